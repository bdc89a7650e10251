"""Writes a page for each group of commands: what it does as a picture, its arguments and errors from the descriptions.

Usage: build/venv/bin/python tools/command_pages.py [DIRECTORY]        (./dev docs calls it; without one: build/docs)

A group is a scenario file in docs/commands/ that also says COMMANDS, ERRORS (their numbers) and SIGNALS (to draw). Its
doc string is the page's introduction.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import takt
from takt import plot, reference
from takt.scenario import load_scenario, run_scenario

ROOT = Path(__file__).resolve().parent.parent
GROUPS = sorted((ROOT / "docs" / "commands").glob("*.py"))


def write(group: Path, directory: Path) -> Path:
    """Runs the scenario of a group, draws it, writes its page. Raises when one of its assertions fails."""
    scenario = load_scenario(group)
    said = about(group)
    with takt.Engine(scenario.machine) as engine:
        outcome = run_scenario(scenario, engine)
    if not outcome.passed:
        failed = [verdict.sentence for verdict in outcome.verdicts if not verdict.passed]
        raise RuntimeError(f"{group.name}: {outcome.complaint or failed[0]}")
    picture = plot.save(plot.draw(outcome.recording, *said.SIGNALS), directory / f"{group.stem}.png")
    title, _, text = (said.__doc__ or "").strip().partition("\n")
    parts = [
        f"# {title.rstrip('.')}",
        text.strip(),
        f"![{title.rstrip('.')}]({picture.name})",
        "The picture is what this does:",
        f"```python\n{body(group)}\n```",
        "## Commands",
        reference.commands(said.COMMANDS),
        "## Errors they can end with",
        reference.errors(said.ERRORS),
    ]
    page = directory / f"{group.stem}.md"
    page.write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    return page


def about(group: Path) -> ModuleType:
    """The module of a group."""
    spec = importlib.util.spec_from_file_location(f"commands_{group.stem}", group)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def body(group: Path) -> str:
    """The function `scenario` of a group, as it stands in the file."""
    text = group.read_text(encoding="utf-8")
    begin = text.index("def scenario(")
    return text[begin : text.index("\n\n\n", begin)]


def main(directory: Path) -> None:
    pages = [write(group, directory) for group in GROUPS]
    lines = [f"- [{page.read_text(encoding='utf-8').splitlines()[0][2:]}]({page.name})" for page in pages]
    (directory / "index.md").write_text("# Commands by group\n\n" + "\n".join(lines) + "\n", encoding="utf-8")
    print(directory / "index.md")


if __name__ == "__main__":
    where = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "docs"
    where.mkdir(parents=True, exist_ok=True)
    main(where)
