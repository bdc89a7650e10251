"""Draws the picture of docs/movers.md: movers that change their order on a ring with two stations, as planned. To be
called when planning or the picture change.

Usage: build/venv/bin/python tools/routing_picture.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import takt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from takt import plot, style
from takt.track_layout import TrackLayout

PICTURE = Path(__file__).resolve().parent.parent / "docs" / "images" / "routing.png"
TRACKS = """\
tracks:
  - name: west
    elements: [{from: {x: 1500, y: 1500}, to: {x: 500, y: 1500}}, {from: {x: 500, y: 0}, to: {x: 1500, y: 0}}]
  - {name: south, starts_from: [west], elements: [{from: {x: 1500, y: 0}, to: {x: 3500, y: 0}}]}
  - name: east
    starts_from: [south]
    elements: [{from: {x: 3500, y: 0}, to: {x: 4500, y: 0}}, {from: {x: 4500, y: 1500}, to: {x: 3500, y: 1500}}]
  - name: south_siding
    starts_from: [west]
    elements: [{from: {x: 2200, y: -700}, to: {x: 2800, y: -700}}]
    ends_at: [east]
  - {name: north, starts_from: [east], elements: [{from: {x: 3500, y: 1500}, to: {x: 1500, y: 1500}}], ends_at: [west]}
  - name: north_siding
    starts_from: [east]
    elements: [{from: {x: 2800, y: 2200}, to: {x: 2200, y: 2200}}]
    ends_at: [west]
"""
PLACES = {"west": (1900.0, 1500.0, 1100.0), "east": (1800.0, 1400.0, 1000.0)}
ORDER = (2, 0, 1)


def run() -> tuple[takt.Recording, TrackLayout, list[str]]:
    layout = TrackLayout(TRACKS)
    tracks = {track.name: track for track in layout.tracks}
    text, targets = "name: stations\naxes: []\nmovers:\n", {}
    for name, places in PLACES.items():
        p = tracks[name].points
        for k, s in enumerate(places):
            x, y = np.interp(s, p.s, p.x), np.interp(s, p.s, p.y)
            text += f"  - {{name: {name[0]}{k + 1}, initial: {{x: {x:.9f}, y: {y:.9f}}}}}\n"
            targets[f"{name[0]}{k + 1}"] = (name, places[ORDER[k]])
    engine = takt.Engine(text + TRACKS)
    for track in engine.tracks.values():
        track.enable()
    for feedback in [mover.enable() for mover in engine.movers.values()]:
        feedback.wait()
    for name, mover in engine.movers.items():
        mover.join_track(track="west" if name[0] == "w" else "east").wait()
    with engine.record(every=10) as recorder:
        engine.move_on_tracks(targets)
    return recorder.recording, layout, list(targets)


def draw(recording: takt.Recording, layout: TrackLayout, names: list[str]) -> None:
    figure = Figure(figsize=(plot.WIDTH_IN, 10.0), dpi=100, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    plan, ways = figure.subplots(2, 1, height_ratios=[1, 1])
    for ax in (plan, ways):
        plot.dress(ax)
    plan.set_aspect("equal")
    for track in layout.tracks:
        plan.plot(track.points.x, track.points.y, color=plot.FAINT, lw=1.2, zorder=1)
        middle = len(track.points.s) // 2
        plan.annotate(
            track.name,
            (track.points.x[middle], track.points.y[middle]),
            (0, 6),
            textcoords="offset points",
            color=plot.INK,
            ha="center",
        )
    # Round the ring; a siding counts as long as the track beside it.
    length = np.array([track.length for track in layout.tracks])
    west, south, east, south_siding, north, north_siding = length
    begins = np.array([0, west, west + south, west, west + south + east, west + south + east])
    shares = np.array([1, 1, 1, south / south_siding, 1, north / north_siding])
    ring = west + south + east + north
    for i, name in enumerate(names):
        table = recording[name]
        colour = style.PALETTE[i]
        x, y, time = table["x"], table["y"], table["time_s"] - table["time_s"][0]
        plan.plot(x[0], y[0], "o", mfc="white", mec=colour, mew=2, ms=11, zorder=3)
        plan.plot(x[-1], y[-1], "o", color=colour, ms=6, zorder=4)
        on, position = table["track"].astype(int) - 1, table["track_position"]
        way = begins[on] + position * shares[on]
        way[1:][np.diff(way) < -ring / 2] = np.nan
        aside = np.isin(on, (3, 5))
        ways.plot(time, np.where(aside, np.nan, way) / 1000, color=colour, lw=2.2, label=name)
        ways.plot(time, np.where(aside, way, np.nan) / 1000, color=colour, lw=1.2, ls=(0, (2, 1)))
    plan.set_xlabel("X [mm]: rings where they start, dots where they end", color=plot.INK, size=10.5)
    plan.set_ylabel("Y [mm]", color=plot.INK, size=10.5)
    ways.set_xlabel("s", color=plot.INK, size=10.5)
    ways.set_ylabel("round the ring [m], sidings dotted", color=plot.INK, size=10.5)
    ways.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    plot.save(figure, PICTURE)


if __name__ == "__main__":
    draw(*run())
