"""3-15: opening the clutch over a time (ramp_time).

In two seconds the slave gets to its sync-out position, on a curve of the fifth degree, and stands; what the master does
no longer matters.
"""

import numpy as np
import takt
from figure import SPEED, mark, meets, quintic, ready, stroke, turns

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
    cam.configure(sync_mode="ramp_time", sync_out_time_s=2, slave_sync_out_position=-50).wait()
    session.mark("open: ramp_time")
    opening = cam.control(sync_cam=False)
    session.run(0.5)
    session.mark("the master stops")
    master.halt()
    opening.wait()
    session.mark("at rest")
    session.run(1.0)


def verify(recording: takt.Recording) -> None:
    begin, end = mark(recording, "open: ramp_time"), mark(recording, "at rest")
    on, off = recording.slice(0, begin), recording.slice(begin, end)
    meets("the slave on the cam", on["slave"]["set_position"], stroke(turns(on)))
    own = off["slave"]
    start = (own["set_position"][0], own["set_velocity"][0], own["set_acceleration"][0])
    time = own["time_s"] - own["time_s"][0]
    assert abs(time[-1] - 2) < 0.01
    meets("the slave", own["set_position"], quintic(2, start, (-50, 0, 0), np.minimum(time, 2)))
    meets("the slave at rest", recording.slice(end, recording.end_s)["slave"]["set_position"], -50)
