"""One component of a session's machine: its commands as methods, what it publishes as properties."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from takt.feedback import Feedback
    from takt.session import Session


class Component:
    """What components of all kinds have in common. Properties are those of the last cycle (in process) or of the last
    message (over LCM)."""

    KIND: ClassVar[str]  # as the engine calls it

    def __init__(self, session: Session, index: int, parameters: Mapping[str, Any]) -> None:
        self.session = session
        self.index = index  # among all components of the machine
        self.name: str = parameters["name"]
        self.parameters = parameters  # all of the machine file's, with the defaults

    def _repr_html_(self) -> str:
        from takt.notebook import component_table

        return component_table(self)

    def _command(self, verb: str, arguments: Mapping[str, Any]) -> Feedback:
        return self.session.command(self.name, verb, arguments)

    def _value(self, field: str) -> Any:
        return self.session._value(self, field)
