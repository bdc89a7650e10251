"""Planar movers on tracks: the manual's programs, and what movers in one another's way do."""

from __future__ import annotations

import math
import random
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine, expect
from test_surface import Watch

TWO_ON_A_LINE = """
name: line
axes: []
movers:
  - {name: one}
  - {name: two, initial: {x: 240}}
tracks: [{name: track}]
"""


def join(session: takt.Session, **options: bool) -> tuple[takt.Mover, takt.Mover]:
    """The first states of the manual's programs 6.2.4, 6.2.6 and 6.2.7, by states, not by feedback."""
    one, two, track = session.mover("one"), session.mover("two"), session.track("track")
    track.append_line(start_x=0, start_y=0, end_x=400, end_y=0)
    track.enable()
    session.wait(lambda: track.state == "Enabled", 1)
    one.enable()
    two.enable()
    session.wait(lambda: one.state == two.state == "Enabled", 1)
    one.join_track(track="track", **options)
    two.join_track(track="track", **options)
    session.wait(lambda: one.command_mode == two.command_mode == "OnTrack", 1)
    return one, two


@pytest.fixture
def engine() -> Engine:
    return Engine(TWO_ON_A_LINE)


def test_two_movers_on_a_track(engine: Engine) -> None:
    """PL-12, PL-50, example 6.2.4: they stand at 150 and 350."""
    recorder = engine.record()
    one, two = join(engine)
    track = engine.track("track")
    assert track.operation_mode == "Standing"
    assert track.mover_count == 2
    one.move_on_track(position=30)
    engine.step()
    assert track.operation_mode == "Moving"
    with pytest.raises(takt.CommandError, match="a command of a mover on the track does not allow this"):
        two.leave_track(x=0, y=0).wait()
    moves = [one.move_on_track(position=150), two.move_on_track(position=350)]
    engine.wait(lambda: one.track_position >= 149.9 and two.track_position >= 349.9, 5)
    engine.run(0.5)
    assert (one.x, one.y, one.track_position) == (150, 0, 150)
    assert (two.x, two.y, two.track_position) == (350, 0, 350)
    assert all(move.done for move in moves)
    assert track.operation_mode == "Standing"
    recording = recorder.stop()
    assert np.min(recording["two"]["x"] - recording["one"]["x"]) > 200 - 1e-6
    assert expect.visits_states(recording, "track", ["Enabling", "Enabled"])


def test_a_mover_says_where_it_goes_and_how_far_it_keeps_away(engine: Engine) -> None:
    """PL-24, PL-70: the track and the place on it, and the gap of the command."""
    one, two = join(engine)
    assert (one.target_track, one.gap) == (0, 200)
    moves = [one.move_on_track(position=30, gap=210), two.move_on_track(position=350)]
    engine.step()
    assert (one.target_track, one.target_position, one.gap) == (1, 30, 210)
    assert (two.target_track, two.target_position, two.gap) == (1, 350, 200)
    for move in moves:
        move.wait()
    assert (one.track_position, one.target_position) == (30, 30)
    two.leave_track(x=350, y=50).wait()
    engine.step()
    assert (two.target_track, two.target_x, two.target_y) == (0, 350, 50)


def test_the_same_over_lcm(tmp_path: Path) -> None:
    """PL-50, example 6.2.4 against taktd."""
    url = new_url()
    with running(tmp_path, url, machine=TWO_ON_A_LINE), takt.connect(url) as session:
        one, two = join(session)
        one.move_on_track(position=150)
        two.move_on_track(position=350)
        session.wait(lambda: one.track_position >= 149.9 and two.track_position >= 349.9, 10)


def test_turning_on_a_track(engine: Engine) -> None:
    """PL-10, PL-50, example 6.2.6: 20 degrees stay CRotationOnTrack, 90 degrees come back to OnTrack."""
    one, two = join(engine, use_orientation=False)
    turns = [one.move_c(position=20), two.move_c(position=90)]
    engine.step()
    assert one.command_mode == two.command_mode == "CRotationOnTrack"
    engine.wait(lambda: one.c >= 19.9 and two.c >= 89.9, 5)
    for turn in turns:
        turn.wait()
    assert one.command_mode == "CRotationOnTrack"
    assert two.command_mode == "OnTrack"
    with pytest.raises(takt.CommandError, match="command mode"):
        one.move_on_track(position=10).wait()
    two.move_on_track(position=350).wait()
    two.leave_track(x=350, y=200, use_orientation=False).wait()
    assert (two.x, two.y, two.c, two.command_mode) == (350, 200, 90, "FreeMovement")


