"""The tuning of position loops by the procedure of the GT-775x manual (its chapter 5.5): Kd is doubled until the axis
rings and then found by halving, Kp likewise until it overshoots, then Ki removes the remaining deviation at rest.
Feedforward is off meanwhile, so that the response is that of the loop alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from pathlib import Path

from takt.axis import Axis
from takt.errors import TaktError
from takt.session import Session
from takt.step_response import SETTLED, StepResponse, analyse, step_response
from takt.tuning_bench import NO_GAINS, Bench, damped, steady, worse

__all__ = ["StepResponse", "Tuning", "analyse", "picture", "step_response", "tune"]

HALVINGS = 5
FIRST_KD, MOST_KD = 0.001, 4.0
MOST_KP = 1.0  # corrects the whole deviation within one cycle
MARGIN = 2.0  # factor of all gains up to which the axis must not ring
LEFT = SETTLED / 4  # share of the step that may be missing at rest
MOST_LEFT = 0.1  # with more, the tuning has failed
SMALLER = 0.8
VERIFICATIONS = 3  # steps with the final gains


@dataclass(frozen=True)
class Tuning:
    """The outcome of `tune`."""

    axis: str
    gains: Mapping[str, float]  # kp, ki, kd
    before: StepResponse
    after: StepResponse  # the worst of several
    steps: int  # number of trials
    remark: str = ""  # what could not be achieved

    @property
    def yaml(self) -> str:
        """The line for the machine file."""
        return "loop: {" + ", ".join(f"{name}: {value:.6g}" for name, value in self.gains.items()) + "}"


def tune(
    session: Session,
    axis: Axis,
    distance: float,
    watch_s: float = 0.5,
    say: Callable[[str], object] = lambda _: None,
    *,
    keep: bool = False,
) -> Tuning:
    """Finds kp, ki and kd of a position loop that the engine closes. Returns them with the responses before and after.

    distance: length of the steps [u]; its sign is the preferred side of the current position.
    watch_s: shortest watch time of a step [s].
    say: called with a sentence for each trial.
    keep: sets the new gains after a success.

    In any case the axis ends powered at its initial position with its former supervision and, unless kept, its former
    gains. Raises TaktError, with the reason in one sentence, if the axis cannot be tuned or no gains damp it.
    """
    with Bench(session, axis, distance, watch_s, say) as bench:
        before = bench.step(bench.found)
        gains = _with_damping(bench, _least(bench))
        gains = _with_margin(bench, gains)
        gains, after = _verified(bench, gains)
        gains, after = _with_integral(bench, gains, after)
        if abs(after.rest) > MOST_LEFT:
            raise TaktError(
                f"{axis.name}: with the best gains {100 * after.rest:.0f} % of a step are left: something holds it (an "
                f"end stop, friction, a brake), or it pulls harder than the drive"
            )
        remark = _remark(bench, after)
    if keep:
        axis.set_constants(**gains).wait()
    return Tuning(axis.name, gains, before, after, bench.steps, remark)


def _remark(bench: Bench, after: StepResponse) -> str:
    remarks = []
    if bench.sampled_s > 1.5 * bench.period_s and not after.rise_s > 10 * bench.sampled_s:
        remarks.append(
            f"the engine publishes the axis only every {1000 * bench.sampled_s:g} ms: overshoot may be larger than "
            f"what was seen (lcm.axis_rate_hz in the machine file)"
        )
    if abs(after.rest) > SETTLED / 2:
        remarks.append(
            f"{100 * after.rest:.1f} % of a step is left at rest (friction, load, a dead band or the drive's "
            f"offset): more of an integral gain would overshoot"
        )
    if bench.reference_lost:
        remarks.append("the ringing was too fast for the encoder: the axis lost its reference and has to be homed")
    return "; ".join(remarks)


def _least(bench: Bench) -> dict[str, float]:
    """Returns gains with a small kp that still moves the axis: half of the largest damped one, found by doubling."""
    gains = {**NO_GAINS, "kp": bench.base_kp}
    while not damped(response := bench.step(gains)):
        gains["kp"] /= 2
        if gains["kp"] < bench.base_kp / 50:
            raise TaktError(f"{bench.name}: it overshoots or rings however small kp is: {response.text}")
    while gains["kp"] < MOST_KP / 2 and damped(bench.step({**gains, "kp": 2 * gains["kp"]})):
        gains["kp"] *= 2
    gains["kp"] /= 2
    return gains


def _with_damping(bench: Bench, gains: Mapping[str, float]) -> dict[str, float]:
    """Returns gains with half the largest kd without ringing (at the limit it rings slightly), and the largest kp that
    is damped with it; with less kd if that much overshoots by itself."""
    kd = _largest(FIRST_KD, lambda kd: steady(bench.step({**gains, "kd": kd})), MOST_KD)
    while kd > FIRST_KD / 2:
        kd /= 2
        kp = _largest(gains["kp"], lambda kp, kd=kd: damped(bench.step({**gains, "kd": kd, "kp": kp})), MOST_KP)  # type: ignore[misc]
        if kp >= gains["kp"]:
            return {**gains, "kd": kd, "kp": kp}
    return dict(gains)


def _with_margin(bench: Bench, gains: Mapping[str, float]) -> dict[str, float]:
    """Reduces all gains until they do not ring even when multiplied by MARGIN."""
    less = dict(gains)
    while not steady(bench.step(_scaled(less, MARGIN))):
        less = _scaled(less, SMALLER)
        if less["kp"] < gains["kp"] / 10:
            raise TaktError(f"{bench.name}: no gains were found that are far enough from ringing")
    return less


def _verified(bench: Bench, gains: Mapping[str, float]) -> tuple[dict[str, float], StepResponse]:
    """Returns these gains, or a smaller kp (friction and play make the limit uncertain), and the worst of their
    responses."""
    tried = dict(gains)
    while True:
        after = reduce(worse, (bench.step(tried) for _ in range(VERIFICATIONS)))
        if damped(after):
            return tried, after
        tried["kp"] *= SMALLER
        if tried["kp"] < gains["kp"] / 10:
            raise TaktError(f"{bench.name}: no gains were found that damp it: {after.text}")


def _with_integral(
    bench: Bench, gains: Mapping[str, float], without: StepResponse
) -> tuple[dict[str, float], StepResponse]:
    """Returns gains with the smallest ki, by doubling, that removes the deviation at rest without overshoot, or else
    the ki with the least deviation. The integral time is from 1000 to 4 times that of the loop."""
    best, after = dict(gains), without
    ki = gains["kp"] ** 2 / 1000
    while ki < gains["kp"] ** 2 / 4 and abs(after.rest) > LEFT:
        tried = {**gains, "ki": ki}
        response = bench.step(tried)
        if damped(response) and abs(response.rest) < abs(after.rest):
            response = reduce(worse, (bench.step(tried) for _ in range(VERIFICATIONS)))
            if damped(response) and abs(response.rest) < abs(after.rest):
                best, after = tried, response
        ki *= 2
    return best, after


def _scaled(gains: Mapping[str, float], factor: float) -> dict[str, float]:
    return {name: factor * value for name, value in gains.items()}


def _largest(first: float, good: Callable[[float], bool], most: float) -> float:
    """Returns the largest good value up to `most`, by doubling and then halving the interval; 0 if there is none."""
    low, high = 0.0, first
    while high < most and good(high):
        low, high = high, min(2 * high, most)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if good(middle) else (low, middle)
    return low


def picture(tuning: Tuning, path: Path) -> Path:
    """Draws both step responses, one above the other, with their values, and writes the picture. Returns the path."""
    from matplotlib.figure import Figure

    from takt import style
    from takt.plot import save

    figure = Figure(figsize=(9, 6), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True, sharey=True)
    lowest, highest = 0.0, 1.0
    for ax, title, step in zip(axes, ("before", "after"), (tuning.before, tuning.after), strict=True):
        end = 1 - step.rest
        lowest, highest = min(lowest, float(step.response.min())), max(highest, float(step.response.max()))
        ax.axhline(1, color="#444", linewidth=0.8)
        if step.settling_s == step.settling_s:
            ax.axhspan(end - SETTLED / 2, end + SETTLED / 2, color=style.GOOD, alpha=0.2, linewidth=0)
            ax.axvline(1000 * step.settling_s, color="#444", linestyle=":", linewidth=1)
        ax.plot(1000 * step.time_s, step.response, color=style.PALETTE[0])
        ax.set_title(f"{title}: {step.text}", loc="left", fontsize=10)
        ax.set_ylabel("share of the step")
        ax.grid(alpha=0.3)
    axes[0].set_ylim(max(lowest, -1.0) - 0.1, min(highest, 2.0) + 0.1)  # an unstable response leaves the picture
    axes[0].set_xlim(0, 1000 * _shown_s(tuning))
    axes[1].set_xlabel("time [ms]")
    figure.suptitle(f"{tuning.axis}: {tuning.yaml}", fontweight="bold")
    return save(figure, path)


def _shown_s(tuning: Tuning) -> float:
    """Returns the time shown: a little longer than both settling times; the whole response if it never settles."""
    ends = []
    for step in (tuning.before, tuning.after):
        whole = float(step.time_s[-1])
        ends.append(min(1.5 * step.settling_s, whole) if step.settling_s == step.settling_s else whole)
    return max(ends)
