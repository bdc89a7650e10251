"""Blocks that move a single axis."""

from __future__ import annotations

import math
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
    """Moves by a distance from the end position of the move in progress."""

    VERB = "move_additive"


def has_velocity(axis: Axis, velocity: float) -> bool:
    """Returns whether the set point of an axis whose command has reached `velocity` [u/s] has it now, scaled by the
    override in force, up to the largest velocity of the axis. A superimposed motion is published together with it: then
    the axis only must not be held by the override."""
    factor = axis.override_factor
    if axis.superimposed:
        return factor > 0 or velocity == 0
    scaled, now = velocity * factor, abs(axis.set_velocity)
    clamped = axis.limited_by is not _commands.LimitedBy.NOTHING and axis.set_acceleration == 0 and now < scaled
    return clamped or (math.isclose(now, scaled, rel_tol=1e-9, abs_tol=1e-9) and (factor > 0 or velocity == 0))


class MC_MoveVelocity(UpdatedBlock):  # noqa: N801
    """Moves endlessly. Never done: InVelocity is true while the set point has the velocity, scaled by the override in
    force."""

    VERB = "move_velocity"
    Velocity = Input(0.0, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.POSITIVE, "direction")
    InVelocity = Output(False)

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        there = feedback.reached and has_velocity(self.Axis, self._given["velocity"])
        self._show(InVelocity=there and self._is_due("InVelocity"))


class MC_Halt(MotionBlock):  # noqa: N801
    """Brakes to standstill; another command may take over before it is at rest."""

    VERB = "halt"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)


class MC_Stop(MotionBlock):  # noqa: N801
    """Brakes to standstill. The axis stays in Stopping and accepts no other motion as long as Execute is true, also
    through power off, faults and emergency stops. All stops of an axis are done when it is at rest, whichever of them
    brakes it."""

    VERB = "stop"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"hold": True}

    def _fall(self) -> None:
        if self._feedback is not None:
            self._feedback.release()


class MC_MoveContinuousAbsolute(UpdatedBlock):  # noqa: N801
    """Moves to a position and continues from there with EndVelocity. Never done: InEndVelocity is true once the axis is
    there, while the set point has that velocity, scaled by the override in force."""

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
        there = feedback.reached and has_velocity(self.Axis, self._given["end_velocity"])
        self._show(InEndVelocity=there and self._is_due("InEndVelocity"))


class MC_MoveContinuousRelative(UpdatedBlock):  # noqa: N801
    """Moves by a distance and continues from there with EndVelocity. Never done: InEndVelocity is true once the axis is
    there, while the set point has that velocity, scaled by the override in force."""

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
        there = feedback.reached and has_velocity(self.Axis, self._given["end_velocity"])
        self._show(InEndVelocity=there and self._is_due("InEndVelocity"))


class MC_MoveContinue(MC_MoveContinuousAbsolute):  # noqa: N801
    """MC_MoveContinuousAbsolute under its name in the GT-775x."""


class MC_Inch(ExecuteBlock):  # noqa: N801
    """Moves an axis from rest by one increment on each rising edge of Execute; refused while the axis moves."""

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