def test_adopting_the_orientation_of_a_track(engine: Engine) -> None:
    """PL-11, PL-50, example 6.2.7."""
    one, two = join(engine)
    turns = [one.move_c(position=20), two.move_c(position=190)]
    engine.wait(lambda: all(turn.final for turn in turns), 5)
    assert (one.c, two.c) == (20, 190)
    turns = [one.adopt_track_orientation(), two.adopt_track_orientation()]
    engine.wait(lambda: all(turn.final for turn in turns), 5)
    assert one.command_mode == two.command_mode == "OnTrack"
    assert (one.c, two.c) == (0, 360)


NETWORK = """
name: network
axes: []
movers:
  - {name: red, initial: {x: 500, y: 120}}
  - {name: blue, initial: {x: 200, y: 200}}
tracks:
  - name: one
    elements:
      - {from: {x: 250, y: 120}, to: {x: 650, y: 120}}
      - {from: {x: 700, y: 170}, to: {x: 800, y: 450}}
      - {from: {x: 650, y: 500}, to: {x: 250, y: 500}}
  - {name: two, starts_from: [one], ends_at: [one], elements: [{from: {x: 200, y: 450}, to: {x: 200, y: 170}}]}
  - {name: three, starts_from: [one], elements: [{from: {x: 200, y: 500}, to: {x: 120, y: 500}}]}
  - {name: four, starts_from: [one], elements: [{from: {x: 200, y: 550}, to: {x: 200, y: 750}}]}
"""


@pytest.fixture
def network() -> Engine:
    engine = Engine(NETWORK)
    feedback = [track.enable() for track in engine.tracks.values()]
    feedback += [mover.enable() for mover in engine.movers.values()]
    engine.wait(lambda: all(f.final for f in feedback), 1)
    engine.mover("red").join_track(track="one").wait()
    engine.mover("blue").join_track(track="two").wait()
    return engine


def test_through_a_network(network: Engine) -> None:
    """PL-12, PL-23, PL-24: round the ring of tracks one and two; nobody comes nearer than its gap."""
    red, blue = network.mover("red"), network.mover("blue")
    recorder = network.record()
    there = red.move_on_track(position=100, track="four")
    network.run(4)
    # Blue stands on another branch, out of the way.
    assert there.done
    assert red.track == 4
    assert red.track_position == 100
    blue.move_on_track(position=700, track="one").wait()
    back = blue.move_on_track(position=50, track="two")
    network.run(4)
    # Red stands where one on track two could touch it.
    assert not back.final
    assert blue.waits_for == 1
    with pytest.raises(takt.CommandError, match="no route along tracks leads there"):
        red.move_on_track(position=0, track="one").wait()
    red.leave_track(x=300, y=900).wait()
    network.run(4)
    assert back.done
    assert blue.track == 2
    recording = recorder.stop()
    r = recording["red"]
    speed = np.hypot(r["velocity_x"], r["velocity_y"])
    assert speed.max() < 2000 + 1e-6
    across = np.hypot(r["acceleration_x"], r["acceleration_y"])
    assert across.max() < np.hypot(10000, 5000) * (1 + 1e-3)


def test_who_waits_for_whom(network: Engine) -> None:
    """PL-26, PL-70: two movers face to face on one track say so, and go on when one of them gives way."""
    red, blue = network.mover("red"), network.mover("blue")
    blue.leave_track(x=760, y=300).wait()
    blue.join_track(track="one").wait()
    place = blue.track_position
    assert place == pytest.approx(650, abs=60)
    first = red.move_on_track(position=1000)
    network.run(3)
    assert not first.final
    assert red.waits_for == 2
    assert not red.deadlocked
    assert red.gap >= 200  # what bends on its way ask for
    assert red.track_position == pytest.approx(place - red.gap, abs=0.05)
    second = blue.move_on_track(position=100)
    network.run(3)
    assert red.deadlocked
    assert blue.deadlocked
    assert not second.final
    blue.move_on_track(position=250, track="four")
    network.run(4)
    assert first.done
    assert not red.deadlocked
    assert second.aborted


