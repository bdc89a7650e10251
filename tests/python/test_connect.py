"""EN-20 to EN-25, PY-02: a running engine over LCM."""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import lcm
import numpy as np
import pytest
import takt
from machines import MACHINE, UNKNOWN, command_for, machine_with, new_url, running
from takt import msgs, remote
from takt.feedback import QUEUE_FULL, Feedback
from takt.network import DEFAULT_URL, open_network

CLIENT = """
import sys, time, takt
session = takt.connect(sys.argv[1], client="doomed")
x = session.axis("x")
x.power().wait()
x.jog(forward=True, velocity=50.0).wait(until="active")
print("jogging", flush=True)
time.sleep(60)
"""


def test_a_killed_client_lets_go(tmp_path: Path) -> None:
    """EN-23: a client killed in the middle of a jog: the axis stops."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        client = subprocess.Popen([sys.executable, "-c", CLIENT, url], stdout=subprocess.PIPE, text=True)
        assert client.stdout is not None
        assert client.stdout.readline() == "jogging\n"
        x = session.axis("x")
        session.run(1.2)  # twice the dead man's time: it lives
        assert x.set_velocity == pytest.approx(50.0)
        with session.record("x") as recorder:
            before = session.now
            client.send_signal(signal.SIGKILL)
            client.wait()
            after = session.now  # on a busy host seconds later
            session.wait(lambda: x.set_velocity == 0, 2.0, what="the axis at rest")
            session.run(0.1)
        samples = recorder.recording["x"]
        stopped = samples["cycle"][samples["set_velocity"] == 0][0] * session.period
        assert before + 0.2 < stopped < after + 1.5
        assert x.state is takt.PlcState.STANDSTILL


def test_leaving_releases_what_is_held(tmp_path: Path) -> None:
    """EN-23."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        with takt.connect(url) as other:
            other.axis("x").power().wait()
            other.axis("x").jog(forward=True).wait(until="active")
        session.wait(lambda: session.axis("x").state is takt.PlcState.STANDSTILL, 0.25)


def refuse_releases(session: takt.RemoteSession, count: int) -> list[msgs.feedback]:
    """As if the engine's queue were full: so many releases go no further than the client. They are counted."""
    send = session._send
    refused: list[msgs.feedback] = []

    def refusing(feedback: Feedback) -> object:
        if feedback.verb != "release" or len(refused) >= count:
            return send(feedback)
        answer = msgs.feedback()
        answer.id = session._last_id = session._last_id + 1
        answer.state, answer.error_id, answer.sentence, answer.cycle = 4, QUEUE_FULL, "too many", -1
        refused.append(answer)
        sent = session._sent[answer.id] = remote._Sent(msgs.command(), feedback, time.monotonic())
        session._take(answer)
        return sent

    session._send = refusing  # type: ignore[method-assign,assignment]
    return refused


@pytest.mark.parametrize("how", ["released", "closed"])
def test_a_refused_release_is_given_again(how: str, tmp_path: Path) -> None:
    """EN-22, EN-23: an axis that was let go of stops, though the queue was full at that moment."""
    url = new_url()
    machine = machine_with("{dead_man_s: 5}")
    with running(tmp_path, url, machine=machine), takt.connect(url) as session, takt.connect(url) as other:
        other.axis("x").power().wait()
        jog = other.axis("x").jog(forward=True, velocity=50.0).wait(until="active")
        session.wait(lambda: session.axis("x").set_velocity == pytest.approx(50.0), 2.0)
        refused = refuse_releases(other, 3)
        if how == "released":
            assert jog.release().error_id == QUEUE_FULL
        else:
            other.close()
        session.wait(lambda: session.axis("x").set_velocity == 0, 2.0)
        assert len(refused) == 3


def test_no_heartbeat_keeps_what_was_let_go_of(tmp_path: Path) -> None:
    """EN-23: where no release ever gets through, the dead man ends it."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        jog = x.jog(forward=True, velocity=50.0).wait(until="active")
        refuse_releases(session, 1_000_000)
        jog.release()
        session.wait(lambda: x.set_velocity == 0, 2.0)
        assert jog.wait_final(1.0).final


@pytest.mark.parametrize(
    "damage",
    [{"state": 5}, {"state": -1}, {"object_kind": 6, "object_number": 1}, {"object_kind": 99}, {"object_number": 99}],
)
def test_a_damaged_answer_does_not_end_a_session(damage: dict[str, int], tmp_path: Path) -> None:
    """EN-22: an answer to a command of its own, with a state or an object that does not exist."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        commands: list[msgs.command] = []
        network = lcm.LCM(url)
        network.subscribe("takt/command", lambda _, data: commands.append(msgs.command.decode(data)))
        x = session.axis("x")
        x.power().wait()
        move = x.move_absolute(position=20.0, velocity=50.0).wait(until="active")
        while not (commands and commands[-1].verb == "move_absolute"):
            network.handle_timeout(100)
        answer = msgs.feedback()
        answer.client, answer.session, answer.id = commands[-1].client, commands[-1].session, commands[-1].id
        answer.ticket, answer.state, answer.cycle = move.ticket, 1, session.cycle
        answer.object_kind, answer.object_number = 1, 1
        for field, value in damage.items():
            setattr(answer, field, value)
        network.publish("takt/feedback", answer.encode())
        assert move.wait().done
        assert session.ignored == ("state" in damage)
        assert move.object is None


