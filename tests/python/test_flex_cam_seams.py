"""Seams of cam modules through the public face: clutch, ramps, sequences and changes where they meet (CAM-81 to 86)."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import takt

SYNC_PASSED, WOULD_REVERSE, CAM_OVER, OPEN_CAM = 3110, 3020, 3114, 3115
LINE = {"name": "line", "cyclic": True, "segments": [{"to": {"x": 100, "y": 100}, "law": "line"}]}
AT_ONCE = {"slave_absolute": True, "sync_mode": "absolute"}
STRONG = "velocity: 100000, acceleration: 100000000, jerk: 1000000000000"


def hill(name: str, height: float, length: float = 360) -> dict[str, Any]:
    law = "polynomial_345"
    segments = [{"to": {"x": length / 2, "y": height}, "law": law}, {"to": {"x": length, "y": 0}, "law": law}]
    return {"name": name, "cyclic": True, "segments": segments}


def rise(name: str, length: float, stroke: float, **law: Any) -> dict[str, Any]:
    segments = [{"to": {"x": length, "y": stroke}, "law": "polynomial_345", **law}]
    return {"name": name, "cyclic": not law, "segments": segments}


class Rig:
    """A web of any speed, and a knife with strong limits on a cam module."""

    def __init__(self, *cams: dict[str, Any], settings: dict[str, Any], slave: str = "linear", limits: str = STRONG):
        kind = "rotary, modulus: 360" if slave == "rotary" else slave
        module = {"name": "m", "slave": "knife", "master": "web", "cams": [c["name"] for c in cams]}
        self.engine = takt.Engine(
            "name: t\naxes:\n"
            "  - {name: web, unit: mm, limits: {velocity: 2000, acceleration: 20000, jerk: 2000000}}\n"
            f"  - {{name: knife, unit: mm, kind: {kind}, limits: {{{limits}}}}}\n"
            f"cams: {json.dumps(cams)}\nflex_cams: {json.dumps([{**module, 'settings': settings}])}\n"
        )
        self.web, self.knife, self.module = (
            self.engine.axis("web"),
            self.engine.axis("knife"),
            self.engine.flex_cam("m"),
        )
        self.web.power().wait()
        self.module.control(regulator_on=True).wait()
        self.engine.wait(lambda: self.module.axis_enabled, 2.0)

    def __enter__(self) -> Rig:
        return self

    def __exit__(self, *_: object) -> None:
        self.engine.close()

    def run(self, velocity: float) -> Any:
        return self.web.move_velocity(velocity=abs(velocity), direction="negative" if velocity < 0 else "positive")

    def seconds(self, seconds: float) -> Any:
        """Recorded."""
        recorder = self.engine.record()
        self.engine.run(seconds)
        return recorder.stop()


def steps_of_speed(recording: Any) -> float:
    """Largest change of the slave's velocity that its acceleration does not explain."""
    v, a = recording["knife"]["set_velocity"], recording["knife"]["set_acceleration"]
    return float(np.abs(np.diff(v) - (a[1:] + a[:-1]) / 2 * 0.001).max())


ON_CURVE = {**AT_ONCE, "sync_mode": "ramp_pos", "master_sync_in_position": 0}


@pytest.mark.parametrize(
    ("slave", "velocity", "at", "closes"),
    [
        ("linear", 300, -60, True),
        ("linear", -300, 60, True),
        ("linear", -300, -60, False),
        ("rotary", 300, 100, True),
        ("rotary", -300, 100, True),
        ("rotary", -300, 10, True),
    ],
)
def test_without_reversing_a_clutch_goes_with_its_master_in_both_directions(slave, velocity, at, closes):  # CAM-37
    cams = rise("stroke", 300, 150) if slave == "linear" else LINE
    distance = 30 if slave == "linear" else 100
    settings = {"sync_in_passed": "next_cycle", "position_control": "master_direction"}
    with Rig(cams, settings={**ON_CURVE, **settings, "master_sync_in_distance": distance}, slave=slave) as rig:
        rig.knife.move_absolute(position=at, velocity=5000).wait()
        rig.run(velocity)
        rig.engine.run(0.5)
        feedback = rig.module.control(sync_cam=True)
        recording = rig.seconds(2.5)
        moved = np.diff(recording["knife"]["set_position"])
        if slave == "rotary":
            moved = (moved + 180) % 360 - 180
        closing = recording["m"]["clutch"][1:] == 2
        assert (np.sign(velocity) * moved[closing] > -1e-7).all()
        assert (rig.module.clutch.name == "CLOSED") == closes
        if not closes:
            assert feedback.error_id == WOULD_REVERSE


