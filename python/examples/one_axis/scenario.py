"""One axis finds its reference and moves: blended, interrupted, on top of a motion, slowed down, jogged, and stopped.

takt demo one_axis --view      on taktd in real time over LCM, with the live page; afterwards jog it there
takt run python/examples/one_axis/scenario.py      the same in process, in virtual time
"""

import takt
from matplotlib.figure import Figure
from takt import expect, plot

TAKES_S = 15
VIEW = {
    "tab": "scope",
    "signals": "x.set_position x.actual_position x.set_velocity x.set_acceleration x.state".split(),
}

HOMED = "the reference is found"
BLENDED = "three moves, blended"
BLENDED_ENDS = "the third has ended"
SLOWER = "half as fast"
SLOWER_ENDS = "as fast as ever"


def scenario(session: takt.Session) -> None:
    x = session.axis("x")

    session.mark("power on and homing")
    x.power().wait()
    refused = x.move_absolute(position=100).wait_final()
    assert refused.error_id == 9, refused  # it does not know yet where it is
    x.home().wait()
    session.mark(HOMED)
    x.move_absolute(position=0).wait()
    session.run(0.5)

    session.mark(BLENDED)  # each begins at the speed at which the one before ends
    x.move_absolute(position=150, velocity=150)
    x.move_absolute(position=350, velocity=400, buffer_mode="blending_low")
    x.move_absolute(position=550, velocity=100, buffer_mode="blending_low").wait()
    session.mark(BLENDED_ENDS)
    session.run(0.5)

    session.mark("interrupted on the way")  # a new command takes over without a stop
    given_up = x.move_absolute(position=100)
    session.wait(lambda: x.set_position < 350)
    x.move_absolute(position=450, velocity=200).wait()
    assert given_up.aborted

    session.mark("30 mm on top of an endless motion")
    endless = x.move_velocity(velocity=60, direction="negative")
    endless.wait(until="reached")
    x.move_superimposed(distance=-30, velocity_difference=60).wait()
    session.run(0.5)

    session.mark(SLOWER)
    x.set_override(velocity_factor=0.5).wait()
    session.run(1.5)
    x.set_override(velocity_factor=1.0).wait()
    session.mark(SLOWER_ENDS)
    session.run(0.5)
    x.halt().wait()
    assert endless.aborted

    session.mark("jogged")  # as long as the key is held
    for key in ({"forward": True}, {"backward": True}):
        jog = x.jog(velocity=200, **key)
        session.run(0.6)
        jog.release()
        jog.wait()

    session.mark("stopped")  # nothing else moves it until the stop is released
    x.move_absolute(position=590)
    session.run(0.4)
    stop = x.stop(hold=True)
    session.wait(lambda: x.set_velocity == 0)
    assert x.move_relative(distance=10).wait_final().error
    session.run(0.5)
    stop.release()
    session.wait(lambda: x.state == takt.PlcState.STANDSTILL)

    session.mark("and back")
    x.move_absolute(position=0, velocity=250).wait()
    x.power(enable=False).wait()


def times(recording: takt.Recording) -> dict[str, float]:
    return {event.text: event.time_s for event in recording.events if event.kind == "mark"}


def verify(recording: takt.Recording) -> None:
    at = times(recording)
    homed = (at[HOMED], recording.end_s)  # until then its positions count from where it was switched on
    expect.within_limits(recording, "x", window=homed)
    expect.continuous(recording, "x", window=homed)
    expect.stays(recording, "x.homed", window=homed)
    expect.stays(recording, "|x.following_error| < 0.5")
    expect.stays(recording, "x.error < 0.5")
    expect.reaches(recording, "x", 550.0, tolerance=0.01, by=at[BLENDED_ENDS])
    # It does not stop from one move to the next ...
    expect.stays(recording, "x.set_velocity > 99.999", window=(at[BLENDED] + 0.5, at[BLENDED_ENDS] - 0.5))
    # ... and with half the override it has half the speed.
    halved = (at[SLOWER] + 0.5, at[SLOWER_ENDS] - 0.2)
    expect.stays(recording, "x.set_velocity < -29.999", window=halved)
    expect.stays(recording, "x.set_velocity > -30.001", window=halved)
    expect.settles(recording, "x", 0.0, 0.05, within=recording.duration_s)
    states = ["Standstill", "Homing", "Standstill", "DiscreteMotion", "ContinuousMotion", "Standstill"]
    expect.visits_states(recording, "x", ["Disabled", *states, "Stopping", "Standstill", "DiscreteMotion", "Disabled"])


def pictures(recording: takt.Recording) -> dict[str, Figure]:
    return {"one_axis": plot.draw(recording, *VIEW["signals"], "x.following_error", title="One axis")}
