"""PL-86: moves and halts of one coordinate of a mover, halts along a track, and how its speed is bounded in curves."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine, Mover, checks
from test_surface import Watch

V, A, J = 2000.0, 10_000.0, 200_000.0
EACH = 0.5**0.5  # of the maxima, that X and Y each have by themselves
MAXIMUM = {"maximum": {"velocity": V, "acceleration": A, "jerk": J}}
MOVER = {"name": "a", "initial": {"x": 200, "y": 200}, "xy": MAXIMUM}
STATORS = [{"x": 240 * i, "y": 240 * k} for i in range(4) for k in range(3)]
EDGE = 960 - 113 / 2
ON_PARTS = {
    "coordinate_systems": [{"name": "hall"}],
    "parts": [{"name": "floor", "stators": STATORS, "positions": [{"coordinate_system": "hall"}]}],
}


def engine_of(*others: dict[str, Any], mover: dict[str, Any] | None = None, **more: Any) -> Engine:
    """One mover, and others, all enabled."""
    engine = Engine({"name": "each", "axes": [], "movers": [{**MOVER, **(mover or {})}, *others], **more})
    for component in (*engine.movers.values(), *engine.tracks.values(), *engine.planar_groups.values()):
        component.enable().wait()
    return engine


def within_limits(recording: takt.Recording, *names: str) -> None:
    for name in names:
        verdict = checks.within_limits(recording, name)
        assert verdict.passed, verdict.sentence


# --- each by itself ---


def along_x(mover: Mover) -> takt.Feedback:
    return mover.move_x(position=900)


def on_and_on(mover: Mover) -> takt.Feedback:
    return mover.move_velocity_x(velocity=800)


def along_y(mover: Mover) -> takt.Feedback:
    return mover.move_relative_y(distance=-300)


@pytest.mark.parametrize("go", [along_x, on_and_on])
@pytest.mark.parametrize(
    "other",
    [
        along_y,
        lambda mover: mover.move_y(position=500, velocity=300),
        lambda mover: mover.move_velocity_y(velocity=-5000),
        lambda mover: mover.halt_y(),
        lambda mover: mover.move_relative_c(distance=10),
        lambda mover: mover.move_z(position=3),
        lambda mover: mover.halt_c(),
    ],
)
def test_the_other_coordinates_go_on_as_they_did(
    go: Callable[[Mover], takt.Feedback], other: Callable[[Mover], takt.Feedback]
) -> None:
    """X is where it would be if nothing else had been told, in every cycle; Y likewise, once it is told."""
    recordings = []
    for with_other in (False, True):
        engine = engine_of()
        a = engine.mover("a")
        with engine.record() as recorder:
            first = go(a)
            engine.run(0.15)
            if with_other:
                other(a)
                engine.run(0.1)
                other(a)
                engine.run(0.75)
            else:
                engine.run(0.85)
        assert not first.aborted
        recordings.append(recorder.recording)
        within_limits(recorder.recording, "a")
    alone, both = (r["a"] for r in recordings)
    for field in ("x", "velocity_x", "acceleration_x"):
        np.testing.assert_allclose(both[field], alone[field], rtol=0, atol=1e-7)


def test_both_have_what_one_alone_has() -> None:
    """Both ask for more than the mover can do; the vectors keep its maxima, which are reached."""
    engine = engine_of()
    a = engine.mover("a")
    with engine.record() as recorder:
        moves = [a.move_velocity_x(velocity=9000), a.move_velocity_y(velocity=9000)]
        engine.step(2)
        assert a.limited_by == "velocity"
        for move in moves:
            move.wait(until="reached")
        assert (a.velocity_x, a.velocity_y) == (pytest.approx(EACH * V), pytest.approx(EACH * V))
        assert not any(move.final for move in moves)
        halts = [a.halt_x(), a.halt_y()]
        for halt in halts:
            halt.wait()
    assert all(move.aborted for move in moves)
    within_limits(recorder.recording, "a")
    table = recorder.recording["a"]
    assert np.hypot(table["velocity_x"], table["velocity_y"]).max() == pytest.approx(V)
    assert np.hypot(table["acceleration_x"], table["acceleration_y"]).max() == pytest.approx(A)


def test_they_are_as_quick_as_their_limits_allow() -> None:
    """PL-15: as quick as a straight move with the limits that one coordinate has by itself."""
    share = {"velocity": EACH * V, "acceleration": EACH * A, "deceleration": EACH * A, "jerk": EACH * J}
    times = []
    for go in (
        lambda a: a.move_x(position=900),
        lambda a: a.move_relative_x(distance=700),
        lambda a: a.move_to_position(x=900, y=200, **share),
    ):
        engine = engine_of()
        begin = engine.cycle
        go(engine.mover("a")).wait()
        assert engine.mover("a").x == 900
        times.append(engine.cycle - begin)
    assert max(times) - min(times) <= 1


def test_relative_counts_from_where_it_begins() -> None:
    engine = engine_of()
    a = engine.mover("a")
    a.move_relative_x(distance=500)
    engine.run(0.2)
    at = a.x
    a.move_relative_x(distance=100).wait()
    assert a.x == pytest.approx(at + 100, abs=1.5)  # a cycle at its speed
    a.move_relative_x(distance=-40, buffer_mode="buffered")
    a.move_relative_y(distance=7, buffer_mode="buffered").wait()
    assert (a.x, a.y) == (pytest.approx(at + 60, abs=1.5), 207)
    a.move_relative_c(distance=12).wait()
    a.move_relative_c(distance=-20).wait()
    assert a.c == pytest.approx(-8)


def test_a_velocity_may_be_changed_turned_round_and_taken_away() -> None:
    engine = engine_of()
    a = engine.mover("a")
    with engine.record() as recorder:
        for velocity in (600, 150, -700, -701):
            a.move_velocity_x(velocity=velocity).wait(until="reached")
            assert a.velocity_x == pytest.approx(velocity)
        a.move_velocity_x(velocity=0).wait()
        assert a.velocity_x == 0
        turn = a.move_velocity_c(velocity=-200)
        turn.wait(until="reached")
        engine.run(3)
        assert a.c < -500
        assert a.command_mode == "CRotationFreeMovement"
        assert a.move_x(position=0).wait_final().error_id == 3041
        a.halt_c(deceleration=1000).wait()
        assert turn.aborted
    within_limits(recorder.recording, "a")


@pytest.mark.parametrize("straight", [False, True])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_no_jerk_takes_a_coordinate_beyond_its_maxima(seed: int, straight: bool) -> None:
    """PL-86: for any motion of X and Y, a command with a softer jerk takes the acceleration away in time."""
    rng = random.Random(seed)
    engine = engine_of()
    a = engine.mover("a")
    with engine.record() as recorder:
        for _ in range(80):
            of = rng.choice("xy")
            jerk = 10 ** rng.uniform(1.5, 5.4)
            match rng.randrange(8 if straight else 6):
                case 0:
                    getattr(a, f"move_{of}")(position=rng.uniform(-2000, 2000), jerk=jerk)
                case 1:
                    getattr(a, f"move_relative_{of}")(distance=rng.uniform(-2000, 2000), jerk=jerk)
                case 2:
                    getattr(a, f"move_velocity_{of}")(velocity=rng.uniform(-1500, 1500), jerk=jerk)
                case 3:
                    getattr(a, f"halt_{of}")(jerk=jerk)
                case 4 | 5:
                    getattr(a, f"move_velocity_{of}")(velocity=rng.choice([-1500, 1500]))
                case 6:
                    a.halt(jerk=jerk)
                case _:
                    x, y = (rng.uniform(-2000, 2000) for _ in "xy")
                    a.move_to_position(x=x, y=y, jerk=rng.choice([jerk, J]))
            engine.run(rng.choice([0.02, 0.06, 0.12, 0.2, 0.6, 1.5]))
            assert a.error == 0
    within_limits(recorder.recording, "a")
    if not straight:
        for of in "xy":
            assert np.abs(recorder.recording.column("a", f"velocity_{of}")).max() <= EACH * V * (1 + 1e-6)
            assert np.abs(recorder.recording.column("a", f"acceleration_{of}")).max() <= EACH * A * (1 + 1e-6)


@pytest.mark.parametrize(("of", "most"), [("x", EACH * V), ("c", 3600)])
def test_a_softer_jerk_leaves_the_velocity_asked_for(of: str, most: float) -> None:
    """PL-86: as fast as commanded in the end, though the acceleration is taken away with more than the jerk given."""
    fast = {"maximum": {"velocity": 3600, "acceleration": 3600, "jerk": 72000}, "lower": -15, "upper": 15}
    engine = engine_of(mover={"c": fast})
    a = engine.mover("a")
    move = getattr(a, f"move_velocity_{of}")
    move(velocity=0.99 * most)
    engine.wait(lambda: getattr(a, f"velocity_{of}") > 0.5 * most, 2)
    with engine.record() as recorder:
        move(velocity=0.05 * most, jerk=1000).wait(until="reached", timeout=60)
    assert getattr(a, f"velocity_{of}") == pytest.approx(0.05 * most)
    assert np.abs(recorder.recording.column("a", f"velocity_{of}")).max() <= most * (1 + 1e-6)


def test_a_softer_halt_of_a_coordinate_stops_as_near_as_one_of_both() -> None:
    """PL-86: by a jerk that is too soft both stop with the maximum dynamics."""
    xs = []
    for one in (True, False):
        engine = engine_of(mover={"xy": {"maximum": {"velocity": 1500, "acceleration": 2500, "jerk": 12500}}})
        a = engine.mover("a")
        a.move_x(position=1350) if one else a.move_to_position(x=1350, y=200)
        engine.run(0.2)
        (a.halt_x if one else a.halt)(jerk=100).wait(timeout=60)
        xs.append(a.x)
    assert xs[0] == pytest.approx(xs[1], abs=200)


@pytest.mark.parametrize("speed", [700, 2000])
def test_they_take_over_from_a_straight_move_and_the_other_way_round(speed: float) -> None:
    engine = engine_of()
    a = engine.mover("a")
    with engine.record() as recorder:
        for k in range(40):
            line = a.move_to_position(x=100 * (k % 7), y=2000 if k % 2 else -700, c=10 if k % 3 else -5, velocity=speed)
            engine.step(11 + 17 * k % 300)
            each = (a.move_x, a.move_y)[k % 2](position=50 * k)
            engine.step(1 + 13 * k % 150)
            assert line.aborted
            if k % 3 == 0:
                each.wait()
                assert (a.x, a.y)[k % 2] == 50 * k
                assert (a.velocity_x, a.velocity_y) == (0, 0)
    within_limits(recorder.recording, "a")


@pytest.mark.parametrize("which", "xyzabc")
def test_a_halt_of_one_leaves_the_others(which: str) -> None:
    engine = engine_of()
    a = engine.mover("a")
    with engine.record() as recorder:
        moves = {
            "x": a.move_velocity_x(velocity=400),
            "y": a.move_y(position=2000, velocity=300),
            "z": a.move_z(position=4, velocity=5),
            "a": a.move_a(position=4, velocity=5),
            "b": a.move_b(position=-4, velocity=5),
            "c": a.move_c(position=10, velocity=10),
        }
        engine.run(0.3)
        halt = getattr(a, f"halt_{which}")()
        halt.wait()
        assert getattr(a, f"velocity_{which}") == 0
        assert {name for name, move in moves.items() if move.aborted} == {which}
        assert all(getattr(a, f"velocity_{name}") != 0 for name in moves if name != which)
        engine.run(0.5)
    within_limits(recorder.recording, "a")


def test_a_halt_of_x_or_y_ends_a_straight_move_on_its_line() -> None:
    engine = engine_of()
    a = engine.mover("a")
    move = a.move_to_position(x=1200, y=700)
    engine.run(0.3)
    a.halt_x(deceleration=3000).wait()
    assert move.aborted
    assert (a.x - 200) / (a.y - 200) == pytest.approx(2)
    assert (a.velocity_x, a.velocity_y) == (0, 0)


# --- where there is no more room ---


@pytest.mark.parametrize("velocity", [30, 400, 9000])
def test_by_velocity_it_goes_to_the_edge_of_the_surface(velocity: float) -> None:
    engine = engine_of(**ON_PARTS)
    a = engine.mover("a")
    with engine.record() as recorder:
        on = a.move_velocity_x(velocity=velocity)
        engine.run(0.05)
        a.move_y(position=500).wait()
        done = on.wait_final(60)
        assert done.error_id == 3071
        assert done.object is engine.part("floor")
        assert a.x == pytest.approx(EDGE, abs=0.1)
        assert a.x <= EDGE + 1e-6
        assert a.velocity_x == 0
        again = a.move_velocity_x(velocity=velocity).wait_final()
        assert (again.error_id, again.object) == (3071, engine.part("floor"))
        assert a.move_x(position=2000).wait_final().error_id == 3071
        assert a.state == "Enabled"
    within_limits(recorder.recording, "a")


def test_a_velocity_that_ends_for_want_of_room_ends_what_is_buffered() -> None:
    """PL-71."""
    engine = engine_of(**ON_PARTS)
    a = engine.mover("a")
    on = a.move_velocity_x(velocity=400)
    behind = a.move_to_position(x=200, y=200, buffer_mode="buffered")
    assert on.wait_final(60).error_id == 3071
    engine.run(1)
    assert behind.aborted
    assert a.x == pytest.approx(EDGE, abs=0.1)


def test_a_refused_command_leaves_limited_by() -> None:
    """PL-03: it says what was reduced of the last command that was carried out."""
    engine = engine_of(**ON_PARTS)
    a = engine.mover("a")
    a.move_to_position(x=800, y=200, velocity=1e6)
    engine.step(2)
    assert a.limited_by == "velocity"
    refused = [
        a.move_x(position=5000),
        a.move_relative_y(distance=5000),
        a.move_to_position(x=5000, y=200),
        a.move_z(position=99),
    ]
    engine.step(2)
    assert all(command.error_id for command in refused)
    assert a.limited_by == "velocity"


def test_by_velocity_it_goes_as_far_as_its_group_has_room() -> None:
    engine = engine_of(
        {"name": "b", "initial": {"x": 700, "y": 200}},
        environments=[{"name": "floor", "stators": STATORS}],
        planar_groups=[{"name": "g", "movers": ["a", "b"], "environment": "floor"}],
    )
    a, b = engine.movers.values()
    watch = Watch(engine)
    ends = a.move_velocity_x(velocity=500).wait_final()
    assert (ends.error_id, ends.object) == (3024, b)
    assert a.x == pytest.approx(700 - 113, abs=0.11)
    b.move_velocity_y(velocity=500)  # that is its area: up to the border
    engine.run(0.05)
    assert a.move_y(position=400).wait_final().done
    ends = a.move_velocity_x(velocity=500).wait_final()
    assert (ends.error_id, ends.object) == (3024, b)
    b.move_velocity_y(velocity=-500).wait_final()
    ends = a.move_velocity_x(velocity=500).wait_final()
    assert (ends.error_id, ends.object) == (3024, engine.environment("floor"))
    assert a.x == pytest.approx(EDGE, abs=0.11)
    assert not watch.overlaps


def test_another_mover_in_its_way_is_waited_for() -> None:
    """Without a group: it brakes before it, X and Y, and goes on with both once the way is clear."""
    engine = engine_of({"name": "b", "initial": {"x": 700, "y": 200}})
    a, b = engine.movers.values()
    watch = Watch(engine)
    with engine.record() as recorder:
        x, y = a.move_velocity_x(velocity=500), a.move_y(position=260, velocity=20)
        engine.wait(lambda: a.delay == "mover" and a.velocity_x == 0, 5)
        assert (a.waits_for, a.blocked_by) == (2, b)
        assert not x.final
        engine.run(0.2)
        b.move_y(position=600)
        y.wait()
        x.wait(until="reached")
        assert a.y == 260
        engine.wait(lambda: a.x > 1000, 5)
    assert not watch.overlaps
    within_limits(recorder.recording, "a", "b")


def test_a_coordinate_is_halted_while_another_mover_is_in_the_way() -> None:
    engine = engine_of({"name": "b", "initial": {"x": 700, "y": 200}})
    a, b = engine.movers.values()
    x, y = a.move_velocity_x(velocity=500), a.move_y(position=230, velocity=20)
    engine.wait(lambda: a.delay == "mover" and a.velocity_x == 0, 5)
    a.halt_x().wait()
    assert x.aborted
    y.wait()
    assert a.y == 230
    assert a.delay == "none"
    x = a.move_x(position=900)
    engine.wait(lambda: a.delay == "mover", 5)
    a.halt_x().wait()
    b.move_y(position=600).wait()
    engine.run(0.5)
    assert a.velocity_x == 0
    assert a.x < 700 - 113


# --- refused ---

HALTS = [f"halt_{c}" for c in "xyzabc"]
COMMANDS: dict[str, dict[str, Any]] = {
    "move_x": {"position": 300},
    "move_y": {"position": 300},
    "move_relative_x": {"distance": 10},
    "move_relative_y": {"distance": 10},
    "move_relative_c": {"distance": 1},
    "move_velocity_x": {"velocity": 100},
    "move_velocity_y": {"velocity": -100},
    "move_velocity_c": {"velocity": 10},
    **{halt: {} for halt in HALTS},
    "halt_on_track": {},
}
OF_C = {"move_relative_c", "move_velocity_c", "halt_c"}
OF_Z_A_B = {"halt_z", "halt_a", "halt_b"}
OF_X_Y = COMMANDS.keys() - OF_C - OF_Z_A_B - {"halt_on_track"}
LINE = {"name": "t", "elements": [{"from": {"x": 0, "y": 200}, "to": {"x": 900, "y": 200}}]}


def in_mode(mode: str) -> Engine:
    engine = engine_of({"name": "star", "initial": {"x": 400, "y": 400}}, mover={"missing_setpoints": 9}, tracks=[LINE])
    a = engine.mover("a")
    match mode:
        case "Disabled":
            a.disable().wait()
        case "JoiningTrack":
            a.move_y(position=300).wait()
            a.join_track(track="t")
        case "OnTrack" | "LeavingTrack" | "CRotationOnTrack":
            a.join_track(track="t").wait()
            if mode == "LeavingTrack":
                a.leave_track(x=200, y=400)
            if mode == "CRotationOnTrack":
                a.move_c(position=45).wait()
        case "CRotationFreeMovement":
            a.move_c(position=45).wait()
        case "ExternalSetpointGeneration":
            a.start_external_setpoint_generation()
        case "Formation":
            a.join_formation(star="star").wait(until="reached")
    engine.step(2)
    return engine


@pytest.mark.parametrize(
    ("mode", "accepted"),
    [
        ("Disabled", set()),
        ("FreeMovement", OF_X_Y | OF_C | OF_Z_A_B),
        ("CRotationFreeMovement", OF_C | OF_Z_A_B),
        ("OnTrack", OF_C | OF_Z_A_B | {"halt_on_track"}),
        ("CRotationOnTrack", OF_C | OF_Z_A_B | {"halt_on_track"}),
        ("JoiningTrack", set()),
        ("LeavingTrack", set()),
        ("ExternalSetpointGeneration", set()),
        ("Formation", OF_Z_A_B),
    ],
)
def test_what_each_mode_accepts(mode: str, accepted: set[str]) -> None:
    for command, arguments in COMMANDS.items():
        engine = in_mode(mode)
        feedback = getattr(engine.mover("a"), command)(**arguments)
        engine.step(2)
        if command in accepted:
            assert not feedback.error, (command, feedback.sentence)
        else:
            assert feedback.error_id == (3040 if mode == "Disabled" else 3041), command
            assert mode == "Disabled" or mode in feedback.sentence or "mover" in feedback.sentence


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e13, -1.0])
def test_bad_numbers_are_refused_with_a_sentence(command: str, value: float) -> None:
    engine = engine_of()
    for name in ("jerk", *COMMANDS[command]):
        if value == -1.0 and name != "jerk":
            continue
        arguments = {**COMMANDS[command], name: value * 1e3 if name == "jerk" else value}
        feedback = getattr(engine.mover("a"), command)(**arguments).wait_final()
        assert feedback.error_id == 5
        assert f"{name}: expected a" in feedback.sentence


def test_unknown_references_are_refused() -> None:
    engine = engine_of(**ON_PARTS)
    assert engine.mover("a").move_x(position=300, reference="floor").wait_final().done
    refused = engine.mover("a").move_y(position=300, reference="roof").wait_final()
    assert refused.sentence == "reference: expected the name of a part or a coordinate system, found 'roof'"


# --- whatever they are told ---

STOPS: list[Callable[[Engine, Mover], Any]] = [
    lambda e, m: m.halt(),
    lambda e, m: m.halt(deceleration=800, jerk=9000),
    lambda e, m: m.disable(),
    lambda e, m: e.stop_all(),
    lambda e, m: m.halt_x(deceleration=300),
    lambda e, m: m.halt_y(),
    lambda e, m: m.halt_c(deceleration=100),
    lambda e, m: m.halt_on_track(deceleration=900),
]


def tell(rng: random.Random, engine: Engine, mover: Mover) -> None:
    dynamics = {"acceleration": rng.uniform(500, 12_000), "deceleration": rng.uniform(500, 12_000)}
    buffered = {"buffer_mode": "buffered"} if rng.random() < 0.15 else {}
    axis = rng.choice("xy")
    match rng.randrange(16):
        case 0 | 1 | 2:
            getattr(mover, f"move_{axis}")(position=rng.uniform(60, 900), **dynamics, **buffered)
        case 3 | 4:
            getattr(mover, f"move_relative_{axis}")(distance=rng.uniform(-400, 400), **dynamics, **buffered)
        case 5 | 6 | 7:
            getattr(mover, f"move_velocity_{axis}")(velocity=rng.uniform(-1500, 1500), **dynamics, **buffered)
        case 8:
            mover.move_to_position(x=rng.uniform(60, 900), y=rng.uniform(60, 660), velocity=rng.uniform(100, 3000))
        case 9:
            mover.move_to_position(x=rng.uniform(60, 900), y=rng.uniform(60, 660), c=rng.uniform(-15, 15), **buffered)
        case 10:
            mover.move_relative_c(distance=rng.uniform(-10, 10))
        case 11:
            mover.move_velocity_c(velocity=rng.uniform(-300, 300))
        case 12:
            mover.move_c(position=0, direction="shortest_way")
        case 13:
            rng.choice(STOPS)(engine, mover)
        case 14:
            mover.join_track(track="t", use_orientation=rng.random() < 0.5)
            mover.move_on_track(position=rng.uniform(60, 840), buffer_mode="buffered")
        case _:
            mover.leave_track(x=rng.uniform(60, 900), y=rng.uniform(60, 660))


@pytest.mark.parametrize("where", ["plane", "parts", "group", "patient group"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_whatever_movers_are_told_they_keep_apart_on_the_stators_and_within_their_limits(where: str, seed: int) -> None:
    """PL-80 to PL-82: three movers, all commands, stops and halts at any time."""
    rng = random.Random(f"{where} {seed}")
    names = "abc"
    surface: dict[str, Any] = {"tracks": [LINE]}
    if where == "parts":
        surface |= ON_PARTS
        surface["tracks"] = [
            {**LINE, "part": "floor", "elements": [{"from": {"x": 60, "y": 200}, "to": {"x": 900, "y": 200}}]}
        ]
    elif where != "plane":
        wait = {"moves_wait": True} if where.startswith("patient") else {}
        surface |= {
            "environments": [{"name": "floor", "stators": STATORS}],
            "planar_groups": [{"name": "g", "movers": list(names), "environment": "floor", **wait}],
        }
        surface["tracks"] = []
    others = [{**MOVER, "name": n, "initial": {"x": 200 + 250 * i, "y": 200 + 130 * i}} for i, n in enumerate("bc", 1)]
    engine = engine_of(*others, **surface)
    movers = list(engine.movers.values())
    with engine.record() as recorder:
        for _ in range(120):
            mover = rng.choice(movers)
            if mover.state == "Disabled":
                mover.enable()
            tell(rng, engine, mover)
            engine.step(rng.choice([1, 3, 20, 60, 150]))
            assert all(m.error == 0 for m in movers)
        engine.stop_all()
        engine.run(1)
        assert all(m.velocity_x == m.velocity_y == m.velocity_c == 0 for m in movers)
    recording = recorder.recording
    within_limits(recording, *names)
    tables = {name: recording[name] for name in names}
    if where != "plane":
        for table in tables.values():
            assert covers(table, "x").max() <= 960 + 1e-6
            assert covers(table, "x", -1).min() >= -1e-6
            assert covers(table, "y").max() <= 720 + 1e-6
            assert covers(table, "y", -1).min() >= -1e-6
    for one, other in ("ab", "ac", "bc"):
        assert apart(tables[one], tables[other]).min() > -1e-5
    given = [record for m in movers for record in m.history()]
    assert len({r.verb for r in given if r.state.name == "DONE"}) > 4, {r.verb for r in given}


def covers(table: np.ndarray, axis: str, sense: int = 1) -> np.ndarray:
    """How far the square reaches, turned as it is."""
    turned = np.deg2rad(table["c"])
    return np.asarray(table[axis] + sense * 113 / 2 * (np.abs(np.cos(turned)) + np.abs(np.sin(turned))))


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """By separating axes: mm between two squares, below 0 where they overlap."""
    x, y, most = b["x"] - a["x"], b["y"] - a["y"], np.full(len(a), -1e9)
    for by, other in ((a, b), (b, a)):
        for quarter in (0, 90):
            along = np.deg2rad(by["c"] + quarter)
            turned = np.deg2rad(other["c"] - by["c"])
            reach = 113 / 2 * (1 + np.abs(np.cos(turned)) + np.abs(np.sin(turned)))
            most = np.maximum(most, np.abs(x * np.cos(along) + y * np.sin(along)) - reach)
    return most


def test_a_formation_moves_by_coordinates_as_one_body() -> None:
    engine = engine_of({"name": "p", "initial": {"x": 400, "y": 260}, "xy": MAXIMUM})
    a, p = engine.movers.values()
    p.join_formation(star="a").wait(until="reached")
    with engine.record() as recorder:
        x, y = a.move_velocity_x(velocity=500), a.move_relative_y(distance=300)
        y.wait()
        x.wait(until="reached")
        a.halt_x().wait()
        turn = a.move_velocity_c(velocity=30).wait_final()
        assert turn.error_id == 3042
        a.move_relative_c(distance=10).wait()
        a.move_x(position=500)
        engine.run(0.1)
        assert a.move_relative_c(distance=-5).wait_final().error_id == 3093
        p.halt().wait()
        assert a.history()[-2].error_id == 3092
    within_limits(recorder.recording, "a", "p")
    one, other = recorder.recording["a"], recorder.recording["p"]
    distance = np.hypot(one["x"] - other["x"], one["y"] - other["y"])
    assert np.ptp(distance) < 1e-9


# --- stops, and parts that go ---


def test_an_emergency_stop_that_is_held_refuses_moves_but_not_halts() -> None:
    engine = engine_of()
    a = engine.mover("a")
    x, y = a.move_velocity_x(velocity=900), a.move_velocity_y(velocity=300)
    engine.run(0.3)
    engine.emergency_stop(hold=True)
    engine.run(1)
    assert x.final
    assert y.final
    assert (a.velocity_x, a.velocity_y) == (0, 0)
    for command, arguments in COMMANDS.items():
        error = getattr(a, command)(**arguments).wait_final().error_id
        assert (error == 3100) is not command.startswith("halt_"), command


@pytest.mark.parametrize(
    "stop",
    [
        lambda e: e.mover("a").halt(),
        lambda e: e.stop_all(),
        lambda e: e.mover("a").disable(),
        lambda e: e.shut_down(),
        lambda e: e.mover("a").start_external_setpoint_generation(mode="relative"),  # and none comes: a fault
    ],
)
def test_whatever_stops_the_mover_ends_both(stop: Callable[[Engine], Any]) -> None:
    engine = engine_of()
    a = engine.mover("a")
    with engine.record() as recorder:
        moves = [a.move_velocity_x(velocity=900), a.move_velocity_y(velocity=-700), a.move_velocity_x(velocity=300)]
        moves.append(a.move_relative_x(distance=5, buffer_mode="buffered"))
        engine.run(0.3)
        stop(engine)
        engine.run(1)
    assert all(move.final for move in moves)
    assert (a.velocity_x, a.velocity_y) == (0, 0)
    within_limits(recorder.recording, "a")


LIFT = {
    "coordinate_systems": [{"name": "lower"}, {"name": "upper"}],
    "parts": [
        {"name": "hall", "columns": 2, "rows": 2, "positions": [{"coordinate_system": "lower"}]},
        {
            "name": "lift",
            "columns": 1,
            "rows": 2,
            "positions": [{"coordinate_system": "lower", "x": 480}, {"coordinate_system": "upper", "x": 480}],
            "travel_time_s": 0.1,
        },
    ],
}


def test_a_part_that_leaves() -> None:
    """Not below what a move by velocity still has; with the mover on it at rest; and the edge is where it was."""
    engine = engine_of(mover={"reference": "hall", "initial": {"x": 120, "y": 120}}, **LIFT)
    a, lift = engine.mover("a"), engine.part("lift")
    with engine.record() as recorder:
        on = a.move_velocity_x(velocity=400)
        engine.run(0.2)
        going = lift.activate_position(index=2).wait_final()
        assert (going.error_id, going.object) == (3073, a)
        assert on.wait_final().error_id == 3071
        assert a.x == pytest.approx(720 - 113 / 2, abs=0.11)
        lift.activate_position(index=2).wait()
        assert a.coordinate_system == 2
        ends = a.move_velocity_x(velocity=-400).wait_final()  # up there is the lift alone
        assert (ends.error_id, ends.object) == (3071, lift)
        assert a.x == pytest.approx(480 + 113 / 2, abs=0.11)
        y = a.move_velocity_y(velocity=100)
        engine.run(0.2)
        a.halt_y().wait()
        assert y.aborted
        moved = a.move_relative_x(distance=-10).wait_final()
        assert (moved.error_id, moved.object) == (3071, lift)
        lift.activate_position(index=1).wait()
        a.move_x(position=120, reference="hall").wait()
        lift.activate_position(index=2).wait()
        ends = a.move_velocity_x(velocity=400).wait_final()
        assert a.x == pytest.approx(480 - 113 / 2, abs=0.11)
        a.move_velocity_x(velocity=-30)
        engine.run(0.1)
        assert lift.activate_position(index=1).wait_final().done
        engine.run(0.3)
        assert a.velocity_x == pytest.approx(-30)
    recording = recorder.recording
    data = recording["a"]
    for fields, limit in ((("velocity_x", "velocity_y"), V), (("acceleration_x", "acceleration_y"), A)):
        assert np.hypot(*(data[f] for f in fields)).max() <= limit * (1 + 1e-6)


# --- along tracks ---


def test_halt_on_track_leaves_what_does_not_move_along_it() -> None:
    engine = engine_of(tracks=[LINE])
    a = engine.mover("a")
    a.join_track(track="t").wait()
    with engine.record() as recorder:
        move, lift, turn = (
            a.move_on_track(position=850, velocity=800),
            a.move_z(position=5, velocity=4),
            a.move_c(position=9, velocity=9),
        )
        then = a.move_on_track(position=100, buffer_mode="buffered")
        engine.run(0.25)
        speed, at = a.track_velocity, a.track_position
        halt = a.halt_on_track(deceleration=4000)
        halt.wait()
        assert move.aborted
        assert then.aborted
        assert (a.track_velocity, a.command_mode) == (0, "OnTrack")
        assert a.track_position > at + speed**2 / (2 * 4000) > at
        assert a.velocity_z > 0
        assert a.velocity_c > 0
        lift.wait()
        turn.wait()
        a.move_on_track(position=at, direction="negative").wait()
        a.move_on_track(position=800)
        engine.run(0.2)
        again = a.halt_on_track()
        engine.step(2)
        a.move_on_track(position=300).wait()
        assert again.aborted
    within_limits(recorder.recording, "a")
    assert a.halt_on_track().wait_final().done


def test_halt_on_track_ends_a_gear() -> None:
    engine = engine_of({"name": "b", "initial": {"x": 500, "y": 200}, "xy": MAXIMUM}, tracks=[LINE])
    a, b = engine.movers.values()
    for mover in (a, b):
        mover.join_track(track="t").wait()
    gear = a.gear_in_pos_on_track_with_master_mover(master="b", master_sync_position=500, slave_sync_position=200)
    gear.wait(until="reached")
    b.move_on_track(position=850)
    engine.run(0.2)
    assert a.track_velocity > 100
    a.halt_on_track().wait()
    assert gear.aborted
    engine.run(0.5)
    assert a.track_velocity == 0


LOOP = {
    "name": "loop",
    "closed_loop": True,
    "elements": [
        {"from": {"x": 200, "y": 100}, "to": {"x": 800, "y": 100}},
        {"from": {"x": 900, "y": 200}, "to": {"x": 900, "y": 500}},
        {"from": {"x": 800, "y": 600}, "to": {"x": 200, "y": 600}},
        {"from": {"x": 100, "y": 500}, "to": {"x": 100, "y": 200}},
    ],
}


def test_dynamics_reduction() -> None:
    """Without it curves are faster, as far as the vectors allow; with it the lateral acceleration is kept."""
    times, most = {}, {}
    for reduction in ("acceleration_limited_velocity", "none"):
        engine = engine_of(mover={"lateral_acceleration": 2000.0}, tracks=[LOOP])
        a = engine.mover("a")
        a.join_track(track="loop", use_orientation=False).wait()
        begin = engine.cycle
        with engine.record() as recorder:
            a.move_on_track(
                position=a.track_position, direction="positive", additional_turns=1, dynamics_reduction=reduction
            ).wait()
        times[reduction] = engine.cycle - begin
        table = recorder.recording["a"]
        most[reduction] = np.hypot(table["acceleration_x"], table["acceleration_y"])
        jerk = np.hypot(np.diff(table["acceleration_x"]), np.diff(table["acceleration_y"])) / engine.period
        assert most[reduction].max() <= A * (1 + 1e-6)
        assert jerk.max() <= J * (1 + 2e-5)
        if reduction != "none":
            within_limits(recorder.recording, "a")
        lateral = np.abs(table["velocity_x"] * table["acceleration_y"] - table["velocity_y"] * table["acceleration_x"])
        speed = np.maximum(np.hypot(table["velocity_x"], table["velocity_y"]), 1e-9)
        most[reduction] = (lateral / speed).max()
    assert most["acceleration_limited_velocity"] <= 2000.01 < most["none"]
    assert times["none"] < 0.9 * times["acceleration_limited_velocity"]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_dynamics_reduction_may_change_in_a_curve(seed: int) -> None:
    """Whenever: velocity, acceleration and jerk as vectors keep their maxima, and it slows down to what it is told."""
    rng = random.Random(seed)
    engine = engine_of(mover={"lateral_acceleration": 1000.0}, tracks=[LOOP])
    a = engine.mover("a")
    a.join_track(track="loop", use_orientation=False).wait()
    with engine.record() as recorder:
        for _ in range(30):
            a.move_on_track(
                position=rng.uniform(0, 2400),
                direction="positive",
                dynamics_reduction=rng.choice(["none", "acceleration_limited_velocity"]),
                jerk=rng.uniform(50_000, J),
            )
            engine.run(rng.uniform(0.02, 0.5))
            if rng.random() < 0.2:
                a.halt_on_track(deceleration=rng.uniform(1000, A))
    table = recorder.recording["a"]
    for fields, limit in ((("velocity_x", "velocity_y"), V), (("acceleration_x", "acceleration_y"), A)):
        assert np.hypot(*(table[f] for f in fields)).max() <= limit * (1 + 1e-6)
    jerk = np.hypot(np.diff(table["acceleration_x"]), np.diff(table["acceleration_y"])) / engine.period
    assert jerk.max() <= J * (1 + 2e-5)


FORK = [
    {"name": "t", "elements": [{"from": {"x": 0, "y": 200}, "to": {"x": 400, "y": 200}}]},
    {"name": "u", "starts_from": ["t"], "elements": [{"from": {"x": 700, "y": 300}, "to": {"x": 700, "y": 500}}]},
    {"name": "v", "starts_from": ["u"], "elements": [{"from": {"x": 600, "y": 800}, "to": {"x": 400, "y": 800}}]},
    {"name": "w", "starts_from": ["t"], "elements": [{"from": {"x": 700, "y": 100}, "to": {"x": 700, "y": -100}}]},
]


def follow_the_trail(session: takt.Session) -> None:
    """The mover stands on t."""
    a = session.mover("a")
    assert list(a.track_trail()) == []
    a.join_track(track="t").wait()
    assert session.wait(lambda: list(a.track_trail()) == ["t"], 2) or True
    move = a.move_on_track(track="v", position=100, velocity=600)
    seen: list[list[str]] = []

    def look() -> bool:
        trail = list(a.track_trail())
        if trail not in seen[-1:]:
            seen.append(trail)
        return bool(move.done)

    session.wait(lambda: list(a.track_trail()) == ["t", "u", "v"], 2)
    assert isinstance(a.track_trail(), takt.TrackTrail)
    assert a.track_trail().information(session).length == pytest.approx(sum(session.track(n).length for n in "tuv"))
    session.wait(look, 10)
    session.wait(lambda: list(a.track_trail()) == ["v"], 2)
    assert [s for s in seen if s != seen[0]] == [["u", "v"], ["v"]]


def test_the_track_trail_is_what_its_command_leads_along() -> None:
    engine = engine_of(tracks=FORK)
    a = engine.mover("a")
    follow_the_trail(engine)
    engine = engine_of(tracks=FORK)
    a = engine.mover("a")
    a.join_track(track="t").wait()
    a.move_on_track(track="w", position=100)
    engine.step(3)
    assert list(a.track_trail()) == ["t", "w"]
    a.move_on_track(track="u", position=100)
    engine.step(2)
    assert list(a.track_trail()) == ["t", "u"]
    a.halt_on_track().wait()
    assert list(a.track_trail()) == ["t"]
    assert takt.TrackTrail(["t"]) is not None
    a.leave_track(x=200, y=500, use_orientation=False).wait()
    assert list(a.track_trail()) == []


# --- over LCM, and again ---


def test_the_track_trail_over_lcm(tmp_path: Path) -> None:
    machine = json.dumps({"name": "fork", "axes": [], "movers": [MOVER], "tracks": FORK})
    url = new_url()
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        session.mover("a").enable().wait()
        for track in session.tracks.values():
            track.enable().wait()
        follow_the_trail(session)


def test_over_lcm_and_again_from_the_log(tmp_path: Path) -> None:
    log, url = tmp_path / "run.lcm", new_url()
    machine = """
name: each
axes: []
movers: [{name: a, initial: {x: 200, y: 200}}]
tracks: [{name: t, elements: [{from: {x: 0, y: 200}, to: {x: 900, y: 200}}]}]
"""
    with running(tmp_path, url, "--log", str(log), machine=machine), takt.connect(url) as session:
        a = session.mover("a")
        a.enable().wait()
        session.track("t").enable().wait()
        on = a.move_velocity_x(velocity=50)
        on.wait(until="reached")
        a.move_relative_y(distance=25, velocity=500).wait()
        a.halt_x().wait()
        session.wait(lambda: a.y == 225 and a.velocity_x == 0)
        assert on.aborted
        a.move_velocity_c(velocity=100).wait(until="reached")
        a.halt_c().wait()
        a.move_c(position=0, direction="shortest_way").wait()
        with pytest.raises(takt.CommandError, match="command mode"):
            a.halt_on_track().wait()
        with pytest.raises(takt.CommandError, match="distance: expected a number in mm"):
            a.move_relative_x(distance=1e12).wait()
        a.join_track(track="t").wait()
        a.move_on_track(position=800, dynamics_reduction="none")
        a.halt_on_track().wait()
    result = takt.replay(log)
    assert result.same, result
