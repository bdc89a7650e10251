"""The last commands of movers for a session over LCM: those of all clients since it was connected."""

from __future__ import annotations

import functools
import inspect
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from takt import msgs
from takt._commands import MoverCommands
from takt.feedback import FeedbackState

KEPT = 100  # commands of each mover, as in the engine
OPEN = 10_000  # unfinished commands kept at most
UNTOLD = frozenset({"set_external_setpoint"})  # left out, as in the engine
BEFORE_MOVERS = frozenset({3015, 3033, 3100})  # refused before movers see them: stopping, too old, emergency stop

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
    limited: int = -1  # -1: not known yet


class CommandLog:
    """Assembles the history from received messages: commands, feedback, states of movers."""

    def __init__(self, movers: Iterable[str]) -> None:
        self._rows: dict[str, deque[_Row]] = {name: deque(maxlen=KEPT) for name in movers}
        self._open: dict[Key, tuple[str, _Row]] = {}
        self._begun: dict[str, _Row] = {}  # by mover: the command that began last

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
        final = message.state > FeedbackState.ACTIVE
        if final:
            del self._open[key]
        if message.cycle < 0:  # not processed by a cycle of the engine (yet)
            return
        if row.cycle < 0:
            if message.state == FeedbackState.ERROR and message.error_id in BEFORE_MOVERS:
                return
            self._rows[mover].append(row)
            row.cycle = row.begun = message.cycle
            row.ticket = message.ticket
        if message.state == FeedbackState.ACTIVE:
            row.begun = message.cycle
            self._begun[mover] = row
        row.changed = message.cycle
        row.state, row.error = message.state, message.error_id
        row.kind, row.number = message.object_kind, message.object_number

    def state(self, message: Any) -> None:
        """Takes a state of a mover: which of the dynamics of its last command was reduced."""
        row = self._begun.get(message.name)
        if row is not None and row.limited < 0 and message.cycle >= row.begun and _has_dynamics(row.verb):
            row.limited = message.limited_by

    def of(self, mover: str) -> list[tuple[Any, ...]]:
        """Returns the rows of a mover in the form of an engine in process, oldest first."""
        return [
            (r.ticket, r.verb, r.state, r.error, r.cycle, r.begun, r.changed, r.kind, r.number, max(r.limited, 0))
            for r in self._rows[mover]
        ]


@functools.cache
def _has_dynamics(verb: str) -> bool:
    method = getattr(MoverCommands, verb, None)
    return method is not None and "jerk" in inspect.signature(method).parameters
