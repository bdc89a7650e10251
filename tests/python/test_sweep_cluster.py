"""PY-24: sweeps on a cluster of Dask distributed: the rows of local processes, gone on with, and what is not there."""

from __future__ import annotations

import contextlib
import csv
import os
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import CancelledError
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import takt
from takt.sweep import SweepError, sweep

MACHINE = """name: press
axes:
  - {name: ram, unit: mm, limits: {velocity: 400, acceleration: 8000, jerk: 800000}}
"""
SCENARIO = '''"""The ram goes down."""
import os, signal
from takt import expect
def scenario(session, velocity=100.0, dies=0):
    ram = session.axis("ram")
    ram.power().wait()
    ram.move_absolute(position=10, velocity=velocity).wait()
    if dies:
        os.kill(os.getpid(), signal.SIGKILL)
def verify(recording):
    expect.within_limits(recording, "ram")
'''


def rows(table: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(table.open(encoding="utf-8")))


def test_on_two_workers_of_a_cluster(tmp_path: Path) -> None:
    """The same rows as from one process here, in two parts."""
    distributed = pytest.importorskip("distributed")
    file = tmp_path / "press.py"
    file.write_text(SCENARIO)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    grid = ["velocity=50:300:12"]
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path / "dask")
    ) as cluster:
        there = tmp_path / "there"
        first = sweep(file, grid, directory=there, scheduler=cluster.scheduler_address, stop_after=5)
        assert (first.made, first.done) == (5, False)
        result = sweep(file, grid, directory=there, scheduler=cluster.scheduler_address)
        assert (result.made, result.done, result.repeats) == (7, True, True)
    here = sweep(file, grid, directory=tmp_path / "here", workers=1)
    assert rows(result.table) == rows(here.table)
    assert all(row["passed"] == "1" for row in rows(result.table))
    with pytest.raises(SweepError, match="--workers or --scheduler"):
        sweep(file, grid, directory=tmp_path / "x", workers=1, scheduler="tcp://127.0.0.1:1")


@pytest.mark.skipif(not os.environ.get("TAKT_LONG"), reason="workers are started again and again: TAKT_LONG=1")
def test_runs_in_which_workers_die(tmp_path: Path) -> None:
    """They have the reason in their rows; the others are made."""
    distributed = pytest.importorskip("distributed")
    file = tmp_path / "press.py"
    file.write_text(SCENARIO)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    import dask

    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path / "dask")
        ) as cluster,
    ):
        grid = ["velocity=50,300", "dies=0,1"]
        result = sweep(file, grid, directory=tmp_path / "there", scheduler=cluster.scheduler_address)
    for row in rows(result.table):
        assert row["passed"] == str(1 - int(row["dies"])), row
        assert ("no result: its worker ended again and again" in row["failed"]) == (row["dies"] == "1")


HANGS = (
    SCENARIO.replace("velocity=100.0, dies=0", "number=0, hangs=0, hangs_s=0.0, velocity=100.0, dies=0")
    .replace("import os, signal", "import os, signal, time")
    .replace("    ram = session", "    if number == hangs:\n        time.sleep(hangs_s)\n    ram = session")
)


def test_runs_that_take_too_long(tmp_path: Path) -> None:
    """PY-24: only they are given up, not others of their range or behind them, which another worker makes."""
    distributed = pytest.importorskip("distributed")
    file = tmp_path / "press.py"
    file.write_text(HANGS)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    grid = ["number=" + ",".join(map(str, range(16))), "hangs=4", "hangs_s=60"]
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path / "dask")
    ) as cluster:
        there = sweep(file, grid, directory=tmp_path / "there", scheduler=cluster.scheduler_address, timeout_s=6.0)
    found = rows(there.table)
    assert [row["passed"] for row in found] == [*["1"] * 4, "0", *["1"] * 11]
    assert found[4]["failed"] == "no result: it took longer than 6 s"


