"""Pick and place modules as scenarios see them."""

from __future__ import annotations

import pytest
import takt

MACHINE = """
name: cell
axes:
  - {name: x, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: y, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: z, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: drive, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: portal
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 1000, acceleration: 8000, jerk: 400000}
belts:
  - {name: infeed, axis: drive, origin: {y: 200, z: -50}, lower_limit: 0, upper_limit: 600}
pick_and_place:
  - name: picker
    group: portal
    belts: [{belt: infeed, settings: {park_x: 300, park_y: 200, park_z: 20, z_distance: 25, sync_time: 0.05}}]
    settings:
      {path_velocity: 1000, path_acceleration: 8000, path_deceleration: 8000, path_jerk: 400000, keep_orientation: true,
       blending_radius: 10, z_start_distance: 30, z_target_distance: 20, x_target: 100, gripper_closing_time: 0.02}
"""
NO_LIMITS = [0.0] * 7


@pytest.fixture
def engine() -> takt.Engine:
    engine = takt.Engine(MACHINE)
    engine.axis("drive").power().wait()
    picker = engine.pick_place("picker")
    picker.configure(max_velocity=NO_LIMITS, max_acceleration=NO_LIMITS, max_jerk=NO_LIMITS).wait()
    picker.control(regulator_on=True).wait()
    engine.run(0.5)
    assert picker.axes_group_enabled
    return engine


def test_a_session_has_modules(engine: takt.Engine) -> None:
    """PP-01."""
    assert list(engine.pick_places) == ["picker"]
    picker = engine.pick_place("picker")
    assert picker.group is engine.group("portal")
    assert picker.belts == [engine.belt("infeed")]
    assert "ready" in repr(picker)
    with pytest.raises(takt.TaktError, match="did you mean 'picker'"):
        engine.pick_place("piker")


def test_picks_places_and_parks(engine: takt.Engine) -> None:
    """PP-42, PP-30: from a belt that runs to a static place and back to the parking position."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    engine.axis("drive").move_velocity(velocity=100).wait(until="reached")
    belt.detect(x=50).wait()
    picker.execute(1).wait()
    assert (picker.picked, belt.object_count) == (1, 0)
    picker.execute().wait()
    assert picker.placed == 1
    assert picker.position[:3] == pytest.approx((100, 0, 0), abs=0.1)
    assert picker.in_target


def test_stops_on_the_path_and_goes_on(engine: takt.Engine) -> None:
    """PP-20."""
    picker = engine.pick_place("picker")
    going = picker.execute()
    engine.run(0.1)
    picker.control(path_stop=True).wait()
    engine.run(1)
    assert picker.path_hold
    assert not going.final
    picker.control(path_stop=False).wait()
    engine.run(0.01)
    picker.execute().wait()
    going.wait()
    assert picker.position[0] == pytest.approx(100, abs=0.1)


def test_aborted_at_rest(engine: takt.Engine) -> None:
    """PP-20."""
    picker = engine.pick_place("picker")
    going = picker.execute()
    engine.run(0.1)
    picker.control(path_stop=True).wait()
    engine.run(1)
    picker.abort()
    engine.run(0.01)
    assert going.aborted
    assert not picker.path_hold
