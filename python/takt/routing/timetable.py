"""When a mover on a planned route over the free surface is expected to leave its places, as late as it is by now."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple


class Leg(NamedTuple):
    """One straight motion from rest to rest, s by the clock of the plan."""

    departure_s: float
    arrival_s: float
    first: int  # the visit where it begins
    last: int


class Timetable:
    """Times by the clock of a plan.

    entries_s, left_s: by visit, when it takes the place, and has left it.
    """

    def __init__(self, legs: Sequence[Leg], entries_s: Sequence[float], left_s: Sequence[float]) -> None:
        self.legs = legs
        self.entries_s, self.left_s = entries_s, left_s
        self.number = 0  # of the leg that it is on, or that is the next one
        self.late_s: float | None = None  # so much later than planned it began; None: it has not begun
        self._firsts = [leg.first for leg in legs]

    @property
    def leg(self) -> Leg | None:
        """The one that it is on, or the next one; None: it is there."""
        return self.legs[self.number] if self.number < len(self.legs) else None

    @property
    def holds(self) -> bool:
        """Its leg goes as planned, be it late."""
        return self.late_s is not None and self.late_s < math.inf

    def disturbed(self) -> None:
        """Nobody knows any more when this leg ends."""
        self.late_s = math.inf

    def passed(self, visit: int, *, rests: bool) -> None:
        """It has passed the middle of this place, or rests there."""
        while (leg := self.leg) is not None and (visit > leg.last or (visit == leg.last and rests)):
            self.number += 1
            self.late_s = None if rests else math.inf

    def late(self, visit: int, now_s: float) -> float:
        """How much later than planned it is expected to leave this place, s; infinite: nobody knows."""
        leg = self.leg
        if leg is None:
            return 0.0
        late = max(0.0, now_s - leg.departure_s) if self.late_s is None else self.late_s
        number = bisect_right(self._firsts, visit) - 1  # of the leg on which it leaves the place
        if number <= self.number:
            return late
        free_s = leg.arrival_s + late
        for one in self.legs[self.number + 1 : number]:
            free_s = max(one.departure_s, free_s) + one.arrival_s - one.departure_s
        return max(0.0, free_s - self.legs[number].departure_s)
