"""Cams made at run time (CAM-88), and their read-back (CAM-71)."""

import math
import re

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import cam, expect
from takt.replay import replay

MACHINE = """
name: press line
axes:
  - {name: drum, unit: deg, kind: rotary, limits: {velocity: 1800, acceleration: 9000, jerk: 90000}}
  - {name: ram, unit: mm, limits: {velocity: 4000, acceleration: 200000, jerk: 20000000}}
  - {name: gate, unit: mm, limits: {velocity: 4000, acceleration: 200000, jerk: 20000000}}
cams:
  - {name: flat, cyclic: true, segments: [{to: {x: 120, y: 12}, law: cycloid}, {to: {x: 360, y: 0}, law: cycloid}]}
flex_cams:
  - {name: stamp, slave: ram, master: drum, cams: [flat, flat], settings: {slave_absolute: true, sync_mode: ramp_time}}
"""


def hill(height, name="hill", count=181):
    x = np.linspace(0, 360, count)
    y = height * (1 - np.cos(np.radians(x))) / 2
    return cam.Table.from_points(x, y, name=name, cyclic=True, x_unit="deg", y_unit="mm")


def steps(height, name="steps"):
    up = {"to": {"x": 90, "y": height}, "law": "modified_sine"}
    return cam.Table.from_segments(
        [up, {"to": {"x": 200, "y": height}, "law": "dwell"}, {"to": {"x": 360, "y": 0}, "law": "polynomial_345"}],
        name=name,
        cyclic=True,
    )


@pytest.fixture
def session():
    with takt.Engine(MACHINE, journal=True) as engine:
        yield engine


def run_stamp(session, velocity=720.0):
    drum, stamp = session.axis("drum"), session.flex_cam("stamp")
    drum.power().wait()
    stamp.control(regulator_on=True).wait()
    session.wait(lambda: stamp.axis_enabled)
    drum.move_velocity(velocity=velocity)
    stamp.control(sync_cam=True).wait()
    return stamp


@pytest.mark.parametrize("table", [hill(37.5), steps(21.25), hill(5, count=4_001)], ids=["points", "segments", "many"])
def test_a_cam_is_made_while_another_runs_and_is_then_followed(session, table):  # CAM-88
    stamp = run_stamp(session)
    record = session.record()
    session.run(0.6)
    assert stamp.cam_number == 1
    stamp.load_cam(2, table).wait()
    assert stamp.cam_number == 1  # it was only built and put into a slot that does not run
    stamp.control(cam_table=2).wait()
    session.wait(lambda: stamp.cam_table == 2, 2.0)
    session.run(1.2)
    recording = record.stop()
    expect.within_limits(recording, "ram")
    module = recording["stamp"]
    runs = (module["cam_table"] == 2) & module["cam_synchronised"].astype(bool)
    assert runs.sum() > 1000
    assert np.abs(recording["ram"]["set_position"] - table.at(module["set_x_position"]).y)[runs].max() < 1e-9
    assert stamp.cam_number == 2  # behind the one of the machine file


def test_the_cam_in_force_is_read_back(session):  # CAM-71, CAM-88
    stamp = run_stamp(session)
    assert stamp.cam_in_force.source["segments"] == session.cam("flat").source["segments"]
    table = hill(20)
    stamp.load_cam(1, table).wait()  # the slot that runs
    assert stamp.cam_in_force.name == "flat"
    session.wait(lambda: stamp.cam_number == 2, 1.0)
    back = stamp.cam_in_force
    assert back.source == table.source
    assert back.extremes() == table.extremes()
    assert (stamp.set_scaling_master, stamp.set_scaling_slave, stamp.set_offset_slave) == (1, 1, 0)
    assert session.cam("hill").source == table.source
    with pytest.raises(takt.TaktError, match=r"there is no cam 'hil' \(there are flat, hill\)"):
        session.cam("hil")


