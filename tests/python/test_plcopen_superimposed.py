"""AX-35: function blocks of motions on top of other motions."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import takt
from blocks import exclusive, until
from machines import MACHINE
from takt import plcopen as plc


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as session:
        session.axis("x").power().wait()
        yield session


def test_on_top_of_a_move(engine: takt.Engine) -> None:
    """The move is done as late as it would be alone, so much further on."""
    x = engine.axis("x")
    alone = x.move_relative(distance=100.0, velocity=50.0)
    alone.wait()
    move = plc.MC_MoveRelative(x, Distance=100.0, Velocity=50.0)
    top = plc.MC_MoveSuperimposed(x, Distance=10.0, VelocityDiff=20.0)
    begin = engine.now

    def both(**inputs: object) -> None:
        move(Execute=True)
        top(**inputs)

    both.outputs = top.outputs  # type: ignore[attr-defined]
    until(engine, both, lambda: 0 < top.CoveredDistance < 10, Execute=True)
    assert exclusive(top)
    assert top.Busy
    assert x.superimposed
    until(engine, both, lambda: top.Done)
    assert exclusive(top)
    assert top.CoveredDistance == pytest.approx(10.0)
    assert move.Busy
    until(engine, both, lambda: move.Done)
    assert engine.now - begin == pytest.approx(alone.travel_time_s, abs=3 * engine.period)
    assert x.set_position == pytest.approx(210.0)


def test_halted_or_replaced(engine: takt.Engine) -> None:
    x = engine.axis("x")
    x.move_velocity(velocity=50.0).wait(until="reached")
    top = plc.MC_MoveSuperimposed(x, Distance=1000.0, VelocityDiff=20.0)
    until(engine, top, lambda: top.CoveredDistance > 5, Execute=True)
    assert x.set_velocity == pytest.approx(70.0)
    other = plc.MC_MoveSuperimposed(x, Distance=1000.0, VelocityDiff=30.0)
    until(engine, other, lambda: other.CoveredDistance > 5, Execute=True)
    assert top().CommandAborted
    assert top.CoveredDistance > 5
    halt = plc.MC_HaltSuperimposed(x, Deceleration=500.0)
    until(engine, halt, lambda: halt.Done, Execute=True)
    assert (other().CommandAborted, exclusive(halt)) == (True, True)
    assert x.set_velocity == pytest.approx(50.0)
    assert x.state is takt.PlcState.CONTINUOUS_MOTION


def test_refused(engine: takt.Engine) -> None:
    x = engine.axis("x")
    top = plc.MC_MoveSuperimposed(x, Distance=10.0, VelocityDiff=-1.0)
    until(engine, top, lambda: top.Error, Execute=True)
    assert (top.ErrorID, top.CoveredDistance, exclusive(top)) == (5, 0.0, True)
    x.power(enable=False).wait()
    until(engine, top, lambda: not top.Error, Execute=False)
    until(engine, top, lambda: top.Error, Execute=True, VelocityDiff=1.0)
    assert top.ErrorID == 10
