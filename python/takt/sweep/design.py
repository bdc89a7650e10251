"""The design of a sweep: grids of values, and random samples.

A sweep of grids a and b and of n samples has a x b x n runs: the same n draws at each point of the grid. The values of
run i are computed from i alone, so that even a sweep of ten million runs needs no memory for them, and any worker can
make any run. Random numbers come from the bits of PCG64, which NumPy keeps the same from version to version.
"""

from __future__ import annotations

import functools
import math
import zlib
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np

from takt.changes import Value, value_of
from takt.errors import TaktError
from takt.names import names_in

COLUMNS = ("run", "passed", "failed", "engine_s", "hash", "command")  # columns of every row of the table
BLOCK = 1024  # number of draws computed at once
LAWS = {  # of samples, with their syntax
    "uniform": "uniform:LOW:HIGH:COUNT",
    "log_uniform": "log_uniform:LOW:HIGH:COUNT",
    "normal": "normal:MEAN:DEVIATION:COUNT",
    "integers": "integers:LOW:HIGH:COUNT",
    "choice": "choice:A,B,C:COUNT",
}


class SweepError(TaktError):
    """A sweep cannot be made as requested; the text is one sentence for readers."""


@dataclass(frozen=True)
class Grid:
    """Evenly spaced values, including both ends, or listed values."""

    key: str
    text: str
    listed: tuple[Value, ...]
    low: float = 0.0
    high: float = 0.0
    count: int = 0

    @staticmethod
    def of(text: str, texts: Collection[str] = ()) -> Grid:
        """Returns the grid of NAME=LOW:HIGH:COUNT or NAME=A,B,C. texts: keys whose listed values are texts. Raises
        SweepError."""
        key, said = _split(text, "--grid", "velocity=100:500:9 or mode=slow,fast")
        if ":" not in said:
            listed = _listed(said, key in texts)
            return Grid(key, text, listed, count=len(listed))
        parts = said.split(":")
        if len(parts) != 3:
            raise SweepError(f"--grid {text}: expected NAME=LOW:HIGH:COUNT, as velocity=100:500:9")
        low, high = (_number(one, "--grid", text) for one in parts[:2])
        return Grid(key, text, (), low, high, _count(parts[2], "--grid", text))

    def value(self, i: int) -> Value:
        if self.listed:
            return self.listed[i]
        if i == self.count - 1 and i > 0:
            return self.high
        return self.low + (self.high - self.low) * i / max(self.count - 1, 1)


