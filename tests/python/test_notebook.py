"""PY-25: what notebooks show of figures, sessions, recordings, verdicts, cams, paths and comparisons."""

from __future__ import annotations

from math import nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from every_kind import FULL, text_of
from motion_curves import one_axis
from takt import checks, plot
from takt.cam import Table
from takt.recording import Recording
from takt.report import compare
from takt.scenario import Outcome
from takt.sweep.design import Design
from takt.sweep.summary import Summary
from takt.sweep.sweeping import Result
from takt.toolpath import Element, Toolpath
from takt.twin.judging import AxisFigures, Judged, ToolFigures

MACHINE = """\
name: <cell>
axes:
  - {name: x, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: drive, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
belts:
  - {name: infeed, axis: drive}
"""


def shown(value: Any) -> dict[str, Any]:
    """What IPython sends of the last value of a cell; without IPython what its protocol says."""
    try:
        from IPython.core.formatters import DisplayFormatter
    except ImportError:
        kinds = {"image/png": "_repr_png_", "text/html": "_repr_html_"}
        found = {kind: getattr(value, name)() for kind, name in kinds.items() if hasattr(value, name)}
        return {kind: data for kind, data in found.items() if data is not None}
    formatter = DisplayFormatter()
    formatter.active_types = formatter.format_types
    data, _ = formatter.format(value)
    return dict(data)


def test_figures_show_themselves() -> None:
    rec = one_axis()
    for figure in (plot.draw(rec), plot.draw_verdict(checks.within_limits(rec, "x"), rec)):
        assert shown(figure)["image/png"].startswith(b"\x89PNG")


def test_a_session_shows_its_components() -> None:
    with takt.Engine(MACHINE) as session:
        x = session.axis("x")
        x.power().wait()
        x.move_absolute(position=12.5).wait()
        text = shown(session)["text/html"]
        assert repr(session).startswith("<Engine <cell>: 3 components, 0.")
        before = session.cycle
    for wanted in ("&lt;cell&gt; at", '<td style="text-align:left">x</td>', "Standstill at 12.5", "infeed", "belt"):
        assert wanted in text, wanted
    assert "<cell>" not in text
    assert session.cycle == before
    assert "closed" in shown(session)["text/html"]


def test_every_kind_of_component_says_something() -> None:
    with takt.Engine(text_of(FULL)) as session:
        text = shown(session)["text/html"]
        assert text.count("<tr>") == len(session.components) + 1
        for name, component in session.components.items():
            text = shown(component)["text/html"]
            assert f"<b>{name}, {component.KIND.replace('_', ' ')} of small at 0.000 s</b>" in text
            assert text.count("<tr>") > 1, name
            assert "nan" not in text


def test_a_component_shows_its_values() -> None:
    with takt.Engine(MACHINE) as session:
        x = session.axis("x")
        x.power().wait()
        x.move_absolute(position=12.5).wait()
        text = shown(x)["text/html"]
        belt = shown(session.belt("infeed"))["text/plain"]
    cells = [row.split("<td")[1:] for row in text.split("<tr>")[2:]]
    rows = {row[0].split(">")[1].split("<")[0]: [cell.split(">")[1].split("<")[0] for cell in row[1:]] for row in cells}
    assert rows["set_position"] == ["12.5", "mm"]
    assert rows["set_velocity"] == ["0", "mm/s"]  # of the first ones, so shown though it is 0
    assert rows["state"] == ["Standstill", ""]
    assert rows["loop_closed"] == ["yes", ""]
    assert rows["override_factor"] == ["1", ""]
    assert "error" not in rows
    assert "others: 0, off or unknown" in text
    assert belt == "<Belt infeed: at 0 mm, 0 mm/s, 0 objects>"


def test_a_recording_shows_what_it_holds() -> None:
    rows = np.r_[0:10, 15:20]
    columns = {"time_s": 0.001 * rows, "cycle": rows, **{f"f{i}": rows for i in range(8)}}
    rec = Recording({"<x>": columns}, {"<x>": {"f0": "mm"}}, events=[(0.0, "", "a mark")])
    text = shown(rec)["text/html"]
    for wanted in ("&lt;x&gt;", "15", "1000 Hz", "f0 [mm], f1", "2 more", "1 event; missing: 5 samples"):
        assert wanted in text, wanted
    assert "Recording of a machine, 0.000 s" in shown(Recording({}))["text/html"]