@pytest.mark.parametrize("ended", ["power off", "emergency stop"])
def test_a_hold_outlasts_the_end_of_its_stop(ended: str, tmp_path: Path) -> None:
    """EN-23, AX-37: what ends a held stop while the axis brakes does not end its hold; the release does."""
    url = new_url()
    machine = machine_with("{dead_man_s: 0.3}")  # shorter than between heartbeats that hold nothing
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        x.move_velocity(velocity=200.0).wait(until="reached")
        stop = x.stop(hold=True, deceleration=20.0)
        stop.wait(until="active")
        if ended == "power off":
            x.power(enable=False).wait()
        else:
            session.command("machine", "emergency_stop", {}).wait()
        assert stop.wait_final().aborted
        x.power().wait()
        session.run(1.2)
        assert x.state is takt.PlcState.STOPPING
        assert x.move_absolute(position=0).wait_final().error_id == 6
        stop.release()
        session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 2.0)
        assert not session._held


def test_a_refused_stop_holds_nothing(tmp_path: Path) -> None:
    """EN-23: neither the client nor the engine keeps up a stop of an axis that is off."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        assert session.axis("x").stop(hold=True).wait_final().error_id == 10
        assert not session._held


def test_a_stop_goes_on_when_its_sender_becomes_a_client(tmp_path: Path) -> None:
    """EN-22, EN-23, EN-32: a session stops an axis before its name is free. Later its heartbeats keep the hold, and the
    ids it used stay known."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        answers: list[msgs.feedback] = []
        network = lcm.LCM(url)
        network.subscribe("takt/feedback", lambda _, data: answers.append(msgs.feedback.decode(data)))

        def beat(number: int) -> None:
            message = msgs.heartbeat()
            message.client, message.session, message.run_id = "cell", number, session._run_id
            message.utime = remote._now_us()
            network.publish("takt/heartbeat", message.encode())

        beat(1)  # the session that has the name
        session.run(0.1)
        command = command_for(session)
        command.client, command.session, command.id, command.utime = "cell", 2, 1, remote._now_us()
        command.target, command.verb, command.arguments = "x", "stop", "{hold: true}"
        network.publish("takt/command", command.encode())
        for _ in range(35):  # the name is free after 2 s
            beat(2)
            session.run(0.1)
        assert x.state is takt.PlcState.STOPPING
        network.publish("takt/command", command.encode())
        session.run(0.2)
        while network.handle_timeout(50):
            pass
        assert len({a.ticket for a in answers if a.client == "cell" and a.id == 1}) == 1
        session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 2.0, what="the end of the lease")


def test_the_period_of_the_engine_is_that_of_its_machine(tmp_path: Path) -> None:
    """EN-20: `taktd --cycle-time` changes both, as `Engine(period=)` does."""
    url = new_url()
    with takt.Engine(MACHINE, period=0.002) as engine:
        here = engine.machine
    with running(tmp_path, url, "--cycle-time", "2ms", machine=MACHINE), takt.connect(url) as session:
        assert session.period == 0.002
        assert session.machine["cycle"]["period_s"] == 0.002
        assert session.machine == here


def test_states_that_cannot_be_true(tmp_path: Path) -> None:
    """EN-20, bad input: an absurd cycle is counted and ignored; the session's time is not spoilt."""
    url = new_url()
    network = lcm.LCM(url)
    with running(tmp_path, url), takt.connect(url) as session:
        session.run(0.1)
        for cycle, time_ns in ((2**60, 0), (2**40, 2**40 * 10**6), (-1, 0)):
            absurd = msgs.axis_state()
            absurd.name, absurd.cycle, absurd.time_ns = "x", cycle, time_ns
            network.publish("takt/axis/x", absurd.encode())
        session.run(0.2)
        assert session.now < 100
        assert session.ignored == 3
        assert session.losses == {}
        assert session.axis("x").power().wait().done