def test_a_place_that_is_taken(engine: Engine) -> None:
    """PL-24: a mover does not join a track nearer than its gap to another."""
    join(engine)
    one, two = engine.mover("one"), engine.mover("two")
    two.leave_track(x=240, y=150).wait()
    one.move_on_track(position=100).wait()
    with pytest.raises(takt.CommandError, match="would be a collision"):
        two.join_track(track="track").wait()
    one.move_on_track(position=0).wait()
    two.join_track(track="track").wait()


def test_a_place_just_at_the_gap(engine: Engine) -> None:
    """PL-24: rounding does not make it nearer."""
    track = engine.track("track")
    track.append_line(start_x=0, start_y=0, end_x=300, end_y=90)
    track.enable().wait()
    one, two = engine.mover("one"), engine.mover("two")
    one.enable().wait()
    two.enable().wait()
    for s in (10, 20, 30, 40, 50):
        for mover, place in ((one, s), (two, s + 200)):
            at = track.position_at(place)
            mover.move_to_position(x=at.x, y=at.y).wait()
            mover.join_track(track="track").wait()
        for mover in (one, two):
            mover.leave_track(x=mover.x, y=mover.y).wait()


@pytest.mark.parametrize("seed", range(8))
def test_each_stops_just_at_its_gap(seed: int) -> None:
    """PL-12, PL-24: whoever may go to its place gets there, however gently those before it come to rest. Nobody goes
    back on the way."""
    rng = np.random.default_rng(seed)
    count, gap = 6, float(rng.uniform(120, 300))
    xy = [
        f"{{velocity: {rng.uniform(500, 2e3)}, acceleration: {rng.uniform(1500, 1e4)}, jerk: {rng.uniform(2e4, 5e5)}}}"
        for _ in range(count)
    ]
    movers = "".join(
        f"  - {{name: m{i}, gap: {gap}, initial: {{x: {i * (gap + 20)}}}, xy: {{maximum: {xy[i]}}}}}\n"
        for i in range(count)
    )
    line = "tracks: [{name: track, elements: [{from: {x: 0, y: 0}, to: {x: 6000, y: 0}}]}]\n"
    with Engine(f"name: row\naxes: []\nmovers:\n{movers}{line}") as engine:
        engine.track("track").enable().wait()
        all_movers = list(engine.movers.values())
        for mover in all_movers:
            mover.enable().wait()
            mover.join_track(track="track").wait()
        recorder = engine.record()
        first = all_movers[-1].move_on_track(position=2000, velocity=100, jerk=5000)
        others = [mover.move_on_track(position=2000 - (count - 1 - i) * gap) for i, mover in enumerate(all_movers[:-1])]
        engine.wait(lambda: all(move.done for move in (first, *others)), 60)
        for place in (2000.0, 3500.0):
            moves = [
                mover.move_on_track(
                    position=place + i * gap,
                    velocity=rng.uniform(50, 2500),
                    acceleration=rng.uniform(500, 15_000),
                    jerk=rng.uniform(5e3, 5e5),
                )
                for i, mover in enumerate(all_movers)
            ]
            if place == 3500.0:  # the others run up to the first, which goes on
                engine.run(0.3)
                all_movers[-1].halt()
                engine.run(0.3)
                moves[-1] = all_movers[-1].move_on_track(position=place + (count - 1) * gap)
            engine.wait(lambda moves=moves: all(move.done for move in moves), 60)
            assert [mover.track_position for mover in all_movers] == [place + i * gap for i in range(count)]
            assert all(mover.waits_for == 0 for mover in all_movers)
        recording = recorder.stop()
    for mover in all_movers:
        assert np.min(recording[mover.name]["track_velocity"]) > -1e-6


def test_bad_commands(network: Engine) -> None:
    """PL-02, PL-22."""
    red = network.mover("red")
    with pytest.raises(takt.CommandError, match="did you mean four"):
        red.move_on_track(position=0, track="fuor").wait()
    with pytest.raises(takt.CommandError):
        red.move_on_track(position=1e4).wait()
    with pytest.raises(takt.CommandError, match="additional_turns"):
        red.move_on_track(position=0, additional_turns=1).wait()
    with pytest.raises(takt.CommandError, match="command mode"):
        red.move_to_position(x=0, y=0).wait()
    network.track("three").disable().wait()
    with pytest.raises(takt.CommandError, match="not enabled"):
        red.move_on_track(position=0, track="three").wait()
    network.track("one").disable().wait()
    with pytest.raises(takt.CommandError, match=r"a command of a mover on the track .*: mover red"):
        network.track("one").clear().wait()


