"""Cams from files of other systems, recognised by their content (CAM-92).

- a table of numbers, with any separator, decimal point or comma, with or without a header: from spreadsheets, and from
  CODESYS' "Write Cam Data to ASCII Table";
- (dX := 0, dY := 0, dV := 0, dA := 0), ...: an ARRAY OF SMC_CAMXYVA of CODESYS;
- (MasterPos := 0, SlavePos := 0, FunctionType := ..., ...), ..., or columns of these names: an ARRAY OF
  MC_MotionFunctionPoint of TwinCAT;
- ARRAY[0..3, 0..1] OF LREAL := [0, 0, 90, 10, ...]: a table of positions of TwinCAT;
- Tabletype = 3, Lines = 36, ...: a cam table of TwinCAT CNC, over 360 deg.
"""

from __future__ import annotations

import csv
import itertools
import math
import os
import re
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from takt.cam import Interpolation, Table
from takt.csv_rows import DECIMAL_COMMA, surplus
from takt.errors import ConfigError
from takt.names import shown

ERRORS = 20  # reported for one file at most
TURN = 360.0  # deg, the master's range of TwinCAT CNC tables

Row = dict[str, Any]
ALIASES = {
    "x": {"x", "dx", "master", "masterpos", "masterposition"},
    "y": {"y", "dy", "slave", "slavepos", "slaveposition"},
    "v": {"v", "dv", "velocity", "slavevelo", "slavevelocity", "y'"},
    "a": {"a", "da", "acceleration", "slaveacc", "slaveacceleration", "y''"},
    "law": {"functiontype", "segmenttype"},
    "type": {"pointtype"},
    "ignored": {"ignored"},
}
TEXTS = ("law", "type", "ignored")  # fields that are not numbers
# Points that TwinCAT ignores: of the type MOTIONPOINTTYPE_IGNORE, 0, and those of MC3 with Ignored := TRUE.
IGNORED = {"type": {"ignore", "0"}, "ignored": {"true", "1"}}
# Functions of TwinCAT and CODESYS between two points, by name or number.
LAWS = {
    **dict.fromkeys(("polynom1", "1", "line"), "line"),
    **dict.fromkeys(("polynom5", "5", "poly5", "polynom5mm", "15"), "quintic"),
    **dict.fromkeys(("sinuslinie", "10", "inclinedsine"), "cycloid"),
    **dict.fromkeys(("modsinuslinie", "11", "modifiedsine"), "modified_sine"),
    **dict.fromkeys(("beschltrapez", "13"), "modified_trapezoid"),
}
_STRUCT = re.compile(r"\(([^()]*:=[^()]*)\)")
_POSITION = re.compile(r"[(,]\s*(dX|dY|MasterPos|SlavePos)\s*:=", re.IGNORECASE)
_ARRAY = re.compile(r"ARRAY\s*\[([^\],]*),\s*0\s*\.\.\s*1\s*\]\s*OF\s*L?REAL\s*:=\s*\[([^\]]*)\]", re.IGNORECASE)
_STRUCTS = re.compile(r"ARRAY\s*\[([^\],]*)\]\s*OF\s*\w+\s*:=([^;]*)", re.IGNORECASE)
_BOUNDS = re.compile(r"\s*([-+]?\d{1,9})\s*\.\.\s*([-+]?\d{1,9})\s*")
# The beginning of skipped parts of structured text: comments in (* *), which nest, and /* */, pragmas, string literals.
_SKIPPED = re.compile(r"\(\*|/\*|//[^\r\n]*|\{[^{}]*\}|'(?:\$.|[^'$\r\n])*'?", re.DOTALL)
_COMMENTS = {"(*": "*)", "/*": "*/"}
_NESTED = re.compile(r"\(\*|\*\)")
_QUOTED = re.compile(r'(?:^|(?<=[\t;|,]))\s*"[^"]*"(?=\s*(?:[\t;|,]|$))')  # whole fields: ["] is a unit
_CNC = re.compile(r"^\s*tabletype\s*=", re.IGNORECASE | re.MULTILINE)
_FINDING = re.compile(r"(?:points|segments)\[(\d+)\][.\w]*: (.*)")
_THOUSANDS = re.compile(r"[-+]?[1-9][0-9]{0,2}(,[0-9]{3})+")
_NUMBERS = re.compile(r"[-+0-9.,eE]+(\s+[-+0-9.,eE]+)+")


