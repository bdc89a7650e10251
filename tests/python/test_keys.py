"""EN-31: with a key, only its holders command, keep alive, drive and describe; what others say is counted and
ignored."""

from __future__ import annotations

import random
import signal
import stat
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import takt
from keyed import Bystander, Sender, changed, flipped, key_bytes, new_key, now_us
from machines import machine_with, new_url, running, taktd
from plants import LONG_S, Lag, eventually, only_x
from takt import drive, lcmlog, msgs
from takt.cli import main
from takt.keys import read_key
from takt.view.commander import Commander
from takt.view.feed import Feed
from tcpq import Server

REASONS = ("untagged", "wrong_key", "replayed", "stale")


@pytest.fixture(autouse=True)
def no_key_in_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TAKT_KEY_FILE", raising=False)


@pytest.fixture
def key(tmp_path: Path) -> Path:
    return new_key(tmp_path)


def counted(session: takt.RemoteSession, reason: str, least: int) -> None:
    """Waits until the engine has counted so many."""
    session.wait(lambda: session.figures[reason] >= least, LONG_S, what=f"{least} counted as {reason}")


# --- who has which key ---


@pytest.mark.parametrize("engine", ["", "a", "b"])
@pytest.mark.parametrize("client", ["", "a", "b"])
def test_clients_and_engines_by_their_keys(client: str, engine: str, tmp_path: Path) -> None:
    """EN-31: the same key, or none on both sides; else one sentence says what to do."""
    url = new_url()
    files = {"": ""} | {name: str(new_key(tmp_path, name)) for name in "ab"}
    options = ("--key", files[engine]) if engine else ()
    with running(tmp_path, url, *options):
        if client == engine:
            with takt.connect(url, key=files[client], timeout=LONG_S) as session:
                session.axis("x").power().wait()
                session.axis("x").move_absolute(position=3.0).wait()
                session.run(0.3)
                assert bool(session.figures["has_key"]) == bool(engine)
                assert all(session.figures[reason] == 0 for reason in REASONS)
                assert not session.refused
            return
        with pytest.raises(takt.ConnectionError) as refused:
            takt.connect(url, key=files[client], timeout=LONG_S)
    sentence = str(refused.value)
    assert url in sentence
    if not client:
        assert "has a key and hears only holders of it: name its key file" in sentence
    else:
        assert files[client] in sentence
        assert ("has no key" if not engine else "has another key") in sentence


@pytest.mark.parametrize(
    ("engine", "client", "said"),
    [
        ("old new", "old", ""),  # first the engine
        ("old new", "new old", ""),  # then clients and drives, one after the other
        ("new", "new old", ""),  # the engine anew
        ("new", "new", ""),
        ("old new", "new", "has another key than"),
        ("new", "old", "has another key than"),
        ("new", "old new", "does not take the first key of"),
        ("new old", "old", "has another key than"),
    ],
)
def test_a_key_is_changed_step_by_step(engine: str, client: str, said: str, tmp_path: Path) -> None:
    """EN-31: with two keys in a file the first tags and both are heard, so nobody is locked out between two steps."""
    url, keys = new_url(), {name: new_key(tmp_path, name) for name in ("old", "new")}

    def file(which: str) -> Path:
        made = tmp_path / which.replace(" ", "_and_")
        if not made.exists():
            made.touch(mode=0o600)
            made.write_text("\n".join(keys[name].read_text() for name in which.split()))
        return made

    machine = machine_with("{engine_rate_hz: 50}")
    with running(tmp_path, url, "--key", str(file(engine)), machine=machine):
        if said:
            with (
                pytest.raises(takt.ConnectionError, match=said) as refused,
                takt.connect(url, key=file(client), timeout=2.0) as session,
            ):
                session.axis("x").power()
            assert str(file(client)) in str(refused.value)
            return
        with takt.connect(url, key=file(client), timeout=LONG_S) as session:
            session.axis("x").power().wait()
            session.axis("x").move_absolute(position=3.0).wait()
            session.run(0.3)  # heartbeats
            assert all(session.figures[reason] == 0 for reason in REASONS)
            assert not session.refused


