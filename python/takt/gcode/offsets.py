"""Coordinate systems of a program (G54 to G59.3, G10 L2 and L20, G52, G92) and their offsets from the path's system.

A path is in the coordinates of the system in which its first move is made. The zeros of the systems on the machine are
in its memory, not in the program; they are known only if the program sets them (G10) or the user gives them. So each
offset is known or unknown for each axis, and a move in a system with an unknown offset is an error.
"""

from __future__ import annotations

from collections.abc import Mapping

from takt.gcode.errors import LineError
from takt.toolpath import Point

SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
Known = list[float | None]


class Offsets:
    """The offsets of all systems [mm]. `given`: zeros of systems in machine coordinates, by name."""

    def __init__(self, given: Mapping[str, Point]) -> None:
        self.active = "G54"
        self.g92 = [0.0, 0.0, 0.0]  # of G92 and G52, which share their memory
        self._saved_g92 = [0.0, 0.0, 0.0]
        self._machine: dict[str, Known] = {name: list(given[name]) if name in given else [None] * 3 for name in SYSTEMS}
        self._shift: dict[str, Known] = {}  # by system: its zero in path coordinates; empty until `fix`
        self._zero: Known = [None] * 3  # zero of the path in machine coordinates

    def shift(self) -> Point:
        """Returns the shift from coordinates of the active system to those of the path. Raises LineError if it is
        unknown for an axis."""
        self.fix()
        shift = self._shift[self.active]
        for axis, value in zip("XYZ", shift, strict=True):
            if value is None:
                raise LineError(
                    f"{self.active}: the path began in another coordinate system, and how they lie to one another in"
                    f" {axis} is not in the program; give both with --offset, {self.active} X Y Z for one"
                )
        a, b, c = shift
        return ((a or 0.0) + self.g92[0], (b or 0.0) + self.g92[1], (c or 0.0) + self.g92[2])

    def fix(self) -> None:
        """Makes the active system the one of the path, unless there is one already."""
        if self._shift:
            return
        self._zero = list(self._machine[self.active])
        for name in SYSTEMS:
            self._shift[name] = [self._from_machine(name, axis) for axis in range(3)]
        self._shift[self.active] = [0.0, 0.0, 0.0]

    def machine_zero(self) -> Point | None:
        """Returns the machine's zero in path coordinates; None if it is unknown."""
        self.fix()
        x, y, z = self._zero
        return None if x is None or y is None or z is None else (-x, -y, -z)

    def of_machine(self, name: str) -> Known:
        """Returns the zero of a system in machine coordinates, with None for axes for which it is unknown."""
        return self._machine[name]

    def set_machine(self, name: str, axis: int, value: float) -> None:
        """G10 L2: sets the zero of a system in machine coordinates."""
        self._machine[name][axis] = value
        if self._shift:
            self._shift[name][axis] = self._from_machine(name, axis)

    def set_here(self, name: str, axis: int, here: float, value: float) -> None:
        """G10 L20: sets the zero of a system so that the path coordinate `here` has this value in it."""
        self.fix()
        self._shift[name][axis] = shift = here - self.g92[axis] - value
        zero = self._zero[axis]
        self._machine[name][axis] = None if zero is None else zero + shift

    def clear_g92(self, *, keep: bool) -> None:
        """G92.1; with `keep` G92.2, whose offsets G92.3 restores."""
        if keep:
            self._saved_g92 = list(self.g92)
        else:
            self._saved_g92 = [0.0, 0.0, 0.0]
        self.g92 = [0.0, 0.0, 0.0]

    def restore_g92(self) -> None:
        self.g92 = list(self._saved_g92)

    def _from_machine(self, name: str, axis: int) -> float | None:
        value, zero = self._machine[name][axis], self._zero[axis]
        return None if value is None or zero is None else value - zero
