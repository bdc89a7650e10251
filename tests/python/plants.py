"""Machines with drives in other processes, and plants for them: `takt plant`, or on a thread."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import yaml
from takt import drive

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
    try:
        yield made, said
    finally:
        made.stop()
        thread.join(LONG_S)


def only_x(url: str, missing_cycles: int = 5, answer_within_s: float = 20.0) -> str:
    text = yaml.safe_load(outside(url, missing_cycles, answer_within_s))
    text["external"]["drives"] = text["external"]["drives"][:1]
    return yaml.safe_dump(text)
