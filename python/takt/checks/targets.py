"""Checks whether a motion reaches its target, and whether it stays there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from takt.checks.series import Check, Series, UndecidedError, beyond, decided, runs, sound
from takt.recording import FloatArray, Recording
from takt.verdict import Bound, Lane, Verdict, number, seconds


@decided
def reaches(
    recording: Recording,
    component: str,
    position: float,
    *,
    tolerance: float,
    by: float,
    start: float | None = None,
    signal: str = "actual_position",
) -> Verdict:
    """Passes if a sample within `tolerance` of `position` comes no later than `by` [s] (time_s of the recording), and
    not before `start` [s] (None: the beginning of the recording). Raises ValueError if `by` lies before `start`."""
    sound("reaches", position=position, tolerance=tolerance, by=by)
    whole = recording[component]["time_s"]
    begin = start if start is not None else (float(whole[0]) if len(whole) else by)
    if begin > by:
        if start is not None:
            raise ValueError(f"reaches: by={by} lies before start={start}")
        begin = by  # the recording starts too late: `series` reports it
    end = by if not len(whole) or whole[-1] >= by else max(begin, float(whole[-1]))
    check = Check("reaches", recording, (component,), (begin, end))
    s = check.series(component, signal)
    distance = np.abs(s.error_to(position))
    lane = _lane(_with_aftermath(recording, s), position, tolerance)
    inside = np.flatnonzero(_beyond(s, position, tolerance) <= 0)
    if len(inside):
        when = float(s.time_s[inside[0]])
        early = seconds(by - when)
        return check.verdict(
            True,
            f"{component} reached {number(position, s.unit)} at {seconds(when)}, {early} in advance",
            when_s=when,
            by=by - when,
            unit="s",
            lanes=(lane,),
        )
    nearest = int(np.argmin(distance))
    short = float(distance[nearest]) - tolerance
    closest, at = float(distance[nearest]), float(s.time_s[nearest])
    sentence = (
        f"{component} did not reach {number(position, s.unit)} ± {number(tolerance, s.unit)} "
        f"by {seconds(by)}: "
        f"it came no closer than {number(closest, s.unit)}, at {seconds(at)}"
    )
    later = _later(recording, component, signal, position, tolerance, by)
    if later is not None:
        sentence += f"; it was there at {seconds(later)}, {seconds(later - by)} too late"
    elif end < by:
        sentence += f"; the recording ends at {seconds(end)}"
    place = (end, later if later is not None else end)
    return check.verdict(False, sentence, when_s=end, by=short, unit=s.unit, place=place, lanes=(lane,))


@decided
def settles(
    recording: Recording,
    component: str,
    position: float,
    tolerance: float,
    *,
    within: float,
    start: float | None = None,
    hold: float | None = None,
    signal: str = "actual_position",
) -> Verdict:
    """Passes if the signal is within `tolerance` of `position` at most `within` [s] after `start` [s] (None: the
    beginning of the recording), and stays there for `hold` [s] (None: to the end of the recording)."""
    sound("settles", position=position, tolerance=tolerance, within=within, hold=hold or 0.0)
    whole = recording[component]["time_s"]
    begin = start if start is not None else (float(whole[0]) if len(whole) else 0.0)
    deadline = begin + within
    end = deadline + hold if hold is not None else max(float(whole[-1]) if len(whole) else deadline, deadline)
    check = Check("settles", recording, (component,), (begin, end))
    s = check.series(component, signal)
    excess = _beyond(s, position, tolerance)
    slack = 1e-9 * max(1.0, abs(end))  # times are sums: rounding must not miss the deadline
    stays = [
        (a, b) for a, b in runs(excess <= 0) if hold is None or s.time_s[b] - s.time_s[a] >= _held(s, hold) - slack
    ]
    if hold is None:
        stays = [(a, b) for a, b in stays if b == len(s.values) - 1]
    lane = _lane(s, position, tolerance)
    asked = f"{number(position, s.unit)} ± {number(tolerance, s.unit)}"
    how_long = "to the end of the recording" if hold is None else f"for {seconds(hold)}"
    if stays and s.time_s[stays[0][0]] <= deadline + slack:
        first, last = stays[0]
        when = float(s.time_s[first])
        room = abs(float(np.max(excess[first : last + 1])))
        return check.verdict(
            True,
            f"{component} settled at {asked} {how_long} {seconds(when - begin)} after {seconds(begin)}",
            when_s=when,
            by=room,
            unit=s.unit,
            lanes=(lane,),
        )
    after = np.flatnonzero((s.time_s >= deadline - slack) & (excess > 0))
    if not len(after):
        after = np.flatnonzero(excess > 0)
    worst = int(after[np.argmax(excess[after])])
    when = float(s.time_s[after[0]])
    sentence = (
        f"{component} did not settle at {asked} {how_long} by {seconds(deadline)}: it is off by "
        f"{number(float(excess[worst]) + tolerance, s.unit)} at {seconds(float(s.time_s[worst]))}, "
        f"{number(float(excess[worst]), s.unit)} too much"
    )
    if stays:
        sentence += f"; it settled at {seconds(float(s.time_s[stays[0][0]]))}"
    place = (when, float(s.time_s[after[-1]]))
    return check.verdict(False, sentence, when_s=when, by=float(excess[worst]), unit=s.unit, place=place, lanes=(lane,))


def _held(s: Series, hold: float) -> float:
    """Returns the time from the first to the last sample of a hold: the last one lies up to one sample interval before
    the end of the hold."""
    return hold - (float(np.median(np.diff(s.time_s))) if len(s.time_s) > 1 and hold > 0 else 0.0)


def _with_aftermath(recording: Recording, s: Series) -> Series:
    """Returns the series for the picture, extended by half its length."""
    table = recording[s.component]
    first, last = s.span
    shown = (table["time_s"] >= first) & (table["time_s"] <= last + 0.5 * (last - first))
    values = table[s.field][shown].astype(np.float64)
    return replace(s, time_s=table["time_s"][shown], cycle=table["cycle"][shown], values=values)


def _later(
    recording: Recording, component: str, signal: str, position: float, tolerance: float, after: float
) -> float | None:
    end = float(recording[component]["time_s"][-1])
    if end <= after:
        return None
    try:
        rest = Check("", recording, (component,), (after, end)).series(component, signal)
    except UndecidedError:  # only adds a hint to the sentence
        return None
    there = np.flatnonzero(_beyond(rest, position, tolerance) <= 0)
    return float(rest.time_s[there[0]]) if len(there) else None


def _beyond(s: Series, position: float, tolerance: float) -> FloatArray:
    return beyond(s.error_to(position), tolerance, max(abs(position), s.modulus or 0.0))


def _lane(s: Series, position: float, tolerance: float) -> Lane:
    return s.lane(
        bounds=(
            Bound.level(
                f"{number(position, s.unit)} ± {number(tolerance, s.unit)}",
                position + tolerance,
                s.span,
                "none",
            ),
            Bound.level("", position - tolerance, s.span, "none"),
        )
    )
