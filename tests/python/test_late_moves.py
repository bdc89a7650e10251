"""GR-22, GR-40: moves that come while another one is under way, where the path is not planned ahead."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import takt
from carried import ROBOTS, Cell

HARD = ROBOTS["gantry"]
GENTLE = HARD._replace(limits=(1500, 15000, 150000))
SPEEDS = [0, 200, 300]  # of the belt, mm/s
BEGINS = [(0, 0, 60), (-40, 10, 20)]  # where the first one leads, mm


def late_by_cycles(cell: Cell, until: int) -> int:
    """Cycles in which an axis did not get where the path wanted it."""
    run = cell.recorder.stop()
    return max(int(np.sum(run[f"g{a}"]["in_step"][:until] == 0)) for a in "xyz")


def on_a_belt(robot: Any, speed: float) -> Cell:
    """A tool in step, just above the place where its object was when it came."""
    cell = Cell(robot, "belt", speed, board=False)
    cell.line((0, 0, 0.5)).wait()
    cell.recorder.stop()
    cell.recorder = cell.engine.record()
    return cell


@pytest.mark.parametrize("by", BEGINS)
@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("mode", ["aborting", "blending_high", "blending_low"])
@pytest.mark.parametrize("robot", [HARD, GENTLE], ids=["500000", "150000"])
def test_a_tool_in_step_stays_in_step(robot: Any, mode: str, speed: float, by: tuple[float, float, float]) -> None:
    """GR-22, GR-40: the second move comes at any instant of the first one, or so late that a stop is between them."""
    blend: dict[str, Any] = {"transition_mode": "corner_distance", "transition_parameter": 3}
    for wait in np.arange(0.01, 0.125, 0.01):
        cell = on_a_belt(robot, speed)
        start = cell.engine.cycle
        cell.line(by)
        cell.engine.run(float(wait))
        behind = tuple(step + 20 for step in by)
        move = cell.line(behind, buffer_mode=mode, **({} if mode == "aborting" else blend)).wait()
        assert late_by_cycles(cell, move.cycle - start) <= 1, wait


@pytest.mark.parametrize("wait", [0.0, 0.001, 0.004])
@pytest.mark.parametrize("speed", SPEEDS)
def test_a_blend_is_made_while_the_motion_has_hardly_begun(speed: float, wait: float) -> None:
    """GR-22, GR-40: sooner than with a stop, and in step."""
    times = []
    for mode, blend in (
        ("blending_high", {"transition_mode": "corner_distance", "transition_parameter": 20}),
        ("buffered", {}),
    ):
        cell = on_a_belt(HARD, speed)
        start, began = cell.engine.now, cell.engine.cycle
        cell.line((0, 0, 40))
        cell.engine.run(wait)
        move = cell.line((40, 0, 40), buffer_mode=mode, **blend).wait()
        times.append(move.time_s - start)
        assert late_by_cycles(cell, move.cycle - began) <= 1
    assert times[0] <= 0.95 * times[1]


def gantry(ahead: str, axis_limits: str) -> str:
    """A gantry, and an axis beside it."""
    axes = "".join(f"  - {{name: {a}, unit: mm, limits: {axis_limits}}}\n" for a in [*"xyz", "alone"])
    return (
        f"name: cell\naxes:\n{axes}groups:\n  - name: robot\n    axes: [x, y, z]\n"
        "    kinematics: {gantry: {axes: [x, y, z]}}\n"
        f"    path: {{velocity: 4000, acceleration: 60000, jerk: 3000000{ahead}}}\n"
    )


def times_of(machine: str, length: float, limits: dict[str, float]) -> tuple[float, float]:
    """What the tool and a single axis take for the same way, s."""
    with takt.Engine(machine) as engine:
        for axis in engine.axes.values():
            axis.power().wait()
        group = engine.group("robot")
        group.enable().wait()
        start = engine.now
        there = group.move_linear_absolute(x=length, **limits).wait().time_s
        start_alone = engine.now
        there_alone = engine.axis("alone").move_absolute(position=length, **limits).wait().time_s
        return there - start, there_alone - start_alone


@pytest.mark.parametrize("deceleration", [None, 250.0, 500.0, 2000.0])
@pytest.mark.parametrize("ahead", ["", ", planned_ahead: false"], ids=["ahead", "not"])
def test_a_line_takes_little_longer_than_an_axis(ahead: str, deceleration: float | None) -> None:
    """GR-41: from rest to rest with a low acceleration, and another deceleration or none said. An axis takes the least
    time.
    """
    limits = {"velocity": 300.0, "acceleration": 500.0, "jerk": 5000.0}
    if deceleration:
        limits["deceleration"] = deceleration
    machine = gantry(ahead, "{velocity: 1500, acceleration: 15000, jerk: 500000}")
    for length in (1.0, 5.0, 11.0, 24.5, 25.0, 60.0, 200.0):
        path, axis = times_of(machine, length, limits)
        assert path <= 1.07 * axis, length


@pytest.mark.parametrize("acceleration", [500, 3000, 11000])
@pytest.mark.parametrize("ahead", ["", ", planned_ahead: false"], ids=["ahead", "not"])
def test_a_line_on_gentle_axes_takes_little_longer_than_one_of_them(ahead: str, acceleration: float) -> None:
    """GR-41: where the axes, not the path, limit jerk and acceleration."""
    machine = gantry(ahead, f"{{velocity: 500, acceleration: {acceleration}, jerk: 10000}}")
    for length in (1.0, 5.0, 12.0, 40.0):
        path, axis = times_of(machine, length, {})
        assert path <= 1.07 * axis, length
