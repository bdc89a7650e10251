"""`takt twin`: a scenario in the twin of its machine, with the twin's verdicts beside the scenario's own."""

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
from takt.twin.judging import Judged, judge
from takt.twin.plant import Twin


@dataclass(frozen=True)
class TwinRun:
    """A scenario that has run in a twin."""

    outcome: Outcome  # with the verdicts of both
    judged: Judged
    twin: Twin
    cycles_s: float  # cycles a second of the wall clock, Takt and scenario included
    servo_cycles_s: float | None  # the same with our servo model


def find(what: Path, scenario: Path | None) -> tuple[Path, Scenario]:
    """Machine file and scenario of a machine file, a ready machine's name or a scenario file."""
    if what.suffix in (".yaml", ".yml"):
        file = scenario or what.parent / "scenario.py"
        return what, load_scenario(file)
    found = load_scenario(scenario or scenario_of(str(what)))
    return (scenario_of(str(what)).parent / "machine.yaml" if scenario else found.machine), found


def run(machine: Path, scenario: Scenario, *, compare: bool = True, report: Path | None = None) -> TwinRun:
    """Runs a scenario in the twin of a machine, and with our servo model to compare."""
    servo = None
    servo_rate = None
    Twin.of(machine)  # what is wrong with it is said before anything runs
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
    """Figures of the twin beside those of our servo model."""
    made = Table("", "", "twin rms", "largest", "servo rms", "largest", box=None)
    for tool in judged.tools:
        made.add_row(tool.group, "tool from its set pose [mm]", *_pair(tool.off), *_pair(tool.servo_off))
        made.add_row("", "tool from Takt's kinematics [mm]", *_pair(tool.agreement), "", "")
    if judged.products is not None:
        made.add_row("products", "tool from their middle, gripped [mm]", *_pair(judged.products.beside), "", "")
        made.add_row("", "moved after they were put down [mm]", *_pair(judged.products.moved), "", "")
    for axis in judged.axes:
        made.add_row(axis.axis, f"following error [{axis.unit}]", *_pair(axis.following), *_pair(axis.servo))
        made.add_row("", f"torque of {axis.max_torque:g}", *_pair(axis.torque), "", "")
    return made


def _pair(values: tuple[float, float] | None) -> tuple[str, str]:
    return ("", "") if values is None else (f"{values[0]:.2g}", f"{values[1]:.2g}")
