"""Runs of all kinds of components, for the question whether they are the same on another processor: prints a digest of
the state after every cycle of each, and of what the C library's sine says, as JSON.

No command is computed with a function of the C library: what scenarios compute in Python is not the engine's."""

from __future__ import annotations

import hashlib
import json
import math
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import takt
from takt.scenario import load_scenario, modules_of

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "python/examples"
PUMA = ROOT / "tests/cpp/kinematics/puma.urdf"

DEGREES = "unit: deg, limits: {velocity: 300, acceleration: 3000, jerk: 60000}"
PATH = "path: {velocity: 400, acceleration: 4000, jerk: 80000}"

# A SCARA on a turned base beside a turning belt, and an arm read from a URDF in a cell with obstacles.
ARMS = f"""
name: arms
axes:
  - {{name: s1, {DEGREES}}}
  - {{name: s2, {DEGREES}}}
  - {{name: s3, limits: {{velocity: 800, acceleration: 9000, jerk: 200000}}}}
  - {{name: s4, {DEGREES}}}
{"".join(f"  - {{name: j{i}, {DEGREES}}}" + chr(10) for i in range(1, 7))}\
  - {{name: table, kind: rotary, modulus: 360, {DEGREES}}}
groups:
  - name: scara
    axes: [s1, s2, s3, s4]
    kinematics: {{scara: {{first_arm: 325, second_arm: 275}}}}
    base: {{c: 40, z: 20}}
    {PATH}
  - name: arm
    axes: [j1, j2, j3, j4, j5, j6]
    kinematics: {{serial: {{urdf: "{PUMA}"}}}}
    tool: {{x: 10, b: 7}}
    {PATH}
    workspace:
      margin: 2
      obstacles:
        - {{name: post, cylinder: {{radius: 40, height: 600}}, pose: {{x: 700, y: 300, a: 12}}}}
        - {{name: wall, box: {{x: 20, y: 900, z: 900}}, pose: {{x: -500, c: 10}}}}
      gripper:
        - {{name: finger, cylinder: {{radius: 8, height: 60}}, pose: {{z: -30}}}}
belts:
  - {{name: turning, kind: turning, axis: table, origin: {{x: 300, y: 200, c: 25}}, filter_s: 0.01}}
simulation:
  servos:
    - {{axis: s1, encoder: {{noise_counts: 2}}, mechanics: {{coulomb_friction: 0.1, inertia: 0.0003}}}}
"""

FLOOR = [(x, y) for x in range(0, 1920, 240) for y in range(0, 960, 240)]
NAMES = ("one", "two", "three")
PLATE = (
    "name: plate\naxes: []\nmovers:\n"
    + "".join(
        f"  - name: {name}\n    initial: {{x: {200 + 230 * i}, y: 240}}\n"
        "    c: {maximum: {velocity: 360, acceleration: 3600, jerk: 72000}, lower: -100, upper: 100}\n"
        for i, name in enumerate(NAMES)
    )
    + "environments:\n  - {name: floor, stators: ["
    + ", ".join(f"{{x: {x}, y: {y}}}" for x, y in FLOOR)
    + "]}\nplanar_groups:\n  - {name: cell, movers: [one, two, three], environment: floor}\n"
)

PICKER = """
name: picker
axes:
  - {name: a1, unit: deg, limits: {velocity: 800, acceleration: 20000, jerk: 1000000}}
  - {name: a2, unit: deg, limits: {velocity: 800, acceleration: 20000, jerk: 1000000}}
  - {name: a3, unit: deg, limits: {velocity: 800, acceleration: 20000, jerk: 1000000}}
  - {name: drive, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: delta
    axes: [a1, a2, a3]
    kinematics: {delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}
    path: {velocity: 1000, acceleration: 8000, jerk: 400000}
belts:
  - {name: infeed, axis: drive, origin: {x: -200, y: 50, z: -870, c: 15}, lower_limit: 0, upper_limit: 400}
pick_and_place:
  - name: picker
    group: delta
    belts: [{belt: infeed, settings: {park_x: 0, park_y: 50, park_z: -820, z_distance: 25, sync_time: 0.05}}]
    settings:
      {path_velocity: 1000, path_acceleration: 8000, path_deceleration: 8000, path_jerk: 400000, keep_orientation: true,
       blending_radius: 10, z_start_distance: 30, z_target_distance: 20, x_target: 100, z_target: -860,
       gripper_closing_time: 0.02}
"""


