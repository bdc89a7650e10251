"""Function blocks with PLCopen's names, inputs and outputs, for those who think in them.

A block is an instance that is called once a cycle, usually in a program of the session:

    move = MC_MoveAbsolute(session.axis("x"))

    @session.program
    def scan() -> None:
        move(Execute=start, Position=100.0, Velocity=50.0)
        if move.Done: ...

The rules that all blocks keep: an input that is not given keeps its value from the call before. Inputs count on the
rising edge of Execute. While Execute is true, exactly one of Busy, Done, CommandAborted and Error is. Done,
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
from takt.feedback import Feedback

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

    def _show(self, **outputs: Any) -> None:
        self._outputs.update(outputs)

    def _scan(self) -> None:
        raise NotImplementedError


class ExecuteBlock(FunctionBlock):
    """A block that gives a command on the rising edge of Execute."""

    VERB: ClassVar[str]

    Execute = Input(False)
    Done = Output(False)
    Busy = Output(False)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._edge = False  # Execute in the call before
        self._feedback: Feedback | None = None
        self._seen: set[str] = set()  # outputs that were shown for this command
        super().__init__(axis, **inputs)

    def _arguments(self) -> dict[str, Any]:
        return {i.argument: getattr(self, n) for n, i in self.INPUTS.items() if i.argument}

    def _scan(self) -> None:
        execute = bool(self.Execute)
        if execute and not self._edge:
            self._feedback = self.Axis.session.command(self.Axis.name, self.VERB, self._arguments())
            self._seen = set()
        elif self._edge and not execute:
            self._fall()
        self._edge = execute
        if self._feedback is not None:
            self._follow(self._feedback, execute)

    def _fall(self) -> None:
        """The falling edge of Execute. The command goes on all the same."""

    def _follow(self, feedback: Feedback, execute: bool) -> None:
        final = {"Done": feedback.done, "CommandAborted": feedback.aborted, "Error": feedback.error}
        shown = {name for name, state in final.items() if state}
        if feedback.busy:
            self._show(Busy=True, Active=feedback.active)
            if feedback.reached:
                shown.add("InVelocity")
        for name in shown:
            if execute or name not in self._seen:
                self._show(**{name: True})
                self._seen.add(name)
                if name == "Error":
                    self._show(ErrorID=feedback.error_id)


class MotionBlock(ExecuteBlock):
    """A block whose command moves the axis: others can abort it, and it can wait for others."""

    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")


class MC_Reset(ExecuteBlock):  # noqa: N801
    """Clears the fault of an axis."""

    VERB = "reset"


class MC_MoveAbsolute(MotionBlock):  # noqa: N801
    """Moves to a position."""

    VERB = "move_absolute"
    Position = Input(0.0, "position")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.SHORTEST, "direction")
    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")


class MC_MoveRelative(MotionBlock):  # noqa: N801
    """Moves by a distance."""

    VERB = "move_relative"
    Distance = Input(0.0, "distance")
    Velocity = Input[float | None](None, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")


class MC_MoveVelocity(MotionBlock):  # noqa: N801
    """Moves on and on. Never done: InVelocity says that the velocity is reached."""

    VERB = "move_velocity"
    Velocity = Input(0.0, "velocity")
    Acceleration = Input[float | None](None, "acceleration")
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    Direction = Input(_commands.Direction.POSITIVE, "direction")
    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")
    InVelocity = Output(False)


class MC_Halt(MotionBlock):  # noqa: N801
    """Brakes to standstill; another command may take over on the way."""

    VERB = "halt"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")
    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")


class MC_Stop(MotionBlock):  # noqa: N801
    """Brakes to standstill. The axis stays in Stopping, and takes no other motion, as long as Execute is true."""

    VERB = "stop"
    Deceleration = Input[float | None](None, "deceleration")
    Jerk = Input[float | None](None, "jerk")

    def _arguments(self) -> dict[str, Any]:
        return super()._arguments() | {"hold": True}

    def _fall(self) -> None:
        if self._feedback is not None and not (self._feedback.error or self._feedback.aborted):
            self._feedback.release()


class MC_Power(FunctionBlock):  # noqa: N801
    """Switches the power stage and the position loop with the level of Enable. Status: they are on."""

    Enable = Input(False)
    Status = Output(False)
    Valid = Output(False)
    Busy = Output(False)

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._level = False  # that was asked for last
        self._feedback: Feedback | None = None
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        enable = bool(self.Enable)
        if enable != self._level:
            self._level = enable
            self._feedback = self.Axis.power(enable=enable)
        feedback = self._feedback
        failed = feedback is not None and feedback.error
        self._show(Status=self.Axis.loop_closed, Valid=enable and not failed)
        if feedback is not None:
            self._show(Busy=feedback.busy, Error=failed, ErrorID=feedback.error_id if failed else 0)


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
    """The fault of the axis by number; 0: none."""

    AxisErrorID = Output(0)

    def _read(self) -> None:
        self._show(AxisErrorID=self.Axis.error)

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
    let go before the next jog. Velocities and ramps count when a key is pressed or let go."""

    Enable = Input(False)
    JogPos = Input(False)
    JogNeg = Input(False)
    JogVelo = Input[float | None](None, "velocity")
    JogAcc = Input[float | None](None, "acceleration")
    JogDec = Input[float | None](None, "deceleration")
    JogJerk = Input[float | None](None, "jerk")

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._keys = (False, False)
        self._feedback: Feedback | None = None
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        keys = (bool(self.Enable and self.JogPos), bool(self.Enable and self.JogNeg))
        if keys != self._keys:
            self._press(keys)
            self._keys = keys
        if self._feedback is not None and self._feedback.error:
            self._show(Error=True, ErrorID=self._feedback.error_id)

    def _press(self, keys: tuple[bool, bool]) -> None:
        running = self._feedback is not None and self._feedback.busy
        if not any(keys):
            if self._feedback is not None and running:
                self._feedback.release()
            self._feedback = None
            return
        if any(self._keys) and not running:
            return  # refused or aborted: both keys must be let go first
        arguments = {i.argument: getattr(self, n) for n, i in self.INPUTS.items() if i.argument}
        self._feedback = self.Axis.jog(forward=keys[0], backward=keys[1], **arguments)


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
    MC_MoveVelocity,
    MC_Halt,
    MC_Stop,
    GT_Jog,
)

__all__ = ["BLOCKS", "FunctionBlock", "MC_Jog"]
__all__ += [block.__name__ for block in BLOCKS]