@pytest.mark.parametrize("again", [False, True], ids=["opened", "opened and closed"])
def test_a_gentle_ramp_does_not_run_away_with_the_cams_acceleration(again: bool) -> None:  # CAM-39, CAM-81
    ramp = {"sync_velocity": 500, "sync_acceleration": 2000, "sync_deceleration": 2000, "sync_jerk": 20_000}
    with Rig(hill("hill", 60, 100), settings={**AT_ONCE, "sync_mode": "ramp_vel_acc", **ramp}) as rig:
        rig.run(1000)
        rig.engine.run(1)
        rig.module.control(sync_cam=True)
        rig.engine.wait(lambda: rig.module.clutch.name == "CLOSED" and rig.knife.set_acceleration > 1e5, 10)
        fast = abs(rig.knife.set_velocity) + 2 * 1e5 * 0.001  # a cycle until it is given, and one until it acts
        rig.module.control(sync_cam=False)
        if again:
            rig.engine.run(0.003)
            rig.module.control(sync_cam=True)
        recording = rig.seconds(2)
        cam = np.abs(recording["web"]["set_velocity"]).max() * 60 / 50 * 1.875 if again else 0
        assert np.abs(recording["knife"]["set_velocity"]).max() <= fast + cam


def test_a_rotary_slave_comes_back_onto_the_cam_in_the_turn_that_it_left():  # CAM-39, CAM-81
    settings = {"master_sync_in_distance": 30, "sync_in_passed": "here", "master_sync_out_distance": 200}
    with Rig(LINE, settings={**ON_CURVE, **settings}, slave="rotary") as rig:
        rig.run(300)
        rig.module.control(sync_cam=True)
        rig.engine.run(1.0)
        rig.module.control(sync_cam=False)
        rig.engine.run(0.5)
        rig.module.control(sync_cam=True)
        rig.engine.run(0.02)
        rig.run(-300)  # back along the curve of the opening
        recording = rig.seconds(1.5)
        assert rig.module.cam_synchronised
        assert np.abs(recording["knife"]["set_velocity"]).max() < 2000
        closed = recording["m"]["clutch"] == 3
        assert recording["m"]["cam_synchronised"][closed].all()


TOGGLE = object()


@pytest.mark.parametrize(
    ("steps", "settings"),
    [
        (["on", 0.1, TOGGLE, 0.05, "off"], {}),
        (["on", 0.5, TOGGLE, 0.05, TOGGLE], {}),
        (["on", 0.5, TOGGLE, 0.05, TOGGLE], {"master_sync_in_distance": 100, "master_sync_out_distance": 200}),
        (["on", 0.5, TOGGLE, 0.05, TOGGLE], {"sync_in_passed": "next_cycle"}),
        (["on", 1.0, "off", 1.2, "on"], {"position_control": "master_direction"}),
        (["on", 0.1, "off", "on"], {}),  # within one cycle
        (
            ["on", 0.5, "off", 0.05, "on", 0.01, "off", "on"],
            {"master_sync_out_distance": 200, "sync_in_passed": "next_cycle"},
        ),
    ],
)
def test_commands_on_curves_make_no_step(steps, settings):  # CAM-39, CAM-81
    curves = {"master_sync_in_distance": 50, "sync_in_passed": "here", "master_sync_out_distance": 50}
    with Rig(LINE, settings={**ON_CURVE, **curves, **settings}) as rig:
        rig.run(300).wait(until="reached")
        recorder = rig.engine.record()
        for step in steps:
            if step is TOGGLE:
                rig.module.control(sync_cam=False)
                rig.engine.run(0.001)
                rig.module.control(sync_cam=True)
            elif isinstance(step, str):
                rig.module.control(sync_cam=step == "on")
            else:
                rig.engine.run(step)
        rig.engine.run(2.0)
        recording = recorder.stop()
        assert steps_of_speed(recording) < 1.0
        assert np.abs(recording["knife"]["set_velocity"]).max() < 6000
        assert recording["m"]["warning"].max() in (0, WOULD_REVERSE)
        closed = recording["m"]["clutch"] == 3
        assert recording["m"]["cam_synchronised"][closed].all()
        assert rig.module.clutch.name == ("OPEN" if steps[-1] == "off" else "CLOSED")


