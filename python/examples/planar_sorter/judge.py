"""What came of the sorter, found in a recording: what was delivered, what movers did with their time, and for whom they
waited."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from sorter import LOADING, PITCH
from takt.recording import Recording

WORKS = "sorting begins"
ENDS = "sorting ends"
TRAYS = ("red", "blue")
STANDS = 1.0  # mm/s

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Judgement:
    seconds: float
    movers: tuple[str, ...]
    delivered_s: dict[str, Array]  # by tray: when each product was taken away
    shares: dict[str, float]  # what movers do with their time
    held_s: dict[str, float]  # by reason: mover seconds on the way
    stood_at: tuple[Array, Array]  # X and Y, a place for each sample of a mover that stands on the floor
    ways: tuple[tuple[Array, Array], ...]  # of some movers
    nearest: float  # mm between the middles of two movers, the larger of both coordinates

    @property
    def products_a_minute(self) -> float:
        return 60 * sum(len(times) for times in self.delivered_s.values()) / self.seconds

    @property
    def sentence(self) -> str:
        taken = ", ".join(f"{len(times)} {tray}" for tray, times in self.delivered_s.items())
        shares = ", ".join(f"{name} {100 * share:.0f} %" for name, share in self.shares.items())
        held = ", ".join(f"{name} {seconds:.0f} s" for name, seconds in self.held_s.items())
        return (
            f"{taken} in {self.seconds:.0f} s, {self.products_a_minute:.0f} a minute; movers {shares}; "
            f"held up on their way {held}; nearest two {self.nearest:.1f} mm"
        )


def judge(recording: Recording) -> Judgement:
    marks = {event.text: event.time_s for event in recording.events if event.kind == "mark"}
    begin, end = marks[WORKS], marks[ENDS]
    held = {
        found[1]: float(found[2]) for text in marks if (found := re.fullmatch(r"held up by (.*): ([\d.]+) s", text))
    }
    movers = tuple(name for name in recording.components if "waits_for" in recording.fields(name))
    at_all = recording.column(movers[0], "time_s")
    time = at_all[(at_all >= begin) & (at_all <= end)]

    def then(signal: str) -> Array:
        # Over LCM each mover has cycles of its own: what it said last.
        rows = []
        for name in movers:
            said = np.searchsorted(recording.column(name, "time_s"), time + 1e-9, "right") - 1
            rows.append(recording.column(name, signal)[said])
        return np.array(rows, dtype=np.float64)

    x, y, part = then("x"), then("y"), then("part")
    goes = np.hypot(then("velocity_x"), then("velocity_y")) > STANDS
    rides = part != 1
    loading = np.zeros_like(goes)
    for cell in LOADING:
        loading |= np.maximum(abs(x - PITCH * (cell[0] + 0.5)), abs(y - PITCH * (cell[1] + 0.5))) < 1
    stands = ~goes & ~rides
    shares = {
        "go": goes,
        "are loaded": stands & loading,
        "are on trays": ~goes & rides,
        "stand on the floor": stands & ~loading,
    }
    delivered = {}
    for tray in TRAYS:
        place, count = recording.column(tray, "position_index"), recording.column(tray, "mover_count")
        when = recording.column(tray, "time_s")
        arrives = np.flatnonzero((place[1:] == 2) & (place[:-1] != 2)) + 1
        delivered[tray] = np.repeat(when[arrives], count[arrives].astype(int)) - begin
    return Judgement(
        seconds=end - begin,
        movers=movers,
        delivered_s=delivered,
        shares={name: float(np.mean(at)) for name, at in shares.items()},
        held_s=held,
        stood_at=(x[stands & ~loading], y[stands & ~loading]),
        ways=tuple((x[i], y[i]) for i in range(0, len(movers), 20)),
        nearest=_nearest(x, y),
    )


def _nearest(x: Array, y: Array) -> float:
    """mm: the least, over time, of the larger of both distances between two middles; bodies are squares."""
    least = np.inf
    for i in range(len(x) - 1):
        least = min(least, float(np.maximum(abs(x[i + 1 :] - x[i]), abs(y[i + 1 :] - y[i])).min()))
    return least
