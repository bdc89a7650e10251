"""Groups of movers and environments: the manual's programs, and what is said of what is in the way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine

TWO_IN_A_GROUP = """
name: cell
axes: []
movers:
  - {name: one}
  - {name: two, initial: {x: 240}}
tracks: [{name: track}]
planar_groups: [{name: group}]
"""
LINE = "[{name: track, elements: [{from: {x: 0, y: 0}, to: {x: 400, y: 0}}]}]"
WITH_A_LINE = TWO_IN_A_GROUP.replace("[{name: track}]", LINE)


def gather(session: takt.Session) -> list[takt.Mover]:
    """Movers and the group enabled, and the movers put into it: by states, as the manual's programs do."""
    movers, group = list(session.movers.values()), session.planar_group("group")
    for mover in movers:
        mover.enable()
    session.wait(lambda: all(mover.state == "Enabled" for mover in movers), 1)
    group.enable()
    session.wait(lambda: group.state == "Enabled", 1)
    for mover in movers:
        mover.add_to_group(group="group")
    session.wait(lambda: all(mover.group == 1 for mover in movers), 1)
    return movers


def refuse_the_place_of_another(session: takt.Session) -> None:
    one, two = gather(session)
    first, second = one.move_to_position(x=0, y=240), two.move_to_position(x=0, y=0)
    session.wait(lambda: first.final and second.final, 10)
    assert first.done
    assert second.error
    assert second.error_id == 3024
    assert second.object is one
    assert "mover one" in second.sentence
    session.wait(lambda: (one.x, one.y) == (0, 240), 1)
    assert (two.x, two.y) == (240, 0)


def test_a_group_refuses_the_place_of_another() -> None:
    """PL-30, PL-50, example 6.3.2: mover one goes to (0, 240), mover two stays at (240, 0)."""
    engine = Engine(TWO_IN_A_GROUP)
    refuse_the_place_of_another(engine)
    one, two = engine.mover("one"), engine.mover("two")
    assert engine.planar_group("group").mover_count == 2
    record = two.history()[-1]
    assert (record.verb, record.error_id, record.object) == ("move_to_position", 3024, one)
    # Mover one has left the place: it is free now.
    two.move_to_position(x=0, y=0).wait()
    two.remove_from_group().wait()
    assert two.group == 0
    # PL-81: without the group nothing is refused; it waits on its way, and says for which mover.
    move = two.move_to_position(x=0, y=240)
    engine.run(2)
    assert move.active
    assert (two.waits_for, two.delay) == (1, "mover")
    assert one.y - 113 - 5 < two.y <= one.y - 113
    one.move_to_position(x=0, y=480).wait()
    move.wait()


def test_the_same_over_lcm(tmp_path: Path) -> None:
    """PL-02, PL-50, example 6.3.2 against taktd."""
    url = new_url()
    with running(tmp_path, url, machine=TWO_IN_A_GROUP), takt.connect(url) as session:
        refuse_the_place_of_another(session)


def test_stators_and_their_boundary() -> None:
    """PL-31, PL-50, example 6.4.2: four stators, and one boundary of four sides around them."""
    engine = Engine("name: floor\naxes: []\nenvironments: [{name: environment}]\n")
    environment = engine.environment("environment")
    for x, y in ((0, 0), (240, 0), (0, 240), (240, 240)):
        environment.add_stator(lower_x=x, lower_y=y)
    environment.create_boundary().wait()
    assert (environment.stator_count, environment.border_count) == (4, 4)
    environment.add_stator(lower_x=480, lower_y=0).wait()
    environment.create_boundary().wait()
    assert (environment.stator_count, environment.border_count) == (5, 6)
    environment.add_stator(lower_x=500, lower_y=100).wait()
    with pytest.raises(takt.CommandError, match="two stators overlap, found with stator"):
        environment.create_boundary().wait()
    environment.clear().wait()
    assert (environment.stator_count, environment.border_count) == (0, 0)
    with pytest.raises(takt.CommandError, match="there are no stators"):
        environment.create_boundary().wait()


