"""Pictures of recordings and of verdicts.

    figure = plot.draw(rec, "x.*_position", "x.following_error", title="first move")
    plot.save(figure, "first_move.png")

Needs no window system and does not use matplotlib's global state. In a notebook a figure is shown as the last value of
a cell.
"""

from __future__ import annotations

import fnmatch
import io
import math
import re
import textwrap
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from takt import style
from takt.checks.series import quantity, words
from takt.missing import holes
from takt.names import names_in
from takt.recording import Array, Event, FloatArray, Recording, RecordingError
from takt.verdict import Bound, Interval, Lane, Verdict
from takt.written import written

WIDTH_IN = 14.0  # 1400 pixels at 100 dpi
DPI = 100
PICTURES = (".png", ".svg", ".pdf")
INK = "#23282f"
FAINT = "#8b939e"
GRID = "#e6e9ee"
MANY = 100  # events; if more, starts and ends of commands are left out, and the others are drawn fainter
_PLAIN_LANE = 0.775  # width of a lane, as a share of the picture
EVENT_COLOURS = {"error": style.BAD, "end": "#9aa3ae", "start": "#4b5563", "mark": "#4b5563"}

Signal = tuple[str, str]


class Picture(Figure):
    """A figure that notebooks show as the last value of a cell."""

    def __init__(self, height: float, **options: Any) -> None:
        """height: [inch]; the width is WIDTH_IN."""
        super().__init__(figsize=(WIDTH_IN, height), dpi=DPI, facecolor="white", **options)
        FigureCanvasAgg(self)

    def _repr_png_(self) -> bytes:
        return png(self)


def png(figure: Figure) -> bytes:
    """Returns a figure as the bytes of a PNG file."""
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=DPI)
    return data.getvalue()


def select(recording: Recording, patterns: Sequence[str] = ()) -> list[Signal]:
    """Returns the signals that match any of the patterns ("x.set_position", "*.following_error", "x.*"). The name of a
    component alone selects its usual signals; without patterns, those of all components are returned. Raises
    RecordingError for a pattern without a match."""
    everything = [(c, f) for c in recording.components for f in recording.fields(c)[2:]]
    chosen: dict[Signal, None] = {}
    for pattern in names_in(patterns, "signals", "signal", "patterns") or recording.components:
        if pattern in recording:
            matches = _usual(recording, pattern)
        else:
            matches = [s for s in everything if fnmatch.fnmatchcase(".".join(s), pattern)]
        if not matches:
            raise RecordingError(f"no signal matches '{pattern}': {recording.why_no(pattern)}")
        chosen |= dict.fromkeys(matches)
    return list(chosen)


def draw(
    recording: Recording,
    *signals: str,
    title: str | None = None,
    window: Interval | None = None,
    events: bool = True,
) -> Picture:
    """Draws signals over time and returns the picture: stacked lanes, one for each quantity and unit, with bands for
    states and switches, and events above.

    signals: patterns as in `select`; none: the usual signals of all components.
    title: above the picture.
    window: start and end [s]; None: the whole recording.
    events: draws commands, errors and marks.

    Raises RecordingError if there is nothing to draw.
    """
    if window is not None:
        recording = recording.slice(*window)
    chosen = select(recording, signals)
    if not chosen:
        raise RecordingError("the recording has nothing to draw")
    components = list(dict.fromkeys(c for c, _ in chosen))
    bands = [s for s in chosen if _is_band(recording, s)]
    lanes: dict[tuple[str, str], list[Signal]] = {}
    for c, f in chosen:
        if (c, f) not in bands:
            lanes.setdefault((quantity(f), recording.unit(c, f)), []).append((c, f))
    order = {q: i for i, q in enumerate(style.QUANTITY_ORDER)}
    ranked = sorted(lanes.items(), key=lambda lane: order.get(lane[0][0], len(order)))
    shown = [e for e in recording.events if e.component in components or not e.component] if events else []
    if len(shown) > MANY:
        shown = [e for e in shown if e.kind not in ("start", "end")]
    span = window or (_or_zero(recording.start_s), _or_zero(recording.end_s))
    rows = _event_rows(shown, span)
    depth = 1 + max((row for _, row, _ in rows), default=-1)

    sizes = ([0.24 * depth] if depth else []) + [_lane_inches(q) for (q, _), _ in ranked]
    sizes += [0.3 * len(bands)] if bands else []
    figure, axes = _stack(sizes, title)
    if depth:
        _event_lane(axes.pop(0), rows, depth)
    for ((name, unit), members), ax in zip(ranked, axes, strict=False):
        _curves(ax, recording, name, members, components)
        _label(ax, name, unit)
        _mark(ax, shown)
    if bands:
        _band_lane(axes[-1], recording, bands, len(components) > 1)
        _mark(axes[-1], shown)
    _time_axis(axes[-1], span)
    return figure


