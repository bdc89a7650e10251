"""Moves to a position.

To a position, by a distance, by a distance more than was promised, or through a position with a velocity left. The
buffer mode says how one move follows another: at once, after it, or blended into it.
"""

import takt
from takt import expect

COMMANDS = (
    "move_absolute",
    "move_relative",
    "move_additive",
    "move_continuous_absolute",
    "move_continuous_relative",
    "inch",
)
ERRORS = (3, 5, 6, 8, 9, 10, 11, 12, 13, 3003, 3004, 3005, 3006)
SIGNALS = ("x.set_position", "x.set_velocity", "x.set_acceleration", "x.state")


def scenario(session: takt.Session) -> None:
    x = session.axis("x")
    x.power().wait()
    start = x.set_position
    session.mark("absolute", axis="x")
    x.move_absolute(position=start + 60, velocity=200).wait()
    session.mark("blended into the next", axis="x")
    x.move_absolute(position=start + 120, velocity=200)
    x.move_absolute(position=start + 160, velocity=80, buffer_mode="blending_low").wait()
    session.mark("additive in the middle", axis="x")
    x.move_relative(distance=-60, velocity=150)
    session.run(0.15)
    x.move_additive(distance=-40, velocity=150).wait()
    session.mark("on with a velocity", axis="x")
    through = x.move_continuous_relative(distance=30, end_velocity=40, velocity=200)
    through.wait(until="reached")
    session.run(0.4)
    x.halt().wait()
    session.mark("one inch", axis="x")
    x.inch(distance=2).wait()


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "x")
    expect.continuous(recording, "x")
    expect.visits_states(recording, "x", ["DiscreteMotion", "ContinuousMotion", "Standstill", "DiscreteMotion"])
