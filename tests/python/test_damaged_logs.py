"""EN-36, PY-20: whatever has become of a log, what is damaged costs itself alone, and is said."""

from __future__ import annotations

import random
import struct
import subprocess
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import lcm
import numpy as np
import pytest
import takt
from every_kind import FULL, MINIMAL, text_of
from machines import taktd
from takt import msgs
from takt.cli import main
from takt.events import HEADER, SYNC, EventLog, LogError
from takt.lcmlog import open_log
from takt.missing import all_missing

TRIES = 60


def event(channel: bytes, data: bytes, *, channel_length: int | None = None, length: int | None = None) -> bytes:
    """As it stands in a log; the lengths may be others than they are."""
    said = (len(channel) if channel_length is None else channel_length, len(data) if length is None else length)
    return HEADER.pack(SYNC, 7, 8, *said) + channel + data


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """What taktd writes of a machine with a belt and an arm."""
    folder = tmp_path_factory.mktemp("log")
    (folder / "machine.yaml").write_text(text_of(MINIMAL["pick_place"]))
    command = [taktd(), folder / "machine.yaml", "--no-lcm", "--pace", "fast", "--duration", "0.2", "--log"]
    subprocess.run([*command, folder / "a"], check=True, capture_output=True)
    return (folder / "a").read_bytes()


def spans(data: bytes) -> list[tuple[int, int]]:
    """Where each event of a whole log begins and ends."""
    found, at = [], 0
    while at < len(data):
        *_, channel, length = HEADER.unpack_from(data, at)
        found.append((at, at + HEADER.size + channel + length))
        at = found[-1][1]
    return found


def test_what_lcm_reads_of_a_whole_log(whole: bytes, tmp_path: Path) -> None:
    (tmp_path / "log").write_bytes(whole)
    ours = EventLog(tmp_path / "log")
    theirs = [(one.timestamp, one.channel, one.data) for one in lcm.EventLog(str(tmp_path / "log"), "r")]
    assert [tuple(one) for one in ours.events()] == theirs
    assert len(theirs) > 500
    assert ours.left_over == 0


def test_an_event_at_the_end_may_hold_a_sync_word(tmp_path: Path) -> None:
    data = b"a" + SYNC + b"b"
    head = HEADER.pack(SYNC, 0, 5, 1, len(data))
    (tmp_path / "log").write_bytes(head + b"c" + data)
    read = EventLog(tmp_path / "log")
    assert [one.data for one in read.events()] == [data]
    assert read.left_over == 0


def test_a_wrong_length_may_end_at_another_event(tmp_path: Path) -> None:
    """EN-36: the length of the first reaches just over the second and the third."""
    behind = [event(b"b", b"two"), event(b"c", b"three"), event(b"d", b"four")]
    for reached in (1, 2, 3):
        length = len(b"one") + sum(map(len, behind[:reached]))
        (tmp_path / "log").write_bytes(event(b"a", b"one", length=length) + b"".join(behind))
        read = EventLog(tmp_path / "log")
        assert [one.data for one in read.events()] == [b"two", b"three", b"four"]
        assert read.left_over == len(event(b"a", b"one"))


def changed_byte(data: bytes, chance: random.Random) -> tuple[bytes, int, int]:
    at = chance.randrange(len(data))
    return data[:at] + bytes([data[at] ^ (1 << chance.randrange(8))]) + data[at + 1 :], at, at + 1


def cut_out(data: bytes, chance: random.Random) -> tuple[bytes, int, int]:
    at = chance.randrange(len(data))
    end = min(at + chance.choice([1, 7, 500, 5000]), len(data))
    return data[:at] + data[end:], at, end


def foreign_bytes(data: bytes, chance: random.Random) -> tuple[bytes, int, int]:
    at = chance.randrange(len(data))
    return data[:at] + chance.randbytes(chance.choice([1, 30, 3000])) + data[at:], at, at + 1


def zeros(data: bytes, chance: random.Random) -> tuple[bytes, int, int]:
    """A block that was never written to the disk."""
    at = chance.randrange(len(data))
    end = min(at + 4096, len(data))
    return data[:at] + bytes(end - at) + data[end:], at, end


