"""Plans routes and the order of passing for many movers at once: all reach their targets, and none waits for ever.

A plan consists of the hops of each mover from row to row (arrangement.py), and for each hop the hops of other movers
that have to end before it. Movers that keep to that order reach their targets, however long each hop takes: of the
remaining hops, the first one in the order in which they were found is always possible.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from takt.counted import counted
from takt.routing.arrangement import Hop, Place, Task, search
from takt.routing.loop import Loop, go_round
from takt.routing.order import Shift, Step, ends_of, in_time, shifts_of, shorter, steps_of
from takt.routing.rings import by_rules
from takt.routing.streets import SAME, RoutingError, Sweep, read_streets
from takt.routing.surface import may_move_of

if TYPE_CHECKING:
    from takt.session import Session

EFFORT = 20_000  # arrangements tried before a plan is given up
ENOUGH = 20_000  # arrangements tried if there is a plan by rules already, divided by the number of movers ...
LEAST_EFFORT = 500  # ... but at least this many
WEIGHTS = (3.0, 1.5, 1.0)  # of the distance left, in searches for orders with shorter routes ...
BETTER = 30_000  # ... in which this many arrangements are tried, divided by the number of movers
MOST_REORDERED = 250  # hops of a plan that is searched for a better order; the time grows with their square
DYNAMICS = ("velocity", "acceleration", "deceleration", "jerk")
STANDS = 1e-3  # mm/s
Target = tuple[str, float]  # a track, and a position along it [mm]


@dataclass(frozen=True)
class RoutePlan:
    """Routes of movers on tracks, and their order of passing. `str(plan)` describes the plan in words."""

    names: tuple[str, ...]  # of the movers on tracks
    targets: Mapping[str, Target]
    task: Task
    steps: tuple[tuple[Step, ...], ...]  # by mover
    shifts: Mapping[int, tuple[Shift, ...]]  # by street, in the order of the plan
    ends: Mapping[int, float]  # by mover that moves: final position [mm along its last street]; on a loop with turns
    tried: int = 0  # arrangements that were tried
    gap: float | None = None  # as requested [mm]
    dynamics: Mapping[str, float] = field(default_factory=dict)

    def way(self, mover: str) -> list[str]:
        """Returns the names of the tracks along which a mover moves, from its present one on."""
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
    """Returns routes and an order of passing with which all movers with a target reach it; nothing is moved.

    targets: by mover, the track and the position along it [mm].
    may_move: movers without a target that may be moved out of the way; True: all of them, False: none.
    gap: distance between the centres of movers along the track [mm]; None: the largest of the movers' own gaps, or
        more where movers of their sizes would not clear each other.
    effort: arrangements of movers that are tried before the search is given up.
    dynamics: velocity, acceleration, deceleration, jerk of all moves, each above 0.

    Raises RoutingError, with the reason, if no plan is found, TypeError if `dynamics` has another key.
    """
    for key, value in dynamics.items():
        if key not in DYNAMICS:
            raise TypeError(f"dynamics are {', '.join(DYNAMICS)}, not {key}")
        if not 0 < value < math.inf:
            raise RoutingError(f"{key} is above 0, not {value:.6g}")
    if gap is not None and not 0 <= gap < math.inf:
        raise RoutingError(f"the gap is 0 mm or more, not {gap:.6g}")
    movers = {name: mover for name, mover in session.movers.items() if mover.track}
    names = tuple(movers)
    for name, mover in movers.items():
        if mover.command_mode.value in ("JoiningTrack", "LeavingTrack") or abs(mover.track_velocity) > STANDS:
            raise RoutingError(f"mover {name} is in motion: ways are planned for movers that stand")
    if may_move is True:
        free: set[str] = set(names)
    else:
        free = set(may_move_of(may_move))
    for name in [*targets, *free]:
        session.mover(name)
        if name not in movers:
            raise RoutingError(f"mover {name} is on no track: let it join one first")
    gaps = [max(float(m.parameters["gap"]), m.gap) for m in movers.values()]
    streets = read_streets(
        session, max(gaps, default=0.0) if gap is None else gap, movers.values() if gap is None else ()
    )
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
    rules = by_rules(task)
    # If the rules give an order, the search for a shorter one is limited.
    found = search(task, effort if rules is None else min(effort, max(LEAST_EFFORT, ENOUGH // len(names))))
    hops = found.hops
    if hops is None:
        hops = rules
    if hops is None and found.complete:
        switches = any(street.end_node >= 0 for street in streets.all)
        resting = " by movers that wait outside the zones of switches" if switches else ""
        raise RoutingError(
            f"the targets cannot all be reached{resting}: every order of passing was tried "
            f"({counted(found.tried, 'arrangement')}{_aside(task, names)})"
        )
    if hops is None:
        raise RoutingError(f"no plan was found after {counted(found.tried, 'arrangement')} of movers; there may be one")
    pace = dynamics.get("velocity") or max((_velocity(m.parameters) for m in movers.values()), default=1.0)
    hops, more = _best(task, hops, pace, effort)
    steps, shifts = steps_of(task, hops), shifts_of(task, hops)
    ends |= ends_of(task, hops, shifts)
    return RoutePlan(names, dict(targets), task, steps, shifts, ends, found.tried + more, gap, dynamics)


def _best(task: Task, hops: tuple[Hop, ...], pace: float, effort: int) -> tuple[tuple[Hop, ...], int]:
    """Returns the order with the least sum of arrival times, of this one and others with shorter routes; and the number
    of arrangements that were tried for them."""
    if len(hops) > MOST_REORDERED:
        return hops, 0
    best, least = in_time(task, shorter(task, hops), pace)
    tried = 0
    for weight in WEIGHTS:
        found = search(task, min(effort, BETTER // max(len(task.starts), 1)), weight)
        tried += found.tried
        if found.hops is not None and len(found.hops) <= MOST_REORDERED:
            order, total = in_time(task, shorter(task, found.hops), pace)
            if total < least:
                best, least = order, total
    return tuple(best), tried


def _velocity(parameters: Mapping[str, object]) -> float:
    xy: Mapping[str, Mapping[str, float] | None] = parameters["xy"]  # type: ignore[assignment]
    given = [limits["velocity"] for limits in (xy.get("standard"), xy["maximum"]) if limits]
    return float(min(given, default=1.0))


def _aside(task: Task, names: Sequence[str]) -> str:
    return f"; {', '.join(names[i] for i in sorted(task.fixed))} may not be moved" if task.fixed else ""


def _point(place: Place) -> Sweep:
    return Sweep((place.street,), place.s, place.s)


# --- targets that no order of passing can reach ---


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
    """True if there would be a route if this mover could be moved."""
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
