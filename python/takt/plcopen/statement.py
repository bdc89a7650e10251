"""Compares takt.plcopen with the standard: the tables in spec/, and the compliance statement made from them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import resources
from typing import Any

import yaml

from takt.plcopen.base import FunctionBlock

TABLES = ("plcopen_part1.yaml", "plcopen_part4.yaml", "gt775x.yaml", "conveyor_tracking.yaml")
# Python types of the standard's types. Enumerations are those of takt; the block's doc string explains references.
TYPES = {"BOOL": "bool", "REAL": "float", "TIME": "float, in s", "AXIS_REF": "Axis, or its name for a master"}
TYPES |= {"AXES_GROUP_REF": "Group", "LREAL": "float", "Yt_TrackOptions": "TrackOptions"}
TYPES |= dict.fromkeys(("ARRAY", "VECTOR"), "sequence of float, or a mapping of names to float")
TYPES |= dict.fromkeys(("INT", "UINT", "WORD", "DWORD"), "int")

Blocks = Mapping[str, type[FunctionBlock]]


@dataclass(frozen=True)
class Pin:
    """An input or output as listed in a table."""

    name: str
    level: str  # "B", "E" or "V": basic, extended, vendor's own; "V" if the table gives none
    type: str
    kind: str  # "in_out", "inputs" or "outputs"

    @property
    def required(self) -> bool:
        """A block that is implemented must have it: basic, or level V."""
        return self.level != "E"


@dataclass(frozen=True)
class Entry:
    """A block as listed in a table."""

    name: str
    section: str
    pins: tuple[Pin, ...]
    reason: str  # why the block is deliberately not implemented; empty: it is, or will be
    without: Mapping[str, str]  # by pin: why it is not implemented

    def missing(self, block: type[FunctionBlock]) -> tuple[Pin, ...]:
        """Returns the listed pins that a block has neither under this name nor as an alias."""
        there = names(block)
        return tuple(pin for pin in self.pins if pin.name not in there)


@dataclass(frozen=True)
class Table:
    """One file of spec/."""

    title: str
    entries: tuple[Entry, ...]


def names(block: type[FunctionBlock]) -> set[str]:
    """Returns all names of a block's axis, inputs and outputs, including aliases."""
    return {*block.AXES, *block.INPUTS, *block.OUTPUTS}


def tables() -> tuple[Table, ...]:
    """Returns the tables in spec/."""
    folder = resources.files("takt") / "spec"
    return tuple(_table(yaml.safe_load((folder / name).read_text("utf-8"))) for name in TABLES)


def _table(text: Mapping[str, Any]) -> Table:
    return Table(text["title"], tuple(_entry(name, entry) for name, entry in text["blocks"].items()))


def _entry(name: str, text: Mapping[str, Any]) -> Entry:
    without = text.get("without", {})
    reason = without if isinstance(without, str) else ""
    kinds = ("in_out", "inputs", "outputs")
    pins = tuple(_pin(n, value, kind) for kind in kinds for n, value in text.get(kind, {}).items())
    return Entry(name, text["section"], pins, reason, {} if reason else without)


def _pin(name: str, text: str, kind: str) -> Pin:
    level, _, type_name = text.rpartition(" ")
    return Pin(name, level or "V", type_name, kind)


def page(blocks: Blocks) -> str:
    """Returns the compliance statement as Markdown. **Bold** names are required (basic, or level V)."""
    return "\n".join(_page(blocks)) + "\n"


def _page(blocks: Blocks) -> Iterator[str]:
    known = tables()
    yield "# Function blocks: what there is of the standard\n"
    yield "`takt.plcopen` against the lists in `spec/`: of the standard, of the GT-775x modules, of conveyor tracking."
    yield "**Bold**: basic, what a block of this name must have. The others are extended: what it may have."
    yield "Made by `tools/compliance.py`.\n"
    yield "| type | in Python |\n|---|---|"
    for name, here in TYPES.items():
        yield f"| {name} | {here} |"
    for table in known:
        there = sum(entry.name in blocks for entry in table.entries)
        yield f"\n## {table.title}\n\n{there} of {len(table.entries)} blocks.\n"
        yield "| block | section | inputs and outputs | without | our own |\n|---|---|---|---|---|"
        for entry in table.entries:
            yield _row(entry, blocks.get(entry.name))
    listed = {entry.name for table in known for entry in table.entries}
    yield "\n## Of our own\n\n| block | inputs and outputs |\n|---|---|"
    for name, block in blocks.items():
        if name not in listed:
            yield f"| {name} | {', '.join(_in_order(block))} |"


def _row(entry: Entry, block: type[FunctionBlock] | None) -> str:
    if block is None:
        return f"| {entry.name} | {entry.section} | **not there**: {entry.reason or 'not yet'} | | |"
    missing = entry.missing(block)
    there = [f"**{pin.name}**" if pin.required else pin.name for pin in entry.pins if pin not in missing]
    without = [f"{p.name} ({entry.without[p.name]})" if p.name in entry.without else p.name for p in missing]
    listed = {block.SUBJECT, *(pin.name for pin in entry.pins)}
    own = [name for name in _in_order(block) if name not in listed]
    columns = (entry.name, entry.section, ", ".join(there), ", ".join(without), ", ".join(own))
    return f"| {' | '.join(columns)} |"


def _in_order(block: type[FunctionBlock]) -> list[str]:
    return [block.SUBJECT, *sorted(block.AXES - {block.SUBJECT}), *block.INPUTS, *block.OUTPUTS]
