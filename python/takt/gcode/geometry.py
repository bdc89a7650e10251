"""Lines, arcs, helices and splines of G-code as the elements of a path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from takt.gcode.errors import LineError
from takt.toolpath import MOST_ELEMENTS, REACH, SAME, Element, Point, chords, chords_of_bezier, split_turn

# The manual of LinuxCNC, G2 G3: the radii at the two ends of an arc may differ by ALWAYS, or by SHARE of the radius if
# that is more, but never by more than NEVER; [mm], for programs in mm and for programs in inches.
ALWAYS, SHARE, NEVER = (0.005, 0.0005 * 25.4), 0.001, (0.5, 0.05 * 25.4)
PLANES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}  # counterclockwise as seen from the third axis


class Arc(NamedTuple):
    """An arc about an axis, or a helix, or no motion at all (sweep 0); [mm] and [rad]."""

    begin: Point
    end: Point
    axes: tuple[int, int, int]
    centre: tuple[float, float]
    radius: float  # at its start
    last: float  # radius at its end
    angle: float  # at its start
    sweep: float  # positive: counterclockwise

    @property
    def rise(self) -> float:
        return self.end[self.axes[2]] - self.begin[self.axes[2]]

    @property
    def length(self) -> float:
        return math.hypot(abs(self.sweep) * (self.radius + self.last) / 2, self.rise)

    def at(self, share: float) -> Point:
        """Returns the point at a share of the sweep, from 0 to 1."""
        if share == 1:
            return self.end
        angle, r = self.angle + share * self.sweep, self.radius + share * (self.last - self.radius)
        first, second, third = self.axes
        point = [0.0, 0.0, 0.0]
        point[first] = self.centre[0] + r * math.cos(angle)
        point[second] = self.centre[1] + r * math.sin(angle)
        point[third] = self.begin[third] + share * self.rise
        return (point[0], point[1], point[2])


def arc_about(
    begin: Point,
    end: Point,
    plane: str,
    centre: tuple[float, float],
    *,
    clockwise: bool,
    more_turns: float,
    inches: bool = False,
) -> Arc:
    """Returns the arc from `begin` to `end`, a full turn if these are equal in the plane, plus `more_turns`. Raises
    LineError if the radii at its ends differ by more than LinuxCNC allows, or its centre is at one of them."""
    axes = PLANES[plane]
    first, second, _ = axes
    out = (begin[first] - centre[0], begin[second] - centre[1])
    back = (end[first] - centre[0], end[second] - centre[1])
    radius, last = math.hypot(*out), math.hypot(*back)
    apart = abs(radius - last)
    if max(radius, last) < SAME:
        return Arc(begin, end, axes, centre, radius, last, 0.0, 0.0)
    if min(radius, last) < SAME:
        raise LineError("the centre of the arc is where it " + ("begins" if radius < SAME else "ends"))
    if apart > NEVER[inches] or apart > max(ALWAYS[inches], SHARE * max(radius, last)):
        raise LineError(f"the arc begins {radius:.6g} mm from its centre, but ends {last:.6g} mm from it")
    sign = -1 if clockwise else 1
    angle = math.atan2(out[1], out[0])
    sweep = (sign * (math.atan2(back[1], back[0]) - angle)) % (2 * math.pi)
    whole = math.hypot(end[first] - begin[first], end[second] - begin[second]) < SAME
    sweep = 2 * math.pi if whole else sweep
    return Arc(begin, end, axes, centre, radius, last, angle, sign * (sweep + 2 * math.pi * more_turns))


def centre_by_radius(
    begin: Point, end: Point, plane: str, given: float, *, clockwise: bool, inches: bool = False
) -> tuple[float, float]:
    """Returns the centre of the arc of a radius `given` [mm]; negative: of the arc of more than half a turn. Raises
    LineError if the ends are equal, or too far apart for the radius."""
    first, second, _ = PLANES[plane]
    along = (end[first] - begin[first], end[second] - begin[second])
    chord, radius = math.hypot(*along), abs(given)
    if chord < SAME:
        raise LineError("an arc by R must end elsewhere than it begins; use I, J, K for whole turns")
    if radius < chord / 2 - min(max(ALWAYS[inches], SHARE * radius), NEVER[inches]):
        raise LineError(f"R: the ends of the arc are {chord:.6g} mm apart, too far for a radius of {radius:.6g} mm")
    # The centre lies to the left of the chord of a counterclockwise arc of less than half a turn.
    side = 1 if clockwise == (given < 0) else -1
    height = side * math.sqrt(max(radius**2 - chord**2 / 4, 0.0)) / chord
    return (begin[first] + along[0] / 2 - height * along[1], begin[second] + along[1] / 2 + height * along[0])


class PathBuilder:
    """Appends elements to a path. Its methods raise LineError for an element beyond REACH, or for too many elements."""

    def __init__(self, start: Point, tolerance: float) -> None:
        self.elements: list[Element] = []
        self.here = start
        self._end = start  # end of the last element: moves shorter than SAME accumulate until they form an element
        self.tolerance = tolerance

    def line(self, end: Point, velocity: float | None) -> None:
        x, y, z = end
        if not (-REACH <= x <= REACH and -REACH <= y <= REACH and -REACH <= z <= REACH):
            raise LineError(f"a move to ({x:.6g}, {y:.6g}, {z:.6g}) mm: expected numbers up to {REACH:.0e} mm")
        self.here = end
        if math.dist(self._end, end) >= SAME:
            self._append(Element(end, None, velocity))

    def arc(self, arc: Arc, velocity: float | None) -> None:
        (x, y), (u, v, w) = arc.centre, arc.end
        if not max(abs(x), abs(y), arc.radius, abs(u), abs(v), abs(w)) <= REACH:
            raise LineError(f"an arc of a radius of {arc.radius:.6g} mm: expected numbers up to {REACH:.0e} mm")
        if arc.radius < SAME and arc.last < SAME:
            self.line(arc.end, velocity)
        elif abs(arc.rise) < SAME:
            count = self._room(split_turn(arc.sweep))
            # Three points do not define the curvature of a flat arc well enough: within SAME its chord replaces it.
            flat = arc.radius * (1 - math.cos(min(abs(arc.sweep) / count / 2, math.pi / 2))) < SAME
            for i in range(count):
                end = arc.at((i + 1) / count)
                if flat:
                    self.line(end, velocity)
                else:
                    self.here = end
                    self._append(Element(end, arc.at((i + 0.5) / count), velocity))
        else:
            count = self._room(chords(arc.sweep, max(arc.radius, arc.last), self.tolerance))
            for i in range(count):
                self.line(arc.at((i + 1) / count), velocity)

    def bezier(self, control: Sequence[complex]) -> list[complex]:
        """Returns the ends of the chords of a Bezier curve [mm] in X and Y; `control`: its control points after the
        present position. Appends nothing."""
        x, y, _ = self.here
        points = [complex(x, y), *control]
        if not all(abs(point) <= REACH for point in points):
            raise LineError(f"a spline: expected numbers up to {REACH:.0e} mm")
        count = self._room(chords_of_bezier(points, self.tolerance))
        found = []
        for i in range(1, count):
            share = i / count
            ends = points
            while len(ends) > 1:  # de Casteljau
                ends = [(1 - share) * a + share * b for a, b in pairwise(ends)]
            found.append(ends[0])
        return [*found, control[-1]]

    def _append(self, element: Element) -> None:
        self._room(1)
        self._end = element.end
        self.elements.append(element)

    def _room(self, count: int) -> int:
        if len(self.elements) + count > MOST_ELEMENTS:
            raise LineError(f"the path has more than {MOST_ELEMENTS:,} elements")
        return count
