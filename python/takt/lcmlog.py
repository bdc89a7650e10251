"""LCM logs: writes logs of a network; reads logs of taktd and of any logger as recordings and journals."""

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
# Prefixes of channels that end in the name of a component.
NAMED: dict[str, Any] = {
    **{prefix: KINDS[kind].message for kind, prefix in PREFIXES.items()},
    OBJECTS: msgs.belt_objects,
    "takt/track_shapes/": msgs.track_shape,
    "takt/mover_trails/": msgs.mover_trail,
    "takt/mover_routes/": msgs.mover_route,
}
NAMED_TYPES = tuple(NAMED.values())
# Ends of channels takt/drive/AXIS/...
DRIVES: dict[str, Any] = {"setpoint": msgs.drive_setpoint, "feedback": msgs.drive_feedback}
STATES = ("busy", "active", "done", "aborted", "error")

PATIENCE_S = 30.0  # longest wait for writing to finish
SILENCE_S = 0.1  # a component is silent after this, and at least three of its samples, while others are received
BEFORE = 8  # latest messages kept to find when a command was refused: some may be damaged
EARLY_S = 1.0  # of engine time: a log that begins before this is considered to hold all messages


@contextlib.contextmanager
def write_log(path: str | os.PathLike[str], url: str | None = None) -> Iterator[None]:
    """A context in which all messages of an LCM network are written to an LCM log.

    path: the log file; an existing one is overwritten.
    url: None: the network of the environment (LCM_DEFAULT_URL), else the default one.

    All messages that the host has received are written, by a thread of their own, however busy the host is;
    lcm-logger drops messages when it is more than 30 behind. Messages that do not fit into the socket's buffer are
    lost: its size is 4 MiB, if the system allows (net.core.rmem_max), or that of the URL (recv_buf_size).

    Raises ConnectionError if the network cannot be joined or the file cannot be written, LogError if the log is
    incomplete (unless the block itself raised an exception)."""
    network = url or usual_url()
    open_network(network)  # raises errors with the URL as it was given
    log = _core.NetworkLog(roomy(network), os.fsencode(path))
    try:
        yield
    finally:
        whole = log.close(PATIENCE_S)
    if not whole:
        raise LogError(f"{os.fspath(path)}: not all that was said is in it")


@dataclass
class Run:
    """All messages in a log from one run of an engine, in the order in which they were written."""

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
    impossible: int = 0  # decoded messages with implausible values
    returned: bool = False  # it was described again after another run
    contradictions: int = 0  # states with a cycle out of order, or that contradict another state of their cycle
    heard: deque[Any] = field(default_factory=lambda: deque(maxlen=BEFORE))  # the latest messages that have a cycle
    refused: list[tuple[msgs.feedback, list[Any]]] = field(default_factory=list)  # before any cycle; with `heard`


@dataclass
class Log:
    """A log that was read. It has several runs if the engine was restarted while it was written."""

    path: Path
    runs: list[Run]
    messages: Counter[str]  # by channel
    malformed: Counter[str]  # by channel
    left_over: int = 0  # bytes of the file that belong to no event: it is truncated, or bytes were changed
    wrong: int = 0  # states with values that do not fit their types
    changed: int = 0  # messages with a wrong checksum

    @property
    def damaged(self) -> bool:
        return self.left_over > 0

    @property
    def trouble(self) -> str:
        """The reasons why the log is not whole, in a sentence; empty if it is."""
        said = self.reasons
        return f"The log is not whole: {'; '.join(said)}." if said else ""

    @property
    def reasons(self) -> list[str]:
        """The reasons why the log is not whole, one by one; empty if it is."""
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
        """Returns a sentence that says which of several starts of the engine a run is; empty if there is only one."""
        if len(self.runs) == 1:
            return ""
        count, which = len(self.runs), run % len(self.runs)
        return f"The log holds {count} starts of the engine, from 0 on: this is number {which}; --run chooses another."


def read_events(path: str | os.PathLike[str], progress: Progress | None = None) -> Iterator[Event]:
    """Yields every whole event of a log: wall clock [us], channel, bytes. Raises LogError if the file is not a log."""
    return EventLog(path).events(progress)


def open_log(path: str | os.PathLike[str], progress: Progress | None = None) -> Log:
    """Reads all messages of Takt in a log; only damaged ones are lost (`Log.trouble`). Raises LogError if the file is
    not a log. `progress`: called with the progress, 0 to 1."""
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
        except Exception:  # generated code raises many kinds of errors
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
    """Keeps only messages of components and of the engine whose cycle and time agree, and feedback with a cycle that
    was run."""
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
    latest = max(cycles) + 1 / period if cycles else math.inf  # the last messages may be missing
    possible = [report for report in run.feedback if _is_possible(report, latest)]
    run.impossible += len(run.feedback) - len(possible)
    run.feedback[:] = possible


