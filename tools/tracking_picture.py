"""Draws the picture of docs/conveyors.md: how a tool gets onto a belt and off it, the example of the manual of
MC_TrackConveyorBelt. To be called when tracking or the picture change.

Usage: build/venv/bin/python tools/tracking_picture.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import takt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from takt import plot, style
from takt.recording import FloatArray

PICTURE = Path(__file__).resolve().parent.parent / "docs" / "images" / "tracking.png"
SPEED = 2.0  # mm/s
ORIGIN, START, END = -10.5, 9.0, 18.0  # mm
SYNC_IN, SYNC_OUT = 3.0, 3.0  # mm of the belt
MACHINE = """\
name: example
axes:
  - {name: x, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: y, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}}
  - {name: drive, limits: {velocity: 100, acceleration: 1000, jerk: 50000}}
groups:
  - name: portal
    axes: [x, y]
    kinematics: {gantry: {axes: [x, y]}}
    path: {velocity: 800, acceleration: 8000, jerk: 400000}
belts: [{name: infeed, axis: drive}]
"""
TOOL, BELT = style.PALETTE[0], style.PALETTE[1]


def run() -> tuple[takt.Recording, float]:
    """The example; and where the belt was when the object was seen."""
    with takt.Engine(MACHINE) as engine:
        portal, drive = engine.group("portal"), engine.axis("drive")
        portal.power().wait()
        portal.enable().wait()
        drive.power().wait()
        drive.move_velocity(velocity=SPEED).wait(until="reached")
        seen = drive.set_position
        with engine.record() as recorder:
            portal.track_conveyor_belt(
                belt="infeed",
                recorded_position=seen,
                origin_x=ORIGIN,
                start_distance=START,
                end_distance=END,
                sync_in_conveyor_distance=SYNC_IN,
                sync_in_tcp_distance=1.5,
                sync_out_conveyor_distance=SYNC_OUT,
            ).wait()
            engine.run(0.8)
        return recorder.recording, seen


def states(ax: Axes, travel: FloatArray, values: FloatArray, names: dict[int, str]) -> None:
    """What the group calls it, as coloured ground."""
    for first, last, value in plot.stretches(travel, values):
        if name := names[value].replace("_", " ") if value else "":
            ax.axvspan(first, last, color=style.state_colour(names[value], value), alpha=0.14, lw=0, zorder=0)
            ax.annotate(
                f"{value}: {name}",
                ((first + last) / 2, 1),
                xycoords=("data", "axes fraction"),
                xytext=(0, 5),
                textcoords="offset points",
                ha="center",
                size=10,
                color=plot.INK,
            )


def draw() -> Figure:
    """Places and speeds of tool and object over the travel of the belt."""
    recording, seen = run()
    group, belt = recording["portal"], recording["infeed"]
    travel = np.asarray(belt["position"] - seen)
    figure = Figure(figsize=(plot.WIDTH_IN, 6.4), dpi=plot.DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    place, speed = figure.subplots(2, sharex=True, height_ratios=(3, 2))
    for ax in (place, speed):
        plot.dress(ax)
        for mark in (START, START + SYNC_IN, END, END + SYNC_OUT):
            ax.axvline(mark, color=plot.FAINT, lw=0.7, zorder=1)
    names = recording.names("portal", "track_state")
    states(place, travel, group["track_state"], names)
    place.plot(travel, ORIGIN + travel, color=BELT, lw=1.4, ls=(0, (4, 2.2)), label="object")
    place.plot(travel, group["x"], color=TOOL, lw=2.0, label="tool")
    place.plot([START + SYNC_IN], [1.5], "o", color=TOOL, ms=5)
    place.annotate(
        "in step 12 mm behind the sensor,\nthe tool has come 1.5 mm",
        (START + SYNC_IN, 1.5),
        xytext=(14, -30),
        textcoords="offset points",
        size=10,
        color=plot.INK,
    )
    speed.plot(travel, belt["velocity"], color=BELT, lw=1.4, ls=(0, (4, 2.2)), label="belt")
    speed.plot(travel, group["velocity"], color=TOOL, lw=2.0, label="tool")
    place.set_ylabel("X [mm]", color=plot.INK, size=10.5)
    speed.set_ylabel("speed [mm/s]", color=plot.INK, size=10.5)
    speed.set_xlabel("travel of the belt since the object was seen [mm]", color=plot.INK, size=10.5)
    speed.set_xlim(travel[0], travel[-1])
    for ax, where in ((place, "upper left"), (speed, "center left")):
        ax.legend(loc=where, frameon=False, fontsize=10, labelcolor=plot.INK)
    return figure


if __name__ == "__main__":
    print(plot.save(draw(), PICTURE))
