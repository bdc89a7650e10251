"""The scene of a machine: its solids, fixed or moved by signals.

A scene is JSON. `nodes` are frames with solids on them, in mm:

    {"name": "robot.link_2", "of": "robot", "solids": [...],
     "at": [12 numbers],        upper rows of a matrix: pose in the world, or in its moving frame; left out: identity
     "moved": {...}}            left out: it is fixed

`moved` is one of

    {"group": "robot", "link": 2}                             the pose of a link, by the kinematics (`link_poses`)
    {"component": "m1", "pose": ["x", "y", "", "", "", "c"],  published fields of X, Y, Z, A, B, C; "": 0
     "system": "coordinate_system"}                           field with the number that gives its height (`heights`)
    {"component": "x", "slide": "actual_position", "from": 0, "scale": 1, "wrap": 600, "turns": true}
                                                              along X, or about Z in deg

`shown`, {"component": "picker", "field": "held"}: the node is visible while that field is above 0; left out: always.

`label` is the height of a node's name above its frame. `belts` holds the size of objects on belts, `trails` the groups
that leave a trail, `followed` the components that a camera can follow. A section that the machine file leaves out has
no nodes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from takt import _core
from takt.kinematics import Kinematics, KinematicsError
from takt.recording import Array
from takt.scene.mechanisms import solids_of_links
from takt.scene.solids import Solid, ball, box, cylinder, from_file, pose_matrix, rounded, shift
from takt.urdf_files import urdf_folders
from takt.yaml_text import to_json

Node = dict[str, Any]
Mechanisms = Mapping[str, tuple[Kinematics, list[str], Array]]  # of groups: kinematics, axes, base

BELT_WIDTH = 120.0  # mm; the machine file gives neither width nor length of belts
BELT_LENGTH = 800.0
MARKS = 50.0  # mm between marks on a belt
TABLE = 300.0  # radius of a belt that turns
PRODUCT = 20.0  # height: the tool touches its top
STATOR = 240.0
MOVER = 12.0  # height
TRAVEL = 600.0  # of an axis without limits, until its slide starts again
SMALL, LARGE = 150.0, 1500.0  # slides are drawn no smaller and no larger
DISC = 60.0  # radius of an axis that turns
ROOM = 160.0  # distance between axes
NO_LIMIT = (-math.inf, math.inf)


def make_scene(
    machine: Mapping[str, Any], mechanisms: Mechanisms, text: str = "", folder: Path | None = None
) -> dict[str, Any]:
    """Returns the scene of a machine, from the loader's description.

    text: of the machine file, which gives the location of its URDF. folder: base of file names; None: no file is
    opened."""
    made = _Maker(machine, mechanisms, {} if folder is None else urdf_folders(text, folder), folder)
    made.stators()
    made.parts()
    made.movers()
    made.belts()
    made.zones()
    made.groups()
    made.held()
    made.poses()
    made.axes_alone()
    return made.scene()


class _Maker:
    def __init__(
        self,
        machine: Mapping[str, Any],
        mechanisms: Mechanisms,
        urdf_folders: Mapping[str, Path],
        folder: Path | None,
    ) -> None:
        self.machine, self.mechanisms, self.urdf_folders, self.folder = machine, mechanisms, urdf_folders, folder
        self.axes = {axis["name"]: axis for axis in machine["axes"]}
        self.nodes: list[Node] = []
        self.room: list[list[float]] = []  # occupied positions, X and Y
        self.heights = self._heights()

    def scene(self) -> dict[str, Any]:
        links = {name: rounded(mechanism.link_spans) for name, (mechanism, _, _) in self.mechanisms.items()}
        found = {
            "heights": self.heights,
            "spans": links,
            "nodes": self.nodes,
            "belts": {b["name"]: {"size": self._product()} for b in self.machine["belts"]},
            "trails": [{"group": g, "base": rounded(base[:3])} for g, (_, _, base) in self.mechanisms.items()],
            "parts": self._part_names(),
            "followed": [*self.mechanisms, *(mover["name"] for mover in self.machine["movers"])],
        }
        return {key: value for key, value in found.items() if value or key in ("heights", "nodes")}

    def _add(self, name: str, solids: Iterable[Solid], **more: Any) -> None:
        if kept := list(solids):
            self.nodes.append({"name": name, "solids": kept, **more})

    def _heights(self) -> list[float]:
        """Returns the heights of the coordinate systems: stacked, the first one on top, far enough apart to see between
        them."""
        systems = len(self.machine["coordinate_systems"])
        widest = max(
            (STATOR * max(part.get("columns") or 0, part.get("rows") or 0) for part in self.machine["parts"]), default=0
        )
        storey = max(600.0, 0.22 * widest)
        return rounded([storey * (systems - 1 - i) for i in range(systems)])

    def _part_names(self) -> dict[str, list[str]]:
        """Returns the names of the parts that `first_part` and `second_part` of groups with a workspace index."""
        if not any(group.get("workspace") for group in self.machine["groups"]):
            return {}
        return dict(_core.parts_of_groups(to_json(self.machine).encode(), "machine"))

    # --- movers, stators and parts ---

    def stators(self) -> None:
        for environment in self.machine["environments"]:
            tiles = [[place["x"], place["y"]] for place in environment["stators"]]
            self.room += tiles
            self._add(environment["name"], _tiles(tiles), of=environment["name"])

    def parts(self) -> None:
        for part in self.machine["parts"]:
            tiles = [[place["x"], place["y"]] for place in part.get("stators") or ()]
            tiles = tiles or [
                [STATOR * column, STATOR * row]
                for row in range(int(part.get("rows") or 0))
                for column in range(int(part.get("columns") or 0))
            ]
            at = part["positions"][part["initial_position"] - 1]
            self.room += [[at["x"] + x, at["y"] + y] for x, y in tiles]
            moved = {"component": part["name"], "pose": ["x", "y", "", "", "", ""], "system": "coordinate_system"}
            solids = _tiles(tiles) or [ball(4, (0, 0, 0), "stator")]  # its tracks move with it
            self._add(part["name"], solids, of=part["name"], moved=moved)

    def movers(self) -> None:
        for mover in self.machine["movers"]:
            width, height = mover["width"], mover["height"]
            self.room.append([mover["initial"]["x"], mover["initial"]["y"]])
            front = box((0.06 * width, 0.5 * height, MOVER + 1), (0.44 * width, 0, MOVER / 2), "mark")
            moved = {"component": mover["name"], "pose": list("xyzabc"), "system": "coordinate_system"}
            solids = [box((width, height, MOVER), (0, 0, MOVER / 2), "mover"), front]
            self._add(mover["name"], solids, of=mover["name"], moved=moved, label=70)

    # --- belts ---

    def belts(self) -> None:
        for belt in self.machine["belts"]:
            frame = pose_matrix(belt["origin"])
            at = rounded(frame[:3])
            moved = {"component": belt["name"], "slide": "position"}
            if belt["kind"] == "turning":
                table = cylinder(TABLE, (0, 0, -PRODUCT - 20), (0, 0, -PRODUCT), "belt")
                mark = box((TABLE, 8, 2), (TABLE / 2, 0, -PRODUCT), "mark")
                self._add(belt["name"], [table], at=at, of=belt["name"], label=70)
                self._add(f"{belt['name']}.marks", [mark], at=at, of=belt["name"], moved={**moved, "turns": True})
                self.room += [[frame[0, 3] + x, frame[1, 3] + y] for x, y in ((-TABLE, -TABLE), (TABLE, TABLE))]
                continue
            start = min(0.0, belt.get("lower_limit") or 0.0)
            end = belt.get("upper_limit") or BELT_LENGTH
            end = max(end, start + 100.0)
            size = (end - start, BELT_WIDTH, 16.0)
            self._add(
                belt["name"],
                [
                    box(size, ((start + end) / 2, 0, -PRODUCT - 8), "belt"),
                    *(
                        cylinder(
                            14, (x, -BELT_WIDTH / 2 - 6, -PRODUCT - 14), (x, BELT_WIDTH / 2 + 6, -PRODUCT - 14), "base"
                        )
                        for x in (start, end)
                    ),
                    *(
                        box((3, BELT_WIDTH + 8, 2), (x, 0, -PRODUCT), "limit")
                        for x in (belt.get("lower_limit"), belt.get("upper_limit"))
                        if x is not None
                    ),
                ],
                at=at,
                of=belt["name"],
                label=70,
            )
            places = np.arange(start, end - MARKS + 1e-9, MARKS)
            marks = [box((2, BELT_WIDTH, 1), (x, 0, -PRODUCT + 0.3), "mark") for x in places]
            self._add(f"{belt['name']}.marks", marks, at=at, of=belt["name"], moved={**moved, "wrap": MARKS})
            for x in (start, end):
                for y in (-BELT_WIDTH / 2, BELT_WIDTH / 2):
                    self.room.append((frame @ [x, y, 0, 1])[:2].tolist())

    # --- groups ---

    def zones(self) -> None:
        for zone in self.machine["zones"]:
            lower, upper = ([zone[side][axis] for axis in "xyz"] for side in ("lower", "upper"))
            self._add(zone["name"], [_between(lower, upper, "zone")], of=zone["name"])

    def groups(self) -> None:
        for group in self.machine["groups"]:
            if group["name"] not in self.mechanisms:
                continue
            mechanism, axes, base = self.mechanisms[group["name"]]
            name = group["name"]
            ranges = np.array([self._range(axis) for axis in axes[: mechanism.axes]], float)
            solids = solids_of_links(group, mechanism, ranges, self.folder, self.urdf_folders.get(name))
            for i, link in enumerate(mechanism.links):
                self._add(f"{name}.{link}", solids[i], of=name, moved={"group": name, "link": i})
            self.room += _reach(mechanism, ranges, base)
            self._workspace(group, base)

    def held(self) -> None:
        """Adds the products that pick and place modules hold: the top touches the tool, on its far side from the
        flange."""
        groups = {group["name"]: group for group in self.machine["groups"]}
        for module in self.machine["pick_and_place"]:
            name = module["group"]
            if name not in self.mechanisms:
                continue
            kinematics, tool = groups[name]["kinematics"], pose_matrix(groups[name]["tool"])
            outwards = 1.0 if kinematics.get("serial") or kinematics.get("six_axis") else -1.0
            if abs(tool[2, 3]) > 1.0:
                outwards = math.copysign(1.0, tool[2, 3] * tool[2, 2])
            size = self._product()
            solid = box(size, (0, 0, outwards * size[2] / 2), "product")
            moved = {"group": name, "link": len(self.mechanisms[name][0].links) - 1}
            shown = {"component": module["name"], "field": "held"}
            self._add(f"{module['name']}.held", [solid], at=rounded(tool[:3]), of=name, moved=moved, shown=shown)

    def _product(self) -> list[float]:
        """Returns the edges of a product [mm]: those of the twin if it has products, else a default."""
        told = (self.machine.get("twin") or {}).get("products")
        return [told["length"], told["width"], told["height"]] if told else [40.0, 40.0, PRODUCT]

    def _workspace(self, group: Mapping[str, Any], base: Array) -> None:
        workspace = group.get("workspace")
        if not workspace:
            return
        at = rounded(base[:3])
        shapes = [from_file(s, self.folder, "obstacle", part=s["name"]) for s in workspace["obstacles"]]
        obstacles = [shape for shape in shapes if shape is not None]
        self._add(f"{group['name']}.obstacles", obstacles, at=at, of=group["name"])
        bounds = workspace["bounds"]
        corners = [
            [bounds[side].get(axis) if bounds[side].get(axis) is not None else other for axis in "xyz"]
            for side, other in (("lower", -math.inf), ("upper", math.inf))
        ]
        if not np.any(np.isfinite(corners)):
            return
        reach = np.array(_reach3(self.mechanisms[group["name"]][0], self._ranges_of(group)))
        lower = np.where(np.isfinite(corners[0]), corners[0], reach.min(axis=0))
        upper = np.where(np.isfinite(corners[1]), corners[1], reach.max(axis=0))
        if np.all(upper > lower):
            self._add(f"{group['name']}.bounds", [_between(lower, upper, "bound")], at=at, of=group["name"])

    def poses(self) -> None:
        for pose in self.machine["poses"]:
            ends = ((80, 0, 0), (0, 80, 0), (0, 0, 80))
            solids = [cylinder(3, (0, 0, 0), end, f"axis_{i}") for i, end in zip("xyz", ends, strict=True)]
            moved = {"component": pose["name"], "pose": [f"pose_{axis}" for axis in "xyzabc"]}
            self._add(pose["name"], solids, of=pose["name"], moved=moved, label=70)

    def _ranges_of(self, group: Mapping[str, Any]) -> Array:
        mechanism, axes, _ = self.mechanisms[group["name"]]
        return np.array([self._range(axis) for axis in axes[: mechanism.axes]], float)

    def _range(self, axis: str) -> tuple[float, float]:
        limits = self.axes[axis]["limits"]
        lower, upper = limits.get("lower"), limits.get("upper")
        return (NO_LIMIT[0] if lower is None else lower, NO_LIMIT[1] if upper is None else upper)

    # --- axes without a mechanism ---

    def axes_alone(self) -> None:
        """Adds slides and discs in rows in front of everything else, for axes without a mechanism."""
        taken = {axis for mechanism, axes, _ in self.mechanisms.values() for axis in axes[: mechanism.axes]}
        taken |= {belt["axis"] for belt in self.machine["belts"] if belt.get("axis")}
        alone = [axis for axis in self.machine["axes"] if axis["name"] not in taken]
        places = np.array(self.room or [[0.0, ROOM]], float).reshape(-1, 2)
        left, front = float(places[:, 0].min()), float(places[:, 1].min()) - ROOM
        discs = [axis for axis in alone if axis["unit"] in ("deg", "°", "rev") or axis["kind"] == "rotary"]
        for i, axis in enumerate(discs):
            self._disc(axis, left + DISC + ROOM * (i % 6), front - ROOM * (i // 6))
        front -= ROOM * math.ceil(len(discs) / 6)
        for i, axis in enumerate(axis for axis in alone if axis not in discs):
            self._slide(axis, left, front - ROOM * i)

    def _slide(self, axis: Mapping[str, Any], left: float, y: float) -> None:
        lower, upper = self._range(axis["name"])
        moved: dict[str, Any] = {"component": axis["name"], "slide": "actual_position"}
        length = upper - lower
        if math.isfinite(length) and length > 0:
            scale = float(np.clip(length, SMALL, LARGE)) / length
            moved |= {"from": lower, "scale": scale}
            length *= scale
        else:
            length = TRAVEL
            moved |= {"wrap": TRAVEL}
        at = rounded(shift(left, y, 0))
        name = axis["name"]
        rail = [box((length + 80, 50, 16), (length / 2, 0, 8), "base")]
        rail += [box((6, 60, 40), (x, 0, 20), "limit") for x in (-43, length + 43)] if "wrap" not in moved else []
        self._add(f"{name}.rail", rail, at=at, of=name, label=70)
        carriage = [box((70, 64, 34), (0, 0, 33), "link"), box((4, 66, 36), (0, 0, 33), "mark")]
        self._add(name, carriage, at=at, of=name, moved=moved)

    def _disc(self, axis: Mapping[str, Any], x: float, y: float) -> None:
        """Adds an upright disc with a hand, seen from the front."""
        name = axis["name"]
        upright = [1, 0, 0, x, 0, 0, -1, y, 0, 1, 0, DISC + 20]
        turn = 360.0 / axis["modulus"] if axis["kind"] == "rotary" else 360.0 if axis["unit"] == "rev" else 1.0
        moved: dict[str, Any] = {"component": name, "slide": "actual_position", "turns": True}
        if turn != 1.0:
            moved["scale"] = turn
        stand = [box((40, 40, DISC + 20), (0, 30, (DISC + 20) / 2), "base")]
        self._add(f"{name}.stand", stand, at=rounded(shift(x, y, 0)), of=name, label=2 * DISC + 25)
        disc = [cylinder(DISC, (0, 0, 0), (0, 0, 14), "link"), box((DISC - 6, 8, 4), (DISC / 2, 0, 16), "mark")]
        self._add(name, disc, at=rounded(upright), of=name, moved=moved)


def _tiles(places: list[list[float]]) -> list[Solid]:
    return [{"kind": "tiles", "size": [STATOR, STATOR, 30.0], "places": places, "colour": "stator"}] if places else []


def _between(lower: Any, upper: Any, colour: str) -> Solid:
    low, high = np.asarray(lower, float), np.asarray(upper, float)
    return box(high - low, (low + high) / 2, colour)


def _reach3(mechanism: Kinematics, ranges: Array) -> list[list[float]]:
    """Returns sampled positions of the tool in the base frame, over the ranges of the axes."""
    rotary = np.array(mechanism.rotary)
    usual = np.where(rotary[:, np.newaxis], [-60.0, 60.0], [-500.0, 500.0])
    known = np.where(np.isfinite(ranges), ranges, usual)
    shares = np.random.default_rng(1).random((200, mechanism.axes))
    found = []
    for joints in known[:, 0] + shares * (known[:, 1] - known[:, 0]):
        try:
            found.append(mechanism.forward(joints)[:3].tolist())
        except KinematicsError:
            continue
    return found or [[0.0, 0.0, 0.0]]


def _reach(mechanism: Kinematics, ranges: Array, base: Array) -> list[list[float]]:
    places = np.array(_reach3(mechanism, ranges)) @ base[:3, :3].T + base[:3, 3]
    low, high = places.min(axis=0), places.max(axis=0)
    return [[low[0], low[1]], [high[0], high[1]]]
