"""Writes files completely or not at all, with errors that name them."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import shutil
import stat
from collections.abc import Iterator
from pathlib import Path

from takt.errors import TaktError


def refuse_input(target: Path, *inputs: Path | None) -> None:
    """Raises TaktError if the file to be written is one of those that are read."""
    for file in inputs:
        if file is not None and file.exists() and target.exists() and target.samefile(file):
            raise TaktError(f"{target}: is a file that is read, so it is not written: give another one")


@contextlib.contextmanager
def naming(path: str | os.PathLike[str]) -> Iterator[None]:
    """A context that adds the name of this file to an OSError without one, as for a full disk."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno is not None:
            error.filename = os.fspath(path)
        raise


@contextlib.contextmanager
def written(target: str | os.PathLike[str]) -> Iterator[Path]:
    """Yields the path of a temporary file beside the target, which replaces the target at the end. If writing fails, it
    is removed, and the target is unchanged. Yields the target itself if it cannot be replaced by an equal file: it is
    not a regular file, as a pipe or /dev/stdout, is write-protected, has hard links or belongs to another user, or its
    directory is not writable. An OSError names the target."""
    given = Path(target)
    real = Path(os.path.realpath(given))
    beside = real.with_name(f".takt-{secrets.token_hex(6)}{real.suffix}")
    if given.is_relative_to("/dev") or not _is_writable(real.parent) or (given.exists() and not _is_replaceable(given)):
        beside = real = given
    try:
        yield beside
        if beside != real:
            _replace(real, beside)
    except BaseException as error:
        if beside != real:
            beside.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.errno is not None and error.filename in (None, os.fspath(beside)):
            error.filename = os.fspath(target)
            if error.filename2 is not None:
                del error.filename2  # None would be printed as a second name
        raise


def _is_writable(file: Path) -> bool:
    return os.access(file, os.W_OK, effective_ids=True)


def _is_replaceable(file: Path) -> bool:
    status = file.stat()
    alone = stat.S_ISREG(status.st_mode) and status.st_nlink == 1
    return alone and status.st_uid == os.geteuid() and _is_writable(file)


def _replace(target: Path, beside: Path) -> None:
    """Replaces the target by `beside`, with the mode and group of the target; copies the content if that is not
    permitted, or the target is a mount point."""
    try:
        if target.exists():
            group = target.stat().st_gid
            if group != beside.stat().st_gid:
                os.chown(beside, -1, group)
            shutil.copymode(target, beside)
        beside.replace(target)
    except OSError as error:
        if error.errno not in (errno.EPERM, errno.EBUSY):
            raise
        shutil.copyfile(beside, target)
        beside.unlink()


def write_text(target: str | os.PathLike[str], text: str) -> None:
    """Writes a text as UTF-8."""
    with written(target) as beside:
        beside.write_text(text, encoding="utf-8")
