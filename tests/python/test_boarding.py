"""GR-40, GR-42: a tool at rest gets onto belts and tables, whatever comes between."""

from __future__ import annotations

import os
import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from carried import GENTLE, ROBOTS, Cell, ends_told, machine, off_target
from machines import new_url, running

RUNS = 2000 if os.environ.get("TAKT_LONG") else 120


def test_random_boardings_keep_all_limits() -> None:
    """GR-40, GR-42: limits hold whatever comes between, and what is Done is on its place."""
    done = 0
    for seed in range(RUNS):
        chance = random.Random(seed)
        carrier = chance.choice(["belt", "belt", "table"])
        fast = (20, 450) if carrier == "belt" else (5, 80)
        cell = Cell(chance.choice(list(ROBOTS)), carrier, chance.choice([-1, 1]) * chance.uniform(*fast))
        far = chance.choice([5, 30, 100])
        by = (chance.uniform(-far, far), chance.uniform(-far, far), chance.uniform(-far, far))
        slow = {"velocity": chance.uniform(50, 500), "acceleration": chance.uniform(1000, 5000)}
        before = chance.random() < 0.3
        if before:
            cell.group.move_linear_relative(z=chance.uniform(-15, 15), velocity=200)
        more: dict[str, Any] = slow if chance.random() < 0.3 else {}
        move = cell.line(by, **more, **({"buffer_mode": "buffered"} if before else {}))
        blended = chance.random() < 0.3
        if blended:
            cell.line(
                (by[0] + 10, by[1] - 20, by[2]),
                buffer_mode="blending_next",
                transition_mode="corner_distance",
                transition_parameter=5,
            )
        cell.engine.run(chance.choice([chance.uniform(0, 0.05), chance.uniform(0, 0.3)]))
        event = chance.choice(
            ["none", "halt", "stop", "interrupt", "slow", "override 0", "belt", "other", "belt halts"]
        )
        if event == "halt":
            cell.group.halt()
        elif event == "stop":
            cell.group.stop()
        elif event == "interrupt":
            cell.group.interrupt()
            cell.engine.run(chance.uniform(0, 0.3))
            cell.group.continue_path()
        elif event in ("slow", "override 0"):
            cell.group.set_override(velocity_factor=chance.uniform(0.1, 0.9) if event == "slow" else 0)
            cell.engine.run(chance.uniform(0, 0.3))
            cell.group.set_override()
        elif event == "belt":
            cell.carrier.set_override(velocity_factor=chance.uniform(0.3, 0.9))
        elif event == "other":
            cell.group.move_linear_absolute(**{axis: cell.robot.begin[axis] for axis in "xyz"})
        elif event == "belt halts":
            cell.carrier.halt()
        cell.engine.run(2.0)
        undisturbed = move.done and event in ("none", "slow", "override 0", "other")
        run = cell.judge(move.cycle if undisturbed else 0)
        if move.done and not blended:
            done += 1
            assert off_target(run, move.cycle, cell.target(by)) < 1e-4, f"seed {seed}: {event}"
        cell.engine.close()
    assert done > RUNS / 3


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("carrier", ["belt", "table"])
def test_a_tool_is_taken_along_at_once(name: str, carrier: str) -> None:
    """GR-42: up from a carrier at speed takes about as long as from one that stands, and time_left says when."""
    cycles = []
    for speed in (0, 200 if carrier == "belt" else 40):
        cell = Cell(name, carrier, speed)
        start = cell.engine.cycle
        move = cell.line((0, 0, 60)).wait()
        run = cell.judge(move.cycle)
        cycles.append(move.cycle - start)
        assert off_target(run, move.cycle, cell.target((0, 0, 60))) < 1e-6
    assert cycles[1] <= 1.15 * cycles[0]
    assert ends_told(run, cell.engine.period) == {move.cycle}


def test_time_left_counts_what_getting_into_step_takes() -> None:
    """GR-42: where that takes longer than the way, time_left is until the tool is in step."""
    cell = Cell("gantry", "belt", 500)
    move = cell.line((0, 12, 0)).wait()
    assert ends_told(cell.judge(move.cycle), cell.engine.period) == {move.cycle}


