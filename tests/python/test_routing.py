"""Ways and orders of passing for many movers at once: all get to their targets, and none waits for ever (PL-26)."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Mapping
from pathlib import Path

import pytest
import takt
from cities import line, machine, point, put_on_tracks, random_city, random_places
from machines import new_url, running
from takt import Engine
from takt.routing.loop import Loop, go_round
from takt.routing.streets import Street, Streets
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
        self._before: set[str] = set()
        self.nearest = math.inf
        engine.program(self.look)

    def look(self) -> None:
        by_track: dict[int, list[float]] = {}
        # Those that set out together, one at its gap behind the other, may say so for one cycle.
        now = {mover.name for mover in self.engine.movers.values() if mover.deadlocked}
        self.deadlocked |= now & self._before
        self._before = now
        for mover in self.engine.movers.values():
            by_track.setdefault(mover.track, []).append(mover.track_position)
        for places in by_track.values():
            places.sort()
            for a, b in itertools.pairwise(places):
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
    with pytest.raises(takt.RoutingError, match="movers cannot overtake"):
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
    with pytest.raises(takt.RoutingError, match="cannot all be reached: every order of passing was tried"):
        takt.plan_routes(engine, {"a": ("line", 1300.0), "b": ("line", 300.0)})
    check(engine, {"a": ("line", 1100.0), "b": ("line", 1700.0)})


@pytest.mark.parametrize(("key", "value"), [("gap", -5.0), ("gap", math.nan), ("velocity", -5.0), ("jerk", 0.0)])
def test_numbers_that_no_move_can_have(key: str, value: float) -> None:
    """They are refused before anything is planned."""
    engine = on_tracks(RING, {"a": ("main", 300.0)})
    with pytest.raises(takt.RoutingError, match=key):
        engine.move_on_tracks({"a": ("main", 1300.0)}, **{key: value})
    engine.step()
    assert engine.mover("a").track_velocity == 0


def test_one_that_is_in_the_way() -> None:
    """It is moved aside if it may be; else it is named."""
    movers = {"a": ("west", 300.0), "b": ("main", 1000.0)}
    targets = {"a": ("main", 1500.0)}
    engine = on_tracks(SIDING, movers)
    here = engine.mover("b").track_position
    with pytest.raises(takt.RoutingError, match="b may not be moved"):
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


def test_turns_on_a_closed_track() -> None:
    """PL-26: a mover alone takes the shorter way round, several together the least travel of all; rounding adds no
    turn."""
    chance = random.Random(3)
    streets = Streets((), 100.0)

    def plan(length: float, starts: list[float], targets: list[float]) -> dict[int, float]:
        names = [f"m{i}" for i in range(len(starts))]
        street = Street(0, "ring", length, True, (), -1, -1, 0.0, length)
        return go_round(Loop(street, dict(enumerate(starts)), dict(enumerate(targets)), {}), streets, names)

    assert plan(2830.052, [2796.136], [54.048]) == {0: pytest.approx(2830.052 + 54.048)}
    for _ in range(2000):
        length, count = round(chance.uniform(2000, 4000), 3), chance.randint(1, 5)
        slot, turned = length / count, chance.uniform(0, length)
        starts, targets = ([k * slot + chance.uniform(0, slot - 101) for k in range(count)] for _ in "ab")
        targets = [(s + turned) % length for s in targets]
        ends = plan(length, starts, targets)
        least = math.inf
        for turn in range(-3, 4):
            there = [targets[0] + turn * length]
            for s in targets[1:]:
                there.append(there[-1] + (s - there[-1]) % length)
            least = min(least, sum(abs(a - b) for a, b in zip(there, starts, strict=True)))
        assert sum(abs(ends[i] - starts[i]) for i in ends) == pytest.approx(least, abs=1e-6)


# --- a ring of four switches ---

STATIONS = f"""  - {{name: west, elements: [{line((1500, 1500), (500, 1500))}, {line((500, 0), (1500, 0))}]}}
  - {{name: south1, starts_from: [west], elements: [{line((1500, 0), (3500, 0))}]}}
  - {{name: east, starts_from: [south1], elements: [{line((3500, 0), (4500, 0))}, {line((4500, 1500), (3500, 1500))}]}}
  - {{name: south2, starts_from: [west], elements: [{line((2200, -700), (2800, -700))}], ends_at: [east]}}
  - {{name: north1, starts_from: [east], elements: [{line((3500, 1500), (1500, 1500))}], ends_at: [west]}}
  - {{name: north2, starts_from: [east], elements: [{line((2800, 2200), (2200, 2200))}], ends_at: [west]}}
