"""The least time along a path under limits of speed, acceleration and jerk: what path timing is held against (GR-23).

Given q_k(s) with exact derivatives, limits of |dq_k/dt|, |d2q_k/dt2| and |d3q_k/dt3|, and limits of the path itself
(speed, acceleration, deceleration, jerk), from rest to rest with no acceleration at either end.

How: time is cut into intervals, whose lengths keep their ratios; in each, the path's jerk is a straight line with a
value of its own at either end, so that s, v and a are exact polynomials. Coordinates are limited at the ends of the
intervals and at points within, and Ipopt minimises the time over s, v, a, jerk and the time itself. A motion found is
the best of its surroundings only: several starts are tried, and the fastest refined. It is then sampled 20 times finer
against every limit: slowed evenly until all hold, it is a motion within all limits, thus never faster than the optimum.
Without limits of jerk the optimum is a linear programme in h(s) = v * v; it bounds the time from below.

path_problems.py tells how to run this; neither is part of the package or run by the tests.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog
from scipy.sparse import csr_matrix, diags_array, vstack

Array = NDArray[np.float64]


class Shape(Protocol):
    """One coordinate over s: the derivative of order 1, 2 or 3, for numbers (numpy) or symbols (CasADi)."""

    def derivative(self, order: int, s: Array) -> Array: ...

    def symbolic(self, order: int, s: ca.SX) -> ca.SX: ...


@dataclass
class Harmonics:
    """q(s) = offset + slope * s + sum of amplitude * sin(frequency * s + phase)."""

    offset: float = 0.0
    slope: float = 0.0
    harmonics: list[tuple[float, float, float]] = field(default_factory=list)

    def value(self, s: Array) -> Array:
        return self.offset + self.slope * s + sum(a * np.sin(f * s + p) for a, f, p in self.harmonics)

    def derivative(self, order: int, s: Array) -> Array:
        terms = (a * f**order * np.sin(f * s + p + order * math.pi / 2) for a, f, p in self.harmonics)
        return sum(terms, np.full_like(s, self.slope if order == 1 else 0.0))

    def symbolic(self, order: int, s: ca.SX) -> ca.SX:
        terms = (a * f**order * ca.sin(f * s + p + order * math.pi / 2) for a, f, p in self.harmonics)
        return sum(terms, ca.SX(self.slope if order == 1 else 0.0))


@dataclass
class Coordinate:
    """A coordinate and its limits. `shapes` has one entry per piece of the path, smooth within."""

    shapes: Sequence[Shape]
    velocity: float
    acceleration: float
    jerk: float


@dataclass
class Problem:
    """`borders`: where pieces of the path begin and end, from 0 to its length."""

    name: str
    borders: list[float]
    velocity: float
    acceleration: float
    deceleration: float
    jerk: float
    coordinates: list[Coordinate]

    @property
    def length(self) -> float:
        return self.borders[-1]


@dataclass
class Solution:
    """Jerk `left` and `right` of each interval of length `steps`; s, v and a where they begin, and at the end."""

    time: float
    s: Array
    v: Array
    a: Array
    left: Array
    right: Array
    steps: Array
    piece: NDArray[np.int64]

    def sampled(self, fine: int) -> tuple[Array, Array, Array, Array, Array]:
        """t, s, v, a, j of shape (intervals, fine), both ends of each interval included."""
        x = np.linspace(0.0, 1.0, fine)[None, :] * self.steps[:, None]
        s, v, a = (values[:-1, None] for values in (self.s, self.v, self.a))
        j = self.left[:, None]
        slope = (self.right - self.left)[:, None] / self.steps[:, None]
        start = np.concatenate(([0.0], np.cumsum(self.steps)[:-1]))[:, None]
        return (
            start + x,
            s + v * x + a * x**2 / 2 + j * x**3 / 6 + slope * x**4 / 24,
            v + a * x + j * x**2 / 2 + slope * x**3 / 6,
            a + j * x + slope * x**2 / 2,
            j + slope * x,
        )


# --- Without limits of jerk ---------------------------------------------------------------------------------------


def acceleration_only(problem: Problem, intervals: int = 2000) -> tuple[float, Array, Array]:
    """The least time without limits of jerk, extrapolated from two grids; s and h = v * v on the finer."""
    coarse, fine = backward_forward(problem, intervals), backward_forward(problem, 2 * intervals)
    return 2 * fine[0] - coarse[0], *fine[1:]


def backward_forward(problem: Problem, intervals: int) -> tuple[float, Array, Array]:
    """The same on one grid: what a backward and a forward pass would find.

    Of two feasible h the larger of both at every s is feasible too: the greatest sum of h is the fastest everywhere.
    Between the points of the grid the acceleration is constant; limits hold at both ends of each interval, which makes
    it slower by about 1 / intervals.
    """
    # Finer towards both ends, where h starts like s.
    grid = np.linspace(0.0, 1.0, intervals + 1)
    s = problem.length * (grid - 0.9 * np.sin(2 * np.pi * grid) / (2 * np.pi))
    s = np.unique(np.concatenate((s, problem.borders)))
    n = len(s)
    step = np.diff(s)
    piece = np.searchsorted(problem.borders, (s[1:] + s[:-1]) / 2) - 1
    difference = diags_array([-0.5 / step, 0.5 / step], offsets=[0, 1], shape=(n - 1, n), format="csr")
    ends = [csr_matrix((np.ones(n - 1), (np.arange(n - 1), np.arange(n - 1) + k)), shape=(n - 1, n)) for k in (0, 1)]
    rows = [difference / problem.acceleration, -difference / problem.deceleration]
    upper = np.full(n, problem.velocity**2)
    for coordinate in problem.coordinates:
        for end in (0, 1):
            at = s[end : n - 1 + end]
            first, second = (piecewise(coordinate, order, at, piece) for order in (1, 2))
            row = (
                diags_array(first / coordinate.acceleration) @ difference
                + diags_array(second / coordinate.acceleration) @ ends[end]
            )
            rows += [row, -row]
            with np.errstate(divide="ignore"):
                limit = (coordinate.velocity / np.abs(first)) ** 2
            upper[end : n - 1 + end] = np.minimum(upper[end : n - 1 + end], limit)
    upper[[0, -1]] = 0.0
    matrix = vstack(rows, format="csr")
    scale = problem.velocity**2
    done = linprog(
        -np.ones(n), A_ub=matrix * scale, b_ub=np.ones(matrix.shape[0]), bounds=np.c_[np.zeros(n), upper / scale]
    )
    if done.status != 0:
        raise RuntimeError(f"{problem.name}: {done.message}")
    h = np.maximum(done.x, 0.0) * scale
    root = np.sqrt(h)
    return float(np.sum(2 * step / (root[1:] + root[:-1]))), s, h


def piecewise(coordinate: Coordinate, order: int, s: Array, piece: NDArray[np.int64]) -> Array:
    """A derivative at each s, each taken from the piece named for it."""
    result = np.zeros_like(s)
    for index, shape in enumerate(coordinate.shapes):
        inside = piece == index
        result[inside] = shape.derivative(order, s[inside])
    return result


# --- With limits of jerk ------------------------------------------------------------------------------------------


def solve(problem: Problem, start: Solution, close: bool = False) -> Solution:
    """The optimum near `start`, on its intervals. `close`: the start is the optimum of a coarser grid."""
    length, unit = problem.length, start.time
    to_v, to_a, to_j = unit / length, unit**2 / length, unit**3 / length
    n = len(start.steps)
    pieces = len(problem.borders) - 1
    ratios = np.concatenate(
        [part / part.sum() for part in np.split(start.steps, np.flatnonzero(np.diff(start.piece)) + 1)]
    )

    s, v, a = (ca.MX.sym(name, n + 1) for name in ("s", "v", "a"))
    left, right, times = ca.MX.sym("left", n), ca.MX.sym("right", n), ca.MX.sym("times", pieces)
    steps = ca.mtimes(ca.DM(csr_matrix((ratios, (np.arange(n), start.piece)), shape=(n, pieces))), times)
    constraints: list[ca.MX] = []
    lower: list[Array] = []
    upper: list[Array] = []

    h = steps
    slope = right - left
    for defect in (
        a[:-1] + h * (left + right) / 2 - a[1:],
        v[:-1] + h * a[:-1] + h**2 * (left / 3 + right / 6) - v[1:],
        s[:-1] + h * v[:-1] + h**2 * a[:-1] / 2 + h**3 * (left / 8 + right / 24) - s[1:],
    ):
        constraints.append(defect)
        lower.append(np.zeros(n))
        upper.append(np.zeros(n))
    within = [
        (
            s[:-1] + h * v[:-1] * x + h**2 * a[:-1] * x**2 / 2 + h**3 * (left * x**3 / 6 + slope * x**4 / 24),
            v[:-1] + h * a[:-1] * x + h**2 * (left * x**2 / 2 + slope * x**3 / 6),
            a[:-1] + h * (left * x + slope * x**2 / 2),
            left + slope * x,
        )
        for x in (0.25, 0.5, 0.75)
    ]
    for piece in range(pieces):
        here = np.flatnonzero(start.piece == piece)
        first, last = int(here[0]), int(here[-1]) + 1
        speed, acceleration, jerk = limit_functions(problem, piece, unit)
        if speed is None:
            continue
        rows = [
            ca.vec(speed.map(last - first + 1)(s[first : last + 1].T, v[first : last + 1].T)),
            ca.vec(speed.map(last - first)(*(x[first:last].T for x in within[1][:2]))),
            ca.vec(acceleration.map(last - first + 1)(*(x[first : last + 1].T for x in (s, v, a)))),
            *(ca.vec(acceleration.map(last - first)(*(x[first:last].T for x in point[:3]))) for point in within),
            ca.vec(jerk.map(last - first)(*(x[first:last].T for x in (s, v, a, left)))),
            ca.vec(jerk.map(last - first)(*(x[first:last].T for x in within[1]))),
            ca.vec(jerk.map(last - first)(*(x[first + 1 : last + 1].T for x in (s, v, a)), right[first:last].T)),
        ]
        for row in rows:
            constraints.append(row)
            lower.append(np.full(row.shape[0], -1.0))
            upper.append(np.full(row.shape[0], 1.0))

    for point in within:
        constraints.append(point[2])
        lower.append(np.full(n, -problem.deceleration * to_a))
        upper.append(np.full(n, problem.acceleration * to_a))

    def rest(values: Array) -> Array:
        return np.concatenate(([0.0], values, [0.0]))

    borders = np.asarray(problem.borders) / length
    low_s = np.concatenate((borders[start.piece], [1.0]))
    high_s = np.concatenate(([0.0], borders[start.piece + 1]))
    bounds = [
        (low_s, high_s, start.s / length),
        (np.zeros(n + 1), rest(np.full(n - 1, problem.velocity * to_v)), start.v * to_v),
        (
            rest(np.full(n - 1, -problem.deceleration * to_a)),
            rest(np.full(n - 1, problem.acceleration * to_a)),
            start.a * to_a,
        ),
        (np.full(n, -problem.jerk * to_j), np.full(n, problem.jerk * to_j), start.left * to_j),
        (np.full(n, -problem.jerk * to_j), np.full(n, problem.jerk * to_j), start.right * to_j),
        (
            np.full(pieces, 1e-4),
            np.full(pieces, 1e3),
            [start.steps[start.piece == k].sum() / unit for k in range(pieces)],
        ),
    ]
    for k in range(1, pieces):  # a piece begins where the one before it ends
        node = int(np.flatnonzero(start.piece == k)[0])
        low_s[node] = high_s[node] = borders[k]
    options = {
        "print_time": False,
        "ipopt.print_level": 0,
        "ipopt.sb": "yes",
        "ipopt.max_iter": 1500,
        "ipopt.tol": 1e-7,
        "ipopt.acceptable_tol": 1e-5,
        "ipopt.mu_strategy": "adaptive",
        "ipopt.bound_relax_factor": 1e-9,
    }
    if close:
        options |= {"ipopt.mu_strategy": "monotone", "ipopt.mu_init": 1e-5}
        pushes = ("bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac")
        options |= {f"ipopt.{push}": 1e-6 for push in pushes}
    programme = {"x": ca.vertcat(s, v, a, left, right, times), "f": ca.sum1(times), "g": ca.vertcat(*constraints)}
    solver = ca.nlpsol("solver", "ipopt", programme, options)
    low, high, begin = (np.concatenate([bound[i] for bound in bounds]) for i in range(3))
    found = solver(
        x0=np.clip(begin, low, high), lbx=low, ubx=high, lbg=np.concatenate(lower), ubg=np.concatenate(upper)
    )
    if not solver.stats()["success"]:
        raise RuntimeError(f"{problem.name}: {solver.stats()['return_status']}")
    parts = np.split(np.asarray(found["x"]).ravel(), np.cumsum([n + 1, n + 1, n + 1, n, n]))
    real = ratios * parts[5][start.piece] * unit
    return Solution(
        real.sum(),
        parts[0] * length,
        parts[1] / to_v,
        parts[2] / to_a,
        parts[3] / to_j,
        parts[4] / to_j,
        real,
        start.piece,
    )


def limit_functions(problem: Problem, piece: int, unit: float) -> tuple[ca.Function | None, ...]:
    """Speeds, accelerations and jerks of all coordinates by their limits, s in lengths of the path, time in `unit`."""
    s, v, a, j = (ca.SX.sym(name) for name in "svaj")
    rows: list[list[ca.SX]] = [[], [], []]
    for coordinate in problem.coordinates:
        d1, d2, d3 = (
            coordinate.shapes[piece].symbolic(order, s * problem.length) * problem.length**order for order in (1, 2, 3)
        )
        rows[0].append(d1 * v / (coordinate.velocity * unit))
        rows[1].append((d2 * v**2 + d1 * a) / (coordinate.acceleration * unit**2))
        rows[2].append((d3 * v**3 + 3 * d2 * v * a + d1 * j) / (coordinate.jerk * unit**3))
    if not rows[0]:
        return None, None, None
    arguments = (s, v, a, j)
    return tuple(ca.Function("limits", arguments[: k + 2], [ca.vertcat(*rows[k])]) for k in range(3))


def loads(problem: Problem, solution: Solution, fine: int = 21) -> tuple[Array, Array, Array]:
    """The largest speed, acceleration and jerk of path and coordinates at each sample, by their limits."""
    _, s, v, a, j = solution.sampled(fine)
    piece = np.repeat(solution.piece[:, None], fine, axis=1)
    speed = v / problem.velocity
    acceleration = np.maximum(a / problem.acceleration, -a / problem.deceleration)
    jerk = np.abs(j) / problem.jerk
    for coordinate in problem.coordinates:
        d1, d2, d3 = (piecewise(coordinate, order, s.ravel(), piece.ravel()).reshape(s.shape) for order in (1, 2, 3))
        speed = np.maximum(speed, np.abs(d1 * v) / coordinate.velocity)
        acceleration = np.maximum(acceleration, np.abs(d2 * v**2 + d1 * a) / coordinate.acceleration)
        jerk = np.maximum(jerk, np.abs(d3 * v**3 + 3 * d2 * v * a + d1 * j) / coordinate.jerk)
    return speed, acceleration, jerk


# --- Grids --------------------------------------------------------------------------------------------------------


def on_grid(problem: Problem, t: Array, s: Array, density: Array, intervals: int) -> Solution:
    """The motion s(t) on a new grid: about `intervals` of them, closer where `density` (per point of t) is high."""
    measure = np.concatenate(([0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(t))))
    at_borders = np.interp(problem.borders, s, measure)
    at_borders[[0, -1]] = measure[[0, -1]]
    nodes = [np.zeros(1)]
    piece: list[int] = []
    for k, (begin, end) in enumerate(pairwise(at_borders)):
        count = max(8, round(intervals * (end - begin) / measure[-1]))
        nodes.append(np.linspace(begin, end, count + 1)[1:])
        piece += [k] * count
    times = np.interp(np.concatenate(nodes), measure, t)
    place = np.interp(times, t, s)
    v = np.gradient(place, times)
    v[[0, -1]] = 0.0
    a = np.gradient(v, times)
    a[[0, -1]] = 0.0
    j = np.diff(a) / np.diff(times)
    return Solution(times[-1], place, v, a, j, j, np.diff(times), np.asarray(piece))


def first_guess(problem: Problem, s: Array, h: Array, stretch: float, intervals: int) -> Solution:
    """The optimum without limits of jerk, slowed and smoothed."""
    root = np.sqrt(h)
    t = np.concatenate(([0.0], np.cumsum(2 * np.diff(s) / (root[1:] + root[:-1])))) * stretch
    window = 101
    even = np.linspace(-0.1 * t[-1], 1.1 * t[-1], 2001)
    place = np.interp(even, t, s)
    for _ in range(2):
        place = np.convolve(np.pad(place, window // 2, mode="edge"), np.full(window, 1 / window), mode="valid")
    place = np.maximum.accumulate((place - place[0]) / (place[-1] - place[0]) * problem.length)
    return on_grid(problem, even - even[0], place, np.ones(len(even)), intervals)


def adapted(problem: Problem, solution: Solution, intervals: int) -> Solution:
    """The solution on a new grid, closer where its jerk changes."""
    t, s, _, _, j = (x[:, :-1].ravel() for x in solution.sampled(9))
    t, s, j = np.append(t, solution.time), np.append(s, problem.length), np.append(j, solution.right[-1])
    change = np.sqrt(np.abs(np.gradient(j, np.maximum.accumulate(t + 1e-12 * np.arange(len(t))))))
    change = np.convolve(np.pad(change, 20, mode="edge"), np.full(41, 1 / 41), mode="valid")
    mean = np.trapezoid(change, t) / t[-1]
    return on_grid(problem, t, np.maximum.accumulate(s), 1 + 3 * change / mean, intervals)


def halved(solution: Solution) -> Solution:
    """The same motion with every interval cut in two."""
    _, s, v, a, j = solution.sampled(3)
    node = [np.append(x[:, :2].ravel(), x[-1, 2]) for x in (s, v, a)]
    left, right = j[:, :2].ravel(), j[:, 1:].ravel()
    return Solution(solution.time, *node, left, right, np.repeat(solution.steps / 2, 2), np.repeat(solution.piece, 2))


# --- All together -------------------------------------------------------------------------------------------------


@dataclass
class Optimum:
    """`time` of the finest solution; `feasible`: that of a motion that breaks no limit anywhere.

    `acceleration_only`: the least time without limits of jerk. `violation`: how far the finest solution breaks a limit
    between the points of its grid. `doubling`: by how much its time changed when the intervals were cut in two.
    `shares` of time with a speed, an acceleration, a jerk at its limit. Times of all `starts`.
    """

    time: float
    feasible: float
    acceleration_only: float
    violation: float
    doubling: float
    shares: tuple[float, float, float]
    starts: list[float]
    solution: Solution


def optimum(problem: Problem, intervals: int = 450) -> Optimum:
    lower, s, h = acceleration_only(problem)
    starts: list[Solution] = []
    for stretch in (1.1, 1.4, 2.5, 1.2, 1.8, 4.0):
        times = [solution.time for solution in starts]
        if len(times) >= 3 and max(times) < 1.0005 * min(times):
            break  # wherever one begins, one comes to the same motion
        try:
            starts.append(solve(problem, first_guess(problem, s, h, stretch, intervals * 4 // 9)))
        except RuntimeError as error:
            print(f"{problem.name}, start {stretch}: {error}", flush=True)
    best = min(starts, key=lambda solution: solution.time)
    coarse = solve(problem, adapted(problem, best, intervals))
    fine = solve(problem, halved(coarse), close=True)
    if fine.time / coarse.time - 1 > 0.001 or max(load.max() for load in loads(problem, fine)) > 1.01:
        coarse, fine = fine, solve(problem, halved(fine), close=True)
    speed, acceleration, jerk = loads(problem, fine)
    slowing = max(1.0, speed.max(), acceleration.max() ** (1 / 2), jerk.max() ** (1 / 3))
    weights = np.repeat(fine.steps[:, None] / 21, 21, axis=1) / fine.time
    return Optimum(
        time=fine.time,
        feasible=fine.time * slowing,
        acceleration_only=lower,
        violation=max(speed.max(), acceleration.max(), jerk.max()) - 1,
        doubling=fine.time / coarse.time - 1,
        shares=tuple(float(weights[load > 0.98].sum()) for load in (speed, acceleration, jerk)),
        starts=[solution.time for solution in starts],
        solution=fine,
    )
