"""3-18: an offset of 10 for the master and 20 for the slave, on a cam from 0 to 180.

Both are ramped in: X gets 10° ahead of the master, the slave 20 mm ahead of Y, and nothing jumps.
"""

import numpy as np
import takt
from figure import SPEED, mark, meets, ready, rise, turns

SIGNALS = ("master.set_position", "flex.set_x_position", "slave.set_position", "slave.set_velocity")


def scenario(session: takt.Session) -> None:
    ready(session, "flex")
    master, cam = session.axis("master"), session.flex_cam("flex")
    cam.configure(
        offset_mode_master="ramp_in",
        offset_mode_slave="ramp_in",
        offset_scaling_master_velocity=20,
        offset_scaling_slave_velocity=40,
        jerk=10000,
    ).wait()
    cam.control(cam_table=3, sync_cam=True).wait()
    session.mark("the master turns")
    master.move_velocity(velocity=SPEED)
    session.run(1.0)
    session.mark("offsets 10 and 20")
    cam.control(offset_master=10, offset_slave=20).wait()
    session.run(5.0)


def verify(recording: takt.Recording) -> None:
    master, slave = turns(recording), recording["slave"]["set_position"]
    time, given = recording["slave"]["time_s"], mark(recording, "offsets 10 and 20")

    def feed(x: np.ndarray) -> np.ndarray:
        return np.asarray(180 * (x // 180 + rise(np.mod(x, 180) / 180)))

    meets("the slave", slave[time < given], feed(master[time < given]))
    # The longer ramp: its way at its velocity, and half of its ramps with the jerk.
    ended = given + 0.5 + 40 / 1000 + 1000 / 10000 + 0.01
    meets("the slave with both", slave[time > ended], feed(master[time > ended] + 10) + 20)
    jumps = np.abs(np.diff(slave))
    assert jumps.max() < 0.001 * (1.875 * (SPEED + 20) + 40)
