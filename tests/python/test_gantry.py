"""Axes that are one from load on (docs/couplings.md), ramps of faults, limits of the application, what blocks say."""

from __future__ import annotations

import numpy as np
import pytest
import takt
from machines import new_url
from takt.plcopen import MC_AbortPassiveHoming, MC_MoveAbsolute, MC_ReadAxisInfo, MC_ReadMotionState, MC_ReadParameter


def gantry(skew: float, ratio: float = 1.0) -> str:
    """The right one has its switch where it stands askew by so much, u of the left one."""
    return f"""
name: gantry
axes:
  - {{name: left, limits: {{velocity: 300, acceleration: 3000, jerk: 60000}}, encoder: {{increments_per_unit: 10000}}}}
  - {{name: right, limits: {{velocity: 600, acceleration: 6000, jerk: 120000}}, encoder: {{increments_per_unit: 10000}},
     follows: {{axis: left, ratio: {ratio}, square: true, in_step: 0.2, skew_warning: 0.3}}}}
simulation:
  servos:
    - {{axis: left, switches: {{reference: {{from: 80, to: 120}}}}, encoder: {{increments_per_unit: 10000}}}}
    - {{axis: right, switches: {{reference: {{from: {80 * ratio + skew}, to: {120 * ratio + skew}}}}},
       encoder: {{increments_per_unit: 10000}}}}
"""


@pytest.mark.parametrize("ratio", [1.0, 2.0])
@pytest.mark.parametrize("skew", [0.0, 0.1, 3.0, -3.0, 25.0, -25.0])
def test_homing_squares_a_gantry(skew: float, ratio: float) -> None:
    """AX-101: with a switch at each member, whichever of them comes first."""
    with takt.Engine(gantry(skew, ratio)) as s:
        left, right = s.axis("left"), s.axis("right")
        for power in [left.power(), right.power()]:
            power.wait()
        record = s.record()
        left.step_abs_switch(velocity=50, direction="positive", switch_mode="edge_on", set_position=10).wait(timeout=30)
        left.finish_homing().wait()
        samples = record.stop()
        assert right.homed
        assert right.in_step
        assert not right.skewed
        assert right.set_position == pytest.approx(ratio * left.set_position, abs=1e-6)
        # In the world the two stand as their switches do, within what they move from cycle to cycle.
        assert right.true_position - ratio * left.true_position == pytest.approx(skew, abs=0.2 * ratio)
        for axis in ("left", "right"):  # and got there within their limits
            limits = s.axis(axis).parameters["limits"]
            assert np.abs(samples[axis]["set_acceleration"]).max() <= 1.3 * limits["acceleration"]
        left.move_absolute(position=0).wait()
        assert right.set_position == pytest.approx(0, abs=1e-6)


def test_a_follower_without_its_switch_is_no_reference() -> None:
    """AX-101: the search ends by its limit of distance, and the gantry stands."""
    with takt.Engine(gantry(1000.0)) as s:
        left, right = s.axis("left"), s.axis("right")
        for power in [left.power(), right.power()]:
            power.wait()
        step = left.step_abs_switch(velocity=100, direction="positive", distance_limit=200).wait_final(timeout=30)
        assert (step.error_id, right.homed) == (2, False)


SWITCH = """
name: switch
axes:
  - {{name: x, limits: {{velocity: 400, acceleration: 2000, jerk: 40000}}, {ramp},
     encoder: {{increments_per_unit: 10000}}}}
simulation:
  servos:
    - {{axis: x, switches: {{limit_positive: {{from: 100}}}}, encoder: {{increments_per_unit: 10000}}}}
"""


def test_a_limit_switch_has_a_ramp_of_its_own() -> None:
    """AX-112: and one that is gentler than the axis' own makes nothing longer."""
    beyond = {}
    for ramp in (
        "requires_reference: false",
        "limit_stop: {deceleration: 20000, jerk: 0}",
        "limit_stop: {deceleration: 8000}",
        "limit_stop: {deceleration: 100, jerk: 100}",
        "fault_stop: {deceleration: 20000, jerk: 0}",
    ):
        with takt.Engine(SWITCH.format(ramp=ramp)) as s:
            x = s.axis("x")
            x.power().wait()
            x.move_velocity(velocity=300)
            s.run(2)
            assert (x.error, x.set_velocity, x.loop_closed) == (2004, 0, True)
            beyond[ramp] = x.set_position - 100
    usual, hard, harder, gentle, other = beyond.values()
    assert hard == pytest.approx(300**2 / 2 / 20000, abs=0.6)  # v²/2a and a cycle or two
    assert hard < harder < usual
    assert gentle == other == usual


