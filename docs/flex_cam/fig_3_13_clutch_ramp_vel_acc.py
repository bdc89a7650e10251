"""3-13: closing the clutch with velocity and ramps of its own (ramp_vel_acc).

What lies between the slave and Y goes to zero at 40 mm/s; once the master turns, that comes on top of
the cam's velocity.
"""

import takt
from figure import SPEED, mark, meets, ready, stroke, turns

SIGNALS = (
    "master.set_position",
    "slave.set_position",
    "flex.mp06_y_to_slave_position",
    "slave.set_velocity",
    "flex.set_y_velocity",
    "flex.acc_dec_sync",
    "flex.cam_synchronised",
)


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, slave, cam = session.axis("master"), session.axis("slave"), session.flex_cam("flex")
    cam.configure(
        sync_mode="ramp_vel_acc", sync_velocity=40, sync_acceleration=200, sync_deceleration=100, sync_jerk=2000
    ).wait()
    master.move_absolute(position=90, velocity=180).wait()
    slave.move_absolute(position=-50, velocity=200).wait()
    session.mark("at rest")
    session.run(0.3)
    session.mark("clutch: ramp_vel_acc")
    closing = cam.control(sync_cam=True)
    session.run(1.0)
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    closing.wait()
    session.mark("on the cam")
    session.run(2.0)


def verify(recording: takt.Recording) -> None:
    begin, end = mark(recording, "clutch: ramp_vel_acc"), mark(recording, "on the cam")
    # The way at its velocity; half of what the ramps take, each rounded by the jerk.
    wanted_s = 100 / 40 + (40 / 200 + 200 / 2000) / 2 + (40 / 100 + 100 / 2000) / 2
    assert abs(end - begin - wanted_s) < 0.01
    closing = recording.slice(begin, end)
    speed = closing["slave"]["set_velocity"] - closing["flex"]["set_y_velocity"]
    time = closing["slave"]["time_s"] - begin
    meets("the shift's velocity", speed[(time > 0.32) & (time < wanted_s - 0.47)], 40)
    assert speed.min() > -1e-6
    assert speed.max() < 40 + 1e-6
    on = recording.slice(end, recording.end_s)
    meets("the slave on the cam", on["slave"]["set_position"], stroke(turns(on)))
