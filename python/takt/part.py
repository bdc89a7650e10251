"""One part of the surface of a planar motor: a rigid set of stators with one or more positions in a coordinate
system."""

from __future__ import annotations

from takt._commands import PartCommands, PartOutputs
from takt.component import Component


class Part(Component, PartCommands, PartOutputs):
    """A part of the surface."""

    KIND = "part"

    def __repr__(self) -> str:
        index = self.position_index
        where = f"at position {index}" if index else "between positions"
        return f"<Part {self.name}: {self.state.value}, {where}>"
