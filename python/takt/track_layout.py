"""The tracks of a machine file as the engine makes them at loading: lengths, curvature, links, collision ranges."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from takt import _core
from takt.engine import read_machine
from takt.names import shown

Array = npt.NDArray[np.float64]
STEP = 2.0  # mm between points of a curve, at most
# Sections missing in a file with tracks only; appended at its end, so that line numbers do not change.
LACKING = {"name": "name: tracks", "axes": "axes: []"}


@dataclass(frozen=True)
class Points:
    """Points along a track, in order."""

    s: Array  # mm
    x: Array
    y: Array
    direction: Array  # deg
    curvature: Array  # 1/mm, positive to the left
    given: npt.NDArray[np.bool_]  # False: on a transition


@dataclass(frozen=True)
class LaidTrack:
    name: str
    length: float  # mm
    closed: bool
    smallest_radius: float  # mm; infinite if it is straight
    previous: tuple[str, ...]  # tracks that end where it starts
    subsequent: tuple[str, ...]  # tracks that start where it ends
    range_at_start: float  # mm, collision ranges
    range_at_end: float
    traffic_ranges: tuple[float, float]  # mm, at start and end: the ranges that movers keep
    leads: tuple[float, float]  # mm, at start and end: the largest lead against movers on adjacent tracks
    points: Points


class TrackLayout:
    """All tracks of a machine file, or of a file with only the section `tracks`."""

    def __init__(self, file: str | os.PathLike[str], name: str | None = None) -> None:
        text, found = read_machine(file)
        whole = text.lstrip().startswith(b"{")  # JSON, as of a machine given as a dict
        for key, line in LACKING.items():
            if not whole and not re.search(rf"^{key}\s*:".encode(), text, re.MULTILINE):
                text += f"\n{line}".encode()
        self._core = _core.TrackLayout(text + b"\n", shown(name or found))

    def place_parts(self, indices: Sequence[int]) -> None:
        """Links the tracks as with each part at this position, by its index from 1. Requires: `tracks` was not read."""
        self._core.place_parts(list(indices))

    def clear_gap(self, width: float, height: float, turned: float, least: float) -> float:
        """Returns the least gap [mm] from `least` on at which two movers of this size, both at the angle `turned`
        [deg], clear each other everywhere on each track."""
        for i in range(len(self._core.names)):
            least = self._core.clear_gap(i, width, height, turned, least)
        return least

    @cached_property
    def tracks(self) -> tuple[LaidTrack, ...]:
        """The tracks in the order of the file."""
        return tuple(self._track(i) for i in range(len(self._core.names)))

    def _track(self, i: int) -> LaidTrack:
        names = self._core.names
        at_start, at_end = self._core.collision_ranges(i)
        s, x, y, direction, curvature, given = np.asarray(self._core.points(i, STEP)).T
        return LaidTrack(
            names[i],
            self._core.length(i),
            self._core.closed(i),
            self._core.smallest_radius(i),
            tuple(names[k] for k in self._core.before(i)),
            tuple(names[k] for k in self._core.behind(i)),
            at_start,
            at_end,
            self._core.traffic_ranges(i),
            self._core.leads(i),
            Points(s, x, y, direction, curvature, given > 0),
        )
