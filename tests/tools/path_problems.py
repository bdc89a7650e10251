"""Paths and limits for tests of path timing, with the least time of each: makes tests/data/path_optimum.json.

Not part of the package, not run by the tests. In an environment of its own:

    python3 -m venv build/optimum && build/optimum/bin/pip install numpy scipy casadi ruckig
    build/optimum/bin/python tests/tools/path_problems.py check             # solver against closed forms and Ruckig
    build/optimum/bin/python tests/tools/path_problems.py make [NAME...]    # all, or those named; a minute each
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from path_optimum import Coordinate, Harmonics, Optimum, Problem, optimum
from ruckig import InputParameter, Ruckig, Trajectory

DATA = Path(__file__).resolve().parents[1] / "data" / "path_optimum.json"


def rounded(value: float) -> float:
    """As few digits as the file shall have: the solver must work with the very same."""
    return float(f"{value:.6g}")


def coordinate(
    velocity: float,
    acceleration: float,
    jerk: float,
    slope: float = 0.0,
    harmonics: list[tuple[float, float, float]] | None = None,
) -> Coordinate:
    terms = [(rounded(a), rounded(f), rounded(p)) for a, f, p in harmonics or []]
    shape = Harmonics(0.0, rounded(slope), terms)
    return Coordinate([shape], rounded(velocity), rounded(acceleration), rounded(jerk))


def problem(
    name: str, length: float, path: tuple[float, float, float, float], coordinates: list[Coordinate]
) -> Problem:
    """`path`: speed, acceleration, deceleration, jerk."""
    return Problem(name, [0.0, rounded(length)], *(rounded(x) for x in path), coordinates)


# --- Kinds of paths -----------------------------------------------------------------------------------------------

Range = tuple[float, float]


def winding(
    name: str,
    seed: int,
    length: float,
    velocity: Range,
    acceleration: Range,
    jerk: Range,
    waves: float = 5.0,
    count: int = 3,
    deceleration: float = 1.0,
) -> Problem:
    """Random harmonics of at most `waves` waves over the length, limits drawn from ranges; deceleration as a ratio."""
    random = np.random.default_rng(seed)

    def draw(limits: Range) -> float:
        return float(np.exp(random.uniform(*np.log(limits))))

    def shape() -> tuple[float, list[tuple[float, float, float]]]:
        frequencies = 2 * math.pi / length * random.uniform(0.5, waves, 3)
        return random.uniform(-0.7, 0.7), [
            (random.uniform(0.1, 0.5) / f, float(f), random.uniform(0, 2 * math.pi)) for f in frequencies
        ]

    coordinates = [coordinate(draw(velocity), draw(acceleration), draw(jerk), *shape()) for _ in range(count)]
    along = draw(acceleration)
    return problem(name, length, (draw(velocity), along, along * deceleration, draw(jerk)), coordinates)


def zigzag(
    name: str, length: float, bends: int, width: float, path: tuple[float, float, float, float], slack: float
) -> Problem:
    """Straight legs at 45 degrees with `bends` bends, rounded over about `width` of a leg."""
    frequency = math.pi * bends / length
    harmonics = []
    for m in range(1, int(3.3 / width), 2):
        sign = (-1) ** ((m - 1) // 2)
        amplitude = math.sqrt(8) / (math.pi * m) * 2 / (math.pi * m) / 2 * math.pi / frequency / 2
        harmonics.append((sign * amplitude * math.exp(-((m * width) ** 2) / 2), m * frequency, 0.0))
    v, a, _, j = (x * slack for x in path)
    return problem(
        name, length, path, [coordinate(v, a, j, slope=math.sqrt(0.5)), coordinate(v, a, j, harmonics=harmonics)]
    )


def burst(
    name: str, length: float, wave: float, order: int, path: tuple[float, float, float, float], slack: float
) -> Problem:
    """Straight but for the middle, which winds at wave length `wave`: sin(s) * cos(s)**(2 * order) as sines."""
    carrier, envelope = 2 * math.pi / wave, math.pi / length
    v, a, _, j = (x * slack for x in path)
    shapes = []
    for phase in (0.0, math.pi / 2):
        terms = []
        for m in range(-order, order + 1):
            weight = math.comb(2 * order, order + m) / 4**order
            shift = phase - carrier * length / 2 - m * math.pi
            terms.append((0.5 / carrier * weight, carrier + 2 * m * envelope, math.remainder(shift, 2 * math.pi)))
        shapes.append(terms)
    return problem(
        name,
        length,
        path,
        [coordinate(v, a, j, slope=0.9), *(coordinate(v, a, j, harmonics=terms) for terms in shapes)],
    )


def warped(name: str, length: float, depth: float, waves: int, limits: tuple[float, float, float]) -> Problem:
    """One coordinate, which never turns back and alone is limited: its best motion is that of a straight line."""
    frequency = 2 * math.pi * waves / length
    path = (limits[0] * 5, limits[1] * 50, limits[1] * 50, limits[2] * 3000)
    return problem(
        name, length, path, [coordinate(*limits, slope=1.0, harmonics=[(depth / frequency, frequency, 0.4)])]
    )


def circle(name: str, radius: float, turns: float, path: tuple[float, float, float, float], slack: float) -> Problem:
    v, a, _, j = (x * slack for x in path)
    return problem(
        name,
        2 * math.pi * radius * turns,
        path,
        [coordinate(v, a, j, harmonics=[(radius, 1 / radius, phase)]) for phase in (0.0, math.pi / 2)],
    )


def problems() -> list[Problem]:
    line = {"coordinates": []}
    jerk = {"velocity": (1000.0, 3000.0), "acceleration": (1e4, 3e4), "jerk": (2e4, 1e5)}
    acceleration = {"velocity": (1000.0, 3000.0), "acceleration": (2e3, 8e3), "jerk": (1e5, 5e5)}
    speed = {"velocity": (100.0, 300.0), "acceleration": (5e3, 3e4), "jerk": (2e5, 1e6)}
    mixed = {"velocity": (200.0, 1500.0), "acceleration": (3e3, 2e4), "jerk": (1e5, 1e6)}
    return [
        problem("line short", 5, (1000, 1e4, 1e4, 1e5), **line),
        problem("line medium", 150, (1000, 5e3, 5e3, 1e5), **line),
        problem("line long", 500, (800, 8e3, 8e3, 2e5), **line),
        problem("line long asymmetric", 600, (1000, 1e4, 4e3, 1e5), **line),
        problem(
            "line in space asymmetric",
            300,
            (1500, 1e4, 3e3, 3e5),
            [coordinate(600, 9e3, 1e5, 0.6), coordinate(900, 4e3, 2e5, -0.8), coordinate(500, 9e3, 3e5, 0.0)],
        ),
        warped("warped jerk", 60, 0.3, 2, (1000, 2e4, 5e4)),
        warped("warped acceleration", 300, 0.4, 3, (1500, 4e3, 4e5)),
        warped("warped speed", 400, 0.3, 4, (300, 5e3, 2e5)),
        winding("winding jerk 1", 1, 200, **jerk),
        winding("winding jerk 2", 2, 600, **jerk),
        winding("winding jerk 3", 3, 50, **jerk),
        winding("winding jerk 4", 4, 1500, **jerk, waves=3),
        winding("winding jerk asymmetric", 5, 400, **jerk, deceleration=0.4),
        winding("winding acceleration 1", 11, 500, **acceleration),
        winding("winding acceleration 2", 12, 1000, **acceleration, waves=3),
        winding("winding acceleration 3", 13, 250, **acceleration, waves=2),
        winding("winding acceleration 4", 14, 2000, **acceleration, waves=8),
        winding("winding acceleration asymmetric", 15, 800, **acceleration, deceleration=0.3),
        winding("winding speed 1", 21, 300, **speed),
        winding("winding speed 2", 22, 500, **speed, waves=3),
        winding("winding speed 3", 23, 150, **speed, waves=2),
        winding("winding mixed 1", 31, 300, **mixed),
        winding("winding mixed 2", 32, 700, **mixed),
        winding("winding mixed asymmetric", 33, 1000, **mixed, deceleration=2.5),
        winding("winding six coordinates", 41, 600, **mixed, count=6),
        zigzag("zigzag rounded", 600, 4, 0.2, (1000, 1e4, 1e4, 5e5), 0.9),
        zigzag("zigzag sharp", 1200, 3, 0.06, (2000, 6e3, 6e3, 1e6), 0.9),
        burst("burst", 800, 60, 6, (1500, 5e3, 5e3, 2e5), 0.9),
        burst("burst sharp", 800, 30, 8, (2000, 1e4, 1e4, 1e6), 0.9),
        burst("ripple", 400, 16, 1, (800, 2e4, 2e4, 2e5), 1.0),
        circle("circle", 80, 1, (1000, 1e4, 1e4, 2e5), 0.8),
        circle("circle twice asymmetric", 50, 2, (800, 8e3, 4e3, 1e5), 1.2),
    ]


# --- Against closed forms -----------------------------------------------------------------------------------------


def straight_time(length: float, velocity: float, acceleration: float, deceleration: float, jerk: float) -> float:
    """Ruckig's time over a straight line from rest to rest."""
    wanted = InputParameter(1)
    wanted.target_position = [length]
    wanted.max_velocity, wanted.max_acceleration, wanted.max_jerk = [velocity], [acceleration], [jerk]
    wanted.min_acceleration = [-deceleration]
    trajectory = Trajectory(1)
    Ruckig(1).calculate(wanted, trajectory)
    return float(trajectory.duration)


