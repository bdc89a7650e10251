"""Override.

Factors on the velocity, the ramps and the jerk of what moves an axis: of the motion in progress, which is planned anew
from where it is, and of those to come. They do not act on what brings an axis to rest, on homing, torques, tables over
time, nor on axes that follow others.

Velocity factor 0 holds the axis in its state until the factor is more. However late ramps are lowered, the axis does
not get beyond the target that it was on its way to: it takes as much more of its own ramps as that needs, and says so
(`limited_by` distance).

`axis.forecast(...)` tells in process what the motion in progress, or a command not given yet, is going to do.
"""

import takt
from takt import expect

COMMANDS = ("set_override",)
ERRORS = (5, 13)
SIGNALS = ("x.set_position", "x.set_velocity", "x.set_acceleration", "x.override_factor", "x.limited_by")


def scenario(session: takt.Session) -> None:
    x = session.axis("x")
    x.power().wait()
    move = x.move_relative(distance=300, velocity=200)
    session.run(0.5)
    session.mark("half the velocity", axis="x")
    x.set_override(velocity_factor=0.5)
    session.run(0.5)
    session.mark("held", axis="x")
    x.set_override(velocity_factor=0)
    session.run(0.5)
    assert x.state == "DiscreteMotion", x.state
    session.mark("on again", axis="x")
    x.set_override(velocity_factor=1)
    while x.set_position < 283:
        session.run(0.01)
    session.mark("weaker ramps, too late", axis="x")
    x.set_override(acceleration_factor=0.05, jerk_factor=0.05)
    move.wait()
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "x")
    expect.continuous(recording, "x")
    expect.stays(recording, "x.set_position <= 300.001")
    expect.visits_states(recording, "x", ["Standstill", "DiscreteMotion", "Standstill"])
