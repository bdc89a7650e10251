"""Function block of the digital cam switches."""

from __future__ import annotations

from typing import Any

from takt import _commands
from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import FunctionBlock, Input, Output, found_no_room


class MC_DigitalCamSwitch(FunctionBlock):  # noqa: N801
    """Switches outputs by the position of the axis as long as Enable is true. Switches is the name of a list in the
    machine file, which also holds the options of its tracks; Outputs has a bit for each track. Inputs take effect when
    they change. While the command queue is full the command is repeated in each call."""

    Enable = Input(False)
    Switches = Input("", "switches")
    EnableMask = Input(0xFFFFFFFF, "enable_mask")
    ValueSource = Input(_commands.MasterSource.SET_VALUE, "source")
    InOperation = Output(False)
    Busy = Output(False)
    Outputs = Output(0)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._given: dict[str, Any] | None = None  # arguments of the last command; None: switched off
        self._feedback: Feedback | None = None  # of the last command
        self._switching: list[tuple[Feedback, str]] = []  # commands that have not ended, with their lists of switches
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        wanted = self._arguments() if self.Enable else None
        self._switching = [(feedback, name) for feedback, name in self._switching if feedback.busy]
        if wanted != self._given or found_no_room(self._feedback):
            self._feedback = self._give(wanted)
        self._given = wanted
        if self._feedback is None:
            return
        if wanted is None and found_no_room(self._feedback):
            self._show(Busy=True, InOperation=True, Outputs=self.Axis.cam_outputs)
        elif self._feedback.error:
            self._show_error(self._feedback.error_id, self._feedback.sentence)
        elif wanted is not None and self._feedback.busy:
            works = self._feedback.active
            self._show(Busy=True, InOperation=works, Outputs=self.Axis.cam_outputs if works else 0)

    def _give(self, wanted: dict[str, Any] | None) -> Feedback | None:
        """Gives the command and returns its feedback. To switch off, only if a command that switches has not ended;
        else None."""
        if wanted is not None:
            feedback = self.Axis.session.command(self.Axis.name, "digital_cam_switch", wanted)
            self._switching.append((feedback, wanted["switches"]))
            return feedback
        if not self._switching:
            return None
        _, name = self._switching[0]
        return self.Axis.digital_cam_switch(switches=name, enable=False)
