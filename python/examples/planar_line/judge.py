"""What came of the line, found in a recording: pieces, how busy the stations were, and why movers waited."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from line import STATIONS, TEST
from takt.recording import Recording

WORKS = "the line works"
ENDS = "the line ends"
SECTION_MM = 500.0  # of a track, by which places of waiting are told

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Judgement:
    seconds: float
    movers: tuple[str, ...]
    pieces_s: tuple[float, ...]  # when each was tested
    busy: dict[str, float]  # by station: share of the time in which a mover is worked on
    going: float  # share of the movers' time
    worked_on: float  # likewise
    held_by: dict[str, float]  # likewise, by the station behind which they wait, or nearest before which
    # By level, X and Y: a place for each sample of a mover that waits for another one or for the lift.
    waited_at: tuple[tuple[Array, Array], ...]
    nearest: float  # mm between the middles of two movers, the larger of both coordinates
    deadlocked: bool

    @property
    def pieces_a_minute(self) -> float:
        return 60 * len(self.pieces_s) / self.seconds

    @property
    def sentence(self) -> str:
        busy = ", ".join(f"{name} {100 * share:.0f} %" for name, share in self.busy.items())
        held = ", ".join(f"{name} {100 * share:.0f} %" for name, share in self.held_by.items())
        return (
            f"{len(self.pieces_s)} pieces in {self.seconds:.0f} s, {self.pieces_a_minute:.1f} a minute; busy: {busy}; "
            f"movers go {100 * self.going:.0f} % of their time, are worked on {100 * self.worked_on:.0f} %, "
            f"wait before {held}; nearest two {self.nearest:.1f} mm"
        )


def judge(recording: Recording) -> Judgement:
    marks = {event.text: event.time_s for event in recording.events if event.kind == "mark"}
    begin, end = marks[WORKS], marks[ENDS]
    movers = tuple(name for name in recording.components if "waits_for" in recording.fields(name))
    tracks = [name for name in recording.components if "closed_loop" in recording.fields(name)]
    at_all = recording.column(movers[0], "time_s")
    inside = (at_all >= begin) & (at_all <= end)
    time = at_all[inside]
    cycles = recording.column(movers[0], "cycle")[inside]
    # Of each mover where it was then, and what it had said last: over LCM each has cycles of its own.
    said = {name: np.searchsorted(recording.column(name, "cycle"), cycles, "right") - 1 for name in movers}

    def all_of(signal: str) -> Array:
        return np.array([recording.column(name, signal)[said[name]] for name in movers], dtype=np.float64)

    def then(signal: str) -> Array:
        columns = [(recording.column(name, "time_s"), recording.column(name, signal)) for name in movers]
        return np.array([np.interp(time, *column) for column in columns])

    x, y, track, along = then("x"), then("y"), all_of("track"), all_of("track_position")
    codes = {name: code for code, name in recording.names(movers[0], "delay").items()}
    delay = all_of("delay")
    level, speed = all_of("coordinate_system"), all_of("track_velocity")
    worked, waits = delay == codes["time"], delay == codes["mover"]
    at_lift = ~worked & ~waits & (speed == 0)
    held: Counter[str] = Counter()
    at = {station: np.zeros_like(worked) for station in STATIONS}
    for station in STATIONS:
        here = track == tracks.index(station.track) + 1
        at[station] = worked & here & (np.abs(along - station.position) < 1)
        held[station.name] = int(np.sum(waits & here & (along <= station.position)))
    known = sum(held.values())
    held["where lanes meet"] = int(np.sum(waits)) - known
    held["the lift"] = int(np.sum(at_lift))
    ended = at[TEST][:, :-1] & ~at[TEST][:, 1:]
    return Judgement(
        seconds=end - begin,
        movers=movers,
        pieces_s=tuple(np.sort(time[np.nonzero(ended)[1]]) - begin),
        busy={station.name: float(np.mean(at[station].any(axis=0))) for station in STATIONS},
        going=float(np.mean(~worked & ~waits & ~at_lift)),
        worked_on=float(np.mean(worked)),
        held_by={name: count / waits.size for name, count in held.items()},
        waited_at=tuple((x[there], y[there]) for i in (1, 2) for there in [(waits | at_lift) & (level == i)]),
        nearest=nearest(x, y, level),
        deadlocked=bool(all_of("deadlocked")[:, 2:].any()),
    )


def nearest(x: Array, y: Array, level: Array) -> float:
    """mm: the least, over time, of the larger of both distances between two middles; bodies are squares."""
    least = np.inf
    for i in range(len(x)):
        apart = np.maximum(np.abs(x[i + 1 :] - x[i]), np.abs(y[i + 1 :] - y[i]))
        least = min(least, float(apart.min(initial=np.inf, where=level[i + 1 :] == level[i])))
    return least