def test_an_engine_whose_time_stands_still(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """EN-25: that it is heard is not enough."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        session._still_s = 0.5
        monkeypatch.setattr(session, "_believable", lambda _: False)
        monkeypatch.setattr(remote, "SILENCE_S", 60.0)
        with pytest.raises(takt.ConnectionError, match="its time stands still at"):
            session.run(10.0)


def test_two_clients_of_one_name(tmp_path: Path) -> None:
    """EN-22: the second is told so; the first works on. A name is free again when its owner is gone."""
    url = new_url()
    with running(tmp_path, url):
        with takt.connect(url, client="me") as first:
            with (
                pytest.raises(takt.ConnectionError, match="uses the name me"),
                takt.connect(url, client="me") as second,
            ):
                second.run(2.0)
            assert first.axis("x").power().wait().done
        time.sleep(2.2)
        with takt.connect(url, client="me") as third:
            assert third.axis("x").power().wait().done


def test_clients_of_different_names_work_together(tmp_path: Path) -> None:
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as one, takt.connect(url) as two:
        one.axis("x").power().wait()
        ever = one.axis("x").move_velocity(velocity=20.0).wait(until="reached")
        two.axis("x").halt().wait()
        assert ever.wait_final().aborted
        assert one.client != two.client


def test_no_engine_and_no_network() -> None:
    """EN-25, bad input: one clear line each."""
    assert DEFAULT_URL.endswith("ttl=0")
    url = new_url()
    with pytest.raises(takt.ConnectionError, match=r"^no engine answers on .* within 0.2 s; is taktd running there\?$"):
        takt.connect(url, timeout=0.2)
    for wrong in ("udpm://nowhere", "udpm://239.255.76.67:99999", "http://x", ""):
        with pytest.raises(takt.ConnectionError, match="expected one like udpm://"):
            open_network(wrong)


def test_a_network_within_the_program() -> None:
    """EN-25: memq:// needs no socket; on it, too, one hears what was asked for."""
    network = open_network("memq://")
    heard: list[tuple[str, bytes]] = []
    subscription = network.subscribe("a.*", lambda channel, data: heard.append((channel, data)))
    for channel in ("b", "ab", "ca"):
        network.publish(channel, b"\0" + channel.encode())
    assert network.handle_timeout(1000) == 1
    assert network.handle_timeout(0) == 0
    assert heard == [("ab", b"\0ab")]
    network.unsubscribe(subscription)
    network.publish("ab", b"unheard")
    assert network.handle_timeout(0) == 0


def test_a_server_that_goes_away() -> None:
    """Bad input: a network of tcpq:// without its server, first and later."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        url = f"tcpq://127.0.0.1:{listening.getsockname()[1]}"
        with ThreadPoolExecutor(1) as others:
            opening = others.submit(open_network, url)
            server = listening.accept()[0]
            assert len(server.recv(8, socket.MSG_WAITALL)) == 8
            server.sendall(bytes.fromhex("287617fa00000100"))  # magic, version
            network = opening.result()
    server.close()
    with pytest.raises(takt.ConnectionError, match="cannot be joined"):
        open_network(url)
    with pytest.raises(OSError, match="server of the LCM network is gone"):
        network.handle()


def test_a_port_that_is_taken() -> None:
    """Bad input."""
    url = new_url()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("", int(url.split(":")[2].split("?")[0])))
        with pytest.raises(takt.ConnectionError, match="cannot be joined"):
            takt.connect(url, timeout=0.2)


@pytest.mark.skipif(shutil.which("unshare") is None or os.geteuid() != 0, reason="needs a network namespace of its own")
def test_the_network_absent() -> None:
    """Bad input: the sentence has the command that helps."""
    code = "import takt\ntry: takt.connect()\nexcept takt.ConnectionError as e: print(e)"
    done = subprocess.run(["unshare", "-n", sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "not reachable" in done.stdout
    assert "ip route add 224.0.0.0/4 dev lo" in done.stdout
    assert done.stdout.count("\n") == 1
    assert done.stderr == ""


def complaint_of(session: takt.Session) -> str:
    with pytest.raises(takt.ConnectionError) as raised:
        session.run(100.0)
    return str(raised.value)


def test_the_engine_goes_away(tmp_path: Path) -> None:
    """A session says within seconds that its engine is gone, and that another has come."""
    url = new_url()
    with running(tmp_path, url):
        session = takt.connect(url)
    with pytest.raises(takt.ConnectionError, match="silent"):
        session.run(100.0)
    with running(tmp_path, url), takt.connect(url):
        end = time.monotonic() + 60.0
        while "silent" in (said := complaint_of(session)):  # until it hears the other one
            assert time.monotonic() < end
    assert "started again" in said
    session.close()


def test_random_bytes_on_every_channel(tmp_path: Path) -> None:
    """EN-22: neither engine nor client is impressed; the engine counts them."""
    url = new_url()
    source = random.Random(4711)
    network = lcm.LCM(url)
    with running(tmp_path, url), takt.connect(url) as session:
        session.axis("x").power().wait()
        channels = ["takt/command", "takt/heartbeat", "takt/feedback", "takt/machine", "takt/engine", "takt/axis/x"]
        genuine = command_for(session)
        genuine.client = "bytes"
        for i in range(3000):
            data = bytearray(genuine.encode() if i % 2 else source.randbytes(source.randrange(200)))
            for _ in range(3 if i % 2 else 0):
                data[source.randrange(8, len(data))] = source.randrange(256)
            network.publish(source.choice(channels), bytes(data))
        session.run(0.3)
        assert session.axis("x").move_relative(distance=1.0).wait().done
        assert session.figures["malformed"] > 0


@pytest.mark.parametrize("arguments", UNKNOWN)
def test_a_refused_command_as_text(arguments: str, tmp_path: Path) -> None:
    """EN-22: the session hears on after a refused command with any text."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        gear = session.command("x", "gear_in", arguments).wait_final()
        assert gear.error_id == 3010
        assert gear.sentence.startswith(f"master: there is no axis '{UNKNOWN[arguments]}'; there are x")
        assert session.axis("x").power().wait().done


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        (("x\0", "halt"), "x?"),
        (("x", "halt\0"), "halt?"),
        (("x", "halt", "{deceleration: 1\0}"), "1?"),
    ],
)
def test_nul_in_a_command(command: tuple[str, ...], sentence: str, tmp_path: Path) -> None:
    """EN-22: NUL, which ends a text of LCM, is refused by the engine in the same words as in process."""
    url = new_url()
    with takt.Engine(MACHINE) as engine:
        in_process = engine.command(*command).wait_final()
    with running(tmp_path, url), takt.connect(url) as session:
        feedback = session.command(*command).wait_final()
    assert (feedback.error_id, feedback.sentence) == (in_process.error_id, in_process.sentence)
    assert feedback.error
    assert sentence in feedback.sentence


