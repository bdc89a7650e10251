"""Blocks whose inputs change while they are executed."""

from __future__ import annotations

from typing import Any

import pytest
import takt
from takt.plcopen import (
    MC_AccelerationProfile,
    MC_CamIn,
    MC_GearIn,
    MC_MoveAbsolute,
    MC_MoveAdditive,
    MC_MoveContinuousAbsolute,
    MC_MoveContinuousRelative,
    MC_MoveRelative,
    MC_MoveSuperimposed,
    MC_MoveVelocity,
    MC_PhasingAbsolute,
    MC_PositionProfile,
    MC_TorqueControl,
    MC_VelocityProfile,
    SelectedCam,
)

MACHINE = """
name: updates
axes:
  - {name: x, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: y, limits: {velocity: 600, acceleration: 6000, jerk: 120000}}
cams:
  - {name: hill, cyclic: true,
     points: [{x: 0, y: 0, v: 0, a: 0}, {x: 60, y: 20, v: 0, a: 0}, {x: 120, y: 0, v: 0, a: 0}]}
  - {name: way, points: [{x: 0, y: 0, v: 0, a: 0}, {x: 2, y: 50, v: 0, a: 0}]}
  - {name: speed, points: [{x: 0, y: 0, v: 0, a: 0}, {x: 1, y: 100, v: 0, a: 0}]}
"""


def run(s: takt.Engine, block: Any, seconds: float, **inputs: Any) -> None:
    for _ in range(round(seconds / s.period)):
        block(Execute=True, **inputs)
        s.step()


@pytest.fixture
def s() -> Any:
    with takt.Engine(MACHINE) as engine:
        for axis in engine.axes.values():
            axis.power().wait()
        yield engine


@pytest.mark.parametrize("updates", [True, False])
@pytest.mark.parametrize(
    ("block_of", "first", "then", "ends"),
    [
        (MC_MoveAbsolute, {"Position": 60.0}, {"Position": 85.0}, 85.0),
        (MC_MoveAbsolute, {"Position": 60.0}, {"Position": 10.0}, 10.0),
        (MC_MoveRelative, {"Distance": 60.0}, {"Distance": 47.5}, 47.5),
        (MC_MoveAdditive, {"Distance": 60.0}, {"Distance": 72.5}, 72.5),
    ],
)
def test_a_position_changes_on_the_way(
    s: takt.Engine, updates: bool, block_of: Any, first: dict[str, float], then: dict[str, float], ends: float
) -> None:
    """AX-111: with ContinuousUpdate at the rising edge, and only then; a distance counts from where the move began."""
    x = s.axis("x")
    block = block_of(x, Velocity=120.0, ContinuousUpdate=updates)
    with s.record("x") as recorder:
        run(s, block, 0.3, **first)
        run(s, block, 1.5, **then)
    assert block.Done
    assert not block.CommandAborted
    assert x.set_position == pytest.approx(ends if updates else 60.0)
    takt.expect.within_limits(recorder.recording, "x")


def test_velocities_gears_and_torques_change(s: takt.Engine) -> None:
    """AX-111: InVelocity, InGear and InTorque fall and rise again."""
    x, y = s.axis("x"), s.axis("y")
    move = MC_MoveVelocity(x, ContinuousUpdate=True)
    run(s, move, 0.4, Velocity=80.0)
    assert (move.InVelocity, x.set_velocity) == (True, 80)
    move(Velocity=140.0)
    s.step(3)
    assert not move().InVelocity
    run(s, move, 0.4)
    assert (move.InVelocity, x.set_velocity) == (True, 140)
    gear = MC_GearIn(y, Master=x, ContinuousUpdate=True)
    for ratio in (1.0, 2.5, -1.0):
        run(s, gear, 0.6, RatioNumerator=ratio)
        assert gear.InGear
        assert y.set_velocity == pytest.approx(140 * ratio)
    run(s, move, 0.4, Velocity=1000.0)  # more than the axis can
    assert move.Error
    assert "velocity" in move.ErrorText
    assert x.set_velocity == 140
    torque = MC_TorqueControl(y, ContinuousUpdate=True, Torque=4.0)
    run(s, torque, 0.5, Velocity=50.0)
    run(s, torque, 0.8, Velocity=90.0)
    assert y.actual_velocity == pytest.approx(90, abs=1)
    onwards = MC_MoveContinuousAbsolute(x, Position=900.0, EndVelocity=50.0, Velocity=100.0, ContinuousUpdate=True)
    run(s, onwards, 0.2)
    run(s, onwards, 0.5, EndVelocity=20.0, Position=x.set_position + 30)
    assert onwards.InEndVelocity
    assert x.set_velocity == pytest.approx(20)


