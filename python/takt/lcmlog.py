"""LCM logs: written of a network; and read, those of taktd and of any logger, as recordings and journals."""

from __future__ import annotations

import bisect
import contextlib
import functools
import itertools
import json
import math
import os
from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from takt import _core, msgs
from takt.arguments import without_arguments
from takt.belt_object_log import BeltObjectLog, objects_of
from takt.counted import counted
from takt.errors import ConfigError
from takt.events import Event, EventLog, LogError, Progress
from takt.figures import DROPPED, figures_of
from takt.made_cams import is_kept
from takt.names import shown
from takt.network import open_network, roomy, usual_url
from takt.recording import Array, Recording
from takt.sequences import OBJECTS, Sequences
from takt.tables import KINDS, PREFIXES, components_of, is_possible, make_recording, table_of

STATE_TYPES = tuple(kind.message for kind in KINDS.values())
MESSAGES: dict[str, Any] = {
    "takt/machine": msgs.machine_description,
    "takt/engine": msgs.engine_state,
    "takt/command": msgs.command,
    "takt/feedback": msgs.feedback,
    "takt/cams": msgs.cam_piece,
    "takt/journal/start": msgs.journal_start,
    "takt/journal/command": msgs.journal_command,
    "takt/journal/drive": msgs.journal_drive,
    "takt/journal/hashes": msgs.journal_hashes,
}
# Of channels that end in the name of a component.
NAMED: dict[str, Any] = {
    **{prefix: KINDS[kind].message for kind, prefix in PREFIXES.items()},
    OBJECTS: msgs.belt_objects,
    "takt/track_shapes/": msgs.track_shape,
    "takt/mover_trails/": msgs.mover_trail,
    "takt/mover_routes/": msgs.mover_route,
}
NAMED_TYPES = tuple(NAMED.values())
# Of channels takt/drive/AXIS/...
DRIVES: dict[str, Any] = {"setpoint": msgs.drive_setpoint, "feedback": msgs.drive_feedback}
STATES = ("busy", "active", "done", "aborted", "error")

PATIENCE_S = 30.0  # that writing may be behind
SILENCE_S = 0.1  # of one component while others are heard, and three of its samples at least
BEFORE = 8  # messages that are kept to tell when a command was refused: some may be damaged
EARLY_S = 1.0  # of engine time: a log that begins by then holds all that was said


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
    shapes: list[msgs.track_shape] = field(default_factory=list)
    ways: list[msgs.mover_trail | msgs.mover_route] = field(default_factory=list)
    engine_states: list[msgs.engine_state] = field(default_factory=list)
    commands: list[msgs.command] = field(default_factory=list)
    feedback: list[msgs.feedback] = field(default_factory=list)
    start: msgs.journal_start | None = None
    journal: list[msgs.journal_command] = field(default_factory=list)
    drives: list[msgs.journal_drive] = field(default_factory=list)
    hashes: list[msgs.journal_hashes] = field(default_factory=list)
    descriptions: Counter[tuple[str, float, str]] = field(
        default_factory=Counter
    )  # of the machine: text, period, version
    sequences: Sequences = field(default_factory=Sequences)
    impossible: int = 0  # messages that were decoded, but cannot be true
    returned: bool = False  # it was described again after another one
    contradictions: int = 0  # states whose cycle does not fit in the order, or that another one says otherwise
    heard: deque[Any] = field(default_factory=lambda: deque(maxlen=BEFORE))  # the latest messages that have a cycle
    refused: list[tuple[msgs.feedback, list[Any]]] = field(default_factory=list)  # before a cycle; what was heard then


@dataclass
class Log:
    """A log that was read. An engine that was started anew while it was written makes another run."""

    path: Path
    runs: list[Run]
    messages: Counter[str]  # by channel
    malformed: Counter[str]  # by channel
    left_over: int = 0  # bytes of the file that are no event: it was torn off, or bytes were changed
    wrong: int = 0  # states with numbers that their types have no room for
    changed: int = 0  # messages whose checksums say that they are not as they were written

    @property
    def damaged(self) -> bool:
        return self.left_over > 0

    @property
    def trouble(self) -> str:
        """What is not whole, in a sentence; empty: nothing."""
        said = self.reasons
        return f"The log is not whole: {'; '.join(said)}." if said else ""

    @property
    def reasons(self) -> list[str]:
        """The same, each by itself."""
        said = []
        if self.damaged:
            share = f"{self.left_over:,} of {self.path.stat().st_size:,} bytes"
            said.append(f"it ends in the middle of a message, or bytes of it were changed: {share} are left out")
        if self.changed:
            said.append(f"{counted(self.changed, 'message')} with a checksum that does not hold")
        if count := sum(self.malformed.values()):
            said.append(f"{counted(count, 'message')} could not be decoded")
        if count := sum(run.impossible for run in self.runs) + self.wrong:
            said.append(f"{counted(count, 'message')} cannot be true")
        if (count := sum(run.returned for run in self.runs)) > 1:  # one may be a description with changed bytes
            said.append(
                f"{count} engines spoke at once on its network: which of them a state is of is not known, and each run "
                "has what was said behind its own descriptions"
            )
        if count := sum(run.contradictions for run in self.runs):
            said.append(f"{counted(count, 'state')} of components in contradiction to others")
        return said

    def starts(self, run: int) -> str:
        """Which one of several starts of the engine a run is, in a sentence; empty: there is but one."""
        if len(self.runs) == 1:
            return ""
        count, which = len(self.runs), run % len(self.runs)
        return f"The log holds {count} starts of the engine, from 0 on: this is number {which}; --run chooses another."


