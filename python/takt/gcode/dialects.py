"""Dialects of G-code, and how they are recognised. docs/drawings.md states what the same words mean in each."""

from __future__ import annotations

import re
from dataclasses import dataclass

from takt.gcode.errors import LineError

NAMES = ("rs274", "linuxcnc", "fanuc", "grbl", "marlin")

# Patterns that identify a dialect, for lines in capital letters with their comments.
_TELLING = {
    "marlin": r"""
        ^[ \t]* (?: N[0-9]+ [ \t]*)?
            (?: M(?: 104|109|140|190|141|191|106) [ \t]* S
              | M(?: 107|155|20[0-9]|220|221|280|420|50[0-3]|569|572|862|900|907) \b
              | M(?: 117|118) [ \t]
              | G[01] [ \t] [^;(\n]* [ \t] E[-+]?[.0-9] )
      | ^[ \t]* ; [ \t]*
            (?: FLAVOR [ \t]* : [ \t]* (?: MARLIN|REPRAP|KLIPPER)
              | LAYER [ \t]* :
              | GENERATED [ ] (?: BY|WITH) [ ] (?: PRUSASLICER|SLIC3R|CURA|ORCA|SUPER|BAMBU) )""",
    "linuxcnc": r"""
        ^[ \t]* /? [ \t]* O [ \t]* (?: [0-9]+ | <[^>\n]*> | \[[^;(\n]*\]) [ \t]* (?: SUB|CALL|IF|WHILE|DO|REPEAT) \b
      | ^[^;(\n]* \#<
      | ^[^;(\n]* G(?: 43\.1|33\.1|10[ \t]*L20|5\.[123]|6\.2|38\.[2-5]) (?![0-9.])
      | ^[ \t]* [;(] [^\n]* LINUXCNC
      | ^[ \t]* \( [ \t]* (?: DEBUG|PRINT) [ \t]* ,""",
    "fanuc": r"""
        ^[ \t]* (?: N[0-9]+ [ \t]*)?
            (?: [O:] [0-9]{4,} [ \t]* (?: \(|;|$)
              | M98 [ \t]* P
              | [^;(\n]* G0?4 [ \t]* [XU]
              | [^;(\n]* G65 [ \t]* P )""",
    "grbl": r"^[ \t]* \$[0-9HXJ] | ^[ \t]* [;(] [^\n]* \b GRBL \b",
}
_PATTERNS = {name: re.compile(pattern, re.MULTILINE | re.VERBOSE) for name, pattern in _TELLING.items()}


@dataclass(frozen=True)
class Dialect:
    name: str
    why: str = ""  # the line by which it was recognised; empty: none


def of_text(lines: list[str]) -> Dialect:
    """Returns the dialect that the lines of a program identify, rs274 if none. Raises LineError if they identify two.

    Lines of linuxcnc take precedence over those of fanuc and grbl, and fanuc over grbl: LinuxCNC has O1000 and M98,
    too."""
    text = "\n".join(lines).upper()
    found: dict[str, int] = {}
    for name, pattern in _PATTERNS.items():
        first = pattern.search(text)
        if first:
            found[name] = text.count("\n", 0, first.end())
    for name, others in (("linuxcnc", ("fanuc", "grbl")), ("fanuc", ("grbl",))):
        if name in found:
            for other in others:
                found.pop(other, None)
    if len(found) > 1:
        said = " and ".join(f"line {line + 1} is of {name}" for name, line in found.items())
        raise LineError(f"{said}; choose one with --dialect {' or '.join(found)}")
    for name, line in found.items():
        return Dialect(name, f"'{lines[line].strip()[:40]}' in line {line + 1}")
    return Dialect("rs274")