def test_a_track_and_a_group() -> None:
    """PL-30, PL-50, example 6.5: mover two stands in the way of the track; once it is at (240, 320) mover one moves."""
    engine = Engine(TWO_IN_A_GROUP)
    track = engine.track("track")
    track.append_line(start_x=0, start_y=0, end_x=400, end_y=0)
    track.enable()
    engine.wait(lambda: track.state == "Enabled", 1)
    one, two = gather(engine)
    track.add_to_group(group="group")
    engine.wait(lambda: track.group == 1, 1)
    one.join_track(track="track")
    engine.wait(lambda: one.command_mode == "OnTrack", 1)
    feedback = one.move_on_track(position=150)
    two.move_to_position(x=240, y=320)
    engine.step(2)
    engine.wait(lambda: not two.busy_xyc, 5)
    assert feedback.error
    assert feedback.error_id == 3024
    assert feedback.object is two
    again = one.move_on_track(position=150)
    engine.step(5)
    # While it is Moving the track is its own.
    refused = two.move_to_position(x=240, y=0).wait_final()
    assert refused.object is track
    engine.wait(lambda: not one.busy_xyc, 5)
    assert again.done
    assert (one.x, one.y, one.track_position) == (150, 0, 150)
    assert (two.x, two.y) == (240, 320)
    # Standing it is not.
    two.move_to_position(x=350, y=0).wait()
    with pytest.raises(takt.CommandError, match="mover one"):
        two.move_to_position(x=240, y=0).wait()


def test_a_feedback_of_a_mover() -> None:
    """PL-02, PL-50, example 6.7.1: to (1000, 1000)."""
    engine = Engine("name: one\naxes: []\nmovers: [{name: mover}]\n")
    mover = engine.mover("mover")
    feedback = mover.enable()
    engine.wait(lambda: feedback.done, 1)
    feedback = mover.move_to_position(x=1000, y=1000)
    engine.step()
    assert feedback.busy
    assert feedback.active
    engine.wait(lambda: feedback.done, 5)
    assert (mover.x, mover.y) == (1000, 1000)
    assert feedback.object is None


ON_A_STATOR = """
name: stator
axes: []
movers: [{name: mover}]
planar_groups: [{name: group}]
environments: [{name: environment}]
"""


def test_the_border_is_not_crossed() -> None:
    """PL-30, PL-31, PL-50, example 6.7.2: one stator about the origin; (100, 100) is refused, and the mover stays."""
    engine = Engine(ON_A_STATOR)
    environment, group = engine.environment("environment"), engine.planar_group("group")
    environment.add_stator(lower_x=-120, lower_y=-120)
    environment.create_boundary()
    engine.step(3)
    (mover,) = gather(engine)
    environment.add_to_group(group="group")
    engine.wait(lambda: environment.group == 1, 1)
    assert group.environment == 1
    feedback = mover.move_to_position(x=100, y=100).wait_final()
    assert feedback.error
    assert feedback.error_id == 3024
    assert feedback.object is environment
    assert (mover.x, mover.y) == (0, 0)
    mover.move_to_position(x=63.5, y=63.5).wait()
    # What carries movers of an enabled group stays as it is.
    for command in (environment.clear, environment.create_boundary):
        with pytest.raises(takt.CommandError, match="in an enabled group"):
            command().wait()
    environment.remove_from_group().wait()
    mover.move_to_position(x=100, y=100).wait()
    # Off the stator it cannot come back.
    back = environment.add_to_group(group="group").wait_final()
    assert back.error_id == 3024
    assert back.object is mover


def test_what_a_group_needs_to_be_enabled() -> None:
    """PL-30: all at rest, apart, and within the border; else it says who is not."""
    engine = Engine(
        ON_A_STATOR.replace("[{name: group}]", "[{name: group, movers: [mover, other], environment: environment}]")
        .replace("[{name: mover}]", "[{name: mover}, {name: other, initial: {x: 250}}]")
        .replace("[{name: environment}]", "[{name: environment, stators: [{x: -120, y: -120}, {x: 120, y: -120}]}]")
    )
    mover, other, group = engine.mover("mover"), engine.mover("other"), engine.planar_group("group")
    engine.step()
    assert engine.environment("environment").border_count == 4
    other.set_position(x=113, y=0).wait()  # side by side
    refused = group.enable().wait_final()
    assert refused.error_id == 3024
    assert refused.object is other
    engine.wait(lambda: group.state == "Disabled", 1)
    other.set_position(x=250, y=0).wait()
    mover.enable().wait()
    mover.move_to_position(x=20, y=0)
    engine.step(5)
    refused = group.enable().wait_final()
    assert refused.error_id == 3060
    assert refused.object is mover
    engine.run(1)
    group.enable().wait()
    # Set elsewhere it needs room, too.
    refused = other.set_position(x=100, y=0).wait_final()
    assert refused.object is mover
    refused = other.set_position(x=350, y=0).wait_final()
    assert refused.object is engine.environment("environment")
    assert other.x == 250
    group.disable().wait()
    mover.move_to_position(x=100, y=30).wait()


