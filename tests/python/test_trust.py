"""EN-30 to EN-36: what comes over the network, and what happens to the host, does no harm."""

from __future__ import annotations

import os
import random
import re
import signal
import socket
import struct
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import lcm
import pytest
import takt
from machines import command_for, machine_with, new_url, running, taktd
from takt import lcmlog, msgs
from takt.replay import replay

OVERRUN, TOO_OLD, QUEUE_FULL = 3007, 3033, 3012


def anybody(url: str) -> Callable[[bytes], None]:
    """Sends datagrams to the network, past LCM."""
    host, port = url.removeprefix("udpm://").split("?")[0].split(":")
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    return lambda data: sender.sendto(data, (host, int(port)))  # type: ignore[return-value]


def fragment(
    number: int, size: int, offset: int, index: int, count: int, data: bytes, channel: bytes = b"takt/axis/x"
) -> bytes:
    head = struct.pack(">IIIIHH", 0x4C433033, number, size, offset, index, count)
    return head + (channel + b"\0" if index == 0 else b"") + data


def wrong_fragments() -> Iterator[bytes]:
    source = random.Random(30)
    for number in range(300):
        size = source.choice([0, 100, 70_000, 2**28, 2**31, 2**32 - 1])
        for i in (0, 1, 2):
            offset = source.choice([0, 99, 60_000, 2**24, 2**31 - 1, 2**32 - 60_000])
            yield fragment(
                number, size, offset, i, source.choice([0, 1, 3, 65535]), bytes(source.choice([0, 50, 5000]))
            )


def test_fragments_that_lie_end_nobody(tmp_path: Path) -> None:
    """EN-30: engine, client and recorder hear lying fragments; all go on, and hear what is long and right."""
    url = new_url()
    log = tmp_path / "network.lcm"
    say = anybody(url)
    with running(tmp_path, url), lcmlog.write_log(log, url), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        for i, datagram in enumerate(wrong_fragments()):
            say(datagram)
            if i % 50 == 0:
                time.sleep(0.01)
        long = command_for(session)
        long.client, long.session, long.id, long.target, long.verb = "long", 1, 1, "x", "move_absolute"
        long.arguments = "{position: 5}"
        whole = long.encode()
        pieces = [whole[i : i + 40] for i in range(0, len(whole), 40)]
        for i, piece in enumerate(pieces):
            say(fragment(77, len(whole), 40 * i, i, len(pieces), piece, b"takt/command"))
        session.wait(lambda: x.set_position == 5, what="the long command carried out")
        session.run(0.3)
        assert session.figures["malformed"] > 100
    assert "takt/command" in lcmlog.open_log(log).messages


def test_a_client_may_stop_whatever_it_takes_the_network_for(tmp_path: Path) -> None:
    """EN-32: a forged description of another engine: the client commands no more, but stops; and what it held ends."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as watcher, takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        jog = x.jog(forward=True, velocity=20.0).wait(until="active")
        other = msgs.machine_description()
        other.run_id, other.name, other.period_s = 1, "other", 0.001
        lcm.LCM(url).publish("takt/machine", other.encode())
        time.sleep(0.3)
        with pytest.raises(takt.ConnectionError, match="another engine"):
            x.move_absolute(position=1.0)
        for give in (x.halt, session.stop_all, session.emergency_stop, jog.release, lambda: x.power(enable=False)):
            assert not give().error
        time.sleep(1.0)
        assert watcher._states["x"].set_velocity == 0


def test_what_a_client_holds_ends_with_its_session(tmp_path: Path) -> None:
    """EN-32: a client that cannot command any more sends no heartbeats either."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        x.jog(forward=True, velocity=20.0).wait(until="active")
        other = msgs.engine_state()
        other.run_id = 1
        lcm.LCM(url).publish("takt/engine", other.encode())
        end = time.monotonic() + 3
        while session._states["x"].set_velocity != 0 and time.monotonic() < end:
            time.sleep(0.01)
        assert session._states["x"].set_velocity == 0


