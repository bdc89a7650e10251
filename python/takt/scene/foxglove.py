"""A recording's scene for Foxglove (PY-27): messages of its types FrameTransforms and SceneUpdate, lengths in m, as
JSON. Scenes, poses and sizes that are passed in are in mm.

Every node of the scene is a frame, and its solids are an entity in that frame, so that a viewer without knowledge of
machines moves it by transforms alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from takt.recording import Array, Recording
from takt.scene.moving import held, is_shown, link_poses, node_pose, poses_of, rounded_poses

WORLD = "world"
RATE_HZ = 25.0  # of transforms
COLOURS = {
    "base": (0.36, 0.40, 0.46, 1.0),
    "link": (0.18, 0.44, 0.87, 1.0),
    "joint": (0.14, 0.16, 0.18, 1.0),
    "rod": (0.41, 0.45, 0.50, 1.0),
    "tool": (0.41, 0.45, 0.50, 1.0),
    "tip": (0.84, 0.27, 0.24, 1.0),
    "belt": (0.79, 0.82, 0.85, 1.0),
    "mark": (0.41, 0.45, 0.50, 1.0),
    "limit": (0.18, 0.44, 0.87, 1.0),
    "stator": (0.90, 0.92, 0.94, 1.0),
    "mover": (0.18, 0.44, 0.87, 1.0),
    "obstacle": (0.78, 0.48, 0.11, 0.6),
    "zone": (0.78, 0.48, 0.11, 0.16),
    "bound": (0.18, 0.44, 0.87, 0.06),
    "product": (0.78, 0.48, 0.11, 1.0),
    "near": (0.18, 0.62, 0.42, 1.0),
    "taken": (0.41, 0.45, 0.50, 1.0),
    "axis_x": (0.84, 0.27, 0.24, 1.0),
    "axis_y": (0.18, 0.62, 0.42, 1.0),
    "axis_z": (0.18, 0.44, 0.87, 1.0),
}
EVENTS = "/events"  # the topic of marks, starts and ends of commands, errors
SHAPES = "/scene"
POSES = "/tf"
ONE = 0  # Foxglove's kind of deletion: the entity with this id
TRACK = (0.18, 0.44, 0.87, 0.75)


class Stream(NamedTuple):
    """Messages of one topic, ordered by time."""

    topic: str
    schema: dict[str, Any]
    times_s: Array
    messages: Iterator[dict[str, Any]]


def topic_of(component: str) -> str:
    """Returns the topic of a component's values: /NAME, or /components/NAME if /NAME is a topic of another kind."""
    topic = f"/{component}"
    return f"/components{topic}" if topic in (EVENTS, SHAPES, POSES) else topic


def streams_of(recording: Recording, machine: Any) -> list[Stream]:
    """Returns the streams of transforms and of solids of a recorded machine (`takt.view.machine.Machine`); empty if the
    scene has no nodes or the recording no samples."""
    scene, start, end = machine.scene, recording.start_s, recording.end_s
    if not scene["nodes"] or not end >= start:
        return []
    times = np.linspace(start, end, max(2, math.ceil((end - start) * RATE_HZ) + 1))
    moved = list(_transforms(recording, machine, times))
    looks = [*_products(recording, scene), *_coming_and_going(recording, scene, times)]
    solids = [(start, {"deletions": [], "entities": [*entities(scene, start), *tracks(machine, start)]}), *looks]
    solids.sort(key=lambda one: one[0])
    return [
        Stream(POSES, TRANSFORMS, np.array([at for at, _ in moved]), (message for _, message in moved)),
        Stream(SHAPES, SCENE, np.array([at for at, _ in solids]), (message for _, message in solids)),
    ]


# --- poses of frames ---


