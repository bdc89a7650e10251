"""Movers that go along with axes and other movers, over tracks: the manual's programs, and what goes wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine, TrackTrail

AXIS = "{name: axis, limits: {velocity: 1000, acceleration: 10000, jerk: 200000}}"

ONE_ON_A_LINE = f"""
name: line
axes: [{AXIS}]
movers: [{{name: mover, initial: {{x: 100, y: 100}}}}]
tracks: [{{name: track}}]
"""


def follow_an_axis(session: takt.Session, to: float, velocity: float = 30) -> takt.Feedback:
    """The states of the manual's program 6.2.8."""
    mover, track, axis = session.mover("mover"), session.track("track"), session.axis("axis")
    track.append_line(start_x=100, start_y=100, end_x=860, end_y=100)
    track.enable()
    session.wait(lambda: track.state == "Enabled", 1)
    mover.enable()
    session.wait(lambda: mover.state == "Enabled", 1)
    mover.join_track(track="track")
    session.wait(lambda: mover.command_mode == "OnTrack", 1)
    axis.power().wait()
    axis.move_absolute(position=to, velocity=velocity, acceleration=100, deceleration=100, jerk=100)
    return mover.gear_in_pos_on_track(
        master="axis", master_sync_position=100, slave_sync_position=100, slave_sync_track="track"
    )


@pytest.mark.parametrize("kind", ["linear", "rotary"])
@pytest.mark.parametrize("how", ["home", "define_position"])
def test_with_an_axis_that_counts_anew(kind: str, how: str) -> None:
    """PL-14: positions of the master are those that it has now."""
    machine = f"""
name: line
axes:
  - {{name: web, kind: {kind}, limits: {{velocity: 1000, acceleration: 10000, jerk: 200000}}}}
movers: [{{name: mover}}]
tracks: [{{name: track, elements: [{{from: {{x: 0, y: 0}}, to: {{x: 1000, y: 0}}}}]}}]
"""
    engine = Engine(machine)
    mover, web = engine.mover("mover"), engine.axis("web")
    for enabled in (mover.enable(), engine.track("track").enable(), web.power()):
        enabled.wait()
    mover.join_track(track="track").wait()
    getattr(web, how)(position=90).wait()
    mover.gear_in_pos_on_track(
        master="web", master_sync_position=40, slave_sync_position=300, allowed_slave_sync_directions="both"
    )
    engine.wait(lambda: mover.in_sync, 5)
    assert mover.track_position == pytest.approx(350, abs=1e-6)
    web.move_absolute(position=170).wait()
    engine.wait(lambda: mover.in_sync, 5)
    assert mover.track_position == pytest.approx(430, abs=1e-6)


def test_with_an_axis() -> None:
    """PL-14, PL-50, example 6.2.8: the mover stands at 600 of 760, in step all the way."""
    engine = Engine(ONE_ON_A_LINE)
    gear = follow_an_axis(engine, 600)
    mover = engine.mover("mover")
    engine.step()
    recorder = engine.record()
    engine.wait(lambda: engine.axis("axis").set_position >= 600, 40)
    engine.run(0.1)
    assert gear.active
    assert gear.reached
    assert mover.in_sync
    assert (mover.track_position, mover.x) == (pytest.approx(600, abs=1e-9), pytest.approx(700))
    assert engine.track("track").length == pytest.approx(760)
    recording = recorder.stop()
    # Much earlier in step than at the place it was given.
    error = recording["mover"]["track_position"] - recording["axis"]["set_position"]
    assert np.max(np.abs(error)) < 1e-6
    mover.halt().wait()
    assert gear.aborted


def test_beyond_the_end() -> None:
    """PL-14, PL-50, example 6.2.8: a target beyond the track is an error; the mover stands at its end."""
    engine = Engine(ONE_ON_A_LINE)
    gear = follow_an_axis(engine, 900, velocity=200)
    mover = engine.mover("mover")
    engine.wait(lambda: gear.final, 20)
    assert gear.error_id == 3080
    assert not mover.in_sync
    engine.run(1)
    assert mover.track_position == pytest.approx(760, abs=1e-6)
    assert mover.state == "Enabled"
    # Another command takes it back.
    mover.move_on_track(position=100).wait()


