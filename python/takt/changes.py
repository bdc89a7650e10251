"""Changes single values of a machine file for a run: `takt.Engine(machine, changes={"axes.x.limits.velocity": 300})`,
`takt run --set` and `takt sweep`. Only the values in the text are replaced; the rest, line numbers included, is kept.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

import yaml

from takt import _core
from takt.errors import ConfigError
from takt.yaml_text import compose, to_json

NAMES = ("name", "axis")  # keys that name elements of lists
MARK = "__takt_change_{}__"

Value = bool | int | float | str


def changed(text: bytes, file_name: str, changes: Mapping[str, Value]) -> bytes:
    """Returns the text of a machine file with other values. Keys of `changes` are paths: "axes.x.limits.velocity", with
    elements of lists by their name, by the axis that they belong to, or by number from 0. A missing key is added, and
    checked like any other. Raises ConfigError if a path does not exist or a value cannot be changed."""
    if not changes:
        return text
    try:
        parts = _parts(text.decode(), file_name, tuple(changes))
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        _core.load_machine(text, file_name)  # raises ConfigError with the reason and the line
        raise ConfigError([f"{file_name}: values cannot be changed in this text: {error}"]) from None
    values = [to_json(value) for value in changes.values()]
    return "".join(part if isinstance(part, str) else values[part] for part in parts).encode()


@functools.lru_cache(maxsize=8)
def _parts(text: str, file_name: str, paths: tuple[str, ...]) -> tuple[str | int, ...]:
    """Returns the parts of the text around the values, with the numbers of the values between them."""
    for number, path in enumerate(paths):
        text = _edited(text, file_name, path, MARK.format(number))
        for before in range(number):
            if MARK.format(before) not in text:
                raise ConfigError([f"{file_name}: {paths[before]} and {path} are the same value, which is given twice"])
    places = sorted((text.index(MARK.format(number)), number) for number in range(len(paths)))
    parts: list[str | int] = []
    at = 0
    for place, number in places:
        parts += [text[at:place], number]
        at = place + len(MARK.format(number))
    return (*parts, text[at:])


def _edited(text: str, file_name: str, path: str, value: str) -> str:
    node = compose(text)
    keys = path.split(".")
    depth = 0
    while depth < len(keys):
        if isinstance(node, yaml.SequenceNode):
            node, depth = _element(node, file_name, keys, depth)
            continue
        if isinstance(node, yaml.MappingNode):
            found = next((of for name, of in node.value if getattr(name, "value", None) == keys[depth]), None)
            if found is not None:
                node, depth = found, depth + 1
                continue
        if not all(keys[depth:]):
            raise _no_path(file_name, path)
        if isinstance(node, yaml.MappingNode):
            return _added(text, node, keys[depth:], value)
        if isinstance(node, yaml.ScalarNode) and node.tag.endswith(":null"):
            return _replaced(text, node, f" {_flow(keys[depth:], value)}")
        raise ConfigError([f"{file_name}: {'.'.join(keys[:depth])}: holds a value, so there is no {path}"])
    if not isinstance(node, yaml.ScalarNode):
        raise ConfigError([f"{file_name}: {path}: holds further keys; only single values can be changed"])
    return _replaced(text, node, f" {value}" if node.start_mark.index == node.end_mark.index else value)


def _element(node: yaml.SequenceNode, file_name: str, keys: list[str], depth: int) -> tuple[yaml.Node, int]:
    """Returns the element of a list named by the keys from `depth` on, and the depth after its name. Names may have
    dots; the longest match counts."""
    named: dict[str, yaml.Node] = {}
    for one in node.value:
        pairs = one.value if isinstance(one, yaml.MappingNode) else ()
        own = {getattr(name, "value", ""): getattr(of, "value", "") for name, of in pairs}
        named |= {own[name]: one for name in NAMES[::-1] if isinstance(own.get(name), str)}
    for end in range(len(keys), depth, -1):
        if (name := ".".join(keys[depth:end])) in named:
            return named[name], end
    key = keys[depth]
    if key.isdecimal() and int(key) < len(node.value):
        return node.value[int(key)], depth + 1
    if not key:
        raise _no_path(file_name, ".".join(keys))
    there = ", ".join(named) or f"{len(node.value)} without names"
    raise ConfigError([f"{file_name}: {'.'.join(keys[:depth])}: has no element '{key}' (it has {there})"])


def _no_path(file_name: str, path: str) -> ConfigError:
    return ConfigError([f"{file_name}: {path}: is no path of keys, as axes.x.limits.velocity is one"])


def _flow(keys: list[str], value: str) -> str:
    return f"{{{keys[0]}: {_flow(keys[1:], value)}}}" if keys else value


def _added(text: str, node: yaml.MappingNode, keys: list[str], value: str) -> str:
    line = f"{keys[0]}: {_flow(keys[1:], value)}"
    if node.flow_style:
        at = node.start_mark.index + 1
        return text[:at] + line + (", " if node.value else "") + text[at:]
    first: yaml.Mark = node.value[0][0].start_mark
    return text[: first.index] + line + "\n" + " " * first.column + text[first.index :]


def _replaced(text: str, node: yaml.Node, new: str) -> str:
    begin, end = int(node.start_mark.index), int(node.end_mark.index)
    return f"{text[:begin]}{new}{text[end:]}"


def value_of(text: str) -> Value:
    """Returns a value from its text on a command line: a number, true or false, else a text."""
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            number: int | float = kind(text)
        except ValueError:
            continue
        if abs(number) < float("inf"):
            return number
    return text


def text_of(value: Any) -> str:
    """Returns the text from which `value_of` makes exactly this value."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)
