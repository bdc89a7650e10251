"""3-6: running a cam cyclically.

The cam is 240° long, the master's turn 360°. Each cycle of the cam begins where the one before ends, wherever the
master is then.
"""

import numpy as np
import takt
from figure import SPEED, meets, ready, stroke, turns

SIGNALS = ("master.set_position", "flex.set_x_position", "slave.set_position", "slave.set_velocity")


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, cam = session.axis("master"), session.flex_cam("flex")
    cam.control(cam_table=2, sync_cam=True).wait()
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    session.run(12.0)


def verify(recording: takt.Recording) -> None:
    x = turns(recording)
    meets("the slave", recording["slave"]["set_position"], stroke(x, 240))
    assert recording["flex"]["cam_ends"][-1] == np.floor(x[-1] / 240) == 4
