"""Joins an LCM network, or says in one line why not; everything on the network goes through Takt's core."""

from __future__ import annotations

import os
import select
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from takt import _core
from takt.keys import Key, KeyedNetwork, Refused

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
    """Of a network: the channels, and who handles their messages."""

    def __init__(self, network: Network, channels: str, handler: Handler, number: int) -> None:
        self._network = network
        self.channels = channels
        self.handler = handler
        self.number = number

    def set_queue_capacity(self, capacity: int) -> None:
        """So many messages wait to be handled before newer ones are dropped; 0: any number."""
        self._network._core.set_capacity(self.number, capacity)


class Network:
    """A member of an LCM network, with the methods of lcm.LCM: udpm://, tcpq:// or memq://.

    Raises ConnectionError where it cannot be joined; OSError where it is gone later."""

    def __init__(self, url: str) -> None:
        self._core = _core.Network(url)
        self._subscriptions: dict[int, Subscription] = {}
        self.heard_us: int | None = None  # when the message that is handled came, by the wall clock

    def publish(self, channel: str, data: bytes) -> None:
        self._core.publish(channel, data)

    def subscribe(self, channels: str, handler: Handler) -> Subscription:
        """Has messages handled whose channel this regular expression matches as a whole."""
        subscription = Subscription(self, channels, handler, self._core.subscribe(channels, QUEUE))
        self._subscriptions[subscription.number] = subscription
        return subscription

    def unsubscribe(self, subscription: Subscription) -> None:
        self._core.unsubscribe(subscription.number)
        self._subscriptions.pop(subscription.number, None)

    def fileno(self) -> int:
        """Readable while messages wait."""
        return self._core.fileno()

    def handle(self) -> None:
        """Handles one message; waits for it."""
        while not self.handle_timeout(1000):
            pass

    def handle_timeout(self, timeout_ms: float) -> int:
        """Handles one message, waiting so long for it at most: how many there were."""
        heard = self._core.receive()
        if heard is None:
            news = select.poll()
            if (file := self._core.fileno()) >= 0:
                news.register(file, select.POLLIN)
            news.poll(max(0.0, timeout_ms))
            heard = self._core.receive()
        if heard is None:
            return 0
        numbers, channel, data, self.heard_us = heard
        for number in numbers:
            subscription = self._subscriptions.get(number)
            if subscription is not None:
                subscription.handler(channel, data)
        return 1

    @property
    def malformed(self) -> int:
        """Datagrams that were none of LCM's, or from elsewhere where only this host is heard; 0 but on udpm://."""
        return self._core.malformed


def open_network(
    url: str, *, room: bool = False, key: Key | None = None, refused: Refused | None = None
) -> Network | KeyedNetwork:
    """A member of the network; room: with a buffer for bursts (`roomy`); with a key, one that uses it."""
    network = Network(roomy(url) if room else url)
    return network if key is None else KeyedNetwork(network, key, refused)
