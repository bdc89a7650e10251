"""PY-24: sweeps: what is varied, rows, workers, going on, bad input, the page."""

from __future__ import annotations

import csv
import json
import shlex
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import takt
from pages import PATIENCE_S, needs_chromium
from playwright.sync_api import Browser, expect
from takt.cli import main
from takt.scenario import load_scenario, run_scenario, settings_of, with_settings
from takt.sweep import Design, SweepError, sweep
from test_report_page import opened

MACHINE = """\
name: press
axes:
  - {name: ram, unit: mm, limits: {velocity: 400, acceleration: 8000, jerk: 800000}}
simulation:
  servos: [{axis: ram, mechanics: {inertia: 0.001}}]
"""
SCENARIO = '''\
"""The ram goes down."""
import os, signal, sys, time
from pathlib import Path
from takt import expect
EVERY = 4
count = 0
def scenario(session, velocity=100.0, mode="plain", once=""):
    global count
    count += 1
    print("not to be seen")
    ram = session.axis("ram")
    ram.power().wait()
    ram.move_absolute(position=20, velocity=velocity).wait()
    if mode == "dies" or (mode == "dies once" and not Path(once).exists()):
        Path(once or "none").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if mode == "exits":
        sys.exit(3)
    if mode == "hangs":
        time.sleep(60)
    if mode == "raises":
        raise ValueError(f"no\\nthing, \\"{velocity}\\"")
def verify(recording, most=300.0):
    expect.within_limits(recording, "ram", velocity=most)
    expect.stays(recording, "|ram.following_error| < 1")
def results(recording):
    return {"time": recording.duration_s, "fast": recording["ram"]["set_velocity"].max() > 200, "count": count}
'''


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    (tmp_path / "scenario.py").write_text(SCENARIO)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def rows(directory: str) -> list[dict[str, str]]:
    with Path(directory, "runs.csv").open(newline="") as file:
        return list(csv.DictReader(file))


# --- what is varied ---


def test_a_grid_has_both_ends() -> None:
    design = Design.of(["a=100:500:9", "b=x,2,true"], [])
    assert design.size == 27
    assert [design.point(i)["a"] for i in range(0, 27, 3)] == [100.0 + 50 * i for i in range(9)]
    assert [design.point(i)["b"] for i in range(4)] == ["x", 2, True, "x"]
    assert Design.of(["a=3:9:1"], []).point(0) == {"a": 3.0}


def test_samples_are_the_same_at_each_point_of_the_grid() -> None:
    design = Design.of(["a=1,2"], ["u=uniform:5:6:1500", "n=normal:10:2:1500"], seed=7)
    assert design.size == 3000
    first, second = ([design.point(i + at) for i in range(1500)] for at in (0, 1500))
    assert {p["a"] for p in first} == {1}
    assert [p["u"] for p in first] == [p["u"] for p in second]
    assert len({p["u"] for p in first}) == 1500
    assert all(5 < p["u"] < 6 for p in first)
    normal = np.array([p["n"] for p in first])
    assert (normal.mean(), normal.std()) == (pytest.approx(10, abs=0.2), pytest.approx(2, abs=0.15))
    assert Design.of(["a=1,2"], ["u=uniform:5:6:1500"], seed=8).point(0)["u"] != first[0]["u"]


def test_keys_are_a_list() -> None:
    """PY-24: a text alone is refused, not read letter by letter."""
    with pytest.raises(TypeError, match="grid is a list of texts, not the text 'velocity=1,2'"):
        sweep("scenario.py", "velocity=1,2")


def test_laws() -> None:
    design = Design.of([], ["i=integers:-1:1:3000", "c=choice:a,b:3000", "l=log_uniform:1:100:3000"])
    points = [design.point(i) for i in range(3000)]
    assert {p["i"] for p in points} == {-1, 0, 1}
    assert min(Counter(p["c"] for p in points).values()) > 1300
    assert sum(p["l"] < 10 for p in points) == pytest.approx(1500, abs=120)


