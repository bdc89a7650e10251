"""CAM-01 to CAM-04, CAM-24, CAM-71: cams from Python."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from hypothesis import given, settings
from hypothesis import strategies as st
from takt import ConfigError, cam
from takt.cam_check import Limits, check

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import cam_laws  # noqa: E402

LAWS = [*cam_laws.CLOSED_FORMS, "quintic", "line", "dwell"]
FEED = """\
name: feed
x_unit: deg
y_unit: mm
cyclic: true
segments:
  - {to: {x: 120, y: 50}, law: modified_sine}
  - {to: {x: 180, y: 50}, law: dwell}
  - {to: {x: 360, y: 0}, law: cycloid}
"""
MACHINE = """\
name: m
axes:
  - {name: line, unit: deg, limits: {velocity: 720, acceleration: 7200, jerk: 72000}}
  - {name: x, unit: mm, limits: {velocity: 600, acceleration: 6000, deceleration: 5000, jerk: 400000, lower: 0}}
cams:
  - name: saw
    interpolation: linear
    points: [{x: 0, y: 0}, {x: 180, y: 30}, {x: 360, y: 0}]
  - name: feed
    cyclic: true
    segments: [{to: {x: 180, y: 30}, law: cycloid}, {to: {x: 360, y: 0}, law: polynomial_345}]
"""


def feed() -> cam.Table:
    return cam.Table.from_yaml(FEED)


# --- laws ---


@pytest.mark.parametrize("law", cam_laws.CLOSED_FORMS)
def test_peak_factors_are_those_of_the_closed_forms(law: str) -> None:
    """CAM-02: to 1e-6 relative; the same from a cam of that law over another length and height."""
    found = cam.law_factors(law)
    for value, (_, form) in zip(found, cam_laws.CLOSED_FORMS[law], strict=True):
        assert value == pytest.approx(form, rel=1e-6)
    table = cam.Table.from_segments([{"to": {"x": 90, "y": -30}, "law": law}])
    _, *derivatives = table.extremes()
    for power, (bounds, factor) in enumerate(zip(derivatives, found, strict=True), start=1):
        if math.isfinite(factor):
            largest = max(-bounds.least.value, bounds.greatest.value)
            assert largest == pytest.approx(factor * 30 / 90**power, rel=1e-6)


def test_the_page_has_the_factors_of_the_laws() -> None:
    """CAM-02: docs/cams.md."""
    text = cam_laws.PAGE.read_text(encoding="utf-8")
    assert cam_laws.page(text) == text, "please run tools/cam_laws.py"
    assert FEED.splitlines()[0] in text
    example = cam.Table.from_yaml(cam_laws.EXAMPLE)
    assert cam.Table.from_yaml(text.split("```yaml\n")[1].split("```")[0]).source == example.source


def test_shares_of_a_combination() -> None:
    """CAM-02: the family has the other laws as members; shares that are none are refused."""
    trapezoid = cam.law_factors("sine_constant_cosine", sine_share=0.25, cosine_share=0.25)
    assert trapezoid == pytest.approx(cam.law_factors("modified_trapezoid"))
    assert cam.law_factors("sine_constant_cosine", sine_share=0, cosine_share=1)[:2] == pytest.approx(
        cam.law_factors("harmonic")[:2]
    )
    for sine, cosine in ((-0.1, 0.5), (0.6, 0.6), (math.nan, 0.5)):
        with pytest.raises(ValueError, match="at least 0, and 1 at most together"):
            cam.law_factors("sine_constant_cosine", sine_share=sine, cosine_share=cosine)
    with pytest.raises(ConfigError, match=r"expected one of dwell, line, .*, found 'cycloidal'"):
        cam.law_factors("cycloidal")


# --- making ---


def test_points_of_arrays() -> None:
    """CAM-01, CAM-04: linear and quintic through NumPy's numbers; NaN is free."""
    x, y = np.array([0, 90, 180, 360], dtype=np.int32), np.array([0, 10, 40, 0], dtype=np.float32)
    line = cam.Table.from_points(x, y, interpolation="linear", name="line")
    assert line.at(45) == (5.0, 10 / 90, 0.0, 0.0)
    assert len(line.warnings) == 1
    smooth = cam.Table.from_points(x, y, v=[math.nan, 0.2, math.nan, math.nan], cyclic=True)
    assert smooth.warnings == ()
    assert smooth.at(90).dy == pytest.approx(0.2)
    assert smooth.at(180.0).y == 40.0
    assert smooth.stroke == 0.0
    assert np.isnan(smooth.points.v[0])
    assert smooth.points.v[1] == 0.2