@pytest.mark.parametrize("what", ["scaling_master", "scaling_slave"])
@pytest.mark.parametrize("jerk", [100_000, 10_000])
@pytest.mark.parametrize("mode", ["ramp_absolute", "ramp_relative"])
def test_a_factor_given_while_the_master_brakes_does_not_run_away(what, jerk, mode):  # CAM-83
    settings = {"scaling_mode_master": mode, "scaling_mode_slave": mode, "jerk": jerk}
    with Rig(LINE, settings={**AT_ONCE, **settings}) as rig:
        rig.run(300)
        rig.module.control(sync_cam=True)
        rig.engine.run(1.0)
        rig.web.halt()
        rig.engine.run(0.01)
        rig.module.control(**{what: 2.0})
        recording = rig.seconds(8.0)
        place = recording["knife"]["set_position"]
        assert np.abs(recording["knife"]["set_velocity"]).max() < 620
        assert place.max() < place[-1] + 60
        assert abs(place[-1] - rig.module.mp06_y_to_slave_position) < 1e-6
        assert not rig.module.scaling_master_busy
        assert not rig.module.scaling_slave_busy


@pytest.mark.parametrize("control", ["both", "master_direction"])
@pytest.mark.parametrize("side", ["master", "slave"])
@pytest.mark.parametrize("offset_first", [True, False])
def test_offset_and_factor_in_force_are_between_old_and_new(control, side, offset_first):  # CAM-84
    settings = {f"scaling_mode_{side}": "ramp_absolute", f"offset_mode_{side}": "ramp_in", "position_control": control}
    ramps = {f"offset_scaling_{side}_velocity": 300, f"offset_scaling_{side}_acceleration": 3000, "jerk": 10_000}
    with Rig(LINE, settings={**AT_ONCE, **settings, **ramps}) as rig:
        rig.run(300)
        rig.module.control(sync_cam=True)
        rig.engine.run(0.8)
        recorder = rig.engine.record()
        commands = [{f"offset_{side}": -60.0}, {f"scaling_{side}": 1.5}]
        for command in commands if offset_first else commands[::-1]:
            rig.module.control(**command)
            rig.engine.run(0.02)
        assert getattr(rig.module, f"offset_{side}_busy")
        assert getattr(rig.module, f"scaling_{side}_busy")
        rig.engine.run(6.0)
        recording = recorder.stop()
        factor, offset = recording["m"][f"set_scaling_{side}"], recording["m"][f"set_offset_{side}"]
        assert factor.min() >= 1 - 1e-9
        assert factor.max() <= 1.5 + 1e-9
        assert offset.min() >= -60 - 1e-9
        assert offset.max() <= 1e-9
        assert np.abs(np.diff(offset)).max() < 5  # no step
        assert (factor[-1], offset[-1]) == (1.5, -60)


def test_a_ramp_that_rides_on_a_cam_that_is_over_ends_with_a_warning():  # CAM-82
    once = {**rise("one", 200, 70), "cyclic": False}
    settings = {"cam_cyclic": False, "position_control": "master_direction", "offset_mode_slave": "ramp_in"}
    with Rig(once, settings={**AT_ONCE, **settings}) as rig:
        rig.run(300)
        rig.module.control(sync_cam=True).wait(timeout=3)
        rig.engine.run(1.5)
        feedback = rig.module.control(offset_slave=20.0).wait_final(timeout=1)
        assert feedback.error_id == CAM_OVER
        assert rig.module.warning == CAM_OVER
        assert not rig.module.offset_slave_busy
        assert not rig.module.offset_slave_done


