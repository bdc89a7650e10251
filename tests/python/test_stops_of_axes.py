"""AX-100, AX-101, EN-32: what stops axes stops all that moves them, in whatever state they are."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import takt

LIMITS = {"velocity": 300, "acceleration": 3000, "jerk": 60000}
Stop = Callable[[takt.Engine], takt.Feedback]


def engine_of(axes: list[dict[str, Any]], servos: list[dict[str, Any]] | None = None, on: bool = True) -> takt.Engine:
    machine = {
        "name": "m",
        "axes": [{"limits": LIMITS, **axis} for axis in axes],
        "simulation": {"servos": servos or []},
    }
    engine = takt.Engine(machine)
    if on:
        for power in [axis.power() for axis in engine.axes.values()]:
            power.wait()
    return engine


# --- straightening of gantries ---


def skewed(switches: dict[str, Any] | None = None) -> takt.Engine:
    """The follower stands 50 behind its leader."""
    start = {"mechanics": {"start_position": -50}, "encoder": {"offset_counts": -50000}, "switches": switches or {}}
    follows = {"axis": "l", "offset": 0.0, "largest_skew": 200}
    return engine_of([{"name": "l"}, {"name": "r", "follows": follows}], [{"axis": "r", **start}])


@pytest.mark.parametrize(
    "stop",
    [
        lambda e: e.axis("r").stop(),
        lambda e: e.axis("r").halt(),
        lambda e: e.axis("l").stop(hold=True),
        lambda e: e.axis("l").halt(),
        lambda e: e.command("machine", "stop_all"),
        lambda e: e.command("machine", "stop_all", {"open_loops": True}),
        lambda e: e.command("machine", "fail_all_axes"),
        lambda e: e.command("machine", "emergency_stop", {"hold": True}),
        lambda e: e.axis("r").power(enable=False),
        lambda e: e.axis("r").power(enable_positive=False),
    ],
)
def test_what_stops_a_gantry_stops_its_straightening(stop: Stop) -> None:
    with skewed() as engine:
        follower = engine.axis("r")
        straighten = follower.straighten(velocity=30)
        engine.run(0.3)
        assert follower.set_velocity > 20
        assert not straighten.final
        stop(engine)
        engine.run(0.3)
        assert straighten.final
        assert not straighten.done
        stands = follower.set_position
        assert -45 < stands < -30
        engine.run(0.5)
        assert follower.set_position == stands


def test_straightening_does_not_run_onto_a_limit_switch() -> None:
    with skewed({"limit_positive": {"from": -40}}) as engine:
        follower = engine.axis("r")
        straighten = follower.straighten(velocity=30)
        with pytest.raises(takt.CommandError, match="the axis ran onto its positive limit switch"):
            straighten.wait()
        engine.run(1)
        assert -40 < follower.set_position < -38
        follower.reset().wait()
        engine.step(5)
        with pytest.raises(takt.CommandError, match="a limit switch is on"):
            follower.straighten(velocity=30).wait()
        assert follower.set_position < -38


# --- power off ---


@pytest.mark.parametrize("end", ["power", "stop_all", "fail_all_axes", "shut_down"])
def test_power_off_outlives_a_switch_and_a_fault(end: str) -> None:
    """They come while the axis brakes for it: the loop is opened all the same."""
    with engine_of([{"name": "y"}], [{"axis": "y", "switches": {"limit_positive": {"from": 50}}}]) as engine:
        axis = engine.axis("y")
        axis.move_velocity(velocity=200)
        engine.wait(lambda: axis.set_position > 48)
        if end == "shut_down":
            engine.shut_down(5)
        elif end == "stop_all":
            engine.command("machine", "stop_all", {"open_loops": True}).wait()
        else:
            off = axis.power(enable=False)
            engine.step(3)
            if end == "fail_all_axes":
                engine.command("machine", "fail_all_axes")
            off.wait()
        engine.run(1)
        assert not axis.loop_closed
        assert axis.set_velocity == 0


def test_a_reset_of_an_axis_that_is_well_disturbs_nothing() -> None:
    """AX-21: under torque control the set point is what is measured; a reset made it stand for a cycle."""
    with engine_of([{"name": "x"}]) as engine:
        axis = engine.axis("x")
        axis.torque_control(torque=5, velocity=100)
        engine.run(0.5)
        with engine.record("x") as recorder:
            engine.step(20)
            axis.reset().wait()
            engine.step(20)
        velocity = recorder.recording["x"]["set_velocity"]
        assert velocity.min() > 99
        assert velocity.max() < 100.1


# --- one gate for all that move towards a switch ---


@pytest.mark.parametrize("switched", ["l", "r", "q"])
@pytest.mark.parametrize(
    ("verb", "arguments"),
    [
        ("move_relative", {"distance": 5}),
        ("move_superimposed", {"distance": 5}),
        ("step_block", {"direction": "positive", "velocity": 20, "deviation": 1}),
        ("step_ref_pulse", {"direction": "positive", "velocity": 20}),
        ("jog", {"forward": True, "velocity": 20}),
    ],
)
def test_a_switch_of_any_follower_counts_for_its_leader(switched: str, verb: str, arguments: dict[str, Any]) -> None:
    """AX-101: also of a follower's follower; nothing moves at all."""
    axes = [{"name": "l"}, {"name": "r", "follows": {"axis": "l"}}, {"name": "q", "follows": {"axis": "r"}}]
    with engine_of(axes, [{"axis": switched, "switches": {"limit_positive": {"from": 50}}}]) as engine:
        leader = engine.axis("l")
        leader.move_velocity(velocity=100)
        engine.wait(lambda: engine.axis(switched).error > 0)
        engine.run(1)
        for name in ("q", "r", "l"):
            engine.axis(name).reset()
        engine.step(3)
        stands = leader.set_position
        assert stands > 50
        with pytest.raises(takt.CommandError, match="a limit switch is on: only moves away from it"):
            engine.command("l", verb, arguments).wait()
        engine.run(0.5)
        assert leader.set_position == stands
        leader.move_relative(distance=-10).wait()


