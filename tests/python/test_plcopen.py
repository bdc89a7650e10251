"""PY-03: function blocks with PLCopen's names and interface rules (AX-11, the manual's table 8.3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import takt
from hypothesis import given, settings
from hypothesis import strategies as st
from machines import MACHINE, new_url, running
from takt import plcopen as plc

# Inputs and outputs of PLCopen Part 1 v2, appendix B, that are basic, for the blocks there are (AX-95).
BASIC = {
    "MC_Power": ({"Enable"}, {"Status", "Error"}),
    "MC_Stop": ({"Execute"}, {"Done", "Error"}),
    "MC_Halt": ({"Execute"}, {"Done", "Error"}),
    "MC_MoveAbsolute": ({"Execute", "Position", "Velocity", "Direction"}, {"Done", "Error"}),
    "MC_MoveRelative": ({"Execute", "Distance"}, {"Done", "Error"}),
    "MC_MoveAdditive": ({"Execute", "Distance"}, {"Done", "Error"}),
    "MC_MoveVelocity": ({"Execute"}, {"InVelocity", "Error"}),
    "MC_ReadActualPosition": ({"Enable"}, {"Valid", "Error", "Position"}),
    "MC_ReadActualVelocity": ({"Enable"}, {"Valid", "Error", "Velocity"}),
    "MC_ReadActualTorque": ({"Enable"}, {"Valid", "Error", "Torque"}),
    "MC_ReadStatus": ({"Enable"}, {"Valid", "Error", "ErrorStop", "Disabled", "Stopping", "Standstill"}),
    "MC_ReadAxisError": ({"Enable"}, {"Valid", "Error", "ErrorID"}),
    "MC_Reset": ({"Execute"}, {"Done", "Error"}),
}
# Blocks without a command that others can abort, or that is ever done.
NO_OUTPUTS = {"MC_Reset": {"Active", "CommandAborted", "Aborted"}, "MC_MoveVelocity": {"Done"}, "MC_Power": {"Done"}}
RAMPS = {"Acceleration", "Deceleration", "Jerk"}
ENDS = {"Busy", "Active", "CommandAborted", "ErrorID"}
EXTENDED = {
    "MC_Power": ({"BufferMode"}, ENDS | {"Valid", "Aborted"}),
    "MC_Stop": ({"Deceleration", "Jerk", "BufferMode"}, ENDS | {"Aborted"}),
    "MC_Halt": ({"Deceleration", "Jerk", "BufferMode"}, ENDS),
    "MC_MoveAbsolute": (RAMPS | {"BufferMode"}, ENDS),
    "MC_MoveRelative": (RAMPS | {"Velocity", "BufferMode"}, ENDS),
    "MC_MoveAdditive": (RAMPS | {"Velocity", "BufferMode"}, ENDS),
    "MC_MoveVelocity": (RAMPS | {"Velocity", "Direction", "BufferMode"}, ENDS),
    "MC_ReadStatus": ({"Enable"}, {"Homing", "DiscreteMotion", "ContinuousMotion", "SynchronizedMotion"}),
    "MC_ReadAxisError": (set(), {"AxisErrorID", "Busy"}),
    "MC_Reset": (set(), {"Busy", "ErrorID"}),
}
# The manual's own block (its chapter 9.7).
JOG_INPUTS = {"Enable", "JogPos", "JogNeg", "JogVelo", "JogAcc", "JogDec", "JogJerk"}
# x lags behind, and beyond 200 mm/s too far: a fault that opens the loop. The drive of r comes too late to be ready.
WEAK = MACHINE.replace(
    "encoder: {increments_per_unit: 1000}\n  - name: r",
    "encoder: {increments_per_unit: 1000}\n    supervision: {deviation_moving: 2}\n  - name: r",
)
WEAK += "    drive: {ready_timeout_s: 0.1}\n"
WEAK += "simulation:\n  servos:\n    - {axis: x, drive: {velocity_feed_forward: 0, position_gain: 100}}\n"
WEAK += "    - {axis: r, drive: {power_up_s: 0.2}}\n"


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as made:
        made.axis("x").power().wait()
        yield made


@pytest.fixture
def x(engine: takt.Engine) -> takt.Axis:
    return engine.axis("x")


@pytest.fixture
def weak() -> Iterator[takt.Engine]:
    with takt.Engine(WEAK) as made:
        yield made


def until(engine: takt.Engine, block: Callable[..., Any], condition: Callable[[], bool], **inputs: Any) -> int:
    """Calls the block before every cycle until the condition holds; how many calls it took."""
    for calls in range(1, 5000):
        block(**inputs)
        if condition():
            return calls
        engine.step()
    raise AssertionError(f"{block.outputs} after {calls} calls")  # type: ignore[attr-defined]


def shown(block: plc.FunctionBlock, *names: str) -> list[str]:
    """Which of these outputs are true."""
    return [name for name in names if block.outputs.get(name)]


def exclusive(block: plc.FunctionBlock) -> bool:
    return len(shown(block, "Busy", "Done", "Error", "CommandAborted")) == 1


def overrun(engine: takt.Engine, x: takt.Axis) -> None:
    """A fault that opens the loop of `x`."""
    x.move_velocity(velocity=400.0)
    engine.wait(lambda: x.state is takt.PlcState.ERROR_STOP, 5.0)
    assert not x.loop_closed


@pytest.mark.parametrize("table", [BASIC, EXTENDED], ids=["basic", "extended"])
def test_inputs_and_outputs_are_plcopens(table: dict[str, tuple[set[str], set[str]]]) -> None:
    """AX-95: the blocks of a single axis that moves by itself against appendix B."""
    blocks = {b.__name__: b for b in plc.BLOCKS}
    for name, (inputs, outputs) in table.items():
        assert inputs <= set(blocks[name].INPUTS), name
        assert outputs <= set(blocks[name].OUTPUTS), name
    for name, outputs in NO_OUTPUTS.items():
        assert not outputs & set(blocks[name].OUTPUTS), name
    assert set(plc.GT_Jog.INPUTS) == JOG_INPUTS
    assert issubclass(plc.MC_Jog, plc.GT_Jog)


def test_power(engine: takt.Engine) -> None:
    """AX-20: the level of Enable closes and opens the loop; Status says that it is closed."""
    r = engine.axis("r")
    power = plc.MC_Power(r)
    assert not power().Status
    until(engine, power, lambda: power.Status, Enable=True)
    assert (power.Valid, power.Error) == (True, False)
    assert r.state is takt.PlcState.STANDSTILL
    until(engine, power, lambda: not power.Status, Enable=False)
    assert r.state is takt.PlcState.DISABLED


def test_power_closes_the_loop_again_after_a_reset(weak: takt.Engine) -> None:
    """AX-20, AX-11: Enable is a level. Error shows the fault that opened the loop as long as it is there."""
    x = weak.axis("x")
    power, reset = plc.MC_Power(x), plc.MC_Reset(x)
    until(weak, power, lambda: power.Status, Enable=True)
    overrun(weak, x)
    power()
    assert (power.Status, power.Error, power.ErrorID, power.Valid, power.Busy) == (False, True, 2001, False, False)
    weak.step(50)
    assert power().Error
    until(weak, reset, lambda: reset.Done, Execute=True)
    power()
    assert (power.Status, power.Error, power.Valid, power.Busy, power.Active) == (False, False, True, True, True)
    until(weak, power, lambda: power.Status)
    assert x.state is takt.PlcState.STANDSTILL
    assert not shown(power, "Busy", "Active", "Error", "CommandAborted")


def test_power_tries_again_a_drive_that_was_not_ready(weak: takt.Engine) -> None:
    """AX-20: Error follows the present condition."""
    r = weak.axis("r")
    power, reset = plc.MC_Power(r), plc.MC_Reset(r)
    for _ in range(2):
        until(weak, power, lambda: power.Error, Enable=True)
        assert (power.ErrorID, power.Valid, r.state) == (3002, False, takt.PlcState.ERROR_STOP)
        until(weak, reset, lambda: reset.Done, Execute=True)
        reset(Execute=False)
        assert (power().Error, power.Busy, power.Valid) == (False, True, True)
    until(weak, power, lambda: power.Error)
    until(weak, power, lambda: r.state is takt.PlcState.DISABLED, Enable=False)
    assert not power().Error


def test_power_switches_off_from_the_first_call_on(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-20: and from ErrorStop, too; the fault stays until it is reset (the manual's chapter 9.2)."""
    power = plc.MC_Power(x)
    assert power().Busy  # Status is what is the case, not what is wanted
    assert power.Status
    until(engine, power, lambda: not power.Status)
    engine.step()
    assert x.state is takt.PlcState.DISABLED
    assert not any(power().outputs.values())

    until(engine, power, lambda: power.Status, Enable=True)
    x.move_velocity(velocity=500.0, direction="negative")
    engine.wait(lambda: x.error == 2007, 10.0)
    assert (power().Status, power.Error) == (True, False)
    until(engine, power, lambda: x.state is takt.PlcState.DISABLED, Enable=False)
    assert x.error == 2007
    until(engine, power, lambda: power.Error, Enable=True)  # with a fault: to ErrorStop, loop open
    assert (x.state, power.ErrorID) == (takt.PlcState.ERROR_STOP, 2007)


