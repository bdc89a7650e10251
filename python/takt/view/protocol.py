"""The protocol of the socket between server and page.

To the page: the machine as JSON text when there is a new one; then frames, up to twenty a second. A frame is a JSON
header followed by float64 numbers: 4 bytes with the header's length, the header, padding to 8 bytes, the numbers. The
header describes the numbers. To the server: JSON texts, see `Request`."""

from __future__ import annotations

import json
import struct
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from takt.recording import Array
from takt.view.machine import Machine

MOST_SIGNALS = 256
MOST_DETAILS = 16
MOST_LETTERS = 60  # longest name or unit
SIGNS = set("\"'\\{}[]:,#")  # delimiters in the text of arguments
POINTS = 20  # of a cam, most in one command
LARGEST = sys.float_info.max  # integers of JSON may be larger
KEYS = dict.fromkeys(("ack", "epoch", "signals", "after", "details", "command", "hold")).keys()


class RequestError(Exception):
    """The request of a page is invalid; the text says why."""


@dataclass(frozen=True)
class Request:
    """The data that a page requests from now on; None: unchanged."""

    ack: int | None = None  # the last frame that was drawn
    signals: Mapping[int, tuple[str, ...]] | None = None  # fields by component
    after: Mapping[int, float] = field(default_factory=dict)  # by component: the newest cycle that the page has
    details: tuple[int, ...] | None = None  # components with all their fields
    command: tuple[str, str, dict[str, Any]] | None = None  # target, verb, arguments
    hold: bool | None = None  # true: a button is held; false: it was released


def frame(header: Mapping[str, Any], numbers: Sequence[Array]) -> bytes:
    text = json.dumps(header, allow_nan=False, separators=(",", ":")).encode()
    padding = -(4 + len(text)) % 8
    parts = [struct.pack("<I", len(text)), text, b" " * padding]
    parts += [np.ascontiguousarray(one, dtype="<f8").tobytes() for one in numbers]
    return b"".join(parts)


def parse(text: str, machine: Machine | None, epoch: int) -> Request:
    """Returns the request in a text. Requests about a former machine are reduced to `ack`. Raises RequestError."""
    try:
        said = json.loads(text)
    except (ValueError, RecursionError):
        raise RequestError("a request is JSON") from None
    if not isinstance(said, dict) or not said.keys() <= KEYS:
        raise RequestError(f"a request has some of {', '.join(KEYS)}")
    ack = said.get("ack")
    if ack is not None and type(ack) is not int:
        raise RequestError("ack is the number of a frame")
    if machine is None or said.get("epoch") != epoch:
        return Request(ack)
    return Request(
        ack,
        _signals(said["signals"], machine) if "signals" in said else None,
        {_index(i, machine): _number(cycle) for i, cycle in _pairs(said.get("after", []))},
        _details(said["details"], machine) if "details" in said else None,
        _command(said["command"]) if "command" in said else None,
        bool(said["hold"]) if "hold" in said else None,
    )


def _signals(said: Any, machine: Machine) -> dict[int, tuple[str, ...]]:
    pairs = _pairs(said)
    if len(pairs) > MOST_SIGNALS:
        raise RequestError(f"{len(pairs)} signals are too many: {MOST_SIGNALS} at most")
    wanted: dict[int, dict[str, None]] = {}
    for at, name in pairs:
        source = machine.sources[_index(at, machine)]
        if not isinstance(name, str) or name not in source.layout.dtype.fields:  # type: ignore[operator]
            raise RequestError(f"{source.name} publishes no {name!r}")
        wanted.setdefault(source.index, {})[name] = None
    return {index: tuple(fields) for index, fields in wanted.items()}


def _details(said: Any, machine: Machine) -> tuple[int, ...]:
    if not isinstance(said, list):
        raise RequestError("details are a list of components")
    return tuple(_index(at, machine) for at in said[:MOST_DETAILS])


def _command(said: Any) -> tuple[str, str, dict[str, Any]]:
    match said:
        case [str(target), str(verb), dict(arguments)]:
            if all(_is_plain(value) or _are_points(value) for value in arguments.values()):
                return target, verb, arguments
    raise RequestError(
        "a command has a target, a verb and arguments that are numbers, switches, words or points of a cam"
    )


def _is_plain(value: Any) -> bool:
    """Returns whether a value holds nothing that could end the text of an argument."""
    return type(value) in (bool, int, float) or (isinstance(value, str) and _is_word(value))


def _is_word(text: str) -> bool:
    """Returns whether a text is a name or a unit."""
    return 0 < len(text) <= MOST_LETTERS and text.isprintable() and not SIGNS & set(text)


def _are_points(value: Any) -> bool:
    return (
        isinstance(value, list)
        and len(value) <= POINTS
        and all(
            isinstance(point, dict)
            and point.keys() <= set("xyva")
            and all(type(number) in (int, float) and abs(number) <= LARGEST for number in point.values())
            for point in value
        )
    )


def _pairs(said: Any) -> list[list[Any]]:
    if not isinstance(said, list) or not all(isinstance(one, list) and len(one) == 2 for one in said):
        raise RequestError("expected a list of pairs")
    return said


def _index(said: Any, machine: Machine) -> int:
    if type(said) is not int or not 0 <= said < len(machine.sources):
        raise RequestError(f"there is no component {said!r}")
    return said


def _number(said: Any) -> float:
    if type(said) not in (int, float):
        raise RequestError(f"{said!r} is no number")
    if not abs(said) <= LARGEST:
        raise RequestError("a number is finite")
    return float(said)
