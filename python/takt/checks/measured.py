"""Quantities compared with their bounds, and the verdict on them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from takt.checks.series import Check, Mask, Series, extent, nearest
from takt.recording import FloatArray
from takt.verdict import Bound, Lane, Trace, Verdict, number, seconds

_ABOVE: Literal["above"] = "above"
_BELOW: Literal["below"] = "below"
_TINY = 1e-300
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Measured:
    """One quantity compared with its bounds; an excess > 0 violates them."""

    what: str  # "velocity"
    unit: str
    time_s: FloatArray
    values: FloatArray
    excess: FloatArray
    scale: float  # excess / scale is comparable between quantities
    bounds: tuple[Bound, ...]
    label: str
    says: str  # "velocity limit of 100 mm/s"

    @property
    def broken(self) -> Mask:
        return self.excess > 0

    def lane(self) -> Lane:
        return Lane(self.what, self.unit, (Trace(self.label, self.time_s, self.values),), self.bounds)


def in_range(what: str, s: Series, lower: float, upper: float, tolerance: float) -> Measured:
    """Returns values compared with two bounds, one of which may be infinite; `tolerance` is relative to the larger
    bound."""
    sides = [limit for limit in (lower, upper) if math.isfinite(limit)]
    scale = max(abs(limit) for limit in sides)
    excess = np.maximum(s.values - upper, lower - s.values)
    kept = excess <= tolerance * scale
    excess[kept] = np.minimum(excess[kept], 0)
    bounds = tuple(
        Bound.level(f"{name} limit {number(limit, s.unit)}", limit, s.span, side)
        for name, limit, side in (("upper", upper, _ABOVE), ("lower", lower, _BELOW))
        if math.isfinite(limit)
    )
    span = f"{number(lower)} … {number(upper, s.unit)}"
    says = f"range {span} for the {what}" if " " in what else f"{what} range {span}"
    return Measured(what, s.unit, s.time_s, s.values, excess, max(scale, _TINY), bounds, s.label, says)


def jerk_against(what: str, s: Series, steps: FloatArray, limit: float, tolerance: float, label: str) -> Measured:
    """Returns the mean jerk of each interval between samples (steps of the acceleration over the times between them),
    compared with a jerk limit; `tolerance` is relative. Four units in the last place of the largest subtracted number
    are added to it, for rounding."""
    dt = np.diff(s.time_s)
    rounding = 4 * EPS * (np.max(np.abs(s.values)) + limit * np.max(np.abs(s.time_s))) / dt
    unit = s.unit.replace("s²", "s³")
    return against(what, unit, s.time_s[:-1], steps / dt, limit, limit * tolerance + rounding, label)


def against(
    what: str,
    unit: str,
    time_s: FloatArray,
    values: FloatArray,
    limit: float | FloatArray,
    margin: float | FloatArray,
    label: str,
) -> Measured:
    """Returns absolute values compared with a limit; an excess of up to `margin` (absolute, in `unit`) counts as
    kept."""
    levels = np.broadcast_to(np.asarray(limit, dtype=np.float64), values.shape)
    excess = np.abs(values) - levels
    kept = excess <= margin
    excess[kept] = np.minimum(excess[kept], 0)
    typical = float(np.median(levels))
    amount = number(typical if kept.all() else float(levels[np.argmax(excess)]), unit)
    says = f"limit of {amount} for the {what}" if " " in what else f"{what} limit of {amount}"
    bounds = (
        Bound(f"limit ±{number(typical, unit)}", time_s, levels, _ABOVE),
        Bound("", time_s, -levels, _BELOW),
    )
    return Measured(what, unit, time_s, values, excess, max(typical, _TINY), bounds, label, says)


def bounded(name: str, limit: float | None) -> float | None:
    """Returns the limit; None if it is None or infinite. Raises ValueError if it is NaN or negative."""
    if limit is not None and not limit >= 0:
        raise ValueError(f"the {name} limit {limit} is not a positive number")
    return None if limit is None or math.isinf(limit) else float(limit)


def judge(
    check: Check,
    component: str,
    found: Sequence[Measured],
    kept: str,
    broke: str,
    lanes: Sequence[Lane] = (),
) -> Verdict:
    # Returns the verdict on several quantities of one component; requires `found` not to be empty. Reports the one
    # with the largest relative excess (excess / scale) or, if none is violated, with the smallest relative margin.
    worst = max(found, key=lambda m: (bool(m.broken.any()), float(np.max(m.excess)) / m.scale))
    at = int(np.argmax(worst.excess))
    amount, when = float(worst.excess[at]), float(worst.time_s[at])
    if amount <= 0:
        return check.verdict(
            True,
            f"{component} {kept}; {nearest(abs(amount), worst.unit, when)} ({worst.what})",
            when_s=when,
            by=abs(amount),
            unit=worst.unit,
            lanes=(*lanes, *(m.lane() for m in found)),
        )
    place, where = extent(worst.time_s, worst.broken)
    others = [m.what for m in found if m is not worst and m.broken.any()]
    sentence = (
        f"{component} {broke} its {worst.says} by {number(amount, worst.unit)}: "
        f"{number(float(worst.values[at]), worst.unit)} at {seconds(when)} ({where})"
    )
    if others:
        sentence += f"; also {', '.join(others)}"
    return check.verdict(
        False,
        sentence,
        when_s=place[0],
        by=amount,
        unit=worst.unit,
        place=place,
        lanes=(*lanes, worst.lane()),
    )