def test_power_that_changes_its_mind(weak: takt.Engine) -> None:
    """AX-20: Enable is let go while the drive gets ready, and comes back while the axis brakes."""
    x, r = weak.axis("x"), weak.axis("r")
    power = plc.MC_Power(r, Enable=True)
    power()
    weak.step(20)
    power(Enable=False)
    weak.step(300)
    assert (r.state, r.error) == (takt.PlcState.DISABLED, 0)
    assert not any(power().outputs.values())

    power = plc.MC_Power(x)
    until(weak, power, lambda: power.Status, Enable=True)
    x.move_velocity(velocity=100.0).wait(until="reached")
    power(Enable=False)
    weak.step(5)
    assert (power(Enable=True).Busy, power.Status) == (True, True)
    until(weak, power, lambda: not power.Status)
    until(weak, power, lambda: power.Status)
    assert not power.Busy


def test_power_buffered_and_refused(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11, AX-12: BufferMode as in the manual's chapter 9.2; another mode is an error, and not tried for ever."""
    power = plc.MC_Power(x, Enable=True)
    power()
    move = x.move_relative(distance=20.0)
    engine.step(5)
    power(Enable=False, BufferMode=takt.BufferMode.BUFFERED)
    engine.step()
    assert (power().Busy, power.Active, power.Status) == (True, False, True)
    until(engine, power, lambda: not power.Status)
    assert move.done

    x.power().wait()
    power(Enable=True)
    power(Enable=False, BufferMode=takt.BufferMode.BLENDING_LOW)
    with engine.record() as recorder:
        for _ in range(5):
            assert (power().Error, power.ErrorID, power.Status) == (True, 5, True)
            engine.step()
    assert not recorder.recording.events
    assert not power(Enable=True).Error


def test_power_of_two_instances(weak: takt.Engine) -> None:
    """AX-11: both wait for the same drive; the one that was superseded says so and follows the axis."""
    x = weak.axis("x")
    first, second = plc.MC_Power(x, Enable=True), plc.MC_Power(x, Enable=True)
    first()
    second()
    weak.step()
    assert shown(first(), "Busy", "Active", "CommandAborted", "Error") == ["CommandAborted"]
    assert first.Aborted
    for _ in range(500):
        weak.step()
        for power in (first, second):
            assert shown(power(), "Status", "Busy", "CommandAborted", "Error") in (["Status"], ["Busy"])
    assert first.Status
    assert second.Status


def test_an_absolute_move(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11, AX-30: Busy with the rising edge, Active in control, Done while Execute is true, cleared on the falling
    edge."""
    move = plc.MC_MoveAbsolute(x)
    assert not any((move().Busy, move.Active, move.Done, move.Error, move.CommandAborted))
    move(Execute=True, Position=20.0, Velocity=100.0)
    assert (move.Busy, move.Active, move.Done) == (True, True, False)  # table 8.3: not buffered, Active is as Busy
    engine.step()
    assert move().Active
    until(engine, move, lambda: move.Done)
    assert (move.Busy, move.Active) == (False, False)
    assert x.set_position == pytest.approx(20.0)
    engine.step(10)
    assert move().Done
    assert not move(Execute=False).Done
    assert not any(move.outputs.values())


def test_outputs_are_seen_in_one_call_at_least(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11: Execute falls before the end; the command goes on and its end is still seen, once."""
    move = plc.MC_MoveRelative(x)
    move(Execute=True, Distance=5.0)
    engine.step()
    assert move(Execute=False).Busy
    until(engine, move, lambda: move.Done)
    assert x.set_position == pytest.approx(5.0)
    assert not move().Done


def test_inputs_count_on_the_rising_edge(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11: a change of an input while Execute stays true does nothing; one that is missing keeps its value."""
    move = plc.MC_MoveAbsolute(x, Velocity=200.0)
    move(Execute=True, Position=10.0)
    engine.step(3)
    until(engine, move, lambda: move.Done, Position=50.0)
    assert x.set_position == pytest.approx(10.0)
    move(Execute=False)
    until(engine, move, lambda: move.Done, Execute=True)
    assert x.set_position == pytest.approx(50.0)
    assert move.Velocity == 200.0


def test_a_new_rising_edge_supersedes(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11: of the first action of the instance nothing is heard any more."""
    move = plc.MC_MoveAbsolute(x)
    move(Execute=True, Position=300.0)
    engine.step(50)
    move(Execute=False)
    move(Execute=True, Position=5.0)
    for _ in range(2000):
        engine.step()
        move()
        assert not move.CommandAborted
        assert exclusive(move)
        if move.Done:
            break
    assert x.set_position == pytest.approx(5.0)


def test_a_buffered_move_is_active_when_its_turn_comes(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11, AX-12: Active says that the command is in control."""
    first, second = plc.MC_MoveRelative(x, Distance=10.0), plc.MC_MoveRelative(x, Distance=5.0)
    first(Execute=True)
    second(Execute=True, BufferMode=takt.BufferMode.BUFFERED)
    assert (second.Busy, second.Active) == (True, False)
    engine.step()
    assert (first().Active, second().Active) == (True, False)
    until(engine, first, lambda: first.Done)
    assert (second().Busy, second.Active) == (True, True)
    until(engine, second, lambda: second.Done)
    assert x.set_position == pytest.approx(15.0)


def test_another_block_aborts(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11, AX-33, AX-36: Aborted excludes Done and InVelocity."""
    ever, halt = plc.MC_MoveVelocity(x), plc.MC_Halt(x)
    until(engine, ever, lambda: ever.InVelocity, Execute=True, Velocity=80.0)
    assert (ever.Busy, ever.Active) == (True, True)
    halt(Execute=True)
    engine.step()
    ever()
    assert (ever.CommandAborted, ever.Aborted, ever.InVelocity, ever.Busy, ever.Active) == (
        True,
        True,
        False,
        False,
        False,
    )
    until(engine, halt, lambda: halt.Done)
    assert not ever(Execute=False).CommandAborted


def test_in_velocity_is_cleared_with_execute(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11: the falling edge clears InVelocity and disturbs nothing."""
    ever = plc.MC_MoveVelocity(x)
    until(engine, ever, lambda: ever.InVelocity, Execute=True, Velocity=80.0, Direction=takt.Direction.NEGATIVE)
    ever(Execute=False)
    assert (ever.InVelocity, ever.Busy) == (False, True)
    engine.step(5)
    assert x.set_velocity == pytest.approx(-80.0)


@pytest.mark.parametrize("name", ["Velocity", "Acceleration", "Deceleration", "Jerk"])
def test_negative_values_are_errors(name: str, engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11: and such an error does not by itself move the axis to ErrorStop."""
    move = plc.MC_MoveAbsolute(x)
    move(Execute=True, Position=1.0, **{name: -1.0})
    assert (move.Error, move.ErrorID, move.Busy) == (True, 5, False)
    engine.step(5)
    assert move().Error
    assert x.state is takt.PlcState.STANDSTILL
    assert (move(Execute=False).Error, move.ErrorID) == (False, 0)


def test_stop_holds(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-37: Stopping lasts as long as Execute."""
    move, stop, other = plc.MC_MoveVelocity(x), plc.MC_Stop(x), plc.MC_MoveRelative(x)
    until(engine, move, lambda: move.InVelocity, Execute=True, Velocity=100.0)
    until(engine, stop, lambda: stop.Done, Execute=True)
    engine.step(500)
    assert x.state is takt.PlcState.STOPPING
    until(engine, other, lambda: other.Error, Execute=True, Distance=1.0)
    assert other.ErrorID == 6
    assert stop().Done
    stop(Execute=False)
    engine.step(5)
    assert x.state is takt.PlcState.STANDSTILL
    assert not any(stop().outputs.values())


def test_a_second_stop_is_refused(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-37: no block but MC_Reset is carried out in Stopping (the manual's figure 8.1, note 1); the stop that holds
    the axis still does."""
    first, second = plc.MC_Stop(x), plc.MC_Stop(x)
    x.move_velocity(velocity=300.0).wait(until="reached")
    first(Execute=True)
    engine.step(3)
    until(engine, second, lambda: not second.Busy, Execute=True)
    assert (second.Error, second.ErrorID) == (True, 6)
    until(engine, first, lambda: first.Done)
    second(Execute=False)
    assert not any(second.outputs.values())
    engine.step(50)
    assert (first().Done, x.state) == (True, takt.PlcState.STOPPING)
    first(Execute=False)
    engine.step(5)
    assert x.state is takt.PlcState.STANDSTILL


@pytest.mark.parametrize("held", [True, False])
def test_a_buffered_stop(held: bool, engine: takt.Engine, x: takt.Axis) -> None:
    """AX-37, AX-12: after the move; let go while it waits, it does not hold."""
    move, stop = plc.MC_MoveRelative(x, Distance=10.0), plc.MC_Stop(x, BufferMode=takt.BufferMode.BUFFERED)
    move(Execute=True)
    stop(Execute=True)
    engine.step(3)
    assert (stop().Busy, stop.Active) == (True, False)
    stop(Execute=held)
    until(engine, stop, lambda: stop.Done)
    engine.step(5)
    assert move().Done
    assert x.state is (takt.PlcState.STOPPING if held else takt.PlcState.STANDSTILL)
    stop(Execute=False)
    engine.step(5)
    assert x.state is takt.PlcState.STANDSTILL


def test_stop_released_on_the_way(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-37: the ramp goes on to standstill; Done is seen once."""
    move, stop = plc.MC_MoveVelocity(x), plc.MC_Stop(x)
    until(engine, move, lambda: move.InVelocity, Execute=True, Velocity=400.0)
    stop(Execute=True)
    engine.step(5)
    stop(Execute=False)
    until(engine, stop, lambda: stop.Done)
    engine.step(3)
    assert x.state is takt.PlcState.STANDSTILL
    assert not stop().Done


def test_reading(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-22, AX-24: valid while Enable is true."""
    status, position = plc.MC_ReadStatus(x), plc.MC_ReadActualPosition(x)
    velocity, torque = plc.MC_ReadActualVelocity(x), plc.MC_ReadActualTorque(x)
    x.move_velocity(velocity=50.0).wait(until="reached")
    status(Enable=True)
    assert [name for name in takt.PlcState if getattr(status, name.value)] == ["ContinuousMotion"]
    assert position(Enable=True).Position == x.actual_position > 0
    assert velocity(Enable=True).Velocity == x.actual_velocity
    assert torque(Enable=True).Torque == x.torque_nm
    for block in (status, position, velocity, torque):
        assert block().Valid
        assert not any(block(Enable=False).outputs.values())


def test_errors_and_reset(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-21, AX-23, AX-83: running onto a SW limit; the error's number; reset."""
    read, reset = plc.MC_ReadAxisError(x), plc.MC_Reset(x)
    x.move_velocity(velocity=500.0, direction="negative")
    engine.wait(lambda: x.state is takt.PlcState.ERROR_STOP, 10.0)
    engine.wait(lambda: x.set_velocity == 0, 10.0)
    read(Enable=True)
    assert (read.AxisErrorID, read.Error, read.ErrorID, read.Valid) == (2007, True, 2007, True)
    assert "limit" in read.text
    until(engine, reset, lambda: reset.Done, Execute=True)
    assert x.state is takt.PlcState.STANDSTILL
    assert (read().AxisErrorID, read.Error, read.Valid, read.text) == (0, False, True, "")


def test_a_reset_that_is_superseded(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11, AX-21: MC_Reset has no CommandAborted; it stays Busy until the axis has left ErrorStop."""
    first, second = plc.MC_Reset(x), plc.MC_Reset(x)
    x.move_velocity(velocity=500.0, direction="negative")
    engine.wait(lambda: x.state is takt.PlcState.ERROR_STOP, 10.0)
    first(Execute=True)
    second(Execute=True)
    braking = 0
    while x.state is takt.PlcState.ERROR_STOP:
        engine.step()
        for reset in (first(), second()):
            assert shown(reset, "Busy", "Done", "Error") == (["Busy"] if x.error else ["Done"])
        braking += 1
    assert braking > 10
    assert x.state is takt.PlcState.STANDSTILL
    x.move_velocity(velocity=500.0, direction="negative")
    engine.wait(lambda: x.state is takt.PlcState.ERROR_STOP, 10.0)
    assert first().Done  # of a fault that came later it says nothing
    assert not first(Execute=False).Done


def test_a_reset_that_is_superseded_in_vain(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-21: the axis is at rest and its fault still there, so that was of no use: Error."""
    reset = plc.MC_Reset(x)
    x.move_velocity(velocity=500.0, direction="negative")
    engine.wait(lambda: x.state is takt.PlcState.ERROR_STOP and x.set_acceleration == x.set_velocity == 0, 10.0)
    reset(Execute=True)
    assert reset._feedback is not None
    reset._feedback._update(takt.FeedbackState.ABORTED, False, 0, "", engine.cycle)
    assert (reset().Error, reset.ErrorID, shown(reset, "Busy", "Done")) == (True, 7, [])


def test_jog(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-39: the direction pressed first wins; both must be let go before the next jog."""
    jog = plc.GT_Jog(x, JogVelo=50.0)
    jog(JogPos=True)
    engine.step(50)
    assert x.set_velocity == 0  # not enabled
    jog(JogPos=False)
    for press in ({"Enable": True, "JogPos": True}, {"JogNeg": True}):
        jog(**press)
        engine.step(200)
        assert x.set_velocity == pytest.approx(50.0)
    jog(JogPos=False)
    engine.step(300)
    assert x.set_velocity == 0
    jog(JogNeg=False)
    engine.step(5)
    jog(JogNeg=True)
    engine.step(200)
    assert x.set_velocity == pytest.approx(-50.0)
    jog(Enable=False)
    engine.step(300)
    assert x.set_velocity == 0
    assert not jog.Error


def test_a_jog_needs_a_key_pressed_anew(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-39: a key that is held while Enable goes and comes moves nothing; nor does one pressed before Enable."""
    jog = plc.GT_Jog(x, JogVelo=50.0)
    jog(Enable=True, JogPos=True)
    engine.step(100)
    assert x.set_velocity == pytest.approx(50.0)
    for change in ({"Enable": False}, {"Enable": True}, {"JogNeg": True}, {"JogPos": False}):
        jog(**change)
        engine.step(200)
        assert x.set_velocity == 0
    jog(Enable=False, JogNeg=False)  # seen up while not enabled
    jog(JogPos=True)
    jog(Enable=True)
    engine.step(100)
    assert x.set_velocity == 0
    jog(JogPos=False)
    jog(JogPos=True)
    engine.step(100)
    assert x.set_velocity == pytest.approx(50.0)


def test_a_jog_that_cannot_go_on(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-39: the second key brings a velocity that is refused; the axis does not run on without anyone holding it."""
    jog = plc.GT_Jog(x, Enable=True, JogVelo=50.0)
    jog(JogPos=True)
    engine.step(100)
    assert (jog(JogNeg=True, JogVelo=-1.0).Error, jog.ErrorID) == (True, 5)
    engine.step(200)
    assert x.set_velocity == 0
    assert jog().Error
    assert not jog(JogPos=False, JogNeg=False).Error


def test_the_error_of_a_short_jog_is_seen(engine: takt.Engine) -> None:
    """AX-11: the key is let go before the answer is there; the error is shown in one call."""
    jog = plc.GT_Jog(engine.axis("r"), Enable=True)  # not powered
    jog(JogPos=True)
    jog(JogPos=False)
    engine.step()
    assert (jog().Error, jog.ErrorID) == (True, 10)
    assert not jog().Error


def test_a_jog_that_is_refused(engine: takt.Engine) -> None:
    """AX-39: the error stays until the keys are let go."""
    jog = plc.GT_Jog(engine.axis("r"), Enable=True)  # not powered
    jog(JogPos=True)
    engine.step(2)
    assert (jog().Error, jog.ErrorID) == (True, 10)
    engine.axis("r").power().wait()
    assert jog(JogNeg=True).Error
    engine.step(50)
    assert engine.axis("r").set_velocity == 0
    jog(JogPos=False)
    assert not jog(JogNeg=False).Error
    jog(JogNeg=True)
    engine.step(50)
    assert engine.axis("r").set_velocity < 0


def test_names_are_checked(x: takt.Axis) -> None:
    move = plc.MC_MoveAbsolute(x)
    with pytest.raises(TypeError, match="no input 'Positon'"):
        move(Positon=1.0)
    with pytest.raises(AttributeError, match="no input"):
        move.Positon = 1.0  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="output"):
        move.Done = True
    move.Position = 3.0
    assert move.Position == 3.0


class Watch:
    """The interface rules of one block, looked at after every call."""

    def __init__(self, block: plc.FunctionBlock) -> None:
        self.block = block
        self.executes = "Execute" in block.INPUTS
        self.ended_unseen = False  # Execute fell while it was busy: the end must still be shown, once

    def call(self) -> None:
        block = self.block
        was_executed = self.executes and block._edge  # type: ignore[attr-defined]
        out = block().outputs
        ends = shown(block, "Done", "Error", "CommandAborted")
        busy = out.get("Busy", False)
        assert len(ends) + busy <= 1, out
        assert len(ends) + out.get("Active", False) <= 1, out
        assert busy or not (out.get("Active") or out.get("InVelocity")), out
        assert out["Error"] == (out["ErrorID"] != 0), out
        if not self.executes:
            assert not (out.get("Valid") and out["Error"]), out
            return
        execute = block.Execute  # type: ignore[attr-defined]
        if execute:
            assert len(ends) + busy == 1, out
        elif self.ended_unseen:
            assert len(ends) + busy == 1, out  # its end is shown in one call
        elif not was_executed:
            assert not ends, out
        self.ended_unseen = not execute and busy


INPUT = {"power": "Enable", "jog": "JogPos"}
MODES = {"move": list(takt.BufferMode), "velo": list(takt.BufferMode)}
for _name in ("stop", "halt", "power"):
    MODES[_name] = [takt.BufferMode.ABORTING, takt.BufferMode.BUFFERED]


@st.composite
def events(draw: st.DrawFn) -> tuple[str, int, dict[str, Any], int]:
    """Kind of block, which of the two, its inputs, and for how many cycles."""
    kind = draw(st.sampled_from("move velo halt stop reset power jog".split()))
    inputs: dict[str, Any] = {INPUT.get(kind, "Execute"): draw(st.booleans())}
    if kind == "jog":
        inputs |= {"Enable": draw(st.booleans()), "JogNeg": draw(st.booleans())}
    if kind == "velo":  # also too fast (the loop opens), also onto the SW limit (ErrorStop with the loop closed)
        inputs["Direction"] = draw(st.sampled_from([takt.Direction.POSITIVE, takt.Direction.NEGATIVE]))
    if kind in ("move", "velo"):
        inputs["Velocity"] = draw(st.sampled_from([100.0, 400.0, -1.0]))
    if kind in MODES:
        inputs["BufferMode"] = draw(st.sampled_from(MODES[kind]))
    return kind, draw(st.integers(0, 1)), inputs, draw(st.integers(0, 60))


@settings(max_examples=50, deadline=None)
@given(events=st.lists(events(), max_size=16))
def test_outputs_exclude_one_another(events: list[tuple[str, int, dict[str, Any], int]]) -> None:
    """AX-11: whatever is pressed and let go on two instances of each block, and through all faults: exactly one of
    Busy, Done, Error, Aborted while Execute is true, and each end seen once. At last, with all keys let go, a reset
    brings back an axis whose MC_Power is still enabled (AX-20), and nothing holds it any more."""
    with takt.Engine(WEAK) as engine:
        x = engine.axis("x")
        makers: dict[str, Callable[[], plc.FunctionBlock]] = {
            "power": lambda: plc.MC_Power(x, Enable=True),
            "reset": lambda: plc.MC_Reset(x),
            "move": lambda: plc.MC_MoveAbsolute(x, Position=100.0),
            "velo": lambda: plc.MC_MoveVelocity(x),
            "halt": lambda: plc.MC_Halt(x),
            "stop": lambda: plc.MC_Stop(x),
            "jog": lambda: plc.GT_Jog(x, JogVelo=100.0),
        }
        watches = {(kind, i): Watch(make()) for i in range(2) for kind, make in makers.items()}

        def press(kind: str, i: int, cycles: int, **inputs: Any) -> dict[str, Any]:
            watch = watches[kind, i]
            for name, value in inputs.items():
                setattr(watch.block, name, value)
            watch.call()  # perhaps more than once in a cycle
            for _ in range(cycles):
                for each in watches.values():
                    each.call()
                engine.step()
            return watch.block.outputs

        press("power", 0, 150)
        for kind, i, inputs, cycles in events:
            press(kind, i, cycles, **inputs)
        for kind, i in watches:
            level = kind == "power"
            press(kind, i, 1, **{INPUT.get(kind, "Execute"): level}, **({"JogNeg": False} if kind == "jog" else {}))
        press("halt", 0, 150, Execute=False)  # perhaps the drive is still getting ready
        press("halt", 0, 200, Execute=True, BufferMode=takt.BufferMode.ABORTING)
        press("halt", 0, 1, Execute=False)
        assert press("reset", 0, 300, Execute=True)["Done"]
        for i in range(2):
            power = watches["power", i].block
            assert shown(power, "Status", "Busy", "Error", "CommandAborted") == ["Status"]
        assert press("halt", 0, 20, Execute=True)["Done"]
        assert x.state is takt.PlcState.STANDSTILL


def test_blocks_work_on_a_running_engine(tmp_path: Path) -> None:
    """PY-02: the same blocks over LCM, in a program that is called whenever the engine's state has come."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        axis = session.axis("x")
        power, move, stop = plc.MC_Power(axis), plc.MC_MoveAbsolute(axis), plc.MC_Stop(axis)

        @session.program
        def scan() -> None:
            power(Enable=True)
            move(Execute=power.Status, Position=30.0, Velocity=300.0)
            stop(Execute=move.Done)

        session.wait(lambda: stop.Done, 5.0)
        session.run(1.2)
        assert axis.state is takt.PlcState.STOPPING
        assert axis.actual_position == pytest.approx(30.0, abs=0.05)
