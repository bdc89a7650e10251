"""What the engine says of shapes for the plan: of tracks, and of routes over the free surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from takt import msgs

DECIMALS = 2  # of places, in mm


def track(name: str, part: str, closed: bool, places: Any) -> dict[str, Any]:
    """One track as the page knows it. places: (n, 3), position along it, x and y, from where its part is; mm."""
    points = np.round(np.asarray(places, dtype=float), DECIMALS)
    return {"name": name, "part": part, "closed": closed, "points": points.ravel().tolist()}


class Newest:
    """The newest of each name. What has not changed is told to a page once."""

    def __init__(self) -> None:
        self.count = 0  # of changes
        self._known: dict[str, tuple[int, dict[str, Any]]] = {}

    def put(self, new: dict[str, Any]) -> None:
        """Rejects points that are no numbers: those of a damaged message."""
        name = new["name"]
        if not np.all(np.isfinite(new["points"])):
            return
        if name in self._known and self._known[name][1] == new:
            return
        self.count += 1
        self._known[name] = (self.count, new)

    def since(self, count: int) -> list[dict[str, Any]]:
        """Those that changed after so many changes."""
        return [new for changed, new in self._known.values() if changed > count]


class Shapes(Newest):
    """Of tracks."""

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
    """Of movers over the free surface."""

    def take(self, message: msgs.mover_route) -> None:
        points = np.round([message.x, message.y], DECIMALS).T.ravel().tolist()
        self.put({"name": message.name, "first": message.first, "points": points})
