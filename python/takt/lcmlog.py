"""LCM logs: written of a network; and read, those of taktd and of any logger, as recordings and journals."""

from __future__ import annotations

import contextlib
import json
import os
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import lcm
import numpy as np

from takt import _core, msgs
from takt.arguments import without_arguments
from takt.counted import counted
from takt.errors import TaktError
from takt.figures import figures_of
from takt.lying import Lying, objects_of
from takt.network import open_network, roomy, usual_url
from takt.recording import Array, Recording
from takt.tables import (
    KINDS,
    PREFIXES,
    components_of,
    is_possible,
    kind_of_channel,
    make_recording,
    table_of,
)

STATE_TYPES = tuple(kind.message for kind in KINDS.values())
EVENT_HEADER = 28  # bytes of an event beside its channel and data
MESSAGES: dict[str, Any] = {
    "takt/machine": msgs.machine_description,
    "takt/engine": msgs.engine_state,
    "takt/command": msgs.command,
    "takt/feedback": msgs.feedback,
    "takt/journal/start": msgs.journal_start,
    "takt/journal/command": msgs.journal_command,
    "takt/journal/drive": msgs.journal_drive,
    "takt/journal/hashes": msgs.journal_hashes,
}
STATES = ("busy", "active", "done", "aborted", "error")

PATIENCE_S = 30.0  # that writing may be behind

Progress = Callable[[float], None]


class LogError(TaktError, ValueError):
    """A file is no LCM log, or has not in it what is wanted."""


@contextlib.contextmanager
def write_log(path: str | os.PathLike[str], url: str | None = None) -> Iterator[None]:
    """While the block runs, all that is said on an LCM network [the usual one] goes into an LCM log.

    However busy the host is, what has come to it is written, on a thread of its own: lcm-logger drops what it gets more
    than 30 messages behind with. What the socket has no room for is lost here, too: it gets 4 MiB, where the system
    allows that (net.core.rmem_max), unless the URL says otherwise (recv_buf_size).

    An existing log is written anew. Raises ConnectionError when the network cannot be joined or the file not be
    written, LogError when it has become incomplete (unless the block raised something itself)."""
    network = url or usual_url()
    open_network(network)  # says what is wrong with it as it was given
    log = _core.NetworkLog(roomy(network), os.fsencode(path))
    try:
        yield
    finally:
        whole = log.close(PATIENCE_S)
    if not whole:
        raise LogError(f"{os.fspath(path)}: not all that was said is in it")


@dataclass
class Run:
    """All that a log holds of one run of an engine, in the order it was written."""

    machine: msgs.machine_description | msgs.journal_start | None = None
    states: dict[str, list[Any]] = field(default_factory=dict)  # of components, by name
    objects: list[msgs.belt_objects] = field(default_factory=list)
    engine_states: list[msgs.engine_state] = field(default_factory=list)
    commands: list[msgs.command] = field(default_factory=list)
    feedback: list[msgs.feedback] = field(default_factory=list)
    start: msgs.journal_start | None = None
    journal: list[msgs.journal_command] = field(default_factory=list)
    drives: list[msgs.journal_drive] = field(default_factory=list)
    hashes: list[msgs.journal_hashes] = field(default_factory=list)


@dataclass
class Log:
    """A log that was read. An engine that was started anew while it was written makes another run."""

    path: Path
    runs: list[Run]
    messages: Counter[str]  # by channel
    malformed: Counter[str]  # by channel
    left_over: int = 0  # bytes of the file that are no event: it was torn off, or bytes were changed

    @property
    def damaged(self) -> bool:
        return self.left_over > 0

    @property
    def trouble(self) -> str:
        """What is not whole, in a sentence; empty: nothing."""
        said = []
        if self.damaged:
            share = f"{self.left_over:,} of {self.path.stat().st_size:,} bytes"
            said.append(f"it ends in the middle of a message, or bytes of it were changed: {share} are left out")
        if count := sum(self.malformed.values()):
            said.append(f"{counted(count, 'message')} could not be decoded")
        return f"The log is not whole: {'; '.join(said)}." if said else ""

    def starts(self, run: int) -> str:
        """Which one of several starts of the engine a run is, in a sentence; empty: there is but one."""
        if len(self.runs) == 1:
            return ""
        count, which = len(self.runs), run % len(self.runs)
        return f"The log holds {count} starts of the engine, from 0 on: this is number {which}; --run chooses another."


def read_events(path: str | os.PathLike[str], progress: Progress | None = None) -> Iterator[tuple[int, str, bytes]]:
    """Every event of a log: wall clock in us, channel, bytes. A torn end, as a killed logger leaves it, just ends the
    log."""
    file = Path(path)
    try:
        size = file.stat().st_size
        with file.open("rb") as probe:
            magic = probe.read(4)
    except OSError as error:
        raise LogError(f"{file}: cannot be read: {error.strerror}") from None
    if magic != b"\xed\xa1\xda\x01":
        raise LogError(f"{file}: {'is not an LCM log' if magic else 'is empty'}")
    log = lcm.EventLog(str(file), "r")
    try:
        for count, event in enumerate(log):
            if progress is not None and count % 1024 == 0:
                progress(log.tell() / size)
            yield event.timestamp, event.channel, event.data
    finally:
        log.close()
    if progress is not None:
        progress(1.0)


