"""PY-05: checks of motion hold for what keeps its bounds and fail for what misses them by a hair."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motion_curves import DT, LIMITS, one_axis, positions
from numpy.lib import recfunctions
from takt import checks, plot, report
from takt.recording import Recording
from takt.verdict import Verdict

T = np.arange(2000) * DT
HAIR = 1e-6  # relative


def bumped(field: str, at: int, by: float, samples: int = 1) -> Recording:
    """The move at its limits, with one column changed from sample `at` on."""
    column = one_axis()["x"][field].copy()
    column[at : at + samples] += by
    return one_axis(**{field: column})


def failed(verdict: Verdict, *, when: float, by: float, unit: str, rel: float = 1e-6) -> None:
    assert not verdict.passed
    assert verdict.when_s == pytest.approx(when, abs=1e-9)
    assert verdict.by_how_much == pytest.approx(by, rel=rel)
    assert verdict.unit == unit
    assert verdict.place is not None
    assert verdict.lanes
    assert verdict.sentence.startswith(verdict.components[0])


# --- conditions ---


@pytest.mark.parametrize("level", [100.0, -0.3, 1e6, 1e-9, 0.0])
@pytest.mark.parametrize("share", [0.0, 0.4, -0.4, 3.0, -3.0])
def test_numbers_that_rounding_told_apart_are_equal(level: float, share: float) -> None:
    """PY-05: to a billionth, near zero to 1e-12. Each comparison is the contrary of another one, so that of a condition
    and its contrary one holds."""
    off = share * max(abs(level) * 1e-9, 1e-12)
    rec = Recording({"x": {"time_s": [0.0, 0.1], "v": [level + off] * 2}})
    above, below = share > 1, share < -1
    said = {
        "<=": not above,
        ">": above,
        ">=": not below,
        "<": below,
        "==": not above and not below,
        "!=": above or below,
    }
    for comparison, holds in said.items():
        assert checks.stays(rec, f"x.v {comparison} {level!r}").passed == holds, comparison
    for one, other in (("<=", ">"), (">=", "<"), ("==", "!=")):
        assert checks.never_both(rec, f"x.v {one} {level!r}", f"x.v {other} {level!r}").passed


def test_the_margin_of_a_condition() -> None:
    rec = Recording({"x": {"time_s": [0.0, 0.1, 0.2], "v": [3.0, 100.00000000000001, 5.0]}})
    verdict = checks.stays(rec, "|x.v| <= 100")
    assert verdict.sentence == "|x.v| <= 100 held throughout; closest call at 0.1 s, margin 0"
    assert checks.stays(rec, "x.v < 100.5").sentence.endswith("closest call at 0.1 s, margin 0.5")


# --- within limits ---


# PY-05
def test_a_move_at_its_limits_is_within_them() -> None:
    verdict = checks.within_limits(one_axis(), "x")
    assert verdict.passed
    assert "jerk" in verdict.sentence
    assert checks.within_limits(one_axis(), "x", position=(0.0, 100.0)).passed


# PY-05
@pytest.mark.parametrize(
    ("limit", "value", "by", "unit", "when"),
    [
        ("velocity", 200.0, 200.0 * HAIR, "mm/s", 0.4),
        ("acceleration", 1000.0, 1000.0 * HAIR, "mm/s²", 0.2),
        ("jerk", 10_000.0, 10_000.0 * 2e-6, "mm/s³", 0.1),
    ],
)
def test_a_limit_lower_by_a_hair_is_broken(limit: str, value: float, by: float, unit: str, when: float) -> None:
    verdict = checks.within_limits(one_axis(), "x", **{limit: value - by})  # type: ignore[arg-type]
    failed(verdict, when=when, by=by, unit=unit, rel=1e-3)
    assert f"its {limit} limit" in verdict.sentence


# PY-05
@pytest.mark.parametrize(("upper", "passes"), [(100.0, True), (100.0 - 1e-6, False)])
def test_position_limits(upper: float, passes: bool) -> None:
    rec = one_axis()
    assert checks.within_limits(rec, "x", position=(0.0, upper)).passed is passes
    assert checks.within_limits(rec, "x", position=(-math.inf, upper)).passed is passes
    assert checks.within_limits(rec, "x", position=(1e-6, math.inf)).passed is False


# PY-05
def test_motion_the_other_way_has_the_same_limits() -> None:
    def back(**changed: float) -> Recording:
        array = one_axis()["x"]
        columns = {f: -array[f] for f in ("set_position", "set_velocity", "set_acceleration")}
        for field, step in changed.items():
            columns[field][900:] += step
        return one_axis(**columns)

    assert checks.within_limits(back(), "x", position=(-100.0, 0.0)).passed
    assert checks.continuous(back(), "x").passed
    for limit, value in (("velocity", 199.999), ("acceleration", 999.99), ("jerk", 9999.9)):
        verdict = checks.within_limits(back(), "x", position=(-100.0, 0.0), **{limit: value})  # type: ignore[arg-type]
        assert f"its {limit} limit" in verdict.sentence
        assert not verdict.passed
    assert not checks.continuous(back(set_position=-1e-5), "x").passed
    assert not checks.continuous(back(set_velocity=-1.1), "x").passed


def test_a_rotary_axis_has_no_own_position_limits() -> None:
    array = one_axis()["x"]
    rec = Recording({"x": array}, info={"x": {"modulus": 360.0, "limits": {"position": [0, 1], "velocity": 200.0}}})
    assert checks.within_limits(rec, "x").passed


def test_limits_nobody_knows() -> None:
    rec = Recording({"x": one_axis()["x"]})
    with pytest.raises(ValueError, match="no finite limit is given"):
        checks.within_limits(rec, "x")
    with pytest.raises(ValueError, match="not a positive number"):
        checks.within_limits(rec, "x", velocity=math.nan)


def test_a_single_sample_shows_no_jerk() -> None:
    """PY-05: a jerk limit alone cannot be checked with it; other limits can."""
    rec = Recording({"x": one_axis()["x"][:1]})
    verdict = checks.within_limits(rec, "x", jerk=10.0)
    assert not verdict.passed
    assert verdict.sentence == "the recording has a single sample of x, which shows no jerk"
    assert checks.within_limits(rec, "x", jerk=10.0, velocity=1.0).passed


def test_an_infinite_limit_leaves_the_others_checked() -> None:
    """PY-05: also in `continuous`; without a finite limit there is nothing to check."""
    verdict = checks.within_limits(one_axis(), "x", velocity=math.inf, acceleration=10)
    assert "its acceleration limit" in verdict.sentence
    assert not verdict.passed
    verdict = checks.within_limits(one_axis(), "x", velocity=math.inf)
    assert verdict.passed
    assert "velocity" not in verdict.sentence
    assert not checks.continuous(one_axis(), "x", velocity=math.inf, acceleration=10).passed
    assert checks.continuous(one_axis(), "x", velocity=math.inf).passed
    unlimited = dict.fromkeys(("velocity", "acceleration", "jerk"), math.inf)
    with pytest.raises(ValueError, match="within_limits: no finite"):
        checks.within_limits(one_axis(), "x", position=(-math.inf, math.inf), **unlimited)
    with pytest.raises(ValueError, match="continuous: no finite"):
        checks.continuous(one_axis(), "x", **unlimited)


@pytest.mark.parametrize("value", [math.nan, math.inf])
@pytest.mark.parametrize(
    "arguments",
    [
        {"check": "in_sync", "tolerance": 1.0},
        {"check": "in_sync", "tolerance": 1.0, "ratio": 1.0},
        {"check": "in_sync", "tolerance": 1.0, "offset": 1.0},
        {"check": "keeps_distance", "minimum": 1.0},
        {"check": "keeps_distance", "minimum": 1.0, "tolerance": 1.0},
        {"check": "keeps_distance", "minimum": 1.0, "modulus": 1.0},
        {"check": "continuous", "step": 1.0},
        {"check": "continuous", "slack": 1.0},
        {"check": "within_limits", "tolerance": 1.0},
        {"check": "within_limits", "jerk_tolerance": 1.0},
    ],
)
def test_arguments_that_are_no_numbers_are_refused(arguments: dict[str, Any], value: float) -> None:
    """PY-05: the sentence names the check and its argument."""
    name, last = arguments["check"], list(arguments)[-1]
    given = {key: one for key, one in arguments.items() if key != "check"} | {last: value}
    components = ("x", "x") if name in ("in_sync", "keeps_distance") else ("x",)
    with pytest.raises(ValueError, match=f"^{name}: {last} is {value}, not "):
        getattr(checks, name)(one_axis(), *components, **given)


def test_deceleration_counts_and_jerk_zero_is_no_limit() -> None:
    array = one_axis()["x"]
    limits = {"acceleration": 500.0, "deceleration": 1000.0, "jerk": 0.0}
    assert checks.within_limits(Recording({"x": array}, info={"x": {"limits": limits}}), "x").passed


# PY-05
def test_the_set_point_of_an_open_loop_has_no_jerk() -> None:
    """An emergency stop while the axis speeds up: from that sample on the set point is what is measured."""
    array = one_axis()["x"].copy()
    fastest = int(np.argmax(array["set_acceleration"]))
    array["set_acceleration"][fastest:] = array["set_velocity"][fastest:] = 0
    assert not checks.within_limits(Recording({"x": array}, info={"x": {"limits": LIMITS}}), "x").passed
    closed = np.arange(len(array)) < fastest
    table = recfunctions.append_fields(array, "loop_closed", closed, usemask=False)
    assert checks.within_limits(Recording({"x": table}, info={"x": {"limits": LIMITS}}), "x").passed


# PY-05
def test_lost_samples_do_not_spoil_the_jerk() -> None:
    array = one_axis()["x"]
    rng = np.random.default_rng(3)
    lossy = Recording(
        {"x": array[np.sort(rng.choice(len(array), 1500, replace=False))]}, info={"x": {"limits": LIMITS}}
    )
    assert checks.within_limits(lossy, "x").passed
    assert checks.continuous(lossy, "x").passed


# PY-05
@given(
    start=st.floats(0, 1e5),
    amplitude=st.floats(1e-3, 1e5),
    f=st.floats(0.1, 20),
    over=st.sampled_from([1.0, 1 - 1e-4]),
)
def test_a_sine_is_within_its_closed_form_extremes(start: float, amplitude: float, f: float, over: float) -> None:
    w = 2 * math.pi * f
    t = start + np.arange(1000) / 2000 / f  # half a turn, with every extreme on a sample or beside it
    x = w * (t - start)
    rec = Recording.from_array(
        "x",
        Recording(
            {
                "x": {
                    "time_s": t,
                    "set_position": amplitude * np.sin(x),
                    "set_velocity": amplitude * w * np.cos(x),
                    "set_acceleration": -amplitude * w**2 * np.sin(x),
                }
            }
        )["x"],
        "mm",
    )
    a = amplitude * over
    kept = checks.within_limits(rec, "x", velocity=a * w, acceleration=a * w**2, jerk=a * w**3)
    assert kept.passed is (over == 1.0)
    if over == 1.0:
        assert checks.continuous(rec, "x", velocity=a * w, acceleration=a * w**2, jerk=a * w**3).passed


@pytest.mark.parametrize(
    ("window", "says", "place"),
    [
        ((0.5, 20.0), "the recording of x ends at 1.999 s, before 20 s", (1.999, 1.999)),
        ((-5.0, 1.0), "the recording of x starts at 0 s, after -5 s", (0.0, 0.0)),
        ((5.0, 9.0), "the recording has no sample of x between 5 s and 9 s", None),
    ],
)
def test_what_cannot_be_judged_shows_what_was_recorded(window: Any, says: str, place: Any) -> None:
    verdicts = [
        checks.stays(one_axis(), condition, window=window) for condition in ("x.set_position < 3", "x.state == 1")
    ]
    for verdict in verdicts:
        assert not verdict.passed
        assert verdict.sentence == says
        assert verdict.place == (None if place is None else pytest.approx(place))
        ((trace,),) = (lane.traces for lane in verdict.lanes)
        assert trace.time_s.tolist() == T.tolist()
    assert verdicts[1].lanes[0].names
    plot.draw_verdict(verdicts[0]).canvas.draw()
    report.render(one_axis(), verdicts, "t")


def test_what_is_broken_again_and_again_is_not_told_as_one() -> None:
    """The place that is shown is the first one, and the sentence says so."""
    at = np.zeros(1000)
    at[100:111] = 3
    rec = positions(x=at)
    once = "x.set_position < 2 did not hold from 0.1 s to 0.11 s, 11 samples: "
    assert checks.stays(rec, "x.set_position < 2").sentence.startswith(once)
    at[500] = at[800:900] = 3
    verdict = checks.stays(positions(x=at), "x.set_position < 2")
    assert verdict.sentence.startswith(f"{once[:-2]}, and 2 more times until 0.899 s: ")
    assert verdict.place == pytest.approx((0.1, 0.11))
    at[101:900] = 0
    at[899] = 3
    verdict = checks.stays(positions(x=at), "x.set_position < 2")
    assert verdict.sentence.startswith("x.set_position < 2 did not hold at 0.1 s, and 1 more time until 0.899 s: ")


# --- continuous ---


# PY-05
def test_a_jerk_limited_move_is_continuous() -> None:
    assert checks.continuous(one_axis(), "x").passed
    assert checks.continuous(one_axis(), "x", jerk=0.0).passed


# PY-05
@pytest.mark.parametrize(
    ("field", "step", "what"),
    [
        ("set_position", 1e-5, "position apart from its velocity"),
        ("set_position", 0.3, "position apart from its velocity"),
        ("set_velocity", 0.02, "velocity"),
        ("set_acceleration", 11.0, "acceleration"),
    ],
)
@pytest.mark.parametrize("at", [50, 250, 450, 1500])
def test_a_step_is_found_wherever_it_is(field: str, step: float, what: str, at: int) -> None:
    # A jerk of 10 m/s³ allows the acceleration 10 mm/s² in a sample, so less than that is no step of it.
    verdict = checks.continuous(bumped(field, at, step, 10_000), "x")
    assert not verdict.passed
    assert what in verdict.sentence
    assert verdict.when_s is not None
    assert verdict.when_s >= at * DT - 1e-9


def test_step_of_a_measured_signal() -> None:
    rec = positions(x=np.cumsum(np.full(100, 0.25)))
    assert checks.continuous(rec, "x", signal="actual_position", step=0.25).passed
    failed(checks.continuous(rec, "x", signal="actual_position", step=0.24), when=0.001, by=0.01, unit="mm")


# PY-05: rotary axes
def test_a_wrap_is_no_step() -> None:
    rec = positions("deg", {"x": 360.0}, x=np.linspace(-200, 900, 2000))
    assert checks.continuous(rec, "x", velocity=600.0).passed
    assert not checks.continuous(rec, "x", velocity=550.0).passed


def test_one_sample_shows_no_continuity() -> None:
    assert not checks.continuous(positions(x=np.zeros(1)), "x", velocity=1.0).passed


# --- reaches, settles ---


# PY-05
def test_reaches() -> None:
    rec = one_axis()
    verdict = checks.reaches(rec, "x", 100.0, tolerance=0.01, by=0.9)
    assert verdict.passed
    assert verdict.when_s is not None
    # The last phase brakes with 10 m/s³: 0.01 mm are left (6 * 0.01 / 10000)^(1/3) s before 0.9 s.
    entry = 0.9 - (6 * 0.01 / 10_000) ** (1 / 3)
    assert entry <= verdict.when_s < entry + DT
    late = checks.reaches(rec, "x", 100.0, tolerance=0.01, by=0.88)
    failed(late, when=0.88, by=10_000 / 6 * 0.02**3 - 0.01, unit="mm")
    assert "too late" in late.sentence
    assert not checks.reaches(rec, "x", 100.0 + 0.01 + 1e-7, tolerance=0.01, by=1.9).passed
    assert checks.reaches(rec, "x", 100.0 + 0.01 - 1e-7, tolerance=0.01, by=1.9).passed
    assert not checks.reaches(rec, "x", 0.0, tolerance=0.01, by=1.9, start=0.5).passed


def test_reaches_says_where_a_short_recording_ends() -> None:
    verdict = checks.reaches(one_axis(samples=500), "x", 100.0, tolerance=0.01, by=2.0)
    assert not verdict.passed
    assert "the recording ends at 0.499 s" in verdict.sentence


# PY-05: rotary axes
def test_reaches_the_short_way_round() -> None:
    rec = positions("deg", {"x": 360.0}, x=np.linspace(300, 359.995, 100))
    assert checks.reaches(rec, "x", 0.0, tolerance=0.01, by=0.099).passed
    assert not checks.reaches(rec, "x", 0.0, tolerance=0.004, by=0.099).passed


def decaying(amplitude: float = 10.0, tau: float = 0.05, f: float = 20.0) -> Recording:
    return positions(x=100 + amplitude * np.exp(-T / tau) * np.cos(2 * math.pi * f * T))


# PY-05
def test_settles() -> None:
    # The envelope 10 exp(-t / 0.05) falls below 0.1 after 0.05 ln(100) = 0.2303 s; its last peak above is at
    # 0.225 s.
    rec = decaying()
    verdict = checks.settles(rec, "x", 100.0, 0.1, within=0.2303)
    assert verdict.passed
    assert verdict.when_s is not None
    assert 0.225 < verdict.when_s < 0.2303
    assert not checks.settles(rec, "x", 100.0, 0.1, within=0.225).passed
    # An oscillation is inside the window for a moment each time it passes: short holds are met early.
    assert checks.settles(rec, "x", 100.0, 0.1, within=0.2, hold=0.0).passed
    assert not checks.settles(rec, "x", 100.0, 0.1, within=0.2, hold=0.05).passed
    assert checks.settles(rec, "x", 100.0, 0.1, within=0.1, start=0.15, hold=0.5).passed


def test_settling_needs_data_up_to_the_end_of_the_hold() -> None:
    verdict = checks.settles(decaying(), "x", 100.0, 0.1, within=1.0, hold=1.5)
    assert not verdict.passed
    assert "ends at 1.999 s" in verdict.sentence


def test_leaving_again_is_not_settling() -> None:
    curve = np.where(T < 0.5, 0.0, 100.0)
    curve[1500] += 0.2
    verdict = checks.settles(positions(x=curve), "x", 100.0, 0.1, within=0.6)
    failed(verdict, when=1.5, by=0.1, unit="mm")
    assert checks.settles(positions(x=curve), "x", 100.0, 0.1, within=0.6, hold=0.8).passed


@pytest.mark.parametrize("target", [1.0, 4.0, 16.0, 100.0, -200.0, 1e5])
@pytest.mark.parametrize("tolerance", [0.001, 0.01, 0.3])
def test_a_tolerance_holds_at_its_ends(target: float, tolerance: float) -> None:
    """PY-05: one increment beside its target an axis is within a tolerance of one increment, however numbers are
    rounded; a millionth beyond it is not."""
    for side in (1, -1):
        for beyond, within in ((0.0, True), (1e-6 * tolerance, False)):
            value = target + side * (tolerance + beyond)
            rec = positions(x=np.full(200, value), m=np.full(200, target))
            assert checks.reaches(rec, "x", target, tolerance=tolerance, by=0.1).passed == within
            assert checks.settles(rec, "x", target, tolerance, within=0.1).passed == within
            assert checks.in_sync(rec, "m", "x", tolerance=tolerance).passed == within
            nearer = positions(x=np.full(200, target + side * (tolerance - beyond)), m=np.full(200, target))
            assert checks.keeps_distance(nearer, "m", "x", tolerance).passed == within


# --- two components ---


# PY-05
@pytest.mark.parametrize("ratio", [2.0, -0.5])
def test_in_sync(ratio: float) -> None:
    master = 50 * np.sin(T)
    slave = ratio * master + 7.0
    slave[700] += 0.01
    rec = positions(m=master, s=slave)
    assert checks.in_sync(rec, "m", "s", ratio=ratio, offset=7.0, tolerance=0.01 + 1e-9).passed
    verdict = checks.in_sync(rec, "m", "s", ratio=ratio, offset=7.0, tolerance=0.01 - 1e-6)
    assert not verdict.passed
    assert verdict.when_s == pytest.approx(0.7)
    assert verdict.by_how_much == pytest.approx(1e-6, rel=1e-3)
    assert checks.in_sync(rec, "m", "s", ratio=ratio, offset=7.0, tolerance=1e-9, window=(0.8, 1.5)).passed
    assert checks.in_sync(rec, "m", "s", ratio=ratio, offset=None, tolerance=0.011).passed
    assert not checks.in_sync(rec, "m", "s", ratio=ratio, tolerance=6.9).passed


# PY-05: modulus-aware for rotary axes
@given(
    turns=st.floats(-5, 5),
    ratio=st.sampled_from([1.0, 0.5, -1.5, 1 / 3, 7.0]),
    offset=st.floats(-400, 400),
    start=st.floats(0, 359),
)
def test_in_sync_over_any_number_of_turns(turns: float, ratio: float, offset: float, start: float) -> None:
    master = start + 360 * turns * np.linspace(0, 1, 800)
    rec = positions("deg", {"m": 360.0, "s": 360.0}, m=master, s=ratio * master + offset)
    assert checks.in_sync(rec, "m", "s", ratio=ratio, offset=offset, tolerance=1e-6).passed
    assert not checks.in_sync(rec, "m", "s", ratio=ratio, offset=offset + 0.011, tolerance=0.01).passed


# PY-05
def test_keeps_distance() -> None:
    rec = positions(a=np.zeros(1000), b=10 + 5 * np.cos(2 * math.pi * np.arange(1000) / 1000))
    assert checks.keeps_distance(rec, "a", "b", 5.0).passed
    failed(checks.keeps_distance(rec, "b", "a", 5.0 + 1e-3), when=0.497, by=1e-3, unit="mm")


def test_keeps_distance_on_a_closed_track() -> None:
    rec = positions("mm", {"a": 1000.0, "b": 1000.0}, a=np.linspace(0, 990, 100), b=np.full(100, 5.0) + 995)
    assert not checks.keeps_distance(rec, "a", "b", 20.0, window=(0.05, 0.099)).passed
    assert checks.keeps_distance(rec, "a", "b", 10.0, window=(0.001, 0.099)).passed
    assert checks.keeps_distance(rec, "a", "b", 100.0, window=(0.03, 0.06)).passed


def test_keeps_distance_in_the_plane() -> None:
    t = np.arange(3) * DT
    rec = Recording(
        {
            "a": {"time_s": t, "x": [0, 0, 0], "y": [0, 0, 0]},
            "b": {"time_s": t, "x": [3, 3, 6], "y": [4, 4, 8]},
        }
    )
    assert checks.keeps_distance(rec, "a", "b", 5.0, signal=("x", "y")).passed
    assert not checks.keeps_distance(rec, "a", "b", 5.001, signal=("x", "y")).passed


def test_components_that_were_never_sampled_together() -> None:
    t = np.arange(0, 10, 2)
    rec = Recording(
        {
            "a": {"time_s": t * DT, "cycle": t, "actual_position": t * 1.0},
            "b": {"time_s": (t + 1) * DT, "cycle": t + 1, "actual_position": t * 1.0},
        }
    )
    assert "no cycle in common" in checks.keeps_distance(rec, "a", "b", 0.0).sentence
    assert "no cycle in common" in checks.in_sync(rec, "a", "b", tolerance=1.0, signal="actual_position").sentence
    assert not checks.never_both(rec, "a.actual_position > 100", "b.actual_position > 100").passed


def test_components_that_were_seldom_sampled_together() -> None:
    """PY-05: cycles of which neither is a multiple of the other's prove little; single losses do not matter."""

    def line(cycles: np.typing.NDArray[np.int64]) -> dict[str, np.typing.NDArray[Any]]:
        return {"time_s": cycles * DT, "cycle": cycles, "set_position": 3.0 * cycles}

    rec = Recording({"a": line(np.arange(0, 1000, 10)), "b": line(np.arange(0, 1000, 25))})
    sentence = "a and b have only 20 of 40 cycles in common: publish both at one rate"
    assert checks.in_sync(rec, "a", "b", tolerance=1.0).sentence.startswith(sentence)
    assert not checks.never_both(rec, "a.set_position < -1", "b.set_position < -1").passed
    rec = Recording({"a": line(np.delete(np.arange(0, 1000, 10), 7)), "b": line(np.arange(0, 1000, 10))})
    assert checks.in_sync(rec, "a", "b", tolerance=1e-9).passed


def test_different_rates_are_compared_where_both_are() -> None:
    t = np.arange(1000)
    line = 3.0 * t
    rec = Recording(
        {
            "m": {"time_s": t * DT, "cycle": t, "set_position": line},
            "s": {"time_s": t[::7] * DT, "cycle": t[::7], "set_position": line[::7]},
        }
    )
    assert checks.in_sync(rec, "m", "s", tolerance=1e-9).passed