@pytest.mark.parametrize("name", ["a\0b", "a\udc00"])
def test_a_name_that_cannot_be_sent(name: str) -> None:
    """EN-22: such a name of a client is refused at once."""
    with pytest.raises(ValueError, match="client: expected a name without NUL and lone surrogates, found 'a"):
        takt.connect(new_url(), client=name, timeout=0.1)


def test_all_that_is_sent_is_for_this_engine_alone(tmp_path: Path) -> None:
    """EN-22: a log of it, played into another engine's network, moves nothing."""
    url = new_url()
    network = lcm.LCM(url)
    sent: list[msgs.command | msgs.heartbeat] = []
    network.subscribe("takt/command", lambda _, data: sent.append(msgs.command.decode(data)))
    network.subscribe("takt/heartbeat", lambda _, data: sent.append(msgs.heartbeat.decode(data)))
    with running(tmp_path, url), takt.connect(url) as session:
        assert session.axis("x").power().wait().done
        while network.handle_timeout(100):
            pass
        assert {type(message) for message in sent} == {msgs.command, msgs.heartbeat}
        assert {message.run_id for message in sent} == {session.figures["run_id"]}


def test_the_same_id_again_is_harmless(tmp_path: Path) -> None:
    """EN-22: sent three times, done once; each is answered."""
    url = new_url()
    network = lcm.LCM(url)
    answers: list[msgs.feedback] = []
    network.subscribe("takt/feedback", lambda _, data: answers.append(msgs.feedback.decode(data)))
    with running(tmp_path, url), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        message = command_for(session)
        message.client, message.session, message.id = "again", 7, 1
        message.target, message.verb, message.arguments = "x", "move_relative", "{distance: 5}"
        for _ in range(3):
            network.publish("takt/command", message.encode())
            session.run(0.3)
        while network.handle_timeout(100):
            pass
        mine = [a for a in answers if a.client == "again"]
        assert x.set_position == pytest.approx(5.0)
        assert [a.state for a in mine].count(msgs.feedback.STATE_DONE) == 3
        assert len({a.ticket for a in mine}) == 1


