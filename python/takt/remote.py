"""Sessions with a running engine (taktd) over LCM."""

from __future__ import annotations

import json
import math
import os
import random
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from takt import _core, msgs
from takt.belt import Belt
from takt.belt_object_log import objects_of
from takt.cam import Table
from takt.component import Component
from takt.errors import ConnectionError, TaktError
from takt.feedback import Feedback, FeedbackState
from takt.figures import DROPPED, figures_of
from takt.keys import Key, KeyFile, first_key_not_taken, no_key, not_the_key, read_key
from takt.mover import Mover
from takt.network import open_network, usual_url
from takt.recording import FloatArray, Recording
from takt.remote_cams import RemoteCams
from takt.remote_history import CommandLog
from takt.remote_tracks import RemoteTracks
from takt.session import Recorder, Session, _clean, release_of
from takt.tables import KINDS, PREFIXES, State, is_possible, kind_of_channel, make_recording, named, table_of
from takt.track import Track

QUEUE = 100_000  # messages waiting to be received before LCM drops some
DESCRIPTION_S = 2.5  # longest wait for a description of the machine, which the engine sends every second
SILENCE_S = 3.0  # without any message: connection lost (the engine sends its state and, every second, the machine)
RESEND_S = 0.1  # between two transmissions of an unanswered command
REFRESH_S = 2.0  # after which an unfinished command is sent again: its last answer may have been lost
ANSWER_S = 2.0  # after which an unanswered command is given up
LATE_S = 1.0  # how long published values may take to catch up with a feedback, or with one another
IDLE_BEAT_S = 0.5  # between heartbeats while no command is held
ON_TRACK = ("OnTrack", "CRotationOnTrack")  # command modes of movers
POLL_S = 0.1  # longest wait between two checks of clocks and Ctrl-C
STILL_S = 10.0  # how long a heard engine may stay at one cycle
OTHER_RUN = 3017  # error: the message was for another start of the engine
QUEUE_FULL = 3012  # error: a queue is full
ANOTHER = "another engine runs on this network now: it was started again, or there are two"
STATES = frozenset(FeedbackState)
JUMP_S = 3600.0  # of engine time between two messages: component states with a larger jump are ignored


@dataclass
class _Sent:
    message: msgs.command
    feedback: Feedback
    at: float
    answered: bool = False


class _Kept:
    """Keeps every n-th message of a component; repeated and late messages are ignored."""

    def __init__(self, every: int) -> None:
        self.messages: list[State] = []
        self._every = every
        self._count = 0
        self._last = -1

    def take(self, message: State) -> None:
        if message.cycle <= self._last:
            return
        self._last = message.cycle
        if self._count % self._every == 0:
            self.messages.append(message)
        self._count += 1