def draw_verdict(verdict: Verdict, recording: Recording | None = None) -> Picture:
    """Draws the data of a verdict with its bounds and returns the picture; for a failure, with the time of the failure
    magnified beside it. `recording`: the judged recording, to show where samples are missing."""
    lanes = list(verdict.lanes)
    torn = {
        trace.label: holes(recording, verdict.components, trace.label) if recording is not None else []
        for lane in lanes
        for trace in lane.traces
    }
    whole = _span(lanes)
    zoom = _around(verdict, lanes, whole)
    mark = style.GOOD if verdict.passed else style.BAD
    columns = 1 if zoom is None else 2
    shares = [0.6 if lane.names else 2.6 for lane in lanes] or [2.6]
    height = 1.5 + sum(shares)
    figure = Picture(height)
    text = textwrap.fill(verdict.sentence, 150)
    head = 0.8 + 0.2 * (text.count("\n") + 1)
    figure.text(
        0.012,
        1 - 0.13 / height,
        "passed" if verdict.passed else "failed",
        color=mark,
        weight="bold",
        size=13,
        va="top",
    )
    figure.text(0.06, 1 - 0.13 / height, verdict.title, color=INK, weight="bold", size=13, va="top")
    figure.text(0.012, 1 - 0.45 / height, text, color=INK, size=11, va="top")
    grid = figure.add_gridspec(
        len(shares), columns, height_ratios=shares, left=0.065, right=0.985, top=1 - head / height,
        bottom=0.55 / height,
        width_ratios=[1] if zoom is None else [1.25, 1], hspace=0.3, wspace=0.13,
    )  # fmt: skip
    for column, view in enumerate([whole] if zoom is None else [whole, zoom]):
        for row, lane in enumerate(lanes):
            ax = figure.add_subplot(grid[row, column])
            _verdict_lane(ax, lane, view, torn, dots=column == 1, passed=verdict.passed)
            if verdict.place is not None and not verdict.passed:
                first, last = verdict.place
                ax.axvspan(first, last, color=style.BAD, alpha=0.13, lw=0, zorder=0)
                for edge in {first, last}:
                    ax.axvline(edge, color=style.BAD, lw=0.8, alpha=0.8, zorder=1)
            if column == 0:
                _label(ax, lane.traces[0].label.replace(".", "\n") if lane.names else lane.quantity, lane.unit)
                if zoom is not None:
                    ax.axvspan(*zoom, color="#5b6572", alpha=0.07, lw=0, zorder=0)
            if row == len(lanes) - 1:
                ax.set_xlabel("time [s]", color=INK, size=10.5)
            else:
                ax.tick_params(labelbottom=False)
    return figure


def save(figure: Figure, path: str | PathLike[str]) -> Path:
    """Writes a picture in the format of its suffix (PICTURES); a PNG is 1400 pixels wide. Returns the path. Raises
    ValueError for other suffixes."""
    target = Path(path)
    if target.suffix not in PICTURES:
        raise ValueError(f"{target}: expected a name that ends in {', '.join(PICTURES)}")
    target.parent.mkdir(parents=True, exist_ok=True)
    with written(target) as file:
        figure.savefig(file, format=target.suffix[1:], dpi=DPI)
    return target


