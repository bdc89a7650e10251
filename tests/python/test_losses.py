"""PY-20: what a report calls complete is complete. The losses of every channel are counted and said."""

from __future__ import annotations

import json
import random
import re
from pathlib import Path
from typing import Any

import lcm
import pytest
import takt
from every_kind import FULL, text_of
from takt import checks, msgs
from takt.cli import main
from takt.missing import all_missing, lost

CYCLES = 200
PERIOD = 0.002
# Of each channel: its type, the name that its messages carry, and cycles from one to the next.
CHANNELS: dict[str, tuple[Any, str, int]] = {
    "takt/axis/feed": (msgs.axis_state, "feed", 1),
    "takt/belt/belt": (msgs.belt_state, "belt", 2),
    "takt/belt/turntable": (msgs.belt_state, "turntable", 2),
    "takt/belt_objects/belt": (msgs.belt_objects, "belt", 2),
    "takt/belt_objects/turntable": (msgs.belt_objects, "turntable", 2),
    "takt/feedback": (msgs.feedback, "", 5),
    "takt/drive/feed/feedback": (msgs.drive_feedback, "", 1),
    "takt/engine": (msgs.engine_state, "", 20),
    "takt/track_shapes/line": (msgs.track_shape, "line", 40),
    "takt/mover_trails/mover": (msgs.mover_trail, "mover", 40),
    "takt/mover_routes/mover": (msgs.mover_route, "mover", 40),
}
# Nothing else is published.
QUIET = {"axis_rate_hz": 0, "rates": [{"axis": name, "rate_hz": 500} for name in ("feed", "belt", "turntable")]}
STATES = ("takt/axis/feed", "takt/belt/belt", "takt/belt/turntable")
REPEATING = ("takt/engine", "takt/track_shapes/line", "takt/mover_trails/mover", "takt/mover_routes/mover")


def write(path: Path, left_out: dict[str, range], *, on_the_way: bool = True, dropped: int = 0) -> Path:
    """A log without the messages of these cycles, by channel: lost on the way, or never sent."""
    log = lcm.EventLog(str(path), "w", overwrite=True)
    machine = msgs.machine_description()
    machine.text, machine.period_s = text_of({**FULL, "lcm": QUIET}), PERIOD
    log.write_event(1, "takt/machine", machine.encode())
    sequences = dict.fromkeys(CHANNELS, 0)
    for cycle in range(CYCLES):
        for channel, (kind, name, step) in CHANNELS.items():
            if cycle % step:
                continue
            gone = cycle in left_out.get(channel, ())
            message = kind()
            for field, value in (
                ("name", name),
                ("cycle", cycle),
                ("time_ns", round(cycle * PERIOD * 1e9)),
                ("sequence", sequences[channel]),
            ):
                if field in message.__slots__:
                    setattr(message, field, value)
            if channel == "takt/engine":
                message.snapshots_dropped = dropped * (cycle > CYCLES / 2)
            sequences[channel] += not gone or on_the_way
            if not gone:
                log.write_event(1, channel, message.encode())
    log.close()
    return path


def page(run: Path) -> dict[str, Any]:
    """What the report shows."""
    assert main(["report", str(run)]) == 0
    text = run.with_suffix(".html").read_text(encoding="utf-8")
    found = re.search(r'<script[^>]*id="data"[^>]*>(.*?)</script>', text, re.DOTALL)
    assert found
    return dict(json.loads(found[1]))


def test_a_whole_log(tmp_path: Path) -> None:
    run = write(tmp_path / "run.log", {})
    recording = takt.read_log(run)
    assert (all_missing(recording), recording.meta["losses"], recording.meta["dropped"]) == ("", {}, {})
    shown = page(run)
    assert shown["meta"]["lost samples"] == "none"
    assert shown["trouble"] == ""


@pytest.mark.parametrize("gone", [0, 7])
def test_messages_in_another_order_are_not_lost(gone: int, tmp_path: Path) -> None:
    """A datagram may overtake others or come twice."""
    whole = write(tmp_path / "whole.log", {"takt/axis/feed": range(100, 100 + gone)})
    events = [(one.channel, one.data) for one in lcm.EventLog(str(whole), "r")]
    chance = random.Random(gone)
    mixed = sorted(range(1, len(events)), key=lambda i: i + chance.uniform(0, 40))
    mixed += chance.sample(mixed, 20)
    log = lcm.EventLog(str(tmp_path / "mixed.log"), "w", overwrite=True)
    for channel, data in [events[0], *(events[i] for i in mixed)]:
        log.write_event(1, channel, data)
    log.close()
    losses = takt.read_log(tmp_path / "mixed.log").meta["losses"]
    assert losses == ({"takt/axis/feed": gone} if gone else {})


