"""Tracks from drawings (SVG, DXF): one track for each connected line.

Lines and arcs are kept, ellipses and splines are approximated by lines. Ends closer to each other than JOIN are joined.
Where two elements meet with a corner, or where a line meets an arc, both are shortened to make room for a transition
between them. Ignored contents of a drawing are listed in comments before the tracks.
"""

from __future__ import annotations

import cmath
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from takt.errors import TaktError
from takt.names import shown

if TYPE_CHECKING:
    from takt.track_dxf import Run

CORNER = 40.0  # mm by which a corner shortens the lines that meet there
TOLERANCE = 0.5  # mm between curves and their approximation by lines
SAME = 1e-6  # mm
JOIN = 0.01  # mm: ends closer than this are joined
SMOOTH = 1e-6  # rad
SHARE = 0.45  # largest share of a line that a corner takes
DRAWINGS = (".svg", ".dxf")
_FINDING = re.compile(r"tracks\[(\d+)\](?:\.elements\[(\d+)\][^:]*)?[.:] ?(.*)", re.DOTALL)


@dataclass(frozen=True)
class Piece:
    """A line, or an arc about its centre; points are complex numbers [mm]."""

    begin: complex
    end: complex
    centre: complex | None = None
    sweep: float = 0.0  # rad, of an arc; positive: counterclockwise
    source: str = ""  # its origin in the drawing: an entity with its handle, a shape

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
        """Returns a part of the piece, by shares of its length."""
        return replace(self, begin=self.place(first), end=self.place(last), sweep=self.sweep * (last - first))

    def reversed(self) -> Piece:
        return replace(self, begin=self.end, end=self.begin, sweep=-self.sweep)

    def joined(self, begin: complex | None = None, end: complex | None = None) -> Piece:
        """Returns the piece with an end moved by less than JOIN; an arc keeps its sweep."""
        first, last = self.begin if begin is None else begin, self.end if end is None else end
        if self.centre is None or abs(self.sweep) > 2 * math.pi - SMOOTH or abs(last - first) < SAME:
            return replace(self, begin=first, end=last)
        half = (last - first) / 2
        return replace(self, begin=first, end=last, centre=first + half * (1 + 1j / math.tan(self.sweep / 2)))

    def goes_on_to(self, other: Piece) -> bool:
        """Returns whether `other` continues this piece without a step of direction or curvature."""
        turn = abs(cmath.phase(other.direction(0) / self.direction(1)))
        return turn < SMOOTH and math.isclose(self.curvature, other.curvature, rel_tol=1e-6, abs_tol=1e-12)


class Drawing(NamedTuple):
    tracks: str  # the section of a machine file
    left_out: tuple[str, ...]  # ignored contents of the drawing, a sentence each
    elements: tuple[tuple[str, ...], ...]  # by track: the origins of its elements in the drawing

    def placed(self, file: Path, problem: str) -> str:
        """Returns a problem of a track with the element of the drawing instead of a line of `tracks`."""
        sentence = re.sub(r"^:\d+:\d+: ", "", problem.removeprefix(shown(file)))
        match = _FINDING.fullmatch(sentence)
        if not match:
            return f"{file}: {sentence}"
        track = int(match[1])
        where = f"track{track + 1}"
        if match[2]:
            where += f", element {int(match[2]) + 1} ({self.elements[track][int(match[2])]})"
        return f"{file}: {where}: {match[3]}"


def read(file: Path, corner: float = CORNER) -> str:
    """Returns a drawing as the section `tracks` of a machine file. `corner`: [mm] by which a corner shortens the lines
    that meet there. Raises TaktError."""
    return read_drawing(file, corner).tracks


def read_drawing(file: Path, corner: float = CORNER) -> Drawing:
    """Returns the tracks of a drawing, with its ignored contents. Raises TaktError."""
    left_out: Counter[str] = Counter()
    if file.suffix.lower() == ".svg":
        strokes = list(_of_svg(file, left_out))
    else:
        from takt.track_dxf import read_dxf

        strokes = [_chained(pieces) for pieces in _connected(read_dxf(file, left_out))]
    said = tuple(what if count == 1 else f"{what} ({count} times)" for what, count in left_out.items())
    if not strokes:
        besides = f"; left out: {', '.join(said)}" if said else ""
        raise TaktError(f"{file}: no lines, polylines, arcs or circles are drawn in it{besides}")
    lines = [f"# left out: {what}" for what in said] + ["tracks:"]
    elements = []
    for number, pieces in enumerate(map(_merged, strokes), 1):
        closed = abs(pieces[-1].end - pieces[0].begin) < SAME
        lines += [f"  - name: track{number}", f"    closed_loop: {str(closed).lower()}", "    elements:"]
        rounded = _rounded(pieces, closed, corner)
        lines += [f"      - {_text(piece)}" for piece in rounded]
        elements.append(tuple(map(_label, rounded)))
    return Drawing("\n".join(lines) + "\n", said, tuple(elements))


def _merged(pieces: list[Piece]) -> list[Piece]:
    """Returns the pieces with smooth continuations merged into one piece."""
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
    """Returns the pieces with gaps where they do not continue smoothly."""
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


