"""PY-26: two runs compared: figures, verdicts of both, units, lengths, cycles, signals of one only, and the page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from motion_curves import one_axis
from pages import PATIENCE_S, needs_chromium
from playwright.sync_api import Browser, expect
from takt import checks
from takt.cli import main
from takt.recording import Recording, RecordingError
from takt.report import compare, keep, render_comparison, write_comparison, write_report
from test_report_page import opened

MACHINE = "name: m\naxes: [{name: x, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}]\n"


def curve(values: Any, dt: float = 0.01, unit: str = "mm", start: float = 0.0, **more: Any) -> Recording:
    """One signal, x.position."""
    values = np.asarray(values, dtype=np.float64)
    time_s = start + dt * np.arange(len(values))
    columns = {"time_s": time_s, "cycle": np.arange(len(values)), "position": values}
    return Recording({"x": columns}, {"x": {"position": unit}}, **more)


def move(velocity: float, period: float | None = None) -> Recording:
    with takt.Engine(MACHINE, period=period) as engine, engine.record() as recorder:
        x = engine.axis("x")
        x.power().wait()
        engine.mark("off it goes")
        x.move_absolute(position=100, velocity=velocity).wait()
    return recorder.recording


def test_the_same_run_has_no_difference() -> None:
    comparison = compare(move(200), move(200))
    assert comparison.same
    assert len(comparison.signals) > 20
    assert comparison.sentence == f"no difference in {len(comparison.signals)} signals"


def test_a_difference_in_figures() -> None:
    a, b = np.zeros(101), np.zeros(101)
    b[30:] = 1e-12
    b[60] = -3.0
    (found,) = compare(curve(a), curve(b)).signals
    assert found.differs
    assert (found.largest, found.largest_s, found.first_s) == (3.0, pytest.approx(0.6), pytest.approx(0.3))
    assert found.rms == pytest.approx(3.0 / np.sqrt(101))
    assert found.share == pytest.approx(71 / 101)
    assert found.sentence == "x.position: differs from 0.3 s on, most by 3 mm at 0.6 s, rms 0.298511 mm"


def test_other_lengths_and_cycles() -> None:
    """At times that both span; between samples a line, and what it misses by is no difference."""
    fast, slow = move(200), move(200, period=0.002)
    comparison = compare(fast, slow, align="off it goes")
    found = {one.field: one for one in comparison.signals}
    position = found["set_position"]
    assert len(slow["x"]) - 20 < position.samples <= len(slow["x"])
    assert position.largest is not None
    assert 0 < position.largest < 0.5
    half = compare(curve(np.linspace(0, 100, 101)), curve(np.linspace(0, 50, 26), dt=0.02)).signals[0]
    assert (half.samples, half.differs, half.interpolated) == (26, False, False)
    between = compare(curve(np.linspace(0, 100, 101)), curve(np.linspace(0.5, 50.5, 26), dt=0.02, start=0.005)).signals[
        0
    ]
    assert (between.samples, between.differs, between.interpolated) == (26, False, True)


def test_samples_that_are_missing_are_not_compared() -> None:
    values = np.linspace(0, 100, 101) ** 2
    rows = np.r_[0:40, 60:101]
    columns = {"time_s": 0.01 * rows, "cycle": rows, "position": values[rows]}
    torn = Recording({"x": columns}, {"x": {"position": "mm"}})
    for pair in ((curve(values), torn), (torn, curve(values))):
        (found,) = compare(*pair).signals
        assert (found.samples, found.differs) == (len(rows), False)


def test_rotary_positions_go_the_short_way_round() -> None:
    info = {"x": {"modulus": 360.0}}
    a, b = curve([350, 359, 5], unit="deg", info=info), curve([351, 1, 6], unit="deg", info=info)
    (found,) = compare(a, b).signals
    assert found.largest == pytest.approx(2.0)


def test_samples_of_the_same_times_differ_unless_they_are_equal() -> None:
    """PY-26: rotary positions by the last bit, whole numbers beyond 2^53."""
    info = {"x": {"modulus": 360.0}}
    values = np.array([10.0, 1e-15, 359.0])
    for row in range(3):
        other = values.copy()
        other[row] = np.nextafter(other[row], 400.0)
        (found,) = compare(curve(values, unit="deg", info=info), curve(other, unit="deg", info=info)).signals
        assert (found.differs, found.first_s) == (True, pytest.approx(0.01 * row))
        assert found.largest == other[row] - values[row]
    counts = {"time_s": [0.0, 0.1], "cycle": [0, 1]}
    one, other = (Recording({"x": {**counts, "count": np.array([n, 5], np.uint64)}}) for n in (2**63, 2**63 + 1))
    assert compare(one, other).differing[0].first_s == 0.0
    assert compare(one, one).same


def test_numbers_that_one_run_has_not() -> None:
    (found,) = compare(curve([1, np.nan, 2, np.nan]), curve([1, np.nan, np.nan, np.nan])).signals
    assert (found.largest, found.first_s) == (0.0, pytest.approx(0.02))
    (none,) = compare(curve([np.nan] * 3), curve([np.nan] * 3)).signals
    assert not none.differs


def test_states_by_their_texts() -> None:
    def states(values: list[int], names: list[str]) -> Recording:
        return Recording({"x": {"time_s": [0.0, 1.0, 2.0], "state": values}}, names={"x": {"state": names}})

    same = compare(states([0, 1, 1], ["Off", "On"]), states([1, 0, 0], ["On", "Off"])).signals[0]
    assert not same.differs
    other = compare(states([0, 1, 1], ["Off", "On"]), states([0, 0, 1], ["Off", "On"])).signals[0]
    assert (other.largest, other.first_s, other.share) == (None, 1.0, pytest.approx(1 / 3))
    new = compare(states([0, 1, 1], ["Off", "On"]), states([0, 1, 1], ["Off", "Error"])).signals[0]
    assert new.first_s == 1.0


def test_what_cannot_be_compared_is_said() -> None:
    a = Recording(
        {"x": {"time_s": [0.0, 1.0], "p": [0.0, 1.0], "q": [0.0, 1.0]}, "y": {"time_s": [0.0]}}, {"x": {"p": "mm"}}
    )
    b = Recording({"x": {"time_s": [0.0, 1.0], "p": [0.0, 1.0], "r": [0.0, 1.0]}}, {"x": {"p": "deg"}})
    comparison = compare(a, b, ("one", "other"))
    assert comparison.only == (("x.q", "y"), ("x.r",))
    assert comparison.incomparable == ("x.p: [mm] in one but [deg] in other",)
    assert not comparison.same
    assert "only one has x.q, y; only other has x.r" in comparison.sentence


@pytest.mark.parametrize(
    ("a", "b", "align", "wrong"),
    [
        (curve([]), curve([1, 2]), "", "A holds no samples"),
        (
            curve([1, 2]),
            curve([1, 2], start=5.0),
            "",
            "no time in common: A from 0 s to 0.01 s and B from 5 s to 5.01 s",
        ),
        (curve([1]), curve([1]), "homed", r"A has no event 'homed' \(its marks are none\)"),
    ],
)
def test_runs_that_cannot_be_compared(a: Recording, b: Recording, align: str, wrong: str) -> None:
    with pytest.raises(RecordingError, match=wrong):
        compare(a, b, align=align)


def test_beginnings_are_laid_over_one_another() -> None:
    (found,) = compare(curve([1, 2, 3]), curve([1, 2, 3], start=5.0), align="start").signals
    assert (found.samples, found.differs) == (3, False)


def saved(folder: Path, name: str, limit: float, lag: float) -> Path:
    rec = one_axis(lag=lag)
    verdicts = [checks.within_limits(rec, "x", velocity=limit), checks.within_limits(rec, "x")]
    write_report(rec, verdicts, folder / name, name, {"engine": {"overruns": int(limit)}})
    return folder / name


def test_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before, after = saved(tmp_path, "before", 199.0, 0.002), saved(tmp_path, "after", 300.0, 0.004)
    assert main(["report", str(before), str(after)]) == 0
    page = tmp_path / "before_and_after.html"
    said = capsys.readouterr().out
    assert said.splitlines()[-1] == f"report: {page}"
    assert "x.actual_position: differs from" in said
    assert main(["report", str(before), str(before / "recording.npz"), "-o", str(tmp_path / "p.html")]) == 0
    assert "no difference in" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "wrong"),
    [
        (["before", "before", "before"], "one run, or two to compare: 3 are given"),
        (["before", "--align", "start"], "--align is for two runs"),
        (["before", "none"], "none: No such file"),
        (["before", "before", "--align", "never"], "has no event 'never'"),
        (["before", "before", "-o", "x.txt"], "expected a name that ends in .html"),
    ],
)
def test_bad_input(
    arguments: list[str],
    wrong: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    saved(tmp_path, "before", 300.0, 0.002)
    monkeypatch.chdir(tmp_path)
    assert main(["report", *arguments]) == 2
    assert wrong in capsys.readouterr().err


def test_the_page_is_the_same_again_and_needs_nothing() -> None:
    comparison = compare(move(200), move(250))
    text = render_comparison(comparison)
    assert text == render_comparison(comparison)
    assert "NaN" not in text.split('id="data">')[1].split("</script>")[0]


@needs_chromium
def test_the_page(tmp_path: Path, browser: Browser) -> None:
    expect.set_options(timeout=PATIENCE_S * 1000)
    runs = []
    for velocity, limit in ((200, 300), (250, 240)):
        rec = move(velocity)
        runs.append(keep(rec, "a run", [checks.within_limits(rec, "x", velocity=limit)]))
    file = write_comparison(compare(runs[0], runs[1], ("before", "after")), tmp_path / "page.html")
    with opened(browser, file) as page:
        expect(page.locator("h1")).to_have_text("before and after")
        expect(page.locator("#pill")).to_contain_text("signals differ")
        row = page.locator("#verdicts tbody tr").first
        expect(row.locator("td").nth(1)).to_contain_text("passed")
        expect(row.locator("td").nth(2)).to_contain_text("failed")
        expect(page.locator("#facts-table tr", has_text="length")).to_have_class("apart")
        page.locator("#differences button", has_text="x.set_velocity").click()
        group = page.locator(".pair", has=page.locator("strong", has_text="set velocity [mm/s]"))
        expect(group.locator("canvas")).to_have_count(2)
        outputs = [float(text) for text in group.locator("output").all_inner_texts()]
        assert outputs[1] - outputs[0] == pytest.approx(outputs[2], rel=1e-4)
        assert abs(outputs[2]) > 10
        before = page.locator(".pair:visible").count()
        page.locator("#all").click()
        assert page.locator(".pair:visible").count() > before
