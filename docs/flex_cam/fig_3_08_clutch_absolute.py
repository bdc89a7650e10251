"""3-8: closing the clutch, absolute.

The slave is brought to Y first, with the master at rest; then the clutch closes at once, and nothing jumps.
"""

import takt
from figure import SPEED, mark, meets, ready, stroke, turns

SIGNALS = ("master.set_position", "slave.set_position", "slave.set_velocity", "flex.cam_synchronised")


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, slave, cam = session.axis("master"), session.axis("slave"), session.flex_cam("flex")
    master.move_absolute(position=90, velocity=180).wait()
    session.mark("the slave goes to Y")
    slave.move_absolute(position=50, velocity=100).wait()
    session.run(0.3)
    session.mark("clutch: absolute")
    cam.configure(sync_mode="absolute").wait()
    cam.control(sync_cam=True).wait()
    session.run(0.3)
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    session.run(4.0)


def verify(recording: takt.Recording) -> None:
    closing, moving = mark(recording, "clutch: absolute"), mark(recording, "the master turns")
    meets("the slave while the clutch closes", recording.slice(closing, moving)["slave"]["set_position"], 50)
    on = recording.slice(closing, recording.end_s)
    meets("the slave", on["slave"]["set_position"], stroke(turns(on)))
    assert moving - closing < 0.35  # at once
