"""AX-82, AX-87, EN-26: drives in other processes, over the network, with engines that run in process and in taktd."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import lcm
import numpy as np
import pytest
import takt
import yaml
from machines import new_url, running, taktd
from takt import drive, msgs

LONG_S = 60.0  # nothing takes so long

INSIDE = """\
name: test
cycle: {overruns_in_a_row: 0}  # a loaded computer is late now and then
lcm: {axis_rate_hz: 1000, url: "URL"}
axes:
  - name: x
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
    encoder: {increments_per_unit: 1000}
  - name: y.2
    limits: {velocity: 300, acceleration: 3000, jerk: 60000}
    drive: {mode: analog}
    loop: {velocity_at_10v: 400, kp: 0.05}
    encoder: {type: absolute_ssi, coding: gray, increments_per_unit: 2000}
  - name: z
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
simulation:
  servos:
    - axis: y.2
      drive: {velocity_at_10v: 400, offset_mv: 20}
      mechanics: {coulomb_friction: 0.1, backlash: 0.01, inertia: 0.0003}
      switches: {touch_probe: {from: 30}, limit_positive: {from: 100}}
      encoder: {type: absolute, coding: gray, increments_per_unit: 2000, noise_counts: 0.5}
"""


def outside(url: str, missing_cycles: int = 5, answer_within_s: float = 20.0) -> str:
    """The machine with x and y.2 in another process."""
    drives = ", ".join(f"{{axis: {axis}, missing_cycles: {missing_cycles}}}" for axis in ("x", "y.2"))
    external = f"external: {{answer_within_s: {answer_within_s}, drives: [{drives}]}}\n"
    return INSIDE.replace("URL", url) + external


def inside(url: str) -> str:
    return INSIDE.replace("URL", url)


class Process:
    """`takt plant` and what it says."""

    def __init__(self, machine: Path, *options: str) -> None:
        command = [sys.executable, "-m", "takt", "plant", str(machine), *options]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        self.lines: list[str] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()
        self.wait_for("simulating")

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.lines.append(line.rstrip())

    def wait_for(self, text: str, times: int = 1) -> None:
        eventually(lambda: sum(text in line for line in self.lines) >= times or self.process.poll() is not None)
        assert sum(text in line for line in self.lines) >= times, self.lines

    def end(self, number: int = signal.SIGTERM) -> None:
        if self.process.poll() is None:
            self.process.send_signal(number)
        self.process.wait(LONG_S)
        self._reader.join(LONG_S)


@contextlib.contextmanager
def plant(directory: Path, text: str, *options: str) -> Iterator[Process]:
    file = directory / "plant.yaml"
    file.write_text(text)
    process = Process(file, *options)
    try:
        yield process
    finally:
        process.end()


def eventually(condition: Callable[[], object]) -> None:
    end = time.monotonic() + LONG_S
    while not condition() and time.monotonic() < end:
        time.sleep(0.002)


def work(session: takt.Session) -> takt.Recording:
    """Something for every axis."""
    record = session.record()
    x, y, z = (session.axis(name) for name in ("x", "y.2", "z"))
    for axis in (x, y, z):
        axis.power().wait()
    x.move_absolute(position=100.0)
    y.arm_probe(edge="rising")
    y.move_velocity(velocity=80.0)
    z.gear_in(master="x")
    session.run(1.0)
    x.move_absolute(position=0.0, velocity=200.0).wait()
    y.reset().wait_final()
    return record.stop()


def same(a: takt.Recording, b: takt.Recording) -> bool:
    return all(a[axis].tobytes() == b[axis].tobytes() for axis in ("x", "y.2", "z"))


def test_a_plant_in_another_process_is_the_built_in_one(tmp_path: Path) -> None:
    """AX-87, EN-26: in simulated time bit for bit, whatever the processes do in between; and again."""
    url = new_url()
    with takt.Engine(inside(url)) as engine:
        expected = work(engine)
    assert np.ptp(expected["x"]["actual_position"]) > 90
    assert expected["y.2"]["probe_captures"][-1] == 1
    with plant(tmp_path, outside(url)):
        for late in (0, 2):  # the second engine may still hear an answer for each drive to the first, and refuses it
            with takt.Engine(outside(url)) as engine:
                assert same(work(engine), expected)
                assert engine.figures["samples_refused"] <= late


def test_engine_and_plant_may_come_in_any_order(tmp_path: Path) -> None:
    """EN-26: an engine in simulated time waits for its plant."""
    url = new_url()
    with takt.Engine(outside(url)) as engine:
        begun = threading.Thread(target=engine.run, args=(0.5,))
        begun.start()
        time.sleep(0.3)
        assert begun.is_alive()
        with plant(tmp_path, outside(url)):
            begun.join(LONG_S)
        assert engine.cycle == 500
        assert engine.axis("x").error == 0


def test_a_journal_needs_no_plant(tmp_path: Path) -> None:
    """EN-07, EN-26: what taktd heard of the drives is in its log."""
    for pace in ("fast", "paced", "real"):
        url = new_url()
        file = tmp_path / f"{pace}.lcm"
        machine = outside(url, missing_cycles=2000)
        with (
            plant(tmp_path, machine, "--watchdog", "5000"),
            running(tmp_path, url, "--log", str(file), machine=machine, pace=pace),
            takt.connect(url) as session,
        ):
            x, y = session.axis("x"), session.axis("y.2")
            x.power()
            y.power().wait(timeout=LONG_S)
            x.move_absolute(position=20.0)
            y.move_absolute(position=10.0).wait(timeout=LONG_S)
        result = takt.replay(file)
        assert result.same, result.sentence
        assert np.ptp(takt.read_log(file)["x"]["actual_position"]) > 10


class Lag(drive.Drive):
    """Of the first order."""

    def __init__(self) -> None:
        self.counts = 0.0
        self.told = drive.SetPoint()
        self.silent = False
        self.torque_nm = 0.0

    def step(self, told: drive.SetPoint, elapsed_s: float) -> drive.Measured:
        self.told = told
        if told.enable:
            self.counts += 0.5 * (told.position_counts - self.counts)
        return drive.Measured(counts=round(self.counts), drive_ready=told.enable, torque_nm=self.torque_nm)


@contextlib.contextmanager
def served(url: str, served_drive: drive.Drive, watchdog: int = 100) -> Iterator[tuple[drive.Plant, list[str]]]:
    """A plant for axis x on a thread of this process."""
    said: list[str] = []
    made = drive.Plant({"x": served_drive}, url, watchdog=watchdog, say=said.append)
    thread = threading.Thread(target=made.run)
    thread.start()
    eventually(lambda: made._running)
    try:
        yield made, said
    finally:
        made.stop()
        thread.join(LONG_S)


def only_x(url: str, missing_cycles: int = 5, answer_within_s: float = 20.0) -> str:
    text = yaml.safe_load(outside(url, missing_cycles, answer_within_s))
    text["external"]["drives"] = text["external"]["drives"][:1]
    return yaml.safe_dump(text)


def test_a_plant_of_ones_own() -> None:
    """EN-26."""
    url = new_url()
    lag = Lag()
    with served(url, lag), takt.Engine(only_x(url)) as engine:
        x = engine.axis("x")
        x.power().wait()
        x.move_absolute(position=-30.0).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(-30.0, abs=0.002)
        assert lag.counts == pytest.approx(-30_000.0, abs=2.0)
        engine.shut_down()


def test_what_the_documentation_shows() -> None:
    """EN-26: its machine and its drive."""
    page = (Path(__file__).parents[2] / "docs" / "real_drives.md").read_text()
    machine = page.partition("```yaml\n")[2].partition("```")[0]
    code, call, _ = page.partition("```python\n")[2].partition("```")[0].partition("drive.Plant(")
    assert call
    shown: dict[str, Any] = {}
    exec(code, shown)
    url = new_url()
    with served(url, shown["Lag"]()), takt.Engine(machine, url=url) as engine:
        x = engine.axis("x")
        x.power().wait()
        x.move_absolute(position=50.0).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(50.0, abs=0.002)


def answer(url: str, **changes: object) -> None:
    """A message to the engine from somebody else."""
    message = msgs.drive_feedback()
    message.axis = "x"
    channel = str(changes.pop("channel", "takt/drive/x/feedback"))
    for name, value in changes.items():
        setattr(message, name, value)
    lcm.LCM(url).publish(channel, message.encode())


class Wrong(Lag):
    """Answers with what the engine must refuse, in one cycle."""

    def __init__(self, url: str, changes: dict[str, object]) -> None:
        super().__init__()
        self.send = lambda: answer(url, **changes)
        self.calls = 0

    def step(self, told: drive.SetPoint, elapsed_s: float) -> drive.Measured:
        measured = super().step(told, elapsed_s)
        self.calls += 1
        if self.calls == 300:
            self.send()
            time.sleep(0.05)  # so that it comes first
        return measured


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"channel": "takt/drive/q/feedback"}, "expected the name of an axis, found 'q'"),
        ({"channel": "takt/drive/z/feedback"}, "external.drives do not name axis z"),
        ({"axis": "z"}, "axis: expected x, found 'z'"),
        ({"run_id": 5}, "answers another start of an engine"),
    ],
)
def test_wrong_messages_are_refused(changes: dict[str, object], sentence: str) -> None:
    """AX-87: with a sentence, and nothing comes of them."""
    url = new_url()

    def run(wrong: bool) -> tuple[takt.Recording, list[str]]:
        made = Wrong(url, changes) if wrong else Lag()
        with served(url, made), takt.Engine(only_x(url)) as engine, warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            record = engine.record()
            x = engine.axis("x")
            x.power().wait()
            x.move_absolute(position=50.0).wait()
            engine.run(0.2)
            return record.stop(), [str(w.message) for w in caught if w.category is takt.DriveWarning]

    expected, nothing = run(False)
    recording, sentences = run(True)
    assert nothing == []
    assert len(sentences) == 1
    assert sentence in sentences[0]
    assert recording["x"].tobytes() == expected["x"].tobytes()


@pytest.mark.filterwarnings("ignore:.*no plant answers")
def test_what_is_no_number_is_refused() -> None:
    """AX-87: a drive whose numbers are none is as good as silent."""
    url = new_url()
    lag = Lag()
    with served(url, lag), takt.Engine(only_x(url, 3, 0.5)) as engine:
        x = engine.axis("x")
        x.power().wait()
        lag.torque_nm = float("nan")
        with pytest.warns(takt.DriveWarning, match="torque_nm: expected a finite number, found nan"):
            engine.run(0.02)
        assert x.state is takt.PlcState.ERROR_STOP
        assert x.error == 3002
        assert np.isfinite(x.torque_nm)


def test_messages_of_another_version_are_refused() -> None:
    """EN-20: another fingerprint."""
    url = new_url()

    class Other(Lag):
        def step(self, told: drive.SetPoint, elapsed_s: float) -> drive.Measured:
            measured = super().step(told, elapsed_s)
            lcm.LCM(url).publish("takt/drive/x/feedback", b"\x01" + msgs.drive_feedback().encode()[1:])
            return measured

    with served(url, Other()), takt.Engine(only_x(url)) as engine:
        with pytest.warns(takt.DriveWarning, match="no drive_feedback of this version of Takt"):
            eventually(lambda: engine.figures["samples_refused"] or engine.run(0.05))
        assert engine.axis("x").error == 0


def test_two_plants_for_one_axis() -> None:
    """AX-87: the first one is listened to, the second one is warned of."""
    url = new_url()
    first, second = Lag(), Lag()
    second.counts = 500_000.0
    with served(url, first), takt.Engine(only_x(url)) as engine:
        x = engine.axis("x")
        x.power().wait()
        with served(url, second):
            with pytest.warns(takt.DriveWarning, match="a second plant answers for this axis"):
                eventually(lambda: engine.figures["samples_refused"] or engine.run(0.01))
            x.move_absolute(position=10.0).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(10.0, abs=0.002)
        assert x.error == 0


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


def test_without_a_network_there_are_no_drives(tmp_path: Path) -> None:
    """EN-26: said in one line."""
    file = tmp_path / "machine.yaml"
    file.write_text(outside(new_url()))
    result = subprocess.run([taktd(), str(file), "--no-lcm"], capture_output=True, text=True, check=False)
    assert result.returncode == 2
    assert result.stderr == "taktd: the machine has external drives, which --no-lcm leaves out of reach\n"
    with pytest.raises(takt.ConnectionError, match="nonsense"):
        takt.Engine(file, url="nonsense")


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        (INSIDE, [], "has no external drives (external: drives: - axis: NAME)"),
        (outside("udpm://239.255.76.67:7667?ttl=0"), ["--axis", "z"], "external.drives has no axis z; it has x, y.2"),
        (outside("http://nowhere"), [], "expected one like"),
    ],
)
def test_plants_that_cannot_be(tmp_path: Path, text: str, options: list[str], sentence: str) -> None:
    """EN-26: said in one line."""
    file = tmp_path / "machine.yaml"
    file.write_text(text)
    command = [sys.executable, "-m", "takt", "plant", str(file), *options]
    result = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ)
    assert result.returncode == 2
    assert sentence in result.stderr
    assert len(result.stderr.splitlines()) == 1
    with pytest.raises(takt.TaktError, match="at least one drive"):
        drive.Plant({})
