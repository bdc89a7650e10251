"""Pick and place modules as scenarios see them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
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
    return started()


def started(text: str = MACHINE) -> takt.Engine:
    engine = takt.Engine(text)
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


def tool(engine: takt.Engine) -> tuple[float, ...]:
    """x, y and z, mm, as commanded."""
    return tuple(engine.axis(name).set_position for name in "xyz")


@pytest.mark.parametrize("limits", ["", "lower: -500, upper: 500, "])
def test_a_key_pressed_again_jogs_on(limits: str) -> None:
    """PP-03: before the tool rests, and behind the other key; with a SW limit ahead or without."""
    engine = started(MACHINE.replace("{velocity: 1500", f"{{{limits}velocity: 1500"))
    picker = engine.pick_place("picker")
    picker.configure(cartesian_jog_velocity=50, cartesian_jog_deceleration=200).wait()
    picker.control(select_axis="x").wait()
    picker.jog(positive=True)
    engine.run(1)
    picker.jog()
    engine.run(0.02)
    for _ in range(2):
        picker.jog(positive=True)
        engine.run(1)
        assert (picker.state, picker.error, picker.warning) == (takt.PickPlaceState.JOG_POS, 0, 0)
        assert engine.axis("x").set_velocity == pytest.approx(50)
        picker.jog(negative=True)
        engine.run(1)
        assert (picker.state, engine.axis("x").set_velocity) == (takt.PickPlaceState.JOG_POS, 0)
    picker.jog()
    engine.run(0.02)
    picker.control(select_axis="y")
    picker.jog(positive=True)  # a jog of its own
    engine.run(1)
    assert [engine.axis(name).set_velocity for name in "xy"] == [0, pytest.approx(50)]
    picker.jog().wait()
    assert picker.state is takt.PickPlaceState.READY


LOW = MACHINE.replace("z_distance: 25, sync_time: 0.05", "sync_time: 0.5")


def on_its_workpiece(engine: takt.Engine) -> takt.Feedback:
    """The pick, 0.1 s after the tool has arrived."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=60).wait(until="reached")
    belt.detect(x=50).wait()
    picking = picker.execute(1)
    engine.wait(lambda: picker.in_target, 5)
    engine.run(0.1)
    assert picker.synchronised
    assert not picking.final
    return picking


@pytest.mark.parametrize("stop", ["path_stop", "path_interrupt"])
def test_a_stop_ends_a_pick_on_its_workpiece(stop: str) -> None:
    """PP-20, PP-61: without z_distance, too; the tool does not stay with a workpiece that moves on."""
    engine = started(LOW)
    picker = engine.pick_place("picker")
    picking = on_its_workpiece(engine)
    picker.control(**{stop: True})
    engine.run(0.01)
    assert (picking.done, picker.picked, engine.belt("infeed").object_count) == (True, 1, 0)
    engine.run(0.5)
    assert not picker.synchronised
    before = tool(engine)
    picker.control(**{stop: False})
    engine.run(0.5)
    assert picker.state is takt.PickPlaceState.READY
    assert tool(engine) == before
    picker.execute().wait()


def test_a_group_interrupted_by_itself_stays_the_rest_of_its_time() -> None:
    """PP-41: the time on the workpiece counts while the tool moves with it."""
    engine = started(LOW)
    picker, group = engine.pick_place("picker"), engine.group("portal")
    picking = on_its_workpiece(engine)
    group.interrupt()
    engine.run(1)
    assert not picker.synchronised
    assert not picking.final
    group.continue_path()
    engine.wait(lambda: picker.synchronised, 1)
    begin = engine.now
    picking.wait()
    assert engine.now - begin == pytest.approx(0.4, abs=0.005)


