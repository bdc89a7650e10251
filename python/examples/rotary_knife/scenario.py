"""A rotary knife cuts a web at 1 m/s; each product has another length, by the millimetre.

takt run python/examples/rotary_knife/scenario.py       in process, in virtual time
takt demo rotary_knife                                  on taktd in real time, over LCM
"""

import numpy as np
import takt
from takt import expect
from takt.cam_makers import Limits, RotaryKnife

TAKES_S = 23
VIEW = {
    "tab": "scope",
    "signals": "web.set_velocity knife.set_velocity knife.set_position cutter.set_x_position cutter.cam_number".split(),
}

SPEED = 1000.0  # mm/s of the web
CIRCUMFERENCE = 500.0  # mm of the circle of the blade's edge
PER_MM = 360.0 / CIRCUMFERENCE  # deg of the knife per mm of the web while it cuts
KNIFE = RotaryKnife(
    circumference=CIRCUMFERENCE,
    cut_zone=15.0,
    limits=Limits(velocity=2000, acceleration=120_000, jerk=20_000_000),
)
ORDERS = ((500.0, 4), (437.5, 5), (612.0, 4), (438.0, 3), (439.0, 3), (733.25, 4), (401.0, 5))  # mm, products

CUTTING = "the first cut"
SLOWER = "the web slows down, the length stays"
LEAVES = "the knife leaves the cam above the web"


def change_length(session: takt.Session, cutter: takt.FlexCam, length: float) -> None:
    """Makes the cam of a length, puts it into the slot that does not run, and waits for the cut after which it runs."""
    slot = 3 - cutter.cam_table
    cutter.load_cam(slot, KNIFE.cam(length, speed=SPEED, name=f"length {slot}")).wait()
    cutter.control(cam_table=slot).wait()
    session.wait(lambda: cutter.cam_table == slot, 5.0)


def scenario(session: takt.Session) -> None:
    web, cutter = session.axis("web"), session.flex_cam("cutter")

    session.mark("power on")
    web.power().wait()
    cutter.control(regulator_on=True).wait()
    session.wait(lambda: cutter.axis_enabled)

    session.mark("the web starts, the knife gets onto its cam")
    web.move_velocity(velocity=SPEED)
    cutter.control(sync_cam=True).wait()
    session.mark(CUTTING)

    for length, products in ORDERS:
        if length != CIRCUMFERENCE:
            session.mark(f"{length:g} mm")
            change_length(session, cutter, length)
        session.run(products * length / SPEED)
    in_force = cutter.cam_in_force
    assert (in_force.end, in_force.stroke) == (ORDERS[-1][0], 360.0)

    session.mark(SLOWER)
    web.move_velocity(velocity=SPEED / 4)
    session.run(3.0)

    session.mark(LEAVES)
    cutter.control(sync_cam=False).wait()
    web.halt().wait()
    cutter.control(regulator_on=False).wait()
    web.power(enable=False).wait()
    session.wait(lambda: not cutter.axis_enabled)


def cuts(recording: takt.Recording, begin_s: float, end_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Where the blade cuts, in mm of the web, and its speed over that of the web there; both as the plant has them."""
    knife, web = recording["knife"], recording["web"]
    time, angle = knife["time_s"], np.unwrap(knife["true_position"], period=360.0)
    turns = np.floor(angle / 360.0)
    after = np.flatnonzero((np.diff(turns) == 1) & (time[:-1] > begin_s) & (time[1:] < end_s)) + 1
    step, into = angle[after] - angle[after - 1], angle[after] - 360.0 * turns[after]
    at = time[after] - (time[after] - time[after - 1]) * into / step
    velocity = step / (time[after] - time[after - 1])
    place = np.interp(at, web["time_s"], web["true_position"])
    speed = (np.interp(at + 0.002, web["time_s"], web["true_position"]) - place) / 0.002
    return place, velocity / PER_MM / speed


def verify(recording: takt.Recording) -> None:
    at = {event.text: event.time_s for event in recording.events if event.kind == "mark"}
    places, ratios = cuts(recording, at[CUTTING], at[LEAVES])
    lengths = np.diff(places)
    orders = np.array([length for length, _ in ORDERS])
    which = np.abs(lengths[:, None] - orders).argmin(axis=1)
    off = np.abs(lengths - orders[which]).max()
    assert off < 0.01, f"products are up to {off} mm beside what was asked for: {lengths}"
    # In the order in which they were asked for, as many as there had to be at least.
    assert list(which[np.append(True, np.diff(which) != 0)]) == list(range(len(orders))), lengths
    assert all((which == i).sum() >= products for i, (_, products) in enumerate(ORDERS)), lengths
    assert np.abs(ratios - 1).max() < 0.002, f"the blade is up to {np.abs(ratios - 1).max():.2%} beside the web's speed"
    for axis in ("web", "knife"):
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    expect.visits_states(recording, "cutter", ["Ready", "Sync", "Ready"])
    expect.stays(recording, "knife.error < 0.5")
