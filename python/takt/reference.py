"""The reference page: all descriptions in C++, as Markdown."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from takt import _core

Type = dict[str, Any]

UNITS = "u stands for an axis' own unit. Unset means that the key may be left out."


def reference_page() -> str:
    """Returns the page: machine file, commands, published values, states with their diagram, and error numbers."""
    head = f"# Takt {_core.__version__}: reference\n\n{UNITS}\n"
    return "\n".join([head, *sections().values()]) + "\n"


def sections() -> dict[str, str]:
    """Returns the parts of the page by name, each with a heading of the second level."""
    reference: dict[str, Any] = json.loads(_core.reference())
    return {name: "\n".join(write(reference)) for name, write in SECTIONS.items()}


def _machine_file(reference: dict[str, Any]) -> Iterator[str]:
    yield "## Machine file\n"
    for one in _structs(reference["machine"], {}).values():
        yield f"### {one['name']}\n"
        yield f"{one['about']}\n"
        yield from _fields(one, linked=True)


def _commands(reference: dict[str, Any]) -> Iterator[str]:
    yield "## Commands\n"
    for verb in reference["verbs"]:
        yield from _verb(verb)


def _published(reference: dict[str, Any]) -> Iterator[str]:
    yield "## Published\n"
    published = {**reference["outputs"], "engine": reference["figures"]}
    for name, fields in published.items():
        yield f"### {name}\n"
        yield from _fields(fields)


def _states(reference: dict[str, Any]) -> Iterator[str]:
    yield "## States of an axis\n"
    for state in reference["states"]["values"]:
        yield f"- **{state['name']}**: {state['about']}"
    yield "\n```mermaid\nstateDiagram-v2"
    for t in reference["transitions"]:
        yield f"  {t['from']} --> {t['to']}: {t['by']}"
    yield "```\n"


def commands(names: Sequence[str]) -> str:
    """Returns the entries of the reference page for these commands; those of components other than axes are named as
    "flex_cam.jog"."""
    verbs = {_called(verb): verb for verb in json.loads(_core.reference())["verbs"]}
    return "\n".join(line for name in names for line in _verb(verbs[name]))


def errors(numbers: Sequence[int]) -> str:
    """Returns the table of these error numbers."""
    known = {error["id"]: error for error in json.loads(_core.reference())["errors"]}
    return "\n".join(_errors([known[number] for number in numbers]))


def verbs() -> list[str]:
    """Returns the names of all commands, of the machine, of axes and of other components, as in `commands`."""
    return [_called(verb) for verb in json.loads(_core.reference())["verbs"]]


def _called(verb: dict[str, Any]) -> str:
    of = verb["target_kind"]
    return str(verb["name"] if of in ("machine", "axis") else f"{of}.{verb['name']}")


def _verb(verb: dict[str, Any]) -> Iterator[str]:
    needs = " Needs a heartbeat over LCM." if verb["level_sensitive"] else ""
    yield f"### {verb['target_kind']}: {verb['name']}\n"
    yield f"{verb['arguments']['about']}{needs}\n"
    yield from _fields(verb["arguments"])


def _all_errors(reference: dict[str, Any]) -> Iterator[str]:
    yield "## Errors\n"
    yield from _errors(reference["errors"])


def _errors(errors: Sequence[dict[str, Any]]) -> Iterator[str]:
    yield "| number | name | meaning |\n|---|---|---|"
    for error in errors:
        yield f"| {error['id']:04} | {error['name']} | {error['text']} |"


def _homing(reference: dict[str, Any]) -> Iterator[str]:
    """Yields the stages of a homing step, from the state table that the engine uses."""
    yield "## Homing\n"
    homing = reference["homing"]
    for title in ("stages", "events", "actions", "steps"):
        yield f"{title.capitalize()}:\n"
        for value in homing[title]["values"]:
            yield f"- **{value['name']}**: {value['about']}"
        yield ""
    yield "```mermaid\nstateDiagram-v2\n  [*] --> searching\n  [*] --> leaving"
    for row in homing["rows"]:
        to = "[*]" if row["to"] == "none" else row["to"]
        only = "" if row["steps"] == "all" else f" ({row['steps']})"
        yield f"  {row['from']} --> {to}: {row['event']} / {row['action']}{only}"
    yield "```\n"


def _structs(kind: Type, found: dict[str, Type]) -> dict[str, Type]:
    """Returns all structs below a type, by name, each before those inside it."""
    if kind["kind"] == "struct":
        found.setdefault(kind["name"], kind)
        for field in kind["fields"]:
            _structs(field["type"], found)
    elif "element" in kind:
        _structs(kind["element"], found)
    return found


def _fields(kind: Type, linked: bool = False) -> Iterator[str]:
    """Yields the table of a struct. `linked`: the structs inside it have headings in the same text."""
    if not kind["fields"]:
        return
    yield "| name | type | unit | range | default | meaning |\n|---|---|---|---|---|---|"
    for field in kind["fields"]:
        default = "required" if field["presence"] == "required" else _default(field)
        cells = (
            field["name"],
            _type(field["type"], linked),
            field.get("unit", ""),
            field.get("range", {}).get("text", ""),
            default,
        )
        yield f"| {' | '.join(map(str, cells))} | {field['about']} |"
    for rule in kind["rules"]:
        yield f"\n{rule['field']} {rule['text']}."
    yield ""


def _type(kind: Type, linked: bool) -> str:
    if kind["kind"] == "enum":
        return " / ".join(value["name"] for value in kind["values"])
    if "element" in kind:
        return ("" if kind["kind"] == "optional" else "list of ") + _type(kind["element"], linked)
    if linked and kind["kind"] == "struct":
        return f"[{kind['name']}](#{kind['name'].lower()})"
    return str(kind.get("name", kind["kind"]))


def _default(field: dict[str, Any]) -> str:
    default = field.get("default")
    if field["type"]["kind"] in ("struct", "list", "array"):
        return ""
    return "unset" if default is None else str(default)


SECTIONS = {
    "machine_file": _machine_file,
    "commands": _commands,
    "published": _published,
    "states": _states,
    "homing": _homing,
    "errors": _all_errors,
}
