"""Moves that wait for their area in turn instead of being refused (PL-72), in enabled groups, and what ends them."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
import takt
from machines import new_url, running
from takt import Engine
from test_surface import Watch

PITCH = 150.0
FLOOR = "environments: [{name: floor, stators: [%s]}]\n"


def row(count: int, names: str, more: str = "", extra: str = "") -> str:
    """Movers in a row, one pitch apart, on `count` stators, in a group."""
    movers = "".join(f"  - {{name: {n}, initial: {{x: {75 + PITCH * i}, y: 120}}}}\n" for i, n in enumerate(names))
    floor = FLOOR % ", ".join(f"{{x: {240 * i}, y: {y}}}" for i in range(count) for y in (0, 240))
    group = f"planar_groups: [{{name: group, movers: [{', '.join(names)}], environment: floor{more}}}]\n"
    return f"name: row\naxes: []\nmovers:\n{movers}{floor}{group}{extra}"


def enabled(session: takt.Session) -> list[takt.Mover]:
    movers = list(session.movers.values())
    for component in (*movers, *session.tracks.values(), session.planar_group("group")):
        component.enable().wait()
    return movers


def place(k: float) -> dict[str, float]:
    return {"x": 75 + PITCH * k, "y": 120}


def waiting(session: takt.Session) -> list[tuple[str, int, bool]]:
    return [(m.delay.value, m.waits_for, m.deadlocked) for m in session.movers.values()]


def test_a_train_moves_up_by_one_place() -> None:
    """Each waits until the mover ahead has left, says for which one, and begins in that cycle."""
    engine = Engine(row(5, "abc"))
    a, b, c = enabled(engine)
    watch = Watch(engine)
    moves = [m.move_to_position(**place(k), buffer_mode="buffered") for k, m in enumerate((a, b, c), 1)]
    engine.step(3)
    assert [move.state.name for move in moves] == ["BUSY", "BUSY", "ACTIVE"]
    assert waiting(engine) == [("mover", 2, False), ("mover", 3, False), ("none", 0, False)]
    assert a.blocked_by is b
    engine.wait(lambda: moves[1].active, 1)
    assert 0 <= (c.x - 113 / 2) - (place(2)["x"] + 113 / 2) < 3  # it has just left
    engine.wait(lambda: all(move.done for move in moves), 2)
    assert [m.x for m in (a, b, c)] == [place(k)["x"] for k in (1, 2, 3)]
    assert a.history()[-1].error_id == 0
    assert not watch.overlaps


def test_unless_told_so_a_move_is_refused() -> None:
    """PL-30: at once, and of a mover that stands; what will not go away is never waited for."""
    engine = Engine(row(5, "ab"))
    a, b = enabled(engine)
    refused = a.move_to_position(**place(1)).wait_final()
    assert (refused.error_id, refused.object) == (3024, b)
    border = a.move_to_position(x=-500, y=120, buffer_mode="buffered").wait_final()
    assert border.object is engine.environment("floor")


@pytest.mark.parametrize("moving", [False, True])
def test_a_group_in_which_moves_wait(moving: bool) -> None:
    """What is in progress is aborted, as by any move; the mover comes to rest and its move takes its turn."""
    engine = Engine(row(6, "ab", ", moves_wait: true"))
    a, b = enabled(engine)
    watch = Watch(engine)
    before = a.move_to_position(x=75, y=360)
    if moving:
        engine.wait(lambda: a.velocity_y > 300)
    else:
        before.wait()
    move = a.move_to_position(**place(1))
    engine.step(3)
    assert (move.state.name, before.final) == ("BUSY", True)
    assert before.aborted is moving
    engine.run(0.5)
    assert (a.velocity_x, a.velocity_y) == (0, 0)
    assert waiting(engine)[0] == ("mover", 2, False)
    border = b.move_to_position(x=225, y=-500).wait_final()
    assert border.object is engine.environment("floor")
    b.move_to_position(**place(6))
    move.wait()
    assert not watch.overlaps


def test_movers_that_wait_for_one_another_say_so() -> None:
    """Two for each other, one behind them; whoever is sent elsewhere sets the others free."""
    engine = Engine(row(5, "abcd"))
    a, b, c, _ = enabled(engine)
    watch = Watch(engine)
    moves = [
        a.move_to_position(**place(1), buffer_mode="buffered"),
        b.move_to_position(**place(0), buffer_mode="buffered"),
        c.move_to_position(**place(1), buffer_mode="buffered"),
    ]
    engine.step(4)
    assert waiting(engine) == [("mover", 2, True), ("mover", 1, True), ("deadlock", 2, False), ("none", 0, False)]
    b.move_to_position(x=place(1)["x"], y=360).wait()  # takes over from what waits
    moves[0].wait()
    assert moves[1].aborted
    assert waiting(engine)[2] == ("mover", 1, False)
    a.move_to_position(**place(0)).wait()
    moves[2].wait()
    assert not watch.overlaps


def stop(engine: Engine, a: takt.Mover, how: str) -> None:
    if how == "halt":
        a.halt().wait()
    elif how == "disable":
        a.disable().wait()
    elif how == "fault":
        a.start_external_setpoint_generation().wait_final()  # and no set point comes
    elif how == "emergency_stop":
        engine.command("machine", "emergency_stop", {"hold": False})
    else:
        engine.command("machine", "stop_all", {"open_loops": False})
    engine.run(0.2)


@pytest.mark.parametrize("how", ["halt", "disable", "fault", "emergency_stop", "stop_all"])
def test_what_stops_a_mover_ends_its_waiting(how: str) -> None:
    """Nothing begins by itself after it, once the way is free and the mover is enabled again."""
    engine = Engine(row(5, "ab"))
    a, b = enabled(engine)
    moves = [a.move_to_position(**place(k), buffer_mode="buffered") for k in (1, 2)]
    engine.run(0.1)
    stop(engine, a, how)
    assert all(move.final and not move.done for move in moves)
    assert (a.waits_for, a.delay.value) == (0, "none")
    for mover in (a, b):
        if mover.error:
            mover.reset().wait()
        mover.enable().wait()
    b.move_to_position(**place(5)).wait()
    engine.run(1)
    assert (a.x, a.buffered) == (place(0)["x"], 0)
    a.move_to_position(**place(1), buffer_mode="buffered").wait()


@pytest.mark.parametrize("how", ["disable", "fault", "group", "remove"])
def test_what_becomes_of_the_mover_in_the_way(how: str) -> None:
    """Disabled or in error it is waited for still; once it is in no group any more the guard alone makes it wait."""
    engine = Engine(row(5, "ab"))
    a, b = enabled(engine)
    watch = Watch(engine)
    move = a.move_to_position(**place(1), buffer_mode="buffered")
    engine.run(0.1)
    if how == "group":
        engine.planar_group("group").disable().wait()
    elif how == "remove":
        b.remove_from_group().wait()
    else:
        stop(engine, b, how)
    engine.run(0.3)
    assert move.active is (how in ("group", "remove"))
    assert waiting(engine)[0][:2] == ("mover", 2)
    b.reset().wait()
    b.enable().wait()
    b.move_to_position(**place(4)).wait()
    move.wait()
    assert not watch.overlaps


def test_buffered_moves_that_blend_stop_at_the_corner_for_what_is_there() -> None:
    """And go on when it has left, without their turn being lost."""
    engine = Engine(row(5, "ab"))
    a, b = enabled(engine)
    b.move_to_position(x=300, y=360).wait()
    watch = Watch(engine)
    first = a.move_to_position(x=300, y=120)
    second = a.move_to_position(x=300, y=360, buffer_mode="buffered", blending=60)
    third = a.move_to_position(x=75, y=360, buffer_mode="buffered")
    first.wait()
    engine.run(0.3)
    assert (a.x, a.y, a.buffered) == (300, 120, 2)
    b.move_to_position(x=700, y=360).wait()
    third.wait()
    assert second.done
    assert not watch.overlaps


def test_a_track_that_is_moving_is_waited_for() -> None:
    """A mover that is to cross a track, and one along the track that something stands on."""
    line = "[{from: {x: 75, y: 120}, to: {x: 900, y: 120}}]"
    tracks = f"tracks: [{{name: way, check_collision_against_static_objects: false, elements: {line}}}]\n"
    engine = Engine(row(5, "ab", ", tracks: [way]", tracks))
    a, b = enabled(engine)
    watch = Watch(engine)
    a.join_track(track="way").wait()
    along = a.move_on_track(position=700, buffer_mode="buffered")
    engine.run(0.1)
    assert waiting(engine)[0][:2] == ("mover", 2)
    b.move_to_position(x=225, y=360).wait()
    engine.run(0.1)
    across = b.move_to_position(x=225, y=120, buffer_mode="buffered")
    engine.step(3)
    assert along.active
    assert (b.delay.value, b.blocked_by) == ("mover", a)
    engine.wait(lambda: b.delay.value != "mover", 1)  # that is past it, and the track still Moving
    assert (b.delay.value, b.blocked_by, b.waits_for) == ("track", engine.track("way"), 0)
    across.wait()
    assert along.done
    assert not watch.overlaps


def test_a_part_leaves_from_beneath_waiting_movers() -> None:
    """What waits has nothing reserved: the part goes, and takes the mover along."""
    engine = Engine("""