@pytest.mark.parametrize("what", ["offset_master", "offset_slave", "scaling_master", "scaling_slave"])
def test_a_next_x_zero_that_never_comes_is_told(what):  # CAM-82
    once = {**rise("one", 200, 70), "cyclic": False}
    with Rig(once, settings={**AT_ONCE, "cam_cyclic": False}) as rig:
        rig.run(300)
        rig.module.control(sync_cam=True).wait(timeout=3)
        rig.engine.run(1.5)
        rig.module.control(**{what: 2.0})
        rig.engine.run(0.01)
        assert rig.module.warning == CAM_OVER
        assert not getattr(rig.module, f"{what}_busy")


def test_what_holds_a_slave_back_that_catches_up_is_said():  # flex_cam.md "What holds"
    slow = {**LINE, "name": "slow", "segments": [{"to": {"x": 100, "y": 30}, "law": "line"}]}
    with Rig(LINE, slow, settings=AT_ONCE, limits="velocity: 1000, acceleration: 20000, jerk: 2000000") as rig:
        rig.run(300)
        rig.module.control(sync_cam=True)
        rig.engine.run(0.5)
        rig.module.control(cam_table=2)
        recording = rig.seconds(1.0)
        away = np.abs(recording["knife"]["set_position"] - recording["m"]["mp06_y_to_slave_position"]) > 1e-6
        assert away.sum() > 10
        assert recording["knife"]["limited_by"][away].all()
        assert (recording["knife"]["limited_by"][~away] != 0).sum() < 3


def test_an_open_cam_is_run_once_and_says_so():  # CAM-86
    with Rig(rise("one", 200, 70, end_v=0.5), settings=AT_ONCE) as rig:
        rig.run(300)
        rig.module.control(sync_cam=True)
        recording = rig.seconds(3.0)
        assert recording["m"]["cam_ends"][-1] == 1
        assert abs(rig.knife.set_position - 70) < 1e-9
        assert rig.module.warning == OPEN_CAM


CAMS = [hill(name, height) for name, height in (("one", 10), ("two", 20), ("three", 30), ("four", 40))]


def peaks(recording: Any, begin: float = 0.0, count: int = 4) -> list[int]:
    """Of the slave, cycle by cycle of the web."""
    place, web = recording["knife"]["set_position"], np.abs(recording["web"]["set_position"] - begin)
    bounds = pairwise(360 * k for k in range(count + 1))
    return [round(float(place[(web > low) & (web < high)].max())) for low, high in bounds]


@pytest.mark.parametrize("order", [("cam_sequencer", "sync_cam"), ("sync_cam", "cam_sequencer")])
@pytest.mark.parametrize("velocity", [1440, -1440])
def test_a_sequence_runs_all_cams_whichever_is_switched_on_first(order, velocity):  # CAM-86
    with Rig(*CAMS, settings={**AT_ONCE, "cam_sequence_mode": "cam1_cam2_cam3"}) as rig:
        for switch in order:
            rig.module.control(**{switch: True}).wait()
            rig.engine.run(0.05)
        rig.run(velocity)
        assert peaks(rig.seconds(1.2)) == [10, 20, 30, 30]


@pytest.mark.parametrize(("begin", "velocity"), [(720, 1440), (1080, -1440), (-720, -1440), (-360, 1440)])
def test_a_sequence_begins_wherever_a_linear_master_has_got_to(begin, velocity):  # CAM-82, CAM-86
    with Rig(*CAMS, settings={**AT_ONCE, "cam_sequence_mode": "cam1_cam2_cam3"}) as rig:
        rig.web.move_absolute(position=begin, velocity=2000).wait()
        rig.module.control(cam_sequencer=True)
        rig.module.control(sync_cam=True).wait()
        rig.run(velocity)
        assert peaks(rig.seconds(1.2), begin) == [10, 20, 30, 30]


def largest_step_of_y(recording: Any) -> float:
    return float(np.abs(np.diff(recording["m"]["mp06_y_to_slave_position"])).max())


