"""One group of axes of a session: they move together, along paths of a tool or of their own."""

from __future__ import annotations

from takt._commands import GroupCommands, GroupOutputs
from takt.axis import Axis
from takt.component import Component


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

    @property
    def pose(self) -> tuple[float, float, float, float, float, float]:
        """Where the tool centre point is commanded to be: X, Y, Z in mm, A, B, C in deg, in the machine coordinate
        system."""
        return self.x, self.y, self.z, self.a, self.b, self.c

    @property
    def actual_pose(self) -> tuple[float, float, float, float, float, float]:
        """The same as measured."""
        return self.actual_x, self.actual_y, self.actual_z, self.actual_a, self.actual_b, self.actual_c