def test_replay_is_the_same(tmp_path: Path) -> None:
    """Two engines, one story: the same to the last bit."""
    hashes = []
    for _ in range(2):
        engine = Engine(TWO_ON_A_LINE)
        one, two = join(engine)
        one.move_on_track(position=150)
        two.move_on_track(position=350)
        engine.run(1)
        hashes.append(engine.state_hash)
    assert hashes[0] == hashes[1]


# Where two movers of some size, turned by `c` against a straight track of some direction, touch: (width, height, c,
# direction, mm). Sides flush; flush at 45 deg; corners beside sides at 30 deg and 20 deg.
TOUCH = [
    (113, 113, 0, 0, 113),
    (155, 115, 0, 0, 155),
    (155, 115, 90, 0, 115),
    (120, 120, 0, 45, 169.706),
    (120, 90, 0, 30, 138.565),
    (120, 90, 0, 60, 103.924),
]


@pytest.mark.parametrize(("width", "height", "c", "direction", "least"), TOUCH)
def test_no_gap_lets_movers_touch(width: float, height: float, c: float, direction: float, least: float) -> None:
    """PL-81: a gap at which they would touch is refused with the least that would do; at that they go, and wait."""
    along, across = np.cos(np.radians(direction)), np.sin(np.radians(direction))
    size = f"width: {width}, height: {height}"
    with Engine(f"""
name: gap
axes: []
movers:
  - {{name: behind, {size}, initial: {{c: {c}}}}}
  - {{name: ahead, {size}, initial: {{x: {700 * along}, y: {700 * across}, c: {c}}}}}
tracks:
  - name: line
    mover_width: {width}
    mover_height: {height}
    elements: [{{from: {{x: 0, y: 0}}, to: {{x: {900 * along}, y: {900 * across}}}}}]
""") as engine:
        behind, ahead = engine.mover("behind"), engine.mover("ahead")
        engine.track("line").enable().wait()
        for mover in (behind, ahead):
            mover.enable().wait()
            mover.join_track(track="line", use_orientation=False).wait()
        for gap in (0, 0.5 * least, least - 0.01):
            refused = behind.move_on_track(position=850, gap=gap).wait_final()
            assert refused.error_id == 3051
            assert refused.value == pytest.approx(least, abs=1e-3)
            with pytest.raises(takt.CommandError, match=rf"touch at that gap: expected at least {least:.1f}"[:-2]):
                refused.wait()
        assert behind.track_position == 0
        behind.move_on_track(position=850, gap=least + 0.001)
        engine.run(3)
        assert behind.track_position == pytest.approx(700 - least, abs=0.1)
        assert behind.waits_for == 2


def test_a_gap_that_is_not_given_grows_with_the_movers() -> None:
    """PL-81: one of 260 mm behind one of 300 mm keeps more than the default of 200 mm, so that they never touch."""
    with Engine("""
name: large
axes: []
movers:
  - {name: behind, width: 260, height: 260}
  - {name: ahead, width: 300, height: 300, initial: {x: 900}}
tracks: [{name: line, mover_width: 300, mover_height: 300, elements: [{from: {x: 0, y: 0}, to: {x: 1200, y: 0}}]}]
""") as engine:
        behind = engine.mover("behind")
        engine.track("line").enable().wait()
        for name in ("behind", "ahead"):
            engine.mover(name).enable().wait()
            engine.mover(name).join_track(track="line").wait()
        behind.move_on_track(position=1000)
        engine.run(3)
        assert behind.gap == 300
        assert behind.track_position == pytest.approx(600, abs=0.1)


TWO_TRACKS = """
name: two
axes: []
movers: [{name: one, gap: 120}, {name: two, initial: {x: 240, y: 400}}]
tracks:
  - {name: first, elements: [{from: {x: 0, y: 0}, to: {x: 400, y: 0}}]}
  - {name: second, starts_from: [first], elements: [{from: {x: 500, y: 0}, to: {x: 900, y: 0}}]}
"""