def test_a_way_back_that_is_halted_is_no_way_back(engine: takt.Engine) -> None:
    """PP-20: return_to_path is done at the path alone."""
    picker = engine.pick_place("picker")
    picker.configure(cartesian_jog_velocity=100, cartesian_jog_deceleration=1000).wait()
    picker.control(select_axis="y").wait()
    going = picker.execute()
    engine.run(0.1)
    picker.control(path_stop=True)
    engine.run(1)
    picker.control(path_stop=False).wait()
    engine.run(0.01)
    held = tool(engine)
    picker.jog(positive=True)
    engine.run(1)
    picker.jog().wait()
    picker.configure(path_velocity=50).wait()
    back = picker.control(return_to_path=True)
    engine.run(0.2)
    engine.group("portal").halt().wait()
    engine.run(0.1)
    assert back.aborted
    assert (picker.state, picker.path_hold, picker.off_path) == (takt.PickPlaceState.READY, True, True)
    assert tool(engine)[1] > held[1] + 10
    picker.control(return_to_path=False)
    assert picker.execute().wait_final().error_id == 3031
    picker.control(return_to_path=True).wait()
    assert not picker.off_path
    assert tool(engine) == pytest.approx(held, abs=1e-6)
    picker.execute().wait()
    going.wait()


@pytest.mark.parametrize("by", ["group", "axis", "homing"])
def test_a_tool_moved_away_is_not_parked(engine: takt.Engine, by: str) -> None:
    """PP-42: whatever moves the tool away from its parking position, it parks again."""
    picker, group = engine.pick_place("picker"), engine.group("portal")
    engine.axis("drive").move_velocity(velocity=100).wait(until="reached")
    engine.belt("infeed").detect(x=50).wait()
    picker.execute(1).wait()
    engine.wait(lambda: picker.in_park_position and picker.state is takt.PickPlaceState.READY, 5)
    assert tool(engine) == pytest.approx((300, 200, 20))
    engine.run(0.1)
    assert picker.in_park_position
    if by == "group":
        group.move_linear_absolute(x=0, y=0, z=100).wait()
    elif by == "axis":
        group.disable().wait()
        engine.axis("x").move_absolute(position=0).wait()
        group.enable().wait()
    else:
        picker.configure(homing_order=[1, 0, 0, 0, 0, 0, 0], home_position=[250.0, 0, 0, 0, 0, 0, 0]).wait()
        picker.control(home_execute=True).wait()
    engine.run(0.01)
    assert tool(engine) != pytest.approx((300, 200, 20))
    assert not picker.in_park_position
    picker.execute(1)
    engine.wait(lambda: picker.in_park_position, 5)
    assert tool(engine) == pytest.approx((300, 200, 20))


def test_an_order_that_waits_parks_again_from_where_the_tool_is(engine: takt.Engine) -> None:
    """PP-42: it rises first, and begins when the other motion has ended."""
    picker, group = engine.pick_place("picker"), engine.group("portal")
    engine.axis("drive").move_velocity(velocity=100).wait(until="reached")
    picker.execute(1)
    engine.wait(lambda: picker.in_park_position, 5)
    group.move_linear_absolute(x=0, y=0, z=-40, velocity=100).wait()
    record = engine.record("portal")
    engine.run(2)
    portal = record.stop()["portal"]
    assert tool(engine) == pytest.approx((300, 200, 20))
    assert portal["z"][portal["x"] > 20].min() > -20


@pytest.mark.parametrize("factors", [(0.5, 1, 1), (1, 0.5, 1), (1, 1, 0.5)])
def test_an_override_of_the_group_switches_gripper_control_off(
    engine: takt.Engine, factors: tuple[float, float, float]
) -> None:
    """PP-21, PP-30."""
    picker, names = engine.pick_place("picker"), ("velocity_factor", "acceleration_factor", "jerk_factor")
    picker.configure(gripper_closing_time=0.1).wait()
    engine.group("portal").set_override(**dict(zip(names, factors, strict=True))).wait()

    def pulses(x_target: float, active: bool) -> int:
        picker.configure(x_target=x_target).wait()
        recorder = engine.record()
        going = picker.execute()
        engine.run(0.1)
        assert picker.gripper_control_active == active
        going.wait()
        return int(np.sum(recorder.stop()["picker"]["pulse_gripper"]))

    assert pulses(100, active=False) == 0
    engine.group("portal").set_override().wait()
    assert pulses(300, active=True) == 1


