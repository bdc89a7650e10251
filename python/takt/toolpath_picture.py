"""Pictures of tool paths, and of how a group followed one."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from takt import plot, style
from takt.counted import counted
from takt.recording import Recording
from takt.toolpath import Array, Toolpath

STEP = 0.2  # mm between points of a curve
COMMANDED, ACTUAL = style.PALETTE[0], style.PALETTE[1]


def picture(path: Toolpath, target: str | os.PathLike[str], title: str = "") -> Path:
    """Draws a path as `draw` does and writes it to a file. Returns the path of the file."""
    return plot.save(draw(path, title), target)


def draw(path: Toolpath, title: str = "") -> plot.Picture:
    """Returns a picture of a path in top view; thin where the tool moves at the velocity of the command."""
    low, high = path.extents
    width, depth = (max(float(one), 1e-3) for one in (high - low)[:2])
    tall = min(max(plot.WIDTH_IN * depth / width, 4.0), plot.WIDTH_IN)
    figure = plot.Picture(tall, layout="constrained")
    ax = figure.add_subplot()
    plan(ax, path)
    span = f"{counted(len(path.elements), 'element')}, {path.length:.6g} mm, Z {low[2]:.6g} to {high[2]:.6g} mm"
    ax.set_title(f"{title}   {span}", loc="left", color=plot.INK, weight="bold", size=13)
    return figure


def plan(ax: Axes, path: Toolpath) -> None:
    """Draws the path in X and Y, on equal scales."""
    plot.dress(ax)
    ax.set_aspect("equal")
    ax.set_xlabel("X [mm]", color=plot.INK, size=10.5)
    ax.set_ylabel("Y [mm]", color=plot.INK, size=10.5)
    ax.margins(0.03)
    for quick, (first, last) in _stretches(path):
        part = Toolpath(path.elements[first - 1].end if first else path.start, path.elements[first:last])
        points, _ = part.points(STEP)
        look: dict[str, Any] = (
            {"color": plot.FAINT, "lw": 0.7, "ls": (0, (4, 3))} if quick else {"color": plot.INK, "lw": 1.0}
        )
        ax.plot(points[:, 0], points[:, 1], zorder=2, **look)


def _stretches(path: Toolpath) -> Sequence[tuple[bool, tuple[int, int]]]:
    """Returns runs of elements without (True) or with (False) velocities of their own, as ranges."""
    found, at = [], 0
    for quick, run in groupby(one.velocity is None for one in path.elements):
        count = len(list(run))
        found.append((quick, (at, at + count)))
        at += count
    return found


@dataclass(frozen=True)
class Followed:
    """How a group followed a path: set points and actual values, and their deviation from the path."""

    path: Toolpath
    time_s: Array
    commanded: Array  # (n, 3), mm
    actual: Array  # (n, 3), mm
    position: Array  # arc length [mm] of the set points
    deviation: Array  # mm, of the set points from the path
    actual_deviation: Array  # mm, of the actual positions from the path
    speed: Array  # mm/s, commanded
    actual_speed: Array  # mm/s

    @classmethod
    def of(cls, path: Toolpath, recording: Recording, group: str, begin_s: float, end_s: float) -> Followed:
        """From a recording, between two times [s]. The path is in the machine coordinate system."""
        table = recording.slice(begin_s, end_s)[group]

        def places(prefix: str) -> Array:
            return np.stack([table[prefix + axis] for axis in "xyz"], axis=1)

        commanded, actual = places(""), places("actual_")
        times = table["time_s"]
        along, measured = (path.follow(points, time_s=times) for points in (commanded, actual))
        return cls(
            path, times, commanded, actual, along.position, along.distance, measured.distance,
            table["velocity"], table["actual_velocity"],
        )  # fmt: skip


def followed_picture(
    followed: Followed, title: str, *, bound: float, detail: tuple[float, float, float] | None = None
) -> plot.Picture:
    """Returns a picture of the path with set points and actual positions in top view; below, over the arc length, the
    deviation from the path and the speed.

    bound: allowed deviation [mm].
    detail: X, Y and width [mm] of a magnified area; None: none.
    """
    figure = plot.Picture(11.0, layout="constrained")
    grid = figure.add_gridspec(3, 2, height_ratios=[2.7, 1, 1], width_ratios=[1.55, 1])
    places = [grid[0, 0], grid[0, 1]] if detail else [grid[0, :]]
    views = [figure.add_subplot(place) for place in places]
    # Motions between two lines are not part of the drawing.
    quick = np.array([one.velocity is None for one in followed.path.elements])
    which = np.searchsorted(followed.path.at, followed.position, "right") - 1
    lifted = quick[np.clip(which, 0, len(quick) - 1), np.newaxis]
    for ax in views:
        plan(ax, followed.path)
        for points, colour, width in ((followed.commanded, COMMANDED, 1.6), (followed.actual, ACTUAL, 1.0)):
            ax.plot(*np.where(lifted, np.nan, points)[:, :2].T, color=colour, lw=width, zorder=3)
    if detail:
        x, y, width = detail
        views[0].plot(x, y, "s", ms=9, mfc="none", mec=style.BAD, zorder=5)
        views[1].set(xlim=(x - width / 2, x + width / 2), ylim=(y - width / 2, y + width / 2))
        views[1].set_title("magnified", loc="left", color=style.BAD, size=10.5)
    deviations = figure.add_subplot(grid[1, :])
    speeds = figure.add_subplot(grid[2, :], sharex=deviations)
    for ax, name, unit, commanded, actual in (
        (deviations, "deviation from the path", "mm", followed.deviation, followed.actual_deviation),
        (speeds, "speed", "mm/s", followed.speed, followed.actual_speed),
    ):
        plot.dress(ax)
        ax.plot(followed.position, actual, color=ACTUAL, lw=0.8, zorder=2)
        ax.plot(followed.position, commanded, color=COMMANDED, lw=0.8, zorder=3)
        ax.set_ylabel(f"{name}\n[{unit}]", color=plot.INK, size=10.5)
        ax.set_ylim(bottom=0)
    deviations.axhline(bound, color=style.BAD, lw=1.2, ls=(0, (5, 2)), zorder=4)
    deviations.tick_params(labelbottom=False)
    speeds.set_xlabel("along the path [mm]", color=plot.INK, size=10.5)
    names = (("path", plot.INK, "-"), ("commanded", COMMANDED, "-"), ("actual", ACTUAL, "-"))
    handles = [Line2D([], [], color=colour, ls=line, label=name) for name, colour, line in names]
    handles.append(Line2D([], [], color=style.BAD, ls=(0, (5, 2)), label=f"allowed to what is commanded: {bound:g} mm"))
    figure.legend(handles=handles, loc="outside upper right", ncols=4, frameon=False, fontsize=10, labelcolor=plot.INK)
    figure.suptitle(title, x=0.01, ha="left", color=plot.INK, weight="bold", size=14)
    return figure