def read(
    file: str | os.PathLike[str],
    *,
    columns: Mapping[str, str | int] | None,
    name: str | None,
    interpolation: Interpolation | None,
    cyclic: bool,
    x_unit: str | None,
    y_unit: str | None,
) -> Table:
    """As Table.from_file."""
    path = Path(file)
    text = _decoded(path.read_bytes())
    code = _code(text)
    content = _Content(shown(path))
    if _CNC.search(text):
        cyclic, law = content.read_cnc(text)
        interpolation = interpolation or law
    elif any(kind.search(code) for kind in (_STRUCT, _POSITION, _ARRAY)):
        content.read_code(code)
    else:
        content.read_columns(text, columns)
    content.tell()
    units = {"x_unit": x_unit or content.units.get("x", "u"), "y_unit": y_unit or content.units.get("y", "u")}
    head = {"name": name or shown(path.stem), "cyclic": cyclic, **units}
    if any("law" in row for row in content.rows):
        cam = {**head, "segments": content.segments()}
    else:
        points = [{key: row.get(key) for key in "xyva"} for row in content.rows]
        cam = {**head, "interpolation": interpolation or "quintic", "points": points}
    try:
        return Table.from_dict(cam)
    except ConfigError as error:
        raise ConfigError([content.placed(problem) for problem in error.problems]) from None


def _decoded(data: bytes) -> str:
    encodings = ("utf-16",) if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252")
    for encoding in encodings:
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    return data.decode("latin-1")


