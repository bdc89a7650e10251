"""Checks whether a planar mover is within its limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from takt.checks.measured import Measured, against, bounded, in_range, jerk_against, judge
from takt.checks.series import Check, Mask
from takt.recording import FloatArray
from takt.verdict import Verdict

ON_TRACK = ("OnTrack", "CRotationOnTrack")
CURVATURE = 1e-6  # relative: rounding of directions and curvatures
SAME = 1e-6  # mm/s: a speed that differs more from that along the track has set points from outside on top


def of_mover(
    check: Check, mover: str, given: Mapping[str, float | None], tolerance: float, jerk_tolerance: float
) -> Verdict:
    """Returns the verdict on X and Y together (magnitudes of the vectors), the lateral acceleration in curves, and each
    of Z, A, B and C by itself. `given` holds limits for X and Y that replace the mover's own; None: the mover's own."""
    own = check.recording.info(mover)["limits"]
    limits = dict(own["xy"])
    # For a mover that decelerates harder than it accelerates: one magnitude is compared with the larger limit.
    limits["acceleration"] = max(limits["acceleration"], limits.get("deceleration") or 0.0)
    limits |= {what: limit for what, limit in given.items() if limit is not None}
    in_plane = {what: limit for what in limits if (limit := bounded(what, limits[what])) is not None}
    if in_plane.get("jerk") == 0:  # unlimited, as in commands
        del in_plane["jerk"]
    found = _in_plane(check, mover, in_plane, tolerance, jerk_tolerance)
    found += _across(check, mover, own["lateral_acceleration"], max(tolerance, CURVATURE))
    says = ", ".join(one.says for one in found)
    others = []
    for name in "zabc":
        alone = _alone(check, mover, name, own[name], tolerance, jerk_tolerance)
        # A coordinate that never moves is not mentioned.
        if moves := [one for one in alone if one.broken.any() or np.ptp(one.values) > 0]:
            found += moves
            others.append(name.upper())
    says += f", those of {' and '.join(others)}" if others else ""
    if not found:
        raise ValueError(f"within_limits: no finite limit is given, and the mover {mover} is not in a curve of a track")
    return judge(check, mover, found, f"stayed within its {says}", "left")


def _in_plane(
    check: Check, mover: str, limits: Mapping[str, float], tolerance: float, jerk_tolerance: float
) -> list[Measured]:
    """Returns the magnitudes of the vectors of X and Y, on tracks, too. The part that set points from outside add on a
    track is not recorded separately: the acceleration there is the one along the track."""
    v, a = (_vector(check, mover, what) for what in ("velocity", "acceleration"))
    along = check.series(mover, "track_acceleration")
    added = _added(check, mover)
    push = np.where(added, np.abs(along.values), np.hypot(*a))
    speed = check.series(mover, "velocity_x")
    # Rounding of the direction and the curvature of a track.
    on_tracks = max(tolerance, CURVATURE)
    found = [
        against(what, s.unit, s.time_s, values, limits[what], margin * limits[what], f"{mover}: {what}")
        for what, s, values, margin in (
            ("velocity", speed, np.hypot(*v), tolerance),
            ("acceleration", along, push, on_tracks),
        )
        if what in limits
    ]
    if len(push) > 1 and "jerk" in limits:
        steps = np.hypot(*(np.diff(one) for one in a))
        steps[_pushed(_given(check, mover) | added)] = 0
        label = f"{mover}: jerk (by differences)"
        margin = max(jerk_tolerance, 10 * CURVATURE)
        found.append(jerk_against("jerk", replace(along, values=push), steps, limits["jerk"], margin, label))
    return found


def _across(check: Check, mover: str, limit: float, tolerance: float) -> list[Measured]:
    """Returns the acceleration across the direction of motion on tracks; empty if the mover never moves along one by
    itself."""
    (vx, vy), (ax, ay) = (_vector(check, mover, what) for what in ("velocity", "acceleration"))
    along = check.series(mover, "track_velocity")
    speed = np.hypot(vx, vy)
    curve = _modes(check, mover) & (speed > SAME) & (np.abs(speed - np.abs(along.values)) < SAME)
    if not curve.any():
        return []
    across = np.where(curve, (vx * ay - vy * ax) / np.maximum(speed, SAME), 0)
    unit = check.recording.unit(mover, "acceleration_x")
    what = "lateral acceleration"
    return [against(what, unit, along.time_s, across, limit, tolerance * limit, f"{mover}: {what}")]


def _alone(
    check: Check, mover: str, name: str, own: Mapping[str, Any], tolerance: float, jerk_tolerance: float
) -> list[Measured]:
    """Returns one coordinate compared with its limits. The range of C holds only while X and Y move, and exists four
    times: it is not checked."""
    p, v, a = (check.series(mover, field) for field in (name, f"velocity_{name}", f"acceleration_{name}"))
    most, big = own["maximum"], name.upper()
    found = [
        against(f"{what} of {big}", s.unit, s.time_s, s.values, most[what], tolerance * most[what], s.label)
        for what, s in (("velocity", v), ("acceleration", a))
    ]
    if len(a.values) > 1:
        steps = np.where(_pushed(_given(check, mover)), 0, np.diff(a.values))
        label = f"{mover}.jerk_{name} (by differences)"
        found.append(jerk_against(f"jerk of {big}", a, steps, most["jerk"], jerk_tolerance, label))
    if name != "c":
        found.append(in_range(f"position of {big}", p, own["lower"], own["upper"], tolerance))
    return found


def _vector(check: Check, mover: str, what: str) -> tuple[FloatArray, FloatArray]:
    x, y = (check.series(mover, f"{what}_{axis}").values for axis in "xy")
    return x, y


def _modes(check: Check, mover: str) -> Mask:
    """Returns where the mover moves along a track."""
    mode = check.series(mover, "command_mode").values
    codes = [code for code, name in check.recording.names(mover, "command_mode").items() if name in ON_TRACK]
    return np.isin(mode, codes)


def _given(check: Check, mover: str) -> Mask:
    """Returns where set points come from outside."""
    return np.asarray(check.series(mover, "external").values > 0)


def _added(check: Check, mover: str) -> Mask:
    """Returns where set points from outside add to a motion on a track: while they come, and after their end until the
    mover is back on the track and at rest, also if they ended before the window. The added motion and the motion along
    the track each keep the limits separately."""
    table = check.recording[mover]
    given = np.asarray(table["external"] > 0)
    rests = ~given & (np.asarray(table["busy_xyc"]) == 0)
    count = np.arange(len(given))
    last_given, last_rest = (np.maximum.accumulate(np.where(one, count, -1)) for one in (given, rests))
    cycles = check.series(mover, "external").cycle
    behind = np.asarray(last_given > last_rest)[np.isin(table["cycle"], cycles)]
    return np.asarray(_modes(check, mover) & behind)


def _pushed(given: Mask) -> Mask:
    """Returns, for each pair of neighbouring samples, whether set points come from outside: their jerk is not
    checked."""
    return given[1:] | given[:-1]
