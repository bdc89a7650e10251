"""One externally supplied pose of a session: clients set it by commands."""

from __future__ import annotations

from takt._commands import PoseCommands, PoseOutputs
from takt.component import Component


class FreePose(Component, PoseCommands, PoseOutputs):
    """A pose from elsewhere; groups can go along with it."""

    KIND = "pose"

    def __repr__(self) -> str:
        x, y, z, *_ = self.pose
        return f"<FreePose {self.name}: x {x:.6g}, y {y:.6g}, z {z:.6g} mm>"
