"""Cams from machine and product data (CAM-91)."""

import json
import math
import re

import numpy as np
import pytest
import takt
from takt import expect
from takt.cam_makers import FlyingSaw, Limits, RotaryKnife, WinderTraverse

LIMITS = Limits(velocity=3000, acceleration=150_000, jerk=20_000_000)
KNIFE = RotaryKnife(circumference=480, cut_zone=15, limits=LIMITS)


@pytest.mark.parametrize("length", [411.25, 437.5, 480.0, 512.0, 733.3])
def test_knife_runs_with_the_web_where_it_cuts_and_keeps_its_limits(length):  # CAM-91
    speed = min(1000.0, KNIFE.highest_speed(length))
    table = KNIFE.cam(length, speed=speed)
    assert (table.begin, table.end, table.stroke, table.cyclic) == (0, length, 360, True)
    cutting = table.at(np.concatenate([np.linspace(0, 15, 50), np.linspace(length - 15, length, 50)]))
    assert np.allclose(cutting.dy, 360 / 480, rtol=1e-9)
    dense = table.at(np.linspace(0, length, 100_001))
    assert np.abs(dense.dy).max() * speed <= 3000 * (1 + 1e-9)
    assert np.abs(dense.ddy).max() * speed**2 <= 150_000 * (1 + 1e-9)
    assert np.abs(dense.dddy).max() * speed**3 <= 20_000_000 * (1 + 1e-9)
    assert dense.dy.min() >= -1e-9


def test_at_the_synchronous_length_the_knife_runs_evenly():  # CAM-91
    knife = RotaryKnife(circumference=600, blades=3, cut_zone=10)
    values = knife.cam(200, speed=2000).at(np.linspace(0, 200, 1000))
    assert np.allclose(values.dy, 0.6, rtol=1e-9)
    assert np.abs(values.ddy).max() < 1e-9


@pytest.mark.parametrize(("length", "speed"), [(300.0, 2000.0), (250.0, 1500.0), (120.0, 900.0)])
def test_what_is_impossible_is_told_with_what_would_do(length, speed):  # CAM-91
    with pytest.raises(takt.ConfigError, match=r"its limit is \d+; up to .* would do") as error:
        KNIFE.cam(length, speed=speed)
    slower = float(re.search(r"up to ([\d.]+) mm/s it", str(error.value))[1])
    longer = float(re.search(r"at least ([\d.]+) mm", str(error.value))[1])
    KNIFE.cam(length, speed=slower * (1 - 1e-5))
    KNIFE.cam(longer * (1 + 1e-5), speed=speed)
    with pytest.raises(takt.ConfigError):
        KNIFE.cam(length, speed=slower * (1 + 1e-4))


def test_a_knife_that_may_not_turn_back_says_so():  # CAM-91
    with pytest.raises(takt.ConfigError, match=r"turn back between two cuts; at most ([\d.]+) mm") as error:
        KNIFE.cam(3000, speed=100)
    longest = float(re.search(r"at most ([\d.]+) mm", str(error.value))[1])
    KNIFE.cam(longest * (1 - 1e-5), speed=100)
    RotaryKnife(circumference=480, cut_zone=15, limits=LIMITS, may_reverse=True).cam(2000, speed=100)


@pytest.mark.parametrize("weak", [Limits(velocity=100), Limits(velocity=600)])
def test_what_no_speed_mends_comes_before_the_limits(weak):
    """CAM-91: a knife that would turn back is told so whatever its limits, without a speed of 0 as remedy."""
    knife = RotaryKnife(circumference=500, cut_zone=20, limits=weak)
    with pytest.raises(takt.ConfigError, match="the knife would turn back between two cuts; at") as error:
        knife.cam(1200, speed=1000)
    assert "up to" not in str(error.value)
    assert str(error.value).endswith("at 1000 mm/s no length would do")
    assert knife.highest_speed(1200) == 0


def test_a_knife_that_may_turn_back_stays_out_of_the_cut_zone_between_two_cuts():  # CAM-91
    knife = RotaryKnife(circumference=500, cut_zone=20, limits=LIMITS, may_reverse=True)
    with pytest.raises(
        takt.ConfigError, match=r"back into the cut zone between two cuts; at most ([\d.]+) mm"
    ) as error:
        knife.cam(3000, speed=500)
    assert knife.highest_speed(3000) == 0
    longest = float(re.search(r"at most ([\d.]+) mm", str(error.value))[1]) * (1 - 1e-5)
    table = knife.cam(longest, speed=500)
    assert table.extremes().dy.least.value < 0  # it does turn back
    y = table.at(np.linspace(20, longest - 20, 100_001)).y
    assert y.min() > 14.4 - 1e-6
    assert y.max() < 360 - 14.4 + 1e-6


