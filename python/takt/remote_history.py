"""The last commands of movers for a session over LCM: its own and those of other clients, since it was connected."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from takt import msgs
from takt.feedback import FeedbackState

KEPT = 100  # commands of each mover, as the engine keeps
OPEN = 10_000  # commands that are not finished
UNTOLD = frozenset({"set_external_setpoint"})  # the engine keeps none of these either

Key = tuple[str, int, int]  # client, session, number of the command


@dataclass
class _Row:
    verb: str
    ticket: int = 0
    state: int = FeedbackState.BUSY
    error: int = 0
    cycle: int = -1
    begun: int = 0
    changed: int = -1
    kind: int = 0
    number: int = 0
    limited: int = -1  # -1: not told yet


class CommandLog:
    """Takes messages as they come: commands, feedback, states of movers."""

    def __init__(self, movers: Iterable[str]) -> None:
        self._rows: dict[str, deque[_Row]] = {name: deque(maxlen=KEPT) for name in movers}
        self._open: dict[Key, tuple[str, _Row]] = {}

    def command(self, message: msgs.command) -> None:
        key = (message.client, message.session, message.id)
        if message.target not in self._rows or message.verb in UNTOLD or key in self._open:
            return
        self._open[key] = (message.target, _Row(message.verb))
        if len(self._open) > OPEN:
            del self._open[next(iter(self._open))]

    def feedback(self, message: msgs.feedback) -> None:
        key = (message.client, message.session, message.id)
        mover, row = self._open.get(key, ("", None))
        if row is None or message.cycle < row.changed:
            return
        if row.cycle < 0:
            self._rows[mover].append(row)
            row.cycle = message.cycle
        row.ticket = message.ticket or row.ticket
        if message.state != row.state or row.changed < 0:
            row.changed = message.cycle
        if message.state == FeedbackState.ACTIVE and row.state != FeedbackState.ACTIVE:
            row.begun = message.cycle
        row.state, row.error = message.state, message.error_id
        if message.object_number:
            row.kind, row.number = message.object_kind, message.object_number
        if message.state > FeedbackState.ACTIVE:
            row.begun = row.begun or message.cycle
            del self._open[key]

    def state(self, message: Any) -> None:
        """Of a mover: what the dynamics of its last command were reduced by."""
        rows = self._rows.get(message.name)
        if rows and rows[-1].limited < 0 and message.cycle >= rows[-1].cycle >= 0:
            rows[-1].limited = message.limited_by

    def of(self, mover: str) -> list[tuple[Any, ...]]:
        """Rows as an engine in process gives them, the oldest first."""
        return [
            (r.ticket, r.verb, r.state, r.error, r.cycle, r.begun, r.changed, r.kind, r.number, max(r.limited, 0))
            for r in self._rows[mover]
        ]
