"""Orders as they come on the free surface: planned anew from where movers are, round what stands (PL-72)."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest
import takt
from machines import new_url, running
from takt import Engine
from test_surface import LONG, PITCH, Cell, Watch, at, engine_of, hall, machine, random_world, square


def is_at(mover: takt.Mover, cell: Cell) -> bool:
    return math.dist((mover.x, mover.y), at(cell)) < 1e-6


def free_cells(engine: Engine, orders: dict[str, takt.SurfaceOrder], side: int) -> list[Cell]:
    """Cells in which no mover is, and to which none is sent."""
    taken = [(m.x, m.y) for m in engine.movers.values()]
    taken += [point for order in orders.values() for point in order.targets.values()]
    return [cell for cell in square(side) if all(math.dist(at(cell), point) > PITCH - 1 for point in taken)]


# --- orders as they come ---


@pytest.mark.parametrize(
    ("stators", "count", "seconds"), [(3, 8, 1.5), *([(4, 20, 20.0), (4, 30, 20.0)] if LONG else [])]
)
def test_a_stream_of_orders(stators: int, count: int, seconds: float) -> None:
    """Whoever is there gets a new target at once, while the others are on their way."""
    starts, _ = random_world(stators, count, count)
    engine = engine_of(starts, square(stators))
    watch, chance, there = Watch(engine), random.Random(count), 0
    orders: dict[str, takt.SurfaceOrder] = {}
    while engine.now < seconds:
        for name in starts:
            if name in orders and not orders[name].done:
                continue
            there += name in orders
            cell = chance.choice(free_cells(engine, orders, 2 * stators))
            orders[name] = engine.route({name: at(cell)}, may_move=True, effort=300)
        engine.run(0.02)
    for order in orders.values():
        order.wait()
        ((name, target),) = order.targets.items()
        assert math.dist((engine.mover(name).x, engine.mover(name).y), target) < 1e-6
        assert 0 < order.arrived_s[name] < count
    assert not watch.overlaps
    assert there > 3 * seconds


@pytest.mark.parametrize("pooled", [False, True])
def test_the_first_order_is_for_a_mover_between_two_places(pooled: bool) -> None:
    engine = engine_of({"a": (0, 0), "b": (0, 3)}, square(3))
    a = engine.mover("a")
    a.move_to_position(x=100, y=60).wait()
    goals = [at((3, 2)), at((4, 2))]
    order = engine.route_any(goals) if pooled else engine.route({"a": at((3, 2))})
    order.wait()
    assert {(round(m.x), round(m.y)) for m in (a, engine.mover("b"))} >= set(goals if pooled else goals[:1])


def test_a_mover_is_sent_elsewhere_on_its_way() -> None:
    engine = engine_of({"a": (0, 0), "b": (0, 3)}, square(3))
    watch = Watch(engine)
    first = engine.route({"a": at((5, 0)), "b": at((5, 3))})
    engine.wait(lambda: engine.mover("a").x > 200)
    assert engine.mover("a").velocity_x > 500
    second = engine.route({"a": at((0, 5))})
    second.wait()
    assert is_at(engine.mover("a"), (0, 5))
    with pytest.raises(takt.RoutingError, match="mover a: another order came"):
        first.wait()
    assert is_at(engine.mover("b"), (5, 3))
    assert set(first.arrived_s) == {"b"}
    assert not watch.overlaps


def test_any_of_them_while_others_are_on_their_way() -> None:
    starts = {"a": (0, 0), "b": (5, 0), "c": (0, 5), "d": (5, 5)}
    engine = engine_of(starts, square(3))
    watch = Watch(engine)
    first = engine.route({"a": at((5, 5)), "d": at((0, 0))})
    engine.run(0.15)
    any_of = engine.route_any([at((4, 0)), at((3, 3))])  # b and c: the others have targets
    assert any_of.targets["b"] == at((4, 0))
    any_of.wait()
    first.wait()
    assert is_at(engine.mover("c"), (3, 3))
    less = engine.route_any([at((0, 3))], movers=["a", "b", "c"])
    assert less.movers == ("c",)  # it is the nearest
    assert repr(less.wait()) == "<SurfaceOrder: 1 of 1 there>"
    assert not watch.overlaps


def test_what_cannot_be_leaves_the_others_alone() -> None:
    ring = [cell for cell in square(3) if cell != (1, 1)]
    engine = engine_of({"a": (0, 0), "b": (5, 5), "c": (0, 5)}, ring)
    order = engine.route({"a": at((5, 0)), "b": at((5, 1))})
    engine.run(0.1)
    cases: list[tuple[object, str]] = [
        ({"c": at((2, 2))}, r"the target of mover c at \(300, 300\) is not on the surface"),
        ({"c": at((5, 0))}, r"the target of mover a and the target of mover c are in one place, \(660, 60\)"),
        ({"c": (math.inf, 0.0)}, "the target of mover c is X and Y in mm"),
        ({"c": (70.0, 60.0)}, "is not in the middle of a place"),
    ]
    for targets, sentence in cases:
        with pytest.raises(takt.RoutingError, match=sentence):
            engine.route(targets)  # type: ignore[arg-type]
    with pytest.raises(takt.RoutingError, match="movers are on their way: other options can be given"):
        engine.route({"c": at((0, 3))}, velocity=100)
    with pytest.raises(takt.TaktError, match="no mover 'z'"):
        engine.route({"z": at((0, 3))})
    order.wait()
    assert is_at(engine.mover("a"), (5, 0))
    assert engine.route({}).done
    with pytest.raises(takt.RoutingError, match=r"mover b stands at the target \(660, 180\), and may not be moved"):
        engine.route({"c": at((5, 1))})
    engine.mover("c").disable().wait()
    with pytest.raises(takt.RoutingError, match="mover c cannot be moved on the surface: it is Disabled"):
        engine.route({"c": at((0, 3))})


def test_a_thousand_orders_a_second() -> None:
    """One each cycle, to the same mover and to others."""
    engine = engine_of({"a": (0, 0), "b": (3, 3)}, square(2))
    watch = Watch(engine)
    orders = []
    for k in range(60):
        name, cell = ("a", (k % 4, 1)) if k % 3 else ("b", (k % 4, 2))
        orders.append(engine.route({name: at(cell)}, effort=0))
        engine.step()
    orders[-1].wait()
    assert is_at(engine.mover("a"), (59 % 4, 1))
    assert sum(order.done for order in orders) >= 59
    assert not watch.overlaps


# --- movers that fail, and parts that leave ---


def test_movers_that_fail_are_gone_round() -> None:
    """PL-72: single movers that halt or fail in the middle of a plan; all others get to their targets."""
    starts, targets = random_world(3, 12, 3)
    engine = engine_of(starts, square(3))
    watch, chance = Watch(engine), random.Random(7)
    order = engine.route(targets, effort=500)
    failed: set[str] = set()
    while len(failed) < 3:
        engine.run(chance.uniform(0.05, 0.2))
        moving = [m for m in engine.movers.values() if math.hypot(m.velocity_x, m.velocity_y) > 100]
        if moving and (mover := chance.choice(moving)).name not in failed:
            failed.add(mover.name)
            mover.disable() if len(failed) % 2 else mover.halt()
    engine.wait(lambda: order.done, 30)
    assert failed <= set(order.failed)
    for name in set(starts) - set(order.failed):
        assert math.dist((engine.mover(name).x, engine.mover(name).y), targets[name]) < 1e-6
    for name in set(order.failed) - failed:
        assert "may not be moved" in order.failed[name]  # one that failed stands there, or shuts its way
    # They can move again: from between two places, too.
    for name in failed:
        if engine.mover(name).state is not takt.ObjectState.ENABLED:
            engine.mover(name).enable().wait()
    engine.route({name: targets[name] for name in order.failed}, may_move=True).wait(30)
    for name in order.failed:
        assert math.dist((engine.mover(name).x, engine.mover(name).y), targets[name]) < 1e-6
    assert not watch.overlaps


@pytest.mark.parametrize("size", [113, 200])
def test_an_order_while_the_last_mover_on_its_way_brakes(size: int) -> None:
    """PL-72: it is carried out once that one stands, on the raster on which both were."""
    pitch = 120 if size < 118 else 240
    movers = [
        {"name": name, "width": side, "height": side, "initial": {"x": pitch / 2, "y": y}}
        for name, side, y in (("a", size, pitch / 2), ("b", 113, pitch * 1.5))
    ]
    stators = [{"x": 240 * x, "y": 240 * y} for x, y in square(3)]
    with Engine(
        {"name": "s", "axes": [], "movers": movers, "environments": [{"name": "floor", "stators": stators}]}
    ) as engine:
        for feedback in [mover.enable() for mover in engine.movers.values()]:
            feedback.wait()
        first = engine.route({"a": (720 - pitch / 2, pitch / 2)})
        engine.run(0.25)
        engine.mover("a").halt()
        engine.run(0.02)
        target = (720 - pitch / 2, pitch * 1.5)
        engine.route({"b": target}).wait()
        assert math.dist((engine.mover("b").x, engine.mover("b").y), target) < 1e-6
        assert set(first.failed) == {"a"}


@pytest.mark.parametrize("targets", [[(5, 0), (5, 1)], [(5, 0)]])
def test_an_order_for_any_of_them_that_fails_alone(targets: list[Cell]) -> None:
    """PL-72: a target of the pool is covered by a mover that was halted; the order of another mover goes on."""
    engine = engine_of({name: (0, y) for y, name in enumerate("abcd")}, square(5))
    halted = engine.route({"a": at((9, 0))})
    pool = engine.route_any([at(cell) for cell in targets], movers=["b", "c"])
    other = engine.route({"d": at((9, 3))})
    a = engine.mover("a")
    engine.wait(lambda: a.x > 430)
    a.halt()
    other.wait()
    assert is_at(engine.mover("d"), (9, 3))
    for order in (halted, pool):
        engine.wait(lambda order=order: order.done)
        assert set(order.failed) == set(order.movers)
    assert all("mover a stands at the target (660, 60)" in said for said in pool.failed.values())


@pytest.mark.parametrize(
    ("verb", "arguments"),
    [
        ("emergency_stop", {"hold": True}),
        ("emergency_stop", {"hold": False}),
        ("stop_all", {"open_loops": False}),
        ("stop_all", {"open_loops": True}),
        ("fail_all_axes", {}),
    ],
)
def test_stops_of_the_machine_end_the_orders(verb: str, arguments: dict[str, bool]) -> None:
    """PL-72, AX-100: nobody goes on by itself; once the movers are ready again, new orders are carried out."""
    engine = engine_of({"a": (0, 0), "b": (5, 5), "c": (0, 5)}, square(3))
    watch = Watch(engine)
    order = engine.route({"a": at((5, 0)), "b": at((0, 1))})
    engine.run(0.15)
    assert engine.mover("a").velocity_x > 100
    engine.command("machine", verb, arguments)
    engine.run(1.0)
    stopped = [(m.x, m.y, m.velocity_x, m.velocity_y) for m in engine.movers.values()]
    assert order.done
    with pytest.raises(takt.RoutingError, match=r"mover [ab]"):
        order.wait()
    if arguments.get("hold"):
        with pytest.raises(
            takt.RoutingError, match=r"mover c cannot be moved on the surface: it is (ErrorStop|Disabled)"
        ):
            engine.route({"c": at((0, 3))})
        engine.command("machine", "release_emergency_stop").wait()
    engine.run(1.0)
    assert [(m.x, m.y, m.velocity_x, m.velocity_y) for m in engine.movers.values()] == stopped
    assert all(vx == vy == 0 for _, _, vx, vy in stopped)
    for mover in engine.movers.values():
        if mover.error:
            mover.reset().wait()
        mover.enable().wait()
    engine.route({"a": at((5, 0)), "b": at((0, 1)), "c": at((0, 3))}).wait()
    assert is_at(engine.mover("a"), (5, 0))
    assert is_at(engine.mover("b"), (0, 1))
    assert not watch.overlaps


@pytest.mark.parametrize("on_way", [False, True])
def test_movers_that_cannot_go_when_their_routes_come(on_way: bool) -> None:
    """PL-72: what is published is of the cycle before; the order fails with the reason, the others are carried out."""
    engine = engine_of({"a": (0, 0), "b": (0, 3), "c": (0, 5)}, square(3))
    if on_way:
        engine.route({"b": at((5, 3))})
        engine.run(0.1)
    engine.mover("a").disable()
    order = engine.route({"a": at((5, 0)), "c": at((5, 5))})
    engine.wait(lambda: order.done, 10)
    assert order.failed["a"] == "mover a cannot be moved on the surface: it is Disabled"
    assert set(order.arrived_s) == {"c"}
    if on_way:
        assert is_at(engine.mover("b"), (5, 3))
    # Set points from outside that others start in that cycle, too.
    engine.mover("a").enable().wait()
    engine.mover("a").start_external_setpoint_generation(mode="relative")
    order = engine.route({"a": at((5, 0)), "b": at((0, 3))})
    engine.wait(lambda: order.done, 10)
    assert "a" in order.failed
    assert "b" in order.arrived_s


def test_orders_that_the_engine_refuses_again_and_again() -> None:
    """PL-72: a route of another client is behind a mover that has an order, and so that one may not change over."""
    engine = engine_of({"a": (0, 0), "u": (5, 1), "b": (0, 5)}, square(3))
    first = engine.route({"a": at((3, 0)), "b": at((5, 5))}, velocity=300)
    engine.run(0.3)
    visits = [{"x": x, "y": y} for x, y in map(at, [(5, 1), (5, 0), (4, 0), (3, 0)])]
    visits[-1] |= {"after": 1, "after_visit": 2}
    engine.mover("u").set_route(first=0, visits=visits)
    engine.command("machine", "start_routes", {"movers": [2]}).wait()
    second = engine.route({"a": at((3, 3))})
    engine.run(2)
    assert second.failed["a"].endswith("the mover is on its way, and has no new route: mover u")
    assert first.done
    assert engine._routers[0].plans < 10
    engine.mover("u").halt().wait()
    engine.route({"b": at((5, 4))}).wait()


def test_routes_of_others_end_the_orders() -> None:
    """PL-72: a mover that another client gives a route goes there, and its order has failed."""
    engine = engine_of({"a": (0, 0), "b": (0, 3)}, square(3))
    order = engine.route({"a": at((5, 0)), "b": at((5, 3))})
    engine.run(0.1)
    a = engine.mover("a")
    points = [{"x": x, "y": 60.0} for x in (420.0, 540.0)]
    theirs = a.set_route(first=3, visits=points)
    engine.command("machine", "start_routes", {"movers": [1]}).wait()
    engine.wait(lambda: order.done, 10)
    assert set(order.failed) == {"a"}
    theirs.wait()
    assert is_at(a, (4, 0))
    assert is_at(engine.mover("b"), (5, 3))


def test_those_behind_it_go_back_and_round() -> None:
    """A leader in a lane, and three behind it that were granted places beyond it: none waits for ever."""
    starts = {name: (x, 0) for x, name in enumerate("dcba")}
    engine = engine_of(starts, square(7))
    watch = Watch(engine)
    order = engine.route({name: at((13 - k, 0)) for k, name in enumerate("abcd")})
    engine.wait(lambda: engine.mover("b").velocity_x > 500)
    engine.mover("a").disable()
    with pytest.raises(takt.RoutingError, match="mover a is Disabling on its way"):
        order.wait()
    assert set(order.arrived_s) == set("bcd")
    assert not watch.overlaps
    assert engine.mover("a").x > 420


def test_whoever_waits_says_for_whom() -> None:
    """PL-84: the mover that has a place before, or that is in the way."""
    column = [(0, y) for y in range(3)]  # two places wide, six long
    engine = engine_of({"a": (0, 0), "b": (0, 5), "c": (1, 5), "d": (1, 0)}, column)
    order = engine.route({"a": at((0, 5)), "b": at((0, 0)), "c": at((1, 0)), "d": at((1, 5))})
    seen: set[str] = set()
    engine.wait(lambda: seen.update(order.waits.values()) or order.done)
    assert any("which" in reason and "has before" in reason for reason in seen)
    assert sum(sum(held.values()) for held in engine._routers[0].waited_s.values()) > 0.1


def test_a_part_that_leaves_with_movers_on_their_way_to_it() -> None:
    """Whoever was to go there comes to rest in a place, and says so; the others go on."""
    engine = hall()
    engine.route({"b": (60.0, 420.0)}).wait()  # off the shuttle
    order = engine.route({"a": (540.0, 420.0), "c": (180.0, 60.0)}, velocity=300)
    engine.run(0.1)
    engine.part("shuttle").activate_position(index=2).wait_final()
    if engine.part("shuttle").position_index == 1:
        pytest.fail("the part stayed: a mover was granted places on it at once")
    engine.wait(lambda: order.done)
    assert "the target of mover a at (540, 420) is not on the surface" in order.failed["a"]
    assert set(order.arrived_s) == {"c"}
    a = engine.mover("a")
    assert (a.x - 60) % PITCH == pytest.approx(0, abs=1e-6)
    engine.part("shuttle").activate_position(index=1).wait()
    engine.route({"a": (540.0, 420.0)}).wait()


def test_orders_over_lcm(tmp_path: Path) -> None:
    """PL-72, EN-07: and the log of it is the same when it is run again, and says where movers were on their routes."""
    url = new_url()
    starts = {"a": (0, 0), "b": (5, 5), "c": (2, 0)}
    log = tmp_path / "run.lcm"
    with running(tmp_path, url, "--log", str(log), machine=machine(starts, square(3))), takt.connect(url) as session:
        for feedback in [mover.enable() for mover in session.movers.values()]:
            feedback.wait()
        session.move_on_surface({"a": at((0, 1)), "c": at((2, 1))}, timeout=20)
        first = session.route({"a": at((5, 4)), "b": at((0, 0))})
        session.run(0.2)
        second = session.route({"c": at((2, 5)), "b": at((0, 1))})
        second.wait()
        session.wait(lambda: first.done)
        assert set(first.arrived_s) == {"a"}
        cells = {"a": (5, 4), "b": (0, 1), "c": (2, 5)}
        # What is published may be of the cycle before the last command was done.
        session.wait(lambda: all(is_at(session.mover(name), cell) for name, cell in cells.items()), 1.0)
    again = takt.replay(log)
    assert again.same, again.sentence
    recording = takt.read_log(log)
    assert {bool(value) for value in recording["a"]["on_route"]} == {False, True}
    assert recording["a"]["route_visit"][-1] > 5
