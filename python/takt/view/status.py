"""The activity of a component and why it waits, in a few words: from its published values."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from takt.counted import counted
from takt.tables import KINDS, named

Values = Mapping[str, Any]
NamesOf = Callable[[str, int], str]  # kind, number from 1 -> name of the component

# Fields of every component that the page always shows.
LIVE: dict[str, tuple[str, ...]] = {
    "axis": ("actual_position", "set_velocity", "following_error", "set_position"),
    "flex_cam": (
        *("set_x_position", "set_y_position", "actual_slave_position", "set_x_velocity", "cam_table"),
        *("ip08_cam_table1", "ip09_cam_table2", "ip10_cam_table3", "ip11_cam_table4"),
        *("cam_number", "next_cam_table", "mp01_set_master_position", "mp02_set_slave_position"),
        *("set_scaling_slave",),
    ),
    "group": (
        *("x", "y", "z", "a", "b", "c", "path_velocity", "path_left"),
        *("trouble", "first_part", "second_part", "blocked_at"),
    ),
    "belt": ("position", "velocity"),
    "pose": ("pose_x", "pose_y", "pose_z", "pose_a", "pose_b", "pose_c"),
    "pick_place": ("position_x", "position_y", "position_z", "set_path_velocity", "held"),
    "mover": (
        *(
            "x",
            "y",
            "z",
            "a",
            "b",
            "c",
            "track_position",
            "track_velocity",
            "velocity_x",
            "velocity_y",
            "track",
            "waits_for",
        ),
        *("coordinate_system", "gap", "target_x", "target_y", "target_c"),
        *("on_route", "route_visit", "route_granted"),
        *("reserved_lower_x", "reserved_lower_y", "reserved_upper_x", "reserved_upper_y"),
    ),
    "track": ("length",),
    "part": ("x", "y", "coordinate_system"),
}

# Fields from which the texts are made: they are updated when one of these changes.
WORDS: dict[str, tuple[str, ...]] = {
    "axis": (
        *("state", "error", "active_command", "limited_by", "buffered_commands", "in_step", "synchronizing"),
        *("superimposed", "override_factor", "master1", "master2", "homed"),
    ),
    "flex_cam": (
        *("state", "error", "warning", "cam_table", "next_cam_table", "pending_changes", "acc_dec_sync"),
        *("internal_control_active", "cam_synchronised", "ip08_cam_table1", "ip09_cam_table2"),
        *("ip10_cam_table3", "ip11_cam_table4"),
    ),
    "group": (
        *("state", "error", "command", "buffered", "track_state", "interrupted", "checking", "override_factor"),
        *("reason", "problem", "trouble", "in_sync"),
    ),
    "belt": ("known", "object_count", "taken_count", "in_range_count", "lost_count"),
    "pose": ("fresh",),
    "pick_place": (
        *("state", "error", "warning", "target", "workpiece", "profiles", "path_hold", "off_path"),
        *("internal_control_active", "gripper_control_active", "picked", "placed", "missed"),
    ),
    "mover": (
        *("state", "command_mode", "error", "limited_by", "waits_for", "deadlocked", "delay", "delay_since"),
        *("buffered", "blocker", "track", "group", "in_sync", "part", "coordinate_system"),
    ),
    "track": ("state", "operation_mode", "error", "mover_count", "closed_loop"),
    "planar_group": ("state", "error", "mover_count", "track_count"),
    "environment": ("stator_count", "border_count"),
    "part": (
        "state",
        "error",
        "disable_forced",
        "position_index",
        "commanded_index",
        "coordinate_system",
        "mover_count",
    ),
}
TICKETS = {"axis": "active_command", "group": "command"}  # field with the ticket of the command in control


class Words(NamedTuple):
    state: str
    error: int
    more: str  # further details
    waits: str  # why it does not proceed; empty: it proceeds, or has nothing to do
    since: int  # cycle since which it waits; 0: unknown


def words(kind: str, values: Values, name_of: NamesOf) -> Words:
    more: list[str] = []
    waits: list[str] = []
    say = _SAY.get(kind)
    since = say(values, name_of, more, waits) if say else 0
    state = named(kind, "state", int(values["state"])) if "state" in KINDS[kind].names else ""
    return Words(str(state), int(values.get("error", 0)), ", ".join(more), ", ".join(waits), since)


def _plain(kind: str, field: str, value: Any) -> str:
    name = str(named(kind, field, int(value))).replace("_", " ")
    return re.sub("(?<=[a-z])(?=[A-Z])", " ", name).lower()


def _override(v: Values, more: list[str], waits: list[str]) -> None:
    factor = v["override_factor"]
    if factor == 0:
        waits.append("the override is 0")
    elif factor != 1 and factor == factor:
        more.append(f"override {100 * factor:.4g} %")


def _axis(v: Values, name_of: NamesOf, more: list[str], waits: list[str]) -> int:
    state = named("axis", "state", int(v["state"]))
    masters = [name_of("axis", int(v[m])) for m in ("master1", "master2") if v[m]]
    if masters:
        more.append(f"follows {' and '.join(masters)}")
    if v["limited_by"]:
        more.append(f"held back by its limit of {_plain('axis', 'limited_by', v['limited_by'])}")
    if v["superimposed"]:
        more.append("another motion on top")
    if v["buffered_commands"]:
        more.append(f"{counted(v['buffered_commands'], 'command')} behind it")
    if state not in ("Disabled", "Standstill", "ErrorStop"):
        _override(v, more, waits)
    if state == "SynchronizedMotion" and not v["in_step"]:
        waits.append("gets into step" if v["synchronizing"] else "waits to get into step")
    if state == "Standstill" and not v["homed"]:
        more.append("without a reference")
    return 0


def _flex_cam(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    if v["cam_table"]:
        more.append(f"cam {int(v['cam_table'])}")
    if v["next_cam_table"]:
        more.append(f"then cam {int(v['next_cam_table'])}")
    if v["pending_changes"]:
        waits.append(f"{counted(v['pending_changes'], 'change')} of cam at its end")
    if v["acc_dec_sync"]:
        waits.append("the clutch closes or opens")
    if v["internal_control_active"]:
        more.append("the slave is free")
    return 0


def _group(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    state = named("group", "state", int(v["state"]))
    track = named("group", "track_state", int(v["track_state"]))
    if track == "waiting":
        waits.append("waits for the object")
    elif track != "none":
        more.append(track.replace("_", " "))
    if v["interrupted"]:
        waits.append("interrupted on its path")
    if v["checking"]:
        waits.append("the next path is being checked")
    if state == "GroupMoving":
        _override(v, more, waits)
    if v["buffered"]:
        more.append(f"{counted(v['buffered'], 'move')} behind it")
    for field in ("reason", "problem", "trouble"):
        if v[field] and v["error"]:
            more.append(_plain("group", field, v[field]))
    return 0


def _belt(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    if not v["known"]:
        waits.append("its axis does not say where it is")
    more.append(counted(v["object_count"], "object"))
    for field, text in (("in_range_count", "in range"), ("taken_count", "taken"), ("lost_count", "lost")):
        if v[field]:
            more.append(f"{int(v[field])} {text}")
    return 0


def _pose(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    if not v["fresh"]:
        waits.append("nothing new has come")
    return 0


def _pick_place(v: Values, name_of: NamesOf, more: list[str], waits: list[str]) -> int:
    if v["workpiece"]:
        more.append(f"goes for workpiece {int(v['workpiece'])} on belt {int(v['target'])}")
    if v["profiles"]:
        more.append(counted(v["profiles"], "profile"))
    more += [f"{int(v[field])} {field}" for field in ("picked", "placed", "missed") if v[field]]
    if v["path_hold"]:
        waits.append("away from its path" if v["off_path"] else "rests on its path")
    if v["gripper_control_active"]:
        waits.append("the gripper")
    if v["internal_control_active"]:
        more.append("the group is free")
    return 0


def _mover(v: Values, name_of: NamesOf, more: list[str], waits: list[str]) -> int:
    more.append(_plain("mover", "command_mode", v["command_mode"]))
    if v["track"]:
        more[-1] = f"on {name_of('track', int(v['track']))}" if more[-1].endswith("on track") else more[-1]
    if v["limited_by"]:
        more.append(f"held back by its limit of {_plain('mover', 'limited_by', v['limited_by'])}")
    if v["buffered"]:
        more.append(f"{counted(v['buffered'], 'command')} behind it")
    delay = named("mover", "delay", int(v["delay"]))
    if delay == "mover" or v["waits_for"]:
        waits.append(f"waits for {name_of('mover', int(v['waits_for']))}")
        if v["deadlocked"]:
            waits.append("and that one for it: deadlocked")
        elif delay == "deadlock":
            waits.append("behind movers that wait for one another")
    elif delay != "none":
        words = {
            "track_end": "at the end of its track",
            "time": "stays for a time",
            "master": "waits for its master",
            "part": "waits for a part",
            "track": "waits until nothing moves on a track",
            "formation": "waits until it has left its formation",
            "place": f"waits for its next place, which {name_of('mover', int(v['blocker']))} visits before",
        }
        waits.append(words.get(delay, "waits to be released"))
    return int(v["delay_since"]) if waits else 0


def _track(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    more.append(_plain("track", "operation_mode", v["operation_mode"]))
    more.append(counted(v["mover_count"], "mover"))
    return 0


def _planar_group(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    more += [counted(v["mover_count"], "mover"), counted(v["track_count"], "track")]
    return 0


def _environment(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    more += [counted(v["stator_count"], "stator"), f"a border of {counted(v['border_count'], 'piece')}"]
    return 0


def _part(v: Values, _: NamesOf, more: list[str], waits: list[str]) -> int:
    more.append(counted(v["mover_count"], "mover"))
    if v["position_index"] != v["commanded_index"]:
        waits.append(f"on its way to position {int(v['commanded_index'])}")
    elif v["position_index"]:
        more.append(f"at position {int(v['position_index'])}")
    if v["disable_forced"]:
        waits.append("must not be enabled")
    return 0


_SAY: dict[str, Callable[[Values, NamesOf, list[str], list[str]], int]] = {
    "axis": _axis,
    "flex_cam": _flex_cam,
    "group": _group,
    "belt": _belt,
    "pose": _pose,
    "pick_place": _pick_place,
    "mover": _mover,
    "track": _track,
    "planar_group": _planar_group,
    "environment": _environment,
    "part": _part,
}


def name_in(names: Mapping[str, Sequence[str]]) -> NamesOf:
    """Returns a function that gives the name of a component by kind and number, as messages refer to it."""

    def name_of(kind: str, number: int) -> str:
        known = names.get(kind, ())
        return known[number - 1] if 0 < number <= len(known) else f"{kind} {number}"

    return name_of