# --- lanes of a recording ---


def _usual(recording: Recording, component: str) -> list[Signal]:
    fields = recording.fields(component)[2:]
    usual = [f for f in style.USUAL_FIELDS if f in fields]
    return [(component, f) for f in usual or fields]


def _is_band(recording: Recording, signal: Signal) -> bool:
    return bool(recording.names(*signal)) or recording.column(*signal).dtype.kind == "b"


def _lane_inches(name: str) -> float:
    return 2.3 if name.endswith("position") else 1.7


def _stack(sizes: Sequence[float], title: str | None) -> tuple[Picture, list[Axes]]:
    top, bottom, between = (0.62 if title else 0.22), 0.6, 0.16
    height = top + bottom + sum(sizes) + between * (len(sizes) - 1)
    figure = Picture(height)
    if title:
        figure.text(0.075, 1 - 0.2 / height, title, color=INK, weight="bold", size=14, va="top")
    axes: list[Axes] = []
    y = height - top
    for size in sizes:
        y -= size
        ax = figure.add_axes((0.075, y / height, _PLAIN_LANE, size / height), sharex=axes[0] if axes else None)
        y -= between
        axes.append(ax)
        ax.tick_params(labelbottom=False)
    return figure, axes


def _curves(ax: Axes, recording: Recording, name: str, signals: Sequence[Signal], components: Sequence[str]) -> None:
    dress(ax)
    fields = {field for _, field in signals}
    kinds = {style.is_set_point(f, fields) for f in fields}
    sources = dict.fromkeys(style.source(field) for _, field in signals)
    own = {source: style.PALETTE[i % len(style.PALETTE)] for i, source in enumerate(sources)}
    by_component = len(components) > 1 and (len(own) == 1 or len({component for component, _ in signals}) > 1)
    for component, field in signals:
        table = recording[component]
        colour = style.component_colour(component, components) if by_component else own[style.source(field)]
        dashed = style.is_set_point(field, fields) and len(kinds) > 1
        look: dict[str, Any] = (
            {"color": _darker(colour), "ls": (0, (4, 2.2)), "lw": 1.3, "zorder": 3}
            if dashed
            else {"color": colour, "lw": 1.7, "zorder": 2}
        )
        label = f"{component}  {words(field)}" if len(components) > 1 else words(field)
        modulus = recording.info(component).get("modulus") if name == "position" else None
        label = textwrap.fill(label, 24, subsequent_indent="  ")  # longer ones leave the picture
        torn = holes(recording, (component,))
        ax.plot(*unjoined(table["time_s"], table[field], modulus, torn), label=label, **look)
    _calm_limits(ax)
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(
        handles, labels, loc="upper left", bbox_to_anchor=(1.008, 1.03), borderaxespad=0, frameon=False,
        fontsize=9.5, labelcolor=INK, handlelength=2.2, labelspacing=0.25,
    )  # fmt: skip


def _band_lane(ax: Axes, recording: Recording, signals: Sequence[Signal], several: bool) -> None:
    dress(ax)
    ax.grid(visible=False)
    total = len(signals)
    span = (_or_zero(recording.start_s), _or_zero(recording.end_s))
    for row, (component, field) in enumerate(signals):
        names = recording.names(component, field) or {1: words(field)}
        table = recording[component]
        torn = holes(recording, (component,))
        _band(ax, total - 1 - row, table["time_s"], table[field], names, span, torn)
    ax.set_ylim(-0.5, total - 0.5)
    labels = [f"{c} {words(f)}" if several else words(f) for c, f in reversed(signals)]
    labels = [textwrap.fill(label, 14) for label in labels]  # wider ones leave the picture
    ax.set_yticks(range(total), labels, size=9.5, color=INK)
    ax.tick_params(axis="y", length=0)


