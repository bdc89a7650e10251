"""Machines whose drives are on a CANopen bus, emulated ones in this process, and the process of the drives."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from takt import _core, drive
from takt.drives.canopen_bus import CanopenBus
from takt.drives.emulation import EmulatedNode, Emulation, emulated_link, emulated_nodes

LONG_S = 60.0
PERIOD_S = 0.004

# In real time on a busy host a drive has failed that is silent for 2 s, and an engine that is for 4 s.
PATIENT = "missing_cycles: 500\n      heartbeat_s: 0.5"
PATIENT_WATCHDOG = 1000  # cycles
SILENCE_S = 2.0  # without SYNC, before an emulated drive has a fault

_channels = itertools.count()


def new_bus() -> str:
    """A bus of this process alone."""
    return f"canopen:virtual:{os.getpid()}-{next(_channels)}"


def machine(
    url: str,
    bus: str,
    axes: int = 2,
    *,
    place: str = "node",
    drive_keys: str = "",
    bus_keys: str = "",
    axis_keys: str = "",
) -> str:
    lines = ["name: bus", f"cycle: {{period_s: {PERIOD_S}, overruns_in_a_row: 0}}", f'lcm: {{url: "{url}"}}', "axes:"]
    for k in range(1, axes + 1):
        lines += [
            f"  - name: x{k}",
            "    limits: {velocity: 500, acceleration: 5000, jerk: 100000}",
            "    encoder: {increments_per_unit: 1000}",
        ]
        lines += [f"    {axis_keys}"] if axis_keys else []
    lines += ["external:", "  answer_within_s: 20", "  buses:", f'    - bus: "{bus}"']
    lines += [f"      {bus_keys}"] if bus_keys else []
    lines += ["      drives:"]
    for k in range(1, axes + 1):
        lines += [f"        - {{axis: x{k}, {place}: {k}{', ' + drive_keys if drive_keys else ''}}}"]
    return "\n".join(lines) + "\n"


def described(text: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(_core.load_machine(text.encode(), "machine.yaml"))
    return found


@contextlib.contextmanager
def emulated(text: str, leave_out: Sequence[int] = (), product: int | None = None) -> Iterator[Emulation]:
    """The drives of the machine's only bus, on a thread."""
    whole = described(text)
    one = whole["external"]["buses"][0]
    nodes: list[EmulatedNode] = emulated_nodes(one, whole, text.encode(), "machine.yaml")
    with emulated_link(one["bus"]) as link:
        emulation = Emulation(link, [node for node in nodes if node.id not in leave_out], lambda _: None)
        emulation.silence_s = SILENCE_S
        thread = threading.Thread(target=emulation.run)
        thread.start()
        try:
            yield emulation
        finally:
            emulation.stop()
            thread.join(LONG_S)


AnyBus = TypeVar("AnyBus", bound=drive.Bus)


@contextlib.contextmanager
def run_on(kind: Callable[..., AnyBus], text: str, url: str, watchdog: int) -> Iterator[tuple[AnyBus, list[str]]]:
    """What `takt drives run` is, on a thread; what it says."""
    said: list[str] = []
    whole = described(text)
    bus = kind(whole["external"]["buses"][0], whole, said.append)
    plant = drive.Plant({}, url, buses=[bus], watchdog=watchdog, say=said.append)
    thread = threading.Thread(target=plant.run)
    thread.start()
    try:
        yield bus, said
    finally:
        plant.stop()
        thread.join(LONG_S)
        bus.close()
        print(*said, sep="\n")  # shown by pytest where a test fails


def run(
    text: str, url: str, watchdog: int = drive.WATCHDOG
) -> contextlib.AbstractContextManager[tuple[CanopenBus, list[str]]]:
    return run_on(CanopenBus, text, url, watchdog)


def eventually(condition: Any, within_s: float = LONG_S) -> bool:
    end_s = time.monotonic() + within_s
    while not condition() and time.monotonic() < end_s:
        time.sleep(0.002)
    return bool(condition())


class Said:
    """A process of `takt drives`, and its lines."""

    def __init__(self, *arguments: object) -> None:
        command = [sys.executable, "-m", "takt", "drives", *map(str, arguments)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.lines: list[str] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.lines.append(line.rstrip())

    def wait_for(self, text: str) -> None:
        eventually(lambda: any(text in line for line in self.lines) or self.process.poll() is not None)
        assert any(text in line for line in self.lines), self.lines

    def tell(self, line: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def end(self) -> int:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(60)
        self._reader.join(60)
        assert self.process.stdin is not None
        self.process.stdin.close()
        return code


@contextlib.contextmanager
def drives(*arguments: object) -> Iterator[Said]:
    process = Said(*arguments)
    try:
        yield process
    finally:
        process.end()
