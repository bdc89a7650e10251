"""Zones (GR-47), cams made at run time (CAM-88) and keys (EN-31) in the situations of docs/stopping.md, and in the
hands of every tool."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import takt
import yaml
from keyed import Bystander, Sender, key_bytes, new_key
from machines import new_url, running
from takt import cam, msgs
from takt.cli import main
from test_made_cams import MACHINE as PRESS
from test_made_cams import hill, run_stamp, steps
from test_zones import MIDDLE, gantry, inside, machine, on

TWO = machine(MIDDLE, gantry("left"), gantry("right", 300))


# --- zones: one tool stands inside or goes through, another one waits ---


def switched(name: str, **switches: dict[str, float]) -> str:
    """The machine with limit switches of an axis."""
    text = yaml.safe_load(TWO)
    text["simulation"] = {"servos": [{"axis": name, "switches": switches}]}
    return str(yaml.safe_dump(text))


def stop_held(s: takt.Engine, group: takt.Group) -> takt.Feedback:
    return group.stop(hold=True)


def client_gone(s: takt.Engine, group: takt.Group) -> None:
    """It held a stop and is not heard any more."""
    s._core.resubmit(group.name, "stop", json.dumps({"hold": True}), 10**9, 0.05)


Cause = Callable[[takt.Engine, takt.Group], takt.Feedback | None]
OF_GROUP: dict[str, Cause] = {
    "halt": lambda s, group: group.halt(),
    "stop": lambda s, group: group.stop(),
    "stop held": stop_held,
    "interrupt": lambda s, group: group.interrupt(),
    "disable": lambda s, group: group.disable(),
    "power off": lambda s, group: group.power(enable=False),
    "a client that is gone": client_gone,
}
OF_MACHINE: dict[str, Cause] = {
    "stop_all": lambda s, group: s.command("machine", "stop_all"),
    "stop_all, loops open": lambda s, group: s.command("machine", "stop_all", {"open_loops": True}),
    "emergency stop": lambda s, group: s.command("machine", "emergency_stop"),
    "emergency stop held": lambda s, group: s.command("machine", "emergency_stop", {"hold": True}),
    "fault": lambda s, group: s.command("machine", "fail_all_axes"),
}


def both(s: takt.Engine, recording: takt.Recording) -> bool:
    return bool((inside(recording["left"], 0) & inside(recording["right"], 300)).any())


def recover(s: takt.Engine, group: takt.Group) -> None:
    """Whatever stopped it is over."""
    group.reset().wait_final()
    group.power().wait_final()
    if group.state is takt.GroupState.GROUP_DISABLED:
        group.enable().wait_final()
    if group.interrupted:
        group.continue_path().wait_final()


def goes_on_after(s: takt.Engine, left: takt.Group, right: takt.Group, asked: takt.Feedback | None) -> None:
    """The one inside leaves, the other one gets in."""
    if asked is not None:
        asked.release()
    s.run(0.2)
    for group in (left, right):
        recover(s, group)
    assert left.move_linear_absolute(x=0).wait_final().done
    assert right.move_linear_absolute(x=-150).wait_final().done
    assert right.zone_names == ("middle",)
    assert left.zone_names == ()


@pytest.mark.parametrize("name", OF_GROUP)
def test_what_stops_the_one_that_waits_ends_its_wait(name: str) -> None:
    """GR-47, GR-03: it has no zone and waits for none, and never gets in by itself."""
    with takt.Engine(TWO) as s:
        left, right = on(s)
        left.move_linear_absolute(x=150).wait()
        move = right.move_linear_absolute(x=-150)
        s.run(0.1)
        assert right.waiting
        with s.record() as recorder:
            asked = OF_GROUP[name](s, right)
            s.run(0.5)
            assert not right.waiting
            assert right.zone_names == ()
            assert left.zone_names == ("middle",)
            assert move.final is not (name == "interrupt")
            goes_on_after(s, left, right, asked)
        assert not both(s, recorder.recording)


@pytest.mark.parametrize("moves", [False, True], ids=["at rest", "moving"])
@pytest.mark.parametrize("name", {**OF_GROUP, **OF_MACHINE})
def test_what_stops_the_one_inside_leaves_it_the_zone(name: str, moves: bool) -> None:
    """GR-47: a tool that rests inside has the zone, on or off; the other one stays outside until it has left."""
    with takt.Engine(TWO) as s:
        left, right = on(s)
        left.move_linear_absolute(x=110).wait()
        if moves:
            left.move_linear_absolute(x=190, velocity=100)
        right.move_linear_absolute(x=-150)
        s.run(0.1)
        assert right.waiting
        with s.record() as recorder:
            asked = {**OF_GROUP, **OF_MACHINE}[name](s, left)
            s.run(1)
            assert left.zone_names == ("middle",)
            assert right.zone_names == ()
            assert bool(right.waiting) == (name in OF_GROUP)
            if name == "emergency stop held":
                refused = right.move_linear_absolute(x=-150).wait_final()
                assert refused.error
            goes_on_after(s, left, right, asked)
        assert not both(s, recorder.recording)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_limit_switch_that_stops_the_one_inside(sense: int) -> None:
    """GR-47, PP-60: it is stopped inside, and has the zone; back is the only way out."""
    place = {"limit_positive": {"from": 150}} if sense > 0 else {"limit_negative": {"to": -150}}
    with takt.Engine(switched("left_x" if sense > 0 else "right_x", **place)) as s:
        left, right = on(s)
        first, other = (left, right) if sense > 0 else (right, left)
        first.move_linear_absolute(x=sense * 250, velocity=100)
        s.wait(lambda: first.state is takt.GroupState.GROUP_ERROR_STOP, 20)
        s.run(0.2)
        waits = other.move_linear_absolute(x=-sense * 150)
        s.run(0.2)
        assert first.zone_names == ("middle",)
        assert other.waiting
        first.reset().wait()
        assert first.move_linear_absolute(x=sense * 170).wait_final().error_id == 3006
        assert first.zone_names == ("middle",)
        assert first.move_linear_absolute(x=0).wait_final().done
        assert waits.wait_final().done


def test_a_full_queue_before_a_zone_loses_nothing() -> None:
    """GR-47, AX-12: so many moves wait as a queue holds, one more is refused, and all are carried out."""
    with takt.Engine(TWO) as s:
        left, right = on(s)
        left.move_linear_absolute(x=150).wait()
        moves = [right.move_linear_absolute(x=-150 - (k % 2), buffer_mode="buffered") for k in range(128)]
        s.run(0.1)
        assert right.waiting
        assert right.move_linear_absolute(x=0, buffer_mode="buffered").wait_final().error_id == 3003
        left.move_linear_absolute(x=0).wait()
        s.wait(lambda: all(move.final for move in moves), 60)
        assert all(move.done for move in moves)


def test_nobody_gets_in_while_the_engine_stops() -> None:
    """GR-47, EN-08."""
    with takt.Engine(TWO) as s:
        left, right = on(s)
        left.move_linear_absolute(x=150).wait()
        right.move_linear_absolute(x=-150)
        left.move_linear_absolute(x=0, velocity=50)
        s.run(0.1)
        with s.record() as recorder:
            s.shut_down()
            s.step(50)
        assert not both(s, recorder.recording)
        assert not inside(recorder.recording["right"], 300).any()


# --- cams made at run time ---


MADE: dict[str, Callable[[takt.Engine], takt.Feedback | None]] = {
    "running": lambda s: None,
    "emergency stop held": lambda s: s.command("machine", "emergency_stop", {"hold": True}),
    "power off": lambda s: s.command("machine", "stop_all", {"open_loops": True}),
    "fault": lambda s: s.command("machine", "fail_all_axes"),
    "stop held": lambda s: s.axis("drum").stop(hold=True),
}


@pytest.mark.parametrize("name", MADE)
def test_cams_are_made_whatever_is_stopped(name: str) -> None:
    """CAM-88, AX-101: data is taken, nothing moves by it; what was made then is there afterwards."""
    with takt.Engine(PRESS) as s:
        stamp = run_stamp(s)
        s.run(0.3)
        MADE[name](s)
        s.run(0.5)
        with s.record() as recorder:
            made = s.make_cam(hill(7, "late"))
            loaded = stamp.load_cam(2, steps(8))
            s.run(0.3)
            assert made.done, made.sentence
            assert loaded.done, loaded.sentence
        if name != "running":
            assert not np.abs(recorder.recording["ram"]["set_velocity"]).max()
        assert s.cam("late").extremes().y.greatest.value == pytest.approx(7, abs=1e-6)
        assert stamp.set_cam(slot=1, cam="late").wait_final().done


def test_no_cam_is_made_while_the_engine_stops() -> None:
    """CAM-88, EN-08: refused as every command is, with a sentence."""
    with takt.Engine(PRESS) as s:
        stamp = run_stamp(s)
        s.run(0.3)
        seen: list[takt.Feedback] = []

        def scan() -> None:
            if len(seen) < 2:
                seen.append(s.command("machine", "begin_cam", {"name": "late"}))
                seen.append(stamp.set_cam(slot=2, cam="flat"))

        s.program(lambda: scan() if s.axis("drum").state is takt.PlcState.STOPPING else None)
        s.shut_down()
        s.step(5)
        assert {feedback.error_id for feedback in seen} == {3015}


def test_clients_that_are_gone_leave_no_cam_behind() -> None:
    """CAM-88: what they had begun makes room for the next one; a cam is built whole or not at all."""
    with takt.Engine(PRESS) as s:
        for name in ("first", "second", "third"):
            s.command("machine", "begin_cam", {"name": name}).wait()
            s.command("machine", "add_cam_points", {"cam": name, "points": [{"x": 0.0, "y": 0.0}]}).wait()
        assert s.make_cam(hill(3, "whole")).wait_final().done
        told = s.flex_cam("stamp").set_cam(slot=2, cam="first").wait_final()
        assert told.error_id == 3010


# --- keys ---


@pytest.mark.parametrize("holder", ["", "wrong"])
def test_cams_and_zones_of_holders_of_another_key(holder: str, tmp_path: Path) -> None:
    """EN-31, CAM-88: what others send of a cam is counted and ignored: the holder's own, begun before, stays whole."""
    url, key = new_url(), new_key(tmp_path)
    other = Sender(key_bytes(new_key(tmp_path, "other")))
    bystander = Bystander(url)

    def say(verb: str, **arguments: object) -> None:
        message = msgs.command()
        message.client, message.id, message.target, message.verb = "stranger", time.time_ns(), "machine", verb
        message.arguments, message.utime = json.dumps(arguments), time.time_ns() // 1000
        data = message.encode()
        bystander.network.publish("takt/command", other.tag("takt/command", data) if holder else data)

    reason = "wrong_key" if holder else "untagged"
    with (
        running(tmp_path, url, "--key", str(key), machine=PRESS),
        takt.connect(url, key=str(key), timeout=30) as s,
    ):
        point = {"x": 0.0, "y": 0.0}
        s.command("machine", "begin_cam", {"name": "ours", "cyclic": False}).wait()
        s.command("machine", "add_cam_points", {"cam": "ours", "points": [point]}).wait()
        say("begin_cam", name="ours")
        say("add_cam_points", cam="ours", points=[{"x": 5.0, "y": 99.0}])
        say("drop_cam", cam="flat")
        s.wait(lambda: s.figures[reason] >= 3, 30)
        s.command("machine", "add_cam_points", {"cam": "ours", "points": [{"x": 10.0, "y": 4.0}]}).wait()
        assert s.command("machine", "build_cam", {"cam": "ours", "count": 2}).wait().done
        assert s.flex_cam("stamp").set_cam(slot=2, cam="ours").wait().done
        assert s.make_cam(hill(3)).wait().done