def test_back_before_the_start() -> None:
    """PL-14: the mover stops at the start of its track, and says so."""
    engine = Engine(ONE_ON_A_LINE)
    gear = follow_an_axis(engine, 300, velocity=200)
    engine.wait(lambda: engine.axis("axis").set_position >= 300, 20)
    engine.axis("axis").move_absolute(position=-100, velocity=200)
    engine.wait(lambda: gear.final, 20)
    assert gear.error_id == 3080
    engine.run(1)
    assert engine.mover("mover").track_position == pytest.approx(0, abs=1e-6)


def test_a_master_that_is_too_fast() -> None:
    """PL-14: no error; the mover gets into step once the master slows down."""
    engine = Engine(ONE_ON_A_LINE)
    gear = follow_an_axis(engine, 600, velocity=100)
    mover = engine.mover("mover")
    slow = mover.gear_in_pos_on_track(
        master="axis", master_sync_position=100, slave_sync_position=100, velocity=40, acceleration=1000, jerk=10000
    )
    engine.run(5)
    assert gear.aborted
    assert slow.active
    assert not mover.in_sync
    assert mover.sync_error < -10
    assert mover.track_velocity == pytest.approx(40)
    engine.wait(lambda: mover.in_sync, 20)
    assert mover.track_position == pytest.approx(600, abs=1e-6)


def test_a_master_that_is_switched_off() -> None:
    """PL-14: the gear is over, with an error, and the mover rests."""
    engine = Engine(ONE_ON_A_LINE)
    gear = follow_an_axis(engine, 600, velocity=100)
    engine.run(3)
    engine.axis("axis").power(enable=False).wait()
    engine.run(1)
    assert gear.error_id == 3019
    assert engine.mover("mover").track_velocity == 0
    with pytest.raises(takt.CommandError, match="without power"):
        engine.mover("mover").gear_in_pos_on_track(master="axis", master_sync_position=0, slave_sync_position=0).wait()


@pytest.mark.parametrize("off", [False, True])
def test_a_gear_that_fails_ends_what_is_buffered(off: bool) -> None:
    """PL-71: at the end of the track, or once the axis is without power, nothing begins by itself."""
    engine = Engine(ONE_ON_A_LINE)
    gear = follow_an_axis(engine, 900, velocity=200)
    mover = engine.mover("mover")
    engine.run(3)
    behind = mover.move_on_track(position=0, buffer_mode="buffered")
    engine.step(2)
    assert behind.busy
    if off:
        engine.axis("axis").power(enable=False).wait()
    engine.wait(lambda: gear.final, 20)
    assert gear.error_id == (3019 if off else 3080)
    engine.run(1)
    assert behind.aborted
    assert (mover.buffered, mover.track_velocity) == (0, 0)


TWO_TRACKS = f"""
name: lines
axes: [{AXIS}]
movers:
  - {{name: master, initial: {{x: 100, y: 620}}}}
  - {{name: slave, initial: {{x: 100, y: 100}}}}
tracks:
  - {{name: master_track, elements: [{{from: {{x: 100, y: 620}}, to: {{x: 860, y: 620}}}}]}}
  - {{name: slave_track, elements: [{{from: {{x: 100, y: 100}}, to: {{x: 860, y: 100}}}}]}}
"""


def two_on_tracks(session: takt.Session) -> tuple[takt.Mover, takt.Mover]:
    master, slave = session.mover("master"), session.mover("slave")
    for track in session.tracks.values():
        track.enable().wait()
    for mover in (master, slave):
        mover.enable().wait()
        mover.join_track(track=f"{mover.name}_track").wait()
    return master, slave


