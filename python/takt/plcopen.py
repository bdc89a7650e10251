"""Function blocks with PLCopen's names, inputs and outputs, for those who think in them.

A block is an instance that is called once a cycle, usually in a program of the session:

    move = MC_MoveAbsolute(session.axis("x"))

    @session.program
    def scan() -> None:
        move(Execute=start, Position=100.0, Velocity=50.0)
        if move.Done: ...

The rules that all blocks keep: an input that is not given keeps its value from the call before. Inputs count on the
rising edge of Execute. While Execute is true, exactly one of Busy, Done, CommandAborted and Error is, of those that the
block has. Active is as Busy, but for a buffered command, where it says that the command is in control. Done,
CommandAborted, Error and the like are cleared with the falling edge of Execute, but are seen in one call at least. A
new rising edge before the end starts the command again; of the one before nothing more is heard. Velocity,
acceleration, deceleration and jerk are never negative; the engine refuses them. An input that is None is left to the
engine: the axis' own limit.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Generic, TypeVar, overload

from takt import _commands
from takt.axis import Axis
from takt.engine import error_text
from takt.feedback import Feedback, FeedbackState

ENDINGS = {FeedbackState.DONE: "Done", FeedbackState.ABORTED: "CommandAborted", FeedbackState.ERROR: "Error"}
AXIS_FAULT = 7  # error of a command: the fault of the axis is still there

T = TypeVar("T")


class Input(Generic[T]):
    """An input of a block; `argument` is its name among the command's arguments, where it is one."""

    def __init__(self, initial: T, argument: str = "") -> None:
        self.initial = initial
        self.argument = argument
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, block: None, owner: type) -> Input[T]: ...
    @overload
    def __get__(self, block: FunctionBlock, owner: type) -> T: ...
    def __get__(self, block: FunctionBlock | None, owner: type) -> T | Input[T]:
        if block is None:
            return self
        value: T = block._inputs.get(self.name, self.initial)
        return value

    def __set__(self, block: FunctionBlock, value: T) -> None:
        block._inputs[self.name] = value


class Output(Generic[T]):
    """An output of a block; only the block itself sets it. `alias` is another name of the same output."""

    def __init__(self, initial: T, alias: str = "") -> None:
        self.initial = initial
        self.alias = alias
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, block: None, owner: type) -> Output[T]: ...
    @overload
    def __get__(self, block: FunctionBlock, owner: type) -> T: ...
    def __get__(self, block: FunctionBlock | None, owner: type) -> T | Output[T]:
        if block is None:
            return self
        value: T = block._outputs.get(self.alias or self.name, self.initial)
        return value

    def __set__(self, block: FunctionBlock, value: T) -> None:
        raise AttributeError(f"{self.name} is an output of {type(block).__name__}")


class FunctionBlock:
    """What all blocks have: the axis, inputs, outputs."""

    INPUTS: ClassVar[Mapping[str, Input[Any]]] = {}
    OUTPUTS: ClassVar[Mapping[str, Output[Any]]] = {}

    Error = Output(False)
    ErrorID = Output(0)

    def __init_subclass__(cls) -> None:
        members = [(n, m) for base in reversed(cls.__mro__) for n, m in vars(base).items()]
        cls.INPUTS = {n: m for n, m in members if isinstance(m, Input)}
        cls.OUTPUTS = {n: m for n, m in members if isinstance(m, Output)}

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._inputs: dict[str, Any] = {}
        self._outputs: dict[str, Any] = {}
        self.Axis = axis
        self._assign(inputs)

    def __call__(self, **inputs: Any) -> Any:
        """One call of the block, with new values of some inputs. Returns the block, its outputs up to date."""
        self._assign(inputs)
        self._outputs = {}
        self._scan()
        return self

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_") and name != "Axis" and name not in self.INPUTS and name not in self.OUTPUTS:
            raise AttributeError(self._no_input(name))
        super().__setattr__(name, value)

    @property
    def outputs(self) -> dict[str, Any]:
        """All outputs by name."""
        return {name: getattr(self, name) for name in self.OUTPUTS}

    def _assign(self, inputs: Mapping[str, Any]) -> None:
        for name, value in inputs.items():
            if name not in self.INPUTS and name != "Axis":
                raise TypeError(self._no_input(name))
            setattr(self, name, value)

    def _no_input(self, name: str) -> str:
        return f"{type(self).__name__} has no input '{name}' (it has {', '.join(self.INPUTS)})"

    def _arguments(self) -> dict[str, Any]:
        """The inputs that are arguments of the command."""
        return {i.argument: getattr(self, n) for n, i in self.INPUTS.items() if i.argument}

    def _show(self, **outputs: Any) -> None:
        for name in outputs:
            if name not in self.OUTPUTS:
                raise AttributeError(f"{type(self).__name__} has no output '{name}'")
        self._outputs.update(outputs)

    def _show_error(self, error_id: int) -> None:
        self._show(Error=True, ErrorID=error_id)

    def _scan(self) -> None:
        raise NotImplementedError


