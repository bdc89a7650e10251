"""Conveyor tracking as engineers use it: a portal over two belts, and one with a turning tool over a table."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import takt
from blocks import call, shown, until
from machines import new_url, running
from takt import expect
from takt import plcopen as plc

PCS = takt.CoordinateSystem.PCS
TRACK = takt.TrackState
MACHINE = """\
name: conveyors
cycle: {period_s: 0.001}
lcm: {axis_rate_hz: 1000}
axes:
  - {name: x, unit: mm, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: y, unit: mm, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: z, unit: mm, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: c, unit: deg, limits: {velocity: 720, acceleration: 7200, jerk: 360000}}
  - name: drive
    unit: mm
    limits: {velocity: 500, acceleration: 2000, jerk: 100000}
    encoder: {type: absolute_ssi, ssi_bits: 25, increments_per_unit: 10000}
  - {name: out, unit: mm, limits: {velocity: 500, acceleration: 2000, jerk: 100000}}
  - {name: disc, unit: deg, kind: rotary, limits: {velocity: 90, acceleration: 360, jerk: 7200}}
groups:
  - name: gantry
    axes: [x, y, z, c]
    kinematics: {gantry: {axes: [x, y, z, c]}}
    path: {velocity: 800, acceleration: 8000, jerk: 400000}
belts:
  - {name: infeed, axis: drive}
  - {name: outfeed, axis: out, origin: {x: 50, y: 150, c: 90}} # along Y
  - {name: table, kind: turning, axis: disc, origin: {y: 200}}
simulation:
  servos:
    - axis: drive
      mechanics: {start_position: 976}
      encoder: {type: absolute, ssi_bits: 25, increments_per_unit: 10000}
      switches: {touch_probe: {from: 977, to: 980}}
"""
GROUP_AXES = ("x", "y", "z", "c")
STATUS = ("GroupMoving", "GroupStandby", "SynchronizedMotion", "DiscreteMotion")


def ready(session: takt.Session) -> takt.Group:
    """All axes on, the group enabled."""
    gantry = session.group("gantry")
    for name in ("drive", "out", "disc"):
        session.axis(name).power().wait()
    gantry.power().wait()
    gantry.enable().wait()
    return gantry


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as made:
        ready(made)
        yield made


@pytest.fixture
def gantry(engine: takt.Engine) -> takt.Group:
    return engine.group("gantry")


def moving(engine: takt.Engine, axis: str, velocity: float) -> takt.Axis:
    """An axis at this speed."""
    drive = engine.axis(axis)
    drive.move_velocity(velocity=abs(velocity), direction="negative" if velocity < 0 else "positive").wait(
        until="reached"
    )
    return drive


def on_object(gantry: takt.Group) -> tuple[float, float, float]:
    return gantry.object_x, gantry.object_y, gantry.object_z


def keeps_limits(recording: takt.Recording) -> None:
    for axis in GROUP_AXES:
        assert expect.within_limits(recording, axis)
        assert expect.continuous(recording, axis)


def test_the_manuals_example(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-02, CV-10 to CV-12, CV-15, CV-20: the manual's Example 1, number for number, latched by a touch probe."""
    speed, begin, in_step = 2.0, 9.0, 12.0
    belt, drive = engine.belt("infeed"), engine.axis("drive")
    probe = plc.MC_TouchProbe(drive)
    drive.move_velocity(velocity=speed)
    until(engine, probe, lambda: probe.Done, Execute=True)
    assert probe.RecordedPosition == pytest.approx(977, abs=0.01)
    track = plc.MC_TrackConveyorBelt(gantry, ConveyorBelt=belt, RecordedPosition=probe.RecordedPosition)
    track(ConveyorBeltOrigin=[-10.5], StartDistance=begin, EndDistance=20.0)
    track(TrackOptions=plc.TrackOptions(SyncIn=plc.SyncDistances(ConveyorDistance=3.0, TCPDistance=1.5)))
    status = plc.MC_GroupReadStatus(gantry, Enable=True)

    def travel() -> float:
        return belt.position - probe.RecordedPosition

    track(Execute=True)
    engine.step()
    while travel() < begin:
        track()
        assert shown(status(), *STATUS) == ["GroupStandby"]
        assert gantry.track_state is TRACK.WAITING
        assert (track.Busy, track.Active, track.InSync, gantry.x) == (True, True, False, 0)
        engine.step()
    while travel() < in_step - 1e-9:
        track()
        assert shown(status(), *STATUS) == ["GroupMoving", "SynchronizedMotion"]
        assert gantry.track_state is TRACK.SYNCHRONIZING
        assert not track.InSync
        assert gantry.velocity <= speed * (1 + 1e-9)  # never faster than the belt
        engine.step()
    assert travel() == pytest.approx(in_step, abs=speed * engine.period)
    late = speed * engine.period  # it begins with the first cycle in which the belt has come so far
    assert gantry.x == pytest.approx(1.5 + travel() - in_step, abs=late)
    assert gantry.velocity == pytest.approx(speed, rel=1e-6)
    until(engine, track, lambda: track.InSync)
    assert travel() == pytest.approx(in_step, abs=4 * speed * engine.period)
    on = gantry.object_x
    assert on == pytest.approx(0, abs=late)
    while travel() < 20:
        assert track().InSync
        assert gantry.track_state is TRACK.IN_SYNC
        assert gantry.x == pytest.approx(-10.5 + travel() + on, abs=1e-9)
        engine.step()
    until(engine, track, lambda: track.Done)  # CV-14: the end distance
    assert not track.InSync
    assert (gantry.track_state, gantry.state) == (TRACK.NONE, takt.GroupState.GROUP_STANDBY)
    assert not track(Execute=False).Done


