"""Compares the messages in a log with those that a replay of its journal publishes."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from takt import _core, msgs
from takt.belt_object_log import objects_of
from takt.lcmlog import STATES, Run
from takt.recording import Array
from takt.tables import components_of, fields_of_kind, table_of

OBJECT_FIELDS = ("number", "state", "place", "pose", "in_range", "kind", "colour", "quality")
SHUTDOWN, TOO_OLD = 3015, 3033  # errors of commands: the engine is stopping; too old when received
ERROR, ABORTED = msgs.feedback.STATE_ERROR, msgs.feedback.STATE_ABORTED
SHAPE_FIELDS = ("part", "length", "closed", "position", "x", "y", "direction")


@dataclass(frozen=True)
class StateDifference:
    """A recorded message that differs from the replay's in the same cycle."""

    component: str
    field: str
    cycle: int
    recorded: Any
    replayed: Any


class Comparison:
    """Compares the messages of components, objects on belts, shapes of tracks, trails and routes of movers, and
    feedback. Steps the engine, cycle by cycle where values have to be sampled."""

    def __init__(self, engine: _core.Engine, run: Run) -> None:
        self._engine = engine
        self._states = _States(engine, run)
        self._looks = _Looks(engine, run)
        self._feedback = _Feedback(engine, run)
        self._parts = (self._states, self._looks, self._feedback)

    @property
    def compared(self) -> int:
        return sum(part.tally.compared for part in self._parts)

    @property
    def wrong(self) -> int:
        return sum(part.tally.wrong for part in self._parts)

    @property
    def first(self) -> StateDifference | None:
        found = [part.tally.first for part in self._parts if part.tally.first is not None]
        return min(found, key=lambda difference: difference.cycle, default=None)

    def step(self, end: int) -> None:
        """Runs the engine up to a cycle and collects its published values."""
        self._states.begin()
        while self._engine.cycle < end:
            self._engine.step(min(end, self._looks.next_cycle + 1) - self._engine.cycle)
            self._looks.compare()

    def compare(self, end: int) -> None:
        """Compares the collected values of the cycles before `end`."""
        self._states.compare(end)
        self._feedback.compare(end)


class Tally:
    def __init__(self) -> None:
        self.compared = 0
        self.wrong = 0
        self.first: StateDifference | None = None

    def add(self, difference: StateDifference | None) -> None:
        self.compared += 1
        if difference is not None:
            self.wrong += 1
            self.keep(difference)

    def keep(self, difference: StateDifference) -> None:
        if self.first is None or difference.cycle < self.first.cycle:
            self.first = difference


@dataclass
class _Recorded:
    """The states of one component in a log, as columns."""

    name: str
    index: int  # among the components of the engine
    fields: tuple[str, ...]
    columns: dict[str, Array]
    given: int = 0  # rows compared so far


class _States:
    """Compares the states of components in a log with those published now, in the form in which a recording of the log
    would hold them."""

    def __init__(self, engine: _core.Engine, run: Run) -> None:
        self.tally = Tally()
        self._engine = engine
        self._recorder: _core.Recorder | None = None
        self._all: list[_Recorded] = []
        period = run.start.period_s if run.start is not None else 0.0
        for index, (name, (kind, _)) in enumerate(components_of(json.loads(engine.machine_json)).items()):
            if run.states.get(name):
                columns, _ = table_of(kind.name, run.states[name], period)
                self._all.append(_Recorded(name, index, fields_of_kind(kind.name), columns))

    def begin(self) -> None:
        """Starts recording the next cycles."""
        if self._all:
            self._recorder = self._engine.start_recorder([one.index for one in self._all], 1)

    def compare(self, end: int) -> None:
        """Compares the recorded cycles before `end`."""
        if self._recorder is None:
            return
        self._engine.stop_recorder(self._recorder)
        cycles = self._recorder.cycles().astype(np.int64)
        for place, one in enumerate(self._all):
            last = int(np.searchsorted(one.columns["cycle"], end))
            if not len(cycles) or one.given == last:
                continue
            rows = self._recorder.take_table(place)
            chosen = one.columns["cycle"][one.given : last] - cycles[0]
            wrong = np.zeros(len(chosen), dtype=bool)
            for field in one.fields:
                was, now = one.columns[field][one.given : last], rows[field][chosen]
                differs = ~((was == now) | ((was != was) & (now != now)))  # NaN equals NaN
                if differs.any():
                    at = int(np.flatnonzero(differs)[0])
                    cycle = int(cycles[0] + chosen[at])
                    self.tally.keep(StateDifference(one.name, field, cycle, was[at].item(), now[at].item()))
                wrong |= differs
            self.tally.compared += len(chosen)
            self.tally.wrong += int(wrong.sum())
            one.given = last
        self._recorder = None