@pytest.mark.parametrize("by", ["module", "group"])
def test_what_an_override_makes_too_late_is_not_begun(engine: takt.Engine, by: str) -> None:
    """PP-44: whether a workpiece can be reached goes by the override of the group, whoever gave it."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=100).wait(until="reached")
    if by == "module":
        picker.control(override_factor=0.1).wait()
    else:
        engine.group("portal").set_override(velocity_factor=0.1).wait()
    belt.detect(x=450).wait()  # reached within 1.5 s at full speed
    picker.execute(1)
    for _ in range(100):
        engine.run(0.01)
        assert picker.workpiece == 0


def left_by_a_stop(engine: takt.Engine) -> tuple[takt.PickPlace, takt.Belt]:
    """The module stopped on its way to the only workpiece, which the belt carries out of its range."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    picker.configure_belt(lower_limit=10, upper_limit=400).wait()
    belt.axis.move_velocity(velocity=100).wait(until="reached")
    belt.detect(x=220).wait()
    picker.execute(1)
    engine.run(0.05)
    assert picker.workpiece == 1
    picker.control(stop_all=True)
    return picker, belt


def test_what_is_lost_at_a_stop_is_counted_once(engine: takt.Engine) -> None:
    """PP-63: a workpiece that a stop left behind counts as interrupted; the next one that is lost is missed, too."""
    picker, belt = left_by_a_stop(engine)
    engine.run(4.5)
    assert (picker.missed, picker.missed_interrupted, belt.lost_count) == (1, 1, 1)
    picker.control(stop_all=False)
    engine.run(0.3)
    picker.execute(1)
    engine.run(0.5)
    belt.detect(x=550)
    engine.run(1)
    assert (picker.missed, picker.missed_too_late, belt.lost_count) == (2, 1, 2)


@pytest.mark.parametrize("limits", [(100, 0), (400, 200), (300, 300)])
def test_a_range_the_wrong_way_round_is_refused(engine: takt.Engine, limits: tuple[float, float]) -> None:
    """PP-41: in the file and at run time; both 0 leave the belt's range."""
    lower, upper = limits
    settings = f"settings: {{lower_limit: {lower}, upper_limit: {upper}, "
    with pytest.raises(takt.ConfigError, match=r"belts\[0\].settings.upper_limit: must lie above lower_limit"):
        takt.Engine(MACHINE.replace("settings: {park_x", settings + "park_x"))
    picker = engine.pick_place("picker")
    assert picker.configure_belt(lower_limit=lower, upper_limit=upper).wait_final().error_id == 5
    picker.configure_belt(lower_limit=-100, upper_limit=0).wait()
    picker.configure_belt(lower_limit=0, upper_limit=0).wait()


TWO_BELTS = MACHINE.replace(
    "pick_and_place:", "  - {name: outfeed, axis: drive, upper_limit: 300}\npick_and_place:"
).replace("sync_time: 0.05}}]", "sync_time: 0.05}}, {belt: outfeed}]")


@pytest.mark.parametrize(
    ("text", "setting", "wrong"),
    [
        (
            TWO_BELTS,
            "tracking_mode: from_to, pick_belt: 1, place_belt: 3",
            "settings.place_belt: expected a belt of the module's list, 1 to 2, or 0, the static target, found 3",
        ),
        (
            MACHINE,
            "pick_belt: 2",
            "pick_belt: expected a belt of the module's list, 1, or 0, the static target, found 2",
        ),
        (
            MACHINE,
            "tracking_mode: belt1_to_belt2",
            "tracking_mode: expected a mode for the belts of the module's list, found one that needs belt 2 where "
            "there is 1",
        ),
    ],
)
def test_belts_that_are_not_in_the_list(text: str, setting: str, wrong: str) -> None:
    """PP-43: refused with the list, in the file and at run time."""
    with pytest.raises(takt.ConfigError) as refused:
        takt.Engine(text.replace("{path_velocity", f"{{{setting}, path_velocity"))
    assert wrong in str(refused.value)
    picker = started(text).pick_place("picker")
    name, value = setting.split(", ")[-1].split(": ")
    feedback = picker.configure(**{name: int(value) if value.isdecimal() else value}).wait_final()
    assert (feedback.error_id, wrong.removeprefix("settings.") in str(feedback.sentence)) == (5, True)


def test_commands_for_belts_that_are_not_in_the_list(engine: takt.Engine) -> None:
    """PP-41, PP-43."""
    picker = engine.pick_place("picker")
    wrong = r"set_target: expected a belt of the module's list, 1, or 0, the static target, found 3 \(error 5\)"
    with pytest.raises(takt.CommandError, match=wrong):
        picker.execute(3).wait()
    with pytest.raises(takt.CommandError, match=r"belt: expected a belt of the module's list, 1, found 3 \(error 5\)"):
        picker.configure_belt(belt=3).wait()


