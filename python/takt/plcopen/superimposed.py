"""Blocks of motions superimposed on other motions."""

from __future__ import annotations

from typing import Any

from takt.feedback import Feedback
from takt.plcopen.base import ChangedBlock, ExecuteBlock, Input, Output


class SuperimposedBlock(ExecuteBlock):
    """A block whose command is superimposed on the motion in progress, which is not affected. A newer superimposed
    command supersedes it."""

    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")


class MC_MoveSuperimposed(SuperimposedBlock, ChangedBlock):  # noqa: N801
    """Moves by Distance on top of the motion in progress, with at most VelocityDiff in addition to its velocity.
    CoveredDistance: the part of Distance added so far; after the end of the command, the last one."""

    VERB = "move_superimposed"
    Distance = Input(0.0, "distance")
    VelocityDiff = Input[float | None](None, "velocity_difference")
    Acceleration = Input[float | None](None, "acceleration")
    CoveredDistance = Output(0.0)

    def _changed(self, wanted: dict[str, Any]) -> tuple[str, dict[str, Any]]:
        return self.VERB, wanted | {"update": True}

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        if self.Done or self.CommandAborted or self.Error:
            self._show(CoveredDistance=feedback.value)

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        if feedback.active:
            self._show(CoveredDistance=self.Axis.covered_distance)


class MC_HaltSuperimposed(SuperimposedBlock):  # noqa: N801
    """Brakes the superimposed motion; the motion in progress continues."""

    VERB = "halt_superimposed"
