"""Blocks that let the tool of a group track a moving object (PLCopen Part 4). `group` explains how positions are given.

MC_TrackConveyorBelt moves the tool by itself, without any other command. InSync says that the tool is in step with the
object; its speed equals that of the object only while no move is superimposed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from takt import _commands
from takt.component import Component
from takt.feedback import Feedback
from takt.plcopen.base import ExecuteBlock, Input, Output
from takt.plcopen.group import GroupBlock, GroupSetting, Numbers, by_name
from takt.plcopen.group_moves import GroupName

ComponentOrName = Component | str


@dataclass(frozen=True)
class SyncDistances:
    """Travel of the belt over which the tool synchronizes or desynchronizes (ConveyorDistance), and travel of the tool
    meanwhile (TCPDistance) [mm]. 0: as the limits allow."""

    ConveyorDistance: float = 0.0
    TCPDistance: float = 0.0


@dataclass(frozen=True)
class TrackOptions:
    """How the tool synchronizes and desynchronizes."""

    SyncIn: SyncDistances = field(default_factory=SyncDistances)
    SyncOut: SyncDistances = field(default_factory=SyncDistances)


def name_of(component: ComponentOrName) -> str:
    """Returns the name of a component in commands."""
    return component if isinstance(component, str) else component.name


def tool_numbers(numbers: Numbers) -> Mapping[str, float]:
    """Returns X, Y, Z, A, B, C by name."""
    return by_name(numbers, _commands.CoordinateSystem.MCS)


class TrackingBlock(GroupBlock, ExecuteBlock):
    """A block that lets the tool track an object. Done when the object has left the range of tracking."""

    Pcs = Input(1, "pcs")
    InitialObjectPosition = Input[Numbers](())
    RecordedPosition = Input[float | None](None, "recorded_position")
    ExecutionMode = Input(_commands.ExecutionMode.IMMEDIATELY, "execution_mode")
    InSync = Output(False)
    Done = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)

    def _arguments(self) -> dict[str, Any]:
        return {**super()._arguments(), **tool_numbers(self.InitialObjectPosition)}

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        at_once = self._given["execution_mode"] == _commands.ExecutionMode.IMMEDIATELY
        in_sync = feedback.reached and self.AxesGroup.track_state is _commands.TrackState.IN_SYNC
        self._show(Active=feedback.active or at_once, InSync=in_sync)


class MC_TrackConveyorBelt(TrackingBlock):  # noqa: N801
    """Lets the tool track an object on ConveyorBelt, which was at InitialObjectPosition of the belt when the belt's
    axis was at RecordedPosition (None: now), while the travel of the belt since then is between StartDistance and
    EndDistance (None: without end). Pcs becomes the object's coordinate system. ConveyorBeltOrigin (None: that of the
    machine file) is given in the machine coordinate system. ConveyorBelt may be its name."""

    VERB = "track_conveyor_belt"
    ConveyorBelt = Input[ComponentOrName]("")
    ConveyorBeltOrigin = Input[Numbers | None](None)
    StartDistance = Input(0.0, "start_distance")
    EndDistance = Input[float | None](None, "end_distance")
    TrackOptions = Input(TrackOptions())

    def _arguments(self) -> dict[str, Any]:
        arguments = super()._arguments() | {"belt": name_of(self.ConveyorBelt)}
        if self.ConveyorBeltOrigin is not None:
            origin = {"x": 0.0, **tool_numbers(self.ConveyorBeltOrigin)}
            arguments |= {f"origin_{name}": number for name, number in origin.items()}
        for way, distances in (("in", self.TrackOptions.SyncIn), ("out", self.TrackOptions.SyncOut)):
            arguments[f"sync_{way}_conveyor_distance"] = distances.ConveyorDistance
            arguments[f"sync_{way}_tcp_distance"] = distances.TCPDistance
        return arguments


class MC_TrackRotaryTable(TrackingBlock):  # noqa: N801
    """The same on RotaryTable, from StartAngle to EndAngle in the direction in which it turns [deg]. SyncInAngle and
    SyncOutAngle: turn of the table over which the tool synchronizes and desynchronizes; 0: as the limits allow."""

    VERB = "track_rotary_table"
    RotaryTable = Input[ComponentOrName]("")
    StartAngle = Input(0.0, "start_angle")
    EndAngle = Input[float | None](None, "end_angle")
    SyncInAngle = Input(0.0, "sync_in_angle")
    SyncOutAngle = Input(0.0, "sync_out_angle")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"table": name_of(self.RotaryTable)}


class MC_SetDynCoordTransform(GroupSetting):  # noqa: N801
    """Attaches product coordinate system Pcs of the group to MasterAxesGroup: the tool of another group, a belt, a
    table or a pose; also by name. CoordTransform is its pose relative to that, for a belt when its axis was at
    RecordedPosition (None: now)."""

    VERB = "set_dyn_coord_transform"
    SlaveAxesGroup = GroupName()
    MasterAxesGroup = Input[ComponentOrName]("")
    CoordTransform = Input[Numbers](())
    Pcs = Input(1, "pcs")
    RecordedPosition = Input[float | None](None, "recorded_position")

    def _arguments(self) -> dict[str, Any]:
        carrier = {"carrier": name_of(self.MasterAxesGroup)}
        return {**super()._arguments(), **carrier, **tool_numbers(self.CoordTransform)}
