"""The ready machines in `examples` of the package, each in a folder with a machine file and a scenario."""

from __future__ import annotations

import ast
import difflib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.table import Column, Table

from takt.scenario import ScenarioError

EXAMPLES = Path(__file__).parent / "examples"


@dataclass(frozen=True)
class Ready:
    """A ready machine, as described by its scenario file."""

    name: str
    sentence: str  # the first line of the scenario's doc string
    takes_s: float  # approximate engine time of the scenario
    scenario: Path


def ready_machines() -> list[Ready]:
    """Returns all ready machines in order of their names. Reads their files, but does not run them."""
    return [_introduce(file) for file in sorted(EXAMPLES.glob("*/scenario.py"))]


def scenario_of(what: str) -> Path:
    """Returns the scenario file of a ready machine, or the file itself. Raises ScenarioError for a name that is
    neither."""
    given = Path(what)
    if given.suffix or given.name != what:
        return given
    file = EXAMPLES / what / "scenario.py"
    if file.is_file():
        return file
    names = [one.name for one in ready_machines()]
    near = difflib.get_close_matches(what, names, cutoff=0.4) or names
    raise ScenarioError(f"{what}: neither a scenario file nor a ready machine; the nearest: {', '.join(near)}")


def listing() -> Table:
    """Returns the table of ready machines for `takt demo`."""
    table = Table("name", "", Column("takes", justify="right"), box=None)
    for one in ready_machines():
        table.add_row(one.name, one.sentence, f"{one.takes_s:.0f} s")
    return table


def _introduce(file: Path) -> Ready:
    tree = ast.parse(file.read_text(encoding="utf-8"), str(file))
    constants: dict[str, Any] = {}
    for one in tree.body:
        match one:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=value)):
                constants[name] = value
    lines = (ast.get_docstring(tree) or "").splitlines()
    return Ready(file.parent.name, lines[0] if lines else "", float(constants.get("TAKES_S", 0)), file)
