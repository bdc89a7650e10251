"""The page of a sweep: failures, distributions, dependence of numbers on the varied keys, the worst runs with the
commands that repeat them. One self-contained HTML file."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from takt.counted import counted
from takt.recording import FloatArray
from takt.report.inlined import asset
from takt.report.writing import STYLES
from takt.sweep.summary import Column, Summary
from takt.written import write_text

BINS = 40  # of a distribution
STEPS = 24  # groups of a key with more values
WIDTH, HEIGHT = 420, 120  # of a drawing, without the numbers below
CSS = """
.sweep { display: grid; grid-template-columns: repeat(auto-fill, minmax(430px, 1fr)); gap: 12px; }
.sweep figure { margin: 0; padding: 10px 14px; }
.sweep figcaption { font-weight: 600; }
.sweep svg { display: block; width: 100%; height: auto; margin: 4px 0; overflow: visible; }
.sweep text { font: 11px var(--font); fill: var(--soft); }
.bar { fill: var(--accent); } .bad-bar { fill: var(--bad); }
.band { fill: var(--accent); opacity: 0.22; } .middle { fill: none; stroke: var(--accent); stroke-width: 2; }
.zero { stroke: var(--bad); stroke-dasharray: 4 3; }
code { font-size: 12px; overflow-wrap: anywhere; user-select: all; }
td.number { font-variant-numeric: tabular-nums; white-space: nowrap; }
"""


def write_page(summary: Summary, directory: Path, title: str, about: Path) -> Path:
    """Writes sweep.html. Returns its path."""
    target = directory / "sweep.html"
    write_text(target, render(summary, title, json.loads(about.read_text(encoding="utf-8"))))
    return target


def render(summary: Summary, title: str, about: dict[str, object]) -> str:
    """Returns the page as text."""
    colour = "bad" if summary.failed else "good" if summary.runs else ""
    pill = f"{summary.failed:,} of {summary.runs:,} failed" if summary.failed else f"all {summary.runs:,} passed"
    if not summary.runs:
        pill = "no runs"
    open_ = f"{summary.size - summary.runs:,} of {counted(summary.size, 'run')} have not been made yet."
    notice = f'<p class="notice">{open_}</p>' if summary.runs < summary.size else ""
    facts = {"runs": f"{summary.runs:,}", "scenario": about["scenario"], "machine": about["machine"] or "beside it"}
    facts |= {"grid": about["grid"], "sample": about["sample"], "seed": about["seed"], "Takt": about["version"]}
    told = "".join(f"<div><dt>{_text(k)}</dt><dd>{_text(_said(v))}</dd></div>" for k, v in facts.items() if v != [])
    outputs = [one for name, one in summary.columns.items() if name not in summary.keys and one.count]
    style = "".join(asset(*path) for path in STYLES if path[-1] != "uPlot.min.css")
    parts = [
        _failures(summary),
        _section("Passed, by what was varied", _shares(summary)),
        _section("Distributions", (_distribution(one, summary.kept[one.name]) for one in outputs)),
        _section("By what was varied", _dependences(summary, outputs)),
        *_worst(outputs),
    ]
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{_text(title)}</title>\n<style>{style}{CSS}</style>\n</head>\n"
        '<body class="ready">\n<main>\n'
        f'<header class="headline"><h1>{_text(title)}</h1><span class="pill {colour}">{pill}</span></header>\n'
        f'{notice}<dl class="facts">{told}</dl>\n{"".join(parts)}</main>\n</body>\n</html>\n'
    )


def _failures(summary: Summary) -> str:
    rows = sorted(summary.reasons.items(), key=lambda item: -item[1][0])
    cells = (
        f'<tr><td>{_text(reason)}</td><td class="number">{count:,}</td><td class="number">{run:,}</td>'
        f"<td><code>{_text(command)}</code></td></tr>"
        for reason, (count, run, command) in rows[:30]
    )
    return _table("What failed", ("", "runs", "the first one", "makes it again"), cells) if rows else ""


def _worst(outputs: Sequence[Column]) -> Iterable[str]:
    """Yields the ends of each number: the smallest values of margins, both ends of other numbers."""
    for one in outputs:
        ends = [("least", one.low[:5])] if one.name.rstrip("0123456789 ").endswith(")") else []
        ends = ends or [("least", one.low[:3]), ("greatest", one.high[:3])]
        cells = (
            f'<tr><td>{end}</td><td class="number">{value:.6g}</td><td class="number">{run:,}</td>'
            f"<td><code>{_text(command)}</code></td></tr>"
            for end, entries in ends
            for value, run, command in entries
        )
        yield _table(f"{one.name}: the ends", ("", "", "run", "makes it again"), cells)


def _table(title: str, head: Sequence[str], cells: Iterable[str]) -> str:
    heads = "".join(f"<th>{_text(name)}</th>" for name in head)
    return (
        f'<section><h2>{_text(title)}</h2><div class="scroll"><table><thead><tr>{heads}</tr></thead>'
        f"<tbody>{''.join(cells)}</tbody></table></div></section>\n"
    )


def _section(title: str, figures: Iterable[str]) -> str:
    drawn = "".join(figures)
    return f'<section><h2>{_text(title)}</h2><div class="sweep">{drawn}</div></section>\n' if drawn else ""


# --- drawings ---


def _distribution(column: Column, values: FloatArray) -> str:
    """Returns a histogram; margins below 0 are red: there a verdict failed."""
    good = values[np.isfinite(values)]
    if not len(good):
        return ""
    median = float(np.median(good))
    note = f"{column.count:,} runs: {column.least:.6g} … {column.most:.6g}, median {median:.6g}"
    if column.least == column.most:
        return _figure(column.name, "", f"{column.count:,} runs: {column.least:.6g} throughout")
    counts, edges = np.histogram(good, BINS, (column.least, column.most))
    margin = column.name.rstrip("0123456789 ").endswith(")")
    bars = []
    for i, count in enumerate(counts.tolist()):
        high = HEIGHT * count / counts.max()
        kind = "bad-bar" if margin and edges[i + 1] <= 0 else "bar"
        bars.append(_bar(kind, WIDTH * i / BINS, HEIGHT - high, WIDTH / BINS - 1, high))
    return _figure(column.name, "".join(bars) + _scale(column.least, column.most), note)


def _groups(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Returns the group of each row, and the centres of the groups: the values themselves if they are few."""
    good = values[np.isfinite(values)]
    known = np.unique(good)
    if len(known) <= STEPS:
        return np.searchsorted(known, values).astype(np.float64), known
    edges = np.linspace(known[0], known[-1], STEPS + 1)
    group = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, STEPS - 1)
    return group.astype(np.float64), (edges[1:] + edges[:-1]) / 2


