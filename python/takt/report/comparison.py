"""Differences between two runs: signal by signal, in figures.

    comparison = compare(before, after)
    comparison.differing[0].largest      # the signal that differs most relative to its range

Two recordings are compared at times that both span. If a component was sampled at different times, the run with fewer
samples gives the times; the other run's numbers are interpolated linearly between its neighbouring samples, its states
and integers are those of the last sample. Gaps with missing samples are not compared. At common times samples differ
unless their values are equal; between samples numbers differ above `TOLERANCE` of the signal's range, since the
interpolation is not the motion.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field as kept_field

import numpy as np

from takt.checks.series import quantity, wrap
from takt.counted import counted
from takt.recording import Array, FloatArray, Recording, RecordingError
from takt.verdict import number, seconds

SAME_TIME_S = 1e-9  # samples at most this far apart have the same time
TOLERANCE = 1e-3  # relative to the range of a signal, if one run has no samples at the other's times


@dataclass(frozen=True)
class Difference:
    """One signal of two runs, B minus A."""

    component: str
    field: str
    unit: str
    samples: int  # number of compared times
    largest: float | None  # absolute difference; None: states, integers without a unit, or no finite number in both
    largest_s: float | None  # when
    rms: float | None
    first_s: float | None  # first time at which they differ; None: they do not
    share: float  # share of the times at which they differ, 0 to 1
    relative: float  # largest difference relative to the range of both; for states the share of times
    states: bool  # an enumeration or a boolean
    interpolated: bool  # the samples of the two have different times
    time_s: FloatArray = kept_field(repr=False, compare=False)
    delta: FloatArray = kept_field(repr=False, compare=False)

    @property
    def signal(self) -> str:
        return f"{self.component}.{self.field}"

    @property
    def differs(self) -> bool:
        return self.first_s is not None

    @property
    def sentence(self) -> str:
        if self.first_s is None:
            return f"{self.signal}: no difference at {counted(self.samples, 'time')}"
        since = f"from {seconds(self.first_s)} on"
        if self.largest is None or self.largest_s is None:
            return f"{self.signal}: differs {since}, {100 * self.share:.3g} % of the time"
        at = f"{number(self.largest, self.unit)} at {seconds(self.largest_s)}"
        return f"{self.signal}: differs {since}, most by {at}, rms {number(self.rms or 0.0, self.unit)}"


@dataclass(frozen=True)
class Comparison:
    """Two runs, and the differences between them."""

    a: Recording
    b: Recording  # its times are shifted by `shift_s`
    names: tuple[str, str]
    shift_s: float
    signals: tuple[Difference, ...]  # common signals, those that differ most relative to their range first
    only: tuple[tuple[str, ...], tuple[str, ...]]  # components and signals that only one of them has
    incomparable: tuple[str, ...]  # common signals with different meanings, as sentences

    def __repr__(self) -> str:
        return f"<Comparison {' and '.join(self.names)}: {self.sentence}>"

    def _repr_html_(self) -> str:
        from takt.notebook import comparison_table

        return comparison_table(self)

    @property
    def differing(self) -> tuple[Difference, ...]:
        return tuple(signal for signal in self.signals if signal.differs)

    @property
    def same(self) -> bool:
        """Whether all signals of both are the same."""
        return not self.differing and not self.incomparable and self.only == ((), ())

    @property
    def sentence(self) -> str:
        said = f"{len(self.differing)} of {counted(len(self.signals), 'signal')} differ"
        if self.signals and not self.differing:
            said = f"no difference in {counted(len(self.signals), 'signal')}"
        lacking = zip(self.names, self.only, strict=True)
        more = [f"only {name} has {', '.join(there)}" for name, there in lacking if there]
        return "; ".join([said, *more, *self.incomparable])


def compare(a: Recording, b: Recording, names: tuple[str, str] = ("A", "B"), *, align: str = "") -> Comparison:
    """Compares two recordings. Raises RecordingError if one has no samples, or they have no time in common.

    names: of the two runs.
    align: "": engine time is the same in both; "start": aligns the first samples of both; else the text of a mark or
        another event in both: aligns its first occurrences.
    """
    shift = _shift(a, b, names, align)
    b = b.shifted(shift) if shift else b
    for name, run in zip(names, (a, b), strict=True):
        if math.isnan(run.start_s):
            raise RecordingError(f"{name} holds no samples: there is nothing to compare")
    if max(a.start_s, b.start_s) > min(a.end_s, b.end_s):
        spans = " and ".join(
            f"{name} from {seconds(run.start_s)} to {seconds(run.end_s)}"
            for name, run in zip(names, (a, b), strict=True)
        )
        raise RecordingError(f"the runs have no time in common: {spans}; --align start lays their beginnings together")
    found: list[Difference] = []
    incomparable: list[str] = []
    for component in (name for name in a if name in b):
        for signal in (f for f in a.fields(component)[2:] if f in b.fields(component)):
            if why := _why_not(a, b, names, component, signal):
                incomparable.append(f"{component}.{signal}: {why}")
            else:
                found.append(_difference(a, b, component, signal))
    found.sort(key=lambda one: (not one.differs, -one.relative))
    only = (_only(a, b), _only(b, a))
    return Comparison(a, b, names, shift, tuple(found), only, tuple(incomparable))


def _shift(a: Recording, b: Recording, names: tuple[str, str], align: str) -> float:
    """Returns the time [s] to add to the times of B. Raises RecordingError if an event to align by is missing."""
    if not align:
        return 0.0
    if align == "start":
        return 0.0 if math.isnan(a.start_s + b.start_s) else a.start_s - b.start_s
    times = []
    for name, run in zip(names, (a, b), strict=True):
        found = next((event.time_s for event in run.events if event.text == align), None)
        if found is None:
            marks = list(dict.fromkeys(event.text for event in run.events if event.kind == "mark"))
            raise RecordingError(f"{name} has no event '{align}' (its marks are {', '.join(marks) or 'none'})")
        times.append(found)
    return times[0] - times[1]


def _only(one: Recording, other: Recording) -> tuple[str, ...]:
    """Returns the components and signals that the other recording lacks."""
    found = []
    for component in one:
        if component not in other:
            found.append(component)
        else:
            found += [f"{component}.{f}" for f in one.fields(component)[2:] if f not in other.fields(component)]
    return tuple(found)


def _why_not(a: Recording, b: Recording, names: tuple[str, str], component: str, signal: str) -> str:
    """Returns why two columns of one name cannot be compared; empty if they can."""
    units = [run.unit(component, signal) for run in (a, b)]
    if units[0] != units[1]:
        return " but ".join(f"[{unit or '1'}] in {name}" for name, unit in zip(names, units, strict=True))
    kinds = [bool(run.names(component, signal)) for run in (a, b)]
    if kinds[0] != kinds[1]:
        return " but ".join(f"{'states' if k else 'numbers'} in {name}" for name, k in zip(names, kinds, strict=True))
    moduli = [run.info(component).get("modulus") for run in (a, b)]
    if moduli[0] != moduli[1] and quantity(signal) == "position":
        return " but ".join(
            f"{f'modulus {m:g}' if m else 'endless'} in {name}" for name, m in zip(names, moduli, strict=True)
        )
    return ""


def _difference(a: Recording, b: Recording, component: str, signal: str) -> Difference:
    kept = [_values(run, component, signal, a.names(component, signal)) for run in (a, b)]
    columns = [column.astype(np.float64) for column in kept]
    times = [run[component]["time_s"] for run in (a, b)]
    states = bool(a.names(component, signal)) or all(r.column(component, signal).dtype.kind == "b" for r in (a, b))
    held = states or any(run.column(component, signal).dtype.kind != "f" for run in (a, b))
    unit = a.unit(component, signal)
    unit = "" if unit == "1" else unit
    position = quantity(signal) == "position"
    modulus = a.info(component).get("modulus") if position else None
    asks = 0 if len(times[0]) <= len(times[1]) else 1  # index of the run that gives the times
    time_s = times[asks]
    other_time, other = times[1 - asks], columns[1 - asks]
    rows = np.empty(0, np.int64)
    if len(time_s) and len(other_time):
        inside = (time_s >= other_time[0] - SAME_TIME_S) & (time_s <= other_time[-1] + SAME_TIME_S)
        for gap in (b, a)[asks].gaps(component):
            inside &= (time_s <= gap.time_s + SAME_TIME_S) | (time_s >= gap.until_s - SAME_TIME_S)
        rows = np.flatnonzero(inside)
    time_s, values = time_s[rows], columns[asks][rows]
    nearest, sampled = _nearest(time_s, other_time)
    found = other[nearest] if sampled else _between(time_s, other_time, other, nearest, held, modulus)
    with np.errstate(invalid="ignore", over="ignore"):
        delta = found - values if asks == 0 else values - found
        if modulus is not None:  # only if it is needed, as it rounds
            delta = np.where(np.abs(delta) > modulus / 2, wrap(delta, modulus), delta)
    good = np.concatenate((values, found))
    good = good[np.isfinite(good)]
    extent = float(np.ptp(good)) if len(good) else 0.0
    if sampled:  # compares the values: differences would lose numbers above 2^53 and whole turns
        differs = (kept[asks][rows] != kept[1 - asks][nearest]) & ~(np.isnan(found) & np.isnan(values))
    else:
        limit = 0.0 if held else TOLERANCE * extent
        differs = (np.isnan(found) != np.isnan(values)) | (np.abs(np.nan_to_num(delta, nan=0.0)) > limit)
    amounts = np.abs(delta[np.isfinite(delta)])
    share = float(np.mean(differs)) if len(differs) else 0.0
    numbered = held and unit == ""  # numbers of commands, errors: their distance has no meaning
    numeric = not states and not numbered and len(amounts) > 0
    worst = float(amounts.max()) if numeric else None
    largest_s = float(time_s[int(np.nanargmax(np.where(np.isfinite(delta), np.abs(delta), -1.0)))]) if numeric else None
    return Difference(
        component,
        signal,
        unit,
        len(time_s),
        worst,
        largest_s,
        float(np.sqrt(np.mean(np.square(amounts)))) if numeric else None,
        float(time_s[int(np.argmax(differs))]) if np.any(differs) else None,
        share,
        share if worst is None else worst / extent if extent else 0.0,
        states,
        not sampled,
        time_s,
        np.asarray(differs, dtype=np.float64) if states else delta,
    )


def _values(run: Recording, component: str, signal: str, names: Mapping[int, str]) -> Array:
    """Returns a column; states are encoded by the numbers of the first run."""
    column = run.column(component, signal)
    own = run.names(component, signal)
    if own and own != names:
        known = {text: value for value, text in names.items()}
        translated = {value: known.get(text, 1000 + value) for value, text in own.items()}
        return np.array([translated.get(int(v), int(v)) for v in column], dtype=np.int64)
    return column


def _nearest(time_s: FloatArray, other_time: FloatArray) -> tuple[Array, bool]:
    """Returns the samples of another time base that are nearest to these times, and whether all of them have these
    times."""
    if not len(time_s):
        return np.empty(0, np.int64), True
    behind = np.clip(np.searchsorted(other_time, time_s), 0, len(other_time) - 1)
    before = np.maximum(behind - 1, 0)
    nearest = np.where(np.abs(other_time[behind] - time_s) <= np.abs(other_time[before] - time_s), behind, before)
    return nearest, bool(np.all(np.abs(other_time[nearest] - time_s) <= SAME_TIME_S))


def _between(
    time_s: FloatArray, other_time: FloatArray, other: FloatArray, nearest: Array, held: bool, modulus: float | None
) -> FloatArray:
    """Returns the values of another time base at these times."""
    behind = np.clip(np.searchsorted(other_time, time_s), 0, len(other_time) - 1)
    before = np.maximum(behind - 1, 0)
    sampled = np.abs(other_time[nearest] - time_s) <= SAME_TIME_S
    if held:
        return np.where(sampled, other[nearest], other[before])
    line = np.unwrap(other, period=modulus) if modulus and np.all(np.isfinite(other)) else other
    width = np.where(behind > before, other_time[behind] - other_time[before], 1.0)
    part = (time_s - other_time[before]) / width
    between = line[before] + part * (line[behind] - line[before])
    return np.where(sampled, other[nearest], between)
