"""Motions in closed form, as recordings, for tests that need no engine."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from takt.recording import Recording

Floats = npt.NDArray[np.floating[Any]]
STATES = ("Disabled", "Standstill", "DiscreteMotion", "ContinuousMotion", "Stopping", "ErrorStop")
DT = 0.001


class Move:
    """From 0 to `distance`, at rest at both ends, in seven phases of constant jerk."""

    def __init__(self, distance: float, velocity: float, acceleration: float, jerk: float, start: float) -> None:
        self.jerk_time = acceleration / jerk
        self.ramp = velocity / acceleration - self.jerk_time
        self.cruise = distance / velocity - velocity / acceleration - self.jerk_time
        assert self.ramp >= 0
        assert self.cruise >= 0
        times = (
            self.jerk_time,
            self.ramp,
            self.jerk_time,
            self.cruise,
            self.jerk_time,
            self.ramp,
            self.jerk_time,
        )
        self.phases: list[tuple[float, float, float, float, float]] = []  # from, p, v, a, j
        t, p, v, a = start, 0.0, 0.0, 0.0
        for duration, sign in zip(times, (1, 0, -1, 0, -1, 0, 1), strict=True):
            j = sign * jerk
            self.phases.append((t, p, v, a, j))
            p += v * duration + a * duration**2 / 2 + j * duration**3 / 6
            v += a * duration + j * duration**2 / 2
            a += j * duration
            t += duration
        self.end = t
        self.phases.append((t, distance, 0.0, 0.0, 0.0))

    def at(self, time_s: Floats) -> tuple[Floats, Floats, Floats]:
        position, velocity, acceleration = (np.zeros(len(time_s)) for _ in range(3))
        for t, p, v, a, j in self.phases:
            on = time_s >= t
            x = time_s[on] - t
            position[on] = p + v * x + a * x**2 / 2 + j * x**3 / 6
            velocity[on] = v + a * x + j * x**2 / 2
            acceleration[on] = a + j * x
        return position, velocity, acceleration


def axis(
    time_s: Floats, position: Floats, velocity: Floats, acceleration: Floats, lag: float = 0.0
) -> dict[str, npt.NDArray[Any]]:
    """The columns of an axis; its actual position lags behind by `lag` seconds."""
    behind = velocity * lag
    moving = np.abs(velocity) > 0
    return {
        "time_s": time_s,
        "cycle": np.round(time_s / DT).astype(np.int64),
        "set_position": position,
        "set_velocity": velocity,
        "set_acceleration": acceleration,
        "actual_position": position - behind,
        "actual_velocity": velocity,
        "following_error": behind,
        "state": np.where(moving, 2, 1),
        "in_position": ~moving,
    }


def units(u: str) -> dict[str, str]:
    return {
        "set_position": u,
        "actual_position": u,
        "following_error": u,
        "set_velocity": f"{u}/s",
        "actual_velocity": f"{u}/s",
        "set_acceleration": f"{u}/s²",
    }


LIMITS = {"position": [-1.0, 101.0], "velocity": 200.0, "acceleration": 1000.0, "jerk": 10_000.0}


def one_axis(samples: int = 2000, lag: float = 0.0, **changed: npt.NDArray[Any]) -> Recording:
    """x goes 100 mm, from 0.1 s to 0.9 s, exactly at its limits of 200 mm/s, 1000 mm/s² and 10 m/s³."""
    time_s = np.arange(samples) * DT
    move = Move(100.0, 200.0, 1000.0, 10_000.0, 0.1)
    columns = axis(time_s, *move.at(time_s), lag) | changed
    return Recording(
        {"x": columns},
        {"x": units("mm")},
        names={"x": {"state": STATES}},
        info={"x": {"limits": LIMITS}},
        events=[(0.1, "x", "MoveAbsolute 100", "start"), (move.end, "x", "done", "end")],
    )


def positions(unit: str = "mm", modulus: dict[str, float] | None = None, **curves: Floats) -> Recording:
    """Components with nothing but a set and actual position."""
    tables = {}
    for name, curve in curves.items():
        wrapped = np.mod(curve, modulus[name]) if modulus and name in modulus else curve
        tables[name] = {
            "time_s": np.arange(len(curve)) * DT,
            "set_position": wrapped,
            "actual_position": wrapped,
        }
    return Recording(
        tables,
        {name: {"set_position": unit, "actual_position": unit} for name in curves},
        info={name: {"modulus": m} for name, m in (modulus or {}).items()},
    )
