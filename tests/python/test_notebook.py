"""PY-25: what notebooks show of figures, sessions, recordings, verdicts, cams, paths and comparisons."""

from __future__ import annotations

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
from takt.toolpath import Element, Toolpath

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
