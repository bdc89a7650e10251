"""PY-23: torque that the drive is told to add, from set point and load: following errors before and after, and loads
that are identified."""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np
import pytest
import takt
import yaml
from takt.load import identify
from takt.ready import EXAMPLES

DELTA: dict[str, Any] = yaml.safe_load((EXAMPLES / "delta_cell" / "machine.yaml").read_text(encoding="utf-8"))
SERVO: dict[str, Any] = {
    "name": "lift",
    "axes": [{"name": "z", "unit": "mm", "limits": {"velocity": 500, "acceleration": 8000, "jerk": 200000}}],
    "simulation": {
        "servos": [
            {
                "axis": "z",
                "drive": {"velocity_time_constant_s": 0.003, "max_torque": 50},
                "mechanics": {
                    "inertia": 0.002,
                    "coulomb_friction": 1.5,
                    "viscous_friction": 0.004,
                    "load_torque": 4,
                    "brake_torque": 20,
                },
            }
        ]
    },
}
IDENTIFIED = {"inertia": 0.002, "coulomb_friction": 1.5, "viscous_friction": 0.004, "load_torque": 4.0}


def with_offset(machine: dict[str, Any], offset: dict[str, float]) -> dict[str, Any]:
    axes = [{**axis, "drive": {**axis.get("drive", {}), "torque_offset": offset}} for axis in machine["axes"]]
    return {**machine, "axes": axes}


def error(recording: takt.Recording, axis: str) -> float:
    table = recording[axis]
    return float(np.sqrt(np.mean(table["following_error"][table["loop_closed"].astype(bool)] ** 2)))


def up_and_down(machine: dict[str, Any], axis: str, **options: Any) -> takt.Recording:
    with takt.Engine(machine, **options) as engine:
        record = engine.record()
        for power in [one.power() for one in engine.axes.values()]:
            power.wait()
        for distance, velocity in ((100, 400), (-60, 150), (-40, 300)):
            engine.axis(axis).move_relative(distance=distance, velocity=velocity).wait()
        return record.stop()


def test_the_load_of_a_servo_is_identified_and_told_to_its_drive() -> None:
    """What the simulation has, whose torque is that at the end of a cycle; with it, the axis follows several times as
    well."""
    before = up_and_down(SERVO, "z")
    found = identify(before, "z")
    assert found.inertia == pytest.approx(0.002, rel=0.1)
    assert found.coulomb_friction == pytest.approx(1.5, rel=0.15)
    assert found.viscous_friction == pytest.approx(0.004, rel=0.25)
    assert found.load_torque == pytest.approx(4, rel=0.03)
    assert found.residual_rms < 0.05 * found.torque_rms
    with pytest.warns(DeprecationWarning, match="residual_rms now"):
        assert found.left == found.residual_rms
    with pytest.warns(DeprecationWarning, match="torque_rms now"):
        assert found.of == found.torque_rms
    told = yaml.safe_load(found.machine_file())["drive"]["torque_offset"]
    after = up_and_down(with_offset(SERVO, told), "z")
    assert error(after, "z") < 0.25 * error(before, "z")
    still = np.abs(after["z"]["following_error"][-20:])
    assert still.max() < 0.02
    again = identify(after, "z")
    assert again.inertia == pytest.approx(found.inertia, rel=0.05)


