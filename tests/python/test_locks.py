"""EN-38: what `./dev` installs from the index is named exactly, with hashes, and is what the lists ask for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tools.lock_packages import LOCKS, lists

ROOT = Path(__file__).resolve().parents[2]


def entries(name: str) -> list[str]:
    """Of a lock, one for each package and range of Pythons."""
    return re.split(r"\n(?=\S)", (LOCKS / f"{name}.lock").read_text().strip())


def plain(name: str) -> str:
    """A package's name as the index knows it."""
    return re.sub(r"[-_.]+", "-", name).lower()


@pytest.mark.parametrize("name", [*lists()])
def test_entries_are_exact_and_have_hashes(name: str) -> None:
    """EN-38: no entry of a lock leaves pip a choice."""
    for entry in entries(name):
        first, *hashes = entry.split(" \\\n")
        assert re.fullmatch(r"[a-z0-9-]+==[\w.]+( ; [^\n]+)?", first), first
        assert hashes, first
        assert all(re.fullmatch(r"    --hash=sha256:[0-9a-f]{64}", line) for line in hashes), first


def test_locks_are_of_these_lists() -> None:
    """EN-38: a package or version that was changed in requirements-dev.txt or pyproject.toml was locked anew."""
    locked = {entry.split(" ")[0] for name in lists() for entry in entries(name)}
    names = {entry.split("==")[0] for entry in locked}
    for package in (package for packages in lists().values() for package in packages):
        found = re.match(r"([\w.-]+)(?:==([^;\s]+))?", package)
        assert found
        name, version = plain(found[1]), found[2]
        assert name in names, f"{package}: not locked; python tools/lock_packages.py"
        assert not version or f"{name}=={version}" in locked, f"{package}: {name} is locked at another version"
