"""One environment of a session: the surface that movers float on."""

from __future__ import annotations

from takt._commands import EnvironmentCommands, EnvironmentOutputs
from takt.component import Component


class Environment(Component, EnvironmentCommands, EnvironmentOutputs):
    """An environment: stators, and the border around them."""

    KIND = "environment"

    def __repr__(self) -> str:
        return f"<Environment {self.name}: {self.stator_count} stators, {self.border_count} pieces of border>"
