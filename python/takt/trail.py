"""Trails: consecutive tracks along which a mover follows its master."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, overload

from takt.errors import TaktError
from takt.track import Track

if TYPE_CHECKING:
    from takt.session import Session


@dataclass(frozen=True)
class TrailInformation:
    """The geometry of a trail in a session."""

    length: float  # mm, of all tracks together
    begins: Mapping[str, float]  # by track: mm from the start of the trail to the start of the track

    def position(self, track: str | Track, s: float) -> float:
        """Returns the arc length [mm] from the start of the trail of arc length `s` [mm] on one of its tracks. Raises
        TaktError if the track is not on the trail."""
        name = track if isinstance(track, str) else track.name
        if name not in self.begins:
            raise TaktError(f"track {name} is not on the trail {', '.join(self.begins)}")
        return self.begins[name] + s


class TrackTrail(Sequence[str]):
    """Names of distinct tracks, each of which starts where the one before it ends. The engine does not hold trails: a
    command receives the tracks that are on it when it is given."""

    def __init__(self, tracks: Iterable[str | Track] = ()) -> None:
        self._names: list[str] = []
        if isinstance(tracks, str):
            raise TypeError(f"tracks is a list of tracks, not the text {tracks!r}")
        for track in tracks:
            self.add_track(track)

    def add_track(self, track: str | Track) -> None:
        """Appends a track. Whether it starts at the end of the last one is checked when the trail is used. Raises
        ValueError if the track is on the trail already."""
        name = track if isinstance(track, str) else track.name
        if name in self._names:
            raise ValueError(f"{name} is on the trail already")
        self._names.append(name)

    def information(self, session: Session) -> TrailInformation:
        """Returns the length of the trail and the arc lengths at which its tracks begin. Raises TaktError if a track
        has no geometry, or does not start where the one before it ends."""
        begins: dict[str, float] = {}
        length, before = 0.0, None
        for name in self._names:
            track = session.track(name)
            if not track.length > 0:
                raise TaktError(f"track {name} of the trail has no geometry")
            if before is not None and name not in [behind.name for behind in before.subsequent]:
                raise TaktError(f"track {name} does not start where {before.name} ends: they make no trail")
            begins[name] = length
            length += track.length
            before = track
        return TrailInformation(length, begins)

    def clear(self) -> None:
        self._names.clear()

    def __len__(self) -> int:
        return len(self._names)

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: int | slice) -> str | list[str]:
        return self._names[index]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __repr__(self) -> str:
        return f"<TrackTrail {', '.join(self._names) or 'empty'}>"
