"""One mover on its planned route over the free surface: sent straight on as far as it is its turn, and further while it
moves.

A place is its turn when the mover that visits it before has left it, or is ahead on its way straight through it, in the
same lane: then it cannot be overtaken, and the guard beneath keeps both apart.

With a timetable the mover starts a whole leg of its plan as soon as all places of the leg are expected to be free on
arrival, given the present delays of the other movers: the motion of the plan, without braking. If a place is not
granted at the last moment at which the mover can stop before it, it stops, and places are granted one by one then.

A mover in an enabled group is sent only where others have left, so what it reserves there is free: else its command
would be refused. From rest its commands are buffered ones, which wait; one further on that is refused while it moves
is given again a little later.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

from takt.feedback import QUEUE_FULL, Feedback
from takt.routing.raster import APART, NEAR, Point, extent_of
from takt.routing.streets import RoutingError
from takt.routing.timetable import Leg, Timetable

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session

STANDS = 1e-3  # mm/s
DYNAMICS = ("velocity", "acceleration", "jerk")
COLLISION = 3024  # error number of a command that something is in the way of
AGAIN = 8  # looks, until a command that was refused so is given again
ANSWER_S = 0.1  # over LCM: from an observed state to the effect of the command that answers it
PATIENCE_S = 10.0  # a leg is put off by delays of others for no longer; then places are granted one by one
Before = tuple["Traveller", int]  # a visit of another mover


class Traveller:
    """One mover, and the middles of the places that it visits; the first is where it is now."""

    def __init__(self, mover: Mover, points: Sequence[Point]) -> None:
        self.mover = mover
        self.points = list(points)
        self.before: list[Before | None] = [None] * len(points)  # by visit: the one that has to be over before
        self.directions = [_direction(a, b) for a, b in zip(self.points, self.points[1:], strict=False)]
        self.passed = 0  # the last place whose middle it has reached
        self.granted = 0  # the last place that is its turn
        self.sent = 0  # the last place that it was told
        self.told: Point | None = None  # where its command in progress ends
        self.feedback: Feedback | None = None
        self.grouped = is_grouped(mover)
        self._size = max(extent_of(mover)) + APART
        self._before_that: tuple[Feedback | None, int, Point | None] | None = None  # what it goes on with if refused
        self._pause = 0
        self.halts = False  # that is of a halt
        self.timetable: Timetable | None = None
        self.arrived_s = math.nan if self.directions else 0.0

    @property
    def is_told(self) -> bool:
        """A command is in progress."""
        return self.feedback is not None and self.feedback.busy

    @property
    def rests(self) -> bool:
        """At the place that it was told."""
        return self.passed == self.sent and (self.feedback is None or self.feedback.done)

    @property
    def there(self) -> bool:
        return self.passed == len(self.directions) and self.rests

    @property
    def in_motion(self) -> bool:
        return math.hypot(self.mover.velocity_x, self.mover.velocity_y) > STANDS

    @property
    def held_by(self) -> Mover | None:
        """The mover that has its next place before."""
        if self.granted == len(self.directions) or (before := self.before[self.granted + 1]) is None:
            return None
        return before[0].mover

    def along(self) -> float:
        """mm from the place that it has passed towards the next one."""
        (x, y), (dx, dy) = self.points[self.passed], self.directions[self.passed]
        return (self.mover.x - x) * dx + (self.mover.y - y) * dy

    def has_left(self, visit: int) -> bool:
        """No part of the mover covers the place of this visit any more."""
        if self.passed != visit or visit == len(self.directions):
            return self.passed > visit
        pitch = math.dist(self.points[visit], self.points[visit + 1])
        return self.along() >= (pitch + min(self._size, pitch)) / 2 - NEAR

    def look(self, as_far_as: int | None = None) -> None:
        """Sees which places it has passed."""
        last = self.sent if as_far_as is None else as_far_as
        while self.passed < last:
            if self.along() < math.dist(self.points[self.passed], self.points[self.passed + 1]) - NEAR:
                return
            self.passed += 1

    def grant(self) -> None:
        while self.granted < len(self.directions) and self._may_enter(self.granted + 1):
            self.granted += 1

    def _may_enter(self, visit: int) -> bool:
        before = self.before[visit]
        if before is None or before[0] is self:
            return True
        other, its = before
        if self.grouped:
            return other.passed > its  # what is reserved for it ends there
        if other.has_left(its):
            return True
        direction = self.directions[visit - 1]
        if other.granted <= its or other.directions[its] != direction:
            return False
        return all(other.directions[k] == direction for k in range(other.passed, its))

    def go_on(self, dynamics: Mapping[str, Any], now_s: float = 0.0, later_s: float = 0.0) -> None:
        """Sends it straight on as far as it may go.

        now_s: time since the start of the plan. later_s: most time until a command takes effect."""
        if self._pause > 0:
            self._pause -= 1
            return
        if self.timetable is not None and not self.grouped:
            self.timetable.passed(self.passed, rests=self.rests)
            leg = self.timetable.leg
            if leg is not None and self._goes_by_time(self.timetable, leg, dynamics, now_s, later_s):
                return
        if self.rests or self.passed < self.sent:
            first = self.passed
        elif self.sent > 0 and self.feedback is not None:
            first = self.sent - 1  # in this direction it goes already
        else:
            return
        last = first
        while last < self.granted and self.directions[last] == self.directions[first]:
            last += 1
        if last <= self.passed or (self.rests and self._would_run_up(first, dynamics)):
            return
        if self.points[last] == self.told and not self.rests:
            self.sent = last  # it goes there already
            return
        if self.timetable is not None:
            self.timetable.disturbed()
        self._send(last, dynamics)

    def _send(self, last: int, dynamics: Mapping[str, Any]) -> None:
        x, y = self.points[last]
        starts = self.rests
        self._before_that = None if starts else (self.feedback, self.sent, self.told)
        waits = self.grouped and starts and not self.mover.buffered  # else it takes over from what waits
        mode: Literal["buffered", "aborting"] = "buffered" if waits else "aborting"
        self.feedback = self.mover.move_to_position(x=x, y=y, use_orientation=False, buffer_mode=mode, **dynamics)
        self.sent, self.told = last, (x, y)

    def _goes_by_time(
        self, timetable: Timetable, leg: Leg, dynamics: Mapping[str, Any], now_s: float, later_s: float
    ) -> bool:
        """Starts and supervises the leg. False: places are granted one by one."""
        if timetable.late_s is None:
            begins_s = self._begins(timetable, leg, now_s)
            if not self.rests or self.passed != leg.first or begins_s == math.inf:
                return False
            if now_s > max(begins_s, leg.departure_s) + PATIENCE_S:
                return False
            if now_s >= begins_s:
                timetable.late_s = now_s - leg.departure_s
                self._send(leg.last, dynamics)
            return True
        if not timetable.holds:
            return False
        for visit in range(self.granted + 1, leg.last + 1):
            if now_s + later_s < timetable.entries_s[visit] + timetable.late_s:
                break
            self.stop_where_granted(dynamics)
            break
        return True

    def stop_where_granted(self, dynamics: Mapping[str, Any]) -> None:
        """Ends a leg that was started by time at the last place that is granted."""
        if self.sent > self.granted and self.timetable is not None:
            self.timetable.disturbed()
            self._send(self.granted, dynamics)

    def _begins(self, timetable: Timetable, leg: Leg, now_s: float) -> float:
        """Returns the earliest start of the leg, in s since the start of the plan, at which each place is free on
        arrival; inf if a mover that has to pass first has an unknown delay."""
        begins_s = -math.inf
        for visit in range(leg.first + 1, leg.last + 1):
            before = self.before[visit]
            if before is None or before[0] is self or before[0].has_left(before[1]):
                continue
            other, its = before
            if other.timetable is None:
                return math.inf
            late = other.timetable.late(its, now_s)
            if other.directions[its] == self.directions[visit - 1]:  # it follows that one
                begins_s = max(begins_s, leg.departure_s + late)
            else:
                ahead_s = timetable.entries_s[visit] - leg.departure_s
                begins_s = max(begins_s, other.timetable.left_s[its] + late - ahead_s)
        return begins_s

    def _would_run_up(self, first: int, dynamics: Mapping[str, Any]) -> bool:
        """It rests behind a mover that goes the same way, and would have to brake for it. The guard lets it go no
        further than it could stop behind where that is now: so it starts later by the time that takes at full speed."""
        before = self.before[first + 1]
        if before is None or before[0] is self or before[0].passed > before[1]:
            return False
        leader, (dx, dy) = before[0].mover, self.directions[first]
        ahead = (leader.x - self.mover.x) * dx + (leader.y - self.mover.y) * dy
        needed = math.dist(self.points[first], self.points[first + 1]) + _lead(**{k: dynamics[k] for k in DYNAMICS})
        return ahead < needed

    def fault(self) -> str | None:
        """Why it does not go its way any more."""
        if self.is_told:
            return None  # else that would have ended
        if self.mover.state.value != "Enabled":
            return f"mover {self.mover.name} is {self.mover.state.value} on its way"
        feedback = self.feedback
        if feedback is None or feedback.busy or feedback.done:
            return None
        if feedback.error_id == QUEUE_FULL:
            self.stay()
            return None
        if self.grouped and feedback.error_id == COLLISION and feedback.object in self.mover.session.movers.values():
            # Refused because of its group, which has changed nothing: it goes where it went.
            self._pause = AGAIN
            if self._before_that is None:
                self.stay()
                return None
            (self.feedback, self.sent, self.told), self._before_that = self._before_that, None
            return self.fault()
        return f"mover {self.mover.name} does not go its way any more: {feedback.sentence or 'it was halted'}"

    def stay(self) -> None:
        """It has no command any more: it goes on from the place that it has passed."""
        self.feedback, self.told, self.sent = None, None, self.passed
        if self.timetable is not None and self.timetable.late_s is not None:
            self.timetable.disturbed()

    def check_on_way(self) -> None:
        """It is where it can go on from: between the place that it has passed and the next one."""
        if (off := self.off_way()) > NEAR:
            raise RoutingError(f"mover {self.mover.name} is {off:.6g} mm off its route: plan anew", self.mover.name)

    def off_way(self) -> float:
        here = self.mover.x, self.mover.y
        if self.passed == len(self.directions):
            return math.dist(here, self.points[-1])
        (x, y), (dx, dy) = self.points[self.passed], self.directions[self.passed]
        length = math.dist(self.points[self.passed], self.points[self.passed + 1])
        along = min(max(self.along(), 0.0), length)
        return math.dist(here, (x + along * dx, y + along * dy))

    def stops_at(self, dynamics: Mapping[str, Any], later: float) -> int:
        """The first visit at which it can come to rest if it is told so within `later` s."""
        if self.rests or self.sent == self.passed:
            return self.passed
        dx, dy = self.directions[self.passed]
        velocity = self.mover.velocity_x * dx + self.mover.velocity_y * dy
        # It may be speeding up: then it is faster before it brakes.
        a, jerk = dynamics["acceleration"], dynamics["jerk"]
        fastest = min(max(velocity, 0.0) + a * a / (2 * jerk) + a * later, max(dynamics["velocity"], velocity))
        ramp = fastest / a + a / jerk if fastest > a * a / jerk else 2 * math.sqrt(fastest / jerk)
        needed = self.along() + fastest * (ramp / 2 + later + a / jerk)
        visit = self.passed + 1
        while visit < self.sent and math.dist(self.points[self.passed], self.points[visit]) < needed:
            visit += 1
        return visit


def answers_within(session: Session, in_process_s: float) -> float:
    """s until a command takes effect that answers an observed state."""
    from takt.remote import RemoteSession

    return ANSWER_S if isinstance(session, RemoteSession) else in_process_s


def is_grouped(mover: Mover) -> bool:
    """It is in a group that watches."""
    if not mover.group:
        return False
    return list(mover.session.planar_groups.values())[mover.group - 1].state.value == "Enabled"


@cache
def _lead(velocity: float, acceleration: float, jerk: float) -> float:
    """mm that a leader goes from rest in the time that it takes to brake from this velocity, on average."""
    time = 1.05 * ((velocity / acceleration + acceleration / jerk) / 2 + acceleration / jerk)  # it may speed up yet
    ramp = acceleration / jerk
    if time < ramp:
        return jerk * time**3 / 6
    return min(acceleration * ((time - ramp / 2) ** 2 / 2 + ramp**2 / 24), velocity * time)


def _direction(a: Point, b: Point) -> tuple[int, int]:
    dx, dy = b[0] - a[0], b[1] - a[1]
    return (int(math.copysign(1, dx)), 0) if abs(dx) > abs(dy) else (0, int(math.copysign(1, dy)))