class _Content:
    """The content of a file: rows with x, y and optionally v, a, law; and its errors."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.rows: list[Row] = []
        self.units: dict[str, str] = {}
        self._wrong: list[str] = []

    def tell(self) -> None:
        if not self._wrong and len(self.rows) < 2:
            self._add(None, f"expected 2 to 100,000 points, found {len(self.rows)}")
        if self._wrong:
            raise ConfigError(self._wrong)

    def placed(self, problem: str) -> str:
        """Returns a problem of the cam with its line in the file."""
        match = _FINDING.search(problem)
        if not match:
            return f"{self.file}: {problem}"
        return f"{self.file}:{self.rows[int(match[1])]['line']}:1: {match[2]}"

    def _add(self, line: int | None, message: str) -> None:
        if len(self._wrong) < ERRORS:
            self._wrong.append(f"{self.file}:{line}: {message}" if line else f"{self.file}: {message}")

    def _number(self, text: str, what: str, line: int, decimal_comma: bool) -> float | None:
        plain = text.replace(",", ".") if decimal_comma and "." not in text else text
        try:
            value = float(plain)
        except ValueError:
            value = math.nan
        if math.isfinite(value) and "_" not in text:
            return value
        self._add(line, f"expected a finite number for {what}, found {text!r}")
        return None

    # --- tables of numbers ---

    def read_columns(self, text: str, columns: Mapping[str, str | int] | None) -> None:
        lines = [(i, line.split("//")[0].rstrip()) for i, line in enumerate(text.splitlines(), 1)]
        lines = [(i, line) for i, line in lines if line and not line.lstrip().startswith("#")]
        if not lines:
            return self._add(None, "expected a table of numbers, found an empty file")
        separator = _separator(lines[0][1].strip())
        if separator != "\t" or lines[0][1][0].isspace():  # otherwise the first field of a line may be empty
            lines = [(i, line.strip()) for i, line in lines]
        try:
            cells = [(i, _split(line, separator)) for i, line in lines]
        except csv.Error as error:  # a field of megabytes
            return self._add(None, f"expected a table of numbers: {error}")
        header = None if all(_is_number(cell) for cell in cells[0][1]) else cells.pop(0)[1]
        has_units = header and cells and not any(cell and _is_number(cell) for cell in cells[0][1])
        units = cells.pop(0)[1] if has_units else []
        places = self._places(header, cells, columns)
        if places is None:
            return None
        self.units = {key: units[k].strip("[]() ") for key, k in places.items() if k < len(units) and units[k]}
        width = len(header) if header else max(len(row) for _, row in cells)
        decimal_comma = separator != "," or any(
            DECIMAL_COMMA.fullmatch(row[k]) and not _THOUSANDS.fullmatch(row[k])
            for _, row in cells
            for k in places.values()
            if k < len(row)
        )
        texts = [{key: row[k] if k < len(row) else "" for key, k in places.items()} for _, row in cells]
        ignored = _ignored(texts)
        for k, (line, row) in enumerate(cells):
            if sentence := surplus(row, width):
                self._add(line, sentence)
            elif not ignored[k]:
                self._take(line, texts[k], decimal_comma)
        return None

    def _places(
        self, header: list[str] | None, cells: Sequence[tuple[int, list[str]]], columns: Mapping[str, str | int] | None
    ) -> dict[str, int] | None:
        """Returns the column of each field, from 0; None after an error."""
        width = len(header) if header else max(len(row) for _, row in cells)
        if columns is not None:
            return self._chosen(header, width, columns)
        if header is None:
            if width in (2, 3, 4):
                return dict(zip("xyva", range(width), strict=False))
            self._add(None, f"expected the columns x, y and perhaps v, a, found {width}: say which with columns")
            return None
        found = _titled(header)
        if not {"x", "y"} <= found.keys():
            titles = ", ".join(f"'{title}'" for title in header)
            self._add(None, f"expected columns for x and y, found {titles}: say which with columns")
            return None
        return found

    def _chosen(self, header: list[str] | None, width: int, columns: Mapping[str, str | int]) -> dict[str, int] | None:
        titles = [title.lower() for title in header or []]
        found = {key: k for key, k in _titled(header or []).items() if key in IGNORED}
        for key, column in columns.items():
            if key not in ("x", "y", "v", "a"):
                self._add(None, f"columns: expected x, y, v or a, found {key!r}")
            elif isinstance(column, int) and 1 <= column <= width:
                found[key] = column - 1
            elif isinstance(column, str) and column.lower() in titles:
                found[key] = titles.index(column.lower())
            else:
                has = f"one of {', '.join(header)}, or " if header else ""
                self._add(None, f"columns: expected for {key} {has}a number from 1 to {width}, found {column!r}")
        if not {"x", "y"} <= columns.keys():
            self._add(None, "columns: expected x and y at least")
        return None if self._wrong else found

    def _take(self, line: int, texts: Mapping[str, str], decimal_comma: bool) -> None:
        row: Row = {"line": line}
        for key, text in texts.items():
            if key in TEXTS:
                row[key] = text
            elif text or key in "xy":
                row[key] = self._number(text, key, line, decimal_comma)
        self.rows.append(row)

    # --- structured text ---

    def read_code(self, code: str) -> None:
        for begin in _COMMENTS:
            if begin in code:
                self._add(_line(code, code.index(begin)), f"the comment has no end: expected {_COMMENTS[begin]}")
        if _STRUCT.search(code) or _POSITION.search(code):
            self.read_structs(code)
        else:
            self.read_array(code)

    def read_structs(self, code: str) -> None:
        structs = list[tuple[int, int, dict[str, str], dict[str, str]]]()  # offset, line, names and texts of the fields
        line, at = 1, 0
        for match in _STRUCT.finditer(code):
            line, at = line + code.count("\n", at, match.start()), match.start()
            pairs = dict(part.split(":=", 1) for part in match[1].split(",") if ":=" in part)
            fields = {re.sub(r"[^a-z']", "", key.lower()): value.strip() for key, value in pairs.items()}
            known = {key: field for key, names in ALIASES.items() for field in names if field in fields}
            structs.append((at, line, known, {key: fields[field] for key, field in known.items()}))
        begins = list[int]()  # offsets of points
        ignored = _ignored([texts for *_, texts in structs])
        for k, (at, line, known, texts) in enumerate(structs):
            if ignored[k]:
                begins.append(at)
            elif {"x", "y"} <= known.keys():
                begins.append(at)
                row: Row = {"line": line}
                for key, text in texts.items():
                    row[key] = text if key in TEXTS else self._number(text, known[key], line, False)
                self.rows.append(row)
        points = "(dX := ..., dY := ...) or (MasterPos := ..., SlavePos := ...)"
        read = set(begins)
        rest = _STRUCT.sub(lambda match: _blank(match[0]) if match.start() in read else match[0], code)
        odd = {match.start(1) for match in itertools.islice(_POSITION.finditer(rest), ERRORS)}
        for array in _STRUCTS.finditer(code):
            count = bisect_left(begins, array.end(2)) - bisect_left(begins, array.start(2))
            if count:
                self._check_count(array[1], count, _line(code, array.start()))
                lacking = itertools.islice(_STRUCT.finditer(rest, *array.span(2)), ERRORS)
                odd |= {match.start(1) for match in lacking if not _POSITION.search(match[0])}
        for at in sorted(odd):
            found = " ".join(rest[at : at + 40].split())
            self._add(_line(rest, at), f"expected {points}, found '{found}'")
        if not self.rows:
            self._add(None, f"expected {points}, found neither")

    def read_array(self, code: str) -> None:
        match, *more = _ARRAY.finditer(code)
        line = _line(code, match.start())
        if more:
            self._add(
                _line(code, more[0].start()), f"expected one table of positions, found another one in line {line}"
            )
        values = [self._number(part.strip(), "a position", line, False) for part in match[2].split(",")]
        if len(values) % 2:
            return self._add(line, f"expected pairs of master and slave positions, found {len(values)} numbers")
        self.rows = [{"line": line, "x": x, "y": y} for x, y in zip(values[::2], values[1::2], strict=True)]
        self._check_count(match[1], len(self.rows), line)
        return None

    def _check_count(self, bounds: str, count: int, line: int) -> None:
        """Checks the number of points of an array against its bounds, unless these are names of constants."""
        declared = _BOUNDS.fullmatch(bounds)
        if declared and (expected := int(declared[2]) - int(declared[1]) + 1) != count:
            self._add(line, f"ARRAY[{bounds.strip()}]: expected {expected} points, found {count}")

    # --- TwinCAT CNC ---

    def read_cnc(self, text: str) -> tuple[bool, Interpolation]:
        """Reads a table of TwinCAT CNC. Returns whether it is cyclic, and its interpolation."""
        head: dict[str, str] = {}
        values: list[tuple[int, list[float]]] = []
        for i, line in enumerate(text.splitlines(), 1):
            content = line.split("#")[0].strip()
            if "=" in content:
                key, _, value = content.partition("=")
                head[key.strip().lower()] = value.strip()
            elif content:
                numbers = [self._number(cell, "a position", i, True) for cell in re.split(r"[\s;]+", content)]
                values.append((i, [number for number in numbers if number is not None]))
        if head.get("lines") not in (None, str(len(values))):
            self._add(None, f"Lines: expected {head['lines']} lines of values, found {len(values)}")
        count = len(values[0][1]) if values else 0
        for i, positions in values:
            if len(positions) != count:
                self._add(i, f"expected as many positions as in the first line, {count}, found {len(positions)}")
        function = head.get("functiontype", "1")
        if function not in ("1", "4", "5"):
            self._add(None, f"Functiontype: expected 1 (linear), 4 (line, poly5) or 5 (poly5, line), found {function}")
        if self._wrong or not values:
            return True, "linear"
        if len(values[0][1]) == 1:  # equidistant slave positions; the turn closes with the first one
            step = TURN / len(values)
            self.rows = [{"line": i, "x": k * step, "y": row[0]} for k, (i, row) in enumerate(values)]
        else:
            self.rows = [{"line": i, "x": row[0], "y": row[1]} for i, row in values]
        first = self.rows[0]
        self.rows.append({**first, "x": first["x"] + TURN})
        if function != "1":
            # The first name is that of the segment that ends at the first point.
            names = ("quintic", "line") if function == "4" else ("line", "quintic")
            for k, row in enumerate(self.rows[:-1]):
                row["law"] = names[k % 2]
        return True, "linear"

    # --- laws of motion between points ---

    def segments(self) -> list[dict[str, Any]]:
        """Returns the segments of rows with laws; a law holds from its point to the next one."""
        segments = []
        for row, following in zip(self.rows, self.rows[1:], strict=False):
            law = self._law(row)
            segment: dict[str, Any] = {"to": {"x": following["x"], "y": following["y"]}, "law": law}
            if law == "quintic":
                ends = {"begin_v": row, "end_v": following}, {"begin_a": row, "end_a": following}
                for key, of in zip("va", ends, strict=True):
                    segment |= {end: at[key] for end, at in of.items() if at.get(key) is not None}
            segments.append(segment)
        self.tell()
        segments[0]["from"] = {"x": self.rows[0]["x"], "y": self.rows[0]["y"]}
        return segments

    def _law(self, row: Row) -> str:
        given = str(row.get("law") or "5")
        if given in LAWS.values():
            return given
        plain = re.sub(r"[^a-z0-9]", "", given.lower().rpartition("type_")[2])
        law = LAWS.get(plain)
        if law is None:
            self._add(row["line"], f"expected one of the functions {', '.join(LAWS)}, found {given!r}")
        return law or "quintic"


def _titled(header: Sequence[str]) -> dict[str, int]:
    """Returns the first column, from 0, of each field named by a title."""
    found: dict[str, int] = {}
    for k, title in enumerate(header):
        plain = re.sub(r"[\[(].*|[^a-z']", "", title.lower())
        for key, names in ALIASES.items():
            if plain in names:
                found.setdefault(key, k)
    return found


def _ignored(points: Sequence[Mapping[str, str]]) -> list[bool]:
    """Returns, for each point, whether it is ignored. If all types are 0, the file has no types."""
    typed = any(point.get("type", "0") != "0" for point in points)
    keys = [key for key in IGNORED if typed or key != "type"]
    return [any(point.get(key, "").lower().rpartition("type_")[2] in IGNORED[key] for key in keys) for point in points]


def _code(text: str) -> str:
    """Returns the text with comments, pragmas and string literals replaced by blanks, up to an unterminated comment;
    line numbers do not change."""
    kept, at, nested = list[str](), 0, True
    while match := _SKIPPED.search(text, at):
        end = match.end()
        if match[0] in _COMMENTS:
            closed = _end_of_nested(text, match.end()) if nested and match[0] == "(*" else None
            nested = nested and (match[0] != "(*" or closed is not None)  # if not closed, comments do not nest here
            end = closed or text.find(_COMMENTS[match[0]], match.end()) + 2
            if end < match.end():
                break
        kept += [text[at : match.start()], _blank(text[match.start() : end])]
        at = end
    return "".join([*kept, text[at:]])


def _end_of_nested(text: str, at: int) -> int | None:
    """Returns the end of the comment around `at`, if comments nest; None if it does not end."""
    depth = 1
    for mark in _NESTED.finditer(text, at):
        depth += 1 if mark[0] == "(*" else -1
        if depth == 0:
            return mark.end()
    return None


def _blank(text: str) -> str:
    return re.sub(r"[^\r\n]", " ", text)


def _line(text: str, at: int) -> int:
    return text.count("\n", 0, at) + 1


def _separator(line: str) -> str:
    """Returns the column separator; " ": any number of blanks."""
    line = _QUOTED.sub('""', line)
    for candidate in ("\t", ";", "|"):
        if candidate in line:
            return candidate
    if _NUMBERS.fullmatch(line):
        return " "
    return "," if "," in line else " "


def _split(line: str, separator: str) -> list[str]:
    line = " ".join(line.split()) if separator == " " else line
    return [cell.strip() for row in csv.reader([line], delimiter=separator, skipinitialspace=True) for cell in row]


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return not text
    return True
