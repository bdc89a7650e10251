"""Writes a page for each group of commands: what it does as a picture, its arguments and errors from the descriptions.

tools/docs_pages.py makes them part of the documentation.

A group is a file in docs/commands/ that says COMMANDS and ERRORS (their numbers); its doc string is the page's
introduction. It is a scenario file with SIGNALS to draw, or has a folder of such files for more pictures than one:
docs/commands/flex_cam.py has docs/flex_cam/. A picture begins at the first mark.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import takt
from takt import plot, reference
from takt.scenario import Scenario, load_scenario, run_scenario

DOCS = Path(__file__).resolve().parent.parent / "docs"
GROUPS = sorted((DOCS / "commands").glob("*.py"))


def figures(group: Path) -> list[Path]:
    """The scenario files of a group that has a folder of them."""
    return sorted((DOCS / group.stem).glob("fig_*.py"))


def write(group: Path, directory: Path, run: bool = True) -> Path:
    """Runs the scenarios of a group, draws them, writes its page. Raises when one of their assertions fails. Without
    `run` nothing runs, and the pictures are missing."""
    parts = [*heading("#", group)]
    for figure in figures(group):
        parts += [*heading("##", figure), *drawn(figure, directory, run)]
    if not figures(group):
        parts += drawn(group, directory, run)
    said = about(group)
    parts += [
        "## Commands",
        reference.commands(said.COMMANDS),
        "## Errors they can end with",
        reference.errors(said.ERRORS),
    ]
    page = directory / f"{group.stem}.md"
    page.write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    return page


def heading(level: str, file: Path) -> tuple[str, str]:
    """Title and text of a file's doc string."""
    title, _, text = (about(file).__doc__ or "").strip().partition("\n")
    return f"{level} {title.rstrip('.')}", text.strip()


def drawn(file: Path, directory: Path, run: bool) -> tuple[str, str, str]:
    """A scenario's picture, and what was run."""
    scenario = load_scenario(file)
    if run:
        _draw(scenario, directory / f"{file.stem}.png")
    code = f"```python\n{body(file)}\n```"
    return f"![{scenario.title}]({file.stem}.png)", "The picture is what this does:", code


def _draw(scenario: Scenario, target: Path) -> None:
    """Runs a scenario and draws it from its first mark on. Raises when one of its assertions fails."""
    with takt.Engine(scenario.machine) as engine:
        outcome = run_scenario(scenario, engine)
    if not outcome.passed:
        failed = [verdict.sentence for verdict in outcome.verdicts if not verdict.passed]
        raise RuntimeError(f"{scenario.path.name}: {outcome.complaint or failed[0]}")
    recording = outcome.recording
    begin = min(event.time_s for event in recording.events if event.kind == "mark")
    picture = plot.draw(recording, *about(scenario.path).SIGNALS, window=(begin, recording.end_s))
    plot.save(picture, target)


def about(file: Path) -> ModuleType:
    """The module of a group or of a figure."""
    spec = importlib.util.spec_from_file_location(f"commands_{file.stem}", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(file.parent))  # for what the figures of a folder share
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.pop(0)
    return module


def body(file: Path) -> str:
    """The function `scenario` of a file, as it stands there."""
    text = file.read_text(encoding="utf-8")
    begin = text.index("def scenario(")
    return text[begin : text.index("\n\n\n", begin)]
