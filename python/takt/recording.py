"""Recordings: published values over time, as NumPy arrays with names and units.

A recording holds one table per component ("x", "belt", "mover3" …). A table is a structured array: `time_s`
and `cycle` first, then the published fields in their order. Components may have been sampled at different
rates, so each has its own time base; `cycle` is common to all.

    rec["x"]["actual_position"]          # values
    rec.unit("x", "actual_position")     # "mm"
    rec.slice(1.0, 2.0).save("part.npz")
"""

from __future__ import annotations

import csv
import difflib
import fnmatch
import hashlib
import importlib
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from takt.counted import counted
from takt.errors import TaktError, shortened
from takt.written import written

Array = npt.NDArray[Any]
FloatArray = npt.NDArray[np.float64]
Names = Mapping[int, str] | Sequence[str]

FORMAT_VERSION = 1
ARRAY = "$array"  # in the header of a file, instead of an array of `meta`: its number
BLOCK = 1024  # rows that are copied at a time
UNKNOWN_NAME = -1  # stands for NaN in an enumerated column


class RecordingError(TaktError, ValueError):
    """A recording cannot be made or read, or lacks the requested data; the text is one readable sentence."""


class MissingPackageError(TaktError, ImportError):
    """An optional package that the call needs is not installed; the text says how to install it."""


class Event(NamedTuple):
    """An event at one time: the start or end of a command, an error, a mark set by the user."""

    time_s: float
    component: str  # empty: the whole machine
    text: str
    kind: str = "mark"  # "start", "end", "error" or "mark"


class Gap(NamedTuple):
    """Missing samples between two recorded ones."""

    after_cycle: int  # of the last sample before the gap
    before_cycle: int  # of the first sample after it
    missing: int  # number of missing samples
    time_s: float  # of the last sample before the gap
    until_s: float  # of the first sample after it


