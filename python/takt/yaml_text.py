"""YAML and JSON between Python and the engine: PyYAML refuses or splits some texts that the engine reads."""

from __future__ import annotations

import json
import re
from typing import Any

import yaml

# For the engine, a space or part of a comment or a text; for PyYAML, an error or the end of the line.
_LEGIBLE = str.maketrans(dict.fromkeys("\t\u2028\u2029\ufffe\uffff", " "))
_INDENT = re.compile(r"^ +", re.MULTILINE)
DEEPEST = 100  # levels of a text
_ESCAPED_PAIR = re.compile(r"\\u[Dd][89ABab][0-9A-Fa-f]{2}\\u[Dd][C-Fc-f][0-9A-Fa-f]{2}")
_PAIR = re.compile("[\ud800-\udbff][\udc00-\udfff]")
_ESCAPED = re.compile("[\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """YAML as the engine reads it: 1e-05 is a number."""


class _Joining:
    """Joins each escaped pair of surrogates to one character; libyaml refuses such pairs, PyYAML leaves them apart."""

    def scan_flow_scalar(self, style: str) -> Any:
        token = super().scan_flow_scalar(style)  # type: ignore[misc]
        token.value = _PAIR.sub(lambda pair: pair[0].encode("utf-16", "surrogatepass").decode("utf-16"), token.value)
        return token


class _JoiningLoader(_Joining, yaml.SafeLoader):
    """As _Loader, with pairs of surrogates, but slower."""


class _TextLoader(_Joining, yaml.BaseLoader):
    """Loads all values as texts."""


for _one in (_Loader, _JoiningLoader):
    _one.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?\d+[eE][-+]?\d+$"), list("-+0123456789"))


def _loader_of(text: str) -> type[Any]:
    return _JoiningLoader if _ESCAPED_PAIR.search(text) else _Loader


def _may_nest_deeper(text: str) -> bool:
    """Returns whether values nest deeper than DEEPEST; parses the text only if its brackets, dashes or indentation
    allow that."""
    opened = text.count("[") + text.count("{") + text.count("- ") + text.count("? ")
    if opened <= DEEPEST and max((len(indent) for indent in _INDENT.findall(text)), default=0) <= DEEPEST:
        return False
    level = 0
    try:
        for event in yaml.parse(legible(text), Loader=_loader_of(text)):
            level += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            if level > DEEPEST:
                return True
    except yaml.YAMLError:  # raised again for the caller when it loads the text
        pass
    return False


def legible(text: str) -> str:
    """Returns the text in the form from which PyYAML reads the same structure as the engine; each character keeps its
    index."""
    return text.translate(_LEGIBLE)


def load(text: str) -> Any:
    """Returns the value of a text that the engine accepts. Raises yaml.YAMLError or ValueError."""
    if _may_nest_deeper(text):  # libyaml's composer recurses without a limit
        raise ValueError(f"expected YAML that nests {DEEPEST} levels at most")
    try:
        return yaml.load(text, Loader=_loader_of(text))
    except yaml.YAMLError:
        if legible(text) == text:
            raise
        return yaml.load(legible(text), Loader=_loader_of(text))


def compose(text: str) -> yaml.Node | None:
    """Returns the nodes of a text that the engine accepts, with their positions in it. Raises yaml.YAMLError."""
    return yaml.compose(legible(text), Loader=_JoiningLoader)


def texts_of(arguments: str) -> dict[str, str]:
    """Returns the arguments of a command that are single values, as texts, for sentences; empty if they cannot be
    read."""
    try:
        read = yaml.load(legible(arguments), Loader=_TextLoader)
    except (yaml.YAMLError, ValueError, RecursionError):
        return {}
    pairs = read.items() if isinstance(read, dict) else ()
    return {key: value for key, value in pairs if isinstance(key, str) and isinstance(value, str)}


def to_json(value: Any, **options: Any) -> str:
    """Returns JSON that the engine reads: json.dumps without surrogate pairs."""
    text = json.dumps(value, ensure_ascii=False, **options)
    return _ESCAPED.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
