"""Blocks that switch an axis, clear its faults and show its state."""

from __future__ import annotations

import math
from typing import Any

from takt import _commands
from takt.axis import Axis
from takt.drives.error_texts import error_text as drive_error_text
from takt.engine import error_text
from takt.feedback import Feedback
from takt.plcopen.base import (
    PARAMETER,
    AxisName,
    ExecuteBlock,
    FunctionBlock,
    Input,
    Output,
    ReadBlock,
    SettingBlock,
    found_no_room,
    in_control,
)

OUTPUTS = 32
AXIS_FAULT = 7  # error of a command: the fault of the axis persists
EMERGENCY_STOP = 3100  # error of a command: an emergency stop is on, or power was not commanded anew since


class MC_Reset(ExecuteBlock):  # noqa: N801
    """Clears the fault of an axis. It has no CommandAborted: a reset that is superseded by another one follows the
    state of the axis. It is Busy while the axis still brakes, then Done if the fault is cleared, else Error."""

    VERB = "reset"
    Done = Output(False)

    def _end(self, feedback: Feedback) -> tuple[str, int] | None:
        if not feedback.aborted:
            return super()._end(feedback)
        axis = self.Axis
        axis.session._catch_up(feedback.cycle)
        if axis.state is not _commands.PlcState.ERROR_STOP and not axis.error:
            return "Done", 0
        braking = axis.loop_closed and (axis.set_velocity != 0 or axis.set_acceleration != 0)
        return None if braking else ("Error", AXIS_FAULT)


class MC_Power(FunctionBlock):  # noqa: N801
    """Keeps the power stage and position loop as the level of Enable requests, also after another program has switched
    them: commands power whenever the axis is Disabled and Enable true, or vice versa. Status: the loop is closed.

    A fault that opened the loop is shown by Error until the axis is reset; then the loop is closed again. Enable true
    on a Disabled axis with a fault leads to ErrorStop. A refused command is repeated once the axis is in another state;
    while the command queue is full, in each call. After an emergency stop the block shows error 3100 until Enable has
    risen again: nothing resumes automatically. Use one instance per axis: two with different Enable switch it on and
    off in turn.

    EnablePositive, EnableNegative: the directions in which the axis may move. Motion in another direction is refused
    with error 3103, and one in progress ends with it, as at a limit switch: the axis brakes into ErrorStop. Changes of
    both are commanded while the axis is powered."""

    Enable = Input(False)
    EnablePositive = Input(True, "enable_positive")
    EnableNegative = Input(True, "enable_negative")
    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")
    Status = Output(False)
    Valid = Output(False)
    Busy = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._level: bool | None = None  # Enable in the previous call
        self._anew = False  # Enable has risen, and the axis has not been on since
        self._feedback: Feedback | None = None  # of the command in progress ...
        self._given: dict[str, Any] = {}  # ... and its arguments
        self._told = (True, True)  # EnablePositive and EnableNegative of the last command that was not refused
        self._refusal: tuple[_commands.PlcState, Feedback] | None = None  # the last command, and the axis' state then
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        enable = bool(self.Enable)
        ended = self._end(enable)
        state = self.Axis.state
        if enable is not self._level or (self._refusal and self._refusal[0] is not state):
            self._refusal = None
        self._anew = enable and not self.Axis.loop_closed and (self._anew or not self._level)
        self._level = enable
        if self._is_due(enable, state):
            self._given = {"enable": enable, **self._arguments()}
            if enable and self.Axis.loop_closed:  # only other directions
                self._given["buffer_mode"] = _commands.BufferMode.ABORTING
            self._feedback = self.Axis.session.command(self.Axis.name, "power", self._given)
            ended = self._end(enable) or ended
        self._show_all(enable, state, ended)

    def _end(self, enable: bool) -> Feedback | None:
        """Returns the command that has ended since the previous call; None if none has."""
        ended = self._feedback
        if ended is None or ended.busy:
            return None
        self._feedback = None
        self.Axis.session._catch_up(ended.cycle)
        if ended.error_id == EMERGENCY_STOP:
            self._anew = False
        if not ended.error:
            self._told = (self._given["enable_positive"], self._given["enable_negative"])
        refused = ended.error and (ended.ticket == 0 or not enable) and not found_no_room(ended)
        if self._given["enable"] is enable and (refused or (ended.aborted and not enable)):
            self._refusal = (self.Axis.state, ended)
        return ended

    def _is_due(self, enable: bool, state: _commands.PlcState) -> bool:
        """Returns whether a command is to be given now."""
        if self._refusal is not None or self._is_held_off(enable):
            return False
        if self._feedback is not None:
            return bool(self._given["enable"]) and not enable
        disabled = state is _commands.PlcState.DISABLED
        told = self._told == (self.EnablePositive, self.EnableNegative)
        if enable and not told and self.Axis.loop_closed and state is not _commands.PlcState.ERROR_STOP:
            return True
        return disabled and not self.Axis.active_command if enable else not disabled

    def _is_held_off(self, enable: bool) -> bool:
        """Returns whether an emergency stop has switched the axis off, and Enable has not risen since."""
        return enable and not self._anew and self.Axis.emergency_stopped

    def _show_all(self, enable: bool, state: _commands.PlcState, ended: Feedback | None) -> None:
        status = self.Axis.loop_closed
        error_id, text = (ended.error_id, ended.sentence) if ended is not None and ended.error else (0, "")
        if self._refusal is not None:
            error_id, text = self._refusal[1].error_id, self._refusal[1].sentence
        if enable and not status and state is _commands.PlcState.ERROR_STOP:
            error_id, text = self.Axis.error, ""
        if self._is_held_off(enable):
            error_id, text = EMERGENCY_STOP, ""
        self._show(Status=status, Valid=enable and not error_id)
        if ended is not None and ended.aborted:
            self._show(CommandAborted=True)
        elif error_id:
            self._show_error(error_id, text)
        elif self._feedback is not None or (enable and not status):
            self._show(Busy=True, Active=self._feedback is None or in_control(self._feedback, self._given))


