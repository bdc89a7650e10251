"""PY-04, PY-05: pictures made from a recording."""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_rgb
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


def test_figures_show_themselves() -> None:
    """PY-25: notebooks ask the last value of a cell for its picture."""
    rec = one_axis()
    for figure in (plot.draw(rec, "x"), plot.draw_verdict(checks.within_limits(rec, "x"), rec)):
        shown = imread(io.BytesIO(figure._repr_png_()))
        assert shown.shape[1] == 1400
        assert len(np.unique(shown.reshape(-1, shown.shape[2]), axis=0)) > 20


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
    np.testing.assert_allclose(looks["x"], 0.45 * np.array(to_rgb(looks["actual x"])))
    styles = {line.get_label(): line.get_linestyle() for ax in figure.axes for line in ax.get_lines()}
    assert (styles["x"], styles["actual x"]) == ("--", "-")


def test_signals_by_pattern() -> None:
    rec = positions(x=np.arange(5.0), y=np.arange(5.0))
    with pytest.raises(TypeError, match="signals is a list of patterns, not the text 'xy'"):
        plot.select(rec, "xy")
    assert plot.select(rec, ["*.set_position"]) == [("x", "set_position"), ("y", "set_position")]
    assert plot.select(rec, ["y"]) == [("y", "set_position"), ("y", "actual_position")]
    assert plot.select(rec, ["x.a*", "x.a*"]) == [("x", "actual_position")]
    with pytest.raises(
        RecordingError, match=r"no signal matches 'z\.\*': this recording has no component 'z' \(it has x, y\)"
    ):
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


def test_nothing_is_drawn_where_samples_are_missing() -> None:
    cycle = np.delete(np.arange(10), [4, 5])
    rec = Recording({"x": {"time_s": cycle * DT, "cycle": cycle, "set_position": cycle, "on": [True] * 8}})
    verdicts = [checks.stays(rec, "x.set_position < 20"), checks.never_both(rec, "x.set_position > 20", "x.on")]
    for curve in (plot.draw(rec, "x.*").axes[0], *(plot.draw_verdict(verdict, rec).axes[0] for verdict in verdicts)):
        values = np.asarray(curve.get_lines()[0].get_ydata())
        assert math.isnan(values[4])
        assert np.delete(values, 4).tolist() == cycle.tolist()
    band = plot.draw(rec, "x.*").axes[1]
    ends = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in band.patches]
    np.testing.assert_allclose(ends, [(0.0, 0.003), (0.006, 0.009)])
    assert plot.stretches(cycle[:5] * DT, [1] * 5, [(0.003, 0.006)]) == [(0, 0.003, 1), (0.006, 0.006, 1)]
    late = checks.stays(rec, "x.set_position < 20", window=(0.0065, 0.0085))
    assert np.asarray(plot.draw_verdict(late, rec).axes[0].get_lines()[0].get_ydata()).tolist() == [7, 8]


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


def test_the_picture_shows_the_broken_limit_however_far_away_it_is() -> None:
    rec = Recording({"x": {"time_s": np.arange(50) * DT, "still": np.full(50, 0.7), "nothing": np.zeros(50)}})
    for condition, limit in (("x.still < 0.1", 0.1), ("x.still > 30", 30), ("x.nothing == 2", 2)):
        (ax,) = plot.draw_verdict(checks.stays(rec, condition)).axes
        low, high = ax.get_ylim()
        assert low < limit < high
    (ax,) = plot.draw_verdict(checks.stays(rec, "x.nothing < 400")).axes
    assert ax.get_ylim() == (-1, 1)
