"""Stops of groups (docs/stopping.md): members on limit switches, gantries as members, members that are switched off."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import takt
from takt import expect

LIMITS = {"velocity": 500, "acceleration": 5000, "jerk": 100000}
HARD = {"deceleration": 20000, "jerk": 0}
AWAY_ONLY, DIRECTION, MEMBER, POWER_OFF, AXIS_FAULT = 3006, 3103, 1000, 10, 7


def cell(*, follower: bool = False, switch: str | None = None, path: dict[str, Any] | None = None) -> dict[str, Any]:
    """x and y in a group, and r, which follows x; a limit switch at 150 mm."""
    axes: list[dict[str, Any]] = [{"name": name, "unit": "mm", "limits": LIMITS} for name in ("x", "y")]
    if follower:
        axes.append({"name": "r", "unit": "mm", "limits": LIMITS, "follows": {"axis": "x"}})
    machine: dict[str, Any] = {
        "name": "cell",
        "axes": axes,
        "groups": [
            {
                "name": "g",
                "axes": ["x", "y"],
                "kinematics": {"gantry": {"axes": ["x", "y"]}},
                "path": {"velocity": 500, "acceleration": 5000, "jerk": 100000} | (path or {}),
            }
        ],
    }
    if switch:
        machine["simulation"] = {"servos": [{"axis": switch, "switches": {"limit_positive": {"from": 150}}}]}
    return machine


def ready(machine: dict[str, Any]) -> tuple[takt.Engine, takt.Group]:
    s = takt.Engine(copy.deepcopy(machine))
    for axis in s.axes.values():
        axis.power().wait()
    g = s.group("g")
    g.enable().wait()
    s.step(2)
    return s, g


Give = Callable[[takt.Group], takt.Feedback]
OUTWARDS: dict[str, Give] = {
    "line": lambda g: g.move_linear_relative(x=10),
    "line to a far place": lambda g: g.move_linear_absolute(x=400, y=100),
    "line of axes": lambda g: g.move_linear_relative(a1=10, coordinate_system="acs"),
    "direct": lambda g: g.move_direct_absolute(a1=200, coordinate_system="acs"),
    "arc": lambda g: g.move_circular_relative(circ_mode="border", aux_x=10, aux_y=10, x=20, y=0),
    "jog": lambda g: g.jog(x=10),
    "jog of axes": lambda g: g.jog(a1=10, coordinate_system="acs"),
}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", OUTWARDS)
@pytest.mark.parametrize("switch", ["x", "r"])
def test_nothing_begins_towards_the_switch_of_a_member_or_its_follower(switch: str, name: str) -> None:
    """AX-83, AX-101, PP-60: after a reset the group refuses what leads outwards before anything moves, and names the
    axis; what leads back is taken."""
    s, g = ready(cell(follower=True, switch=switch))
    with s:
        g.move_linear_absolute(x=160, velocity=100)
        s.run(2.5)
        assert s.axis(switch).limit_positive
        for axis in s.axes.values():
            axis.reset()
        s.step(3)
        g.reset().wait()
        stands = s.axis("x").set_position
        with s.record("x", "r") as recorder:
            feedback = OUTWARDS[name](g)
            s.run(0.3)
        assert (feedback.error, feedback.error_id) == (True, AWAY_ONLY)
        assert feedback.sentence.endswith(f": axis {switch}")
        assert feedback.object is s.axis(switch)
        assert all(np.ptp(np.asarray(recorder.recording[axis]["set_position"])) == 0 for axis in "xr")
        assert g.move_linear_relative(x=-20).wait().done
        assert s.axis("x").set_position == pytest.approx(stands - 20)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", OUTWARDS)
@pytest.mark.parametrize("axis", ["x", "r"])
def test_a_direction_that_is_not_enabled_has_its_own_error(axis: str, name: str) -> None:
    """AX-111: 3103 for the direction of a member and of its follower, with the name of the axis."""
    s, g = ready(cell(follower=True))
    with s:
        s.axis(axis).power(enable_positive=False)
        s.step(3)
        feedback = OUTWARDS[name](g)
        s.run(0.2)
        assert (feedback.error_id, s.axis("x").set_position) == (DIRECTION, 0)
        assert feedback.sentence.endswith(f": axis {axis}")


@pytest.mark.filterwarnings("ignore")
def test_a_group_names_the_follower_that_stopped_it() -> None:
    """AX-101: its leader has error 7, and so has the move; the sentence says whose fault it is."""
    s, g = ready(cell(follower=True, switch="r"))
    with s:
        move = g.move_linear_absolute(x=300)
        s.run(1.5)
        assert (move.error_id, move.sentence) == (AXIS_FAULT, "a fault of axis r stopped it")
        assert (s.axis("x").error, s.axis("r").state.value) == (AXIS_FAULT, "ErrorStop")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("verb", ["stop", "halt"])
def test_a_stop_of_a_follower_is_the_matter_of_the_group(verb: str) -> None:
    """GR-03: as one of its leader: refused, and the move goes on."""
    s, g = ready(cell(follower=True))
    with s:
        move = g.move_linear_absolute(x=100)
        s.run(0.1)
        told = {name: s.command(name, verb).wait_final() for name in ("x", "r")}
        assert [told[name].error_id for name in ("x", "r")] == [MEMBER, MEMBER]
        assert told["r"].sentence == "the axis is a member of a group: axis x"
        assert move.wait().done
        g.disable().wait()
        assert s.command("r", verb).wait_final().done


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("how", ["stop_all", "member"])
@pytest.mark.parametrize("cycles", [0, 1, 20])
def test_power_of_a_group_ends_when_a_member_is_switched_off_meanwhile(how: str, cycles: int) -> None:
    """GR-02: it says which one."""
    machine = cell()
    for axis in machine["axes"]:
        axis["drive"] = {"brake_opens_s": 0.1}
    with takt.Engine(machine) as s:
        power = s.group("g").power()
        s.step(cycles)
        if how == "stop_all":
            s.command("machine", "stop_all", {"open_loops": True})
        else:
            s.axis("y").power(enable=False)
        s.run(1)
        assert power.final
        assert not power.done
        assert power.error_id == POWER_OFF
        assert power.sentence == f"the axis is not powered: axis {'x' if how == 'stop_all' else 'y'}"
        assert s.group("g").power().wait().done


@pytest.mark.filterwarnings("ignore")
def test_errors_of_a_group_name_the_member() -> None:
    s, g = ready(cell())
    with s:
        s.axis("y").power(enable=False).wait()
        assert g.move_linear_absolute(x=10).wait_final().sentence == "the axis is not powered: axis y"


# --- how far onto a switch (AX-112) ---


def braked(machine: dict[str, Any], cause: str, *, alone: bool) -> tuple[float, takt.Recording]:
    """How far x goes on for a cause at full speed, in its group or alone."""
    machine = copy.deepcopy(machine)
    if alone:
        del machine["groups"]
    with takt.Engine(machine) as s:
        for axis in s.axes.values():
            axis.power().wait()
        x = s.axis("x")
        with s.record("x", "y") as recorder:
            if alone:
                x.move_velocity(velocity=490)
            else:
                s.group("g").enable().wait()
                s.group("g").move_linear_absolute(x=1500, y=150, velocity=493)
            s.wait(lambda: x.set_position >= 150 if cause != "switch" else x.limit_positive, 5)
            if cause == "direction":
                x.power(enable_positive=False)
            if cause == "all":
                s.command("machine", "fail_all_axes")
            s.run(1.5)
        assert x.set_velocity == 0
        assert x.state is takt.PlcState.ERROR_STOP
    velocity, position = (np.asarray(recorder.recording["x"][key]) for key in ("set_velocity", "set_position"))
    last = np.flatnonzero(velocity > 489.9)[-1]
    assert position[last] == pytest.approx(150, abs=2)
    return float(position[-1] - position[last]), recorder.recording


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("planned_ahead", [False, True])
@pytest.mark.parametrize("path", [1000, 5000])
@pytest.mark.parametrize("ramp", [None, HARD])
@pytest.mark.parametrize("cause", ["switch", "direction"])
def test_a_member_goes_no_further_onto_its_switch_than_alone(
    cause: str, ramp: dict[str, Any] | None, path: float, planned_ahead: bool
) -> None:
    """AX-112, GR-03: whatever the path is like; and on it where that is no longer than its own ramp."""
    machine = cell(
        switch="x" if cause == "switch" else None,
        path={"acceleration": path, "jerk": path * 20, "planned_ahead": planned_ahead},
    )
    if ramp:
        machine["axes"][0] |= {"limit_stop": ramp, "fault_stop": ramp}
    alone, _ = braked(machine, cause, alone=True)
    together, recording = braked(machine, cause, alone=False)
    assert together <= 1.05 * alone + 3 * 490 * 0.001, (together, alone)
    expect.continuous(recording, "y")
    expect.within_limits(recording, "y")
    x, y = (np.asarray(recording[name]["set_position"]) for name in "xy")
    off = np.abs(y - x / 10).max()
    assert off < 1e-6 if ramp is None else off > 0.1, off


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("planned_ahead", [False, True])
def test_a_fault_is_braked_for_along_the_path_as_hard_as_the_axes_can(planned_ahead: bool) -> None:
    """GR-03: not as gently as the path would be braked otherwise."""
    machine = cell(path={"acceleration": 1000, "jerk": 20000, "planned_ahead": planned_ahead})
    alone, _ = braked(machine, "all", alone=True)
    together, recording = braked(machine, "all", alone=False)
    assert together <= 1.05 * alone + 3 * 490 * 0.001, (together, alone)
    for name in "xy":
        expect.within_limits(recording, name)
        expect.continuous(recording, name)
    x, y = (np.asarray(recording[name]["set_position"]) for name in "xy")
    assert np.abs(y - x / 10).max() < 1e-6


# --- what stops a group ranks, and holds ---


def moving(machine: dict[str, Any] | None = None) -> tuple[takt.Engine, takt.Group]:
    s, g = ready(machine or cell())
    g.move_linear_absolute(x=2000)
    s.run(0.3)
    assert s.axis("x").set_velocity > 400
    return s, g


WEAKER: dict[str, Callable[[takt.Engine, takt.Group], takt.Feedback]] = {
    "stop": lambda s, g: g.stop(deceleration=20),
    "held stop": lambda s, g: g.stop(hold=True),
    "halt": lambda s, g: g.halt(deceleration=20),
    "stop_all": lambda s, g: s.command("machine", "stop_all"),
    "move": lambda s, g: g.move_linear_absolute(x=100),
    "buffered move": lambda s, g: g.move_linear_relative(x=50, buffer_mode="buffered"),
    "jog": lambda s, g: g.jog(x=10),
    "power": lambda s, g: g.power(),
    "disable": lambda s, g: g.disable(),
}


@pytest.mark.parametrize("weaker", WEAKER)
@pytest.mark.parametrize("after", [0, 3])
@pytest.mark.parametrize("by_machine", [True, False])
def test_nothing_weaker_overtakes_a_power_off(weaker: str, after: int, by_machine: bool) -> None:
    """EN-32: power off ranks above all that moves or stops a group."""
    s, g = moving()
    with s:
        begin = s.axis("x").set_position
        off = s.command("machine", "stop_all", {"open_loops": True}) if by_machine else g.power(enable=False)
        s.step(after)
        WEAKER[weaker](s, g)
        s.run(0.5)
        assert off.done
        assert not any(axis.loop_closed for axis in s.axes.values())
        assert s.axis("x").set_position - begin < 60


@pytest.mark.parametrize("first", [{}, {"deceleration": 20}])
@pytest.mark.parametrize("second", [{}, {"deceleration": 20}])
def test_no_stop_of_a_group_softens_another(first: dict[str, float], second: dict[str, float]) -> None:
    """EN-32: of several the one that brakes harder, in whatever order."""
    s, g = moving()
    with s:
        begin = s.axis("x").set_position
        g.stop(**first)
        s.step(5)
        g.stop(**second)
        s.run(1)
        way = s.axis("x").set_position - begin
        assert (way < 60) is (first == {} or second == {})


@pytest.mark.parametrize(
    "between",
    [
        lambda s, g: g.power(enable=False),
        lambda s, g: s.command("machine", "stop_all", {"open_loops": True}),
        lambda s, g: s.command("machine", "emergency_stop"),
        lambda s, g: s.command("machine", "fail_all_axes"),
        lambda s, g: g.stop(),
        lambda s, g: s.command("machine", "stop_all"),
        lambda s, g: g.disable(),
    ],
)
@pytest.mark.parametrize("moment", ["moving", "standing"])
def test_a_held_stop_of_a_group_outlasts_whatever_comes(
    between: Callable[[takt.Engine, takt.Group], takt.Feedback], moment: str
) -> None:
    """AX-37, for groups: two holders, of which the last one lets the group go."""
    s, g = moving()
    with s:
        holders = [g.stop(hold=True), g.stop(hold=True)]
        s.run(0.5 if moment == "standing" else 0.02)
        between(s, g)
        s.run(0.5)
        g.reset()
        s.run(0.1)
        g.enable()
        s.step(2)
        g.power()
        s.run(0.5)
        stands = s.axis("x").set_position
        for holder in holders:
            assert g.state == "GroupStopping"
            for give in OUTWARDS.values():
                assert give(g).wait_final().error_id == 6
            assert g.home().wait_final().error
            s.run(0.1)
            assert s.axis("x").set_position == stands
            holder.release()
            s.step(3)
        assert g.state == "GroupStandby"
        g.move_linear_relative(x=-5).wait()


def test_more_holders_of_a_group_than_there_is_room_for_are_told_so() -> None:
    """EN-32: the ninth brakes the group, holds nothing, and gets error 3003."""
    s, g = moving()
    with s:
        holders = [g.stop(hold=True, deceleration=50) for _ in range(8)]
        late = g.stop(hold=True)
        s.run(0.3)
        assert late.wait_final().error_id == 3003
        assert s.axis("x").set_velocity == 0
        for holder in holders:
            assert g.state == "GroupStopping"
            holder.release()
            s.step(2)
        assert g.state == "GroupStandby"