def test_ranges_that_the_belt_does_not_have(engine: takt.Engine) -> None:
    """PP-41: a work range beside the belt's own, in which no workpiece ever is."""
    wrong = (
        "lower_limit: expected lower_limit to upper_limit to overlap the work range of belt 'infeed', 0.0 to 600.0, "
    )
    wrong += "found "
    settings = "settings: {lower_limit: 700, upper_limit: 800, park_x"
    with pytest.raises(takt.ConfigError, match=wrong + "700.0 to 800.0"):
        takt.Engine(MACHINE.replace("settings: {park_x", settings))
    picker = engine.pick_place("picker")
    with pytest.raises(takt.CommandError, match=wrong + "-20.0 to -10.0"):
        picker.configure_belt(lower_limit=-20, upper_limit=-10).wait()
    picker.configure_belt(lower_limit=500, upper_limit=800).wait()
    with pytest.raises(takt.CommandError, match="both must overlap the work range of the belt"):
        picker.configure_belt(lower_limit=700).wait()


def test_rules_of_settings_are_named(engine: takt.Engine) -> None:
    """PP-03, PP-41: where a setting does not go with those that are set already."""
    picker = engine.pick_place("picker")
    for command, arguments, rule in (
        (picker.configure_belt, {"lower_limit": 10}, "upper_limit must lie above lower_limit"),
        (picker.configure_belt, {"turns": 2}, "turns must not lead beyond every"),
        (picker.configure, {"workpiece_pcs1": 16}, "workpiece_pcs1 and workpiece_pcs2 must be different"),
        (picker.jog, {"positive": True}, "select_axis: expected what is to be jogged, found none"),
        (picker.jog, {"positive": True, "negative": True}, "positive and negative: expected one of both"),
    ):
        with pytest.raises(takt.CommandError, match=rule):
            command(**arguments).wait()


@pytest.mark.parametrize(("factor", "slower"), [(0, 2), (0.01, 4)])
def test_a_profile_begun_at_a_low_override_does_not_crawl_afterwards(factor: float, slower: float) -> None:
    """PP-21: behind a hold it keeps its accelerations, behind a low override a tenth of them at least."""

    def takes_s(override_factor: float) -> float:
        engine = started()
        picker = engine.pick_place("picker")
        picker.control(override_factor=override_factor).wait()
        going = picker.execute()
        engine.run(0.3 if override_factor < 1 else 0)
        picker.control(override_factor=1).wait()
        begin = engine.now
        going.wait()
        return engine.now - begin

    assert takes_s(factor) < slower * takes_s(1)


def test_profiles_given_behind_an_override_have_their_own_accelerations(engine: takt.Engine) -> None:
    """PP-21: the profiles that wait begin with those of the override at their begin; it scales accelerations, too."""
    picker = engine.pick_place("picker")
    picker.configure(blending_radius=0, z_start_distance=0, z_target_distance=0).wait()  # straight along X
    picker.control(override_factor=0.5).wait()
    targets = []
    for x_target in (50, 200, 20):
        picker.configure(x_target=x_target).wait()
        targets.append(picker.execute())
    record = engine.record("x")
    targets[0].wait()
    assert np.abs(record.stop()["x"]["set_acceleration"]).max() <= 0.5 * 8000 * 1.001
    picker.control(override_factor=1).wait()
    targets[1].wait()
    record = engine.record("x")
    targets[2].wait()
    assert np.abs(record.stop()["x"]["set_acceleration"]).max() > 0.6 * 8000


@pytest.mark.parametrize("off_s", [0.001, 0.03])
def test_power_asked_for_while_the_tool_brakes_is_given_at_rest(engine: takt.Engine, off_s: float) -> None:
    """PP-02: the rising edge of regulator_on counts while the axes are still being switched off."""
    picker = engine.pick_place("picker")
    picker.execute()
    engine.run(0.1)
    picker.control(regulator_on=False).wait()
    engine.run(off_s)
    assert engine.group("portal").state is takt.GroupState.GROUP_MOVING
    picker.control(regulator_on=True).wait()
    engine.run(1)
    assert (picker.axes_enabled, picker.axes_group_enabled) == (True, True)
    picker.execute().wait()


