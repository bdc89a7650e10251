"""GR-03, GR-13, GR-24, GR-30, GR-47: where tracking, zones, interrupts, paths and changed members of groups meet."""

from __future__ import annotations

import numpy as np
import pytest
import takt

LIMITS = "limits: {velocity: 1000, acceleration: 10000, jerk: 500000}"
GANTRY = "kinematics: {gantry: {axes: [x, y, z]}}"
PATH = "path: {velocity: 100, acceleration: 2000, jerk: 100000}"


def axes(*names: str) -> str:
    return "axes:\n" + "".join(f"  - {{name: {name}, unit: mm, {LIMITS}}}\n" for name in names)


ON_BELT = f"""\
name: conveyors
{axes("x", "y", "z", "drive", "feed")}
groups:
  - {{name: gantry, axes: [x, y, z], {GANTRY}, path: {{velocity: 800, acceleration: 8000, jerk: 400000}}}}
belts:
  - {{name: infeed, axis: drive}}
"""
TWO = f"""\
name: two
{axes("x1", "y1", "z1", "x2", "y2", "z2")}
groups:
  - {{name: left, axes: [x1, y1, z1], {GANTRY}, {PATH}}}
  - {{name: right, axes: [x2, y2, z2], {GANTRY}, {PATH}}}
zones:
  - {{name: mid, lower: {{x: 109.5, y: 86.5, z: -10}}, upper: {{x: 113.5, y: 90.5, z: 10}}, margin: 1}}
"""
TURNED = f"""\
name: turned
axes:
  - {{name: x, unit: mm, {LIMITS}}}
  - {{name: y, unit: mm, limits: {{velocity: 1000, acceleration: 10000, jerk: 500000, lower: -300, upper: 300}}}}
  - {{name: z, unit: mm, {LIMITS}}}
  - {{name: c, unit: deg, limits: {{velocity: 720, acceleration: 7200, jerk: 360000}}}}
  - {{name: aux, unit: mm, {LIMITS}}}
groups:
  - name: gantry
    axes: [x, y, z, c, aux]
    kinematics: {{gantry: {{axes: [x, y, z, c]}}}}
    path: {{velocity: 300, acceleration: 3000, jerk: 60000}}
paths:
  - name: lines
    elements:
      - {{shape: line, to: {{x: 40, y: 0, z: 0}}}}
      - {{shape: arc, via_x: 55, via_y: 15, via_z: 0, to: {{x: 40, y: 30, z: 0}}}}
  - name: spline
    elements:
      - {{shape: spline, points: [{{x: 0, y: 0, z: 0}}, {{x: 40, y: 0, z: 0}}, {{x: 40, y: 30, z: 0}}]}}
  - name: turned_spline
    elements:
      - shape: spline
        points: [{{x: 0, y: 0, z: 0, a: 0, b: 0, c: 0}}, {{x: 40, y: 0, z: 0}}, {{x: 40, y: 30, z: 0}}]
"""
NOT_LEGAL = 3005


def enabled(text: str) -> takt.Engine:
    engine = takt.Engine(text)
    for axis in engine.axes.values():
        axis.power().wait()
    for group in engine.groups.values():
        group.enable().wait()
    return engine


@pytest.mark.parametrize("path", ["lines", "spline"])
def test_what_a_path_does_not_give_stays(path: str) -> None:
    """GR-22: orientation and auxiliary axes are where the path begins all along it."""
    engine = enabled(TURNED)
    gantry = engine.group("gantry")
    gantry.move_linear_absolute(c=30, a5=50).wait()
    engine.run(0.1)
    recorder = engine.record("gantry", "aux", "c")
    gantry.move_path(path=path).wait()
    engine.run(0.1)
    recording = recorder.stop()
    assert gantry.pose[:3] == pytest.approx((40, 30, 0), abs=1e-6)
    for axis, place in (("c", 30), ("aux", 50)):
        assert np.abs(recording[axis]["set_position"] - place).max() < 1e-6


def test_a_spline_begins_as_the_tool_is_turned() -> None:
    """GR-22: else the path would ask for a jump of the orientation."""
    engine = enabled(TURNED)
    gantry = engine.group("gantry")
    assert gantry.move_path(path="turned_spline").wait().done
    gantry.move_linear_absolute(x=0, y=0, c=90).wait()
    refused = gantry.move_path(path="turned_spline").wait_final()
    assert refused.sentence == "the points define no such path, in element 1"


