"""The machine that an engine runs, as the page needs it: its components, their signals, and its geometry."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from takt import _core, msgs
from takt.checks.series import quantity, words
from takt.engine import read_machine
from takt.errors import ConfigError, TaktError
from takt.figures import COUNTS
from takt.kinematics import Kinematics, pose_to_matrix
from takt.names import shown
from takt.recording import Array
from takt.scene import link_poses, make_scene
from takt.style import PALETTE, STATES, USUAL_FIELDS, is_set_point
from takt.tables import KINDS, PREFIXES, components_of, unit_of, units_of
from takt.track_layout import TrackLayout
from takt.view.layout import Layout
from takt.view.shapes import track as shape_of
from takt.view.status import LIVE

CAM_POINTS = 400
MOST_JOINTS = 4000
MOST_KNOTS = 60  # largest number of knots of an editable cam
MOST_PIECES = 9  # at least the number of pieces of any law
SLOPE_STEP = 1e-6  # relative to the largest slope: tolerance for rounding
TRACK_STEP = 10.0  # mm


@dataclass(frozen=True)
class Source:
    """A component and the channel of its messages."""

    index: int
    name: str
    kind: str
    layout: Layout
    parameters: Mapping[str, Any]

    @property
    def channel(self) -> str:
        return PREFIXES[self.kind] + self.name


class Machine:
    """The machine that an engine describes. Raises ConfigError if this package cannot read it.

    folder: base of the files that the text names; None: no file is opened. file: a machine file on this host; if its
    content is the same, the meshes that it names are drawn."""

    def __init__(self, message: msgs.machine_description, folder: Path | None = None, file: Path | None = None) -> None:
        self.run_id = message.run_id
        self.name = message.name
        self.version = message.version
        self.period_s = message.period_s
        self.text = message.text
        self.folder = folder or Path()
        self._drawn_from = (self.text, folder)
        self.parameters: dict[str, Any] = json.loads(
            _core.load_machine(self.text.encode(), shown(self.folder / "machine"), files=folder is not None)
        )
        if file is not None and folder is None and self.parameters == _loaded(file):
            self._drawn_from = (file.read_text(encoding="utf-8"), file.parent)
        self.sources = [
            Source(i, name, kind.name, Layout(kind.name, name), parameters)
            for i, (name, (kind, parameters)) in enumerate(components_of(self.parameters).items())
        ]
        self.by_name = {source.name: source for source in self.sources}
        self.names = {kind: [s.name for s in self.sources if s.kind == kind] for kind in KINDS}
        self.mechanisms = self._mechanisms()

    def describe(self) -> dict[str, Any]:
        """Returns all constant properties of the machine, for the page."""
        used = [kind for kind in KINDS.values() if self.names[kind.name]]
        about = {kind.name: {f: text for f, _, text, _ in _core.output_fields(kind.name)} for kind in used}
        return {
            "run": str(self.run_id),
            "name": self.name,
            "version": self.version,
            "period_s": self.period_s,
            "counts": [[name, *said] for name, said in COUNTS.items()],
            "commands": self.parameters["view"]["commands"],
            "dead_man_s": self.parameters["lcm"]["dead_man_s"],
            "kinds": {
                kind.name: {
                    "live": LIVE.get(kind.name, ()),
                    "fields": [
                        {
                            "name": field,
                            "label": words(field),
                            "unit": kind.units[field],
                            "about": about[kind.name][field],
                            "names": {str(v): n for v, n in kind.names.get(field, {}).items()} or None,
                            "flag": kind.dtypes[field] == np.bool_,
                            "whole": np.issubdtype(kind.dtypes[field], np.integer),
                            "set": is_set_point(field),
                            "quantity": quantity(field),
                        }
                        for field in kind.units
                    ],
                }
                for kind in used
            },
            "components": [self._component(source) for source in self.sources],
            "usual": USUAL_FIELDS,
            "palette": PALETTE,
            "states": STATES,
            "plan": self._plan(),
            "scene": self.scene,
            "cams": self._cams(),
        }

    def _component(self, source: Source) -> dict[str, Any]:
        own = units_of(self.parameters, KINDS[source.kind], source.parameters)
        shown: dict[str, Any] = {"name": source.name, "kind": source.kind}
        shown["units"] = {unit: unit_of(source.kind, field, own) for field, unit in KINDS[source.kind].units.items()}
        if source.parameters.get("kind") == "rotary":
            shown["modulus"] = source.parameters["modulus"]
        if source.kind == "group":
            shown["axes"] = len(source.parameters["axes"])
            shown["tool"] = any((source.parameters.get("kinematics") or {}).values())
        limits = source.parameters.get("limits", {}) if source.kind == "axis" else {}
        if limits:
            shown["velocity"] = limits["velocity"]
        if "lower" in limits and "upper" in limits:
            shown["range"] = [limits["lower"], limits["upper"]]
        return shown

    # --- plan view ---

    def _plan(self) -> dict[str, Any]:
        of = self.parameters
        return {
            "systems": [system["name"] for system in of["coordinate_systems"]],
            "tracks": self._tracks(),
            "stators": [[place["x"], place["y"]] for e in of["environments"] for place in e["stators"]],
            "parts": [self._part(part) for part in of["parts"]],
            "movers": [{k: m[k] for k in ("name", "width", "height", "gap")} for m in of["movers"]],
            "belts": [
                {
                    "name": belt["name"],
                    "turning": belt["kind"] == "turning",
                    "frame": np.asarray(pose_to_matrix(_pose(belt["origin"])))[:3].ravel().tolist(),
                    "range": [belt.get("lower_limit"), belt.get("upper_limit")],
                }
                for belt in of["belts"]
            ],
            "groups": [
                {"name": name, "links": mechanism.links, "base": base[:3].ravel().tolist()}
                for name, (mechanism, _, base) in self.mechanisms.items()
            ],
        }

    def _tracks(self) -> list[dict[str, Any]]:
        """Returns the tracks whose geometry is in the machine file; the engine reports later changes by commands."""
        try:
            tracks = TrackLayout(self.text).tracks if self.parameters["tracks"] else ()
        except (TaktError, ConfigError):
            return []
        shown = []
        part_of = {track["name"]: track["part"] for track in self.parameters["tracks"]}
        only = self.names["part"][0] if len(self.names["part"]) == 1 else ""
        at = {part["name"]: self._initial(part) for part in self.parameters["parts"]}
        for track in tracks:
            if track.length > 0:
                points = track.points
                thin = _thin(np.asarray(points.s))
                part = part_of[track.name] or only
                line = np.stack([points.s, points.x, points.y], axis=1)[thin] - [0.0, *at.get(part, (0.0, 0.0))]
                shown.append(shape_of(track.name, part, track.closed, line))
        return shown

    def _part(self, part: Mapping[str, Any]) -> dict[str, Any]:
        stators = [[place["x"], place["y"]] for place in part.get("stators") or ()]
        stators = stators or [
            [240.0 * column, 240.0 * row]
            for row in range(int(part.get("rows") or 0))
            for column in range(int(part.get("columns") or 0))
        ]
        return {"name": part["name"], "stators": stators}

    @staticmethod
    def _initial(part: Mapping[str, Any]) -> tuple[float, float]:
        initial = part["positions"][part["initial_position"] - 1]
        return initial["x"], initial["y"]

    # --- cams ---

    def _cams(self) -> list[dict[str, Any]]:
        if not self.parameters["cams"]:
            return []
        try:
            tables = _core.cams_of_machine(self.text.encode(), shown(self.folder / "machine"))
        except ConfigError:
            return []
        return [drawn(table) for table, _ in tables]

    # --- arms ---

    def _mechanisms(self) -> dict[str, tuple[Kinematics, list[str], Array]]:
        """Returns, for each group with kinematics: its kinematics, its axes, and the pose of its base as a matrix."""
        found = {}
        for group in self.parameters["groups"]:
            given = {name: value for name, value in (group.get("kinematics") or {}).items() if value}
            if not given:
                continue
            mechanism = Kinematics(folder=self.folder, **given)
            found[group["name"]] = (mechanism, list(group["axes"]), np.asarray(pose_to_matrix(_pose(group["base"]))))
        return found

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The machine in three dimensions (`takt.scene`)."""
        return make_scene(self.parameters, self.mechanisms, *self._drawn_from)

    def link_poses(self, group: str, joints: Array) -> Array:
        """Returns the poses (n, links, 7) of the links of a group in the world frame, for rows of positions of its
        axes."""
        mechanism, _, base = self.mechanisms[group]
        return link_poses(mechanism, base, joints[:, : mechanism.axes])


