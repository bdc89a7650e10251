"""One run of a sweep, and its row."""

from __future__ import annotations

import shlex
import traceback
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from takt.changes import Value, text_of
from takt.engine import Engine
from takt.errors import ConfigError
from takt.names import shown
from takt.scenario import Outcome, Played, load_scenario, run_scenario, with_settings
from takt.sweep.design import COLUMNS

Row = dict[str, Any]
TEXT = 300  # longest text in a cell


@dataclass(frozen=True)
class Job:
    """The common data of all runs of a sweep."""

    scenario: str
    machine: str  # as given; empty: the one beside the scenario

    def command(self, point: Mapping[str, Value]) -> str:
        """Returns the command that repeats a run."""
        words = ["takt", "run", self.scenario]
        words += ["--machine", self.machine] if self.machine else []
        for key, value in point.items():
            words += ["--set", f"{key}={text_of(value)}"]
        return shown(shlex.join(words))

    def run(self, number: int, point: Mapping[str, Value]) -> Row:
        """Makes a run. Returns its row, which also reports any failure."""
        found: Row = {"engine_s": "", "hash": ""}
        failed = ""
        more: Row = {}
        try:
            failed, more = self._outcome(point, found)
        except ConfigError as error:
            failed = error.problems[0]
        except Exception as error:
            failed = f"{type(error).__name__}: {error}{_place(error, Path(self.scenario))}"
        return self.row(number, point, failed, found, more)

    def row(self, number: int, point: Mapping[str, Value], failed: str, found: Row, more: Row) -> Row:
        """Returns a row: the common columns first, then its own."""
        said = " ".join(shown(failed).split())
        head = {"run": number, **point, "passed": int(not failed), "failed": said[:TEXT]}
        return {**head, "engine_s": "", "hash": "", **found, "command": self.command(point), **more}

    def _outcome(self, point: Mapping[str, Value], found: Row) -> tuple[str, Row]:
        # Loaded each time: the state of its module would otherwise depend on earlier runs.
        scenario, changes = with_settings(load_scenario(self.scenario), point)
        with Engine(self.machine or scenario.machine, changes=changes) as session:
            try:
                outcome = run_scenario(scenario, session)
            finally:
                found |= {"engine_s": round(session.now, 9), "hash": f"{session.state_hash:016x}"}
        more = _margins(outcome)
        if Played.of(outcome.recording).broken_off is None:
            for given, value in scenario.numbers(outcome.recording).items():
                name = " ".join(given.split())
                while name in (*COLUMNS, *point, *more):
                    name += " (result)"
                more[name] = _plain(value)
        return _why(outcome), more


def is_same(row: Row, other: Row) -> bool:
    """Returns whether two rows have the same columns and values; NaN equals NaN."""
    return row.keys() == other.keys() and all(
        row[name] == other[name] or (row[name] != row[name] and other[name] != other[name]) for name in row
    )


def _why(outcome: Outcome) -> str:
    """Returns the first failure as a sentence; empty if nothing failed."""
    if outcome.assertion is not None:
        return outcome.complaint
    return next((f"{v.title}: {v.sentence}" for v in outcome.verdicts if not v.passed), "")


def _margins(outcome: Outcome) -> Row:
    """Returns by how much each verdict passed; below 0: by how much it failed."""
    found: Row = {}
    seen: Counter[str] = Counter()
    for verdict in outcome.verdicts:
        seen[verdict.title] += 1
        number = seen[verdict.title]
        name = verdict.title if number == 1 else f"{verdict.title} {number}"
        if verdict.by_how_much is not None:
            found[name] = verdict.by_how_much if verdict.passed else -abs(verdict.by_how_much)
    return found


def _plain(value: Any) -> Any:
    """Returns a value for a table: a Python number, or a text."""
    value = value.item() if hasattr(value, "item") and getattr(value, "ndim", 0) == 0 else value
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, int | float) else " ".join(str(value).split())[:TEXT]


def _place(error: Exception, scenario: Path) -> str:
    folder = scenario.resolve().parent
    frames = [(Path(frame.filename), frame.lineno) for frame in traceback.extract_tb(error.__traceback__)]
    own = [(file, line) for file, line in frames if file.is_file() and file.resolve().parent == folder]
    return f" ({own[-1][0].name}:{own[-1][1]})" if own else ""
