"""PY-05, PL-50, PL-82: `within_limits` of planar movers, in the plane, on tracks and of each other coordinate."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable

import numpy as np
import pytest
import takt
from takt import checks, expect
from takt.recording import Recording
from takt.verdict import MotionAssertionError

MACHINE = """
name: plane
axes: []
movers:
  - name: one
    xy: {maximum: {velocity: 1500, acceleration: 8000, jerk: 160000}}
    lateral_acceleration: 3000
tracks:
  - name: loop
    closed_loop: true
    elements:
      - {from: {x: 200, y: 100}, to: {x: 800, y: 100}}
      - {from: {x: 900, y: 200}, to: {x: 900, y: 500}}
      - {from: {x: 800, y: 600}, to: {x: 200, y: 600}}
      - {from: {x: 100, y: 500}, to: {x: 100, y: 200}}
"""


def drive(number: int) -> Recording:
    """Whatever comes: targets while it moves, blended, beyond what it can do, halts; up and round; onto a track."""
    rng = random.Random(number)
    with takt.Engine(MACHINE) as engine, engine.record() as recorder:
        one, loop = engine.mover("one"), engine.track("loop")
        loop.enable().wait()
        one.enable().wait()
        for _ in range(15):
            dynamics = {"velocity": rng.uniform(50, 4000), "acceleration": rng.uniform(500, 30_000)}
            buffered = {"buffer_mode": "buffered", "blending": rng.uniform(0, 100)} if rng.random() < 0.3 else {}
            one.move_to_position(x=rng.uniform(0, 2000), y=rng.uniform(0, 2000), **dynamics, **buffered)
            one.move_z(position=rng.uniform(0, 5))
            one.move_c(position=rng.uniform(-15, 15))
            engine.run(rng.uniform(0.01, 0.6))
            if rng.random() < 0.2:
                one.halt()
        one.halt().wait()
        one.join_track(track="loop", use_orientation=False).wait()
        for _ in range(6):
            one.move_on_track(track="loop", position=rng.uniform(0, 2000), velocity=rng.uniform(500, 4000))
            engine.run(rng.uniform(0.1, 1.2))
        one.move_on_track(track="loop", position=0).wait()
        one.leave_track(x=60, y=60).wait()
    return recorder.recording


@pytest.fixture(scope="module")
def recording() -> Recording:
    return drive(1)


@pytest.mark.parametrize("number", range(4))
def test_a_mover_keeps_its_limits_whatever_comes(number: int) -> None:
    verdict = checks.within_limits(drive(number), "one")
    assert verdict.passed, verdict.sentence
    for text in ("velocity limit of 1500 mm/s", "acceleration limit of 8000 mm/s²", "jerk limit of 160000 mm/s³"):
        assert text in verdict.sentence
    assert "limit of 3000 mm/s² for the lateral acceleration, those of Z and C; closest call" in verdict.sentence


def test_it_uses_what_it_has(recording: Recording) -> None:
    """So the limits are those that bind: a thousandth less of any is not kept."""
    assert not checks.within_limits(recording, "one", velocity=1500 * 0.999).passed
    assert not checks.within_limits(recording, "one", acceleration=8000 * 0.999).passed
    assert not checks.within_limits(recording, "one", jerk=160_000 * 0.999).passed
    tight = Recording(
        {"one": recording["one"]},
        {"one": {f: recording.unit("one", f) for f in recording.fields("one")[2:]}},
        names={"one": {"command_mode": recording.names("one", "command_mode")}},
        info={"one": {"limits": {**recording.info("one")["limits"], "lateral_acceleration": 2990.0}}},
    )
    verdict = checks.within_limits(tight, "one")
    assert not verdict.passed
    over = re.search(
        r"one left its limit of 2990 mm/s² for the lateral acceleration by ([\d.]+) mm/s²", verdict.sentence
    )
    assert over, verdict.sentence
    assert 9.9 < float(over[1]) <= 10.001


def test_an_infinite_limit_leaves_the_others_checked(recording: Recording) -> None:
    """PL-82: and a limit that is not a number is refused."""
    verdict = checks.within_limits(recording, "one", velocity=math.inf, acceleration=8000 * 0.999)
    assert "its acceleration limit" in verdict.sentence
    assert not verdict.passed
    verdict = checks.within_limits(recording, "one", jerk=math.inf)
    assert verdict.passed
    assert "jerk limit" not in verdict.sentence
    with pytest.raises(ValueError, match="the velocity limit nan is not a positive number"):
        checks.within_limits(recording, "one", velocity=math.nan)


def changed(recording: Recording, field: str, change: Callable[[np.ndarray], object]) -> Recording:
    """The same with one column that `change` has had in its hands."""
    table = recording["one"].copy()
    change(table[field])
    fields = recording.fields("one")[2:]
    return Recording(
        {"one": table},
        {"one": {f: recording.unit("one", f) for f in fields}},
        names={"one": {f: recording.names("one", f) for f in fields if recording.names("one", f)}},
        info={"one": recording.info("one")},
    )


def put(at: int, value: float) -> Callable[[np.ndarray], object]:
    def change(column: np.ndarray) -> None:
        column[at] = value

    return change


@pytest.mark.parametrize(
    ("field", "value", "on_track", "sentence"),
    [
        ("velocity_y", 1600, False, "left its velocity limit of 1500 mm/s by"),
        ("acceleration_x", 8100, False, "; also acceleration"),
        ("acceleration_y", 200, False, "left its jerk limit of 160000 mm/s³ by"),
        ("velocity_x", -1501, True, "left its velocity limit of 1500 mm/s by 1 mm/s: 1501 mm/s"),
        ("acceleration_y", 170, True, "left its jerk limit of 160000 mm/s³ by"),
        ("z", 5.1, False, "left its range 0 … 5 mm for the position of Z by 0.1 mm: 5.1 mm"),
        ("velocity_c", 400, True, "left its limit of 360 deg/s for the velocity of C by 40 deg/s"),
        ("acceleration_b", -301, True, "; also acceleration of B"),
        ("velocity_x", np.nan, False, "one.velocity_x is not a number"),
    ],
)
def test_each_limit_is_asked(recording: Recording, field: str, value: float, on_track: bool, sentence: str) -> None:
    """At rest in the plane before it moves, or standing on the track."""
    mode = recording.text("one", "command_mode")
    at = int(np.flatnonzero(mode == "OnTrack")[0]) + 1 if on_track else 50
    verdict = checks.within_limits(changed(recording, field, put(at, value)), "one")
    assert not verdict.passed
    assert sentence in verdict.sentence
    assert verdict.when_s == pytest.approx(recording["one"]["time_s"][at], abs=0.0015)
    assert verdict.lanes


def round_a_corner(distance: float, jerk: float, lateral: float) -> Recording:
    machine = f"""
