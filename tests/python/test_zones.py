"""Zones that groups share: one is inside at a time (GR-47)."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import pytest
import takt

LIMITS = "limits: {velocity: 1500, acceleration: 15000, jerk: 300000}"
PATH = "path: {velocity: 1000, acceleration: 10000, jerk: 200000}"


def gantry(name: str, base: float = 0.0) -> tuple[str, str]:
    """Lines of its axes and of the group itself."""
    axes = "".join(f"  - {{name: {name}_{axis}, unit: mm, {LIMITS}}}\n" for axis in "xyz")
    places = ", ".join(f"{name}_{axis}" for axis in "xyz")
    return axes, (
        f"  - {{name: {name}, axes: [{places}], kinematics: {{gantry: {{axes: [x, y, z]}}}}, {PATH}, "
        f"base: {{x: {base}}}}}\n"
    )


def machine(zones: str, *gantries: tuple[str, str], more: str = "") -> str:
    axes, groups = ("".join(lines) for lines in zip(*gantries, strict=True))
    return f"name: zones\naxes:\n{axes}{more}groups:\n{groups}zones:\n{zones}"


MIDDLE = "  - {name: middle, lower: {x: 100, y: -50, z: -50}, upper: {x: 200, y: 50, z: 50}, margin: 3}\n"
TWO = machine(MIDDLE, gantry("left"), gantry("right", 300))


def on(session: takt.Session) -> list[takt.Group]:
    groups = list(session.groups.values())
    for group in groups:
        group.power().wait()
        group.enable().wait()
    return groups


def inside(tool: Any, base: float, grown: float = 0.0) -> Any:
    x = tool["x"] + base
    within = (x > 100 - grown) & (x < 200 + grown)
    for other in ("y", "z"):
        within &= np.abs(tool[other]) < 50 + grown
    return within


def test_one_waits_outside_and_says_for_whom() -> None:
    """GR-47: it waits where its last move before ends, goes on by itself, and the moves in between are rounded."""
    with takt.Engine(TWO) as session:
        left, right = on(session)
        recorder = session.record()
        left.move_linear_absolute(x=150).wait()
        assert left.zone_names == ("middle",)
        assert not left.waiting
        up = right.move_linear_absolute(z=40)
        into = right.move_linear_absolute(x=-150, buffer_mode="blending_next")
        session.run(1)
        assert up.done
        assert not into.final
        assert right.waiting == "at zone 'middle' for group 'left'"
        assert right.zone_names == ()
        assert right.x == pytest.approx(0)
        into_low = right.move_linear_absolute(z=0, buffer_mode="buffered")
        left.move_linear_absolute(x=0).wait()
        into.wait()
        assert right.z == pytest.approx(40)
        into_low.wait()
        assert right.zone_names == ("middle",)
        assert left.zone_names == ()
        recording = recorder.stop()
    assert not (inside(recording["left"], 0) & inside(recording["right"], 300)).any()


def test_a_zone_that_is_passed_is_free_before_the_move_ends() -> None:
    with takt.Engine(TWO) as session:
        left, right = on(session)
        through = left.move_linear_absolute(x=900)
        session.wait(lambda: left.x > 203)
        session.step(2)
        assert left.zone_names == ()
        assert not through.final
        assert right.move_linear_absolute(x=-150).wait().done


def test_stops_and_power_off_leave_no_zone_taken() -> None:
    """GR-47: what ends a move ends its claim; a tool that rests inside has the zone, on or off."""
    with takt.Engine(TWO) as session:
        left, right = on(session)
        for end in ("halt", "stop", "disable", "power"):
            left.move_linear_absolute(x=150).wait()
            waits = right.move_linear_absolute(x=-150)
            session.run(0.1)
            assert right.waiting
            getattr(right, end)(**({"enable": False} if end == "power" else {})).wait()
            assert waits.final
            assert not right.waiting
            assert right.zone_names == ()
            left.move_linear_absolute(x=0).wait()
            session.step(2)
            assert left.zone_names == ()
            right.power().wait()
            right.enable().wait() if right.state.value == "GroupDisabled" else None
        left.move_linear_absolute(x=150).wait()
        session.command("machine", "emergency_stop").wait()
        session.run(0.5)
        assert left.zone_names == ("middle",)


def test_who_would_wait_in_a_circle_is_refused() -> None:
    """GR-47: overlapping zones, and each group is in one that the other needs."""
    zones = (
        "  - {name: near, lower: {x: 0, y: -9, z: -9}, upper: {x: 160, y: 9, z: 9}}\n"
        "  - {name: far, lower: {x: 140, y: -9, z: -9}, upper: {x: 300, y: 9, z: 9}}\n"
    )
    with takt.Engine(machine(zones, gantry("left"), gantry("right", 300))) as session:
        left, right = on(session)
        assert left.zone_names == ("near",)
        assert right.zone_names == ("far",)
        waits = left.move_linear_absolute(x=250)
        session.run(0.2)
        assert left.waiting == "at zone 'far' for group 'right'"
        refused = right.move_linear_absolute(x=-250).wait_final()
        assert refused.error_id == 3131
        assert "deadlock at zones" in refused.sentence
        assert right.move_linear_absolute(y=40).wait().done  # out of the way
        assert waits.wait().done
        assert left.zone_names == ("far",)


@pytest.mark.parametrize("seed", range(3))
def test_never_two_inside_at_random(seed: int) -> None:
    """GR-47: three groups, two zones that overlap, moves of all kinds, halts; whoever waits gets there."""
    chance = random.Random(seed)
    zones = (
        MIDDLE + "  - {name: side, lower: {x: 150, y: 0, z: -50}, upper: {x: 260, y: 90, z: 50}, groups: [left, top]}\n"
    )
    text = machine(zones, gantry("left"), gantry("right", 300), gantry("top", 150))
    bases = {"left": 0.0, "right": 300.0, "top": 150.0}
    with takt.Engine(text) as session:
        groups = on(session)
        recorder = session.record()
        given: list[takt.Feedback] = []
        waited = 0
        for group in groups:
            group.move_linear_absolute(z=200).wait()
        for _ in range(250):
            group = chance.choice(groups)
            x, y, z = chance.uniform(50, 260) - bases[group.name], chance.uniform(-80, 120), chance.uniform(-60, 200)
            if chance.random() < 0.05:
                group.halt()
            elif chance.random() < 0.5:
                mode = chance.choice(["buffered", "blending_next"])
                given.append(group.move_linear_absolute(x=x, y=y, z=z, buffer_mode=mode))
            else:
                given.append(group.move_direct_absolute(x=x, y=y, z=z, coordinate_system="mcs", buffer_mode="buffered"))
            session.run(chance.uniform(0, 0.15))
            waited += sum(bool(one.waiting) for one in groups)
        # Where two wait for one that stands inside with nothing to do, that one is led out.
        for group in sorted(groups, key=lambda one: not one.zone_names):
            group.halt().wait_final()
            assert group.move_linear_absolute(z=200).wait_final(timeout=20).done
        recording = recorder.stop()
    assert waited > 20
    assert sum(one.done for one in given) > 30
    assert {one.error_id for one in given} <= {0, 3005, 3131}  # given while it halts
    here = {name: inside(recording[name], base) for name, base in bases.items()}
    for one, other in (("left", "right"), ("left", "top"), ("right", "top")):
        assert not (here[one] & here[other]).any()


@pytest.mark.parametrize(
    ("zone", "sentence"),
    [
        ("{name: z, lower: {x: 0, y: 0, z: 0}, upper: {x: 9, y: 0, z: 9}}", "zones[0].upper: must lie above lower"),
        ("{name: z, lower: {x: 0, y: 0, z: 0}, upper: {x: 9, y: 9}}", "zones[0].upper.z: expected this key"),
        (
            "{name: z, lower: {x: 0, y: 0, z: 0}, upper: {x: 9, y: 9, z: 9}, groups: [lift, right]}",
            "did you mean left?",
        ),
        ("{name: z, lower: {x: 0, y: 0, z: 0}, upper: {x: 9, y: 9, z: 9}, groups: [left]}", "at least 2 groups"),
        ("{name: z, lower: {x: 0, y: 0, z: 0}, upper: {x: 9, y: 9, z: 9}, groups: [left, left]}", "found 'left' again"),
        ("{name: z, lower: {x: 0, y: 0, z: 0}, upper: {x: 9, y: 9, z: 9}, margin: -1}", "zones[0].margin"),
    ],
)
def test_bad_zones_are_named(zone: str, sentence: str) -> None:
    with pytest.raises(takt.ConfigError) as refused:
        takt.Engine(machine(f"  - {zone}\n", gantry("left"), gantry("right")))
    assert sentence in str(refused.value)


def test_a_blend_that_cuts_through_a_zone_is_counted() -> None:
    """GR-47: neither side of the corner meets the zone, the blend between them does: it has the zone where it is free,
    else the tool waits at the corner."""
    zone = "  - {name: corner, lower: {x: 100, y: 100, z: -50}, upper: {x: 190, y: 190, z: 50}, margin: 3}\n"
    rounded = {"buffer_mode": "blending_next", "transition_mode": "corner_distance", "transition_parameter": 90}

    def within(recording: takt.Recording, name: str) -> Any:
        tool = recording[name]
        return (np.abs(tool["x"] - 145) < 45) & (np.abs(tool["y"] - 145) < 45)

    with takt.Engine(machine(zone, gantry("left"), gantry("right"))) as session:
        left, right = on(session)
        for taken in (False, True):
            right.move_linear_absolute(x=150 if taken else 400, y=150).wait()
            left.move_linear_absolute(y=0).wait()
            left.move_linear_absolute(x=200).wait()
            with session.record() as recorder:
                left.move_linear_absolute(y=200)
                last = left.move_linear_absolute(x=0, **rounded)
                session.run(1)
                if taken:
                    assert left.waiting == "at zone 'corner' for group 'right'"
                    assert (left.x, left.y) == pytest.approx((200, 200))
                    right.move_linear_absolute(x=400, y=0).wait()
                assert last.wait().done
            cuts = within(recorder.recording, "left")
            assert cuts.any() is np.bool_(not taken)
            assert (recorder.recording["left"]["zones"][cuts] == 1).all()
            assert not (cuts & within(recorder.recording, "right")).any()


@pytest.mark.parametrize("how", ["member", "group", "all", "emergency_stop"])
def test_power_off_ends_a_wait(how: str) -> None:
    """GR-47, AX-100: a move that waits for a zone does not set off when the power comes back."""
    with takt.Engine(TWO) as session:
        left, right = on(session)
        left.move_linear_absolute(x=150).wait()
        waits = right.move_linear_absolute(x=-150)
        session.run(0.1)
        assert right.waiting
        if how == "member":
            session.axis("right_y").power(enable=False).wait()
        elif how == "group":
            right.power(enable=False).wait()
        elif how == "all":
            session.command("machine", "stop_all", {"open_loops": True})
        else:
            session.command("machine", "emergency_stop")
        session.run(0.1)
        assert waits.final
        assert not waits.done
        assert not right.waiting
        right.reset().wait()
        right.power().wait()
        left.reset().wait()
        left.power().wait()
        left.move_linear_absolute(x=0).wait()
        session.run(0.5)
        assert right.x == 0
        right.move_linear_absolute(x=-150).wait()
