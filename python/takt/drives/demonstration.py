"""`takt demo real_drives`: the six axes with emulated drives on a field bus, each part in its own process: EtherCAT if
a pair of Ethernet interfaces can be made, else CANopen over UDP."""

from __future__ import annotations

import contextlib
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

from takt.drives.ethercat_link import ethernet_socket, package
from takt.errors import TaktError

NAME: Final = "real_drives"
OF: Final = "six_axes"  # demo whose scenario it uses
ENDS: Final = ("ec0", "ec1")  # ends of the wire in ethercat.yaml
READY_WITHIN_S: Final = 120.0  # busy hosts take their time


@contextlib.contextmanager
def machine_file(folder: Path, say: Callable[[str], None]) -> Iterator[Path]:
    """Yields the machine file whose bus is available on this host; its wire exists while the context is open."""
    made = False
    try:
        try:
            package()
            made = _make_wire()
            for end in ENDS:
                ethernet_socket(end).close()
            said, name = f"EtherCAT between the interfaces {ENDS[0]} and {ENDS[1]}", "ethercat.yaml"
        except TaktError as error:
            said, name = f"no EtherCAT here: {error}; so CANopen over UDP", "canopen.yaml"
        say(said)
        yield folder / name
    finally:
        if made:
            _ip("link", "del", ENDS[0])


def _make_wire() -> bool:
    """Makes the pair of interfaces. Returns False if it exists already."""
    known = {name for _, name in socket.if_nameindex()}
    if known.issuperset(ENDS):
        return False
    _ip("link", "add", ENDS[0], "type", "veth", "peer", "name", ENDS[1])
    for end in ENDS:
        _ip("link", "set", end, "up")
    return True


def _ip(*arguments: str) -> None:
    try:
        done = subprocess.run(["ip", *arguments], capture_output=True, text=True, check=False)
    except OSError as error:
        raise TaktError(f"ip {' '.join(arguments)}: {error.strerror}") from None
    if done.returncode:
        why = " ".join(done.stderr.split()) or f"it ended with {done.returncode}"
        raise TaktError(f"ip {' '.join(arguments)}: {why}")


@contextlib.contextmanager
def processes(machine: Path, url: str, directory: Path, say: Callable[[str], None]) -> Iterator[None]:
    """Runs the emulated drives and the drive process of the engine; their output is written to files of the
    directory."""
    with (
        _process("emulate", [str(machine)], directory, "emulated drives"),
        _process("run", [str(machine), "--url", url], directory, "ready: "),
    ):
        say(f"drives are emulated and run, {directory}/drives_*.txt is what they say")
        yield


@contextlib.contextmanager
def _process(command: str, arguments: list[str], directory: Path, ready: str) -> Iterator[None]:
    text = directory / f"drives_{command}.txt"
    with text.open("wb") as output:
        started = subprocess.Popen(
            [sys.executable, "-m", "takt", "drives", command, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        try:
            _await(started, text, ready, command)
            yield
        finally:
            if started.poll() is None:
                started.send_signal(signal.SIGTERM)
            try:
                started.wait(10)
            except subprocess.TimeoutExpired:
                started.kill()
                started.wait()


def _await(started: subprocess.Popen[bytes], text: Path, ready: str, command: str) -> None:
    end_s = time.monotonic() + READY_WITHIN_S
    while ready not in text.read_text(errors="replace"):
        if started.poll() is not None or time.monotonic() > end_s:
            said = text.read_text(errors="replace").strip().rpartition("\n")[2]
            raise TaktError(f"takt drives {command} does not start: {said or 'it says nothing'}")
        time.sleep(0.02)
