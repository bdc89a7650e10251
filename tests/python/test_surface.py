"""Routes on the free surface for many movers at once: all get there, without a collision or a deadlock (PL-72)."""

from __future__ import annotations

import math
import os
import random
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine

PITCH = 120.0
SIDE = 113.0
XY = "xy: {maximum: {velocity: 2000, acceleration: 10000, jerk: 200000}}"
Cell = tuple[int, int]
LONG = bool(os.environ.get("TAKT_LONG"))


def at(cell: Cell) -> tuple[float, float]:
    return PITCH * (cell[0] + 0.5), PITCH * (cell[1] + 0.5)


def machine(starts: Mapping[str, Cell], stators: list[Cell], extra: str = "") -> str:
    movers = "".join(
        f"  - {{name: {name}, width: {SIDE}, height: {SIDE}, initial: {{x: {at(cell)[0]}, y: {at(cell)[1]}}}, {XY}}}\n"
        for name, cell in starts.items()
    )
    floor = ", ".join(f"{{x: {240 * x}, y: {240 * y}}}" for x, y in stators)
    return f"name: surface\naxes: []\nmovers:\n{movers}environments:\n  - {{name: floor, stators: [{floor}]}}\n{extra}"


def engine_of(starts: Mapping[str, Cell], stators: list[Cell], extra: str = "") -> Engine:
    engine = Engine(machine(starts, stators, extra))
    for feedback in [mover.enable() for mover in engine.movers.values()]:
        feedback.wait()
    return engine


def square(side: int) -> list[Cell]:
    return [(x, y) for x in range(side) for y in range(side)]


def random_world(side: int, count: int, seed: int) -> tuple[dict[str, Cell], dict[str, tuple[float, float]]]:
    """Movers on `side` by `side` stators, and a target for each."""
    chance = random.Random(seed)
    cells = square(2 * side)
    starts = dict(zip((f"m{i}" for i in range(count)), chance.sample(cells, count), strict=True))
    targets = {name: at(cell) for name, cell in zip(starts, chance.sample(cells, count), strict=True)}
    return starts, targets


class Watch:
    """No two movers overlap in any cycle."""

    def __init__(self, engine: Engine) -> None:
        self.movers = list(engine.movers.values())
        self.overlaps: set[tuple[str, str]] = set()
        engine.program(self.look)

    def look(self) -> None:
        x, y = (np.array([getattr(m, of) for m in self.movers]) for of in "xy")
        level = np.array([m.coordinate_system for m in self.movers])
        near = np.maximum(np.abs(x[:, None] - x), np.abs(y[:, None] - y)) < SIDE - 1e-6
        near &= level[:, None] == level
        for i, k in zip(*np.nonzero(np.triu(near, 1)), strict=True):
            self.overlaps.add((self.movers[i].name, self.movers[k].name))


def check(engine: Engine, plan: takt.SurfacePlan) -> takt.SurfaceJourney:
    """Is carried out, and all is well."""
    watch = Watch(engine)
    journey = takt.SurfaceJourney(engine, plan).wait()
    for name, (x, y) in plan.targets.items():
        mover = engine.mover(name)
        assert (mover.x, mover.y) == (pytest.approx(x, abs=1e-6), pytest.approx(y, abs=1e-6))
    assert not watch.overlaps
    return journey


# --- plans that are carried out ---


def in_a_group(starts: Mapping[str, Cell], stators: list[Cell], more: str = "") -> Engine:
    """All movers in a group that is enabled."""
    group = f"planar_groups: [{{name: cell, movers: [{', '.join(starts)}], environment: floor{more}}}]\n"
    engine = engine_of(starts, stators, group)
    engine.planar_group("cell").enable().wait()
    return engine


@pytest.mark.parametrize(("count", "more"), [(24, ""), (40, ""), (24, ", moves_wait: true")])
def test_routes_are_carried_out_in_an_enabled_group(count: int, more: str) -> None:
    """PL-30, PL-72: movers are sent only into what others have left, so their group refuses none of their commands."""
    starts, targets = random_world(4, count, count)
    engine = in_a_group(starts, square(4), more)
    check(engine, takt.plan_surface(engine, targets, effort=300))
    errors = {record.error_id for mover in engine.movers.values() for record in mover.history()}
    assert errors == {0}