def alone_on_two_tracks() -> tuple[Engine, takt.Mover]:
    engine = Engine(TWO_TRACKS)
    mover = engine.mover("one")
    for name in ("first", "second"):
        engine.track(name).enable().wait()
    mover.enable().wait()
    mover.join_track(track="first").wait()
    return engine, mover


def test_buffered_ways_lead_into_one_another() -> None:
    """PL-71: through the targets without a stop, as quick as one way; each is done where its target is passed."""
    engine, mover = alone_on_two_tracks()
    start = engine.cycle
    mover.move_on_track(track="second", position=400).wait()
    alone = engine.cycle - start

    engine, mover = alone_on_two_tracks()
    start = engine.cycle
    moves = [
        mover.move_on_track(position=250),
        mover.move_on_track(track="second", position=100, buffer_mode="buffered"),
        mover.move_on_track(track="second", position=400, buffer_mode="buffered"),
    ]
    engine.step()
    assert mover.buffered == 2
    passed = []
    while moves[-1].busy:
        engine.step()
        if len(passed) < 2 and moves[len(passed)].done:
            passed.append((mover.x, abs(mover.velocity_x)))
    assert engine.cycle - start <= alone + 10
    assert [place for place, _ in passed] == [pytest.approx(250, abs=2.1), pytest.approx(500, abs=2.1)]
    assert min(speed for _, speed in passed) > 1000
    assert [move.value > 0 for move in moves] == [True] * 3
    records = mover.history()[-3:]
    assert [(r.changed - r.begun) * engine.period for r in records] == pytest.approx([move.value for move in moves])


def test_a_buffered_way_back_begins_at_rest() -> None:
    """PL-71: it reaches its target before it turns."""
    _, mover = alone_on_two_tracks()
    there = mover.move_on_track(position=300)
    back = mover.move_on_track(position=100, buffer_mode="buffered")
    there.wait()
    assert mover.track_position == 300
    back.wait()
    assert mover.track_position == 100


def before_curve(radius: float, maximum: tuple[float, float, float]) -> Engine:
    """A mover at rest on a track, 700 mm before a curve. maximum: velocity, acceleration, jerk."""
    velocity, acceleration, jerk = maximum
    engine = Engine(f"""
name: curve
axes: []
movers:
  - name: one
    initial: {{x: 500}}
    xy: {{maximum: {{velocity: {velocity}, acceleration: {acceleration}, jerk: {jerk}}}}}
tracks:
  - name: track
    elements:
      - {{from: {{x: 300, y: 0}}, to: {{x: 1200, y: 0}}}}
      - {{from: {{x: {1200 + radius}, y: {radius}}}, to: {{x: {1200 + radius}, y: 700}}}}
""")
    engine.track("track").enable().wait()
    engine.mover("one").enable().wait()
    engine.mover("one").join_track(track="track").wait()
    return engine


@pytest.mark.parametrize(
    ("radius", "first", "seconds", "second"),
    [
        (50, (2000, 10000, 50000), 0.35, (500, 40000)),
        (100, (2000, 5000, 30000), 0.5, (1000, 50000)),
        (140, (2000, 8000, 50000), 0.45, (1500, 20000)),
        (200, (2000, 10000, 50000), 0.3, (500, 20000)),
        (200, (1000, 10000, 30000), 0.35, (1000, 50000)),
    ],
)
def test_a_new_jerk_before_a_curve_turns_no_mover_back(
    radius: float, first: tuple[float, float, float], seconds: float, second: tuple[float, float]
) -> None:
    """PL-21, PL-82: it had to brake in the curve with less jerk than it had begun with (-67 to -210 mm/s)."""
    velocity, acceleration, jerk = first
    with before_curve(radius, (2000, 10000, 50000)) as engine:
        one = engine.mover("one")
        record = engine.record("one")
        one.move_on_track(position=1400, velocity=velocity, acceleration=acceleration, jerk=jerk)
        engine.run(seconds)
        one.move_on_track(position=1400, velocity=second[0], jerk=second[1]).wait()
        recording = record.stop()
    assert recording["one"]["track_velocity"].min() > -1e-6
    assert expect.within_limits(recording, "one")


