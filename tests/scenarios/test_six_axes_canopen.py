"""AX-87, EN-26: the six axes with drives of CiA 402 on a CANopen bus: the same verdicts as simulated."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
import takt
import yaml
from takt.scenario import Outcome, load_scenario, run_scenario

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
from buses import emulated, new_bus, run
from machines import new_url

FOLDER = Path(__file__).parents[2] / "python/examples/six_axes"


def machine() -> dict[str, Any]:
    text: dict[str, Any] = yaml.safe_load((FOLDER / "canopen.yaml").read_text())
    return text


def verdicts(outcome: Outcome) -> list[tuple[str, bool]]:
    return [(verdict.title, verdict.passed) for verdict in outcome.verdicts]


def test_the_verdicts_are_those_of_the_simulation() -> None:
    """In simulated time, with the emulated drives behind SDO, NMT, SYNC and process data."""
    scenario = load_scenario(FOLDER / "scenario.py")
    inside = machine()
    del inside["external"]
    with takt.Engine(yaml.safe_dump(inside)) as session:
        expected = run_scenario(scenario, session)
    assert expected.passed, [v.sentence for v in expected.verdicts if not v.passed]

    url = new_url()
    outside = machine()
    outside["lcm"]["url"] = url
    outside["external"]["answer_within_s"] = 20
    outside["external"]["buses"][0]["bus"] = new_bus()
    text = yaml.safe_dump(outside)
    with emulated(text), run(text, url) as (bus, _), takt.Engine(text) as session:
        result = run_scenario(scenario, session)
    assert verdicts(result) == verdicts(expected)
    assert bus.late == 0
    end = {axis: float(expected.recording[axis]["actual_position"][-1]) for axis in ("x", "y", "a", "c", "feed")}
    for axis, position in end.items():
        assert float(result.recording[axis]["actual_position"][-1]) == pytest.approx(position, abs=0.1)
