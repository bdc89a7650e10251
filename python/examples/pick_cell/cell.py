"""What is true in the pick cell, whatever anybody measures or commands: where products, trays and tool really are.

Belts are moved by their simulated servos, and slip. Products lie on the infeed at random places that the seed alone
decides; some slide after the camera has seen them. The camera notices a product at once when it passes, and says late
and not quite exactly where it lies. The gripper takes its time; it holds a product that is near enough just then.

In the twin (takt twin pick_cell) MuJoCo says where products are, and whether the gripper holds one.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np
import numpy.typing as npt
import takt

Array = npt.NDArray[np.float64]
BELT = 1500.0  # mm from the sensor to the end of a belt
EVERY = 10  # cycles between two looks of sensors and control: what passes a sensor meanwhile is found between them


@dataclass(frozen=True)
class Settings:
    seed: int = 8
    nearest: float = 90.0  # mm between two products at least
    more: float = 50.0  # mm, the mean of what there is beside
    across: float = 40.0  # mm to either side of the middle of the belt
    pitch: float = 100.0  # mm between two trays
    slip: float = 0.0001  # share of what the drive travels that the belt does not
    noise: float = 0.03  # mm, standard deviation of what the camera says of X and of Y
    picture_s: float = 0.05  # s from the camera's latch to the pose
    slides: float = 0.03  # share of the products that slide ...
    slides_by: float = 8.0  # ... by so many mm ...
    slides_at: float = 150.0  # ... when they are so many mm behind the camera
    gripper_s: float = 0.03  # s to close, and to open
    holds_within: float = 2.0  # mm from the middle of a product at which the gripper still holds it
    begins: float = -60.0  # mm from the camera: where products of the twin are put onto the infeed


@dataclass(frozen=True)
class Thing:
    """A product or a tray: where it lies on its belt."""

    number: int  # from 1, in the order in which they pass the sensor
    at: float  # mm of the belt's travel at which it passes the sensor
    y: float = 0.0  # mm beside the middle of the belt
    slides: tuple[float, float] = (0.0, 0.0)  # mm, along and across, after the camera has seen it


def products(settings: Settings) -> Iterator[Thing]:
    """All that will ever come."""
    chance = random.Random(settings.seed)
    at = 100.0
    for number in count(1):
        at += settings.nearest + chance.expovariate(1 / settings.more)
        y = chance.uniform(-settings.across, settings.across)
        turn, slides = chance.uniform(0, 2 * math.pi), chance.random() < settings.slides
        by = settings.slides_by if slides else 0.0
        yield Thing(number, at, y, (by * math.cos(turn), by * math.sin(turn)))


def trays(settings: Settings) -> Iterator[Thing]:
    for number in count(1):
        yield Thing(number, number * settings.pitch)


def place(thing: Thing, travel: Array | float, settings: Settings) -> tuple[Any, Any]:
    """X and Y of a thing from the origin of its belt when its drive has really travelled so far, mm."""
    x = (1 - settings.slip) * travel - thing.at
    slid = x > settings.slides_at
    return x + slid * thing.slides[0], thing.y + slid * thing.slides[1]


def in_world(origin: dict[str, float], x: Any, y: Any) -> tuple[Any, Any]:
    """X and Y of places on a level belt: numbers, or arrays of them."""
    turn = math.radians(origin.get("c", 0.0))
    cos, sin = math.cos(turn), math.sin(turn)
    return origin["x"] + cos * x - sin * y, origin["y"] + sin * x + cos * y


def reaches_in(belt: takt.Belt, distance: float) -> float:
    """s in which a belt cannot travel farther, mm, whatever it is told meanwhile."""
    if distance <= 0:
        return 0.0
    axis = belt.axis
    fastest = max(axis.set_velocity, axis.actual_velocity) + 20.0  # mm/s: more than its servo is ever off
    speeds_up = 2.0 * float(axis.parameters["limits"]["acceleration"])
    return (math.sqrt(fastest * fastest + 2 * speeds_up * distance) - fastest) / speeds_up


@dataclass
class Seen:
    """What the control knows of a thing on a belt."""

    number: int  # the belt's own
    recorded: float  # mm, position of the belt's axis at which it was
    x: float  # mm, there
    y: float


class Conveyor:
    """A belt of the cell with all that lies on it, and the sensor over its origin. `late`: a camera that gives poses
    so many s later; none: a photo sensor, which knows that things lie in the middle."""

    def __init__(self, session: takt.Session, name: str, things: Iterator[Thing], settings: Settings, late: float):
        self.session = session
        self.belt = session.belt(name)
        self.settings = settings
        self.late = late
        self.origin: dict[str, float] = self.belt.parameters["origin"]
        self.seen: dict[int, Seen] = {}  # by number, with a pose
        self.changed: Callable[[], None] = lambda: None  # called when there is a new one
        self.here: dict[int, Thing] = {}  # what has passed the sensor and lies there still
        self._things = things
        self._next = next(things)
        self._noise = random.Random(settings.seed + 1)
        self._before = self._measured()
        self._start = self._before[0]
        self._pictures: list[tuple[float, Seen, takt.Feedback]] = []
        plant = getattr(session, "plant", None)
        self.cargo = plant.cargo if plant is not None and late > 0 else None
        self._slid: set[int] = set()
        self._coming = products(settings)  # those to be put into the twin
        self._arrives = next(self._coming)

    @property
    def travel(self) -> float:
        """mm that its drive has really travelled."""
        return self.belt.axis.true_position - self._start

    def on_belt(self) -> list[Thing]:
        """What has passed the sensor, without that which has left at the end of the belt."""
        travel = self.travel
        ended = [number for number, thing in self.here.items() if travel - thing.at > BELT]
        for number in ended if self.cargo is None else ():
            del self.here[number]
        return list(self.here.values())

    def truth(self, thing: Thing, travel: float) -> tuple[float, float]:
        """X and Y in the world when the belt's drive has really travelled so far."""
        if self.cargo is not None:
            x, y, _ = self.cargo.position(thing.number).tolist()
            return x, y
        return in_world(self.origin, *place(thing, travel, self.settings))

    def looks_again(self) -> float:
        """s until the sensor has to be looked at again: the look before the next thing passes it, and when the camera
        gives a pose. Of what `step` has seen in this cycle."""
        travel = self._before[0] - self._start
        left = [-self._past(travel)]
        if self.cargo is not None:
            left = [] if left[0] == math.inf else left
            left.append(self.settings.begins - float(place(self._arrives, travel, self.settings)[0]))
            left += [self.settings.slides_at - (travel - thing.at) for thing in self._about_to_slide()]
        due = reaches_in(self.belt, min(left)) - EVERY * self.session.period
        if self._pictures:
            due = min(due, self._pictures[0][0] - self.session.now)
        return max(due, 0.0)

    @property
    def waiting(self) -> int:
        """How many of what has passed the sensor the control has not dealt with: it does not know of them yet, or has
        neither gone for them nor given them up."""
        return len(self.seen) + len(self._pictures)

    def _measured(self) -> tuple[float, float]:
        axis = self.belt.axis
        return axis.true_position, axis.actual_position

    def step(self) -> None:
        """The sensor latches what has passed it since the last look, the camera gives poses that are due."""
        (true_0, actual_0), (true_1, actual_1) = self._before, self._measured()
        self._before = true_1, actual_1
        if self.cargo is not None:
            self._carry(true_1 - self._start)
        while (past := self._past(true_1 - self._start)) >= 0:
            share = 1 - past / (true_1 - true_0) if true_1 > true_0 else 1.0
            self._latch(self._next, actual_0 + min(max(share, 0.0), 1.0) * (actual_1 - actual_0))
            self._next = next(self._things)
        while self._pictures and self._pictures[0][0] <= self.session.now and self._pictures[0][2].final:
            _, seen, latched = self._pictures.pop(0)
            if latched.done:
                seen.number = int(latched.value)
                if self.late > 0:
                    self.belt.locate(number=seen.number, x=seen.x, y=seen.y)
                self.seen[seen.number] = seen
                self.changed()

    def _past(self, travel: float) -> float:
        """mm of travel since the next thing has passed the sensor."""
        if self.cargo is None:
            return travel - self._next.at / (1 - self.settings.slip)
        if self._next.number not in self.cargo.here:
            return -math.inf
        x, y, *_ = self.cargo.position(self._next.number)
        turn = math.radians(self.origin.get("c", 0.0))
        return float((x - self.origin["x"]) * math.cos(turn) + (y - self.origin["y"]) * math.sin(turn))

    def _carry(self, travel: float) -> None:
        """Puts products of the twin onto the belt before they come to the camera, and has some slide behind it."""
        assert self.cargo is not None
        while (x := float(place(self._arrives, travel, self.settings)[0])) >= self.settings.begins:
            self.cargo.put(self.belt.name, x, self._arrives.y)
            self._arrives = next(self._coming)
        for thing in self._about_to_slide():
            if place(thing, travel, self.settings)[0] > self.settings.slides_at:
                self._slid.add(thing.number)
                self.cargo.move(thing.number, *(in_world({**self.origin, "x": 0.0, "y": 0.0}, *thing.slides)))
        self.here = {number: thing for number, thing in self.here.items() if number in self.cargo.here}

    def _about_to_slide(self) -> list[Thing]:
        return [one for one in self.here.values() if one.slides != (0.0, 0.0) and one.number not in self._slid]

    def _latch(self, thing: Thing, recorded: float) -> None:
        noise = self.settings.noise if self.late > 0 else 0.0
        seen = Seen(0, recorded, self._noise.gauss(0, noise), thing.y + self._noise.gauss(0, noise))
        pose = {} if self.late > 0 else {"x": 0.0}
        latched = self.belt.detect(recorded_position=recorded, **pose)
        self.here[thing.number] = thing
        self._pictures.append((self.session.now + self.late, seen, latched))


