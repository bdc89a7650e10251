"""The pick cell: picks from a running belt, places onto a second one, held against where everything really was (CV-01,
CV-02, CV-20, CV-21, CV-23, PP-40, PP-42, PP-51, PP-68)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from takt import expect
from takt.demo import run_demo
from takt.scenario import load_scenario, modules_of, run_scenario

FOLDER = Path(__file__).parents[2] / "python/examples/pick_cell"
SCENARIO = FOLDER / "scenario.py"
with modules_of(FOLDER):
    from cell import Settings
    from judge import Judgement, judge
    from picker import LEFT, NOT_HELD
    from scenario import MACHINE, play

TEXT = (FOLDER / "machine.yaml").read_text(encoding="utf-8")
EXACT = {"noise": 0.0, "slip": 0.0, "slides": 0.0}  # nothing but belts, arms and gripper can be wrong
SPARSE = {"nearest": 500.0, "more": 300.0, "pitch": 500.0}  # for fast belts
AXES = ("arm_1", "arm_2", "arm_3", "infeed_drive", "outfeed_drive")


def run(
    settings: Settings,
    *speeds: tuple[float, str, float],
    seconds: float = 30.0,
    interrupt: float | None = None,
    text: str = TEXT,
) -> tuple[takt.Recording, Judgement]:
    with takt.Engine(text) as session:
        recorder = session.record()
        play(session, settings, seconds, speeds, interrupt)
        recording = recorder.stop()
    return recording, judge(recording, MACHINE, settings)


def test_the_demo_in_virtual_time() -> None:
    """With changing speeds, an interrupted path, a camera that errs, and belts that slip."""
    scenario = load_scenario(SCENARIO)
    with takt.Engine(scenario.machine) as session:
        outcome = run_scenario(scenario, session)
    assert outcome.passed, [outcome.complaint, *(v.sentence for v in outcome.verdicts if not v.passed)]
    assert len(outcome.verdicts) == 15
    assert outcome.recording.duration_s == pytest.approx(scenario.takes_s, rel=0.1)


def test_the_demo_on_taktd(tmp_path: Path) -> None:
    scenario = load_scenario(SCENARIO)
    result = run_demo(scenario, scenario.machine, tmp_path, pace="paced")
    assert result.passed, [result.outcome.complaint, *(v.sentence for v in result.outcome.verdicts if not v.passed)]


def test_at_constant_speed_products_are_placed_where_they_belong() -> None:
    """CV-02, CV-20, CV-23: poses come late, tracking is exact, from one running belt to another. Twice the same."""
    recording, found = run(Settings(**EXACT))
    assert len(found.placed) > 30
    assert found.errors.max() < 0.06
    assert max(abs(one.height) for one in found.placed) < 0.15
    assert not found.misses
    for axis in AXES:
        assert expect.within_limits(recording, axis)
        assert expect.continuous(recording, axis)
    again, same = run(Settings(**EXACT))
    assert [(one.product, one.tray, one.time_s) for one in same.placed] == [
        (one.product, one.tray, one.time_s) for one in found.placed
    ]
    assert np.array_equal(same.errors, found.errors)
    assert np.array_equal(again["robot"]["x"], recording["robot"]["x"])


def test_at_a_metre_a_second_with_changing_speeds() -> None:
    """PP-51: below 0.1 mm against the true belts, whose speeds change by up to 20 % three times a second."""
    levels = (1000.0, 1100.0, 900.0)
    speeds = [(0.0, belt, 1000.0) for belt in ("infeed", "outfeed")]
    for i in range(1, 85):
        speeds += [(0.35 * i, "infeed", levels[i % 3]), (0.35 * i, "outfeed", levels[-i % 3])]
    recording, found = run(Settings(**EXACT, **SPARSE), *speeds, text=TEXT.replace("sync_time: 0.3", "sync_time: 0.05"))
    assert len(found.placed) > 15
    assert found.errors.max() < 0.1
    assert set(found.reasons) <= {LEFT}
    for axis in AXES:
        assert expect.within_limits(recording, axis)


def test_an_interrupted_path_is_gone_on_with() -> None:
    """PP-20: the product in the gripper gets to its tray all the same."""
    recording, found = run(Settings(**EXACT), seconds=8.0, interrupt=3.0)
    assert expect.visits_states(recording, "picker", ["ready", "move_pp", "path_interrupt", "move_pp", "ready"])
    robot, picker = recording["robot"], recording["picker"]
    interrupted = list(takt.PickPlaceState).index(takt.PickPlaceState.PATH_INTERRUPT)
    rests = (picker["state"] == interrupted) & (robot["velocity"] == 0)
    assert np.count_nonzero(rests) > 150
    assert any(one.held_s < robot["time_s"][rests][0] < one.time_s for one in found.placed)
    assert found.errors.max() < 0.06
    assert not found.misses


def test_what_slips_is_measured_and_not_believed() -> None:
    """Encoders do not see that belts slip. The truth does: a product is held beside its middle by the slip since the
    camera saw it."""
    slip = 0.001
    settings = Settings(noise=0.0, slides=0.0, slip=slip)
    recording, found = run(settings, seconds=10.0)
    drive = recording["infeed_drive"]
    for one in found.placed:
        travel = np.interp(one.held_s, drive["time_s"], drive["true_position"])
        assert one.gripped[0] == pytest.approx(-slip * (travel - one.product.at), abs=0.06)
    assert found.errors.max() > 0.3


def test_a_coarse_encoder_costs_what_it_must() -> None:
    """CV-01: 10 counts a mm, and a filter for them."""
    coarse = TEXT.replace("increments_per_unit: 500", "increments_per_unit: 10").replace(
        "filter_s: 0.003", "filter_s: 0.03"
    )
    assert coarse != TEXT
    _, found = run(Settings(**EXACT), seconds=15.0, text=coarse)
    assert 0.02 < found.errors.max() < 0.25


@pytest.mark.parametrize(
    ("settings", "speed", "why"),
    [
        (Settings(slides=0.3, noise=0.0), 200.0, NOT_HELD),
        (Settings(**EXACT), 350.0, LEFT),
        (Settings(**EXACT, across=500.0), 200.0, LEFT),
    ],
    ids=[NOT_HELD, LEFT, "unreachable"],
)
def test_each_miss_has_its_reason(settings: Settings, speed: float, why: str) -> None:
    """PP-44: and it goes on after it."""
    with takt.Engine(TEXT) as session:
        recorder = session.record()
        cell = play(session, settings, 20.0, ((0.0, "infeed", speed),))
        passed, waiting = session.belt("infeed").last_number, cell.infeed.waiting
        recording = recorder.stop()
    found = judge(recording, MACHINE, settings)
    assert found.reasons[why] > 0
    assert set(found.reasons) <= {NOT_HELD, LEFT}
    assert found.placed[-1].time_s > found.misses[0].time_s
    assert len(found.placed) + len(found.misses) == passed - waiting
