"""One group of axes of a session: they move together, along paths of a tool or of their own."""

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
        """Its axes in their places: those of the kinematics first."""
        axes = list(self.session.axes.values())
        return tuple(axes[number - 1] for number in self.places if number)

    @property
    def places(self) -> tuple[int, ...]:
        """For each of the eight places the number of its axis, from 1; 0: none."""
        return tuple(int(self._value(f"member{place}")) for place in range(1, 9))

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """What its workspace knows by name, in the order of their numbers from 1: the tool and its bounds, parts of
        links and gripper, obstacles. Empty without a workspace."""
        text = to_json(self.session.machine).encode()
        return tuple(_core.parts_of_groups(text, "machine").get(self.name, ()))

    @property
    def in_the_way(self) -> tuple[str, ...]:
        """What the last move was refused for: what moves and what it would meet, or the tool and its bound. Empty:
        for neither."""
        numbers = (int(self.first_part), int(self.second_part))
        return tuple(self.parts[number - 1] for number in numbers if number)

    @property
    def zone_names(self) -> tuple[str, ...]:
        """The zones of the machine file that the group has: its tool is there, or is to go there."""
        names = [str(zone["name"]) for zone in self.session.machine.get("zones", [])]
        return tuple(name for i, name in enumerate(names) if int(self.zones) >> i & 1)

    @property
    def waiting(self) -> str:
        """Where it waits and for what: "at zone 'belt' for group 'left'". Empty: it does not wait at a zone."""
        group, zone = int(self.waits_for), int(self.waits_zone)
        if not group:
            return ""
        machine = self.session.machine
        return f"at zone '{machine['zones'][zone - 1]['name']}' for group '{machine['groups'][group - 1]['name']}'"

    @property
    def pose(self) -> Pose:
        """Where the tool centre point is commanded to be, in the machine coordinate system."""
        return self.x, self.y, self.z, self.a, self.b, self.c

    @property
    def actual_pose(self) -> Pose:
        """The same as measured."""
        return self.actual_x, self.actual_y, self.actual_z, self.actual_a, self.actual_b, self.actual_c

    def product_system(self, pcs: int) -> Pose:
        """Where product coordinate system `pcs`, from 1 to 16, is now in the machine coordinate system."""
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
        """Sets product coordinate system `pcs` to where measured places of the tool have it, as of a table or a camera,
        and returns it with what is left over (GR-46).

        `measured`: places or poses in the machine coordinate system, as `actual_pose` has them; the turn of a pose is
        not used. Three: the origin, a point on X, a point towards Y. Four: the same three give the directions, the
        fourth one is the origin. With `seen`, the same points by their numbers in the product coordinate system, three
        or more in any order, it is the nearest frame by the sum of squares.

        Raises CalibrationError, and sets nothing, where the points define no frame or one of them is further off than
        `largest_residual` (mm).
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
        """Where the machine coordinate system is in the world, as the machine file says."""
        return self._given("base")

    @property
    def tool(self) -> Pose:
        """Where the tool centre point is on the flange: as `set_tool` said, or the machine file."""
        x, y, z, a, b, c = (float(self._value(f"tool_{number}")) for number in POSE)
        return x, y, z, a, b, c

    def _given(self, key: str) -> Pose:
        x, y, z, a, b, c = (float(self.parameters[key][number]) for number in POSE)
        return x, y, z, a, b, c


def _places(points: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """X, Y, Z of each place or pose."""
    try:
        rows = np.atleast_2d(np.asarray(points, dtype=float))
    except (TypeError, ValueError):
        raise calibrate.CalibrationError("points: expected rows of three numbers, or of six of a pose") from None
    return rows[:, :3] if rows.ndim == 2 and rows.shape[1] == len(POSE) else rows