"""


def test_a_ring_of_four_switches() -> None:
    """Both ends of a ring with two stations of two tracks each: the movers there are to stand in another order."""
    places = {"west": [1900.0, 1500.0, 1100.0], "east": [1800.0, 1400.0, 1000.0]}
    movers = {f"{track}{k}": (track, s) for track, own in places.items() for k, s in enumerate(own)}
    targets = {
        f"{track}{k}": (track, s) for track, own in places.items() for k, s in enumerate((own[2], own[0], own[1]))
    }
    assert len(naive(on_tracks(STATIONS, movers), targets, 20)) >= 4
    engine = on_tracks(STATIONS, movers)
    plan = takt.plan_routes(engine, targets)
    assert {track for name in movers for track in plan.way(name)} >= {"south1", "south2"} or (
        {track for name in movers for track in plan.way(name)} >= {"north1", "north2"}
    )
    check(engine, targets, timeout=120)


def test_a_roundabout() -> None:
    """Four ways into a ring and four out of it: from each side five movers, three quarters round."""
    length = TrackLayout(f"tracks:\n{roundabout()}").tracks[-1].length
    movers = {f"m{i}{k}": (f"in{i}", 1600.0 - 210 * k) for i in range(4) for k in range(5)}
    targets = {f"m{i}{k}": (f"out{(i + 3) % 4}", length - 10 - 210 * k) for i in range(4) for k in range(5)}
    times = check(on_tracks(roundabout(), movers), targets)
    assert set(times) == set(movers)


def roundabout() -> str:
    """Four tracks in a ring; where one goes on into the next, another one leads in and a third one out."""
    radius = 700.0

    def at(i: int, ahead: float, turned: float = 0.0) -> tuple[float, float]:
        angle = i * math.pi / 2
        tangent = angle + math.pi / 2 - math.copysign(math.radians(turned), ahead)
        x, y = radius * math.cos(angle), radius * math.sin(angle)
        return x + ahead * math.cos(tangent), y + ahead * math.sin(tangent)

    text = ""
    for i in range(4):
        links = (f", starts_from: [side{i - 1}]" if i else "") + (", ends_at: [side0]" if i == 3 else "")
        pieces = f"{line(at(i, 0), at(i, 40))}, {line(at(i + 1, -40), at(i + 1, 0))}"
        text += f"  - {{name: side{i}, elements: [{pieces}]{links}}}\n"
    for i in range(4):
        pieces = f"{line(at(i, -2000, 60), at(i, -600, 60))}, {line(at(i, -40), at(i, 0))}"
        text += f"  - {{name: in{i}, elements: [{pieces}], ends_at: [side{i}]}}\n"
        pieces = f"{line(at(i, 0), at(i, 40))}, {line(at(i, 600, 60), at(i, 2000, 60))}"
        text += f"  - {{name: out{i}, starts_from: [side{(i - 1) % 4}], elements: [{pieces}]}}\n"
    return text


# --- in random networks ---


@pytest.mark.parametrize("seed", range(6))
def test_random_networks(seed: int) -> None:
    """Where movers can get by being sent about at random one after the other, they get at once when planned."""
    rng = random.Random(seed)
    roads = random_city(rng, 24)
    tracks = TrackLayout(machine(roads, [])).tracks
    starts = random_places(rng, list(tracks), Streets(tracks, GAP + 5), 10)
    text = machine(roads, [point(tracks[k], s) for k, s in starts])
    names = [track.name for track in tracks]
    engine = Engine(text)
    put_on_tracks(engine, starts, names)
    targets = wander(rng, engine)
    engine = Engine(text)
    put_on_tracks(engine, starts, names)
    check(engine, targets, may_move=True)


def wander(rng: random.Random, engine: Engine) -> dict[str, tuple[str, float]]:
    """Sends one mover after the other to random places, as far as it gets; where they are in the end."""
    tracks, movers = list(engine.tracks.values()), list(engine.movers.values())
    for _ in range(5 * len(movers)):
        mover, track = rng.choice(movers), rng.choice(tracks)
        move = mover.move_on_track(track=track.name, position=rng.uniform(0, track.length), gap=GAP + 5)
        engine.wait(lambda m=mover, f=move: f.final or (m.waits_for and abs(m.track_velocity) < 1e-3), 30)  # type: ignore[misc]
        if not move.final:  # where it waits is as near to a switch as can be: a little further back
            mover.halt().wait()
            if mover.track_position > 1:
                mover.move_on_track(position=mover.track_position - 1, gap=GAP + 1)
                engine.run(0.3)
                mover.halt().wait()
    return {mover.name: (tracks[mover.track - 1].name, mover.track_position) for mover in movers}


# --- what goes wrong on the way, and what cannot be ---


def test_planned_anew() -> None:
    """One that is halted by somebody else does not end it: all come to rest, and a new plan is made."""
    targets = {"a": ("main", 1300.0), "b": ("main", 300.0)}
    engine = on_tracks(RING, {"a": ("main", 300.0), "b": ("main", 1300.0)})
    halted = []

    @engine.program
    def meddle() -> None:
        if not halted and engine.mover("b").track == 2 and engine.mover("b").track_position > 700:
            halted.append(engine.mover("b").halt())

    check(engine, targets)
    assert halted


def test_broken_down_on_the_way() -> None:
    """All come to rest, and it is said which mover it was."""
    targets = {"a": ("main", 1300.0), "b": ("main", 300.0)}
    engine = on_tracks(RING, {"a": ("main", 300.0), "b": ("main", 1300.0)})
    broken = []

    @engine.program
    def break_down() -> None:
        if not broken and engine.mover("b").track == 2:
            broken.append(engine.mover("b").disable())

    with pytest.raises(takt.RoutingError, match="mover b cannot move along tracks now: Disabl"):
        engine.move_on_tracks(targets)
    engine.run(1)
    assert engine.mover("a").track_velocity == 0


def test_tracks_that_were_changed() -> None:
    """Ways are planned on the tracks of the machine file; if these are others by now, that is said."""
    engine = Engine("name: n\naxes: []\nmovers: [{name: a}]\ntracks: [{name: line}]\n")
    engine.track("line").append_line(start_x=0, start_y=0, end_x=500, end_y=0).wait()
    put_on_tracks(engine, [(0, 0.0)], ["line"])
    with pytest.raises(takt.RoutingError, match="track line is not as the machine file has it"):
        engine.move_on_tracks({"a": ("line", 300.0)})


SWITCH = """
name: t
axes: []
coordinate_systems: [{name: w}]
parts:
  - {name: A, columns: 4, rows: 1, positions: [{coordinate_system: w}]}
  - {name: C, columns: 4, rows: 1, positions: [{coordinate_system: w, y: 1000}]}
  - {name: B, columns: 4, rows: 1, travel_time_s: 0.1,
     positions: [{coordinate_system: w, x: 960}, {coordinate_system: w, x: 960, y: 1000}]}