def arms(session: takt.Engine) -> None:
    scara, arm, table = session.group("scara"), session.group("arm"), session.axis("table")
    for one in (scara, arm, table):
        one.power().wait()
    for group in (scara, arm):
        group.enable().wait()
    table.move_velocity(velocity=40)
    session.belt("turning").detect(x=30, y=20, c=5)
    scara.move_direct_absolute(a1=20, a2=60, a3=-30, a4=10, coordinate_system="acs")
    arm.move_direct_absolute(a1=15, a2=-40, a3=70, a4=20, a5=50, a6=-10, coordinate_system="acs").wait()
    for group, step in ((scara, -60), (arm, 80)):
        blend: dict[str, Any] = {
            "buffer_mode": "blending_next",
            "transition_mode": "corner_distance",
            "transition_parameter": 10.0,
        }
        moves = [
            group.move_linear_relative(x=step, y=-step, **blend),
            group.move_linear_relative(y=step, z=-10, c=25, **blend),
            group.move_circular_relative(aux_x=30, aux_y=20, x=40, y=-20, buffer_mode="buffered"),
            group.move_direct_relative(a1=-12, a2=9, a4=-30, buffer_mode="buffered"),
        ]
        for move in moves:
            move.wait()
    session.run(0.2)


def plate(session: takt.Engine) -> None:
    star = session.mover("one")
    session.planar_group("cell").enable().wait()
    for mover in session.movers.values():
        mover.enable().wait()
    for name in NAMES[1:]:
        session.mover(name).join_formation(star="one").wait(until="reached")
    star.move_to_position(x=900, y=300, velocity=1500)
    star.move_to_position(x=700, y=220, c=35, use_orientation=True, buffer_mode="buffered").wait()
    for name in NAMES[1:]:
        session.mover(name).leave_formation().wait()
    session.mover("three").move_to_position(x=1500, y=600).wait()


def picker(session: takt.Engine) -> None:
    module, belt = session.pick_place("picker"), session.belt("infeed")
    session.axis("drive").power().wait()
    module.configure(max_velocity=[0.0] * 7, max_acceleration=[0.0] * 7, max_jerk=[0.0] * 7).wait()
    module.control(regulator_on=True).wait()
    session.wait(lambda: module.axes_group_enabled, 2)
    session.axis("drive").move_velocity(velocity=80).wait(until="reached")
    belt.detect(x=60, y=10, c=20).wait()
    module.execute(1).wait()
    module.execute().wait()


def delta_cell(session: takt.Engine) -> None:
    robot = session.group("robot")
    robot.power().wait()
    robot.enable().wait()
    robot.set_cartesian_transform(pcs=1, z=-800).wait()
    robot.move_direct_absolute(x=0, y=0, z=4, coordinate_system="pcs").wait()
    robot.move_path(
        path="drawing",
        coordinate_system="pcs",
        transition_mode="max_corner_deviation",
        transition_parameter=0.05,
    )
    session.run(3.0)


def scenario_of(name: str) -> Callable[[takt.Engine], None]:
    def play(session: takt.Engine) -> None:
        load_scenario(EXAMPLES / name / "scenario.py").play(session)

    return play


def planar_line(session: takt.Engine) -> None:
    folder = EXAMPLES / "planar_line"
    with modules_of(folder):
        from scenario import play  # type: ignore[import-not-found]

        play(session, 4.0)


RUNS: dict[str, tuple[str | Path, Callable[[takt.Engine], None]]] = {
    "arms": (ARMS, arms),
    "plate": (PLATE, plate),
    "picker": (PICKER, picker),
    "delta_cell": (EXAMPLES / "delta_cell/machine.yaml", delta_cell),
    "planar_line": (EXAMPLES / "planar_line/machine.yaml", planar_line),
    **{
        name: (EXAMPLES / name / "machine.yaml", scenario_of(name))
        for name in ("one_axis", "six_axes", "positioning_module", "flying_saw")
    },
}


def digest(name: str) -> str:
    """Of the state after every cycle of a run."""
    machine, play = RUNS[name]
    with takt.Engine(machine, journal=True) as session:
        play(session)
        cycles, hashes = session.take_hashes()
    assert len(cycles) > 500, f"{name}: {len(cycles)} cycles"
    return hashlib.sha256(hashes.tobytes()).hexdigest()[:16]


def of_the_c_library() -> str:
    """Of what its functions say here."""
    values = [f(0.37 * k) for k in range(1, 2000) for f in (math.sin, math.cos, math.tan, math.atan, math.log)]
    return hashlib.sha256(struct.pack(f"{len(values)}d", *values)).hexdigest()[:16]


if __name__ == "__main__":
    names = sys.argv[1:] or list(RUNS)
    print(json.dumps({"c_library": of_the_c_library(), **{name: digest(name) for name in names}}))
