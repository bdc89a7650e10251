"""One group of movers of a session: while it is enabled, commands that would lead to a collision are refused."""

from __future__ import annotations

from takt._commands import PlanarGroupCommands, PlanarGroupOutputs
from takt.component import Component
from takt.counted import counted


class PlanarGroup(Component, PlanarGroupCommands, PlanarGroupOutputs):
    """A group of movers. Members are added by a command of their own: `mover.add_to_group(group="cell")`."""

    KIND = "planar_group"

    def __repr__(self) -> str:
        inside = f"{counted(self.mover_count, 'mover')}, {counted(self.track_count, 'track')}"
        return f"<PlanarGroup {self.name}: {self.state.value}, {inside}>"
