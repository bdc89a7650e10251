"""Runs a scenario on an engine of its own, in real time and over LCM, and judges it from a log of the network."""

from __future__ import annotations

import contextlib
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from takt import _core
from takt.counted import counted
from takt.engine import read_machine
from takt.errors import ConnectionError, TaktError
from takt.keys import Key
from takt.lcmlog import read_log, write_log
from takt.network import open_network, roomy
from takt.remote import RemoteSession, connect
from takt.replay import ReplayResult, replay
from takt.scenario import Outcome, Scenario, play, verify_recording
from takt.source import IN_DIRECTORY

Say = Callable[[str], None]
Beside = Callable[[str], contextlib.AbstractContextManager[Any]]
Judged = Callable[["Outcome", dict[str, Any]], None]

ENDED_AT_ONCE = 130  # exit status of taktd after a second signal


def nothing(_: str) -> contextlib.AbstractContextManager[None]:
    return contextlib.nullcontext()


@dataclass(frozen=True)
class DemoResult:
    """The result of a demo: the verdicts on the log, the engine's own figures, and the result of replaying its journal
    (None: no journal was kept)."""

    outcome: Outcome
    figures: dict[str, Any]
    replayed: ReplayResult | None
    log: Path

    @property
    def passed(self) -> bool:
        return self.outcome.passed and (self.replayed is None or self.replayed.same)


def run_demo(
    scenario: Scenario,
    machine: Path,
    directory: Path,
    say: Say = print,
    pace: str = "real",
    beside: Beside = nothing,
    judged: Judged = lambda *_: None,
    stays: bool = False,
) -> DemoResult:
    """Starts taktd on the machine, logs its network, runs the scenario over LCM, ends both, and judges the log. Returns
    the result.

    directory: where all files are kept.
    say: called with progress messages.
    pace: as `taktd --pace`.
    beside: returns a context to enter while the engine runs, for the network with this URL.
    judged: called with the outcome and the engine's figures.
    stays: the engine runs on until `judged` returns, and keeps no journal, which would grow without limit.

    Raises ConfigError if the machine file is wrong, TaktError if taktd does not start or fails.
    """
    _core.load_machine(*read_machine(machine))  # raises ConfigError if it is wrong
    directory.mkdir(parents=True, exist_ok=True)
    log, kept = directory / "network.log", directory / "taktd.log"
    for old in (log, kept):
        old.unlink(missing_ok=True)
    url = free_url()
    with taktd(machine, url, None if stays else kept, pace, directory) as engine, beside(url):
        with write_log(log, url):
            say(f"taktd runs {machine} ({pace} time), {log.name} records {url}")
            with _connected(url, engine, directory / "taktd.txt") as session:
                started, began = time.monotonic(), session.now
                with session.record(every=1000) as notes:  # for its marks, which are not sent over LCM
                    played = play(scenario, session)
                took, seconds = session.now - began, time.monotonic() - started
                say(f"scenario done: {took:.1f} s of engine time in {seconds:.1f} s")
                session.run(1.5 / _rate(session.machine["lcm"]["engine_rate_hz"]))  # the last figures count everything
                figures = session.figures
        if not stays:
            _end(engine, directory / "taktd.txt")
        recording = read_log(log)
        say(f"{log.name} read back: {counted(len(recording.components), 'component')}, {recording.duration_s:.1f} s")
        marks = [event for event in notes.recording.events if event.kind == "mark"]
        recording.events = sorted([*recording.events, *marks], key=lambda event: event.time_s)
        played.keep(recording)
        outcome = verify_recording(scenario, recording)
        recording.meta["machine_file"]["folder"] = str(machine.resolve().parent)
        recording.save(directory / IN_DIRECTORY)
        judged(outcome, figures)
        if stays:
            _end(engine, directory / "taktd.txt", also=ENDED_AT_ONCE)  # the Ctrl-C that ends the stay reaches it, too
    return DemoResult(outcome, figures, None if stays else replay(kept), log)


def _connected(url: str, engine: subprocess.Popen[bytes], text: Path, timeout: float = 15.0) -> RemoteSession:
    """Returns a session as soon as the engine answers. Raises TaktError if the engine has ended, ConnectionError after
    `timeout` [s]."""
    end = time.monotonic() + timeout
    while True:
        try:
            return connect(url, timeout=0.5)
        except ConnectionError:
            if engine.poll() is not None:
                said = text.read_text(errors="replace").strip() or f"it ended with {engine.returncode}"
                raise TaktError(f"taktd does not start: {said}") from None
            if time.monotonic() > end:
                raise


def _end(engine: subprocess.Popen[bytes], text: Path, also: int = 0) -> None:
    """Ends the engine in an orderly way. Raises TaktError, with the file of its output, if it reports a failure."""
    engine.send_signal(signal.SIGINT)
    if engine.wait(20) not in (0, also):
        raise TaktError(f"taktd ended with {engine.returncode}: see {text}")


def _rate(hz: float) -> float:
    return max(float(hz), 0.1)


_PORTS = (61_000, 65_000)  # above the ephemeral ports of Linux
_TRIES = 5


def free_url() -> str:
    """Returns the URL of a network that stays on this host, on an unused port, with a receive buffer for bursts."""
    *others, last = random.sample(range(*_PORTS), _TRIES)
    for port in others:
        with contextlib.suppress(ConnectionError):
            return _opened(port)
    return _opened(last)  # raises the reason, before anything is started


def _opened(port: int) -> str:
    url = roomy(f"udpm://239.255.76.67:{port}?ttl=0")
    open_network(url)
    return url


@contextlib.contextmanager
def taktd(
    machine: Path, url: str, journal: Path | None, pace: str, directory: Path, key: Key | None = None
) -> Iterator[subprocess.Popen[bytes]]:
    """Runs the engine as a process of its own, ended in an orderly way. Its output is written to taktd.txt. Without a
    key it uses that of the environment, if any. Raises TaktError if taktd is not installed."""
    beside = str(Path(sys.executable).parent)  # prefer the one installed with this package
    program = shutil.which("taktd", path=beside) or shutil.which("taktd")
    if program is None:
        raise TaktError("taktd is not installed (or not on PATH)")
    command = [program, str(machine), "--pace", pace, "--lcm-url", url]
    command += ["--log", str(journal)] if journal else []
    command += ["--key", key.file] if key else []
    with (
        (directory / "taktd.txt").open("wb") as text,
        _ended(subprocess.Popen(command, stdout=text, stderr=subprocess.STDOUT)) as process,
    ):
        yield process


@contextlib.contextmanager
def _ended(process: subprocess.Popen[bytes]) -> Iterator[subprocess.Popen[bytes]]:
    """Ends the process in any case, in an orderly way if possible."""
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
