"""Canned drilling cycles: G73, G81, G82, G83, G85, G89.

Source: the manual of LinuxCNC, G80 to G89. Between two pecks the tool retracts by CLEARANCE (G73), or to R and back
down to CLEARANCE above the depth reached (G83); other controllers have other clearances, in their settings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from takt.gcode.errors import LineError
from takt.gcode.geometry import PLANES, PathBuilder
from takt.toolpath import Point

if TYPE_CHECKING:
    from takt.gcode.machine import Modal

CLEARANCE = 0.254  # [mm] as in LinuxCNC
MOST = 100_000  # repeats, and pecks of one hole


class Cycle:
    """The words of a cycle, which are modal as long as the cycle is active."""

    def __init__(self) -> None:
        self._depth: float | None = None  # [mm] as programmed
        self._retract: float | None = None
        self._peck: float | None = None
        self._old: float | None = None  # [mm] height at which the cycle began, in path coordinates

    def run(self, code: str, numbers: dict[str, float], modal: Modal, shift: Point, path: PathBuilder) -> None:
        """Appends the holes of a line to the path. numbers: words of the line; shift: path coordinates of the zero of
        the active system [mm]. Raises LineError if words are missing or invalid."""
        first, second, third = PLANES[modal.plane]
        letters, unit = "XYZ", modal.unit
        if modal.inverse_time or modal.diameters:
            raise LineError(f"{code} is not read together with G93 or G7")
        count = numbers.get("L", 1.0)
        if count != math.floor(count) or not 1 <= count <= MOST:
            raise LineError(f"L: expected a whole number of repeats from 1 to {MOST:,}, found {count:g}")
        if letters[third] in numbers:
            self._depth = numbers[letters[third]] * unit
        if "R" in numbers:
            self._retract = numbers["R"] * unit
        if "Q" in numbers:
            self._peck = numbers["Q"] * unit
        if self._depth is None or self._retract is None:
            raise LineError(f"{code}: expected {letters[third]}, the depth, and R, the height between holes")
        if code in ("G73", "G83") and not (self._peck is not None and self._peck > 0):
            raise LineError(f"{code}: expected Q, the depth of a peck, above 0")
        here = list(path.here)
        self._old = here[third] if self._old is None else self._old
        retract = self._retract + (self._old if modal.relative else shift[third])
        bottom = self._depth + (retract if modal.relative else shift[third])
        if retract < bottom:
            raise LineError(f"{code}: R lies {bottom - retract:.6g} mm below the bottom of the hole")
        clear = retract if modal.retract_to_r else max(self._old, retract)

        def rapid(height: float) -> None:
            here[third] = height
            path.line((here[0], here[1], here[2]), None)

        if here[third] < retract:
            rapid(retract)
        for _ in range(int(count)):
            for axis in (first, second):
                if letters[axis] in numbers:
                    value = numbers[letters[axis]] * unit
                    here[axis] = here[axis] + value if modal.relative else value + shift[axis]
            rapid(here[third])
            rapid(retract)
            self._hole(code, here, third, (retract, bottom), modal, path)
            rapid(clear)

    def _hole(
        self, code: str, here: list[float], third: int, heights: tuple[float, float], modal: Modal, path: PathBuilder
    ) -> None:
        retract, bottom = heights

        def go(height: float, velocity: float | None) -> None:
            here[third] = height
            path.line((here[0], here[1], here[2]), velocity)

        if code in ("G73", "G83"):
            peck = self._peck or 0.0
            if (retract - bottom) / peck > MOST:
                raise LineError(f"{code}: more than {MOST:,} pecks of {peck:.6g} mm")
            depth = retract - peck
            while depth > bottom:
                go(depth, modal.feed)
                if code == "G73":
                    go(depth + CLEARANCE, None)
                else:
                    go(retract, None)
                    go(depth + CLEARANCE, None)
                depth -= peck
        go(bottom, modal.feed)
        if code in ("G85", "G89"):
            go(retract, modal.feed)
