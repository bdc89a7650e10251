"""Plans routes for many movers on the free surface at once: all reach their targets, and none waits for ever (PL-72).

The planner is C++ (cpp/takt/routing/surface.h states what a plan guarantees); this module calls it for the movers of a
session.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

from takt import _core
from takt.counted import counted
from takt.names import names_in
from takt.routing.on_way import DYNAMICS, STANDS
from takt.routing.raster import APART, Point, Raster, extent_of, make_raster
from takt.routing.streets import RoutingError

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session

EFFORT = 3_000  # search states of the improvement, at least
EFFORT_BY_MOVERS = 50  # times the square of the number of movers
MOST_EFFORT = 500_000  # 2 to 5 s of planning
MOST_RUN_S = 1e5  # [s] longest motion: the planner compares sums of such times to a nanosecond


@dataclass(frozen=True)
class SurfaceLeg:
    """One straight motion of a mover from rest to rest."""

    departure_s: float
    arrival_s: float
    start: Point  # mm
    end: Point


@dataclass(frozen=True)
class Visit:
    """The visit of a mover at a place of its route."""

    place: int
    entry_s: float  # from this time on the mover cannot come to rest before the place any more
    left_s: float  # end of the visit: no part of the mover covers the place; of the last visit: arrival
    before: tuple[int, int] | None  # index of a mover and of its visit that has to end before; None: none


@dataclass(frozen=True)
class SurfacePlan:
    """Routes of movers, and the order in which they visit each place. `str(plan)` describes the plan in words."""

    names: tuple[str, ...]  # of the movers with a route, or that may have one
    targets: Mapping[str, Point]  # by mover: where it ends [mm]; movers that stay, without a target, are left out
    legs: Mapping[str, tuple[SurfaceLeg, ...]]  # by mover
    visits: tuple[tuple[Visit, ...], ...]  # by mover, from its start on
    moved_aside: tuple[str, ...]  # movers that move without a target
    raster: Raster
    dynamics: Mapping[str, float]  # of all moves: velocity, acceleration, jerk
    sum_s: float  # of all arrival times
    lower_bound_s: float  # of `sum_s`: the sum if each mover were alone
    first_sum_s: float  # of the first plan, before it was improved

    @property
    def arrival_s(self) -> dict[str, float]:
        """By mover: time of arrival at its final position, from the start on [s]."""
        return {name: legs[-1].arrival_s if legs else 0.0 for name, legs in self.legs.items()}

    @property
    def duration_s(self) -> float:
        """Time of arrival of the last mover [s]."""
        return max(self.arrival_s.values(), default=0.0)

    def __str__(self) -> str:
        lines = []
        for name, (x, y) in self.targets.items():
            arrival, legs = self.arrival_s[name], counted(len(self.legs[name]), "leg")
            lines.append(f"{name}: to ({x:.6g}, {y:.6g}) in {legs}, there at {arrival:.3f} s")
        ratio = f", {self.sum_s / self.lower_bound_s:.3f} of the lower bound" if self.lower_bound_s > 0 else ""
        return "\n".join([*lines, f"sum {self.sum_s:.3f} s{ratio}"])


# A point by mover, several points by several movers (a tuple); or points alone, for any mover.
Targets = Mapping[Any, Any] | Sequence[Point]


@dataclass(frozen=True)
class Order:
    """Movers and their targets: each target is for any one of the movers."""

    movers: tuple[str, ...]
    points: tuple[Point, ...]
    own: bool  # True: one mover, whose own target this is

    def says(self, k: int) -> str:
        if self.own:
            return f"the target of mover {self.movers[0]}"
        return f"target {k + 1} of movers {', '.join(self.movers)}" if self.movers else f"target {k + 1}"


@dataclass(frozen=True)
class Options:
    """The options of a plan, besides its targets; None: as plan_surface says."""

    environment: str | None = None
    pitch: float | None = None
    origin: Point | None = None
    effort: int = EFFORT
    seed: int = 1
    dynamics: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for key, value in self.dynamics.items():
            if key not in DYNAMICS:
                raise TypeError(f"dynamics are {', '.join(DYNAMICS)}, not {key}")
            if not (_is_number(value) and 0 < value < math.inf):
                raise RoutingError(f"{key} is a number above 0, not {value!r}")
        if self.pitch is not None and not (_is_number(self.pitch) and 0 < self.pitch < math.inf):
            raise RoutingError(f"the pitch is a number above 0 mm, not {self.pitch!r}")
        if self.origin is not None:
            _point("the origin", self.origin)
        for key, count in (("effort", self.effort), ("seed", self.seed)):
            if not _is_whole(count) or not 0 <= count < 2**63:
                raise RoutingError(f"{key} is a whole number from 0 to {2**63 - 1}, not {count!r}")


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _is_whole(value: object) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)


def plan_surface(
    session: Session,
    targets: Targets,
    *,
    movers: Iterable[str] | None = None,
    may_move: bool | Iterable[str] = False,
    environment: str | None = None,
    pitch: float | None = None,
    origin: Point | None = None,
    effort: int | None = None,
    seed: int = 1,
    **dynamics: float,
) -> SurfacePlan:
    """Returns routes on the free surface on which all movers with a target reach it; nothing is moved.

    targets: by mover, X and Y of its target [mm]; by several movers (a tuple of names), a list of such points, each for
        any one of them. Or a list alone: each point is for any one of `movers`.
    movers: with a list of targets, the movers that may take one; None: all that can move.
    may_move: movers without a target that may be moved out of the way; True: all of them, False: none. All others stay.
    environment: the environment whose stators are the surface; needed if several have stators. If the machine has
        parts, their stators are the surface, and an environment is an error.
    pitch: distance between the centres of places [mm], larger than the largest mover by 0.01 mm or more; None: the
        least part or multiple of a stator's 240 mm that leaves 2 mm between movers.
    origin: lower left corner of the raster [mm]; None: that of the stators.
    effort: search states that are expanded to improve the first plan. A count, so that the plan is reproducible. None:
        50 times the square of the number of movers, from 3,000 to 500,000.
    seed: of the search; another seed may give another plan.
    dynamics: velocity, acceleration (of braking, too), jerk of all moves, each above 0; else the least of the movers'
        own. The movers' maxima bound them.

    Raises RoutingError, with the reason, if no plan is found, TypeError if `dynamics` has another key.
    """
    options = Options(environment, pitch, origin, EFFORT if effort is None else effort, seed, dynamics)
    orders = orders_of(session, targets, movers)
    wanted = [name for order in orders for name in order.movers]
    free = free_of(session, may_move)
    for name in [*wanted, *([] if may_move is True else free)]:
        check_can_move(session.mover(name))
    for name, mover in session.movers.items():
        if math.hypot(mover.velocity_x, mover.velocity_y) > STANDS:
            raise RoutingError(f"mover {name} is in motion: routes are planned for movers that stand")
    routed = {name: session.mover(name) for name in session.movers if name in {*wanted, *free}}
    if may_move is True and session.parts and wanted:  # movers in other coordinate systems block none
        here = session.mover(wanted[0]).coordinate_system
        routed = {name: m for name, m in routed.items() if name in wanted or m.coordinate_system == here}
    if effort is None:
        options = replace(options, effort=min(max(EFFORT, EFFORT_BY_MOVERS * len(routed) ** 2), MOST_EFFORT))
    raster = make_raster(
        session, list(routed.values()) or list(session.movers.values()), environment, pitch, options.origin
    )
    starts = {name: (m.x, m.y) for name, m in routed.items()}
    return make_plan(session, raster, starts, orders, options)


def orders_of(session: Session, targets: Targets, movers: Iterable[str] | None) -> list[Order]:
    """Returns the targets in one form. Raises RoutingError if a target is invalid, there are more targets than movers,
    or a mover has two."""
    if not isinstance(targets, Iterable):
        raise RoutingError(f"targets are places by mover, or a list of places, not {targets!r}")
    if not isinstance(targets, Mapping):
        points = tuple(_point(f"target {i}", target) for i, target in enumerate(targets, 1))
        able = [name for name, mover in session.movers.items() if _cannot_move(mover) is None]
        wanted = able if movers is None else list(dict.fromkeys(names_in(movers, "movers", "mover")))
        if len(points) > len(wanted):
            raise RoutingError(f"{counted(len(points), 'target')} for {counted(len(wanted), 'mover')}")
        return [Order(tuple(wanted), points, False)]
    if movers is not None:
        raise TypeError("movers are for interchangeable targets, a list")
    orders: list[Order] = []
    for key, target in targets.items():
        if isinstance(key, str):
            orders.append(Order((key,), (_point(f"the target of mover {key}", target),), True))
            continue
        names = names_of_key(key)
        said = ", ".join(names)
        if not isinstance(target, Iterable):
            raise RoutingError(f"the targets of movers {said} are a list of X and Y in mm, not {target!r}")
        points = tuple(_point(f"target {i} of movers {said}", one) for i, one in enumerate(target, 1))
        if len(points) > len(names):
            raise RoutingError(f"{counted(len(points), 'target')} for {counted(len(names), 'mover')}: {said}")
        orders.append(Order(names, points, False))
    known: set[str] = set()
    for name in (name for order in orders for name in order.movers):
        if name in known:
            raise RoutingError(f"mover {name} has more than one target")
        known.add(name)
    return orders


def names_of_key(key: Any) -> tuple[str, ...]:
    """Returns the names of the movers of a key of `targets`: one name, or a tuple of names."""
    if isinstance(key, str):
        return (key,)
    if not isinstance(key, Iterable):
        raise TypeError(f"targets: a mover goes by its name, not by {key!r}")
    return tuple(dict.fromkeys(names_in(key, "targets", "mover")))


def may_move_of(may_move: bool | Iterable[str]) -> list[str]:
    """Returns the names of the movers that may be moved aside, if `may_move` gives them by name."""
    return [] if may_move is False or may_move is None else list(names_in(may_move, "may_move", "mover"))


def free_of(session: Session, may_move: bool | Iterable[str]) -> list[str]:
    """Returns the names of the movers that may be moved aside; True: all that can move."""
    if may_move is True:
        return [name for name, mover in session.movers.items() if _cannot_move(mover) is None]
    return may_move_of(may_move)


def can_move(mover: Mover) -> bool:
    return _cannot_move(mover) is None


def check_can_move(mover: Mover) -> None:
    if (reason := _cannot_move(mover)) is not None:
        raise RoutingError(f"mover {mover.name} cannot be moved on the surface: {reason}", mover.name)


def make_plan(
    session: Session,
    raster: Raster,
    starts: Mapping[str, Point],
    orders: Sequence[Order],
    options: Options,
    standing: Mapping[int, str] | None = None,
) -> SurfacePlan:
    """Returns the plan for the movers in `starts`, from these points. All others are obstacles: `standing` has the
    mover by place that it covers; None: as the movers are now. Raises RoutingError, with the reason, if no plan is
    found."""
    names = tuple(starts)
    start_places = [raster.place_at(point, f"mover {name}") for name, point in starts.items()]
    _check_apart("mover", names, start_places, raster)
    if standing is None:
        standing = {
            place: mover.name
            for name, mover in session.movers.items()
            if name not in starts
            for place in raster.covered_by(mover)
        }
    for name, place in zip(names, start_places, strict=True):
        if place in standing:
            raise RoutingError(
                f"mover {standing[place]} reaches into the place of mover {name}, and may not be moved", name
            )
    targets, pools = [-1] * len(names), [-1] * len(names)
    number = {name: i for i, name in enumerate(names)}
    goals: dict[int, str] = {}
    for pool, order in enumerate(orders):
        for k, point in enumerate(order.points):
            said, mover = order.says(k), order.movers[k]
            place = raster.place_at(point, said, mover)
            if place in goals:
                both = f"{goals[place]} and {said}".replace(f" of movers {', '.join(order.movers)}", "")
                raise RoutingError(f"{both} are in one place, {_at(raster, place)}", mover)
            if place in standing:
                raise RoutingError(
                    f"mover {standing[place]} stands at the target {_at(raster, place)}, and may not be moved",
                    mover,
                )
            goals[place] = said
            targets[number[mover]] = place
        for name in () if order.own else order.movers:
            pools[number[name]] = pool
    routed = [session.mover(name) for name in names]
    limits = {key: min((_limit(m, key, options.dynamics.get(key)) for m in routed), default=1.0) for key in DYNAMICS}
    longest = (max(raster.width, raster.height) - 1) * raster.pitch
    if (takes_s := _core.run_duration(longest, **limits)) > MOST_RUN_S:
        said = ", ".join(f"{key} {value:.6g}" for key, value in limits.items())
        raise RoutingError(
            f"the movers are too slow for a plan: a run along the surface takes {takes_s:.0f} s, more than "
            f"{MOST_RUN_S:.0f} s, with {said}"
        )
    routes = _core.plan_surface(
        width=raster.width,
        height=raster.height,
        pitch=raster.pitch,
        mover_size=min(raster.pitch, max((max(extent_of(m)) for m in routed), default=0.0) + APART),
        **limits,
        blocked=[not on or place in standing for place, on in enumerate(raster.free)],
        starts=start_places,
        targets=targets,
        pools=pools,
        effort=options.effort,
        seed=options.seed,
    )
    _check_outcome(routes, names, targets, pools, raster, standing)
    legs = {}
    for name, rows in zip(names, routes.legs, strict=True):
        made = []
        for departure, from_, to in rows:
            start, end = raster.middle(from_), raster.middle(to)
            duration = _core.run_duration(math.dist(start, end), **limits)
            made.append(SurfaceLeg(departure, departure + duration, start, end))
        legs[name] = tuple(made)
    visits = tuple(
        tuple(Visit(place, entry, left, None if who < 0 else (who, k)) for place, entry, left, who, k in rows)
        for rows in routes.visits
    )
    own = {order.movers[0] for order in orders if order.own}
    pooled = {
        name for name, place, pool in zip(names, routes.targets, pools, strict=True) if pool >= 0 and place in goals
    }
    ends = {name: raster.middle(place) for name, place in zip(names, routes.targets, strict=True)}
    return SurfacePlan(
        names,
        {name: ends[name] for name in names if legs[name] or name in own or name in pooled},
        legs,
        visits,
        tuple(name for name in names if legs[name] and name not in own and name not in pooled),
        raster,
        limits,
        routes.sum,
        routes.lower_bound,
        routes.first_sum,
    )


def _check_outcome(
    routes: _core.SurfaceRoutes,
    names: Sequence[str],
    targets: Sequence[int],
    pools: Sequence[int],
    raster: Raster,
    standing: Mapping[int, str],
) -> None:
    if routes.outcome == "unreachable":
        name = names[routes.unreachable]
        if pools[routes.unreachable] >= 0:
            raise RoutingError(
                "the targets cannot all be reached: holes and movers that stand shut the ways to them"
                f"{_round(standing.values())}",
                name,
            )
        target = _at(raster, targets[routes.unreachable])
        raise RoutingError(f"mover {name}: no way leads to its target {target}{_round(standing.values())}", name)
    if routes.outcome == "impossible":
        raise RoutingError(
            f"the targets cannot all be reached: every order of passing was tried{_round(standing.values())}"
        )
    if routes.outcome != "planned":
        raise RoutingError("no plan was found, and there may be one: another seed, or fewer movers at a time, may help")


def _point(what: str, point: object) -> Point:
    try:
        x, y = (float(value) for value in point)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise RoutingError(f"{what} is X and Y in mm, not {point!r}") from None
    if not (math.isfinite(x) and math.isfinite(y)):
        raise RoutingError(f"{what} is X and Y in mm, not {point!r}")
    return x, y


def _cannot_move(mover: Mover) -> str | None:
    """Returns the reason why the mover cannot be sent over the surface; None if it can."""
    if mover.state.value != "Enabled":
        return f"it is {mover.state.value}"
    if mover.command_mode.value != "FreeMovement":
        return f"its command mode is {mover.command_mode.value}"
    if mover.formation:
        return "it is in a formation"
    return None


def _limit(mover: Mover, key: str, asked: float | None) -> float:
    xy = mover.parameters["xy"]
    most = float(xy["maximum"][key])
    own = float((xy.get("standard") or xy["maximum"])[key])
    brakes = float((xy["maximum"].get("deceleration") if key == "acceleration" else None) or most)
    return min(most, brakes, own if asked is None else asked)


def _at(raster: Raster, place: int) -> str:
    x, y = raster.middle(place)
    return f"({x:.6g}, {y:.6g})"


def _round(standing: Iterable[str]) -> str:
    names = sorted(set(standing))
    return f" ({', '.join(names)} may not be moved)" if names else ""


def _check_apart(what: str, names: Sequence[str], places: Sequence[int], raster: Raster) -> None:
    known: dict[int, str] = {}
    for name, place in zip(names, places, strict=True):
        if place in known:
            raise RoutingError(f"{what} {known[place]} and {what} {name} are in one place, {_at(raster, place)}")
        known[place] = name
