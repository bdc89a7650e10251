"""Cam switches as a function block (AX-50, CAM-72)."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
import takt
from blocks import fill_queue
from machines import MACHINE
from takt._commands import Direction, MasterSource
from takt.plcopen import MC_DigitalCamSwitch, MC_MoveVelocity

GATES = (
    MACHINE
    + """\
cam_switches:
  - name: gates
    tracks: [{track: 2, on_lead_s: 0.02}]
    switches:
      - {track: 1, first_on_position: 10, last_on_position: 20}
      - {track: 2, first_on_position: 100, mode: time, duration_s: 0.05}
"""
)

# The table of PLCopen Part 1 for MC_DigitalCamSwitch: an axis of 5000 u a turn, Switch01 to Switch04.
TABLE = """
name: table
cycle: {period_s: 0.001}
axes:
  - name: c
    kind: rotary
    modulus: 5000
    limits: {velocity: 1000, acceleration: 10000, jerk: 200000}
    encoder: {increments_per_unit: 1000}
  - name: x
    limits: {velocity: 1000, acceleration: 10000, jerk: 200000}
    encoder: {increments_per_unit: 1000}
cam_switches:
  - name: table
    switches:
      - {track: 1, first_on_position: 2000, last_on_position: 3000, direction: positive}
      - {track: 1, first_on_position: 2500, last_on_position: 3000, direction: negative}
      - {track: 1, first_on_position: 4000, last_on_position: 1000, direction: both}
      - {track: 2, first_on_position: 3000, direction: both, mode: time, duration_s: 1.35}
"""


def engine_of(axis: takt.Axis) -> takt.Engine:
    assert isinstance(axis.session, takt.Engine)
    return axis.session


def until(axis: takt.Axis, condition: Callable[[], bool], *blocks: Callable[[], object]) -> None:
    """Calls the blocks before every cycle until the condition holds."""
    for _ in range(20000):
        for block in blocks:
            block()
        if condition():
            return
        engine_of(axis).step()
    raise AssertionError("it never came")


@pytest.fixture(name="x")
def powered_axis() -> takt.Axis:
    axis = takt.Engine(GATES).axis("x")
    axis.power().wait()
    return axis


def test_cam_switch_works_while_enabled(x: takt.Axis) -> None:  # AX-50
    cams, move = MC_DigitalCamSwitch(x, Switches="gates"), MC_MoveVelocity(x)
    cams(Enable=True)
    move(Execute=True, Velocity=200)
    seen: dict[int, list[float]] = {1: [], 2: []}

    def note() -> None:
        for track, positions in seen.items():
            if cams.Outputs >> (track - 1) & 1:
                positions.append(x.set_position)

    until(x, lambda: x.set_position > 130, cams, move, note)
    assert cams.InOperation
    assert cams.Busy
    assert min(seen[1]) == pytest.approx(10, abs=0.2)
    assert max(seen[1]) == pytest.approx(20, abs=0.2)
    assert min(seen[2]) == pytest.approx(96, abs=0.2)
    assert len(seen[2]) == 50
    cams(Enable=False)
    engine_of(x).step()
    assert not cams().InOperation
    assert x.cam_outputs == 0


def test_cam_switch_says_what_is_wrong(x: takt.Axis) -> None:  # AX-50
    cams = MC_DigitalCamSwitch(x, Switches="doors")
    cams(Enable=True)
    until(x, lambda: cams.Error, cams)
    assert cams.ErrorID == 3010
    assert not cams.Busy
    cams(Enable=False)
    assert not cams.Error


def test_cam_switch_in_a_full_queue(x: takt.Axis) -> None:
    """AX-50, EN-22: what was refused is given again, whether it switches on, changes or switches off."""
    cams = MC_DigitalCamSwitch(x, Switches="gates")
    x.move_absolute(position=15.0).wait()
    other = engine_of(x).axis("r")
    fill_queue(other)
    assert cams(Enable=True).ErrorID == 3012
    until(x, lambda: cams.InOperation, cams)
    assert cams.Outputs == 1
    fill_queue(other)
    assert cams(EnableMask=2).ErrorID == 3012
    cams(Enable=False, EnableMask=1)  # the change has not been taken
    assert (cams.Busy, cams.InOperation, cams.Error, x.cam_outputs) == (True, True, False, 1)
    until(x, lambda: x.cam_outputs == 0, cams)
    assert (cams.Busy, cams.InOperation, cams.Error) == (False, False, False)
    refused = engine_of(x).figures["commands_refused"]
    until(x, lambda: cams(Enable=True).InOperation)
    assert cams.Outputs == 1
    assert engine_of(x).figures["commands_refused"] == refused


def test_cam_switch_ends_after_a_change_that_was_refused(x: takt.Axis) -> None:
    """AX-50: the switches in force go on after it, and end with Enable."""
    cams = MC_DigitalCamSwitch(x, Switches="gates")
    x.move_absolute(position=15.0).wait()
    until(x, lambda: cams(Enable=True).InOperation)
    until(x, lambda: cams(Switches="doors").Error)
    assert x.cam_outputs == 1
    until(x, lambda: x.cam_outputs == 0, lambda: cams(Enable=False))


def edges_of_turn(axis: takt.Axis, sense: int, source: MasterSource) -> dict[int, list[tuple[bool, float]]]:
    """On or off, and where: what the tracks did over a turn that began at 1500."""
    cams = MC_DigitalCamSwitch(axis, Switches="table", ValueSource=source)
    move = MC_MoveVelocity(axis, Velocity=800, Direction=Direction.POSITIVE if sense > 0 else Direction.NEGATIVE)
    cams(Enable=True)
    move(Execute=True)
    until(axis, lambda: cams.InOperation and move.InVelocity, cams, move)
    until(axis, lambda: abs(axis.set_position - 1500) < 0.5, cams, move)
    edges: dict[int, list[tuple[bool, float]]] = {1: [], 2: []}
    before = cams.Outputs
    for _ in range(6250):  # 5000 u at 0.8 u a cycle
        engine_of(axis).step()
        cams()
        place = axis.set_position if source is MasterSource.SET_VALUE else axis.actual_position
        for track, bit in ((1, 1), (2, 2)):
            if (before ^ cams.Outputs) & bit:
                edges[track].append((bool(cams.Outputs & bit), place))
        before = cams.Outputs
    return edges


@pytest.mark.parametrize("source", list(MasterSource))
def test_figures_of_the_standard(source: MasterSource) -> None:  # CAM-72
    forward = {1: [(True, 2000), (False, 3000), (True, 4000), (False, 1000)], 2: [(True, 3000), (False, 4080)]}
    backward = {1: [(True, 1000), (False, 4000), (True, 3000), (False, 2500)], 2: [(True, 3000), (False, 1920)]}
    for sense, figure in ((1, forward), (-1, backward)):
        with takt.Engine(TABLE) as engine:
            axis = engine.axis("c")
            axis.power().wait()
            found = edges_of_turn(axis, sense, source)
            for track, edges in figure.items():
                assert [on for on, _ in found[track]] == [on for on, _ in edges]
                for (_, at), (_, expected) in zip(found[track], edges, strict=True):
                    assert abs(math.remainder(at - expected, 5000)) < 0.9, (track, found)


def test_list_across_zero_is_refused_on_a_linear_axis() -> None:  # CAM-72
    with takt.Engine(TABLE) as engine:
        refused = engine.axis("x").digital_cam_switch(switches="table")
        assert refused.error_id == 5
        assert "switches: 'table': expected last_on_position not below first_on_position, as axis x" in refused.sentence
