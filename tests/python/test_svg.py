"""SVG drawings as a browser shows them (PY-22, EN-37)."""

from __future__ import annotations

import contextlib
import math
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from takt.svg import read_svg
from takt.toolpath import Toolpath, ToolpathError

HEAD = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="200mm" height="100mm"'
    ' viewBox="0 0 200 100">'
)
LINE = '<path d="M10 20 H17"/>'  # 7 mm, at Y 80


def read(directory: Path, body: str, head: str = HEAD) -> Toolpath:
    (directory / "a.svg").write_text(head + body + "</svg>")
    return read_svg(directory / "a.svg", (0, 0, 5))


def wrong(directory: Path, body: str) -> str:
    with pytest.raises(ToolpathError) as error:
        read(directory, body)
    return str(error.value).removeprefix(str(directory) + "/")


def drawn(path: Toolpath) -> tuple[float, np.ndarray]:
    """The length of what is drawn, and its least and greatest X and Y."""
    points, along = path.points(0.05)
    down = points[:, 2] == 0
    both = down[1:] & down[:-1]
    return float(np.sum(np.diff(along)[both])), np.array([points[down].min(axis=0)[:2], points[down].max(axis=0)[:2]])


SHAPES = {
    "path": '<path d="M50 30 H70 V60 H50 Z" {}/>',
    "rect": '<rect x="50" y="30" width="20" height="30" {}/>',
    "polygon": '<polygon points="50,30 70,30 70,60 50,60" {}/>',
    "polyline": '<polyline points="50,30 70,30 70,60 50,60 50,30" {}/>',
    "circle": '<circle cx="60" cy="40" r="12" {}/>',
    "ellipse": '<ellipse cx="60" cy="40" rx="20" ry="7" {}/>',
    "line": '<line x1="50" y1="30" x2="70" y2="60" {}/>',
    "rounded": '<rect x="50" y="30" width="20" height="30" rx="5" ry="5" {}/>',
    "curves": '<path d="M50 30 C 60 10 80 70 70 60 Q 50 50 40 60 A 10 5 30 1 0 50 30" {}/>',
}
TRANSFORMS = {
    "turned": ("rotate(25 60 45)", lambda z: (60 + 45j) + (z - (60 + 45j)) * np.exp(1j * math.radians(25))),
    "mirrored": ("matrix(-1 0 0 1 120 0)", lambda z: 120 - np.conj(z)),
    "larger": ("translate(-30 10) scale(1.3)", lambda z: 1.3 * z - 30 + 10j),
    "skewed": ("skewX(20)", lambda z: z + math.tan(math.radians(20)) * z.imag),
    "flat": ("scale(1.5 0.5)", lambda z: 1.5 * z.real + 0.5j * z.imag),
    "all": ("translate(20,5) rotate(-40) skewY(10)", None),
}


@pytest.mark.parametrize("how", ["itself", "group", "use", "style"])
@pytest.mark.parametrize("transform", TRANSFORMS)
@pytest.mark.parametrize("shape", SHAPES)
def test_transforms(tmp_path: Path, shape: str, transform: str, how: str) -> None:
    """Of the shape, of its groups, of what uses it: each point is where the matrix takes it."""
    matrix, function = TRANSFORMS[transform]
    plain = read(tmp_path, SHAPES[shape].format(""))
    attribute = f'transform="{matrix}"'
    body = {
        "itself": SHAPES[shape].format(attribute),
        "group": f"<g {attribute}><g>{SHAPES[shape].format('')}</g></g>",
        "use": "<defs>" + SHAPES[shape].format('id="s"') + f'</defs><use href="#s" {attribute}/>',
        "style": SHAPES[shape].format(attribute + ' style="fill:none;stroke:#000"'),
    }[how]
    path = read(tmp_path, body)
    if function is None:
        turn = np.exp(-1j * math.radians(40))

        def function(z: np.ndarray) -> np.ndarray:
            return (z + 1j * math.tan(math.radians(10)) * z.real) * turn + 20 + 5j

    points = plain.points(0.5)[0]
    points = points[points[:, 2] == 0]
    there = np.conj(function(points[:, 0] + 1j * (100 - points[:, 1]))) + 100j
    expected = np.stack([there.real, there.imag, np.zeros(len(there))], axis=1)
    away = path.follow(np.concatenate([[(0, 0, 5)], [(*expected[0, :2], 5.0)], expected]), slack=1e3).distance
    assert np.max(away[2:]) < 0.02


