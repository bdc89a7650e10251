"""The text of a program: its characters, lines, comments and words, and the links between its o-words."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from takt.gcode import words
from takt.gcode.errors import LineError
from takt.gcode.expressions import NUMBER, Reader, Value, Values, evaluate

_WITHOUT_EXPRESSIONS = ("grbl", "marlin")
MOST_BYTES = 500_000_000
_COMMENT = re.compile(r"\([^()]*\)|;.*", re.DOTALL)
_ENDS = re.compile(r"\r\n|\n|\r")  # of lines; U+2028 and vertical tabs are not among them
_BINARY = re.compile(r"[\x00-\x08\x0e-\x10\x15-\x19\x1b-\x1f]")
_PAPER_TAPE = dict.fromkeys((0x11, 0x12, 0x13, 0x14, 0x1A), " ")  # control characters of serial lines and old files
_WORD = re.compile(r"([A-Z@^$])([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[-+][0-9]+)?)")
_LETTER = re.compile(r"[A-Z@^$]")
_EXPONENT = re.compile(r"(?<=[0-9.])[Ee]([-+][0-9]+)(?![0-9.])")
_UNSIGNED_EXPONENT = re.compile(r"[XYZIJKRF][-+]?[0-9]*\.?[0-9]+E[0-9]+(?![0-9.])")
_MARLIN_TEXT = re.compile(
    r"\s*(?:N[0-9]+\s*)?(M(?:0|1|16|23|28|30|32|33|36|38|115|117|118|486|550|551|587|862\.[0-9]|928))(?![0-9])"
)
_MARLIN_MACRO = re.compile(r"\s*([A-Z_]{2,}[A-Z0-9_]*)(?:\s|$)")
_MARLIN_COMMAND = re.compile(r"\s*(?:N[0-9]+\s*)?([GM])([0-9]+(?:\.[0-9]+)?)(?![0-9.])")
_MARLIN_CODE = re.compile(r"[GM]\s*[0-9]")
_MARLIN_MODAL = re.compile(r"\s*(?:N[0-9]+\s*)?[XYZE]\s*[-+.0-9][^;(]*?M\s*([0-9]+)")
_MARLIN_WORD = re.compile(r"([A-Z])([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))?")
_GRBL_SYSTEM = re.compile(r"\s*(\$[A-Z]*)")
_SLASH = re.compile(r"^/[1-9]?")
_CHECKSUM = re.compile(r"\*[0-9]+\s*$")
_O_WORD = re.compile(r"(?:N[0-9.]+)?[O:](?=[0-9<#\[])")
_KEYWORD = re.compile(
    r"ENDWHILE|ENDREPEAT|ENDIF|ENDSUB|ELSEIF|ELSE|CONTINUE|BREAK|RETURN|REPEAT|WHILE|CALL|SUB|DO|IF|$"
)


def decode(data: bytes) -> str:
    """Returns the text of a file, UTF-8 with or without a byte order mark, else cp1252. Raises LineError if it is
    larger than MOST_BYTES or contains control characters of binary files."""
    if len(data) > MOST_BYTES:
        raise LineError(f"is larger than {MOST_BYTES:,} bytes")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("cp1252", errors="replace")
    control = _BINARY.search(text)
    if control:
        raise LineError(f"is no text (byte {ord(control[0]):#04x} at character {control.start()})")
    return text.translate(_PAPER_TAPE)


@dataclass
class Block:
    """A line of words and assignments to parameters."""

    codes: tuple[str, ...]
    numbers: Mapping[str, float]
    words: list[tuple[str, Value]] | None = None  # if the line has expressions or assignments
    settings: list[tuple[str | Value, Value]] = field(default_factory=list)

    def now(self, values: Values) -> tuple[tuple[str, ...], Mapping[str, float]]:
        """Returns codes and numbers with the present values of parameters."""
        if self.words is None:
            return self.codes, self.numbers
        return sorted_words([(letter, evaluate(value, values)) for letter, value in self.words])


@dataclass
class OWord:
    """A line that begins with O."""

    name: str | Value  # a value: of o[...] call
    keyword: str  # "": a number only, a program
    arguments: list[Value]


Line = Block | OWord


class Text:
    """The lines of a file, compiled when they are first executed."""

    def __init__(self, text: str, source: str, leave_out: frozenset[str], *, delete_blocks: bool) -> None:
        self.source = source
        self.lines = _ENDS.split(text)
        self.first = 0  # after an opening %
        self.slashes = [i for i, line in enumerate(self.lines) if line.lstrip().startswith("/")]
        if delete_blocks:
            for i in self.slashes:
                self.lines[i] = ""
        self._leave_out = leave_out
        self._compiled: list[Line | None] = []

    def begin(self, dialect: str) -> None:
        """Cuts the text at its % lines and links its o-words; requires the dialect. Raises LineError with the position
        of the line."""
        self._dialect = dialect
        self._cut()
        self._compiled = [None] * len(self.lines)
        self.subs: dict[str, int] = {}
        self.programs: dict[str, int] = {}
        self.links: dict[int, int] = {}  # from an o-word to its counterpart, see _close
        self._link()

    def place(self, line: int) -> str:
        return f"{self.source}:{line + 1}"

    def line(self, at: int) -> Line:
        found = self._compiled[at]
        if found is None:
            found = self._compile(self.lines[at])
            if self.links or self.programs:  # otherwise no line is executed twice
                self._compiled[at] = found
        return found

    def _cut(self) -> None:
        """Keeps the lines between the first % and the second one; if lines precede the first %, those before it."""
        marks = [i for i, line in enumerate(self.lines) if line.lstrip().startswith("%")]
        if not marks:
            return
        before = [i for i in range(marks[0]) if _bare(self.lines[i])]
        if not before:
            self.first = marks[0] + 1
            if len(marks) > 1:
                del self.lines[marks[1] :]
            return
        behind = [i for i in range(marks[0] + 1, len(self.lines)) if _bare(self.lines[i]) and i not in marks]
        if behind:
            raise LineError(
                f"the program ends here with '%', but line {behind[0] + 1} goes on; expected '%' in line 1, too",
                self.place(marks[0]),
            )
        del self.lines[marks[0] :]

    def _compile(self, line: str) -> Line:
        dialect = self._dialect
        upper = line.upper()
        if dialect == "grbl" and (system := _GRBL_SYSTEM.match(upper)):
            return Block((system[1],), {})
        if dialect == "marlin":
            special = self._marlin(upper)
            if special is not None:
                return special
            upper = _CHECKSUM.sub("", _COMMENT.sub("", upper))
            if "E" in upper and _EXPONENT.search(_COMMENT.sub("", line).replace("E", " ")):
                raise LineError("a number with e: Marlin takes e for a word, its writer for an exponent")
        if "(" in upper or ";" in upper:
            if "(ABORT," in upper:
                raise LineError(f"the program ends itself: {line.strip()}")
            if upper.lstrip().startswith(";PY,"):
                raise LineError("Python in a comment is not run (--leave-out does not hold for it)")
            upper = _COMMENT.sub("", upper)
        if "E" in upper and dialect != "marlin":
            upper = self._exponents(upper)
        code = "".join(upper.split()) if upper.isascii() else _ascii(upper)
        if code.startswith("/"):
            code = _SLASH.sub("", code)
        is_o_word = _O_WORD.match(code) is not None
        if dialect in _WITHOUT_EXPRESSIONS and (is_o_word or "#" in code or "[" in code):
            raise LineError(f"the dialect {dialect} has no o-words, parameters, expressions (--dialect linuxcnc has)")
        if is_o_word:
            return _o_word(code)
        found = _WORD.findall(code)
        if len(code) > 300 and any(math.isinf(float(number)) for _, number in found):
            raise LineError("a number has too many digits")
        if len("".join(map("".join, found))) == len(code):  # words with numbers and nothing else
            codes, numbers = sorted_words([(letter, float(number)) for letter, number in found])
            return Block(codes, numbers)
        if dialect == "marlin" and (flagged := _with_flags(upper, code)):
            return flagged
        return _with_expressions(code, self._leave_out)

    def _exponents(self, upper: str) -> str:
        """Returns the line with exponents as in 2.5E-3 marked by a small e, which only the dialect rs274 has. Raises
        LineError for an exponent in another dialect, and for one without a sign, which may be the word E."""
        outside = re.sub(r"\[.*\]", "", upper)
        signed = _EXPONENT.search(outside)
        if self._dialect != "rs274":
            if signed and _LETTER.match(outside.lstrip()):
                raise LineError(f"a number with E{signed[1]}: the dialect {self._dialect} has no exponents")
            return upper
        unsigned = _UNSIGNED_EXPONENT.search(outside)
        if unsigned:
            raise LineError(f"'{unsigned[0]}': an exponent, or the word E? Put a blank or a sign before its number")
        return _EXPONENT.sub(r"e\1", upper) if signed else upper

    def _marlin(self, upper: str) -> Line | None:
        """Returns the line if it is a code followed by text, a code that is left out and alone in its line, or a macro;
        else None."""
        modal = _MARLIN_MODAL.match(upper)
        if modal:
            raise LineError(f"M{modal[1]} beside a motion: Marlin takes one command a line")
        text = _MARLIN_TEXT.match(upper)
        if text and text[1] != "M30":
            return Block((text[1],), {})
        macro = _MARLIN_MACRO.match(upper)
        if macro:
            name = macro[1]
            if name not in self._leave_out:
                raise LineError(words.refused(name))
            return Block((name,), {})
        command = _MARLIN_COMMAND.match(upper) if self._leave_out else None
        code = words.code_name(command[1], float(command[2])) if command else ""
        if command is None or code not in self._leave_out or code in words.GROUP_OF:
            return None
        others = _MARLIN_CODE.search(_COMMENT.sub("", upper[command.end() :]))
        return None if others else Block((code,), {})

    # --- Links between lines ---

    def _link(self) -> None:
        """Links o-words that belong together. Raises LineError if one has no counterpart."""
        opened: list[tuple[str, str, int, list[int]]] = []  # keyword, name, line, its branches or breaks
        for at in range(self.first, len(self.lines)):
            raw = self.lines[at]
            if "o" not in raw and "O" not in raw and ":" not in raw:
                continue
            code = _SLASH.sub("", "".join(_COMMENT.sub("", raw).upper().split()))
            if not _O_WORD.match(code) or self._dialect in _WITHOUT_EXPRESSIONS:
                continue
            try:
                self._pair(self.line(at), at, opened)
            except LineError as error:
                raise LineError(str(error), error.place or self.place(at)) from None
        if opened:
            keyword, name, at, _ = opened[-1]
            raise LineError(f"O{name} {keyword.lower()} has no end", self.place(at))

    def _pair(self, line: Line, at: int, opened: list[tuple[str, str, int, list[int]]]) -> None:
        if not isinstance(line, OWord):
            return
        keyword = line.keyword
        if keyword == "CALL":
            return
        if not isinstance(line.name, str):
            raise LineError(f"o-words with an expression for a name are calls only, not '{keyword.lower()}'")
        name = line.name
        top = opened[-1] if opened else ("", "", 0, [])
        same = top[1] == name
        if keyword == "":
            if opened:
                raise LineError(f"O{name} stands within O{top[1]} {top[0].lower()}; expected a word like sub behind it")
            self.programs.setdefault(name, at)
        elif keyword == "SUB":
            if opened:
                raise LineError(f"O{name} sub stands within O{top[1]} {top[0].lower()}")
            if name in self.subs:
                raise LineError(f"O{name} sub is there already, in line {self.subs[name] + 1}")
            self.subs[name] = at
            opened.append((keyword, name, at, []))
        elif keyword == "WHILE" and same and top[0] == "DO":
            self._close(at, opened)
        elif keyword in ("IF", "DO", "WHILE", "REPEAT"):
            opened.append((keyword, name, at, [at] if keyword == "IF" else []))
        elif keyword in ("ELSEIF", "ELSE"):
            if not same or top[0] != "IF":
                raise LineError(f"O{name} {keyword.lower()} has no if before it")
            top[3].append(at)
        elif keyword in ("ENDIF", "ENDWHILE", "ENDREPEAT", "ENDSUB"):
            if not same or top[0] != keyword[3:]:
                within = f", but stands within O{top[1]} {top[0].lower()}" if opened else ""
                raise LineError(f"O{name} {keyword.lower()} has no {keyword[3:].lower()} before it{within}")
            self._close(at, opened)
        elif keyword in ("BREAK", "CONTINUE"):
            loops = [one for one in opened if one[1] == name and one[0] in ("DO", "WHILE", "REPEAT")]
            if not loops:
                raise LineError(f"O{name} {keyword.lower()} stands in no loop of that number")
            loops[-1][3].append(at)
        elif not any(one[0] == "SUB" for one in opened):
            raise LineError(f"O{name} {keyword.lower()} stands in no sub")

    def _close(self, end: int, opened: list[tuple[str, str, int, list[int]]]) -> None:
        keyword, _, begin, inside = opened.pop()
        if keyword == "IF":
            for this, following in zip(inside, [*inside[1:], end], strict=True):
                self.links[this] = following  # next line if the condition is false
                self.links[-1 - this] = end  # next line after a branch that was taken
            return
        self.links[begin], self.links[end] = end, begin
        for at in inside:
            self.links[at], self.links[-1 - at] = end, begin


def sorted_words(found: list[tuple[str, float]]) -> tuple[tuple[str, ...], dict[str, float]]:
    """Returns codes, and numbers by their letters. Raises LineError if two codes exclude each other or a letter is
    given twice."""
    codes: list[str] = []
    numbers: dict[str, float] = {}
    for letter, number in found:
        if letter in "GM":
            code = f"{letter}{number:g}"
            if code not in codes:
                codes.append(code)
        elif letter in numbers:
            raise LineError(f"{letter} is given twice")
        else:
            numbers[letter] = number
    if len(codes) > 1:
        groups: dict[str, str] = {}
        for code in codes:
            group = words.GROUP_OF.get(code)
            if group and groups.setdefault(group, code) != code:
                raise LineError(f"{groups[group]} and {code} exclude each other in one line")
    return tuple(codes), numbers


def _bare(line: str) -> bool:
    """Returns whether a line has anything besides comments."""
    return bool(_COMMENT.sub("", line).strip(" \t\r\v\f\x1a\x11\x13"))


def _ascii(line: str) -> str:
    code = "".join(line.split(" ")).replace("\t", "")
    wrong = re.search(r"[^\x00-\x7f]", code)
    if wrong:
        raise LineError(f"expected a letter and a number, found '{code[wrong.start() : wrong.start() + 12]}'")
    return "".join(code.split())


def _o_word(code: str) -> OWord:
    reader = Reader(code, _O_WORD.match(code).end())  # type: ignore[union-attr]
    name: str | Value
    plain = re.compile(r"<([^<>]*)>|[0-9]+(?:\.[0-9]+)?").match(code, reader.at)
    if plain:
        reader.at = plain.end()
        name = f"<{plain[1]}>" if plain[1] is not None else words.program_name(float(plain[0]))
    else:
        name = reader.value()
    keyword = _KEYWORD.match(code, reader.at)
    if not keyword:
        raise reader.unexpected("sub, call, if, while, do, repeat or another word behind O")
    reader.at = keyword.end()
    arguments = []
    while reader.at < len(code):
        arguments.append(reader.bracket() if code[reader.at] == "[" else reader.value())
    wanted = {"IF": 1, "ELSEIF": 1, "WHILE": 1, "REPEAT": 1, "CALL": 30}
    optional = keyword[0] in ("CALL", "RETURN", "ENDSUB")
    most = wanted.get(keyword[0], 1 if optional else 0)
    if len(arguments) > most or (not optional and len(arguments) < most):
        raise LineError(f"{keyword[0].lower()}: expected {most} values in brackets, found {len(arguments)}")
    return OWord(name, keyword[0], arguments)


def _with_flags(line: str, code: str) -> Block | None:
    """Returns a line of Marlin in which letters have no number, if it is an M code, whose words do not affect the path,
    or a G code with such flags; else None."""
    command = _MARLIN_COMMAND.match(line)
    if not command:
        return None
    name = words.code_name(command[1], float(command[2]))
    if name[0] == "M":
        alone = name not in words.ENDS and not re.search(r"\bG[0-9]", line[command.end() :])
        return Block((name,), {}) if alone else None
    found = _MARLIN_WORD.findall(code)
    if name in words.WITHOUT_FLAGS or len("".join(map("".join, found))) != len(code):
        return None
    codes, numbers = sorted_words([(letter, float(number or 0)) for letter, number in found])
    return Block(codes, numbers)


def _with_expressions(code: str, leave_out: frozenset[str]) -> Block:
    reader = Reader(code)
    found: list[tuple[str, Value]] = []
    settings: list[tuple[str | Value, Value]] = []
    while reader.at < len(code):
        if code[reader.at] == "#":
            target = reader.parameter_name()
            if code[reader.at : reader.at + 1] != "=":
                raise reader.unexpected("=")
            reader.at += 1
            settings.append((target, reader.value()))
            continue
        letter = code[reader.at]
        if not _LETTER.match(letter) or not re.match(r"[-+.0-9#\[A-Z]", code[reader.at + 1 : reader.at + 2]):
            raise reader.unexpected("a letter and a number")
        begin = reader.at
        reader.at += 1
        if not NUMBER.match(code, reader.at) and not re.match(r"[-+]*(?:[.0-9#\[]|[A-Z]{2,6}\[)", code[reader.at :]):
            reader.at = begin
            raise reader.unexpected("a letter and a number")
        value = reader.value()
        found.append((letter, 0.0 if letter in leave_out else value))  # a word left out is not evaluated
    return Block((), {}, found, settings)
