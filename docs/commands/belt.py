"""Belts.

A belt carries objects through the cell: a photo sensor or a camera detects them, later it is told where they lay, and
whoever wants one takes it. What leaves the work range untaken is lost. A pose that comes from elsewhere carries, too:
its mover, camera or robot says where it is.
"""

import takt
from takt import expect

COMMANDS = ("belt.detect", "belt.locate", "belt.take", "belt.give_back", "belt.remove", "belt.clear", "pose.set")
ERRORS = (5, 3032, 17918)
SIGNALS = ("infeed.position", "infeed.first_place", "infeed.object_count", "infeed.lost_count", "mover.pose_x")


def scenario(session: takt.Session) -> None:
    infeed, drive = session.belt("infeed"), session.belt("infeed").axis
    drive.power().wait()
    session.mark("the belt moves, an object is seen")
    drive.move_velocity(velocity=200).wait(until="reached")
    seen = infeed.detect(kind=1)
    session.run(0.3)
    session.mark("the camera says where it lay")
    infeed.locate(number=int(seen.wait().value), x=20, y=5, c=30).wait()
    session.pose("mover").set(x=100, vx=50).wait()
    session.run(0.4)
    session.mark("a second one is taken, the first is lost")
    second = int(infeed.detect(x=0).wait().value)
    infeed.take(number=second).wait()
    session.wait(lambda: infeed.lost_count == 1)
    session.run(0.2)
    infeed.remove(number=second).wait()
    drive.halt().wait()
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "drive")
