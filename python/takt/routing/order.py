"""The order of hops: sorted by time, without detours, and reduced to the constraints that have to be kept."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from takt.routing.arrangement import Arrangement, Hop, Place, Task
from takt.routing.streets import SAME, Streets


@dataclass(frozen=True)
class Step:
    """One hop of a mover, and the hops of other movers that have to end before: (mover, number of its hop)."""

    hop: Hop
    after: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Shift:
    """A hop to or from the row of a street, and the position of the row that it requires."""

    hop: tuple[int, int]  # mover, and number of its hop
    compact: bool  # True: no mover takes its target yet, the row is as far ahead as possible
    most: Mapping[int, float]  # by mover: upper bound of its position [mm]


def in_time(task: Task, hops: Sequence[Hop], speed: float) -> tuple[list[Hop], float]:
    """Returns the hops sorted by the time at which each can begin, as far as the remaining ones stay possible; and the
    sum of the arrival times [s] of the movers with a target at `speed` [mm/s], without ramps and queues."""
    streets = task.streets
    left = list(hops)
    a = task.start
    ready = [0.0] * len(task.starts)  # by mover: time at which its last hop so far ends [s]
    place = list(task.starts)
    pending: dict[int, float] = {}  # by mover: time at which its next hop can begin, as far as is known [s]
    placed: list[tuple[Hop, float, float]] = []
    order: list[Hop] = []

    def begin(hop: Hop) -> float:
        here = place[hop.mover]
        way = abs((hop.sweep.end if hop.backward else hop.sweep.start) - here.s)
        return max([ready[hop.mover] + way / speed, *(_over(streets, hop, one, speed) for one in placed)])

    while left:
        first: dict[int, Hop] = {}
        for hop in left:
            first.setdefault(hop.mover, hop)
        for i, hop in first.items():
            if i not in pending:
                pending[i] = begin(hop)
        for i in sorted(first, key=lambda i: (pending[i], left.index(first[i]))):
            hop = first[i]
            at = left.index(hop)
            if at == 0 or _still_possible(task, a, left, at):
                break
        after = task.after(hop, a)
        assert after is not None
        a = after
        del left[at]
        order.append(hop)
        end = pending[i] + streets.length(hop.sweep) / speed
        ready[i], place[i] = end, Place(hop.street, hop.place)
        placed.append((hop, pending.pop(i), end))
        for other in pending:
            pending[other] = max(pending[other], _over(streets, first[other], placed[-1], speed))
    times = (ready[i] + abs(aim.s - place[i].s) / speed for i, aim in task.targets.items())
    return order, sum(times)


def _over(streets: Streets, hop: Hop, earlier: tuple[Hop, float, float], speed: float) -> float:
    """Returns the time [s] from which an earlier hop allows this one to begin; 0 if they do not conflict."""
    before, start, end = earlier
    if before.mover == hop.mover or not streets.meet(hop.sweep, before.sweep):
        return 0.0
    return start + streets.gap / speed if _follows(hop, before) else end


def _follows(hop: Hop, before: Hop) -> bool:
    """True if both lead forward from the same street to another one: there the mover cannot overtake the other."""
    return (
        not hop.backward
        and not before.backward
        and hop.sweep.streets[0] == before.sweep.streets[0]
        and len(hop.sweep.streets) > 1
        and len(before.sweep.streets) > 1
    )


def _still_possible(task: Task, a: Arrangement, hops: Sequence[Hop], first: int) -> bool:
    """True if from this arrangement the hops are possible in this order, with hop number `first` moved to the front."""
    usual: Arrangement | None = a
    other = task.after(hops[first], a)
    for n, hop in enumerate(hops):
        if other is None:
            return False
        if n <= first and usual is not None:
            usual = task.after(hop, usual)
        if n != first:
            other = task.after(hop, other)
        elif usual == other:
            return True
    return other is not None and task.is_done(other)


# --- without detours ---


def shorter(task: Task, hops: Sequence[Hop]) -> list[Hop]:
    """Returns the hops without rounds that lead a mover back to where it was, and without stops in a zone before it
    enters a row, as far as the remaining hops allow."""
    best = list(hops)
    for i in sorted({hop.mover for hop in hops}):
        while True:
            better = next((one for one in _shortcuts(best, i) if _leads_there(task, one)), None)
            if better is None:
                break
            best = better
    return best


def _leads_there(task: Task, hops: Sequence[Hop]) -> bool:
    a: Arrangement | None = task.start
    for hop in hops:
        a = task.after(hop, a) if a is not None else None
    return a is not None and task.is_done(a)


def _shortcuts(hops: Sequence[Hop], mover: int) -> Iterator[list[Hop]]:
    own = [n for n, hop in enumerate(hops) if hop.mover == mover]
    # A round: from the street where it begins directly to the hop by which the mover leaves that street again.
    for size in range(len(own) - 1, 0, -1):
        for first, after in zip(own, own[size:], strict=False):
            before, then = hops[first], hops[after]
            if before.sweep.streets[0] != then.sweep.streets[0]:
                continue
            entry = before.sweep.end if before.backward else before.sweep.start
            if then.backward:
                joined = replace(then, sweep=replace(then.sweep, end=max(entry, then.sweep.start)))
            else:
                joined = replace(then, sweep=replace(then.sweep, start=entry))
            if len(joined.sweep.streets) > 1 or joined.sweep.start < joined.sweep.end:
                dropped = own[own.index(first) : own.index(after) + 1]
                yield _in_place(hops, joined, after, dropped)
                yield _in_place(hops, joined, first, dropped)
    # A stop in the zone before a row, and the hop from there into the row.
    for first, second in itertools.pairwise(own):
        one, two = hops[first], hops[second]
        if not (one.to_row or one.backward or two.backward) and two.to_row and one.street == two.street:
            joined = replace(one, sweep=replace(one.sweep, end=two.sweep.end), to_row=True)
            yield _in_place(hops, joined, first, [first, second])
            yield _in_place(hops, joined, second, [first, second])


def _in_place(hops: Sequence[Hop], new: Hop, at: int, dropped: Sequence[int]) -> list[Hop]:
    return [new if n == at else hop for n, hop in enumerate(hops) if n == at or n not in dropped]


# --- which hop waits for which ---


def steps_of(task: Task, hops: Sequence[Hop]) -> tuple[tuple[Step, ...], ...]:
    steps: list[list[Step]] = [[] for _ in task.starts]
    # Hops of one kind differ only in their movers; for each mover only the last hop of a kind counts.
    last: dict[Hop, dict[int, int]] = {}
    waits: dict[tuple[Hop, Hop], bool] = {}
    for hop in hops:
        kind = replace(hop, mover=-1)
        after: dict[int, int] = {}
        for before, numbers in last.items():
            if (kind, before) not in waits:
                waits[kind, before] = _waits_for(task.streets, kind, before)
            if waits[kind, before]:
                for mover, number in numbers.items():
                    if mover != hop.mover:
                        after[mover] = max(number, after.get(mover, 0))
        number = len(steps[hop.mover])
        steps[hop.mover].append(Step(hop, tuple(sorted(after.items()))))
        last.setdefault(kind, {})[hop.mover] = number
    return tuple(tuple(own) for own in steps)


def _waits_for(streets: Streets, hop: Hop, before: Hop) -> bool:
    # No mover enters a row that has yet to make room at its front.
    if before.comes_back(streets[hop.street]):
        return True
    return streets.meet(hop.sweep, before.sweep) and not _follows(hop, before)


def shifts_of(task: Task, hops: Sequence[Hop]) -> dict[int, tuple[Shift, ...]]:
    shifts: dict[int, list[Shift]] = {}
    numbers = [0] * len(task.starts)
    a: Arrangement | None = task.start
    for hop in hops:
        assert a is not None
        a = task.after(hop, a)
        assert a is not None
        one = (hop.mover, numbers[hop.mover])
        numbers[hop.mover] += 1
        street = task.streets[hop.street]
        if hop.comes_back(street):
            high = task.bounds(street, a)[1]
            most = {i: high - n * task.streets.gap for n, i in enumerate(a.rows[hop.street])}
            shifts.setdefault(hop.street, []).append(Shift(one, True, most))
        elif hop.to_row or len(hop.sweep.streets) == 1:
            shifts.setdefault(hop.street, []).append(Shift(one, hop.backward, {}))
    return {k: tuple(own) for k, own in shifts.items() if any(shift.compact for shift in own)}


def ends_of(task: Task, hops: Sequence[Hop], shifted: Collection[int]) -> dict[int, float]:
    """Returns the final position [mm] of each mover that moves: its target; without one the foremost free position of
    its row after a hop, else a displacement no larger than necessary. All movers of rows that are shifted meanwhile
    (`shifted`: their streets) count as moving."""
    a: Arrangement | None = task.start
    for hop in hops:
        assert a is not None
        a = task.after(hop, a)
    assert a is not None
    moved = {hop.mover for hop in hops}
    ends = {i: place.s for i, place in a.apart if i not in task.fixed and (i in moved or i in task.targets)}
    gap = task.streets.gap
    for street in task.streets.all:
        row = a.rows[street.index]
        if street.closed or not row:
            continue
        low, high = task.bounds(street, a)
        least: dict[int, float] = {}
        for i in reversed(row):
            aim = task.aim(i)
            least[i] = low if aim is None else aim.s
            low = least[i] + gap
        for i in row:
            aim = task.aim(i)
            if aim is not None:
                s = aim.s
            elif i in moved:
                s = high
            else:
                s = min(max(task.starts[i].s, least[i]), high)
            high = s - gap
            moves = street.index in shifted or i in moved or abs(s - task.starts[i].s) > SAME
            if i not in task.fixed and (aim is not None or moves):
                ends[i] = s
    return ends
