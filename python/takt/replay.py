"""Runs a journal again and compares the whole state after every cycle."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from takt import _core
from takt.lcmlog import LogError, Progress, open_log

CHUNK = 10_000  # cycles between two reports of progress


@dataclass(frozen=True)
class Difference:
    """The first cycle after which the state was another one."""

    cycle: int
    recorded: int
    replayed: int


@dataclass(frozen=True)
class ReplayResult:
    machine: str
    cycles: int  # that were compared
    commands: int
    period_s: float
    version: str  # of the engine that wrote the log
    difference: Difference | None

    @property
    def same(self) -> bool:
        return self.difference is None

    def __bool__(self) -> bool:
        return self.same

    @property
    def sentence(self) -> str:
        what = f"{self.cycles} cycles ({self.cycles * self.period_s:.3f} s) with {self.commands} commands"
        if self.difference is None:
            return f"{what}: the same, bit for bit"
        at = self.difference.cycle
        return f"{what}: differs from cycle {at} ({at * self.period_s:.4f} s) on"


def replay(log: str | os.PathLike[str], *, run: int = -1, progress: Progress | None = None) -> ReplayResult:
    """Rebuilds the engine from a log that taktd wrote (--log), gives every command so that it is applied in the same
    cycle, and compares the hash of the state after every cycle. Hashes are compared as far as the log has them."""
    content = open_log(log, (lambda share: progress(share / 2)) if progress else None)
    one = content.runs[run]
    if one.start is None:
        raise LogError(f"{content.path}: holds no journal; taktd writes one with --log")
    recorded = _join((h.first_cycle, h.hashes) for h in one.hashes)
    engine = _core.Engine(one.start.text.encode(), str(content.path), journal=True, period_s=one.start.period_s)
    entries = iter(sorted(one.journal, key=lambda e: e.cycle))
    entry = next(entries, None)
    last = max(recorded, default=-1)
    commands = 0
    difference = None
    compared = 0
    while difference is None and engine.cycle <= last:
        while entry is not None and entry.cycle <= engine.cycle:
            _give(engine, entry.target, entry.verb, entry.arguments, entry.lease_s, entry.ticket)
            commands += 1
            entry = next(entries, None)
        until = min(last + 1, engine.cycle + CHUNK, entry.cycle if entry is not None else last + 1)
        engine.step(until - engine.cycle)
        cycles, hashes = engine.take_hashes()
        for cycle, value in zip(cycles.tolist(), hashes.tolist(), strict=True):
            if cycle in recorded:
                compared += 1
                if recorded[cycle] != value:
                    difference = Difference(cycle, recorded[cycle], value)
                    break
        engine.take_feedback()
        engine.take_journal()
        if progress is not None:
            progress(0.5 + 0.5 * engine.cycle / (last + 1))
    name = json.loads(engine.machine_json)["name"]
    return ReplayResult(name, compared, commands, one.start.period_s, one.start.version, difference)


def _join(parts: Iterable[tuple[int, npt.ArrayLike]]) -> dict[int, int]:
    """Hashes by cycle. LCM has no unsigned numbers."""
    joined: dict[int, int] = {}
    for first, hashes in parts:
        values = np.asarray(hashes, dtype=np.int64).view(np.uint64).tolist()
        joined.update(zip(range(first, first + len(values)), values, strict=True))
    return joined


def _give(engine: _core.Engine, target: str, verb: str, arguments: str, lease_s: float, ticket: int) -> None:
    _, error_id, sentence = engine.resubmit(target, verb, arguments, ticket, lease_s)
    if error_id:
        raise LogError(
            f"the journal's command {ticket} ({target}.{verb} {arguments}) cannot be given again: {sentence}"
        )
