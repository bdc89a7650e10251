"""A faulty machine for tests of function blocks, and how they are called and looked at."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import takt
from machines import MACHINE
from takt import plcopen as plc

# x lags behind, and beyond 200 mm/s too far: a fault that opens the loop. The drive of r comes too late to be ready.
WEAK = MACHINE.replace(
    "encoder: {increments_per_unit: 1000}\n  - name: r",
    "encoder: {increments_per_unit: 1000}\n    supervision: {deviation_moving: 2}\n  - name: r",
)
WEAK += "    drive: {ready_timeout_s: 0.1}\n"
WEAK += "simulation:\n  servos:\n    - {axis: x, drive: {velocity_feed_forward: 0, position_gain: 100}}\n"
WEAK += "    - {axis: r, drive: {power_up_s: 0.2}}\n"


def until(engine: takt.Engine, block: Callable[..., Any], condition: Callable[[], bool], **inputs: Any) -> int:
    """Calls the block before every cycle until the condition holds; how many calls it took."""
    for calls in range(1, 5000):
        block(**inputs)
        if condition():
            return calls
        engine.step()
    raise AssertionError(f"{block.outputs} after {calls} calls")  # type: ignore[attr-defined]


def shown(block: plc.FunctionBlock, *names: str) -> list[str]:
    """Which of these outputs are true."""
    return [name for name in names if block.outputs.get(name)]


def exclusive(block: plc.FunctionBlock) -> bool:
    return len(shown(block, "Busy", "Done", "Error", "CommandAborted")) == 1


def overrun(engine: takt.Engine, x: takt.Axis) -> None:
    """A fault that opens the loop of `x`."""
    x.move_velocity(velocity=400.0)
    engine.wait(lambda: x.state is takt.PlcState.ERROR_STOP, 5.0)
    assert not x.loop_closed


def fill_queue(axis: takt.Axis) -> None:
    """Gives commands to an axis until the command queue of the engine is full."""
    while not axis.set_override(velocity_factor=1.0).error:
        pass


def call(engine: takt.Engine, block: plc.FunctionBlock, seconds: float, **inputs: object) -> Any:
    """Calls a block each cycle for so long."""
    for _ in range(round(seconds / engine.period)):
        block(**inputs)
        engine.run(engine.period)
    return block(**inputs)
