"""Pick and place modules whose group is stopped, moved or taken away by other commands while a profile is under way."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
import takt
from test_pick_place import MACHINE, started, tool

Other = Callable[[takt.Engine], object]
READY = takt.PickPlaceState.READY
TARGET = (100.0, 0.0, 0.0)


def running(speed: float, z_distance: float = 25, sync_time: float = 0.05) -> takt.Engine:
    """A machine whose belt runs with `speed` [mm/s]."""
    text = MACHINE.replace("z_distance: 25", f"z_distance: {z_distance}")
    engine = started(text.replace("sync_time: 0.05", f"sync_time: {sync_time}"))
    engine.axis("drive").move_velocity(velocity=speed).wait(until="reached")
    return engine


def picking(engine: takt.Engine) -> takt.Feedback:
    engine.belt("infeed").detect(x=100).wait()
    return engine.pick_place("picker").execute(1)


def counted(engine: takt.Engine, limit_s: float = 3) -> list[float]:
    """Steps so long. Distances [mm] between the tool and the workpiece or target, where picked or placed rises."""
    picker, belt, group = engine.pick_place("picker"), engine.belt("infeed"), engine.group("portal")
    apart = []
    for _ in range(round(limit_s * 1000)):
        counts, objects = (picker.picked, picker.placed), belt.objects
        engine.step()
        if picker.picked > counts[0]:
            apart.append(math.dist(tool(engine), objects[0].pose[:3]))
        if picker.placed > counts[1]:
            apart.append(math.dist(tool(engine), TARGET))
        assert group.in_sync or not picker.synchronised
    return apart


def jogged(engine: takt.Engine) -> None:
    jog = engine.group("portal").jog(x=30)
    engine.run(0.2)
    jog.release()


def disabled(engine: takt.Engine) -> None:
    engine.group("portal").disable()
    engine.run(0.3)
    engine.group("portal").enable()


def switched_off(engine: takt.Engine) -> None:
    engine.group("portal").power(enable=False)
    engine.run(0.3)
    engine.group("portal").power()
    engine.run(0.3)
    engine.group("portal").enable()


LOSSES: dict[str, Other] = {
    "halt": lambda engine: engine.group("portal").halt(),
    "stop": lambda engine: engine.group("portal").stop(),
    "move": lambda engine: engine.group("portal").move_linear_absolute(x=20, y=20, z=20),
    "jog": jogged,
    "continue": lambda engine: engine.group("portal").continue_path(),
    "disable": disabled,
    "power": switched_off,
    "stop_all": lambda engine: engine.command("machine", "stop_all", {}),
}


@pytest.mark.parametrize("brakes", [False, True], ids=["at rest", "braking"])
@pytest.mark.parametrize("target", [0, 1])
@pytest.mark.parametrize("hold", ["path_stop", "path_halt", "path_interrupt"])
@pytest.mark.parametrize("by", LOSSES)
def test_a_held_path_that_is_lost_is_not_done(by: str, hold: str, target: int, brakes: bool) -> None:
    """PP-20: however the interrupt ended; the tool moves back first, or the profile is aborted."""
    engine = running(20)
    picker = engine.pick_place("picker")
    engine.belt("infeed").detect(x=100).wait()
    going = picker.execute(target)
    engine.run(0.1)
    picker.control(**{hold: True})
    engine.run(0.005 if brakes else 0.5)
    held = tool(engine)
    if hold != "path_interrupt" and not brakes:
        picker.control(**{hold: False})
        engine.run(0.05)
    LOSSES[by](engine)
    engine.run(0.8)
    picker.control(**{hold: False})
    engine.run(0.1)
    assert not going.done
    assert (picker.picked, picker.placed, picker.state) == (0, 0, READY)
    if going.aborted:
        assert not picker.path_hold
        assert (hold, by) in {("path_interrupt", other) for other in ("stop", "disable", "power", "stop_all")}
    else:
        assert picker.off_path
        assert picker.execute(target).wait_final().error_id == 3031
        picker.control(return_to_path=True).wait()
        assert not picker.off_path
        assert tool(engine) == pytest.approx(held, abs=0.1 if not brakes else 5)
    picker.execute(target)
    apart = counted(engine)
    assert len(apart) == 1
    assert apart[0] < 0.5
    assert going.aborted or going.done


def test_a_path_lost_behind_the_way_back_is_lost_again() -> None:
    """PP-20: a tool that other commands move away once more has to return once more."""
    engine = running(20)
    picker, group = engine.pick_place("picker"), engine.group("portal")
    going = picker.execute(0)
    engine.run(0.1)
    picker.control(path_stop=True)
    engine.run(0.5)
    picker.control(path_stop=False)
    engine.run(0.05)
    held = tool(engine)
    for _ in range(2):
        group.move_linear_absolute(x=20, y=60, z=-40).wait()
        engine.run(0.05)
        assert picker.off_path
        picker.control(return_to_path=True).wait()
        picker.control(return_to_path=False)
        assert tool(engine) == pytest.approx(held, abs=1e-3)
    picker.execute(0)
    assert counted(engine)[0] < 0.5
    assert going.done


def a_fault(engine: takt.Engine) -> None:
    picker = engine.pick_place("picker")
    picker.execute(0)
    engine.run(0.1)
    engine.axis("x").power(enable=False)
    engine.run(0.5)
    assert picker.state is takt.PickPlaceState.ERROR
    picker.control(reset_error=True)
    engine.run(1)
    picker.control(reset_error=False)


def enabled_by_others(engine: takt.Engine) -> None:
    picker, group = engine.pick_place("picker"), engine.group("portal")
    picker.control(stop_all=True)
    engine.run(0.3)
    group.enable()
    engine.run(0.3)
    picker.control(stop_all=False)


@pytest.mark.parametrize(
    "before", [lambda engine: None, a_fault, enabled_by_others], ids=["nothing", "fault", "others"]
)
def test_a_disable_of_its_group_is_not_undone(before: Other) -> None:
    """PP-20: also after the module was about to enable it; profiles never continue by themselves."""
    engine = started()
    picker, group = engine.pick_place("picker"), engine.group("portal")
    before(engine)
    engine.run(0.5)
    assert (picker.state, picker.axes_group_enabled) == (READY, True)
    placed = picker.placed
    going = picker.execute(0)
    engine.run(0.1)
    group.disable()
    engine.run(0.8)
    assert going.aborted
    assert (picker.state, picker.placed, picker.axes_group_enabled) == (READY, placed, False)


def on_workpiece(engine: takt.Engine) -> None:
    group = engine.group("portal")
    engine.wait(lambda: group.in_sync and abs(group.object_z) < 1e-9, 5)


@pytest.mark.parametrize("z_distance", [25, 0])
@pytest.mark.parametrize("interrupted_s", [0.002, 0.15])
def test_the_time_on_a_workpiece_runs_on_it_alone(z_distance: float, interrupted_s: float) -> None:
    """PP-41, PP-42: not while the group is interrupted or catches up, and `synchronised` is false meanwhile."""
    engine = running(300, z_distance, 0.02)
    group = engine.group("portal")
    going = picking(engine)
    on_workpiece(engine)
    engine.step(10)
    group.interrupt()
    engine.run(interrupted_s)
    group.continue_path()
    apart = counted(engine)
    assert len(apart) == 1
    assert apart[0] < 0.5
    assert going.done


@pytest.mark.parametrize("z_distance", [25, 0])
@pytest.mark.parametrize("catches_up", [False, True])
@pytest.mark.parametrize("by", ["path_stop", "path_halt", "path_interrupt", "ack_gripper", "enable"])
def test_nothing_is_picked_beside_a_workpiece(by: str, catches_up: bool, z_distance: float) -> None:
    """PP-31, PP-41: a pick that is stopped while its group is interrupted is missed."""
    engine = running(100, z_distance, 0.2)
    picker, group = engine.pick_place("picker"), engine.group("portal")
    going = picking(engine)
    on_workpiece(engine)
    engine.step(10)
    group.interrupt()
    engine.run(0.3)
    if catches_up:
        group.continue_path()
        engine.step(20)
    picker.control(**{by: by != "enable"})
    apart = counted(engine, 0.5)
    if by == "ack_gripper":  # asks for the end of a time that does not run
        group.continue_path()
        apart += counted(engine, 2)
        assert len(apart) == 1
        assert apart[0] < 0.5
        assert going.done
        return
    assert apart == []
    assert (picker.picked, picker.missed, picker.missed_interrupted) == (0, 1, 1)
    assert engine.belt("infeed").object_count == 0
    assert not going.done


@pytest.mark.parametrize("z_distance", [25, 0])
@pytest.mark.parametrize("stop", ["path_stop", "path_halt", "path_interrupt", "enable"])
def test_a_pick_stopped_in_the_cycle_of_its_arrival(stop: str, z_distance: float) -> None:
    """PP-20, PP-61: it ends as with ack_gripper from that cycle on, with any z_distance; before, it begins anew."""
    for early in range(-3, 4):
        engine = running(100, z_distance)
        picker = engine.pick_place("picker")
        if early == -3:
            picking(engine)
            on_workpiece(engine)
            arrival = engine.cycle
            engine = running(100, z_distance)
            picker = engine.pick_place("picker")
        going = picking(engine)
        engine.step(arrival + early - engine.cycle)
        picker.control(**{stop: stop != "enable"})
        engine.step()
        done = going.done
        assert done == (picker.picked == 1)
        assert done or early < 0
        assert counted(engine, 0.4) == []
        if stop == "enable":
            assert going.final
            continue
        picker.control(**{stop: False})
        engine.run(0.01)
        if stop != "path_interrupt" and not done:
            picker.execute(1)
        assert [distance < 0.5 for distance in counted(engine)] == ([] if done else [True])
        assert picker.picked == 1


def test_a_static_profile_stopped_in_the_cycle_of_its_arrival() -> None:
    """PP-20: it is done, and no path is held."""
    engine = started()
    picker = engine.pick_place("picker")
    begin = engine.cycle
    picker.execute(0).wait()
    takes = engine.cycle - begin
    for early in range(-3, 2):
        engine = started()
        picker = engine.pick_place("picker")
        going = picker.execute(0)
        engine.step(takes + early)
        picker.control(path_stop=True)
        engine.run(0.2)
        picker.control(path_stop=False)
        engine.run(0.1)
        assert not picker.off_path
        if not going.done:
            assert counted(engine, 0.1) == []
            picker.execute(0)
            assert counted(engine, 1)[0] < 0.5
        assert going.done
        assert math.dist(tool(engine), TARGET) < 0.5


ENDS: dict[str, tuple[Other, int]] = {  # and how many are picked
    "enable": (lambda engine: engine.pick_place("picker").control(enable=False), 1),
    "stop_all": (lambda engine: engine.pick_place("picker").control(stop_all=True), 0),
    "halt": (lambda engine: engine.group("portal").halt(), 0),
    "stop": (lambda engine: engine.group("portal").stop(), 0),
    "disable": (lambda engine: engine.group("portal").disable(), 0),
    "power": (lambda engine: engine.group("portal").power(enable=False), 0),
    "regulator_on": (lambda engine: engine.pick_place("picker").control(regulator_on=False), 0),
    "axis": (lambda engine: engine.axis("x").power(enable=False), 0),
    "emergency_stop": (lambda engine: engine.command("machine", "emergency_stop", {}), 0),
}


@pytest.mark.parametrize("by", ENDS)
def test_a_pick_that_ends_on_its_workpiece_takes_it_along(by: str) -> None:
    """PP-20, PP-41: the gripper may hold it, so that no other pick gets it: it is picked, or counts as missed."""
    engine = running(100, sync_time=0.3)
    picker = engine.pick_place("picker")
    going = picking(engine)
    on_workpiece(engine)
    engine.step(20)
    end, picked = ENDS[by]
    end(engine)
    engine.run(0.4)
    assert (picker.picked, picker.missed_interrupted, picker.missed) == (picked, 1 - picked, 1 - picked)
    assert engine.belt("infeed").object_count == 0
    assert picker.held == picked
    assert going.done == (picked == 1)


REFUSALS: dict[str, tuple[Other, int]] = {
    "disabled": (lambda engine: engine.group("portal").disable(), 3025),
    "stopped": (lambda engine: engine.group("portal").stop(hold=True), 6),
    "off": (lambda engine: engine.group("portal").power(enable=False), 10),
}


@pytest.mark.parametrize("cause", REFUSALS)
@pytest.mark.parametrize("what", ["execute", "home_execute", "return_to_path", "jog"])
def test_a_refusal_names_what_the_group_lacks(cause: str, what: str) -> None:
    """PP-63: that it is disabled, held by a stop, or that its axes are off."""
    engine = started()
    picker = engine.pick_place("picker")
    act, error = REFUSALS[cause]
    act(engine)
    engine.run(0.5)
    picker.control(select_axis="x").wait()
    asked = picker.jog(positive=True) if what == "jog" else picker.control(**{what: True})
    engine.run(0.05)
    assert asked.error_id == error
