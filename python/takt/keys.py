"""The key that an engine, its clients and its drives share (EN-31); two keys during a change.

With a key, commands, heartbeats, messages of drives and descriptions carry an authentication tag; messages without a
valid one are counted and ignored. Tags are made and checked by Takt's core (see `cpp/takt/lcm/authentication.h`).
"""

from __future__ import annotations

import os
import secrets
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from takt import _core
from takt.errors import KeyFileError

ENVIRONMENT = "TAKT_KEY_FILE"
BYTES = 32

Handler = Callable[[str, bytes], object]
Refused = Callable[[str, _core.TagState], object]
KeyFile = str | os.PathLike[str]


@dataclass(frozen=True)
class Key:
    """A key and the name of its file. With two keys in the file, the first one tags sent messages, and both are
    accepted."""

    file: str
    data: bytes = field(repr=False)  # one or two keys, concatenated

    @property
    def changing(self) -> bool:
        """Whether the file holds two keys."""
        return len(self.data) > BYTES


def read_key(file: KeyFile | None = None) -> Key | None:
    """Returns the key in a file. `file`: None: the file named by the environment (TAKT_KEY_FILE). Returns None if none
    is named or `file` is "". Raises KeyFileError if the file cannot be used."""
    name = os.fspath(file) if file is not None else os.environ.get(ENVIRONMENT, "")
    return Key(name, _core.read_keys(os.fsencode(name))) if name else None


def new_key(file: KeyFile) -> None:
    """Writes a new random key to a new file that only its owner may open. Raises KeyFileError if the file exists or
    cannot be written."""
    name = os.fspath(file)
    try:
        number = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
    except FileExistsError:
        raise KeyFileError(f"key file {name}: it is there already; it is left as it is") from None
    except OSError as error:
        raise KeyFileError(f"key file {name}: {error.strerror}") from None
    with os.fdopen(number, "w") as made:
        made.write(secrets.token_hex(BYTES) + "\n")


def no_key(url: str) -> str:
    """Returns why an engine with a key does not answer a client or drive without one."""
    return (
        f"the engine on {url} has a key and hears only holders of it: "
        f"name its key file (key=, --key, or {ENVIRONMENT} in the environment)"
    )


def not_the_key(url: str, key: Key, state: _core.TagState) -> str:
    """Returns why a client or drive with this key ignores the messages of an engine, by the state of their tags."""
    if state == _core.TagState.untagged:
        return (
            f"the engine on {url} has no key, but this side has one ({key.file}): "
            "start taktd with --key and this file, or leave the key out here"
        )
    if state == _core.TagState.wrong_key:
        return f"the engine on {url} has another key than {key.file}"
    return f"the engine on {url}: its messages are ignored: {_core.tag_text(state)}"


def first_key_not_taken(key: Key) -> str:
    """Returns why an engine that is heard does not answer a client with two keys."""
    return (
        f"it does not take the first key of {key.file}, which tags what is sent: "
        "start the engine with both keys, or put the other key first"
    )


class KeyedNetwork:
    """A member of an LCM network that tags sent messages and, on tagged channels, accepts only messages with a valid
    tag. It has the methods of lcm.LCM that Takt uses; handlers receive messages without their tags."""

    def __init__(self, network: Any, key: Key, refused: Refused | None = None) -> None:
        """refused: called with channel and reason of each ignored message, on the thread that handles messages."""
        self.refused: Counter[str] = Counter()  # messages, by reason
        self._network = network
        self._key = key
        self._refused = refused
        self._signer = _core.Signer(key.data)

    def publish(self, channel: str, data: bytes) -> None:
        self._network.publish(channel, self._signer.sign(channel, data) if _core.is_tagged_channel(channel) else data)

    def subscribe(self, channels: str, handler: Handler) -> Any:
        """As Network.subscribe. Each subscription has a verifier of its own, which sees each message once."""
        return self._network.subscribe(channels, partial(self._open, _core.Verifier(self._key.data), handler))

    def unsubscribe(self, subscription: Any) -> None:
        self._network.unsubscribe(subscription)

    def fileno(self) -> int:
        return int(self._network.fileno())

    def handle(self) -> None:
        self._network.handle()

    def handle_timeout(self, timeout_ms: float) -> int:
        return int(self._network.handle_timeout(timeout_ms))

    def _open(self, verifier: _core.Verifier, handler: Handler, channel: str, data: bytes) -> None:
        if _core.is_tagged_channel(channel):
            state, data = verifier.open(channel, data, getattr(self._network, "heard_us", None))
            if state != _core.TagState.good:
                self.refused[state.name] += 1
                if self._refused is not None:
                    self._refused(channel, state)
                return
        handler(channel, data)
