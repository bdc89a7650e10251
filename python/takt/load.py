"""Identifies the load of a motor from a recording: the values of `drive: torque_offset` of an axis (PY-23).

found = takt.load.identify(recording, "x")
print(found.machine_file())
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np

from takt.recording import Array, Recording, RecordingError

LEAST = 100  # least number of samples for a fit
FULL_AT = 1.0  # u/s: default of torque_offset.full_at
HALF = 8  # half width of the triangular filter, samples
LATE = np.arange(-2, 5.1, 0.25)  # delays of the torque against the position that are tried, samples
INDEPENDENT = 0.02  # least ratio of the smallest to the largest singular value of the regressors


@dataclass(frozen=True)
class Load:
    """Identified load of an axis. Torques are in Nm, or N of a linear motor; u is the unit of the axis."""

    axis: str
    inertia: float  # torque per u/s2
    coulomb_friction: float
    viscous_friction: float  # torque per u/s
    load_torque: float
    residual_rms: float  # of the torque that the model does not explain
    torque_rms: float  # of the reported torque

    @property
    def left(self) -> float:
        """Former name of `residual_rms`."""
        warnings.warn("Load.left is called residual_rms now", DeprecationWarning, stacklevel=2)
        return self.residual_rms

    @property
    def of(self) -> float:
        """Former name of `torque_rms`."""
        warnings.warn("Load.of is called torque_rms now", DeprecationWarning, stacklevel=2)
        return self.torque_rms

    def machine_file(self) -> str:
        """Returns the line `drive: torque_offset` for the machine file."""
        return (
            f"drive: {{torque_offset: {{inertia: {self.inertia:.4g}, coulomb_friction: {self.coulomb_friction:.4g}, "
            f"viscous_friction: {self.viscous_friction:.4g}, load_torque: {self.load_torque:.4g}}}}}"
        )


def _averaged(values: Array) -> Array:
    """Returns the values filtered by a triangle of HALF samples to either side."""
    weights = HALF - np.abs(np.arange(-HALF + 1, HALF))
    return np.convolve(values, weights / HALF**2, "same")


def identify(recording: Recording, axis: str, *, full_at: float = FULL_AT) -> Load:
    """Returns inertia, friction and load torque of an axis: a least-squares fit of the reported torque to acceleration,
    velocity and direction of motion while the loop is closed. Requires equidistant samples with motion in both
    directions, with acceleration and at more than one speed. Raises RecordingError if the samples do not determine the
    values.

    full_at: speed [u/s]; slower samples, in which Coulomb friction is not fully developed, are left out; as in the
        machine file.
    """
    table = recording[axis]
    period = float(np.median(np.diff(table["time_s"]))) if len(table) > 1 else 1.0
    closed = np.asarray(table["loop_closed"], bool)
    rows = np.flatnonzero(closed)
    inside = slice(rows[0], rows[-1] + 1) if len(rows) else slice(0, 0)
    position = np.cumsum(np.asarray(table["actual_velocity"], float)[inside]) * period
    torque = np.asarray(table["torque_nm"], float)[inside]
    if len(torque) > 2 * HALF:
        # The central second difference over HALF samples is the acceleration filtered by a triangle of that half width;
        # torque and velocity get the same filter, so that all three have the same delay.
        torque = _averaged(torque)[HALF:-HALF]
        acceleration = (position[2 * HALF :] - 2 * position[HALF:-HALF] + position[: -2 * HALF]) / (HALF * period) ** 2
        velocity = _averaged(np.gradient(position, period))[HALF:-HALF]
        whole = np.convolve(closed[inside], np.ones(2 * HALF + 1), "valid") > 2 * HALF  # the loop was closed throughout
    else:
        acceleration = velocity = torque = np.empty(0)
        whole = np.empty(0, bool)
    if whole.sum() < LEAST:
        least = LEAST + 2 * HALF
        raise RecordingError(f"axis '{axis}': {len(rows)} samples with a closed loop, at least {least} are needed")
    moves = whole & (np.abs(velocity) >= full_at)  # at rest, friction balances any torque up to its own
    if not np.any(np.asarray(table["set_velocity"])[inside]):
        raise RecordingError(f"axis '{axis}': it does not move in this recording")
    if moves.sum() < LEAST:
        raise RecordingError(
            f"axis '{axis}': it does not move for long enough in this recording: {moves.sum()} samples at {full_at:g} "
            f"u/s or faster, at least {LEAST} are needed"
        )
    parts = np.stack([acceleration, np.sign(velocity), velocity, np.ones_like(velocity)], axis=1)[moves]
    sizes = np.maximum(np.abs(parts).max(axis=0), 1e-30)
    values = np.linalg.svd(parts / sizes, compute_uv=False)
    if values[-1] < INDEPENDENT * values[0]:
        raise RecordingError(
            f"axis '{axis}': its friction cannot be told from its load in this recording: it needs motion both "
            "ways and at more than one speed"
        )
    # The torque is delayed against the position by an unknown fraction of cycles: the one with the least residual wins.
    at = np.flatnonzero(moves).astype(float)
    best, found, left, torque_told = math.inf, np.zeros(4), torque, torque
    for late in LATE:
        told = np.interp(at + late, np.arange(len(torque)), torque)
        values, *_ = np.linalg.lstsq(parts / sizes, told, rcond=None)
        rest = told - parts / sizes @ values
        if (size := float(rest @ rest)) < best:
            best, found, left, torque_told = size, values, rest, told
    inertia, coulomb, viscous, load = found / sizes
    return Load(
        axis,
        max(0.0, float(inertia)),
        max(0.0, float(coulomb)),
        max(0.0, float(viscous)),
        float(load),
        float(np.sqrt(np.mean(left**2))),
        float(np.sqrt(np.mean(torque_told**2))),
    )
