"""A whole sweep: its runs, its table and its page."""

from __future__ import annotations

import importlib.util
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from takt.changes import changed
from takt.engine import read_machine
from takt.scenario import load_scenario, with_settings
from takt.sweep.cluster import Cluster
from takt.sweep.design import Design, SweepError
from takt.sweep.pool import Pool
from takt.sweep.runs import Job, Row, is_same
from takt.sweep.summary import Summary
from takt.sweep.table import ABOUT, Table, about, rows_of, to_parquet

FLUSH_S = 1.0
TIMEOUT_S = 600.0


@dataclass(frozen=True)
class Result:
    """The result of a sweep."""

    table: Path  # runs.csv
    page: Path  # sweep.html
    parquet: Path | None  # runs.parquet, where pyarrow is installed
    summary: Summary
    made: int  # runs of this call; the others existed before
    elapsed_s: float
    repeats: bool  # the first run of this call had the same row when it was repeated

    def __repr__(self) -> str:
        rest = self.summary.size - self.summary.runs
        more = f", {rest:,} not made yet" if rest else ""
        return f"<Result {self.table}: {self.summary.passed:,} passed, {self.summary.failed:,} failed{more}>"

    def _repr_html_(self) -> str:
        from takt.notebook import sweep_table

        return sweep_table(self)

    @property
    def done(self) -> bool:
        return self.summary.runs == self.summary.size


def sweep(
    scenario: str | os.PathLike[str],
    grid: Sequence[str] = (),
    sample: Sequence[str] = (),
    directory: str | os.PathLike[str] | None = None,
    *,
    machine: str | os.PathLike[str] | None = None,
    seed: int = 0,
    workers: int | None = None,
    scheduler: str | None = None,
    stop_after: int | None = None,
    timeout_s: float = TIMEOUT_S,
    fresh: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Result:
    """Runs a scenario at all points of a grid and of samples, in virtual time. Raises SweepError if the sweep cannot be
    made.

    grid: "velocity=100:500:9" or "mode=slow,fast"; sample: "mass=uniform:1:2:100". Keys are parameters of the scenario,
        or, with a dot, paths of the machine file.
    directory: of the table and the page [sweeps/SCENARIO]; an existing sweep is continued.
    workers: number of processes [number of processors].
    scheduler: address of a scheduler of Dask distributed, "tcp://host:8786", whose workers make the runs instead.
    stop_after: number of runs in this call; the next call continues. None: all.
    timeout_s: longest time [s] of a run by the clock of this host.
    fresh: starts over.
    progress: called with the finished share, 0 to 1, after each run.
    """
    from takt.sweep.page import write_page  # drawing takes long to import, and workers do not need it

    job = Job(str(scenario), str(machine or ""))
    design = Design.of(grid, sample, seed, load_scenario(scenario).texts)
    _check(job, design)
    if workers is not None and workers < 1:
        raise SweepError(f"at least one worker is needed, found {workers}")
    if workers is not None and scheduler is not None:
        raise SweepError("a scheduler has workers of its own: give one of both, --workers or --scheduler")
    pool: Pool | Cluster
    if scheduler is not None:
        pool = Cluster(job, design, scheduler, timeout_s)
    else:
        pool = Pool(job, design, workers or os.cpu_count() or 1, timeout_s)
    target = Path(directory) if directory is not None else Path("sweeps") / Path(scenario).stem
    table = Table(target, about(job, design), fresh)
    try:
        first, end = table.count, design.size
        if first > end:
            raise SweepError(f"{table.path}: holds {first} runs of {end}; --fresh begins again")
        if stop_after is not None:
            end = min(end, first + stop_after)
        begin = time.monotonic()
        repeats = _make(table, pool, first, end, job, progress)
        elapsed = time.monotonic() - begin
    finally:
        table.close()
    summary = Summary.of(rows_of(table.path), design)
    arrow = importlib.util.find_spec("pyarrow") is not None
    parquet = to_parquet(table.path, summary.texts) if arrow and summary.runs else None
    page = write_page(summary, target, load_scenario(scenario).title, target / ABOUT)
    return Result(table.path, page, parquet, summary, end - first, elapsed, repeats)


def _make(
    table: Table, pool: Pool | Cluster, first: int, end: int, job: Job, progress: Callable[[float], None] | None
) -> bool:
    flushed = time.monotonic()
    repeats = True

    def take(row: Row) -> None:
        nonlocal flushed, repeats
        if row["run"] == first and row["hash"]:
            again = job.run(first, {key: row[key] for key in pool.keys})
            repeats = is_same(again, row)
        table.append(row)
        if time.monotonic() - flushed > FLUSH_S:
            table.flush()
            flushed = time.monotonic()
        if progress is not None:
            progress((table.count - first) / (end - first))

    if end > first:
        pool.run(first, end, take)
    return repeats


def _check(job: Job, design: Design) -> None:
    """Refuses a design with which no run could be made, and values whose types do not match their parameters."""
    scenario = load_scenario(job.scenario)
    _, changes = with_settings(scenario, design.point(0))
    for key, value in design.kinds:
        with_settings(scenario, {key: value})
    text, file_name = read_machine(job.machine or scenario.machine)
    changed(text, file_name, changes)
