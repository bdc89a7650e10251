"""What becomes of a command: Busy -> Active -> Done | Aborted | Error, once."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import TYPE_CHECKING, Literal

from takt.errors import CommandError, TimeoutError, seconds

if TYPE_CHECKING:
    from takt.component import Component
    from takt.session import Session

Place = tuple[str, int]  # file and line
Until = Literal["final", "done", "active", "reached"]

DEFAULT_TIMEOUT_S = 60.0
QUEUE_FULL = 3012  # error number: the command may be given again


class FeedbackState(IntEnum):
    BUSY = 0  # accepted, waiting for its turn
    ACTIVE = 1  # in control
    DONE = 2  # final: reached what it was for
    ABORTED = 3  # final: another command or a fault took over
    ERROR = 4  # final: refused or failed


class Feedback:
    """One command that was given. Changes while the session steps or receives; ends in exactly one of Done, Aborted,
    Error."""

    def __init__(self, session: Session, target: str, verb: str, arguments: str, *, level_sensitive: bool) -> None:
        self._session = session
        self.target = target  # the name of a component, or "machine"
        self.verb = verb
        self.arguments = arguments  # as given to the engine
        self.level_sensitive = level_sensitive  # acts until `release`d
        self.given_at: tuple[Place, ...] = ()  # where the program gave it, the innermost call first
        self.ticket = 0  # the engine's number of the command; 0: refused
        self.reached = False  # a command that never ends by itself has what it was given for
        self.cycle = -1  # of the last change; -1: before the command came to a cycle
        self.travel_time_s = 0.0  # s, how long the motion takes as planned when it began; 0: not known (AX-96)
        self.value = 0.0  # what a command was to read or capture, has covered, or (movers) s it took, once it has ended
        self.object: Component | None = None  # that is in the way: a mover, a track, an environment ...
        self.released = False  # let go of, whether or not the engine has taken up the release yet
        self._release: Feedback | None = None  # the last try to
        self._state = FeedbackState.BUSY
        self._error_id = 0
        self._sentence = ""
        self._refused = False  # an error before it ever came to control anything
        self._heeded = False  # the program has asked what became of it when it was final

    @property
    def state(self) -> FeedbackState:
        """What has become of it so far."""
        self._heeded |= self._final
        return self._state

    @property
    def error_id(self) -> int:
        """Number of what went wrong; 0: nothing has."""
        self._heeded |= self._final
        return self._error_id

    @property
    def sentence(self) -> str:
        """What went wrong; empty while nothing has."""
        self._heeded |= self._final
        return self._sentence

    @property
    def busy(self) -> bool:
        """Not final yet, in control or not."""
        return self.state in (FeedbackState.BUSY, FeedbackState.ACTIVE)

    @property
    def active(self) -> bool:
        return self.state is FeedbackState.ACTIVE

    @property
    def done(self) -> bool:
        return self.state is FeedbackState.DONE

    @property
    def aborted(self) -> bool:
        return self.state is FeedbackState.ABORTED

    @property
    def error(self) -> bool:
        return self.state is FeedbackState.ERROR

    @property
    def final(self) -> bool:
        return not self.busy

    @property
    def time_s(self) -> float:
        """Engine time of the last change; NaN before the command came to a cycle."""
        return self.cycle * self._session.period if self.cycle >= 0 else math.nan

    @property
    def text(self) -> str:
        """The command for people: "x.move_absolute {position: 100.0}"."""
        return f"{self.target}.{self.verb} {self.arguments}".rstrip()

    def __repr__(self) -> str:
        end = f", {self.sentence}" if self.sentence else ""
        return f"<Feedback {self.text}: {self.state.name.lower()}{', reached' if self.reached else ''}{end}>"

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S, *, until: Until = "final") -> Feedback:
        """Lets engine time pass until the command is final ("final", "done"), in control ("active") or has what it was
        given for ("reached"), `timeout` in seconds of engine time. Raises CommandError on an error or when it is
        aborted (an active command has been active: that is no error for "active"), TimeoutError when nothing of that
        happens in time."""
        if until not in ("final", "done", "active", "reached"):
            raise ValueError(f"until is one of final, done, active, reached, not {until!r}")

        def arrived() -> bool:
            return self.final or (until == "active" and self.active) or (until == "reached" and self.reached)

        self._wait(arrived, timeout, until)
        if self.error or self.aborted:
            raise CommandError(self)
        return self

    def wait_final(self, timeout: float = DEFAULT_TIMEOUT_S) -> Feedback:
        """As `wait`, but an abort or an error is an answer like any other."""
        self._wait(lambda: self.final, timeout, "final")
        return self

    def release(self) -> Feedback:
        """Lets go of a level-sensitive command (jog, stop with hold). The feedback of the release itself. While the
        engine's queue is full it is refused, and given again by itself until the engine takes it."""
        return self._session._release(self)

    @property
    def _lets_go_of_another(self) -> bool:
        """Whether it is the release of a level-sensitive command; movers have a command `release` of their own."""
        return self.target == "machine" and self.verb == "release"

    @property
    def _release_is_settled(self) -> bool:
        """The release has done what it can: it need not be given again."""
        return self._release is not None and self._release._final and self._release._error_id != QUEUE_FULL

    @property
    def _release_is_refused(self) -> bool:
        return self._release is not None and self._release._error_id == QUEUE_FULL

    @property
    def _final(self) -> bool:
        return self._state > FeedbackState.ACTIVE

    @property
    def _done(self) -> bool:
        return self._state is FeedbackState.DONE

    @property
    def _ignored(self) -> bool:
        """Refused, and the program has not asked."""
        return self._refused and not self._heeded

    def _wait(self, arrived: Arrived, timeout: float, until: str) -> None:
        if not self._session._wait_for(arrived, seconds(timeout, "a timeout"), on_feedback=True):
            what = self.state.name.lower() if until == "final" else f"{self.state.name.lower()}, not {until}"
            raise TimeoutError(f"{self.text}: still {what} after {timeout:g} s")
        self._session._catch_up(self.cycle)

    def _update(self, state: int, reached: bool, error_id: int, sentence: str, cycle: int, value: float = 0.0) -> bool:
        """Takes over a report. False: it says nothing new (final states stay)."""
        new = FeedbackState(state)
        if self._final or new < self._state or (new, reached) == (self._state, self.reached):
            return False
        self._refused = new is FeedbackState.ERROR and self._state is FeedbackState.BUSY
        self._error_id = error_id
        self._sentence = sentence or ("aborted by another command" if new is FeedbackState.ABORTED else "")
        self.cycle = cycle
        self.reached = reached or self.reached
        if new is FeedbackState.ACTIVE and not math.isnan(value) and not reached:
            self.travel_time_s = value
        elif new > FeedbackState.ACTIVE:
            self.value = value
        self._state = new  # last: who sees it on another thread sees the rest too
        return True


if TYPE_CHECKING:
    from collections.abc import Callable

    Arrived = Callable[[], bool]
