"""The basis of all checks: takes columns from a recording, and rejects data that cannot be judged."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ParamSpec

import numpy as np
import numpy.typing as npt

from takt.counted import counted
from takt.missing import missing
from takt.recording import Array, FloatArray, Recording
from takt.verdict import Interval, Lane, Trace, Verdict, number, seconds

P = ParamSpec("P")
Mask = npt.NDArray[np.bool_]

ROUNDING = 1e-9  # relative difference of numbers that count as equal
NEAR_ZERO = 1e-3  # numbers below this are compared absolutely, by 1e-12 in the signal's unit
LAST_PLACES = 16 * float(np.finfo(np.float64).eps)  # relative: error of a difference of two rounded numbers

SHARE_IN_COMMON = 0.9  # of the samples of two components; the rest may be lost

NOT_NEGATIVE = ("tolerance", "jerk_tolerance", "slack", "step", "within", "hold")

CAM_AXES = ("x", "y")  # in units of their own
TOOL = {**dict.fromkeys("xyz", "position"), **dict.fromkeys("abc", "orientation")}
QUANTITIES = ("position", "velocity", "acceleration", "jerk", "error", "torque", "voltage", "state")


class UndecidedError(Exception):
    """Raised inside a check if the data cannot be judged; carries the failed verdict."""

    def __init__(self, verdict: Verdict) -> None:
        super().__init__(verdict.sentence)
        self.verdict = verdict


def decided(check: Callable[P, Verdict]) -> Callable[P, Verdict]:
    """Turns UndecidedError into the failed verdict that it carries."""

    @functools.wraps(check)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> Verdict:
        try:
            return check(*args, **kwargs)
        except UndecidedError as undecided:
            return undecided.verdict

    return wrapper


def sound(name: str, **numbers: float) -> None:
    """Raises ValueError if an argument of the check `name` is infinite or NaN, or if a width or duration is
    negative."""
    for what, value in numbers.items():
        if not math.isfinite(value):
            raise ValueError(f"{name}: {what} is {value}, not a number")
        if what in NOT_NEGATIVE and value < 0:
            raise ValueError(f"{name}: {what} is negative")


@dataclass(frozen=True)
class Series:
    """One column within the window of a check, as finite numbers."""

    component: str
    field: str
    unit: str
    time_s: FloatArray
    cycle: Array
    values: FloatArray
    modulus: float | None

    @property
    def label(self) -> str:
        return f"{self.component}.{self.field}"

    @property
    def span(self) -> Interval:
        return float(self.time_s[0]), float(self.time_s[-1])

    def trace(self) -> Trace:
        return Trace(self.label, self.time_s, self.values, self.modulus)

    def lane(self, **more: Any) -> Lane:
        return Lane(quantity(self.field), self.unit, (self.trace(),), **more)

    def error_to(self, target: float | FloatArray) -> FloatArray:
        """Returns values - target; on a rotary axis wrapped into [-modulus/2, modulus/2)."""
        return wrap(self.values - target, self.modulus)

    def take(self, rows: Array) -> Series:
        return Series(
            self.component,
            self.field,
            self.unit,
            self.time_s[rows],
            self.cycle[rows],
            self.values[rows],
            self.modulus,
        )


class Check:
    """One check in progress: returns series that can be judged, and makes the verdict."""

    def __init__(
        self,
        name: str,
        recording: Recording,
        components: Sequence[str],
        window: Interval | None,
        says_missing: bool = True,
    ) -> None:
        """`says_missing`: the sentences of its verdicts end with the samples that are missing."""
        if window is not None and not window[0] <= window[1]:
            raise ValueError(f"{name}: the window {window} does not run forward")
        self.name = name
        self.recording = recording
        self.components = tuple(components)
        self.window = window
        self.says_missing = says_missing

    def series(self, component: str, field: str) -> Series:
        """Returns the column in the window. Undecided, hence failed, if there is no sample, if the recording does not
        span the window, or if a value is not finite."""
        column = self.recording.column(component, field)
        table = self.recording[component]
        time_s: FloatArray = table["time_s"]
        names = self.recording.names(component, field)
        info = self.recording.info(component)
        whole = Series(
            component,
            field,
            self.recording.unit(component, field),
            time_s,
            table["cycle"],
            column.astype(np.float64),
            float(info["modulus"]) if info.get("modulus") and quantity(field) == "position" else None,
        )
        there = [whole.lane(names=names)] if len(time_s) else []  # shown if the check gives up
        inside = np.ones(len(time_s), dtype=np.bool_)
        if self.window is not None:
            inside = (time_s >= self.window[0]) & (time_s <= self.window[1])
        if not inside.any():
            where = "" if self.window is None else f" between {seconds(self.window[0])} and {seconds(self.window[1])}"
            self._give_up(f"the recording has no sample of {component}{where}", lanes=there)
        if self.window is not None:
            self._spans(component, time_s, self.window, there)
        taken = whole.take(inside)
        broken = np.flatnonzero(~np.isfinite(taken.values))
        if len(broken):
            when = float(taken.time_s[broken[0]])
            count = f" ({len(broken)} samples)" if len(broken) > 1 else ""
            self._give_up(
                f"{taken.label} is not a number ({taken.values[broken[0]]}) at {seconds(when)}{count}",
                when,
                (taken.lane(names=names),),
            )
        return taken

    def verdict(
        self,
        passed: bool,
        sentence: str,
        *,
        when_s: float | None = None,
        by: float | None = None,
        unit: str = "",
        place: Interval | None = None,
        lanes: Sequence[Lane] = (),
    ) -> Verdict:
        if self.says_missing and (lacks := missing(self.recording, self.components, self.window)):
            sentence += f"; missing: {lacks}"
        if place is None and when_s is not None and not passed:
            place = (when_s, when_s)
        return Verdict(self.name, self.components, passed, sentence, when_s, by, unit, place, tuple(lanes))

    def together(self, a: Series, b: Series) -> tuple[Series, Series]:
        """Returns the samples of both that belong to the same cycles. Undecided if these are too few: nearly all
        samples of the series with the lower rate must be among them."""
        if np.array_equal(a.cycle, b.cycle):
            return a, b
        _, rows_a, rows_b = np.intersect1d(a.cycle, b.cycle, assume_unique=True, return_indices=True)
        first, last = max(a.cycle[0], b.cycle[0]), min(a.cycle[-1], b.cycle[-1])
        wanted = min(int(np.count_nonzero((s.cycle >= first) & (s.cycle <= last))) for s in (a, b))
        advice = "publish both at one rate, or one at a multiple of the other's"
        if not len(rows_a):
            self._give_up(f"{a.component} and {b.component} have no cycle in common: {advice}")
        if len(rows_a) < SHARE_IN_COMMON * wanted:
            self._give_up(
                f"{a.component} and {b.component} have only {len(rows_a)} of {counted(wanted, 'cycle')} in common: "
                f"{advice}"
            )
        return a.take(rows_a), b.take(rows_b)

    def _spans(self, component: str, time_s: FloatArray, window: Interval, lanes: Sequence[Lane]) -> None:
        """Requires the samples to cover the window: up to one and a half usual sample intervals may be missing at each
        end."""
        slack = 1.5 * float(np.median(np.diff(time_s))) if len(time_s) > 1 else 0.0
        if time_s[-1] < window[1] - slack:
            self._give_up(
                f"the recording of {component} ends at {seconds(time_s[-1])}, before {seconds(window[1])}",
                float(time_s[-1]),
                lanes,
            )
        if time_s[0] > window[0] + slack:
            self._give_up(
                f"the recording of {component} starts at {seconds(time_s[0])}, after {seconds(window[0])}",
                float(time_s[0]),
                lanes,
            )

    def _give_up(self, sentence: str, when_s: float | None = None, lanes: Sequence[Lane] = ()) -> None:
        raise UndecidedError(self.verdict(False, sentence, when_s=when_s, lanes=lanes))


def words(field: str) -> str:
    """ "torque_nm" -> "torque", "set_position" -> "set position": a field's name for readers, who see the unit beside
    it."""
    for suffix in ("_nm", "_v", "_s", "_mm", "_deg"):
        field = field.removesuffix(suffix)
    return field.replace("_", " ")


def quantity(field: str) -> str:
    """ "set_position" -> "position", "set_x_position" -> "x position", "velocity_x" -> "velocity"; the field's own name
    if it does not end in a known quantity."""
    name = words(field)
    if name == "following error":
        return name
    *before, last = name.split(" ")
    if last in TOOL:
        return before[-1] if before and before[-1] in QUANTITIES else TOOL[last]
    if last not in QUANTITIES:
        return name
    return f"{before[-1]} {last}" if before and before[-1] in CAM_AXES else last


def sibling(position: str, wanted: str) -> str:
    """ "set_position" -> "set_velocity": the field of the same source that holds another quantity."""
    if not position.endswith("position"):
        raise ValueError(f"'{position}' is not a position: its name does not end in 'position'")
    return position.removesuffix("position") + wanted


def wrap(difference: FloatArray, modulus: float | None) -> FloatArray:
    """Returns the difference wrapped into [-modulus/2, modulus/2); unchanged if the modulus is None."""
    if modulus is None:
        return difference
    return np.mod(difference + modulus / 2, modulus) - modulus / 2


def unwrapped(series: Series) -> FloatArray:
    """Returns a rotary position without jumps at the modulus, starting from the value reported first."""
    if series.modulus is None:
        return series.values
    return np.unwrap(series.values, period=series.modulus)


def slack(level: float) -> float:
    """Returns the difference from a number up to which a value counts as equal to it."""
    return ROUNDING * max(abs(level), NEAR_ZERO)


def beyond(difference: FloatArray, tolerance: float, level: float) -> FloatArray:
    """Returns the excess of absolute differences of numbers up to `level` over a tolerance. It is above 0 only if it
    exceeds rounding: a billionth of the tolerance, and the last places of the numbers."""
    excess = np.abs(difference) - tolerance
    kept = excess <= slack(tolerance) + LAST_PLACES * abs(level)
    excess[kept] = np.minimum(excess[kept], 0)
    return excess


def runs(mask: Mask) -> list[tuple[int, int]]:
    """Returns the first and last index of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def extent(time_s: FloatArray, mask: Mask) -> tuple[Interval, str]:
    """Returns the interval [s] of the first run of True, and a text "from … to …, n samples" with the number of further
    runs. Requires at least one True."""
    (first, last), *others = runs(mask)
    place = (float(time_s[first]), float(time_s[last]))
    text = f"at {seconds(place[0])}"
    if last > first:
        text = f"from {seconds(place[0])} to {seconds(place[1])}, {counted(last - first + 1, 'sample')}"
    if others:
        text += f", and {counted(len(others), 'more time')} until {seconds(float(time_s[others[-1][1]]))}"
    return place, text


def nearest(value: float, unit: str, time_s: float) -> str:
    """Returns the closest call of a passed check as text: time, and the margin that was left."""
    return f"closest call at {seconds(time_s)}, margin {number(value, unit)}"
