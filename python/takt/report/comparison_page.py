"""The page of two runs: their differences in figures, verdicts of both side by side, superimposed curves."""

from __future__ import annotations

import difflib
import itertools
from collections import Counter
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from takt import style
from takt.checks.series import quantity, words
from takt.missing import troubles
from takt.recording import Recording
from takt.report.columns import Block
from takt.report.comparison import Comparison, Difference
from takt.report.kept import extremes, kept, plain
from takt.report.writing import columns_of, facts_of, filled
from takt.verdict import number, seconds
from takt.written import write_text

POINTS = 20_000  # of a curve of differences; longer ones are reduced to the extremes of each interval
LINES = 400  # largest number of lines of the machine files' difference


def write_comparison(comparison: Comparison, path: str | PathLike[str]) -> Path:
    """Writes the page. Returns its path."""
    target = Path(path)
    write_text(target, render_comparison(comparison))
    return target


def render_comparison(comparison: Comparison) -> str:
    """Returns the page as text."""
    block = Block()
    a, b = comparison.a, comparison.b
    title = " and ".join(comparison.names)
    payload = {
        "title": title,
        "names": list(comparison.names),
        "sentence": comparison.sentence,
        "trouble": [f"{name}: {said}" for name, run in _runs(comparison) for said in troubles(run)],
        "notes": _notes(comparison),
        "span": [min(a.start_s, b.start_s), max(a.end_s, b.end_s)],
        "runs": [columns_of(run, block, ()) for run in (a, b)],
        "signals": [_signal(one, block) for one in comparison.signals],
        "components": list(dict.fromkeys(one.component for one in comparison.signals)),
        "only": [list(there) for there in comparison.only],
        "incomparable": list(comparison.incomparable),
        "verdicts": verdict_rows(a, b),
        "facts": fact_rows(a, b),
        "machine": _machine(comparison),
        "palette": list(style.PALETTE),
    }
    return filled("compare", title, plain(payload), block)


def verdict_rows(a: Recording, b: Recording) -> list[tuple[str, list[Any], list[Any]]]:
    """Returns a row per verdict: its title, and for both runs whether it passed and its sentence; [] if a run lacks it.
    Verdicts of the same title are paired in their order."""
    told = [_verdicts(run) for run in (a, b)]
    titles = dict.fromkeys(key for one in told for key in one)
    rows = [(title, told[0].get((title, k), []), told[1].get((title, k), [])) for title, k in titles]
    return sorted(rows, key=lambda row: (row[1][:1] == row[2][:1], bool(row[1] and row[1][0])))


def fact_rows(a: Recording, b: Recording) -> list[tuple[str, str, str]]:
    """Returns the facts of both runs, by name."""
    told = [dict(_facts(run)) for run in (a, b)]
    return [(name, told[0].get(name, "—"), told[1].get(name, "—")) for name in dict.fromkeys((*told[0], *told[1]))]


def _runs(comparison: Comparison) -> Iterator[tuple[str, Recording]]:
    return zip(comparison.names, (comparison.a, comparison.b), strict=True)


def _notes(comparison: Comparison) -> list[str]:
    """Returns notes about the comparison, as sentences."""
    notes = []
    a, b = comparison.a, comparison.b
    if comparison.shift_s:
        notes.append(f"{comparison.names[1]} is shown {seconds(comparison.shift_s)} later than it was.")
    common = (max(a.start_s, b.start_s), min(a.end_s, b.end_s))
    if (a.start_s, a.end_s) != (b.start_s, b.end_s):
        notes.append(f"Compared from {seconds(common[0])} to {seconds(common[1])}, which both runs span.")
    between = [one for one in comparison.signals if one.interpolated]
    if between:
        names = ", ".join(dict.fromkeys(one.component for one in between))
        notes.append(f"Samples of {names} are of different times: numbers are compared on lines between samples.")
    return notes


def _signal(one: Difference, block: Block) -> dict[str, Any]:
    time_s, delta = one.time_s, one.delta
    if len(delta) > POINTS:
        rows = np.unique(np.concatenate(([0], extremes(delta, POINTS), [len(delta) - 1])))
        time_s, delta = time_s[rows], delta[rows]
    figures = {
        "largest": None if one.largest is None else number(one.largest, one.unit),
        "at": None if one.largest_s is None else seconds(one.largest_s),
        "rms": None if one.rms is None else number(one.rms, one.unit),
        "first": None if one.first_s is None else seconds(one.first_s),
        "share": f"{100 * one.share:.3g} %",
        "samples": f"{one.samples:,}",
    }
    moment = one.largest_s if one.largest_s is not None and one.largest else one.first_s
    drawn = {"time": block.time(time_s), "delta": block.put(delta)} if one.differs else {}
    return {
        "component": one.component,
        "field": one.field,
        "label": words(one.field),
        "quantity": quantity(one.field),
        "unit": one.unit,
        "differs": one.differs,
        "moment": moment,
        "states": one.states,
        **figures,
        **drawn,
    }


def _verdicts(run: Recording) -> dict[tuple[str, int], list[Any]]:
    told = kept(run) or {}
    count: Counter[str] = Counter()
    found = {}
    for verdict in (*([told["assertion"]] if told.get("assertion") else []), *told.get("verdicts", ())):
        title = verdict["title"]
        found[title, count[title]] = [bool(verdict["passed"]), verdict["sentence"]]
        count[title] += 1
    return found


def _facts(run: Recording) -> Iterator[tuple[str, str]]:
    told = kept(run) or {"figures": {}}
    yield "length", f"{run.duration_s:.3f} s"
    yield "samples", f"{sum(len(run[name]) for name in run):,}"
    for name, value in facts_of(run, told["figures"]).items():
        if isinstance(value, Mapping):
            yield from ((f"{name}: {what}", str(of)) for what, of in value.items())
        else:
            yield name, str(value)


def _machine(comparison: Comparison) -> list[str]:
    """Returns the differing lines of the machine files."""
    texts = [(run.meta.get("machine_file") or {}).get("text", "") for run in (comparison.a, comparison.b)]
    if not all(texts):
        return []
    a, b = (text.splitlines() for text in texts)
    lines = difflib.unified_diff(a, b, *comparison.names, n=1, lineterm="")
    shown = list(itertools.islice(lines, LINES + 1))
    return shown if len(shown) <= LINES else [*shown[:LINES], "…"]
