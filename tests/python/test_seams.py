"""Every command of every component in every situation that stops something (docs/stopping.md): the outcome is as that
page says, set points keep their limits, nothing moves onto a switch, nothing resumes."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import takt
import yaml
from seams import MACHINE, TARGETS, VERBS, Given, commands
from takt import checks

ROUNDING = 1e-9
WATCHED = 40  # cycles after each command: enough to see that a motion has begun


def powered(machine: str = MACHINE) -> takt.Engine:
    s = takt.Engine(machine)
    asked = [s.axis(name).power() for name in ("left", "right", "web", "infeed", "valve")]
    asked += [s.group("portal").power(), s.group("portal").enable()]
    for feedback in asked:
        feedback.wait()
    s.command("cutter", "control", {"regulator_on": True})
    s.command("picker", "control", {"regulator_on": True})
    s.command("shuttle", "enable")
    s.run(0.2)
    assert all(axis.loop_closed for axis in s.axes.values())
    return s


def beside(servos: dict[str, Any], **axes: Any) -> str:
    """The machine with other servos and axes."""
    machine = yaml.safe_load(MACHINE)
    machine["simulation"] = {"servos": [{"axis": name, **copy.deepcopy(servo)} for name, servo in servos.items()]}
    for axis in machine["axes"]:
        axis |= axes.get(axis["name"], {})
    return str(yaml.safe_dump(machine))


def out_of_limits(s: takt.Engine, recording: takt.Recording) -> list[str]:
    """Set points beyond the limits of their axis or mover; the first cycle after a loop was closed or opened is no
    step."""
    wrong = []
    for name, axis in s.axes.items():
        limits = axis.parameters["limits"]
        r = recording[name]
        closed = np.asarray(r["loop_closed"], bool)
        acceleration = np.asarray(r["set_acceleration"])
        strongest = max(limits["acceleration"], limits.get("deceleration") or 0)
        jerk = np.abs(np.diff(acceleration)) / s.period
        within = {
            "velocity": np.abs(r["set_velocity"]).max() <= limits["velocity"] * (1 + ROUNDING),
            "acceleration": np.abs(acceleration).max() <= strongest * (1 + ROUNDING),
            "jerk": (jerk[closed[1:] & closed[:-1]] <= limits["jerk"] * (1 + 1e-6)).all(),
        }
        wrong += [f"{name}: {limit}" for limit, kept in within.items() if not kept]
    verdicts = [checks.within_limits(recording, name) for name in s.movers]
    return wrong + [verdict.sentence for verdict in verdicts if not verdict.passed]


@dataclass(frozen=True)
class Situation:
    """How a machine gets into it, what must not be in a recording of it, and whether it is still as it was."""

    enter: Callable[[], takt.Engine]
    wrong: Callable[[takt.Engine, takt.Recording, Given, takt.Feedback], list[str]]
    same: Callable[[takt.Engine], bool]
    sense: int = 1
    ended_by: tuple[str, ...] = ()  # commands that may end it, later


def moved(recording: takt.Recording, *names: str) -> list[str]:
    return [name for name in names if np.abs(recording[name]["set_velocity"]).max() > 0]


# Limit switches: all axes but those that lead others stand on theirs.
MASTERS = ("infeed", "web")


def at_switches(sense: int) -> takt.Engine:
    switch = {"limit_positive": {"from": -0.5}} if sense > 0 else {"limit_negative": {"to": 0.5}}
    standing = [axis["name"] for axis in yaml.safe_load(MACHINE)["axes"] if axis["name"] not in MASTERS]
    s = powered(beside({name: {"switches": switch} for name in standing}))
    for name in MASTERS:
        s.axis(name).move_velocity(velocity=50, direction="positive" if sense > 0 else "negative")
    s.run(0.1)
    return s


def onto_switches(sense: int) -> Callable[..., list[str]]:
    def wrong(s: takt.Engine, recording: takt.Recording, given: Given, feedback: takt.Feedback) -> list[str]:
        del given, feedback
        names = [name for name in s.axes if name not in MASTERS]
        on = "limit_positive" if sense > 0 else "limit_negative"
        velocity = {name: sense * np.asarray(recording[name]["set_velocity"]) for name in names}
        return [f"{n} moves onto its switch" for n in names if (velocity[n][recording[n][on]] > ROUNDING).any()]

    return wrong


def untouched(s: takt.Engine) -> bool:
    """Nothing failed, nothing moves but masters."""
    still = [axis for name, axis in s.axes.items() if name not in MASTERS]
    return all(axis.loop_closed and axis.error == 0 and not axis.set_velocity for axis in still)


# Power off.
def off() -> takt.Engine:
    s = powered()
    s.axis("web").move_velocity(velocity=50)
    s.axis("left").move_velocity(velocity=50)
    s.run(0.2)
    s.command("machine", "stop_all", {"open_loops": True})
    s.run(0.3)
    assert all_open(s)
    return s


def all_open(s: takt.Engine) -> bool:
    off = [a.state is takt.PlcState.DISABLED and not a.error and not a.active_command for a in s.axes.values()]
    return all(off) and not any(a.loop_closed for a in s.axes.values())


def powered_unasked(s: takt.Engine, recording: takt.Recording, given: Given, feedback: takt.Feedback) -> list[str]:
    del feedback
    _, verb, arguments = given
    wrong = [f"{name} moves" for name in moved(recording, *s.axes)]
    if verb not in ("power", "enable") and "regulator_on" not in arguments:
        wrong += [f"{name} is powered" for name in s.axes if any(recording[name]["loop_closed"])]
    return wrong


# A fault that leaves the loops closed.
def failed() -> takt.Engine:
    s = powered()
    s.axis("web").move_velocity(velocity=50)
    s.axis("left").move_velocity(velocity=50)
    s.run(0.2)
    s.command("machine", "fail_all_axes")
    s.run(0.3)
    assert all_failed(s)
    return s


def all_failed(s: takt.Engine) -> bool:
    return all(a.state is takt.PlcState.ERROR_STOP and a.error and not a.set_velocity for a in s.axes.values())


def leaves_error(s: takt.Engine, recording: takt.Recording, given: Given, feedback: takt.Feedback) -> list[str]:
    target, verb, _ = given
    wrong = [f"{name} moves" for name in moved(recording, *s.axes)]
    if verb != "reset":
        stopped = takt.PlcState.ERROR_STOP
        wrong += [f"{name} left ErrorStop" for name, a in s.axes.items() if a.state is not stopped]
    asks = target in s.axes and verb in ("power", "move_absolute", "move_velocity", "jog", "gear_in", "home", "inch")
    if asks and s.axis(target).parameters.get("follows") is None and feedback.error_id not in (5, 11, 1000):
        wrong.append(f"refused with {feedback.error_id}")
    return wrong


# A follower that lost its loop: what leads it does not move without it.
def follower_failed() -> takt.Engine:
    s = powered(beside({"right": {"mechanics": {"upper_stop": 5}}}, right={"supervision": {"deviation_moving": 1}}))
    s.axis("left").move_velocity(velocity=50)
    s.run(0.5)
    s.axis("left").reset().wait()
    assert gantry_failed(s)
    return s


def gantry_failed(s: takt.Engine) -> bool:
    left, right = s.axis("left"), s.axis("right")
    return left.loop_closed and not left.error and not left.set_velocity and right.error != 0 and not right.loop_closed


def moves_without_follower(
    s: takt.Engine, recording: takt.Recording, given: Given, feedback: takt.Feedback
) -> list[str]:
    del s, given, feedback
    return [f"{name} moves" for name in moved(recording, "left", "right")]


# Stops that are held.
HELD = ("web", "infeed", "left", "valve")


def stopped() -> takt.Engine:
    s = powered()
    for name in HELD:
        s.axis(name).move_velocity(velocity=50)
    s.run(0.2)
    for name in HELD:
        s.axis(name).stop(hold=True).wait()
    assert all_stopping(s)
    return s


def stopped_and_switched() -> takt.Engine:
    """Two hold, one has let go; the axes were switched off, stopped by a fault and switched on again."""
    s = stopped()
    second = [s.axis(name).stop(hold=True) for name in HELD]
    s.step(2)
    for feedback in second:
        feedback.release()
    s.command("machine", "stop_all", {"open_loops": True})
    s.run(0.3)
    assert all_open(s)
    for name in (*HELD, "right"):
        s.axis(name).power()
    s.run(0.3)
    s.command("machine", "fail_all_axes")
    for name in s.axes:
        s.axis(name).reset()
    s.run(0.1)
    assert all_stopping(s)
    return s


def all_stopping(s: takt.Engine) -> bool:
    return all(s.axis(name).state is takt.PlcState.STOPPING and not s.axis(name).set_velocity for name in HELD)


def leaves_stopping(s: takt.Engine, recording: takt.Recording, given: Given, feedback: takt.Feedback) -> list[str]:
    del feedback
    wrong = [f"{name} moves" for name in moved(recording, *HELD, "right")]
    if given[1] != "power":
        held = takt.PlcState.STOPPING
        wrong += [f"{name} left Stopping" for name in HELD if s.axis(name).state is not held and given[1] != "stop"]
    return wrong


# The emergency stop, held.
def emergency() -> takt.Engine:
    s = powered()
    s.axis("web").move_velocity(velocity=50)
    s.run(0.2)
    s.command("machine", "emergency_stop", {"hold": True}).wait()
    s.run(0.5)
    assert all_open(s)
    return s


def moves_or_powered(s: takt.Engine, recording: takt.Recording, given: Given, feedback: takt.Feedback) -> list[str]:
    del given, feedback
    closed = [f"{name} is powered" for name in s.axes if any(recording[name]["loop_closed"])]
    return closed + [f"{name} moves" for name in moved(recording, *s.axes)]


SITUATIONS = {
    "emergency stop held": Situation(emergency, moves_or_powered, all_open),
    "positive limit switches on": Situation(lambda: at_switches(1), onto_switches(1), untouched),
    "negative limit switches on": Situation(lambda: at_switches(-1), onto_switches(-1), untouched, -1),
    "power off": Situation(off, powered_unasked, all_open, ended_by=("power", "enable", "control")),
    "fault": Situation(failed, leaves_error, all_failed),
    "fault of a follower": Situation(follower_failed, moves_without_follower, gantry_failed),
    "stop held": Situation(stopped, leaves_stopping, all_stopping),
    "stop held, power off and on": Situation(stopped_and_switched, leaves_stopping, all_stopping),
}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", SITUATIONS)
def test_every_command_in_every_situation(name: str) -> None:
    """AX-83, AX-100, AX-101: the rows of the page's first table, with all components and commands as columns."""
    situation = SITUATIONS[name]
    wrong: list[str] = []
    s = situation.enter()
    for given in commands(situation.sense):
        target, verb, arguments = given
        with s.record() as recorder:
            feedback = s.command(target, verb, arguments)
            s.step(WATCHED)
        seen = situation.wrong(s, recorder.recording, given, feedback) + out_of_limits(s, recorder.recording)
        wrong += [f"{target}.{verb} {arguments} -> {feedback.state.name} {feedback.error_id}: {one}" for one in seen]
        if not feedback.final:
            feedback.release()
        s.step(2)
        if seen or verb in situation.ended_by or not situation.same(s):
            s.close()
            s = situation.enter()
    s.close()
    assert not wrong, "\n".join(wrong)


