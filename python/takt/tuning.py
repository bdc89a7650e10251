"""Step responses, and the tuning of position loops by the procedure of the GT-775x manual (its chapter 5.5): Kd is
doubled until the axis rings and then found by halving, Kp likewise until it overshoots, then Ki takes away what is left
at rest.

A step is a small move at all that the axis' limits allow, as in the manual: nearly a step for the loop, and within the
limits like any other move. Feed-forward is off meanwhile, so that the loop alone answers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from takt.axis import Axis
from takt.errors import TaktError
from takt.session import Session

if TYPE_CHECKING:
    from numpy.typing import NDArray

CRITICAL = 1.0  # % of overshoot that still counts as critically damped
SETTLED = 0.02  # share of the step, peak to peak
RINGS = 3  # turning points of that size after the arrival
GAINS = ("kp", "ki", "kd")
HALVINGS = 5
MOST_STEPS = 14  # doublings


@dataclass(frozen=True)
class StepResponse:
    """What a loop makes of a step. Times in s from the beginning of the step; NaN: never."""

    time_s: NDArray[np.float64]
    response: NDArray[np.float64]  # share of the step, from 0 to 1
    overshoot: float  # % of the step
    rise_s: float  # from 10 % to 90 %
    settling_s: float  # until it stays within 2 % of where it ends, peak to peak
    rest: float  # share of the step that is missing at the end
    turns: int  # turning points that are larger than that band

    @property
    def text(self) -> str:
        rise, settling = (f"{1000 * t:.1f} ms" if t == t else "never" for t in (self.rise_s, self.settling_s))
        return f"overshoot {self.overshoot:.1f} %, rise {rise}, settling {settling}, left {100 * self.rest:.1f} %"


@dataclass(frozen=True)
class Tuning:
    """The outcome of `tune`."""

    axis: str
    gains: Mapping[str, float]  # kp, ki, kd
    before: StepResponse
    after: StepResponse
    steps: int  # that were tried

    @property
    def yaml(self) -> str:
        """The line for the machine file."""
        return "loop: {" + ", ".join(f"{name}: {value:.6g}" for name, value in self.gains.items()) + "}"


def analyse(time_s: NDArray[np.float64], response: NDArray[np.float64]) -> StepResponse:
    """Figures of a response that goes from 0 to 1."""
    end = float(np.mean(response[-max(1, len(response) // 20) :]))
    overshoot = max(0.0, 100 * (float(np.max(response)) - max(1.0, end)))

    def passes(level: float) -> float:
        above = np.flatnonzero(response >= level)
        return float(time_s[above[0]]) if len(above) else float("nan")

    outside = np.flatnonzero(np.abs(response - end) > SETTLED / 2)
    settled = 0 if not len(outside) else int(outside[-1]) + 1
    settling = float(time_s[settled]) if settled < len(time_s) * 0.95 else float("nan")
    return StepResponse(
        time_s, response, overshoot, passes(0.9) - passes(0.1), settling, 1 - end, _turning_points(response)
    )


def _turning_points(response: NDArray[np.float64]) -> int:
    """How often it turns round by more than the band."""
    turns, sense, extreme = 0, 1, float(response[0])
    for value in response:
        if sense * (value - extreme) > 0:
            extreme = float(value)
        elif sense * (extreme - value) > SETTLED:
            turns, sense, extreme = turns + 1, -sense, float(value)
    return turns


def step_response(session: Session, axis: Axis, distance: float, watch_s: float = 0.5) -> StepResponse:
    """Makes a step of `distance` and back, and looks at the way there for `watch_s`."""
    start, origin = axis.actual_position, axis.set_position
    recorder = session.record(axis.name)
    begin = session.now
    axis.move_relative(distance=distance)
    session.run(watch_s)
    recording = recorder.stop()
    if axis.error:
        raise TaktError(f"{axis.name}: the step ended in error {axis.error}")
    samples = recording[axis.name]
    moved = samples["actual_position"] - start
    whole = distance + (origin - start)
    if axis.rotary:
        turn = axis.parameters["modulus"]
        moved = (moved + turn / 2) % turn - turn / 2
    axis.move_relative(distance=-distance)
    session.run(watch_s)
    return analyse(np.asarray(samples["time_s"]) - begin, np.asarray(moved / whole))


def tune(
    session: Session,
    axis: Axis,
    distance: float,
    watch_s: float = 0.5,
    say: Callable[[str], object] = lambda _: None,
) -> Tuning:
    """Finds kp, ki and kd of a loop that is closed by the engine, with steps of `distance` [u] around where the axis
    stands. On a failure the axis has the gains it had; feed-forward always comes back. Raises TaktError where the drive
    closes the loop itself, the axis is not powered, or there is no good answer."""
    if axis.parameters["drive"]["mode"] == "cyclic_position":
        raise TaktError(f"{axis.name}: its drive closes the position loop itself; there is nothing to tune here")
    if axis.state.value != "Standstill":
        raise TaktError(f"{axis.name}: expected an axis in Standstill, found {axis.state.value}")
    loop = axis.parameters["loop"]
    first = {name: float(loop[name]) for name in GAINS}
    count = 0

    def response(gains: Mapping[str, float]) -> StepResponse:
        nonlocal count
        count += 1
        axis.set_constants(**gains, ff=0.0).wait()
        session.run(0.05)
        result = step_response(session, axis, distance, watch_s)
        say(", ".join(f"{n} {v:.4g}" for n, v in gains.items()) + f": {result.text}")
        return result

    with _restoring(session, axis, first, float(loop["ff"])) as keep:
        before = response(first)
        gains = {"kp": first["kp"] / 4, "ki": 0.0, "kd": 0.0}
        while response(gains).turns >= RINGS and gains["kp"] > 1e-6:
            gains["kp"] /= 2
        gains["kd"] = _largest(0.001, lambda kd: response({**gains, "kd": kd}).turns < RINGS, 4.0)
        gains["kd"] /= 2  # a margin: at the edge it rings a little
        gains["kp"] = _largest(gains["kp"] / 4, lambda kp: _damped(response({**gains, "kp": kp})), 1.0)
        after = response(gains)
        while not _damped(after) and gains["kp"] > 1e-6:  # friction and play make the edge uncertain
            gains["kp"] *= 0.8
            after = response(gains)
        if abs(after.rest) > SETTLED / 4:
            enough = _least(1e-5, lambda ki: abs(response({**gains, "ki": ki}).rest) < SETTLED / 4, gains["kp"])
            with_ki = response({**gains, "ki": enough})
            if enough and _damped(with_ki):
                gains["ki"], after = enough, with_ki
        if not _damped(after):
            raise TaktError(f"{axis.name}: no gains were found that damp it: {after.text}")
        keep(gains)
    return Tuning(axis.name, gains, before, after, count)


def _damped(response: StepResponse) -> bool:
    return response.overshoot < CRITICAL and response.turns < RINGS


def _largest(first: float, good: Callable[[float], bool], most: float) -> float:
    """By doubling, then halving the interval: the largest value that is good; 0: not even the first one."""
    low, high = 0.0, first
    while high < most and good(high):
        low, high = high, 2 * high
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if good(middle) else (low, middle)
    return low


def _least(first: float, good: Callable[[float], bool], most: float) -> float:
    """By doubling: the first value that is good; 0: none."""
    value = first
    while value < most:
        if good(value):
            return value
        value *= 2
    return 0.0


@contextmanager
def _restoring(
    session: Session, axis: Axis, first: Mapping[str, float], ff: float
) -> Iterator[Callable[[Mapping[str, float]], None]]:
    """Puts the gains back that were not kept, and feed-forward always."""
    final = dict(first)

    def keep(gains: Mapping[str, float]) -> None:
        final.update(gains)

    try:
        yield keep
    finally:
        axis.set_constants(**final, ff=ff)
        session.run(0.01)


def picture(tuning: Tuning, path: Path) -> Path:
    """Both step responses, one above the other, with their figures."""
    from matplotlib.figure import Figure

    from takt import style
    from takt.plot import save

    figure = Figure(figsize=(9, 6), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True, sharey=True)
    for ax, title, step in zip(axes, ("before", "after"), (tuning.before, tuning.after), strict=True):
        ax.axhspan(1 - SETTLED / 2, 1 + SETTLED / 2, color=style.GOOD, alpha=0.2, linewidth=0)
        ax.axhline(1, color="#444", linewidth=0.8)
        ax.plot(1000 * step.time_s, step.response, color=style.PALETTE[0])
        if step.settling_s == step.settling_s:
            ax.axvline(1000 * step.settling_s, color="#444", linestyle=":", linewidth=1)
        ax.set_title(f"{title}: {step.text}", loc="left", fontsize=10)
        ax.set_ylabel("share of the step")
        ax.grid(alpha=0.3)
    axes[1].set_xlabel("time [ms]")
    figure.suptitle(f"{tuning.axis}: {tuning.yaml}", fontweight="bold")
    return save(figure, path)
