"""CAM-10, PY-02 to PY-04: cam modules in sessions, recordings, logs and replays, the same in process and over LCM."""

from __future__ import annotations

import json
import math
import signal
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import _core, cam, report
from takt.lcmlog import open_log
from takt.recording import Array, Recording

MACHINE = """\
name: rotary_cutter
cycle: {period_s: 0.001}
lcm: {axis_rate_hz: 1000, dead_man_s: 0.3}
axes:
  - name: web
    unit: deg
    kind: rotary
    limits: {velocity: 720, acceleration: 7200, jerk: 100000}
    encoder: {increments_per_unit: 1000}
  - name: knife
    unit: mm
    limits: {velocity: 2000, acceleration: 50000, jerk: 5000000}
    encoder: {increments_per_unit: 10000}
cams:
  - name: hill
    x_unit: deg
    y_unit: mm
    cyclic: true
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 150, y: 20, v: 0, a: 0}, {x: 360, y: 0, v: 0, a: 0}]
  - name: dale
    x_unit: deg
    y_unit: mm
    cyclic: true
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 210, y: -9, v: 0, a: 0}, {x: 360, y: 0, v: 0, a: 0}]
flex_cams:
  - name: cutter
    slave: knife
    master: web
    cams: [hill, dale]
    settings: {sync_mode: ramp_time, sync_in_time_s: 0.3, sync_out_time_s: 0.2, slave_absolute: true,
               jog_velocity: 30, jog_acceleration: 1000, jog_deceleration: 1000, jog_jerk: 20000}
"""
SPEED = 300.0  # deg/s of the web
HILL, DALE = cam.of_machine(MACHINE)
FIELDS = {f[0]: f for f in _core.output_fields("flex_cam")}
OUTPUTS = json.loads(_core.reference())["outputs"]["flex_cam"]["fields"]


