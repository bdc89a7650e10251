"""The tuning of position loops by the procedure of the GT-775x manual (its chapter 5.5): Kd is doubled until the axis
rings and then found by halving, Kp likewise until it overshoots, then Ki takes away what is left at rest. Feed-forward
is off meanwhile, so that the loop alone answers.
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
MOST_KP = 1.0  # all of the error within one cycle
MARGIN = 2.0  # all gains may become so many times larger before it rings
LEFT = SETTLED / 4  # share of the step that may be missing at rest
MOST_LEFT = 0.1  # with more than that it is no answer
SMALLER = 0.8
VERIFICATIONS = 3  # of the answer


@dataclass(frozen=True)
class Tuning:
    """The outcome of `tune`."""

    axis: str
    gains: Mapping[str, float]  # kp, ki, kd
    before: StepResponse
    after: StepResponse  # the worst of some
    steps: int  # that were tried
    remark: str = ""  # what could not be had

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
    """Finds kp, ki and kd of a loop that is closed by the engine, with steps of `distance` [u] on one side of where the
    axis stands. However it ends, the axis stays powered where it stood, with the supervision and the gains that it had;
    with `keep` a success leaves it with the new ones. Raises TaktError, with the reason in one sentence, where the axis
    cannot be tuned as it is or no gains damp it."""
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
    """Gains with a kp that is small, but moves the axis: half of the last that is damped, by doubling."""
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
    """Half the largest kd with which it does not ring (at the edge it rings a little), and the largest kp that is
    damped with it; where so much kd overshoots alone, less of it."""
    kd = _largest(FIRST_KD, lambda kd: steady(bench.step({**gains, "kd": kd})), MOST_KD)
    while kd > FIRST_KD / 2:
        kd /= 2
        kp = _largest(gains["kp"], lambda kp, kd=kd: damped(bench.step({**gains, "kd": kd, "kp": kp})), MOST_KP)  # type: ignore[misc]
        if kp >= gains["kp"]:
            return {**gains, "kd": kd, "kp": kp}
    return dict(gains)


def _with_margin(bench: Bench, gains: Mapping[str, float]) -> dict[str, float]:
    """As much less of all gains as it takes until they are far from ringing."""
    less = dict(gains)
    while not steady(bench.step(_scaled(less, MARGIN))):
        less = _scaled(less, SMALLER)
        if less["kp"] < gains["kp"] / 10:
            raise TaktError(f"{bench.name}: no gains were found that are far enough from ringing")
    return less


def _verified(bench: Bench, gains: Mapping[str, float]) -> tuple[dict[str, float], StepResponse]:
    """These gains, or with a smaller kp (friction and play make the edge uncertain), and the worst of their
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
    """The smallest ki, by doubling, that takes away what is left at rest, or else the one that leaves least, without
    overshoot. The integral's time is from 1000 to 4 times the loop's own."""
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
    """By doubling, then halving the interval: the largest value up to `most` that is good; 0: none."""
    low, high = 0.0, first
    while high < most and good(high):
        low, high = high, min(2 * high, most)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if good(middle) else (low, middle)
    return low


def picture(tuning: Tuning, path: Path) -> Path:
    """Both step responses, one above the other, with their figures."""
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
    axes[0].set_ylim(max(lowest, -1.0) - 0.1, min(highest, 2.0) + 0.1)  # one that runs away leaves the picture
    axes[0].set_xlim(0, 1000 * _shown_s(tuning))
    axes[1].set_xlabel("time [ms]")
    figure.suptitle(f"{tuning.axis}: {tuning.yaml}", fontweight="bold")
    return save(figure, path)


def _shown_s(tuning: Tuning) -> float:
    """Until both have settled, and a little longer; all of one that never does."""
    ends = []
    for step in (tuning.before, tuning.after):
        whole = float(step.time_s[-1])
        ends.append(min(1.5 * step.settling_s, whole) if step.settling_s == step.settling_s else whole)
    return max(ends)
