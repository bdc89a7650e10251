"""3-20: opening the clutch over a way of the master, with and without reversing.

Both slaves are to stand at 150°, which they have just passed. The one that may reverse goes back to it; the other one
goes on to the next turn.
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
    for module in modules:
        module.configure(sync_mode="absolute").wait()
        module.control(sync_cam=True).wait()
        module.configure(sync_mode="ramp_pos", master_sync_out_distance=180, slave_sync_out_position=150).wait()
    session.mark("the master turns")
    session.axis("master").move_velocity(velocity=SPEED)
    session.run(2.0)
    session.mark("open: ramp_pos")
    for opening in [module.control(sync_cam=False) for module in modules]:
        opening.wait()
    session.mark("at rest")
    session.run(1.0)


def verify(recording: takt.Recording) -> None:
    begin, end = mark(recording, "open: ramp_pos"), mark(recording, "at rest")
    opening, off = recording.slice(begin, end), recording.slice(end, recording.end_s)
    free, forward = turns(opening, "free"), turns(opening, "forward")
    master = turns(opening)
    assert free[0] > 150
    assert abs(master[-1] - master[0] - 180) < 0.5
    assert np.diff(forward).min() > -1e-9
    assert np.diff(free).min() < -0.01
    meets("the slave that may reverse", free[-1:], 150)
    meets("the slave that may not", forward[-1:], 510)
    for axis in ("free", "forward"):
        meets(f"{axis} at rest", off[axis]["set_position"], 150)
