"""3-14: opening the clutch over a way of the master (ramp_pos).

While the master goes on by 200°, the slave gets to its sync-out position on a curve of the fifth degree, and stands.
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
    cam.configure(sync_mode="ramp_pos", master_sync_out_distance=200, slave_sync_out_position=-50).wait()
    session.mark("open: ramp_pos")
    cam.control(sync_cam=False).wait()
    session.mark("at rest")
    session.run(1.0)


def verify(recording: takt.Recording) -> None:
    begin, end = mark(recording, "open: ramp_pos"), mark(recording, "at rest")
    on, off = recording.slice(0, begin), recording.slice(begin, end)
    meets("the slave on the cam", on["slave"]["set_position"], stroke(turns(on)))
    x, own = turns(off), off["slave"]
    start = (own["set_position"][0], own["set_velocity"][0] / SPEED, own["set_acceleration"][0] / SPEED**2)
    meets("the slave", own["set_position"], quintic(200, start, (-50, 0, 0), np.minimum(x - x[0], 200)))
    assert abs(x[-1] - x[0] - 200) < 0.5
    meets("the slave at rest", recording.slice(end, recording.end_s)["slave"]["set_position"], -50)
