"""The elements of an SVG drawing that are rendered, as a tree of groups and shapes with nothing else in it.

SVG's structure (SVG 1.1, chapter 5): `use` stands for a copy of what it refers to, a `symbol` is drawn only by `use`
and then has a viewport of its own, and `defs`, `mask`, `marker`, `clipPath`, `pattern` and the like are never drawn
themselves. Copies are counted before they are made: a drawing of a few lines can ask for millions.
"""

from __future__ import annotations

import copy
import math
import re
from collections import Counter
from typing import TYPE_CHECKING
from xml.etree import ElementTree

if TYPE_CHECKING:
    from collections.abc import Callable

MOST = 100_000  # elements, with those that use copies
DEPTH = 100
SVG = "{http://www.w3.org/2000/svg}"
_HREF = ("href", "{http://www.w3.org/1999/xlink}href")
SHAPES = ("path", "rect", "circle", "ellipse", "line", "polyline", "polygon")
_CONTAINERS = ("svg", "g", "a", "switch")
_TEXTS = ("text", "image", "foreignObject")
# What a use has for itself; all else it hands on to its copy.
_OWN = {"x", "y", "width", "height", "id", "transform", *_HREF}
CLIPPED, CLIP = "takt-clipped", "takt-clip"  # attributes: the clips of a shape, and the clip that a shape is part of


class TreeError(Exception):
    """What is wrong with a drawing."""


class Rendered:
    """`root`: the tree. `left_out`: elements that are seen, but are no outlines, by their names."""

    def __init__(self, root: ElementTree.Element, viewport: Callable[..., str]) -> None:
        self.left_out: Counter[str] = Counter()
        self._viewport = viewport
        self._count = self._clips = 0
        self._by_id = {one.attrib["id"]: one for one in root.iter() if "id" in one.attrib}
        if _name(root) != "svg":
            raise TreeError(f"expected <svg> in it, found <{_name(root) or 'something else'}>")
        self.root = self._copied(root, (), (), 0)
        for i, style in enumerate(one for one in root.iter() if _name(one) == "style"):
            _check_style(style)
            self.root.insert(i, copy.deepcopy(style))  # wherever they stand, they hold for all

    def _copied(
        self, one: ElementTree.Element, within: tuple[str, ...], clips: tuple[int, ...], depth: int
    ) -> ElementTree.Element:
        """A container with what is rendered of it. `within`: the uses that lead here."""
        if depth > DEPTH:
            raise TreeError(f"elements nest deeper than {DEPTH}")
        name = _name(one)
        made = ElementTree.Element(SVG + ("svg" if name == "svg" else "g"), _attributes(one))
        children = list(one)
        if name == "switch":
            children = [child for child in children if _name(child) != "foreignObject"][:1]
        for child in children:
            self._add(made, child, within, clips, depth)
        return made

    def _add(
        self,
        parent: ElementTree.Element,
        child: ElementTree.Element,
        within: tuple[str, ...],
        clips: tuple[int, ...],
        depth: int,
    ) -> None:
        name = _name(child)
        if name not in (*SHAPES, *_CONTAINERS, *_TEXTS, "use"):
            return
        self._count += 1
        if self._count > MOST:
            raise TreeError(f"more than {MOST:,} elements, with the copies that <use> makes")
        if _property(child, "display") == "none":
            return
        if _property(child, "mask") not in ("", "none"):
            raise TreeError(f"{_label(child)} has a mask, and what that leaves of outlines is not known; remove it")
        clip = _property(child, "clip-path")
        if clip not in ("", "none"):
            clips = (*clips, self._clip(parent, child, clip, depth))
        if name in _TEXTS:
            self.left_out[name] += 1
        elif name == "use":
            self._use(parent, child, within, clips, depth)
        elif name in SHAPES:
            parent.append(_shape(child, {CLIPPED: " ".join(map(str, clips))}))
        else:
            parent.append(self._copied(child, within, clips, depth + 1))

    def _use(
        self,
        parent: ElementTree.Element,
        use: ElementTree.Element,
        within: tuple[str, ...],
        clips: tuple[int, ...],
        depth: int,
    ) -> None:
        href = next((use.attrib[key] for key in _HREF if key in use.attrib), "")
        target = self._by_id.get(href.removeprefix("#")) if href.startswith("#") else None
        if target is None:
            self.left_out[f"use of '{href}', which is not in the file"] += 1
            return
        if href in within:
            raise TreeError(f"<use> of '{href}' is part of what it copies")
        x, y = (_length(use.attrib.get(key, "0")) for key in "xy")
        moved = f"{use.attrib.get('transform', '')} translate({x!r} {y!r})"
        if _name(target) in ("symbol", "svg"):
            moved += " " + self._of_viewport(use, target)
        attributes = {key: value for key, value in use.attrib.items() if key not in _OWN}
        made = ElementTree.SubElement(parent, SVG + "g", {**attributes, "transform": moved.strip()})
        if _name(target) in ("symbol", "svg"):
            inner = ElementTree.SubElement(made, SVG + "g", _attributes(target))
            for child in target:
                self._add(inner, child, (*within, href), clips, depth + 1)
        else:
            if depth > DEPTH:
                raise TreeError(f"elements nest deeper than {DEPTH}")
            self._add(made, target, (*within, href), clips, depth + 1)

    def _of_viewport(self, use: ElementTree.Element, target: ElementTree.Element) -> str:
        """The transform from the view box of a symbol to the size that its use gives it."""
        numbers = re.split(r"[\s,]+", target.attrib.get("viewBox", "").strip())
        if len(numbers) != 4:
            return ""
        x, y, width, height = map(_length, numbers)
        if not (width > 0 and height > 0):
            return ""
        sizes = [use.attrib.get(key, target.attrib.get(key, "100%")) for key in ("width", "height")]
        if any(size.strip().endswith("%") or size == "auto" for size in sizes):
            raise TreeError(f"{_label(use)}: expected a width and a height in numbers for {_label(target)}")
        size = [_length(one) for one in sizes]
        return self._viewport(0.0, 0.0, *size, x, y, width, height, target.attrib.get("preserveAspectRatio"))

    def _clip(self, parent: ElementTree.Element, one: ElementTree.Element, clip: str, depth: int) -> int:
        """Adds the shapes of a clipPath beside the element that it clips, marked, in the coordinates of the element."""
        match = re.fullmatch(r"url\(\s*['\"]?#([^'\")]*)['\"]?\s*\)", clip)
        path = self._by_id.get(match[1]) if match else None
        if path is None or _name(path) != "clipPath":
            return 0  # what is not there clips nothing
        if path.attrib.get("clipPathUnits") == "objectBoundingBox" or "clip-path" in path.attrib:
            raise TreeError(f"{_label(one)}: its clip-path '{match[1] if match else ''}' is not of plain coordinates")
        self._clips += 1
        transform = {"transform": one.attrib["transform"]} if "transform" in one.attrib else {}
        if _name(one) == "use":
            transform = {"transform": one.attrib.get("transform", "")}
        outer = ElementTree.SubElement(parent, SVG + "g", transform)
        inner = ElementTree.SubElement(outer, SVG + "g", _attributes(path))
        for child in path:
            self._count += 1
            if _name(child) in SHAPES:
                inner.append(_shape(child, {CLIP: str(self._clips)}))
            elif _name(child) in ("use", *_TEXTS):
                raise TreeError(f"the clip-path {_label(path)} consists of more than shapes")
        return self._clips