@pytest.fixture(params=["in process", "over LCM"])
def session(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[takt.Session]:
    if request.param == "in process":
        with takt.Engine(MACHINE) as engine:
            yield engine
        return
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as remote:
        yield remote


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as made:
        yield made


def power(session: takt.Session) -> takt.FlexCam:
    """Web and knife are on, each in its own way."""
    session.axis("web").power()
    cutter = session.flex_cam("cutter")
    cutter.control(regulator_on=True).wait()
    session.wait(lambda: cutter.axis_enabled and session.axis("web").loop_closed, 2.0)
    return cutter


def synchronise(session: takt.Session) -> takt.FlexCam:
    """The web turns, the knife is on the hill."""
    cutter = power(session)
    session.axis("web").move_velocity(velocity=SPEED).wait(until="reached")
    cutter.control(sync_cam=True).wait()
    return cutter


def on_cam(recording: Recording, slot: int) -> Any:
    """Which samples have the knife on the cam of this slot."""
    module = recording["cutter"]
    return module["cam_synchronised"].astype(bool) & (module["cam_table"] == slot)


# --- the same on both ---


def test_the_slave_is_where_the_cam_says(session: takt.Session) -> None:
    """CAM-10, CAM-30, CAM-33, PY-02: every recorded sample lies on the curve; done is told when it first does."""
    recorder = session.record()
    cutter = power(session)
    assert (cutter.state, cutter.cam_synchronised) == (takt.ModuleState.READY, False)
    assert (cutter.slave, cutter.master) == (session.axis("knife"), session.axis("web"))
    assert "cutter" in repr(cutter)
    session.axis("web").move_velocity(velocity=SPEED).wait(until="reached")
    sync = cutter.control(sync_cam=True)
    sync.wait(until="active")
    assert not sync.done
    sync.wait()
    assert sync.done
    assert cutter.cam_synchronised
    assert cutter.state is takt.ModuleState.SYNC
    session.run(1.5)
    change = cutter.change_cam(cam_table=2, when="next_cycle").wait()
    assert change.done
    session.run(1.5)
    cutter.control(sync_cam=False).wait()
    assert cutter.state is takt.ModuleState.READY
    recording = recorder.stop()

    # Over LCM the first command may be given before the first message: its event lies before the first sample.
    assert any(e.text.startswith("cutter.control {regulator_on: true}") for e in recording.events)
    first = max(table["cycle"][0] for table in map(recording.__getitem__, recording))
    last = min(table["cycle"][-1] for table in map(recording.__getitem__, recording))
    recording = recording.slice(first * session.period, last * session.period)
    module, web, knife = recording["cutter"], recording["web"], recording["knife"]
    assert np.array_equal(module["cycle"], web["cycle"])
    assert np.array_equal(module["cycle"], knife["cycle"])
    first = int(module["cycle"][np.flatnonzero(module["cam_synchronised"])[0]])
    assert first == sync.cycle
    for slot, table in ((1, HILL), (2, DALE)):
        rows = np.flatnonzero(on_cam(recording, slot))
        assert len(rows) > 1000
        x = web["set_position"][rows]
        velocity = web["set_velocity"][rows]
        wanted = table.at(x)
        for name, value, close in (
            ("set_position", wanted.y, 1e-9),
            ("set_velocity", wanted.dy * velocity, 1e-6),
            ("set_acceleration", wanted.ddy * velocity**2 + wanted.dy * web["set_acceleration"][rows], 1e-3),
        ):
            assert np.max(np.abs(knife[name][rows] - value)) < close, name
        assert np.max(np.abs(module["set_x_position"][rows] - x)) < 1e-9
        assert np.max(np.abs(module["set_y_position"][rows] - wanted.y)) < 1e-9
        assert np.max(np.abs(module["mp02_set_slave_position"][rows] - knife["set_position"][rows])) == 0
    takt.expect.visits_states(recording, "cutter", ["Ready", "Sync", "Ready"])
    takt.expect.within_limits(recording, "knife")
    takt.expect.continuous(recording, "knife")
    assert recording.unit("cutter", "actual_slave_velocity") == "mm/s"
    assert {e.kind for e in recording.events if e.component == "cutter"} >= {"start", "end"}


def test_components_go_by_their_names(session: takt.Session) -> None:
    """PY-02, PY-03: unknown names are told with the nearest that there is."""
    assert list(session.flex_cams) == ["cutter"]
    assert list(session.components) == ["web", "knife", "cutter"]
    with pytest.raises(takt.TaktError, match=r"no cam module 'cuter'; did you mean 'cutter'\? \(it has cutter\)"):
        session.flex_cam("cuter")
    with pytest.raises(takt.TaktError, match="no cam module 'web'"):
        session.flex_cam("web")
    with pytest.raises(takt.TaktError, match="no axis 'cutter'"):
        session.axis("cutter")
    with pytest.raises(TypeError, match="a cam module goes by its name, not by None"):
        session.flex_cam(None)  # type: ignore[arg-type]
    with pytest.raises(takt.TaktError, match=r"no axis or other component 'cuttr'; did you mean 'cutter'\?"):
        session.record("cuttr")
    unknown = session.command("cuter", "control")
    assert unknown.error_id == 3010
    assert unknown.sentence.endswith("did you mean cutter?")
    assert session.command("cutter", "controll").sentence.endswith("did you mean control?")
    assert session.command("cutter", "move_absolute", "{position: 1}").error_id == 3011
    assert session.command("knife", "set_cam", "{slot: 1, cam: hill}").error_id == 3011
    assert session.flex_cam("cutter").set_cam(slot=1, cam="hil").wait_final().sentence.endswith("did you mean hill?")


WRONG: list[tuple[str, dict[str, Any], str]] = [
    *(("control", {name: math.nan}, name) for name in ("offset_master", "offset_slave", "scaling_slave")),
    ("control", {"offset_master": math.inf}, "offset_master"),
    ("control", {"scaling_master": -1.0}, "scaling_master"),
    ("control", {"scaling_master": 0.0}, "scaling_master"),
    ("control", {"scaling_slave": -0.5}, "scaling_slave"),
    ("control", {"cam_table": 5}, "cam_table"),
    ("control", {"cam_table": 0}, "cam_table"),
    ("control", {"sync_cam": "yes"}, "sync_cam"),
    ("control", {"virtual_velocity": 1e13}, "virtual_velocity"),
    ("configure", {"master_sync_in_distance": -1.0}, "master_sync_in_distance"),
    ("configure", {"master_sync_out_distance": math.nan}, "master_sync_out_distance"),
    ("configure", {"sync_in_time_s": 0.0}, "sync_in_time_s"),
    ("configure", {"jerk": -1.0}, "jerk"),
    ("configure", {"sync_mode": "ramp"}, "sync_mode"),
    ("set_cam", {"slot": 0, "cam": "hill"}, "slot"),
    ("set_cam", {"slot": 5, "cam": "hill"}, "slot"),
    ("set_cam", {"slot": 1, "cam": ""}, "cam"),
    ("change_cam", {"cam_table": 5}, "cam_table"),
    ("change_cam", {"cam_table": 1, "position": math.nan}, "position"),
    ("change_cam", {"cam_table": 1, "when": "soon"}, "when"),
]


def test_wrong_values_change_nothing(engine: takt.Engine) -> None:
    """EN-22: refused with a sentence that names the argument; the engine stays like one that was never asked."""
    with takt.Engine(MACHINE) as twin:
        cutters = [synchronise(one) for one in (engine, twin)]
        for verb, arguments, name in WRONG:
            feedback = getattr(cutters[0], verb)(**arguments)
            assert feedback.error, (verb, arguments)
            assert feedback.error_id == 5
            assert f"{name}: expected " in feedback.sentence
            engine.step()
            twin.step()
            assert engine.state_hash == twin.state_hash, (verb, arguments)
        assert cutters[0].cam_synchronised


def test_a_refusal_says_the_same_over_lcm(session: takt.Session) -> None:
    """EN-22, PY-02."""
    cutter = session.flex_cam("cutter")
    for verb, arguments, name in WRONG:
        feedback = getattr(cutter, verb)(**arguments)
        assert feedback.error, (verb, arguments)
        assert f"{name}: expected " in feedback.sentence
    refused = cutter.change_cam(cam_table=2).wait_final()  # this one only the cycle finds out
    assert (refused.error, refused.error_id) == (True, 3005)
    off = cutter.control(sync_cam=True).wait_final()
    assert (off.error, off.error_id) == (True, 10)
    with pytest.raises(takt.CommandError, match=r"^cutter.control \{sync_cam: true\}: "):
        off.wait()


def test_what_is_not_given_stays(session: takt.Session) -> None:
    """CAM-11, PY-03: None is no value; levels and settings stay until they are changed."""
    cutter = session.flex_cam("cutter")
    cutter.control(offset_master=12.5, scaling_slave=0.5).wait()
    cutter.configure(scaling_mode_slave="ramp_absolute", offset_mode_slave=takt.OffsetMode.DIRECT).wait()
    assert cutter.control().wait().done
    cutter.control(offset_slave=-3.0, offset_master=None).wait()
    cutter.configure(sync_in_time_s=0.7, scaling_mode_slave=None).wait()
    assert cutter.ip03_set_offset_master == 12.5
    assert cutter.ip04_set_offset_slave == -3.0
    assert cutter.ip06_set_scaling_slave == 0.5
    assert cutter.ip01_set_scaling_master == 1.0
    assert cutter.ip07_scaling_mode_slave is takt.ScalingMode.RAMP_ABSOLUTE
    assert cutter.ip05_offset_mode_slave is takt.OffsetMode.DIRECT
    assert (cutter.ip08_cam_table1, cutter.ip09_cam_table2, cutter.ip10_cam_table3) == (1, 2, 0)
    cutter.set_cam(slot=3, cam="dale").wait()
    assert cutter.ip10_cam_table3 == 2


def test_a_configured_clutch_is_as_it_was_configured(engine: takt.Engine) -> None:
    """CAM-33: what is changed at run time is what the clutch then does."""
    cutter = power(engine)
    engine.axis("web").move_velocity(velocity=SPEED).wait(until="reached")
    cutter.configure(sync_in_time_s=0.75).wait()
    begin = engine.now
    cutter.control(sync_cam=True).wait()
    assert engine.now - begin == pytest.approx(0.75, abs=0.01)


# --- described once ---


def test_every_field_is_described() -> None:
    """EN-11."""
    assert [f["name"] for f in OUTPUTS] == list(FIELDS)
    with takt.Engine(MACHINE) as engine:
        assert set(engine.record("cutter").stop()["cutter"].dtype.names or ()) == {"time_s", "cycle", *FIELDS}


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[takt.Session, takt.Session]]:
    """Two sessions that nothing is asked of: in process and over LCM."""
    url = new_url()
    with (
        running(tmp_path_factory.mktemp("both"), url, machine=MACHINE),
        takt.connect(url) as remote,
        takt.Engine(MACHINE) as engine,
    ):
        engine.step()
        yield engine, remote


