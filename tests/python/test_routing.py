"""Ways and orders of passing for many movers at once: all get to their targets, and none waits for ever (PL-26)."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
import takt
from cities import line, machine, point, put_on_tracks, random_city, random_places
from machines import new_url, running
from takt import Engine
from takt.routing.streets import Streets
from takt.track_layout import TrackLayout

GAP = 200.0


def on_tracks(tracks: str, movers: Mapping[str, tuple[str, float]]) -> Engine:
    """An engine with movers that stand there."""
    layout = {track.name: track for track in TrackLayout(f"tracks:\n{tracks}").tracks}
    text = "name: routing\naxes: []\nmovers:\n"
    for name, (track, s) in movers.items():
        x, y = point(layout[track], s)
        text += f"  - {{name: {name}, initial: {{x: {x:.9f}, y: {y:.9f}}}}}\n"
    engine = Engine(f"{text}tracks:\n{tracks}")
    names = list(layout)
    put_on_tracks(engine, [(names.index(track), s) for track, s in movers.values()], names)
    return engine


class Watch:
    """What must hold in every cycle: nobody is deadlocked, and on one track movers keep their gap."""

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self.deadlocked: set[str] = set()
        self.nearest = math.inf
        engine.program(self.look)

    def look(self) -> None:
        by_track: dict[int, list[float]] = {}
        for mover in self.engine.movers.values():
            if mover.deadlocked:
                self.deadlocked.add(mover.name)
            by_track.setdefault(mover.track, []).append(mover.track_position)
        for places in by_track.values():
            places.sort()
            for a, b in zip(places, places[1:], strict=False):
                self.nearest = min(self.nearest, b - a)


def check(engine: Engine, targets: Mapping[str, tuple[str, float]], **options: object) -> dict[str, float]:
    """Goes there, and all is well."""
    watch = Watch(engine)
    times = engine.move_on_tracks(targets, **options)  # type: ignore[arg-type]
    names = list(engine.tracks)
    for name, (track, s) in targets.items():
        mover = engine.mover(name)
        assert (names[mover.track - 1], mover.track_position) == (track, pytest.approx(s, abs=1e-6))
    assert not watch.deadlocked
    assert watch.nearest > GAP - 1e-6
    return times


def naive(engine: Engine, targets: Mapping[str, tuple[str, float]], duration: float) -> set[str]:
    """Each its shortest way at once: who waits for ever."""
    for name, (track, s) in targets.items():
        engine.mover(name).move_on_track(track=track, position=s)
    engine.run(duration)
    return {name for name, mover in engine.movers.items() if mover.deadlocked}


# --- closed loops ---

CIRCLE = """  - name: loop
    closed_loop: true
    elements:
      - {from: {x: 0, y: 0}, to: {x: 600, y: 0}}
      - {from: {x: 600, y: 800}, to: {x: 0, y: 800}}
"""


def test_a_loop_with_one_place_left() -> None:
    """All but one place are taken, and each mover goes to the next: the order round the loop is kept."""
    length = TrackLayout(f"tracks:\n{CIRCLE}").tracks[0].length
    count = math.floor(length / GAP)
    assert count > 10
    room = length / count
    places = [room * i + 1 for i in range(count)]
    names = [f"m{i}" for i in range(count - 1)]
    engine = on_tracks(CIRCLE, {name: ("loop", places[i]) for i, name in enumerate(names)})
    check(engine, {name: ("loop", places[(i + 1) % count]) for i, name in enumerate(names)})
    # And all of them once more, so that one goes over the place where the loop is closed.
    check(engine, {name: ("loop", places[(i + 2) % count]) for i, name in enumerate(names)})
    swapped = {"m0": ("loop", engine.mover("m1").track_position), "m1": ("loop", engine.mover("m0").track_position)}
    with pytest.raises(takt.RoutingError, match="nobody overtakes"):
        engine.move_on_tracks(swapped, may_move=True)


# --- a line with a siding, and back to its start ---

SIDING = f"""  - {{name: west, elements: [{line((0, 0), (1500, 0))}]}}
  - {{name: main, starts_from: [west], elements: [{line((1500, 0), (3500, 0))}]}}
  - {{name: siding, starts_from: [west], elements: [{line((2100, 400), (2900, 400))}], ends_at: []}}
  - name: back
    starts_from: [main]
    elements: [{line((3500, 0), (4500, 0))}, {line((4500, 1400), (0, 1400))}]
    ends_at: [west]
""".replace(", ends_at: []", "")
RING = f"""  - {{name: main, elements: [{line((0, 0), (2000, 0))}]}}
  - {{name: back, starts_from: [main], elements: [{line((2000, 900), (0, 900))}], ends_at: [main]}}