def test_what_waits_changes_when_its_turn_comes(s: takt.Engine) -> None:
    """AX-111: a buffered block is not given twice."""
    x = s.axis("x")
    first = MC_MoveAbsolute(x, Position=30.0, Velocity=100.0)
    second = MC_MoveAbsolute(x, Position=50.0, Velocity=100.0, BufferMode=1, ContinuousUpdate=True)
    for i in range(1500):
        first(Execute=True)
        second(Execute=i > 3, Position=50.0 if i < 50 else 70.0)
        s.step()
    assert first.Done
    assert second.Done
    assert x.set_position == pytest.approx(70)


def test_a_continuous_distance_counts_from_its_beginning(s: takt.Engine) -> None:
    """AX-111: MC_MoveContinuousRelative, changed twice on the way."""
    x = s.axis("x")
    x.move_absolute(position=13).wait()
    block = MC_MoveContinuousRelative(x, EndVelocity=20.0, Velocity=100.0, ContinuousUpdate=True)
    with s.record("x") as recorder:
        run(s, block, 0.3, Distance=80.0)
        run(s, block, 0.1, Distance=90.0)
        run(s, block, 1.0, Distance=70.0)
    r = recorder.recording["x"]
    assert block.InEndVelocity
    at_end = r["set_position"][abs(r["set_velocity"] - 20) < 1e-9]
    assert at_end[0] == pytest.approx(83, abs=0.05)
    takt.expect.within_limits(recorder.recording, "x")


@pytest.mark.parametrize("block_of", [MC_MoveContinuousAbsolute, MC_MoveContinuousRelative])
@pytest.mark.parametrize(("factor", "velocity"), [(0.5, 20.0), (1.0, 40.0), (2.0, 80.0), (10.0, 300.0)])
def test_the_end_velocity_is_scaled_by_the_override(
    s: takt.Engine, block_of: Any, factor: float, velocity: float
) -> None:
    """AX-51: InEndVelocity with the end velocity that the override makes of it; not while the axis is held."""
    x = s.axis("x")
    x.set_override(velocity_factor=factor).wait()
    place = {"Position": 10.0} if block_of is MC_MoveContinuousAbsolute else {"Distance": 10.0}
    block = block_of(x, EndVelocity=40.0, Velocity=100.0, **place)
    while not block(Execute=True).InEndVelocity:
        assert s.now < 5
        s.step()
    assert x.set_velocity == pytest.approx(velocity)
    assert x.set_position >= 10
    x.set_override(velocity_factor=0.0).wait()
    run(s, block, 0.5)
    assert (x.set_velocity, block(Execute=True).InEndVelocity) == (0, False)
    x.set_override(velocity_factor=0.25).wait()
    run(s, block, 0.5)
    assert (x.set_velocity, block(Execute=True).InEndVelocity) == (pytest.approx(10), True)


def test_the_end_velocity_is_that_of_the_limit_in_force(s: takt.Engine) -> None:
    """AX-51, AX-28: an override above 1 counts as far as the largest velocity that was written."""
    x = s.axis("x")
    x.write_parameter(number=9, value=50).wait()
    x.set_override(velocity_factor=2).wait()
    block = MC_MoveContinuousAbsolute(x, Position=30.0, EndVelocity=40.0, Velocity=50.0)
    while not block(Execute=True).InEndVelocity:
        assert s.now < 5
        s.step()
    assert x.set_velocity == pytest.approx(50)
    x.set_override(velocity_factor=1.1)
    shown = []
    for _ in range(300):
        s.step()
        if block().InEndVelocity:
            shown.append(x.set_velocity)
    assert block.InEndVelocity
    assert shown == pytest.approx([44] * len(shown))


