"""Draws the picture of docs/movers.md: twenty movers, each with dynamics of its own, start, stop and start again behind
one another. To be called when following changes.

Usage: build/venv/bin/python tools/accordion_picture.py
"""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import takt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from takt import plot

PICTURE = Path(__file__).resolve().parent.parent / "docs" / "images" / "accordion.png"
MOVERS = 20
GAP = 150.0  # mm
LENGTH = 9000.0
STOP_S, GO_S, END_S = 3.0, 5.0, 7.5


def machine() -> str:
    chance = random.Random(5)
    line = f"{{from: {{x: 0, y: 0}}, to: {{x: {LENGTH}, y: 0}}}}"
    text = f"name: accordion\naxes: []\ntracks: [{{name: line, elements: [{line}]}}]\nmovers:\n"
    for i in range(MOVERS):
        dynamics = ", ".join(
            f"{name}: {between[0] if i == 0 else chance.uniform(*between):.0f}"
            for name, between in (("velocity", (500, 1500)), ("acceleration", (4e3, 12e3)), ("jerk", (8e4, 3e5)))
        )
        x = 100 + (GAP + 1) * (MOVERS - 1 - i)
        text += f"  - {{name: m{i + 1}, initial: {{x: {x}, y: 0}}, gap: {GAP}, xy: {{maximum: {{{dynamics}}}}}}}\n"
    return text


def run() -> takt.Recording:
    engine = takt.Engine(machine())
    engine.track("line").enable().wait()
    movers = list(engine.movers.values())
    for feedback in [mover.enable() for mover in movers]:
        feedback.wait()
    for feedback in [mover.join_track(track="line", use_orientation=False) for mover in movers]:
        feedback.wait()
    with engine.record() as recorder:
        for i, mover in enumerate(movers):
            mover.move_on_track(position=LENGTH - 100 - GAP * i)
        engine.run(STOP_S)
        movers[0].halt().wait()
        engine.run(GO_S - STOP_S)
        movers[0].move_on_track(position=LENGTH - 100)
        engine.run(END_S - GO_S)
    return recorder.recording


def draw(recording: takt.Recording) -> None:
    figure = Figure(figsize=(plot.WIDTH_IN, 11.0), dpi=plot.DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(4, 1, sharex=True)
    names = [f"m{i + 1}" for i in range(MOVERS)]
    time = recording.column(names[0], "time_s")
    time = time - time[0]
    period = float(np.median(np.diff(time)))

    def of(i: int, signal: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return recording.column(names[i], f"track_{signal}")

    def curve(title: str, i: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        if title.startswith("gap"):
            return of(i - 1, "position") - of(i, "position")
        if title.startswith("speed"):
            return of(i, "velocity")
        acceleration = of(i, "acceleration") / 1000
        return acceleration if title.startswith("acc") else np.diff(acceleration, prepend=0) / period

    titles = ("gap to the mover ahead, mm", "speed, mm/s", "acceleration, m/s²", "jerk, m/s³")
    for ax, title in zip(axes, titles, strict=True):
        plot.dress(ax)
        for i in range(1 if "gap" in title else 0, MOVERS):
            ax.plot(time, curve(title, i), lw=0.9, color=str(0.1 + 0.65 * i / MOVERS))
        ax.set_ylabel(title)
    axes[0].axhline(GAP, color="tab:red", lw=0.8)
    axes[-1].set_xlabel("s; the first mover, darkest, is the slowest; it is halted at 3 s and goes on at 5 s")
    figure.savefig(PICTURE)


if __name__ == "__main__":
    draw(run())
