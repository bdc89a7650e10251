"""The report of the sorter: the floor from above with three ways and where movers stood, deliveries, times."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from judge import Judgement
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from sorter import LOADING, PITCH
from takt import plot, style

STATOR = 240.0
COLOURS = {"red": "#b3413a", "blue": "#3566a8"}


def picture(found: Judgement, machine: Mapping[str, Any]) -> Figure:
    figure = Figure(figsize=(plot.WIDTH_IN, 8.5), dpi=plot.DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    columns = figure.add_gridspec(1, 2, width_ratios=[1.35, 1])
    _from_above(figure.add_subplot(columns[0]), found, machine)
    beside = columns[1].subgridspec(2, 1)
    _deliveries(figure.add_subplot(beside[0]), found)
    _shares(figure.add_subplot(beside[1]), found)
    title = f"{len(found.movers)} movers, {found.products_a_minute:.0f} products a minute"
    figure.suptitle(title, x=0.01, ha="left", color=plot.INK, weight="bold", size=14)
    return figure


def _from_above(ax: Axes, found: Judgement, machine: Mapping[str, Any]) -> None:
    plot.dress(ax)
    ax.grid(False)
    ax.set_aspect("equal")
    for part in machine["parts"]:
        own = part["stators"] or [
            {"x": STATOR * i, "y": STATOR * k} for i in range(part["columns"]) for k in range(part["rows"])
        ]
        colour = COLOURS.get(part["name"], plot.FAINT)
        for number, place in enumerate(part["positions"]):
            for stator in own:
                corner = (stator["x"] + place["x"], stator["y"] + place["y"])
                dashed = "--" if number else "-"
                ax.add_patch(Rectangle(corner, STATOR, STATOR, fill=False, ec=colour, lw=0.8, ls=dashed, zorder=1))
            if part["name"] in COLOURS:
                middle = (place["x"] + STATOR, place["y"] + 2 * STATOR + 40)
                ax.annotate(f"{part['name']}{', away' if number else ''}", middle, ha="center", color=colour)
    for column, row in LOADING:
        ax.add_patch(Rectangle((PITCH * column + 6, PITCH * row + 6), 108, 108, color=plot.FAINT, zorder=0, lw=0))
    ax.annotate("loading", (-20, 480), ha="right", va="center", rotation=90, color=plot.INK)
    x, y = found.stood_at
    cells, often = np.unique(np.round((np.stack([x, y]) - 60) / PITCH) * PITCH + 60, axis=1, return_counts=True)
    most = max(1, int(often.max(initial=1)))
    ax.scatter(cells[0], cells[1], s=4 + 110 * often / most, color=style.PALETTE[1], alpha=0.45, lw=0, zorder=2)
    for number, (way_x, way_y) in enumerate(found.ways):
        rides = np.hypot(np.diff(way_x), np.diff(way_y)) > STATOR
        way_x = np.where(np.append(rides, False), np.nan, way_x)
        ax.plot(way_x, way_y, color=style.PALETTE[(2 * number) % len(style.PALETTE)], lw=1.0, alpha=0.8, zorder=3)
    ax.set_title("ways of three movers; dots: where movers stood", loc="left")
    ax.set_xlim(-160, 3480)
    ax.set_ylim(-60, 4000)
    ax.set_xlabel("X, mm")
    ax.set_ylabel("Y, mm")


def _deliveries(ax: Axes, found: Judgement) -> None:
    plot.dress(ax)
    for tray, times in found.delivered_s.items():
        at = np.concatenate([[0], times, [found.seconds]])
        counts = np.concatenate([np.arange(len(times) + 1), [len(times)]])
        ax.step(at, counts, where="post", color=COLOURS[tray], lw=1.6, label=tray)
    ax.legend(frameon=False, loc="upper left")
    ax.set_ylim(bottom=0)
    ax.set_xlabel("s")
    ax.set_ylabel("products taken away")


def _shares(ax: Axes, found: Judgement) -> None:
    plot.dress(ax)
    total = found.seconds * len(found.movers)
    shares = dict(found.shares)
    shares |= {f"held up by {name}": seconds / total for name, seconds in found.held_s.items()}
    names = list(shares)[::-1]
    ax.barh(names, [100 * shares[name] for name in names], color=style.PALETTE[0], height=0.6)
    for row, name in enumerate(names):
        ax.annotate(
            f"{100 * shares[name]:.0f}", (100 * shares[name], row), (4, 0), textcoords="offset points", va="center"
        )
    ax.set_yticks(range(len(names)), names)
    ax.set_xlim(0, 110)
    ax.set_xlabel("share of the movers' time, %")