def test_where_the_loop_is_open_nothing_is_fitted() -> None:
    """A torque of 0 while the axis coasts, its power off in the middle of a recording, says nothing of its load."""
    table = up_and_down(SERVO, "z")["z"].copy()
    moving = np.flatnonzero(np.abs(table["set_velocity"]) > 100)
    coasts = moving[len(moving) // 4 : len(moving) // 2]
    table["torque_nm"][coasts] = 0
    table["loop_closed"][coasts] = False
    found = identify(takt.Recording({"z": table}), "z")
    assert found.inertia == pytest.approx(0.002, rel=0.1)
    assert found.coulomb_friction == pytest.approx(1.5, rel=0.15)
    assert found.load_torque == pytest.approx(4, rel=0.05)


def test_the_load_of_an_axis_in_mujoco_is_identified() -> None:
    """A lift of 5 kg with friction, which a physics that is not ours moves."""
    pytest.importorskip("mujoco")
    twin = {
        "axes": [
            {
                "axis": "z",
                "max_torque": 400,
                "mass": 5,
                "direction": "z",
                "coulomb_friction": 3,
                "viscous_friction": 20,
            }
        ]
    }
    found = identify(up_and_down({**SERVO, "twin": twin}, "z", plant="mujoco"), "z")
    assert found.inertia == pytest.approx(0.005, rel=0.03)  # N s2/mm
    assert found.load_torque == pytest.approx(5 * 9.81, rel=0.02)
    # MuJoCo's friction is soft about standstill: what it is at the speeds that were driven is what counts.
    for speed in (150, 300, 400):
        assert found.coulomb_friction + found.viscous_friction * speed == pytest.approx(3 + 0.02 * speed, rel=0.12)


def test_a_delta_in_mujoco_follows_better_with_it() -> None:
    """Each arm for itself, as if its inertia did not depend on the pose: a physics that is not ours agrees."""
    pytest.importorskip("mujoco")

    def errors(machine: dict[str, Any]) -> tuple[float, float]:
        with takt.Engine(machine, plant="mujoco") as engine:
            robot = engine.group("robot")
            robot.power().wait()
            robot.enable().wait()
            record = engine.record()
            for x, y, z in ((0, 0, -760), (150, 60, -800), (-120, 80, -780), (0, -150, -800), (0, 0, -760)):
                robot.move_direct_absolute(x=x, y=y, z=z, coordinate_system="mcs").wait()
            recording = record.stop()
            found = [error(recording, axis) for axis in engine.axes]
            return max(found), float(engine.plant.built.inertia[0])  # type: ignore[union-attr]

    groups = [{name: value for name, value in group.items() if name != "paths"} for group in DELTA["groups"]]
    axes = [{**axis, "supervision": {**axis["supervision"], "deviation_moving": 1.0}} for axis in DELTA["axes"]]
    bare = {name: value for name, value in DELTA.items() if name != "paths"} | {"axes": axes, "groups": groups}
    before, inertia = errors(bare)
    offset = {
        "inertia": inertia * math.radians(1),
        "coulomb_friction": 0.1,
        "viscous_friction": 0.05 * math.radians(1),
    }
    after, _ = errors(with_offset(bare, offset))
    assert after < 0.5 * before, (before, after)


def test_a_payload_that_is_gripped_is_told_at_run_time() -> None:
    """GR-46: with the load told as it comes the axis follows as without one; power off, a clone and what is left out
    leave it as it is."""
    heavy = copy.deepcopy(SERVO)
    heavy["simulation"]["servos"][0]["mechanics"] |= {"inertia": 0.004, "load_torque": 9}

    def worst(machine: dict[str, Any], told: dict[str, float] | None) -> float:
        with takt.Engine(with_offset(machine, IDENTIFIED), journal=True) as engine:
            axis = engine.axis("z")
            axis.power().wait()
            if told is not None:
                axis.set_load(**told).wait()
                axis.set_load().wait()
                axis.power(enable=False).wait()
                axis.power().wait()
            goes_on = engine.clone()
            found = []
            for one in (engine, goes_on):
                with one.record() as recorder:
                    one.axis("z").move_relative(distance=100).wait()
                found.append(error(recorder.recording, "z"))
            assert found[0] == found[1]
            return found[0]

    empty, wrong = worst(SERVO, None), worst(heavy, None)
    right = worst(heavy, {"inertia": 0.004, "load_torque": 9.0})
    assert wrong > 2 * empty
    assert right < 1.1 * empty


def test_a_load_that_cannot_be() -> None:
    """GR-46: values, an axis without `torque_offset`, a member of a group that moves."""
    with takt.Engine(SERVO) as engine:
        assert engine.axis("z").set_load(load_torque=1.0).wait_final().error_id == 3005
    group = {"name": "g", "axes": ["z"], "path": {"velocity": 100, "acceleration": 1000, "jerk": 20000}}
    with takt.Engine(with_offset(SERVO, {}) | {"groups": [group]}) as engine:
        axis = engine.axis("z")
        for wrong in ({"inertia": -1.0}, {"load_torque": 1e12}, {"coulomb_friction": math.nan}):
            refused = axis.set_load(**wrong).wait_final()
            assert refused.error_id == 5
            assert next(iter(wrong)) in refused.sentence
        engine.group("g").power().wait()
        engine.group("g").enable().wait()
        move = engine.group("g").move_direct_absolute(a1=50.0)
        engine.run(0.1)
        axis.set_load(load_torque=4.0).wait()
        move.wait()


def test_what_does_not_fit() -> None:
    """Values out of range, with line and key; recordings that say too little."""
    text = yaml.safe_dump(with_offset(SERVO, {**IDENTIFIED, "inertia": -1}))
    with pytest.raises(takt.ConfigError, match=r"axes\[0\]\.drive\.torque_offset\.inertia: expected"):
        takt.Engine(text)
    analog = with_offset(SERVO, IDENTIFIED)
    analog["axes"][0]["drive"]["mode"] = "analog"
    with pytest.raises(takt.ConfigError, match=r"drive\.torque_offset: needs a mode other than analog"):
        takt.Engine(analog)
    with takt.Engine(SERVO) as engine:
        record = engine.record()
        engine.step(50)
        short = record.stop()
        record = engine.record()
        engine.axis("z").power().wait()
        engine.run(0.3)
        still = record.stop()
        record = engine.record()
        engine.axis("z").move_velocity(velocity=100)
        engine.run(0.5)
        one_way = record.stop().slice(0.6, 1.0)
    with pytest.raises(takt.RecordingError, match="0 samples with a closed loop, at least 116"):
        identify(short, "z")
    with pytest.raises(takt.RecordingError, match="it does not move in this recording"):
        identify(still, "z")
    with pytest.raises(takt.RecordingError, match=r"it does not move|both ways"):
        identify(one_way, "z")
