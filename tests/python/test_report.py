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

import lcm
import numpy as np
import pytest
import takt
from machines import MACHINE, new_url, running
from matplotlib.image import imread
from motion_curves import DT, one_axis, positions
from takt import checks, report
from takt.cli import main
from takt.events import SYNC
from takt.recording import Recording
from takt.report import writing


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
    assert data["meta"] == {"engine": {"overruns": 0}, "nan": None, "lost samples": "none"}
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


def test_the_summary_knows_movers() -> None:
    """As axes: how fast, how hard and how far beside, of X and Y together."""
    still = np.zeros(3)
    columns = {
        **{"x": [0.0, 3.0, 6.0], "y": [0.0, 4.0, 8.0], "z": still},
        **{"actual_x": [0.0, 2.7, 6.0], "actual_y": [0.0, 3.6, 8.0], "actual_z": still},
        **{"velocity_x": [0.0, 3.0, -30.0], "velocity_y": [0.0, 4.0, 40.0]},
        **{"acceleration_x": [0.0, 600.0, 0.0], "acceleration_y": [0.0, -800.0, 0.0]},
    }
    units = {"actual_x": "mm", "velocity_x": "mm/s", "acceleration_x": "mm/s²"}
    rec = Recording({"one": {"time_s": np.arange(3) * DT, **columns}}, {"one": units})
    data, _ = payload(report.render(rec, [], "t"))
    (row,) = data["summary"]["rows"]
    told = dict(zip(data["summary"]["head"], row, strict=True))
    assert told["max. velocity"] == "50 mm/s"
    assert told["max. acceleration"] == "1000 mm/s²"
    assert told["max. following error"] == "0.5 mm"


# --- what is kept of a run ---

SCENARIO = '''"""Goes there."""
from takt import expect

def scenario(session):
    x = session.axis("x")
    x.power().wait()
    session.mark("now")
    x.move_absolute(position=60.0, velocity=300.0).wait()
    session.run(0.1)

def verify(recording):
    expect.reaches(recording, "x", 60.0, tolerance=0.05, by=1.5)
    expect.within_limits(recording, "x", velocity=250)
    assert recording["x"]["actual_position"][-1] < 50, "it went too far"

def pictures(recording):
    from matplotlib.figure import Figure
    figure = Figure()
    figure.add_subplot().plot(recording["x"]["time_s"], recording["x"]["set_position"])
    return {"x over time": figure}
'''
PASSES = SCENARIO.replace("velocity=250", "velocity=301").replace("< 50", "< 61")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("machine.yaml").write_text(MACHINE)
    Path("fails.py").write_text(SCENARIO)
    Path("passes.py").write_text(PASSES)
    return tmp_path


def test_figures_of_the_engine_are_said_in_words(here: Path) -> None:
    """Of a log, whose last message of the engine has them."""
    url = new_url()
    with running(here, url, "--log", "run.log"), takt.connect(url) as session:
        session.axis("x").power().wait()
        session.run(0.3)  # the next figures count it
    assert main(["report", "run.log"]) == 0
    data, _ = payload(Path("run.html").read_text())
    assert data["meta"]["cycle"] == "1 ms"
    last = takt.read_log("run.log").meta["engine"]
    rows = data["meta"]["engine"]
    assert rows["cycles"] == f"{last['cycle']:,}"
    assert rows["commands"] == "1 applied, 0 refused by a full queue"
    assert rows["dropped"] == "0 states, 0 feedbacks"
    assert set(rows) <= {"cycles", "overruns", "execution of a cycle", "wake-up latency", "commands", "dropped"}


