"""EN-26: the wire of `takt demo real_drives`: EtherCAT where it can be had, else a line that says why, and CANopen."""

from __future__ import annotations

import os
import socket
from pathlib import Path

import pytest
from takt.drives import demonstration
from takt.errors import TaktError

FOLDER = Path(__file__).parents[2] / "python/examples/six_axes"


def test_without_the_right_it_is_canopen(monkeypatch: pytest.MonkeyPatch) -> None:
    """One line says what is missing."""

    def refused(*_: str) -> None:
        raise TaktError("ip link add: Operation not permitted")

    monkeypatch.setattr(demonstration, "_ip", refused)
    monkeypatch.setattr(demonstration, "ENDS", ("nix0", "nix1"))
    monkeypatch.setattr(demonstration, "package", lambda: None)
    said: list[str] = []
    with demonstration.machine_file(FOLDER, said.append) as file:
        assert file.name == "canopen.yaml"
        assert file.is_file()
    assert said == ["no EtherCAT here: ip link add: Operation not permitted; so CANopen over UDP"]


def test_the_wire_is_made_and_taken_away() -> None:
    """Both ends are there meanwhile, and not afterwards."""
    pytest.importorskip("pysoem")
    from wires import own_network

    with own_network(wire=False):
        said: list[str] = []
        with demonstration.machine_file(FOLDER, said.append) as file:
            assert (file.name, said) == ("ethercat.yaml", ["EtherCAT between the interfaces ec0 and ec1"])
            assert {"ec0", "ec1"} <= {name for _, name in socket.if_nameindex()}
        assert "ec0" not in {name for _, name in socket.if_nameindex()}


def test_a_process_that_does_not_start(tmp_path: Path) -> None:
    """Its last line is said."""
    machine = tmp_path / "machine.yaml"
    machine.write_text("name: m\naxes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\n")
    with (
        pytest.raises(TaktError, match=r"takt drives emulate does not start: .*has no field buses"),
        demonstration.processes(machine, f"udpm://239.255.76.67:{20000 + os.getpid() % 9000}?ttl=0", tmp_path, print),
    ):
        pass
