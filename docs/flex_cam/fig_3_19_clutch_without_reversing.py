"""3-19: closing the clutch over a way of the master, with and without reversing.

Both slaves stand at 90° and are to be on the cam at the master's 360°, where Y is 0°. The one that may reverse takes
the short way back; the other one goes up to the next turn.
"""

import numpy as np
import takt
from figure import SPEED, mark, meets, ready, turns

SIGNALS = (
    "master.set_position",
    "free.set_position",
    "forward.set_position",
    "free.set_velocity",
    "forward.set_velocity",
)


def scenario(session: takt.Session) -> None:
    ready(session, "flex_free", "flex_forward")
    modules = [session.flex_cam("flex_free"), session.flex_cam("flex_forward")]
    for move in [module.slave.move_absolute(position=90, velocity=360) for module in modules]:
        move.wait()
    for module in modules:
        module.configure(master_sync_in_distance=180, master_sync_in_position=0).wait()
    session.mark("the master turns")
    session.axis("master").move_velocity(velocity=SPEED)
    session.run(0.5)
    session.mark("clutch: ramp_pos")
    for closing in [module.control(sync_cam=True) for module in modules]:
        closing.wait()
    session.mark("on the cam")
    session.run(3.0)


def verify(recording: takt.Recording) -> None:
    begin, end = mark(recording, "clutch: ramp_pos"), mark(recording, "on the cam")
    closing, on = recording.slice(begin, end), recording.slice(end, recording.end_s)
    free, forward = turns(closing, "free"), turns(closing, "forward")
    assert abs(turns(closing)[-1] - 360) < 0.5
    assert np.diff(forward).min() > -1e-9
    assert np.diff(free).min() < -0.01
    meets("the slave that may reverse", free[-1:], 0, 0.5)
    meets("the slave that may not", forward[-1:], 360, 0.5)
    for axis, module in (("free", "flex_free"), ("forward", "flex_forward")):
        off = on[axis]["set_position"] - on[module]["op02_set_y_position_out"]
        meets(f"{axis} on the cam", np.mod(off + 180, 360) - 180, 0)