def torn(data: bytes, chance: random.Random) -> tuple[bytes, int, int]:
    at = chance.randrange(100, len(data))
    return data[:at], at, len(data)


def wrong_length(data: bytes, chance: random.Random) -> tuple[bytes, int, int]:
    begin, _ = chance.choice(spans(data))
    at = begin + chance.choice([20, 24])  # of channel or data
    length = chance.choice([0, 1, 62, 1000, 60_000, 0x7FFFFFFF, 0xFFFFFFFF])
    return data[:at] + struct.pack(">I", length) + data[at + 4 :], at, at + 4


def foreign_event(data: bytes, chance: random.Random) -> tuple[bytes, int, int]:
    begin, _ = chance.choice(spans(data))
    channel = chance.choice(
        [b"\xff\xfe", b"x" * 900, b"takt/axis/x", b"takt/machine", b"takt/drive/", b"takt/journal/hashes"]
    )
    new = event(channel, chance.randbytes(chance.choice([0, 8, 200])), length=chance.choice([None, None, 2**31]))
    return data[:begin] + new + data[begin:], begin, begin


DAMAGES = (changed_byte, cut_out, foreign_bytes, zeros, torn, wrong_length, foreign_event)


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda damage: damage.__name__)
def test_events_that_were_not_touched_are_read(
    damage: Callable[[bytes, random.Random], tuple[bytes, int, int]], whole: bytes, tmp_path: Path
) -> None:
    log, chance = tmp_path / "log", random.Random(damage.__name__)
    events = [(begin, end, whole[begin + HEADER.size : end]) for begin, end in spans(whole)]
    for _ in range(TRIES):
        data, first, last = damage(whole, chance)
        log.write_bytes(data)
        read = EventLog(log)
        found = Counter(one.channel.encode() + one.data for one in read.events())
        untouched = Counter(text for begin, end, text in events if end <= first or begin >= last)
        assert untouched <= found
        assert found.total() <= len(events) + 1
        assert 0 <= read.left_over <= len(data)


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda damage: damage.__name__)
def test_tools_say_what_is_wrong(
    damage: Callable[[bytes, random.Random], tuple[bytes, int, int]],
    whole: bytes,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Neither a crash nor silence: what is not whole is one sentence, and no 0 from `takt log` and `takt replay`."""
    monkeypatch.chdir(tmp_path)
    log, chance = Path("log"), random.Random(1)
    for _ in range(8):
        data, _, _ = damage(whole, chance)
        log.write_bytes(data)
        trouble = open_log(log).trouble
        capsys.readouterr()
        assert main(["log", "log"]) == (1 if trouble else 0)
        assert trouble in capsys.readouterr().out
        for command in (["replay", "log"], ["export", "log", "x", "--csv", "a.csv"]):
            code = main(command)
            said = capsys.readouterr()
            assert code in (0, 1, 2)
            assert said.out or said.err
            assert "Error: " not in said.err, said.err  # a sentence, not the name of an exception
            if command[0] == "export" and code == 0:
                assert trouble.rstrip(".") in said.out


def test_the_rest_of_a_recording_is_as_it_was(whole: bytes, tmp_path: Path) -> None:
    """Two events of an axis are damaged: all other samples stay."""
    channel = b"takt/axis/x"
    own = [(begin, end) for begin, end in spans(whole) if whole[begin + HEADER.size :].startswith(channel)]
    data = bytearray(whole)
    data[own[50][0] + 24 : own[50][0] + 28] = b"\x7f\xff\xff\xff"
    data[own[120][0] + 40 : own[120][1]] = bytes(own[120][1] - own[120][0] - 40)
    (tmp_path / "whole").write_bytes(whole)
    (tmp_path / "damaged").write_bytes(data)
    good, bad = takt.read_log(tmp_path / "whole"), takt.read_log(tmp_path / "damaged")
    np.testing.assert_array_equal(bad["x"], np.delete(good["x"], [50, 120]))
    np.testing.assert_array_equal(bad["y"], good["y"])
    assert all_missing(good) == ""
    assert good.meta["trouble"] == ""
    assert all_missing(bad).startswith("2 samples of x in 2 gaps")
    assert "bytes are left out" in bad.meta["trouble"]
    assert "1 message could not be decoded" in bad.meta["trouble"]


def test_a_beginning_that_is_missing(whole: bytes, tmp_path: Path) -> None:
    (tmp_path / "log").write_bytes(whole[11:])
    assert sum(open_log(tmp_path / "log").messages.values()) == len(spans(whole)) - 1


def test_a_number_that_no_engine_says_costs_its_own_sample(tmp_path: Path) -> None:
    log = lcm.EventLog(str(tmp_path / "log"), "w", overwrite=True)
    machine = msgs.machine_description()
    machine.text, machine.period_s = text_of(MINIMAL["axis"]), 0.001
    log.write_event(1, "takt/machine", machine.encode())
    for cycle, buffered in enumerate((0, 0, -9, 0)):
        state = msgs.axis_state()
        state.name, state.cycle, state.time_ns, state.sequence = "x", cycle, cycle * 10**6, cycle
        state.buffered_commands = buffered
        log.write_event(1, "takt/axis/x", state.encode())
    log.close()
    recording = takt.read_log(tmp_path / "log")
    assert recording["x"]["cycle"].tolist() == [0, 1, 3]
    assert "1 message cannot be true" in recording.meta["trouble"]


def test_a_changed_number_costs_its_own_message(
    whole: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """EN-36: a bit of a number, where a decoder sees nothing wrong, is found by the checksum of the event."""
    log = tmp_path / "log"
    log.write_bytes(whole)
    name = takt.read_log(log).components[0]
    channel = f"takt/axis/{name}".encode()
    chosen = [(begin, end) for begin, end in spans(whole) if whole[begin + HEADER.size :].startswith(channel)]
    begin, end = chosen[50]
    state = msgs.axis_state.decode(whole[begin + HEADER.size + len(channel) : end])
    at = whole.index(struct.pack(">d", state.set_position), begin)
    log.write_bytes(whole[:at] + bytes([whole[at] ^ 0x40]) + whole[at + 1 :])
    recording = takt.read_log(log)
    assert "1 message with a checksum that does not hold" in recording.meta["trouble"]
    assert f"1 sample of {name} in 1 gap" in all_missing(recording)
    for tool in ("log", "replay"):
        assert main([tool, str(log)]) == 1
        assert "1 message with a checksum that does not hold" in capsys.readouterr().out


@pytest.mark.parametrize("cycle", [4, 10**6], ids=["a cycle that was", "a cycle of the future"])
def test_a_forged_state_costs_itself_alone(cycle: int, tmp_path: Path) -> None:
    """EN-36: one that says otherwise of the same cycle, and one after which true ones would seem to be late."""
    log = lcm.EventLog(str(tmp_path / "log"), "w", overwrite=True)
    machine = msgs.machine_description()
    machine.text, machine.period_s = text_of(MINIMAL["axis"]), 0.001
    log.write_event(1, "takt/machine", machine.encode())

    def write(cycle: int, position: float) -> None:
        state = msgs.axis_state()
        state.name, state.cycle, state.time_ns, state.sequence = "x", cycle, cycle * 10**6, cycle
        state.set_position = position
        log.write_event(1, "takt/axis/x", state.encode())

    for i in range(9):
        write(i, float(i))
        if i == 5:
            write(3, 3.0)  # the same again, late: no contradiction
            write(cycle, 99.0)
    log.close()
    recording = takt.read_log(tmp_path / "log")
    assert recording["x"]["cycle"].tolist() == list(range(9))
    assert recording["x"]["set_position"].tolist() == list(map(float, range(9)))
    assert recording.meta["trouble"] == "The log is not whole: 1 state of components in contradiction to others."
    assert main(["log", str(tmp_path / "log")]) == 1


@pytest.mark.parametrize(("state", "ticket", "cycle", "taken"), [
    (2, 5, 3, True), (2, 5, 10**7, False), (2, 5, -1, False), (4, 5, -1, False), (4, 0, -1, True), (0, 5, -1, True),
])  # fmt: skip
def test_reports_of_cycles_that_were_not(state: int, ticket: int, cycle: int, taken: bool, tmp_path: Path) -> None:
    """EN-36: only that a command is waited for, or was refused at the door, belongs to no cycle."""
    log = lcm.EventLog(str(tmp_path / "log"), "w", overwrite=True)
    machine = msgs.machine_description()
    machine.text, machine.period_s = text_of(MINIMAL["axis"]), 0.001
    log.write_event(1, "takt/machine", machine.encode())
    for i in range(5):
        sample = msgs.axis_state()
        sample.name, sample.cycle, sample.time_ns, sample.sequence = "x", i, i * 10**6, i
        log.write_event(1, "takt/axis/x", sample.encode())
    report = msgs.feedback()
    report.state, report.ticket, report.cycle = state, ticket, cycle
    log.write_event(1, "takt/feedback", report.encode())
    log.close()
    assert open_log(tmp_path / "log").trouble == ("" if taken else "The log is not whole: 1 message cannot be true.")


def test_a_description_without_a_period(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = lcm.EventLog(str(tmp_path / "log"), "w", overwrite=True)
    machine, state = msgs.machine_description(), msgs.axis_state()
    machine.text, machine.period_s, state.name = text_of(MINIMAL["axis"]), float("nan"), "x"
    log.write_event(1, "takt/machine", machine.encode())
    log.write_event(1, "takt/axis/x", state.encode())
    log.close()
    assert main(["log", str(tmp_path / "log")]) == 1
    assert "1 message cannot be true" in capsys.readouterr().out
    with pytest.raises(LogError, match="the period of the machine that it describes is nan s"):
        takt.read_log(tmp_path / "log")


def test_a_description_with_changed_bytes(tmp_path: Path) -> None:
    """The one that is said most often counts; engines repeat it every second."""
    log = lcm.EventLog(str(tmp_path / "log"), "w", overwrite=True)
    good = text_of(MINIMAL["axis"])
    for text in (good.replace("axes", "ayes"), good, good, good.replace('"x"', '"u"')):
        machine = msgs.machine_description()
        machine.text, machine.period_s = text, 0.001
        log.write_event(1, "takt/machine", machine.encode())
    state = msgs.axis_state()
    state.name = "x"
    log.write_event(1, "takt/axis/x", state.encode())
    log.close()
    assert takt.read_log(tmp_path / "log").components == ("x",)


@pytest.mark.parametrize(("order", "said"), [("abab", True), ("aabb", False), ("aba", False), ("a", False)])
def test_two_engines_at_once(order: str, said: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-20: states do not say whose they are; so it is said where two engines are described in turn. A single
    description with a changed number of its run is none, nor is an engine that was started anew."""
    log = lcm.EventLog(str(tmp_path / "log"), "w", overwrite=True)
    for cycle, letter in enumerate(order):
        machine, state = msgs.machine_description(), msgs.axis_state()
        machine.run_id, machine.text, machine.period_s = ord(letter), text_of(MINIMAL["axis"]), 0.001
        state.name, state.cycle, state.time_ns = "x", cycle, cycle * 1_000_000
        log.write_event(1, "takt/machine", machine.encode())
        log.write_event(1, "takt/axis/x", state.encode())
    log.close()
    assert main(["log", str(tmp_path / "log")]) == (1 if said else 0)
    assert ("2 engines spoke at once" in capsys.readouterr().out) == said


def test_all_kinds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A machine of all kinds, with every tenth event damaged somewhere."""
    file, log = tmp_path / "machine.yaml", tmp_path / "log"
    file.write_text(text_of(FULL))
    command = [taktd(), file, "--no-lcm", "--pace", "fast", "--duration", "0.1", "--log", log]
    subprocess.run(command, check=True, capture_output=True)
    data, chance = bytearray(log.read_bytes()), random.Random(5)
    for begin, end in spans(bytes(data))[2::10]:
        data[chance.randrange(begin, end)] ^= 1 << chance.randrange(8)
    log.write_bytes(data)
    for tool in ("log", "replay"):
        assert main([tool, str(log)]) == 1
    assert main(["report", str(log)]) == 0
    assert "The log is not whole: " in capsys.readouterr().out
