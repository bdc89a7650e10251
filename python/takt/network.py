"""Joins an LCM network, or says in one line why not."""

from __future__ import annotations

import os
import re
import socket

import lcm

from takt.errors import ConnectionError

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"  # ttl 0: stays on this host


def usual_url() -> str:
    """The network of whoever names none: that of the environment (LCM_DEFAULT_URL), else DEFAULT_URL."""
    return os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL


def open_network(url: str) -> lcm.LCM:
    """LCM itself answers an absent network with a page of advice on stderr: this looks first."""
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
        network = lcm.LCM(url)
    except RuntimeError as error:
        raise ConnectionError(f"the LCM network {url} cannot be joined: {error}") from None
    if network.fileno() < 0:  # it could send, but not receive
        raise ConnectionError(f"the LCM network {url} cannot be joined: is its port used by another program?")
    return network


def _wrong(url: str) -> str:
    return f'LCM URL "{url}": expected one like {DEFAULT_URL}'