@pytest.mark.parametrize("interpolation", ["linear", "quintic", "cubic_spline"])
def test_slices_are_as_good_as_arrays_of_their_own(interpolation: cam.Interpolation) -> None:
    """CAM-04: what NumPy hands over need not lie in one piece."""
    grid = np.random.default_rng(1).normal(size=(40, 4))
    x = np.arange(80.0)[::2]
    cut = cam.Table.from_points(x, grid[:, 1], interpolation=interpolation)
    whole = cam.Table.from_points(x.copy(), grid[:, 1].copy(), interpolation=interpolation)
    places = np.linspace(0, 78, 101)
    assert np.array_equal(cut.at(places), whole.at(places))


def test_shapes() -> None:
    """CAM-71: numbers give floats, arrays arrays of their shape; outside as at the nearer end."""
    table = feed()
    value = table.at(60)
    assert isinstance(value.y, float)
    assert value.y == pytest.approx(25)
    assert table.at([]).y.shape == (0,)
    many = table.at(np.arange(24.0).reshape(2, 3, 4).transpose())
    assert many.dddy.shape == (4, 3, 2)
    assert many.y[3, 2, 1] == table.at(23.0).y
    assert table.at(-1) == table.at(0)
    assert table.at(math.inf) == table.at(360)


def test_segments_follow_one_another() -> None:
    """CAM-01: boundary velocity and acceleration of a quintic; from and to."""
    table = cam.Table.from_segments(
        [
            {"from": {"x": -10, "y": np.float64(5)}, "to": {"x": 0, "y": 5}, "law": "dwell"},
            {"to": {"x": 10, "y": 8}, "end_v": 0.5, "end_a": -0.01},
            {"to": {"x": 20, "y": 9}, "begin_v": None},
        ],
        name="three",
        x_unit="mm",
    )
    assert (table.begin, table.end, table.stroke, table.x_unit, table.y_unit) == (-10, 20, 4, "mm", "u")
    assert table.at(10)[:3] == pytest.approx((8, 0.5, -0.01))
    assert table.joints.tolist() == [-10, 0, 10, 20]
    assert repr(table) == "<cam three: x -10 to 20, stroke 4>"


# --- bad input ---

POINTS_NOT = [
    ([0.0], [0.0], "cam: points: expected 2 to 100,000 points, found 1"),
    ([], [], "cam: points: expected 2 to 100,000 points, found 0"),
    (range(100_001), range(100_001), "cam: points: expected 2 to 100,000 points, found 100001"),
    ([0, 1, 1], [0, 0, 0], "cam: points[2].x: expected x above 1 of the point before, found 1"),
    ([0, 2, 1], [0, 0, 0], "cam: points[2].x: expected x above 2 of the point before, found 1"),
    ([0, math.nan], [0, 0], "cam: points[1].x: expected a finite number, found nan"),
    ([0, 1], [0, -math.inf], "cam: points[1].y: expected a finite number, found -inf"),
]


@pytest.mark.parametrize(("x", "y", "sentence"), POINTS_NOT)
def test_points_that_are_no_cam(x: Any, y: Any, sentence: str) -> None:
    """CAM-03."""
    with pytest.raises(ConfigError) as error:
        cam.Table.from_points(x, y)
    assert error.value.problems == [sentence]


