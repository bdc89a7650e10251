"""CAM-80: belts and movers as masters of cam modules, with clutch, scaling and sequencer."""

from __future__ import annotations

import numpy as np
import pytest
import takt
from takt import cam

MACHINE = """\
name: masters
axes:
  - {name: knife, unit: mm, limits: {velocity: 3000, acceleration: 60000, jerk: 6000000}}
  - {name: drive, unit: mm, limits: {velocity: 1000, acceleration: 5000, jerk: 100000}}
belts: [{name: infeed, axis: drive, ratio: 2, source: SOURCE}]
movers:
  - {name: shuttle, width: 113, height: 113, initial: {x: 60, y: 60, c: 0},
     xy: {maximum: {velocity: 2000, acceleration: 10000, jerk: 200000}}}
cams:
  - {name: up, cyclic: true, segments: [{to: {x: 50, y: 20}, law: cycloid}, {to: {x: 100, y: 0}, law: cycloid}]}
  - {name: down, cyclic: true, segments: [{to: {x: 60, y: -15}, law: cycloid}, {to: {x: 100, y: 0}, law: cycloid}]}
  - {name: low, cyclic: true, segments: [{to: {x: 40, y: 5}, law: cycloid}, {to: {x: 100, y: 0}, law: cycloid}]}
flex_cams:
  - {name: fc, slave: knife, master: MASTER, cams: [up, down, low],
     settings: {sync_mode: ramp_pos, master_sync_in_distance: 80, master_sync_in_position: 300, slave_absolute: true,
                scaling_mode_master: relative, cam_sequence_mode: cam1_cam3}}
"""
UP, DOWN, LOW = cam.of_machine(MACHINE.replace("MASTER", "drive").replace("SOURCE", "set_value"))


def machine(master: str, source: str = "set_value") -> str:
    return MACHINE.replace("MASTER", master).replace("SOURCE", source)


def moves(engine: takt.Engine, master: str) -> None:
    """What the module follows goes on by more than 1,000 mm."""
    if master == "infeed":
        engine.axis("drive").power().wait()
        engine.axis("drive").move_velocity(velocity=250)
    else:
        mover = engine.mover("shuttle")
        mover.enable().wait()
        mover.move_to_position(x=1400, y=60, velocity=500)


@pytest.mark.parametrize("master", ["infeed", "shuttle.x"])
def test_a_belt_and_a_mover_lead_a_module(master: str) -> None:
    """CAM-50, CAM-80: in every cycle on the cam the slave is where the cam says for its master of that cycle."""
    with takt.Engine(machine(master)) as engine:
        fc = engine.flex_cam("fc")
        assert fc.master is (engine.belt("infeed") if master == "infeed" else engine.mover("shuttle"))
        fc.control(regulator_on=True)
        engine.wait(lambda: fc.axis_enabled, 2.0)
        if master == "infeed":
            engine.axis("drive").power().wait()
        else:
            engine.mover("shuttle").enable().wait()
        closing = fc.control(sync_cam=True)
        closing.wait(until="active")
        moves(engine, master)
        rows = []
        while not closing.final:
            engine.step()
        assert closing.done
        assert fc.clutch == takt.ClutchPhase.CLOSED
        for _ in range(300):
            engine.step()
            rows.append((fc.mp01_set_master_position, engine.axis("knife").set_position))
        at, knife = np.array(rows).T
        assert at[0] >= 300
        assert np.max(np.abs(knife - UP.at(at % 100).y)) < 1e-6
        place = engine.belt("infeed").position if master == "infeed" else engine.mover("shuttle").x
        assert abs(place - at[-1]) < 1e-9
        before = fc.mp03_master_to_x_position, fc.mp01_set_master_position
        fc.control(scaling_master=0.5).wait()
        engine.run(0.2)
        after = fc.mp03_master_to_x_position, fc.mp01_set_master_position
        assert (after[0] - before[0]) / (after[1] - before[1]) == pytest.approx(0.5, abs=0.02)
        fc.control(cam_sequencer=True).wait()
        engine.wait(lambda: fc.cam_table == 3, 3.0)


def test_a_measured_belt_leads_a_module() -> None:
    """CAM-80: a belt whose measured position counts is a master, too; it is noisy and filtered."""
    with takt.Engine(machine("infeed", "actual_value")) as engine:
        fc = engine.flex_cam("fc")
        fc.control(regulator_on=True)
        engine.wait(lambda: fc.axis_enabled, 2.0)
        moves(engine, "infeed")
        fc.control(sync_cam=True).wait()
        engine.run(0.5)
        assert fc.cam_synchronised


def test_a_mover_that_is_off_is_no_master() -> None:
    with takt.Engine(machine("shuttle.x")) as engine:
        fc = engine.flex_cam("fc")
        fc.control(regulator_on=True)
        engine.wait(lambda: fc.axis_enabled, 2.0)
        assert fc.master_lost
        assert fc.control(sync_cam=True).wait_final().sentence == takt.error_text(3019)


def test_an_unknown_master_is_named() -> None:
    with pytest.raises(
        takt.ConfigError, match=r"expected the name of an axis, a belt or a mover, found 'infed'.*infeed"
    ):
        takt.Engine(machine("infed"))


@pytest.mark.parametrize("source", ["set_value", "actual_value"])
def test_a_belt_on_the_slave_is_no_master(source: str) -> None:
    """CAM-80, EN-10: the slave would follow itself."""
    wrong = machine("infeed", source).replace("axis: drive", "axis: knife")
    expected = r"flex_cams\[0\].master: expected another master than a belt on the slave 'knife', found 'infeed'"
    with pytest.raises(takt.ConfigError, match=expected):
        takt.Engine(wrong)


def test_a_virtual_master_is_none() -> None:
    with takt.Engine(machine("drive").replace("master: drive, ", "")) as engine:
        assert engine.flex_cam("fc").master is None


@pytest.mark.parametrize(
    ("master", "unit"), [("infeed", "mm"), ("shuttle.x", "mm"), ("shuttle.c", "deg"), ("drive", "mm")]
)
def test_recordings_know_the_unit_of_any_master(master: str, unit: str) -> None:
    """CAM-80: what is in the master's unit is so in a recording, whatever kind of component the master is."""
    with takt.Engine(machine(master)) as engine:
        recorder = engine.record()
        engine.step(5)
        recording = recorder.stop()
    assert recording.unit("fc", "clutch_position") == unit
    assert recording.unit("fc", "clutch_master_velocity") == f"{unit}/s"
