"""Set points of groups that come from outside, one after another (docs/groups.md)."""

from __future__ import annotations

import heapq
import math
import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from portals import PORTAL, portal

OTHER_STREAM, LATE, JUMP, ENDED = 3120, 3121, 3122, 3123
DELTA = """
name: streamed
axes:
  - {name: a1, unit: deg, limits: {velocity: 400, acceleration: 8000, jerk: 400000, lower: -30, upper: 85}}
  - {name: a2, unit: deg, limits: {velocity: 400, acceleration: 8000, jerk: 400000, lower: -30, upper: 85}}
  - {name: a3, unit: deg, limits: {velocity: 400, acceleration: 8000, jerk: 400000, lower: -30, upper: 85}}
groups:
  - name: robot
    axes: [a1, a2, a3]
    kinematics: {delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}
    path: {velocity: 2000, acceleration: 30000, jerk: 2000000}
"""
JOINT = (
    "  - {name: j%d, unit: deg, limits: {velocity: 200, acceleration: 1500, jerk: 30000, lower: -170, upper: 170}}\n"
)
LIMITS = "{velocity: 200, acceleration: 1500, jerk: 30000, lower: -170, upper: 170}"
SIX = (
    "name: streamed\naxes:\n"
    + "".join(f"  - {{name: j{i}, unit: deg, limits: {LIMITS}}}\n" for i in range(1, 7))
    + """groups:
  - name: robot
    axes: [j1, j2, j3, j4, j5, j6]
    kinematics: {six_axis: {a1: 100, a2: -35, b: 0, c1: 400, c2: 350, c3: 350, c4: 80}}
    path: {velocity: 800, acceleration: 5000, jerk: 100000}
"""
)
Signal = Callable[[float], tuple[float, float, float]]


def hand(seed: int) -> Signal:
    """A hand that never rests: slow and quick waves at random in X, Y and Z, from 0."""
    rnd = random.Random(seed)
    waves = [[(rnd.uniform(3, 25) / f, f, rnd.uniform(0, 6.28)) for f in (0.7, 1.9, 4.3)] for _ in range(3)]
    return lambda t: tuple(sum(a * (math.sin(f * t + p) - math.sin(p)) for a, f, p in w) for w in waves)  # type: ignore[return-value]


def send(s: takt.Engine, group: takt.Group, signal: Signal, rate: float, *, seed: int, seconds: float, velocity: bool,
         jitter: float, lost: float, doubled: float, system: str) -> list[takt.Feedback]:  # fmt: skip
    """Packets with the sender's times, which began long ago; each comes late by up to `jitter`, or not at all."""
    rnd = random.Random(seed)
    begin, epoch = s.now, 8000.25
    packets: list[tuple[float, int]] = []
    for i in range(int(seconds * rate)):
        if i and rnd.random() < lost:
            continue
        for _ in range(2 if rnd.random() < doubled else 1):
            heapq.heappush(packets, (i / rate + rnd.uniform(0, jitter if i else 0), i))
    answers = []
    while packets:
        if packets[0][0] > s.now - begin:
            s.step()
            continue
        t = heapq.heappop(packets)[1] / rate
        x, y, z = signal(t)
        given = {}
        if velocity:
            slopes = [(b - a) / 2e-4 for a, b in zip(signal(t - 1e-4), signal(t + 1e-4), strict=True)]
            given = dict(zip(("vx", "vy", "vz"), slopes, strict=True))
        answers.append(
            group.stream_point(x=x, y=y, z=z, coordinate_system=system, pcs=3, time=epoch + t, key=7, **given)
        )
    return answers


