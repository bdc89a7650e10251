"""Torques and their limit (docs/axis.md)."""

from __future__ import annotations

import numpy as np
import pytest
import takt
from takt.plcopen import MC_StepBlock, MC_TorqueControl

TORQUE = list(takt.LimitedBy).index(takt.LimitedBy.TORQUE)
MACHINE = """
name: torques
axes:
  - name: x
    limits: {{velocity: 220, acceleration: 3500, jerk: 70000{limit}}}
    supervision: {{deviation_moving: 40}}
    drive: {{mode: {mode}}}
    loop: {{kp: 0.1, velocity_at_10v: 500}}
    encoder: {{increments_per_unit: {increments}}}
simulation:
  servos:
    - axis: x
      drive: {{max_torque: 8}}
      mechanics: {{inertia: {inertia}, coulomb_friction: 0.01{stop}}}
      encoder: {{increments_per_unit: {increments}}}
"""


def machine(
    inertia: float = 2e-5, stop: str = "", limit: str = "", mode: str = "cyclic_position", increments: int = 2000
) -> str:
    return MACHINE.format(inertia=inertia, stop=stop, limit=limit, mode=mode, increments=increments)


@pytest.mark.parametrize("increments", [64, 10000])
@pytest.mark.parametrize("inertia", [5e-6, 1e-3])
@pytest.mark.parametrize("mode", ["cyclic_position", "cyclic_velocity"])
def test_torque_control_keeps_the_limits(mode: str, inertia: float, increments: int) -> None:
    """AX-42, AX-13: however light the load, however coarse the encoder, on the way up, turning round, and into the next
    command; and at the velocity the axis is at it."""
    with takt.Engine(machine(inertia, mode=mode, increments=increments)) as s:
        x = s.axis("x")
        x.power().wait()
        with s.record("x") as recorder:
            for torque in (2.0, -2.0, 3.0):
                x.torque_control(torque=torque, velocity=200)
                s.run(0.9)
                assert x.actual_velocity == pytest.approx(200 if torque > 0 else -200, abs=1 + 1001 / increments)
                assert str(x.limited_by) == "velocity"
            x.torque_control(torque=0.5, velocity=40, acceleration=900, torque_ramp=4)
            s.run(0.5)
            x.halt().wait()
        takt.expect.within_limits(recorder.recording, "x")
        if increments > 1000 and inertia < 1e-4:  # the metal, too, but for what its velocity loop lags behind
            accelerations = np.abs(np.diff(recorder.recording["x"]["actual_velocity"])) / 0.001
            assert accelerations.max() < 3500 * 1.15 + 2 * 1e6 / increments


def test_the_block_takes_acceleration() -> None:
    """AX-42: a slow start by Acceleration alone."""
    with takt.Engine(machine()) as s:
        x = s.axis("x")
        x.power().wait()
        block = MC_TorqueControl(x, Execute=True, Torque=3.0, Velocity=100.0, Acceleration=250.0)
        for _ in range(200):
            block()
            s.step()
        assert x.set_velocity == pytest.approx(250 * 0.2, rel=0.1)
        assert str(x.limited_by) == "acceleration"


@pytest.mark.parametrize("mode", ["cyclic_position", "cyclic_velocity", "analog"])
def test_the_drive_keeps_the_torque_limit(mode: str) -> None:
    """AX-105: of the machine file, then one written at run time; limited_by says torque while it is all used."""
    with takt.Engine(machine(1e-3, limit=", torque: 2.5", mode=mode)) as s:
        x = s.axis("x")
        x.power().wait()
        for limit in (2.5, 1.25):
            if limit != 2.5:
                x.write_parameter(number=1008, value=limit).wait()
            assert x.read_parameter(number=1008).wait().value == limit
            with s.record("x") as recorder:
                x.move_relative(distance=150, acceleration=3500).wait_final(timeout=20)
                s.run(0.3)
            torque = np.abs(recorder.recording["x"]["torque_nm"])
            assert torque.max() == pytest.approx(limit)
            reasons = np.asarray(recorder.recording["x"]["limited_by"])
            assert (reasons[torque >= limit * 0.9999] == TORQUE).all()
            assert x.set_position == pytest.approx(150 * (1 if limit == 2.5 else 2))
        refused = x.torque_control(torque=1.3).wait_final()
        assert refused.error
        for beyond in (-1, 0, 2.6):
            assert x.write_parameter(number=1008, value=beyond).wait_final().error_id == 5
        x.write_parameter(number=1008, value=2.5).wait()  # that of the file again


