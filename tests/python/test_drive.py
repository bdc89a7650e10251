"""AX-87, EN-26: drives in other processes, over the network, with engines that run in process and in taktd."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import lcm
import numpy as np
import pytest
import takt
from machines import new_url, running, taktd
from plants import INSIDE, LONG_S, Lag, inside, only_x, outside, plant, served
from takt import drive, msgs


def work(session: takt.Session) -> takt.Recording:
    """Something for every axis."""
    record = session.record()
    x, y, z = (session.axis(name) for name in ("x", "y.2", "z"))
    for axis in (x, y, z):
        axis.power().wait()
    x.move_absolute(position=100.0)
    y.arm_probe(edge="rising")
    y.move_velocity(velocity=80.0)
    z.gear_in(master="x")
    session.run(1.0)
    x.move_absolute(position=0.0, velocity=200.0).wait()
    y.reset().wait_final()
    return record.stop()


def same(a: takt.Recording, b: takt.Recording) -> bool:
    def seen(recording: takt.Recording, axis: str) -> bytes:
        table = recording[axis].copy()
        table["true_position"] = 0  # only the plant knows it
        return table.tobytes()

    return all(seen(a, axis) == seen(b, axis) for axis in ("x", "y.2", "z"))


def test_a_plant_in_another_process_is_the_built_in_one(tmp_path: Path) -> None:
    """AX-87, EN-26: in simulated time bit for bit, whatever the processes do in between; and again."""
    url = new_url()
    with takt.Engine(inside(url)) as engine:
        expected = work(engine)
    assert np.ptp(expected["x"]["actual_position"]) > 90
    assert expected["y.2"]["probe_captures"][-1] == 1
    with plant(tmp_path, outside(url)):
        for late in (0, 2):  # the second engine may still hear an answer for each drive to the first, and refuses it
            with takt.Engine(outside(url)) as engine:
                assert same(work(engine), expected)
                assert engine.figures["samples_refused"] <= late


def test_engine_and_plant_may_come_in_any_order(tmp_path: Path) -> None:
    """EN-26: an engine in simulated time waits for its plant."""
    url = new_url()
    with takt.Engine(outside(url)) as engine:
        begun = threading.Thread(target=engine.run, args=(0.5,))
        begun.start()
        time.sleep(0.3)
        assert begun.is_alive()
        with plant(tmp_path, outside(url)):
            begun.join(LONG_S)
        assert engine.cycle == 500
        assert engine.axis("x").error == 0


def test_a_journal_needs_no_plant(tmp_path: Path) -> None:
    """EN-07, EN-26: what taktd heard of the drives is in its log."""
    for pace in ("fast", "paced", "real"):
        url = new_url()
        file = tmp_path / f"{pace}.lcm"
        machine = outside(url, missing_cycles=2000)
        with (
            plant(tmp_path, machine, "--watchdog", "5000"),
            running(tmp_path, url, "--log", str(file), machine=machine, pace=pace),
            takt.connect(url) as session,
        ):
            x, y = session.axis("x"), session.axis("y.2")
            x.power()
            y.power().wait(timeout=LONG_S)
            x.move_absolute(position=20.0)
            y.move_absolute(position=10.0).wait(timeout=LONG_S)
        result = takt.replay(file)
        assert result.same, result.sentence
        assert np.ptp(takt.read_log(file)["x"]["actual_position"]) > 10


def test_a_plant_of_ones_own() -> None:
    """EN-26."""
    url = new_url()
    lag = Lag()
    with served(url, lag), takt.Engine(only_x(url)) as engine:
        x = engine.axis("x")
        x.power().wait()
        x.move_absolute(position=-30.0).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(-30.0, abs=0.002)
        assert lag.counts == pytest.approx(-30_000.0, abs=2.0)
        engine.shut_down()


def test_a_plant_told_to_end_before_it_begins_ends() -> None:
    """As by a signal between its first line and its first set point."""
    idle = drive.Plant({"x": Lag()}, new_url())
    idle.stop()
    begin_s = time.monotonic()
    idle.run(LONG_S)
    assert time.monotonic() - begin_s < LONG_S / 2
    idle.run(0.01)  # and serves when it is told to again


def test_what_the_documentation_shows() -> None:
    """EN-26: its machine and its drive."""
    page = (Path(__file__).parents[2] / "docs" / "real_drives.md").read_text()
    machine = page.partition("```yaml\n")[2].partition("```")[0]
    code, call, _ = page.partition("```python\n")[2].partition("```")[0].partition("drive.Plant(")
    assert call
    shown: dict[str, Any] = {}
    exec(code, shown)
    url = new_url()
    with served(url, shown["Lag"]()), takt.Engine(machine, url=url) as engine:
        x = engine.axis("x")
        x.power().wait()
        x.move_absolute(position=50.0).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(50.0, abs=0.002)


def test_without_a_network_there_are_no_drives(tmp_path: Path) -> None:
    """EN-26: said in one line."""
    file = tmp_path / "machine.yaml"
    file.write_text(outside(new_url()))
    result = subprocess.run([taktd(), str(file), "--no-lcm"], capture_output=True, text=True, check=False)
    assert result.returncode == 2
    assert result.stderr == "taktd: the machine has external drives, which --no-lcm leaves out of reach\n"
    with pytest.raises(takt.ConnectionError, match="nonsense"):
        takt.Engine(file, url="nonsense")


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        (INSIDE, [], "has no external drives (external: drives: - axis: NAME)"),
        (outside("udpm://239.255.76.67:7667?ttl=0"), ["--axis", "z"], "external.drives has no axis z; it has x, y.2"),
        (outside("http://nowhere"), [], "expected one like"),
    ],
)
def test_plants_that_cannot_be(tmp_path: Path, text: str, options: list[str], sentence: str) -> None:
    """EN-26: said in one line."""
    file = tmp_path / "machine.yaml"
    file.write_text(text)
    command = [sys.executable, "-m", "takt", "plant", str(file), *options]
    result = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ)
    assert result.returncode == 2
    assert sentence in result.stderr
    assert len(result.stderr.splitlines()) == 1
    with pytest.raises(takt.TaktError, match="at least one drive"):
        drive.Plant({})


class Forgetful(drive.Bus):
    """Two drives on a wire that now and then does not hear one of them."""

    axes = ("x", "y.2")

    def __init__(self) -> None:
        self.exchanges = 0
        self.counts = dict.fromkeys(self.axes, 0.0)

    def exchange(self, told: Mapping[str, drive.SetPoint], *, real_time: bool) -> Mapping[str, drive.Measured | None]:
        self.exchanges += 1
        for axis, point in told.items():
            if point.enable and point.mode == drive.CYCLIC_POSITION:
                self.counts[axis] = point.position_counts
        heard = {
            axis: drive.Measured(counts=round(self.counts[axis]), drive_ready=point.enable)
            for axis, point in told.items()
        }
        return heard | {"x": None} if self.exchanges % 100 == 0 else heard

    def idle(self, stop: Collection[str]) -> None: ...


def test_drives_on_one_wire() -> None:
    """EN-26: all set points of a cycle at once; only an answer that is missing is asked for again."""
    url = new_url()
    bus, said = Forgetful(), []  # type: ignore[var-annotated]
    plant = drive.Plant({}, url, buses=[bus], say=said.append)
    thread = threading.Thread(target=plant.run)
    thread.start()
    try:
        with takt.Engine(outside(url)) as engine:
            x = engine.axis("x")
            x.power().wait()
            x.move_absolute(position=30.0).wait()
            engine.run(0.2)
            assert x.actual_position == pytest.approx(30.0, abs=0.01)
            assert x.error == 0
            assert bus.exchanges - engine.cycle == pytest.approx(bus.exchanges / 100, abs=3)
    finally:
        plant.stop()
        thread.join(LONG_S)


class Late(drive.Bus):
    """A drive on a wire whose computer is late now and then."""

    axes = ("x",)

    def __init__(self) -> None:
        self.cycles: list[int] = []

    def exchange(self, told: Mapping[str, drive.SetPoint], *, real_time: bool) -> Mapping[str, drive.Measured | None]:
        self.cycles.append(told["x"].cycles)
        return {"x": drive.Measured()}

    def idle(self, stop: Collection[str]) -> None: ...


class Alone(drive.Drive):
    """The same with a wire of its own."""

    def __init__(self) -> None:
        self.cycles: list[int] = []

    def step(self, told: drive.SetPoint, elapsed_s: float) -> drive.Measured:
        self.cycles.append(told.cycles)
        assert elapsed_s == pytest.approx(told.cycles * told.period_s)
        return drive.Measured()


def test_drives_are_told_how_many_cycles_have_passed() -> None:
    """EN-26: since the set point before, also where some were lost or came all at once."""
    url = new_url()
    network, told = lcm.LCM(url), msgs.drive_setpoint()
    told.axis, told.run_id, told.real_time, told.period_s = "x", 1, True, 0.001
    bus, alone = Late(), Alone()
    for drives, buses in (({}, [bus]), ({"x": alone}, [])):
        serving = drive.Plant(drives, url, buses=buses, watchdog=1_000_000)
        for at_once in ([1], [2], [12], [13, 15, 40], [41]):
            for told.cycle in at_once:
                network.publish("takt/drive/x/setpoint", told.encode())
            time.sleep(0.01)
            for _ in range(10):
                serving.handle(0.002)
    assert bus.cycles == [1, 1, 10, 28, 1]
    assert alone.cycles == [1, 1, 10, 1, 2, 25, 1]
