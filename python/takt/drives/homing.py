"""Homing by a drive itself (CiA 402, mode hm): what is written for it, and how it is carried out (AX-87).

The drive counts from its reference afterwards, so its position jumps. The axis does not: the engine hears the position
go on as before, and is told the reference as an index pulse.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from takt.drives.cia402 import FOLLOWING_ERROR_BIT, FOLLOWS_BIT, HOMING_START_BIT, TARGET_REACHED_BIT, Mode
from takt.drives.scaling import Scaling

MODE_WITHIN_S: Final = 1.0  # from the request for the mode to the mode
QUIET_CYCLES: Final = 2  # in the mode without the start bit, which counts by its edge
ANSWER_CYCLES: Final = 4  # from the start bit to a status word that is about it


class DriveHoming:
    """One homing of a drive after the other; the drive is in operation meanwhile."""

    def __init__(self, described: Mapping[str, Any]) -> None:
        self.method: int = described["method"]
        self.within_s = float(described["within_s"])
        self.homed = False
        self.failed = ""  # why; "": it has not
        self.interrupted()

    def interrupted(self) -> None:
        """The drive is not in operation: the next homing starts anew."""
        self._begin_s: float | None = None
        self._cycles = 0  # in the mode

    @property
    def under_way(self) -> bool:
        return self._begin_s is not None and not self.homed and not self.failed

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