@pytest.mark.parametrize("direction", ["positive", "negative"])
def test_in_velocity_is_scaled_by_the_override(s: takt.Engine, direction: str) -> None:
    """AX-51, AX-11: InVelocity while the set point has the velocity that the override makes of the commanded one; not
    on the way there, nor while the axis is held. The velocity of a motion on top does not count."""
    x = s.axis("x")
    block = MC_MoveVelocity(x, Velocity=100.0, Direction=direction)
    run(s, block, 0.5)
    assert block.InVelocity
    for factor, velocity in ((0.5, 50), (0.0, 0), (1.0, 100), (2.5, 250), (10.0, 300), (3.0, 300), (0.2, 20)):
        x.set_override(velocity_factor=factor)
        passed = []
        for _ in range(500):
            s.step()
            if block().InVelocity:
                passed.append(abs(x.set_velocity))
        assert abs(x.set_velocity) == pytest.approx(velocity)
        assert block.InVelocity is (factor > 0)
        assert passed == pytest.approx([velocity] * len(passed))
    x.set_override(velocity_factor=1).wait()
    run(s, block, 0.5)
    added = x.move_superimposed(distance=-20, velocity_difference=30)
    while not added.final:
        s.step()
        assert block().InVelocity
    block(Execute=False)
    assert not block().InVelocity
    x.halt().wait()
    rest = MC_MoveVelocity(x, Velocity=0.0)
    run(s, rest, 0.1)
    assert rest.InVelocity


@pytest.mark.parametrize("beneath", [False, True])
def test_what_is_on_top_counts_from_its_beginning(s: takt.Engine, beneath: bool) -> None:
    """AX-111: MC_MoveSuperimposed adds the new distance in all, also less than it has added already."""
    x = s.axis("x")
    if beneath:
        x.move_velocity(velocity=40)
    block = MC_MoveSuperimposed(x, VelocityDiff=50.0, ContinuousUpdate=True)
    run(s, block, 0.3, Distance=40.0)
    covered = block.CoveredDistance
    assert 5 < covered < 40
    run(s, block, 0.002, Distance=25.0)
    assert covered < block.CoveredDistance < covered + 1
    run(s, block, 1.5, Distance=2.0)
    assert block.Done
    assert block.CoveredDistance == pytest.approx(2)
    block(Execute=False)
    bad = MC_MoveSuperimposed(x, VelocityDiff=50.0, ContinuousUpdate=True)
    run(s, bad, 0.1, Distance=20.0)
    run(s, bad, 0.01, VelocityDiff=-1.0)
    assert bad.Error
    s.run(1)
    assert not x.superimposed


def test_tables_go_on_at_their_place(s: takt.Engine) -> None:
    """AX-111: scales of a profile change where it is, not from its beginning."""
    x = s.axis("x")
    block = MC_PositionProfile(x, TimePosition="way", ContinuousUpdate=True)
    with s.record("x") as recorder:
        run(s, block, 1.0)
        assert x.set_position == pytest.approx(25, abs=0.2)
        run(s, block, 0.5, PositionScale=0.5)
        run(s, block, 0.9, TimeScale=2.0)
        assert not block.Done
        run(s, block, 0.2)
    assert block.Done  # 0.5 s of the table were left, 1 s twice as slow
    assert x.set_position == pytest.approx(25)
    takt.expect.within_limits(recorder.recording, "x")
    speeds = MC_VelocityProfile(x, TimeVelocity="speed", ContinuousUpdate=True)
    run(s, speeds, 0.5)
    run(s, speeds, 0.3, VelocityScale=-1.0)
    assert x.set_velocity == pytest.approx(-94.2, abs=0.5)  # of the table at 0.8 s
    run(s, speeds, 0.01, VelocityScale=50.0)  # beyond the axis
    assert speeds.Error
    run(s, speeds, 0.3)
    assert -101 < x.set_velocity < -50
    ramps = MC_AccelerationProfile(x, TimeAcceleration="speed", ContinuousUpdate=True)
    before = x.set_velocity
    run(s, ramps, 0.5)
    run(s, ramps, 0.6, AccelerationScale=0.0)
    assert ramps.Done
    assert before + 5 < x.set_velocity < before + 50


