"""EN-37, EN-38: files that were changed at random are read or refused in a sentence, by every reader, in bounded time
and memory. TAKT_LONG tries other ones, for longer."""

from __future__ import annotations

import os
import random
import time
import zlib
from pathlib import Path

import pytest
from fuzz_readers import READERS, Reader
from fuzzing import changed, tried
from takt.errors import TaktError

LONG = bool(os.environ.get("TAKT_LONG"))
TRIES = 100_000 if LONG else 40
SECONDS = 60.0 if LONG else 1e9
FIRST = random.SystemRandom().randrange(10**9) if LONG else 0


@pytest.mark.parametrize("name", READERS)
def test_changed_files_are_read_or_refused(name: str) -> None:
    found = tried(READERS[name], TRIES, FIRST, SECONDS)
    assert not found.failed, "\n".join(found.failed)
    assert found.read + found.refused > 0


@pytest.mark.parametrize("name", READERS)
def test_whole_files_are_read(name: str, tmp_path: Path) -> None:
    """Else nothing behind the first check would be tried."""
    reader = READERS[name]
    for whole in reader.whole():
        file = tmp_path / f"a{reader.suffix}"
        file.write_bytes(whole)
        reader.read(file)


def _bad_reader(what: str) -> Reader:
    def read(file: Path) -> None:
        number = zlib.crc32(file.read_bytes())
        if number % 4 == 0:
            raise TaktError("a sentence")
        if what == "hangs" and number % 16 == 1:
            while True:
                time.process_time()
        if what == "eats memory" and number % 16 == 1:
            bytearray(3 << 30)
        if what == "dies" and number % 16 == 1:
            os.abort()
        if what == "raises anything" and number % 16 == 1:
            raise KeyError("x")

    return Reader("csv_points", ".csv", read, READERS["csv_points"].whole, (b"x",))


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("hangs", "took more than 0.2 s of processor time"),
        ("eats memory", "MemoryError"),
        ("dies", "ended the process: SIGABRT"),
        ("raises anything", "KeyError"),
    ],
)
def test_readers_that_fail_are_found(what: str, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever a reader does, its file is named, and the others are tried."""
    monkeypatch.setattr("fuzzing.SECONDS", 0.2)
    found = tried(_bad_reader(what), 60)
    assert found.failed
    assert all(said in line for line in found.failed)
    assert found.read + found.refused + len(found.failed) == 60


def test_a_seed_makes_the_same_file_again() -> None:
    reader = READERS["csv"]
    assert changed(reader, 5) == changed(reader, 5)
    assert len({changed(reader, seed) for seed in range(20)}) > 15
