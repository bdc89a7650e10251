"""Reads G-code (RS274/NGC, ISO 6983, Marlin's) as the path of a tool.

    path = read_gcode("part.ngc")
    path = read_gcode("part.nc", dialect="fanuc", leave_out=["G41", "A"])

Lines, arcs, helices, splines (G5, G5.1, NURBS) and drilling cycles become the path of the tool tip, in the coordinate
system (G54 to G59.3) in which the first move is made. Expressions, parameters, o-words, M98 and M99 are executed. Codes
that do not affect the path (spindles, coolant, dwells, tools, extruders) are left out and listed; all others are errors
with their line, since a path that differs from the file is worse than none. docs/drawings.md has the tables.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path

from takt.gcode import dialects
from takt.gcode.errors import LineError
from takt.gcode.geometry import PathBuilder
from takt.gcode.machine import Machine
from takt.gcode.offsets import SYSTEMS, Offsets
from takt.gcode.parameters import Parameters
from takt.gcode.runner import Runner
from takt.gcode.source import MOST_BYTES, Text, decode
from takt.toolpath import TOLERANCE, Point, Toolpath, ToolpathError

DIALECTS = dialects.NAMES
_NAME = re.compile(r"[A-Z]|[GM][0-9]+(?:\.[0-9]+)?|[A-Z_][A-Z0-9_]+|\$[A-Z]+")
_FILE_NAME = re.compile(r"[a-z0-9_-]+")


@dataclasses.dataclass(frozen=True)
class Options:
    """How to read a program.

    dialect: one of DIALECTS; None: recognised from the lines of the program.
    leave_out: codes, letters and macros that are left out, with the words that belong to them: "M7", "G41", "A".
    delete_blocks: lines that begin with / are skipped; False: they are executed.
    offsets: zeros of coordinate systems in machine coordinates [mm], by name ("G54").
    parameters: values by number or name ("5410", "_depth").
    subroutines: a folder with files of subs, or several, searched after the program's own folder.
    """

    dialect: str | None = None
    leave_out: Iterable[str] = ()
    delete_blocks: bool = False
    offsets: Mapping[str, Point] = dataclasses.field(default_factory=dict)
    parameters: Mapping[str, float] = dataclasses.field(default_factory=dict)
    subroutines: str | PathLike[str] | Iterable[str | PathLike[str]] = ()

    def checked(self) -> Options:
        """Returns the options with names as in programs. Raises ToolpathError if an option is invalid."""
        if self.dialect is not None and self.dialect not in DIALECTS:
            raise ToolpathError(f"dialect: expected {', '.join(DIALECTS)}, found '{self.dialect}'")
        names = []
        for given in [self.leave_out] if isinstance(self.leave_out, str) else self.leave_out:
            for name in str(given).upper().replace(",", " ").split():
                if not _NAME.fullmatch(name):
                    raise ToolpathError(f"leave_out: expected a word like M7, G41 or A, found '{name}'")
                code = len(name) > 1 and name[0] in "GM" and name[1].isdigit()
                names.append(f"{name[0]}{float(name[1:]):g}" if code else name)
        offsets = {name.upper(): point for name, point in self.offsets.items()}
        for name, point in offsets.items():
            if name not in SYSTEMS or len(point) != 3 or not all(map(math.isfinite, point)):
                raise ToolpathError(
                    f"offsets: expected one of {', '.join(SYSTEMS)} and three numbers, found {name} {point}"
                )
        parameters = {name.strip("#<>"): float(value) for name, value in self.parameters.items()}
        for name, value in parameters.items():
            if not math.isfinite(value):
                raise ToolpathError(f"parameters: {name}: expected a number, found {value}")
        return dataclasses.replace(self, leave_out=tuple(names), offsets=offsets, parameters=parameters)

    @property
    def folders(self) -> list[Path]:
        """The folders of `subroutines` as a list."""
        given = self.subroutines
        return [Path(one) for one in ([given] if isinstance(given, str | PathLike) else given)]


def read_gcode(
    path: str | PathLike[str],
    start: Point = (0.0, 0.0, 0.0),
    tolerance: float = TOLERANCE,
    options: Options | None = None,
) -> Toolpath:
    """Returns the path of a file.

    start: position of the tool when the program begins [mm].
    tolerance: of the chords that replace helices and splines [mm].
    options: None: the defaults of Options.

    Raises ToolpathError, with file and line, if the file cannot be read or a line cannot be part of a path.
    """
    given = options or Options()
    try:
        with Path(path).open("rb") as file:
            text = decode(file.read(MOST_BYTES + 1))
    except LineError as error:
        raise ToolpathError(f"{path}: {error}") from None
    given = dataclasses.replace(given, subroutines=[Path(path).parent, *given.folders])
    return parse_gcode(text, start, tolerance, given, source=str(path))


def parse_gcode(
    text: str,
    start: Point = (0.0, 0.0, 0.0),
    tolerance: float = TOLERANCE,
    options: Options | None = None,
    *,
    source: str = "G-code",
) -> Toolpath:
    """Returns the path of a program given as text. `source`: its name in errors; all else is as in `read_gcode`."""
    given = (options or Options()).checked()
    leave_out = frozenset(given.leave_out)
    main = Text(text.removeprefix("\ufeff"), source, leave_out, delete_blocks=given.delete_blocks)
    try:
        dialect = dialects.Dialect(given.dialect) if given.dialect else dialects.of_text(main.lines)
        main.begin(dialect.name)
    except LineError as error:
        raise ToolpathError(f"{error.place or source}: {error}") from None
    builder = PathBuilder(start, tolerance)
    machine = Machine(builder, Offsets(given.offsets), dialect.name, leave_out, lambda: runner.place())
    folders = given.folders

    def find(name: str) -> Text | None:
        if not _FILE_NAME.fullmatch(name):
            return None
        for file in (folder / f"{name}.ngc" for folder in folders):
            if file.is_file():
                found = Text(decode(file.read_bytes()), str(file), leave_out, delete_blocks=given.delete_blocks)
                found.begin(dialect.name)
                return found
        return None

    runner = Runner(main, machine, Parameters(machine, given.parameters), dialect.name, find)
    try:
        runner.run()
    except LineError as error:
        raise ToolpathError(f"{error.place}: {error}") from None
    left_out = [f"{word} ({count} time{'s' * (count > 1)})" for word, count in machine.left_out.items()]
    if main.slashes:
        lines = f"{len(main.slashes)} line{'s' * (len(main.slashes) > 1)}"
        left_out.append(f"{lines} that / deletes" if given.delete_blocks else f"the / of {lines}, which are run")
    read_as = dialect.name + (f" ({dialect.why})" if dialect.why else "")
    return Toolpath(start, tuple(builder.elements), tuple(left_out), read_as)
