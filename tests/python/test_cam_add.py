"""Superposition of cams on one slave, and ExecutionMode of MC_CamTableSelect (CAM-90)."""

import numpy as np
import pytest
import takt
from takt import cam, expect
from takt import plcopen as plc

MACHINE = """
name: needle
axes:
  - {name: main, unit: deg, kind: rotary, limits: {velocity: 720, acceleration: 7200, jerk: 144000}}
  - {name: bar, unit: mm, limits: {velocity: 4000, acceleration: 400000, jerk: 80000000}}
cams:
  - name: stitch
    cyclic: true
    segments: [{to: {x: 170, y: 24}, law: modified_sine}, {to: {x: 360, y: 0}, law: modified_sine}]
  - {name: wobble, cyclic: true, segments: [{to: {x: 45, y: 1.5}, law: cycloid}, {to: {x: 90, y: 0}, law: cycloid}]}
  - {name: once, segments: [{to: {x: 200, y: 6}, law: polynomial_345}]}
  - {name: a, cyclic: true, segments: [{to: {x: 360, y: 2}, law: line}]}
"""


@pytest.fixture
def session():
    with takt.Engine(MACHINE, journal=True) as engine:
        engine.axis("main").power().wait()
        engine.axis("bar").power().wait()
        yield engine


def follow(session, velocity=180.0):
    main, bar = session.axis("main"), session.axis("bar")
    bar.cam_in(master="main", cam="stitch").wait(until="active")
    main.move_velocity(velocity=abs(velocity), direction="negative" if velocity < 0 else "positive").wait(
        until="reached"
    )
    session.run(0.1)
    return main, bar


@pytest.mark.parametrize("velocity", [180.0, -240.0])
def test_the_slave_follows_the_sum(session, velocity):  # CAM-90
    _, bar = follow(session, velocity)
    record = session.record()
    bar.cam_add(cam="wobble", master_scaling=2.0, slave_scaling=-1.5, slave_absolute=True).wait()
    bar.cam_add(cam="a", slave_absolute=True, slave_offset=3.25, periodic=False).wait()
    session.run(2.5)
    recording = record.stop()
    x, y = recording["main"]["set_position"], recording["bar"]["set_position"]
    stitch, wobble, line = (session.cam(name) for name in ("stitch", "wobble", "a"))
    wanted = stitch.at(x).y - 1.5 * wobble.at((2 * x) % 90).y
    later = slice(600, None)
    # The third part goes on over all turns: it is 2 mm per turn, once.
    rest = (y - wanted)[later] - 3.25
    turns = np.unwrap(x, period=360.0)[later]
    inside = (turns >= 0) & (turns <= 360)
    assert np.abs(rest[inside] - line.at(turns[inside]).y).max(initial=0) < 1e-6
    assert bar.in_step
    expect.within_limits(recording, "bar")
    expect.continuous(recording, "bar")


def test_what_is_added_relatively_makes_no_step_and_what_is_removed_is_caught_up_with(session):  # CAM-90
    main, bar = follow(session)
    session.wait(lambda: 100 < main.set_position < 110, 5.0)
    record = session.record()
    before = bar.set_position - session.cam("stitch").at(main.set_position).y
    assert before == pytest.approx(0, abs=1e-6)
    bar.cam_add(cam="once", master_absolute=False).wait()
    session.step(2)
    assert abs(bar.set_position - session.cam("stitch").at(main.set_position).y) < 1e-3
    session.run(1.5)
    assert bar.set_position - session.cam("stitch").at(main.set_position).y == pytest.approx(6, abs=1e-6)
    bar.cam_remove(cam="once").wait()
    session.run(0.5)
    assert bar.set_position == pytest.approx(session.cam("stitch").at(main.set_position).y, abs=1e-6)
    expect.within_limits(record.stop(), "bar")


def test_cams_made_at_run_time_are_superimposed_and_kept(session):  # CAM-88, CAM-90
    main, bar = follow(session)
    session.make_cam(cam.Table.from_points([0, 180, 360], [0, 0.5, 0], name="extra", cyclic=True)).wait()
    bar.cam_add(cam="extra", slave_absolute=True).wait()
    old = session.cam("extra")
    for number in range(70):
        table = cam.Table.from_points([0, 180, 360], [0, number, 0], name="extra", cyclic=True)
        session.make_cam(table).wait()
    session.run(0.3)
    wanted = session.cam("stitch").at(main.set_position).y + old.at(main.set_position).y
    assert bar.set_position == pytest.approx(wanted, abs=1e-6)


