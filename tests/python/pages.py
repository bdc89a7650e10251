"""The live page in tests: its server as a process, a client of its socket, and a real browser."""

from __future__ import annotations

import contextlib
import json
import re
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
from playwright.sync_api import Browser, Page
from websockets.sync.client import connect as connect_socket

from tools.browser import CHROMIUM

PATIENCE_S = 60.0  # for things that take a moment; nothing is judged by how long they take

# A mover, another one before it, and a loop for both.
TWO_ON_A_LOOP = """\
tracks:
  - name: loop
    closed_loop: true
    elements: [{from: {x: 0, y: 0}, to: {x: 800, y: 0}}, {from: {x: 800, y: 600}, to: {x: 0, y: 600}}]
movers:
  - {name: one, initial: {x: 100, y: 0}, gap: 200, xy: {maximum: {velocity: 1000, acceleration: 5000, jerk: 100000}}}
  - {name: two, initial: {x: 700, y: 0}, gap: 200, xy: {maximum: {velocity: 1000, acceleration: 5000, jerk: 100000}}}
"""

needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="chromium-headless-shell is not installed")


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
        self.holes: dict[int, int] = {}  # frames that say that rows before them were overwritten, by component
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
        for index, count, fields, skipped in self.header["signals"]:
            self.holes[index] = self.holes.get(index, 0) + (skipped > 0)
            self.cycles.setdefault(index, []).append(numbers[at : at + count])
            at += count
            for field in fields:
                self.values.setdefault((index, field), []).append(numbers[at : at + count])
                at += count
        assert at == len(numbers)


# --- In a browser ---


@contextlib.contextmanager
def opened(browser: Browser, address: str, hash_: str = "", dark: bool = False) -> Iterator[Page]:
    """The page in a profile of its own. It must not complain, and ask nobody but its server."""
    complaints: list[str] = []
    asked: set[str] = set()
    context = browser.new_context(viewport={"width": 1440, "height": 860}, color_scheme="dark" if dark else "light")
    page = context.new_page()
    page.set_default_timeout(PATIENCE_S * 1000)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("request", lambda request: asked.add(re.sub(r"^(\w+://[^/]*/).*", r"\1", request.url)))
    page.goto(address + hash_)
    yield page
    context.close()
    assert complaints == []
    assert asked <= {address}, asked


def until(page: Page, condition: str, *arguments: Any) -> None:
    """Until an expression of the page's own world holds."""
    page.wait_for_function(condition, arg=list(arguments))


def column(page: Page, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Cycles and values that the page has of a signal."""
    component, field = name.rsplit(".", 1)
    script = """([component, field]) => {
        const { model, scope } = window.takt;
        const series = scope.store.series.get(model.byName.get(component).index);
        return [[...series.cycles.subarray(0, series.end)], [...series.columns.get(field).subarray(0, series.end)]];
    }"""
    cycles, values = page.evaluate(script, [component, field])
    return np.array(cycles), np.array(values, dtype=float)


def wait_for_cycle(page: Page, cycle: int) -> None:
    script = """([cycle]) => {
        const all = [...window.takt.scope.store.series.values()];
        return all.length > 0 && all.every((series) => series.last >= cycle);
    }"""
    until(page, script, int(cycle))


def row(page: Page, name: str) -> Any:
    return page.locator("#list .row:visible", has=page.locator(f".name:text-is('{name}')"))
