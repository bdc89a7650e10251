"""AX-87, EN-26: what drives on a bus have to do with encoders that jump, torque limits, and all tools."""

from __future__ import annotations

from pathlib import Path

import buses
import pytest
import takt
from both_buses import driven
from machines import new_url, running
from takt import expect
from takt.cli import main
from takt.drives import objects as od

SSI = "encoder: {increments_per_unit: 1000, type: absolute_ssi, ssi_bits: 32, coding: binary}"


def machine(url: str, bus: str, axes: int = 1, **more: str) -> str:
    place = "position" if bus.startswith("ethercat") else "node"
    return buses.machine(url, bus, axes, place=place, **more)


# --- a position that jumps ---


@pytest.mark.parametrize("doing", ["stands", "moves", "off"])
@pytest.mark.parametrize("jump", [9_000, -60_000, 1 << 30])
def test_a_position_that_jumps(bus: str, doing: str, jump: int, tmp_path: Path) -> None:
    """3001, the power is off at once and nothing moves; MC_Reset brings the axis back, without its reference."""
    url = new_url()
    text = machine(url, bus)
    with driven(text, url, tmp_path) as (_, tell), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        x.step_direct(set_position=0).wait()
        if doing == "moves":
            x.move_velocity(velocity=200)
        elif doing == "off":
            x.power(enable=False).wait()
        engine.run(0.2)
        tell(f"jump 1 {jump}")
        engine.wait(lambda: x.error, timeout=20)
        assert (x.error, x.state is takt.PlcState.DISABLED) == (3001, doing == "off")
        engine.run(0.3)
        assert not x.loop_closed
        assert x.actual_velocity == 0
        assert x.power().wait_final().error
        x.reset().wait()
        engine.run(0.1)
        assert (x.error, x.homed) == (0, False)
        x.power().wait()
        where = x.actual_position
        x.move_relative(distance=5).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(where + 5, abs=0.01)


def test_the_reference_of_a_drive_is_not_believed_after_a_jump(bus: str, tmp_path: Path) -> None:
    """Homing in the drive: it homes anew when it is switched on again, and not before."""
    url = new_url()
    text = machine(
        url,
        bus,
        axis_keys="drive: {ready_timeout_s: 20}\n    homing: {method: pulse, velocity: 20}",
        drive_keys="homing: {method: 35, within_s: 9}",
    )
    with driven(text, url, tmp_path) as (said, tell), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        x.home().wait()
        assert x.homed
        tell("jump 1 60000")
        engine.wait(lambda: x.error == 3001, timeout=20)
        engine.run(0.1)
        assert any("its position has jumped by" in s and "it has no reference any more" in s for s in said)
        homings = sum("homed, its position is" in line for line in said)
        assert homings == 1
        x.reset().wait()
        x.power().wait()
        assert sum("homed, its position is" in line for line in said) == 2
        x.home().wait()
        assert x.actual_position == pytest.approx(0, abs=0.1), "where it was homed just now"


@pytest.mark.parametrize("how", ["stop", "held stop", "halt", "stop_all", "power off", "emergency stop"])
def test_what_stops_a_drive_that_homes(bus: str, how: str, tmp_path: Path) -> None:
    """It comes to rest along its quick stop ramp, the axis is off, and nothing goes on by itself."""
    url = new_url()
    keys = "homing: {method: 17, velocity_switch: 60, velocity_pulse: 10, acceleration: 1000, within_s: 9}"
    text = machine(url, bus, axis_keys="drive: {ready_timeout_s: 20}", drive_keys=keys)
    text += "simulation: {servos: [{axis: x1, switches: {limit_negative: {to: -400}}}]}\n"
    with driven(text, url, tmp_path), takt.Engine(text) as engine:
        x = engine.axis("x1")
        power = x.power()
        engine.wait(lambda: x.actual_velocity < -50, timeout=20)
        stops = {
            "stop": x.stop,
            "held stop": lambda: x.stop(hold=True),
            "halt": x.halt,
            "stop_all": engine.stop_all,
            "power off": lambda: x.power(enable=False),
            "emergency stop": engine.emergency_stop,
        }
        said, where = stops[how](), x.actual_position
        engine.run(0.5)
        assert said.done
        assert power.aborted
        assert (x.actual_velocity, x.drive_ready, x.loop_closed) == (0, False, False)
        assert 0 <= where - x.actual_position < 10
        engine.run(1.0)
        assert x.actual_velocity == 0
        if how == "held stop":
            x.power()
            engine.run(1.0)
            assert x.state is takt.PlcState.DISABLED or x.move_absolute(position=5).wait_final().error
            said.release()
            x.power(enable=False).wait()
            engine.run(0.5)
        power = x.power()
        engine.wait(lambda: x.actual_velocity < -50, timeout=20)
        assert power.active


@pytest.mark.parametrize("how", ["stop", "held stop", "stop_all", "power off"])
@pytest.mark.parametrize("powered", ["by the group", "by the axis"])
def test_what_stops_drives_of_a_group_that_home(how: str, powered: str) -> None:
    """As that of an axis alone."""
    url = new_url()
    keys = "homing: {method: 17, velocity_switch: 60, velocity_pulse: 10, acceleration: 1000, within_s: 9}"
    text = machine(url, buses.new_bus(), 2, axis_keys="drive: {ready_timeout_s: 20}", drive_keys=keys)
    path = "path: {velocity: 300, acceleration: 2000, jerk: 50000}"
    text += f"groups: [{{name: g, axes: [x1, x2], kinematics: {{gantry: {{axes: [x, y]}}}}, {path}}}]\n"
    text += "simulation: {servos: [{axis: x1, switches: {limit_negative: {to: -400}}}]}\n"
    with buses.emulated(text), buses.run(text, url), takt.Engine(text) as engine:
        group, x = engine.group("g"), engine.axis("x1")
        group.enable().wait()
        power = group.power() if powered == "by the group" else x.power()
        engine.wait(lambda: x.actual_velocity < -50, timeout=20)
        stops = {
            "stop": group.stop,
            "held stop": lambda: group.stop(hold=True),
            "stop_all": engine.stop_all,
            "power off": lambda: group.power(enable=False),
        }
        said, where = stops[how](), x.actual_position
        engine.run(1.0)
        assert said.done
        assert power.aborted
        assert (x.actual_velocity, x.drive_ready, x.loop_closed) == (0, False, False)
        assert 0 <= where - x.actual_position < 10