def test_zones_with_a_key(tmp_path: Path) -> None:
    """EN-31, GR-47: states stay open, and a client without the key moves nobody into a zone."""
    url, key = new_url(), new_key(tmp_path)
    with running(tmp_path, url, "--key", str(key), machine=TWO), takt.connect(url, key=str(key), timeout=30) as s:
        left, right = on(s)
        left.move_linear_absolute(x=150).wait()
        waits = right.move_linear_absolute(x=-150)
        s.wait(lambda: bool(right.waiting), 10)
        assert left.zone_names == ("middle",)
        with pytest.raises(takt.ConnectionError):
            takt.connect(url, timeout=5)
        left.move_linear_absolute(x=0).wait()
        assert waits.wait().done


# --- tools ---


def test_zones_and_made_cams_in_every_tool(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07, GR-47, CAM-88: a run with both is checked, recorded, drawn, reported and exported; the published states
    say who waits for whom and which cam runs. (Logs, replay, live page: test_every_kind.py, test_made_cams.py.)"""
    both, press = yaml.safe_load(TWO), yaml.safe_load(PRESS)
    both |= {"axes": both["axes"] + press["axes"], "cams": press["cams"], "flex_cams": press["flex_cams"]}
    file, run = tmp_path / "machine.yaml", tmp_path / "run.npz"
    file.write_text(yaml.safe_dump(both))
    with takt.Engine(file.read_text()) as s:
        left, right = on(s)
        stamp = run_stamp(s)
        recorder = s.record()
        left.move_linear_absolute(x=150).wait()
        right.move_linear_absolute(x=-150)
        s.run(0.1)
        stamp.load_cam(2, hill(37.5)).wait()
        stamp.control(cam_table=2).wait()
        s.wait(lambda: stamp.cam_number == 2, 2)
        left.move_linear_absolute(x=0).wait()
        s.wait(lambda: right.zone_names == ("middle",), 2)
        recorder.stop().save(run)
        assert isinstance(s.cam("hill"), cam.Table)
    for command in (["check", file], ["plot", run], ["report", run], ["export", run, "--csv", tmp_path / "run.csv"]):
        assert main([str(part) for part in command]) == 0, capsys.readouterr()
    recording = takt.Recording.load(run)
    assert set(np.unique(recording["right"]["waits_for"])) == {0, 1}
    assert set(np.unique(recording["right"]["waits_zone"])) == {0, 1}
    assert set(np.unique(recording["right"]["zones"])) == {0, 1}
    assert recording["stamp"]["cam_number"].max() == 2