movers:
  - {name: on_a, reference: A, initial: {x: 120, y: 120}}
  - {name: on_c, reference: C, initial: {x: 120, y: 120}}
tracks:
  - {name: a, part: A, elements: [{from: {x: 70, y: 120}, to: {x: 960, y: 120}}]}
  - {name: c, part: C, elements: [{from: {x: 70, y: 120}, to: {x: 960, y: 120}}]}
  - {name: b, part: B, elements: [{from: {x: 0, y: 120}, to: {x: 800, y: 120}}],
     starts_from_positions: [{track: a, this_position_index: 1}, {track: c, this_position_index: 2}]}
"""


def test_links_are_those_of_parts_where_they_are() -> None:
    """PL-88: the track on a part that moves is linked to another one at each of its positions."""
    with Engine(SWITCH) as engine:
        put_on_tracks(engine, [(0, 0.0), (1, 0.0)], ["a", "c"])
        for index, name, other in ((1, "a", "c"), (2, "c", "a")):
            engine.part("B").activate_position(index=index).wait()
            assert str(takt.plan_routes(engine, {f"on_{name}": ("b", 600)})) == f"on_{name}: {name} > b to 600 mm"
            with pytest.raises(takt.RoutingError, match=f"no way leads from {other} to b"):
                takt.plan_routes(engine, {f"on_{other}": ("b", 600)})
        engine.move_on_tracks({"on_c": ("b", 600)})
        assert engine.mover("on_c").track_position == pytest.approx(600)


def test_links_that_commands_have_made() -> None:
    """PL-88: ways are planned on the tracks of the machine file; those that are linked otherwise by now are named."""
    tracks = "".join(
        f"  - {{name: {name}, elements: [{{from: {{x: {x}, y: 0}}, to: {{x: {x + 500}, y: 0}}}}]}}\n"
        for name, x in (("one", 0), ("two", 500))
    )
    with Engine(f"name: n\naxes: []\nmovers: [{{name: a}}]\ntracks:\n{tracks}") as engine:
        engine.track("two").start_from_track(track="one").wait()
        put_on_tracks(engine, [(0, 0.0)], ["one"])
        with pytest.raises(takt.RoutingError, match="track one is not as the machine file has it"):
            takt.plan_routes(engine, {"a": ("one", 300.0)})


THREE = """
  - {name: main, elements: [{from: {x: 0, y: 0}, to: {x: 1500, y: 0}}]}
  - name: up
    starts_from: [main]
    elements: [{from: {x: 1500, y: 900}, to: {x: 0, y: 900}}]
    ends_at: [main]
  - name: short
    starts_from: [main]
    elements: [{from: {x: 1500, y: 500}, to: {x: 0, y: 500}}]
    ends_at: [main]