def along_with_a_mover(session: takt.Session) -> takt.Feedback:
    """The states 12 and 13 of the manual's program 6.2.9."""
    master, slave = two_on_tracks(session)
    master.move_on_track(position=500)
    return slave.gear_in_pos_on_track_with_master_mover(
        master="master",
        master_sync_position=100,
        master_sync_track="master_track",
        slave_sync_position=100,
        slave_sync_track="slave_track",
    )


def test_with_a_mover() -> None:
    """PL-14, PL-50, example 6.2.9: the slave stands at 500."""
    engine = Engine(TWO_TRACKS)
    recorder = engine.record()
    gear = along_with_a_mover(engine)
    slave = engine.mover("slave")
    engine.run(3)
    assert gear.reached
    assert slave.track_position == pytest.approx(500, abs=1e-9)
    assert slave.in_sync
    recording = recorder.stop()
    error = recording["slave"]["sync_error"]
    assert np.max(np.abs(error)) < 1e-6


def test_the_same_over_lcm(tmp_path: Path) -> None:
    """PL-50, example 6.2.9 against taktd."""
    url = new_url()
    with running(tmp_path, url, machine=TWO_TRACKS), takt.connect(url) as session:
        gear = along_with_a_mover(session)
        slave = session.mover("slave")
        session.wait(lambda: slave.in_sync and slave.track_position >= 499.999, 10)
        assert gear.active


NETWORK = """
name: switch
axes: []
movers:
  - {name: master, initial: {x: 100, y: 360}}
  - {name: slave, initial: {x: 100, y: 120}}
tracks:
  - {name: track_in, elements: [{from: {x: 100, y: 360}, to: {x: 400, y: 360}}]}
  - {name: track_out1, starts_from: [track_in], elements: [{from: {x: 450, y: 410}, to: {x: 860, y: 620}}]}
  - {name: track_out2, starts_from: [track_in], elements: [{from: {x: 450, y: 310}, to: {x: 860, y: 100}}]}
"""


def behind_a_mover(session: takt.Session) -> takt.Feedback:
    """The manual's program 6.2.12."""
    master, slave = session.mover("master"), session.mover("slave")
    for track in session.tracks.values():
        track.enable().wait()
    master.enable().wait()
    master.join_track(track="track_in").wait()
    master.move_on_track(track="track_in", position=200).wait()
    slave.enable().wait()
    slave.join_track(track="track_in").wait()
    slave.move_on_track(track="track_in", position=0).wait()
    master.move_on_track(track="track_out1", position=500)
    return slave.gear_in_pos_on_track_with_master_mover(
        master="master",
        master_sync_position=210,
        master_sync_track="track_in",
        slave_sync_position=10,
        slave_sync_track="track_in",
        follow_mover=True,
    )


def test_behind_a_mover_through_a_network() -> None:
    """PL-14, PL-50, example 6.2.12: the slave stands at 300 on the branch that the master took."""
    engine = Engine(NETWORK)
    gear = behind_a_mover(engine)
    master, slave = engine.mover("master"), engine.mover("slave")
    recorder = engine.record()
    engine.run(4)
    assert (master.track, master.track_position) == (2, 500)
    assert (slave.track, slave.track_position) == (2, pytest.approx(300, abs=1e-6))
    assert gear.reached
    recording = recorder.stop()
    length = engine.track("track_in").length
    first, second = (
        recording[name]["track_position"] + length * (recording[name]["track"] - 1) for name in ("master", "slave")
    )
    assert np.min(first - second) > 200 - 1e-6
    # And on, wherever the master goes.
    master.move_on_track(position=515)
    engine.run(2)
    assert slave.track_position == pytest.approx(315, abs=1e-6)


TRAIL = f"""
name: trail
axes: [{AXIS}]
movers: [{{name: mover, initial: {{x: 100, y: 100}}}}]
tracks:
  - {{name: track1, elements: [{{from: {{x: 100, y: 100}}, to: {{x: 400, y: 100}}}}]}}
  - {{name: track2, starts_from: [track1], elements: [{{from: {{x: 500, y: 100}}, to: {{x: 860, y: 100}}}}]}}
  - {{name: track3, starts_from: [track1], elements: [{{from: {{x: 500, y: 200}}, to: {{x: 500, y: 600}}}}]}}
"""


