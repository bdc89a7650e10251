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
    """The report of a scenario that was run; `engine`: what the engine says of itself."""
    drawn = scenario.draw(outcome.recording) if outcome.passed else {}
    figures = {"engine": engine}
    return write_report(
        outcome.recording, outcome.verdicts, directory, scenario.title, figures, drawn, outcome.assertion
    )


def target_of(run: Path) -> Path:
    """Where the page of a run goes unless told: into its directory, or beside its file."""
    return run / PAGE if run.is_dir() else run.with_name(f"{stem_of(run)}.html")


def target_of_two(runs: Sequence[Path]) -> Path:
    """Where the page of two runs goes unless told: beside the first one."""
    a, b = map(stem_of, runs)
    return runs[0].parent / f"{a}_and_{b}.html"


def names_of(runs: Sequence[Path]) -> tuple[str, str]:
    """What two runs are called: as short as they can be told apart."""
    whole = [run.resolve() for run in runs]
    for parts in range(1, max(len(run.parts) for run in whole)):
        a, b = (shown("/".join(run.parts[-parts:])) for run in whole)
        if a != b:
            return a, b
    return "A", "B"


def judged(outcome: Outcome, scenario: Scenario) -> Recording:
    """The recording with what its scenario says of it now. What the engine said of itself stays."""
    drawn = scenario.draw(outcome.recording) if outcome.passed else {}
    figures = (outcome.recording.meta.get("run") or {}).get("figures")
    pictures = {name: png(figure) for name, figure in drawn.items()}
    return keep(outcome.recording, scenario.title, outcome.verdicts, outcome.assertion, figures, pictures)


def write_page(recording: Recording, run: Path, target: Path) -> Path:
    """The page of a recording as it was kept."""
    write_text(target, render_kept(recording, shown(run.resolve().name)))
    return target
