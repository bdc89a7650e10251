"""AX-86: step responses and the tuning of position loops, on three plants."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import takt
from takt import tuning
from takt.cli import main

PLANTS = {
    "stiff": ("0.001", "inertia: 0.0001"),
    "soft": ("0.02", "inertia: 0.001, coulomb_friction: 0.02"),
    "backlash": ("0.003", "inertia: 0.0001, backlash: 0.02, coulomb_friction: 0.01"),
}


def machine(plant: str, mode: str = "analog") -> str:
    time_constant, mechanics = PLANTS[plant]
    return f"""
name: bench
axes:
  - name: x
    limits: {{velocity: 1000, acceleration: 20000, jerk: 0}}
    encoder: {{increments_per_unit: 10000}}
    drive: {{mode: {mode}}}
    loop: {{kp: 0.02, kd: 0, ff: 1, velocity_at_10v: 1200}}
simulation:
  servos:
    - axis: x
      drive: {{velocity_at_10v: 1200, velocity_time_constant_s: {time_constant}, load_compensation_s: 0}}
      mechanics: {{{mechanics}}}
      encoder: {{increments_per_unit: 10000}}
"""


def powered(session: takt.Session) -> takt.Axis:
    x = session.axis("x")
    x.power().wait()
    session.run(0.1)
    return x


@pytest.mark.parametrize("plant", PLANTS)
def test_a_loop_gets_critically_damped_and_faster(plant: str) -> None:
    with takt.Engine(machine(plant)) as engine:
        x = powered(engine)
        found = tuning.tune(engine, x, 0.2)
        assert found.after.overshoot < 1
        assert found.after.settling_s < 0.5 * found.before.settling_s
        assert found.after.rise_s < found.before.rise_s
        assert x.error == 0
        again = tuning.step_response(engine, x, 0.2)  # with the gains it was left with, and feed-forward
        assert again.rise_s <= found.after.rise_s


def test_figures_of_a_known_response() -> None:
    """A second-order system of damping 0.5: overshoot exp(-pi d / sqrt(1 - d^2)) = 16.3 %, rise 1.64 / w."""
    w, d = 50.0, 0.5
    t = np.arange(0, 1, 1e-4)
    wd = w * math.sqrt(1 - d * d)
    response = 1 - np.exp(-d * w * t) * (np.cos(wd * t) + d / math.sqrt(1 - d * d) * np.sin(wd * t))
    figures = tuning.analyse(t, response)
    assert figures.overshoot == pytest.approx(16.3, abs=0.1)
    assert figures.rise_s == pytest.approx(1.64 / w, rel=0.01)
    assert figures.turns == 2
    ringing = tuning.analyse(t, 1 - np.cos(wd * t))
    assert math.isnan(ringing.settling_s)
    assert ringing.turns > 10


def test_what_cannot_be_tuned() -> None:
    with (
        takt.Engine(machine("stiff", "cyclic_position")) as engine,
        pytest.raises(takt.TaktError, match="drive closes the position loop itself"),
    ):
        tuning.tune(engine, powered(engine), 0.2)
    with (
        takt.Engine(machine("stiff")) as engine,
        pytest.raises(takt.TaktError, match="expected an axis in Standstill, found Disabled"),
    ):
        tuning.tune(engine, engine.axis("x"), 0.2)


def test_a_failure_leaves_the_gains_as_they_were() -> None:
    with takt.Engine(
        machine("stiff").replace("drive: {mode", "supervision: {deviation_moving: 0.001}\n    drive: {mode")
    ) as engine:
        x = powered(engine)
        with pytest.raises(takt.TaktError, match="the step ended in error 2001"):
            tuning.tune(engine, x, 0.2)


def test_the_command_line_draws_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "machine.yaml"
    file.write_text(machine("soft"))
    target = tmp_path / "tuned.png"
    assert main(["tune", "x", "--machine", str(file), "--distance", "0.2", "--picture", str(target)]) == 0
    assert "loop: {kp: " in capsys.readouterr().out
    assert target.stat().st_size > 10_000
    assert main(["tune", "x", "--distance", "0.2"]) == 2