def along_a_trail(session: takt.Session, to: float) -> takt.Feedback:
    """The manual's program 6.8.1, with one more track at the end of the first."""
    mover, axis = session.mover("mover"), session.axis("axis")
    for track in session.tracks.values():
        track.enable().wait()
    mover.enable().wait()
    mover.join_track(track="track1").wait()
    axis.power().wait()
    axis.move_absolute(position=to, velocity=100, acceleration=100, deceleration=100, jerk=1000)
    trail = TrackTrail()
    trail.add_track("track1")
    trail.add_track("track2")
    return mover.gear_in_pos_on_track(
        master="axis", trail=trail, master_sync_position=100, slave_sync_position=100, slave_sync_track="track1"
    )


def test_along_a_trail() -> None:
    """PL-14, PL-34, PL-50, example 6.8.1: over two tracks with an axis."""
    engine = Engine(TRAIL)
    gear = along_a_trail(engine, 700)
    mover = engine.mover("mover")
    engine.step()
    recorder = engine.record()
    engine.wait(lambda: engine.axis("axis").set_position >= 700, 20)
    engine.run(0.1)
    assert gear.reached
    length = engine.track("track1").length
    assert (mover.track, mover.track_position) == (2, pytest.approx(700 - length, abs=1e-9))
    recording = recorder.stop()
    assert np.max(np.abs(recording["mover"]["sync_error"])) < 1e-6


def test_beyond_the_end_of_a_trail() -> None:
    """PL-34, example 6.8.1: the end of the last track is the end of the way."""
    engine = Engine(TRAIL)
    gear = along_a_trail(engine, 2000)
    engine.wait(lambda: gear.final, 20)
    engine.run(1)
    assert gear.error_id == 3080
    mover = engine.mover("mover")
    assert (mover.track, mover.track_position) == (2, pytest.approx(engine.track("track2").length, abs=1e-6))


def test_trails() -> None:
    """PL-34: each track once; what does not connect, or leaves out the mover, is refused."""
    trail = TrackTrail(["track1"])
    with pytest.raises(ValueError, match="track1 is on the trail already"):
        trail.add_track("track1")
    assert list(trail) == ["track1"]
    trail.clear()
    assert not trail
    engine = Engine(TRAIL)
    along_a_trail(engine, 0)
    mover = engine.mover("mover")

    def gear(**options: object) -> None:
        arguments = {"master": "axis", "master_sync_position": 0, "slave_sync_position": 0, **options}
        mover.gear_in_pos_on_track(**arguments).wait(until="active")

    with pytest.raises(takt.CommandError, match="form no such trail"):
        gear(trail=["track2", "track1"])
    with pytest.raises(takt.CommandError, match="or the mover is not on it"):
        gear(trail=["track2"])
    with pytest.raises(takt.CommandError, match="or the mover is not on it"):
        gear(slave_sync_track="track2")
    with pytest.raises(takt.CommandError, match="trail: expected the name of a track of the machine, found 'track9'"):
        gear(trail=["track1", "track9"])
    with pytest.raises(takt.CommandError, match="expected each track once"):
        gear(trail=["track1", "track1"])
    with pytest.raises(takt.CommandError, match="a list of at most 128"):
        gear(trail=["track1"] * 129)
    with pytest.raises(takt.CommandError, match="master: expected the name of an axis, found 'mover'"):
        gear(master="mover")
    with pytest.raises(takt.CommandError, match="must be 0 where the direction is non_modulo"):
        gear(modulo_tolerance_slave_sync_position=1)
    with pytest.raises(takt.CommandError):
        gear(direction_slave_sync_position="positive")  # of a closed loop only
    with pytest.raises(takt.CommandError):
        gear(slave_sync_position=1000)


