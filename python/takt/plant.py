"""Plants: simulations that move axes instead of simulated servos, in the process of a `takt.Engine` and in lockstep
with it (PY-23).

A `Plant` receives the set points of all its axes in one call per cycle and returns the measured values at its end.
Engine time does not advance meanwhile, and no network is involved; for drives in other processes see takt.drive.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from takt import _core
from takt.drive import Bus, Drive, Measured, SetPoint
from takt.errors import ConfigError, TaktError

if TYPE_CHECKING:
    from takt.recording import Recording

TOLD: Final[np.dtype[np.void]] = _core.told_layout()
MEASURED: Final[np.dtype[np.void]] = _core.measured_layout()

Rows = npt.NDArray[np.void]  # one row per axis; a column is told["position_counts"]


class PlantError(TaktError):
    """A plant cannot continue. The engine's previous cycle is complete, and recordings stay readable."""


class Plant(ABC):
    """Moves the axes named in `axes`; stepped once per cycle with the set points of all of them.

    The columns of `told` and `measured` have the names and units of takt.drive.SetPoint and takt.drive.Measured; in
    addition `measured` has true_position, the true position of the load in the unit of the axis, which is only
    published. Both arrays are the engine's own memory: do not keep references to them. Values not written into
    `measured` keep their previous value.
    """

    axes: Sequence[str]  # names, in the order of the rows

    def start(self, machine: Mapping[str, Any], period_s: float) -> None:  # noqa: B027 (may be left as it is)
        """Called when an engine of this machine has been made, before its first cycle. `machine`: as
        `session.machine`."""

    @abstractmethod
    def step(self, cycle: int, told: Rows, measured: Rows) -> None:
        """Applies the set points `told` of a cycle and writes the values at its end into `measured`.

        The first call has cycle -1 and set points that mean off. An exception is raised from the engine's step: cycle
        `cycle + 1` and all later ones do not run. This method must not use the engine.
        """

    def finish(self, recording: Recording) -> None:  # noqa: B027 (may be left as it is)
        """Called when a recording of the engine has ended; may add data of the plant to its `meta`."""


class Drives(Plant):
    """A plant of independent drives (takt.drive.Drive), in this process.

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


class OnNetwork(Bus):
    """A plant in a process of its own, for an engine on an LCM network, in real time or in simulated time: pass it to
    takt.drive.Plant as a bus. Its true_position is not sent to the engine and is not in recordings.

    make: returns a plant in its initial state; called again for each engine that starts.
    machine: all parameters of the machine, as `session.machine`.
    """

    def __init__(self, make: Callable[[], Plant], machine: Mapping[str, Any]) -> None:
        self._make, self._machine = make, machine
        self.period_s = float(machine["cycle"]["period_s"])
        self._begin()
        self.axes = tuple(self.plant.axes)

    def _begin(self) -> None:
        self.plant = self._make()
        self.plant.start(self._machine, self.period_s)
        self._rows = {axis: row for row, axis in enumerate(self.plant.axes)}
        self._told, self._measured = np.zeros(len(self._rows), TOLD), np.zeros(len(self._rows), MEASURED)
        self._started: set[str] = set()
        self._heard: set[str] = set()  # axes whose set point of this cycle has been received
        self._before: dict[str, Measured | None] = {}
        self._cycle = -1

    def start(self, axis: str, *, real_time: bool, period_s: float) -> None:
        if period_s != self.period_s:
            raise PlantError(f"the engine has cycles of {period_s:g} s, the machine file says {self.period_s:g} s")
        if axis in self._started:  # of another engine
            self._begin()
        self._started.add(axis)
        if real_time and self._cycle == -1:  # the first answer is measured before any set point
            self._step()

    def exchange(self, told: Mapping[str, SetPoint], *, real_time: bool) -> Mapping[str, Measured | None]:
        late = real_time and self._heard.isdisjoint(told)  # rest of a cycle already carried out without these axes
        for axis, point in told.items():
            self._told[self._rows[axis]] = tuple(getattr(point, name) for name in _TOLD)
        if late and self._heard:
            self._heard |= set(told)
            return self._before
        self._heard = set(told)
        self._before = self._answers()
        self._step()
        return self._before if real_time else self._answers()

    def idle(self, stop: Collection[str]) -> None:
        if stop:  # there was an engine before: motors are off, brakes hold
            self._told[:] = np.zeros((), TOLD)
            self._step()

    def _step(self) -> None:
        self.plant.step(self._cycle, self._told, self._measured)
        self._cycle += 1

    def _answers(self) -> dict[str, Measured | None]:
        return {
            axis: Measured(**{name: self._measured[name][row].item() for name in _SAID})
            for axis, row in self._rows.items()
        }


_TOLD: Final = TOLD.names or ()
_SAID: Final = tuple(name for name in MEASURED.names or () if name != "true_position")
_COUNTERS: Final = {name for name in _SAID if MEASURED[name].kind == "u"}
_WRAP: Final = 0xFFFF_FFFF
assert set(_TOLD) <= {field.name for field in fields(SetPoint)}
assert set(_SAID) == {field.name for field in fields(Measured)}


def axes_of(plant: Plant, machine: Mapping[str, Any], file_name: str) -> list[str]:
    """Returns the axes that a plant moves, in its order. Raises ConfigError if the plant does not fit the machine."""
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
