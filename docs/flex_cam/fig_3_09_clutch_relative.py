"""3-9: closing the clutch, relative.

The slave stands 30 mm below Y, and stays so far below it.
"""

import takt
from figure import SPEED, mark, meets, ready, stroke, turns

SIGNALS = (
    "master.set_position",
    "slave.set_position",
    "flex.set_y_position",
    "slave.set_velocity",
    "flex.cam_synchronised",
)


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, slave, cam = session.axis("master"), session.axis("slave"), session.flex_cam("flex")
    master.move_absolute(position=90, velocity=180).wait()
    session.mark("the slave goes anywhere")
    slave.move_absolute(position=20, velocity=100).wait()
    session.run(0.3)
    session.mark("clutch: relative")
    cam.configure(sync_mode="relative").wait()
    cam.control(sync_cam=True).wait()
    session.run(0.3)
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    session.run(4.0)


def verify(recording: takt.Recording) -> None:
    closing, moving = mark(recording, "clutch: relative"), mark(recording, "the master turns")
    meets("the slave while the clutch closes", recording.slice(closing, moving)["slave"]["set_position"], 20)
    on = recording.slice(closing, recording.end_s)
    meets("the slave", on["slave"]["set_position"], stroke(turns(on)) - 30)
