"""Checks whether the tool of a group follows a path."""

from __future__ import annotations

import numpy as np

from takt.checks.series import Check, beyond, decided, nearest
from takt.recording import Recording
from takt.toolpath import SLACK, Toolpath
from takt.verdict import Bound, Interval, Lane, Trace, Verdict, number


@decided
def follows_path(
    recording: Recording,
    group: str,
    path: Toolpath,
    within: float,
    *,
    actual: bool = False,
    window: Interval | None = None,
) -> Verdict:
    """Passes if a group follows all of a path, from its start to its end and in order, with a deviation of at most
    `within` [mm].

    path: in the machine coordinate system. actual: checks the actual pose instead of the set point. Raises ValueError
    unless 0 < within < SLACK."""
    if not 0 < within < SLACK:
        raise ValueError(f"follows_path: within is a number of mm above 0 and below {SLACK:g}, not {within}")
    check = Check("follows_path", recording, (group,), window)
    prefix = "actual_" if actual else ""
    columns = [check.series(group, prefix + axis) for axis in "xyz"]
    x = columns[0]
    beside = path.follow(np.stack([column.values for column in columns], axis=1), time_s=x.time_s)
    bound = Bound.level(f"at most {number(within, x.unit)}", within, x.span, "above")
    name = f"{'measured' if actual else 'commanded'} place beside the path"
    lane = Lane("deviation", x.unit, (Trace(f"{group}: {name}", x.time_s, beside.distance),), (bound,))
    largest = max(float(np.max(np.abs(column.values))) for column in columns)
    excess = beyond(beside.distance, within, max(largest, path.length))
    worst = int(np.argmax(beside.distance))
    far, when = float(beside.distance[worst]), float(x.time_s[worst])
    where = f"{number(float(beside.position[worst]), x.unit)} along the path"
    if excess[worst] > 0:
        first = int(np.argmax(excess > 0))
        text = f"the {name} was off by {number(far, x.unit)}, {where}, more than {number(within, x.unit)}"
        place = (float(x.time_s[first]), when) if first < worst else (when, when)
        return check.verdict(
            False, text, when_s=float(x.time_s[first]), by=far - within, unit=x.unit, place=place, lanes=[lane]
        )
    for what, at, wanted in (("began", beside.position[0], 0.0), ("ended", beside.position[-1], path.length)):
        if beyond(np.array([at - wanted]), within, path.length)[0] > 0:
            row = 0 if what == "began" else -1
            text = f"{what} {number(float(at), x.unit)} along the path, not at {number(wanted, x.unit)}"
            return check.verdict(
                False, text, when_s=float(x.time_s[row]), by=abs(float(at) - wanted), unit=x.unit, lanes=[lane]
            )
    text = f"the {name} was off by at most {number(far, x.unit)} over {number(path.length, x.unit)}, {where}"
    room = max(within - far, 0.0)
    text += f"; {nearest(room, x.unit, when)}"
    return check.verdict(True, text, when_s=when, by=room, unit=x.unit, lanes=[lane])
