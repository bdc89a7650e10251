"""The lift between the line and the place of repair below it: it takes one mover at a time, down or up."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import takt

MIDDLE = 493.0  # mm along the way through the car
CLEAR = 250.0  # mm beyond the car, where the next one may come in


@dataclass(frozen=True)
class Level:
    position: int  # of the lift
    track: str  # on which movers wait for it ...
    place: float  # ... and where on that, mm
    leads_to: str  # track behind the car


UPPER = Level(1, "bad", 1200.0, "mended")
LOWER = Level(2, "repair", 3600.0, "repair")
MOST_BELOW = 3  # movers


class Lift:
    """Fetches who calls it. `arrived` gives a mover its next command when it is on the other level."""

    def __init__(self, session: takt.Session, arrived: dict[Level, Callable[[takt.Mover], None]]) -> None:
        self._part = session.part("lift")
        self._arrived = arrived
        self._numbers = {name: number for number, name in enumerate(session.tracks, 1)}
        self._coming: dict[Level, dict[takt.Mover, takt.Feedback]] = {UPPER: {}, LOWER: {}}
        self._below = 0
        self._program = self._run()

    def call(self, mover: takt.Mover, level: Level) -> None:
        """It goes to where movers wait for the lift, as soon as it has done what it was told before."""
        way = mover.move_on_track(track=level.track, position=level.place, buffer_mode="buffered")
        self._coming[level][mover] = way

    def step(self) -> None:
        """Once in a cycle."""
        next(self._program)

    def _run(self) -> Iterator[None]:
        here, there = UPPER, LOWER
        while True:
            mover = self._first(here)
            if mover and (here is LOWER or self._below < MOST_BELOW):
                del self._coming[here][mover]
                yield from self._until_done(lambda who=mover: who.move_on_track(track="car", position=MIDDLE))
                yield from self._go(there)
                self._below += 1 if there is LOWER else -1
                self._arrived[there](mover)
                while not self._has_left(mover, there):
                    yield
            elif self._first(there):
                yield from self._go(there)
            else:
                yield
                continue
            here, there = there, here

    def _first(self, level: Level) -> takt.Mover | None:
        return next((mover for mover, way in self._coming[level].items() if way.done), None)

    def _has_left(self, mover: takt.Mover, level: Level) -> bool:
        on = mover.track
        return on != self._numbers["car"] and (on != self._numbers[level.leads_to] or mover.track_position > CLEAR)

    def _go(self, level: Level) -> Iterator[None]:
        yield from self._until_done(lambda: self._part.activate_position(index=level.position))

    def _until_done(self, command: Callable[[], takt.Feedback]) -> Iterator[None]:
        """Again, if it is refused because somebody is in the way for a moment."""
        feedback = command()
        while not feedback.done:
            yield
            if feedback.final and not feedback.done:
                feedback = command()
