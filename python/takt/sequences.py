"""What is missing among numbered messages, channel by channel."""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass, field
from typing import Any

OBJECTS = "takt/belt_objects/"  # channels of what lies on belts; nothing else shows where a look is missing
REORDERED = 1_000  # lost messages of a channel that may still come late


@dataclass
class _Channel:
    sequence: int
    cycle: int
    lost: int = 0
    missing: deque[int] = field(default_factory=lambda: deque(maxlen=REORDERED))  # the last ones that are lost
    steps: Counter[int] = field(default_factory=Counter)  # in cycles, from one message to the next


class Sequences:
    """Hears the numbers of messages, which count up from one to the next on each channel.

    A number that jumps by more than there were cycles since the last message is not believed: no channel of a component
    has more than one message a cycle. A message that comes behind later ones is
    not lost, and one that comes twice counts once.
    """

    def __init__(self) -> None:
        self._channels: dict[str, _Channel] = {}

    def hear(self, channel: str, message: Any) -> None:
        """Takes a message as it came."""
        sequence, cycle = getattr(message, "sequence", None), getattr(message, "cycle", 0)
        if sequence is None:
            return
        known = self._channels.get(channel)
        if known is None:
            self._channels[channel] = _Channel(sequence, cycle)
            return
        step, cycles = int(sequence - known.sequence), int(cycle - known.cycle)
        if -REORDERED <= step <= 0:  # it comes late, or twice
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
        """How many messages are missing, by channel: those lost on the way, and of what lies on belts those, too, that
        the engine had no room for, which leave a gap of cycles."""
        found = {
            name: of.lost + (_skipped(of.steps) if name.startswith(OBJECTS) else 0)
            for name, of in self._channels.items()
        }
        return {name: count for name, count in found.items() if count}


def _skipped(steps: Counter[int]) -> int:
    """Messages that are missing between two that follow one another by their numbers."""
    if not steps:
        return 0
    usual = steps.most_common(1)[0][0]
    return sum((-(-cycles // usual) - 1) * count for cycles, count in steps.items())
