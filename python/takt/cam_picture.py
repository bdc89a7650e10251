"""Pictures of cams: y, y', y'' and y''' over x."""

from __future__ import annotations

import math
import os
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from takt import plot, style
from takt.cam import Extreme, Table
from takt.cam_check import Limits, figure

EVENLY = 2000  # equidistant x, besides the joints
MOST_POINTS, MOST_SEGMENTS = 150, 40  # that can be distinguished in a picture
NAMES = (("y", "position"), ("y'", "velocity"), ("y''", "acceleration"), ("y'''", "jerk"))
POWERS = ("", "", "²", "³")


def picture(
    table: Table,
    path: str | os.PathLike[str],
    master_velocity: float | None = None,
    limits: Limits | None = None,
    title: str | None = None,
) -> Path:
    """Draws a cam as `draw` does and writes it to a file. Returns the path."""
    return plot.save(draw(table, master_velocity, limits, title), path)


def draw(
    table: Table, master_velocity: float | None = None, limits: Limits | None = None, title: str | None = None
) -> plot.Picture:
    """Returns a picture of y and its derivatives, one below the other, with extremes, points and segments.

    master_velocity: if given, the scales on the right are for the slave over time, and nearby limits are lines.
    limits: of the slave.
    title: None: the name of the cam.
    """
    x = _places(table)
    values, extremes = table.at(x), table.extremes()
    ends = [segment["to"]["x"] for segment in table.source["segments"]]
    points = table.points if len(table.points.x) <= MOST_POINTS else None
    drawing = plot.Picture(9.5, layout="constrained")
    lanes: list[Axes] = list(drawing.subplots(4, 1, sharex=True, height_ratios=[1.35, 1, 1, 1]))
    for power, (ax, bounds) in enumerate(zip(lanes, extremes, strict=True)):
        plot.dress(ax)
        ax.plot(x, values[power], color=style.PALETTE[power], lw=1.8, zorder=3)
        _frame(ax, [bounds.least.value, bounds.greatest.value], _limits_at(limits, power, master_velocity))
        for end in ends if len(ends) <= MOST_SEGMENTS else ():
            ax.axvline(end, color=plot.FAINT, lw=0.7, alpha=0.45, zorder=1)
        if bounds.greatest.value > bounds.least.value:
            scale = bounds.greatest.value - bounds.least.value
            _label(ax, bounds.greatest, scale, 1)
            _label(ax, bounds.least, scale, -1)
        symbol, name = NAMES[power]
        unit = f"{table.y_unit}/{table.x_unit}{POWERS[power]}" if power else table.y_unit
        ax.set_ylabel(f"{symbol}  {name}\n{unit}", color=plot.INK, size=10)
        if master_velocity and power:
            _for_slave(ax, table, power, master_velocity)
    if points:
        lanes[0].plot(points.x, points.y, "o", ms=4, color=plot.INK, zorder=4)
    _name_laws(lanes[0], table)
    lanes[-1].set_xlabel(f"x  master [{table.x_unit}]", color=plot.INK, size=10)
    drawing.align_ylabels(lanes)
    behind = f"   master at {master_velocity:g} {table.x_unit}/s" if master_velocity else ""
    drawing.suptitle((title or table.name) + behind, x=0.01, ha="left", color=plot.INK, weight="bold", size=14)
    return drawing


def _places(table: Table) -> Any:
    """Returns equidistant x and both sides of every joint."""
    joints = table.joints
    evenly = np.linspace(table.begin, table.end, EVENLY)
    return np.unique(np.concatenate([evenly, joints, np.nextafter(joints[1:], -math.inf)]))


def _limits_at(limits: Limits | None, power: int, master_velocity: float | None) -> list[float]:
    """Returns the limits of a derivative on the scale of the left side."""
    if limits is None:
        return []
    if power == 0:
        return [one for one in (limits.lower, limits.upper) if one is not None]
    limit = (limits.velocity, limits.acceleration, limits.jerk)[power - 1]
    if limit is None or not master_velocity:
        return []
    return [limit / master_velocity**power, -limit / master_velocity**power]


def _frame(ax: Axes, values: list[float], limits: list[float]) -> None:
    """Scales the axis for the curve and for limits that are near enough not to flatten it."""
    low, high = min(values), max(values)
    reach = max(high - low, 1e-9 * max(abs(low), abs(high)), 1e-300)
    near = [one for one in limits if low - 0.6 * reach <= one <= high + 0.6 * reach]
    for one in near:
        ax.axhline(one, color=style.BAD, lw=1.2, ls=(0, (5, 2)), zorder=2)
    low, high = min([low, *near]), max([high, *near])
    room = 0.2 * (high - low) or max(abs(high), 1.0)
    ax.set_ylim(low - room, high + room)


def _label(ax: Axes, extreme: Extreme, scale: float, side: int) -> None:
    ax.plot(extreme.x, extreme.value, ".", ms=8, color=plot.INK, zorder=4)
    low, high = ax.get_xlim()
    share = (extreme.x - low) / (high - low)
    ax.annotate(
        f"{figure(extreme.value, scale, 5)} at {figure(extreme.x, digits=5)}",
        (extreme.x, extreme.value),
        xytext=(0, 6 * side),
        textcoords="offset points",
        ha="left" if share < 0.1 else "right" if share > 0.9 else "center",
        va="bottom" if side > 0 else "top",
        size=8.5,
        color=plot.INK,
        bbox={"facecolor": "white", "alpha": 0.75, "linewidth": 0, "pad": 0.8},
        zorder=5,
    )


def _for_slave(ax: Axes, table: Table, power: int, master_velocity: float) -> None:
    factor = master_velocity**power

    def to_slave(value: Any) -> Any:
        return value * factor

    def back(value: Any) -> Any:
        return value / factor

    right = ax.secondary_yaxis("right", functions=(to_slave, back))
    right.set_ylabel(f"{table.y_unit}/s{POWERS[power]}", color=plot.INK, size=10)
    right.tick_params(colors=plot.FAINT, labelcolor=plot.INK, labelsize=9.5, length=3)
    right.spines["right"].set_color("#c5cad2")


def _name_laws(ax: Axes, table: Table) -> None:
    """Writes the names of the laws above the picture, where a segment is wide enough."""
    segments = table.source["segments"]
    ends = [table.begin, *(segment["to"]["x"] for segment in segments)]
    for (begin, end), segment in zip(pairwise(ends), segments, strict=True):
        name = segment["law"].replace("_", " ")
        if (end - begin) / (table.end - table.begin) > 0.0075 * len(name):
            middle, transform = (begin + end) / 2, ax.get_xaxis_transform()
            ax.text(middle, 1.02, name, transform=transform, ha="center", size=9, color=plot.FAINT)