class MC_ReadStatus(ReadBlock):  # noqa: N801
    """Shows the state of the axis, one output per state. Ref: the axis is homed."""

    ErrorStop = Output(False)
    Disabled = Output(False)
    Stopping = Output(False)
    Homing = Output(False)
    Standstill = Output(False)
    StandStill = Output(False, alias="Standstill")
    DiscreteMotion = Output(False)
    ContinuousMotion = Output(False)
    SynchronizedMotion = Output(False)
    Ref = Output(False)

    def _read(self) -> None:
        self._show(**{self.Axis.state.value: True}, Ref=self.Axis.homed)


class MC_ReadAxisError(ReadBlock):  # noqa: N801
    """Shows the fault of the axis as a number; 0: none. Error and ErrorID show the axis' fault, too: the block itself
    has no errors, and its outputs are valid."""

    AxisErrorID = Output(0)

    def _read(self) -> None:
        error_id = self.Axis.error
        self._show(AxisErrorID=error_id, Error=error_id != 0, ErrorID=error_id)

    @property
    def text(self) -> str:
        """The fault in words, with that of the drive; empty without one."""
        said = [drive_error_text(self.Axis.drive_error)] if self.Axis.drive_error else []
        return ": ".join([error_text(self.AxisErrorID), *said]) if self.AxisErrorID else ""


class MC_ReadActualPosition(ReadBlock):  # noqa: N801
    """Shows the actual position [u]."""

    Position = Output(0.0)

    def _read(self) -> None:
        self._show(Position=self.Axis.actual_position)


class MC_ReadActualVelocity(ReadBlock):  # noqa: N801
    """Shows the actual velocity [u/s]."""

    Velocity = Output(0.0)

    def _read(self) -> None:
        self._show(Velocity=self.Axis.actual_velocity)


class MC_ReadActualTorque(ReadBlock):  # noqa: N801
    """Shows the torque [Nm] that the drive reports; the force [N] on linear motors."""

    Torque = Output(0.0)

    def _read(self) -> None:
        self._show(Torque=self.Axis.torque_nm)


class MC_ReadMotionState(ReadBlock):  # noqa: N801
    """Shows how the axis moves: by its set point (Source SET_VALUE), or by the actual velocity and its change since the
    previous call."""

    Source = Input(_commands.MasterSource.SET_VALUE)
    ConstantVelocity = Output(False)
    Accelerating = Output(False)
    Decelerating = Output(False)
    DirectionPositive = Output(False)
    DirectionNegative = Output(False)

    def __init__(self, subject: Axis, **inputs: Any) -> None:
        self._before: tuple[int, float, float] = (0, 0.0, 0.0)  # cycle, actual velocity and acceleration until then
        super().__init__(subject, **inputs)

    def _read(self) -> None:
        axis = self.Axis
        if self.Source is _commands.MasterSource.SET_VALUE:
            velocity, acceleration = axis.set_velocity, axis.set_acceleration
        else:
            velocity, acceleration = axis.actual_velocity, self._measured_acceleration()
        growing = acceleration * (velocity or acceleration)
        self._show(
            ConstantVelocity=growing == 0,
            Accelerating=growing > 0,
            Decelerating=growing < 0,
            DirectionPositive=velocity > 0,
            DirectionNegative=velocity < 0,
        )

    def _measured_acceleration(self) -> float:
        """Returns the acceleration [u/s²] from the actual velocities of the previous call and of now. Below a hundredth
        of the axis' acceleration limit it is 0: encoders count in steps."""
        cycle, velocity, acceleration = self._before
        now = self.Axis.session.cycle
        if now != cycle:
            period = self.Axis.session.period
            acceleration = (self.Axis.actual_velocity - velocity) / ((now - cycle) * period)
            self._before = (now, self.Axis.actual_velocity, acceleration)
        least = 0.01 * self.Axis.parameters["limits"]["acceleration"]
        return acceleration if abs(acceleration) >= least else 0.0


