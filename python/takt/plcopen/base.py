"""Basis of all function blocks: inputs and outputs, edges of Execute, levels of Enable."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any, ClassVar, Generic, TypeVar, overload

from takt import _commands
from takt.axis import Axis
from takt.component import Component
from takt.engine import error_text
from takt.feedback import QUEUE_FULL, Feedback, FeedbackState

PARAMETER = 5  # error of a command: an input is out of its range
ENDINGS = {FeedbackState.DONE: "Done", FeedbackState.ABORTED: "CommandAborted", FeedbackState.ERROR: "Error"}

T = TypeVar("T")
AnyAxis = Axis  # for classes with a member called Axis


class Input(Generic[T]):
    """An input of a block. `argument` is its name among the command's arguments ("": it is none). `alias` is the input
    that this is another name of. If `initial` is a member of an enumeration, the text of a member may be assigned as
    well; any other value is kept, and refused: by the command that has it as an argument, else by the block."""

    def __init__(self, initial: T, argument: str = "", *, alias: str = "") -> None:
        self.initial = initial
        self.argument = argument
        self.alias = alias
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
        value: T = block._inputs.get(self.alias or self.name, self.initial)
        return value

    def __set__(self, block: FunctionBlock, value: T) -> None:
        block._inputs[self.alias or self.name] = member_of(self.initial, value)


class Output(Generic[T]):
    """An output of a block; only the block itself sets it. `alias` is the output that this is another name of."""

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


class AxisName:
    """Another name of the axis: PLCopen calls it Slave in couplings."""

    @overload
    def __get__(self, block: None, owner: type) -> AxisName: ...
    @overload
    def __get__(self, block: FunctionBlock, owner: type) -> Axis: ...
    def __get__(self, block: FunctionBlock | None, owner: type) -> Axis | AxisName:
        return self if block is None else block.Axis

    def __set__(self, block: FunctionBlock, axis: Axis) -> None:
        setattr(block, block.SUBJECT, axis)


class FunctionBlock:
    """Base of all blocks: the component that they command or show, inputs and outputs."""

    SUBJECT: ClassVar[str] = "Axis"  # name of the component ...
    AXES: ClassVar[frozenset[str]] = frozenset({"Axis"})  # ... and its other names
    INPUTS: ClassVar[Mapping[str, Input[Any]]] = {}
    OUTPUTS: ClassVar[Mapping[str, Output[Any]]] = {}
    CHOICES: ClassVar[Mapping[str, type[Enum]]] = {}  # inputs that are enumerations and not arguments of a command

    Error = Output(False)
    ErrorID = Output(0)
    ErrorText = Output("")  # the sentence of the error

    def __init_subclass__(cls) -> None:
        members = [(n, m) for base in reversed(cls.__mro__) for n, m in vars(base).items()]
        cls.INPUTS = {n: m for n, m in members if isinstance(m, Input)}
        cls.OUTPUTS = {n: m for n, m in members if isinstance(m, Output)}
        choices = {n: i.initial for n, i in cls.INPUTS.items() if not i.argument and not i.alias}
        cls.CHOICES = {n: type(usual) for n, usual in choices.items() if isinstance(usual, Enum)}
        cls.AXES = frozenset({cls.SUBJECT, *(n for n, m in members if isinstance(m, AxisName))})

    Axis: AnyAxis

    def __init__(self, subject: Component, **inputs: Any) -> None:
        self._inputs: dict[str, Any] = {}
        self._outputs: dict[str, Any] = {}
        setattr(self, self.SUBJECT, subject)
        self._assign(inputs)

    @property
    def _subject(self) -> Component:
        subject: Component = getattr(self, self.SUBJECT)
        return subject

    def __call__(self, **inputs: Any) -> Any:
        """Executes the block once, with new values of some inputs. Returns the block with its outputs updated. Raises
        TypeError if it has no such input."""
        self._assign(inputs)
        self._outputs = {}
        self._scan()
        return self

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_") and name not in {*self.AXES, *self.INPUTS, *self.OUTPUTS}:
            raise AttributeError(self._no_input(name))
        super().__setattr__(name, value)

    @property
    def outputs(self) -> dict[str, Any]:
        """All outputs by name."""
        return {name: getattr(self, name) for name in self.OUTPUTS}

    def _assign(self, inputs: Mapping[str, Any]) -> None:
        for name, value in inputs.items():
            if name not in self.INPUTS and name not in self.AXES:
                raise TypeError(self._no_input(name))
            setattr(self, name, value)

    def _no_input(self, name: str) -> str:
        return f"{type(self).__name__} has no input '{name}' (it has {', '.join(self.INPUTS)})"

    def _arguments(self) -> dict[str, Any]:
        """Returns the inputs that are arguments of the command, by the argument's name."""
        return {i.argument: getattr(self, n) for n, i in self.INPUTS.items() if i.argument}

    def _wrong_choice(self) -> str:
        """Returns the error of the first input of CHOICES whose value is not a member of its enumeration; empty if all
        are valid."""
        for name, kind in self.CHOICES.items():
            value = getattr(self, name)
            if not isinstance(value, kind):
                expected = ", ".join(member.value for member in kind)
                return f"{name}: expected one of {expected}, found {value!r}"
        return ""

    def _show(self, **outputs: Any) -> None:
        for name in outputs:
            if name not in self.OUTPUTS:
                raise AttributeError(f"{type(self).__name__} has no output '{name}'")
        self._outputs.update(outputs)

    def _show_error(self, error_id: int, text: str = "") -> None:
        self._show(Error=True, ErrorID=error_id, ErrorText=text or error_text(error_id))

    def _scan(self) -> None:
        raise NotImplementedError


