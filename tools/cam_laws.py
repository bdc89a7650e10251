"""Puts the peak factors of the laws of motion into docs/cams.md, each beside its closed form, and draws that page's
picture. To be called when laws or the picture change.

Usage: build/venv/bin/python tools/cam_laws.py
"""

from __future__ import annotations

import math
from math import pi, sqrt
from pathlib import Path

from takt import cam
from takt.cam_picture import picture

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "cams.md"
PICTURE = ROOT / "docs" / "images" / "cam.png"
EXAMPLE = ROOT / "python" / "examples" / "cams" / "feed.yaml"
BEGIN, END = "<!-- factors: made by tools/cam_laws.py -->\n", "<!-- end of factors -->\n"

# The sine-constant-cosine combination, as Norton has it (Cam Design and Manufacturing Handbook), for its usual shares.
SINE, COSINE = 1 / 4, 1 / 2
COMBINED = 4 * pi**2 / ((pi**2 - 8) * (SINE**2 - COSINE**2) - 2 * pi * (pi - 2) * SINE + pi**2)

JUMPS = ("∞", math.inf)
# Velocity, acceleration, jerk: closed forms of VDI 2143 and the textbooks, not by way of the engine.
CLOSED_FORMS = {
    "parabola": (("2", 2), ("4", 4), JUMPS),
    "harmonic": (("π/2", pi / 2), ("π²/2", pi**2 / 2), JUMPS),
    "cycloid": (("2", 2), ("2π", 2 * pi), ("4π²", 4 * pi**2)),
    "modified_trapezoid": (("2", 2), ("8π/(2+π)", 8 * pi / (2 + pi)), ("32π²/(2+π)", 32 * pi**2 / (2 + pi))),
    "modified_sine": (
        ("4π/(4+π)", 4 * pi / (4 + pi)),
        ("4π²/(4+π)", 4 * pi**2 / (4 + pi)),
        ("16π³/(4+π)", 16 * pi**3 / (4 + pi)),
    ),
    "polynomial_345": (("15/8", 15 / 8), ("10/√3", 10 / sqrt(3)), ("60", 60)),
    "polynomial_4567": (("35/16", 35 / 16), ("84√5/25", 84 * sqrt(5) / 25), ("105/2", 105 / 2)),
    "double_harmonic": (("3√3π/8", 3 * sqrt(3) * pi / 8), ("π²", pi**2), JUMPS),
    "sine_constant_cosine": (
        ("A(3/(4π) + 1/8)", COMBINED * (SINE / pi + (1 - SINE - COSINE) / 2 + COSINE / pi)),
        ("A = 64π²/(16π² - 8π(π-2) - 3(π²-8))", COMBINED),
        ("4πA", COMBINED * pi / min(SINE, COSINE)),
    ),
}


def factors() -> str:
    """The table: what the engine says, to eight digits, and the closed form behind it."""
    lines = ["| law | velocity | acceleration | jerk |", "|---|---|---|---|"]
    for law, forms in CLOSED_FORMS.items():
        found = cam.law_factors(law)
        cells = [_cell(value, text) for value, (text, _) in zip(found, forms, strict=True)]
        lines.append(f"| `{law}` | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _cell(value: float, text: str) -> str:
    number = "∞" if math.isinf(value) else f"{value:.8g}"
    return number if number == text else f"{number} = {text}"


def page(text: str) -> str:
    """The page with its table made anew."""
    before, rest = text.split(BEGIN)
    _, behind = rest.split(END)
    return before + BEGIN + factors() + END + behind


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    print(picture(cam.Table.from_yaml(EXAMPLE), PICTURE, master_velocity=360.0))
