"""Homing as function blocks, with the switches of the machine file's simulation (AX-60 to AX-71)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Literal

import pytest
import takt
from machines import MACHINE
from takt._commands import BufferMode, HomingDirection, SwitchMode
from takt.plcopen import MC_MoveAbsolute, MC_MoveRelative, homing

NO_REFERENCE = 9

# x stands at place 0, the reference switch begins at 40, the pulses come every 10 from 3 on.
WITH_SWITCHES = (
    MACHINE.replace("name: x\n", "name: x\n    requires_reference: true\n").replace("lower: -10, upper: 1000", "")
    + """\
simulation:
  servos:
    - axis: x
      encoder: {increments_per_unit: 1000, index_distance: 10, index_offset: 3}
      switches:
        reference: {from: 40, to: 60}
        limit_negative: {to: -50}
        limit_positive: {from: 150}
      mechanics: {upper_stop: 170}
"""
).replace("jerk: 100000, }", "jerk: 100000}")


@pytest.fixture
def x() -> Iterator[takt.Axis]:
    with takt.Engine(WITH_SWITCHES) as engine:
        engine.axis("x").power().wait()
        yield engine.axis("x")


def until(axis: takt.Axis, condition: Callable[[], bool], *blocks: Callable[[], Any]) -> None:
    """Calls the blocks before every cycle until the condition holds."""
    assert isinstance(axis.session, takt.Engine)
    for _ in range(20000):
        for block in blocks:
            block()
        if condition():
            return
        axis.session.step(1)
    raise AssertionError("it never came")


def ended(block: Any) -> bool:
    return any(block.outputs[name] for name in ("Done", "Error", "CommandAborted"))


def homed(axis: takt.Axis) -> bool:
    return bool(axis.homed)


def test_a_scenario_from_power_on_to_the_first_absolute_move(x: takt.Axis) -> None:  # AX-60, AX-63, AX-71
    move = MC_MoveAbsolute(x)
    move(Execute=True, Position=90.0, Velocity=50.0)
    until(x, lambda: ended(move), move)
    assert move.outputs["ErrorID"] == NO_REFERENCE
    assert not homed(x)

    search = homing.MC_StepAbsSwitch(x, Velocity=50.0, Direction=HomingDirection.POSITIVE)
    search(Execute=True)
    until(x, lambda: ended(search), search)
    assert search.outputs["Done"]
    assert x.state.value == "Homing"
    assert x.set_position == pytest.approx(40, abs=0.11)

    pulse = homing.MC_StepRefPulse(x, Velocity=10.0, SetPosition=100.0)
    pulse(Execute=True)
    until(x, lambda: ended(pulse), pulse)
    assert pulse.outputs["Done"]
    assert x.state.value == "Standstill"
    assert homed(x)
    assert 100 < x.set_position < 100.5

    move(Execute=False)
    move(Execute=True)
    until(x, lambda: ended(move), move)
    assert move.outputs["Done"]
    assert x.set_position == pytest.approx(90.0)


def test_limit_switch_and_finish(x: takt.Axis) -> None:  # AX-61, AX-66
    search = homing.MC_StepLimitSwitch(x, Velocity=100.0, SwitchMode=SwitchMode.EDGE_ON, SetPosition=-20.0)
    finish = homing.MC_FinishHoming(x, Distance=20.0, BufferMode=BufferMode.BUFFERED)
    search(Execute=True)
    finish(Execute=True)
    until(x, lambda: ended(finish), search, finish)
    assert finish.outputs["Done"]
    assert homed(x)
    assert x.set_position == pytest.approx(0, abs=1e-6)
    assert x.error == 0


def test_distance_limit(x: takt.Axis) -> None:  # AX-70
    search = homing.MC_StepAbsSwitch(x, Velocity=50.0, Direction=HomingDirection.POSITIVE, DistanceLimit=10.0)
    search(Execute=True)
    until(x, lambda: ended(search), search)
    assert search.outputs["ErrorID"] == 2


def test_end_stop(x: takt.Axis) -> None:  # AX-62
    block = homing.MC_StepBlock(x, Velocity=20.0, DevRef=0.5, Direction=HomingDirection.POSITIVE, TimeLimit=0.1)
    block(Execute=True)
    until(x, lambda: ended(block), block)
    assert block.outputs["ErrorID"] == 1


def test_direct_and_absolute(x: takt.Axis) -> None:  # AX-64, AX-65
    direct = homing.MC_StepDirect(x, SetPosition=7.0)
    direct(Execute=True)
    until(x, lambda: ended(direct), direct)
    assert direct.outputs["Done"]
    assert x.set_position == 7.0
    absolute = homing.MC_StepAbsolute(x)
    absolute(Execute=True)
    until(x, lambda: ended(absolute), absolute)
    assert absolute.outputs["Error"]  # its encoder is incremental


@pytest.mark.parametrize(
    ("kind", "place"), [(homing.MC_StepRefFlyingSwitch, 40.0), (homing.MC_StepRefFlyingRefPulse, 3.0)]
)
def test_in_passing(x: takt.Axis, kind: type[homing.FlyingBlock], place: float) -> None:  # AX-67, AX-68
    move, flying = MC_MoveRelative(x, Distance=70.0, Velocity=50.0), kind(x, SetPosition=500.0)
    move(Execute=True)
    flying(Execute=True)
    until(x, lambda: ended(move), move, flying)
    assert move.outputs["Done"]
    assert flying.outputs["Done"]
    assert homed(x)
    assert x.set_position == pytest.approx(500 + 70 - place, abs=0.06)


HOMES = "homing: {method: switch, direction: positive, velocity: 50, pulse_velocity: 5, pulse_direction: negative}"


def test_as_the_axis_says() -> None:  # MC_Home
    machine = WITH_SWITCHES.replace("requires_reference: true\n", f"requires_reference: true\n    {HOMES}\n")
    with takt.Engine(machine) as engine:
        x = engine.axis("x")
        x.power().wait()
        home = homing.MC_Home(x, Position=-7.0)
        move = MC_MoveAbsolute(x, Position=0.0, BufferMode=BufferMode.BUFFERED)
        home(Execute=True)
        until(x, lambda: x.state is takt.PlcState.HOMING, home)
        assert home.outputs["Active"]
        until(x, lambda: home.Done, home)
        assert homed(x)
        move(Execute=True)
        until(x, lambda: move.Done, move)
        engine.run(0.1)
        assert x.actual_position == pytest.approx(0, abs=2e-3)  # the pulse is at 33, so this is place 40
        assert x.reference


def test_home_where_it_stands(x: takt.Axis) -> None:  # MC_Home without a section `homing`
    home = homing.MC_Home(x, Position=12.0)
    home(Execute=True)
    until(x, lambda: home.Done, home)
    assert x.set_position == 12.0


@pytest.mark.parametrize(
    ("section", "why"),
    [
        ("{method: switch}", "must be more than 0 for a search"),
        ("{method: pulse, velocity: 1, direction: switch_positive}", "must be positive or negative"),
        ("{method: pulse, velocity: 1, pulse_velocity: 1}", "methods that search a switch"),
        ("{method: block, velocity: 1}", "must be more than 0 for an end stop"),
        ("{method: switch, velocity: 501}", "no faster than the axis"),
        ("{method: absolute}", "absolute encoder"),
    ],
)
def test_a_section_that_cannot_work_is_refused(section: str, why: str) -> None:
    machine = WITH_SWITCHES.replace("requires_reference: true\n", f"requires_reference: true\n    homing: {section}\n")
    with pytest.raises(takt.ConfigError, match=why):
        takt.Engine(machine)


@pytest.mark.parametrize("mode", ["buffered", "blending_low", "blending_high", "blending_next", "blending_previous"])
@pytest.mark.parametrize("how", ["flying", "set_position"])
def test_a_reference_in_passing_before_a_blend(how: str, mode: Literal["buffered", "blending_low"]) -> None:
    """AX-62, AX-18: the move to blend into lies elsewhere now, on the other side: the axis does not pass its target."""
    machine = {
        "name": "passing",
        "axes": [
            {"name": "x", "limits": {"velocity": 100, "acceleration": 1000, "jerk": 20000, "lower": -100, "upper": 91}}
        ],
        "simulation": {"servos": [{"axis": "x", "switches": {"reference": {"from": 20, "to": 25}}}]},
    }
    with takt.Engine(machine) as s:
        x = s.axis("x")
        x.power().wait()
        if how == "flying":
            x.step_ref_flying_switch(set_position=50)
        first = x.move_absolute(position=60, velocity=50)
        second = x.move_absolute(position=70, velocity=50, buffer_mode=mode)
        s.run(0.5)
        if how == "set_position":
            x.define_position(position=30, relative=True)
        with s.record("x") as recorder:
            second.wait()
        assert first.done
        assert (x.set_position, x.error) == (pytest.approx(70), 0)
        assert max(recorder.recording["x"]["set_position"]) == pytest.approx(90, abs=1e-9)
        takt.expect.within_limits(recorder.recording, "x")
