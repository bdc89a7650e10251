"""Torque.

The drive follows a torque on its ramp, within a velocity and an acceleration. The set point is the ramp of these
limits, and where the torque holds the axis, what is measured.
"""

import takt
from takt import expect

COMMANDS = ("torque_control",)
ERRORS = (5, 10, 11, 13, 2006, 2007, 3005)
SIGNALS = ("z.torque_nm", "z.actual_velocity", "z.actual_position", "z.state")


def scenario(session: takt.Session) -> None:
    z = session.axis("z")
    z.power().wait()
    session.mark("0.2 Nm, at most 120 mm/s", axis="z")
    z.torque_control(torque=0.2, torque_ramp=0.5, velocity=120)
    session.run(1.0)
    session.mark("halt", axis="z")
    z.halt().wait()
    session.run(0.2)


def verify(recording: takt.Recording) -> None:
    expect.stays(recording, "z.actual_velocity < 121")
    expect.visits_states(recording, "z", ["Standstill", "ContinuousMotion", "Standstill"])
