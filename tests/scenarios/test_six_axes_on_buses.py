"""AX-87, EN-26: the six axes with drives of CiA 402 on field buses: the same verdicts as simulated."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import takt
import yaml
from takt.scenario import Outcome, load_scenario, run_scenario

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
import buses
from machines import new_url

FOLDER = Path(__file__).parents[2] / "python/examples/six_axes"


def machine(bus: str) -> dict[str, Any]:
    text: dict[str, Any] = yaml.safe_load((FOLDER / f"{bus}.yaml").read_text())
    return text


@contextlib.contextmanager
def driven(bus: str, text: str, url: str, folder: Path) -> Iterator[takt.drive.Bus]:
    """Emulated drives, and the process that has them on the bus."""
    if bus == "canopen":
        with buses.emulated(text), buses.run(text, url) as (served, _):
            yield served
        return
    pytest.importorskip("pysoem")
    import wires

    with wires.own_network(), wires.emulated(text, folder), wires.run(text, url) as (served, _):
        yield served
        assert served.lost_frames <= served.cycles / 1000  # a busy host is too late for some


def verdicts(outcome: Outcome) -> list[tuple[str, bool]]:
    return [(verdict.title, verdict.passed) for verdict in outcome.verdicts]


@pytest.mark.parametrize("bus", ["canopen", "ethercat"])
def test_the_verdicts_are_those_of_the_simulation(bus: str, tmp_path: Path) -> None:
    """In simulated time, with emulated drives behind all that the bus has: SDO, NMT, SYNC, or frames and mailboxes."""
    scenario = load_scenario(FOLDER / "scenario.py")
    inside = machine(bus)
    del inside["external"]
    with takt.Engine(yaml.safe_dump(inside)) as session:
        expected = run_scenario(scenario, session)
    assert expected.passed, [v.sentence for v in expected.verdicts if not v.passed]

    url = new_url()
    outside = machine(bus)
    outside["lcm"]["url"] = url
    outside["external"]["answer_within_s"] = 20
    if bus == "canopen":
        outside["external"]["buses"][0]["bus"] = buses.new_bus()
    text = yaml.safe_dump(outside)
    with driven(bus, text, url, tmp_path) as served, takt.Engine(text) as session:
        result = run_scenario(scenario, session)
        assert served.late == 0
    assert verdicts(result) == verdicts(expected)
    end = {axis: float(expected.recording[axis]["actual_position"][-1]) for axis in ("x", "y", "a", "c", "feed")}
    for axis, position in end.items():
        assert float(result.recording[axis]["actual_position"][-1]) == pytest.approx(position, abs=0.1)
