"""Objects on belts over time, sampled a few times a second: for recordings and for top views of the machine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from takt import msgs
from takt.recording import Array

LOOK_S = 0.04  # s from one sample to the next
TAKEN = msgs.belt_object.STATE_TAKEN
COLUMNS = 7

Object = tuple[Any, ...]  # the fields of takt.BeltObject, the state by number; pose (x, y, z, a, b, c) in the world


def objects_of(message: msgs.belt_objects) -> Iterator[Object]:
    """Returns the objects of a message in the form of an engine in process."""
    for o in message.objects:
        pose = (o.pose.x, o.pose.y, o.pose.z, o.pose.a, o.pose.b, o.pose.c)
        yield o.number, o.state, o.place, pose, bool(o.in_range), o.kind, o.colour, o.quality


def rows_of(objects: Iterable[Object]) -> list[list[float]]:
    """Returns, for each object whose pose is known: number, x, y, z, c in the world, taken, within the work range."""
    return [
        [number, *pose[:3], pose[5], int(state == TAKEN), int(in_range)]
        for number, state, _, pose, in_range, *_ in objects
        if pose[0] == pose[0]
    ]


class BeltObjectLog:
    """The objects on each belt over time."""

    def __init__(self) -> None:
        self._times: dict[str, list[float]] = {}
        self._rows: dict[str, list[list[list[float]]]] = {}

    def is_due(self, belt: str, time_s: float) -> bool:
        """Returns whether a sample is due at `time_s`."""
        times = self._times.get(belt)
        return not times or time_s - times[-1] >= 0.999 * LOOK_S

    def due_in(self, belt: str, time_s: float) -> float:
        """Returns the time [s] until a sample is due."""
        times = self._times.get(belt)
        return times[-1] + LOOK_S - time_s if times else 0.0

    def look(self, belt: str, time_s: float, objects: Iterable[Object]) -> None:
        """Stores the objects if a sample is due."""
        if not self.is_due(belt, time_s):
            return
        self._times.setdefault(belt, []).append(time_s)
        self._rows.setdefault(belt, []).append(rows_of(objects))

    def columns(self) -> dict[str, dict[str, Array]]:
        """Returns, for each belt, `time_s` of the samples, shape (n,); `rows` of all samples, shape (m, 7), columns as
        in `rows_of`; `first`, shape (n + 1,): sample i has the rows first[i] to first[i + 1] - 1."""
        return {
            belt: {
                "time_s": np.array(times),
                "first": np.cumsum([0, *map(len, self._rows[belt])]),
                "rows": np.array([row for rows in self._rows[belt] for row in rows], float).reshape(-1, COLUMNS),
            }
            for belt, times in self._times.items()
        }
