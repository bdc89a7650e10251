"""A plain `assert` that failed in a scenario, as a verdict: when, and curves of what its line names."""

from __future__ import annotations

import re
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from takt.checks.series import quantity
from takt.component import Component
from takt.recording import Recording
from takt.verdict import Lane, Trace, Verdict, seconds

NAME = "assert"

Signal = tuple[str, str]


@dataclass(frozen=True)
class Complaint:
    text: str  # what it says, and where it stands
    when_s: float | None  # None: it was asked of the whole recording
    components: frozenset[str]  # what its line names, some of which are components
    words: frozenset[str]  # of its line, some of which are fields of them

    @staticmethod
    def of(error: AssertionError, path: Path, when_s: float | None = None) -> Complaint:
        """`path`: the scenario's file, whose line says where it stands; what it names is told by the line that raised
        it."""
        stack = traceback.extract_tb(error.__traceback__)
        frames = [frame for frame in stack if Path(frame.filename).name == path.name]
        said = str(error) or (frames[-1].line if frames else "") or "an assertion failed"
        where = f" ({path.name}:{frames[-1].lineno})" if frames else ""
        when = "" if when_s is None else f" at {seconds(when_s)}"
        line = stack[-1].line or "" if stack else ""
        *_, (last, _) = traceback.walk_tb(error.__traceback__)
        words = frozenset(re.findall(r"\w+", line))
        known = {**last.f_globals, **last.f_locals}
        variables = {one.name for word in words if isinstance(one := known.get(word), Component)}
        quoted = frozenset(re.findall(r"[\"']([^\"']+)[\"']", line))
        return Complaint(said + where + when, when_s, quoted.union(variables), words)

    def verdict(self, recording: Recording) -> Verdict:
        """With the curves of the components that are named; of the fields that are, or of the usual ones."""
        named = tuple(name for name in recording if name in self.components)
        place = None if self.when_s is None else (self.when_s, self.when_s)
        lanes = _lanes(recording, [signal for name in named for signal in self._signals(recording, name)])
        return Verdict(NAME, named, False, self.text, self.when_s, None, "", place, lanes)

    def _signals(self, recording: Recording, name: str) -> list[Signal]:
        from takt import plot  # which takes long to import, and few need it

        fields = [(name, field) for field in recording.fields(name)[2:] if field in self.words]
        return fields or plot.select(recording, [name])


def _lanes(recording: Recording, signals: Sequence[Signal]) -> tuple[Lane, ...]:
    lanes: dict[tuple[str, str], Lane] = {}
    for name, field in signals:
        time_s, values = recording[name]["time_s"], recording.column(name, field).astype(np.float64)
        trace = Trace(f"{name}.{field}", time_s, values)
        switch = {0: "no", 1: "yes"} if recording.column(name, field).dtype.kind == "b" else {}
        states, unit = recording.names(name, field) or switch, recording.unit(name, field)
        key = (f"{name}.{field}" if states else quantity(field), unit)
        others = lanes[key].traces if key in lanes else ()
        lanes[key] = Lane(key[0], unit, (*others, trace), names=states)
    return tuple(lanes.values())