def test_arrays_that_do_not_fit() -> None:
    """CAM-03, CAM-04."""
    with pytest.raises(ValueError, match="y: expected as many values as x has, 2, found 3"):
        cam.Table.from_points([0, 1], [0, 1, 2])
    with pytest.raises(ValueError, match="x must be an array of one dimension"):
        cam.Table.from_points([[0, 1]], [[0, 1]])
    with pytest.raises(ValueError, match="could not convert"):
        cam.Table.from_points(["a", 1], [0, 1])
    with pytest.raises(ConfigError, match=r"cam: points\[0\].v: expected a finite number, found inf"):
        cam.Table.from_points([0, 1], [0, 1], v=[math.inf, 0])
    with pytest.raises(ConfigError, match="expected one of linear, quintic, cubic_spline, monotone, found 'quintc'"):
        cam.Table.from_points([0, 1], [0, 1], interpolation="quintc")  # type: ignore[arg-type]


SEGMENTS_NOT = [
    ([], "points: must be given, or segments, or a file"),
    ([{"to": 3}], "segments[0].to: expected a mapping, found '3'"),
    ([{"to": {"x": 1}}], "segments[0].to.y: expected this key"),
    ([{"to": {"x": math.nan, "y": 0}}], "segments[0].to.x: expected a finite number"),
    ([{"to": {"x": 1, "y": 1}, "law": "cycloidal"}], "did you mean cycloid?"),
    ([{"to": {"x": 1, "y": 1}, "laws": "cycloid"}], "did you mean law?"),
    ([{"to": {"x": 1, "y": 1}}, {"to": {"x": 1, "y": 2}}], "segments[1].to.x: expected x above 1"),
    (
        [{"to": {"x": 1, "y": 1}, "law": "cycloid"}, {"from": {"x": 1, "y": 2}, "to": {"x": 2, "y": 3}}],
        "segments[1]: expected the position of the segment before, 1 at x 1, found 2",
    ),
    (
        [{"to": {"x": 1, "y": 1}, "law": "cycloid"}, {"to": {"x": 2, "y": 3}, "law": "line"}],
        "segments[1]: expected the velocity of the segment before, 0 at x 1, found 2",
    ),
]


@pytest.mark.parametrize(("segments", "part"), SEGMENTS_NOT)
def test_segments_that_are_no_cam(segments: Any, part: str) -> None:
    """CAM-03: breaks of position and velocity among them."""
    with pytest.raises(ConfigError) as error:
        cam.Table.from_segments(segments)
    (problem,) = error.value.problems
    assert part in problem


CSV_NOT = [
    ("x,y\n0,0\n\n2,1\n2,2\n", ":5:1: expected x above 2 of the point before, found 2"),
    ("x,y\n0,0\n1,nan\n", ":3:3: expected a finite number for y, found 'nan'"),
    ("x,y\n0,0\n", ":1:1: expected 2 to 100,000 points, found 1"),
    ("x,y\n0;0\n1;1\n", ":2:1: expected 2 columns, found 1"),
    (
        "x,y\n" + "".join(f"{i},0\n" for i in range(100_005)),
        ":100002:1: expected 100,000 points at most, found one more",
    ),
]


@pytest.mark.parametrize(("text", "sentence"), CSV_NOT, ids=range(len(CSV_NOT)))
def test_csv_that_is_no_cam(text: str, sentence: str, tmp_path: Path) -> None:
    """CAM-03: file, row and value."""
    file = tmp_path / "bad.csv"
    file.write_text(text)
    with pytest.raises(ConfigError) as error:
        cam.Table.from_csv(file)
    assert error.value.problems[0] == f"{file}{sentence}"


def test_a_file_within_a_file_is_refused(tmp_path: Path) -> None:
    """CAM-04: one cam of YAML has its points with it; a machine file may name a CSV file."""
    with pytest.raises(ConfigError, match="expected points or segments, found a file"):
        cam.Table.from_yaml("name: a\nfile: b.csv\n")
    with pytest.raises(FileNotFoundError):
        cam.Table.from_csv(tmp_path / "none.csv")


# --- there and back ---

NUMBERS = st.floats(-1e6, 1e6, allow_nan=False)
GIVEN = st.one_of(st.just(math.nan), st.floats(-1e3, 1e3, allow_nan=False))
ROWS = st.lists(st.tuples(st.floats(1e-3, 1e3), NUMBERS, GIVEN, GIVEN), min_size=2, max_size=30)


