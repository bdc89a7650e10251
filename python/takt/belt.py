"""One belt of a session: it carries workpieces through the cell."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from takt._commands import BeltCommands, BeltOutputs
from takt.axis import Axis
from takt.component import Component
from takt.counted import counted
from takt.group import Pose

STATES = ("detected", "visible", "taken")


@dataclass(frozen=True)
class BeltObject:
    """The current state of an object on a belt. Its position is unknown until it is visible."""

    number: int  # from 1 in the order of detection, never reused
    state: str  # one of STATES
    place: float  # position along the belt from its origin [mm]; on a turning table [deg]
    pose: Pose  # in the world
    in_range: bool  # within the work range
    kind: int  # kind, colour and quality as reported
    colour: int
    quality: float


class Belt(Component, BeltCommands, BeltOutputs):
    """A belt or a turning table."""

    KIND = "belt"

    def __repr__(self) -> str:
        lying = counted(self.object_count, "object")
        unit = "deg" if self.parameters["kind"] == "turning" else "mm"
        return f"<Belt {self.name}: at {self.position:.6g} {unit}, {self.velocity:.6g} {unit}/s, {lying}>"

    @cached_property
    def axis(self) -> Axis:
        """The axis that moves or measures the belt."""
        return self.session.axis(self.parameters["axis"])

    @property
    def objects(self) -> tuple[BeltObject, ...]:
        """The objects on the belt, in the order of their numbers."""
        rows = self.session._objects(self)
        return tuple(BeltObject(number, STATES[state], *rest) for number, state, *rest in rows)
