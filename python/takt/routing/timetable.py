"""Expected times of a mover on a planned route over the free surface, from the plan and its present delay."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple


class Leg(NamedTuple):
    """One straight motion from rest to rest; times in s since the start of the plan."""

    departure_s: float
    arrival_s: float
    first: int  # the visit where it begins
    last: int


class Timetable:
    """The planned times of one mover, in s since the start of the plan, and the delay of its present leg.

    entries_s, left_s: by visit, the times at which the mover takes the place and gives it back.
    """

    def __init__(self, legs: Sequence[Leg], entries_s: Sequence[float], left_s: Sequence[float]) -> None:
        self.legs = legs
        self.entries_s, self.left_s = entries_s, left_s
        self.number = 0  # of the present leg, or at rest of the next one
        self.late_s: float | None = None  # delay of its start; None: not started; inf: unknown
        self._firsts = [leg.first for leg in legs]

    @property
    def leg(self) -> Leg | None:
        """The present leg, or at rest the next one; None after the last one."""
        return self.legs[self.number] if self.number < len(self.legs) else None

    @property
    def holds(self) -> bool:
        """Whether the present leg has started and its delay is known."""
        return self.late_s is not None and self.late_s < math.inf

    def disturbed(self) -> None:
        """Marks the delay of the present leg as unknown."""
        self.late_s = math.inf

    def passed(self, visit: int, *, rests: bool) -> None:
        """Updates the leg: the mover has passed the middle of the place of this visit, or rests there."""
        while (leg := self.leg) is not None and (visit > leg.last or (visit == leg.last and rests)):
            self.number += 1
            self.late_s = None if rests else math.inf

    def late(self, visit: int, now_s: float) -> float:
        """Returns the expected delay [s] of leaving the place of this visit; inf: unknown."""
        leg = self.leg
        if leg is None:
            return 0.0
        late = max(0.0, now_s - leg.departure_s) if self.late_s is None else self.late_s
        number = bisect_right(self._firsts, visit) - 1  # of the leg that leaves the place
        if number <= self.number:
            return late
        free_s = leg.arrival_s + late
        for one in self.legs[self.number + 1 : number]:
            free_s = max(one.departure_s, free_s) + one.arrival_s - one.departure_s
        return max(0.0, free_s - self.legs[number].departure_s)
