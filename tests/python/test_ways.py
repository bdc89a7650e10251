"""Ways along tracks and why there is none, what a mover waits for, and sentences that name it: PL-83, PL-84, PL-85."""

from __future__ import annotations

from pathlib import Path

import pytest
import takt
from machines import new_url, running
from takt import Engine

LINE = "{{from: {{x: {}, y: {}}}, to: {{x: {}, y: {}}}}}"


def chain(count: int, length: float = 150.0) -> str:
    """Tracks in a row, each from the end of the one before it."""
    text = "tracks:\n"
    for i in range(count):
        links = f", starts_from: [t{i - 1}]" if i else ""
        text += f"  - {{name: t{i}, elements: [{LINE.format(length * i, 0, length * (i + 1), 0)}]{links}}}\n"
    return text


def on_tracks(engine: Engine, **tracks: str) -> None:
    engine.run(engine.period)  # lengths are known then
    for track in engine.tracks.values():
        if track.length:
            track.enable().wait()
    for mover, track in tracks.items():
        engine.mover(mover).enable().wait()
        engine.mover(mover).join_track(track=track, use_orientation=False).wait()


def test_a_way_over_many_tracks() -> None:  # PL-83
    with Engine(f"name: row\naxes: []\nmovers: [{{name: m}}]\n{chain(90)}") as engine:
        on_tracks(engine, m="t0")
        mover = engine.mover("m")
        with engine.record() as recorder:
            mover.move_on_track(track="t89", position=70).wait()
        assert (mover.track, mover.track_position) == (90, 70)
        # As one track of that length: no border is felt.
        assert recorder.recording["m"]["track_velocity"].max() == pytest.approx(2000)
        assert mover.x == pytest.approx(89 * 150 + 70)


def test_a_trail_over_many_tracks() -> None:  # PL-83
    axis = "{name: ax, unit: mm, limits: {velocity: 900, acceleration: 4000, jerk: 90000}}"
    with Engine(f"name: row\naxes: [{axis}]\nmovers: [{{name: m}}]\n{chain(40, 60.0)}") as engine:
        on_tracks(engine, m="t0")
        engine.axis("ax").power().wait()
        mover = engine.mover("m")
        trail = takt.TrackTrail([f"t{i}" for i in range(40)])
        gear = mover.gear_in_pos_on_track(master="ax", master_sync_position=0, slave_sync_position=0, trail=trail)
        gear.wait(until="reached")
        engine.axis("ax").move_absolute(position=39.5 * 60).wait()
        engine.run(0.5)
        assert (mover.track, mover.track_position) == (40, pytest.approx(30, abs=1e-6))


# A shuttle between two sides, and a track that nothing leads to.
SHUTTLE = f"""
name: shuttle
axes: []
coordinate_systems: [{{name: hall}}]
parts:
  - {{name: left, columns: 2, rows: 1, positions: [{{coordinate_system: hall}}]}}
  - {{name: right, columns: 2, rows: 1, positions: [{{coordinate_system: hall, x: 1440}}]}}
  - name: ferry
    columns: 2
    rows: 1
    positions: [{{coordinate_system: hall, x: 480}}, {{coordinate_system: hall, x: 960}}]
    travel_time_s: 0.4
movers: [{{name: m, reference: left, initial: {{x: 120, y: 120}}, gap: 150}}]
tracks:
  - {{name: in, part: left, elements: [{LINE.format(60, 120, 480, 120)}]}}
  - {{name: deck, part: ferry, starts_from: [in], elements: [{LINE.format(20, 120, 470, 120)}]}}
  - {{name: alone, part: right, elements: [{LINE.format(20, 120, 440, 120)}]}}
  - {{name: empty, part: right}}
"""


@pytest.fixture
def ferry() -> Engine:
    engine = Engine(SHUTTLE)
    on_tracks(engine, m="in")
    return engine


def refusal(engine: Engine, **move: object) -> tuple[int, str, takt.Feedback]:
    feedback = engine.mover("m").move_on_track(**move).wait_final()  # type: ignore[arg-type]
    assert feedback.error
    return feedback.error_id, feedback.sentence, feedback


def test_why_there_is_no_way(ferry: Engine) -> None:  # PL-83
    mover = ferry.mover("m")
    here = mover.track_position
    assert refusal(ferry, position=here + 50, direction="negative")[:2] == (
        3047,
        "the direction does not lead to the target from where the mover can stop: track in",
    )
    assert refusal(ferry, track="alone", position=10)[:2] == (3047, "no route along tracks leads there: track alone")
    assert refusal(ferry, track="empty", position=0)[0] == 3050
    ferry.part("ferry").activate_position(index=2).wait()
    number, sentence, feedback = refusal(ferry, track="deck", position=100)
    assert (number, sentence) == (3047, "the way leads over a part that is elsewhere: part ferry")
    assert feedback.object is ferry.part("ferry")
    mover.leave_track(x=120, y=120, reference="left").wait()
    ferry.part("ferry").activate_position(index=1).wait()
    mover.join_track(track="in").wait()
    mover.move_on_track(track="deck", position=100).wait()
    assert refusal(ferry, track="in", position=100)[:2] == (3047, "no route along tracks leads there: track in")


