"""Files that are written whole or not at all, and errors that name them."""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

from takt.errors import TaktError


def refuse_input(target: Path, *inputs: Path | None) -> None:
    """Raises TaktError where a file to be written is one of those that are read."""
    for file in inputs:
        if file is not None and file.exists() and target.exists() and target.samefile(file):
            raise TaktError(f"{target}: is a file that is read, so it is not written: give another one")


@contextlib.contextmanager
def naming(path: str | os.PathLike[str]) -> Iterator[None]:
    """Gives the name of this file to an OSError that has none, as of a full disk."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno is not None:
            error.filename = os.fspath(path)
        raise


@contextlib.contextmanager
def written(target: str | os.PathLike[str]) -> Iterator[Path]:
    """Yields the path of a file beside the target, which replaces the target in the end; it is removed where writing
    fails, and the target stays as it was. Yields the target itself where it is no regular file, as a pipe or
    /dev/stdout, or where its directory takes no other file. An OSError names the target."""
    given = Path(target)
    real = Path(os.path.realpath(given))
    beside = real.with_name(f".takt-{secrets.token_hex(6)}{real.suffix}")
    special = given.is_relative_to("/dev") or (given.exists() and not given.is_file())
    if special or not os.access(real.parent, os.W_OK):
        beside = real = given
    try:
        yield beside
        if beside != real:
            with contextlib.suppress(FileNotFoundError):
                shutil.copymode(real, beside)
            beside.replace(real)
    except BaseException as error:
        if beside != real:
            beside.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.errno is not None and error.filename in (None, os.fspath(beside)):
            error.filename, error.filename2 = os.fspath(target), None
        raise


def write_text(target: str | os.PathLike[str], text: str) -> None:
    """Writes a text as UTF-8."""
    with written(target) as beside:
        beside.write_text(text, encoding="utf-8")
