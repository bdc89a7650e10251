"""Writes reports: the self-contained page, and the pictures beside it."""

from __future__ import annotations

import base64
import functools
import html
import json
import re
import zlib
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from takt import plot, style
from takt.checks.series import quantity, words
from takt.export import rates
from takt.figures import in_words
from takt.missing import all_missing, holes, troubles
from takt.recording import Array, Recording
from takt.report.columns import Block
from takt.report.inlined import asset, import_map
from takt.report.kept import KEY, keep, kept, plain, told
from takt.report.scene import cams_of, machine_of, scene_of
from takt.source import IN_DIRECTORY
from takt.tables import short_name
from takt.verdict import Verdict
from takt.written import write_text

# Fields with the position of a component, the best first: its actual position, or the Y of a cam module.
POSITIONS = ("actual_position", "position", "set_position", "set_y_position")
# Columns of the summary with the largest value of the first field that exists. Several fields are one vector; actual
# coordinates are taken relative to their set points.
LARGEST = {
    "max. velocity": (
        *("actual_velocity", "velocity", "set_velocity", "set_y_velocity", "set_path_velocity"),
        "velocity_x velocity_y",
    ),
    "max. acceleration": (
        *("set_acceleration", "acceleration", "actual_acceleration", "set_y_acceleration"),
        "acceleration_x acceleration_y",
    ),
    "max. following error": ("following_error", "actual_x actual_y actual_z"),
}
PAGE = "report.html"
BYTES = 128 << 20  # of all curves of a page before compression; longer runs are thinned evenly
# Entries of `meta` that are not shown as facts in the head of the page.
ELSEWHERE = (
    KEY,
    "machine_file",
    "objects",
    "made_cams",
    "trouble",
    "starts",
    "period_s",
    "losses",
    "dropped",
    "silent",
    "late",
    "played",
)


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
    assertion: Verdict | None = None,
) -> Report:
    """Writes report.html, the recording with all data of the page (recording.npz) and the pictures into `out_dir`,
    replacing files of an earlier run with the same names.

    meta: facts of the run, as the figures of `keep`. The recording's own `meta` is shown as well.
    more: further pictures by name, shown in the page and saved as NAME.png beside it.
    assertion: a failed plain assertion beside the verdicts; None: none.
    """
    directory = Path(out_dir)
    directory.mkdir(parents=True, exist_ok=True)
    judged = [*verdicts, *([assertion] if assertion is not None else [])]
    pictures = _pictures(recording, judged, directory, title)
    shown = {name: plot.save(figure, directory / f"{_file_name(name)}.png") for name, figure in (more or {}).items()}
    whole = keep(recording, title, verdicts, assertion, meta, {name: path.read_bytes() for name, path in shown.items()})
    whole.save(directory / IN_DIRECTORY)
    page = directory / PAGE
    write_text(page, render_kept(whole, title))
    return Report(page, (*pictures, *shown.values()))


def render(
    recording: Recording,
    verdicts: Sequence[Verdict],
    title: str,
    meta: Mapping[str, Any] | None = None,
    assertion: Verdict | None = None,
) -> str:
    """Returns the HTML page as text."""
    return render_kept(keep(recording, title, verdicts, assertion, meta), title)


def render_kept(recording: Recording, name: str) -> str:
    """Returns the HTML page of a recording with its kept data. `name`: its title if there are none."""
    run = kept(recording) or {"title": name, "made": "", "verdicts": [], "complaint": "", "figures": {}, "pictures": {}}
    block = Block()
    facts = facts_of(recording, run["figures"])
    machine = machine_of(recording)
    scene = scene_of(recording, block, machine)
    judged = [v for v in (*run["verdicts"], run.get("assertion")) if v is not None]
    failing = [v["view"] for v in judged if v["view"] and not v["passed"]]
    payload = {
        "title": run["title"],
        "made": run["made"],
        "trouble": " ".join(troubles(recording)),
        "meta": facts,
        "span": plain([recording.start_s, recording.end_s]),
        **columns_of(recording, block, failing),
        "events": [[e.time_s, e.component, e.text, e.kind] for e in recording.events],
        "complaint": run["complaint"],
        "assertion": _verdict(run["assertion"], block, recording) if run.get("assertion") else None,
        "verdicts": [_verdict(v, block, recording) for v in sorted(run["verdicts"], key=lambda v: bool(v["passed"]))],
        "summary": _summary(recording),
        "quantities": list(style.QUANTITY_ORDER),
        "palette": list(style.PALETTE),
        "scene": scene,
        "cams": cams_of(recording, machine),
    }
    pictures = "".join(_shown(name, bytes(png)) for name, png in run["pictures"].items())
    return filled("page", str(run["title"]), payload, block, pictures=pictures)


