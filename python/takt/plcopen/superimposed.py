"""Blocks of motions on top of other motions."""

from __future__ import annotations

from typing import Any

from takt.feedback import Feedback
from takt.plcopen.base import ChangedBlock, ExecuteBlock, Input, Output


class SuperimposedBlock(ExecuteBlock):
    """A block whose command is on top of the motion in progress, which knows nothing of it. A newer one takes over."""

    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")


class MC_MoveSuperimposed(SuperimposedBlock, ChangedBlock):  # noqa: N801
    """Moves by Distance on top of the motion in progress, with VelocityDiff more than that has. CoveredDistance: how
    much of it was added so far, or at last."""

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
    """Brakes what was put on top of the motion in progress, which goes on."""

    VERB = "halt_superimposed"
