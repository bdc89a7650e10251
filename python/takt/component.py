"""One component of a session's machine: its commands as methods, its published values as properties."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from takt.feedback import Feedback
    from takt.session import Session


class Component:
    """Base class of components of all kinds. Properties are values of the last cycle (in process) or of the last
    message (over LCM)."""

    KIND: ClassVar[str]  # the engine's name of the kind

    def __init__(self, session: Session, index: int, parameters: Mapping[str, Any]) -> None:
        self.session = session
        self.index = index  # among all components of the machine
        self.name: str = parameters["name"]
        self.parameters = parameters  # of the machine file, including defaults

    def _repr_html_(self) -> str:
        from takt.notebook import component_table

        return component_table(self)

    def _command(self, verb: str, arguments: Mapping[str, Any]) -> Feedback:
        return self.session.command(self.name, verb, arguments)

    def _value(self, field: str) -> Any:
        return self.session._value(self, field)
