"""Simple solids of scenes. Lengths in mm; `colour` names the role of the solid, and the page's theme gives its
colour."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from takt import _core
from takt.kinematics import pose_to_matrix
from takt.names import shown
from takt.recording import Array

Solid = dict[str, Any]
Place = Sequence[float] | Array
MOST_TRIANGLES = 6000  # of one mesh; larger ones are simplified
CELLS = 48  # along the longest edge of a mesh whose vertices are merged


def box(size: Place, at: Place, colour: str, **more: Any) -> Solid:
    """Returns a box from its edges along X, Y, Z and its centre."""
    return {"kind": "box", "size": rounded(size), "at": rounded(shift(*at)), "colour": colour, **more}


def cylinder(radius: float, start: Place, end: Place, colour: str, **more: Any) -> Solid:
    """Returns a cylinder between the centres of its faces."""
    length = float(np.linalg.norm(np.subtract(end, start)))
    return {
        **{"kind": "cylinder", "size": rounded([radius, length]), "at": rounded(along(start, end)[:3].ravel())},
        "colour": colour,
        **more,
    }


def capsule(radius: float, start: Place, end: Place, colour: str, **more: Any) -> Solid:
    """Returns a cylinder with hemispheres on both ends, beyond `start` and `end`."""
    return {**cylinder(radius, start, end, colour, **more), "kind": "capsule"}


def ball(radius: float, at: Place, colour: str, **more: Any) -> Solid:
    return {"kind": "sphere", "size": rounded([radius]), "at": rounded(shift(*at)), "colour": colour, **more}


def from_file(
    solid: Mapping[str, Any], folder: Path | None, colour: str, span: Place = (0, 0, 0), **more: Any
) -> Solid | None:
    """Returns a shape of the machine file, placed on its link; None if its file is not available.

    span: position of the next axis, for capsules without a length."""
    at = rounded(pose_matrix(solid["pose"])[:3].ravel())
    placed: Solid = {"at": at, "colour": colour, **more}
    if given := solid.get("box"):
        return {**placed, "kind": "box", "size": [given[edge] for edge in "xyz"]}
    if given := solid.get("cylinder"):
        return {**placed, "kind": "cylinder", "size": [given["radius"], given["height"]]}
    if given := solid.get("sphere"):
        return {**placed, "kind": "sphere", "size": [given["radius"]]}
    if given := solid.get("capsule"):
        if given.get("length") is not None:
            return {**placed, "kind": "capsule", "size": [given["radius"], given["length"]]}
        return {**capsule(given["radius"], (0, 0, 0), span, colour), **more}
    mesh = solid.get("mesh")
    surface = _core.surface_of_stl(shown(folder / mesh["file"]), mesh["scale"]) if mesh and folder else None
    if surface is None:
        return None
    vertices, triangles = thinned(*surface)
    flat = {"vertices": rounded(vertices.ravel()), "triangles": triangles.ravel().tolist()}
    return {**placed, "kind": "mesh", **flat}


def thinned(vertices: Array, triangles: Any) -> tuple[Array, Any]:
    """Returns a surface of at most MOST_TRIANGLES triangles: vertices in one cell of a grid are merged, triangles
    without area removed."""
    if len(triangles) <= MOST_TRIANGLES:
        return vertices, triangles
    lower = vertices.min(axis=0)
    edge = float(np.max(vertices.max(axis=0) - lower))
    for cells in (CELLS, CELLS // 2, CELLS // 4, CELLS // 8):
        grid = np.floor((vertices - lower) / edge * cells)
        _, first, cell = np.unique(grid, axis=0, return_index=True, return_inverse=True)
        corners = cell.reshape(-1)[triangles]
        a, b, c = corners.T
        kept = np.unique(corners[(a != b) & (b != c) & (a != c)], axis=0)
        if len(kept) <= MOST_TRIANGLES:
            break
    return vertices[first], kept[:MOST_TRIANGLES]


def shift(x: float, y: float, z: float) -> list[float]:
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z]


def along(start: Place, end: Place) -> Array:
    """Returns the frame in the middle of two points whose Z points from the first to the second."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(b - a))
    z = (b - a) / length if length > 1e-9 else np.array([0.0, 0.0, 1.0])
    aside = np.array([0.0, 1.0, 0.0]) if abs(z[1]) < 0.9 else np.array([1.0, 0.0, 0.0])
    x = np.cross(aside, z)
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3] = np.stack([x, np.cross(z, x), z, (a + b) / 2], axis=1)
    return frame


def pose_matrix(pose: Mapping[str, float]) -> Array:
    return np.asarray(pose_to_matrix([float(pose[axis]) for axis in "xyzabc"]))


def rounded(numbers: Any) -> list[float]:
    return [float(f"{number:.7g}") + 0.0 for number in np.asarray(numbers, float).ravel()]