def test_positions_are_defined_for_all_or_for_none() -> None:
    """GR-06: a command that is refused changes nothing; axes of the kinematics have numbers in ACS alone."""
    engine = enabled(TURNED)
    gantry = engine.group("gantry")
    assert gantry.define_position(a1=10, a2=999).wait_final().error_id != 0
    engine.run(0.01)
    assert gantry.pose[0] == pytest.approx(0, abs=1e-9)
    assert gantry.define_position(coordinate_system="mcs", a1=5).wait_final().error_id != 0
    assert gantry.define_position(coordinate_system="mcs", x=5, a5=7).wait_final().done
    engine.run(0.01)
    assert gantry.pose[0] == pytest.approx(5)
    assert engine.axis("aux").set_position == pytest.approx(7)


def test_positions_are_defined_beside_an_axis_outside_its_limits() -> None:
    """GR-06: as after the start, before anything has its reference."""
    away = TURNED.replace(
        f"name: aux, unit: mm, {LIMITS}", f"name: aux, unit: mm, {LIMITS[:-1]}, lower: 50, upper: 500}}"
    )
    assert away != TURNED
    engine = enabled(away)
    gantry = engine.group("gantry")
    assert gantry.define_position(coordinate_system="mcs", x=10).wait_final().done
    assert gantry.define_position(coordinate_system="mcs", x=20, a5=100).wait_final().done
    engine.run(0.01)
    assert gantry.pose[0] == pytest.approx(20)
    assert engine.axis("aux").set_position == pytest.approx(100)


def running_belt(speed: float = 100) -> tuple[takt.Engine, takt.Group, takt.Axis]:
    engine = enabled(ON_BELT)
    drive = engine.axis("drive")
    drive.move_velocity(velocity=speed)
    engine.run(0.3)
    return engine, engine.group("gantry"), drive


@pytest.mark.parametrize("change", ["kinematics", "member"])
def test_what_waits_for_an_object_keeps_its_kinematics(change: str) -> None:
    """GR-30: without them the tool would be nowhere when the object comes."""
    engine, gantry, _ = running_belt()
    gantry.move_linear_absolute(x=200, y=150, z=40).wait()
    tracking = gantry.track_conveyor_belt(belt="infeed", pcs=1, start_distance=50, y=150, x=0, z=40)
    engine.run(0.1)
    changed = gantry.set_kin_transform(enable=False) if change == "kinematics" else gantry.remove_axis(ident=3)
    assert changed.wait_final().error_id == NOT_LEGAL
    engine.run(2)
    assert gantry.y == pytest.approx(150, abs=1e-6)
    assert tracking.reached


@pytest.mark.parametrize("mode", ["queued", "immediately"])
@pytest.mark.parametrize("before", ["none", "far", "there", "both"])
def test_a_move_before_one_that_waits_for_its_object(mode: str, before: str) -> None:
    """GR-30: it is done when it has arrived; then the object is waited for, and tracked."""
    engine, gantry, _ = running_belt()
    moves = []
    tracking = None
    if mode == "immediately":
        tracking = gantry.track_conveyor_belt(belt="infeed", pcs=1, x=0, y=50, start_distance=150)
    if before in ("far", "both"):
        moves.append(gantry.move_linear_absolute(x=100))
    if before in ("there", "both"):
        moves.append(gantry.move_linear_absolute(x=100 if before == "both" else 0, buffer_mode="buffered"))
    engine.run(0.02)
    if mode == "queued":
        tracking = gantry.track_conveyor_belt(
            belt="infeed", pcs=1, x=0, y=50, start_distance=150, execution_mode="queued"
        )
    last = gantry.move_linear_absolute(x=10, y=0, z=0, coordinate_system="pcs", pcs=1, buffer_mode="buffered")
    engine.run(0.9)
    assert all(move.done for move in moves)
    engine.run(3)
    assert last.done
    assert tracking is not None
    assert tracking.reached
    assert gantry.object_x == pytest.approx(10, abs=0.01)