def test_drawn_numbers_stay_what_they_are() -> None:
    """Of the first seed, for ever: a table could not go on otherwise."""
    design = Design.of([], ["mass=uniform:0:1:2000"])
    assert [design.point(i)["mass"] for i in (0, 1, 1999)] == [
        0.17583788192591154,
        0.08355071375183953,
        0.04454116826352539,
    ]


@pytest.mark.parametrize(
    ("grid", "sample", "wrong"),
    [
        ([], [], "nothing is varied"),
        (["velocity=1:2:0"], [], "velocity=1:2:0: has no values, so there is nothing to run"),
        (["velocity="], [], "has no values"),
        (["velocity"], [], "--grid velocity: expected NAME="),
        (["velocity=1:2"], [], "expected NAME=LOW:HIGH:COUNT"),
        (["velocity=1:x:3"], [], "'x' is not a number"),
        (["velocity=1:inf:3"], [], "'inf' is not a number"),
        (["velocity=1:2:2.5"], [], "the count must be a whole number"),
        (["velocity=1:2:-1"], [], "the count must be a whole number"),
        (["velocity=1,2", "velocity=3,4"], [], "'velocity' is varied twice"),
        ([], ["velocity=even:1:2:3"], "there is no law 'even'"),
        ([], ["velocity=uniform:1:2"], "expected NAME=uniform:LOW:HIGH:COUNT"),
        ([], ["velocity=uniform:2:1:3"], "the lower end 2 is above the upper end 1"),
        ([], ["velocity=normal:1:0:3"], "the deviation must be above 0"),
        ([], ["velocity=log_uniform:0:1:3"], "the lower end must be above 0"),
        ([], ["velocity=integers:0.5:1:3"], "the ends must be whole numbers"),
        ([], ["velocity=choice:,:3"], "nothing to choose from"),
        ([], ["velocity=uniform:1:2:3", "most=uniform:1:2:4"], "found 3 of velocity, 4 of most"),
        (["run=1,2"], [], "'run' is a column that every table has: give the parameter another name"),
        ([], ["engine_s=uniform:1:2:3"], "'engine_s' is a column that every table has"),
        (["velocty=1,2"], [], "has no parameter 'velocty'; did you mean 'velocity'?"),
        (["axes.rum.unit=1,2"], [], "axes: has no element 'rum'"),
    ],
)
def test_bad_input(grid: list[str], sample: list[str], wrong: str, capsys: pytest.CaptureFixture[str]) -> None:
    options = [f"--grid={one}" for one in grid] + [f"--sample={one}" for one in sample]
    assert main(["sweep", "scenario.py", *options]) == 2
    assert wrong in capsys.readouterr().err
    assert not Path("sweeps").exists()


# --- rows ---


def test_the_same_rows_whatever_the_number_of_workers(capsys: pytest.CaptureFixture[str]) -> None:
    """And the command of a row makes the run again, to the last bit."""
    grid, sample = ["velocity=100:400:4"], ["axes.ram.limits.jerk=log_uniform:2e5:8e5:3"]
    one = sweep("scenario.py", grid, sample, "one", workers=1)
    two = sweep("scenario.py", grid, sample, "two", workers=3)
    assert Path("one/runs.csv").read_bytes() == Path("two/runs.csv").read_bytes()
    assert (one.summary.runs, one.made, one.done, one.repeats) == (12, 12, True, True)
    assert two.summary.passed == one.summary.passed
    found = rows("one")
    assert [row["run"] for row in found] == [str(i) for i in range(12)]
    assert {row["count"] for row in found} == {"1"}  # its module is a new one in each run
    row = next(row for row in found if row["passed"] == "1" and row["velocity"] == "200.0")
    words = shlex.split(row["command"])
    assert words[:3] == ["takt", "run", "scenario.py"]
    scenario, changes = with_settings(load_scenario("scenario.py"), settings_of([w for w in words[3:] if "=" in w]))
    with takt.Engine(scenario.machine, changes=changes) as session:
        outcome = run_scenario(scenario, session)
        assert f"{session.state_hash:016x}" == row["hash"]
    assert outcome.passed
    assert float(row["engine_s"]) == pytest.approx(session.now)
    assert float(row["time"]) == outcome.recording.duration_s
    assert float(row["stays(ram)"]) == outcome.verdicts[1].by_how_much
    assert main(words[1:]) == 0
    assert "2 passed" in capsys.readouterr().out


