"""Many movers on the free surface under a stream of orders: routes are replanned while movers are under way.

A new plan begins where each mover can come to rest: the visits up to there, which are granted already, come before all
others at their places. They end by themselves, and the rest is a plan for movers at rest: so the order of visits is
still free of deadlocks. The engine executes routes; if movers are farther along than expected when new routes arrive,
it rejects them, all movers are held, and routes are planned again from there.

A mover that fails, or is halted, is an obstacle. All others move on to where they can come to rest clear of it; those
behind it that cannot, because it covers a place granted to them, return to the last place that they have reached. A
place to which a mover returns must not be granted to another one: movers bound for it behind that mover return, too.
Then routes are planned round the obstacles. The same applies when a part leaves with places of routes.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from takt.errors import TimeoutError
from takt.feedback import DEFAULT_TIMEOUT_S
from takt.routing.on_way import COMMANDS_A_CYCLE, Before, OnWay, answers_within, parts_of_route
from takt.routing.raster import NEAR, Point, Raster, is_there, make_raster
from takt.routing.streets import RoutingError
from takt.routing.surface import (
    Options,
    Order,
    SurfacePlan,
    Targets,
    can_move,
    check_can_move,
    free_of,
    make_plan,
    names_of_key,
    orders_of,
)
from takt.routing.surface_journey import dynamics_of

if TYPE_CHECKING:
    from takt.feedback import Feedback
    from takt.mover import Mover
    from takt.session import Session

CYCLES = 8  # cycles until the engine executes new routes, in process
MOST_REFUSALS = 5  # of routes, in succession


@dataclass
class _Goal:
    """The target of a mover. Movers of one pool may exchange their targets."""

    order: SurfaceOrder
    pool: object
    target: Point | None  # None: not assigned yet, any remaining target of its pool


@dataclass
class _Started:
    """Routes that were sent to the engine, which may reject them."""

    start: Feedback
    told: list[Feedback]
    before: dict[str, OnWay]  # movers under way until then

    @property
    def busy(self) -> bool:
        return self.start.busy

    @property
    def done(self) -> bool:
        return self.start.done and not any(one.error for one in self.told)

    @property
    def refusal(self) -> Feedback:
        return next((one for one in self.told if one.error), self.start)


class SurfaceOrder:
    """Targets that were given together; `wait()` lets engine time pass until the movers have arrived."""

    def __init__(self, router: SurfaceRouter, movers: Iterable[str], started_s: float, may_move: Iterable[str]) -> None:
        self._router = router
        self.movers = tuple(movers)
        self.may_move = tuple(may_move)  # movers without a target that may be moved out of the way
        self.started_s = started_s
        self.targets: dict[str, Point] = {}  # by mover [mm]; movers of one pool may exchange theirs until they arrive
        self.arrived_s: dict[str, float] = {}  # by mover: time of arrival, from the order on [s]
        self.failed: dict[str, str] = {}  # by mover: the reason why it does not reach its target

    @property
    def done(self) -> bool:
        """True if every mover has arrived or failed."""
        return all(name in self.arrived_s or name in self.failed for name in self.movers)

    @property
    def waits(self) -> dict[str, str]:
        """By mover: the reason why it waits, if it is at rest before its target."""
        reasons = self._router.waits
        return {name: reasons[name] for name in self.movers if name in reasons}

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S) -> SurfaceOrder:
        """Lets engine time pass until all movers have arrived or failed, and returns the order. Raises TimeoutError,
        with the movers that are late, after `timeout` [s], and RoutingError, with the reasons, if movers failed."""
        session = self._router.session
        try:
            session.wait(lambda: self.done, timeout)
        except TimeoutError:
            late = [name for name in self.movers if name not in self.arrived_s and name not in self.failed]
            waits = self.waits
            said = ", ".join(name + (f" ({waits[name]})" if name in waits else "") for name in late)
            raise TimeoutError(f"not there within {timeout:g} s: {said}") from None
        if self.failed:
            raise RoutingError("; ".join(self.failed.values()), next(iter(self.failed)))
        return self

    def __repr__(self) -> str:
        there, failed = len(self.arrived_s), len(self.failed)
        return f"<SurfaceOrder: {there} of {len(self.movers)} there{f', {failed} failed' if failed else ''}>"


class SurfaceRouter:
    """Plans routes for orders as they arrive, and executes them while engine time passes.

    options: environment, pitch, origin, effort, seed, velocity, acceleration, jerk, as in takt.plan_surface; `effort`
        is 3,000 unless given.
    """

    def __init__(
        self,
        session: Session,
        *,
        environment: str | None = None,
        pitch: float | None = None,
        origin: Point | None = None,
        effort: int | None = None,
        seed: int = 1,
        **dynamics: float,
    ) -> None:
        given = Options(environment, pitch, origin, seed=seed, dynamics=dynamics)
        self.session = session
        self.given = {"environment": environment, "pitch": pitch, "origin": origin, "effort": effort, **dynamics}
        self.given = {key: value for key, value in self.given.items() if value is not None}
        if seed != 1:
            self.given["seed"] = seed
        self.options = given if effort is None else Options(environment, pitch, origin, effort, seed, dynamics)
        self.plans = 0  # number of plans so far
        self._planned: SurfacePlan | None = None  # the last one
        self.waited_s: dict[str, dict[str, float]] = defaultdict(lambda: defaultdict(float))  # mover, its blocker: [s]
        self._on_way: dict[str, OnWay] = {}
        self._goals: dict[str, _Goal] = {}
        self._back: dict[str, OnWay] = {}  # movers that return to a place; meanwhile nothing more is granted
        self._failed: set[str] = set()  # movers of `_back` that stay where they come to rest
        self._raster: Raster | None = None
        self._dynamics: dict[str, Any] = {}
        self._pending: list[_Started] = []  # routes that the engine has not answered yet
        self._held = False  # routes are being held
        self._too_late = False  # routes arrived too late: they are planned again
        self._refusals = 0  # in a row
        self._surface: tuple[object, ...] = ()
        self._seen_s = session.now
        self._later_s = answers_within(session, CYCLES * session.period)
        session.program(self.scan)

    # --- orders ---

    def route(
        self, targets: Targets, *, movers: Iterable[str] | None = None, may_move: bool | Iterable[str] = False
    ) -> SurfaceOrder:
        """Sends movers to their targets and returns the order. Those of them under way are redirected; all others under
        way keep their targets. Engine time has to pass, as in `wait()` of the order.

        targets, may_move: as in takt.plan_surface.
        movers: as in takt.plan_surface; None: all that can move and have no target yet.

        Raises RoutingError, with the reason, if there is no plan; then all movements continue unchanged.
        """
        if movers is None and not isinstance(targets, Mapping):
            movers = [name for name in free_of(self.session, True) if name not in self._goals]
        orders = orders_of(self.session, targets, movers)
        names = [name for order in orders for name in order.movers]
        aside = free_of(self.session, may_move)
        for name in [*names, *([] if may_move is True else aside)]:
            check_can_move(self.session.mover(name))
        made = SurfaceOrder(self, names, self.session.now, aside)
        goals = {name: goal for name, goal in self._goals.items() if name not in names}
        for order in orders:
            pool = object()
            for k, name in enumerate(order.movers):
                goals[name] = _Goal(made, pool, order.points[k] if k < len(order.points) else None)
        if not names:
            return made
        number = self.session.mover(names[0]).coordinate_system
        aside = [name for name in aside if self.session.mover(name).coordinate_system == number]
        made.may_move = tuple(aside)
        sizes = dict.fromkeys([*names, *self._on_way, *aside])
        raster = self._make_raster([self.session.mover(name) for name in sizes])
        if not self._back:
            astray = self._astray(names, raster)
            if not astray:
                self._install(*self._plan(goals, raster))
            else:
                self._check_targets(goals, raster)
                self._go_to_rest(astray, raster)
        for name in names:
            if name in self._goals:
                self._fail(name, f"mover {name}: another order came")
        self._goals = goals
        self._take_targets()
        self._look_whether_there()
        return made

    def route_any(
        self, points: Sequence[Point], *, movers: Iterable[str] | None = None, may_move: bool | Iterable[str] = False
    ) -> SurfaceOrder:
        """Sends any of these movers to any of these points (X and Y [mm]), one each; otherwise as `route`."""
        return self.route(list(points), movers=movers, may_move=may_move)

    @property
    def busy(self) -> bool:
        """True while movers are under way or have targets to reach."""
        return bool(self._on_way or self._back or self._goals)

    @property
    def waits(self) -> dict[str, str]:
        """By mover: the reason why it waits, if it is at rest before its target."""
        reasons = {}
        names = list(self.session.movers)
        for name, one in self._on_way.items():
            mover = one.mover
            if mover.waits_for:
                reasons[name] = f"waits for {names[mover.waits_for - 1]}, in its way"
            elif name in self._back:
                reasons[name] = "goes out of the way of what stands"
            elif self._back and not one.in_motion and not one.there:
                reasons[name] = f"waits until {', '.join(self._back)} {_are(self._back)} out of the way"
            elif mover.delay.value == "place" and one.granted < one.last:
                x, y = one.points[one.granted + 1]
                reasons[name] = f"waits for the place ({x:.6g}, {y:.6g}), which {names[mover.blocker - 1]} has before"
        return reasons

    # --- in every cycle ---

    def scan(self) -> None:
        """Updates arrivals, waiting times and failures, and plans routes again where necessary."""
        passed, self._seen_s = self.session.now - self._seen_s, self.session.now
        busy = self._on_way or self._back or self._pending or self._too_late
        if not busy or not self._are_started():
            return
        failed: dict[str, str] = {}
        for name, one in self._on_way.items():
            if name not in self._back and (sentence := one.fault()) is not None:
                failed[name] = sentence
        if failed or self._too_late or self._surface_now() != self._surface:
            for name, sentence in failed.items():
                self._fail(name, sentence)
                self._failed.add(name)
            self._too_late = False
            self._plan_round()
        if self._back:
            self._see_to_those_that_go_back()
        names = list(self.session.movers)
        for name, one in self._on_way.items():
            if one.mover.delay.value == "place":
                self.waited_s[name][names[one.mover.blocker - 1]] += passed
        self._look_whether_there()

    def _are_started(self) -> bool:
        """Returns True if the engine has answered and its last answer needs no new plan. If it has rejected the last
        routes, all movers are held, and the next scan plans again."""
        if any(one.busy for one in self._pending):
            return False
        if not self._pending:
            return True
        ways = self._pending[0].before
        for one, after in zip(self._pending, [*self._pending[1:], None], strict=True):
            if one.done:
                ways = self._on_way if after is None else after.before
        last, self._pending = self._pending[-1], []
        self._on_way = {**ways, **self._back}
        for way in ways.values():
            way.bound = way.last
        if last.done:
            self._refusals = 0
            self._release()
            return True
        self._refusals += 1
        if self._refusals > MOST_REFUSALS:
            self._refusals = 0
            self._give_up(last.refusal)
            if not self._goals:  # all movers keep their previous routes
                self._release()
                return True
        self._hold(self._on_way)
        self._too_late = True
        return False

    def _give_up(self, refusal: Feedback) -> None:
        """The engine accepts no routes from here: the target of the mover that it names fails, or all targets do."""
        named = refusal.object
        names = [named.name] if named is not None and named.name in self._goals else list(self._goals)
        for name in names:
            self._fail(name, f"mover {name}: {refusal.sentence}")

    def _hold(self, names: Iterable[str]) -> None:
        if numbers := self._numbers(names):
            self.session.command("machine", "hold_routes", {"movers": numbers})
            self._held = True

    def _release(self) -> None:
        if self._held and (numbers := self._numbers(self._on_way)):
            self.session.command("machine", "hold_routes", {"hold": False, "movers": numbers})
        self._held = False

    def _numbers(self, names: Iterable[str]) -> list[int]:
        wanted = set(names)
        return [number for number, name in enumerate(self.session.movers, 1) if name in wanted]

    def _look_whether_there(self) -> None:
        if self._back or self._pending:
            return
        for name in [name for name, one in self._on_way.items() if one.there]:
            del self._on_way[name]
        for name in [name for name, goal in self._goals.items() if name not in self._on_way]:
            goal = self._goals.pop(name)
            goal.order.arrived_s.setdefault(name, self.session.now - goal.order.started_s)

    def _fail(self, name: str, sentence: str) -> None:
        goal = self._goals.pop(name, None)
        if goal is not None:
            goal.order.failed[name] = sentence

    # --- planning ---

    def _make_raster(self, movers: Sequence[Mover]) -> Raster:
        options = self.options
        if (self._on_way or self._goals) and self._raster is not None:  # movers with an order stay on its raster
            raster = make_raster(self.session, movers, options.environment, self._raster.pitch, self._raster.origin)
        else:
            raster = make_raster(self.session, movers, options.environment, options.pitch, options.origin)
        return raster

    def _surface_now(self) -> tuple[object, ...]:
        return tuple((is_there(part), part.position_index) for part in self.session.parts.values())

    def _commitments(self) -> dict[str, int]:
        """Returns by mover under way the index of the place to which it is committed: where it can come to rest, or
        farther, so that the movers behind it reach theirs."""
        if self._held:
            return {name: one.granted for name, one in self._on_way.items()}
        later_s = max(self._later_s, (len(self._on_way) / COMMANDS_A_CYCLE + 4) * self.session.period)
        found = {name: one.stops_at(self._dynamics, later_s) for name, one in self._on_way.items()}
        again = True
        while again:
            again = False
            for name, one in self._on_way.items():
                for place in range(one.passed + 1, found[name] + 1):
                    if (behind := self._behind(one, place)) is None:
                        continue
                    other, its = behind
                    ahead = self._on_way[other]
                    if ahead.passed <= its < ahead.last and found[other] <= its:
                        found[other] = its + 1
                        again = True
        return found

    def _behind(self, one: OnWay, place: int) -> tuple[str, int] | None:
        """Returns the mover under way that visits this place before `one`, and the index of the place on its own route;
        None if the place is not visited before by another mover under way."""
        before = one.before[place]
        if before is None or before[0] == one.mover.name or before[0] not in self._on_way:
            return None
        return before[0], before[1] - self._on_way[before[0]].first

    def _standing(self, raster: Raster, starts: Iterable[str]) -> dict[int, str]:
        """Returns by place the mover that covers it; movers in `starts` are left out."""
        moved = set(starts)
        return {
            place: mover.name
            for name, mover in self.session.movers.items()
            if name not in moved
            for place in raster.covered_by(mover)
        }

    def _plan(self, goals: Mapping[str, _Goal], raster: Raster) -> tuple[SurfacePlan, dict[str, int]]:
        commitments = self._commitments()
        wanted = {*goals, *self._on_way}
        here = raster.coordinate_system
        for name in {name for goal in goals.values() for name in goal.order.may_move} - wanted:
            mover = self.session.mover(name)
            in_reach = not here or mover.coordinate_system == here
            if in_reach and can_move(mover) and self._is_in_place(mover, raster):
                wanted.add(name)
        starts: dict[str, Point] = {}
        for name, mover in self.session.movers.items():
            if name not in wanted:
                continue
            going = self._on_way.get(name)
            starts[name] = (mover.x, mover.y) if going is None else going.points[commitments[name]]
        pools: dict[object, list[str]] = defaultdict(list)
        for name, goal in goals.items():
            pools[goal.pool].append(name)
        orders = []
        for movers in pools.values():
            movers.sort(key=lambda name: goals[name].target is None)
            points = tuple(point for name in movers if (point := goals[name].target) is not None)
            orders.append(Order(tuple(movers), points, len(movers) == 1 and len(points) == 1))
        plan = make_plan(self.session, raster, starts, orders, self.options, self._standing(raster, starts))
        self.plans += 1
        return plan, commitments

    def _install(self, plan: SurfacePlan, commitments: Mapping[str, int]) -> None:
        raster = plan.raster
        before_all: dict[int, list[Before]] = defaultdict(list)  # by place, visits that are granted
        made: dict[str, OnWay] = {}
        for name, visits in zip(plan.names, plan.visits, strict=True):
            points = [raster.middle(visit.place) for visit in visits]
            old = self._on_way.get(name)
            made[name] = self._from_now(name, old, commitments.get(name, 0), points)
            one = made[name]
            for k in range(one.bound):
                before_all[_place(raster, one.points[k])].append((name, one.first + k))
        for name, visits in zip(plan.names, plan.visits, strict=True):
            one = made[name]
            for k, visit in enumerate(visits[1:], one.bound + 1):
                if visit.before is not None:
                    other = made[plan.names[visit.before[0]]]
                    one.before[k] = other.mover.name, other.first + other.bound + visit.before[1]
                else:
                    one.before[k] = _last(before_all[visit.place], made)
        self._tell({name: one for name, one in made.items() if name in self._on_way or one.last > 0}, dynamics_of(plan))
        self._raster = raster
        self._dynamics = {**dynamics_of(plan), "reference": raster.reference}
        self._surface = self._surface_now()
        self._planned = plan

    def _from_now(self, name: str, old: OnWay | None, at: int, points: Sequence[Point]) -> OnWay:
        """Returns the route of a mover up to place `at`, to which it is committed, and then along these points."""
        mover = self.session.mover(name)
        if old is None:
            one = OnWay(mover, points, mover.route_visit)
            one.bound = 0
            return one
        passed = old.passed
        one = OnWay(mover, [*old.points[passed:at], *points], old.first + passed)
        one.before[: at - passed + 1] = old.before[passed : at + 1]
        one.bound = at - passed
        return one

    def _tell(self, ways: dict[str, OnWay], dynamics: Mapping[str, float]) -> None:
        """Sends these routes to the engine, each from the place to which its mover is committed."""
        numbers = {name: number for number, name in enumerate(self.session.movers, 1)}
        told: list[Feedback] = []
        for name, one in ways.items():
            visits: list[dict[str, Any]] = []
            for k in range(one.bound, one.last + 1):
                x, y = one.points[k]
                visits.append({"x": x, "y": y})
                before = one.before[k]
                if k > one.bound and before is not None and before[0] != name:
                    visits[-1] |= {"after": numbers[before[0]], "after_visit": before[1]}
            given = [one.mover.set_route(**part) for part in parts_of_route(one.first + one.bound, visits)]
            one.feedback = given[0]
            told += given
        if ways:
            movers = [numbers[name] for name in ways]
            start = self.session.command("machine", "start_routes", {**dynamics, "movers": movers})
            self._pending.append(_Started(start, told, self._on_way))
        self._on_way = ways

    def _take_targets(self) -> None:
        """Takes the targets that the last plan assigned to movers of pools; a mover without one leaves its order."""
        taken: Mapping[str, Point] = {} if self._planned is None else self._planned.targets
        for name in list(self._goals):
            goal = self._goals[name]
            alone = sum(other.pool is goal.pool for other in self._goals.values()) == 1
            if goal.target is None or not alone:
                points = [g.target for g in self._goals.values() if g.pool is goal.pool and g.target is not None]
                if not self._back:
                    goal.order.targets.pop(name, None)
                    if (point := taken.get(name)) is not None and any(math.dist(point, p) < NEAR for p in points):
                        goal.order.targets[name] = point
            else:
                goal.order.targets[name] = goal.target
        if self._back:
            return
        for name in list(self._goals):
            goal = self._goals[name]
            if name in goal.order.targets:
                goal.target = goal.order.targets[name]
            else:  # there were fewer targets than movers
                del self._goals[name]
                goal.order.movers = tuple(other for other in goal.order.movers if other != name)

    def _plan_round(self) -> None:
        """Plans again after movers failed or the surface changed; movers that cannot keep clear of obstacles return to
        places first."""
        movers = [self.session.mover(name) for name in dict.fromkeys([*self._on_way, *self._goals])]
        if not movers:
            return
        try:
            raster = self._make_raster(movers)
        except RoutingError as error:
            for name in list(self._goals):
                self._fail(name, f"mover {name}: {error}")
            self._go_to_rest(list(self._on_way), self._raster)
            return
        self._surface = self._surface_now()
        for name, one in list(self._on_way.items()):
            if one.rests and not raster.free[_place(raster, one.points[one.passed])]:
                self._fail(name, f"mover {name}: the surface on which it waited is there no more")
                del self._on_way[name]
        self._bring_into_places(raster)
        shut = self._standing(raster, self._on_way)
        commitments = self._commitments()
        caught = self._failed | {name for name, one in self._on_way.items() if one.off_way() > NEAR}
        for name, one in self._on_way.items():
            places = [_place(raster, point) for point in one.points[one.passed + 1 : commitments[name] + 1]]
            if any(place in shut or not raster.free[place] for place in places):
                caught.add(name)
        if caught:
            self._go_to_rest(caught, raster)
        else:
            self._plan_what_can_be(raster)

    def _bring_into_places(self, raster: Raster) -> None:
        """Sends movers with a target that rest between places to a place first; fails those that cannot be moved."""
        for name in [name for name in self._goals if name not in self._on_way]:
            try:
                check_can_move(self.session.mover(name))
                self._astray([name], raster)
            except RoutingError as error:
                self._fail(name, str(error))

    def _plan_what_can_be(self, raster: Raster) -> None:
        """Plans for all targets. Those for which there is no plan any more fail, with the reason."""
        while True:
            try:
                self._install(*self._plan(self._goals, raster))
                break
            except RoutingError as error:
                failed = self._goals.get(error.mover)
                names = [name for name, goal in self._goals.items() if failed is None or goal.pool is failed.pool]
                for name in names:
                    self._fail(name, str(error) if name in str(error) else f"mover {name}: {error}")
                if not names:
                    self._end_routes()
                    return
        self._take_targets()

    @staticmethod
    def _is_in_place(mover: Mover, raster: Raster) -> bool:
        here = (mover.x, mover.y)
        places = raster.covered_by(mover)
        return any(raster.free[place] and math.dist(raster.middle(place), here) <= NEAR for place in places)

    def _end_routes(self) -> None:
        """Ends all routes in the first places where the movers can come to rest."""
        dynamics = {key: value for key, value in self._dynamics.items() if key != "reference"}
        ends = self._commitments()
        ways = {
            name: self._from_now(name, one, ends[name], [one.points[ends[name]]]) for name, one in self._on_way.items()
        }
        self._tell(ways, dynamics)

    def _check_targets(self, goals: Mapping[str, _Goal], raster: Raster) -> None:
        """Raises RoutingError if a target is not the centre of a place, or two movers have the same one."""
        known: dict[int, str] = {}
        for name, goal in goals.items():
            if goal.target is not None:
                place = raster.place_at(goal.target, f"the target of mover {name}", name)
                if place in known:
                    raise RoutingError(f"mover {known[place]} and mover {name} have one target", name)
                known[place] = name

    # --- returning to places ---

    def _astray(self, names: Iterable[str], raster: Raster) -> list[str]:
        """Returns those of these movers that rest between places, each registered with a route to the nearest free
        place straight along X or Y. Raises RoutingError if there is no such place for a mover."""
        shut = self._standing(raster, [*names, *self._on_way])
        bound = {_place(raster, p) for one in self._on_way.values() for p in one.points[one.passed :]}
        found = {}
        for name in names:
            mover = self.session.mover(name)
            if name in self._on_way:
                continue
            if self._is_in_place(mover, raster):
                continue
            here = (mover.x, mover.y)
            near = sorted(raster.covered_by(mover), key=lambda place: math.dist(raster.middle(place), here))
            for place in near:
                x, y = raster.middle(place)
                straight = min(abs(mover.x - x), abs(mover.y - y)) < NEAR
                if straight and raster.free[place] and place not in shut and place not in bound:
                    found[name] = OnWay(mover, [(x, y)], mover.route_visit)
                    bound.add(place)
                    break
            else:
                raster.place_at(here, f"mover {name}", name)  # raises the error with the reason
                raise RoutingError(f"mover {name} at ({mover.x:.6g}, {mover.y:.6g}) has no way to a place", name)
        if found:
            if not self._on_way:
                self._dynamics = {**self.options.dynamics, "reference": raster.reference}
            self._on_way |= found
        return list(found)

    def _go_to_rest(self, caught: Iterable[str], raster: Raster | None) -> None:
        """Halts these movers, and those committed to places behind them, so that they return to the last place reached;
        all others are held where they can come to rest."""
        commitments = self._commitments()
        back = set(caught)
        again = True
        while again:
            again = False
            for name, one in self._on_way.items():
                if name in back:
                    continue
                for place in range(one.passed + 1, commitments[name] + 1):
                    behind = self._behind(one, place)
                    if behind is not None and behind[0] in back and self._on_way[behind[0]].passed <= behind[1]:
                        back.add(name)
                        again = True
                        break
        for name, one in self._on_way.items():
            if name in back and name not in self._back:
                able = one.mover.state.value == "Enabled" and name not in self._failed
                one.feedback = one.mover.halt() if able and (one.in_motion or one.mover.on_route) else None
                one.halts = one.feedback is not None
                self._back[name] = one
        self._hold([name for name in self._on_way if name not in self._back])
        if raster is not None:
            self._raster = raster

    def _see_to_those_that_go_back(self) -> None:
        left = False
        for name, one in list(self._back.items()):
            mover, feedback = one.mover, one.feedback
            if one.in_motion or mover.state.value in ("Disabling", "ErrorPending") or (one.halts and one.is_told):
                left = True
                continue
            if one.halts:
                one.halts, feedback, one.feedback = False, None, None
            if mover.state.value != "Enabled" or mover.command_mode.value != "FreeMovement":
                self._fail(name, f"mover {name} is {mover.state.value} on its way")
                self._failed.add(name)
            x, y = one.points[one.passed]
            if name in self._failed:
                del self._back[name], self._on_way[name]
                self._failed.discard(name)
            elif feedback is None and math.dist((mover.x, mover.y), (x, y)) > NEAR:
                one.feedback = mover.move_to_position(x=x, y=y, use_orientation=False, **self._dynamics)
                left = True
            elif one.is_told:
                left = True
            elif feedback is not None and not feedback.done:
                self._fail(name, f"mover {name} does not get out of the way: {feedback.sentence or 'it was halted'}")
                self._failed.add(name)
                left = True
        if left:
            return
        for name, one in self._back.items():
            self._on_way[name] = OnWay(one.mover, [one.points[one.passed]], one.first + one.passed)
        self._back = {}
        self._plan_round()


def router_for(
    session: Session, targets: Targets, movers: Iterable[str] | None, options: Mapping[str, Any]
) -> SurfaceRouter:
    """Returns the router of the session for the coordinate system of these movers: the existing one, or a new one if
    there is none or its options differ from those given. Raises RoutingError if that one is busy."""
    if isinstance(targets, Mapping):
        names = [name for key in targets for name in names_of_key(key)]
    else:
        names = list(movers or ()) or [name for name, mover in session.movers.items() if can_move(mover)]
    number = session.mover(names[0]).coordinate_system if names and session.parts else 0
    known = session._routers.get(number)
    if known is not None and (not options or known.given == options):
        return known
    if known is not None and known.busy:
        raise RoutingError("movers are on their way: other options can be given when they are there")
    made = SurfaceRouter(session, **options)
    if known is not None:
        session._programs[:] = [program for program in session._programs if program.scan != known.scan]
    session._routers[number] = made
    return made


def _last(visits: Sequence[Before], ways: Mapping[str, OnWay]) -> Before | None:
    """Returns the last one of the visits of a place, each of which refers to the one before; None if there are none."""
    earlier = {ways[name].before[number - ways[name].first] for name, number in visits}
    return next((visit for visit in visits if visit not in earlier), None)


def _place(raster: Raster, point: Point) -> int:
    x, y = (math.floor((value - low) / raster.pitch) for value, low in zip(point, raster.origin, strict=True))
    return y * raster.width + x


def _are(names: Iterable[str]) -> str:
    return "is" if len(list(names)) == 1 else "are"