@pytest.mark.parametrize("velocity", [False, True])
@pytest.mark.parametrize(
    ("rate", "jitter", "lost", "doubled", "within"),
    [(50, 0.0, 0.0, 0.0, 0.4), (50, 0.03, 0.05, 0.05, 2.5), (1000, 0.006, 0.1, 0.1, 0.3)],
)  # fmt: skip
def test_a_hand_is_followed(
    rate: float, jitter: float, lost: float, doubled: float, within: float, velocity: bool
) -> None:
    """AX-114: a Delta in a product coordinate system at 50 Hz to 1 kHz, with jitter, losses, packets twice and out of
    order: within the limits of each axis, without a step, and the tool where the hand was one delay before."""
    signal = hand(int(rate) + velocity)
    delay = 0.028 if rate == 1000 else 0.03 + 2 / rate + jitter
    with takt.Engine(DELTA) as s:
        robot = s.group("robot")
        robot.power().wait()
        robot.enable().wait()
        robot.set_cartesian_transform(pcs=3, x=robot.x, y=robot.y, z=robot.z - 60, c=30).wait()
        robot.move_linear_absolute(x=0, y=0, z=0, coordinate_system="pcs", pcs=3).wait()
        stream = robot.stream(key=7, delay=delay)
        s.step(3)
        begin = s.now
        with s.record("robot", "a1", "a2", "a3") as recorder:
            answers = send(s, robot, signal, rate, seed=3, seconds=1.6, velocity=velocity, jitter=jitter, lost=lost,
                           doubled=doubled, system="pcs")  # fmt: skip
        assert stream.active
        assert stream.reached
        assert {answer.error_id for answer in answers} <= {0, LATE}
        assert sum(answer.done for answer in answers) > 0.9 * 1.6 * rate * (1 - lost)
        for axis in ("a1", "a2", "a3"):
            takt.expect.within_limits(recorder.recording, axis)
        r = recorder.recording["robot"]
        t = np.asarray(r["cycle"]) * s.period - begin - delay
        due = np.array([signal(one) if one > 0 else (0, 0, 0) for one in t])
        matrix = np.asarray(takt.kinematics.pose_to_matrix(robot.product_system(3)))
        due = due @ matrix[:3, :3].T + matrix[:3, 3]
        tool = np.column_stack([r["x"], r["y"], r["z"]])
        away = np.linalg.norm(tool - due, axis=1)[t > 0.6]  # after it has caught up
        assert away.max() < within + 200 * 0.002
        robot.halt().wait()
        assert stream.aborted
        assert robot.state is takt.GroupState.GROUP_STANDBY


def test_a_stream_that_stops_stops_the_group() -> None:
    """AX-114: on with the last velocity until the timeout, then a stop within limits; moves are taken at once."""
    with portal() as (s, gantry):
        stream = gantry.stream(delay=0.01, timeout=0.05)
        s.run(1.0)
        assert stream.active  # before the first set point nothing is missing
        with s.record("x", "y") as recorder:
            for i in range(40):
                gantry.stream_point(x=2.0 * i, y=-1.0 * i, time=0.02 * i)
                s.step(20)
            last = s.now
            stream.wait_final()
        assert stream.error_id == ENDED
        assert s.now - last == pytest.approx(0.05 - 0.02, abs=0.003)
        gantry.move_linear_absolute(x=0, y=0, z=0).wait()
        for axis in ("x", "y"):
            takt.expect.within_limits(recorder.recording, axis)


def test_joints_are_streamed() -> None:
    """AX-114: in ACS, one axis alone, with velocities; what is not given stays."""
    with portal() as (s, gantry):
        gantry.stream(delay=0.03)
        with s.record("x", "y", "z") as recorder:
            for i in range(100):
                t = 0.01 * i
                done = gantry.stream_point(
                    a2=20 * (1 - math.cos(3 * t)), v2=60 * math.sin(3 * t), time=t, coordinate_system="acs"
                )
                s.step(10)
                assert done.done, done.sentence
        y = np.asarray(recorder.recording["y"]["set_position"])
        t = np.arange(len(y)) * s.period - 0.031
        assert np.abs(y - 20 * (1 - np.cos(3 * t)))[300:].max() < 0.1
        for axis in ("x", "z"):
            assert not np.any(recorder.recording[axis]["set_position"])


def test_a_wrist_turns() -> None:
    """AX-114: six axes, the tool turns about its centre point and keeps it; an untouched number stays."""
    with takt.Engine(SIX) as s:
        robot = s.group("robot")
        robot.power().wait()
        robot.enable().wait()
        robot.move_direct_absolute(a1=10, a2=20, a3=30, a4=5, a5=60, a6=0).wait()
        x, y, z, _, b, c = robot.pose
        robot.stream(delay=0.05)
        with s.record("robot", *(f"j{i}" for i in range(1, 7))) as recorder:
            for i in range(75):
                t = 0.02 * i
                given = robot.stream_point(x=x, y=y, z=z, c=c + 10 * (1 - math.cos(2 * t)), time=t)
                s.step(20)
                assert given.done, given.sentence
        r = recorder.recording["robot"]
        assert max(np.abs(np.asarray(r[k]) - v).max() for k, v in zip("xyz", (x, y, z), strict=True)) < 0.02
        assert np.ptp(np.asarray(r["c"])) > 15
        assert np.abs(np.asarray(r["b"]) - b).max() < 0.01
        for i in range(1, 7):
            takt.expect.within_limits(recorder.recording, f"j{i}")


