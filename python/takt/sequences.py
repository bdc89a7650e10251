"""Finds lost messages by their sequence numbers, channel by channel."""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass, field
from typing import Any

OBJECTS = "takt/belt_objects/"  # channels of objects on belts; only their losses show missing samples of these
REORDERED = 1_000  # lost messages of a channel that may still arrive late


@dataclass
class _Channel:
    sequence: int
    cycle: int
    lost: int = 0
    missing: deque[int] = field(default_factory=lambda: deque(maxlen=REORDERED))  # the last lost ones
    steps: Counter[int] = field(default_factory=Counter)  # in cycles, from one message to the next


class Sequences:
    """Tracks the sequence numbers of messages, which increase by one per message on each channel.

    A number that jumps by more than the cycles since the last message is ignored: no channel of a component has more
    than one message per cycle. A late message is not lost, and a repeated one counts once.
    """

    def __init__(self) -> None:
        self._channels: dict[str, _Channel] = {}

    def hear(self, channel: str, message: Any) -> None:
        """Takes a received message."""
        sequence, cycle = getattr(message, "sequence", None), getattr(message, "cycle", 0)
        if sequence is None:
            return
        known = self._channels.get(channel)
        if known is None:
            self._channels[channel] = _Channel(sequence, cycle)
            return
        step, cycles = int(sequence - known.sequence), int(cycle - known.cycle)
        if -REORDERED <= step <= 0:  # late or repeated
            if sequence in known.missing:
                known.missing.remove(sequence)
                known.lost -= 1
            return
        if step > 1 and hasattr(message, "time_ns") and step > cycles:
            return
        known.lost += max(step - 1, 0)
        known.missing.extend(range(max(known.sequence + 1, sequence - REORDERED), sequence))
        if step == 1 and cycles > 0:
            known.steps[cycles] += 1
        known.sequence, known.cycle = sequence, cycle

    def lost(self) -> dict[str, int]:
        """Returns the numbers of missing messages by channel: those lost in transmission and, for objects on belts,
        also those that the engine dropped, which leave a gap of cycles."""
        found = {
            name: of.lost + (_skipped(of.steps) if name.startswith(OBJECTS) else 0)
            for name, of in self._channels.items()
        }
        return {name: count for name, count in found.items() if count}


def _skipped(steps: Counter[int]) -> int:
    """Returns the number of messages missing between messages with consecutive numbers, by their cycles."""
    if not steps:
        return 0
    usual = steps.most_common(1)[0][0]
    return sum((-(-cycles // usual) - 1) * count for cycles, count in steps.items())
