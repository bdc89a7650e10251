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


def test_two_stops_hold_until_both_let_go(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-37, EN-32: the manual's figure 8.1, note 1, carries out no block but MC_Reset in Stopping; a stop that would
    be refused there, while another one brakes gently, stops nothing. No other transition comes from that."""
    first, second = plc.MC_Stop(x, Deceleration=20.0), plc.MC_Stop(x)
    x.move_velocity(velocity=300.0).wait(until="reached")
    first(Execute=True)
    engine.step(3)
    until(engine, second, lambda: second.Done, Execute=True)
    assert x.set_velocity == 0
    assert first().Done
    for block, other in ((second, first), (first, None)):
        assert x.state is takt.PlcState.STOPPING
        assert x.move_velocity(velocity=10.0).wait_final().error_id == 6
        block(Execute=False)
        engine.step(5)
        assert not any(block().outputs.values())
        assert other is None or other().Done
    assert x.state is takt.PlcState.STANDSTILL


def test_execute_outlasts_power(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-37: power off ends the braking, not the hold; the falling edge of Execute lets go whatever is shown."""
    stop = plc.MC_Stop(x)
    x.move_velocity(velocity=300.0).wait(until="reached")
    stop(Execute=True)
    engine.step(2)
    x.power(enable=False).wait()
    assert stop().CommandAborted
    x.power().wait()
    engine.step(2)
    assert x.state is takt.PlcState.STOPPING
    stop(Execute=False)
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