def _in_control(feedback: Feedback, arguments: Mapping[str, Any]) -> bool:
    """Active of a command in progress; one that does not wait for others is as soon as it is given."""
    return feedback.active or arguments["buffer_mode"] == _commands.BufferMode.ABORTING


class ExecuteBlock(FunctionBlock):
    """A block that gives a command on the rising edge of Execute."""

    VERB: ClassVar[str]

    Execute = Input(False)
    Busy = Output(False)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._edge = False  # Execute in the call before
        self._given: dict[str, Any] = {}  # the arguments of the command
        self._feedback: Feedback | None = None
        self._ending: tuple[str, int] | None = None  # of the command: the output that says so, the error's number
        self._seen: set[str] = set()  # outputs that were shown for this command
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        execute = bool(self.Execute)
        if execute and not self._edge:
            self._given = self._arguments()
            self._feedback = self.Axis.session.command(self.Axis.name, self.VERB, self._given)
            self._ending = None
            self._seen = set()
        elif self._edge and not execute:
            self._fall()
        self._edge = execute
        if self._feedback is not None:
            self._follow(self._feedback)

    def _fall(self) -> None:
        """The falling edge of Execute. The command goes on all the same."""

    def _follow(self, feedback: Feedback) -> None:
        self._ending = self._ending or self._end(feedback)
        if self._ending is None:
            self._run(feedback)
        elif self._is_due(self._ending[0]):
            name, error_id = self._ending
            self._show_error(error_id) if name == "Error" else self._show(**{name: True})

    def _end(self, feedback: Feedback) -> tuple[str, int] | None:
        """How the command ended; None: it has not."""
        return (ENDINGS[feedback.state], feedback.error_id) if feedback.final else None

    def _run(self, feedback: Feedback) -> None:
        """Shows the outputs of a command in progress."""
        self._show(Busy=True)

    def _is_due(self, name: str) -> bool:
        """Whether an output that Execute clears is to be shown: while Execute is true, and in one call at least."""
        due = self._edge or name not in self._seen
        self._seen.add(name)
        return due


class MotionBlock(ExecuteBlock):
    """A block whose command moves the axis: others can abort it, and it can wait for others."""

    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=_in_control(feedback, self._given))


class MC_Reset(ExecuteBlock):  # noqa: N801
    """Clears the fault of an axis. There is no CommandAborted: a reset that another one supersedes follows the axis. It
    is Busy while the axis still brakes, then Done when the fault is cleared, and Error when it is not."""

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


class MC_MoveAbsolute(MotionBlock):  # noqa: N801
    """Moves to a position."""

    VERB = "move_absolute"
    Position = Input(0.0, "position")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.SHORTEST, "direction")
    Done = Output(False)


class MC_MoveRelative(MotionBlock):  # noqa: N801
    """Moves by a distance."""

    VERB = "move_relative"
    Distance = Input(0.0, "distance")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)


class MC_MoveAdditive(MC_MoveRelative):  # noqa: N801
    """Moves by a distance from where the move in progress was to end."""

    VERB = "move_additive"