@pytest.mark.parametrize("seed", range(10) if LONG else [7])
def test_what_waiting_does_not_solve_is_solved_by_routes(seed: int) -> None:
    """PL-72: what docs/planar_groups.md says of 50 movers on 64 places in ten worlds, told at once and by `route`."""
    starts, targets = random_world(4, 50, seed)
    engine = in_a_group(starts, square(4), ", moves_wait: true")
    moves = [engine.mover(name).move_to_position(x=x, y=y) for name, (x, y) in targets.items()]
    engine.run(5)
    assert not any(move.error for move in moves)
    assert sum(move.done for move in moves) <= 2
    assert sum(mover.deadlocked for mover in engine.movers.values()) >= 2
    engine = in_a_group(starts, square(4), ", moves_wait: true")
    start = engine.now
    order = engine.route(targets).wait()
    assert len(order.arrived_s) == 50
    assert 17 < engine.now - start < 28


def test_orders_are_carried_out_in_an_enabled_group() -> None:
    """PL-72: with others sent after them, and one that is halted in the middle of it."""
    starts, targets = random_world(3, 12, 5)
    engine = in_a_group(starts, square(3))
    watch = Watch(engine)
    order = engine.route(targets)
    engine.run(0.2)
    again = engine.route({name: at(starts[name]) for name in ("m0", "m1")})
    engine.run(0.3)
    engine.mover("m2").halt().wait()
    engine.wait(lambda: order.done and again.done, 30)
    assert {"m0", "m1"} <= set(order.failed) <= {"m0", "m1", "m2"}
    assert set(again.arrived_s) == {"m0", "m1"}
    assert not watch.overlaps


@pytest.mark.parametrize("count", [10, 20, 30, 38])
def test_random_targets_are_reached_without_a_collision(count: int) -> None:
    """And when it was planned."""
    starts, targets = random_world(4, count, count)
    engine = engine_of(starts, square(4))
    plan = takt.plan_surface(engine, targets)
    assert plan.lower_bound_s <= plan.sum_s <= plan.first_sum_s
    journey = check(engine, plan)
    assert sum(journey.arrived_s.values()) < 1.01 * plan.sum_s


@pytest.mark.parametrize("how", ["emergency stop", "held", "stop_all", "disable"])
def test_stops_in_the_middle_of_a_journey(how: str) -> None:
    """All come to rest apart, nothing goes on by itself, and once they can move again `wait` ends the journey."""
    starts, targets = random_world(3, 20, 4)
    engine = engine_of(starts, square(3))
    plan = takt.plan_surface(engine, targets)
    for share in (0.1, 0.35, 0.6):
        engine = engine_of(starts, square(3))
        watch, journey = Watch(engine), takt.SurfaceJourney(engine, plan)
        due = engine.now + share * plan.duration_s
        engine.wait(lambda due=due, engine=engine, journey=journey: journey.scan() or engine.now > due)
        held = None
        if how == "stop_all":
            engine.stop_all()
        elif how == "disable":
            for mover in engine.movers.values():
                mover.disable()
        else:
            held = engine.emergency_stop(hold=how == "held")
        with pytest.raises(takt.RoutingError):
            journey.wait()
        engine.run(0.5)
        stand = [(m.x, m.y) for m in engine.movers.values()]
        if how == "held":
            assert all(m.enable().wait_final().error for m in engine.movers.values())
            assert held is not None
            held.release()
        engine.run(0.5)
        assert [(m.x, m.y) for m in engine.movers.values()] == stand
        for mover in engine.movers.values():
            mover.reset().wait()
            mover.enable().wait()
        journey.wait()
        assert not watch.overlaps
        assert {n: (engine.mover(n).x, engine.mover(n).y) for n in targets} == {
            n: pytest.approx(at_, abs=1e-6) for n, at_ in targets.items()
        }


