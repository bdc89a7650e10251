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
        """Its axes as the machine file has them: those of the kinematics first."""
        return tuple(self.session.axis(name) for name in self.parameters["axes"])

    @property
    def pose(self) -> tuple[float, float, float, float, float, float]:
        """Where the tool centre point is commanded to be: X, Y, Z in mm, A, B, C in deg, in the machine coordinate
        system."""
        return self.x, self.y, self.z, self.a, self.b, self.c
