"""Saved states of an engine in process (PY-23): they are restored bit for bit by replaying their journal."""

from __future__ import annotations

from dataclasses import dataclass, field

JournalEntry = tuple[int, int, float, str, str, str]  # cycle, ticket, lease in s, target, verb, arguments


@dataclass(frozen=True)
class Saved:
    """A state of an engine, returned by `Engine.save`. It can be pickled; `hash` is the hash of the state."""

    machine_text: bytes = field(repr=False)
    file_name: str  # of the machine file
    period_s: float | None  # None: that of the machine file
    cycle: int
    hash: int
    journal: tuple[JournalEntry, ...] = field(repr=False)  # all commands up to the state
    version: str
