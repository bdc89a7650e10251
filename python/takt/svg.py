"""Reads drawings (SVG) into a path for a tool, a pen say.

X goes to the right and Y up from the drawing's lower left corner, in mm; the pen draws at Z 0 and is lifted between
lines. Circular arcs stay arcs; ellipses and Béziers become lines that keep within a tolerance. Only outlines are
drawn: texts, pictures and fillings are not. Needs svgelements (pip install takt-motion[svg]).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from os import PathLike
from typing import Any
from xml.etree.ElementTree import ParseError

from takt.toolpath import SAME, TOLERANCE, Element, Point, Toolpath, ToolpathError, chords, split_turn

LIFT = 5.0  # mm
_MM = 1 / (96 * 0.0393701)  # of a pixel; svgelements rounds so, and drawings in mm come out exactly


def read_svg(
    path: str | PathLike[str],
    start: Point = (0.0, 0.0, 0.0),
    tolerance: float = TOLERANCE,
    *,
    lift: float = LIFT,
    velocity: float | None = None,
) -> Toolpath:
    """Reads a file. `start`: where the tool is when it begins, in mm. `lift`: how high the pen goes between lines.
    `velocity`: of drawing, in mm/s; unset: that of the command. Raises ToolpathError."""
    try:
        import svgelements  # type: ignore[import-untyped]
    except ImportError:
        raise ToolpathError(f"{path}: SVG needs svgelements (pip install takt-motion[svg])") from None
    try:
        drawing = svgelements.SVG.parse(str(path), reify=True, ppi=96)
    except ParseError as error:
        raise ToolpathError(f"{path}: is no SVG: {error}") from None
    pen = _Pen(start, drawing.height * _MM if drawing.height else 0.0, tolerance, lift, velocity)
    for shape in drawing.elements(lambda one: isinstance(one, svgelements.Shape)):
        outline = shape if isinstance(shape, svgelements.Path) else svgelements.Path(shape)
        for segment in outline:
            pen.draw(segment, type(segment).__name__)
    pen.up()
    skipped = drawing.elements(lambda one: isinstance(one, (svgelements.Text, svgelements.Image)))
    left_out = tuple(type(one).__name__.lower() for one in skipped)
    return Toolpath(start, tuple(pen.elements), left_out)


class _Pen:
    def __init__(self, start: Point, height: float, tolerance: float, lift: float, velocity: float | None) -> None:
        self.elements: list[Element] = []
        self._here = start
        self._height, self._tolerance, self._lift, self._velocity = height, tolerance, lift, velocity
        self._next: tuple[float, float] | None = None  # where the pen goes down

    def up(self) -> None:
        if self.elements:
            self._to((self._here[0], self._here[1], self._lift), None)

    def draw(self, segment: Any, kind: str) -> None:
        if kind == "Move":
            self._next = self._place(segment.end)
            return
        if segment.start is None or segment.end is None:
            return
        begin = self._place(segment.start)
        if math.dist(begin, self._here[:2]) >= SAME or self._here[2] != 0.0:
            if self.elements or self._here[2] != self._lift:
                self._to((self._here[0], self._here[1], self._lift), None)
            self._to((*begin, self._lift), None)
            self._to((*begin, 0.0), self._velocity)
        for element in self._elements(segment, kind):
            if math.dist(self._here, element.end) >= SAME:
                self.elements.append(element)
                self._here = element.end

    def _elements(self, segment: Any, kind: str) -> Iterator[Element]:
        if kind == "Arc":
            sweep, rx, ry = abs(segment.sweep), segment.rx * _MM, segment.ry * _MM
            if abs(rx - ry) <= 1e-9 * max(rx, ry):
                count = split_turn(sweep)
                for i in range(count):
                    yield Element(
                        self._at(segment, (i + 1) / count), self._at(segment, (i + 0.5) / count), self._velocity
                    )
                return
            count = chords(sweep, max(rx, ry), self._tolerance)  # a circle pressed flat: its chords come nearer too
        elif kind in ("QuadraticBezier", "CubicBezier"):
            count = self._chords_of_bezier([complex(*self._place(p)) for p in segment if p is not None])
        else:
            count = 1
        for i in range(count):
            yield Element(self._at(segment, (i + 1) / count), None, self._velocity)

    def _chords_of_bezier(self, control: list[complex]) -> int:
        """So many of equal share keep within the tolerance: a chord over h is off by h² / 8 times the curve's second
        derivative, which its control points bound."""
        n = len(control) - 1
        second = max(abs(control[i + 2] - 2 * control[i + 1] + control[i]) for i in range(n - 1)) * n * (n - 1)
        return max(math.ceil(math.sqrt(second / (8 * self._tolerance))), 1)

    def _to(self, point: Point, velocity: float | None) -> None:
        if math.dist(self._here, point) >= SAME:
            self.elements.append(Element(point, None, velocity))
            self._here = point

    def _at(self, segment: Any, share: float) -> Point:
        return (*self._place(segment.end if share == 1 else segment.point(share)), 0.0)

    def _place(self, point: Any) -> tuple[float, float]:
        return (float(point.x) * _MM, self._height - float(point.y) * _MM)