def test_an_axis_follows_a_cam_made_at_run_time(session):  # CAM-88
    drum, gate = session.axis("drum"), session.axis("gate")
    drum.power().wait()
    gate.power().wait()
    table = steps(14.5, "gate cam")
    refused = gate.cam_in(master="drum", cam="gate cam").wait_final()
    assert (refused.error_id, refused.sentence) == (3010, "cam: the machine has no cam 'gate cam' (it has flat)")
    session.make_cam(table).wait()
    gate.cam_in(master="drum", cam="gate cam", master_sync_position=0.0).wait(until="active")
    drum.move_absolute(position=75, velocity=300).wait()
    session.run(0.2)
    assert gate.set_position == pytest.approx(table.at(75).y, abs=1e-9)


def test_an_axis_keeps_its_cam_when_the_name_gets_another_one(session):  # CAM-88
    drum, gate = session.axis("drum"), session.axis("gate")
    drum.power().wait()
    gate.power().wait()
    session.make_cam(hill(10, "swing")).wait()
    gate.cam_in(master="drum", cam="swing", periodic=True).wait(until="active")
    drum.move_velocity(velocity=360)
    for height in range(20, 220):  # more than there are places for
        session.make_cam(hill(height, "swing", count=5)).wait()
    record = session.record("gate", "drum")
    session.run(1.5)
    recording = record.stop()
    assert recording["gate"]["set_position"].max() == pytest.approx(10, abs=1e-3)
    expect.within_limits(recording, "gate")


def test_a_cam_of_the_most_points_is_made_without_a_pause_of_the_slave():  # CAM-88
    with takt.Engine(MACHINE) as session:
        stamp = run_stamp(session)
        record = session.record()
        table = hill(30, "fine", count=100_000)
        stamp.load_cam(2, table).wait()
        stamp.control(cam_table=2).wait()
        session.wait(lambda: stamp.cam_table == 2, 2.0)
        session.run(0.5)
        recording = record.stop()
        assert stamp.cam_in_force.points.x.size == 100_000
    expect.within_limits(recording, "ram")
    module = recording["stamp"]
    runs = module["cam_table"] == 2
    assert np.abs(recording["ram"]["set_position"] - table.at(module["set_x_position"]).y)[runs].max() < 1e-9


def test_cams_made_at_run_time_replay_bit_for_bit(session):  # CAM-88, EN-07
    stamp = run_stamp(session)
    stamp.load_cam(2, hill(25)).wait()
    stamp.control(cam_table=2).wait()
    session.run(0.3)
    session.command("machine", "begin_cam", {"name": "bad"}).wait()
    session.command("machine", "build_cam", {"cam": "bad"}).wait_final()
    stamp.load_cam(1, steps(8)).wait()
    stamp.control(cam_table=1).wait()
    session.run(1.0)
    cycles, hashes = session.take_hashes()
    again = takt._core.Engine(MACHINE.encode(), "machine", journal=True, checks=False)
    journal = session.take_journal()
    assert "cam_built" in {entry[4] for entry in journal}
    at = 0
    for cycle, ticket, lease, target, verb, arguments in journal:
        again.step(cycle - at)
        at = cycle
        assert again.resubmit(target, verb, arguments, ticket, lease)[1] == 0, (verb, arguments)
    again.step(len(cycles) - at)
    assert np.array_equal(again.take_hashes()[1], hashes)


POINT = {"x": 0.0, "y": 0.0}


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        ([], "cam 'odd': points: expected 2 to 100,000 points, found 0"),
        ([POINT], "cam 'odd': points: expected 2 to 100,000 points, found 1"),
        ([POINT, {"x": 0.0, "y": 1.0}], "cam 'odd': points[1].x: expected x above 0 of the point before, found 0"),
        ([POINT, {"x": 10.0, "y": 4.0}], "cam 'odd': points[1]"),  # cyclic, and the end is not the beginning
    ],
)
def test_what_is_wrong_with_a_cam_is_told_by_the_engine(session, points, sentence):  # CAM-88, for clients of any kind
    session.command("machine", "begin_cam", {"name": "odd", "cyclic": True, "interpolation": "linear"}).wait()
    if points:
        session.command("machine", "add_cam_points", {"cam": "odd", "points": points}).wait()
    built = session.command("machine", "build_cam", {"cam": "odd"}).wait_final()
    if len(points) == 2 and points[1]["x"]:
        assert built.done  # a stroke may remain
        return
    assert (built.error_id, built.sentence) == (3113, sentence)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_numbers_that_are_none_are_refused_before_anything_is_sent(session, value):  # CAM-88
    with pytest.raises(takt.ConfigError, match=r"segments\[0\].to.y: expected a finite number"):
        session.make_cam({"name": "bad", "segments": [{"to": {"x": 5, "y": value}}]})
    told = session.command("machine", "begin_cam", {"name": "bad"}).wait()
    told = session.command("machine", "add_cam_points", {"cam": "bad", "points": [{"x": 0, "y": value}]}).wait_final()
    assert told.error, told
    assert "points[0].y" in told.sentence
    refused = session.command("machine", "build_cam", {"cam": "bad"}).wait_final()
    assert refused.error_id == 3113


