"""A failing test in real time is told apart from a host that gave it no processor (tests/starved.py)."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]

PROBE = """
import subprocess, time
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


@pytest.mark.any_host
def test_a_starved_test_is_skipped(tmp_path: Path) -> None:
    """Two programs share one processor: of the tests that fail the one in real time is excused, no other."""
    for program in ("taktd", "other"):
        shutil.copy("/bin/sleep", tmp_path / program)
    (tmp_path / "test_probe.py").write_text(PROBE)
    (tmp_path / "conftest.py").write_text(
        (TESTS / "conftest.py").read_text().replace("Path(__file__).parent", repr(str(TESTS)))
    )
    one = {min(os.sched_getaffinity(0))}
    busy = subprocess.Popen([sys.executable, "-c", "while True: pass"], preexec_fn=lambda: os.sched_setaffinity(0, one))
    try:
        done = subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-rA", "-p", "no:cacheprovider", "--rootdir", tmp_path, tmp_path],
            env={**os.environ, "TAKT_BUILD_DIR": str(tmp_path)},
            preexec_fn=lambda: os.sched_setaffinity(0, one),
            capture_output=True,
            text=True,
            check=False,
        )
    finally:
        busy.kill()
        busy.wait()
    assert "1 failed, 1 passed, 1 skipped" in done.stdout, done.stdout
    assert "test_probe.py::test_nothing_in_real_time" in done.stdout
    assert "the host was starved: " in done.stdout
    assert "it had failed: told too late" in done.stdout
    (line,) = (tmp_path / "starved.txt").read_text().splitlines()
    assert "test_probe.py::test_late: the host was starved: " in line
