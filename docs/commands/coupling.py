"""Gears, phases, sums of two masters.

A geared axis gets its master's velocity times the ratio, or meets it at a place; a phase shifts what it takes for its
master's position; two masters may be added. Let go, it keeps its velocity.
"""

import takt
from takt import expect

COMMANDS = ("gear_in", "gear_in_pos", "gear_out", "phasing_absolute", "phasing_relative", "combine_axes", "straighten")
ERRORS = (5, 6, 8, 10, 11, 13, 2006, 2007, 3004, 3005, 3010, 3018, 3019, 3101, 3102)
SIGNALS = ("[xyz].set_position", "[xyz].set_velocity", "y.in_step", "z.in_step", "y.state", "z.state")


def scenario(session: takt.Session) -> None:
    x, y, z = (session.axis(name) for name in "xyz")
    for power in [axis.power() for axis in (x, y, z)]:
        power.wait()
    start = x.set_position
    session.mark("x moves")
    x.move_velocity(velocity=100)
    session.run(0.3)
    session.mark("y: gear 2 to 1", axis="y")
    y.gear_in(master="x", ratio_numerator=2).wait(until="reached")
    session.mark("z: in step with x at a place", axis="z")
    z.gear_in_pos(master="x", master_sync_position=start + 100, slave_sync_position=40, master_start_distance=50).wait(
        until="reached"
    )
    assert abs(z.set_position - 40 - (x.set_position - start - 100)) < 1e-6
    session.run(0.3)
    session.mark("z: a phase of 20 mm", axis="z")
    z.phasing_relative(phase_shift=20, velocity=60).wait()
    session.run(0.2)
    session.mark("y lets go", axis="y")
    y.gear_out().wait_final()
    session.run(0.2)
    session.mark("z: x plus y", axis="z")
    z.combine_axes(master1="x", master2="y").wait(until="reached")
    session.run(0.3)
    y.halt(deceleration=2000).wait()  # z brakes as both together: gently, or it falls out of step
    x.halt(deceleration=2000).wait()
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    for axis in "xyz":
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    expect.visits_states(recording, "y", ["Standstill", "SynchronizedMotion", "ContinuousMotion", "Standstill"])
