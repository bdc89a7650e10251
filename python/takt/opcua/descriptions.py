"""The descriptions from which the address space is built; machine files, commands and published values use the same."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from takt import _core
from takt.tables import KINDS

Type = dict[str, Any]
MACHINE = "machine"  # target of commands to the machine as a whole
SCALARS = ("bool", "integer", "real", "text", "enum")


@dataclass(frozen=True)
class Enumeration:
    name: str
    about: str
    members: tuple[str, ...]  # by number, from 0


@dataclass(frozen=True)
class Field:
    """A value that a component publishes."""

    name: str
    unit: str  # as in the descriptions: u/s2
    about: str
    enumeration: str  # name of its enumeration; empty: a number or a boolean


@dataclass(frozen=True)
class Argument:
    """An argument of a command."""

    name: str
    kind: str  # one of SCALARS; "yaml": a structure, given as YAML text
    is_list: bool
    enumeration: str  # name of its enumeration; empty: none
    has_default: bool
    unset: bool  # True: has no value if it is left out
    about: str  # with unit, range and default


@dataclass(frozen=True)
class Verb:
    target_kind: str
    name: str
    about: str
    arguments: tuple[Argument, ...]


@functools.cache
def _reference() -> dict[str, Any]:
    described: dict[str, Any] = json.loads(_core.reference())
    return described


def _below(kind: Type, name: str = "") -> Iterator[tuple[str, Type]]:
    """Yields a type and all types inside it, with the names of fields as they are published: pcs1_x."""
    yield name, kind
    for field in kind.get("fields", ()):
        yield from _below(field["type"], f"{name}_{field['name']}" if name else field["name"])
    if "element" in kind:
        yield from _below(kind["element"], name)


def _roots() -> Iterator[Type]:
    yield from _reference()["outputs"].values()
    for verb in _reference()["verbs"]:
        yield verb["arguments"]


@functools.cache
def enumerations() -> dict[str, Enumeration]:
    """Returns the enumerations of all published values and all arguments, by name."""
    found: dict[str, Enumeration] = {}
    for root in _roots():
        for _, kind in _below(root):
            if kind["kind"] == "enum":
                members = tuple(value["name"] for value in kind["values"])
                found[kind["name"]] = Enumeration(kind["name"], kind.get("about", ""), members)
    return found


@functools.cache
def fields_of(kind: str) -> tuple[Field, ...]:
    """Returns the fields that components of this kind publish, in the order of `takt.tables.KINDS`."""
    types = dict(_below(_reference()["outputs"][kind]))
    return tuple(
        Field(name, unit, about, types[name]["name"] if name in KINDS[kind].names else "")
        for name, unit, about, _ in _core.output_fields(kind)
    )


@functools.cache
def verbs_of(kind: str) -> tuple[Verb, ...]:
    """Returns the commands of components of this kind, or of the machine."""
    return tuple(
        Verb(kind, verb["name"], verb["arguments"]["about"], tuple(map(_argument, verb["arguments"]["fields"])))
        for verb in _reference()["verbs"]
        if verb["target_kind"] == kind
    )


@functools.cache
def figures() -> Mapping[str, str]:
    """Returns the meanings of the figures that the engine publishes of itself, by name."""
    return {field["name"]: field["about"] for field in _reference()["figures"]["fields"]}


def _argument(field: dict[str, Any]) -> Argument:
    kind: Type = field["type"]
    optional = kind["kind"] == "optional"
    kind = kind["element"] if optional else kind
    is_list = kind["kind"] in ("list", "array") and kind["element"]["kind"] in SCALARS
    kind = kind["element"] if is_list else kind
    required = field["presence"] == "required"
    default = field.get("default")
    said = [field["about"]]
    if field.get("unit"):
        said.append(f"Unit: {field['unit']}.")
    if field.get("range"):
        said.append(f"Range: {field['range']['text']}.")
    if not required and default is not None and not (isinstance(default, float) and math.isnan(default)):
        said.append(f"Default: {json.dumps(default)}.")
    return Argument(
        field["name"],
        kind["kind"] if kind["kind"] in SCALARS else "yaml",
        is_list,
        kind["name"] if kind["kind"] == "enum" else "",
        not required,
        optional,
        " ".join(said),
    )
