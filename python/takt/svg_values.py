"""Parses attributes of SVG: lengths, transforms, points, path data. Matrices are (a, b, c, d, e, f) as in SVG."""

from __future__ import annotations

import math
import re

Matrix = tuple[float, float, float, float, float, float]
IDENTITY: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
PX = 96 / 25.4  # px per mm
FONT = 16.0  # px, default font size
NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_UNITS = {"": 1.0, "px": 1.0, "mm": PX, "cm": 10 * PX, "q": PX / 4, "in": 96.0, "pt": 96 / 72, "pc": 16.0}
_ANGLES = {"": 1.0, "deg": 1.0, "grad": 0.9, "rad": 180 / math.pi, "turn": 360.0}
_FUNCTIONS = {  # possible numbers of arguments
    "matrix": (6,), "translate": (1, 2), "translatex": (1,), "translatey": (1,), "scale": (1, 2), "scalex": (1,),
    "scaley": (1,), "rotate": (1, 3), "skewx": (1,), "skewy": (1,),
}  # fmt: skip
_WORD = re.compile(rf"\s*({NUMBER})\s*(%|[A-Za-z]*)\s*")
_ARGUMENT = re.compile(rf"[\s,]*({NUMBER})(%|[A-Za-z]*)")
_FUNCTION = re.compile(r"[\s,]*([A-Za-z0-9]+)\s*\(([^()]*)\)[\s,]*")
_PATH_WORD = re.compile(rf"\s*(?:,\s*)?({NUMBER})")
_PATH_FLAG = re.compile(r"\s*(?:,\s*)?[01]")
_PATH = {"m": 2, "l": 2, "h": 1, "v": 1, "c": 6, "s": 4, "q": 4, "t": 2, "a": 7}


class TreeError(Exception):
    """A drawing cannot be read; the text says why."""


def length(text: str, whole: float = math.nan, font: float = FONT) -> float:
    """Returns a length [px]. `whole`: 100 % [px]; NaN: a percentage is an error. Raises TreeError."""
    match = _WORD.fullmatch(text)
    value = float(match[1]) if match else math.nan
    if match is None or not math.isfinite(value):
        raise TreeError(f"expected a number, found '{text[:40]}'")
    unit = match[2].lower()
    if unit == "%":
        value *= whole / 100
    elif unit in ("em", "ex", "rem"):
        value *= {"em": font, "ex": font / 2, "rem": FONT}[unit]
    else:
        value *= _UNITS.get(unit, math.nan)
    if math.isnan(value):
        raise TreeError(f"the unit of '{text.strip()[:40]}' is not read; expected px, mm, cm, in, pt, pc or em")
    return value


def product(outer: Matrix, inner: Matrix) -> Matrix:
    """Returns the product of two matrices: the inner one is applied first."""
    a, b, c, d, e, f = outer
    g, h, i, j, k, m = inner
    return (a * g + c * h, b * g + d * h, a * i + c * j, b * i + d * j, a * k + c * m + e, b * k + d * m + f)


def inverse(matrix: Matrix) -> Matrix | None:
    a, b, c, d, e, f = matrix
    area = a * d - b * c
    if not (math.isfinite(area) and area != 0):
        return None
    return (d / area, -b / area, -c / area, a / area, (c * f - d * e) / area, (b * e - a * f) / area)


def moved(x: float, y: float) -> Matrix:
    return (1.0, 0.0, 0.0, 1.0, x, y)


def transform(text: str, font: float = FONT) -> Matrix:
    """Returns the matrix of a transform attribute or property. Raises TreeError."""
    matrix, at = IDENTITY, 0
    if text.strip().lower() in ("", "none"):
        return matrix
    while at < len(text):
        match = _FUNCTION.match(text, at)
        if not match:
            raise _no_transform(text)
        matrix = product(matrix, _function(match[1].lower(), match[2], text, font))
        at = match.end()
    return matrix


def _no_transform(text: str) -> TreeError:
    shown = text if len(text) < 60 else text[:57] + "..."
    return TreeError(f"the transform '{shown}' is not read; expected matrix, translate, scale, rotate, skewX or skewY")