def test_true_false_and_texts_of_a_grid() -> None:
    """PY-24: rows say what ran: True and False as people write them, texts as they are typed."""
    head, rest = SCENARIO.split("def verify")
    results = 'def results(recording, up=True, mode=""):\n    return {"ran": f"{up!r} {mode!r}"}\n'
    Path("scenario.py").write_text(f"{head}def verify{rest.split('def results')[0]}{results}")
    sweep("scenario.py", ["up=True,False,no", "mode=007,1e3"], directory="d", workers=1)
    found = rows("d")
    assert [row["ran"] for row in found] == [f"{up} {mode!r}" for up in (True, False, False) for mode in ("007", "1e3")]
    assert [row["mode"] for row in found[:2]] == ["007", "1e3"]
    assert "--set mode=007" in found[0]["command"]


@pytest.mark.parametrize(("judges", "passed"), [("return True", "1"), ("return False", "0"), ("assert False", "0")])
def test_results_whatever_verify_says(judges: str, passed: str) -> None:
    """PY-24: they are asked for where the scenario came to its end, and may be NaN in a run that repeats."""
    head, _ = SCENARIO.split("def verify")
    broken = "    assert mode == 'plain'\n"
    results = "def results(recording):\n    return {'mean': float('nan'), 'time': recording.duration_s}\n"
    Path("scenario.py").write_text(f"{head}{broken}def verify(recording):\n    {judges}\n{results}")
    result = sweep("scenario.py", ["mode=plain,other"], directory="d", workers=1)
    first, second = rows("d")
    assert (first["passed"], first["mean"], second["passed"], second["mean"]) == (passed, "nan", "0", "")
    assert float(first["time"]) > 0.1
    assert result.repeats


def test_results_named_like_other_columns() -> None:
    """PY-24: no column replaces another one, and a name is one line."""
    head, _ = SCENARIO.split("def results")
    given = {"run": 5, "command": 6, "velocity": 7, "line\nbreak": 8, "line break": 9, "stays(ram)": 10}
    Path("scenario.py").write_text(f"{head}def results(recording):\n    return {given!r}\n")
    sweep("scenario.py", ["velocity=100,200"], directory="d", workers=1)
    first, second = rows("d")
    assert (first["run"], second["run"], second["velocity"]) == ("0", "1", "200")
    assert first["command"].startswith("takt run scenario.py")
    assert list(first.values())[-6:] == [str(value) for value in given.values()]
    names = ["run (result)", "command (result)", "velocity (result)", "line break", "line break (result)"]
    assert list(first)[-6:] == [*names, "stays(ram) (result)"]


def test_what_fails_is_a_row() -> None:
    result = sweep("scenario.py", ["velocity=250,350,1000", "mode=plain,raises"], directory="d", workers=2)
    assert (result.summary.passed, result.summary.failed) == (1, 5)
    found = rows("d")
    assert found[0]["failed"] == ""
    assert found[1]["failed"].startswith('ValueError: no thing, "250.0" (scenario.py:')
    assert found[2]["failed"].startswith("within_limits(ram): ")
    assert float(found[2]["within_limits(ram)"]) < 0
    assert "velocity" in found[4]["failed"]
    reasons = result.summary.reasons
    assert reasons["within_limits(ram)"][:2] == (1, 2)
    assert sum(count for count, _, _ in reasons.values()) == 5


def test_a_machine_that_is_refused_is_a_row() -> None:
    sweep("scenario.py", ["axes.ram.limits.velocity=400,-1"], directory="d", workers=1)
    found = rows("d")
    assert (found[0]["passed"], found[1]["passed"]) == ("1", "0")
    assert found[1]["failed"].startswith("machine.yaml:3:")


# --- workers ---


