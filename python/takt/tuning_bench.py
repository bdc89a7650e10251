"""An axis under tuning: it is checked first, kept near its initial position, and restored afterwards."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from types import TracebackType

import numpy as np

from takt.axis import Axis
from takt.engine import error_text
from takt.errors import CommandError, TaktError
from takt.session import Session
from takt.step_response import SETTLED, StepResponse, come_to_rest, relative, there_and_back

GAINS = ("kp", "ki", "kd")
NO_GAINS = dict.fromkeys(GAINS, 0.0)
CRITICAL = 1.0  # % of overshoot that still counts as critically damped
RINGS = 3  # turning points larger than the band from which on it rings
HUMS = 8  # smaller turning points in the second half, in which it should be at rest
LEAST_COUNTS = 100  # of a step: 1 % of overshoot is one count
MOST_NOISE = 0.01  # share of the step, peak to peak
GUARD = 3.0  # following error, in steps, at which the engine opens the loop
FEED = 0.5  # share of a step that is fed forward to find the direction of motion
DEVIATION, ENCODER = 2001, 3001  # errors caused by ringing: following error, too fast for the encoder
ROOM = 1.0  # steps of clearance behind the start and beyond the target
LOOK_S = 0.05  # s of observation without a set point
LEAST_SPEED_GAIN = 5.0  # 1/s, start of the search
AS_GOOD_AS_NONE = 1e9  # u, stands for no limit
MOST_DRIFT = 5.0  # largest drift without a command, in steps per s

# Numbers of parameters: of PLCopen, and of Takt.
LIMIT_POSITIVE, LIMIT_NEGATIVE, LIMIT_POSITIVE_ON, LIMIT_NEGATIVE_ON, LAG_ON, LAG = 2, 3, 4, 5, 6, 7
KP, KI, KD, FF, LAG_AT_REST = 1001, 1002, 1003, 1005, 1007


def damped(response: StepResponse) -> bool:
    return steady(response) and response.overshoot < CRITICAL


def steady(response: StepResponse) -> bool:
    """Returns whether the response neither rings nor hums, without a fault."""
    return not response.error and response.turns < RINGS and response.hum < HUMS


def worse(one: StepResponse, other: StepResponse) -> StepResponse:
    def badness(r: StepResponse) -> tuple[bool, bool, bool, float]:
        return not steady(r), not damped(r), math.isnan(r.settling_s), r.settling_s

    return max(one, other, key=badness)


class Bench:
    """A context for tuning an axis. On entry it checks the axis and widens its supervision for steps of `distance`
    [u]; on exit, for any reason, the axis has its former gains, supervision and position, and is powered.

    Raises TaktError, with the axis unchanged or restored, if it cannot be tuned."""

    def __init__(
        self, session: Session, axis: Axis, distance: float, watch_s: float, say: Callable[[str], object]
    ) -> None:
        self._session, self._axis, self._watch_s, self._say = session, axis, watch_s, say
        self.name = axis.name
        self._check_axis(distance)
        self.distance = self._with_room(distance)
        self.steps = 0  # number of steps made
        self.base_kp = LEAST_SPEED_GAIN * session.period  # initial gain
        self.found = {name: self._read(number) for name, number in zip(GAINS, (KP, KI, KD), strict=True)}
        self._ff = self._read(FF)
        self._lag, self._lag_at_rest, self._lag_on = self._read(LAG), self._read(LAG_AT_REST), self._read(LAG_ON)
        self._origin = axis.set_position
        self._safe: Mapping[str, float] = self.found  # gains with the least deviation so far
        self._safe_rest = math.inf  # share of a step
        self._homed = axis.homed
        self.period_s = self.sampled_s = session.period  # s from one published sample to the next
        self._noise = 0.0  # u, peak to peak
        self._backwards = False
        self._unruly = False  # it rings permanently with its former gains

    def __enter__(self) -> Bench:
        try:
            guard = GUARD * abs(self.distance) + abs(self._axis.following_error)
            self._write(LAG, guard)
            if self._lag_at_rest < math.inf:
                self._write(LAG_AT_REST, guard)
            self._look()
        except BaseException:
            self._restore()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._restore()

    def step(self, gains: Mapping[str, float]) -> StepResponse:
        """Makes a step and a step back with these gains, without feedforward. Returns the worse response. Raises
        TaktError if the axis fails for reasons other than ringing."""
        self.steps += 1
        try:
            self._go_home()
            self._set(gains)
            self._rest()
            response = worse(*there_and_back(self._session, self._axis, self.distance, self._watch_s, self._noise))
        except CommandError:
            self._check_power()
            raise
        if response.error not in (0, DEVIATION, ENCODER):
            raise TaktError(f"{self.name}: a step ended in error {response.error}: {error_text(response.error)}")
        if damped(response) and abs(response.rest) < self._safe_rest:
            self._safe, self._safe_rest = dict(gains), abs(response.rest)
        elif gains == self._safe and not steady(response):
            self._safe = {**NO_GAINS, "kp": self.base_kp}
        if gains == self.found:
            self._unruly = response.error != 0 or (not steady(response) and math.isnan(response.settling_s))
        self._say(", ".join(f"{n} {v:.4g}" for n, v in gains.items()) + f": {response.text}")
        return response

    @property
    def reference_lost(self) -> bool:
        return self._homed and not self._axis.homed

    # --- checking the axis ---

    def _check_axis(self, distance: float) -> None:
        axis, name = self._axis, self.name
        if axis.parameters["drive"]["mode"] == "cyclic_position":
            raise TaktError(f"{name}: its drive closes the position loop itself; there is nothing to tune here")
        if axis.state.value != "Standstill":
            raise TaktError(f"{name}: expected an axis in Standstill, found {axis.state.value}")
        for other in self._session.axes.values():
            if axis.index + 1 in (other.master1, other.master2):
                raise TaktError(f"{name}: {other.name} follows it and would make the steps, too; uncouple it first")
        if not math.isfinite(distance) or distance == 0:
            raise TaktError(f"{name}: a step has a length; {distance:g} {axis.unit} is none")
        counts = abs(distance) * axis.parameters["encoder"]["increments_per_unit"]
        if counts < LEAST_COUNTS * (1 - 1e-9):
            least = abs(distance) * LEAST_COUNTS / counts
            raise TaktError(
                f"{name}: steps of {abs(distance):g} {axis.unit} are only {counts:.3g} increments of the encoder; "
                f"take {least:g} {axis.unit} at least"
            )
        if axis.rotary and abs(distance) > axis.parameters["modulus"] / (4 * GUARD):
            raise TaktError(f"{name}: steps of {distance:g} {axis.unit} are too large a part of a turn")

    def _with_room(self, distance: float) -> float:
        """Returns the distance, or its negative if only that fits between the SW limits. Raises TaktError if neither
        does."""
        axis, size = self._axis, abs(distance)
        lower = self._read(LIMIT_NEGATIVE) if self._read(LIMIT_NEGATIVE_ON) else -math.inf
        upper = self._read(LIMIT_POSITIVE) if self._read(LIMIT_POSITIVE_ON) else math.inf
        below, above = axis.set_position - lower, upper - axis.set_position
        for way in (distance, -distance):
            ahead, behind = (above, below) if way > 0 else (below, above)
            if ahead >= (1 + ROOM) * size and behind >= ROOM * size:
                return way
        nearest = min(below, above)
        raise TaktError(
            f"{self.name}: it stands {nearest:.4g} {axis.unit} from a SW limit, and steps of {size:g} {axis.unit} need "
            f"{ROOM * size:g} {axis.unit} of room on one side and {(1 + ROOM) * size:g} {axis.unit} on the other"
        )

    def _look(self) -> None:
        """Checks the axis with an open loop: its drift, the noise of its encoder, and the direction in which
        feedforward moves it, which cannot run away even with a wrong sign."""
        axis, size = self._axis, abs(self.distance)
        self._set(NO_GAINS)
        self._watch_idle()  # lets oscillations decay
        drift, self._noise = self._watch_idle()
        if abs(drift) > MOST_DRIFT * size:
            raise TaktError(
                f"{self.name}: it moves at {drift:.3g} {axis.unit}/s when nothing is commanded; trim the drive's "
                f"offset, have the drive hold the load, or, where it swings with the gains it has, lower kp first"
            )
        if self._noise > MOST_NOISE * size:
            least = self._noise / MOST_NOISE
            raise TaktError(
                f"{self.name}: its encoder trembles by {self._noise:.3g} {axis.unit} at rest, too much for steps of "
                f"{size:g} {axis.unit}; take {least:.2g} {axis.unit} at least"
            )
        self.base_kp = max(self.base_kp, 20 * abs(drift) / size * self.period_s)
        self._set(NO_GAINS, ff=FEED)
        there = self._feed(self.distance, drift)
        back = self._feed(-self.distance, drift)
        moved = (there - back) / 2 / self.distance
        self._set(NO_GAINS)
        self._backwards = moved < -FEED / 10
        if self._backwards:
            raise TaktError(
                f"{self.name}: it moves down when it is told to move up; "
                f"turn round drive.invert (or encoder.invert, if it is the encoder that counts the wrong way)"
            )

    def _watch_idle(self) -> tuple[float, float]:
        """Returns the drift of the axis [u/s] and the noise of its measured position, peak to peak [u]."""
        axis, session = self._axis, self._session
        begin = axis.actual_position
        start_s = session.now
        with session.record(axis.name) as recorder:
            while session.now < start_s + max(LOOK_S, 5 * self.period_s):
                session.run(max(LOOK_S / 10, self.period_s))
                moved = relative(axis, axis.actual_position - begin)
                if abs(moved) > abs(self.distance) / 4:
                    break
        drift = float(moved / (session.now - start_s))
        samples = recorder.recording[axis.name]
        if len(samples) < 4:
            return drift, 0.0
        time_s = samples["time_s"] - samples["time_s"][0]
        self.sampled_s = float(np.median(np.diff(time_s)))
        places = relative(axis, samples["actual_position"] - begin)
        return drift, float(np.ptp(places - np.polyval(np.polyfit(time_s, places, 2), time_s)))

    def _feed(self, distance: float, drift: float) -> float:
        """Returns the displacement [u] of the axis, less its drift, when a step is fed forward only."""
        axis, session = self._axis, self._session
        start, begin = axis.actual_position, session.now
        if not axis.error:
            session.run(axis.move_relative(distance=distance).wait(until="active").travel_time_s + self._watch_s / 5)
        return float(relative(axis, axis.actual_position - start)) - drift * (session.now - begin)

    # --- steps and restoring ---

    def _rest(self) -> None:
        come_to_rest(
            self._session, self._axis, self._watch_s / 2, max(abs(self.distance) * SETTLED / 8, 2 * self._noise)
        )

    def _go_home(self) -> None:
        """Moves the powered axis to its initial position, with gains that hold it; resets faults first."""
        axis = self._axis
        if axis.error:
            rang = axis.error in (DEVIATION, ENCODER)
            axis.reset().wait()
            if rang:
                axis.power().wait()
        self._check_power()
        self._set(self._safe)
        away = relative(axis, self._origin - axis.set_position)
        if abs(away) > 1e-9 * abs(self.distance):
            self._session.run(axis.move_relative(distance=float(away)).wait(until="active").travel_time_s)
        self._rest()

    def _check_power(self) -> None:
        if not self._axis.powered:
            raise TaktError(f"{self.name}: it was switched off meanwhile")

    def _restore(self) -> None:
        """Restores the axis as far as possible: errors on the way to the initial position do not keep the parameters
        from being restored."""
        axis = self._axis
        powered = axis.powered or axis.error in (DEVIATION, ENCODER)  # not switched off by another client
        longest_s = axis.parameters["supervision"]["in_position_timeout_s"] + 1
        try:
            with suppress(TaktError):
                if not self._backwards:
                    self._go_home()
                    self._session.wait(lambda: axis.state.value != "DiscreteMotion", longest_s)
                if self._backwards or self._unruly or self._is_far_out():  # off, before the supervision trips
                    axis.power(enable=False).wait()
        finally:
            self._set(self.found, self._ff)
            self._write(LAG, min(self._lag, AS_GOOD_AS_NONE))
            if not self._lag_on:
                self._write(LAG_ON, 0.0)
            if self._lag_at_rest < math.inf:
                self._write(LAG_AT_REST, self._lag_at_rest)
            if axis.error:
                axis.reset().wait_final()
            if powered and not axis.powered and not axis.error:
                axis.power().wait_final()

    def _is_far_out(self) -> bool:
        return abs(self._axis.following_error) > min(self._lag, self._lag_at_rest) / 2

    def _set(self, gains: Mapping[str, float], ff: float = 0.0) -> None:
        self._axis.set_constants(**gains, ff=ff).wait()

    def _read(self, number: int) -> float:
        return self._axis.read_parameter(number=number).wait().value

    def _write(self, number: int, value: float) -> None:
        self._axis.write_parameter(number=number, value=value).wait()