class MC_ReadAxisInfo(ReadBlock):  # noqa: N801
    """Shows the inputs of the axis and its readiness."""

    HomeAbsSwitch = Output(False)
    LimitSwitchPos = Output(False)
    LimitSwitchNeg = Output(False)
    Simulation = Output(False)
    CommunicationReady = Output(False)
    ReadyForPowerOn = Output(False)
    PowerOn = Output(False)
    IsHomed = Output(False)
    AxisWarning = Output(False)

    def _read(self) -> None:
        axis = self.Axis
        simulated = not math.isnan(axis.true_position)  # a servo in the engine
        heard = axis.drive_heard and (simulated or axis.session.cycle > 0)  # nothing is received before the first cycle
        self._show(
            HomeAbsSwitch=axis.reference,
            LimitSwitchPos=axis.limit_positive,
            LimitSwitchNeg=axis.limit_negative,
            Simulation=simulated,
            CommunicationReady=heard,
            ReadyForPowerOn=axis.error == 0 and heard and not axis.emergency_stopped,
            PowerOn=axis.loop_closed,
            IsHomed=axis.homed,
            AxisWarning=axis.limited_by is not _commands.LimitedBy.NOTHING,
        )


class GT_SInfo(ReadBlock):  # noqa: N801
    """Shows the input signals of the axis."""

    LIMpos = Output(False)
    LIMneg = Output(False)
    REF = Output(False)
    TP = Output(False)

    def _read(self) -> None:
        axis = self.Axis
        self._show(LIMpos=axis.limit_positive, LIMneg=axis.limit_negative, REF=axis.reference, TP=axis.touch_probe)


class GT_Show(ReadBlock):  # noqa: N801
    """Shows the values of the position loop: set point (the model), actual value, and output."""

    ModelPosition = Output(0.0)
    Position = Output(0.0)
    Deviation = Output(0.0)
    ModelVelocity = Output(0.0)
    Velocity = Output(0.0)
    Voltage = Output(0.0)
    Torque = Output(0.0)

    def _read(self) -> None:
        axis = self.Axis
        self._show(
            ModelPosition=axis.set_position,
            Position=axis.actual_position,
            Deviation=axis.following_error,
            ModelVelocity=axis.set_velocity,
            Velocity=axis.actual_velocity,
            Voltage=axis.voltage_v,
            Torque=axis.torque_nm,
        )


class MC_ReadDigitalInput(ReadBlock):  # noqa: N801
    """Shows an input of the axis. InputNumber: 1 LIM+, 2 LIM-, 3 REF, 4 TP; any other is error 5."""

    InputNumber = Input(1)
    Value = Output(False)
    Input = AxisName()

    def _read(self) -> None:
        axis = self.Axis
        inputs = (axis.limit_positive, axis.limit_negative, axis.reference, axis.touch_probe)
        if 1 <= self.InputNumber <= len(inputs):
            self._show(Value=inputs[self.InputNumber - 1])
        else:
            self._show(Valid=False, Busy=False)
            self._show_error(PARAMETER)


class MC_ReadDigitalOutput(ReadBlock):  # noqa: N801
    """Shows a digital output of the axis, which MC_WriteDigitalOutput or a track of MC_DigitalCamSwitch switches.
    OutputNumber: from 1 to 32; any other is error 5."""

    OutputNumber = Input(1)
    Value = Output(False)
    Output = AxisName()

    def _read(self) -> None:
        if 1 <= self.OutputNumber <= OUTPUTS:
            self._show(Value=bool(self.Axis.digital_outputs >> (self.OutputNumber - 1) & 1))
        else:
            self._show(Valid=False, Busy=False)
            self._show_error(PARAMETER)


class MC_WriteDigitalOutput(SettingBlock):  # noqa: N801
    """Switches a digital output of the axis. OutputNumber: from 1 to 32. Value False does not switch off an output that
    a track of MC_DigitalCamSwitch switches on."""

    VERB = "write_output"
    OutputNumber = Input(1, "number")
    Value = Input(False, "value")
    Output = AxisName()


class GT_EStop(ExecuteBlock):  # noqa: N801
    """Switches all drives of the machine off and applies all brakes at once. Faults are cleared; every axis becomes
    Disabled and stays Disabled as long as Execute is true: commands for power are refused (error 3100). Done: all axes
    are Disabled. Nothing resumes when Execute falls. Enable is another name of Execute."""

    VERB = "emergency_stop"
    Enable = Input(False, alias="Execute")
    Done = Output(False)

    def __init__(self, subject: Axis, **inputs: Any) -> None:
        self._holding: list[Feedback] = []  # to be released
        super().__init__(subject, **inputs)

    def _command(self) -> Feedback:
        feedback = self.Axis.session.command("machine", self.VERB, {"hold": True})
        self._holding.append(feedback)
        return feedback

    def _scan(self) -> None:
        super()._scan()
        axes = self.Axis.session.axes.values()
        if self.Done and not (self.Execute and all(a.state is _commands.PlcState.DISABLED for a in axes)):
            self._show(Done=False)
        if self.Execute:
            return
        for feedback in [f for f in self._holding if f.ticket or f.final]:  # over LCM the ticket is not known at once
            if feedback.ticket:
                feedback.release()
            self._holding.remove(feedback)