def test_a_way_that_is_too_long() -> None:  # PL-83
    with Engine(f"name: row\naxes: []\nmovers: [{{name: m}}]\n{chain(258, 40.0)}") as engine:
        on_tracks(engine, m="t0")
        assert refusal(engine, track="t257", position=1)[1] == "the way has more than 256 tracks: track t257"
        engine.mover("m").move_on_track(track="t255", position=1).wait()


def test_a_buffered_move_waits_for_a_part(ferry: Engine) -> None:  # PL-83, PL-84
    """It says so, begins when the part is there, and is refused where the part has gone elsewhere."""
    mover, part = ferry.mover("m"), ferry.part("ferry")
    part.activate_position(index=2).wait()
    coming = part.activate_position(index=1)
    ferry.run(0.1)
    asked = ferry.cycle
    move = mover.move_on_track(track="deck", position=200, buffer_mode="buffered")
    ferry.run(0.1)
    assert not move.final
    assert (mover.delay, mover.blocked_by) == ("part", part)
    assert asked <= mover.delay_since <= asked + 3
    assert not coming.final
    move.wait()
    assert coming.done
    assert (mover.track, mover.track_position, mover.delay, mover.blocked_by) == (2, 200, "none", None)

    on_its_way = mover.move_on_track(position=20)
    on_its_way.wait()
    at_once = mover.move_on_track(track="deck", position=100)
    at_once.wait()


def test_one_that_is_not_buffered_is_refused_meanwhile(ferry: Engine) -> None:  # PL-83
    ferry.part("ferry").activate_position(index=2).wait()
    ferry.part("ferry").activate_position(index=1)
    ferry.run(0.1)
    number, sentence, _ = refusal(ferry, track="deck", position=100)
    assert number in (3047, 3072)
    assert sentence.endswith(": part ferry")


def test_behind_a_deadlock() -> None:  # PL-84
    """Two face to face are deadlocked; the one behind them waits for no good, and says so."""
    movers = ", ".join(f"{{name: {n}, initial: {{x: {x}}}, gap: 150}}" for n, x in (("a", 100), ("b", 400), ("c", 900)))
    track = f"tracks: [{{name: t, elements: [{LINE.format(0, 0, 1500, 0)}]}}]"
    with Engine(f"name: x\naxes: []\nmovers: [{movers}]\n{track}\n") as engine:
        on_tracks(engine, a="t", b="t", c="t")
        a, b, c = (engine.mover(name) for name in "abc")
        b.move_on_track(position=1200)
        c.move_on_track(position=50)
        engine.run(1)
        assert b.deadlocked
        assert (b.delay, b.blocked_by, c.blocked_by) == ("mover", c, b)
        a.move_on_track(position=1300)
        engine.run(1)
        assert not a.deadlocked
        assert (a.delay, a.blocked_by, a.waits_for) == ("deadlock", b, 2)
        b.halt()
        engine.run(0.1)
        assert (a.delay, a.blocked_by) == ("mover", b)


def test_a_gear_whose_master_is_held_up() -> None:  # PL-84
    movers = ", ".join(f"{{name: {n}, initial: {{x: {x}}}, gap: 150}}" for n, x in (("s", 100), ("m", 400), ("b", 900)))
    track = f"tracks: [{{name: t, elements: [{LINE.format(0, 0, 1500, 0)}]}}]"
    with Engine(f"name: x\naxes: []\nmovers: [{movers}]\n{track}\n") as engine:
        on_tracks(engine, s="t", m="t", b="t")
        s, m, b = (engine.mover(name) for name in "smb")
        s.gear_in_pos_on_track_with_master_mover(master="m", master_sync_position=400, slave_sync_position=150)
        engine.wait(lambda: s.in_sync, 5)
        assert s.delay == "none"
        m.move_on_track(position=1200)
        engine.run(2)
        assert (m.delay, m.blocked_by) == ("mover", b)
        assert (s.delay, s.blocked_by) == ("master", m)
        b.move_on_track(position=1450)
        engine.run(2)
        assert (m.delay, s.delay, s.blocked_by) == ("none", "none", None)


