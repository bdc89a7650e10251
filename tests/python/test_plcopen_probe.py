"""Touch probe and torque control as function blocks (AX-42, AX-49)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
import takt
from machines import MACHINE
from takt._commands import Direction, TouchMode
from takt.plcopen import (
    GT_Touch,
    MC_AbortTrigger,
    MC_MoveAbsolute,
    MC_MoveVelocity,
    MC_TorqueControl,
    MC_TouchProbe,
)

WITH_PROBE = (
    MACHINE
    + """\
simulation:
  servos:
    - {axis: x, mechanics: {inertia: 0.001, upper_stop: 150}, switches: {touch_probe: {from: 60, to: 70}}}
"""
)


@pytest.fixture
def x() -> Iterator[takt.Axis]:
    with takt.Engine(WITH_PROBE) as engine:
        engine.axis("x").power().wait()
        yield engine.axis("x")


def step(axis: takt.Axis, cycles: int = 1) -> None:
    assert isinstance(axis.session, takt.Engine)
    axis.session.step(cycles)


def until(axis: takt.Axis, condition: Callable[[], bool], *blocks: Callable[[], Any]) -> None:
    """Calls the blocks before every cycle until the condition holds."""
    for _ in range(5000):
        for block in blocks:
            block()
        if condition():
            return
        step(axis)
    raise AssertionError("it never came")


def test_touch_probe_records_the_position(x: takt.Axis) -> None:  # AX-49
    probe, move = MC_TouchProbe(x), MC_MoveAbsolute(x)
    probe(Execute=True)
    assert probe.outputs["Busy"]
    assert not probe.outputs["Done"]
    move(Execute=True, Position=100, Velocity=200)
    until(x, lambda: probe.Done, probe, move)
    assert probe.RecordedPosition == pytest.approx(60, abs=200 * 20e-6 + 0.001)
    assert not probe.Busy
    assert move.Busy
    until(x, lambda: move.Done, probe, move)
    probe(Execute=False)
    assert not probe.Done


def test_abort_trigger_ends_all_that_wait(x: takt.Axis) -> None:  # AX-49, AX-109
    first, second, abort = MC_TouchProbe(x), MC_TouchProbe(x), MC_AbortTrigger(x)
    first(Execute=True)
    step(x)
    second(Execute=True)
    step(x)
    assert first.Busy
    assert second.Busy
    abort(Execute=True)
    until(x, lambda: first.CommandAborted and second.CommandAborted, first, second, abort)
    assert abort().Done


def test_touch_returns_to_the_position(x: takt.Axis) -> None:  # AX-49
    touch, move = GT_Touch(x), MC_MoveVelocity(x)
    touch(Execute=True, Velocity=50)
    move(Execute=True, Velocity=300)
    until(x, lambda: touch.Active, touch, move)
    assert x.set_position > 60
    until(x, lambda: touch.Done, touch, move)
    assert move.CommandAborted
    assert touch.RecordedPosition == pytest.approx(60, abs=0.01)
    assert x.set_position == pytest.approx(touch.RecordedPosition)


def test_touch_keeps_its_position(x: takt.Axis) -> None:
    """AX-49, AX-109: other probes of the axis do not change RecordedPosition; the command has it as its value."""
    touch, other = GT_Touch(x, Velocity=50), MC_TouchProbe(x, TriggerInput="falling")
    touch(Execute=True)
    other(Execute=True)
    x.move_velocity(velocity=500)
    until(x, lambda: touch.Done, touch, other)
    assert other.Done
    assert other.RecordedPosition == pytest.approx(70, abs=0.02)
    assert touch.RecordedPosition == pytest.approx(60, abs=0.02)
    assert x.set_position == pytest.approx(touch.RecordedPosition)
    other(Execute=False)
    other(Execute=True)
    x.move_relative(distance=20).wait()
    assert other().Done
    assert touch().RecordedPosition == pytest.approx(60, abs=0.02)
    x.move_absolute(position=0).wait()
    again = x.touch(velocity=50)
    x.move_velocity(velocity=100)
    assert again.wait().value == x.probe_position == pytest.approx(60, abs=0.01)


def test_touch_slows_down_as_long_as_execute_is_true(x: takt.Axis) -> None:  # AX-49
    slow, move = GT_Touch(x, Mode=TouchMode.SLOW, Velocity=20), MC_MoveAbsolute(x)
    slow(Execute=True)
    move(Execute=True, Position=100, Velocity=100)
    until(x, lambda: x.set_position > 68, slow, move)
    assert x.set_velocity == pytest.approx(20)
    assert slow.Busy
    assert slow.Active
    slow(Execute=False)
    until(x, lambda: move.Done, slow, move)
    x.move_absolute(position=0).wait()
    fast = MC_MoveAbsolute(x)
    fast(Execute=True, Position=100, Velocity=100)
    until(x, lambda: x.set_position > 68, fast)
    assert x.set_velocity == pytest.approx(100)


def test_torque_control_presses(x: takt.Axis) -> None:  # AX-42
    press = MC_TorqueControl(x)
    press(Execute=True, Torque=3, TorqueRamp=30, Velocity=100)
    until(x, lambda: press.InTorque, press)
    assert press.Busy
    assert press.Active
    until(x, lambda: x.actual_position > 149.999, press)
    step(x, 50)
    assert x.torque_nm == pytest.approx(3)
    back = MC_TorqueControl(x)
    back(Execute=True, Torque=1, Velocity=50, Direction=Direction.NEGATIVE)
    until(x, lambda: x.actual_position < 50, press, back)
    assert press.CommandAborted
    assert abs(x.actual_velocity) <= 51
    x.halt().wait()


def test_torque_control_takes_directions_as_text(x: takt.Axis) -> None:
    """AX-42, AX-11: another value is an error that names the input, and moves nothing."""
    press = MC_TorqueControl(x, Torque=1, Velocity=50, Direction="negative")
    press(Execute=True)
    until(x, lambda: x.set_velocity < -40, press)
    press(Execute=False)
    x.halt().wait()
    for value in (3, "NEGATIVE", None):
        wrong = MC_TorqueControl(x, Torque=1, Velocity=50, Direction=value)
        assert (wrong(Execute=True).Error, wrong.ErrorID, wrong.Busy) == (True, 5, False)
        assert wrong.ErrorText == f"Direction: expected one of current, positive, shortest, negative, found {value!r}"
        step(x, 50)
        assert x.set_velocity == 0
        assert wrong().Error
        assert not wrong(Execute=False).Error
    wrong(Execute=True, Direction="positive")
    until(x, lambda: x.set_velocity > 40, wrong)
    changed = MC_TorqueControl(x, Torque=1, Velocity=50, ContinuousUpdate=True)
    changed(Execute=True)
    until(x, lambda: changed.InTorque, changed)
    assert changed(Direction="downwards").Error
    step(x, 50)
    assert changed().Error
    assert x.set_velocity > 40
