"""Poses of moving nodes: of links by the kinematics of the group, of others by published fields.

A pose is seven numbers: X, Y, Z in mm and a unit quaternion x, y, z, w. Pages apply such poses and have no kinematics.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from takt.kinematics import Kinematics, KinematicsError, pose_to_matrix
from takt.recording import Array, Recording

POSE = 7  # numbers
Values = Callable[[str, str], float]  # component, field -> value


def link_poses(mechanism: Kinematics, base: Array, joints: Array) -> Array:
    """Returns the poses (n, links, 7) of the links in the world, for rows of positions of the axes; NaN where the
    kinematics have no solution."""
    try:
        frames = mechanism.link_frames(joints)
    except (KinematicsError, ValueError):
        if len(joints) == 1:
            return np.full((1, len(mechanism.links), POSE), np.nan)
        half = len(joints) // 2
        return np.concatenate([link_poses(mechanism, base, part) for part in (joints[:half], joints[half:])])
    return poses_of(base @ frames)


def poses_of(matrices: Array) -> Array:
    """Returns the poses (..., 7) of homogeneous matrices (..., 4, 4). Shepperd's method: the largest of the four
    components comes from the diagonal, so that none of the others is divided by a small number."""
    m = matrices[..., :3, :3]
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = np.stack([1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz], axis=-1)
    a, b, c = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    xy, xz, yz = m[..., 0, 1] + m[..., 1, 0], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 2] + m[..., 2, 1]
    rows = np.stack(
        [
            np.stack([squares[..., 0], xy, xz, a], axis=-1),
            np.stack([xy, squares[..., 1], yz, b], axis=-1),
            np.stack([xz, yz, squares[..., 2], c], axis=-1),
            np.stack([a, b, c, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    best = np.argmax(squares, axis=-1)
    turns = np.take_along_axis(rows, best[..., np.newaxis, np.newaxis], axis=-2)[..., 0, :]
    turns = turns / np.linalg.norm(turns, axis=-1, keepdims=True)
    return np.concatenate([matrices[..., :3, 3], turns], axis=-1)


def rounded_poses(poses: Array) -> Array:
    """Returns poses rounded to 0.01 mm, and 0.01 mm on 1 m: the accuracy of pictures."""
    return np.concatenate([np.round(poses[..., :3], 2), np.round(poses[..., 3:], 5)], axis=-1)


def held(recording: Recording, component: str, field: str, times: Array) -> Array:
    """Returns the last sample at or before each time; before all samples the first one."""
    table = recording[component]
    rows = np.searchsorted(table["time_s"], times + 1e-9, side="right") - 1
    column: Array = table[field][np.maximum(rows, 0)].astype(np.float64)
    return column


def matrix_of(pose: Array) -> Array:
    """Returns the homogeneous matrix (4, 4) of a pose."""
    x, y, z, w = pose[3:]
    matrix = np.eye(4)
    matrix[:3, 3] = pose[:3]
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return matrix


def node_pose(scene: Mapping[str, Any], node: Mapping[str, Any], links: Mapping[str, Array], value: Values) -> Array:
    """Returns the matrix (4, 4) of a node of a scene in the world, as `space.js` computes it from the same description.
    `links`: poses (links, 7) of each group; `value` returns a published field of a component. NaN where that is
    unknown."""
    rest = np.eye(4)
    if "at" in node:
        rest[:3] = np.reshape(node["at"], (3, 4))
    moved = node.get("moved")
    if moved is None:
        return rest
    if "link" in moved:
        return np.asarray(matrix_of(links[moved["group"]][moved["link"]]) @ rest)
    component = moved["component"]
    if "slide" in moved:
        return np.asarray(rest @ _slid(moved, value(component, moved["slide"])))
    pose = [value(component, field) if field else 0.0 for field in moved["pose"]]
    placed = np.asarray(pose_to_matrix(pose)) @ rest
    if "system" in moved:
        placed[2, 3] += height_of(scene, value(component, moved["system"]))
    return np.asarray(placed)


def is_shown(node: Mapping[str, Any], value: Values) -> bool:
    """Returns whether a node is visible."""
    shown = node.get("shown")
    return shown is None or value(shown["component"], shown["field"]) > 0


def height_of(scene: Mapping[str, Any], system: float) -> float:
    """Returns the height [mm] at which a coordinate system is drawn, by its number from 1; 0 if there is none of this
    number."""
    heights = scene["heights"]
    return float(heights[int(system) - 1]) if math.isfinite(system) and 1 <= system <= len(heights) else 0.0


def _slid(moved: Mapping[str, Any], position: float) -> Array:
    way = (position - moved.get("from", 0.0)) * moved.get("scale", 1.0)
    if "wrap" in moved:
        way %= moved["wrap"]
    matrix = np.eye(4)
    if moved.get("turns"):
        cos, sin = math.cos(math.radians(way)), math.sin(math.radians(way))
        matrix[:2, :2] = [[cos, -sin], [sin, cos]]
    else:
        matrix[0, 3] = way
    return matrix
