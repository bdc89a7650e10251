"""The summary of a sweep's rows: number of passed runs, distributions of numbers, worst runs."""

from __future__ import annotations

import heapq
import math
import re
from array import array
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from takt.counted import counted
from takt.recording import FloatArray
from takt.sweep.design import COLUMNS, Design

KEPT = 100_000  # most rows whose numbers are kept for distributions, evenly chosen
WORST = 10  # rows kept for each number, at either end
REASONS = 1000  # most different failures that are kept
FIGURE = re.compile(r"(?<![\w.])-?\d[\d.]*(e[+-]?\d+)?(?![\w.])")
FIXED = {*COLUMNS} - {"engine_s"}


@dataclass
class Column:
    """A number over all rows."""

    name: str
    count: int = 0
    least: float = math.inf
    most: float = -math.inf
    low: list[tuple[float, int, str]] = field(default_factory=list)  # (value, run, command), smallest first
    high: list[tuple[float, int, str]] = field(default_factory=list)  # largest first

    def take(self, value: float, run: int, command: str) -> None:
        self.count += 1
        self.least, self.most = min(self.least, value), max(self.most, value)
        for heap, key in ((self.low, -value), (self.high, value)):  # the entry to be dropped first is at the top
            entry = (key, -run, command)
            if len(heap) < WORST:
                heapq.heappush(heap, entry)
            elif entry > heap[0]:
                heapq.heapreplace(heap, entry)

    def close(self) -> None:
        self.low = [(-key, -run, command) for key, run, command in sorted(self.low, reverse=True)]
        self.high = [(key, -run, command) for key, run, command in sorted(self.high, reverse=True)]


@dataclass
class Summary:
    size: int  # runs of the sweep
    keys: list[str]
    runs: int = 0  # finished runs
    passed: int = 0
    reasons: dict[str, tuple[int, int, str]] = field(default_factory=dict)  # by failure: count, first run, command
    columns: dict[str, Column] = field(default_factory=dict)  # numbers
    texts: set[str] = field(default_factory=lambda: {"failed", "hash", "command"})  # columns that are not numbers
    kept: dict[str, FloatArray] = field(default_factory=dict)  # numbers of every n-th row, NaN where missing

    def __repr__(self) -> str:
        return f"<Summary: {self.runs:,} of {counted(self.size, 'run')}, {self.passed:,} passed>"

    @property
    def failed(self) -> int:
        return self.runs - self.passed

    @staticmethod
    def of(rows: Iterable[Mapping[str, str]], design: Design) -> Summary:
        found = Summary(design.size, design.keys)
        every = max(1, -(-design.size // KEPT))
        kept: dict[str, array[float]] = {}
        for row in rows:
            found._take(row)
            if (found.runs - 1) % every:
                continue
            length = (found.runs - 1) // every
            for name, text in row.items():
                if name in found.texts:
                    continue
                column = kept.setdefault(name, array("d", [math.nan]) * length)
                column.extend([math.nan] * (length - len(column)))
                column.append(_number(text))
        longest = max(map(len, kept.values()), default=0)
        for name, column in kept.items():
            if name not in found.texts:
                column.extend([math.nan] * (longest - len(column)))
                found.kept[name] = np.array(column)
        for one in found.columns.values():
            one.close()
        for name in found.texts:
            found.columns.pop(name, None)
        return found

    def _take(self, row: Mapping[str, str]) -> None:
        self.runs += 1
        run, command = int(row["run"]), row["command"]
        if row["passed"] == "1":
            self.passed += 1
        else:
            reason = _reason(row["failed"])
            count, first, of = self.reasons.get(reason, (0, run, command))
            if reason in self.reasons or len(self.reasons) < REASONS:
                self.reasons[reason] = (count + 1, first, of)
        for name, text in row.items():
            if name in FIXED or not text or name in self.texts:
                continue
            value = _number(text)
            if math.isnan(value) and text != "nan":
                self.texts.add(name)
            elif math.isfinite(value):
                self.columns.setdefault(name, Column(name)).take(value, run, command)


def _reason(sentence: str) -> str:
    """Returns the reason of a failure, without the figures of the single run."""
    title, colon, _ = sentence.partition(": ")
    if colon and title.endswith(")"):
        return title
    return FIGURE.sub("…", sentence)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