def _loaded(file: Path) -> Any:
    """Returns the content of a machine file; None if it cannot be read."""
    try:
        return json.loads(_core.load_machine(*read_machine(file)))
    except (ConfigError, OSError):
        return None


def drawn(table: Any) -> dict[str, Any]:
    """Returns a cam as the page draws it: position, velocity, acceleration and jerk. If there are very many joints,
    only some are sampled."""
    joints = table.joints[:: 1 + len(table.joints) // MOST_JOINTS]
    x = np.unique(np.concatenate([np.linspace(table.begin, table.end, CAM_POINTS), joints]))
    return {
        "name": table.name,
        "units": [table.x_unit, table.y_unit],
        "cyclic": table.cyclic,
        "x": _finite(x),
        "curves": [_finite(curve) for curve in table.at(x)],
        "knots": _knots(table),
    }


def _knots(table: Any) -> list[list[float]] | None:
    """Returns the points at which the page lets a cam be dragged: [x, y, y', y''] at each point, or at both ends of
    each segment, not where pieces of one law meet. None if there are too many, or the slope has steps, as with straight
    lines between points."""
    if len(table.joints) > MOST_PIECES * MOST_KNOTS:
        return None
    source = json.loads(table.source) if isinstance(table.source, str) else table.source
    ends = [point["x"] for point in source.get("points") or []]
    ends += [segment["to"]["x"] for segment in source.get("segments") or []]
    x = np.unique([table.begin, *ends])
    if len(x) > MOST_KNOTS:
        return None
    y, v, a, _ = (values.copy() for values in table.at(x))
    if table.cyclic:  # both ends are one point of the cycle
        v[-1], a[-1] = v[0], a[0]
    left = table.at(np.nextafter(x, -np.inf))[1]
    if np.abs(left - v).max() > SLOPE_STEP * (1 + np.abs(v).max()):
        return None
    return [[float(one) for one in knot] for knot in zip(x, y, v, a, strict=True)]


def _pose(pose: Mapping[str, float]) -> list[float]:
    return [float(pose[axis]) for axis in "xyzabc"]


def _finite(values: Array) -> list[float | None]:
    return [float(f"{v:.9g}") if math.isfinite(v) else None for v in values]


def _thin(s: Array) -> Array:
    """Returns which points of a line are far enough from the previous ones; always the last one."""
    steps = np.floor(s / TRACK_STEP)
    kept = np.concatenate(([True], np.diff(steps) > 0))
    kept[-1] = True
    return kept
