"""Problems of the section `twin` that only show in the model, with file, line and key like those of the loader."""

from __future__ import annotations

import re
from collections.abc import Sequence

import yaml

from takt.errors import ConfigError, TaktError
from takt.yaml_text import compose


def problem(text: bytes, file_name: str, path: str, sentence: str) -> str:
    """Returns a problem as "machine.yaml:12:5: twin.axes[0].joint: expected ...", with line and column of the innermost
    key of `path` that the file has."""
    try:
        node = compose(text.decode())
    except (UnicodeDecodeError, yaml.YAMLError):
        return f"{file_name}: {path}: {sentence}"
    mark = None
    for key in re.findall(r"[^.\[\]]+", path):
        if isinstance(node, yaml.MappingNode):
            pairs = {getattr(name, "value", None): (name, of) for name, of in node.value}
            if key not in pairs:
                break
            name, node = pairs[key]
            mark = node.start_mark if isinstance(node, yaml.ScalarNode) else name.start_mark
        elif isinstance(node, yaml.SequenceNode) and key.isdecimal() and int(key) < len(node.value):
            node = node.value[int(key)]
            mark = node.start_mark
        else:
            break
    where = f":{mark.line + 1}:{mark.column + 1}" if mark is not None else ""
    return f"{file_name}{where}: {path}: {sentence}"


class Problems:
    """The problems of one machine file, collected."""

    def __init__(self, text: bytes, file_name: str) -> None:
        self._text = text
        self._file_name = file_name
        self._all: list[str] = []

    def add(self, path: str, sentence: str) -> None:
        self._all.append(problem(self._text, self._file_name, path, sentence))

    def end(self) -> None:
        """Raises ConfigError if there are any problems."""
        if self._all:
            raise ConfigError(self._all)

    def fail(self, path: str, sentence: str) -> ConfigError:
        return ConfigError([*self._all, problem(self._text, self._file_name, path, sentence)])


def mujoco_missing() -> TaktError:
    return TaktError('the twin needs MuJoCo, which is not installed: pip install "takt-motion[twin]"')


def near(word: str, known: Sequence[str]) -> str:
    """Returns a hint for an unknown name: the most similar known one, and all known ones."""
    import difflib

    match = difflib.get_close_matches(word, known, n=1)
    hint = f"; did you mean '{match[0]}'?" if match else ""
    return f"{hint} (it has {', '.join(known) or 'none'})"
