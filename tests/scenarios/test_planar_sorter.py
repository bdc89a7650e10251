"""The planar sorter: 60 movers to interchangeable targets on an L of stators with two parts that move (PL-72, PL-70,
PL-32)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from takt.scenario import modules_of

FOLDER = Path(__file__).parents[2] / "python/examples/planar_sorter"
with modules_of(FOLDER):
    from judge import STANDS, TRAYS, Judgement, judge
    from scenario import EVERY, play
    from sorter import ON_TRAY, SIDE, Sorter

SECONDS = 13.0
TEXT = (FOLDER / "machine.yaml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def played() -> tuple[takt.Recording, Sorter]:
    with takt.Engine(TEXT) as session:
        recorder = session.record(every=EVERY)
        sorter = play(session, SECONDS)
        return recorder.stop(), sorter


@pytest.fixture(scope="module")
def became(played: tuple[takt.Recording, Sorter]) -> Judgement:
    return judge(played[0])


def test_products_are_sorted(became: Judgement, played: tuple[takt.Recording, Sorter]) -> None:
    """Each tray has gone away once at least, with as many as it takes; the program counts the same."""
    assert not played[1].refused
    for tray in TRAYS:
        assert len(became.delivered_s[tray]) >= ON_TRAY
        assert len(became.delivered_s[tray]) % ON_TRAY == 0
    assert became.products_a_minute > 45, became.sentence
    assert became.nearest > SIDE - 1e-6


def test_movers_are_held_up_for_reasons_that_are_told(became: Judgement) -> None:
    """PL-70: what movers do adds up, and little of it is waiting for one another."""
    assert sum(became.shares.values()) == pytest.approx(1, abs=1e-9)
    assert set(became.held_s) == {"movers before them", "movers in their way"}
    assert 0 < sum(became.held_s.values()) < 0.15 * SECONDS * len(became.movers), became.sentence


def test_only_movers_that_stand_ride(played: tuple[takt.Recording, Sorter]) -> None:
    """PL-32: a tray goes when no mover is on its way over it."""
    recording, _ = played
    for number, tray in enumerate(TRAYS, 2):
        away = recording.column(tray, "position_index") != 1
        assert np.sum(away) > 50
        for mover in (name for name in recording.components if "waits_for" in recording.fields(name)):
            on = away & (recording.column(mover, "part") == number)
            assert np.all(abs(recording.column(mover, "velocity_x")[on]) < STANDS)
