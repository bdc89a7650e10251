"""EN-37, EN-38: files that were changed at random are read or refused in a sentence, by every reader, in bounded time
and memory. TAKT_LONG tries other ones, for longer."""

from __future__ import annotations

import io
import os
import random
import struct
import time
import zipfile
import zlib
from pathlib import Path

import pytest
from fuzz_readers import READERS, Reader
from fuzzing import changed, outcome, tried
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


def _npz(shape: str) -> bytes:
    """A recording whose header says that it has this shape."""
    said = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("header.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", len(said)) + said.encode() + bytes(80))
    return file.getvalue()


def _entities(levels: int) -> str:
    inner = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, levels))
    return f'<!DOCTYPE svg [<!ENTITY e0 "{"x" * 100}">{inner}]>'


ALIASES = "a0: &a0 [x]\n" + "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 12))
LINES = "".join(f'<path d="M0 {i} l 1e9 1e-9 Z" transform="rotate({i})"/>' for i in range(2000))
JOINTS = "".join(
    f'<link name="l{i}"/><joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
    '<axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>'
    for i in range(20_000)
)
BOMBS = {
    "yaml, aliases of aliases": ("yaml", ALIASES.encode()),
    "yaml, nested lists": ("yaml", b"[" * 200_000),
    "yaml, nested maps": ("yaml", b"a: {" * 100_000),
    "yaml, a long scalar": ("yaml", b"name: " + b"9" * 3_000_000),
    "yaml, as many axes": ("yaml", b"name: a\naxes:\n" + b"  - {name: x}\n" * 200_000),
    "urdf, a long chain": ("urdf", f'<robot name="r">{JOINTS}<link name="l20000"/></robot>'.encode()),
    "urdf, nested elements": ("urdf", b"<robot>" + b"<a>" * 300_000),
    "urdf, entities of entities": ("urdf", (_entities(10) + "<robot name='&e9;'/>").encode()),
    "stl, as many triangles": ("stl", bytes(80) + b"\xff\xff\xff\x7f" + bytes(5000)),
    "stl, one line": ("stl", b"solid " + b"facet " * 600_000),
    "svg, entities of entities": ("svg", (_entities(10) + "<svg><text>&e9;</text></svg>").encode()),
    "svg, nested groups": ("svg", b"<svg>" + b"<g>" * 200_000),
    "svg, a path of many arcs": ("svg", b'<svg><path d="M0 0' + b"A9 9 0 0 1 5 5" * 40_000 + b'"/></svg>'),
    "svg, huge and tiny": ("svg", f'<svg viewBox="0 0 9 9">{LINES}</svg>'.encode()),
    "svg_track, nested groups": ("svg_track", b"<svg>" + b"<g>" * 200_000),
    "dxf, a long line": ("dxf", b"0\nSECTION\n2\n" + b"x" * 3_000_000),
    "gcode, a loop without end": ("gcode", b"o1 while [1]\nG1 X1\no1 endwhile\nM2\n"),
    "gcode, loops in loops": ("gcode", b"o1 repeat [9999]\no2 repeat [9999]\n#1=[#1+1]\no2 endrepeat\no1 endrepeat\n"),
    "gcode, calls itself": ("gcode", b"o1 sub\no1 call\no1 call\no1 endsub\no1 call\nM2\n"),
    "gcode, nested brackets": ("gcode", b"G1 X" + b"[" * 300_000),
    "gcode, turns": ("gcode", b"G17 G2 X1 Y0 I1 J0 P999999999 F1\n"),
    "csv, a long field": ("csv", b'x,y,z\n"' + b"1" * 3_000_000),
    "csv, as many columns": ("csv", b"x,y,z" + b",x" * 1_000_000),
    "csv_cam, as many rows": ("csv_cam", b"x,y\n" + b"".join(b"%d,0\n" % i for i in range(300_000))),
    "csv_cam, one line": ("csv_cam", b"x,y" + b"," * 3_000_000),
    "csv_points, a long field": ("csv_points", b'x,y,z\n"' + b"1" * 3_000_000),
    "npz, an array of terabytes": ("npz", _npz("(999999999999,)")),
    "npz, dimensions": ("npz", _npz("(" + "1, " * 20 + ")")),
    "npz, a nested header": ("npz", _npz("(" * 300 + ")" * 300)),
    "log, lengths": ("log", (b"\xed\xa1\xda\x01" + bytes(16) + b"\x7f\xff\xff\xff\x7f\xff\xff\xff") * 20_000),
    "log, zeros": ("log", bytes(4_000_000)),
}


@pytest.mark.parametrize("name", BOMBS)
def test_hostile_files_take_bounded_time_and_memory(name: str) -> None:
    """EN-37: small files that mean much, and long ones that mean little."""
    reader, data = BOMBS[name]
    assert outcome(READERS[reader], data) in ("", "refused")


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
