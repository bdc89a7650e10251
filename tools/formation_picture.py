"""Draws the picture of docs/movers.md: four movers carry a plate, and turn it by 90° on their way. To be called when
formations change.

Usage: build/venv/bin/python tools/formation_picture.py
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import takt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from takt import plot

PICTURE = Path(__file__).resolve().parent.parent / "docs" / "images" / "formation.png"
SIDE = 113.0  # mm, of a mover
PLATE = 400.0
PLACES = {"star": (0, 0), "two": (240, 0), "three": (240, 240), "four": (0, 240)}
COLORS = {"star": "tab:red", "two": "tab:blue", "three": "tab:green", "four": "tab:purple"}
SPEED, ACCELERATION = 2.0, 10.0  # m/s, m/s²: what each of them can do
TURNING = "c: {maximum: {velocity: 360, acceleration: 3600, jerk: 72000}, lower: -100, upper: 100}"


def run() -> takt.Recording:
    text = "name: plate\naxes: []\nmovers:\n"
    for name, (x, y) in PLACES.items():
        text += f"  - {{name: {name}, initial: {{x: {x}, y: {y}}}, {TURNING}}}\n"
    engine = takt.Engine(text)
    for mover in engine.movers.values():
        mover.enable().wait()
    for name in list(PLACES)[1:]:
        engine.mover(name).join_formation(star="star").wait(until="reached")
    star = engine.mover("star")
    with engine.record() as recorder:
        star.move_to_position(x=1500, y=500, c=90, use_orientation=True).wait()
        star.move_to_position(x=2700, y=500).wait()
    return recorder.recording


def rectangle(middle: complex, side: float, c: float, **style: Any) -> Polygon:
    corners = middle + np.exp(1j * np.radians(c)) * side / 2 * np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j])
    return Polygon(np.column_stack([corners.real, corners.imag]), **style)


def draw(recording: takt.Recording) -> None:
    figure = Figure(figsize=(plot.WIDTH_IN, 8.5), dpi=plot.DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    above, speeds, accelerations = figure.subplots(3, 1, height_ratios=(2.2, 1, 1))
    time = recording.column("star", "time_s")
    time = time - time[0]
    at = {name: recording.column(name, "x") + 1j * recording.column(name, "y") for name in PLACES}
    c = recording.column("star", "c")
    middle = (at["star"] + at["three"]) / 2
    plot.dress(above)
    above.set_aspect("equal")
    above.set_xlim(-150, 2850)
    above.set_ylim(-150, 950)
    for moment in np.linspace(0, len(time) - 1, 10).astype(int):
        above.add_patch(rectangle(middle[moment], PLATE, c[moment], fill=False, edgecolor="0.6", lw=0.8))
    for name, color in COLORS.items():
        above.plot(at[name].real, at[name].imag, lw=0.9, color=color, label=name)
        for moment in (0, len(time) - 1):
            style = {"facecolor": color, "alpha": 0.25, "edgecolor": color}
            above.add_patch(rectangle(at[name][moment], SIDE, c[moment], **style))
        for ax, signal in ((speeds, "velocity"), (accelerations, "acceleration")):
            size = np.hypot(recording.column(name, f"{signal}_x"), recording.column(name, f"{signal}_y")) / 1000
            ax.plot(time, size, lw=0.9, color=color)
    for ax, limit, title in ((speeds, SPEED, "speed, m/s"), (accelerations, ACCELERATION, "acceleration, m/s²")):
        plot.dress(ax)
        ax.axhline(limit, color="0.3", lw=0.8, ls="--")
        ax.set_ylabel(title)
        ax.set_xlim(0, time[-1])
    above.set_xlabel("X, mm")
    above.set_ylabel("Y, mm")
    above.legend(loc="upper left", ncols=4, fontsize="small")
    accelerations.set_xlabel("s; dashed: what each of them can do")
    figure.savefig(PICTURE)


if __name__ == "__main__":
    draw(run())
