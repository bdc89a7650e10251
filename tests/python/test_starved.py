"""A failing test in real time is told apart from a host that gave it no processor (tests/starved.py)."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
sys.path.insert(0, str(TESTS))
from starved import AHEAD  # noqa: E402

PROBE = """
import os, subprocess, time
from pathlib import Path

def run_beside(program, good):
    engine = subprocess.Popen([str(Path(__file__).parent / program), "60"])
    try:
        end = time.monotonic() + 2.0
        while time.monotonic() < end:
            pass
        assert good, "told too late"
    finally:
        engine.kill()
        engine.wait()

def test_late():
    run_beside("taktd", False)

def test_good():
    run_beside("taktd", True)

def test_nothing_in_real_time():
    run_beside("other", False)
"""

# Keeps its priority, for what watches the tests of this file takes it for one of them.
BUSY = """
import contextlib, os, sys
while True:
    with contextlib.suppress(PermissionError):
        os.setpriority(os.PRIO_PROCESS, 0, int(sys.argv[1]))
"""

OF_BUSY = """
def of_busy():
    ticks = Path("/proc", os.environ["BUSY"], "stat").read_text().split()[13:15]
    return sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")
"""


def use_one_processor() -> None:
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def run_beside_a_busy_program(folder: Path, probe: str, priority: int) -> str:
    """What pytest says of `probe` on one processor that a program with this nice value wants for itself."""
    for program in ("taktd", "other"):
        shutil.copy("/bin/sleep", folder / program)
    (folder / "test_probe.py").write_text(probe)
    (folder / "conftest.py").write_text(
        (TESTS / "conftest.py").read_text().replace("Path(__file__).parent", f"Path({str(TESTS)!r})")
    )

    busy = subprocess.Popen([sys.executable, "-c", BUSY, str(priority)], preexec_fn=use_one_processor)
    try:
        return subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-rA", "-p", "no:cacheprovider", "--rootdir", folder, folder],
            env={**os.environ, "TAKT_BUILD_DIR": str(folder), "BUSY": str(busy.pid)},
            preexec_fn=use_one_processor,
            capture_output=True,
            text=True,
            check=False,
        ).stdout
    finally:
        busy.kill()
        busy.wait()


@pytest.mark.any_host
def test_a_starved_test_is_skipped(tmp_path: Path) -> None:
    """Two programs share one processor: of the tests that fail the one in real time is excused, no other."""
    said = run_beside_a_busy_program(tmp_path, PROBE, AHEAD)
    assert "1 failed, 1 passed, 1 skipped" in said, said
    assert "test_probe.py::test_nothing_in_real_time" in said
    assert "the host was starved: " in said
    assert "it had failed: told too late" in said
    (line,) = (tmp_path / "starved.txt").read_text().splitlines()
    assert "test_probe.py::test_late: the host was starved: " in line


@pytest.mark.any_host
@pytest.mark.skipif(os.geteuid() != 0, reason="root alone may raise priorities")
def test_what_is_in_real_time_comes_first(tmp_path: Path) -> None:
    """A program of normal priority gets little of the processor meanwhile."""
    measured = PROBE.replace("end = time", "began = [time.process_time(), of_busy()]; end = time").replace(
        "assert good", "assert time.process_time() - began[0] > 3.0 * (of_busy() - began[1]) or program == 'other'"
    )
    said = run_beside_a_busy_program(tmp_path, measured + OF_BUSY, 0)
    assert "3 passed" in said, said
