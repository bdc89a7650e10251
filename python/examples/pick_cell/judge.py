"""What became of the products, found in a recording: the true places of belts and arms, and when the gripper acted."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np
from cell import Array, Settings, Thing, in_world, place, products, trays
from takt import kinematics
from takt.recording import Recording

WORKS = "picks begin"
ENDS = "picks end"
INTERRUPTED = "interrupted on the path"
GOES_ON = "and gone on with"


@dataclass(frozen=True)
class Placed:
    """A product that was put down."""

    product: Thing
    tray: Thing
    held_s: float  # when the gripper held it
    time_s: float  # when the gripper let go
    gripped: Array  # mm, (2,) from the tool to the middle of the product
    error: Array  # mm, (2,) in the world: from where it should lie to where it lies
    height: float  # mm above the tray at which the gripper let go

    @property
    def distance(self) -> float:
        """mm, placing error."""
        return float(np.hypot(*self.error))


@dataclass(frozen=True)
class Miss:
    number: int  # the object's on its belt
    why: str
    time_s: float


@dataclass(frozen=True)
class Judgement:
    placed: tuple[Placed, ...]
    misses: tuple[Miss, ...]
    span: tuple[float, float]  # s, from the first to the last chance
    tool: Array  # (n, 3), mm: the true path of the tool
    time_s: Array  # (n,)

    @property
    def errors(self) -> Array:
        """mm, of all that were placed."""
        return np.array([one.distance for one in self.placed])

    @property
    def picks_a_minute(self) -> float:
        return 60 * len(self.placed) / (self.span[1] - self.span[0])

    @property
    def reasons(self) -> Counter[str]:
        return Counter(miss.why for miss in self.misses)

    @property
    def sentence(self) -> str:
        errors = self.errors
        missed = ", ".join(f"{number} {why}" for why, number in sorted(self.reasons.items())) or "none"
        return (
            f"{len(errors)} products placed, {self.picks_a_minute:.0f} a minute; missed: {missed}; placing error "
            f"{errors.mean():.3f} mm in the mean, {np.percentile(errors, 95):.3f} mm for 95 %, {errors.max():.3f} mm "
            f"at most"
        )


class Truth:
    """Where all really was in a recording, at any time of it."""

    def __init__(self, recording: Recording, machine: dict[str, Any], settings: Settings, begins_s: float) -> None:
        self.settings = settings
        self._begins_s = begins_s
        self._recording = recording
        self._moved: dict[str, tuple[Array, Array]] = {}  # by axis
        self.belts = {belt["name"]: belt for belt in machine["belts"]}
        (group,) = machine["groups"]
        self.time_s = self._true(group["axes"][0])[0]
        arms = [np.interp(self.time_s, *self._true(arm)) for arm in group["axes"]]
        delta = kinematics.Kinematics(delta=group["kinematics"]["delta"])
        self.tool: Array = np.asfortranarray(delta.forward(np.stack(arms, axis=1))[:, :3])  # columns are asked for

    def _true(self, axis: str) -> tuple[Array, Array]:
        """Times and positions, each in one piece: NumPy copies columns of a table again and again."""
        if axis not in self._moved:
            table = self._recording[axis]
            self._moved[axis] = np.ascontiguousarray(table["time_s"]), np.ascontiguousarray(table["true_position"])
        return self._moved[axis]

    def tool_at(self, time_s: float) -> Array:
        """X, Y and Z of the tool."""
        return np.array([np.interp(time_s, self.time_s, self.tool[:, axis]) for axis in range(3)])

    def travel_at(self, belt: str, time_s: Array | float) -> Array:
        """mm since the picks began."""
        times, positions = self._true(self.belts[belt]["axis"])
        return np.interp(time_s, times, positions) - np.interp(self._begins_s, times, positions)

    def thing_at(self, belt: str, thing: Thing, time_s: Array | float) -> Array:
        """X and Y of something that lies on a belt."""
        travel = self.travel_at(belt, time_s)
        return np.array(in_world(self.belts[belt]["origin"], *place(thing, travel, self.settings)))


def judge(recording: Recording, machine: dict[str, Any], settings: Settings) -> Judgement:
    marks = [event for event in recording.events if event.kind == "mark"]
    begins, ends = (next(mark.time_s for mark in marks if mark.text == text) for text in (WORKS, ENDS))
    truth = Truth(recording, machine, settings, begins)
    held: dict[int, tuple[float, Array]] = {}
    placed: list[Placed] = []
    misses: list[Miss] = []
    for mark in marks:
        if match := re.fullmatch(r"holds product (\d+)", mark.text):
            product = _numbered(products(settings), int(match[1]))
            offset = truth.thing_at("infeed", product, mark.time_s) - truth.tool_at(mark.time_s)[:2]
            held[product.number] = mark.time_s, offset
        elif match := re.fullmatch(r"puts product (\d+) onto tray (\d+)", mark.text):
            product = _numbered(products(settings), int(match[1]))
            tray = _numbered(trays(settings), int(match[2]))
            held_s, offset = held[product.number]
            tool = truth.tool_at(mark.time_s)
            error = tool[:2] + offset - truth.thing_at("outfeed", tray, mark.time_s)
            height = float(tool[2] - truth.belts["outfeed"]["origin"]["z"])
            placed.append(Placed(product, tray, held_s, mark.time_s, offset, error, height))
        elif match := re.fullmatch(r"misses object (\d+): (.+)", mark.text):
            misses.append(Miss(int(match[1]), match[2], mark.time_s))
    return Judgement(tuple(placed), tuple(misses), (begins, ends), truth.tool, truth.time_s)


def _numbered(things: Any, number: int) -> Thing:
    return next(thing for thing in things if thing.number == number)
