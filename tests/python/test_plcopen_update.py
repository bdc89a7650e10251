"""Blocks whose inputs change while they are executed."""

from __future__ import annotations

from typing import Any

import pytest
import takt
from takt.plcopen import (
    MC_GearIn,
    MC_MoveAbsolute,
    MC_MoveAdditive,
    MC_MoveContinuousAbsolute,
    MC_MoveRelative,
    MC_MoveVelocity,
    MC_TorqueControl,
)

MACHINE = """
name: updates
axes:
  - {name: x, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: y, limits: {velocity: 600, acceleration: 6000, jerk: 120000}}
"""


def run(s: takt.Engine, block: Any, seconds: float, **inputs: Any) -> None:
    for _ in range(round(seconds / s.period)):
        block(Execute=True, **inputs)
        s.step()


@pytest.fixture
def s() -> Any:
    with takt.Engine(MACHINE) as engine:
        for axis in engine.axes.values():
            axis.power().wait()
        yield engine


@pytest.mark.parametrize("updates", [True, False])
@pytest.mark.parametrize(
    ("block_of", "first", "then", "ends"),
    [
        (MC_MoveAbsolute, {"Position": 60.0}, {"Position": 85.0}, 85.0),
        (MC_MoveAbsolute, {"Position": 60.0}, {"Position": 10.0}, 10.0),
        (MC_MoveRelative, {"Distance": 60.0}, {"Distance": 47.5}, 47.5),
        (MC_MoveAdditive, {"Distance": 60.0}, {"Distance": 72.5}, 72.5),
    ],
)
def test_a_position_changes_on_the_way(
    s: takt.Engine, updates: bool, block_of: Any, first: dict[str, float], then: dict[str, float], ends: float
) -> None:
    """AX-111: with ContinuousUpdate at the rising edge, and only then; a distance counts from where the move began."""
    x = s.axis("x")
    block = block_of(x, Velocity=120.0, ContinuousUpdate=updates)
    with s.record("x") as recorder:
        run(s, block, 0.3, **first)
        run(s, block, 1.5, **then)
    assert block.Done
    assert not block.CommandAborted
    assert x.set_position == pytest.approx(ends if updates else 60.0)
    takt.expect.within_limits(recorder.recording, "x")


def test_velocities_gears_and_torques_change(s: takt.Engine) -> None:
    """AX-111: InVelocity, InGear and InTorque fall and rise again."""
    x, y = s.axis("x"), s.axis("y")
    move = MC_MoveVelocity(x, ContinuousUpdate=True)
    run(s, move, 0.4, Velocity=80.0)
    assert (move.InVelocity, x.set_velocity) == (True, 80)
    move(Velocity=140.0)
    s.step(3)
    assert not move().InVelocity
    run(s, move, 0.4)
    assert (move.InVelocity, x.set_velocity) == (True, 140)
    gear = MC_GearIn(y, Master=x, ContinuousUpdate=True)
    for ratio in (1.0, 2.5, -1.0):
        run(s, gear, 0.6, RatioNumerator=ratio)
        assert gear.InGear
        assert y.set_velocity == pytest.approx(140 * ratio)
    run(s, move, 0.4, Velocity=1000.0)  # more than the axis can
    assert move.Error
    assert "velocity" in move.ErrorText
    assert x.set_velocity == 140
    torque = MC_TorqueControl(y, ContinuousUpdate=True, Torque=4.0)
    run(s, torque, 0.5, Velocity=50.0)
    run(s, torque, 0.8, Velocity=90.0)
    assert y.actual_velocity == pytest.approx(90, abs=1)
    onwards = MC_MoveContinuousAbsolute(x, Position=900.0, EndVelocity=50.0, Velocity=100.0, ContinuousUpdate=True)
    run(s, onwards, 0.2)
    run(s, onwards, 0.5, EndVelocity=20.0, Position=x.set_position + 30)
    assert onwards.InEndVelocity
    assert x.set_velocity == pytest.approx(20)


def test_what_waits_changes_when_its_turn_comes(s: takt.Engine) -> None:
    """AX-111: a buffered block is not given twice."""
    x = s.axis("x")
    first = MC_MoveAbsolute(x, Position=30.0, Velocity=100.0)
    second = MC_MoveAbsolute(x, Position=50.0, Velocity=100.0, BufferMode=1, ContinuousUpdate=True)
    for i in range(1500):
        first(Execute=True)
        second(Execute=i > 3, Position=50.0 if i < 50 else 70.0)
        s.step()
    assert first.Done
    assert second.Done
    assert x.set_position == pytest.approx(70)
