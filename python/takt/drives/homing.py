"""Homing by a drive itself (CiA 402, mode hm): the objects written for it, and its execution (AX-87).

Afterwards the drive counts from its reference, so its position jumps. The axis' position does not: the engine receives
a continuous position, and the reference as an index pulse.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any, Final

from takt.drives.cia402 import FOLLOWING_ERROR_BIT, FOLLOWS_BIT, HOMING_START_BIT, TARGET_REACHED_BIT, Mode
from takt.drives.scaling import Scaling

MODE_WITHIN_S: Final = 1.0  # from the command of the mode to the mode
QUIET_CYCLES: Final = 2  # in the mode without the start bit, whose edge starts homing
ANSWER_CYCLES: Final = 4  # from the start bit to a status word that reflects it
BRAKING_SHARE: Final = 2.0  # times the braking distance: largest overrun of a limit switch
BRAKING_CYCLES: Final = 4  # cycles until the drive begins to brake
AVERAGED_SAMPLES: Final = 8  # of the speed: on a busy computer single positions are late, or arrive in pairs


class Watch:
    """Supervises a homing drive: it must come to rest behind a limit switch, and not move too far. All values in
    increments, with the sign of the axis.

    most: largest distance from the start; None: unlimited.
    acceleration: increments/s²."""

    def __init__(self, most: float | None, acceleration: float, period_s: float) -> None:
        self._most, self._acceleration, self._period_s = most, acceleration, period_s
        self.begin()

    def begin(self) -> None:
        self._from: int | None = None
        self._before: deque[tuple[int, int]] = deque(maxlen=AVERAGED_SAMPLES)  # positions, each with its cycle
        self._cycle = 0
        self._edges: dict[int, tuple[int, float]] = {}  # by sign: position and speed when its switch came on

    def look(self, position: int, switches: Mapping[int, bool], cycles: int = 1) -> str:
        """Checks the drive, once a cycle or after `cycles`. Returns why it must stop; "" if it need not.

        switches: by sign, -1 and 1, whether the limit switch at that end is on."""
        if self._from is None:
            self._from = position
        self._cycle += cycles
        speed = self._speed(position)
        self._before.append((position, self._cycle))
        gone = abs(position - self._from)
        if self._most is not None and gone > self._most:
            return f"it has gone {gone} increments from where it began, more than the {self._most:.0f} of distance"
        for sense, on in switches.items():
            if not on:
                self._edges.pop(sense, None)
                continue
            edge, speed_there = self._edges.setdefault(sense, (position, speed))
            beyond = sense * (position - edge)
            braking = BRAKING_SHARE * speed_there**2 / (2 * self._acceleration)
            if beyond > braking + BRAKING_CYCLES * self._period_s * speed + 1:
                end = "positive" if sense > 0 else "negative"
                return f"it goes on behind the {end} limit switch, {beyond} increments by now"
        return ""

    def _speed(self, position: int) -> float:
        """Returns the larger of the speed in the last cycle and the average speed [increments/s]."""
        compared = [self._before[-1], self._before[0]] if self._before else []
        per_cycle = [abs(position - before) / (self._cycle - cycle) for before, cycle in compared]
        return max(per_cycle, default=0.0) / self._period_s


class DriveHoming:
    """The homing of a drive, which may be repeated; the drive is in operation meanwhile.

    watch: None: the motion of the drive is not supervised."""

    def __init__(self, described: Mapping[str, Any], watch: Watch | None = None) -> None:
        self.method: int = described["method"]
        self.watch = watch
        self.within_s = float(described["within_s"])
        self.homed = False
        self.failed = ""  # the reason; "": it has not failed
        self.interrupted()

    def interrupted(self) -> None:
        """Call while the drive is not in operation: the next homing starts from the beginning."""
        self._begin_s: float | None = None
        self._cycles = 0  # in the mode
        if self.watch is not None:
            self.watch.begin()

    @property
    def under_way(self) -> bool:
        return self._begin_s is not None and not self.homed and not self.failed

    @property
    def moves(self) -> bool:
        """Homing was commanded and has not succeeded yet."""
        return self._begin_s is not None and not self.homed

    def forget(self) -> None:
        """Forgets a former homing, as after a restart of the drive."""
        self.homed, self.failed = False, ""
        self.interrupted()

    def control_bits(self, status: int, mode: int, now_s: float) -> int:
        """Returns bits of the control word for this cycle.

        mode: reported by the drive (0x6061)."""
        if self._begin_s is None:
            self._begin_s = now_s
        elapsed_s = now_s - self._begin_s
        if elapsed_s > self.within_s:
            self.failed = f"it has not ended within {self.within_s:g} s"
        if mode != Mode.HOMING:
            if elapsed_s > MODE_WITHIN_S:
                self.failed = (
                    f"the drive has not changed to the mode hm within {MODE_WITHIN_S:g} s, it says mode {mode}"
                )
            return 0
        self._cycles += 1
        if self._cycles <= QUIET_CYCLES:
            return 0
        if self._cycles > QUIET_CYCLES + ANSWER_CYCLES:
            if status & FOLLOWING_ERROR_BIT:
                self.failed = f"the drive reports a homing error (status word 0x{status:04X})"
            elif status & FOLLOWS_BIT and status & TARGET_REACHED_BIT:
                self.homed = True
        return HOMING_START_BIT


def watch_of(described: Mapping[str, Any], axis: Mapping[str, Any], scaling: Scaling, period_s: float) -> Watch:
    """Returns the supervision for the `homing` of a machine file; if that has no acceleration, the axis' deceleration
    or acceleration limit is used."""
    per_unit = float(axis["encoder"]["increments_per_unit"]) * float(scaling.increments_per_count)
    limits, distance = axis["limits"], described.get("distance")
    acceleration = described.get("acceleration") or limits.get("deceleration") or limits["acceleration"]
    return Watch(None if distance is None else distance * per_unit, float(acceleration) * per_unit, period_s)


def homing_objects(
    described: Mapping[str, Any], axis: Mapping[str, Any], scaling: Scaling
) -> list[tuple[int, int, int, int]]:
    """Returns index, subindex, value and bits of the objects to write for the `homing` of a machine file."""
    counts = float(axis["encoder"]["increments_per_unit"])
    written = [(0x6098, 0, int(described["method"]), 8)]
    for key, index, subindex in (
        ("velocity_switch", 0x6099, 1),
        ("velocity_pulse", 0x6099, 2),
        ("acceleration", 0x609A, 0),
    ):
        if described.get(key) is not None:
            written.append((index, subindex, max(1, scaling.velocity(described[key] * counts)), 32))
    return written
