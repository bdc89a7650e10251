"""Power, reset, emergency stop.

An axis is switched on and off with power. A fault ends in ErrorStop, which only reset leaves; the emergency stop opens
all loops at once and leaves the axes Disabled; held, it keeps them so.
"""

import takt
from takt import expect

COMMANDS = (
    "power",
    "reset",
    "stop_all",
    "emergency_stop",
    "release_emergency_stop",
    "fail_all_axes",
    "release",
    "renew",
)
ERRORS = (5, 7, 11, 13, 2001, 2004, 2005, 2006, 2007, 3001, 3002, 3007, 3016, 3100, 3103)
SIGNALS = ("x.set_velocity", "x.actual_position", "x.loop_closed", "x.state")


def scenario(session: takt.Session) -> None:
    x = session.axis("x")
    session.mark("power on")
    x.power().wait()
    session.mark("moves", axis="x")
    x.move_velocity(velocity=100, direction="negative")
    session.run(1.2)  # the limit switch at -150 stops it
    assert x.state == "ErrorStop", x.state
    session.mark("reset", axis="x")
    x.reset().wait()
    x.move_velocity(velocity=100)
    session.run(0.5)
    session.mark("emergency stop")
    session.command("machine", "emergency_stop").wait()
    session.run(0.2)


def verify(recording: takt.Recording) -> None:
    expect.visits_states(recording, "x", ["Disabled", "Standstill", "ContinuousMotion", "ErrorStop", "Standstill"])
    expect.visits_states(recording, "x", ["ContinuousMotion", "Disabled"])
    expect.within_limits(recording, "x")
