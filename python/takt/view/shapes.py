"""The shapes of tracks as the engine says they are now, for the plan."""

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


class Shapes:
    """Newest shapes by name. What has not changed is told to a page once."""

    def __init__(self, parts: Sequence[str] = ()) -> None:
        self.count = 0  # of changes
        self._parts = parts
        self._known: dict[str, tuple[int, dict[str, Any]]] = {}

    def take(self, message: msgs.track_shape) -> None:
        part = self._parts[message.part - 1] if message.part else ""
        places = np.stack([message.position, message.x, message.y], axis=1) if message.count else np.empty((0, 3))
        new = track(message.name, part, bool(message.closed), places)
        if message.name in self._known and self._known[message.name][1] == new:
            return
        self.count += 1
        self._known[message.name] = (self.count, new)

    def since(self, count: int) -> list[dict[str, Any]]:
        """Those that changed after so many changes."""
        return [shape for changed, shape in self._known.values() if changed > count]
