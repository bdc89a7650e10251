"""DXF drawings as tracks (PY-22, EN-37): where CAD shows them, or an error with the entity's name."""

from __future__ import annotations

import cmath
import contextlib
import math
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from takt.cli import main
from takt.errors import TaktError
from takt.track_drawing import read_drawing

ezdxf = pytest.importorskip("ezdxf")
DOWN = {"extrusion": (0, 0, -1)}
Draw = Callable[[Any, Any], object]


def read(directory: Path, draw: Draw, corner: float = 0.001) -> tuple[list[dict[str, Any]], tuple[str, ...]]:
    """The tracks, and what was left out."""
    document = ezdxf.new("R2010")
    document.units = 4
    draw(document.modelspace(), document)
    document.saveas(directory / "a.dxf")
    drawing = read_drawing(directory / "a.dxf", corner)
    return yaml.safe_load(drawing.tracks)["tracks"], drawing.left_out


def wrong(directory: Path, draw: Draw) -> str:
    with pytest.raises(TaktError) as error:
        read(directory, draw)
    return str(error.value).removeprefix(str(directory) + "/")


def place(point: dict[str, float]) -> complex:
    return complex(point["x"], point["y"])


def middle(element: dict[str, Any]) -> complex:
    """Half-way along an element."""
    begin, end = place(element["from"]), place(element["to"])
    if "center" not in element:
        return (begin + end) / 2
    centre = place(element["center"])
    sweep = cmath.phase((end - centre) / (begin - centre)) % (2 * math.pi) or 2 * math.pi
    sweep = sweep - 2 * math.pi if element["clockwise"] and sweep < 2 * math.pi else sweep
    return centre + (begin - centre) * cmath.exp(0.5j * sweep)


# --- Coordinates of entities ---


@pytest.mark.parametrize(
    ("draw", "begin", "half", "end"),
    [
        (lambda m: m.add_arc((20, 10), 5, 0, 90), 25 + 10j, 20 + 10j + 5 * cmath.exp(0.25j * math.pi), 20 + 15j),
        (
            lambda m: m.add_arc((20, 10), 5, 0, 90, dxfattribs=DOWN),
            -25 + 10j, -20 + 10j + 5 * cmath.exp(0.75j * math.pi), -20 + 15j,
        ),
        (lambda m: m.add_arc((0, 0), 5, 350, 10), cmath.rect(5, -math.pi / 18), 5, cmath.rect(5, math.pi / 18)),
        (lambda m: m.add_lwpolyline([(0, 0, 1), (0, 8, 0)], format="xyb"), 0, 4 + 4j, 8j),
        (lambda m: m.add_lwpolyline([(0, 0, -1), (0, 8, 0)], format="xyb"), 0, -4 + 4j, 8j),
        (lambda m: m.add_lwpolyline([(0, 0, 1), (0, 8, 0)], format="xyb", dxfattribs=DOWN), 0, -4 + 4j, 8j),
        (lambda m: m.add_polyline2d([(1, 0, 1), (1, 8, 0)], format="xyb", dxfattribs=DOWN), -1, -5 + 4j, -1 + 8j),
        (lambda m: m.add_polyline3d([(1, 2, 3), (4, 6, 3)]), 1 + 2j, 2.5 + 4j, 4 + 6j),
        (lambda m: m.add_line((1, 2, 7), (4, 6, 7)), 1 + 2j, 2.5 + 4j, 4 + 6j),
        (lambda m: m.add_ellipse((0, 0), (5, 0), 1, 0, math.pi / 2), 5, None, 5j),
    ],
)  # fmt: skip
def test_where_entities_lie(
    tmp_path: Path, draw: Callable[[Any], object], begin: complex, half: complex | None, end: complex
) -> None:
    (track,), left_out = read(tmp_path, lambda m, _: draw(m))
    elements = track["elements"]
    ends = [place(elements[0]["from"]), place(elements[-1]["to"])]
    halves = [middle(one) for one in elements] if half is not None else []
    if abs(ends[0] - begin) > abs(ends[1] - begin):
        ends.reverse()
    assert ends == pytest.approx([begin, end], abs=1e-9)
    assert halves == ([pytest.approx(half, abs=1e-9)] if half is not None else [])
    assert not left_out


