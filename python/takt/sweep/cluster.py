"""The runs of a sweep on a cluster: workers of Dask distributed, wherever a scheduler has them. The rows equal those of
local processes. Dask is an extra: pip install "takt-motion[cluster]"."""

from __future__ import annotations

import itertools
import logging
import re
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from weakref import WeakValueDictionary

import takt
from takt.sweep.design import Design, SweepError
from takt.sweep.runs import Job, Row

AT_ONCE = 16  # most runs that a worker is given at once
AHEAD = 3  # pending ranges of runs per thread of the workers
CONNECT_S = 10.0
LOOK_S = 1.0  # interval of checks of the scheduler
GONE_S = 10.0  # time without a scheduler after which a sweep ends
ADDRESS = re.compile(r"[a-z][a-z0-9+]*://[^\s/]+(/\S*)?")
_alone = threading.Lock()


@dataclass
class Range:
    """Consecutive runs that a worker is given at once."""

    first: int
    end: int
    at: int = -1  # the run in progress
    worker: str = ""  # address of its worker
    since: float | None = None  # time.monotonic() [s] at which the run began; None: no run is in progress


def make(job: Job, design: Design, first: int, end: int, topic: str, token: int) -> list[Row]:
    """Runs on a worker: returns the rows of some runs. Scenarios are modules, so only one at a time in each process."""
    rows = []
    with _alone:
        for number in range(first, end):
            tell(topic, token, number)
            rows.append(job.run(number, design.point(number)))
    return rows


def tell(topic: str, token: int, number: int) -> None:
    """Runs on a worker: reports that a run begins."""
    from distributed import get_worker

    worker = get_worker()
    worker.log_event(topic, (token, number, worker.address))


def version() -> str:
    """Runs on a worker: returns the version of its takt."""
    return takt.__version__


