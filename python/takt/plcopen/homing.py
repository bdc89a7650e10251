"""Blocks that home an axis (PLCopen Part 5)."""

from __future__ import annotations

from takt import _commands
from takt.feedback import Feedback
from takt.plcopen.base import ExecuteBlock, Input, MotionBlock, Output


class HomingBlock(MotionBlock):
    """A step of homing."""

    Done = Output(False)


class MC_Home(HomingBlock):  # noqa: N801
    """Homes the axis according to its section `homing`, and ends homing. Position: the position assigned to the
    reference."""

    VERB = "home"
    Position = Input(0.0, "position")


class SearchBlock(HomingBlock):
    """A step that searches. TimeLimit [s] and DistanceLimit [u] end it with errors 1 and 2; 0: no limit. TorqueLimit
    [Nm] (N on linear motors): limit of the drive meanwhile; None: that of the axis."""

    Velocity = Input(0.0, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    TimeLimit = Input(0.0, "time_limit")
    DistanceLimit = Input(0.0, "distance_limit")
    TorqueLimit = Input[float | None](None, "torque_limit")


class MC_StepAbsSwitch(SearchBlock):  # noqa: N801
    """Searches the reference switch and returns to the position at which it was found. The axis stays in Homing for the
    next step."""

    VERB = "step_abs_switch"
    Direction = Input(_commands.HomingDirection.SWITCH_NEGATIVE, "direction")
    SwitchMode = Input(_commands.SwitchMode.EDGE_ON, "switch_mode")
    SetPosition = Input[float | None](None, "set_position")


class MC_StepLimitSwitch(SearchBlock):  # noqa: N801
    """Searches a limit switch and returns to the position at which it was found. The axis stays in Homing for the next
    step."""

    VERB = "step_limit_switch"
    Direction = Input(_commands.HomingDirection.NEGATIVE, "direction")
    SwitchMode = Input(_commands.SwitchMode.EDGE_ON, "switch_mode")
    LimitSwitchMode = Input(_commands.SwitchMode.EDGE_ON, alias="SwitchMode")
    SetPosition = Input[float | None](None, "set_position")


class MC_StepBlock(SearchBlock):  # noqa: N801
    """Searches an end stop: the axis hardly moves and its following error reaches DevRef. Ends homing."""

    VERB = "step_block"
    Direction = Input(_commands.HomingDirection.NEGATIVE, "direction")
    DevRef = Input(0.0, "deviation")
    SetPosition = Input(0.0, "set_position")


class MC_StepRefPulse(SearchBlock):  # noqa: N801
    """Searches the next index pulse of the encoder; stops behind it and does not return. Ends homing."""

    VERB = "step_ref_pulse"
    Direction = Input(_commands.HomingDirection.POSITIVE, "direction")
    SetPosition = Input(0.0, "set_position")


class MC_StepDistanceCoded(SearchBlock):  # noqa: N801
    """Finds the position from the distance between two distance-coded marks of the encoder (`encoder.coded_marks`);
    stops behind the second one and does not return. Ends homing."""

    VERB = "step_distance_coded"
    Direction = Input(_commands.HomingDirection.POSITIVE, "direction")


class MC_StepDirect(HomingBlock):  # noqa: N801
    """Assigns SetPosition to the present position. Ends homing."""

    VERB = "step_direct"
    SetPosition = Input(0.0, "set_position")


class MC_StepAbsolute(HomingBlock):  # noqa: N801
    """Takes the position of the absolute encoder as it is. Ends homing."""

    VERB = "step_absolute"


class MC_FinishHoming(HomingBlock):  # noqa: N801
    """Moves by Distance and ends homing."""

    VERB = "finish_homing"
    Distance = Input(0.0, "distance")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")


class FlyingBlock(ExecuteBlock):
    """A reference taken during another motion."""

    SetPosition = Input(0.0, "set_position")
    TimeLimit = Input(0.0, "time_limit")
    DistanceLimit = Input(0.0, "distance_limit")
    UntilHalt = Input(False, "until_halt")
    Done = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")
    RecordedPosition = Output(0.0)

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        if self.Done:
            self._show(RecordedPosition=feedback.value)


class MC_StepRefFlyingSwitch(FlyingBlock):  # noqa: N801
    """Takes the reference from the reference switch during motion."""

    VERB = "step_ref_flying_switch"
    SwitchMode = Input(_commands.SwitchMode.EDGE_ON, "switch_mode")


class MC_StepRefFlyingRefPulse(FlyingBlock):  # noqa: N801
    """Takes the reference from the index pulse of the encoder during motion."""

    VERB = "step_ref_flying_ref_pulse"


class MC_AbortPassiveHoming(ExecuteBlock):  # noqa: N801
    """Cancels a reference that is to be taken during motion; nothing else changes."""

    VERB = "abort_passive_homing"
    Done = Output(False)
    CommandAborted = Output(False)


class MC_StepAbsoluteSwitch(MC_StepAbsSwitch):  # noqa: N801
    """MC_StepAbsSwitch under its name in version 2 of PLCopen's Part 5."""


class MC_StepReferencePulse(MC_StepRefPulse):  # noqa: N801
    """MC_StepRefPulse under its name in version 2 of PLCopen's Part 5."""


class MC_HomeDirect(MC_StepDirect):  # noqa: N801
    """MC_StepDirect under its name in version 2 of PLCopen's Part 5."""


class MC_HomeAbsolute(MC_StepAbsolute):  # noqa: N801
    """MC_StepAbsolute under its name in version 2 of PLCopen's Part 5."""


class MC_StepReferenceFlyingSwitch(MC_StepRefFlyingSwitch):  # noqa: N801
    """MC_StepRefFlyingSwitch under its name in version 2 of PLCopen's Part 5."""


class MC_StepReferenceFlyingRefPulse(MC_StepRefFlyingRefPulse):  # noqa: N801
    """MC_StepRefFlyingRefPulse under its name in version 2 of PLCopen's Part 5."""
