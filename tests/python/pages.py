"""The live page in tests: its server as a process, a client of its socket, and a real browser."""

from __future__ import annotations

import contextlib
import json
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from websockets.sync.client import connect as connect_socket

CHROMIUM = shutil.which("chromium")
FLAGS = (
    "--headless --no-sandbox --disable-gpu --disable-background-networking --disable-component-update --disable-sync "
    "--no-first-run"
).split()
PATIENCE_S = 30.0  # for things that take a moment; nothing is judged by how long they take

needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def start_server(*arguments: str, port: int = 0) -> tuple[subprocess.Popen[str], str]:
    """`takt view` as a process, and its address."""
    command = [sys.executable, "-m", "takt", "view", *arguments, "--no-browser", "--port", str(port)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert process.stdout is not None
    line = process.stdout.readline()
    assert "http://" in line, line + process.stdout.read()
    return process, line[line.index("http://") :].split()[0]


@contextlib.contextmanager
def served(*arguments: str, port: int = 0) -> Iterator[str]:
    """The address of the page, as long as its server runs."""
    process, address = start_server(*arguments, port=port)
    try:
        yield address
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=20)
    assert process.returncode == 130, said
    assert "Traceback" not in said, said


class Client:
    """What a page hears, without a browser."""

    def __init__(self, address: str) -> None:
        self._stack = contextlib.ExitStack()
        url, origin = address.replace("http", "ws") + "live", address.rstrip("/")
        self._socket: Any = self._stack.enter_context(connect_socket(url, origin=origin, max_size=None))
        self.machine: dict[str, Any] = {}
        self.complaints: list[str] = []
        self.header: dict[str, Any] = {}
        self.rows: dict[int, dict[str, Any]] = {}
        self.cycles: dict[int, list[np.ndarray]] = {}
        self.values: dict[tuple[int, str], list[np.ndarray]] = {}
        self.live = np.empty(0)
        self.answers: list[dict[str, str]] = []

    def __enter__(self) -> Client:
        self.until(lambda: self.header)
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def ask(self, **request: Any) -> None:
        self._socket.send(json.dumps(request))

    def say(self, text: str) -> None:
        self._socket.send(text)

    def index(self, name: str) -> int:
        return next(i for i, c in enumerate(self.machine["components"]) if c["name"] == name)

    def state(self, name: str) -> str:
        """In words; empty before it was told."""
        return str(self.rows.get(self.index(name), {}).get("state", ""))

    def look_at(self, *signals: str, **more: Any) -> None:
        pairs = [signal.rsplit(".", 1) for signal in signals]
        self.ask(epoch=self.machine["epoch"], signals=[[self.index(name), field] for name, field in pairs], **more)

    def give(self, target: str, verb: str, **arguments: Any) -> None:
        self.ask(epoch=self.machine["epoch"], command=[target, verb, arguments])

    def hold(self, on: bool = True) -> None:
        self.ask(epoch=self.machine["epoch"], hold=on)

    def until(self, condition: Callable[[], Any], timeout: float = PATIENCE_S) -> None:
        end = time.monotonic() + timeout
        while not condition():
            assert time.monotonic() < end, "the page was not told what it waits for"
            self._take(self._socket.recv(timeout=timeout))

    def signal(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Cycles and values of a signal that is looked at."""
        component, field = name.rsplit(".", 1)
        index = self.index(component)
        if index not in self.cycles:
            return np.empty(0), np.empty(0)
        return np.concatenate(self.cycles[index]), np.concatenate(self.values[index, field])

    def _take(self, data: str | bytes) -> None:
        if isinstance(data, str):
            said = json.loads(data)
            self.complaints += [said["complaint"]] if "complaint" in said else []
            if "machine" in said:
                self.machine, self.rows = said["machine"], {}
                self.cycles, self.values = {}, {}
            return
        (length,) = struct.unpack("<I", data[:4])
        self.header = json.loads(data[4 : 4 + length])
        numbers = np.frombuffer(data[(4 + length + 7) // 8 * 8 :])
        self.ask(ack=self.header["n"])
        self.live = numbers[: self.header["live"]]
        self.answers += self.header.get("answers", [])
        for row in self.header.get("rows", ()):
            self.rows[row["i"]] = row
        at = self.header["live"]
        for index in self.header["details"]:
            at += len(self.machine["kinds"][self.machine["components"][index]["kind"]]["fields"])
        for index, count, fields, _ in self.header["signals"]:
            self.cycles.setdefault(index, []).append(numbers[at : at + count])
            at += count
            for field in fields:
                self.values.setdefault((index, field), []).append(numbers[at : at + count])
                at += count
        assert at == len(numbers)
