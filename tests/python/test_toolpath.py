"""Paths from G-code, SVG and CSV (GR-20, GR-24) and the command `takt path`."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from takt import checks, toolpath
from takt.cli import main
from takt.gcode import parse_gcode
from takt.recording import Recording
from takt.svg import read_svg
from takt.toolpath import Element, Toolpath, ToolpathError

EXAMPLE = Path(__file__).parents[2] / "python/examples/delta_cell"


def ends(path: Toolpath) -> list[tuple[float, float, float]]:
    return [one.end for one in path.elements]


def wrong(text: str) -> str:
    with pytest.raises(ToolpathError) as error:
        parse_gcode(text, source="x.nc")
    return str(error.value)


# --- G-code: lines ---


def test_lines_and_feeds() -> None:
    path = parse_gcode("G0 Z5\nG1 X10 F600 ; cut\nY20\nG0 X0\nG1 Y0\nF1200 X1\n")
    assert ends(path) == [(0, 0, 5), (10, 0, 5), (10, 20, 5), (0, 20, 5), (0, 0, 5), (1, 0, 5)]
    assert [one.velocity for one in path.elements] == [None, 10, 10, None, 10, 20]
    assert not path.left_out


def test_a_line_without_a_feed_has_none() -> None:
    assert parse_gcode("G1 X1").elements == (Element((1, 0, 0)),)


def test_inches() -> None:
    """Of the ends, the centres and the feed, inch/min."""
    path = parse_gcode("G20 G1 X1 F60\nG3 X2 Y1 J1\nG21 G1 X0 F60")
    assert path.elements[0] == Element((25.4, 0, 0), None, 25.4)
    assert path.elements[1].end == pytest.approx((50.8, 25.4, 0))
    assert path.at[2] - path.at[1] == pytest.approx(25.4 * math.pi / 2)
    assert path.elements[2] == Element((0, path.elements[1].end[1], 0), None, 1)


def test_relative_and_absolute() -> None:
    path = parse_gcode("G91 G1 X1 Y1\nX1\nG90 X10\nG91 Z-1", start=(5, 6, 7))
    assert ends(path) == [(6, 7, 7), (7, 7, 7), (10, 7, 7), (10, 7, 6)]


def test_notation() -> None:
    """Numbers of lines, small letters, blanks, comments, codes with leading zeros, more than one code in a line."""
    path = parse_gcode("%\n(G1 X99)\nN10 g00 g90 x 1. y-.5\nN20 G01X+2(there; and)Y3 ; G1 X99\n\nM30\nG1 X99\n")
    assert ends(path) == [(1, -0.5, 0), (2, 3, 0)]


def test_moves_to_where_the_tool_is_are_none() -> None:
    assert parse_gcode("G1 X0\nX1\nX1 Y0\nG4 P1").elements == (Element((1, 0, 0)),)


def test_what_says_nothing_about_the_path_is_left_out_and_said() -> None:
    path = parse_gcode("G40 G49 G54 G80\nM3 S1000\nT1 M6\nG1 X1 H2\nG4 P2\nM5\nM3")
    assert ends(path) == [(1, 0, 0)]
    assert path.left_out == ("M3 (2 times)", "S (1 time)", "M6 (1 time)", "T (1 time)", "H (1 time)", "G4 (1 time)",
                             "M5 (1 time)")  # fmt: skip


# --- G-code: arcs ---


@pytest.mark.parametrize(
    ("plane", "word", "begin", "end", "via"),
    [
        ("G17", "X0 Y10 I-10", (10, 0, 0), (0, 10, 0), (1, 1, 0)),
        ("G18", "Z0 X10 K-10", (0, 0, 10), (10, 0, 0), (1, 0, 1)),
        ("G19", "Y0 Z10 J-10", (0, 10, 0), (0, 0, 10), (0, 1, 1)),
    ],
)
def test_a_quarter_counterclockwise_in_each_plane(
    plane: str, word: str, begin: toolpath.Point, end: toolpath.Point, via: toolpath.Point
) -> None:
    """As seen from the third axis: X to Y, Z to X, Y to Z."""
    path = parse_gcode(f"{plane} G3 {word}", start=begin)
    (arc,) = path.elements
    assert arc.end == end
    assert arc.via == pytest.approx([10 / math.sqrt(2) * one for one in via])
    assert path.length == pytest.approx(5 * math.pi)
    # Clockwise the other three quarters, in two arcs.
    other = parse_gcode(f"{plane} G2 {word}", start=begin)
    assert len(other.elements) == 2
    assert other.length == pytest.approx(15 * math.pi)
    assert other.end == end


def test_whole_turns() -> None:
    path = parse_gcode("G2 I5 F60")
    assert len(path.elements) == 2
    assert path.length == pytest.approx(10 * math.pi)
    assert path.end == (0, 0, 0)
    assert path.extents == pytest.approx(np.array([[0, -5, 0], [10, 5, 0]]))
    assert path.elements[0].via == pytest.approx((5, 5, 0))  # clockwise from the left end: up first
    assert parse_gcode("G2 X0 Y0 I5 P3").length == pytest.approx(30 * math.pi)
    assert parse_gcode("G3 X10 I5 P2").length == pytest.approx(15 * math.pi)


@pytest.mark.parametrize(
    ("motion", "radius", "via", "length"),
    [
        ("G3", 10, (10 - 10 * math.cos(math.pi / 4), 10 * (1 - math.sin(math.pi / 4))), 5 * math.pi),
        ("G2", 10, (10 * math.cos(math.pi / 4), 10 * math.sin(math.pi / 4)), 5 * math.pi),
        ("G3", -10, None, 15 * math.pi),
        ("G2", -10, None, 15 * math.pi),
    ],
)
def test_arcs_by_radius(motion: str, radius: float, via: tuple[float, float] | None, length: float) -> None:
    """From (0, 10) to (10, 0): the short way bends towards the zero or away from it."""
    begin = (0.0, 10.0, 0.0)
    path = parse_gcode(f"{motion} X10 Y0 R{radius}", start=begin)
    assert path.length == pytest.approx(length)
    assert path.end == (10, 0, 0)
    if via:
        assert path.elements[0].via == pytest.approx((*via, 0))


def test_half_a_turn_by_radius() -> None:
    path = parse_gcode("G2 X10 R5")
    assert path.elements[0].via == pytest.approx((5, 5, 0))
    assert path.length == pytest.approx(5 * math.pi)


def test_centres_absolute() -> None:
    path = parse_gcode("G90.1 G3 X0 Y10 I0 J0\nG91.1 X-10 Y0 J-10", start=(10, 0, 0))
    assert path.length == pytest.approx(10 * math.pi)
    assert path.extents == pytest.approx(np.array([[-10, 0, 0], [10, 10, 0]]))


def test_relative_arcs_in_inches() -> None:
    path = parse_gcode("G20 G91 G3 X-1 Y1 I-1", start=(25.4, 0, 3))
    assert path.end == pytest.approx((0, 25.4, 3))
    assert path.length == pytest.approx(25.4 * math.pi / 2)


def test_helices_become_chords_within_the_tolerance() -> None:
    """Each point of a chord is beside the helix by at most the tolerance, and ends lie on it, at an even rise."""
    for tolerance in (0.1, 0.01):
        path = parse_gcode("G3 X0 Y10 Z6 I-10 P2 F60", start=(10, 0, 1), tolerance=tolerance)
        points = np.array(ends(path))
        angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]) % (2 * math.pi))
        assert angle[-1] == pytest.approx(2.5 * math.pi)
        assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(10)
        assert points[:, 2] == pytest.approx(1 + 5 * angle / angle[-1])
        everywhere, _ = path.points(0.05)
        inside = 10 - np.hypot(everywhere[:, 0], everywhere[:, 1])
        assert 0.5 * tolerance < inside.max() <= tolerance
        assert {one.velocity for one in path.elements} == {1.0}


def test_small_errors_of_the_centre_are_taken() -> None:
    path = parse_gcode("G3 X0 Y10.003 I-10 J0", start=(10, 0, 0))
    assert path.end == (0, 10.003, 0)
    assert path.length == pytest.approx(5 * math.pi, rel=1e-3)


# --- G-code: what is wrong ---


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G1 X1\nG1 Xa", "x.nc:2: expected a letter and a number, found 'XA'"),
        ("G1 X1 (open", "x.nc:1: expected a letter and a number, found '(OPEN'"),
        ("G1 X1.2.3", "x.nc:1: expected a letter and a number, found '.3'"),
        ("G1 X", "x.nc:1: expected a letter and a number, found 'X'"),
        ("G1 X1 X2", "x.nc:1: X is given twice"),
        ("G0 G1 X1", "x.nc:1: G0 and G1 exclude each other in one line"),
        ("G90 G91", "x.nc:1: G90 and G91 exclude each other in one line"),
        ("\nX1", "x.nc:2: expected G0, G1, G2 or G3 before X"),
        ("G1 X1\nG80\nX2", "x.nc:3: expected G0, G1, G2 or G3 before X"),
        ("G41 D1", "x.nc:1: G41 is not read: a radius of the tool is not known (--leave-out G41 leaves it out)"),
        ("G1 A90", "x.nc:1: A is not read: no rotary axis is known (--leave-out A leaves it out)"),
        ("G1 X1 I2", "x.nc:1: I is not read but with G2 and G3"),
        ("G1 X1 F0", "x.nc:1: F: expected a number above 0"),
        ("G2 X1", "x.nc:1: expected I, J or R for an arc"),
        ("G18 G2 X1", "x.nc:1: expected K, I or R for an arc"),
        ("G2 X1 I1 R1", "x.nc:1: R and I, J exclude each other"),
        ("G2 X1 K1", "x.nc:1: K is not in the plane of G17"),
        ("G2 X10 R4", "x.nc:1: R: the ends of the arc are 10 mm apart, too far for a radius of 4 mm"),
        ("G2 X0 Y0 R4", "x.nc:1: an arc by R must end elsewhere than it begins; use I, J, K for whole turns"),
        ("G2 X10 I4", "x.nc:1: the arc begins 4 mm from its centre, but ends 6 mm from it"),
        ("G2 X10 I0 J0", "x.nc:1: the centre of the arc is where it begins"),
        ("G90.1 G2 X10 I5", "x.nc:1: expected both I and J after G90.1"),
        ("G2 I5 P1.5", "x.nc:1: P: expected a whole number of turns from 1 on, found 1.5"),
        ("G2 I5 P0", "x.nc:1: P: expected a whole number of turns from 1 on, found 0"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(text: str, said: str) -> None:
    assert wrong(text) == said


# --- Paths ---


def some_path() -> Toolpath:
    return parse_gcode(
        "G0 Z5\nG0 X20 Y5\nG1 Z0 F600\nX40\nG3 X50 Y15 J10\nG2 X70 Y35 R20\nG19 G3 Y15 Z0 J-10\nG17 G2 I-5 F300\n"
        "G1 X0 Y0 Z1.5",
        start=(1, 2, 3),
    )


def test_the_way_along_a_path() -> None:
    """Points lie on it, no further apart than asked for, as far along it as they say, and turn nowhere."""
    path = some_path()
    points, ways = path.points(0.1)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert tuple(points[0]) == path.start
    assert tuple(points[-1]) == pytest.approx(path.end)
    assert np.all(steps <= np.diff(ways) + 1e-12)
    assert np.diff(ways).max() <= 0.1 + 1e-12
    assert np.sum(steps) == pytest.approx(path.length, rel=1e-5)
    assert ways[-1] == pytest.approx(path.length)
    low, high = path.extents
    assert np.all(points >= low - 1e-9)
    assert np.all(points <= high + 1e-9)
    assert points.min(axis=0) == pytest.approx(low, abs=1e-3)
    assert points.max(axis=0) == pytest.approx(high, abs=1e-3)


def test_followed_exactly_and_beside() -> None:
    path = some_path()
    points, ways = path.points(0.1)
    on = path.follow(points)
    assert on.distance.max() < 1e-9
    assert on.position == pytest.approx(ways, abs=1e-6)
    lifted = path.follow(parse_gcode("G1 X100", start=(0, 0.03, 0.04)).points(0.5)[0])
    assert lifted.distance.min() > 0
    straight = parse_gcode("G1 X100").follow(np.array([[x, 0.03, 0.04] for x in np.linspace(0, 100, 500)]))
    assert straight.distance == pytest.approx(0.05)


def test_a_path_that_crosses_itself_is_followed_in_order() -> None:
    """What leaves the loop out is beside the path, though it touches it where the path crosses itself."""
    loop = parse_gcode("G1 X50\nG3 I0 J20\nG1 X100")
    shortcut = parse_gcode("G1 X100")
    assert loop.follow(loop.points(0.2)[0]).distance.max() < 1e-9
    assert loop.follow(shortcut.points(0.2)[0]).distance.max() > 10


@pytest.mark.parametrize("step", [0.01, 0.2, 1.0])
@pytest.mark.parametrize(
    "code",
    ["G1 X20\nG1 X0", "G1 X15\nG1 X0\nG1 Y30", "G1 Z-5\nG1 Z0\nG1 X30", "G1 X10\nG1 X0\nG1 X10\nG1 X0\nG1 Y5"],
)
def test_a_path_that_goes_back_over_itself_is_followed_in_order(code: str, step: float) -> None:
    path = parse_gcode(code)
    points, ways = path.points(step)
    on = path.follow(points)
    assert on.distance.max() < 1e-9
    assert on.position == pytest.approx(ways, abs=2 * toolpath.SLACK)  # where it turns both ways are as near
    assert on.position[-1] == pytest.approx(path.length)
    noise = np.random.default_rng(1).normal(0, 0.01, points.shape)
    on = path.follow(points + noise)
    assert on.distance.max() < 0.1
    assert on.position[-1] == pytest.approx(path.length, abs=0.1)


@given(
    st.lists(st.tuples(st.integers(-20, 20), st.integers(-20, 20), st.booleans()), min_size=2, max_size=6),
    st.lists(st.tuples(st.floats(0, 1), st.integers(3, 40)), max_size=3),
)
def test_property_points_on_a_path_are_found_on_it(
    moves: list[tuple[int, int, bool]], cuts: list[tuple[float, int]]
) -> None:
    """Lines, also back over the line before, with holes: nothing is said to be off the path that is on it."""
    ends = [(0.0, 0.0, 0.0)]
    for x, y, back in moves:
        end = ends[-2] if back and len(ends) > 1 else (float(x), float(y), 0.0)
        if math.dist(end, ends[-1]) > 0.5:
            ends.append(end)
    assume(len(ends) > 1)
    path = Toolpath(ends[0], tuple(Element(end) for end in ends[1:]))
    points, _ = path.points(0.2)
    kept = np.ones(len(points), bool)
    for share, many in cuts:
        first = 1 + int(share * (len(points) - 2))
        kept[first : min(first + many, len(points) - 1)] = False
    assume(np.median(np.diff(np.flatnonzero(kept))) == 1)
    on = path.follow(points[kept], time_s=0.001 * np.flatnonzero(kept))
    assert on.distance.max() < 1e-6
    assert on.position[-1] == pytest.approx(path.length)


@pytest.mark.parametrize("times", [[0, 1], [0, 2, 1], [0, 1, 1], [0, 1, math.nan], [[0, 1, 2]], 3])
def test_times_of_points_that_are_none(times: object) -> None:
    with pytest.raises(ValueError, match="time_s: expected 3 rising numbers, one for each point"):
        parse_gcode("G1 X2").follow([[0, 0, 0], [1, 0, 0], [2, 0, 0]], time_s=times)


@pytest.mark.parametrize("seed", range(12))
def test_where_samples_are_missing_the_path_is_followed_on(seed: int) -> None:
    """Holes of up to 60 samples, 12 mm of the way: round corners and arcs, and over places where it crosses itself."""
    rng = np.random.default_rng(seed)
    path = toolpath.read(EXAMPLE / "drawing.gcode", (0, 0, 4))
    points, _ = path.points(0.2)
    kept = np.ones(len(points), bool)
    for first in rng.integers(1, len(points) - 100, 40):
        kept[first : first + rng.integers(5, 60)] = False
    times = 0.001 * np.arange(len(points))[kept]
    on = path.follow(points[kept], time_s=times)
    assert on.distance.max() < 1e-6
    assert on.position[-1] == pytest.approx(path.length)


def test_who_leaves_out_a_loop_cannot_say_that_samples_are_missing() -> None:
    """In the time of a hole no more of the path counts as gone than is possible."""
    loop = parse_gcode("G1 X50\nG3 I0 J20\nG1 X100")
    points = parse_gcode("G1 X100").points(0.2)[0]
    times = 0.001 * np.arange(len(points))
    hole = np.abs(points[:, 0] - 50) > 3
    assert loop.follow(points[hole], time_s=times[hole]).distance.max() > 10
    there = loop.points(0.2)[0]
    turned = np.concatenate([there[:240], there[-240:]])  # in the time of the turn nothing was heard
    times = 0.001 * np.concatenate([np.arange(240), np.arange(len(there) - 240, len(there))])
    assert loop.follow(turned, time_s=times).distance.max() < 1e-9
    assert loop.follow(turned).distance.max() > 10


def test_nearest_place_of_an_arc() -> None:
    """Beyond the ends of an arc they are the nearest places, each on its side."""
    arc = parse_gcode("G3 X0 Y10 I-10", start=(10, 0, 0))
    near = arc.follow(np.array([[10, -1, 0], [12, 12, 0], [-1, 10, 0]]), slack=20)
    assert near.distance == pytest.approx([1, math.hypot(12, 12) - 10, 1])
    assert near.position == pytest.approx([0, 2.5 * math.pi, 5 * math.pi])


@given(
    st.lists(
        st.tuples(st.floats(-50, 50), st.floats(-50, 50), st.floats(-50, 50), st.booleans(), st.floats(0.2, 3.0)),
        min_size=1,
        max_size=8,
    )
)
def test_property_points_of_any_path_lie_on_it(moves: list[tuple[float, float, float, bool, float]]) -> None:
    here, elements = np.zeros(3), []
    for x, y, z, is_arc, bend in moves:
        end = np.array([x, y, z])
        if np.linalg.norm(end - here) < 0.1:
            continue
        side = np.cross(end - here, [0.3, -0.5, 0.8])
        is_arc &= bool(np.linalg.norm(side) > 0.05 * np.linalg.norm(end - here))
        via = (here + end) / 2 + bend * side / 2 if is_arc else None
        elements.append(Element(tuple(end), None if via is None else tuple(via)))
        here = end
    path = Toolpath((0, 0, 0), tuple(elements))
    points, ways = path.points(1.0)
    assert np.linalg.norm(points[-1] - here) < 1e-6
    for first, last, element in zip(path.at[:-1], path.at[1:], path.elements, strict=True):
        on = points[(ways >= first) & (ways <= last)]
        if element.via is not None:
            part = Toolpath(tuple(on[0]), (element,))
            assert part.follow(on, slack=1e9).distance.max() < 1e-6
            assert part.follow(np.array([element.via]), slack=1e9).distance.max() < 1e-6


def test_csv_there_and_back(tmp_path: Path) -> None:
    path = some_path()
    again = Toolpath.from_csv(path.to_csv(tmp_path / "path.csv"), path.start)
    assert np.array(ends(again)) == pytest.approx(np.array(ends(path)), abs=1e-7)
    assert again.length == pytest.approx(path.length)
    assert [one.velocity for one in again.elements] == [one.velocity for one in path.elements]
    assert toolpath.read(tmp_path / "path.csv").elements == again.elements


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x,y\n1,2\n", ":1: expected the columns x, y, z"),
        ("x,y,z,v\n1,2,3,4\n", ":1: expected the columns x, y, z"),
        ("x,y,z\n1,2,\n", ":2: z: expected a number, found ''"),
        ("x,y,z\n1,2,nan\n", ":2: z: expected a number, found 'nan'"),
        ("shape,x,y,z\nspline,1,2,3\n", ":2: shape: expected line or arc, found 'spline'"),
        ("shape,x,y,z\narc,1,2,3\n", ":2: via_x: expected a number, found ''"),
        ("shape,x,y,z,via_x,via_y,via_z\narc,2,0,0,1,0,0\n", ": element 1: the three points of an arc lie on a line"),
        ("x,y,z\n1,0,0\n1,0,0\n", ": element 2: has no length"),
    ],
)
def test_bad_csv(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "path.csv").write_text(text)
    with pytest.raises(ToolpathError) as error:
        toolpath.read(tmp_path / "path.csv")
    assert said in str(error.value)


def test_as_the_machine_file_has_it() -> None:
    path = parse_gcode("G1 X10 F60\nG3 X0 Y10 I-10 J0")
    assert path.to_elements() == [
        {"shape": "line", "to": {"x": 10, "y": 0, "z": 0}, "velocity": 1},
        {
            "shape": "arc",
            "to": {"x": 0, "y": 10, "z": 0},
            "via_x": pytest.approx(10 / math.sqrt(2)),
            "via_y": pytest.approx(10 / math.sqrt(2)),
            "via_z": 0,
            "velocity": 1,
        },
    ]


def test_elsewhere() -> None:
    path = some_path()
    moved = path.shifted(1, 2, -800)
    assert moved.extents == pytest.approx(path.extents + np.array([1, 2, -800]))
    assert moved.length == pytest.approx(path.length)


# --- SVG ---

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="50mm" viewBox="0 0 1000 500">
<g transform="translate(100 0)"><circle cx="100" cy="100" r="50"/></g>
<path d="M10 490 L 110 490 V 390"/>
<text x="1" y="2">hello</text></svg>"""


