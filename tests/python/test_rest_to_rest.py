"""GR-41: lines from rest to rest, beside the time-optimal motion of a single axis."""

from __future__ import annotations

import pytest
import takt


def gantry(ahead: str) -> str:
    """A gantry, and an axis beside it."""
    limits = "{velocity: 1500, acceleration: 15000, jerk: 500000}"
    axes = "".join(f"  - {{name: {a}, unit: mm, limits: {limits}}}\n" for a in [*"xyz", "alone"])
    return (
        f"name: cell\naxes:\n{axes}groups:\n  - name: robot\n    axes: [x, y, z]\n"
        "    kinematics: {gantry: {axes: [x, y, z]}}\n"
        f"    path: {{velocity: 4000, acceleration: 60000, jerk: 3000000{ahead}}}\n"
    )


def times_of(machine: str, length: float, limits: dict[str, float]) -> tuple[float, float]:
    """What the tool and the single axis take for the same way, s."""
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
    """GR-41: from rest to rest with a low acceleration, and another deceleration or none said."""
    limits = {"velocity": 300.0, "acceleration": 500.0, "jerk": 5000.0}
    if deceleration:
        limits["deceleration"] = deceleration
    for length in (1.0, 5.0, 11.0, 24.5, 25.0, 60.0, 200.0):
        path, axis = times_of(gantry(ahead), length, limits)
        assert path <= 1.07 * axis, length
