"""Sweeps: a scenario run by the thousand, each time with other values of its parameters and of the machine file.

    sweep("scenario.py", grid=["velocity=100:500:9"], sample=["axes.x.limits.jerk=uniform:1e4:1e5:100"])

Worker processes, started once, make the runs; one table holds their rows in the order of the runs, whichever worker
made them, and an interrupted sweep can be continued. `takt sweep` is the same on the command line.
"""

from takt.sweep.design import Design, SweepError
from takt.sweep.sweeping import Result, sweep

__all__ = ["Design", "Result", "SweepError", "sweep"]
