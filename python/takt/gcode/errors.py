"""The errors of a line of G-code."""

from __future__ import annotations


class LineError(Exception):
    """What is wrong with a line. `place`: the file and line to name, if it is not the one that is being read."""

    def __init__(self, what: str, place: str = "") -> None:
        super().__init__(what)
        self.place = place
