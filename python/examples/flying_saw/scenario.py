"""A flying saw cuts a moving web at its print marks, changes to another length at full speed, and is stopped at once.

takt run python/examples/flying_saw/scenario.py       in process, in virtual time
takt demo flying_saw                                  on taktd in real time, over LCM
"""

import numpy as np
import takt
from takt import expect

TAKES_S = 17
VIEW = {
    "tab": "scope",
    "signals": (
        "web.set_velocity saw.set_velocity saw.set_position saw.following_error cutter.state cutter.cam_synchronised"
    ).split(),
}

SPEED = 500.0  # mm/s of the web
FIRST_MARK = 190.0  # mm of the web at the sensor when the first mark passes it ...
MARKS = 600.8  # mm, ... and from one to the next
SENSOR = 160.0  # mm in front of the saw's position 0
CATCH_UP = 60.0  # mm of X minus mm of the saw while it rides along
LENGTH = 600.0  # mm of X, one product
AT_SENSOR = CATCH_UP - SENSOR + LENGTH  # where X is to be when a mark passes the sensor

REGISTERED = "the marks are met"
SHORTER = "the shorter product runs"
OPENED = "opened at once"


def correct(web: takt.Axis, cutter: takt.FlexCam) -> float:
    """Waits for a mark and shifts X to where it should have been. How far it was off, in mm."""
    probe = web.arm_probe(edge="rising")
    probe.wait()
    offset = cutter.ip03_set_offset_master  # as it is set: marks come while it is still being ramped in
    x = probe.value + offset  # the web's position is X but for the offset
    error = (AT_SENSOR - x + LENGTH / 2) % LENGTH - LENGTH / 2
    cutter.control(offset_master=offset + error).wait(until="active")
    return error


def scenario(session: takt.Session) -> None:
    web, saw, cutter = session.axis("web"), session.axis("saw"), session.flex_cam("cutter")

    session.mark("power on")
    web.power().wait()
    cutter.control(regulator_on=True).wait()
    session.wait(lambda: cutter.axis_enabled)

    session.mark("the web starts, the saw gets onto its cam")
    web.move_velocity(velocity=SPEED)
    cutter.control(sync_cam=True).wait()
    assert cutter.cam_synchronised

    session.mark("mark by mark")
    off = [correct(web, cutter) for _ in range(4)]
    assert abs(off[0]) > 1, off
    assert all(abs(error) < 1 for error in off[1:]), off
    session.mark(REGISTERED)
    for _ in range(3):
        correct(web, cutter)

    session.mark("the next product is shorter")
    cutter.control(cam_table=2).wait()
    session.wait(lambda: cutter.cam_table == 2)
    session.mark(SHORTER)
    session.run(4.0)

    session.mark(OPENED)
    cutter.control(sync_out_instant=True).wait()
    session.wait(lambda: cutter.state == takt.ModuleState.READY, 2.0)
    assert abs(web.set_velocity - SPEED) < 1e-6  # the web runs on

    session.mark("and back onto the cam, over a time")
    saw.move_absolute(position=0).wait()
    cutter.control(sync_out_instant=False, sync_cam=False).wait()
    cutter.configure(sync_mode="ramp_time", sync_in_time_s=0.5).wait()
    cutter.control(sync_cam=True).wait()
    session.run(2.0)

    session.mark("the saw leaves the cam, the web stops")
    cutter.configure(sync_mode="ramp_pos").wait()
    cutter.control(sync_cam=False).wait()
    assert abs(saw.set_position) < 1e-6
    web.halt().wait()
    cutter.control(regulator_on=False).wait()
    web.power(enable=False).wait()
    session.wait(lambda: not cutter.axis_enabled)


def cuts(recording: takt.Recording, cam: int, middle: float, begin_s: float, end_s: float) -> np.ndarray:
    """Where on the web the saw is each time it rides along, in mm."""
    time, x = recording["cutter"]["time_s"], recording["cutter"]["set_x_position"]
    rides = (recording["cutter"]["cam_table"] == cam) & recording["cutter"]["cam_synchronised"].astype(bool)
    rides &= (time >= begin_s) & (time < end_s)
    passes = np.flatnonzero(rides[1:] & rides[:-1] & (x[:-1] < middle) & (x[1:] >= middle))
    assert len(passes) > 2

    def then(axis: str, field: str) -> np.ndarray:  # each component has times of its own: messages may get lost
        return np.interp(time[passes], recording[axis]["time_s"], recording[axis][field])

    speeds = then("saw", "set_velocity") - then("web", "set_velocity")
    assert np.max(np.abs(speeds)) < 1e-3 * SPEED, speeds
    return then("web", "set_position") - then("saw", "set_position") - SENSOR


def verify(recording: takt.Recording) -> None:
    at = {event.text: event.time_s for event in recording.events if event.kind == "mark"}
    places = cuts(recording, 1, 210.0, at[REGISTERED], at[SHORTER])
    off = (places - FIRST_MARK + MARKS / 2) % MARKS - MARKS / 2
    assert np.max(np.abs(off)) < 1.0, f"cuts lie {off} mm beside their marks"
    lengths = np.diff(cuts(recording, 2, 157.5, at[SHORTER], at[OPENED]))
    assert np.max(np.abs(lengths - 450)) < 0.01, f"products are {lengths} mm long"
    for axis in ("web", "saw"):
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    expect.visits_states(recording, "cutter", ["Ready", "Sync", "Ready", "Service", "Ready", "Sync", "Ready"])
    expect.stays(recording, "saw.error < 0.5")
