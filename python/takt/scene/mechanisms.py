"""The solids of a group's links: the shapes that the machine file or its URDF gives, else simple solids made from the
parameters of the mechanism."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from takt import _core
from takt.kinematics import Kinematics
from takt.names import shown
from takt.recording import Array
from takt.scene.solids import Solid, ball, box, capsule, cylinder, from_file

ROD_SPACING = 60.0  # mm: between the rods of a Delta without a given spacing, so that both are visible
TRAVEL = 500.0  # mm to both sides of an axis without limits
THICK = 0.035  # radius of an arm, relative to the reach of the mechanism
Solids = list[list[Solid]]  # of each link


def solids_of_links(
    group: Mapping[str, Any], mechanism: Kinematics, ranges: Array, folder: Path | None, urdf_folder: Path | None
) -> Solids:
    """Returns the solids of each link, in its own frame. ranges: (axes, 2), ranges of the axes."""
    spans = mechanism.link_spans
    kinematics = group["kinematics"]
    kind = next((kind for kind in kinematics if kinematics[kind] and kind != "joints"), "")
    given = _given(group, mechanism, folder)
    serial = kinematics.get("serial")
    if serial and not any(given):
        seen, simple = (_of_urdf(mechanism, serial, urdf_folder, visual=visual) for visual in (True, False))
        given = [a or b for a, b in zip(seen, simple, strict=True)]
    made = _made(kind, kinematics.get(kind) or {}, mechanism, spans, ranges)
    shown = [given[i] or made[i] for i in range(len(made))]
    shown[-1] = [*(given[-1] or _tool(group["tool"], _thickness(kind, spans))), *_gripper(group, folder)]
    return shown


def _given(group: Mapping[str, Any], mechanism: Kinematics, folder: Path | None) -> Solids:
    return _placed(mechanism, (group.get("workspace") or {}).get("links") or (), folder)


def _of_urdf(mechanism: Kinematics, serial: Mapping[str, Any], folder: Path | None, *, visual: bool) -> Solids:
    """Returns the shapes of links in a URDF, visual or for collisions; files that cannot be read give none."""
    told = _core.urdf_solids(serial["urdf"], serial["base"], serial["tip"], shown((folder or Path()).resolve()), visual)
    return _placed(mechanism, [json.loads(one) for one in told], folder)


def _placed(mechanism: Kinematics, solids: Sequence[Mapping[str, Any]], folder: Path | None) -> Solids:
    """Returns the shapes of a machine file: each applies to the link of this name, else to all links whose names begin
    with it."""
    found: Solids = [[] for _ in mechanism.links]
    for solid in solids:
        exact = [i for i, link in enumerate(mechanism.links) if link == solid["link"]]
        for i in exact or [i for i, link in enumerate(mechanism.links) if link.startswith(solid["link"])]:
            part = solid["name"] or mechanism.links[i]
            shape = from_file(solid, folder, _colour(mechanism.links[i]), mechanism.link_spans[i], part=part)
            if shape is not None:
                found[i].append(shape)
    return found


def _gripper(group: Mapping[str, Any], folder: Path | None) -> list[Solid]:
    solids = (group.get("workspace") or {}).get("gripper") or ()
    shapes = (from_file(solid, folder, "tool", part=solid["name"]) for solid in solids)
    return [shape for shape in shapes if shape is not None]


def _tool(tool: Mapping[str, float], thick: float) -> list[Solid]:
    """Returns the solids from the flange to the tool centre point."""
    at = (tool["x"], tool["y"], tool["z"])
    point = ball(max(4.0, 0.35 * thick), at, "tip", part="tool")
    return [point, cylinder(0.35 * thick, (0, 0, 0), at, "tool", part="tool")] if math.hypot(*at) > 1 else [point]


def _thickness(kind: str, spans: Array) -> float:
    """Returns the radius [mm] of drawn arms: a share of the length of all links together, for a Delta of one of its
    equal arms."""
    lengths = np.linalg.norm(spans, axis=1)
    reach = float(np.sum(np.unique(np.round(lengths, 3)) if kind == "delta" else lengths))
    return float(np.clip(THICK * reach, 6.0, 70.0))


def _colour(link: str) -> str:
    return "base" if link == "base" else "rod" if link.startswith("lower_arm") else "link"


def _made(kind: str, p: Mapping[str, Any], mechanism: Kinematics, spans: Array, ranges: Array) -> Solids:
    if kind == "delta":
        return _delta(p, mechanism, spans)
    if kind in ("gantry", "core_xy"):
        return _gantry(mechanism, ranges)
    if kind == "scara":
        return _scara(p, mechanism, spans, ranges)
    return _chain(mechanism, spans)


def _delta(p: Mapping[str, Any], mechanism: Kinematics, spans: Array) -> Solids:
    radius, upper = p["base_radius"], p["upper_arm"]
    thick = max(4.0, 0.06 * upper)
    half = 0.0 if p["rod_spacing"] else ROD_SPACING / 2
    solids: Solids = []
    for link, span in zip(mechanism.links, spans, strict=True):
        if link == "base":
            plate = cylinder(radius, (0, 0, 1.2 * thick), (0, 0, 1.2 * thick + 12), "base")
            solids.append([plate, *_motors(p, thick)])
        elif link.startswith("upper_arm"):
            aside = np.array([0.0, half, 0.0])
            hinge = cylinder(0.6 * thick, span - aside, span + aside, "joint", part=link)
            solids.append([capsule(thick, (0, 0, 0), span, "link", part=link), hinge])
        elif link.startswith("lower_arm"):
            aside = np.array([0.0, half if link.endswith("a") else -half, 0.0])
            solids.append([capsule(max(3.0, 0.025 * upper), aside, span + aside, "rod", part=link)])
        elif link == "platform":
            solids.append([cylinder(max(p["platform_radius"], 20.0), (0, 0, 0), (0, 0, 10), "link", part=link)])
        else:
            solids.append([])
    return solids


def _motors(p: Mapping[str, Any], thick: float) -> list[Solid]:
    motors = []
    for i in range(3):
        turn = math.radians(p["first_arm_deg"] + 120 * i)
        cos, sin = math.cos(turn), math.sin(turn)
        middle, half = np.array([cos, sin, 0.0]) * p["base_radius"], 2.2 * thick * np.array([-sin, cos, 0.0])
        motors.append(cylinder(1.5 * thick, middle - half, middle + half, "base"))
    return motors


def _chain(mechanism: Kinematics, spans: Array) -> Solids:
    """Returns a capsule along each link of non-zero length and a ball at its axis; a column under the first one."""
    thick = _thickness("", spans)
    solids: Solids = []
    joints = len(mechanism.links) - 2
    for i, (link, span) in enumerate(zip(mechanism.links, spans, strict=True)):
        radius = thick * (1.3 - 0.8 * max(0, i - 1) / max(1, joints))  # thinner towards the tool
        length = float(np.linalg.norm(span))
        if link == "base":
            column = span if length > 1 else np.array([0.0, 0.0, 0.6 * thick])
            foot = cylinder(1.9 * thick, (0, 0, -0.3 * thick), (0, 0, 0.3 * thick), "base")
            solids.append([foot, cylinder(1.4 * thick, (0, 0, 0), column, "base")])
        elif link == "tool":
            solids.append([])
        else:
            solid = [ball(1.15 * radius, (0, 0, 0), "joint", part=link)]
            solids.append([*solid, capsule(0.8 * radius, (0, 0, 0), span, "link", part=link)] if length > 1 else solid)
    return solids


def _scara(p: Mapping[str, Any], mechanism: Kinematics, spans: Array, ranges: Array) -> Solids:
    """Returns arms at the height of the machine file, and a spindle that reaches them in all positions."""
    thick, height = _thickness("scara", spans), p["height"]
    lift = np.array([0.0, 0.0, height])
    ends = np.zeros((2, mechanism.axes))
    ends[:, 2] = np.where(np.isfinite(ranges[2]), ranges[2], 0.0)
    heights = mechanism.link_frames(ends)[:, list(mechanism.links).index("spindle"), 2, 3] - height
    solids: Solids = []
    for link, span in zip(mechanism.links, spans, strict=True):
        if link == "base":
            foot = cylinder(1.9 * thick, (0, 0, 0), (0, 0, 0.4 * thick), "base")
            solids.append([foot, cylinder(1.3 * thick, (0, 0, 0), (0, 0, max(height, thick)), "base")])
        elif link.startswith("arm"):
            radius = 0.9 * thick if link == "arm_1" else 0.7 * thick
            joint = cylinder(1.3 * radius, (0, 0, height - radius), (0, 0, height + radius), "joint", part=link)
            solids.append([joint, capsule(radius, lift, lift + span, "link", part=link)])
        elif link == "spindle":
            low, high = min(0.0, -heights.max()), max(0.0, -heights.min()) + 3 * thick
            solids.append([cylinder(0.4 * thick, (0, 0, low), (0, 0, high), "rod", part=link)])
        else:
            solids.append([])
    return solids


def _gantry(mechanism: Kinematics, ranges: Array) -> Solids:
    """Returns rails along X, a beam along Y and a column along Z, over the travel of the tool by the ranges of the
    axes."""
    lower, upper = _travel(mechanism, ranges)
    links = mechanism.links
    size = float(np.clip(0.06 * np.max(upper - lower), 20.0, 90.0))
    top = upper[2] + 2.2 * size
    moves = {name for link in links for name in link if link not in ("base", "tool")}
    sides = [lower[1] - 1.5 * size, upper[1] + 1.5 * size] if "y" in moves else [0.0]
    solids: Solids = []
    for link in links:
        if link == "base":
            length, middle = upper[0] - lower[0] + 4 * size, (lower[0] + upper[0]) / 2
            rails = [box((length, 0.5 * size, 0.5 * size), (middle, y, top - 0.6 * size), "base") for y in sides]
            solids.append(rails if "x" in moves else [])
        elif link == "x" and "y" in moves:
            beam = ((sides[0] + sides[1]) / 2, sides[1] - sides[0] + size)
            solids.append([box((size, beam[1], 0.8 * size), (0, beam[0], top), "link", part=link)])
        elif link == ("xy" if "y" in moves and "x" in moves else "x" if "x" in moves else "y"):
            carriage = box((1.7 * size, 1.4 * size, 1.5 * size), (0, 0, top), "joint", part=link)
            solids.append([carriage])
        elif set(link) == moves:
            length = top - lower[2] + size
            column = box((0.6 * size, 0.6 * size, length), (0, 0, length / 2), "rod", part=link)
            solids.append([column])
        else:
            solids.append([])
    return solids


def _travel(mechanism: Kinematics, ranges: Array) -> tuple[Array, Array]:
    """Returns the smallest and the largest X, Y, Z of the tool."""
    known = np.where(np.isfinite(ranges), ranges, np.array([-TRAVEL, TRAVEL]))
    corners = np.array(list(itertools.product(*known)))
    places = mechanism.forward(corners)[:, :3]
    return places.min(axis=0), places.max(axis=0)
