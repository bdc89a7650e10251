"""Blocks for groups of axes (PLCopen Part 4).

CoordSystem determines what Position, Distance, AuxPoint and EndPoint hold: a1, a2 ... of the axes with ACS, else X, Y,
Z [mm] and A, B, C [deg] of the tool. They are given as a sequence in this order, which may be shorter, with None for
unchanged values; or by name, {"x": 10, "a4": 90}, to give auxiliary axes together with the tool.
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
NO_MEMBER = 1003  # no such member
STATE = 3005  # not legal in this state
AXES = tuple(f"a{place}" for place in range(1, 9))
# The tool is in step with an object, or synchronizes or desynchronizes with it.
RIDING = frozenset(_commands.TrackState) - {_commands.TrackState.NONE, _commands.TrackState.WAITING}


def by_name(numbers: Numbers, system: _commands.CoordinateSystem) -> dict[str, float]:
    """Returns the arguments of a command for a position; None values are left out. Raises TypeError if there are more
    numbers than the system has."""
    if isinstance(numbers, Mapping):
        return dict(numbers)
    names = AXES if system is _commands.CoordinateSystem.ACS else POSE
    if len(numbers) > len(names):
        raise TypeError(f"a position has up to {len(names)} numbers with {system}, found {len(numbers)}")
    return {name: number for name, number in zip(names, numbers, strict=False) if number is not None}


class GroupBlock(FunctionBlock):
    """Base of blocks for groups."""

    SUBJECT: ClassVar[str] = "AxesGroup"
    AxesGroup: Group

    if TYPE_CHECKING:

        def __init__(self, subject: Group, **inputs: Any) -> None: ...


class GroupSetting(GroupBlock, SettingBlock):
    """A block whose command causes no motion."""


def with_numbers(arguments: Mapping[str, Any], numbers: Numbers) -> dict[str, Any]:
    """Returns the arguments of a command with those of a position added."""
    return {**arguments, **by_name(numbers, arguments["coordinate_system"])}


# --- members and states ---


class MC_AddAxisToGroup(GroupSetting):  # noqa: N801
    """Adds an axis to a group with number IdentInGroup (1 is a1). Axis may be its name."""

    VERB = "add_axis"
    Axis = Input[AxisOrName]("", "axis")  # type: ignore[assignment]
    IdentInGroup = Input(1, "ident")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"axis": axis_name(self.Axis)}


class MC_RemoveAxisFromGroup(GroupSetting):  # noqa: N801
    """Removes the axis with number IdentInGroup from a group."""

    VERB = "remove_axis"
    IdentInGroup = Input(1, "ident")


class MC_UngroupAllAxes(GroupSetting):  # noqa: N801
    """Removes all axes from a group, which becomes disabled."""

    VERB = "ungroup_all_axes"


class MC_GroupReadConfiguration(GroupBlock, ReadBlock):  # noqa: N801
    """Shows the axis with number IdentInGroup; an Error if there is no such axis. Axis is an output."""

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
    """Switches from GroupDisabled to GroupStandby."""

    VERB = "enable"


class MC_GroupDisable(GroupSetting):  # noqa: N801
    """Switches to GroupDisabled; the axes then accept commands of their own again."""

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
    """Switches the drives of all members on, or off if On is false."""

    VERB = "power"
    On = Input(True, "enable")
    Done = Output(False)
    CommandAborted = Output(False)


class MC_GroupReadStatus(GroupBlock, ReadBlock):  # noqa: N801
    """Shows the state of a group, one output per state; how the speed along its path changes; and InPosition: whether
    it is at rest without a command. SynchronizedMotion: the tool tracks an object, or synchronizes or desynchronizes
    with it; or its path follows a master. DiscreteMotion: a move is in control, also one relative to a tracked object,
    or the tool comes to rest."""

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
    """Shows why a group is in GroupErrorStop, as a number; 0: it is not. Error and ErrorID show it, too."""

    GroupErrorID = Output(0)

    def _read(self) -> None:
        error_id = self.AxesGroup.error
        self._show(GroupErrorID=error_id, Error=error_id != 0, ErrorID=error_id)

    @property
    def text(self) -> str:
        """The error in words; empty without one."""
        return error_text(self.GroupErrorID) if self.GroupErrorID else ""


# --- positions and motion ---


def system_frame(group: Group, system: _commands.CoordinateSystem, pcs: int) -> Array | None:
    """Returns the pose of a coordinate system in the machine coordinate system as a matrix; None if there is none with
    this number, or it is that of the axes."""
    if system is _commands.CoordinateSystem.MCS:
        return pose_to_matrix([0.0] * len(POSE))
    if system is _commands.CoordinateSystem.WCS:
        return np.asarray(np.linalg.inv(pose_to_matrix(group.base)), np.float64)
    if system is _commands.CoordinateSystem.PCS and 1 <= pcs <= PRODUCT_SYSTEMS:
        return pose_to_matrix(group.product_system(pcs))
    return None


def seen_from(frame: Array, pose: Sequence[float]) -> tuple[float, ...]:
    """Returns a pose, given in the machine coordinate system, in the coordinate system `frame`."""
    return tuple(map(float, matrix_to_pose(np.linalg.inv(frame) @ pose_to_matrix(pose))))


class GroupReadBlock(GroupBlock, ReadBlock):
    """A block that shows values of a group in CoordSystem."""

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
    """Shows the actual position of a group: of each axis with ACS; X, Y, Z, A, B, C of the tool with MCS, WCS and
    PCS."""

    Position = Output[tuple[float, ...]](())

    def _of_axes(self, members: Sequence[Axis]) -> None:
        self._show(Position=tuple(axis.actual_position for axis in members))

    def _of_tool(self, group: Group, frame: Array) -> None:
        self._show(Position=seen_from(frame, group.actual_pose))


class MC_GroupReadActualVelocity(GroupReadBlock):  # noqa: N801
    """Shows the actual velocity of a group: of each axis with ACS; else PathVelocity, the speed of the tool [mm/s]."""

    Velocity = Output[tuple[float, ...]](())
    PathVelocity = Output(0.0)

    def _of_axes(self, members: Sequence[Axis]) -> None:
        self._show(Velocity=tuple(axis.actual_velocity for axis in members))

    def _of_tool(self, group: Group, frame: Array) -> None:
        self._show(PathVelocity=group.actual_velocity)


class MC_GroupReadActualAcceleration(GroupReadBlock):  # noqa: N801
    """Shows the acceleration set point of a group (it is not measured): of each axis with ACS; else PathAcceleration,
    that of the tool [mm/s²]."""

    Acceleration = Output[tuple[float, ...]](())
    PathAcceleration = Output(0.0)

    def _of_axes(self, members: Sequence[Axis]) -> None:
        self._show(Acceleration=tuple(axis.set_acceleration for axis in members))

    def _of_tool(self, group: Group, frame: Array) -> None:
        self._show(PathAcceleration=group.acceleration)


class MC_GroupSetPosition(GroupSetting):  # noqa: N801
    """Assigns new numbers to the present position of a group, without motion."""

    VERB = "define_position"
    Position = Input[Numbers](())
    CoordSystem = Input(_commands.CoordinateSystem.ACS, "coordinate_system")
    Pcs = Input(1, "pcs")

    def _arguments(self) -> dict[str, Any]:
        return with_numbers(super()._arguments(), self.Position)


class MC_GroupSetOverride(GroupBlock, FunctionBlock):  # noqa: N801
    """Applies the factors, and their changes, as long as Enable is true; afterwards the last ones stay in force."""

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
    """Switches the kinematics of the machine file on (KinTransform true) or off (false)."""

    VERB = "set_kin_transform"
    KinTransform = Input(True, "enable")


class MC_ReadKinTransform(GroupBlock, ReadBlock):  # noqa: N801
    """Shows whether the group has kinematics that are switched on."""

    KinTransform = Output(False)

    def _read(self) -> None:
        self._show(KinTransform=self.AxesGroup.kinematics_on)


class MC_SetCartesianTransform(GroupSetting):  # noqa: N801
    """Sets the pose of product coordinate system Pcs in the machine coordinate system: mm, and degrees about X, Y,
    Z."""

    VERB = "set_cartesian_transform"
    TransX = Input(0.0, "x")
    TransY = Input(0.0, "y")
    TransZ = Input(0.0, "z")
    RotAngle1 = Input(0.0, "a")
    RotAngle2 = Input(0.0, "b")
    RotAngle3 = Input(0.0, "c")
    Pcs = Input(1, "pcs")


class MC_SetCoordinateTransform(GroupSetting):  # noqa: N801
    """Sets the pose of product coordinate system Pcs in another system: CoordTransform is X, Y, Z, A, B, C."""

    VERB = "set_coordinate_transform"
    CoordTransform = Input[Numbers](())
    Pcs = Input(1, "pcs")
    Reference = Input(_commands.CoordinateSystem.MCS, "reference")
    ReferencePcs = Input(1, "reference_pcs")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | by_name(self.CoordTransform, _commands.CoordinateSystem.MCS)


class MC_ReadCoordinateTransform(GroupBlock, ReadBlock):  # noqa: N801
    """Shows the present pose of product coordinate system Pcs in another system: X, Y, Z, A, B, C."""

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
        # In the machine coordinate system the pose as it was given, not other angles of the same frame.
        return self._found(pose if self.Reference is _commands.CoordinateSystem.MCS else seen_from(reference, pose))

    def _found(self, pose: tuple[float, ...]) -> None:
        self._show(CoordTransform=pose)


class MC_ReadCartesianTransform(MC_ReadCoordinateTransform):  # noqa: N801
    """Shows the same pose, also as one output per number."""

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