name: lift
axes: []
coordinate_systems: [{name: hall}, {name: above}]
parts:
  - {name: floor, columns: 3, positions: [{coordinate_system: hall}]}
  - {name: lift, positions: [{coordinate_system: hall, x: 720}, {coordinate_system: above}], travel_time_s: 0.2}
movers:
  - {name: a, reference: lift, initial: {x: 120, y: 120}}
  - {name: b, reference: floor, initial: {x: 600, y: 120}}
planar_groups: [{name: group, movers: [a, b]}]
""")
    a, b = enabled(engine)
    watch = Watch(engine)
    move = a.move_to_position(x=600, y=120, reference="hall", buffer_mode="buffered")
    engine.run(0.1)
    assert waiting(engine)[0] == ("mover", 2, False)
    engine.part("lift").activate_position(index=2).wait()
    engine.run(0.1)
    assert move.error  # there is no way from one coordinate system to another
    engine.part("lift").activate_position(index=1).wait()
    b.move_to_position(x=120, y=120, reference="hall").wait()
    a.move_to_position(x=600, y=120, reference="hall", buffer_mode="buffered").wait()
    assert not watch.overlaps


def test_many_at_once_to_random_targets() -> None:
    """Nothing is refused, nothing touches, and whatever stands says for which mover; in a ring, or behind one, too."""
    chance = random.Random(3)
    cells = [(i, j) for i in range(6) for j in range(6)]
    starts, targets = chance.sample(cells, 24), chance.sample(cells, 24)
    movers = "".join(
        f"  - {{name: m{k}, initial: {{x: {80 + 160 * i}, y: {80 + 160 * j}}}}}\n" for k, (i, j) in enumerate(starts)
    )
    floor = FLOOR % ", ".join(f"{{x: {240 * i}, y: {240 * j}}}" for i in range(4) for j in range(4))
    names = ", ".join(f"m{k}" for k in range(24))
    engine = Engine(
        f"name: many\naxes: []\nmovers:\n{movers}{floor}"
        f"planar_groups: [{{name: group, movers: [{names}], environment: floor, moves_wait: true}}]\n"
    )
    all_of_them = enabled(engine)
    watch = Watch(engine)
    moves = [m.move_to_position(x=80 + 160 * i, y=80 + 160 * j) for m, (i, j) in zip(all_of_them, targets, strict=True)]
    engine.run(1.5)
    assert not any(move.error for move in moves)
    assert 0 < sum(move.done for move in moves) < 24
    for mover, move in zip(all_of_them, moves, strict=True):
        assert move.done or mover.waits_for > 0
    ring = [m for m in all_of_them if m.deadlocked]
    assert len(ring) >= 2
    assert all(all_of_them[m.waits_for - 1].deadlocked for m in ring)
    assert {m.delay.value for m in all_of_them if m.waits_for and not m.deadlocked} <= {"mover", "deadlock"}
    # As planned together, all of them get there.
    places = {m.name: (80 + 160 * i, 80 + 160 * j) for m, (i, j) in zip(all_of_them, targets, strict=True)}
    engine.route(places, pitch=160.0, origin=(0.0, 0.0)).wait(60)
    assert not watch.overlaps


def test_over_lcm_and_again_from_the_log(tmp_path: Path) -> None:
    """EN-07, PL-85: a program elsewhere sees who waits for whom; the log gives the same states."""
    url = new_url()
    log = tmp_path / "log.lcm"
    with running(tmp_path, url, "--log", str(log), machine=row(5, "abc")), takt.connect(url) as session:
        a, b, c = enabled(session)
        moves = [m.move_to_position(**place(1), buffer_mode="buffered") for m in (a, c)]
        session.wait(lambda: a.waits_for == 2 and c.waits_for == 2, 2)
        assert a.blocked_by is b
        b.move_to_position(x=225, y=360).wait()
        session.wait(lambda: any(move.done for move in moves), 5)
        session.wait(lambda: {a.waits_for, c.waits_for} in ({0, 1}, {0, 3}), 2)
    result = takt.replay(log)
    assert result.same, result.sentence


TRACK_IN_A_GROUP = """
name: cell
axes: []
movers:
  - {name: a, initial: {x: 2000, y: 2000}}
  - {name: b, initial: {x: 2300, y: 2000}}
  - {name: c, initial: {x: 1000, y: 600}}
