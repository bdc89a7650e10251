"""PY-23, AX-87: plants in the process of an engine, in step with it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
import takt
import yaml
from plants import inside, outside
from takt import _core, drive
from takt.plant import MEASURED, Drives, OnNetwork, Rows
from test_drive import same, work

URL = "udpm://239.255.76.67:7690?ttl=0"  # nothing is ever sent there
MACHINE = inside(URL)


def servos(*axes: str) -> Drives:
    return Drives({axis: drive.SimulatedServo(MACHINE, axis) for axis in axes})


class Lag(takt.Plant):
    """Makes up for half of the lag of its axes in each cycle."""

    def __init__(self, *axes: str, fails_at: int = 10**9) -> None:
        self.axes = axes
        self.fails_at = fails_at
        self.calls: list[int] = []
        self.started: tuple[str, float] | None = None
        self.at = np.zeros(len(axes))

    def start(self, machine: Mapping[str, Any], period_s: float) -> None:
        self.started = (machine["name"], period_s)

    def step(self, cycle: int, told: Rows, measured: Rows) -> None:
        self.calls.append(cycle)
        if cycle == self.fails_at:
            raise takt.PlantError("the belt of the trial has torn")
        self.at += 0.5 * np.where(told["enable"], told["position_counts"] - self.at, 0)
        measured["counts"] = np.round(self.at).astype(np.int64) & 0xFFFF_FFFF
        measured["drive_ready"] = told["enable"]
        measured["true_position"] = self.at / 1000


def test_drives_in_process_are_the_built_in_servos() -> None:
    """Bit for bit, and whether the machine file calls them external or not; nothing goes over the network."""
    with takt.Engine(MACHINE) as engine:
        expected = work(engine)
    for machine in (MACHINE, outside(URL)):
        with takt.Engine(machine, plant=servos("y.2", "x")) as engine:
            assert same(work(engine), expected)
            assert engine.figures["samples_refused"] == 0


STOPS: dict[str, Callable[[takt.Engine], object]] = {
    "halt": lambda session: session.axis("x").halt(),
    "stop held": lambda session: session.axis("x").stop(hold=True),
    "power off": lambda session: session.axis("x").power(enable=False),
    "emergency stop held": lambda session: session.emergency_stop(hold=True),
    "stop all": lambda session: session.stop_all(),
    "override 0": lambda session: session.axis("x").set_override(velocity_factor=0),
}


@pytest.mark.parametrize("stop", STOPS.values(), ids=list(STOPS))
def test_stops_act_as_on_simulated_servos(stop: Callable[[takt.Engine], object]) -> None:
    """AX-100: in motion; what is refused afterwards is refused, and what was recorded is the same, bit for bit."""

    def run(session: takt.Engine) -> tuple[takt.Recording, list[int]]:
        x = session.axis("x")
        x.power().wait()
        with session.record("x") as recorder:
            x.move_absolute(position=80)
            session.run(0.2)
            stop(session)
            session.run(0.8)
            asked = [x.power(), x.move_absolute(position=5)]
            session.run(0.5)
        assert recorder.recording["x"]["set_velocity"][190] > 1
        return recorder.recording, [one.error_id for one in asked]

    with takt.Engine(MACHINE) as engine:
        expected, refused = run(engine)
    with takt.Engine(MACHINE, plant=servos("x")) as engine:
        recording, answers = run(engine)
    assert answers == refused
    for field in ("set_position", "actual_position", "state", "error", "loop_closed"):
        assert np.array_equal(recording["x"][field], expected["x"][field]), field


def test_all_set_points_of_a_cycle_come_at_once() -> None:
    """One call a cycle, from -1 on, with a row for each axis in the plant's order."""
    plant = Lag("z", "x")
    with takt.Engine(MACHINE, plant=plant) as engine:
        assert plant.started == ("test", 0.001)
        assert plant.calls == []
        engine.step(5)
        assert plant.calls == [-1, 0, 1, 2, 3]
        x, z = engine.axis("x"), engine.axis("z")
        x.power().wait()
        z.power().wait()
        x.move_absolute(position=50).wait()
        assert plant.at[1] == pytest.approx(50_000, abs=20)
        assert plant.at[0] == 0
        assert x.true_position == pytest.approx(50, abs=0.02)
        assert plant.calls == list(range(-1, engine.cycle - 1))


