"""Paths of a Delta robot and a SCARA seen from their joints, with least times: tests/data/path_optimum_joints.json.

Of each path a table: s, and of each joint its position and derivatives by s (q, q1, q2, q3) in mm or deg; q1 and q2 are
those of takt.kinematics, q3 the derivative of a Chebyshev polynomial through q2. Where the curvature of the path jumps,
s stands twice, with the values of either side. There the jerk of the joints is without bounds at any speed above 0:
limits hold within the pieces only.

Run like path_problems.py, after ./dev build; takt needs more (pip install lcm==1.5.3 click rich matplotlib PyYAML):

    PYTHONPATH=build/release/python build/optimum/bin/python tests/tools/path_mechanisms.py [NAME...]
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial import Polynomial as Power
from path_optimum import Array, Coordinate, Optimum, Problem, optimum
from path_problems import summary
from takt.kinematics import Kinematics

DATA = Path(__file__).resolve().parents[1] / "data" / "path_optimum_joints.json"

# position, direction and curvature of the tool at s, rows of X, Y, Z
Piece = tuple[float, Callable[[Array], tuple[Array, Array, Array]]]


class Polynomial:
    """A joint along one piece of a path."""

    def __init__(self, first: Chebyshev, second: Chebyshev) -> None:
        self.orders = {1: first, 2: second, 3: second.deriv()}

    def derivative(self, order: int, s: Array) -> Array:
        return self.orders[order](s)

    def symbolic(self, order: int, s: ca.SX) -> ca.SX:
        polynomial = self.orders[order]
        offset, scale = polynomial.mapparms()
        x = offset + scale * s
        above, above2 = ca.SX(0), ca.SX(0)
        for coefficient in polynomial.coef[:0:-1]:  # Clenshaw
            above, above2 = coefficient + 2 * x * above - above2, above
        return polynomial.coef[0] + x * above - above2


# --- Paths --------------------------------------------------------------------------------------------------------


def line(start: Sequence[float], end: Sequence[float]) -> Piece:
    begin, way = np.asarray(start, float), np.subtract(end, start)
    length = float(np.linalg.norm(way))
    direction = way / length

    def at(s: Array) -> tuple[Array, Array, Array]:
        return begin + s[:, None] * direction, np.tile(direction, (len(s), 1)), np.zeros((len(s), 3))

    return length, at


def arc(center: Sequence[float], start: Sequence[float], direction: Sequence[float], angle: float) -> Piece:
    """`direction`: a unit vector, the way it sets out from `start`; `angle` in rad."""
    outward, radius = np.subtract(start, center), math.dist(start, center)
    along = np.asarray(direction, float) * radius

    def at(s: Array) -> tuple[Array, Array, Array]:
        cos, sin = np.cos(s / radius)[:, None], np.sin(s / radius)[:, None]
        spoke = outward * cos + along * sin
        return np.asarray(center) + spoke, (along * cos - outward * sin) / radius, -spoke / radius**2

    return radius * angle, at


def pick(start: Sequence[float], way: float, height: float, radius: float) -> list[Piece]:
    """Up by `height`, along Y by `way`, down by `height`; the corners are arcs."""
    x, y, z = start
    top, low = z + height, z + height - radius
    near, far = y + radius, y + way - radius
    quarter = math.pi / 2
    return [
        line((x, y, z), (x, y, low)),
        arc((x, near, low), (x, y, low), (0, 0, 1), quarter),
        line((x, near, top), (x, far, top)),
        arc((x, far, low), (x, far, top), (0, 1, 0), quarter),
        line((x, y + way, low), (x, y + way, z)),
    ]


def corner(start: Sequence[float], apex: Sequence[float], end: Sequence[float]) -> Piece:
    """Instead of the corner at `apex`, as far from `start` as from `end`: the blend of cpp/takt/path/blend.h."""
    begin, finish = np.asarray(start, float), np.asarray(end, float)
    first, second = np.subtract(apex, begin), np.subtract(finish, apex)
    distance = float(np.linalg.norm(first))
    q = math.sqrt((1 + float(first @ second) / distance**2) / 2)
    share = q / (0.2067 + 0.28 * q)  # of the tangents at both ends over the distance
    u = Power([0, 1])
    # Hermite's polynomials of the fifth degree, without curvature at the ends.
    place = 10 * u**3 - 15 * u**4 + 6 * u**5
    leave = u - 6 * u**3 + 8 * u**4 - 3 * u**5
    join = -4 * u**3 + 7 * u**4 - 3 * u**5
    axes = [
        a + (b - a) * place + share * (c * leave + d * join)
        for a, b, c, d in zip(begin, finish, first, second, strict=True)
    ]

    def rows(order: int, x: Array) -> Array:
        return np.column_stack([axis.deriv(order)(x) if order else axis(x) for axis in axes])

    speed = Chebyshev.interpolate(lambda x: np.linalg.norm(rows(1, x), axis=1), 60, domain=[0, 1])
    way = speed.integ(lbnd=0)
    length = float(way(1.0))

    def at(s: Array) -> tuple[Array, Array, Array]:
        x = s / length
        for _ in range(20):
            x = x - (way(x) - s) / speed(x)
        velocity, acceleration = rows(1, x), rows(2, x)
        pace = np.linalg.norm(velocity, axis=1)[:, None]
        tangent = velocity / pace
        along = (acceleration * tangent).sum(axis=1)[:, None]
        return rows(0, x), tangent, (acceleration - along * tangent) / pace**2

    return length, at


def blended_pick(start: Sequence[float], way: float, height: float, distance: float) -> list[Piece]:
    """The same with blends that begin and end at a distance from the corners."""
    x, y, z = start
    top, low, near, far = z + height, z + height - distance, y + distance, y + way - distance
    ends = (x, y, z), (x, y, low), (x, near, top), (x, far, top), (x, y + way, low), (x, y + way, z)
    return [
        line(ends[0], ends[1]),
        corner(ends[1], (x, y, top), ends[2]),
        line(ends[2], ends[3]),
        corner(ends[3], (x, y + way, top), ends[4]),
        line(ends[4], ends[5]),
    ]


# --- Through the joints -------------------------------------------------------------------------------------------


def through(robot: Kinematics, piece: Piece, s: Array, near: Array | None = None) -> tuple[Array, Array, Array]:
    """q, q' and q'' (rows of joints) at s, the tool keeping its orientation."""
    position, direction, curvature = (np.pad(rows, ((0, 0), (0, 3))) for rows in piece[1](s))
    found = robot.inverse_motion(position, direction, curvature, near, path=True)
    assert found.ok.all(), found.reasons
    return found.joints, found.velocities, found.accelerations


