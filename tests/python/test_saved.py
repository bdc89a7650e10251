"""PY-23: engines are saved, restored and cloned at any cycle, and go on in the same way."""

from __future__ import annotations

import os
import pickle
import random
from pathlib import Path

import pytest
import takt
from takt.ready import EXAMPLES
from test_walks import MACHINES, walk

MACHINE = (EXAMPLES / "one_axis" / "machine.yaml").read_text(encoding="utf-8")
CELL = EXAMPLES / "delta_cell" / "machine.yaml"


def states(engine: takt.Engine, cycles: int) -> list[int]:
    found = []
    for _ in range(cycles):
        engine.step()
        found.append(engine.state_hash)
    return found


def test_a_clone_goes_on_as_the_engine_does() -> None:
    """In the middle of a move of a group, to the bit; afterwards they are two."""
    with takt.Engine(CELL, journal=True) as engine:
        robot = engine.group("robot")
        robot.power().wait()
        robot.enable().wait()
        robot.move_direct_absolute(x=0, y=0, z=-760, coordinate_system="mcs").wait()
        robot.move_linear_absolute(x=50, y=20, z=-780, coordinate_system="mcs")
        engine.step(37)
        before = engine.take_journal()
        with engine.clone() as clone:
            assert (clone.cycle, clone.state_hash) == (engine.cycle, engine.state_hash)
            assert engine.take_journal() == clone.take_journal() == []
            assert states(clone, 200) == states(engine, 200)
            for one in (engine, clone):
                one.group("robot").move_linear_absolute(x=0, y=0, z=-760, coordinate_system="mcs").wait()
            assert clone.state_hash == engine.state_hash
            clone.group("robot").move_linear_absolute(x=10, coordinate_system="mcs")
            assert states(clone, 5)[-1] != states(engine, 5)[-1]
            with clone.clone() as third:
                assert third.state_hash == clone.state_hash
        assert before


@pytest.mark.parametrize("machine", MACHINES)
def test_clones_of_random_walks_go_on_as_they_did(machine: str) -> None:
    """All kinds of component in whatever state, with what no cycle has applied yet."""
    for seed in range(200 if os.environ.get("TAKT_LONG") else 2):
        with takt.Engine(MACHINES[machine], journal=True) as engine:
            rnd = random.Random(seed)
            for _ in range(3):
                walk(engine, rnd, 25)
                with engine.clone() as clone:
                    assert states(clone, 40) == states(engine, 40), (seed, engine.cycle)


def test_what_no_cycle_has_applied_yet_is_kept() -> None:
    """More commands than one cycle applies, of which a clone of a clone knows, too."""
    with takt.Engine(MACHINE, journal=True) as engine:
        axis = next(iter(engine.axes.values()))
        axis.power().wait()
        for distance in range(40):
            axis.move_relative(distance=0.01 * (distance + 1), buffer_mode="aborting")
        with engine.clone() as clone, clone.clone() as third:
            expected = states(engine, 100)
            assert states(clone, 100) == expected
            assert states(third, 60) == expected[:60]
            assert engine.take_journal()[1:] == clone.take_journal() == third.take_journal()
            assert axis.set_position == clone.axis(axis.name).set_position > 0


def test_an_engine_that_shuts_down_is_saved() -> None:
    with takt.Engine(MACHINE, journal=True) as engine:
        axis = next(iter(engine.axes.values()))
        axis.power().wait()
        axis.move_velocity(velocity=2)
        engine.run(0.5)
        engine.shut_down()
        refused = axis.power()
        engine.step(3)
        with engine.clone() as clone:
            assert states(clone, 10) == states(engine, 10)
            again = clone.axis(axis.name).power()
            clone.step(2)
            assert str(again.error) == str(refused.error) != "None"


def test_an_engine_that_is_off_shuts_down_for_its_clones_too() -> None:
    """EN-08: the end of the machine is in what is saved."""
    with takt.Engine(MACHINE, journal=True) as engine:
        engine.step(10)
        engine.shut_down()
        with engine.clone() as copy:
            name = next(iter(engine.axes))
            refused, again = (one.axis(name).power().wait_final() for one in (engine, copy))
            assert again.sentence == refused.sentence != ""


def test_what_is_saved_can_be_kept_and_gone_back_to() -> None:
    """Pickled, and as often as one wishes: branches from one state."""
    with takt.Engine(MACHINE, journal=True, period=0.002) as engine:
        axis = next(iter(engine.axes.values()))
        axis.power().wait()
        axis.move_relative(distance=5)
        engine.step(20)
        saved = pickle.loads(pickle.dumps(engine.save()))
        assert (saved.cycle, saved.hash) == (engine.cycle, engine.state_hash)
        end = states(engine, 50)
    ends = []
    for velocity in (None, 3.0, None):
        with takt.Engine.restore(saved) as branch:
            assert branch.period == 0.002
            if velocity is not None:
                branch.axis(axis.name).move_velocity(velocity=velocity)
            ends.append(states(branch, 50))
    assert ends[0] == ends[2] == end
    assert ends[1] != end


def test_what_cannot_be_saved_is_said(tmp_path: Path) -> None:
    with takt.Engine(MACHINE) as engine:
        assert engine.take_journal() == []
        with pytest.raises(takt.TaktError, match=r"only an engine with a journal .* journal=True"):
            engine.clone()
    with takt.Engine(MACHINE, journal=True) as engine:
        engine.step(5)
        saved = engine.save()
    wrong = takt.Saved(
        saved.machine_text, saved.file_name, saved.period_s, saved.cycle, saved.hash ^ 1, saved.journal, "0.0.1"
    )
    with pytest.raises(takt.TaktError, match=r"after 5 cycles is not the one that was saved \(by version 0\.0\.1"):
        takt.Engine.restore(wrong)
    with pytest.raises(TypeError, match=r"expected what Engine\.save returned, not 'x'"):
        takt.Engine.restore("x")  # type: ignore[arg-type]
    with pytest.raises(takt.ClosedError):
        engine.save()
