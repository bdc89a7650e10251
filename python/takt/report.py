"""A report of a run: one HTML page that needs nothing else, with curves to zoom into, and the pictures beside
it."""

from __future__ import annotations

import base64
import html
import json
import math
import re
from collections.abc import Mapping, Sequence
from datetime import datetime, timezone
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from takt import plot, style
from takt.checks.series import quantity, words
from takt.recording import Array, Recording
from takt.verdict import Verdict, seconds

# What says where a component is, the best first: its own measured position, or the Y of a cam module.
POSITIONS = ("actual_position", "position", "set_position", "set_y_position")


class Report(NamedTuple):
    html: Path
    pictures: tuple[Path, ...]


def write_report(
    recording: Recording,
    verdicts: Sequence[Verdict],
    out_dir: str | PathLike[str],
    title: str,
    meta: Mapping[str, Any] | None = None,
    more: Mapping[str, Figure] | None = None,
) -> Report:
    """Writes report.html and the pictures into `out_dir`, replacing what an earlier run left under the same
    names.

    meta: what to say about the run. Plain values stand in the head ("machine": "six_axes"); a dict is a group
        of figures under its name
    ("engine": {"longest cycle": "112 µs", "overruns": 0}). What the recording's own `meta` holds is shown as
    well.
    more: pictures of the caller's by name, to be shown in the page and kept as NAME.png beside it.
    """
    directory = Path(out_dir)
    directory.mkdir(parents=True, exist_ok=True)
    pictures = _pictures(recording, verdicts, directory, title)
    page = directory / "report.html"
    shown = {name: plot.save(figure, directory / f"{_file_name(name)}.png") for name, figure in (more or {}).items()}
    pictures += shown.values()
    text = render(recording, verdicts, title, {**recording.meta, **(meta or {})}, shown)
    page.write_text(text, encoding="utf-8")
    return Report(page, tuple(pictures))


