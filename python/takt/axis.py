"""One axis of a session: its commands as methods, what it publishes as properties."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from takt._commands import AxisCommands, AxisOutputs
from takt.component import Component

if TYPE_CHECKING:
    from takt.forecast import Forecast
    from takt.session import Session


class Axis(Component, AxisCommands, AxisOutputs):
    """An axis."""

    KIND = "axis"

    def __init__(self, session: Session, index: int, parameters: Mapping[str, Any]) -> None:
        super().__init__(session, index, parameters)
        self.unit: str = parameters["unit"]  # u: the axis' own unit

    def __repr__(self) -> str:
        return f"<Axis {self.name}: {self.state.value} at {self.actual_position:.6g} {self.unit}>"

    @property
    def rotary(self) -> bool:
        return bool(self.parameters["kind"] == "rotary")

    @property
    def powered(self) -> bool:
        """The position loop is closed."""
        return self.loop_closed

    def forecast(self, verb: str = "", **arguments: Any) -> Forecast:
        """What the motion in progress is going to do, or with a verb and its arguments what that command would if it
        were given now: a dry run, nothing changes. In process only."""
        return self.session._foresee(self, verb, arguments)
