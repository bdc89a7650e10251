"""One environment of a session: the surface above which movers levitate."""

from __future__ import annotations

from takt._commands import EnvironmentCommands, EnvironmentOutputs
from takt.component import Component
from takt.counted import counted


class Environment(Component, EnvironmentCommands, EnvironmentOutputs):
    """An environment: stators and the border around them."""

    KIND = "environment"

    def __repr__(self) -> str:
        stators, border = counted(self.stator_count, "stator"), counted(self.border_count, "piece")
        return f"<Environment {self.name}: {stators}, {border} of border>"