def test_makers_without_limits_and_with_impossible_lengths():  # CAM-91
    saw = FlyingSaw(travel=900, ride=300)
    assert saw.run_up(1200) == 300  # no limit asks for less
    for wrong in (math.nan, 100):
        with pytest.raises(takt.ConfigError, match="length: expected a number of mm above 300, found"):
            saw.run_up(wrong)
    with pytest.raises(takt.ConfigError, match="length: expected more than 30 mm, twice the cut zone, found 10"):
        KNIFE.highest_speed(10)
    with pytest.raises(takt.ConfigError, match="width: expected"):
        WinderTraverse(pitch=10, reversal=90).highest_speed(0.1)
    with pytest.raises(takt.ConfigError, match="circumference: expected a number of mm above 0, found 'long'"):
        RotaryKnife(circumference="long")


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        ({"circumference": 0}, "circumference: expected a number of mm above 0, found 0"),
        ({"circumference": math.nan}, "circumference: "),
        ({"circumference": 400, "blades": 0}, "blades: expected a whole number from 1 on, found 0"),
        ({"circumference": 400, "cut_zone": 200}, "cut_zone: expected less than 200 mm"),
        ({"circumference": 400, "limits": Limits(velocity=-1)}, "limits.velocity: expected a number above 0, found -1"),
    ],
)
def test_impossible_machines_are_refused(arguments, what):  # CAM-91
    with pytest.raises(takt.ConfigError, match=re.escape(what)):
        RotaryKnife(**arguments)


@pytest.mark.parametrize(("length", "speed"), [(30.0, 100.0), (math.inf, 100.0), (400.0, 0.0), (400.0, math.nan)])
def test_impossible_products_are_refused(length, speed):  # CAM-91
    with pytest.raises(takt.ConfigError, match="expected"):
        KNIFE.cam(length, speed=speed)


MACHINE = """
name: knife
axes:
  - {name: web, unit: mm, limits: {velocity: 1500, acceleration: 4000, jerk: 40000}}
  - {name: knife, unit: deg, kind: rotary, limits: {velocity: 3000, acceleration: 150000, jerk: 20000000}}
cams:
"""
MODULE = """flex_cams:
  - name: cutter
    slave: knife
    master: web
    cams: [first, second]
    settings: {slave_absolute: true, sync_mode: ramp_pos, master_sync_in_distance: 400, master_sync_in_position: 960}
"""


@pytest.mark.parametrize("length", [437.5, 533.25])
def test_lengths_are_cut_and_changed_while_the_web_runs(length):  # CAM-91
    speed = 700.0
    cams = [KNIFE.cam(480, speed=speed, name="first"), KNIFE.cam(length, speed=speed, name="second")]
    text = MACHINE + "".join(f"  - {json.dumps(one.source)}\n" for one in cams) + MODULE
    with takt.Engine(text) as session:
        web, cutter = session.axis("web"), session.flex_cam("cutter")
        web.power().wait()
        cutter.control(regulator_on=True)
        session.wait(lambda: cutter.axis_enabled)
        web.move_velocity(velocity=speed)
        cutter.control(sync_cam=True).wait()
        recorder = session.record()
        session.run(3)
        cutter.control(cam_table=2).wait()
        session.run(4)
        recording = recorder.stop()
    place = recording["web"]["true_position"]
    turns = np.unwrap(recording["knife"]["true_position"], period=360) / 360
    cuts = np.flatnonzero(np.diff(np.floor(turns)) > 0)
    share = (np.ceil(turns[cuts]) - turns[cuts]) / (turns[cuts + 1] - turns[cuts])
    lengths = np.diff(place[cuts] + share * (place[cuts + 1] - place[cuts]))
    changed = int(np.argmax(np.abs(lengths - 480) > 1))
    assert changed > 1
    assert np.abs(lengths[:changed] - 480).max() < 1e-6
    assert len(lengths) > changed + 2
    assert np.abs(lengths[changed:] - length).max() < 1e-6
    ratio = recording["knife"]["set_velocity"][cuts + 1] / recording["web"]["set_velocity"][cuts + 1]
    assert np.allclose(ratio, 360 / 480, rtol=1e-6)
    expect.within_limits(recording, "knife")


# --- the flying saw ---

SAW = FlyingSaw(travel=420, ride=150, limits=Limits(velocity=2500, acceleration=35_000, jerk=2_500_000))


