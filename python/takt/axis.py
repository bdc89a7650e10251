"""One axis of a session: its commands as methods, its published values as properties."""

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
        self.unit: str = parameters["unit"]  # the axis' position unit, called u elsewhere

    def __repr__(self) -> str:
        return f"<Axis {self.name}: {self.state.value} at {self.actual_position:.6g} {self.unit}>"

    @property
    def rotary(self) -> bool:
        return bool(self.parameters["kind"] == "rotary")

    @property
    def powered(self) -> bool:
        """Whether the position loop is closed."""
        return self.loop_closed

    def forecast(self, verb: str = "", **arguments: Any) -> Forecast:
        """Returns the forecast of the motion in progress or, with a verb and its arguments, of that command as if it
        were given now. A dry run: nothing changes. In process only; raises TaktError over LCM."""
        return self.session._foresee(self, verb, arguments)