@pytest.mark.parametrize("seed", range(20 if LONG else 3))
def test_a_program_that_looks_now_and_then(seed: int) -> None:
    """Commands come late, each by another time: all get there, behind one another, without a collision."""
    starts, targets = random_world(4, 28, seed)
    engine = engine_of(starts, square(4))
    plan = takt.plan_surface(engine, targets, effort=1000)
    watch = Watch(engine)
    journey = takt.SurfaceJourney(engine, plan)
    chance = random.Random(seed)
    while not journey.scan():
        engine.run(chance.choice([0.001, 0.001, 0.02, 0.08]))
        assert engine.now - journey.started_s < 4 * plan.duration_s + 10
    assert not watch.overlaps


def test_three_quarters_of_the_places_are_filled() -> None:
    starts, targets = random_world(2, 12, 1)
    engine = engine_of(starts, square(2))
    check(engine, takt.plan_surface(engine, targets, effort=1000))


def test_movers_change_places_over_a_siding_round_a_hole() -> None:
    """A ring of stators round one that is missing: two movers that meet in it."""
    ring = [cell for cell in square(3) if cell != (1, 1)]
    engine = engine_of({"a": (0, 0), "b": (5, 5)}, ring)
    plan = takt.plan_surface(engine, {"a": at((5, 5)), "b": at((0, 0))})
    hole = [place for place, free in enumerate(plan.raster.free) if not free]
    assert len(hole) == 4
    assert not {visit.place for visits in plan.visits for visit in visits} & set(hole)
    check(engine, plan)
    assert set(engine.move_on_surface({"a": at((0, 5))})) == {"a"}


def test_interchangeable_targets_go_to_whom_they_suit() -> None:
    starts, targets = random_world(3, 12, 4)
    engine = engine_of(starts, square(3))
    labelled = takt.plan_surface(engine, targets)
    plan = takt.plan_surface(engine, list(targets.values()))
    assert plan.sum_s < 0.8 * labelled.sum_s
    assert plan.lower_bound_s <= plan.sum_s < 1.3 * plan.lower_bound_s
    assert sorted(plan.targets.values()) == sorted(targets.values())
    check(engine, plan)


def test_movers_that_stand_are_gone_round_or_moved_aside() -> None:
    column = [(0, y) for y in range(3)]  # two places wide
    starts = {"a": (0, 0), "b": (0, 2), "c": (1, 2)}
    engine = engine_of(starts, column)
    target = {"a": at((0, 5))}
    with pytest.raises(takt.RoutingError, match=r"mover a: no way leads .* \(b, c may not be moved\)"):
        takt.plan_surface(engine, target)
    plan = takt.plan_surface(engine, target, may_move=["c"])
    assert plan.moved_aside == ("c",)
    check(engine, plan)
    # The other way round nobody has to make room.
    assert takt.plan_surface(engine, {"a": at((0, 4))}, may_move=True).moved_aside == ()


def test_after_a_halt_the_journey_goes_on() -> None:
    """Who is late holds up those behind it, and the order stays good."""
    starts, targets = random_world(3, 14, 2)
    engine = engine_of(starts, square(3))
    plan = takt.plan_surface(engine, targets)
    journey = takt.SurfaceJourney(engine, plan)
    watch = Watch(engine)
    chance = random.Random(5)
    halted = 0
    while halted < 5:
        due = engine.now + chance.uniform(0.05, 0.2)
        engine.wait(lambda due=due: journey.scan() or engine.now > due)
        moving = [m for m in engine.movers.values() if math.hypot(m.velocity_x, m.velocity_y) > 1]
        if moving:
            chance.choice(moving).halt()
            halted += 1
            with pytest.raises(takt.RoutingError, match="does not go its way any more"):
                journey.wait()
            engine.run(0.3)
    journey.wait()
    assert not watch.overlaps
    for name, (x, y) in targets.items():
        assert math.dist((engine.mover(name).x, engine.mover(name).y), (x, y)) < 1e-6


def test_a_mover_that_fails_is_named_and_the_others_rest_in_places() -> None:
    engine = engine_of({"a": (0, 0), "b": (0, 3)}, square(2))
    journey = takt.SurfaceJourney(engine, takt.plan_surface(engine, {"a": at((3, 0)), "b": at((3, 3))}))
    engine.wait(lambda: journey.scan() or engine.mover("a").x > 150)
    engine.mover("a").disable()
    with pytest.raises(takt.RoutingError, match="mover a is Disabling on its way"):
        journey.wait()
    engine.run(1)
    assert (engine.mover("b").x - 60) % PITCH == pytest.approx(0, abs=1e-6)
    engine.mover("a").enable().wait()
    journey.wait()
    assert (engine.mover("a").x, engine.mover("a").y) == pytest.approx(at((3, 0)), abs=1e-6)