def _band(
    ax: Axes,
    y: float,
    time_s: FloatArray,
    values: Any,
    names: dict[int, str],
    span: Interval,
    torn: Sequence[Interval],
) -> None:
    """Draws one row of coloured intervals; of a switch (only 1 has a name), those in which it is on."""
    length = max(span[1] - span[0], 1e-9)
    for first, last, value in stretches(time_s, values, torn):
        if value == 0 and 0 not in names:
            continue
        name = names.get(value, f"?{value}")
        colour = style.state_colour(name, value)
        ax.barh(y, last - first, left=first, height=0.78, color=colour, alpha=0.85, lw=0, zorder=2)
        seen = (max(first, span[0]), min(last, span[1]))
        if (seen[1] - seen[0]) / length > (0.0066 * len(name) + 0.006) * _PLAIN_LANE / _lane_width(ax):
            ax.text(
                sum(seen) / 2, y, name, ha="center", va="center_baseline", size=8.5, color="white", zorder=3,
                weight="bold", clip_on=True,
            )  # fmt: skip


def _lane_width(ax: Axes) -> float:
    return float(ax.get_position().width)


def stretches(time_s: FloatArray, values: Any, torn: Sequence[Interval] = ()) -> list[tuple[float, float, int]]:
    """Returns (from, to, value) of each interval in which a column is constant and no samples are missing."""
    if not len(values):
        return []
    whole = np.nan_to_num(np.asarray(values, dtype=np.float64), nan=-1).astype(np.int64)
    behind = _behind(time_s, torn)
    starts = np.unique(np.concatenate(([0], np.flatnonzero(np.diff(whole)) + 1, behind)))
    ends = np.append(starts[1:] - np.isin(starts[1:], behind), len(whole) - 1)
    return [(float(time_s[a]), float(time_s[b]), int(whole[a])) for a, b in zip(starts, ends, strict=True)]


def unjoined(
    time_s: FloatArray, values: Any, modulus: float | None, torn: Sequence[Interval] = ()
) -> tuple[FloatArray, FloatArray]:
    """Returns the curve, interrupted where a rotary position wraps around and where samples are missing."""
    numbers = np.asarray(values, dtype=np.float64)
    if not modulus and not torn:
        return time_s, numbers
    jumps = _behind(time_s, torn)
    if modulus:
        jumps = np.union1d(jumps, np.flatnonzero(np.abs(np.diff(numbers)) > modulus / 2) + 1)
    return np.insert(time_s, jumps, time_s[jumps]), np.insert(numbers, jumps, np.nan)


def _behind(time_s: FloatArray, torn: Sequence[Interval]) -> Array:
    """Returns the first row after each of these gaps that is between rows."""
    rows = np.unique(np.searchsorted(time_s, [until for _, until in torn]))
    return rows[(rows > 0) & (rows < len(time_s))]


def _event_rows(events: Sequence[Event], span: Interval) -> list[tuple[Event, int, bool]]:
    """Arranges the labels of events in rows without overlap, marks and errors first. Returns event, row, and whether
    the label is to the left of its line. Labels that do not fit into four rows are left out; their lines stay."""
    length = max(span[1] - span[0], 1e-9)
    taken: list[list[tuple[float, float]]] = [[] for _ in range(4)]
    placed = []
    for event in sorted(events, key=lambda e: e.kind not in ("mark", "error")):
        x = (event.time_s - span[0]) / length
        width = 0.0064 * len(_short(event)) + 0.014
        leftwards = x + width > 1.1
        begin, end = (x - width, x) if leftwards else (x, x + width)
        for row, others in enumerate(taken):
            if all(end <= b or begin >= e for b, e in others):
                others.append((begin, end))
                placed.append((event, row, leftwards))
                break
    return placed