def closed_form(length: float, velocity: float, acceleration: float, jerk: float) -> float:
    """Seven phases, or fewer: the textbook's time over a straight line from rest to rest."""
    if velocity * jerk >= acceleration**2:  # the acceleration is reached where there is room
        top = (-(acceleration**2) + math.sqrt(acceleration**4 + 4 * acceleration * jerk**2 * length)) / (2 * jerk)
        top = min(top, velocity)
        if top * jerk >= acceleration**2:
            return length / top + top / acceleration + acceleration / jerk
    top = min((length / 2) ** (2 / 3) * jerk ** (1 / 3), velocity)
    return length / top + 2 * math.sqrt(top / jerk)


def straight(given: Problem) -> tuple[float, float] | None:
    """Time by Ruckig and by the closed form (NaN where not symmetric) of what is a straight line, bent or not."""
    if given.name.startswith("warped"):
        (only,) = given.coordinates
        ends = [only.shapes[0].value(np.array([s]))[0] for s in (0.0, given.length)]
        limits = (ends[1] - ends[0], only.velocity, only.acceleration, only.acceleration, only.jerk)
    elif given.name.startswith("line"):
        limits = (given.length, given.velocity, given.acceleration, given.deceleration, given.jerk)
        for each in given.coordinates:
            slope = abs(each.shapes[0].slope) or 1e-9
            own = (math.inf, each.velocity, each.acceleration, each.acceleration, each.jerk)
            limits = tuple(min(a, b / slope) for a, b in zip(limits, own, strict=True))
    else:
        return None
    length, velocity, acceleration, deceleration, jerk = limits
    even = acceleration == deceleration
    return straight_time(*limits), closed_form(length, velocity, acceleration, jerk) if even else math.nan