RISES = [rise(name, 100, height) for name, height in (("one", 10), ("two", 20), ("three", 30), ("four", 40))]
ONCE = [rise(name, length, height, end_v=0) for name, length, height in (("a", 100, 10), ("b", 60, 20), ("c", 100, 30))]
RELATIVE = {"slave_absolute": False, "sync_mode": "absolute", "cam_sequence_mode": "cam1_cam3"}


@pytest.mark.parametrize(
    ("change", "to", "back"),
    [
        ({"when": "next_cycle"}, 220, 180),
        ({"when": "next_cycle", "align": "velocity"}, 220, 80),
        ({"when": "at_once"}, 150, 50),
        ({"when": "cam_position", "position": 60}, 170, 50),
    ],
)
def test_a_change_of_cam_ends_a_sequence_so_no_cam_before_it_comes_back(change, to, back):
    """CAM-70, CAM-86: a master that reverses behind the change moves Y on without a step."""
    with Rig(*RISES, settings=RELATIVE) as rig:
        rig.module.control(cam_sequencer=True)
        rig.module.control(sync_cam=True).wait_final()
        rig.web.move_absolute(position=150, velocity=200).wait()
        assert rig.module.cam_table == 3
        rig.module.control(cam_sequencer=False)
        feedback = rig.module.change_cam(cam_table=2, **change)
        rig.web.move_absolute(position=to, velocity=200).wait()
        assert feedback.wait_final().done
        assert rig.module.cam_table == 2
        recorder = rig.engine.record()
        rig.web.move_absolute(position=back, velocity=200).wait()
        assert largest_step_of_y(recorder.stop()) < 0.2
        assert rig.module.cam_table == 2


@pytest.mark.parametrize("absolute", [True, False])
@pytest.mark.parametrize("then", ["next_cycle", "sequencer"])
def test_a_cam_that_is_over_where_it_is_taken_is_held(then, absolute):
    """CAM-70: X is beyond the end of the shorter cam, so what follows begins where X is, not at that end."""
    settings = {**RELATIVE, "cam_cyclic": False, "slave_absolute": absolute}
    with Rig(*ONCE, settings=settings) as rig:
        rig.module.control(sync_cam=True).wait_final()
        rig.web.move_absolute(position=80, velocity=100).wait()
        held = 20 if absolute else rig.knife.set_position  # of the shorter cam
        rig.module.change_cam(cam_table=2, when="at_once")
        if then == "next_cycle":
            rig.module.change_cam(cam_table=3, when="next_cycle", align="position")
        else:
            rig.module.control(cam_sequencer=True)
        rig.engine.run(0.05)
        assert rig.module.cam_table == (3 if then == "next_cycle" else 1)
        assert rig.knife.set_position == pytest.approx(held)
        recorder = rig.engine.record()
        rig.web.move_velocity(velocity=100)
        rig.engine.run(0.3)
        assert largest_step_of_y(recorder.stop()) < 0.1
    with Rig(*ONCE, settings=settings) as rig:  # the cam is as far behind as its end
        rig.module.control(sync_cam=True).wait_final()
        rig.web.move_absolute(position=80, velocity=100).wait()
        rig.module.change_cam(cam_table=2, when="at_once").wait_final()
        rig.web.move_absolute(position=61, velocity=100).wait()
        assert rig.knife.set_position == pytest.approx(held)
        rig.web.move_absolute(position=0, velocity=100).wait()
        assert rig.knife.set_position == pytest.approx(held - 20)


@pytest.mark.parametrize("absolute", [True, False])
@pytest.mark.parametrize("length", [60, 100])
@pytest.mark.parametrize("how", ["at_once", "instant"])
def test_a_cam_held_behind_a_sequence_is_changed_without_a_step(how, length, absolute):
    """CAM-70, CAM-86: X is at the end of the other cam or beyond it; the other cam goes on, as it is cyclic."""
    cams = [RISES[0], rise("two", length, 10), *RISES[2:]]
    with Rig(*cams, settings={**RELATIVE, "slave_absolute": absolute}) as rig:
        rig.module.control(cam_sequencer=True)
        rig.module.control(sync_cam=True).wait_final()
        rig.web.move_absolute(position=150, velocity=200).wait()
        rig.module.control(cam_sequencer=False)
        rig.web.move_absolute(position=330, velocity=200).wait()
        assert rig.knife.set_position == pytest.approx(50)  # cam one is run once, from 200 to 300
        recorder = rig.engine.record()
        if how == "instant":
            rig.module.control(cam_table=2, cam_change_instant=True)
        else:
            rig.module.change_cam(cam_table=2, when=how)
        rig.engine.run(0.05)
        assert rig.module.cam_table == 2
        assert rig.knife.set_position == pytest.approx(50)
        rig.web.move_absolute(position=330 + length, velocity=200).wait()
        assert largest_step_of_y(recorder.stop()) < 0.1
        assert rig.knife.set_position == pytest.approx(60)