@pytest.mark.parametrize("engine", ["", "a", "b"])
@pytest.mark.parametrize("plant", ["", "a", "b"])
def test_drives_and_engines_by_their_keys(plant: str, engine: str, tmp_path: Path) -> None:
    """EN-31: drives carry out what an engine with the same key says, and are heard by no other."""
    url = new_url()
    files = {"": ""} | {name: str(new_key(tmp_path, name)) for name in "ab"}
    lag = Lag()
    said: list[str] = []
    made = drive.Plant({"x": lag}, url, say=said.append, key=files[plant])
    thread = threading.Thread(target=made.run, args=(LONG_S,))
    thread.start()
    try:
        if plant == engine:
            with takt.Engine(only_x(url), key=files[engine]) as session:
                session.axis("x").power().wait()
                session.axis("x").move_absolute(position=2.0).wait()
                assert lag.told.enable
                assert not made.refused
            return
        with takt.Engine(only_x(url, 2, 0.2), key=files[engine]) as session:
            with pytest.warns(takt.DriveWarning, match="no plant answers"):
                session.run(0.01)
            assert session.axis("x").power().wait_final().error
        assert lag.told == drive.SetPoint()
        assert sum(made.refused.values()) > 0
        expected = "has a key and hears only" if not plant else "has no key" if not engine else "has another key"
        assert [line for line in said if expected in line] == said
        assert len(said) == 1
    finally:
        made.stop()
        thread.join(LONG_S)


# --- hostile messages ---


@pytest.fixture
def keyed(tmp_path: Path, key: Path) -> Iterator[tuple[takt.RemoteSession, Bystander, Path]]:
    """A session with an engine that has a key, somebody who has none on the same network, and the key."""
    url = new_url()
    bystander = Bystander(url)
    with (
        running(tmp_path, url, "--key", str(key), machine=machine_with("{dead_man_s: 0.5, engine_rate_hz: 50}")),
        takt.connect(url, key=key, timeout=LONG_S) as session,
    ):
        yield session, bystander, key


def forged_command(session: takt.RemoteSession, number: int, **fields: object) -> bytes:
    message = msgs.command()
    message.run_id, message.client, message.session = session._run_id, "mallory", 99
    message.id, message.target, message.verb, message.arguments = number, "x", "move_absolute", "{position: 50}"
    for name, value in fields.items():
        setattr(message, name, value)
    return bytes(message.encode())


def test_hostile_commands_move_nothing(keyed: tuple[takt.RemoteSession, Bystander, Path], tmp_path: Path) -> None:
    """EN-31: without tag, with another key's, changed on the way, heard before, of another time, of another start."""
    session, bystander, key = keyed
    source = random.Random(31)
    x = session.axis("x")
    x.power().wait()
    x.move_absolute(position=1.0).wait()
    bystander.until(lambda: len(bystander.on("takt/command")) >= 2)
    own = bystander.on("takt/command")
    foreign = Sender(key_bytes(new_key(tmp_path, "other")))
    holder = Sender(key_bytes(key))
    for i in range(20):
        bystander.say("takt/command", forged_command(session, 1 + i))
        bystander.say("takt/command", foreign.tag("takt/command", forged_command(session, 100 + i)))
        bystander.say("takt/command", changed(msgs.command, own[-1], id=1000 + i) + own[-1][-60:])
        bystander.say("takt/command", flipped(own[-1], source))
        bystander.say("takt/command", own[i % len(own)])
        told = holder.tag("takt/command", forged_command(session, 200 + i), now_us() - 3_000_000)
        bystander.say("takt/command", told)
        bystander.say("takt/heartbeat", holder.tag("takt/command", forged_command(session, 250 + i)))  # elsewhere
        old_run = forged_command(session, 300 + i, run_id=session._run_id - 1)
        bystander.say("takt/command", holder.tag("takt/command", old_run))
    for reason, least in (("untagged", 20), ("wrong_key", 60), ("replayed", 20), ("stale", 20), ("other_run", 20)):
        counted(session, reason, least)
    assert x.set_position == pytest.approx(1.0)
    assert session.figures["untagged"] + session.figures["wrong_key"] == 100
    assert session.figures["commands_applied"] == len(own)
    x.move_absolute(position=2.0).wait()  # and its holder commands on