@dataclass(frozen=True)
class Sample:
    """Random values."""

    key: str
    text: str
    law: str
    parameters: tuple[Any, ...]
    count: int

    @staticmethod
    def of(text: str, texts: Collection[str] = ()) -> Sample:
        """Returns the sample of NAME=LAW:...:COUNT. texts: keys whose listed values are texts. Raises SweepError."""
        key, said = _split(text, "--sample", "mass=uniform:1:2:100")
        law, *parts = said.split(":")
        if law not in LAWS:
            raise SweepError(f"--sample {text}: there is no law '{law}' (there are {', '.join(LAWS)})")
        if len(parts) != LAWS[law].count(":"):
            raise SweepError(f"--sample {text}: expected NAME={LAWS[law]}")
        count = _count(parts.pop(), "--sample", text)
        if law == "choice":
            choices = _listed(parts[0], key in texts)
            if not choices:
                raise SweepError(f"--sample {text}: there is nothing to choose from")
            return Sample(key, text, law, choices, count)
        low, high = (_number(one, "--sample", text) for one in parts)
        if law == "normal":
            if high <= 0:
                raise SweepError(f"--sample {text}: the deviation must be above 0, found {high:g}")
        elif low > high:
            raise SweepError(f"--sample {text}: the lower end {low:g} is above the upper end {high:g}")
        if law == "log_uniform" and low <= 0:
            raise SweepError(f"--sample {text}: the lower end must be above 0, found {low:g}")
        if law == "integers" and not (low.is_integer() and high.is_integer()):
            raise SweepError(f"--sample {text}: the ends must be whole numbers")
        return Sample(key, text, law, (low, high), count)

    def value(self, seed: int, i: int) -> Value:
        share = _shares(seed, zlib.crc32(self.key.encode()), i // BLOCK)[i % BLOCK]
        if self.law == "choice":
            chosen: Value = self.parameters[int(share * len(self.parameters))]
            return chosen
        low, high = self.parameters
        match self.law:
            case "uniform":
                return float(low + share * (high - low))
            case "log_uniform":
                return float(low * math.exp(share * math.log(high / low)))
            case "normal":
                return NormalDist(low, high).inv_cdf(share)
        return int(low) + int(share * (int(high) - int(low) + 1))


@dataclass(frozen=True)
class Design:
    """All runs of a sweep."""

    grids: tuple[Grid, ...]
    samples: tuple[Sample, ...]
    seed: int = 0

    @staticmethod
    def of(grid: Sequence[str], sample: Sequence[str], seed: int = 0, texts: Collection[str] = ()) -> Design:
        """Returns the design of grids and samples. texts: keys whose listed values are texts. Raises SweepError if it
        has no runs, or keys or counts conflict."""
        grids = tuple(Grid.of(one, texts) for one in names_in(grid, "grid", "key", "texts"))
        samples = tuple(Sample.of(one, texts) for one in names_in(sample, "sample", "key", "texts"))
        design = Design(grids, samples, seed)
        keys = design.keys
        if not keys:
            raise SweepError("nothing is varied: give --grid velocity=100:500:9 or --sample mass=uniform:1:2:100")
        for key in keys:
            if keys.count(key) > 1:
                raise SweepError(f"'{key}' is varied twice")
            if key in COLUMNS:
                raise SweepError(f"'{key}' is a column that every table has: give the parameter another name")
        varied: list[Grid | Sample] = [*design.grids, *design.samples]
        for one in varied:
            if not one.count:
                raise SweepError(f"{one.text}: has no values, so there is nothing to run")
        counts = {one.count for one in design.samples}
        if len(counts) > 1:
            said = ", ".join(f"{drawn.count} of {drawn.key}" for drawn in design.samples)
            raise SweepError(f"samples are drawn together, so their counts must be the same, found {said}")
        return design

    @property
    def keys(self) -> list[str]:
        return [*(one.key for one in self.grids), *(one.key for one in self.samples)]

    @property
    def size(self) -> int:
        """Number of runs."""
        return math.prod(one.count for one in self.grids) * self.draws

    @property
    def kinds(self) -> Iterator[tuple[str, Value]]:
        """Keys with representative values: all listed ones, the first two and the last of evenly spaced ones (integers
        among them), the first random one."""
        for grid in self.grids:
            for i in range(grid.count) if grid.listed else sorted({0, min(1, grid.count - 1), grid.count - 1}):
                yield grid.key, grid.value(i)
        for one in self.samples:
            drawn = one.parameters if one.law == "choice" else (one.value(self.seed, 0),)
            yield from ((one.key, value) for value in drawn)

    @property
    def draws(self) -> int:
        """Number of draws at each point of the grid."""
        return self.samples[0].count if self.samples else 1

    def point(self, run: int) -> dict[str, Value]:
        """Returns the values of one run. Draws change fastest, then the last grid."""
        place, draw = divmod(run, self.draws)
        found: dict[str, Value] = {}
        for grid in reversed(self.grids):
            place, i = divmod(place, grid.count)
            found[grid.key] = grid.value(i)
        found = dict(reversed(found.items()))
        return found | {one.key: one.value(self.seed, draw) for one in self.samples}


@functools.lru_cache(maxsize=64)
def _shares(seed: int, key: int, block: int) -> list[float]:
    """Returns uniformly distributed numbers above 0 and below 1."""
    bits = np.random.PCG64([seed, key, block]).random_raw(BLOCK)
    shares: list[float] = (((bits >> np.uint64(12)).astype(np.float64) + 0.5) * 2.0**-52).tolist()
    return shares


def _listed(said: str, as_texts: bool) -> tuple[Value, ...]:
    """Returns the values of A,B,C."""
    given = [one.strip() for one in said.split(",") if one.strip()]
    return tuple(one if as_texts else value_of(one) for one in given)


def _split(text: str, option: str, example: str) -> tuple[str, str]:
    key, equals, said = text.partition("=")
    if not key or not equals:
        raise SweepError(f"{option} {text}: expected NAME=..., as {example}")
    return key, said


def _number(text: str, option: str, whole: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise SweepError(f"{option} {whole}: '{text}' is not a number")
    return number


def _count(text: str, option: str, whole: str) -> int:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number) or number < 0 or not number.is_integer():
        raise SweepError(f"{option} {whole}: the count must be a whole number from 0 on, found '{text}'")
    return int(number)
