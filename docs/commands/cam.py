"""Cams, and tables over time.

An axis follows a table over its master's position, once or over and over, from where the cam and the axis meet; or it
follows a table of positions, velocities or accelerations over time. The tables are the machine's `cams:`, and those
made at run time (docs/cams.md).
"""

import takt
from takt import expect

COMMANDS = (
    "cam_table_select",
    "cam_in",
    "cam_add",
    "cam_remove",
    "cam_out",
    "begin_cam",
    "add_cam_points",
    "add_cam_segments",
    "build_cam",
    "drop_cam",
    "read_cam",
    "position_profile",
    "velocity_profile",
    "acceleration_profile",
)
ERRORS = (5, 6, 9, 10, 11, 13, 2006, 2007, 3004, 3005, 3010, 3018, 3019, 3113)
SIGNALS = ("[xyz].set_position", "[yz].set_velocity", "y.in_step", "y.state", "z.state")


def scenario(session: takt.Session) -> None:
    x, y, z = (session.axis(name) for name in "xyz")
    for power in [axis.power() for axis in (x, y, z)]:
        power.wait()
    start = x.set_position
    session.mark("y: on the cam from 50 mm on", axis="y")
    stroke = y.cam_in(master="x", cam="stroke", master_absolute=False, master_start_distance=50, slave_absolute=False)
    session.mark("x moves")
    x.move_velocity(velocity=150)
    stroke.wait(until="reached")
    assert abs(x.set_position - start - 50) < 0.2
    session.mark("z: positions over time", axis="z")
    z.position_profile(profile="swing", position_scale=60).wait()
    session.run(0.2)
    session.mark("z: velocities over time", axis="z")
    z.velocity_profile(profile="swing", velocity_scale=120).wait()
    session.run(0.3)
    session.mark("y leaves the cam", axis="y")
    y.cam_out().wait_final()
    session.run(0.2)
    for halt in [axis.halt() for axis in (x, y, z)]:
        halt.wait()
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    for axis in "xyz":
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    expect.visits_states(recording, "y", ["Standstill", "SynchronizedMotion", "ContinuousMotion", "Standstill"])
