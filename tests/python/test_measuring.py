"""What is measured while axes move: probes, and masters that are only measured."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import takt
from takt.plcopen import MC_AbortTrigger, MC_MoveAbsolute, MC_TouchProbe


def probes(first: float, last: float) -> str:
    servo = f"switches: {{touch_probe: {{from: {first}, to: {last}}}}}, encoder: {{increments_per_unit: 5000}}"
    limits = "limits: {velocity: 300, acceleration: 3000, jerk: 60000}, encoder: {increments_per_unit: 5000}"
    return f"""
name: probes
axes:
  - {{name: x, {limits}}}
  - {{name: y, {limits}, inputs: {{touch_probe_of: x}}}}
simulation:
  servos:
    - {{axis: x, {servo}}}
"""


@pytest.mark.parametrize(("first", "last", "speed"), [(31.5, 58.25, 100.0), (20.0, 20.4, 250.0), (12.125, 90.0, 40.0)])
def test_both_edges_in_one_pass(first: float, last: float, speed: float) -> None:
    """AX-109: the length of a product, of one probe; and what waits is over with its own edge only."""
    with takt.Engine(probes(first, last)) as s:
        x = s.axis("x")
        x.power().wait()
        rising, falling = MC_TouchProbe(x, TriggerInput="rising"), MC_TouchProbe(x, TriggerInput="falling")
        again = MC_TouchProbe(x, TriggerInput="rising", WindowOnly=True, FirstPosition=first - 1, LastPosition=last)
        outside = MC_TouchProbe(x, TriggerInput="rising", WindowOnly=True, FirstPosition=last + 5, LastPosition=200)
        move = MC_MoveAbsolute(x, Position=110.0, Velocity=speed)
        while not move.Done:
            for block in (rising, falling, again, outside, move):
                block(Execute=True)
            s.step()
            assert not rising.CommandAborted
        for block, place in ((rising, first), (falling, last), (again, first)):
            assert block.Done
            assert block.RecordedPosition == pytest.approx(place, abs=2 / 5000 + speed * 2e-5)
        assert outside.Busy
        assert x.probe_captures == 2  # two edges, whoever waited for them


def test_one_probe_for_two_axes() -> None:
    """AX-109: `touch_probe_of`: the wire of x captures y, too, at the same instant."""
    with takt.Engine(probes(40.0, 60.0)) as s:
        x, y = s.axis("x"), s.axis("y")
        for axis in (x, y):
            axis.power().wait()
        captures = [axis.arm_probe(edge="rising") for axis in (x, y)]
        y.move_velocity(velocity=70)
        x.move_velocity(velocity=100)
        with s.record() as recorder:
            s.wait(lambda: all(capture.done for capture in captures))
        assert captures[0].value == pytest.approx(40, abs=0.003)
        r = recorder.recording
        at_edge = np.interp(40.0, r["x"]["actual_position"], r["y"]["actual_position"])
        assert captures[1].value == pytest.approx(at_edge, abs=0.004)
    with pytest.raises(takt.ConfigError, match="touch_probe_of: expected the name of an axis, found 'z'"):
        takt.Engine(probes(1, 2).replace("touch_probe_of: x", "touch_probe_of: z"))


def test_abort_trigger_of_one_edge_and_of_all() -> None:
    """AX-109, AX-49: also a block that is started anew takes over from itself, and the ninth is refused."""
    with takt.Engine(probes(40.0, 60.0)) as s:
        x = s.axis("x")
        x.power().wait()
        rising, falling = x.arm_probe(edge="rising"), x.arm_probe(edge="falling")
        abort = MC_AbortTrigger(x, TriggerInput="falling")
        abort(Execute=True)
        s.step(2)
        assert (rising.final, falling.aborted) == (False, True)
        x.abort_trigger()
        s.step(2)
        assert rising.aborted
        waiting = [x.arm_probe() for _ in range(8)]
        s.step(2)
        assert x.arm_probe().wait_final().error_id == 3003
        assert not any(one.final for one in waiting)
        x.abort_trigger().wait()
        block = MC_TouchProbe(x)
        for i in range(40):
            block(Execute=i % 2 == 0)
            s.step()
        block(Execute=True)
        assert block.Busy
        assert not block.Error


def ripple(time_s: float | None, speed: float, increments: float, **given: Any) -> tuple[float, float]:
    """Peak to peak of the slave's speed, and how far it lags behind its master in the world, in u."""
    text = f"""
name: measured
axes:
  - {{name: m, limits: {{velocity: 400, acceleration: 4000, jerk: 80000}},
     encoder: {{increments_per_unit: {increments}}}}}
  - {{name: s, limits: {{velocity: 800, acceleration: 8000, jerk: 400000}}}}
simulation:
  servos:
    - {{axis: m, encoder: {{increments_per_unit: {increments}}}}}
"""
    with takt.Engine(text) as s:
        master, slave = s.axis("m"), s.axis("s")
        for axis in (master, slave):
            axis.power().wait()
        master.move_velocity(velocity=speed).wait(until="reached")
        gear = slave.gear_in(master="m", source="actual_value", master_filter=time_s, **given)
        s.run(1.5)
        assert gear.reached
        with s.record() as recorder:
            s.run(0.6)
        r = recorder.recording
        away = np.asarray(r["s"]["set_position"]) - np.asarray(r["m"]["set_position"])
        takt.expect.within_limits(r, "s")
        return float(np.ptp(r["s"]["set_velocity"])), float(np.ptp(away))


@pytest.mark.parametrize(("speed", "increments"), [(37.0, 10.0), (61.0, 7.0), (149.0, 16.0)])
def test_a_filter_makes_a_measured_master_smoother(speed: float, increments: float) -> None:
    """AX-110: at each time constant the slave is smoother than without, and its lag does not grow."""
    bare, _ = ripple(0.0, speed, increments)
    assert bare > 0
    for time_s in (0.003, 0.01, 0.04, 0.2):
        smooth, drift = ripple(time_s, speed, increments)
        assert smooth <= bare, time_s
        assert smooth < 0.02 * speed
        assert drift < 0.5 / increments
    assert ripple(None, speed, increments)[0] == bare  # unset: as the encoder of the master, which has none


def test_a_filter_has_no_lag_while_the_master_accelerates() -> None:
    """AX-110: its acceleration is known, so the slave is where its master is, to an increment."""
    text = """
name: measured
axes:
  - {name: m, limits: {velocity: 300, acceleration: 1500, jerk: 20000}, encoder: {increments_per_unit: 20}}
  - {name: s, limits: {velocity: 600, acceleration: 6000, jerk: 300000}}
simulation: {servos: [{axis: m, encoder: {increments_per_unit: 20}}]}
"""
    with takt.Engine(text) as s:
        master, slave = s.axis("m"), s.axis("s")
        for axis in (master, slave):
            axis.power().wait()
        slave.gear_in(master="m", source="actual_value", master_filter=0.05).wait(until="reached")
        with s.record() as recorder:
            for target in (150.0, -80.0, 20.0):
                master.move_absolute(position=target).wait()
        r = recorder.recording
        away = np.asarray(r["s"]["set_position"]) - np.asarray(r["m"]["set_position"])
        # What is measured is a cycle old: that is the speed times the period.
        assert np.abs(away - away[0]).max() < 2 / 20 + 300 * 0.001 + 0.1
        assert math.isclose(away[-1], away[0], abs_tol=2 / 20)