def test_override_0_keeps_a_tool_where_it_is() -> None:
    """GR-42: at override 0 a tool at rest is not taken along; later it gets there."""
    cell = Cell("gantry", "belt", 200)
    cell.group.set_override(velocity_factor=0)
    move = cell.line((0, 50, 0))
    cell.engine.run(0.5)
    assert cell.group.pose[:3] == (0, 0, 0)
    cell.group.set_override()
    move.wait()
    assert off_target(cell.judge(move.cycle), move.cycle, cell.target((0, 50, 0))) < 1e-4


def test_moves_before_it_are_done_first() -> None:
    """GR-22, GR-42: a move from rest behind others, or behind one of no length, is carried out like any other."""
    for way in (0.0, 30.0):
        cell = Cell("gantry", "belt", 150)
        first = cell.group.move_linear_absolute(z=way)
        second = cell.line((0, 40, way), buffer_mode="buffered")
        third = cell.line((20, 40, way), buffer_mode="buffered")
        third.wait(timeout=3)
        assert (first.done, second.done) == (True, True)
        assert first.cycle <= second.cycle < third.cycle
        run = cell.judge(third.cycle)
        assert off_target(run, second.cycle, cell.target((0, 40, way))) < 1e-6
        assert off_target(run, third.cycle, cell.target((20, 40, way))) < 1e-6


@pytest.mark.parametrize("upper", [*range(196, 230, 3)])
def test_a_place_that_leaves_the_range_is_refused_or_let_go(upper: int) -> None:
    """GR-40, GR-42: near the end of an axis the move ends with error 3021, and the tool stands within the range."""
    ends = f"{{name: gx, unit: mm, limits: {{lower: -1000, upper: {upper}, "
    text = machine(ROBOTS["gantry"]).replace("{name: gx, unit: mm, limits: {", ends)
    with takt.Engine(text) as engine:
        group = engine.group("robot")
        for axis in engine.axes.values():
            axis.power().wait()
        group.enable().wait()
        engine.axis("drive").move_velocity(velocity=300).wait(until="reached")
        group.set_dyn_coord_transform(pcs=1, carrier="belt").wait()
        move = group.move_linear_absolute(x=100, y=150, z=0, coordinate_system="pcs", pcs=1, velocity=800).wait_final()
        engine.run(1.0)
        assert move.done or move.error_id == 3021
        assert group.state is takt.GroupState.GROUP_STANDBY
        assert engine.axis("gx").set_position <= upper
        assert engine.axis("gx").set_velocity == 0


@pytest.mark.parametrize("speed", [-1000, 600, 1000])
@pytest.mark.parametrize("by", [(50, 50, 0), (0, 20, 0), (-20, 0, 0)])
def test_fast_belts_leave_the_axes_within_their_velocities(speed: float, by: tuple[float, float, float]) -> None:
    """GR-40, GR-42: at two thirds of an axis' velocity, too, where the tool goes faster than the belt to catch up."""
    cell = Cell("gantry", "belt", speed)
    move = cell.line(by).wait()
    assert off_target(cell.judge(move.cycle), move.cycle, cell.target(by)) < 1e-6


@pytest.mark.parametrize("speed", [-200, -150, 115, 200])
@pytest.mark.parametrize("by", [(0, 0, 60), (-3.6, 0, 2.1), (30, -20, 0)])
def test_tables_that_turn_fast_leave_gentle_axes_in_step(speed: float, by: tuple[float, float, float]) -> None:
    """GR-40, GR-42: where the jerk of the axes is little, and turning takes a large part of it."""
    cell = Cell(GENTLE, "table", speed)
    move = cell.line(by).wait()
    assert off_target(cell.judge(move.cycle), move.cycle, cell.target(by)) < 1e-4


@pytest.mark.parametrize("wait", [0.003, 0.008, 0.015, 0.025, 0.04])
@pytest.mark.parametrize(("before", "after"), [(200, 250), (200, 150), (300, 600), (300, 0)])
def test_a_belt_that_changes_its_velocity_while_the_tool_boards(before: float, after: float, wait: float) -> None:
    """GR-40, GR-42: the path waits until the tool is in step with what the belt does now."""
    for by in ((0, 0, 60), (-2, 0, 0), (50, 50, 0)):
        cell = Cell("gantry", "belt", before)
        move = cell.line(by)
        cell.engine.run(wait)
        if after:
            cell.carrier.move_velocity(velocity=after)
        else:
            cell.carrier.halt()
        move.wait()
        cell.engine.run(1.0)
        assert off_target(cell.judge(move.cycle), cell.engine.cycle - 1, cell.target(by)) < 1e-4


