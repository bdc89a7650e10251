"""What moves instead of simulated servos, in the process of a `takt.Engine` and in step with it (PY-23).

A `Plant` is told the set points of all its axes in one call a cycle and says what their wires read at its end. Time
stands still meanwhile, and nothing goes over a network; drives in other processes are in takt.drive.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from takt import _core
from takt.drive import Drive, Measured, SetPoint
from takt.errors import ConfigError, TaktError

if TYPE_CHECKING:
    from takt.recording import Recording

TOLD: Final[np.dtype[np.void]] = _core.told_layout()
MEASURED: Final[np.dtype[np.void]] = _core.measured_layout()

Rows = npt.NDArray[np.void]  # one an axis; a column is told["position_counts"]


class PlantError(TaktError):
    """A plant cannot go on. The engine's cycle before it is complete, and what was recorded stays readable."""


class Plant(ABC):
    """All that moves the axes named in `axes`, stepped once a cycle with the set points of all of them.

    The columns of `told` and `measured` have the names and units of takt.drive.SetPoint and takt.drive.Measured; and
    `measured` has true_position, where the load really is in the unit of the axis, which is only published. Both are
    the engine's own memory: no reference to them may be kept. What is not written into `measured` stays as it was.
    """

    axes: Sequence[str]  # names; the order of the rows

    def start(self, machine: Mapping[str, Any], period_s: float) -> None:  # noqa: B027 (may be left as it is)
        """An engine of this machine has been made, and no cycle has run. `machine`: as `session.machine` has it."""

    @abstractmethod
    def step(self, cycle: int, told: Rows, measured: Rows) -> None:
        """Carries the set points of a cycle out and writes what the wires read at its end. The first one has the number
        -1 and says off. What it raises comes out of the engine's step, whose cycle `cycle + 1` then does not run; that
        engine makes no further cycle. It must not use the engine itself."""

    def finish(self, recording: Recording) -> None:  # noqa: B027 (may be left as it is)
        """A recording of the engine has ended: what the plant knows beside it may go into its `meta`."""


class Drives(Plant):
    """Drives that answer each for itself (takt.drive.Drive), in this process.

    drives: by the names of their axes.
    """

    def __init__(self, drives: Mapping[str, Drive]) -> None:
        if not drives:
            raise TaktError("a plant needs at least one drive")
        self.axes = tuple(drives)
        self._drives = tuple(drives.values())
        self._period_s = 0.0

    def start(self, machine: Mapping[str, Any], period_s: float) -> None:
        self._period_s = period_s
        for drive in self._drives:
            drive.start()

    def step(self, cycle: int, told: Rows, measured: Rows) -> None:
        for row, drive in enumerate(self._drives):
            values = dict(zip(_TOLD, told[row].item(), strict=True))
            answer = drive.step(SetPoint(**values, period_s=self._period_s), self._period_s)
            said = [int(getattr(answer, n)) & _WRAP if n in _COUNTERS else getattr(answer, n) for n in _SAID]
            measured[row] = (*said, np.nan)


_TOLD: Final = TOLD.names or ()
_SAID: Final = tuple(name for name in MEASURED.names or () if name != "true_position")
_COUNTERS: Final = {name for name in _SAID if MEASURED[name].kind == "u"}
_WRAP: Final = 0xFFFF_FFFF
assert set(_TOLD) <= {field.name for field in fields(SetPoint)}
assert set(_SAID) == {field.name for field in fields(Measured)}


def axes_of(plant: Plant, machine: Mapping[str, Any], file_name: str) -> list[str]:
    """The axes that a plant moves, in its order. Raises ConfigError where it does not fit the machine."""
    axes = list(getattr(plant, "axes", ()))
    known = [axis["name"] for axis in machine["axes"]]
    external = [drive["axis"] for drive in machine["external"]["drives"]]
    problems = [] if axes else [f"{file_name}: the plant {type(plant).__name__} moves no axes"]
    for axis in axes:
        if axis not in known:
            problems.append(f"{file_name}: the plant moves axis {axis!r}, which the machine does not have")
        elif axes.count(axis) > 1:
            problems.append(f"{file_name}: the plant moves axis {axis!r} twice")
    left = [axis for axis in external if axis not in axes]
    if axes and left:
        names = ", ".join(left)
        problems.append(f"{file_name}: external.drives has {names}, which the plant does not move; one plant moves all")
    if problems:
        raise ConfigError(list(dict.fromkeys(problems)))
    return axes
