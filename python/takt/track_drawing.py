"""Tracks from drawings (SVG, DXF): a track for each line that is drawn in one go.

Lines and arcs are taken as they are. Where two of them meet with a corner, or where a line becomes an arc, both are
shortened, so that a transition can lead from one to the other. DXF needs ezdxf (pip install takt-motion[dxf]).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

from takt.errors import TaktError

CORNER = 40.0  # mm that a corner takes of the lines that meet there
TOLERANCE = 0.5  # mm from curves to lines for them
SAME = 1e-6  # mm
SMOOTH = 1e-6  # rad
SHARE = 0.45  # a corner takes no more of a line
DRAWINGS = (".svg", ".dxf")


@dataclass(frozen=True)
class Piece:
    """A line, or an arc about its centre; places are complex numbers, mm."""

    begin: complex
    end: complex
    centre: complex | None = None
    sweep: float = 0.0  # rad, of an arc; above 0 counterclockwise

    @property
    def length(self) -> float:
        if self.centre is None:
            return abs(self.end - self.begin)
        return abs(self.sweep) * abs(self.begin - self.centre)

    @property
    def curvature(self) -> float:
        return 0.0 if self.centre is None else math.copysign(1 / abs(self.begin - self.centre), self.sweep)

    def place(self, share: float) -> complex:
        if self.centre is None:
            return self.begin + share * (self.end - self.begin)
        return self.centre + (self.begin - self.centre) * cmath.exp(1j * share * self.sweep)

    def direction(self, share: float) -> complex:
        if self.centre is None:
            return (self.end - self.begin) / abs(self.end - self.begin)
        out = (self.place(share) - self.centre) / abs(self.begin - self.centre)
        return out * (1j if self.sweep > 0 else -1j)

    def between(self, first: float, last: float) -> Piece:
        """A part of it, by shares of its length."""
        return replace(self, begin=self.place(first), end=self.place(last), sweep=self.sweep * (last - first))

    def reversed(self) -> Piece:
        return replace(self, begin=self.end, end=self.begin, sweep=-self.sweep)

    def goes_on_to(self, other: Piece) -> bool:
        """Without a step of direction or curvature."""
        turn = abs(cmath.phase(other.direction(0) / self.direction(1)))
        return turn < SMOOTH and math.isclose(self.curvature, other.curvature, rel_tol=1e-6, abs_tol=1e-12)


def read(file: Path, corner: float = CORNER) -> str:
    """The section `tracks` of a machine file that says what is drawn. Raises TaktError."""
    strokes = list(_of_svg(file) if file.suffix.lower() == ".svg" else _of_dxf(file))
    if not strokes:
        raise TaktError(f"{file}: no lines, polylines, arcs or circles are drawn in it")
    lines = ["tracks:"]
    for number, pieces in enumerate(map(_merged, strokes), 1):
        closed = abs(pieces[-1].end - pieces[0].begin) < SAME
        lines += [f"  - name: track{number}", f"    closed_loop: {str(closed).lower()}", "    elements:"]
        lines += [f"      - {_text(piece)}" for piece in _rounded(pieces, closed, corner)]
    return "\n".join(lines) + "\n"


def _merged(pieces: list[Piece]) -> list[Piece]:
    """What goes on smoothly is one."""
    merged = pieces[:1]
    for piece in pieces[1:]:
        last = merged[-1]
        whole = abs(last.sweep + piece.sweep) < 2 * math.pi + SMOOTH
        if last.goes_on_to(piece) and whole:
            merged[-1] = replace(last, end=piece.end, sweep=last.sweep + piece.sweep)
        else:
            merged.append(piece)
    return merged


def _rounded(pieces: Sequence[Piece], closed: bool, corner: float) -> list[Piece]:
    """With gaps where they do not go on smoothly."""
    count = len(pieces)
    last = count if closed and count > 1 else count - 1
    cuts = [not pieces[i].goes_on_to(pieces[(i + 1) % count]) for i in range(last)]
    before = [cuts[i - 1] if i > 0 or last == count else False for i in range(count)]
    behind = [cuts[i] if i < last else False for i in range(count)]
    rounded = []
    for piece, first, second in zip(pieces, before, behind, strict=True):
        share = min(corner / piece.length, SHARE)
        rounded.append(piece.between(share * first, 1 - share * second) if first or second else piece)
    return rounded


def _text(piece: Piece) -> str:
    ends = f"from: {_place(piece.begin)}, to: {_place(piece.end)}"
    if piece.centre is None:
        return f"{{{ends}}}"
    clockwise = str(piece.sweep < 0).lower()
    return f"{{shape: circle, {ends}, center: {_place(piece.centre)}, clockwise: {clockwise}}}"


def _place(place: complex) -> str:
    return f"{{x: {_number(place.real)}, y: {_number(place.imag)}}}"


def _number(value: float) -> str:
    text = repr(round(value, 12) + 0.0)
    return text if "e" not in text else f"{value:.12f}"


def _of_svg(file: Path) -> Iterator[list[Piece]]:
    from takt.svg import LIFT, read_svg

    path = read_svg(file, (0.0, 0.0, LIFT), TOLERANCE)
    stroke: list[Piece] = []
    here = path.start
    for element in path.elements:
        drawn = here[2] == 0 and element.end[2] == 0
        if drawn:
            begin, end = complex(*here[:2]), complex(*element.end[:2])
            stroke.append(_arc_through(begin, complex(*element.via[:2]), end) if element.via else Piece(begin, end))
        elif stroke:
            yield stroke
            stroke = []
        here = element.end
    if stroke:
        yield stroke


def _arc_through(begin: complex, via: complex, end: complex) -> Piece:
    """No more than half a turn."""
    a, b = via - begin, end - begin
    cross = (a.conjugate() * b).imag
    centre = begin + 1j * (abs(a) ** 2 * b - abs(b) ** 2 * a) / (-2 * cross)
    sweep = cmath.phase((via - centre) / (begin - centre)) + cmath.phase((end - centre) / (via - centre))
    return Piece(begin, end, centre, sweep)


def _of_dxf(file: str | PathLike[str]) -> Iterator[list[Piece]]:
    try:
        from ezdxf.enums import InsertUnits
        from ezdxf.filemanagement import readfile
        from ezdxf.lldxf.const import DXFError
        from ezdxf.units import conversion_factor
    except ImportError:
        raise TaktError(f"{file}: DXF needs ezdxf (pip install takt-motion[dxf])") from None
    try:
        drawing = readfile(str(file))
    except (OSError, DXFError) as error:
        raise TaktError(f"{file}: is no DXF: {error}") from None
    scale = conversion_factor(InsertUnits(drawing.units), InsertUnits.Millimeters) if drawing.units else 1.0
    loose: list[Piece] = []
    for entity in drawing.modelspace():
        if entity.dxftype() in ("LWPOLYLINE", "POLYLINE"):
            yield _chained([_piece(one, scale) for one in entity.virtual_entities()])  # type: ignore[attr-defined]
        elif entity.dxftype() == "CIRCLE":
            yield [_piece(entity, scale)]
        elif entity.dxftype() in ("LINE", "ARC"):
            loose.append(_piece(entity, scale))
    while loose:
        yield _grown([loose.pop(0)], loose)


def _piece(entity: Any, scale: float) -> Piece:
    def place(point: Any) -> complex:
        return scale * complex(point.x, point.y)

    if entity.dxftype() == "LINE":
        return Piece(place(entity.dxf.start), place(entity.dxf.end))
    centre = place(entity.dxf.center)
    if entity.dxftype() == "CIRCLE":
        return Piece(centre + scale * entity.dxf.radius, centre + scale * entity.dxf.radius, centre, 2 * math.pi)
    sweep = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360)
    return Piece(place(entity.start_point), place(entity.end_point), centre, sweep)


def _chained(pieces: list[Piece]) -> list[Piece]:
    """In the order given, each turned so that it goes on where the one before it ends."""
    pieces = [piece for piece in pieces if piece.length > SAME]
    if len(pieces) > 1 and min(abs(pieces[0].end - e) for e in (pieces[1].begin, pieces[1].end)) > SAME:
        pieces[0] = pieces[0].reversed()
    for i in range(1, len(pieces)):
        if abs(pieces[i].begin - pieces[i - 1].end) > SAME:
            pieces[i] = pieces[i].reversed()
    return pieces


def _grown(stroke: list[Piece], loose: list[Piece]) -> list[Piece]:
    """With all that goes on at its ends, in whatever order and sense it was drawn."""
    grew = True
    while grew:
        grew = False
        for piece in loose:
            for one in (piece, piece.reversed()):
                if abs(one.begin - stroke[-1].end) < SAME:
                    stroke.append(one)
                elif abs(one.end - stroke[0].begin) < SAME:
                    stroke.insert(0, one)
                else:
                    continue
                loose.remove(piece)
                grew = True
                break
            if grew:
                break
    return stroke
