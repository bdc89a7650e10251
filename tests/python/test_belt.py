"""Belts, what lies on them, and poses from elsewhere, as scenarios see them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running

MACHINE = """
name: cell
axes:
  - {name: drive, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
  - {name: disc, unit: deg, kind: rotary, limits: {velocity: 720, acceleration: 7200, jerk: 720000}}
belts:
  - {name: infeed, axis: drive, origin: {x: 100, c: 90}, lower_limit: 0, upper_limit: 300}
  - {name: table, kind: turning, axis: disc, source: actual_value, filter_s: 0.01}
poses:
  - {name: mover, goes_on_s: 0.05}
"""


@pytest.fixture
def engine() -> takt.Engine:
    engine = takt.Engine(MACHINE)
    for axis in engine.axes.values():
        axis.power().wait()
    return engine


def test_a_session_has_belts_and_poses(engine: takt.Engine) -> None:
    """CV-01, CV-42."""
    assert list(engine.belts) == ["infeed", "table"]
    assert list(engine.poses) == ["mover"]
    assert engine.belt("infeed").axis is engine.axis("drive")
    with pytest.raises(takt.TaktError, match="did you mean 'infeed'"):
        engine.belt("infed")
    assert "infeed" in repr(engine.belt("infeed"))
    assert "mover" in repr(engine.pose("mover"))


def test_a_late_pose_is_made_good(engine: takt.Engine) -> None:
    """CV-02, CV-03, PP-40: against the closed form, in the world."""
    belt = engine.belt("infeed")
    belt.axis.move_velocity(velocity=200).wait(until="reached")
    seen = belt.detect(kind=4)
    number = int(seen.wait().value)
    assert seen.travel_time_s == 0
    latch = belt.position - belt.velocity * engine.period * (engine.cycle - seen.cycle)
    (thing,) = belt.objects
    assert (thing.number, thing.state, thing.kind, thing.in_range) == (number, "detected", 4, False)
    assert math.isnan(thing.place)
    engine.run(0.3)
    belt.locate(number=number, x=20, y=5, c=10, colour=2).wait()
    (thing,) = belt.objects
    way = belt.position - latch
    assert way > 60
    assert thing.place == pytest.approx(20 + way, abs=1e-9)
    assert thing.pose == pytest.approx((100 - 5, 20 + way, 0, 0, 0, 100), abs=1e-9)
    assert (thing.state, thing.kind, thing.colour, thing.in_range) == ("visible", 4, 2, True)
    assert belt.first_number == number
    assert belt.first_pose == pytest.approx(thing.pose)
    assert belt.first_time_left == pytest.approx((300 - thing.place) / 200)
    engine.wait(lambda: belt.object_count == 0, 5)
    assert belt.lost_count == 1
    assert belt.objects == ()


def test_thirty_and_no_more(engine: takt.Engine) -> None:
    """PP-40."""
    belt = engine.belt("infeed")
    for number in range(1, 31):
        assert belt.detect(x=number).wait().value == number
    before = belt.objects
    with pytest.raises(takt.CommandError) as refused:
        belt.detect(x=31).wait()
    assert refused.value.feedback.error_id == 17918
    assert belt.objects == before
    belt.take(number=7).wait()
    assert belt.objects[6].state == "taken"
    belt.clear().wait()
    with pytest.raises(takt.CommandError) as refused:
        belt.locate(x=1).wait()
    assert refused.value.feedback.error_id == 3032


def test_a_recording_has_the_travel_over_all_turns(engine: takt.Engine) -> None:
    """CV-01."""
    engine.axis("disc").move_velocity(velocity=720).wait(until="reached")
    with engine.record("table", "infeed") as recorder:
        engine.run(0.2)  # the filter has forgotten the start
        engine.run(2)
    recording = recorder.recording
    position = recording["table"]["position"]
    assert position[-1] - position[0] > 3.9 * 360
    assert np.allclose(np.diff(position[200:]), 0.72, atol=2e-3)
    assert recording.unit("table", "position") == "deg"
    assert recording.unit("table", "velocity") == "deg/s"
    assert recording.unit("infeed", "position") == "mm"


def test_a_pose_goes_on_until_it_is_old(engine: takt.Engine) -> None:
    """CV-42."""
    mover = engine.pose("mover")
    assert math.isnan(mover.pose[0])
    mover.set(x=10, y=20, c=5, vx=100, wz=-20).wait()
    assert mover.fresh
    assert mover.velocity == pytest.approx(100)
    engine.run(0.02)
    x, y, _, _, _, c = mover.pose
    assert x == pytest.approx(10 + 100 * mover.age_s)
    assert y == 20
    assert c == pytest.approx(5 - 20 * mover.age_s)
    engine.run(0.1)
    assert not mover.fresh
    assert mover.pose[0] == pytest.approx(15)
    assert mover.velocity == 0


def test_the_same_over_lcm(tmp_path: Path) -> None:
    """CV-02, CV-42, EN-20: a camera in another process."""
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        belt, mover = session.belt("infeed"), session.pose("mover")
        number = int(belt.detect().wait().value)
        belt.locate(number=number, x=20, y=5, kind=3).wait()
        mover.set(x=7).wait()
        session.wait(lambda: belt.first_number == number and len(belt.objects) == 1 and not math.isnan(mover.pose[0]))
        (thing,) = belt.objects
        assert (thing.number, thing.kind, thing.in_range) == (number, 3, True)
        session.wait(lambda: belt.objects[0].state == "visible")
        assert belt.objects[0].pose == pytest.approx((95, 20, 0, 0, 0, 90), abs=1e-9)
        assert belt.first_pose == pytest.approx(belt.objects[0].pose)
        assert mover.pose[0] == 7
