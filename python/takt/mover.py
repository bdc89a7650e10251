"""One planar mover of a session: it floats over stators and moves in six coordinates."""

from __future__ import annotations

from dataclasses import dataclass

from takt._commands import MoverCommands, MoverOutputs
from takt.component import Component
from takt.errors import TaktError
from takt.feedback import FeedbackState
from takt.recording import FloatArray
from takt.tables import named
from takt.trail import TrackTrail


@dataclass(frozen=True)
class MoverRecord:
    """A command of a mover and what became of it."""

    ticket: int
    verb: str
    state: FeedbackState
    error_id: int  # 0: none
    cycle: int  # that took the command
    begun: int  # cycle in which it began; of buffered ones later than it was given
    changed: int  # cycle in which it came to be what it is
    object: Component | None  # that was in the way
    limited_by: str  # what of its dynamics was more than the mover can do, and was reduced


class Mover(Component, MoverCommands, MoverOutputs):
    """A planar mover."""

    KIND = "mover"

    def __repr__(self) -> str:
        return f"<Mover {self.name}: {self.state.value}, {self.command_mode.value} at ({self.x:.6g}, {self.y:.6g})>"

    @property
    def position_on_current_part(self) -> tuple[float, float, float]:
        """X, Y (mm) and C (deg), X and Y in the coordinates of the part that its middle is on."""
        if self.part == 0:
            raise TaktError(f"mover {self.name} is on no part")
        part = list(self.session.parts.values())[self.part - 1]
        return self.x - part.x, self.y - part.y, self.c

    @property
    def blocked_by(self) -> Component | None:
        """What it waits for: a mover, the axis that is its master, a track that ends, a part. None: nothing."""
        return self.session._object_of(str(self.blocker_kind), self.blocker)

    def track_trail(self) -> TrackTrail:
        """The tracks along which its command leads it, that where it is first; of one that stands on a track and is to
        stay: that alone. Empty: it is on no track. A track that it comes back to is named once."""
        tracks = list(self.session.tracks)
        return TrackTrail(dict.fromkeys(tracks[number] for number in self.session._trail(self)))

    def surface_route(self) -> FloatArray:
        """The rest of its route over the free surface: the centres of its places, (n, 2) [mm], from the last one that
        the mover has reached to the target. The first `route_granted` - `route_visit` behind that one are granted.
        Empty if `on_route` is false. Over LCM a new route appears with the next message about it."""
        first, places = self.session._route(self)
        return places[min(max(self.route_visit - first, 0), len(places)) :]

    def history(self) -> tuple[MoverRecord, ...]:
        """Its last 100 commands, the oldest first; external set points apart. Over LCM: those of all clients since this
        session was connected."""
        rows = self.session._history(self)
        return tuple(
            MoverRecord(
                ticket,
                verb,
                FeedbackState(state),
                error,
                cycle,
                begun,
                changed,
                self.session._object(*where),
                named("mover", "limited_by", limited),
            )
            for ticket, verb, state, error, cycle, begun, changed, *where, limited in rows
        )
