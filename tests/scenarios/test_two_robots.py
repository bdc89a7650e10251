"""Two Deltas over one belt (PP-67, GR-47): in virtual time and on taktd."""

from __future__ import annotations

from pathlib import Path

import pytest
import takt
from takt.demo import run_demo
from takt.scenario import load_scenario, run_scenario

SCENARIO = Path(__file__).parents[2] / "python/examples/two_robots/scenario.py"


def test_in_virtual_time() -> None:
    scenario = load_scenario(SCENARIO)
    with takt.Engine(scenario.machine) as session:
        outcome = run_scenario(scenario, session)
    assert outcome.passed, outcome.complaint or [v.sentence for v in outcome.verdicts if not v.passed]
    assert len(outcome.verdicts) >= 14
    assert outcome.recording.duration_s == pytest.approx(scenario.takes_s, rel=0.1)


def test_on_taktd(tmp_path: Path) -> None:
    scenario = load_scenario(SCENARIO)
    result = run_demo(scenario, scenario.machine, tmp_path, pace="paced")
    outcome = result.outcome
    assert outcome.passed, outcome.complaint or [v.sentence for v in outcome.verdicts if not v.passed]
    assert result.replayed.same