# --- several stops, and what a stop that holds outlasts (AX-37) ---


@pytest.mark.parametrize("second", [{}, {"hold": True}, {"deceleration": 1}, {"jerk": 1000.0}])
@pytest.mark.parametrize("first", [{"deceleration": 5}, {"hold": True, "deceleration": 5}, {}])
def test_the_stop_that_brakes_sooner_brakes_and_both_are_done(first: dict[str, Any], second: dict[str, Any]) -> None:
    """EN-32: a gentle stop locks no other one out, a gentler one softens none."""
    with engine_of([{"name": "x"}]) as engine:
        axis = engine.axis("x")
        axis.move_velocity(velocity=300)
        engine.run(0.5)
        one = axis.stop(**first)
        engine.run(0.02)
        before = axis.set_velocity
        two = axis.stop(**second)
        axis.move_relative(distance=1, buffer_mode="buffered")
        soon = first == {} or not ({"deceleration", "jerk"} & set(second))
        engine.run(0.3)
        assert (axis.set_velocity == 0) is soon
        assert axis.set_velocity < before
        engine.wait(lambda: axis.set_velocity == 0, timeout=70)
        engine.step(3)
        assert one.done
        assert two.done
        held = [stop for stop, given in ((one, first), (two, second)) if given.get("hold")]
        for stop in held:
            assert axis.state == takt.PlcState.STOPPING
            assert axis.move_relative(distance=1).wait_final().error_id == 6
            stop.release()
            engine.step(2)
        assert axis.state != takt.PlcState.STOPPING


def test_stop_all_counts_during_a_gentle_stop() -> None:
    with engine_of([{"name": "x"}]) as engine:
        axis = engine.axis("x")
        axis.move_velocity(velocity=300)
        engine.run(0.5)
        axis.stop(deceleration=5, hold=True)
        engine.run(0.1)
        waits = axis.move_relative(distance=1, buffer_mode="buffered")
        engine.command("machine", "stop_all")
        engine.run(0.3)
        assert axis.set_velocity == 0
        assert axis.state == takt.PlcState.STOPPING
        assert waits.aborted


