"""Blocks that couple an axis to one or two masters. Master is an axis or its name."""

from __future__ import annotations

from typing import Any, ClassVar

from takt import _commands
from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import AxisName, ExecuteBlock, Input, MotionBlock, Output, UpdatedBlock


def axis_name(axis: Axis | str) -> str:
    return axis if isinstance(axis, str) else axis.name


class CouplingBlock(MotionBlock):
    """A block whose axis, the slave, follows masters. Never done: the output IN_STEP is true while the slave is in
    step."""

    IN_STEP = "InGear"
    Slave = AxisName()

    def _arguments(self) -> dict[str, Any]:
        arguments = super()._arguments()
        return arguments | {n: axis_name(v) for n, v in arguments.items() if isinstance(v, Axis)}

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(**{self.IN_STEP: feedback.reached and self.Axis.in_step})


class MC_GearIn(CouplingBlock, UpdatedBlock):  # noqa: N801
    """Follows the velocity of Master times RatioNumerator / RatioDenominator; from InGear on, its position, too. InGear
    falls when the limits of the axis prevent this."""

    VERB = "gear_in"
    Master = Input[Axis | str]("", "master")
    RatioNumerator = Input(1.0, "ratio_numerator")
    RatioDenominator = Input(1.0, "ratio_denominator")
    MasterValueSource = Input(_commands.MasterSource.SET_VALUE, "source")
    MasterFilter = Input[float | None](None, "master_filter")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    InGear = Output(False)


class MC_GearInPos(CouplingBlock):  # noqa: N801
    """Follows the position of Master times the ratio, in step from MasterSyncPosition and SlaveSyncPosition on.
    StartSync: synchronization is in progress."""

    VERB = "gear_in_pos"
    IN_STEP = "InSync"
    Master = Input[Axis | str]("", "master")
    RatioNumerator = Input(1.0, "ratio_numerator")
    RatioDenominator = Input(1.0, "ratio_denominator")
    MasterValueSource = Input(_commands.MasterSource.SET_VALUE, "source")
    MasterFilter = Input[float | None](None, "master_filter")
    MasterSyncPosition = Input(0.0, "master_sync_position")
    SlaveSyncPosition = Input(0.0, "slave_sync_position")
    SyncMode = Input(_commands.SyncMode.SHORTEST, "sync_mode")
    MasterStartDistance = Input[float | None](None, "master_start_distance")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    StartSync = Output(False)
    InSync = Output(False)

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(StartSync=feedback.active and not feedback.reached and self.Axis.synchronizing)


class MC_GearOut(ExecuteBlock):  # noqa: N801
    """Releases the axis from its master; the axis continues with its present velocity."""

    VERB = "gear_out"
    Slave = AxisName()
    Done = Output(False)


class PhasingBlock(ExecuteBlock):
    """Shifts the master position that the axis follows. A newer shift supersedes this one. The axis is coupled to its
    master already: Master is not evaluated."""

    Master = Input[Axis | str]("")
    Slave = AxisName()
    PhaseShift = Input(0.0, "phase_shift")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    SHIFT: ClassVar[str]  # the output that shows the shift so far

    def _follow(self, feedback: Feedback) -> None:
        super()._follow(feedback)
        if self.Done or self.CommandAborted or self.Error:
            self._show(**{self.SHIFT: feedback.value})

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=feedback.active)
        if feedback.active:
            self._show(**{self.SHIFT: self.Axis.covered_phase_shift})


class MC_PhasingAbsolute(PhasingBlock):  # noqa: N801
    """Shifts the phase to an amount. AbsolutePhaseShift: the present phase shift; after the end of the command, the
    last one."""

    VERB = "phasing_absolute"
    SHIFT = "AbsolutePhaseShift"
    AbsolutePhaseShift = Output(0.0)


class MC_PhasingRelative(PhasingBlock):  # noqa: N801
    """Shifts the phase by an amount. CoveredPhaseShift: the part added so far; after the end of the command, the last
    one."""

    VERB = "phasing_relative"
    SHIFT = "CoveredPhaseShift"
    CoveredPhaseShift = Output(0.0)


class MC_Phasing(MC_PhasingAbsolute):  # noqa: N801
    """MC_PhasingAbsolute under its name in the GT-775x."""


class MC_CombineAxes(CouplingBlock, UpdatedBlock):  # noqa: N801
    """Follows the sum or the difference of two masters, each times its ratio."""

    VERB = "combine_axes"
    IN_STEP = "InSync"
    Master1 = Input[Axis | str]("", "master1")
    Master2 = Input[Axis | str]("", "master2")
    CombineMode = Input(_commands.CombineMode.ADD, "mode")
    GearRatioNumeratorM1 = Input(1.0, "ratio_numerator1")
    GearRatioDenominatorM1 = Input(1.0, "ratio_denominator1")
    GearRatioNumeratorM2 = Input(1.0, "ratio_numerator2")
    GearRatioDenominatorM2 = Input(1.0, "ratio_denominator2")
    MasterValueSourceM1 = Input(_commands.MasterSource.SET_VALUE, "source1")
    MasterValueSourceM2 = Input(_commands.MasterSource.SET_VALUE, "source2")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    InSync = Output(False)