def test_tags_as_described_are_taken(keyed: tuple[takt.RemoteSession, Bystander, Path]) -> None:
    """EN-31: what docs/keys.md says of the tag is enough to write a client in any language."""
    session, bystander, key = keyed
    session.axis("x").power().wait()
    bystander.say("takt/command", Sender(key_bytes(key)).tag("takt/command", forged_command(session, 1)))
    session.wait(lambda: session.axis("x").set_position == 50, LONG_S, what="the move of a client without Takt")


CLIENT = """
import sys, time, takt
session = takt.connect(sys.argv[1], client="doomed", key=sys.argv[2], timeout=60)
session.axis("x").power().wait()
session.axis("x").jog(forward=True, velocity=20.0).wait(until="active")
print("jogging", flush=True)
time.sleep(60)
"""


def test_nobody_keeps_a_dead_client_alive(keyed: tuple[takt.RemoteSession, Bystander, Path]) -> None:
    """EN-31: heartbeats of a killed client, forged from what is published, and its own said again and changed, renew
    nothing: its jog ends."""
    session, bystander, key = keyed
    client = subprocess.Popen([sys.executable, "-c", CLIENT, session.url, str(key)], stdout=subprocess.PIPE, text=True)
    assert client.stdout is not None
    assert client.stdout.readline() == "jogging\n"

    def beats() -> list[bytes]:
        return [b for b in bystander.on("takt/heartbeat") if msgs.heartbeat.decode(b).client == "doomed"]

    bystander.until(lambda: len(beats()) >= 3)
    client.kill()
    client.wait()
    bystander.listen()
    own, source = beats(), random.Random(1)
    x = session.axis("x")

    def haunt() -> bool:
        bystander.say("takt/heartbeat", changed(msgs.heartbeat, own[-1], utime=now_us()))
        bystander.say("takt/heartbeat", own[-1])
        bystander.say("takt/heartbeat", flipped(own[-1], source))
        bystander.say("takt/heartbeat", changed(msgs.heartbeat, own[-1], utime=now_us()) + own[-1][-60:])
        time.sleep(0.02)
        return x.set_velocity == 0

    session.wait(haunt, LONG_S, what="the end of the jog")
    for reason in ("untagged", "wrong_key", "replayed"):
        counted(session, reason, 1)


def test_forged_answers_and_descriptions_are_not_believed(
    keyed: tuple[takt.RemoteSession, Bystander, Path], tmp_path: Path
) -> None:
    """EN-31: a description or figures of another engine end no session, feedback that nobody gave finishes no
    command."""
    session, bystander, _ = keyed
    x = session.axis("x")
    x.power().wait()
    moving = x.move_velocity(velocity=10.0).wait(until="active")

    def answers() -> list[bytes]:
        return [m for m in bystander.on("takt/feedback") if msgs.feedback.decode(m).ticket == moving.ticket]

    bystander.until(lambda: answers() and bystander.on("takt/machine") and bystander.on("takt/engine"))
    foreign = Sender(key_bytes(new_key(tmp_path, "other")))
    for channel, message in (
        ("takt/machine", changed(msgs.machine_description, bystander.on("takt/machine")[-1], run_id=1)),
        ("takt/engine", changed(msgs.engine_state, bystander.on("takt/engine")[-1], run_id=1)),
        ("takt/feedback", changed(msgs.feedback, answers()[-1], state=msgs.feedback.STATE_ERROR, sequence=10**9)),
    ):
        bystander.say(channel, message)
        bystander.say(channel, foreign.tag(channel, message))
    bystander.say("takt/feedback", answers()[0])
    session.wait(lambda: session.refused["untagged"] >= 3 and session.refused["wrong_key"] >= 3, LONG_S)
    session.wait(lambda: session.refused["replayed"] >= 1, LONG_S)
    assert not moving.error
    assert not session.losses
    x.halt().wait()
    counted(session, "untagged", 1)  # the engine hears descriptions, too


