"""From what axes publish to recordings: columns, units and names as the engine describes them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from takt import _core, msgs
from takt.recording import Array, Recording, RecordingError

OUTPUT_FIELDS = tuple(name for name, _, _, _ in _core.output_fields())
_UNITS = {name: unit for name, unit, _, _ in _core.output_fields()}
_NAMES = {name: names for name, _, _, names in _core.output_fields() if names}
_DTYPES = {name: dtype for name, (dtype, *_) in (_core.output_layout().fields or {}).items()}


def unit_of(field: str, u: str) -> str:
    """The unit of a published field of an axis with the unit `u`: u/s2 -> mm/s²."""
    text = _UNITS[field]
    if text == "u" or text.startswith("u/"):
        text = u + text[1:]
    return text.replace("s2", "s²").replace("s3", "s³")


def named(field: str, value: Any) -> Any:
    """A published value as people see it: enumerations by the name of their member, but errors by number."""
    names = _NAMES.get(field) if field != "error" else None
    return names[value] if names else value


def fields_of(message: Any) -> dict[str, Any]:
    """The fields of an LCM message, but for those that only mattered on the way."""
    return {f: getattr(message, f) for f in message.__slots__ if f not in ("utime", "sequence")}


def is_possible(message: msgs.axis_state | msgs.engine_state, period: float) -> bool:
    """Cycle and time say the same, as they do unless bytes were changed or made up. The engine's period is one of whole
    nanoseconds."""
    return bool(message.cycle >= 0 and abs(message.time_ns - message.cycle * period * 1e9) <= message.cycle)


def table_of(messages: Sequence[msgs.axis_state], period: float, every: int = 1) -> dict[str, Array]:
    """The columns of messages of one axis, of every n-th message (`every`). A repeated or late message counts once."""
    rows = []
    last = -1
    for message in messages:
        if message.cycle > last:
            rows.append(message)
            last = message.cycle
    rows = rows[::every]
    cycle = np.array([m.cycle for m in rows], dtype=np.int64)
    return {"time_s": cycle * period, "cycle": cycle} | {f: _column(rows, f) for f in OUTPUT_FIELDS}


def _column(messages: Sequence[msgs.axis_state], field: str) -> Array:
    try:
        return np.array([getattr(m, field) for m in messages], dtype=_DTYPES[field])
    except OverflowError:
        raise RecordingError(
            f"{messages[0].name}.{field} holds a number that no engine publishes: bytes of the log were changed"
        ) from None


def make_recording(
    machine: Mapping[str, Any],
    tables: Mapping[str, Mapping[str, Array]],
    events: Iterable[tuple[float, str, str, str]],
    meta: Mapping[str, Any],
) -> Recording:
    """A recording of axes of `machine`; each table has time_s, cycle and published fields."""
    axes = {a["name"]: a for a in machine["axes"] if a["name"] in tables}
    names = {f: n for f, n in _NAMES.items() if f != "error"}
    return Recording(
        tables,
        {name: {f: unit_of(f, a["unit"]) for f in OUTPUT_FIELDS} for name, a in axes.items()},
        names={name: {f: n for f, n in names.items() if f in tables[name]} for name in axes},
        info={name: _info(a) for name, a in axes.items()},
        events=events,
        meta={"machine": machine["name"], **meta},
    )


def _info(axis: Mapping[str, Any]) -> dict[str, Any]:
    limits = axis["limits"]
    info: dict[str, Any] = {"unit": axis["unit"], "limits": {}}
    if axis["kind"] == "rotary":
        info["modulus"] = axis["modulus"]
    for what in ("velocity", "acceleration", "deceleration", "jerk"):
        if limits.get(what) is not None:
            info["limits"][what] = limits[what]
    lower, upper = limits.get("lower"), limits.get("upper")
    if lower is not None or upper is not None:
        info["limits"]["position"] = [-math.inf if lower is None else lower, math.inf if upper is None else upper]
    return info
