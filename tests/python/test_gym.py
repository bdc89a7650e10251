"""PY-23: an environment of gymnasium, checked by gymnasium's own checker."""

from __future__ import annotations

import subprocess
import sys
import warnings
from typing import Any

import numpy as np
import pytest
import takt

MACHINE = """name: two
axes:
  - {name: x, unit: mm, limits: {velocity: 300, acceleration: 3000, jerk: 60000, lower: -100, upper: 100}}
  - {name: y, unit: mm, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
  - {name: r, unit: deg, kind: rotary, modulus: 360, limits: {velocity: 300, acceleration: 3000, jerk: 60000}}
"""


def test_gymnasium_checks_it() -> None:
    """Spaces, seeds, the order of calls: as its own checker wants them."""
    pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env
    from takt.gym import ReachEnv

    env = ReachEnv(MACHINE, ["x", "y"], ranges={"y": (0, 50)}, episode_s=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*not have a `spec`.*|.*render.*|.*infinity.*")
        check_env(env, skip_render_check=True)
    observed, info = env.reset(seed=7)
    total, ended = 0.0, False
    for _ in range(40):
        observed, reward, ended, broken_off, _ = env.step(observed[4:])
        total += reward
        if ended or broken_off:
            break
    assert ended
    assert env.engine.axis("x").actual_position == pytest.approx(info["goal"][0], abs=1)
    assert -10 < total < 0
    again = [env.reset(seed=7)[0].tolist() for _ in range(2)]
    assert again[0] == again[1]
    assert not np.allclose(env.reset(seed=8)[0], again[0])
    for wrong in ([0.5], [0.5, float("nan")], [[0.5, 0.5]]):
        with pytest.raises(ValueError, match="expected an action of 2 numbers from -1 to 1, found"):
            env.step(wrong)
    env.close()
    with pytest.raises(takt.TaktError, match=r"axis y: no range: give ranges"):
        ReachEnv(MACHINE, ["y"])
    with pytest.raises(TypeError, match="axes is a list of names, not the text 'x'"):
        ReachEnv(MACHINE, "x")
    with pytest.raises(takt.TaktError, match="at least one axis"):
        ReachEnv(MACHINE, [])


def test_an_episode_lasts_as_long_as_it_should() -> None:
    """PY-23: steps are whole cycles, however short ones are asked for."""
    pytest.importorskip("gymnasium")
    from takt.gym import ReachEnv

    with takt.Engine(MACHINE) as engine:
        period = engine.period
    env = ReachEnv(MACHINE, ["x"], step_s=period / 4, episode_s=10 * period)
    env.reset(seed=1)
    ended = [env.step([0.0])[3] for _ in range(10)]
    assert ended == [False] * 9 + [True]
    env.close()


@pytest.mark.parametrize(
    ("axes", "options", "said"),
    [
        (["x", "x"], {}, "each axis once, found x, x"),
        (["x"], {"step_s": 0}, "step_s: expected a number above 0, found 0"),
        (["x"], {"episode_s": float("inf")}, "episode_s: expected a number above 0, found inf"),
        (["x"], {"within": -1}, "within: expected a number above 0, found -1"),
        (["x"], {"ranges": {"z": (0, 5)}}, "ranges: expected axes of the environment, found z"),
        (["x"], {"ranges": {"x": (0, float("inf"))}}, "axis x: no range"),
        (["x"], {"ranges": {"x": (-1000, 50)}}, "ranges: axis x: expected -100 to 100 mm, found -1000 to 50"),
        (["x"], {"ranges": {"x": (0, 101)}}, "ranges: axis x: expected -100 to 100 mm, found 0 to 101"),
        (["r"], {"ranges": {"r": (-90, 90)}}, "ranges: axis r: expected 0 to below 360 deg, found -90 to 90"),
        (["r"], {"ranges": {"r": (0, 360)}}, "ranges: axis r: expected 0 to below 360 deg, found 0 to 360"),
    ],
)
def test_what_no_environment_is_made_of(axes: list[str], options: dict[str, Any], said: str) -> None:
    """PY-23: refused, where steps would divide by zero, observations be no numbers, or goals never be reached."""
    pytest.importorskip("gymnasium")
    from takt.gym import ReachEnv

    with pytest.raises(takt.TaktError, match=said):
        ReachEnv(MACHINE, axes, **options)


def test_refused_moves_are_raised() -> None:
    """PY-23: an axis that is off does not end an episode as one that was too slow."""
    pytest.importorskip("gymnasium")
    from takt.gym import ReachEnv

    env = ReachEnv(MACHINE, ["x", "r"], ranges={"r": (0, 359)})
    env.reset(seed=1)
    env.step([0.5, 1.0])
    env.engine.axis("r").power(enable=False).wait_final()
    with pytest.raises(takt.CommandError, match=r"r\.move_absolute"):
        env.step([0.5, 0.5])
    env.close()


def test_without_gymnasium() -> None:
    program = """
import sys
sys.modules["gymnasium"] = None
import takt
try:
    import takt.gym
except takt.TaktError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert 'environments need gymnasium, which is not installed: pip install "takt-motion[gym]"' in done.stdout
