"""The data of a report beside the recording: verdicts with their curves, figures, pictures. They are kept in the
recording's own `meta["run"]`, so that one file holds a whole run."""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Mapping, Sequence
from datetime import datetime, timezone
from typing import Any

import numpy as np

from takt import plot
from takt.recording import Array, Recording
from takt.verdict import Bound, Interval, Lane, Trace, Verdict, seconds

KEY = "run"
POINTS = 2000  # of a verdict's curve outside its view; inside all are kept, up to
POINTS_AT_PLACE = 20_000
AROUND_S = 0.5  # time shown before and after a plain assertion without components


def keep(
    recording: Recording,
    title: str,
    verdicts: Sequence[Verdict] = (),
    assertion: Verdict | None = None,
    figures: Mapping[str, Any] | None = None,
    pictures: Mapping[str, bytes] | None = None,
) -> Recording:
    """Returns the same recording with all data of its report in its `meta`.

    assertion: a failed plain assertion beside the verdicts; None: none. figures: further facts of the run; plain values
    appear in the head ("machine": "six_axes"), a dict is a group of figures under its name ("engine": {"longest cycle":
    "112 µs", "overruns": 0}). pictures: PNG files by their titles.
    """
    whole = copy.copy(recording)
    whole.meta = {
        **recording.meta,
        KEY: {
            "title": title,
            "made": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
            "verdicts": [_verdict(verdict) for verdict in verdicts],
            "complaint": assertion.sentence if assertion is not None else "",
            "assertion": _assertion(assertion, recording) if assertion is not None else None,
            "figures": told(figures or {}),
            "pictures": {name: np.frombuffer(data, np.uint8) for name, data in (pictures or {}).items()},
        },
    }
    return whole


def kept(recording: Recording) -> dict[str, Any] | None:
    """Returns the data of `keep`; None if there are none."""
    found: dict[str, Any] | None = recording.meta.get(KEY)
    return found


def told(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Returns facts in JSON's types, without empty ones."""
    found: dict[str, Any] = plain({name: value for name, value in facts.items() if value not in ({}, [], "", None)})
    return found


def plain(value: Any) -> Any:
    """Returns a value in JSON's types: numbers that are not finite become null, NumPy's numbers Python's, other objects
    text."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, bool | int | str) else str(value)


def _verdict(verdict: Verdict) -> dict[str, Any]:
    place = verdict.place or (None if verdict.when_s is None else (verdict.when_s, verdict.when_s))
    drawn = any(len(trace.time_s) for lane in verdict.lanes for trace in lane.traces)
    view = plot.around(place, verdict.lanes) if place and drawn else place
    return {
        "title": verdict.title,
        "components": list(verdict.components),
        "passed": bool(verdict.passed),
        "sentence": verdict.sentence,
        "when": None if verdict.when_s is None else seconds(verdict.when_s),
        "place": plain(place),
        "view": plain(view),
        "lanes": [_lane(lane, view) for lane in verdict.lanes],
    }


def _assertion(assertion: Verdict, recording: Recording) -> dict[str, Any]:
    """Returns an assertion. If it has no curves, its view is the time around it in the curves of the machine."""
    told = _verdict(assertion)
    if assertion.place and not assertion.lanes:
        at = assertion.place[0]
        told["view"] = plain([max(recording.start_s, at - AROUND_S), min(recording.end_s, at + AROUND_S)])
    return told


def _lane(lane: Lane, view: Interval | None) -> dict[str, Any]:
    return {
        "quantity": lane.quantity,
        "unit": lane.unit,
        "names": {str(value): name for value, name in lane.names.items()},
        "traces": [_trace(trace, lane, view) for trace in lane.traces],
        "bounds": [_bound(bound, view) for bound in lane.bounds],
    }


def _trace(trace: Trace, lane: Lane, view: Interval | None) -> dict[str, Any]:
    numbers = np.asarray(trace.values, dtype=np.float64)
    rows = _changes(numbers) if lane.names else _rows(trace.time_s, numbers, view)
    return {
        "label": trace.label,
        "modulus": trace.modulus,
        "time_s": np.asarray(trace.time_s, dtype=np.float64)[rows],
        "values": numbers[rows],
    }


def _bound(bound: Bound, view: Interval | None) -> dict[str, Any]:
    values = np.asarray(bound.values, dtype=np.float64)
    rows = _rows(bound.time_s, values, view)
    time_s = np.asarray(bound.time_s, dtype=np.float64)[rows]
    return {"label": bound.label, "forbidden": bound.forbidden, "time_s": time_s, "values": values[rows]}


def _changes(values: Array) -> Array:
    """Returns the first and last row of each interval of constant state."""
    if not len(values):
        return np.empty(0, np.int64)
    steps = np.flatnonzero(values[1:] != values[:-1])
    return np.unique(np.concatenate(([0], steps, steps + 1, [len(values) - 1])))


def _rows(time_s: Array, values: Array, view: Interval | None) -> Array:
    """Returns all rows in the view; elsewhere the rows of the extremes of each interval, as a picture shows them."""
    if len(values) <= POINTS:
        return np.arange(len(values))
    inside = np.arange(0)
    if view is not None:
        begin, end = int(np.searchsorted(time_s, view[0])), int(np.searchsorted(time_s, view[1], side="right"))
        begin, end = max(begin - 1, 0), min(end + 1, len(values))
        inside = np.arange(begin, end)
        if len(inside) > POINTS_AT_PLACE:
            inside = begin + extremes(values[begin:end], POINTS_AT_PLACE)
    ends = np.array([0, len(values) - 1])
    return np.unique(np.concatenate((ends, inside, extremes(values, POINTS))))


def extremes(values: Array, count: int) -> Array:
    edges = np.linspace(0, len(values), count // 2 + 1).astype(np.int64)
    low, high = np.nan_to_num(values, nan=np.inf), np.nan_to_num(values, nan=-np.inf)
    found = [int(a + pick) for a, b in itertools.pairwise(edges) for pick in (low[a:b].argmin(), high[a:b].argmax())]
    return np.array(found)
