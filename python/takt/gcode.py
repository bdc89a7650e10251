"""Reads G-code (RS-274, ISO 6983) into a path for a tool.

Read are: G0 G1 G2 G3 (lines, arcs by I J K or R, helices, turns by P), G17 G18 G19 (plane), G20 G21 (inch, mm),
G90 G91 (absolute, relative), G90.1 G91.1 (the same for I J K), F (mm or inch a minute), N, comments, M2 and M30.
Words that only say what holds anyway (G40 G49 G54 G61 G64 G80 G94) change nothing. M codes, S, T, E, D, H and G4 say
nothing about the path; they are left out, and said to be. All else is an error: a path that is not the one in the file
is worse than none.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from os import PathLike
from pathlib import Path

from takt.toolpath import SAME, Element, Point, Toolpath, ToolpathError, chords, split_turn

INCH = 25.4  # mm
# The ends of an arc may be unequally far from its centre by so much: mm, or the share of its radius if that is more.
RADIUS_SLACK, RADIUS_SHARE = 0.005, 0.001

_WORD = re.compile(r"([A-Z])([-+]?(?:\d+\.?\d*|\.\d+))")
_COMMENT = re.compile(r"\([^()]*\)|;.*")
# Of each group one may stand in a line.
_GROUPS = {
    "motion": ("G0", "G1", "G2", "G3", "G80"),
    "plane": ("G17", "G18", "G19"),
    "units": ("G20", "G21"),
    "distances": ("G90", "G91"),
    "distances of centres": ("G90.1", "G91.1"),
}
_GROUP_OF = {code: group for group, codes in _GROUPS.items() for code in codes}
_HOLD_ANYWAY = ("G40", "G49", "G54", "G61", "G64", "G94")
_LEFT_OUT = "STEDH"
# First and second axis of each plane, counterclockwise as seen from the third.
_PLANES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}


def read_gcode(path: str | PathLike[str], start: Point = (0.0, 0.0, 0.0), tolerance: float = 0.005) -> Toolpath:
    """Reads a file. `start`: where the tool is when the program begins, in mm. `tolerance`: of the lines that a helix
    becomes, in mm. Raises ToolpathError."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise ToolpathError(f"{path}: is no text ({error.reason} at byte {error.start})") from None
    return parse_gcode(text, start, tolerance, source=str(path))


def parse_gcode(
    text: str, start: Point = (0.0, 0.0, 0.0), tolerance: float = 0.005, *, source: str = "G-code"
) -> Toolpath:
    """The same of text; `source` is what errors call it."""
    program = _Program(start, tolerance)
    for number, line in enumerate(text.splitlines(), 1):
        try:
            if not program.run(line):
                break
        except _WrongLineError as error:
            raise ToolpathError(f"{source}:{number}: {error}") from None
    left_out = tuple(f"{word} ({count} time{'s' * (count > 1)})" for word, count in program.left_out.items())
    return Toolpath(start, tuple(program.elements), left_out)


class _WrongLineError(Exception):
    """What is wrong with a line."""


class _Words:
    """The words of one line; what is taken is gone."""

    def __init__(self, line: str) -> None:
        code = re.sub(r"\s", "", _COMMENT.sub("", line)).upper()
        self.codes: dict[str, str] = {}  # by their group
        self.other_codes: list[str] = []
        self.numbers: dict[str, float] = {}
        at = 0
        while at < len(code) and code != "%":
            word = _WORD.match(code, at)
            if not word:
                raise _WrongLineError(f"expected a letter and a number, found '{code[at : at + 12]}'")
            self._add(word[1], word[2])
            at = word.end()

    def _add(self, letter: str, number: str) -> None:
        if letter in "GM":
            code = f"{letter}{float(number):g}"
            group = _GROUP_OF.get(code)
            if group is None:
                self.other_codes.append(code)
            elif group in self.codes:
                raise _WrongLineError(f"{self.codes[group]} and {code} exclude each other in one line")
            else:
                self.codes[group] = code
        elif letter in self.numbers:
            raise _WrongLineError(f"{letter} is given twice")
        else:
            self.numbers[letter] = float(number)