def sent_ahead() -> tuple[Engine, takt.SurfaceJourney]:
    """b crosses the way of a, which is sent over the crossing ahead by time."""
    dynamics = {"maximum": {"velocity": 1000, "acceleration": 5000, "jerk": 100000}}
    movers = [
        {"name": name, "width": SIDE, "height": SIDE, "xy": dynamics, "initial": {"x": at(cell)[0], "y": at(cell)[1]}}
        for name, cell in (("a", (2, 13)), ("b", (0, 1)))
    ]
    stators = [{"x": 240 * x, "y": 240 * y} for x in range(3) for y in range(7)]
    engine = Engine(
        {"name": "s", "axes": [], "movers": movers, "environments": [{"name": "floor", "stators": stators}]}
    )
    for feedback in [engine.mover("a").enable(), engine.mover("b").enable()]:
        feedback.wait()
    return engine, takt.SurfaceJourney(engine, takt.plan_surface(engine, {"a": at((2, 0)), "b": at((5, 1))}))


def test_a_mover_that_was_sent_ahead_by_time_rests_where_it_is_its_turn() -> None:
    """PL-72: one that passes first fails; the other stops in the next place, and stays there when its way is free."""
    engine, journey = sent_ahead()
    a, b = engine.mover("a"), engine.mover("b")
    engine.wait(lambda: journey.scan() or engine.now > 0.3)
    b.disable()
    with pytest.raises(takt.RoutingError, match="mover b is Disabling on its way"):
        journey.wait()
    engine.run(3)
    rest = a.x, a.y
    assert rest == pytest.approx(at((2, 10)), abs=1e-6)
    b.enable().wait()
    x, y = at((5, 1))
    b.move_to_position(x=x, y=y).wait()
    engine.run(1)
    assert (a.x, a.y) == rest


@pytest.mark.parametrize("interrupted", [False, True])
def test_a_journey_that_is_not_waited_for_any_more_rests_where_it_is_its_turn(interrupted: bool) -> None:
    """PL-72: the time allowed is over, or the wait is broken off: no mover goes on by time alone; `wait` continues."""
    engine, journey = sent_ahead()
    a, b = engine.mover("a"), engine.mover("b")
    if interrupted:
        scan = journey.scan

        def interrupt() -> bool:
            if engine.now > 0.3:
                raise KeyboardInterrupt
            return scan()

        journey.scan = interrupt  # type: ignore[method-assign]
        with pytest.raises(KeyboardInterrupt):
            journey.wait()
        journey.scan = scan  # type: ignore[method-assign]
    else:
        with pytest.raises(takt.TimeoutError, match=r"not there within 0\.3 s: a, b"):
            journey.wait(0.3)
    b.halt().wait()
    engine.run(3)
    assert (a.x, a.y) == pytest.approx(at((2, 10)), abs=1e-6)
    journey.wait()
    assert (a.x, a.y) == pytest.approx(at((2, 0)), abs=1e-6)
    assert (b.x, b.y) == pytest.approx(at((5, 1)), abs=1e-6)


def test_the_same_plan_each_time() -> None:
    starts, targets = random_world(3, 12, 8)
    plans = [takt.plan_surface(engine_of(starts, square(3)), targets) for _ in range(2)]
    assert plans[0].legs == plans[1].legs
    assert plans[0].visits == plans[1].visits


def test_the_effort_grows_with_the_movers() -> None:
    """PL-72: unless it is given; with few movers it is 3,000."""
    for count, effort in ((4, 3_000), (16, 50 * 16**2)):
        starts, targets = random_world(3, count, 8)
        engine = engine_of(starts, square(3))
        usual, given = takt.plan_surface(engine, targets), takt.plan_surface(engine, targets, effort=effort)
        assert usual.legs == given.legs
    less = takt.plan_surface(engine, targets, effort=100)
    assert usual.sum_s < less.sum_s


