"""Random networks of tracks with merges, splits and rings, and movers on them; for tests of traffic and of ways."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import takt
from takt.routing.streets import Streets, Sweep
from takt.track_layout import LaidTrack, TrackLayout

Array = npt.NDArray[np.float64]
SIZE = 100.0  # mm, of movers
REACH = math.hypot(SIZE, SIZE)  # between centres: nearer than this they may touch
CORNER = 150.0  # mm, least radius


@dataclass(frozen=True)
class Crossing:
    x: float
    y: float
    angle: float

    def ahead(self, way: float) -> tuple[float, float]:
        return self.x + way * math.cos(self.angle), self.y + way * math.sin(self.angle)


@dataclass(frozen=True)
class Road:
    start: int  # crossings
    end: int
    elements: str
    laid: LaidTrack

    @property
    def places(self) -> Array:
        return np.stack((self.laid.points.x, self.laid.points.y), axis=1)[::8]


def line(a: tuple[float, float], b: tuple[float, float]) -> str:
    return f"{{from: {{x: {a[0]:.12f}, y: {a[1]:.12f}}}, to: {{x: {b[0]:.12f}, y: {b[1]:.12f}}}}}"


def random_city(rng: random.Random, count: int, side: int = 4) -> list[Road]:
    """Tracks between random crossings; movers on two of them can only touch where these meet."""
    crossings = [
        Crossing(900 * x + rng.uniform(-100, 100), 900 * y + rng.uniform(-100, 100), rng.uniform(-math.pi, math.pi))
        for x in range(side)
        for y in range(side)
    ]
    roads: list[Road] = []
    for _ in range(40 * count):
        if len(roads) == count:
            break
        start, end = rng.sample(range(len(crossings)), 2)
        a, b = crossings[start], crossings[end]
        if math.hypot(a.x - b.x, a.y - b.y) > 1500:
            continue
        elements = ", ".join(
            (line((a.x, a.y), a.ahead(rng.uniform(50, 200))), line(b.ahead(-rng.uniform(50, 200)), (b.x, b.y)))
        )
        try:
            laid = TrackLayout(
                f"tracks:\n  - {{name: r, mover_width: {SIZE}, mover_height: {SIZE}, elements: [{elements}]}}\n"
            ).tracks[0]
        except takt.ConfigError:
            continue
        road = Road(start, end, elements, laid)
        if laid.length > 3000 or laid.smallest_radius < CORNER:
            continue
        if all(_go_together(road, other) and _go_together(other, road) for other in roads):
            roads.append(road)
    return _linked(roads)


def _go_together(a: Road, b: Road) -> bool:
    """Movers come too near to each other only from a common start, or to a common end, on; or where one goes on as the
    other."""
    distance = np.sqrt(((a.places[:, None, :] - b.places[None, :, :]) ** 2).sum(axis=2)).min(axis=1)
    near = distance < REACH + 20
    if not near.any():
        return True
    edges = np.flatnonzero(np.diff(np.concatenate(([0], near.astype(int), [0]))))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        at_start = first == 0 and a.start in (b.start, b.end)
        at_end = last == len(near) and a.end in (b.start, b.end)
        if (not at_start and not at_end) or last - first > 0.6 * len(near):
            return False
    return True


def _linked(roads: list[Road]) -> list[Road]:
    """Without those that only start, or only end, where others do: nobody would see to them."""
    while True:
        starts, ends = [r.start for r in roads], [r.end for r in roads]
        good = [
            r
            for r in roads
            if (starts.count(r.start) == 1 or r.start in ends) and (ends.count(r.end) == 1 or r.end in starts)
        ]
        if len(good) == len(roads):
            return roads
        roads = good


def machine(roads: list[Road], places: list[tuple[float, float]]) -> str:
    """The machine file, with movers at these places."""
    text = "name: city\naxes: []\nmovers:\n"
    for i, (x, y) in enumerate(places):
        text += f"  - {{name: m{i}, width: {SIZE}, height: {SIZE}, initial: {{x: {x:.9f}, y: {y:.9f}}}}}\n"
    if not places:
        text = text.replace("movers:\n", "")
    text += "tracks:\n"
    for i, r in enumerate(roads):
        before = [f"t{k}" for k in range(i) if roads[k].end == r.start]
        behind = [f"t{k}" for k in range(i) if roads[k].start == r.end]
        links = (f", starts_from: [{', '.join(before)}]" if before else "") + (
            f", ends_at: [{', '.join(behind)}]" if behind else ""
        )
        text += f"  - {{name: t{i}, mover_width: {SIZE}, mover_height: {SIZE}, elements: [{r.elements}]{links}}}\n"
    return text


def random_places(rng: random.Random, tracks: list[LaidTrack], streets: Streets, count: int) -> list[tuple[int, float]]:
    """Places on tracks where movers can stand at a time, as many of them as are found."""
    places: list[tuple[int, float]] = []
    lengths = [track.length for track in tracks]
    for _ in range(60 * count):
        if len(places) == count:
            break
        k = rng.choices(range(len(tracks)), lengths)[0]
        s = rng.uniform(0, lengths[k])
        if not any(streets.meet(Sweep((k,), s, s), Sweep((i,), at, at)) for i, at in places):
            places.append((k, s))
    return places


def point(track: LaidTrack, s: float) -> tuple[float, float]:
    p = track.points
    return float(np.interp(s, p.s, p.x)), float(np.interp(s, p.s, p.y))


def put_on_tracks(engine: takt.Session, starts: list[tuple[int, float]], names: list[str]) -> None:
    """Enables all, and lets each mover join its track where it is."""
    everything = [*engine.tracks.values(), *engine.movers.values()]
    for feedback in [one.enable() for one in everything]:
        feedback.wait()
    joins = [mover.join_track(track=names[k]) for mover, (k, _) in zip(engine.movers.values(), starts, strict=True)]
    for feedback in joins:
        feedback.wait()
