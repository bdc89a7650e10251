"""Blocks that change and show the settings of an axis."""

from __future__ import annotations

from typing import Any

from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import FunctionBlock, Input, Output, SettingBlock, found_no_room

YES_OR_NO = (4, 5, 6)  # parameters: EnableLimitPos, EnableLimitNeg, EnablePosLagMonitoring


class GT_SetConstant(SettingBlock):  # noqa: N801
    """Sets the constants of the position loop and the SW limits; an input that is None leaves its value unchanged."""

    VERB = "set_constants"
    Kp = Input[float | None](None, "kp")
    Ki = Input[float | None](None, "ki")
    Kd = Input[float | None](None, "kd")
    Ff = Input[float | None](None, "ff")
    Kc = Input[float | None](None, "kc")
    Vmax = Input[float | None](None, "velocity_at_10v")
    LimPos = Input[float | None](None, "upper")
    LimNeg = Input[float | None](None, "lower")


class GT_SWLim(SettingBlock):  # noqa: N801
    """Sets the SW limits and whether they are enabled; None leaves a limit unchanged."""

    VERB = "set_soft_limits"
    EnablePos = Input(True, "enable_upper")
    EnableNeg = Input(True, "enable_lower")
    LimPos = Input[float | None](None, "upper")
    LimNeg = Input[float | None](None, "lower")


class GT_Analog(SettingBlock):  # noqa: N801
    """Outputs a voltage, -10 to 10 V, while the axis is Disabled."""

    VERB = "direct_output"
    Voltage = Input(0.0, "voltage")


class GT_Pulse(SettingBlock):  # noqa: N801
    """Outputs a voltage for Duration [s] while the axis is Disabled, and 0 V after it."""

    VERB = "pulse_output"
    Voltage = Input(0.0, "voltage")
    Duration = Input(0.0, "duration")
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")


class MC_SetPosition(SettingBlock):  # noqa: N801
    """Assigns Position to the present position of the axis, or adds it (Relative), without motion."""

    VERB = "define_position"
    Position = Input(0.0, "position")
    Relative = Input(False, "relative")


class MC_SetOverride(FunctionBlock):  # noqa: N801
    """Keeps the override factors of the axis at those of the inputs as long as Enable is true; afterwards the last ones
    stay in force. Enabled: they are in force. VelFactor 0 holds the axis in its state until it is above 0."""

    Enable = Input(False)
    VelFactor = Input(1.0, "velocity_factor")
    AccFactor = Input(1.0, "acceleration_factor")
    JerkFactor = Input(1.0, "jerk_factor")
    Enabled = Output(False)
    Busy = Output(False)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._given: dict[str, Any] | None = None
        self._feedback: Feedback | None = None
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        if not self.Enable:
            self._given = self._feedback = None
            return
        wanted = self._arguments()
        if self._feedback is None or wanted != self._given or found_no_room(self._feedback):
            self._given = wanted
            self._feedback = self.Axis.session.command(self.Axis.name, "set_override", wanted)
        if self._feedback.error:
            self._show_error(self._feedback.error_id, self._feedback.sentence)
        else:
            self._show(Busy=True, Enabled=self._feedback.done)


class MC_WriteParameter(SettingBlock):  # noqa: N801
    """Sets a parameter by PLCopen's number."""

    VERB = "write_parameter"
    ParameterNumber = Input(0, "number")
    Value = Input(0.0, "value")


class MC_WriteBoolParameter(SettingBlock):  # noqa: N801
    """Sets a boolean parameter: 4, 5 or 6. Any other number is error 5."""

    VERB = "write_parameter"
    ParameterNumber = Input(0, "number")
    Value = Input(False)

    def _arguments(self) -> dict[str, Any]:
        number = self.ParameterNumber if self.ParameterNumber in YES_OR_NO else 0
        return super()._arguments() | {"number": number, "value": 1.0 if self.Value else 0.0}


class MC_ReadParameter(FunctionBlock):  # noqa: N801
    """Shows a parameter by PLCopen's number, read repeatedly as long as Enable is true. Value is valid from the first
    answer on, one or more cycles after Enable or after a change of ParameterNumber."""

    Enable = Input(False)
    ParameterNumber = Input(0, "number")
    Valid = Output(False)
    Busy = Output(False)
    Value: Output[Any] = Output(0.0)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._given: dict[str, Any] | None = None  # arguments of the request
        self._asked: Feedback | None = None
        self._answer: Feedback | None = None
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        if not self.Enable:
            self._asked = self._answer = None
            return
        wanted = self._arguments()
        if wanted != self._given:
            self._given, self._asked, self._answer = wanted, None, None
        self._take_answer()
        if self._asked is None:
            self._asked = self.Axis.session.command(self.Axis.name, "read_parameter", wanted)
            self._take_answer()  # an invalid request is refused at once
        if self._answer is not None and self._answer.error:
            self._show_error(self._answer.error_id, self._answer.sentence)
            return
        self._show(Busy=True)
        if self._answer is not None:
            self._show(Valid=True, Value=self._value(self._answer.value))

    def _take_answer(self) -> None:
        if self._asked is not None and self._asked.final:
            self._answer, self._asked = self._asked, None

    def _value(self, value: float) -> Any:
        return value


class MC_ReadBoolParameter(MC_ReadParameter):  # noqa: N801
    """Shows a boolean parameter."""

    Value: Output[Any] = Output(False)

    def _value(self, value: float) -> Any:
        return value != 0
