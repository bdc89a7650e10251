"""Movers on their planned routes over the free surface.

The engine executes the routes, by the order of visits and not by the clock: a late mover delays those behind it. This
module sends the plan to the engine and monitors it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from takt import _core
from takt.errors import TimeoutError
from takt.feedback import DEFAULT_TIMEOUT_S, Feedback
from takt.routing.on_way import COMMANDS_A_CYCLE, STANDS, parts_of_route, why_not_on
from takt.routing.raster import NEAR, Point
from takt.routing.streets import RoutingError
from takt.routing.surface import SurfacePlan, Targets, Visit, plan_surface

if TYPE_CHECKING:
    from takt.session import Session


def dynamics_of(plan: SurfacePlan) -> dict[str, float]:
    """Returns velocity, acceleration, deceleration and jerk of all motions of a plan."""
    return {**plan.dynamics, "deceleration": plan.dynamics["acceleration"]}


class SurfaceJourney:
    """Execution of a plan by the engine: call `scan` in every cycle, or `wait`.

    If a mover is halted, disabled, or cannot continue, RoutingError is raised, and all others come to rest in the next
    places where they can. Once the mover can move again, `wait` resumes the plan: its order is still valid.
    """

    def __init__(self, session: Session, plan: SurfacePlan) -> None:
        self.session = session
        self.plan = plan
        self.started_s = session.now
        self._numbers = {name: number for number, name in enumerate(session.movers, 1)}
        self._left = [name for name, visits in zip(plan.names, plan.visits, strict=True) if len(visits) > 1]
        self._arrived_s = {name: 0.0 if name not in self._left else math.nan for name in plan.names}
        self._untold: list[tuple[str, dict[str, Any]]] = []
        self._told: list[tuple[str, Feedback]] = []
        self._feedbacks: dict[str, Feedback] = {}  # of the routes
        self._start: Feedback | None = None  # None: the engine does not have all routes yet
        self._interrupted = False
        for name, visits in zip(plan.names, plan.visits, strict=True):
            self._check_start(name, plan.raster.middle(visits[0].place))
        self._tell_anew()

    @property
    def arrived_s(self) -> dict[str, float]:
        """By mover: time of arrival at its final position, from the start on [s]; NaN until then."""
        return dict(self._arrived_s)

    @property
    def duration_s(self) -> float:
        """Time until the last mover arrived [s]; valid once all have."""
        return max(self._arrived_s.values(), default=0.0)

    def scan(self) -> bool:
        """Updates arrivals, and returns True once all movers have arrived. Raises RoutingError if the engine rejects a
        route or a mover no longer follows its own."""
        if self._interrupted:
            self._go_on_again()
        self._check()
        if self._left and self._start is None:
            self._tell()
        for name in [name for name in self._left if name in self._feedbacks and self._feedbacks[name].done]:
            self._left.remove(name)
            self._arrived_s[name] = self._feedbacks[name].cycle * self.session.period - self.started_s
        return not self._left

    def _check_start(self, name: str, point: Point) -> None:
        mover = self.session.mover(name)
        if (off := math.dist((mover.x, mover.y), point)) > NEAR:
            raise RoutingError(f"mover {name} is {off:.6g} mm off its route: plan anew", name)

    def _routes(self) -> Iterator[tuple[str, dict[str, Any]]]:
        """Yields the names of movers and the arguments of the commands that give them their routes."""
        first = {name: self.session.mover(name).route_visit for name in self.plan.names}
        for name, visits in zip(self.plan.names, self.plan.visits, strict=True):
            if name in self._left:
                for part in parts_of_route(first[name], self._visits_of(name, visits, first)):
                    yield name, part

    def _tell(self) -> None:
        """Sends the routes, in each call as many commands as the engine accepts in a cycle, then starts all at once."""
        now, self._untold = self._untold[:COMMANDS_A_CYCLE], self._untold[COMMANDS_A_CYCLE:]
        for name, route in now:
            given = self.session.mover(name).set_route(**route)
            self._told.append((name, given))
            self._feedbacks.setdefault(name, given)
        if not self._untold:
            movers = [self._numbers[name] for name in self._feedbacks]
            self._start = self.session.command("machine", "start_routes", {**dynamics_of(self.plan), "movers": movers})

    def _tell_anew(self) -> None:
        self._untold = list(self._routes())
        self._told, self._feedbacks, self._start = [], {}, None

    def _visits_of(self, name: str, visits: Sequence[Visit], first: Mapping[str, int]) -> list[dict[str, Any]]:
        plan, told = self.plan, []
        for visit in visits:
            x, y = plan.raster.middle(visit.place)
            # The entry times of a plan are early by surface_early_s, for a program that polls.
            times = {"entry_time": visit.entry_s + _core.surface_early_s, "exit_time": visit.left_s}
            told.append({"x": x, "y": y, **{key: max(value, 0.0) for key, value in times.items()}})
            if visit.before is not None and visit.before[0] != plan.names.index(name):
                other = plan.names[visit.before[0]]
                told[-1] |= {"after": self._numbers[other], "after_visit": first[other] + visit.before[1]}
        at = 0
        for leg in plan.legs[name]:
            told[at]["departure_time"] = leg.departure_s
            at += round(math.dist(leg.start, leg.end) / plan.raster.pitch)
            told[at]["arrival_time"] = leg.arrival_s
        return told

    def _check(self) -> None:
        for name, given in self._told:
            if given.error:
                self._tell_anew()
                raise RoutingError(f"mover {name}: {given.sentence}", name)
        if self._start is not None and self._start.error:
            sentence, culprit = self._start.sentence, self._start.object
            self._tell_anew()
            raise RoutingError(sentence, culprit.name if culprit else "")
        if self._start is not None and self._start.done:
            self._told = []
        for name in self._feedbacks:
            if name in self._left and (why := self._fault(name)) is not None:
                self._come_to_rest()
                raise RoutingError(why, name)

    def _fault(self, name: str) -> str | None:
        """Returns the reason why the mover no longer follows its route; None if it does."""
        feedback = self._feedbacks[name]
        return None if feedback.busy or feedback.done else why_not_on(self.session.mover(name), feedback)

    def _come_to_rest(self) -> None:
        """Lets all movers come to rest in places; `scan` resumes from there."""
        self._interrupted = self._start is not None
        if self._interrupted:
            self._hold(True)

    def _hold(self, hold: bool) -> None:
        self.session.command("machine", "hold_routes", {"hold": hold, "movers": [self._numbers[n] for n in self._left]})

    def _go_on_again(self) -> None:
        for name in self._left:
            feedback, mover = self._feedbacks[name], self.session.mover(name)
            if feedback.busy or feedback.done:
                continue
            if math.hypot(mover.velocity_x, mover.velocity_y) > STANDS:
                raise RoutingError(f"mover {name} is still in motion")
            self._feedbacks[name] = mover.continue_route()
        self._hold(False)
        self._interrupted = False

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S) -> SurfaceJourney:
        """Lets engine time pass until all movers have arrived, and returns the journey.

        Raises TimeoutError, with the movers that are late and why, after `timeout` [s], and RoutingError as `scan`
        does. After these, or another interruption, all movers come to rest in the next places where they can, and a
        further `wait` resumes the plan.
        """
        try:
            self.session.wait(self.scan, timeout)
        except TimeoutError:
            late = [name + self._reason(name) for name in self._left]
            self._come_to_rest()
            raise TimeoutError(f"not there within {timeout:g} s: {', '.join(late)}") from None
        except BaseException:
            if not self._interrupted:
                self._come_to_rest()
            raise
        self.session._catch_up(max((feedback.cycle for feedback in self._feedbacks.values()), default=0))
        return self

    def _reason(self, name: str) -> str:
        mover, names = self.session.mover(name), list(self.session.movers)
        if mover.waits_for:
            return f" (waits for {names[mover.waits_for - 1]})"
        if mover.delay.value == "place":
            return f" (its next place is that of {names[mover.blocker - 1]} first)"
        return ""

    def halt(self) -> None:
        """Halts all enabled movers that have not arrived, and waits until they are at rest. `wait` resumes the plan."""
        going = [self.session.mover(name) for name in self._left]
        for feedback in [mover.halt() for mover in going if mover.state.value == "Enabled"]:
            feedback.wait_final()
        self._interrupted = self._start is not None


def move_on_surface(
    session: Session,
    targets: Targets,
    *,
    movers: Iterable[str] | None,
    may_move: bool | Iterable[str],
    timeout: float,
    **options: Any,
) -> dict[str, float]:
    """Implements Session.move_on_surface."""
    plan = plan_surface(session, targets, movers=movers, may_move=may_move, **options)
    journey = SurfaceJourney(session, plan).wait(timeout)
    return {name: journey.arrived_s[name] for name in plan.targets}
