"""Movers on a closed loop: their order stays what it is; all that there is to find is who goes how many times round."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from takt.counted import counted
from takt.routing.streets import SAME, RoutingError, Street, Streets


@dataclass(frozen=True)
class Loop:
    street: Street
    starts: Mapping[int, float]  # by mover: mm along the loop
    targets: Mapping[int, float]
    fixed: Mapping[int, float]  # that stay where they are


def go_round(loop: Loop, streets: Streets, names: Sequence[str]) -> dict[int, float]:
    """Where the movers that move go, turns counted in; all of them set out at once."""
    length, gap = loop.street.length, streets.gap
    if len(loop.starts) * gap > length - SAME:
        movers = counted(len(loop.starts), "mover")
        raise RoutingError(f"loop {loop.street.name} is full: {movers} with a gap of {gap:.6g} mm")
    best: dict[int, float] | None = None
    aims = {**loop.targets, **loop.fixed}
    one = next(iter(loop.fixed), next(iter(loop.targets)))
    # From one with an aim on, upwards; and once more the same at the end.
    order = sorted(loop.starts, key=lambda i: (loop.starts[i] - loop.starts[one]) % length)
    starts = {i: loop.starts[one] + (loop.starts[i] - loop.starts[one]) % length for i in order}
    for turn in (0,) if one in loop.fixed else (-1, 0, 1):
        ends = _ends(loop, order, starts, aims, aims[one] + turn * length, gap)
        if ends is not None and (best is None or _far(ends, starts) < _far(best, starts)):
            best = ends
    if best is None:
        stay = f", and {', '.join(names[i] for i in loop.fixed)} may not be moved" if loop.fixed else ""
        raise RoutingError(
            f"on loop {loop.street.name} nobody overtakes: the targets are in another order than the movers{stay}"
        )
    moving = {i: s for i, s in best.items() if i in loop.targets or abs(s - starts[i]) > SAME}
    # As the engine counts: from where each of them is within the loop.
    return {i: s - (starts[i] - loop.starts[i]) for i, s in moving.items() if i not in loop.fixed}


def _far(ends: Mapping[int, float], starts: Mapping[int, float]) -> float:
    return sum(abs(ends[i] - starts[i]) for i in ends)


def _ends(
    loop: Loop, order: Sequence[int], starts: Mapping[int, float], aims: Mapping[int, float], first: float, gap: float
) -> dict[int, float] | None:
    length = loop.street.length
    fixed = {i: first + (aims[i] - first) % length for i in order if i in aims}
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
        if s > high + SAME or s < least[i] - SAME or (i in fixed and s != fixed[i]):
            return None
        ends[i] = s
        high = s - gap
    return ends if not math.isinf(high) else None
