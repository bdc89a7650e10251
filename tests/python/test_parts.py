"""Parts of the surface: the manual's programs, and what movers and tracks on them can do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine

TWO_PARTS = """
name: side by side
axes: []
coordinate_systems: [{name: plane}]
parts:
  - {name: left, positions: [{coordinate_system: plane}]}
  - {name: right, positions: [{coordinate_system: plane, x: 240}]}
movers:
  - {name: mover, reference: left, initial: {x: 120, y: 120}}
tracks: [{name: track_one, part: left}, {name: track_two, part: right}]
"""

LIFT = """
name: lift
axes: []
coordinate_systems: [{name: lower}, {name: upper}]
parts:
  - {name: one, positions: [{coordinate_system: lower}]}
  - {name: two, positions: [{coordinate_system: upper}]}
  - name: three
    positions: [{coordinate_system: lower, y: 240}, {coordinate_system: upper, y: 240}]
    initial_position: 2
movers:
  - {name: mover, reference: one, initial: {x: 120, y: 120}}
"""

NETWORK = """
name: network
axes: []
coordinate_systems: [{name: plane}]
parts:
  - name: part_one
    columns: 2
    rows: 4
    positions: [{coordinate_system: plane}]
  - name: part_two
    stators: [{x: 0, y: 0}, {x: 0, y: 240}]
    positions: [{coordinate_system: plane, x: 480}, {coordinate_system: plane, x: 480, y: 480}]
movers:
  - {name: mover, reference: part_two, initial: {x: 120, y: 240}}
tracks: [{name: track_one, part: part_one}, {name: track_two, part: part_one}, {name: track_three, part: part_two}]
"""


def enabled(session: takt.Session) -> takt.Mover:
    mover = session.mover("mover")
    mover.enable()
    session.wait(lambda: mover.state == "Enabled", 1)
    return mover


def test_across_parts() -> None:
    """PL-32, PL-50, example 6.1.4: 100, 100 on the right part is 340, 100."""
    with Engine(TWO_PARTS) as engine:
        mover = enabled(engine)
        mover.move_to_position(x=100, y=100, reference="right").wait()
        assert (mover.x, mover.y) == (pytest.approx(340, abs=1e-9), pytest.approx(100, abs=1e-9))
        assert mover.position_on_current_part == pytest.approx((100, 100, 0), abs=1e-9)
        assert (mover.part, mover.coordinate_system) == (2, 1)
        assert engine.part("right").mover_count == 1
        # All is fixed in one coordinate system: it need not be named.
        mover.move_to_position(x=120, y=100).wait()
        assert mover.part == 1
        with pytest.raises(takt.CommandError, match="leave the stators"):
            mover.move_to_position(x=120, y=200).wait()
        with pytest.raises(takt.CommandError, match="did you mean right"):
            mover.move_to_position(x=120, y=100, reference="rihgt").wait()


@pytest.mark.parametrize("reference", [None, "plane", "left"])
def test_external_set_points(reference: str | None) -> None:
    """PL-13, PL-50, example 6.1.7: it accelerates to 100 mm/s2 and back to 0, and comes to rest to the right, still on
    its first part."""
    text = TWO_PARTS.replace("initial:", "missing_setpoints: 20, initial:").replace(
        "axes: []", "axes: []\ncycle: {period_s: 0.01}"
    )
    with Engine(text) as engine:
        mover = enabled(engine)
        mover.start_external_setpoint_generation()
        options = {} if reference is None else {"reference": reference}
        x, velocity, acceleration, jerk, dt = mover.x, 0.0, 0.0, 1000.0, 0.01
        while True:
            x += dt * velocity + dt**2 / 2 * acceleration + dt**3 / 6 * jerk
            velocity += dt * acceleration + dt**2 / 2 * jerk
            acceleration += dt * jerk
            mover.set_external_setpoint(x=x, y=120, velocity_x=velocity, acceleration_x=acceleration, **options)
            engine.step()
            if acceleration >= 100:
                jerk = -1000.0
            if acceleration <= 1e-9:
                break
        assert mover.x == pytest.approx(x, abs=1e-9)
        mover.stop_external_setpoint_generation().wait()
        assert mover.command_mode == "FreeMovement"
        assert 120 < x < mover.x < 240
        assert mover.part == 1


def test_tracks_across_parts() -> None:
    """PL-33, PL-50, example 6.2.5: 150 along the second track, at 390, 120."""
    with Engine(TWO_PARTS) as engine:
        one, two = engine.track("track_one"), engine.track("track_two")
        one.append_line(start_x=40, start_y=120, end_x=240, end_y=120, reference="plane")
        two.start_from_track(track="track_one")
        two.append_line(start_x=260, start_y=120, end_x=440, end_y=120, reference="plane")
        one.enable()
        two.enable()
        engine.wait(lambda: one.state == two.state == "Enabled", 1)
        mover = enabled(engine)
        mover.join_track(track="track_one")
        engine.wait(lambda: mover.command_mode == "OnTrack", 2)
        mover.move_on_track(track="track_two", position=150).wait()
        assert (mover.x, mover.y) == pytest.approx((390, 120), abs=1e-9)
        assert mover.part == 2
        assert two.position_at(150).x == pytest.approx(390, abs=1e-9)
        assert two.arc_length_closest_to(400, 0) == pytest.approx(160, abs=1e-6)


def test_network_on_moving_parts() -> None:
    """PL-33, PL-50, example 6.2.11: tracks two and three are equally long, and are linked as part two is."""
    with Engine(NETWORK) as engine:
        one, two, three = (engine.track(f"track_{name}") for name in ("one", "two", "three"))

        def line(track: takt.Track, part: str, *ends: float) -> None:
            names = ("start_x", "start_y", "end_x", "end_y")
            track.append_line(**dict(zip(names, ends, strict=True)), reference=part)

        line(three, "part_two", 0, 360, 80, 360)
        line(three, "part_two", 120, 320, 120, 160)
        line(three, "part_two", 80, 120, 0, 120)
        two.start_from_track(track="track_three", this_position_index=1, other_position_index=2)
        line(two, "part_one", 440, 600, 400, 600)
        line(two, "part_one", 360, 560, 360, 400)
        line(two, "part_one", 400, 360, 440, 360)
        two.end_at_track(track="track_three", this_position_index=1, other_position_index=1)
        one.start_from_track(track="track_three", this_position_index=1, other_position_index=1)
        line(one, "part_one", 440, 120, 160, 120)
        line(one, "part_one", 120, 160, 120, 800)
        line(one, "part_one", 160, 840, 440, 840)
        one.end_at_track(track="track_three", this_position_index=1, other_position_index=2).wait()
        assert two.length == pytest.approx(three.length, abs=1e-9)
        assert (two.subsequent, three.subsequent, one.subsequent) == ([three], [one], [])
        engine.part("part_two").activate_position(index=2).wait()
        assert (two.subsequent, three.subsequent, one.subsequent) == ([], [two], [three])


def lift(session: takt.Session) -> None:
    """The manual's program 6.6.1, by states."""
    mover, three = enabled(session), session.part("three")
    three.activate_position(index=1)
    session.wait(lambda: three.position_index == 1, 1)
    mover.move_to_position(x=120, y=120, reference="three")
    session.wait(lambda: mover.y > 300 and not mover.busy_xyc, 5)
    assert mover.coordinate_system == 1
    three.activate_position(index=2)
    session.wait(lambda: three.position_index == 2, 1)
    assert mover.coordinate_system == 2
    mover.move_to_position(x=120, y=120, reference="two").wait()
    assert (mover.x, mover.y) == (pytest.approx(120, abs=1e-9), pytest.approx(120, abs=1e-9))
    assert (mover.coordinate_system, mover.part) == (2, 2)