@pytest.mark.parametrize("draw", [
    lambda m: m.add_circle((-70, 5), 3, dxfattribs=DOWN), lambda m: m.add_arc((70, 5), 3, 0, 360),
    lambda m: m.add_arc((70, 5), 3, 90, 450),
    lambda m: m.add_lwpolyline([(67, 5, 1), (73, 5, 1)], format="xyb", close=True),
])  # fmt: skip
def test_circles(tmp_path: Path, draw: Callable[[Any], object]) -> None:
    (track,), _ = read(tmp_path, lambda m, _: draw(m))
    assert track["closed_loop"]
    for element in track["elements"]:
        assert place(element["center"]) == pytest.approx(70 + 5j)
        assert abs(place(element["from"]) - (70 + 5j)) == pytest.approx(3)


@pytest.mark.parametrize(
    ("attributes", "function"),
    [
        ({}, lambda z: z + 10 + 20j),
        ({"rotation": 30}, lambda z: z * cmath.exp(1j * math.radians(30)) + 10 + 20j),
        ({"xscale": -1}, lambda z: -z.conjugate() + 10 + 20j),
        ({"xscale": 2, "yscale": 2}, lambda z: 2 * z + 10 + 20j),
    ],
)
def test_blocks(tmp_path: Path, attributes: dict[str, float], function: Callable[[complex], complex]) -> None:
    """An arc and the line that goes on at its end, in a block within a block."""

    def draw(model: Any, document: Any) -> None:
        inner = document.blocks.new("INNER")
        inner.add_arc((0, 0), 5, 0, 90)
        inner.add_line((-4, 5), (0, 5))
        document.blocks.new("OUTER").add_blockref("INNER", (0, 0))
        model.add_blockref("OUTER", (10, 20), dxfattribs=attributes)

    (track,), _ = read(tmp_path, draw)
    found = [place(track["elements"][0]["from"]), place(track["elements"][-1]["to"])]
    assert sorted(found, key=abs) == pytest.approx(sorted(map(function, (5 + 0j, -4 + 5j)), key=abs), abs=1e-9)
    arc = next(one for one in track["elements"] if "center" in one)
    assert middle(arc) == pytest.approx(function(5 * cmath.exp(0.25j * math.pi)), abs=0.01)


Insertion = tuple[complex, float, float, float]  # of a block: where, xscale, yscale, rotation in deg


def inserted(point: complex, insertion: Insertion) -> complex:
    at, x, y, rotation = insertion
    return at + complex(point.real * x, point.imag * y) * cmath.exp(1j * math.radians(rotation))


SCALES = st.sampled_from([1.0, 2.0, -1.0, -2.0, 0.5, 3.0])
INSERTIONS = st.tuples(
    st.sampled_from([0j, 30 - 20j]), SCALES, SCALES, st.sampled_from([0.0, 90.0, 180.0, 270.0, 45.0, -30.0, 77.7])
)


def in_blocks(insertions: list[Insertion], add: Callable[[Any], object]) -> Draw:
    """What is added, in a block for each insertion; the last one is the outermost."""

    def draw(model: Any, document: Any) -> None:
        block = document.blocks.new("B0")
        add(block)
        for i, (at, x, y, rotation) in enumerate(insertions):
            outer = model if i == len(insertions) - 1 else document.blocks.new(f"B{i + 1}")
            attributes = {"xscale": x, "yscale": y, "rotation": rotation}
            outer.add_blockref(f"B{i}", (at.real, at.imag), dxfattribs=attributes)

    return draw


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60, deadline=None)
@given(st.lists(INSERTIONS, min_size=1, max_size=4), st.sampled_from(["line", "polyline", "circle", "arc", "bulge"]))
@example([(10 + 0j, 1, 1, 90), (0j, 1, -2, 0)], "line")
@example([(0j, 1, 1, 45), (0j, 3, 1, 0)], "circle")
@example([(0j, 1, 1, 45), (0j, 3, 1, 0)], "bulge")
def test_property_blocks_in_one_another(tmp_path: Path, insertions: list[Insertion], kind: str) -> None:
    """PY-22: each point is where the insertions, one after the other, take it; also turned within stretched."""

    def add(block: Any) -> None:
        if kind == "line":
            block.add_line((10, 0), (100, 50))
        elif kind == "polyline":
            block.add_lwpolyline([(0, 0), (100, 0), (100, 50)])
        elif kind == "circle":
            block.add_circle((20, 10), 40)
        elif kind == "arc":
            block.add_arc((20, 10), 40, 20, 130)
        else:
            block.add_lwpolyline([(0, 0, -1), (0, 80, 0), (50, 80, 0)], format="xyb")

    def there(point: complex) -> complex:
        for one in insertions:
            point = inserted(point, one)
        return point

    tracks, _ = read(tmp_path, in_blocks(insertions, add))
    arc = {"circle": (0, 360), "arc": (20, 130)}.get(kind)
    if kind == "bulge":  # half a circle to the left of the way up, seen from its end
        outline = [complex(-40 * math.sin(t), 40 - 40 * math.cos(t)) for t in np.linspace(0, math.pi, 2000)]
        outline += [complex(x, 80) for x in np.linspace(0, 50, 500)]
    elif arc:
        outline = [20 + 10j + cmath.rect(40, math.radians(angle)) for angle in np.linspace(*arc, 2000)]
    else:
        corners = {"line": [10, 100 + 50j], "polyline": [0, 100, 100 + 50j]}[kind]
        outline = [a + t * (b - a) for a, b in pairwise(corners) for t in np.linspace(0, 1, 500)]
    expected = np.array([there(point) for point in outline])
    found = [
        place(element["from"]) + t * (place(element["to"]) - place(element["from"]))
        for (track,) in [tracks]
        for element in track["elements"]
        if "center" not in element
        for t in (0, 0.5, 1)
    ] + [middle(element) for element in tracks[0]["elements"] if "center" in element]
    step = np.max(np.abs(np.diff(expected)))
    assert max(np.min(np.abs(expected - point)) for point in found) < 0.5 + step
    box = np.array([[np.min(z.real), np.max(z.real), np.min(z.imag), np.max(z.imag)] for z in (expected,)])
    if not any("center" in element for element in tracks[0]["elements"]):
        z = np.array(found)
        assert np.array([z.real.min(), z.real.max(), z.imag.min(), z.imag.max()]) == pytest.approx(box[0], abs=0.6)