NAMES = f"""
name: names
axes: []
coordinate_systems: [{{name: s}}]
parts:
  - {{name: plate, columns: 3, rows: 2, positions: [{{coordinate_system: s}}, {{coordinate_system: s, x: 3000}}]}}
movers: [{{name: m, initial: {{x: 200, y: 200}}, reference: plate}}]
tracks:
  - {{name: t, part: plate, elements: [{LINE.format(120, 200, 600, 200)}]}}
  - {{name: bare, part: plate}}
"""


@pytest.mark.parametrize(
    ("command", "arguments", "sentence"),
    [
        ("part", {"index": 4}, "index: expected 1 to 2, of the positions of part plate, found 4"),
        ("join_track", {"track": "bare"}, ": track bare"),
        ("move_on_track", {"position": 900}, "the target is not on track t: expected 0 to 480 mm"),
        ("move_on_track", {"track": "bare", "position": 0}, ": track bare"),
        (
            "move_on_track",
            {"position": 50, "direction": "positive", "additional_turns": 2},
            "turns, their directions and modulo tolerances are for closed loops, and track t is open",
        ),
        ("leave_track", {"x": -90, "y": 0, "reference": "plate"}, "would leave the stators; it is on part plate"),
        ("move_z", {"position": -2}, "the target is outside the limits of mover m: the nearest position allowed is 0"),
        ("move_z", {"position": 7.5}, "the nearest position allowed is 5"),
    ],
)
def test_sentences_say_what_is_wrong_and_where(command: str, arguments: dict[str, object], sentence: str) -> None:
    with Engine(NAMES) as engine:
        engine.track("t").enable().wait()
        mover = engine.mover("m")
        mover.enable().wait()
        if command != "join_track":
            mover.join_track(track="t").wait()
        give = engine.part("plate").activate_position if command == "part" else getattr(mover, command)
        feedback = give(**arguments).wait_final()
        assert feedback.error
        assert sentence in feedback.sentence


def test_tracks_over_lcm(tmp_path: Path) -> None:  # PL-85
    """What an engine in process answers of its tracks, another process gets, too."""
    url = new_url()
    with Engine(SHUTTLE) as engine:
        engine.part("ferry").activate_position(index=1).wait()
        here = [
            (t.position_at(0.3 * t.length), t.arc_length_closest_to(700, 50), [o.name for o in t.previous])
            for t in engine.tracks.values()
            if t.length
        ]
    with running(tmp_path, url, machine=SHUTTLE), takt.connect(url) as session:
        session.part("ferry").activate_position(index=1).wait()
        session.wait(lambda: session.part("ferry").position_index == 1)
        there = [
            (t.position_at(0.3 * t.length), t.arc_length_closest_to(700, 50), [o.name for o in t.previous])
            for t in session.tracks.values()
            if t.length
        ]
        assert there == here
        assert [t.name for t in session.track("in").subsequent] == ["deck"]
        session.part("ferry").activate_position(index=2).wait()
        session.wait(lambda: session.part("ferry").position_index == 2)
        assert session.track("in").subsequent == []
        assert session.track("deck").position_at(0).x == pytest.approx(960)  # where the track before it ends


def test_routes_are_planned_over_lcm(tmp_path: Path) -> None:  # PL-85
    url = new_url()
    machine = (
        f"name: x\naxes: []\nmovers: [{{name: m}}]\ntracks: [{{name: t, elements: [{LINE.format(0, 0, 900, 0)}]}}]\n"
    )
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        session.track("t").enable().wait()
        mover = session.mover("m")
        mover.enable().wait()
        mover.join_track(track="t").wait()
        plan = takt.plan_routes(session, {"m": ("t", 700.0)})
        assert plan.way("m") == ["t"]
        assert set(session.move_on_tracks({"m": ("t", 700.0)})) == {"m"}
        verbs = [record.verb for record in mover.history()]
        assert verbs == ["enable", "join_track", "move_on_track"]


def test_what_a_trail_is_like() -> None:  # PL-86
    with Engine(f"name: row\naxes: []\nmovers: [{{name: m}}]\n{chain(5, 70.0)}") as engine:
        engine.run(engine.period)
        trail = takt.TrackTrail(["t1", "t2", "t3"])
        information = trail.information(engine)
        assert information.length == pytest.approx(210)
        assert information.begins == pytest.approx({"t1": 0, "t2": 70, "t3": 140})
        assert information.position("t2", 12.5) == pytest.approx(82.5)
        with pytest.raises(takt.TaktError, match="track t4 is not on the trail t1, t2, t3"):
            information.position("t4", 1)
        with pytest.raises(takt.TaktError, match="t3 does not start where t1 ends"):
            takt.TrackTrail(["t1", "t3"]).information(engine)