def test_names_of_all_characters() -> None:
    """CAM-04: names with characters beyond U+FFFF stay as they are."""
    table = cam.Table.from_segments([{"to": {"x": 360, "y": 10}}], name="𠮷 😀")
    assert table.name == "𠮷 😀"
    assert cam.Table.from_yaml(table.to_yaml()).name == table.name
    with takt.Engine(MACHINE.replace("linear", "quintic")) as session:
        session.make_cam(table).wait()
        assert session.cam("𠮷 😀").name == table.name


@settings(deadline=None)
@given(ROWS)
def test_what_was_written_is_the_same_cam(rows: list[tuple[float, float, float, float]]) -> None:
    """CAM-04: points by way of CSV, YAML and NumPy, bit for bit."""
    steps, y, v, a = (np.array(column) for column in zip(*rows, strict=True))
    x = np.cumsum(steps)
    table = cam.Table.from_points(x, y, v, a)
    core = takt._core.cam_from_csv(table.to_csv().encode(), "f.csv", "cam", "quintic", False, "u", "u")
    places = np.linspace(x[0], x[-1], 50)
    for again in (
        cam.Table(*core),
        cam.Table.from_yaml(table.to_yaml()),
        cam.Table.from_dict(table.source),
        cam.Table.from_points(*table.points),
    ):
        assert np.array_equal(again.at(places), table.at(places))
        assert again.source == table.source


@pytest.mark.parametrize("law", LAWS)
def test_segments_are_written_and_read(law: str, tmp_path: Path) -> None:
    """CAM-04."""
    file = tmp_path / "one.yaml"
    table = cam.Table.from_segments([{"to": {"x": 3, "y": 0 if law == "dwell" else 1}, "law": law}])
    table.to_yaml(file)
    assert cam.Table.from_yaml(file).source == table.source
    with pytest.raises(ValueError, match="a cam of segments has no points"):
        table.to_csv()


def test_segments_as_points(tmp_path: Path) -> None:
    """CAM-04: points of the curve with velocity and acceleration; between them the quintic is near, by h^6 theory."""
    file = tmp_path / "feed.csv"
    text = feed().to_csv(file, count=73)
    assert file.read_text() == text
    assert len(text.splitlines()) == 74
    near = cam.Table.from_csv(file, cyclic=True)
    x = np.linspace(0, 360, 5000)
    # |error| <= h^6 / (64 * 720) * |sixth derivative|; the cycloid's is 2 pi h / L (2 pi / L)^5 at most.
    bound = 5**6 / 46_080 * (50 / 120) * 16 * (2 * math.pi / 60) ** 5
    assert np.max(np.abs(near.at(x).y - feed().at(x).y)) < bound


def test_cams_of_a_machine_file(tmp_path: Path) -> None:
    """CAM-04, CAM-02: points, segments and files, all with their warnings."""
    feed().to_csv(tmp_path / "far.csv", count=37)
    file = tmp_path / "machine.yaml"
    file.write_text(MACHINE + "  - {name: far, cyclic: true, file: far.csv}\n")
    saw, designed, far = cam.of_machine(file)
    assert [saw.name, designed.name, far.name] == ["saw", "feed", "far"]
    assert saw.warnings[0].startswith("saw: points[1]: straight lines meet")
    assert designed.warnings == far.warnings == ()
    assert len(far.points.x) == 37
    with pytest.warns(UserWarning, match=r"machine.yaml:8:\d+: cams\[0\].points\[1\]: warning: straight lines meet"):
        takt.Engine(file).close()


@pytest.mark.parametrize(
    ("text", "is_one"),
    [
        (MACHINE, True),
        (FEED, False),
        ("{cams: [{name: a, points: []}], axes: []}", True),
        ("name: {points: 1}\nunits: [file]\naxes: []", True),
        ("name: cams\npoints: [{x: 0, y: 0}]\naxes: 1", False),
        ("name: &a cams\nother: *a\nsegments: []", False),
        ("", False),
        ("name: [", False),
        ("\xff", False),
    ],
)
def test_a_machine_is_told_from_a_cam(text: str, is_one: bool) -> None:
    assert cam.is_machine(text.encode("latin-1")) is is_one