def _function(name: str, arguments: str, text: str, font: float) -> Matrix:
    found, at = [], 0
    while match := _ARGUMENT.match(arguments, at):
        found.append((match[1], match[2].lower()))
        at = match.end()
    if arguments[at:].strip() or len(found) not in _FUNCTIONS.get(name, ()):
        raise _no_transform(text)
    if name in ("rotate", "skewx", "skewy"):
        number, unit = found[0]
        if unit not in _ANGLES:
            raise _no_transform(text)
        angle = math.radians(float(number) * _ANGLES[unit])
        if name != "rotate":
            slope = math.tan(angle)
            return (1.0, 0.0, slope, 1.0, 0.0, 0.0) if name == "skewx" else (1.0, slope, 0.0, 1.0, 0.0, 0.0)
        x, y = (length(a + b, font=font) for a, b in found[1:]) if len(found) == 3 else (0.0, 0.0)
        cos, sin = math.cos(angle), math.sin(angle)
        if abs(cos * sin) < 1e-15:  # quarters of a turn are exact
            cos, sin = float(round(cos)), float(round(sin))
        return (cos, sin, -sin, cos, x - cos * x + sin * y, y - sin * x - cos * y)
    if name.startswith("translate"):
        values = [length(a + b, font=font) for a, b in found]
        if name == "translatey":
            return moved(0.0, values[0])
        return moved(values[0], values[1] if len(values) == 2 else 0.0)
    if any(unit for _, unit in found):
        raise _no_transform(text)
    values = [float(number) for number, _ in found]
    if name == "matrix":
        return (values[0], values[1], values[2], values[3], values[4], values[5])
    x = 1.0 if name == "scaley" else values[0]
    y = 1.0 if name == "scalex" else values[-1]
    return (x, 0.0, 0.0, y, 0.0, 0.0)


def view_box(text: str) -> tuple[float, float, float, float] | None:
    """Returns x, y, width and height of a viewBox attribute; None if it is empty. Raises TreeError."""
    words = re.split(r"\s*,\s*|\s+", text.strip()) if text.strip() else []
    if not words:
        return None
    if len(words) != 4:
        raise TreeError(f"viewBox: expected four numbers, found '{text[:60]}'")
    x, y, width, height = (length(word) for word in words)
    if width < 0 or height < 0:
        raise TreeError(f"viewBox: expected a size above 0, found '{text[:60]}'")
    return (x, y, width, height)


def fitted(box: tuple[float, float, float, float], width: float, height: float, aspect: str) -> Matrix:
    """Returns the matrix from a view box of a size above 0 to a viewport at (0, 0), by preserveAspectRatio (SVG 2,
    8.2)."""
    words = aspect.split()
    words = words[1:] if words[:1] == ["defer"] else words
    align = words[0] if words else "xMidYMid"
    match = re.fullmatch("x(Min|Mid|Max)Y(Min|Mid|Max)", align)
    if (align != "none" and not match) or words[1:] not in ([], ["meet"], ["slice"]):
        raise TreeError(f"preserveAspectRatio: expected none or xMidYMid and the like, found '{aspect[:40]}'")
    x, y = width / box[2], height / box[3]
    if not match:
        return (x, 0.0, 0.0, y, -box[0] * x, -box[1] * y)
    scale = max(x, y) if words[1:] == ["slice"] else min(x, y)
    share = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    across, down = share[match[1]] * (width - box[2] * scale), share[match[2]] * (height - box[3] * scale)
    return (scale, 0.0, 0.0, scale, across - box[0] * scale, down - box[1] * scale)


def points(text: str) -> tuple[list[complex], bool]:
    """Returns the points before the first error, and whether there is one."""
    found: list[float] = []
    at = 0
    while match := _PATH_WORD.match(text, at):
        found.append(float(match[1]))
        at = match.end()
    wrong = bool(text[at:].strip()) or len(found) % 2 == 1
    return [complex(x, y) for x, y in zip(found[::2], found[1::2], strict=False)], wrong


def path_data(text: str) -> tuple[str, bool]:
    """Returns the path data before the first error (SVG 1.1, F.2), and whether there is one."""
    at = good = 0
    while at < len(text):
        letter = text[at].lower()
        if letter.isspace():
            at += 1
        elif letter == "z" and good:
            at = good = at + 1
        elif letter in _PATH and (good or letter == "m"):
            end = _arguments(text, at + 1, letter)
            if end is None:
                return text[:good], True
            while end is not None:
                at = good = end
                end = _arguments(text, at, letter)
        else:
            return text[:good], True
    return text[:good], False


def _arguments(text: str, at: int, letter: str) -> int | None:
    """Returns the end of one set of arguments of a command; None if it is incomplete or wrong."""
    for i in range(_PATH[letter]):
        match = (_PATH_FLAG if letter == "a" and i in (3, 4) else _PATH_WORD).match(text, at)
        if match is None or (letter == "a" and i < 2 and float(match[1]) < 0):
            return None
        at = match.end()
    return at