@pytest.mark.parametrize(
    ("radius", "maximum", "move", "position"),
    [
        (50, (2000, 8000, 20000), (1553, 5662, 18786), 915),
        (200, (2000, 10000, 50000), (1135, 5478, 34842), 934),
    ],
)
def test_a_move_to_a_place_in_a_curve_passes_it_hardly(
    radius: float, maximum: tuple[float, float, float], move: tuple[float, float, float], position: float
) -> None:
    """PL-21, PL-82: its plan ends at rest there, though braking as the curve asks would be later (1.9 mm)."""
    with before_curve(radius, maximum) as engine:
        one = engine.mover("one")
        record = engine.record("one")
        one.move_on_track(
            position=position, velocity=move[0], acceleration=move[1], deceleration=move[1], jerk=move[2]
        ).wait()
        recording = record.stop()
    assert recording["one"]["track_position"].max() <= position + 0.2


def test_a_mover_says_why_and_since_when_it_waits() -> None:
    """PL-70: for another one; for a release."""
    engine, mover = alone_on_two_tracks()
    other = engine.mover("two")
    other.enable().wait()
    other.join_track(track="first").wait()
    way = mover.move_on_track(position=300)
    engine.run(2)
    assert (mover.delay, mover.waits_for) == ("mover", 2)
    assert 0 < engine.cycle - mover.delay_since < 2 / engine.period
    other.move_on_track(position=390)
    engine.run(2)
    other.move_on_track(track="second", position=300)
    way.wait()
    assert (mover.delay, mover.delay_since) == ("none", 0)
    held = mover.wait(for_release=True)
    engine.run(0.1)
    assert mover.delay == "release"
    mover.release()
    held.wait()


def test_what_ends_with_set_points_from_outside_names_what_was_in_the_way() -> None:  # PL-02, PL-84
    machine = {
        "name": "line",
        "axes": [],
        "movers": [{"name": "one"}, {"name": "two", "initial": {"x": 500, "y": 130}}],
        "tracks": [{"name": "track", "elements": [{"from": {"x": 0, "y": 0}, "to": {"x": 1000, "y": 0}}]}],
    }
    with Engine(machine) as engine:
        one, two = engine.mover("one"), engine.mover("two")
        engine.track("track").enable().wait()
        one.enable().wait()
        one.join_track(track="track").wait()
        move = one.move_on_track(position=900, velocity=500)
        outside = one.start_external_setpoint_generation(mode="relative")
        for i in range(1, 1500):
            t = i * engine.period  # sways by 80 mm, which the way past the other mover has no room for
            sways = {"y": 40 * (1 - math.cos(5 * t)), "velocity_y": 200 * math.sin(5 * t)}
            one.set_external_setpoint(**sways, acceleration_y=1000 * math.cos(5 * t))
            engine.step()
            if outside.final:
                break
        engine.run(0.5)
    for feedback in (outside, move):
        assert (feedback.error_id, feedback.object) == (3024, two)
        assert feedback.sentence == "there would be a collision on the path: mover two"


def test_a_far_place_on_a_loop_is_planned_as_fast_as_a_near_one() -> None:
    """PL-12, EN-04: 16 million turns round a circle; a cycle took half a second."""
    circle = {"shape": "circle", "from": {"x": 10, "y": 0}, "to": {"x": 10, "y": 0}, "center": {"x": 0, "y": 0}}
    with Engine({"name": "ring", "axes": [], "movers": [{"name": "one", "initial": {"x": 10, "y": 0}}],
                 "tracks": [{"name": "ring", "closed_loop": True, "elements": [circle]}]}) as engine:  # fmt: skip
        one, ring = engine.mover("one"), engine.track("ring")
        ring.enable().wait()
        one.enable().wait()
        one.join_track(track="ring").wait()
        before = time.process_time()
        move = one.move_on_track(position=1e9)
        engine.run(0.02)
        assert time.process_time() - before < 0.1
        assert not move.final
        assert one.track_position > 0


# --- relative set points beside other movers ---


def line(x0: float, y0: float, x1: float, y1: float) -> dict[str, Any]:
    return {"elements": [{"from": {"x": x0, "y": y0}, "to": {"x": x1, "y": y1}}]}


def side_by_side(x: float, y: float, apart: float = 180, **of_one: Any) -> Engine:
    """Two tracks side by side, and one that ends at the upper one without a node; all enabled. Mover two is at x, y."""
    engine = Engine(
        {
            "name": "tracks",
            "axes": [],
            "movers": [
                {"name": "one", "initial": {"x": 500, "y": 0}, **of_one},
                {"name": "two", "initial": {"x": x, "y": y}},
            ],
            "tracks": [
                {"name": "lower", **line(0, 0, 1400, 0)},
                {"name": "upper", **line(400, apart, 1000, apart)},
                {"name": "across", **line(700, 900, 700, apart)},
            ],
        }
    )
    for component in (*engine.movers.values(), *engine.tracks.values()):
        component.enable().wait()
    return engine


