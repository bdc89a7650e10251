"""Set points from outside.

A joystick, a camera or another controller says where the axis is to be, many times a second, with times of its own
clock. The axis goes by a smooth curve through these set points, one `delay` late, within its limits; when they stop
coming it stops. Set points of a group say where its tool is to be, in any coordinate system that stands, or its axes.
"""

import math
import random

import takt
from takt import expect

COMMANDS = ("stream", "stream_point", "group.stream", "group.stream_point")
ERRORS = (5, 8, 10, 11, 1001, 1003, 3003, 3005, 3021, 3022, 3120, 3121, 3122, 3123, 3130)
SIGNALS = ("x.set_position", "x.set_velocity", "y.set_position", "x.state")


def scenario(session: takt.Session) -> None:
    hand, begin = random.Random(4), 0.0
    waves = [(hand.uniform(8, 20) / f, f) for f in (0.9, 2.3, 5.1)]
    x = session.axis("x")
    x.power().wait()
    session.mark("a hand at 50 Hz, a tenth of it lost", axis="x")
    stream = x.stream(key=17, delay=0.08)
    begin = x.set_position
    for i in range(150):
        t = i / 50
        if i == 0 or hand.random() > 0.1:
            x.stream_point(position=begin + sum(a * (1 - math.cos(f * t)) for a, f in waves), time=t, key=17)
        session.run(0.02)
    session.mark("nothing more comes", axis="x")
    stream.wait_final()
    assert stream.error_id == 3123
    session.run(0.3)
    session.mark("the tool of a portal round a circle", axis="x")
    portal = session.group("portal")
    portal.power().wait()
    portal.enable().wait()
    portal.stream(key=18, delay=0.08)
    x, y = portal.x, portal.y
    for i in range(100):
        t = i / 50
        portal.stream_point(x=x + 20 * math.sin(3 * t), y=y + 20 * (1 - math.cos(3 * t)), time=t, key=18)
        session.run(0.02)
    portal.halt().wait()


def verify(recording: takt.Recording) -> None:
    for axis in ("x", "y"):
        expect.within_limits(recording, axis)
    expect.visits_states(recording, "x", ["Standstill", "SynchronizedMotion", "DiscreteMotion", "Standstill"])
