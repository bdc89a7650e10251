"""AX-87, EN-20: what comes from plants and cannot be believed."""

from __future__ import annotations

import time
import warnings
from typing import Any

import lcm
import numpy as np
import pytest
import takt
from machines import new_url
from plants import Lag, eventually, only_x, served
from takt import drive, msgs


def answer(url: str, **changes: object) -> None:
    """A message to the engine from somebody else."""
    message = msgs.drive_feedback()
    message.axis = "x"
    channel = str(changes.pop("channel", "takt/drive/x/feedback"))
    for name, value in changes.items():
        setattr(message, name, value)
    lcm.LCM(url).publish(channel, message.encode())


class Wrong(Lag):
    """Answers with what the engine must refuse, in one cycle."""

    def __init__(self, url: str, changes: dict[str, object]) -> None:
        super().__init__()
        self.send = lambda: answer(url, **changes)
        self.calls = 0

    def step(self, told: drive.SetPoint, elapsed_s: float) -> drive.Measured:
        measured = super().step(told, elapsed_s)
        self.calls += 1
        if self.calls == 300:
            self.send()
            time.sleep(0.05)  # so that it comes first
        return measured


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"channel": "takt/drive/q/feedback"}, "expected the name of an axis, found 'q'"),
        ({"channel": "takt/drive/z/feedback"}, "external.drives do not name axis z"),
        ({"axis": "z"}, "axis: expected x, found 'z'"),
        ({"run_id": 5}, "answers another start of an engine"),
    ],
)
def test_wrong_messages_are_refused(changes: dict[str, object], sentence: str) -> None:
    """AX-87: with a sentence, and nothing comes of them."""
    url = new_url()

    def run(wrong: bool) -> tuple[takt.Recording, list[str]]:
        made = Wrong(url, changes) if wrong else Lag()
        with served(url, made), takt.Engine(only_x(url)) as engine, warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            record = engine.record()
            x = engine.axis("x")
            x.power().wait()
            x.move_absolute(position=50.0).wait()
            engine.run(0.2)
            return record.stop(), [str(w.message) for w in caught if w.category is takt.DriveWarning]

    expected, nothing = run(False)
    recording, sentences = run(True)
    assert nothing == []
    assert len(sentences) == 1
    assert sentence in sentences[0]
    assert recording["x"].tobytes() == expected["x"].tobytes()


@pytest.mark.filterwarnings("ignore:.*no plant answers")
def test_what_is_no_number_is_refused() -> None:
    """AX-87: a drive whose numbers are none is as good as silent."""
    url = new_url()
    lag = Lag()
    with served(url, lag), takt.Engine(only_x(url, 3, 0.5)) as engine:
        x = engine.axis("x")
        x.power().wait()
        lag.torque_nm = float("nan")
        with pytest.warns(takt.DriveWarning, match="torque_nm: expected a finite number, found nan"):
            engine.run(0.02)
        assert x.state is takt.PlcState.ERROR_STOP
        assert x.error == 3002
        assert np.isfinite(x.torque_nm)


def test_messages_of_another_version_are_refused() -> None:
    """EN-20: another fingerprint."""
    url = new_url()

    class Other(Lag):
        def step(self, told: drive.SetPoint, elapsed_s: float) -> drive.Measured:
            measured = super().step(told, elapsed_s)
            lcm.LCM(url).publish("takt/drive/x/feedback", b"\x01" + msgs.drive_feedback().encode()[1:])
            return measured

    with served(url, Other()), takt.Engine(only_x(url)) as engine:
        with pytest.warns(takt.DriveWarning, match="no drive_feedback of this version of Takt"):
            eventually(lambda: engine.figures["samples_refused"] or engine.run(0.05))
        assert engine.axis("x").error == 0


def test_drive_processes_of_before_go_on_working(monkeypatch: pytest.MonkeyPatch) -> None:
    """AX-87: those from before drive_error and later_s, whose messages are shorter and have another fingerprint: what
    they do not know is 0, the motion is the same."""
    encode = drive.Plant._encode

    def before(plant: drive.Plant, line: Any, measured: drive.Measured, cycle: int) -> bytes:
        return bytes.fromhex("21b308b742c4984c") + encode(plant, line, measured, cycle)[8:-16]

    def run() -> bytes:
        url = new_url()
        with served(url, Lag()), takt.Engine(only_x(url)) as engine:
            x = engine.axis("x")
            x.power().wait()
            record = engine.record()
            x.move_absolute(position=5.0).wait()
            recording = record.stop()
            assert not recording["x"]["drive_error"].any()
            return bytes(recording["x"]["actual_position"].tobytes())

    now = run()
    monkeypatch.setattr(drive.Plant, "_encode", before)
    assert run() == now


def test_two_plants_for_one_axis() -> None:
    """AX-87: the first one is listened to, the second one is warned of."""
    url = new_url()
    first, second = Lag(), Lag()
    second.counts = 500_000.0
    with served(url, first), takt.Engine(only_x(url)) as engine:
        x = engine.axis("x")
        x.power().wait()
        with served(url, second):
            with pytest.warns(takt.DriveWarning, match="a second plant answers for this axis"):
                eventually(lambda: engine.figures["samples_refused"] or engine.run(0.01))
            x.move_absolute(position=10.0).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(10.0, abs=0.002)
        assert x.error == 0


def test_a_closed_engine_is_silent() -> None:
    """AX-87: drives hear no more of it, though Python may not have taken it away yet."""
    url = new_url()
    network, heard = lcm.LCM(url), []
    network.subscribe("takt/drive/x/setpoint", lambda _, data: heard.append(data))
    with served(url, Lag()), takt.Engine(only_x(url)) as engine:
        engine.run(0.2)
    while network.handle_timeout(100):
        pass
    assert heard
    assert network.handle_timeout(300) == 0
    assert engine.cycle >= 200
