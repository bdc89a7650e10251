"""`takt report`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from takt.names import shown
from takt.plot import png
from takt.recording import Recording
from takt.report.kept import keep
from takt.report.writing import PAGE, Report, render_kept, write_report
from takt.scenario import Outcome, Scenario
from takt.source import stem_of
from takt.written import write_text


def write_outcome(outcome: Outcome, scenario: Scenario, directory: Path, engine: Mapping[str, Any]) -> Report:
    """Writes the report of a finished scenario; `engine`: the engine's own figures."""
    drawn = scenario.draw(outcome.recording) if outcome.passed else {}
    figures = {"engine": engine}
    return write_report(
        outcome.recording, outcome.verdicts, directory, scenario.title, figures, drawn, outcome.assertion
    )


def target_of(run: Path) -> Path:
    """Returns the default path of a run's page: in its directory, or beside its file."""
    return run / PAGE if run.is_dir() else run.with_name(f"{stem_of(run)}.html")


def target_of_two(runs: Sequence[Path]) -> Path:
    """Returns the default path of the page of two runs: beside the first one."""
    a, b = map(stem_of, runs)
    return runs[0].parent / f"{a}_and_{b}.html"


def names_of(runs: Sequence[Path]) -> tuple[str, str]:
    """Returns names of two runs: the shortest ends of their paths that differ."""
    whole = [run.resolve() for run in runs]
    for parts in range(1, max(len(run.parts) for run in whole)):
        a, b = (shown("/".join(run.parts[-parts:])) for run in whole)
        if a != b:
            return a, b
    return "A", "B"


def judged(outcome: Outcome, scenario: Scenario) -> Recording:
    """Returns the recording with the present verdicts of its scenario. The engine's own figures are kept."""
    drawn = scenario.draw(outcome.recording) if outcome.passed else {}
    figures = (outcome.recording.meta.get("run") or {}).get("figures")
    pictures = {name: png(figure) for name, figure in drawn.items()}
    return keep(outcome.recording, scenario.title, outcome.verdicts, outcome.assertion, figures, pictures)


def write_page(recording: Recording, run: Path, target: Path) -> Path:
    """Writes the page of a recording with its kept data. Returns `target`."""
    write_text(target, render_kept(recording, shown(run.resolve().name)))
    return target
