"""PY-04, PY-05: pictures and the report made from a recording."""

from __future__ import annotations

import base64
import json
import math
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread
from motion_curves import DT, one_axis, positions
from takt import checks, plot, report
from takt.recording import Recording, RecordingError


def pixels(path: Path) -> Any:
    image = imread(path)
    assert image.shape[1] == 1400
    return image


def colours_of(figure: Any) -> int:
    """How many different colours the picture has: an empty one has one."""
    figure.canvas.draw()
    rgba = np.ascontiguousarray(figure.canvas.buffer_rgba())
    return len(np.unique(rgba.view(np.uint32)))


# --- plots ---


def test_usual_signals_in_lanes_with_units(tmp_path: Path) -> None:
    figure = plot.draw(one_axis(lag=0.002), title="a move")
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels == [
        "",
        "position\n[mm]",
        "velocity\n[mm/s]",
        "acceleration\n[mm/s²]",
        "following error\n[mm]",
        "",
    ]
    styles = {line.get_label(): line.get_linestyle() for line in figure.axes[1].get_lines()}
    assert styles["set position"] == "--"
    assert styles["actual position"] == "-"
    assert figure.axes[-1].get_xlabel() == "time [s]"
    texts = [t.get_text() for t in figure.axes[0].texts]
    assert texts == ["x: MoveAbsolute 100", "x: done"]
    assert [t.get_text() for t in figure.axes[-1].texts] == ["DiscreteMotion", "Standstill"]
    pixels(plot.save(figure, tmp_path / "new" / "a.png"))


def test_signals_of_one_component_can_be_told_apart() -> None:
    """X, Y and Z of a tool share a lane; set points have the colour of what is measured, darker."""
    columns = {name: np.arange(5.0) for name in ("time_s", "x", "y", "z", "actual_x")}
    figure = plot.draw(Recording({"robot": columns}), "robot.*")
    looks = {line.get_label(): line.get_color() for ax in figure.axes for line in ax.get_lines()}
    assert len({looks["x"], looks["y"], looks["z"]}) == 3
    assert looks["actual x"] == looks["x"]


def test_signals_by_pattern() -> None:
    rec = positions(x=np.arange(5.0), y=np.arange(5.0))
    assert plot.select(rec, ["*.set_position"]) == [("x", "set_position"), ("y", "set_position")]
    assert plot.select(rec, ["y"]) == [("y", "set_position"), ("y", "actual_position")]
    assert plot.select(rec, ["x.a*", "x.a*"]) == [("x", "actual_position")]
    with pytest.raises(RecordingError, match=r"no signal matches 'z\.\*' \(the recording has the components x, y\)"):
        plot.draw(rec, "z.*")


def test_lanes_of_different_units_are_apart() -> None:
    t = np.arange(10) * DT
    rec = Recording(
        {"x": {"time_s": t, "set_position": t}, "a": {"time_s": t, "set_position": t}},
        {"x": {"set_position": "mm"}, "a": {"set_position": "deg"}},
    )
    assert [ax.get_ylabel() for ax in plot.draw(rec).axes] == ["position\n[mm]", "position\n[deg]"]


def test_a_wrap_is_not_drawn_as_a_line() -> None:
    time_s, values = plot.unjoined(np.arange(4.0), np.array([350.0, 359.0, 2.0, 9.0]), 360.0)
    assert time_s.tolist() == [0, 1, 2, 2, 3]
    assert math.isnan(values[2])
    assert values[[0, 1, 3, 4]].tolist() == [350, 359, 2, 9]


@pytest.mark.parametrize(
    "values",
    [[], [1.0], [math.nan] * 5, [0.0, math.inf, 1.0], [1e300, -1e300], [5.0] * 9],
    ids=lambda v: str(v)[:14],
)
def test_odd_data_can_be_drawn(values: list[float]) -> None:
    rec = Recording({"x": {"time_s": np.arange(len(values)) * DT, "set_position": values, "on": [True] * len(values)}})
    plot.draw(rec).canvas.draw()
    plot.draw_verdict(checks.stays(rec, "x.set_position < 3")).canvas.draw()
    report.render(rec, [checks.stays(rec, "x.set_position < 3")], "odd")


