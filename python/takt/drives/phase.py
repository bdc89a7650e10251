"""The cycle in phase with distributed clocks: where between two SYNC0 the frames pass the slaves, and how much later
the engine ought to begin its cycles so that they pass in the middle (AX-87, EN-26).

The mean is that of angles, as a phase has no end: a frame a little late and one a little early are not a cycle apart.
"""

from __future__ import annotations

import cmath
import math
from collections import deque
from typing import Final

SMOOTHED_CYCLES: Final = 64  # frames come as the host lets them
LOCKED: Final = 0.5  # length of the mean of all phases; 1: always the same one, 0: all as often


class Phase:
    """Of frames against SYNC0, which comes half a period after the whole periods of the slaves' clock."""

    def __init__(self, period_s: float) -> None:
        self._period_s, self._period_ns = period_s, round(1e9 * period_s)
        self._mean = 0j
        self._seen: deque[float] = deque(maxlen=200_000)  # s from the middle between two SYNC0

    def take(self, clock_ns: int) -> float:
        """Of the frame of this cycle, by the clock of the slaves: how much later [s] the cycles ought to begin."""
        angle = 2 * math.pi * (clock_ns % self._period_ns) / self._period_ns
        sample = cmath.exp(1j * angle)
        self._seen.append(cmath.phase(sample) / (2 * math.pi) * self._period_s)
        self._mean = sample if self._mean == 0 else self._mean + (sample - self._mean) / SMOOTHED_CYCLES
        return -cmath.phase(self._mean) / (2 * math.pi) * self._period_s

    @property
    def locked(self) -> bool:
        """Over the second half of the frames their phase stayed where it is."""
        second = self._second_half()
        mean = sum(cmath.exp(2j * math.pi * each / self._period_s) for each in second)
        return len(second) > 0 and abs(mean) / len(second) > LOCKED

    def text(self) -> str:
        """ "SYNC0 comes 0.500 ms after a frame (1 % below 0.412, 1 % above 0.534)"."""
        gaps = sorted(1000 * (self._period_s / 2 - each) for each in self._second_half())
        low, middle, high = (gaps[int(q * (len(gaps) - 1))] for q in (0.01, 0.5, 0.99))
        return f"SYNC0 comes {middle:.3f} ms after a frame (1 % below {low:.3f}, 1 % above {high:.3f})"

    def _second_half(self) -> list[float]:
        seen = list(self._seen)
        return seen[len(seen) // 2 :]
