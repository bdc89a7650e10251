"""One track of a session: a way in the plane along which movers go."""

from __future__ import annotations

import math
from dataclasses import dataclass

from takt._commands import TrackCommands, TrackOutputs
from takt.component import Component
from takt.errors import TaktError


@dataclass(frozen=True)
class TrackPosition:
    """Where a track leads, and how it runs there."""

    x: float  # mm
    y: float  # mm
    direction: float  # deg, counterclockwise from x; counts on along the track
    curvature: float  # 1/mm, above 0 where the track bends to the left


class Track(Component, TrackCommands, TrackOutputs):
    """A track. Over LCM its geometry is that of the machine file; one that was changed while the machine runs is
    refused there."""

    KIND = "track"

    def __repr__(self) -> str:
        return f"<Track {self.name}: {self.state.value}, {self.length:.6g} mm>"

    def position_at(self, s: float) -> TrackPosition:
        """The place so many mm along the track. A closed loop goes round, an open track ends at its ends."""
        self._check_length()
        if not math.isfinite(s):
            raise TaktError(f"track {self.name}: {s} mm is no place on it")
        return TrackPosition(*self.session._track_at(self, s))

    def arc_length_closest_to(self, x: float, y: float) -> float:
        """mm along the track where it is nearest to a place."""
        self._check_length()
        if not (math.isfinite(x) and math.isfinite(y)):
            raise TaktError(f"track {self.name}: ({x}, {y}) is no place in the plane")
        return self.session._track_closest_to(self, x, y)

    @property
    def previous(self) -> list[Track]:
        """Tracks that end where this one starts."""
        return self._tracks(0)

    @property
    def subsequent(self) -> list[Track]:
        """Tracks that start where this one ends."""
        return self._tracks(1)

    def _tracks(self, which: int) -> list[Track]:
        tracks = list(self.session.tracks.values())
        return [tracks[i] for i in self.session._track_links(self)[which]]

    def _check_length(self) -> None:
        if not self.length > 0:
            raise TaktError(f"track {self.name} has no length yet")
