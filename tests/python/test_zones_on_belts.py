"""Zones and what carries a tool into them (GR-47): in no cycle two tools are inside the same box, whatever the belt
does, whatever is commanded. The checker knows nothing but where the tools are and where the boxes are."""

from __future__ import annotations

import os
import random
from typing import Any

import numpy as np
import pytest
import takt
from test_shared_belts import sharing
from test_zones import LIMITS, gantry, machine, on

LONG = bool(os.environ.get("TAKT_LONG"))
PCS = "pcs"
DRIVE = f"  - {{name: drive, unit: mm, {LIMITS}}}\n"


def with_belts(text: str, **angles: float) -> str:
    """The machine with belts along its X axis, turned by these angles, all of one drive."""
    lines = "".join(f"  - {{name: {name}, axis: drive, origin: {{c: {c}}}}}\n" for name, c in angles.items())
    return f"{text}belts:\n{lines}"


def boxes(s: takt.Session) -> list[tuple[np.ndarray, np.ndarray, set[str]]]:
    return [
        (
            np.array([zone["lower"][k] for k in "xyz"]),
            np.array([zone["upper"][k] for k in "xyz"]),
            set(zone.get("groups") or s.groups),
        )
        for zone in s.machine["zones"]
    ]


def both_inside(s: takt.Session, recording: takt.Recording) -> list[str]:
    """Where two tools were inside a box at once, and where two groups had the same zone."""
    wrong = []
    tools = {}
    for name, group in s.groups.items():
        base = group.parameters.get("base") or {}
        tools[name] = np.stack([recording[name][k] + (base.get(k) or 0.0) for k in "xyz"], axis=1)
    names = list(tools)
    for k, (lower, upper, of) in enumerate(boxes(s)):
        inside = {n: ((tools[n] > lower) & (tools[n] < upper)).all(axis=1) for n in names if n in of}
        had = {n: (recording[n]["zones"].astype(np.int64) >> k & 1).astype(bool) for n in inside}
        for i, one in enumerate(inside):
            for other in list(inside)[i + 1 :]:
                for what, which in (("inside", inside), ("has it", had)):
                    both = which[one] & which[other]
                    if both.any():
                        at = int(np.argmax(both))
                        wrong.append(f"zone {k}: {one} and {other} {what} in cycle {at}, {int(both.sum())} in all")
    return wrong


MIDDLE = "  - {name: middle, lower: {x: 300, y: -50, z: -50}, upper: {x: 400, y: 50, z: 50}}\n"


def belt_machine() -> str:
    return with_belts(machine(MIDDLE, gantry("left"), gantry("right"), more=DRIVE), belt=0)


def rides(s: takt.Session, group: takt.Group, speed: float) -> takt.Axis:
    """The tool stands on the belt, which runs."""
    drive = s.axis("drive")
    drive.power().wait()
    drive.move_velocity(velocity=abs(speed), direction="positive" if speed > 0 else "negative").wait(until="reached")
    group.track_conveyor_belt(belt="belt", x=min(group.x, 0.0)).wait(until="reached")
    s.wait(lambda: group.in_sync)
    return drive


def test_it_has_the_zone_that_it_is_carried_into() -> None:
    """GR-47: it takes the zone half a second before, the other one waits, and goes on when the tool has left."""
    with takt.Engine(belt_machine()) as s:
        left, right = on(s)
        right.move_linear_absolute(x=350, z=100).wait()
        with s.record() as recorder:
            rides(s, left, 200)
            s.wait(lambda: left.zone_names == ("middle",))
            assert left.x == pytest.approx(300 - 5 - 0.5 * 200, abs=1)
            into = right.move_linear_absolute(z=0)
            s.run(0.05)
            assert right.waiting == "at zone 'middle' for group 'left'"
            into.wait(10)
            assert left.x > 400
            assert left.state is takt.GroupState.GROUP_MOVING
        assert not both_inside(s, recorder.recording)


@pytest.mark.parametrize("speed", [50, 400, 700])
def test_it_is_stopped_outside_a_zone_of_another_group(speed: float) -> None:
    """GR-47: outside the box, within its margin at most, at each speed of the belt."""
    with takt.Engine(belt_machine()) as s:
        left, right = on(s)
        right.move_linear_absolute(x=350).wait()
        left.move_linear_absolute(x=-600).wait()
        rides(s, left, speed)
        s.wait(lambda: left.state is takt.GroupState.GROUP_ERROR_STOP)
        assert left.error == 3130
        s.run(0.3)
        assert 280 < left.x <= 300
        assert left.zone_names == ()
        right.move_linear_absolute(x=500).wait()
        left.reset().wait()
        assert left.move_linear_absolute(x=350).wait().done