class RemoteSession(Session):
    """A session with a running engine; returned by `connect`."""

    def __init__(self, url: str, client: str, timeout: float, key: Key | None = None) -> None:
        self.url = url
        self.client = client
        self.losses: dict[str, int] = {}  # messages lost in transmission, by channel
        self.ignored = 0  # messages with an implausible cycle, or a state that does not exist
        self.refused: Counter[str] = Counter()  # with a key: messages without a valid tag, by reason
        self._session_id = random.SystemRandom().getrandbits(62) + 1
        self._news = threading.Condition()  # guards all members below
        self._sequences: dict[str, int] = {}
        self._states: dict[str, State] = {}
        self._engine_state: msgs.engine_state | None = None
        self._description: msgs.machine_description | None = None
        self._cycle = -1
        self._heard = 0.0
        self._trouble = ""  # why the session cannot continue
        self._key = key
        self._key_trouble = ""  # why the engine's last description was rejected
        self._belt_objects: dict[str, msgs.belt_objects] = {}
        self._trails: dict[str, msgs.mover_trail] = {}  # of movers on tracks
        self._routes: dict[str, msgs.mover_route] = {}  # of movers on the free surface
        self._cams = RemoteCams(self)
        self._sent: dict[int, _Sent] = {}
        self._held: list[Feedback] = []  # level-sensitive commands that need heartbeats
        self._last_id = 0
        self._log: CommandLog | None = None  # of movers; set once the machine is known
        self._recorded: dict[Recorder, dict[str, _Kept]] = {}
        self._before: dict[Recorder, tuple[dict[str, int], dict[str, int]]] = {}  # counts of lost, dropped at its start
        self._stop = threading.Event()
        self._beat_now = threading.Event()

        self._lcm = open_network(url, room=True, key=key, refused=self._on_refused)
        self._subscriptions: list[Any] = []
        for channel, handler in (
            ("takt/machine", self._on_machine),
            ("takt/engine", self._on_engine),
            ("takt/feedback", self._on_feedback),
            ("takt/command", self._on_command),
            ("takt/belt_objects/.*", self._on_objects),
            ("takt/mover_trails/.*", self._keeping(msgs.mover_trail, self._trails)),
            ("takt/mover_routes/.*", self._keeping(msgs.mover_route, self._routes)),
            ("takt/cams", self._on_cam),
            *((f"{prefix}.*", self._on_state) for prefix in PREFIXES.values()),
        ):
            subscription = self._lcm.subscribe(channel, handler)
            subscription.set_queue_capacity(QUEUE)
            self._subscriptions.append(subscription)
        self._receiver = threading.Thread(target=self._receive, name="takt receiver", daemon=True)
        self._receiver.start()
        try:
            description = self._first_description(timeout)
            self._period = description.period_s
            self._run_id = description.run_id
            machine = json.loads(_core.load_machine(description.text.encode(), "machine", files=False))
            machine["cycle"]["period_s"] = self._period  # taktd --cycle-time
            super().__init__(machine, description.text)
            self._geometry = RemoteTracks(self)
            with self._news:
                self._log = CommandLog(self.movers)
            self._dead_man_s = float(machine["lcm"]["dead_man_s"])
            self._command_age_s = float(machine["lcm"]["command_age_s"])
            self._answer_s = max(ANSWER_S, self._command_age_s)  # the engine refuses older commands
            self._still_s = max(STILL_S, 3.0 / float(machine["lcm"]["engine_rate_hz"]))
            self._beater = threading.Thread(target=self._beat, name="takt heartbeat", daemon=True)
            self._beater.start()
            self._first_states(timeout)
        except BaseException:
            self._stop.set()
            self._beat_now.set()
            self._leave()
            raise

    # --- the machine ---

    @property
    def cycle(self) -> int:
        return max(self._cycle, 0)

    @property
    def period(self) -> float:
        return self._period

    @property
    def figures(self) -> dict[str, Any]:
        return figures_of(self._engine_state) if self._engine_state is not None else {}

    def close(self) -> None:
        """Releases held commands and leaves the network. The engine continues to run."""
        if self._closed:
            return
        with self._news:
            held = [f for f in self._held if not f.released]
        for feedback in held:
            try:
                feedback.release()
            except TaktError:
                break
        with self._news:  # commands still not released after that end for lack of heartbeats
            self._news.wait_for(
                lambda: self._trouble or all(f._release_is_settled for f in self._held), self._dead_man_s
            )
        try:
            super().close()
        finally:
            self._stop.set()
            self._beat_now.set()
            self._beater.join()
            self._leave()

    def _leave(self) -> None:
        """Unsubscribes; otherwise LCM would queue messages while the session object is referenced."""
        self._receiver.join()
        while self._subscriptions:
            self._lcm.unsubscribe(self._subscriptions.pop())

    # --- receiving, on a thread of its own ---

    def _receive(self) -> None:
        while not self._stop.is_set():
            try:
                self._lcm.handle_timeout(50)
            except OSError as error:
                with self._news:
                    self._trouble = f"the LCM network {self.url} broke: {error}"
                    self._news.notify_all()
                return

    def _hear(self, channel: str, sequence: int) -> None:
        last = self._sequences.get(channel)
        if last is not None and sequence > last + 1:
            self.losses[channel] = self.losses.get(channel, 0) + sequence - last - 1
            if channel == "takt/feedback":
                for sent in self._sent.values():
                    sent.answered = False  # is sent again
                self._beat_now.set()
        self._sequences[channel] = sequence
        if self._key is None or _core.is_tagged_channel(channel):  # other channels are not authenticated
            self._heard = time.monotonic()
        self._news.notify_all()

    def _check_run(self, run_id: int) -> None:
        if self._description is not None and run_id != self._description.run_id and not self._trouble:
            self._trouble = ANOTHER

    def _believable(self, message: msgs.engine_state | State) -> bool:
        """Returns whether cycle and time of a message agree and, for a component, its cycle is not far ahead of all
        cycles received. The engine's own state carries the run's number and may be far ahead (this process may have
        slept)."""
        if self._description is None:
            return False
        period = self._description.period_s
        good = is_possible(message, period)
        if good and not isinstance(message, msgs.engine_state) and self._cycle >= 0:
            good = (message.cycle - self._cycle) * period <= JUMP_S
        self.ignored += not good
        return good

    def _on_machine(self, channel: str, data: bytes) -> None:
        message = _decoded(msgs.machine_description, data)
        if message is None:
            return
        with self._news:
            self._key_trouble = ""
            self._check_run(message.run_id)
            if self._description is None and self._key is None and _core.has_tag(data):
                self._trouble = no_key(self.url)
            elif self._description is None:
                self._description = message
            self._hear(channel, message.sequence)

    def _on_refused(self, channel: str, state: _core.TagState) -> None:
        assert self._key is not None
        with self._news:
            self.refused[state.name] += 1
            if channel == "takt/machine":
                self._key_trouble = not_the_key(self.url, self._key, state)
                self._news.notify_all()

    def _on_engine(self, channel: str, data: bytes) -> None:
        message = _decoded(msgs.engine_state, data)
        if message is None:
            return
        with self._news:
            self._check_run(message.run_id)
            if self._believable(message):
                self._engine_state = message
                self._cycle = max(self._cycle, message.cycle)
                self._hear(channel, message.sequence)
            self._news.notify_all()

    def _on_state(self, channel: str, data: bytes) -> None:
        kind = kind_of_channel(channel)
        message = _decoded(kind.message, data) if kind else None
        if message is None:
            return
        with self._news:
            if not self._believable(message):
                return
            self._states[message.name] = message
            if self._log is not None and kind is not None and kind.name == "mover":
                self._log.state(message)
            self._cycle = max(self._cycle, message.cycle)
            for rows in self._recorded.values():
                if message.name in rows:
                    rows[message.name].take(message)
            self._hear(channel, message.sequence)

    def _on_objects(self, channel: str, data: bytes) -> None:
        message = _decoded(msgs.belt_objects, data)
        if message is None:
            return
        with self._news:
            if self._believable(message):
                self._belt_objects[message.name] = message
                for recorder in self._recorded:
                    if message.name in recorder.belts:
                        recorder.belt_objects.look(message.name, message.cycle * self.period, objects_of(message))
                self._hear(channel, message.sequence)

    def _keeping(self, kind: Any, newest: dict[str, Any]) -> Callable[[str, bytes], None]:
        """Returns a handler that keeps the newest message of each name."""

        def take(channel: str, data: bytes) -> None:
            message = _decoded(kind, data)
            if message is None:
                return
            with self._news:
                if self._believable(message):
                    newest[message.name] = message
                    self._hear(channel, message.sequence)

        return take

    def _on_cam(self, channel: str, data: bytes) -> None:
        message = _decoded(msgs.cam_piece, data)
        if message is None:
            return
        with self._news:
            self._cams.take(message)
            self._hear(channel, message.sequence)

    def _on_feedback(self, channel: str, data: bytes) -> None:
        message = _decoded(msgs.feedback, data)
        if message is None:
            return
        with self._news:
            if message.state not in STATES:
                self.ignored += 1
                return
            if self._log is not None:
                self._log.feedback(message)
            if message.client == self.client and message.session == self._session_id:
                self._take(message)
            self._hear(channel, message.sequence)

    def _on_command(self, channel: str, data: bytes) -> None:
        message = _decoded(msgs.command, data)
        if message is None:
            return
        with self._news:
            if self._log is not None:
                self._log.command(message)

    def _take(self, message: msgs.feedback) -> None:
        sent = self._sent.get(message.id)
        if sent is None:
            if message.id == 0 and message.error_id not in (0, QUEUE_FULL):  # when full, stopping is still possible
                self._trouble = ANOTHER if message.error_id == OTHER_RUN else message.sentence
            return
        sent.answered = True
        feedback = sent.feedback
        feedback.ticket = message.ticket or feedback.ticket
        self._report(
            feedback,
            message.state,
            message.reached,
            message.error_id,
            message.sentence,
            message.cycle,
            message.value,
            message.object_kind,
            message.object_number,
        )
        if feedback._final:
            del self._sent[message.id]
        self._held = [f for f in self._held if not f._final or (_outlasts_its_end(f) and not f._release_is_settled)]

    # --- heartbeats and retransmissions, on a thread of their own ---

    def _beat(self) -> None:
        beat = msgs.heartbeat()
        beat.client, beat.session = self.client, self._session_id
        beat.run_id = self._run_id
        while not self._stop.is_set():
            now = time.monotonic()
            with self._news:
                ending = [f for f in self._held if f.released and not f._release_is_settled]
                for feedback in ending:
                    if feedback.ticket and (feedback._release is None or feedback._release_is_refused):
                        self._send(release_of(feedback))
                # Heartbeats renew every command that the client holds. Without them the dead-man switch ends commands
                # that cannot be released, and those of a client that can no longer send commands.
                beats = not self._trouble and (not ending or len(ending) < len(self._held))
                again = [s for s in self._sent.values() if now - s.at > (REFRESH_S if s.answered else RESEND_S)]
                for sent in again:
                    sent.at = now
                interval = self._dead_man_s / 4 if self._held else IDLE_BEAT_S
                if ending or any(not s.answered for s in self._sent.values()):
                    interval = min(interval, RESEND_S / 2)
            if beats:
                beat.utime = _now_us()
                self._publish("takt/heartbeat", beat.encode())
            for sent in again:
                self._publish("takt/command", sent.message.encode())
            self._beat_now.wait(interval)
            self._beat_now.clear()

    def _publish(self, channel: str, data: bytes) -> None:
        try:
            self._lcm.publish(channel, data)
        except OSError as error:
            with self._news:
                self._trouble = f"the LCM network {self.url} does not take messages: {error}"
                self._news.notify_all()

    # --- implementation of Session ---

    def _send(self, feedback: Feedback) -> _Sent:
        message = msgs.command()
        message.client, message.session = self.client, self._session_id
        message.target, message.verb, message.arguments = feedback.target, feedback.verb, feedback.arguments
        message.run_id, message.utime = self._run_id, _now_us()
        with self._news:
            self._last_id += 1
            message.id = self._last_id
            sent = self._sent[message.id] = _Sent(message, feedback, time.monotonic())
            if self._log is not None:
                self._log.command(message)
            if feedback.level_sensitive:
                self._held.append(feedback)
                self._beat_now.set()
        self._publish("takt/command", message.encode())
        return sent

    def _submit(self, feedback: Feedback) -> None:
        # Commands that stop, release or switch off are sent in any state of the session (EN-32).
        lets_go = _core.lets_go(self._kind(feedback.target), feedback.verb, feedback.arguments)
        with self._news:
            if lets_go:
                self._check_open()
            else:
                self._check_alive()
        wrong_keys = self._wrong_keys()
        sent = self._send(feedback)
        with self._news:
            if not self._news.wait_for(lambda: sent.answered or (self._trouble and not lets_go), self._answer_s):
                if feedback.level_sensitive:
                    feedback.released = True  # the engine may have accepted it: retried until it answers
                elif not feedback._lets_go_of_another:
                    del self._sent[sent.message.id]
                late = "" if lets_go else f"; it refuses what reaches it later than {self._command_age_s:g} s"
                if self._key is not None and self._key.changing and self._wrong_keys() > wrong_keys:
                    late = f"; {first_key_not_taken(self._key)}"
                raise ConnectionError(
                    f"{feedback.text}: the engine on {self.url} does not answer within {self._answer_s:g} s{late}"
                )
            if not sent.answered:
                raise ConnectionError(self._trouble)

    def _wrong_keys(self) -> int:
        """Returns the number of messages that the engine has refused for a wrong key, by its last state."""
        return int(self._engine_state.wrong_key) if self._engine_state is not None else 0

    def _value(self, component: Component, field: str) -> Any:
        return named(component.KIND, field, KINDS[component.KIND].getters[field](self._states[component.name]))

    def _objects(self, belt: Belt) -> Iterable[tuple[Any, ...]]:
        message = self._belt_objects.get(belt.name)
        return objects_of(message) if message else ()

    def _history(self, mover: Mover) -> Iterable[tuple[Any, ...]]:
        with self._news:
            return self._log.of(mover.name) if self._log is not None else ()

    def _trail(self, mover: Mover) -> Iterable[int]:
        message, here = self._trails.get(mover.name), mover.track
        tracks = [] if message is None else list(message.tracks)
        if message is None or message.cycle < self._states[mover.name].cycle:
            if mover.command_mode not in ON_TRACK:
                return ()
            # Tracks that the mover has left since the message are dropped.
            tracks = tracks[tracks.index(here) :] if here in tracks else [here]
        return [track - 1 for track in tracks]

    def _route(self, mover: Mover) -> tuple[int, FloatArray]:
        message = self._routes.get(mover.name)
        if message is None or not (message.count and mover.on_route):
            return 0, np.empty((0, 2))
        return message.first, np.column_stack([message.x, message.y])

    def _track_at(self, track: Track, s: float) -> tuple[float, float, float, float]:
        return self._geometry.at(track, s)

    def _track_closest_to(self, track: Track, x: float, y: float) -> float:
        return self._geometry.closest_to(track, x, y)

    def _track_links(self, track: Track) -> tuple[list[int], list[int]]:
        return self._geometry.links(track)

    def _cam(self, number: int) -> Table:
        table = self._made_cams.known(number)
        return self._cams.table(number) if table is None else table

    def cam(self, name: str) -> Table:
        self._check_open()
        number = self._cams.number_of(name)
        return self._cam(number) if number else super().cam(name)

    def _await(self, condition: Callable[[], bool], timeout: float) -> None:
        """Waits until a received message makes the condition true, the session fails, or `timeout` [s] has passed."""
        with self._news:
            self._news.wait_for(lambda: condition() or self._trouble, timeout)

    def _wait_for(self, condition: Callable[[], bool], timeout: float, *, on_feedback: bool, every: int = 1) -> bool:
        end = self.now + timeout
        cycle, since = self._cycle, time.monotonic()
        while True:
            with self._news:
                seen = self._sequences.copy()
            if self._programs:
                self._scan()
            if condition():
                return True
            if self.now >= end:
                return False
            if self._cycle != cycle:
                cycle, since = self._cycle, time.monotonic()
            if time.monotonic() - since > self._still_s:
                raise ConnectionError(f"the engine on {self.url} is there, but its time stands still at {self.now:g} s")
            with self._news:
                self._check_alive()
                self._news.wait_for(lambda seen=seen: self._sequences != seen or self._trouble, POLL_S)  # type: ignore[misc]

    def _run(self, cycles: int) -> None:
        end = self.cycle + cycles
        self._wait_for(lambda: self._cycle >= end, math.inf, on_feedback=False)
        self._catch_up(end)

    def _catch_up(self, cycle: int) -> None:
        with self._news:
            self._news.wait_for(
                lambda: all(self._states[c].cycle >= cycle for c in self._components) or self._trouble, LATE_S
            )

    def _begin(self, recorder: Recorder) -> None:
        with self._news:
            self._recorded[recorder] = {name: _Kept(recorder.every) for name in recorder.components}
            self._before[recorder] = (self.losses.copy(), self._dropped())

    def _finish(self, recorder: Recorder) -> Recording:
        with self._news:
            rows = self._recorded.pop(recorder)
            lost, dropped = (
                _more(now, then)
                for now, then in zip((self.losses, self._dropped()), self._before.pop(recorder), strict=True)
            )
        tables = {
            name: table_of(self._components[name].KIND, kept.messages, self.period)[0] for name, kept in rows.items()
        }
        meta = {
            "source": self.url,
            "period_s": self.period,
            "losses": lost,
            "dropped": dropped,
            "objects": recorder.belt_objects.columns(),
            **self._made_cams.kept(),
        }
        return make_recording(self.machine, tables, recorder.events, meta, self.machine_text)

    def _dropped(self) -> dict[str, int]:
        """Returns the engine's counts of dropped messages, by its last state."""
        state = self._engine_state
        return {name: getattr(state, name) for name in DROPPED} if state is not None else {}

    # --- health ---

    def _check_alive(self) -> None:
        self._check_open()
        if self._trouble:
            raise ConnectionError(self._trouble)
        silence = time.monotonic() - self._heard
        if silence > SILENCE_S:
            why = f": {self._key_trouble}" if self._key_trouble else ""
            raise ConnectionError(f"the engine on {self.url} has been silent for {silence:.1f} s{why}")

    def _first_description(self, timeout: float) -> msgs.machine_description:
        end = time.monotonic() + timeout
        with self._news:
            self._news.wait_for(lambda: self._description or self._trouble or self._key_trouble, timeout)
            if self._key_trouble:  # may be from a foreign sender: the next description is due within a second
                left = min(DESCRIPTION_S, end - time.monotonic())
                self._news.wait_for(lambda: self._description or self._trouble, left)
            if self._trouble:
                raise ConnectionError(self._trouble)
            if self._description is None and self._key_trouble:
                raise ConnectionError(self._key_trouble)
            if self._description is None:
                raise ConnectionError(f"no engine answers on {self.url} within {timeout:g} s; is taktd running there?")
            return self._description

    def _first_states(self, timeout: float) -> None:
        with self._news:
            self._news.wait_for(lambda: self._trouble or self._states.keys() >= self._components.keys(), timeout)
            if self._trouble:
                raise ConnectionError(self._trouble)
            silent = [name for name in self._components if name not in self._states]
        if silent:
            raise ConnectionError(f"the engine on {self.url} does not publish its component {silent[0]}")