def filled(name: str, title: str, payload: Mapping[str, Any], block: Block, **parts: str) -> str:
    """Returns the page `name`.html with all that it needs: its module and the imports of that, and its data."""
    main = f"takt/report/page/{MAINS[name]}"
    data = json.dumps(payload, ensure_ascii=False, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    parts |= {
        "title": html.escape(title),
        "style": "".join(asset(*path) for path in STYLES),
        "uplot": asset("report", "page", "uplot", "uPlot.iife.min.js"),
        "modules": import_map(main),
        "main": main,
        "data": data,
        "columns": block.text(),
        "three": three_inside() if payload.get("scene") else "",
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda m: parts[m[1]], asset("report", "page", f"{name}.html"))


@functools.cache
def three_inside() -> str:
    """Returns three.js for pages with a scene, with its imports, deflated; about 250 kB."""
    texts = (asset("view", "page", "three", f"three.{part}.min.js") for part in ("core", "module"))
    return base64.b64encode(zlib.compress("\0".join(texts).encode(), 9)).decode("ascii")


MAINS = {"page": "main.js", "compare": "compare.js"}
STYLES = (
    ("view", "page", "look.css"),
    ("report", "page", "uplot", "uPlot.min.css"),
    ("report", "page", "style.css"),
)


def facts_of(recording: Recording, figures: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the facts in the head of the page: from the recording's own `meta`, and the kept figures, in words."""
    facts: dict[str, Any] = {**told({k: v for k, v in recording.meta.items() if k not in ELSEWHERE}), **figures}
    if isinstance(engine := facts.get("engine"), Mapping):
        facts["engine"] = in_words(engine)
    if (period := recording.meta.get("period_s")) is not None:
        facts["cycle"] = f"{1e3 * period:g} ms"
    if not all_missing(recording):
        facts["lost samples"] = "none"
    if losses := recording.meta.get("losses"):
        facts["messages lost on the way, of"] = {short_name(channel): f"{count:,}" for channel, count in losses.items()}
    return facts


def _shown(name: str, png: bytes) -> str:
    data = base64.b64encode(png).decode("ascii")
    return (
        f"<section><h2>{html.escape(name)}</h2>"
        f'<img class="picture" alt="{html.escape(name)}" src="data:image/png;base64,{data}"></section>'
    )


# --- data of the page ---


def columns_of(recording: Recording, block: Block, whole: Sequence[Sequence[float]]) -> dict[str, Any]:
    """Returns time bases, shared if they are the same, and the columns of each component. Recordings that would be too
    long for a page are reduced to every n-th sample, except in the windows `whole` [s]."""
    every = _every(recording)
    bases: list[dict[str, Any]] = []
    known: dict[bytes, int] = {}
    components = []
    for component in recording.components:
        table = recording[component]
        rows = _rows(table, every, whole)
        time_s = np.ascontiguousarray(table["time_s"][rows])
        base = known.setdefault(time_s.tobytes(), len(bases))
        if base == len(bases):
            bases.append(block.time(time_s))
        components.append(
            {
                "name": component,
                "base": base,
                "colour": style.component_colour(component, recording.components),
                "modulus": recording.info(component).get("modulus"),
                "holes": holes(recording, (component,)),
                "fields": [_field(recording, component, f, rows, block) for f in recording.fields(component)[2:]],
            }
        )
    return {"bases": bases, "components": components, "thinned": _thinned(recording, every)}


def _thinned(recording: Recording, every: int) -> str:
    """Returns a sentence about samples that are not shown; empty if all are."""
    if every == 1:
        return ""
    rate = max(rates(recording).values()) / every
    return (
        f"This run is long: one sample of {every} is shown, {rate:.3g} a second, and all where something failed. "
        "Verdicts and figures are of all samples."
    )


def _every(recording: Recording) -> int:
    """Returns n if every n-th sample is shown."""
    size = sum(
        table[f].nbytes // (2 if table[f].dtype.kind == "f" else 1)
        for table in map(recording.__getitem__, recording.components)
        for f in (table.dtype.names or ())[2:]
        if len(table) and np.any(table[f] != table[f][0])
    )
    return max(1, -(-size // BYTES))


def _rows(table: Array, every: int, whole: Sequence[Sequence[float]]) -> Any:
    """Returns which rows of a component are shown; always the last one."""
    if every == 1:
        return slice(None)
    time_s = table["time_s"]
    shown = np.zeros(len(table), dtype=bool)
    shown[::every] = shown[-1:] = True
    for begin, end in whole:
        shown |= (time_s >= begin) & (time_s <= end)
    return shown


def _field(recording: Recording, component: str, field: str, rows: Any, block: Block) -> dict[str, Any]:
    column = recording.column(component, field)[rows]
    names = recording.names(component, field)
    flag = column.dtype.kind == "b"
    out: dict[str, Any] = {
        "name": field,
        "label": words(field),
        "quantity": quantity(field),
        "unit": recording.unit(component, field),
        "set": style.is_set_point(field, recording.fields(component)),
        "source": style.source(field),
        **block.put(column),
    }
    if names or flag:
        shown = names or {1: words(field)}
        out["names"] = {str(v): [t, style.state_colour(t, v)] for v, t in shown.items()}
    return out


def _verdict(verdict: Mapping[str, Any], block: Block, recording: Recording) -> dict[str, Any]:
    """Returns a kept verdict with its curves in the block."""

    def curve(kept: Mapping[str, Any]) -> dict[str, Any]:
        rest = {k: v for k, v in kept.items() if k not in ("time_s", "values")}
        rest["holes"] = holes(recording, verdict["components"], kept["label"])
        return {**rest, "time": block.time(kept["time_s"]), "values": block.put(kept["values"])}

    def lane(kept: Mapping[str, Any]) -> dict[str, Any]:
        names = {value: [name, style.state_colour(name, int(value))] for value, name in kept["names"].items()}
        curves = {what: [curve(one) for one in kept[what]] for what in ("traces", "bounds")}
        return {**kept, "names": names, **curves}

    return {**verdict, "lanes": [lane(one) for one in verdict["lanes"]]}


def _summary(recording: Recording) -> dict[str, Any]:
    """Returns a row per component: extremes of actual values, final state, losses."""
    rows = []
    for component in recording.components:
        table = recording[component]
        fields = recording.fields(component)

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
                *(_largest(recording, component, what) for what in LARGEST),
                state,
                f"{errors}",
                f"{lost}",
            ]
        )
    head = [
        "",
        "samples",
        "position",
        *LARGEST,
        "ended in",
        "errors",
        "lost",
    ]
    return {"head": head, "rows": rows}


def _largest(recording: Recording, component: str, what: str) -> str:
    table, fields = recording[component], recording.fields(component)
    found = next((names.split() for names in LARGEST[what] if set(names.split()) <= set(fields)), None)
    if found is None:
        return "—"
    columns = [table[field].astype(np.float64) for field in found]
    if found[0] == "actual_x":
        columns = [there - table[field.removeprefix("actual_")] for there, field in zip(columns, found, strict=True)]
    with np.errstate(over="ignore"):  # damaged logs hold numbers that no engine publishes
        lengths = np.sqrt(np.sum(np.square(columns), axis=0))
    lengths = lengths[np.isfinite(lengths)]
    return f"{float(lengths.max()):.5g} {recording.unit(component, found[0])}".rstrip() if len(lengths) else "—"


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
        pictures.append(plot.save(plot.draw_verdict(verdict, recording), directory / f"{_file_name(name)}.png"))
    return pictures


def _matches(recording: Recording, pattern: str) -> bool:
    field = pattern.removeprefix("*.")
    return any(field in recording.fields(c) for c in recording.components)


def _file_name(text: str) -> str:
    return re.sub(r"[^\w.-]+", "_", text)[:80]