class Recording:
    """Columns over time, grouped by component. Immutable except for `meta` and `events`."""

    def __init__(
        self,
        components: Mapping[str, Mapping[str, npt.ArrayLike] | Array],
        units: Mapping[str, Mapping[str, str]] | None = None,
        *,
        names: Mapping[str, Mapping[str, Names]] | None = None,
        info: Mapping[str, Mapping[str, Any]] | None = None,
        events: Iterable[Sequence[Any]] = (),
        meta: Mapping[str, Any] | None = None,
    ) -> None:
        """Makes a recording from plain arrays.

        components: for each component its columns by name, all of equal length, or a structured array. `time_s` [s]
            (strictly increasing) is required; `cycle` (integers, strictly increasing) is counted from 0 if missing.
        units: the unit of each field of each component; "" or absent for dimensionless values.
        names: the texts of enumerated fields, by value; such a column is stored as int8.
        info: further properties of a component. `modulus` (rotary axes) and `limits` (`position`: [lower, upper],
            `velocity`, `acceleration`, `jerk`) are used by the assertions; other entries are kept unchanged.
        events: (time_s, component, text) or (time_s, component, text, kind).
        meta: any values that JSON can hold, and NumPy arrays at any depth (machine, versions, engine figures,
            verdicts).

        Raises RecordingError if the data is inconsistent.
        """
        self._names = {c: {f: _name_table(t) for f, t in fields.items()} for c, fields in (names or {}).items()}
        self._units = {c: dict(fields) for c, fields in (units or {}).items()}
        self._info = {c: dict(i) for c, i in (info or {}).items()}
        self._data = {c: _table(c, columns, self._names.get(c, {})) for c, columns in components.items()}
        for what, given in (("units", self._units), ("names", self._names), ("info", self._info)):
            for component in given:
                if component not in self._data:
                    raise RecordingError(f"{what} are given for '{component}', which is not among the components")
        self.events: list[Event] = sorted((_event(e) for e in events), key=lambda e: e.time_s)
        self.meta: dict[str, Any] = dict(meta or {})

    @classmethod
    def from_columns(
        cls,
        time_s: npt.ArrayLike,
        cycle: npt.ArrayLike,
        columns: Sequence[str],
        values: npt.ArrayLike,
        units: Sequence[str] | None = None,
        *,
        integers: Iterable[str] = ("error_id",),
        names: Mapping[str, Mapping[str, Names]] | None = None,
        info: Mapping[str, Mapping[str, Any]] | None = None,
        events: Iterable[Sequence[Any]] = (),
        meta: Mapping[str, Any] | None = None,
    ) -> Recording:
        """Makes a recording from one matrix: a row per sample, a column per "component.field", all on one time base.

        time_s, cycle: of the rows, shape (n,).
        columns: the names "component.field" of the columns of `values`, shape (n, len(columns)).
        units: one per column; None: none.
        integers: fields (without component) whose columns become integers if all their values are finite.
        names, info, events, meta: as in the constructor.

        Raises RecordingError if the data is inconsistent.
        """
        matrix = np.asarray(values, dtype=np.float64)
        if matrix.ndim != 2 or matrix.shape[1] != len(columns):
            raise RecordingError(f"{len(columns)} columns are named, but the values have the shape {matrix.shape}")
        if units is not None and len(units) != len(columns):
            raise RecordingError(f"{len(columns)} columns are named, but {len(units)} units are given")
        whole = set(integers)
        data: dict[str, dict[str, npt.ArrayLike]] = {}
        unit_table: dict[str, dict[str, str]] = {}
        for i, column in enumerate(columns):
            component, field = split_signal(column)
            table = data.setdefault(component, {"time_s": time_s, "cycle": cycle})
            if field in table:
                raise RecordingError(f"column '{column}' is given twice")
            numbers = matrix[:, i]
            table[field] = numbers.astype(np.int64) if field in whole and np.all(np.isfinite(numbers)) else numbers
            unit_table.setdefault(component, {})[field] = units[i] if units is not None else ""
        return cls(data, unit_table, names=names, info=info, events=events, meta=meta)

    @classmethod
    def from_array(
        cls, component: str, array: Array, unit: str, *, names: Mapping[str, Names] | None = None, **info: Any
    ) -> Recording:
        """Makes a recording of one component from a structured array whose positions are in `unit` (velocities in
        unit/s and so on, by the names of the fields)."""
        powers = {"position": "", "velocity": "/s", "acceleration": "/s²", "jerk": "/s³"}
        units = {}
        for field in array.dtype.names or ():
            last = "position" if field == "following_error" else field.rsplit("_", 1)[-1]
            if last in powers:
                units[field] = unit + powers[last]
        return cls({component: array}, {component: units}, names={component: names or {}}, info={component: info})

    # --- access ---

    @property
    def components(self) -> tuple[str, ...]:
        return tuple(self._data)

    def __getitem__(self, component: str) -> Array:
        try:
            return self._data[component]
        except KeyError:
            raise RecordingError(_nothing("component", component, self._data, "this recording")) from None

    def __contains__(self, component: object) -> bool:
        return component in self._data

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __repr__(self) -> str:
        parts = ", ".join(f"{c}: {counted(len(a), 'sample')}" for c, a in self._data.items())
        return f"<Recording {self.duration_s:.3f} s; {parts or 'empty'}; {counted(len(self.events), 'event')}>"

    def _repr_html_(self) -> str:
        from takt.notebook import recording_table

        return recording_table(self)

    def fields(self, component: str) -> tuple[str, ...]:
        """Returns the fields of a component, `time_s` and `cycle` first."""
        return tuple(self[component].dtype.names or ())

    def column(self, component: str, field: str) -> Array:
        """Returns one column. Raises RecordingError, with the names that exist, if there is none."""
        table = self[component]
        if field not in (table.dtype.names or ()):
            raise RecordingError(_nothing("field", field, table.dtype.names or (), f"'{component}'"))
        column: Array = table[field]
        return column

    def why_no(self, pattern: str) -> str:
        """Returns a sentence that says why no signal matches `pattern`: which component or which of its fields is
        missing."""
        component, dot, field = pattern.rpartition(".")
        of = [name for name in self if fnmatch.fnmatchcase(name, component)]
        if not dot or not of:
            return _nothing("component", component or pattern, self, "this recording")
        fields = dict.fromkeys(f for name in of for f in self.fields(name)[2:])
        return _nothing("field", field, fields, " or ".join(f"'{name}'" for name in of))

    def unit(self, component: str, field: str) -> str:
        """Returns the unit of a column as text; "" if dimensionless."""
        self.column(component, field)
        if field == "time_s":
            return "s"
        return self._units.get(component, {}).get(field, "")

    def names(self, component: str, field: str) -> dict[int, str]:
        """Returns the texts of an enumerated field by value; empty if the field is not enumerated."""
        self.column(component, field)
        return dict(self._names.get(component, {}).get(field, {}))

    def text(self, component: str, field: str) -> npt.NDArray[np.str_]:
        """Returns an enumerated column as texts; "?" and the number for values without a text."""
        table = self.names(component, field)
        values, where = np.unique(self.column(component, field), return_inverse=True)
        return np.array([table.get(int(v), f"?{int(v)}") for v in values], dtype=np.str_)[where]

    def info(self, component: str) -> dict[str, Any]:
        """Returns further properties of a component (`modulus`, `limits` …)."""
        self[component]
        return self._info.get(component, {})

    @property
    def start_s(self) -> float:
        """Time [s] of the first sample; NaN if there are no samples."""
        return min((float(a["time_s"][0]) for a in self._data.values() if len(a)), default=math.nan)

    @property
    def end_s(self) -> float:
        """Time [s] of the last sample; NaN if there are no samples."""
        return max((float(a["time_s"][-1]) for a in self._data.values() if len(a)), default=math.nan)

    @property
    def duration_s(self) -> float:
        return 0.0 if math.isnan(self.start_s) else self.end_s - self.start_s

    def gaps(self, component: str, step: int | None = None) -> list[Gap]:
        """Returns the gaps between samples of a component. `step`: the sample spacing in cycles; None: the most
        frequent spacing."""
        table = self[component]
        if len(table) < 2:
            return []
        steps = np.diff(table["cycle"])
        if step is None:
            values, counts = np.unique(steps, return_counts=True)
            step = int(values[np.argmax(counts)])
        cycle, time_s = table["cycle"], table["time_s"]
        return [
            Gap(
                *(int(cycle[i]), int(cycle[i + 1]), math.ceil(int(steps[i]) / step) - 1),
                *(float(time_s[i]), float(time_s[i + 1])),
            )
            for i in np.flatnonzero(steps > step)
        ]

    def slice(self, t0: float, t1: float) -> Recording:
        """Returns the samples and events with t0 <= time_s <= t1. Raises RecordingError unless t0 <= t1."""
        if not t0 <= t1:
            raise RecordingError(f"a slice from {t0} s to {t1} s has no length")
        part = {c: a[(a["time_s"] >= t0) & (a["time_s"] <= t1)] for c, a in self._data.items()}
        events = [e for e in self.events if t0 <= e.time_s <= t1]
        return Recording(part, self._units, names=self._names, info=self._info, events=events, meta=self.meta)

    def shifted(self, by_s: float) -> Recording:
        """Returns the recording with `by_s` [s] added to all times, events included; cycles keep their numbers."""
        tables = {c: {f: a[f] for f in a.dtype.names or ()} for c, a in self._data.items()}
        moved = {c: {**columns, "time_s": columns["time_s"] + by_s} for c, columns in tables.items()}
        events = [event._replace(time_s=event.time_s + by_s) for event in self.events]
        return Recording(moved, self._units, names=self._names, info=self._info, events=events, meta=self.meta)

    def between(self, start: float | None, end: float | None) -> Recording:
        """Returns the slice from `start` to `end` [s]; None: from the beginning, to the end. Raises RecordingError if
        it holds no sample."""
        if start is None and end is None:
            return self
        part = self.slice(-math.inf if start is None else start, math.inf if end is None else end)
        if math.isnan(part.start_s):
            asked = [f"from {start:g} s on" if end is None else f"from {start:g} s"] if start is not None else []
            asked += [f"to {end:g} s"] if end is not None else []
            there = "no samples" if math.isnan(self.start_s) else f"samples from {self.start_s:g} s to {self.end_s:g} s"
            raise RecordingError(f"nothing was recorded {' '.join(asked)}: there are {there}")
        return part

    def pick(self, signals: Iterable[tuple[str, str]]) -> Recording:
        """Returns these signals (component, field) only, with the events of their components and of the whole
        machine."""
        fields: dict[str, list[str]] = {}
        for component, field in signals:
            self.column(component, field)
            fields.setdefault(component, ["time_s", "cycle"]).append(field)
        return Recording(
            {c: self[c][list(dict.fromkeys(of))] for c, of in fields.items()},
            {c: {f: u for f, u in self._units.get(c, {}).items() if f in of} for c, of in fields.items()},
            names={c: {f: n for f, n in self._names.get(c, {}).items() if f in of} for c, of in fields.items()},
            info={c: self.info(c) for c in fields},
            events=[e for e in self.events if not e.component or e.component in fields],
            meta=self.meta,
        )

    # --- saving and exporting ---

    def save(self, path: str | PathLike[str]) -> Path:
        """Writes the recording as one .npz file, readable by NumPy alone as well. Returns the path. Raises
        RecordingError if `info` or `meta` hold values that JSON cannot represent."""
        target = Path(path)
        header = {
            "takt_recording": FORMAT_VERSION,
            "components": list(self._data),
            "units": self._units,
            "names": {
                c: {f: {str(v): t for v, t in n.items()} for f, n in fs.items()} for c, fs in self._names.items()
            },
            "info": self._info,
            "events": [list(e) for e in self.events],
        }
        kept: dict[bytes, Array] = {}
        try:
            text = json.dumps(header | {"meta": _put_aside(self.meta, kept)})
        except TypeError as error:
            raise RecordingError(f"info or meta hold something that JSON cannot: {error}") from None
        arrays = {f"component{i}": a for i, a in enumerate(self._data.values())}
        arrays |= {f"meta{i}": a for i, a in enumerate(kept.values())}
        target.parent.mkdir(parents=True, exist_ok=True)
        with written(target) as beside, beside.open("wb") as file:
            np.savez_compressed(file, header=np.array(text), **arrays)  # type: ignore[arg-type]
        return target

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Recording:
        """Returns the recording in a file written by `save`. Raises FileNotFoundError, or RecordingError if the file is
        not a recording."""
        try:
            with np.load(path, allow_pickle=False) as file:
                header = json.loads(str(file["header"]))
                if header["takt_recording"] != FORMAT_VERSION:
                    raise RecordingError(
                        f"{path} has recording format {header['takt_recording']}; this version reads {FORMAT_VERSION}"
                    )
                data = {c: file[f"component{i}"] for i, c in enumerate(header["components"])}
                kept = [file[name] for name in sorted(file.files, key=_number) if _number(name) >= 0]
            names = {
                c: {f: {int(v): t for v, t in n.items()} for f, n in fs.items()} for c, fs in header["names"].items()
            }
            return cls(
                data,
                header["units"],
                names=names,
                info=header["info"],
                events=header["events"],
                meta=_put_back(header["meta"], kept),
            )
        except FileNotFoundError:
            raise
        except RecordingError:
            raise
        except MemoryError:
            raise RecordingError(f"{path} is not a recording: it asks for more memory than there is") from None
        except Exception as error:  # NumPy and zipfile raise many kinds of errors on damaged bytes
            raise RecordingError(f"{path} is not a recording: {shortened(str(error))}") from None

    def to_csv(self, path: str | PathLike[str]) -> Path:
        """Writes one wide table: a row per cycle, columns "component.field [unit]", texts for enumerated fields, empty
        where a component has no sample in that cycle. Returns the path."""
        target = Path(path)
        cycle, time_s, rows = self._joined()
        header = ["cycle", "time_s"]
        columns: list[list[Any]] = [cycle.tolist(), time_s.tolist()]
        for component, field in self._signals():
            unit = self.unit(component, field)
            header.append(f"{component}.{field} [{unit}]" if unit else f"{component}.{field}")
            values = self.text(component, field) if self.names(component, field) else self.column(component, field)
            column: list[Any] = [""] * len(cycle)
            for row, value in zip(rows[component].tolist(), values.tolist(), strict=True):
                column[row] = value
            columns.append(column)
        target.parent.mkdir(parents=True, exist_ok=True)
        with written(target) as beside, beside.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(header)
            writer.writerows(zip(*columns, strict=True))
        return target

    def to_dataframe(self, *signals: str) -> Any:
        """Returns a pandas.DataFrame: index `time_s`, columns `cycle` and "component.field"; states are categories of
        their texts, units are in `attrs`. One row for each cycle in which any of the components has a sample.

        signals: as in `takt plot` ("x", "x.set_position", "*.torque_nm"); none: all.

        Raises MissingPackageError without pandas.
        """
        pandas = _optional("pandas", "to_dataframe")
        part = self._part(signals)
        frame = part.to_pandas()
        for component, field in part._signals():
            if names := part.names(component, field):
                numbers = frame[f"{component}.{field}"]
                texts = numbers.map(lambda value, names=names: names.get(int(value), f"?{int(value)}"), "ignore")
                kinds = dict.fromkeys([*names.values(), *texts.dropna()])
                frame[f"{component}.{field}"] = pandas.Categorical(texts, kinds)
        return frame

    def to_parquet(self, path: str | PathLike[str], *signals: str) -> Path:
        """Writes one wide table as `to_csv` does: texts for states, nulls where a component has no sample in that
        cycle, the unit of a column in its metadata. Returns the path.

        signals: as in `to_dataframe`.

        Raises MissingPackageError without pyarrow.
        """
        arrow = _optional("pyarrow", "to_parquet")
        parquet = _optional("pyarrow.parquet", "to_parquet")
        part = self._part(signals)
        cycle, time_s, rows = part._joined()
        fields = [arrow.field("cycle", arrow.int64()), arrow.field("time_s", arrow.float64(), metadata={"unit": "s"})]
        columns = [arrow.array(cycle), arrow.array(time_s)]
        for component, field in part._signals():
            texts = bool(part.names(component, field))
            values = arrow.array(part.text(component, field) if texts else part.column(component, field))
            places = np.full(len(cycle), -1)
            places[rows[component]] = np.arange(len(values))
            values = values.take(arrow.array(places, mask=places < 0))
            columns.append(values.dictionary_encode() if texts else values)
            unit = part.unit(component, field)
            fields.append(arrow.field(f"{component}.{field}", columns[-1].type, metadata={"unit": unit}))
        target = Path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        with written(target) as beside, beside.open("wb") as file:
            parquet.write_table(arrow.Table.from_arrays(columns, schema=arrow.schema(fields)), file)
        return target

    def _part(self, signals: Sequence[str]) -> Recording:
        from takt.plot import select  # here, because its import is slow

        return self.pick(select(self, signals)) if signals else self

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame: index `time_s`, columns `cycle` and "component.field", states by number; units
        and texts in `attrs`. Raises MissingPackageError without pandas."""
        pandas = _optional("pandas", "to_pandas")
        cycle, time_s, rows = self._joined()
        columns: dict[str, Array] = {"cycle": cycle}
        for component, field in self._signals():
            columns[f"{component}.{field}"] = _spread(self.column(component, field), rows[component], len(cycle))
        frame = pandas.DataFrame(columns, index=pandas.Index(time_s, name="time_s"))
        frame.attrs.update(self._attributes())
        return frame

    def to_xarray(self) -> Any:
        """Returns an xarray.Dataset: dimension `time_s`, a variable per "component.field" with its unit. Raises
        MissingPackageError without xarray."""
        xarray = _optional("xarray", "to_xarray")
        cycle, time_s, rows = self._joined()
        variables: dict[str, Any] = {}
        for component, field in self._signals():
            attributes: dict[str, Any] = {"units": self.unit(component, field)}
            if names := self.names(component, field):
                attributes |= {"flag_values": list(names), "flag_meanings": " ".join(names.values())}
            values = _spread(self.column(component, field), rows[component], len(cycle))
            variables[f"{component}.{field}"] = ("time_s", values, attributes)
        return xarray.Dataset(variables, coords={"time_s": time_s, "cycle": ("time_s", cycle)})

    def _signals(self) -> Iterator[tuple[str, str]]:
        for component in self._data:
            for field in self.fields(component)[2:]:
                yield component, field

    def _attributes(self) -> dict[str, Any]:
        units = {f"{c}.{f}": self.unit(c, f) for c, f in self._signals()}
        names = {f"{c}.{f}": self.names(c, f) for c, f in self._signals() if self.names(c, f)}
        return {"units": units, "names": names}

    def _joined(self) -> tuple[Array, FloatArray, dict[str, Array]]:
        """Returns all cycles of all components, their times, and for each component the rows of its samples among
        these cycles."""
        tables = list(self._data.values())
        if not tables:
            return np.empty(0, np.int64), np.empty(0), {}
        cycle, first = np.unique(np.concatenate([t["cycle"] for t in tables]), return_index=True)
        time_s = np.concatenate([t["time_s"] for t in tables])[first]
        return cycle, time_s, {c: np.searchsorted(cycle, t["cycle"]) for c, t in self._data.items()}


def split_signal(signal: str) -> tuple[str, str]:
    """ "x.set_position" -> ("x", "set_position"); component names may contain dots. Raises RecordingError for any other
    form."""
    component, dot, field = signal.rpartition(".")
    if not (dot and component and field):
        raise RecordingError(f"'{signal}' is not of the form component.field")
    return component, field


def _table(
    component: str, columns: Mapping[str, npt.ArrayLike] | Array, names: Mapping[str, Mapping[int, str]]
) -> Array:
    fields = (columns.dtype.names or ()) if isinstance(columns, np.ndarray) else tuple(columns)
    if "time_s" not in fields:
        raise RecordingError(f"'{component}' has no column time_s")
    arrays = {f: np.asarray(columns[f]) for f in fields}
    time_s = arrays["time_s"].astype(np.float64)
    if time_s.ndim != 1:
        raise RecordingError(f"time_s of '{component}' has {time_s.ndim} dimensions, not one")
    for field, values in arrays.items():
        if values.shape != time_s.shape:
            raise RecordingError(f"'{component}.{field}' has the shape {values.shape}, but time_s has {time_s.shape}")
    if not np.all(np.isfinite(time_s)):
        raise RecordingError(f"time_s of '{component}' holds something that is not a number")
    cycle = arrays["cycle"].astype(np.int64) if "cycle" in arrays else np.arange(len(time_s), dtype=np.int64)
    for field, rising in (("time_s", time_s), ("cycle", cycle)):
        falls = np.flatnonzero(np.diff(rising) <= 0)
        if len(falls):
            i = int(falls[0])
            raise RecordingError(
                f"{field} of '{component}' does not rise after sample {i}: {rising[i]}, {rising[i + 1]}"
            )
    arrays = {"time_s": time_s, "cycle": cycle} | {f: a for f, a in arrays.items() if f not in ("time_s", "cycle")}
    for field in arrays:
        if arrays[field].dtype.kind not in "biuf":
            raise RecordingError(f"'{component}.{field}' holds {arrays[field].dtype}, not numbers")
        if field in names:
            arrays[field] = _enumerated(component, field, arrays[field])
        elif arrays[field].dtype.kind == "u":
            arrays[field] = arrays[field].astype(np.int64)
    table = np.empty(len(time_s), dtype=[(f, a.dtype) for f, a in arrays.items()])
    for first in range(0, len(table), BLOCK):  # in blocks: copying whole columns would overrun the cache
        part = slice(first, first + BLOCK)
        rows = table[part]
        for field, values in arrays.items():
            rows[field] = values[part]
    table.flags.writeable = False
    return table


def _enumerated(component: str, field: str, values: Array) -> Array:
    numbers = np.where(np.isnan(values), UNKNOWN_NAME, values) if values.dtype.kind == "f" else values
    if len(numbers) and (np.any(numbers < -128) or np.any(numbers > 127)):
        raise RecordingError(f"'{component}.{field}' is enumerated, but holds values outside -128 to 127")
    return numbers.astype(np.int8)


def _name_table(names: Names) -> dict[int, str]:
    return {int(v): str(t) for v, t in (names.items() if isinstance(names, Mapping) else enumerate(names))}


def _event(event: Sequence[Any]) -> Event:
    if not 3 <= len(event) <= 4:
        raise RecordingError(f"an event is (time_s, component, text) or (time_s, component, text, kind), not {event!r}")
    time_s = float(event[0])
    if not math.isfinite(time_s):
        raise RecordingError(f"the event '{event[2]}' has no time")
    return Event(time_s, *(str(part) for part in event[1:]))


def _put_aside(value: Any, kept: dict[bytes, Array]) -> Any:
    """Returns `meta` as JSON can hold it: each distinct array goes into `kept` and is replaced by its number."""
    if isinstance(value, np.ndarray) and value.dtype.hasobject:
        return _put_aside(value.tolist(), kept)
    if isinstance(value, np.ndarray):
        key = hashlib.sha256(f"{value.dtype} {value.shape}".encode() + value.tobytes()).digest()
        kept.setdefault(key, value)
        return {ARRAY: list(kept).index(key)}
    if isinstance(value, Mapping):
        return {str(k): _put_aside(v, kept) for k, v in value.items()}
    return [_put_aside(v, kept) for v in value] if isinstance(value, list | tuple) else value


def _put_back(value: Any, kept: Sequence[Array]) -> Any:
    if isinstance(value, dict):
        if set(value) == {ARRAY}:
            return kept[value[ARRAY]]
        return {k: _put_back(v, kept) for k, v in value.items()}
    return [_put_back(v, kept) for v in value] if isinstance(value, list) else value


def _number(name: str) -> int:
    """Returns the number of an array of `meta` by its name in the file; -1 for other arrays."""
    return int(name[4:]) if name.startswith("meta") else -1


def _spread(values: Array, rows: Array, length: int) -> Array:
    if len(values) == length:
        return values
    out: Array = np.full(length, np.nan)
    out[rows] = values
    return out


def _optional(module: str, asks: str) -> Any:
    """Returns a module of an optional package. Raises MissingPackageError if it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError:
        package = module.partition(".")[0]
        raise MissingPackageError(f"{asks}() needs the package {package}: pip install {package}") from None


def _nothing(kind: str, wanted: str, there: Iterable[str], where: str) -> str:
    known = list(there)
    near = difflib.get_close_matches(wanted, known, n=1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    return f"{where} has no {kind} '{wanted}'{hint} (it has {', '.join(known) or 'none'})"
