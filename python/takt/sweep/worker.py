"""A worker of a sweep: a process that makes runs as long as it is asked for some. Started by `pool`."""

from __future__ import annotations

import contextlib
import signal
import sys
from multiprocessing.connection import Connection

from takt.sweep.design import Design
from takt.sweep.runs import Job


def work(connection: Connection) -> None:
    """Takes what all runs have in common, then ranges of runs; sends each run's number and its row."""
    job: Job
    design: Design
    job, design = connection.recv()
    connection.send(("ready", None))
    while True:
        first, end = connection.recv()
        for number in range(first, end):
            connection.send((number, job.run(number, design.point(number))))


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the first one decides
    with contextlib.suppress(EOFError, BrokenPipeError, ConnectionResetError):  # the sweep has ended, or its process
        work(Connection(int(sys.argv[1])))