def open_log(path: str | os.PathLike[str], progress: Progress | None = None) -> Log:
    """Reads all messages of a log that are Takt's."""
    log = Log(Path(path), [Run()], Counter(), Counter())
    size = 0
    for _, channel, data in read_events(path, progress):
        size += EVENT_HEADER + len(channel.encode()) + len(data)
        log.messages[channel] += 1
        component = kind_of_channel(channel)
        kind = component.message if component else MESSAGES.get(channel)
        if channel.startswith("takt/belt_objects/"):
            kind = msgs.belt_objects
        if kind is None:
            continue
        try:
            message = kind.decode(data)
        except Exception:  # generated code raises whatever comes
            log.malformed[channel] += 1
            continue
        _sort_in(log.runs, message)
    log.left_over = max(log.path.stat().st_size - size, 0)
    return log


def _sort_in(runs: list[Run], message: Any) -> None:
    run = runs[-1]
    if isinstance(message, (msgs.machine_description, msgs.journal_start)):
        if run.machine is not None and run.machine.run_id != message.run_id:
            run = Run()
            runs.append(run)
        if isinstance(message, msgs.journal_start):
            run.start = message
            run.machine = run.machine or message
        else:
            run.machine = message  # which also has the name
    elif isinstance(message, STATE_TYPES):
        run.states.setdefault(message.name, []).append(message)
    elif isinstance(message, msgs.belt_objects):
        run.objects.append(message)
    elif isinstance(message, msgs.engine_state):
        run.engine_states.append(message)
    elif isinstance(message, msgs.command):
        run.commands.append(message)
    elif isinstance(message, msgs.feedback):
        run.feedback.append(message)
    elif isinstance(message, msgs.journal_command):
        run.journal.append(message)
    elif isinstance(message, msgs.journal_drive):
        run.drives.append(message)
    elif isinstance(message, msgs.journal_hashes):
        run.hashes.append(message)


def read_log(path: str | os.PathLike[str], *, run: int = -1, progress: Progress | None = None) -> Recording:
    """An LCM log as a recording: every component, with the commands as events. `run` picks one of several starts of the
    engine, the last unless told."""
    return to_recording(open_log(path, progress), run)


def run_of(log: Log, run: int) -> Run:
    """A run by number, from the end if negative."""
    try:
        return log.runs[run]
    except IndexError:
        count = counted(len(log.runs), "run")
        raise LogError(f"{log.path}: holds {count}; there is no run {run}: they are counted from 0") from None


def to_recording(log: Log, run: int = -1) -> Recording:
    """One run of a log as a recording."""
    one = run_of(log, run)
    if one.machine is None:
        raise LogError(f"{log.path}: holds no description of a machine (channel takt/machine)")
    machine = json.loads(_core.load_machine(one.machine.text.encode(), str(log.path)))
    period = one.machine.period_s
    tables: dict[str, dict[str, Array]] = {
        name: table_of(kind.name, [s for s in one.states[name] if is_possible(s, period)], period)
        for name, (kind, _) in components_of(machine).items()
        if name in one.states
    }
    meta = {
        "source": str(log.path),
        "period_s": period,
        "version": one.machine.version,
        "losses": _losses(one),
        "trouble": log.trouble,
        "starts": log.starts(run),
        "objects": _lying(one, period).columns(),
        "engine": figures_of(one.engine_states[-1]) if one.engine_states else {},
    }
    return make_recording(machine, tables, _events(one, period), meta, one.machine.text)


def _events(run: Run, period: float) -> Iterator[tuple[float, str, str, str]]:
    """Starts and ends of commands. What was asked is known of commands that the log holds, from clients or from the
    journal."""
    asked: dict[Any, tuple[str, str]] = {}
    for command in run.commands:
        asked[(command.client, command.session, command.id)] = (command.target, _text(command))
    for entry in run.journal:
        asked[entry.ticket] = (entry.target, _text(entry))
        if entry.verb != "renew":
            yield entry.cycle * period, _component(entry.target), _text(entry), "start"
    journaled = bool(run.journal)
    started: set[Any] = set()
    ended: set[Any] = set()
    for report in run.feedback:
        key = (report.client, report.session, report.id)
        if report.cycle < 0 or key in ended:
            continue
        target, text = asked.get(report.ticket) or asked.get(key) or ("", f"command {report.id} of {report.client}")
        time_s, component = report.cycle * period, _component(target)
        if key not in started:
            started.add(key)
            if not journaled:
                yield time_s, component, text, "start"
        if report.state >= STATES.index("done"):
            ended.add(key)
            if report.state == STATES.index("error"):
                yield time_s, component, f"{without_arguments(text)}: {report.sentence}", "error"
            else:
                yield time_s, component, f"{without_arguments(text)}: {STATES[report.state]}", "end"


def _text(command: msgs.command | msgs.journal_command) -> str:
    return f"{command.target}.{command.verb} {command.arguments}".rstrip()


def _component(target: str) -> str:
    return "" if target == "machine" else target


def _channel(state: Any) -> str:
    """On which a state was published."""
    kind = next(kind for kind in KINDS.values() if isinstance(state, kind.message))
    return PREFIXES[kind.name] + str(state.name)


def _losses(run: Run) -> dict[str, int]:
    """Messages missing by their sequence numbers, by channel."""
    channels: dict[str, list[Any]] = {_channel(states[0]): list(states) for states in run.states.values()}
    channels |= {"takt/engine": list(run.engine_states), "takt/feedback": list(run.feedback)}
    losses = {}
    for channel, messages in channels.items():
        steps = np.diff([m.sequence for m in messages])
        lost = int(np.sum(steps[steps > 1] - 1))
        if lost:
            losses[channel] = lost
    return losses


def _lying(run: Run, period: float) -> Lying:
    lying = Lying()
    for message in run.objects:
        if is_possible(message, period):
            lying.look(message.name, message.cycle * period, objects_of(message))
    return lying
