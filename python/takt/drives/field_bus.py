"""Common base of the field buses for an engine: cycle time, clock, and statistics of the cycles."""

from __future__ import annotations

import itertools
from abc import abstractmethod
from collections import deque
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, Final, Protocol

from takt import drive
from takt.counted import counted
from takt.drives import objects as od
from takt.drives.cia402 import MODE_NAMES, Mode
from takt.drives.emulation_commands import CLOCK, CLOCK_IS_SYNC
from takt.drives.homing import DriveHoming, watch_of
from takt.drives.probe import ProbeLatch, latches
from takt.drives.scaling import Scaling
from takt.drives.sdo import Objects, SdoError
from takt.errors import TaktError

ANSWERS_WITHIN: Final = 0.9  # of a period, in real time
ANSWERS_WITHIN_S: Final = 1.0  # in simulated time


class Member(Protocol):
    """A drive on a bus."""

    emulated: bool

    @property
    def named(self) -> str: ...


def interpolation_period(period_s: float) -> tuple[int, int] | None:
    """Returns value (1 to 255) and exponent (-6 to -3) of 0x60C2, whose period is value * 10^exponent [s]; None if no
    such pair gives the period."""
    period_us = round(1e6 * period_s)
    for exponent in (-3, -4, -5, -6):
        value, rest = divmod(period_us, 10 ** (6 + exponent))
        if rest == 0 and 0 < value <= 0xFF:
            return value, exponent
    return None


def lacks(described: Mapping[str, Any], sdo: Objects, modes: Collection[Mode]) -> str:
    """Returns what a drive lacks of the functions that its entry in the machine file requires; "" if nothing."""
    if described.get("homing") and Mode.HOMING not in modes:
        has = ", ".join(MODE_NAMES[m] for m in sorted(modes)) or "none"
        return f"does not have the mode hm, which homing asks for; it has {has}"
    number = described["probe_latch"]
    for entry in (od.PROBE_FUNCTION, od.PROBE_STATUS, *latches(number)) if number else ():
        if sdo.find(entry.index) is None:
            return f"does not have 0x{entry.index:04X} ({entry.name}), which probe_latch: {number} asks for"
    return ""


def extras_of(
    described: Mapping[str, Any], axis: Mapping[str, Any], scaling: Scaling, period_s: float
) -> dict[str, Any]:
    """Returns keyword arguments of a DriveAxis for an entry in the machine file."""
    homing, number = described.get("homing"), described["probe_latch"]
    counts = float(axis["limits"]["velocity"]) * float(axis["encoder"]["increments_per_unit"]) * period_s
    sense = -1 if axis["encoder"]["invert"] else 1
    return {
        "homing": DriveHoming(homing, watch_of(homing, axis, scaling, period_s)) if homing else None,
        "limit_senses": {
            "limit_negative": (-sense, bool(axis["inputs"]["invert_limit_negative"])),
            "limit_positive": (sense, bool(axis["inputs"]["invert_limit_positive"])),
        },
        "probe": ProbeLatch(number) if number else None,
        "period_s": period_s,
        "largest_step": counts * float(scaling.increments_per_count) + 1,
    }


class FieldBus(drive.Bus):
    """The drives of one bus of a machine file."""

    rhythm: str  # what is sent once a cycle

    def __init__(self, described: Mapping[str, Any], machine: Mapping[str, Any], say: Callable[[str], None]) -> None:
        self.described = described
        self.period_s = float(machine["cycle"]["period_s"])
        self._say = say
        self._said: set[str] = set()  # sentences that are reported only once
        self._simulated = False
        self.cycles = 0
        self.late = 0  # answers of drives that were late or lost
        self.sent_s: deque[float] = deque(maxlen=200_000)  # in real time: when `rhythm` was sent
        self.round_trips_s: deque[float] = deque(maxlen=200_000)  # from the first message to the last answer

    @property
    def bus_name(self) -> str:
        return str(self.described["bus"])

    @property
    @abstractmethod
    def members(self) -> Sequence[Member]:
        """All drives."""

    @abstractmethod
    def _tell_clock(self, simulated: bool) -> None:
        """Switches emulated drives to the engine's simulated time, or to the clock."""

    def _tell_clock_of(self, one: Member, objects: Objects, simulated: bool) -> None:
        try:
            objects.write(*CLOCK, CLOCK_IS_SYNC if simulated else 0, 8)
        except SdoError as error:
            raise TaktError(f"{self.bus_name}: {one.named}: {error}") from None

    def _tell_interpolation_period(self, one: Member, objects: Objects) -> None:
        """Writes 0x60C2 (CiA 402) if the drive has it."""
        period = interpolation_period(self.period_s)
        if period is not None:
            value, exponent = period
            if objects.try_to_write(0x60C2, 2, exponent, 8):
                objects.try_to_write(0x60C2, 1, value, 8)
        elif objects.find(0x60C2, 1) is not None:
            self._say(
                f"{one.named}: 0x60C2 cannot hold the cycle of {1e6 * self.period_s:.6g} us (1 to 255 times 1, 10, 100 "
                f"or 1000 us): the drive keeps its interpolation period"
            )

    def _say_once(self, sentence: str) -> None:
        if sentence not in self._said:
            self._said.add(sentence)
            self._say(sentence)

    def start(self, axis: str, *, real_time: bool, period_s: float) -> None:
        if abs(period_s - self.period_s) > 1e-9:
            raise TaktError(
                f"the engine's cycle is {1000 * period_s:g} ms, the machine file's {1000 * self.period_s:g} ms"
            )
        if real_time is not self._simulated:
            return
        metal = [one for one in self.members if not one.emulated]
        if not real_time and metal:
            raise TaktError(
                f"{metal[0].named} is no emulated drive and has a clock of its own, but the engine runs in simulated "
                f"time; run taktd --pace real"
            )
        self._tell_clock(not real_time)
        self._simulated = not real_time

    def _answers_within_s(self, real_time: bool) -> float:
        return ANSWERS_WITHIN * self.period_s if real_time else ANSWERS_WITHIN_S

    def summary(self) -> str:
        """Returns the statistics of the cycles in a line."""
        said = f"{self.bus_name}: {counted(self.cycles, 'cycle')}, {counted(self.late, 'answer')} late or lost"
        said += self._also_lost()
        if len(self.sent_s) > 2:
            sent = list(self.sent_s)
            periods = sorted(b - a for a, b in itertools.pairwise(sent))
            trips = sorted(self.round_trips_s)
            low, middle, high = (1000 * periods[int(q * (len(periods) - 1))] for q in (0.01, 0.5, 0.99))
            trip, worst = (1000 * trips[int(q * (len(trips) - 1))] for q in (0.5, 0.99))
            said += (
                f"; {self.rhythm} every {middle:.3f} ms (1 % below {low:.3f}, 1 % above {high:.3f}); from set points "
                f"to answers {trip:.3f} ms, 1 % above {worst:.3f}"
            )
        return said

    def _also_lost(self) -> str:
        return ""
