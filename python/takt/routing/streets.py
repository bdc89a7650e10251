"""The tracks of a machine as a route planner sees them: where movers can rest without blocking others, how they pass
from one such stretch to the next, and which of these passages conflict.

The engine keeps movers apart by their gap, along the track. Around a node, where tracks meet, it checks all movers that
are nearer to the node than their gap or the collision range of their track. Outside these zones movers on different
tracks do not affect one another. So a track has room for a row of movers between the zones at its ends, and a mover
that passes from one row to another needs the zones between for itself.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from takt.errors import TaktError
from takt.track_layout import LaidTrack, TrackLayout

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session

MARGIN = 2e-3  # [mm] distance of rows from zones; in the engine movers wait at half of it
SAME = 1e-6  # [mm] positions closer than this are equal
LONGEST = 256  # tracks in one route, as in the engine (kRouteTracks)


class RoutingError(TaktError):
    """No plan of routes was found, or it could not be executed. `mover`: name of the mover that caused it; empty if
    none did."""

    def __init__(self, sentence: str, mover: str = "") -> None:
        super().__init__(sentence)
        self.mover = mover


@dataclass(frozen=True)
class Street:
    index: int
    name: str
    length: float  # mm
    closed: bool
    behind: tuple[int, ...]  # streets that start where it ends
    start_node: int  # -1: none
    end_node: int
    first: float  # [mm] start of the stretch on which a row of movers blocks no others
    last: float  # [mm] its end; less than `first`: there is no room for a row

    @property
    def has_room(self) -> bool:
        return self.last >= self.first

    def in_row(self, s: float) -> bool:
        return self.has_room and self.zone_ends <= s <= self.zone_begins

    @property
    def zone_ends(self) -> float:
        """End of the zone of the node at the start [mm]. A mover that waits there is outside the zone."""
        return self.first - 0.9 * MARGIN if self.start_node >= 0 else -SAME

    @property
    def zone_begins(self) -> float:
        return self.last + 0.9 * MARGIN if self.end_node >= 0 else self.length + SAME


@dataclass(frozen=True)
class Sweep:
    """A stretch over these streets, from a position on the first one to a position on the last one."""

    streets: tuple[int, ...]
    start: float  # mm
    end: float


class Presence(NamedTuple):
    """An interval within the zones of a node, along the route, and the streets before and after the node (-1: none)."""

    node: int
    low: float  # mm, from the node
    high: float
    come_from: int
    to: int


class Streets:
    """All tracks, numbered from 0, with a gap [mm] that all movers keep."""

    def __init__(self, tracks: Sequence[LaidTrack], gap: float) -> None:
        self.gap = gap
        numbers = {track.name: i for i, track in enumerate(tracks)}
        links = [tuple(numbers[name] for name in t.subsequent if name != t.name) for t in tracks]
        starts, ends = _nodes(links)
        self.all = tuple(
            Street(
                i,
                t.name,
                t.length,
                t.closed,
                links[i],
                starts[i],
                ends[i],
                self._zone(t.traffic_ranges[0]) if starts[i] >= 0 else 0.0,
                t.length - (self._zone(t.traffic_ranges[1]) if ends[i] >= 0 else 0.0),
            )
            for i, t in enumerate(tracks)
        )
        # By node, for the streets that start there and for those that end there: the largest lead between two movers.
        self._leads: tuple[dict[int, float], dict[int, float]] = (defaultdict(float), defaultdict(float))
        for i, t in enumerate(tracks):
            for leads, node, lead in zip(self._leads, (starts[i], ends[i]), t.leads, strict=True):
                leads[node] = max(leads[node], lead)
        self.before: tuple[tuple[int, ...], ...] = tuple(
            tuple(k for k, behind in enumerate(links) if i in behind) for i in range(len(tracks))
        )
        self._presences: dict[Sweep, tuple[Presence, ...]] = {}
        self._meetings: dict[tuple[Sweep, Sweep], bool] = {}

    def __getitem__(self, index: int) -> Street:
        return self.all[index]

    def _zone(self, reach: float) -> float:
        return max(self.gap, reach) + MARGIN

    # --- from row to row ---

    @cached_property
    def passages(self) -> tuple[tuple[tuple[int, ...], ...], ...]:
        """By street: the routes from its end to the next streets; streets in between have no room for a row."""
        return tuple(tuple(self._passages((street.index,))) for street in self.all)

    def _passages(self, way: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        for k in self[way[-1]].behind:
            if k in way and (k != way[0] or not self[k].has_room):
                continue
            yield (*way, k)
            if not self[k].has_room and len(way) < LONGEST - 1:
                yield from self._passages((*way, k))

    def way_to(
        self,
        target: int,
        closed_off: Collection[int] = (),
        shut: Collection[tuple[int, int]] = (),
    ) -> tuple[list[float], list[int]]:
        """Returns by street the least distance [mm] from its end to the start of the target street, and the next street
        on that route; infinite and -1 if no route leads there. Routes neither pass through streets in `closed_off` nor
        use the passages (from, to) in `shut`."""
        way, after = [math.inf] * len(self.all), [-1] * len(self.all)
        heap = [(0.0, k, target) for k in self.before[target]]
        while heap:
            cost, k, via = heapq.heappop(heap)
            if cost >= way[k] or (k, via) in shut:
                continue
            way[k], after[k] = cost, via
            if k != target and k not in closed_off:
                for previous in self.before[k]:
                    heapq.heappush(heap, (cost + self[k].length, previous, k))
        return way, after

    def is_the_way(self, streets: Sequence[int]) -> bool:
        """True if the engine takes this route by itself from each of these streets to the last one: no other route is
        as short."""
        target = streets[-1]
        if target in streets[:-1] or len(streets) > LONGEST:
            return False
        way = self._ways_to(target)
        for here, there in itertools.pairwise(streets):
            costs = {k: 0.0 if k == target else self[k].length + way[k] for k in self[here].behind}
            if any(costs[k] < costs[there] + SAME for k in costs if k != there):
                return False
        return True

    def _ways_to(self, target: int) -> list[float]:
        if target not in self._open_ways:
            self._open_ways[target] = self.way_to(target)[0]
        return self._open_ways[target]

    @cached_property
    def _open_ways(self) -> dict[int, list[float]]:
        return {}

    # --- conflicts ---

    def length(self, sweep: Sweep) -> float:
        return sum(self[k].length for k in sweep.streets[:-1]) + sweep.end - sweep.start

    def meet(self, a: Sweep, b: Sweep) -> bool:
        """True if two movers, each anywhere on one of the sweeps, may come too near to each other."""
        known = self._meetings.get((a, b))
        if known is None:
            known = self._meetings[a, b] = self._meetings[b, a] = self._meet(a, b)
        return known

    def _meet(self, a: Sweep, b: Sweep) -> bool:
        near = self.gap - SAME
        for street, low, high in self._stretches(a):
            for other, its_low, its_high in self._stretches(b):
                if street == other and max(low, its_low) - min(high, its_high) < near:
                    return True
        return any(
            one.node == two.node and self._near(one, two) for one in self._at_nodes(a) for two in self._at_nodes(b)
        )

    def _near(self, a: Presence, b: Presence) -> bool:
        if max(a.low, b.low) - min(a.high, b.high) < self.gap - SAME:
            return True
        behind, before = (leads[a.node] - SAME for leads in self._leads)
        both_behind = min(a.high, b.high) >= 0 and min(a.to, b.to) >= 0 and a.to != b.to
        both_before = max(a.low, b.low) <= 0 and min(a.come_from, b.come_from) >= 0 and a.come_from != b.come_from
        return (both_behind and max(a.low, b.low, 0.0) - min(a.high, b.high) < behind) or (
            both_before and max(a.low, b.low) - min(a.high, b.high, 0.0) < before
        )

    def _stretches(self, sweep: Sweep) -> Iterator[tuple[int, float, float]]:
        for i, k in enumerate(sweep.streets):
            low = sweep.start if i == 0 else 0.0
            high = sweep.end if i == len(sweep.streets) - 1 else self[k].length
            yield k, min(low, high), max(low, high)

    def _at_nodes(self, sweep: Sweep) -> tuple[Presence, ...]:
        """Returns the intervals of a sweep within the zones of nodes [mm from the node along the route]."""
        if sweep not in self._presences:
            self._presences[sweep] = tuple(self._find_nodes(sweep))
        return self._presences[sweep]

    def _find_nodes(self, sweep: Sweep) -> Iterator[Presence]:
        streets = [self[k] for k in sweep.streets]
        end = sum(street.length for street in streets[:-1]) + sweep.end
        low, high = min(sweep.start, end), max(sweep.start, end)
        if streets[0].start_node >= 0 and low < streets[0].zone_ends:
            yield Presence(streets[0].start_node, low, min(high, streets[0].zone_ends), -1, streets[0].index)
        at = 0.0
        for i, street in enumerate(streets):
            at += street.length
            behind = streets[i + 1].zone_ends if i + 1 < len(streets) else math.inf
            before = street.zone_begins - street.length
            if street.end_node >= 0 and high - at > before and low - at < behind:
                to = streets[i + 1].index if i + 1 < len(streets) else -1
                yield Presence(street.end_node, max(low - at, before), min(high - at, behind), street.index, to)
        # Nodes that a mover on the first street may have passed shortly before still count.
        yield from self._behind(streets[0], low, high, 0)

    def _behind(self, street: Street, low: float, high: float, depth: int) -> Iterator[Presence]:
        for k in self.before[street.index]:
            previous = self[k]
            if previous.start_node >= 0 and low + previous.length < previous.zone_ends and depth < 4:
                to = min(high + previous.length, previous.zone_ends)
                yield Presence(previous.start_node, low + previous.length, to, -1, -1)
                yield from self._behind(previous, low + previous.length, high + previous.length, depth + 1)


def read_streets(session: Session, gap: float, movers: Iterable[Mover] = ()) -> Streets:
    """Returns the tracks of a session's machine file, linked according to the commanded positions of its parts.

    gap: distance between movers [mm].
    movers: the gap is raised to the least one at which these clear each other on all tracks.

    Raises RoutingError if the machine has no tracks, or a track has another length or other links in the engine."""
    layout = TrackLayout(session.machine_text) if session.tracks else None
    if layout is None:
        raise RoutingError("the machine has no tracks")
    layout.place_parts([part.commanded_index for part in session.parts.values()])
    for laid in layout.tracks:
        track = session.track(laid.name)
        links = (len(laid.previous), len(laid.subsequent))
        if abs(laid.length - track.length) > 1e-3 or links != (track.previous_tracks, track.subsequent_tracks):
            raise RoutingError(f"track {laid.name} is not as the machine file has it: ways are planned on its tracks")
    sizes = [(float(m.parameters["width"]), float(m.parameters["height"]), m.c) for m in movers]
    width, height = (max((size[k] for size in sizes), default=0.0) for k in (0, 1))
    for turned in {round(size[2], 6) for size in sizes}:
        gap = layout.clear_gap(width, height, turned, gap)
    return Streets(layout.tracks, gap)


def _nodes(links: Sequence[tuple[int, ...]]) -> tuple[list[int], list[int]]:
    """Returns by street the numbers of the nodes at its start and at its end; -1: no other street meets it there."""
    starts, ends = [-1] * len(links), [-1] * len(links)
    count = 0

    def name(k: int, of: list[int], node: int) -> None:
        if of[k] == node:
            return
        of[k] = node
        if of is ends:
            for other in links[k]:
                name(other, starts, node)
        else:
            for other, behind in enumerate(links):
                if k in behind:
                    name(other, ends, node)

    for k, behind in enumerate(links):
        if behind and ends[k] < 0:
            name(k, ends, count)
            count += 1
    return starts, ends
