"""Frames and kinematics of axes groups, on NumPy arrays.

import takt.kinematics as kin

robot = kin.Kinematics(delta={"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 800})
robot.forward([10, 20, 30])                    # [x, y, z, a, b, c]
robot.inverse([[0, 0, -700, 0, 0, 0]]).joints  # one row a pose

A pose is six numbers: X, Y, Z in mm and A, B, C in degrees. A, B, C turn about X, then Y, then Z of the frame the pose
is given in, which stand still. Positions of axes are in their own units, mm or deg. Wherever an array with a row a pose
goes in, a single row may.
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
    """There is no such position, or no such pose. `row` says which, `reason` why."""

    def __init__(self, row: int, reason: int) -> None:
        self.row = row
        self.reason = _REASONS[reason]
        super().__init__(f"row {row}: {_core.reason_texts()[reason]}")


class Configuration(NamedTuple):
    """Which of several positions of the axes for one pose; "keep": as the axes are that are given as near."""

    shoulder: Shoulder = "keep"
    elbow: Bend = "keep"
    wrist: Bend = "keep"


@dataclass(frozen=True)
class Solution:
    """What `inverse` found: rows of NaN where a reason says why not."""

    joints: Array  # (n, axes), mm or deg
    reasons: npt.NDArray[np.str_]  # (n,), "none" where there is an answer

    @property
    def ok(self) -> npt.NDArray[np.bool_]:
        """(n,): which rows have an answer."""
        return np.asarray(self.reasons == "none")


@dataclass(frozen=True)
class MotionSolution(Solution):
    """The same with velocities and accelerations of the axes."""

    velocities: Array  # (n, axes), mm/s or deg/s
    accelerations: Array  # (n, axes), mm/s² or deg/s²


class ToolMotion(NamedTuple):
    """A tool's pose with its velocity and acceleration, those of turning about X, Y, Z of the frame it is seen from."""

    poses: Array  # (n, 6), mm and deg
    velocities: Array  # (n, 6), mm/s and deg/s
    accelerations: Array  # (n, 6), mm/s² and deg/s²