class _Looks:
    """Compares objects on belts, shapes of tracks, and trails and routes of movers, in the cycles of their messages."""

    def __init__(self, engine: _core.Engine, run: Run) -> None:
        self.tally = Tally()
        self._engine = engine
        machine = json.loads(engine.machine_json)
        self._belts = {belt["name"]: i for i, belt in enumerate(machine["belts"])}
        self._tracks = {track["name"]: i for i, track in enumerate(machine["tracks"])}
        self._movers = {mover["name"]: i for i, mover in enumerate(machine["movers"])}
        messages: Iterator[Any] = itertools.chain(
            (one for one in run.objects if one.name in self._belts),
            (one for one in run.shapes if one.name in self._tracks),
            (one for one in run.ways if one.name in self._movers),
        )
        self._messages = sorted(messages, key=lambda message: message.cycle)
        self._given = 0

    @property
    def next_cycle(self) -> int:
        """Cycle of the next message."""
        return self._messages[self._given].cycle if self._given < len(self._messages) else 2**62

    def compare(self) -> None:
        """Compares the messages of the last cycle."""
        at = self._engine.cycle - 1
        while self.next_cycle <= at:
            message = self._messages[self._given]
            self._given += 1
            if message.cycle < at:  # not a cycle of this run
                difference: StateDifference | None = StateDifference(message.name, "cycle", at, message.cycle, at)
            else:
                difference = next(self._differences(message), None)
            self.tally.add(difference)

    def _differences(self, message: Any) -> Iterator[StateDifference]:
        def difference(field: str, was: Any, now: Any) -> StateDifference:
            return StateDifference(message.name, field, message.cycle, was, now)

        if isinstance(message, msgs.track_shape):
            shape = (message.part, message.length, bool(message.closed))
            recorded = (*shape, *map(list, (message.position, message.x, message.y, message.direction)))
            for field, was, now in zip(
                SHAPE_FIELDS, recorded, self._engine.track_shape(self._tracks[message.name]), strict=True
            ):
                if not _same(was, now):
                    yield difference(field, was, now)
            return
        if isinstance(message, msgs.mover_trail):
            tracks = [number + 1 for number in self._engine.mover_trail(self._movers[message.name])]
            if list(message.tracks) != tracks:
                yield difference("trail", list(message.tracks), tracks)
            return
        if isinstance(message, msgs.mover_route):
            first, places = self._engine.mover_route(self._movers[message.name])
            recorded_route, replayed = (message.first, *map(list, (message.x, message.y))), (first, *places.T.tolist())
            if recorded_route != replayed:
                yield difference("route", recorded_route, replayed)
            return
        lying = self._engine.belt_objects(self._belts[message.name])
        if message.count != len(lying):
            yield difference("objects", message.count, len(lying))
        for one, other in zip(objects_of(message), lying, strict=False):
            for field, was, now in zip(OBJECT_FIELDS, one, other, strict=True):
                if not _same(was, now):
                    yield difference(f"object {other[0]}: {field}", was, now)


class _Feedback:
    """Compares the feedback of commands. Not compared: sentences (a replay does not check paths against the cell and so
    knows less), the client of a command, and refusals by a stopping engine or of commands that were too old: these are
    not in the journal."""

    def __init__(self, engine: _core.Engine, run: Run) -> None:
        self.tally = Tally()
        self._engine = engine
        self._targets = {entry.ticket: entry.target for entry in run.journal}
        reports = (one for one in run.feedback if one.ticket > 0 and not self._never_began(one))
        self._reports = sorted(reports, key=lambda report: report.cycle)
        self._given = 0

    def _never_began(self, report: msgs.feedback) -> bool:
        refused = report.state == ERROR and report.error_id in (SHUTDOWN, TOO_OLD)
        return refused and report.ticket not in self._targets

    def compare(self, end: int) -> None:
        made: dict[tuple[int, int], list[tuple[Any, ...]]] = {}
        for ticket, cycle, state, reached, error_id, value, _, *place in self._engine.take_feedback():
            made.setdefault((ticket, cycle), []).append((state, reached, error_id, value, *place))
        while self._given < len(self._reports) and self._reports[self._given].cycle < end:
            report = self._reports[self._given]
            self._given += 1
            where = (report.object_kind, report.object_number)
            # A replay has no reason for the stop.
            stopped = report.state == ABORTED and report.error_id == SHUTDOWN
            error_id = 0 if stopped else report.error_id
            recorded = (report.state, bool(report.reached), error_id, report.value, *where)
            replayed = made.get((report.ticket, report.cycle), [])
            if any(_same(recorded, one) for one in replayed):
                self.tally.add(None)
                continue
            target = self._targets.get(report.ticket, "engine")
            said = " and ".join(map(_said, replayed)) or "nothing"
            field = f"feedback of command {report.ticket}"
            self.tally.add(StateDifference(target, field, report.cycle, _said(recorded), said))


def _said(report: tuple[Any, ...]) -> str:
    state, reached, error_id, value, *_ = report
    words = [STATES[state]]
    words += ["reached"] if reached else []
    words += [f"error {error_id}"] if error_id else []
    words += [f"value {value}"] if value else []
    return ", ".join(words)


def _same(one: Any, other: Any) -> bool:
    """Returns whether two values are equal bit for bit, except for the sign of 0; NaN equals NaN."""
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(_same, one, other))
    return bool(one == other or (one != one and other != other))
