"""One part of the surface of a session: stators that movers float on, at one of several positions."""

from __future__ import annotations

from takt._commands import PartCommands, PartOutputs
from takt.component import Component


class Part(Component, PartCommands, PartOutputs):
    """A part of the surface."""

    KIND = "part"

    def __repr__(self) -> str:
        return f"<Part {self.name}: {self.state.value}, at position {self.position_index}>"
