"""Tool paths, from G-code or SVG, for a group's `move_path`.

    path = toolpath.read("drawing.gcode")
    path.length, path.extents                   # mm
    path.to_csv("drawing.csv")                  # the `file` of a path in a machine file

Paths consist of lines and arcs, in [mm] and [mm/s]; other curves of a file (helices, ellipses, Béziers) are
approximated by lines within a tolerance.
"""

from __future__ import annotations

import csv
import functools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from takt.csv_rows import read_rows
from takt.errors import TaktError, shortened
from takt.written import written

if TYPE_CHECKING:
    from takt.gcode import Options

Array = npt.NDArray[np.float64]
Point = tuple[float, float, float]

SAME = 1e-6  # mm: points closer than this are the same, as in the engine
SLACK = 2.0  # mm: distance beside, before or behind a path within which points follow it
TOLERANCE = 0.005  # mm between a curve and its approximation by lines
REACH = 1e8  # mm: largest coordinates accepted, so that their rounding errors stay below SAME
MOST_ELEMENTS = 1_000_000  # of a path read from a file
COLUMNS = ("shape", "x", "y", "z", "via_x", "via_y", "via_z", "velocity")
GCODE = (".gcode", ".nc", ".ngc", ".tap")
_BLOCK = 64  # points processed together in `follow`
_HOPELESS = (
    10 * SLACK
)  # mm by which the cost of an assignment of points to a path may exceed the least and still become the least


class ToolpathError(TaktError, ValueError):
    """A file does not describe a tool path; the text says where and why."""


@dataclass(frozen=True, slots=True)
class Element:
    """A line to `end`, or an arc through `via` to `end`, from the end of the previous element."""

    end: Point  # mm
    via: Point | None = None
    velocity: float | None = None  # mm/s; None: that of the command, "as fast as possible"


class Followed(NamedTuple):
    """Points projected onto a path."""

    distance: Array  # mm, from the path
    position: Array  # arc length [mm] of the projection on the path


class _Geometry(NamedTuple):
    """One row per element. For a line, the centre is its beginning and u its direction."""

    begin: Array
    is_arc: npt.NDArray[np.bool_]
    centre: Array
    u: Array  # unit vectors: from the centre to the beginning ...
    w: Array  # ... and the direction of the arc at its beginning
    radius: Array
    length: Array
    at: Array  # arc length [mm] at which it begins; one more row for the end of the path


