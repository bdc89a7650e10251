"""Function block of torque control."""

from __future__ import annotations

from typing import Any

from takt import _commands
from takt.feedback import Feedback
from takt.plcopen.base import Input, Output, UpdatedBlock


class MC_TorqueControl(UpdatedBlock):  # noqa: N801
    """Drives with a torque, within Velocity, Acceleration, Deceleration and Jerk. Never done: InTorque is true while
    the torque set point has the commanded value. Direction NEGATIVE reverses the torque."""

    VERB = "torque_control"
    Torque = Input(0.0, "torque")
    TorqueRamp = Input[float | None](None, "torque_ramp")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.POSITIVE)
    InTorque = Output(False)

    def _arguments(self) -> dict[str, Any]:
        sense = -1 if self.Direction is _commands.Direction.NEGATIVE else 1
        return super()._arguments() | {"torque": sense * self.Torque}

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(InTorque=feedback.reached and self._is_due("InTorque"))
