"""AX-82, AX-87, EN-26: plants and engines that die or are held up, and messages that are lost."""

from __future__ import annotations

import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running, taktd
from plants import LONG_S, Lag, eventually, inside, only_x, outside, plant, served
from takt import drive


def test_a_plant_that_dies(tmp_path: Path) -> None:
    """AX-82, AX-87: kill -9; drive error and a stop within the limits, other axes go on; a new plant and a reset, and
    it runs again."""
    url = new_url()
    machine = outside(url, 5, 0.5)
    with plant(tmp_path, machine) as one, takt.Engine(machine) as engine:
        x, y, z = (engine.axis(name) for name in ("x", "y.2", "z"))
        for axis in (x, y, z):
            axis.power().wait()
        for axis in (x, y, z):
            axis.move_velocity(velocity=50.0)
        engine.run(0.5)
        record = engine.record()
        one.process.kill()
        with pytest.warns(takt.DriveWarning, match="no plant answers"):
            engine.run(0.5)
        recording = record.stop()
        for axis in (x, y):
            assert axis.state is takt.PlcState.ERROR_STOP
            assert axis.error == 3002
            assert not axis.loop_closed
            takt.expect.within_limits(recording, axis.name)
            # Nothing for four cycles, then the ramp: v/a + a/j or less, and the end of the loop.
            closed = int(np.sum(recording[axis.name]["loop_closed"]))
            assert 20 < closed < 100
        assert z.state is takt.PlcState.CONTINUOUS_MOTION
        assert z.set_velocity == 50.0
        assert x.reset().wait_final().error
        with plant(tmp_path, machine):

            def heard() -> bool:
                x.reset().wait_final()
                y.reset().wait_final()
                return x.error == 0 and y.error == 0

            eventually(heard)
            x.power().wait()
            y.power().wait()
            x.move_absolute(position=7.0).wait()
            engine.run(0.1)
            assert x.actual_position == pytest.approx(7.0, abs=0.01)
            assert y.error == 0


def test_an_engine_that_dies(tmp_path: Path) -> None:
    """AX-82: drives that do not hear their engine any more are off, the brake falls; a new engine has them again."""
    url = new_url()
    machine = only_x(url, 2000)
    file = tmp_path / "machine.yaml"
    file.write_text(machine)
    lag = Lag()
    with served(url, lag, watchdog=2000) as (_, said):
        engine = subprocess.Popen([taktd(), str(file), "--lcm-url", url, "--pace", "real"], stdout=subprocess.DEVNULL)
        with takt.connect(url) as session:
            session.axis("x").power().wait(timeout=LONG_S)
            assert lag.told.enable
            eventually(lambda: lag.told.release_brake)  # told in the cycle after
            assert lag.told.release_brake
        engine.kill()
        engine.wait()
        eventually(lambda: not lag.told.enable)
        assert lag.told == drive.SetPoint()
        eventually(lambda: len(said) > 1)
        assert said == ["x: an engine has started", "x: no set point for 2000 periods: off, brake on"]
        with running(tmp_path, url, machine=machine, pace="real"), takt.connect(url) as session:
            session.axis("x").power().wait(timeout=LONG_S)
            assert lag.told.enable


def test_an_engine_that_is_held_up(tmp_path: Path) -> None:
    """AX-82: a drive that the watchdog has switched off stays off until it is switched off and on again."""
    url = new_url()
    machine = only_x(url, 100_000)
    lag = Lag()
    with (
        served(url, lag, watchdog=2000) as (_, said),
        running(tmp_path, url, machine=machine, pace="real") as process,
        takt.connect(url) as session,
    ):
        x = session.axis("x")
        x.power().wait(timeout=LONG_S)
        process.send_signal(signal.SIGSTOP)
        eventually(lambda: not lag.told.enable)
        process.send_signal(signal.SIGCONT)
        eventually(lambda: any("is heard again; off until it is switched on anew" in line for line in said))
        assert not lag.told.enable
        session.wait(lambda: x.state is takt.PlcState.ERROR_STOP, LONG_S)
        assert x.error == 3002
        assert not lag.told.enable
        x.reset().wait(timeout=LONG_S)
        x.power().wait(timeout=LONG_S)
        assert lag.told.enable


def test_simulated_time_knows_no_watchdog() -> None:
    """AX-82, EN-06: while simulated time stands still, nothing runs out."""
    url = new_url()
    lag = Lag()
    with served(url, lag, watchdog=1) as (_, said), takt.Engine(only_x(url)) as engine:
        x = engine.axis("x")
        x.power().wait()
        time.sleep(0.2)
        assert lag.told.enable
        x.move_absolute(position=5.0).wait()
        assert x.error == 0
        assert said == ["x: an engine has started, in simulated time"]


def test_lost_set_points_are_made_up_for(tmp_path: Path) -> None:
    """EN-26: a simulated servo to which some cycles never came holds what it was told last meanwhile."""
    file = tmp_path / "machine.yaml"
    file.write_text(inside(new_url()))
    all_, some = (drive.SimulatedServo(file, "x") for _ in range(2))
    told = [
        drive.SetPoint(enable=True, release_brake=True, position_counts=10.0 * i, period_s=0.001) for i in range(300)
    ]
    for i in range(100):
        all_.step(told[i], 0.001)
        some.step(told[i], 0.001)
    for _ in range(4):
        expected = all_.step(told[99], 0.001)
    expected = all_.step(told[110], 0.001)
    assert some.step(told[110], 0.005) == expected
