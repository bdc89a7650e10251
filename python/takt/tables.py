"""Converts published values of components to recordings, with columns, units and names as described by the engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

import numpy as np

from takt import _core, msgs
from takt.recording import Array, Recording, RecordingError

State = Any  # a message with the state of a component: axis_state, flex_cam_state


@dataclass(frozen=True)
class Kind:
    """The published fields of components of one kind."""

    name: str
    section: str  # of the machine file
    places: Mapping[str, int]  # number of each field, from 0
    units: Mapping[str, str]
    names: Mapping[str, Mapping[int, str]]  # of enumerations
    dtypes: Mapping[str, Any]
    message: Any  # the LCM type
    getters: Mapping[str, Callable[[Any], Any]]  # read a field from a message

    @staticmethod
    def of(name: str, section: str) -> Kind:
        fields = _core.output_fields(name)
        message = getattr(msgs, f"{name}_state")
        return Kind(
            name,
            section,
            places={field: place for place, (field, *_) in enumerate(fields)},
            units={field: unit for field, unit, _, _ in fields},
            names={field: names for field, _, _, names in fields if names and field not in NUMBERS},
            dtypes={field: dtype for field, (dtype, *_) in (_core.output_layout(name).fields or {}).items()},
            message=message,
            getters={field: attrgetter(place_of(field, message)) for field, *_ in fields},
        )


def place_of(field: str, message: Any) -> str:
    """Returns the attribute path of a field in a message: pcs1_x is pcs1.x."""
    return field if field in message.__slots__ else ".".join(field.rsplit("_", 1))


NUMBERS = ("error", "warning")  # enumerations shown by number
KINDS = {name: Kind.of(name, section) for name, section in _core.component_kinds()}
# Prefixes of channels: followed by the name of the component.
PREFIXES = {name: f"takt/{name}/" for name in KINDS}


def fields_of_kind(kind: str) -> tuple[str, ...]:
    """Returns the published fields of components of this kind."""
    return tuple(KINDS[kind].units)


def components_of(machine: Mapping[str, Any]) -> dict[str, tuple[Kind, Mapping[str, Any]]]:
    """Returns kind and parameters of every component of a machine, by name."""
    return {c["name"]: (kind, c) for kind in KINDS.values() for c in machine[kind.section]}


def kind_of_channel(channel: str) -> Kind | None:
    """Returns the kind of component whose state is published on a channel; None for other channels."""
    return next((KINDS[kind] for kind, prefix in PREFIXES.items() if channel.startswith(prefix)), None)


def short_name(channel: str) -> str:
    """Returns a readable name of a channel: of a component's states its name, of others the part after "takt/"."""
    kind = kind_of_channel(channel)
    return channel.removeprefix(PREFIXES[kind.name] if kind else "takt/")


def unit_of(kind: str, field: str, own: Mapping[str, str]) -> str:
    """Returns the unit of a published field, with the component's `own` units: u/s2 -> mm/s²."""
    text = KINDS[kind].units[field]
    first, slash, rest = text.partition("/")
    text = own.get(first, first) + slash + rest
    return text.replace("s2", "s²").replace("s3", "s³")


def named(kind: str, field: str, value: Any) -> Any:
    """Returns a published value for display: enumerations by name, except errors, which stay numbers."""
    names = KINDS[kind].names.get(field)
    return names[value] if names else value


def fields_of(message: Any) -> dict[str, Any]:
    """Returns the fields of an LCM message, except those for transmission only."""
    return {f: getattr(message, f) for f in message.__slots__ if f not in ("utime", "sequence")}


def is_possible(message: State | msgs.engine_state, period: float) -> bool:
    """Returns whether cycle and time of a message agree; they do not if bytes were changed or forged. The engine's
    period is a whole number of nanoseconds."""
    return bool(message.cycle >= 0 and abs(message.time_ns - message.cycle * period * 1e9) <= message.cycle)


