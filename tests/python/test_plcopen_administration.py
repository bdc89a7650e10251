"""Function blocks that switch an axis, clear its faults and show its state (AX-20 to AX-24)."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import takt
from blocks import WEAK, fill_queue, overrun, shown, until
from machines import MACHINE
from takt import plcopen as plc


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


def test_power_in_a_full_queue(engine: takt.Engine) -> None:
    """AX-20, EN-22: a command for which there was no room is given again, whatever it changes."""
    r = engine.axis("r")
    power = plc.MC_Power(r)
    for enable, forward in ((True, True), (True, False), (False, True)):
        fill_queue(engine.axis("x"))
        power(Enable=enable, EnablePositive=forward)
        assert power.ErrorID in ((3012,) if enable else (0, 3012))
        until(engine, power, lambda: power.Status is enable and not (power.Busy or power.Error))  # noqa: B023
        answer = r.move_relative(distance=1.0).wait_final()
        assert answer.error_id == (10 if not enable else 0 if forward else 3103)


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
