"""The planar line: 32 movers on a network with stations, lanes that part and meet, and a bypass (PL-24, PL-26, PL-70,
PL-71)."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
import takt
from takt.scenario import load_scenario, verify_recording

FOLDER = Path(__file__).parents[2] / "python/examples/planar_line"
sys.path.insert(0, str(FOLDER))

from judge import Judgement, judge  # noqa: E402
from line import PRESSES  # noqa: E402
from scenario import EVERY, play  # noqa: E402

TEXT = (FOLDER / "machine.yaml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def recording() -> takt.Recording:
    with takt.Engine(TEXT) as session:
        recorder = session.record(every=EVERY)
        line = play(session, 90.0)
        recording = recorder.stop()
    assert line.finished == len(judge(recording).pieces_s)
    return recording


@pytest.fixture(scope="module")
def became(recording: takt.Recording) -> Judgement:
    return judge(recording)


def test_the_line_works(recording: takt.Recording) -> None:
    """As its own scenario asks, after a shorter time."""
    outcome = verify_recording(load_scenario(FOLDER / "scenario.py"), recording)
    assert outcome.passed, [outcome.complaint, *(v.sentence for v in outcome.verdicts if not v.passed)]


def test_presses_share_the_work(became: Judgement) -> None:
    busy = [became.busy[press.name] for press in PRESSES]
    assert min(busy) > 0.7
    assert max(busy) - min(busy) < 0.1


def test_time_adds_up(became: Judgement) -> None:
    """PL-70: whatever a mover does, the recording says what, and before which station it waits."""
    assert became.going + became.worked_on + sum(became.held_by.values()) == pytest.approx(1, abs=1e-9)
    one_each = sum(became.busy.values()) / len(became.movers)
    assert became.worked_on == pytest.approx(one_each, rel=0.02)


def test_it_is_the_same_again() -> None:
    hashes = []
    for _ in range(2):
        with takt.Engine(TEXT) as session:
            play(session, 5.0)
            hashes.append(session.state_hash)
    assert hashes[0] == hashes[1]
