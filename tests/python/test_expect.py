"""PY-05: motion assertions of conditions and states, and what holds for every assertion."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from motion_curves import DT, LIMITS, STATES, axis, one_axis
from takt import checks, expect
from takt.errors import ConfigError
from takt.recording import Recording, RecordingError
from takt.verdict import MotionAssertionError, Verdict

T = np.arange(2000) * DT

# --- conditions and states ---


# PY-05
def test_stays() -> None:
    rec = one_axis(lag=0.002)
    assert checks.stays(rec, "|x.following_error| <= 0.4").passed
    beyond = checks.stays(rec, "x.following_error <= 0.399")
    assert beyond.by_how_much == pytest.approx(0.001, rel=1e-6)
    assert beyond.when_s is not None
    assert 0.38 < beyond.when_s < 0.4
    assert checks.stays(rec, "x.state == Standstill", window=(1.0, 1.9)).passed
    assert checks.stays(rec, "x.state == Standstill and x.in_position", window=(1.0, 1.9)).passed
    moved = checks.stays(rec, "x.state != DiscreteMotion")
    assert not moved.passed
    assert "DiscreteMotion" in moved.sentence
    assert not checks.stays(rec, "not x.in_position").passed


# PY-05
def test_never_both() -> None:
    time_s = np.arange(100) * DT
    a = np.zeros(100)
    b = np.zeros(100)
    a[10:21] = 5
    b[21:30] = 5

    def rec() -> Recording:
        return Recording({"a": {"time_s": time_s, "p": a}, "b": {"time_s": time_s, "p": b}})

    assert checks.never_both(rec(), "a.p > 1", "b.p > 1").passed
    b[20] = 5
    verdict = checks.never_both(rec(), "a.p > 1", "b.p > 1")
    assert not verdict.passed
    assert verdict.when_s == pytest.approx(0.02)
    assert verdict.by_how_much == 0.0
    assert checks.never_both(rec(), "a.p > 1 and b.p < 1", "b.p > 1").passed


# PY-05
def test_visits_states() -> None:
    rec = one_axis()
    assert checks.visits_states(rec, "x", ["Standstill", "DiscreteMotion", "Standstill"], exactly=True).passed
    assert checks.visits_states(rec, "x", ["Standstill", "Standstill"]).passed
    assert not checks.visits_states(rec, "x", ["Standstill", "Standstill"], exactly=True).passed
    assert not checks.visits_states(rec, "x", ["Standstill", "DiscreteMotion"], exactly=True).passed
    missing = checks.visits_states(rec, "x", ["DiscreteMotion", "Stopping"])
    assert not missing.passed
    assert "Stopping is missing" in missing.sentence
    assert not checks.visits_states(rec, "x", ["DiscreteMotion", "Standstill", "DiscreteMotion"]).passed
    with pytest.raises(ValueError, match="states is an empty list, so there is nothing to judge"):
        checks.visits_states(rec, "x", [])
    with pytest.raises(TypeError, match="states is a list of names, not the text 'Standstill'"):
        checks.visits_states(rec, "x", "Standstill")


@pytest.mark.parametrize(
    ("condition", "sentence"),
    [
        ("x.state == Standstil", "did you mean 'Standstill'"),
        ("x.set_position > far", "neither a number nor the name"),
        ("x.set_position > nan", "neither a number nor the name"),
        ("x.set_position", None),
        ("set_position > 3", "not of the form"),
        ("x.set_position => 3", "is not a condition"),
        ("y.set_position > 3", "no component 'y'"),
        ("x.position > 3", "no field 'position'"),
    ],
)
def test_conditions_that_make_no_sense(condition: str, sentence: str | None) -> None:
    if sentence is None:
        assert not checks.stays(one_axis(), condition).passed  # a number alone: is it other than zero
        return
    with pytest.raises(RecordingError, match=sentence):
        checks.stays(one_axis(), condition)


# EN-20, PY-05
def test_complete() -> None:
    assert checks.complete(one_axis(), "x").passed
    rec = Recording({"x": np.delete(one_axis()["x"], [100, 101, 500])})
    verdict = checks.complete(rec, "x")
    assert not verdict.passed
    assert "3 samples of x lost in 2 gaps, the first after cycle 99 at 0.099 s" in verdict.sentence
    one = checks.complete(Recording({"x": np.delete(one_axis()["x"], [100])}), "x")
    assert "1 sample of x lost in 1 gap, the first" in one.sentence
    assert verdict.by_how_much == 3
    assert verdict.when_s == pytest.approx(0.099)


# EN-20, PY-05: of the samples that an assertion asks for, of its components and in its window alone
def test_an_assertion_says_what_it_had_to_do_without() -> None:
    x = one_axis()["x"]
    rec = Recording({"x": np.delete(x, [100, 101, 500]), "y": x})
    whole = checks.stays(rec, "x.set_position > -1")
    assert whole.passed
    assert whole.sentence.endswith("; missing: 3 samples of x in 2 gaps, the first after 0.099 s")
    after = checks.stays(rec, "x.set_position > -1", window=(0.3, 0.6))
    assert after.sentence.endswith("; missing: 1 sample of x in 1 gap, after 0.499 s")
    assert "missing" not in checks.stays(rec, "x.set_position > -1", window=(0.6, 1.0)).sentence
    assert "missing" not in checks.stays(rec, "y.set_position > -1").sentence
    failed = checks.stays(rec, "x.set_position < 50")
    assert not failed.passed
    assert "missing: 3 samples of x" in failed.sentence


# --- what can be said of every assertion ---

EVERY: dict[str, Callable[[Recording], Verdict]] = {
    "within_limits": lambda r: checks.within_limits(r, "x", **LIMITS),  # type: ignore[arg-type]
    "continuous": lambda r: checks.continuous(r, "x", velocity=200.0, acceleration=1000.0, jerk=10_000.0),
    "reaches": lambda r: checks.reaches(r, "x", 100.0, tolerance=0.1, by=1.9),
    "settles": lambda r: checks.settles(r, "x", 100.0, 0.1, within=0.9),
    "in_sync": lambda r: checks.in_sync(r, "x", "x", tolerance=1.0),
    "keeps_distance": lambda r: checks.keeps_distance(r, "x", "x", 0.0),
    "never_both": lambda r: checks.never_both(r, "x.set_position < -1", "x.actual_position < -1"),
    "stays": lambda r: checks.stays(r, "x.set_position > -1"),
    "visits_states": lambda r: checks.visits_states(r, "x", ["DiscreteMotion", "Standstill"]),
}
USES = {
    "within_limits": "set_acceleration",
    "continuous": "set_velocity",
    "reaches": "actual_position",
    "settles": "actual_position",
    "in_sync": "set_position",
    "keeps_distance": "actual_position",
    "never_both": "actual_position",
    "stays": "set_position",
}


@pytest.mark.parametrize("name", EVERY)
def test_all_hold_for_the_plain_move(name: str) -> None:
    assert EVERY[name](one_axis()).passed


# PY-05: NaN never passes
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("at", [0, 400, 800])
@pytest.mark.parametrize("name", USES)
def test_what_is_not_a_number_fails(name: str, at: int, bad: float) -> None:
    column = one_axis()["x"][USES[name]].copy()
    column[at] = bad
    verdict = EVERY[name](one_axis(**{USES[name]: column}))
    assert not verdict.passed
    assert "is not a number" in verdict.sentence
    assert verdict.when_s == pytest.approx(at * DT)


# PY-05: no data, no pass
@pytest.mark.parametrize("name", EVERY)
def test_an_empty_recording_fails(name: str) -> None:
    empty = one_axis().slice(50, 60)
    assert len(empty["x"]) == 0
    verdict = EVERY[name](empty)
    assert not verdict.passed
    assert "no sample" in verdict.sentence


@pytest.mark.parametrize("window", [(1.0, 3.0), (-1.0, 1.0)])
def test_a_window_that_was_not_recorded_fails(window: tuple[float, float]) -> None:
    verdict = checks.stays(one_axis(), "x.set_position > -1", window=window)
    assert not verdict.passed
    assert "the recording of x" in verdict.sentence
    with pytest.raises(ValueError, match="does not run forward"):
        checks.stays(one_axis(), "x.set_position > -1", window=(1.0, 0.5))


# --- the asserting form ---


# PY-05: failures say when, by how much, and save a picture
def test_a_failure_raises_with_a_sentence_and_a_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(expect, "pictures", tmp_path / "pics")
    assert expect.reaches(one_axis(), "x", 100.0, tolerance=0.01, by=0.9).passed
    with pytest.raises(MotionAssertionError) as caught:
        expect.reaches(one_axis(), "x", 100.0, tolerance=0.01, by=0.88)
    text = str(caught.value)
    assert isinstance(caught.value, AssertionError)
    assert text.startswith("reaches(x): x did not reach 100 mm ± 0.01 mm by 0.88 s")
    again = pickle.loads(pickle.dumps(caught.value))  # as between processes
    assert (str(again), again.verdict.sentence) == (text, caught.value.verdict.sentence)
    wrong = pickle.loads(pickle.dumps(ConfigError(["a: one", "b: two"])))
    assert wrong.problems == ["a: one", "b: two"]
    picture = caught.value.verdict.picture
    assert picture is not None
    assert f"picture: {picture}" in text
    assert picture.parent == tmp_path / "pics"
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_picture_that_cannot_be_saved_does_not_hide_the_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(expect, "pictures", tmp_path / "file")
    with pytest.raises(MotionAssertionError, match="no picture: "):
        expect.within_limits(one_axis(), "x", velocity=1.0)
    monkeypatch.setattr(expect, "pictures", None)
    with pytest.raises(MotionAssertionError) as caught:
        expect.within_limits(one_axis(), "x", velocity=1.0)
    assert "picture" not in str(caught.value)


# PY-05: for scenario runs
def test_collecting_instead_of_raising(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(expect, "pictures", tmp_path)
    with expect.collect() as verdicts:
        expect.within_limits(one_axis(), "x")
        with expect.collect() as inner:
            expect.within_limits(one_axis(), "x", velocity=2.0)
        expect.within_limits(one_axis(), "x", velocity=1.0)
    assert [v.passed for v in verdicts] == [True, False]
    assert [v.passed for v in inner] == [False]
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(MotionAssertionError):
        expect.within_limits(one_axis(), "x", velocity=1.0)


def test_every_check_has_its_asserting_form() -> None:
    for name in checks.__all__:
        assert getattr(expect, name).__wrapped__ is getattr(checks, name)
        assert name in expect.__all__


def test_states_by_name_only_where_there_are_names() -> None:
    with pytest.raises(RecordingError, match="has no named values"):
        checks.visits_states(one_axis(), "x", ["Standstill"], field="set_position")
    assert STATES[1] == "Standstill"
    assert "x" in Recording({"x": axis(T, T, T, T)})