@pytest.mark.parametrize(
    "hidden",
    [
        '<rect visibility="hidden" width="50" height="50"/>',
        '<g visibility="collapse"><rect width="50" height="50"/></g>',
        '<rect style="visibility:hidden" width="50" height="50"/>',
        "<style>.a{display:none !important}</style><rect class='a' style='display:inline' width='5' height='5'/>",
        '<rect style="DISPLAY:none" width="5" height="5"/>',
        "<style>g .a{display:none}</style><g><g><rect class='a' width='5' height='5'/></g></g>",
        "<style>.a{visibility:hidden} .b{display:none}</style><rect class='a' width='5' height='5'/><g class='b'><rect"
        " width='5' height='5'/></g>",
        "<defs><style>.a{fill:red;visibility:hidden}</style></defs><rect class='a' width='5' height='5'/>",
        "<rect id='a' width='5' height='5'/><style>/* g .b{} */ #a,rect.b{display:none}</style>",
        '<rect display="none" width="50" height="50"/>',
        '<g style="fill:red;display:none"><rect width="50" height="50"/></g>',
        '<mask id="m"><rect width="90" height="90"/></mask>',
        '<clipPath id="c"><rect width="90" height="90"/></clipPath>',
        '<symbol id="s"><rect width="90" height="90"/></symbol>',
        '<marker id="k"><rect width="5" height="5"/></marker>',
        '<pattern id="p"><rect width="5" height="5"/></pattern>',
        '<defs><rect id="d" width="5" height="5"/></defs>',
        '<metadata><rect width="5" height="5"/></metadata>',
        '<x:g xmlns:x="urn:else"><rect width="5" height="5"/></x:g>',
        '<switch><foreignObject/><g/><rect width="5" height="5"/></switch>',
        '<rect width="0" height="5"/><circle r="0"/>',
        '<rect opacity="0" width="5" height="5"/>',
        '<use href="#none"/>',
        '<rect fill="none" stroke="none" width="5" height="5"/>',
        "<text>a</text>",
        "<title>a</title><desc>b</desc>",
    ],
)
def test_what_is_not_seen_is_not_drawn(tmp_path: Path, hidden: str) -> None:
    for body in (hidden + LINE, LINE + hidden):
        length, box = drawn(read(tmp_path, body))
        assert length == pytest.approx(7)
        assert box == pytest.approx(np.array([[10, 80], [17, 80]]))


def test_what_is_left_out_is_said(tmp_path: Path) -> None:
    body = LINE + '<text>a</text><text>b</text><image width="3" height="3"/><use href="#no"/>'
    body += '<rect fill="none" stroke="none" width="5" height="5"/>'
    assert read(tmp_path, body).left_out == (
        "text (2 times)", "image", "use of '#no', which is not in the file", "<rect> with neither fill nor stroke",
    )  # fmt: skip


def test_visible_within_hidden(tmp_path: Path) -> None:
    body = '<g visibility="hidden"><path d="M0 0 H50"/><path visibility="visible" d="M10 20 H17"/></g>'
    assert drawn(read(tmp_path, body))[0] == pytest.approx(7)


def test_symbols_have_viewports(tmp_path: Path) -> None:
    """A diagonal of a view box of 10, scaled to 30 by 40 at (20, 10): 3 times, and in the middle of its height."""
    symbol = '<symbol id="s" viewBox="0 0 10 10"><path d="M0 0 L10 10"/></symbol>'
    length, box = drawn(read(tmp_path, symbol + '<use xlink:href="#s" x="20" y="10" width="30" height="40"/>'))
    assert length == pytest.approx(30 * math.sqrt(2))
    assert box == pytest.approx(np.array([[20, 100 - 45], [50, 100 - 15]]), abs=1e-6)
    whole = drawn(read(tmp_path, symbol + '<use href="#s"/>'))[1]  # 100 %: ten times, in the middle of the width
    assert whole == pytest.approx(np.array([[50, 0], [150, 100]]))
    assert "viewers do not agree" in wrong(tmp_path, symbol.replace("<symbol", '<symbol x="1"') + '<use href="#s"/>')


