"""Cam modules.

A module leads its slave after a master through one of up to four cams. `control` sets the levels at its inputs, what is
not given stays; the module closes and opens its clutch, changes cams, scales and shifts. What it is made of and what
holds of it: docs/flex_cam.md.
"""

import takt
from takt import expect

COMMANDS = (
    "flex_cam.control",
    "flex_cam.jog",
    "flex_cam.configure",
    "flex_cam.set_cam",
    "flex_cam.change_cam",
    "flex_cam.withdraw_changes",
)
ERRORS = (5, 9, 10, 3003, 3004, 3005, 3010, 3014, 3019, 3020, 20306, 20307, 20500, 20501)
SIGNALS = (
    "x.set_position",
    "knife.set_position",
    "knife.set_velocity",
    "cutter.set_x_position",
    "cutter.set_y_position",
    "cutter.state",
    "cutter.cam_table",
    "cutter.cam_synchronised",
)


def scenario(session: takt.Session) -> None:
    x, cutter = session.axis("x"), session.flex_cam("cutter")
    x.power().wait()
    cutter.control(regulator_on=True).wait()
    session.wait(lambda: cutter.axis_enabled)
    session.mark("by hand", axis="cutter")
    jog = cutter.jog(positive=True).wait(until="active")
    session.run(0.3)
    jog.release()
    jog.wait()
    session.mark("x moves")
    x.move_velocity(velocity=200).wait(until="reached")
    session.mark("onto the cam within 0.4 s", axis="cutter")
    cutter.configure(sync_mode="ramp_time", sync_in_time_s=0.4, sync_out_time_s=0.4).wait()
    cutter.control(sync_cam=True).wait()
    assert cutter.cam_synchronised
    session.run(0.8)
    session.mark("another cam from its end on", axis="cutter")
    cutter.set_cam(slot=2, cam="hop").wait()
    cutter.change_cam(cam_table=2, when="next_cycle").wait()
    cutter.change_cam(cam_table=1, when="cam_position", position=60)
    cutter.withdraw_changes().wait()
    session.run(0.8)
    session.mark("off the cam", axis="cutter")
    cutter.control(sync_cam=False).wait()
    x.halt().wait()
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    for axis in ("x", "knife"):
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    expect.visits_states(recording, "cutter", ["Ready", "JogPos", "Ready", "Sync", "Ready"])
    expect.stays(recording, "cutter.error == 0 and cutter.pending_changes <= 1")
