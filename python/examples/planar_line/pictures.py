"""The report of the line: where movers waited, from above; pieces over time; stations and movers by what they do."""

from __future__ import annotations

import numpy as np
from judge import Array, Judgement
from line import STATIONS
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from takt import plot, style
from takt.recording import Recording
from takt.track_layout import LaidTrack, TrackLayout

BELOW = ("repair", "car")


def picture(recording: Recording, found: Judgement, machine: str) -> Figure:
    figure = Figure(figsize=(plot.WIDTH_IN, 10.0), dpi=plot.DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.add_gridspec(3, 1, height_ratios=[1.6, 1, 1])
    levels = rows[0].subgridspec(1, 2, width_ratios=[2.6, 1])
    layout = TrackLayout(machine)
    above = [track for track in layout.tracks if track.name != "repair"]
    below = [track for track in layout.tracks if track.name in BELOW]
    title = "above; dots: where movers waited, the larger the longer"
    _from_above(figure.add_subplot(levels[0]), title, found.waited_at[0], above)
    _from_above(figure.add_subplot(levels[1]), "below", found.waited_at[1], below)
    _pieces(figure.add_subplot(rows[1]), found)
    grid = rows[2].subgridspec(1, 2)
    _bars(figure.add_subplot(grid[0]), "share of the time a station works", found.busy)
    shares = {"go": found.going, "are worked on": found.worked_on}
    shares |= {f"wait: {name}": share for name, share in found.held_by.items()}
    _bars(figure.add_subplot(grid[1]), "what movers do with their time", shares)
    title = f"{len(found.movers)} movers, {found.pieces_a_minute:.0f} pieces a minute"
    figure.suptitle(title, x=0.01, ha="left", color=plot.INK, weight="bold", size=14)
    return figure


def _from_above(ax: Axes, name: str, waited_at: tuple[Array, Array], tracks: list[LaidTrack]) -> None:
    plot.dress(ax)
    ax.set_aspect("equal")
    for track in tracks:
        ax.plot(track.points.x, track.points.y, color=plot.FAINT, lw=1.2, zorder=1)
    x, y = waited_at
    cells, where = np.unique(np.round(np.stack([x, y]) / 50) * 50, axis=1, return_counts=True)
    most = max(1, int(where.max(initial=1)))
    ax.scatter(cells[0], cells[1], s=4 + 90 * where / most, color=style.PALETTE[1], alpha=0.55, lw=0, zorder=2)
    by_name = {track.name: track for track in tracks}
    for station in STATIONS:
        if station.track not in by_name:
            continue
        points = by_name[station.track].points
        at = (np.interp(station.position, points.s, points.x), np.interp(station.position, points.s, points.y))
        ax.plot(*at, marker="s", ms=9, color=style.PALETTE[0], zorder=3)
        ax.annotate(station.name, at, (0, 9), textcoords="offset points", ha="center", color=plot.INK)
    ax.set_title(name, loc="left")
    ax.set_xlabel("X, mm")
    ax.set_ylabel("Y, mm")


def _pieces(ax: Axes, found: Judgement) -> None:
    plot.dress(ax)
    times = np.array(found.pieces_s)
    window = min(30.0, found.seconds / 4)
    at = np.linspace(window, found.seconds, 300)
    rate = [60 / window * np.sum((times > t - window) & (times <= t)) for t in at]
    ax.plot(at, rate, color=style.PALETTE[0], lw=1.4)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("s")
    ax.set_ylabel(f"pieces a minute, over {window:.0f} s")


def _bars(ax: Axes, title: str, shares: dict[str, float]) -> None:
    plot.dress(ax)
    names = list(shares)[::-1]
    ax.barh(names, [100 * shares[name] for name in names], color=style.PALETTE[0], height=0.6)
    for row, name in enumerate(names):
        ax.annotate(
            f"{100 * shares[name]:.0f}", (100 * shares[name], row), (4, 0), textcoords="offset points", va="center"
        )
    ax.set_yticks(range(len(names)), names)
    ax.set_xlim(0, 110)
    ax.set_xlabel(f"{title}, %")