# --- extremes, inverse, checks ---


@settings(deadline=None, max_examples=50)
@given(
    st.lists(st.tuples(st.floats(1, 10), st.floats(-5, 5), st.sampled_from(LAWS[:-2])), min_size=1, max_size=6),
    st.floats(0.1, 5),
    st.floats(0, 5),
)
def test_extremes_are_those_of_dense_samples(rows: list[tuple[float, float, str]], speed: float, more: float) -> None:
    """CAM-24: no sample is beyond, some are near."""
    x, segments = 0.0, []
    for length, y, law in rows:
        x += length
        segments.append({"to": {"x": x, "y": y}, "law": law})
    table = cam.Table.from_segments(segments)
    joints = table.joints
    places = np.concatenate([np.linspace(0, x, 20_000), joints, np.nextafter(joints[1:], 0)])
    y, dy, ddy, dddy = table.at(places)
    for samples, bounds in zip((y, dy, ddy, dddy), table.extremes(), strict=True):
        size = 1e-6 + np.max(np.abs(samples))
        assert -1e-9 * size <= np.min(samples) - bounds.least.value < 1e-3 * size
        assert -1e-9 * size <= bounds.greatest.value - np.max(samples) < 1e-3 * size
    peaks = table.slave_peaks(speed, more)
    sampled = np.max(np.abs(ddy) * speed**2 + np.abs(dy) * more)
    assert peaks.velocity.value == pytest.approx(np.max(np.abs(dy)) * speed, rel=1e-3, abs=1e-9)
    assert peaks.acceleration.value == pytest.approx(sampled, rel=1e-3, abs=1e-9)
    assert abs(table.at(peaks.velocity.x).dy) * speed == pytest.approx(peaks.velocity.value, abs=1e-9)


def test_the_engine_meets_the_extremes() -> None:
    """CAM-24: a slave behind a master at constant speed has just these velocities and accelerations."""
    table = cam.of_machine(MACHINE)[1]
    with pytest.warns(UserWarning, match="straight lines meet"):
        engine = takt.Engine(MACHINE)
    with engine:
        line, x = engine.axis("line"), engine.axis("x")
        line.power().wait()
        x.power().wait()
        x.cam_in(master="line", cam="feed")
        line.move_velocity(velocity=300)
        engine.run(1.0)
        record = engine.record("x")
        engine.run(2.4)  # two turns
        recording = record.stop()
    found = table.slave_peaks(300.0)
    rows = recording["x"]
    assert np.max(np.abs(rows["set_velocity"])) == pytest.approx(found.velocity.value, rel=1e-4)
    assert np.max(np.abs(rows["set_acceleration"])) == pytest.approx(found.acceleration.value, rel=1e-3)
    assert np.max(rows["set_position"]) == pytest.approx(found.position.greatest.value, abs=1e-3)


def test_inverse() -> None:
    """CAM-71: every x of a y, both ends of a rest; the nearest one; none."""
    table = feed()
    up, down = table.inverse(25)
    assert up == pytest.approx(60)
    assert down == pytest.approx(270)
    assert table.nearest(25, 200) == down
    assert table.nearest(25, 160) == up
    rest = table.inverse(50)
    assert rest.min() == pytest.approx(120)
    assert rest.max() == pytest.approx(180)
    assert table.inverse(51).shape == (0,)
    assert table.nearest(51, 0) is None
    for y in np.linspace(0.5, 49.5, 99):
        assert table.at(table.inverse(y)).y == pytest.approx(y)
    with pytest.raises(ValueError, match="y must be a finite number"):
        table.inverse(math.nan)
    with pytest.raises(ValueError, match="near must be a finite number"):
        table.nearest(1, math.inf)


