"""Tracks with the least time along each: makes tests/data/track_optimum.json, which PL-15 is held against.

Not part of the package, not run by the tests. In an environment of its own:

    python3 -m venv build/optimum && build/optimum/bin/pip install . scipy casadi
    build/optimum/bin/python tests/tools/track_problems.py [NAME...]    # all, or those named; a minute each
"""

from __future__ import annotations

import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev, Polynomial
from path_optimum import Array, Coordinate, Optimum, Problem, optimum
from takt.track_layout import LaidTrack, TrackLayout

DATA = Path(__file__).resolve().parents[1] / "data" / "track_optimum.json"
DEGREE = 16


@dataclass
class Bend:
    """Curvature over s on a stretch of a track, as the second derivative of a coordinate that has no other: the
    coordinate's acceleration is the one across the track, curvature * v * v."""

    curvature: Polynomial
    begin: float
    end: float

    def derivative(self, order: int, s: Array) -> Array:
        if order != 2:
            return np.zeros_like(s)
        return np.asarray(self.curvature((2 * s - self.begin - self.end) / (self.end - self.begin)))

    def symbolic(self, order: int, s: ca.SX) -> ca.SX:
        if order != 2:
            return ca.SX(0.0)
        x = (2 * s - self.begin - self.end) / (self.end - self.begin)
        sum_ = ca.SX(0.0)
        for coefficient in self.curvature.coef[::-1]:
            sum_ = sum_ * x + coefficient
        return sum_


def bends(track: LaidTrack) -> tuple[list[float], list[Bend]]:
    """Borders between what was given and what fills the gaps, and the curvature of each stretch."""
    points = track.points
    changes = np.flatnonzero(np.diff(points.given.astype(int))) + 1
    firsts = [0, *changes]
    lasts = [*changes, len(points.s) - 1]
    borders, found = [0.0], []
    for first, last in zip(firsts, lasts, strict=True):
        begin, end = borders[-1], float(points.s[last])
        s, curvature = points.s[first : last + 1], points.curvature[first : last + 1]
        x = (2 * s - begin - end) / (end - begin)
        fit = Chebyshev.fit(x, curvature, min(DEGREE, len(x) - 1), domain=[-1, 1])
        off = np.abs(fit(x) - curvature).max()
        if off > 2e-3 * max(np.abs(points.curvature).max(), 1e-9):
            raise RuntimeError(f"{track.name}: curvature met to {off} only, from {begin} to {end}")
        found.append(Bend(fit.convert(kind=Polynomial), begin, end))
        borders.append(end)
    return borders, found


def elements(seed: int) -> list[dict[str, dict[str, float]]]:
    """Four lines that go off at right angles in turns, as drivers know them: room for a bend between each two."""
    random = np.random.default_rng(seed)
    lines = []
    x = y = 0.0
    for i in range(4):
        length, radius = (round(float(random.uniform(*span)), 1) for span in ((300, 900), (80, 200)))
        side = int(random.choice((-1, 1)))
        to = (x + length, y) if i % 2 == 0 else (x, y + side * length)
        if i % 2:
            y += side * radius
            to = (x, y + side * length)
        lines.append({"from": {"x": x, "y": y}, "to": {"x": to[0], "y": to[1]}})
        x, y = (to[0] + radius, to[1]) if i % 2 == 0 else (to[0] + radius, to[1] + side * radius)
    return lines


def laid(given: list[dict[str, dict[str, float]]]) -> LaidTrack:
    (track,) = TrackLayout(f"tracks: {json.dumps([{'name': 'track', 'elements': given}])}\n").tracks
    return track


def problem(name: str, track: LaidTrack, limits: dict[str, float]) -> Problem:
    borders, shapes = bends(track)
    across = Coordinate(shapes, math.inf, limits["lateral"], math.inf)
    speed, acceleration, jerk = (limits[key] for key in ("velocity", "acceleration", "jerk"))
    return Problem(name, borders, speed, acceleration, acceleration, jerk, [across])


def wanted() -> dict[str, tuple[list[dict[str, dict[str, float]]], dict[str, float]]]:
    """Names, tracks and limits: the same as of movers that are sold, and slower and softer ones."""
    found = {}
    for seed in range(12):
        random = np.random.default_rng(1000 + seed)
        limits = {
            "velocity": round(float(random.uniform(800, 2000)), 0),
            "acceleration": round(float(random.uniform(4000, 12000)), 0),
            "jerk": round(float(random.uniform(1e5, 5e5)), 0),
            "lateral": round(float(random.uniform(3000, 10000)), 0),
        }
        found[f"bends {seed}"] = (elements(seed), limits)
    return found


def entry(name: str, given: Any, limits: dict[str, float], length: float, found: Optimum) -> dict[str, Any]:
    return {
        "name": name,
        "elements": given,
        "length": round(length, 6),
        **limits,
        "optimum_s": round(found.time, 6),
        "acceleration_only_s": round(found.acceleration_only, 6),
    }


def make(names: list[str]) -> None:
    all_of = wanted()
    for name, (given, limits) in all_of.items():
        if names and name not in names:
            continue
        track = laid(given)
        found = optimum(problem(name, track, limits))
        speed, acceleration, jerk = (round(100 * share) for share in found.shares)
        print(
            f"{name:10} {track.length:7.0f} mm, radius {track.smallest_radius:4.0f}: {found.acceleration_only:.4f}"
            f" {found.time:.5f} s, slowed {100 * (found.feasible / found.time - 1):.2f} %, violation"
            f" {100 * found.violation:.2f} %, doubling {100 * found.doubling:+.3f} %, at limit {speed} {acceleration}"
            f" {jerk} %, starts {' '.join(f'{time:.4f}' for time in found.starts)}",
            flush=True,
        )
        known = {each["name"]: each for each in json.loads(DATA.read_text())} if DATA.exists() else {}
        known[name] = entry(name, given, limits, track.length, found)
        DATA.write_text("[\n" + ",\n".join(json.dumps(known[each]) for each in all_of if each in known) + "\n]\n")


if __name__ == "__main__":
    make(sys.argv[1:])