class Kinematics:
    """One mechanism, with the parameters a machine file would give it: Kinematics(scara={"first_arm": 325, ...}).

    Exactly one of gantry, core_xy, scara, delta, six_axis, serial; `joints` may say for each axis its zero and whether
    it counts the other way round; files (`serial`) are looked for in `folder`. Raises takt.ConfigError."""

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
        """How many axes it has."""
        return self._core.axes

    @property
    def rotary(self) -> tuple[bool, ...]:
        """Which of the axes turn and count in deg."""
        return tuple(self._core.rotary)

    @property
    def ranges(self) -> Array:
        """(axes, 2): where each axis may be, mm or deg; infinite without limits. Can be set."""
        return self._core.ranges

    @ranges.setter
    def ranges(self, ranges: npt.ArrayLike) -> None:
        self._core.ranges = np.asarray(ranges, float)

    def forward(self, joints: npt.ArrayLike) -> Array:
        """The poses (n, 6) in mm and deg of positions (n, axes) in mm or deg. Raises KinematicsError where a Delta's
        arms do not meet."""
        rows, single = _rows(joints, self.axes)
        poses, reasons = self._core.forward(rows)
        _raise_first(reasons)
        return _like(poses, single)

    def forward_motion(
        self, joints: npt.ArrayLike, velocities: npt.ArrayLike, accelerations: npt.ArrayLike
    ) -> ToolMotion:
        """The tool's motion of positions (mm or deg), velocities and accelerations (per s and s²) of the axes, each
        (n, axes). Raises KinematicsError where a Delta's arms do not meet."""
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
        """Where the axes must be for poses (n, 6) in mm and deg.

        `near`: where the axes are, (axes,) or (n, axes); without it they come near the middle of their ranges. `path`:
        the poses are one path, each is solved from the one before and no axis jumps. The rest says which branch."""
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
        """The same with velocities (n, 6; mm/s, deg/s) and accelerations (n, 6; mm/s², deg/s²) of the tool."""
        rows, _ = _rows(poses, 6)
        wanted = _configuration(shoulder, elbow, wrist)
        joints, rates, changes, reasons = self._core.inverse_motion(
            rows, _rows(velocities, 6)[0], _rows(accelerations, 6)[0], self._near(near), wanted, path
        )
        return MotionSolution(joints, _names(reasons), rates, changes)

    def jacobian(self, joints: npt.ArrayLike) -> Array:
        """(n, 6, axes): velocity of the tool (mm/s, deg/s about X, Y, Z) for 1 mm/s or deg/s of each axis."""
        rows, single = _rows(joints, self.axes)
        matrices, reasons = self._core.jacobian(rows)
        _raise_first(reasons)
        return _like(matrices, single)

    @property
    def links(self) -> tuple[str, ...]:
        """Names of the links, from the base to the tool."""
        return tuple(self._core.links)

    def link_places(self, joints: npt.ArrayLike) -> Array:
        """(n, links, 6): X, Y, Z of where each link begins, at its own axis, and where it ends, at the next one, in mm.
        Links without such an extent end where they begin. Raises KinematicsError where a Delta's arms do not meet."""
        rows, single = _rows(joints, self.axes)
        places, reasons = self._core.link_places(rows)
        _raise_first(reasons)
        return _like(places, single)

    @property
    def link_spans(self) -> Array:
        """(links, 3): where the next axis is, seen from each link, in mm; 0 for links without such an extent."""
        return self._core.link_spans

    def link_frames(self, joints: npt.ArrayLike) -> Array:
        """(n, links, 4, 4): where each link is, seen from the base, as a homogeneous matrix in mm. Raises
        KinematicsError where a Delta's arms do not meet."""
        rows, single = _rows(joints, self.axes)
        upper, reasons = self._core.link_frames(rows)
        _raise_first(reasons)
        frames = np.zeros((*upper.shape[:2], 4, 4))
        frames[:, :, :3] = upper.reshape(*upper.shape[:2], 3, 4)
        frames[:, :, 3, 3] = 1.0
        return _like(frames, single)

    def configuration(self, joints: npt.ArrayLike) -> Configuration:
        """Which branch one position (axes,) is in; "keep" for what the mechanism has no choice of."""
        return Configuration(*self._core.configuration(_rows(joints, self.axes)[0]))  # type: ignore[arg-type]

    def _near(self, near: npt.ArrayLike | None) -> Array:
        return np.full((1, self.axes), np.nan) if near is None else _rows(near, self.axes)[0]


def pose_to_matrix(poses: npt.ArrayLike) -> Array:
    """Homogeneous matrices (n, 4, 4), in mm, of poses (n, 6) in mm and deg."""
    rows, single = _rows(poses, 6)
    return _like(_core.poses_to_matrices(rows), single)


def matrix_to_pose(matrices: npt.ArrayLike) -> Array:
    """Poses (n, 6) in mm and deg of homogeneous matrices (n, 4, 4) in mm. B is in [-90, 90]; with B = ±90 A is 0."""
    array = np.asarray(matrices, float)
    single = array.ndim == 2
    return _like(_core.matrices_to_poses(array[np.newaxis] if single else array), single)


def interpolate(start: npt.ArrayLike, end: npt.ArrayLike, shares: npt.ArrayLike) -> Array:
    """Poses (n, 6) on the straight line from one pose (6,) to another, turning along the great arc: `shares` (n,) of
    the way, 0 to 1."""
    ends = np.concatenate([_rows(start, 6)[0], _rows(end, 6)[0]])
    return _core.poses_between(ends, np.atleast_1d(np.asarray(shares, float)))


def _rows(values: npt.ArrayLike, columns: int) -> tuple[Array, bool]:
    """As rows, and whether it was a single one."""
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
