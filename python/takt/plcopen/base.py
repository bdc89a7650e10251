"""What all function blocks are made of: inputs and outputs, edges of Execute, levels of Enable."""

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
AnyAxis = Axis  # where a member is called Axis


class Input(Generic[T]):
    """An input of a block; `argument` is its name among the command's arguments, where it is one. `alias` is another
    name of the same input. Where `initial` is a member of an enumeration, the text of a member stands for it; any other
    value is kept as it is, and refused: by the command that has it as an argument, else by the block."""

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


class AxisName:
    """Another name of the axis: where it follows others, PLCopen calls it Slave."""

    @overload
    def __get__(self, block: None, owner: type) -> AxisName: ...
    @overload
    def __get__(self, block: FunctionBlock, owner: type) -> Axis: ...
    def __get__(self, block: FunctionBlock | None, owner: type) -> Axis | AxisName:
        return self if block is None else block.Axis

    def __set__(self, block: FunctionBlock, axis: Axis) -> None:
        setattr(block, block.SUBJECT, axis)


class FunctionBlock:
    """What all blocks have: the component that they command or show, inputs, outputs."""

    SUBJECT: ClassVar[str] = "Axis"  # what the component is called ...
    AXES: ClassVar[frozenset[str]] = frozenset({"Axis"})  # ... with other names of it
    INPUTS: ClassVar[Mapping[str, Input[Any]]] = {}
    OUTPUTS: ClassVar[Mapping[str, Output[Any]]] = {}
    CHOICES: ClassVar[Mapping[str, type[Enum]]] = {}  # inputs that are enumerations and no arguments of a command

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
        """One call of the block, with new values of some inputs. Returns the block, its outputs up to date."""
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
        """The inputs that are arguments of the command."""
        return {i.argument: getattr(self, n) for n, i in self.INPUTS.items() if i.argument}

    def _wrong_choice(self) -> str:
        """Which input of CHOICES has a value that is no member of its enumeration; empty: none has."""
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
    """The member of the enumeration of `usual` for which `value` stands: its text, for a buffer mode also its number, 0
    aborting to 5 blending_high (PLCopen's mcAborting ...). Returns `value` itself where there is none."""
    if not isinstance(usual, Enum):
        return value
    members: list[Enum] = list(type(usual))
    if isinstance(usual, _commands.BufferMode) and isinstance(value, int) and not isinstance(value, bool):
        return members[value] if 0 <= value < len(members) else value
    return next((member for member in members if isinstance(value, str) and value == member.value), value)


def in_control(feedback: Feedback, arguments: Mapping[str, Any]) -> bool:
    """Active of a command in progress; one that does not wait for others is as soon as it is given."""
    return feedback.active or arguments["buffer_mode"] == _commands.BufferMode.ABORTING


def found_no_room(feedback: Feedback | None) -> bool:
    """Whether a command was refused because the command queue is full: blocks that follow the level of Enable give it
    again in their next call."""
    return feedback is not None and feedback.error_id == QUEUE_FULL


class ExecuteBlock(FunctionBlock):
    """A block that gives a command on the rising edge of Execute."""

    VERB: ClassVar[str]

    Execute = Input(False)
    Busy = Output(False)

    def __init__(self, subject: Component, **inputs: Any) -> None:
        self._edge = False  # Execute in the call before
        self._given: dict[str, Any] = {}  # the arguments of the command
        self._feedback: Feedback | None = None
        self._wrong = ""  # why no command was given: an input has a value that it cannot have
        self._ending: tuple[str, int] | None = None  # of the command: the output that says so, the error's number
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
        """The falling edge of Execute. The command goes on all the same."""

    def _hold(self) -> None:
        """Execute is still true."""

    def _follow(self, feedback: Feedback) -> None:
        self._ending = self._ending or self._end(feedback)
        if self._ending is None:
            self._run(feedback)
        elif self._is_due(self._ending[0]):
            name, error_id = self._ending
            self._show_error(error_id, feedback.sentence) if name == "Error" else self._show(**{name: True})

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


class SettingBlock(ExecuteBlock):
    """A block whose command takes no control of what it is given to: done at once, or refused."""

    Done = Output(False)


class MotionBlock(ExecuteBlock):
    """A block whose command moves something: others can abort it, and it can wait for others."""

    BufferMode = Input(_commands.BufferMode.ABORTING, "buffer_mode")
    Active = Output(False)
    CommandAborted = Output(False)
    Aborted = Output(False, alias="CommandAborted")

    def _run(self, feedback: Feedback) -> None:
        super()._run(feedback)
        self._show(Active=in_control(feedback, self._given))


class ChangedBlock(ExecuteBlock):
    """A motion whose inputs may change while Execute is true: with ContinuousUpdate true at the rising edge each change
    is commanded, once the command is in control, and the motion goes on from where it is. A change that is refused is
    an error of the block; the motion goes on as it did."""

    AT_ONCE: ClassVar[dict[str, Any]] = {}  # arguments of a change, whatever the inputs say

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
        """The command that changes the one in control (`self._given`) into what is wanted."""
        return self.VERB, wanted


class UpdatedBlock(MotionBlock, ChangedBlock):
    """Such a motion that may wait for others: it changes once it is in control."""

    AT_ONCE: ClassVar[dict[str, Any]] = {"buffer_mode": _commands.BufferMode.ABORTING}

    def _is_in_control(self, feedback: Feedback) -> bool:
        return in_control(feedback, self._given)

    def _changed(self, wanted: dict[str, Any]) -> tuple[str, dict[str, Any]]:
        return self.VERB, wanted | {"update": True}  # takes nothing from what another program has given since


class ReadBlock(FunctionBlock):
    """A block that shows something as long as Enable is true."""

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
