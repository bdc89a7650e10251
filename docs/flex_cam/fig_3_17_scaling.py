"""3-17: scaling the master by 0.5 and the slave by 2.0, on a cam from 0 to 180.

Both factors are given amid a cycle and taken over where the cam begins anew: from there on a cycle takes 360° of the
master instead of 180°, and moves the slave by 360 mm instead of 180 mm.
"""

import numpy as np
import takt
from figure import SPEED, mark, meets, ready, rise, turns

SIGNALS = ("master.set_position", "flex.set_x_position", "slave.set_position", "slave.set_velocity")


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, cam = session.axis("master"), session.flex_cam("flex")
    cam.control(cam_table=3, sync_cam=True).wait()
    session.mark("the master turns")
    master.move_velocity(velocity=2 * SPEED)
    session.run(1.5)
    session.mark("factors 0.5 and 2.0")
    cam.control(scaling_master=0.5, scaling_slave=2.0).wait()
    session.wait(lambda: cam.set_scaling_slave == 2)
    session.mark("in force")
    session.run(4.0)


def verify(recording: takt.Recording) -> None:
    master, slave = turns(recording), recording["slave"]["set_position"]
    time = recording["slave"]["time_s"]
    assert 180 < master[time >= mark(recording, "factors 0.5 and 2.0")][0] < 360 < 720 < master[-1]

    def feed(x: np.ndarray) -> np.ndarray:
        return np.asarray(180 * (x // 180 + rise(np.mod(x, 180) / 180)))

    scaled = 360 + 2 * feed(0.5 * (master - 360))
    meets("the slave", slave, np.where(master < 360, feed(master), scaled))
    meets("the factors", recording["flex"]["set_scaling_slave"], np.where(master < 360, 1, 2))
    meets("the factors", recording["flex"]["set_scaling_master"], np.where(master < 360, 1, 0.5))
