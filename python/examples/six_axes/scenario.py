"""Six axes with different units and drives: moves, a blended path, an abort, a halt, a SW limit and the way back.

takt run python/examples/six_axes/scenario.py           in process, in virtual time
takt demo six_axes                                      on taktd in real time, over LCM
"""

import takt
from takt import expect

TAKES_S = 7
VIEW = {
    "tab": "scope",
    "signals": (
        "x.set_position y.set_position z.set_position a.set_position x.set_velocity y.set_velocity c.set_velocity "
        "a.state c.state y.state"
    ).split(),
}


def scenario(session: takt.Session) -> None:
    x, y, z, a, c, feed = (session.axis(name) for name in ("x", "y", "z", "a", "c", "feed"))

    session.mark("power on")
    for power in [axis.power() for axis in session.axes.values()]:
        power.wait()

    session.mark("all at once")
    moves = [
        x.move_absolute(position=400),
        y.move_absolute(position=300),
        z.move_absolute(position=150),
        a.move_absolute(position=60),
        c.move_absolute(position=270, direction="shortest"),
        feed.move_velocity(velocity=600),
    ]
    for move in moves:
        move.wait(until="reached")

    session.mark("x in three blended moves")
    x.move_absolute(position=550, velocity=300)
    x.move_absolute(position=700, velocity=150, buffer_mode="blending_low")
    last = x.move_absolute(position=800, velocity=400, buffer_mode="blending_next")

    session.mark("y is sent back on its way", axis="y")
    given_up = y.move_absolute(position=600)
    session.run(0.3)
    back = y.move_absolute(position=50)
    back.wait()
    assert given_up.aborted
    last.wait()

    session.mark("the turntable turns and is halted", axis="c")
    turning = c.move_velocity(velocity=500)
    turning.wait(until="reached")
    session.run(0.5)
    c.halt(deceleration=1800).wait()
    assert turning.aborted
    c.move_absolute(position=10, direction="positive").wait()

    session.mark("a runs into its SW limit", axis="a")
    runaway = a.move_velocity(velocity=90)
    runaway.wait_final()
    assert runaway.error_id == 2006, runaway
    session.wait(lambda: a.set_velocity == 0)
    assert a.state == takt.PlcState.ERROR_STOP
    a.reset().wait()
    a.move_absolute(position=0).wait()

    session.mark("z is jogged", axis="z")
    jog = z.jog(backward=True, velocity=50)
    session.run(0.5)
    jog.release()
    jog.wait()

    session.mark("the roller stops at 250 mm", axis="feed")
    feed.move_absolute(position=250, direction="positive").wait()
    for axis in session.axes.values():
        axis.power(enable=False).wait()


def verify(recording: takt.Recording) -> None:
    for axis in recording.components:
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    expect.reaches(recording, "x", 800.0, tolerance=0.02, by=recording.start_s + 6)
    expect.settles(recording, "y", 50.0, 0.1, within=recording.duration_s)
    expect.settles(recording, "c", 10.0, 0.05, within=recording.duration_s)
    expect.stays(recording, "a.set_position < 110.000001")
    expect.stays(recording, "|x.following_error| < 0.5")
    expect.visits_states(
        recording, "a", ["ContinuousMotion", "ErrorStop", "Standstill", "DiscreteMotion", "Standstill", "Disabled"]
    )
    expect.visits_states(recording, "c", ["ContinuousMotion", "DiscreteMotion", "Standstill"])
    expect.never_both(recording, "a.loop_closed < 0.5", "|a.set_velocity| > 0")
