"""3-7: running a cam once.

After its end the slave stays where the cam has brought it, while the master turns on.
"""

import numpy as np
import takt
from figure import SPEED, meets, ready, rise, turns

SIGNALS = ("master.set_position", "flex.set_x_position", "slave.set_position", "slave.set_velocity")


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, cam = session.axis("master"), session.flex_cam("flex")
    cam.configure(cam_cyclic=False).wait()
    cam.control(cam_table=3, sync_cam=True).wait()
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    session.run(6.0)


def verify(recording: takt.Recording) -> None:
    x = turns(recording)
    assert x[-1] > 500
    meets("the slave", recording["slave"]["set_position"], 180 * rise(np.minimum(x / 180, 1)))
    assert recording["flex"]["cam_ends"][-1] == 1
