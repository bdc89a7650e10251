"""Couplings between axes, from their published values: to explain a refused coupling with the names involved."""

from __future__ import annotations

import difflib
import itertools
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from takt.yaml_text import texts_of

if TYPE_CHECKING:
    from takt.axis import Axis

COUPLING_LOOP = 3018  # error numbers: the axis would follow itself ...
UNKNOWN_TARGET = 3010  # ... there is no such component, or no such cam
COORDINATES = ("", ".x", ".y", ".c")  # of a mover, that axes can follow; "": its distance along tracks


def why_refused(
    error_id: int,
    target: str,
    arguments: str,
    axes: Mapping[str, Axis],
    movers: Collection[str] = (),
    cams: Collection[str] = (),
) -> str:
    """Returns why a command was refused, with the names involved; empty if there is nothing to add."""
    if error_id == COUPLING_LOOP:
        return loop_sentence(target, arguments, axes)
    if error_id != UNKNOWN_TARGET:
        return ""
    other = unknown_sentence(arguments, axes, movers) if target in axes else ""
    return other or unknown_cam_sentence(arguments, cams)


def unknown_sentence(arguments: str, axes: Mapping[str, Axis], movers: Collection[str]) -> str:
    """Returns a sentence about a master or list of cam switches among the arguments that does not exist; empty: all
    exist."""
    asked = texts_of(arguments)
    coordinates = [name + suffix for name in movers for suffix in COORDINATES]
    for key in ("master", "master1", "master2"):
        if not asked.get(key) or asked[key] in axes or asked[key] in coordinates:
            continue
        near = difflib.get_close_matches(asked[key], coordinates, 1) or coordinates[1:2]
        others = f", and movers with their coordinates, such as {near[0]}" if near else ""
        return f"{key}: there is no axis '{asked[key]}'; there are {', '.join(axes)}{others}"
    if asked.get("switches"):
        return f"switches: the machine has no list of cam switches '{asked['switches']}'"
    return ""


def unknown_cam_sentence(arguments: str, cams: Collection[str]) -> str:
    """Returns a sentence about a cam among the arguments, with the known names `cams`; empty: there is none."""
    asked = texts_of(arguments)
    for key in ("cam", "profile"):
        if asked.get(key):
            near = difflib.get_close_matches(asked[key], cams, 1)
            has = f" (it has {', '.join(cams)})" if 0 < len(cams) <= 10 else ""
            hint = f"; did you mean {near[0]}?" if near else ""
            return f"{key}: the machine has no cam '{asked[key]}'{has}{hint}"
    return ""


def masters_of(axis: Axis, axes: Mapping[str, Axis]) -> list[str]:
    """Returns the names of the axes that an axis follows, by the machine file or by a coupling in force."""
    names = list(axes)
    follows = axis.parameters.get("follows")
    from_load = [follows["axis"]] if follows else []
    # Larger numbers are other masters, which follow no axis.
    return from_load + [names[number - 1] for number in (axis.master1, axis.master2) if 0 < number <= len(names)]


def loop_sentence(target: str, arguments: str, axes: Mapping[str, Axis]) -> str:
    """Returns why a coupling was refused: "x would follow itself: x follows z, z follows y, y follows x". Empty if the
    coupling that closes the loop is not published (it still waits in a buffer)."""
    asked = texts_of(arguments)
    wanted = [asked[key] for key in ("master", "master1", "master2") if asked.get(key) in axes]
    chain = _chain(wanted, target, axes, [target])
    if not chain:
        return ""
    steps = ", ".join(f"{one} follows {other}" for one, other in itertools.pairwise(chain))
    return f"{target} would follow itself: {steps}"


def _chain(masters: list[str], goal: str, axes: Mapping[str, Axis], way: list[str]) -> list[str]:
    for name in masters:
        if name == goal:
            return [*way, name]
        if name not in way:
            chain = _chain(masters_of(axes[name], axes), goal, axes, [*way, name])
            if chain:
                return chain
    return []