@dataclass
class Gripper:
    """It closes and opens a time after it is told so; what it then holds hangs as it was gripped."""

    cell: Cell
    closed: bool = False
    holds: Thing | None = None
    _due: list[tuple[float, bool]] = field(default_factory=list)

    def close(self) -> None:
        self._tell(True)

    def open(self) -> None:
        self._tell(False)

    def _tell(self, close: bool) -> None:
        self._due.append((self.cell.session.now + self.cell.settings.gripper_s, close))
        self.cell.wake()

    def step(self) -> None:
        while self._due and self._due[0][0] <= self.cell.session.now:
            _, self.closed = self._due.pop(0)
            self._grip() if self.closed else self._let_go()
            self.cell.changed()

    def looks_again(self) -> float:
        """s until it acts."""
        return max(self._due[0][0] - self.cell.session.now, 0.0) if self._due else math.inf

    def _grip(self) -> None:
        conveyor, session = self.cell.infeed, self.cell.session
        near, apart = self.cell.nearest(conveyor)
        if near is None or apart > self.cell.settings.holds_within:
            session.mark("holds nothing")
            return
        self.holds = conveyor.here.pop(near.number)
        session.mark(f"holds product {near.number}")

    def _let_go(self) -> None:
        thing, self.holds = self.holds, None
        if thing is None:
            return
        conveyor = self.cell.outfeed
        tray, _ = self.cell.nearest(conveyor)
        assert tray is not None
        self.cell.session.mark(f"puts product {thing.number} onto tray {tray.number}")


