"""Measures the speed of virtual time against the bare C++ loop (PY-08)."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass

from takt.engine import Engine
from takt.events import Progress

ROUNDS = 3  # of each measurement; the best counts

AXIS = """\
  - name: axis{i}
    unit: mm
    limits: {{velocity: 500, acceleration: 5000, jerk: 100000}}
    encoder: {{increments_per_unit: 1000}}
"""


@dataclass(frozen=True)
class Speed:
    name: str  # "idle" or "moving"
    cycles_s: float
    pace: float  # seconds of engine time per second
    ratio: float  # duration relative to the bare C++ loop


def machine_text(axes: int) -> str:
    """Returns the text of a machine with this number of linear axes."""
    return "name: bench\naxes:\n" + "".join(AXIS.format(i=i) for i in range(axes))


def measure(
    machine: str | os.PathLike[str] | None, axes: int, cycles: int, progress: Progress | None = None
) -> list[Speed]:
    """Measures stepping with all axes idle and with all axes moving. Returns both speeds."""
    results = []
    for count, moving in enumerate((False, True)):
        stepped = bare = float("inf")
        for one in range(ROUNDS):
            with _engine(machine, axes, moving) as engine:
                start = time.perf_counter()
                engine.step(cycles)
                stepped = min(stepped, time.perf_counter() - start)
            with _engine(machine, axes, moving) as engine:
                bare = min(bare, engine._core.measure(cycles))
            if progress is not None:
                progress((count * ROUNDS + one + 1) / (2 * ROUNDS))
            period = engine.period
        name = "moving" if moving else "idle"
        results.append(Speed(name, cycles / stepped, cycles * period / stepped, stepped / bare))
    return results


def _engine(machine: str | os.PathLike[str] | None, axes: int, moving: bool) -> Engine:
    engine = Engine(machine if machine is not None else machine_text(axes))
    if moving:
        for axis in engine.axes.values():
            axis.power()
        engine.wait(lambda: all(axis.powered for axis in engine.axes.values()), 10.0, what="every axis powered")
        for axis in engine.axes.values():
            axis.move_velocity(velocity=0.1 * axis.parameters["limits"]["velocity"])
        engine.run(1.0)
    return engine
