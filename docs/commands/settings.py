"""Settings at run time.

Constants of the loop, parameters by their standard numbers, SW limits, other numbers for where the axis is, and, with
the loop open, the output itself. `set_load` says what the axis carries, where the machine file has
`drive: torque_offset`.
"""

import takt
from takt import expect

COMMANDS = (
    "set_constants",
    "set_load",
    "read_parameter",
    "write_parameter",
    "write_output",
    "set_soft_limits",
    "define_position",
    "direct_output",
    "pulse_output",
)
ERRORS = (5, 8, 12, 13, 2006, 2007, 3005)
SIGNALS = ("x.set_position", "x.set_velocity", "x.state")


def scenario(session: takt.Session) -> None:
    x = session.axis("x")
    x.power().wait()
    session.mark("the axis is at 0 from now on", axis="x")
    x.define_position(position=0).wait()
    assert x.set_position == 0
    session.mark("SW limit at 80", axis="x")
    x.set_soft_limits(lower=-100, upper=80).wait()
    refused = x.move_absolute(position=81).wait_final()
    assert refused.error_id == 8, refused
    x.move_velocity(velocity=100)
    session.run(1.0)
    assert x.state == "ErrorStop", x.state
    assert x.set_position <= 80
    assert x.set_load(load_torque=2.0).wait_final().error_id == 3005  # the machine file has no `torque_offset`
    session.mark("reset", axis="x")
    x.reset().wait()
    x.move_absolute(position=0, velocity=200).wait()
    assert x.read_parameter(number=2).wait().value == 80  # SWLimitPos


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "x")
    expect.stays(recording, "x.set_position <= 80")
    expect.visits_states(
        recording, "x", ["ContinuousMotion", "ErrorStop", "Standstill", "DiscreteMotion", "Standstill"]
    )