@pytest.mark.parametrize("field", OUTPUTS, ids=lambda f: f["name"])
def test_properties_have_the_type_they_are_described_with(
    field: dict[str, Any], both: tuple[takt.Session, takt.Session]
) -> None:
    """EN-11, PY-03: the same in process and over LCM."""
    of = field["type"]
    names = {"real": "float", "integer": "int", "bool": "bool", "enum": of.get("name", "")}
    wanted = "int" if of.get("name") == "ErrorId" else names[of["kind"]]
    values = [getattr(session.flex_cam("cutter"), field["name"]) for session in both]
    assert [type(value).__name__ for value in values] == [wanted, wanted]
    assert values[0] == values[1]
    if of["kind"] == "enum" and wanted != "int":
        assert values[0] in [v["name"] for v in of["values"]]


# --- over LCM ---

CLIENT = """
import sys, time, takt
session = takt.connect(sys.argv[1], client="doomed")
cutter = session.flex_cam("cutter")
cutter.control(regulator_on=True).wait()
session.wait(lambda: cutter.axis_enabled, 2.0)
cutter.jog(positive=True).wait(until="active")
print("jogging", flush=True)
time.sleep(60)
"""


def test_a_killed_client_lets_go_of_a_jog(tmp_path: Path) -> None:
    """EN-23, CAM-10: the jog of a module lives by heartbeats, and ends without them."""
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        cutter, knife = session.flex_cam("cutter"), session.axis("knife")
        client = subprocess.Popen([sys.executable, "-c", CLIENT, url], stdout=subprocess.PIPE, text=True)
        assert client.stdout is not None
        assert client.stdout.readline() == "jogging\n"
        session.run(0.9)  # three times the dead man's time: it lives
        assert knife.set_velocity == pytest.approx(30.0)
        assert cutter.state is takt.ModuleState.JOG_POS
        killed = session.now  # before: a busy host may take longer to end it than the dead man does
        client.send_signal(signal.SIGKILL)
        client.wait()
        session.wait(lambda: knife.set_velocity == 0, 2.0, what="the knife at rest")
        assert 0.02 < session.now - killed < 1.5
        session.wait(lambda: cutter.state is takt.ModuleState.READY, 0.5)