def test_workers_that_die(tmp_path: Path) -> None:
    """The run that two of them die in says so; others are made."""
    result = sweep("scenario.py", ["mode=plain,dies,exits,plain "], directory="d", workers=2)
    found = rows("d")
    assert [row["passed"] for row in found] == ["1", "0", "0", "1"]
    assert found[1]["failed"] == "no result: its worker was ended by SIGKILL"
    assert "ended by exit(3)" in found[2]["failed"]
    assert result.summary.failed == 2


def test_a_worker_that_dies_once(tmp_path: Path) -> None:
    grid = ["velocity=100,200", "mode=dies once"]
    sweep("scenario.py", [*grid, f"once={tmp_path / 'was'}"], directory="d", workers=1)
    assert [row["passed"] for row in rows("d")] == ["1", "1"]


def test_a_run_that_takes_too_long() -> None:
    sweep("scenario.py", ["mode=hangs,plain"], directory="d", workers=1, timeout_s=1.5)
    found = rows("d")
    assert found[0]["failed"] == "no result: it took longer than 1.5 s"
    assert found[1]["passed"] == "1"


# --- going on ---


def test_a_sweep_goes_on(capsys: pytest.CaptureFixture[str]) -> None:
    grid = ["velocity=100:200:6"]
    sweep("scenario.py", grid, directory="whole", workers=1)
    first = sweep("scenario.py", grid, directory="d", workers=1, stop_after=2)
    assert (first.made, first.done) == (2, False)
    with Path("d/runs.csv").open("a") as file:
        file.write("2,14")  # a process that was killed while it wrote
    assert main(["sweep", "scenario.py", "--grid", grid[0], "-o", "d", "--workers", "1"]) == 0
    said = capsys.readouterr().out
    assert "6 passed, 0 failed\n4 runs made" in said
    assert Path("d/runs.csv").read_bytes() == Path("whole/runs.csv").read_bytes()
    again = sweep("scenario.py", grid, directory="d", workers=1)
    assert (again.made, again.done) == (0, True)


def test_ten_million_runs_begin_at_once() -> None:
    grid, sample = ["velocity=100:200:1e4"], ["most=uniform:250:300:1000"]
    assert Design.of(grid, sample).size == 10_000_000
    result = sweep("scenario.py", grid, sample, "d", workers=1, stop_after=3)
    assert (result.summary.runs, result.summary.size) == (3, 10_000_000)
    assert "9,999,997 of 10,000,000 runs have not been made yet." in result.page.read_text()


def test_columns_that_come_later() -> None:
    """The first run breaks off before it is judged."""
    sweep("scenario.py", ["mode=raises,plain"], directory="d", workers=1)
    first, second = rows("d")
    assert first["stays(ram)"] == first["time"] == ""
    assert float(second["stays(ram)"]) > 0
    assert list(first) == list(second)


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        ({"version": "0.0.1"}, "was made by another version of Takt (0.0.1; now"),
        ({"takt_sweep": 0}, "was made by another format (0; now 1)"),
        ({"seed": 5}, "was made by another seed (5; now 0)"),
        ({"grid": ["velocity=1:2:3"]}, "was made by other grids (velocity=1:2:3; now velocity=100:200:2)"),
        ({"scenario_sha256": "0"}, "was made by the scenario as it was before a change, and"),
        ({"machine_sha256": "0"}, "was made by the machine file as it was before a change"),
        ("{", "does not say what runs.csv beside it was made by"),
        ("[]", "does not say what runs.csv beside it was made by"),
    ],
)
def test_a_table_that_others_made(change: dict[str, object] | str, wrong: str) -> None:
    grid = ["velocity=100:200:2"]
    sweep("scenario.py", grid, directory="d", workers=1, stop_after=0)
    about = Path("d/sweep.json")
    known = json.loads(about.read_text())
    about.write_text(change if isinstance(change, str) else json.dumps(known | change))
    with pytest.raises(SweepError) as error:
        sweep("scenario.py", grid, directory="d", workers=1)
    assert wrong in str(error.value)
    sweep("scenario.py", grid, directory="d", workers=1, stop_after=0, fresh=True)
    assert json.loads(about.read_text()) == known


