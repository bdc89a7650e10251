"""GR-02, GR-03, GR-20, PY-02 to PY-04: groups of axes in sessions, recordings, logs and replays."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from portals import PORTAL, portal
from seams import MACHINE
from takt import _core

OUTPUTS = json.loads(_core.reference())["outputs"]["group"]["fields"]


def test_a_session_has_its_groups_by_name() -> None:
    with takt.Engine(PORTAL) as engine:
        assert list(engine.groups) == ["gantry"]
        gantry = engine.group("gantry")
        assert gantry is engine.components["gantry"]
        engine.step()
        assert [axis.name for axis in gantry.members] == ["x", "y", "z"]
        assert gantry.places == (1, 2, 3, 0, 0, 0, 0, 0)
        assert gantry.state is takt.GroupState.GROUP_DISABLED
        with pytest.raises(takt.TaktError, match="no group 'gantrie'; did you mean 'gantry'"):
            engine.group("gantrie")
        assert repr(gantry) == "<Group gantry: GroupDisabled at x 0, y 0, z 0 mm>"


def test_every_output_is_a_property() -> None:
    """PY-02."""
    with takt.Engine(PORTAL) as engine:
        gantry = engine.group("gantry")
        for field in OUTPUTS:
            assert getattr(gantry, field["name"]) is not None
        assert gantry.pose == gantry.actual_pose == (0, 0, 0, 0, 0, 0)


def test_moves_along_a_line_and_is_recorded() -> None:
    """GR-20, PY-04."""
    with portal() as (engine, gantry):
        with engine.record() as recorder:
            engine.step()
            gantry.move_linear_absolute(x=60, y=80, velocity=100).wait()
        made = recorder.recording
        x, y = (np.array(made["gantry"][name]) for name in "xy")
        assert np.abs(x / 60 - y / 80).max() < 1e-9
        assert gantry.pose == pytest.approx((60, 80, 0, 0, 0, 0), abs=1e-9)
        assert max(made["gantry"]["path_velocity"]) == pytest.approx(100, rel=1e-3)
        assert made.unit("gantry", "path_velocity") == "mm/s"
        assert made.unit("gantry", "acceleration") == "mm/s²"
        assert takt.expect.visits_states(made, "gantry", ["GroupStandby", "GroupMoving", "GroupStandby"])
        for axis in "xyz":
            assert takt.expect.within_limits(made, axis)
            assert takt.expect.continuous(made, axis)


@pytest.mark.parametrize(
    ("base", "system", "transform", "y_sense"),
    [
        ("", "mcs", {}, 1),
        ("", "pcs", {"a": 180}, -1),
        ("", "pcs", {"b": 90}, 1),
        ("base: {x: 1000, a: 180}", "wcs", {}, -1),
    ],
)
def test_circles_by_centre_turn_in_the_system_of_the_command(
    base: str, system: str, transform: dict[str, float], y_sense: int
) -> None:
    """GR-20: without a normal, counterclockwise is about Z of that system: a quarter of a circle and a half of one."""
    with takt.Engine(PORTAL.replace("base: {x: 1000, c: 90}", base)) as engine:
        gantry = engine.group("gantry")
        gantry.power().wait()
        gantry.enable().wait()
        if transform:
            gantry.set_cartesian_transform(**transform).wait()
        for x, y, turn in ((-50, 50, math.pi / 2), (-100, 0, math.pi)):
            gantry.move_linear_absolute(x=0, y=0, z=0).wait()
            with engine.record() as recorder:
                engine.step()
                arc = {"circ_mode": "center", "path_choice": "counterclockwise", "aux_x": -50, "x": x, "y": y}
                gantry.move_circular_relative(coordinate_system=system, **arc).wait()
            places = np.array([recorder.recording["gantry"][name] for name in "xyz"])
            length = np.linalg.norm(np.diff(places, axis=1), axis=0).sum()
            assert length == pytest.approx(50 * turn, rel=1e-3)
            assert max(y_sense * places[1]) == pytest.approx(50, abs=1e-3)


def test_a_deceleration_left_out_is_that_of_the_group() -> None:
    """GR-20: whatever acceleration the command gives."""
    machine = PORTAL.replace("acceleration: 3000, jerk: 60000}", "acceleration: 3000, deceleration: 500, jerk: 60000}")
    with takt.Engine(machine) as engine:
        gantry = engine.group("gantry")
        gantry.power().wait()
        gantry.enable().wait()
        for given, least in ((None, -500), (1500, -1500)):
            with engine.record() as recorder:
                gantry.move_linear_relative(x=100, acceleration=2000, deceleration=given).wait()
            along = np.array(recorder.recording["gantry"]["path_acceleration"])
            assert 1800 < along.max() < 2000.1
            assert least - 0.1 < along.min() < 0.9 * least


def test_product_systems_are_published() -> None:
    """GR-10: sixteen, as they were given; also in recordings."""
    with portal() as (engine, gantry):
        assert gantry.base == (1000, 0, 0, 0, 0, 90)
        assert gantry.tool == (0, 0, 0, 0, 0, 0)
        with engine.record() as recorder:
            engine.step()
            for pcs in range(1, 17):
                gantry.set_cartesian_transform(pcs=pcs, x=pcs, y=-pcs, z=0.5, a=pcs, b=2, c=300).wait()
                assert gantry.product_system(pcs) == (pcs, -pcs, 0.5, pcs, 2, 300)
        assert gantry.pcs7 == gantry.product_system(7)
        assert list(recorder.recording["gantry"]["pcs16_x"][[0, -1]]) == [0, 16]
        assert recorder.recording.unit("gantry", "pcs16_a") == "deg"
        for wrong in (0, 17):
            with pytest.raises(takt.TaktError, match=f"1 to 16, found {wrong}"):
                gantry.product_system(wrong)


def test_members_are_not_moved_by_themselves() -> None:
    """GR-03."""
    with portal() as (engine, gantry):
        refused = engine.axis("x").move_absolute(position=5).wait_final()
        assert (refused.error_id, refused.sentence) == (1000, "the axis is a member of a group")
        assert engine.axis("x").write_output(number=1, value=True).wait().done  # it moves nothing
        gantry.disable().wait()
        engine.axis("x").move_absolute(position=5).wait()


def test_what_is_refused_comes_with_a_sentence() -> None:
    """GR-02, GR-12."""
    with portal() as (_, gantry):
        assert gantry.move_path(path="slit").sentence.endswith("found 'slit'; did you mean slot?")
        beyond = gantry.move_linear_absolute(x=301)
        with pytest.raises(takt.CommandError):
            beyond.wait()
        assert beyond.error_id == 3021
        assert gantry.reason is takt.Reason.AXIS_LIMIT
        gantry.disable().wait()
        assert gantry.move_linear_absolute(x=1).wait_final().error_id == 3025


def test_members_come_and_go() -> None:
    """GR-02."""
    with takt.Engine(PORTAL) as engine:
        gantry = engine.group("gantry")
        assert gantry.add_axis(axis="feed", ident=1).wait_final().error_id == 1001  # the place is taken
        gantry.add_axis(axis="feed", ident=4).wait()
        engine.step()
        assert [axis.name for axis in gantry.members] == ["x", "y", "z", "feed"]
        gantry.remove_axis(ident=4).wait()
        gantry.ungroup_all_axes().wait()
        engine.step()
        assert gantry.members == ()


def test_no_members_at_run_time_that_the_machine_file_could_not_have() -> None:
    """GR-02: an axis that follows another, or that a cam module moves, stays out of a group."""
    with takt.Engine(MACHINE) as engine:
        portal = engine.group("portal")
        for axis, why in (("right", "that does not follow another"), ("knife", "that no cam module moves")):
            refused = portal.add_axis(axis=axis, ident=4).wait_final()
            assert refused.sentence == f"axis: expected an axis {why}, found '{axis}'"
        engine.step()
        assert [axis.name for axis in portal.members] == ["x", "y", "z"]


def test_what_another_component_leads_is_not_taken_from_it() -> None:
    """GR-25, CAM-80: an axis follows one group or cam module at a time."""
    with takt.Engine(MACHINE) as engine:
        portal, robot, cutter = engine.group("portal"), engine.group("robot"), engine.flex_cam("cutter")
        for group in (portal, robot):
            group.power().wait()
            group.enable().wait()
        engine.axis("web").power().wait()
        cutter.control(regulator_on=True)
        engine.wait(lambda: engine.axis("knife").powered)
        synced = portal.sync_axis(axis="knife")
        synced.wait(until="reached")
        assert robot.sync_axis(axis="knife").wait_final().error_id == 3005
        assert cutter.control(sync_cam=True).wait_final().error_id == 3005
        assert cutter.state is takt.ModuleState.SERVICE
        assert synced.active
        engine.axis("knife").halt().wait()  # a command of its own
        assert synced.aborted
        cutter.control(sync_cam=False)
        cutter.control(sync_cam=True).wait(until="active")
        engine.step()
        assert portal.sync_axis(axis="knife").wait_final().error_id == 3005
        assert cutter.state is takt.ModuleState.SYNC


def test_sw_limits_that_are_changed_count_for_groups() -> None:
    """GR-12: wider than in the machine file, then narrower."""
    with portal() as (engine, gantry):
        for limit in (400, 100):
            gantry.disable().wait()
            engine.axis("x").set_soft_limits(upper=limit).wait()
            gantry.enable().wait()
            beyond = gantry.move_linear_absolute(x=limit + 1).wait_final()
            assert (beyond.error_id, gantry.reason) == (3021, takt.Reason.AXIS_LIMIT)
            gantry.move_linear_absolute(x=limit - 1).wait()
            assert engine.axis("x").set_position == pytest.approx(limit - 1)
            gantry.move_linear_absolute(x=0).wait()


def test_interrupted_and_continued() -> None:
    """GR-20."""
    with portal() as (engine, gantry):
        move = gantry.move_path(path="slot")
        engine.run(0.3)
        gantry.interrupt().wait()
        assert gantry.interrupted
        here = gantry.pose
        engine.run(0.2)
        assert gantry.pose == here
        gantry.continue_path().wait()
        move.wait()
        assert gantry.pose == pytest.approx((0, 0, 0, 0, 0, 0), abs=1e-9)


def test_over_lcm_as_in_process_and_replayed(tmp_path: Path) -> None:
    """PY-01, PY-03, EN-20, EN-40."""
    url, log = new_url(), tmp_path / "portal.log"
    with running(tmp_path, url, "--log", str(log), machine=PORTAL), takt.connect(url) as session:
        gantry = session.group("gantry")
        gantry.power().wait()
        gantry.enable().wait()
        gantry.move_linear_absolute(x=30, y=40).wait()
        assert gantry.x == pytest.approx(30, abs=1e-9)
        stop = gantry.stop(hold=True)
        session.wait(lambda: gantry.state is takt.GroupState.GROUP_STOPPING)
        stop.release()
        session.wait(lambda: gantry.state is takt.GroupState.GROUP_STANDBY)
    replayed = takt.replay(log)
    assert replayed.same, replayed.sentence
