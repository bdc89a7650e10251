"""What lies between motor and load (AX-115): backlash, errors of the screw, a second encoder."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import takt

SCREW = "[{position: 0, error: 0}, {position: 100, error: 0.08}, {position: 200, error: -0.05}]"
ENCODERS_APART = 3106


def machine(axis: str = "", mechanics: str = "", drive: str = "cyclic_position") -> str:
    return f"""
name: between
axes:
  - name: x
    limits: {{velocity: 300, acceleration: 3000, jerk: 60000}}
    encoder: {{increments_per_unit: 10000}}
    drive: {{mode: {drive}}}
    loop: {{kp: 0.05, velocity_at_10v: 1000}}
    {axis}
simulation:
  servos:
    - axis: x
      mechanics: {{{mechanics or "inertia: 0.001"}}}
"""


def to_and_fro(x: takt.Axis) -> list[float]:
    """How far the load is from where it shall be, at places reached gently from below and from above."""
    errors = []
    for target in (100.0, 150.0, 120.0, 60.0, 80.0, 200.0, 150.0, 0.0):
        x.move_absolute(position=target, velocity=150, acceleration=500, deceleration=500, jerk=5000).wait()
        x.session.run(0.3)
        errors.append(x.true_position - target)
    return errors


@pytest.mark.parametrize("drive", ["cyclic_position", "cyclic_velocity"])
def test_backlash_is_made_up_for(drive: str) -> None:
    """AX-115: without, the load is half of it behind either way; with, where it shall be."""
    for compensation in ("", "compensation: {backlash: 0.5}"):
        with takt.Engine(machine(compensation, "backlash: 0.5", drive)) as s:
            x = s.axis("x")
            x.power().wait()
            errors = np.abs(to_and_fro(x))
            assert np.abs(errors - (0 if compensation else 0.25)).max() < 0.006


def test_the_motor_goes_through_the_backlash_within_limits() -> None:
    """AX-115: with the velocity of the compensation and the acceleration of the axis, and no further."""
    with takt.Engine(machine("compensation: {backlash: 0.5, velocity: 10}", "backlash: 0.5")) as s:
        x = s.axis("x")
        x.power().wait()
        x.move_absolute(position=50).wait()
        assert x.encoder_correction == pytest.approx(0.25)
        recording = s.record()
        x.move_absolute(position=0).wait()
        s.run(0.2)
        correction = recording.stop()["x"]["encoder_correction"]
        assert correction[-1] == pytest.approx(-0.25)
        rate = np.diff(correction) / 0.001
        assert np.abs(rate).max() == pytest.approx(10)
        assert np.abs(np.diff(rate)).max() <= 3 + 1e-6
        assert correction.min() >= -0.25 - 1e-9


def test_errors_of_the_screw_are_made_up_for() -> None:
    """AX-115: as soon as the axis has its reference, and not before; also with backlash on top."""
    text = machine(f"compensation: {{backlash: 0.2, screw: {SCREW}}}", f"backlash: 0.2, screw: {SCREW}")
    with takt.Engine(text) as s:
        x = s.axis("x")
        x.power().wait()
        x.move_absolute(position=100).wait()
        s.run(0.3)
        assert x.true_position == pytest.approx(100.08, abs=0.003)
        x.move_absolute(position=0).wait()
        x.move_absolute(position=1).wait()  # what is called 1 now, reached from below
        x.step_direct(set_position=1).wait()
        assert np.abs(to_and_fro(x)).max() < 0.003
        assert abs(x.following_error) < 0.001


@pytest.mark.parametrize("drive", ["cyclic_velocity", "analog"])
def test_an_encoder_on_the_load_closes_the_loop(drive: str) -> None:
    """AX-115: backlash and screw are its business; the axis is where the load is."""
    text = machine("load_encoder: {increments_per_unit: 20000, invert: true}", f"backlash: 0.1, screw: {SCREW}", drive)
    with takt.Engine(text) as s:
        x = s.axis("x")
        x.power().wait()
        for target in (100.0, 200.0, 50.0):
            x.move_absolute(position=target).wait()
            s.run(0.5)
            assert x.true_position == pytest.approx(x.actual_position, abs=0.0001)
            assert x.true_position == pytest.approx(target, abs=0.06 if drive == "analog" else 0.02)
        assert abs(x.encoder_correction) > 0.005


def test_a_coupling_that_slips_opens_the_loop() -> None:
    """AX-115: motor and load get apart; reset takes them as they are then."""
    text = machine(
        "load_encoder: {increments_per_unit: 20000}\n    supervision: {encoders_apart: 0.3}",
        "backlash: 1.0",
        "cyclic_velocity",
    )
    with takt.Engine(text) as s:
        x = s.axis("x")
        x.power().wait()
        failed = x.move_absolute(position=100).wait_final()
        assert (failed.error_id, x.error, x.loop_closed) == (ENCODERS_APART, ENCODERS_APART, False)
        s.run(0.2)
        x.reset().wait()
        x.power().wait()
        x.move_absolute(position=100).wait()


BAD: dict[str, tuple[str, str]] = {
    "csp": ("load_encoder: {}", "cyclic_position"),
    "both": ("load_encoder: {}\n    compensation: {backlash: 0.1}", "beside load_encoder"),
    "marks": ("load_encoder: {coded_marks: {distance: 20, step: 0.02}}", "no coded_marks"),
    "falling": ("compensation: {screw: [{position: 5, error: 0}, {position: 1, error: 0}]}", "rising positions"),
    "steep": ("compensation: {screw: [{position: 0, error: 0}, {position: 1, error: 0.2}]}", "a tenth"),
    "negative": ("compensation: {backlash: -0.1}", "backlash"),
    "fast": ("compensation: {backlash: 0.1, velocity: 301}", "no faster"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_cannot_be_is_refused(case: str) -> None:
    axis, said = BAD[case]
    with pytest.raises(takt.ConfigError, match=said):
        takt.Engine(machine(axis, drive="cyclic_position" if case == "csp" else "cyclic_velocity"))


def test_without_any_of_it_nothing_changes() -> None:
    with takt.Engine(machine()) as s:
        x: Any = s.axis("x")
        x.power().wait()
        x.move_absolute(position=10).wait()
        assert x.encoder_correction == 0


def test_the_table_of_a_screw_stays_where_it_lies() -> None:
    """AX-115: MC_SetPosition renames places, and moves nothing; the next reference names them as the table does."""
    with takt.Engine(machine(f"compensation: {{screw: {SCREW}}}", f"screw: {SCREW}")) as s:
        x = s.axis("x")
        x.power().wait()
        x.step_direct(set_position=0).wait()
        x.move_absolute(position=100).wait()
        s.run(0.3)
        x.define_position(position=0).wait()
        s.run(0.3)
        assert x.true_position == pytest.approx(100, abs=0.003)
        x.move_absolute(position=50).wait()
        s.run(0.3)
        assert x.true_position == pytest.approx(150, abs=0.003)
        x.step_direct(set_position=150).wait()
        s.run(0.3)
        assert x.true_position == pytest.approx(150, abs=0.003)