def test_what_cannot_be_is_refused(session):  # CAM-90
    bar = session.axis("bar")
    assert bar.cam_add(cam="wobble").wait_final().error_id == 3005  # it follows no cam
    follow(session)
    assert "the machine has no cam 'wabble'" in bar.cam_add(cam="wabble").wait_final().sentence
    assert "master_scaling" in bar.cam_add(cam="wobble", master_scaling=0.0).wait_final().sentence
    for name in ("wobble", "once", "a"):
        bar.cam_add(cam=name).wait()
    bar.cam_add(cam="once", slave_scaling=2.0).wait()  # again: takes the place of its own
    session.make_cam({"name": "fourth", "segments": [{"to": {"x": 10, "y": 1}}]}).wait()
    assert bar.cam_add(cam="fourth").wait_final().error_id == 3003
    assert bar.cam_remove(cam="fourth").wait_final().error_id == 3005
    bar.cam_out().wait()
    bar.halt().wait()
    session.axis("main").halt().wait()
    bar.cam_in(master="main", cam="stitch").wait(until="active")
    assert bar.cam_remove(cam="wobble").wait_final().error_id == 3005  # it ended with its coupling


def call(session, block, seconds, **inputs):
    for _ in range(round(seconds / session.period)):
        block(**inputs)
        session.step()
    return block


def test_blocks(session):  # CAM-90
    _, bar = follow(session)
    add = call(session, plc.MC_CamAdd(bar, CamTableID="wobble", MasterScaling=2.0), 0.01, Execute=True)
    assert (add.Done, add.Error) == (True, False)
    remove = call(session, plc.MC_CamRemove(bar, CamTableID="wobble"), 0.01, Execute=True)
    assert (remove.Done, remove.Error) == (True, False)
    again = call(session, plc.MC_CamRemove(bar, CamTableID="wobble"), 0.01, Execute=True)
    assert (again.Error, again.ErrorID) == (True, 3005)


def test_a_table_is_selected_in_its_turn(session):  # CAM-90: ExecutionMode
    bar = session.axis("bar")
    bar.move_absolute(position=30, velocity=60).wait(until="active")
    bar.move_absolute(position=60, velocity=60, buffer_mode="buffered")
    blocks = {
        mode: plc.MC_CamTableSelect(bar, CamTable="stitch", ExecutionMode=mode)
        for mode in ("immediately", "delayed", "queued")
    }
    done = {}
    for _ in range(2000):
        for mode, block in blocks.items():
            block(Execute=True)
            if block.Done and mode not in done:
                done[mode] = bar.set_position
            assert block.Busy != block.Done
            assert (block.CamTableID is not None) == block.Done
        session.step()
        if len(done) == 3:
            break
    assert done["immediately"] < 1
    assert done["delayed"] == pytest.approx(30, abs=0.5)
    assert done["queued"] == pytest.approx(60, abs=0.5)
    # Behind a cam that runs over and over: at its end.
    follow(session)
    block, ends = plc.MC_CamTableSelect(bar, CamTable="a", ExecutionMode="queued"), bar.profile_ends
    for _ in range(3000):
        block(Execute=True)
        if block.Done:
            break
        session.step()
    assert block.Done
    assert bar.profile_ends == ends + 1


@pytest.mark.parametrize("change", ["none", "added", "added and removed"])
def test_cams_added_on_the_way_into_step(change: str) -> None:
    """AX-48: in step where it was promised, and without a step of the slave."""
    gentle = MACHINE.replace(
        "velocity: 4000, acceleration: 400000, jerk: 80000000", "velocity: 400, acceleration: 4000, jerk: 80000"
    )
    assert gentle != MACHINE
    hump = "[{to: {x: 180, y: 20}, law: modified_sine}, {to: {x: 360, y: 0}, law: modified_sine}]"
    with takt.Engine(f"{gentle}  - {{name: hump, cyclic: true, segments: {hump}}}\n") as engine:
        main, bar = engine.axis("main"), engine.axis("bar")
        main.power().wait()
        bar.power().wait()
        main.move_velocity(velocity=90).wait(until="reached")
        bar.cam_in(master="main", cam="stitch", master_start_distance=120, master_sync_position=300)
        record = engine.record()
        engine.wait(lambda: 230 < main.set_position < 232, 9)
        if change != "none":
            bar.cam_add(cam="hump").wait()
        if change == "added and removed":
            engine.run(0.1)
            bar.cam_remove(cam="hump").wait()
        engine.wait(lambda: bar.in_step, 9)
        assert main.set_position == pytest.approx(300, abs=0.2)
        assert abs(record.stop()["bar"]["set_acceleration"]).max() < 300
