"""Joins an LCM network; all traffic passes through Takt's core. Errors are raised as one line of text."""

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
QUEUE = 30  # default queue capacity of a subscription, as in LCM
BUFFER = 4 << 20  # bytes of receive buffer for sockets that must not lose messages


def usual_url() -> str:
    """Returns the default network: that of the environment (LCM_DEFAULT_URL), else DEFAULT_URL."""
    return os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL


def network_of(machine: Mapping[str, Any]) -> str:
    """Returns the network that taktd uses for a machine without an option on its command line: the machine file's
    `lcm.url`, else the default one."""
    return machine["lcm"].get("url") or usual_url()


def roomy(url: str) -> str:
    """Returns the URL with a receive buffer for bursts, as large as the system allows."""
    if not url.startswith("udpm://") or "recv_buf_size" in url:
        return url
    try:
        allowed = int(Path("/proc/sys/net/core/rmem_max").read_text())
    except (OSError, ValueError):
        return url
    return f"{url}{'&' if '?' in url else '?'}recv_buf_size={min(BUFFER, allowed)}"


class Subscription:
    """A subscription to channels of a network, with the handler of their messages."""

    def __init__(self, network: Network, channels: str, handler: Handler, number: int) -> None:
        self._network = network
        self.channels = channels
        self.handler = handler
        self.number = number

    def set_queue_capacity(self, capacity: int) -> None:
        """Sets the number of messages that may wait before newer ones are dropped; 0: unlimited."""
        self._network._core.set_capacity(self.number, capacity)


class Network:
    """A member of an LCM network, with the methods of lcm.LCM: udpm://, tcpq:// or memq://.

    Raises ConnectionError if it cannot be joined; OSError if it fails later."""

    def __init__(self, url: str) -> None:
        self._core = _core.Network(url)
        self._subscriptions: dict[int, Subscription] = {}
        self.heard_us: int | None = None  # wall clock time of receipt of the message being handled

    def publish(self, channel: str, data: bytes) -> None:
        self._core.publish(channel, data)

    def subscribe(self, channels: str, handler: Handler) -> Subscription:
        """Subscribes a handler to all channels that the regular expression matches completely."""
        subscription = Subscription(self, channels, handler, self._core.subscribe(channels, QUEUE))
        self._subscriptions[subscription.number] = subscription
        return subscription

    def unsubscribe(self, subscription: Subscription) -> None:
        self._core.unsubscribe(subscription.number)
        self._subscriptions.pop(subscription.number, None)

    def fileno(self) -> int:
        """Returns a file descriptor that is readable while messages wait."""
        return self._core.fileno()

    def handle(self) -> None:
        """Waits for one message and handles it."""
        while not self.handle_timeout(1000):
            pass

    def handle_timeout(self, timeout_ms: float) -> int:
        """Handles one message, waiting up to `timeout_ms` for it. Returns the number of handled messages, 0 or 1."""
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
        """Number of datagrams that are not LCM's, or are from other hosts on a network of this host only; always 0
        except on udpm://."""
        return self._core.malformed


def open_network(
    url: str, *, room: bool = False, key: Key | None = None, refused: Refused | None = None
) -> Network | KeyedNetwork:
    """Joins a network and returns its member. `room`: with a receive buffer for bursts (`roomy`). `key`: authenticates
    messages with it; `refused` is called for refused ones. Raises ConnectionError."""
    network = Network(roomy(url) if room else url)
    return network if key is None else KeyedNetwork(network, key, refused)