def test_a_stranger_among_64_clients_may_stop(tmp_path: Path) -> None:
    """EN-32: no place is left; a new client commands nothing but what stops."""
    url = new_url()
    network = lcm.LCM(url)
    with running(tmp_path, url), takt.connect(url) as old:
        x = old.axis("x")
        x.power().wait()
        x.move_velocity(velocity=20.0).wait(until="active")
        beat = msgs.heartbeat()
        beat.run_id, beat.session = old._run_id, 1
        for i in range(100):
            beat.client = f"squatter {i}"
            network.publish("takt/heartbeat", beat.encode())
        time.sleep(0.2)
        with takt.connect(url) as stranger:
            assert stranger.axis("x").move_absolute(position=1.0).wait_final().error_id == QUEUE_FULL
            assert stranger.axis("x").halt().wait().done
            assert stranger.emergency_stop().wait().done
        assert not x.powered


@pytest.fixture
def engine(tmp_path: Path) -> Iterator[tuple[subprocess.Popen[str], str, Path]]:
    """A taktd that can be sent signals, its network, and its log."""
    url, machine, log = new_url(), tmp_path / "machine.yaml", tmp_path / "run.lcm"
    machine.write_text(machine_with("{axis_rate_hz: 500, dead_man_s: 0.5, command_age_s: 0.8}"))
    command = [taktd(), str(machine), "--lcm-url", url, "--log", str(log)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        assert process.stdout is not None
        while "cycle" not in process.stdout.readline():
            pass
        try:
            yield process, url, log
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGCONT)
                process.send_signal(signal.SIGINT)
            process.communicate(timeout=20)


def test_a_stalled_engine_stops_and_refuses_what_grew_old(engine: tuple[subprocess.Popen[str], str, Path]) -> None:
    """EN-33, EN-34: given while it stood still, a command moves nothing afterwards, and the client is told; the motion
    that was in progress is ended along its ramp, and the stall is published."""
    process, url, _ = engine
    with takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        x.move_velocity(velocity=50.0).wait(until="active")
        process.send_signal(signal.SIGSTOP)
        with pytest.raises(takt.ConnectionError, match=r"does not answer within 2 s; it refuses .* later than 0\.8 s"):
            session.axis("r").power()
        process.send_signal(signal.SIGCONT)
        session.wait(lambda: x.error == OVERRUN and x.set_velocity == 0, 5.0, what="the stop")
        session.run(0.3)
        assert not session.axis("r").powered
        assert session.figures["cycles_skipped"] > 1500
        assert session.figures["latency"]["max"] > 1.5e9
        assert session.figures["ignored"] > 0
        assert x.reset().wait().done  # and it goes on
        assert x.move_relative(distance=1.0).wait().done


def test_commands_of_the_past_are_refused(engine: tuple[subprocess.Popen[str], str, Path]) -> None:
    """EN-31, EN-33: what a client gave and somebody plays again later, under the same name, moves nothing; a stop does
    what it says."""
    _, url, _ = engine
    given: list[bytes] = []
    network = lcm.LCM(url)
    network.subscribe("takt/command", lambda _, data: given.append(data)).set_queue_capacity(0)
    with takt.connect(url, client="panel") as session:
        x = session.axis("x")
        x.power().wait()
        x.move_relative(distance=7.0).wait()
        x.halt().wait()
    while network.handle_timeout(50):
        pass
    time.sleep(2.2)  # the name is free
    with takt.connect(url, client="panel") as session:
        session.run(0.7)  # a heartbeat: what the one before gave is forgotten
    time.sleep(2.2)
    answers: list[msgs.feedback] = []
    network.subscribe("takt/feedback", lambda _, data: answers.append(msgs.feedback.decode(data)))
    with takt.connect(url) as watcher:
        for data in given:
            network.publish("takt/command", data)
        time.sleep(0.5)
        while network.handle_timeout(50):
            pass
        assert watcher.axis("x").set_position == pytest.approx(7.0)
    told = {a.id: a.error_id for a in answers if a.client == "panel"}
    commands = [msgs.command.decode(data) for data in given]
    assert {c.verb: told[c.id] for c in commands} == {"power": TOO_OLD, "move_relative": TOO_OLD, "halt": 0}


