"""3-10: closing the clutch over a way of the master (ramp_pos).

From 100° before the sync position of 60° on, the slave goes on a curve of the fifth degree, which meets the cam there.
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
    master, slave, cam = session.axis("master"), session.axis("slave"), session.flex_cam("flex")
    cam.configure(sync_mode="ramp_pos", master_sync_in_distance=100, master_sync_in_position=60).wait()
    slave.move_absolute(position=-50, velocity=200).wait()
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    session.run(2.0)
    session.mark("clutch: ramp_pos")
    cam.control(sync_cam=True).wait()
    session.mark("on the cam")
    session.run(4.0)


def verify(recording: takt.Recording) -> None:
    on = recording.slice(mark(recording, "clutch: ramp_pos"), recording.end_s)
    x, slave = turns(on), on["slave"]["set_position"]
    meets("the slave before 320°", slave[x < 320], -50)
    meets("the slave from 420° on", slave[x > 420], stroke(x[x > 420]))
    begin = 320
    curve = (x >= begin) & (x <= 420)
    slope = 100 / 180 * 30 * (1 / 3) ** 2 * (2 / 3) ** 2
    bend = 100 / 180**2 * 60 / 3 * (2 / 3) * (1 / 3)
    end = (stroke(np.array([60.0]))[0], slope, bend)
    meets("the slave between", slave[curve], quintic(420 - begin, (-50, 0, 0), end, x[curve] - begin))