class Cluster:
    """Like `pool.Pool`, on the workers of a scheduler."""

    def __init__(self, job: Job, design: Design, address: str, timeout_s: float) -> None:
        self._job, self._design, self._address, self._timeout_s = job, design, address, timeout_s
        self._made = 0
        self._topic = f"takt-sweep-{uuid.uuid4().hex}"  # topic of the events that report the beginning of a run
        self._tokens = itertools.count()
        self._given: WeakValueDictionary[int, Range] = WeakValueDictionary()  # by token
        self._heard = time.monotonic()  # when a run last began or ended
        self._held: set[str] = set()  # addresses of workers with an abandoned run, which may continue
        self._free: list[str] = []  # addresses of the others, once a run was abandoned
        if not ADDRESS.fullmatch(address):  # Dask would take it for a host name, and search for it for a long time
            raise SweepError(f"expected the address of a scheduler as tcp://host:8786, found '{address}'")
        try:
            import distributed
        except ImportError:
            raise SweepError(
                "a sweep on a cluster needs Dask distributed, which is not installed: "
                'pip install "takt-motion[cluster]"'
            ) from None
        self._dask: Any = distributed

    @property
    def keys(self) -> list[str]:
        """The varied keys."""
        return self._design.keys

    def run(self, first: int, end: int, take: Callable[[Row], None]) -> None:
        with _quiet():
            try:
                client = self._dask.Client(self._address, timeout=CONNECT_S, set_as_default=False)
            except (OSError, ValueError, TimeoutError) as error:
                raise SweepError(f"no scheduler of Dask answers at {self._address}: {_line(error)}") from None
            try:
                with client.as_current():
                    self._run(client, first, end, take)
            finally:
                client.close(timeout=LOOK_S)

    def _run(self, client: Any, first: int, end: int, take: Callable[[Row], None]) -> None:
        threads = self._check(client)
        client.subscribe_topic(self._topic, self._hear)
        each = max(1, min(AT_ONCE, (end - first) // (4 * threads)))
        pending: dict[Any, Range] = {}
        rows: dict[int, Row] = {}
        following = oldest = first
        answered = time.monotonic()  # time of the last contact with the scheduler
        while oldest < end:
            self._give_again(client, pending)
            while following < end and len(pending) < AHEAD * threads:
                self._give(client, pending, following, min(following + each, end))
                following = min(following + each, end)
            done = self._done(client, pending)
            if client.status == "running" or done:
                answered = time.monotonic()
            elif time.monotonic() - answered > GONE_S:
                raise SweepError(f"the scheduler at {self._address} is gone; {self._kept(oldest - first)}")
            for future in done:
                span = pending.pop(future)
                self._heard = time.monotonic()
                if future.status == "error" and span.end - span.first > 1:  # which run failed is unknown
                    for number in range(span.first, span.end):
                        self._give(client, pending, number, number + 1)
                    continue
                for row in self._rows(future, span):
                    rows[row["run"]] = row
            for row in self._give_up(client, pending):
                rows[row["run"]] = row
            if self._held and self._waits_in_vain(pending):
                raise SweepError(
                    f"no worker is free: runs that took longer than {self._timeout_s:g} s still hold "
                    f"{', '.join(sorted(self._held))}; {self._kept(oldest - first)}"
                )
            while (found := rows.pop(oldest, None)) is not None:
                oldest += 1
                self._made += 1
                take(found)

    @staticmethod
    def _kept(count: int) -> str:
        return f"{count} runs are kept, and the same command goes on with the others"

    def _give(self, client: Any, pending: dict[Any, Range], first: int, end: int) -> None:
        span = Range(first, end)
        token = next(self._tokens)
        self._given[token] = span
        arguments = (self._job, self._design, first, end, self._topic, token)
        # Dask takes workers whose run was cancelled for free, though it continues.
        where = {"workers": self._free, "allow_other_workers": True} if self._free else {}
        pending[client.submit(make, *arguments, pure=False, **where)] = span

    def _give_again(self, client: Any, pending: dict[Any, Range]) -> None:
        """Resubmits runs that a scheduler lost, once one answers again."""
        if client.status != "running":
            return
        lost = [future for future in pending if future.status in ("cancelled", "lost")]
        if lost:
            client.subscribe_topic(self._topic, self._hear)  # a restarted scheduler does not know the subscription
        for future in lost:
            span = pending.pop(future)
            self._give(client, pending, span.first, span.end)

    def _hear(self, event: tuple[float, tuple[int, int, str]]) -> None:
        """Records that a worker begins a run."""
        _, (token, number, worker) = event
        span = self._given.get(token)
        if span is not None:
            span.at, span.worker, span.since = number, worker, time.monotonic()
            self._heard = time.monotonic()

    def _give_up(self, client: Any, pending: dict[Any, Range]) -> Iterator[Row]:
        """Yields the rows of runs that take too long. The other runs of their ranges, and those that wait, are
        resubmitted."""
        now = time.monotonic()
        late = [
            future
            for future, span in pending.items()
            if future.status == "pending" and span.since is not None and now - span.since > self._timeout_s
        ]
        if not late or client.status != "running":
            return
        workers = client.scheduler_info(n_workers=-1)["workers"]
        for future in late:
            span = pending[future]
            if future.status != "pending":
                continue
            if span.worker not in workers:  # it has ended; Dask reassigns the range
                span.since = None
                continue
            del pending[future]
            future.cancel()
            yield self._failed(span.at, f"it took longer than {self._timeout_s:g} s")
            for first, end in ((span.first, span.at), (span.at + 1, span.end)):
                if first < end:
                    self._give(client, pending, first, end)
            self._held.add(span.worker)
            self._heard = time.monotonic()
        self._free = [worker for worker in workers if worker not in self._held]
        for future in [future for future, span in pending.items() if future.status == "pending" and span.since is None]:
            span = pending.pop(future)
            future.cancel()
            self._give(client, pending, span.first, span.end)

    def _waits_in_vain(self, pending: dict[Any, Range]) -> bool:
        """Returns whether no run is in progress, and none has begun or ended for a long time."""
        idle = all(future.status == "pending" and span.since is None for future, span in pending.items())
        return idle and time.monotonic() - self._heard > max(GONE_S, self._timeout_s)

    def _done(self, client: Any, pending: dict[Any, Range]) -> list[Any]:
        # Without a scheduler all futures are cancelled at once, and a wait for them raises.
        open_ = [future for future in pending if future.status not in ("cancelled", "lost")]
        if not open_:
            time.sleep(LOOK_S)
            return []
        try:
            ended = self._dask.wait(open_, timeout=LOOK_S, return_when="FIRST_COMPLETED").done
        except (self._dask.TimeoutError, TimeoutError):
            return []
        except (OSError, CancelledError):
            time.sleep(LOOK_S)
            return []
        return [future for future in ended if future.status in ("finished", "error")]

    def _rows(self, future: Any, span: Range) -> list[Row]:
        """Returns the rows of a finished range of runs."""
        if future.status == "finished":
            found: list[Row] = future.result()
            return found
        error = future.exception()
        why = (
            "its worker ended again and again"
            if type(error).__name__ == "KilledWorker"
            else f"{type(error).__name__}: {_line(error)}"
        )
        return [self._failed(number, why) for number in range(span.first, span.end)]

    def _failed(self, number: int, why: str) -> Row:
        return self._job.row(number, self._design.point(number), f"no result: {why}", {}, {})

    def _check(self, client: Any) -> int:
        """Returns the number of threads of all workers. Raises SweepError if there are none, or one has another version
        of takt."""
        workers = client.scheduler_info(n_workers=-1)["workers"]
        if not workers:
            raise SweepError(f"the scheduler at {self._address} has no workers: dask worker {self._address}")
        try:
            found = client.run(version)
        except Exception as error:
            raise SweepError(f"the workers of {self._address} cannot run takt: {_line(error)}") from None
        for worker, said in found.items():
            if said != takt.__version__:
                raise SweepError(
                    f"worker {worker} has takt {said}, this is {takt.__version__}: rows would not be the same"
                )
        return sum(worker["nthreads"] for worker in workers.values())


@contextmanager
def _quiet() -> Iterator[None]:
    """Suppresses Dask's log of lost connections, with its traces: a sweep reports them in a sentence."""
    loggers = [logging.getLogger(name) for name in ("distributed.client", "distributed.core", "distributed.comm")]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)


def _line(error: object) -> str:
    return " ".join(str(error).split())[:300]
