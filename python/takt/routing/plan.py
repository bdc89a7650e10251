"""Plans ways and the order of passing for many movers at once, so that all get to their targets and none waits for ever.

What a plan is: for each mover its hops from row to row (arrangement.py), and for each hop those of others that have to be
over before. Whoever keeps to that order gets there, however long each of them takes: of the hops that are left the one
that comes first in the order they were found in can always be done.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from takt.routing.arrangement import Arrangement, Hop, Place, Task, search
from takt.routing.loop import Loop, go_round
from takt.routing.streets import SAME, RoutingError, Streets, Sweep, read_streets

if TYPE_CHECKING:
    from takt.session import Session

EFFORT = 20_000  # arrangements looked at before a plan is given up
Target = tuple[str, float]  # a track, and mm along it


@dataclass(frozen=True)
class Step:
    """One hop of a mover, after those of others: (mover, number of its hop)."""

    hop: Hop
    after: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Shift:
    """A hop to or from the row of a street, and where that has to be for it."""

    hop: tuple[int, int]  # mover, and number of its hop
    compact: bool  # nobody is at its target yet: as far on as possible
    most: Mapping[int, float]  # by mover: mm, no further than this


@dataclass(frozen=True)
class RoutePlan:
    """Ways for movers, and who passes before whom. `str(plan)` says it in words."""

    names: tuple[str, ...]  # of the movers on tracks
    targets: Mapping[str, Target]
    task: Task
    steps: tuple[tuple[Step, ...], ...]  # by mover
    shifts: Mapping[int, tuple[Shift, ...]]  # by street, in the order of the plan
    ends: Mapping[int, float]  # by mover that moves: mm along its last street; of a closed loop turns are counted in
    tried: int = 0  # arrangements that were looked at
    gap: float | None = None  # as asked for
    dynamics: Mapping[str, float] = field(default_factory=dict)

    def way(self, mover: str) -> list[str]:
        """The tracks that a mover goes along, from where it is."""
        i = self.names.index(mover)
        streets = [self.task.starts[i].street]
        for step in self.steps[i]:
            streets += step.hop.sweep.streets[1:]
        return [self.task.streets[k].name for k in streets]

    @property
    def moved_aside(self) -> list[str]:
        """Movers that move without a target."""
        return [self.names[i] for i in sorted(self.ends) if i not in self.task.targets]

    def __str__(self) -> str:
        lines = []
        for i in sorted(self.ends):
            after = sorted({self.names[j] for step in self.steps[i] for j, _ in step.after})
            behind = f", after {', '.join(after)}" if after else ""
            lines.append(f"{self.names[i]}: {' > '.join(self.way(self.names[i]))} to {self.ends[i]:.6g} mm{behind}")
        return "\n".join(lines)


def plan_routes(
    session: Session,
    targets: Mapping[str, Target],
    *,
    may_move: bool | Iterable[str] = False,
    gap: float | None = None,
    effort: int = EFFORT,
    **dynamics: float,
) -> RoutePlan:
    """Ways and an order of passing, such that all movers with a target get there; nothing is moved.

    targets: by mover, track and mm along it.
    may_move: movers without a target that may be moved out of the way, or all of them (True).
    gap: mm from centre to centre along the way, instead of the movers' own.
    effort: arrangements of movers that are looked at before it is given up.
    dynamics: velocity, acceleration, deceleration, jerk of all moves.

    Raises RoutingError, with the reason, if there is no plan.
    """
    movers = {name: m for name, m in session.movers.items() if m.track and m.command_mode.value != "JoiningTrack"}
    names = tuple(movers)
    if may_move is True:
        free: set[str] = set(names)
    else:
        free = set(may_move or ())
    for name in [*targets, *free]:
        session.mover(name)
        if name not in movers:
            raise RoutingError(f"mover {name} is on no track: let it join one first")
    gaps = [float(m.parameters["gap"]) for m in movers.values()]
    streets = read_streets(session, max(gaps, default=0.0) if gap is None else max(gap, 0.0))
    numbers = {street.name: street.index for street in streets.all}
    aims = {}
    for name, (track, s) in targets.items():
        length = session.track(track).length
        if not 0 <= s <= length:
            raise RoutingError(f"mover {name}: track {track} goes from 0 to {length:.6g} mm, not to {s:.6g}")
        aims[names.index(name)] = Place(numbers[track], float(s))
    able = {name for name, m in movers.items() if m.state.value == "Enabled" and m.command_mode.value == "OnTrack"}
    for name in targets:
        if name not in able:
            mover = movers[name]
            raise RoutingError(
                f"mover {name} cannot move along tracks now: {mover.state.value}, {mover.command_mode.value}"
            )
    fixed = frozenset(i for i, name in enumerate(names) if i not in aims and not (name in free and name in able))
    starts = tuple(Place(m.track - 1, m.track_position) for m in movers.values())
    task = Task(streets, starts, aims, fixed)
    _check_targets(task, names)
    ends = {i: s for loop in _loops(task) for i, s in go_round(loop, streets, names).items()}
    _check_ways(task, names)
    found = search(task, effort)
    if found.hops is None and found.complete:
        raise RoutingError(
            "the targets cannot all be reached: every order of passing was tried "
            f"({found.tried} arrangements{_aside(task, names)})"
        )
    if found.hops is None:
        raise RoutingError(f"no plan was found after {found.tried} arrangements of movers; there may be one")
    pace = dynamics.get("velocity") or max((_velocity(m.parameters) for m in movers.values()), default=1.0)
    hops = in_time(task, shorter(task, found.hops), pace)
    steps = _steps(task, hops)
    ends |= _ends(task, hops)
    return RoutePlan(names, dict(targets), task, steps, _shifts(task, hops), ends, found.tried, gap, dynamics)


def _velocity(parameters: Mapping[str, object]) -> float:
    xy: Mapping[str, Mapping[str, float] | None] = parameters["xy"]  # type: ignore[assignment]
    return float((xy.get("standard") or xy["maximum"] or {"velocity": 1.0})["velocity"])


def _aside(task: Task, names: Sequence[str]) -> str:
    return f"; {', '.join(names[i] for i in sorted(task.fixed))} may not be moved" if task.fixed else ""


def _point(place: Place) -> Sweep:
    return Sweep((place.street,), place.s, place.s)


# --- what cannot be, whatever the order ---


def _check_targets(task: Task, names: Sequence[str]) -> None:
    streets = task.streets
    last = [(i, aim) for i in range(len(names)) if (aim := task.aim(i)) is not None]
    for n, (i, a) in enumerate(last):
        for j, b in last[:n]:
            if i in task.fixed and j in task.fixed:
                continue
            round_ = streets[a.street].length if streets[a.street].closed else math.inf
            apart = abs(a.s - b.s)
            near = a.street == b.street and min(apart, round_ - apart) < streets.gap - SAME
            if near or streets.meet(_point(a), _point(b)):
                one, two = (names[j], names[i]) if j not in task.fixed else (names[i], names[j])
                stands = f"where {two} stands" if i in task.fixed or j in task.fixed else f"that of {two}"
                raise RoutingError(
                    f"the target of mover {one} is too near to {stands} for a gap of {streets.gap:.6g} mm"
                )


def _check_ways(task: Task, names: Sequence[str]) -> None:
    streets = task.streets
    for i, aim in task.targets.items():
        here = task.starts[i].street
        if streets[here].closed or streets[aim.street].closed:
            if here != aim.street:
                raise RoutingError(
                    f"mover {names[i]}: no way leads from {streets[here].name} to {streets[aim.street].name}"
                )
            continue
        if here == aim.street:
            continue
        open_ways, _ = streets.way_to(aim.street)
        if open_ways[here] == math.inf:
            raise RoutingError(
                f"mover {names[i]}: no way leads from {streets[here].name} to {streets[aim.street].name}"
            )
        if task.ways[aim.street][0][here] == math.inf:
            standing = sorted(names[j] for j in task.fixed if _frees(task, j, here, aim.street)) or sorted(
                names[j] for j in task.fixed
            )
            raise RoutingError(
                f"mover {names[i]}: {' and '.join(standing)} on the way to {streets[aim.street].name} may not be moved"
            )


def _frees(task: Task, j: int, here: int, there: int) -> bool:
    """There would be a way if this one could be moved."""
    without = Task(task.streets, task.starts, task.targets, task.fixed - {j})
    return without.ways[there][0][here] < math.inf


# --- closed loops ---


def _loops(task: Task) -> list[Loop]:
    loops = []
    for street in task.streets.all:
        if street.closed:
            movers = [i for i, place in enumerate(task.starts) if place.street == street.index]
            fixed = {i: task.starts[i].s for i in movers if i in task.fixed}
            targets = {i: task.targets[i].s for i in movers if i in task.targets}
            if targets:
                loops.append(Loop(street, {i: task.starts[i].s for i in movers}, targets, fixed))
    return loops


# --- order ---


def in_time(task: Task, hops: Sequence[Hop], speed: float) -> list[Hop]:
    """The hops in an order in which whoever can be there first goes first, as long as the rest stays possible."""
    streets = task.streets
    left = list(hops)
    a = task.start
    ready = [0.0] * len(task.starts)  # s, when it is where it is next
    place = list(task.starts)
    pending: dict[int, float] = {}  # by mover: when its next hop can begin, as far as is known
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
    return order


def _over(streets: Streets, hop: Hop, earlier: tuple[Hop, float, float], speed: float) -> float:
    """When an earlier hop lets this one begin."""
    before, start, end = earlier
    if before.mover == hop.mover or not streets.meet(hop.sweep, before.sweep):
        return 0.0
    return start + streets.gap / speed if _follows(hop, before) else end


def _follows(hop: Hop, before: Hop) -> bool:
    """It goes behind the other from the same street on; there it cannot overtake."""
    return (
        not hop.backward
        and not before.backward
        and hop.sweep.streets[0] == before.sweep.streets[0]
        and len(hop.sweep.streets) > 1
        and len(before.sweep.streets) > 1
    )


def _still_possible(task: Task, a: Arrangement, hops: Sequence[Hop], first: int) -> bool:
    """The hops in this order but for one that goes first."""
    one: Arrangement | None = a
    usual: Arrangement | None = a
    one = task.after(hops[first], a)
    for n, hop in enumerate(hops):
        if one is None:
            return False
        if n <= first:
            usual = task.after(hop, usual) if usual is not None else None
        if n == first:
            if usual == one:
                return True
            continue
        one = task.after(hop, one)
    return one is not None and task.is_done(one)


def shorter(task: Task, hops: Sequence[Hop]) -> list[Hop]:
    """The hops without those that lead round to where their mover was, or to a place that it only leaves again, as far as
    the rest can do without."""
    best = list(hops)
    for i in sorted({hop.mover for hop in hops}):
        again = True
        while again:
            again = any(_leads_there(task, one) and _put(best, one) for one in _shortcuts(task, best, i))
    return best


def _put(hops: list[Hop], better: list[Hop]) -> bool:
    hops[:] = better
    return True


def _leads_there(task: Task, hops: Sequence[Hop]) -> bool:
    a: Arrangement | None = task.start
    for hop in hops:
        a = task.after(hop, a) if a is not None else None
    return a is not None and task.is_done(a)


def _shortcuts(task: Task, hops: Sequence[Hop], mover: int) -> Iterator[list[Hop]]:
    own = [n for n, hop in enumerate(hops) if hop.mover == mover]
    begins = [hops[n].sweep.streets[0] for n in own]
    for size in range(len(own) - 1, 0, -1):
        for first in range(len(own) - size):
            cut, after = own[first : first + size], own[first + size]
            if begins[first] != begins[first + size]:
                continue
            # From where it was at first, or after all of the cut, on to where the hop after that leads.
            then, before = hops[after], hops[cut[0]]
            entry = before.sweep.end if before.backward else before.sweep.start
            if then.backward:
                joined = replace(then, sweep=replace(then.sweep, end=max(entry, then.sweep.start)))
            else:
                joined = replace(then, sweep=replace(then.sweep, start=entry))
            if len(joined.sweep.streets) == 1 and joined.sweep.start >= joined.sweep.end:
                continue
            for at in (after, cut[0]):
                kept = [n for n in range(len(hops)) if n not in cut and n != after]
                new = [hops[n] for n in kept if n < at] + [joined] + [hops[n] for n in kept if n > at]
                yield new
    # A place that it comes to and leaves again.
    for first, second in zip(own, own[1:], strict=False):
        one, two = hops[first], hops[second]
        if not one.to_row and two.to_row and not one.backward and not two.backward and one.street == two.street:
            joined = replace(one, sweep=replace(one.sweep, end=two.sweep.end), to_row=True)
            rest = [hop for n, hop in enumerate(hops) if n not in (first, second)]
            yield [*rest[:first], joined, *rest[first:]]
            yield [*rest[: second - 1], joined, *rest[second - 1 :]]


def _steps(task: Task, hops: Sequence[Hop]) -> tuple[tuple[Step, ...], ...]:
    steps: list[list[Step]] = [[] for _ in task.starts]
    numbered: list[tuple[Hop, int]] = []
    for hop in hops:
        after: dict[int, int] = {}
        for before, number in numbered:
            if before.mover == hop.mover:
                continue
            # Into a row that has to make room at its front comes nobody before that.
            if before.comes_back(task.streets[hop.street]) or (
                task.streets.meet(hop.sweep, before.sweep) and not _follows(hop, before)
            ):
                after[before.mover] = number
        number = len(steps[hop.mover])
        steps[hop.mover].append(Step(hop, tuple(after.items())))
        numbered.append((hop, number))
    return tuple(tuple(own) for own in steps)


def _shifts(task: Task, hops: Sequence[Hop]) -> dict[int, tuple[Shift, ...]]:
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


def _ends(task: Task, hops: Collection[Hop]) -> dict[int, float]:
    """Where the movers of rows come to stand in the end: at their targets; others no further than they have to."""
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
            if i not in task.fixed and (aim is not None or i in moved or abs(s - task.starts[i].s) > SAME):
                ends[i] = s
    return ends
