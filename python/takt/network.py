"""Joins an LCM network, or says in one line why not.

Messages are sent by liblcm. On UDP they are heard by the receiver of Takt's core: liblcm's reassembly of long messages
believes what fragments say of offset and size, so that one datagram ends the program (EN-30).
"""

from __future__ import annotations

import os
import re
import select
import socket
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import lcm

from takt import _core
from takt.errors import ConnectionError

Handler = Callable[[str, bytes], object]

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"  # ttl 0: stays on this host
QUEUE = 30  # messages of a subscription that wait, unless it says otherwise; as in LCM
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


class Subscription:
    """Of a network; the same to whoever uses it as one of the lcm module."""

    def __init__(self, network: Network, channels: str, handler: Handler, capacity: int) -> None:
        self._network = network
        self.channels = channels
        self.handler = handler
        self.number = network._hear(self, capacity)

    def set_queue_capacity(self, capacity: int) -> None:
        """So many messages wait to be handled before newer ones are dropped; 0: any number."""
        self._network._receiver.set_capacity(self.number, capacity)


class Network:
    """A member of an LCM network over UDP, with the methods of lcm.LCM."""

    def __init__(self, url: str) -> None:
        self._sender = lcm.LCM(url)  # never asked to receive
        self._receiver = _core.Receiver(url)
        self._subscriptions: dict[int, Subscription] = {}

    def publish(self, channel: str, data: bytes) -> None:
        self._sender.publish(channel, data)

    def subscribe(self, channels: str, handler: Handler) -> Subscription:
        """Has messages handled whose channel this regular expression matches as a whole."""
        return Subscription(self, channels, handler, QUEUE)

    def unsubscribe(self, subscription: Subscription) -> None:
        self._forget(subscription)

    def fileno(self) -> int:
        """Readable while messages wait."""
        return self._receiver.fileno()

    def handle(self) -> None:
        """Handles one message; waits for it."""
        while not self.handle_timeout(1000):
            pass

    def handle_timeout(self, timeout_ms: float) -> int:
        """Handles one message, waiting so long for it at most: how many there were."""
        heard = self._receiver.receive()
        if heard is None:
            news = select.poll()
            news.register(self._receiver.fileno(), select.POLLIN)
            news.poll(max(0.0, timeout_ms))
            heard = self._receiver.receive()
        if heard is None:
            return 0
        numbers, channel, data = heard
        for number in numbers:
            subscription = self._subscriptions.get(number)
            if subscription is not None:
                subscription.handler(channel, data)
        return 1

    @property
    def malformed(self) -> int:
        """Datagrams that were none of LCM's, or from elsewhere where only this host is heard."""
        return self._receiver.malformed

    def _hear(self, subscription: Subscription, capacity: int) -> int:
        number = self._receiver.subscribe(subscription.channels, capacity)
        self._subscriptions[number] = subscription
        return number

    def _forget(self, subscription: Subscription) -> None:
        self._receiver.unsubscribe(subscription.number)
        self._subscriptions.pop(subscription.number, None)


def open_network(url: str, *, room: bool = False) -> Any:
    """A member of the network: a Network on UDP, else an lcm.LCM, which has the same methods.

    LCM itself answers an absent network with a page of advice on stderr: this looks first.

    room: for bursts (`roomy`)."""
    udp = url.startswith("udpm://")
    if udp:
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
    url = roomy(url) if room else url
    try:
        network = Network(url) if udp else lcm.LCM(url)
    except RuntimeError as error:
        raise ConnectionError(f"the LCM network {url} cannot be joined: {error}") from None
    if not udp and network.fileno() < 0:  # it could send, but not receive
        raise ConnectionError(f"the LCM network {url} cannot be joined: is its port used by another program?")
    return network


def _wrong(url: str) -> str:
    return f'LCM URL "{url}": expected one like {DEFAULT_URL}'
