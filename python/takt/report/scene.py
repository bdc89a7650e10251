"""The plan and the scene of the machine for the page's own drawing: the description that the live page gets, and the
poses of arms and of objects on belts over time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from takt import msgs, style
from takt.cam import Table
from takt.errors import ConfigError
from takt.recording import Array, Recording
from takt.report.columns import Block
from takt.scene import rounded_poses
from takt.scene.moving import POSE, held
from takt.view.machine import Machine, drawn

RATE_HZ = 50.0  # rate of the poses of arms, unless they would exceed
NUMBERS = 1_000_000  # numbers
LYING = ("tracks", "stators", "parts", "movers", "belts", "groups")  # visible in the plan


def machine_of(recording: Recording) -> Machine | None:
    """Returns the machine of a recording; None if the recording has none, or it cannot be read."""
    file = recording.meta.get("machine_file")
    if not file:
        return None
    description = msgs.machine_description()
    description.name = str(recording.meta.get("machine", ""))
    description.version = str(recording.meta.get("version", ""))
    description.period_s = float(recording.meta.get("period_s", 0.001))
    description.text = file["text"]
    try:
        return Machine(description, Path(file["folder"]))
    except ConfigError:
        return None  # file of another version


def cams_of(recording: Recording, machine: Machine | None) -> dict[str, Any] | None:
    """Returns the cams that the page draws for recorded cam modules, including cams made at run time; None if there is
    no module."""
    modules = [name for name in recording.components if "mp05_set_y_position" in recording.fields(name)]
    if machine is None or not modules:
        return None
    fields = ("mp01_set_master_position", "mp02_set_slave_position", "actual_slave_position")
    tables = [(number, Table.from_dict(cam)) for number, cam in recording.meta.get("made_cams", [])]
    return {
        "cams": machine.describe()["cams"],
        "made": [{"number": number, **drawn(table)} for number, table in tables],
        "modules": [
            {"name": name, "units": {f: recording.unit(name, f) for f in fields if f in recording.fields(name)}}
            for name in modules
        ],
        "palette": list(style.PALETTE),
    }


def scene_of(recording: Recording, block: Block, machine: Machine | None) -> dict[str, Any] | None:
    """Returns the scene; None if the machine has nothing to draw, or the recording has no machine."""
    if machine is None:
        return None
    told = machine.describe()
    flat = any(told["plan"][what] for what in LYING)
    if not flat and not told["scene"]["nodes"]:
        return None
    kinds = {name: {"live": kind["live"], "fields": []} for name, kind in told["kinds"].items()}
    shown = {name: told[name] for name in ("name", "period_s", "components", "palette", "states", "plan", "scene")}
    groups = {name: _links(machine, name, recording, block) for name in machine.mechanisms}
    return {
        "flat": flat,
        "machine": {**shown, "kinds": kinds},
        "links": {name: links for name, links in groups.items() if links is not None},
        "objects": {belt: _objects(told, block) for belt, told in recording.meta.get("objects", {}).items()},
    }


def _links(machine: Machine, group: str, recording: Recording, block: Block) -> dict[str, Any] | None:
    """Returns the poses of the links of a group, frame after frame: n frames from `from` to `to` [s], of `count`
    numbers each. None if its axes were not recorded."""
    mechanism, axes, _ = machine.mechanisms[group]
    axes = axes[: mechanism.axes]
    if any(axis not in recording or len(recording[axis]) < 2 for axis in axes):
        return None
    first = max(float(recording[axis]["time_s"][0]) for axis in axes)
    last = min(float(recording[axis]["time_s"][-1]) for axis in axes)
    if not last > first:
        return None
    count = POSE * len(mechanism.links)
    n = max(2, min(math.ceil((last - first) * RATE_HZ), NUMBERS // count))
    times = np.linspace(first, last, n)
    joints = np.stack([held(recording, axis, "actual_position", times) for axis in axes], axis=1)
    poses = rounded_poses(machine.link_poses(group, joints))
    return {"from": first, "to": last, "n": n, "count": count, **block.exactly(poses, "f32")}


def _objects(told: dict[str, Array], block: Block) -> dict[str, Any]:
    return {
        "time": block.time(told["time_s"]),
        "first": block.exactly(told["first"], "f64"),
        "rows": block.exactly(told["rows"], "f32"),
    }