def test_limits_of_the_application_are_written_by_number() -> None:
    """AX-107: 9, 13, 15, 17, at most those of the machine file, which 8, 12, 14, 16 keep."""
    with takt.Engine(SWITCH.format(ramp="requires_reference: false")) as s:
        x = s.axis("x")
        x.power().wait()
        read = lambda number: x.read_parameter(number=number).wait().value  # noqa: E731
        for number, system, most in ((9, 8, 400), (13, 12, 2000), (15, 14, 2000), (17, 16, 40000)):
            assert x.write_parameter(number=number, value=most / 2).wait().done
            assert (read(number), read(system)) == (most / 2, most)
            for wrong in (0, -1, most * 1.01):
                assert x.write_parameter(number=number, value=wrong).wait_final().error_id == 5
            assert x.write_parameter(number=system, value=most / 2).wait_final().error_id == 5
        assert x.move_relative(distance=10, velocity=300).wait_final().error_id == 5
        record = s.record()
        x.move_relative(distance=80).wait()
        moved = record.stop()["x"]
        assert np.abs(moved["set_velocity"]).max() <= 200 * (1 + 1e-9)
        assert np.abs(moved["set_acceleration"]).max() <= 1000 * (1 + 1e-9)
        x.move_relative(distance=-50)
        s.run(0.1)
        assert x.write_parameter(number=9, value=100).wait_final().error_id == 3005


def test_a_drive_that_was_never_heard_is_not_ready() -> None:
    """AX-108: neither before the first cycle nor after it."""
    drives = "external:\n  drives: [{axis: x}]\n  answer_within_s: 0.001\n"
    axis = "{name: x, limits: {velocity: 100, acceleration: 900, jerk: 9000}}"
    with takt.Engine(f"name: away\naxes: [{axis}]\n{drives}", url=new_url()) as s:
        info = MC_ReadAxisInfo(s.axis("x"), Enable=True)
        for _ in range(3):
            info()
            assert (info.Valid, info.Simulation) == (True, False)
            assert (info.CommunicationReady, info.ReadyForPowerOn) == (False, False)
            s.step(1)


def test_what_blocks_say() -> None:
    """AX-108, AX-113: outputs of a refused read, the sentence of an error, buffer modes by number, measured motion."""
    with takt.Engine(SWITCH.format(ramp="requires_reference: false")) as s:
        x = s.axis("x")
        read = MC_ReadParameter(x, Enable=True, ParameterNumber=9999)
        read()
        assert (read.Valid, read.Busy, read.Error, read.ErrorID) == (False, False, True, 5)
        assert "number" in read.ErrorText
        s.step(1)
        info = MC_ReadAxisInfo(x, Enable=True)()
        assert (info.Simulation, info.CommunicationReady, info.ReadyForPowerOn) == (True, True, True)
        x.power().wait()
        first, then = MC_MoveAbsolute(x, Position=30, Velocity=100), MC_MoveAbsolute(x, Position=60, Velocity=100)
        motion = MC_ReadMotionState(x, Enable=True, Source="actual_value")
        seen = set()
        for _ in range(1500):
            first(Execute=True)
            then(Execute=True, BufferMode=3)
            motion()
            seen.add((motion.Accelerating, motion.Decelerating))
            s.step(1)
        assert then.Done
        assert seen >= {(True, False), (False, True), (False, False)}
        wrong = MC_MoveAbsolute(x, Position=30, Velocity=100, BufferMode=6)
        for _ in range(3):
            wrong(Execute=True)
            s.step(1)
        assert wrong.Error
        assert "buffer_mode" in wrong.ErrorText
        passive = MC_AbortPassiveHoming(x)
        for _ in range(3):
            passive(Execute=True)
            s.step(1)
        assert passive.Done


TWO = """
name: two
axes:
  - {name: m, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: x, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
"""


@pytest.mark.parametrize("mode", ["buffered", "blending_low", "blending_previous", "blending_next", "blending_high"])
def test_what_may_be_blended_into(mode: str) -> None:
    """AX-104: gears and homing steps; a gear takes over in motion, homing begins at rest."""
    with takt.Engine(TWO) as s:
        m, x = s.axis("m"), s.axis("x")
        for power in [m.power(), x.power()]:
            power.wait()
        m.move_velocity(velocity=50).wait(until="reached")
        x.move_relative(distance=20, velocity=50)
        record = s.record()
        x.gear_in(master="m", buffer_mode=mode).wait(until="reached")
        slowest = record.stop()["x"]["set_velocity"][200:].min()
        assert (slowest > 49) == (mode != "buffered")
        x.halt().wait()
        for step in ("step_abs_switch", "step_limit_switch"):
            x.move_relative(distance=5, velocity=50)
            homing = s.command("x", step, {"velocity": 10, "buffer_mode": mode, "time_limit": 0.2})
            assert homing.wait_final().error_id == 1  # there is no switch
            s.run(0.3)
        refused = x.torque_control(torque=1, buffer_mode="blending_low").wait_final()
        assert refused.sentence.endswith("buffer_mode: expected aborting or buffered")
