"""Small machines for what must hold of every kind of component: one with as little as each kind needs, and one with all
kinds that says all it can."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator, Mapping
from typing import Any

Machine = dict[str, Any]


def _axes(*names: str, **more: Any) -> list[dict[str, Any]]:
    limits = {"velocity": 400, "acceleration": 4000, "jerk": 80000}
    return [{"name": name, "limits": dict(limits), **more} for name in names]


_CAM = {"name": "lift", "segments": [{"to": {"x": 120, "y": 15}}, {"to": {"x": 360, "y": 0}}]}
_PATH = {"velocity": 300, "acceleration": 3000, "jerk": 60000}
_PORTAL = {"name": "portal", "axes": ["x", "y"], "path": _PATH}
_ARM = {"name": "arm", "axes": ["x", "y", "z"], "kinematics": {"gantry": {"axes": ["x", "y", "z"]}}, "path": _PATH}
_OTHER = {**_ARM, "name": "other", "axes": ["u", "v", "w"]}
_ZONE = {"name": "middle", "lower": {"x": 100, "y": -50, "z": -50}, "upper": {"x": 200, "y": 50, "z": 50}}
_BELT = {"name": "belt", "axis": "feed"}
_TRACK = {"name": "line", "elements": [{"from": {"x": 0, "y": 0}, "to": {"x": 900, "y": 0}}]}
_FIELDS = [{"x": 240 * i, "y": 240 * k} for i in range(4) for k in range(3)]

_QUARTER = {"from": {"x": 760, "y": 150}, "to": {"x": 880, "y": 270}, "center": {"x": 760, "y": 270}}

# What each kind needs, and nothing else: all that is optional is left out.
MINIMAL: dict[str, Machine] = {
    "axis": {"axes": _axes("x")},
    "flex_cam without a master": {
        "axes": _axes("x"),
        "cams": [_CAM],
        "flex_cams": [{"name": "module", "slave": "x", "cams": ["lift"]}],
    },
    "flex_cam": {
        "axes": _axes("x", "y"),
        "cams": [_CAM],
        "flex_cams": [{"name": "module", "slave": "x", "master": "y", "cams": ["lift"]}],
    },
    "group without kinematics": {"axes": _axes("x", "y"), "groups": [_PORTAL]},
    "group": {"axes": _axes("x", "y", "z"), "groups": [_ARM]},
    "groups with a zone": {"axes": _axes(*"xyzuvw"), "groups": [_ARM, _OTHER], "zones": [_ZONE]},
    "belt": {"axes": _axes("feed"), "belts": [_BELT]},
    "turning belt": {"axes": _axes("feed", unit="deg"), "belts": [{**_BELT, "kind": "turning"}]},
    "pose": {"axes": [], "poses": [{"name": "camera"}]},
    "pick_place": {
        "axes": _axes("x", "y", "z", "feed"),
        "groups": [_ARM],
        "belts": [_BELT],
        "pick_and_place": [{"name": "picker", "group": "arm"}],
    },
    "mover": {"axes": [], "movers": [{"name": "shuttle"}]},
    "track": {"axes": [], "tracks": [{"name": "line"}]},
    "track with a line": {"axes": [], "tracks": [_TRACK]},
    "planar_group": {"axes": [], "planar_groups": [{"name": "cell"}]},
    "environment": {"axes": [], "environments": [{"name": "floor"}]},
    "part": {
        "axes": [],
        "coordinate_systems": [{"name": "hall"}],
        "parts": [{"name": "table", "positions": [{"coordinate_system": "hall"}]}],
    },
}

# All kinds at once, and most of what they can be given.
FULL: Machine = {
    "cycle": {"period_s": 0.002, "overruns_in_a_row": 5},
    "lcm": {"axis_rate_hz": 250, "rates": [{"axis": "feed", "rate_hz": 500}], "engine_rate_hz": 20, "dead_man_s": 0.4},
    "axes": [
        *_axes("x", "y", "z", homing={"method": "direct"}, supervision={"deviation_moving": 3, "in_position": 0.05}),
        *_axes("feed", encoder={"increments_per_unit": 500}),
        {
            "name": "table",
            "unit": "deg",
            "kind": "rotary",
            "modulus": 180,
            "limits": {"velocity": 300, "acceleration": 3000, "deceleration": 2500, "jerk": 50000},
        },
        {
            "name": "knife",
            "unit": "cm",
            "limits": {"velocity": 30, "acceleration": 500, "jerk": 9000, "lower": -1, "upper": 40},
        },
    ],
    "cams": [{**_CAM, "x_unit": "mm", "y_unit": "cm", "cyclic": True}],
    "cam_switches": [
        {
            "name": "valves",
            "modulus": 90,
            "tracks": [{"track": 1}],
            "switches": [{"track": 1, "first_on_position": 10, "last_on_position": 40}],
        }
    ],
    "flex_cams": [
        {
            "name": "module",
            "slave": "knife",
            "master": "feed",
            "source": "actual_value",
            "cams": ["lift"],
            "settings": {"stop_deceleration": 400},
            "homing": {"method": "direct"},
        }
    ],
    "groups": [
        {
            **_ARM,
            "path": {**_PATH, "deceleration": 2500},
            "tool_limits": {"velocity": 250},
            "tracking": {"tolerance": 0.5, "zones_ahead_s": 0.2},
            "base": {"z": 100},
            "tool": {"z": -20},
            "workspace": {"bounds": {"lower": {"z": -500}}},
        }
    ],
    "zones": [{**_ZONE, "margin": 8}],
    "paths": [{"name": "round", "elements": [{"shape": "line", "to": {"x": 10, "y": 5, "z": 0}}]}],
    "belts": [
        {
            **_BELT,
            "source": "actual_value",
            "ratio": 2,
            "origin": {"x": -200, "c": 30},
            "lower_limit": 100,
            "upper_limit": 400,
            "filter_s": 0.004,
            "dead_time_s": 0.001,
            "forget_after": 600,
        },
        {"name": "turntable", "kind": "turning", "axis": "table"},
    ],
    "poses": [{"name": "camera", "goes_on_s": 0.2}],
    "pick_and_place": [
        {
            "name": "picker",
            "group": "arm",
            "belts": [{"belt": "belt", "settings": {"park_z": 50}}],
            "settings": {"path_stop_deceleration": 2000},
        }
    ],
    "coordinate_systems": [{"name": "hall"}],
    "parts": [
        {
            "name": "deck",
            "columns": 5,
            "rows": 3,
            "positions": [{"coordinate_system": "hall", "x": 240, "y": 0}],
            "initial_position": 1,
            "travel_time_s": 1,
        }
    ],
    "movers": [
        {
            "name": "shuttle",
            "width": 110,
            "height": 100,
            "initial": {"x": 500, "y": 400},
            "reference": "deck",
            "xy": {"maximum": {"velocity": 1000, "acceleration": 5000, "jerk": 90000}},
            "z": {"maximum": {"velocity": 50, "acceleration": 500, "jerk": 9000}, "lower": 0, "upper": 4},
            "c_modulus": 180,
            "gap": 220,
            "deviation": 2,
        }
    ],
    "tracks": [
        {
            **_TRACK,
            "part": "deck",
            "elements": [
                {"shape": "position", "to": {"x": 130, "y": 130}},
                {"shape": "line", "from": {"x": 400, "y": 130}, "to": {"x": 700, "y": 130}},
                {"shape": "circle", **_QUARTER},
            ],
            "mover_width": 120,
        }
    ],
    "planar_groups": [{"name": "cell", "movers": ["shuttle"], "tracks": ["line"]}],
    "environments": [{"name": "floor", "stators": _FIELDS}],
    "simulation": {"servos": [{"axis": "x", "mechanics": {"start_position": 3}}]},
    "view": {"commands": True},
}


def text_of(machine: Mapping[str, Any]) -> str:
    """As a machine file."""
    return json.dumps({"name": "small", **machine}, indent=1) + "\n"


def left_out(machine: Mapping[str, Any]) -> Iterator[tuple[str, Machine]]:
    """The machine without each of its keys and elements of its lists in turn, and where that was. Not all of them are
    machines still."""
    for path in _places(machine):
        other = copy.deepcopy(dict(machine))
        holder: Any = other
        for key in path[:-1]:
            holder = holder[key]
        del holder[path[-1]]
        yield ".".join(map(str, path)), other


def _places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    inside = value.items() if isinstance(value, Mapping) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in inside:
        yield (*path, key)
        yield from _places(inner, (*path, key))