@pytest.mark.parametrize("moves", [(), ("one",), ("two",), ("one", "two")], ids=" ".join)
@pytest.mark.parametrize("where", ["free", "upper", "across", "joining", "ahead", "behind"])
@pytest.mark.parametrize("to", ["towards", "away"])
def test_relative_set_points_lead_into_no_mover(where: str, moves: tuple[str, ...], to: str) -> None:
    """PL-13, PL-81: neither off every track nor on the same one or another one, at rest or in motion."""
    places = {"across": (700, 190), "ahead": (860, 0), "behind": (300, 0), "joining": (680, 200)}
    engine = side_by_side(*places.get(where, (680, 180)))
    one, two = engine.movers.values()
    if where in ("upper", "across"):
        two.join_track(track=where).wait()
    one.join_track(track="lower").wait()
    if where in ("ahead", "behind"):
        two.join_track(track="lower").wait()
    one.move_on_track(position=650).wait()
    if where == "behind":
        two.move_on_track(position=440).wait()
    watch = Watch(engine)
    if "one" in moves:
        one.move_on_track(position=600 if where == "ahead" else 700, velocity=50)
    if "two" in moves and where == "joining":
        two.join_track(track="upper", velocity=10)
    elif "two" in moves and where == "free":
        two.move_x(position=720, velocity=30)
    elif "two" in moves:
        by = {"across": 9, "behind": -40}.get(where, 40)
        two.move_on_track(position=two.track_position + by, velocity=10)
    engine.run(0.3)
    sense = 1 if to == "towards" else -1
    sense, axis = (sense if where != "behind" else -sense, "x") if where in ("ahead", "behind") else (sense, "y")
    w, amplitude = 2 * np.pi, 45 if axis == "y" else 80
    led = one.start_external_setpoint_generation(mode="relative")
    for k in range(1, 1000):
        t = k * 1e-3
        if led.final:
            break
        more = (1 - np.cos(w * t), w * np.sin(w * t), w * w * np.cos(w * t))
        names = (axis, f"velocity_{axis}", f"acceleration_{axis}")
        one.set_external_setpoint(**{n: sense * amplitude * float(m) for n, m in zip(names, more, strict=True)})
        engine.step()
    ended = led.final
    one.stop_external_setpoint_generation()
    engine.run(1)
    assert not watch.overlaps
    if to == "towards":
        assert led.error_id == 3024
        assert "two" in led.sentence
    elif axis == "y":
        assert not ended, led.sentence


@pytest.mark.parametrize("seed", range(12))
def test_relative_set_points_beside_a_track_at_any_time(seed: int) -> None:
    """PL-81: with any speed, distance and end of the motion beneath."""
    rng = random.Random(seed)
    y = rng.choice([180, 190, 200])
    engine = side_by_side(700, y, y, xy={"maximum": {"velocity": 1000, "acceleration": 5000, "jerk": 50_000}})
    one, two = engine.movers.values()
    one.join_track(track="lower").wait()
    two.join_track(track="upper").wait()
    watch = Watch(engine)
    for _ in range(3):
        one.move_on_track(position=1100 if one.track_position < 700 else 300, velocity=rng.choice([100, 200, 400]))
        engine.run(rng.uniform(0, 1))
        led = one.start_external_setpoint_generation(mode="relative")
        w, amplitude, brake = 2 * np.pi * rng.choice([1, 1.5]), rng.uniform(10, 60), rng.randrange(300, 2000)
        for k in range(1, 2000):
            if led.final:
                break
            t = k * 1e-3
            v, a = amplitude * w * np.sin(w * t), amplitude * w * w * np.cos(w * t)
            one.set_external_setpoint(y=amplitude * (1 - np.cos(w * t)), velocity_y=v, acceleration_y=a)
            if k == brake:
                one.move_on_track(position=one.track_position, deceleration=rng.choice([300, 10_000]))
            engine.step()
        engine.run(2)
        one.reset().wait()
        one.move_on_track(position=one.track_position).wait()
    assert not watch.overlaps
