"""Function blocks of gears, homing, settings and continuous moves in cyclic programs, as engineers use them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import takt
from blocks import call
from takt import plcopen as plc

MACHINE = """
name: bench
axes:
  - name: x
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
    encoder: {increments_per_unit: 10000}
    requires_reference: true
  - name: y
    limits: {velocity: 1000, acceleration: 10000, jerk: 200000}
    encoder: {increments_per_unit: 10000}
  - name: a
    limits: {velocity: 300, acceleration: 3000, jerk: 60000}
    drive: {mode: analog}
    loop: {kp: 0.05, velocity_at_10v: 400}
simulation:
  servos:
    - axis: x
      mechanics: {start_position: -40}
      switches:
        limit_negative: {to: -100}
        limit_positive: {from: 100}
        reference: {from: 10, to: 30}
      encoder: {increments_per_unit: 10000, index_distance: 10, index_offset: 3}
"""


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as session:
        for name in ("x", "y", "a"):
            session.axis(name).power()
        session.run(0.5)
        yield session


def test_homing_as_a_sequence_of_steps(engine: takt.Engine) -> None:
    """AX-60, AX-63, AX-71: switch roughly, then the index pulse exactly; absolute moves only after that."""
    x = engine.axis("x")
    move = plc.MC_MoveAbsolute(x, Position=0.0)
    assert call(engine, move, 0.01, Execute=True).ErrorID == 9
    switch = plc.MC_StepAbsSwitch(x, Direction=takt.HomingDirection.POSITIVE, Velocity=50.0, TimeLimit=10.0)
    call(engine, switch, 1.0, Execute=True)
    assert (switch.Busy, switch.Active, switch.Done) == (True, True, False)
    call(engine, switch, 3.0, Execute=True)
    assert switch.Done
    status = plc.MC_ReadStatus(x, Enable=True)()
    assert (status.Homing, status.Ref) == (True, False)
    pulse = plc.MC_StepRefPulse(x, Direction=takt.HomingDirection.NEGATIVE, Velocity=10.0, SetPosition=0.0)
    call(engine, pulse, 3.0, Execute=True)
    assert pulse.Done
    status()
    assert (status.Standstill, status.Ref) == (True, True)
    call(engine, move, 0.01, Execute=False)
    call(engine, move, 1.0, Execute=True)
    assert move.Done
    assert plc.MC_ReadActualPosition(x, Enable=True)().Position == pytest.approx(0, abs=2e-4)


def test_a_search_that_takes_too_long(engine: takt.Engine) -> None:
    """AX-70."""
    step = plc.MC_StepLimitSwitch(engine.axis("x"), Direction=takt.HomingDirection.NEGATIVE, Velocity=5.0)
    call(engine, step, 1.0, Execute=True, TimeLimit=0.5)
    assert (step.Error, step.ErrorID, step.Done) == (True, 1, False)


def test_a_reference_in_passing(engine: takt.Engine) -> None:
    """AX-67."""
    x = engine.axis("x")
    fly = plc.MC_StepRefFlyingSwitch(x, SetPosition=500.0)
    move = plc.MC_MoveRelative(x, Distance=60.0, Velocity=50.0)
    for _ in range(2000):
        fly(Execute=True)
        move(Execute=True)
        engine.run(engine.period)
    assert (fly(Execute=True).Done, move(Execute=True).Done) == (True, True)
    assert fly.RecordedPosition == 500.0
    assert x.actual_position == pytest.approx(510, abs=0.1)  # 10 behind the switch


def test_gears(engine: takt.Engine) -> None:
    """AX-43, AX-44, AX-46: in gear, shifted, let go."""
    x, y = engine.axis("x"), engine.axis("y")
    drive = plc.MC_MoveVelocity(x, Velocity=50.0)
    gear = plc.MC_GearIn(y, Master=x, RatioNumerator=2.0)
    drive(Execute=True)
    call(engine, gear, 0.5, Execute=True)
    assert (gear.Busy, gear.Active, gear.InGear) == (True, True, True)
    assert y.set_velocity == pytest.approx(100)
    before = y.set_position - 2 * x.set_position
    shift = plc.MC_PhasingRelative(y, PhaseShift=5.0)
    call(engine, shift, 1.0, Execute=True)
    assert shift.Done
    assert y.set_position - 2 * x.set_position == pytest.approx(before + 10)
    out = plc.MC_GearOut(y)
    call(engine, out, 0.01, Execute=True)
    assert out.Done
    assert gear(Execute=True).CommandAborted
    assert plc.MC_ReadStatus(y, Enable=True)().ContinuousMotion


def test_a_gear_in_step_at_a_place(engine: takt.Engine) -> None:
    """AX-45."""
    x, y = engine.axis("x"), engine.axis("y")
    start = x.set_position
    gear = plc.MC_GearInPos(y, Master="x", MasterSyncPosition=start + 100, SlaveSyncPosition=30.0)
    gear(Execute=True, MasterStartDistance=50.0)
    drive = plc.MC_MoveVelocity(x, Velocity=40.0)
    drive(Execute=True)
    call(engine, gear, 2.0, Execute=True)
    assert (gear.StartSync, gear.InSync) == (True, False)
    call(engine, gear, 1.0, Execute=True)
    assert (gear.StartSync, gear.InSync) == (False, True)
    assert y.set_position == pytest.approx(30 + x.set_position - start - 100)


def test_a_loop_of_gears(engine: takt.Engine) -> None:
    """AX-55."""
    x, y = engine.axis("x"), engine.axis("y")
    call(engine, plc.MC_GearIn(y, Master=x), 0.01, Execute=True)
    assert call(engine, plc.MC_GearIn(x, Master=y), 0.01, Execute=True).ErrorID == 3018
    with pytest.raises(takt.CommandError, match="x would follow itself: x follows y, y follows x"):
        x.gear_in(master="y").wait()


def test_parameters(engine: takt.Engine) -> None:
    """AX-28, AX-52, AX-29."""
    y = engine.axis("y")
    write = plc.MC_WriteParameter(y, ParameterNumber=2, Value=50.0)
    call(engine, write, 0.01, Execute=True)
    assert write.Done
    read = plc.MC_ReadParameter(y, ParameterNumber=2)
    call(engine, read, 0.01, Enable=True)
    assert (read.Valid, read.Value) == (True, 50.0)
    enabled = plc.MC_ReadBoolParameter(y, ParameterNumber=4)
    call(engine, enabled, 0.01, Enable=True)
    assert enabled.Value is True
    call(engine, plc.MC_WriteBoolParameter(y, ParameterNumber=4, Value=False), 0.01, Execute=True)
    call(engine, enabled, 0.01, Enable=True)
    assert enabled.Value is False
    call(engine, read, 0.01, Enable=True, ParameterNumber=99)
    assert (read.Valid, read.ErrorID) == (False, 5)
    for number, value in ((2, 50.0), (4, 0.0), (2, 50.0)):
        read(ParameterNumber=number)
        assert (read.Valid, read.Error, read.Busy) == (False, False, True)
        call(engine, read, 0.01)
        assert (read.Valid, read.Value) == (True, value)
    assert call(engine, plc.GT_SWLim(y, LimPos=20.0, LimNeg=-20.0), 0.01, Execute=True).Done
    assert call(engine, plc.MC_MoveAbsolute(y, Position=21.0), 0.01, Execute=True).ErrorID == 8
    assert call(engine, plc.MC_SetPosition(y, Position=-7.0), 0.01, Execute=True).Done
    assert y.set_position == -7.0


def test_constants_and_direct_output(engine: takt.Engine) -> None:
    """AX-27, AX-53."""
    a = engine.axis("a")
    assert call(engine, plc.GT_SetConstant(a, Kp=0.08, Kd=0.01), 0.01, Execute=True).Done
    assert call(engine, plc.GT_Analog(a, Voltage=1.0), 0.01, Execute=True).ErrorID == 13
    a.power(enable=False).wait()
    assert call(engine, plc.GT_Analog(a, Voltage=1.0), 0.01, Execute=True).Done
    assert a.voltage_v == pytest.approx(1.0, abs=0.0013)  # a step of the converter
    pulse = plc.GT_Pulse(a, Voltage=2.0, Duration=0.05)
    show = plc.GT_Show(a, Enable=True)
    call(engine, pulse, 0.03, Execute=True)
    assert pulse.Busy
    assert (show().Voltage, show.Valid) == (pytest.approx(2.0, abs=0.0013), True)
    call(engine, pulse, 0.03, Execute=True)
    assert pulse.Done
    assert show().Voltage == 0


def test_what_the_position_loop_works_with(engine: takt.Engine) -> None:
    """GT_Show."""
    y = engine.axis("y")
    y.move_velocity(velocity=50.0).wait(until="reached")
    show = plc.GT_Show(y, Enable=True)()
    assert show.ModelVelocity == 50.0
    assert show.Velocity == pytest.approx(50.0, rel=0.05)
    assert show.Deviation == y.following_error
    assert show.ModelPosition - show.Position == pytest.approx(show.Deviation + 0.05, abs=0.01)  # a cycle's way ahead
    assert show(Enable=False).ModelPosition == 0.0


def test_continuous_moves_and_what_the_axis_does(engine: takt.Engine) -> None:
    """AX-25, AX-26, AX-34, AX-40, AX-54."""
    y = engine.axis("y")
    move = plc.MC_MoveContinuousRelative(y, Distance=50.0, EndVelocity=100.0)
    state = plc.MC_ReadMotionState(y, Enable=True)
    call(engine, move, 0.02, Execute=True)
    state()
    assert (state.Accelerating, state.DirectionPositive, state.ConstantVelocity) == (True, True, False)
    call(engine, move, 1.0, Execute=True)
    assert (move.InEndVelocity, move.Busy) == (True, True)
    state()
    assert (state.ConstantVelocity, state.Decelerating) == (True, False)
    call(engine, plc.MC_Halt(y), 0.5, Execute=True)
    inch = plc.MC_Inch(y, Distance=0.5)
    position = y.set_position
    assert call(engine, inch, 0.5, Execute=True).Done
    assert y.set_position == pytest.approx(position + 0.5)
    info = plc.MC_ReadAxisInfo(engine.axis("x"), Enable=True)()
    assert (info.PowerOn, info.IsHomed, info.LimitSwitchPos) == (True, False, False)


def test_enumerations_are_given_as_text(engine: takt.Engine) -> None:
    """AX-11, AX-26: as for all commands; another value is an error that names the input."""
    x = engine.axis("x")
    motion = plc.MC_ReadMotionState(x, Enable=True, Source="actual_value")
    assert motion().Valid
    for value in ("actual", 0):
        motion(Source=value)
        assert (motion.Valid, motion.Error, motion.ErrorID, motion.ConstantVelocity) == (False, True, 5, False)
        assert motion.ErrorText == f"Source: expected one of set_value, actual_value, found {value!r}"
    assert motion(Source=takt.MasterSource.SET_VALUE).Valid
    select = plc.MC_CamTableSelect(x, CamTable="none", ExecutionMode="later")
    assert select(Execute=True).ErrorText.startswith("ExecutionMode: expected one of immediately, delayed, queued")
    assert (select.Error, select.ErrorID, select.CamTableID) == (True, 5, None)
    power = plc.MC_Power(x, Enable=False, BufferMode="late")
    cams = plc.MC_DigitalCamSwitch(x, Enable=True, ValueSource="due")
    for block, text in (
        (power, "buffer_mode: expected one of aborting, buffered"),
        (cams, "source: expected one of set_value, actual_value"),
    ):
        block()
        engine.run(0.01)
        assert block().Error
        assert text in block.ErrorText
    move = plc.MC_MoveVelocity(x, Velocity=10.0, BufferMode=1)
    assert move.BufferMode is takt.BufferMode.BUFFERED


def test_the_inputs_of_an_axis(engine: takt.Engine) -> None:
    """AX-54: each switch where it lies, and nowhere else."""
    x = engine.axis("x")
    info = plc.GT_SInfo(x, Enable=True)
    begin = x.set_position + 40  # the mechanics stand at -40

    def signals() -> set[str]:
        outputs = info().outputs
        return {name for name in ("LIMpos", "LIMneg", "REF", "TP") if outputs[name]}

    assert signals() == set()
    x.move_relative(distance=60, velocity=100).wait()
    assert signals() == {"REF"}
    x.move_relative(distance=20, velocity=100).wait()
    assert signals() == set()
    for distance, name in ((100, "LIMpos"), (-300, "LIMneg")):
        x.move_relative(distance=distance, velocity=100).wait_final()
        assert signals() == {name}
        assert x.set_position - begin == pytest.approx(100 if distance > 0 else -100, abs=8)  # where it came to rest
        x.reset().wait()
    info(Enable=False)
    assert signals() == set()


def test_emergency_stop(engine: takt.Engine) -> None:
    """AX-38."""
    y = engine.axis("y")
    y.move_velocity(velocity=100.0)
    engine.run(0.2)
    stop = plc.GT_EStop(y)
    call(engine, stop, 0.01, Execute=True)
    assert stop.Done
    assert not y.loop_closed
    assert y.state is takt.PlcState.DISABLED


def test_how_long_a_move_takes_is_known_when_it_begins(engine: takt.Engine) -> None:
    """AX-96."""
    y = engine.axis("y")
    move = y.move_relative(distance=100.0)
    engine.run(0.01)
    begin = move.time_s
    move.wait()
    assert move.travel_time_s == pytest.approx(move.time_s - begin, abs=2.1 * engine.period)


def test_only_a_yes_or_no_is_written_as_one(engine: takt.Engine) -> None:
    """AX-28."""
    y = engine.axis("y")
    write = plc.MC_WriteBoolParameter(y, ParameterNumber=2, Value=True)
    assert call(engine, write, 0.01, Execute=True).ErrorID == 5
    assert plc.MC_WriteBoolParameter(y, ParameterNumber=4, Value=False)(Execute=True).Busy
    engine.run(0.01)
    assert y.move_absolute(position=1e4).error_id == 0