def read_events(path: str | os.PathLike[str], progress: Progress | None = None) -> Iterator[Event]:
    """Every event of a log that is whole: wall clock in us, channel, bytes."""
    return EventLog(path).events(progress)


def open_log(path: str | os.PathLike[str], progress: Progress | None = None) -> Log:
    """Reads all messages of a log that are Takt's. What is damaged costs itself alone (`Log.trouble`)."""
    events = EventLog(path)
    log = Log(events.path, [Run()], Counter(), Counter())
    for event in events.events(progress):
        log.messages[event.channel] += 1
        kind = _kind_of(event.channel)
        if kind is None:
            continue
        if _core.checksum_holds(event.channel, event.data) is False:
            log.changed += 1
            continue
        try:
            message = kind.decode(event.data)
        except Exception:  # generated code raises whatever comes
            message = None
        if message is None or not _belongs(message, event.channel):
            log.malformed[event.channel] += 1
            continue
        _sort_in(log.runs, message)
        _run_of(log.runs, message).sequences.hear(event.channel, message)
    log.left_over = events.left_over
    for run in log.runs:
        _leave_out_impossible(run)
    return log


def _leave_out_impossible(run: Run) -> None:
    """Keeps the messages of components and of the engine whose cycle and time say the same, and reports on commands
    in cycles that there were."""
    wrong = [one for one in run.descriptions if not 0 < one[1] < 1]
    if len(wrong) == len(run.descriptions):
        run.impossible += sum(run.descriptions.values())
        return
    for one in wrong:
        run.impossible += run.descriptions.pop(one)
    (_, period, _), _ = run.descriptions.most_common(1)[0]
    for messages in (*run.states.values(), run.objects, run.shapes, run.ways, run.engine_states):
        possible = [message for message in messages if is_possible(message, period)]
        run.impossible += len(messages) - len(possible)
        messages[:] = possible
    for messages in run.states.values():
        run.contradictions += _put_in_order(messages)
    run.states = {name: messages for name, messages in run.states.items() if messages}
    cycles = [one.cycle for one in run.engine_states] + [one[-1].cycle for one in run.states.values()]
    latest = max(cycles) + 1 / period if cycles else math.inf  # what is said last may be missing
    possible = [report for report in run.feedback if _is_possible(report, latest)]
    run.impossible += len(run.feedback) - len(possible)
    run.feedback[:] = possible


def _is_possible(report: msgs.feedback, latest: float) -> bool:
    """What a cycle has brought says which one it was: all but the refusal of a command that never came so far, and that
    it is waited for."""
    if report.cycle >= 0:
        return bool(report.cycle <= latest)
    refused = report.state == STATES.index("error") and report.ticket <= 0
    return refused or report.state == STATES.index("busy")


def _put_in_order(states: list[Any]) -> int:
    """Leaves the states of one component of which each has a later cycle than the one before: as many as there can be,
    so that one with a cycle of the future costs itself alone. How many others there were, but for those that came twice
    or late."""
    if all(one.cycle < other.cycle for one, other in itertools.pairwise(states)):
        return 0
    ends: list[int] = []  # of runs of each length, their last cycle, the least there is
    last: list[int] = []  # and where it stands
    before: list[int] = []
    for i, state in enumerate(states):
        length = bisect.bisect_left(ends, state.cycle)
        before.append(last[length - 1] if length else -1)
        if length == len(ends):
            ends.append(state.cycle)
            last.append(i)
        elif state.cycle < ends[length]:  # of the same cycle the first one counts
            ends[length], last[length] = state.cycle, i
    chosen, at = [], last[-1]
    while at >= 0:
        chosen.append(at)
        at = before[at]
    kept = {states[i].cycle: states[i] for i in reversed(chosen)}
    contradictions, latest, places = 0, -1, set(chosen)
    for i, state in enumerate(states):
        if i in places:
            latest = state.cycle
        elif state.cycle in kept:
            contradictions += state.encode() != kept[state.cycle].encode()
        else:
            contradictions += state.cycle > latest
    states[:] = kept.values()
    return contradictions


