"""The six axes of the demo (PY-02, EN-06, EN-24): the same scenario and verdicts in virtual time and on taktd."""

from __future__ import annotations

from pathlib import Path

import pytest
import takt
from takt.demo import run_demo
from takt.scenario import Outcome, load_scenario, run_scenario

SCENARIO = Path(__file__).parents[2] / "python/examples/six_axes/scenario.py"


def verdicts(outcome: Outcome) -> list[tuple[str, bool]]:
    return [(verdict.title, verdict.passed) for verdict in outcome.verdicts]


@pytest.fixture(scope="module")
def in_process() -> Outcome:
    scenario = load_scenario(SCENARIO)
    with takt.Engine(scenario.machine) as session:
        return run_scenario(scenario, session)


def test_in_virtual_time(in_process: Outcome) -> None:
    assert in_process.passed, [v.sentence for v in in_process.verdicts if not v.passed]
    assert len(in_process.verdicts) >= 20
    assert in_process.recording.duration_s == pytest.approx(load_scenario(SCENARIO).takes_s, rel=0.1)


def test_twice_the_same(in_process: Outcome) -> None:
    """EN-06: bit for bit."""
    scenario = load_scenario(SCENARIO)
    with takt.Engine(scenario.machine) as session:
        again = run_scenario(scenario, session).recording
    for axis in again.components:
        assert again[axis].tobytes() == in_process.recording[axis].tobytes()


def test_on_taktd_with_the_real_tools(in_process: Outcome, tmp_path: Path) -> None:
    """Over LCM, recorded by lcm-logger, replayed from taktd's journal."""
    scenario = load_scenario(SCENARIO)
    result = run_demo(scenario, scenario.machine, tmp_path, pace="paced")
    assert result.passed, [v.sentence for v in result.outcome.verdicts if not v.passed]
    assert verdicts(result.outcome) == verdicts(in_process)
    assert result.replayed.same