def test_svg(tmp_path: Path) -> None:
    """mm from the lower left corner, groups with their transforms; between two lines the pen is up."""
    (tmp_path / "a.svg").write_text(DRAWING)
    path = read_svg(tmp_path / "a.svg", start=(0, 0, 5), velocity=20)
    drawn = [one for one in path.elements if one.velocity is not None]
    arcs = [one for one in path.elements if one.via]
    assert len(arcs) == 4
    assert sum(5 * math.pi / 2 for _ in arcs) == pytest.approx(5 * math.pi * 2)
    for one in arcs:
        assert one.via is not None
        assert math.dist(one.via, (20, 40, 0)) == pytest.approx(5, abs=1e-6)
    assert drawn[-2].end == pytest.approx((11, 1, 0))
    assert drawn[-1].end == pytest.approx((11, 11, 0))
    assert path.end == pytest.approx((11, 11, 5))
    lifted = [one.end for one in path.elements if one.end[2] == 5]
    assert np.array(lifted) == pytest.approx(np.array([[25, 40, 5], [25, 40, 5], [1, 1, 5], [11, 11, 5]]))
    assert path.left_out == ("text",)


@pytest.mark.parametrize("tolerance", [0.1, 0.01])
def test_curves_of_svg_keep_the_tolerance(tmp_path: Path, tolerance: float) -> None:
    """Béziers and an ellipse beside their own formulas."""
    t = np.linspace(0, 1, 20_000)[:, np.newaxis]
    turn = 2 * math.pi * t
    curves = {
        '<path d="M0 100 C 30 0 70 0 100 100"/>': np.hstack(
            [90 * t * (1 - t) ** 2 + 210 * t**2 * (1 - t) + 100 * t**3, 300 * t * (1 - t)]
        ),
        '<path d="M0 100 Q 50 0 100 100"/>': np.hstack([100 * t, 200 * t * (1 - t)]),
        '<ellipse cx="50" cy="50" rx="40" ry="10"/>': np.hstack([50 + 40 * np.cos(turn), 50 - 10 * np.sin(turn)]),
    }
    for shape, curve in curves.items():
        (tmp_path / "a.svg").write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">{shape}</svg>'
        )
        path = read_svg(tmp_path / "a.svg", (curve[0, 0], curve[0, 1], 0.0), tolerance)
        away = path.follow(np.pad(curve, ((0, 0), (0, 1)))).distance
        assert 0.3 * tolerance < away.max() <= tolerance, shape


