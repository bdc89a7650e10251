"""The touch probe of a drive (CiA 402, 0x60B8 to 0x60BD): the drive latches its position at an edge, and the axis
receives the age of the edge at the end of the cycle (AX-87)."""

from __future__ import annotations

from typing import Final

from takt.drives import objects as od
from takt.drives.scaling import signed

# Bits of the function (0x60B8) and the status (0x60B9); those of probe 2 are shifted by 8.
ENABLE_BIT: Final = 1 << 0
CONTINUOUS_BIT: Final = 1 << 1  # function: each edge is latched, not only the first one
RISE_BIT: Final = 1 << 4  # function: the rising edge is latched
FALL_BIT: Final = 1 << 5
RISE_STORED_BIT: Final = 1 << 1  # status
FALL_STORED_BIT: Final = 1 << 2


def latches(number: int) -> tuple[od.Object, od.Object]:
    """Returns the objects with the positions of a probe, 1 or 2, at its last rising and falling edge."""
    return (od.PROBE_1_RISE, od.PROBE_1_FALL) if number == 1 else (od.PROBE_2_RISE, od.PROBE_2_FALL)


class _Edge:
    """An edge: armed, latched by the drive, read, armed again."""

    def __init__(self) -> None:
        self.armed = False  # positions stored before that are old
        self.count = 1  # above 0, so that the engine uses the edges from the first one on
        self.age_s = 0.0

    def take(self, latched: int | None, position: int, step: int, period_s: float) -> bool:
        """Returns whether a new edge was read. latched: position that the drive has stored; None: none. step:
        increments in the last `period_s`."""
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
        self.wire = False  # level after the last edge

    def forget(self) -> None:
        """Disarms both edges: the drive has restarted."""
        self.rise.armed = self.fall.armed = False

    @property
    def function(self) -> int:
        """The touch probe function for the drive (0x60B8)."""
        edges = (RISE_BIT if self.rise.armed else 0) | (FALL_BIT if self.fall.armed else 0)
        return (ENABLE_BIT | edges) << self._shift

    def stored(self, status: int, rise: int, fall: int) -> tuple[int | None, int | None]:
        """Returns the positions at the rising and the falling edge; None where the status (0x60B9) says that none is
        stored."""
        bits = status >> self._shift
        return rise if bits & RISE_STORED_BIT else None, fall if bits & FALL_STORED_BIT else None

    def take(self, stored: tuple[int | None, int | None], position: int, step: int, period_s: float) -> None:
        """Updates the edges. position: of this cycle; step: increments since the position `period_s` before."""
        rose = self.rise.take(stored[0], position, step, period_s)
        fell = self.fall.take(stored[1], position, step, period_s)
        if rose != fell:  # a short pulse leaves the level unchanged
            self.wire = rose
