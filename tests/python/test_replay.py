"""EN-07, PY-04: logs of taktd, read as recordings and run again bit for bit."""

from __future__ import annotations

import re
import signal
import time
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import lcm
import numpy as np
import pytest
import takt
from machines import MACHINE, command_for, new_url, running
from takt import msgs
from takt.lcmlog import open_log


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a run with every command, refused and aborted ones, a jog with heartbeats, a fault, and the stop at the
    end."""
    directory = tmp_path_factory.mktemp("log")
    url = new_url()
    file = directory / "run.lcm"
    with running(directory, url, "--log", str(file)), takt.connect(url) as session:
        x, r = session.axis("x"), session.axis("r")
        x.power()
        r.power().wait()
        r.move_velocity(velocity=200.0, direction="negative")
        x.move_absolute(position=100.0, velocity=300.0).wait()
        x.move_absolute(position=0.1 + 0.2, acceleration=1234.5678901234567)
        x.move_relative(distance=10.0, buffer_mode="buffered").wait()
        x.move_absolute(position=5000.0).wait_final()
        x.jog(backward=True, velocity=20.0).wait(until="active")
        session.run(0.4)
        x.stop(hold=True).wait().release()
        session.run(0.1)
        x.move_velocity(velocity=400.0, direction="negative").wait_final()
        x.reset().wait_final()
        x.halt()
        r.halt()
        r.move_absolute(position=359.0)
    return file


def changed(log: Path, target: Path, change: object) -> Path:
    """A copy of the log whose messages `change` has had in its hands."""
    out = lcm.EventLog(str(target), "w", overwrite=True)
    for event in lcm.EventLog(str(log), "r"):
        data = change(event.channel, event.data)  # type: ignore[operator]
        if data is not None:
            out.write_event(event.timestamp, event.channel, data)
    out.close()
    return target


def test_a_run_is_reproduced(log: Path) -> None:
    """EN-07: every cycle, down to the last one of the stop."""
    shares: list[float] = []
    result = takt.replay(log, progress=shares.append)
    assert result.same, result.sentence
    assert result.machine == "test"
    assert result.cycles > 1500
    assert result.commands > 12
    assert result.sentence.endswith("the same, bit for bit")
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    cycles = takt.read_log(log)["x"]["cycle"]
    assert result.cycles == len(cycles) == cycles[-1] + 1


def test_the_slightest_change_is_found(log: Path, tmp_path: Path) -> None:
    """EN-07: another last bit of one argument of one command, in the cycle in which it counts."""
    wanted = open_log(log).runs[-1]
    at = next(e.cycle for e in wanted.journal if "distance" in e.arguments)

    def change(channel: str, data: bytes) -> bytes:
        if channel != "takt/journal/command":
            return data
        command = msgs.journal_command.decode(data)
        command.arguments = command.arguments.replace("distance: 10.0", "distance: 10.000000000000002")
        return command.encode()

    result = takt.replay(changed(log, tmp_path / "changed.lcm", change))
    assert result.difference is not None
    assert result.difference.cycle == at
    assert "differs from cycle" in result.sentence


def test_forged_states_are_found(log: Path, tmp_path: Path) -> None:
    """EN-36: the journal is whole and is reproduced, but the states beside it are not those of the run."""
    wanted = open_log(log).runs[-1]
    whole = takt.replay(log)
    reports = [report for report in wanted.feedback if report.ticket > 0 and report.cycle >= 0]
    assert reports
    assert whole.states == sum(map(len, wanted.states.values())) + len(reports)
    assert f"{whole.states:,} recorded messages: the same" in whole.sentence
    at = wanted.states["x"][700].cycle

    def change(channel: str, data: bytes) -> bytes:
        if channel != "takt/axis/x":
            return data
        state = msgs.axis_state.decode(data)
        if state.cycle == at:
            state.set_position += 1e-9
        return state.encode()

    result = takt.replay(changed(log, tmp_path / "changed.lcm", change))
    assert not result.same
    assert result.complete
    assert result.difference is None
    assert result.wrong_states == 1
    found = result.state_difference
    assert found is not None
    assert (found.component, found.field, found.cycle) == ("x", "set_position", at)
    assert (
        f"1 of the recorded messages are not what the run published: x.set_position in cycle {at} " in result.sentence
    )


CELL = """
name: cell
axes:
  - {name: drive, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
belts:
  - {name: infeed, axis: drive, upper_limit: 300}
movers:
  - {name: m}
tracks:
  - {name: ring}
"""


@pytest.fixture(scope="module")
def cell_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a run with things on a belt and a track that is made on the way."""
    directory = tmp_path_factory.mktemp("cell")
    url = new_url()
    file = directory / "run.lcm"
    with running(directory, url, "--log", str(file), machine=CELL), takt.connect(url) as session:
        belt = session.belt("infeed")
        belt.axis.power().wait()
        belt.axis.move_velocity(velocity=100.0).wait(until="reached")
        belt.detect(kind=4).wait()
        track = session.track("ring")
        track.append_line(start_x=0, start_y=0, end_x=500, end_y=0)
        track.append_position(x=500, y=300)
        track.enable().wait()
        belt.detect(kind=5, quality=0.5, x=10.0, y=3.0).wait()
        session.run(0.2)
        track.disable().wait()
        track.clear().wait()
    return file


MOVERS = """
name: plane
axes: []
tracks:
  - {name: one, elements: [{from: {x: 0, y: 500}, to: {x: 400, y: 500}}]}
  - {name: two, starts_from: [one], elements: [{from: {x: 400, y: 500}, to: {x: 900, y: 500}}]}
movers: [{name: free, initial: {x: 60, y: 60}}, {name: rider, initial: {x: 0, y: 500}}]
"""


@pytest.fixture(scope="module")
def movers_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a mover on a route, halted on its way, and another one over two tracks."""
    directory = tmp_path_factory.mktemp("movers")
    url = new_url()
    file = directory / "run.lcm"
    with running(directory, url, "--log", str(file), machine=MOVERS), takt.connect(url) as session:
        free, rider = session.mover("free"), session.mover("rider")
        for feedback in (session.track("one").enable(), session.track("two").enable(), free.enable(), rider.enable()):
            feedback.wait()
        rider.join_track(track="one").wait()
        there = rider.move_on_track(track="two", position=300, velocity=600)
        free.set_route(first=free.route_visit, visits=[{"x": 60 + 120 * k, "y": 60} for k in range(5)])
        session.command("machine", "start_routes", {"velocity": 200}).wait()
        session.wait(lambda: free.x > 200)
        free.halt().wait()
        free.continue_route().wait()
        there.wait()
    return file


def forge(message: Any, field: str) -> None:
    """Another value in a field of one of the message's parts, or of itself."""
    owner, _, name = field.rpartition(".")
    if owner:
        message = getattr(message, owner)[-1]
    value = getattr(message, name)
    setattr(message, name, [*value[:-1], value[-1] + 1] if isinstance(value, (list, tuple)) else type(value)(value + 1))


@pytest.mark.parametrize(
    ("channel", "kind", "field", "said"),
    [
        ("takt/mover_trails/rider", msgs.mover_trail, "tracks", r"rider\.trail"),
        ("takt/mover_routes/free", msgs.mover_route, "x", r"free\.route"),
        ("takt/mover_routes/free", msgs.mover_route, "first", r"free\.route"),
    ],
)
def test_forged_trails_and_routes_are_found(
    movers_log: Path, tmp_path: Path, channel: str, kind: Any, field: str, said: str
) -> None:
    """EN-36: the tracks of a mover, and its places on the free surface; what is left out of a route is none."""
    whole = takt.replay(movers_log)
    assert whole.same, whole.sentence
    forged = 0

    def change(where: str, data: bytes) -> bytes:
        nonlocal forged
        if where != channel or forged:
            return data
        message = kind.decode(data)
        if message.count < 2:
            return data
        forged = 1
        forge(message, field)
        return bytes(message.encode())

    result = takt.replay(changed(movers_log, tmp_path / "changed.lcm", change))
    assert forged
    assert not result.same
    assert result.wrong_states == 1
    assert re.search(rf": {said} in cycle \d+ ", result.sentence), result.sentence


@pytest.mark.parametrize(
    ("channel", "kind", "field", "said"),
    [
        ("takt/belt_objects/infeed", msgs.belt_objects, "objects.kind", r"infeed\.object 2: kind"),
        ("takt/belt_objects/infeed", msgs.belt_objects, "objects.place", r"infeed\.object 2: place"),
        ("takt/track_shapes/ring", msgs.track_shape, "y", r"ring\.y"),
        ("takt/track_shapes/ring", msgs.track_shape, "length", r"ring\.length"),
        ("takt/feedback", msgs.feedback, "state", r"infeed\.feedback of command \d+"),
        ("takt/feedback", msgs.feedback, "error_id", r"infeed\.feedback of command \d+"),
        ("takt/feedback", msgs.feedback, "value", r"infeed\.feedback of command \d+"),
        ("takt/feedback", msgs.feedback, "ticket", r"ring\.feedback of command \d+"),
    ],
)
def test_forged_messages_of_every_kind_are_found(
    cell_log: Path, tmp_path: Path, channel: str, kind: Any, field: str, said: str
) -> None:
    """EN-36: what lies on belts, shapes of tracks, and what became of commands."""
    whole = takt.replay(cell_log)
    assert whole.same, whole.sentence
    run = open_log(cell_log).runs[-1]
    assert len(run.shapes) >= 3
    assert any(message.count == 2 for message in run.objects)
    forged = 0

    def change(where: str, data: bytes) -> bytes:
        nonlocal forged
        if where != channel or forged:
            return data
        message = kind.decode(data)
        second = {
            msgs.belt_objects: lambda: message.count == 2 and message.objects[1].place > 0,
            msgs.track_shape: lambda: message.count > 0,
            msgs.feedback: lambda: message.value == 2,
        }
        if not second[kind]():
            return data
        forged = 1
        forge(message, field)
        return bytes(message.encode())

    result = takt.replay(changed(cell_log, tmp_path / "changed.lcm", change))
    assert forged
    assert result.complete
    assert not result.same
    assert result.wrong_states == 1
    assert re.search(rf": {said} in cycle \d+ ", result.sentence), result.sentence


def test_forged_descriptions_and_hashes_are_found(log: Path, tmp_path: Path) -> None:
    """EN-36: limits that a report would judge by, and hashes in the engine's figures, are those of the journal."""

    def other_limits(channel: str, data: bytes) -> bytes:
        if channel != "takt/machine":
            return data
        description = msgs.machine_description.decode(data)
        description.text = description.text.replace("velocity: ", "velocity: 9", 1)
        return description.encode()

    result = takt.replay(changed(log, tmp_path / "limits.lcm", other_limits))
    assert not result.same
    assert "the machine that is described is not that of the journal" in result.sentence

    def other_hash(channel: str, data: bytes) -> bytes:
        if channel != "takt/engine":
            return data
        figures = msgs.engine_state.decode(data)
        figures.state_hash ^= figures.cycle > 500
        return figures.encode()

    result = takt.replay(changed(log, tmp_path / "hash.lcm", other_hash))
    assert not result.same
    assert "the engine's figures have another hash" in result.sentence


def test_a_log_without_a_journal_says_so(log: Path, tmp_path: Path) -> None:
    def change(channel: str, data: bytes) -> bytes | None:
        return None if channel.startswith("takt/journal") else data

    plain = changed(log, tmp_path / "plain.lcm", change)
    with pytest.raises(takt.LogError, match="holds no journal"):
        takt.replay(plain)
    assert len(takt.read_log(plain)["x"]) > 1000


def test_a_log_becomes_a_recording(log: Path) -> None:
    """PY-04: every cycle, with units, names, commands as events."""
    recording = takt.read_log(log)
    x = recording["x"]
    assert np.array_equal(x["cycle"], np.arange(len(x)))
    assert recording.unit("x", "set_velocity") == "mm/s"
    assert recording.meta["machine"] == "test"
    assert recording.meta["losses"] == {}
    assert recording.gaps("x") == []
    starts = [e.text for e in recording.events if e.kind == "start" and e.component == "x"]
    assert any(text.startswith("x.move_absolute {position: 100.0") for text in starts)
    assert any("SW limit" in e.text for e in recording.events if e.kind == "error")
    assert sum(e.text.endswith("aborted") for e in recording.events) >= 2
    takt.expect.within_limits(recording, "r")
    takt.expect.complete(recording, "x")
    assert "ErrorStop" in recording.text("x", "state")


def test_a_torn_log_is_read_as_far_as_it_goes(log: Path, tmp_path: Path) -> None:
    """A logger that was killed leaves half a message."""
    data = log.read_bytes()
    beginning = data.index(data[:4], len(data) // 2)  # of an event: its sync word
    torn = tmp_path / "torn.lcm"
    torn.write_bytes(data[: beginning + 20])  # torn between two events nobody could tell it from a whole log
    assert 100 < len(takt.read_log(torn)["x"]) < len(takt.read_log(log)["x"])
    result = takt.replay(torn)
    assert result.difference is None
    assert not result.complete
    assert not result.same
    assert 100 < result.cycles < result.of
    assert "not proven the same: the log is cut off or damaged" in result.sentence


def _hashes_changed(log: Path, target: Path, change: Callable[[msgs.journal_hashes], bool]) -> takt.ReplayResult:
    def changed_data(channel: str, data: bytes) -> bytes | None:
        if channel != "takt/journal/hashes":
            return data
        hashes = msgs.journal_hashes.decode(data)
        return hashes.encode() if change(hashes) else None

    return takt.replay(changed(log, target, changed_data))


def test_only_what_was_compared_is_the_same(log: Path, tmp_path: Path) -> None:
    """EN-07: a journal with holes, however made, proves nothing beyond them, and ends."""

    def far(hashes: msgs.journal_hashes) -> bool:
        hashes.first_cycle += 10**12
        return True

    def twice(hashes: msgs.journal_hashes) -> bool:
        hashes.first_cycle = 0
        return True

    number = count()
    cases: list[tuple[Callable[[msgs.journal_hashes], bool], bool, str]] = [
        (lambda _: False, False, "holds no hashes"),
        (lambda _: next(number) != 0, False, "no hash of cycle 0"),
        (lambda h: h.first_cycle == 0, True, "the journal ends after cycle"),
        (lambda h: h.first_cycle != 0, False, "no hash of cycle 0"),
        (far, False, "no hash of cycle 0"),
        (twice, True, "comes twice"),
    ]
    for change, some, sentence in cases:
        result = _hashes_changed(log, tmp_path / "holes.lcm", change)
        assert not result.same
        assert not result.complete
        assert (result.cycles > 0) == some or sentence == "comes twice"
        assert sentence in result.sentence


def test_a_journal_that_lost_entries_says_so(log: Path, tmp_path: Path) -> None:
    """EN-07."""

    def change(channel: str, data: bytes) -> bytes:
        if channel != "takt/engine":
            return data
        state = msgs.engine_state.decode(data)
        state.journal_dropped = 11_412
        return state.encode()

    result = takt.replay(changed(log, tmp_path / "lost.lcm", change))
    assert not result.same
    assert result.sentence.endswith("not proven the same: the journal lost 11,412 entries")


def test_runs_that_are_not_there(log: Path) -> None:
    with pytest.raises(takt.LogError, match="holds 1 run; there is no run 5"):
        takt.replay(log, run=5)


def test_a_run_with_overruns_is_reproduced(tmp_path: Path) -> None:
    """EN-05, EN-07: what the engine did on its own when a cycle came too late is in the journal too, and disturbs no
    ticket."""
    url = new_url()
    file = tmp_path / "late.lcm"
    machine = MACHINE.replace("lcm:", "cycle: {overruns_in_a_row: 1}\nlcm:")
    with (
        running(tmp_path, url, "--log", str(file), machine=machine, pace="real") as process,
        takt.connect(url) as session,
    ):
        x = session.axis("x")
        x.power().wait_final()
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.1)
        process.send_signal(signal.SIGCONT)
        session.wait(lambda: x.state is takt.PlcState.ERROR_STOP, 5.0)
        for command in (x.reset, x.power, lambda: x.move_relative(distance=3.0)):
            command().wait_final()  # done, unless this computer is late once more
    log = open_log(file).runs[-1]
    assert any(e.verb == "fail_all_axes" and e.ticket == 0 for e in log.journal)
    assert takt.replay(file).same


def test_a_burst_of_commands_is_reproduced(tmp_path: Path) -> None:
    """EN-07, EN-22: commands at 100 times the rate of the cycle, more than one cycle takes up."""
    url = new_url()
    file = tmp_path / "burst.lcm"
    network = lcm.LCM(url)
    with running(tmp_path, url, "--log", str(file)), takt.connect(url) as session:
        session.axis("r").power().wait()
        message = command_for(session)
        message.client, message.session, message.target, message.verb = "burst", 1, "r", "move_relative"
        for message.id in range(1, 3001):
            message.arguments = f"{{distance: {message.id % 7 - 3}.5}}"
            network.publish("takt/command", message.encode())
        session.run(1.0)
        assert session.axis("r").halt().wait().done
    journal = open_log(file).runs[-1].journal
    assert sum(e.verb == "move_relative" for e in journal) > 500
    assert takt.replay(file).same


def test_files_that_are_no_logs(tmp_path: Path) -> None:
    for name, content, sentence in (
        ("text", b"hello", "is not an LCM log"),
        ("empty", b"", "is empty"),
    ):
        file = tmp_path / name
        file.write_bytes(content)
        with pytest.raises(takt.LogError, match=sentence):
            takt.read_log(file)
    with pytest.raises(takt.LogError, match="cannot be read"):
        takt.read_log(tmp_path / "none")
    other = tmp_path / "other.lcm"
    log = lcm.EventLog(str(other), "w", overwrite=True)
    log.write_event(1, "takt/axis/x", b"\x00" * 20)
    log.write_event(2, "LCM_SELF_TEST", b"")
    log.close()
    content = open_log(other)
    assert content.malformed == {"takt/axis/x": 1}
    with pytest.raises(takt.LogError, match="no description of a machine"):
        takt.read_log(other)


def test_two_runs_in_one_log(log: Path, tmp_path: Path) -> None:
    """An engine that was started again makes another run; the last one is read unless told."""
    both = tmp_path / "both.lcm"
    out = lcm.EventLog(str(both), "w", overwrite=True)
    for run in range(2):
        for event in lcm.EventLog(str(log), "r"):
            data = event.data
            if event.channel == "takt/machine":
                description = msgs.machine_description.decode(data)
                description.run_id += run
                data = description.encode()
            elif event.channel == "takt/journal/start":
                start = msgs.journal_start.decode(data)
                start.run_id += run
                data = start.encode()
            out.write_event(event.timestamp, event.channel, data)
    out.close()
    assert len(open_log(both).runs) == 2
    first, last = takt.read_log(both, run=0), takt.read_log(both)
    assert np.array_equal(first["x"], last["x"])
    with pytest.raises(takt.LogError, match="there is no run 2"):
        takt.read_log(both, run=2)
