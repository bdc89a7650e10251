"""MC_Stop, which holds the axis as long as Execute is true (AX-37)."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import takt
from blocks import until
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
