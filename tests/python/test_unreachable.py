"""GR-44: the sentence of a refused move says which configurations fail, and why."""

from __future__ import annotations

import itertools
import re

import numpy as np
import takt

RANGES = [(-170, 170), (-90, 60), (-80, 120), (-150, 150), (-60, 100), (-200, 200)]
SHOULDERS, ELBOWS, WRISTS = ("front", "back"), ("positive", "negative"), ("positive", "negative")
LIMIT = re.compile(r"axis 'j(\d)' would leave its range at the (lower|upper) end")


def machine(ranges: list[tuple[float, float]]) -> str:
    """An arm of six axes with a spherical wrist."""
    axes = "".join(
        f"  - {{name: j{i}, unit: deg, limits: {{velocity: 2000, acceleration: 20000, jerk: 400000,"
        f" lower: {lower}, upper: {upper}}}}}\n"
        for i, (lower, upper) in enumerate(ranges, 1)
    )
    return (
        f"name: arm\naxes:\n{axes}groups:\n  - name: arm\n    axes: [j1, j2, j3, j4, j5, j6]\n"
        "    kinematics: {six_axis: {a1: 25, a2: -35, c1: 400, c2: 455, c3: 420, c4: 90}}\n"
        "    path: {velocity: 500, acceleration: 5000, jerk: 100000}\n"
    )


def ready(ranges: list[tuple[float, float]]) -> tuple[takt.Engine, takt.Group]:
    session = takt.Engine(machine(ranges))
    group = session.group("arm")
    group.power().wait()
    group.enable().wait()
    group.move_direct_absolute(coordinate_system="acs", a1=10, a2=-20, a3=40, a4=10, a5=30, a6=0).wait()
    return session, group


def test_each_configuration_says_why_it_fails() -> None:
    """Whoever asks for one configuration hears its own reason: an arm without ends goes there in this configuration,
    and then stands outside the range that the sentence names. Without a configuration all those reasons are told."""
    _, group = ready(RANGES)
    free, free_group = ready([(-355, 355)] * 6)
    rng = np.random.default_rng(44)
    refused = limited = mixed = 0
    for _ in range(60):
        pose = {name: float(rng.uniform(-900, 900)) for name in "xy"}
        pose |= {"z": float(rng.uniform(-200, 1200))} | {name: float(rng.uniform(-180, 180)) for name in "ac"}
        pose |= {"b": float(rng.uniform(-90, 90))}
        move = {"coordinate_system": "mcs", **pose}
        asked = group.move_direct_absolute(**move).wait_final()
        if asked.error_id == 0:
            group.move_direct_absolute(coordinate_system="acs", a1=10, a2=-20, a3=40, a4=10, a5=30, a6=0).wait()
            continue
        refused += 1
        start = "no position of the axes leads there: "
        assert asked.sentence.startswith(start)
        reasons = set()
        for shoulder, elbow, wrist in itertools.product(SHOULDERS, ELBOWS, WRISTS):
            named = {"shoulder": shoulder, "elbow": elbow, "wrist": wrist}
            one = group.move_direct_absolute(**move, **named).wait_final()
            assert one.error_id == asked.error_id
            (reason,) = re.fullmatch(start + r"([^(;]*)", one.sentence).groups()  # type: ignore[union-attr]
            reasons.add(reason)
            found = LIMIT.fullmatch(reason)
            anywhere = free_group.move_direct_absolute(**move, **named).wait_final()
            assert (found is None) == (anywhere.error_id != 0), (reason, anywhere.sentence)
            if found is None:
                continue
            limited += 1
            axis = int(found[1]) - 1
            lower, upper = RANGES[axis]
            stands = free.axis(f"j{axis + 1}").set_position
            turns = [stands + 360 * turn for turn in (-1, 0, 1)]
            assert not any(lower <= position <= upper for position in turns), (reason, stands)
        assert {part.split(" (")[0] for part in asked.sentence.removeprefix(start).split("; ")} >= {
            reason + (", in every configuration" if len(reasons) == 1 else "") for reason in reasons
        }
        mixed += len(reasons) > 1
    assert refused > 20
    assert mixed > 10
    assert limited > 30


def test_a_straight_move_names_the_axis() -> None:
    """An arm without ends goes the same way, and that axis out of that end."""
    _, group = ready(RANGES)
    rng = np.random.default_rng(45)
    named = 0
    for _ in range(40):
        pose = {"x": float(rng.uniform(200, 700)), "y": float(rng.uniform(-400, 400)), "z": float(rng.uniform(0, 900))}
        start = {name: getattr(group, name) for name in "abc"}
        moved = group.move_linear_absolute(coordinate_system="mcs", **pose, **start).wait_final()
        found = LIMIT.search(moved.sentence)
        if found is None:
            group.move_direct_absolute(coordinate_system="acs", a1=10, a2=-20, a3=40, a4=10, a5=30, a6=0).wait()
            continue
        free, other = ready([(-355, 355)] * 6)
        way = f"j{found[1]}"
        with free.record(way) as recorder:
            gone = other.move_linear_absolute(coordinate_system="mcs", **pose, **start).wait_final()
        if gone.error_id != 0:
            continue
        named += 1
        positions = recorder.recording[way]["set_position"]
        lower, upper = RANGES[int(found[1]) - 1]
        assert (positions.max() > upper) if found[2] == "upper" else (positions.min() < lower)
    assert named >= 5


def test_axes_behind_the_kinematics_are_named_too() -> None:
    text = """
name: gantry
axes:
  - {name: x, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -100, upper: 100}}
  - {name: y, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: z, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: belt, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -50, upper: 50}}
groups:
  - name: g
    axes: [x, y, z, belt]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 500, acceleration: 5000, jerk: 100000}
"""
    with takt.Engine(text) as session:
        group = session.group("g")
        group.power().wait()
        group.enable().wait()
        moved = group.move_linear_absolute(x=150, y=10).wait_final()
        assert moved.sentence == "no position of the axes leads there: axis 'x' would leave its range at the upper end"
        moved = group.move_linear_absolute(x=-150, y=10).wait_final()
        assert moved.sentence == "no position of the axes leads there: axis 'x' would leave its range at the lower end"
        moved = group.move_linear_absolute(x=50, y=10, a4=70).wait_final()
        assert "axis 'belt'" in moved.sentence


def test_modules_and_accepted_moves() -> None:
    """A module says it of its profiles. What failed of a direct move that was accepted is no reason for what fails
    later, and what failed once is told once."""
    text = """
name: cell
axes:
  - {name: x, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -100, upper: 100}}
  - {name: y, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: z, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: g
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 500, acceleration: 5000, jerk: 100000}
pick_and_place:
  - {name: p, group: g}
"""
    generic = "no position of the axes leads there: out of reach, not turned so, or beyond the range of an axis"
    with takt.Engine(text) as session:
        module = session.pick_place("p")
        module.control(enable=True, regulator_on=True).wait()
        session.run(0.5)
        module.configure(x_target=150, y_target=10, z_target=0).wait()
        failed = module.execute(0).wait_final()
        assert failed.sentence == "no position of the axes leads there: axis 'x' would leave its range at the upper end"
    session, group = ready(RANGES)
    moved = group.move_direct_absolute(
        coordinate_system="mcs", x=group.x + 20, y=group.y, z=group.z, a=group.a, b=group.b, c=group.c
    )
    assert moved.wait_final().error_id == 0
    with session:
        assert group.jog(x=200.0).wait_final(timeout=30).sentence == generic