def test_rings_of_masters() -> None:
    """PL-14: nobody follows itself, be it over others."""
    engine = Engine(TWO_TRACKS)
    master, slave = two_on_tracks(engine)
    axis = engine.axis("axis")
    places = {"master_sync_position": 0, "slave_sync_position": 0}
    slave.gear_in_pos_on_track_with_master_mover(master="master", **places).wait(until="active")
    with pytest.raises(takt.CommandError, match="another mover"):
        master.gear_in_pos_on_track_with_master_mover(master="master", **places).wait(until="active")
    with pytest.raises(takt.CommandError, match="the coupling would form a loop"):
        master.gear_in_pos_on_track_with_master_mover(master="slave", **places).wait(until="active")
    axis.power().wait()
    axis.gear_in_pos(master="slave", **places).wait(until="active")
    with pytest.raises(takt.CommandError, match="the coupling would form a loop"):
        master.gear_in_pos_on_track(master="axis", **places).wait(until="active")
    axis.halt().wait()
    master.gear_in_pos_on_track(master="axis", **places).wait(until="active")
    with pytest.raises(takt.CommandError, match="the coupling would form a loop"):
        axis.gear_in(master="slave.x").wait(until="active")


def test_axes_that_follow_movers() -> None:
    """A mover as the master of an axis: its way over tracks, and its coordinates."""
    engine = Engine(TRAIL.replace(f"axes: [{AXIS}]", f"axes: [{AXIS}, {AXIS.replace('axis', 'other')}]"))
    mover, axis, other = engine.mover("mover"), engine.axis("axis"), engine.axis("other")
    for track in engine.tracks.values():
        track.enable().wait()
    axis.power().wait()
    with pytest.raises(takt.CommandError, match="without power"):
        axis.gear_in(master="mover").wait(until="active")
    other.power().wait()
    mover.enable().wait()
    mover.join_track(track="track1").wait()
    gear = axis.gear_in_pos(master="mover", master_sync_position=0, slave_sync_position=0)
    second = other.gear_in(master="mover.x", ratio_numerator=2)
    engine.run(0.2)
    recorder = engine.record()
    mover.move_on_track(track="track2", position=300, velocity=400, acceleration=2000, jerk=50000).wait()
    engine.run(0.1)
    recording = recorder.stop()
    assert gear.reached
    assert second.reached
    length = engine.track("track1").length
    assert axis.set_position == pytest.approx(length + 300)
    way = recording["mover"]["track_position"] + length * (recording["mover"]["track"] == 2)
    # In the same cycle, and over the border between tracks.
    assert np.max(np.abs(recording["axis"]["set_position"] - way)) < 1e-6
    x = 2 * recording["mover"]["x"]
    assert np.max(np.abs(np.diff(recording["other"]["set_position"]) - np.diff(x))) < 1e-6
    mover.disable().wait()
    engine.run(0.1)
    assert gear.error_id != 0


def test_a_master_that_nobody_is() -> None:
    """The sentence names what an axis can follow, and what is wrong beside a master that there is."""
    engine = Engine(TRAIL)
    axis = engine.axis("axis")
    axis.power().wait()
    for wrong, near in (("mover.yy", "mover.y"), ("nobody", "mover.x")):
        there = f"there are axis, and movers with their coordinates, such as {near}"
        assert axis.gear_in(master=wrong).wait_final().sentence == f"master: there is no axis '{wrong}'; {there}"
    cam = axis.cam_in(master="mover.x", cam="none").wait_final()
    assert cam.sentence == "cam: the machine has no cam 'none'"


LOOP = f"""
name: loop
axes: [{AXIS}]
movers: [{{name: mover, initial: {{x: 350, y: 100}}}}]
tracks:
  - name: ring
    closed_loop: true
    elements:
      - {{from: {{x: 200, y: 100}}, to: {{x: 500, y: 100}}}}
      - {{from: {{x: 500, y: 400}}, to: {{x: 200, y: 400}}}}
"""


