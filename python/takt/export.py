"""Recordings for other tools: `takt export`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from takt import plot
from takt.counted import counted
from takt.errors import TaktError
from takt.missing import troubles
from takt.recording import Array, Recording
from takt.scene.foxglove import EVENTS, topic_of
from takt.written import written

LATEST_S = 2**63 / 1e9  # s; log times count ns from 0 up
LEVELS = {"error": 4, "mark": 2}  # of foxglove.Log: ERROR, INFO; all others are DEBUG
DEBUG = 1
LOG = {
    "title": "foxglove.Log",
    "type": "object",
    "properties": {
        "timestamp": {
            "type": "object",
            "title": "time",
            "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}},
        },
        "level": {"type": "integer"},
        "message": {"type": "string"},
        "name": {"type": "string", "description": "the component; empty: the whole machine"},
        "file": {"type": "string", "description": "what it is: start, end, error or mark"},
        "line": {"type": "integer"},
    },
}


class ExportError(TaktError):
    """A recording cannot be exported as requested."""


def write(
    recording: Recording, targets: Sequence[Path], signals: Sequence[str], start: float | None, end: float | None
) -> Iterator[str]:
    """Writes a part of a recording into files, in the formats of their suffixes (.mcap, .parquet, else CSV). Yields a
    sentence about missing data and about each file."""
    chosen = part(recording, signals, start, end)
    yield from troubles(chosen)
    for target in targets:
        if target.suffix == ".mcap":
            said = counted(to_mcap(chosen, target, scene=not signals), "message")
            yield f"{target}: {said} of {counted(len(chosen), 'component')} and of events"
        elif target.suffix == ".parquet":
            yield f"{chosen.to_parquet(target)}: {words_on_rates(chosen)}"
        else:
            yield f"{chosen.to_csv(target)}: {words_on_rates(chosen)}"


def part(recording: Recording, signals: Sequence[str], start: float | None, end: float | None) -> Recording:
    """Returns these signals, as in `takt plot`, or all, from `start` to `end` [s] (None: no bound)."""
    chosen = recording.pick(plot.select(recording, signals)) if signals else recording
    return chosen.between(start, end)


def rates(recording: Recording) -> dict[str, float]:
    """Returns the sample rate [Hz] of each component with at least two samples, by the median period."""
    tables = {name: recording[name]["time_s"] for name in recording}
    return {name: 1.0 / float(np.median(np.diff(time_s))) for name, time_s in tables.items() if len(time_s) > 1}


def words_on_rates(recording: Recording) -> str:
    """Returns a sentence about the rows of a table of all components."""
    known = {name: round(rate, 3) for name, rate in rates(recording).items()}
    if len(set(known.values())) < 2:
        return "a row for each cycle that was recorded"
    said = ", ".join(f"{name} {rate:g} Hz" for name, rate in known.items())
    return f"rates differ ({said}): a row for each cycle of any component; cells of those without a sample are empty"


def to_mcap(recording: Recording, path: Path, scene: bool = True) -> int:
    """Writes a recording as MCAP and returns the number of messages: a JSON channel for each component, with its name,
    and one for the events. Log times are engine time [ns]. Units are in the descriptions of the schemas, enumerations
    are texts, and NaN is left out, as JSON has no NaN. The machine file is attached.

    scene: also writes the geometry of the machine and its motion (/scene, /tf).

    Raises ExportError, and writes nothing, if the package mcap is not installed, or a time is negative or too large for
    MCAP.
    """
    try:
        from mcap.writer import Writer
    except ImportError:
        raise ExportError("writing MCAP needs the package mcap: pip install mcap") from None
    _check_times(recording)
    with written(path) as beside, beside.open("wb") as file:
        writer: Any = Writer(file)
        writer.start(profile="", library="takt")
        streams = [_component(writer, recording, name) for name in recording]
        streams.append(_events(writer, recording))
        streams += _scene(writer, recording) if scene else []
        count = 0
        for time_ns, channel, data in sorted_by_time(streams):
            writer.add_message(channel, log_time=time_ns, data=data, publish_time=time_ns, sequence=count)
            count += 1
        _about(writer, recording)
        writer.finish()
    return count


def _check_times(recording: Recording) -> None:
    """Raises ExportError if MCAP cannot represent a time."""
    times = [*(recording[name]["time_s"] for name in recording), [event.time_s for event in recording.events]]
    for time_s in map(np.asarray, times):
        wrong = time_s[~((time_s > -0.5e-9) & (time_s < LATEST_S))]  # in whole ns
        if len(wrong):
            raise ExportError(
                f"MCAP has no time {wrong[0]:g} s, only times from 0 s to {LATEST_S:.3g} s: export a part"
                " (--from, --to), or shift the recording (Recording.shifted)"
            )


Message = tuple[int, int, bytes]


def sorted_by_time(streams: Sequence[tuple[Array, int, Iterator[bytes]]]) -> Iterator[Message]:
    """Yields the messages of all streams (times [ns], channel, data) in the order of time."""
    times = np.concatenate([times for times, _, _ in streams])
    which = np.concatenate([np.full(len(times), i) for i, (times, _, _) in enumerate(streams)])
    for row in np.argsort(times, kind="stable").tolist():
        _, channel, data = streams[which[row]]
        yield int(times[row]), channel, next(data)


def _component(writer: Any, recording: Recording, name: str) -> tuple[Array, int, Iterator[bytes]]:
    fields = recording.fields(name)[1:]
    properties = {"time_s": {"type": "number", "description": "s"}}
    properties |= {field: _property(recording, name, field) for field in fields}
    schema = {"title": name, "type": "object", "properties": properties}
    number = writer.register_schema(name=f"takt.{name}", encoding="jsonschema", data=json.dumps(schema).encode())
    channel = writer.register_channel(topic=topic_of(name), message_encoding="json", schema_id=number)
    table = recording[name]
    return _ns(table["time_s"]), channel, _rows(recording, name)


def _property(recording: Recording, name: str, field: str) -> dict[str, Any]:
    column, unit = recording.column(name, field), recording.unit(name, field)
    if names := recording.names(name, field):
        return {"type": "string", "description": ", ".join(names.values())}
    if column.dtype.kind == "b":
        return {"type": "boolean"}
    about = {"description": unit} if unit not in ("", "1") else {}
    return {"type": "integer" if column.dtype.kind == "i" else "number", **about}


def _rows(recording: Recording, name: str) -> Iterator[bytes]:
    fields = recording.fields(name)
    columns = [
        (recording.text(name, f) if recording.names(name, f) else recording.column(name, f)).tolist() for f in fields
    ]
    for row in zip(*columns, strict=True):
        yield json.dumps(
            {f: v for f, v in zip(fields, row, strict=True) if not isinstance(v, float) or math.isfinite(v)}
        ).encode()


def _events(writer: Any, recording: Recording) -> tuple[Array, int, Iterator[bytes]]:
    number = writer.register_schema(name=LOG["title"], encoding="jsonschema", data=json.dumps(LOG).encode())
    channel = writer.register_channel(topic=EVENTS, message_encoding="json", schema_id=number)
    times = _ns(np.array([event.time_s for event in recording.events]))

    def messages() -> Iterator[bytes]:
        for event, time_ns in zip(recording.events, times.tolist(), strict=True):
            yield json.dumps(
                {
                    "timestamp": {"sec": time_ns // 10**9, "nsec": time_ns % 10**9},
                    "level": LEVELS.get(event.kind, DEBUG),
                    "message": event.text,
                    "name": event.component,
                    "file": event.kind,
                    "line": 0,
                }
            ).encode()

    return times, channel, messages()


def _scene(writer: Any, recording: Recording) -> list[tuple[Array, int, Iterator[bytes]]]:
    """Returns the streams of the scene; empty for recordings without their machine."""
    from takt.report.scene import machine_of  # reports need this module
    from takt.scene.foxglove import streams_of

    machine = machine_of(recording)
    shown: list[tuple[Array, int, Iterator[bytes]]] = []
    for stream in streams_of(recording, machine) if machine is not None and len(recording) else ():
        data = json.dumps(stream.schema).encode()
        number = writer.register_schema(name=stream.schema["title"], encoding="jsonschema", data=data)
        channel = writer.register_channel(topic=stream.topic, message_encoding="json", schema_id=number)
        shown.append((_ns(stream.times_s), channel, (json.dumps(message).encode() for message in stream.messages)))
    return shown


def _about(writer: Any, recording: Recording) -> None:
    """Writes the origin of the recording as metadata, and attaches the machine file."""
    plain = {name: str(v) for name, v in recording.meta.items() if isinstance(v, (str, int, float)) and v != ""}
    writer.add_metadata("takt", plain)
    if file := recording.meta.get("machine_file"):
        writer.add_attachment(0, 0, "machine.yaml", "application/yaml", file["text"].encode())


def _ns(time_s: Array) -> Array:
    return np.round(np.asarray(time_s, dtype=np.float64) * 1e9).astype(np.int64)