def test_slow_movers_are_planned_like_fast_ones() -> None:
    """PL-72: planning takes no more time and memory where runs take hours; beyond a day they are refused."""
    engine = engine_of({"a": (0, 0), "b": (5, 5)}, square(4))
    for velocity, seconds in ((1.0, 840), (0.01, 84_000)):
        begin = time.monotonic()
        plan = takt.plan_surface(engine, {"a": at((7, 0)), "b": at((0, 5))}, velocity=velocity)
        assert time.monotonic() - begin < 2
        assert plan.arrival_s["a"] == pytest.approx(seconds, rel=0.01)
    for slow in ({"velocity": 0.001}, {"acceleration": 1e-7}, {"jerk": 1e-12}):
        with pytest.raises(
            takt.RoutingError, match="the movers are too slow for a plan: a run along the surface takes"
        ):
            takt.plan_surface(engine, {"a": at((7, 0))}, **slow)


def test_two_hundred_movers_are_planned() -> None:
    starts, targets = random_world(10, 200, 6)
    engine = engine_of(starts, square(10))
    plan = takt.plan_surface(engine, targets, effort=0)
    ends = {name: plan.legs[name][-1].end if plan.legs[name] else at(starts[name]) for name in starts}
    assert ends == targets
    if LONG:
        check(engine, plan)


def test_legs_are_as_the_engine_moves() -> None:
    """A mover alone: the times of the plan are those of the engine."""
    engine = engine_of({"a": (0, 0)}, square(3))
    plan = takt.plan_surface(engine, {"a": at((5, 4))}, velocity=700, acceleration=3000)
    assert plan.sum_s == pytest.approx(plan.lower_bound_s)
    assert len(plan.legs["a"]) == 2
    journey = check(engine, plan)
    assert journey.duration_s == pytest.approx(plan.duration_s, abs=0.01)
    assert "a: to (660, 540) in 2 legs" in str(plan)


SHUTTLE = f"""
name: hall
axes: []
coordinate_systems: [{{name: upper}}, {{name: lower}}]
parts:
  - {{name: left, columns: 2, rows: 2, positions: [{{coordinate_system: upper}}]}}
  - {{name: below, columns: 2, rows: 2, positions: [{{coordinate_system: lower}}]}}
  - name: shuttle
    columns: 1
    rows: 2
    positions: [{{coordinate_system: upper, x: 480}}, {{coordinate_system: lower, x: 480}}]
    travel_time_s: 0.2
movers:
  - {{name: a, reference: left, initial: {{x: 60, y: 60}}, {XY}}}
  - {{name: b, reference: shuttle, initial: {{x: 60, y: 60}}, {XY}}}
  - {{name: c, reference: left, initial: {{x: 420, y: 60}}, {XY}}}
  - {{name: d, reference: below, initial: {{x: 60, y: 60}}, {XY}}}
"""


def hall() -> Engine:
    engine = Engine(SHUTTLE)
    for feedback in [mover.enable() for mover in engine.movers.values()]:
        feedback.wait()
    return engine


def test_parts_are_the_surface_as_they_are_now() -> None:
    """PL-72: obstacles and parts. Places keep their numbers while parts come and go."""
    engine = hall()
    plan = takt.plan_surface(engine, {"a": (540.0, 60.0), "b": (60.0, 60.0)}, may_move=["c"])
    assert (plan.raster.width, plan.raster.height, plan.raster.reference) == (6, 4, "upper")
    check(engine, plan)
    assert engine.part("shuttle").mover_count == 1
    engine.part("shuttle").activate_position(index=2).wait()
    again = takt.plan_surface(engine, {"b": (180.0, 180.0)})
    assert (again.raster.width, again.raster.height) == (6, 4)
    assert sum(again.raster.free) == 16
    with pytest.raises(takt.RoutingError, match=r"the target of mover b at \(540, 60\) is not on the surface"):
        takt.plan_surface(engine, {"b": (540.0, 60.0)})
    with pytest.raises(takt.RoutingError, match="mover a is in lower and mover b is in upper: routes"):
        takt.plan_surface(engine, {"a": (60.0, 60.0), "b": (180.0, 60.0)})
    with pytest.raises(takt.RoutingError, match="environment floor: where there are parts, they are the surface"):
        takt.plan_surface(engine, {"b": (180.0, 60.0)}, environment="floor")
    engine.move_on_surface({"a": (180.0, 60.0)}, may_move=True)  # below
    assert (engine.mover("a").coordinate_system, engine.mover("a").x) == (2, pytest.approx(180))


