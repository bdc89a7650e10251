"""The cycle in phase with distributed clocks: the position of the frames between two SYNC0, and how much later the
engine should begin its cycles so that the frames pass in the middle (AX-87, EN-26).

The mean is that of angles, as a phase wraps: a frame a little late and one a little early are not a cycle apart.
"""

from __future__ import annotations

import cmath
import math
from collections import deque
from typing import Final

SMOOTHED_CYCLES: Final = 64  # averages the jitter of the host
LOCKED: Final = 0.5  # length of the mean of all phases; 1: constant phase, 0: uniformly distributed


class Phase:
    """Phase of frames against SYNC0, which occurs half a period after the whole periods of the slaves' clock."""

    def __init__(self, period_s: float) -> None:
        self._period_s, self._period_ns = period_s, round(1e9 * period_s)
        self._mean = 0j
        self._seen: deque[float] = deque(maxlen=200_000)  # s from the middle between two SYNC0

    def take(self, clock_ns: int) -> float:
        """Takes the time [ns] of this cycle's frame by the clock of the slaves. Returns how much later [s] the cycles
        should begin."""
        angle = 2 * math.pi * (clock_ns % self._period_ns) / self._period_ns
        sample = cmath.exp(1j * angle)
        self._seen.append(cmath.phase(sample) / (2 * math.pi) * self._period_s)
        self._mean = sample if self._mean == 0 else self._mean + (sample - self._mean) / SMOOTHED_CYCLES
        return -cmath.phase(self._mean) / (2 * math.pi) * self._period_s

    @property
    def locked(self) -> bool:
        """The phase stayed constant over the second half of the frames."""
        second = self._second_half()
        mean = sum(cmath.exp(2j * math.pi * each / self._period_s) for each in second)
        return len(second) > 0 and abs(mean) / len(second) > LOCKED

    def text(self) -> str:
        """Returns "SYNC0 comes 0.500 ms after a frame (1 % below 0.412, 1 % above 0.534)"."""
        gaps = sorted(1000 * (self._period_s / 2 - each) for each in self._second_half())
        low, middle, high = (gaps[int(q * (len(gaps) - 1))] for q in (0.01, 0.5, 0.99))
        return f"SYNC0 comes {middle:.3f} ms after a frame (1 % below {low:.3f}, 1 % above {high:.3f})"

    def _second_half(self) -> list[float]:
        seen = list(self._seen)
        return seen[len(seen) // 2 :]
