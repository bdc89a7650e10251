"""Groups of movers, and environments.

A mover of a group asks for the area that it needs before it moves ([what is reserved](../../docs/planar_groups.md)).
Here one is refused, as another one stands on its way, and as it would leave the stators of the part it is on; then the
other leaves.
"""

import takt

COMMANDS = (
    "planar_group.enable",
    "planar_group.disable",
    "planar_group.reset",
    "environment.add_stator",
    "environment.create_boundary",
    "environment.clear",
    "environment.add_to_group",
    "environment.remove_from_group",
    "mover.add_to_group",
    "mover.remove_from_group",
    "track.add_to_group",
    "track.remove_from_group",
)
ERRORS = (3024, 3060, 3061, 3062, 3063, 3064, 3065, 3066)
SIGNALS = ("shuttle.x", "shuttle.y", "guest.y", "cell.state", "cell.mover_count", "floor.border_count")


def scenario(session: takt.Session) -> None:
    cell, floor = session.planar_group("cell"), session.environment("floor")
    shuttle, guest = session.mover("shuttle"), session.mover("guest")
    session.run(0.01)
    session.mark("stators, and the border around them")
    for x in (600, 840, 1080):
        floor.add_stator(lower_x=x, lower_y=720)
    floor.create_boundary().wait()
    shuttle.set_position(x=720, y=840).wait()
    shuttle.enable()
    guest.enable().wait()
    session.mark("all into the group, which is enabled")
    floor.add_to_group(group="cell")
    shuttle.add_to_group(group="cell")
    guest.add_to_group(group="cell").wait()
    cell.enable().wait()
    session.mark("refused: the guest stands on the way, the stators end")
    assert shuttle.move_to_position(x=1200, y=840).wait_final().object is guest
    assert shuttle.move_to_position(x=720, y=1180).wait_final().object is session.part("deck")
    session.run(0.05)
    session.mark("the guest leaves the group, and the stators")
    guest.remove_from_group().wait()
    guest.move_to_position(x=900, y=1100).wait()
    shuttle.move_to_position(x=1200, y=840).wait()
    session.run(0.05)


def verify(recording: takt.Recording) -> None:
    assert recording["floor"]["border_count"][-1] == 4
    assert recording["shuttle"]["x"][-1] == 1200
    assert recording["shuttle"]["y"].max() == 840