@pytest.mark.parametrize(
    ("attributes", "width", "height"),
    [
        ('width="100mm" viewBox="0 0 100 50"', 100, 50),
        ('height="100mm" viewBox="0 0 100 50"', 200, 100),
        ('width="10cm" height="auto" viewBox="0 0 100 50"', 100, 50),
        ('width="100mm" height="100%" viewBox="0 0 100 50"', 100, 50),
        ('style="width:100mm;height:50mm" viewBox="0,0,100,50"', 100, 50),
        ('viewBox="0 0 96 192"', 25.4, 50.8),
        ('width="100%" height="100%" viewBox="0 0 96 192"', 25.4, 50.8),
        ('width="1in" height="1in" viewBox="0 0 9 9"', 25.4, 25.4),
        ('width="72pt" height="6pc" viewBox="0 0 9 9"', 25.4, 25.4),
        ('width="100mm" height="50mm" viewBox="-10 -5 20 10"', 100, 50),
        ('width="100mm" height="60mm" viewBox="7 5 20 10" preserveAspectRatio="none"', 100, 60),
    ],
)
def test_sizes_of_drawings(tmp_path: Path, attributes: str, width: float, height: float) -> None:
    """PY-22: what is not given follows from the view box. A frame round all of it reaches from corner to corner."""
    box = (attributes + ' viewBox="').split('viewBox="')[1].split('"')[0].replace(",", " ").split()
    frame = '<rect x="{}" y="{}" width="{}" height="{}"/>'.format(*box)
    found = drawn(read(tmp_path, frame, f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>'))[1]
    assert found == pytest.approx(np.array([[0, 0], [width, height]]), abs=1e-9)


@pytest.mark.parametrize(
    ("attributes", "said"),
    [
        ('width="100mm"', "<svg> has neither a height nor a viewBox; Y begins at its lower edge"),
        ('width="50%" viewBox="0 0 9 9"', "width: 50% of a window; expected a length"),
        ('viewBox="0 0 9"', "viewBox: expected four numbers, found '0 0 9'"),
        ('width="9" height="9" transform="scale(2)"', "'transform' of the outermost <svg> is not read"),
        ('width="0" height="9"', "no outlines are drawn in it; left out: <svg> of size 0"),
        ('height="9bu"', "the unit of '9bu' is not read"),
        (
            'width="9" height="9" viewBox="0 0 9 9" preserveAspectRatio="middle"',
            "preserveAspectRatio: expected none or",
        ),
    ],
)
def test_sizes_of_drawings_that_are_none(tmp_path: Path, attributes: str, said: str) -> None:
    (tmp_path / "a.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{LINE}</svg>')
    with pytest.raises(ToolpathError) as error:
        read_svg(tmp_path / "a.svg")
    assert said in str(error.value)


VIEWPORTS = st.tuples(
    st.sampled_from([0, 5, -12]), st.sampled_from([0, 7]), st.sampled_from([40, 100]), st.sampled_from([30, 80]),
    st.sampled_from([None, (0, 0, 50, 50), (-5, 10, 20, 40)]),
    st.sampled_from(["", "none", "xMinYMax", "xMaxYMid slice"]),
)  # fmt: skip


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60, deadline=None)
@given(st.lists(st.tuples(VIEWPORTS, st.sampled_from(["svg", "use", "symbol"])), min_size=1, max_size=3))
def test_property_viewports_within_viewports(tmp_path: Path, around: list[tuple[tuple, str]]) -> None:  # type: ignore[type-arg]
    """PY-22: svg within svg, used svg, and symbols: each point is where SVG 2, 8.2 says."""
    begin, end = 10 + 20j, 30 + 25j
    body, definitions, ends = '<path d="M10 20 L30 25"/>', "", [begin, end]
    for i, ((x, y, width, height, box, aspect), kind) in enumerate(around):
        view = f' viewBox="{box[0]} {box[1]} {box[2]} {box[3]}"' if box else ""
        view += f' preserveAspectRatio="{aspect}"' if aspect else ""
        place, size = f'x="{x}" y="{y}"', f'width="{width}" height="{height}"'
        if kind == "svg":
            body = f'<svg {place} {size} overflow="visible"{view}>{body}</svg>'
        else:
            own, name = ("", "symbol") if kind == "symbol" else ('x="3" width="1"', "svg")
            definitions += f'<defs><{name} id="s{i}" overflow="visible" {own}{view}>{body}</{name}></defs>'
            body = f'<use href="#s{i}" {place} {size}/>'
        across, down, offset = 1.0, 1.0, 0j
        if box:
            across, down = width / box[2], height / box[3]
            if aspect != "none":
                across = down = max(across, down) if "slice" in aspect else min(across, down)
            over = complex(width - across * box[2], height - down * box[3])
            share = {"xMinYMax": (0, 1), "xMaxYMid slice": (1, 0.5), "none": (0, 0)}.get(aspect, (0.5, 0.5))
            offset = complex(share[0] * over.real - box[0] * across, share[1] * over.imag - box[1] * down)
        origin = complex(x + (3 if kind == "use" else 0), y)
        ends = [origin + offset + complex(across * z.real, down * z.imag) for z in ends]
    path = read(tmp_path, definitions + body)
    expected = [(z.real, 100 - z.imag, 0) for z in ends]
    assert [one.end for one in path.elements][1:3] == [pytest.approx(place, abs=1e-6) for place in expected]


def test_what_viewports_cut_is_refused(tmp_path: Path) -> None:
    """PY-22: beyond a viewport nothing is seen, unless its overflow is visible."""
    for name in ("svg", "symbol"):
        inner = f'<{name} id="s" width="12" height="30">{LINE}</{name}>'
        body = inner if name == "svg" else f'<defs>{inner}</defs><use href="#s"/>'
        assert f"the viewport of <{name}> 's' would cut <path>" in wrong(tmp_path, body)
        assert drawn(read(tmp_path, body.replace('height="30"', 'height="30" overflow="visible"')))[0] == 7


@pytest.mark.parametrize(
    ("attributes", "function"),
    [
        ('transform="rotate(90)" transform-origin="10 20"', lambda z: 10 + 20j + (z - 10 - 20j) * 1j),
        ('style="transform:rotate(0.25turn);transform-origin:1cm 20px"', None),
        ('transform="scale(2)" transform-origin="center"', lambda z: 2 * z - 100 - 50j),
        ('transform="scale(2)" style="transform-origin:right bottom"', lambda z: 2 * z - 200 - 100j),
        ('transform="scale(2)" transform-origin="top"', lambda z: 2 * z - 100),
        ('style="transform:translateX(3px) translateY(4px)"', lambda z: z + 3 + 4j),
        ('transform="translate(9)" style="transform:none"', lambda z: z),
    ],
)
def test_origins_of_transforms(tmp_path: Path, attributes: str, function: object) -> None:
    """PY-22: by attribute and style, in lengths and shares of the viewport (200 by 100)."""
    if function is None:
        origin = 10 * 96 / 25.4 + 20j

        def function(z: complex) -> complex:
            return origin + (z - origin) * 1j

    path = read(tmp_path, LINE.replace("<path", f"<path {attributes}"))
    ends = [complex(one.end[0], 100 - one.end[1]) for one in path.elements[1:3]]
    assert ends == pytest.approx([function(10 + 20j), function(17 + 20j)])  # type: ignore[operator]
    boxed = LINE.replace("<path", '<path transform="scale(2)" transform-box="fill-box"')
    assert "'transform-box: fill-box' is not read" in wrong(tmp_path, boxed)
    assert "'rotate' is not read; expected 'transform'" in wrong(tmp_path, LINE.replace("/>", ' style="rotate:9deg"/>'))


@pytest.mark.parametrize(
    ("body", "box"),
    [
        ('<ellipse cx="20" cy="20" rx="10"/>', [10, 70, 30, 90]),
        ('<ellipse cx="20" cy="20" rx="auto" ry="5"/>', [15, 75, 25, 85]),
        ('<g x="5" width="50" rx="3" r="9"><rect x="1" y="1" width="10" height="4"/></g>', [1, 95, 11, 99]),
        ('<circle r="1" style="r:8px;cx:20px" cy="20"/>', [12, 72, 28, 88]),
        ('<line x1="1in" y1="1pc" x2="2em" y2="50%"/>', [32, 50, 96, 84]),
        ('<g font-size="20"><line x1="2em" x2="50" y1="10" y2="1em"/></g>', [40, 80, 50, 90]),
        ('<rect x="10%" y="10%" width="10%" height="50%"/>', [20, 40, 40, 90]),
        ('<switch><g systemLanguage="xx"><path d="M0 0H9"/></g><path d="M1 5H9"/></switch>', [1, 95, 9, 95]),
        ('<switch><g requiredExtensions="http://x/"/><path d="M1 5H9"/><path d="M0 0H9"/></switch>', [1, 95, 9, 95]),
        ('<path d="M1 1H2" style="d:path(\'M10 10 H30\')"/>', [10, 90, 30, 90]),
        ('<style>path{display:none}#a{display:inline}</style><path id="a" d="M1 5H9"/>', [1, 95, 9, 95]),
        (
            '<style>g > .a{display:none}</style><path class="a" d="M1 5H9"/><g><path class="a" d="M0 0H9"/></g>',
            [1, 95, 9, 95],
        ),
        ('<path d="M1 5H9" style="display:none;display:inline"/>', [1, 95, 9, 95]),
    ],
)  # fmt: skip
def test_sizes_and_styles_of_shapes(tmp_path: Path, body: str, box: list[float]) -> None:
    """PY-22: the least X and Y and the greatest ones, by hand."""
    found = drawn(read(tmp_path, body))[1]
    assert found.ravel() == pytest.approx(box, abs=1e-6)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('<path d="M0 0 20 20 X 5 5 L60 60"/>', "what follows an error in the path 'M0 0 20 20 X 5 5 L60 60'"),
        ('<path d="L60 60"/>', "what follows an error in the path 'L60 60'"),
        ('<polygon points="0,0 10,0 10,10 5"/>', "what follows an error in the polygon '0,0 10,0 10,10 5'"),
        ('<path id="p" d="M0 0H9" opacity="0"/>', "<path> 'p' with opacity 0"),
        ('<g opacity="0"><path d="M0 0H9"/></g>', "<path> with opacity 0"),
        ('<path d="M0 0H9" fill="none" stroke="red" stroke-opacity="0"/>', "<path> with neither fill nor stroke"),
        ('<path d="M0 0H9" fill="none" stroke="red" stroke-width="0"/>', "<path> with neither fill nor stroke"),
        ('<path d="M0 0H9" fill="transparent"/>', "<path> with neither fill nor stroke"),
        ('<path d="M0 0H9" fill="#0000"/>', "<path> with neither fill nor stroke"),
        ('<path d="M0 0H9" fill="rgba(0,0,0,0)"/>', "<path> with neither fill nor stroke"),
        ('<path d="M0 0H9" fill="url(#none)"/>', "<path> with neither fill nor stroke"),
        ('<rect x="-5" width="-10" height="5"/>', "<rect> of a size below 0"),
        ('<circle r="-1"/>', "<circle> of a size below 0"),
        ('<path d="M0 0H9" systemLanguage="de"/>', "<path> for some languages or extensions only"),
        ('<path d="M50 50H59" marker-end="url(#m)"/><marker id="m"/>', "marker-end of <path>"),
        ('<path d="M50 50H59" filter="url(#f)"/>', "the filter of <path>"),
        ('<path d="M50 50H59"><animate attributeName="d"/></path>', "<animate>"),
        ("<style>@import url('a.css');</style>", "@import of a style sheet"),
    ],
)
def test_what_is_not_drawn_as_written_is_said(tmp_path: Path, body: str, said: str) -> None:
    """PY-22: nothing is left out in silence."""
    assert read(tmp_path, LINE + body).left_out == (said,)
    if "50 50" not in body and "M0 0 20" not in body and "polygon" not in body:
        assert f"a.svg: no outlines are drawn in it; left out: {said}" in wrong(tmp_path, body)


