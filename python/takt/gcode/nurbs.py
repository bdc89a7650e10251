"""NURBS of G-code: G5.2 to G5.3 (LinuxCNC's manual) and G6.2 (knots in the program), in the active plane.

A rational B-spline of order k with n weighted control points and n + k knots. It is approximated by chords, whose ends
come from de Boor's algorithm in homogeneous coordinates (Piegl, Tiller, The NURBS Book, 4.2). G5.2 gives no knots: they
are uniform and clamped, so that the curve begins at the first control point and ends at the last one.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from takt.gcode.errors import LineError
from takt.toolpath import MOST_ELEMENTS

Array = npt.NDArray[np.float64]
MOST_ORDER = 20


class Nurbs:
    """Collects the control points [mm], weights and knots of a curve, line by line."""

    def __init__(self, with_knots: bool) -> None:
        self.order, self.with_knots = 3, with_knots
        self._points: list[tuple[float, float, float]] = []
        self._knots: list[float] = []

    def set_order(self, order: float) -> None:
        least = 2 if self.with_knots else 3
        if order != int(order) or not least <= order <= MOST_ORDER:
            raise LineError(
                f"the order of a NURBS: expected a whole number from {least} to {MOST_ORDER}, found {order:g}"
            )
        self.order = int(order)

    def add(self, point: complex, weight: float) -> None:
        if not 0 < weight < 1e9:
            raise LineError(f"the weight of a control point: expected a number above 0, found {weight:g}")
        self._points.append((point.real, point.imag, weight))

    def add_knot(self, knot: float) -> None:
        if self._knots and knot < self._knots[-1]:
            raise LineError(f"K: expected a knot from {self._knots[-1]:g} on, found {knot:g}")
        self._knots.append(knot)

    @property
    def is_complete(self) -> bool:
        """True if all knots are given."""
        return len(self._knots) == len(self._points) + self.order

    def chords(self, tolerance: float) -> list[complex]:
        """Returns points of the curve [mm], so dense that the chords between them deviate by at most `tolerance` [mm].
        Raises LineError if there are too few control points, all knots are equal, or a point is not finite."""
        count = len(self._points)
        if count < self.order:
            raise LineError(f"a NURBS of order {self.order}: expected as many control points at least, found {count}")
        if self.with_knots:
            knots = np.array(self._knots)
        else:
            inner = np.arange(1.0, count - self.order + 1)
            last = float(count - self.order + 1)
            knots = np.concatenate([np.zeros(self.order), inner, np.full(self.order, last)])
        control = np.array([(x * w, y * w, w) for x, y, w in self._points])
        spans = [i for i in range(self.order - 1, count) if knots[i + 1] > knots[i]]
        if not spans:
            raise LineError("K: all knots are the same")
        found = [complex(self._at(knots[spans[:1]], spans[0], knots, control)[0])]
        for span in spans:
            found += self._chords_of(span, knots, control, tolerance)
        return found

    def _chords_of(self, span: int, knots: Array, control: Array, tolerance: float) -> list[complex]:
        """Returns the ends of the chords of one knot span. Their number is doubled until the curve half-way between two
        ends is within the tolerance of their chord."""
        count = 4
        while True:
            at = knots[span] + (knots[span + 1] - knots[span]) * np.linspace(0, 1, 2 * count + 1)
            points = self._at(at, span, knots, control)
            begin, half, end = points[:-1:2], points[1::2], points[2::2]
            if not np.all(np.isfinite(points)):
                raise LineError("a NURBS has no finite points")
            if np.max(np.abs(half - (begin + end) / 2)) <= tolerance:
                return [complex(point) for point in end]
            count *= 2
            if count > MOST_ELEMENTS:
                raise LineError(f"the path has more than {MOST_ELEMENTS:,} elements")

    def _at(self, at: Array, span: int, knots: Array, control: Array) -> npt.NDArray[np.complex128]:
        degree = self.order - 1
        rows = [np.repeat(control[span - degree + j][np.newaxis], len(at), axis=0) for j in range(self.order)]
        for level in range(1, self.order):
            for j in range(degree, level - 1, -1):
                low, high = knots[span - degree + j], knots[span + 1 + j - level]
                share = ((at - low) / (high - low))[:, np.newaxis]
                rows[j] = (1 - share) * rows[j - 1] + share * rows[j]
        x, y, w = rows[degree].T
        return np.asarray((x + 1j * y) / w)
