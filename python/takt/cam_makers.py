"""Cams from the data of a machine and its product, checked against the limits of the slave.

    knife = RotaryKnife(circumference=500, blades=1, cut_zone=20, limits=Limits(velocity=3000, acceleration=200_000))
    table = knife.cam(437.5, speed=1000)  # x: mm of web, y: deg of the knife

What is impossible is told as `takt.ConfigError`: which limit, by how much, and what would do.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from takt.cam import Table
from takt.errors import ConfigError

SEARCH_STEPS = 60  # of a bisection: as near as numbers go


@dataclass(frozen=True)
class Limits:
    """Of a slave, in its own unit: deg/s, deg/s², deg/s³ for a knife."""

    velocity: float = math.inf
    acceleration: float = math.inf
    jerk: float = math.inf


@dataclass(frozen=True)
class RotaryKnife:
    """A rotary knife or cross cutter above a running web.

    circumference: mm, of the circle of the blades' edges.
    blades: evenly spaced around it.
    cut_zone: mm of web before and behind each cut in which the blade runs with the web.
    limits: of the knife's axis, which counts deg.
    may_reverse: the knife may turn back between two cuts; else long products are refused where it would.
    """

    circumference: float
    blades: int = 1
    cut_zone: float = 0.0
    limits: Limits = Limits()
    may_reverse: bool = False

    def __post_init__(self) -> None:
        wrong = []
        if not (math.isfinite(self.circumference) and self.circumference > 0):
            wrong.append(f"circumference: expected a number of mm above 0, found {self.circumference!r}")
        if isinstance(self.blades, bool) or not isinstance(self.blades, int) or self.blades < 1:
            wrong.append(f"blades: expected a whole number from 1 on, found {self.blades!r}")
        if not (math.isfinite(self.cut_zone) and self.cut_zone >= 0):
            wrong.append(f"cut_zone: expected a number of mm from 0 on, found {self.cut_zone!r}")
        for name in ("velocity", "acceleration", "jerk"):
            if not getattr(self.limits, name) > 0:
                wrong.append(f"limits.{name}: expected a number above 0, found {getattr(self.limits, name)!r}")
        if not wrong and 2 * self.cut_zone >= self.circumference / self.blades:
            most = self.circumference / self.blades / 2
            wrong.append(
                f"cut_zone: expected less than {most:g} mm, half of the way of a blade, found {self.cut_zone:g}"
            )
        if wrong:
            raise ConfigError(wrong)

    @property
    def pitch(self) -> float:
        """deg from one blade to the next."""
        return 360.0 / self.blades

    def cam(self, length: float, *, speed: float, name: str | None = None) -> Table:
        """The cyclic cam for products of `length` mm: x in mm of web from one cut to the next, y in deg.

        speed: mm/s, the highest of the web: the limits hold up to there.
        """
        if not (math.isfinite(speed) and speed > 0):
            raise ConfigError([f"speed: expected a number of mm/s above 0, found {speed!r}"])
        if not (math.isfinite(length) and length > 2 * self.cut_zone):
            raise ConfigError(
                [f"length: expected more than {2 * self.cut_zone:g} mm, twice the cut zone, found {length!r}"]
            )
        table = self._made(length, name or f"knife_{length:g}")
        problem = self._problem(table, speed)
        if problem:
            raise ConfigError([f"length {length:g} mm at {speed:g} mm/s: {problem}; {self._remedy(length, speed)}"])
        return table

    def _made(self, length: float, name: str) -> Table:
        zone, per_mm = self.cut_zone, 360.0 / self.circumference
        run = {"begin_v": per_mm, "begin_a": 0.0, "end_v": per_mm, "end_a": 0.0}
        middle = {"to": {"x": length - zone, "y": self.pitch - zone * per_mm}, **run}
        if not zone:
            segments: list[dict[str, Any]] = [middle]
        else:
            into = {"to": {"x": zone, "y": zone * per_mm}, "law": "line"}
            out = {"to": {"x": length, "y": self.pitch}, "law": "line"}
            segments = [into, middle, out]
        return Table.from_segments(segments, name=name, cyclic=True, x_unit="mm", y_unit="deg")

    @staticmethod
    def _peaks(table: Table, speed: float) -> dict[str, float]:
        """The knife's largest velocity, acceleration and jerk at this speed of the web, exact from the polynomials."""
        extremes = table.extremes()
        most = [max(abs(b.least.value), abs(b.greatest.value)) for b in (extremes.dy, extremes.ddy, extremes.dddy)]
        names = ("velocity", "acceleration", "jerk")
        return {name: most[i] * speed ** (i + 1) for i, name in enumerate(names)}

    def _reverses(self, table: Table) -> bool:
        return not self.may_reverse and table.extremes().dy.least.value < -1e-9 * 360 / self.circumference

    def _problem(self, table: Table, speed: float) -> str:
        for name, peak in self._peaks(table, speed).items():
            limit = getattr(self.limits, name)
            if peak > limit * (1 + 1e-9):
                return f"the knife's {name} would be {peak:.6g}, its limit is {limit:g}"
        return "the knife would turn back between two cuts" if self._reverses(table) else ""

    def highest_speed(self, length: float) -> float:
        """mm/s of web up to which the limits hold for products of this length; 0: the knife would turn back."""
        table = self._made(length, "knife")
        if self._reverses(table):
            return 0.0
        at_one = self._peaks(table, 1.0)
        return min(
            (getattr(self.limits, name) / peak) ** (1 / k) if peak else math.inf
            for k, (name, peak) in enumerate(at_one.items(), 1)
        )

    def _remedy(self, length: float, speed: float) -> str:
        slower = self.highest_speed(length)
        synchronous = self.circumference / self.blades  # at this length the knife runs evenly
        if self.highest_speed(synchronous) < speed:
            return f"up to {slower:.6g} mm/s it would do; at {speed:g} mm/s no length would"
        bad, good = length, synchronous
        for _ in range(SEARCH_STEPS):
            middle = (bad + good) / 2
            if self.highest_speed(middle) < speed:
                bad = middle
            else:
                good = middle
        bound = "at least" if length < synchronous else "at most"
        which = f"{bound} {good:.6g} mm would do at this speed"
        return which if slower == 0 else f"up to {slower:.6g} mm/s it would do, or {which}"