def test_power_withdrawn_while_the_tool_brakes_is_not_given(engine: takt.Engine) -> None:
    """PP-02: the level of regulator_on counts once the axes are off."""
    picker = engine.pick_place("picker")
    picker.execute()
    engine.run(0.1)
    for level in (False, True, False):
        picker.control(regulator_on=level).wait()
    engine.run(1)
    assert not picker.axes_enabled


@pytest.mark.parametrize(
    ("setting", "then"),
    [
        ({"target_coordinate_system": "pcs", "target_pcs": 15}, {"target_pcs": 14}),
        ({"target_coordinate_system": "pcs", "target_pcs": 3, "workpiece_pcs2": 3}, {"workpiece_pcs2": 4}),
    ],
)
def test_a_target_in_a_system_of_workpieces_is_refused(
    engine: takt.Engine, setting: dict[str, str | int], then: dict[str, int]
) -> None:
    """PP-14: in the file and at run time, whichever is changed; each pick would move the target onto its belt."""
    wrong = "target_pcs must be another one than workpiece_pcs1 and workpiece_pcs2"
    text = ", ".join(f"{name}: {value}" for name, value in setting.items())
    with pytest.raises(takt.ConfigError, match=wrong):
        takt.Engine(MACHINE.replace("{path_velocity", f"{{{text}, path_velocity"))
    picker = engine.pick_place("picker")
    feedback = picker.configure(**setting).wait_final()
    assert (feedback.error_id, wrong in str(feedback.sentence)) == (5, True)
    picker.configure(**setting | then).wait()
    for name, value in setting.items():
        if name != "target_coordinate_system":
            taken = picker.configure(**{name: value}).wait_final().error_id
            assert taken == (5 if then.get(name, value) != value else 0)
    picker.configure(target_coordinate_system="mcs").wait()
    picker.configure(**{name: value for name, value in setting.items() if name != "target_coordinate_system"}).wait()
    assert picker.configure(target_coordinate_system="pcs").wait_final().error_id == 5


def test_a_system_of_a_waiting_target_is_not_given_to_workpieces(engine: takt.Engine) -> None:
    """PP-16: later settings do not change a profile that was accepted."""
    picker = engine.pick_place("picker")
    picker.configure(target_coordinate_system="pcs", target_pcs=3).wait()
    going = picker.execute()
    picker.configure(target_coordinate_system="mcs").wait()
    assert picker.configure(workpiece_pcs1=3).wait_final().error_id == 5
    going.wait()
    engine.run(0.01)
    picker.configure(workpiece_pcs1=3).wait()


def test_a_target_in_acs_is_refused(engine: takt.Engine) -> None:
    """PP-14: in the file and at run time."""
    wrong = "target_coordinate_system must not be acs"
    with pytest.raises(takt.ConfigError, match="target_coordinate_system: must not be acs"):
        takt.Engine(MACHINE.replace("{path_velocity", "{target_coordinate_system: acs, path_velocity"))
    feedback = engine.pick_place("picker").configure(target_coordinate_system="acs").wait_final()
    assert (feedback.error_id, wrong in str(feedback.sentence)) == (5, True)


@pytest.mark.parametrize("waits", [False, True])
@pytest.mark.parametrize("change", [{"z": -50}, {"c": 30}, {"c": 0.1}])
def test_a_tool_that_is_set_anew_parks_again(engine: takt.Engine, change: dict[str, float], waits: bool) -> None:
    """PP-42: the parking position is one of the tool."""
    picker, group = engine.pick_place("picker"), engine.group("portal")
    engine.axis("drive").move_velocity(velocity=100).wait(until="reached")
    if not waits:
        engine.belt("infeed").detect(x=50).wait()
    picker.execute(1)
    engine.wait(lambda: picker.in_park_position, 5)
    engine.run(0.5)
    assert picker.in_park_position
    group.set_tool(**change).wait()
    if not waits:
        engine.run(0.01)
        assert not picker.in_park_position
        picker.execute(1)
    engine.run(1)
    assert picker.in_park_position
    assert picker.position[:3] == pytest.approx((300, 200, 20), abs=0.01)