def table_of(kind: str, messages: Sequence[State], period: float) -> tuple[dict[str, Array], int]:
    """Returns the columns of messages of one component, and the number of messages left out because a value does not
    fit the type of its field. Repeated and late messages are ignored. Raises RecordingError if all are left out."""
    rows = []
    last = -1
    for message in messages:
        if message.cycle > last:
            rows.append(message)
            last = message.cycle
    count = len(rows)
    try:
        columns = {field: _column(kind, rows, field) for field in fields_of_kind(kind)}
    except OverflowError:
        wrong = [_wrong_field(kind, row) for row in rows]
        rows = [row for row, field in zip(rows, wrong, strict=True) if not field]
        if not rows:
            raise RecordingError(
                f"{messages[0].name}.{wrong[0]} holds a number that no engine publishes: bytes of the log were changed"
            ) from None
        columns = {field: _column(kind, rows, field) for field in fields_of_kind(kind)}
    cycle = np.array([m.cycle for m in rows], dtype=np.int64)
    return {"time_s": cycle * period, "cycle": cycle} | columns, count - len(rows)


def _column(kind: str, messages: Sequence[State], field: str) -> Array:
    return np.array([KINDS[kind].getters[field](m) for m in messages], dtype=KINDS[kind].dtypes[field])


def _wrong_field(kind: str, message: State) -> str:
    """Returns the first field whose value does not fit its type; empty if there is none."""
    for field in fields_of_kind(kind):
        try:
            _column(kind, [message], field)
        except OverflowError:
            return field
    return ""


def make_recording(
    machine: Mapping[str, Any],
    tables: Mapping[str, Mapping[str, Array]],
    events: Iterable[tuple[float, str, str, str]],
    meta: Mapping[str, Any],
    text: str,
    folder: str = "",
) -> Recording:
    """Returns a recording of components of `machine`.

    tables: by component; each has time_s, cycle and published fields.
    text: of the machine file.
    folder: of the machine file; "": unknown.
    """
    found = {name: of for name, of in components_of(machine).items() if name in tables}
    units = {name: units_of(machine, kind, parameters) for name, (kind, parameters) in found.items()}
    return Recording(
        tables,
        {name: {f: unit_of(k.name, f, units[name]) for f in k.units} for name, (k, _) in found.items()},
        names={name: {f: n for f, n in k.names.items() if f in tables[name]} for name, (k, _) in found.items()},
        info={name: _info(machine, k, parameters) for name, (k, parameters) in found.items()},
        events=events,
        meta={"machine": machine["name"], **meta, "machine_file": {"text": text, "folder": folder}},
    )


def units_of(machine: Mapping[str, Any], kind: Kind, parameters: Mapping[str, Any]) -> dict[str, str]:
    """Returns the units behind the symbols in the descriptions: "u" is the component's own, "u_m" its master's. A cam
    module has those of slave, master and its first cam; a virtual master has the unit of the cam's x."""
    if kind.name == "axis":
        return {"u": str(parameters["unit"]), "u_m": "u of the master"}  # the master changes at run time
    if kind.name == "belt":
        return {"u": "deg" if parameters["kind"] == "turning" else "mm"}
    if kind.name != "flex_cam":
        return {"u": "mm"}
    components = components_of(machine)

    def unit(name: str) -> str:
        if name in components:
            return units_of(machine, *components[name])["u"]
        mover, _, coordinate = name.rpartition(".")  # a coordinate of a mover: mover.x
        return "deg" if coordinate == "c" else units_of(machine, *components[mover])["u"]

    cam = next(c for c in machine["cams"] if c["name"] == parameters["cams"][0])
    master = parameters.get("master")
    return {
        "u": unit(parameters["slave"]),
        "u_m": cam["x_unit"] if master is None else unit(master),
        "x": cam["x_unit"],
        "y": cam["y_unit"],
    }


def _info(machine: Mapping[str, Any], kind: Kind, axis: Mapping[str, Any]) -> dict[str, Any]:
    info: dict[str, Any] = {"unit": units_of(machine, kind, axis)["u"], "limits": {}}
    if kind.name == "mover":
        info["limits"] = {name: dict(axis[name]) for name in "zabc"}
        most = dict(axis["xy"]["maximum"])
        lateral = axis.get("lateral_acceleration")
        lateral = lateral if lateral is not None else min(5000.0, most["acceleration"])
        info["limits"] |= {"xy": most, "lateral_acceleration": lateral}
    if kind.name != "axis":
        return info
    limits = axis["limits"]
    if axis["kind"] == "rotary":
        info["modulus"] = axis["modulus"]
    for what in ("velocity", "acceleration", "deceleration", "jerk"):
        if limits.get(what) is not None:
            info["limits"][what] = limits[what]
    lower, upper = limits.get("lower"), limits.get("upper")
    if lower is not None or upper is not None:
        info["limits"]["position"] = [-math.inf if lower is None else lower, math.inf if upper is None else upper]
    return info