def _shares(summary: Summary) -> Iterable[str]:
    if not summary.failed:
        return
    passed = summary.kept["passed"]
    for key in summary.keys:
        if key not in summary.kept or summary.columns[key].least == summary.columns[key].most:
            continue
        group, middles = _groups(summary.kept[key])
        each = WIDTH / len(middles)
        bars = []
        for i in range(len(middles)):
            rows = group == i
            if not np.any(rows):
                continue
            share = float(np.mean(passed[rows]))
            bars.append(_bar("bad-bar", each * i, 0, each - 1, HEIGHT * (1 - share)))
            bars.append(_bar("bar", each * i, HEIGHT * (1 - share), each - 1, HEIGHT * share))
        column = summary.columns[key]
        yield _figure(key, "".join(bars) + _scale(column.least, column.most), "blue: passed, red: failed")


def _dependences(summary: Summary, outputs: Sequence[Column]) -> Iterable[str]:
    """Yields the smallest, median and largest value of each number, by varied key."""
    for one in outputs:
        for key in summary.keys:
            of = summary.columns.get(key)
            if of is None or key not in summary.kept or of.least == of.most or one.least == one.most:
                continue
            group, middles = _groups(summary.kept[key])
            values = summary.kept[one.name]
            points = []
            for i, x in enumerate(middles.tolist()):
                there = values[(group == i) & np.isfinite(values)]
                if len(there):
                    points.append((x, float(there.min()), float(np.median(there)), float(there.max())))
            if len(points) < 2:
                continue

            def at(x: float, y: float, one: Column = one, of: Column = of) -> str:
                across = WIDTH * (x - of.least) / (of.most - of.least)
                return f"{across:.1f},{HEIGHT * (one.most - y) / (one.most - one.least):.1f}"

            band = [at(x, high) for x, _, _, high in points] + [at(x, low) for x, low, _, _ in reversed(points)]
            middle = [at(x, y) for x, _, y, _ in points]
            drawn = f'<polygon class="band" points="{" ".join(band)}"/>'
            drawn += f'<polyline class="middle" points="{" ".join(middle)}"/>'
            if one.least < 0 < one.most:
                zero = HEIGHT * one.most / (one.most - one.least)
                drawn += f'<line class="zero" x1="0" x2="{WIDTH}" y1="{zero:.1f}" y2="{zero:.1f}"/>'
            note = f"{one.least:.6g} … {one.most:.6g}: least, median and greatest"
            yield _figure(f"{one.name} by {key}", drawn + _scale(of.least, of.most), note)


def _figure(title: str, drawn: str, note: str) -> str:
    picture = f'<svg viewBox="0 0 {WIDTH} {HEIGHT + 16}" role="img">{drawn}</svg>' if drawn else ""
    return (
        f'<figure class="card"><figcaption>{_text(title)}</figcaption>{picture}'
        f'<span class="soft">{_text(note)}</span></figure>'
    )


def _bar(kind: str, x: float, y: float, width: float, height: float) -> str:
    return f'<rect class="{kind}" x="{x:.1f}" y="{y:.1f}" width="{max(width, 0.5):.1f}" height="{height:.1f}"/>'


def _scale(low: float, high: float) -> str:
    y = HEIGHT + 14
    return f'<text x="0" y="{y}">{low:.6g}</text><text x="{WIDTH}" y="{y}" text-anchor="end">{high:.6g}</text>'


def _said(value: object) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def _text(value: object) -> str:
    return html.escape(str(value))