@pytest.mark.parametrize("channel", CHANNELS)
def test_messages_lost_on_the_way(channel: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    step = CHANNELS[channel][2]
    run = write(tmp_path / "run.log", {channel: range(80, 120)})
    recording = takt.read_log(run)
    count = 40 // step
    assert recording.meta["losses"] == {channel: count}
    shown = page(run)
    assert list(shown["meta"]["messages lost on the way, of"].values()) == [str(count)]
    assert main(["log", str(run)]) == 0
    assert f"{channel}  {CYCLES // step - count}  {count}  0\n" in capsys.readouterr().out
    if channel in REPEATING:  # the next one says all that was in it
        assert all_missing(recording) == ""
        return
    assert "lost samples" not in shown["meta"]
    said = (
        f"{count} samples of {CHANNELS[channel][1]} in 1 gap" if channel in STATES else f"{count} messages of {channel}"
    )
    if count == 1:
        said = said.replace("messages", "message")
    assert said in all_missing(recording)
    assert said in shown["trouble"]


@pytest.mark.parametrize("channel", ["takt/belt_objects/belt", "takt/belt/belt"])
def test_what_the_engine_had_no_room_for(channel: str, tmp_path: Path) -> None:
    """Their numbers go on, their cycles do not: of what lies on belts, too, which nothing else shows."""
    run = write(tmp_path / "run.log", {channel: range(120, 160)}, on_the_way=False, dropped=20)
    recording = takt.read_log(run)
    said = all_missing(recording)
    assert "20 states that the engine had no room for" in said
    if channel in STATES:
        assert said.startswith("20 samples of belt in 1 gap")
    else:
        assert recording.meta["losses"] == {channel: 20}
        assert f"20 messages of {channel}" in said
    shown = page(run)
    assert "lost samples" not in shown["meta"]
    assert "20 states that the engine had no room for" in shown["trouble"]


@pytest.mark.parametrize("channel", ["takt/axis/feed", "takt/belt/belt", "takt/belt_objects/belt"])
@pytest.mark.parametrize("since", [0, 60])
def test_what_is_not_heard_any_more(channel: str, since: int, tmp_path: Path) -> None:
    """Neither numbers nor cycles show what is missing at the end."""
    run = write(tmp_path / "run.log", {channel: range(since, CYCLES)})
    recording = takt.read_log(run)
    name = CHANNELS[channel][1] if channel in STATES else channel
    last = since - CHANNELS[channel][2] if since else 0
    assert recording.meta["silent"] == {name: pytest.approx(last * PERIOD)}
    assert all_missing(recording) == f"{name} from {last * PERIOD:g} s on"
    assert "lost samples" not in page(run)["meta"]


@pytest.mark.parametrize("channel", ["takt/axis/feed", "takt/belt/belt", "takt/belt_objects/belt"])
def test_a_beginning_that_is_missing(channel: str, tmp_path: Path) -> None:
    """PY-20: its first number says that there were others before, when other components were heard."""
    run = write(tmp_path / "run.log", {channel: range(120)})
    recording = takt.read_log(run)
    name = CHANNELS[channel][1] if channel in STATES else channel
    assert all_missing(recording) == f"{name} before {120 * PERIOD:g} s"
    assert "lost samples" not in page(run)["meta"]
    if channel in STATES:
        verdict = checks.complete(recording, name)
        assert (verdict.passed, verdict.sentence) == (False, f"the samples of {name} before 0.24 s are missing")
        assert checks.complete(recording.slice(0.3, 0.4), name).passed
    everything = takt.read_log(write(tmp_path / "late.log", dict.fromkeys(CHANNELS, range(120))))  # joined late
    assert all_missing(everything) == ""


def test_an_end_that_is_missing_is_not_complete(tmp_path: Path) -> None:
    recording = takt.read_log(write(tmp_path / "run.log", {"takt/axis/feed": range(120, CYCLES)}))
    verdict = checks.complete(recording, "feed")
    assert (verdict.passed, verdict.sentence) == (False, "the samples of feed from 0.238 s on are missing")
    assert checks.complete(recording, "belt").passed
    assert checks.complete(recording.slice(0.0, 0.2), "feed").passed


def test_many_channels_are_counted(tmp_path: Path) -> None:
    names = ["takt/belt_objects/belt", "takt/belt_objects/turntable", "takt/feedback", "takt/drive/feed/feedback"]
    recording = takt.read_log(write(tmp_path / "run.log", dict.fromkeys(names, range(60, 100))))
    assert lost(recording) == (
        "40 messages of takt/drive/feed/feedback; 20 messages of takt/belt_objects/belt; "
        "20 messages of takt/belt_objects/turntable; some of 1 other channel"
    )


def test_a_number_that_cannot_be_is_no_loss(tmp_path: Path) -> None:
    """No channel of a component has more than one message a cycle: that message alone is missing."""
    run = write(tmp_path / "run.log", {})
    data = run.read_bytes()
    state = msgs.belt_objects()
    state.name, state.cycle, state.time_ns, state.sequence = "belt", 40, 80_000_000, 20
    at = data.index(state.encode())
    changed = state.encode()
    state.sequence = 2**40
    run.write_bytes(data[:at] + state.encode() + data[at + len(changed) :])
    assert takt.read_log(run).meta["losses"] == {"takt/belt_objects/belt": 1}
