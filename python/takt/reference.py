"""The reference page: everything that is described in C++, as Markdown."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from takt import _core

Type = dict[str, Any]


def reference_page() -> str:
    """Machine file, commands, published values, states with their diagram, and error numbers."""
    reference: dict[str, Any] = json.loads(_core.reference())
    return "\n".join(_page(reference)) + "\n"


def _page(reference: dict[str, Any]) -> Iterator[str]:
    yield f"# Takt {reference['version']}: reference\n"
    yield "u stands for an axis' own unit. Unset means that the key may be left out.\n"
    yield "## Machine file\n"
    for one in _structs(reference["machine"], {}).values():
        yield from _struct(one, "###")
    yield "## Commands\n"
    for verb in reference["verbs"]:
        yield from _verb(verb)
    yield "## Published\n"
    published = {**reference["outputs"], "engine": reference["figures"]}
    for name, fields in published.items():
        yield f"### {name}\n"
        yield from _fields(fields)
    yield "## States of an axis\n"
    for state in reference["states"]["values"]:
        yield f"- **{state['name']}**: {state['about']}"
    yield "\n```mermaid\nstateDiagram-v2"
    for t in reference["transitions"]:
        yield f"  {t['from']} --> {t['to']}: {t['by']}"
    yield "```\n"
    yield "## Homing\n"
    yield from _homing(reference["homing"])
    yield "## Errors\n"
    yield from _errors(reference["errors"])


def commands(names: Sequence[str]) -> str:
    """What the reference page says of these commands; those of other components than axes are called "flex_cam.jog"."""
    verbs = {_called(verb): verb for verb in json.loads(_core.reference())["verbs"]}
    return "\n".join(line for name in names for line in _verb(verbs[name]))


def errors(numbers: Sequence[int]) -> str:
    """The table of these error numbers."""
    known = {error["id"]: error for error in json.loads(_core.reference())["errors"]}
    return "\n".join(_errors([known[number] for number in numbers]))


def verbs() -> list[str]:
    """All commands, of the machine, of axes and of other components, as `commands` calls them."""
    return [_called(verb) for verb in json.loads(_core.reference())["verbs"]]


def _called(verb: dict[str, Any]) -> str:
    of = verb["target_kind"]
    return str(verb["name"] if of in ("machine", "axis") else f"{of}.{verb['name']}")


def _verb(verb: dict[str, Any]) -> Iterator[str]:
    needs = " Needs a heartbeat over LCM." if verb["level_sensitive"] else ""
    yield f"### {verb['target_kind']}: {verb['name']}\n"
    yield f"{verb['arguments']['about']}{needs}\n"
    yield from _fields(verb["arguments"])


def _errors(errors: Sequence[dict[str, Any]]) -> Iterator[str]:
    yield "| number | name | meaning |\n|---|---|---|"
    for error in errors:
        yield f"| {error['id']:04} | {error['name']} | {error['text']} |"


def _homing(homing: dict[str, Any]) -> Iterator[str]:
    """The stages of a homing step, drawn from the table that the engine runs."""
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
    """All structs below a type, by name, each before those inside it."""
    if kind["kind"] == "struct":
        found.setdefault(kind["name"], kind)
        for field in kind["fields"]:
            _structs(field["type"], found)
    elif "element" in kind:
        _structs(kind["element"], found)
    return found


def _struct(kind: Type, level: str) -> Iterator[str]:
    yield f"{level} {kind['name']}\n"
    yield f"{kind['about']}\n"
    yield from _fields(kind)


def _fields(kind: Type) -> Iterator[str]:
    if not kind["fields"]:
        return
    yield "| name | type | unit | range | default | meaning |\n|---|---|---|---|---|---|"
    for field in kind["fields"]:
        default = "required" if field["presence"] == "required" else _default(field)
        cells = (
            field["name"],
            _type(field["type"]),
            field.get("unit", ""),
            field.get("range", {}).get("text", ""),
            default,
        )
        yield f"| {' | '.join(map(str, cells))} | {field['about']} |"
    for rule in kind["rules"]:
        yield f"\n{rule['field']} {rule['text']}."
    yield ""


def _type(kind: Type) -> str:
    if kind["kind"] == "enum":
        return " / ".join(value["name"] for value in kind["values"])
    if "element" in kind:
        return ("" if kind["kind"] == "optional" else "list of ") + _type(kind["element"])
    return str(kind.get("name", kind["kind"]))


def _default(field: dict[str, Any]) -> str:
    default = field.get("default")
    if field["type"]["kind"] in ("struct", "list", "array"):
        return ""
    return "unset" if default is None else str(default)