def test_commands_of_an_earlier_start_are_void(tmp_path: Path, key: Path) -> None:
    """EN-31: said again to the next start of the engine at once, while their tags are fresh: nothing moves."""
    url = new_url()
    bystander = Bystander(url)
    with running(tmp_path, url, "--key", str(key)), takt.connect(url, key=key, timeout=LONG_S) as session:
        session.axis("x").power().wait()
        session.axis("x").move_relative(distance=5.0).wait()
        bystander.until(lambda: len(bystander.on("takt/command")) >= 2)
    old = bystander.on("takt/command") + bystander.on("takt/heartbeat")
    with running(tmp_path, url, "--key", str(key)), takt.connect(url, key=key, timeout=LONG_S) as session:
        for data in old:
            bystander.say("takt/command", data)
        session.wait(lambda: sum(session.figures[r] for r in ("stale", "other_run", "wrong_key")) >= len(old), LONG_S)
        assert session.axis("x").set_position == 0
        assert not session.axis("x").powered


def test_keys_over_tcpq(tmp_path: Path, key: Path) -> None:
    """EN-31: on tcpq:// tags count as on UDP: holders command; what has no good tag, or was heard, moves nothing."""
    foreign = Sender(key_bytes(new_key(tmp_path, "other")))
    machine = machine_with("{dead_man_s: 0.5, engine_rate_hz: 50}")
    with Server() as server:
        bystander = Bystander(server.url)
        with running(tmp_path, server.url, "--key", str(key), machine=machine):
            with takt.connect(server.url, key=key, timeout=LONG_S) as session:
                x = session.axis("x")
                x.power().wait()
                x.move_relative(distance=1.0).wait()
                bystander.until(lambda: len(bystander.on("takt/command")) >= 2)
                bystander.say("takt/command", bystander.on("takt/command")[-1])
                for number in range(3):
                    bystander.say("takt/command", forged_command(session, number))
                    bystander.say("takt/command", foreign.tag("takt/command", forged_command(session, number)))
                counted(session, "replayed", 1)
                counted(session, "untagged", 3)
                counted(session, "wrong_key", 3)
                assert x.set_position == 1.0
                x.halt().wait()
            with pytest.raises(takt.ConnectionError, match="has a key and hears only holders of it"):
                takt.connect(server.url, key="", timeout=LONG_S)


# --- drives ---


def moved(url: str, key: Path, disturb: Callable[[Bystander], None] | None) -> tuple[list[float], drive.Plant]:
    """Actual positions of an axis whose drive is in another process, moving while somebody disturbs both."""
    made = drive.Plant({"x": Lag()}, url, key=key, say=lambda _: None)
    stop = threading.Event()

    def hostile() -> None:
        bystander = Bystander(url, "takt/drive/.*")
        while not stop.is_set() and disturb is not None:
            bystander.network.handle_timeout(20)
            disturb(bystander)
            bystander.heard.clear()

    threads = [threading.Thread(target=made.run), threading.Thread(target=hostile)]
    for thread in threads:
        thread.start()
    try:
        with takt.Engine(only_x(url), key=key) as engine:
            x = engine.axis("x")
            x.power().wait()
            record = engine.record()
            x.move_absolute(position=4.0).wait()
            assert x.error == 0
            engine.run(0.1)
            return list(record.stop()["x"]["actual_position"]), made
    finally:
        stop.set()
        made.stop()
        for thread in threads:
            thread.join(LONG_S)


