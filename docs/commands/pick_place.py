"""Pick and place modules.

A pick and place module moves a group between static places and workpieces on belts
([what it does](../../docs/pick_and_place.md)). Here it picks two workpieces from a belt that runs, puts them down at a
static place, and parks.
"""

import takt
from takt import expect

COMMANDS = (
    "pick_place.control",
    "pick_place.configure",
    "pick_place.configure_belt",
    "pick_place.jog",
    "pick_place.reset_counters",
)
ERRORS = (5, 9, 10, 1003, 3003, 3005, 3010, 3021, 3022, 3023, 3024, 3031, 20306, 20307, 20500, 20501)
SIGNALS = ("picker.position_[xyz]", "picker.synchronised", "picker.pulse_gripper", "picker.state")


def scenario(session: takt.Session) -> None:
    picker, belt = session.pick_place("picker"), session.belt("infeed")
    picker.control(regulator_on=True)
    drive = session.axis("drive")
    drive.power().wait()
    drive.move_velocity(velocity=40).wait(until="reached")
    session.mark("two workpieces")
    belt.detect(x=60, y=5)
    belt.detect(x=20, y=0)
    for _ in range(2):
        picker.execute(1).wait()
        picker.execute(0).wait()
    session.mark("a tracking mode finds no more: it parks")
    picker.configure(tracking_mode="belt1_to_static")
    loop = picker.execute()
    session.run(1)
    picker.control(path_stop=True)
    session.run(0.5)
    picker.control(path_stop=False)
    picker.abort()
    session.run(0.2)
    assert loop.aborted


def verify(recording: takt.Recording) -> None:
    for axis in "xyz":
        expect.within_limits(recording, axis)