@pytest.mark.parametrize("name", ["SIGHUP", "SIGQUIT", "SIGUSR1", "SIGALRM", "SIGXCPU"])
def test_signals_end_along_the_ramps(name: str, engine: tuple[subprocess.Popen[str], str, Path]) -> None:
    """EN-34: whatever signal ends the engine, the axes brake along their ramps."""
    process, url, log = engine
    with takt.connect(url) as session:
        session.axis("x").power().wait()
        session.axis("x").move_velocity(velocity=200.0).wait(until="active")
        session.run(0.4)
        process.send_signal(getattr(signal, name))
        assert process.wait(10) == 0
    velocity = lcmlog.read_log(log)["x"]["set_velocity"]
    assert max(velocity) == pytest.approx(200.0)
    assert velocity[-1] == 0
    assert max(abs(velocity[1:] - velocity[:-1])) < 6  # 5,000 mm/s2 at 1 ms


@pytest.mark.parametrize("seed", range(3))
def test_a_killed_engine_leaves_a_log_that_proves(seed: int, engine: tuple[subprocess.Popen[str], str, Path]) -> None:
    """EN-36: to 100 ms before it was killed (200 on a loaded computer); each of its events carries a checksum."""
    process, url, log = engine
    session = takt.connect(url)
    x = session.axis("x")
    x.power().wait()
    for i in range(4 + seed):
        x.move_absolute(position=10.0 * i)
        session.run(0.11)
    cycle = session.cycle
    process.kill()
    process.wait()
    run = lcmlog.open_log(log).runs[-1]
    last = max(h.first_cycle + h.count for h in run.hashes)
    assert last > cycle - 200
    result = replay(log)
    assert result.same or result.cycles > cycle - 200, result.sentence


def test_events_carry_checksums(engine: tuple[subprocess.Popen[str], str, Path]) -> None:
    """EN-36."""
    from takt import _core

    process, url, log = engine
    with takt.connect(url) as session:
        session.run(0.3)
    process.send_signal(signal.SIGINT)
    process.wait(10)
    events = list(lcm.EventLog(str(log), "r"))
    assert len(events) > 100
    assert all(_core.checksum_holds(event.channel, event.data) for event in events)
    for event in events[::50]:
        changed = bytearray(event.data)
        changed[len(changed) // 2] ^= 4
        assert _core.checksum_holds(event.channel, bytes(changed)) is False


NAMES_FILES = {
    "cams[0].file": "cams: [{name: c, file: FILE}]\n",
    "paths[0].file": "paths: [{name: p, file: FILE}]\n",
    "groups[0].kinematics.serial.urdf": (
        "groups: [{name: g, axes: [x, r], kinematics: {serial: {urdf: FILE}}, "
        "path: {velocity: 1, acceleration: 1, jerk: 1}}]\n"
    ),
}


@pytest.mark.parametrize("where", NAMES_FILES)
def test_a_description_opens_no_files(where: str, tmp_path: Path) -> None:
    """EN-37: of a machine that is described over the network or in a log, no file is opened, and a sentence says which
    it names; the same text as a file may name it."""
    from takt import _core
    from takt.view.machine import Machine

    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)  # who opened it would wait
    description = msgs.machine_description()
    description.run_id, description.name, description.period_s = 7, "test", 0.001
    description.text = machine_with("{}") + NAMES_FILES[where].replace("FILE", str(pipe))
    sentence = rf"{re.escape(where)}: expected what stands in the file itself, found its name .*: .* opens no files"
    with pytest.raises(takt.ConfigError, match=sentence):
        Machine(description)
    log = lcm.EventLog(str(tmp_path / "log"), "w")
    log.write_event(1, "takt/machine", description.encode())
    log.close()
    with pytest.raises(takt.ConfigError, match=sentence):
        lcmlog.read_log(tmp_path / "log")
    url = new_url()
    network, stop = lcm.LCM(url), threading.Event()

    def describe() -> None:
        while not stop.wait(0.05):
            network.publish("takt/machine", description.encode())

    thread = threading.Thread(target=describe)
    thread.start()
    try:
        with pytest.raises(takt.ConfigError, match=sentence):
            takt.connect(url)
    finally:
        stop.set()
        thread.join()
    pipe.unlink()
    with pytest.raises(takt.ConfigError, match="No such file"):
        _core.load_machine(description.text.encode(), "machine")
