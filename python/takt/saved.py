"""States of an engine in process that are kept, and gone back to (PY-23): what led there is made again, bit for bit."""

from __future__ import annotations

from dataclasses import dataclass, field

JournalEntry = tuple[int, int, float, str, str, str]  # cycle, ticket, lease in s, target, verb, arguments


@dataclass(frozen=True)
class Saved:
    """A state of an engine, made by `Engine.save`. It can be pickled; `hash` is the state's."""

    machine_text: bytes = field(repr=False)
    file_name: str  # of the machine file
    period_s: float | None  # instead of the machine file's
    cycle: int
    hash: int
    journal: tuple[JournalEntry, ...] = field(repr=False)  # all commands up to there
    version: str