def _is_possible(report: msgs.feedback, latest: float) -> bool:
    """Returns whether the cycle of a feedback is plausible. Feedback without a cycle is plausible only if it is Busy,
    or the refusal of a command that no cycle has processed."""
    if report.cycle >= 0:
        return bool(report.cycle <= latest)
    refused = report.state == STATES.index("error") and report.ticket <= 0
    return refused or report.state == STATES.index("busy")


def _put_in_order(states: list[Any]) -> int:
    """Reduces the states of one component to a longest subsequence with increasing cycles, so that a single state with
    a future cycle does not displace others. Returns the number of removed states that are neither repeated nor late."""
    if all(one.cycle < other.cycle for one, other in itertools.pairwise(states)):
        return 0
    ends: list[int] = []  # by length of subsequence: its least possible last cycle
    last: list[int] = []  # and the index of that state
    before: list[int] = []
    for i, state in enumerate(states):
        length = bisect.bisect_left(ends, state.cycle)
        before.append(last[length - 1] if length else -1)
        if length == len(ends):
            ends.append(state.cycle)
            last.append(i)
        elif state.cycle < ends[length]:  # the first state of a cycle counts
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
    """Returns the type of a channel's messages; None if it is not Takt's, or is not read."""
    if channel in MESSAGES:
        return MESSAGES[channel]
    if channel.startswith("takt/drive/"):
        return DRIVES.get(channel.rsplit("/", 1)[-1])
    return next((kind for prefix, kind in NAMED.items() if channel.startswith(prefix)), None)


def _belongs(message: Any, channel: str) -> bool:
    """Returns whether a message of a component is on that component's channel, and a feedback has a known state."""
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
    """Returns the run of a message: the last one, unless the message identifies its run."""
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
    """Returns an LCM log as a recording of all components, with the commands as events.

    run: index of one of several starts of the engine in the log; -1: the last one.
    progress: called with the progress, 0 to 1.

    Raises LogError if the file is not a log, or has no such run or no description of its machine.
    """
    return to_recording(open_log(path, progress), run)


def run_of(log: Log, run: int) -> Run:
    """Returns a run by index, from the end if negative. Raises LogError if there is none."""
    try:
        return log.runs[run]
    except IndexError:
        count = counted(len(log.runs), "run")
        raise LogError(f"{log.path}: holds {count}; there is no run {run}: they are counted from 0") from None


def to_recording(log: Log, run: int = -1) -> Recording:
    """Returns one run of a log as a recording. Raises LogError as `read_log`."""
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
    """Returns text, period and version of a run's machine: the most frequent valid description, as bytes of some may
    have been changed."""
    said = [one for one, _ in run.descriptions.most_common()]
    for text, period, version in said:
        with contextlib.suppress(ConfigError):
            if 0 < period < 1:
                _core.load_machine(text.encode(), "machine", files=False)
                return text, period, version
    return said[0]


def _dropped(run: Run, period: float) -> dict[str, int]:
    """Returns the engine's counts of dropped messages while the log was written, without those from before."""
    if not run.engine_states:
        return {}
    first, last = run.engine_states[0], run.engine_states[-1]
    early = first.cycle * period <= EARLY_S
    counts = {name: getattr(last, name) - (0 if early else getattr(first, name)) for name in DROPPED}
    return {name: count for name, count in counts.items() if count > 0}


def _unheard(
    machine: dict[str, Any], tables: dict[str, dict[str, Array]], run: Run, period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Returns the components, and channels of objects on belts, that fell silent while others did not, with the time
    [s] of their last message; and those whose beginning is missing (by their sequence numbers), with the time of the
    first."""
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
    """Yields starts and ends of commands. Their texts are known for commands in the log, from clients or the journal. A
    command refused before any cycle has the time of the last message before it."""
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
    """Returns the cams made at run time by any client, in the form of live recordings: from the journal if there is
    one, else from the commands of clients."""
    from takt.view.made import MadeCams

    made = MadeCams(lambda table: {"table": table}, builds=max(1, len(run.feedback)))
    for entry in run.journal:  # has no client; matched by the ticket of the feedback
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
    """Returns the cycle of the latest plausible message; 0 if there is none."""
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
