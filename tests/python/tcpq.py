"""A server of LCM's tcpq:// networks, which Debian has none of: what a member publishes goes to all that subscribed."""

from __future__ import annotations

import re
import socket
import struct
import threading
from types import TracebackType

HELLO = bytes.fromhex("287617fa00000100")  # magic, version
PUBLISH, SUBSCRIBE, UNSUBSCRIBE = 1, 2, 3


class Server:
    """In a context; `url` names the network."""

    def __init__(self) -> None:
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.url = f"tcpq://127.0.0.1:{self._listening.getsockname()[1]}"
        self._channels: dict[socket.socket, list[str]] = {}
        self._lock = threading.Lock()

    def __enter__(self) -> Server:
        threading.Thread(target=self._accept, daemon=True).start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._listening.close()
        with self._lock:
            for member in self._channels:
                member.close()

    def _accept(self) -> None:
        while True:
            try:
                member = self._listening.accept()[0]
            except OSError:
                return
            with self._lock:
                self._channels[member] = []
            threading.Thread(target=self._serve, args=(member,), daemon=True).start()

    def _serve(self, member: socket.socket) -> None:
        source = member.makefile("rb")

        def number() -> int:
            return int(struct.unpack(">I", source.read(4))[0])

        try:
            source.read(len(HELLO))
            member.sendall(HELLO)
            while True:
                kind, channel = number(), source.read(number())
                data = source.read(number()) if kind == PUBLISH else b""
                with self._lock:
                    if kind == SUBSCRIBE:
                        self._channels[member].append(channel.decode())
                    elif kind == UNSUBSCRIBE:
                        self._channels[member].remove(channel.decode())
                    else:
                        self._forward(channel, data)
        except (OSError, struct.error, ValueError):
            with self._lock:
                self._channels.pop(member, None)

    def _forward(self, channel: bytes, data: bytes) -> None:
        event = struct.pack(">II", PUBLISH, len(channel)) + channel + struct.pack(">I", len(data)) + data
        for member, channels in self._channels.items():
            if any(re.fullmatch(pattern, channel.decode()) for pattern in channels):
                try:
                    member.sendall(event)
                except OSError:
                    continue