def test_a_waiting_profile_keeps_its_workpiece_rule(engine: takt.Engine) -> None:
    """PP-16: later settings do not change a profile that was accepted."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=5).wait(until="reached")
    picker.execute(1)
    engine.wait(lambda: picker.in_park_position, 5)
    picker.configure(workpiece_rule="latest").wait()
    for x in (100, 200):
        belt.detect(x=x)
    engine.run(0.01)
    assert picker.workpiece == 2  # the one that leaves the range first


def test_a_workpiece_that_is_deleted_under_the_tool_keeps_its_attributes() -> None:
    """PP-66: it is picked, as the tool stands on it; attributes travel with it to its place."""
    engine = started(LOW)
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=60).wait(until="reached")
    belt.detect(x=50, kind=7, colour=3, quality=0.5).wait()
    picking = picker.execute(1)
    engine.wait(lambda: picker.in_target, 5)
    engine.run(0.1)
    belt.remove(number=1).wait()
    picking.wait()
    assert (picker.picked, picker.held) == (1, 1)
    assert (picker.held_kind, picker.held_colour, picker.held_quality) == (7, 3, 0.5)


def test_more_products_are_held_than_attributes_are_known() -> None:
    """PP-66: all count; those from the ninth on have no attributes."""
    engine = started(MACHINE.replace("sync_time: 0.05", "sync_time: 0"))
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=10).wait(until="reached")
    for kind in range(1, 11):
        belt.detect(x=100, kind=kind).wait()
        picker.execute(1).wait()
    held = []
    for _ in range(10):
        held.append((picker.held, picker.held_kind))
        picker.execute().wait()
    assert held == [(10 - i, i + 1 if i < 8 else 0) for i in range(10)]
    assert picker.held == 0


def test_a_workpiece_without_a_path_is_missed_once_when_it_is_lost() -> None:
    """PP-44: each refusal leaves it on the belt, where it may still be picked."""
    switch = [axis == 8 for axis in range(13)]  # A3

    def refused(engine: takt.Engine) -> None:
        picker = engine.pick_place("picker")
        picker.control(enable_hw_limit=True, hw_limit_negative=switch).wait()
        for _ in range(3):
            engine.run(0.2)
            picker.control(reset_error=False).wait()
            picker.control(reset_error=True).wait()
            engine.run(0.3)
            assert picker.execute(1).wait_final().error_id == 20501
            assert picker.missed == 0
        picker.control(hw_limit_negative=[False] * 13, reset_error=False).wait()
        picker.control(reset_error=True).wait()
        engine.run(0.3)

    for lost in (False, True):
        engine = started()
        picker, belt = engine.pick_place("picker"), engine.belt("infeed")
        belt.axis.move_velocity(velocity=5).wait(until="reached")
        belt.detect(x=200).wait()
        refused(engine)
        if lost:
            belt.axis.move_velocity(velocity=400)
            engine.wait(lambda belt=belt: belt.lost_count == 1, 5)
            engine.run(0.01)
        else:
            picker.execute(1).wait()
        assert (picker.picked, picker.missed, picker.missed_refused) == ((0, 1, 1) if lost else (1, 0, 0))


def test_a_refused_path_from_a_workpiece_is_counted_as_refused(engine: takt.Engine) -> None:
    """PP-44: also where the lift from the workpiece before is interrupted by the refusal."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=20).wait(until="reached")
    picker.control(enable_hw_limit=True, hw_limit_negative=[axis == 6 for axis in range(13)]).wait()  # A1
    engine.run(0.3)
    picker.control(reset_error=True).wait()
    engine.run(0.3)
    for x in (300, 100):
        belt.detect(x=x).wait()
    first, second = picker.execute(1), picker.execute(1)
    first.wait()
    assert second.wait_final().error_id == 20501
    belt.axis.move_velocity(velocity=400)
    engine.wait(lambda: belt.lost_count == 1, 6)
    engine.run(0.01)
    assert (picker.missed, picker.missed_refused, picker.missed_interrupted) == (1, 1, 0)


def path_is_aborted(engine: takt.Engine) -> None:
    picker = engine.pick_place("picker")
    picker.control(path_stop=True).wait()
    engine.run(1)
    picker.control(path_stop=False).wait()
    engine.run(0.1)
    picker.abort()