def test_clipped_blocks_are_refused(tmp_path: Path) -> None:
    """PY-22: what a block's clip would cut off is not read in silence."""
    from ezdxf.xclip import XClip

    def draw(model: Any, document: Any) -> None:
        in_blocks([(0j, 1, 1, 0)], lambda block: block.add_line((0, 0), (100, 0)))(model, document)
        XClip(model[0]).set_block_clipping_path([(0, -1), (50, 1)])

    assert "of the block 'B0' is clipped, and blocks are read whole" in wrong(tmp_path, draw)


@pytest.mark.parametrize(
    ("unit", "length"),
    [
        *((0, 1), (1, 25.4), (2, 304.8), (8, 25.4e-6), (9, 0.0254), (10, 914.4)),
        *((21, 12e5 / 3937), (22, 1e5 / 3937), (23, 36e5 / 3937), (24, 6336e6 / 3937)),
    ],
)
def test_units(tmp_path: Path, unit: int, length: float) -> None:
    """PY-22: all that $INSUNITS names, those of US surveyors as well."""
    (track,), _ = read(tmp_path, lambda m, d: setattr(d, "units", unit) or m.add_line((0, 0), (10, 0)))
    assert place(track["elements"][0]["to"]) == pytest.approx(10 * length, rel=1e-12, abs=1e-11)


def test_curves_keep_the_tolerance(tmp_path: Path) -> None:
    """An ellipse by its own formula; chords are shortened at their corners."""
    (track,), _ = read(tmp_path, lambda m, _: m.add_ellipse((10, 0), (40, 0), 0.5))
    assert track["closed_loop"]
    for element in track["elements"]:
        z = middle(element) - 10
        assert abs(math.hypot(z.real / 40, z.imag / 20) - 1) * 20 < 0.5
    scaled, _ = read(tmp_path, lambda m, d: setattr(d, "units", 6) or m.add_ellipse((0, 0), (0.04, 0), 0.5))
    assert len(scaled[0]["elements"]) > 8  # metres


# --- What belongs together ---


@given(
    st.permutations(range(6)), st.lists(st.booleans(), min_size=6, max_size=6), st.floats(-0.004, 0.004), st.booleans()
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30, deadline=None)
def test_property_pieces_join_in_any_order_and_sense(
    tmp_path: Path, order: list[int], turned: list[bool], gap: float, closed: bool
) -> None:
    """Lines, an arc and a spline whose ends are less than 0.01 mm apart are one track."""
    corners = [(0, 0), (60, 0), (80, 20), (80, 60), (30, 90), (0, 60)]

    def draw(model: Any, _: Any) -> None:
        for i in order:
            if i == 5 and not closed:
                continue
            (x, y), (u, v) = corners[i], corners[(i + 1) % 6]
            begin, end = (x + gap, y - gap), (u, v)
            if turned[i]:
                begin, end = end, begin
            if i == 2:
                model.add_spline([begin, (70, 40), end])
            else:
                model.add_line(begin, end)

    (track,), left_out = read(tmp_path, draw)
    assert track["closed_loop"] == closed
    assert not left_out
    points = [place(one[key]) for one in track["elements"] for key in ("from", "to")]
    gaps = [abs(points[i + 1] - points[i]) for i in range(1, len(points) - 1, 2)]
    assert max(gaps) < 25