def _transforms(recording: Recording, machine: Any, times: Array) -> Iterator[tuple[float, dict[str, Any]]]:
    """Yields time [s] and message at each time at which transforms have changed; unknown poses are left out."""
    scene = machine.scene
    links = {name: _links(recording, machine, name, times) for name in machine.mechanisms}
    columns: dict[tuple[str, str], Array] = {}

    def value_at(row: int) -> Callable[[str, str], float]:
        def value(component: str, field: str) -> float:
            key = (component, field)
            if key not in columns:
                columns[key] = _column(recording, component, field, times)
            return float(columns[key][row])

        return value

    last: dict[str, list[float]] = {}
    for row, time_s in enumerate(times.tolist()):
        poses = {name: rows[row] for name, rows in links.items()}
        changed = []
        for node in scene["nodes"]:
            if "moved" not in node and row:
                continue
            matrix = node_pose(scene, node, poses, value_at(row))
            if not np.all(np.isfinite(matrix)):
                continue
            pose = rounded_poses(poses_of(matrix)).tolist()
            if last.get(node["name"]) != pose:
                last[node["name"]] = pose
                changed.append(transform(node["name"], pose, time_s))
        if changed:
            yield time_s, {"transforms": changed}


def _links(recording: Recording, machine: Any, group: str, times: Array) -> Array:
    mechanism, axes, base = machine.mechanisms[group]
    joints = [_column(recording, axis, "actual_position", times) for axis in axes[: mechanism.axes]]
    return link_poses(mechanism, base, np.stack(joints, axis=1))


def _column(recording: Recording, component: str, field: str, times: Array) -> Array:
    """Returns the values at these times; NaN where nothing was recorded."""
    if component not in recording or field not in recording.fields(component) or not len(recording[component]):
        return np.full(len(times), np.nan)
    column = held(recording, component, field, times)
    return np.where(times >= recording[component]["time_s"][0] - 1e-9, column, np.nan)


def transform(name: str, pose: list[float], time_s: float) -> dict[str, Any]:
    """Returns the transform of a frame to the world, from its pose (7 numbers, mm)."""
    at = _pose(pose)
    return {
        "timestamp": _time(time_s),
        "parent_frame_id": WORLD,
        "child_frame_id": name,
        "translation": at["position"],
        "rotation": at["orientation"],
    }


# --- entities ---


def entities(scene: Mapping[str, Any], time_s: float) -> Iterator[dict[str, Any]]:
    """Yields the entities of nodes that are always visible."""
    for node in scene["nodes"]:
        if "shown" not in node:
            yield entity(node, time_s)


def entity(node: Mapping[str, Any], time_s: float) -> dict[str, Any]:
    """Returns the entity with the solids of a node."""
    shapes: dict[str, list[dict[str, Any]]] = {}
    for solid in node["solids"]:
        for kind, shape in _shapes(solid):
            shapes.setdefault(kind, []).append(shape)
    return _entity(node["name"], node["name"], time_s, shapes)


def coming_or_going(node: Mapping[str, Any], shown: bool, time_s: float) -> dict[str, Any]:
    """Returns the update that shows or removes a node."""
    if shown:
        return {"deletions": [], "entities": [entity(node, time_s)]}
    return {"deletions": [{"timestamp": _time(time_s), "type": ONE, "id": node["name"]}], "entities": []}


def _coming_and_going(
    recording: Recording, scene: Mapping[str, Any], times: Array
) -> Iterator[tuple[float, dict[str, Any]]]:
    for node in scene["nodes"]:
        if "shown" not in node:
            continue
        column = _column(recording, node["shown"]["component"], node["shown"]["field"], times)
        before = False
        for time_s, number in zip(times.tolist(), column.tolist(), strict=True):
            now = is_shown(node, lambda *_, number=number: number)
            if now != before:
                yield time_s, coming_or_going(node, now, time_s)
            before = now


def _entity(name: str, frame: str, time_s: float, shapes: Mapping[str, list[dict[str, Any]]]) -> dict[str, Any]:
    empty: dict[str, list[Any]] = {kind: [] for kind in PRIMITIVES}
    return {
        "timestamp": _time(time_s),
        "frame_id": frame,
        "id": name,
        "lifetime": {"sec": 0, "nsec": 0},  # until it is replaced
        "frame_locked": True,
        "metadata": [],
        **empty,
        **shapes,
    }


