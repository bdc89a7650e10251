"""Step responses of position loops and their characteristic values.

A step is a short move at the axis' limits: nearly a step for the loop, and within the limits like any other move.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from takt.axis import Axis
from takt.errors import CommandError, TaktError
from takt.session import Session

if TYPE_CHECKING:
    from numpy.typing import NDArray

SETTLED = 0.02  # share of the step, peak to peak
LEAD_S = 0.02  # s of recording before a step, for the initial position
SLICES = 50  # per watch time; after each, the axis is checked for rest
STILL = 15  # slices without motion that count as rest
LONGEST = 6  # watch times after which a step without rest is given up
STANDS_STILL_TOO_SOON = 3  # error number: not inside the in-position window in time


@dataclass(frozen=True)
class StepResponse:
    """The response of a loop to a step. Times in [s] from the beginning of the step; NaN: never."""

    time_s: NDArray[np.float64]
    response: NDArray[np.float64]  # share of the step: the set point moves from 0 to 1
    overshoot: float  # % of the step, beyond the final position of the loop
    rise_s: float  # from 10 % to 90 %
    settling_s: float  # until it stays within 2 %, peak to peak, around its end; NaN if it does not rise
    rest: float  # share of the step that is missing at the end
    turns: int  # turning points larger than that band
    hum: int = 0  # smaller turning points in the second half, in which it should be at rest
    error: int = 0  # fault of the axis; 0: none

    @property
    def text(self) -> str:
        rise, settling = (f"{1000 * t:.1f} ms" if t == t else "never" for t in (self.rise_s, self.settling_s))
        figures = f"overshoot {self.overshoot:.1f} %, rise {rise}, settling {settling}, left {100 * self.rest:.1f} %"
        return f"ran away (error {self.error})" if self.error else figures


def analyse(
    time_s: NDArray[np.float64],
    response: NDArray[np.float64],
    *,
    start: float = 0.0,
    bias: float = 0.0,
    grain: float = SETTLED,
    error: int = 0,
) -> StepResponse:
    """Returns the step response with its characteristic values. All arguments in shares of the step.

    start: position of the axis before the step.
    bias: offset of the final position beyond the set point (as by a load); counts as `rest`, not as overshoot.
    grain: smaller turning points do not count as hum.
    error: fault of the axis; 0: none.
    """
    travelled = (response - start) / (1 + bias - start)
    last = max(1, len(response) // 20)
    end = float(np.mean(travelled[-last:]))

    def passes(level: float) -> float:
        above = np.flatnonzero(travelled >= level)
        if not len(above):
            return float("nan")
        i = max(int(above[0]), 1)
        share = (level - travelled[i - 1]) / (travelled[i] - travelled[i - 1])
        return float(time_s[i - 1] + share * (time_s[i] - time_s[i - 1]))

    rise = passes(0.9) - passes(0.1)
    outside = np.flatnonzero(np.abs(travelled - end) > SETTLED / 2)
    settled = 0 if not len(outside) else int(outside[-1]) + 1
    comes_to_rest = rise == rise and settled < len(response) - last and not error
    return StepResponse(
        time_s,
        response,
        overshoot=max(0.0, 100 * (float(np.max(travelled)) - 1)),
        rise_s=rise,
        settling_s=float(time_s[settled]) if comes_to_rest else float("nan"),
        rest=1 - float(np.mean(response[-last:])),
        turns=_turning_points(travelled, SETTLED),
        hum=_turning_points(travelled[len(response) // 2 :], grain),
        error=error,
    )


def _turning_points(response: NDArray[np.float64], band: float) -> int:
    """Returns the number of reversals by more than the band."""
    turns, sense, extreme = 0, 1, float(response[0])
    for value in response.tolist():
        if sense * (value - extreme) > 0:
            extreme = value
        elif sense * (extreme - value) > band:
            turns, sense, extreme = turns + 1, -sense, value
    return turns


def step_response(session: Session, axis: Axis, distance: float, watch_s: float = 0.5) -> StepResponse:
    """Makes a step of `distance` [u] and back, and returns the response of the first. Each step is watched until the
    axis is at rest: at least `watch_s` [s], at most six times that. Raises TaktError if the axis does not complete the
    step."""
    if not math.isfinite(distance) or distance == 0:
        raise TaktError(f"{axis.name}: a step has a length; {distance:g} {axis.unit} is none")
    there, _ = there_and_back(session, axis, distance, watch_s)
    if axis.error:
        raise TaktError(f"{axis.name}: the step ended in error {axis.error}")
    return there


def there_and_back(
    session: Session, axis: Axis, distance: float, watch_s: float, noise: float = 0.0
) -> tuple[StepResponse, StepResponse]:
    """Returns the responses of a step and of the step back; after a fault of the axis, twice the one with the fault.
    `noise`: of the measured position, peak to peak [u]."""
    grain = max(SETTLED / 2, 2 * noise / abs(distance))  # smaller oscillations are encoder and converter noise
    tolerance = max(abs(distance) * SETTLED / 8, noise)
    there = _one_way(session, axis, distance, watch_s, tolerance)
    if there.error:
        only = there.figures(0.0, grain)
        return only, only
    back = _one_way(session, axis, -distance, watch_s, tolerance)
    if back.error:
        only = back.figures(0.0, grain)
        return only, only
    # An offset to the same side in both directions is a bias; one beyond the target in both directions is overshoot.
    bias = (there.beyond - back.beyond) / 2
    return there.figures(bias, grain), back.figures(-bias, grain)


@dataclass(frozen=True)
class _OneWay:
    time_s: NDArray[np.float64]
    response: NDArray[np.float64]
    start: float
    error: int

    @property
    def beyond(self) -> float:
        return float(np.mean(self.response[-max(1, len(self.response) // 20) :])) - 1

    def figures(self, bias: float, grain: float) -> StepResponse:
        # With a bias near a whole step the response would be meaningless.
        bias = min(max(bias, self.start - 0.9), self.start + 0.9)
        return analyse(self.time_s, self.response, start=self.start, bias=bias, grain=grain, error=self.error)


def _one_way(session: Session, axis: Axis, distance: float, watch_s: float, tolerance: float) -> _OneWay:
    origin = axis.set_position
    with session.record(axis.name) as recorder:
        session.run(LEAD_S)
        step = axis.move_relative(distance=distance)
        try:
            step.wait(until="active")
        except CommandError:
            if not axis.error and step.error_id != STANDS_STILL_TOO_SOON:
                raise
        session.run(step.travel_time_s)
        come_to_rest(session, axis, watch_s, tolerance)
        error = axis.error
    samples = recorder.recording[axis.name]
    moved = np.flatnonzero(samples["set_position"] != samples["set_position"][0])
    first = max(int(moved[0]) - 1, 0) if len(moved) else 0  # the last sample before the step
    share = np.asarray(relative(axis, samples["actual_position"] - origin) / distance)
    time_s = np.asarray(samples["time_s"][first:] - samples["time_s"][first])
    return _OneWay(time_s, share[first:], float(np.mean(share[: first + 1])), error)


def come_to_rest(session: Session, axis: Axis, watch_s: float, tolerance: float) -> None:
    """Lets engine time pass until the axis is at rest within `tolerance` [u] or has a fault, at most LONGEST times
    `watch_s` [s]."""
    errors: deque[float] = deque(maxlen=STILL)
    for i in range(1, LONGEST * SLICES + 1):
        session.run(max(watch_s / SLICES, session.period))
        errors.append(axis.following_error)
        if axis.error or (i >= SLICES and max(errors) - min(errors) <= tolerance):
            return


def relative(axis: Axis, difference: Any) -> Any:
    """Returns a difference of positions; of a rotary axis, the shorter one around the turn."""
    if not axis.rotary:
        return difference
    turn = axis.parameters["modulus"]
    return (difference + turn / 2) % turn - turn / 2
