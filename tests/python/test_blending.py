"""Moves that blend, with a look at all that wait (docs/axis.md)."""

from __future__ import annotations

import itertools
import math
import random

import numpy as np
import pytest
import takt

VELOCITY, ACCELERATION, JERK = 250.0, 4000.0, 90000.0
MACHINE = f"""
name: blends
axes:
  - {{name: x, limits: {{velocity: {VELOCITY}, acceleration: {ACCELERATION}, jerk: {JERK}}}}}
"""
MODES = ("blending_low", "blending_previous", "blending_next", "blending_high")


def ramp_s(velocity: float) -> float:
    """Time from rest to a velocity, in closed form."""
    if velocity * JERK >= ACCELERATION**2:
        return velocity / ACCELERATION + ACCELERATION / JERK
    return 2 * math.sqrt(velocity / JERK)


def move_s(distance: float, velocity: float) -> float:
    """Time of a move from rest to rest that reaches its velocity."""
    assert velocity * ramp_s(velocity) <= distance
    return ramp_s(velocity) + distance / velocity


def chain(s: takt.Engine, distances: list[float], velocity: float, mode: str) -> takt.Recording:
    """Moves one after another, always as many waiting as there can be."""
    x = s.axis("x")
    x.power().wait()
    last = None
    with s.record("x") as recorder:
        for i, distance in enumerate(distances):
            s.wait(lambda: x.buffered_commands < 8)
            last = x.move_relative(distance=distance, velocity=velocity, buffer_mode=mode if i else "aborting")
            s.step(1)
        assert last is not None
        last.wait(timeout=100)
    return recorder.recording


def within_limits(recording: takt.Recording) -> None:
    takt.expect.within_limits(recording, "x")
    v = np.asarray(recording["x"]["set_velocity"])
    p = np.asarray(recording["x"]["set_position"])
    assert np.abs(np.diff(p) - 0.5 * (v[1:] + v[:-1]) * 0.001).max() < 1e-4  # no step


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("count", "length", "velocity"), [(40, 3.0, 150.0), (25, 7.0, 250.0), (60, 1.5, 120.0)])
def test_a_chain_of_moves_takes_as_long_as_one_move(mode: str, count: int, length: float, velocity: float) -> None:
    """AX-103: where the braking distance lies within the moves that wait, within 2 % of the time in closed form."""
    assert 0.5 * velocity * ramp_s(velocity) < 8 * length
    with takt.Engine(MACHINE) as s:
        recording = chain(s, [length] * count, velocity, mode)
        assert s.axis("x").set_position == pytest.approx(count * length, abs=1e-9)
    moving = np.count_nonzero(np.asarray(recording["x"]["set_velocity"])) * 0.001
    assert moving == pytest.approx(move_s(count * length, velocity), rel=0.02)
    within_limits(recording)
    assert np.asarray(recording["x"]["set_velocity"]).max() == pytest.approx(velocity, abs=1e-6)


def test_moves_too_short_for_all_that_wait_say_so() -> None:
    """AX-103: the speed is what can be braked from within eight moves, and limited_by says distance."""
    with takt.Engine(MACHINE) as s:
        recording = chain(s, [0.4] * 50, 200.0, "blending_high")
    fastest = np.asarray(recording["x"]["set_velocity"]).max()
    assert 0.5 * fastest * ramp_s(fastest) == pytest.approx(9 * 0.4, rel=0.15)
    distance = list(takt.LimitedBy).index(takt.LimitedBy.DISTANCE)
    assert set(np.asarray(recording["x"]["limited_by"])[20:60]) == {distance}
    within_limits(recording)


@pytest.mark.parametrize("seed", range(6))
def test_random_chains(seed: int) -> None:
    """AX-12, AX-103: all lengths, velocities, ramps, modes, reversals, with the override changed on the way: every move
    ends where it was to, set points keep their limits and make no step."""
    rnd = random.Random(seed)
    with takt.Engine(MACHINE) as s:
        x = s.axis("x")
        x.power().wait()
        due = 0.0
        moves = []
        with s.record("x") as recorder:
            for i in range(60):
                s.wait(lambda: x.buffered_commands < 8)
                distance = (
                    rnd.choice([0.01, 0.3, 2.0, 15.0]) * rnd.uniform(0.5, 1.5) * (-1 if rnd.random() < 0.15 else 1)
                )
                due += distance
                same = rnd.random() < 0.6
                moves.append(
                    x.move_relative(
                        distance=distance,
                        velocity=150.0 if same else rnd.uniform(5, VELOCITY),
                        acceleration=None if same else rnd.uniform(500, ACCELERATION),
                        buffer_mode=rnd.choice((*MODES, "buffered")) if i else "aborting",
                    )
                )
                if rnd.random() < 0.1:
                    x.set_override(velocity_factor=rnd.choice([0.0, 0.1, 0.5, 1.0]))
                    s.step(rnd.randrange(1, 30))
                    x.set_override(velocity_factor=1)
                s.step(rnd.choice([1, 1, 5, 40]))
            moves[-1].wait(timeout=100)
        assert all(move.done for move in moves)
        assert x.set_position == pytest.approx(due, abs=1e-7)
    within_limits(recorder.recording)


def test_what_waits_and_cannot_be_done_is_no_room() -> None:
    """AX-103: a move behind that leads out of the SW limits is not counted on: the axis rests before it."""
    with takt.Engine(MACHINE.replace("jerk:", "upper: 20, jerk:")) as s:
        x = s.axis("x")
        x.power().wait()
        moves = [x.move_relative(distance=4, velocity=180)]
        moves += [x.move_relative(distance=4, velocity=180, buffer_mode="blending_high") for _ in range(7)]
        with s.record("x") as recorder:
            s.run(1.0)
        assert not any(move.busy for move in moves)
        assert [move.done for move in moves] == [True] * 5 + [False] * 3
        assert moves[5].error_id == 8
        assert x.set_position == pytest.approx(20)
        assert x.state is takt.PlcState.STANDSTILL
        assert max(itertools.chain(recorder.recording["x"]["set_position"])) <= 20 + 1e-9
        within_limits(recorder.recording)