def connect(
    url: str | None = None, *, client: str | None = None, timeout: float = 5.0, key: KeyFile | None = None
) -> RemoteSession:
    """Joins an LCM network and returns a session with its engine.

    url: the network; None: that of the environment (LCM_DEFAULT_URL), else "udpm://239.255.76.67:7667?ttl=0".
    client: a unique name of this client; the engine refuses a second client with the same name. None: generated.
    timeout: longest wait [s] for the description of the machine, and again for the first states of all components.
    key: the file with the key that the engine was started with (`taktd --key`); None: the file named by the environment
        (TAKT_KEY_FILE); "": no key.

    Raises ConnectionError if no engine answers, or the keys of engine and client do not match; KeyFileError if the key
    file cannot be used; ValueError if `client` cannot be encoded as UTF-8 or contains NUL.
    """
    url = url or usual_url()
    name = client if client is not None else f"python-{os.getpid()}-{random.SystemRandom().getrandbits(24):06x}"
    if _clean(name) != name:
        raise ValueError(f"client: expected a name without NUL and lone surrogates, found {name!r}")
    return RemoteSession(url, name, timeout, read_key(key))


def _outlasts_its_end(feedback: Feedback) -> bool:
    """Returns whether a final command still needs its release. Power off, a fault or another stop ends a held stop as
    aborted or in error, but its hold remains."""
    return feedback._done or (feedback.verb == "stop" and not feedback._refused)


def _more(now: dict[str, int], then: dict[str, int]) -> dict[str, int]:
    """Returns the increases of counts; unchanged ones are left out."""
    return {name: count - then.get(name, 0) for name, count in now.items() if count > then.get(name, 0)}


def _now_us() -> int:
    return time.time_ns() // 1000


def _decoded(kind: Any, data: bytes) -> Any:
    """Returns the decoded message; None if the bytes are not of this type."""
    try:
        return kind.decode(data)
    except Exception:  # generated code raises ValueError, struct.error, UnicodeDecodeError, IndexError ...
        return None
