"""SVG drawings as a browser shows them (PY-22, EN-37)."""

from __future__ import annotations

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
    assert "expected a width and a height in numbers for <symbol> 's'" in wrong(tmp_path, symbol + '<use href="#s"/>')


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
        ('<rect width="200" height="100" transform="rotate(3)"/>', LINE, False),
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
        ("g .a{fill:red;display:none}", "'display' for 'g .a'"),
        ("rect, path:hover {visibility:hidden}", "'visibility' for 'path:hover'"),
        ("@media print{.a{opacity:0}}", "'opacity' for"),
        (".a{clip-path:url(#c)}", "'clip-path' for '.a'"),
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
