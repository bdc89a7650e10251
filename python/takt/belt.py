"""One belt of a session: it carries workpieces through the cell."""

from __future__ import annotations

from takt._commands import BeltCommands, BeltOutputs
from takt.axis import Axis
from takt.component import Component


class Belt(Component, BeltCommands, BeltOutputs):
    """A belt, or a table that turns."""

    KIND = "belt"

    def __repr__(self) -> str:
        return f"<Belt {self.name}: at {self.position:.6g}, {self.velocity:.6g}/s, {self.object_count} objects>"

    @property
    def axis(self) -> Axis:
        """The axis that moves it, or measures it."""
        return self.session.axis(self.parameters["axis"])
