"""Executes the lines of a program in the order given by o-words, M98 and M99.

A program is a list of lines and a position in it; o-words move the position along links that were found when the text
was read, calls save the position to return to. The number of lines without repetition is not limited, that of repeated
lines is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from takt.gcode.errors import LineError
from takt.gcode.expressions import Value, evaluate
from takt.gcode.machine import Flow, Machine, Modal
from takt.gcode.parameters import Parameters
from takt.gcode.source import Block, OWord, Text
from takt.gcode.words import program_name

MOST_LINES = 1_000_000  # executed by repetition
MOST_CALLS = 10  # nested calls, as in LinuxCNC


@dataclass
class _Frame:
    """A call, or the program itself."""

    text: Text  # of the sub or program called
    back: tuple[Text, int] | None = None  # the line after the call
    kept: tuple[dict[int, float], dict[str, float]] | None = None  # the caller's parameters; None: M98 saves none
    first: int = 0  # line at which an M98 call begins
    left: int = 0  # remaining repetitions of an M98 call
    repeats: dict[int, int] = field(default_factory=dict)  # by line of an active repeat: remaining repetitions
    modal: Modal | None = None  # saved by M70 or M73
    restore: bool = False  # True: restore `modal` on return (M73)


class Runner:
    def __init__(
        self, main: Text, machine: Machine, parameters: Parameters, dialect: str, find: Callable[[str], Text | None]
    ) -> None:
        self._text, self._at = main, main.first
        self._machine, self._parameters = machine, parameters
        self._dialect, self._find = dialect, find
        self._frames = [_Frame(main)]
        self._loaded: dict[str, Text] = {}
        self._begun = False  # a word has been executed

    def place(self) -> str:
        return self._text.place(self._at)

    def run(self) -> None:
        """Executes the program. Raises LineError, with the position of the line unless the error has one."""
        try:
            self._run()
            self._machine.end()
        except LineError as error:
            raise LineError(str(error), error.place or self.place()) from None

    def _run(self) -> None:
        machine, parameters = self._machine, self._parameters
        count = 0
        while True:
            text = self._text
            if self._at >= len(text.lines):
                if len(self._frames) == 1:
                    return
                raise LineError("the file ends within a sub; expected endsub, return or M99")
            line = text.line(self._at)
            count += 1
            if count > MOST_LINES and count > MOST_LINES + len(text.lines):
                raise LineError(f"more than {MOST_LINES:,} lines were repeated; a loop does not end")
            if type(line) is Block:
                codes, numbers = (line.codes, line.numbers) if line.words is None else line.now(parameters)
                if line.settings:
                    self._set(line.settings)
                if codes or numbers:
                    self._begun = True
                    flow = machine.run(codes, numbers)
                    if flow is not None and self._follow(flow):
                        return
                self._at += 1
            else:
                assert isinstance(line, OWord)
                self._o_word(line)

    def _set(self, settings: list[tuple[str | Value, Value]]) -> None:
        """Sets parameters; all values are evaluated before the first one is set."""
        parameters = self._parameters
        found = [(target, evaluate(value, parameters)) for target, value in settings]
        for target, value in found:
            if isinstance(target, str):
                parameters.set_name(target, value)
            else:
                parameters.set_number(evaluate(target, parameters), value)

    def _follow(self, flow: Flow) -> bool:
        """Applies the effect of a line on the order of lines. Returns True if the program ends."""
        frame = self._frames[-1]
        if flow.code == "M2":
            return True
        if flow.code == "M98":
            self._call_program(flow)
        elif flow.code == "M99":
            if len(self._frames) == 1:
                self._machine.left_out["M99, which repeats the program for ever"] += 1
                return True
            if frame.kept is not None:
                raise LineError("M99 ends programs that M98 calls; expected O- endsub or return")
            if frame.left > 0:
                frame.left -= 1
                frame.repeats.clear()
                self._at = frame.first
            else:
                self._return(None)
                self._at -= 1  # the caller adds 1
        elif flow.code in ("M70", "M73"):
            frame.modal, frame.restore = self._machine.modal, flow.code == "M73" and len(self._frames) > 1
        elif flow.code == "M71":
            frame.modal, frame.restore = None, False
        elif frame.modal is None:
            raise LineError("M72 has no M70 before it")
        else:
            self._machine.restore(frame.modal)
        return False

    def _call_program(self, flow: Flow) -> None:
        number, count = flow.program, flow.count
        name = program_name(number)
        if name not in self._text.programs and self._dialect in ("fanuc", "rs274") and number >= 10_000 and count == 1:
            count, number = divmod(number, 10_000)
            name = program_name(number)
        if count != int(count) or count < 0:
            raise LineError(f"M98: L: expected a whole number of repeats, found {count:g}")
        first = self._text.programs.get(name)
        if first is None:
            kind = "a sub, which M98 does not call" if name in self._text.subs else "none"
            raise LineError(f"M98: expected a program O{name} in this file, found {kind}")
        if count > 0:
            self._push(_Frame(self._text, (self._text, self._at + 1), None, first, int(count) - 1))
            self._at = first  # the caller adds 1

    def _push(self, frame: _Frame) -> None:
        if len(self._frames) > MOST_CALLS:
            raise LineError(f"calls nest deeper than {MOST_CALLS}")
        self._frames.append(frame)
        self._parameters.level = len(self._frames) - 1

    def _return(self, value: float | None) -> None:
        frame = self._frames.pop()
        assert frame.back is not None
        if frame.restore and frame.modal is not None:
            self._machine.restore(frame.modal)
        if frame.kept is not None:
            self._parameters.leave(frame.kept)
            self._parameters.returned = value
        self._parameters.level = len(self._frames) - 1
        self._text, self._at = frame.back

    def _o_word(self, line: OWord) -> None:
        """Executes an o-word: moves to the next line."""
        text, at, keyword = self._text, self._at, line.keyword
        repeats = self._frames[-1].repeats
        if keyword == "CALL":
            self._call(line)
        elif keyword == "":
            if self._begun and (len(self._frames) > 1 or at != self._frames[0].first):
                raise LineError(f"O{line.name} begins before the program above it ends; expected M2, M30 or M99 there")
            self._at += 1
        elif keyword == "SUB":
            self._at = text.links[at] + 1
        elif keyword in ("ENDSUB", "RETURN"):
            if len(self._frames) == 1 or self._frames[-1].kept is None:
                raise LineError(f"{keyword.lower()}, but no sub was called")
            self._return(self._value(line) if line.arguments else None)
        elif keyword == "IF":
            self._branch(line)
        elif keyword in ("ELSEIF", "ELSE"):  # after the branch that was taken
            self._at = text.links[-1 - at]
        elif keyword == "WHILE" and text.links[at] < at:  # of do
            self._at = text.links[at] + 1 if self._value(line) else at + 1
        elif keyword == "WHILE":
            self._at = at + 1 if self._value(line) else text.links[at] + 1
        elif keyword in ("ENDWHILE", "ENDREPEAT"):
            self._at = text.links[at]
        elif keyword == "REPEAT":
            left = repeats.pop(at, None)
            left = round(self._value(line)) if left is None else left - 1
            if left > 0:
                repeats[at] = left
            self._at = at + 1 if left > 0 else text.links[at] + 1
        elif keyword == "BREAK":
            self._leave_loops(range(text.links[-1 - at], text.links[at]))
            self._at = text.links[at] + 1
        elif keyword == "CONTINUE":
            self._leave_loops(range(text.links[-1 - at] + 1, text.links[at]))
            begin = text.line(text.links[-1 - at])
            is_do = isinstance(begin, OWord) and begin.keyword == "DO"
            self._at = text.links[at] if is_do else text.links[-1 - at]
        else:  # do, endif
            self._at += 1

    def _leave_loops(self, lines: range) -> None:
        """Drops the counters of the loops that begin in these lines."""
        repeats = self._frames[-1].repeats
        for begin in [begin for begin in repeats if begin in lines]:
            del repeats[begin]

    def _branch(self, line: OWord) -> None:
        """Moves to the first branch whose condition is true, to else, or after endif."""
        text, at = self._text, self._at
        while not self._value(line):
            at = text.links[at]
            following = text.line(at)
            assert isinstance(following, OWord)
            if following.keyword != "ELSEIF":
                break
            line, self._at = following, at
        self._at = at + 1

    def _value(self, line: OWord) -> float:
        return evaluate(line.arguments[0], self._parameters)

    def _call(self, line: OWord) -> None:
        name = line.name if isinstance(line.name, str) else program_name(evaluate(line.name, self._parameters))
        arguments = [evaluate(one, self._parameters) for one in line.arguments]
        text = self._where(name)
        kept = self._parameters.enter(arguments)
        self._parameters.returned = None
        self._push(_Frame(text, (self._text, self._at + 1), kept))
        self._text, self._at = text, text.subs[name] + 1

    def _where(self, name: str) -> Text:
        """Returns the text that has a sub. It is searched in this text, the program, the files loaded so far, and the
        file of its name. Raises LineError if there is none."""
        for text in (self._text, self._frames[0].text, *self._loaded.values()):
            if name in text.subs:
                return text
        if name in self._text.programs:
            raise LineError(f"O{name} is a program, which M98 calls; expected O{name} sub")
        found = self._find(name.strip("<>").lower())
        if found is None or name not in found.subs:
            where = "the file" if found is None else f"the file and {found.source}"
            raise LineError(f"expected O{name.lower()} sub, found none in {where} (--subroutines names a folder)")
        self._loaded[name] = found
        return found
