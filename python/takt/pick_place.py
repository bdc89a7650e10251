"""One pick and place module of a session: it moves a group between static targets and workpieces on belts."""

from __future__ import annotations

import yaml

from takt._commands import PickPlaceCommands, PickPlaceOutputs
from takt.belt import Belt
from takt.component import Component
from takt.feedback import Feedback
from takt.group import Group

PARAMETER = 5  # error number: an argument is out of range
SYSTEMS = {"target_coordinate_system", "target_pcs", "workpiece_pcs1", "workpiece_pcs2"}
LIMITS = {"lower_limit", "upper_limit"}
TURNS = {"turn", "turns", "every"}


def why_refused(error_id: int, verb: str, arguments: str) -> str:
    """Returns the rules that a command may violate together with the current settings; empty if none is known."""
    if error_id != PARAMETER:
        return ""
    asked = yaml.safe_load(arguments) or {}
    rules = []
    if verb == "configure" and asked.keys() & {"workpiece_pcs1", "workpiece_pcs2"}:
        rules.append("workpiece_pcs1 and workpiece_pcs2 must be different: places on two belts are seen from them")
    if verb == "configure" and asked.get("target_coordinate_system") == "acs":
        rules.append("target_coordinate_system must not be acs: targets are places of the tool")
    elif verb == "configure" and asked.keys() & SYSTEMS:
        rules.append(
            "target_pcs must be another one than workpiece_pcs1 and workpiece_pcs2: the target would lie on a workpiece"
        )
    if verb == "configure_belt" and asked.keys() & LIMITS:
        rules.append(
            "upper_limit must lie above lower_limit, and both must overlap the work range of the belt, or both must be "
            "0: the range of the belt alone"
        )
    if verb == "configure_belt" and asked.keys() & (LIMITS | {"leave"}):
        rules.append("leave must be 0 without lower_limit and upper_limit: it counts workpieces behind that range")
        rules.append("leave must be 0, or upper_limit lie below that of the belt, which deletes workpieces beyond it")
    if verb == "configure_belt" and asked.keys() & TURNS:
        rules.append("turns must not lead beyond every: turn + turns - 1 is at most every")
    if verb == "jog" and asked.get("positive") and asked.get("negative"):
        rules.append("positive and negative: expected one of both, found both at once")
    elif verb == "jog":
        rules.append("select_axis: expected what is to be jogged, found none, or X to C of a group without kinematics")
    return "; ".join(rules)


class PickPlace(Component, PickPlaceCommands, PickPlaceOutputs):
    """A pick and place module. Belts are numbered from 1 in the order of its section of the machine file."""

    KIND = "pick_place"

    def __repr__(self) -> str:
        return f"<PickPlace {self.name}: {self.state.value}, {self.picked} picked, {self.placed} placed>"

    @property
    def group(self) -> Group:
        """The group that the module moves."""
        return self.session.group(self.parameters["group"])

    @property
    def belts(self) -> list[Belt]:
        """The belts of the module, in the order of their numbers."""
        return [self.session.belt(belt["belt"]) for belt in self.parameters["belts"]]

    def execute(self, target: int = 0) -> Feedback:
        """Gives a rising edge of `execute`: moves to the static target (0) or to a workpiece on a belt, or continues a
        held path. Returns the feedback."""
        self.control(execute=False)
        return self.control(execute=True, set_target=target)

    def abort(self) -> Feedback:
        """Gives a rising edge of `abort`: discards a held path, or ends a tracking mode after the path in progress.
        Returns the feedback."""
        self.control(abort=False)
        return self.control(abort=True)

    def ack_gripper(self) -> Feedback:
        """Gives a rising edge of `ack_gripper`: the tool lifts at once. Returns the feedback."""
        self.control(ack_gripper=False)
        return self.control(ack_gripper=True)

    def return_to_path(self) -> Feedback:
        """Gives a rising edge of `return_to_path`: the tool moves back to the pose at which it left its path. Returns
        the feedback."""
        self.control(return_to_path=False)
        return self.control(return_to_path=True)
