"""The six axes of the demo (PY-02, EN-06, EN-24): the same scenario and verdicts in virtual time and on taktd."""

from __future__ import annotations

import contextlib
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
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


@contextlib.contextmanager
def lcm_logger(url: str, file: Path) -> Iterator[None]:
    logger = subprocess.Popen(["/usr/bin/lcm-logger", f"--lcm-url={url}", "--quiet", file])
    try:
        yield
    finally:
        logger.send_signal(signal.SIGINT)
        logger.wait(20)


def test_on_taktd_with_the_real_tools(in_process: Outcome, tmp_path: Path) -> None:
    """Over LCM, replayed from taktd's journal; lcm-logger, beside, has heard the same, though not always all of it."""
    scenario = load_scenario(SCENARIO)
    file = tmp_path / "theirs.log"
    result = run_demo(scenario, scenario.machine, tmp_path, pace="paced", beside=lambda url: lcm_logger(url, file))
    assert result.passed, [v.sentence for v in result.outcome.verdicts if not v.passed]
    assert verdicts(result.outcome) == verdicts(in_process)
    assert result.replayed.same
    ours, theirs = result.outcome.recording, takt.read_log(file)
    assert theirs.components == ours.components
    for axis in ours.components:
        both = np.isin(ours[axis]["cycle"], theirs[axis]["cycle"])
        assert np.mean(both) > 0.5
        assert ours[axis][both].tobytes() == theirs[axis][np.isin(theirs[axis]["cycle"], ours[axis]["cycle"])].tobytes()
        assert not ours.gaps(axis)
