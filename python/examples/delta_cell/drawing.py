"""Writes the drawing of the Delta cell as G-code: python3 drawing.py > drawing.gcode

A frame with rounded corners, a rosette, a gear with another rosette in it, and the name, in mm about the middle of the
sheet. Nearly all of it are chords of half a millimetre, as a CAM system would write them.
"""

import cmath
import itertools
import math
from collections.abc import Callable

LIFT = 4.0  # mm above the sheet
DRAW, LETTERS = 18000, 9000  # mm/min
CHORD = 0.6  # mm

lines = ["(Takt: drawing of the Delta cell)", "G21 G90 G17", f"G0 Z{LIFT:g}"]


def xy(place: complex) -> str:
    return f"X{place.real:.3f} Y{place.imag:.3f}".replace("-0.000", "0.000")


def start(place: complex, feed: int = DRAW) -> None:
    """Lifts the pen, goes there and lowers it."""
    lines.extend([f"G0 Z{LIFT:g}", f"G0 {xy(place)}", f"G1 Z0 F{feed}"])


def line(to: complex) -> None:
    lines.append(f"G1 {xy(to)}")


def arc(here: complex, to: complex, centre: complex, clockwise: bool = False) -> None:
    offset = centre - here
    lines.append(f"G{2 if clockwise else 3} {xy(to)} I{offset.real:.3f} J{offset.imag:.3f}")


def frame(width: float, height: float, radius: float) -> None:
    corners = [complex(x * width / 2, y * height / 2) for x, y in ((1, -1), (1, 1), (-1, 1), (-1, -1))]
    way = 1 + 0j
    start(corners[-1] + radius * way)
    for corner in corners:
        line(corner - radius * way)
        left = way * 1j
        lines.append(f"G3 {xy(corner + radius * left)} R{radius:g}")
        way = left


def curve(place: Callable[[float], complex], span: float) -> None:
    """Chords of CHORD along a curve that closes after so many rad."""
    start(place(0))
    fine = [place(span * i / 200_000) for i in range(200_001)]
    ways = [0.0]
    for before, after in itertools.pairwise(fine):
        ways.append(ways[-1] + abs(after - before))
    count, k = round(ways[-1] / CHORD), 0
    for i in range(1, count + 1):
        while k < len(ways) - 1 and ways[k] < ways[-1] * i / count:
            k += 1
        line(fine[k])


def gear(centre: complex, teeth: int, root: float, tip: float) -> None:
    """Tips and roots are arcs about the centre, flanks lines."""
    pitch = 2 * math.pi / teeth

    def at(radius: float, angle: float) -> complex:
        return centre + cmath.rect(radius, angle)

    here = at(root, -0.2 * pitch)
    start(here)
    for tooth in range(teeth):
        middle = tooth * pitch + 0.5 * pitch
        foot = at(root, middle - 0.3 * pitch)
        arc(here, foot, centre)
        line(at(tip, middle - 0.14 * pitch))
        arc(at(tip, middle - 0.14 * pitch), at(tip, middle + 0.14 * pitch), centre)
        here = at(root, middle + 0.3 * pitch)
        line(here)


def letters(origin: complex, height: float) -> None:
    """takt, of lines and arcs."""
    r = 0.3 * height

    def t(x: float) -> None:
        foot = origin + x
        start(foot + 1j * height, LETTERS)
        line(foot + 1j * r)
        arc(foot + 1j * r, foot + r, foot + r + 1j * r)
        start(foot - 0.6 * r + 0.62j * height, LETTERS)
        line(foot + 1.1 * r + 0.62j * height)

    def a(x: float) -> None:
        centre = origin + x + r + 1j * r
        start(centre + r, LETTERS)
        arc(centre + r, centre + r, centre, clockwise=True)
        start(centre + r + 1j * r, LETTERS)
        line(centre + r - 1j * r)

    def k(x: float) -> None:
        foot = origin + x
        start(foot + 1j * height, LETTERS)
        line(foot)
        start(foot + 1.7 * r + 0.62j * height, LETTERS)
        line(foot + 0.28j * height)
        line(foot + 1.8 * r)

    t(0.0)
    a(2.0 * r)
    k(5.1 * r)
    t(8.3 * r)


frame(230, 170, 15)
frame(222, 162, 11)
curve(lambda t: -53 + 10j + cmath.rect(36, t) + cmath.rect(18, -2.6 * t), 10 * math.pi)
gear(54 + 18j, 20, 43, 50)
curve(lambda t: 54 + 18j + cmath.rect(22, t) + cmath.rect(15, -3.25 * t), 8 * math.pi)
letters(-18 - 74j, 30)
lines.extend([f"G0 Z{LIFT:g}", "G0 X0 Y0", "M2"])
print("\n".join(lines))