@pytest.mark.parametrize(
    ("data", "length", "said"),
    [
        ("M10 10 L20 10 L nan 10 L90 90", 10, True),
        ("M10 10 L20 10 L 30", 10, True),
        ("M10 10 A0 5 0 0 1 20 10", 10, False),
        ("M10 10 A5 5 0 0 1 10 10 H12", 2, False),
        ("M10 10 A1 1 0 0 1 20 10", 5 * math.pi, False),  # too small: made larger
        ("M10 10 h5 v0 h5", 10, False),
        ("M10 10 Z", 0, False),
        ("", 0, False),
    ],
)
def test_data_of_paths(tmp_path: Path, data: str, length: float, said: bool) -> None:
    """Radii of 0, and up to an error, as SVG 1.1 has it (8.3.8, F.2)."""
    path = read(tmp_path, f'<path d="{data}"/>' + LINE)
    assert drawn(path)[0] == pytest.approx(length + 7)
    assert bool(path.left_out) == said


@pytest.mark.parametrize(
    ("clip", "shape", "taken"),
    [
        ('<rect x="0" y="0" width="200" height="100"/>', LINE, True),
        ('<path d="M0 0 H200 V100 H0 Z"/>', LINE, True),
        ('<rect x="0" y="0" width="15" height="100"/>', LINE, False),
        ('<circle cx="15" cy="20" r="50"/>', LINE, False),
        ('<rect width="200" height="100" transform="rotate(3)"/>', LINE, True),
        ('<rect x="5" y="15" width="9" height="10" transform="rotate(3)"/>', LINE, False),
        ('<rect width="8" height="30" transform="translate(10 0)"/>', LINE, True),
        ("", LINE, False),
    ],
)
def test_clips(tmp_path: Path, clip: str, shape: str, taken: bool) -> None:
    """Those that cut nothing are without effect, all others an error."""
    body = f'<clipPath id="c">{clip}</clipPath><g clip-path="url(#c)">{shape}</g>'
    if taken:
        assert drawn(read(tmp_path, body))[0] == pytest.approx(7)
    else:
        assert "a.svg: a clip-path would cut <path>, and outlines are drawn whole" in wrong(tmp_path, body)
    moved = body.replace('<g clip-path="url(#c)">', '<g clip-path="url(#c)" transform="translate(60 40)">')
    if taken:
        assert drawn(read(tmp_path, moved))[0] == pytest.approx(7)
    assert "has a mask" in wrong(tmp_path, '<g mask="url(#m)">' + LINE + "</g>")


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        ("g + .a{fill:red;display:none}", "'display' for 'g + .a'"),
        ("path:not(.a){stroke:none}", "'stroke' for 'path:not(.a)'"),
        ("rect, path:hover {visibility:hidden}", "'visibility' for 'path:hover'"),
        ("@media print{.a{opacity:0}}", "'opacity' for"),
        (
            "@media all{@supports(display:grid){.a{display:none}}}",
            "'display' for '@media all @supports(display:grid) .a'",
        ),
        ("@layer x{@media screen{.a{fill:blue;display:none}}}", "'display' for '@layer x @media screen .a'"),
        ("svg{fill:red; .a{display:none} g{fill:blue}}", "'display' for 'svg .a'"),
        ("svg{fill:red; .a{fill:blue} stroke:red}", ""),
        ("{".join(["@media all"] * 3000), "rules are nested more than 20 deep"),
        (".a{clip-path:url(#c)}", ""),
        ("path{display:none}path{display:inline !important}", ""),
        ("g .a{fill:red}", ""),
        (".a{stroke:red}", ""),
    ],
)
def test_styles_that_are_not_read(tmp_path: Path, rule: str, said: str) -> None:
    """They are an error if they say what is seen, or where."""
    body = f"<style>{rule}</style>{LINE}"
    if said:
        assert f"a.svg: <style>: {said}" in wrong(tmp_path, body)
    else:
        assert drawn(read(tmp_path, body))[0] == pytest.approx(7)


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        ("path:not(.x){stroke:black}", "'stroke' for 'path:not(.x)' is not read"),
        ("@media screen{path{stroke:black}}", "'stroke' for '@media screen path' is not read"),
        ("g:not(rect, path, circle){fill:red}", "'fill' for 'g:not(rect, path, circle)' is not read"),
        ("path:hover{stroke:black}", "no outlines are drawn in it"),
        ("rect{fill:red}", "no outlines are drawn in it"),
    ],
)
def test_styles_that_are_not_read_and_show(tmp_path: Path, rule: str, said: str) -> None:
    """They are an error where an element would be left out for want of a paint."""
    body = f'<style>{rule}</style><g fill="none" stroke="none">{LINE}</g>'
    assert said in wrong(tmp_path, body)
    shown = LINE.replace("/>", ' stroke="red"/>')
    assert drawn(read(tmp_path, body.replace(LINE, shown)))[0] == pytest.approx(7)


