"""GR-48: groups jogged by hand, in axis, machine, world, product and tool coordinates."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from portals import PORTAL, portal
from takt import expect

_AXIS = "limits: {velocity: 300, acceleration: 3000, jerk: 100000, lower: -170, upper: 170}"
ARM = (
    "name: cell\naxes:\n"
    + "".join(f"  - {{name: a{i}, unit: deg, {_AXIS}}}\n" for i in range(1, 7))
    + """groups:
  - name: arm
    axes: [a1, a2, a3, a4, a5, a6]
    kinematics: {six_axis: {a1: 25, a2: -35, b: 0, c1: 400, c2: 455, c3: 420, c4: 80}}
    path: {velocity: 1000, acceleration: 8000, jerk: 300000}
    base: {x: 500, c: 90}
    tool: {z: 100}
"""
)
DELTA = (
    "name: delta\naxes:\n"
    + "".join(
        f"  - {{name: arm{i}, unit: deg, limits: {{velocity: 800, acceleration: 20000, jerk: 1000000}}}}\n"
        for i in range(3)
    )
    + """groups:
  - name: robot
    axes: [arm0, arm1, arm2]
    kinematics: {delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}
    path: {velocity: 1000, acceleration: 20000, jerk: 1000000}
"""
)
TURNING = PORTAL.replace("kinematics: {gantry: {axes: [x, y, z]}}", "kinematics: {gantry: {axes: [x, y, c]}}")


def ready(engine: takt.Engine, **joints: float) -> takt.Group:
    (group,) = engine.groups.values()
    group.power().wait()
    group.enable().wait()
    if joints:
        group.move_direct_absolute(**joints).wait()
    return group


@pytest.fixture
def arm() -> Iterator[tuple[takt.Engine, takt.Group]]:
    with takt.Engine(ARM) as engine:
        yield engine, ready(engine, a1=10, a2=-80, a3=100, a4=5, a5=50, a6=-20)


def turned(pose: tuple[float, ...]) -> np.ndarray:
    """The rotation of A, B, C about the X, Y, Z of the coordinate system, one after the other."""
    a, b, c = np.radians(pose[3:])
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    return z @ y @ x


def limits_held(recording: takt.Recording, group: takt.Group) -> None:
    for axis in group.members:
        assert expect.within_limits(recording, axis.name)
        assert expect.continuous(recording, axis.name)


@pytest.mark.parametrize("system", ["mcs", "wcs", "pcs", "tool"])
@pytest.mark.parametrize("direction", range(6))
def test_along_and_about_each_axis(system: str, direction: int, arm: tuple[takt.Engine, takt.Group]) -> None:
    engine, group = arm
    group.set_cartesian_transform(pcs=3, x=50, a=20, b=-30, c=40).wait()
    before = group.pose
    frame = {
        "mcs": np.eye(3),
        "wcs": turned((0, 0, 0, 0, 0, 90)).T,
        "pcs": turned((0, 0, 0, 20, -30, 40)),
        "tool": turned(before),
    }[system]
    speed = -15.0
    with engine.record() as recorder:
        jog = group.jog(**{"xyzabc"[direction]: speed}, coordinate_system=system, pcs=3)
        engine.run(0.4)
        assert jog.active
        assert group.path_velocity == pytest.approx(15, rel=1e-3)
        jog.release()
        assert jog.wait().done
    after = group.pose
    moved = np.array(after[:3]) - before[:3]
    wanted = np.zeros(3)
    if direction < 3:
        assert np.linalg.norm(moved) > 4
        wanted = -frame[:, direction] * np.linalg.norm(moved)
        assert np.allclose(turned(after), turned(before), atol=1e-9)
    else:
        turn = turned(after) @ turned(before).T
        axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        assert np.allclose(axis / np.linalg.norm(axis), -frame[:, direction - 3], atol=1e-6)
        assert np.degrees(np.arcsin(np.linalg.norm(axis) / 2)) > 4
    assert np.allclose(moved, wanted, atol=1e-6)
    assert group.state is takt.GroupState.GROUP_STANDBY
    limits_held(recorder.recording, group)


def test_axes_one_by_one_and_together(arm: tuple[takt.Engine, takt.Group]) -> None:
    engine, group = arm
    before = [axis.set_position for axis in group.members]
    jog = group.jog(a1=20, a5=-10, coordinate_system="acs")
    engine.run(0.5)
    assert group.members[0].set_velocity == pytest.approx(20)
    assert group.members[4].set_velocity == pytest.approx(-10)
    jog.release()
    jog.wait()
    moved = [axis.set_position - start for axis, start in zip(group.members, before, strict=True)]
    assert moved[0] == pytest.approx(-2 * moved[4])
    assert moved[1:4] + moved[5:] == pytest.approx([0] * 4, abs=1e-9)


def test_more_than_half_a_turn() -> None:
    with takt.Engine(TURNING) as engine:
        group = ready(engine)
        jog = group.jog(c=200, coordinate_system="wcs")
        engine.run(4.0)
        jog.release()
        jog.wait()
        assert engine.axis("z").set_position > 700


def test_ends_before_a_sw_limit_and_goes_the_other_way() -> None:
    with portal() as (engine, group):
        with engine.record() as recorder:
            jog = group.jog(x=250)
            assert jog.wait_final(5.0).error_id == 3021
            assert 299.99 < group.x < 300
            assert group.reason.value == "axis_limit"
            assert group.state is takt.GroupState.GROUP_STANDBY
            assert group.jog(x=10).wait_final().error_id == 3021
            back = group.jog(x=-100)
            engine.run(0.5)
            back.release()
            back.wait()
        assert group.x < 270
        assert engine.axis("x").error == 0
        limits_held(recorder.recording, group)


def test_ends_at_the_rim_of_the_reach() -> None:
    with takt.Engine(DELTA) as engine:
        group = ready(engine)
        with engine.record() as recorder:
            assert group.jog(x=600, y=200).wait_final(5.0).error_id in (3021, 3022)
            far = group.x
            back = group.jog(x=-300)
            engine.run(0.3)
            back.release()
            back.wait()
        assert far > 200
        assert group.x < far - 50
        limits_held(recorder.recording, group)
        assert group.jog(c=10).wait_final().error_id == 3021  # its platform does not turn
        assert group.reason.value == "orientation"


def test_speeds_are_held_to_those_of_jogs() -> None:
    text = ARM.replace("    base:", "    jog: {velocity: 40, angular_velocity: 12, axis_factor: 0.1}\n    base:")
    with takt.Engine(text) as engine:
        group = ready(engine, a1=10, a2=-80, a3=100, a4=5, a5=50, a6=-20)
        for given, most, of in (
            ({"x": -500}, 40, "velocity"),
            ({"a1": 300, "coordinate_system": "acs"}, 40, "velocity"),
            ({"c": 100}, 12, "path_velocity"),
            ({"a6": 300, "coordinate_system": "acs"}, 12, "path_velocity"),
        ):
            jog = group.jog(**given)
            engine.run(0.4)
            assert 0.3 * most < getattr(group, of) <= most * (1 + 1e-6), given
            jog.release()
            jog.wait()


def test_a_deceleration_left_out_is_that_of_the_group() -> None:
    """GR-48: whatever acceleration the jog gives."""
    machine = PORTAL.replace("acceleration: 3000, jerk: 60000}", "acceleration: 3000, deceleration: 500, jerk: 60000}")
    with takt.Engine(machine) as engine:
        gantry = ready(engine)
        with engine.record() as recorder:
            gantry.jog(x=100, acceleration=2000)
            engine.run(0.3)
            gantry.jog()
            engine.run(0.5)
        along = np.array(recorder.recording["gantry"]["path_acceleration"])
        assert 1800 < along.max() < 2000.1
        assert -500.1 < along.min() < -450


def test_another_speed_takes_over_without_a_stop_another_direction_behind_one() -> None:
    with portal() as (engine, group):
        with engine.record() as recorder:
            first = group.jog(x=20)
            engine.run(0.3)
            second = group.jog(x=60)
            engine.run(0.3)
            assert first.aborted
            assert second.active
            assert group.velocity == pytest.approx(60)
            group.jog(x=10)
            engine.run(0.3)
            assert group.velocity == pytest.approx(10)
        speed = np.array(recorder.recording["gantry"]["velocity"])
        assert speed[200:].min() > 9.99
        with engine.record() as recorder:
            last = group.jog(y=30)
            engine.run(0.5)
            assert group.velocity == pytest.approx(30)
            let_go = group.jog()
            assert let_go.wait().done
        assert last.aborted
        assert np.array(recorder.recording["gantry"]["velocity"]).min() < 1e-9
        limits_held(recorder.recording, group)
        assert group.jog().wait().done  # there is nothing to let go of


def test_moves_and_jogs_take_over_from_one_another() -> None:
    with portal() as (engine, group):
        move = group.move_linear_absolute(x=200, velocity=100)
        engine.run(0.3)
        jog = group.jog(z=20)
        engine.run(0.5)
        assert move.aborted
        assert jog.active
        waits = group.move_linear_absolute(x=0, buffer_mode="buffered")
        assert waits.wait_final().error_id == 3005
        assert group.move_linear_absolute(x=0, z=0).wait().done
        assert jog.aborted
        jog = group.jog(z=20)
        engine.run(0.2)
        assert group.halt().wait().done
        assert jog.aborted
        jog = group.jog(x=20)
        engine.run(0.2)
        group.set_override(velocity_factor=0.5).wait()
        engine.run(0.3)
        assert group.velocity == pytest.approx(10)
        engine.axis("x").stop()  # refused: it is a member
        assert group.stop().wait().done
        assert jog.aborted


def test_ends_before_what_stands_in_the_workspace() -> None:
    box = "obstacles: [{name: post, box: {x: 20, y: 20, z: 20}, pose: {x: 100}}]"
    ball = "gripper: [{name: finger, sphere: {radius: 5}}]"
    text = PORTAL.replace("    base:", f"    workspace: {{margin: 2, {box}, {ball}}}\n    base:")
    with takt.Engine(text) as engine:
        group = ready(engine)
        jog = group.jog(x=50)
        assert jog.wait_final(5.0).error_id == 3024
        assert group.in_the_way == ("finger", "post")
        assert 80 < group.x < 83
        back = group.jog(x=-50)
        engine.run(0.3)
        back.release()
        assert back.wait().done


def test_ends_before_a_zone_that_another_group_has() -> None:
    axes = "".join(
        f"  - {{name: {g}_{a}, unit: mm, limits: {{velocity: 500, acceleration: 5000, jerk: 100000}}}}\n"
        for g in ("left", "right")
        for a in "xyz"
    )
    groups = "".join(
        f"  - {{name: {g}, axes: [{g}_x, {g}_y, {g}_z], kinematics: {{gantry: {{axes: [x, y, z]}}}}, "
        f"path: {{velocity: 300, acceleration: 3000, jerk: 60000}}, base: {{x: {base}}}}}\n"
        for g, base in (("left", 0), ("right", 150))
    )
    zone = "  - {name: middle, lower: {x: 100, y: -50, z: -50}, upper: {x: 200, y: 50, z: 50}}\n"
    with takt.Engine(f"name: zones\naxes:\n{axes}groups:\n{groups}zones:\n{zone}") as engine:
        left, right = engine.groups.values()
        for group in (left, right):
            group.power().wait()
            group.enable().wait()
        for start in (0, -150, -1000):
            left.move_linear_absolute(x=start).wait()
            jog = left.jog(x=100)
            assert jog.wait_final(20.0).error_id == 3130
            assert 95 - (95 - start) / 30 < left.x < 95
        assert left.state is takt.GroupState.GROUP_STANDBY


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"x": float("nan")}, "x: expected"),
        ({"a1": float("inf"), "coordinate_system": "acs"}, "a1: expected"),
        ({"x": 1e12}, "x: expected a number in mm/s from"),
        ({"x": 1, "coordinate_system": "acs"}, "x: expected a1 to a8 only, with coordinate_system acs"),
        ({"x": 1, "coordinate_system": "hand"}, "expected one of acs, mcs, wcs, pcs, tool"),
        ({"x": 1, "pcs": 0, "coordinate_system": "pcs"}, "pcs: expected a whole number from 1 to 16"),
        ({"x": 1, "jerk": -1}, "jerk: expected"),
        ({"a1": 1}, ""),
        ({"a8": 1, "coordinate_system": "acs"}, ""),
    ],
)
def test_bad_input(given: dict[str, object], sentence: str) -> None:
    with portal() as (engine, group):
        jog = engine.command("gantry", "jog", given).wait_final()
        assert jog.error
        assert sentence in jog.sentence
        engine.run(0.05)
        assert group.pose == (0, 0, 0, 0, 0, 0)


def test_refused_where_nothing_may_move() -> None:
    with takt.Engine(PORTAL) as engine:
        group = engine.group("gantry")
        assert group.jog(x=1).wait_final().error_id == 3025
        group.enable().wait()
        assert group.jog(x=1).wait_final().error_id == 10


CLIENT = """
import sys, time, takt
session = takt.connect(sys.argv[1], client="doomed")
group = session.group("gantry")
group.power().wait()
group.enable().wait()
group.jog(x=20.0).wait(until="active")
print("jogging", flush=True)
time.sleep(60)
"""


def test_the_dead_man_of_a_client(tmp_path: Path) -> None:
    """EN-23: a client that is killed in the middle of a jog."""
    url = new_url()
    with running(tmp_path, url, machine=PORTAL), takt.connect(url) as session:
        client = subprocess.Popen([sys.executable, "-c", CLIENT, url], stdout=subprocess.PIPE, text=True)
        assert client.stdout is not None
        assert client.stdout.readline() == "jogging\n"
        group = session.group("gantry")
        session.run(0.7)  # twice the dead man's time: it lives
        assert group.velocity == pytest.approx(20)
        client.send_signal(signal.SIGKILL)
        client.wait()
        session.wait(lambda: group.state is takt.GroupState.GROUP_STANDBY, 2.0, what="the group at rest")
        assert group.velocity == pytest.approx(0, abs=1e-9)
