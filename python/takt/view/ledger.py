"""Commands of all clients and their results, from the commands and feedbacks on the network."""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Collection
from typing import NamedTuple

from takt import msgs

MOST = 5000  # commands stored
MOST_EVENTS = 500
STATES = ("busy", "active", "done", "aborted", "error")
FINAL = 2  # from this state on
Key = tuple[str, int, int]


class Event(NamedTuple):
    cycle: int
    target: str
    text: str
    state: str  # "given", or one of STATES
    sentence: str
    client: str


class Ledger:
    def __init__(self, targets: Collection[str]) -> None:
        self._targets = targets  # existing targets; of others only events are kept
        self.events: deque[Event] = deque(maxlen=MOST_EVENTS)
        self.count = 0  # number of all events so far
        self.touched: set[str] = set()  # targets with news; the reader clears it
        self._given: OrderedDict[Key, tuple[str, str]] = OrderedDict()
        self._tickets: OrderedDict[int, str] = OrderedDict()
        self._open: dict[str, OrderedDict[Key, str]] = {}
        self._trouble: dict[str, str] = {}
        self._last: OrderedDict[Key, int] = OrderedDict()

    def take_command(self, message: msgs.command, cycle: int) -> None:
        key = (message.client, message.session, message.id)
        if key in self._given:  # a repetition
            return
        arguments = message.arguments.strip()
        text = f"{message.verb} {arguments}" if arguments not in ("", "{}") else message.verb
        _remember(self._given, key, (message.target, text))
        self._note(Event(cycle, message.target, text, "given", "", message.client))

    def take_feedback(self, message: msgs.feedback) -> None:
        key = (message.client, message.session, message.id)
        known = self._given.get(key)
        if known is None or not 0 <= message.state < len(STATES) or self._last.get(key, -1) >= message.state:
            return
        _remember(self._last, key, message.state)
        target, text = known
        still_open = self._open.setdefault(target, OrderedDict()) if target in self._targets else OrderedDict()
        if message.ticket:
            _remember(self._tickets, message.ticket, text)
        if message.state >= FINAL:
            still_open.pop(key, None)
            self._note(Event(message.cycle, target, text, STATES[message.state], message.sentence, message.client))
        else:
            _remember(still_open, key, text)
        if message.error_id and target in self._targets:
            self._trouble[target] = message.sentence
        self.touched.add(target)

    def command_of(self, target: str, ticket: int = 0) -> str:
        """Returns the command that a component executes: the one with this ticket; ticket 0: the oldest that has not
        ended. "" if there is none."""
        if ticket:
            return self._tickets.get(ticket, f"command {ticket}")
        still_open = self._open.get(target)
        return next(iter(still_open.values())) if still_open else ""

    def trouble_of(self, target: str) -> str:
        """Returns the sentence of the last refused or failed command; "" if there is none."""
        return self._trouble.get(target, "")

    def since(self, count: int) -> list[Event]:
        """Returns the events from this number on, as far as they are stored."""
        new = min(self.count - count, len(self.events))
        return list(self.events)[len(self.events) - new :] if new > 0 else []

    def _note(self, event: Event) -> None:
        self.events.append(event)
        self.count += 1
        self.touched.add(event.target)


def _remember(memory: OrderedDict, key: object, value: object) -> None:  # type: ignore[type-arg]
    memory[key] = value
    while len(memory) > MOST:
        memory.popitem(last=False)
