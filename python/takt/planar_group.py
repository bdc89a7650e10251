"""One group of movers of a session: while it is enabled, what would collide is refused."""

from __future__ import annotations

from takt._commands import PlanarGroupCommands, PlanarGroupOutputs
from takt.component import Component


class PlanarGroup(Component, PlanarGroupCommands, PlanarGroupOutputs):
    """A group of movers. What is in it is told itself to come into it: `mover.add_to_group(group="cell")`."""

    KIND = "planar_group"

    def __repr__(self) -> str:
        return f"<PlanarGroup {self.name}: {self.state.value}, {self.mover_count} movers, {self.track_count} tracks>"