BOMB = '<defs><path id="u0" d="M0 0 H1"/>' + "".join(
    f'<g id="u{i}">' + f'<use href="#u{i - 1}"/>' * 12 + "</g>" for i in range(1, 10)
) + '</defs><use href="#u9"/>'  # fmt: skip


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (BOMB, "more than 100,000 elements, with the copies that <use> makes"),
        ('<g id="a"><use href="#a"/></g>', "<use> of '#a' is part of what it copies"),
        ('<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g>', "is part of what it copies"),
        ("<g>" * 5000 + "</g>" * 5000, "elements nest deeper than 100"),
        ('<path d="M0 0 C 1e15 1e15 1e15 0 0 1"/>', "expected numbers up to 1e+08 mm"),
        ('<path d="M0 0 L 1e300 1"/>', "expected numbers up to 1e+08 mm"),
        ('<path d="M0 0 C 9e7 9e7 9e7 -9e7 0 1" transform="scale(1)"/>' * 40, "more than 1,000,000 elements"),
        ('<circle r="1" transform="scale(1e20)"/>', "expected numbers up to 1e+08 mm"),
        ('<rect width="1" height="1" transform="translate(1e200)"/>', "expected numbers up to 1e+08 mm"),
        ('<rect x="1mm" width="5%" height="3em" rx="2%"/><line x1="1ex" x2="5%" y2="q"/>', "a.svg: "),
        ('<use href="#x" x="nan"/><path id="x" d="M0 0H1"/>', "expected a number, found 'nan'"),
    ],
)
def test_limits(tmp_path: Path, body: str, said: str) -> None:
    begin = time.process_time()
    assert said in wrong(tmp_path, body)
    assert time.process_time() - begin < 20


