"""Draws the picture of docs/surface.md: movers that cross a surface with a hole, as they were carried out. To be called
when planning or the picture change.

Usage: build/venv/bin/python tools/surface_picture.py
"""

from __future__ import annotations

from pathlib import Path

import takt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from takt import plot, style

PICTURE = Path(__file__).resolve().parent.parent / "docs" / "images" / "surface.png"
HOLES = {(1, 1), (2, 1)}  # stators that are missing
WIDTH, HEIGHT = 4, 3
STARTS = ((0, 0), (0, 2), (0, 4), (7, 1), (7, 3), (7, 5))
TARGETS = ((7, 5), (7, 3), (7, 0), (0, 5), (0, 2), (0, 0))


def at(cell: tuple[int, int]) -> tuple[float, float]:
    return 120 * cell[0] + 60, 120 * cell[1] + 60


def run() -> tuple[takt.Recording, takt.SurfacePlan]:
    text = "name: surface\naxes: []\nmovers:\n"
    for i, cell in enumerate(STARTS):
        x, y = at(cell)
        text += f"  - {{name: m{i + 1}, initial: {{x: {x}, y: {y}}}}}\n"
    stators = [(x, y) for x in range(WIDTH) for y in range(HEIGHT) if (x, y) not in HOLES]
    floor = ", ".join(f"{{x: {240 * x}, y: {240 * y}}}" for x, y in stators)
    engine = takt.Engine(f"{text}environments: [{{name: floor, stators: [{floor}]}}]\n")
    for feedback in [mover.enable() for mover in engine.movers.values()]:
        feedback.wait()
    plan = takt.plan_surface(engine, {f"m{i + 1}": at(cell) for i, cell in enumerate(TARGETS)})
    with engine.record() as recorder:
        takt.SurfaceJourney(engine, plan).wait()
    return recorder.recording, plan


def draw(recording: takt.Recording, plan: takt.SurfacePlan) -> None:
    figure = Figure(figsize=(plot.WIDTH_IN, 10.5), dpi=100, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    above, speeds = figure.subplots(2, 1, height_ratios=[1.5, 1])
    for ax in (above, speeds):
        plot.dress(ax)
    above.set_aspect("equal")
    above.grid(False)
    raster = plan.raster
    for place, free in enumerate(raster.free):
        middle = raster.middle(place)
        corner = (middle[0] - raster.pitch / 2, middle[1] - raster.pitch / 2)
        face = "white" if free else plot.FAINT
        above.add_patch(Rectangle(corner, raster.pitch, raster.pitch, fc=face, ec=plot.FAINT, lw=0.8, zorder=0))
    for i, name in enumerate(plan.names):
        table, colour = recording[name], style.PALETTE[i]
        x, y, time = table["x"], table["y"], table["time_s"] - table["time_s"][0]
        shift = 7.0 * (i - 2.5)  # so that routes in one lane are seen
        above.plot(x + shift, y + shift, color=colour, lw=1.8, zorder=2)
        above.plot(x[0] + shift, y[0] + shift, "o", mfc="white", mec=colour, mew=2, ms=11, zorder=3)
        above.plot(x[-1] + shift, y[-1] + shift, "o", color=colour, ms=7, zorder=4)
        speed = (table["velocity_x"] ** 2 + table["velocity_y"] ** 2) ** 0.5
        speeds.plot(time, speed / 1000 + 2.2 * (len(plan.names) - 1 - i), color=colour, lw=1.6, label=name)
        speeds.axvline(plan.arrival_s[name], color=colour, lw=1, ls=(0, (2, 2)))
    above.set_xlabel("X [mm]: rings where they start, dots where they end; grey: no stator", color=plot.INK, size=10.5)
    above.set_ylabel("Y [mm]", color=plot.INK, size=10.5)
    speeds.set_xlabel("s; dotted: planned arrivals", color=plot.INK, size=10.5)
    speeds.set_ylabel("speed [m/s], one above the other", color=plot.INK, size=10.5)
    speeds.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    plot.save(figure, PICTURE)


if __name__ == "__main__":
    draw(*run())
