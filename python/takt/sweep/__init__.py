"""Sweeps: a scenario run by the thousand, with other values of its parameters and of the machine file each time.

    sweep("scenario.py", grid=["velocity=100:500:9"], sample=["axes.x.limits.jerk=uniform:1e4:1e5:100"])

Runs go to worker processes that are started once; rows stand in the order of the runs in one table, whoever ran them,
and a sweep that was interrupted goes on where it was. `takt sweep` is the same on the command line.
"""

from takt.sweep.design import Design, SweepError
from takt.sweep.sweeping import Result, sweep

__all__ = ["Design", "Result", "SweepError", "sweep"]
