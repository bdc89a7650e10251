"""PY-03: function blocks with PLCopen's names and interface rules (AX-11, the manual's table 8.3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import takt
from hypothesis import HealthCheck, given, settings
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
    "MC_MoveVelocity": ({"Execute"}, {"InVelocity", "Error"}),
    "MC_ReadActualPosition": ({"Enable"}, {"Valid", "Error", "Position"}),
    "MC_ReadActualVelocity": ({"Enable"}, {"Valid", "Error", "Velocity"}),
    "MC_ReadActualTorque": ({"Enable"}, {"Valid", "Error", "Torque"}),
    "MC_ReadStatus": ({"Enable"}, {"Valid", "Error", "ErrorStop", "Disabled", "Stopping", "Standstill"}),
    "MC_ReadAxisError": ({"Enable"}, {"Valid", "Error", "ErrorID"}),
    "MC_Reset": ({"Execute"}, {"Done", "Error"}),
}
RAMPS = {"Acceleration", "Deceleration", "Jerk"}
ENDS = {"Busy", "Active", "CommandAborted", "ErrorID"}
EXTENDED = {
    "MC_Power": (set(), {"Valid", "ErrorID"}),
    "MC_Stop": ({"Deceleration", "Jerk"}, ENDS - {"Active"}),
    "MC_Halt": ({"Deceleration", "Jerk", "BufferMode"}, ENDS),
    "MC_MoveAbsolute": (RAMPS | {"BufferMode"}, ENDS),
    "MC_MoveRelative": (RAMPS | {"Velocity", "BufferMode"}, ENDS),
    "MC_MoveVelocity": (RAMPS | {"Velocity", "Direction", "BufferMode"}, ENDS),
    "MC_ReadStatus": ({"Enable"}, {"Homing", "DiscreteMotion", "ContinuousMotion", "SynchronizedMotion"}),
    "MC_ReadAxisError": (set(), {"AxisErrorID", "Busy"}),
    "MC_Reset": (set(), {"Busy", "ErrorID"}),
}
# The manual's own block (its chapter 9.7).
JOG_INPUTS = {"Enable", "JogPos", "JogNeg", "JogVelo", "JogAcc", "JogDec", "JogJerk"}


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as made:
        made.axis("x").power().wait()
        yield made


@pytest.fixture
def x(engine: takt.Engine) -> takt.Axis:
    return engine.axis("x")


def until(engine: takt.Engine, block: Callable[..., Any], condition: Callable[[], bool], **inputs: Any) -> int:
    """Calls the block before every cycle until the condition holds; how many calls it took."""
    for calls in range(1, 5000):
        block(**inputs)
        if condition():
            return calls
        engine.step()
    raise AssertionError(f"{block.outputs} after {calls} calls")  # type: ignore[attr-defined]


def exclusive(block: plc.FunctionBlock) -> bool:
    return [block.Busy, block.Done, block.Error, block.CommandAborted].count(True) == 1  # type: ignore[attr-defined]


@pytest.mark.parametrize("table", [BASIC, EXTENDED], ids=["basic", "extended"])
def test_inputs_and_outputs_are_plcopens(table: dict[str, tuple[set[str], set[str]]]) -> None:
    """AX-95: the blocks of this version against appendix B; none is left out of the table."""
    blocks = {b.__name__: b for b in plc.BLOCKS}
    assert set(blocks) - set(BASIC) == {"GT_Jog"}
    for name, (inputs, outputs) in table.items():
        assert inputs <= set(blocks[name].INPUTS), name
        assert outputs <= set(blocks[name].OUTPUTS), name
    assert set(plc.GT_Jog.INPUTS) == JOG_INPUTS
    assert plc.MC_Jog is plc.GT_Jog


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


def test_an_absolute_move(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-11, AX-30: Busy with the rising edge, Active in control, Done while Execute is true, cleared on the falling
    edge."""
    move = plc.MC_MoveAbsolute(x)
    assert not any((move().Busy, move.Active, move.Done, move.Error, move.CommandAborted))
    move(Execute=True, Position=20.0, Velocity=100.0)
    assert (move.Busy, move.Done) == (True, False)
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
    assert read(Enable=True).AxisErrorID == 2007
    assert "limit" in read.text
    until(engine, reset, lambda: reset.Done, Execute=True)
    assert x.state is takt.PlcState.STANDSTILL
    assert (read().AxisErrorID, read.text) == (0, "")


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


EVENTS = st.lists(st.tuples(st.sampled_from("move velo halt".split()), st.booleans(), st.integers(1, 60)), max_size=12)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(events=EVENTS)
def test_outputs_exclude_one_another(events: list[tuple[str, bool, int]]) -> None:
    """AX-11: whatever is pressed and let go, exactly one of Busy, Done, Error, Aborted while Execute is true; Active
    only with Busy."""
    with takt.Engine(MACHINE) as engine:
        x = engine.axis("x")
        x.power().wait()
        blocks = {
            "move": plc.MC_MoveAbsolute(x, Position=100.0),
            "velo": plc.MC_MoveVelocity(x, Velocity=100.0),
            "halt": plc.MC_Halt(x),
        }
        for name, execute, cycles in events:
            blocks[name].Execute = execute
            for _ in range(cycles):
                for block in blocks.values():
                    block()
                    final = [block.Done, block.Error, block.CommandAborted]
                    assert [block.Busy, *final].count(True) <= 1
                    assert [block.Active, *final].count(True) <= 1
                    assert block.Busy or not block.Active
                    assert exclusive(block) or not block.Execute
                engine.step()


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