def test_what_cannot_be_followed_is_refused_and_the_stream_goes_on() -> None:
    """AX-114: each with its own error; the axes do not notice."""
    with portal() as (s, gantry):
        assert gantry.stream_point(x=1).wait_final().error_id == 3005
        stream = gantry.stream(key=5, delay=0.05)
        s.step(3)
        bad = [
            ({"x": math.nan}, 5),
            ({"x": 1.0, "vx": math.inf}, 5),
            ({"x": 1.0, "vx": 501.0}, JUMP),
            ({"x": 1.0, "time": math.nan}, 5),
            ({"x": 1.0, "key": 4}, OTHER_STREAM),
            ({"x": 250.0}, JUMP),
            ({"x": 301.0}, 3021),
            ({"a1": 301.0, "coordinate_system": "acs"}, 8),
            ({"a1": 1.0}, 5),  # not beside the tool's numbers
            ({"x": 1.0, "coordinate_system": "acs"}, 5),
            ({"a7": 1.0, "coordinate_system": "acs"}, 1003),
            ({}, 5),
        ]
        with s.record("x") as recorder:
            for i in range(72):
                t = 0.01 * i
                good = gantry.stream_point(x=40 * math.sin(2 * t), time=t, key=5)
                s.step(5)
                assert good.done, good.sentence
                given, error = bad[i % len(bad)]
                refused = gantry.stream_point(**({"time": t + 0.005, "key": 5} | given))
                again = gantry.stream_point(x=3, time=t, key=5)
                before = gantry.stream_point(x=3, time=t - 1, key=5)
                s.step(5)
                assert (refused.error_id, again.error_id, before.error_id) == (error, LATE, LATE), given
                assert refused.sentence
        assert stream.active
        takt.expect.within_limits(recorder.recording, "x")
        assert gantry.x == pytest.approx(40 * math.sin(2 * (0.01 * 71 - 0.04)), abs=1.0)


def test_two_clients_for_one_stream() -> None:
    """AX-114: the second stream takes over, smoothly; set points of the first one are refused from then on."""
    with portal() as (s, gantry):
        first = gantry.stream(key=1)
        answers = []
        second = None
        with s.record("x", "y") as recorder:
            for i in range(150):
                if i == 70:
                    second = gantry.stream(key=2)
                answers.append(gantry.stream_point(x=0.8 * i, y=0.4 * i, time=0.01 * i, key=1))
                if second is not None:
                    gantry.stream_point(x=50 - 0.3 * (i - 70), time=500 + 0.01 * i, key=2)
                s.step(10)
        assert first.aborted
        assert second is not None
        assert second.reached
        assert {answer.error_id for answer in answers[71:]} == {OTHER_STREAM}
        for axis in ("x", "y"):
            takt.expect.within_limits(recorder.recording, axis)


def test_it_takes_over_from_moves_and_jogs_and_the_reverse() -> None:
    """AX-114: a stream begins while the group moves, and moves take over from it; buffered ones would wait for ever."""
    with portal() as (s, gantry):
        with s.record("x", "y", "z") as recorder:
            move = gantry.move_linear_absolute(x=150, y=80)
            s.run(0.3)
            stream = gantry.stream()
            s.step(2)
            assert move.aborted
            for i in range(60):
                gantry.stream_point(x=60 + 0.5 * i, y=20, z=-0.2 * i, time=0.01 * i)
                s.step(10)
            assert gantry.move_linear_absolute(x=0, buffer_mode="buffered").wait_final().error_id == 3005
            assert gantry.interrupt().wait_final().error_id == 3005
            gantry.move_linear_absolute(x=0, y=0, z=0).wait()
            assert stream.aborted
            jog = gantry.jog(x=40)
            s.run(0.3)
            stream = gantry.stream()
            gantry.stream_point(y=10)
            s.run(0.05)
            assert jog.aborted
            gantry.jog(y=-20)
            s.run(0.3)
            assert stream.aborted
            gantry.halt().wait()
        for axis in ("x", "y", "z"):
            takt.expect.within_limits(recorder.recording, axis)


@pytest.mark.parametrize("verb", ["halt", "stop", "power", "emergency_stop", "disable", "x_off"])
def test_stops_end_a_stream(verb: str) -> None:
    """AX-114, AX-100: set points that come later move nothing."""
    with portal() as (s, gantry):
        stream = gantry.stream()
        given = []
        for i in range(100):
            given.append(gantry.stream_point(x=0.9 * i, y=0.3 * i, time=0.01 * i))
            if i == 50:
                if verb == "emergency_stop":
                    s.command("machine", verb)
                elif verb == "x_off":
                    s.command("x", "power", {"enable": False})
                else:
                    s.command("gantry", verb, {"enable": False} if verb == "power" else {})
            s.step(10)
        assert stream.final
        assert not stream.done
        assert given[-1].error_id in (3005, 1001)
        assert s.axis("x").set_velocity == 0
        assert s.axis("y").set_velocity == 0


