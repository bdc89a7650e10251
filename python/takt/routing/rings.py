"""An order of hops for many movers on a network in which every street leads to every other one. It is found by rules
instead of a search, so the effort stays small for many movers.

Ours. Streets with room are queues: movers enter at the back and leave at the front. The network is decomposed into a
ring and ears (an ear is a chain of streets that branches off the rest and joins it again). One ear after the other is
filled with the movers whose targets are on it, the foremost first, and is closed; the remaining network is always
strongly connected. With the last ear the movers on the ring are sorted: where the ear branches off, a mover takes one
of two queues, where it joins, the queues are merged, so that a lap brings the order nearer to that of the targets. Then
the last ear is filled, and the other movers stop at their targets in a last lap.

Requires room for one mover more than there are. The invariant: in a strongly connected network some street with room
is reachable from every street, and the movers at the fronts of the streets on the path to it can move up by one street
each.
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Iterable, Mapping

from takt.routing.arrangement import Hop, Task
from takt.routing.sorting import Ear, GivenUpError, Sorting
from takt.routing.streets import MARGIN, Street, Sweep


def by_rules(task: Task) -> tuple[Hop, ...] | None:
    """Returns an order of hops; None if the network or the task does not meet the requirements of the rules."""
    try:
        return Rules(task).hops()
    except GivenUpError:
        return None


class Rules:
    def __init__(self, task: Task) -> None:
        self.task = task
        streets = task.streets
        start = task.start
        self.rows = {s.index: deque(start.rows[s.index]) for s in streets.all if s.has_room and not s.closed}
        self.room = {k: self._room_of(streets[k]) for k in self.rows}
        self.ways: dict[int, dict[int, tuple[int, ...]]] = {k: {} for k in self.rows}
        for k in self.rows:
            for way in sorted(streets.passages[k], key=lambda way: (len(way), way)):
                if way[-1] in self.rows and way[-1] != k:
                    self.ways[k].setdefault(way[-1], way)
        on_loops = any(start.rows[s.index] for s in streets.all if s.closed)
        if start.apart or task.fixed or on_loops or len(self.rows) < 3:
            raise GivenUpError
        self._leave_out_the_rest()
        self.aims = self._rows_of_targets()
        self.street_of = {i: k for k, row in self.aims.items() for i in row}
        self.found: list[Hop] = []
        self.closed: set[int] = set()  # streets that are filled with their movers

    def _leave_out_the_rest(self) -> None:
        """Keeps only the streets that are strongly connected to the one of the first mover. All movers have to be on
        them."""
        first = next((k for k, row in self.rows.items() if row), None)
        if first is None:
            raise GivenUpError
        back: dict[int, list[int]] = {k: [] for k in self.rows}
        for k, behind in self.ways.items():
            for n in behind:
                back[n].append(k)
        both = _reached(first, self.ways) & _reached(first, back)
        if any(row and k not in both for k, row in self.rows.items()):
            raise GivenUpError
        self.rows = {k: row for k, row in self.rows.items() if k in both}
        self.ways = {k: {n: way for n, way in self.ways[k].items() if n in both} for k in self.rows}

    def _room_of(self, street: Street) -> int:
        return int((street.last - street.first + MARGIN) / self.task.streets.gap) + 1

    def _rows_of_targets(self) -> dict[int, list[int]]:
        """Returns by street the movers that end there, the foremost first. A mover without a target stays on its street
        if there is room beside the movers that have one, else it is assigned to a street with room."""
        task = self.task
        aims: dict[int, list[int]] = {k: [] for k in self.rows}
        for i, aim in task.targets.items():
            if aim.street not in aims or not task.streets[aim.street].in_row(aim.s):
                raise GivenUpError
            aims[aim.street].append(i)
        for row in aims.values():
            row.sort(key=lambda i: -task.targets[i].s)
        free = [(i, k) for k, row in self.rows.items() for i in row if i not in task.targets]
        for i, here in free:
            for k in sorted(aims, key=lambda k: (k != here, len(aims[k]) - self.room[k], k)):
                rows = [[*aims[k][:n], i, *aims[k][n:]] for n in range(len(aims[k]), -1, -1)]
                fitting = next((row for row in rows if task.fits(task.streets[k], row, task.start, aims=True)), None)
                if fitting is not None:
                    aims[k] = fitting
                    break
            else:
                raise GivenUpError
        return aims

    def hops(self) -> tuple[Hop, ...]:
        left = set(self.rows)
        if sum(map(len, self.rows.values())) >= sum(self.room[k] for k in left):
            raise GivenUpError
        ears: list[Ear] = []
        while (ear := self._ear_of(left)) is not None:
            ears.append(ear)
            left -= set(ear.streets)
        ring = self._ring_of(left)
        if ring is None or not ears:
            raise GivenUpError
        for ear in ears[:-1]:
            self._fill(ear)
        Sorting(self, ring, ears[-1]).run()
        if any(list(self.rows[k]) != self.aims[k] for k in self.rows):
            raise GivenUpError
        return tuple(self.found)

    # --- structure of the network ---

    def _is_one(self, streets: set[int]) -> bool:
        """True if these streets are strongly connected."""
        first = next(iter(streets))
        ahead = {k: [n for n in self.ways[k] if n in streets] for k in streets}
        back: dict[int, list[int]] = {k: [] for k in streets}
        for k, behind in ahead.items():
            for n in behind:
                back[n].append(k)
        return all(_reached(first, links) == streets for links in (ahead, back))

    def _ear_of(self, streets: set[int]) -> Ear | None:
        """Returns the chain with the least room without which the rest is still strongly connected; None if none is."""
        ahead = {k: [n for n in self.ways[k] if n in streets] for k in streets}
        back: dict[int, list[int]] = {k: [] for k in streets}
        for k, behind in ahead.items():
            for n in behind:
                back[n].append(k)
        found = []
        for k in streets:
            chain = [k]
            while len(ahead[chain[-1]]) == 1 and len(back[ahead[chain[-1]][0]]) == 1 and ahead[chain[-1]][0] != k:
                chain.append(ahead[chain[-1]][0])
            while len(back[chain[0]]) == 1 and len(ahead[back[chain[0]][0]]) == 1 and back[chain[0]][0] not in chain:
                chain.insert(0, back[chain[0]][0])
            rest = streets - set(chain)
            if len(rest) > 1 and self._is_one(rest):
                room = sum(self.room[n] for n in chain)
                found.append((room, Ear(tuple(chain), min(back[chain[0]]), min(ahead[chain[-1]]))))
        return min(found)[1] if found else None

    def _ring_of(self, streets: set[int]) -> list[int] | None:
        first = min(streets)
        ring = [first]
        while True:
            behind = [n for n in self.ways[ring[-1]] if n in streets]
            if len(behind) != 1:
                return None
            if behind[0] == first:
                return ring if len(ring) == len(streets) else None
            ring.append(behind[0])

    # --- moves ---

    def has_room(self, street: int) -> bool:
        return len(self.rows[street]) < self.room[street]

    def hop(self, here: int, there: int) -> None:
        streets = self.task.streets
        mover = self.rows[here].popleft()
        self.rows[there].append(mover)
        sweep = Sweep(self.ways[here][there], streets[here].last, streets[there].first)
        self.found.append(Hop(mover, sweep, False, True))

    def _make_room(self, street: int, allowed: set[int]) -> None:
        """Makes room in a street: the movers at the fronts of the streets on the shortest path to one with room move
        up."""
        before: dict[int, int] = {street: -1}
        waiting = deque([street])
        while waiting:
            k = waiting.popleft()
            if k != street and self.has_room(k):
                chain = [k]
                while before[chain[-1]] >= 0:
                    chain.append(before[chain[-1]])
                for there, here in itertools.pairwise(chain):
                    self.hop(here, there)
                return
            for n in self.ways[k]:
                if n in allowed and n not in before:
                    before[n] = k
                    waiting.append(n)
        raise GivenUpError

    def _fill(self, ear: Ear) -> None:
        """Brings the movers with targets on the ear into it, the foremost first; then closes it."""
        others = set(self.rows) - set(ear.streets) - self.closed
        wanted = [i for k in reversed(ear.streets) for i in self.aims[k]]
        # The movers on the ear leave it until those that remain are the first ones of the wanted order.
        while (line := [i for k in reversed(ear.streets) for i in self.rows[k]]) != wanted[: len(line)]:
            self._move_up(next(k for k in reversed(ear.streets) if self.rows[k]), ear, others)
        for i in wanted:
            self._bring(i, ear, others)
        self.closed |= set(ear.streets)

    def _move_up(self, k: int, ear: Ear, others: set[int]) -> None:
        """Moves the foremost mover of a street of the ear to the next street; from the last one out of the ear."""
        at = ear.streets.index(k)
        there = ear.streets[at + 1] if at + 1 < len(ear.streets) else ear.joins
        if not self.has_room(there):
            if there in ear.streets:
                self._move_up(there, ear, others)
            else:
                self._make_room(there, others)
        self.hop(k, there)

    def _bring(self, i: int, ear: Ear, others: set[int]) -> None:
        goal = self.street_of[i]
        for _ in range(4 * sum(self.room.values()) * len(self.rows)):
            here = next(k for k, row in self.rows.items() if i in row)
            if here == goal:
                return
            if here in ear.streets:
                self._move_up(here, ear, others)
            elif self.rows[here][0] != i:
                self._pass_on(here, i, ear, others)
            elif here == ear.leaves:
                if not self.has_room(ear.streets[0]):
                    self._move_up(ear.streets[0], ear, others)
                self.hop(here, ear.streets[0])
            else:
                there = self._next_to(here, ear.leaves, others)
                if not self.has_room(there):
                    self._make_room(there, others)
                if self.rows[here] and self.rows[here][0] == i:
                    self.hop(here, there)
        raise GivenUpError

    def _pass_on(self, here: int, mover: int, ear: Ear, others: set[int]) -> None:
        """Moves the foremost mover of a street on to one with room, preferably not to the one that `mover` needs."""
        way = self._next_to(here, ear.leaves, others) if here != ear.leaves else -1
        ahead = [n for n in self.ways[here] if n in others]
        if not ahead:
            raise GivenUpError
        there = min(ahead, key=lambda n: (not self.has_room(n), n == way, len(self.rows[n]) - self.room[n], n))
        if not self.has_room(there):
            self._make_room(there, others)
            if not self.rows[here] or self.rows[here][0] == mover or not self.has_room(there):
                return
        self.hop(here, there)

    def _next_to(self, here: int, goal: int, allowed: set[int]) -> int:
        """Returns the next street on the shortest path from `here` to `goal`."""
        after: dict[int, int] = {}
        waiting = deque([goal])
        seen = {goal}
        while waiting:
            k = waiting.popleft()
            for before in sorted(allowed):
                if before not in seen and k in self.ways[before]:
                    seen.add(before)
                    after[before] = k
                    if before == here:
                        return k
                    waiting.append(before)
        raise GivenUpError


def _reached(first: int, links: Mapping[int, Iterable[int]]) -> set[int]:
    seen, waiting = {first}, [first]
    while waiting:
        for n in links[waiting.pop()]:
            if n not in seen:
                seen.add(n)
                waiting.append(n)
    return seen