@pytest.mark.parametrize("sheet", ["a{", "/*", "/* */", "(", "a>", "a{}", '"', "a b>", "a,", "  ", "@media{", "a{b:(;"])
def test_hostile_style_sheets_take_bounded_time(tmp_path: Path, sheet: str) -> None:
    """PY-22: in proportion to their length, whatever is not closed in them."""
    begin = time.process_time()
    for body in (f"<style>{sheet * 100_000}</style>{LINE}", LINE.replace("/>", f" style='{sheet * 20_000}'/>")):
        (tmp_path / "a.svg").write_text(HEAD + body.replace("<svg", "").replace("&", "") + "</svg>")
        with contextlib.suppress(ToolpathError):
            read_svg(tmp_path / "a.svg")
    assert time.process_time() - begin < 10


def test_rules_within_one_another_take_bounded_time(tmp_path: Path) -> None:
    nested = "<g>" * 90 + LINE + "</g>" * 90
    begin = time.process_time()
    assert drawn(read(tmp_path, f"<style>{'g ' * 60}x > path{{display:none}}</style>{nested}"))[0] == pytest.approx(7)
    rules = "path{fill:red}" * 9000
    assert "<style>: too many rules for so many elements" in wrong(tmp_path, f"<style>{rules}</style>" + LINE * 2000)
    assert time.process_time() - begin < 20


