"""Motions on top of other motions.

A distance of its own is added to what the axis does, be it a move, a gear or a cam, which knows nothing of it: it is
done when it would be done alone, and ends so much further on. So a label is brought to its mark without the web being
stopped. The limits are those of the axis: where both together would be too much, what lies on top is slower, or waits.
"""

import takt
from takt import expect

COMMANDS = ("move_superimposed", "halt_superimposed")
ERRORS = (3, 5, 6, 8, 10, 11, 12, 13, 3003, 3005, 3006)
SIGNALS = ("[xy].set_velocity", "y.covered_distance", "y.superimposed", "y.state")


def scenario(session: takt.Session) -> None:
    x, y = session.axis("x"), session.axis("y")
    for axis in (x, y):
        axis.power().wait()
    session.mark("y follows x", axis="y")
    y.gear_in(master="x")
    x.move_velocity(velocity=100).wait(until="reached")
    session.run(0.2)
    session.mark("10 more, on the way", axis="y")
    y.move_superimposed(distance=10, velocity_difference=40).wait()
    session.run(0.1)
    session.mark("40 less ...", axis="y")
    correction = y.move_superimposed(distance=-40, velocity_difference=60)
    session.run(0.3)
    session.mark("... no, halt", axis="y")
    y.halt_superimposed().wait()
    assert correction.aborted
    session.run(0.1)
    session.mark("x stands; 5 more", axis="y")
    x.halt().wait()
    y.move_superimposed(distance=5, velocity_difference=40).wait()
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "y")
    expect.continuous(recording, "y")
    expect.visits_states(recording, "y", ["SynchronizedMotion"])
