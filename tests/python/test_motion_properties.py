"""AX-13, AX-14: random machines, start states, targets and limits: no set point ever exceeds a limit or steps.

10,000 problems in the suite, 1,000,000 with TAKT_LONG=1 (`./dev bench --long`). The tolerances are the published ones
of the planner: 1e-9 of a limit, 1e-6 of the jerk (its differences round), 2e-8 of a³/j² where a motion ends.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
import takt
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

AXES = 20  # problems an example
EXAMPLES = 50_000 if os.environ.get("TAKT_LONG") else 500

share = st.floats(0.02, 1)


@dataclass(frozen=True)
class Problem:
    """In units of the axis: what a drive of some size in µm, mm, m or deg may do, and two commands, the second in the
    middle of the first."""

    unit: float
    velocity: float
    ramp_s: float  # time to full speed
    jerk_s: float  # time to full acceleration; 0: unlimited
    braking: float  # deceleration as a share of the acceleration
    fenced: bool
    first: tuple[str, float, float, float]
    after: float  # share of a second
    second: tuple[str, float, float, float]

    @property
    def limits(self) -> dict[str, float]:
        v = self.velocity * self.unit
        a = v / self.ramp_s
        limits = {"velocity": v, "acceleration": a, "deceleration": a * self.braking}
        limits["jerk"] = a / self.jerk_s if self.jerk_s else 0.0
        if self.fenced:
            limits |= {"lower": -0.3 * v, "upper": 0.3 * v}
        return limits

    def give(self, axis: takt.Axis, command: tuple[str, float, float, float]) -> None:
        kind, where, fast, hard = command
        own = self.limits
        ramps = {"acceleration": own["acceleration"] * hard, "deceleration": own["deceleration"] * hard}
        if own["jerk"]:
            ramps["jerk"] = own["jerk"] * hard
        if kind == "absolute":
            axis.move_absolute(position=0.3 * own["velocity"] * where, velocity=own["velocity"] * fast, **ramps)
        elif kind == "relative":
            axis.move_relative(distance=0.3 * own["velocity"] * where, velocity=own["velocity"] * fast, **ramps)
        elif kind == "velocity":
            sense = "positive" if where > 0 else "negative"
            axis.move_velocity(velocity=own["velocity"] * fast, direction=sense, **ramps)
        else:
            axis.halt(**{k: v for k, v in ramps.items() if k != "acceleration"})


command = st.tuples(st.sampled_from(["absolute", "relative", "velocity", "halt"]), st.floats(-1, 1), share, share)
problem = st.builds(
    Problem,
    unit=st.sampled_from([1e-3, 1.0, 1e3, 57.3]),
    velocity=st.floats(0.05, 5),
    ramp_s=st.floats(0.01, 0.5),
    jerk_s=st.one_of(st.just(0.0), st.floats(0.002, 0.2)),
    braking=st.sampled_from([1.0, 0.3, 2.5]),
    fenced=st.booleans(),
    first=command,
    after=st.floats(0, 1),
    second=command,
)


def machine_of(problems: list[Problem]) -> str:
    axes = [f"  - {{name: a{i}, limits: {p.limits}}}".replace("'", "") for i, p in enumerate(problems)]
    return "name: random\naxes:\n" + "\n".join(axes) + "\n"


def check(p: Problem, trace: np.ndarray, period: float) -> None:
    trace = trace[trace["loop_closed"] > 0]
    own = p.limits
    x, v, a = (trace[f"set_{what}"] for what in ("position", "velocity", "acceleration"))
    assert len(x) > 100
    assert np.all(np.abs(v) <= own["velocity"] * (1 + 1e-9))
    grows = a * v > 0
    assert np.all(np.abs(a[grows]) <= own["acceleration"] * (1 + 1e-9))
    # At standstill a motion may be about to go either way; with different limits the planner takes the smaller one.
    assert np.all(np.abs(a[~grows]) <= max(own["acceleration"], own["deceleration"]) * (1 + 1e-9))
    falls = a * v < 0
    assert np.all(np.abs(a[falls]) <= own["deceleration"] * (1 + 1e-9))
    hardest = max(own["acceleration"], own["deceleration"])
    if own["jerk"]:
        assert np.all(np.abs(np.diff(a)) <= own["jerk"] * period * (1 + 1e-6) + 1e-12 * hardest)
        bend = own["jerk"] * period**3 / 12 + 2e-8 * hardest**3 / own["jerk"] ** 2
    else:
        bend = hardest * period**2 / 2
    apart = np.diff(x) - (v[1:] + v[:-1]) / 2 * period
    assert np.all(np.abs(apart) <= bend * (1 + 1e-6) + 1e-9 * p.unit)
    if p.fenced:
        assert np.all(x <= own["upper"] + 1e-6 * own["velocity"])
        assert np.all(x >= own["lower"] - 1e-6 * own["velocity"])


@settings(
    max_examples=EXAMPLES, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow], database=None
)
@given(st.lists(problem, min_size=AXES, max_size=AXES), st.sampled_from([0.00025, 0.001, 0.004]))
def test_no_limit_is_ever_exceeded(problems: list[Problem], period: float) -> None:
    with takt.Engine(machine_of(problems), period=period) as engine:
        axes = list(engine.axes.values())
        for axis in axes:
            axis.power()
        engine.run(0.15)
        with engine.record() as recorder:
            for axis, p in zip(axes, problems, strict=True):
                p.give(axis, p.first)
            order = sorted(range(AXES), key=lambda i: problems[i].after)
            for i in order:
                engine.run(max(0.0, problems[i].after * 0.4 - (engine.now - 0.15)))
                problems[i].give(axes[i], problems[i].second)
            engine.run(0.6)
        for axis, p in zip(axes, problems, strict=True):
            check(p, recorder.recording[axis.name], period)
