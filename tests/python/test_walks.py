"""Random walks of commands, stops and faults over whole machines, with what must hold in every cycle."""

from __future__ import annotations

import copy
import os
import random
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
import yaml
from seams import MACHINE, NAMES, SIGNED, Given, commands

SEEDS = range(1000 if os.environ.get("TAKT_LONG") else 4)
EXAMPLES = Path(__file__).parents[2] / "python" / "examples"
STRAIGHTENING = 1.3  # of the limits of a follower, while it goes along with its master besides
EMERGENCY, RELEASE = ("machine", "emergency_stop", {"hold": True}), ("machine", "release_emergency_stop", {})


def with_switches() -> str:
    """The machine of all kinds, with a gantry in a group, limit switches within reach and a skew that is watched."""
    machine = yaml.safe_load(MACHINE)
    x = next(axis for axis in machine["axes"] if axis["name"] == "x")
    machine["axes"].append(copy.deepcopy(x) | {"name": "x2", "follows": {"axis": "x"}})
    switches = {"limit_positive": {"from": 60}, "limit_negative": {"to": -60}, "reference": {"from": 20, "to": 25}}
    machine["simulation"] = {
        "servos": [{"axis": axis["name"], "switches": copy.deepcopy(switches)} for axis in machine["axes"]]
    }
    right = next(axis for axis in machine["axes"] if axis["name"] == "right")
    right["follows"] |= {"largest_skew": 2.0, "square": True}
    return str(yaml.safe_dump(machine))


def example(name: str) -> str:
    return (EXAMPLES / name / "machine.yaml").read_text(encoding="utf-8")


MACHINES = {"all kinds": with_switches(), **{name: example(name) for name in ("six_axes", "positioning_module")}}


def targets_of(s: takt.Engine) -> dict[str, tuple[str, ...]]:
    """The components by their kinds; poses and belts take objects, which is another matter."""
    found: dict[str, tuple[str, ...]] = {}
    for kind, group in (
        ("axis", s.axes),
        ("flex_cam", s.flex_cams),
        ("group", s.groups),
        ("pick_place", s.pick_places),
        ("mover", s.movers),
        ("part", s.parts),
    ):
        found[kind] = tuple(group)
    return found


def names_of(s: takt.Engine) -> Mapping[str, str]:
    names = {key: value for key, value in NAMES.items() if value in s.components}
    axes = list(s.axes)
    cams = [cam["name"] for cam in s.machine.get("cams", [])] or ["none"]
    return {"master": axes[0], "axis": axes[-1], "cam": cams[0], "profile": cams[0]} | names | {"cam": cams[0]}


def varied(rnd: random.Random, given: Given) -> Given:
    target, verb, arguments = given
    out: dict[str, Any] = dict(arguments)
    for key, value in arguments.items():
        if key in SIGNED and isinstance(value, float):
            out[key] = rnd.choice([0.3, 5.0, 40.0, 90.0]) * rnd.uniform(-1, 1)
    return target, verb, out


Held = tuple[str, int, int]  # axis, cycles between which one of its stops held it


def walk(s: takt.Engine, rnd: random.Random, steps: int) -> tuple[list[tuple[int, int]], list[Held]]:
    """Gives commands at random; the cycles between which an emergency stop, and a stop of an axis, was held."""
    known = commands(1, targets_of(s), names_of(s)) + commands(-1, targets_of(s), names_of(s))
    power = [given for given in known if given[1] in ("power", "enable") or "regulator_on" in given[2]]
    reset = [given for given in known if given[1] == "reset"]
    held: list[tuple[int, int]] = []
    stopped: list[Held] = []
    stops: list[tuple[str, takt.Feedback, int]] = []
    since: int | None = None
    for given in power:
        s.command(*given)
    s.run(0.15)
    for _ in range(steps):
        chance = rnd.random()
        if since is not None and chance < 0.1:
            held.append((since, s.cycle))
            since = None
            s.command(*RELEASE)
        elif since is None and chance < 0.02:
            s.command(*EMERGENCY)
            since = s.cycle + 2
        elif chance < 0.03:
            s.command("machine", "stop_all", {"open_loops": rnd.random() < 0.5})
        elif chance < 0.04:
            s.command("machine", "fail_all_axes")
        elif chance < 0.07:
            name = rnd.choice(list(s.axes))
            stop = s.axis(name).stop(hold=True, deceleration=rnd.choice([None, 300.0]))
            s.step(rnd.choice([1, 5, 60]))
            if stop.done:
                stops.append((name, stop, s.cycle))
            else:
                stop.release()
        elif chance < 0.09 and stops:
            name, stop, begin = stops.pop(rnd.randrange(len(stops)))
            stopped.append((name, begin, s.cycle))
            stop.release()
        elif chance < 0.16:
            for group in (reset, power):
                for one in group:
                    s.command(*one)
                s.step(rnd.choice([1, 5, 60]))
        else:
            feedback = s.command(*varied(rnd, rnd.choice(known)))
            if rnd.random() < 0.4:
                s.step(rnd.randrange(40))
                if not feedback.final:
                    feedback.release()
        s.step(rnd.choice([0, 1, 1, 3, 10, 60]))
    if since is not None:
        held.append((since, s.cycle))
    return held, stopped + [(name, begin, s.cycle) for name, _, begin in stops]