@pytest.mark.parametrize("absolute", [True, False])
@pytest.mark.parametrize("change", ["slave_scale", "slave_offset", "master_offset", "master_scale"])
def test_a_cam_stays_where_it_is(s: takt.Engine, absolute: bool, change: str) -> None:
    """AX-111: MC_CamIn goes on with other scales and offsets, and does not begin anew."""
    x, y = s.axis("x"), s.axis("y")
    table = SelectedCam("hill", None, absolute, absolute)
    y.move_absolute(position=7).wait()
    x.move_absolute(position=11).wait()
    x.move_velocity(velocity=50)
    s.run(0.2)
    block = MC_CamIn(y, Master=x, CamTableID=table, ContinuousUpdate=True)
    run(s, block, 2.0)
    assert block.InSync
    with s.record("y") as recorder:
        new = {
            "slave_scale": {"SlaveScaling": 0.5},
            "slave_offset": {"SlaveOffset": 3.0},
            "master_offset": {"MasterOffset": 10.0},
            "master_scale": {"MasterScaling": 1.2},
        }[change]
        run(s, block, 1.0, **new)
    assert block.InSync
    takt.expect.within_limits(recorder.recording, "y")
    again = MC_CamIn(y, Master=x, CamTableID=table, ContinuousUpdate=True, **new)
    if absolute:  # a new block finds the cam laid as it is: the axis goes on without a correction
        with s.record("y") as recorder:
            run(s, again, 0.2)
        assert again.InSync
        assert abs(recorder.recording["y"]["set_acceleration"]).max() < 500
    block(Execute=True, SlaveScaling=float("nan"))
    s.step()
    block()
    assert block.Error or block.CommandAborted


@pytest.mark.parametrize("sync", [{}, {"MasterSyncPosition": 30.0}])
@pytest.mark.parametrize("at", [25.0, 275.0, -410.0])
def test_a_cam_of_another_length_counts_from_the_zero_of_its_master(s: takt.Engine, at: float, sync: Any) -> None:
    """AX-111: in each cycle of an absolute cam the slave is where a new block puts it."""
    x, y = s.axis("x"), s.axis("y")
    x.move_absolute(position=at - 50).wait()
    if sync:
        x.move_absolute(position=0).wait()
    block = MC_CamIn(y, Master=x, CamTableID=SelectedCam("hill", None, True, True), ContinuousUpdate=True, **sync)
    run(s, block, 0.1)
    x.move_absolute(position=60 if sync else at)
    run(s, block, 4)
    x.move_absolute(position=at)
    run(s, block, 4)
    places = []
    for scaling in (1.0, 1.25, 1.0):
        run(s, block, 1, MasterScaling=scaling)
        assert block.InSync
        places.append(y.set_position)
    again = MC_CamIn(y, Master=x, CamTableID=SelectedCam("hill", None, True, True))
    for scaling, place in zip((1.0, 1.25), places, strict=False):
        again(Execute=False)
        run(s, again, 1, MasterScaling=scaling)
        assert again.InSync
        assert y.set_position == pytest.approx(place)
    assert places[2] == pytest.approx(places[0])
    assert abs(places[1] - places[0]) > 1


@pytest.mark.parametrize("distance", [None, 10.0])
@pytest.mark.parametrize(("at", "sync"), [(60.0, 30.0), (25.0, 30.0), (275.0, 30.0), (-410.0, 30.0), (150.0, 90.0)])
def test_a_relative_cam_of_another_length_counts_from_its_sync_position(
    s: takt.Engine, at: float, sync: float, distance: float | None
) -> None:
    """AX-111: in each cycle the slave is where the cam is that begins at the sync position."""
    x, y = s.axis("x"), s.axis("y")
    given = {"MasterSyncPosition": sync} | ({} if distance is None else {"MasterStartDistance": distance})
    block = MC_CamIn(y, Master=x, CamTableID=SelectedCam("hill", None, False, True), ContinuousUpdate=True, **given)
    run(s, block, 0.1)
    x.move_absolute(position=sync + 10)
    run(s, block, 3)
    x.move_absolute(position=at)
    run(s, block, 4)
    for scaling in (1.0, 1.25, 1.0001, 1.0):
        run(s, block, 1, MasterScaling=scaling)
        assert block.InSync
        u = 1 - abs((at - sync) * scaling % 120 / 60 - 1)
        assert y.set_position == pytest.approx(20 * u**3 * (10 - 15 * u + 6 * u * u), abs=1e-6)