@pytest.mark.parametrize(("direction", "way"), [("positive", "on"), ("negative", "back"), ("shortest_way", "back")])
def test_round_a_loop(direction: str, way: str) -> None:
    """PL-14: places of a loop are the same but for whole turns; turns are counted on."""
    engine = Engine(LOOP)
    mover, axis, ring = engine.mover("mover"), engine.axis("axis"), engine.track("ring")
    ring.enable().wait()
    mover.enable().wait()
    mover.join_track(track="ring").wait()
    axis.power().wait()
    begin = mover.track_position
    assert begin == pytest.approx(150, abs=1e-6)
    # A place behind the mover, and the same one a turn on.
    gear = mover.gear_in_pos_on_track(
        master="axis",
        master_sync_position=0,
        slave_sync_position=100,
        direction_slave_sync_position=direction,
        allowed_slave_sync_directions="both",
    )
    engine.run(0.1)
    assert np.sign(mover.track_velocity) == (1 if way == "on" else -1)
    gear.wait(until="reached")
    recorder = engine.record()
    engine.run(0.01)
    assert mover.track_position == pytest.approx(100, abs=1e-6)
    axis.move_absolute(position=2.5 * ring.length, velocity=500).wait()
    engine.run(0.01)
    assert mover.track_position == pytest.approx((100 + 2.5 * ring.length) % ring.length, abs=1e-6)
    recording = recorder.stop()
    assert np.max(np.abs(recording["mover"]["sync_error"])) < 1e-6


def test_a_master_that_leaves() -> None:
    """PL-14: a master that is disabled is none any more."""
    engine = Engine(TWO_TRACKS)
    gear = along_with_a_mover(engine)
    engine.run(0.3)
    engine.mover("master").disable()
    engine.run(1)
    assert gear.error_id == 3082
    assert engine.mover("slave").track_velocity == 0
    assert engine.mover("slave").state == "Enabled"
    with pytest.raises(takt.CommandError, match="not enabled, or not on a track"):
        engine.mover("slave").gear_in_pos_on_track_with_master_mover(
            master="master", master_sync_position=0, slave_sync_position=0
        ).wait(until="active")


def test_replay_is_the_same() -> None:
    """Two engines, one story: the same to the last bit."""
    hashes = []
    for _ in range(2):
        engine = Engine(NETWORK)
        behind_a_mover(engine)
        engine.run(1)
        hashes.append(engine.state_hash)
    assert hashes[0] == hashes[1]


@pytest.mark.parametrize(("allowed", "begin", "end"), [("positive", 620, 480), ("negative", 300, 470)])
def test_who_waits_for_an_axis_says_so(allowed: str, begin: float, end: float) -> None:
    """PL-84: its place behind the axis is where it may not go; it stands until the axis brings that, and says why."""
    with Engine(f"""
name: waits
axes: [{AXIS}]
movers: [{{name: mover, initial: {{x: {begin}}}}}]
tracks: [{{name: track, elements: [{{from: {{x: 0, y: 0}}, to: {{x: 900, y: 0}}}}]}}]
""") as engine:
        mover, axis = engine.mover("mover"), engine.axis("axis")
        engine.track("track").enable().wait()
        mover.enable().wait()
        mover.join_track(track="track").wait()
        axis.power().wait()
        begun = engine.cycle
        mover.gear_in_pos_on_track(
            master="axis",
            master_sync_position=0,
            slave_sync_position=end,
            allowed_slave_sync_directions=allowed,
        )
        engine.run(1)
        assert (mover.delay, mover.waits_for, mover.in_sync) == ("master", 0, False)
        assert mover.blocked_by is axis
        assert begun <= mover.delay_since < begun + 5
        assert mover.track_position == begin
        way = begin - end + (20 if allowed == "positive" else -20)
        axis.move_relative(distance=way, velocity=100, acceleration=100, deceleration=100, jerk=100).wait()
        engine.run(2)
        assert (mover.delay, mover.delay_since, mover.in_sync) == ("none", 0, True)
        assert mover.track_position == pytest.approx(end + way, abs=1e-6)
