"""Columns of numbers in a page: as small as possible without a visible difference, concatenated in a deflated block.

The bytes of a column are separated: first the lowest bytes of all its numbers, then the next ones. Consecutive numbers
differ in their low bytes only, so that the others compress to nearly nothing.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np

from takt.recording import Array

TYPES = {"i8": "i1", "f32": "<f4", "f64": "<f8"}


class Block:
    """Collects columns and returns their location: {"f32": [at, n]}, n numbers from the byte `at` on."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self._known: dict[tuple[str, bytes], dict[str, Any]] = {}

    def put(self, column: Array) -> dict[str, Any]:
        """Adds a column. Constant columns become one value, states bytes; numbers become 32-bit floats if their
        rounding is below a millionth of the column's range."""
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
        """Adds times: evenly spaced ones become start, end and number."""
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
        """Bytes before compression."""
        return self._size

    def text(self) -> str:
        return base64.b64encode(zlib.compress(b"".join(self._parts), 6)).decode("ascii")


def unpacked(text: str) -> bytes:
    """Returns the bytes of a block from its text."""
    return zlib.decompress(base64.b64decode(text))


def column_of(data: bytes, place: dict[str, Any], n: int) -> Array:
    """Returns a column of n numbers from the bytes of a block; NaN if it holds no finite number."""
    if "constant" in place:
        return np.full(n, np.nan if place["constant"] is None else place["constant"])
    kind = next(kind for kind in TYPES if kind in place)
    at, count = place[kind]
    width = np.dtype(TYPES[kind]).itemsize
    apart = np.frombuffer(data, np.uint8, count * width, at).reshape(width, count)
    return np.ascontiguousarray(apart.T).reshape(-1).view(TYPES[kind])
