"""The messages of an engine over LCM, for the page.

Each component has up to two subscriptions: the overview takes its newest message several times a second and lets LCM
drop the others before they reach Python; the scope takes every message of the few components whose signals are shown,
into rings. All processing happens in `tick`, on one thread; between ticks LCM's own threads store the messages."""

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

QUEUE = 200_000  # capacity for messages until the next tick, on channels that must not lose any
AT_ONCE = 2000  # most messages of one tick, besides states
SILENCE_S = 3.0  # silence after which the engine counts as gone
TAKEN_OVER_S = 1.5  # silence after which another engine that is heard replaces it
KEPT_S = 30.0  # how long signals that no page shows are kept, for a page that comes back


class Tap:
    """All messages of one component, and the latest values of those of its signals that are shown."""

    def __init__(self, source: Source, period_s: float) -> None:
        self.source = source
        self.ring = Ring(())
        self.lost = 0  # messages lost: gaps in the sequence
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
        """file: machine file on this host; if it equals the running machine, the meshes that it names are drawn."""
        self.url = url
        self._file = file
        self.machine: Machine | None = None
        self.overview: Overview | None = None
        self.ledger = Ledger(())
        self.made_cams = MadeCams(drawn)
        self.taps: dict[int, Tap] = {}
        self.engine: dict[str, Any] | None = None
        self.objects: dict[str, list[list[float]]] = {}  # objects on belts
        self.shapes = Shapes()  # of tracks
        self.routes = Routes()  # of movers
        self.links: dict[str, list[list[float]]] = {}  # poses of the links of groups
        self.trouble = ""  # a problem outside the engine, as a sentence
        self.messages = 0  # messages of the scope so far
        self.epoch = 0  # counts the machines that were seen
        self.listeners: set[Callable[[msgs.feedback], None]] = set()  # called with each feedback
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
        """No machine is known, or its engine has been silent for SILENCE_S."""
        return self.machine is None or time.monotonic() - self._heard > SILENCE_S

    @property
    def lost(self) -> int:
        return sum(tap.lost for tap in self.taps.values())

    @property
    def _latest_cycle(self) -> float:
        """Upper bound of the cycle of any component, from the engine's own state, whose messages carry the number of
        the run."""
        if self.engine is None or self.machine is None:
            return math.inf
        return float(self.engine["cycle"]) + JUMP_S / self.machine.period_s

    @property
    def network(self) -> Any:
        """The network for commands."""
        return self._news

    # --- shown signals ---

    def look_at(self, wanted: Iterable[tuple[int, str]]) -> None:
        """Sets the signals that all pages together show: (component, field). Others are kept for KEPT_S."""
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

    # --- received messages ---

    def tick(self) -> None:
        """Processes all messages received since the previous call."""
        # New states may arrive as fast as they are taken: one of each suffices.
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
        """Subscribes to a channel with a queue of one message: the newest one suffices until the next tick."""
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
    """Returns the message; None if the bytes are invalid."""
    try:
        return kind.decode(data)
    except Exception:  # generated code raises any exception
        return None
