"""Conditions over time: one that must always hold, two that must never hold together, and the states that are visited.

A condition is a text such as "x.actual_position > 10", "|x.following_error| <= 0.5", "x.state == Standstill",
"x.in_position", "not x.in_position", or several of them joined by " and ".

Numbers that differ only by rounding count as equal (`slack`): 100.00000000000001 is not above 100.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from takt.checks.series import Check, Mask, Series, decided, extent, nearest, slack
from takt.counted import counted
from takt.names import names_in
from takt.recording import FloatArray, Recording, RecordingError, split_signal
from takt.verdict import Bound, Interval, Lane, Verdict, number, seconds

# Arguments: value minus the level, and the difference [same unit] that still counts as equal.
_COMPARE: dict[str, Callable[[Any, float], Any]] = {
    "<=": lambda difference, slack: difference <= slack,
    ">=": lambda difference, slack: difference >= -slack,
    "==": lambda difference, slack: np.abs(difference) <= slack,
    "!=": lambda difference, slack: np.abs(difference) > slack,
    "<": lambda difference, slack: difference < -slack,
    ">": lambda difference, slack: difference > slack,
}
_COMPARISON = re.compile(
    r"^(?P<bar>\|?)\s*(?P<signal>[^\s|<>=!]+)\s*(?P<bar2>\|?)\s*(?P<op><=|>=|==|!=|<|>)\s*(?P<value>\S.*)$"
)
_FLAG = re.compile(r"^(?P<negated>not\s+)?(?P<signal>[^\s|<>=!]+)$")


@dataclass(frozen=True)
class _Term:
    """One evaluated comparison of a condition."""

    text: str
    series: Series
    holds: Mask
    excess: FloatArray | None  # > 0: by how much it is violated; None for states, flags and !=
    lane: Lane


@decided
def stays(recording: Recording, condition: str, *, window: Interval | None = None) -> Verdict:
    """Passes if a condition holds at every sample: stays(rec, "x.state == Standstill", window=(1.0, 2.0)). window:
    (from, to) [s]; None: the whole recording. Numbers that differ by less than a billionth (relative) count as
    equal."""
    terms = _parse(condition)
    check = Check("stays", recording, _components(terms), window)
    evaluated = [_evaluate(check, *term) for term in terms]
    lanes = [t.lane for t in evaluated]
    broken = [t for t in evaluated if not t.holds.all()]
    if not broken:
        closest = [t for t in evaluated if t.excess is not None]
        if not closest:
            return check.verdict(True, f"{condition} held throughout", lanes=lanes)
        term = max(closest, key=lambda t: float(np.max(_excess(t))))
        at = int(np.argmax(_excess(term)))
        room, when = max(0.0, -float(_excess(term)[at])), float(term.series.time_s[at])
        text = f"{condition} held throughout; {nearest(room, term.series.unit, when)}"
        return check.verdict(True, text, when_s=when, by=room, unit=term.series.unit, lanes=lanes)
    term = min(broken, key=lambda t: float(t.series.time_s[np.argmin(t.holds)]))
    s = term.series
    place, where = extent(s.time_s, ~term.holds)
    at = int(np.argmin(term.holds))
    by: float | None = None
    if term.excess is not None:
        at = int(np.argmax(term.excess))
        by = float(term.excess[at])
    was = f"{s.label} was {_value(recording, s, at)} at {seconds(float(s.time_s[at]))}"
    text = f"{term.text} did not hold {where}: {was}"
    if by is not None and by > 0:
        text += f", off by {number(by, s.unit)}"
    return check.verdict(
        False, text, when_s=place[0], by=by, unit=s.unit if by is not None else "", place=place, lanes=lanes
    )


@decided
def never_both(recording: Recording, a: str, b: str, *, window: Interval | None = None) -> Verdict:
    """Passes if two conditions never hold in the same cycle: never_both(rec, "x.actual_position > 10", "clamp.closed").
    Only cycles that all components of both conditions have are compared."""
    terms_a, terms_b = _parse(a), _parse(b)
    check = Check("never_both", recording, _components([*terms_a, *terms_b]), window)
    all_a, all_b = ([_evaluate(check, *t) for t in terms] for terms in (terms_a, terms_b))
    lanes = list({t.series.label: _without_sides(t.lane) for t in (*all_a, *all_b)}.values())
    holds_a, holds_b = check.together(_all_hold(check, all_a), _all_hold(check, all_b))
    both = (holds_a.values > 0) & (holds_b.values > 0)
    if not both.any():
        return check.verdict(True, f"'{a}' and '{b}' never held together", lanes=lanes)
    place, where = extent(holds_a.time_s, both)
    ends = float(holds_a.time_s[np.flatnonzero(both)[-1]])
    lasted = ends - place[0]
    text = f"'{a}' and '{b}' held together {where}"
    return check.verdict(False, text, when_s=place[0], by=lasted, unit="s", place=place, lanes=lanes)


@decided
def visits_states(
    recording: Recording,
    component: str,
    states: Sequence[str],
    *,
    exactly: bool = False,
    field: str = "state",
    window: Interval | None = None,
) -> Verdict:
    """Passes if the states are visited in this order. Other states may lie between them, before and after, unless
    `exactly`. `field` is the signal with the names of states. Raises ValueError if `states` is empty."""
    states = names_in(states, "states", "state")
    if not states:
        raise ValueError("visits_states: states is an empty list, so there is nothing to judge")
    names = recording.names(component, field)
    wanted = [_state_value(recording, component, field, s) for s in states]
    check = Check("visits_states", recording, (component,), window)
    s = check.series(component, field)
    starts = np.concatenate(([0], np.flatnonzero(np.diff(s.values)) + 1))
    visited = [int(v) for v in s.values[starts]]
    lane = s.lane(names=names)
    texts = [names.get(v, str(v)) for v in visited]
    shown = " -> ".join(texts if len(texts) <= 12 else [*texts[:6], "…", *texts[-5:]])
    reached, at = 0, 0
    for i, value in enumerate(visited):
        if reached < len(wanted) and value == wanted[reached]:
            reached, at = reached + 1, i
        elif exactly:
            break
    asked = " -> ".join(states)
    if reached == len(wanted) and (not exactly or len(visited) == len(wanted)):
        when = float(s.time_s[starts[at]])
        return check.verdict(
            True,
            f"{component} went through {asked} (complete at {seconds(when)})",
            when_s=when,
            lanes=(lane,),
        )
    if reached == len(wanted):
        i = len(wanted)
        when = float(s.time_s[starts[i]])
        text = f"{component} went on to {texts[i]} at {seconds(when)} after {asked}"
        return check.verdict(False, text, when_s=when, lanes=(lane,))
    when = s.span[1]
    if exactly and reached < len(visited):
        when = float(s.time_s[starts[reached]])
    missing = f"{states[reached]} is missing (number {reached + 1})"
    text = f"{component} did not go through {asked}: {missing}; it went through {shown}"
    place = (float(s.time_s[starts[at]]), s.span[1]) if not exactly else None
    return check.verdict(False, text, when_s=when, place=place, lanes=(lane,))


@decided
def complete(recording: Recording, component: str, *, step: int | None = None) -> Verdict:
    """Passes if no sample was lost: cycle numbers are evenly spaced (`step` cycles apart; None: the most frequent
    spacing), from the beginning of the recording to its end."""
    check = Check("complete", recording, (component,), None, says_missing=False)
    s = check.series(component, "cycle")
    gaps = recording.gaps(component, step)
    silent, late = (recording.meta.get(what) or {} for what in ("silent", "late"))
    if component in late and recording.start_s < late[component]:
        text = f"the samples of {component} before {seconds(late[component])} are missing"
        return check.verdict(False, text, when_s=recording.start_s, lanes=(s.lane(),))
    if component in silent and recording.end_s > silent[component]:
        text = f"the samples of {component} from {seconds(silent[component])} on are missing"
        return check.verdict(False, text, when_s=silent[component], lanes=(s.lane(),))
    if not gaps:
        text = f"{component} is complete: {counted(len(s.values), 'sample')}"
        return check.verdict(True, text, lanes=(s.lane(),))
    missing = sum(g.missing for g in gaps)
    text = (
        f"{counted(missing, 'sample')} of {component} lost in {counted(len(gaps), 'gap')}, "
        f"the first after cycle {gaps[0].after_cycle} at {seconds(gaps[0].time_s)}"
    )
    return check.verdict(False, text, when_s=gaps[0].time_s, by=float(missing), unit="samples", lanes=(s.lane(),))


def _parse(condition: str) -> list[tuple[str, str, str, str, bool]]:
    """Returns (text, signal, operator, value, absolute) of each term."""
    terms = []
    for part in re.split(r"\s+and\s+", condition.strip()):
        if (m := _COMPARISON.match(part)) and m["bar"] == m["bar2"]:
            terms.append((part, m["signal"], m["op"], m["value"].strip(), bool(m["bar"])))
        elif m := _FLAG.match(part):
            terms.append((part, m["signal"], "==" if m["negated"] else "!=", "0", False))
        else:
            raise RecordingError(
                f"'{part}' is not a condition such as 'x.actual_position > 10' or 'x.state == Standstill'"
            )
    return terms


def _components(terms: Sequence[tuple[str, str, str, str, bool]]) -> list[str]:
    return list(dict.fromkeys(split_signal(signal)[0] for _, signal, _, _, _ in terms))


def _evaluate(check: Check, text: str, signal: str, op: str, value: str, absolute: bool) -> _Term:
    component, field = split_signal(signal)
    names = check.recording.names(component, field)
    level = (
        float(_state_value(check.recording, component, field, value))
        if names and not _is_number(value)
        else _number(value, text)
    )
    s = check.series(component, field)
    values = np.abs(s.values) if absolute else s.values
    holds: Mask = np.asarray(_COMPARE[op](values - level, slack(level)), dtype=np.bool_)
    excess: FloatArray | None = None
    if not names and check.recording.column(component, field).dtype.kind != "b":
        excess = {"<": values - level, ">": level - values, "=": np.abs(values - level)}.get(op[0])
    bounds: tuple[Bound, ...] = ()
    if excess is not None:
        forbidden: dict[str, Any] = {"<": "above", ">": "below"}
        bounds = (Bound.level(number(level, s.unit), level, s.span, forbidden.get(op[0], "none")),)
        if absolute:
            bounds += (Bound.level("", -level, s.span, "below" if op[0] == "<" else "none"),)
    return _Term(text, s, holds, excess, s.lane(bounds=bounds, names=names))


def _all_hold(check: Check, terms: Sequence[_Term]) -> Series:
    """Returns a series of 1 where all terms hold and 0 elsewhere, over the cycles that all terms have."""
    result: Series | None = None
    for term in terms:
        s = term.series
        held = Series(s.component, s.field, "", s.time_s, s.cycle, term.holds.astype(np.float64), None)
        if result is not None:
            result, held = check.together(result, held)
            held = Series(s.component, s.field, "", held.time_s, held.cycle, result.values * held.values, None)
        result = held
    assert result is not None
    return result


def _without_sides(lane: Lane) -> Lane:
    """Removes the forbidden side of thresholds: a condition of never_both may hold by itself."""
    return replace(lane, bounds=tuple(replace(b, forbidden="none") for b in lane.bounds))


def _excess(term: _Term) -> FloatArray:
    assert term.excess is not None
    return term.excess


def _state_value(recording: Recording, component: str, field: str, text: str) -> int:
    names = recording.names(component, field)
    if not names:
        raise RecordingError(f"'{component}.{field}' has no named values")
    for value, name in names.items():
        if name == text:
            return value
    near = difflib.get_close_matches(text, names.values(), n=1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    raise RecordingError(f"'{component}.{field}' has no value '{text}'{hint} (it has {', '.join(names.values())})")


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _number(text: str, condition: str) -> float:
    if text in ("true", "false"):
        return float(text == "true")
    if not _is_number(text):
        raise RecordingError(f"in '{condition}', '{text}' is neither a number nor the name of a value")
    return float(text)


def _value(recording: Recording, s: Series, at: int) -> str:
    names = recording.names(s.component, s.field)
    value = float(s.values[at])
    return names.get(int(value), number(value)) if names else number(value, s.unit)
