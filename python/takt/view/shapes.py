"""Shapes from the engine for the plan view: tracks, and routes over the free surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from takt import msgs

DECIMALS = 2  # of coordinates, in mm


def track(name: str, part: str, closed: bool, places: Any) -> dict[str, Any]:
    """Returns one track in the page's form. places: (n, 3), arc length, x and y relative to its part [mm]."""
    points = np.round(np.asarray(places, dtype=float), DECIMALS)
    return {"name": name, "part": part, "closed": closed, "points": points.ravel().tolist()}


class Newest:
    """The newest shape of each name. Unchanged ones are sent to a page only once."""

    def __init__(self) -> None:
        self.count = 0  # number of changes so far
        self._known: dict[str, tuple[int, dict[str, Any]]] = {}

    def put(self, new: dict[str, Any]) -> None:
        """Stores a shape. One with points that are not finite (a damaged message) is ignored."""
        name = new["name"]
        if not np.all(np.isfinite(new["points"])):
            return
        if name in self._known and self._known[name][1] == new:
            return
        self.count += 1
        self._known[name] = (self.count, new)

    def since(self, count: int) -> list[dict[str, Any]]:
        """Returns the shapes that changed after the first `count` changes."""
        return [new for changed, new in self._known.values() if changed > count]


class Shapes(Newest):
    """Shapes of tracks."""

    def __init__(self, parts: Sequence[str] = ()) -> None:
        super().__init__()
        self._parts = parts

    def take(self, message: msgs.track_shape) -> None:
        if not 0 <= message.part <= len(self._parts):  # damaged
            return
        part = self._parts[message.part - 1] if message.part else ""
        places = np.stack([message.position, message.x, message.y], axis=1) if message.count else np.empty((0, 3))
        self.put(track(message.name, part, bool(message.closed), places))


class Routes(Newest):
    """Routes of movers over the free surface."""

    def take(self, message: msgs.mover_route) -> None:
        points = np.round([message.x, message.y], DECIMALS).T.ravel().tolist()
        self.put({"name": message.name, "first": message.first, "points": points})
