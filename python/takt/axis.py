"""One axis of a session: its commands as methods, what it publishes as properties."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from takt._commands import AxisCommands, AxisOutputs

if TYPE_CHECKING:
    from takt.feedback import Feedback
    from takt.forecast import Forecast
    from takt.session import Session


class Axis(AxisCommands, AxisOutputs):
    """Properties are those of the last cycle (in process) or of the last message (over LCM)."""

    def __init__(self, session: Session, index: int, parameters: Mapping[str, Any]) -> None:
        self.session = session
        self.index = index
        self.name: str = parameters["name"]
        self.unit: str = parameters["unit"]  # u: the axis' own unit
        self.parameters = parameters  # all of the machine file's, with the defaults

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

    def _command(self, verb: str, arguments: Mapping[str, Any]) -> Feedback:
        return self.session.command(self.name, verb, arguments)

    def _value(self, field: str) -> Any:
        return self.session._value(self, field)