def test_ends_that_are_apart_do_not_join(tmp_path: Path) -> None:
    tracks, _ = read(tmp_path, lambda m, _: (m.add_line((0, 0), (50, 0)), m.add_line((50.02, 0), (99, 0))))
    assert len(tracks) == 2


def test_thousands_of_lines(tmp_path: Path) -> None:
    def draw(model: Any, _: Any) -> None:
        for i in range(4000):
            model.add_line(((i * 1237) % 4000, 0), ((i * 1237) % 4000 + 1, 0))

    begin = time.process_time()
    (track,), _ = read(tmp_path, draw)
    assert time.process_time() - begin < 20
    assert [place(track["elements"][0]["from"]), place(track["elements"][0]["to"])] in ([0, 4000], [4000, 0])


# --- What is left out, and what is refused ---


@pytest.mark.parametrize(
    ("draw", "said"),
    [
        (lambda m, d: m.add_line((5, 5), (5, 5)), "LINE without length"),
        (lambda m, d: m.add_circle((5, 5), 0), "CIRCLE without length"),
        (lambda m, d: m.add_lwpolyline([(3, 3)]), "LWPOLYLINE of one point"),
        (lambda m, d: m.add_lwpolyline([(3, 3), (3, 3)]), "LWPOLYLINE without length"),
        (lambda m, d: m.add_text("a"), "TEXT"),
        (lambda m, d: m.add_mtext("a"), "MTEXT"),
        (lambda m, d: m.add_point((1, 1)), "POINT"),
        (lambda m, d: m.add_hatch(), "HATCH"),
        (lambda m, d: m.add_linear_dim((0, 5), (0, 0), (9, 0)).render(), "DIMENSION"),
        (lambda m, d: m.add_blockref("NONE", (0, 0)), "INSERT of the block 'NONE', which is not in the file"),
        (
            lambda m, d: (d.layers.add("aux").off(), m.add_line((0, 0), (9, 9), dxfattribs={"layer": "AUX"})),
            "what is invisible, or on a layer that is off or frozen",
        ),
        (
            lambda m, d: m.add_line((0, 0), (9, 9), dxfattribs={"invisible": 1}),
            "what is invisible, or on a layer that is off or frozen",
        ),
    ],
)
def test_what_is_left_out_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str], draw: Draw, said: str) -> None:
    tracks, left_out = read(tmp_path, lambda m, d: (draw(m, d), m.add_line((0, 0), (50, 0))))
    assert [[place(one["to"]) for one in track["elements"]] for track in tracks] == [[50]]
    assert left_out == (said,)
    assert main(["track", str(tmp_path / "a.dxf")]) == 0
    assert f"left out: {said}\n" in capsys.readouterr().out
    assert "no lines, polylines, arcs or circles are drawn in it; left out: " + said in wrong(tmp_path, draw)


@pytest.mark.parametrize(
    ("draw", "said"),
    [
        (lambda m, d: m.add_polymesh((3, 3)), "is a mesh; expected lines, arcs and curves"),
        (lambda m, d: m.add_polyface(), "is a mesh"),
        (lambda m, d: triangle(m.add_mesh()), "is a surface or body"),
        (lambda m, d: m.add_3dface([(0, 0), (1, 0), (1, 1)]), "3DFACE #"),
        (lambda m, d: m.add_ray((0, 0), (1, 0)), "RAY #"),
        (lambda m, d: m.add_line((0, 0, 0), (9, 0, 1)), "rises in Z"),
        (lambda m, d: m.add_polyline3d([(0, 0, 0), (9, 0, 1)]), "rises in Z"),
        (lambda m, d: m.add_spline([(0, 0, 0), (3, 3, 3), (9, 0, 0)]), "rises in Z"),
        (lambda m, d: m.add_helix(5, 2, 3), "rises in Z"),
        (lambda m, d: m.add_circle((0, 0), 5, dxfattribs={"extrusion": (1, 0, 0)}), "does not lie in a plane parallel"),
        (lambda m, d: m.add_line((0, 0), (1e300, 0)), "expected numbers up to 1e+08 mm"),
        (lambda m, d: m.add_line((0, 0), (math.nan, 0)), "expected numbers up to 1e+08 mm"),
        (lambda m, d: m.add_circle((0, 0), -100), "has a radius of -100 mm"),
        (lambda m, d: m.add_lwpolyline([(0, 0, 1e300), (9, 0, 0)], format="xyb"), "mm"),
        (lambda m, d: m.add_circle((0, 0), math.inf), "expected numbers up to 1e+08 mm"),
        (lambda m, d: d.header.__setitem__("$INSUNITS", 77), "its unit ($INSUNITS) is 77"),
        (lambda m, d: nested(m, d, 60, 1), "blocks nest deeper than 50"),
        (lambda m, d: nested(m, d, 8, 10), "more than 100,000 entities"),
    ],
)
def test_what_is_refused_is_named(tmp_path: Path, draw: Draw, said: str) -> None:
    begin = time.process_time()
    sentence = wrong(tmp_path, lambda m, d: (m.add_line((0, 0), (50, 0)), draw(m, d)))
    assert sentence.startswith("a.dxf: ")
    assert said in sentence
    assert time.process_time() - begin < 40


