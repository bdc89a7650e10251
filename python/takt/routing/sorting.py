"""Sorts movers on a ring of streets with one ear (rings.py), so that each can stop at its target in a last lap."""

from __future__ import annotations

import bisect
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from takt.routing.rings import Rules


class GivenUpError(Exception):
    """The rules do not lead to a solution."""


class Ear(NamedTuple):
    streets: tuple[int, ...]  # in the direction of travel
    leaves: int  # the street of the rest that leads into the ear
    joins: int  # the street of the rest into which the ear leads


class Sorting:
    """Sorting of the movers on a ring and one ear."""

    def __init__(self, rules: Rules, ring: list[int], ear: Ear) -> None:
        self.rules = rules
        self.rows = rules.rows
        self.ear = ear
        # The ring from where the ear joins it to where it branches off, and the queue parallel to the ear.
        at = ring.index(ear.joins)
        turned = ring[at:] + ring[:at]
        leaves = turned.index(ear.leaves)
        self.main = turned[: leaves + 1]
        self.beside = turned[leaves + 1 :]
        # In the order in which movers arrive where the ear branches off.
        aims = rules.aims
        order = [i for k in reversed(self.main) for i in aims[k]] + [i for k in reversed(self.beside) for i in aims[k]]
        self.on_ear = [i for k in reversed(ear.streets) for i in aims[k]]
        self.order = order + self.on_ear
        self.rank = {i: n for n, i in enumerate(self.order)}
        self.count = len(self.order)
        self.last = self.count - 1  # rank of the ordered mover that joined last
        self.kept: set[int] = set()

    def run(self) -> None:
        if not self.order:
            return
        self._empty_ear()
        for _ in range(self.count + 1):  # each lap moves at least one mover to its place in the order
            if self._is_sorted():
                break
            self._lap()
        else:
            raise GivenUpError
        self._settle()

    def _empty_ear(self) -> None:
        """Moves movers from the ear to the ring, as far as there is room."""
        ear, ring = list(self.ear.streets), [*self.main, *self.beside]
        while any(self.rows[k] for k in ear):
            self._close_up(self.main)
            self._close_up(ear)
            slack = sum(self.rules.room[k] - len(self.rows[k]) for k in ring)
            if slack < 2 or not self.rows[ear[-1]] or not self.rules.has_room(self.main[0]):
                return
            self.rules.hop(ear[-1], self.main[0])

    def _line(self, streets: Iterable[int]) -> list[int]:
        return [i for k in reversed(list(streets)) for i in self.rows[k]]

    def _ahead(self, i: int) -> int:
        """Returns the number of movers in the order between the one that joined last and this one."""
        return (self.rank[i] - self.last - 1) % self.count

    def _is_sorted(self) -> bool:
        """True if both queues can be merged with the rest of the ring in the order of the targets."""
        both = sorted(self._line(self.beside) + self._line(self.ear.streets), key=self._ahead)
        for line in (self._line(self.beside), self._line(self.ear.streets)):
            if [self._ahead(i) for i in line] != sorted(map(self._ahead, line)):
                return False
        all_of = self._line(self.main) + both
        ranks = [self.rank[i] for i in all_of]
        falls = sum(a > b for a, b in zip(ranks, [*ranks[1:], ranks[0]], strict=True))
        return falls <= 1

    # --- one street ahead ---

    def _close_up(self, streets: Sequence[int], stop: Mapping[int, int] | None = None) -> bool:
        """Moves movers ahead within these streets, as far as there is room; `stop`: by mover, the street on which it
        stays. Returns False if none moved."""
        moved = False
        for n in range(len(streets) - 2, -1, -1):
            here, there = streets[n], streets[n + 1]
            while self.rows[here] and self.rules.has_room(there):
                if stop is not None and stop.get(self.rows[here][0]) == here:
                    break
                self.rules.hop(here, there)
                moved = True
        return moved

    def _join(self, queue: Sequence[int]) -> None:
        self.last = self.rank[self.rows[queue[-1]][0]]
        self.rules.hop(queue[-1], self.main[0])

    def _queues(self) -> list[list[int]]:
        return [list(q) for q in (self.beside, list(self.ear.streets)) if q]

    def _lap(self) -> None:
        """Moves all movers round once. The longest sequence in order is kept; of the others as many as there is room
        for wait in the ear, and rejoin where they belong."""
        main, beside = self._line(self.main), self._line(self.beside)
        self.kept = self._in_order(main + beside)
        # The rearmost movers on the ring are those that joined last.
        for i in beside + main:
            self._note(i)
        passed, laps = 0, len(main) + len(beside)
        ear = list(self.ear.streets)
        while passed < laps:
            moved = self._close_up(self.main)
            for queue in (self.beside, ear):
                moved |= self._close_up(queue)
            front = self.rows[self.main[-1]]
            room = self.rules.has_room(self.main[0])
            waits = self.rows[ear[-1]]
            if waits and self._belongs_here(waits[0]):
                if room:
                    self.kept.add(waits[0])
                    self._join(ear)
                    continue
            elif self.beside and self.rows[self.beside[-1]] and room:
                i = self.rows[self.beside[-1]][0]
                self.rules.hop(self.beside[-1], self.main[0])
                self._note(i)
                continue
            if front and front[0] not in self.kept and self.rules.has_room(ear[0]) and self._follows_in_ear(front[0]):
                self.rules.hop(self.main[-1], ear[0])
                passed += 1
                continue
            if front and self.beside and self.rules.has_room(self.beside[0]):
                self.rules.hop(self.main[-1], self.beside[0])
                passed += 1
                continue
            if front and not self.beside and room and not (waits and self._belongs_here(waits[0])):
                i = front[0]
                self.rules.hop(self.main[-1], self.main[0])
                self._note(i)
                passed += 1
                continue
            if not moved:
                raise GivenUpError

    def _note(self, i: int) -> None:
        if i in self.kept:
            self.last = self.rank[i]

    def _next_kept(self) -> int | None:
        line = self._line(self.beside) + self._line(self.main)
        return next((i for i in line if i in self.kept), None)

    def _belongs_here(self, i: int) -> bool:
        """True if the mover belongs between the ordered mover that joined last and the next one."""
        then = self._next_kept()
        return then is None or self._ahead(i) < self._ahead(then)

    def _follows_in_ear(self, i: int) -> bool:
        line = self._line(self.ear.streets)
        return not line or self._ahead(line[-1]) < self._ahead(i)

    def _in_order(self, line: Sequence[int]) -> set[int]:
        """Returns the longest subsequence of a line in the cyclic order of the targets."""
        best: list[int] = []
        for base in {self.rank[i] for i in line}:
            keys = [(self.rank[i] - base) % self.count for i in line]
            tails: list[int] = []  # keys, by length
            ends: list[int] = []  # index in the line
            before = [-1] * len(line)
            for n, key in enumerate(keys):
                at = bisect.bisect_left(tails, key)
                before[n] = ends[at - 1] if at else -1
                tails[at : at + 1] = [key]
                ends[at : at + 1] = [n]
            if len(ends) > len(best):
                best, n = [], ends[-1]
                while n >= 0:
                    best.append(line[n])
                    n = before[n]
        return set(best)

    # --- in order: each mover to its target ---

    def _settle(self) -> None:
        """Fills the ear with its movers, and stops the others on the streets of their targets."""
        ring = [i for i in self.order if i not in set(self.on_ear)]
        first = ring[0] if ring else -1
        waiting = deque(self.on_ear)
        ear = list(self.ear.streets)
        stays = set(self.on_ear)
        entered: set[int] = set()
        begun = False
        stop: dict[int, int] = {}
        beside = {i for k in self.beside for i in self.rules.aims[k]}
        open_ = [k for k in self.rows if k not in self.rules.closed]
        for _ in range(20 * (self.count + 2) * (len(self.rules.rows) + 2)):
            if not waiting and all(list(self.rows[k]) == self.rules.aims[k] for k in open_):
                return
            moved = self._close_up(self.main, stop)
            queues = self._queues()
            for queue in queues:
                moved |= self._close_up(queue, self._ear_stops(ear, stays, entered) if queue == ear else stop)
            # Out of the queues, in order; movers that stay in the ear do not count.
            heads = [q for q in queues if self.rows[q[-1]] and not (q == ear and self.rows[q[-1]][0] in entered)]
            ready = [q for q in heads if stop.get(self.rows[q[-1]][0]) != q[-1]]
            if ready and self.rules.has_room(self.main[0]):
                queue = min(ready, key=lambda q: self._ahead(self.rows[q[-1]][0]))
                i = self.rows[queue[-1]][0]
                if i == first and not waiting and entered.issuperset(self._line(ear)):
                    begun = True
                    if beside.issuperset(ring):  # none stops on the rest of the ring: all are in their queue
                        stop = {one: self.rules.street_of[one] for one in beside}
                        continue
                self._join(queue)
                if begun and i in self.rules.street_of:
                    stop[i] = self.rules.street_of[i] if i not in beside else -1
                    if set(ring) - beside <= stop.keys():
                        stop |= {one: self.rules.street_of[one] for one in beside}
                continue
            front = self.rows[self.main[-1]]
            if front and stop.get(front[0]) != self.main[-1]:
                i = front[0]
                if waiting and i == waiting[0]:
                    if self.rules.has_room(ear[0]):
                        waiting.popleft()
                        entered.add(i)
                        self.rules.hop(self.main[-1], ear[0])
                        continue
                elif self.beside:
                    if self.rules.has_room(self.beside[0]):
                        self.rules.hop(self.main[-1], self.beside[0])
                        continue
                elif self.rules.has_room(self.main[0]):
                    if i == first and not waiting and entered.issuperset(self._line(ear)):
                        begun = True
                    self.last = self.rank[i]
                    self.rules.hop(self.main[-1], self.main[0])
                    if begun:
                        stop[i] = self.rules.street_of[i]
                    continue
            if not moved:
                raise GivenUpError
        raise GivenUpError

    def _ear_stops(self, ear: Sequence[int], stays: set[int], entered: set[int]) -> dict[int, int]:
        return {i: self.rules.street_of[i] for i in stays if i in entered}
