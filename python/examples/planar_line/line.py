"""The stations of the line, and who sends the movers round: each lap is a list of commands that wait in the mover."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import cycle

import takt


@dataclass(frozen=True)
class Station:
    name: str
    track: str
    position: float  # mm along it
    takes_s: float


LOADING = Station("loading", "supply", 1500.0, 0.5)
PRESSES = (Station("press 1", "press_1", 1500.0, 2.4), Station("press 2", "press_2", 1500.0, 2.4))
TEST = Station("test", "back", 5500.0, 0.8)
STATIONS = (LOADING, *PRESSES, TEST)
PAST = 8  # every so many-th mover has nothing to be pressed: it takes the bypass
AHEAD = 3  # so many commands a mover has before it at least


class Line:
    """Keeps all movers busy from now on, in step with the session's engine, until it is told to end."""

    def __init__(self, session: takt.Session) -> None:
        self.session = session
        self.finished = 0
        self.ends = False
        self._laps = 0
        self._presses = cycle(PRESSES)
        self._given: dict[str, deque[takt.Feedback]] = {name: deque() for name in session.movers}
        self._tests: set[takt.Feedback] = set()
        session.program(self._step)

    def _send_round(self, mover: takt.Mover) -> None:
        self._laps += 1
        way = [LOADING, TEST]
        if self._laps % PAST:
            way.insert(1, next(self._presses))
        given = self._given[mover.name]
        for station in way:
            given.append(mover.move_on_track(track=station.track, position=station.position, buffer_mode="buffered"))
            given.append(mover.wait(duration=station.takes_s))
        self._tests.add(given[-1])

    def _step(self) -> None:
        for name, given in self._given.items():
            while given and given[0].done:
                done = given.popleft()
                if done in self._tests:
                    self._tests.remove(done)
                    self.finished += 1
            if len(given) < AHEAD and not self.ends:
                self._send_round(self.session.mover(name))