def test_no_more_points_than_a_cam_may_have(session):  # CAM-88
    with pytest.raises(takt.ConfigError, match="expected 2 to 100,000 points, found 100001"):
        cam.Table.from_points(np.arange(100_001), np.zeros(100_001))
    session.command("machine", "begin_cam", {"name": "long"}).wait()
    for first in range(0, 100_000, 20):
        points = [{"x": float(first + k), "y": 0.0} for k in range(20)]
        told = session.command("machine", "add_cam_points", {"cam": "long", "first": first, "points": points})
        if first % 2000 == 0:
            told.wait()
    told = session.command("machine", "add_cam_points", {"cam": "long", "points": [{"x": 1e6, "y": 0.0}]}).wait_final()
    assert (told.error_id, told.sentence) == (3113, "expected 2 to 100,000 points, found 100001")


@pytest.mark.parametrize(
    ("verb", "arguments", "sentence"),
    [
        ("add_cam_points", {"cam": "none", "points": [POINT]}, "expected a begin_cam of this name before"),
        ("build_cam", {"cam": "none"}, "expected a begin_cam of this name before"),
        ("drop_cam", {"cam": "flat"}, "expected the name of a cam made at run time"),
        (
            "add_cam_points",
            {"cam": "begun", "first": 7, "points": [POINT]},
            "first: expected 2, the number of points or segments sent before, found 7: a piece of the cam is missing "
            "or was sent twice",
        ),
        (
            "build_cam",
            {"cam": "begun", "count": 3},
            "count: expected 2, the number of points or segments that have come, found 3: a "
            "piece of the cam is missing",
        ),
        (
            "add_cam_segments",
            {"cam": "begun", "segments": [{"to": {"x": 1, "y": 1}}]},
            "expected points or segments, found both",
        ),
        ("add_cam_points", {"cam": "begun", "points": [POINT] * 21}, "points"),
        ("begin_cam", {"name": "x" * 41}, "name"),
    ],
)
def test_pieces_out_of_order_are_refused(session, verb, arguments, sentence):  # CAM-88
    session.command("machine", "begin_cam", {"name": "begun"}).wait()
    session.command("machine", "add_cam_points", {"cam": "begun", "points": [POINT, {"x": 1.0, "y": 2.0}]}).wait()
    told = session.command("machine", verb, arguments).wait_final()
    assert told.error
    assert sentence in told.sentence
    if verb.startswith("add") and arguments["cam"] == "begun" and len(arguments.get("points", "x")) < 21:
        built = session.command("machine", "build_cam", {"cam": "begun"}).wait_final()
        assert built.sentence == "a piece of the cam was refused; send the cam again from begin_cam on"


def test_cams_that_are_sent_do_not_disturb_one_that_is_built(session):  # CAM-88
    first, second = session.make_cam(hill(3, "one")), session.make_cam(steps(4, "two"))
    third = session.make_cam(hill(5, "one"))  # lets time pass until there is room
    third.wait()
    assert (first.done, second.done) == (True, True)
    assert session.cam("one").extremes().y.greatest.value == pytest.approx(5, abs=1e-6)


def test_a_third_cam_at_the_same_time_is_told_to_wait(session):  # CAM-88
    for name in ("a", "b"):
        session.command("machine", "begin_cam", {"name": name})
        session.command("machine", "add_cam_points", {"cam": name, "points": [POINT, {"x": 1.0, "y": 2.0}]})
        session.command("machine", "build_cam", {"cam": name})
    third = session.command("machine", "begin_cam", {"name": "c"}).wait_final()
    assert third.sentence == "two cams are being built; wait until one of them is done"


