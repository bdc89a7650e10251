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
    """An object on a belt, as it is now. Before it is visible nothing is known of its place."""

    number: int  # from 1 in the order of their detection, never used again
    state: str  # one of STATES
    place: float  # mm along the belt, from its origin; of a table deg
    pose: Pose  # in the world
    in_range: bool  # it lies within the work range
    kind: int  # these three as they were told
    colour: int
    quality: float


class Belt(Component, BeltCommands, BeltOutputs):
    """A belt, or a table that turns."""

    KIND = "belt"

    def __repr__(self) -> str:
        lying = counted(self.object_count, "object")
        unit = "deg" if self.parameters["kind"] == "turning" else "mm"
        return f"<Belt {self.name}: at {self.position:.6g} {unit}, {self.velocity:.6g} {unit}/s, {lying}>"

    @cached_property
    def axis(self) -> Axis:
        """The axis that moves it, or measures it."""
        return self.session.axis(self.parameters["axis"])

    @property
    def objects(self) -> tuple[BeltObject, ...]:
        """What lies on it, in the order of the numbers."""
        rows = self.session._objects(self)
        return tuple(BeltObject(number, STATES[state], *rest) for number, state, *rest in rows)
