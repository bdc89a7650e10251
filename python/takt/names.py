"""Lists of names, as arguments take them, and names of files, as people see them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable

_LONE = re.compile("[\ud800-\udfff]")


def shown(path: str | os.PathLike[str]) -> str:
    """Returns the name of a file as a text that UTF-8 can hold: bytes that Python could not decode become U+FFFD. The
    engine, YAML, JSON and pages take no others."""
    return _LONE.sub("\ufffd", os.fspath(path))


def names_in(given: object, argument: str, what: str, listed: str = "names") -> tuple[str, ...]:
    """The names of a list. TypeError for a text alone, which would be read letter by letter, and for anything in the
    list that is no name.

    what: what has the names, as "mover". listed: what the list is of, in sentences.
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
