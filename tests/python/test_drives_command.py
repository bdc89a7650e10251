"""AX-87, EN-26: the command `takt drives`."""

from __future__ import annotations

import itertools
import os
from pathlib import Path

import can
import pytest
import takt
from buses import described, drives, emulated, machine, new_bus
from machines import new_url
from takt.cli import main
from takt.drives.can_link import parse

_ports = itertools.count(20_000 + os.getpid() % 400 * 10)


def new_wire() -> str:
    """A bus for several processes."""
    return f"canopen:udp_multicast:239.74.163.42?port={next(_ports)}"


def test_processes_of_their_own(tmp_path: Path) -> None:
    """EN-26: bus, drives, drive process and engine, each in its own; faults on command; a sentence at the end."""
    url, bus = new_url(), new_wire()
    text = machine(url, bus, 2)
    file = tmp_path / "machine.yaml"
    file.write_text(text)
    with drives("emulate", file) as emulation:
        emulation.wait_for("2 emulated drives")
        with drives("run", file) as served:
            served.wait_for("ready: x1, x2")
            with takt.Engine(text) as engine:
                x = engine.axis("x1")
                x.power().wait()
                x.move_absolute(position=20.0).wait()
                emulation.tell("fault 1 0x4210")
                emulation.wait_for("fault 1 0x4210: done")
                engine.run(0.2)
                assert x.error == 3002
                served.wait_for("x1: node 1: fault 0x4210 (drive too hot)")
            assert not [line for line in served.lines if "another master" in line], "it does not take itself for one"
            with can.Bus(interface="udp_multicast", channel=parse(bus).channel, **parse(bus).options) as stranger:
                stranger.send(can.Message(arbitration_id=0x080, is_extended_id=False))
            with takt.Engine(text) as engine:
                engine.run(0.1)
            served.wait_for("another master is active: another node sends SYNC, too")
            assert served.end() == 0
            assert "cycles, " in served.lines[-1]
        emulation.tell("frighten 1")
        emulation.wait_for("not understood: 'frighten 1")
        emulation.tell("quit")
        assert emulation.process.wait(60) == 0


def test_scan_and_info(capsys: pytest.CaptureFixture[str]) -> None:
    """AX-87: what is on the bus, and what a drive says of itself."""
    bus = new_bus()
    with emulated(machine(new_url(), bus, 2)):
        assert main(["drives", "scan", "--bus", bus]) == 0
        said = capsys.readouterr()
        assert said.out.splitlines() == [
            f"node {k}: Takt emulated drive, vendor 0x0, product 0x54414B54, revision 0x1, switch on disabled, no error"
            for k in (1, 2)
        ]
        assert said.err == f"{bus}: 2 nodes\n"
        assert main(["drives", "info", "--bus", bus, "--node", "2"]) == 0
        out = capsys.readouterr().out
        for line in ("modes: hm, csp, csv, cst", "0x6076 motor rated torque: 1000", "0x6041 status word: 0x0240"):
            assert f"  {line}\n" in out
        assert main(["drives", "info", "--bus", bus, "--node", "9"]) == 2
        assert capsys.readouterr().err == f"takt: {bus}: node 9: 0x1000:0 cannot be read: no answer\n"


def test_an_empty_bus(capsys: pytest.CaptureFixture[str]) -> None:
    """AX-87: exit code 1."""
    bus = new_bus()
    assert main(["drives", "scan", "--bus", bus]) == 1
    assert capsys.readouterr().err == f"{bus}: 0 nodes\n"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["run", "plain.yaml"], "plain.yaml: has no field buses (external: buses: - bus: canopen:CHANNEL)"),
        (
            ["run", "bus.yaml", "--bus", "canopen:can9"],
            "bus.yaml: external.buses has no canopen:can9; it has canopen:nocan",
        ),
        (["run", "bus.yaml"], "canopen:nocan: the bus cannot be opened: "),
        (["emulate"], "give a machine file, or --bus with --nodes"),
        (
            ["scan", "--bus", "can0"],
            "can0: expected canopen:CHANNEL or canopen:INTERFACE:CHANNEL, such as canopen:can0",
        ),
        (["info", "--bus", "canopen:virtual:x", "--node", "0"], "Invalid value for '--node': 0 is not in the range"),
    ],
)
def test_bad_input(
    arguments: list[str],
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """AX-87: one line, exit code 2."""
    monkeypatch.chdir(tmp_path)
    Path("bus.yaml").write_text(machine(new_url(), "canopen:nocan", 1))
    Path("plain.yaml").write_text(machine(new_url(), "canopen:nocan", 1).partition("external:")[0])
    assert main(["drives", *arguments]) == 2
    err = capsys.readouterr().err
    assert err.startswith(f"takt: {sentence}")
    assert err.count("\n") == 1


def test_drives_without_a_machine(capsys: pytest.CaptureFixture[str]) -> None:
    """AX-87: any number of them."""
    bus = new_wire()
    with drives("emulate", "--bus", bus, "--nodes", "3") as emulation:
        emulation.wait_for("3 emulated drives")
        assert main(["drives", "scan", "--bus", bus]) == 0
        assert len(capsys.readouterr().out.splitlines()) == 3


def test_the_page_shows_a_machine_that_loads() -> None:
    """The keys of docs/field_buses.md."""
    page = (Path(__file__).parents[2] / "docs" / "field_buses.md").read_text()
    shown = page.partition("```yaml\n# machine.yaml\n")[2].partition("```")[0]
    head = "name: shown\naxes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\n"
    found = described(head + shown)["external"]["buses"][0]["drives"][0]
    assert found["scaling"]["feed"] == 5
