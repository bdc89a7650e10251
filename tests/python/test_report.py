"""PY-05: the report made from a recording, and what is kept of a run to make it again."""

from __future__ import annotations

import base64
import json
import math
import re
import zlib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread
from motion_curves import DT, one_axis, positions
from takt import checks, report
from takt.recording import Recording


def pixels(path: Path) -> None:
    assert imread(path).shape[1] == 1400


class Page(HTMLParser):
    """Collects what a page would load from elsewhere, and its data."""

    def __init__(self) -> None:
        super().__init__()
        self.loads: list[str] = []
        self.texts: dict[str, str] = {}
        self._inside = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        self.loads += [v for k, v in found.items() if k in ("src", "href") and v]
        self._inside = found.get("id") or ""

    def handle_data(self, data: str) -> None:
        if self._inside in ("data", "columns"):
            self.texts[self._inside] = self.texts.get(self._inside, "") + data

    def handle_endtag(self, tag: str) -> None:
        self._inside = ""


def payload(text: str) -> tuple[dict[str, Any], Page]:
    page = Page()
    page.feed(text)
    found: dict[str, Any] = json.loads(page.texts["data"])
    return found, page


def decoded(field: dict[str, Any], n: int, page: Page) -> Any:
    if "constant" in field:
        return np.full(n, math.nan if field["constant"] is None else field["constant"])
    kind = next(k for k in ("i8", "f32", "f64") if k in field)
    at, count = field[kind]
    width = {"i8": 1, "f32": 4, "f64": 8}[kind]
    data = zlib.decompress(base64.b64decode(page.texts["columns"]))
    numbers = [data[at + i : at + width * count : count] for i in range(count)]  # the bytes of each, the lowest first
    return np.frombuffer(b"".join(numbers), {"i8": "i1", "f32": "<f4", "f64": "<f8"}[kind])


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
    data, page = payload(report.render(rec, [], "t"))
    (component,) = data["components"]
    base = data["bases"][component["base"]]
    np.testing.assert_allclose(np.linspace(base["from"], base["to"], base["n"]), rec["x"]["time_s"], atol=1e-9)
    for field, original in zip(component["fields"], rec.fields("x")[2:], strict=True):
        column = rec["x"][original].astype(float)
        np.testing.assert_allclose(
            decoded(field, base["n"], page), column, rtol=0, atol=1e-6 * max(np.ptp(column), 1e-30)
        )


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
    data, page = payload(report.render(rec, [], "t"))
    field = data["components"][0]["fields"][0]
    assert kind in field
    good = column[np.isfinite(column)].astype(float)
    spread = float(np.ptp(good)) if len(good) else 0.0
    np.testing.assert_allclose(
        decoded(field, len(column), page).astype(float), column.astype(float), rtol=0, atol=1e-6 * spread
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
    data, page = payload(report.render(Recording({"x": {"time_s": time_s, "p": time_s}}), [], "t"))
    assert decoded(data["bases"][0], 4, page).tolist() == time_s.tolist()


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
    folder = Path(report.__file__).parent / "page" / "uplot"
    assert "MIT" in (folder / "LICENSE").read_text()
    version = re.search(r"uPlot (\d+\.\d+\.\d+)", (folder / "README.md").read_text())
    assert version is not None
    assert f"(v{version[1]})" in (folder / "uPlot.iife.min.js").read_text(encoding="utf-8")[:200]
