"""Cams computed from the data of a machine and its product, checked against the limits of the slave.

    knife = RotaryKnife(circumference=500, blades=1, cut_zone=20, limits=Limits(velocity=3000, acceleration=200_000))
    table = knife.cam(437.5, speed=1000)  # x: mm of web, y: deg of the knife

Impossible cams raise `takt.ConfigError`, which says which limit is exceeded, by how much, and what would be possible.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from takt.cam import Table
from takt.errors import ConfigError

SEARCH_STEPS = 60  # of a bisection: down to the precision of floats
REVERSAL_POINTS = 1001  # samples of the motion of a knife that reverses


@dataclass(frozen=True)
class Limits:
    """Limits of a slave in its own unit: [deg/s], [deg/s²], [deg/s³] for a knife."""

    velocity: float = math.inf
    acceleration: float = math.inf
    jerk: float = math.inf


def peaks(table: Table, speed: float) -> dict[str, float]:
    """Returns the slave's largest velocity, acceleration and jerk at this speed of the master, exact from the
    polynomials."""
    extremes = table.extremes()
    most = [max(abs(b.least.value), abs(b.greatest.value)) for b in (extremes.dy, extremes.ddy, extremes.dddy)]
    names = ("velocity", "acceleration", "jerk")
    return {name: most[i] * speed ** (i + 1) for i, name in enumerate(names)}


def fastest(table: Table, limits: Limits) -> float:
    """Returns the highest speed of the master at which the slave keeps its limits; infinity without limits."""
    at_one = peaks(table, 1.0)
    return min(
        (getattr(limits, name) / peak) ** (1 / k) if peak else math.inf
        for k, (name, peak) in enumerate(at_one.items(), 1)
    )


def beyond(table: Table, limits: Limits, speed: float, slave: str) -> str:
    """Returns a sentence about a limit that the slave exceeds at this speed of the master; empty: it keeps all."""
    for name, peak in peaks(table, speed).items():
        limit = getattr(limits, name)
        if peak > limit * (1 + 1e-9):
            return f"the {slave}'s {name} would be {peak:.6g}, its limit is {limit:g}"
    return ""


def is_number(value: object) -> bool:
    return isinstance(value, (int, float, np.number)) and math.isfinite(value)


class Wrong(list[str]):
    """Problems of the data of a machine or a product."""

    def expect(self, name: str, value: float, above: float, what: str = "a number") -> None:
        if not (is_number(value) and value > above):
            self.append(f"{name}: expected {what} above {above:g}, found {value!r}")

    def expect_not_below(self, name: str, value: float, least: float, what: str = "a number") -> None:
        if not (is_number(value) and value >= least):
            self.append(f"{name}: expected {what} from {least:g} on, found {value!r}")

    def expect_limits(self, limits: Limits) -> None:
        for name in ("velocity", "acceleration", "jerk"):
            value = getattr(limits, name)
            if isinstance(value, str) or not value > 0:
                self.append(f"limits.{name}: expected a number above 0, found {getattr(limits, name)!r}")

    def tell(self) -> None:
        if self:
            raise ConfigError(self)


@dataclass(frozen=True)
class RotaryKnife:
    """A rotary knife or cross cutter above a running web.

    circumference: [mm] of the circle of the blades' edges.
    blades: number of blades, evenly spaced on it, from 1.
    cut_zone: length [mm] of web before and behind each cut in which the blade moves synchronously with the web.
    limits: of the knife's axis [deg].
    may_reverse: the knife may turn backwards between two cuts; otherwise long products that need it are refused. A
        motion in which a blade would re-enter the cut zone between two cuts is always refused.

    Raises takt.ConfigError if the data is inconsistent.
    """

    circumference: float
    blades: int = 1
    cut_zone: float = 0.0
    limits: Limits = Limits()
    may_reverse: bool = False

    def __post_init__(self) -> None:
        wrong = Wrong()
        wrong.expect("circumference", self.circumference, 0, "a number of mm")
        if isinstance(self.blades, bool) or not isinstance(self.blades, int) or self.blades < 1:
            wrong.append(f"blades: expected a whole number from 1 on, found {self.blades!r}")
        wrong.expect_not_below("cut_zone", self.cut_zone, 0, "a number of mm")
        wrong.expect_limits(self.limits)
        if not wrong and 2 * self.cut_zone >= self.circumference / self.blades:
            most = self.circumference / self.blades / 2
            wrong.append(
                f"cut_zone: expected less than {most:g} mm, half of the way of a blade, found {self.cut_zone:g}"
            )
        wrong.tell()

    @property
    def pitch(self) -> float:
        """Angle [deg] from one blade to the next."""
        return 360.0 / self.blades

    def cam(self, length: float, *, speed: float, name: str | None = None) -> Table:
        """Returns the cyclic cam for products of `length` [mm]: x [mm] of web from one cut to the next, y [deg].

        speed: highest speed of the web [mm/s], up to which the limits hold.
        name: None: "knife_" and the length.

        Raises takt.ConfigError if a limit is exceeded or the motion is not possible.
        """
        if not (is_number(speed) and speed > 0):
            raise ConfigError([f"speed: expected a number of mm/s above 0, found {speed!r}"])
        table = self._made(self._product(length), name or f"knife_{length:g}")
        problem = self._problem(table, speed)
        if problem:
            raise ConfigError([f"length {length:g} mm at {speed:g} mm/s: {problem}; {self._remedy(length, speed)}"])
        return table

    def _product(self, length: float) -> float:
        if not (is_number(length) and length > 2 * self.cut_zone):
            raise ConfigError(
                [f"length: expected more than {2 * self.cut_zone:g} mm, twice the cut zone, found {length!r}"]
            )
        return length

    def _made(self, length: float, name: str) -> Table:
        zone, per_mm = self.cut_zone, 360.0 / self.circumference
        run = {"begin_v": per_mm, "begin_a": 0.0, "end_v": per_mm, "end_a": 0.0}
        middle = {"to": {"x": length - zone, "y": self.pitch - zone * per_mm}, **run}
        if not zone:
            segments: list[dict[str, Any]] = [middle]
        else:
            into = {"to": {"x": zone, "y": zone * per_mm}, "law": "line"}
            out = {"to": {"x": length, "y": self.pitch}, "law": "line"}
            segments = [into, middle, out]
        return Table.from_segments(segments, name=name, cyclic=True, x_unit="mm", y_unit="deg")

    def _blocked(self, table: Table) -> str:
        """Returns why the motion is impossible at any speed; empty if it is possible."""
        least = table.extremes().dy.least.value
        if least >= -1e-9 * 360 / self.circumference:
            return ""
        if not self.may_reverse:
            return "the knife would turn back between two cuts"
        edge = self.cut_zone * 360 / self.circumference
        zone, length = self.cut_zone, table.end
        between = np.linspace(zone, length - zone, REVERSAL_POINTS)
        y = table.at(between).y
        inside = y.min() < edge - 1e-9 * self.pitch or y.max() > self.pitch - edge + 1e-9 * self.pitch
        return "a blade would come back into the cut zone between two cuts" if inside else ""

    def _problem(self, table: Table, speed: float) -> str:
        return self._blocked(table) or beyond(table, self.limits, speed, "knife")

    def highest_speed(self, length: float) -> float:
        """Returns the web speed [mm/s] up to which the limits hold for products of `length` [mm]; 0 if the knife would
        turn backwards without `may_reverse`, or re-enter the cut zone."""
        table = self._made(self._product(length), "knife")
        if self._blocked(table):
            return 0.0
        return fastest(table, self.limits)

    def _remedy(self, length: float, speed: float) -> str:
        slower = self.highest_speed(length)
        synchronous = self.circumference / self.blades  # at this length the knife runs evenly
        if self.highest_speed(synchronous) < speed:
            no_length = f"at {speed:g} mm/s no length would"
            return f"{no_length} do" if slower == 0 else f"up to {slower:.6g} mm/s it would do; {no_length}"
        bad, good = length, synchronous
        for _ in range(SEARCH_STEPS):
            middle = (bad + good) / 2
            if self.highest_speed(middle) < speed:
                bad = middle
            else:
                good = middle
        bound = "at least" if length < synchronous else "at most"
        which = f"{bound} {good:.6g} mm would do at this speed"
        return which if slower == 0 else f"up to {slower:.6g} mm/s it would do, or {which}"


@dataclass(frozen=True)
class FlyingSaw:
    """A saw, a printer or a gripper on a carriage that moves along with a running web and returns.

    travel: longest travel of the carriage [mm] from its rear end, which is y = 0.
    ride: length [mm] of web over which it moves synchronously with the web.
    limits: of the carriage's axis [mm].

    Raises takt.ConfigError if the data is inconsistent.
    """

    travel: float
    ride: float
    limits: Limits = Limits()

    def __post_init__(self) -> None:
        wrong = Wrong()
        wrong.expect("travel", self.travel, 0, "a number of mm")
        wrong.expect("ride", self.ride, 0, "a number of mm")
        wrong.expect_limits(self.limits)
        if not wrong and self.ride >= self.travel:
            wrong.append(f"ride: expected less than {self.travel:g} mm, the travel, found {self.ride:g}")
        wrong.tell()

    def cam(self, length: float, *, speed: float, name: str | None = None) -> Table:
        """Returns the cyclic cam for products of `length` [mm]: x [mm] of web from one product to the next, y [mm] of
        the carriage. The carriage accelerates to the web's speed over `run_up(length)` of web, moves along with it,
        brakes over the same length, and returns by a modified sine.

        speed: highest speed of the web [mm/s], up to which the limits hold.
        name: None: "saw_" and the length.

        Raises takt.ConfigError if a limit is exceeded.
        """
        wrong = Wrong()
        wrong.expect("speed", speed, 0, "a number of mm/s")
        wrong.expect("length", length, self.ride, "a number of mm")
        wrong.tell()
        table = self._made(length, self.run_up(length), name or f"saw_{length:g}")
        problem = beyond(table, self.limits, speed, "carriage")
        if problem:
            remedy = f"up to {fastest(table, self.limits):.6g} mm/s it would do"
            longer = self._shortest(length, speed)
            raise ConfigError([f"length {length:g} mm at {speed:g} mm/s: {problem}; {remedy}{longer}"])
        return table

    def run_up(self, length: float) -> float:
        """Returns the length [mm] of web over which the carriage accelerates, chosen for the highest web speed. Without
        limits: a third of the product's length beyond `ride`, or what the travel leaves."""
        wrong = Wrong()
        wrong.expect("length", length, self.ride, "a number of mm")
        wrong.tell()
        # A shorter run-up leaves more for the return: the highest speed has a single maximum.
        most = min(self.travel - self.ride, (length - self.ride) / 2)
        if self.limits == Limits():
            return min(self.travel - self.ride, (length - self.ride) / 3)  # a third each: run-up, braking, return
        low, high = 0.0, most
        for _ in range(SEARCH_STEPS):
            third = (high - low) / 3
            if self._highest(length, low + third) < self._highest(length, high - third):
                low += third
            else:
                high -= third
        return (low + high) / 2

    def highest_speed(self, length: float) -> float:
        """Returns the web speed [mm/s] up to which the limits hold for products of `length` [mm]."""
        return self._highest(length, self.run_up(length))

    def _highest(self, length: float, run_up: float) -> float:
        if not 0 < 2 * run_up < length - self.ride:
            return 0.0
        return fastest(self._made(length, run_up, "saw"), self.limits)

    def _made(self, length: float, run_up: float, name: str) -> Table:
        ride = self.ride
        segments: list[dict[str, Any]] = [
            {"to": {"x": run_up, "y": run_up / 2}, "begin_v": 0.0, "begin_a": 0.0, "end_v": 1.0, "end_a": 0.0},
            {"to": {"x": run_up + ride, "y": run_up / 2 + ride}, "law": "line"},
            {
                "to": {"x": 2 * run_up + ride, "y": run_up + ride},
                **{"begin_v": 1.0, "begin_a": 0.0, "end_v": 0.0, "end_a": 0.0},
            },
            {"to": {"x": length, "y": 0.0}, "law": "modified_sine"},
        ]
        return Table.from_segments(segments, name=name, cyclic=True, x_unit="mm", y_unit="mm")

    def _shortest(self, length: float, speed: float) -> str:
        bad, good = length, 2 * length
        while self.highest_speed(good) < speed:
            bad, good = good, 2 * good
            if good > 1e3 * length:
                return ""
        for _ in range(SEARCH_STEPS // 2):
            middle = (bad + good) / 2
            bad, good = (middle, good) if self.highest_speed(middle) < speed else (bad, middle)
        return f", or at least {good:.6g} mm would do at this speed"


@dataclass(frozen=True)
class WinderTraverse:
    """The guide that lays a thread, a wire or a band onto a rotating spool, layer by layer.

    pitch: travel of the guide [mm] per turn of the spool.
    reversal: angle [deg] of the spool over which the guide reverses at an edge.
    dwell: angle [deg] of the spool for which it dwells at each edge.
    limits: of the guide's axis [mm].

    Raises takt.ConfigError if the data is inconsistent.
    """

    pitch: float
    reversal: float
    dwell: float = 0.0
    limits: Limits = Limits()

    def __post_init__(self) -> None:
        wrong = Wrong()
        wrong.expect("pitch", self.pitch, 0, "a number of mm")
        wrong.expect("reversal", self.reversal, 0, "a number of deg")
        wrong.expect_not_below("dwell", self.dwell, 0, "a number of deg")
        wrong.expect_limits(self.limits)
        wrong.tell()

    @property
    def _edge(self) -> float:
        """Distance [mm] to the edge at which the guide begins to brake."""
        return self.pitch / 360 * self.reversal * (1 / 4 if self.dwell else 5 / 16)

    def cam(self, width: float, *, speed: float, name: str | None = None) -> Table:
        """Returns the cyclic cam of two layers: x [deg] of the spool, y [mm] of the guide from one edge, 0, to the
        other, `width` [mm], and back. Between the reversals the guide moves at constant pitch.

        speed: highest speed of the spool [deg/s], up to which the limits hold.
        name: None: "traverse_" and the width.

        Raises takt.ConfigError if a limit is exceeded.
        """
        wrong = Wrong()
        wrong.expect("speed", speed, 0, "a number of deg/s")
        wrong.expect("width", width, 2 * self._edge, "a number of mm")
        wrong.tell()
        table = self._made(width, name or f"traverse_{width:g}")
        problem = beyond(table, self.limits, speed, "guide")
        if problem:
            slower = fastest(table, self.limits)
            raise ConfigError(
                [f"width {width:g} mm at {speed:g} deg/s: {problem}; up to {slower:.6g} deg/s it would do"]
            )
        return table

    def highest_speed(self, width: float) -> float:
        """Returns the spool speed [deg/s] up to which the limits hold for this `width` [mm]."""
        wrong = Wrong()
        wrong.expect("width", width, 2 * self._edge, "a number of mm")
        wrong.tell()
        return fastest(self._made(width, "traverse"), self.limits)

    def _made(self, width: float, name: str) -> Table:
        per_deg, edge, half = self.pitch / 360, self._edge, self.reversal / 2
        # Without a dwell the guide reverses along u - 2 u³ + u⁴, the polynomial of lowest degree without a jump of
        # acceleration; at the edge, u = 1/2, its second derivative is -3.
        bend = 0.0 if self.dwell else 3 * per_deg / self.reversal
        even = (width - 2 * edge) / per_deg
        out: list[tuple[dict[str, float], dict[str, Any]]] = [
            ({"x": half, "y": edge}, {"begin_v": 0.0, "begin_a": bend, "end_v": per_deg, "end_a": 0.0}),
            ({"x": half + even, "y": width - edge}, {"law": "line"}),
            ({"x": 2 * half + even, "y": width}, {"begin_v": per_deg, "begin_a": 0.0, "end_v": 0.0, "end_a": -bend}),
            ({"x": 2 * half + even + self.dwell, "y": width}, {"law": "dwell"}),
        ]
        layer = 2 * half + even + self.dwell
        back = [
            ({"x": layer + to["x"], "y": width - to["y"]}, {k: v if k == "law" else -v for k, v in how.items()})
            for to, how in out
        ]
        segments = [{"to": to, **how} for to, how in out + back if self.dwell or how.get("law") != "dwell"]
        return Table.from_segments(segments, name=name, cyclic=True, x_unit="deg", y_unit="mm")