@pytest.mark.parametrize("modulus", [None, 360])
@pytest.mark.parametrize("shift", [-50.0, 30.0])
@pytest.mark.parametrize("scaling", [None, 1.0, 1.5])
def test_a_cam_that_waits_keeps_its_phase(modulus: int | None, shift: float, scaling: float | None) -> None:
    """AX-111: a change of MC_CamIn before the sync position does not move it by the phase."""
    rotary = f", kind: rotary, modulus: {modulus}" if modulus else ""
    machine = MACHINE.replace("{name: x,", f"{{name: x{rotary},")
    with takt.Engine(machine) as s:
        x, y = s.axis("x"), s.axis("y")
        x.power().wait()
        y.power().wait()
        given = {"master": "x", "cam": "hill", "master_sync_position": 100, "master_start_distance": 20}
        y.cam_in(**given)
        y.phasing_absolute(phase_shift=shift).wait(until="active")
        s.run(1.0)  # the shift is over
        x.move_absolute(position=70 - shift).wait()  # with -50 behind the position, but for the phase
        if scaling:
            y.cam_in(**given, slave_scaling=scaling, update=True)
        x.move_absolute(position=95 - shift).wait()
        assert not y.in_step
        x.move_absolute(position=130 - shift).wait()
        s.run(0.5)
        assert y.in_step
        assert y.set_position == pytest.approx(20 * (scaling or 1) * _law((130 % 120) / 60), abs=1e-6)


def _law(share: float) -> float:
    return share**3 * (10 - 15 * share + 6 * share**2)


@pytest.mark.parametrize(
    ("block_of", "inputs", "changes"),
    [
        (MC_MoveVelocity, {}, {"Velocity": 100.0}),
        (MC_MoveAbsolute, {"Position": 900.0}, {"Velocity": 100.0}),
        (MC_MoveRelative, {"Distance": 900.0}, {"Distance": 900.0}),
        (MC_MoveContinuousAbsolute, {"Position": 900.0, "EndVelocity": 5.0}, {"Velocity": 100.0}),
        (MC_MoveContinuousRelative, {"Distance": 900.0, "EndVelocity": 5.0}, {"Velocity": 100.0}),
        (MC_TorqueControl, {"Velocity": 50.0}, {"Torque": 0.1}),
        (MC_MoveSuperimposed, {"Distance": 900.0}, {"VelocityDiff": 50.0}),
        (MC_GearIn, {"Master": "y"}, {"RatioNumerator": 1.0}),
    ],
)
@pytest.mark.parametrize("stop", ["halt", "stop", "stop_all", "profile", "power"])
def test_a_change_never_takes_over_from_another_command(
    s: takt.Engine, block_of: Any, inputs: dict[str, Any], changes: dict[str, float], stop: str
) -> None:
    """AX-111: an input that changes in every cycle does not swallow what another program has given meanwhile."""
    x = s.axis("x")
    s.axis("y").move_velocity(velocity=20)
    (name, value) = next(iter(changes.items()))
    block = block_of(x, ContinuousUpdate=True, Execute=True, **inputs)
    for step in range(300):
        block(**{name: value + 0.001 * (step % 7)})
        s.step()
    others = {
        "halt": x.halt,
        "stop": x.stop,
        "stop_all": lambda: s.command("machine", "stop_all"),
        "profile": lambda: x.position_profile(profile="way"),
        "power": lambda: x.power(enable=False),
    }
    other = others[stop]()
    for step in range(3000):
        block(**{name: value + 0.001 * (step % 7)})
        s.step()
    assert other.done
    assert x.set_velocity == 0
    assert block.CommandAborted
    assert not block.Busy


