"""Pictures of the pick cell: the tool's way from above and from the side, placing errors, and who rode on what when."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from cell import in_world
from judge import INTERRUPTED, Judgement
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from picker import LIFT
from takt import plot, style
from takt.recording import Recording

HALF_WIDTH = 60.0  # mm, of a belt
DETAIL_S = 8.0  # s of the time line
SHOWN = ("none", "synchronizing", "in_sync", "desynchronizing")
EMPTY, FULL = style.PALETTE[0], style.PALETTE[1]


def picture(recording: Recording, machine: dict[str, Any], found: Judgement, around_s: float) -> Figure:
    """Everything in one: `around_s` is in the middle of the time line."""
    figure = Figure(figsize=(plot.WIDTH_IN, 13.0), dpi=plot.DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(4, 2, height_ratios=[2.5, 1.5, 0.5, 1.0], width_ratios=[1.5, 1])
    above, errors = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[0, 1])
    side = figure.add_subplot(grid[1, :])
    states = figure.add_subplot(grid[2, :])
    speeds = figure.add_subplot(grid[3, :], sharex=states)
    full = _full(found)
    _from_above(above, machine, found, full)
    _from_the_side(side, machine, found, full)
    _errors(errors, found)
    window = (around_s - DETAIL_S / 2, around_s + DETAIL_S / 2)
    _states(states, recording, found, window)
    _speeds(speeds, recording, machine, window)
    handles = [
        Line2D([], [], color=EMPTY, label="tool, empty"),
        Line2D([], [], color=FULL, label="tool with a product"),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=2, frameon=False, fontsize=10, labelcolor=plot.INK)
    title = f"{found.picks_a_minute:.0f} picks a minute from one running belt to another"
    figure.suptitle(title, x=0.01, ha="left", color=plot.INK, weight="bold", size=14)
    return figure


def _full(found: Judgement) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """When the gripper holds something, for each sample of the tool's way."""
    full = np.zeros(len(found.time_s), dtype=np.bool_)
    for one in found.placed:
        full |= (found.time_s >= one.held_s) & (found.time_s <= one.time_s)
    return full


def _ways(ax: Axes, found: Judgement, full: np.ndarray[Any, np.dtype[np.bool_]], columns: Sequence[int]) -> None:
    works = ((found.time_s >= found.span[0]) & (found.time_s <= found.span[1]))[:, np.newaxis]
    for mask, colour in ((~full, EMPTY), (full, FULL)):
        way = np.where(works & mask[:, np.newaxis], found.tool, np.nan)
        ax.plot(way[:, columns[0]], way[:, columns[1]], color=colour, lw=0.6, alpha=0.6, zorder=3)


def _from_above(ax: Axes, machine: dict[str, Any], found: Judgement, full: Any) -> None:
    plot.dress(ax)
    ax.set_aspect("equal")
    for belt in machine["belts"]:
        ends = in_world(belt["origin"], np.array([-20.0, 900.0]), np.zeros(2))
        reach = in_world(belt["origin"], np.array([belt["lower_limit"], belt["upper_limit"]]), np.zeros(2))
        for span, colour in ((ends, "#eceff3"), (reach, "#dbe6f7")):
            low = float(span[0].min()), float(span[1].min()) - HALF_WIDTH
            ax.add_patch(Rectangle(low, float(np.ptp(span[0])), 2 * HALF_WIDTH, fc=colour, ec="none", zorder=1))
        start, end = np.array(in_world(belt["origin"], np.array([20.0, 110.0]), np.full(2, HALF_WIDTH - 12.0))).T
        ax.annotate("", end, start, arrowprops={"arrowstyle": "->", "color": plot.FAINT}, zorder=4)
        sensor = in_world(belt["origin"], np.zeros(2), np.array([-HALF_WIDTH, HALF_WIDTH]))
        ax.plot(*sensor, color=style.BAD, lw=1.4, zorder=4)
        name = in_world(belt["origin"], 20.0, -HALF_WIDTH + 12.0)
        right = abs(belt["origin"].get("c", 0.0)) > 90
        what = "camera" if belt["name"] == "infeed" else "photo sensor"
        ax.text(
            *name, f"{belt['name']}, {what}", ha="right" if right else "left", va="center", color=plot.INK, size=9.5
        )
    _ways(ax, found, full, (0, 1))
    ax.set(xlim=(-470, 470), ylim=(-230, 230))
    ax.set_xlabel("X [mm]", color=plot.INK, size=10.5)
    ax.set_ylabel("Y [mm]", color=plot.INK, size=10.5)
    ax.set_title("from above; blue: where the robot may work", loc="left", color=plot.INK, size=10.5)


