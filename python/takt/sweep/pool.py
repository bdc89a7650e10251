"""The workers of a sweep: processes that are started once and given ranges of runs. A worker that dies is replaced; the
run in which it died is tried once more, and reported as failed in its row if another worker dies in it, too."""

from __future__ import annotations

import contextlib
import heapq
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from multiprocessing.connection import Connection, wait
from typing import IO, Any

from takt.sweep.design import Design, SweepError
from takt.sweep.runs import Job, Row

AT_ONCE = 16  # most runs that a worker is given at once
AHEAD = 4096  # how far runs may be ahead of the oldest missing one
TRIES = 2  # of a run in which a worker dies
# The memory of an engine is 40 MB; by default glibc returns it after each run, and half of the time of a run was spent
# on allocating it again.
KEEP_MEMORY = {"MALLOC_MMAP_MAX_": "0", "MALLOC_TRIM_THRESHOLD_": str(2**33), "MALLOC_TOP_PAD_": str(2**26)}
LOOK_S = 1.0  # interval of checks of the timeout


class Worker:
    """One process."""

    def __init__(self, job: Job, design: Design) -> None:
        ours, theirs = socket.socketpair()
        self.errors: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115
        command = [sys.executable, "-m", "takt.sweep.worker", str(theirs.fileno())]
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=self.errors,
            pass_fds=[theirs.fileno()],
            env=os.environ | KEEP_MEMORY,
        )
        theirs.close()
        self.connection = Connection(ours.detach())
        self.connection.send((job, design))
        self.ready = False
        self.at = self.end = 0  # run in progress, and the end of its range
        self.since = time.monotonic()

    @property
    def idle(self) -> bool:
        return self.ready and self.at == self.end

    def give(self, first: int, end: int) -> None:
        self.at, self.end = first, end
        self.since = time.monotonic()
        self.connection.send((first, end))

    def last_words(self) -> str:
        self.errors.seek(0)
        lines = self.errors.read().decode("utf-8", "replace").strip().splitlines()
        return lines[-1] if lines else ""

    def close(self) -> None:
        self.connection.close()
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.errors.close()

    def how_it_ended(self) -> str:
        code = self.process.wait()
        if code < 0:
            return f"its worker was ended by {signal.Signals(-code).name}"
        return f"its worker ended with exit code {code}"


class Pool:
    """Makes the runs from `first` to `end` and passes on their rows in order."""

    def __init__(self, job: Job, design: Design, workers: int, timeout_s: float) -> None:
        self._job, self._design, self._timeout_s = job, design, timeout_s
        self._count = workers
        self._workers: list[Worker] = []
        self._again: list[tuple[int, int]] = []  # ranges of workers that died
        self._tries: Counter[int] = Counter()
        self._rows: dict[int, Row] = {}  # rows that wait for an earlier one
        self._next = self._end = self._oldest = 0

    @property
    def keys(self) -> list[str]:
        """The varied keys."""
        return self._design.keys

    def run(self, first: int, end: int, take: Callable[[Row], None]) -> None:
        self._next = self._oldest = first
        self._end = end
        try:
            for _ in range(min(self._count, end - first)):
                self._workers.append(Worker(self._job, self._design))
            while self._oldest < end:
                self._give()
                self._hear()
                while (row := self._rows.pop(self._oldest, None)) is not None:
                    self._oldest += 1
                    take(row)
        finally:
            for worker in self._workers:
                worker.close()

    def _give(self) -> None:
        for worker in self._workers:
            if not worker.idle:
                continue
            if self._again:
                span = heapq.heappop(self._again)
            elif self._next < min(self._end, self._oldest + AHEAD):
                each = max(1, min(AT_ONCE, (self._end - self._next) // (4 * self._count)))
                span = (self._next, min(self._next + each, self._end))
                self._next = span[1]
            else:
                continue
            with contextlib.suppress(OSError):  # it has died: `_hear` detects that
                worker.give(*span)

    def _hear(self) -> None:
        heard: list[Any] = wait([worker.connection for worker in self._workers], LOOK_S)
        for worker in [one for one in self._workers if one.connection in heard]:
            try:
                number, row = worker.connection.recv()
            except (EOFError, OSError):
                self._replace(worker, worker.how_it_ended())
                continue
            worker.since = time.monotonic()
            if number == "ready":
                worker.ready = True
            else:
                worker.at = number + 1
                self._rows[number] = row
        for worker in list(self._workers):
            if worker.ready and not worker.idle and time.monotonic() - worker.since > self._timeout_s:
                self._tries[worker.at] = TRIES  # it would take too long again
                self._replace(worker, f"it took longer than {self._timeout_s:g} s")

    def _replace(self, worker: Worker, why: str) -> None:
        if not worker.ready:
            raise SweepError(f"a worker cannot be started: {why}: {worker.last_words()}")
        words = worker.last_words()
        worker.close()
        self._workers.remove(worker)
        at, end = worker.at, worker.end
        if at < end:
            self._tries[at] += 1
            if self._tries[at] >= TRIES:
                failed = f"no result: {why}" + (f": {words}" if words else "")
                self._rows[at] = self._job.row(at, self._design.point(at), failed, {}, {})
                at += 1
        if at < end:
            heapq.heappush(self._again, (at, end))
        self._workers.append(Worker(self._job, self._design))
