"""A positioning module finds its references, measures an edge, runs coupled, stops at once and comes back.

takt run python/examples/positioning_module/scenario.py       in process, in virtual time
takt demo positioning_module                                  on taktd in real time, over LCM
"""

import takt
from takt import expect

TAKES_S = 7
VIEW = {
    "tab": "scope",
    "signals": [f"{axis}.actual_position" for axis in "xyzabc"] + [f"{axis}.state" for axis in "xyzabc"],
}

READY = "all axes have their reference"


def home(session: takt.Session) -> None:
    """Each axis in its own way, all at the same time."""
    x, y, z, a, b, c = (session.axis(name) for name in ("x", "y", "z", "a", "b", "c"))
    refused = x.move_absolute(position=0).wait_final()
    assert refused.error_id == 9, refused

    switch = x.step_abs_switch(direction="positive", switch_mode="edge_on", velocity=50)
    pulse = x.step_ref_pulse(direction="negative", velocity=5, set_position=0, buffer_mode="buffered")
    rough = y.step_limit_switch(direction="negative", switch_mode="edge_on", velocity=30)
    limit = y.step_limit_switch(  # once more, slowly: a switch is looked at once a cycle
        direction="negative", switch_mode="edge_off", velocity=3, set_position=-20, buffer_mode="buffered"
    )
    leave = y.finish_homing(distance=5, velocity=20, buffer_mode="buffered")
    block = z.step_block(direction="negative", velocity=10, deviation=1, set_position=0, time_limit=20)
    taken = [a.step_absolute(), b.step_direct(set_position=0), c.step_direct(set_position=0)]
    for step in [switch, pulse, rough, limit, leave, block, *taken]:
        step.wait()
    assert all(axis.homed for axis in session.axes.values())


def scenario(session: takt.Session) -> None:
    x, y, a, b, c = (session.axis(name) for name in ("x", "y", "a", "b", "c"))

    session.mark("power on")
    for power in [axis.power() for axis in session.axes.values()]:
        power.wait()
    session.mark("homing")
    home(session)
    session.mark(READY)

    session.mark("y measures an edge", axis="y")
    probe = y.arm_probe(edge="rising", window_only=True, first_position=50, last_position=100)
    y.move_absolute(position=95, velocity=80).wait()
    probe.wait()
    assert abs(probe.value - 83.25) < 0.01, probe.value

    session.mark("b runs geared to x, c gets into step at a place, a makes room by its cam")
    gear = b.gear_in(master="x", ratio_numerator=2)
    place = c.gear_in_pos(
        master="x",
        ratio_denominator=2,
        master_sync_position=120,
        slave_sync_position=40,
        master_start_distance=60,
    )
    raised = a.set_position
    room = a.cam_in(master="x", cam="make_room", slave_absolute=False)
    start = b.set_position
    x.move_absolute(position=125, velocity=150).wait()
    assert abs(a.set_position - (raised - 30)) < 1e-6
    x.move_absolute(position=220, velocity=150).wait()
    assert abs(a.set_position - raised) < 1e-6
    assert a.profile_ends == 1
    assert room.reached
    assert gear.reached
    assert place.reached
    assert abs(c.set_position - (40 + (220 - 120) / 2)) < 1e-6
    assert abs(b.set_position - start - 2 * 220) < 2

    session.mark("emergency stop")
    x.move_absolute(position=0, velocity=150)
    session.run(0.4)
    session.command("machine", "emergency_stop").wait()
    session.run(0.3)
    assert not any(axis.loop_closed for axis in session.axes.values())

    session.mark("and the way back")
    for power in [axis.power() for axis in session.axes.values()]:
        power.wait()
    assert all(axis.homed for axis in session.axes.values())
    for move in [axis.move_absolute(position=10) for axis in session.axes.values()]:
        move.wait()
    for axis in session.axes.values():
        axis.power(enable=False).wait()


def verify(recording: takt.Recording) -> None:
    ready = next(event.time_s for event in recording.events if event.text == READY)
    for axis in recording.components:
        expect.within_limits(recording, axis)
        expect.visits_states(recording, axis, ["Disabled", "Standstill", "DiscreteMotion", "Standstill", "Disabled"])
        expect.settles(recording, axis, 10.0, 0.05, within=recording.duration_s)
    for axis in "xyz":
        expect.visits_states(recording, axis, ["Standstill", "Homing", "Standstill"])
    expect.stays(recording, "x.homed and y.homed and z.homed and a.homed", window=(ready, recording.end_s))
    for axis in "abc":
        expect.visits_states(recording, axis, ["Standstill", "SynchronizedMotion", "Disabled"])
    expect.stays(recording, "x.error < 0.5")
