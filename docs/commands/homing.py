"""Finding the reference.

Step by step: search a switch or an index pulse, then finish. Each step is Done with the axis still Homing, until a
finishing step gives it its numbers. References may also be taken in passing, during another move. And home does all of
it at once, as the section `homing` of the axis says.
"""

import takt
from takt import expect

COMMANDS = (
    "home",
    "step_abs_switch",
    "step_limit_switch",
    "step_block",
    "step_ref_pulse",
    "step_distance_coded",
    "step_direct",
    "step_absolute",
    "finish_homing",
    "step_ref_flying_switch",
    "step_ref_flying_ref_pulse",
    "abort_passive_homing",
)
ERRORS = (1, 2, 5, 8, 10, 11, 13, 2004, 2005, 3005, 3006, 3104, 3105)
SIGNALS = ("x.set_position", "x.set_velocity", "x.reference", "x.homed", "x.state")


def scenario(session: takt.Session) -> None:
    x = session.axis("x")
    x.power().wait()
    session.mark("the switch, fast", axis="x")
    x.step_abs_switch(direction="positive", switch_mode="edge_on", velocity=80).wait()
    session.mark("the index pulse, slowly", axis="x")
    x.step_ref_pulse(direction="negative", velocity=10, set_position=0).wait()
    assert x.homed
    session.mark("in passing", axis="x")
    flying = x.step_ref_flying_switch(switch_mode="edge_on", set_position=6)
    x.move_relative(distance=40, velocity=60).wait()
    assert flying.done
    session.mark("all at once", axis="x")
    x.home(position=0).wait()
    assert x.homed
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    expect.within_limits(recording, "x")
    expect.visits_states(
        recording, "x", ["Standstill", "Homing", "Standstill", "DiscreteMotion", "Standstill", "Homing", "Standstill"]
    )