# PY-05: the picture shows the violated bound and the place
def test_the_picture_of_a_verdict_shows_bound_and_place(tmp_path: Path) -> None:
    verdict = checks.within_limits(one_axis(), "x", velocity=199.0)
    figure = plot.draw_verdict(verdict)
    whole, zoomed = figure.axes
    assert [line.get_label() for line in whole.get_lines()][:2] == ["x.set_velocity", "limit ±199 mm/s"]
    assert verdict.place is not None
    left, right = zoomed.get_xlim()
    assert left < verdict.place[0] < verdict.place[1] < right
    assert right - left < whole.get_xlim()[1] - whole.get_xlim()[0]
    assert any("x left its velocity limit of 199 mm/s by 1 mm/s" in t.get_text() for t in figure.texts)
    pixels(plot.save(figure, tmp_path / "v.png"))


def test_every_kind_of_verdict_can_be_drawn() -> None:
    rec = one_axis(lag=0.002)
    verdicts = [
        checks.within_limits(rec, "x", jerk=1.0),
        checks.continuous(rec, "x", acceleration=1.0),
        checks.reaches(rec, "x", 50.0, tolerance=0.1, by=0.1),
        checks.settles(rec, "x", 50.0, 0.1, within=0.1),
        checks.in_sync(rec, "x", "x", tolerance=0.1, master_signal="actual_position"),
        checks.keeps_distance(rec, "x", "x", 1.0),
        checks.never_both(rec, "x.state == DiscreteMotion", "x.set_velocity > 100"),
        checks.stays(rec, "x.in_position"),
        checks.visits_states(rec, "x", ["ErrorStop"]),
        checks.complete(Recording({"x": np.delete(rec["x"], [7])}), "x"),
    ]
    for verdict in verdicts:
        assert not verdict.passed
        assert colours_of(plot.draw_verdict(verdict)) > 50, verdict.title


# --- report ---


class Page(HTMLParser):
    """Collects what a page would load from elsewhere, and its data."""

    def __init__(self) -> None:
        super().__init__()
        self.loads: list[str] = []
        self.data = ""
        self._in_data = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        self.loads += [v for k, v in found.items() if k in ("src", "href") and v]
        self._in_data = found.get("id") == "data"

    def handle_data(self, data: str) -> None:
        if self._in_data:
            self.data += data

    def handle_endtag(self, tag: str) -> None:
        self._in_data = False


def payload(text: str) -> tuple[dict[str, Any], Page]:
    page = Page()
    page.feed(text)
    found: dict[str, Any] = json.loads(page.data)
    return found, page


def decoded(field: dict[str, Any], n: int) -> Any:
    if "constant" in field:
        return np.full(n, math.nan if field["constant"] is None else field["constant"])
    kind = next(k for k in ("i8", "f32", "f64") if k in field)
    return np.frombuffer(base64.b64decode(field[kind]), {"i8": "i1", "f32": "<f4", "f64": "<f8"}[kind])


def test_the_report_needs_nothing_else(tmp_path: Path) -> None:
    rec = one_axis(lag=0.002)
    verdicts = [checks.within_limits(rec, "x"), checks.within_limits(rec, "x", velocity=199.0)]
    made = report.write_report(
        rec, verdicts, tmp_path / "out", "A <move> & more", {"engine": {"overruns": 0}, "nan": math.nan}
    )
    text = made.html.read_text(encoding="utf-8")
    data, page = payload(text)
    assert page.loads == []
    assert not re.search(r"""(url\(|@import|fetch\(|import\(|https?://[^\s"']+\.(js|css))""", text)
    assert "<title>A &lt;move&gt; &amp; more</title>" in text
    assert data["title"] == "A <move> & more"
    assert data["meta"] == {"engine": {"overruns": 0}, "nan": None}
    assert [v["passed"] for v in data["verdicts"]] == [False, True]
    assert {p.name for p in made.pictures} == {"x.png", "failed_1_within_limits_x.png"}
    for picture in made.pictures:
        pixels(picture)


