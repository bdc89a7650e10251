"""Blocks that move groups of axes along paths, or couple other axes to them (PLCopen Part 4). `group` explains how
positions are given."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from takt import _commands
from takt.feedback import Feedback
from takt.plcopen.base import AxisName, ExecuteBlock, FunctionBlock, Input, MotionBlock, Output
from takt.plcopen.coupling import axis_name
from takt.plcopen.group import AxisOrName, GroupBlock, Numbers, with_numbers

PATH_UNKNOWN = 3026  # error of a command: no such path


class GroupName(AxisName):
    """Another name of the group: PLCopen calls it Master if an axis follows it."""

    def __get__(self, block: FunctionBlock | None, owner: type) -> Any:
        return self if block is None else getattr(block, block.SUBJECT)


class GroupMotionBlock(GroupBlock, ExecuteBlock):
    """A block whose command moves a group, or brakes it, and does not wait for others."""

    Done = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=feedback.active)


class GroupMove(GroupBlock, MotionBlock):
    """A move that other commands can abort and that can wait for others."""

    CoordSystem = Input(_commands.CoordinateSystem.MCS, "coordinate_system")
    Pcs = Input(1, "pcs")
    TransitionMode = Input(_commands.TransitionMode.NONE, "transition_mode")
    TransitionParameter = Input(0.0, "transition_parameter")
    Done = Output(False)


class PathMove(GroupMove):
    """A move with limits along its path."""

    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")


# --- motion ---


class MC_GroupHome(GroupMotionBlock):  # noqa: N801
    """Homes every axis according to the machine file."""

    VERB = "home"


class MC_GroupStop(GroupMotionBlock):  # noqa: N801
    """Brakes to standstill on the path. The group stays in GroupStopping as long as Execute is true, however the
    command ends."""

    VERB = "stop"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"hold": True}

    def _fall(self) -> None:
        if self._feedback is not None:
            self._feedback.release()


class MC_GroupHalt(GroupMotionBlock):  # noqa: N801
    """Brakes to standstill on the path; another move may take over before it is at rest."""

    VERB = "halt"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")


class MC_GroupInterrupt(GroupMotionBlock):  # noqa: N801
    """Brakes to standstill on the path, to be continued by MC_GroupContinue."""

    VERB = "interrupt"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")


class MC_GroupContinue(GroupMotionBlock):  # noqa: N801
    """Continues the interrupted path."""

    VERB = "continue_path"


class MC_MoveLinearAbsolute(PathMove):  # noqa: N801
    """Moves in a straight line to Position."""

    VERB = "move_linear_absolute"
    Position = Input[Numbers](())

    def _arguments(self) -> dict[str, Any]:
        return with_numbers(super()._arguments(), self.Position)


class MC_MoveLinearRelative(PathMove):  # noqa: N801
    """Moves in a straight line by Distance."""

    VERB = "move_linear_relative"
    Distance = Input[Numbers](())

    def _arguments(self) -> dict[str, Any]:
        return with_numbers(super()._arguments(), self.Distance)


def three(argument: str, what: str, numbers: Sequence[float]) -> dict[str, float]:
    """Returns the arguments of a command for X, Y and Z. Raises TypeError unless there are three numbers."""
    if len(numbers) != len("xyz"):
        raise TypeError(f"{what} has 3 numbers, X, Y and Z in mm, found {len(numbers)}: {list(numbers)}")
    return {f"{argument}_{name}": number for name, number in zip("xyz", numbers, strict=True)}


class MC_MoveCircularAbsolute(PathMove):  # noqa: N801
    """Moves along a circle or a helix to EndPoint. AuxPoint is X, Y, Z [mm] of the point that CircMode defines."""

    VERB = "move_circular_absolute"
    CircMode = Input(_commands.CircMode.BORDER, "circ_mode")
    AuxPoint = Input[Sequence[float]]((0.0, 0.0, 0.0))
    EndPoint = Input[Numbers](())
    PathChoice = Input(_commands.PathChoice.COUNTERCLOCKWISE, "path_choice")
    Normal = Input[Sequence[float]]((0.0, 0.0, 0.0))
    Turns = Input(0, "turns")

    def _arguments(self) -> dict[str, Any]:
        vectors = three("aux", "AuxPoint", self.AuxPoint) | three("normal", "Normal", self.Normal)
        return with_numbers(super()._arguments() | vectors, self.EndPoint)


class MC_MoveCircularRelative(MC_MoveCircularAbsolute):  # noqa: N801
    """Moves along a circle or a helix; EndPoint and AuxPoint are relative to its start."""

    VERB = "move_circular_relative"


class MC_MoveDirectAbsolute(GroupMove):  # noqa: N801
    """Moves each axis by itself to Position; all arrive together."""

    VERB = "move_direct_absolute"
    Position = Input[Numbers](())
    CoordSystem = Input(_commands.CoordinateSystem.ACS, "coordinate_system")
    VelFactor = Input(1.0, "velocity_factor")
    AccFactor = Input(1.0, "acceleration_factor")
    JerkFactor = Input(1.0, "jerk_factor")

    def _arguments(self) -> dict[str, Any]:
        return with_numbers(super()._arguments(), self.Position)


class MC_MoveDirectRelative(GroupMove):  # noqa: N801
    """Moves each axis by itself by Distance; all arrive together."""

    VERB = "move_direct_relative"
    Distance = Input[Numbers](())
    CoordSystem = Input(_commands.CoordinateSystem.ACS, "coordinate_system")
    VelFactor = Input(1.0, "velocity_factor")
    AccFactor = Input(1.0, "acceleration_factor")
    JerkFactor = Input(1.0, "jerk_factor")

    def _arguments(self) -> dict[str, Any]:
        return with_numbers(super()._arguments(), self.Distance)


class MC_PathSelect(GroupBlock, FunctionBlock):  # noqa: N801
    """Selects the path PathDescription of the machine file for MC_MovePath: PathData is its name. Done in the same
    call; an Error if the machine has no such path."""

    Execute = Input(False)
    PathDescription = Input("")
    PathData = Output("")
    Done = Output(False)
    Busy = Output(False)

    def _scan(self) -> None:
        if not self.Execute:
            return
        if any(path["name"] == self.PathDescription for path in self.AxesGroup.session.machine["paths"]):
            self._show(Done=True, PathData=self.PathDescription)
        else:
            self._show_error(PATH_UNKNOWN)


class MC_MovePath(PathMove):  # noqa: N801
    """Moves along the path PathData, an output of MC_PathSelect."""

    VERB = "move_path"
    PathData = Input("", "path")


# --- couplings with other axes ---


class MC_SyncAxisToGroup(GroupBlock, ExecuteBlock):  # noqa: N801
    """Couples Slave, which is not a member, to the arc length along the path: RatioNumerator of its unit per
    RatioDenominator mm. Never done: InSync is true while its set point matches the path. Slave may be its name."""

    VERB = "sync_axis"
    Master = GroupName()
    Slave = Input[AxisOrName]("", "axis")
    RatioNumerator = Input(1.0, "ratio_numerator")
    RatioDenominator = Input(1.0, "ratio_denominator")
    InSync = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"axis": axis_name(self.Slave)}

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        in_sync = feedback.active and self.AxesGroup.session.axis(self._given["axis"]).in_step
        self._show(Active=feedback.active, InSync=in_sync)


class MC_MovePathSynchronized(GroupBlock, ExecuteBlock):  # noqa: N801
    """Moves along the path PathData as Master moves: Ratio mm of path per unit of the master. InSync: the group is in
    step. Master is an axis or its name."""

    VERB = "move_path_synchronized"
    PathData = Input("", "path")
    Master = Input[AxisOrName]("", "master")
    Ratio = Input(1.0, "ratio")
    CoordSystem = Input(_commands.CoordinateSystem.MCS, "coordinate_system")
    Pcs = Input(1, "pcs")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    TransitionMode = Input(_commands.TransitionMode.NONE, "transition_mode")
    TransitionParameter = Input(0.0, "transition_parameter")
    InSync = Output(False)
    Done = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"master": axis_name(self.Master)}

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=feedback.active, InSync=feedback.active and self.AxesGroup.synchronized)