@pytest.mark.parametrize("moment", ["moving", "standing"])
@pytest.mark.parametrize(
    "between",
    [
        lambda e: e.axis("x").power(enable=False),
        lambda e: e.command("machine", "stop_all", {"open_loops": True}),
        lambda e: e.command("machine", "emergency_stop"),
        lambda e: e.command("machine", "fail_all_axes"),
        lambda e: e.axis("x").stop(),
        lambda e: e.command("machine", "stop_all"),
    ],
)
def test_a_stop_that_holds_outlasts_whatever_comes(between: Stop, moment: str) -> None:
    """Stopping lasts as long as Execute (AX-37): two holders, of which the last one lets the axis go."""
    with engine_of([{"name": "x"}, {"name": "y"}]) as engine:
        axis = engine.axis("x")
        axis.move_velocity(velocity=100)
        engine.run(0.3)
        holders = [axis.stop(hold=True), axis.stop(hold=True)]
        engine.run(0.5 if moment == "standing" else 0.01)
        between(engine)
        engine.run(0.5)
        stands = axis.set_position
        axis.reset()
        engine.step(3)
        axis.power().wait()
        engine.step(2)
        for holder in holders:
            assert axis.state == takt.PlcState.STOPPING
            for verb, arguments in (
                ("move_velocity", {"velocity": 20}),
                ("move_superimposed", {"distance": 2}),
                ("gear_in", {"master": "y"}),
                ("jog", {"forward": True, "velocity": 20}),
                ("torque_control", {"torque": 0.1, "velocity": 20}),
                ("step_direct", {"position": 3}),
            ):
                assert engine.command("x", verb, arguments).wait_final().error
            engine.run(0.1)
            assert axis.set_position == stands
            holder.release()
            engine.step(3)
        assert axis.state == takt.PlcState.STANDSTILL
        axis.move_relative(distance=2).wait()


def test_nothing_slips_in_before_a_held_axis_is_stopping_again() -> None:
    """In no cycle between power and Stopping a motion is taken."""
    with engine_of([{"name": "x", "drive": {"brake_opens_s": 0.005}}]) as engine:
        axis = engine.axis("x")
        axis.stop(hold=True).wait()
        axis.power(enable=False).wait()
        power = axis.power()
        for _ in range(200):
            move = axis.move_relative(distance=1, buffer_mode="buffered")
            jog = axis.jog(forward=True, velocity=10)
            engine.step()
            assert not move.active
            assert not jog.active
        assert power.done
        assert axis.set_position == 0


def test_more_holders_than_there_is_room_for_are_told_so() -> None:
    with engine_of([{"name": "x"}]) as engine:
        axis = engine.axis("x")
        axis.move_velocity(velocity=100)
        engine.run(0.3)
        stops = [axis.stop(hold=True, deceleration=50) for _ in range(8)]
        late = axis.stop(hold=True)
        engine.run(0.2)
        assert late.wait_final().error_id == 3003
        assert axis.set_velocity == 0  # it brakes all the same
        for stop in stops:
            assert axis.state == takt.PlcState.STOPPING
            stop.release()
            engine.step(2)
        assert axis.state == takt.PlcState.STANDSTILL


# --- while drives get ready ---


@pytest.mark.parametrize(
    "stop",
    [
        lambda e: e.command("machine", "stop_all"),
        lambda e: e.axis("x").stop(hold=True),
        lambda e: e.axis("x").stop(),
        lambda e: e.axis("x").halt(),
    ],
)
@pytest.mark.parametrize("after_s", [0.0, 0.001, 0.2])
def test_a_stop_while_the_brake_opens_ends_what_waits(stop: Stop, after_s: float) -> None:
    with engine_of([{"name": "x", "drive": {"brake_opens_s": 0.3}}], on=False) as engine:
        axis = engine.axis("x")
        power = axis.power()
        engine.step(2)
        engine.run(after_s)
        move = axis.move_relative(distance=50, buffer_mode="buffered")
        engine.step(5)
        stopped = stop(engine)
        states = []
        for _ in range(600):
            engine.step()
            states.append(axis.state)
        assert power.done
        assert stopped.done
        assert move.aborted
        assert axis.set_position == 0
        held = stopped.level_sensitive
        seen = list(dict.fromkeys(states))
        rest = [takt.PlcState.STANDSTILL, takt.PlcState.STOPPING] if held else [takt.PlcState.STANDSTILL]
        assert seen == [takt.PlcState.DISABLED, *rest]
        if held:
            assert axis.move_relative(distance=5).wait_final().error_id == 6
            stopped.release()
            engine.step(2)
        axis.move_relative(distance=5).wait()