def test_it_is_told_where_a_belt_that_turns_round_takes_it() -> None:
    """GR-47: also back into a zone that it has left."""
    with takt.Engine(belt_machine()) as s:
        left, right = on(s)
        left.move_linear_absolute(x=380).wait()
        drive = rides(s, left, 200)
        s.wait(lambda: left.x > 450)
        right.move_linear_absolute(x=350).wait()
        drive.move_velocity(velocity=300, direction="negative")
        s.wait(lambda: left.state is takt.GroupState.GROUP_ERROR_STOP)
        s.run(0.3)
        assert left.x >= 400


def test_one_that_waits_on_a_belt_gets_off_it() -> None:
    """GR-47: a move on the object has to wait, and the belt would carry the tool in: it waits where it got off."""
    with takt.Engine(belt_machine()) as s:
        left, right = on(s)
        right.move_linear_absolute(x=350).wait()
        with s.record() as recorder:
            rides(s, left, 200)
            left.set_dyn_coord_transform(pcs=2, carrier="belt", x=left.x + 150).wait()
            on_it = left.move_linear_absolute(x=0, y=0, z=0, coordinate_system=PCS, pcs=2)
            s.run(2)
            assert left.waiting == "at zone 'middle' for group 'right'"
            assert left.state is takt.GroupState.GROUP_MOVING
            assert 200 < left.x <= 300
            assert left.velocity == 0
            assert not on_it.final
            right.move_linear_absolute(x=350, z=200).wait()
            on_it.wait(10)
            assert left.object_x == pytest.approx(0, abs=1e-6)
        assert not both_inside(s, recorder.recording)


@pytest.mark.parametrize(
    ("tracking", "sentence"),
    [("zones_ahead_s: -1", "zones_ahead_s"), ("zones_ahead_s: soon", "zones_ahead_s"), ("zones_ahead: 1", "did you")],
)
def test_bad_times_are_named(tracking: str, sentence: str) -> None:
    text = belt_machine().replace(", path:", f", tracking: {{{tracking}}}, path:", 1)
    with pytest.raises(takt.ConfigError, match=sentence):
        takt.Engine(text)


