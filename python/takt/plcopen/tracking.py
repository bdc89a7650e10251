"""Blocks that let the tool of a group go along with what moves (PLCopen Part 4). How positions are given stands in
`group`.

MC_TrackConveyorBelt moves the tool by itself, without any other command. InSync says that the tool is in step with the
object; its speed is that of the object only where no move runs on top.
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
    """Over how much of the belt's way the tool gets into step, or out of it, and how far it goes meanwhile; mm. 0: as
    the limits allow."""

    ConveyorDistance: float = 0.0
    TCPDistance: float = 0.0


@dataclass(frozen=True)
class TrackOptions:
    """How the tool gets into step and out of it."""

    SyncIn: SyncDistances = field(default_factory=SyncDistances)
    SyncOut: SyncDistances = field(default_factory=SyncDistances)


def name_of(component: ComponentOrName) -> str:
    """What commands call a component by."""
    return component if isinstance(component, str) else component.name


def tool_numbers(numbers: Numbers) -> Mapping[str, float]:
    """X, Y, Z, A, B, C by name."""
    return by_name(numbers, _commands.CoordinateSystem.MCS)


class TrackingBlock(GroupBlock, ExecuteBlock):
    """A block that lets the tool go along with an object. Done when the object has left where it may be tracked."""

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
    """Takes the tool along with an object on ConveyorBelt, which was at InitialObjectPosition of the belt when the
    belt's axis was at RecordedPosition (None: it is now), as long as the belt has come between StartDistance and
    EndDistance (None: for good) since. Pcs becomes the object's coordinate system. ConveyorBeltOrigin (None: that of
    the machine file) is seen from the machine coordinate system. ConveyorBelt may be its name."""

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
    """The same on RotaryTable, from StartAngle to EndAngle in the sense in which it turns, in deg. SyncInAngle and
    SyncOutAngle: so much of its turn the tool takes to get into step and out of it; 0: as the limits allow."""

    VERB = "track_rotary_table"
    RotaryTable = Input[ComponentOrName]("")
    StartAngle = Input(0.0, "start_angle")
    EndAngle = Input[float | None](None, "end_angle")
    SyncInAngle = Input(0.0, "sync_in_angle")
    SyncOutAngle = Input(0.0, "sync_out_angle")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"table": name_of(self.RotaryTable)}


class MC_SetDynCoordTransform(GroupSetting):  # noqa: N801
    """Lets product coordinate system Pcs of the group go along with MasterAxesGroup: the tool of another group, or a
    belt, a table or a pose; also by name. CoordTransform is where it is on that, of a belt when its axis was at
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