class TwinGripper(Gripper):
    """That of the twin: MuJoCo has the products, and what the gripper holds."""

    _told = False

    def _tell(self, close: bool) -> None:
        self._twin.close() if close else self._twin.open()
        self._told = close
        self.cell.wake()

    def looks_again(self) -> float:
        return 0.0 if self._told != self.closed else math.inf

    @property
    def _twin(self) -> Any:
        return self.cell.session.plant.cargo.grippers["robot"]  # type: ignore[attr-defined]

    def step(self) -> None:
        if self._twin.closed == self.closed:
            return
        self.closed = self._twin.closed
        self.cell.changed()
        if not self.closed:
            self._let_go()
        elif self._twin.holds is None:
            self.cell.session.mark("holds nothing")
        else:
            self.holds = self.cell.infeed.here.pop(self._twin.holds)
            self.cell.session.mark(f"holds product {self.holds.number}")


class Cell:
    """Both belts and the gripper, from now on in step with the session's engine."""

    def __init__(self, session: takt.Session, settings: Settings) -> None:
        self.session = session
        self.settings = settings
        self.robot = session.group("robot")
        self.infeed = Conveyor(session, "infeed", products(settings), settings, settings.picture_s)
        self.outfeed = Conveyor(session, "outfeed", trays(settings), settings, 0.0)
        self.gripper = Gripper(self) if self.infeed.cargo is None else TwinGripper(self)
        self._later: list[tuple[float, Callable[[], object], Callable[[], Any]]] = []
        self.changed: Callable[[], None] = lambda: None  # called when the gripper has acted
        session.program(self._step, every=EVERY, on=())

    def when(self, condition: Callable[[], object], what: Callable[[], Any]) -> None:
        """Has something done once, as soon as the condition holds: a command, a change."""
        self._do_later(self.session.now, condition, what)

    def at(self, seconds: float, what: Callable[[], Any]) -> None:
        """The same when the session's time has come."""
        self._do_later(seconds, lambda: True, what)

    def _do_later(self, seconds: float, condition: Callable[[], object], what: Callable[[], Any]) -> None:
        self._later.append((seconds, condition, what))
        self.wake()

    def wake(self) -> None:
        """Something new is to be done: the cell does not wait until what it knew of is due."""
        self.session.wake(self._step)

    def nearest(self, conveyor: Conveyor) -> tuple[Thing | None, float]:
        """The thing on a belt that is nearest to the tool, and how far it is from there, mm."""
        tool, z, travel = self.robot.actual_pose[:3], conveyor.origin["z"], conveyor.travel
        found: tuple[Thing | None, float] = None, math.inf
        for thing in conveyor.on_belt():
            apart = math.dist(tool, (*conveyor.truth(thing, travel), z))
            if apart < found[1]:
                found = thing, apart
        return found

    def _step(self) -> float:
        """All that is due. Returns s until there may be something again."""
        now = self.session.now
        for one in [one for one in self._later if now >= one[0] and one[1]()]:
            self._later.remove(one)
            one[2]()
        self.infeed.step()
        self.outfeed.step()
        self.gripper.step()
        later = min((max(one[0] - now, 0.0) for one in self._later), default=math.inf)
        return min(later, self.infeed.looks_again(), self.outfeed.looks_again(), self.gripper.looks_again())
