"""One track of a session: a path in the plane along which movers travel."""

from __future__ import annotations

import math
from dataclasses import dataclass

from takt._commands import TrackCommands, TrackOutputs
from takt.component import Component
from takt.errors import TaktError


@dataclass(frozen=True)
class TrackPosition:
    """Position, direction and curvature of a track at an arc length."""

    x: float  # mm
    y: float  # mm
    direction: float  # deg, counterclockwise from x; unwrapped along the track
    curvature: float  # 1/mm, positive where the track bends to the left


class Track(Component, TrackCommands, TrackOutputs):
    """A track. Over LCM its geometry is read from the machine file; methods that need it raise TaktError there if the
    track's length has been changed at run time."""

    KIND = "track"

    def __repr__(self) -> str:
        return f"<Track {self.name}: {self.state.value}, {self.length:.6g} mm>"

    def position_at(self, s: float) -> TrackPosition:
        """Returns position, direction and curvature at arc length `s` [mm]. On a closed loop `s` wraps around, on an
        open track it is clamped to the ends. Raises TaktError if `s` is not finite or the track has no length yet."""
        self._check_length()
        if not math.isfinite(s):
            raise TaktError(f"track {self.name}: {s} mm is no place on it")
        return TrackPosition(*self.session._track_at(self, s))

    def arc_length_closest_to(self, x: float, y: float) -> float:
        """Returns the arc length [mm] of the point of the track closest to (x, y) [mm]. Raises TaktError if x or y is
        not finite or the track has no length yet."""
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
