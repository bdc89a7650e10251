"""Planar movers.

A mover floats over stators and moves in six coordinates ([what it does](../../docs/movers.md)). Here it goes to a place
and, in the middle of that, to another one, turns where it stands, follows set points from outside, moves X and Y each
by itself, and goes along a track, on which another one goes along with it; then both move as one body.
"""

import takt
from takt import expect

COMMANDS = (
    "mover.enable",
    "mover.disable",
    "mover.reset",
    "mover.halt",
    "mover.set_position",
    "mover.move_to_position",
    "mover.move_z",
    "mover.move_a",
    "mover.move_b",
    "mover.move_c",
    "mover.move_x",
    "mover.move_y",
    "mover.move_relative_x",
    "mover.move_relative_y",
    "mover.move_relative_c",
    "mover.move_velocity_x",
    "mover.move_velocity_y",
    "mover.move_velocity_c",
    "mover.halt_x",
    "mover.halt_y",
    "mover.halt_z",
    "mover.halt_a",
    "mover.halt_b",
    "mover.halt_c",
    "mover.halt_on_track",
    "mover.join_track",
    "mover.leave_track",
    "mover.move_on_track",
    "mover.gear_in_pos_on_track",
    "mover.gear_in_pos_on_track_with_master_mover",
    "mover.adopt_track_orientation",
    "mover.start_external_setpoint_generation",
    "mover.set_external_setpoint",
    "mover.stop_external_setpoint_generation",
    "mover.wait",
    "mover.release",
    "mover.join_formation",
    "mover.leave_formation",
)
ERRORS = (
    *(5, 8, 3003, 3004, 3005, 3007, 3018, 3019, 3024, 3040, 3041, 3042, 3043, 3044, 3045, 3046, 3047, 3048, 3049),
    *(3051, 3060, 3070, 3071, 3072, 3076, 3077, 3080, 3081, 3082, 3083, 3090, 3091, 3092, 3093, 3094),
)
SIGNALS = ("shuttle.x", "shuttle.y", "shuttle.velocity_x", "shuttle.velocity_y", "shuttle.c", "shuttle.command_mode")


def scenario(session: takt.Session) -> None:
    shuttle = session.mover("shuttle")
    shuttle.set_position(x=60, y=60).wait()
    shuttle.enable().wait()
    session.mark("to a place, and on to another")
    shuttle.move_to_position(x=500, y=60)
    session.run(0.25)
    shuttle.move_to_position(x=600, y=160).wait()
    session.mark("turned where it stands")
    shuttle.move_z(position=3)
    shuttle.move_c(position=90).wait()
    session.mark("set points from outside")
    shuttle.start_external_setpoint_generation()
    for i in range(200):
        t = i * session.period
        shuttle.set_external_setpoint(
            x=600 - 1000 * t * t, y=160, z=3, c=90, velocity_x=-2000 * t, acceleration_x=-2000 if i else 0
        )
        session.run(session.period)
    shuttle.stop_external_setpoint_generation().wait()
    session.mark("halted on its way")
    shuttle.move_to_position(x=60, y=60)
    session.run(0.2)
    shuttle.halt().wait()
    session.run(0.1)
    session.mark("one after the other")
    shuttle.move_to_position(x=300, y=60)
    shuttle.move_to_position(x=300, y=160, buffer_mode="buffered", blending=30)
    shuttle.wait(duration=0.1, for_release=True)
    last = shuttle.move_to_position(x=60, y=60, buffer_mode="buffered")
    shuttle.release()
    last.wait()
    session.mark("x and y each by itself")
    shuttle.move_velocity_x(velocity=200).wait(until="reached")
    shuttle.move_relative_y(distance=60).wait()
    shuttle.halt_x().wait()
    shuttle.move_x(position=60)
    shuttle.move_y(position=60).wait()
    session.wait(lambda: shuttle.x == 60, 5)
    session.mark("along a track")
    session.track("line").enable().wait()
    shuttle.join_track(track="line", use_orientation=False).wait()
    shuttle.move_on_track(position=500).wait()
    shuttle.move_c(position=180).wait()
    shuttle.adopt_track_orientation().wait()
    session.mark("another goes along with it, then with an axis")
    trailer = session.mover("trailer")
    trailer.enable().wait()
    trailer.join_track(track="line", use_orientation=False).wait()
    gear = trailer.gear_in_pos_on_track_with_master_mover(
        master="shuttle", master_sync_position=500, slave_sync_position=200, follow_mover=True
    )
    gear.wait(until="reached")
    shuttle.move_on_track(position=550).wait()
    session.axis("x").power().wait()
    trailer.gear_in_pos_on_track(
        master="x",
        master_sync_position=session.axis("x").set_position,
        slave_sync_position=250,
        allowed_slave_sync_directions="both",
    ).wait(until="reached")
    trailer.halt().wait()
    trailer.leave_track(x=300, y=340, use_orientation=False).wait()  # out of the way of the other
    shuttle.leave_track(x=60, y=60, use_orientation=False).wait()
    session.mark("both as one body")
    trailer.join_formation(star="shuttle").wait(until="reached")
    shuttle.move_to_position(x=100, y=100, c=shuttle.c + 10, use_orientation=True).wait()
    trailer.leave_formation().wait()
    shuttle.disable().wait()


def verify(recording: takt.Recording) -> None:
    expect.reaches(recording, "shuttle", 600, tolerance=1e-9, by=2, signal="x")
    expect.visits_states(
        recording,
        "shuttle",
        [
            *("FreeMovement", "CRotationFreeMovement", "FreeMovement", "ExternalSetpointGeneration", "FreeMovement"),
            *("JoiningTrack", "OnTrack", "CRotationOnTrack", "OnTrack", "CRotationOnTrack", "OnTrack", "LeavingTrack"),
            "FreeMovement",
        ],
        field="command_mode",
    )
    expect.stays(recording, "shuttle.error == 0")