def _shapes(solid: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields Foxglove's primitives for one solid: a capsule is a cylinder and two spheres."""
    at = np.eye(4)
    if "at" in solid:
        at[:3] = np.reshape(solid["at"], (3, 4))
    colour = _colour(COLOURS[solid["colour"]])
    placed = {"pose": _pose(poses_of(at).tolist()), "color": colour}
    kind, size = solid["kind"], solid.get("size", ())
    if kind == "box":
        yield "cubes", {**placed, "size": _vector(size)}
    elif kind == "sphere":
        yield "spheres", {**placed, "size": _vector([2 * size[0]] * 3)}
    elif kind in ("cylinder", "capsule"):
        radius, length = size
        across = _vector([2 * radius, 2 * radius, length])
        yield "cylinders", {**placed, "size": across, "bottom_scale": 1.0, "top_scale": 1.0}
        for end in (-length / 2, length / 2) if kind == "capsule" else ():
            ball = {"position": _vector((at @ [0, 0, end, 1])[:3]), "orientation": _UPRIGHT}
            yield "spheres", {"pose": ball, "size": _vector([2 * radius] * 3), "color": colour}
    elif kind == "tiles":
        x, y, z = size
        for px, py in solid["places"]:
            place = {"position": _vector([px + x / 2, py + y / 2, -z / 2]), "orientation": _UPRIGHT}
            yield "cubes", {"pose": place, "size": _vector([x - 3, y - 3, z]), "color": colour}
    else:
        points = np.reshape(solid["vertices"], (-1, 3))
        corners = {"points": [_vector(point) for point in points], "indices": solid["triangles"]}
        yield "triangles", {**placed, **corners, "colors": []}


def tracks(machine: Any, time_s: float) -> Iterator[dict[str, Any]]:
    """Yields the tracks of a machine, as lines."""
    parts = {part["name"] for part in machine.parameters["parts"]}
    for track in machine.describe()["plan"]["tracks"]:
        points = [_vector([x, y, 3.0]) for _, x, y in np.reshape(track["points"], (-1, 3)).tolist()]
        line = {
            **{"type": 1 if track["closed"] else 0, "pose": _pose([0, 0, 0, 0, 0, 0, 1]), "thickness": 2.0},
            **{"scale_invariant": True, "points": points, "color": _colour(TRACK), "colors": [], "indices": []},
        }
        frame = track["part"] if track["part"] in parts else WORLD
        yield _entity(f"track {track['name']}", frame, time_s, {"lines": [line]})


def _products(recording: Recording, scene: Mapping[str, Any]) -> Iterator[tuple[float, dict[str, Any]]]:
    """Yields time [s] and update of the objects on each belt, at each recorded time."""
    for belt, told in recording.meta.get("objects", {}).items():
        size = scene.get("belts", {}).get(belt, {}).get("size")
        for i, time_s in enumerate(told["time_s"].tolist() if size else ()):
            if not recording.start_s <= time_s <= recording.end_s:
                continue
            rows = told["rows"][int(told["first"][i]) : int(told["first"][i + 1])]
            yield time_s, {"deletions": [], "entities": [products_on(belt, size, rows.tolist(), time_s)]}


def products_on(belt: str, size: Any, rows: Iterable[Any], time_s: float) -> dict[str, Any]:
    """Returns the entity of all objects on a belt, with rows of `takt.belt_object_log.rows_of` and the size of an
    object [mm]."""
    cubes = []
    for _, x, y, z, turn, taken, near in rows:
        half = math.radians(turn) / 2
        pose = [x, y, z - size[2] / 2, 0.0, 0.0, math.sin(half), math.cos(half)]
        colour = COLOURS["taken" if taken else "near" if near else "product"]
        cubes.append({"pose": _pose(pose), "size": _vector(size), "color": _colour(colour)})
    return _entity(f"on {belt}", WORLD, time_s, {"cubes": cubes})


# --- Foxglove's types (m) ---


def _time(time_s: float) -> dict[str, int]:
    time_ns = round(time_s * 1e9)
    return {"sec": time_ns // 10**9, "nsec": time_ns % 10**9}


def _vector(mm: Any) -> dict[str, float]:
    x, y, z = (round(float(one) / 1000, 6) for one in mm)
    return {"x": x, "y": y, "z": z}


def _pose(pose: Any) -> dict[str, Any]:
    x, y, z, w = (round(float(one), 6) for one in pose[3:])
    return {"position": _vector(pose[:3]), "orientation": {"x": x, "y": y, "z": z, "w": w}}


def _colour(rgba: tuple[float, ...]) -> dict[str, float]:
    return dict(zip("rgba", rgba, strict=True))


_UPRIGHT = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
PRIMITIVES = ("arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models")


# --- the schemas, as far as they are used here ---


def _object(title: str, **properties: Any) -> dict[str, Any]:
    return {"title": title, "type": "object", "properties": properties, "required": list(properties)}


def _list(of: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": of}


def _numbers(title: str, names: str) -> dict[str, Any]:
    return _object(title, **{name: {"type": "number"} for name in names})


_TEXT: dict[str, Any] = {"type": "string"}
_NUMBER: dict[str, Any] = {"type": "number"}
_FLAG: dict[str, Any] = {"type": "boolean"}
_WHOLE: dict[str, Any] = {"type": "integer"}
_TIME = _object("time", sec=_WHOLE, nsec=_WHOLE)
_XYZ = _numbers("foxglove.Vector3", "xyz")
_TURN = _numbers("foxglove.Quaternion", "xyzw")
_AT = _object("foxglove.Pose", position=_XYZ, orientation=_TURN)
_RGBA = _numbers("foxglove.Color", "rgba")
_SOLID = {"pose": _AT, "size": _XYZ, "color": _RGBA}
_POINTS = {"points": _list(_numbers("foxglove.Point3", "xyz")), "color": _RGBA, "colors": _list(_RGBA)}
_ENTITY = _object(
    "foxglove.SceneEntity",
    timestamp=_TIME,
    frame_id=_TEXT,
    id=_TEXT,
    lifetime=_object("duration", sec=_WHOLE, nsec=_WHOLE),
    frame_locked=_FLAG,
    metadata=_list(_object("foxglove.KeyValuePair", key=_TEXT, value=_TEXT)),
    arrows=_list({"type": "object"}),
    cubes=_list(_object("foxglove.CubePrimitive", **_SOLID)),
    spheres=_list(_object("foxglove.SpherePrimitive", **_SOLID)),
    cylinders=_list(_object("foxglove.CylinderPrimitive", **_SOLID, bottom_scale=_NUMBER, top_scale=_NUMBER)),
    lines=_list(
        _object(
            "foxglove.LinePrimitive",
            **{"type": _WHOLE, "pose": _AT, "thickness": _NUMBER, "scale_invariant": _FLAG},
            **_POINTS,
            indices=_list(_WHOLE),
        )
    ),
    triangles=_list(_object("foxglove.TriangleListPrimitive", pose=_AT, **_POINTS, indices=_list(_WHOLE))),
    texts=_list({"type": "object"}),
    models=_list({"type": "object"}),
)
SCENE = _object(
    "foxglove.SceneUpdate",
    deletions=_list(_object("foxglove.SceneEntityDeletion", timestamp=_TIME, type=_WHOLE, id=_TEXT)),
    entities=_list(_ENTITY),
)
TRANSFORMS = _object(
    "foxglove.FrameTransforms",
    transforms=_list(
        _object(
            "foxglove.FrameTransform",
            timestamp=_TIME,
            parent_frame_id=_TEXT,
            child_frame_id=_TEXT,
            translation=_XYZ,
            rotation=_TURN,
        )
    ),
)
