"""Progress of one mover on its planned route over the free surface. The engine executes the route (commands set_route
and start_routes); this module derives what a planner needs to know of it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from takt.feedback import Feedback
from takt.routing.raster import NEAR, Point

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session

STANDS = 1e-3  # mm/s
DYNAMICS = ("velocity", "acceleration", "jerk")
ANSWER_S = 0.1  # over LCM: from an observed state to the effect of the command that answers it
VISITS_A_COMMAND = 48
COMMANDS_A_CYCLE = 16  # accepted by the engine
Before = tuple[str, int]  # a visit: name of the mover, number of the visit


class OnWay:
    """A mover, and the centres of the places that it visits.

    The engine numbers visits; `first` is the number of the first one. All other indices here refer to this list.
    """

    def __init__(self, mover: Mover, points: Sequence[Point], first: int) -> None:
        self.mover = mover
        self.points = list(points)
        self.first = first
        self.before: list[Before | None] = [None] * len(points)  # by place: the visit that has to end before
        self.feedback: Feedback | None = None  # of the command in progress
        self.bound = len(self.points) - 1  # the last place that can be granted before the engine has the next route
        self.halts = False  # True: the feedback is that of a halt

    @property
    def last(self) -> int:
        return len(self.points) - 1

    @property
    def passed(self) -> int:
        """Index of the last place whose centre the mover has reached."""
        passed = min(max(self.mover.route_visit - self.first, 0), self.last)
        # After it left its route it may have passed further places while it braked.
        while not self.mover.on_route and passed < self.granted and self._along(passed) >= self._step(passed) - NEAR:
            passed += 1
        return passed

    @property
    def granted(self) -> int:
        """Index of the last place granted to the mover."""
        passed = min(max(self.mover.route_visit - self.first, 0), self.bound)
        return max(min(self.mover.route_granted - self.first, self.bound), passed)

    @property
    def in_motion(self) -> bool:
        return math.hypot(self.mover.velocity_x, self.mover.velocity_y) > STANDS

    @property
    def rests(self) -> bool:
        """True if the mover is at rest at the centre of a place of its route."""
        return not self.in_motion and self.off_way() <= NEAR and self._is_in(self.passed)

    @property
    def there(self) -> bool:
        return self.feedback is None or self.feedback.done

    @property
    def is_told(self) -> bool:
        """True if a command is in progress."""
        return self.feedback is not None and self.feedback.busy

    def fault(self) -> str | None:
        """Returns the reason why the mover no longer follows its route; None if it does."""
        if self.feedback is None or self.feedback.busy or self.feedback.done:
            return None
        return why_not_on(self.mover, self.feedback)

    def off_way(self) -> float:
        """Returns the distance [mm] of the mover from the segment of its route between the last place reached and the
        next one."""
        here, passed = (self.mover.x, self.mover.y), self.passed
        if passed == self.last:
            return math.dist(here, self.points[-1])
        (x, y), (dx, dy) = self.points[passed], self._direction(passed)
        along = min(max(self._along(passed), 0.0), self._step(passed))
        return math.dist(here, (x + along * dx, y + along * dy))

    def stops_at(self, dynamics: Mapping[str, Any], later: float) -> int:
        """Returns the index of the first place at which the mover can come to rest if the command for it takes effect
        within `later` [s]. dynamics: velocity, acceleration, jerk of its motion."""
        passed, granted = self.passed, self.granted
        if passed >= granted or (not self.in_motion and self._is_in(passed)):
            return passed
        straight = passed + 1
        while straight < granted and self._direction(straight) == self._direction(passed):
            straight += 1
        dx, dy = self._direction(passed)
        velocity = self.mover.velocity_x * dx + self.mover.velocity_y * dy
        # The mover may be accelerating: its speed is then higher when it starts to brake.
        a, jerk = dynamics["acceleration"], dynamics["jerk"]
        fastest = min(max(velocity, 0.0) + a * a / (2 * jerk) + a * later, max(dynamics["velocity"], velocity))
        ramp = fastest / a + a / jerk if fastest > a * a / jerk else 2 * math.sqrt(fastest / jerk)
        needed = self._along(passed) + fastest * (ramp / 2 + later + a / jerk)
        visit = passed + 1
        while visit < straight and math.dist(self.points[passed], self.points[visit]) < needed:
            visit += 1
        return visit

    def _is_in(self, place: int) -> bool:
        return math.dist((self.mover.x, self.mover.y), self.points[place]) <= 2 * NEAR

    def _step(self, place: int) -> float:
        return math.dist(self.points[place], self.points[place + 1])

    def _direction(self, place: int) -> tuple[int, int]:
        """Returns the direction from this place to the next one, along X or Y."""
        (x, y), (to_x, to_y) = self.points[place], self.points[place + 1]
        dx, dy = to_x - x, to_y - y
        return (int(math.copysign(1, dx)), 0) if abs(dx) > abs(dy) else (0, int(math.copysign(1, dy)))

    def _along(self, place: int) -> float:
        """Returns the displacement [mm] of the mover from this place towards the next one."""
        (x, y), (dx, dy) = self.points[place], self._direction(place)
        return (self.mover.x - x) * dx + (self.mover.y - y) * dy


def why_not_on(mover: Mover, feedback: Feedback) -> str:
    """Returns the sentence that says why the route of a mover ended before its last place."""
    if mover.state.value != "Enabled":
        return f"mover {mover.name} is {mover.state.value} on its way"
    return f"mover {mover.name} does not go its way any more: {feedback.sentence or 'it was halted'}"


def parts_of_route(first: int, visits: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Returns the arguments of the set_route commands of a route, VISITS_A_COMMAND visits in each; the feedback of the
    first command is that of the route."""
    return [
        {"first": first + k, "continues": k > 0, "visits": list(visits[k : k + VISITS_A_COMMAND])}
        for k in range(0, len(visits), VISITS_A_COMMAND)
    ]


def answers_within(session: Session, in_process_s: float) -> float:
    """Returns the time [s] from an observed state to the effect of a command sent in response: ANSWER_S over LCM, else
    `in_process_s`."""
    from takt.remote import RemoteSession

    return ANSWER_S if isinstance(session, RemoteSession) else in_process_s
