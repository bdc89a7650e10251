"""Function block of the digital cam switches."""

from __future__ import annotations

from typing import Any

from takt import _commands
from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import FunctionBlock, Input, Output


class MC_DigitalCamSwitch(FunctionBlock):  # noqa: N801
    """Switches outputs by the position of the axis as long as Enable is true. Switches is the name of a list in the
    machine file, which holds the options of its tracks too; Outputs has a bit for each track. Inputs count when they
    change."""

    Enable = Input(False)
    Switches = Input("", "switches")
    EnableMask = Input(0xFFFFFFFF, "enable_mask")
    ValueSource = Input(_commands.MasterSource.SET_VALUE, "source")
    InOperation = Output(False)
    Busy = Output(False)
    Outputs = Output(0)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._given: dict[str, Any] | None = None  # arguments of the command in force
        self._feedback: Feedback | None = None
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        wanted = self._arguments() if self.Enable else None
        if wanted != self._given:
            self._give(wanted)
        self._given = wanted
        if self._feedback is None:
            return
        if self._feedback.error:
            self._show_error(self._feedback.error_id)
        elif self._feedback.busy:
            works = self._feedback.active
            self._show(Busy=True, InOperation=works, Outputs=self.Axis.cam_outputs if works else 0)

    def _give(self, wanted: dict[str, Any] | None) -> None:
        if wanted is not None:
            self._feedback = self.Axis.session.command(self.Axis.name, "digital_cam_switch", wanted)
        elif self._feedback is not None:
            if self._feedback.busy:
                self.Axis.digital_cam_switch(switches=self._given["switches"] if self._given else "", enable=False)
            self._feedback = None
