"""3-11: closing the clutch over a way of the master, in the positive direction only.

While the master turns backwards over the sync position, the slave stands. Its curve begins on the next pass upwards.
"""

import takt
from figure import SPEED, mark, meets, ready, stroke, turns

SIGNALS = (
    "master.set_position",
    "slave.set_position",
    "flex.mp06_y_to_slave_position",
    "master.set_velocity",
    "slave.set_velocity",
    "flex.acc_dec_sync",
    "flex.cam_synchronised",
)


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, slave, cam = session.axis("master"), session.axis("slave"), session.flex_cam("flex")
    cam.configure(
        sync_mode="ramp_pos", sync_direction="positive", master_sync_in_distance=100, master_sync_in_position=60
    ).wait()
    master.move_absolute(position=200, velocity=360, direction="positive").wait()
    slave.move_absolute(position=-50, velocity=200).wait()
    session.mark("clutch: ramp_pos, upwards")
    closing = cam.control(sync_cam=True)
    session.mark("the master turns back")
    master.move_velocity(velocity=SPEED, direction="negative")
    session.run(3.0)
    session.mark("and forth")
    master.move_velocity(velocity=SPEED)
    closing.wait()
    session.mark("on the cam")
    session.run(3.0)


def verify(recording: takt.Recording) -> None:
    x, slave = turns(recording), recording["slave"]["set_position"]
    back, closed = mark(recording, "the master turns back"), mark(recording, "on the cam")
    time = recording["slave"]["time_s"]
    lowest = x[time > back].argmin() + (time <= back).sum()
    assert x[lowest] < -41  # beyond where the curve is to begin
    meets("the slave on the way back", slave[(time > back) & (time < time[lowest])], -50)
    meets("the slave before the sync position", slave[lowest:][x[lowest:] > 60], stroke(x[lowest:][x[lowest:] > 60]))
    assert abs(x[time >= closed][0] - 60) < 0.2
