"""Two Deltas share the products of one belt, and the place between them.

takt run python/examples/two_robots/scenario.py       in process, in virtual time
takt demo two_robots                                  on taktd in real time, over LCM
"""

import random
from pathlib import Path

import numpy as np
import takt
import yaml
from takt import expect

TAKES_S = 7
VIEW = {
    "tab": "plan",
    "signals": ["left.x", "right.x", "left.zones", "right.zones", "left.waits_for", "right.waits_for"],
}

MACHINE = yaml.safe_load((Path(__file__).parent / "machine.yaml").read_text(encoding="utf-8"))
SEED = 4
SPEED, SLOWER = 300.0, 180.0  # mm/s of the belt
NEAREST, MORE, ACROSS = 105.0, 30.0, 30.0  # mm between two products: at least, and beside that; mm beside the middle
WORKS, ENDS = "picks begin", "the last ones"
WORKS_S, SLOW_S, SLOW_FOR_S = 6.5, 3.2, 0.8


def scenario(session: takt.Session) -> None:
    chance = random.Random(SEED)
    belt, pickers = session.belt("infeed"), list(session.pick_places.values())

    session.mark("power on")
    belt.axis.power().wait()
    for picker in pickers:
        picker.control(regulator_on=True).wait()
    session.wait(lambda: all(picker.axes_enabled and picker.axes_group_enabled for picker in pickers), 10)

    session.mark(WORKS)
    loops = [picker.execute() for picker in pickers]
    belt.axis.move_velocity(velocity=SPEED)
    begins, slow, normal = session.now, False, False
    while session.now < begins + WORKS_S:
        belt.detect(x=0, y=chance.uniform(-ACROSS, ACROSS))
        after = belt.position + NEAREST + chance.uniform(0, MORE)
        session.wait(lambda after=after: belt.position >= after, 10)
        if not slow and session.now > begins + SLOW_S:
            slow = True
            session.mark("the belt slows down")
            belt.axis.move_velocity(velocity=SLOWER)
        if not normal and session.now > begins + SLOW_S + SLOW_FOR_S:
            normal = True
            session.mark("and is as fast as before")
            belt.axis.move_velocity(velocity=SPEED)

    session.mark(ENDS)
    for picker in pickers:
        picker.abort()  # the loop ends behind the path in progress
    for loop in loops:
        loop.wait_final()
    belt.axis.halt().wait()
    for picker in pickers:
        picker.control(regulator_on=False).wait()
    session.wait(lambda: not any(picker.axes_enabled for picker in pickers), 10)
    belt.axis.power(enable=False).wait()


def inside(recording: takt.Recording, robot: str) -> np.ndarray:
    """In which cycles the tool is in the zone."""
    zone = MACHINE["zones"][0]
    base = next(group.get("base", {}).get("x", 0.0) for group in MACHINE["groups"] if group["name"] == robot)
    tool = recording[robot]
    within = np.ones(len(tool), bool)
    for axis, offset in (("x", base), ("y", 0.0), ("z", 0.0)):
        within &= (tool[axis] + offset > zone["lower"][axis]) & (tool[axis] + offset < zone["upper"][axis])
    return within


def verify(recording: takt.Recording) -> None:
    robots = ("left", "right")
    picked = {robot: int(recording[f"{robot}_picker"]["picked"][-1]) for robot in robots}
    there = {robot: inside(recording, robot) for robot in robots}
    waits = {robot: float(np.mean(recording[robot]["waits_for"] > 0)) for robot in robots}
    told = ", ".join(f"{robot} picked {picked[robot]}, waited {waits[robot]:.0%} of the time" for robot in robots)
    print(told)
    assert not (there["left"] & there["right"]).any(), "both tools were in the zone at once"
    assert all(there[robot].any() for robot in robots), told
    assert min(picked.values()) >= 4, told
    assert not any(recording[f"{robot}_picker"]["missed"][-1] for robot in robots), f"products were missed: {told}"
    for robot in robots:
        expect.stays(recording, f"{robot}_picker.error == 0")
        for axis in range(1, 4):
            expect.within_limits(recording, f"{robot}_{axis}")
            expect.continuous(recording, f"{robot}_{axis}")
