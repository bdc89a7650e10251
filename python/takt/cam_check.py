"""Checks a cam, at a given motion of its master, against the limits of its slave.

result = check(table, master_velocity=360.0, limits=Limits.of_axis("machine.yaml", "x"))
print(result.passed, result.continuity, result.fastest)
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from takt import _core
from takt.cam import Bounds, Extreme, Table
from takt.engine import read_machine
from takt.errors import ConfigError

SAME = 1e-6  # of the largest velocity or acceleration: jumps up to this are rounding, or decimals of a file
TOUCHING = 1e-9  # relative tolerance of limits: a cam made for a limit touches it


def figure(value: float, scale: float = 0.0, digits: int = 6) -> str:
    """Returns a number as text; 0 if it is negligible against `scale`."""
    return f"{0.0 if abs(value) < 1e-12 * abs(scale) else value:.{digits}g}"


@dataclass(frozen=True)
class Limits:
    """Limits of a slave in its unit and [s]; None: no limit."""

    velocity: float | None = None
    acceleration: float | None = None  # and deceleration
    jerk: float | None = None
    lower: float | None = None
    upper: float | None = None

    @classmethod
    def of_axis(cls, machine: str | os.PathLike[str], name: str) -> Limits:
        """Returns the limits of an axis of a machine file. Raises ConfigError if it has no such axis."""
        text, file_name = read_machine(machine)
        axes = {axis["name"]: axis for axis in json.loads(_core.load_machine(text, file_name))["axes"]}
        if name not in axes:
            raise ConfigError([f"{file_name}: expected an axis of {', '.join(axes)}, found '{name}'"])
        limits: dict[str, float] = axes[name]["limits"]
        acceleration = limits["acceleration"]
        return cls(
            limits["velocity"],
            min(acceleration, limits.get("deceleration", acceleration)),
            limits["jerk"],
            limits.get("lower"),
            limits.get("upper"),
        )


@dataclass(frozen=True)
class Peak:
    """A peak value of the slave and its limit."""

    what: str  # "velocity"
    unit: str
    value: float  # infinite at a jump
    x: float
    limit: float | None = None
    least: bool = False  # value and limit are lower bounds, not upper ones
    slack: float = 0.0  # tolerance for rounding

    @property
    def passed(self) -> bool:
        """Whether the value is within the limit, if there is one."""
        if self.limit is None:
            return True
        if self.least:
            return self.value >= self.limit - self.slack
        return self.value <= self.limit + self.slack


@dataclass(frozen=True)
class Check:
    """The result of a check."""

    peaks: tuple[Peak, ...]
    jump_of_velocity: Extreme | None  # the largest, y/x
    jump_of_acceleration: Extreme | None  # the largest where the velocity does not jump, y/x²
    fastest: Extreme | None  # highest velocity of the master within all limits, and the x that determines it

    @property
    def passed(self) -> bool:
        return all(peak.passed for peak in self.peaks)

    @property
    def continuity(self) -> str:
        """The continuity of the cam in a sentence."""
        if self.jump_of_velocity:
            jump = self.jump_of_velocity
            return f"the velocity jumps, by {jump.value:.6g} at x {jump.x:.6g}"
        if self.jump_of_acceleration:
            jump = self.jump_of_acceleration
            return f"the acceleration jumps, by {jump.value:.6g} at x {jump.x:.6g}; the velocity has no jump"
        return "position, velocity and acceleration have no jump"


def jumps(table: Table) -> tuple[Extreme | None, Extreme | None]:
    """Returns the largest jump of velocity, and of acceleration where the velocity does not jump, including the seam of
    a cyclic cam; None: no jump."""
    joints = table.joints
    inner = joints[1:-1]
    before, behind = table.at(np.nextafter(inner, -math.inf)), table.at(inner)
    lengths = np.minimum(np.diff(joints)[:-1], np.diff(joints)[1:])
    seam = int(table.cyclic)
    x = np.append(inner, [joints[-1]] * seam)
    lengths = np.append(lengths, [joints[-1] - joints[-2]] * seam)
    ends = table.at(joints[[-1, 0]])
    all_before = [np.append(one, [end[0]] * seam) for one, end in zip(before, ends, strict=True)]
    all_behind = [np.append(one, [end[1]] * seam) for one, end in zip(behind, ends, strict=True)]
    size = [max(abs(low.value), abs(high.value)) for low, high in table.extremes()]
    velocity, acceleration = (np.abs(all_behind[k] - all_before[k]) for k in (1, 2))
    # Differences within the rounding of y over a piece of that length are not jumps.
    rough = velocity > SAME * size[1] + 1e-11 * size[0] / lengths
    hard = ~rough & (acceleration > SAME * size[2] + 1e-11 * size[0] / lengths**2)
    return _largest(x, velocity, rough), _largest(x, acceleration, hard)


def _largest(x: Any, jump: Any, counts: Any) -> Extreme | None:
    if not counts.any():
        return None
    worst = int(np.argmax(np.where(counts, jump, 0)))
    return Extreme(float(x[worst]), float(jump[worst]))


def check(
    table: Table,
    master_velocity: float | None = None,
    master_acceleration: float = 0.0,
    limits: Limits | None = None,
) -> Check:
    """Compares the peaks of the slave with its limits.

    master_velocity: largest velocity of the master [unit/s], unit of the master; None: checks positions only.
    master_acceleration: its largest acceleration [unit/s²]; the jerk of the slave is computed at constant velocity of
        the master.
    limits: None: no limits.
    """
    limits = limits or Limits()
    low, high = table.extremes().y
    unit = table.y_unit
    slack = TOUCHING * max(abs(low.value), abs(high.value))
    peaks = [
        Peak("lowest position", unit, low.value, low.x, limits.lower, least=True, slack=slack),
        Peak("highest position", unit, high.value, high.x, limits.upper, slack=slack),
    ]
    rough, hard = jumps(table)
    if master_velocity is not None:
        found = table.slave_peaks(master_velocity, master_acceleration)
        acceleration, jerk = found.acceleration, _magnitude(table.extremes().dddy)
        jerk = Extreme(jerk.x, jerk.value * master_velocity**3)
        if rough and master_velocity > 0:
            acceleration = jerk = Extreme(rough.x, math.inf)
        elif hard and master_velocity > 0:
            jerk = Extreme(hard.x, math.inf)
        rows = (
            ("velocity", f"{unit}/s", found.velocity, limits.velocity),
            ("acceleration", f"{unit}/s²", acceleration, limits.acceleration),
            ("jerk", f"{unit}/s³", jerk, limits.jerk),
        )
        for what, of, peak, limit in rows:
            peaks.append(Peak(what, of, peak.value, peak.x, limit, slack=TOUCHING * (limit or 0.0)))
    return Check(tuple(peaks), rough, hard, _fastest(table, limits, bool(rough), bool(hard)))


def _magnitude(bounds: Bounds) -> Extreme:
    worse = bounds.greatest if bounds.greatest.value >= -bounds.least.value else bounds.least
    return Extreme(worse.x, abs(worse.value))


def _fastest(table: Table, limits: Limits, rough: bool, hard: bool) -> Extreme | None:
    """Returns the highest velocity of the master within the limits, and its x; None if there are no limits, or a jump
    exceeds them at any velocity."""
    _, *derivatives = table.extremes()
    bounds = []
    for power, (bound, limit) in enumerate(
        zip(derivatives, (limits.velocity, limits.acceleration, limits.jerk), strict=True), start=1
    ):
        most = _magnitude(bound)
        if limit is not None and most.value > 0:
            bounds.append(Extreme(most.x, (limit / most.value) ** (1 / power)))
    too_hard = (rough and limits.acceleration is not None) or ((rough or hard) and limits.jerk is not None)
    return None if too_hard else min(bounds, key=lambda one: one.value, default=None)