def test_rows_that_are_not_in_order() -> None:
    grid = ["velocity=100:200:2"]
    sweep("scenario.py", grid, directory="d", workers=1, stop_after=1)
    table = Path("d/runs.csv")
    table.write_text(table.read_text().replace("\n0,", "\n1,"))
    with pytest.raises(SweepError, match=r"runs\.csv:2: expected run 0 with \d+ columns here"):
        sweep("scenario.py", grid, directory="d", workers=1)
    for damaged in ("0,foo,bar", '0,"foo,bar"', '0,"foo'):
        table.write_text(table.read_text().splitlines()[0] + f"\n{damaged}\n")
        with pytest.raises(SweepError, match=r"runs\.csv:2: expected run 0 with \d+ columns here"):
            sweep("scenario.py", grid, directory="d", workers=1)


def test_two_sweeps_at_once() -> None:
    grid = ["velocity=100:200:2"]
    wrong: list[str] = []

    def also(share: float) -> None:
        with pytest.raises(SweepError) as error:
            sweep("scenario.py", grid, directory="d", workers=1)
        wrong.append(str(error.value))

    assert sweep("scenario.py", grid, directory="d", workers=1, progress=also).done
    assert wrong == ["d/runs.csv: another sweep is writing it; -o names another directory"] * 2


def test_a_machine_of_ones_own() -> None:
    Path("other.yaml").write_text(MACHINE.replace("velocity: 400", "velocity: 150"))
    sweep("scenario.py", ["velocity=100,200"], directory="d", machine="other.yaml", workers=1)
    found = rows("d")
    assert [row["passed"] for row in found] == ["1", "0"]
    assert found[0]["command"] == "takt run scenario.py --machine other.yaml --set velocity=100"


def test_a_sweep_whose_process_is_killed_leaves_no_workers() -> None:
    program = (
        "import os, signal, threading\nfrom takt.sweep import sweep\n"
        "done = lambda share: os.kill(os.getpid(), signal.SIGKILL)\n"
        "sweep('scenario.py', ['velocity=100:200:12'], directory='d', workers=1, progress=done)\n"
    )
    killed = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=60, check=False)
    assert killed.returncode == -9  # and its pipes, which workers would hold, were closed
    assert sweep("scenario.py", ["velocity=100:200:12"], directory="d", workers=2).done


def test_what_is_random_is_said() -> None:
    text = SCENARIO.replace("velocity=velocity", "velocity=velocity + int.from_bytes(os.urandom(2)) / 1e3")
    Path("scenario.py").write_text(text)
    assert not sweep("scenario.py", ["velocity=100,101"], directory="d", workers=1).repeats


def test_parquet() -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    result = sweep("scenario.py", ["velocity=100,350", "mode=plain,raises"], directory="d", workers=1)
    table = parquet.read_table(result.parquet)
    assert table["run"].to_pylist() == [0, 1, 2, 3]
    assert table["mode"].to_pylist() == ["plain", "raises"] * 2
    assert table["time"].to_pylist()[1] is None
    assert table["velocity"].to_pylist() == [100.0, 100.0, 350.0, 350.0]


@needs_chromium
def test_the_page(browser: Browser) -> None:
    expect.set_options(timeout=PATIENCE_S * 1000)
    file = sweep("scenario.py", ["velocity=100:400:7"], directory="d", workers=2).page
    with opened(browser, file.resolve()) as page:
        expect(page.locator("h1")).to_have_text("The ram goes down")
        expect(page.locator(".pill")).to_have_text("2 of 7 failed")
        expect(page.locator("figcaption", has_text="stays(ram) by velocity")).to_be_visible()
        failed = page.locator("section", has=page.locator("h2", has_text="What failed"))
        expect(failed.locator("code")).to_have_text("takt run scenario.py --set velocity=350.0")
        bars = page.locator("figure", has=page.locator("figcaption", has_text="time")).first.locator("rect")
        assert bars.count() == 40