def way_to_rest(velocity: float, acceleration: float, limits: Mapping[str, Any]) -> float:
    """A bound of how far an axis goes on by its limits, from a speed and an acceleration in the sense of it."""
    deceleration = limits.get("deceleration") or limits["acceleration"]
    jerk = limits["jerk"] or np.inf
    faster = max(acceleration, 0.0)
    fastest = velocity + faster**2 / (2 * jerk)
    return float(fastest * (faster + deceleration) / jerk + fastest**2 / (2 * deceleration))


def wrong_of(s: takt.Engine, recording: takt.Recording, held: list[tuple[int, int]], stopped: list[Held]) -> list[str]:
    """What of the invariants a recording breaks."""
    wrong = []
    for name, begin, end in stopped:
        cycle, closed = np.asarray(recording[name]["cycle"]), np.asarray(recording[name]["loop_closed"], bool)
        during = (cycle > begin) & (cycle < end) & closed
        if np.abs(np.asarray(recording[name]["set_velocity"])[during]).max(initial=0) > 0:
            wrong.append(f"{name}: moves while a stop holds it, cycles {begin} to {end}")
    homing = list(takt.PlcState).index(takt.PlcState.HOMING)
    slaves = {module["slave"] for module in s.machine["flex_cams"]}  # brake with the ramp of their module (CAM-85)
    for name, axis in s.axes.items():
        r = recording[name]
        cycle = np.asarray(r["cycle"])
        velocity, acceleration = np.asarray(r["set_velocity"]), np.asarray(r["set_acceleration"])
        position = np.asarray(r["set_position"])
        closed = np.asarray(r["loop_closed"], bool)
        for begin, end in held:
            during = (cycle >= begin) & (cycle < end)
            if closed[during].any() or np.abs(velocity[during]).max(initial=0) > 0:
                wrong.append(f"{name}: powered or moved while the emergency stop was held, cycles {begin} to {end}")
        searches = np.asarray(r["state"]) == homing
        follows = axis.parameters.get("follows")
        if follows:
            searches |= np.asarray(recording[follows["axis"]]["state"]) == homing
        for sense, switch in ((1, "limit_positive"), (-1, "limit_negative")):
            on = np.asarray(r[switch], bool)
            both = on[1:] & on[:-1] & closed[1:] & ~searches[1:] & ~searches[:-1]
            faster = sense * velocity[1:] > np.maximum(0, sense * velocity[:-1]) + 1e-9
            # An axis that runs onto its switch while it speeds up ends its acceleration within its jerk.
            eases = (sense * velocity[:-1] > 0) & (sense * acceleration[1:] < sense * acceleration[:-1])
            towards = faster & ~eases
            if (both & towards).any():
                wrong.append(f"{name}: moves onto its switch in cycle {cycle[1:][both & towards][0]}")
            if name in slaves:
                continue
            edges = on[1:] & ~on[:-1] & closed[1:] & ~searches[1:] & (sense * velocity[1:] > 0)
            for i in np.flatnonzero(edges) + 1:
                away = np.flatnonzero(~on[i:] | ~closed[i:] | (sense * velocity[i:] <= 0))
                end = i + (away[0] if away.size else on.size - i) - 1
                way = sense * (position[end] - position[i])
                most = way_to_rest(sense * velocity[i], sense * acceleration[i], axis.parameters["limits"])
                if way > most + 3 * s.period * abs(velocity[i]) + 1e-9:
                    wrong.append(f"{name}: {way:.3f} onto its switch from cycle {cycle[i]}, alone {most:.3f}")
        limits = axis.parameters["limits"]
        share = STRAIGHTENING if follows else 1 + 1e-6
        strongest = max(limits["acceleration"], limits.get("deceleration") or 0)
        jerk = np.abs(np.diff(acceleration)) / s.period
        still_closed = closed[1:] & closed[:-1]
        if np.abs(velocity).max() > limits["velocity"] * share:
            wrong.append(f"{name}: velocity")
        if np.abs(acceleration).max() > strongest * share:
            wrong.append(f"{name}: acceleration")
        if limits["jerk"] and (jerk[still_closed] > limits["jerk"] * share).any():
            at = cycle[1:][still_closed][jerk[still_closed] > limits["jerk"] * share][0]
            wrong.append(f"{name}: jerk in cycle {at}")
        if follows and follows.get("largest_skew"):
            leader = recording[follows["axis"]]
            together = closed & (np.asarray(r["error"]) == 0) & (np.abs(leader["set_velocity"]) > 0)
            apart = np.abs(r["skew"])[together].max(initial=0)
            if apart > follows["largest_skew"] + follows["in_step"]:
                wrong.append(f"{name}: skew {apart}")
    for name in s.movers:
        r = recording[name]
        cycle = np.asarray(r["cycle"])
        for begin, end in held:
            during = (cycle >= begin + 400) & (cycle < end)  # after its ramp
            if during.any() and np.ptp(np.asarray(r["x"])[during]) > 0:
                wrong.append(f"{name}: moves while the emergency stop is held")
    return wrong


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", MACHINES)
def test_walk(name: str) -> None:
    """AX-13, AX-37, AX-83, AX-100, AX-101, AX-112: in every cycle: while an emergency stop is held no axis is powered
    or moves, while a stop holds an axis that one does not move; none moves onto a switch that is on, or goes further
    onto one than by its own limits; set points keep their limits."""
    failures = []
    for seed in SEEDS:
        rnd = random.Random(seed)
        with takt.Engine(MACHINES[name]) as s:
            with s.record() as recorder:
                held, stopped = walk(s, rnd, 150)
            wrong = wrong_of(s, recorder.recording, held, stopped)
        failures += [f"seed {seed}: {one}" for one in wrong]
    assert not failures, "\n".join(failures)