@pytest.mark.parametrize(("absolute", "held"), [(True, 10), (False, 10 * 0.94208)])
def test_a_sequence_begins_at_the_end_of_the_cam_that_is_over(absolute, held):
    """CAM-70, CAM-86: the change is made while the sequencer is on, where X is beyond the end of the other cam."""
    cams = [RISES[0], rise("two", 60, 10), *RISES[2:]]
    with Rig(*cams, settings={**RELATIVE, "slave_absolute": absolute}) as rig:
        rig.module.control(cam_sequencer=True)
        rig.module.control(sync_cam=True).wait_final()
        rig.web.move_absolute(position=80, velocity=200).wait()
        rig.module.control(cam_table=2, cam_change_instant=True)
        rig.engine.run(0.05)
        assert rig.module.cam_table == 1
        assert rig.knife.set_position == pytest.approx(held)
        rig.web.move_absolute(position=180, velocity=200).wait()
        assert rig.knife.set_position == pytest.approx(held + 10)


@pytest.mark.parametrize("velocity", [300, -300])
def test_cams_that_meet_at_their_ends_are_changed_there(velocity):  # CAM-70
    with Rig(hill("a", 100, 500), hill("b", 60, 500), settings=AT_ONCE) as rig:
        rig.run(velocity)
        rig.module.control(sync_cam=True)
        rig.engine.run(0.3)
        feedback = rig.module.change_cam(cam_table=2, when="without_jump")
        recording = rig.seconds(2.0)
        assert feedback.done
        assert rig.module.cam_table == 2
        assert recording["m"]["cam_ends"][-1] - recording["m"]["cam_ends"][0] == 1
        assert steps_of_speed(recording) < 1.0


def test_a_change_at_a_position_that_a_master_has_left_behind_warns():  # CAM-70, CAM-82
    with Rig(hill("a", 100, 500), hill("b", 60, 500), settings=AT_ONCE) as rig:
        rig.run(300)
        rig.module.control(sync_cam=True)
        rig.engine.run(0.5)
        rig.module.change_cam(cam_table=2, when="master_position", position=50.0)
        rig.engine.run(0.01)
        assert rig.module.pending_changes == 1
        assert rig.module.warning == SYNC_PASSED


@pytest.mark.parametrize("velocity", [300, -300])
@pytest.mark.parametrize("where", [{"master_sync_position": 200.0}, {"master_start_distance": 0.0}])
def test_cam_in_without_a_distance_gets_into_step_from_its_place_on(where, velocity):  # CAM-82, CAM-90
    with Rig(hill("a", 100, 500), settings=AT_ONCE, limits="velocity: 3000, acceleration: 60000, jerk: 5000000") as rig:
        rig.module.control(enable=False).wait()
        sign = np.sign(velocity)
        rig.knife.cam_in(master="web", cam="a", **{k: sign * v for k, v in where.items()})
        rig.run(velocity)
        record = rig.seconds(4)
        begins = sign * where.get("master_sync_position", 500 if velocity > 0 else 0)
        in_step, web = record["knife"]["in_step"].astype(bool), record["web"]["set_position"]
        first = int(np.argmax(in_step))
        assert in_step.any()
        assert in_step[first:].all()
        if "master_sync_position" in where:
            assert 0 <= sign * web[first] - abs(begins) < 100
        assert np.ptp(record["knife"]["set_position"]) == pytest.approx(100, abs=0.01)
        assert np.abs(record["knife"]["set_acceleration"]).max() <= 60000 * (1 + 1e-9)