ENDS: dict[str, Callable[[takt.Engine], object]] = {
    "disabled": lambda engine: engine.pick_place("picker").control(enable=False).wait(),
    "aborted": path_is_aborted,
    "limit switch": lambda engine: (
        engine.pick_place("picker").control(enable_hw_limit=True, hw_limit_negative=[k == 8 for k in range(13)]).wait()
    ),
    "regulator off": lambda engine: engine.pick_place("picker").control(regulator_on=False).wait(),
    "group stopped": lambda engine: engine.group("portal").stop(),
}


@pytest.mark.parametrize("low", [False, True])
@pytest.mark.parametrize("end", ENDS)
def test_a_workpiece_of_an_order_that_was_ended_is_missed(engine: takt.Engine, end: str, low: bool) -> None:
    """PP-44, PP-63: the height of the tool does not matter."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=100).wait(until="reached")
    belt.detect(x=100).wait()
    picker.execute(1)
    engine.wait(lambda: picker.workpiece == 1, 2)
    if low:
        engine.wait(lambda: picker.synchronised and picker.position[2] < -40, 2)
    else:
        engine.run(0.06)
    ENDS[end](engine)
    engine.wait(lambda: belt.lost_count == 1, 10)
    engine.run(0.01)
    assert (picker.picked, picker.missed, picker.missed_interrupted) == (0, 1, 1)


@pytest.mark.parametrize("stop", [{"stop_all": True}, {"regulator_on": False}])
def test_the_twin_of_a_workpiece_that_is_missed_under_the_tool_is_deleted(stop: dict[str, bool]) -> None:
    """PP-66: the gripper may hold the product that was seen twice."""
    engine = started(LOW)
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    belt.axis.move_velocity(velocity=60).wait(until="reached")
    for x in (50, 51, 10):
        belt.detect(x=x).wait()
    picker.execute(1)
    engine.wait(lambda: picker.in_target, 5)
    engine.run(0.1)
    assert picker.workpiece == 2
    picker.control(**stop).wait()
    engine.run(0.5)
    assert (picker.missed, picker.missed_interrupted, picker.picked) == (1, 1, 0)
    assert [thing.number for thing in belt.objects] == [3]


def test_what_a_module_does_not_take_is_not_missed() -> None:
    """PP-63, PP-66, PP-67: of another kind, or of the turn of another module."""
    for own, missed in (("kind: 1", 1), ("every: 2", 2), ("sync_time: 0", 3)):
        engine = started(MACHINE.replace("sync_time: 0.05", own))
        picker, belt = engine.pick_place("picker"), engine.belt("infeed")
        belt.axis.move_velocity(velocity=100).wait(until="reached")
        picker.execute(1)
        engine.run(0.5)
        for kind in (1, 2, 2):
            belt.detect(x=595, kind=kind)
        engine.run(0.5)
        assert (belt.lost_count, picker.missed, picker.missed_too_late) == (3, missed, missed)


def test_a_workpiece_that_a_stop_left_and_others_fetch_is_counted_by_its_number(engine: takt.Engine) -> None:
    """PP-63: the next one that is lost is missed, too."""
    picker, belt = left_by_a_stop(engine)
    engine.run(2)
    assert (picker.missed_interrupted, belt.object_count) == (1, 1)
    belt.remove(number=1).wait()
    picker.control(stop_all=False)
    engine.run(0.3)
    picker.execute(1)
    engine.run(0.5)
    belt.detect(x=550)
    engine.run(1)
    assert (picker.missed, picker.missed_interrupted, picker.missed_too_late) == (2, 1, 1)


def test_profiles_given_on_the_way_to_the_parking_position_begin_where_those_before_end(engine: takt.Engine) -> None:
    """PP-10, PP-42: the last one rises from the target before."""
    picker, belt = engine.pick_place("picker"), engine.belt("infeed")
    picker.configure(path_velocity=200, blending_radius=0).wait()
    belt.axis.move_velocity(velocity=100).wait(until="reached")
    belt.detect(x=50).wait()
    picker.execute(1).wait()
    engine.run(0.1)
    assert picker.target == 0
    assert not picker.in_park_position
    going = picker.execute()
    engine.wait(lambda: picker.profile_point_passed == 1, 10)
    picker.configure(x_target=200).wait()
    then = picker.execute()
    going.wait()
    record = engine.record("portal")
    then.wait()
    assert record.stop()["portal"]["z"].max() == pytest.approx(30, abs=0.1)