def test_a_turn_needs_room() -> None:
    """PL-30: two movers flush but for 1 mm: one cannot turn by 90 degrees, but by less than half a degree."""
    engine = Engine(TWO_IN_A_GROUP.replace("x: 240", "x: 114"))
    one, two = gather(engine)
    assert one.move_c(position=90).wait_final().object is two
    one.move_c(position=0.4).wait()


def test_a_mover_says_where_it_goes_and_what_it_has_reserved() -> None:
    """PL-30, PL-70: the target at once; the rectangle around all that is covered on the way, less what is left."""
    engine = Engine(TWO_IN_A_GROUP)
    one, two = gather(engine)
    size = 113.0  # mm, of movers as they are if nothing is said

    def reserved(mover: takt.Mover) -> list[float]:
        fields = ("reserved_lower_x", "reserved_lower_y", "reserved_upper_x", "reserved_upper_y")
        return [float(getattr(mover, field)) for field in fields]

    assert reserved(two) == [240 - size / 2, -size / 2, 240 + size / 2, size / 2]
    move = one.move_to_position(x=60, y=200)
    engine.run(0.1)
    assert 0 < one.y < 100
    assert (one.target_x, one.target_y, one.target_c) == (60, 200, 0)
    assert reserved(one) == pytest.approx([one.x - size / 2, one.y - size / 2, 60 + size / 2, 200 + size / 2])
    move.wait()
    assert reserved(one) == pytest.approx([60 - size / 2, 200 - size / 2, 60 + size / 2, 200 + size / 2])
    one.move_c(position=30)
    engine.step()
    assert one.target_c == 30
    # The square turned by 30 degrees is wider by the cosine and the sine.
    assert reserved(one)[2] == pytest.approx(60 + size / 2 * 1.3660254, abs=1)
    one.remove_from_group().wait()
    engine.step()
    assert reserved(one) == [0, 0, 0, 0]


def swing(engine: Engine, mover: takt.Mover, by: float) -> tuple[takt.Feedback, float]:
    """Relative set points in Y, up to twice `by`, mm: how they end, and how far Y came."""
    feedback = mover.start_external_setpoint_generation(mode="relative")
    furthest = mover.y
    for k in range(1600):
        t = 0.001 * k
        mover.set_external_setpoint(
            y=by * (1 - np.cos(2 * t)), velocity_y=2 * by * np.sin(2 * t), acceleration_y=4 * by * np.cos(2 * t)
        )
        engine.step()
        furthest = max(furthest, mover.y)
    return feedback, furthest


OFF_A_TRACK = """
name: cell
axes: []
movers: [{name: one}, {name: two, initial: {x: 300, y: 300}}]
tracks: [{name: track, elements: [{from: {x: 0, y: 0}, to: {x: 450, y: 0}}]}]
environments: [{name: floor, stators: [{x: -120, y: -120}, {x: 120, y: -120}, {x: 360, y: -120}, {x: -120, y: 120},
   {x: 120, y: 120}, {x: 360, y: 120}]}]
planar_groups: [{name: group, movers: [one, two], tracks: [track], environment: floor}]
"""


@pytest.mark.parametrize("at", [300, 30], ids=["another mover", "the border"])
def test_set_points_beside_a_track_are_watched(at: float) -> None:
    """PL-13, PL-30: off its place on a track a mover comes near nothing of its group, and not over the border."""
    engine = Engine(OFF_A_TRACK)
    one, two = engine.mover("one"), engine.mover("two")
    for enabled in (one.enable(), two.enable(), engine.track("track").enable(), engine.planar_group("group").enable()):
        enabled.wait()
    one.join_track(track="track").wait()
    one.move_on_track(position=at).wait()
    feedback, furthest = swing(engine, one, 200)
    assert (feedback.error, feedback.error_id) == (True, 3024)
    border = 300 - 113 if at == 300 else 360 - 56.5
    assert border - 15 < furthest < border  # what it needs to stop is left
    assert feedback.object is (two if at == 300 else engine.environment("floor"))
    engine.run(2)
    assert (one.x, one.y) == (at, 0)
    # And nobody comes where it is off to.
    one.reset().wait()
    feedback = one.start_external_setpoint_generation(mode="relative")
    for k in range(400):
        t = 0.001 * k
        one.set_external_setpoint(
            y=60 * (1 - np.cos(2 * t)), velocity_y=120 * np.sin(2 * t), acceleration_y=240 * np.cos(2 * t)
        )
        engine.step()
    refused = two.move_to_position(x=at, y=one.y + 100).wait_final()
    assert (refused.error_id, refused.object) == (3024, one)


