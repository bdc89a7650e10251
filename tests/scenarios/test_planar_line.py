"""The planar line: 32 movers on a network with stations, lanes that part and meet, a bypass and a lift (PL-24, PL-26,
PL-32, PL-33, PL-70, PL-71)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from takt.scenario import load_scenario, modules_of, verify_recording

FOLDER = Path(__file__).parents[2] / "python/examples/planar_line"
with modules_of(FOLDER):
    from judge import Judgement, judge
    from line import PRESSES
    from scenario import EVERY, play

LOWER_TRACK = 11  # number of the track on the level below
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


def test_the_lift_takes_bad_pieces_down_and_up_again(recording: takt.Recording, became: Judgement) -> None:
    """PL-32: one after the other, each of them there and back."""
    assert became.busy["repair"] > 0.15
    level = recording.column("lift", "coordinate_system")
    arrivals = np.count_nonzero(np.diff(level[level > 0]))
    assert arrivals >= 6
    for mover in became.movers:
        levels = recording.column(mover, "coordinate_system")
        assert set(levels[recording.column(mover, "track") == LOWER_TRACK]) <= {2}


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
