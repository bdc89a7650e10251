"""Arrangements of movers on streets, reduced to what decides which mover can pass, and the search for an order of hops
that brings all movers to their targets.

Movers on one street cannot overtake, so their order matters and their positions do not. An arrangement is a row of
movers for each street, and the movers that rest singly within the zones of nodes. A hop takes one mover from a row to
the next, or to or from a position within a zone. Between two hops a row may be shifted along its street freely.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from takt.routing.streets import MARGIN, Street, Streets, Sweep

HOP = 100.0  # [mm] cost of a hop, in addition to its length


class Place(NamedTuple):
    street: int
    s: float  # mm


class Arrangement(NamedTuple):
    rows: tuple[tuple[int, ...], ...]  # by street: movers, the foremost first
    apart: tuple[tuple[int, Place], ...]  # movers that rest within zones, by number


@dataclass(frozen=True)
class Hop:
    mover: int
    sweep: Sweep  # the stretch that the mover needs for itself meanwhile
    backward: bool  # False: to the end of the sweep; True: from its end to its start
    to_row: bool  # ends in the row of the last street; else at the end of the sweep

    @property
    def street(self) -> int:
        """The street on which the hop ends."""
        return self.sweep.streets[-1]

    @property
    def place(self) -> float:
        """The position at which the hop ends [mm along its street]."""
        return self.sweep.start if self.backward else self.sweep.end

    def comes_back(self, street: Street) -> bool:
        """True if the hop leads backward towards the row of this street, from ahead of it: the row has to make room."""
        return self.backward and self.street == street.index and (self.to_row or self.place > street.last)


@dataclass(frozen=True)
class Task:
    """Starts and targets of the movers, which are numbered from 0."""

    streets: Streets
    starts: tuple[Place, ...]
    targets: Mapping[int, Place]
    fixed: frozenset[int]  # movers that may not be moved

    @cached_property
    def start(self) -> Arrangement:
        rows: list[list[int]] = [[] for _ in self.streets.all]
        apart = []
        for i, place in enumerate(self.starts):
            if self.streets[place.street].in_row(place.s):
                rows[place.street].append(i)
            elif not self.streets[place.street].closed:
                apart.append((i, place))
        for row in rows:
            row.sort(key=lambda i: -self.starts[i].s)
        return Arrangement(tuple(tuple(row) for row in rows), tuple(apart))

    @cached_property
    def closed_off(self) -> frozenset[int]:
        """Streets that cannot be passed: a fixed mover rests there."""
        return frozenset(self.starts[i].street for i in self.fixed)

    @cached_property
    def ways(self) -> dict[int, tuple[list[float], list[int]]]:
        """By street: distances and next streets towards it, as Streets.way_to, not past fixed movers."""
        shut = set().union(*(self._blocked_by(self.starts[i]) for i in self.fixed))
        return {street.index: self.streets.way_to(street.index, self.closed_off, shut) for street in self.streets.all}

    def aim(self, mover: int) -> Place | None:
        """Returns the final position of a mover: that of its start if it is fixed, else its target, None if any."""
        return self.starts[mover] if mover in self.fixed else self.targets.get(mover)

    # --- possible hops ---

    def bounds(self, street: Street, a: Arrangement, without: int = -1) -> tuple[float, float]:
        """Returns the range [mm] available to the row of a street, given the movers in its zones except `without`."""
        low, high = street.first, street.last
        for i, place in a.apart:
            if place.street == street.index and i != without:
                if place.s < street.first:
                    low = max(low, place.s + self.streets.gap)
                else:
                    high = min(high, place.s - self.streets.gap)
        return low, high

    def fits(self, street: Street, row: Sequence[int], a: Arrangement, aims: bool = False) -> bool:
        """True if there is room for this row; `aims`: with all its movers at their targets."""
        low, place = self.bounds(street, a)
        last = math.inf
        for i in row:
            aim = self.targets.get(i) if aims else None
            if i in self.fixed:
                aim = self.starts[i]
            if aim is not None:
                if aim.street != street.index or aim.s > place + MARGIN:
                    return False
                place = aim.s
            last = place
            place -= self.streets.gap
        return last >= low - MARGIN

    def is_free(self, sweep: Sweep, mover: int, a: Arrangement) -> bool:
        return not any(
            i != mover and self.streets.meet(sweep, Sweep((place.street,), place.s, place.s)) for i, place in a.apart
        )

    def after(self, hop: Hop, a: Arrangement) -> Arrangement | None:
        """Returns the arrangement after this hop; None if the hop is not possible."""
        if not self.is_free(hop.sweep, hop.mover, a):
            return None
        i, street = hop.mover, self.streets[hop.street]
        rows, apart = list(a.rows), [one for one in a.apart if one[0] != i]
        if len(apart) == len(a.apart):
            come_from = hop.sweep.streets[0]
            row = rows[come_from]
            front = len(hop.sweep.streets) > 1 or hop.place > street.last
            if not row or row[0 if front else -1] != i:
                return None
            rows[come_from] = row[1:] if front else row[:-1]
        elif self._passes_a_row(hop, a):
            return None
        if hop.to_row:
            front = hop.backward
            rows[street.index] = (i, *rows[street.index]) if front else (*rows[street.index], i)
        else:
            apart.append((i, Place(street.index, hop.place)))
            apart.sort()
        after = Arrangement(tuple(rows), tuple(apart))
        return after if self.fits(street, rows[street.index], after) else None

    def _passes_a_row(self, hop: Hop, a: Arrangement) -> bool:
        """Whether the hop leads from the zone at one end of a street past the movers in its row."""
        here = next(place for i, place in a.apart if i == hop.mover)
        street = self.streets[here.street]
        if not street.has_room or not a.rows[here.street]:
            return False
        if len(hop.sweep.streets) > 1:
            return here.s < street.first
        return not hop.to_row and (here.s < street.first) != (hop.place < street.first)

    def hops(self, a: Arrangement) -> Iterator[Hop]:
        """Yields the hops worth trying; `after` decides which are possible."""
        for street in self.streets.all:
            row = a.rows[street.index]
            if not row or street.closed:
                continue
            if row[0] not in self.fixed:
                yield from self._onward(row[0], street, street.last)
            for i, backward in ((row[0], False), (row[-1], True)):
                aim = self.targets.get(i)
                if i in self.fixed or aim is None or aim.street != street.index or street.in_row(aim.s):
                    continue
                if backward and aim.s < street.first:
                    yield Hop(i, Sweep((street.index,), aim.s, street.first), True, False)
                elif not backward and aim.s > street.last:
                    yield Hop(i, Sweep((street.index,), street.last, aim.s), False, False)
        for i, (index, s) in a.apart:
            if i in self.fixed:
                continue
            street = self.streets[index]
            aim = self.targets.get(i)
            if not street.has_room or s > street.last:
                yield from self._onward(i, street, s)
            if (
                aim is not None
                and aim.street == index
                and aim.s != s
                and (not street.has_room or (not street.in_row(aim.s) and (aim.s < street.first) == (s < street.first)))
            ):
                yield Hop(i, Sweep((index,), min(s, aim.s), max(s, aim.s)), aim.s < s, False)
            if not street.has_room:
                continue
            if s < street.first:
                yield Hop(i, Sweep((index,), s, street.first), False, True)
            else:
                yield Hop(i, Sweep((index,), street.last, s), True, True)

    def _onward(self, i: int, street: Street, s: float) -> Iterator[Hop]:
        aim = self.targets.get(i)
        for way in self.streets.passages[street.index]:
            last = self.streets[way[-1]]
            if last.has_room:
                yield Hop(i, Sweep(way, s, last.first), False, True)
            if aim is not None and aim.street == last.index and (not last.has_room or aim.s < last.first):
                yield Hop(i, Sweep(way, s, aim.s), False, False)

    # --- cost and remaining distance ---

    def cost(self, hop: Hop) -> float:
        """Returns the cost [mm] of a hop: HOP, the length of its sweep, and that of the row that it enters."""
        street = self.streets[hop.street]
        return HOP + self.streets.length(hop.sweep) + (street.last - street.first if hop.to_row else 0.0)

    def is_done(self, a: Arrangement) -> bool:
        return (
            all(
                self.fits(street, a.rows[street.index], a, aims=True)
                for street in self.streets.all
                if not street.closed
            )
            and all(self.targets.get(i, place) == place for i, place in a.apart)
            and not self._missing(a)
        )

    def _missing(self, a: Arrangement) -> bool:
        """True if a mover is in a row although its target is on another street, or outside the row of this one."""
        for street in self.streets.all:
            for i in a.rows[street.index]:
                aim = self.targets.get(i)
                if aim is not None and not street.closed and (aim.street != street.index or not street.in_row(aim.s)):
                    return True
        return False

    def far(self, a: Arrangement) -> float:
        """Returns an estimate [mm] of the distance left for all movers together; infinite if there is no solution."""
        total = 0.0
        needed: set[tuple[int, int]] = set()  # passages from street to street that a mover has to make, not its last
        last: set[tuple[int, Place]] = set()  # last passages, from a street to a target
        arrive: dict[int, float] = {}  # by street: the foremost target of a mover that has yet to arrive [mm]
        stay: list[tuple[int, Place]] = []  # movers that may stay on their street, and their positions

        def go(here: int, aim: Place | None) -> float:
            if aim is not None:
                arrive[aim.street] = max(aim.s, arrive.get(aim.street, 0.0))
            return self._way(here, aim, needed, last)

        for street in self.streets.all:
            if street.closed:
                continue
            leaves, most = False, -math.inf
            row = a.rows[street.index]
            crowded = row and not self.fits(street, row, a, aims=True)
            for i in reversed(row):
                aim = self.aim(i)
                # A mover without a target blocks those behind it from targets at the front of the street.
                leaves |= bool(crowded) and aim is None and most > street.last - self.streets.gap
                if not leaves and (aim is None or (aim.street == street.index and aim.s > most)):
                    stay.append((i, aim or Place(street.index, street.last)))
                    if aim is not None:
                        most = aim.s
                        total += 0.0 if street.in_row(aim.s) else 1.0
                    continue
                leaves = True
                if i in self.fixed:
                    return math.inf
                total += go(street.index, aim)
        for i, place in a.apart:
            aim = self.aim(i)
            if aim is None or aim == place:
                stay.append((i, place))
            elif aim.street == place.street:
                total += 2.0
            else:
                total += go(place.street, aim)
        passed = {there for _, there in needed}
        for i, place in stay:
            if i in self.fixed:
                continue
            in_the_way = place.street in passed or arrive.get(place.street, -1.0) > place.s
            if not self.streets[place.street].in_row(place.s):
                in_the_way |= not needed.isdisjoint(self._blocked_by(place))
                point = Sweep((place.street,), place.s, place.s)
                in_the_way |= any(self.streets.meet(point, self._arrival(k, aim)) for k, aim in last)
            if i in self.targets:
                total += self._round(place.street) if in_the_way else 0.0
            elif in_the_way or (place.street in arrive and not self._leaves_room(i, place.street, a)):
                total += self.streets[place.street].length + HOP
        return total

    def _arrival(self, here: int, aim: Place) -> Sweep:
        street = self.streets[aim.street]
        return Sweep((here, aim.street), max(self.streets[here].last, 0.0), min(aim.s, max(street.first, 0.0)))

    def _way(self, here: int, aim: Place | None, needed: set[tuple[int, int]], last: set[tuple[int, Place]]) -> float:
        if aim is None:
            return HOP
        way, after = self.ways[aim.street]
        if way[here] == math.inf:
            return math.inf
        total, k = way[here] + HOP, here
        while True:
            if after[k] == aim.street:
                last.add((k, aim))
                return total
            needed.add((k, after[k]))
            k = after[k]
            total += HOP

    def _leaves_room(self, i: int, index: int, a: Arrangement) -> bool:
        """True if another mover could still enter the row behind this one."""
        street = self.streets[index]
        return self.fits(street, (*a.rows[index], i), a)

    def _round(self, street: int) -> float:
        way = self.ways[street][0][street]
        return 1e4 if way == math.inf else way + HOP

    def _blocked_by(self, place: Place) -> set[tuple[int, int]]:
        if place not in self._blocks:
            point = Sweep((place.street,), place.s, place.s)
            self._blocks[place] = {
                (a.index, b)
                for a in self.streets.all
                for b in a.behind
                if self.streets.meet(point, Sweep((a.index, b), max(a.last, 0.0), min(self.streets[b].first, 1e9)))
            }
        return self._blocks[place]

    @cached_property
    def _blocks(self) -> dict[Place, set[tuple[int, int]]]:
        return {}


class Search(NamedTuple):
    hops: tuple[Hop, ...] | None  # None: not found
    tried: int  # arrangements reached
    complete: bool  # True: no arrangement is left to try


def search(task: Task, effort: int, weight: float = math.inf) -> Search:
    """Searches for an order of hops, and gives up after about `effort` arrangements.

    Without a weight the arrangement with the least estimated distance left is expanded first (greedy best-first
    search). With a weight it is that with the least sum of cost so far and weight times distance left (weighted A*):
    the smaller the weight, the shorter the routes, and the more arrangements are expanded.
    """
    start = task.start
    if task.is_done(start):
        return Search((), 0, True)
    greedy = weight == math.inf
    came: dict[Arrangement, tuple[Arrangement, Hop] | None] = {start: None}
    gone = {start: 0.0}
    count = itertools.count()
    heap = [(task.far(start), 0, 0.0, start)] if task.far(start) < math.inf else []
    while heap:
        _, _, way, a = heapq.heappop(heap)
        if way > gone[a]:
            continue  # reached at a lower cost meanwhile
        if not greedy and task.is_done(a):
            return Search(_hops_to(a, came), len(came), False)
        for hop in task.hops(a):
            b = task.after(hop, a)
            if b is None:
                continue
            further = way + task.cost(hop)
            if b in came and (greedy or further >= gone[b]):
                continue
            came[b], gone[b] = (a, hop), further
            far = task.far(b)
            if far == math.inf:
                continue
            if greedy and task.is_done(b):
                return Search(_hops_to(b, came), len(came), False)
            heapq.heappush(heap, (far if greedy else further + weight * far, -next(count), further, b))
        if len(came) > effort:
            return Search(None, len(came), False)
    return Search(None, len(came), True)


def _hops_to(a: Arrangement, came: Mapping[Arrangement, tuple[Arrangement, Hop] | None]) -> tuple[Hop, ...]:
    hops = []
    while (step := came[a]) is not None:
        a, hop = step
        hops.append(hop)
    return tuple(reversed(hops))
