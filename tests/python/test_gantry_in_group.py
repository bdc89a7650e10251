"""Gantries whose leader is a member of a group: directions, power off and faults while the group moves."""

from __future__ import annotations

import numpy as np
import pytest
import takt
from takt import expect

IN_A_GROUP = """\
name: cell
axes:
  - {name: a, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: b, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}, follows: {axis: a}}
  - {name: y, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: g
    axes: [a, y]
    kinematics: {gantry: {axes: [x, y]}}
    path: {velocity: 600, acceleration: 6000, jerk: 120000}
"""


def moving(s: takt.Engine, cycles: int) -> takt.Group:
    for name in "aby":
        s.axis(name).power().wait()
    g = s.group("g")
    g.enable().wait()
    g.move_linear_absolute(x=-300, y=20)
    s.step(cycles)
    return g


@pytest.mark.parametrize("cycles", [45, 70, 100, 130, 160, 320])
def test_a_direction_of_a_follower_is_barred_while_a_group_moves_the_leader(cycles: int) -> None:
    """AX-13, AX-101, AX-111: the group brakes along its path; no set point jumps."""
    with takt.Engine(IN_A_GROUP) as s:
        moving(s, cycles)
        with s.record("a", "b") as recorder:
            s.axis("b").power(enable_negative=False)
            s.run(0.6)
        for name in "ab":
            expect.within_limits(recorder.recording, name)
            expect.continuous(recorder.recording, name)
        positions = np.asarray(recorder.recording["a"]["set_position"])
        assert np.diff(positions).max() <= 1e-9
        assert positions[0] - positions[-1] < 60
        assert s.axis("a").set_velocity == 0


@pytest.mark.parametrize("which", "ab")
def test_power_off_while_a_group_brakes_for_a_fault(which: str) -> None:
    """AX-101: along the ramp first, both members of the gantry in step, then off."""
    with takt.Engine(IN_A_GROUP) as s:
        moving(s, 200)
        s.command("machine", "fail_all_axes")
        s.step(30)
        assert s.axis("a").set_velocity < -400
        with s.record("a", "b", "y") as recorder:
            s.axis(which).power(enable=False)
            s.run(0.6)
        for name in "aby":
            expect.within_limits(recorder.recording, name)
        a, b = recorder.recording["a"], recorder.recording["b"]
        closed = np.asarray(a["loop_closed"], bool)
        assert np.abs(np.asarray(a["set_velocity"])[np.flatnonzero(~closed)[0]]) < 1e-6
        assert np.abs(np.asarray(a["true_position"]) - np.asarray(b["true_position"])).max() < 1


@pytest.mark.parametrize("how", ["group", "stop_all", "shut_down"])
@pytest.mark.parametrize("fault", ["all", "direction"])
def test_switching_off_while_a_group_brakes_for_a_fault(how: str, fault: str) -> None:
    """AX-100: it is stronger than the fault: all members are off at rest."""
    with takt.Engine(IN_A_GROUP) as s:
        g = moving(s, 200)
        if fault == "all":
            s.command("machine", "fail_all_axes")
        else:
            s.axis("a").power(enable_negative=False)
        s.step(30)
        with s.record("a", "b", "y") as recorder:
            if how == "group":
                assert g.power(enable=False).wait().done
                s.run(0.05)  # followers behind their leaders
            elif how == "stop_all":
                s.command("machine", "stop_all", {"open_loops": True})
                s.run(1.0)
            else:
                s.shut_down(5)
        assert not any(s.axis(name).loop_closed for name in "aby")
        for name in "aby":
            expect.within_limits(recorder.recording, name)
