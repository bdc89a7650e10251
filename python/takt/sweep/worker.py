"""A worker of a sweep: a process that makes runs as long as they are requested. Started by `pool`."""

from __future__ import annotations

import contextlib
import signal
import sys
from multiprocessing.connection import Connection

from takt.sweep.design import Design
from takt.sweep.runs import Job


def work(connection: Connection) -> None:
    """Receives the common data of all runs, then ranges of runs; sends the number and the row of each run."""
    job: Job
    design: Design
    job, design = connection.recv()
    connection.send(("ready", None))
    while True:
        first, end = connection.recv()
        for number in range(first, end):
            connection.send((number, job.run(number, design.point(number))))


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the main process decides
    with contextlib.suppress(EOFError, BrokenPipeError, ConnectionResetError):  # the sweep has ended, or its process
        work(Connection(int(sys.argv[1])))