def test_targets_of_several_kinds() -> None:
    """PL-72: any of some movers to any of some places, and others to places of their own, in one plan."""
    starts, _ = random_world(4, 14, 3)
    engine = engine_of(starts, square(4))
    names = list(starts)
    kinds = {tuple(names[:5]): [at((0, y)) for y in range(5)], tuple(names[5:10]): [at((7, y)) for y in range(4)]}
    plan = takt.plan_surface(engine, {**kinds, names[10]: at((3, 3))}, may_move=True)
    for movers, places in kinds.items():
        assert sorted(plan.targets[name] for name in movers if plan.targets.get(name) in places) == sorted(places)
    assert plan.targets[names[10]] == at((3, 3))
    check(engine, plan)
    cases: list[tuple[object, str]] = [
        ({(names[0],): [at((0, 0)), at((1, 0))]}, "2 targets for 1 mover: m0"),
        ({(names[0], names[1]): [at((0, 0))], names[1]: at((1, 0))}, "mover m1 has more than one target"),
        ({(names[0], names[1]): [at((9, 0))]}, "target 1 of movers m0, m1 at .* is not on the surface"),
        ({(names[0], names[1]): 7}, "the targets of movers m0, m1 are a list of X and Y in mm, not 7"),
    ]
    for targets, sentence in cases:
        with pytest.raises(takt.RoutingError, match=sentence):
            takt.plan_surface(engine, targets)  # type: ignore[arg-type]


@pytest.mark.parametrize("movers", ["ab", "cart", 7, ["ab", 7]])
def test_names_are_a_list(movers: object) -> None:
    """PL-72: a text alone is no list of the movers that its letters name."""
    engine = engine_of({"a": (0, 0), "b": (3, 3), "ab": (2, 0), "cart": (1, 3)}, square(2))
    wrong = r"movers is a list of names, not (the text '(ab|cart)'|7)|movers: a mover goes by its name, not by 7"
    aside = wrong.replace("movers", "may_move")
    for order in (takt.plan_surface, Engine.move_on_surface, Engine.route, Engine.route_any):
        with pytest.raises(TypeError, match=wrong):
            order(engine, [at((0, 1))], movers=movers)  # type: ignore[operator]
    for order in (takt.plan_surface, Engine.move_on_surface, Engine.route):
        with pytest.raises(TypeError, match=aside):
            order(engine, {"a": at((0, 1))}, may_move=movers)  # type: ignore[operator]
        with pytest.raises(TypeError, match="targets: a mover goes by its name, not by <Mover"):
            order(engine, {engine.mover("a"): at((0, 1))})  # type: ignore[operator]
    engine.route_any([at((0, 1))], movers=(name for name in ["a"])).wait()
    assert engine.mover("a").y == pytest.approx(at((0, 1))[1])


def test_over_lcm(tmp_path: Path) -> None:
    """A plan is made and carried out from another process."""
    url = new_url()
    text = machine({"a": (0, 0), "b": (3, 3), "c": (2, 0)}, square(2))
    with running(tmp_path, url, machine=text), takt.connect(url) as session:
        for feedback in [mover.enable() for mover in session.movers.values()]:
            feedback.wait()
        times = session.move_on_surface({"a": at((3, 3)), "b": at((0, 0))})
        assert set(times) == {"a", "b"}
        assert (session.mover("a").x, session.mover("a").y) == pytest.approx(at((3, 3)), abs=1e-6)