class _Program:
    """What holds from one line to the next."""

    def __init__(self, start: Point, tolerance: float) -> None:
        self.elements: list[Element] = []
        self.left_out: Counter[str] = Counter()
        self._here = start
        self._tolerance = tolerance
        self._holds: dict[str, str | None] = {
            "motion": None,
            "plane": "G17",
            "units": "G21",
            "distances": "G90",
            "distances of centres": "G91.1",
        }
        self._feed: float | None = None  # mm/s

    def run(self, line: str) -> bool:
        """Takes a line. False: the program ends with it."""
        words = _Words(line)
        numbers = words.numbers
        numbers.pop("N", None)
        self._holds |= words.codes
        unit = INCH if self._holds["units"] == "G20" else 1.0
        ends = self._other_codes(words)
        for letter in _LEFT_OUT:
            if numbers.pop(letter, None) is not None:
                self.left_out[letter] += 1
        if "F" in numbers:
            feed = numbers.pop("F") * unit / 60
            if not feed > 0:
                raise _WrongLineError("F: expected a number above 0")
            self._feed = feed
        self._move(numbers, "motion" in words.codes, unit)
        return not ends

    def _other_codes(self, words: _Words) -> bool:
        ends = False
        for code in words.other_codes:
            if code in ("M2", "M30"):
                ends = True
            elif code[0] == "M" or code == "G4":
                self.left_out[code] += 1
                if not words.numbers.keys() & set("IJKR"):
                    words.numbers.pop("P", None)  # theirs, not turns of an arc
            elif code not in _HOLD_ANYWAY:
                raise _WrongLineError(f"{code} is not read")
        return ends

    def _move(self, numbers: dict[str, float], told: bool, unit: float) -> None:
        motion = self._holds["motion"]
        relative = self._holds["distances"] == "G91"
        arc = motion in ("G2", "G3")
        allowed = "XYZIJKRP" if arc else "XYZ"
        for letter in numbers:
            if letter not in allowed:
                raise _WrongLineError(
                    f"{letter} is not read" + ("" if letter not in "IJKRP" else " but with G2 and G3")
                )
        if not numbers and not (told and arc):
            return
        if motion not in ("G0", "G1", "G2", "G3"):
            raise _WrongLineError(f"expected G0, G1, G2 or G3 before {next(iter(numbers))}")
        end = list(self._here)
        for axis, letter in enumerate("XYZ"):
            if letter in numbers:
                end[axis] = numbers[letter] * unit + (self._here[axis] if relative else 0.0)
        target = (end[0], end[1], end[2])
        if arc:
            self._arc(target, numbers, unit)
        else:
            self._line(target, None if motion == "G0" else self._feed)
        self._here = target

    def _line(self, end: Point, velocity: float | None) -> None:
        begin = self.elements[-1].end if self.elements else self._here
        if math.dist(begin, end) >= SAME:
            self.elements.append(Element(end, None, velocity))

    def _arc(self, end: Point, numbers: dict[str, float], unit: float) -> None:
        first, second, third = _PLANES[str(self._holds["plane"])]
        centre = self._centre(end, numbers, unit)
        out = [self._here[axis] - centre[i] for i, axis in enumerate((first, second))]
        back = [end[axis] - centre[i] for i, axis in enumerate((first, second))]
        radius, last = math.hypot(*out), math.hypot(*back)
        if radius < SAME:
            raise _WrongLineError("the centre of the arc is where it begins")
        if abs(radius - last) > max(RADIUS_SLACK, RADIUS_SHARE * radius):
            raise _WrongLineError(f"the arc begins {radius:.6g} mm from its centre, but ends {last:.6g} mm from it")
        sign = 1 if self._holds["motion"] == "G3" else -1
        from_angle = math.atan2(out[1], out[0])
        sweep = (sign * (math.atan2(back[1], back[0]) - from_angle)) % (2 * math.pi)
        whole = math.hypot(end[first] - self._here[first], end[second] - self._here[second]) < SAME
        sweep = 2 * math.pi if whole else sweep
        turns = numbers.get("P", 1.0)
        if turns != int(turns) or turns < 1:
            raise _WrongLineError(f"P: expected a whole number of turns from 1 on, found {turns:g}")
        sweep += 2 * math.pi * (turns - 1)
        rise = end[third] - self._here[third]

        def place(share: float) -> Point:
            angle, r = from_angle + sign * share * sweep, radius + share * (last - radius)
            point = [0.0, 0.0, 0.0]
            point[first], point[second] = centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle)
            point[third] = self._here[third] + share * rise
            return (point[0], point[1], point[2])

        if abs(rise) < SAME:
            count = split_turn(sweep)
            for i in range(count):
                to = end if i + 1 == count else place((i + 1) / count)
                self.elements.append(Element(to, place((i + 0.5) / count), self._feed))
        else:
            count = chords(sweep, radius, self._tolerance)
            for i in range(count):
                self._line(end if i + 1 == count else place((i + 1) / count), self._feed)

    def _centre(self, end: Point, numbers: dict[str, float], unit: float) -> tuple[float, float]:
        first, second, third = _PLANES[str(self._holds["plane"])]
        letters = "IJK"
        if letters[third] in numbers:
            raise _WrongLineError(f"{letters[third]} is no way in the plane of {self._holds['plane']}")
        given = [letters[axis] in numbers for axis in (first, second)]
        if "R" in numbers:
            if any(given):
                raise _WrongLineError(f"R and {letters[first]}, {letters[second]} exclude each other")
            return self._centre_by_radius(end, numbers["R"] * unit)
        if not any(given):
            raise _WrongLineError(f"expected {letters[first]}, {letters[second]} or R for an arc")
        if self._holds["distances of centres"] == "G90.1":
            if not all(given):
                raise _WrongLineError(f"expected both {letters[first]} and {letters[second]} after G90.1")
            return (numbers[letters[first]] * unit, numbers[letters[second]] * unit)
        return (
            self._here[first] + numbers.get(letters[first], 0.0) * unit,
            self._here[second] + numbers.get(letters[second], 0.0) * unit,
        )

    def _centre_by_radius(self, end: Point, given: float) -> tuple[float, float]:
        first, second, _ = _PLANES[str(self._holds["plane"])]
        way = (end[first] - self._here[first], end[second] - self._here[second])
        chord, radius = math.hypot(*way), abs(given)
        if chord < SAME:
            raise _WrongLineError("an arc by R must end elsewhere than it begins; use I, J, K for whole turns")
        if radius < chord / 2 - max(RADIUS_SLACK, RADIUS_SHARE * radius):
            raise _WrongLineError(
                f"R: the ends of the arc are {chord:.6g} mm apart, too far for a radius of {radius:.6g} mm"
            )
        # The centre lies to the left of the way of a counterclockwise arc of less than half a turn.
        side = 1 if (self._holds["motion"] == "G3") == (given > 0) else -1
        height = side * math.sqrt(max(radius**2 - chord**2 / 4, 0.0)) / chord
        return (
            self._here[first] + way[0] / 2 - height * way[1],
            self._here[second] + way[1] / 2 + height * way[0],
        )