name: corner
axes: []
movers:
  - name: one
    xy: {{maximum: {{velocity: 1800, acceleration: 9000, jerk: {jerk}}}}}
    lateral_acceleration: {lateral}
tracks:
  - name: bend
    elements:
      - {{from: {{x: 0, y: 0}}, to: {{x: 500, y: 0}}}}
      - {{from: {{x: {500 + distance}, y: {-distance}}}, to: {{x: {500 + distance}, y: -700}}}}
"""
    with takt.Engine(machine) as engine:
        one, bend = engine.mover("one"), engine.track("bend")
        bend.enable().wait()
        one.enable().wait()
        one.join_track(track="bend").wait()
        with engine.record() as recorder:
            one.move_on_track(position=bend.length - 1).wait()
    return recorder.recording


@pytest.mark.parametrize("distance", [12.0, 55.0, 140.0])
@pytest.mark.parametrize(("jerk", "lateral"), [(60_000.0, 9000.0), (250_000.0, 2500.0), (1_200_000.0, 6000.0)])
def test_a_corner_is_gone_round_within_the_vectors(distance: float, jerk: float, lateral: float) -> None:  # PL-82
    recording = round_a_corner(distance, jerk, lateral)
    verdict = checks.within_limits(recording, "one")
    assert verdict.passed, verdict.sentence
    table = recording["one"]
    ax, ay = table["acceleration_x"], table["acceleration_y"]
    assert np.hypot(ax, ay).max() <= 9000 * (1 + 1e-6)
    measured = np.hypot(np.diff(ax), np.diff(ay)).max() / 0.001
    assert 0.98 * jerk <= measured <= jerk * (1 + 2e-5)


def test_a_jerk_across_the_track_is_found(recording: Recording) -> None:  # PL-82
    """The acceleration along the track stays as it is; its vector turns by as much as no mover can."""
    on = recording.text("one", "command_mode") == "OnTrack"
    fast = np.flatnonzero(on & (np.abs(recording["one"]["track_velocity"]) > 300))
    at = int(fast[len(fast) // 2])
    across = float(recording["one"]["acceleration_y"][at]) + 500
    verdict = checks.within_limits(changed(recording, "acceleration_y", put(at, across)), "one")
    assert not verdict.passed
    assert "left its jerk limit of 160000 mm/s³ by" in verdict.sentence


@pytest.mark.parametrize(("lateral", "acceleration"), [(5001, 5000), (12_000, 9000)])
def test_more_across_the_track_than_there_is_is_refused(lateral: float, acceleration: float) -> None:  # PL-82
    xy = f"xy: {{maximum: {{velocity: 900, acceleration: {acceleration}, jerk: 90000}}}}"
    with pytest.raises(takt.ConfigError, match=r"lateral_acceleration: must not be above xy\.maximum\.acceleration"):
        takt.Engine(f"name: x\naxes: []\nmovers: [{{name: one, {xy}, lateral_acceleration: {lateral}}}]\n")
    # Without one it is what the mover has, where that is less than 5000.
    with takt.Engine(f"name: x\naxes: []\nmovers: [{{name: one, {xy.replace(str(acceleration), '700')}}}]\n") as engine:
        with engine.record() as recorder:
            engine.step()
        assert recorder.recording.info("one")["limits"]["lateral_acceleration"] == 700


@pytest.mark.parametrize("number", [7, 11])
def test_movers_that_turn_brake_before_others_within_their_limits(number: int) -> None:  # PL-81, PL-82
    """The area of what turns is a bound, and may come out larger while it brakes: no reason to stop at once."""
    rng = random.Random(number)
    turns = {"maximum": {"velocity": 720, "acceleration": 7200, "jerk": 144_000}, "lower": -1e4, "upper": 1e4}
    sizes = {"one": (60, 150, 0), "two": (150, 50, 500)}
    machine = {
        "name": "plane",
        "axes": [],
        "movers": [
            {"name": name, "width": width, "height": height, "initial": {"x": x, "c": rng.uniform(-90, 90)}, "c": turns}
            for name, (width, height, x) in sizes.items()
        ],
    }
    with takt.Engine(machine) as engine, engine.record() as recorder:
        movers = list(engine.movers.values())
        for mover in movers:
            mover.enable().wait()
        for _ in range(12):
            dynamics = {"acceleration": rng.uniform(1000, 10_000)}
            place = {"x": rng.uniform(0, 500), "y": rng.uniform(-80, 80), "c": rng.uniform(-90, 90)}
            rng.choice(movers).move_to_position(**place, **dynamics)
            engine.run(rng.uniform(0.05, 0.4))
        engine.run(1)
    for name in sizes:
        expect.within_limits(recorder.recording, name)


def taken_over(one: takt.Mover, engine: takt.Engine) -> None:
    one.move_to_position(x=1000, y=0)
    engine.run(0.2)
    one.move_x(position=100).wait()


def halted(one: takt.Mover, engine: takt.Engine) -> None:
    one.move_to_position(x=1000, y=0)
    one.move_z(position=50)
    one.move_c(position=50)
    engine.run(0.3)
    one.halt().wait()


def turned_along(one: takt.Mover, engine: takt.Engine) -> None:
    one.move_to_position(x=1, y=0, c=50, use_orientation=True).wait()


@pytest.mark.parametrize("go", [taken_over, halted, turned_along])
def test_a_standard_above_the_maximum_is_the_maximum(go: Callable[[takt.Mover, takt.Engine], None]) -> None:
    """PL-03, PL-15: however a motion begins or ends, the maximum is kept."""
    more = {"velocity": 3000, "acceleration": 20_000, "jerk": 2e6}
    wide = {"standard": {**more, "velocity": 90}, "lower": -60, "upper": 60}
    one = {
        "name": "one",
        "xy": {"maximum": {"velocity": 1000, "acceleration": 2000, "jerk": 50_000}, "standard": more},
        "z": {"maximum": {"velocity": 100, "acceleration": 200, "jerk": 20_000}, **wide},
        "c": {"maximum": {"velocity": 100, "acceleration": 1000, "jerk": 20_000}, **wide},
    }
    with takt.Engine({"name": "plane", "axes": [], "movers": [one]}) as engine:
        engine.mover("one").enable().wait()
        with engine.record() as recorder:
            go(engine.mover("one"), engine)
    expect.within_limits(recorder.recording, "one")


def test_set_points_from_outside_may_have_any_jerk() -> None:
    with takt.Engine(MACHINE) as engine, engine.record() as recorder:
        one = engine.mover("one")
        one.enable().wait()
        one.start_external_setpoint_generation()
        x, v = one.x, 0.0
        for i in range(200):
            a = 5000.0 if i < 100 else -5000.0
            x, v = x + v * engine.period + a * engine.period**2 / 2, v + a * engine.period
            one.set_external_setpoint(x=x, y=one.y, velocity_x=v, acceleration_x=a)
            engine.step()
        one.stop_external_setpoint_generation().wait()
    assert np.abs(np.diff(recorder.recording["one"]["acceleration_x"])).max() > 9000
    verdict = checks.within_limits(recorder.recording, "one")
    assert verdict.passed, verdict.sentence
    with pytest.raises(MotionAssertionError, match="acceleration limit of 4000"):
        expect.within_limits(recorder.recording, "one", acceleration=4000)


@pytest.mark.parametrize("how", ["halt", "stop", "missing"])
@pytest.mark.parametrize("cycles", range(250, 500, 60))
def test_the_way_back_to_a_track_is_within_the_limits(cycles: int, how: str) -> None:
    """PL-13, PL-82: relative set points end on a track; what they added and the way along the track each brake by
    themselves, and the way back begins when both are over."""
    machine = {
        "name": "line",
        "axes": [],
        "movers": [{"name": "one"}],
        "tracks": [{"name": "track", "elements": [{"from": {"x": 0, "y": 0}, "to": {"x": 3000, "y": 0}}]}],
    }
    with takt.Engine(machine) as engine:
        one = engine.mover("one")
        one.enable().wait()
        engine.track("track").enable().wait()
        one.join_track(track="track").wait()
        one.move_on_track(position=2900, velocity=300)
        with engine.record() as recorder:
            engine.run(0.1)
            one.start_external_setpoint_generation(mode="relative")
            w = 2 * np.pi
            for k in range(1, cycles):
                y, v, a = (1 - np.cos(w * k * 1e-3)), w * np.sin(w * k * 1e-3), w * w * np.cos(w * k * 1e-3)
                one.set_external_setpoint(y=20 * y, velocity_y=20 * v, acceleration_y=20 * a)
                engine.step()
            if how == "halt":
                one.halt(deceleration=300, jerk=3000)
            elif how == "stop":
                one.stop_external_setpoint_generation()
            engine.run(3)
            if how == "missing":
                one.reset()
                engine.run(0.01)
            else:
                one.move_on_track(position=2000)
                engine.run(2)
        assert one.y == 0
    recording = recorder.recording
    verdict = checks.within_limits(recording, "one")
    assert verdict.passed, verdict.sentence
    # A part of it begins on the way back.
    time_s = recording["one"]["time_s"]
    ended_s = float(time_s[np.flatnonzero(recording["one"]["external"] > 0)[-1]])
    for later_s in (0.002, 0.02, 0.05, 0.3):
        part = checks.within_limits(recording, "one", window=(ended_s + later_s, float(time_s[-1])))
        assert part.passed, part.sentence
    # From where it is back and at rest all is checked again.
    last = len(recording["one"]) - 2
    assert not checks.within_limits(changed(recording, "acceleration_y", put(last, 9000)), "one").passed
    # The way back has each cycle for itself.
    ax, ay, vx = (recording.column("one", signal) for signal in ("acceleration_x", "acceleration_y", "velocity_x"))
    ended = int(np.nonzero(recording["one"]["external"] > 0)[0].max())
    rested = ended + int(np.argmax((vx == 0)[ended:]))
    assert np.hypot(np.diff(ax), np.diff(ay))[rested - 1 :].max() <= 200_000 * 1e-3 * (1 + 1e-6)


def test_positions_in_the_plane_are_asked_by_name(recording: Recording) -> None:
    with pytest.raises(ValueError, match="for positions of the mover one say which: signal='x'"):
        checks.within_limits(recording, "one", position=(0, 100))
    assert not checks.within_limits(recording, "one", position=(0, 100), signal="x").passed
    assert checks.within_limits(recording, "one", position=(0, 2000.1), signal="x").passed
