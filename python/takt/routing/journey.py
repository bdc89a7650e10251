"""Movers on their planned routes: commanded as far as the order of passing allows, and farther while they move."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from takt.errors import TimeoutError
from takt.feedback import DEFAULT_TIMEOUT_S, Feedback
from takt.routing.plan import STANDS, RoutePlan, Target, plan_routes
from takt.routing.streets import SAME, RoutingError, Streets

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session

LOOK_S = 0.005  # [s] engine time between two checks of the movers
NEAR = 0.05  # [mm] admissible deviation of a mover from its position
TRIES = 3


class _InterruptedError(RoutingError):
    """A mover no longer follows its command."""


class _Traveller:
    """One mover of the plan. Its level is the number of its hops that are released."""

    def __init__(self, number: int, mover: Mover, plan: RoutePlan) -> None:
        self.mover = mover
        self.plan = plan
        self.number = number
        self.steps = plan.steps[number]
        self.way = [plan.task.starts[number].street]  # streets, one after the other
        self.reach = [0]  # by level: index in `way` of the street on which it ends
        for step in self.steps:
            self.way += step.hop.sweep.streets[1:]
            self.reach.append(len(self.way) - 1)
        self.at = 0  # index in `way` of the present street
        self.s = plan.task.starts[number].s
        self.over = 0  # hops completed
        self.level = 0  # hops released
        self.sent: tuple[int, float] | None = None  # level and position [mm] of the last command
        self.feedback: Feedback | None = None
        self.waited_s = 0.0
        self.arrived_s = math.nan

    @property
    def there(self) -> bool:
        last = (len(self.steps), self.plan.ends[self.number])
        return self.over == len(self.steps) and self.sent == last and (self.feedback is None or self.feedback.done)

    def look(self, streets: Streets) -> None:
        """Updates the position of the mover and the number of hops completed."""
        while True:  # both from one message
            track = self.mover.track
            self.s = self.mover.track_position
            if self.mover.track == track:
                break
        for at in range(self.at, self.reach[self.level] + 1):
            if self.way[at] == track - 1:
                self.at = at
                break
        while self.over < self.level and self._is_over(streets):
            self.over += 1

    def _is_over(self, streets: Streets) -> bool:
        hop, end = self.steps[self.over].hop, self.reach[self.over + 1]
        if self.at != end:
            return self.at > end
        if not hop.to_row:
            return abs(self.s - hop.place) < NEAR
        return streets[hop.street].first - NEAR <= self.s <= streets[hop.street].last + NEAR

    @property
    def may_plan_on(self) -> bool:
        """True if the next hop may be released; if the last one released ends with a stop, only after that stop."""
        last = self.steps[self.level - 1].hop if self.level else None
        stops = last is not None and (not last.to_row or len(self.steps[self.level].hop.sweep.streets) == 1)
        return not stops or self.over == self.level

    def destination(self, level: int, row: _Row | None) -> float:
        """Returns the end position of this level [mm along its last street]."""
        street = self.plan.task.streets[self.way[self.reach[level]]]
        ends = level == len(self.steps)
        if not ends:
            hop = self.steps[level].hop
            s = hop.sweep.end if hop.backward else hop.sweep.start
        else:
            s = self.plan.ends[self.number]
        if row is None or (level > 0 and not self.steps[level - 1].hop.to_row) or not street.in_row(s):
            return s
        if not ends and hop.backward and row.next != (self.number, level):
            s = street.last  # other hops of this row come first
        if row.most:
            return min(s, row.most.get(self.number, s))
        return street.last if ends else s

    def go_on(self, streets: Streets, rows: Mapping[int, _Row]) -> None:
        """Commands the mover to the end of its level, or as far as the engine finds the planned route by itself."""
        least = self.sent[0] if self.sent else 0
        for level in range(self.level, least - 1, -1):
            rest = self.way[self.at : self.reach[level] + 1]
            if len(rest) > 1 and not streets.is_the_way(rest):
                continue
            s = self.destination(level, rows.get(rest[-1]))
            if self.sent == (level, s):
                return
            first, self.sent = self.sent is None, (level, s)
            if first and len(rest) == 1 and abs(s - self.s) < SAME:
                return
            options: dict[str, Any] = dict(self.plan.dynamics)
            if self.plan.gap is not None:
                options["gap"] = self.plan.gap
            track = "" if streets[rest[-1]].closed else streets[rest[-1]].name
            self.feedback = self.mover.move_on_track(position=s, track=track, **options)
            return


@dataclass(frozen=True)
class _Row:
    """A row that has yet to make room for hops, before its movers take their final positions."""

    next: tuple[int, int]  # the hop that changes it next: mover, number
    most: Mapping[int, float]  # by mover: upper bound of its position [mm]


class Journey:
    """Execution of a plan: call `scan` from time to time, or `wait`."""

    def __init__(self, session: Session, plan: RoutePlan) -> None:
        self.session = session
        self.plan = plan
        self.started_s = session.now
        self._all = [_Traveller(i, session.mover(plan.names[i]), plan) for i in sorted(plan.ends)]
        self._by_number = {t.number: t for t in self._all}
        self._looked_s = -math.inf

    @property
    def arrived_s(self) -> dict[str, float]:
        """By mover: time of arrival at its final position, from the start on [s]; NaN until then."""
        return {t.mover.name: t.arrived_s - self.started_s for t in self._all}

    @property
    def waited_s(self) -> dict[str, float]:
        """By mover: time at rest before its arrival [s]."""
        return {t.mover.name: t.waited_s for t in self._all}

    @property
    def duration_s(self) -> float:
        """Time until the last mover arrived [s]; valid once all have."""
        return max(self.arrived_s.values(), default=0.0)

    def scan(self) -> bool:
        """Commands the movers whose turn it is. Returns True once all have arrived; False if it is called again within
        LOOK_S. Raises RoutingError if a mover no longer follows its commands."""
        now = self.session.now
        elapsed = now - self._looked_s
        if elapsed < LOOK_S:
            return False
        self._looked_s = now
        streets = self.plan.task.streets
        for one in self._all:
            if math.isnan(one.arrived_s):
                one.look(streets)
                self._check(one)
                if elapsed < math.inf and abs(one.mover.track_velocity) < NEAR:
                    one.waited_s += elapsed
        rows = self._rows()
        for one in self._all:
            while one.level < len(one.steps) and one.may_plan_on and self._may(one):
                one.level += 1
            if math.isnan(one.arrived_s):
                one.go_on(streets, rows)
            if one.there and math.isnan(one.arrived_s):
                one.arrived_s = now
        return all(one.there for one in self._all)

    def _rows(self) -> dict[int, _Row]:
        rows = {}
        for street, shifts in self.plan.shifts.items():
            left = [shift for shift in shifts if self._by_number[shift.hop[0]].over <= shift.hop[1]]
            if any(shift.compact for shift in left):
                rows[street] = _Row(left[0].hop, left[0].most)
        return rows

    def _may(self, one: _Traveller) -> bool:
        hop = one.steps[one.level].hop
        if hop.comes_back(self.plan.task.streets[hop.street]):
            # The row makes room for this hop when its turn has come.
            for shift in self.plan.shifts[hop.street]:
                if shift.hop == (one.number, one.level):
                    break
                if self._by_number[shift.hop[0]].over <= shift.hop[1]:
                    return False
        return all(self._by_number[i].over > k for i, k in one.steps[one.level].after)

    def _check(self, one: _Traveller) -> None:
        name, state = one.mover.name, one.mover.state.value
        if state != "Enabled":
            raise _InterruptedError(f"mover {name} is {state} on its way")
        if one.feedback is not None and (one.feedback.error or one.feedback.aborted):
            raise _InterruptedError(f"mover {name} does not go its way any more: {one.feedback.sentence}")

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S) -> Journey:
        """Lets engine time pass until all movers have arrived, and returns the journey. Raises TimeoutError, with the
        movers that are late, after `timeout` [s], and RoutingError if a mover no longer follows its commands."""
        try:
            self.session.wait(self.scan, timeout)
        except TimeoutError:
            movers = list(self.session.movers)
            late = [
                t.mover.name + (f" (waits for {movers[t.mover.waits_for - 1]})" if t.mover.waits_for else "")
                for t in self._all
                if not t.there
            ]
            raise TimeoutError(f"not there within {timeout:g} s: {', '.join(late)}") from None
        self.session._catch_up(max((t.feedback.cycle for t in self._all if t.feedback), default=0))
        return self

    def halt(self) -> None:
        """Halts all enabled movers that have not arrived, and waits until the movers of the plan are at rest."""
        going = [t.mover for t in self._all if not t.there and t.mover.state.value == "Enabled"]
        for feedback in [mover.halt() for mover in going]:
            feedback.wait_final()
        # A mover that is disabled, or has a fault, may brake for longer than the others.
        self.session.wait(lambda: all(abs(t.mover.track_velocity) < STANDS for t in self._all))


def move_on_tracks(
    session: Session,
    targets: Mapping[str, Target],
    *,
    route: Literal["auto", "shortest"],
    may_move: bool | Iterable[str],
    gap: float | None,
    timeout: float,
    **dynamics: Any,
) -> dict[str, float]:
    """Implements Session.move_on_tracks."""
    if route not in ("auto", "shortest"):
        raise ValueError(f"route is one of auto, shortest, not {route!r}")
    start, tries = session.now, 1
    if route == "shortest":
        options: dict[str, Any] = dynamics if gap is None else {**dynamics, "gap": gap}
        moves = {
            m: session.mover(m).move_on_track(position=s, track=track, **options) for m, (track, s) in targets.items()
        }
        for move in moves.values():
            move.wait(max(start + timeout - session.now, 0.0))
        return {m: move.time_s - start for m, move in moves.items()}
    while True:
        plan = plan_routes(session, targets, may_move=may_move, gap=gap, **dynamics)
        journey = Journey(session, plan)
        try:
            journey.wait(max(start + timeout - session.now, 0.0))
            return {m: s + journey.started_s - start for m, s in journey.arrived_s.items()}
        except _InterruptedError as interruption:
            journey.halt()
            if tries == TRIES:
                raise RoutingError(f"given up after {tries} plans: {interruption}") from None
            tries += 1