@pytest.mark.filterwarnings("ignore::takt.DriveWarning")
def test_nobody_moves_a_drive_or_speaks_for_it(tmp_path: Path, key: Path) -> None:
    """EN-31, EN-26: forged answers and set points, without tag, with another key's, said again or changed: bit for bit
    the same motion."""
    source = random.Random(2)
    foreign = Sender(key_bytes(new_key(tmp_path, "other")))

    def disturb(bystander: Bystander) -> None:
        for channel, data in bystander.heard:
            if data in bystander.said:
                continue
            if channel.endswith("setpoint"):
                for cycle in (0, 1):
                    told = msgs.drive_setpoint.decode(data)
                    lie = msgs.drive_feedback()
                    lie.run_id, lie.cycle, lie.plant, lie.axis = told.run_id, told.cycle + cycle, 7, "x"
                    lie.sequence, lie.counts, lie.drive_fault = 2**63 - 1, 10**6, True
                    bystander.say("takt/drive/x/feedback", lie.encode())
                    answer = foreign.tag("takt/drive/x/feedback", lie.encode())
                    bystander.say("takt/drive/x/feedback", answer)
                later = changed(msgs.drive_setpoint, data, run_id=told.run_id + 10**12, position_counts=9e5)
                bystander.say(channel, later)
                bystander.say(channel, foreign.tag(channel, later))
                bystander.say(channel, later + data[-60:])
            bystander.say(channel, data)
            bystander.say(channel, flipped(data, source))

    quiet, _ = moved(new_url(), key, None)
    disturbed, plant = moved(new_url(), key, disturb)
    assert disturbed == quiet
    assert all(plant.refused[reason] > 10 for reason in ("untagged", "wrong_key", "replayed"))


@pytest.mark.filterwarnings("ignore::takt.DriveWarning")
def test_forged_answers_count_and_lock_no_drive_out(tmp_path: Path, key: Path) -> None:
    """EN-31, in real time: answers to every cycle from somebody who pretends to be the drive, from before it starts."""
    url = new_url()
    lag = Lag()
    with (
        running(tmp_path, url, "--key", str(key), machine=only_x(url, 2000), pace="real"),
        takt.connect(url, key=key, timeout=LONG_S) as session,
    ):
        bystander = Bystander(url, "takt/drive/x/setpoint")

        def lie() -> bool:
            bystander.listen(100)
            for data in bystander.on("takt/drive/x/setpoint")[-3:]:
                told, lied = msgs.drive_setpoint.decode(data), msgs.drive_feedback()
                lied.run_id, lied.cycle, lied.plant, lied.axis = told.run_id, told.cycle, 7, "x"
                lied.sequence, lied.counts = 2**63 - 1, 10**6
                bystander.say("takt/drive/x/feedback", lied.encode())
            bystander.heard.clear()
            return bool(session.figures["untagged"] > 20)

        session.wait(lie, LONG_S, what="forged answers counted")
        assert session.figures["samples_refused"] > 0
        made = drive.Plant({"x": lag}, url, key=key, watchdog=100_000, say=lambda _: None)
        thread = threading.Thread(target=made.run)
        thread.start()
        try:
            x = session.axis("x")
            session.wait(lambda: lie() and lag.told.period_s > 0 and x.power().wait_final().done, LONG_S)
            assert abs(x.actual_position) < 1.0
        finally:
            made.stop()
            thread.join(LONG_S)


# --- files ---

HEX = "0123456789abcdef" * 4


@pytest.mark.parametrize(
    ("content", "mode", "sentence"),
    [
        (None, 0, "there is none; takt key new .* makes one"),
        ("", 0o600, "it is empty; expected one key of 64 hexadecimal digits"),
        (HEX[:40], 0o600, "too short: expected one key of 64 hexadecimal digits, found 40"),
        (HEX + "00", 0o600, "too long: .*, found 66"),
        (f"{HEX}\n{HEX[::-1]}\n{HEX}\n", 0o600, "holds 3 keys; expected one, or two while the key is changed"),
        (f"{HEX}\n{HEX[:20]}\n", 0o600, "key 2: too short: .*, found 20"),
        (f"{HEX[:40]}\n{HEX}\n", 0o600, "key 1: too short: .*, found 40"),
        (f"{HEX}\n\n{HEX}\n", 0o600, "holds the same key twice"),
        (HEX + HEX[::-1], 0o600, "too long: .*, found 128"),
        (HEX[:63] + "g", 0o600, "found other characters"),
        (HEX[:32] + " " + HEX[32:], 0o600, "found spaces between them"),
        (HEX, 0o644, r"others than its owner may open it \(mode 0644\); chmod 600"),
        (HEX, 0o640, "chmod 600"),
        (HEX, 0o602, "chmod 600"),
        ("\0" * 9000, 0o600, "found other characters"),
    ],
)
def test_key_files_that_are_none(content: str | None, mode: int, sentence: str, tmp_path: Path) -> None:
    """EN-31: engine and clients say the same; nobody says what is in the file."""
    file, machine = tmp_path / "key", tmp_path / "machine.yaml"
    if content is not None:
        file.write_text(content)
        file.chmod(mode)
    with pytest.raises(takt.KeyFileError, match=sentence) as said:
        takt.connect(new_url(), key=file)
    assert str(file) in str(said.value)
    assert HEX[:12] not in str(said.value)
    machine.write_text(machine_with("{}"))
    command = [taktd(), str(machine), "--lcm-url", new_url(), "--duration", "0.01", "--key", str(file)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=LONG_S)
    assert result.returncode == 2
    assert str(said.value) in result.stderr


