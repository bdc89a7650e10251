"""Users of an OPC UA server and their rights, to read or to command: a file with names, rights and password hashes."""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from asyncua.crypto.permission_rules import User, UserRole

from takt.errors import TaktError

READ, COMMANDS = "read", "commands"
RIGHTS = (READ, COMMANDS)
LENGTH = 32
COST = {"n": 1 << 14, "r": 8, "p": 1}  # of scrypt: 16 MiB and about 50 ms for each attempt


@dataclass
class Person(User):  # type: ignore[misc]
    commands: bool = False


class Users:
    """Authentication of clients for the server. `known`: rights and hash by user name; None: all clients are accepted
    without a name."""

    def __init__(self, known: Mapping[str, tuple[str, str]] | None, commands: bool) -> None:
        self.known = known
        self._commands = commands  # False: no client may command, whatever its rights

    def get_user(
        self, iserver: Any, username: str | None = None, password: str | None = None, certificate: Any = None
    ) -> Person | None:
        if self.known is None:
            return Person(UserRole.User, None, self._commands)
        rights, hashed = self.known.get(username or "", ("", f"{'0' * 2 * LENGTH}:{'0' * 2 * LENGTH}"))
        good = hmac.compare_digest(_hash(password or "", hashed.split(":")[0]), hashed)
        return Person(UserRole.User, username, self._commands and rights == COMMANDS) if good and rights else None


def read_users(file: Path) -> dict[str, tuple[str, str]]:
    """Returns rights and hash by user name. Raises TaktError, with the reason and the line, if the file is invalid,
    accessible to users other than its owner, or has no users."""
    try:
        mode = file.stat().st_mode
        lines = file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise TaktError(f"users file {file}: {getattr(error, 'strerror', None) or 'it is no text'}") from None
    if mode & 0o077:
        raise TaktError(f"users file {file}: others than its owner may open it: chmod 600 {file}")
    known: dict[str, tuple[str, str]] = {}
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.startswith("#"):
            continue
        words = line.split()
        if len(words) != 3 or words[1] not in RIGHTS or not _is_hash(words[2]):
            raise TaktError(f"users file {file}:{number}: expected a name, read or commands, and a hash")
        if words[0] in known:
            raise TaktError(f"users file {file}:{number}: {words[0]} is there already")
        known[words[0]] = (words[1], words[2])
    if not known:
        raise TaktError(f"users file {file}: there are no users in it: takt opcua-user {file} NAME")
    return known


def add_user(file: Path, name: str, password: str, rights: str) -> None:
    """Adds a user, or replaces the password and rights of a user. A missing file is created, accessible to its owner
    only. Raises TaktError if the name is not one word, the password is empty, or the file cannot be written."""
    if not name or len(name.split()) != 1 or name.startswith("#"):
        raise TaktError(f"a name is one word, not {name!r}")
    if not password:
        raise TaktError(f"{name}: the password is empty")
    if file.exists():
        lines = [line for line in file.read_text(encoding="utf-8").splitlines() if line.split()[:1] != [name]]
    else:
        lines = ["# takt opcua --users: name, read or commands, hash of the password"]
    lines.append(f"{name} {rights} {_hash(password, secrets.token_hex(LENGTH))}")
    try:
        number = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
    except OSError as error:
        raise TaktError(f"users file {file}: {error.strerror}") from None
    with os.fdopen(number, "w", encoding="utf-8") as made:
        made.write("\n".join(lines) + "\n")


def _hash(password: str, salt: str) -> str:
    made = hashlib.scrypt(password.encode(), salt=bytes.fromhex(salt), dklen=LENGTH, **COST)
    return f"{salt}:{made.hex()}"


def _is_hash(text: str) -> bool:
    salt, _, rest = text.partition(":")
    return all(len(part) == 2 * LENGTH and set(part) <= set("0123456789abcdef") for part in (salt, rest))
