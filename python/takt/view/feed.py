"""What an engine says over LCM, for the page.

Two subscriptions of each component: the overview takes the newest message of everything some times a second and lets
LCM drop the others before Python sees them; the scope takes every message of the few components whose signals somebody
looks at, into rings. All of it happens in `tick`, on one thread; in between LCM's own threads keep what comes."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from takt import _core, msgs
from takt.belt_object_log import objects_of, rows_of
from takt.errors import ConfigError
from takt.keys import Key, not_the_key
from takt.network import open_network
from takt.remote import JUMP_S
from takt.scene import rounded_poses
from takt.tables import fields_of
from takt.view.ledger import Ledger
from takt.view.machine import Machine, Source, drawn
from takt.view.made import MadeCams
from takt.view.overview import Overview
from takt.view.ring import Ring
from takt.view.shapes import Routes, Shapes

QUEUE = 200_000  # messages that wait for the next tick, of all that must not get lost
AT_ONCE = 2000  # messages of one tick, besides states
SILENCE_S = 3.0  # silence after which the engine counts as gone
TAKEN_OVER_S = 1.5  # without one, and another engine is heard: that one took its place
KEPT_S = 30.0  # how long signals are kept that nobody looks at, for a page that comes back


class Tap:
    """All messages of one component, and the last values of those of its signals that are looked at."""

    def __init__(self, source: Source, period_s: float) -> None:
        self.source = source
        self.ring = Ring(())
        self.lost = 0  # on the way: gaps in the sequence
        self.malformed = 0
        self.idle_since = time.monotonic()
        self._period_ns = period_s * 1e9
        self._pending: list[bytes] = []
        self._sequence = -1
        self._cycle = -1

    def take(self, _: str, data: bytes) -> None:
        self._pending.append(data)

    def drain(self, latest_cycle: float = math.inf) -> int:
        """Appends pending messages to the ring; malformed, repeated and implausible ones are left out. Returns the
        number of messages handled."""
        if not self._pending:
            return 0
        pending, self._pending = self._pending, []
        good = [data for data in pending if self.source.layout.fits(data)]
        self.malformed += len(pending) - len(good)
        if not good:
            return len(pending)
        rows = self.source.layout.rows(good)
        cycles, sequence = rows["cycle"].astype(np.int64), rows["sequence"].astype(np.int64)
        possible = (np.abs(rows["time_ns"] - cycles * self._period_ns) <= cycles) & (cycles <= latest_cycle)
        latest = np.maximum.accumulate(np.concatenate(([self._cycle], np.where(possible, cycles, -1))))
        new = (cycles > latest[:-1]) & possible
        self.malformed += int(np.sum(~possible))
        if not np.any(new):
            return len(pending)
        cycles, sequence = cycles[new], sequence[new]
        steps = np.diff(np.concatenate(([self._sequence if self._sequence >= 0 else sequence[0] - 1], sequence)))
        self.lost += int(np.sum(steps[steps > 1] - 1))
        self._sequence, self._cycle = int(sequence[-1]), int(cycles[-1])
        columns = [rows[field][new].astype(float) for field in self.ring.fields]
        self.ring.append(cycles, np.stack(columns) if columns else np.empty((0, len(cycles))))
        return len(pending)


class Feed:
    def __init__(self, url: str, key: Key | None = None, file: Path | None = None) -> None:
        """file: machine file on this host; if the machine that runs equals it, the meshes that it names are drawn."""
        self.url = url
        self._file = file
        self.machine: Machine | None = None
        self.overview: Overview | None = None
        self.ledger = Ledger(())
        self.made_cams = MadeCams(drawn)
        self.taps: dict[int, Tap] = {}
        self.engine: dict[str, Any] | None = None
        self.objects: dict[str, list[list[float]]] = {}  # what lies on belts
        self.shapes = Shapes()  # of tracks
        self.routes = Routes()  # of movers
        self.links: dict[str, list[list[float]]] = {}  # poses of the links of groups
        self.trouble = ""  # what is wrong beside the engine, in a sentence
        self.messages = 0  # of the scope, so far
        self.epoch = 0  # counts the machines that were seen
        self.listeners: set[Callable[[msgs.feedback], None]] = set()  # to what becomes of commands
        self._heard = 0.0
        self._other_heard = 0.0
        self._key = key
        self.may_command = True  # False: the engine has a key, and this page has none
        self._news: Any = open_network(url, room=True, key=key, refused=self._on_refused)
        self._scope: Any = open_network(url, room=True)
        self._subscriptions: list[Any] = []
        self._tap_subscriptions: dict[int, Any] = {}
        for channel, handler in (
            ("takt/machine", self._on_machine),
            ("takt/engine", self._on_engine),
            ("takt/command", self._on_command),
            ("takt/feedback", self._on_feedback),
        ):
            self._news.subscribe(channel, handler).set_queue_capacity(QUEUE)

    @property
    def gone(self) -> bool:
        """No engine is heard."""
        return self.machine is None or time.monotonic() - self._heard > SILENCE_S

    @property
    def lost(self) -> int:
        return sum(tap.lost for tap in self.taps.values())

    @property
    def _latest_cycle(self) -> float:
        """No component can be later than this, by what the engine itself said, whose messages have the run's number."""
        if self.engine is None or self.machine is None:
            return math.inf
        return float(self.engine["cycle"]) + JUMP_S / self.machine.period_s

    @property
    def network(self) -> Any:
        """Where commands go."""
        return self._news

    # --- what is looked at ---

    def look_at(self, wanted: Iterable[tuple[int, str]]) -> None:
        """The signals that all pages together look at: (component, field). Others are kept for a while."""
        if self.machine is None:
            return
        fields: dict[int, list[str]] = {}
        for index, field in wanted:
            fields.setdefault(index, []).append(field)
        now = time.monotonic()
        for index, of in fields.items():
            tap = self.taps.get(index) or self._open_tap(self.machine.sources[index])
            tap.idle_since = now
            missing = [field for field in dict.fromkeys(of) if field not in tap.ring.fields]
            if missing:
                tap.ring = tap.ring.with_fields([*tap.ring.fields, *missing])
        for index in [i for i, tap in self.taps.items() if i not in fields and now - tap.idle_since > KEPT_S]:
            self._scope.unsubscribe(self._tap_subscriptions.pop(index))
            del self.taps[index]

    def _open_tap(self, source: Source) -> Tap:
        assert self.machine is not None
        tap = self.taps[source.index] = Tap(source, self.machine.period_s)
        subscription = self._scope.subscribe(re.escape(source.channel), tap.take)
        subscription.set_queue_capacity(QUEUE)
        self._tap_subscriptions[source.index] = subscription
        return tap

    # --- what has come ---

    def tick(self) -> None:
        """Takes everything that has come since the last one."""
        # Of the newest states new ones may come as fast as they are taken: one of each is enough.
        _drain(self._news, AT_ONCE + (len(self.machine.sources) if self.machine else 0))
        _drain(self._scope, QUEUE)
        for tap in self.taps.values():
            self.messages += tap.drain(self._latest_cycle)
        if self.overview is not None:
            self.overview.update(self.ledger, self._latest_cycle)
            self._place_links()

    def _on_machine(self, _: str, data: bytes) -> None:
        message = _decoded(msgs.machine_description, data)
        if message is None or not message.period_s > 0:
            return
        now = time.monotonic()
        if self.machine is not None and message.run_id == self.machine.run_id:
            self._heard = now
            self.may_command = self._may_command(data)
            if now - self._other_heard > SILENCE_S:
                self.trouble = ""
            return
        if self.machine is not None and now - self._heard < TAKEN_OVER_S:
            self._other_heard = now
            self.trouble = "another engine runs on this network, too: what it says is left out"
            return
        try:
            self._begin(Machine(message, file=self._file))
            self.may_command = self._may_command(data)
            self.trouble = ""
        except ConfigError as error:
            self.trouble = f"the machine {message.name} cannot be read here: {error.problems[0]}"

    def _may_command(self, description: bytes) -> bool:
        return self._key is not None or not _core.has_tag(description)

    def _on_refused(self, channel: str, state: _core.TagState) -> None:
        if channel == "takt/machine" and self.gone and self._key is not None:
            self.trouble = not_the_key(self.url, self._key, state)

    def _begin(self, machine: Machine) -> None:
        for subscription in self._subscriptions:
            self._news.unsubscribe(subscription)
        for subscription in self._tap_subscriptions.values():
            self._scope.unsubscribe(subscription)
        self._tap_subscriptions.clear()
        self.taps.clear()
        self.machine, self.overview, self.ledger = machine, Overview(machine), Ledger(machine.by_name)
        self.engine, self.objects, self.links, self.messages = None, {}, {}, 0
        self.shapes = Shapes(machine.names["part"])
        self.routes = Routes()
        self.made_cams = MadeCams(drawn)
        self.epoch += 1
        self._heard = time.monotonic()
        self._subscriptions = [self._newest(source.channel, self._taker(source)) for source in machine.sources]
        for belt in machine.names["belt"]:
            self._subscriptions.append(self._newest(f"takt/belt_objects/{belt}", self._on_objects))
        for track in machine.names["track"]:
            self._subscriptions.append(self._newest(f"takt/track_shapes/{track}", self._on_shape))
        for mover in machine.names["mover"]:
            self._subscriptions.append(self._newest(f"takt/mover_routes/{mover}", self._on_route))

    def _newest(self, channel: str, handler: Any) -> Any:
        """One message is enough until the next tick."""
        subscription = self._news.subscribe(re.escape(channel), handler)
        subscription.set_queue_capacity(1)
        return subscription

    def _taker(self, source: Source) -> Any:
        overview = self.overview
        assert overview is not None

        def take(_: str, data: bytes) -> None:
            if source.layout.fits(data):
                overview.take(source, data)

        return take

    def _on_engine(self, _: str, data: bytes) -> None:
        message = _decoded(msgs.engine_state, data)
        if message is None or self.machine is None or message.run_id != self.machine.run_id:
            return
        self._heard = time.monotonic()
        figures = fields_of(message)
        del figures["state_hash"], figures["run_id"]
        for name in ("execution", "latency"):
            histogram = figures[name]
            figures[name] = {"count": histogram.count, "max": histogram.max, "buckets": list(histogram.buckets)}
        self.engine = figures
        assert self.overview is not None
        self.overview.cycle = max(self.overview.cycle, message.cycle)

    def _on_command(self, _: str, data: bytes) -> None:
        message = _decoded(msgs.command, data)
        if message is not None and self.machine is not None and message.run_id == self.machine.run_id:
            self.made_cams.take_command(message)
            self.ledger.take_command(message, self.overview.cycle if self.overview else 0)

    def _on_feedback(self, _: str, data: bytes) -> None:
        message = _decoded(msgs.feedback, data)
        if message is not None:
            self.made_cams.take_feedback(message)
            self.ledger.take_feedback(message)
            for listener in list(self.listeners):
                listener(message)

    def _on_objects(self, _: str, data: bytes) -> None:
        message = _decoded(msgs.belt_objects, data)
        if message is not None:
            self.objects[message.name] = rows_of(objects_of(message))

    def _on_shape(self, _: str, data: bytes) -> None:
        message = _decoded(msgs.track_shape, data)
        if message is not None:
            self.shapes.take(message)

    def _on_route(self, _: str, data: bytes) -> None:
        message = _decoded(msgs.mover_route, data)
        if message is not None:
            self.routes.take(message)

    def _place_links(self) -> None:
        assert self.machine is not None
        assert self.overview is not None
        for name, (_, axes, _) in self.machine.mechanisms.items():
            joints = np.array([[self.overview.value(axis, "actual_position") for axis in axes]], float)
            poses = rounded_poses(self.machine.link_poses(name, joints)[0])
            self.links[name] = poses.tolist() if np.all(np.isfinite(poses)) else []


def _drain(network: Any, most: int) -> None:
    for _ in range(most):
        if not network.handle_timeout(0):
            return


def _decoded(kind: Any, data: bytes) -> Any:
    """The message, or None where the bytes are something else."""
    try:
        return kind.decode(data)
    except Exception:  # generated code raises whatever comes
        return None
