"""PY-03: function blocks with PLCopen's names and interface rules (AX-11, the manual's table 8.3)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import takt
from blocks import exclusive, until
from machines import MACHINE, new_url, running
from takt import plcopen as plc


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as made:
        made.axis("x").power().wait()
        yield made


@pytest.fixture
def x(engine: takt.Engine) -> takt.Axis:
    return engine.axis("x")


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