def test_new_keys(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """EN-31: `takt key new` makes a key that its owner alone may open, each time another; it replaces nothing."""
    one, other = tmp_path / "one", tmp_path / "other"
    assert main(["key", "new", str(one)]) == 0
    assert main(["key", "new", str(other)]) == 0
    assert stat.S_IMODE(one.stat().st_mode) == 0o600
    made = read_key(one)
    assert made is not None
    assert made.data == key_bytes(one)
    assert repr(made.data) not in repr(made)
    assert key_bytes(one) != key_bytes(other)
    before = one.read_bytes()
    capsys.readouterr()
    assert main(["key", "new", str(one)]) == 2
    assert "it is there already" in capsys.readouterr().err
    assert one.read_bytes() == before
    assert main(["key", "new", str(tmp_path / "nowhere" / "key")]) == 2


def test_the_engine_says_who_may_command(tmp_path: Path, key: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """EN-31: once, at its start; the environment may name the key, the command line wins."""
    machine = tmp_path / "machine.yaml"
    machine.write_text(machine_with("{}"))

    def said(*options: str) -> str:
        command = [taktd(), str(machine), "--duration", "0.01", "--pace", "fast", *options]
        return subprocess.run(command, capture_output=True, text=True, timeout=LONG_S).stdout

    on = ("--lcm-url", new_url())
    assert said(*on).count("no key: anyone who reaches the network may command") == 1
    assert "may command" not in said("--no-lcm")
    assert "only holders of the key may command" in said(*on, "--key", str(key))
    both = new_key(tmp_path, "both")
    both.write_text(both.read_text() + key.read_text())
    assert "only holders of either key may command: it is being changed" in said(*on, "--key", str(both))
    monkeypatch.setenv("TAKT_KEY_FILE", str(key))
    assert "only holders of the key may command" in said(*on)
    monkeypatch.setenv("TAKT_KEY_FILE", str(tmp_path / "none"))
    assert "only holders of the key may command" in said(*on, "--key", str(key))


# --- tools ---

SCENARIO = """\
def scenario(session):
    session.axis("x").power().wait()
    session.axis("x").move_absolute(position=3.0).wait()

def verify(recording):
    assert recording["x"]["set_position"][-1] == 3.0
"""


def test_tools_use_the_key(tmp_path: Path, key: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """EN-31: `takt run` commands with the key, and says what is wrong without; a log of the network is read as ever."""
    url, log = new_url(), tmp_path / "network.lcm"
    scenario = tmp_path / "scenario.py"
    scenario.write_text(SCENARIO)
    with running(tmp_path, url, "--key", str(key)), lcmlog.write_log(log, url):
        assert main(["run", str(scenario), "--url", url, "--key", str(key)]) == 0
        capsys.readouterr()
        assert main(["run", str(scenario), "--url", url]) == 2
        assert "has a key and hears only holders of it" in capsys.readouterr().err
    read = lcmlog.open_log(log)
    assert not read.malformed
    assert {"power", "move_absolute"} <= {c.verb for c in read.runs[-1].commands}
    assert lcmlog.read_log(log)["x"]["set_position"][-1] == pytest.approx(3.0)


@pytest.mark.parametrize("which", ["none", "own", "other"])
def test_the_live_page_shows_without_the_key_and_commands_with_it(which: str, tmp_path: Path, key: Path) -> None:
    """EN-31: states are open; a page without the key may not command, one with another says so."""
    url = new_url()
    files: dict[str, str | Path] = {"none": "", "own": key, "other": new_key(tmp_path, "other")}
    with running(tmp_path, url, "--key", str(key)):
        feed = Feed(url, key=read_key(files[which]))

        def heard() -> bool:
            feed.tick()
            return bool(feed.machine or feed.trouble)

        eventually(heard)
        assert (feed.machine is not None) == (which != "other")
        assert feed.may_command == (which != "none")
        assert ("has another key" in feed.trouble) == (which == "other")


def test_another_engine_with_a_key_does_not_keep_the_page_from_commanding(key: Path) -> None:
    """EN-31: descriptions of an engine that the page leaves out change nothing."""
    url = new_url()
    feed, bystander, other = Feed(url), Bystander(url), Sender(key_bytes(key))
    description = msgs.machine_description()
    description.run_id, description.period_s, description.text = 1, 0.001, machine_with("{}")
    bystander.say("takt/machine", description.encode())
    eventually(lambda: feed.tick() or feed.machine)
    assert feed.may_command
    description.run_id = 2
    bystander.say("takt/machine", other.tag("takt/machine", description.encode()))
    eventually(lambda: feed.tick() or feed.trouble)
    assert "another engine" in feed.trouble
    assert feed.may_command


def test_a_page_with_the_key_commands(tmp_path: Path, key: Path) -> None:
    """EN-31: what the live page gives is tagged, too."""
    url, told = new_url(), list[Any]()
    machine = machine_with("{axis_rate_hz: 100}") + "view: {commands: true}\n"
    with (
        running(tmp_path, url, "--key", str(key), machine=machine),
        takt.connect(url, key=key, timeout=LONG_S) as session,
    ):
        feed = Feed(url, key=read_key(key))
        eventually(lambda: feed.tick() or feed.machine)
        assert feed.machine is not None
        commander = Commander(feed.network, feed.machine, told.append)
        feed.listeners.add(commander.take)
        commander.give("x", "power", {"enable": True}, time.monotonic())
        eventually(lambda: feed.tick() or session.axis("x").powered)
        assert session.axis("x").powered
        assert not told


def test_clocks_that_differ_are_said(key: Path) -> None:
    """EN-31: an engine whose tags are of another time is not believed, and the sentence names the clocks."""
    url, stop = new_url(), threading.Event()
    bystander, engine = Bystander(url), Sender(key_bytes(key))
    description = msgs.machine_description()
    description.run_id, description.period_s, description.text = 1, 0.001, machine_with("{}")

    def describe() -> None:
        while not stop.wait(0.05):
            late = engine.tag("takt/machine", description.encode(), now_us() - 5_000_000)
            bystander.say("takt/machine", late)

    thread = threading.Thread(target=describe)
    thread.start()
    try:
        with pytest.raises(takt.ConnectionError, match="the clocks of the hosts differ"):
            takt.connect(url, key=key, timeout=0.5)
    finally:
        stop.set()
        thread.join()


def test_a_restart_with_another_key_is_said(tmp_path: Path, key: Path) -> None:
    """EN-31: a session whose engine was started anew with another key says why it hears nothing."""
    url = new_url()
    with running(tmp_path, url, "--key", str(key)):
        session = takt.connect(url, key=key, timeout=LONG_S)
    with running(tmp_path, url, "--key", str(new_key(tmp_path, "other"))) as process:
        eventually(lambda: session.refused["wrong_key"] > 0)
        time.sleep(3.1)
        with pytest.raises(takt.ConnectionError, match=r"silent .*: the engine on .* has another key"):
            session.run(0.1)
        process.send_signal(signal.SIGINT)
        process.wait(LONG_S)
    session.close()
