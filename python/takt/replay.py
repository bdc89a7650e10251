"""Replays a journal and compares the whole state after every cycle, and the published values of components."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from takt import _core, msgs
from takt.counted import counted
from takt.events import LogError, Progress
from takt.lcmlog import Run, open_log, run_of
from takt.names import shown
from takt.replay_comparison import Comparison, StateDifference
from takt.tables import components_of

CHUNK = 2_000  # cycles between two reports of progress
WIRES = tuple(_core.servo_inputs())

Hashes = tuple[npt.NDArray[np.int64], npt.NDArray[np.uint64]]  # cycles, rising, and the hash after each


@dataclass(frozen=True)
class Difference:
    """The first cycle after which the states differ."""

    cycle: int
    recorded: int  # hash of the state
    replayed: int


@dataclass(frozen=True)
class ReplayResult:
    machine: str
    cycles: int  # compared cycles
    of: int  # cycles from 0 to the last one mentioned in the log
    commands: int
    period_s: float
    version: str  # of the engine that wrote the log
    difference: Difference | None
    missing: str  # why not all cycles could be compared; empty: all were
    states: int = 0  # compared recorded messages: of components, belts, tracks, and feedback
    wrong_states: int = 0  # those of them that differ from the replay
    state_difference: StateDifference | None = None

    @property
    def complete(self) -> bool:
        """Whether the journal is complete from the first cycle to the last one mentioned in the log."""
        return not self.missing

    @property
    def same(self) -> bool:
        """Whether all cycles and all messages of the log were compared and equal."""
        return self.complete and self.difference is None and self.state_difference is None

    def __bool__(self) -> bool:
        return self.same

    @property
    def sentence(self) -> str:
        span = f"{counted(self.cycles, 'cycle')} ({self.cycles * self.period_s:.3f} s)"
        states = f" and {counted(self.states, 'recorded message')}" if self.states else ""
        what = f"{span} with {counted(self.commands, 'command')}{states}"
        if self.difference is not None:
            at = self.difference.cycle
            missing = f" ({self.missing})" if self.missing else ""
            return f"{what}: differs from cycle {at} ({at * self.period_s:.4f} s) on{missing}"
        if (state := self.state_difference) is not None:
            where = f"{state.component}.{state.field} in cycle {state.cycle} ({state.cycle * self.period_s:.4f} s)"
            return (
                f"{what}: {self.wrong_states:,} of the recorded messages are not what the run published: "
                f"{where} was {state.replayed}, the log has {state.recorded}"
            )
        if self.missing:
            compared = f"{self.cycles:,} of {counted(self.of, 'cycle')}"
            return f"{compared} compared and equal, so not proven the same: {self.missing}"
        return f"{what}: the same, bit for bit"


def replay(log: str | os.PathLike[str], *, run: int = -1, progress: Progress | None = None) -> ReplayResult:
    """Replays a log written by taktd (--log): makes its engine, gives every command so that it is applied in the same
    cycle, and compares the hash of the state after every cycle and the messages in the log (components, objects on
    belts, shapes of tracks, trails and routes of movers, feedback) with those of the replay. Not compared: sentences of
    feedback, counters and times of the engine.

    log: the log file.
    run: index of the run in the log; -1: the last one.
    progress: called with the progress, 0 to 1.

    Returns the result. It is `same` only if every cycle from the first to the last one mentioned in the log was
    compared and equal; a gap in the journal ends the comparison. Raises LogError if the file is not a log or has no
    journal.
    """
    content = open_log(log, (lambda share: progress(share / 2)) if progress else None)
    one = run_of(content, run)
    if one.start is None:
        raise LogError(f"{content.path}: holds no journal; taktd writes one with --log")
    cycles, recorded = _hashes(one)
    known = _last_cycle(one, cycles) + 1
    missing = _missing(one, cycles, known) or _contradiction(one, cycles, recorded)
    if content.damaged:
        missing = f"the log is cut off or damaged{', and ' + missing if missing else ''}"
    elif content.trouble:
        missing = f"the log is not whole: {'; '.join([*content.reasons, *([missing] if missing else [])])}"
    comparable = _in_a_row(cycles)
    text = one.start.text.encode()
    engine = _core.Engine(text, shown(content.path), journal=True, period_s=one.start.period_s, checks=False)
    strange = sorted(one.states.keys() - components_of(json.loads(engine.machine_json)).keys())
    if strange:
        missing = missing or f"the log has states of '{strange[0]}', which the machine does not have"
    commands = sorted(one.journal, key=lambda entry: entry.cycle)
    drives = _Drives(engine, one)
    comparison = Comparison(engine, one)
    given = 0
    difference = None
    while difference is None and engine.cycle < comparable:
        while given < len(commands) and commands[given].cycle <= engine.cycle:
            _give(engine, commands[given])
            given += 1
        first = engine.cycle
        next_cycle = commands[given].cycle if given < len(commands) else comparable
        next_cycle = min(next_cycle, drives.give(first))
        comparison.step(min(comparable, first + CHUNK, next_cycle))
        made = engine.take_hashes()[1]
        wrong = np.flatnonzero(made != recorded[first : first + len(made)])
        if len(wrong):
            at = first + int(wrong[0])
            difference = Difference(at, int(recorded[at]), int(made[wrong[0]]))
        comparison.compare(first + (int(wrong[0]) if len(wrong) else len(made)))
        engine.take_journal()
        engine.take_drive_journal()
        if progress is not None:
            progress(0.5 + 0.5 * engine.cycle / comparable)
    compared = comparable if difference is None else difference.cycle + 1
    name = json.loads(engine.machine_json)["name"]
    return ReplayResult(
        name,
        compared,
        known,
        given,
        one.start.period_s,
        one.start.version,
        difference,
        missing,
        comparison.compared,
        comparison.wrong,
        comparison.first,
    )


class _Drives:
    """Feeds the recorded measurements of external drives to the engine."""

    def __init__(self, engine: _core.Engine, run: Run) -> None:
        self._engine = engine
        axes = [axis["name"] for axis in json.loads(engine.machine_json)["axes"]]
        self._axes = {name: index for index, name in enumerate(axes)}
        self._entries = sorted(run.drives, key=lambda entry: entry.cycle)
        self._given = 0

    def give(self, cycle: int) -> int:
        """Feeds the measurements used in this cycle. Returns the next cycle with measurements."""
        while self._given < len(self._entries) and self._entries[self._given].cycle <= cycle:
            feedback = self._entries[self._given].feedback
            if feedback.axis not in self._axes:
                raise LogError(f"the journal has a drive of axis {feedback.axis!r}, which the machine does not have")
            wires = {name: getattr(feedback, name) for name in WIRES}
            self._engine.hear(self._axes[feedback.axis], feedback.cycle, wires)
            self._given += 1
        return self._entries[self._given].cycle if self._given < len(self._entries) else sys.maxsize


def _hashes(run: Run) -> Hashes:
    """Returns all hashes of a run, unsigned again (LCM has no unsigned numbers)."""
    parts = sorted((h for h in run.hashes if h.count > 0 and 0 <= h.first_cycle < 2**62), key=lambda h: h.first_cycle)
    if not parts:
        return np.empty(0, np.int64), np.empty(0, np.uint64)
    cycles = np.concatenate([np.arange(h.first_cycle, h.first_cycle + h.count, dtype=np.int64) for h in parts])
    return cycles, np.concatenate([np.asarray(h.hashes, dtype=np.int64) for h in parts]).view(np.uint64)


def _in_a_row(cycles: npt.NDArray[np.int64]) -> int:
    """Returns the number of cycles from 0 on without a gap."""
    breaks = np.flatnonzero(cycles != np.arange(len(cycles)))
    return int(breaks[0]) if len(breaks) else len(cycles)


def _last_cycle(run: Run, cycles: npt.NDArray[np.int64]) -> int:
    """Returns the last cycle mentioned in the log; -1 if there is none."""
    known = [int(cycles[-1])] if len(cycles) else []
    known += [entry.cycle for entry in run.journal]
    known += [state.cycle for state in run.engine_states]
    known += [states[-1].cycle for states in run.states.values() if states]
    return max(known, default=-1)


def _missing(run: Run, cycles: npt.NDArray[np.int64], known: int) -> str:
    """Returns why the journal cannot be replayed completely; empty if it can."""
    dropped = max((state.journal_dropped for state in run.engine_states), default=0)
    if dropped > 0:
        return f"the journal lost {dropped:,} entries"
    if not len(cycles):
        return "the journal holds no hashes"
    row = _in_a_row(cycles)
    if row < len(cycles):
        return f"the journal has no hash of cycle {row:,}" if cycles[row] > row else f"cycle {row - 1:,} comes twice"
    if row < known:
        return f"the journal ends after cycle {row - 1:,}"
    return ""


def _contradiction(run: Run, cycles: npt.NDArray[np.int64], recorded: npt.NDArray[np.uint64]) -> str:
    """Returns what else in the log contradicts its journal; empty if nothing does."""
    start = run.start
    if start is not None and any(text != start.text for text, _, _ in run.descriptions):
        return "the machine that is described is not that of the journal"
    for state in run.engine_states:
        told = state.state_hash & 0xFFFF_FFFF_FFFF_FFFF
        row = int(np.searchsorted(cycles, state.cycle))
        if told and row < len(cycles) and cycles[row] == state.cycle and int(recorded[row]) != told:
            return f"the engine's figures have another hash for cycle {state.cycle:,} than the journal"
    return ""


def _give(engine: _core.Engine, entry: msgs.journal_command) -> None:
    _, error_id, sentence = engine.resubmit(entry.target, entry.verb, entry.arguments, entry.ticket, entry.lease_s)
    if error_id:
        command = f"{entry.target}.{entry.verb} {entry.arguments}"
        raise LogError(f"the journal's command {entry.ticket} ({command}) cannot be given again: {sentence}")
