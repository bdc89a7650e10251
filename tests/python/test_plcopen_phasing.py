"""How far a phase has been shifted, as blocks show it."""

from __future__ import annotations

from typing import Any

import pytest
import takt
from takt.plcopen import MC_PhasingAbsolute, MC_PhasingRelative

MACHINE = """
name: phases
axes:
  - {name: x, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: y, limits: {velocity: 600, acceleration: 6000, jerk: 120000}}
"""


def run(s: takt.Engine, block: Any, seconds: float) -> None:
    for _ in range(round(seconds / s.period)):
        block(Execute=True)
        s.step()
    block()


@pytest.fixture
def s() -> Any:
    with takt.Engine(MACHINE) as engine:
        for axis in engine.axes.values():
            axis.power().wait()
        yield engine


def test_how_far_a_shift_is(s: takt.Engine) -> None:
    """AX-111: CoveredPhaseShift counts from where the shift began, AbsolutePhaseShift from none."""
    x, y = s.axis("x"), s.axis("y")
    y.gear_in(master="x", ratio_numerator=2)
    s.run(0.4)
    x.move_velocity(velocity=50)
    s.run(0.4)
    lag = y.set_position - 2 * x.set_position
    absolute = MC_PhasingAbsolute(y, Master=x, PhaseShift=8.0, Velocity=40.0)
    run(s, absolute, 0.15)
    assert absolute.Active
    assert 0.5 < absolute.AbsolutePhaseShift < 7.5
    assert y.phase_shift == absolute.AbsolutePhaseShift
    assert y.set_position - 2 * x.set_position - lag == pytest.approx(2 * y.phase_shift, abs=1e-6)
    run(s, absolute, 0.5)
    assert absolute.Done
    assert absolute.AbsolutePhaseShift == pytest.approx(8)
    relative = MC_PhasingRelative(y, Master=x, PhaseShift=-5.0, Velocity=40.0)
    run(s, relative, 0.1)
    assert -4.9 < relative.CoveredPhaseShift < -0.1
    assert y.phase_shift == pytest.approx(8 + relative.CoveredPhaseShift)
    again = MC_PhasingRelative(y, Master=x, PhaseShift=2.0, Velocity=40.0)  # takes over from the other one
    run(s, again, 0.01)
    relative()
    assert relative.CommandAborted
    begun = y.phase_shift - y.covered_phase_shift
    run(s, again, 0.6)
    assert again.Done
    assert again.CoveredPhaseShift == pytest.approx(2)  # and nothing of the one before
    assert y.phase_shift - again.CoveredPhaseShift == pytest.approx(begun)
    y.gear_out().wait()
    s.step()
    assert (y.phase_shift, y.covered_phase_shift) == (0, 0)


def test_a_deceleration_left_out_is_that_of_the_axis() -> None:
    """AX-111: whatever acceleration the command gives."""
    with takt.Engine(MACHINE.replace("acceleration: 6000,", "acceleration: 6000, deceleration: 1000,")) as engine:
        for axis in engine.axes.values():
            axis.power().wait()
        y = engine.axis("y")
        y.gear_in(master="x")
        engine.run(0.1)
        with engine.record() as recorder:
            y.phasing_relative(phase_shift=20, velocity=100, acceleration=3000).wait()
        acceleration = recorder.recording["y"]["set_acceleration"]
        assert 2000 < max(acceleration) < 3000.1
        assert -1000.1 < min(acceleration) < -900


def test_what_is_refused_covers_nothing(s: takt.Engine) -> None:
    """AX-111: in no state but in a coupling to one master; values that are none."""
    y = s.axis("y")
    for before in (lambda: None, lambda: y.move_velocity(velocity=20), y.halt, lambda: y.power(enable=False)):
        before()
        s.run(0.2)
        block = MC_PhasingRelative(y, Master="x", PhaseShift=5.0)
        run(s, block, 0.01)
        assert block.Error
        assert block.CoveredPhaseShift == 0
    y.power().wait()
    y.gear_in(master="x")
    s.run(0.4)
    for bad in ({"PhaseShift": float("nan")}, {"Velocity": -1.0}, {"Velocity": 0.0}, {"Jerk": float("inf")}):
        block = MC_PhasingAbsolute(y, Master="x", **bad)
        run(s, block, 0.01)
        assert block.Error, bad
        assert y.phase_shift == 0
