"""AX-87, EN-26: the six axes with drives of CiA 402 on EtherCAT: the same verdicts as simulated."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
import takt
import yaml
from takt.scenario import Outcome, load_scenario, run_scenario

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
from machines import new_url
from wires import emulated, own_network, run

FOLDER = Path(__file__).parents[2] / "python/examples/six_axes"


def machine() -> dict[str, Any]:
    text: dict[str, Any] = yaml.safe_load((FOLDER / "ethercat.yaml").read_text())
    return text


def verdicts(outcome: Outcome) -> list[tuple[str, bool]]:
    return [(verdict.title, verdict.passed) for verdict in outcome.verdicts]


def test_the_verdicts_are_those_of_the_simulation(tmp_path: Path) -> None:
    """In simulated time, with the emulated drives behind frames, mailboxes and process data."""
    pytest.importorskip("pysoem")
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
    text = yaml.safe_dump(outside)
    with own_network(), emulated(text, tmp_path), run(text, url) as (bus, _), takt.Engine(text) as session:
        result = run_scenario(scenario, session)
    assert verdicts(result) == verdicts(expected)
    assert (bus.late, bus.lost_frames) == (0, 0)
    end = {axis: float(expected.recording[axis]["actual_position"][-1]) for axis in ("x", "y", "a", "c", "feed")}
    for axis, position in end.items():
        assert float(result.recording[axis]["actual_position"][-1]) == pytest.approx(position, abs=0.1)
