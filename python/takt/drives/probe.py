"""The touch probe of a drive (CiA 402, 0x60B8 to 0x60BD): the drive latches its position at an edge, and the axis is
told how long before the end of the cycle that was (AX-87)."""

from __future__ import annotations

from typing import Final

from takt.drives import objects as od
from takt.drives.scaling import signed

# Of the function (0x60B8) and the status (0x60B9); those of probe 2 are 8 bits further.
ENABLE_BIT: Final = 1 << 0
CONTINUOUS_BIT: Final = 1 << 1  # function: each edge is latched, not the first one alone
RISE_BIT: Final = 1 << 4  # function: the rising edge is looked for
FALL_BIT: Final = 1 << 5
RISE_STORED_BIT: Final = 1 << 1  # status
FALL_STORED_BIT: Final = 1 << 2


def latches(number: int) -> tuple[od.Object, od.Object]:
    """The objects with the positions of a probe, 1 or 2, at its last rising and falling edge."""
    return (od.PROBE_1_RISE, od.PROBE_1_FALL) if number == 1 else (od.PROBE_2_RISE, od.PROBE_2_FALL)


class _Edge:
    """Looked for, stored by the drive, taken from there, looked for again."""

    def __init__(self) -> None:
        self.armed = False  # what is stored before that is from an earlier time
        self.count = 1  # so that the engine goes by the edges from the first one on
        self.age_s = 0.0

    def take(self, latched: int | None, position: int, step: int, period_s: float) -> bool:
        """latched: position that the drive has stored; None: none. step: increments since `period_s` ago."""
        if latched is None:
            self.armed = True
            return False
        if not self.armed:
            return False
        self.armed = False
        self.count += 1
        self.age_s = max(0.0, signed(position - latched) / step * period_s) if step else 0.0
        return True


class ProbeLatch:
    """A touch probe of the drive.

    number: 1 or 2."""

    def __init__(self, number: int) -> None:
        self._shift = 8 * (number - 1)
        self.rise, self.fall = _Edge(), _Edge()
        self.wire = False  # as the last edge left it

    def forget(self) -> None:
        """The drive has started anew."""
        self.rise.armed = self.fall.armed = False

    @property
    def function(self) -> int:
        """What the drive is told (0x60B8)."""
        edges = (RISE_BIT if self.rise.armed else 0) | (FALL_BIT if self.fall.armed else 0)
        return (ENABLE_BIT | edges) << self._shift

    def stored(self, status: int, rise: int, fall: int) -> tuple[int | None, int | None]:
        """The positions that are stored, as the status (0x60B9) says."""
        bits = status >> self._shift
        return rise if bits & RISE_STORED_BIT else None, fall if bits & FALL_STORED_BIT else None

    def take(self, stored: tuple[int | None, int | None], position: int, step: int, period_s: float) -> None:
        """With the position of this cycle, and increments since the one `period_s` before."""
        rose = self.rise.take(stored[0], position, step, period_s)
        fell = self.fall.take(stored[1], position, step, period_s)
        if rose != fell:  # a short pulse leaves the wire as it was
            self.wire = rose
