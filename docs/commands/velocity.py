"""Moves without an end, and how they end.

A velocity is held until something else comes: halt, which any command may interrupt, or stop, which lets nothing
through while it is held. A jog follows two keys.
"""

import takt
from takt import expect

COMMANDS = ("move_velocity", "jog", "halt", "stop")
ERRORS = (5, 6, 10, 11, 12, 13, 2006, 2007, 3003, 3005, 3006, 3014)
SIGNALS = ("x.set_velocity", "x.set_acceleration", "x.state")


def scenario(session: takt.Session) -> None:
    x = session.axis("x")
    x.power().wait()
    session.mark("velocity", axis="x")
    x.move_velocity(velocity=150).wait(until="reached")
    session.mark("another one", axis="x")
    x.move_velocity(velocity=60, direction="negative").wait(until="reached")
    session.mark("halt", axis="x")
    x.halt().wait()
    x.move_velocity(velocity=100).wait(until="reached")
    session.mark("stop, held", axis="x")
    stop = x.stop(deceleration=1000, hold=True)
    session.run(0.3)
    refused = x.move_velocity(velocity=10).wait_final()
    assert refused.error_id == 6, refused
    stop.release()
    session.run(0.1)
    session.mark("jog", axis="x")
    jog = x.jog(backward=True, velocity=50)
    session.run(0.4)
    jog.release()
    session.run(0.2)


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "x")
    expect.continuous(recording, "x")
    expect.visits_states(recording, "x", ["ContinuousMotion", "Stopping", "Standstill", "ContinuousMotion"])
