"""Verdicts of motion assertions: passed or not, when, by how much, and the data needed for a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from takt.recording import Array, FloatArray

Interval = tuple[float, float]


@dataclass(frozen=True)
class Trace:
    """One curve."""

    label: str  # "x.set_position"
    time_s: FloatArray
    values: Array
    modulus: float | None = None  # the curve is interrupted where it wraps around


@dataclass(frozen=True)
class Bound:
    """A line that must not be crossed towards `forbidden`; "none": a target line."""

    label: str
    time_s: FloatArray
    values: FloatArray
    forbidden: Literal["above", "below", "none"]

    @classmethod
    def level(cls, label: str, value: float, over: Interval, forbidden: Literal["above", "below", "none"]) -> Bound:
        return cls(label, np.array(over, dtype=np.float64), np.full(2, value, dtype=np.float64), forbidden)


@dataclass(frozen=True)
class Lane:
    """Curves and bounds that share one value axis."""

    quantity: str  # "position"
    unit: str
    traces: tuple[Trace, ...]
    bounds: tuple[Bound, ...] = ()
    names: dict[int, str] = field(default_factory=dict)  # texts of the values, for states


@dataclass(frozen=True)
class Verdict:
    """The outcome of one motion assertion."""

    name: str  # of the assertion: "reaches"
    components: tuple[str, ...]
    passed: bool
    sentence: str  # readable; says when and by how much
    when_s: float | None  # failed: time of the first violation; passed: time of the smallest margin, if there is one
    by_how_much: float | None  # failed: the largest violation of the bound; passed: the smallest margin; None: unknown
    unit: str  # of by_how_much
    place: Interval | None  # the time interval of interest
    lanes: tuple[Lane, ...] = ()
    picture: Path | None = None

    def __bool__(self) -> bool:
        return self.passed

    def __repr__(self) -> str:
        return f"<Verdict {self.title}: {'passed' if self.passed else 'failed'}: {self.sentence}>"

    def _repr_html_(self) -> str:
        from takt.notebook import verdict_picture

        return verdict_picture(self)

    @property
    def title(self) -> str:
        return f"{self.name}({', '.join(self.components)})" if self.components else self.name


class MotionAssertionError(AssertionError):
    """A motion assertion failed. `verdict` has the details; the text is its sentence and the path of the picture."""

    def __init__(self, verdict: Verdict, note: str = "") -> None:
        self.verdict, self._note = verdict, note
        super().__init__(f"{verdict.title}: {verdict.sentence}" + (f"\n{note}" if note else ""))

    def __reduce__(self) -> tuple[type[MotionAssertionError], tuple[Verdict, str]]:
        return type(self), (self.verdict, self._note)  # for pickling, as between processes


def seconds(time_s: float) -> str:
    """Returns a time as readable text: "1.2345 s"."""
    if not math.isfinite(time_s):
        return f"{time_s} s"
    text = f"{time_s:.4f}".rstrip("0").rstrip(".")
    return ("0" if text == "-0" else text) + " s"


def number(value: float, unit: str = "") -> str:
    """Returns a value as readable text: "12.3457 mm"."""
    return f"{value:.6g} {unit}".rstrip()
