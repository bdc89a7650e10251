"""Targets of movers on a closed track. Movers do not overtake, so their cyclic order is fixed; what remains is the
number of turns. Ours: the target of one reference mover is tried at -1, 0 and +1 turns, and the solution with the least
total travel is taken."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from takt.counted import counted
from takt.routing.streets import SAME, RoutingError, Street, Streets


@dataclass(frozen=True)
class Loop:
    street: Street
    starts: Mapping[int, float]  # by mover: mm along the loop
    targets: Mapping[int, float]
    fixed: Mapping[int, float]  # movers that may not be moved


def go_round(loop: Loop, streets: Streets, names: Sequence[str]) -> dict[int, float]:
    """Returns the target position [mm] of each mover that moves, counted from its present position on the track: below
    0 or above the length where it crosses the origin. All start at the same time. Movers without a target are displaced
    where necessary, `fixed` ones never. Raises RoutingError if the gaps do not fit, or the targets are in another
    cyclic order. Requires: at least one target."""
    length, gap = loop.street.length, streets.gap
    if len(loop.starts) * gap > length - SAME:
        movers = counted(len(loop.starts), "mover")
        raise RoutingError(
            f"closed track {loop.street.name} ({length:.6g} mm) has no room for {movers} with a gap of {gap:.6g} mm"
        )
    best: dict[int, float] | None = None
    aims = {**loop.targets, **loop.fixed}
    reference = next(iter(loop.fixed), next(iter(loop.targets)))
    # Movers in ascending order, unwrapped from the reference mover.
    order = sorted(loop.starts, key=lambda i: (loop.starts[i] - loop.starts[reference]) % length)
    starts = {i: loop.starts[reference] + (loop.starts[i] - loop.starts[reference]) % length for i in order}
    for turn in (0,) if reference in loop.fixed else (-1, 0, 1):
        ends = _ends(loop, order, starts, aims, aims[reference] + turn * length, gap)
        if ends is not None and (best is None or _total_travel(ends, starts) < _total_travel(best, starts)):
            best = ends
    if best is None:
        stay = f", and {', '.join(names[i] for i in loop.fixed)} may not be moved" if loop.fixed else ""
        raise RoutingError(
            f"closed track {loop.street.name}: movers cannot overtake, and the targets are in another order than the "
            f"movers{stay}"
        )
    moving = {i: s for i, s in best.items() if i in loop.targets or abs(s - starts[i]) > SAME}
    # Back from unwrapped positions to those on the track.
    return {i: s - (starts[i] - loop.starts[i]) for i, s in moving.items() if i not in loop.fixed}


def _total_travel(ends: Mapping[int, float], starts: Mapping[int, float]) -> float:
    return sum(abs(ends[i] - starts[i]) for i in ends)


def _ends(
    loop: Loop, order: Sequence[int], starts: Mapping[int, float], aims: Mapping[int, float], first: float, gap: float
) -> dict[int, float] | None:
    """Returns the end position [mm, unwrapped] of each mover if the reference mover `order[0]` ends at `first`; None
    where a gap or a fixed mover does not allow it. Forwards: the least position of each mover; backwards: the position
    nearest to its start that keeps the gap to the next one."""
    length = loop.street.length
    fixed = {i: first + (aims[i] - first) % length for i in order if i in aims}
    fixed[order[0]] = first  # exactly: rounding must not add a turn
    if any(abs(fixed[i] - starts[i]) > SAME for i in loop.fixed):
        return None
    least: dict[int, float] = {}
    low = first
    for i in order:
        least[i] = fixed.get(i, low)
        low = least[i] + gap
    ends: dict[int, float] = {}
    high = first + length - gap
    for i in reversed(order):
        s = fixed[i] if i in fixed else min(max(starts[i], least[i]), high)
        if s > high + SAME or s < least[i] - SAME:
            return None
        ends[i] = s
        high = s - gap
    return ends
