"""One pick and place module of a session: it moves a group between static places and workpieces on belts."""

from __future__ import annotations

from takt._commands import PickPlaceCommands, PickPlaceOutputs
from takt.belt import Belt
from takt.component import Component
from takt.feedback import Feedback
from takt.group import Group


class PickPlace(Component, PickPlaceCommands, PickPlaceOutputs):
    """A pick and place module. Belts are numbered from 1 in the order of its section of the machine file."""

    KIND = "pick_place"

    def __repr__(self) -> str:
        return f"<PickPlace {self.name}: {self.state.value}, {self.picked} picked, {self.placed} placed>"

    @property
    def group(self) -> Group:
        """The group that it moves."""
        return self.session.group(self.parameters["group"])

    @property
    def belts(self) -> list[Belt]:
        """Belts that it knows, in the order of their numbers."""
        return [self.session.belt(belt["belt"]) for belt in self.parameters["belts"]]

    def execute(self, target: int = 0) -> Feedback:
        """A rising edge of execute: to the static target (0) or to a workpiece on a belt; or on with the path held."""
        self.control(execute=False)
        return self.control(execute=True, set_target=target)

    def abort(self) -> Feedback:
        """A rising edge of abort: forgets the path held, or ends a tracking mode behind the path in progress."""
        self.control(abort=False)
        return self.control(abort=True)

    def ack_gripper(self) -> Feedback:
        """A rising edge of ack_gripper: the tool lifts at once."""
        self.control(ack_gripper=False)
        return self.control(ack_gripper=True)

    def return_to_path(self) -> Feedback:
        """A rising edge of return_to_path: the tool moves back to where it left its path."""
        self.control(return_to_path=False)
        return self.control(return_to_path=True)
