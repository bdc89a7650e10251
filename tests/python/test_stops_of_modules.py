"""What cam modules and pick and place modules do with their slave or group by themselves, jogs, homing, profiles, ends
with every stop, in whatever cycle it comes, and does not go on by itself (docs/stopping.md, AX-100, CAM-85, PP-03)."""

from __future__ import annotations

import copy
from typing import Any

import pytest
import takt
from takt import _core
from takt.arguments import to_text

FAST = {"velocity": 2000, "acceleration": 20000, "jerk": 400000}
SEARCH = {"method": "switch", "direction": "negative", "velocity": 20}

CAM: dict[str, Any] = {
    "name": "cam",
    "axes": [
        {"name": "web", "limits": {"velocity": 1000, "acceleration": 1000, "jerk": 10000}},
        {
            "name": "saw",
            "limits": {"velocity": 3000, "acceleration": 60000, "jerk": 4000000},
            "homing": SEARCH,
        },
    ],
    "cams": [
        {
            "name": "c",
            "cyclic": True,
            "segments": [
                {"to": {"x": 300, "y": 100}, "law": "modified_sine"},
                {"to": {"x": 600, "y": 0}, "law": "modified_sine"},
            ],
        }
    ],
    "flex_cams": [{"name": "cut", "slave": "saw", "master": "web", "cams": ["c"]}],
}

PICK: dict[str, Any] = {
    "name": "pick",
    "axes": [{"name": n, "limits": FAST} for n in "xyz"] + [{"name": "drive", "limits": FAST}],
    "groups": [
        {
            "name": "gantry",
            "axes": ["x", "y", "z"],
            "kinematics": {"gantry": {"axes": ["x", "y", "z"]}},
            "path": {"velocity": 1000, "acceleration": 10000, "jerk": 200000},
        }
    ],
    "belts": [{"name": "infeed", "axis": "drive", "lower_limit": 0, "upper_limit": 300}],
    "pick_and_place": [
        {
            "name": "picker",
            "group": "gantry",
            "belts": [{"belt": "infeed", "settings": {"park_x": 150, "park_z": 40}}],
            "settings": {
                "tracking_mode": "program",
                "x_target": 300,
                "y_target": 80,
                "z_target": 5,
                "home_by_module": True,
                "homing_order": [1, 1, 1, 0, 0, 0, 0],
            },
            "homing": [{"axis": n, "homing": SEARCH} for n in "xyz"],
        }
    ],
}


def cam(**slave: Any) -> tuple[takt.Engine, Any, takt.Axis]:
    machine = copy.deepcopy(CAM)
    machine["axes"][1] |= slave
    s = takt.Engine(machine)
    s.axis("web").power().wait()
    module = s.flex_cam("cut")
    module.control(regulator_on=True)
    s.wait(lambda: s.axis("saw").powered)
    s.step(2)
    return s, module, s.axis("saw")


def picker() -> tuple[takt.Engine, Any]:
    s = takt.Engine(copy.deepcopy(PICK))
    s.axis("drive").power().wait()
    module = s.pick_place("picker")
    module.control(regulator_on=True)
    s.wait(lambda: s.group("gantry").state.value == "GroupStandby")
    s.step(2)
    return s, module


OF_CAM = {
    "jog": lambda m: m.jog(positive=True),
    "homing": lambda m: m.control(home_execute=True),
}
STOPS_OF_CAM = {
    "emergency stop": lambda s, _: s.command("machine", "emergency_stop"),
    "stop_all": lambda s, _: s.command("machine", "stop_all"),
    "stop_all, loops open": lambda s, _: s.command("machine", "stop_all", {"open_loops": True}),
    "stop": lambda _, m: m.control(stop=True),
    "halt": lambda _, m: m.control(halt=True),
    "enable false": lambda _, m: m.control(enable=False),
    "regulator off": lambda _, m: m.control(regulator_on=False),
    "power off": lambda s, _: s.axis("saw").power(enable=False),
}


@pytest.mark.parametrize(
    ("machine", "name", "releases"),
    [
        (CAM, "cut", {"sync_cam": False}),
        (CAM, "cut", {"virtual_velocity": 0}),
        (PICK, "picker", {"override_factor": 0}),
    ],
)
def test_what_asks_for_power_does_not_pass_for_a_stop(
    machine: dict[str, Any], name: str, releases: dict[str, Any]
) -> None:
    """AX-100, EN-33: inputs of a module that ask for power and release something are refused in the cycle of an
    emergency stop, and grow old."""
    with takt.Engine(machine) as s:
        s.command("machine", "emergency_stop", {})
        asked = s.command(name, "control", {"regulator_on": True, **releases})
        s.run(0.5)
        assert asked.error_id == 3100
        assert not any(axis.loop_closed for axis in s.axes.values())
        kind = s.components[name].KIND
        assert _core.lets_go(kind, "control", to_text(releases))
        assert not _core.lets_go(kind, "control", to_text({"regulator_on": True, **releases}))


