"""The last values of the signals of one component, in bounded memory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
CAPACITY = 1 << 15  # rows: half a minute at 1 kHz


class Piece(NamedTuple):
    """Rows that a reader has not read yet."""

    cursor: int  # start of the next read
    skipped: int  # rows that were overwritten before they were read
    cycles: Floats
    columns: Floats  # (fields, rows)


class Ring:
    """Rows are counted from the first one ever written; readers store their own position."""

    def __init__(self, fields: Sequence[str], capacity: int = CAPACITY) -> None:
        self.fields = tuple(fields)
        self.written = 0
        self._cycles = np.zeros(capacity)
        self._columns = np.full((len(self.fields), capacity), np.nan)

    @property
    def capacity(self) -> int:
        return len(self._cycles)

    @property
    def first(self) -> int:
        """Number of the oldest row that is kept."""
        return max(0, self.written - self.capacity)

    def append(self, cycles: npt.NDArray[np.generic], columns: npt.NDArray[np.generic]) -> None:
        """Appends rows; `columns` has shape (fields, rows)."""
        count = len(cycles)
        kept = min(count, self.capacity)
        at = np.arange(self.written + count - kept, self.written + count) % self.capacity
        self._cycles[at] = cycles[count - kept :]
        self._columns[:, at] = columns[:, count - kept :]
        self.written += count

    def since(self, cursor: int, fields: Sequence[str], most: int) -> Piece:
        """Returns the rows from `cursor` on, at most `most`, with these fields."""
        begin = min(max(cursor, self.first), self.written)
        end = min(self.written, begin + most)
        at = np.arange(begin, end) % self.capacity
        which = [self.fields.index(field) for field in fields]
        return Piece(
            end, max(0, begin - cursor), self._cycles[at], self._columns[np.array(which, dtype=np.intp)[:, None], at]
        )

    def after(self, cycle: float) -> int:
        """Returns the number of the first row with a later cycle; `written` if there is none."""
        at = np.arange(self.first, self.written) % self.capacity
        return self.first + int(np.searchsorted(self._cycles[at], cycle, side="right"))

    def with_fields(self, fields: Sequence[str]) -> Ring:
        """Returns the same rows with other fields; values that were not kept are NaN."""
        ring = Ring(fields, self.capacity)
        ring.written = self.written
        ring._cycles[:] = self._cycles
        for i, field in enumerate(ring.fields):
            if field in self.fields:
                ring._columns[i] = self._columns[self.fields.index(field)]
        return ring