def follow_a_route(session: takt.Session) -> None:
    """Over four places, held in the second; what the mover says of its route until it has left it."""
    a = session.mover("a")
    a.enable().wait()
    assert a.surface_route().shape == (0, 2)
    places = [at((0, 0)), at((1, 0)), at((2, 0)), at((2, 1))]
    there = a.set_route(first=a.route_visit, visits=[{"x": x, "y": y} for x, y in places])
    session.command("machine", "start_routes", {"velocity": 500}).wait()
    session.wait(lambda: len(a.surface_route()) == 4 and a.x > 80, 5)
    assert a.surface_route().tolist() == [list(place) for place in places]
    session.command("machine", "hold_routes").wait()
    session.wait(lambda: a.delay == "release", 5)
    assert a.surface_route().tolist() == [list(place) for place in places[a.route_visit :]]
    session.command("machine", "hold_routes", {"hold": False}).wait()
    there.wait()
    session.wait(lambda: len(a.surface_route()) == 0, 2)


def test_what_a_mover_says_of_its_route() -> None:
    follow_a_route(Engine(machine({"a": (0, 0)}, square(2))))


def test_what_a_mover_says_of_its_route_over_lcm(tmp_path: Path) -> None:
    url = new_url()
    text = machine({"a": (0, 0)}, square(2))
    with running(tmp_path, url, machine=text), takt.connect(url) as session:
        follow_a_route(session)
        with takt.connect(url) as later:  # joins while it is on its way
            a = session.mover("a")
            places = [at((2, 1)), at((1, 1)), at((0, 1))]
            there = a.set_route(first=a.route_visit, visits=[{"x": x, "y": y} for x, y in places])
            session.command("machine", "start_routes", {"velocity": 60}).wait()
            with takt.connect(url) as late:
                late.wait(lambda: len(late.mover("a").surface_route()) > 0, 3)
                assert late.mover("a").surface_route()[-1].tolist() == list(places[-1])
            assert later.mover("a").on_route
            there.wait()


# --- what cannot be ---


def test_targets_that_cannot_be_are_named() -> None:
    ring = [cell for cell in square(3) if cell != (1, 1)]
    engine = engine_of({"a": (0, 0), "b": (5, 5), "c": (0, 1)}, ring)
    cases: list[tuple[object, str]] = [
        ({"a": at((2, 2))}, r"the target of mover a at \(300, 300\) is not on the surface"),
        ({"a": (-60.0, 60.0)}, "the target of mover a at .* is not on the surface"),
        ({"a": (190.0, 60.0)}, r"is not in the middle of a place: the nearest is \(180, 60\), places are 120 mm apart"),
        ({"a": at((4, 0)), "b": at((4, 0))}, r"the target of mover a and the target of mover b are in one place"),
        ({"a": at((0, 1))}, r"mover c stands at the target \(60, 180\), and may not be moved"),
        ({"a": [at((4, 0)), at((5, 0))]}, "the target of mover a is X and Y in mm, not"),
        ({"a": (math.nan, 0.0)}, "the target of mover a is X and Y in mm"),
        ({"a": "here"}, "the target of mover a is X and Y in mm"),
        ([at((4, 0))] * 2, "target 1 and target 2 are in one place"),
        ([at((x, 0)) for x in range(4)], "4 targets for 3 movers"),
    ]
    for targets, sentence in cases:
        with pytest.raises(takt.RoutingError, match=sentence):
            takt.plan_surface(engine, targets)  # type: ignore[arg-type]
    with pytest.raises(takt.TaktError, match="no mover 'd'"):
        takt.plan_surface(engine, {"d": at((0, 0))})
    with pytest.raises(TypeError, match="dynamics are velocity, acceleration, jerk, not speed"):
        takt.plan_surface(engine, {"a": at((4, 0))}, speed=1)
    with pytest.raises(takt.RoutingError, match="targets are places by mover, or a list of places, not 5"):
        takt.plan_surface(engine, 5)  # type: ignore[arg-type]
    given: list[tuple[dict[str, object], str]] = [
        ({"velocity": 0}, "velocity is a number above 0, not 0"),
        ({"velocity": "fast"}, "velocity is a number above 0, not 'fast'"),
        ({"jerk": math.nan}, "jerk is a number above 0, not nan"),
        ({"pitch": "a"}, "the pitch is a number above 0 mm, not 'a'"),
        ({"origin": (math.nan, 0)}, r"the origin is X and Y in mm, not \(nan, 0\)"),
        ({"origin": (5,)}, r"the origin is X and Y in mm, not \(5,\)"),
        ({"origin": "ab"}, "the origin is X and Y in mm, not 'ab'"),
        ({"effort": -1}, "effort is a whole number from 0 to 9223372036854775807, not -1"),
        ({"effort": 1.5}, "effort is a whole number .* not 1.5"),
        ({"effort": "x"}, "effort is a whole number .* not 'x'"),
        ({"seed": 2**70}, "seed is a whole number from 0"),
    ]
    for options, sentence in given:
        with pytest.raises(takt.RoutingError, match=sentence):
            takt.plan_surface(engine, {"a": at((4, 0))}, **options)  # type: ignore[arg-type]
        with pytest.raises(takt.RoutingError, match=sentence):
            takt.SurfaceRouter(engine, **options)  # type: ignore[arg-type]
    assert takt.plan_surface(engine, {}).sum_s == 0
    assert takt.plan_surface(engine, {"a": at((0, 0))}).targets == {"a": at((0, 0))}  # it is there


