"""Function blocks of the touch probe."""

from __future__ import annotations

from typing import Any

from takt import _commands
from takt.feedback import Feedback
from takt.plcopen.base import ExecuteBlock, Input, Output


class MC_TouchProbe(ExecuteBlock):  # noqa: N801
    """Captures the position of the axis at the next edge of its touch probe. TriggerInput is the edge; each axis has
    one probe. Up to eight blocks wait at once, each for its own edge and window."""

    VERB = "arm_probe"
    TriggerInput = Input(_commands.ProbeEdge.RISING, "edge")
    WindowOnly = Input(False, "window_only")
    FirstPosition = Input(0.0, "first_position")
    LastPosition = Input(0.0, "last_position")
    Done = Output(False)
    CommandAborted = Output(False)
    RecordedPosition = Output(0.0)

    def _command(self) -> Feedback:
        if self._feedback is not None and not self._feedback.final:
            self._feedback.release()  # a new edge of Execute supersedes the last command of this block
        return super()._command()

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        if self.Done:
            self._show(RecordedPosition=feedback.value)


class MC_AbortTrigger(ExecuteBlock):  # noqa: N801
    """Aborts the blocks that wait for the touch probe of the axis. TriggerInput: only those that wait for this edge;
    None: all."""

    VERB = "abort_trigger"
    TriggerInput = Input[_commands.ProbeEdge | None](None, "edge")
    Done = Output(False)


class GT_Touch(ExecuteBlock):  # noqa: N801
    """Waits for the touch probe, then aborts the motion in progress, stops and returns to the position captured at the
    probe's edge; Active meanwhile. With Mode SLOW it instead slows down any motion while the probe is on, at most as
    long as Execute is true, and is never done."""

    VERB = "touch"
    Mode = Input(_commands.TouchMode.CAPTURE, "mode")
    TriggerInput = Input(_commands.ProbeEdge.RISING, "edge")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)
    RecordedPosition = Output(0.0)

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=feedback.active)

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        if self.Done:
            self._show(RecordedPosition=feedback.value)

    def _fall(self) -> None:
        slows: Any = self._given["mode"] == _commands.TouchMode.SLOW
        if slows and self._feedback is not None and self._feedback.busy:
            self._feedback.release()
