"""Blocks that move an axis by itself."""

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
    """Moves by a distance from where the move in progress was to end."""

    VERB = "move_additive"


def has_velocity(axis: Axis, velocity: float) -> bool:
    """Whether the set point of an axis whose command has reached `velocity` [u/s] has it now, as the override in force
    scales it, up to the largest velocity of the axis. What is on top of the motion is published together with it: then
    the axis only must not be held."""
    factor = axis.override_factor
    if axis.superimposed:
        return factor > 0 or velocity == 0
    scaled, now = velocity * factor, abs(axis.set_velocity)
    clamped = axis.limited_by is not _commands.LimitedBy.NOTHING and axis.set_acceleration == 0 and now < scaled
    return clamped or (math.isclose(now, scaled, rel_tol=1e-9, abs_tol=1e-9) and (factor > 0 or velocity == 0))


class MC_MoveVelocity(UpdatedBlock):  # noqa: N801
    """Moves on and on. Never done: InVelocity is true while the set point has the velocity, as the override in force
    scales it."""

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


class MC_MoveContinuousAbsolute(UpdatedBlock):  # noqa: N801
    """Moves to a position and goes on from there with EndVelocity. Never done: InEndVelocity is true once it is
    there, while the set point has that velocity, as the override in force scales it."""

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
    """Moves by a distance and goes on from there with EndVelocity. Never done: InEndVelocity is true once it is
    there, while the set point has that velocity, as the override in force scales it."""

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
