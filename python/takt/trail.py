"""Tracks one behind the other, along which a mover goes with its master."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import overload

from takt.track import Track


class TrackTrail(Sequence[str]):
    """Names of tracks, each of which starts where the one before it ends, each once. It lives here alone: commands take
    what is on it when they are given."""

    def __init__(self, tracks: Iterable[str | Track] = ()) -> None:
        self._names: list[str] = []
        for track in tracks:
            self.add_track(track)

    def add_track(self, track: str | Track) -> None:
        """At the end of the last one. Whether it starts there is found when a command uses the trail."""
        name = track if isinstance(track, str) else track.name
        if name in self._names:
            raise ValueError(f"{name} is on the trail already")
        self._names.append(name)

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
