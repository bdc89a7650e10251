"""Events of LCM logs, whatever has become of the file: what is damaged costs itself alone.

The format is LCM's (lcm-proj.github.io, "LCM log file format"); numbers are big-endian:

    sync word  event number  time [us]  length of the channel  length of the data  channel  data
    4 bytes    8             8          4                      4

An event is whole if it ends at or before the next sync word behind its own, or at the end of the file. Its data may
hold a sync word if it ends at another one, unless a whole event begins at that word: then its length is wrong by
chance by just the events behind it. An event whose length is wrong, or of which bytes are missing, is left out, and
reading goes on at the next sync word. Of an event that ends before the next sync word, what stands between is left
out. LCM's own reader believes the lengths that it finds, crashes at some, and skips what follows a wrong one.
"""

from __future__ import annotations

import itertools
import os
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from takt.errors import TaktError

SYNC = b"\xed\xa1\xda\x01"
HEADER = struct.Struct(">4sqqII")
CHANNEL = 1000  # bytes of a channel's name, of which LCM allows fewer
BEGINNING = 1 << 20  # bytes of a file with the sync word of an event, if it is a log whose beginning is damaged
REPORT_EVERY = 1024  # events between two reports of progress

Progress = Callable[[float], None]


class LogError(TaktError, ValueError):
    """A file is no LCM log, or has not in it what is wanted."""


class Event(NamedTuple):
    """One message as it was logged."""

    utime: int  # us, wall clock
    channel: str
    data: bytes


class EventLog:
    """The events of a log in the order of the file. After iterating, `left_over` says how many bytes are none."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Raises LogError where the file cannot be read, or is no log."""
        self.path = Path(path)
        self.left_over = 0
        try:
            if not is_log(self.path):
                empty = self.path.stat().st_size == 0
                raise LogError(f"{self.path}: {'is empty' if empty else 'is not an LCM log'}")
        except OSError as error:
            raise LogError(f"{self.path}: cannot be read: {error.strerror}") from None

    def events(self, progress: Progress | None = None) -> Iterator[Event]:
        """Every event that is whole."""
        text = self.path.read_bytes()
        size, at = len(text), _next_sync(text, 0)
        self.left_over = at
        for count in itertools.count(1):
            if at >= size:
                break
            end, following = _end_of(text, at), _next_sync(text, at + len(SYNC))
            if end is not None and _is_exact(text, end) and not _is_exact(text, _end_of(text, following)):
                following = end
            if end is not None and end <= following:
                yield _event(text, at, end)
                self.left_over += following - end
            else:
                self.left_over += following - at
            at = following
            if progress is not None and count % REPORT_EVERY == 0:
                progress(at / size)
        if progress is not None:
            progress(1.0)


def is_log(path: Path) -> bool:
    """Whether a file begins like a log, or at least has a sync word near its beginning."""
    with path.open("rb") as file:
        return SYNC in file.read(BEGINNING)


def _end_of(text: bytes, at: int) -> int | None:
    """Where the event ends that begins there; None: it says that it ends where none can."""
    if at + HEADER.size > len(text):
        return None
    _, _, _, channel, data = HEADER.unpack_from(text, at)
    end = at + HEADER.size + channel + data
    return end if 0 < channel < CHANNEL and end <= len(text) else None


def _is_exact(text: bytes, end: int | None) -> bool:
    """Whether the next event, or the end of the file, is at the end that an event says."""
    return end is not None and (end == len(text) or text.startswith(SYNC, end))


def _next_sync(text: bytes, start: int) -> int:
    """Where the next event may begin; the end of the file: nowhere."""
    found = text.find(SYNC, start)
    return found if found >= 0 else len(text)


def _event(text: bytes, at: int, end: int) -> Event:
    _, _, utime, channel, _ = HEADER.unpack_from(text, at)
    data = at + HEADER.size + channel
    return Event(utime, text[at + HEADER.size : data].decode("utf-8", "replace"), text[data:end])
