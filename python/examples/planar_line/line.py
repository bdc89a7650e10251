"""The stations of the line, and who sends the movers round: each lap is a list of commands that wait in the mover."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import cycle

import takt
from lift import LOWER, UPPER, Lift


@dataclass(frozen=True)
class Station:
    name: str
    track: str
    position: float  # mm along it
    takes_s: float


LOADING = Station("loading", "supply", 1500.0, 0.5)
PRESSES = (Station("press 1", "press_1", 1500.0, 2.4), Station("press 2", "press_2", 1500.0, 2.4))
TEST = Station("test", "back", 5500.0, 0.8)
REPAIR = Station("repair", "repair", 1890.0, 6.0)
STATIONS = (LOADING, *PRESSES, TEST, REPAIR)
PAST = 8  # every so many-th mover has nothing to be pressed: it takes the bypass
BAD = 11  # every so many-th piece fails the test
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
        self._bad: set[str] = set()  # movers whose piece has failed the test, or will
        self._lift = Lift(session, {LOWER: self._repair, UPPER: self._send_round})
        session.program(self._step)

    def _go(self, mover: takt.Mover, station: Station) -> None:
        self._given[mover.name] += (
            mover.move_on_track(track=station.track, position=station.position, buffer_mode="buffered"),
            mover.wait(duration=station.takes_s),
        )

    def _send_round(self, mover: takt.Mover) -> None:
        self._bad.discard(mover.name)
        self._laps += 1
        self._go(mover, LOADING)
        if self._laps % PAST:
            self._go(mover, next(self._presses))
        self._go(mover, TEST)
        self._tests.add(self._given[mover.name][-1])
        if self._laps % BAD == 0:
            self._bad.add(mover.name)
            self._lift.call(mover, UPPER)

    def _repair(self, mover: takt.Mover) -> None:
        self._go(mover, REPAIR)
        self._lift.call(mover, LOWER)

    def _step(self) -> None:
        for name, given in self._given.items():
            while given and given[0].done:
                done = given.popleft()
                if done in self._tests:
                    self._tests.remove(done)
                    self.finished += 1
            if len(given) < AHEAD and name not in self._bad and not self.ends:
                self._send_round(self.session.mover(name))
        if not self.ends:
            self._lift.step()
