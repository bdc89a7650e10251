"""Forecasts of a motion as planned now; later commands, overrides and faults change it (AX-96)."""

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
    """The forecast of one motion. Times are in [s] from the last cycle on, positions as the axis publishes them.
    Commands buffered behind the motion are not included; each has its own forecast."""

    def __init__(self, core: _core.Forecast, sentence: str) -> None:
        self._core = core
        self.error_id: int = core.error_id  # not 0: the command would be refused, or would fail before it starts
        self.sentence = sentence  # why
        # Whether there is a plan: the axis follows nothing (a master, a table, a torque, a switch), nothing is
        # superimposed on its motion, and the command starts within ten minutes. If False, the values below are
        # meaningless.
        self.known: bool = core.known
        self.held: bool = core.held  # by an override: the motion ends where the override stops it
        self.limited_by: str = named("axis", "limited_by", core.limited_by)
        self.start_s: float = core.start_s  # start of the motion; negative: in progress

    def __repr__(self) -> str:
        if self.error_id:
            return f"<Forecast: {self.sentence}>"
        return f"<Forecast: {self.duration_s:.6g} s>" if self.known else "<Forecast: not known>"

    @property
    def duration_s(self) -> float:
        """Time [s] until the motion is at rest or has reached its final velocity; infinity if it is held."""
        return self._core.duration_s

    def time_to(self, position: float) -> float:
        """Returns the time [s] until the set point first is at `position`; NaN: never."""
        return self._core.time_to(position)

    def at(self, time_s: float) -> Moment:
        """Returns the set point in `time_s` [s] from now; the initial set point before a motion has begun."""
        return Moment(*self._core.at(time_s))
