"""EN-24: the tools that come with LCM work with the channels and logs as they are, and logs of ours are like theirs."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import lcm
import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import msgs
from takt.cli import main
from takt.lcmlog import read_events
from takt.network import open_network

LOGGER, PLAYER = Path("/usr/bin/lcm-logger"), Path("/usr/bin/lcm-logplayer")
OURS = "takt record"

pytestmark = pytest.mark.skipif(not LOGGER.exists() or not PLAYER.exists(), reason="needs Debian's liblcm-bin")


@pytest.fixture(scope="module", params=["lcm-logger", OURS])
def by(request: pytest.FixtureRequest) -> str:
    """Which logger wrote it."""
    return str(request.param)


@pytest.fixture(scope="module")
def logged(by: str, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, takt.Recording]:
    """What a logger wrote of a run, and what the session recorded of it. lcm-logger, which ends with what it has
    written by then, gets a second and a third run on a busy host."""
    for _ in range(3):
        file, recording = log_a_run(by, tmp_path_factory.mktemp("logger"))
        log = takt.read_log(file)
        kept = np.isin(recording["x"]["cycle"], log["x"]["cycle"] if "x" in log else [])
        if by == OURS or np.mean(kept) > 0.5:
            return file, recording
    pytest.skip(f"lcm-logger kept {np.mean(kept):.0%} of the states: the host is busy")


def log_a_run(by: str, directory: Path) -> tuple[Path, takt.Recording]:
    url = new_url()
    file = directory / "logger.lcm"
    ours = [sys.executable, "-m", "takt", "record", f"--url={url}", file]
    with running(directory, url):
        logger = subprocess.Popen(ours if by == OURS else [LOGGER, f"--lcm-url={url}", "--quiet", file])
        try:
            with takt.connect(url) as session:
                session.wait(lambda: file.exists() and b"takt/machine" in file.read_bytes(), 20.0)
                session.axis("x").power().wait()
                with session.record() as recorder:
                    session.axis("x").move_absolute(position=40.0).wait()
                    session.run(0.2)
        finally:
            logger.send_signal(signal.SIGINT)
            assert logger.wait(40) == 0
    return file, recorder.recording


def test_loggers_record(by: str, logged: tuple[Path, takt.Recording]) -> None:
    """EN-24: a logger's file read back is what a client saw at the same time. lcm-logger leaves some out on a busy
    host."""
    file, seen = logged
    recording = takt.read_log(file)
    common = np.isin(recording["x"]["cycle"], seen["x"]["cycle"])
    again = np.isin(seen["x"]["cycle"], recording["x"]["cycle"])
    assert np.array_equal(recording["x"][common], seen["x"][again])
    assert np.mean(again) > 0.5
    assert recording["x"]["actual_position"][-1] == pytest.approx(40.0, abs=0.05)
    if by == OURS:
        assert np.all(again)
        assert recording.meta["losses"] == {}
    # Commands are known from the clients' own messages.
    assert [e.text for e in recording.events if e.kind == "end"][-1] == "x.move_absolute: done"


def test_event_log_reads(by: str, logged: tuple[Path, takt.Recording]) -> None:
    """EN-24: lcm.EventLog and the generated types alone are enough."""
    states = [
        msgs.axis_state.decode(event.data)
        for event in lcm.EventLog(str(logged[0]), "r")
        if event.channel == "takt/axis/x"
    ]
    assert len(states) > (50 if by == OURS else 10)  # lcm-logger loses some on a busy host
    steps = np.diff([s.sequence for s in states])
    assert np.all(steps == 1 if by == OURS else steps >= 1)
    assert states[-1].name == "x"
    assert states[-1].state == msgs.axis_state.STATE_STANDSTILL


@contextmanager
def playing(file: Path, url: str) -> Iterator[None]:
    """lcm-logplayer again and again: one log may be over before a client on a busy host listens."""
    over = threading.Event()

    def play() -> None:
        while not over.is_set():
            subprocess.run([PLAYER, f"--lcm-url={url}", file], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    player = threading.Thread(target=play)
    player.start()
    try:
        yield
    finally:
        over.set()
        player.join(60.0)


def test_lcm_logplayer_plays(logged: tuple[Path, takt.Recording]) -> None:
    """EN-24: a session can watch what lcm-logplayer plays back; commands it would give are not answered."""
    url = new_url()
    with playing(logged[0], url), takt.connect(url, timeout=60.0) as session:
        x = session.axis("x")
        session.wait(lambda: x.set_velocity > 0, 60.0)
        session.wait(lambda: x.actual_position > 39.0, 60.0)


def test_commands_refused_before_a_cycle_are_in_recordings(tmp_path: Path) -> None:
    """PY-20: at their time, as in a live recording; taktd's own log does not hold their texts."""
    url, own, heard = new_url(), tmp_path / "own.lcm", tmp_path / "heard.lcm"
    with (
        takt.write_log(heard, url),
        running(tmp_path, url, "--log", str(own)),
        takt.connect(url, client="c") as session,
    ):
        session.run(0.3)
        recorder = session.record("x")
        with pytest.raises(takt.CommandError):
            session.axis("x").move_absolute(position=100, velocity=-1).wait()
        session.run(0.1)
        live = [event for event in recorder.stop().events if event.kind != "mark"]
    assert [event.kind for event in live] == ["start", "error"]
    for file, component in ((heard, "x"), (own, "")):
        found = [event for event in takt.read_log(file).events if event.kind in ("start", "error")]
        assert [(event.component, event.kind) for event in found] == [(component, "start"), (component, "error")]
        assert found[0].time_s == pytest.approx(live[0].time_s, abs=0.1)
        assert "velocity: expected a number" in found[1].text
        if component:
            assert found[0].text == live[0].text
            assert found[1].text.startswith("x.move_absolute: ")
        else:
            assert found[1].text.startswith("command 1 of c: ")


def rmem_max() -> int:
    return int(Path("/proc/sys/net/core/rmem_max").read_text())


@pytest.mark.skipif(rmem_max() < 4 << 20, reason="the system gives sockets no room (net.core.rmem_max)")
def test_a_logger_that_is_held_up_loses_nothing(tmp_path: Path) -> None:
    """As long as the socket has room; with what systems give unasked that would be a fifth of these."""
    url, file = new_url(), tmp_path / "network.log"
    network = open_network(url)
    logger = subprocess.Popen(
        [sys.executable, "-m", "takt", "record", f"--url={url}", file], stdout=subprocess.PIPE, text=True
    )
    assert logger.stdout
    assert logger.stdout.readline() == f"{file} records {url}; Ctrl-C ends it\n"
    logger.send_signal(signal.SIGSTOP)
    for number in range(1500):
        network.publish("n", number.to_bytes(2, "big") * 100)
    logger.send_signal(signal.SIGCONT)
    logger.send_signal(signal.SIGTERM)
    assert logger.communicate(timeout=60)[0] == f"{file}: 0.3 MB\n"
    assert logger.returncode == 0
    said = [int.from_bytes(data[:2], "big") for _, channel, data in read_events(file) if channel == "n"]
    assert said == list(range(1500))


def test_recording_says_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = tmp_path / "letter.txt"
    text.write_text("a letter")
    assert main(["record", str(text), "--url", new_url()]) == 2
    assert capsys.readouterr().err == f"takt: log file {text} exists and is no LCM log; it is left as it is\n"
    assert text.read_text() == "a letter"
    assert main(["record", str(tmp_path / "x.lcm"), "--url", "udpm://239.255.76.67:99999"]) == 2
    assert "takt: LCM URL 'udpm://239.255.76.67:99999': expected one like" in capsys.readouterr().err