def test_lift() -> None:
    """PL-32, PL-50, example 6.6.1."""
    with Engine(LIFT) as engine:
        lift(engine)
        assert [engine.part(name).state for name in ("one", "two", "three")] == ["Disabled", "Enabled", "Enabled"]


def test_a_reference_that_is_needed() -> None:
    """PL-50: a place without one is refused with the names that there are."""
    needed = "reference: expected the name of a part or a coordinate system, needed where there are several coordinate"
    there = r"systems or parts that move \(there are one, two, three, lower, upper\) \(error 3070\)"
    with Engine(LIFT) as engine:
        mover = enabled(engine)
        for given in (mover.move_to_position(x=120, y=200), mover.set_position(x=120, y=200)):
            with pytest.raises(takt.CommandError, match=f"{needed} {there}"):
                given.wait()


def test_lift_over_lcm(tmp_path: Path) -> None:
    """PL-50, example 6.6.1 against taktd."""
    url = new_url()
    with running(tmp_path, url, machine=LIFT), takt.connect(url) as session:
        lift(session)


def test_who_is_in_the_way() -> None:
    """A part does not go while a mover stands across its border."""
    with Engine(LIFT) as engine:
        mover, three = enabled(engine), engine.part("three")
        three.activate_position(index=1).wait()
        mover.move_to_position(x=120, y=240, reference="lower").wait()
        refused = three.activate_position(index=2)
        with pytest.raises(takt.CommandError, match="a mover is in the way of the part"):
            refused.wait()
        assert refused.object is mover
        assert three.position_index == 1
        three.force_disable()
        engine.run(0.1)
        assert (mover.state, three.state, three.disable_forced) == ("Error", "Disabled", True)


def test_beside_its_track_a_mover_stays_on_the_stators() -> None:
    """PL-13, PL-32: PL-80: set points take it off its place on the track, but no part of it off the stators."""
    engine = Engine(
        TWO_PARTS.replace("part: left}", "part: left, elements: [{from: {x: 60, y: 120}, to: {x: 180, y: 120}}]}")
    )
    mover = enabled(engine)
    engine.track("track_one").enable().wait()
    mover.join_track(track="track_one").wait()
    feedback = mover.start_external_setpoint_generation(mode="relative")
    furthest = 0.0
    for k in range(1500):
        t = 0.001 * k
        mover.set_external_setpoint(
            y=90 * (1 - np.cos(2 * t)), velocity_y=180 * np.sin(2 * t), acceleration_y=360 * np.cos(2 * t)
        )
        engine.step()
        furthest = max(furthest, mover.y)
    assert (feedback.error, feedback.error_id) == (True, 3071)
    assert 240 - 56.5 - 10 < furthest <= 240 - 56.5
    engine.run(1)
    assert (mover.x, mover.y, mover.part) == (120, 120, 1)
