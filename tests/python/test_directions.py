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


def geared_in_pos(s: takt.Engine, sense: int) -> Any:
    gear = s.axis("y").gear_in_pos(
        master="m", master_sync_position=30.0 * sense, slave_sync_position=20.0 * sense, master_start_distance=25
    )
    s.axis("m").move_velocity(velocity=150, direction="positive" if sense > 0 else "negative")
    return gear


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


def jogged(s: takt.Engine, sense: int) -> Any:
    s.group("portal").enable().wait()
    return s.group("portal").jog(y=50.0 * sense)


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
    "gear_in_pos": geared_in_pos,
    "cam_in": cammed,
    "stream": streamed,
    "combine_axes": summed,
    "group": grouped,
    "group stream": group_streamed,
    "group_jog": jogged,
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


@pytest.mark.parametrize("stop", ["halt", "stop", "power", "interrupt"])
def test_a_group_that_stops_is_left_to_it(s: takt.Engine, stop: str) -> None:
    """AX-111: a member's direction that is not enabled any more does not make a hard stop of a gentle one."""
    portal, x = s.group("portal"), s.axis("x")
    portal.power().wait()
    portal.enable().wait()
    portal.move_linear_absolute(x=400, velocity=200, acceleration=300, deceleration=300)
    s.run(1.2)
    ended = portal.power(enable=False) if stop == "power" else getattr(portal, stop)()
    s.step(20)
    assert x.set_velocity > 100
    x.power(enable_positive=False)
    assert ended.wait().done
    assert (portal.error, x.error) == (0, 0)


def test_a_path_that_is_continued_before_the_tool_rests_is_kept(s: takt.Engine) -> None:
    """AX-111: a direction that was taken away while it braked is a fault then, braked for along the path."""
    portal, x = s.group("portal"), s.axis("x")
    portal.power().wait()
    portal.enable().wait()
    portal.move_linear_absolute(x=400, y=80, velocity=200)
    s.run(0.5)
    record = s.record("portal")
    portal.interrupt()
    s.step(5)
    x.power(enable_positive=False)
    s.step(5)
    portal.continue_path()
    s.run(1)
    table = record.stop()["portal"]
    assert abs(table["y"] - 0.2 * table["x"]).max() < 1e-9
    assert (x.error, portal.state.value) == (DIRECTION, "GroupErrorStop")


@pytest.mark.parametrize("before", ["halt", "interrupt"])
def test_a_stream_behind_a_stop_minds_directions(s: takt.Engine, before: str) -> None:
    """AX-111, AX-114."""
    portal, x = s.group("portal"), s.axis("x")
    portal.power().wait()
    portal.enable().wait()
    portal.move_linear_absolute(x=400, velocity=200)
    s.run(0.5)
    getattr(portal, before)()
    s.step(20 if before == "halt" else 500)
    stream = portal.stream()
    portal.stream_point(x=portal.x + 200, y=0, z=0)
    s.wait(lambda: x.set_velocity > 20, 5)
    x.power(enable_positive=False)
    assert stream.wait_final().error_id == DIRECTION
    s.run(0.5)
    assert (x.error, portal.state.value) == (DIRECTION, "GroupErrorStop")


@pytest.mark.parametrize("barred", ["left", "right"])
@pytest.mark.parametrize("stop", ["halt", "stop"])
def test_a_gantry_that_stops_is_left_to_it(s: takt.Engine, stop: str, barred: str) -> None:
    """AX-111, AX-101: whichever of them may not move so any more."""
    left = s.axis("left")
    left.move_velocity(velocity=200).wait(until="reached")
    ended = getattr(left, stop)(deceleration=300)
    s.step(20)
    assert left.set_velocity > 100
    s.axis(barred).power(enable_positive=False)
    assert ended.wait().done
    s.run(0.1)
    assert (left.error, s.axis("right").error) == (0, 0)


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


def test_the_permits_are_shown(s: takt.Engine) -> None:
    """AX-111: in the state of the axis, and in what is recorded."""
    y = s.axis("y")
    assert (y.enable_positive, y.enable_negative) == (True, True)
    with s.record("y") as recorder:
        s.step(3)
        permit(s, -1, False)
        s.step(3)
    assert (y.enable_positive, y.enable_negative) == (True, False)
    assert list(recorder.recording["y"]["enable_negative"][[0, -1]]) == [True, False]
    assert recorder.recording["y"]["enable_positive"].all()


