"""3-12: closing the clutch over a time (ramp_time).

What lies between the slave and Y goes to zero in two seconds, on a curve of the fifth degree, whether the master stands
or turns.
"""

import numpy as np
import takt
from figure import SPEED, mark, meets, ready, rise, stroke, turns

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
    cam.configure(sync_mode="ramp_time", sync_in_time_s=2).wait()
    master.move_absolute(position=90, velocity=180).wait()
    session.mark("at rest")
    session.run(0.3)
    session.mark("clutch: ramp_time")
    closing = cam.control(sync_cam=True)
    session.run(1.0)
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    closing.wait()
    session.mark("on the cam")
    session.run(2.0)


def verify(recording: takt.Recording) -> None:
    begin, end = mark(recording, "clutch: ramp_time"), mark(recording, "on the cam")
    assert abs(end - begin - 2) < 0.01
    on = recording.slice(begin, recording.end_s)
    left = np.clip(1 - (on["slave"]["time_s"] - begin) / 2, 0, 1)
    meets("the slave", on["slave"]["set_position"], stroke(turns(on)) - 50 * rise(left))
    on = recording.slice(end, recording.end_s)
    meets("the slave on the cam", on["slave"]["set_position"], stroke(turns(on)))
