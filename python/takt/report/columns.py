"""Columns of numbers as a page holds them: as small as they can be without a difference that could be seen, and one
behind the other in a block that is deflated.

The bytes of a column lie apart: first the lowest ones of all its numbers, then the next ones. Numbers that follow one
another differ in their low bytes only, so that the others shrink to nearly nothing.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np

from takt.recording import Array

TYPES = {"i8": "i1", "f32": "<f4", "f64": "<f8"}


class Block:
    """Takes columns and says where they are: {"f32": [at, n]} from the byte `at` on."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self._known: dict[tuple[str, bytes], dict[str, Any]] = {}

    def put(self, column: Array) -> dict[str, Any]:
        """One value where nothing changes, bytes for states, 32-bit floats where their rounding is below a millionth of
        the column's range."""
        if column.dtype.kind == "b" or column.dtype == np.int8:
            if len(column) and np.all(column == column[0]):
                return {"constant": float(column[0])}
            return self.exactly(column, "i8")
        values = column.astype(np.float64)
        good = values[np.isfinite(values)]
        if not len(good):
            return {"constant": None}
        if len(good) == len(values) and np.all(values == values[0]):
            return {"constant": float(values[0])}
        largest = float(np.max(np.abs(good)))
        small = largest < 1e38 and largest * 2.0**-24 <= 1e-6 * float(np.ptp(good))
        return self.exactly(values, "f32" if small else "f64")

    def time(self, time_s: Array) -> dict[str, Any]:
        """Times: from, to and how many where they are even."""
        n = len(time_s)
        if n > 1:
            even = time_s[0] + np.arange(n) * ((time_s[-1] - time_s[0]) / (n - 1))
            if np.max(np.abs(even - time_s)) < 1e-9 * max(1.0, float(time_s[-1])):
                return {"n": n, "from": float(time_s[0]), "to": float(time_s[-1])}
        return {"n": n, **self.exactly(time_s, "f64")}

    def exactly(self, values: Array, kind: str) -> dict[str, Any]:
        numbers = np.ascontiguousarray(values, dtype=TYPES[kind]).reshape(-1)
        data = np.ascontiguousarray(numbers.view(np.uint8).reshape(-1, numbers.itemsize).T).tobytes()
        place = self._known.setdefault((kind, data), {kind: [self._size, len(numbers)]})
        if place[kind][0] == self._size and data:
            self._parts.append(data)
            self._size += len(data)
        return dict(place)

    @property
    def size(self) -> int:
        """Bytes before they are deflated."""
        return self._size

    def text(self) -> str:
        return base64.b64encode(zlib.compress(b"".join(self._parts), 6)).decode("ascii")


def unpacked(text: str) -> bytes:
    """The bytes of a block, as its text was."""
    return zlib.decompress(base64.b64decode(text))


def column_of(data: bytes, place: dict[str, Any], n: int) -> Array:
    """A column of n numbers again; NaN where nothing is known."""
    if "constant" in place:
        return np.full(n, np.nan if place["constant"] is None else place["constant"])
    kind = next(kind for kind in TYPES if kind in place)
    at, count = place[kind]
    width = np.dtype(TYPES[kind]).itemsize
    apart = np.frombuffer(data, np.uint8, count * width, at).reshape(width, count)
    return np.ascontiguousarray(apart.T).reshape(-1).view(TYPES[kind])
