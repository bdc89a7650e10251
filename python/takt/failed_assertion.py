"""Endings of a scenario other than verdicts, expressed as a verdict: a failed plain `assert`, a refused command, or
no assertion at all. With its time, its source line, and curves of the signals that the line names."""

from __future__ import annotations

import re
import traceback
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from takt.checks.series import quantity
from takt.component import Component
from takt.counted import counted
from takt.errors import CommandError, TaktError
from takt.feedback import Feedback, Place
from takt.names import shown
from takt.recording import Recording
from takt.verdict import Lane, Trace, Verdict, seconds

ASSERT = "assert"
COMMAND = "command"
VERIFY = "verify"

Signal = tuple[str, str]


@dataclass(frozen=True)
class FailedAssertion:
    text: str  # the message and the source line
    when_s: float | None  # None: about the whole recording
    components: frozenset[str] = frozenset()  # names in its line, some of which are components
    words: frozenset[str] = frozenset()  # words of its line, some of which are fields of the components
    name: str = ASSERT

    @staticmethod
    def of(error: AssertionError, path: Path, when_s: float | None = None) -> FailedAssertion:
        """From a failed `assert`. `path`: the scenario's file, whose line is reported; the names are read from the line
        that raised the error."""
        stack = traceback.extract_tb(error.__traceback__)
        frames = [frame for frame in stack if Path(frame.filename).name == path.name]
        said = str(error) or (frames[-1].line if frames else "") or "an assertion failed"
        where = f" ({shown(path.name)}:{frames[-1].lineno})" if frames else ""
        line = stack[-1].line or "" if stack else ""
        *_, (last, _) = traceback.walk_tb(error.__traceback__)
        words = frozenset(re.findall(r"\w+", line))
        known = {**last.f_globals, **last.f_locals}
        variables = {one.name for word in words if isinstance(one := known.get(word), Component)}
        quoted = frozenset(re.findall(r"[\"']([^\"']+)[\"']", line))
        return FailedAssertion(said + where + _at(when_s), when_s, quoted.union(variables), words)

    @staticmethod
    def of_broken(error: TaktError, path: Path, when_s: float) -> FailedAssertion:
        """From an error that ended the scenario: a command that it waited for failed, or a condition was not met in
        time."""
        stack = traceback.extract_tb(error.__traceback__)
        places: Sequence[Place] = [(frame.filename, frame.lineno or 0) for frame in reversed(stack)]
        name, target = "wait", frozenset[str]()
        if isinstance(error, CommandError):  # the line that gave the command says more than the line that waited
            name, target, places = COMMAND, frozenset({error.feedback.target}), error.feedback.given_at or places
        return FailedAssertion(f"{error}{_where(places, path)}{_at(when_s)}", when_s, target, name=name)

    @staticmethod
    def of_ignored(ignored: Sequence[Feedback], path: Path) -> FailedAssertion | None:
        """From refused commands whose feedback the scenario did not read; None if there are none."""
        if not ignored:
            return None
        first = ignored[0]
        where, when_s = _where(first.given_at, path), first.time_s
        others = f", and {counted(len(ignored) - 1, 'command')} more" if len(ignored) > 1 else ""
        text = f"{CommandError(first)}{where}: nothing asked what became of it{others}"
        when = when_s if np.isfinite(when_s) else None
        return FailedAssertion(text, when, frozenset({first.target}), name=COMMAND)

    def told(self) -> dict[str, Any]:
        """Returns the values as recordings keep them."""
        return {**asdict(self), "components": sorted(self.components), "words": sorted(self.words)}

    @staticmethod
    def again(told: Mapping[str, Any]) -> FailedAssertion:
        """Restores what `told` returned."""
        sets = {name: frozenset(told[name]) for name in ("components", "words")}
        return FailedAssertion(told["text"], told["when_s"], **sets, name=told["name"])

    def verdict(self, recording: Recording) -> Verdict:
        """Returns the verdict, with curves of the named components: of their named fields or, without any, the usual
        ones."""
        named = tuple(name for name in recording if name in self.components)
        place = None if self.when_s is None else (self.when_s, self.when_s)
        lanes = _lanes(recording, [signal for name in named for signal in self._signals(recording, name)])
        return Verdict(self.name, named, False, self.text, self.when_s, None, "", place, lanes)

    def _signals(self, recording: Recording, name: str) -> list[Signal]:
        from takt import plot  # here, because its import is slow and rarely needed

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


def _at(when_s: float | None) -> str:
    return "" if when_s is None else f" at {seconds(when_s)}"


def _where(places: Iterable[Place], path: Path) -> str:
    """Returns the innermost line in the scenario's folder, and the lines there that called it, as text."""
    folder = path.resolve().parent
    own = [(Path(file).resolve(), line) for file, line in places if not file.startswith("<")]
    lines = [f"{shown(file.relative_to(folder))}:{line}" for file, line in own if file.is_relative_to(folder)]
    if not lines:
        return ""
    return f" ({lines[0]}, called from {', '.join(lines[1:])})" if len(lines) > 1 else f" ({lines[0]})"