@pytest.mark.parametrize("how", ["aborted", "switched off"])
def test_an_interrupt_before_the_motion_lets_go_of_nothing_later(how: str) -> None:
    """GR-24, GR-30: the next move onto a belt gets into step."""
    engine, gantry, drive = running_belt(speed=0)
    gantry.move_linear_absolute(x=10, y=5)
    gantry.interrupt()
    engine.run(0.05)
    if how == "switched off":
        engine.axis("x").power(enable=False).wait()
        engine.axis("x").power().wait()
    drive.move_velocity(velocity=100)
    engine.run(0.5)
    gantry.set_dyn_coord_transform(pcs=1, carrier="infeed", x=50).wait()
    move = gantry.move_linear_absolute(x=0, y=0, z=0, coordinate_system="pcs", pcs=1)
    engine.run(1.5)
    assert move.done
    assert gantry.in_sync
    assert gantry.object_x == pytest.approx(0, abs=0.01)


@pytest.mark.parametrize("lines", [2, 3])
def test_a_blend_that_cuts_a_zone_waits_however_much_is_planned(lines: int) -> None:
    """GR-47: a blend through a zone counts as the move behind it does."""
    engine = enabled(TWO)
    left, right = engine.group("left"), engine.group("right")
    right.move_linear_absolute(x=111.5, y=88.5).wait()
    blending = {"buffer_mode": "blending_high", "transition_mode": "corner_distance", "transition_parameter": 50}
    if lines == 2:
        left.move_linear_absolute(x=100, y=0).wait()
        left.move_linear_absolute(x=100, y=100)
    else:
        left.move_linear_absolute(x=100, y=0)
        left.move_linear_absolute(x=100, y=100, **blending)
    last = left.move_linear_absolute(x=200, y=100, **blending)
    engine.run(4)
    assert left.pose[:2] == pytest.approx((100, 100), abs=1e-6)
    assert left.waiting
    right.move_linear_absolute(x=300, y=300).wait()
    assert last.wait().done


@pytest.mark.parametrize("waits", [False, True])
@pytest.mark.parametrize("what", ["kinematics", "member", "all members", "tool", "position"])
def test_a_tool_that_carries_another_stays(what: str, waits: bool) -> None:
    """GR-05, GR-30: what takes the tool of a group away, or makes it jump, is refused while another rides on it, and
    while a move waits that will."""
    engine = enabled(TWO)
    left, right = engine.group("left"), engine.group("right")
    left.move_linear_absolute(x=200, y=100).wait()
    right.set_dyn_coord_transform(pcs=1, carrier="left", x=10).wait()
    if waits:
        right.move_linear_absolute(x=300, y=300)
        mode = "buffered"
    else:
        mode = "aborting"
    move = right.move_linear_absolute(x=0, y=0, z=20, coordinate_system="pcs", pcs=1, buffer_mode=mode)
    if not waits:
        move.wait()
    engine.run(0.1)
    commands = {
        "kinematics": lambda: left.set_kin_transform(enable=False),
        "member": lambda: left.remove_axis(ident=3),
        "all members": lambda: left.ungroup_all_axes(),
        "tool": lambda: left.set_tool(x=50),
        "position": lambda: left.define_position(a1=150, coordinate_system="acs"),
    }
    assert commands[what]().wait_final().error_id == NOT_LEGAL
    engine.run(10 if waits else 0.5)
    assert right.pose[:3] == pytest.approx((210, 100, 20), abs=1e-6)
    right.stop().wait()
    right.move_linear_absolute(x=0).wait()
    assert commands[what]().wait_final().done


def test_a_disabled_group_has_no_command() -> None:
    """GR-02: nothing of a motion that was broken off is published on."""
    engine = enabled(ON_BELT)
    gantry = engine.group("gantry")
    gantry.move_linear_absolute(x=500)
    engine.run(0.1)
    assert gantry.command != 0
    gantry.disable().wait()
    engine.run(0.2)
    assert gantry.command == 0
    assert not gantry.synchronized


def test_a_jog_keeps_its_lease_through_an_interrupt() -> None:
    """GR-48, EN-23: without heartbeats it ends, whatever has come between."""
    engine = enabled(ON_BELT)
    gantry = engine.group("gantry")
    engine._core.resubmit("gantry", "jog", '{"z": 20}', 10**9, 0.3)
    engine.run(0.1)
    gantry.interrupt().wait()
    gantry.continue_path().wait()
    engine.run(0.1)
    assert gantry.z > 0
    engine.run(0.5)
    assert gantry.velocity == 0
    assert gantry.state == "GroupStandby"