def test_counts_of_the_engine_that_should_be_0_are_said_where_they_are_not() -> None:
    figures = takt.Engine(MACHINE).figures
    times = {"count": 2, "max": 3000, "buckets": [0] * 11 + [2] + [0] * 20}
    figures |= {"overruns": 1234, "snapshots_dropped": 1, "journal_dropped": 3, "latency": times}
    data, _ = payload(report.render(one_axis(), [], "t", {"engine": figures, "mine": {"a_b": 1}}))
    assert data["meta"] == {
        "engine": {
            "cycles": "0",
            "overruns": "1,234",
            "wake-up latency": "median 3 µs, 99 % below 3 µs, longest 3 µs",
            "commands": "0 applied, 0 refused by a full queue",
            "dropped": "1 state, 0 feedbacks",
            "journal entries dropped": "3",
        },
        "mine": {"a_b": 1},
        "lost samples": "none",
    }


def test_what_was_judged_without_samples_says_so(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Which are missing and where: in the page, on the terminal, and in every verdict that had to do without them."""
    assert main(["run", "passes.py", "--report", "whole"]) == 0
    assert "2 passed, 0 failed" in (said := capsys.readouterr().out)
    assert "s of engine time, no sample missing" in said
    data, _ = payload(Path("whole/report.html").read_text())
    assert (data["meta"]["lost samples"], data["trouble"]) == ("none", "")

    whole = takt.Recording.load("whole/recording.npz")
    first = whole["x"]["cycle"][0]
    losses = {"takt/axis/x": 1234, "takt/engine": 1}
    holed = Recording(
        {"x": np.delete(whole["x"], [50, 51, 200]), "r": whole["r"]},
        info={"x": whole.info("x")},
        names={"x": {"state": whole.names("x", "state")}},
        meta={"losses": losses},
    )
    holed.save("holed.npz")
    lacks = f"3 samples of x in 2 gaps, the first after {(first + 49) / 1000:g} s"
    assert main(["report", "holed.npz", "--scenario", "passes.py"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert f"s of engine time; missing: {lacks} Samples are missing: {lacks}. report:" in said
    data, _ = payload(Path("holed.html").read_text())
    assert data["trouble"] == f"Samples are missing: {lacks}."
    assert "lost samples" not in data["meta"]
    assert data["meta"]["messages lost on the way, of"] == {"x": "1,234", "engine": "1"}
    assert [v["sentence"].endswith(f"; missing: {lacks}") for v in data["verdicts"]] == [True, True]


@pytest.mark.parametrize(("scenario", "code"), [("fails.py", 1), ("passes.py", 0)])
def test_a_report_made_later_is_the_one_made_at_once(scenario: str, code: int, here: Path) -> None:
    """Verdicts, figures, pictures and the machine are kept in the recording: nothing else is asked."""
    assert main(["run", scenario, "--report", "out"]) == code
    at_once = Path("out/report.html").read_bytes()
    Path(scenario).unlink()
    assert main(["report", "out", "-o", "later.html"]) == 0
    assert Path("later.html").read_bytes() == at_once
    Path("moved.npz").write_bytes(Path("out/recording.npz").read_bytes())
    assert main(["report", "moved.npz"]) == 0
    assert Path("moved.html").read_bytes() == at_once
    data, page = payload(at_once.decode())
    assert data["title"] == "Goes there"
    assert data["meta"]["engine"]["commands"] == "2 applied, 0 refused by a full queue"
    found = [(v["title"], v["passed"]) for v in data["verdicts"]]
    failing_first = [("within_limits(x)", False), ("reaches(x)", True)]
    assert found == (failing_first if code else [("reaches(x)", True), ("within_limits(x)", True)])
    assert data["complaint"] == ("it went too far (fails.py:14)" if code else "")
    pictures = [load for load in page.loads if load.startswith("data:image/png;base64,")]
    assert len(pictures) == (0 if code else 1)
    assert (b"<h2>x over time</h2>" in at_once) == (code == 0)


@pytest.mark.parametrize(
    ("line", "components", "quantities"),
    [
        ("assert axis.set_position > 1000, 'too near'", ["x"], ["position"]),
        ("assert session.axis('x').state == 'Nothing', 'too near'", ["x"], ["x.state"]),
        ("assert x.in_position > 1000, 'too near'", ["x"], ["x.in_position"]),
        ("assert x is None, 'too near'", ["x"], ["position", "velocity", "acceleration", "following error", "x.state"]),
        ("assert session.now < 0, 'too near'", [], []),
    ],
)
def test_a_plain_assertion_says_when_and_shows_what_it_names(
    line: str, components: list[str], quantities: list[str], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where a component is named its curves, of the fields that are named or the usual ones; always the time."""
    broken = SCENARIO.replace("    session.run(0.1)", f"    axis = x\n    {line}\n    session.run(0.1)")
    Path("broken.py").write_text(broken)
    assert main(["run", "broken.py", "--report", "out"]) == 1
    when = takt.Recording.load("out/recording.npz").end_s
    data, page = payload(Path("out/report.html").read_text())
    assertion = data["assertion"]
    (said,) = re.findall(r"too near \(broken.py:10\) at ([\d.]+) s", assertion["sentence"])
    assert float(said) == pytest.approx(when, abs=0.0015)
    assert "too near (broken.py:10) at" in " ".join(capsys.readouterr().out.split())
    assert assertion["components"] == components
    assert assertion["place"] == [pytest.approx(when, abs=0.0015)] * 2
    assert assertion["view"][0] < assertion["place"][0] <= assertion["view"][1] + 0.0015
    assert [lane["quantity"] for lane in assertion["lanes"]] == quantities
    if line.startswith("assert axis"):
        (trace,) = assertion["lanes"][0]["traces"]
        assert trace["label"] == "x.set_position"
        values = decoded(trace["values"], trace["time"]["n"], page)
        assert values[-1] == pytest.approx(60)


def test_a_plain_assertion_on_the_recording_shows_what_it_names(here: Path) -> None:
    assert main(["run", "fails.py", "--report", "out"]) == 1
    data, _ = payload(Path("out/report.html").read_text())
    assertion = data["assertion"]
    assert (assertion["sentence"], assertion["place"]) == ("it went too far (fails.py:14)", None)
    assert [trace["label"] for lane in assertion["lanes"] for trace in lane["traces"]] == ["x.actual_position"]


def test_the_failing_verdict_has_its_curve_and_limit(here: Path) -> None:
    main(["run", "fails.py", "--report", "out"])
    recording = takt.Recording.load("out/recording.npz")
    data, page = payload(Path("out/report.html").read_text())
    verdict = data["verdicts"][0]
    over = np.flatnonzero(recording["x"]["set_velocity"] > 250)
    times = recording["x"]["time_s"][over]
    assert verdict["place"] == [pytest.approx(times[0]), pytest.approx(times[-1])]
    assert verdict["view"][0] < verdict["place"][0] < verdict["place"][1] < verdict["view"][1]
    (lane,) = (lane for lane in verdict["lanes"] if lane["quantity"] == "velocity")
    assert lane["unit"] == "mm/s"
    (trace,) = lane["traces"]
    n = trace["time"]["n"]
    np.testing.assert_allclose(decoded(trace["values"], n, page), recording["x"]["set_velocity"], atol=1e-3)
    limits = {bound["forbidden"]: bound["values"]["constant"] for bound in lane["bounds"]}
    assert limits == {"above": 250.0, "below": -250.0}


def test_curves_of_verdicts_stay_small_and_keep_what_matters() -> None:
    """100 s at 1 kHz: all samples at the place, elsewhere what can be seen; the greatest value is never lost."""
    n = 100_000
    time_s = np.arange(n) * DT
    values = np.sin(time_s)
    values[73_210] = 9.0
    values[50_000:50_040] = 5.0
    rec = Recording({"x": {"time_s": time_s, "p": values}})
    kept = report.keep(rec, "t", [checks.stays(rec, "x.p < 4")]).meta["run"]["verdicts"][0]
    (trace,) = kept["lanes"][0]["traces"]
    assert len(trace["time_s"]) < 12_000
    assert trace["values"].max() == 9.0
    inside = (time_s >= kept["view"][0]) & (time_s <= kept["view"][1])
    at = (trace["time_s"] >= kept["view"][0]) & (trace["time_s"] <= kept["view"][1])
    np.testing.assert_array_equal(trace["values"][at], values[inside])


def test_a_run_that_nobody_judged_is_judged_later(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with takt.Engine("machine.yaml") as engine, engine.record() as recorder:
        engine.axis("x").power().wait()
        engine.axis("x").move_absolute(position=60.0, velocity=300.0).wait()
    recorder.recording.save("plain.npz")
    assert main(["report", "plain.npz"]) == 0
    data, _ = payload(Path("plain.html").read_text())
    assert (data["title"], data["verdicts"], data["complaint"]) == ("plain.npz", [], "")
    capsys.readouterr()
    assert main(["report", "plain.npz", "--scenario", "passes.py"]) == 0
    assert "2 passed, 0 failed" in capsys.readouterr().out
    data, page = payload(Path("plain.html").read_text())
    assert [v["passed"] for v in data["verdicts"]] == [True, True]
    assert page.loads[0].startswith("data:image/png;base64,")
    assert main(["report", "plain.npz", "--scenario", "fails.py", "-o", "again.html"]) == 1
    data, _ = payload(Path("again.html").read_text())
    assert [v["passed"] for v in data["verdicts"]] == [False, True]


def test_a_log_that_ends_in_the_middle_of_a_message(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What is whole is shown, and what is not is said."""
    url = new_url()
    with running(here, url, "--log", "whole.log"), takt.connect(url) as session:
        session.axis("x").power().wait()
        session.axis("x").move_absolute(position=20.0).wait()
    data = Path("whole.log").read_bytes()
    inside = data.rfind(SYNC, 0, len(data) * 2 // 3) + 20  # bytes, of which no event is made
    Path("torn.log").write_bytes(data[:inside])
    for name in ("whole", "torn"):
        capsys.readouterr()
        assert main(["report", f"{name}.log"]) == 0
        said = capsys.readouterr().out
        shown, _ = payload(Path(f"{name}.html").read_text())
        assert shown["trouble"] in said
        assert ("ends in the middle of a message" in shown["trouble"]) == (name == "torn")
        assert [c["name"] for c in shown["components"]] == ["x", "r"]
    whole, torn = takt.read_log("whole.log"), takt.read_log("torn.log")
    assert 0 < len(torn["x"]) < len(whole["x"])
    np.testing.assert_array_equal(torn["x"], whole["x"][: len(torn["x"])])


def test_a_log_of_two_starts_says_which_one_is_shown(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, place in (("first", 20.0), ("second", 30.0)):
        url = new_url()
        with running(here, url, "--log", f"{name}.log"), takt.connect(url) as session:
            session.axis("x").power().wait()
            session.axis("x").move_absolute(position=place).wait()
    Path("both.log").write_bytes(Path("first.log").read_bytes() + Path("second.log").read_bytes())

    def last_place(*arguments: str) -> tuple[float, str, str]:
        """What is shown, what the terminal says, and what the page does."""
        capsys.readouterr()
        assert main(["report", "both.log", *arguments]) == 0
        data, page = payload(Path("both.html").read_text())
        (x,) = (c for c in data["components"] if c["name"] == "x")
        (field,) = (f for f in x["fields"] if f["name"] == "set_position")
        values = decoded(field, data["bases"][x["base"]]["n"], page)
        return float(values[-1]), capsys.readouterr().out, data["trouble"]

    said = "The log holds 2 starts of the engine, from 0 on: this is number {}; --run chooses another."
    for arguments, place, number in (((), 30, 1), (("--run", "0"), 20, 0), (("--run", "1"), 30, 1)):
        shown, terminal, page = last_place(*arguments)
        assert shown == pytest.approx(place)
        assert said.format(number) in terminal
        assert said.format(number) in page
    assert main(["report", "first.log"]) == 0
    assert "starts of the engine" not in capsys.readouterr().out

    # The other commands choose likewise.
    assert main(["log", "both.log", "--run", "0", "--save", "a.npz"]) == 0
    assert takt.Recording.load("a.npz")["x"]["set_position"][-1] == pytest.approx(20)
    assert main(["export", "both.log", "x.set_position", "--csv", "a.csv", "--run", "0"]) == 0
    assert float(Path("a.csv").read_text().splitlines()[-1].split(",")[2]) == pytest.approx(20)
    assert main(["plot", "both.log", "x", "--run", "0", "-o", "a.png"]) == 0
    assert capsys.readouterr().out.count(said.format(0)) == 3


BAD = {
    "no such start": (
        ["strange.log", "--run", "1"],
        "strange.log: holds 1 run; there is no run 1: they are counted from 0",
    ),
    "a start from the end": (["strange.log", "--run", "-1"], "there is no run -1: they are counted from 0"),
    "one start": (["good.npz", "--run", "0"], "good.npz: is a recording, which holds one run: there is none to choose"),
    "nothing there": (["none.npz"], "none.npz: No such file or directory"),
    "another file": (["fails.py"], "fails.py: is neither a recording (.npz) nor an LCM log"),
    "no run": (["empty"], "empty: holds no run: expected recording.npz in it"),
    "cut off": (["cut.npz"], "cut.npz is not a recording"),
    "where": (["good.npz", "-o", "nowhere/a.html"], "nowhere/a.html: there is no directory nowhere"),
    "onto a directory": (["good.npz", "-o", "taken.html"], "taken.html: Is a directory"),
    "what": (["good.npz", "-o", "a.txt"], "a.txt: expected a name that ends in .html"),
    "no scenario": (["good.npz", "--scenario", "none.py"], "none.py: there is no such file"),
    "no machine": (["strange.log"], "strange.log: holds no description of a machine"),
}


@pytest.mark.parametrize("case", BAD)
def test_mistakes_are_one_line(case: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one_axis().save("good.npz")
    data = Path("good.npz").read_bytes()
    Path("cut.npz").write_bytes(data[: len(data) // 2])
    Path("empty").mkdir()
    Path("taken.html").mkdir()
    log = lcm.EventLog("strange.log", "w", overwrite=True)
    log.write_event(1, "nothing", b"")
    log.close()
    arguments, sentence = BAD[case]
    assert main(["report", *arguments]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert sentence in said


def test_too_long_runs_are_thinned_but_not_where_they_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    rec = one_axis(lag=0.002)
    verdict = checks.within_limits(rec, "x", velocity=199.0)
    size = sum(rec["x"][f].nbytes for f in rec.fields("x")[2:])
    monkeypatch.setattr(writing, "BYTES", size // 10)
    data, page = payload(report.render(rec, [verdict], "t"))
    every = int(re.findall(r"one sample of (\d+) is shown", data["thinned"])[0])
    assert every > 2
    assert f"{1 / DT / every:.3g} a second" in data["thinned"]
    times = decoded(data["bases"][0], data["bases"][0]["n"], page)
    recorded = rec["x"]["time_s"]
    view = data["verdicts"][0]["view"]
    inside = recorded[(recorded >= view[0]) & (recorded <= view[1])]
    np.testing.assert_array_equal(times[(times >= view[0]) & (times <= view[1])], inside)
    assert set(recorded[::every]) < set(times) < set(recorded)
    assert len(times) < len(inside) + len(recorded) / every + 2
    assert data["summary"]["rows"][0][1] == str(len(rec["x"]))  # of all samples
