"""Homing by a drive itself (CiA 402, mode hm): what is written for it, and how it is carried out (AX-87).

The drive counts from its reference afterwards, so its position jumps. The axis does not: the engine hears the position
go on as before, and is told the reference as an index pulse.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any, Final

from takt.drives.cia402 import FOLLOWING_ERROR_BIT, FOLLOWS_BIT, HOMING_START_BIT, TARGET_REACHED_BIT, Mode
from takt.drives.scaling import Scaling

MODE_WITHIN_S: Final = 1.0  # from the request for the mode to the mode
QUIET_CYCLES: Final = 2  # in the mode without the start bit, which counts by its edge
ANSWER_CYCLES: Final = 4  # from the start bit to a status word that is about it
BRAKING_SHARE: Final = 2.0  # times the braking distance: how far behind a limit switch a drive may come to rest
BRAKING_CYCLES: Final = 4  # and that many cycles until it brakes
AVERAGED_SAMPLES: Final = 8  # of the speed: on a busy computer single positions are late, or come in pairs


class Watch:
    """That a drive which homes stays where it may be: it comes to rest behind a limit switch, and does not go too far.
    All in increments, with the sense of the axis.

    most: how far from where it began; None: anywhere.
    acceleration: increments/s²."""

    def __init__(self, most: float | None, acceleration: float, period_s: float) -> None:
        self._most, self._acceleration, self._period_s = most, acceleration, period_s
        self.begin()

    def begin(self) -> None:
        self._from: int | None = None
        self._before: deque[tuple[int, int]] = deque(maxlen=AVERAGED_SAMPLES)  # positions, each with its cycle
        self._cycle = 0
        self._edges: dict[int, tuple[int, float]] = {}  # by sense: where its switch came on, and the speed there

    def look(self, position: int, switches: Mapping[int, bool], cycles: int = 1) -> str:
        """Once a cycle, or after so many; "": all is well, else why the drive must stop.

        switches: by sense, -1 and 1, whether the limit switch at that end is on."""
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
        """Of the last cycle, or on average, whichever is more; increments/s."""
        compared = [self._before[-1], self._before[0]] if self._before else []
        per_cycle = [abs(position - before) / (self._cycle - cycle) for before, cycle in compared]
        return max(per_cycle, default=0.0) / self._period_s


class DriveHoming:
    """One homing of a drive after the other; the drive is in operation meanwhile.

    watch: None: what the drive does is its own affair."""

    def __init__(self, described: Mapping[str, Any], watch: Watch | None = None) -> None:
        self.method: int = described["method"]
        self.watch = watch
        self.within_s = float(described["within_s"])
        self.homed = False
        self.failed = ""  # why; "": it has not
        self.interrupted()

    def interrupted(self) -> None:
        """The drive is not in operation: the next homing starts anew."""
        self._begin_s: float | None = None
        self._cycles = 0  # in the mode
        if self.watch is not None:
            self.watch.begin()

    @property
    def under_way(self) -> bool:
        return self._begin_s is not None and not self.homed and not self.failed

    @property
    def moves(self) -> bool:
        """The drive was told to home, and has not ended by itself."""
        return self._begin_s is not None and not self.homed

    def forget(self) -> None:
        """The drive has started anew."""
        self.homed, self.failed = False, ""
        self.interrupted()

    def control_bits(self, status: int, mode: int, now_s: float) -> int:
        """Bits of the control word in this cycle.

        mode: that the drive says it is in (0x6061)."""
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
    """For the `homing` of a machine file; what it does not say of braking is as the axis does it."""
    per_unit = float(axis["encoder"]["increments_per_unit"]) * float(scaling.increments_per_count)
    limits, distance = axis["limits"], described.get("distance")
    acceleration = described.get("acceleration") or limits.get("deceleration") or limits["acceleration"]
    return Watch(None if distance is None else distance * per_unit, float(acceleration) * per_unit, period_s)


def homing_objects(
    described: Mapping[str, Any], axis: Mapping[str, Any], scaling: Scaling
) -> list[tuple[int, int, int, int]]:
    """Index, subindex, value and bits of what is written for the `homing` of a machine file."""
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
