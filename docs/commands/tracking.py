"""Going along with what moves.

A group takes its tool along with an object on a belt or a table, by itself; moves in the object's coordinate system run
on top. A coordinate system can also go along with the tool of another group, or with a pose from elsewhere.

Where tracking begins and ends is counted from where the belt's axis was when the object was seen
(`recorded_position`).
"""

import numpy as np
import takt
from takt import expect

COMMANDS = ("group.set_dyn_coord_transform", "group.track_conveyor_belt", "group.track_rotary_table")
ERRORS = (5, 1000, 3005, 3010, 3021, 3022, 3025, 3027, 3028, 3029, 3030)
SIGNALS = (
    *("portal.x", "portal.y", "infeed.position"),
    *("portal.velocity", "infeed.velocity"),
    "portal.track_state",
    "portal.interrupted",
)


def scenario(session: takt.Session) -> None:
    portal, infeed, table = session.group("portal"), session.belt("infeed"), session.belt("table")
    portal.power().wait()
    portal.enable().wait()
    portal.move_linear_absolute(x=0, y=0).wait()
    for belt in (infeed, table):
        belt.axis.power().wait()
    infeed.axis.move_velocity(velocity=100).wait(until="reached")
    session.mark("from 20 mm on it gets into step, within 40 mm")
    seen = infeed.axis.set_position
    track = portal.track_conveyor_belt(
        belt="infeed", recorded_position=seen, start_distance=20, end_distance=220, sync_in_conveyor_distance=40
    )
    track.wait(until="reached")
    session.mark("a move on top")
    portal.move_linear_absolute(x=0, y=20, coordinate_system="pcs").wait()
    session.mark("interrupted and continued")
    portal.interrupt().wait()
    session.run(0.1)
    portal.continue_path().wait()
    track.wait()
    session.mark("to a table and along with it")
    portal.set_dyn_coord_transform(pcs=2, carrier="table", x=40).wait()
    table.axis.move_velocity(velocity=60).wait(until="reached")
    portal.move_linear_absolute(x=0, y=0, coordinate_system="pcs", pcs=2).wait()
    session.run(0.5)
    session.mark("off it again")
    portal.move_linear_absolute(x=0, y=0).wait()
    infeed.axis.halt()
    table.axis.halt().wait()


def verify(recording: takt.Recording) -> None:
    for axis in "xyz":
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    states = recording["portal"]["track_state"]
    assert set(states) == {0, 1, 2, 3, 4}
    rests = (states == 3) & (recording["portal"]["path_velocity"] == 0)
    assert np.nanmax(np.abs(recording["portal"]["object_x"][rests])) < 1e-9