LATE = """\
name: late
axes:
  - {name: w, unit: mm, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: x, unit: mm, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: y, unit: mm, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: drive, unit: mm, limits: {velocity: 500, acceleration: 2000, jerk: 100000}}
  - {name: f, unit: mm, limits: {velocity: 500, acceleration: 2000, jerk: 100000}}
groups:
  - name: gantry
    axes: [x, y]
    kinematics: {gantry: {axes: [x, y]}}
    path: {velocity: 800, acceleration: 8000, jerk: 400000}
belts:
  - {name: infeed, axis: drive}
"""


def test_a_member_that_comes_later_moves_behind_its_belt() -> None:
    """EN-03, GR-02: the axis takes the place of another one in a group that rides on a belt."""
    with takt.Engine(LATE) as engine:
        gantry, drive = engine.group("gantry"), engine.axis("drive")
        gantry.set_dyn_coord_transform(pcs=1, carrier="infeed").wait()
        gantry.remove_axis(ident=1).wait()
        gantry.add_axis(axis="w", ident=1).wait()
        for component in (drive, gantry):
            component.power().wait()
        gantry.enable().wait()
        drive.move_velocity(velocity=200).wait(until="reached")
        gantry.move_linear_absolute(x=50, y=0, coordinate_system="pcs", pcs=1)
        engine.run(1.0)
        assert gantry.x - drive.set_position == pytest.approx(50, abs=1e-6)
        assert gantry.track_lag == pytest.approx(0, abs=1e-6)


def test_a_group_does_not_ride_on_a_member_that_comes_later() -> None:
    """EN-03, GR-02: 3018, and other couplings go on."""
    with takt.Engine(LATE) as engine:
        gantry = engine.group("gantry")
        gantry.remove_axis(ident=1).wait()
        gantry.set_dyn_coord_transform(pcs=1, carrier="infeed").wait()
        assert gantry.add_axis(axis="drive", ident=1).wait_final().error_id == 3018
        gantry.add_axis(axis="x", ident=1).wait()
        for name in ("w", "f"):
            engine.axis(name).power().wait()
        engine.axis("f").gear_in(master="w").wait(until="reached")


