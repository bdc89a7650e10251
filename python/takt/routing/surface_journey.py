"""Movers on their planned routes over the free surface: as far as the order of visits allows, extended while they move.

Each is sent straight on to the last place that is its turn. A place is its turn when the mover that visits it before
has reached the middle of its own next place, or is ahead on its way straight through it, in the same lane: then it
cannot be overtaken, and the guard beneath keeps both apart. Times do not matter: who is late holds up those behind it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from takt.errors import TimeoutError
from takt.feedback import DEFAULT_TIMEOUT_S, QUEUE_FULL, Feedback
from takt.routing.raster import NEAR, Point
from takt.routing.streets import RoutingError
from takt.routing.surface import STANDS, SurfacePlan, Targets, plan_surface

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session


class _Traveller:
    """One mover of the plan."""

    def __init__(self, number: int, mover: Mover, plan: SurfacePlan) -> None:
        self.mover = mover
        self.before = [visit.before for visit in plan.visits[number]]
        self.points = [plan.raster.middle(visit.place) for visit in plan.visits[number]]
        self.directions = [_direction(a, b) for a, b in zip(self.points, self.points[1:], strict=False)]
        self.number = number
        self.passed = 0  # the last place whose middle it has reached
        self.granted = 0  # the last place that is its turn
        self.sent = 0  # the last place that it was told
        self.feedback: Feedback | None = None
        self.arrived_s = math.nan if self.directions else 0.0

    @property
    def there(self) -> bool:
        return self.passed == len(self.directions) and (self.feedback is None or self.feedback.done)

    def look(self) -> None:
        while self.passed < self.sent:
            dx, dy = self.directions[self.passed]
            x, y = self.points[self.passed + 1]
            if (self.mover.x - x) * dx + (self.mover.y - y) * dy < -NEAR:
                return
            self.passed += 1

    def go_on(self, dynamics: Mapping[str, Any]) -> None:
        """Sends it straight on as far as it may go."""
        rests = self.passed == self.sent and (self.feedback is None or self.feedback.done)
        if rests:
            first = self.passed
        elif self.sent > 0 and self.feedback is not None:
            first = self.sent - 1  # in this direction it goes already
        else:
            return
        last = first
        while last < self.granted and self.directions[last] == self.directions[first]:
            last += 1
        if last <= self.sent:
            return
        x, y = self.points[last]
        self.feedback = self.mover.move_to_position(x=x, y=y, use_orientation=False, **dynamics)
        self.sent = last

    def check_on_way(self) -> None:
        """It is where it can go on from: between the place that it has passed and the next one."""
        here = self.mover.x, self.mover.y
        if self.passed == len(self.directions):
            off = math.dist(here, self.points[-1])
        else:
            (x, y), (dx, dy) = self.points[self.passed], self.directions[self.passed]
            along = (here[0] - x) * dx + (here[1] - y) * dy
            length = math.dist(self.points[self.passed], self.points[self.passed + 1])
            along = min(max(along, 0.0), length)
            off = math.dist(here, (x + along * dx, y + along * dy))
        if off > NEAR:
            raise RoutingError(f"mover {self.mover.name} is {off:.6g} mm off its route: plan anew")


def _direction(a: Point, b: Point) -> tuple[int, int]:
    dx, dy = b[0] - a[0], b[1] - a[1]
    return (int(math.copysign(1, dx)), 0) if abs(dx) > abs(dy) else (0, int(math.copysign(1, dy)))


def dynamics_of(plan: SurfacePlan) -> dict[str, Any]:
    """What all commands of a plan have in common."""
    return {**plan.dynamics, "deceleration": plan.dynamics["acceleration"], "reference": plan.raster.reference}


class SurfaceJourney:
    """A plan that is carried out. `scan` in every cycle, or `wait`.

    If a mover is halted, disabled, or refuses a command, RoutingError says so, and all others come to rest where it was
    their turn. Once it can move again, `wait` goes on: the order is still good.
    """

    def __init__(self, session: Session, plan: SurfacePlan) -> None:
        self.session = session
        self.plan = plan
        self.started_s = session.now
        self._all = [_Traveller(i, session.mover(name), plan) for i, name in enumerate(plan.names)]
        self._left = [one for one in self._all if one.directions]
        self._interrupted = False
        self._dynamics = dynamics_of(plan)
        for one in self._left:
            one.check_on_way()

    @property
    def arrived_s(self) -> dict[str, float]:
        """By mover: s from the start on, when it was where it stays; NaN: it is not yet."""
        return {t.mover.name: t.arrived_s for t in self._all}

    @property
    def duration_s(self) -> float:
        """s until the last one was there."""
        return max(self.arrived_s.values(), default=0.0)

    def scan(self) -> bool:
        """Lets movers go on whose turn it is. True: all are there."""
        if self._interrupted:
            self._go_on_again()
        for one in self._left:
            one.look()
            self._check(one)
        for one in self._left:
            while one.granted < len(one.directions) and self._may(one, one.granted + 1):
                one.granted += 1
        for one in self._left:
            one.go_on(self._dynamics)
            if one.there:
                one.arrived_s = self.session.now - self.started_s
        self._left = [one for one in self._left if math.isnan(one.arrived_s)]
        return not self._left

    def _may(self, one: _Traveller, visit: int) -> bool:
        before = one.before[visit]
        if before is None or before[0] == one.number:
            return True
        other, its = self._all[before[0]], before[1]
        if other.passed > its:
            return True
        direction = one.directions[visit - 1]
        if other.granted <= its or other.directions[its] != direction:
            return False
        return all(other.directions[k] == direction for k in range(other.passed, its))

    def _check(self, one: _Traveller) -> None:
        feedback = one.feedback
        if one.mover.state.value != "Enabled":
            self._interrupted = True
            raise RoutingError(f"mover {one.mover.name} is {one.mover.state.value} on its way")
        if feedback is None or feedback.busy or feedback.done:
            return
        if feedback.error_id == QUEUE_FULL:
            one.feedback, one.sent = None, one.passed
            return
        self._interrupted = True
        raise RoutingError(
            f"mover {one.mover.name} does not go its way any more: {feedback.sentence or 'it was halted'}"
        )

    def _go_on_again(self) -> None:
        for one in self._left:
            if one.feedback is not None and not one.feedback.busy and not one.feedback.done:
                if math.hypot(one.mover.velocity_x, one.mover.velocity_y) > STANDS:
                    raise RoutingError(f"mover {one.mover.name} is still in motion")
                one.look()  # it went on while it braked
                one.check_on_way()
                one.feedback, one.sent = None, one.passed
        self._interrupted = False

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S) -> SurfaceJourney:
        """Lets engine time pass until all are there."""
        try:
            self.session.wait(self.scan, timeout)
        except TimeoutError:
            late = [t.mover.name + self._reason(t) for t in self._left]
            raise TimeoutError(f"not there within {timeout:g} s: {', '.join(late)}") from None
        self.session._catch_up(max((t.feedback.cycle for t in self._all if t.feedback), default=0))
        return self

    def _reason(self, one: _Traveller) -> str:
        if one.mover.waits_for:
            return f" (waits for {list(self.session.movers)[one.mover.waits_for - 1]})"
        if one.granted < len(one.directions) and (before := one.before[one.granted + 1]) is not None:
            return f" (its next place is that of {self._all[before[0]].mover.name} first)"
        return ""

    def halt(self) -> None:
        """Brings all to rest that are not there yet. `wait` goes on."""
        going = [t for t in self._left if t.mover.state.value == "Enabled"]
        for feedback in [t.mover.halt() for t in going]:
            feedback.wait_final()
        self._interrupted = True


def move_on_surface(
    session: Session,
    targets: Targets,
    *,
    movers: Iterable[str] | None,
    may_move: bool | Iterable[str],
    timeout: float,
    **options: Any,
) -> dict[str, float]:
    """As Session.move_on_surface."""
    plan = plan_surface(session, targets, movers=movers, may_move=may_move, **options)
    journey = SurfaceJourney(session, plan).wait(timeout)
    return {name: journey.arrived_s[name] for name in plan.targets}
