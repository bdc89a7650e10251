"""The rendered shapes of an SVG drawing, each with its matrix to the drawing's own coordinates (px, Y down).

Structure by SVG 1.1, chapter 5, and SVG 2 where it says more: `use` is a copy of the referenced element, `svg` and
`symbol` within a drawing have viewports of their own, and `defs`, `mask`, `marker`, `clipPath`, `pattern` and the like
are never drawn themselves. Copies are counted before they are made: a drawing of a few lines can request millions.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import NamedTuple
from xml.etree import ElementTree

from takt import svg_values
from takt.svg_style import INHERITED, Key, Styles, is_paint, is_zero, key_of
from takt.svg_values import FONT, IDENTITY, Matrix, TreeError, length, moved, product

MOST = 100_000  # elements, including copies by <use>
DEPTH = 100
SVG = "{http://www.w3.org/2000/svg}"
_HREF = ("href", "{http://www.w3.org/1999/xlink}href")
SHAPES = ("path", "rect", "circle", "ellipse", "line", "polyline", "polygon")
_CONTAINERS = ("svg", "g", "a", "switch")
_TEXTS = ("text", "image", "foreignObject")
_MOVING = ("animate", "animateTransform", "animateMotion", "set", "script")
_MARKED = ("path", "line", "polyline", "polygon")
_FONTS = {
    "medium": 16.0,
    "small": 13.0,
    "large": 18.0,
    "x-small": 10.0,
    "x-large": 24.0,
    "xx-small": 9.0,
    "xx-large": 32.0,
}


class Shape(NamedTuple):
    tag: str
    label: str
    numbers: dict[str, float]  # x, width, rx and the like, px
    points: list[complex]
    data: str
    matrix: Matrix
    clips: tuple[Clip, ...] = ()


class Clip(NamedTuple):
    """A clip: everything outside its shapes is invisible."""

    what: str
    shapes: list[Shape]
    matrix: Matrix


@dataclass(frozen=True)
class _Around:
    """The context of an element."""

    inherited: dict[str, str]
    within: tuple[Key, ...]  # ancestors for style sheets
    written_within: tuple[Key, ...]  # ancestors in the file, also of copied elements
    matrix: Matrix
    viewport: tuple[float, float]
    font: float = FONT
    clips: tuple[Clip, ...] = ()
    uses: tuple[str, ...] = ()  # references of the enclosing <use> elements
    depth: int = 0
    is_clear: bool = False  # opacity 0


@dataclass
class _Element:
    one: ElementTree.Element
    name: str
    label: str
    properties: dict[str, str]
    around: _Around = field(repr=False)

    def get(self, name: str, default: str = "") -> str:
        value = self.properties.get(name, "")
        return default if value.lower() in ("", "auto") else value

    def length(self, name: str, default: str = "0") -> float:
        """Returns a property as a length [px]; percentages refer to the viewport."""
        text = self.get(name, default)
        width, height = self.around.viewport
        whole = math.hypot(width, height) / math.sqrt(2)
        if name in ("x", "width", "cx", "rx", "x1", "x2"):
            whole = width
        elif name in ("y", "height", "cy", "ry", "y1", "y2"):
            whole = height
        try:
            return length(text, whole, self.around.font)
        except TreeError as error:
            raise TreeError(f"{self.label}: {name}: {error}") from None


class Rendered:
    """The rendered `shapes`, the `height` of the drawing [px], and `left_out`: visible contents that are not outlines.
    Raises TreeError."""

    def __init__(self, root: ElementTree.Element) -> None:
        self.shapes: list[Shape] = []
        self.left_out: Counter[str] = Counter()
        self._count = 0
        self._by_id: dict[str, ElementTree.Element] = {}
        self._parents = {child: one for one in root.iter() for child in one}
        for one in root.iter():
            self._by_id.setdefault(one.attrib.get("id", ""), one)
        if _name(root) != "svg":
            raise TreeError(f"expected <svg> in it, found <{_name(root) or 'something else'}>")
        sheets = [one for one in root.iter() if _name(one) == "style"]
        self._styles = Styles(["".join(one.itertext()) for one in sheets])
        if self._styles.imported:
            self.left_out["@import of a style sheet"] += self._styles.imported
        self.height = 0.0
        self._root(root)

    # --- The drawing and its elements ---

    def _root(self, root: ElementTree.Element) -> None:
        around = _Around({}, (), (), IDENTITY, (math.nan, math.nan))
        svg = self._element(root, "svg", around)
        if svg.get("display").lower() == "none":
            return
        for name in ("transform", "clip-path", "mask", "rotate", "translate", "scale"):
            if svg.get(name, "none").lower() != "none":
                raise TreeError(f"'{name}' of the outermost <svg> is not read: viewers do not agree on it")
        box = svg_values.view_box(root.attrib.get("viewBox", ""))
        sizes = []
        for name in ("width", "height"):  # 100 % refers to an unknown window
            text = svg.get(name, "100%")
            if text.strip().endswith("%") and text.strip() != "100%":
                raise TreeError(f"<svg>: {name}: {text} of a window; expected a length")
            sizes.append(None if text.strip() == "100%" else svg.length(name))
        width, height = sizes
        if box and 0 in box[2:]:
            self.left_out["<svg> with a viewBox of size 0"] += 1
            return
        if box:
            if width is None:
                width = box[2] if height is None else height * box[2] / box[3]
            height = width * box[3] / box[2] if height is None else height
        if height is None:
            raise TreeError("<svg> has neither a height nor a viewBox; Y begins at its lower edge")
        width = math.nan if width is None else width
        if width < 0 or height < 0:
            raise TreeError("<svg>: expected a width and a height above 0")
        self.height = height
        if 0 in (width, height):
            self.left_out["<svg> of size 0"] += 1
            return
        matrix = svg_values.fitted(box, width, height, root.attrib.get("preserveAspectRatio", "")) if box else IDENTITY
        inside = replace(
            self._inside(svg),
            matrix=matrix,
            viewport=(box[2], box[3]) if box else (width, height),
            is_clear=is_zero(svg.get("opacity", "1")),
        )
        for child in root:
            self._add(child, inside)

    def _element(self, one: ElementTree.Element, name: str, around: _Around) -> _Element:
        key = key_of(one, name)
        properties = self._styles.of(one, key, around.within, around.inherited)
        label = f"<{name}>" + (f" '{one.attrib['id']}'" if "id" in one.attrib else "")
        if self._styles.are_nested and around.uses:
            written = self._styles.of(one, key, around.written_within, around.inherited)
            if written != properties:
                raise TreeError(f"<style>: viewers do not agree on the rules for {label} where <use> copies it")
        font = properties.get("font-size", "").lower()
        if font and font != around.inherited.get("font-size", "").lower():
            size = _FONTS.get(font)
            around = replace(around, font=length(font, around.font, around.font) if size is None else size)
            properties["font-size"] = f"{around.font!r}px"
        return _Element(one, name, label, properties, around)

    def _inside(self, element: _Element) -> _Around:
        """Returns the context of the children of an element."""
        around = element.around
        if around.depth > DEPTH:
            raise TreeError(f"elements nest deeper than {DEPTH}")
        key = key_of(element.one, element.name)
        return replace(
            around,
            inherited={name: value for name, value in element.properties.items() if name in INHERITED},
            within=(*around.within, key),
            written_within=(*around.written_within, key),
            depth=around.depth + 1,
        )

    def _add(self, child: ElementTree.Element, around: _Around) -> None:
        name = _name(child)
        if name in _MOVING:
            self.left_out[f"<{name}>"] += 1
        if name not in (*SHAPES, *_CONTAINERS, *_TEXTS, "use"):
            return
        self._count += 1
        if self._count > MOST:
            raise TreeError(f"more than {MOST:,} elements, with the copies that <use> makes")
        element = self._element(child, name, around)
        if element.get("display").lower() == "none":
            return
        if not _holds(child):
            self.left_out[f"{element.label} for some languages or extensions only"] += 1
            return
        if element.get("mask", "none").lower() != "none":
            raise TreeError(f"{element.label} has a mask, and what that leaves of outlines is not known; remove it")
        if element.get("filter", "none").lower() != "none":
            self.left_out[f"the filter of {element.label}"] += 1
        for moving in ("rotate", "translate", "scale", "offset-path"):
            if element.get(moving, "none").lower() != "none":
                raise TreeError(f"{element.label}: '{moving}' is not read; expected 'transform'")
        matrix = product(around.matrix, self._transform(element))
        element.around = replace(
            element.around, matrix=matrix, is_clear=around.is_clear or is_zero(element.get("opacity", "1"))
        )
        clip = element.get("clip-path", "none")
        if clip.lower() != "none":
            element.around = replace(element.around, clips=(*around.clips, *self._clip(element, clip)))
        if name in SHAPES:
            self._shape(element)
        elif name in _TEXTS:
            if _is_visible(element):
                self.left_out[name] += 1
        elif name == "use":
            self._use(element)
        elif name == "svg":
            self._viewport(element, element, {})
        else:
            self._children(element)

    def _children(self, element: _Element) -> None:
        inside = self._inside(element)
        children = list(element.one)
        if element.name == "switch":  # the first child whose conditions hold; no language is assumed
            known = [child for child in children if _name(child) in (*SHAPES, *_CONTAINERS, *_TEXTS, "use")]
            children = next(([child] for child in known if _holds(child)), [])
            others = len([child for child in known if "systemLanguage" in child.attrib])
            if others:
                self.left_out[f"what {element.label} has for some languages only"] += others
        for child in children:
            self._add(child, inside)

    def _transform(self, element: _Element) -> Matrix:
        text = element.get("transform", "none")
        around = element.around
        try:
            matrix = svg_values.transform(text, around.font)
        except TreeError as error:
            raise TreeError(f"{element.label}: {error}") from None
        if matrix == IDENTITY:
            return matrix
        if element.get("transform-box", "view-box").lower() != "view-box":
            raise TreeError(f"{element.label}: 'transform-box: {element.get('transform-box')}' is not read")
        x, y = _origin(element)
        return product(product(moved(x, y), matrix), moved(-x, -y)) if (x, y) != (0.0, 0.0) else matrix

    # --- Copies and viewports ---

    def _use(self, use: _Element) -> None:
        href = next((use.one.attrib[key] for key in _HREF if key in use.one.attrib), "")
        target = self._by_id.get(href[1:]) if href.startswith("#") and len(href) > 1 else None
        if target is None:
            self.left_out[f"use of '{href}', which is not in the file"] += 1
            return
        around = use.around
        if href in around.uses:
            raise TreeError(f"<use> of '{href}' is part of what it copies")
        inside = self._inside(use)
        written: list[Key] = []
        parent = self._parents.get(target)
        while parent is not None:
            written.insert(0, key_of(parent, _name(parent)))
            parent = self._parents.get(parent)
        inside = replace(
            inside,
            matrix=product(around.matrix, moved(use.length("x"), use.length("y"))),
            within=(),
            written_within=tuple(written),
            uses=(*around.uses, href),
        )
        if _name(target) not in ("symbol", "svg"):
            self._add(target, inside)
            return
        self._count += 1
        copy = self._element(target, _name(target), inside)
        if copy.get("display").lower() == "none":
            return
        copy.around = replace(copy.around, matrix=product(inside.matrix, self._transform(copy)))
        self._viewport(copy, use, {name: use.get(name) for name in ("width", "height") if use.get(name)})

    def _viewport(self, svg: _Element, sized: _Element, sizes: dict[str, str]) -> None:
        """Draws the children of an svg or symbol. `sizes`: width and height given by a <use>."""
        attributes = svg.one.attrib
        if svg.name == "symbol" and attributes.keys() & {"x", "y", "refX", "refY"}:
            raise TreeError(f"{svg.label}: viewers do not agree on x, y, refX and refY of symbols")
        x, y = svg.length("x"), svg.length("y")
        width, height = ((sized if name in sizes else svg).length(name, "100%") for name in ("width", "height"))
        if math.isnan(width) or math.isnan(height):
            raise TreeError(f"{svg.label}: expected a width and a height")
        if not (width > 0 and height > 0):
            self.left_out[f"{svg.label} of size 0"] += 1
            return
        box = svg_values.view_box(attributes.get("viewBox", ""))
        if box and 0 in box[2:]:
            self.left_out[f"{svg.label} with a viewBox of size 0"] += 1
            return
        outer = product(svg.around.matrix, moved(x, y))
        fit = svg_values.fitted(box, width, height, attributes.get("preserveAspectRatio", "")) if box else IDENTITY
        clips = svg.around.clips
        if svg.properties.get("overflow", "hidden").lower() not in ("visible", "auto"):
            frame = Shape("rect", svg.label, {"x": 0.0, "y": 0.0, "width": width, "height": height}, [], "", outer)
            clips = (*clips, Clip(f"the viewport of {svg.label}", [frame], outer))
        inside = replace(
            self._inside(svg),
            matrix=product(outer, fit),
            viewport=(box[2], box[3]) if box else (width, height),
            clips=clips,
        )
        for child in svg.one:
            self._add(child, inside)

    # --- Shapes ---

    def _shape(self, element: _Element) -> None:
        if not _is_visible(element):
            return
        if any(_name(child) in _MOVING for child in element.one):
            self.left_out.update(f"<{_name(child)}>" for child in element.one if _name(child) in _MOVING)
        if element.around.is_clear:
            self.left_out[f"{element.label} with opacity 0"] += 1
            return
        if not self._is_painted(element):
            if self._styles.unread:
                raise TreeError(f"<style>: {self._styles.unread} is not read; expected it at the elements")
            self.left_out[f"<{element.name}> with neither fill nor stroke"] += 1
            return
        shape = self._read(element)
        if shape is None:
            return
        if element.name in _MARKED:
            for where in ("start", "mid", "end"):
                if self._is_there(element.get(f"marker-{where}", "none")):
                    self.left_out[f"marker-{where} of {element.label}"] += 1
        self.shapes.append(shape)

    def _is_painted(self, element: _Element) -> bool:
        fill, stroke = element.get("fill", "black"), element.get("stroke", "none")
        paints = []
        for paint in (fill, stroke):
            match = re.fullmatch(r"url\([^)]*\)\s*(.*)", paint)
            if match and not self._is_there(paint):
                paint = match[1] or "none"
            paints.append(element.get("color", "black") if paint.lower() == "currentcolor" else paint)
        width = element.get("stroke-width", "1")
        return is_paint(paints[0], element.get("fill-opacity", "1")) or (
            is_paint(paints[1], element.get("stroke-opacity", "1")) and not is_zero(width)
        )

    def _is_there(self, reference: str) -> bool:
        match = re.match(r"url\(\s*['\"]?#([^'\")]*)['\"]?\s*\)", reference)
        return match is not None and match[1] in self._by_id

    def _read(self, element: _Element) -> Shape | None:
        """Returns the shape of an element; None if it has no outline."""
        tag, data, found, wrong = element.name, "", list[complex](), False
        numbers: dict[str, float] = {}
        if tag == "path":
            data, text = "", element.get("d")
            match = re.fullmatch(r"path\(\s*(?:[a-z]+\s*,\s*)?(['\"])(.*)\1\s*\)", text, flags=re.DOTALL)
            text = match[2] if match else text
            data, wrong = svg_values.path_data("" if text == "none" else text)
        elif tag in ("polyline", "polygon"):
            text = element.one.attrib.get("points", "")
            found, wrong = svg_values.points(text)
        elif tag == "line":
            element.properties.update({name: element.one.attrib.get(name, "0") for name in ("x1", "y1", "x2", "y2")})
            numbers = {name: element.length(name) for name in ("x1", "y1", "x2", "y2")}
        else:
            numbers = _sizes(element)
            if any(numbers[name] < 0 for name in ("width", "height", "rx", "ry", "r") if name in numbers):
                self.left_out[f"{element.label} of a size below 0"] += 1
                return None
            if any(numbers[name] == 0 for name in _NEEDED[tag]):
                return None
        if wrong:
            shown = text if len(text) < 40 else text[:37] + "..."
            self.left_out[f"what follows an error in the {tag} '{shown}'"] += 1
        around = element.around
        return Shape(tag, element.label, numbers, found, data, around.matrix, around.clips)

    def _clip(self, element: _Element, clip: str) -> list[Clip]:
        match = re.fullmatch(r"url\(\s*['\"]?#([^'\")]*)['\"]?\s*\)", clip)
        if match is None:
            raise TreeError(f"{element.label}: the clip-path '{clip[:40]}' is not read; expected url(#...)")
        path = self._by_id.get(match[1])
        if path is None or _name(path) != "clipPath":
            return []  # a missing clip-path clips nothing
        if path.attrib.get("clipPathUnits") == "objectBoundingBox" or "clip-path" in path.attrib:
            raise TreeError(f"{element.label}: its clip-path '{match[1]}' is not of plain coordinates")
        around = replace(element.around, clips=(), inherited={})
        frame = self._element(path, "clipPath", around)
        around = replace(self._inside(frame), matrix=product(around.matrix, self._transform(frame)))
        shapes = []
        for child in path:
            self._count += 1
            name = _name(child)
            if name in SHAPES:
                inner = self._element(child, name, around)
                if inner.get("display").lower() != "none" and _is_visible(inner):
                    inner.around = replace(around, matrix=product(around.matrix, self._transform(inner)))
                    shape = self._read(inner)
                    if shape is not None:
                        shapes.append(shape)
            elif name in ("use", *_TEXTS):
                raise TreeError(f"the clip-path {frame.label} consists of more than shapes")
        return [Clip("a clip-path", shapes, around.matrix)]


_NEEDED = {"rect": ("width", "height"), "circle": ("r",), "ellipse": ("rx", "ry")}


def _sizes(element: _Element) -> dict[str, float]:
    """Returns the dimensions of a rectangle, circle or ellipse; missing and auto values by SVG 2, chapter 10."""
    if element.name == "circle":
        return {name: element.length(name) for name in ("cx", "cy", "r")}
    names = ("x", "y", "width", "height") if element.name == "rect" else ("cx", "cy")
    numbers = {name: element.length(name) for name in names}
    rx, ry = (element.length(name) if element.get(name) else None for name in ("rx", "ry"))
    numbers["rx"] = rx if rx is not None else ry if ry is not None else 0.0
    numbers["ry"] = ry if ry is not None else numbers["rx"]
    if element.name == "rect":
        numbers["rx"] = min(numbers["rx"], numbers["width"] / 2)
        numbers["ry"] = min(numbers["ry"], numbers["height"] / 2)
    return numbers


def _origin(element: _Element) -> tuple[float, float]:
    """Returns transform-origin in the coordinates of the element."""
    words = element.get("transform-origin", "0 0").lower().replace(",", " ").split()
    share = {"left": "0%", "right": "100%", "top": "0%", "bottom": "100%", "center": "50%"}
    if len(words) == 1:
        words = ["center", words[0]] if words[0] in ("top", "bottom") else [words[0], "center"]
    elif words[0] in ("top", "bottom") or words[1] in ("left", "right"):
        words[:2] = [words[1], words[0]]
    width, height = element.around.viewport
    x, y = (
        length(share.get(word, word), whole, element.around.font)
        for word, whole in zip(words[:2], (width, height), strict=True)
    )
    return (x, y)


def _is_visible(element: _Element) -> bool:
    return element.get("visibility").lower() not in ("hidden", "collapse")


def _holds(one: ElementTree.Element) -> bool:
    """Returns whether an element is drawn without a known language or extensions."""
    return "systemLanguage" not in one.attrib and "requiredExtensions" not in one.attrib


def _name(one: ElementTree.Element) -> str:
    """Returns the name of an SVG element; "" for other elements."""
    tag = one.tag if isinstance(one.tag, str) else ""
    return tag.removeprefix(SVG) if tag.startswith(SVG) or not tag.startswith("{") else ""