@functools.lru_cache(4096)
def _kind_of(channel: str) -> Any:
    """The type of a channel's messages; None: it is none of Takt's, or not looked at."""
    if channel in MESSAGES:
        return MESSAGES[channel]
    if channel.startswith("takt/drive/"):
        return DRIVES.get(channel.rsplit("/", 1)[-1])
    return next((kind for prefix, kind in NAMED.items() if channel.startswith(prefix)), None)


def _belongs(message: Any, channel: str) -> bool:
    """A component's message comes on its own channel; states of commands are those that there are."""
    if isinstance(message, msgs.feedback):
        return 0 <= message.state < len(STATES)
    return not isinstance(message, NAMED_TYPES) or channel.endswith(f"/{message.name}")


def _sort_in(runs: list[Run], message: Any) -> None:
    run = _run_of(runs, message)
    if isinstance(message, (msgs.machine_description, msgs.journal_start)):
        if isinstance(message, msgs.journal_start):
            run.start = message
            run.machine = run.machine or message
        else:
            run.machine = message  # which also has the name
        run.descriptions[message.text, message.period_s, message.version] += 1
    elif isinstance(message, STATE_TYPES):
        run.states.setdefault(message.name, []).append(message)
        run.heard.append(message)
    elif isinstance(message, msgs.belt_objects):
        run.objects.append(message)
    elif isinstance(message, msgs.track_shape):
        run.shapes.append(message)
    elif isinstance(message, (msgs.mover_trail, msgs.mover_route)):
        run.ways.append(message)
    elif isinstance(message, msgs.engine_state):
        run.engine_states.append(message)
        run.heard.append(message)
    elif isinstance(message, msgs.command):
        run.commands.append(message)
    elif isinstance(message, msgs.feedback):
        run.feedback.append(message)
        if message.cycle < 0 and message.state == STATES.index("error") and message.id > 0:  # 0: of a heartbeat
            run.refused.append((message, list(run.heard)))
    elif isinstance(message, msgs.journal_command):
        run.journal.append(message)
    elif isinstance(message, msgs.journal_drive):
        run.drives.append(message)
    elif isinstance(message, msgs.journal_hashes):
        run.hashes.append(message)


def _run_of(runs: list[Run], message: Any) -> Run:
    """The run that a message is of: the last one, unless it says which one itself."""
    if isinstance(message, (msgs.machine_description, msgs.journal_start)):
        known = [run for run in runs if run.machine is None or run.machine.run_id == message.run_id]
        if not known:
            runs.append(Run())
        elif known[-1] is not runs[-1]:
            known[-1].returned = True
            runs.remove(known[-1])
            runs.append(known[-1])
    return runs[-1]


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
    text, period, version = _description(one)
    if not 0 < period < 1:
        raise LogError(f"{log.path}: the period of the machine that it describes is {period:g} s")
    machine = json.loads(_core.load_machine(text.encode(), shown(log.path), files=False))
    tables: dict[str, dict[str, Array]] = {}
    components = components_of(machine)
    wrong = sum(len(states) for name, states in one.states.items() if name not in components)
    for name, (kind, _) in components.items():
        if name in one.states:
            tables[name], left_out = table_of(kind.name, one.states[name], period)
            wrong += left_out
    silent, late = _unheard(machine, tables, one, period)
    meta = {
        "source": shown(log.path),
        "period_s": period,
        "version": version,
        "losses": one.sequences.lost(),
        "dropped": _dropped(one, period),
        "silent": silent,
        "late": late,
        "trouble": log.trouble if not wrong else replace(log, wrong=wrong).trouble,
        "starts": log.starts(run),
        "objects": _lying(one, period).columns(),
        "engine": figures_of(one.engine_states[-1]) if one.engine_states else {},
        **_made_cams(one),
    }
    return make_recording(machine, tables, _events(one, period), meta, text)


def _description(run: Run) -> tuple[str, float, str]:
    """Text, period and version of a run's machine: those said most often of those that can be, as bytes of one may have
    been changed."""
    said = [one for one, _ in run.descriptions.most_common()]
    for text, period, version in said:
        with contextlib.suppress(ConfigError):
            if 0 < period < 1:
                _core.load_machine(text.encode(), "machine", files=False)
                return text, period, version
    return said[0]


