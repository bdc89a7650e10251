"""Plans routes for many movers on the free surface at once: all get to their targets, and none waits for ever (PL-72).

The planner is C++ (cpp/takt/routing/surface.h says what a plan keeps); here it is asked for the movers of a session.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from takt import _core
from takt.counted import counted
from takt.routing.raster import Point, Raster, make_raster
from takt.routing.streets import RoutingError

if TYPE_CHECKING:
    from takt.mover import Mover
    from takt.session import Session

EFFORT = 3_000  # states that improvements look at
STANDS = 1e-3  # mm/s
DYNAMICS = ("velocity", "acceleration", "jerk")


@dataclass(frozen=True)
class SurfaceLeg:
    """One straight motion of a mover from rest to rest."""

    departure_s: float
    arrival_s: float
    start: Point  # mm
    end: Point


@dataclass(frozen=True)
class Visit:
    """A mover at a place of its route."""

    place: int
    entry_s: float  # from here on it cannot rest before the place any more
    before: tuple[int, int] | None  # mover and number of its visit that has to be over before


@dataclass(frozen=True)
class SurfacePlan:
    """Routes, and who is where before whom. `str(plan)` says it in words."""

    names: tuple[str, ...]  # of the movers with a route, or that may have one
    targets: Mapping[str, Point]  # by mover, where it ends; movers that stay are not in it
    legs: Mapping[str, tuple[SurfaceLeg, ...]]  # by mover
    visits: tuple[tuple[Visit, ...], ...]  # by mover, from where it starts
    moved_aside: tuple[str, ...]  # movers that move without a target
    raster: Raster
    dynamics: Mapping[str, float]  # of all moves: velocity, acceleration, jerk
    sum_s: float  # of all arrivals
    lower_bound_s: float  # no sum is less: that of all movers alone
    first_sum_s: float  # of the first plan, before it was improved

    @property
    def arrival_s(self) -> dict[str, float]:
        """By mover: when it is where it stays."""
        return {name: legs[-1].arrival_s if legs else 0.0 for name, legs in self.legs.items()}

    @property
    def duration_s(self) -> float:
        """When the last one is."""
        return max(self.arrival_s.values(), default=0.0)

    def __str__(self) -> str:
        lines = []
        for name, (x, y) in self.targets.items():
            arrival, legs = self.arrival_s[name], counted(len(self.legs[name]), "leg")
            lines.append(f"{name}: to ({x:.6g}, {y:.6g}) in {legs}, there at {arrival:.3f} s")
        ratio = f", {self.sum_s / self.lower_bound_s:.3f} of the lower bound" if self.lower_bound_s > 0 else ""
        return "\n".join([*lines, f"sum {self.sum_s:.3f} s{ratio}"])


def plan_surface(
    session: Session,
    targets: Mapping[str, Point] | Sequence[Point],
    *,
    movers: Iterable[str] | None = None,
    may_move: bool | Iterable[str] = False,
    environment: str | None = None,
    pitch: float | None = None,
    origin: Point | None = None,
    effort: int = EFFORT,
    seed: int = 1,
    **dynamics: float,
) -> SurfacePlan:
    """Routes on the free surface on which all movers with a target get there; nothing is moved.

    targets: by mover, X and Y in mm. Or a list of them: interchangeable, each for any of `movers`.
    movers: with interchangeable targets, those that may take one; all that can move, unless given.
    may_move: movers without a target that may be moved out of the way, or all of them (True). All others stand.
    environment: whose stators are the surface; needed where several have some.
    pitch: mm between places, no less than the largest mover; else the least that divides a stator (240 mm).
    origin: lower left corner of the raster; else that of the stators.
    effort: states that are looked at to make the first plan better. Counted, so that the plan is the same each time.
    seed: another one gives another plan.
    dynamics: velocity, acceleration (of braking, too), jerk of all moves; else the least of the movers' own.

    Raises RoutingError, with the reason, if there is no plan.
    """
    for key, value in dynamics.items():
        if key not in DYNAMICS:
            raise TypeError(f"dynamics are {', '.join(DYNAMICS)}, not {key}")
        if not 0 < value < math.inf:
            raise RoutingError(f"{key} is above 0, not {value:.6g}")
    if effort < 0 or seed < 0:
        raise RoutingError(f"effort and seed are 0 or more, not {effort} and {seed}")
    labelled = isinstance(targets, Mapping)
    aims: dict[str, Point] = {}
    points: list[Point] = []
    if isinstance(targets, Mapping):
        aims = {name: _point(f"the target of mover {name}", target) for name, target in targets.items()}
    else:
        points = [_point(f"target {i}", target) for i, target in enumerate(targets, 1)]
    if movers is not None and labelled:
        raise TypeError("movers are for interchangeable targets, a list")
    able = {name for name, mover in session.movers.items() if _cannot_move(session, mover) is None}
    if labelled:
        wanted = list(aims)
    else:
        wanted = [name for name in session.movers if name in able] if movers is None else list(dict.fromkeys(movers))
    free = [name for name in session.movers if name in able] if may_move is True else list(may_move or ())
    for name in [*wanted, *([] if may_move is True else free)]:
        if (reason := _cannot_move(session, session.mover(name))) is not None:
            raise RoutingError(f"mover {name} cannot be moved on the surface: {reason}")
    for name, mover in session.movers.items():
        if math.hypot(mover.velocity_x, mover.velocity_y) > STANDS:
            raise RoutingError(f"mover {name} is in motion: routes are planned for movers that stand")
    if not labelled and len(points) > len(wanted):
        raise RoutingError(f"{counted(len(points), 'target')} for {counted(len(wanted), 'mover')}")
    names = tuple(name for name in session.movers if name in {*wanted, *free})
    routed = [session.mover(name) for name in names]
    raster = make_raster(session, routed or list(session.movers.values()), environment, pitch, origin)
    starts = [raster.place_at((m.x, m.y), f"mover {m.name}") for m in routed]
    _check_apart("mover", names, starts, raster)
    standing = {
        place: mover.name
        for name, mover in session.movers.items()
        if name not in names
        for place in raster.covered_by(mover)
    }
    for name, place in zip(names, starts, strict=True):
        if place in standing:
            raise RoutingError(f"mover {standing[place]} reaches into the place of mover {name}, and may not be moved")
    if labelled:
        goals = [raster.place_at(p, f"the target of mover {name}") for name, p in aims.items()]
        _check_apart("the target of mover", tuple(aims), goals, raster)
    else:
        goals = [raster.place_at(p, f"target {i}") for i, p in enumerate(points, 1)]
        _check_apart("target", tuple(str(i) for i in range(1, len(points) + 1)), goals, raster)
    for place in goals:
        if place in standing:
            raise RoutingError(
                f"mover {standing[place]} stands at the target {_at(raster, place)}, and may not be moved"
            )
    limits = {key: min((_limit(m, key, dynamics.get(key)) for m in routed), default=1.0) for key in DYNAMICS}
    by_name = dict(zip(aims, goals, strict=True)) if labelled else {}
    routes = _core.plan_surface(
        width=raster.width,
        height=raster.height,
        pitch=raster.pitch,
        **limits,
        blocked=[not on or place in standing for place, on in enumerate(raster.free)],
        starts=starts,
        targets=[by_name.get(name, -1) for name in names] if labelled else goals,
        interchangeable=not labelled,
        effort=effort,
        seed=seed,
    )
    if routes.outcome == "unreachable":
        if not labelled:
            raise RoutingError("the targets cannot all be reached: holes and movers that stand shut the ways to them")
        name = names[routes.unreachable]
        raise RoutingError(
            f"mover {name}: no way leads to its target {_at(raster, by_name[name])}{_round(standing.values())}"
        )
    if routes.outcome == "impossible":
        raise RoutingError(
            f"the targets cannot all be reached: every order of passing was tried{_round(standing.values())}"
        )
    if routes.outcome != "planned":
        raise RoutingError("no plan was found, and there may be one: another seed, or fewer movers at a time, may help")
    times = dict(limits)
    legs = {}
    for name, rows in zip(names, routes.legs, strict=True):
        made = []
        for departure, from_, to in rows:
            start, end = raster.middle(from_), raster.middle(to)
            duration = _core.run_duration(math.dist(start, end), **times)
            made.append(SurfaceLeg(departure, departure + duration, start, end))
        legs[name] = tuple(made)
    visits = tuple(
        tuple(Visit(place, entry, None if who < 0 else (who, k)) for place, entry, who, k in rows)
        for rows in routes.visits
    )
    with_target = {name for name, place in zip(names, routes.targets, strict=True) if place in set(goals)}
    moving = [name for name in names if legs[name]]
    ends = {name: raster.middle(place) for name, place in zip(names, routes.targets, strict=True)}
    return SurfacePlan(
        names,
        {name: ends[name] for name in names if legs[name] or name in with_target},
        legs,
        visits,
        tuple(name for name in moving if (name not in aims if labelled else name not in with_target)),
        raster,
        limits,
        routes.sum,
        routes.lower_bound,
        routes.first_sum,
    )


def _point(what: str, point: object) -> Point:
    try:
        x, y = (float(value) for value in point)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise RoutingError(f"{what} is X and Y in mm, not {point!r}") from None
    if not (math.isfinite(x) and math.isfinite(y)):
        raise RoutingError(f"{what} is X and Y in mm, not {point!r}")
    return x, y


def _cannot_move(session: Session, mover: Mover) -> str | None:
    """Why it cannot be sent over the surface."""
    if mover.state.value != "Enabled":
        return f"it is {mover.state.value}"
    if mover.command_mode.value != "FreeMovement":
        return f"its command mode is {mover.command_mode.value}"
    if mover.formation:
        return "it is in a formation"
    if mover.group:
        group = list(session.planar_groups.values())[mover.group - 1]
        if group.state.value != "Disabled":
            return f"it is in group {group.name}, which refuses what the guard between movers lets wait: disable it"
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