@dataclass(frozen=True)
class Toolpath:
    """A path of lines and arcs from `start`."""

    start: Point
    elements: tuple[Element, ...]
    left_out: tuple[str, ...] = ()  # ignored contents of the file, a sentence each
    read_as: str = ""  # the dialect of G-code, and how it was recognised

    @classmethod
    def from_csv(cls, path: str | PathLike[str], start: Point = (0.0, 0.0, 0.0)) -> Toolpath:
        """Returns the path in a CSV file, the `file` of a path in a machine file. Raises ToolpathError."""
        head, rows = read_rows(path, ToolpathError)
        if not {"x", "y", "z"} <= set(head) <= set(COLUMNS):
            raise ToolpathError(f"{path}:1: expected the columns x, y, z and perhaps {', '.join(COLUMNS)}")
        elements = [_element_of(row, f"{path}:{line}") for line, row in rows]
        return cls(start, tuple(elements))._checked(str(path))

    def _repr_png_(self) -> bytes:
        from takt import plot, toolpath_picture

        return plot.png(toolpath_picture.draw(self))

    @property
    def length(self) -> float:
        """Length of the path [mm]."""
        return float(self._geometry.at[-1])

    @property
    def end(self) -> Point:
        """The end point [mm]."""
        return self.elements[-1].end if self.elements else self.start

    @property
    def extents(self) -> Array:
        """The least and the greatest X, Y, Z [mm] on the path, shape (2, 3)."""
        g = self._geometry
        points = [np.array([self.start]), *([_ends(self.elements)] if self.elements else [])]
        u, w, radius = g.u[g.is_arc], g.w[g.is_arc], g.radius[g.is_arc, np.newaxis]
        sweep = g.length[g.is_arc, np.newaxis] / radius
        for turn in (0.0, math.pi):  # where an arc is perpendicular to a coordinate axis
            angle = np.mod(np.arctan2(w, u) + turn, 2 * math.pi)
            there = g.centre[g.is_arc] + radius * (u * np.cos(angle) + w * np.sin(angle))
            points.append(np.where(angle <= sweep, there, g.begin[g.is_arc]))
        every = np.concatenate(points)
        return np.array([every.min(axis=0), every.max(axis=0)])

    @property
    def is_arc(self) -> npt.NDArray[np.bool_]:
        """Whether each element is an arc, shape (n,)."""
        return self._geometry.is_arc

    @property
    def at(self) -> Array:
        """Arc lengths [mm] at which each element begins, and at which the last one ends, shape (n + 1,)."""
        return self._geometry.at

    def points(self, step: float) -> tuple[Array, Array]:
        """Returns points on the path [mm], shape (m, 3), and their arc lengths [mm], shape (m,). The points include the
        ends of all elements and are at most `step` [mm] apart. Raises ValueError unless `step` is above 0."""
        if not step > 0:
            raise ValueError(f"step is a number of mm above 0, not {step}")
        g = self._geometry
        counts = np.maximum(np.ceil(g.length / step), 1).astype(np.int64)
        which = np.repeat(np.arange(len(counts)), counts)
        shares = (np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts) + 1) / counts[which]
        ways = shares * g.length[which]
        places = np.concatenate([np.array([self.start]), self._places(which, ways)])
        return places, np.concatenate([[0.0], g.at[which] + ways])

    def follow(self, points: npt.ArrayLike, slack: float = SLACK, time_s: npt.ArrayLike | None = None) -> Followed:
        """Projects a sequence of points, traversed in order from the start, onto the path.

        The arc length from one projection to the next hardly exceeds the distance of the two points. So a path may
        cross itself or return over itself, and points that skip a loop are not mistaken for points that follow it.

        points: [mm], shape (m, 3).
        slack: distance [mm] that points may be beside the path, or before or behind on it.
        time_s: times of the points [s], increasing, shape (m,). Where samples are missing, the path between two points
            may be longer than their distance, up to the greatest speed elsewhere (99 % quantile). None: none are
            missing.

        Raises ValueError for arrays of other shapes, ToolpathError if the path has no elements.
        """
        rows = np.asarray(points, float)
        if rows.ndim != 2 or rows.shape[1] != 3:
            raise ValueError(f"expected rows of 3 numbers, found an array of shape {rows.shape}")
        if not self.elements:
            raise ToolpathError("a path without elements cannot be followed")
        way = np.concatenate([[0.0], np.linalg.norm(np.diff(rows, axis=0), axis=1)])[: len(rows)]
        most = way if time_s is None else _most(way, np.asarray(time_s, float))
        found = self._follow_quickly(rows, most, slack)
        if not len(rows) or not np.all(np.isfinite(rows)):
            return found
        # A right result can be recognised: it leads along the path, to its end if the points end there.
        lost = np.max(found.distance) > slack
        behind = self.length - found.position[-1] > 2 * np.linalg.norm(rows[-1] - self.end) + 1e-6
        gone = np.diff(found.position)
        if lost or behind or np.any((gone < -slack) | (gone > most[1:] + slack)):
            sure = self._follow_surely(rows, way, most, slack)
            if not lost or np.max(sure.distance) <= np.max(found.distance):
                return sure
        return found

    def _follow_quickly(self, rows: Array, most: Array, slack: float) -> Followed:
        """Projects blocks of points to the nearest positions within reach of a whole block. Where a path returns over
        itself, or crosses itself in a gap of the points, these may be on the wrong part of it."""
        distance, position = np.empty(len(rows)), np.empty(len(rows))
        here = 0.0
        for first in range(0, len(rows), _BLOCK):
            block = slice(first, min(first + _BLOCK, len(rows)))
            part = self._between(here - slack, here + float(np.sum(most[block])) + slack)
            away, ways = self._distances(rows[block], part)
            nearest = np.argmin(away, axis=1)
            row = np.arange(len(nearest))
            distance[block] = away[row, nearest]
            position[block] = self.at[part.start + nearest] + ways[row, nearest]
            here = float(position[block][-1])
        return Followed(distance, position)

    def _follow_surely(self, rows: Array, way: Array, most: Array, slack: float) -> Followed:
        """Returns the assignment of least cost of the points to the path in order (Viterbi's algorithm over the nearest
        position on each element within reach). The cost [mm] is the distance of the points from the path plus the
        difference between the arc length and the distance of the points."""
        places, costs, steps = np.zeros(1), np.zeros(1), []
        first, known = 0, slice(0, 0)  # first point and elements of the block of known distances
        for i, point in enumerate(rows):
            low, high = float(np.min(places)) - slack, float(np.max(places)) + float(most[i]) + slack
            part = self._between(low, high)
            if i == first + _BLOCK or part.start < known.start or part.stop > known.stop:
                first, ahead = i, float(np.sum(most[i : i + _BLOCK]))
                known = self._between(low - slack, high + ahead + slack)
                aways, ways = self._distances(rows[i : i + _BLOCK], known)
                wheres = self.at[known] + ways
            these = slice(part.start - known.start, part.stop - known.start)
            away, where = aways[i - first, these], wheres[i - first, these]
            near = np.flatnonzero(away <= np.min(away) + slack)
            stay = places[np.argmin(costs)]  # always possible, for any distance of the point
            there = np.append(where[near], stay)
            beside = np.append(away[near], np.linalg.norm(point - self._place(stay)))
            gone = there - places[:, np.newaxis]
            unlike = np.maximum(np.maximum(way[i] - gone, gone - most[i]), 0.0)
            unlike[(gone < -slack) | (gone > most[i] + slack)] = np.inf
            total = costs[:, np.newaxis] + unlike
            before = np.argmin(total, axis=0)
            cost = total[before, np.arange(len(there))] + beside
            good = np.flatnonzero(cost <= np.min(cost) + _HOPELESS)
            places, costs = there[good], cost[good]
            steps.append((places, beside[good], before[good]))
        best = int(np.argmin(costs + 1e-3 * np.abs(self.length - places)))  # of equals, the one nearest to the end
        distance, position = np.empty(len(rows)), np.empty(len(rows))
        for i in range(len(rows) - 1, -1, -1):
            places, beside, before = steps[i]
            distance[i], position[i], best = beside[best], places[best], before[best]
        return Followed(distance, position)

    def _between(self, low: float, high: float) -> slice:
        """Returns the elements that overlap this range of arc lengths [mm]."""
        begin = max(int(np.searchsorted(self.at, low, "right")) - 1, 0)
        begin = min(begin, len(self.elements) - 1)
        return slice(begin, max(min(int(np.searchsorted(self.at, high)), len(self.elements)), begin + 1))

    def _place(self, way: float) -> Array:
        """Returns the point at arc length `way` [mm]."""
        part = self._between(way, way)
        return np.asarray(self._places(np.array([part.start]), np.array([way - self.at[part.start]]))[0])

    def shifted(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Toolpath:
        """Returns the path translated by x, y, z [mm]."""

        def move(point: Point) -> Point:
            return (point[0] + x, point[1] + y, point[2] + z)

        elements = tuple(
            Element(move(one.end), None if one.via is None else move(one.via), one.velocity) for one in self.elements
        )
        return Toolpath(move(self.start), elements, self.left_out, self.read_as)

    def to_csv(self, path: str | PathLike[str]) -> Path:
        """Writes the elements as the `file` of a path in a machine file. Returns the path of the file, which does not
        contain the start of the tool path."""
        target = Path(path)
        with written(target) as beside, beside.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            for one in self.elements:
                via = [_text(value) for value in one.via] if one.via else ["", "", ""]
                velocity = "" if one.velocity is None else _text(one.velocity)
                shape = "arc" if one.via else "line"
                writer.writerow([shape, *(_text(value) for value in one.end), *via, velocity])
        return target

    def to_elements(self) -> list[dict[str, Any]]:
        """Returns the elements in the form of the `elements` of a path in a machine file."""
        elements = []
        for one in self.elements:
            element: dict[str, Any] = {"shape": "arc" if one.via else "line"}
            element["to"] = dict(zip("xyz", one.end, strict=True))
            if one.via:
                element |= dict(zip(("via_x", "via_y", "via_z"), one.via, strict=True))
            if one.velocity is not None:
                element["velocity"] = one.velocity
            elements.append(element)
        return elements

    @functools.cached_property
    def _geometry(self) -> _Geometry:
        if not self.elements:
            no, nothing = np.empty((0, 3)), np.empty(0)
            return _Geometry(no, np.empty(0, bool), no, no, no, nothing, nothing, np.zeros(1))
        ends = _ends(self.elements)
        begin = np.concatenate([[self.start], ends[:-1]])
        is_arc = np.array([one.via is not None for one in self.elements])
        chord = ends - begin
        length = np.linalg.norm(chord, axis=1)
        centre, w, radius = begin.copy(), np.zeros_like(begin), np.zeros(len(begin))
        u = np.divide(chord, length[:, np.newaxis], out=np.zeros_like(chord), where=length[:, np.newaxis] > 0)
        if np.any(is_arc):
            via = np.array([one.via for one in self.elements if one.via is not None])
            arc = _arcs(begin[is_arc], via, ends[is_arc])
            centre[is_arc], u[is_arc], w[is_arc], radius[is_arc], length[is_arc] = arc
        return _Geometry(begin, is_arc, centre, u, w, radius, length, np.concatenate([[0.0], np.cumsum(length)]))

    def _places(self, which: npt.NDArray[np.int64], ways: Array) -> Array:
        """Returns the points at arc lengths `ways` [mm] from the beginnings of the elements `which`."""
        g = self._geometry
        arc = g.is_arc[which, np.newaxis]
        angle = np.divide(ways, g.radius[which], out=np.zeros_like(ways), where=g.is_arc[which])[:, np.newaxis]
        radius = g.radius[which, np.newaxis]
        along = np.where(arc, radius * np.cos(angle), ways[:, np.newaxis])
        return np.asarray(g.centre[which] + along * g.u[which] + radius * np.sin(angle) * g.w[which])

    def _distances(self, points: Array, part: slice) -> tuple[Array, Array]:
        """Returns the distance of each of m points from each of the k elements of a part of the path, and the arc
        length of the closest point from the beginning of the element, shape (m, k) each."""
        g = self._geometry
        out = points[:, np.newaxis, :] - g.centre[part]
        along = np.einsum("mkc,kc->mk", out, g.u[part])
        across = np.einsum("mkc,kc->mk", out, g.w[part])
        arc, radius, length = g.is_arc[part], g.radius[part], g.length[part]
        sweep = np.divide(length, radius, out=np.ones_like(length), where=arc)
        # Beyond an arc's ends the nearer one counts: angles are taken from the middle of the arc.
        middle = sweep / 2
        turned = np.mod(np.arctan2(across, along) - middle + math.pi, 2 * math.pi) - math.pi
        ways = np.where(arc, radius * (np.clip(turned, -middle, middle) + middle), np.clip(along, 0, length))
        which = np.broadcast_to(np.arange(len(self.elements))[part], ways.shape)
        there = self._places(which.ravel(), ways.ravel()).reshape(out.shape)
        return np.linalg.norm(points[:, np.newaxis, :] - there, axis=2), ways

    def _checked(self, source: str) -> Toolpath:
        """Returns itself. Raises ToolpathError if an arc is degenerate or an element has no length."""
        g = self._geometry
        for wrong, why in ((~np.isfinite(g.length), "the three points of an arc lie on a line"),
                           (~(g.length >= SAME), "has no length")):  # fmt: skip
            if np.any(wrong):
                raise ToolpathError(f"{source}: element {int(np.argmax(wrong)) + 1}: {why}")
        return self


def read(
    path: str | PathLike[str],
    start: Point = (0.0, 0.0, 0.0),
    tolerance: float = TOLERANCE,
    gcode: Options | None = None,
) -> Toolpath:
    """Reads G-code (.gcode, .nc, .ngc, .tap), a drawing (.svg) or elements (.csv). Returns the path.

    start: initial position of the tool [mm].
    tolerance: largest distance [mm] between curves and their approximation by lines.
    gcode: how to read G-code (takt.gcode.Options); None: recognised from its content.

    Raises ToolpathError."""
    suffix = Path(path).suffix.lower()
    if suffix in GCODE:
        from takt.gcode import read_gcode

        return read_gcode(path, start, tolerance, gcode)
    if gcode is not None and suffix in (".svg", ".csv"):
        raise ToolpathError(f"{path}: options of G-code do not hold for {suffix}")
    if suffix == ".svg":
        from takt.svg import read_svg

        return read_svg(path, start, tolerance)
    if suffix == ".csv":
        return Toolpath.from_csv(path, start)
    raise ToolpathError(f"{path}: expected a file of G-code ({', '.join(GCODE)}), .svg or .csv")


def _most(way: Array, time_s: Array) -> Array:
    """Returns the largest arc length that may lie between each point and the one before, from their distances (the
    first is 0) and times."""
    if time_s.shape != way.shape or not np.all(np.isfinite(time_s)) or not np.all(np.diff(time_s) > 0):
        raise ValueError(f"time_s: expected {len(way)} rising numbers, one for each point")
    if len(way) < 2:
        return way
    took = np.diff(time_s)
    usual = took <= 1.5 * np.median(took)
    fastest = np.quantile(way[1:][usual] / took[usual], 0.99)
    return np.concatenate([[0.0], np.where(usual, way[1:], np.maximum(way[1:], fastest * took))])


def split_turn(sweep: float) -> int:
    """Returns the number of equal arcs into which an arc of `sweep` [rad] is split, so that none is more than half a
    turn and three points define each of them."""
    return max(math.ceil(abs(sweep) / math.pi - 1e-9), 1)


def chords(sweep: float, radius: float, tolerance: float) -> int:
    """Returns the number of chords that approximate an arc of `sweep` [rad] within a tolerance."""
    if radius <= tolerance:
        return max(math.ceil(abs(sweep) / 1.0), 1)
    return max(math.ceil(abs(sweep) / (2 * math.acos(1 - tolerance / radius))), 1)


def chords_of_bezier(control: Sequence[complex], tolerance: float) -> int:
    """Returns the number of chords, equal in parameter, that approximate a Bézier curve within a tolerance. The error
    of a chord over a parameter interval h is at most h² / 8 times the second derivative, which is bounded by the second
    differences of the control points."""
    n = len(control) - 1
    second = max(abs(control[i + 2] - 2 * control[i + 1] + control[i]) for i in range(n - 1)) * n * (n - 1)
    return max(math.ceil(math.sqrt(second / (8 * tolerance))), 1)


def _arcs(begin: Array, via: Array, end: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Returns centre, u, w, radius and length of arcs through three points each; NaN if they lie on a line."""
    a, b = via - begin, end - begin
    normal = np.cross(a, b)
    square = np.einsum("nc,nc->n", normal, normal)
    reach = np.einsum("nc,nc->n", a, a) * np.einsum("nc,nc->n", b, b)
    square = np.where(square > 1e-20 * reach, square, np.nan)[:, np.newaxis]
    squares_a = np.einsum("nc,nc->n", a, a)[:, np.newaxis]
    squares_b = np.einsum("nc,nc->n", b, b)[:, np.newaxis]
    to_centre = np.cross(squares_a * b - squares_b * a, normal) / (2 * square)
    centre = begin + to_centre
    radius = np.linalg.norm(to_centre, axis=1)
    u = -to_centre / radius[:, np.newaxis]
    w = np.cross(normal / np.sqrt(square), u)
    out = end - centre
    sweep = np.mod(np.arctan2(np.einsum("nc,nc->n", out, w), np.einsum("nc,nc->n", out, u)), 2 * math.pi)
    return centre, u, w, radius, radius * sweep


def _ends(elements: Sequence[Element]) -> Array:
    return np.array([one.end for one in elements])


def _text(value: float) -> str:
    return f"{value:.10g}"


def _element_of(row: dict[str, str | None], place: str) -> Element:
    def numbers(names: Iterable[str]) -> list[float]:
        values = []
        for name in names:
            try:
                values.append(float(row.get(name) or ""))
            except ValueError:
                values.append(math.nan)
            if not math.isfinite(values[-1]):
                raise ToolpathError(f"{place}: {name}: expected a number, found '{shortened(row.get(name) or '')}'")
        return values

    shape = row.get("shape") or "line"
    if shape not in ("line", "arc"):
        raise ToolpathError(f"{place}: shape: expected line or arc, found '{shortened(shape)}'")
    x, y, z = numbers("xyz")
    via: Point | None = None
    if shape == "arc":
        via_x, via_y, via_z = numbers(("via_x", "via_y", "via_z"))
        via = (via_x, via_y, via_z)
    velocity = numbers(["velocity"])[0] if row.get("velocity") else None
    return Element((x, y, z), via, velocity)