def fitted(robot: Kinematics, piece: Piece) -> list[Polynomial]:
    degree = 48
    length = piece[0]
    s = length * (1 - np.cos(np.pi * np.arange(degree + 1) / degree)) / 2
    _, first, second = through(robot, piece, s)
    polynomials = []
    for joint in range(robot.axes):
        fits = [Chebyshev.fit(s, values[:, joint], degree, domain=[0, length]) for values in (first, second)]
        both = [fit.trim(1e-13 * (np.abs(fit.coef).max() + 1e-12)) for fit in fits]
        test = np.linspace(0, length, 333)
        _, first_test, second_test = through(robot, piece, test)
        for fit, exact in ((both[0], first_test), (both[1], second_test), (both[0].deriv(), second_test)):
            error = np.abs(fit(test) - exact[:, joint]).max()
            assert error < 1e-7 * (np.abs(exact[:, joint]).max() + 1e-3), error
        polynomials.append(Polynomial(*both))
    return polynomials


Limits = tuple[tuple[float, float, float], ...]  # speed, acceleration, jerk of each joint

MECHANISMS: dict[str, tuple[dict[str, Any], Limits]] = {
    "delta": (
        {"delta": {"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 800}},
        ((400, 5000, 2.5e5),) * 3,
    ),
    # As strong as tests/cpp/group/machines.h has it: of the class that moves 0.1 kg.
    "strong delta": (
        {"delta": {"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 800}},
        ((800, 20000, 1e6),) * 3,
    ),
    "scara": (
        {"scara": {"first_arm": 325, "second_arm": 275, "height": 387}},
        ((450, 4000, 1e5), (720, 8000, 3e5), (1100, 15000, 6e5), (2400, 30000, 1e6)),
    ),
}


def paths() -> dict[str, tuple[str, tuple[float, float, float, float], list[Piece]]]:
    """Mechanism, path limits (speed, acceleration, deceleration, jerk) and pieces."""
    delta, scara = (4000.0, 4e4, 4e4, 2e6), (3000.0, 2e4, 2e4, 8e5)
    strong = (4000.0, 6e4, 6e4, 3e6)
    turn = 2 * math.pi
    return {
        "delta line": ("delta", delta, [line((-150, 60, -760), (150, 60, -760))]),
        "delta pick": ("delta", delta, pick((50, -152.5, -800), 305, 25, 20)),
        "delta circle": ("delta", delta, [arc((40, 0, -780), (120, 0, -780), (0, 1, 0), turn)]),
        "delta standard cycle": ("strong delta", strong, blended_pick((0, -152.5, -850), 305, 25, 12.5)),
        "scara line": ("scara", scara, [line((260, -150, 300), (260, 150, 300))]),
        "scara pick": ("scara", scara, pick((380, -152.5, 250), 305, 25, 20)),
        "scara circle": ("scara", scara, [arc((380, 100, 300), (460, 100, 300), (0, 1, 0), turn)]),
    }


def posed(name: str) -> tuple[Problem, Kinematics, list[Piece]]:
    mechanism, limits, pieces = paths()[name]
    robot = Kinematics(**MECHANISMS[mechanism][0])
    ends = np.concatenate(([0.0], np.cumsum([piece[0] for piece in pieces])))
    shapes = [fitted(robot, piece) for piece in pieces]
    shifted = [
        [Polynomial(*(moved(joint.orders[order], begin) for order in (1, 2))) for joint in joints]
        for joints, begin in zip(shapes, ends[:-1], strict=True)
    ]
    coordinates = [
        Coordinate([joints[k] for joints in shifted], *MECHANISMS[mechanism][1][k]) for k in range(robot.axes)
    ]
    return Problem(name, ends.tolist(), *limits, coordinates), robot, pieces


def moved(polynomial: Chebyshev, by: float) -> Chebyshev:
    return Chebyshev(polynomial.coef, domain=polynomial.domain + by)


def table(problem: Problem, robot: Kinematics, pieces: list[Piece]) -> dict[str, Any]:
    """The path about every 2.5 mm, both sides of each border."""
    columns: dict[str, list[Array]] = {"s": [], "q": [], "q1": [], "q2": [], "q3": []}
    near = None
    for k, piece in enumerate(pieces):
        s = np.linspace(0, piece[0], max(9, round(piece[0] / 2.5) + 1))
        q, first, second = through(robot, piece, s, near)
        near = q[-1]
        third = np.column_stack([each.shapes[k].derivative(3, s + problem.borders[k]) for each in problem.coordinates])
        for column, values in zip(columns, (s + problem.borders[k], q, first, second, third), strict=True):
            columns[column].append(values)
    result: dict[str, Any] = {"s": shortened(np.concatenate(columns["s"]))}
    for column in ("q", "q1", "q2", "q3"):
        result[column] = [shortened(values) for values in np.concatenate(columns[column]).T]
    return result


def shortened(values: Array) -> list[float]:
    largest = np.abs(values).max()
    digits = 9 - math.ceil(math.log10(largest)) if largest > 1e-9 else 3
    return [round(float(value), digits) + 0.0 for value in values]


def entry(name: str, problem: Problem, robot: Kinematics, pieces: list[Piece], found: Optimum) -> dict[str, Any]:
    mechanism, limits = MECHANISMS[paths()[name][0]]
    return {
        "name": name,
        "mechanism": mechanism,
        "length": problem.length,
        "path": {k: getattr(problem, k) for k in ("velocity", "acceleration", "deceleration", "jerk")},
        "joints": [dict(zip(("velocity", "acceleration", "jerk"), each, strict=True)) for each in limits],
        **table(problem, robot, pieces),
        "optimum_s": round(found.time, 6),
        "acceleration_only_s": round(found.acceleration_only, 6),
    }


def main(names: list[str]) -> None:
    known = {each["name"]: each for each in json.loads(DATA.read_text())} if DATA.exists() else {}
    for name in names or paths():
        problem, robot, pieces = posed(name)
        found = optimum(problem)
        print(summary(problem, found), flush=True)
        known[name] = entry(name, problem, robot, pieces, found)
        DATA.write_text("[\n" + ",\n".join(json.dumps(known[each]) for each in paths() if each in known) + "\n]\n")


if __name__ == "__main__":
    main(sys.argv[1:])
