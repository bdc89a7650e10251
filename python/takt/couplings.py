"""Who follows whom, from what the axes publish: so that a refused loop can be told with its members."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import TYPE_CHECKING

import yaml

if TYPE_CHECKING:
    from takt.axis import Axis

COUPLING_LOOP = 3018  # error number: the axis would follow itself


def masters_of(axis: Axis, axes: Mapping[str, Axis]) -> list[str]:
    """Names of the axes that an axis follows: from load on, or by a coupling in force."""
    names = list(axes)
    follows = axis.parameters.get("follows")
    from_load = [follows["axis"]] if follows else []
    return from_load + [names[number - 1] for number in (axis.master1, axis.master2) if number > 0]


def loop_sentence(target: str, arguments: str, axes: Mapping[str, Axis]) -> str:
    """Why this coupling was refused: "x would follow itself: x follows z, z follows y, y follows x". Empty where what
    closes the loop is not published (a coupling that still waits in a buffer)."""
    asked = yaml.safe_load(arguments) or {}
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