LEASE = 0.05  # s


@pytest.mark.filterwarnings("ignore")
def test_levels_of_a_client_that_is_gone_end() -> None:
    """EN-05: the client is gone as a column: what it held is let go of when its lease is over, and nothing else."""
    levels = {(verb["target_kind"], verb["name"]) for verb in VERBS if verb["level_sensitive"]}
    kinds = {target: kind for kind, targets in TARGETS.items() for target in targets}
    wrong: list[str] = []
    tried = set()
    for n, (target, verb, arguments) in enumerate(commands()):
        if (kinds[target], verb) not in levels:
            continue
        hold = {"hold": True} if verb == "stop" else {}
        tried.add((kinds[target], verb))
        with powered() as s:
            moves = s.axis("web").move_velocity(velocity=50) if target != "web" else None
            with s.record() as recorder:
                error = s._core.resubmit(target, verb, json.dumps(arguments | hold), 10**9 + n, LEASE)[1]
                s.run(LEASE)
                held = {name: a.state for name, a in s.axes.items()}
                s.run(1)
            what = f"{target}.{verb} {arguments | hold}"
            wrong += [f"{what}: {one}" for one in out_of_limits(s, recorder.recording)]
            if error:
                wrong.append(f"{what}: refused with {error}")
            on = [name for name, a in s.axes.items() if a.set_velocity and not (moves and name == "web")]
            wrong += [f"{what}: {name} moves on" for name in on]
            stays = (takt.PlcState.STOPPING, takt.PlcState.ERROR_STOP, takt.PlcState.DISABLED)
            wrong += [f"{what}: {name} is {a.state.value}, was {held[name].value}"
                      for name, a in s.axes.items() if a.state in stays]  # fmt: skip
            wrong += [f"{what}: {g.name} is {g.state.value}" for g in s.groups.values() if "Stopping" in g.state.value]
            if moves and not moves.active:
                wrong.append(f"{what}: ended what nobody held")
    assert not wrong, "\n".join(wrong)
    assert tried == {one for one in levels if one[0] in ("axis", "flex_cam", "group", "pick_place", "mover")}


