"""Cams: the position of a slave as a function of the position of its master.

    table = cam.Table.from_points([0, 90, 180, 360], [0, 10, 40, 0], cyclic=True)
    table = cam.Table.from_segments([{"to": {"x": 180, "y": 40}, "law": "modified_sine"}, {"to": {"x": 360, "y": 0}}])
    table = cam.Table.from_csv("press.csv", cyclic=True)
    y, dy, ddy, dddy = table.at(np.linspace(0, 360, 1000))

x is in the master's unit, y in the slave's; velocity, acceleration and jerk of a cam are derivatives with respect to x:
[y/x], [y/x²], [y/x³]. Errors of a cam raise `takt.ConfigError`; `Table.warnings` has remarks.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, overload

import numpy as np
import yaml

from takt import _core
from takt.engine import read_machine
from takt.names import shown
from takt.written import write_text
from takt.yaml_text import legible, to_json

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    FloatArray = NDArray[np.float64]

Interpolation = Literal["linear", "quintic", "cubic_spline", "monotone"]


class Value(NamedTuple):
    """The values of a cam at one x."""

    y: float
    dy: float  # velocity, y/x
    ddy: float  # acceleration, y/x²
    dddy: float  # jerk, y/x³


class Values(NamedTuple):
    """The values of a cam at several x; each array has the shape of x."""

    y: FloatArray
    dy: FloatArray  # velocity, y/x
    ddy: FloatArray  # acceleration, y/x²
    dddy: FloatArray  # jerk, y/x³


class Points(NamedTuple):
    """The points that a cam was made from, each of shape (n,); NaN: free."""

    x: FloatArray
    y: FloatArray
    v: FloatArray  # velocity, y/x
    a: FloatArray  # acceleration, y/x²


class Extreme(NamedTuple):
    """A value and the first x at which it occurs."""

    x: float
    value: float


class Bounds(NamedTuple):
    """The least and the greatest value."""

    least: Extreme
    greatest: Extreme


class Extremes(NamedTuple):
    """The extremes of a whole cam; at discontinuities both one-sided values count."""

    y: Bounds
    dy: Bounds  # velocity, y/x
    ddy: Bounds  # acceleration, y/x²
    dddy: Bounds  # jerk, y/x³


@dataclass(frozen=True)
class SlavePeaks:
    """The peaks of a slave behind a master with given limits."""

    position: Bounds  # slave's unit
    velocity: Extreme  # largest, slave's unit/s
    acceleration: Extreme  # largest, slave's unit/s²


class Factors(NamedTuple):
    """The peak values of a law of motion from (0, 0) to (1, 1)."""

    velocity: float
    acceleration: float
    jerk: float  # infinite where the acceleration jumps


class Table:
    """A cam; immutable."""

    def __init__(self, core: _core.CamTable, warnings: Sequence[str] = ()) -> None:
        """For internal use: tables are made by the functions below."""
        self._core = core
        self.warnings = tuple(warnings)
        """Sentences about what may surprise: jumps of velocity in linear cams."""

    @classmethod
    def from_points(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        v: ArrayLike | None = None,
        a: ArrayLike | None = None,
        *,
        name: str = "cam",
        interpolation: Interpolation = "quintic",
        cyclic: bool = False,
        x_unit: str = "u",
        y_unit: str = "u",
    ) -> Table:
        """Returns a cam through points.

        x, y: 2 to 100,000 points, x strictly increasing, each of shape (n,).
        v, a: velocity [y/x] and acceleration [y/x²] at the points; NaN or None: free, chosen for a smooth curve.
        interpolation: "linear", "quintic", "cubic_spline" or "monotone".
        cyclic: the end continues at the beginning, raised by the stroke.
        x_unit, y_unit: units of master and slave, for display.

        Raises takt.ConfigError if the points make no cam.
        """
        px, py = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
        pv, pa = (None if one is None else np.asarray(one, dtype=np.float64) for one in (v, a))
        return cls(*_core.cam_from_points(px, py, pv, pa, name, interpolation, cyclic, x_unit, y_unit))

    @classmethod
    def from_segments(
        cls,
        segments: Sequence[Mapping[str, Any]],
        *,
        name: str = "cam",
        cyclic: bool = False,
        x_unit: str = "u",
        y_unit: str = "u",
    ) -> Table:
        """Returns a cam of consecutive laws of motion, each as in a machine file: {"to": {"x": 90, "y": 10}, "law":
        "cycloid"}, optionally with "from", and for quintics with "begin_v", "begin_a", "end_v", "end_a". Raises
        takt.ConfigError if the segments make no cam."""
        units = {"x_unit": x_unit, "y_unit": y_unit}
        return cls.from_dict({"name": name, "cyclic": cyclic, **units, "segments": list(segments)})

    @classmethod
    def from_dict(cls, cam: Mapping[str, Any]) -> Table:
        """Returns a cam from a dict as in a machine file and in `source`. Raises takt.ConfigError."""
        text = to_json(_plain(cam))  # which is YAML, too
        return cls(*_core.cam_from_yaml(text.encode(), "cam"))

    @classmethod
    def from_yaml(cls, file: str | os.PathLike[str]) -> Table:
        """Returns one cam in the form of a machine file. `file`: a path, or the text itself (more than one line).
        Raises takt.ConfigError."""
        text, file_name = read_machine(file)
        return cls(*_core.cam_from_yaml(text, file_name))

    @classmethod
    def from_csv(
        cls,
        file: str | os.PathLike[str],
        *,
        name: str | None = None,
        interpolation: Interpolation = "quintic",
        cyclic: bool = False,
        x_unit: str = "u",
        y_unit: str = "u",
    ) -> Table:
        """Returns a cam through the points of a CSV file with the columns x, y and optionally v, a. Other parameters
        as in `from_points`; the default of `name` is that of the file. Raises takt.ConfigError."""
        path = Path(file)
        how = (name or shown(path.stem), interpolation, cyclic, x_unit, y_unit)
        return cls(*_core.cam_from_csv(path.read_bytes(), shown(path), *how))

    @classmethod
    def from_file(
        cls,
        file: str | os.PathLike[str],
        *,
        columns: Mapping[str, str | int] | None = None,
        name: str | None = None,
        interpolation: Interpolation | None = None,
        cyclic: bool = False,
        x_unit: str | None = None,
        y_unit: str | None = None,
    ) -> Table:
        """Returns a cam from a file of another system, recognised by its content (CAM-92): a table of numbers with any
        separator, decimal point or comma, with or without a header; an array of CODESYS (SMC_CAMXYVA) or TwinCAT
        (MC_MotionFunctionPoint, positions) as structured text; a cam table of TwinCAT CNC, which is cyclic.

        columns: the columns of x, y, v and a, by title or by number from 1; None: by their usual titles, or in this
            order.
        name: None: the name of the file.
        interpolation: None: that of the file, else "quintic".
        x_unit, y_unit: None: those of a second header line, else "u".

        Raises takt.ConfigError if the file holds no cam.
        """
        from takt.cam_files import read

        how = {"name": name, "interpolation": interpolation, "x_unit": x_unit, "y_unit": y_unit}
        return read(file, columns=columns, cyclic=cyclic, **how)  # type: ignore[arg-type]

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def cyclic(self) -> bool:
        return self._core.cyclic

    @property
    def x_unit(self) -> str:
        """The master's unit, for display."""
        return self._core.x_unit

    @property
    def y_unit(self) -> str:
        """The slave's unit, for display."""
        return self._core.y_unit

    @property
    def begin(self) -> float:
        """First x [master's unit]."""
        return self._core.begin

    @property
    def end(self) -> float:
        """Last x [master's unit]."""
        return self._core.end

    @property
    def stroke(self) -> float:
        """y at the end minus y at the beginning [slave's unit]."""
        return self._core.stroke

    @property
    def joints(self) -> FloatArray:
        """The x at which the pieces of the curve meet, including both ends, shape (pieces + 1,)."""
        return self._core.joints

    @property
    def points(self) -> Points:
        """The points that the cam was made from; empty for segments."""
        return Points(*self._core.points)

    @property
    def source(self) -> dict[str, Any]:
        """The definition of the cam in the form of a machine file (CAM-71)."""
        source: dict[str, Any] = json.loads(self._core.source)
        return source

    @overload
    def at(self, x: float) -> Value: ...
    @overload
    def at(self, x: ArrayLike) -> Values: ...
    def at(self, x: ArrayLike) -> Value | Values:
        """Returns y and its derivatives at x [master's unit]: floats for a number, arrays of the same shape for an
        array. Outside the cam, the values at the nearer end; NaN for NaN."""
        places = np.asarray(x, dtype=np.float64)
        arrays = self._core.at(places)
        if np.isnan(places).any():
            y, dy, ddy, dddy = (np.where(np.isnan(places), np.nan, one) for one in arrays)
            arrays = (y, dy, ddy, dddy)
        if places.ndim == 0:
            return Value(*(float(one) for one in arrays))
        return Values(*arrays)

    def extremes(self) -> Extremes:
        """Returns the least and greatest y, velocity, acceleration and jerk, computed from roots, not from samples
        (CAM-24)."""
        return Extremes(*(Bounds(Extreme(*low), Extreme(*high)) for low, high in self._core.extremes()))

    def slave_peaks(self, master_velocity: float, master_acceleration: float = 0.0) -> SlavePeaks:
        """Returns the peaks of the slave for limits of the master's velocity V [master's unit/s] and acceleration A
        [unit/s²], both at least 0: the maxima of |dy| V and |ddy| V² + |dy| A (CAM-24)."""
        least, greatest, velocity, acceleration = self._core.slave_peaks(master_velocity, master_acceleration)
        return SlavePeaks(Bounds(Extreme(*least), Extreme(*greatest)), Extreme(*velocity), Extreme(*acceleration))

    def inverse(self, y: float) -> FloatArray:
        """Returns every x at which the cam has this y, increasing; for a dwell at y, both of its ends (CAM-71)."""
        return self._core.all_x(y)

    def nearest(self, y: float, near: float) -> float | None:
        """Returns the x nearest to `near` at which the cam has this y; None if there is none."""
        return self._core.nearest_x(y, near)

    def to_csv(self, file: str | os.PathLike[str] | None = None, *, count: int | None = None) -> str:
        """Returns the points as CSV text and writes it to `file`, if given. `from_csv` reads back an identical cam if
        interpolation and cyclic are passed to it again.

        count: number of equidistant points of the curve, with velocity and acceleration, to write instead, as for the
            quintic point tables of other systems; None: the cam's own points.

        Raises ValueError for a cam of segments without `count`.
        """
        if count is not None:
            x = np.linspace(self.begin, self.end, count)
            y, v, a, _ = self.at(x)
            text = Table.from_points(x, y, v, a).to_csv()
        elif len(self.points.x):
            text = self._core.to_csv()
        else:
            raise ValueError("a cam of segments has no points; say how many the file is to have (count)")
        if file is not None:
            write_text(file, text)
        return text

    def to_yaml(self, file: str | os.PathLike[str] | None = None) -> str:
        """Returns the cam as YAML text in the form of a machine file and writes it to `file`, if given."""
        text = self._core.to_yaml()
        if file is not None:
            write_text(file, text)
        return text

    def _repr_png_(self) -> bytes:
        from takt import cam_picture, plot

        return plot.png(cam_picture.draw(self))

    def __repr__(self) -> str:
        kind = "cyclic cam" if self.cyclic else "cam"
        return f"<{kind} {self.name}: x {self.begin:g} to {self.end:g}, stroke {self.stroke:g}>"


