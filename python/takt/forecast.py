"""What a motion is going to do, as it is planned now: commands, overrides and faults to come change it (AX-96)."""

from __future__ import annotations

from typing import NamedTuple

from takt import _core
from takt.tables import named


class Moment(NamedTuple):
    """The set point at a time."""

    position: float  # u
    velocity: float  # u/s
    acceleration: float  # u/s²


class Forecast:
    """Times are in s from the last cycle on, positions as the axis publishes them. Commands that wait behind the motion
    are not in it: each is asked for by itself."""

    def __init__(self, core: _core.Forecast, sentence: str) -> None:
        self._core = core
        self.error_id: int = core.error_id  # the command would be refused, or would fail before its turn
        self.sentence = sentence  # why
        # There is a plan: the axis follows nothing (a master, a table, a torque, a switch), nothing lies on top of its
        # motion, and the turn of the command comes within ten minutes. Otherwise the rest says nothing.
        self.known: bool = core.known
        self.held: bool = core.held  # by an override: it goes as far as where that stops it
        self.limited_by: str = named("axis", "limited_by", core.limited_by)
        self.start_s: float = core.start_s  # begin of the motion; negative: it is under way

    def __repr__(self) -> str:
        if self.error_id:
            return f"<Forecast: {self.sentence}>"
        return f"<Forecast: {self.duration_s:.6g} s>" if self.known else "<Forecast: not known>"

    @property
    def duration_s(self) -> float:
        """Until the motion is at rest, or at the velocity with which it goes on. Infinity: held."""
        return self._core.duration_s

    def time_to(self, position: float) -> float:
        """Until the set point is at `position` first; NaN: never."""
        return self._core.time_to(position)

    def at(self, time_s: float) -> Moment:
        """The set point so many seconds from now; before a motion that has not begun, what it begins with."""
        return Moment(*self._core.at(time_s))