def _label(piece: Piece) -> str:
    begin, end = (f"({place.real:.6g}, {place.imag:.6g})" for place in (piece.begin, piece.end))
    return f"{'line' if piece.centre is None else 'arc'} from {begin} to {end} mm of {piece.source}"


def _place(place: complex) -> str:
    return f"{{x: {_number(place.real)}, y: {_number(place.imag)}}}"


def _number(value: float) -> str:
    text = repr(round(value, 12) + 0.0)
    return text if "e" not in text else f"{value:.12f}"


def _of_svg(file: Path, left_out: Counter[str]) -> Iterator[list[Piece]]:
    from takt.svg import LIFT, read_svg

    sources: list[str] = []
    path = read_svg(file, (0.0, 0.0, LIFT), TOLERANCE, sources=sources)
    left_out.update(path.left_out)
    stroke: list[Piece] = []
    here = path.start
    for element, source in zip(path.elements, sources, strict=True):
        drawn = here[2] == 0 and element.end[2] == 0
        if drawn:
            begin, end = complex(*here[:2]), complex(*element.end[:2])
            piece = _arc_through(begin, complex(*element.via[:2]), end) if element.via else Piece(begin, end)
            stroke.append(replace(piece, source=source))
        elif stroke:
            yield stroke
            stroke = []
        here = element.end
    if stroke:
        yield stroke


def _arc_through(begin: complex, via: complex, end: complex) -> Piece:
    """Returns the arc through three points; requires at most half a turn."""
    a, b = via - begin, end - begin
    cross = (a.conjugate() * b).imag
    centre = begin + 1j * (abs(a) ** 2 * b - abs(b) ** 2 * a) / (-2 * cross)
    sweep = cmath.phase((via - centre) / (begin - centre)) + cmath.phase((end - centre) / (via - centre))
    return Piece(begin, end, centre, sweep)


def _connected(runs: Sequence[Run]) -> Iterator[list[Piece]]:
    """Yields strokes: complete runs, and loose runs joined with those that continue at their ends, in any order and
    direction of drawing."""
    loose = [run.pieces for run in runs if run.loose and not _is_closed(run.pieces)]
    yield from (run.pieces for run in runs if not run.loose or _is_closed(run.pieces))
    ends = _Ends(loose)
    for i, pieces in enumerate(loose):
        if not ends.take(i):
            continue
        ahead, before = list(pieces), list[Piece]()  # before: from the beginning backwards
        while (after := ends.at(ahead[-1].end)) is not None:
            ends.take(after)
            ahead += _from(loose[after], ahead[-1].end)
        while (after := ends.at(before[-1].end if before else ahead[0].begin)) is not None:
            ends.take(after)
            before += _from(loose[after], before[-1].end if before else ahead[0].begin)
        yield _turned(before) + ahead


def _from(pieces: list[Piece], begin: complex) -> list[Piece]:
    """Returns the pieces in the direction in which they begin at `begin`."""
    return pieces if abs(pieces[0].begin - begin) < JOIN else _turned(pieces)


def _turned(pieces: list[Piece]) -> list[Piece]:
    return [piece.reversed() for piece in reversed(pieces)]


def _is_closed(pieces: Sequence[Piece]) -> bool:
    return abs(pieces[-1].end - pieces[0].begin) < JOIN


class _Ends:
    """The ends of runs of pieces in a grid of cell size JOIN, so that each is compared only with its neighbours."""

    def __init__(self, runs: Sequence[list[Piece]]) -> None:
        self._ends = [(pieces[0].begin, pieces[-1].end) for pieces in runs]
        self._left = set(range(len(runs)))
        self._squares: dict[tuple[int, int], list[int]] = {}
        for i, ends in enumerate(self._ends):
            for end in ends:
                self._squares.setdefault(self._square(end), []).append(i)

    def take(self, i: int) -> bool:
        """Takes a run. Returns False if it has been taken already."""
        if i not in self._left:
            return False
        self._left.remove(i)
        return True

    def at(self, place: complex) -> int | None:
        """Returns the first remaining run with an end at a point; None if there is none."""
        x, y = self._square(place)
        near = [
            i
            for dx in (-1, 0, 1)
            for dy in (-1, 0, 1)
            for i in self._squares.get((x + dx, y + dy), ())
            if i in self._left and min(abs(end - place) for end in self._ends[i]) < JOIN
        ]
        return min(near, default=None)

    @staticmethod
    def _square(place: complex) -> tuple[int, int]:
        return (math.floor(place.real / JOIN), math.floor(place.imag / JOIN))


def _chained(pieces: list[Piece]) -> list[Piece]:
    """Returns the pieces with each beginning exactly at the end of the previous one, also around a closed loop."""
    chained = pieces[:1]
    for piece in pieces[1:]:
        chained.append(piece.joined(begin=chained[-1].end))
    if len(chained) > 1 and _is_closed(chained):
        chained[-1] = chained[-1].joined(end=chained[0].begin)
    return chained
