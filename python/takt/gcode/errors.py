"""The errors of a line of G-code."""

from __future__ import annotations


class LineError(Exception):
    """An error in a line. `place`: file and line of the error; empty: the line that is being read."""

    def __init__(self, what: str, place: str = "") -> None:
        super().__init__(what)
        self.place = place
