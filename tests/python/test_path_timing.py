"""Motion along paths: limits that hold at every instant, corners that cost no time (docs/groups.md, Path timing)."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
import takt
from machines import new_url, running
from takt.lcmlog import open_log

Points = list[tuple[float, float, float]]
Disturb = Callable[[takt.Engine, takt.Group], None]
LONG = os.environ.get("TAKT_LONG") == "1"
PERIOD = 1e-3
FASTER = "name: {}, unit: mm, limits: {{velocity: 1000, acceleration: 10000, jerk: 200000}}"
WITHIN = 1 + 1e-6


class Limits(NamedTuple):
    velocity: float
    acceleration: float
    jerk: float


class Case(NamedTuple):
    points: Points
    limits: Limits
    deviation: float


def values(limits: Limits, choice: str = "") -> str:
    return f"{{velocity: {limits.velocity!r}, acceleration: {limits.acceleration!r}, jerk: {limits.jerk!r}{choice}}}"


def machine(points: Points, limits: Limits, choice: str = "", others: str = "") -> str:
    path = values(limits, choice)
    axes = "".join(f"  - {{name: {name}, unit: mm, limits: {values(limits)}}}\n" for name in "xyz")
    elements = "".join(f"      - {{shape: line, to: {{x: {x!r}, y: {y!r}, z: {z!r}}}}}\n" for x, y, z in points)
    return (
        f"name: gantry\naxes:\n{axes}groups:\n"
        f"  - {{name: g, axes: [x, y, z], kinematics: {{gantry: {{axes: [x, y, z]}}}}, path: {path}}}\n"
        f"paths:\n  - name: p\n    elements:\n{elements}{others}"
    )


def go(case: Case, rounded: bool, disturb: Disturb | None = None) -> tuple[float, takt.Recording]:
    with takt.Engine(machine(case.points, case.limits)) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        began = session.now
        with session.record("g", "x", "y", "z") as recorder:
            if rounded:
                done = group.move_path(
                    path="p", transition_mode="max_corner_deviation", transition_parameter=case.deviation
                )
            else:
                done = group.move_path(path="p")
            if disturb is not None:
                disturb(session, group)
            done.wait(timeout=200)
            took = session.now - began
        return took, recorder.recording


def off_path(points: Points, recording: takt.Recording) -> float:
    """How far set points are from the nearest line, mm."""
    tool = np.stack([recording[name]["set_position"] for name in "xyz"], axis=1)
    least: npt.NDArray[np.floating] = np.full(len(tool), np.inf)
    corners = [np.zeros(3), *map(np.array, points)]
    for begin, end in itertools.pairwise(corners):
        along = end - begin
        share = np.clip((tool - begin) @ along / (along @ along), 0, 1)
        least = np.minimum(least, np.linalg.norm(tool - begin - share[:, None] * along, axis=1))
    return float(least.max())


def check_limits(case: Case, recording: takt.Recording) -> None:
    """Velocity, acceleration and jerk of the path and of each axis, and the tool on its path."""
    limits = case.limits
    path = recording["g"]
    assert path["path_velocity"].min() >= -1e-9
    assert path["path_velocity"].max() <= WITHIN * limits.velocity
    assert np.abs(path["path_acceleration"]).max() <= WITHIN * limits.acceleration
    assert np.abs(np.diff(path["path_acceleration"])).max() <= WITHIN * limits.jerk * PERIOD
    speed = 0.0
    for name in "xyz":
        axis = recording[name]
        speed += axis["set_velocity"] ** 2
        assert np.abs(axis["set_acceleration"]).max() <= WITHIN * limits.acceleration
        # From positions alone: no motion within the limits passes through samples that differ by more.
        assert np.abs(np.diff(axis["set_position"], 3)).max() <= (1 + 1e-4) * limits.jerk * PERIOD**3
    # The axes follow the path: none had to keep its own limits against it.
    assert np.abs(np.sqrt(speed) - path["path_velocity"]).max() <= 2e-3
    assert off_path(case.points, recording) <= case.deviation + 1e-3


def random_case(rng: np.random.Generator, least_leg: float = 0.1) -> Case:
    """Three to eight lines of `least_leg` to 100 mm that turn by any angle."""
    points: Points = []
    at = np.zeros(3)
    for _ in range(rng.integers(3, 9)):
        direction = rng.normal(size=3)
        at = at + direction / np.linalg.norm(direction) * 10 ** rng.uniform(np.log10(least_leg), 2)
        points.append((round(float(at[0]), 4), round(float(at[1]), 4), round(float(at[2]), 4)))
    acceleration = float(10 ** rng.uniform(3, 4.5))
    limits = Limits(float(rng.uniform(50, 1000)), acceleration, float(acceleration * 10 ** rng.uniform(1, 2.2)))
    return Case(points, limits, float(10 ** rng.uniform(-2.5, 0.5)))


def stairs(step: float, deviation: float, count: int = 8) -> Case:
    at = [0.0, 0.0, 0.0]
    points = []
    for i in range(count):
        at[i % 2] += step
        points.append((at[0], at[1], 0.0))
    return Case(points, Limits(500, 5000, 100_000), deviation)


@pytest.mark.parametrize("seed", range(2000 if LONG else 12))
def test_random_polylines_keep_all_limits(seed: int) -> None:
    """GR-40: turns to 180 degrees, legs from 0.1 mm on, blends from 3 um on."""
    case = random_case(np.random.default_rng(seed))
    _, recording = go(case, rounded=True)
    check_limits(case, recording)


@pytest.mark.parametrize("seed", range(2000 if LONG else 10))
def test_interrupts_and_overrides_keep_all_limits(seed: int) -> None:
    """GR-40: interrupted, continued, slowed down and stopped by the override at random instants."""
    rng = np.random.default_rng(seed)
    case = random_case(rng, least_leg=1)

    def disturb(session: takt.Engine, group: takt.Group) -> None:
        for _ in range(6):
            session.run(float(rng.integers(1, 150)) * PERIOD)
            if group.state != "GroupMoving":
                break
            what = rng.integers(0, 3)
            if what == 0:
                group.interrupt()
                session.run(float(rng.integers(1, 400)) * PERIOD)
                group.continue_path()
            else:
                factor = rng.uniform(0.05, 1) if what == 1 else rng.integers(0, 2)
                group.set_override(velocity_factor=float(factor))
        group.set_override(velocity_factor=1.0)

    _, recording = go(case, rounded=True, disturb=disturb)
    check_limits(case, recording)


@pytest.mark.parametrize("step", [5, 25.4, 50])
def test_rounding_a_staircase_is_no_slower_than_stopping(step: float) -> None:
    """GR-41: but for what a plan takes to be there."""
    stopping, _ = go(stairs(step, 0.01), rounded=False)
    for deviation in (0.01, 0.05, 0.2, 1):
        case = stairs(step, deviation)
        took, recording = go(case, rounded=True)
        check_limits(case, recording)
        assert took <= 1.02 * stopping, deviation
    assert took <= 0.93 * stopping


@pytest.mark.parametrize("leg", [10.0, 0.1, 1e-3, 1e-4, 1e-6])
@pytest.mark.parametrize("deviation", [1e-6, 1e-4, 1e-3, 1e-2, 0.05])
def test_rounding_is_no_slower_than_stopping_however_small(leg: float, deviation: float) -> None:
    """GR-41: legs and deviations down to 1e-6 mm; a corner where rounding saves no three cycles is a stop."""
    points = [(10.0, 0.0, 0.0), (10.0, leg, 0.0), (0.0, leg, 0.0)]
    case = stairs(10, deviation)._replace(points=points)
    stopping, _ = go(case, rounded=False)
    took, recording = go(case, rounded=True)
    check_limits(case, recording)
    assert took <= stopping + 3 * PERIOD


BELT = "belts:\n  - {name: belt, axis: z}\n"


@pytest.mark.parametrize(
    ("choice", "others", "planned"), [("", "", True), (", planned_ahead: false", "", False), ("", BELT, True)]
)
def test_paths_that_stand_are_planned_ahead(choice: str, others: str, planned: bool) -> None:
    """GR-41: unless chosen otherwise; a staircase then takes no longer than with stops."""
    case = stairs(25.4, 0.05, 15)
    with takt.Engine(machine(case.points, case.limits, choice, others)) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        began = session.now
        group.move_path(path="p", transition_mode="max_corner_deviation", transition_parameter=case.deviation).wait(
            timeout=20
        )
        took = session.now - began
    assert (took < 3.1) == planned, took


@pytest.mark.parametrize("instant", range(300, 800, 5) if LONG else range(340, 800, 120))
def test_plans_that_begin_near_a_corner_pass_it(instant: int) -> None:
    """GR-41: at a corner that the first plan passes, one that begins a little before it does not come to rest."""
    rng = np.random.default_rng(4)
    x, y = 0.0, 0.0
    points = []
    for _ in range(60):
        leg, angle = rng.uniform(2, 8), rng.uniform(-2.4, 2.4)
        x, y = float(x + leg * np.cos(angle)), float(y + leg * np.sin(angle))
        points.append((x, y, 0.0))
    case = Case(points, Limits(300.0, 15e3, 1.5e6), 0.05)
    stopped_s = 0.1

    def interrupt(session: takt.Engine, group: takt.Group) -> None:
        session.run(instant * PERIOD)
        group.interrupt().wait()
        session.run(stopped_s)
        group.continue_path().wait()

    free_s, free = go(case, rounded=True)
    took_s, recording = go(case, rounded=True, disturb=interrupt)
    ends = round(0.06 / PERIOD)
    resumed = instant + round(0.23 / PERIOD)
    least = free["g"]["velocity"][ends:-ends].min()
    assert least > 1
    assert recording["g"]["velocity"][resumed:-ends].min() > 0.2 * least
    assert took_s < free_s + stopped_s + 0.04
    check_limits(case, recording)


def test_an_interrupt_is_answered_soon_and_goes_on_to_the_end() -> None:
    """GR-40: on a staircase, at every instant of one step."""
    case = stairs(25.4, 0.05, count=3)
    longest = 0.0
    for instant in range(40, 400, 30 if not LONG else 1):

        def disturb(session: takt.Engine, group: takt.Group, instant: int = instant) -> None:
            nonlocal longest
            session.run(instant * PERIOD)
            began = session.now
            group.interrupt().wait(timeout=5)
            longest = max(longest, session.now - began)
            group.continue_path()

        _, recording = go(case, rounded=True, disturb=disturb)
        check_limits(case, recording)
    # From full speed the ramp takes 0.1 s.
    assert longest <= 0.15


def less_machine(rng: np.random.Generator, limits: Limits) -> tuple[str, dict[str, Limits]]:
    """A gantry whose axes have from a third to three times what the path has, of jerk down to a tenth."""
    of = {
        name: Limits(
            float(limits.velocity * 10 ** rng.uniform(-0.5, 0.5)),
            float(limits.acceleration * 10 ** rng.uniform(-0.5, 0.5)),
            float(limits.jerk * 10 ** rng.uniform(-1, 0.5)),
        )
        for name in "xyz"
    }
    axes = "".join(f"  - {{name: {name}, unit: mm, limits: {values(one)}}}\n" for name, one in of.items())
    group = f"name: g, axes: [x, y, z], kinematics: {{gantry: {{axes: [x, y, z]}}}}, path: {values(limits)}"
    return f"name: gantry\naxes:\n{axes}groups:\n  - {{{group}}}\n", of


@pytest.mark.parametrize("seed", [303, *range(1000 if LONG else 20)])
def test_axes_with_less_than_the_path_keep_their_limits(seed: int) -> None:
    """GR-40: moves that differ in speed, acceleration and jerk, with and without stops, disturbed at random."""
    rng = np.random.default_rng(seed)
    case = random_case(rng, least_leg=1)
    text, of = less_machine(rng, case.limits)
    stops = rng.integers(0, 3) == 0
    with takt.Engine(text) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        with session.record("g", "x", "y", "z") as recorder:
            for i, (x, y, z) in enumerate(case.points):
                given: dict[str, object] = {"velocity": float(case.limits.velocity * rng.uniform(0.05, 1))}
                if rng.random() < 0.3:
                    given["acceleration"] = float(case.limits.acceleration * rng.uniform(0.2, 1))
                if rng.random() < 0.3:
                    given["jerk"] = float(case.limits.jerk * rng.uniform(0.2, 1))
                if i > 0 and (stops or rng.random() < 0.1):
                    given["buffer_mode"] = "buffered"
                elif i > 0:
                    given["buffer_mode"] = "blending_" + str(rng.choice(["low", "previous", "next", "high"]))
                    given |= {"transition_mode": "max_corner_deviation", "transition_parameter": case.deviation}
                done = group.move_linear_absolute(x=x, y=y, z=z, **given)  # type: ignore[arg-type]
            for _ in range(6 if seed % 2 else 0):
                session.run(float(rng.integers(1, 200)) * PERIOD)
                if group.state != "GroupMoving":
                    break
                if rng.integers(0, 2):
                    group.interrupt().wait(timeout=60)
                    session.run(float(rng.integers(1, 100)) * PERIOD)
                    group.continue_path()
                else:
                    group.set_override(velocity_factor=float(rng.choice([0, rng.uniform(0.05, 1)])))
            group.set_override(velocity_factor=1.0)
            done.wait(timeout=200)
        recording = recorder.recording
    for name, limits in of.items():
        axis = recording[name]
        assert np.abs(axis["set_velocity"]).max() <= WITHIN * limits.velocity
        assert np.abs(axis["set_acceleration"]).max() <= WITHIN * limits.acceleration
        assert np.abs(np.diff(axis["set_position"], 3)).max() <= (1 + 1e-4) * limits.jerk * PERIOD**3
    assert np.abs(recording["g"]["path_acceleration"]).max() <= WITHIN * case.limits.acceleration
    assert off_path(case.points, recording) <= (0 if stops else case.deviation) + 1e-3


@pytest.mark.parametrize("factor", [0.5, 0.1, 0.0, None])
def test_stops_and_overrides_are_answered_where_bends_leave_little(factor: float | None) -> None:
    """GR-40: on a circle whose speed the jerk of the axes limits, at four places of it; None: a stop."""
    axes = Limits(1000, 10_000, 200_000)
    text = machine([(1.0, 0.0, 0.0)], Limits(500, 5000, 100_000)).split("paths:")[0]
    text = text.replace(values(Limits(500, 5000, 100_000)), values(axes), 3)
    for cycles in (900, 970, 1040, 1110):
        with takt.Engine(text) as session:
            group = session.group("g")
            group.power().wait()
            group.enable().wait()
            with session.record("g", "x", "y", "z") as recorder:
                group.move_circular_absolute(
                    circ_mode="center", aux_x=-15, aux_y=0, aux_z=0, normal_z=1, turns=60, x=0, y=0, z=0
                )
                session.run(cycles * PERIOD)
                speed = group.path_velocity
                assert speed > 300
                if factor is None:
                    group.stop()
                else:
                    group.set_override(velocity_factor=factor)
                session.run(0.4)
                assert group.path_velocity <= 500 * (factor or 0) + 1e-6
            for name in "xyz":
                axis = recorder.recording[name]
                assert np.abs(axis["set_acceleration"]).max() <= WITHIN * axes.acceleration
                assert np.abs(np.diff(axis["set_position"], 3)).max() <= (1 + 1e-4) * axes.jerk * PERIOD**3


@pytest.mark.parametrize("instant", range(0, 700, 7) if LONG else range(0, 700, 70))
def test_overrides_and_interrupts_cross_where_bends_leave_little(instant: int) -> None:
    """GR-40: interrupted while a lower override brakes, continued, raised again; each time answered, and it goes on."""
    axes = Limits(1000, 10_000, 200_000)
    text = machine([(1.0, 0.0, 0.0)], Limits(500, 5000, 100_000)).split("paths:")[0]
    text = text.replace(values(Limits(500, 5000, 100_000)), values(axes), 3)
    with takt.Engine(text) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        done = group.move_circular_absolute(
            circ_mode="center", aux_x=-15, aux_y=0, aux_z=0, normal_z=1, turns=30, x=0, y=0, z=0
        )
        session.run(instant * PERIOD)
        for wait in (5, 30, 90, 150):
            session.run(0.5)
            group.set_override(velocity_factor=0.1)
            session.run(wait * PERIOD)
            group.interrupt().wait(timeout=0.6)
            group.continue_path()
            session.run(0.2)
            assert group.path_velocity == pytest.approx(50, abs=1e-3)
            group.set_override(velocity_factor=1.0)
        done.wait(timeout=20)
        assert np.abs([session.axis(name).set_position for name in "xyz"]).max() <= 1e-6


@pytest.mark.parametrize("choice", ["", ", planned_ahead: false"])
@pytest.mark.parametrize(
    ("velocity", "waiting", "every", "least"),
    [(500, 110, 1, 0.98), (500, 110, 7, 0.75), (500, 60, 1, 0.7), (300, 90, 2, 0.99), (300, 60, 4, 0.98)],
)
def test_chords_that_come_one_by_one_are_passed_at_full_speed(
    choice: str, velocity: float, waiting: int, every: int, least: float
) -> None:
    """GR-24: 1 mm chords of a circle, given as the queue empties, looked after every so many cycles."""
    limits, radius, deviation, count = Limits(velocity, 5000, 100_000), 30.0, 0.01, 600
    text = machine([(1.0, 0.0, 0.0)], limits, choice).split("paths:")[0]
    for name in "xyz":
        text = text.replace(f"name: {name}, unit: mm, limits: {values(limits)}", FASTER.format(name))
    with takt.Engine(text) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        given: list[takt.Feedback] = []
        with session.record("g", "x", "y") as recorder:
            while not given or not given[-1].final:
                while len(given) < count and sum(not one.final for one in given[-120:]) < waiting:
                    angle = (len(given) + 1) / radius
                    blend = {"transition_mode": "max_corner_deviation", "transition_parameter": deviation}
                    given.append(
                        group.move_linear_absolute(
                            x=radius * np.cos(angle) - radius,
                            y=radius * np.sin(angle),
                            **({"buffer_mode": "blending_high", **blend} if given else {}),
                        )
                    )
                session.run(every * PERIOD)
                assert session.now < 20
        recording = recorder.recording
    assert all(one.done for one in given)
    speed = recording["g"]["path_velocity"]
    assert speed[len(speed) // 4 : 3 * len(speed) // 4].min() >= least * limits.velocity
    x, y = recording["x"]["set_position"], recording["y"]["set_position"]
    sagitta = radius - np.sqrt(radius**2 - 0.5**2)  # of a chord
    assert np.hypot(x + radius, y).max() <= radius + 1e-6
    assert np.hypot(x + radius, y).min() >= radius - sagitta - deviation - 1e-3
    for axis in (recording["x"], recording["y"]):
        assert np.abs(axis["set_acceleration"]).max() <= WITHIN * 10_000
        assert np.abs(np.diff(axis["set_position"], 3)).max() <= (1 + 1e-4) * 200_000 * PERIOD**3


STOP_AT = 293  # cycles
FURTHER = {"x": 20, "y": -40, "z": 5}
AROUND_A_STOP: dict[str, Callable[[takt.Engine, takt.Group], object]] = {
    "nothing": lambda _, __: None,
    "override": lambda _, group: group.set_override(velocity_factor=0.4),
    "override for a cycle": lambda session, group: (
        group.set_override(velocity_factor=0.4),
        session.run(PERIOD),
        group.set_override(velocity_factor=1.0),
    ),
    "interrupt": lambda session, group: (group.interrupt().wait(timeout=2), session.run(0.02), group.continue_path()),
    "one more": lambda _, group: group.move_linear_absolute(buffer_mode="buffered", **FURTHER),
    "one more that blends": lambda _, group: group.move_linear_absolute(
        buffer_mode="blending_next", transition_mode="corner_distance", transition_parameter=2, **FURTHER
    ),
    "abort": lambda _, group: group.move_linear_absolute(**FURTHER),
    "halt": lambda _, group: (group.halt().wait(timeout=2), group.move_linear_absolute(**FURTHER)),
}


@pytest.mark.parametrize("left", range(-20, 130, 3) if LONG else (-1, 0, 1, 2, 12, 60, 110))
@pytest.mark.parametrize("event", AROUND_A_STOP)
def test_what_is_behind_a_stop_sets_out_at_once(event: str, left: int) -> None:
    """GR-41: it is planned before, though it bends at once; whatever happens so many cycles before the stop."""
    limits = Limits(400, 4000, 80_000)
    with takt.Engine(machine([(1.0, 0.0, 0.0)], limits).split("paths:")[0]) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        with session.record("g", "x", "y", "z") as recorder:
            first = group.move_circular_absolute(circ_mode="border", aux_x=10, aux_y=10, aux_z=0, x=20, y=0, z=0)
            group.move_circular_absolute(
                circ_mode="border", aux_x=30, aux_y=-10, aux_z=0, x=20, y=-20, z=0, buffer_mode="buffered"
            )
            session.run((STOP_AT - left) * PERIOD)
            AROUND_A_STOP[event](session, group)
            session.run(1.5)
        assert group.state == "GroupStandby"
        assert first.done or event in ("abort", "halt")
        recording = recorder.recording
    path = recording["g"]
    assert np.abs(path["path_acceleration"]).max() <= WITHIN * limits.acceleration
    for name in "xyz":
        axis = recording[name]
        assert np.abs(axis["set_acceleration"]).max() <= WITHIN * limits.acceleration
        assert np.abs(np.diff(axis["set_position"], 3)).max() <= (1 + 1e-4) * limits.jerk * PERIOD**3
    ends = (20, -20, 0) if event in ("nothing", "override", "override for a cycle", "interrupt") else (20, -40, 5)
    assert [recording[name]["set_position"][-1] for name in "xyz"] == pytest.approx(ends, abs=1e-6)
    if event == "nothing":
        still = np.flatnonzero(path["path_velocity"][STOP_AT - 20 : STOP_AT + 20] == 0)
        assert len(still) <= 1


# --- with everything else ---

STOPS: dict[str, Callable[[takt.Engine, takt.Group], object]] = {
    "halt": lambda _, group: group.halt(),
    "gentle halt": lambda _, group: group.halt(deceleration=500, jerk=20_000),
    "stop": lambda _, group: group.stop(),
    "interrupt": lambda _, group: group.interrupt(),
    "override 0": lambda _, group: group.set_override(velocity_factor=0.0),
    "abort": lambda _, group: group.move_linear_absolute(x=0, y=0),
    "emergency stop": lambda session, _: session.command("machine", "emergency_stop", {"hold": True}),
    "stop all": lambda session, _: session.command("machine", "stop_all", {"open_loops": True}),
    "power off": lambda _, group: group.power(enable=False),
    "power off of a member": lambda session, _: session.axis("x").power(enable=False),
    "disable": lambda _, group: group.disable(),
}
# The members then brake by themselves, or the tool leaves the path for another one.
OFF_PATH = ("emergency stop", "stop all", "power off", "power off of a member", "disable", "abort")


@pytest.mark.parametrize("stop", STOPS)
def test_every_stop_brakes_within_limits_and_nothing_resumes(stop: str) -> None:
    """GR-40, AX-100: at instants all along a staircase."""
    case = stairs(25.4, 0.05, count=4)
    for instant in range(11, 600, 5 if LONG else 97):
        with takt.Engine(machine(case.points, case.limits)) as session:
            group = session.group("g")
            group.power().wait()
            group.enable().wait()
            with session.record("g", "x", "y", "z") as recorder:
                group.move_path(path="p", transition_mode="max_corner_deviation", transition_parameter=0.05)
                session.run(instant * PERIOD)
                STOPS[stop](session, group)
                session.run(1.5 if stop == "abort" else 0.6)
            recording = recorder.recording
            ends = [recording[name]["set_position"][-1] for name in "xyz"]
            if stop == "abort":
                assert np.abs(ends).max() <= 1e-6
            else:
                session.run(0.5)
                assert [session.axis(name).set_position for name in "xyz"] == pytest.approx(ends, abs=1e-9)
            if stop not in OFF_PATH:
                check_limits(case, recording)
            for name in "xyz":
                assert np.abs(recording[name]["set_acceleration"]).max() <= WITHIN * case.limits.acceleration


@pytest.mark.parametrize("left", range(-20, 130, 3) if LONG else (-1, 1, 12, 60))
@pytest.mark.parametrize("stop", STOPS)
def test_a_plan_behind_a_stop_is_forgotten_by_every_stop(stop: str, left: int) -> None:
    """GR-40, AX-100: nothing resumes behind it, and what is asked for anew keeps all limits and gets there."""
    limits = Limits(400, 4000, 80_000)
    with takt.Engine(machine([(1.0, 0.0, 0.0)], limits).split("paths:")[0]) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        with session.record("x", "y", "z") as recorder:
            group.move_circular_absolute(circ_mode="border", aux_x=10, aux_y=10, aux_z=0, x=20, y=0, z=0)
            group.move_circular_absolute(
                circ_mode="border", aux_x=30, aux_y=-10, aux_z=0, x=20, y=-20, z=0, buffer_mode="buffered"
            )
            session.run((STOP_AT - left) * PERIOD)
            given = STOPS[stop](session, group)
            session.run(0.8)
            stands = [session.axis(name).set_position for name in "xyz"]
            session.run(0.4)
            assert [session.axis(name).set_position for name in "xyz"] == pytest.approx(stands, abs=1e-9)
        braking = recorder.recording
        if stop == "emergency stop":
            assert isinstance(given, takt.Feedback)
            given.release()
            session.run(0.01)
        with session.record("x", "y", "z") as recorder:
            group.set_override(velocity_factor=1.0)
            if group.state == "GroupErrorStop":
                group.reset().wait()
            group.power().wait()
            if group.state == "GroupDisabled":
                group.enable().wait()
            group.move_circular_absolute(circ_mode="border", aux_x=10, aux_y=-30, aux_z=0, x=0, y=-20, z=5).wait(10)
        anew = recorder.recording
    assert [anew[name]["set_position"][-1] for name in "xyz"] == pytest.approx([0, -20, 5], abs=1e-6)
    for recording in (braking, anew):
        for name in "xyz":
            axis = recording[name]
            assert np.abs(axis["set_acceleration"]).max() <= WITHIN * limits.acceleration
            if recording is anew or stop not in OFF_PATH:
                assert np.abs(np.diff(axis["set_position"], 3)).max() <= (1 + 1e-4) * limits.jerk * PERIOD**3


@pytest.mark.parametrize("seed", range(200 if LONG else 6))
def test_moves_that_come_late_keep_all_limits(seed: int) -> None:
    """GR-22, GR-40: each move is given while the one before it is in motion, from far ahead to too late to blend."""
    rng = np.random.default_rng(seed)
    case = random_case(rng, least_leg=3)
    with takt.Engine(machine(case.points, case.limits)) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        with session.record("g", "x", "y", "z") as recorder:
            done = None
            for i, (x, y, z) in enumerate(case.points):
                done = group.move_linear_absolute(
                    x=x,
                    y=y,
                    z=z,
                    buffer_mode="blending_high" if i else "aborting",
                    transition_mode="max_corner_deviation",
                    transition_parameter=case.deviation,
                )
                session.run(float(rng.integers(1, 250)) * PERIOD)
            assert done is not None
            done.wait(timeout=100)
        check_limits(case, recorder.recording)


@pytest.mark.parametrize("pace", ["real", "fast"])
def test_a_run_with_plans_is_reproduced(tmp_path: Path, pace: str) -> None:
    """EN-07: plans are made in another thread; the journal says when each was there."""
    case = stairs(25.4, 0.05)
    url = new_url()
    file = tmp_path / "run.lcm"
    text = machine(case.points, case.limits)
    with running(tmp_path, url, "--log", str(file), machine=text, pace=pace), takt.connect(url) as session:
        group = session.group("g")
        group.power().wait_final()
        group.enable().wait_final()
        done = group.move_path(path="p", transition_mode="max_corner_deviation", transition_parameter=0.05)
        session.run(0.4)
        group.interrupt().wait_final()
        group.continue_path()
        done.wait(timeout=30)
        # Planned behind a stop, before it.
        group.move_linear_absolute(x=0, y=0, z=0, buffer_mode="buffered")
        group.move_circular_absolute(
            circ_mode="border", aux_x=10, aux_y=10, aux_z=0, x=20, y=0, z=0, buffer_mode="buffered"
        )
        done = group.move_circular_absolute(
            circ_mode="border", aux_x=30, aux_y=-10, aux_z=0, x=20, y=-20, z=0, buffer_mode="buffered"
        )
        done.wait(timeout=30)
    assert any(event.verb == "path_planned" for event in open_log(file).runs[-1].journal)
    result = takt.replay(file)
    assert result.same
    assert result.states > 0


class Stadium(NamedTuple):
    """A line of 60 mm, half a circle and a line back, turned about z: the curvature steps where they meet."""

    axes: float  # mm/s
    path: float  # mm/s
    radius: float  # mm
    turned: float = 0.0  # degrees
    jerk_of_y: float = 1.0  # of that of the other axes

    def machine(self) -> str:
        jerks = (1e5, 1e5) if self.axes < 1000 else (5e5, 4e5)
        of, along = Limits(self.axes, 10 * self.axes, jerks[0]), Limits(self.path, 10 * self.path, jerks[1])
        cosine, sine, r = np.cos(np.radians(self.turned)), np.sin(np.radians(self.turned)), self.radius

        def place(x: float, y: float, prefix: str = "") -> str:
            return f"{prefix}x: {x * cosine - y * sine:.9f}, {prefix}y: {x * sine + y * cosine:.9f}, {prefix}z: 0"

        y = f"name: y, unit: mm, limits: {values(of)}"
        text = machine([], of).replace(f"path: {values(of)}", f"path: {values(along)}")
        text = text.replace(y, y.replace(repr(of.jerk), repr(self.jerk_of_y * of.jerk)))
        return (
            f"{text}      - {{shape: line, to: {{{place(60, 0)}}}}}\n"
            f"      - {{shape: arc, {place(60 + r, r, 'via_')}, to: {{{place(60, 2 * r)}}}}}\n"
            f"      - {{shape: line, to: {{{place(0, 2 * r)}}}}}\n"
        )

    def off(self, recording: takt.Recording) -> float:
        """The largest distance from it in mm."""
        at = recording["x"]["set_position"] + 1j * recording["y"]["set_position"]
        at *= np.exp(-1j * np.radians(self.turned))
        on_arc = np.abs(np.abs(at - 60 - 1j * self.radius) - self.radius)
        on_lines = np.minimum(np.abs(at.imag), np.abs(at.imag - 2 * self.radius))
        return float(np.where(at.real > 60, on_arc, on_lines).max())


STADIUM = [
    Stadium(500, 500, 15),
    Stadium(1000, 800, 5),
    Stadium(500, 500, 5, 75),
    Stadium(500, 500, 15, 30),
    Stadium(500, 500, 2, 45, 0.5),
]


@pytest.mark.parametrize("turned", range(0, 180, 15))
@pytest.mark.parametrize(("radius", "jerk_of_y"), [(2, 1.0), (5, 1.0), (15, 1.0), (2, 0.5), (5, 0.3)])
def test_steps_of_curvature_are_passed_on_the_path(radius: float, jerk_of_y: float, turned: float) -> None:
    """GR-40: whatever the axes share of them."""
    case = Stadium(500, 500, radius, turned, jerk_of_y)
    with takt.Engine(case.machine()) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        recorder = session.record("x", "y")
        group.move_path(path="p").wait()
        session.run(0.5)
        assert case.off(recorder.stop()) <= 1e-3


@pytest.mark.parametrize("case", STADIUM)
@pytest.mark.parametrize(
    "disturb",
    [
        lambda _, group: group.set_override(velocity_factor=0.5),
        lambda _, group: group.set_override(velocity_factor=0),
        lambda _, group: group.halt(),
        lambda _, group: group.halt(deceleration=1000),
        lambda _, group: group.interrupt(deceleration=1000),
        lambda _, group: group.stop(jerk=1e4),
    ],
    ids=["half", "zero", "halt", "soft-halt", "soft-interrupt", "soft-stop"],
)
def test_no_instant_leads_off_the_path_where_curvature_steps(case: Stadium, disturb: Disturb) -> None:
    """GR-40: brakings and overrides passed the steps as fast as they came (0.2 to 12 mm beside the path)."""
    worst = 0.0
    for instant in range(20, 700, 12 if LONG else 52):
        with takt.Engine(case.machine()) as session:
            group = session.group("g")
            group.power().wait()
            group.enable().wait()
            recorder = session.record("x", "y")
            group.move_path(path="p")
            session.step(instant)
            disturb(session, group)
            session.run(0.5)
            group.set_override()
            session.run(1.0)
            worst = max(worst, case.off(recorder.stop()))
    assert worst <= 1e-3


@pytest.mark.parametrize("stop", STOPS)
def test_every_stop_where_curvature_steps(stop: str) -> None:
    """GR-40, AX-100: within the limits of the axes, on the path unless its members brake, and nothing resumes."""
    case = STADIUM[2]
    for instant in (250, 290, 320, 350, 400):
        with takt.Engine(case.machine()) as session:
            group = session.group("g")
            group.power().wait()
            group.enable().wait()
            recorder = session.record("x", "y")
            group.move_path(path="p")
            session.step(instant)
            STOPS[stop](session, group)
            session.run(1.0)
            recording = recorder.stop()
            if stop not in OFF_PATH:
                assert case.off(recording) <= 1e-3
            ends = [recording[name]["set_position"][-1] for name in "xy"]
            session.run(0.2)
            assert [session.axis(name).set_position for name in "xy"] == pytest.approx(ends, abs=1e-9)
            for name in "xy":
                assert np.abs(recording[name]["set_acceleration"]).max() <= WITHIN * 5000
                if stop != "emergency stop":  # which switches off: on straight paths, too, accelerations step
                    assert np.abs(np.diff(recording[name]["set_acceleration"])).max() <= WITHIN * 100


@pytest.mark.parametrize(
    ("radius", "override"), [(3, 1), (5, 1), (5, 0.8), (5, 0.5), (10, 0.8), (15, 1), (15, 0.9), (40, 1), (100, 1)]
)
def test_smooth_joints_are_no_slower_than_stops(radius: float, override: float) -> None:
    """GR-23, GR-41: steps of curvature are passed at the speed that they allow (it crept at 2 mm/s before them)."""
    taken = []
    for stops in (False, True):
        with takt.Engine(Stadium(500, 500, radius).machine()) as session:
            group = session.group("g")
            group.power().wait()
            group.enable().wait()
            group.set_override(velocity_factor=override)
            session.step()
            began = session.now
            if stops:
                group.move_linear_absolute(x=60, y=0, z=0)
                border = {"aux_x": 60 + radius, "aux_y": radius, "aux_z": 0, "x": 60, "y": 2 * radius, "z": 0}
                group.move_circular_absolute(circ_mode="border", buffer_mode="buffered", **border)
                group.move_linear_absolute(x=0, y=2 * radius, z=0, buffer_mode="buffered").wait()
            else:
                group.move_path(path="p").wait()
            taken.append(session.now - began)
    assert taken[0] < taken[1]


@pytest.mark.parametrize("planned_ahead", ["true", "false"])
@pytest.mark.parametrize("width", [1e-4, 1.3e-3, 0.01, 0.03, 0.3])
def test_narrow_arches_end(width: float, planned_ahead: str) -> None:
    """GR-40, GR-41: up and over to a place beside (they stood at the crest for good, or took 10 s and more)."""
    limits = Limits(1000, 10000, 5e5)
    text = machine([(1, 0, 0)], limits, f", planned_ahead: {planned_ahead}")
    with takt.Engine(text) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        began = session.now
        group.move_arch(x=width, z=0, height=20).wait()
        assert session.now - began < 0.5
        assert group.x == pytest.approx(width, abs=1e-9)