def _event_lane(ax: Axes, rows: Sequence[tuple[Event, int, bool]], depth: int) -> None:
    ax.set_facecolor("none")
    for side in ax.spines.values():
        side.set_visible(False)
    ax.set_yticks([])
    ax.tick_params(axis="x", length=0)
    ax.set_ylim(depth, 0)
    for event, row, leftwards in rows:
        colour = EVENT_COLOURS.get(event.kind, FAINT)
        ax.plot(
            [event.time_s, event.time_s],
            [row + 0.15, depth + 0.4],
            color=colour,
            lw=0.8,
            alpha=0.55,
            clip_on=False,
        )
        ax.annotate(
            _short(event),
            (event.time_s, row + 0.5),
            xytext=(-3.5 if leftwards else 3.5, 0),
            textcoords="offset points",
            size=9,
            ha="right" if leftwards else "left",
            va="center",
            color=colour if event.kind == "error" else INK,
            weight="bold" if event.kind == "mark" else "normal",
            annotation_clip=False,
        )


def _short(event: Event) -> str:
    """Returns the text of an event, shortened, preceded by the component unless it begins with it."""
    named = not event.component or re.match(rf"{re.escape(event.component)}\b", event.text)
    text = event.text if named else f"{event.component}: {event.text}"
    return text if len(text) <= 38 else text[:37] + "…"


def _mark(ax: Axes, events: Sequence[Event]) -> None:
    alpha = 0.35 * min(1.0, 0.5 * MANY / max(len(events), 1))
    for event in events:
        ax.axvline(event.time_s, color=EVENT_COLOURS.get(event.kind, FAINT), lw=0.8, alpha=alpha, zorder=1)


# --- lanes of a verdict ---


def _verdict_lane(
    ax: Axes, lane: Lane, view: Interval, torn: Mapping[str, Sequence[Interval]], dots: bool, passed: bool
) -> None:
    dress(ax)
    ax.set_xlim(*view)
    if lane.names:
        ax.grid(visible=False)
        ax.set_yticks([])
        ax.set_ylim(-0.7, len(lane.traces) - 0.3)
        for i, trace in enumerate(lane.traces):
            _band(ax, i, trace.time_s, trace.values, lane.names, view, torn[trace.label])
        return
    for i, trace in enumerate(lane.traces):
        inside = (trace.time_s >= view[0]) & (trace.time_s <= view[1])
        points = dots and np.count_nonzero(inside) < 120
        ax.plot(
            *unjoined(trace.time_s, trace.values, trace.modulus, torn[trace.label]),
            color=style.PALETTE[i % len(style.PALETTE)], lw=1.6, label=trace.label, zorder=3,
            marker="." if points else None, ms=5,
        )  # fmt: skip
    low, high = _value_range(lane, view, passed)
    ax.set_ylim(low, high)
    for bound in lane.bounds:
        at_most = bound.values if len(bound.values) else np.zeros(0)
        ax.plot(
            bound.time_s,
            at_most,
            color=style.BAD,
            lw=1.2,
            ls=(0, (5, 2)),
            label=bound.label or None,
            zorder=2,
        )
        if bound.forbidden != "none":
            edge = high if bound.forbidden == "above" else low
            ax.fill_between(bound.time_s, at_most, edge, color=style.BAD, alpha=0.06, lw=0, zorder=0)
    if not dots:
        ax.legend(
            loc="lower left", bbox_to_anchor=(0, 1.0), ncols=4, fontsize=9, frameon=False, labelcolor=INK,
            borderaxespad=0.1, handlelength=2, columnspacing=1.6,
        )  # fmt: skip


def _value_range(lane: Lane, view: Interval, passed: bool) -> Interval:
    """Returns the range of the curves in view, of bounds near enough not to flatten them, and of the nearest violated
    bound."""
    seen = [t.values[(t.time_s >= view[0]) & (t.time_s <= view[1])].astype(np.float64) for t in lane.traces]
    values = np.concatenate([*seen, np.zeros(0)])
    values = values[np.isfinite(values)]
    if not len(values):
        values = np.zeros(1)
    least, most = float(values.min()), float(values.max())
    extent = most - least
    shown, broken = [least, most], []
    for bound in lane.bounds:
        for level in _levels(bound, view):
            if least - 1.5 * extent - abs(level) * 1e-3 <= level <= most + 1.5 * extent + abs(level) * 1e-3:
                shown.append(level)
            if {"above": level < most, "below": level > least, "none": True}[bound.forbidden]:
                broken.append(level)
    if broken and not passed:
        shown.append(min(broken, key=lambda level: max(least - level, level - most, 0.0)))
    low, high = min(shown), max(shown)
    pad = 0.12 * (high - low) or abs(high) * 1e-3 or 1.0
    return low - pad, high + pad