def member_of(usual: Any, value: Any) -> Any:
    """Returns the member of the enumeration of `usual` that `value` denotes: by its text, for a buffer mode also by its
    number, 0 aborting to 5 blending_high (PLCopen's mcAborting ...). Returns `value` unchanged if it denotes none, or
    `usual` is not a member of an enumeration."""
    if not isinstance(usual, Enum):
        return value
    members: list[Enum] = list(type(usual))
    if isinstance(usual, _commands.BufferMode) and isinstance(value, int) and not isinstance(value, bool):
        return members[value] if 0 <= value < len(members) else value
    return next((member for member in members if isinstance(value, str) and value == member.value), value)


def in_control(feedback: Feedback, arguments: Mapping[str, Any]) -> bool:
    """Returns the output Active for a command in progress; with buffer mode aborting it is true as soon as the command
    is given."""
    return feedback.active or arguments["buffer_mode"] == _commands.BufferMode.ABORTING


def found_no_room(feedback: Feedback | None) -> bool:
    """Returns whether a command was refused because the command queue is full: blocks that follow the level of Enable
    repeat it in their next call."""
    return feedback is not None and feedback.error_id == QUEUE_FULL


class ExecuteBlock(FunctionBlock):
    """A block that gives a command on the rising edge of Execute."""

    VERB: ClassVar[str]

    Execute = Input(False)
    Busy = Output(False)

    def __init__(self, subject: Component, **inputs: Any) -> None:
        self._edge = False  # Execute in the previous call
        self._given: dict[str, Any] = {}  # the arguments of the command
        self._feedback: Feedback | None = None
        self._wrong = ""  # why no command was given: an input has an invalid value
        self._ending: tuple[str, int] | None = None  # of the command: the output that shows it, the error number
        self._seen: set[str] = set()  # outputs that were shown for this command
        super().__init__(subject, **inputs)

    def _scan(self) -> None:
        execute = bool(self.Execute)
        if execute and not self._edge:
            self._wrong = self._wrong_choice()
            self._given = self._arguments()
            self._feedback = None if self._wrong else self._command()
            self._ending = None
            self._seen = set()
        elif self._edge and not execute:
            self._fall()
        elif execute:
            self._hold()
        self._edge = execute
        if self._feedback is not None:
            self._follow(self._feedback)
        elif self._wrong and self._is_due("Error"):
            self._show_error(PARAMETER, self._wrong)

    def _command(self) -> Feedback:
        """Gives the command."""
        return self._subject.session.command(self._subject.name, self.VERB, self._given)

    def _fall(self) -> None:
        """Handles the falling edge of Execute. The command continues nevertheless."""

    def _hold(self) -> None:
        """Handles a call in which Execute stays true."""

    def _follow(self, feedback: Feedback) -> None:
        self._ending = self._ending or self._end(feedback)
        if self._ending is None:
            self._run(feedback)
        elif self._is_due(self._ending[0]):
            name, error_id = self._ending
            self._show_error(error_id, feedback.sentence) if name == "Error" else self._show(**{name: True})

    def _end(self, feedback: Feedback) -> tuple[str, int] | None:
        """Returns the output that shows how the command ended, and the error number; None while it is in progress."""
        return (ENDINGS[feedback.state], feedback.error_id) if feedback.final else None

    def _run(self, feedback: Feedback) -> None:
        """Shows the outputs of a command in progress."""
        self._show(Busy=True)

    def _is_due(self, name: str) -> bool:
        """Returns whether an output that Execute clears is to be shown: while Execute is true, and in at least one
        call."""
        due = self._edge or name not in self._seen
        self._seen.add(name)
        return due