def test_a_verdict_shows_its_picture() -> None:
    rec = one_axis()
    failed, passed = checks.within_limits(rec, "x", velocity=1.0), checks.within_limits(rec, "x")
    for verdict, mark in ((failed, "failed"), (passed, "passed")):
        text = shown(verdict)["text/html"]
        assert f">{mark}</b>" in text
        assert "data:image/png;base64," in text
    empty = Recording({"x": {"time_s": [], "state": []}}, names={"x": {"state": ["a"]}})
    alone = checks.visits_states(empty, "x", ["a"])
    assert "failed" in shown(alone)["text/html"]


def test_a_scenario_that_ran_shows_its_verdicts() -> None:
    """Those that failed with their pictures; and one line as text, without curves."""
    rec = one_axis()
    verdicts = checks.within_limits(rec, "x", velocity=1.0), checks.within_limits(rec, "x")
    said = shown(Outcome(rec, verdicts))
    for wanted in ("1 passed, 1 failed", ">failed</b>", "no sample missing"):
        assert wanted in said["text/html"], wanted
    assert said["text/html"].count("data:image/png;base64,") == 1
    assert said["text/plain"].startswith("<Outcome: 1 passed, 1 failed; <Recording")
    assert repr(verdicts[1]) == f"<Verdict within_limits(x): passed: {verdicts[1].sentence}>"


def test_a_sweep_shows_what_failed_and_its_numbers(tmp_path: Path) -> None:
    row = {"run": "0", "velocity": "100", "passed": "1", "failed": "", "command": "takt run a.py", "stroke_s": "2.5"}
    bad = row | {"run": "1", "velocity": "200", "passed": "0", "failed": "stays(x): <by far>", "command": "takt run b"}
    summary = Summary.of([row, bad], Design.of(["velocity=100:300:3"], [], 0))
    result = Result(tmp_path / "runs.csv", tmp_path / "sweep.html", None, summary, 2, 1.0, True)
    said = shown(result)
    for wanted in ("1 passed, 1 failed, 1 not made yet", "stays(x)", "takt run b", "velocity", "sweep.html"):
        assert wanted in said["text/html"], wanted
    assert said["text/plain"] == f"<Result {tmp_path}/runs.csv: 1 passed, 1 failed, 1 not made yet>"


def test_a_twin_shows_its_figures() -> None:
    verdict = checks.within_limits(one_axis(), "x")
    axes = (
        AxisFigures("x", "mm", (0.012, 0.5), (0.02, 0.6), (1.0, 9.0), 40.0, 0),
        AxisFigures("off", "mm", (nan, nan), None, (0.0, 0.0), 40.0, 0),
    )
    judged = Judged(1000, axes, (ToolFigures("robot", (0.01, 0.1), 0.02, (1.5, 4.0), None),), None, (verdict,))
    said = shown(judged)
    for wanted in (
        "1,000 cycles in the twin",
        "tool from its set pose [mm]",
        "0.012",
        "torque of 40",
        verdict.sentence,
    ):
        assert wanted in said["text/html"], wanted
    assert "nan" not in said["text/html"]  # the position loop was never closed
    assert said["text/plain"] == "<Judged 1,000 cycles: passed>"


def test_a_comparison_shows_its_figures() -> None:
    text = shown(compare(one_axis(lag=0.002), one_axis(lag=0.003), ("before", "after")))["text/html"]
    for wanted in ("before and after", "x.actual_position", "largest difference", "signals differ"):
        assert wanted in text, wanted


def test_cams_and_paths_draw_themselves() -> None:
    cam = Table.from_points([0, 90, 180], [0, 10, 0], x_unit="deg", y_unit="mm")
    path = Toolpath((0.0, 0.0, 0.0), (Element((10.0, 0.0, 0.0)), Element((20.0, 10.0, 0.0), via=(17.0, 3.0, 0.0))))
    for one in (cam, path):
        assert shown(one)["image/png"].startswith(b"\x89PNG")


def test_an_empty_path_draws_itself() -> None:
    assert shown(Toolpath((0.0, 0.0, 0.0), ()))["image/png"]


def test_what_export_needs_is_named(tmp_path: Any, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    import sys

    from takt.cli import main

    monkeypatch.setitem(sys.modules, "pyarrow", None)
    file = one_axis().save(tmp_path / "a.npz")
    assert main(["export", str(file), "--parquet", str(tmp_path / "a.parquet")]) == 2
    assert "to_parquet() needs the package pyarrow: pip install pyarrow" in capsys.readouterr().err