def test_it_ends_before_a_sw_limit() -> None:
    """AX-114: a stream whose velocity leads beyond a SW limit ends before it, without a fault."""
    with portal() as (s, gantry):
        gantry.move_linear_absolute(x=250).wait()
        with s.record("x") as recorder:
            stream = gantry.stream(delay=0.01, timeout=5)
            for i in range(24):
                gantry.stream_point(x=250 + 2 * i, vx=200, time=0.01 * i)
                s.step(10)
            stream.wait_final()
            s.run(0.3)
        assert stream.error_id == 8
        assert gantry.state is takt.GroupState.GROUP_STANDBY
        takt.expect.within_limits(recorder.recording, "x")


ZONES = """
name: zones
axes:
  - {name: l, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: r, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - {name: left, axes: [l], kinematics: {gantry: {axes: [x]}}, path: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: right, axes: [r], kinematics: {gantry: {axes: [x]}}, path: {velocity: 300, acceleration: 3000, jerk: 60000},
     base: {x: 400}}
zones:
  - {name: middle, lower: {x: 150, y: -50, z: -50}, upper: {x: 250, y: 50, z: 50}}
"""


def test_zones_of_others_are_not_entered() -> None:
    """AX-114, GR-47: set points into a taken zone are refused, a free one is taken; a stream that would run into one
    of another group ends outside; its own stays its own until it is outside."""
    with takt.Engine(ZONES) as s:
        left, right = s.group("left"), s.group("right")
        for group in (left, right):
            group.power().wait()
            group.enable().wait()
        right.move_linear_absolute(x=-200).wait()
        stream = left.stream(delay=0.2, timeout=3)
        refused = set()
        with s.record("left") as recorder:
            for i in range(100):
                refused.add(left.stream_point(x=1.9 * i, time=0.01 * i).wait_final().error_id)
                s.step(9)
            stream.wait_final()
            s.run(0.5)
        assert refused == {0, 3130, 3005}
        assert stream.error_id == 3130
        assert np.asarray(recorder.recording["left"]["x"]).max() < 150
        assert left.state is takt.GroupState.GROUP_STANDBY
        right.move_linear_absolute(x=0).wait()
        left.stream()
        begins = left.x
        for i in range(60):
            assert left.stream_point(x=begins + i, time=0.02 * i).wait_final().done
            s.step(19)
            if i == 30:
                waits = right.move_linear_absolute(x=-200)
        assert left.zone_names == ("middle",)
        assert not waits.final
        assert right.x == pytest.approx(0)
        left.move_linear_absolute(x=0).wait()
        waits.wait()


def test_systems_that_move_are_refused() -> None:
    """AX-114: what moves has no place that a set point could name ahead."""
    machine = PORTAL + "poses: [{name: tray}]\n"
    with takt.Engine(machine) as s:
        gantry = s.group("gantry")
        gantry.power().wait()
        gantry.enable().wait()
        s.pose("tray").set(x=1000).wait()
        gantry.set_dyn_coord_transform(pcs=2, carrier="tray").wait()
        stream = gantry.stream()
        assert gantry.stream_point(x=1, coordinate_system="pcs", pcs=2).wait_final().error_id == 5
        assert gantry.stream_point(x=1000, y=2, coordinate_system="wcs").wait_final().done
        assert stream.active


def test_over_lcm(tmp_path: Path) -> None:
    """AX-114: from another process, in real time."""
    url = new_url()
    with running(tmp_path, url, machine=PORTAL), takt.connect(url) as session:
        gantry = session.group("gantry")
        gantry.power().wait()
        gantry.enable().wait()
        stream = gantry.stream(key=3, delay=0.2, timeout=5.0)
        session.wait(lambda: stream.active)
        asked = []
        for i in range(60):
            t = 0.01 * i
            x, vx = 20 * (1 - math.cos(2 * t)), 40 * math.sin(2 * t)
            asked.append(gantry.stream_point(x=x, y=-x, vx=vx, vy=-vx, time=t, key=3))
            session.run(0.01)
        asked.append(gantry.stream_point(x=30, y=0, time=2.0, vx=0, key=3))
        session.wait(lambda: all(one.final for one in asked))
        assert sum(one.done for one in asked) > 50
        session.wait(lambda: abs(gantry.x - 30) < 1e-3 and abs(gantry.y) < 1e-3 and gantry.velocity < 1e-3)
        gantry.halt().wait()
        assert stream.aborted