tracks: [{name: line, elements: [{from: {x: 2000, y: 2000}, to: {x: 2600, y: 2000}}]}]
planar_groups: [{name: group, movers: [a, b, c], tracks: [line], moves_wait: true}]
"""


@pytest.mark.parametrize("buffered", [False, True])
def test_a_move_that_waits_for_its_track_holds_up_no_other_area(buffered: bool) -> None:
    """PL-72: neither the origin of the plane nor an older target is its own."""
    engine = Engine(TRACK_IN_A_GROUP)
    a, b, c = enabled(engine)
    a.join_track(track="line").wait()
    along = a.move_on_track(position=500, **({"buffer_mode": "buffered"} if buffered else {}))
    engine.run(0.01)
    assert waiting(engine)[0][:2] == ("mover", 2)
    b.move_to_position(x=2300, y=3000, velocity=50)
    engine.run(0.5)
    far = c.move_to_position(x=600, y=1000, buffer_mode="buffered")
    engine.step(3)
    assert along.busy
    assert far.active, c.delay
    far.wait()


def test_a_mover_that_joins_a_formation_gives_its_turn_up() -> None:
    """PL-72, PL-84: its delay is the formation, and others may have what it waited for."""
    places = {"a": (0, 0), "s": (0, 300), "b": (500, 0), "c": (500, -400)}
    movers = [{"name": name, "initial": {"x": x, "y": y}} for name, (x, y) in places.items()]
    group = {"name": "group", "movers": list(places), "moves_wait": True}
    engine = Engine({"name": "cell", "axes": [], "movers": movers, "planar_groups": [group]})
    a, s, b, c = enabled(engine)
    a.move_to_position(x=500, y=0)
    engine.run(0.1)
    assert (a.delay, a.blocked_by) == ("mover", b)
    a.join_formation(star="s").wait(until="reached")
    engine.step(2)
    assert (a.delay, a.blocked_by, a.buffered) == ("formation", s, 1)
    b.move_to_position(x=500, y=2000, velocity=20)
    engine.run(12)
    across = c.move_to_position(x=300, y=0, buffer_mode="buffered")
    engine.step(3)
    assert across.active, c.delay


@pytest.mark.parametrize("moving", [False, True])
def test_releases_stay_when_a_move_waits_at_once(moving: bool) -> None:
    """PL-71, PL-72: what waits instead of being refused is no halt."""
    engine = Engine(row(6, "ab", ", moves_wait: true"))
    a, b = enabled(engine)
    b.move_to_position(**place(5)).wait()
    if moving:
        a.move_to_position(**place(2))
        engine.run(0.1)
    a.release().wait_final()
    move = a.move_to_position(**place(5))
    wait = a.wait(for_release=True)
    engine.run(0.5)
    assert move.busy
    b.move_to_position(x=300, y=360).wait()
    move.wait()
    engine.run(0.1)
    assert wait.done