@pytest.mark.parametrize("ends", [True, False])
def test_a_run_that_holds_the_only_worker(ends: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """PY-24: no run is given up that waits behind one; where that one does not end, a sentence says so."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr("takt.sweep.cluster.GONE_S", 60.0 if ends else 0.1)
    file = tmp_path / "press.py"
    file.write_text(HANGS)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    grid = ["number=0,1,2,3", f"hangs_s={6 if ends else 8}"]
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        call = lambda: sweep(file, grid, directory=tmp_path / "x", scheduler=cluster.scheduler_address, timeout_s=2)  # noqa: E731
        if ends:
            assert [row["passed"] for row in rows(call().table)] == ["0", "1", "1", "1"]
        else:
            with pytest.raises(
                SweepError, match=r"no worker is free: runs that took longer than 2 s still hold inproc.*1 runs"
            ):
                call()


def test_schedulers_that_do_not_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("takt.sweep.cluster.CONNECT_S", 0.3)
    file = tmp_path / "press.py"
    file.write_text(SCENARIO)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    for address in ("nonsense", "", "host:8786", "tcp://", "tcp://a b:1"):
        with pytest.raises(SweepError, match=f"expected the address of a scheduler .*, found '{address}'"):
            sweep(file, ["velocity=50:300:3"], directory=tmp_path / "x", scheduler=address)
    for address in ("tcp://127.0.0.1:1", "nonsense://x"):
        with pytest.raises(SweepError, match="no scheduler of Dask answers at " + address):
            sweep(file, ["velocity=50:300:3"], directory=tmp_path / "x", scheduler=address)


class Vanishing:
    """A client of Dask whose scheduler has gone: all that it was given is cancelled."""

    class Future:
        status = "pending"
        result: Any = None

    def __init__(self, comes_back: bool) -> None:
        self.status, self.comes_back = "running", comes_back
        self.given: list[Vanishing.Future] = []

    def __call__(self, *_: object, **__: object) -> Vanishing:
        return self

    def as_current(self) -> contextlib.nullcontext[None]:
        return contextlib.nullcontext()

    def scheduler_info(self, n_workers: int) -> dict[str, dict[str, dict[str, int]]]:
        return {"workers": {"one": {"nthreads": 1}}}

    def run(self, _: object) -> dict[str, str]:
        return {"one": takt.__version__}

    def subscribe_topic(self, topic: str, handler: Callable[..., object]) -> None:
        pass

    def get_worker(self) -> SimpleNamespace:
        return SimpleNamespace(address="one", log_event=lambda topic, message: None)

    def submit(self, make: Callable[..., object], *arguments: object, pure: bool) -> Future:
        future = self.Future()
        if len(self.given) < 3:  # those of the beginning
            self.given.append(future)
        else:
            future.status, future.result = "finished", lambda: make(*arguments)
        return future

    def wait(self, futures: list[Future], timeout: float, return_when: str) -> SimpleNamespace:
        done = [future for future in futures if future.status == "finished"]
        if not done:
            for future in self.given:
                future.status = "cancelled"
            self.status = "running" if self.comes_back else "connecting"
            raise CancelledError("Reasons: scheduler-connection-lost")
        return SimpleNamespace(done=done)

    def close(self, timeout: float) -> None:
        pass


@pytest.mark.parametrize("comes_back", [False, True])
def test_a_scheduler_that_goes_away(comes_back: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is said in a sentence; where it comes back the runs that went with it are given again."""
    monkeypatch.setattr("takt.sweep.cluster.GONE_S", 0.2)
    monkeypatch.setattr("takt.sweep.cluster.LOOK_S", 0.02)
    client = Vanishing(comes_back)
    dask = SimpleNamespace(Client=client, wait=client.wait, TimeoutError=TimeoutError, get_worker=client.get_worker)
    monkeypatch.setitem(sys.modules, "distributed", dask)
    file = tmp_path / "press.py"
    file.write_text(SCENARIO)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    call = lambda: sweep(file, ["velocity=50:300:9"], directory=tmp_path / "x", scheduler="tcp://x:1")  # noqa: E731
    if comes_back:
        assert [row["run"] for row in rows(call().table)] == [str(run) for run in range(9)]
    else:
        with pytest.raises(SweepError, match="the scheduler at tcp://x:1 is gone; 0 runs are kept"):
            call()


def test_without_dask(tmp_path: Path) -> None:
    file = tmp_path / "press.py"
    file.write_text(SCENARIO)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    program = f"""
import sys
sys.modules["distributed"] = None
from takt.cli import main
sys.exit(main(["sweep", {str(file)!r}, "--grid", "velocity=50:300:3", "--scheduler", "tcp://127.0.0.1:1"]))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode != 0
    assert (
        'needs Dask distributed, which is not installed: pip install "takt-motion[cluster]"'
        in done.stdout + done.stderr
    )
    assert not (tmp_path / "sweeps").exists()
