"""Every tool with every kind of component, and with each optional part of a machine file left out."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
import takt
from every_kind import FULL, MINIMAL, left_out, text_of
from machines import new_url, running, taktd
from pages import Client, served
from takt import _core, msgs
from takt.cli import main
from takt.missing import all_missing
from takt.report.columns import Block
from takt.report.scene import machine_of, scene_of
from takt.view.machine import Machine

ALL = {**MINIMAL, "all of them": FULL}


def recorded(text: str) -> takt.Recording:
    with takt.Engine(text) as engine:
        recorder = engine.record()
        engine.step(6)
        assert [repr(component) for component in engine.components.values()]
        return recorder.stop()


def live(text: str) -> dict[str, Any]:
    """What the live page is told of a machine."""
    description = msgs.machine_description()
    description.name, description.text, description.period_s = "small", text, 0.001
    return Machine(description).describe()


@pytest.mark.parametrize("name", ALL)
def test_virtual_time(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-04, PY-07, CAM-80: check, record, plot, report and export."""
    text = text_of(ALL[name])
    file, run = tmp_path / "machine.yaml", tmp_path / "run.npz"
    file.write_text(text)
    recording = recorded(text)
    assert {len(recording[name]) for name in recording} == {6}
    recording.save(run)
    for command in (
        ["check", file],
        ["plot", run],
        ["report", run],
        ["export", run, "--csv", tmp_path / "run.csv", "--mcap", tmp_path / "run.mcap"],
    ):
        assert main(list(map(str, command))) == 0, capsys.readouterr()
    components = json.loads(json.dumps(live(text)))["components"]
    assert {one["name"] for one in components} == set(recording)


@pytest.mark.parametrize("name", ALL)
def test_log(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """EN-07, PY-07, CAM-80: what taktd wrote of it is read, replayed, drawn and reported."""
    file, log = tmp_path / "machine.yaml", tmp_path / "run.lcm"
    file.write_text(text_of(ALL[name]))
    command = [taktd(), file, "--no-lcm", "--pace", "fast", "--duration", "0.1", "--log", log]
    subprocess.run(command, check=True, capture_output=True)
    for tool in (["log", log], ["replay", log], ["report", log], ["export", log, "--csv", tmp_path / "run.csv"]):
        assert main(list(map(str, tool))) == 0, capsys.readouterr()
    assert "the same, bit for bit" in capsys.readouterr().out


def test_with_anything_left_out() -> None:
    """PY-04, CAM-80: whatever is a machine without a part of it is recorded and shown, by reports and the live page."""
    tried = []
    for where, machine in left_out(FULL):
        text = text_of(machine)
        try:
            _core.load_machine(text.encode(), "machine")
        except takt.ConfigError:
            continue
        tried.append(where)
        recording = recorded(text)
        scene = scene_of(recording, Block(), machine_of(recording))
        shown = scene["machine"] if scene else live(text)
        assert [one["name"] for one in shown["components"]] == list(recording), where
    assert len(tried) > 100
    assert {"flex_cams.0.master", "groups.0.path.deceleration", "movers.0.z", "belts.0.upper_limit"} <= set(tried)


@pytest.mark.parametrize("name", ["all of them", "flex_cam without a master"])
def test_over_lcm(name: str, tmp_path: Path) -> None:
    """PY-02: a session, its recording, a log of the network and the live page."""
    url, log = new_url(), tmp_path / "network.log"
    with (
        running(tmp_path, url, machine=text_of(ALL[name])),
        served(url) as address,
        takt.write_log(log, url),
        takt.connect(url) as session,
        Client(address) as page,
    ):
        assert [repr(component) for component in session.components.values()]
        page.look_at(details=list(range(len(session.components))))
        with session.record() as recorder:
            session.run(0.3)
        page.until(lambda: len(page.rows) == len(session.components))
    assert set(recorder.recording) == set(session.components) == set(takt.read_log(log))
    assert all_missing(recorder.recording) == ""
    recorder.recording.save(tmp_path / "run.npz")
    assert main(["report", str(tmp_path / "run.npz")]) == 0


def test_units_of_a_cam_module() -> None:
    """CAM-80: a virtual master has the unit of its cam."""
    machine = MINIMAL["flex_cam without a master"]
    cam = {**machine["cams"][0], "x_unit": "deg", "y_unit": "in"}
    with takt.Engine(text_of({**machine, "cams": [cam]})) as engine:
        module = engine.flex_cam("module")
        assert module.master is None
        with engine.record() as recorder:
            engine.step(3)
        recording = recorder.recording
    assert recording.unit("module", "set_x_position") == "deg"
    assert {recording.unit("module", field) for field in recording.fields("module")} >= {"deg", "in", "mm/s"}
