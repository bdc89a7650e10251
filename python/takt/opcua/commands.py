"""Commands of OPC UA clients: each session is a client of the engine of its own, and releases what it holds when it
ends."""

from __future__ import annotations

import asyncio
import time
import traceback
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from asyncua import ua

from takt import msgs
from takt.arguments import to_text
from takt.opcua.arguments import RefusedError, values_of
from takt.opcua.descriptions import Verb
from takt.opcua.sessions import CALLER, Session
from takt.opcua.space import Call, answer
from takt.session import is_held
from takt.view.client import FINAL, GIVEN_UP_S, Client
from takt.view.feed import Feed
from takt.view.machine import Machine

MOST = 1000  # commands whose feedback is kept
BUSY, ERROR = 0, 4
SETTLES_S = 0.1  # [s] a method waits for the next feedback after the engine has accepted the command
UNANSWERED = "the engine does not answer"


@dataclass
class Followed:
    """A command, and its latest feedback."""

    target: str
    told: dict[str, Any]  # the fields of `takt.opcua.space.FEEDBACK`
    news: asyncio.Event = field(default_factory=asyncio.Event)


class _Client(Client):
    """The engine's client of one session. `told` receives the number of a command within the session, and its feedback;
    None: the engine did not answer."""

    def __init__(self, network: Any, machine: Machine, told: Callable[[int, msgs.feedback | None], None]) -> None:
        super().__init__(network, machine, "opcua")
        self._told = told

    def give(self, target: str, verb: str, arguments: str, held: bool, now: float) -> int:
        if held:
            self.hold(now)
            self._beat(now)  # the engine knows this client's name before the command needs it
        return self._send(target, verb, arguments, now, held)

    def _became(self, message: msgs.command, feedback: msgs.feedback) -> None:
        self._told(message.id, feedback)

    def _unanswered(self, message: msgs.command) -> None:
        self._told(message.id, None)


