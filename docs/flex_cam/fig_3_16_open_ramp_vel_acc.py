"""3-16: opening the clutch with velocity and ramps of its own (ramp_vel_acc).

The slave goes to its sync-out position at 40 mm/s and stands; what the master does no longer matters.
"""

import numpy as np
import takt
from figure import SPEED, mark, meets, ready, stroke, turns

SIGNALS = (
    "master.set_position",
    "slave.set_position",
    "flex.mp06_y_to_slave_position",
    "slave.set_velocity",
    "flex.acc_dec_sync",
    "flex.cam_synchronised",
)


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, cam = session.axis("master"), session.flex_cam("flex")
    cam.control(sync_cam=True).wait()
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    session.run(2.5)
    cam.configure(
        sync_mode="ramp_vel_acc", sync_velocity=40, sync_acceleration=200, sync_deceleration=100, sync_jerk=2000,
        slave_sync_out_position=-50,
    ).wait()  # fmt: skip
    session.mark("open: ramp_vel_acc")
    opening = cam.control(sync_cam=False)
    session.run(0.5)
    session.mark("the master stops")
    master.halt()
    opening.wait()
    session.mark("at rest")
    session.run(1.0)


def verify(recording: takt.Recording) -> None:
    begin, end = mark(recording, "open: ramp_vel_acc"), mark(recording, "at rest")
    on, off = recording.slice(0, begin), recording.slice(begin, end)["slave"]
    meets("the slave on the cam", on["slave"]["set_position"], stroke(turns(on)))
    left, speed = off["set_position"] + 50, off["set_velocity"]
    # It brakes from 40 mm/s over 9 mm, half of what velocity and ramp with jerk take.
    braking = 40 / 2 * (40 / 100 + 100 / 2000)
    steady = (off["time_s"] - begin > 1) & (left > braking + 0.1)
    meets("the slave's velocity", speed[steady], -40)
    assert np.all(speed[left < braking - 0.1] > -40)
    assert off["set_acceleration"].max() < 200 + 1e-6
    assert left.min() > -1e-6  # without overshooting
    meets("the slave at rest", recording.slice(end, recording.end_s)["slave"]["set_position"], -50)