@pytest.mark.parametrize("speed", [100, 400])
@pytest.mark.parametrize("wait", [0.01, 0.02, 0.03, 0.04])
def test_a_trifle_of_a_change_does_not_throw_the_tool_past_its_object(speed: float, wait: float) -> None:
    """GR-40, GR-42: it comes nearer all the time, or overshoots by a few mm."""
    cell = Cell("gantry", "belt", speed)
    move = cell.line((0, 0, 60))
    cell.engine.run(wait)
    cell.carrier.move_velocity(velocity=1.0001 * speed)
    move.wait()
    lags = cell.judge(move.cycle)["robot"]["object_x"]
    assert np.max(lags) <= 0.02 * speed
    assert np.min(lags) >= -0.1 * speed


@pytest.mark.parametrize("speed", [100, 300, 600])
@pytest.mark.parametrize("wait", [0.01, 0.02, 0.03, 0.04])
def test_an_interrupt_while_the_tool_boards_brakes_it_as_a_halt_does(speed: float, wait: float) -> None:
    """GR-24, GR-42: and continue takes it to its place."""
    ways = []
    for interrupt in (False, True):
        cell = Cell("gantry", "belt", speed)
        move = cell.line((0, 0, 60))
        cell.engine.run(wait)
        x = cell.engine.axis("gx")
        begin = x.set_position
        (cell.group.interrupt if interrupt else cell.group.halt)()
        for _ in range(1000):
            cell.engine.run(0.001)
            if x.set_velocity == 0:
                break
        ways.append(x.set_position - begin)
        if interrupt:
            cell.group.continue_path()
            move.wait()
            run = cell.judge(move.cycle)
            assert off_target(run, move.cycle, cell.target((0, 0, 60))) < 1e-4
    assert ways[1] <= 1.2 * ways[0] + 1


def arc(cell: Cell) -> takt.Feedback:
    target, middle = cell.target((0, 100, 0)), cell.target((50, 50, 0))
    aux = {f"aux_{axis}": place for axis, place in middle.items()}
    return cell.group.move_circular_absolute(coordinate_system="pcs", pcs=1, **target, **aux)


WAYS: dict[str, Any] = {
    "arc on a slow belt": ("belt", 3, arc),
    "arc": ("belt", 150, arc),
    "far away on a slow belt": ("belt", 50, lambda cell: cell.line((-300, 0, 0))),
    "ahead on a fast belt": ("belt", 750, lambda cell: cell.line((300, 0, 0))),
    "across a fast table": ("table", 120, lambda cell: cell.line((-150, 150, -80))),
    "towards the middle of a table": ("table", 60, lambda cell: cell.line((0, -100, 0))),
    "at a low velocity": ("belt", 600, lambda cell: cell.line((0, 0, 60), velocity=300, acceleration=2000, jerk=20000)),
}


@pytest.mark.parametrize("way", WAYS)
def test_boarding_is_chosen_where_it_is_faster(way: str) -> None:
    """GR-42: no move takes longer for it, whatever its length, its shape and the velocity of the carrier."""
    carrier, speed, command = WAYS[way]
    times = []
    for board in (False, True):
        cell = Cell("gantry", carrier, speed, board)
        start = cell.engine.now
        move = command(cell).wait(timeout=5)
        times.append(move.time_s - start)
        cell.judge(move.cycle)
    assert times[1] <= 1.06 * times[0]


@pytest.mark.parametrize("by", [(200, 20, 0), (3, 20, 0), (0, 20, 60)])
def test_a_move_behind_a_stop_has_all_limits_again(by: tuple[float, float, float]) -> None:
    """GR-42: what boarding takes is not kept from the next move."""
    times = []
    for at_once in (True, False):
        cell = Cell("gantry", "belt", 600)
        first = cell.line((0, 20, 0))
        if not at_once:
            first.wait()
        second = cell.line(by, buffer_mode="buffered").wait()
        times.append(second.time_s - first.time_s)
        cell.judge(second.cycle)
    assert times[0] <= times[1] + 0.04


