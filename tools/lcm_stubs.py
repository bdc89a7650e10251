"""Prints the stub file of the package takt.msgs: what lcm-gen makes of .lcm files has no types.

Usage: lcm_stubs.py FILE.lcm ...
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

SCALARS = {
    **dict.fromkeys(("byte", "int8_t", "int16_t", "int32_t", "int64_t"), "int"),
    "float": "float",
    "double": "float",
    "boolean": "bool",
    "string": "str",
}


def field_type(type_name: str, dimensions: int) -> str:
    """The Python type of a field, as lcm-gen's code decodes it and takes it."""
    name = SCALARS.get(type_name, type_name.rpartition(".")[2])
    if dimensions == 0:
        return name
    if type_name == "byte":
        name = "bytes"
    elif name in ("int", "float"):
        name = f"Sequence[{name}]"  # decoded as a tuple
    else:
        name = f"list[{name}]"
    return "list[" * (dimensions - 1) + name + "]" * (dimensions - 1)


def struct_stub(name: str, body: str) -> str:
    """The class of one struct."""
    lines = [f"class {name}:"]
    for statement in filter(None, (part.strip() for part in body.split(";"))):
        constant = re.fullmatch(r"const\s+(\S+)\s+(.*)", statement, re.DOTALL)
        if constant:
            names = re.findall(r"(\w+)\s*=", constant[2])
            lines += [f"    {one}: Final[{SCALARS[constant[1]]}]" for one in names]
        else:
            type_name, names_text = statement.split(None, 1)
            for one, dimensions in re.findall(r"(\w+)\s*((?:\[[^\]]*\]\s*)*)", names_text):
                lines.append(f"    {one}: {field_type(type_name, dimensions.count('['))}")
    lines += [
        "    def __init__(self) -> None: ...",
        "    def encode(self) -> bytes: ...",
        "    @staticmethod",
        f"    def decode(data: bytes | IO[bytes]) -> {name}: ...",
    ]
    return "\n".join(lines)


def main() -> None:
    """Reads the files named on the command line."""
    print("from collections.abc import Sequence\nfrom typing import IO, Final")
    for path in sys.argv[1:]:
        text = re.sub(r"//[^\n]*|/\*.*?\*/", "", Path(path).read_text(encoding="utf-8"), flags=re.DOTALL)
        for name, body in re.findall(r"\bstruct\s+(\w+)\s*\{(.*?)\}", text, re.DOTALL):
            print("\n" + struct_stub(name, body))


if __name__ == "__main__":
    main()
