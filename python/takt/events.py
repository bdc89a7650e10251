"""Events of LCM logs, also of damaged files: only damaged events are lost.

The format is LCM's (lcm-proj.github.io, "LCM log file format"); numbers are big-endian:

    sync word  event number  time [us]  length of the channel  length of the data  channel  data
    4 bytes    8             8          4                      4

An event is whole if it ends at or before the next sync word behind its own, or at the end of the file. Its data may
contain a sync word if the event ends at another one, unless a whole event begins at the inner word: then its length is
wrong and by chance covers the following events. An event with a wrong length or missing bytes is skipped, and reading
resumes at the next sync word. Bytes between the end of an event and the next sync word are skipped. LCM's own reader
trusts the lengths that it finds, crashes on some, and skips the events after a wrong one.
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
CHANNEL = 1000  # bytes of a channel's name, more than LCM allows
BEGINNING = 1 << 20  # bytes searched for a sync word, in case the beginning of a log is damaged
REPORT_EVERY = 1024  # events between two reports of progress

Progress = Callable[[float], None]


class LogError(TaktError, ValueError):
    """A file is not an LCM log, or lacks the requested content."""


class Event(NamedTuple):
    """One logged message."""

    utime: int  # us, wall clock
    channel: str
    data: bytes


class EventLog:
    """The events of a log in the order of the file. After iterating, `left_over` is the number of skipped bytes."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Raises LogError if the file cannot be read or is not a log."""
        self.path = Path(path)
        self.left_over = 0
        try:
            if not is_log(self.path):
                empty = self.path.stat().st_size == 0
                raise LogError(f"{self.path}: {'is empty' if empty else 'is not an LCM log'}")
        except OSError as error:
            raise LogError(f"{self.path}: cannot be read: {error.strerror}") from None

    def events(self, progress: Progress | None = None) -> Iterator[Event]:
        """Yields every whole event. `progress` is called with the progress, 0 to 1."""
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
    """Returns whether a file has the sync word of a log in its first 1 MiB."""
    with path.open("rb") as file:
        return SYNC in file.read(BEGINNING)


def _end_of(text: bytes, at: int) -> int | None:
    """Returns the end of the event that begins at `at`, by its lengths; None if these are impossible."""
    if at + HEADER.size > len(text):
        return None
    _, _, _, channel, data = HEADER.unpack_from(text, at)
    end = at + HEADER.size + channel + data
    return end if 0 < channel < CHANNEL and end <= len(text) else None


def _is_exact(text: bytes, end: int | None) -> bool:
    """Returns whether an event with this end is followed by the next event or the end of the file."""
    return end is not None and (end == len(text) or text.startswith(SYNC, end))


def _next_sync(text: bytes, start: int) -> int:
    """Returns the position of the next sync word; the end of the file if there is none."""
    found = text.find(SYNC, start)
    return found if found >= 0 else len(text)


def _event(text: bytes, at: int, end: int) -> Event:
    _, _, utime, channel, _ = HEADER.unpack_from(text, at)
    data = at + HEADER.size + channel
    return Event(utime, text[at + HEADER.size : data].decode("utf-8", "replace"), text[data:end])
