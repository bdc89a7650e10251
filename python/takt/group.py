"""One group of axes of a session: coordinated motion along paths of the tool or of the axes."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from takt import _core, calibrate
from takt._commands import GroupCommands, GroupOutputs
from takt.axis import Axis
from takt.component import Component
from takt.errors import TaktError
from takt.yaml_text import to_json

if TYPE_CHECKING:
    import numpy.typing as npt

PRODUCT_SYSTEMS = 16
POSE = ("x", "y", "z", "a", "b", "c")
Pose = tuple[float, float, float, float, float, float]  # X, Y, Z in mm, A, B, C in deg


class Group(Component, GroupCommands, GroupOutputs):
    """A group of axes."""

    KIND = "group"

    def __repr__(self) -> str:
        return f"<Group {self.name}: {self.state.value} at x {self.x:.6g}, y {self.y:.6g}, z {self.z:.6g} mm>"

    @property
    def members(self) -> tuple[Axis, ...]:
        """The axes of the group, by member position: those of the kinematics first. Unused positions are left out."""
        axes = list(self.session.axes.values())
        return tuple(axes[number - 1] for number in self.places if number)

    @property
    def places(self) -> tuple[int, ...]:
        """The axis number, from 1, at each of the eight member positions; 0: unused."""
        return tuple(int(self._value(f"member{place}")) for place in range(1, 9))

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """The names in its workspace, in the order of their numbers from 1: the tool and its bounds, parts of links and
        gripper, obstacles. Empty without a workspace."""
        text = to_json(self.session.machine).encode()
        return tuple(_core.parts_of_groups(text, "machine").get(self.name, ()))

    @property
    def in_the_way(self) -> tuple[str, ...]:
        """The names of the two parts for which the last move was refused: the moving part and the part that it would
        collide with, or the tool and its bound. Empty: no such refusal."""
        numbers = (int(self.first_part), int(self.second_part))
        return tuple(self.parts[number - 1] for number in numbers if number)

    @property
    def zone_names(self) -> tuple[str, ...]:
        """The names of the zones that the group occupies or has reserved: its tool is inside or will enter."""
        names = [str(zone["name"]) for zone in self.session.machine.get("zones", [])]
        return tuple(name for i, name in enumerate(names) if int(self.zones) >> i & 1)

    @property
    def waiting(self) -> str:
        """The zone at which the group waits, and the group that it waits for: "at zone 'belt' for group 'left'". Empty:
        it does not wait at a zone."""
        group, zone = int(self.waits_for), int(self.waits_zone)
        if not group:
            return ""
        machine = self.session.machine
        return f"at zone '{machine['zones'][zone - 1]['name']}' for group '{machine['groups'][group - 1]['name']}'"

    @property
    def pose(self) -> Pose:
        """The commanded pose of the tool centre point in the machine coordinate system: X, Y, Z [mm], A, B, C [deg]."""
        return self.x, self.y, self.z, self.a, self.b, self.c

    @property
    def actual_pose(self) -> Pose:
        """The actual pose of the tool centre point in the machine coordinate system: X, Y, Z [mm], A, B, C [deg]."""
        return self.actual_x, self.actual_y, self.actual_z, self.actual_a, self.actual_b, self.actual_c

    def product_system(self, pcs: int) -> Pose:
        """Returns the current pose of product coordinate system `pcs` (1 to 16) in the machine coordinate system.
        Raises TaktError for other numbers."""
        if not 1 <= pcs <= PRODUCT_SYSTEMS:
            raise TaktError(f"there are product coordinate systems 1 to {PRODUCT_SYSTEMS}, found {pcs}")
        x, y, z, a, b, c = (float(self._value(f"pcs{pcs}_{number}")) for number in POSE)
        return x, y, z, a, b, c

    def calibrate_product_system(
        self,
        pcs: int,
        measured: npt.ArrayLike,
        *,
        seen: npt.ArrayLike | None = None,
        largest_residual: float | None = None,
    ) -> calibrate.Calibration:
        """Computes product coordinate system `pcs` from measured positions of the tool, as of a table or a camera, sets
        it, and returns it with its residuals (GR-46).

        pcs: 1 to 16.
        measured: positions or poses in the machine coordinate system, as `actual_pose`; the rotation of a pose is not
            used. Three: the origin, a point on X, a point towards Y. Four: the first three give the directions, the
            fourth is the origin.
        seen: the coordinates of the same points in the product coordinate system, three or more points in any order;
            the frame is then the least squares fit. None: `measured` has three or four points as above.
        largest_residual: limit [mm] of the residuals; None: no limit.

        Raises CalibrationError, and sets nothing, if the points define no frame or a residual exceeds
        `largest_residual`.
        """
        self.product_system(pcs)
        places = _places(measured)
        if seen is not None:
            made = calibrate.fit(_places(seen), places)
        elif len(places) in (3, 4):
            made = calibrate.three_points(*places[:3], at=places[3] if len(places) == 4 else None)
        else:
            raise calibrate.CalibrationError(
                f"measured points: expected three or four without seen ones, found {len(places)}"
            )
        if largest_residual is not None and not made.largest <= largest_residual:
            worst = int(np.argmax(made.residuals))
            raise calibrate.CalibrationError(
                f"measured points: point {worst + 1} is {made.largest:.3g} mm from where the frame has it, expected "
                f"up to {largest_residual:g} mm: measure it again"
            )
        self.set_cartesian_transform(pcs=pcs, **dict(zip(POSE, map(float, made.pose), strict=True))).wait()
        return made

    @property
    def base(self) -> Pose:
        """The pose of the machine coordinate system in the world, from the machine file."""
        return self._given("base")

    @property
    def tool(self) -> Pose:
        """The pose of the tool centre point on the flange, as set by `set_tool` or the machine file."""
        x, y, z, a, b, c = (float(self._value(f"tool_{number}")) for number in POSE)
        return x, y, z, a, b, c

    def _given(self, key: str) -> Pose:
        x, y, z, a, b, c = (float(self.parameters[key][number]) for number in POSE)
        return x, y, z, a, b, c


def _places(points: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Returns X, Y, Z of each position or pose."""
    try:
        rows = np.atleast_2d(np.asarray(points, dtype=float))
    except (TypeError, ValueError):
        raise calibrate.CalibrationError("points: expected rows of three numbers, or of six of a pose") from None
    return rows[:, :3] if rows.ndim == 2 and rows.shape[1] == len(POSE) else rows
