"""The table of docs/twin.md: every ready machine with a twin, by its own scenario, there and with our servo model.

Usage: build/venv/bin/python tools/twin_table.py [NAME...]       (prints the rows; --write puts them into docs/twin.md)
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
from pathlib import Path

from takt import _core, read_machine
from takt.ready import ready_machines
from takt.scenario import load_scenario
from takt.twin import command
from takt.twin.judging import ProductFigures

PAGE = Path(__file__).resolve().parent.parent / "docs" / "twin.md"
HEAD = (
    "| machine | takes | tool: twin, kinematics | tool: off its set pose, twin | servo | following error, twin | servo "
    "| torque | products: beside the tool, moved | verdicts |\n|---|---|---|---|---|---|---|---|---|---|\n"
)
BEGIN, END = "how far they moved afterwards, at most.\n", "\nThe twin has found"


def pair(values: tuple[float, float] | None) -> str:
    return "" if values is None else f"{values[0]:.2g} / {values[1]:.2g}"


def products(figures: ProductFigures | None) -> str:
    return "" if figures is None else f"{figures.put}: {figures.beside[1]:.2g}, {figures.moved[1]:.2g}"


def worst(pairs: list[tuple[float, float] | None]) -> tuple[float, float] | None:
    there = [one for one in pairs if one is not None]
    return max(there, key=lambda one: one[1]) if there else None


def row(name: str, file: Path) -> str:
    with contextlib.redirect_stdout(io.StringIO()):
        ran = command.run(file.parent / "machine.yaml", load_scenario(file))
    judged = ran.judged
    failed = sorted((v for v in ran.outcome.verdicts if not v.passed), key=lambda v: v.when_s or 0.0)
    count = len(failed) + (ran.outcome.assertion is not None)
    said = f"{count} failed, first {failed[0].title}: {failed[0].sentence}" if failed else ran.outcome.complaint
    judged_axes = [axis for axis in judged.axes if axis.unit == "deg"]  # those of the mechanisms
    peak = max(judged_axes, key=lambda axis: axis.torque[1] / axis.max_torque)
    cells = [
        name,
        f"{ran.outcome.recording.duration_s:.1f} s",
        pair(worst([tool.agreement for tool in judged.tools])),
        pair(worst([tool.off for tool in judged.tools])),
        pair(worst([tool.servo_off for tool in judged.tools])),
        pair(worst([axis.following for axis in judged_axes])),
        pair(worst([axis.servo for axis in judged_axes])),
        f"{pair(peak.torque)} of {peak.max_torque:g}",
        products(judged.products),
        said or "all passed",
    ]
    return f"| {' | '.join(cells)} |\n"


def main() -> None:
    names = [name for name in sys.argv[1:] if not name.startswith("-")]
    rows = ""
    for one in ready_machines():
        machine = json.loads(_core.load_machine(*read_machine(one.scenario.parent / "machine.yaml")))
        if machine.get("twin") and (not names or one.name in names):
            rows += row(one.name, one.scenario)
            print(rows.splitlines()[-1], flush=True)
    if "--write" in sys.argv:
        text = PAGE.read_text(encoding="utf-8")
        begin = text.index(BEGIN) + len(BEGIN)
        PAGE.write_text(text[:begin] + "\n" + HEAD + rows + text[text.index(END) :], encoding="utf-8")


if __name__ == "__main__":
    main()
