"""Tags of messages (EN-31) as docs/keys.md describes them, made with Python's hmac alone; and a member of the network
that hears and says everything as it is."""

from __future__ import annotations

import hmac
import random
import struct
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lcm
from takt import keys

TAG_BYTES = 60


def now_us() -> int:
    return time.time_ns() // 1000


def key_bytes(file: Path) -> bytes:
    return bytes.fromhex(file.read_text())


def new_key(directory: Path, name: str = "key") -> Path:
    file = directory / name
    keys.new_key(file)
    return file


class Sender:
    """Tags as one sender does."""

    def __init__(self, key: bytes) -> None:
        self.key = key
        self.number = random.getrandbits(64)
        self.counter = 0

    def tag(self, channel: str, data: bytes, utime: int | None = None) -> bytes:
        self.counter += 1
        told = data + b"TKH1" + struct.pack(">QQq", self.number, self.counter, now_us() if utime is None else utime)
        return told + hmac.digest(self.key, channel.encode() + b"\0" + told, "sha256")


class Bystander:
    """Hears all of some channels, and may say anything. Only for messages shorter than a datagram."""

    def __init__(self, url: str, channels: str = "takt/(command|heartbeat|feedback|machine|engine|drive/.*)") -> None:
        self.network = lcm.LCM(url)
        self.heard: list[tuple[str, bytes]] = []
        self.said: set[bytes] = set()
        self.network.subscribe(channels, lambda channel, data: self.heard.append((channel, data))).set_queue_capacity(0)

    def listen(self, most: int = 1000) -> None:
        """Hears what has come, so many messages at most."""
        while most > 0 and self.network.handle_timeout(10):
            most -= 1

    def until(self, condition: Callable[[], object], seconds: float = 20.0) -> None:
        end = time.monotonic() + seconds
        while not condition() and time.monotonic() < end:
            self.network.handle_timeout(10)
        assert condition()

    def on(self, channel: str) -> list[bytes]:
        return [data for where, data in self.heard if where == channel]

    def say(self, channel: str, data: bytes) -> None:
        self.said.add(data)
        self.network.publish(channel, data)


def flipped(data: bytes, source: random.Random) -> bytes:
    """One bit changed, anywhere."""
    changed = bytearray(data)
    changed[source.randrange(len(data))] ^= 1 << source.randrange(8)
    return bytes(changed)


def changed(kind: Any, data: bytes, **fields: Any) -> bytes:
    """A message with other values, without its tag."""
    message = kind.decode(data)
    for name, value in fields.items():
        setattr(message, name, value)
    return bytes(message.encode())
