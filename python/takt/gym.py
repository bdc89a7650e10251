"""A machine as a gymnasium environment, for learning and search (PY-23): axes are to reach randomly drawn positions. It
trains nothing; it is an example of an environment made from an engine.

env = takt.gym.ReachEnv("machine.yaml", ["x", "y"])

gymnasium is an extra: pip install "takt-motion[gym]".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from takt.engine import Engine, Machine
from takt.errors import CommandError, TaktError
from takt.names import names_in

try:
    import gymnasium
    from gymnasium import spaces
except ImportError:
    raise TaktError('environments need gymnasium, which is not installed: pip install "takt-motion[gym]"') from None

Floats = npt.NDArray[np.float32]

MOST = 2.0  # bound of observed positions and velocities, relative to half the range and to the limit


class ReachEnv(gymnasium.Env[Floats, Floats]):
    """An environment in which axes are to reach target positions.

    An action is the position to which each axis moves until the next action, scaled to -1 to 1 over its range. The
    observation has the actual positions and velocities of all axes and their targets: positions on the same scale,
    velocities relative to their limits. The reward of a step is the negative mean distance; an episode ends when all
    axes are at their targets at rest. A move that is refused or fails raises CommandError.

    machine: as for takt.Engine.
    axes: names.
    ranges: by axis, lowest and highest position, within its SW limits; of a rotary axis from 0 to below its modulus;
        without an entry: the SW limits of the axis.
    step_s: engine time [s] from one action to the next.
    episode_s: engine time [s] after which an episode is truncated.
    within: tolerance of a reached target, relative to half the range; also the velocity that counts as rest, relative
        to its limit.

    Raises TaktError if an argument is wrong.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 (as gymnasium declares it)

    def __init__(
        self,
        machine: Machine,
        axes: Sequence[str],
        *,
        ranges: Mapping[str, tuple[float, float]] | None = None,
        step_s: float = 0.05,
        episode_s: float = 5.0,
        within: float = 0.01,
    ) -> None:
        if not axes:
            raise TaktError("an environment needs at least one axis")
        self._names = list(names_in(axes, "axes", "axis"))
        if len(set(self._names)) < len(self._names):
            raise TaktError(f"an environment has each axis once, found {', '.join(self._names)}")
        if other := set(ranges or {}) - set(self._names):
            raise TaktError(f"ranges: expected axes of the environment, found {', '.join(sorted(other))}")
        for what, value in (("step_s", step_s), ("episode_s", episode_s), ("within", within)):
            if not 0 < value < np.inf:
                raise TaktError(f"{what}: expected a number above 0, found {value!r}")
        self._engine = Engine(machine, journal=True)
        self._cycles = max(1, round(step_s / self._engine.period))
        self._most = max(1, round(episode_s / (self._cycles * self._engine.period)))
        self._within = within
        low, high, speed = [], [], []
        for name in self._names:
            axis = self._engine.axis(name).parameters
            limits = axis["limits"]
            lower, upper = (ranges or {}).get(name, (limits.get("lower"), limits.get("upper")))
            if lower is None or upper is None or not -np.inf < lower < upper < np.inf:
                raise TaktError(f"axis {name}: no range: give ranges={{'{name}': (LOWEST, HIGHEST)}}, or SW limits")
            _refuse_unreachable(axis, lower, upper)
            low.append(lower)
            high.append(upper)
            speed.append(limits["velocity"])
        self._middle, self._half = (np.add(low, high) / 2, np.subtract(high, low) / 2)
        self._speed = np.array(speed)
        for power in [self._engine.axis(name).power() for name in self._names]:
            power.wait()
        self._begin = self._engine.save()  # every episode begins here
        count = len(self._names)
        self.action_space = spaces.Box(-1.0, 1.0, (count,), np.float32)
        self.observation_space = spaces.Box(-MOST, MOST, (3 * count,), np.float32)
        self._goal = np.zeros(count)
        self._steps = 0

    @property
    def engine(self) -> Engine:
        """The engine of the current episode."""
        return self._engine

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        super().reset(seed=seed)
        self._engine.close()
        self._engine = Engine.restore(self._begin)
        self._goal = self.np_random.uniform(-0.9, 0.9, len(self._names))
        self._steps = 0
        return self._observed(), {"goal": self._middle + self._half * self._goal}

    def step(self, action: npt.ArrayLike) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        told = np.asarray(action, float)
        if told.shape != self.action_space.shape or not np.isfinite(told).all():
            raise ValueError(f"expected an action of {len(self._names)} numbers from -1 to 1, found {action!r}")
        told = np.clip(told, -1, 1)
        moves = [
            self._engine.axis(name).move_absolute(position=float(position))
            for name, position in zip(self._names, self._middle + self._half * told, strict=True)
        ]
        self._engine.step(self._cycles)
        for move in moves:
            if move.error:
                raise CommandError(move)
        self._steps += 1
        at, velocity = self._state()
        off = np.abs(at - self._goal)
        reached = bool((off < self._within).all() and (np.abs(velocity) < self._within).all())
        return self._observed(), -float(off.mean()), reached, self._steps >= self._most and not reached, {}

    def close(self) -> None:
        self._engine.close()

    def _state(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        axes = [self._engine.axis(name) for name in self._names]
        positions = np.array([axis.actual_position for axis in axes])
        velocities = np.array([axis.actual_velocity for axis in axes])
        return (positions - self._middle) / self._half, velocities / self._speed

    def _observed(self) -> Floats:
        seen = np.concatenate([*self._state(), self._goal])
        return np.asarray(np.clip(seen, -MOST, MOST), np.float32)


def _refuse_unreachable(axis: Mapping[str, Any], lower: float, upper: float) -> None:
    """Raises TaktError if a range is not within the SW limits of an axis or, for a rotary axis, not within 0 to below
    its modulus."""
    limits, found = axis["limits"], f"found {lower:g} to {upper:g}"
    least, most = limits.get("lower", -np.inf), limits.get("upper", np.inf)
    if axis["kind"] == "rotary" and not 0 <= lower < upper < axis["modulus"]:
        raise TaktError(f"ranges: axis {axis['name']}: expected 0 to below {axis['modulus']:g} {axis['unit']}, {found}")
    if not least <= lower < upper <= most:
        raise TaktError(f"ranges: axis {axis['name']}: expected {least:g} to {most:g} {axis['unit']}, {found}")