def test_cam_in_ends_where_a_linear_master_goes_away_from_its_place():  # CAM-82
    with Rig(hill("a", 100, 500), settings=AT_ONCE) as rig:
        rig.module.control(enable=False).wait()
        feedback = rig.knife.cam_in(master="web", cam="a", master_sync_position=-200.0)
        rig.run(300)
        rig.seconds(1.5)
        assert not feedback._final  # it may come back
        rig.seconds(1)
        assert feedback.error_id == SYNC_PASSED, feedback.sentence
        assert rig.knife.state == "Standstill"


@pytest.mark.parametrize("sense", [1, -1])
def test_gear_in_pos_ends_where_a_linear_master_goes_away_for_good(sense):  # CAM-82, AX-45
    where = {"master_sync_position": -200.0 * sense, "slave_sync_position": 0.0, "master_start_distance": 50.0}
    with Rig(hill("a", 100, 500), settings=AT_ONCE) as rig:
        rig.module.control(enable=False).wait()
        feedback = rig.knife.gear_in_pos(master="web", **where)
        rig.run(1000 * sense)
        rig.seconds(1.9)
        assert not feedback._final  # it may come back: it does 2 m in 1 s
        rig.seconds(0.5)
        assert feedback.error_id == SYNC_PASSED, feedback.sentence
        assert "moves away from it" in feedback.sentence
        assert rig.knife.state == "Standstill"
        again = rig.knife.gear_in_pos(master="web", **where)
        rig.run(-1000 * sense)
        again.wait(until="reached", timeout=4)
        assert rig.knife.set_position == pytest.approx(rig.web.set_position + 200 * sense, abs=1e-6)


@pytest.mark.parametrize("how", ["stop", "halt"])
def test_a_stop_with_an_opening_opens(how):
    with Rig(hill("a", 100, 500), settings=AT_ONCE) as rig:
        rig.run(300)
        rig.module.control(sync_cam=True).wait()
        rig.seconds(0.3)
        feedback = rig.module.control(**{how: True}, sync_cam=False)
        rig.seconds(0.3)
        assert feedback._done, feedback.sentence
        assert rig.module.warning == 0
        assert rig.module.state == "Stop"


@pytest.mark.parametrize("control", [{"offset_master": 40.0}, {"offset_slave": 30.0}, {"scaling_master": 1.5}])
@pytest.mark.parametrize("position_control", ["both", "master_direction"])
def test_an_opening_waits_for_ramps_so_a_master_that_comes_back_finds_the_cam(control, position_control):  # CAM-39
    ramps = {"offset_mode_master": "ramp_in", "offset_mode_slave": "ramp_in", "scaling_mode_master": "ramp_relative"}
    settings = {**ON_CURVE, **ramps, "master_sync_in_distance": 50, "sync_in_passed": "here"}
    settings |= {"master_sync_out_distance": 200, "position_control": position_control}
    with Rig(LINE, settings=settings, slave="rotary") as rig:
        rig.run(300)
        rig.module.control(sync_cam=True).wait()
        rig.module.control(**control)
        rig.seconds(0.05)
        recorder = rig.engine.record()
        rig.module.control(sync_cam=False)
        rig.engine.run(0.02)
        assert rig.module.clutch_waits == "ramps"
        rig.engine.wait(lambda: rig.module.clutch == "opening", 10.0)
        rig.engine.run(0.1)
        rig.module.control(sync_cam=True)
        rig.run(-300)
        rig.engine.run(1.0)
        record = recorder.stop()
        assert rig.module.clutch == "closed"
        assert rig.module.cam_synchronised
        assert steps_of_speed(record) < 40
        assert np.abs(record["knife"]["set_velocity"]).max() < 1500


FIRM = "velocity: 2000, acceleration: 20000, jerk: 2000000"