def of_machine(machine: str | os.PathLike[str]) -> list[Table]:
    """Returns the cams of a machine file, given as a path or as its text. Raises takt.ConfigError."""
    return [Table(core, warnings) for core, warnings in _core.cams_of_machine(*read_machine(machine))]


def is_machine(text: bytes) -> bool:
    """Returns whether a YAML text is a machine file rather than a cam, by its first known key."""
    depth, key = 0, True  # of mappings and lists; whether a key comes next
    try:
        for event in yaml.parse(legible(text.decode()), Loader=yaml.SafeLoader):
            depth -= isinstance(event, yaml.CollectionEndEvent)
            if depth == 1 and isinstance(event, (yaml.ScalarEvent, yaml.AliasEvent, yaml.CollectionEndEvent)):
                name = event.value if key and isinstance(event, yaml.ScalarEvent) else None
                if name in ("points", "segments", "file", "axes", "cams"):
                    return name in ("axes", "cams")
                key = not key
            depth += isinstance(event, yaml.CollectionStartEvent)
    except (yaml.YAMLError, UnicodeError):
        pass  # reported when the text is read as a cam
    return False


def law_factors(law: str, *, sine_share: float = 0.25, cosine_share: float = 0.5) -> Factors:
    """Returns the largest velocity, acceleration and jerk of a law of motion from (0, 0) to (1, 1) (CAM-02)."""
    return Factors(*_core.law_factors(law, sine_share, cosine_share))


def _plain(value: Any) -> Any:
    """Returns the value without NumPy numbers and without keys whose value is None, for JSON."""
    if isinstance(value, Mapping):
        return {key: _plain(one) for key, one in value.items() if one is not None}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return value.item() if isinstance(value, np.generic) else value