class MC_MoveVelocity(MotionBlock):  # noqa: N801
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
    """Brakes to standstill. The axis stays in Stopping, and takes no other motion, as long as Execute is true; another
    stop is refused then."""

    VERB = "stop"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Done = Output(False)

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"hold": True}

    def _fall(self) -> None:
        if self._feedback is not None and not (self._feedback.error or self._feedback.aborted):
            self._feedback.release()


class MC_Power(FunctionBlock):  # noqa: N801
    """Keeps power stage and position loop as the level of Enable says, whoever switched them: gives a command whenever
    the axis is Disabled and Enable true, or the other way round. Status: the loop is closed.

    A fault that opened the loop is shown by Error until the axis is reset; then the loop is closed again. Enable true
    on a Disabled axis with a fault leads to ErrorStop. A command that is refused is given again once the axis is in
    another state. One instance an axis: two with different Enable switch it to and fro."""

    Enable = Input(False)
    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")
    Status = Output(False)
    Valid = Output(False)
    Busy = Output(False)
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._level: bool | None = None  # Enable in the call before
        self._feedback: Feedback | None = None  # of the command in progress ...
        self._given: dict[str, Any] = {}  # ... and its arguments
        self._refusal: tuple[_commands.PlcState, int] | None = None  # of the last command: the axis' state, the error
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        enable = bool(self.Enable)
        ended = self._end(enable)
        state = self.Axis.state
        if enable is not self._level or (self._refusal and self._refusal[0] is not state):
            self._refusal = None
        self._level = enable
        if self._is_due(enable, state):
            self._given = {"enable": enable, **self._arguments()}
            self._feedback = self.Axis.session.command(self.Axis.name, "power", self._given)
            ended = self._end(enable) or ended
        self._show_all(enable, state, ended)

    def _end(self, enable: bool) -> Feedback | None:
        """The command that has ended since the call before."""
        ended = self._feedback
        if ended is None or ended.busy:
            return None
        self._feedback = None
        self.Axis.session._catch_up(ended.cycle)
        refused = ended.error and (ended.ticket == 0 or not enable)
        if self._given["enable"] is enable and (refused or (ended.aborted and not enable)):
            self._refusal = (self.Axis.state, ended.error_id)
        return ended

    def _is_due(self, enable: bool, state: _commands.PlcState) -> bool:
        """Whether a command is to be given now."""
        if self._refusal is not None:
            return False
        if self._feedback is not None:
            return bool(self._given["enable"]) and not enable
        disabled = state is _commands.PlcState.DISABLED
        return disabled and not self.Axis.active_command if enable else not disabled

    def _show_all(self, enable: bool, state: _commands.PlcState, ended: Feedback | None) -> None:
        status = self.Axis.loop_closed
        error_id = ended.error_id if ended is not None and ended.error else 0
        if self._refusal is not None:
            error_id = self._refusal[1]
        if enable and not status and state is _commands.PlcState.ERROR_STOP:
            error_id = self.Axis.error
        self._show(Status=status, Valid=enable and not error_id)
        if ended is not None and ended.aborted:
            self._show(CommandAborted=True)
        elif error_id:
            self._show_error(error_id)
        elif self._feedback is not None or (enable and not status):
            self._show(Busy=True, Active=self._feedback is None or _in_control(self._feedback, self._given))


class ReadBlock(FunctionBlock):
    """A block that shows something as long as Enable is true."""

    Enable = Input(False)
    Valid = Output(False)
    Busy = Output(False)

    def _scan(self) -> None:
        if self.Enable:
            self._show(Valid=True, Busy=True)
            self._read()

    def _read(self) -> None:
        raise NotImplementedError


class MC_ReadStatus(ReadBlock):  # noqa: N801
    """The state of the axis, one output for each."""

    ErrorStop = Output(False)
    Disabled = Output(False)
    Stopping = Output(False)
    Homing = Output(False)
    Standstill = Output(False)
    DiscreteMotion = Output(False)
    ContinuousMotion = Output(False)
    SynchronizedMotion = Output(False)

    def _read(self) -> None:
        self._show(**{self.Axis.state.value: True})


