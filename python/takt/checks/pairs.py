"""Checks whether two components keep in step, or at a distance."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from takt.checks.series import LAST_PLACES, Check, Series, beyond, decided, extent, nearest, sound, unwrapped, wrap
from takt.recording import Recording
from takt.verdict import Bound, Interval, Lane, Trace, Verdict, number, seconds


@decided
def in_sync(
    recording: Recording,
    master: str,
    slave: str,
    *,
    ratio: float = 1.0,
    offset: float | None = 0.0,
    tolerance: float,
    signal: str = "set_position",
    master_signal: str | None = None,
    window: Interval | None = None,
) -> Verdict:
    """Passes if slave = ratio · master + offset within `tolerance`, at every cycle that both have.

    On rotary axes turns do not count: the master is followed over its turns, starting from the first value of the
    window, and the error is wrapped to at most half the slave's modulus. offset=None takes the offset from the first
    sample, so that only staying in step is checked. `signal` is the slave's, and the master's too unless
    `master_signal` is given.
    """
    sound("in_sync", ratio=ratio, offset=offset or 0.0, tolerance=tolerance)
    check = Check("in_sync", recording, (master, slave), window)
    m = check.series(master, master_signal or signal)
    s = check.series(slave, signal)
    m, s = check.together(m, s)
    led = ratio * unwrapped(m)
    shift = float(s.values[0] - led[0]) if offset is None else offset
    error = wrap(s.values - (led + shift), s.modulus)
    largest = max(float(np.max(np.abs(values))) for values in (s.values, led))
    excess = beyond(error, tolerance, largest)
    lanes = [
        Lane(
            "synchronisation error",
            s.unit,
            (Trace(f"{slave} - ({ratio:g} · {master} + {shift:g})", s.time_s, error),),
            (
                Bound.level(f"±{number(tolerance, s.unit)}", tolerance, s.span, "above"),
                Bound.level("", -tolerance, s.span, "below"),
            ),
        ),
        s.lane(),
        m.lane(),
    ]
    worst = int(np.argmax(excess))
    at, off = float(s.time_s[worst]), float(error[worst])
    if excess[worst] <= 0:
        room = abs(float(excess[worst]))
        kept = f"{slave} kept in step with {master} within {number(tolerance, s.unit)}"
        text = f"{kept}; {nearest(room, s.unit, at)}"
        return check.verdict(True, text, when_s=at, by=room, unit=s.unit, lanes=lanes)
    place, where = extent(s.time_s, excess > 0)
    text = (
        f"{slave} was out of step with {master} by {number(off, s.unit)} at {seconds(at)}, "
        f"{number(float(excess[worst]), s.unit)} more than the tolerance of {number(tolerance, s.unit)} "
        f"({where})"
    )
    return check.verdict(False, text, when_s=place[0], by=float(excess[worst]), unit=s.unit, place=place, lanes=lanes)


@decided
def keeps_distance(
    recording: Recording,
    a: str,
    b: str,
    minimum: float,
    *,
    signal: str | Sequence[str] = "actual_position",
    modulus: float | None = None,
    tolerance: float = 1e-9,
    window: Interval | None = None,
) -> Verdict:
    """Passes if the distance of two components never falls below `minimum`.

    `signal` is one position along a common track, or several ("x", "y") for the straight-line distance of points. On a
    closed track of length `modulus` (None: known if both components have the same) the shorter way round counts.
    tolerance: relative, for rounding.
    """
    sound("keeps_distance", minimum=minimum, tolerance=tolerance)
    if modulus is not None and not 0 < modulus < math.inf:
        raise ValueError(f"keeps_distance: modulus is {modulus}, not a length above 0")
    check = Check("keeps_distance", recording, (a, b), window)
    fields = [signal] if isinstance(signal, str) else list(signal)
    squares: list[np.ndarray[tuple[int], np.dtype[np.float64]]] = []
    pairs: list[tuple[Series, Series]] = []
    for field in fields:
        pair = check.together(check.series(a, field), check.series(b, field))
        pairs.append(pair)
        around = modulus
        if around is None and len(fields) == 1 and pair[0].modulus == pair[1].modulus:
            around = pair[0].modulus
        squares.append(wrap(pair[1].values - pair[0].values, around) ** 2)
    first = pairs[0][0]
    distance = np.sqrt(np.sum(squares, axis=0))
    excess = minimum - distance
    largest = max(float(np.max(np.abs(one.values))) for pair in pairs for one in pair)
    allowed = tolerance * abs(minimum) + LAST_PLACES * largest
    bound = Bound.level(f"minimum {number(minimum, first.unit)}", minimum, first.span, "below")
    lanes = [
        Lane("distance", first.unit, (Trace(f"{a} to {b}", first.time_s, distance),), (bound,)),
        *(Lane(p.lane().quantity, p.unit, (p.trace(), q.trace())) for p, q in pairs),
    ]
    worst = int(np.argmax(excess))
    at = float(first.time_s[worst])
    amount = float(excess[worst])
    if amount <= allowed:
        room = max(-amount, 0.0)
        kept = f"{a} and {b} kept their distance of {number(minimum, first.unit)}"
        text = f"{kept}; {nearest(room, first.unit, at)}"
        return check.verdict(True, text, when_s=at, by=room, unit=first.unit, lanes=lanes)
    place, where = extent(first.time_s, excess > allowed)
    text = (
        f"{a} and {b} came within {number(float(distance[worst]), first.unit)} at {seconds(at)}, "
        f"{number(amount, first.unit)} less than the minimum of {number(minimum, first.unit)} ({where})"
    )
    return check.verdict(False, text, when_s=place[0], by=amount, unit=first.unit, place=place, lanes=lanes)
