"""Movers that are stopped, stopped again, and set into the way of others (PL-80 to PL-82, PL-14)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import takt
from takt import Engine

V, A, J = 2000.0, 10_000.0, 200_000.0
SIDE = 113.0
MAXIMUM = {"maximum": {"velocity": V, "acceleration": A, "jerk": J}}
Stop = Callable[[Engine], Any]
STOPS: dict[str, Stop] = {
    "halt": lambda e: e.mover("a").halt(),
    "stop_all": lambda e: e.stop_all(),
    "disable": lambda e: e.mover("a").disable(),
    "emergency stop": lambda e: e.emergency_stop(),
    "another move": lambda e: e.mover("a").move_to_position(x=300, y=-100),
}


def engine_of(*others: dict[str, Any], **more: Any) -> Engine:
    """One mover at the origin that is enabled, and others."""
    movers = [{"name": "a", "xy": MAXIMUM, **more.pop("a", {})}, *others]
    engine = Engine({"name": "stops", "axes": [], "movers": movers, **more})
    engine.mover("a").enable().wait()
    for track in engine.tracks.values():
        track.enable().wait()
    return engine


def track(to: float, **more: Any) -> dict[str, Any]:
    y = more.pop("y", 0)
    return {"name": "t", "elements": [{"from": {"x": 0, "y": y}, "to": {"x": to, "y": y}}], **more}


def overlap(recording: takt.Recording, one: str, other: str) -> float:
    """mm, the largest of two squares that are not turned."""
    a, b = recording[one], recording[other]
    apart = np.maximum(np.abs(a["x"] - b["x"]), np.abs(a["y"] - b["y"]))
    return float(SIDE - apart.min())


# --- as hard as it can ---


@pytest.mark.parametrize("how", ["disable", "emergency stop", "stop_all"])
@pytest.mark.parametrize("then", [None, {"x": 100, "y": 400}, {"x": -300, "y": 20}])
def test_it_brakes_as_hard_as_it_can_whatever_it_was_told(how: str, then: dict[str, float] | None) -> None:
    """PL-14: also while a gentle move comes to rest for another one; the way is that of the maxima."""
    engine = engine_of()
    a = engine.mover("a")
    a.move_to_position(x=4000, y=0, deceleration=1000)
    engine.run(0.3)
    if then is not None:
        a.move_to_position(**then, deceleration=1000)
        engine.run(0.05)
    velocity, x, y = math.hypot(a.velocity_x, a.velocity_y), a.x, a.y
    assert velocity > 1500
    STOPS[how](engine)
    engine.run(1.0)
    assert math.hypot(a.velocity_x, a.velocity_y) == 0
    # From an acceleration of A it is faster by A²/2J at the most before it brakes.
    fastest = min(velocity + A * A / (2 * J), V)
    assert math.hypot(a.x - x, a.y - y) <= fastest * (fastest / A + A / J) / 2 + fastest * A / J


# --- the velocity never steps ---


def bend(engine: Engine, mode: str, seconds: float = 0.299) -> None:
    """Along a circle of 100 mm at up to 500 mm/s, from outside."""
    a, radius, way, speed = engine.mover("a"), 100.0, 0.0, 0.0
    a.start_external_setpoint_generation(mode=mode)
    for _ in range(round(seconds / engine.period)):
        rise = 2000.0 if speed < 500 else 0.0
        way += speed * engine.period + rise * engine.period**2 / 2
        speed += rise * engine.period
        sine, cosine, inwards = math.sin(way / radius), math.cos(way / radius), speed * speed / radius
        a.set_external_setpoint(
            x=radius * sine,
            y=radius * (1 - cosine),
            velocity_x=speed * cosine,
            velocity_y=speed * sine,
            acceleration_x=rise * cosine - inwards * sine,
            acceleration_y=rise * sine + inwards * cosine,
        )
        engine.step(1)


@pytest.mark.parametrize("mode", ["absolute", "relative"])
@pytest.mark.parametrize("first", ["halt", "stop_all", "none"])
@pytest.mark.parametrize("second", STOPS)
def test_one_that_is_stopped_twice_does_not_jerk(mode: str, first: str, second: str) -> None:
    """PL-82: set points along a bend end; while the mover comes to rest in a bend it is stopped once more."""
    for later in (1, 5, 20):
        engine = engine_of()
        record = engine.record()
        bend(engine, mode)
        if first != "none":
            STOPS[first](engine)
        engine.step(later)
        STOPS[second](engine)
        engine.run(0.6)
        data = record.stop()["a"]
        steps = np.hypot(np.diff(data["velocity_x"]), np.diff(data["velocity_y"]))
        assert steps.max() <= A * engine.period * 1.001, (later, steps.max())


# --- set down in the way ---


def onto_track(e: Engine) -> None:
    e.mover("a").join_track(track="t").wait()
    e.mover("a").move_on_track(position=4000)
    e.run(0.5)


def straight_on(e: Engine) -> None:
    e.mover("a").move_to_position(x=4000, y=0)
    e.run(0.5)


def as_a_star(e: Engine) -> None:
    e.mover("p").enable().wait()
    e.mover("p").join_formation(star="a").wait(until="reached")
    straight_on(e)


def from_outside(e: Engine) -> None:
    a = e.mover("a")
    a.start_external_setpoint_generation()
    for i in range(300):
        t = i * e.period
        a.set_external_setpoint(x=2000 * t * t, velocity_x=4000 * t, acceleration_x=4000)
        e.step(1)


@pytest.mark.parametrize("go", [straight_on, onto_track, as_a_star, from_outside])
@pytest.mark.parametrize("grouped", [False, True])
def test_set_position_into_the_way_of_a_mover_is_refused(go: Callable[[Engine], None], grouped: bool) -> None:
    """PL-81: where that could not come to rest any more; further on it is taken, and the other one stops before it."""
    more: dict[str, Any] = {"tracks": [track(4000)]}
    if grouped:
        more["planar_groups"] = [{"name": "g", "movers": ["a", "b", "p"], "tracks": ["t"]}]
    engine = engine_of({"name": "b", "initial": {"y": 5000}}, {"name": "p", "initial": {"y": 200}}, **more)
    if grouped:
        engine.planar_group("g").enable().wait()
    record = engine.record()
    go(engine)
    a, b = engine.mover("a"), engine.mover("b")
    near = b.set_position(x=a.x + 130, y=a.y).wait_final()
    assert near.error_id == 3024
    assert near.object in (a, engine.tracks.get("t"))  # its group has the whole track for it
    if not grouped:
        assert b.set_position(x=a.x + 1000, y=a.y).wait_final().done
    engine.run(2.0)
    recording = record.stop()
    assert overlap(recording, "a", "b") <= 1e-6


def test_set_position_in_the_very_first_cycle() -> None:
    """PL-81: others are where the machine file has them, not at the origin."""
    movers = [{"name": "a"}, {"name": "b", "initial": {"x": 900, "y": 840}}]
    engine = Engine({"name": "first", "axes": [], "movers": movers})
    a = engine.mover("a")
    onto = a.set_position(x=850, y=840)
    assert a.set_position(x=60, y=60).wait_final().done
    assert onto.error_id == 3024


def test_set_position_is_kept_in_a_fault_of_the_next_cycle() -> None:
    """PL-11: the braking that has just ended is not what the mover stops with at its new position."""
    hall = {"name": "hall", "columns": 6, "rows": 3, "positions": [{"coordinate_system": "cs"}]}
    start = {"initial": {"x": 120, "y": 120}, "reference": "hall"}
    engine = engine_of(coordinate_systems=[{"name": "cs"}], parts=[hall], a=start)
    a = engine.mover("a")
    a.move_to_position(x=1200, y=120)
    engine.run(0.3)
    a.disable().wait()
    put = a.set_position(x=300, y=500)
    engine.part("hall").force_disable()
    engine.run(0.05)
    assert put.done
    assert (a.state, a.x, a.y) == ("Error", 300, 500)


# --- on tracks ---


HALL = {"name": "hall", "columns": 4, "rows": 1, "positions": [{"coordinate_system": "cs"}]}


def in_a_hall() -> Engine:
    """On a track that leads nearer to the border of the stators, at X of 960 mm, than the mover is large."""
    return engine_of(
        a={"reference": "hall", "initial": {"x": 80, "y": 120}},
        coordinate_systems=[{"name": "cs"}],
        parts=[HALL],
        tracks=[{"name": "t", "part": "hall", "elements": [{"from": {"x": 80, "y": 120}, "to": {"x": 950, "y": 120}}]}],
    )


@pytest.mark.parametrize("dynamics", [{"deceleration": 1000}, {"jerk": 2000}, {"deceleration": 100}])
@pytest.mark.parametrize("command", ["halt", "back", "on"])
def test_a_gentle_command_does_not_lead_over_the_border(dynamics: dict[str, float], command: str) -> None:
    """PL-80: a halt is as hard as it has to be, a move that would is refused."""
    for wait in (0.2, 0.3, 0.4, 0.5):
        engine = in_a_hall()
        a = engine.mover("a")
        a.join_track(track="t").wait()
        record = engine.record()
        a.move_on_track(position=820)
        engine.run(wait)
        if command == "halt":
            said = a.halt(**dynamics)
        else:
            said = a.move_on_track(position=100 if command == "back" else 810, **dynamics)
        engine.run(6.0)
        assert said.done or said.error_id == 3071
        assert record.stop()["a"]["x"].max() + SIDE / 2 <= 960 + 1e-6
        assert a.velocity_x == 0


def aside(engine: Engine, along: float, across: float, cycles: int) -> Any:
    """Relative set points with a constant acceleration, mm/s², until they are refused."""
    a = engine.mover("a")
    said = a.start_external_setpoint_generation(mode="relative")
    for i in range(1, cycles + 1):
        t = i * engine.period
        a.set_external_setpoint(
            x=along * t * t / 2,
            y=across * t * t / 2,
            velocity_x=along * t,
            velocity_y=across * t,
            acceleration_x=along,
            acceleration_y=across,
        )
        engine.step(1)
        if said.error:
            break
    return said


@pytest.mark.parametrize("first", [(0, -3000), (0, 3000), (2500, 0), (2000, 2000)])
@pytest.mark.parametrize("end", ["stop", "halt"])
@pytest.mark.parametrize("grouped", [False, True])
def test_set_points_begun_anew_on_a_track_keep_clear(first: tuple[float, float], end: str, grouped: bool) -> None:
    """PL-81: while the mover is still off its place from those before, what is added leads to one that stands there."""
    for y in (130.0, 160.0, 200.0, 260.0):
        for pause in (1, 5, 40):
            other = {"name": "b", "initial": {"x": 500, "y": y}}
            more: dict[str, Any] = {"tracks": [track(1000)]}
            if grouped:
                more["planar_groups"] = [{"name": "g", "movers": ["a", "b"], "tracks": ["t"]}]
            engine = engine_of(other, a={"initial": {"x": 500, "y": 0}}, **more)
            if grouped:
                engine.planar_group("g").enable().wait()
            a = engine.mover("a")
            a.join_track(track="t").wait()
            record = engine.record()
            aside(engine, *first, 60)
            said = a.stop_external_setpoint_generation() if end == "stop" else a.halt()
            engine.step(pause)
            if a.state.value == "Enabled":
                aside(engine, 0, 3000, 1000)
            engine.run(1.0)
            assert said.final
            assert overlap(record.stop(), "a", "b") <= 1e-6, (y, pause)
            assert (a.y, a.velocity_y) == (pytest.approx(0, abs=1e-6), 0)


@pytest.mark.parametrize("end", ["missing", "stop", "halt", "disable"])
def test_the_speed_stays_within_its_maximum_when_set_points_end(end: str) -> None:
    """PL-82: on a track, as a vector, with what was added."""
    fastest = 200.0
    for along, cycles in ((150, 30), (150, 23), (190, 11), (199, 60)):
        limits = {"maximum": {"velocity": fastest, "acceleration": 30_000, "jerk": J}}
        engine = engine_of(a={"xy": limits}, tracks=[track(1000)])
        a = engine.mover("a")
        a.join_track(track="t").wait()
        a.move_on_track(position=900, velocity=along)
        engine.run(0.5)
        record = engine.record()
        aside(engine, 0, 4000, cycles)
        if a.state.value == "Enabled":
            if end == "stop":
                a.stop_external_setpoint_generation()
            elif end != "missing":
                STOPS[end](engine)
        engine.run(1.0)
        data = record.stop()["a"]
        assert np.hypot(data["velocity_x"], data["velocity_y"]).max() <= fastest * 1.0001
