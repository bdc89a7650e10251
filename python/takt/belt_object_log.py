"""What lies on belts, as pictures of the machine from above need it, and as recordings keep it: some looks a second."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from takt import msgs
from takt.recording import Array

LOOK_S = 0.04  # from one look to the next
TAKEN = msgs.belt_object.STATE_TAKEN
COLUMNS = 7

Object = tuple[Any, ...]  # number, state, place, pose (x, y, z, a, b, c) in the world, whether in range, and more


def objects_of(message: msgs.belt_objects) -> Iterator[Object]:
    """The objects of a message, as an engine in process says them."""
    for o in message.objects:
        pose = (o.pose.x, o.pose.y, o.pose.z, o.pose.a, o.pose.b, o.pose.c)
        yield o.number, o.state, o.place, pose, bool(o.in_range), o.kind, o.colour, o.quality


def rows_of(objects: Iterable[Object]) -> list[list[float]]:
    """Of each object whose place is known: number, x, y, z, c in the world, taken, within the work range."""
    return [
        [number, *pose[:3], pose[5], int(state == TAKEN), int(in_range)]
        for number, state, _, pose, in_range, *_ in objects
        if pose[0] == pose[0]
    ]


class BeltObjectLog:
    """What lay on each belt over time."""

    def __init__(self) -> None:
        self._times: dict[str, list[float]] = {}
        self._rows: dict[str, list[list[list[float]]]] = {}

    def is_due(self, belt: str, time_s: float) -> bool:
        """Whether there was no look just before."""
        times = self._times.get(belt)
        return not times or time_s - times[-1] >= 0.999 * LOOK_S

    def due_in(self, belt: str, time_s: float) -> float:
        """s until a look is due."""
        times = self._times.get(belt)
        return times[-1] + LOOK_S - time_s if times else 0.0

    def look(self, belt: str, time_s: float, objects: Iterable[Object]) -> None:
        """Keeps what lies there, if a look is due."""
        if not self.is_due(belt, time_s):
            return
        self._times.setdefault(belt, []).append(time_s)
        self._rows.setdefault(belt, []).append(rows_of(objects))

    def columns(self) -> dict[str, dict[str, Array]]:
        """Of each belt `time_s` (n,) of the looks; `rows` (m, 7) of all of them, as `rows_of` has them; `first`
        (n + 1,): those from first[i] to first[i + 1] are of look i."""
        return {
            belt: {
                "time_s": np.array(times),
                "first": np.cumsum([0, *map(len, self._rows[belt])]),
                "rows": np.array([row for rows in self._rows[belt] for row in rows], float).reshape(-1, COLUMNS),
            }
            for belt, times in self._times.items()
        }
