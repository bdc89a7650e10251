"""`takt twin`: runs a scenario in the twin of its machine, and adds the twin's verdicts to those of the scenario."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path

from rich.table import Table

from takt.engine import Engine
from takt.errors import TaktError
from takt.plant import PlantError
from takt.ready import scenario_of
from takt.scenario import Outcome, Scenario, load_scenario, run_scenario
from takt.twin.judging import HEAD, Judged, judge
from takt.twin.plant import Twin


@dataclass(frozen=True)
class TwinRun:
    """A scenario that has run in a twin."""

    outcome: Outcome  # with the verdicts of both
    judged: Judged
    twin: Twin
    cycles_s: float  # cycles per second of wall clock, Takt and scenario included
    servo_cycles_s: float | None  # the same with our servo model; None: not compared


def find(what: Path, scenario: Path | None) -> tuple[Path, Scenario]:
    """Returns machine file and scenario for a machine file, a ready machine's name or a scenario file.

    scenario: scenario file; None: that of the machine, for a machine file the `scenario.py` beside it.
    """
    if what.suffix in (".yaml", ".yml"):
        file = scenario or what.parent / "scenario.py"
        return what, load_scenario(file)
    found = load_scenario(scenario or scenario_of(str(what)))
    return (scenario_of(str(what)).parent / "machine.yaml" if scenario else found.machine), found


def run(machine: Path, scenario: Scenario, *, compare: bool = True, report: Path | None = None) -> TwinRun:
    """Runs a scenario in the twin of a machine.

    compare: run it with our servo model, too, for comparison.
    report: folder of the report; None: no report.

    Raises PlantError if the physics explodes.
    """
    servo = None
    servo_rate = None
    Twin.of(machine)  # raises its errors before anything runs
    if compare:
        with Engine(machine) as session:
            start = time.perf_counter()
            servo = run_scenario(scenario, session).recording
            servo_rate = session.cycle / (time.perf_counter() - start)
    with Engine(machine, plant="mujoco") as session:
        twin = session.plant
        assert isinstance(twin, Twin)
        start = time.perf_counter()
        try:
            outcome = run_scenario(scenario, session, report)
        except PlantError as error:
            raise PlantError(f"{error}{_drawn(twin, report)}") from None
        rate = session.cycle / (time.perf_counter() - start)
    judged = judge(twin, outcome.recording, servo)
    outcome = replace(outcome, verdicts=(*outcome.verdicts, *judged.verdicts))
    return TwinRun(outcome, judged, twin, rate, servo_rate)


def _drawn(twin: Twin, report: Path | None) -> str:
    if report is None:
        return ""
    try:
        return f"; picture: {twin.picture(report / 'twin.png')}"
    except TaktError as error:
        return f"; {error}"


def table(judged: Judged) -> Table:
    """Returns the figures of the twin beside those of our servo model as a table."""
    made = Table(*HEAD, box=None)
    for row in judged.table():
        made.add_row(*row)
    return made
