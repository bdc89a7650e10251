"""Commands that a page gives: only those named here, only where the machine file allows it.

Jogging goes on as long as the page says so (EN-23): each page is a client of the engine by itself, and its heartbeats
go out only while the page has said within the dead man's time that the button is still held. A page that hangs, is
closed or is cut off, a server that dies: whatever falls silent, the engine hears no heartbeat and lets go."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from takt import msgs
from takt.arguments import to_text
from takt.tables import KINDS
from takt.view.machine import Machine

# By kind of component: verbs with the arguments that a page may give.
ALLOWED: dict[str, dict[str, frozenset[str]]] = {
    "machine": {
        "emergency_stop": frozenset(),
        "stop_all": frozenset(),
        "begin_cam": frozenset({"name", "cyclic", "interpolation", "x_unit", "y_unit"}),
        "add_cam_points": frozenset({"cam", "first", "points"}),
        "build_cam": frozenset({"cam", "count"}),
    },
    "axis": {
        "power": frozenset({"enable"}),
        "reset": frozenset(),
        "halt": frozenset(),
        "jog": frozenset({"forward", "backward", "velocity"}),
    },
    "group": {
        **{verb: frozenset() for verb in ("enable", "disable", "reset", "halt")},
        "power": frozenset({"enable"}),
        "jog": frozenset({*"xyzabc", *(f"a{i}" for i in range(1, 9)), "coordinate_system"}),
    },
    "flex_cam": {
        "control": frozenset({"regulator_on", "reset_error", "halt"}),
        "set_cam": frozenset({"slot", "cam"}),
    },
    "pick_place": {"control": frozenset({"regulator_on", "reset_error", "path_halt"})},
    "mover": {verb: frozenset() for verb in ("enable", "disable", "reset", "halt")},
    "track": {verb: frozenset() for verb in ("enable", "disable", "reset")},
    "planar_group": {verb: frozenset() for verb in ("enable", "disable", "reset")},
}
HELD = {("axis", "jog"), ("group", "jog")}  # go on only while they are held
RESEND_S = 0.2  # between two tries of a command that is not answered
GIVEN_UP_S = 2.0
FINAL = 2  # from this state on a feedback is the last one
Tell = Callable[[dict[str, Any]], None]


class RefusedError(Exception):
    """Why a page may not give a command."""


@dataclass
class _Given:
    message: msgs.command
    began: float
    sent: float
    answered: bool = False
    ticket: int = 0
    held: bool = False  # goes on until it is let go of
    let_go: bool = False  # it is to be let go of as soon as it has a ticket


class Commander:
    """What one page commands. `tell` takes what becomes of it."""

    def __init__(self, network: Any, machine: Machine, tell: Tell) -> None:
        self._network = network
        self._machine = machine
        self._tell = tell
        self._client = f"page-{random.SystemRandom().getrandbits(40):010x}"
        self._session = random.SystemRandom().getrandbits(62) + 1
        self._dead_man_s = float(machine.parameters["lcm"]["dead_man_s"])
        self._last_id = 0
        self._given: dict[int, _Given] = {}
        self._held_at = 0.0  # when the page said last that it holds
        self._beat_at = 0.0

    def give(self, target: str, verb: str, arguments: Mapping[str, Any], now: float) -> None:
        """Gives a command, or raises RefusedError with a sentence."""
        if not self._machine.parameters["view"]["commands"]:
            raise RefusedError("the machine file does not let the page command: view: {commands: true}")
        source = self._machine.by_name.get(target)
        kind = source.kind if source else "machine"
        if source is None and target != "machine":
            raise RefusedError(f"there is no {target!r}")
        allowed = ALLOWED.get(kind, {}).get(verb)
        if allowed is None:
            raise RefusedError(f"the page gives no {verb!r} to a {kind.replace('_', ' ')}")
        if not arguments.keys() <= allowed:
            raise RefusedError(f"the page gives {verb} with {', '.join(sorted(allowed)) or 'no arguments'} alone")
        held = (kind, verb) in HELD
        if held:
            self.release()
            self._held_at = now
            self._beat(now)  # the name is known before the command needs it
        self._send(target, verb, to_text(arguments), now, held)

    def hold(self, now: float) -> None:
        """The button is still pressed."""
        self._held_at = now

    def release(self) -> None:
        """Lets go of what is held."""
        now = time.monotonic()
        for given in [one for one in self._given.values() if one.held]:
            given.held, given.let_go = False, True
            self._let_go(given, now)

    def tick(self, now: float) -> None:
        """Beats while something is held and the page says so; asks again what was not answered."""
        holding = any(one.held for one in self._given.values())
        if holding and now - self._held_at > self._dead_man_s:
            self.release()
        elif holding and now - self._beat_at >= self._dead_man_s / 4:
            self._beat(now)
        for number, given in list(self._given.items()):
            if given.answered:
                continue
            if now - given.began > GIVEN_UP_S:
                del self._given[number]
                self._say(given.message, "error", "the engine does not answer")
            elif now - given.sent > RESEND_S:
                given.sent = now
                self._network.publish("takt/command", given.message.encode())

    def take(self, message: msgs.feedback) -> None:
        """A feedback that passed by."""
        if message.client != self._client or message.session != self._session:
            return
        given = self._given.get(message.id)
        if given is None:
            return
        given.answered = True
        given.ticket = message.ticket
        if message.state >= FINAL:
            del self._given[message.id]
        else:
            self._let_go(given, time.monotonic())
        if message.error_id:
            self._say(given.message, "error", message.sentence)

    def _let_go(self, given: _Given, now: float) -> None:
        if given.let_go and given.ticket:
            given.let_go = False
            self._send("machine", "release", to_text({"ticket": given.ticket}), now)

    def _send(self, target: str, verb: str, arguments: str, now: float, held: bool = False) -> None:
        message = msgs.command()
        message.utime = time.time_ns() // 1000
        message.run_id, message.client, message.session = self._machine.run_id, self._client, self._session
        self._last_id += 1
        message.id, message.target, message.verb, message.arguments = self._last_id, target, verb, arguments
        self._given[message.id] = _Given(message, now, now, held=held)
        self._network.publish("takt/command", message.encode())

    def _beat(self, now: float) -> None:
        beat = msgs.heartbeat()
        beat.utime = time.time_ns() // 1000
        beat.run_id, beat.client, beat.session = self._machine.run_id, self._client, self._session
        self._beat_at = now
        self._network.publish("takt/heartbeat", beat.encode())

    def _say(self, message: msgs.command, state: str, sentence: str) -> None:
        self._tell({"target": message.target, "verb": message.verb, "state": state, "sentence": sentence})


assert ALLOWED.keys() <= {"machine", *KINDS}
