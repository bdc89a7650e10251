"""Frames and kinematics of axis groups, on NumPy arrays.

import takt.kinematics as kin

robot = kin.Kinematics(delta={"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 800})
robot.forward([10, 20, 30])                    # [x, y, z, a, b, c]
robot.inverse([[0, 0, -700, 0, 0, 0]]).joints  # one row per pose

A pose is six numbers: X, Y, Z [mm] and A, B, C [deg]. A, B, C rotate about the fixed axes X, then Y, then Z of the
reference frame. Positions of axes are in their own units, [mm] or [deg]. Arguments with one row per pose also accept a
single row; results then lack the first dimension, too, except those of `inverse` and `inverse_motion`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from takt import _core
from takt.errors import TaktError
from takt.names import shown
from takt.yaml_text import to_json

Array = npt.NDArray[np.float64]
Reason = Literal["none", "not_finite", "out_of_reach", "orientation", "singular", "axis_limit"]
Shoulder = Literal["keep", "front", "back"]
Bend = Literal["keep", "positive", "negative"]

_REASONS = tuple(_core.reason_names())
assert get_args(Reason) == _REASONS


class KinematicsError(TaktError, ValueError):
    """No pose exists for a position of the axes, or no position for a pose: `row` is its index, `reason` says why."""

    def __init__(self, row: int, reason: int) -> None:
        self.row = row
        self.reason = _REASONS[reason]
        super().__init__(f"row {row}: {_core.reason_texts()[reason]}")


class Configuration(NamedTuple):
    """The branch among several positions of the axes for one pose; "keep": the branch of the given near position."""

    shoulder: Shoulder = "keep"
    elbow: Bend = "keep"
    wrist: Bend = "keep"


@dataclass(frozen=True)
class Solution:
    """The result of `inverse`: rows of NaN where there is no solution."""

    joints: Array  # (n, axes), mm or deg
    reasons: npt.NDArray[np.str_]  # (n,), why a row has no solution; "none": it has one

    @property
    def ok(self) -> npt.NDArray[np.bool_]:
        """Whether each row has a solution, shape (n,)."""
        return np.asarray(self.reasons == "none")


@dataclass(frozen=True)
class MotionSolution(Solution):
    """The result of `inverse_motion`: a Solution with velocities and accelerations of the axes."""

    velocities: Array  # (n, axes), mm/s or deg/s
    accelerations: Array  # (n, axes), mm/s² or deg/s²


class ToolMotion(NamedTuple):
    """Poses of the tool with its velocities and accelerations; angular ones are about X, Y, Z of the reference
    frame."""

    poses: Array  # (n, 6), mm and deg
    velocities: Array  # (n, 6), mm/s and deg/s
    accelerations: Array  # (n, 6), mm/s² and deg/s²


class Kinematics:
    """One mechanism, with the parameters of a machine file: Kinematics(scara={"first_arm": 325, ...}).

    mechanism: exactly one of gantry, core_xy, scara, delta, six_axis, serial.
    joints: per axis, its zero position and whether its direction is inverted, as in a machine file; empty: defaults.
    folder: base of relative file names (`serial`).

    Raises takt.ConfigError if the parameters are wrong."""

    def __init__(
        self,
        *,
        folder: str | Path = ".",
        joints: Sequence[Mapping[str, Any]] = (),
        **mechanism: Mapping[str, Any],
    ) -> None:
        params: dict[str, Any] = dict(mechanism)
        if joints:
            params["joints"] = [dict(joint) for joint in joints]
        self._core = _core.Mechanism(to_json(params), shown(folder))

    @property
    def axes(self) -> int:
        """Number of axes."""
        return self._core.axes

    @property
    def rotary(self) -> tuple[bool, ...]:
        """Whether each axis is rotary, with positions in [deg]."""
        return tuple(self._core.rotary)

    @property
    def ranges(self) -> Array:
        """Lower and upper limit of each axis [mm] or [deg], shape (axes, 2); infinite without limits. Settable."""
        return self._core.ranges

    @ranges.setter
    def ranges(self, ranges: npt.ArrayLike) -> None:
        self._core.ranges = np.asarray(ranges, float)

    def forward(self, joints: npt.ArrayLike) -> Array:
        """Returns the poses [mm, deg], shape (n, 6), of positions of the axes [mm or deg], shape (n, axes). Raises
        KinematicsError if a row has no pose (the arms of a delta do not meet)."""
        rows, single = _rows(joints, self.axes)
        poses, reasons = self._core.forward(rows)
        _raise_first(reasons)
        return _like(poses, single)

    def forward_motion(
        self, joints: npt.ArrayLike, velocities: npt.ArrayLike, accelerations: npt.ArrayLike
    ) -> ToolMotion:
        """Returns the motion of the tool for positions [mm or deg], velocities [per s] and accelerations [per s²] of
        the axes, each of shape (n, axes). Raises KinematicsError if a row has no pose (the arms of a delta do not
        meet)."""
        rows, single = _rows(joints, self.axes)
        poses, rates, changes, reasons = self._core.forward_motion(
            rows, _rows(velocities, self.axes)[0], _rows(accelerations, self.axes)[0]
        )
        _raise_first(reasons)
        return ToolMotion(_like(poses, single), _like(rates, single), _like(changes, single))

    def inverse(
        self,
        poses: npt.ArrayLike,
        near: npt.ArrayLike | None = None,
        *,
        path: bool = False,
        shoulder: Shoulder = "keep",
        elbow: Bend = "keep",
        wrist: Bend = "keep",
    ) -> Solution:
        """Returns the positions of the axes for poses [mm, deg], shape (n, 6); never raises KinematicsError.

        near: current positions of the axes, shape (axes,) or (n, axes); None: near the middle of their ranges.
        path: the poses form one path: each is solved from the one before, so that no axis jumps.
        shoulder, elbow, wrist: the branch, as in Configuration.
        """
        rows, _ = _rows(poses, 6)
        wanted = _configuration(shoulder, elbow, wrist)
        joints, reasons = self._core.inverse(rows, self._near(near), wanted, path)
        return Solution(joints, _names(reasons))

    def inverse_motion(
        self,
        poses: npt.ArrayLike,
        velocities: npt.ArrayLike,
        accelerations: npt.ArrayLike,
        near: npt.ArrayLike | None = None,
        *,
        path: bool = False,
        shoulder: Shoulder = "keep",
        elbow: Bend = "keep",
        wrist: Bend = "keep",
    ) -> MotionSolution:
        """As `inverse`, also for velocities [mm/s, deg/s] and accelerations [mm/s², deg/s²] of the tool, each of shape
        (n, 6)."""
        rows, _ = _rows(poses, 6)
        wanted = _configuration(shoulder, elbow, wrist)
        joints, rates, changes, reasons = self._core.inverse_motion(
            rows, _rows(velocities, 6)[0], _rows(accelerations, 6)[0], self._near(near), wanted, path
        )
        return MotionSolution(joints, _names(reasons), rates, changes)

    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """Returns the Jacobian matrices, shape (n, 6, axes): the velocity of the tool [mm/s, deg/s about X, Y, Z] for
        1 mm/s or deg/s of each axis. Raises KinematicsError if a row has no pose."""
        rows, single = _rows(joints, self.axes)
        matrices, reasons = self._core.jacobian(rows)
        _raise_first(reasons)
        return _like(matrices, single)

    @property
    def links(self) -> tuple[str, ...]:
        """The names of the links, from the base to the tool."""
        return tuple(self._core.links)

    def link_places(self, joints: npt.ArrayLike) -> Array:
        """Returns the end points [mm] of each link, shape (n, links, 6): X, Y, Z of its start, at its own axis, and of
        its end, at the next axis; equal for links without an extent. Raises KinematicsError if a row has no pose (the
        arms of a delta do not meet)."""
        rows, single = _rows(joints, self.axes)
        places, reasons = self._core.link_places(rows)
        _raise_first(reasons)
        return _like(places, single)

    @property
    def link_spans(self) -> Array:
        """The position [mm] of the next axis in the frame of each link, shape (links, 3); 0 for links without an
        extent."""
        return self._core.link_spans

    def link_frames(self, joints: npt.ArrayLike) -> Array:
        """Returns the pose of each link in the base frame as a homogeneous matrix [mm], shape (n, links, 4, 4). Raises
        KinematicsError if a row has no pose (the arms of a delta do not meet)."""
        rows, single = _rows(joints, self.axes)
        upper, reasons = self._core.link_frames(rows)
        _raise_first(reasons)
        frames = np.zeros((*upper.shape[:2], 4, 4))
        frames[:, :, :3] = upper.reshape(*upper.shape[:2], 3, 4)
        frames[:, :, 3, 3] = 1.0
        return _like(frames, single)

    def configuration(self, joints: npt.ArrayLike) -> Configuration:
        """Returns the branch of one position of the axes, shape (axes,); "keep" where the mechanism has no choice."""
        return Configuration(*self._core.configuration(_rows(joints, self.axes)[0]))  # type: ignore[arg-type]

    def _near(self, near: npt.ArrayLike | None) -> Array:
        return np.full((1, self.axes), np.nan) if near is None else _rows(near, self.axes)[0]


def pose_to_matrix(poses: npt.ArrayLike) -> Array:
    """Returns the homogeneous matrices [mm], shape (n, 4, 4), of poses [mm, deg], shape (n, 6)."""
    rows, single = _rows(poses, 6)
    return _like(_core.poses_to_matrices(rows), single)


def matrix_to_pose(matrices: npt.ArrayLike) -> Array:
    """Returns the poses [mm, deg], shape (n, 6), of homogeneous matrices [mm], shape (n, 4, 4). B is in [-90, 90]; with
    B = ±90, A is 0."""
    array = np.asarray(matrices, float)
    single = array.ndim == 2
    return _like(_core.matrices_to_poses(array[np.newaxis] if single else array), single)


def interpolate(start: npt.ArrayLike, end: npt.ArrayLike, shares: npt.ArrayLike) -> Array:
    """Returns poses, shape (n, 6), between two poses, shape (6,): positions on the straight line, orientations along
    the great arc. `shares`: fractions of the distance, 0 to 1, shape (n,)."""
    ends = np.concatenate([_rows(start, 6)[0], _rows(end, 6)[0]])
    return _core.poses_between(ends, np.atleast_1d(np.asarray(shares, float)))


def _rows(values: npt.ArrayLike, columns: int) -> tuple[Array, bool]:
    """Returns the values as rows, and whether they were a single row."""
    array = np.asarray(values, float)
    single = array.ndim == 1
    table = array[np.newaxis] if single else array
    if table.ndim != 2 or table.shape[1] != columns:
        raise ValueError(f"expected rows of {columns} numbers, found an array of shape {array.shape}")
    return table, single


def _like(table: Array, single: bool) -> Array:
    first: Array = table[0] if single else table
    return first


def _names(reasons: npt.NDArray[np.uint8]) -> npt.NDArray[np.str_]:
    return np.array(_REASONS)[reasons]


def _raise_first(reasons: npt.NDArray[np.uint8]) -> None:
    bad = np.flatnonzero(reasons)
    if bad.size:
        raise KinematicsError(int(bad[0]), int(reasons[bad[0]]))


def _configuration(shoulder: str, elbow: str, wrist: str) -> str:
    return json.dumps({"shoulder": shoulder, "elbow": elbow, "wrist": wrist})