@pytest.mark.parametrize(
    ("verb", "arguments"),
    [
        ("move_continuous_relative", {"distance": 20.0, "end_velocity": 10.0}),
        ("move_continuous_absolute", {"position": 20.0, "end_velocity": 10.0}),
        ("move_absolute", {"position": 2000.0}),
        ("move_additive", {"distance": 2000.0}),
        ("move_velocity", {"velocity": 20.0}),
        ("torque_control", {"torque": 0.1, "velocity": 20.0}),
        ("gear_in", {"master": "y"}),
        ("combine_axes", {"master1": "y", "master2": "y"}),
        ("move_superimposed", {"distance": 20.0}),
        ("position_profile", {"profile": "way"}),
        ("velocity_profile", {"profile": "speed"}),
        ("acceleration_profile", {"profile": "speed"}),
        ("cam_in", {"master": "y", "cam": "hill", "slave_absolute": False}),
    ],
)
def test_what_is_not_there_cannot_be_changed(s: takt.Engine, verb: str, arguments: dict[str, Any]) -> None:
    """AX-111: `update` takes nothing from another command: aborted where no such command is in control."""
    x = s.axis("x")
    for bad in ({"update": "perhaps"}, {"update": True, next(iter(arguments)): float("nan")}):
        assert s.command("x", verb, arguments | bad).wait_final().error
    assert s.command("x", verb, arguments | {"update": True}).wait_final().aborted
    for other in (x.halt, lambda: x.stop(hold=True)):
        s.command("x", verb, arguments)
        s.run(0.1)
        taken = other()
        assert s.command("x", verb, arguments | {"update": True}).wait_final().aborted
        s.run(3)
        assert taken.done
        if taken.level_sensitive:
            taken.release()
        x.stop().wait()
    x.power(enable=False).wait()
    assert s.command("x", verb, arguments | {"update": True}).wait_final().final
    assert x.state.value == "Disabled"


MODES = ("buffered", "blending_low", "blending_previous", "blending_next", "blending_high")


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(
    ("block_of", "first", "then", "ends"),
    [
        (MC_MoveAbsolute, {"Position": 60.0, "Velocity": 100.0}, {"Velocity": 120.0}, 75.0),
        (MC_MoveAbsolute, {"Position": 60.0, "Velocity": 100.0}, {"Position": 85.0}, 100.0),
        (MC_MoveRelative, {"Distance": 60.0, "Velocity": 100.0}, {"Distance": 40.0}, 55.0),
        (MC_MoveAdditive, {"Distance": 60.0, "Velocity": 100.0}, {"Distance": 50.0}, 65.0),
        (MC_PositionProfile, {"TimePosition": "way"}, {"Offset": 5.0}, 70.0),
    ],
)
def test_what_waits_behind_a_change_stays(
    s: takt.Engine, mode: Any, block_of: Any, first: dict[str, Any], then: dict[str, Any], ends: float
) -> None:
    """AX-111: a change is no new command: one of any kind that waits comes after it, in its mode."""
    x = s.axis("x")
    block = block_of(x, ContinuousUpdate=True)
    with s.record("x") as recorder:
        run(s, block, 0.1, **first)
        behind = MC_MoveRelative(x, Distance=15.0, Velocity=80.0, BufferMode=mode)
        for i in range(4000):
            block(Execute=True, **({} if i < 50 else then))
            behind(Execute=True)
            s.step()
    assert block.Done
    assert behind.Done
    assert x.set_position == pytest.approx(ends)
    takt.expect.within_limits(recorder.recording, "x")


@pytest.mark.parametrize("behind_of", [MC_MoveAbsolute, MC_MoveVelocity])
def test_what_waits_behind_a_velocity_that_changes_stays(s: takt.Engine, behind_of: Any) -> None:
    """AX-111: it takes over once the new velocity is reached."""
    x = s.axis("x")
    block = MC_MoveVelocity(x, Velocity=100.0, ContinuousUpdate=True)
    run(s, block, 0.03)
    given = {"Position": 100.0} if behind_of is MC_MoveAbsolute else {}
    behind = behind_of(x, Velocity=50.0, BufferMode="buffered", **given)
    velocities = []
    for _ in range(3000):
        block(Execute=True, Velocity=150.0)
        behind(Execute=True)
        s.step()
        velocities.append(x.set_velocity)
    assert block.CommandAborted
    assert max(velocities) == pytest.approx(150)
    assert behind.Done if behind_of is MC_MoveAbsolute else behind.InVelocity