def test_the_page_holds_the_data_as_recorded() -> None:
    rec = one_axis(lag=0.002)
    data, _ = payload(report.render(rec, [], "t"))
    (component,) = data["components"]
    base = data["bases"][component["base"]]
    np.testing.assert_allclose(np.linspace(base["from"], base["to"], base["n"]), rec["x"]["time_s"], atol=1e-9)
    for field, original in zip(component["fields"], rec.fields("x")[2:], strict=True):
        column = rec["x"][original].astype(float)
        np.testing.assert_allclose(decoded(field, base["n"]), column, rtol=0, atol=1e-6 * max(np.ptp(column), 1e-30))


@pytest.mark.parametrize(
    ("column", "kind"),
    [
        (np.linspace(0, 500, 100), "f32"),
        (1e4 + np.linspace(0, 1, 100), "f64"),
        (np.full(100, 3.25), "constant"),
        (np.full(100, math.nan), "constant"),
        (np.array([0.0, math.nan, 1.0]), "f32"),
        (np.array([0.0, 1e300]), "f64"),
        (np.array([True, False]), "i8"),
    ],
)
def test_columns_are_as_small_as_they_may_be(column: Any, kind: str) -> None:
    rec = Recording({"x": {"time_s": np.arange(len(column)), "p": column}})
    data, _ = payload(report.render(rec, [], "t"))
    field = data["components"][0]["fields"][0]
    assert kind in field
    good = column[np.isfinite(column)].astype(float)
    spread = float(np.ptp(good)) if len(good) else 0.0
    np.testing.assert_allclose(
        decoded(field, len(column)).astype(float), column.astype(float), rtol=0, atol=1e-6 * spread
    )


def test_text_from_outside_cannot_break_the_page() -> None:
    nasty = "</script><script>alert(1)</script><!-- {{data}}"
    rec = Recording(
        {nasty: {"time_s": [0.0, 1.0], nasty: [1.0, 2.0]}},
        {nasty: {nasty: nasty}},
        events=[(0.5, nasty, nasty)],
    )
    text = report.render(rec, [], nasty, {nasty: nasty})
    plain = report.render(Recording({"x": {"time_s": [0.0, 1.0]}}), [], "x")
    assert text.count("<script") == plain.count("<script")
    assert text.count("</script>") == plain.count("</script>")
    data, _ = payload(text)
    assert data["components"][0]["name"] == nasty


def test_uneven_time_is_kept_exactly() -> None:
    time_s = np.array([0.0, 0.001, 0.004, 0.0041])
    data, _ = payload(report.render(Recording({"x": {"time_s": time_s, "p": time_s}}), [], "t"))
    assert decoded(data["bases"][0], 4).tolist() == time_s.tolist()


def test_components_on_one_time_base_share_it() -> None:
    data, _ = payload(report.render(positions(a=np.arange(50.0), b=np.arange(50.0), c=np.arange(20.0)), [], "t"))
    assert [c["base"] for c in data["components"]] == [0, 0, 1]


def test_size_of_a_report_of_50_signals() -> None:
    """10 s at 1 kHz of noise, which nothing makes smaller: 50 columns of 32 bits, and little else."""
    rng = np.random.default_rng(1)
    n = 10_000
    columns = {f"s{i}": rng.normal(size=n) for i in range(50)}
    text = report.render(Recording({"x": {"time_s": np.arange(n) * DT, **columns}}), [], "t")
    assert len(text.encode()) < 2.7 * 2**20


def test_an_empty_recording_makes_a_report(tmp_path: Path) -> None:
    made = report.write_report(Recording({}), [], tmp_path, "nothing")
    assert made.pictures == ()
    data, _ = payload(made.html.read_text(encoding="utf-8"))
    assert data["components"] == []
    report.write_report(Recording({"x": {"time_s": [], "p": []}}), [], tmp_path, "no samples")


def test_the_library_inside_says_whose_it_is() -> None:
    folder = Path(report.__file__).parent / "assets" / "uplot"
    assert "MIT" in (folder / "LICENSE").read_text()
    version = re.search(r"uPlot (\d+\.\d+\.\d+)", (folder / "README.md").read_text())
    assert version is not None
    assert f"(v{version[1]})" in (folder / "uPlot.iife.min.js").read_text(encoding="utf-8")[:200]
