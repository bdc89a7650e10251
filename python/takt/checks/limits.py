"""Checks whether a motion is within its limits, and whether it is continuous."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from takt.checks.measured import EPS, Measured, against, bounded, in_range, jerk_against, judge
from takt.checks.movers import of_mover
from takt.checks.series import Check, Mask, decided, sibling, sound, wrap
from takt.recording import FloatArray, Recording
from takt.verdict import Interval, Verdict


@dataclass(frozen=True)
class _Limits:
    position: tuple[float, float] | None
    velocity: float | None
    acceleration: float | None
    jerk: float | None


@decided
def within_limits(
    recording: Recording,
    component: str,
    *,
    position: Sequence[float] | None = None,
    velocity: float | None = None,
    acceleration: float | None = None,
    jerk: float | None = None,
    signal: str = "set_position",
    tolerance: float = 1e-9,
    jerk_tolerance: float = 1e-6,
    window: Interval | None = None,
) -> Verdict:
    """Passes if position, velocity, acceleration and jerk stay within limits.

    position: (lower, upper); the other limits are largest absolute values. None: the limit is taken from the
        component's `limits`; a limit that is not known there either, or is infinite, is not checked. For a planar
        mover, velocity, acceleration and jerk are the magnitudes of the vectors of X and Y, in the plane and on tracks;
        `lateral_acceleration` in curves of tracks, and Z, A, B and C, are checked against the mover's own limits. Jerk
        is not checked where set points come from outside. A jerk of 0 is unlimited.
    tolerance: relative to the limit, for rounding.
    jerk_tolerance: relative. Jerk is not recorded; it is the difference of two accelerations over the time between
        them, which is the mean jerk of that interval. If the jerk keeps its limit, so does its mean, also over lost
        samples, so sampling needs no allowance. The rounding of the subtracted numbers (accelerations and times) does:
        four units in the last place of the largest are added automatically. Jerk is not checked where the loop is open
        or opens: the set point is the measured value there.
    """
    sound("within_limits", tolerance=tolerance, jerk_tolerance=jerk_tolerance)
    check = Check("within_limits", recording, (component,), window)
    if signal == "set_position" and "xy" in (recording.info(component).get("limits") or {}):
        if position is not None:
            raise ValueError(f"within_limits: for positions of the mover {component} say which: signal='x'")
        given = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk}
        return of_mover(check, component, given, tolerance, jerk_tolerance)
    limits = _limits(recording, component, position, velocity, acceleration, jerk)
    found: list[Measured] = []
    if limits.position is not None:
        lower, upper = limits.position
        s = check.series(component, signal)
        if math.isfinite(lower) or math.isfinite(upper):
            found.append(in_range("position", s, lower, upper, tolerance))
    for what, limit in (("velocity", limits.velocity), ("acceleration", limits.acceleration)):
        if limit is not None:
            s = check.series(component, sibling(signal, what))
            found.append(against(what, s.unit, s.time_s, s.values, limit, tolerance * limit, s.label))
    if limits.jerk is not None:
        s = check.series(component, sibling(signal, "acceleration"))
        if len(s.values) > 1:
            own = _set_by_engine(check, component, signal)
            label = f"{component}.{sibling(signal, 'jerk')} (by differences)"
            found.append(
                jerk_against("jerk", s, np.where(own, np.diff(s.values), 0), limits.jerk, jerk_tolerance, label)
            )
    if not found and limits.jerk is not None:
        return check.verdict(
            False,
            f"the recording has a single sample of {component}, which shows no jerk",
            when_s=float(s.time_s[0]),
        )
    if not found:
        raise ValueError(f"within_limits: no finite limit is given, and the recording knows none of '{component}'")
    return judge(check, component, found, f"stayed within its {', '.join(m.says for m in found)}", "left")


@decided
def continuous(
    recording: Recording,
    component: str,
    *,
    step: float | None = None,
    velocity: float | None = None,
    acceleration: float | None = None,
    jerk: float | None = None,
    signal: str = "set_position",
    tolerance: float = 1e-6,
    slack: float = 1e-8,
    window: Interval | None = None,
) -> Verdict:
    """Passes if no step exceeds what the bounds allow in one sample.

    step: the largest change of the signal from one sample to the next; it is then the only check, for signals that are
        measured (with noise and quantisation). None: bounds follow from the limits, given or known of the component,
        over the time dt between two samples:

    - position changes by at most velocity * dt, and by the mean of its two velocities times dt, give or take
      jerk * dt³/12 (without a jerk limit: acceleration * dt²/4), the error of the trapezoidal rule;
    - velocity changes by at most acceleration * dt, and by the mean of its two accelerations times dt, give
      or take jerk * dt²/4;
    - acceleration changes by at most jerk * dt.

    So a jump of a micrometre is found in a set point, although the axis could have moved further in that time.
    Velocities and accelerations that were not recorded are not checked. While its loop is open an axis has no set point
    of its own (it equals the actual position), so a set point is checked only while the loop is closed.

    tolerance: relative to the bound.
    slack: added to the bound, in u, u/s and u/s²: the accuracy with which a planned move ends.
    """
    sound("continuous", step=step if step is not None else 0.0, tolerance=tolerance, slack=slack)
    check = Check("continuous", recording, (component,), window)
    p = check.series(component, signal)
    if len(p.values) < 2:
        return check.verdict(
            False,
            f"the recording has a single sample of {component}, which shows no steps",
            when_s=float(p.time_s[0]),
        )
    dt, time_s = np.diff(p.time_s), p.time_s[1:]
    step_p = wrap(np.diff(p.values), p.modulus)
    own = _set_by_engine(check, component, signal)
    if step is not None:
        found = [against("step of position", p.unit, time_s[own], step_p[own], step, tolerance * step, p.label)]
        return judge(check, component, found, "made no step", "went beyond")

    limits = _limits(recording, component, None, velocity, acceleration, jerk)
    v_max, a_max, j_max = limits.velocity, limits.acceleration, limits.jerk
    there = recording.fields(component)
    time_rounding = 4 * EPS * float(np.max(np.abs(p.time_s)))
    found = []

    def add(what: str, unit: str, change: FloatArray, bound: FloatArray, values: FloatArray, rate: float) -> None:
        margin = tolerance * bound + slack + 8 * EPS * float(np.max(np.abs(values))) + time_rounding * rate
        label = f"{component}: {what}"
        found.append(against(what, unit, time_s[own], change[own], bound[own], margin[own], label))

    rate_p = v_max if v_max is not None else 0.0
    if v_max is not None:
        add("step of position", p.unit, step_p, v_max * dt, p.values, rate_p)
    a: FloatArray | None = None
    if a_max is not None or j_max is not None:
        if (field_a := sibling(signal, "acceleration")) in there:
            a = check.series(component, field_a).values
        if (field_v := sibling(signal, "velocity")) in there:
            v = check.series(component, field_v)
            largest_v = float(np.max(np.abs(v.values)))
            apart = step_p - (v.values[1:] + v.values[:-1]) / 2 * dt
            bound = j_max * dt**3 / 12 if j_max is not None else (a_max or 0.0) * dt**2 / 4
            add("position apart from its velocity", p.unit, apart, bound, p.values, largest_v)
            step_v = np.diff(v.values)
            if a_max is not None:
                add("step of velocity", v.unit, step_v, a_max * dt, v.values, a_max)
            if a is not None and j_max is not None:
                apart = step_v - (a[1:] + a[:-1]) / 2 * dt
                add(
                    "velocity apart from its acceleration",
                    v.unit,
                    apart,
                    j_max * dt**2 / 4,
                    v.values,
                    float(np.max(np.abs(a))),
                )
    if a is not None and j_max is not None:
        unit_a = recording.unit(component, sibling(signal, "acceleration"))
        add("step of acceleration", unit_a, np.diff(a), j_max * dt, a, j_max)
    if not found:
        raise ValueError(f"continuous: no finite bound is given, and the recording knows no limits of '{component}'")
    return judge(check, component, found, "made no step", "went beyond", (p.lane(),))


def _set_by_engine(check: Check, component: str, signal: str) -> Mask:
    """Returns, for each pair of neighbouring samples, whether the engine chose the signal. All True if that is not
    recorded or the loop was never closed."""
    samples = len(check.series(component, signal).values)
    everywhere = np.ones(samples - 1, dtype=np.bool_)
    if not signal.startswith("set_") or "loop_closed" not in check.recording.fields(component):
        return everywhere
    closed = check.series(component, "loop_closed").values > 0
    both: Mask = closed[1:] & closed[:-1]
    return both if both.any() else everywhere


def _limits(
    recording: Recording,
    component: str,
    position: Sequence[float] | None,
    velocity: float | None,
    acceleration: float | None,
    jerk: float | None,
) -> _Limits:
    """Returns the given limits, else the component's own; None where infinite. A jerk of 0 means unlimited, as in
    commands. The larger of the component's acceleration and deceleration limits bounds the absolute value."""
    own: dict[str, Any] = dict(recording.info(component).get("limits") or {})
    if own.get("acceleration") is not None and own.get("deceleration") is not None:
        own["acceleration"] = max(own["acceleration"], own["deceleration"])
    rotary = recording.info(component).get("modulus") is not None
    if position is None and own.get("position") is not None and not rotary:
        position = own["position"]
    if position is not None and not (len(position) == 2 and position[0] <= position[1]):
        raise ValueError(f"position limits are (lower, upper), not {position!r}")

    def pick(name: str, given: float | None) -> float | None:
        return bounded(name, given if given is not None else own.get(name))

    return _Limits(
        (float(position[0]), float(position[1])) if position is not None else None,
        pick("velocity", velocity),
        pick("acceleration", acceleration),
        pick("jerk", jerk) or None,
    )