def test_its_journal_needs_no_plant() -> None:
    """What the plant measured is in the journal of external drives: the run again, without it, has the same states."""
    with takt.Engine(MACHINE, plant=servos("x"), journal=True) as engine:
        engine.axis("x").power().wait()
        engine.axis("x").move_absolute(position=10).wait()
        commands, drives = engine.take_journal(), engine.take_drive_journal()
        cycles, hashes = engine.take_hashes()
    again = _core.Engine(MACHINE.encode(), "machine", journal=True, plant=["x"])
    again.set_plant(Recorded({cycle: wires for cycle, _, _, wires in drives}).step)
    for cycle, ticket, lease, target, verb, arguments in commands:
        again.step(cycle - again.cycle)
        again.resubmit(target, verb, arguments, ticket, lease)
    again.step(len(cycles) - again.cycle)
    assert np.array_equal(again.take_hashes()[1], hashes)


class Recorded:
    def __init__(self, wires: Mapping[int, Mapping[str, Any]]) -> None:
        self.wires = wires

    def step(self, cycle: int, told: Rows, measured: Rows) -> None:
        wires = self.wires[cycle + 1]
        measured[0] = tuple(wires.get(name, np.nan) for name in MEASURED.names or ())


def test_a_plant_that_fails_stops_its_engine() -> None:
    """What it raises comes out of the step; what was recorded is there; no further cycle is made."""
    plant = Lag("x", fails_at=40)
    with takt.Engine(MACHINE, plant=plant) as engine:
        record = engine.record()
        with pytest.raises(takt.PlantError, match="torn"):
            engine.step(100)
        assert engine.cycle == 41
        with pytest.raises(RuntimeError, match="failed before"):
            engine.step()
        assert engine.cycle == 41
        assert len(record.stop()["x"]) == 41


def test_a_plant_must_not_ask_its_engine() -> None:
    """It would wait for itself for ever."""

    class Asks(Lag):
        engine: takt.Engine | None = None

        def step(self, cycle: int, told: Rows, measured: Rows) -> None:
            super().step(cycle, told, measured)
            if cycle == 3 and self.engine is not None:
                self.engine.axis("x").actual_position  # noqa: B018

    plant = Asks("x")
    with takt.Engine(MACHINE, plant=plant) as engine:
        plant.engine = engine
        with pytest.raises(RuntimeError, match="must not use its engine"):
            engine.step(10)
        plant.engine = None


@pytest.mark.parametrize(
    ("plant", "machine", "said"),
    [
        (Lag(), MACHINE, "moves no axes"),
        (Lag("q"), MACHINE, "axis 'q', which the machine does not have"),
        (Lag("x", "x"), MACHINE, "axis 'x' twice"),
        (Lag("x"), outside(URL), "external.drives has y.2, which the plant does not move"),
    ],
)
def test_plants_that_do_not_fit(plant: takt.Plant, machine: str, said: str) -> None:
    with pytest.raises(takt.ConfigError, match=said):
        takt.Engine(machine, plant=plant)


def test_what_is_no_plant() -> None:
    with pytest.raises(TypeError, match='or "mujoco", not'):
        takt.Engine(MACHINE, plant="gazebo")  # type: ignore[arg-type]


def test_a_machine_as_a_dict() -> None:
    """PY-23: the same engine as of its text; what no machine file can hold is refused."""
    described = yaml.safe_load(MACHINE)
    described["axes"][0]["limits"]["velocity"] = np.float64(500)
    hashes = []
    for machine in (MACHINE, described):
        with takt.Engine(machine, changes={"axes.x.limits.jerk": 50_000}) as engine:
            engine.axis("x").power().wait()
            engine.axis("x").move_absolute(position=20).wait()
            hashes.append(engine.state_hash)
    assert hashes[0] == hashes[1]
    with pytest.raises(takt.ConfigError, match=r"machine:7:5: axes\[0\]\.limits: .*'velocty'"):
        takt.Engine({"name": "x", "axes": [{"name": "x", "limits": {"velocty": 1, "acceleration": 1, "jerk": 1}}]})
    for wrong, said in ((float("nan"), "no machine file can hold"), ({1, 2}, "is no number, text, list or dict")):
        with pytest.raises(takt.ConfigError, match=said):
            takt.Engine({"name": "x", "axes": wrong})


def test_the_first_answer_in_real_time_is_measured() -> None:
    """AX-87: an absolute encoder is read before anything is told; 0 would be a place, and the next answer a jump."""

    class Standing(takt.Plant):
        axes = ("x",)

        def start(self, machine: Mapping[str, Any], period_s: float) -> None:
            pass

        def step(self, cycle: int, told: Rows, measured: Rows) -> None:
            measured["counts"] = 100_000

    machine = {"name": "m", "cycle": {"period_s": 0.001}}
    bus = OnNetwork(Standing, machine)
    bus.start("x", real_time=True, period_s=0.001)
    for _ in range(2):
        found = bus.exchange({"x": drive.SetPoint()}, real_time=True)["x"]
        assert found is not None
        assert found.counts == 100_000
