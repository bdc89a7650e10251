"""A machine with every kind of component, and every command that its components know, made from their descriptions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from takt import _core

MACHINE = """
name: stops
axes:
  - {name: x, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: y, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: z, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: left, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: right, limits: {velocity: 300, acceleration: 3000, jerk: 60000}, follows: {axis: left}}
  - {name: web, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: knife, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: valve, limits: {velocity: 400, acceleration: 4000, jerk: 80000}, drive: {mode: analog},
     loop: {kp: 0.05, velocity_at_10v: 500}}
  - {name: a, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: b, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: c, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: infeed, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
cams:
  - {name: hill, cyclic: true,
     points: [{x: 0, y: 0, v: 0, a: 0}, {x: 60, y: 20, v: 0, a: 0}, {x: 120, y: 0, v: 0, a: 0}]}
flex_cams:
  - {name: cutter, slave: knife, master: web, cams: [hill], settings: {jog_velocity: 30}}
groups:
  - {name: portal, axes: [x, y, z], kinematics: {gantry: {axes: [x, y, z]}},
     path: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: robot, axes: [a, b, c], kinematics: {gantry: {axes: [x, y, z]}},
     path: {velocity: 300, acceleration: 3000, jerk: 60000}}
belts:
  - {name: belt, axis: infeed, lower_limit: 0, upper_limit: 300}
pick_and_place:
  - name: picker
    group: robot
    belts: [{belt: belt, settings: {park_x: 150, park_z: 40, z_distance: 15, sync_time: 0.1}}]
    settings: {path_velocity: 300, path_acceleration: 3000, path_deceleration: 3000, path_jerk: 60000}
movers:
  - {name: shuttle, initial: {x: 300, y: 300}}
tracks:
  - {name: siding}
poses:
  - {name: camera}
planar_groups:
  - {name: cell}
environments:
  - {name: floor}
coordinate_systems: [{name: plane}]
parts:
  - {name: deck, columns: 4, rows: 4, positions: [{coordinate_system: plane, x: 0, y: 0}]}
"""
VERBS: list[dict[str, Any]] = json.loads(_core.reference())["verbs"]
# One component of each kind; of axes: one alone, both of a gantry, one that a module, one that a group moves.
TARGETS: dict[str, tuple[str, ...]] = {
    "axis": ("web", "left", "right", "knife", "x", "valve"),
    "flex_cam": ("cutter",),
    "group": ("portal", "robot"),
    "belt": ("belt",),
    "pose": ("camera",),
    "pick_place": ("picker",),
    "mover": ("shuttle",),
    "track": ("siding",),
    "planar_group": ("cell",),
    "environment": ("floor",),
    "part": ("deck",),
}
# What must be given, where a number will not do.
NAMES = {"master": "infeed", "cam": "hill", "profile": "hill", "axis": "infeed", "belt": "belt", "table": "belt",
         "carrier": "belt", "track": "siding", "group": "cell", "path": "none", "mover": "shuttle"}  # fmt: skip
ASK = {"flex_cam.control": ("regulator_on", "sync_cam", "home_execute"),
       "pick_place.control": ("regulator_on", "execute", "home_execute", "return_to_path")}  # fmt: skip


Given = tuple[str, str, dict[str, Any]]  # target, verb, arguments


def value_of(field: dict[str, Any], names: Mapping[str, str]) -> Any:
    """Something that the field takes."""
    kind = field["type"]["kind"]
    if kind in ("text", "name"):
        return names.get(field["name"], "web")
    if kind == "enum":
        return field["type"]["values"][0]["name"]
    if kind == "bool":
        return True
    return 1 if kind in ("integer", "whole") else 2.0


SIGNED = ("distance", "position", "torque", "x", "y", "z")


def commands(
    sense: int = 1,
    targets: Mapping[str, tuple[str, ...]] = TARGETS,
    names: Mapping[str, str] = NAMES,
) -> list[Given]:
    """Every command of every component, with what must be given, and what asks for something; motions of one sense."""
    found: list[Given] = []
    for verb in VERBS:
        fields = verb["arguments"]["fields"]
        needed = {f["name"]: value_of(f, names) for f in fields if f["presence"] == "required"}
        needed |= {key: sense * needed[key] for key in SIGNED if isinstance(needed.get(key), float)}
        name = f"{verb['target_kind']}.{verb['name']}"
        sets = [{key: True} for key in ASK.get(name, ())] or [{}]
        if verb["name"] == "jog":
            keys = ("forward", "positive") if sense > 0 else ("backward", "negative")
            sets = [{f["name"]: True} for f in fields if f["name"] in keys] or [{"x": sense * 10.0}]
        for target in targets.get(verb["target_kind"], ()):
            found += [(target, verb["name"], needed | given) for given in sets]
    return found