def _dropped(run: Run, period: float) -> dict[str, int]:
    """What the engine had no room for while the log was written: by its own count, less what it had counted before."""
    if not run.engine_states:
        return {}
    first, last = run.engine_states[0], run.engine_states[-1]
    early = first.cycle * period <= EARLY_S
    counts = {name: getattr(last, name) - (0 if early else getattr(first, name)) for name in DROPPED}
    return {name: count for name, count in counts.items() if count > 0}


def _unheard(
    machine: dict[str, Any], tables: dict[str, dict[str, Array]], run: Run, period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Components, and channels of what lies on belts, that were not heard any more although others were: since when, in
    s; and those of which the beginning is missing: until when. Their numbers say that there was one."""
    rates = {own["axis"]: own["rate_hz"] for own in machine["lcm"]["rates"]}
    published = [name for name in components_of(machine) if rates.get(name, machine["lcm"]["axis_rate_hz"]) > 0]
    heard = {name: tables[name]["cycle"].tolist() if name in tables else [] for name in published}
    numbers = {name: states[0].sequence for name, states in run.states.items() if states}
    for belt in machine["belts"]:
        if belt["name"] in published:
            objects = [message for message in run.objects if message.name == belt["name"]]
            heard[OBJECTS + belt["name"]] = [message.cycle for message in objects]
            numbers[OBJECTS + belt["name"]] = objects[0].sequence if objects else 0
    begin = min((cycles[0] for cycles in heard.values() if cycles), default=0)
    end = max((cycles[-1] for cycles in heard.values() if cycles), default=0)
    silent, late = {}, {}
    for name, cycles in heard.items():
        usual = Counter(b - a for a, b in itertools.pairwise(cycles)).most_common(1)
        slack = max(SILENCE_S / period, 3 * usual[0][0] if usual else 0)
        if not cycles or end - cycles[-1] > slack:
            silent[name] = cycles[-1] * period if cycles else 0.0
        if cycles and cycles[0] - begin > slack and numbers.get(name, 0) > 0:
            late[name] = cycles[0] * period
    return silent, late


def _events(run: Run, period: float) -> Iterator[tuple[float, str, str, str]]:
    """Starts and ends of commands. What was asked is known of commands that the log holds, from clients or from the
    journal. A command that was refused before it came to a cycle has the time of what was heard last before."""
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
    refused = {id(report): _cycle_before(heard, period) for report, heard in run.refused}
    for report in run.feedback:
        key = (report.client, report.session, report.id)
        cycle = refused.get(id(report), report.cycle)
        if cycle < 0 or key in ended:
            continue
        known = asked.get(report.ticket) if report.ticket > 0 else None
        target, text = known or asked.get(key) or ("", f"command {report.id} of {report.client}")
        time_s, component = cycle * period, _component(target)
        if key not in started:
            started.add(key)
            if not journaled or report.cycle < 0:
                yield time_s, component, text, "start"
        if report.state >= STATES.index("done"):
            ended.add(key)
            if report.state == STATES.index("error"):
                yield time_s, component, f"{without_arguments(text)}: {report.sentence}", "error"
            else:
                yield time_s, component, f"{without_arguments(text)}: {STATES[report.state]}", "end"


def _made_cams(run: Run) -> dict[str, Any]:
    """Cams made at run time, as live recordings keep them, by anyone: from the journal where there is one, else from
    the commands of clients."""
    from takt.view.made import MadeCams

    made = MadeCams(lambda table: {"table": table}, builds=max(1, len(run.feedback)))
    for entry in run.journal:  # it has no client; the feedback has its ticket
        command = msgs.command()
        command.id, command.target = entry.ticket, entry.target
        command.verb, command.arguments = entry.verb, entry.arguments
        made.take_command(command)
    for command in () if run.journal else run.commands:
        made.take_command(command)
    for report in run.feedback:
        answer = report
        if run.journal:
            answer = msgs.feedback()
            answer.id, answer.state, answer.value = report.ticket, report.state, report.value
        made.take_feedback(answer)
    cams = [(one["number"], one["table"].source) for one in made.since(0) if is_kept(one["table"])]
    return {"made_cams": cams} if cams else {}


def _cycle_before(heard: list[Any], period: float) -> int:
    """The cycle of the latest message that can be true; 0: none of them."""
    return next((int(message.cycle) for message in reversed(heard) if is_possible(message, period)), 0)


def _text(command: msgs.command | msgs.journal_command) -> str:
    return f"{command.target}.{command.verb} {command.arguments}".rstrip()


def _component(target: str) -> str:
    return "" if target == "machine" else target


def _lying(run: Run, period: float) -> BeltObjectLog:
    lying = BeltObjectLog()
    for message in run.objects:
        lying.look(message.name, message.cycle * period, objects_of(message))
    return lying
