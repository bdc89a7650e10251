"""Movers on their planned routes over the free surface: as far as the order of visits allows (traveller.py), not by the
clock: a mover that is late holds up those behind it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from takt import _core
from takt.errors import TimeoutError
from takt.feedback import DEFAULT_TIMEOUT_S
from takt.routing.streets import RoutingError
from takt.routing.surface import SurfacePlan, Targets, Visit, plan_surface
from takt.routing.timetable import Leg, Timetable
from takt.routing.traveller import Traveller, answers_within

if TYPE_CHECKING:
    from takt.session import Session


def dynamics_of(plan: SurfacePlan) -> dict[str, Any]:
    """What all commands of a plan have in common."""
    return {**plan.dynamics, "deceleration": plan.dynamics["acceleration"], "reference": plan.raster.reference}


def travellers_of(session: Session, plan: SurfacePlan) -> list[Traveller]:
    made = [
        Traveller(session.mover(name), [plan.raster.middle(visit.place) for visit in visits])
        for name, visits in zip(plan.names, plan.visits, strict=True)
    ]
    for one, visits in zip(made, plan.visits, strict=True):
        one.before = [None if visit.before is None else (made[visit.before[0]], visit.before[1]) for visit in visits]
        one.timetable = _timetable(plan, one.mover.name, visits)
    return made


def _timetable(plan: SurfacePlan, name: str, visits: Sequence[Visit]) -> Timetable:
    legs, first = [], 0
    for leg in plan.legs[name]:
        last = first + round(math.dist(leg.start, leg.end) / plan.raster.pitch)
        legs.append(Leg(leg.departure_s, leg.arrival_s, first, last))
        first = last
    return Timetable(legs, [visit.entry_s for visit in visits], [visit.left_s for visit in visits])


class SurfaceJourney:
    """A plan that is carried out. `scan` in every cycle, or `wait`.

    If a mover is halted, disabled, or refuses a command, RoutingError says so, and all others come to rest where it was
    their turn. Once it can move again, `wait` goes on: the order is still good.
    """

    def __init__(self, session: Session, plan: SurfacePlan) -> None:
        self.session = session
        self.plan = plan
        self.started_s = session.now
        self._all = travellers_of(session, plan)
        self._left = [one for one in self._all if one.directions]
        self._interrupted = False
        self._dynamics = dynamics_of(plan)
        # The entries of a plan are early by surface_early_s already.
        self._later_s = answers_within(session, session.period - _core.surface_early_s)
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
        now_s = self.session.now - self.started_s
        for one in self._left:
            one.look()
        self._check()
        for one in self._left:
            one.grant()
        for one in self._left:
            one.go_on(self._dynamics, now_s, self._later_s)
            if one.there:
                one.arrived_s = self.session.now - self.started_s
        self._left = [one for one in self._left if math.isnan(one.arrived_s)]
        return not self._left

    def _check(self) -> None:
        for one in self._left:
            if (sentence := one.fault()) is not None:
                self._come_to_rest()
                raise RoutingError(sentence, one.mover.name)

    def _come_to_rest(self) -> None:
        """Each where it was its turn; `scan` goes on from there."""
        self._interrupted = True
        for one in self._left:
            one.grant()
            if one.is_told:
                one.stop_where_granted(self._dynamics)

    def _go_on_again(self) -> None:
        for one in self._left:
            if one.feedback is not None and not one.feedback.busy and not one.feedback.done:
                if one.in_motion:
                    raise RoutingError(f"mover {one.mover.name} is still in motion")
                one.look()  # it went on while it braked
                one.check_on_way()
                one.stay()
        self._interrupted = False

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S) -> SurfaceJourney:
        """Lets engine time pass until all are there.

        If that is not within `timeout` [s] (TimeoutError, says which are late and why) or is broken off, all come to
        rest where it was their turn, and a further `wait` goes on.
        """
        try:
            self.session.wait(self.scan, timeout)
        except TimeoutError:
            late = [t.mover.name + self._reason(t) for t in self._left]
            self._come_to_rest()
            raise TimeoutError(f"not there within {timeout:g} s: {', '.join(late)}") from None
        except BaseException:
            if not self._interrupted:
                self._come_to_rest()
            raise
        self.session._catch_up(max((t.feedback.cycle for t in self._all if t.feedback), default=0))
        return self

    def _reason(self, one: Traveller) -> str:
        if one.mover.waits_for:
            return f" (waits for {list(self.session.movers)[one.mover.waits_for - 1]})"
        if (holder := one.held_by) is not None:
            return f" (its next place is that of {holder.name} first)"
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