@pytest.mark.parametrize("length", [391.25, 437.5, 620.0, 1400.0])
def test_a_saw_rides_with_the_web_and_keeps_its_limits(length):  # CAM-91
    speed = SAW.highest_speed(length) * (1 - 1e-9)
    table = SAW.cam(length, speed=speed)
    assert (table.begin, table.end, table.stroke, table.cyclic) == (0, length, 0, True)
    up = SAW.run_up(length)
    rides = table.at(np.linspace(up, up + 150, 100))
    assert np.allclose(rides.dy, 1, rtol=1e-9)
    dense = table.at(np.linspace(0, length, 100_001))
    assert (dense.y.min(), dense.y.max()) == (pytest.approx(0, abs=1e-9), pytest.approx(up + 150))
    assert up + 150 <= 420 + 1e-9
    for values, limit, power in ((dense.dy, 2500, 1), (dense.ddy, 35_000, 2), (dense.dddy, 2_500_000, 3)):
        assert np.abs(values).max() * speed**power <= limit * (1 + 1e-6)
    # No other run-up lets the web run faster.
    for share in (0.8, 0.95, 1.05, 1.2):
        assert SAW._highest(length, min(share * up, 420 - 150)) <= speed * (1 + 1e-6)


def test_a_saw_that_cannot_follow_says_what_would_do():  # CAM-91
    with pytest.raises(takt.ConfigError, match=r"carriage's .* its limit is \S+; up to \S+ mm/s it would do") as error:
        SAW.cam(391.25, speed=1500)
    slower = float(re.search(r"up to ([\d.]+) mm/s it", str(error.value))[1])
    longer = float(re.search(r"at least ([\d.]+) mm", str(error.value))[1])
    SAW.cam(391.25, speed=slower * (1 - 1e-5))
    SAW.cam(longer * (1 + 1e-4), speed=1500)


# --- the traverse of a winder ---


@pytest.mark.parametrize("dwell", [0.0, 45.0])
@pytest.mark.parametrize(("width", "pitch", "reversal"), [(82.5, 3.2, 120.0), (40.0, 0.31, 90.0)])
def test_a_traverse_lays_evenly_from_edge_to_edge(width, pitch, reversal, dwell):  # CAM-91
    guide = WinderTraverse(pitch=pitch, reversal=reversal, dwell=dwell, limits=Limits(velocity=500, acceleration=3000))
    speed = min(guide.highest_speed(width), 7200.0) * (1 - 1e-9)
    table = guide.cam(width, speed=speed)
    dense = table.at(np.linspace(0, table.end, 200_001))
    assert (dense.y.min(), dense.y.max()) == (pytest.approx(0, abs=1e-9), pytest.approx(width))
    assert np.abs(dense.dy).max() == pytest.approx(pitch / 360)
    even = np.isclose(np.abs(dense.dy), pitch / 360, rtol=1e-9).mean() * table.end
    assert table.end - even == pytest.approx(2 * (reversal + dwell), rel=1e-2)
    assert np.isclose(dense.dy, 0, atol=1e-12).mean() * table.end == pytest.approx(2 * dwell, abs=2.0)
    assert np.abs(np.diff(dense.ddy)).max() < 0.25 * np.abs(dense.ddy).max()  # no jump of acceleration
    if not dwell:  # u - 2 u³ + u⁴ has its largest second derivative, 3, at the edge
        assert np.abs(dense.ddy).max() == pytest.approx(3 * pitch / 360 / reversal)
    half = len(dense.y) // 2
    assert np.allclose(
        dense.y[: half + 1], width - dense.y[half:], atol=1e-9
    )  # the second layer is the first, mirrored


@pytest.mark.parametrize(
    ("make", "what"),
    [
        (lambda: FlyingSaw(travel=100, ride=100), "ride: expected less than 100 mm, the travel, found 100"),
        (lambda: FlyingSaw(travel=math.inf, ride=10), "travel: expected a number of mm above 0, found inf"),
        (lambda: SAW.cam(150, speed=100), "length: expected a number of mm above 150, found 150"),
        (lambda: SAW.cam(500, speed=-1), "speed: expected a number of mm/s above 0, found -1"),
        (lambda: WinderTraverse(pitch=0, reversal=10), "pitch: expected a number of mm above 0, found 0"),
        (lambda: WinderTraverse(pitch=1, reversal=10, dwell=-1), "dwell: expected a number of deg from 0 on, found -1"),
        (lambda: WinderTraverse(pitch=36, reversal=180).cam(5, speed=1), "width: expected a number of mm above 11.25"),
    ],
)
def test_impossible_saws_and_winders_are_refused(make, what):  # CAM-91
    with pytest.raises(takt.ConfigError, match=re.escape(what)):
        make()