def test_a_turn_that_goes_too_far() -> None:
    """PL-30: sent back in the middle of a turn, a mover has as its own what it goes on by."""
    engine = Engine(TWO_IN_A_GROUP)
    one, two = gather(engine)
    recorder = engine.record()
    one.move_c(position=90)
    engine.wait(lambda: one.c >= 15, 1)
    back = one.move_c(position=0)
    engine.step()
    # At 20 degrees a corner is 72.4 mm out, at 30 degrees 77.2 mm, at 45 degrees 79.9 mm.
    refused = two.move_to_position(x=133, y=0).wait_final()
    assert refused.object is one
    two.move_to_position(x=137, y=0).wait()
    if not back.final:
        back.wait()
    assert recorder.stop()["one"]["c"].max() > 40
    two.move_to_position(x=133, y=0).wait()


def test_a_track_outside_the_group() -> None:
    """PL-30: a mover of a group moves along tracks of the group alone."""
    engine = Engine(WITH_A_LINE)
    engine.track("track").enable().wait()
    one, _ = gather(engine)
    one.join_track(track="track").wait()
    refused = one.move_on_track(position=50).wait_final()
    assert refused.error_id == 3066
    assert refused.object is engine.track("track")


def test_who_is_in_the_way_on_tracks() -> None:
    """PL-02: without any group, too: who is too near to join, and the track where others move."""
    engine = Engine(WITH_A_LINE)
    track = engine.track("track")
    one, two = engine.mover("one"), engine.mover("two")
    for component in (track, one, two):
        component.enable().wait()
    one.join_track(track="track").wait()
    one.move_on_track(position=100).wait()
    assert two.join_track(track="track").wait_final().object is one
    one.move_on_track(position=0)
    refused = two.join_track(track="track").wait_final()
    assert refused.error_id == 3046
    assert refused.object is track


def test_replay_is_the_same(tmp_path: Path) -> None:
    """EN-07, EN-22: a log with a boundary made and moves refused gives the same states to the last bit."""
    url = new_url()
    log = tmp_path / "log.lcm"
    with running(tmp_path, url, "--log", str(log), machine=ON_A_STATOR), takt.connect(url) as session:
        environment = session.environment("environment")
        environment.add_stator(lower_x=-120, lower_y=-120).wait()
        environment.create_boundary().wait()
        (mover,) = gather(session)
        environment.add_to_group(group="group").wait()
        feedback = mover.move_to_position(x=100, y=100).wait_final()
        assert feedback.object is environment
        mover.move_to_position(x=50, y=50).wait()
    result = takt.replay(log)
    assert result.same, result.sentence


@pytest.mark.parametrize("checked", [True, False])
def test_static_objects_may_be_left_out(checked: bool) -> None:
    """PL-86: a track nearer to the border than its largest mover allows, though the mover on it fits."""
    engine = Engine(f"""
name: narrow
axes: []
movers: [{{name: small, width: 100, height: 100, initial: {{x: 90, y: 120}}}}]
tracks:
  - name: way
    check_collision_against_static_objects: {str(checked).lower()}
    elements: [{{from: {{x: 90, y: 120}}, to: {{x: 390, y: 120}}}}]
environments: [{{name: floor, stators: [{{x: 0, y: 0}}, {{x: 240, y: 0}}]}}]
planar_groups: [{{name: group, movers: [small], tracks: [way], environment: floor}}]
""")
    small = engine.mover("small")
    engine.track("way").enable().wait()
    small.enable().wait()
    engine.planar_group("group").enable().wait()
    small.join_track(track="way").wait()
    move = small.move_on_track(position=250).wait_final()
    assert move.done is not checked
    if checked:
        assert move.object is engine.environment("floor")