def test_rasters_that_cannot_be_are_named() -> None:
    engine = engine_of({"a": (0, 0), "b": (3, 3)}, square(2))
    with pytest.raises(takt.RoutingError, match="mover a is 113 mm large, and has no room in places of 80 mm"):
        takt.plan_surface(engine, {"a": at((1, 0))}, pitch=80)
    with pytest.raises(takt.RoutingError, match="the pitch is a number above 0 mm"):
        takt.plan_surface(engine, {"a": at((1, 0))}, pitch=-1)
    with pytest.raises(takt.RoutingError, match=r"mover a at \(60, 60\) is not in the middle of a place"):
        takt.plan_surface(engine, {"a": at((1, 0))}, pitch=160)
    with pytest.raises(takt.RoutingError, match="no place of 120 mm is on the stators"):
        takt.plan_surface(engine, {"a": at((1, 0))}, origin=(5000.0, 0.0))
    far = engine_of({"a": (0, 0)}, [(0, 0), (70, 0)])
    with pytest.raises(takt.RoutingError, match="142 by 2 places of 120 mm: expected at most 128 each way"):
        takt.plan_surface(far, {"a": at((1, 0))})
    with pytest.raises(takt.TaktError, match="no environment 'roof'"):
        takt.plan_surface(engine, {"a": at((1, 0))}, environment="roof")
    nowhere = Engine(f"name: n\naxes: []\nmovers: [{{name: a, initial: {{x: 60, y: 60}}, {XY}}}]\n")
    nowhere.mover("a").enable().wait()
    with pytest.raises(takt.RoutingError, match="expected an environment with stators"):
        takt.plan_surface(nowhere, {"a": (60.0, 60.0)})


def test_movers_that_cannot_go_are_named() -> None:
    engine = engine_of({"a": (0, 0), "b": (3, 3), "c": (2, 2)}, square(2))
    engine.mover("b").disable().wait()
    with pytest.raises(takt.RoutingError, match="mover b cannot be moved on the surface: it is Disabled"):
        takt.plan_surface(engine, {"b": at((1, 0))})
    engine.mover("c").move_to_position(x=180, y=300)
    engine.run(0.05)
    with pytest.raises(takt.RoutingError, match="mover c is in motion"):
        takt.plan_surface(engine, {"a": at((1, 0))})


def test_two_movers_in_a_lane_cannot_change_places() -> None:
    """Every order was tried, and that is said."""
    movers = "".join(
        f"  - {{name: {name}, width: 200, height: 200, initial: {{x: {x}, y: 120}}, {XY}}}\n"
        for name, x in (("a", 120), ("b", 360))
    )
    floor = "environments: [{name: floor, stators: [{x: 0, y: 0}, {x: 240, y: 0}]}]\n"
    engine = Engine(f"name: lane\naxes: []\nmovers:\n{movers}{floor}")
    for feedback in [mover.enable() for mover in engine.movers.values()]:
        feedback.wait()
    with pytest.raises(takt.RoutingError, match="every order of passing was tried"):
        takt.plan_surface(engine, {"a": (360.0, 120.0), "b": (120.0, 120.0)})
