"""The free surface as a raster of places: which are there, and which hold something that stands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from takt.routing.streets import RoutingError

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session

STATOR = 240.0  # mm, side
ROOM = 2.0  # mm between movers in neighbouring places, unless a pitch is given
CLEARANCE = 0.01  # mm that a mover has to be smaller than a place
NEAR = 0.05  # mm that a mover may be off the middle of a place
MOST_PLACES = 128  # each way
Point = tuple[float, float]


@dataclass(frozen=True)
class Raster:
    """Places in rows and columns. Number of a place: row by row, from the lower left one on."""

    origin: Point  # mm, lower left corner of the first place
    pitch: float  # mm
    width: int
    height: int
    free: tuple[bool, ...]  # by place: stators cover it

    def middle(self, place: int) -> Point:
        x, y = place % self.width, place // self.width
        return self.origin[0] + (x + 0.5) * self.pitch, self.origin[1] + (y + 0.5) * self.pitch

    def place_at(self, point: Point, what: str) -> int:
        """The place with this middle. `what`: the subject of the sentence that says that there is none."""
        x, y = (math.floor((value - low) / self.pitch) for value, low in zip(point, self.origin, strict=True))
        inside = 0 <= x < self.width and 0 <= y < self.height
        place = y * self.width + x
        if not inside or not self.free[place]:
            raise RoutingError(f"{what} at {_text(point)} is not on the surface: stators do not cover the place there")
        if math.dist(self.middle(place), point) > NEAR:
            raise RoutingError(
                f"{what} at {_text(point)} is not in the middle of a place: "
                f"the nearest is {_text(self.middle(place))}, places are {self.pitch:.6g} mm apart"
            )
        return place

    def covered_by(self, mover: Mover) -> list[int]:
        """Places that a mover reaches into."""
        half_x, half_y = (side / 2 for side in extent_of(mover))
        found = []
        for place in range(len(self.free)):
            x, y = self.middle(place)
            near_x = abs(mover.x - x) < half_x + self.pitch / 2 - NEAR
            if near_x and abs(mover.y - y) < half_y + self.pitch / 2 - NEAR:
                found.append(place)
        return found


def extent_of(mover: Mover) -> Point:
    """Sides of the rectangle along X and Y around a mover, as it is turned, mm."""
    angle = math.radians(mover.c)
    sine, cosine = abs(math.sin(angle)), abs(math.cos(angle))
    width, height = float(mover.parameters["width"]), float(mover.parameters["height"])
    return width * cosine + height * sine, width * sine + height * cosine


def make_raster(
    session: Session, movers: Sequence[Mover], environment: str | None, pitch: float | None, origin: Point | None
) -> Raster:
    """The raster on the stators of an environment, for movers as large as these."""
    stators = _stators(session, environment)
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
    for stator in stators:
        by_column.setdefault(math.floor(stator[0] / STATOR), []).append(stator)
    raster = Raster(origin, pitch, width, height, ())
    free = tuple(_is_covered(raster.middle(place), pitch, by_column) for place in range(width * height))
    if not any(free):
        raise RoutingError(f"no place of {pitch:.6g} mm is on the stators, counted from {_text(origin)}")
    return Raster(origin, pitch, width, height, free)


def _text(point: Point) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})"


def _stators(session: Session, environment: str | None) -> list[Point]:
    if session.parts:
        raise RoutingError("the machine has parts: routes on the free surface are planned on environments only")
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


def _is_covered(middle: Point, pitch: float, by_column: dict[int, list[Point]]) -> bool:
    """Stators cover the whole place."""
    left, low = middle[0] - pitch / 2, middle[1] - pitch / 2
    area = 0.0
    for column in range(math.floor(left / STATOR) - 1, math.floor((left + pitch) / STATOR) + 1):
        for x, y in by_column.get(column, ()):
            wide = min(left + pitch, x + STATOR) - max(left, x)
            high = min(low + pitch, y + STATOR) - max(low, y)
            if wide > 0 and high > 0:
                area += wide * high
    return area > pitch * pitch * (1 - 1e-9)
