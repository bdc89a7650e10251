"""Computes frames of tables, cameras and belts from points measured with a tool, with their residuals.

Points are positions of the tool centre point [mm], as a group publishes them, one per row. Frames are returned as poses
(x, y, z [mm], a, b, c [deg]), in the form of `origin` of a belt, `base` of a group and `set_cartesian_transform`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from takt.errors import TaktError
from takt.kinematics import matrix_to_pose

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

REACH = 1e9  # mm or u: larger numbers are taken for mistakes; sums of their squares could overflow
LEAST_SPREAD = 0.1  # mm: points closer together, or closer to one line, define no frame


class CalibrationError(TaktError):
    """The points define no frame."""


@dataclass(frozen=True)
class Calibration:
    """A frame, and the distance of each measured point from its position by the frame."""

    pose: Array  # x, y, z [mm], a, b, c [deg]
    residuals: Array  # mm, one for each point; empty if the frame is exactly determined
    ratio: float | None = None  # of a belt: mm along X per unit of its axis

    @property
    def largest(self) -> float:
        """The largest residual [mm]; 0 without residuals."""
        return float(self.residuals.max(initial=0.0))

    @property
    def yaml(self) -> str:
        """The pose in the form of a machine file, rounded to 1e-6 mm and deg."""
        numbers = (f"{key}: {_text(value)}" for key, value in zip("xyzabc", self.pose, strict=True))
        return "{" + ", ".join(numbers) + "}"


def _text(value: float) -> str:
    """Returns a number with up to six decimals, without trailing zeros."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def three_points(
    origin: npt.ArrayLike, on_x: npt.ArrayLike, on_xy: npt.ArrayLike, *, at: npt.ArrayLike | None = None
) -> Calibration:
    """Returns the frame of three points: the origin, a point on +X, and a point of the XY plane with y > 0.

    at: the origin instead of the first point; the first three points then give the orientation only.

    Raises CalibrationError if the points coincide or lie on one line.
    """
    o, x, xy = (_points(point, 1, "a point")[0] for point in (origin, on_x, on_xy))
    if np.linalg.norm(x - o) < LEAST_SPREAD:
        raise CalibrationError(
            f"the point on X is {np.linalg.norm(x - o):.3g} mm from the origin: measure one further away"
        )
    along = (x - o) / np.linalg.norm(x - o)
    across = (xy - o) - np.dot(xy - o, along) * along
    if np.linalg.norm(across) < LEAST_SPREAD:
        raise CalibrationError(
            f"the third point is {np.linalg.norm(across):.3g} mm from the line through the other two: "
            "the three must not lie on one line"
        )
    place = o if at is None else _points(at, 1, "a point")[0]
    return Calibration(_pose(along, across, place), np.empty(0))


def fit(seen: npt.ArrayLike, measured: npt.ArrayLike) -> Calibration:
    """Returns the least-squares frame that maps the `seen` points (as of a camera or a drawing) to the measured ones.

    seen, measured: the same points in both frames, three or more that do not lie on one line, shape (n, 3).

    Raises CalibrationError for other points.

    Kabsch, A solution for the best rotation to relate two sets of vectors, Acta Crystallographica A32 (1976).
    """
    a, b = _points(seen, 3, "seen points"), _points(measured, 3, "measured points")
    if len(a) != len(b):
        raise CalibrationError(f"there are {len(a)} seen points and {len(b)} measured ones: expected as many of both")
    for points, name in ((a, "seen"), (b, "measured")):
        _refuse_line(points, name)
    centre_a, centre_b = a.mean(axis=0), b.mean(axis=0)
    u, _, vt = np.linalg.svd((a - centre_a).T @ (b - centre_b))
    mirror = np.sign(np.linalg.det(vt.T @ u.T))
    rotation = vt.T @ np.diag([1.0, 1.0, mirror]) @ u.T
    offset = centre_b - rotation @ centre_a
    return Calibration(_to_pose(rotation, offset), np.linalg.norm(a @ rotation.T + offset - b, axis=1))


def belt(positions: npt.ArrayLike, measured: npt.ArrayLike, beside: npt.ArrayLike) -> Calibration:
    """Returns the origin and the ratio of a straight belt, from a mark on it. The origin is the position of the mark at
    position 0 of the belt's axis.

    positions: two or more positions of the belt's axis [u].
    measured: the mark at each of these positions, shape (n, 3).
    beside: a point on the belt on the +Y side of the line of the mark.

    Raises CalibrationError if the mark did not move, or `beside` is on its line.
    """
    at = np.asarray(positions, dtype=float).reshape(-1)
    points = _points(measured, 2, "measured points")
    if len(at) != len(points):
        raise CalibrationError(f"there are {len(at)} positions and {len(points)} points: expected one for each")
    if not np.all(np.abs(at) <= REACH):
        raise CalibrationError(
            f"positions: expected numbers up to {REACH:g}, found {at[np.argmin(np.abs(at) <= REACH)]:g}"
        )
    spread = at - at.mean()
    if not np.ptp(at):
        raise CalibrationError(
            "all points were measured at one position of the belt's axis: move the belt between them"
        )
    slope = spread @ (points - points.mean(axis=0)) / (spread @ spread)
    ratio = float(np.linalg.norm(slope))
    if ratio * np.ptp(at) < LEAST_SPREAD:
        raise CalibrationError(
            f"the mark moved {ratio * np.ptp(at):.3g} mm: measure it at least {LEAST_SPREAD} mm apart"
        )
    along = slope / ratio
    origin = points.mean(axis=0) - at.mean() * slope
    side = _points(beside, 1, "a point")[0] - origin
    across = side - np.dot(side, along) * along
    if np.linalg.norm(across) < LEAST_SPREAD:
        raise CalibrationError(
            f"the point beside is {np.linalg.norm(across):.3g} mm from the line of the mark: it must not lie on it"
        )
    residuals = np.linalg.norm(origin + np.outer(at, slope) - points, axis=1)
    return Calibration(_pose(along, across, origin), residuals, ratio)


def _points(values: npt.ArrayLike, least: int, name: str) -> Array:
    try:
        points = np.atleast_2d(np.asarray(values, dtype=float))
    except (TypeError, ValueError):
        raise CalibrationError(f"{name}: expected x, y, z in each row, as numbers") from None
    if points.ndim != 2 or points.shape[1] != 3:
        raise CalibrationError(f"{name}: expected x, y, z in each row, found {points.shape[-1]} numbers")
    if len(points) < least:
        raise CalibrationError(f"{name}: expected at least {least}, found {len(points)}")
    good = (np.abs(points) <= REACH).all(axis=1)  # NaN is not
    if not np.all(good):
        row = int(np.argmin(good))
        said = "is not finite" if not np.all(np.isfinite(points[row])) else f"lies beyond {REACH:g} mm"
        raise CalibrationError(f"{name}: point {row + 1} {said}: {', '.join(f'{v:g}' for v in points[row])}")
    return points


def _refuse_line(points: Array, name: str) -> None:
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if spread[1] < LEAST_SPREAD:
        raise CalibrationError(
            f"the {name} points lie within {spread[1]:.3g} mm of one line: measure one beside it"
            if spread[0] >= LEAST_SPREAD
            else f"the {name} points lie within {spread[0]:.3g} mm of one another: measure them further apart"
        )


def _pose(along: Array, across: Array, origin: Array) -> Array:
    y = across / np.linalg.norm(across)
    return _to_pose(np.column_stack([along, y, np.cross(along, y)]), origin)


def _to_pose(rotation: Array, offset: Array) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, offset
    return np.asarray(matrix_to_pose(matrix))
