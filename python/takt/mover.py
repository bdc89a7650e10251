"""One planar mover of a session: it levitates above stators and moves in six coordinates."""

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
    """A command of a mover and its outcome."""

    ticket: int
    verb: str
    state: FeedbackState
    error_id: int  # 0: no error
    cycle: int  # in which the command was received
    begun: int  # cycle in which it became active; later than `cycle` for buffered commands
    changed: int  # cycle of the last change of its state
    object: Component | None  # the obstructing component
    limited_by: str  # the first of its dynamics that exceeded the mover's limits and was reduced


class Mover(Component, MoverCommands, MoverOutputs):
    """A planar mover."""

    KIND = "mover"

    def __repr__(self) -> str:
        return f"<Mover {self.name}: {self.state.value}, {self.command_mode.value} at ({self.x:.6g}, {self.y:.6g})>"

    @property
    def position_on_current_part(self) -> tuple[float, float, float]:
        """X, Y [mm] and C [deg], X and Y relative to the part of the surface below the mover's centre. Raises TaktError
        if the mover is on no part."""
        if self.part == 0:
            raise TaktError(f"mover {self.name} is on no part")
        part = list(self.session.parts.values())[self.part - 1]
        return self.x - part.x, self.y - part.y, self.c

    @property
    def blocked_by(self) -> Component | None:
        """The component that it waits for: a mover, its master axis, a track that ends, a part. None: it does not
        wait."""
        return self.session._object_of(str(self.blocker_kind), self.blocker)

    def track_trail(self) -> TrackTrail:
        """Returns the tracks along which its command leads, the current one first; only that one if the mover is at
        rest. Empty if it is on no track. A track that is visited again is named once."""
        tracks = list(self.session.tracks)
        return TrackTrail(dict.fromkeys(tracks[number] for number in self.session._trail(self)))

    def surface_route(self) -> FloatArray:
        """Returns the rest of its route over the free surface: positions [mm], shape (n, 2), from the last one that the
        mover has reached to the target. The `route_granted` - `route_visit` positions after the first row are granted.
        Empty if `on_route` is false. Over LCM a new route appears with its next message."""
        first, places = self.session._route(self)
        return places[min(max(self.route_visit - first, 0), len(places)) :]

    def history(self) -> tuple[MoverRecord, ...]:
        """Returns its last 100 commands, oldest first, without external set points. Over LCM: the commands of all
        clients since this session was connected."""
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