def _from_the_side(ax: Axes, machine: dict[str, Any], found: Judgement, full: Any) -> None:
    plot.dress(ax)
    ax.set_aspect("equal")
    for belt in machine["belts"]:
        origin = belt["origin"]
        low = origin["y"] - HALF_WIDTH, origin["z"] - 6.0
        ax.add_patch(Rectangle(low, 2 * HALF_WIDTH, 6.0, fc="#c9d0d9", ec="none", zorder=1))
        ax.text(origin["y"], low[1] - 3, belt["name"], ha="center", va="top", color=plot.INK, size=9.5)
    _ways(ax, found, full, (1, 2))
    height = machine["belts"][0]["origin"]["z"]
    ax.set(xlim=(-230, 230), ylim=(height - 26, height + LIFT + 30))
    ax.set_xlabel("Y [mm]", color=plot.INK, size=10.5)
    ax.set_ylabel("Z [mm]", color=plot.INK, size=10.5)
    ax.set_title("along the belts", loc="left", color=plot.INK, size=10.5)


def _errors(ax: Axes, found: Judgement) -> None:
    plot.dress(ax)
    errors = found.errors
    ax.hist(errors, bins=16, range=(0.0, max(float(errors.max()), 1e-3)), color=style.GOOD, alpha=0.85, zorder=2)
    for value, name, dash in (
        (errors.mean(), "mean", "-"),
        (np.percentile(errors, 95), "95 %", (0, (5, 2))),
        (errors.max(), "largest", (0, (1, 1.5))),
    ):
        ax.axvline(value, color=plot.INK, lw=1.2, ls=dash, label=f"{name}  {value:.3f} mm", zorder=3)
    ax.set_xlim(0, 1.5 * float(errors.max()))
    ax.set_xlabel("from where a product should lie to where it lies [mm]", color=plot.INK, size=10.5)
    ax.set_ylabel("products", color=plot.INK, size=10.5)
    ax.legend(loc="upper right", frameon=False, fontsize=9.5, labelcolor=plot.INK)
    missed = ", ".join(f"{number} {why}" for why, number in sorted(found.reasons.items())) or "none"
    title = f"{len(errors)} placed; missed: {missed}"
    ax.set_title(title, loc="left", color=plot.INK, size=10.5)


def _states(ax: Axes, recording: Recording, found: Judgement, window: tuple[float, float]) -> None:
    table = recording["robot"]
    names = recording.names("robot", "track_state") or {}
    for begin, end, value in plot.stretches(table["time_s"], table["track_state"]):
        if end < window[0] or begin > window[1]:
            continue
        colour = style.state_colour(names.get(value, ""), value)
        ax.add_patch(Rectangle((begin, 0.6), end - begin, 0.8, fc=colour, ec="none"))
    for one in found.placed:
        ax.add_patch(Rectangle((one.held_s, -0.4), one.time_s - one.held_s, 0.8, fc=FULL, ec="none"))
    for side in ax.spines.values():
        side.set_visible(False)
    ax.set(xlim=window, ylim=(-0.6, 1.6), yticks=[0, 1], yticklabels=["holds", "tracking"])
    ax.tick_params(colors=plot.FAINT, labelcolor=plot.INK, labelsize=9.5, length=0, labelbottom=False)
    shown = [Patch(fc=style.STATES[name], label=name.replace("_", " ")) for name in SHOWN]
    ax.legend(handles=shown, loc="lower right", bbox_to_anchor=(1, 0.98), ncols=4, frameon=False, fontsize=9)
    ax.set_title(f"{DETAIL_S:g} s of it", loc="left", color=plot.INK, size=10.5)


def _speeds(ax: Axes, recording: Recording, machine: dict[str, Any], window: tuple[float, float]) -> None:
    plot.dress(ax)
    shown = recording.slice(*window)
    for i, belt in enumerate(machine["belts"]):
        table = shown[belt["axis"]]
        ax.plot(table["time_s"], table["set_velocity"], color=style.PALETTE[2 + i], lw=1.6, label=belt["name"])
    tool = shown["robot"]
    ax.plot(tool["time_s"], tool["velocity"] / 10, color=plot.FAINT, lw=0.9, label="tool / 10")
    ax.set_xlim(*window)
    ax.set_ylim(0, 420)
    ax.set_xlabel("time [s]", color=plot.INK, size=10.5)
    ax.set_ylabel("speed\n[mm/s]", color=plot.INK, size=10.5)
    ax.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=3, frameon=False, fontsize=9, labelcolor=plot.INK)
    for event in shown.events:
        if event.kind == "mark" and not event.text.startswith(("holds", "puts", "misses")):
            ax.axvline(event.time_s, color=plot.INK, lw=0.8, alpha=0.4)
            before = event.text == INTERRUPTED
            ax.annotate(event.text, (event.time_s, 1.0), xycoords=("data", "axes fraction"),
                        xytext=(-3 if before else 3, -3), textcoords="offset points",
                        ha="right" if before else "left", va="top", size=9, color=plot.INK)  # fmt: skip