def _name(one: ElementTree.Element) -> str:
    """Of an element of SVG; "" of another one."""
    tag = one.tag if isinstance(one.tag, str) else ""
    return tag.removeprefix(SVG) if tag.startswith(SVG) or not tag.startswith("{") else ""


def _check_style(style: ElementTree.Element) -> None:
    """Raises TreeError where rules that say what is seen, or where, are of a kind that is not read."""
    text = re.sub(r"/\*.*?\*/", "", style.text or "", flags=re.DOTALL)
    for selectors, rules in re.findall(r"([^{}]*)\{([^{}]*)\}?", text):
        found = re.search(r"(?:^|[;\s])(display|visibility|opacity|transform|clip-path|mask|d)\s*:", rules)
        if not found:
            continue
        for selector in selectors.split(","):
            plain = re.fullmatch(r"\s*(?:\*|[\w-]*[.#]?[\w-]+)\s*", selector)
            if not plain or found[1] in ("clip-path", "mask"):
                raise TreeError(
                    f"<style>: '{found[1]}' for '{selector.strip()}' is not read; expected it at the elements"
                )


def _label(one: ElementTree.Element) -> str:
    name = one.attrib.get("id")
    return f"<{_name(one)}>" + (f" '{name}'" if name else "")


def _shape(one: ElementTree.Element, marks: dict[str, str]) -> ElementTree.Element:
    return ElementTree.Element(one.tag, {**_attributes(one), **{key: value for key, value in marks.items() if value}})


def _attributes(one: ElementTree.Element) -> dict[str, str]:
    """All of them, but those that the tree has dealt with."""
    drop = {"clip-path", "mask", CLIPPED, CLIP}
    if _name(one) in ("symbol", "clipPath"):
        drop |= {"viewBox", "width", "height", "x", "y", "preserveAspectRatio"}
    return {key: value for key, value in one.attrib.items() if key not in drop}


def _property(one: ElementTree.Element, name: str) -> str:
    """A property of an element's own style or attributes."""
    found = re.search(rf"(?:^|;)\s*{name}\s*:\s*([^;!]*)", one.attrib.get("style", ""))
    return (found[1] if found else one.attrib.get(name, "")).strip()


def _length(text: str) -> float:
    """A number without a unit, or in px."""
    try:
        value = float(text.strip().removesuffix("px"))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise TreeError(f"expected a number, found '{text}'")
    return value
