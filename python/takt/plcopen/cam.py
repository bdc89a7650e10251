"""Blocks of cams: tables of the machine that an axis follows over its master's position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from takt import _commands
from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import AxisName, ExecuteBlock, Input, Output, SettingBlock, UpdatedBlock
from takt.plcopen.coupling import CouplingBlock


@dataclass(frozen=True)
class SelectedCam:
    """A cam of the machine and how it is applied to the axes: an output of MC_CamTableSelect and an input of
    MC_CamIn."""

    cam: str
    periodic: bool | None = None  # None: periodic if the cam is cyclic
    master_absolute: bool = True
    slave_absolute: bool = True


class MC_CamTableSelect(SettingBlock):  # noqa: N801
    """Selects the cam of the machine with the name CamTable, from its file or made at run time. CamTableID is for
    MC_CamIn, and keeps its value until another cam is selected. An error if the machine has no such cam.

    ExecutionMode: immediately; delayed: when the command in control of Slave has ended; queued: when all commands given
    to Slave before have ended. A periodic cam counts as ended at its next end."""

    VERB = "cam_table_select"
    Master = Input[Axis | str]("")
    Slave = AxisName()
    CamTable = Input("", "cam")
    Periodic = Input[bool | None](None)
    MasterAbsolute = Input(True)
    SlaveAbsolute = Input(True)
    ExecutionMode = Input(_commands.ExecutionMode.IMMEDIATELY)
    CamTableID = Output[SelectedCam | None](None)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._asked: SelectedCam | None = None
        self._selected: SelectedCam | None = None
        super().__init__(axis, **inputs)

    def _end(self, feedback: Feedback) -> tuple[str, int] | None:
        return None if feedback.done and self._waits(feedback) else super()._end(feedback)

    def _waits(self, feedback: Feedback) -> bool:
        """Returns whether commands given before this one are still in control or waiting, as far as ExecutionMode
        requires it."""
        axis = self.Axis
        mode = self._mode
        if mode is _commands.ExecutionMode.IMMEDIATELY:
            return False
        earlier = 0 < axis.active_command < feedback.ticket
        if mode is _commands.ExecutionMode.DELAYED:
            earlier = earlier and axis.active_command == self._active
        passed = axis.active_command == self._active and axis.profile_ends != self._ends
        return earlier and not (passed and axis.buffered_commands == 0)

    def _command(self) -> Feedback:
        self._mode = self.ExecutionMode
        self._active, self._ends = self.Axis.active_command, self.Axis.profile_ends
        self._asked = SelectedCam(self.CamTable, self.Periodic, self.MasterAbsolute, self.SlaveAbsolute)
        return super()._command()

    def _scan(self) -> None:
        super()._scan()
        self._show(CamTableID=self._selected)

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        if feedback.done and self._ending is not None:
            self._selected = self._asked


class MC_CamIn(CouplingBlock, UpdatedBlock):  # noqa: N801
    """Follows the cam of CamTableID, which is an output of MC_CamTableSelect or the name of a cam. x is Master's
    position times MasterScaling plus MasterOffset, the axis' position y(x) times SlaveScaling plus SlaveOffset.
    EndOfProfile: the end of the cam was passed since the previous call, while this command was in control; also in the
    call in which the next command has taken over."""

    VERB = "cam_in"
    IN_STEP = "InSync"
    Master = Input[Axis | str]("", "master")
    MasterOffset = Input(0.0, "master_offset")
    SlaveOffset = Input(0.0, "slave_offset")
    MasterScaling = Input(1.0, "master_scaling")
    SlaveScaling = Input(1.0, "slave_scaling")
    MasterStartDistance = Input[float | None](None, "master_start_distance")
    MasterSyncPosition = Input[float | None](None, "master_sync_position")
    StartMode = Input(_commands.CamStart.RAMP_IN, "start_mode")
    MasterValueSource = Input(_commands.MasterSource.SET_VALUE, "source")
    CamTableID = Input[SelectedCam | str | None]("")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    InSync = Output(False)
    EndOfProfile = Output(False)

    def _arguments(self) -> dict[str, Any]:
        cam = self.CamTableID
        table = cam if isinstance(cam, SelectedCam) else SelectedCam(cam or "")
        laid = {"master_absolute": table.master_absolute, "slave_absolute": table.slave_absolute}
        return super()._arguments() | laid | {"cam": table.cam, "periodic": table.periodic}

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._ends: int | None = None  # profile_ends in the previous call; None: the command was not in control then
        super().__init__(axis, **inputs)

    def _command(self) -> Feedback:
        self._ends = None
        return super()._command()

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        takes_control = feedback.active and self._ends is None
        if takes_control or (feedback.final and self._ends is not None):
            self.Axis.session._catch_up(feedback.cycle)
        ends = self.Axis.profile_ends
        self._show(EndOfProfile=self._ends is not None and ends != self._ends)
        if takes_control:
            self._ends = ends
        elif self._ends is not None:
            self._ends = None if feedback.final else ends


class MC_CamAdd(SettingBlock):  # noqa: N801
    """Superimposes the cam of CamTableID on that of MC_CamIn, over the same master: SlaveScaling times y(x) plus
    SlaveOffset is added to the slave's position. SlaveAbsolute: added as it is; else less its present value, without a
    step. Up to three cams."""

    VERB = "cam_add"
    Slave = AxisName()
    CamTableID = Input[SelectedCam | str | None]("")
    MasterOffset = Input(0.0, "master_offset")
    SlaveOffset = Input(0.0, "slave_offset")
    MasterScaling = Input(1.0, "master_scaling")
    SlaveScaling = Input(1.0, "slave_scaling")
    MasterAbsolute = Input(True, "master_absolute")
    SlaveAbsolute = Input(False, "slave_absolute")

    def _arguments(self) -> dict[str, Any]:
        cam = self.CamTableID
        name, periodic = (cam.cam, cam.periodic) if isinstance(cam, SelectedCam) else (cam or "", None)
        return super()._arguments() | {"cam": name, "periodic": periodic}


class MC_CamRemove(SettingBlock):  # noqa: N801
    """Removes a superimposed cam; the slave moves to the position without it, within the limits of MC_CamIn."""

    VERB = "cam_remove"
    Slave = AxisName()
    CamTableID = Input[SelectedCam | str | None]("")

    def _arguments(self) -> dict[str, Any]:
        cam = self.CamTableID
        return {"cam": cam.cam if isinstance(cam, SelectedCam) else cam or ""}


class MC_CamOut(ExecuteBlock):  # noqa: N801
    """Leaves the cam; the axis continues with its present velocity."""

    VERB = "cam_out"
    Slave = AxisName()
    Done = Output(False)