@pytest.mark.parametrize("jerk", [50000, 100000])
@pytest.mark.parametrize("speed", [200, 300, 500])
def test_a_move_behind_a_boarding_one_is_no_slower(jerk: float, speed: float) -> None:
    """GR-42: over an object, then down onto it; the first path may end before the tool is in step."""
    for aside in (0, 20, 40):
        times = []
        for board in (True, False):
            cell = Cell(GENTLE._replace(limits=(1500, 15000, jerk)), "belt", speed, board)
            start = cell.engine.now
            cell.line((aside, 30, 40))
            move = cell.line((aside, 30, 0), buffer_mode="buffered").wait()
            times.append(move.time_s - start)
            cell.judge(move.cycle)
        assert times[0] <= 1.02 * times[1], aside


def test_what_boarded_before_is_no_matter_for_moves_that_go_over() -> None:
    """GR-42: boardings that were broken off leave nothing behind."""
    times = set()
    for boardings in range(8):
        cell = Cell("gantry", "belt", 500)
        for _ in range(boardings):
            cell.group.set_dyn_coord_transform(pcs=1, carrier="belt").wait()
            cell.line((20, 60, 40))
            cell.engine.run(0.015)
            cell.group.disable()
            cell.engine.run(0.2)
            cell.group.enable().wait()
            cell.group.move_linear_absolute(x=0, y=0, z=0).wait()
            cell.engine.run(0.1)
        cell.group.set_dyn_coord_transform(pcs=1, carrier="belt").wait()
        start = cell.engine.now
        blend: dict[str, Any] = {"buffer_mode": "blending_next", "transition_mode": "corner_distance"}
        times.add(round(cell.line((15, 50, 32), **blend, transition_parameter=5).wait().time_s - start, 6))
    assert len(times) == 1, times


@pytest.mark.parametrize("wait", [0.005, 0.015, 0.03])
@pytest.mark.parametrize("speed", [300, 600])
def test_a_move_to_the_world_turns_a_tool_back(speed: float, wait: float) -> None:
    """GR-40, GR-42: halfway onto a belt it is not taken aboard first."""
    times = []
    for board in (True, False):
        cell = Cell(GENTLE, "belt", speed, board)
        start = cell.engine.now
        first = cell.line((-20, 40, 30))
        cell.engine.run(wait)
        move = cell.group.move_linear_absolute(x=10, y=10, z=10).wait()
        assert first.aborted
        run = cell.judge(move.cycle)
        assert np.max(run["gx"]["set_position"]) <= 16
        times.append(move.time_s - start)
    assert times[0] <= 1.02 * times[1]


@pytest.mark.parametrize("wait", [0.005, 0.01, 0.02])
@pytest.mark.parametrize("speed", [200, 290, 310, 400])
def test_an_interrupt_on_a_belt_as_fast_as_the_path_may_be(speed: float, wait: float) -> None:
    """GR-42: boarding is planned with what the axes can, and continued so."""
    times = []
    for board in (True, False):
        slow_path = ROBOTS["gantry"]._replace(path="{velocity: 300, acceleration: 60000, jerk: 3000000}")
        cell = Cell(slow_path, "belt", speed, board)
        start = cell.engine.now
        move = cell.line((0, 13, 40))
        cell.engine.run(wait)
        cell.group.interrupt()
        cell.engine.run(0.05)
        cell.group.continue_path()
        times.append(move.wait().time_s - start)
        if board:
            cell.judge(move.cycle)
    assert times[0] <= 1.02 * times[1]


@pytest.mark.parametrize("speed", [60, 90, 120])
@pytest.mark.parametrize("board", [False, True])
def test_moves_on_a_table_take_no_longer_given_at_once_than_one_by_one(board: bool, speed: float) -> None:
    """GR-22, GR-42: the table moves the axes of a tool that stands on it; the look-ahead behind a stop knows that."""
    times = []
    for at_once in (True, False):
        cell = Cell(GENTLE._replace(limits=(1500, 15000, 150000)), "table", speed, board)
        cell.line((0, 0, 40)).wait()
        start = cell.engine.now
        for by in ((30, 0, 40), (30, 30, 40), (0, 30, 40)):
            move = cell.line(by, buffer_mode="buffered")
            if not at_once:
                move.wait()
        times.append(move.wait().time_s - start)
        cell.judge(move.cycle)
    assert times[0] <= 1.02 * times[1]


