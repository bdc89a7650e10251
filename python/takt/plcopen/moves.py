"""Blocks that move an axis by itself."""

from __future__ import annotations

from typing import Any

from takt import _commands
from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import ExecuteBlock, Input, MotionBlock, Output, UpdatedBlock


class MC_MoveAbsolute(UpdatedBlock):  # noqa: N801
    """Moves to a position."""

    VERB = "move_absolute"
    Position = Input(0.0, "position")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.SHORTEST, "direction")
    Done = Output(False)


class MC_MoveRelative(UpdatedBlock):  # noqa: N801
    """Moves by a distance."""

    VERB = "move_relative"
    Distance = Input(0.0, "distance")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)

    def _changed(self, wanted: dict[str, Any]) -> tuple[str, dict[str, Any]]:
        more = wanted["distance"] - self._given["distance"]
        return "move_additive", wanted | {"distance": more, "update": True}


class MC_MoveAdditive(MC_MoveRelative):  # noqa: N801
    """Moves by a distance from where the move in progress was to end."""

    VERB = "move_additive"


class MC_MoveVelocity(UpdatedBlock):  # noqa: N801
    """Moves on and on. Never done: InVelocity says that the velocity is reached."""

    VERB = "move_velocity"
    Velocity = Input(0.0, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.POSITIVE, "direction")
    InVelocity = Output(False)

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(InVelocity=feedback.reached and self._is_due("InVelocity"))


class MC_Halt(MotionBlock):  # noqa: N801
    """Brakes to standstill; another command may take over on the way."""

    VERB = "halt"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)


class MC_Stop(MotionBlock):  # noqa: N801
    """Brakes to standstill. The axis stays in Stopping, and takes no other motion, as long as Execute is true,
    through power off, faults and emergency stops, too. All stops of an axis are done when it stands, whichever of them
    brakes."""

    VERB = "stop"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"hold": True}

    def _fall(self) -> None:
        if self._feedback is not None:
            self._feedback.release()


def has_end_velocity(axis: Axis, end_velocity: float) -> bool:
    """Whether the set point has the end velocity [u/s] of a continuous move, as the override in force scales it."""
    scaled = end_velocity * (axis.override_factor or 1.0)  # 0: the axis is held
    return abs(axis.set_velocity) >= min(scaled, axis.parameters["limits"]["velocity"] or scaled) * (1 - 1e-9)


class MC_MoveContinuousAbsolute(UpdatedBlock):  # noqa: N801
    """Moves to a position and goes on from there with EndVelocity. Never done: InEndVelocity says that it is there."""

    VERB = "move_continuous_absolute"
    Position = Input(0.0, "position")
    EndVelocity = Input(0.0, "end_velocity")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.SHORTEST, "direction")
    InEndVelocity = Output(False)

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        there = feedback.reached and has_end_velocity(self.Axis, self._given["end_velocity"])
        self._show(InEndVelocity=there and self._is_due("InEndVelocity"))


class MC_MoveContinuousRelative(UpdatedBlock):  # noqa: N801
    """Moves by a distance and goes on from there with EndVelocity. Never done: InEndVelocity says that it is there."""

    VERB = "move_continuous_relative"
    Distance = Input(0.0, "distance")
    EndVelocity = Input(0.0, "end_velocity")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    InEndVelocity = Output(False)

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        there = feedback.reached and has_end_velocity(self.Axis, self._given["end_velocity"])
        self._show(InEndVelocity=there and self._is_due("InEndVelocity"))


class MC_MoveContinue(MC_MoveContinuousAbsolute):  # noqa: N801
    """The GT-775x's name of MC_MoveContinuousAbsolute."""


class MC_Inch(ExecuteBlock):  # noqa: N801
    """Moves a standing axis by one increment on each rising edge of Execute."""

    VERB = "inch"
    Distance = Input(0.0, "distance")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=True)