def render(
    recording: Recording,
    verdicts: Sequence[Verdict],
    title: str,
    meta: Mapping[str, Any] | None = None,
    pictures: Mapping[str, Path] | None = None,
) -> str:
    """The HTML page as text. `pictures`: PNG files to show in it."""
    payload = {
        "title": title,
        "made": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "meta": _plain({name: value for name, value in (meta or {}).items() if value not in ({}, [], "", None)}),
        "span": _plain([recording.start_s, recording.end_s]),
        **_columns(recording),
        "events": [[e.time_s, e.component, e.text, e.kind] for e in recording.events],
        "verdicts": [_verdict(v) for v in sorted(verdicts, key=lambda v: v.passed)],
        "summary": _summary(recording),
        "quantities": list(style.QUANTITY_ORDER),
        "good": style.GOOD,
        "bad": style.BAD,
    }
    data = json.dumps(payload, ensure_ascii=False, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    assets = resources.files("takt") / "assets"
    parts = {
        "title": html.escape(title),
        "style": _asset(assets, "uplot", "uPlot.min.css") + _asset(assets, "report.css"),
        "uplot": _asset(assets, "uplot", "uPlot.iife.min.js"),
        "script": _asset(assets, "report.js"),
        "data": data,
        "pictures": "".join(_shown(name, path) for name, path in (pictures or {}).items()),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda m: parts[m[1]], _asset(assets, "report.html"))


def _shown(name: str, path: Path) -> str:
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    return (
        f"<section><h2>{html.escape(name)}</h2>"
        f'<img class="picture" alt="{html.escape(name)}" src="data:image/png;base64,{data}"></section>'
    )


def _asset(assets: Any, *path: str) -> str:
    text: str = assets.joinpath(*path).read_text(encoding="utf-8")
    return text


# --- what the page is given ---


def _columns(recording: Recording) -> dict[str, Any]:
    """Time bases, shared where they are the same, and the columns of each component."""
    bases: list[dict[str, Any]] = []
    known: dict[bytes, int] = {}
    components = []
    for component in recording.components:
        table = recording[component]
        time_s = np.ascontiguousarray(table["time_s"])
        base = known.setdefault(time_s.tobytes(), len(bases))
        if base == len(bases):
            bases.append(_time_base(time_s))
        components.append(
            {
                "name": component,
                "base": base,
                "colour": style.component_colour(component, recording.components),
                "modulus": recording.info(component).get("modulus"),
                "fields": [_field(recording, component, f) for f in recording.fields(component)[2:]],
            }
        )
    return {"bases": bases, "components": components}


def _time_base(time_s: Array) -> dict[str, Any]:
    n = len(time_s)
    if n > 1:
        even = time_s[0] + np.arange(n) * ((time_s[-1] - time_s[0]) / (n - 1))
        if np.max(np.abs(even - time_s)) < 1e-9 * max(1.0, float(time_s[-1])):
            return {"n": n, "from": float(time_s[0]), "to": float(time_s[-1])}
    return {"n": n, **_packed(time_s, "<f8", "f64")}


def _field(recording: Recording, component: str, field: str) -> dict[str, Any]:
    column = recording.column(component, field)
    names = recording.names(component, field)
    flag = column.dtype.kind == "b"
    out: dict[str, Any] = {
        "label": words(field),
        "quantity": quantity(field),
        "unit": recording.unit(component, field),
        "set": style.is_set_point(field),
        **_encoded(column),
    }
    if names or flag:
        shown = names or {1: words(field)}
        out["names"] = {str(v): [t, style.state_colour(t, v)] for v, t in shown.items()}
    return out


def _encoded(column: Array) -> dict[str, Any]:
    """As small as it can be without a difference that could be seen: one value where nothing changes, bytes
    for states, 32-bit floats where their rounding is below a millionth of the column's range."""
    if column.dtype.kind == "b" or column.dtype == np.int8:
        return _packed(column, "i1", "i8")
    values = column.astype(np.float64)
    good = values[np.isfinite(values)]
    if not len(good):
        return {"constant": None}
    if len(good) == len(values) and np.all(values == values[0]):
        return {"constant": float(values[0])}
    largest = float(np.max(np.abs(good)))
    if largest < 1e38 and largest * 2.0**-24 <= 1e-6 * float(np.ptp(good)):
        return _packed(values, "<f4", "f32")
    return _packed(values, "<f8", "f64")


def _packed(values: Array, dtype: str, name: str) -> dict[str, Any]:
    return {name: base64.b64encode(np.ascontiguousarray(values, dtype=dtype).tobytes()).decode("ascii")}


def _verdict(verdict: Verdict) -> dict[str, Any]:
    bounds = [
        {"quantity": lane.quantity, "unit": lane.unit, "level": float(bound.values[0]), "label": bound.label}
        for lane in verdict.lanes
        for bound in lane.bounds
        if len(bound.values) and np.all(bound.values == bound.values[0]) and math.isfinite(bound.values[0])
    ]
    return {
        "title": verdict.title,
        "components": list(verdict.components),
        "passed": verdict.passed,
        "sentence": verdict.sentence,
        "when": None if verdict.when_s is None else seconds(verdict.when_s),
        "place": _plain(verdict.place or ([verdict.when_s] * 2 if verdict.when_s is not None else None)),
        "bounds": bounds,
    }


def _summary(recording: Recording) -> dict[str, Any]:
    """A row per component: extremes of what was measured, how it ended, what was lost."""
    rows = []
    for component in recording.components:
        table = recording[component]
        fields = recording.fields(component)

        def largest(*candidates: str, _component: str = component, _fields: tuple[str, ...] = fields) -> str:
            field = next((f for f in candidates if f in _fields), None)
            if field is None or not len(recording[_component]):
                return "—"
            values = np.abs(recording[_component][field].astype(np.float64))
            if np.all(np.isnan(values)):
                return "—"
            return f"{float(np.nanmax(values)):.5g} {recording.unit(_component, field)}".rstrip()

        position = next((f for f in POSITIONS if f in fields), None)
        travelled = "—"
        if position is not None and len(table) and np.any(np.isfinite(table[position])):
            p, unit = table[position], recording.unit(component, position)
            travelled = f"{float(np.nanmin(p)):.6g} … {float(np.nanmax(p)):.6g} {unit}".rstrip()
        state = "—"
        if recording.names(component, "state") if "state" in fields else False:
            state = str(recording.text(component, "state")[-1]) if len(table) else "—"
        errors = sum(1 for e in recording.events if e.component == component and e.kind == "error")
        lost = sum(g.missing for g in recording.gaps(component))
        rows.append(
            [
                component,
                f"{len(table)}",
                travelled,
                largest("actual_velocity", "velocity", "set_velocity", "set_y_velocity"),
                largest("set_acceleration", "acceleration", "actual_acceleration", "set_y_acceleration"),
                largest("following_error"),
                state,
                f"{errors}",
                f"{lost}",
            ]
        )
    head = [
        "",
        "samples",
        "position",
        "max. velocity",
        "max. acceleration",
        "max. following error",
        "ended in",
        "errors",
        "lost",
    ]
    return {"head": head, "rows": rows}


def _plain(value: Any) -> Any:
    """Numbers that JSON does not know become null; NumPy's become Python's; what else there is becomes
    text."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, bool | int | str) else str(value)


def _pictures(recording: Recording, verdicts: Sequence[Verdict], directory: Path, title: str) -> list[Path]:
    pictures = []
    if len(recording.components) > 1:
        overview = [
            s
            for s in ("*.actual_position", "*.set_y_position", "*.following_error", "*.state")
            if _matches(recording, s)
        ]
        if overview:
            pictures.append(plot.save(plot.draw(recording, *overview, title=title), directory / "overview.png"))
    for component in recording.components:
        if recording.fields(component)[2:]:
            figure = plot.draw(recording, component, title=f"{title}: {component}")
            pictures.append(plot.save(figure, directory / f"{_file_name(component)}.png"))
    for i, verdict in enumerate(v for v in verdicts if not v.passed and v.lanes):
        name = "_".join(("failed", str(i + 1), verdict.name, *verdict.components))
        pictures.append(plot.save(plot.draw_verdict(verdict), directory / f"{_file_name(name)}.png"))
    return pictures


def _matches(recording: Recording, pattern: str) -> bool:
    field = pattern.removeprefix("*.")
    return any(field in recording.fields(c) for c in recording.components)


def _file_name(text: str) -> str:
    return re.sub(r"[^\w.-]+", "_", text)[:80]
