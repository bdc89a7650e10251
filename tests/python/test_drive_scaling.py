"""AX-87: units of an axis against the integers of a drive."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
import takt
from hypothesis import given
from hypothesis import strategies as st
from takt import drive
from takt.drives.axis import DriveAxis, Heard
from takt.drives.cia402 import Mode, PowerStateMachine, State
from takt.drives.scaling import Scaling, Unwrapped, scaling_of, signed
from takt.plant import Drives

AXIS = {"encoder": {"increments_per_unit": 1000.0}}


@given(st.integers(-(2**40), 2**40), st.lists(st.integers(-(2**31) + 1, 2**31 - 1), max_size=30))
def test_counters_wrap(start: int, steps: list[int]) -> None:
    """AX-87: a counter of 32 bits goes on for ever, whichever way."""
    counter, position = Unwrapped(), start
    origin = start - counter.take(start & 0xFFFF_FFFF)
    for step in steps:
        position += step
        assert counter.take(position & 0xFFFF_FFFF) + origin == position


@given(
    st.integers(1, 1 << 24),
    st.integers(1, 100),
    st.integers(1, 100),
    st.integers(1, 1000),
    st.integers(-(10**9), 10**9),
)
def test_gears_are_exact(resolution: int, motor: int, shaft: int, feed: int, counts: int) -> None:
    """AX-87: there and back within half a count, however far the axis has gone."""
    drive = {
        "scaling": {
            "increments_per_revolution": float(resolution),
            "gear_motor": float(motor),
            "gear_shaft": float(shaft),
            "feed": float(feed),
        }
    }
    scaling = scaling_of(drive, AXIS)
    ratio = Fraction(resolution * motor, shaft * feed * 1000)
    assert scaling.increments_per_count == ratio
    there = scaling.increments(counts)
    assert there == signed(round(counts * ratio))
    back = scaling.counts(round(counts * ratio))
    assert abs(back - counts) <= Fraction(1, 2) + Fraction(1, 2) / ratio


def test_a_count_is_an_increment_unless_told_otherwise() -> None:
    """AX-87: and a target beyond 32 bits wraps as the counter does."""
    scaling = scaling_of({}, AXIS)
    assert [scaling.increments(x) for x in (0.4, -7.6, 2.0**31, 2.0**32 + 5, -(2.0**31) - 1)] == [
        0,
        -8,
        -(2**31),
        5,
        2**31 - 1,
    ]


def test_velocities_and_torques() -> None:
    """AX-87: scaled, and clamped instead of wrapped: a speed must not turn round."""
    scaling = Scaling(Fraction(4), velocity_factor=0.5, rated_torque=2.0)
    assert scaling.velocity(1000.0) == 2000
    assert scaling.velocity(1e12) == 2**31 - 1
    assert scaling.velocity(math.nan) == scaling.increments(math.inf) == 0
    assert scaling.torque(-1.0) == -500
    assert scaling.torque(1e9) == 32767
    assert scaling.torque_nm(-500) == pytest.approx(-1.0)
    assert [scaling.torque_limit(nm) for nm in (0.0, 3.0, 1e6, math.inf)] == [0xFFFF, 1500, 0xFFFF, 0xFFFF]


class Followed(drive.Drive):
    """A drive that is in each cycle where it was told to be in the one before, and what it was told at most."""

    def __init__(self, ratio: Fraction, position: int) -> None:
        self.axis = DriveAxis("x", "it", Scaling(ratio), {}, frozenset({Mode.CYCLIC_POSITION}), lambda _: None)
        self.machine, self.position, self.time_s, self.furthest = PowerStateMachine(), position, 0.0, 0
        self.machine.started()

    def step(self, told: drive.SetPoint, _: float) -> drive.Measured:
        self.time_s += 0.001
        words = self.axis.words(told, self.time_s)
        self.machine.control(words.control)
        step = signed(words.position - self.position)
        self.furthest = max(self.furthest, abs(step))
        if self.axis.state is State.OPERATION_ENABLED and abs(step) < 1 << 29:
            self.position = signed(self.position + step)
        heard = Heard(self.machine.status_word(), self.position, 0, 0, int(Mode.CYCLIC_POSITION))
        return self.axis.measured(heard, self.time_s)


ENDLESS = """
name: endless
axes:
  - name: x
    limits: {velocity: 30000, acceleration: 1000000, jerk: 1000000000}
    encoder: {increments_per_unit: 1000000}
    supervision: {deviation_moving: 1000}
"""


@pytest.mark.parametrize("ratio", ["1", "3/2", "10/3", "1/4"])
@pytest.mark.parametrize("start", [0, 600_000_000])
def test_an_engine_that_starts_later_does_not_make_the_drive_jump(ratio: str, start: int) -> None:
    """AX-87: the engine counts from what it hears first; the drive may have wrapped before, at any ratio."""
    followed = Followed(Fraction(ratio), start)
    for _ in range(2):
        with takt.Engine(ENDLESS, plant=Drives({"x": followed})) as engine:
            engine.step(5)
            followed.furthest = 0
            axis = engine.axis("x")
            axis.power().wait()
            engine.step(20)
            assert followed.furthest <= 1  # rounding
            axis.move_relative(distance=2500).wait()
            assert 0 < followed.furthest < 1 << 28