def test_tracks_that_cannot_be_made_are_named_as_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-22: by the entity and its handle, or the shape, with the ends of the element; not by a line of the file."""
    document = ezdxf.new()
    document.units = 4
    model = document.modelspace()
    handle = model.add_line((3, 0), (0, 0)).dxf.handle
    model.add_line((3, 0), (3, 3))
    model.add_lwpolyline([(10 * i, 100 + i % 2) for i in range(70)])
    document.saveas(tmp_path / "a.dxf")
    assert main(["track", str(tmp_path / "a.dxf"), "--corner", "0.2"]) == 2
    assert capsys.readouterr().err.replace(f"{tmp_path}/", "").splitlines() == [
        "a.dxf: track1: elements: a track has at most 64 elements, starts from at most 8 tracks and ends at as many; "
        "at most 64 start, or end, at one point",
        f"a.dxf: track2, element 2 (line from (2.8, 0) to (0, 0) mm of LINE #{handle}): the gap is too small: "
        "the transition would have a radius of less than 1 mm",
    ]
    shape = '<path id="frame" d="M1 1h1v1h-1z" stroke="black" fill="none"/>'
    size = 'xmlns="http://www.w3.org/2000/svg" width="10mm" height="10mm" viewBox="0 0 10 10"'
    (tmp_path / "s.svg").write_text(f"<svg {size}>{shape}</svg>")
    assert main(["track", str(tmp_path / "s.svg")]) == 2
    said = capsys.readouterr().err.replace(f"{tmp_path}/", "")
    assert said.startswith("s.svg: track1, element 2 (line from (2, 8.55) to (2, 8.45) mm of <path> 'frame'): the gap")


def triangle(mesh: Any) -> None:
    with mesh.edit_data() as data:
        data.vertices, data.faces = [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]


def nested(model: Any, document: Any, depth: int, count: int) -> None:
    document.blocks.new("B0").add_line((0, 0), (1, 0))
    for i in range(1, depth):
        block = document.blocks.new(f"B{i}")
        for k in range(count):
            block.add_blockref(f"B{i - 1}", (k, i))
    model.add_blockref(f"B{depth - 1}", (0, 0))


@given(st.lists(st.tuples(st.floats(0, 1), st.sampled_from([b"", b"-", b"nan", b"9" * 20, b"\n", b"x"])), max_size=6))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30, deadline=None)
def test_property_a_damaged_drawing_is_read_or_refused(tmp_path: Path, damage: list[tuple[float, bytes]]) -> None:
    whole, file = tmp_path / "whole.dxf", tmp_path / "a.dxf"
    if not whole.exists():
        read(tmp_path, lambda m, d: (m.add_arc((0, 0), 5, 0, 90), m.add_spline([(9, 0), (12, 3), (15, 0)])))
        whole.write_bytes(file.read_bytes())
    data = whole.read_bytes()
    first = data.index(b"ENTITIES")
    for share, piece in damage:
        at = first + int(share * (len(data) - first))
        data = data[:at] + piece + data[at + 3 :]
    file.write_bytes(data)
    with contextlib.suppress(TaktError):
        assert yaml.safe_load(read_drawing(file).tracks)["tracks"]


@pytest.mark.parametrize(
    "data", [b"", b"no drawing", bytes(range(256)), b"0\nSECTION\n2\nENTITIES\n0\nLINE\n10\nx\n0\nEOF\n"]
)
def test_what_is_no_drawing(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.dxf").write_bytes(data)
    with pytest.raises(TaktError, match=r"a\.dxf: "):
        read_drawing(tmp_path / "a.dxf")