def check() -> None:
    for given in problems():
        known = straight(given)
        if known is not None:
            found = optimum(given)
            print(
                f"{given.name:28} Ruckig {known[0]:.6f} s, closed form {known[1]:.6f} s, here {found.time:.6f} s"
                f" ({100 * (found.time / known[0] - 1):+.3f} %), slowed {found.feasible:.6f} s",
                flush=True,
            )


# --- The file -----------------------------------------------------------------------------------------------------


def entry(given: Problem, found: Optimum) -> dict[str, Any]:
    return {
        "name": given.name,
        "length": given.length,
        "path": {k: getattr(given, k) for k in ("velocity", "acceleration", "deceleration", "jerk")},
        "coordinates": [
            {
                "offset": each.shapes[0].offset,
                "slope": each.shapes[0].slope,
                "harmonics": [list(term) for term in each.shapes[0].harmonics],
                "velocity": each.velocity,
                "acceleration": each.acceleration,
                "jerk": each.jerk,
            }
            for each in given.coordinates
        ],
        "optimum_s": round(found.time, 6),
        "acceleration_only_s": round(found.acceleration_only, 6),
    }


def write(entries: list[dict[str, Any]]) -> None:
    """One problem a line: the file is read by programs, and a problem solved again is one line changed."""
    DATA.parent.mkdir(exist_ok=True)
    DATA.write_text("[\n" + ",\n".join(json.dumps(each) for each in entries) + "\n]\n")


def summary(given: Problem, found: Optimum) -> str:
    speed, acceleration, jerk = (round(100 * share) for share in found.shares)
    return (
        f"{given.name:32} {found.acceleration_only:8.4f} {found.time:9.5f} s"
        f"  slowed {100 * (found.feasible / found.time - 1):.2f} %"
        f"  violation {100 * found.violation:.2f} %  doubling {100 * found.doubling:+.3f} %"
        f"  at limit v {speed} a {acceleration} j {jerk} %  fastest {found.solution.v.max():.0f}"
        f"  starts {' '.join(f'{time:.4f}' for time in found.starts)}"
    )


def make(names: list[str]) -> None:
    wanted = problems()
    for given in wanted:
        if not names or given.name in names:
            found = optimum(given)
            print(summary(given, found), flush=True)
            known = {each["name"]: each for each in json.loads(DATA.read_text())} if DATA.exists() else {}
            known[given.name] = entry(given, found)
            write([known[each.name] for each in wanted if each.name in known])


if __name__ == "__main__":
    commands = {"check": lambda names: check(), "make": make}
    commands[sys.argv[1]](sys.argv[2:])
