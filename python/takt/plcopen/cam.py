"""Blocks of cams: tables of the machine that an axis follows over its master's position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from takt import _commands
from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import AxisName, ExecuteBlock, Input, Output, SettingBlock
from takt.plcopen.coupling import CouplingBlock


@dataclass(frozen=True)
class SelectedCam:
    """A cam of the machine and how it is to be laid over the axes: what MC_CamTableSelect gives and MC_CamIn takes."""

    cam: str
    periodic: bool | None = None  # None: as the cam says
    master_absolute: bool = True
    slave_absolute: bool = True


class MC_CamTableSelect(SettingBlock):  # noqa: N801
    """Selects the cam of the machine whose name is CamTable. CamTableID is for MC_CamIn, and stays what it is until
    another cam is selected. An error if the machine has no such cam."""

    VERB = "cam_table_select"
    Master = Input[Axis | str]("")
    Slave = AxisName()
    CamTable = Input("", "cam")
    Periodic = Input[bool | None](None)
    MasterAbsolute = Input(True)
    SlaveAbsolute = Input(True)
    CamTableID = Output[SelectedCam | None](None)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._asked: SelectedCam | None = None
        self._selected: SelectedCam | None = None
        super().__init__(axis, **inputs)

    def _command(self) -> Feedback:
        self._asked = SelectedCam(self.CamTable, self.Periodic, self.MasterAbsolute, self.SlaveAbsolute)
        return super()._command()

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        if feedback.done:
            self._selected = self._asked
        self._show(CamTableID=self._selected)


class MC_CamIn(CouplingBlock):  # noqa: N801
    """Follows the cam of CamTableID, which MC_CamTableSelect gives; a plain name of a cam is one, too. x is Master's
    position times MasterScaling plus MasterOffset, the axis' place y(x) times SlaveScaling plus SlaveOffset.
    EndOfProfile: the end of the cam was passed since the call before."""

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

    def _command(self) -> Feedback:
        self._ends = self.Axis.profile_ends
        return super()._command()

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(EndOfProfile=feedback.active and self.Axis.profile_ends != self._ends)
        self._ends = self.Axis.profile_ends


class MC_CamOut(ExecuteBlock):  # noqa: N801
    """Leaves the cam; the axis goes on with the velocity it has."""

    VERB = "cam_out"
    Slave = AxisName()
    Done = Output(False)
