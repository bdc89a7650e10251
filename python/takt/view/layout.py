"""Messages with the state of a component as rows of a table: many at once, without decoding each.

LCM's encoding has every number at a fixed offset, except after a text; the only text in a state is the name of its
component, which does not change."""

from __future__ import annotations

import functools
from operator import attrgetter
from typing import Any

import numpy as np

from takt.tables import KINDS, place_of

HEAD = ("cycle", "time_ns", "sequence")
# By type: a value that differs from a fresh message in all bytes; by type and length: NumPy's type for LCM's encoding.
_PROBES: dict[type, Any] = {int: -1, bool: True, float: 1 / 3}
_TYPES = {(int, 1): ">i1", (int, 2): ">i2", (int, 4): ">i4", (int, 8): ">i8", (bool, 1): ">i1", (float, 8): ">f8"}
_NAME_AT = 8 + 4 * 8  # after the fingerprint, utime and HEAD


@functools.cache
def _places(kind: str) -> dict[str, tuple[int, str]]:
    """Returns offset and type of each field in a message whose component has no name. They are measured: setting a
    field changes the bytes that hold it."""
    message = KINDS[kind].message
    fresh = message().encode()
    paths = {field: field for field in HEAD} | {field: place_of(field, message) for field in KINDS[kind].getters}
    found = {}
    for field, path in paths.items():
        probe = message()
        *outer, last = path.split(".")
        holder = attrgetter(".".join(outer))(probe) if outer else probe
        what = type(getattr(holder, last))
        setattr(holder, last, _PROBES[what])
        data = probe.encode()
        changed = [i for i in range(len(fresh)) if fresh[i] != data[i]]
        found[field] = (changed[0], _TYPES[what, len(changed)])
    return found


class Layout:
    """The memory layout of messages of the component `name`."""

    def __init__(self, kind: str, name: str) -> None:
        message = KINDS[kind].message()
        message.name = name
        fresh = message.encode()
        encoded = len(name.encode())
        places = {f: (at + encoded if at > _NAME_AT else at, kind) for f, (at, kind) in _places(kind).items()}
        self.dtype = np.dtype(
            {
                "names": list(places),
                "formats": [one for _, one in places.values()],
                "offsets": [at for at, _ in places.values()],
                "itemsize": len(fresh),
            }
        )
        self.blank = fresh
        self._fingerprint = fresh[:8]
        self._name = fresh[_NAME_AT : _NAME_AT + 4 + encoded + 1]

    def fits(self, data: bytes) -> bool:
        """Returns whether this is a message of the component."""
        return (
            len(data) == self.dtype.itemsize
            and data.startswith(self._fingerprint)
            and data.startswith(self._name, _NAME_AT)
        )

    def rows(self, messages: list[bytes]) -> np.typing.NDArray[np.void]:
        """Returns messages that fit as rows."""
        return np.frombuffer(b"".join(messages), self.dtype)
