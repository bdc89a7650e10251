"""The objects of an emulated EtherCAT drive, read and written through its mailbox (CoE, ETG.1000.6): SDO expedited,
normal (in one message), and segmented."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

COE: Final = 3  # kind of message in a mailbox
MAILBOX_ERROR: Final = 0
_REQUEST, _RESPONSE, _INFORMATION = 2, 3, 8
_HEADER_BYTES: Final = 6  # of a message in the mailbox
LONGEST_OBJECT: Final = 4096

TOGGLE: Final = 0x0503_0000
UNKNOWN_COMMAND: Final = 0x0504_0001
UNSUPPORTED: Final = 0x0601_0000
READ_ONLY: Final = 0x0601_0002
NO_OBJECT: Final = 0x0602_0000
WRONG_LENGTH: Final = 0x0607_0010
NO_SUBINDEX: Final = 0x0609_0011


class AbortError(Exception):
    """Aborts a transfer with this code."""

    def __init__(self, code: int) -> None:
        super().__init__(f"0x{code:08X}")
        self.code = code


@dataclass
class Entry:
    """A subindex. write: None if it is read-only; raises AbortError for an invalid value."""

    read: Callable[[], bytes]
    write: Callable[[bytes], None] | None = None


class SdoServer:
    """Answers requests for the objects of a dictionary.

    mailbox_bytes: size of a whole message."""

    def __init__(self, entries: dict[tuple[int, int], Entry], mailbox_bytes: int) -> None:
        self.entries, self._most = entries, mailbox_bytes - _HEADER_BYTES
        self._begin()

    def _begin(self) -> None:
        self._key = (0, 0)
        self._sending: bytes | None = None  # remainder of an upload
        self._taking: bytearray | None = None  # received part of a download
        self._expected = 0
        self._toggle = 0

    def answer(self, kind: int, message: bytes) -> list[tuple[int, bytes]]:
        """Returns the replies to a mailbox message, as (mailbox type, data)."""
        if kind != COE:
            return [(MAILBOX_ERROR, struct.pack("<HH", 1, 2))]  # unsupported protocol
        if len(message) < 10:
            return [(MAILBOX_ERROR, struct.pack("<HH", 1, 8))]  # too short
        service = int.from_bytes(message[:2], "little") >> 12
        body = message[2:]
        if service == _INFORMATION:
            return [(COE, struct.pack("<HBBHI", _INFORMATION << 12, 7, 0, 0, UNSUPPORTED))]
        if service != _REQUEST:
            return [(MAILBOX_ERROR, struct.pack("<HH", 1, 4))]
        try:
            said = self._carry_out(body)
        except AbortError as abort:
            self._begin_keeping_key(body)
            return [(COE, struct.pack("<HBHBI", _REQUEST << 12, 0x80, *self._key, abort.code))]
        return [(COE, struct.pack("<H", _RESPONSE << 12) + said)] if said else []

    def _begin_keeping_key(self, body: bytes) -> None:
        key = self._key if body[0] >> 5 in (0, 3) else struct.unpack_from("<HB", body, 1)
        self._begin()
        self._key = (int(key[0]), int(key[1]))

    def _carry_out(self, body: bytes) -> bytes:
        command = body[0] >> 5
        if command == 4:  # the master aborts
            self._begin()
            return b""
        if command == 0:
            return self._take_segment(body)
        if command == 3:
            return self._send_segment(body)
        if command not in (1, 2):
            raise AbortError(UNKNOWN_COMMAND)
        index, subindex = struct.unpack_from("<HB", body, 1)
        self._begin()
        self._key = (index, subindex)
        if body[0] & 0x10:
            raise AbortError(UNSUPPORTED)  # all subindices at once
        entry = self._entry()
        return self._upload(entry) if command == 2 else self._download(entry, body)

    def _entry(self) -> Entry:
        entry = self.entries.get(self._key)
        if entry is None:
            raise AbortError(NO_SUBINDEX if any(index == self._key[0] for index, _ in self.entries) else NO_OBJECT)
        return entry

    def _upload(self, entry: Entry) -> bytes:
        data = entry.read()
        if len(data) <= 4 and data:
            return struct.pack("<BHB", 0x43 | (4 - len(data)) << 2, *self._key) + data.ljust(4, b"\0")
        room = self._most - 10
        if len(data) > room:
            self._sending = data[room:]
        return struct.pack("<BHBI", 0x41, *self._key, len(data)) + data[:room]

    def _send_segment(self, body: bytes) -> bytes:
        if self._sending is None:
            raise AbortError(UNKNOWN_COMMAND)
        if body[0] >> 4 & 1 != self._toggle:
            raise AbortError(TOGGLE)
        room = self._most - 3
        part, left = self._sending[:room], self._sending[room:]
        word = self._toggle << 4 | (0 if left else 1)
        if len(part) < 7:
            word |= (7 - len(part)) << 1
        self._toggle ^= 1
        self._sending = left or None
        return bytes((word,)) + part.ljust(7, b"\0")

    def _download(self, entry: Entry, body: bytes) -> bytes:
        if entry.write is None:
            raise AbortError(READ_ONLY)
        if body[0] & 2:  # expedited
            length = 4 - (body[0] >> 2 & 3) if body[0] & 1 else 4
            entry.write(body[4 : 4 + length])
        else:
            length = int.from_bytes(body[4:8], "little")
            if length > LONGEST_OBJECT:
                raise AbortError(WRONG_LENGTH)
            data = body[8 : 8 + length]
            if len(data) < length:
                self._taking, self._expected = bytearray(data), length
            else:
                entry.write(data)
        return struct.pack("<BHBI", 0x60, *self._key, 0)

    def _take_segment(self, body: bytes) -> bytes:
        if self._taking is None:
            raise AbortError(UNKNOWN_COMMAND)
        if body[0] >> 4 & 1 != self._toggle:
            raise AbortError(TOGGLE)
        room = len(body) - 1
        if room <= 7:
            room = 7 - (body[0] >> 1 & 7)
        self._taking += body[1 : 1 + room]
        if len(self._taking) > self._expected:
            raise AbortError(WRONG_LENGTH)
        word = 0x20 | self._toggle << 4
        self._toggle ^= 1
        if body[0] & 1:
            data, self._taking = bytes(self._taking), None
            if len(data) != self._expected:
                raise AbortError(WRONG_LENGTH)
            write = self._entry().write
            assert write is not None
            write(data)
        return bytes((word,)).ljust(8, b"\0")
