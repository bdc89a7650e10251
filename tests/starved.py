"""Tells a starved host from a fault: a test in real time that fails while the host gave it no processor is skipped.

A test is in real time where it has a taktd or a browser running. While tests run a process beside them looks each 0.1 s
how long their threads have waited for a processor (Linux counts it: /proc/PID/task/TID/schedstat), and how late it was
woken itself. A failure counts as the host's where, since the test or what it shares with others began, a thread waited
for more than STARVED of a second, or the whole host stood for so long. The skip says so; `dev` counts them in
TAKT_BUILD_DIR/starved.txt, and more than a few fail.

So that this is rare, a test in real time and all that it runs come before others on the host, where that is allowed
(root's tests, those of CI): its threads get the priority AHEAD as soon as they are seen.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections import deque
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

STARVED = 0.25  # of one second
PERIOD_S = 0.1
REAL_TIME = ("taktd", "chrom")  # what names of programs begin with
AHEAD = -10  # nice value of what runs in real time


class Look(NamedTuple):
    """What was seen at one time."""

    time_s: float  # time.monotonic()
    waited_s: float  # in the second before, the thread that waited longest
    late_s: float  # of the look itself
    real_time: bool  # a program in real time was there


def descendants(parent: int) -> dict[int, str]:
    """The process and all under it, with the names of their programs."""
    children: dict[int, list[int]] = {}
    names: dict[int, str] = {}
    for entry in os.scandir("/proc"):
        if entry.name.isdigit():
            try:
                text = Path(entry.path, "stat").read_text()
            except OSError:  # ended meanwhile
                continue
            name, rest = text[text.index("(") + 1 :].rsplit(")", 1)
            if rest.split()[0] == "Z":
                continue
            names[int(entry.name)] = name
            children.setdefault(int(rest.split()[1]), []).append(int(entry.name))
    found: dict[int, str] = {}
    left = [parent]
    while left:
        pid = left.pop()
        if pid != os.getpid():
            found[pid] = names.get(pid, "")
            left += children.get(pid, [])
    return found


def waits_s(pids: Iterator[int]) -> dict[str, float]:
    """How long each thread has waited for a processor so far."""
    waits: dict[str, float] = {}
    for pid in pids:
        try:
            for task in os.scandir(f"/proc/{pid}/task"):
                waits[task.name] = int(Path(task.path, "schedstat").read_text().split()[1]) * 1e-9
        except (OSError, IndexError):  # ended meanwhile, or a kernel that does not count
            continue
    return waits


def put_ahead(pids: Iterable[int], ahead: set[int]) -> None:
    """Gives their threads the priority, but for those in `ahead`, which have been given it; adds them there."""
    for pid in pids:
        try:
            for thread in {int(task.name) for task in Path(f"/proc/{pid}/task").iterdir()} - ahead:
                os.setpriority(os.PRIO_PROCESS, thread, AHEAD)
                ahead.add(thread)
        except OSError:  # ended meanwhile, or not allowed
            continue


def watch(parent: int) -> None:
    """Prints a Look each 0.1 s in which anything was waited for, until the parent is gone."""
    history: deque[dict[str, float]] = deque(maxlen=round(1.0 / PERIOD_S))
    ahead: set[int] = set()
    planned_s = time.monotonic()
    while os.getppid() == parent:
        now_s = time.monotonic()
        processes = descendants(parent)
        real_time = any(name.startswith(REAL_TIME) for name in processes.values())
        if real_time:
            put_ahead([*processes, os.getpid()], ahead)
        waits = waits_s(iter(processes))
        waited_s = max((waits[task] - history[0].get(task, 0.0) for task in waits), default=0.0) if history else 0.0
        history.append(waits)
        late_s = now_s - planned_s
        if max(waited_s, late_s) > STARVED:
            print(now_s, waited_s, late_s, int(real_time), flush=True)
        planned_s = time.monotonic() + PERIOD_S
        time.sleep(PERIOD_S)


class Host:
    """A pytest plugin."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / f"host-{os.getpid()}.txt"
        self._count = folder / "starved.txt"
        with self._file.open("w") as out:
            self._watching = subprocess.Popen([sys.executable, "-I", __file__, str(os.getpid())], stdout=out)
        self._began_s: dict[str, float] = {}  # each file of tests, each test

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
        outcome = yield
        report = outcome.get_result()  # type: ignore[attr-defined]
        began_s = self._began_s.setdefault(item.nodeid, time.monotonic() - call.duration)
        shared_s = self._began_s.setdefault(str(item.path), began_s)
        excused = item.get_closest_marker("any_host") is None
        if report.failed and excused and (said := self._starved_since(shared_s if shares(item) else began_s)):
            report.outcome = "skipped"
            path, line, _ = item.location
            report.longrepr = (
                path,
                line or 0,
                f"{said}; it had failed: {str(call.excinfo and call.excinfo.value)[:200]}",
            )
            with self._count.open("a") as count:
                count.write(f"{item.nodeid}: {said}\n")

    def _starved_since(self, began_s: float) -> str:
        """Why the host was to blame; empty: it was not."""
        if not self._file.exists():
            return ""
        lines = [line.split() for line in self._file.read_text().splitlines()]
        looks = [Look(float(a), float(b), float(c), d == "1") for a, b, c, d in lines if float(a) >= began_s]
        looks = [look for look in looks if look.real_time]
        if not looks:
            return ""
        waited_s = max(max(look.waited_s, look.late_s) for look in looks)
        return f"the host was starved: {waited_s:.2f} s without a processor within one second"

    def pytest_unconfigure(self) -> None:
        self._watching.kill()
        self._watching.wait()
        self._file.unlink(missing_ok=True)


def shares(item: pytest.Item) -> bool:
    """The test uses what an earlier one of its file has begun."""
    fixtures = getattr(item, "_fixtureinfo").name2fixturedefs.values()  # noqa: B009
    return any(definition[-1].scope != "function" for definition in fixtures)


if __name__ == "__main__":
    watch(int(sys.argv[1]))