"""


def test_face_to_face() -> None:
    """Two on one track that want past each other: one goes on and round, and comes in behind the other."""
    movers = {"a": ("main", 300.0), "b": ("main", 1300.0)}
    targets = {"a": ("main", 1300.0), "b": ("main", 300.0)}
    assert naive(on_tracks(RING, movers), targets, 5) == {"a", "b"}
    engine = on_tracks(RING, movers)
    plan = takt.plan_routes(engine, targets)
    assert plan.way("b") == ["main", "back", "main"]
    assert plan.way("a") == ["main"]
    assert str(plan) == "a: main to 1300 mm\nb: main > back > main to 300 mm"
    before = engine.state_hash
    takt.plan_routes(engine, targets)
    assert engine.state_hash == before
    times = check(engine, targets)
    assert times["a"] < times["b"] < 10


def test_no_way_past_each_other() -> None:
    """The same on a track that leads nowhere: that is found out, and said."""
    tracks = f"  - {{name: line, elements: [{line((0, 0), (2000, 0))}]}}\n"
    engine = on_tracks(tracks, {"a": ("line", 300.0), "b": ("line", 1300.0)})
    with pytest.raises(takt.RoutingError, match="every order of passing was tried"):
        takt.plan_routes(engine, {"a": ("line", 1300.0), "b": ("line", 300.0)})
    check(engine, {"a": ("line", 1100.0), "b": ("line", 1700.0)})


def test_one_that_is_in_the_way() -> None:
    """It is moved aside if it may be; else it is named."""
    movers = {"a": ("west", 300.0), "b": ("main", 1000.0)}
    targets = {"a": ("main", 1500.0)}
    engine = on_tracks(SIDING, movers)
    here = engine.mover("b").track_position
    with pytest.raises(takt.RoutingError, match="b may not be moved|; b may not be moved"):
        engine.move_on_tracks(targets)
    engine.run(0.1)
    assert (engine.mover("a").track_velocity, engine.mover("b").track_position) == (0, here)
    plan = takt.plan_routes(engine, targets, may_move=["b"])
    assert plan.moved_aside == ["b"]
    check(engine, targets, may_move=["b"])
    assert engine.mover("b").track_position >= 1700 - 1e-6 or engine.mover("b").track == 4
    engine = on_tracks(SIDING, movers)
    with pytest.raises(takt.RoutingError, match="b on the way to back may not be moved"):
        takt.plan_routes(engine, {"a": ("back", 1500.0)})
    check(engine, {"a": ("back", 1500.0)}, may_move=True)


# --- a ring of four switches ---


def square() -> str:
    """Four tracks round a square, and at each corner one that leads in and one that leads out."""
    corners = [(0, 0), (2400, 0), (2400, 2400), (0, 2400)]
    along = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    text = ""
    for i, ((x, y), (u, v)) in enumerate(zip(corners, along, strict=True)):
        a, b = (x + 300 * u, y + 300 * v), (x + 2100 * u, y + 2100 * v)
        last = ", ends_at: [side0]" if i == 3 else ""
        first = f", starts_from: [side{i - 1}]" if i else ""
        text += f"  - {{name: side{i}{first}, elements: [{line(a, b)}]{last}}}\n"
    for i, ((x, y), (u, v)) in enumerate(zip(corners, along, strict=True)):
        a = (x + 2700 * u, y + 2700 * v)
        b = (x + 3700 * u, y + 3700 * v)
        text += f"  - {{name: out{i}, starts_from: [side{i}], elements: [{line(a, b)}]}}\n"
    return text


def test_a_ring_of_four_switches() -> None:
    """The ring is full of movers that want to the other side of it: each waits for the next, unless they are planned."""
    layout = TrackLayout(f"tracks:\n{square()}").tracks
    streets = Streets(layout, GAP)
    movers, targets = {}, {}
    for i in range(4):
        side = streets[i]
        count = math.floor((side.last - side.first) / GAP) + 1
        for k in range(count):
            name = f"m{i}{k}"
            movers[name] = (f"side{i}", side.first + GAP * k + 0.1 * k)
            targets[name] = (f"out{(i + 2) % 4}", streets[4 + (i + 2) % 4].last - (GAP + 1) * k)
        while targets[name][1] < streets[4].first:
            del targets[name]
            name = f"m{i}{int(name[2:]) - 1}"
    deadlocked = naive(on_tracks(square(), movers), targets, 20)
    assert len(deadlocked) >= 4
    engine = on_tracks(square(), movers)
    check(engine, targets, may_move=True, timeout=120)
