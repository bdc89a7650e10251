"""A machine for tests, and taktd running it on an LCM port of its own."""

from __future__ import annotations

import contextlib
import itertools
import os
import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import takt
from takt import msgs

_TEXT = """\
name: test
lcm: {LCM}
axes:
  - name: x
    unit: mm
    limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -10, upper: 1000}
    encoder: {increments_per_unit: 1000}
  - name: r
    unit: deg
    kind: rotary
    limits: {velocity: 360, acceleration: 3600, jerk: 36000}
    encoder: {increments_per_unit: 1000}
"""


def machine_with(lcm: str) -> str:
    """The machine with this section `lcm`."""
    return _TEXT.replace("{LCM}", lcm)


MACHINE = machine_with("{dead_man_s: 0.5}")

# Arguments of gear_in with a master that there is not, and its name.
UNKNOWN = {
    "{master: none,\tratio_numerator: 1}": "none",
    "{master:\tnone}": "none",
    '{master: "7"}': "7",
}

_ports = itertools.count(12_000 + os.getpid() % 500 * 40)  # below the ephemeral ports of Linux


def new_url() -> str:
    """An LCM network that no other test uses."""
    return f"udpm://239.255.76.67:{next(_ports)}?ttl=0"


def taktd() -> str:
    found = shutil.which("taktd")
    assert found, "taktd is not on the PATH"
    return found


def command_for(session: takt.RemoteSession) -> msgs.command:
    """An empty command to the engine of this session, past the session."""
    message = msgs.command()
    message.run_id = session._run_id
    return message


@contextlib.contextmanager
def running(
    directory: Path, url: str, *options: str, machine: str = MACHINE, pace: str = "paced"
) -> Iterator[subprocess.Popen[str]]:
    """taktd at the pace of the wall clock, ended by SIGTERM."""
    file = directory / "machine.yaml"
    file.write_text(machine)
    command = [taktd(), str(file), "--lcm-url", url, "--pace", pace, *options]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        text, _ = process.communicate(timeout=20)
    assert process.returncode == 0, text
