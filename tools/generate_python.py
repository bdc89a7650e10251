"""Prints the module takt._commands: the commands and published fields of components as typed, documented Python, from
what the engine says of itself.

Usage: generate_python.py TAKTD    (asks `TAKTD --reference`)
       generate_python.py FILE.json
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

Json = dict[str, Any]

WIDTH = 120
SCALARS = {"bool": "bool", "integer": "int", "real": "float", "text": "str"}
# Commands that are no methods of a session: the engine gives them to itself, or feedback objects and heartbeats do.
INTERNAL = {("machine", verb) for verb in ("fail_all_axes", "release", "renew")}
# Error numbers are plain numbers in Python; takt.error_text() tells what they mean.
NUMBERS = {"ErrorId"}

HEAD = '''"""Commands, published fields and enumerations of components. Made by tools/generate_python.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from takt.feedback import Feedback
'''

NAME = '''class Name(str, Enum):
    """A member of an enumeration, which is also the text that stands for it."""

    def __str__(self) -> str:
        return str(self.value)'''


def class_name(kind: str) -> str:
    """flex_cam -> FlexCam."""
    return "".join(word.capitalize() for word in kind.split("_"))


def member(name: str) -> str:
    """The name of an enumeration's member: "DiscreteMotion", "blending_low" -> DISCRETE_MOTION, BLENDING_LOW."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).upper()


def doc(text: str, indent: str) -> str:
    """A doc string: the text, wrapped."""
    lines = []
    for paragraph in text.split("\n"):
        hang = "    " if paragraph.startswith("* ") else ""
        lines += textwrap.wrap(paragraph.removeprefix("* "), WIDTH - len(indent) - 8, subsequent_indent=hang) or [""]
    escaped = "\n".join((indent + line) if line else "" for line in lines).strip().replace("\\", "\\\\")
    return f'{indent}"""{escaped}"""' if len(lines) == 1 else f'{indent}"""{escaped}\n{indent}"""'


def enumerations(node: Any, found: dict[str, Json]) -> dict[str, Json]:
    """All enumerations below a piece of the reference, by name, in the order of their first use."""
    if isinstance(node, dict):
        is_class = node.get("kind") == "enum" and node["name"] not in NUMBERS
        if is_class and found.setdefault(node["name"], node) != node:
            raise ValueError(f"there are two enumerations {node['name']}")
        for child in node.values():
            enumerations(child, found)
    elif isinstance(node, list):
        for child in node:
            enumerations(child, found)
    return found


def enum_class(enum: Json) -> str:
    """The class of an enumeration. Its members are strings: what YAML and the recordings write."""
    lines = [f"class {enum['name']}(Name):", doc(enum["about"], "    "), ""]
    lines += [f'    {member(v["name"])} = "{v["name"]}"  # {v["about"]}' for v in enum["values"]]
    names = [json.dumps(v["name"]) for v in enum["values"]]
    alias = f"{enum['name']}Name = Literal[{', '.join(names)}]"
    if len(alias) > WIDTH:
        alias = f"{enum['name']}Name = Literal[\n" + "".join(f"    {name},\n" for name in names) + "]"
    return "\n".join(lines) + "\n\n\n" + alias


def type_text(node: Json, argument: bool) -> str:
    """The Python type of a value. As an argument, an enumeration may also be given by the name of its member."""
    kind = node["kind"]
    if kind == "optional":
        return type_text(node["element"], argument) + " | None"
    if kind == "list":
        return f"{'Sequence' if argument else 'list'}[{type_text(node['element'], argument)}]"
    if kind == "enum":
        if node["name"] in NUMBERS:
            return "int"
        return f"{node['name']} | {node['name']}Name" if argument else str(node["name"])
    return "Mapping[str, Any]" if kind == "struct" else SCALARS[kind]


def default_text(field: Json) -> str:
    """What stands behind the = of an argument."""
    value = field.get("default")
    if isinstance(value, list):
        value = tuple(value)  # nobody changes it
    return f'"{value}"' if isinstance(value, str) else repr(value)


def argument_line(field: Json) -> str:
    """The line of the doc string that explains an argument."""
    brackets = []
    if unit := field.get("unit"):
        brackets.append(unit)
    if limits := field.get("range"):
        brackets.append(limits["text"])
    return f"* {field['name']}: {field['about']}" + (f" [{', '.join(brackets)}]" if brackets else "")


def method(verb: Json) -> str:
    """The method of a command."""
    fields = [f for f in verb["arguments"]["fields"] if f["presence"] != "internal"]
    lines = [f"    def {verb['name']}("]
    if fields:
        lines += ["        self,", "        *,"]
        for field in fields:
            default = "" if field["presence"] == "required" else f" = {default_text(field)}"
            lines.append(f"        {field['name']}: {type_text(field['type'], True)}{default},")
        lines.append("    ) -> Feedback:")
    else:
        lines = [f"    def {verb['name']}(self) -> Feedback:"]
    explained = "\n".join([verb["arguments"]["about"], *([""] if fields else []), *map(argument_line, fields)])
    lines.append(doc(explained, "        "))
    pairs = [f'"{f["name"]}": {f["name"]}' for f in fields]
    call = f'        return self._command("{verb["name"]}", {{{", ".join(pairs)}}})'
    if len(call) > WIDTH:
        lines += ["        return self._command(", f'            "{verb["name"]}",', "            {"]
        lines += [f"                {argument}," for argument in pairs]
        call = "            },\n        )"
    lines.append(call)
    return "\n".join(lines)


def pair(texts: tuple[str, str]) -> str:
    """A pair as Python writes it."""
    return f'("{texts[0]}", "{texts[1]}")'


def defaults(verbs: list[Json]) -> str:
    """The table of what arguments are when they are not given."""
    lines = [
        "# What arguments are when they are not given, by kind of component and verb.",
        "DEFAULTS: Mapping[tuple[str, str], Mapping[str, Any]] = {",
    ]
    for verb in verbs:
        given = [f for f in verb["arguments"]["fields"] if f.get("default") is not None]
        pairs = ", ".join(f'"{f["name"]}": {default_text(f)}' for f in given)
        lines.append(f"    {pair((verb['target_kind'], verb['name']))}: {{{pairs}}},")
    return "\n".join([*lines, "}"])


def commands_class(name: str, about: str, verbs: list[Json]) -> str:
    """A mixin with a method for each command."""
    head = f"""class {name}:
    \"\"\"{about}\"\"\"

    def _command(self, verb: str, arguments: Mapping[str, Any]) -> Feedback:
        raise NotImplementedError
"""
    return head + "".join(f"\n{method(verb)}\n" for verb in verbs).rstrip()


def property_text(field: Json) -> str:
    """The property of a published field."""
    if field["type"]["kind"] == "struct":
        return struct_property(field)
    kind = type_text(field["type"], False)
    about = field["about"] + (f" [{field['unit']}]" if field.get("unit") else "")
    lines = ["    @property", f"    def {field['name']}(self) -> {kind}:", doc(about, "        ")]
    lines.append(f'        return {kind}(self._value("{field["name"]}"))')
    return "\n".join(lines)


def struct_property(field: Json) -> str:
    """The property of a published struct: its numbers in their order."""
    parts = field["type"]["fields"]
    about = field["about"] + " [" + ", ".join(f"{part['name']}: {part['unit']}" for part in parts) + "]"
    values = [f'self._value("{field["name"]}_{part["name"]}")' for part in parts]
    lines = ["    @property", f"    def {field['name']}(self) -> tuple[float, ...]:", doc(about, "        ")]
    return "\n".join([*lines, "        return (", *(f"            {value}," for value in values), "        )"])


def outputs_class(name: str, outputs: Json) -> str:
    """A mixin with a property for each published field."""
    head = f"""class {name}:
{doc(outputs["about"], "    ")}

    def _value(self, field: str) -> Any:
        raise NotImplementedError
"""
    return head + "".join(f"\n{property_text(field)}\n" for field in outputs["fields"]).rstrip()


def module(reference: Json) -> str:
    """The whole module."""
    verbs = [v for v in reference["verbs"] if (v["target_kind"], v["name"]) not in INTERNAL]
    of = {kind: [v for v in verbs if v["target_kind"] == kind] for kind in ("machine", *reference["outputs"])}
    level = sorted((v["target_kind"], v["name"]) for v in verbs if v["level_sensitive"])
    enums = enumerations([reference["verbs"], reference["outputs"]], {})
    parts = [
        HEAD.rstrip() + f"\n\n__all__ = {json.dumps(sorted(enums))}\n\n# Commands that act until they are released.\n"
        f"LEVEL_SENSITIVE = frozenset({{{', '.join(map(pair, level))}}})\n\n{defaults(verbs)}",
        NAME,
        *map(enum_class, enums.values()),
        commands_class("MachineCommands", "What the machine as a whole can be told.", of["machine"]),
    ]
    for kind in reference["kinds"]:
        name = class_name(kind["name"])
        about = f"What {kind['one']} can be told. Quantities are in the axis' own unit u."
        parts += [
            commands_class(f"{name}Commands", about, of[kind["name"]]),
            outputs_class(f"{name}Outputs", reference["outputs"][kind["name"]]),
        ]
    return "\n\n\n".join(parts)


def main() -> None:
    """Reads the reference from where the command line says."""
    source = Path(sys.argv[1])
    if source.suffix == ".json":
        text = source.read_text(encoding="utf-8")
    else:
        text = subprocess.run([source, "--reference"], check=True, capture_output=True, text=True).stdout
    print(module(json.loads(text)))


if __name__ == "__main__":
    main()
