"""The geometry of tracks for a session over LCM, computed from the machine file that the engine sends."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from takt import _core
from takt.errors import TaktError

if TYPE_CHECKING:
    from takt.session import Session
    from takt.track import Track

SAME = 1e-6  # mm


class RemoteTracks:
    """Computes the geometry of tracks as an engine in process does; positions in [mm]. The tracks must be unchanged
    from the machine file: methods raise TaktError for a track whose current length differs."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def at(self, track: Track, s: float) -> tuple[float, float, float, float]:
        """Returns x, y [mm], direction [deg], curvature [1/mm] at arc length `s` [mm]."""
        number = self._number(track)
        x, y, direction, curvature = self._layout.at(number, s)
        origin_x, origin_y = self._origin(number)
        return x + origin_x, y + origin_y, direction, curvature

    def closest_to(self, track: Track, x: float, y: float) -> float:
        """Returns the arc length [mm] of the closest point of the track."""
        number = self._number(track)
        origin_x, origin_y = self._origin(number)
        return self._layout.closest_to(number, x - origin_x, y - origin_y)

    def links(self, track: Track) -> tuple[list[int], list[int]]:
        """Returns the numbers, from 0, of the tracks before and after the track, with all parts at their commanded
        positions."""
        for other in self._session.tracks.values():
            self._number(other)
        self._layout.place_parts([part.commanded_index for part in self._session.parts.values()])
        number = self._number(track)
        return self._layout.before(number), self._layout.behind(number)

    @cached_property
    def _layout(self) -> _core.TrackLayout:
        return _core.TrackLayout(self._session.machine_text.encode(), "machine")

    def _number(self, track: Track) -> int:
        number = list(self._session.tracks).index(track.name)
        if abs(self._layout.length(number) - track.length) > SAME:
            raise TaktError(
                f"track {track.name}: it is {track.length:.6g} mm long, {self._layout.length(number):.6g} mm in the "
                "machine file: over LCM the geometry of tracks is known as the machine file has it"
            )
        return number

    def _origin(self, number: int) -> tuple[float, float]:
        part = self._layout.part(number)
        if part < 0:
            return 0.0, 0.0
        under = list(self._session.parts.values())[part]
        return under.x, under.y
