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