PROBED = (
    MACHINE
    + """\
simulation:
  servos:
    - {axis: y, switches: {touch_probe: {from: 20}}}
    - {axis: z, switches: {touch_probe: {to: -20}}}
"""
)


@pytest.mark.parametrize(("name", "sense"), [("y", 1), ("z", -1)])
def test_the_way_back_of_a_touch(name: str, sense: int) -> None:
    """AX-111: a touch whose way back is not enabled is refused at the touch; the motion goes on."""
    with takt.Engine(PROBED) as s:
        axis = s.axis(name)
        axis.power().wait()
        back = "enable_negative" if sense > 0 else "enable_positive"
        axis.power(**{back: False}).wait()
        touch = axis.touch()
        move = axis.move_velocity(velocity=200, direction="positive" if sense > 0 else "negative")
        s.run(1.0)
        assert touch.error_id == DIRECTION
        assert move.active
        assert sense * axis.set_velocity == 200
        axis.halt().wait()
        axis.power(**{back: True}).wait()
        axis.move_absolute(position=0).wait()
        touch = axis.touch()
        axis.move_velocity(velocity=200, direction="positive" if sense > 0 else "negative")
        s.run(1.5)
        assert touch.done
        assert sense * axis.set_position == pytest.approx(20, abs=0.01)


MODULES = """
name: modules
axes:
  - {name: x, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: y, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: z, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: web, kind: rotary, unit: deg, limits: {velocity: 720, acceleration: 7200, jerk: 100000}}
  - {name: knife, limits: {velocity: 2000, acceleration: 50000, jerk: 5000000}}
cams:
  - {name: hill, x_unit: deg, cyclic: true,
     points: [{x: 0, y: 0, v: 0, a: 0}, {x: 150, y: 20, v: 0, a: 0}, {x: 360, y: 0, v: 0, a: 0}]}
flex_cams:
  - name: cutter
    slave: knife
    master: web
    cams: [hill]
    settings: {sync_mode: ramp_time, sync_in_time_s: 0.3, sync_out_time_s: 0.2, slave_absolute: true,
               jog_velocity: 30, jog_acceleration: 1000, jog_deceleration: 1000, jog_jerk: 20000}
groups:
  - name: portal
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 1000, acceleration: 8000, jerk: 400000}
pick_and_place:
  - name: picker
    group: portal
    settings:
      {path_velocity: 1000, path_acceleration: 8000, path_deceleration: 8000, path_jerk: 400000, keep_orientation: true,
       blending_radius: 10, z_start_distance: 30, z_target_distance: 20, x_target: 100}
"""


def test_a_cam_module_names_the_direction() -> None:
    """AX-111: its jog is refused, and a cam that turns that way ends with 3103, before the first step."""
    with takt.Engine(MODULES) as s:
        knife, cutter = s.axis("knife"), s.flex_cam("cutter")
        s.axis("web").power().wait()
        cutter.control(regulator_on=True).wait()
        s.wait(lambda: cutter.axis_enabled, 2.0)
        knife.power(enable_negative=False).wait()
        with s.record("knife") as recorder:
            jog = cutter.jog(negative=True)
            s.run(0.3)
        assert jog.error_id == DIRECTION
        assert recorder.recording["knife"]["set_position"].min() > -1e-3
        cutter.jog(negative=False)
        cutter.control(reset_error=True)
        knife.reset()
        s.run(0.2)
        cutter.control(reset_error=False)
        s.axis("web").move_velocity(velocity=300).wait(until="reached")
        cutter.control(sync_cam=True)
        s.run(2.0)
        assert (knife.error, cutter.error) == (DIRECTION, DIRECTION)


def test_a_pick_and_place_module_names_the_direction() -> None:
    """AX-111: not a limit switch (20500), which there is none of; the motion is not begun."""
    with takt.Engine(MODULES) as s:
        picker = s.pick_place("picker")
        picker.configure(max_velocity=[0.0] * 7, max_acceleration=[0.0] * 7, max_jerk=[0.0] * 7).wait()
        picker.control(regulator_on=True).wait()
        s.run(0.5)
        s.axis("x").power(enable_positive=False).wait()
        going = picker.execute().wait_final()
        assert (going.error_id, picker.error) == (DIRECTION, DIRECTION)
        assert s.axis("x").set_position == pytest.approx(0, abs=1e-6)