def test_values_are_not_older_than_what_was_waited_for(tmp_path: Path) -> None:
    """PY-02: also where states come seldom, what a scenario reads after a wait is what the axis then was."""
    url = new_url()
    machine = machine_with("{axis_rate_hz: 5}")
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        assert x.powered
        x.move_relative(distance=1.0).wait()
        assert x.set_position == pytest.approx(1.0)
        start = session.now
        session.run(0.01)
        assert all(state.cycle * session.period >= start + 0.01 for state in session._states.values())


@pytest.mark.parametrize("noticed", [True, False])
def test_a_lost_answer_is_asked_for_again(noticed: bool, tmp_path: Path) -> None:
    """EN-20, EN-22: at once where the sequence numbers have a gap, else after a while."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        session.axis("x").power().wait()
        take, lost = session._take, []

        def lossy(message: msgs.feedback) -> None:
            if message.state == msgs.feedback.STATE_DONE and not lost:
                lost.append(message)
                session._sequences["takt/feedback"] -= 1 if noticed else 0
            else:
                take(message)

        session._take = lossy  # type: ignore[method-assign]
        move = session.axis("x").move_relative(distance=1.0)
        start = session.now
        assert move.wait(5.0).done
        assert len(lost) == 1
        assert (session.now - start < 1.5) == noticed


def test_losses_are_seen(tmp_path: Path) -> None:
    """EN-20: a gap in the sequence numbers of a channel is a loss on the way."""
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as session:
        session.run(0.2)
        assert session.losses == {}
        late = session._states["x"]
        late.sequence += 1000
        lcm.LCM(url).publish("takt/axis/x", late.encode())
        session.run(0.2)
        assert session.losses.keys() == {"takt/axis/x"}
        assert 900 < session.losses["takt/axis/x"] < 1000


@pytest.mark.parametrize("how", ["closed", "found no engine"])
def test_a_session_that_is_over_gathers_nothing(how: str, tmp_path: Path) -> None:
    """However long somebody still knows it, and however much is published."""
    url = new_url()
    if how == "closed":
        with running(tmp_path, url), takt.connect(url) as session:
            session.run(0.1)
    else:
        with pytest.raises(takt.ConnectionError, match="no engine answers"):
            takt.connect(url, timeout=0.1)
    network = lcm.LCM(url)
    before = resident_mb()
    for i in range(1500):
        network.publish("takt/axis/x", bytes(60_000))
        if i % 20 == 0:
            time.sleep(0.002)  # so that it gets there
    time.sleep(0.2)
    assert resident_mb() - before < 20


def resident_mb() -> float:
    """Of this process."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 2**20


def test_rates_are_as_configured(tmp_path: Path) -> None:
    """EN-20: states come at the rates of the machine file."""
    url = new_url()
    machine = machine_with("{axis_rate_hz: 50, rates: [{axis: r, rate_hz: 250}], engine_rate_hz: 20}")
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        with session.record() as recorder:
            session.run(1.0)
        recording = recorder.recording
        assert set((recording["x"]["cycle"][1:] - recording["x"]["cycle"][:-1]).tolist()) == {20}
        assert set((recording["r"]["cycle"][1:] - recording["r"]["cycle"][:-1]).tolist()) == {4}
        assert len(recording["r"]) == pytest.approx(250, abs=25)


def test_after_waiting_everything_is_as_new_as_what_was_waited_for(tmp_path: Path) -> None:
    """Whoever waits for one component may ask for another: `follower`, in gear with x, is published once in 50 ms."""
    url, machine = (
        new_url(),
        machine_with("{axis_rate_hz: 1000, rates: [{axis: follower, rate_hz: 20}], dead_man_s: 1}"),
    )
    machine += machine[machine.index("  - name: x") : machine.index("  - name: r")].replace("name: x", "name: follower")
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        x, follower = session.axis("x"), session.axis("follower")
        x.power().wait()
        follower.power().wait()
        follower.gear_in(master="x").wait(until="active")
        x.move_velocity(velocity=200)
        for place in range(20, 320, 15):
            session.wait(lambda place=place: x.set_position >= place)
            assert follower.set_position >= place - 0.21  # one cycle behind its master at most


def test_every_nth_published_sample(tmp_path: Path) -> None:
    """PY-04: also where an axis is published in cycles that are no multiples of `every`."""
    url = new_url()
    with running(tmp_path, url, machine=machine_with("{axis_rate_hz: 40}")), takt.connect(url) as session:
        with session.record(every=10) as recorder:
            session.run(1.0)
        for axis in ("x", "r"):
            assert set(np.diff(recorder.recording[axis]["cycle"]).tolist()) == {250}