"""


@pytest.mark.parametrize("first", [50, 150, 250, 350])
@pytest.mark.parametrize("count", [3, 4])
def test_movers_turn_their_order_round_from_within_a_zone(first: int, count: int) -> None:
    """PL-88: the last one stands in the zone of a switch; it does not get past those before it, so it is no detour to
    go into the row behind them."""
    places = [first + 220.0 * i for i in range(count)]
    names = "abcd"[:count]
    check(
        on_tracks(THREE, {n: ("main", s) for n, s in zip(names, places, strict=True)}),
        {n: ("main", s) for n, s in zip(names, reversed(places), strict=True)},
        timeout=30,
    )


def test_targets_side_by_side_behind_a_switch() -> None:
    """PL-81, PL-88: on two tracks that leave it movers may be a gap apart along the way, and touch all the same."""
    engine = on_tracks(THREE, {"a": ("main", 280.0), "b": ("up", 183.0)})
    with pytest.raises(takt.RoutingError, match="the target of mover a is too near to that of b"):
        takt.plan_routes(engine, {"a": ("short", 0.0), "b": ("up", 219.0)})
    check(engine, {"a": ("short", 100.0), "b": ("up", 600.0)}, timeout=30)


def test_what_is_planned_is_carried_out_within_zones() -> None:
    """PL-88: starts and targets anywhere, also near switches; those that are too near to one another are refused."""
    layout = TrackLayout(f"tracks:\n{THREE}").tracks
    carried_out = 0
    for seed in range(40):
        rng = random.Random(seed)

        def draw(rng: random.Random = rng) -> dict[str, tuple[str, float]]:
            places: list[tuple[str, float]] = []
            while len(places) < 3:
                track = rng.choice(layout)
                s = rng.choice([rng.uniform(0, 300), rng.uniform(0, track.length), track.length - rng.uniform(0, 300)])
                if all(track.name != other or abs(s - at) > 225 for other, at in places):
                    places.append((track.name, s))
            return dict(zip("abc", places, strict=True))

        try:
            engine = on_tracks(THREE, draw())
            plan = takt.plan_routes(engine, draw())
        except takt.TaktError:
            continue
        takt.Journey(engine, plan).wait(60)
        carried_out += 1
    assert carried_out >= 12


@pytest.mark.parametrize("size", [60, 100])
def test_routes_keep_the_gap_that_bends_take(size: float) -> None:
    """PL-88: a gap that movers could touch with in a bend is a larger one, for the plan as well."""
    movers = {"a": ("main", 300.0), "b": ("main", 800.0), "c": ("up", 1500.0), "d": ("short", 1200.0)}
    layout = {track.name: track for track in TrackLayout(f"tracks:\n{THREE}").tracks}
    lines = []
    for name, (track, s) in movers.items():
        x, y = point(layout[track], s)
        own = f"name: {name}, gap: {1.2 * size}, width: {size}, height: {size}"
        lines.append(f"  - {{{own}, initial: {{x: {x:.9f}, y: {y:.9f}}}}}")
    engine = Engine("name: r\naxes: []\nmovers:\n" + "\n".join(lines) + f"\ntracks:\n{THREE}")
    names = list(layout)
    put_on_tracks(engine, [(names.index(track), s) for track, s in movers.values()], names)
    engine.move_on_tracks({"a": ("main", 800.0), "b": ("main", 300.0)}, may_move=True, timeout=30)
    assert [engine.mover(n).track_position for n in "ab"] == pytest.approx([800.0, 300.0])


def test_a_machine_as_a_dict() -> None:
    """PL-02, PY-01: as good as its text."""
    line = {"name": "line", "elements": [{"from": {"x": 0, "y": 0}, "to": {"x": 500, "y": 0}}]}
    engine = Engine({"name": "n", "axes": [], "movers": [{"name": "a"}], "tracks": [line]})
    put_on_tracks(engine, [(0, 0.0)], ["line"])
    engine.move_on_tracks({"a": ("line", 300.0)})
    assert engine.mover("a").x == pytest.approx(300.0)


def test_bad_requests() -> None:
    """PL-02."""
    engine = on_tracks(RING, {"a": ("main", 300.0), "b": ("main", 1300.0)})
    with pytest.raises(takt.TaktError, match="no mover 'c'"):
        engine.move_on_tracks({"c": ("main", 1.0)})
    with pytest.raises(takt.TaktError, match="no track 'mian'; did you mean 'main'"):
        engine.move_on_tracks({"a": ("mian", 1.0)})
    with pytest.raises(takt.RoutingError, match="from 0 to 2000 mm, not to 2001"):
        engine.move_on_tracks({"a": ("main", 2001.0)})
    with pytest.raises(takt.RoutingError, match="target of mover a is too near to that of b for a gap of 200 mm"):
        engine.move_on_tracks({"a": ("main", 1000.0), "b": ("main", 1150.0)})
    with pytest.raises(takt.RoutingError, match="target of mover a is too near to where b stands"):
        engine.move_on_tracks({"a": ("main", 1150.0)})
    with pytest.raises(TypeError, match="may_move is a list of names, not the text 'b'"):
        engine.move_on_tracks({"a": ("main", 900.0)}, may_move="b")
    with pytest.raises(ValueError, match="auto, shortest"):
        engine.move_on_tracks({"a": ("main", 1.0)}, route="best")  # type: ignore[arg-type]
    assert set(engine.move_on_tracks({"a": ("main", 900.0)}, route="shortest")) == {"a"}
    leaving = engine.mover("b").leave_track(x=1300, y=-500)
    engine.step()
    with pytest.raises(takt.RoutingError, match="b is in motion"):
        engine.move_on_tracks({"a": ("main", 800.0)})
    leaving.wait()
    with pytest.raises(takt.RoutingError, match="b is on no track"):
        engine.move_on_tracks({"b": ("main", 1.0)})
    with pytest.raises(TypeError, match="velocity, acceleration, deceleration, jerk, not speed"):
        engine.move_on_tracks({"a": ("main", 1.0)}, speed=1)


def test_over_lcm(tmp_path: Path) -> None:
    """The same against taktd."""
    url = new_url()
    engine = on_tracks(RING, {"a": ("main", 300.0), "b": ("main", 1300.0)})
    with running(tmp_path, url, machine=engine.machine_text), takt.connect(url) as session:
        put_on_tracks(session, [(0, 300.0), (0, 1300.0)], ["main", "back"])
        times = session.move_on_tracks({"a": ("main", 1300.0), "b": ("main", 300.0)})
        assert session.mover("b").track_position == pytest.approx(300, abs=1e-6)
    assert 1 < times["b"] < 10


def test_the_same_each_time() -> None:
    """Plans depend on nothing but what they are made of: two engines, one story, the same to the last bit."""
    hashes = []
    for _ in range(2):
        engine = on_tracks(RING, {"a": ("main", 300.0), "b": ("main", 1300.0)})
        engine.move_on_tracks({"a": ("main", 1300.0), "b": ("main", 300.0)})
        hashes.append(engine.state_hash)
    assert hashes[0] == hashes[1]