@pytest.mark.parametrize("velocity", [100, 300])
def test_a_slave_that_is_taken_along_does_not_leave_its_limits_at_once(velocity: float) -> None:
    """CAM-85: with the default ramps of the module; it goes as fast as the web until the limit is near."""
    with Rig(LINE, settings=AT_ONCE, limits=FIRM + ", lower: -500, upper: 150") as rig:
        rig.module.control(sync_cam=True).wait()
        rig.run(velocity)
        knife = rig.seconds(0.8)["knife"]
        assert knife["set_velocity"].max() <= velocity * 1.05
        assert knife["set_position"].max() == pytest.approx(min(150, 0.8 * velocity), abs=2)


@pytest.mark.parametrize("how", ["stop", "halt", "sync_out_instant"])
def test_a_stop_does_not_speed_the_slave_up(how: str) -> None:
    """CAM-12: where the cam accelerates it, the gentle jerk of the stop would go on with that for long."""
    with Rig(hill("up", 300), settings={**AT_ONCE, "stop_jerk": 100_000, "jerk": 100_000}, limits=FIRM) as rig:
        rig.run(500)
        rig.module.control(sync_cam=True).wait(timeout=3)
        rig.engine.wait(lambda: rig.knife.set_velocity > 100 and rig.knife.set_acceleration > 2000, 5)
        before = rig.knife.set_velocity
        rig.module.control(**{how: True})
        assert rig.seconds(1.0)["knife"]["set_velocity"].max() < 1.2 * before


def test_a_clutch_that_waits_to_open_brakes_as_gently() -> None:
    """CAM-85: at a SW limit, with the module's stop_deceleration."""
    settings = {
        **{**AT_ONCE, "sync_mode": "ramp_pos", "stop_deceleration": 2000, "stop_jerk": 100_000},
        **{"master_sync_in_distance": 100, "master_sync_in_position": 200, "master_sync_out_distance": 0.05},
    }
    for opens in (False, True):
        with Rig(LINE, settings=settings, limits=FIRM + ", lower: -500, upper: 500") as rig:
            rig.module.control(sync_cam=True)
            rig.run(300)
            rig.engine.wait(lambda knife=rig.knife: knife.set_position > 430, 5)
            if opens:
                rig.module.control(sync_cam=False)
            knife = rig.seconds(1.0)["knife"]
            assert knife["set_acceleration"].min() == pytest.approx(-2000, rel=0.01)
            assert knife["set_position"].max() == pytest.approx(500, abs=0.5)


def test_a_refused_homing_leaves_the_clutch_to_open() -> None:
    """CAM-81: both in one cycle."""
    settings = {**AT_ONCE, "sync_mode": "ramp_time", "sync_in_time_s": 0.2, "sync_out_time_s": 0.3}
    with Rig(LINE, settings=settings, limits=FIRM) as rig:
        rig.run(100)
        rig.module.control(sync_cam=True).wait(timeout=3)
        opens, homes = rig.module.control(sync_cam=False), rig.module.control(home_execute=True)
        rig.engine.run(1)
        assert homes.error_id == 3005
        assert opens.done
        assert rig.module.clutch == "open"


def test_a_factor_of_nothing_is_refused_wherever_the_master_leads() -> None:
    """CAM-82: in each state, and whichever of the two is told first."""
    settings = {**AT_ONCE, "scaling_mode_slave": "ramp_absolute"}
    with Rig(LINE, settings={**settings, "position_control": "master_direction"}, limits=FIRM) as rig:
        assert rig.module.control(scaling_slave=0.0).wait_final().error_id == WOULD_REVERSE
    with Rig(LINE, settings=settings, limits=FIRM) as rig:
        assert rig.module.control(scaling_slave=0.0).wait_final().done
        refused = rig.module.configure(position_control="master_direction").wait_final()
        assert refused.error_id == WOULD_REVERSE


def test_stop_ends_when_a_command_of_the_slave_has_taken_over() -> None:
    """CAM-10: the state lasts as long as stop or halt is held."""
    with Rig(LINE, settings=AT_ONCE, limits=FIRM) as rig:
        rig.knife.move_velocity(velocity=500)
        rig.engine.run(0.5)
        rig.module.control(halt=True)
        rig.engine.run(0.01)
        rig.module.control(halt=False)
        rig.engine.run(0.005)
        rig.knife.move_velocity(velocity=200)
        rig.engine.run(0.2)
        assert rig.module.state == "Service"
