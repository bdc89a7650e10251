"""Sphinx takes the doc strings of this project, which are prose and no reStructuredText.

What is indented behind a blank line is code. Lines that go on are indented, so `name: what it is` begins an item where
others hang from it or stand beside it. `|` and `*` are themselves.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

MEANS_SOMETHING = re.compile(r"[|*\\]|(?<=\w)_(?=\W|$)")
ITEM = re.compile(r"(\w+(?:, \w+)*): (.*)")


def to_rst(lines: list[str]) -> list[str]:
    """The lines of a doc string as reStructuredText."""
    paragraphs: list[list[str]] = [[]]
    for line in lines:
        if line.strip():
            paragraphs[-1].append(line)
        elif paragraphs[-1]:
            paragraphs.append([])
    return [line for paragraph in paragraphs if paragraph for line in _paragraph(paragraph)]


def _paragraph(lines: list[str]) -> Iterator[str]:
    if all(line.startswith("    ") for line in lines):
        yield from ["::", "", *lines, ""]
        return
    hangs = any(line.startswith(" ") for line in lines)
    begins = sum(bool(ITEM.match(line)) for line in lines)
    in_item = False
    for line in lines:
        item = ITEM.match(line)
        if item and (hangs or begins > 1):
            if not in_item:
                yield ""
            in_item = True
            yield f"- **{item[1]}**: {_escaped(item[2])}"
            continue
        if line.startswith("- "):
            in_item = True
            yield f"- {_escaped(line[2:])}"
            continue
        if in_item and not line.startswith(" "):
            yield ""
            in_item = False
        yield ("  " if in_item else "") + _escaped(line.strip())
    yield ""


def _escaped(text: str) -> str:
    """Without meaning to reStructuredText, but for `names`."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else MEANS_SOMETHING.sub(r"\\\g<0>", part) for part in parts)


def _process(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    lines[:] = to_rst(lines)


def setup(app: Any) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", _process)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