class Commands:
    def __init__(self, feed: Feed, target_of: Callable[[ua.NodeId], tuple[str, str] | None]) -> None:
        """target_of: returns the target's name and kind for the node of an object; None: it is no target."""
        self.changed: dict[str, Followed] = {}  # by target: commands with news; the reader empties it
        self._feed = feed
        self._target_of = target_of
        self._clients: dict[Session, _Client] = {}
        self._leaving: list[tuple[float, Session, _Client]] = []  # still releasing, at least until this time
        self._followed: OrderedDict[int, Followed] = OrderedDict()
        self._open: dict[tuple[Session, int], int] = {}  # number of a command by session and number within it
        self._latest: dict[str, int] = {}  # by target: number of its last command
        self._count = 0

    # --- methods ---

    def caller(self, verb: Verb) -> Call:
        async def call(parent: ua.NodeId, *given: ua.Variant) -> ua.CallMethodResult:
            return await _answered(self._call(verb, parent, given))

        return call

    async def ask(self, _: ua.NodeId, *given: ua.Variant) -> ua.CallMethodResult:
        """Returns the latest feedback of the command with the given number; BadNotFound if it is not known."""
        result = ua.CallMethodResult()
        followed = self._followed.get(given[0].Value) if len(given) == 1 and isinstance(given[0].Value, int) else None
        if followed is None:
            result.StatusCode = ua.StatusCode(
                ua.StatusCodes.BadNotFound if given else ua.StatusCodes.BadArgumentsMissing
            )
        else:
            result.OutputArguments = answer(followed.told)
        return result

    async def _call(self, verb: Verb, parent: ua.NodeId, given: tuple[ua.Variant, ...]) -> ua.CallMethodResult:
        session = CALLER.get()
        if not session.may_command or not self._feed.may_command:
            raise RefusedError(ua.StatusCodes.BadUserAccessDenied)
        found = self._target_of(parent)
        if found is None or found[1] != verb.target_kind:
            raise RefusedError(ua.StatusCodes.BadMethodInvalid)
        values = values_of(verb.arguments, given)
        if self._feed.gone:
            raise RefusedError(ua.StatusCodes.BadNoCommunication)
        followed = self._give(session, found[0], verb, values)
        await _wait(followed, GIVEN_UP_S + 1)
        if followed.told["state"] == BUSY:
            await _wait(followed, SETTLES_S)
        return ua.CallMethodResult(OutputArguments=answer(followed.told))

    def _give(self, session: Session, target: str, verb: Verb, values: Mapping[str, Any]) -> Followed:
        arguments = to_text(values)
        held = is_held(verb.target_kind, verb.name, values, arguments)
        self._count += 1
        followed = self._followed[self._count] = Followed(
            target,
            {
                "command": self._count,
                "client": session.client,
                "verb": verb.name,
                "arguments": arguments,
                "state": BUSY,
                "reached": False,
                "error_id": 0,
                "sentence": "",
                "value": 0.0,
                "ticket": 0,
            },
        )
        if len(self._followed) > MOST:
            ended = (old for old, one in self._followed.items() if one.told["state"] >= FINAL)
            del self._followed[next(ended, next(iter(self._followed)))]
        number = self._client_of(session).give(target, verb.name, arguments, held, time.monotonic())
        self._open[session, number] = self._latest[target] = self._count
        self.changed[target] = followed
        return followed

    def _client_of(self, session: Session) -> _Client:
        if session not in self._clients:
            machine = self._feed.machine
            assert machine is not None

            def told(number: int, feedback: msgs.feedback | None) -> None:
                self._take(session, number, feedback)

            client = self._clients[session] = _Client(self._feed.network, machine, told)
            self._feed.listeners.add(client.take)
        return self._clients[session]

    def _take(self, session: Session, number: int, feedback: msgs.feedback | None) -> None:
        final = feedback is None or feedback.state >= FINAL
        known = self._open.pop((session, number), None) if final else self._open.get((session, number))
        followed = self._followed.get(known) if known else None
        if followed is None:
            return
        if feedback is None:
            followed.told |= {"state": ERROR, "sentence": UNANSWERED}
        else:
            followed.told |= {
                "state": feedback.state,
                "reached": feedback.reached,
                "error_id": feedback.error_id,
                "sentence": feedback.sentence,
                "value": feedback.value,
                "ticket": feedback.ticket,
            }
        followed.news.set()
        if self._latest.get(followed.target) == known:
            self.changed[followed.target] = followed

    # --- periodic ---

    def tick(self, now: float) -> None:
        """Keeps alive what open sessions hold, as long as their clients are heard, and releases it for sessions that
        have ended. now: time of the monotonic clock [s]."""
        for session, client in list(self._clients.items()):
            if session.is_closed:
                client.release()
                del self._clients[session]
                self._leaving.append((now + GIVEN_UP_S, session, client))
            else:
                client.hold(now if session.calls else session.heard_at)
                client.tick(now)
        pending = {session for session, _ in self._open}
        for end, session, client in self._leaving[:]:
            client.tick(now)
            if now > end and session not in pending:
                self._leaving.remove((end, session, client))
                self._feed.listeners.discard(client.take)

    def forget(self) -> None:
        """Discards all clients and fails open commands after a restart of the engine, which does not know them."""
        for client in (*self._clients.values(), *(client for *_, client in self._leaving)):
            self._feed.listeners.discard(client.take)
        self._clients.clear()
        self._leaving.clear()
        for number in self._open.values():
            followed = self._followed.get(number)
            if followed is not None:
                followed.told |= {"state": ERROR, "sentence": "the engine was started again meanwhile"}
                followed.news.set()
                if self._latest.get(followed.target) == number:
                    self.changed[followed.target] = followed
        self._open.clear()

    def release(self) -> None:
        """Releases everything that the sessions hold."""
        for client in self._clients.values():
            client.release()


async def _wait(followed: Followed, seconds: float) -> None:
    followed.news.clear()
    try:
        await asyncio.wait_for(followed.news.wait(), seconds)
    except asyncio.TimeoutError:
        return


async def _answered(call: Any) -> ua.CallMethodResult:
    result = ua.CallMethodResult()
    try:
        result = await call
    except RefusedError as error:
        result.StatusCode = ua.StatusCode(error.status)
        result.InputArgumentResults = [ua.StatusCode(one) for one in error.arguments]
    except Exception:  # a fault of the server: the client gets an answer, the terminal of the server the trace
        traceback.print_exc()
        result.StatusCode = ua.StatusCode(ua.StatusCodes.BadInternalError)
    return result
