"""Overrides and forecasts from Python, as engineers use them (AX-51, AX-96)."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
import takt
from machines import MACHINE
from takt import plcopen as plc


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as session:
        for axis in session.axes.values():
            axis.power()
        session.run(0.5)
        yield session


def scan(engine: takt.Engine, block: plc.MC_SetOverride, cycles: int = 200) -> None:
    for _ in range(cycles):
        block()
        engine.step()
    block()


def test_the_block_keeps_the_factors(engine: takt.Engine) -> None:
    """AX-51, AX-95."""
    x = engine.axis("x")
    x.move_velocity(velocity=100).wait(until="reached")
    override = plc.MC_SetOverride(x, VelFactor=0.5)
    scan(engine, override, 5)
    assert (override.Enabled, override.Busy, x.set_velocity) == (False, False, 100)
    override(Enable=True)
    assert (override.Enabled, override.Busy) == (False, True)
    scan(engine, override)
    assert (override.Enabled, override.Busy, override.Error) == (True, True, False)
    assert (x.set_velocity, x.override_factor) == (50, 0.5)
    override(VelFactor=0.0)
    assert not override.Enabled
    scan(engine, override)
    assert (override.Enabled, x.set_velocity) == (True, 0)
    assert (x.state, x.limited_by) == (takt.PlcState.CONTINUOUS_MOTION, takt.LimitedBy.OVERRIDE)
    override(VelFactor=0.25)
    scan(engine, override)
    override(Enable=False, VelFactor=1.0)
    scan(engine, override)
    assert (override.Enabled, override.Busy, x.set_velocity) == (False, False, 25)


@pytest.mark.parametrize("name", ["AccFactor", "JerkFactor"])
def test_the_block_shows_what_is_refused(engine: takt.Engine, name: str) -> None:
    """AX-51: a factor of ramps or jerk is not 0."""
    override = plc.MC_SetOverride(engine.axis("x"), Enable=True, **{name: 0.0})
    scan(engine, override, 3)
    assert (override.Enabled, override.Busy, override.Error, override.ErrorID) == (False, False, True, 5)
    override(**{name: 1.0})
    scan(engine, override, 3)
    assert (override.Enabled, override.Error, override.ErrorID) == (True, False, 0)


def test_a_dry_run_is_what_happens(engine: takt.Engine) -> None:
    """AX-96: travel time before the move and when it is accepted; the time to a place; the place at a time."""
    x = engine.axis("x")
    before = engine.state_hash
    forecast = x.forecast("move_absolute", position=100.0, velocity=50.0)
    assert engine.state_hash == before
    assert forecast.known
    assert not forecast.error_id
    begin = engine.now
    move = x.move_absolute(position=100.0, velocity=50.0).wait(until="active")
    assert move.travel_time_s == pytest.approx(forecast.duration_s)
    engine.wait(lambda: x.set_position >= 40)
    assert engine.now - begin == pytest.approx(forecast.time_to(40), abs=1.01 * engine.period)
    assert forecast.at(engine.now - begin) == pytest.approx((x.set_position, x.set_velocity, x.set_acceleration))
    rest = x.forecast()
    assert rest.start_s < 0
    assert rest.duration_s == pytest.approx(begin + forecast.duration_s - engine.now)
    assert rest.time_to(x.set_position) == 0
    assert math.isnan(rest.time_to(30))
    move.wait()
    assert engine.now - begin == pytest.approx(forecast.duration_s, abs=2 * engine.period)


def test_a_dry_run_is_refused_like_the_command(engine: takt.Engine) -> None:
    """AX-96."""
    x = engine.axis("x")
    for arguments in ({"position": 1e15}, {"position": 1.0, "velocity": -1.0}, {"place": 1.0}):
        forecast = x.forecast("move_absolute", **arguments)
        given = engine.command("x", "move_absolute", arguments)
        given.wait_final()
        assert (forecast.error_id, forecast.known) == (given.error_id, False)
        assert forecast.sentence
        assert forecast.sentence in repr(forecast)


def test_held_there_is_no_end(engine: takt.Engine) -> None:
    """AX-51, AX-96."""
    x = engine.axis("x")
    x.set_override(velocity_factor=0).wait()
    forecast = x.forecast("move_relative", distance=10)
    assert (forecast.held, forecast.duration_s, forecast.limited_by) == (True, math.inf, takt.LimitedBy.OVERRIDE)
    x.set_override().wait()
    waits = x.move_relative(distance=100, velocity=50)
    engine.step()
    later = x.forecast("move_relative", distance=10, buffer_mode="buffered")
    assert later.start_s == pytest.approx(waits.travel_time_s, abs=2 * engine.period)
    assert later.duration_s > later.start_s
