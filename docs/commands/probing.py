"""Measuring and switching on the way.

A touch probe is captured between two cycles, to within microseconds of travel. GT_Touch stops at what it touched. A cam
switch puts out signals over ranges of positions, early enough for valves that take their time.
"""

import takt
from takt import expect

COMMANDS = ("arm_probe", "abort_trigger", "touch", "digital_cam_switch")
ERRORS = (5, 10, 11, 13, 3005, 3010)
SIGNALS = ("x.set_position", "x.set_velocity", "x.touch_probe", "x.cam_outputs", "x.probe_position", "x.state")


def scenario(session: takt.Session) -> None:
    x = session.axis("x")
    x.power().wait()
    x.define_position(position=-60).wait()
    x.digital_cam_switch(switches="nozzles").wait(until="active")
    session.mark("an edge is measured", axis="x")
    probe = x.arm_probe(edge="rising")
    x.move_absolute(position=180, velocity=150).wait()
    assert abs(probe.value - 83.25) < 0.01, probe.value
    session.mark("back to before it", axis="x")
    x.move_absolute(position=60, velocity=300).wait()
    session.mark("touch: stop, and back to the edge", axis="x")
    touch = x.touch(mode="capture", edge="rising", velocity=100)
    x.move_absolute(position=180, velocity=100)
    touch.wait()
    assert abs(x.set_position - 83.25) < 0.01, x.set_position


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "x")
    expect.visits_states(recording, "x", ["Standstill", "DiscreteMotion", "Standstill", "DiscreteMotion", "Standstill"])
