"""MC_Power's EnablePositive and EnableNegative against every kind of motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import takt
from takt.plcopen import MC_MoveVelocity, MC_Power

DIRECTION = 3103
MACHINE = """
name: directions
axes:
  - {name: x, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: y, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: z, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: m, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: left, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: right, limits: {velocity: 300, acceleration: 3000, jerk: 60000}, follows: {axis: left}}
cams:
  - {name: hill, cyclic: true,
     points: [{x: 0, y: 0, v: 0, a: 0}, {x: 60, y: 20, v: 0, a: 0}, {x: 120, y: 0, v: 0, a: 0}]}
  - {name: way, points: [{x: 0, y: 0, v: 0, a: 0}, {x: 2, y: 100, v: 0, a: 0}]}
  - {name: speed, points: [{x: 0, y: 0, v: 0, a: 0}, {x: 1, y: 100, v: 0, a: 0}]}
groups:
  - {name: portal, axes: [x, y, z], kinematics: {gantry: {axes: [x, y, z]}},
     path: {velocity: 300, acceleration: 3000, jerk: 60000}}
"""
Start = Callable[[takt.Engine, int], Any]


def geared(s: takt.Engine, sense: int) -> Any:
    gear = s.axis("y").gear_in(master="m")
    s.axis("m").move_velocity(velocity=50, direction="positive" if sense > 0 else "negative")
    return gear


def summed(s: takt.Engine, sense: int) -> Any:
    total = s.axis("y").combine_axes(master1="m", master2="z")
    s.axis("m").move_velocity(velocity=50, direction="positive" if sense > 0 else "negative")
    return total


def cammed(s: takt.Engine, sense: int) -> Any:
    cam = s.axis("y").cam_in(master="m", cam="hill", slave_scaling=float(sense))
    s.axis("m").move_velocity(velocity=50)
    return cam


def streamed(s: takt.Engine, sense: int) -> Any:
    y = s.axis("y")
    stream = y.stream(key=7, delay=0.01, timeout=1.0)
    for i in range(60):
        y.stream_point(key=7, position=sense * 0.0015 * i * i)
        s.step(1)
    return stream


def grouped(s: takt.Engine, sense: int) -> Any:
    s.group("portal").enable().wait()
    return s.group("portal").move_linear_absolute(x=0, y=150 * sense, z=0, velocity=100)


def group_streamed(s: takt.Engine, sense: int) -> Any:
    portal = s.group("portal")
    portal.enable().wait()
    stream = portal.stream(key=7, delay=0.01, timeout=1.0)
    for i in range(60):
        portal.stream_point(key=7, y=sense * 0.0015 * i * i)
        s.step(1)
    return stream


KINDS: dict[str, Start] = {
    "move_absolute": lambda s, k: s.axis("y").move_absolute(position=150 * k),
    "move_relative": lambda s, k: s.axis("y").move_relative(distance=150 * k),
    "move_additive": lambda s, k: s.axis("y").move_additive(distance=150 * k),
    "move_velocity": lambda s, k: s.axis("y").move_velocity(velocity=50, direction="positive" if k > 0 else "negative"),
    "move_continuous_absolute": lambda s, k: s.axis("y").move_continuous_absolute(position=150 * k, end_velocity=20),
    "move_continuous_relative": lambda s, k: s.axis("y").move_continuous_relative(distance=150 * k, end_velocity=20),
    "inch": lambda s, k: s.axis("y").inch(distance=50 * k),
    "jog": lambda s, k: s.axis("y").jog(forward=k > 0, backward=k < 0),
    "torque_control": lambda s, k: s.axis("y").torque_control(torque=2 * k, velocity=50),
    "move_superimposed": lambda s, k: s.axis("y").move_superimposed(distance=100 * k),
    "position_profile": lambda s, k: s.axis("y").position_profile(profile="way", position_scale=float(k)),
    "velocity_profile": lambda s, k: s.axis("y").velocity_profile(profile="speed", velocity_scale=float(k)),
    "acceleration_profile": lambda s, k: s.axis("y").acceleration_profile(profile="speed", acceleration_scale=float(k)),
    "step_abs_switch": lambda s, k: s.axis("y").step_abs_switch(
        direction="positive" if k > 0 else "negative", switch_mode="is_on", velocity=50
    ),
    "gear_in": geared,
    "cam_in": cammed,
    "stream": streamed,
    "combine_axes": summed,
    "group": grouped,
    "group stream": group_streamed,
}


@pytest.fixture
def s() -> Any:
    with takt.Engine(MACHINE) as engine:
        for feedback in [axis.power() for axis in engine.axes.values()]:
            feedback.wait()
        yield engine


def permit(s: takt.Engine, sense: int, allowed: bool) -> None:
    which = "enable_positive" if sense > 0 else "enable_negative"
    assert s.axis("y").power(**{which: allowed}).wait().done


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("kind", KINDS)
def test_no_motion_begins_in_a_direction_that_is_not_enabled(s: takt.Engine, kind: str, sense: int) -> None:
    """AX-111: refused, or for what follows something ended before its first step; the other direction is free."""
    y = s.axis("y")
    permit(s, sense, False)
    with s.record("y") as recorder:
        given = KINDS[kind](s, sense)
        s.run(0.8)
    assert given.error
    assert given.error_id == DIRECTION, given.sentence
    assert y.error in (0, DIRECTION)
    assert (sense * recorder.recording["y"]["set_position"]).max() < 1e-3
    s.group("portal").disable()
    for axis in s.axes.values():
        axis.halt()
    s.run(0.3)
    y.reset().wait()
    assert y.move_relative(distance=-5 * sense).wait().done
    permit(s, sense, True)
    assert y.move_relative(distance=5 * sense).wait().done


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("kind", KINDS)
def test_a_motion_in_progress_ends(s: takt.Engine, kind: str, sense: int) -> None:
    """AX-111: withdrawn on the way, the axis brakes within its limits into ErrorStop, as at a limit switch."""
    y = s.axis("y")
    given = KINDS[kind](s, sense)
    s.run(0.25)
    assert sense * y.set_velocity > 0.5, "the case is to move by now"
    with s.record("y") as recorder:
        permit(s, -sense, False)
        s.run(0.05)
        assert not given.error
        permit(s, sense, False)
        s.run(0.6)
    assert given.error
    assert (y.state.value, y.error) == ("ErrorStop", DIRECTION)
    assert y.set_velocity == 0
    if kind != "torque_control":
        takt.expect.within_limits(recorder.recording, "y")
    assert y.move_relative(distance=1).wait_final().error


def test_stops_are_stops(s: takt.Engine) -> None:
    """AX-111: what brakes anyway does so in peace; standing, nothing happens."""
    y = s.axis("y")
    for stop in (y.halt, y.stop):
        permit(s, 1, True)
        y.move_velocity(velocity=200)
        s.run(0.3)
        ended = stop()
        s.step(2)
        permit(s, 1, False)
        assert ended.wait_final().done
        s.run(0.2)
        assert (y.state.value, y.error) == ("Standstill", 0)


def test_members_of_a_gantry(s: takt.Engine) -> None:
    """AX-111: what one of them may not, none may."""
    left, right = s.axis("left"), s.axis("right")
    right.power(enable_positive=False).wait()
    assert left.move_relative(distance=20).wait_final().error_id == DIRECTION
    assert left.move_relative(distance=-20).wait().done
    right.power(enable_positive=True).wait()
    left.move_velocity(velocity=50)
    s.run(0.3)
    right.power(enable_positive=False).wait()
    s.run(0.5)
    assert right.error == DIRECTION
    assert (left.state.value, left.set_velocity) == ("ErrorStop", 0)


def test_bad_input_and_every_state(s: takt.Engine) -> None:
    """AX-111: not a truth value is refused and changes nothing; power that names no direction leaves them."""
    y = s.axis("y")
    wrong = s.command("y", "power", {"enable_positive": 3.5})
    assert wrong.wait_final().error
    permit(s, 1, False)
    y.power().wait()
    assert y.move_relative(distance=5).wait_final().error_id == DIRECTION
    y.power(enable=False).wait()
    y.power().wait()
    assert y.move_relative(distance=5).wait_final().error_id == DIRECTION
    y.move_velocity(velocity=50, direction="negative")
    s.run(0.2)
    refused = y.power(enable_positive=True, enable_negative=False)
    s.run(0.3)
    assert refused.done
    assert y.state.value == "ErrorStop"
    assert y.power(enable_negative=True).wait_final().error_id == 11  # not in ErrorStop
    y.reset().wait()
    assert y.move_relative(distance=-5).wait_final().error_id == DIRECTION
    assert y.move_relative(distance=5).wait().done


def test_the_block_tells_changes(s: takt.Engine) -> None:
    """AX-111: EnablePositive and EnableNegative count whenever they change."""
    y = s.axis("y")
    power, move = MC_Power(y), MC_MoveVelocity(y, Velocity=50.0)

    def run(seconds: float, **inputs: bool) -> None:
        for _ in range(round(seconds / s.period)):
            power(Enable=True, **inputs)
            move()
            s.step()

    run(0.01, EnablePositive=False)
    move(Execute=True)
    run(0.05)
    assert move.ErrorID == DIRECTION
    assert power.Status
    assert not power.Error
    move(Execute=False)
    run(0.05, EnablePositive=True)
    move(Execute=True)
    run(0.4)
    assert move.InVelocity
    run(0.4, EnablePositive=False)
    assert move.ErrorID == DIRECTION
    assert y.state.value == "ErrorStop"