def test_bad_svg(tmp_path: Path) -> None:
    (tmp_path / "a.svg").write_text("<svg")
    with pytest.raises(ToolpathError, match=r"a\.svg: is no SVG"):
        toolpath.read(tmp_path / "a.svg")


# --- The command ---


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("part.nc").write_text("G0 Z5\nG1 X30 Y40 F600\nG3 X30 Y40 I0 J10\nM5\n")
    assert main(["path", "part.nc", "--start", "0", "0", "5", "--csv", "part.csv", "--plot", "part.png"]) == 0
    text = capsys.readouterr().out
    assert "part.nc: 1 line and 2 arcs, 112.832 mm" in text
    assert "velocities: 10 mm/s" in text
    assert "left out: M5 (1 time)" in text
    assert "elements: part.csv\npicture: part.png\n" in text
    assert Path("part.png").read_bytes().startswith(b"\x89PNG")
    assert Path("part.csv").read_text().splitlines()[:2] == [
        "shape,x,y,z,via_x,via_y,via_z,velocity",
        "line,30,40,5,,,,10",
    ]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["bad.nc"], "bad.nc:2: G41 is not read"),
        (["none.nc"], "none.nc: No such file or directory"),
        (["part.txt"], "part.txt: expected a file of G-code (.gcode, .nc, .ngc, .tap), .svg or .csv"),
        (["binary.nc"], "binary.nc: is no text"),
        (["bad.nc", "--tolerance", "0"], "--tolerance: expected a number of mm above 0"),
        (["bad.nc", "--plot", "a.gif"], "a.gif: expected a name that ends in .png"),
        (["bad.nc", "--csv", "no/a.csv"], "no/a.csv: there is no directory no"),
    ],
)
def test_command_with_bad_input(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("bad.nc").write_text("G1 X1\nG41 D1\n")
    Path("binary.nc").write_bytes(b"\xff\xfe\x00")
    assert main(["path", *arguments]) == 2
    assert said in capsys.readouterr().err


def test_an_empty_program(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.nc").write_text("(nothing)\n")
    assert main(["path", str(tmp_path / "a.nc"), "--plot", str(tmp_path / "a.png")]) == 0
    assert "0 lines and 0 arcs, 0 mm" in capsys.readouterr().out


# --- The example ---


def test_the_drawing_of_the_delta_cell() -> None:
    """At least 5,000 points with all four motions; its CSV is what `takt path` makes of it."""
    text = (EXAMPLE / "drawing.gcode").read_text()
    for code in ("G0", "G1", "G2", "G3"):
        assert f"\n{code} " in text
    path = toolpath.read(EXAMPLE / "drawing.gcode", (0, 0, 4))
    assert len(path.elements) >= 5000
    assert Toolpath.from_csv(EXAMPLE / "drawing.csv", (0, 0, 4)).length == pytest.approx(path.length)


# --- How a group keeps to a path ---


def recording_of(points: np.ndarray, actual: np.ndarray | None = None) -> Recording:
    columns = {"time_s": 0.001 * np.arange(len(points))}
    for i, axis in enumerate("xyz"):
        columns[axis] = points[:, i]
        columns[f"actual_{axis}"] = (points if actual is None else actual)[:, i]
    return Recording({"robot": columns}, {"robot": dict.fromkeys([*"xyz", "actual_x", "actual_y", "actual_z"], "mm")})


def test_follows_path() -> None:
    path = some_path()
    points, _ = path.points(0.3)
    verdict = checks.follows_path(recording_of(points), "robot", path, 0.05)
    assert verdict.passed
    assert f"over {path.length:.6g} mm" in verdict.sentence
    assert verdict.by_how_much == pytest.approx(0.05)

    beside = points.copy()
    beside[100] += [0, 0, 0.08]
    verdict = checks.follows_path(recording_of(beside), "robot", path, 0.05)
    assert not verdict.passed
    assert verdict.by_how_much == pytest.approx(0.03, abs=1e-3)
    assert verdict.when_s == pytest.approx(0.1)
    assert checks.follows_path(recording_of(points, beside), "robot", path, 0.05).passed
    assert not checks.follows_path(recording_of(points, beside), "robot", path, 0.05, actual=True).passed


def test_follows_path_all_the_way() -> None:
    path = some_path()
    points, _ = path.points(0.3)
    verdict = checks.follows_path(recording_of(points[:-5]), "robot", path, 0.05)
    assert not verdict.passed
    assert verdict.sentence.startswith("ended ")
    verdict = checks.follows_path(recording_of(points[3:]), "robot", path, 0.05)
    assert verdict.sentence.startswith("began ")
    assert not verdict.passed
    with pytest.raises(ValueError, match="within"):
        checks.follows_path(recording_of(points), "robot", path, 2.0)
