"""Blocks for groups of axes (PLCopen Part 4).

Position, Distance, AuxPoint and EndPoint are what CoordSystem says: a1, a2 ... of the axes with ACS, else X, Y, Z in mm
and A, B, C in degrees of the tool. They are given as a sequence in this order, which may be shorter, with None for what
stays; or by name, {"x": 10, "a4": 90}, which is how auxiliary axes are given together with the tool.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from takt import _commands
from takt.axis import Axis
from takt.engine import error_text
from takt.feedback import Feedback
from takt.group import POSE, PRODUCT_SYSTEMS, Group
from takt.kinematics import Array, matrix_to_pose, pose_to_matrix
from takt.plcopen.base import (
    PARAMETER,
    ExecuteBlock,
    FunctionBlock,
    Input,
    Output,
    ReadBlock,
    SettingBlock,
    found_no_room,
)
from takt.plcopen.coupling import axis_name

Numbers = Sequence[float | None] | Mapping[str, float]
AxisOrName = Axis | str

# Errors of commands.
NO_MEMBER = 1003  # there is no such member
STATE = 3005  # not legal in this state
AXES = tuple(f"a{place}" for place in range(1, 9))
# The tool goes along with an object, or gets into step with it or out of it.
RIDING = frozenset(_commands.TrackState) - {_commands.TrackState.NONE, _commands.TrackState.WAITING}


def by_name(numbers: Numbers, system: _commands.CoordinateSystem) -> dict[str, float]:
    """Arguments of a command from what is given for a position."""
    if isinstance(numbers, Mapping):
        return dict(numbers)
    names = AXES if system is _commands.CoordinateSystem.ACS else POSE
    if len(numbers) > len(names):
        raise TypeError(f"a position has up to {len(names)} numbers with {system}, found {len(numbers)}")
    return {name: number for name, number in zip(names, numbers, strict=False) if number is not None}


class GroupBlock(FunctionBlock):
    """What blocks for groups have in common."""

    SUBJECT: ClassVar[str] = "AxesGroup"
    AxesGroup: Group

    if TYPE_CHECKING:

        def __init__(self, subject: Group, **inputs: Any) -> None: ...


class GroupSetting(GroupBlock, SettingBlock):
    """A block whose command moves nothing."""


def with_numbers(arguments: Mapping[str, Any], numbers: Numbers) -> dict[str, Any]:
    """The arguments of a command with those of a position."""
    return {**arguments, **by_name(numbers, arguments["coordinate_system"])}


# --- members and states ---


class MC_AddAxisToGroup(GroupSetting):  # noqa: N801
    """Takes an axis into a group at the place IdentInGroup. Axis may be its name."""

    VERB = "add_axis"
    Axis = Input[AxisOrName]("", "axis")  # type: ignore[assignment]
    IdentInGroup = Input(1, "ident")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"axis": axis_name(self.Axis)}


class MC_RemoveAxisFromGroup(GroupSetting):  # noqa: N801
    """Takes the axis at the place IdentInGroup out of a group."""

    VERB = "remove_axis"
    IdentInGroup = Input(1, "ident")


class MC_UngroupAllAxes(GroupSetting):  # noqa: N801
    """Takes all axes out of a group; it is disabled then."""

    VERB = "ungroup_all_axes"


class MC_GroupReadConfiguration(GroupBlock, ReadBlock):  # noqa: N801
    """Which axis is at the place IdentInGroup; an Error where there is none. Axis is an output."""

    IdentInGroup = Input(1)
    Axis = Output["Axis | None"](None)  # type: ignore[assignment]

    def _read(self) -> None:
        places = self.AxesGroup.places
        if not 1 <= self.IdentInGroup <= len(places) or not places[self.IdentInGroup - 1]:
            self._show(Valid=False)
            return self._show_error(PARAMETER if not 1 <= self.IdentInGroup <= len(places) else NO_MEMBER)
        axes = list(self.AxesGroup.session.axes.values())
        return self._show(Axis=axes[places[self.IdentInGroup - 1] - 1])


class MC_GroupEnable(GroupSetting):  # noqa: N801
    """From GroupDisabled to GroupStandby."""

    VERB = "enable"


class MC_GroupDisable(GroupSetting):  # noqa: N801
    """To GroupDisabled; the axes take commands of their own again."""

    VERB = "disable"


class MC_GroupReset(GroupBlock, ExecuteBlock):  # noqa: N801
    """Clears the faults of a group and of its axes."""

    VERB = "reset"
    Done = Output(False)

    def _end(self, feedback: Feedback) -> tuple[str, int] | None:
        if not feedback.aborted:
            return super()._end(feedback)
        group = self.AxesGroup  # another reset took over
        group.session._catch_up(feedback.cycle)
        return ("Error", group.error) if group.error else ("Done", 0)


class GT_GroupPower(GroupBlock, ExecuteBlock):  # noqa: N801
    """Switches the drives of all members on, or with On false off."""

    VERB = "power"
    On = Input(True, "enable")
    Done = Output(False)
    CommandAborted = Output(False)


class MC_GroupReadStatus(GroupBlock, ReadBlock):  # noqa: N801
    """The state of a group, one output for each; how the speed along its path changes; whether it stands and has
    nothing to do. SynchronizedMotion: the tool goes along with what moves, gets into step with it or out of it; or its
    path follows a master. DiscreteMotion: a move is in control, also one on what moves, or the tool comes to rest."""

    GroupMoving = Output(False)
    GroupHoming = Output(False)
    GroupErrorStop = Output(False)
    GroupDisabled = Output(False)
    GroupStopping = Output(False)
    GroupStandby = Output(False)
    ConstantVelocity = Output(False)
    Accelerating = Output(False)
    Decelerating = Output(False)
    InPosition = Output(False)
    SynchronizedMotion = Output(False)
    DiscreteMotion = Output(False)

    def _read(self) -> None:
        group = self.AxesGroup
        speed, change = group.path_velocity, group.path_acceleration
        self._show(**{group.state.value: True}, InPosition=group.in_position)
        self._show(ConstantVelocity=speed > 0 and change == 0, Accelerating=change > 0, Decelerating=change < 0)
        if group.state is _commands.GroupState.GROUP_MOVING:
            rides = group.track_state in RIDING
            self._show(SynchronizedMotion=rides or group.synchronized, DiscreteMotion=bool(group.command) or not rides)


class MC_GroupReadError(GroupBlock, ReadBlock):  # noqa: N801
    """Why a group is in GroupErrorStop, by number; 0: it is not. Error and ErrorID say that, too."""

    GroupErrorID = Output(0)

    def _read(self) -> None:
        error_id = self.AxesGroup.error
        self._show(GroupErrorID=error_id, Error=error_id != 0, ErrorID=error_id)

    @property
    def text(self) -> str:
        """The error for people; empty without one."""
        return error_text(self.GroupErrorID) if self.GroupErrorID else ""


# --- where it is ---


def system_frame(group: Group, system: _commands.CoordinateSystem, pcs: int) -> Array | None:
    """Where a coordinate system is in the machine coordinate system; None: there is none of this number, or it is
    that of the axes."""
    if system is _commands.CoordinateSystem.MCS:
        return pose_to_matrix([0.0] * len(POSE))
    if system is _commands.CoordinateSystem.WCS:
        return np.asarray(np.linalg.inv(pose_to_matrix(group.base)), np.float64)
    if system is _commands.CoordinateSystem.PCS and 1 <= pcs <= PRODUCT_SYSTEMS:
        return pose_to_matrix(group.product_system(pcs))
    return None


def seen_from(frame: Array, pose: Sequence[float]) -> tuple[float, ...]:
    """A pose in the machine coordinate system, seen from a coordinate system that is there."""
    return tuple(map(float, matrix_to_pose(np.linalg.inv(frame) @ pose_to_matrix(pose))))


class GroupReadBlock(GroupBlock, ReadBlock):
    """A block that shows numbers of a group, seen from CoordSystem."""

    CoordSystem = Input(_commands.CoordinateSystem.ACS)
    Pcs = Input(1)

    def _read(self) -> None:
        group, system = self.AxesGroup, self.CoordSystem
        if system is _commands.CoordinateSystem.ACS:
            return self._of_axes(group.members)
        frame = system_frame(group, system, self.Pcs)
        if frame is None or not group.kinematics_on:
            self._show(Valid=False)
            return self._show_error(PARAMETER if frame is None else STATE)
        return self._of_tool(group, frame)

    def _of_axes(self, members: Sequence[Axis]) -> None:
        raise NotImplementedError

    def _of_tool(self, group: Group, frame: Array) -> None:
        raise NotImplementedError


class MC_GroupReadActualPosition(GroupReadBlock):  # noqa: N801
    """Where a group is as measured: each axis with ACS; X, Y, Z, A, B, C of the tool with MCS, WCS and PCS."""

    Position = Output[tuple[float, ...]](())

    def _of_axes(self, members: Sequence[Axis]) -> None:
        self._show(Position=tuple(axis.actual_position for axis in members))

    def _of_tool(self, group: Group, frame: Array) -> None:
        self._show(Position=seen_from(frame, group.actual_pose))


class MC_GroupReadActualVelocity(GroupReadBlock):  # noqa: N801
    """How fast a group is as measured: each axis with ACS; else PathVelocity, the speed of the tool."""

    Velocity = Output[tuple[float, ...]](())
    PathVelocity = Output(0.0)

    def _of_axes(self, members: Sequence[Axis]) -> None:
        self._show(Velocity=tuple(axis.actual_velocity for axis in members))

    def _of_tool(self, group: Group, frame: Array) -> None:
        self._show(PathVelocity=group.actual_velocity)


class MC_GroupReadActualAcceleration(GroupReadBlock):  # noqa: N801
    """How a group accelerates, as it is told to: nothing measures it. Each axis with ACS; else PathAcceleration, that
    of the tool."""

    Acceleration = Output[tuple[float, ...]](())
    PathAcceleration = Output(0.0)

    def _of_axes(self, members: Sequence[Axis]) -> None:
        self._show(Acceleration=tuple(axis.set_acceleration for axis in members))

    def _of_tool(self, group: Group, frame: Array) -> None:
        self._show(PathAcceleration=group.acceleration)


class MC_GroupSetPosition(GroupSetting):  # noqa: N801
    """Gives where a group stands other numbers."""

    VERB = "define_position"
    Position = Input[Numbers](())
    CoordSystem = Input(_commands.CoordinateSystem.ACS, "coordinate_system")
    Pcs = Input(1, "pcs")

    def _arguments(self) -> dict[str, Any]:
        return with_numbers(super()._arguments(), self.Position)


class MC_GroupSetOverride(GroupBlock, FunctionBlock):  # noqa: N801
    """As long as Enable is true, the factors are in force, also when they change; afterwards they stay."""

    Enable = Input(False)
    VelFactor = Input(1.0, "velocity_factor")
    AccFactor = Input(1.0, "acceleration_factor")
    JerkFactor = Input(1.0, "jerk_factor")
    Enabled = Output(False)
    Busy = Output(False)

    def __init__(self, subject: Group, **inputs: Any) -> None:
        self._feedback: Feedback | None = None
        self._given: dict[str, Any] = {}
        super().__init__(subject, **inputs)

    def _scan(self) -> None:
        if not self.Enable:
            self._feedback = None
            return
        wanted = self._arguments()
        if self._feedback is None or wanted != self._given or found_no_room(self._feedback):
            self._given = wanted
            self._feedback = self.AxesGroup.session.command(self.AxesGroup.name, "set_override", wanted)
        if self._feedback.error:
            self._show_error(self._feedback.error_id, self._feedback.sentence)
        else:
            self._show(Enabled=self._feedback.done, Busy=True)


# --- coordinate systems ---


class MC_SetKinTransform(GroupSetting):  # noqa: N801
    """Switches the kinematics of the machine file on or off; KinTransform is which: true or false."""

    VERB = "set_kin_transform"
    KinTransform = Input(True, "enable")


class MC_ReadKinTransform(GroupBlock, ReadBlock):  # noqa: N801
    """Whether there are kinematics that are switched on."""

    KinTransform = Output(False)

    def _read(self) -> None:
        self._show(KinTransform=self.AxesGroup.kinematics_on)


class MC_SetCartesianTransform(GroupSetting):  # noqa: N801
    """Says where product coordinate system Pcs is in the machine coordinate system: mm, and degrees about X, Y, Z."""

    VERB = "set_cartesian_transform"
    TransX = Input(0.0, "x")
    TransY = Input(0.0, "y")
    TransZ = Input(0.0, "z")
    RotAngle1 = Input(0.0, "a")
    RotAngle2 = Input(0.0, "b")
    RotAngle3 = Input(0.0, "c")
    Pcs = Input(1, "pcs")


class MC_SetCoordinateTransform(GroupSetting):  # noqa: N801
    """Says where product coordinate system Pcs is in another one: CoordTransform is X, Y, Z, A, B, C."""

    VERB = "set_coordinate_transform"
    CoordTransform = Input[Numbers](())
    Pcs = Input(1, "pcs")
    Reference = Input(_commands.CoordinateSystem.MCS, "reference")
    ReferencePcs = Input(1, "reference_pcs")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | by_name(self.CoordTransform, _commands.CoordinateSystem.MCS)


class MC_ReadCoordinateTransform(GroupBlock, ReadBlock):  # noqa: N801
    """Where product coordinate system Pcs is now in another one: X, Y, Z, A, B, C."""

    Pcs = Input(1)
    Reference = Input(_commands.CoordinateSystem.MCS)
    ReferencePcs = Input(1)
    CoordTransform = Output[tuple[float, ...]](())

    def _read(self) -> None:
        group = self.AxesGroup
        reference = system_frame(group, self.Reference, self.ReferencePcs)
        if reference is None or not 1 <= self.Pcs <= PRODUCT_SYSTEMS:
            self._show(Valid=False)
            return self._show_error(PARAMETER)
        pose: tuple[float, ...] = group.product_system(self.Pcs)
        # In the machine coordinate system as it was given, not another pose of the same frame.
        return self._found(pose if self.Reference is _commands.CoordinateSystem.MCS else seen_from(reference, pose))

    def _found(self, pose: tuple[float, ...]) -> None:
        self._show(CoordTransform=pose)


class MC_ReadCartesianTransform(MC_ReadCoordinateTransform):  # noqa: N801
    """The same, number by number."""

    TransX = Output(0.0)
    TransY = Output(0.0)
    TransZ = Output(0.0)
    RotAngle1 = Output(0.0)
    RotAngle2 = Output(0.0)
    RotAngle3 = Output(0.0)

    def _found(self, pose: tuple[float, ...]) -> None:
        super()._found(pose)
        x, y, z, a, b, c = pose
        self._show(TransX=x, TransY=y, TransZ=z, RotAngle1=a, RotAngle2=b, RotAngle3=c)