# --- torque limits ---


@pytest.mark.parametrize("mode", ["cyclic_position", "cyclic_velocity"])
def test_a_torque_limit_outlasts_a_fault_and_a_restart(bus: str, mode: str, tmp_path: Path) -> None:
    """Of the machine file, and as it was changed at run time."""
    url = new_url()
    text = machine(url, bus, axis_keys=f"drive: {{mode: {mode}}}\n    loop: {{ff: 1, velocity_at_10v: 600}}")
    text = text.replace("jerk: 100000}", "jerk: 100000, torque: 0.8}")
    with driven(text, url, tmp_path) as (_, tell), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        x.move_absolute(position=10).wait()
        x.torque_control(torque=0.5, velocity=20, torque_ramp=100)
        engine.run(0.2)
        tell("fault 1 0x3210")
        engine.wait(lambda: x.error == 3002, timeout=20)
        engine.run(0.5)
        x.reset().wait()
        x.power().wait()
        record = engine.record()
        engine.run(0.05)
        x.move_relative(distance=5).wait()
        recording = record.stop()
        assert abs(recording["x1"]["torque_nm"]).max() <= 0.8 * 1.001
        expect.within_limits(recording, "x1")


def test_the_limit_is_at_the_drive_again(tmp_path: Path) -> None:
    """0x6072 after a fault, and, in real time, after the drive has started anew."""
    url, bus = new_url(), buses.new_bus()
    text = machine(url, bus, bus_keys=buses.PATIENT)
    text = text.replace("jerk: 100000}", "jerk: 100000, torque: 0.8}")
    with (
        buses.emulated(text) as emulation,
        buses.run(text, url, watchdog=buses.PATIENT_WATCHDOG) as (_, said),
        running(tmp_path, url, machine=text, pace="real"),
        takt.connect(url) as session,
    ):
        drive, x = emulation.nodes[1].drive, session.axis("x1")
        x.power().wait(timeout=20)
        limit = drive.read(od.MAX_TORQUE)
        assert limit == round(1000 * 0.8 / drive.scaling.rated_torque)
        for command in ("fault 1 0x3210", "power 1 off"):
            emulation.command(command)
            session.wait(lambda: x.error == 3002, timeout=20)
            if command == "power 1 off":
                assert buses.eventually(lambda: any("is not heard any more" in line for line in said), 10)
                drive.values[od.MAX_TORQUE.index] = 0xFFFF  # as a drive has it that has lost its supply
                emulation.command("power 1 on")
                assert buses.eventually(lambda: "x1: node 1 is set up again" in said, 20)
            else:
                assert buses.eventually(lambda: "x1: node 1: the fault has been reset" in said, 20)
            assert buses.eventually(lambda: x.reset().wait_final(timeout=20).done, 20), (
                "once the engine has heard of it"
            )
            x.power().wait(timeout=20)
            assert drive.read(od.MAX_TORQUE) == limit


def test_a_fault_without_a_code_is_said(bus: str, tmp_path: Path) -> None:
    url = new_url()
    text = machine(url, bus)
    with driven(text, url, tmp_path) as (said, tell), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        tell("fault 1 0x10000")  # no code: it is not understood, and nothing happens
        engine.run(0.2)
        assert x.error == 0
        tell("fault 1 0")
        engine.wait(lambda: x.error == 3002, timeout=20)
        engine.run(1.0)
        (fault,) = [n for n, line in enumerate(said) if "fault without an error code" in line]
        assert any("the fault has been reset" in line for line in said[fault:])
        x.reset().wait()


# --- tools ---


def test_every_tool_takes_a_machine_with_a_bus(
    bus: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """check, record, plot, report, replay of a journal; and what goes wrong on the bus is in the report."""
    monkeypatch.chdir(tmp_path)
    url = new_url()
    Path("machine.yaml").write_text(machine(url, bus, 2))
    text = Path("machine.yaml").read_text()
    assert main(["check", "machine.yaml"]) == 0
    with driven(text, url, tmp_path) as (_, tell), takt.Engine("machine.yaml", journal=True) as engine:
        x, y = engine.axis("x1"), engine.axis("x2")
        record = engine.record()
        for axis in (x, y):
            axis.power().wait()
        x.move_absolute(position=20).wait()
        y.move_velocity(velocity=50)
        engine.run(0.2)
        tell("fault 2 0x3210")
        engine.wait(lambda: y.error == 3002, timeout=20)
        recording = record.stop()
        assert recording["x2"]["drive_error"][-1] == 0x3210
        recording.save("run.npz")
    capsys.readouterr()
    assert main(["plot", "run.npz", "x1", "-o", "x1.png"]) == 0
    assert Path("x1.png").stat().st_size > 10_000
    assert main(["report", "run.npz"]) == 0
    assert "run.html" in capsys.readouterr().out
    assert "x2" in Path("run.html").read_text()
