"""Feedback of a command: Busy -> Active -> Done | Aborted | Error; a final state does not change."""

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
QUEUE_FULL = 3012  # error number; the command may be retried


class FeedbackState(IntEnum):
    BUSY = 0  # accepted, not in control yet
    ACTIVE = 1  # in control
    DONE = 2  # final: completed
    ABORTED = 3  # final: another command or a fault took over
    ERROR = 4  # final: refused or failed


class Feedback:
    """The feedback of one command. It is updated while the session steps or receives, and ends in exactly one of Done,
    Aborted, Error."""

    def __init__(self, session: Session, target: str, verb: str, arguments: str, *, level_sensitive: bool) -> None:
        self._session = session
        self.target = target  # the name of a component, or "machine"
        self.verb = verb
        self.arguments = arguments  # as given to the engine
        self.level_sensitive = level_sensitive  # acts until `release`d
        self.given_at: tuple[Place, ...] = ()  # call stack of the program that gave it, innermost call first
        self.ticket = 0  # the engine's number of the command; 0: refused
        self.reached = False  # a command that does not end by itself has reached its goal
        self.cycle = -1  # of the last change; -1: no cycle has processed the command yet
        self.travel_time_s = 0.0  # s, duration of the motion as planned at its start; 0: not known (AX-96)
        self.value = 0.0  # after the end: the value read or captured, distance covered, or (movers) s it took
        self.object: Component | None = None  # the obstructing mover, track, environment ...
        self.released = False  # release requested, whether or not the engine has applied it yet
        self._release: Feedback | None = None  # the last attempt to release it
        self._state = FeedbackState.BUSY
        self._error_id = 0
        self._sentence = ""
        self._refused = False  # failed before it was in control
        self._heeded = False  # the program has read its result after it was final

    @property
    def state(self) -> FeedbackState:
        """The current state."""
        self._heeded |= self._final
        return self._state

    @property
    def error_id(self) -> int:
        """The error number; 0: no error."""
        self._heeded |= self._final
        return self._error_id

    @property
    def sentence(self) -> str:
        """The reason of an error or abort as a sentence; empty otherwise."""
        self._heeded |= self._final
        return self._sentence

    @property
    def busy(self) -> bool:
        """Whether the command is not final: Busy or Active."""
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
        """Engine time [s] of the last change; NaN before a cycle has processed the command."""
        return self.cycle * self._session.period if self.cycle >= 0 else math.nan

    @property
    def text(self) -> str:
        """The command as readable text: "x.move_absolute {position: 100.0}"."""
        return f"{self.target}.{self.verb} {self.arguments}".rstrip()

    def __repr__(self) -> str:
        end = f", {self.sentence}" if self.sentence else ""
        return f"<Feedback {self.text}: {self.state.name.lower()}{', reached' if self.reached else ''}{end}>"

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S, *, until: Until = "final") -> Feedback:
        """Lets engine time pass until the command reaches a state. Returns this feedback.

        timeout: engine time [s].
        until: "final" or "done": the command is final; "active": it is in control; "reached": it has reached its goal,
            for commands that do not end by themselves. A final command ends every wait.

        Raises CommandError if the command is in error or aborted then, TimeoutError if the state is not reached within
        `timeout`.
        """
        if until not in ("final", "done", "active", "reached"):
            raise ValueError(f"until is one of final, done, active, reached, not {until!r}")

        def arrived() -> bool:
            return self.final or (until == "active" and self.active) or (until == "reached" and self.reached)

        self._wait(arrived, timeout, until)
        if self.error or self.aborted:
            raise CommandError(self)
        return self

    def wait_final(self, timeout: float = DEFAULT_TIMEOUT_S) -> Feedback:
        """As `wait`, but does not raise if the command is aborted or in error. Returns this feedback."""
        self._wait(lambda: self.final, timeout, "final")
        return self

    def release(self) -> Feedback:
        """Releases a level-sensitive command (jog, stop with hold). Returns the feedback of the release. A release that
        is refused because the engine's queue is full is retried automatically until the engine accepts it."""
        return self._session._release(self)

    @property
    def _lets_go_of_another(self) -> bool:
        """Whether this is the release of a level-sensitive command (movers have a command `release` of their own)."""
        return self.target == "machine" and self.verb == "release"

    @property
    def _release_is_settled(self) -> bool:
        """Whether the release is final and need not be retried."""
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
        """Whether the command was refused and the program has not read its result."""
        return self._refused and not self._heeded

    def _wait(self, arrived: Arrived, timeout: float, until: str) -> None:
        if not self._session._wait_for(arrived, seconds(timeout, "a timeout"), on_feedback=True):
            what = self.state.name.lower() if until == "final" else f"{self.state.name.lower()}, not {until}"
            raise TimeoutError(f"{self.text}: still {what} after {timeout:g} s")
        self._session._catch_up(self.cycle)

    def _update(self, state: int, reached: bool, error_id: int, sentence: str, cycle: int, value: float = 0.0) -> bool:
        """Applies a report of the engine. Returns False if it changes nothing (final states do not change)."""
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
        self._state = new  # last: another thread that sees it sees the other values too
        return True


if TYPE_CHECKING:
    from collections.abc import Callable

    Arrived = Callable[[], bool]