class World:
    """Two or three gantries over belts that share boxes, and somebody who commands at random."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)
        chance = self.chance
        zones = ""
        for k in range(chance.randint(1, 3)):
            at = [chance.uniform(-200, 300), chance.uniform(-60, 20), chance.uniform(-60, 0)]
            size = [chance.uniform(60, 160), chance.uniform(40, 120), chance.uniform(40, 90)]
            lower = ", ".join(f"{axis}: {a:.1f}" for axis, a in zip("xyz", at, strict=True))
            upper = ", ".join(f"{axis}: {a + b:.1f}" for axis, a, b in zip("xyz", at, size, strict=True))
            zones += f"  - {{name: z{k}, lower: {{{lower}}}, upper: {{{upper}}}}}\n"
        names = ("left", "right", "third")[: chance.choice((2, 2, 3))]
        groups = [gantry(name, chance.choice((0.0, -150.0, 200.0))) for name in names]
        self.text = with_belts(machine(zones, *groups, more=DRIVE), belt=0, across=chance.uniform(-180, 180))
        self.done = {"rides": 0, "stopped": 0, "waited": 0, "held": 0}

    def place(self, group: takt.Group) -> dict[str, float]:
        base = (group.parameters.get("base") or {}).get("x") or 0.0
        chance = self.chance
        return {"x": chance.uniform(-300, 450) - base, "y": chance.uniform(-80, 80), "z": chance.uniform(-50, 120)}

    def command(self, s: takt.Session, group: takt.Group) -> None:
        chance, what = self.chance, self.chance.random()
        if group.state is takt.GroupState.GROUP_ERROR_STOP:
            self.done["stopped"] += group.error == 3130
            group.reset()
        elif group.state is takt.GroupState.GROUP_DISABLED:
            group.power()
            group.enable()
        elif group.interrupted:
            group.continue_path()
        elif group.track_state is not takt.TrackState.NONE and chance.random() < 0.6:
            return
        elif what < 0.25:
            mode = chance.choice(["buffered", "blending_next", "aborting"])
            group.move_linear_absolute(**self.place(group), buffer_mode=mode)
        elif what < 0.55:
            belt, pcs = chance.choice(["belt", "across"]), chance.randint(1, 3)
            on_belt = {"x": chance.uniform(-200, 300), "y": chance.uniform(-30, 30), "z": 0.0}
            group.set_dyn_coord_transform(pcs=pcs, carrier=belt, **on_belt)
            for _ in range(chance.randint(1, 3)):
                group.move_linear_absolute(
                    x=chance.uniform(-40, 40), y=0, z=chance.choice([0, 40]), coordinate_system=PCS, pcs=pcs,
                    buffer_mode=chance.choice(["buffered", "blending_next", "aborting"]),
                )  # fmt: skip
        elif what < 0.75:
            group.track_conveyor_belt(belt="belt")
        elif what < 0.8:
            group.halt(**chance.choice([{}, {"deceleration": 800.0}]))
        elif what < 0.85:
            group.stop(**chance.choice([{}, {"deceleration": 800.0}]))
        elif what < 0.92:
            group.interrupt()
        elif what < 0.94:
            s.command("machine", "fail_all_axes")

    def run(self, s: takt.Session, steps: int) -> list[str]:
        chance = self.chance
        groups = on(s)
        drive = s.axis("drive")
        drive.power().wait()
        for i, group in enumerate(groups):
            group.move_linear_absolute(z=150 + 10 * i).wait()
        with s.record() as recorder:
            for _ in range(steps):
                if chance.random() < 0.25:
                    if not drive.loop_closed or drive.error:
                        drive.reset()
                        drive.power()
                    drive.move_velocity(
                        velocity=chance.choice([0.0, 50.0, 200.0, 500.0]),
                        direction=chance.choice(["positive", "positive", "negative"]),
                        acceleration=chance.choice([500.0, 2000.0]),
                    )
                self.command(s, chance.choice(groups))
                s.run(chance.uniform(0.005, 0.15))
                self.done["rides"] += sum(g.track_state is not takt.TrackState.NONE for g in groups)
                self.done["waited"] += sum(bool(g.waiting) for g in groups)
                self.done["held"] += sum(bool(g.zones) for g in groups)
        return both_inside(s, recorder.recording)


def test_never_two_inside_on_belts_at_random() -> None:
    """GR-47: random zones, belts that speed up, stop and turn round, moves onto them, tracking, halts, stops,
    interrupts and faults."""
    became: dict[str, Any] = {}
    for seed in range(400 if LONG else 3):
        world = World(seed)
        with takt.Engine(world.text) as s:
            wrong = world.run(s, 200 if LONG else 90)
        assert not wrong, f"seed {seed}: {wrong}"
        for key, value in world.done.items():
            became[key] = became.get(key, 0) + value
    assert min(became.values()) > 0, f"a test that cannot fail: {became}"


def pickers(chance: random.Random) -> str:
    """Two gantries whose ranges along one belt overlap, and a zone there."""
    lower = chance.uniform(200, 300)
    text = sharing("sync_time: 0.15", "sync_time: 0.15")
    text = text.replace("upper_limit: 250", f"upper_limit: {chance.uniform(300, 420):.0f}")
    text = text.replace("lower_limit: 350", f"lower_limit: {chance.uniform(150, 300):.0f}")
    zone = (
        f"lower: {{x: {lower:.0f}, y: -50, z: -50}}, upper: {{x: {lower + chance.uniform(80, 160):.0f}, y: 200, z: 90}}"
    )
    return f"{text}zones:\n  - {{name: between, {zone}}}\n"


def test_modules_never_meet_in_a_zone() -> None:
    """PP-67, GR-47: two pick and place modules at work on one belt that changes its speed, stops and turns round: never
    both inside, no fault, and both pick."""
    picked = [0, 0]
    for seed in range(60 if LONG else 3):
        chance = random.Random(seed)
        with takt.Engine(pickers(chance)) as s:
            belt, modules = s.belt("belt"), list(s.pick_places.values())
            belt.axis.power().wait()
            for module in modules:
                module.control(regulator_on=True).wait()
            s.wait(lambda modules=modules: all(m.axes_enabled and m.axes_group_enabled for m in modules), 5)
            for module in modules:
                module.execute()
            with s.record() as recorder:
                belt.axis.move_velocity(velocity=150)
                for _ in range(40):
                    belt.detect(x=0, y=chance.uniform(-30, 30))
                    if chance.random() < 0.3:
                        belt.axis.move_velocity(
                            velocity=chance.choice([0.0, 100.0, 250.0, 400.0]),
                            direction=chance.choice(["positive"] * 4 + ["negative"]),
                            acceleration=chance.choice([300.0, 1500.0]),
                        )
                    s.run(chance.uniform(0.1, 0.6))
            assert not both_inside(s, recorder.recording), f"seed {seed}"
            states = {m.name: m.state.name for m in modules}
            assert "ERROR" not in states.values(), f"seed {seed}: {states} {[m.error for m in modules]}"
            picked = [a + m.picked for a, m in zip(picked, modules, strict=True)]
    assert min(picked) > 5, f"a test that cannot fail: {picked}"