def test_places_for_cams_are_bounded_and_come_back(session):  # CAM-88
    for number in range(64):
        session.make_cam(hill(number + 1, f"cam {number}", count=3)).wait()
    full = session.make_cam(hill(1, "one more", count=3)).wait_final()
    assert full.sentence == "64 cams made at run time are in use; drop one with drop_cam first"
    session.drop_cam(cam="cam 17").wait()
    gone = session.flex_cam("stamp").set_cam(slot=1, cam="cam 17").wait_final()
    assert gone.error_id == 3010
    assert re.search("the machine has no cam 'cam 17'; did you mean", gone.sentence)
    session.make_cam(hill(1, "one more", count=3)).wait()


def test_a_cam_of_the_machine_file_is_hidden_and_comes_back(session):  # CAM-88
    stamp = session.flex_cam("stamp")
    stamp.load_cam(2, hill(6, "flat")).wait()
    assert session.cam("flat").extremes().y.greatest.value == pytest.approx(6, abs=1e-6)
    assert (stamp.ip08_cam_table1, stamp.ip09_cam_table2) == (1, 2)
    session.drop_cam(cam="flat").wait()
    assert session.cam("flat").extremes().y.greatest.value == pytest.approx(12)
    stamp.set_cam(slot=2, cam="flat").wait()
    assert stamp.ip09_cam_table2 == 1


def test_over_lcm_and_in_the_log_of_the_run(tmp_path):  # CAM-88, EN-07: real time, and replayed bit for bit
    url, log = new_url(), tmp_path / "run.lcm"
    with running(tmp_path, url, "--log", str(log), machine=MACHINE), takt.connect(url) as session:
        stamp = run_stamp(session)
        table = hill(33, count=3_001)
        stamp.load_cam(2, table).wait()
        stamp.control(cam_table=2).wait()
        session.wait(lambda: stamp.cam_number == 2, 3.0)
        assert stamp.cam_in_force.source == table.source
        assert session.cam("flat").extremes().y.greatest.value == pytest.approx(12)
        session.command("machine", "begin_cam", {"name": "odd"}).wait()
        session.command("machine", "add_cam_points", {"cam": "odd", "points": [POINT]}).wait()
        built = session.command("machine", "build_cam", {"cam": "odd"}).wait_final()
        assert built.sentence == "cam 'odd': points: expected 2 to 100,000 points, found 1"
        stamp.load_cam(3, hill(2, "flat")).wait()
        assert session.cam("flat").extremes().y.greatest.value == pytest.approx(2, abs=1e-6)
        session.drop_cam(cam="flat").wait()
        assert session.cam("flat").extremes().y.greatest.value == pytest.approx(12)
        unknown = stamp.set_cam(slot=3, cam="odd").wait_final()
        assert unknown.sentence == "cam: the machine has no cam 'odd' (it has flat, hill)"
    assert replay(log).same


def test_a_cam_sent_under_another_name(tmp_path):  # CAM-88: the client that made it reads what others read
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        session.make_cam(hill(33), name="other").wait()
        assert session.cam("other").name == "other"
        assert session.cam("other").source == {**hill(33).source, "name": "other"}
        with takt.connect(url) as another:
            assert another.cam("other").source == session.cam("other").source


@pytest.mark.parametrize("count", [61, 5_001])
def test_recordings_of_logs_have_cams_made_at_run_time(count, tmp_path):  # CAM-88, PY-20: as live ones have them
    url, own, heard = new_url(), tmp_path / "own.lcm", tmp_path / "heard.lcm"
    with (
        takt.write_log(heard, url),
        running(tmp_path, url, "--log", str(own), machine=MACHINE),
        takt.connect(url) as session,
    ):
        recorder = session.record()
        session.make_cam(hill(33, count=count), name="other").wait()
        for height in range(1, 21):
            session.make_cam(steps(height)).wait()
        live = recorder.stop().meta["made_cams"]
    assert [cam["name"] for _, cam in live] == ["other"] * (count <= 5_000) + ["steps"] * 20
    for file in (own, heard):
        assert takt.read_log(file).meta["made_cams"] == live