@pytest.mark.parametrize("behind", [False, True])
def test_a_refused_move_leaves_the_tool_at_rest(behind: bool) -> None:
    """GR-40, GR-42: towards a belt that comes from beyond the range of an axis; nothing rides on behind the error."""
    ends = "{name: gx, unit: mm, limits: {lower: -3000, upper: 300, "
    text = machine(ROBOTS["gantry"]).replace("{name: gx, unit: mm, limits: {", ends)
    with takt.Engine(text) as engine:
        group = engine.group("robot")
        for axis in engine.axes.values():
            axis.power().wait()
        group.enable().wait()
        engine.axis("drive").move_velocity(velocity=500, direction="negative").wait(until="reached")
        group.set_dyn_coord_transform(pcs=1, carrier="belt").wait()
        move = group.move_linear_absolute(x=392, y=0, z=0, coordinate_system="pcs", pcs=1)
        if behind:
            group.move_linear_absolute(x=300, y=9, z=0, coordinate_system="pcs", pcs=1, buffer_mode="buffered")
        engine.run(2.0)
        if move.error:
            assert group.state is takt.GroupState.GROUP_STANDBY
            assert engine.axis("gx").set_velocity == 0


def test_another_object_is_reached_while_the_tool_boards() -> None:
    """GR-40, GR-42: an aborting move to another place on the belt keeps what boarding takes."""
    for wait in (0.005, 0.015, 0.03):
        cell = Cell("gantry", "belt", 500)
        cell.group.set_dyn_coord_transform(pcs=2, carrier="belt", x=40).wait()
        cell.line((60, 60, 0))
        cell.engine.run(wait)
        move = cell.group.move_linear_absolute(x=-80, y=10, coordinate_system="pcs", pcs=2).wait()
        cell.judge(move.cycle)


@pytest.mark.parametrize("wait", [0.001, 0.005, 0.015, 0.03, 0.06])
@pytest.mark.parametrize("event", ["emergency stop", "power off", "axis off", "disable"])
@pytest.mark.parametrize("changes", [False, True])
def test_nothing_goes_on_behind_what_switches_off(changes: bool, event: str, wait: float) -> None:
    """GR-42, AX-100: at any instant of boarding, also when the belt has ended it; afterwards the tool boards again."""
    cell = Cell("gantry", "belt", 200)
    first = cell.line((30, 40, 0))
    if changes:
        cell.engine.run(0.003)
        cell.carrier.move_velocity(velocity=300)
    cell.engine.run(wait)
    if event == "emergency stop":
        cell.engine.emergency_stop(hold=True)
    elif event == "power off":
        cell.group.power(enable=False)
    elif event == "axis off":
        cell.engine.axis("gx").power(enable=False)
    else:
        cell.group.disable()
    cell.engine.run(1.0)
    assert first.final
    assert not first.done
    assert all(cell.engine.axis("g" + name).set_velocity == 0 for name in cell.robot.axes)
    if event == "emergency stop":
        assert cell.line((0, 0, 0)).wait_final().error
        cell.engine.release_emergency_stop().wait()
    cell.engine.run(0.1)
    cell.group.reset()
    cell.engine.run(0.1)
    for axis in cell.engine.axes.values():
        axis.reset()
        axis.power()
    cell.engine.run(0.5)
    cell.group.enable()
    cell.engine.run(0.1)
    cell.group.move_linear_absolute(**cell.robot.begin).wait(timeout=3)
    cell.carrier.move_velocity(velocity=150).wait(until="reached")
    cell.engine.run(3.1)  # by then the belt is steady
    cell.group.set_dyn_coord_transform(pcs=1, carrier="belt").wait()
    assert cell.line((30, 40, 0)).wait(timeout=3).done


def test_boarding_is_reproduced(tmp_path: Path) -> None:
    """EN-07, GR-42: every cycle, bit for bit, and the states are in the log."""
    url, log = new_url(), tmp_path / "run.lcm"
    arguments = ("--log", str(log))
    with running(tmp_path, url, *arguments, machine=machine(ROBOTS["gantry"])), takt.connect(url) as session:
        group = session.group("robot")
        for axis in session.axes.values():
            axis.power().wait()
        group.enable().wait()
        session.axis("drive").move_velocity(velocity=150).wait(until="reached")
        group.set_dyn_coord_transform(pcs=1, carrier="belt").wait()
        group.move_linear_absolute(x=0, y=50, z=0, coordinate_system="pcs", pcs=1)
        group.move_linear_absolute(x=40, y=0, z=0, coordinate_system="pcs", pcs=1, buffer_mode="buffered").wait()
        group.stop().wait()
    result = takt.replay(log)
    assert result.same, result.sentence
    assert {2, 3} <= set(np.unique(takt.read_log(log)["robot"]["track_state"]))
