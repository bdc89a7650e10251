"""GR-22, GR-40: moves that come while another one is under way, where the path is not planned ahead."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
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
@pytest.mark.parametrize("robot", [HARD, GENTLE], ids=["500000", "150000"])
def test_a_tool_in_step_stays_in_step(robot: Any, speed: float, by: tuple[float, float, float]) -> None:
    """GR-22, GR-40: an aborting move comes at any instant of the first one."""
    for wait in np.arange(0.01, 0.125, 0.01):
        cell = on_a_belt(robot, speed)
        start = cell.engine.cycle
        cell.line(by)
        cell.engine.run(float(wait))
        move = cell.line(tuple(step + 20 for step in by)).wait()
        assert late_by_cycles(cell, move.cycle - start) <= 1, wait