FROM_FILE = MACHINE.replace("flex_cams:", "  - {name: drawn, file: drawn.csv}\nflex_cams:")


def test_cams_of_others_are_read_back_over_lcm(tmp_path):  # CAM-88, CAM-92: made by another client, or in a file
    url = new_url()
    (tmp_path / "drawn.csv").write_text("x;y;v\n0;0;\n10,5;2,25;\n20;5;0,5\n")
    with running(tmp_path, url, machine=FROM_FILE), takt.connect(url) as session:
        stamp = run_stamp(session)
        table = hill(33, count=451)
        stamp.load_cam(1, table).wait()
        session.make_cam(steps(7)).wait()
        session.wait(lambda: stamp.cam_number == 3, 3.0)
        with takt.connect(url) as other:
            assert other.flex_cam("stamp").cam_in_force.source == table.source
            assert other.cam("hill").extremes() == table.extremes()
            assert other.cam("steps").source == steps(7).source
            drawn = other.cam("drawn")
            assert list(drawn.points.x) == [0, 10.5, 20]
            assert np.array_equal(drawn.points.v, [math.nan, math.nan, 0.5], equal_nan=True)
            session.make_cam(hill(2)).wait()  # the same name
            assert other.cam("hill").extremes().y.greatest.value == pytest.approx(2, abs=1e-6)
            with pytest.raises(takt.TaktError, match=r"there is no cam 'hil' \(there are flat, drawn\)"):
                other.cam("hil")
            with pytest.raises(takt.TaktError, match="the engine has no cam of number 99 any more"):
                other._cam(99)


def test_a_piece_that_is_lost_is_read_again(tmp_path, monkeypatch):  # CAM-88
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        table = hill(33, count=301)
        session.make_cam(table).wait()
        with takt.connect(url) as other:
            take, seen = other._cams.take, []

            def lossy(message):
                seen.append(message.first)
                if seen.count(message.first) > 1:
                    take(message)

            monkeypatch.setattr(other._cams, "take", lossy)
            monkeypatch.setattr("takt.remote_cams.WAIT_S", 0.05)
            assert other._cam(2).source == table.source
            assert set(seen) == {0, 100, 200, 300}
            monkeypatch.setattr(other._cams, "take", lambda message: None)
            with pytest.raises(takt.ConnectionError, match="asked 5 times for its piece from"):
                other._cam(2)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"number": 7}, "cam, number: expected the name or the number of a cam that the engine has"),
        ({"cam": "none"}, "cam, number: expected the name or the number of a cam that the engine has"),
        ({}, "cam, number: expected the name or the number of a cam that the engine has"),
        (
            {"cam": "flat", "first": 2},
            "first: expected less than 2, the number of points or segments of the cam, found 2",
        ),
        ({"number": 1, "first": 4_000_000_000}, "first: expected less than 2, the number of points or segments"),
    ],
)
def test_what_cannot_be_read_is_refused(session, arguments, sentence):  # CAM-88
    for _ in range(100):  # nobody takes the pieces here: what does not fit is lost, the answer stays the same
        assert session.command("machine", "read_cam", {"cam": "flat"}).wait().value == 2
    told = session.command("machine", "read_cam", arguments).wait_final()
    assert (told.error_id, told.sentence[: len(sentence)]) == (3113, sentence)


def test_impossible_cams_are_refused_before_anything_is_made(session):  # CAM-88
    stamp = session.flex_cam("stamp")
    for slot in (0, 5):
        with pytest.raises(takt.TaktError, match=f"slot: expected 1 to 4, found {slot}"):
            stamp.load_cam(slot, hill(10, name="flat"))
    assert session._made_cams.cams == []
    with pytest.raises(takt.ConfigError, match="name: expected"):
        session.make_cam(hill(10, name=""))


def test_nan_has_no_place_on_a_cam():  # CAM-71
    values = hill(10).at([90.0, math.nan])
    assert math.isfinite(values.y[0])
    assert math.isnan(values.y[1])
    assert math.isnan(values.dddy[1])
    assert math.isnan(hill(10).at(math.nan).y)
