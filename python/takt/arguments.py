"""Writes the arguments of a command as the one-line text that the engine reads: {position: 100.0, direction:
positive}."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from enum import Enum
from numbers import Integral, Real
from typing import Any

from takt.yaml_text import to_json

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_NOT_TEXT = {"true", "false", "null", "yes", "no", "on", "off", "y", "n", "nan", "inf"}


def to_text(arguments: Mapping[str, Any], defaults: Mapping[str, Any] | None = None) -> str:
    """Returns the arguments as text; "" if there are none. Arguments that are None or equal to their `defaults` are
    omitted. Values are not checked here: the engine checks them and reports errors. Raises ValueError for a key that is
    not a name."""
    for key in arguments:
        if not isinstance(key, str) or not _PLAIN.fullmatch(key):
            raise ValueError(f"{key!r} is no name of an argument")
    usual = defaults or {}
    given = {key: _value(value) for key, value in arguments.items() if value is not None}
    told = [(key, value) for key, value in given.items() if key not in usual or _value(usual[key]) != value]
    text = ", ".join(f"{key}: {value}" for key, value in told)
    return f"{{{text}}}" if text else ""


def _value(value: Any) -> str:
    if isinstance(value, Enum):
        return _value(value.value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Integral):
        return repr(int(value))
    if isinstance(value, Real):
        return repr(float(value))
    if isinstance(value, Mapping):
        return to_text(value) or "{}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"[{', '.join(map(_value, value))}]"
    text = str(value)
    return text if _PLAIN.fullmatch(text) and text.lower() not in _NOT_TEXT else to_json(text)


def without_arguments(text: str) -> str:
    """Returns "x.move_absolute" for "x.move_absolute {position: 40.0}": enough for the end of a command."""
    return text.split(" {", 1)[0]