@pytest.mark.parametrize(
    "text", ["", "<svg", "<html/>", "\x00\x01", "<!DOCTYPE a [<!ENTITY b SYSTEM 'x'>]><svg>&b;</svg>"]
)
def test_what_is_no_drawing(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.svg").write_text(text)
    with pytest.raises(ToolpathError, match=r"a\.svg: (is no SVG|expected <svg>)"):
        read_svg(tmp_path / "a.svg")


NUMBER = st.one_of(
    st.integers(-200, 200).map(str), st.sampled_from(["1e9", "-1e400", "nan", "0.0000001", "", "a", "50%"])
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(st.tuples(st.sampled_from("MLHVCSQTAZmlhvcsqtaz"), st.lists(NUMBER, max_size=8)), max_size=8),
    st.sampled_from(["", "rotate(30)", "scale(0)", "matrix(1 2 2 4 0 0)", "skewX(90)", "foo", "scale(1e300)"]),
)
def test_property_any_path_is_drawn_or_refused(
    tmp_path: Path, data: list[tuple[str, list[str]]], transform: str
) -> None:
    text = " ".join(letter + ",".join(numbers) for letter, numbers in data)
    try:
        path = read(tmp_path, f'<path d="{text}" transform="{transform}"/>')
    except ToolpathError:
        return
    assert math.isfinite(path.length)
