"""Blocks that follow tables over time. The tables are cams of the machine, given by name; x is the time [s]."""

from __future__ import annotations

from takt.plcopen.base import Input, Output, UpdatedBlock


class MC_PositionProfile(UpdatedBlock):  # noqa: N801
    """Follows positions over time, scaled by TimeScale and PositionScale and shifted by Offset."""

    VERB = "position_profile"
    TimePosition = Input("", "profile")
    TimeScale = Input(1.0, "time_scale")
    PositionScale = Input(1.0, "position_scale")
    Offset = Input(0.0, "offset")
    Done = Output(False)


class MC_VelocityProfile(UpdatedBlock):  # noqa: N801
    """Follows velocities over time, and continues with the last one."""

    VERB = "velocity_profile"
    TimeVelocity = Input("", "profile")
    TimeScale = Input(1.0, "time_scale")
    VelocityScale = Input(1.0, "velocity_scale")
    Offset = Input(0.0, "offset")
    Done = Output(False)
    ProfileCompleted = Output(False, alias="Done")


class MC_AccelerationProfile(UpdatedBlock):  # noqa: N801
    """Follows accelerations over time, and continues with the resulting velocity."""

    VERB = "acceleration_profile"
    TimeAcceleration = Input("", "profile")
    TimeScale = Input(1.0, "time_scale")
    AccelerationScale = Input(1.0, "acceleration_scale")
    Offset = Input(0.0, "offset")
    Done = Output(False)
    ProfileCompleted = Output(False, alias="Done")
