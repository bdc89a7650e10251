"""EN-24: the tools that come with LCM work with the channels and logs as they are."""

from __future__ import annotations

import signal
import subprocess
import time
from pathlib import Path

import lcm
import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import msgs

LOGGER, PLAYER = Path("/usr/bin/lcm-logger"), Path("/usr/bin/lcm-logplayer")

pytestmark = pytest.mark.skipif(not LOGGER.exists() or not PLAYER.exists(), reason="needs Debian's liblcm-bin")


@pytest.fixture(scope="module")
def logged(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, takt.Recording]:
    """What lcm-logger wrote of a run, and what the session recorded of it."""
    directory = tmp_path_factory.mktemp("logger")
    url = new_url()
    file = directory / "logger.lcm"
    with running(directory, url):
        logger = subprocess.Popen([LOGGER, f"--lcm-url={url}", "--quiet", file])
        try:
            with takt.connect(url) as session:
                time.sleep(1.2)  # until the machine was described again
                session.axis("x").power().wait()
                with session.record() as recorder:
                    session.axis("x").move_absolute(position=40.0).wait()
                    session.run(0.2)
        finally:
            logger.send_signal(signal.SIGINT)
            logger.wait(10)
    return file, recorder.recording


def test_lcm_logger_records(logged: tuple[Path, takt.Recording]) -> None:
    """EN-24: lcm-logger's file read back is what a client saw at the same time."""
    file, seen = logged
    recording = takt.read_log(file)
    common = np.isin(recording["x"]["cycle"], seen["x"]["cycle"])
    assert np.array_equal(recording["x"][common], seen["x"])
    assert recording["x"]["actual_position"][-1] == pytest.approx(40.0, abs=0.05)
    assert recording.meta["losses"] == {}
    # Commands are known from the clients' own messages.
    assert [e.text for e in recording.events if e.kind == "end"][-1] == "x.move_absolute: done"


def test_event_log_reads(logged: tuple[Path, takt.Recording]) -> None:
    """EN-24: lcm.EventLog and the generated types alone are enough."""
    states = [
        msgs.axis_state.decode(event.data)
        for event in lcm.EventLog(str(logged[0]), "r")
        if event.channel == "takt/axis/x"
    ]
    assert len(states) > 50
    assert [s.sequence for s in states] == list(range(states[0].sequence, states[0].sequence + len(states)))
    assert states[-1].name == "x"
    assert states[-1].state == msgs.axis_state.STATE_STANDSTILL


def test_lcm_logplayer_plays(logged: tuple[Path, takt.Recording]) -> None:
    """EN-24: a session can watch what lcm-logplayer plays back; commands it would give are not answered."""
    url = new_url()
    player = subprocess.Popen(
        [PLAYER, f"--lcm-url={url}", logged[0]], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        with takt.connect(url) as session:
            x = session.axis("x")
            session.wait(lambda: x.set_velocity > 0, 10.0)
            session.wait(lambda: x.actual_position > 39.0, 10.0)
    finally:
        player.kill()
        player.wait()
