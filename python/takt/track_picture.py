"""Pictures of tracks: a top view with directions of travel and switches; below, the curvature over the arc length."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from takt import plot, style
from takt.counted import counted
from takt.track_layout import LaidTrack, TrackLayout

ARROW_EVERY = 0.08  # of the larger side of the picture
MARK: dict[str, Any] = {"ms": 7, "mfc": "white", "mew": 1.6, "zorder": 5}


def picture(layout: TrackLayout, target: str | os.PathLike[str], title: str = "") -> Path:
    """Draws all tracks, transitions thinner than given elements, and writes the picture. Returns its path."""
    tracks = [track for track in layout.tracks if track.length > 0]
    figure = Figure(figsize=(plot.WIDTH_IN, 12.0), dpi=plot.DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    plan, bends = figure.subplots(2, 1, height_ratios=[3, 1])
    total = sum(track.length for track in tracks)
    plan.set_title(
        f"{title}   {counted(len(tracks), 'track')}, {total:.6g} mm", loc="left", color=plot.INK, weight="bold", size=13
    )
    for ax in (plan, bends):
        plot.dress(ax)
    plan.set_aspect("equal")
    plan.set_xlabel("X [mm]", color=plot.INK, size=10.5)
    plan.set_ylabel("Y [mm]", color=plot.INK, size=10.5)
    plan.margins(0.05)
    bends.set_xlabel("along the track [mm]", color=plot.INK, size=10.5)
    bends.set_ylabel("curvature [1/m], left above", color=plot.INK, size=10.5)
    size = max((max(np.ptp(t.points.x), np.ptp(t.points.y)) for t in tracks), default=1.0)
    for i, track in enumerate(tracks):
        colour = style.PALETTE[i % len(style.PALETTE)]
        _draw(plan, track, colour, ARROW_EVERY * max(size, 1.0))
        bends.plot(track.points.s, 1000 * track.points.curvature, color=colour, lw=1.4, label=track.name)
    _mark_ends(plan, tracks)
    if tracks:
        bends.legend(loc="upper right", frameon=False, ncols=min(len(tracks), 8))
    return plot.save(figure, target)


def _draw(ax: Axes, track: LaidTrack, colour: str, every: float) -> None:
    points = track.points
    ax.plot(points.x, points.y, color=colour, lw=1.2, zorder=2)
    ax.plot(np.where(points.given, points.x, np.nan), points.y, color=colour, lw=2.6, zorder=3)
    count = max(1, round(track.length / every))
    for s in track.length * (np.arange(count) + 0.5) / count:
        x, y = np.interp(s, points.s, points.x), np.interp(s, points.s, points.y)
        angle = np.deg2rad(np.interp(s, points.s, points.direction))
        ax.annotate(
            "",
            (x + np.cos(angle) * every / 100, y + np.sin(angle) * every / 100),
            (x, y),
            arrowprops={"arrowstyle": "-|>", "color": colour, "mutation_scale": 14},
            zorder=4,
        )
    middle = len(points.s) // 2
    ax.annotate(
        track.name, (points.x[middle], points.y[middle]), (8, 8), textcoords="offset points", color=colour, size=10.5
    )


def _mark_ends(ax: Axes, tracks: list[LaidTrack]) -> None:
    """Marks open ends by rings, and switches, where more than two tracks meet, by squares."""
    for track in tracks:
        if track.closed:
            continue
        beside = {name for other in track.subsequent for t in tracks if t.name == other for name in t.previous}
        for i, others in ((0, len(track.previous)), (-1, len(track.subsequent) + len(beside - {track.name}))):
            x, y = track.points.x[i], track.points.y[i]
            if others == 0:
                ax.plot(x, y, "o", mec=plot.FAINT, **MARK)
            elif others > 1:
                ax.plot(x, y, "s", mec=plot.INK, **MARK)