@pytest.mark.parametrize("stop", STOPS_OF_CAM)
@pytest.mark.parametrize("motion", OF_CAM)
@pytest.mark.parametrize("cycles", [0, 1, 100])
def test_what_a_cam_module_moves_by_itself_ends_with_every_stop(motion: str, stop: str, cycles: int) -> None:
    s, module, saw = cam()
    feedback = OF_CAM[motion](module)
    if cycles:
        s.step(cycles)
    STOPS_OF_CAM[stop](s, module)
    s.run(0.5)
    assert feedback.final
    assert not feedback.done
    assert saw.set_velocity == 0
    module.control(reset_error=True, stop=False, halt=False, enable=True, regulator_on=False)
    s.step(2)
    module.control(regulator_on=True)
    s.step(2)
    at = saw.set_position
    s.run(0.3)
    assert saw.set_position == at
    assert saw.powered


OF_PICKER = {
    "jog": lambda m: m.jog(positive=True),
    "homing": lambda m: m.control(home_execute=True),
    "profile": lambda m: m.control(execute=True),
}
STOPS_OF_PICKER = {
    "emergency stop": lambda s, _: s.command("machine", "emergency_stop"),
    "stop_all": lambda s, _: s.command("machine", "stop_all"),
    "stop_all, loops open": lambda s, _: s.command("machine", "stop_all", {"open_loops": True}),
    "group stop": lambda s, _: s.group("gantry").stop(),
    "group halt": lambda s, _: s.group("gantry").halt(),
    "group disable": lambda s, _: s.group("gantry").disable(),
    "group power off": lambda s, _: s.group("gantry").power(enable=False),
    "power off of a member": lambda s, _: s.axis("x").power(enable=False),
    "enable false": lambda _, m: m.control(enable=False),
    "regulator off": lambda _, m: m.control(regulator_on=False),
}


@pytest.mark.parametrize("stop", STOPS_OF_PICKER)
@pytest.mark.parametrize("motion", OF_PICKER)
@pytest.mark.parametrize("cycles", [0, 1, 100])
def test_what_a_pick_and_place_module_is_about_ends_with_every_stop(motion: str, stop: str, cycles: int) -> None:
    s, module = picker()
    module.control(select_axis="x")
    feedback = OF_PICKER[motion](module)
    if cycles:
        s.step(cycles)
    asked = STOPS_OF_PICKER[stop](s, module)
    s.run(0.8)
    assert asked.final, asked
    assert feedback.final, feedback
    assert not feedback.done, feedback
    assert module.warning != 3021
    assert all(s.axis(n).set_velocity == 0 for n in "xyz")
    module.control(reset_error=True, enable=True, regulator_on=False)
    s.run(0.1)
    s.group("gantry").power().wait_final()
    s.group("gantry").enable().wait_final()
    s.step(2)
    at = [s.axis(n).set_position for n in "xyz"]
    s.run(0.3)
    assert [s.axis(n).set_position for n in "xyz"] == at


@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("motion", ["jog", "homing", "sync"])
def test_nothing_begins_towards_a_limit_switch_of_a_cam_module(motion: str, sense: str) -> None:
    s, module, saw = cam(homing={"method": "switch", "direction": sense, "velocity": 50})
    s.axis("web").move_absolute(position=300).wait()
    if motion == "sync":  # the cam is at 100 there
        module.configure(sync_mode="absolute", slave_absolute=True)
        saw.move_absolute(position=50 if sense == "positive" else 150).wait()
    module.control(enable_hw_limit=True, **{f"hw_limit_{sense}": True})
    s.run(0.1)
    module.control(reset_error=True)
    s.run(0.1)
    at = saw.set_position
    recording = s.record("saw")
    if motion == "jog":
        feedback = module.jog(**{sense: True})
    else:
        feedback = module.control(**{"sync_cam" if motion == "sync" else "home_execute": True})
    s.run(0.5)
    assert (recording.stop()["saw"]["set_position"] == at).all()
    assert feedback.error_id == (20500 if sense == "positive" else 20501)
    assert module.error == feedback.error_id
