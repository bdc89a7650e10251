"""Checks lists of names in arguments, and makes names of files displayable."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable

_LONE = re.compile("[\ud800-\udfff]")


def shown(path: str | os.PathLike[str]) -> str:
    """Returns the name of a file as text that can be encoded as UTF-8: bytes that Python could not decode become
    U+FFFD. The engine, YAML, JSON and pages accept no other text."""
    return _LONE.sub("\ufffd", os.fspath(path))


def names_in(given: object, argument: str, what: str, listed: str = "names") -> tuple[str, ...]:
    """Returns the names in a list. Raises TypeError for a single text, which would be read letter by letter, and for
    entries that are not texts.

    argument: the name of the argument, for sentences.
    what: the kind of named thing, as "mover".
    listed: the plural of the entries, for sentences.
    """
    if isinstance(given, str) or not isinstance(given, Iterable):
        found = f"the text {given!r}" if isinstance(given, str) else repr(given)
        raise TypeError(f"{argument} is a list of {listed}, not {found}")
    names = tuple(given)
    for name in names:
        if not isinstance(name, str):
            article = "an" if what[0] in "aeiou" else "a"
            raise TypeError(f"{argument}: {article} {what} goes by its name, not by {name!r}")
    return names