@pytest.mark.parametrize("kind", ["velocity", "absolute", "table", "gear", "cam"])
def test_what_is_on_top_of_a_change_stays(s: takt.Engine, kind: str) -> None:
    """AX-111: a superimposed motion goes on, and adds all of its distance."""
    x, y = s.axis("x"), s.axis("y")
    x.move_velocity(velocity=50).wait(until="reached")
    block, first, then = {
        "velocity": (MC_MoveVelocity(y, ContinuousUpdate=True), {"Velocity": 50.0}, {"Velocity": 60.0}),
        "absolute": (MC_MoveAbsolute(y, ContinuousUpdate=True, Velocity=50.0), {"Position": 90.0}, {"Position": 95.0}),
        "table": (MC_PositionProfile(y, ContinuousUpdate=True), {"TimePosition": "way"}, {"Offset": 5.0}),
        "gear": (MC_GearIn(y, Master=x, ContinuousUpdate=True), {"RatioNumerator": 1.0}, {"RatioNumerator": 1.5}),
        "cam": (
            MC_CamIn(y, Master=x, ContinuousUpdate=True, CamTableID=SelectedCam("hill")),
            {"SlaveOffset": 0.0},
            {"SlaveOffset": 5.0},
        ),
    }[kind]
    with s.record() as recorder:
        run(s, block, 0.2, **first)
        top = MC_MoveSuperimposed(y, Distance=12.0, VelocityDiff=30.0)
        for i in range(1500):
            block(Execute=True, **({} if i < 100 else then))
            top(Execute=True)
            s.step()
    assert not block.CommandAborted
    assert top.Done
    assert top.CoveredDistance == pytest.approx(12)
    if kind == "absolute":
        run(s, block, 1.5)
        assert y.set_position == pytest.approx(107)
    if kind == "table":
        run(s, block, 1.5)
        assert y.set_position == pytest.approx(67)
    takt.expect.within_limits(recorder.recording, "y")


@pytest.mark.parametrize("done", [True, False])
def test_a_phase_stays_when_the_ratio_changes(s: takt.Engine, done: bool) -> None:
    """AX-111: one that is there, and one on its way, which goes on once the slave is in gear again."""
    x, y = s.axis("x"), s.axis("y")
    x.move_velocity(velocity=40).wait(until="reached")
    gear = MC_GearIn(y, Master=x, ContinuousUpdate=True)
    run(s, gear, 0.4, RatioNumerator=1.0)
    shift = MC_PhasingAbsolute(y, Master=x, PhaseShift=10.0, Velocity=20.0)
    with s.record() as recorder:
        for _ in range(1000 if done else 250):
            gear(Execute=True)
            shift(Execute=True)
            s.step()
        assert bool(shift().Done) is done
        for _ in range(1200):
            gear(Execute=True, RatioNumerator=1.5)
            shift(Execute=True)
            s.step()
    assert gear.InGear
    assert shift.Done
    assert y.phase_shift == pytest.approx(10)
    r = recorder.recording
    # Only what was left of it came after the change.
    lag = r["y"]["set_position"] - 1.5 * r["x"]["set_position"]
    rest = 0.0 if done else lag[-1] - lag[r["y"]["phase_shift"] > r["y"]["phase_shift"][300]][0]
    assert rest == pytest.approx(0.0 if done else 1.5 * (10 - r["y"]["phase_shift"][300]), abs=0.2)
    takt.expect.within_limits(r, "y")


def test_a_cam_that_waits_keeps_what_is_on_top_when_it_changes(s: takt.Engine) -> None:
    """AX-111, AX-35: its phase, done or on its way, and added cams."""
    places = []
    for scale in (None, 1 + 1e-9):
        with takt.Engine(MACHINE) as engine:
            x, y = engine.axis("x"), engine.axis("y")
            for axis in (x, y):
                axis.power().wait()
            cam = {"master": "x", "cam": "hill", "periodic": True, "start_mode": "absolute"}
            waits = {**cam, "master_start_distance": 20.0, "master_sync_position": 50.0}
            y.cam_in(**waits)
            added = y.cam_add(cam="hill", slave_scaling=0.5)
            shift = y.phasing_absolute(phase_shift=10, velocity=20)
            engine.run(0.1)
            if scale is not None:
                assert not shift.done
                y.cam_in(**waits, slave_scaling=scale, update=True)
            engine.run(2)
            assert added.done
            x.move_absolute(position=130, velocity=100).wait()
            engine.run(0.2)
            assert y.in_step
            assert shift.done
            assert y.phase_shift == pytest.approx(10)
            places.append(y.set_position)
    assert places[0] == pytest.approx(places[1], abs=1e-4)