class SettingBlock(ExecuteBlock):
    """A block whose command does not take control of its component: done at once, or refused."""

    Done = Output(False)


class MotionBlock(ExecuteBlock):
    """A block whose command is a motion: other commands can abort it, and it can wait for others (BufferMode)."""

    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=in_control(feedback, self._given))


class ChangedBlock(ExecuteBlock):
    """A motion whose inputs may change while Execute is true. If ContinuousUpdate was true at the rising edge, each
    change is commanded once the command is in control, and the motion continues from its present state. A refused
    change is an error of the block; the motion continues unchanged."""

    AT_ONCE: ClassVar[dict[str, Any]] = {}  # arguments of a change, which replace those of the inputs

    ContinuousUpdate = Input(False)

    def __init__(self, subject: Component, **inputs: Any) -> None:
        self._updates = False
        super().__init__(subject, **inputs)

    def _command(self) -> Feedback:
        self._updates = bool(self.ContinuousUpdate)
        return super()._command()

    def _hold(self) -> None:
        feedback = self._feedback
        if not self._updates or feedback is None or feedback.final or not self._is_in_control(feedback):
            return
        self._wrong = self._wrong_choice()
        if self._wrong:
            self._feedback = None
            return
        wanted = self._arguments() | self.AT_ONCE
        if wanted == self._given | self.AT_ONCE:
            return
        verb, arguments = self._changed(wanted)
        self._given = wanted
        self._feedback = self._subject.session.command(self._subject.name, verb, arguments)

    def _is_in_control(self, feedback: Feedback) -> bool:
        return feedback.busy

    def _changed(self, wanted: dict[str, Any]) -> tuple[str, dict[str, Any]]:
        """Returns verb and arguments of the command that changes the one in control (`self._given`) into `wanted`."""
        return self.VERB, wanted


class UpdatedBlock(MotionBlock, ChangedBlock):
    """A ChangedBlock whose command may wait for others: changes are commanded only once it is in control."""

    AT_ONCE: ClassVar[dict[str, Any]] = {"buffer_mode": _commands.BufferMode.ABORTING}

    def _is_in_control(self, feedback: Feedback) -> bool:
        return in_control(feedback, self._given)

    def _changed(self, wanted: dict[str, Any]) -> tuple[str, dict[str, Any]]:
        return self.VERB, wanted | {"update": True}  # does not abort commands that another program has given since


class ReadBlock(FunctionBlock):
    """A block that shows values as long as Enable is true."""

    Enable = Input(False)
    Valid = Output(False)
    Busy = Output(False)

    def _scan(self) -> None:
        if not self.Enable:
            return
        if wrong := self._wrong_choice():
            self._show_error(PARAMETER, wrong)
            return
        self._show(Valid=True, Busy=True)
        self._read()

    def _read(self) -> None:
        raise NotImplementedError