class MC_ReadAxisError(ReadBlock):  # noqa: N801
    """The fault of the axis by number; 0: none. Error and ErrorID say that of the axis, too: the block itself has none,
    and what it shows is valid."""

    AxisErrorID = Output(0)

    def _read(self) -> None:
        error_id = self.Axis.error
        self._show(AxisErrorID=error_id, Error=error_id != 0, ErrorID=error_id)

    @property
    def text(self) -> str:
        """The fault for people; empty without one."""
        return error_text(self.AxisErrorID) if self.AxisErrorID else ""


class MC_ReadActualPosition(ReadBlock):  # noqa: N801
    """The measured position, in u."""

    Position = Output(0.0)

    def _read(self) -> None:
        self._show(Position=self.Axis.actual_position)


class MC_ReadActualVelocity(ReadBlock):  # noqa: N801
    """The measured velocity, in u/s."""

    Velocity = Output(0.0)

    def _read(self) -> None:
        self._show(Velocity=self.Axis.actual_velocity)


class MC_ReadActualTorque(ReadBlock):  # noqa: N801
    """The torque in Nm as the drive reports it; the force in N on linear motors."""

    Torque = Output(0.0)

    def _read(self) -> None:
        self._show(Torque=self.Axis.torque_nm)


class GT_Jog(FunctionBlock):  # noqa: N801
    """Moves as long as JogPos or JogNeg is held, while Enable is true. The direction pressed first wins; both must be
    let go before the next jog, so a key that is held while Enable becomes true does nothing. Velocities and ramps count
    when a key is pressed or let go; a jog that cannot go on with them ends."""

    Enable = Input(False)
    JogPos = Input(False)
    JogNeg = Input(False)
    JogVelo = Input[float | None](None, "velocity")
    JogAcc = Input[float | None](None, "acceleration")
    JogDec = Input[float | None](None, "deceleration")
    JogJerk = Input[float | None](None, "jerk")

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._keys = (False, False)  # that counted in the call before
        self._up = True  # both keys were, Enable or not
        self._feedback: Feedback | None = None
        self._changed: list[Feedback] = []  # jogs before that one, which end when it is accepted
        self._seen = True  # the error of that one, if any
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        pressed = (bool(self.JogPos), bool(self.JogNeg))
        keys = pressed if self.Enable else (False, False)
        if keys != self._keys:
            self._press(keys)
        self._keys = keys
        self._up = not any(pressed)
        failed = self._feedback is not None and self._feedback.error
        if failed or not any(keys):
            self._release()
        if self._feedback is not None and failed and (any(keys) or not self._seen):
            self._show_error(self._feedback.error_id)
            self._seen = True

    def _press(self, keys: tuple[bool, bool]) -> None:
        jogs = self._feedback is not None and self._feedback.busy and not self._feedback.released
        if not any(keys) or not (jogs or self._up):
            return
        if self._feedback is not None:
            self._changed = [f for f in (*self._changed, self._feedback) if f.busy]
        self._feedback = self.Axis.jog(forward=keys[0], backward=keys[1], **self._arguments())
        self._seen = False

    def _release(self) -> None:
        for jog in (*self._changed, self._feedback):
            if jog is not None and jog.busy and not jog.released:
                jog.release()


MC_Jog = GT_Jog

BLOCKS: tuple[type[FunctionBlock], ...] = (
    MC_Power,
    MC_Reset,
    MC_ReadStatus,
    MC_ReadAxisError,
    MC_ReadActualPosition,
    MC_ReadActualVelocity,
    MC_ReadActualTorque,
    MC_MoveAbsolute,
    MC_MoveRelative,
    MC_MoveAdditive,
    MC_MoveVelocity,
    MC_Halt,
    MC_Stop,
    GT_Jog,
)

__all__ = ["BLOCKS", "FunctionBlock", "MC_Jog"]
__all__ += [block.__name__ for block in BLOCKS]
