"""Conversion between the units of an axis and the integers of its drive (AX-87)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

WORD = 1 << 32


def signed(value: int, bits: int = 32) -> int:
    """Returns the value modulo 2^bits as a signed number."""
    value &= (1 << bits) - 1
    return value - (1 << bits) if value >> (bits - 1) else value


def clamped(value: float, bits: int) -> int:
    """Returns the nearest integer that a signed object of this many bits holds; 0 if the value is not finite."""
    if not math.isfinite(value):
        return 0
    edge = 1 << (bits - 1)
    return max(-edge, min(edge - 1, round(value)))


@dataclass
class Unwrapped:
    """A 32-bit counter extended without limit: each new value is the nearest one to the last."""

    total: int | None = None

    def take(self, word: int) -> int:
        self.total = signed(word) if self.total is None else self.total + signed(word - self.total)
        return self.total


@dataclass(frozen=True)
class Scaling:
    """Ratio of an axis' encoder counts in the engine to increments of its drive.

    increments_per_count: exact, so that nothing drifts however far an endless axis turns.
    velocity_factor: units of the drive's velocities in 1 increment/s.
    rated_torque: Nm, or N: torque objects are thousandths of it.
    """

    increments_per_count: Fraction = Fraction(1)
    velocity_factor: float = 1.0
    rated_torque: float = 1.0

    def increments(self, counts: float) -> int:
        """Returns the target position for these counts, as the object of 32 bits holds it; counts may be unwrapped. 0
        if they are not finite."""
        ratio = self.increments_per_count
        if not math.isfinite(counts):
            return 0
        return signed(round(counts) if ratio == 1 else round(Fraction(counts) * ratio))

    def counts(self, increments: int) -> int:
        """Returns the counts for an unwrapped position of the drive."""
        ratio = self.increments_per_count
        return increments if ratio == 1 else round(increments / ratio)

    def velocity(self, counts_s: float) -> int:
        """Returns the target velocity, in units of the drive, for counts/s."""
        return clamped(counts_s * float(self.increments_per_count) * self.velocity_factor, 32)

    def torque(self, nm: float) -> int:
        """Returns the torque in thousandths of the rated torque."""
        return clamped(1000 * nm / self.rated_torque, 16)

    def torque_limit(self, nm: float) -> int:
        """Returns the object "max torque" (0x6072) for a limit [Nm]; 0xFFFF, the drive's own limit, if it is 0 or
        infinite."""
        return min(0xFFFF, round(1000 * nm / self.rated_torque)) if 0 < nm < math.inf else 0xFFFF

    def torque_nm(self, thousandths: int) -> float:
        return thousandths * self.rated_torque / 1000


def scaling_of(drive: Mapping[str, Any], axis: Mapping[str, Any], rated_torque: float = 1.0) -> Scaling:
    """Returns the scaling of a drive under `external: buses:` of a machine file for its axis."""
    given = drive.get("scaling")
    ratio = Fraction(1)
    if given:
        exact = {name: Fraction(str(value)) for name, value in given.items()}
        per_unit = exact["increments_per_revolution"] * exact["gear_motor"] / exact["gear_shaft"] / exact["feed"]
        ratio = per_unit / Fraction(str(axis["encoder"]["increments_per_unit"]))
    return Scaling(ratio, float(drive.get("velocity_factor") or 1.0), float(drive.get("rated_torque") or rated_torque))
