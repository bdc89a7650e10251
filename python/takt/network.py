"""Joins an LCM network, or says in one line why not."""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import lcm

from takt.errors import ConnectionError

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"  # ttl 0: stays on this host
BUFFER = 4 << 20  # bytes of a socket that must not lose anything


def usual_url() -> str:
    """The network of whoever names none: that of the environment (LCM_DEFAULT_URL), else DEFAULT_URL."""
    return os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL


def network_of(machine: Mapping[str, Any]) -> str:
    """The network that taktd runs a machine on unless its command line says otherwise: the machine file's `lcm.url`,
    else the usual one."""
    return machine["lcm"].get("url") or usual_url()


def roomy(url: str) -> str:
    """The network with a receive buffer that takes bursts, as far as the system allows."""
    if not url.startswith("udpm://") or "recv_buf_size" in url:
        return url
    try:
        allowed = int(Path("/proc/sys/net/core/rmem_max").read_text())
    except (OSError, ValueError):
        return url
    return f"{url}{'&' if '?' in url else '?'}recv_buf_size={min(BUFFER, allowed)}"


def open_network(url: str, *, room: bool = False) -> lcm.LCM:
    """LCM itself answers an absent network with a page of advice on stderr: this looks first.

    room: for bursts (`roomy`)."""
    if url.startswith("udpm://"):
        parts = re.fullmatch(r"udpm://(\d+(?:\.\d+){3}):(\d{1,5})(?:\?.*)?", url)
        if not parts or not 0 < int(parts[2]) < 65536:
            raise ConnectionError(_wrong(url))
        try:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                probe.connect((parts[1], int(parts[2])))
        except OSError as error:
            raise ConnectionError(
                f"the LCM network {url} is not reachable ({error.strerror or error}); "
                "with the loopback interface alone it needs: ip route add 224.0.0.0/4 dev lo"
            ) from None
    elif not url.startswith(("tcpq://", "memq://")):
        raise ConnectionError(_wrong(url))
    try:
        network = lcm.LCM(roomy(url) if room else url)
    except RuntimeError as error:
        raise ConnectionError(f"the LCM network {url} cannot be joined: {error}") from None
    if network.fileno() < 0:  # it could send, but not receive
        raise ConnectionError(f"the LCM network {url} cannot be joined: is its port used by another program?")
    return network


def _wrong(url: str) -> str:
    return f'LCM URL "{url}": expected one like {DEFAULT_URL}'
