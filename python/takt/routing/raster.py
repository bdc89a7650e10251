"""The free surface as a raster of places (squares): which of them stators cover, and which of them movers cover.

If the machine has parts, their stators are the surface, all in one coordinate system; else those of an environment.
With parts the raster extends over all their positions there, so that a place keeps its number while parts move.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from takt.routing.streets import RoutingError

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.part import Part
    from takt.session import Session

STATOR = 240.0  # [mm] side of a stator
ROOM = 2.0  # [mm] between movers in neighbouring places, unless a pitch is given
CLEARANCE = 0.01  # [mm] least difference of the sizes of place and mover
APART = 1.0  # [mm] least distance between movers, where the pitch allows it
NEAR = 0.05  # [mm] admissible deviation of a mover from the centre of a place
MOST_PLACES = 128  # in each direction
Point = tuple[float, float]


@dataclass(frozen=True)
class Raster:
    """Places in rows and columns, numbered row by row from the lower left one."""

    origin: Point  # mm, lower left corner of the first place
    pitch: float  # mm
    width: int
    height: int
    free: tuple[bool, ...]  # by place: True if stators cover it
    reference: str = ""  # name of the coordinate system; empty: the machine has no parts
    coordinate_system: int = 0  # its number; 0: the machine has no parts

    def middle(self, place: int) -> Point:
        x, y = place % self.width, place // self.width
        return self.origin[0] + (x + 0.5) * self.pitch, self.origin[1] + (y + 0.5) * self.pitch

    def place_at(self, point: Point, what: str, mover: str = "") -> int:
        """Returns the place with this centre. Raises RoutingError, with `what` as the subject of its sentence, if
        stators do not cover the place or the point is more than NEAR off its centre."""
        x, y = (math.floor((value - low) / self.pitch) for value, low in zip(point, self.origin, strict=True))
        inside = 0 <= x < self.width and 0 <= y < self.height
        place = y * self.width + x
        if not inside or not self.free[place]:
            raise RoutingError(
                f"{what} at {_text(point)} is not on the surface: stators do not cover the place there", mover
            )
        if math.dist(self.middle(place), point) > NEAR:
            raise RoutingError(
                f"{what} at {_text(point)} is not in the middle of a place: "
                f"the nearest is {_text(self.middle(place))}, places are {self.pitch:.6g} mm apart",
                mover,
            )
        return place

    def covered_by(self, mover: Mover) -> list[int]:
        """Returns the places that a mover covers in part; none if it is in another coordinate system."""
        if self.coordinate_system and mover.coordinate_system != self.coordinate_system:
            return []
        ranges = []
        for value, low, side, count in zip(
            (mover.x, mover.y), self.origin, extent_of(mover), (self.width, self.height), strict=True
        ):
            first = math.floor((value - low - side / 2 + NEAR) / self.pitch)
            last = math.ceil((value - low + side / 2 - NEAR) / self.pitch) - 1
            ranges.append(range(max(first, 0), min(last, count - 1) + 1))
        return [y * self.width + x for y in ranges[1] for x in ranges[0]]


def extent_of(mover: Mover) -> Point:
    """Returns the sides [mm] of the bounding rectangle of a mover along X and Y, at its present orientation."""
    angle = math.radians(mover.c)
    sine, cosine = abs(math.sin(angle)), abs(math.cos(angle))
    width, height = float(mover.parameters["width"]), float(mover.parameters["height"])
    return width * cosine + height * sine, width * sine + height * cosine


def make_raster(
    session: Session, movers: Sequence[Mover], environment: str | None, pitch: float | None, origin: Point | None
) -> Raster:
    """Returns the raster for movers of these sizes on the stators of an environment, or of the parts in the coordinate
    system of these movers. Raises RoutingError if the surface, the pitch [mm] or the origin [mm] does not allow one."""
    number = _coordinate_system(session, movers)
    if number:
        if environment is not None:
            raise RoutingError(f"environment {environment}: where there are parts, they are the surface")
        stators, there = _stators_of_parts(session, number)
    else:
        stators = there = _stators(session, environment)
    side, largest = max(((max(extent_of(m)), m) for m in movers), key=lambda pair: pair[0], default=(0.0, None))
    if pitch is None:
        least = side + ROOM
        pitch = STATOR * math.ceil(least / STATOR) if least > STATOR else STATOR / math.floor(STATOR / max(least, 1.0))
    if not 0 < pitch < math.inf:
        raise RoutingError(f"the pitch is above 0 mm, not {pitch:.6g}")
    if largest is not None and pitch < side + CLEARANCE - 1e-9:
        raise RoutingError(
            f"mover {largest.name} is {side:.6g} mm large, and has no room in places of {pitch:.6g} mm: "
            f"expected a pitch of {side + CLEARANCE:.6g} mm or more"
        )
    if origin is None:
        origin = min(x for x, _ in stators), min(y for _, y in stators)
    right, top = max(x for x, _ in stators) + STATOR, max(y for _, y in stators) + STATOR
    width, height = (math.floor((end - start) / pitch + 1e-9) for start, end in zip(origin, (right, top), strict=True))
    if width < 1 or height < 1:
        raise RoutingError(f"no place of {pitch:.6g} mm is on the stators: the surface ends at {_text((right, top))}")
    if max(width, height) > MOST_PLACES:
        raise RoutingError(
            f"the raster has {width} by {height} places of {pitch:.6g} mm: expected at most {MOST_PLACES} each way"
        )
    by_column: dict[int, list[Point]] = {}
    for stator in there:
        by_column.setdefault(math.floor(stator[0] / STATOR), []).append(stator)
    reference = session.machine["coordinate_systems"][number - 1]["name"] if number else ""
    raster = Raster(origin, pitch, width, height, (), reference, number)
    free = tuple(_is_covered(raster.middle(place), pitch, by_column) for place in range(width * height))
    if not any(free):
        raise RoutingError(f"no place of {pitch:.6g} mm is on the stators, counted from {_text(origin)}")
    return replace(raster, free=free)


def _text(point: Point) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})"


def _stators(session: Session, environment: str | None) -> list[Point]:
    if environment is None:
        names = [name for name, one in session.environments.items() if one.parameters["stators"]]
        if len(names) != 1:
            which = "which of " + ", ".join(names) if names else "an environment with stators"
            raise RoutingError(f"expected {which}: it says where movers can be (environment)")
        environment = names[0]
    one = session.environment(environment)
    stators = {(float(s["x"]), float(s["y"])) for s in one.parameters["stators"]}
    if not stators:
        raise RoutingError(f"environment {environment} has no stators")
    if one.stator_count != len(one.parameters["stators"]):
        raise RoutingError(f"environment {environment} is not as the machine file has it: routes are planned on that")
    return sorted(stators)


def _coordinate_system(session: Session, movers: Sequence[Mover]) -> int:
    """Returns the number of the coordinate system of all these movers; 0 if the machine has no parts."""
    if not session.parts:
        return 0
    for mover in movers[1:]:
        if mover.coordinate_system != movers[0].coordinate_system:
            names = [one["name"] for one in session.machine["coordinate_systems"]]
            said = [f"mover {m.name} is in {names[m.coordinate_system - 1]}" for m in (movers[0], mover)]
            raise RoutingError(f"{' and '.join(said)}: routes are planned in one coordinate system")
    return movers[0].coordinate_system if movers else 1


def _stators_of_parts(session: Session, number: int) -> tuple[list[Point], list[Point]]:
    """Returns the lower left corners of all stators that may be in this coordinate system, and of those there now."""
    name = session.machine["coordinate_systems"][number - 1]["name"]
    ever: set[Point] = set()
    now: set[Point] = set()
    for part in session.parts.values():
        own = [(float(s["x"]), float(s["y"])) for s in part.parameters["stators"]] or [
            (STATOR * column, STATOR * row)
            for column in range(part.parameters["columns"])
            for row in range(part.parameters["rows"])
        ]
        places = part.parameters["positions"]
        for place in places:
            if place["coordinate_system"] == name:
                ever.update((x + float(place["x"]), y + float(place["y"])) for x, y in own)
        if is_there(part) and part.coordinate_system == number:
            now.update((x + part.x, y + part.y) for x, y in own)
    return sorted(ever), sorted(now)


def is_there(part: Part) -> bool:
    """True if movers can be sent onto this part: it is enabled, or being enabled, and at rest at a position."""
    going = part.commanded_index != part.position_index
    return part.position_index > 0 and not going and part.state.value in ("Enabled", "Enabling")


def _is_covered(middle: Point, pitch: float, by_column: dict[int, list[Point]]) -> bool:
    """True if stators cover the whole place."""
    left, low = middle[0] - pitch / 2, middle[1] - pitch / 2
    area = 0.0
    for column in range(math.floor(left / STATOR) - 1, math.floor((left + pitch) / STATOR) + 1):
        for x, y in by_column.get(column, ()):
            wide = min(left + pitch, x + STATOR) - max(left, x)
            high = min(low + pitch, y + STATOR) - max(low, y)
            if wide > 0 and high > 0:
                area += wide * high
    return area > pitch * pitch * (1 - 1e-9)
