"""Robots with a belt and a table on which their tools work, and what must hold of their axes."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import takt
from takt.recording import Recording

ROOM = 1e-6  # of each limit


class Robot(NamedTuple):
    axes: tuple[str, ...]
    limits: tuple[float, float, float]
    kinematics: str
    path: str
    begin: dict[str, float]  # where the tool stands


FREE = "{velocity: 4000, acceleration: 60000, jerk: 3000000}"
ROBOTS = {
    "gantry": Robot(
        ("x", "y", "z"), (1500, 15000, 500000), "{gantry: {axes: [x, y, z]}}", FREE, {"x": 0, "y": 0, "z": 0}
    ),
    "delta": Robot(
        ("a1", "a2", "a3"),
        (800, 20000, 1e6),
        "{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}",
        FREE,
        {"x": 0, "y": 0, "z": -880},
    ),
    "scara": Robot(
        ("a1", "a2", "z", "c"),
        (600, 6000, 200000),
        "{scara: {first_arm: 325, second_arm: 275, height: 0}}",
        "{velocity: 2000, acceleration: 20000, jerk: 600000}",
        {"x": 400, "y": 0, "z": -50, "c": 0},
    ),
    "six axes": Robot(
        ("a1", "a2", "a3", "a4", "a5", "a6"),
        (300, 3000, 100000),
        "{six_axis: {a1: 25, a2: -35, b: 0, c1: 400, c2: 455, c3: 420, c4: 80}}",
        "{velocity: 1000, acceleration: 8000, jerk: 300000}",
        {"x": 450, "y": 0, "z": 500, "a": 0, "b": 65, "c": 0},
    ),
}

GENTLE = Robot(("x", "y", "z"), (1500, 15000, 50000), "{gantry: {axes: [x, y, z]}}", FREE, {"x": 0, "y": 0, "z": 0})


def machine(robot: Robot, board: bool = True) -> str:
    """The robot, a belt and a table whose coordinate systems lie where its tool stands."""
    velocity, acceleration, jerk = robot.limits
    limits = f"{{velocity: {velocity}, acceleration: {acceleration}, jerk: {jerk}}}"
    axes = "".join(f"  - {{name: g{name}, unit: mm, limits: {limits}}}\n" for name in robot.axes)
    begin = robot.begin
    at = f"{{x: {begin['x']}, y: {begin['y']}, z: {begin['z']}}}"
    beside = f"{{x: {begin['x']}, y: {begin['y'] - 150}, z: {begin['z']}}}"
    return (
        f"name: cell\naxes:\n{axes}"
        "  - {name: drive, unit: mm, limits: {velocity: 2000, acceleration: 5000, jerk: 100000}}\n"
        "  - {name: disc, unit: deg, kind: rotary, limits: {velocity: 400, acceleration: 2000, jerk: 40000}}\n"
        f"groups:\n  - name: robot\n    axes: [{', '.join('g' + name for name in robot.axes)}]\n"
        f"    kinematics: {robot.kinematics}\n    path: {robot.path}\n    tracking: {{board: {str(board).lower()}}}\n"
        f"belts:\n  - {{name: belt, axis: drive, origin: {at}}}\n"
        f"  - {{name: table, kind: turning, axis: disc, origin: {beside}}}\n"
    )


class Cell:
    """A robot at rest, and a belt or table at speed whose coordinate system 1 is recorded now."""

    def __init__(self, robot: str | Robot, carrier: str, speed: float, board: bool = True) -> None:
        self.robot = ROBOTS[robot] if isinstance(robot, str) else robot
        self.engine = takt.Engine(machine(self.robot, board))
        self.group = self.engine.group("robot")
        self.carrier = self.engine.axis({"belt": "drive", "table": "disc"}[carrier])
        for axis in self.engine.axes.values():
            axis.power().wait()
        self.group.enable().wait()
        self.group.move_direct_absolute(coordinate_system="mcs", **self.robot.begin).wait()
        if speed:
            direction: Any = "positive" if speed > 0 else "negative"
            self.carrier.move_velocity(velocity=abs(speed), direction=direction).wait(until="reached")
        self.group.set_dyn_coord_transform(pcs=1, carrier=carrier).wait()
        # The tool as the object sees it.
        self.here = (0.0, 150.0, 0.0) if carrier == "table" else (0.0, 0.0, 0.0)
        self.recorder = self.engine.record()

    def target(self, by: tuple[float, float, float]) -> dict[str, float]:
        return {axis: here + step for axis, here, step in zip("xyz", self.here, by, strict=True)}

    def line(self, by: tuple[float, float, float], **more: Any) -> takt.Feedback:
        return self.group.move_linear_absolute(coordinate_system="pcs", pcs=1, **self.target(by), **more)

    def judge(self, until: int) -> Recording:
        """Stops recording, and holds all axes of the group against their limits; to a cycle they follow at once."""
        run = self.recorder.stop()
        velocity, acceleration, jerk = (limit * (1 + ROOM) for limit in self.robot.limits)
        for name in self.robot.axes:
            made = run["g" + name]
            assert np.max(np.abs(made["set_velocity"])) <= velocity, name
            assert np.max(np.abs(made["set_acceleration"])) <= acceleration, name
            assert np.max(np.abs(np.diff(made["set_acceleration"]))) / self.engine.period <= jerk, name
            steps = np.diff(made["set_position"])
            assert np.max(np.abs(steps)) <= velocity * self.engine.period * (1 + 1e-9), name
            # Set points are kept within the limits in any case: what was too much comes late.
            late = np.flatnonzero(~made["in_step"].astype(bool) & (made["cycle"] <= until))
            assert len(late) <= 12, f"{name}: {late}"
        return run


def off_target(run: Recording, cycle: int, target: dict[str, float]) -> float:
    """How far [mm] the tool is from a place of the object in a cycle."""
    robot = run["robot"]
    row = int(np.searchsorted(robot["cycle"], cycle))
    return max(abs(float(robot[f"object_{axis}"][row]) - place) for axis, place in target.items())


def ends_told(run: Recording, period: float) -> set[int]:
    """The cycles in which the tool will stand, by all known values of time_left."""
    cycles, left = run["robot"]["cycle"], run["robot"]["time_left"]
    known = ~np.isnan(left)
    return set((cycles[known] + np.round(left[known] / period)).astype(int))