def test_a_jog_is_released(session: takt.Session) -> None:
    """EN-23, PY-02."""
    cutter = power(session)
    jog = cutter.jog(negative=True).wait(until="active")
    session.run(0.5)
    assert cutter.state is takt.ModuleState.JOG_NEG
    jog.release()
    assert jog.wait(2.0).done
    session.wait(lambda: cutter.state is takt.ModuleState.READY, 0.5)


def test_a_module_has_a_rate_of_its_own(tmp_path: Path) -> None:
    """EN-20."""
    url = new_url()
    machine = MACHINE.replace("dead_man_s", "rates: [{axis: cutter, rate_hz: 50}], dead_man_s")
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        with session.record() as recorder:
            session.run(0.5)
        recording = recorder.recording
        assert set(np.diff(recording["cutter"]["cycle"]).tolist()) == {20}
        assert set(np.diff(recording["web"]["cycle"]).tolist()) == {1}


# --- logs, replays ---


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a run of taktd with every command of a module."""
    directory = tmp_path_factory.mktemp("log")
    url = new_url()
    file = directory / "run.lcm"
    with running(directory, url, "--log", str(file), machine=MACHINE), takt.connect(url) as session:
        cutter = power(session)
        jog = cutter.jog(positive=True).wait(until="active")
        session.run(0.5)
        jog.release()
        jog.wait()
        cutter.configure(calculate_bounds=True, master_max_velocity=SPEED, scaling_mode_slave="ramp_absolute").wait()
        session.axis("web").move_velocity(velocity=SPEED).wait(until="reached")
        cutter.control(sync_cam=True).wait()
        cutter.control(offset_master=0.1 + 0.2, scaling_slave=0.5).wait()
        session.run(0.3)
        cutter.set_cam(slot=3, cam="dale").wait()
        cutter.change_cam(cam_table=3, when="cam_position", position=123.4567890123456, align="position").wait()
        cutter.change_cam(cam_table=2)
        cutter.withdraw_changes().wait()
        cutter.control(cam_table=5)
        cutter.control(cam_table=2, cam_change_instant=True).wait()
        session.run(0.3)
        cutter.control(sync_out_instant=True).wait()
        session.wait(lambda: cutter.state is takt.ModuleState.READY, 2.0)
        cutter.control(sync_out_instant=False, sync_cam=False, stop=True).wait()
        session.run(0.1)
    return file


def test_a_run_with_a_module_is_reproduced(log: Path) -> None:
    """EN-07: every cycle."""
    result = takt.replay(log)
    assert result.same, result.sentence
    assert result.cycles > 1500
    assert result.commands > 12


def bits(column: Array) -> bytes:
    return np.ascontiguousarray(column).tobytes()


def test_a_log_has_what_a_replayed_run_has(log: Path) -> None:
    """EN-07, PY-04: every column of every component, bit for bit, as an engine makes it that is given the journal."""
    read = takt.read_log(log)
    run = open_log(log).runs[-1]
    assert run.start is not None
    journal = sorted(run.journal, key=lambda entry: entry.cycle)
    assert {entry.verb for entry in journal if entry.target == "cutter"} == {
        v["name"] for v in json.loads(_core.reference())["verbs"] if v["target_kind"] == "flex_cam"
    }
    cycles = int(read["cutter"]["cycle"][-1]) + 1
    with takt.Engine(run.start.text, period=run.start.period_s) as engine:
        recorder = engine.record()
        for entry in journal:
            engine.step(entry.cycle - engine.cycle)
            given = engine._core.resubmit(entry.target, entry.verb, entry.arguments, entry.ticket, entry.lease_s)
            assert given[1] == 0
        engine.step(cycles - engine.cycle)
        made = recorder.stop()
    assert list(read) == list(made) == ["web", "knife", "cutter"]
    for component in made:
        assert read[component].dtype == made[component].dtype
        for name in made[component].dtype.names or ():
            assert bits(read[component][name]) == bits(made[component][name]), f"{component}.{name}"
        assert {n: read.unit(component, n) for n in FIELDS if component == "cutter"} == {
            n: made.unit(component, n) for n in FIELDS if component == "cutter"
        }
    assert read.meta["losses"] == {}
    assert read.gaps("cutter") == []
    states = read.text("cutter", "state")
    order = [str(states[0])] + [str(b) for a, b in pairwise(states) if a != b]
    assert order == ["Ready", "JogPos", "Ready", "Sync", "Ready", "Stop"]
    assert "cutter.change_cam: aborted" in [e.text for e in read.events if e.component == "cutter"]
    assert any(e.text.startswith("cutter.change_cam {cam_table: 3") for e in read.events if e.kind == "start")


# --- pictures ---


def test_a_recording_with_a_module_is_drawn(engine: takt.Engine, tmp_path: Path) -> None:
    """PY-04, PY-05: signals of a module, the usual ones, and the page."""
    with engine.record() as recorder:
        synchronise(engine)
        engine.run(1.0)
    recording = recorder.recording
    figure = takt.plot.draw(recording, "cutter.set_x_position", "cutter.set_y_position", "knife.set_position")
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert [label for label in labels if label] == ["position\n[mm]", "x position\n[deg]", "y position\n[mm]"]
    figure.canvas.draw()
    takt.plot.draw(recording).canvas.draw()
    takt.plot.draw(recording, "cutter.*").canvas.draw()
    made = report.write_report(recording, [takt.checks.continuous(recording, "knife")], tmp_path, "a cutter")
    text = made.html.read_text()
    assert '"label":"set x position"' in text
    assert '"name":"cutter"' in text
    assert all(picture.stat().st_size > 10_000 for picture in made.pictures)


def test_a_recording_with_a_module_is_kept(engine: takt.Engine, tmp_path: Path) -> None:
    """PY-04: written and read again, it is the same."""
    with engine.record("cutter", "web") as recorder:
        synchronise(engine)
    recording = recorder.recording
    recording.save(tmp_path / "run.npz")
    again = Recording.load(tmp_path / "run.npz")
    assert list(again) == ["cutter", "web"]
    assert bits(again["cutter"]) == bits(recording["cutter"])
    assert again.text("cutter", "state").tolist() == recording.text("cutter", "state").tolist()
    assert again.unit("cutter", "set_y_position") == recording.unit("cutter", "set_y_position")
