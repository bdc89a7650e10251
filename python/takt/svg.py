"""Reads drawings (SVG) as tool paths, as for a pen.

X points to the right and Y up from the drawing's lower left corner, in [mm]; the pen draws at Z 0 and is lifted between
lines. Circular arcs stay arcs; ellipses and Béziers are approximated by lines within a tolerance. The outlines of all
shapes that a browser shows are drawn, whether stroked or filled; texts and pictures are left out, and reported. Needs
svgelements (pip install svgelements).

`svg_tree` finds the rendered shapes, each with its matrix; svgelements splits their outlines into segments.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from takt.svg_tree import Clip, Rendered, Shape
from takt.svg_values import IDENTITY, PX, Matrix, TreeError, inverse, product
from takt.toolpath import (
    MOST_ELEMENTS,
    REACH,
    SAME,
    TOLERANCE,
    Element,
    Point,
    Toolpath,
    ToolpathError,
    chords,
    chords_of_bezier,
    split_turn,
)

LIFT = 5.0  # mm
MOST_BYTES = 200_000_000
_MM = 1 / PX  # of a pixel
_CUT = 0.01  # mm by which a shape may exceed its clip and still counts as inside


def read_svg(
    path: str | PathLike[str],
    start: Point = (0.0, 0.0, 0.0),
    tolerance: float = TOLERANCE,
    *,
    lift: float = LIFT,
    velocity: float | None = None,
    sources: list[str] | None = None,
) -> Toolpath:
    """Returns the path of a drawing.

    start: initial position of the tool [mm].
    tolerance: largest distance [mm] between curves and their approximation by lines.
    lift: height [mm] of the pen between lines.
    velocity: of drawing [mm/s]; None: that of the command.
    sources: receives, for each element, the name of the shape that it draws or moves to.

    Raises ToolpathError.
    """
    try:
        import svgelements  # type: ignore[import-untyped]
    except ImportError:
        raise ToolpathError(f"{path}: SVG needs svgelements (pip install svgelements)") from None
    with Path(path).open("rb") as file:
        data = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise ToolpathError(f"{path}: is larger than {MOST_BYTES:,} bytes")
    try:
        tree = Rendered(ElementTree.fromstring(data))
        left_out = tree.left_out
        if re.search(rb"<\?xml-stylesheet\b", data[:10_000]):
            left_out["a style sheet in another file"] += 1
        if not 0 <= tree.height * _MM <= REACH:
            raise TreeError(f"a height of {tree.height * _MM:.6g} mm: expected numbers up to {REACH:.0e} mm")
        pen = _Pen(start, tree.height * _MM, tolerance, lift, velocity)
        for shape in tree.shapes:
            _draw(svgelements, shape, pen)
        pen.up()
    except ElementTree.ParseError as error:
        raise ToolpathError(f"{path}: is no SVG: {error}") from None
    except TreeError as error:
        raise ToolpathError(f"{path}: {error}") from None
    said = tuple(what if count == 1 else f"{what} ({count} times)" for what, count in left_out.items())
    if not pen.elements:
        besides = f"; left out: {', '.join(said)}" if said else ""
        raise ToolpathError(f"{path}: no outlines are drawn in it{besides}")
    if sources is not None:
        sources[:] = pen.sources
    return Toolpath(start, tuple(pen.elements), said)._checked(str(path))


def _draw(svgelements: Any, shape: Shape, pen: _Pen) -> None:
    outline = _Outline(svgelements, shape)
    for clip in shape.clips:
        _hold_against(svgelements, clip, outline)
    pen.source = shape.label
    for segment in outline.segments:
        pen.draw(segment, type(segment).__name__, shape.matrix)


class _Outline:
    def __init__(self, svgelements: Any, shape: Shape) -> None:
        self.shape = shape
        n = shape.numbers
        try:
            if shape.tag == "path":
                self.segments = list(svgelements.Path(shape.data))
                return
            if shape.tag == "rect":
                made = svgelements.Rect(n["x"], n["y"], n["width"], n["height"], n.get("rx", 0.0), n.get("ry", 0.0))
            elif shape.tag == "circle":
                made = svgelements.Circle(n["cx"], n["cy"], n["r"])
            elif shape.tag == "ellipse":
                made = svgelements.Ellipse(n["cx"], n["cy"], n["rx"], n["ry"])
            elif shape.tag == "line":
                made = svgelements.SimpleLine(n["x1"], n["y1"], n["x2"], n["y2"])
            else:
                kind = svgelements.Polygon if shape.tag == "polygon" else svgelements.Polyline
                made = kind(*((point.real, point.imag) for point in shape.points))
            self.segments = list(made.segments(transformed=False))
        except Exception as error:  # svgelements raises many kinds of errors on bad data
            raise TreeError(f"{shape.label} cannot be read: {error}") from None

    def box(self, svgelements: Any, matrix: Matrix) -> tuple[float, float, float, float] | None:
        """Returns the bounding box of the transformed outline (least X, Y, greatest X, Y); None if it is empty."""
        box = abs(svgelements.Path(*self.segments) * svgelements.Matrix(*matrix)).bbox()
        if box is None:
            return None
        left, top, right, bottom = map(float, box)
        return (left, top, right, bottom)


def _hold_against(svgelements: Any, clip: Clip, outline: _Outline) -> None:
    """Raises TreeError if a clip may cut off part of a shape or hide it; only rectangular clips can be checked, in the
    coordinates of the rectangle."""
    matrix = clip.shapes[0].matrix if len(clip.shapes) == 1 else clip.matrix
    into = inverse(matrix)
    box = None if into is None else outline.box(svgelements, product(into, outline.shape.matrix))
    if box is None:
        return
    if len(clip.shapes) == 1:
        frame = _Outline(svgelements, clip.shapes[0])
        around = frame.box(svgelements, IDENTITY)
        if around is not None and _is_rectangle(frame):
            slack = _CUT / _MM / _stretch(matrix)[0]
            low = box[0] >= around[0] - slack and box[1] >= around[1] - slack
            if low and box[2] <= around[2] + slack and box[3] <= around[3] + slack:
                return
    raise TreeError(
        f"{clip.what} would cut {outline.shape.label}, and outlines are drawn whole;"
        " cut them in the drawing program first"
    )


def _is_rectangle(outline: _Outline) -> bool:
    """Returns whether the outline is a rectangle with sides along X and Y."""
    ends = []
    for segment in outline.segments:
        if type(segment).__name__ not in ("Move", "Line", "Close"):
            return False
        if segment.end is not None:
            ends.append(_moved(IDENTITY, segment.end))
    if len(ends) > 1 and abs(ends[0] - ends[-1]) < 1e-9:
        ends.pop()
    if len(ends) != 4:
        return False
    sides = [ends[i] - ends[i - 1] for i in range(4)]
    flat = all(min(abs(side.real), abs(side.imag)) <= 1e-6 * abs(side) for side in sides)
    return flat and abs(sides[0] + sides[2]) <= 1e-6 * abs(sides[0])


def _moved(matrix: tuple[float, ...], point: Any) -> complex:
    a, b, c, d, e, f = matrix
    if point.x is None or point.y is None:
        raise TreeError("a shape has a point without coordinates")
    x, y = float(point.x), float(point.y)
    return complex(a * x + c * y + e, b * x + d * y + f)


def _stretch(matrix: tuple[float, ...]) -> tuple[float, bool]:
    """Returns the largest scale factor of a matrix, and whether it is the same in all directions (a similarity)."""
    a, b, c, d = matrix[:4]
    mean, apart = (a * a + b * b + c * c + d * d) / 2, math.hypot((a * a + b * b - c * c - d * d) / 2, a * c + b * d)
    return math.sqrt(mean + apart), apart <= 1e-9 * mean


class _Pen:
    def __init__(self, start: Point, height: float, tolerance: float, lift: float, velocity: float | None) -> None:
        self.elements: list[Element] = []
        self.source, self.sources = "", list[str]()  # the current shape, and that of each element
        self._here = start
        self._height, self._tolerance, self._lift, self._velocity = height, tolerance, lift, velocity
        self._matrix: tuple[float, ...] = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)

    def up(self) -> None:
        if self.elements:
            self._to((self._here[0], self._here[1], self._lift), None)

    def draw(self, segment: Any, kind: str, matrix: tuple[float, ...]) -> None:
        """Draws a segment of an outline. `matrix`: from its coordinates to those of the drawing (px)."""
        if kind == "Move" or segment.start is None or segment.end is None:
            return
        self._matrix = matrix
        begin = self._place(segment.start)
        end = self._place(segment.end)
        if kind in ("Line", "Close") and math.dist(begin, end) < SAME:
            return
        if math.dist(begin, self._here[:2]) >= SAME or self._here[2] != 0.0:
            if self.elements or self._here[2] != self._lift:
                self._to((self._here[0], self._here[1], self._lift), None)
            self._to((*begin, self._lift), None)
            self._to((*begin, 0.0), self._velocity)
        for element in self._elements(segment, kind):
            if math.dist(self._here, element.end) >= SAME:
                self._append(element)

    def _elements(self, segment: Any, kind: str) -> Iterable[Element]:
        if kind == "Arc":
            yield from self._arc(segment)
        elif kind in ("QuadraticBezier", "CubicBezier"):
            yield from self._bezier([complex(*self._place(point)) for point in segment])
        else:
            yield from self._chords(segment, 1)

    def _arc(self, segment: Any) -> Iterator[Element]:
        sweep, rx, ry = abs(segment.sweep), segment.rx * _MM, segment.ry * _MM
        if not (rx > 0 and ry > 0 and sweep > 0):  # SVG 1.1, 8.3.8: it is a line
            yield from self._chords(segment, 1)
            return
        stretch, similar = _stretch(self._matrix)
        radius = stretch * max(rx, ry)
        if not radius <= REACH:
            raise TreeError(f"an arc with a radius of {radius:.6g} mm: expected numbers up to {REACH:.0e} mm")
        count = split_turn(sweep)
        flat = radius * (1 - math.cos(min(sweep / count / 2, math.pi / 2))) < SAME
        if similar and abs(rx - ry) <= 1e-9 * max(rx, ry) and not flat:
            for i in range(count):
                yield Element(self._at(segment, (i + 1) / count), self._at(segment, (i + 0.5) / count), self._velocity)
        else:  # for a flattened circle, the errors of chords are smaller, too
            yield from self._chords(segment, chords(sweep, radius, self._tolerance))

    def _bezier(self, control: list[complex]) -> Iterator[Element]:
        count = self._room(chords_of_bezier(control, self._tolerance))
        share = np.arange(1, count + 1) / count
        rest = 1 - share
        ends = [np.full(count, point) for point in control]
        while len(ends) > 1:  # de Casteljau
            ends = [rest * a + share * b for a, b in pairwise(ends)]
        for x, y in zip(ends[0].real.tolist(), ends[0].imag.tolist(), strict=True):
            yield Element((x, y, 0.0), None, self._velocity)

    def _chords(self, segment: Any, count: int) -> Iterator[Element]:
        for i in range(self._room(count)):
            yield Element(self._at(segment, (i + 1) / count), None, self._velocity)

    def _room(self, count: int) -> int:
        if len(self.elements) + count > MOST_ELEMENTS:
            raise TreeError(f"the path has more than {MOST_ELEMENTS:,} elements")
        return count

    def _to(self, point: Point, velocity: float | None) -> None:
        if math.dist(self._here, point) >= SAME:
            self._append(Element(point, None, velocity))

    def _append(self, element: Element) -> None:
        self._room(1)
        self.elements.append(element)
        self.sources.append(self.source)
        self._here = element.end

    def _at(self, segment: Any, share: float) -> Point:
        return (*self._place(segment.end if share == 1 else segment.point(share)), 0.0)

    def _place(self, point: Any) -> tuple[float, float]:
        at = _moved(self._matrix, point) * _MM
        x, y = at.real, self._height - at.imag
        if not (abs(x) <= REACH and abs(y) <= REACH):
            raise TreeError(f"a point at ({x:.6g}, {y:.6g}) mm: expected numbers up to {REACH:.0e} mm")
        return (x, y)