def test_check_against_limits() -> None:
    """CAM-24: velocity and acceleration of the slave as closed forms say, held against the axis; deceleration is the
    smaller one here."""
    limits = Limits.of_axis(MACHINE, "x")
    assert limits == Limits(600, 5000, 400_000, 0, None)
    result = check(feed(), 360.0, limits=limits)
    rise, way = 50, 120
    sine = cam.law_factors("modified_sine")
    by_name = {peak.what: peak for peak in result.peaks}
    assert by_name["velocity"].value == pytest.approx(sine.velocity * rise / way * 360)
    assert by_name["acceleration"].value == pytest.approx(sine.acceleration * rise / way**2 * 360**2)
    assert by_name["jerk"].value == pytest.approx(sine.jerk * rise / way**3 * 360**3)
    assert by_name["lowest position"].passed
    assert result.passed
    assert result.fastest is not None
    expected = way * min(
        600 / sine.velocity / rise,
        (5000 / sine.acceleration / rise) ** (1 / 2),
        (400_000 / sine.jerk / rise) ** (1 / 3),
    )
    assert result.fastest.value == pytest.approx(expected)
    assert check(feed(), result.fastest.value, limits=limits).passed
    assert not check(feed(), result.fastest.value * 1.001, limits=limits).passed
    with pytest.raises(ConfigError, match="expected an axis of line, x, found 'z'"):
        Limits.of_axis(MACHINE, "z")


def test_continuity() -> None:
    """CAM-03: the largest jumps and their places; over the seam, too."""
    limits = Limits(1e9, 1e9, 1e9)
    saw = check(cam.of_machine(MACHINE)[0], 1.0, limits=limits)
    assert saw.jump_of_velocity == (180, pytest.approx(1 / 3))
    assert saw.continuity == "the velocity jumps, by 0.333333 at x 180"
    assert not saw.passed
    assert saw.fastest is None
    parabola = [{"to": {"x": 2, "y": 1}, "law": "parabola"}, {"to": {"x": 5, "y": 1}, "law": "dwell"}]
    for cyclic in (False, True):
        hard = check(cam.Table.from_segments(parabola, cyclic=cyclic), 1.0, limits=limits)
        assert hard.jump_of_velocity is None
        assert hard.jump_of_acceleration == (1, pytest.approx(2))
        assert not hard.passed
    seam = [{"to": {"x": 2, "y": 1}, "law": "line"}, {"to": {"x": 5, "y": 3}, "law": "line"}]
    assert check(cam.Table.from_segments(seam, cyclic=True)).jump_of_velocity == (2, pytest.approx(1 / 6))
    assert check(cam.Table.from_segments(seam[:1], cyclic=True)).jump_of_velocity is None
    assert check(feed()).continuity == "position, velocity and acceleration have no jump"


@settings(deadline=None)
@given(st.integers(2, 3000), st.integers(0, 1000), st.booleans())
def test_smooth_points_have_no_jumps(count: int, seed: int, cyclic: bool) -> None:
    """CAM-01: quintic cams through random points; rounding is not told as a jump."""
    random = np.random.default_rng(seed)
    x = np.cumsum(random.uniform(0.1, 10, count))
    y = np.cumsum(random.normal(size=count))
    result = check(cam.Table.from_points(x, y, cyclic=cyclic))
    assert result.continuity == "position, velocity and acceleration have no jump"


@pytest.mark.parametrize("interpolation", ["quintic", "monotone"])
@pytest.mark.parametrize("given", [0, 2])
@pytest.mark.parametrize("extra", [{"v": 1.0}, {"a": 0.05}, {"v": 1.0, "a": 0.05}])
def test_one_end_of_a_cyclic_cam_gives_the_other(interpolation: str, given: int, extra: dict[str, float]) -> None:
    """CAM-01, CAM-03: first and last point are one, so a number given for one holds for both."""
    points: list[dict[str, float]] = [{"x": 0, "y": 0}, {"x": 50, "y": 20}, {"x": 100, "y": 100}]
    points[given] |= extra
    table = cam.Table.from_dict({"name": "c", "cyclic": True, "interpolation": interpolation, "points": points})
    for at in (table.at(0.0), table.at(100.0)):
        for key, value in extra.items():
            assert {"v": at.dy, "a": at.ddy}[key] == pytest.approx(value)
