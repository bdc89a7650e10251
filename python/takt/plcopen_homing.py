"""Function blocks for homing (PLCopen Part 5), with the names of its chapter and the module's own DevRef.

A search leaves the axis in Homing, at what was found; MC_FinishHoming, MC_StepDirect or MC_StepRefPulse leads out. The
two flying blocks take no control of the axis: another motion goes on meanwhile."""

from __future__ import annotations

from takt import _commands
from takt.plcopen import ExecuteBlock, Input, MotionBlock, Output


class SearchBlock(MotionBlock):
    """A step that searches at a velocity, within limits of time [s] and distance; 0: none."""

    Velocity = Input(0.0, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    TimeLimit = Input(0.0, "time_limit")
    DistanceLimit = Input(0.0, "distance_limit")
    Done = Output(False)


class MC_StepAbsSwitch(SearchBlock):  # noqa: N801
    """Searches the reference switch. Without SetPosition the numbers stay as they are."""

    VERB = "step_abs_switch"
    Direction = Input(_commands.HomingDirection.SWITCH_NEGATIVE, "direction")
    SwitchMode = Input(_commands.SwitchMode.EDGE_ON, "switch_mode")
    SetPosition = Input[float | None](None, "set_position")


class MC_StepLimitSwitch(SearchBlock):  # noqa: N801
    """Searches the limit switch of its direction."""

    VERB = "step_limit_switch"
    Direction = Input(_commands.HomingDirection.SWITCH_NEGATIVE, "direction")
    SwitchMode = Input(_commands.SwitchMode.EDGE_ON, "switch_mode")
    SetPosition = Input[float | None](None, "set_position")


class MC_StepBlock(SearchBlock):  # noqa: N801
    """Searches an end stop, where the axis lags behind by DevRef and hardly moves. Ends homing."""

    VERB = "step_block"
    Direction = Input(_commands.HomingDirection.NEGATIVE, "direction")
    DevRef = Input(0.0, "deviation")
    SetPosition = Input(0.0, "set_position")


class MC_StepRefPulse(SearchBlock):  # noqa: N801
    """Searches the encoder's next index pulse and stops behind it. Ends homing."""

    VERB = "step_ref_pulse"
    Direction = Input(_commands.HomingDirection.POSITIVE, "direction")
    SetPosition = Input(0.0, "set_position")


class MC_StepDirect(MotionBlock):  # noqa: N801
    """The place where the axis stands is SetPosition. Ends homing."""

    VERB = "step_direct"
    SetPosition = Input(0.0, "set_position")
    Done = Output(False)


class MC_StepAbsolute(MotionBlock):  # noqa: N801
    """Takes the position of the absolute encoder. Ends homing."""

    VERB = "step_absolute"
    Done = Output(False)


class MC_FinishHoming(MotionBlock):  # noqa: N801
    """Ends homing; moves off by Distance first, if there is one."""

    VERB = "finish_homing"
    Distance = Input(0.0, "distance")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)


class FlyingBlock(ExecuteBlock):
    """Takes the reference in passing."""

    SetPosition = Input(0.0, "set_position")
    TimeLimit = Input(0.0, "time_limit")
    DistanceLimit = Input(0.0, "distance_limit")
    Done = Output(False)
    CommandAborted = Output(False)


class MC_StepRefFlyingSwitch(FlyingBlock):  # noqa: N801
    """Takes it from the reference switch."""

    VERB = "step_ref_flying_switch"
    SwitchMode = Input(_commands.SwitchMode.EDGE_ON, "switch_mode")


class MC_StepRefFlyingRefPulse(FlyingBlock):  # noqa: N801
    """Takes it from the encoder's index pulse."""

    VERB = "step_ref_flying_ref_pulse"


BLOCKS = (
    MC_StepAbsSwitch,
    MC_StepLimitSwitch,
    MC_StepBlock,
    MC_StepRefPulse,
    MC_StepDirect,
    MC_StepAbsolute,
    MC_FinishHoming,
    MC_StepRefFlyingSwitch,
    MC_StepRefFlyingRefPulse,
)

__all__ = ["BLOCKS"]
__all__ += [block.__name__ for block in BLOCKS]
