"""AX-01, EN-06: a machine may have any number of axes."""

from __future__ import annotations

import takt

COUNT = 1000


def test_a_thousand_axes_move_together() -> None:
    limits = "limits: {velocity: 500, acceleration: 5000, jerk: 100000}"
    machine = "name: many\naxes:\n" + "".join(f"  - {{name: a{i}, {limits}}}\n" for i in range(COUNT))
    with takt.Engine(machine) as engine:
        for power in [axis.power() for axis in engine.axes.values()]:
            power.wait()
        moves = [axis.move_absolute(position=10.0 + i) for i, axis in enumerate(engine.axes.values())]
        for move in moves:
            move.wait()
        for i, axis in enumerate(engine.axes.values()):
            assert axis.set_position == 10.0 + i
