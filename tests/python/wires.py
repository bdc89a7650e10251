"""A network of this process alone with a pair of Ethernet interfaces, and machines with drives on EtherCAT there."""

from __future__ import annotations

import contextlib
import ctypes
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import buses
import pytest
from buses import Said, described, drives, eventually
from takt import drive
from takt.drives.ethercat_bus import EthercatBus

MASTER, DRIVES = "ec0", "ec1"  # the ends of the wire
BUS = f"ethercat:{MASTER}"

# Like that of buses.py, and drives go on where a cable is back once their axes have failed: their watchdog is 6 s.
PATIENT = "missing_cycles: 500\n      heartbeat_s: 2"

_NEW_NETWORK = 0x4000_0000

_LOOPBACK = """
ip link set lo up multicast on
ip route add 224.0.0.0/4 dev lo
"""
_WIRE = f"""
ip link add {MASTER} type veth peer name {DRIVES}
ip link set {MASTER} up
ip link set {DRIVES} up
"""
RING_WIRE = """
ip link add ec2 type veth peer name ec3
ip link set ec2 up
ip link set ec3 up
"""  # from the last slave back to this host


@contextlib.contextmanager
def own_network(*, wire: bool = True) -> Iterator[None]:
    """Skips where the rights, or what else it takes, are missing. wire: with the pair of interfaces."""
    libc = ctypes.CDLL(None, use_errno=True)
    before = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
    try:
        if libc.unshare(_NEW_NETWORK):
            pytest.skip(f"no right to make a network namespace ({os.strerror(ctypes.get_errno())})")
        try:
            made = subprocess.run(["sh", "-ec", _LOOPBACK + _WIRE * wire], capture_output=True, text=True, check=False)
            if made.returncode:
                pytest.skip(f"no veth pair can be made here: {' '.join(made.stderr.split())}")
            yield
        finally:
            libc.setns(before, _NEW_NETWORK)
    finally:
        os.close(before)


def machine(url: str, axes: int = 2, **keys: str) -> str:
    return buses.machine(url, BUS, axes, place="position", **keys)


@contextlib.contextmanager
def emulated(text: str, folder: Path) -> Iterator[Said]:
    """The drives of the machine's only bus, in a process."""
    file = folder / "emulated.yaml"
    file.write_text(text)
    with drives("emulate", file) as emulation:
        emulation.wait_for(f"ethercat:{DRIVES}: ")
        yield emulation


def run(
    text: str, url: str, watchdog: int = drive.WATCHDOG
) -> contextlib.AbstractContextManager[tuple[EthercatBus, list[str]]]:
    return buses.run_on(EthercatBus, text, url, watchdog)


def tell(emulation: Said, command: str) -> str:
    """What the emulation answers to a command."""
    count = len(emulation.lines)
    emulation.tell(command)
    assert eventually(lambda: len(emulation.lines) > count)
    return emulation.lines[count]


def bus_of(text: str, said: Any = None) -> EthercatBus:
    whole = described(text)
    return EthercatBus(whole["external"]["buses"][0], whole, said or (lambda _: None))