def test_refusals(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-10, CV-13: each has its own number and text."""
    track = plc.MC_TrackConveyorBelt(gantry, ConveyorBelt="infeed", StartDistance=9.0)
    assert (track(Execute=True, EndDistance=8.0).Error, track.ErrorID) == (True, 3027)
    options = plc.TrackOptions(SyncIn=plc.SyncDistances(3.0, 1.5))
    track(Execute=False)
    assert track(Execute=True, EndDistance=11.0, TrackOptions=options).ErrorID == 3028
    track(Execute=False)
    moving(engine, "drive", -20)
    track(Execute=True, EndDistance=60.0)
    until(engine, track, lambda: track.Error)
    assert track.ErrorID == 3029
    track(Execute=False)
    table = plc.MC_TrackRotaryTable(gantry, RotaryTable="infeed")
    assert table(Execute=True).ErrorID == 5
    sentence = gantry.track_conveyor_belt(belt="infeed", start_distance=9, end_distance=8).sentence
    assert sentence == "end_distance: expected at least 9 mm, start_distance"


def test_waits_for_moves(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-10: the execution mode."""
    moving(engine, "drive", 50)
    track = plc.MC_TrackConveyorBelt(gantry, ConveyorBelt="infeed", ExecutionMode=takt.ExecutionMode.QUEUED)
    first = gantry.move_linear_absolute(x=20)
    second = gantry.move_linear_absolute(x=40, y=5, buffer_mode="buffered")
    track(Execute=True)
    while not second.done:
        track()
        assert (track.Busy, track.Active) == (True, False)
        engine.step()
    assert first.done
    until(engine, track, lambda: track.InSync)
    assert track.Active


def test_picks_and_places(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-11, CV-14, CV-21, CV-23: from one belt to another without a stop; moves run on top."""
    moving(engine, "drive", 150)
    moving(engine, "out", 100)
    infeed, outfeed = engine.belt("infeed"), engine.belt("outfeed")
    status = plc.MC_GroupReadStatus(gantry, Enable=True)
    with engine.record() as recorder:
        track = plc.MC_TrackConveyorBelt(gantry, ConveyorBelt=infeed, InitialObjectPosition={"y": 20.0, "z": -60.0})
        until(engine, track, lambda: track.InSync, Execute=True)
        assert shown(status(), *STATUS) == ["GroupMoving", "SynchronizedMotion"]
        down = plc.MC_MoveLinearAbsolute(gantry, Position=[0, 0, 0], CoordSystem=PCS)
        until(engine, down, lambda: gantry.velocity > 200, Execute=True)
        assert shown(status(), *STATUS) == ["GroupMoving", "SynchronizedMotion", "DiscreteMotion"]
        until(engine, down, lambda: down.Done)
        assert on_object(gantry) == pytest.approx((0, 0, 0), abs=1e-9)
        assert track().InSync
        place = {"x": 10.0, "z": -40.0}
        onto = plc.MC_SetDynCoordTransform(gantry, MasterAxesGroup=outfeed, CoordTransform=place, Pcs=2)
        until(engine, onto, lambda: onto.Done, Execute=True)
        begin = outfeed.position
        over = plc.MC_MoveLinearAbsolute(gantry, Position=[0, 0, 30], CoordSystem=PCS, Pcs=2)
        over(Execute=True)
        engine.step()
        lower = plc.MC_MoveLinearAbsolute(gantry, Position=[0, 0, 0], CoordSystem=PCS, Pcs=2)
        lower(BufferMode=takt.BufferMode.BUFFERED, Execute=True)
        while not over.Done:
            over(), lower(), track()
            assert gantry.velocity > 50
            engine.step()
        assert track.CommandAborted
        until(engine, lower, lambda: lower.Done)
        engine.run(0.2)
        assert on_object(gantry) == pytest.approx((0, 0, 0), abs=1e-9)
        assert gantry.pose[:3] == pytest.approx((50, 150 + 10 + outfeed.position - begin, -40), abs=0.2)
        assert gantry.velocity == pytest.approx(100, rel=1e-9)
    keeps_limits(recorder.recording)


def test_interrupted_and_continued(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-14, CV-16, CV-40: it stands in the world, then catches up within limits."""
    moving(engine, "drive", 120)
    with engine.record() as recorder:
        engine.step()
        track = gantry.track_conveyor_belt(belt="infeed", y=10).wait(until="reached")
        gantry.move_linear_absolute(x=0, y=0, coordinate_system="pcs").wait()
        assert on_object(gantry)[:2] == pytest.approx((0, 0), abs=1e-9)
        gantry.interrupt().wait()
        here = gantry.pose
        engine.run(0.3)
        assert gantry.pose == here
        assert gantry.interrupted
        assert gantry.track_lag == pytest.approx(-gantry.object_x, abs=1e-9)
        assert gantry.track_lag > 36
        gantry.continue_path().wait()
        engine.wait(lambda: gantry.in_sync, 2.0)
        assert on_object(gantry)[:2] == pytest.approx((0, 0), abs=1e-9)
        assert track.active
    keeps_limits(recorder.recording)
    assert recorder.recording["gantry"]["velocity"].max() <= 800 * (1 + 1e-6)


def test_a_stop(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-14."""
    moving(engine, "drive", 120)
    track = plc.MC_TrackConveyorBelt(gantry, ConveyorBelt="infeed")
    until(engine, track, lambda: track.InSync, Execute=True)
    stop = plc.MC_GroupStop(gantry)
    until(engine, stop, lambda: stop.Done, Execute=True)
    assert (track().CommandAborted, track.InSync) == (True, False)
    here = gantry.pose
    call(engine, stop, 0.1)
    assert (gantry.pose, gantry.state) == (here, takt.GroupState.GROUP_STOPPING)
    call(engine, stop, 0.01, Execute=False)
    assert (gantry.state, gantry.track_state) == (takt.GroupState.GROUP_STANDBY, TRACK.NONE)


def test_a_disabled_group(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-14."""
    moving(engine, "drive", 120)
    track = plc.MC_TrackConveyorBelt(gantry, ConveyorBelt="infeed")
    until(engine, track, lambda: track.InSync, Execute=True)
    gantry.disable().wait()
    assert track().CommandAborted


def test_a_belt_that_reverses(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-01, CV-14: followed backwards as far as where tracking began, then it is over for good."""
    belt = engine.belt("infeed")
    drive = moving(engine, "drive", 100)
    begin = belt.position
    track = gantry.track_conveyor_belt(belt="infeed", recorded_position=drive.set_position, start_distance=20)
    track.wait(until="reached")
    engine.run(0.5)
    drive.move_velocity(velocity=100, direction="negative")
    engine.run(0.3)
    assert belt.velocity == pytest.approx(-100)
    while belt.position - begin > 20.5:
        assert gantry.in_sync
        assert gantry.object_x == pytest.approx(0, abs=1e-9)
        engine.step()
    track.wait()
    assert belt.position - begin == pytest.approx(20, abs=5)
    drive.move_velocity(velocity=100)
    engine.run(1.0)
    assert belt.position - begin > 60
    assert (gantry.track_state, gantry.state) == (TRACK.NONE, takt.GroupState.GROUP_STANDBY)


@pytest.mark.parametrize("speed", [30.0, -30.0])
def test_a_table(engine: takt.Engine, gantry: takt.Group, speed: float) -> None:
    """CV-22: either way round; the tool turns along."""
    gantry.move_linear_absolute(x=80, y=200).wait()
    moving(engine, "disc", speed)
    table = engine.belt("table")
    track = plc.MC_TrackRotaryTable(gantry, RotaryTable=table, InitialObjectPosition=[80], StartAngle=10.0)
    track(EndAngle=100.0, SyncInAngle=15.0, Execute=True)
    begin = table.position
    until(engine, track, lambda: track.InSync)
    assert abs(table.position - begin) == pytest.approx(25, abs=1)
    c = gantry.c - table.position
    for _ in range(500):
        track()
        engine.step()
        on = gantry.pcs1
        assert gantry.pose[:2] == pytest.approx(on[:2], abs=1e-9)
        assert math.hypot(gantry.x, gantry.y - 200) == pytest.approx(80, abs=1e-9)
        assert gantry.c - table.position == pytest.approx(c, abs=1e-6)
    until(engine, track, lambda: track.Done)
    assert gantry.state is takt.GroupState.GROUP_STANDBY


def test_an_object_of_a_camera(engine: takt.Engine, gantry: takt.Group) -> None:
    """CV-02, CV-03: latched now, located later, tracked by where it lay then."""
    moving(engine, "drive", 150)
    belt, drive = engine.belt("infeed"), engine.axis("drive")
    latch = drive.set_position
    number = int(belt.detect().wait().value)
    engine.run(0.2)
    belt.locate(number=number, x=-30, y=15, c=20).wait()
    gantry.track_conveyor_belt(belt="infeed", recorded_position=latch, x=-30, y=15, c=20, start_distance=50)
    move = gantry.move_linear_absolute(x=0, y=0, z=-5, c=0, coordinate_system="pcs")
    move.wait()
    travel = drive.set_position - latch
    assert gantry.pose == pytest.approx((travel - 30, 15, -5, 0, 0, 20), abs=1e-6)
    assert belt.first_place == pytest.approx(travel - 30, abs=0.3)  # detected a cycle after the latch was read


def test_a_run_is_reproduced(tmp_path: Path) -> None:
    """EN-07, CV-11: every cycle, bit for bit; states of tracking are in the log."""
    url, log = new_url(), tmp_path / "run.lcm"
    with running(tmp_path, url, "--log", str(log), machine=MACHINE), takt.connect(url) as session:
        gantry = ready(session)
        session.axis("drive").move_velocity(velocity=150).wait(until="reached")
        gantry.track_conveyor_belt(belt="infeed", y=5, end_distance=250, sync_in_conveyor_distance=20)
        gantry.move_linear_absolute(x=0, y=0, z=-20, coordinate_system="pcs").wait()
        gantry.interrupt().wait()
        session.run(0.1)
        gantry.continue_path().wait()
        session.wait(lambda: gantry.state is takt.GroupState.GROUP_STANDBY, 10.0)
        session.axis("disc").move_velocity(velocity=30).wait(until="reached")
        gantry.track_rotary_table(table="table", x=100, end_angle=20).wait(until="reached")
        gantry.stop().wait()
    result = takt.replay(log)
    assert result.same, result.sentence
    states = takt.read_log(log)["gantry"]["track_state"]
    assert set(np.unique(states)) == {0, 2, 3, 4}


@pytest.mark.parametrize("increments", [10, 50, 500])
def test_coarsely_measured_belts_are_followed(increments: int) -> None:
    """CV-01, CV-16, CV-20: an encoder alone, with few increments in a millimetre, at a constant speed. The set point
    shakes by less than a tenth of an increment; after an interrupt the tool gets into step again."""
    machine = MACHINE.replace("increments_per_unit: 10000", f"increments_per_unit: {increments}")
    machine = machine.replace("absolute_ssi, ssi_bits: 25", "incremental").replace(
        "absolute, ssi_bits: 25", "incremental"
    )
    machine = machine.replace("infeed, axis: drive", "infeed, axis: drive, source: actual_value")
    machine = machine.replace("path: {velocity: 800", "tracking: {tolerance: 0.01}\n    path: {velocity: 800")
    with takt.Engine(machine) as session:
        gantry, drive = ready(session), session.axis("drive")
        drive.move_velocity(velocity=61.7).wait(until="reached")
        session.run(0.5)
        record = session.record()
        gantry.track_conveyor_belt(belt="infeed", start_distance=1).wait(until="reached")
        session.run(0.5)
        gantry.interrupt().wait()
        session.run(0.3)
        gantry.continue_path()
        session.run(1.0)
        recording = record.stop()
    robot, belt = recording["gantry"], recording["infeed"]
    last = slice(-500, None)
    shakes = robot["object_x"][last]
    assert np.ptp(shakes) < 0.1 / increments + 1e-3
    assert np.mean(robot["in_sync"][last]) > 0.95
    assert np.ptp(robot["velocity"][last] - belt["velocity"][last]) < 5


PLACING = """\
name: placing
axes:
  - {name: x, unit: mm, limits: {velocity: 4000, acceleration: 40000, jerk: 2000000}}
  - {name: y, unit: mm, limits: {velocity: 4000, acceleration: 40000, jerk: 2000000}}
  - {name: z, unit: mm, limits: {velocity: 4000, acceleration: 40000, jerk: 2000000}}
  - name: drive
    unit: mm
    limits: {velocity: 2000, acceleration: 10000, jerk: 500000}
    encoder: {type: incremental, increments_per_unit: 100}
groups:
  - name: gantry
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 3000, acceleration: 30000, jerk: 1500000}
belts:
  - {name: infeed, axis: drive, source: actual_value}
simulation:
  servos:
    - axis: drive
      drive: {position_gain: 50, velocity_time_constant_s: 0.01, load_compensation_s: 0.05}
      mechanics: {inertia: 0.001, coulomb_friction: 0.5, viscous_friction: 0.001}
      encoder: {type: incremental, increments_per_unit: 100}
"""


@pytest.mark.parametrize("hertz", [0.0, 0.5, 1.0, 2.0])
def test_placing_on_a_belt_that_changes_its_speed(hertz: float) -> None:
    """PP-64, PP-51: 1 m/s +-10 %, by jumps of the speed every 50 ms, against where the belt truly is; at a constant
    speed nothing shakes."""
    with takt.Engine(PLACING) as session:
        gantry, drive = session.group("gantry"), session.axis("drive")
        gantry.power().wait()
        gantry.enable().wait()
        drive.power().wait()
        drive.move_velocity(velocity=1000, acceleration=1000).wait(until="reached")
        session.run(0.5)
        worst, shaken, samples = 0.0, 0.0, 0
        for _ in range(4):
            latch, true_latch = drive.actual_position, drive.true_position
            gantry.set_dyn_coord_transform(pcs=1, carrier="infeed", x=-100, recorded_position=latch).wait()
            there = gantry.move_linear_absolute(x=0, y=0, z=5, coordinate_system="pcs", pcs=1)
            told = None
            for cycle in range(900):
                if cycle % 50 == 0 and hertz > 0:
                    way = 2 * math.pi * hertz
                    drive.move_velocity(velocity=1000 + 100 * math.sin(way * session.now), acceleration=105 * way)
                session.run(0.001)
                if told is not None:  # where it was told to be by now
                    worst = max(worst, abs(told - (drive.true_position - true_latch - 100)))
                    samples += 1
                told = gantry.x if there.done and gantry.track_state is TRACK.IN_SYNC else None
                if told is not None:
                    shaken = max(shaken, abs(session.belt("infeed").acceleration))
            gantry.move_linear_absolute(x=0, y=0, z=50).wait()
    assert samples > 1000
    assert worst < (0.1 if hertz > 0 else 0.01)
    assert hertz > 0 or shaken < 300


@pytest.mark.parametrize("how", ["member", "group", "all", "emergency_stop"])
def test_power_off_ends_a_track_that_waits(how: str) -> None:
    """AX-100: a tool whose tracking waits for its object does not set off when the power comes back."""
    with takt.Engine(MACHINE) as session:
        gantry = ready(session)
        track = gantry.track_conveyor_belt(belt="infeed", start_distance=60)
        session.run(0.1)
        assert gantry.track_state is TRACK.WAITING
        if how == "member":
            session.axis("y").power(enable=False).wait()
        elif how == "group":
            gantry.power(enable=False).wait()
        elif how == "all":
            session.command("machine", "stop_all", {"open_loops": True})
        else:
            session.command("machine", "emergency_stop")
        session.run(0.1)
        assert track.aborted
        assert gantry.track_state is TRACK.NONE
        gantry.reset().wait()
        gantry.power().wait()
        session.axis("drive").power().wait()
        session.axis("drive").move_velocity(velocity=100)
        session.run(1.0)
        assert gantry.x == 0


@pytest.mark.parametrize("buffered", [True, False])
@pytest.mark.parametrize("early_s", [0.1, 0.06, 0.02, 0.004])
@pytest.mark.parametrize("event", ["interrupted", "interrupted and continued", "faster"])
def test_a_move_is_done_where_the_tool_is_on_its_place(buffered: bool, early_s: float, event: str) -> None:
    """GR-22, CV-03: with and without another move behind it, after any event before its end."""
    limited = "400000}\n    tracking: {after_sync: limited}\n" if event == "faster" else "400000}\n"
    text = MACHINE.replace("400000}\n", limited).replace("acceleration: 2000,", "acceleration: 50000,", 1)

    def begin(engine: takt.Engine) -> tuple[takt.Group, list[takt.Feedback]]:
        gantry = ready(engine)
        gantry.set_dyn_coord_transform(pcs=1, carrier="infeed").wait()
        gantry.move_linear_absolute(x=0, y=0, z=30).wait()
        engine.axis("drive").move_velocity(velocity=100 if event == "faster" else 300)
        engine.run(0.5)
        moves = [gantry.move_linear_absolute(x=-100, y=0, z=0, coordinate_system=PCS, pcs=1)]
        if buffered:
            moves.append(
                gantry.move_linear_absolute(x=-100, y=50, z=0, coordinate_system=PCS, pcs=1, buffer_mode="buffered")
            )
        return gantry, moves

    with takt.Engine(text) as engine:
        _, moves = begin(engine)
        moves[0].wait()
        undisturbed_s = engine.now
    with takt.Engine(text) as engine:
        gantry, moves = begin(engine)
        engine.run(undisturbed_s - early_s - engine.now)
        if event == "faster":
            engine.axis("drive").move_velocity(velocity=450)
        else:
            gantry.interrupt()
            engine.run(0.05)
            assert not moves[0].done or math.dist(on_object(gantry), (-100, 0, 0)) < 1e-6
            if event == "interrupted":
                engine.run(0.5)
                assert not moves[0].done or math.dist(on_object(gantry), (-100, 0, 0)) < 1e-6
            gantry.continue_path()
        engine.wait(lambda: moves[0].final, timeout=5)
        assert moves[0].done
        assert on_object(gantry) == pytest.approx((-100, 0, 0), abs=0.01)
        moves[-1].wait()
        assert on_object(gantry) == pytest.approx((-100, 50 if buffered else 0, 0), abs=0.01)


def test_a_system_of_which_nothing_is_known() -> None:
    """CV-03: a pose that was never given, and a group without kinematics, carry nothing; there is no move in them."""
    pair = "  - {name: pair, axes: [u, v], path: {velocity: 800, acceleration: 8000, jerk: 400000}}\n"
    limits = "limits: {velocity: 1000, acceleration: 10000, jerk: 500000}"
    axes = "".join(f"  - {{name: {name}, unit: mm, {limits}}}\n" for name in "uv")
    text = MACHINE.replace("belts:\n", f"{pair}poses: [{{name: camera}}]\nbelts:\n").replace(
        "groups:\n", f"{axes}groups:\n"
    )
    with takt.Engine(text) as engine:
        gantry = ready(engine)
        gantry.move_linear_absolute(x=200, y=50, z=10).wait()
        place = gantry.pose
        for carrier in ("camera", "pair"):
            gantry.set_dyn_coord_transform(pcs=1, carrier=carrier).wait_final()
            moves = [
                gantry.move_linear_absolute(x=0, y=0, coordinate_system=PCS, pcs=1),
                gantry.move_direct_absolute(x=0, y=0, coordinate_system=PCS, pcs=1),
                gantry.jog(x=10, coordinate_system="pcs", pcs=1),
            ]
            engine.run(0.3)
            assert [move.error_id for move in moves] == [3035] * 3
            assert "is not known" in moves[0].sentence
        assert gantry.pose == pytest.approx(place)


@pytest.mark.parametrize(
    ("lower", "upper", "angle", "place"),
    [
        (190, 260, 185, 185),
        (190, 260, 200, 200),
        (190, 260, 280, -80),
        (150, 210, 190, 190),
        (-200, -100, 155, -205),
        (0, 90, 100, -260),
        (0, 90, 80, 80),
        (0, 720, 10, 10),
        (0, 720, -10, -10),
        (0, 360, -10, -10),
        (-60, 265, -100, -100),
        (185, 545, 182, 182),
        (None, 90, 100, -260),
        (10, None, -170, -170),
    ],
)
def test_objects_on_a_table_reach_its_range_within_a_turn(
    lower: float | None, upper: float | None, angle: float, place: float
) -> None:
    """CV-22: also ranges beyond 180 deg and of a turn, and objects just before and just behind the range."""
    limits = {"lower_limit": lower, "upper_limit": upper}
    given = ", ".join(f"{name}: {limit}" for name, limit in limits.items() if limit is not None)
    text = f"""
name: table
axes: [{{name: disc, unit: deg, kind: rotary, limits: {{velocity: 360, acceleration: 3600, jerk: 72000}}}}]
belts: [{{name: table, kind: turning, axis: disc, {given}}}]
"""
    engine = takt.Engine(text)
    table = engine.belt("table")
    table.detect(x=200 * math.cos(math.radians(angle)), y=200 * math.sin(math.radians(angle))).wait()
    engine.step(2)
    assert table.objects[0].place == pytest.approx(place)
    assert table.objects[0].in_range == ((lower is None or lower <= place) and (upper is None or place <= upper))


@pytest.mark.parametrize(("speed", "first"), [(60, 2), (-60, 1)])
def test_the_object_that_leaves_the_range_first(speed: float, first: int) -> None:
    """CV-43: in the sense in which the belt moves."""
    engine = takt.Engine("""
name: belt
axes: [{name: drive, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}]
belts: [{name: infeed, axis: drive, lower_limit: 0, upper_limit: 600}]
""")
    belt = engine.belt("infeed")
    belt.axis.power().wait()
    belt.axis.move_absolute(position=math.copysign(1, speed)).wait()
    for x in (200, 400):
        belt.detect(x=x).wait()
    engine.step()
    assert (belt.first_number, belt.first_place) == (first, pytest.approx(200 * first))
