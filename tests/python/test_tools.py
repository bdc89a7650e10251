"""Tools that are changed while the machine runs (GR-46)."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
import takt
from takt import expect

PARAMETER, STATE, COLLISION = 5, 3005, 3024
TOOL = {"x": 40.0, "y": 10.0, "z": -60.0, "a": 0.0, "b": 0.0, "c": 30.0}
MACHINE: dict[str, Any] = {
    "name": "cell",
    "axes": [
        {"name": name, "limits": {"velocity": 500, "acceleration": 5000, "jerk": 100000}}
        for name in ("x", "y", "z", "c")
    ],
    "groups": [
        {
            "name": "g",
            "axes": ["x", "y", "z", "c"],
            "kinematics": {"gantry": {"axes": ["x", "y", "z", "c"]}},
            "tool": {"z": -20},
            "path": {"velocity": 500, "acceleration": 5000, "jerk": 100000},
        }
    ],
}


def ready(machine: dict[str, Any] = MACHINE) -> tuple[takt.Engine, takt.Group]:
    s = takt.Engine(copy.deepcopy(machine), journal=True)
    g = s.group("g")
    g.power().wait()
    g.enable().wait()
    return s, g


def test_places_are_those_of_the_new_tool_and_no_axis_moves() -> None:
    """GR-46: what is seen, and where moves lead; there and back again."""
    s, g = ready()
    with s:
        assert g.tool == (0, 0, -20, 0, 0, 0)
        g.move_linear_absolute(x=100, y=50, z=-100).wait()
        with s.record("x", "y", "z", "c") as recorder:
            assert g.set_tool(**TOOL).wait().done
            s.step(2)
        assert all(np.ptp(np.asarray(recorder.recording[axis]["set_position"])) == 0 for axis in "xyzc")
        assert g.tool == tuple(TOOL.values())
        assert g.pose == pytest.approx((140, 60, -140, 0, 0, 30))
        with s.record("x", "y", "z", "c") as recorder:
            assert g.move_linear_absolute(x=200, y=80, z=-150, c=75).wait().done
        for axis in "xyzc":
            expect.within_limits(recorder.recording, axis)
        assert g.pose == pytest.approx((200, 80, -150, 0, 0, 75))
        turn = np.radians(45)
        flange = (200 - 40 * np.cos(turn) + 10 * np.sin(turn), 80 - 40 * np.sin(turn) - 10 * np.cos(turn), -90, 45)
        assert [s.axis(axis).set_position for axis in "xyzc"] == pytest.approx(flange)
        assert g.set_tool(z=-20).wait().done
        s.step(2)
        assert g.pose == pytest.approx((*flange[:2], -110, 0, 0, 45))


def test_a_tool_stays_through_stops_and_in_a_copy_of_the_engine() -> None:
    """GR-46: until the next one."""
    s, g = ready()
    with s:
        g.set_tool(**TOOL).wait()
        s.command("machine", "emergency_stop").wait()
        s.run(0.1)
        g.reset().wait()
        g.power().wait()
        assert g.tool == tuple(TOOL.values())
        with s.clone() as other:
            assert other.group("g").tool == tuple(TOOL.values())
            other.group("g").move_linear_absolute(x=90, y=40, z=-90).wait()
            assert other.group("g").pose[:3] == pytest.approx((90, 40, -90))
        assert s.command("machine", "stop_all").wait().done


def test_a_tool_is_changed_at_rest_only() -> None:
    """GR-46: refused, and nothing has changed, while the group moves, is interrupted, jogs, streams or has a fault."""
    s, g = ready()
    with s:
        g.move_linear_absolute(x=100, y=50, z=-100).wait()

        def refused() -> None:
            assert g.set_tool(**TOOL).wait_final().error_id == STATE
            assert g.tool == (0, 0, -20, 0, 0, 0)

        g.move_linear_absolute(x=0)
        refused()
        s.run(0.1)
        refused()
        g.interrupt().wait()
        refused()
        g.halt().wait()
        jog = g.jog(x=20)
        s.run(0.1)
        refused()
        jog.release()
        s.run(0.3)
        stream = g.stream(key=1)
        s.run(0.01)
        refused()
        g.halt().wait()
        assert stream.aborted
        stop = g.stop(hold=True).wait()
        refused()
        stop.release()
        s.step(2)
        s.command("machine", "fail_all_axes")
        s.step(3)
        refused()
        for axis in s.axes.values():
            axis.reset()
        s.run(0.1)
        g.reset().wait()
        assert g.set_tool(**TOOL).wait().done
        g.disable().wait()
        assert g.set_tool(z=-20).wait().done  # disabled, too


@pytest.mark.parametrize(
    ("arguments", "field"),
    [({"x": 1e10}, "x"), ({"c": float("nan")}, "c"), ({"a": 1e7}, "a"), ({"z": "low"}, "z")],
)
def test_numbers_that_are_none_are_refused(arguments: dict[str, Any], field: str) -> None:
    """EN-22: with a sentence that names the number."""
    s, g = ready()
    with s:
        feedback = s.command("g", "set_tool", arguments).wait_final()
        assert feedback.error_id == PARAMETER
        assert f"{field}: expected" in feedback.sentence
        assert g.tool == (0, 0, -20, 0, 0, 0)


def test_a_group_without_kinematics_has_no_tool() -> None:
    machine = copy.deepcopy(MACHINE)
    del machine["groups"][0]["kinematics"], machine["groups"][0]["tool"]
    s, g = ready(machine)
    with s:
        assert g.set_tool(z=1).wait_final().error_id == PARAMETER


def test_bounds_of_a_workspace_are_for_the_tool_that_is_there() -> None:
    """GR-13, GR-46: the same place of the flange is within them with one tool and not with another."""
    machine = copy.deepcopy(MACHINE)
    machine["groups"][0]["workspace"] = {"margin": 1, "bounds": {"lower": {"z": -150}}}
    s, g = ready(machine)
    with s:
        assert g.move_linear_absolute(x=50, z=-140).wait().done
        g.set_tool(z=-5).wait()
        assert g.move_linear_absolute(x=0, z=-140).wait().done  # with the tool before it, 155 mm down
        g.set_tool(z=-60).wait()
        refused = g.move_linear_absolute(x=50, z=-170).wait_final()
        assert refused.error_id == COLLISION
        assert "lower z" in refused.sentence
