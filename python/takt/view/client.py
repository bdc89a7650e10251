"""One of several clients of an engine in one process: its commands, their feedback, and the heartbeats that keep held
commands active (EN-23).

Each is a separate client of the engine, and sends heartbeats only while `hold` was called within the dead man's time.
If the far end hangs, is closed or is cut off, or this process dies, the engine receives no heartbeat and releases held
commands."""

from __future__ import annotations

import random
import time
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from takt import msgs
from takt.arguments import to_text
from takt.view.machine import Machine

RESEND_S = 0.1  # interval at which an unanswered command is repeated
REFRESH_S = 2.0  # interval at which an unfinished command is repeated: its last feedback may have been lost
GIVEN_UP_S = 2.0  # time without an answer after which a command is given up
ACTIVE, FINAL, ERROR = 1, 2, 4  # states of a feedback; from FINAL on it is the last


@dataclass
class Given:
    # A pending command.
    message: msgs.command
    began: float  # time.monotonic() [s] at which it was first sent
    sent: float  # time.monotonic() [s] at which it was last sent
    answered: bool = False
    ticket: int = 0
    held: bool = False  # continues until it is released
    let_go: bool = False  # to be released as soon as it has a ticket
    released: bool = False  # its release has been sent
    given_up: bool = False  # the engine has not answered in time, and may have accepted it
    active: bool = False  # it was in control at some time

    def outlasts(self, feedback: msgs.feedback) -> bool:
        """Returns whether its hold outlasts this final feedback: that of a stop does, unless it was refused."""
        return self.held and self.message.verb == "stop" and (self.active or feedback.state != ERROR)


class Client(ABC):
    def __init__(self, network: Any, machine: Machine, kind: str) -> None:
        """kind: prefix of the client's name."""
        self._network = network
        self._machine = machine
        self.name = f"{kind}-{random.SystemRandom().getrandbits(40):010x}"
        self._session = random.SystemRandom().getrandbits(62) + 1
        self._dead_man_s = float(machine.parameters["lcm"]["dead_man_s"])
        self._last_id = 0
        self._given: dict[int, Given] = {}
        self._holds: list[Given] = []  # stops whose feedback is final and that still hold
        self._held_at = 0.0  # time of the latest call of `hold`
        self._beat_at = 0.0

    @abstractmethod
    def _became(self, message: msgs.command, feedback: msgs.feedback) -> None:
        """Called with each feedback of a command."""

    @abstractmethod
    def _unanswered(self, message: msgs.command) -> None:
        """Called when a command is given up because the engine has not answered within GIVEN_UP_S."""

    def hold(self, now: float) -> None:
        """Confirms that held commands continue. now: time.monotonic() [s]."""
        self._held_at = now

    def release(self) -> None:
        """Releases all held commands."""
        now = time.monotonic()
        held = [one for one in self._given.values() if one.held] + self._holds
        self._holds = []
        for given in held:
            given.held, given.let_go = False, True
            self._let_go(given, now)

    def tick(self, now: float) -> None:
        """Sends heartbeats while commands are held and `hold` confirms them, else releases them; repeats unanswered
        commands. Call it at least every dead_man_s / 4. now: time.monotonic() [s]."""
        holding = bool(self._holds) or any(one.held for one in self._given.values())
        if holding and now - self._held_at > self._dead_man_s:
            self.release()
        elif holding and now - self._beat_at >= self._dead_man_s / 4:
            self._beat(now)
        for number, given in list(self._given.items()):
            if not given.answered and not given.given_up and now - given.began > GIVEN_UP_S:
                given.given_up = True
                if given.held or given.let_go:  # is repeated until it is answered, and then released
                    given.held, given.let_go = False, True
                elif given.message.verb != "release":
                    del self._given[number]
                self._unanswered(given.message)
            elif now - given.sent > (REFRESH_S if given.answered or given.given_up else RESEND_S):
                given.sent = now
                self._network.publish("takt/command", given.message.encode())

    def take(self, message: msgs.feedback) -> None:
        """Processes a feedback; those of other clients, and states that do not exist, are ignored."""
        if message.client != self.name or message.session != self._session or not 0 <= message.state <= ERROR:
            return
        given = self._given.get(message.id)
        if given is None:
            return
        given.answered = True
        given.ticket = message.ticket
        given.active |= message.state == ACTIVE
        if message.state >= FINAL:
            del self._given[message.id]
            if given.outlasts(message) and not given.released:
                self._holds.append(given)
        self._let_go(given, time.monotonic())
        if not given.given_up:
            self._became(given.message, message)

    def _let_go(self, given: Given, now: float) -> None:
        if given.let_go and given.ticket:
            given.let_go = False
            self._send("machine", "release", to_text({"ticket": given.ticket}), now)

    def _send(self, target: str, verb: str, arguments: str, now: float, held: bool = False) -> int:
        """Sends a command. Returns its number."""
        if verb == "release":
            for given in [*self._given.values(), *self._holds]:
                given.released |= bool(given.ticket) and arguments == to_text({"ticket": given.ticket})
            self._holds = [given for given in self._holds if not given.released]
        message = msgs.command()
        message.utime = time.time_ns() // 1000
        message.run_id, message.client, message.session = self._machine.run_id, self.name, self._session
        self._last_id += 1
        message.id, message.target, message.verb, message.arguments = self._last_id, target, verb, arguments
        self._given[message.id] = Given(message, now, now, held=held)
        self._network.publish("takt/command", message.encode())
        return self._last_id

    def _beat(self, now: float) -> None:
        beat = msgs.heartbeat()
        beat.utime = time.time_ns() // 1000
        beat.run_id, beat.client, beat.session = self._machine.run_id, self.name, self._session
        self._beat_at = now
        self._network.publish("takt/heartbeat", beat.encode())
