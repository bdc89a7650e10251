"""Numbered and named parameters of RS274/NGC: those that a program sets, and those that read the controller's state."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from takt.gcode.errors import LineError
from takt.gcode.offsets import SYSTEMS

if TYPE_CHECKING:
    from takt.gcode.machine import Machine

LOCAL = 30  # numbered parameters up to this one are local to a sub
MOST = 5602
_AXES = "xyz"
# Numbers of parameters whose values only the machine knows: first, last, meaning.
_OF_THE_MACHINE = ((5061, 5070, "the place where a probe was touched"), (5399, 5399, "an input of the machine"),
                   (5401, 5413, "the tool's table"))  # fmt: skip


class Parameters:
    """Values by number or name. `given`: values from the user, which take precedence over those of the machine."""

    def __init__(self, machine: Machine, given: Mapping[str, float]) -> None:
        self._machine = machine
        self._numbers: dict[int, float] = {}
        self._globals: dict[str, float] = {}
        self.locals: dict[str, float] = {}
        self._read_only = _read_only(machine)
        self.returned: float | None = None
        self.level = 0
        for name, value in given.items():
            if name.isdigit():
                self._numbers[int(name)] = value
            else:
                self._globals[name.upper()] = value
        self._given = {int(name) for name in given if name.isdigit()}

    def number(self, index: float) -> float:
        n = _index(index)
        if n in self._numbers:
            return self._numbers[n]
        if n <= 5000:
            return 0.0
        return self._special(n)

    def name(self, name: str) -> float:
        found = self._look_up(name)
        if found is None:
            hint = "; --set gives it a value" if name.startswith("_") else ""
            raise LineError(f"#<{name.lower()}> has no value{hint}")
        return found

    def exists(self, name: str) -> bool:
        return self._look_up(name) is not None

    def set_number(self, index: float, value: float) -> None:
        n = _index(index)
        if 5021 <= n <= 5029 or 5400 <= n <= 5428:
            raise LineError(f"#{n} is set by the machine only")
        if 5161 <= n <= 5390:
            raise LineError(f"#{n} holds an offset; expected G10 or G92 to set it")
        self._numbers[n] = value

    def set_name(self, name: str, value: float) -> None:
        if name in self._read_only:
            raise LineError(f"#<{name.lower()}> is set by the machine only")
        (self._globals if name.startswith("_") else self.locals)[name] = value

    def enter(self, arguments: list[float]) -> tuple[dict[int, float], dict[str, float]]:
        """Begins a call of a sub with these arguments. Returns the saved parameters of the caller for `leave`."""
        kept = {n: self._numbers[n] for n in range(1, LOCAL + 1) if n in self._numbers}, self.locals
        for n, value in enumerate(arguments, 1):
            self._numbers[n] = value
        self.locals = {}
        return kept

    def leave(self, kept: tuple[dict[int, float], dict[str, float]]) -> None:
        for n in range(1, LOCAL + 1):
            self._numbers.pop(n, None)
        self._numbers |= kept[0]
        self.locals = kept[1]

    def _look_up(self, name: str) -> float | None:
        if name in self.locals:
            return self.locals[name]
        if name in self._globals:
            return self._globals[name]
        if name == "_VALUE":
            return self.returned or 0.0
        if name == "_VALUE_RETURNED":
            return float(self.returned is not None)
        if name == "_CALL_LEVEL":
            return float(self.level)
        found = self._read_only.get(name)
        return None if found is None else found()

    def _special(self, n: int) -> float:
        machine, unit = self._machine, self._machine.modal.unit
        for first, last, what in _OF_THE_MACHINE:
            if first <= n <= last:
                raise LineError(f"#{n} is {what}, known to the machine only; --set {n}=NUMBER gives it a value")
        if 5420 <= n <= 5422:
            return machine.local()[n - 5420]
        if 5021 <= n <= 5023:
            return _absolute(machine, n - 5021)
        if n == 5210:
            return float(any(machine.offsets.g92))
        if 5211 <= n <= 5213:
            return machine.offsets.g92[n - 5211] / unit
        if n == 5220:
            return float(SYSTEMS.index(machine.offsets.active) + 1)
        system, axis = divmod(n - 5221, 20)
        if 5221 <= n <= 5390 and axis < 3:
            value = machine.offsets.of_machine(SYSTEMS[system])[axis]
            if value is None:
                raise LineError(
                    f"#{n} is an offset of {SYSTEMS[system]} that is not in the program;"
                    f" --offset {SYSTEMS[system]} X Y Z gives it"
                )
            return value / unit
        return 0.0


def _index(index: float) -> int:
    n = round(index)
    if abs(index - n) > 1e-4 or not 1 <= n <= MOST:
        raise LineError(f"#{index:g}: expected the number of a parameter from 1 to {MOST}")
    return n


def _absolute(machine: Machine, axis: int) -> float:
    zero = machine.offsets.machine_zero()
    if zero is None:
        name = machine.offsets.active
        raise LineError(
            f"a machine coordinate is asked for, and the program does not say where the zero is; --offset {name} X Y Z"
        )
    return (machine.path.here[axis] - zero[axis]) / machine.modal.unit


def _read_only(machine: Machine) -> dict[str, Callable[[], float]]:
    found: dict[str, Callable[[], float]] = {
        "_METRIC": lambda: float(machine.modal.unit == 1.0),
        "_IMPERIAL": lambda: float(machine.modal.unit != 1.0),
        "_ABSOLUTE": lambda: float(not machine.modal.relative),
        "_INCREMENTAL": lambda: float(machine.modal.relative),
        "_IJK_ABSOLUTE_MODE": lambda: float(machine.modal.centres_absolute),
        "_INVERSE_TIME": lambda: float(machine.modal.inverse_time),
        "_UNITS_PER_MINUTE": lambda: float(not machine.modal.inverse_time),
        "_UNITS_PER_REV": lambda: 0.0,
        "_RETRACT_R_PLANE": lambda: float(machine.modal.retract_to_r),
        "_RETRACT_OLD_Z": lambda: float(not machine.modal.retract_to_r),
        "_LATHE_DIAMETER_MODE": lambda: float(machine.modal.diameters),
        "_LATHE_RADIUS_MODE": lambda: float(not machine.modal.diameters),
        "_FEED": lambda: (machine.modal.feed or 0.0) * 60 / machine.modal.unit,
        "_PLANE": lambda: float(machine.modal.plane[1:]) * 10,
        "_COORD_SYSTEM": lambda: float(machine.offsets.active[1:]) * 10,
        "_MOTION_MODE": lambda: 800.0 if machine.modal.motion is None else float(machine.modal.motion[1:]) * 10,
        "_TASK": lambda: 0.0,
        "_CCOMP": lambda: 400.0,
        "_VMAJOR": lambda: 2.9,
        "_VMINOR": lambda: 0.0,
    }
    for axis, letter in enumerate("XYZ"):
        found[f"_{letter}"] = lambda axis=axis: machine.local()[axis]  # type: ignore[misc]
        found[f"_ABS_{letter}"] = lambda axis=axis: _absolute(machine, axis)  # type: ignore[misc]
    return found
