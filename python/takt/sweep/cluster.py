"""The runs of a sweep on a cluster: workers of Dask distributed, wherever a scheduler has them. The rows
are those that local processes make. Dask is an extra: pip install "takt-motion[cluster]"."""

from __future__ import annotations

import logging
import re
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from typing import Any

import takt
from takt.sweep.design import Design, SweepError
from takt.sweep.runs import Job, Row

AT_ONCE = 16  # runs that a worker is given, at most
AHEAD = 3  # ranges of runs that the scheduler has, for each thread of a worker
CONNECT_S = 10.0
LOOK_S = 1.0  # from one look at the scheduler to the next
GONE_S = 10.0  # without a scheduler, after which a sweep ends
ADDRESS = re.compile(r"[a-z][a-z0-9+]*://[^\s/]+(/\S*)?")
_alone = threading.Lock()


def make(job: Job, design: Design, first: int, end: int) -> list[Row]:
    """On a worker: the rows of some runs. Scenarios are modules, so one at a time in each process."""
    with _alone:
        return [job.run(number, design.point(number)) for number in range(first, end)]


def version() -> str:
    """On a worker: that of its takt."""
    return takt.__version__


class Cluster:
    """As `pool.Pool`, on the workers of a scheduler."""

    def __init__(self, job: Job, design: Design, address: str, timeout_s: float) -> None:
        self._job, self._design, self._address, self._timeout_s = job, design, address, timeout_s
        self._made = 0
        if not ADDRESS.fullmatch(address):  # Dask would take it for the name of a host, and look for it for long
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
        """What the runs vary."""
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
        each = max(1, min(AT_ONCE, (end - first) // (4 * threads)))
        pending: dict[Any, tuple[int, int]] = {}
        rows: dict[int, Row] = {}
        following = oldest = first
        heard = time.monotonic()
        while oldest < end:
            self._give_again(client, pending)
            while following < end and len(pending) < AHEAD * threads:
                span = (following, min(following + each, end))
                pending[client.submit(make, self._job, self._design, *span, pure=False)] = span
                following = span[1]
            done = self._done(client, pending)
            if done:
                heard = time.monotonic()
            elif client.status != "running" and time.monotonic() - heard > GONE_S:
                raise SweepError(
                    f"the scheduler at {self._address} is gone; {oldest - first} runs are kept, and the same command "
                    "goes on with the others"
                )
            elif time.monotonic() - heard > self._timeout_s * each:
                done = [min(pending, key=lambda future: pending[future])]
            for future in done:
                span = pending.pop(future)
                if future.status == "error" and span[1] - span[0] > 1:  # which of them it was is not known
                    for number in range(*span):
                        one = client.submit(make, self._job, self._design, number, number + 1, pure=False)
                        pending[one] = (number, number + 1)
                    continue
                for row in self._rows(future, span, time.monotonic() - heard > self._timeout_s * each):
                    rows[row["run"]] = row
            while (found := rows.pop(oldest, None)) is not None:
                oldest += 1
                self._made += 1
                take(found)

    def _give_again(self, client: Any, pending: dict[Any, tuple[int, int]]) -> None:
        """Runs that a scheduler took with it when it went away, once one answers again."""
        if client.status != "running":
            return
        for future in [future for future in pending if future.status in ("cancelled", "lost")]:
            span = pending.pop(future)
            pending[client.submit(make, self._job, self._design, *span, pure=False)] = span

    def _done(self, client: Any, pending: dict[Any, tuple[int, int]]) -> list[Any]:
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

    def _rows(self, future: Any, span: tuple[int, int], late: bool) -> list[Row]:
        """What became of a range of runs."""
        if late:
            future.cancel()
            return [self._failed(number, f"it took longer than {self._timeout_s:g} s") for number in range(*span)]
        if future.status == "finished":
            found: list[Row] = future.result()
            return found
        error = future.exception()
        why = (
            "its worker ended again and again"
            if type(error).__name__ == "KilledWorker"
            else f"{type(error).__name__}: {_line(error)}"
        )
        return [self._failed(number, why) for number in range(*span)]

    def _failed(self, number: int, why: str) -> Row:
        return self._job.row(number, self._design.point(number), f"no result: {why}", {}, {})

    def _check(self, client: Any) -> int:
        """Threads of all workers, which have to be there and to have this takt."""
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
    """What Dask logs of a connection that is lost, with where in its own code, a sweep says in a sentence."""
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