def _levels(bound: Bound, view: Interval) -> list[float]:
    inside = bound.values[(bound.time_s >= view[0]) & (bound.time_s <= view[1])]
    if not len(inside):
        inside = np.interp(view, bound.time_s, bound.values) if len(bound.values) else inside
    return [float(v) for v in (inside.min(), inside.max()) if math.isfinite(v)] if len(inside) else []


def _span(lanes: Sequence[Lane]) -> Interval:
    times = [t.time_s for lane in lanes for t in lane.traces if len(t.time_s)]
    if not times:
        return 0.0, 1.0
    first, last = min(float(t[0]) for t in times), max(float(t[-1]) for t in times)
    return (first, last) if last > first else (first - 0.5, first + 0.5)


def _around(verdict: Verdict, lanes: Sequence[Lane], whole: Interval) -> Interval | None:
    """Returns the interval to magnify, with margins; None for a passed verdict, or if it is most of the picture."""
    if verdict.passed or verdict.place is None or not lanes:
        return None
    view = around(verdict.place, lanes)
    return view if 0 < view[1] - view[0] < 0.6 * (whole[1] - whole[0]) else None


def around(place: Interval, lanes: Sequence[Lane]) -> Interval:
    """Returns an interval with margins, limited to the curves."""
    whole = _span(lanes)
    steps = [np.median(np.diff(t.time_s)) for lane in lanes for t in lane.traces if len(t.time_s) > 1]
    room = max(0.6 * (place[1] - place[0]), 0.008 * (whole[1] - whole[0]), 12.0 * float(max(steps, default=0.0)))
    return max(place[0] - room, whole[0]), min(place[1] + room, whole[1])


# --- appearance ---


def dress(ax: Axes) -> None:
    """Sets the appearance of a lane."""
    ax.set_facecolor("white")
    ax.grid(visible=True, color=GRID, lw=0.8, zorder=0)
    ax.set_axisbelow(True)
    for name, side in ax.spines.items():
        side.set_visible(name in ("left", "bottom"))
        side.set_color("#c5cad2")
    ax.tick_params(colors=FAINT, labelcolor=INK, labelsize=9.5, length=3)
    ax.ticklabel_format(axis="y", useOffset=False)
    ax.yaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 2.5, 5, 10]))
    ax.xaxis.set_major_locator(MaxNLocator(nbins=10, steps=[1, 2, 5, 10]))
    ax.margins(x=0)


def _label(ax: Axes, name: str, unit: str) -> None:
    ax.set_ylabel(f"{name}\n[{unit}]" if unit else name, color=INK, size=10.5)
    ax.yaxis.set_label_coords(-0.042 / _lane_width(ax), 0.5)


def _time_axis(ax: Axes, span: Interval) -> None:
    ax.tick_params(labelbottom=True)
    ax.set_xlabel("time [s]", color=INK, size=10.5)
    if span[1] > span[0]:
        ax.set_xlim(*span)


def _calm_limits(ax: Axes) -> None:
    """Keeps rounding noise on a constant from filling the lane."""
    low, high = ax.get_ylim()
    least = 1e-6 * max(abs(low), abs(high), 1e-3)
    if high - low < least:
        middle = (low + high) / 2
        ax.set_ylim(middle - least, middle + least)


def _darker(colour: str) -> tuple[float, float, float]:
    r, g, b = colors.to_rgb(colour)
    return 0.45 * r, 0.45 * g, 0.45 * b


def _or_zero(value: float) -> float:
    return value if np.isfinite(value) else 0.0