@pytest.mark.filterwarnings("ignore")
def test_no_command_is_taken_while_the_engine_stops() -> None:
    """EN-08: all are refused with 3015, and every axis ends Disabled."""
    with powered() as s:
        for name in HELD:
            s.axis(name).move_velocity(velocity=50)
        s.run(0.3)
        waiting = commands()
        asked: list[takt.Feedback] = []

        def scan() -> None:
            if s.axis("web").state is takt.PlcState.STOPPING:
                asked.extend(s.command(*waiting.pop()) for _ in range(min(20, len(waiting))))

        s.program(scan)
        with s.record() as recorder:
            s.shut_down()
            s.step(5)
        assert len(asked) > 100
        assert {feedback.error_id for feedback in asked} <= {3015, 5}
        assert all_open(s)
        assert not out_of_limits(s, recorder.recording)


ONE = """
name: full
axes:
  - {name: web, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
  - {name: infeed, limits: {velocity: 400, acceleration: 4000, jerk: 80000}}
cams:
  - {name: hill, cyclic: true,
     points: [{x: 0, y: 0, v: 0, a: 0}, {x: 60, y: 20, v: 0, a: 0}, {x: 120, y: 0, v: 0, a: 0}]}
"""


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("buffered", [False, True])
def test_a_full_buffer_loses_nothing(buffered: bool) -> None:
    """AX-12: with eight commands waiting every further one is carried out, or refused and nothing is lost by it."""
    tried = 0
    for target, verb, arguments in commands():
        if target != "web":
            continue
        with takt.Engine(ONE) as s:
            web, infeed = s.axis("web"), s.axis("infeed")
            web.power()
            infeed.power().wait()
            infeed.move_velocity(velocity=20)
            moves = [web.move_relative(distance=1, velocity=100)]
            moves += [web.move_relative(distance=1, buffer_mode="buffered") for _ in range(8)]
            s.step(3)
            assert web.buffered_commands == 8
            mode = {"buffer_mode": "buffered"} if buffered else {}
            with s.record() as recorder:
                feedback = s.command(target, verb, arguments | mode)
                s.step(2)
                aborted = [move for move in moves if move.aborted]
                if feedback.error:
                    assert not aborted, verb
                    if buffered and feedback.error_id != 5:
                        assert feedback.error_id in (3003, 6, 9, 10), f"{verb}: {feedback.error_id}"
                s.run(0.8)
            assert not out_of_limits(s, recorder.recording), verb
            if not aborted and not any(move.aborted for move in moves):
                assert all(move.done for move in moves), f"{verb}: {[move.state.name for move in moves]}"
            if verb in ("halt", "stop"):
                assert not feedback.error or buffered
            tried += 1
    assert tried > 40