@pytest.mark.parametrize("torque", [0.2, 0.9])
def test_homing_onto_a_stop_pushes_no_harder_than_asked(torque: float) -> None:
    """AX-105: TorqueLimit of MC_StepBlock, and of the section homing of the machine file."""
    text = machine(stop=", lower_stop: -30")
    homed_by_file = text.replace(
        "    drive: {mode",
        f"    homing: {{method: block, velocity: 30, deviation: 2, torque_limit: {torque}}}\n    drive: {{mode",
    )
    for by_block in (True, False):
        with takt.Engine(text if by_block else homed_by_file) as s:
            x = s.axis("x")
            x.power().wait()
            block = MC_StepBlock(x, Velocity=30.0, DevRef=2.0, SetPosition=5.0, TorqueLimit=torque)
            home = None if by_block else x.home(position=5)
            with s.record("x") as recorder:
                for _ in range(4000):
                    if by_block:
                        block(Execute=True)
                    s.step()
                    if block.Done or (home is not None and home.final):
                        break
            assert x.homed
            pushing = np.abs(recorder.recording["x"]["torque_nm"])
            assert pushing.max() == pytest.approx(torque)
            assert TORQUE in set(recorder.recording["x"]["limited_by"])
            assert x.set_position == pytest.approx(5, abs=0.1)
            x.move_relative(distance=20).wait()  # free again
            assert x.true_position == pytest.approx(-10, abs=0.2)


DIRECT = """
name: direct
axes:
  - {name: x, limits: {velocity: 400, acceleration: 4000, jerk: 80000, upper: 70}, drive: {mode: analog},
     loop: {kp: 0.05, velocity_at_10v: 800}}
simulation:
  servos:
    - {axis: x, drive: {velocity_at_10v: 800}, switches: {limit_negative: {to: -25}}}
"""


@pytest.mark.parametrize(("voltage", "error"), [(0.75, 2006), (-1.5, 2005)])
def test_a_voltage_put_out_turns_the_motor_until_a_limit(voltage: float, error: int) -> None:
    """AX-53: with the loop open; it ends at the switch and at the SW limit, and needs a reset."""
    with takt.Engine(DIRECT) as s:
        x = s.axis("x")
        x.direct_output(voltage=voltage).wait()
        s.run(0.2)  # the drive gets ready
        assert x.actual_velocity == pytest.approx(voltage * 80, rel=0.02)
        assert (x.state, x.loop_closed) == (takt.PlcState.DISABLED, False)
        s.run(2.0)
        assert (x.actual_velocity, x.voltage_v, x.error) == (0, 0, error)
        assert x.true_position == pytest.approx(70 if voltage > 0 else -25, abs=0.6)
        x.reset().wait()
        x.direct_output(voltage=-voltage).wait()  # away from there
        s.run(0.15)
        assert x.actual_velocity * voltage < 0


def test_power_closes_the_loop_of_a_motor_at_rest() -> None:
    """AX-53, AX-20: 0 V first; then the loop, without a step."""
    with takt.Engine(DIRECT) as s:
        x = s.axis("x")
        x.direct_output(voltage=3).wait()
        s.run(0.15)
        with s.record() as recorder:
            x.power().wait()
            s.run(0.1)
        assert np.abs(recorder.recording["x"]["following_error"]).max() < 0.1
        assert x.actual_velocity == 0
        assert x.direct_output(voltage=1).wait_final().error_id == 13
        x.power(enable=False).wait()
        pulse = x.pulse_output(voltage=1, duration=0.2)
        s.run(0.15)
        assert x.actual_velocity > 0
        pulse.wait()
        s.run(0.05)
        assert x.actual_velocity == 0
