"""Tracks.

A track is a way in the plane along which movers go. It is given by lines, circles and positions; gaps between them are
filled so that direction and curvature have no step. Its geometry is made outside the cycle: a command that changes it
is done when that is over. Tracks start where others end and end where others start: where several meet, a switch is.
What others start from or end at keeps its geometry until they are cleared. Movers use a track once it is enabled.
"""

import takt

COMMANDS = (
    "track.append_line",
    "track.append_circle",
    "track.append_position",
    "track.close_loop",
    "track.clear",
    "track.start_from_track",
    "track.end_at_track",
    "track.enable",
    "track.disable",
    "track.reset",
)
ERRORS = (5, 3005, 3050, 3070)
SIGNALS = ("main.length", "siding.length", "siding.state", "siding.previous_tracks")


def scenario(session: takt.Session) -> None:
    main, siding = session.track("main"), session.track("siding")
    session.run(0.01)
    session.mark("a line and an arc, the gap between them filled")
    main.append_line(start_x=200, start_y=120, end_x=500, end_y=120).wait()
    main.append_circle(start_x=700, start_y=300, end_x=500, end_y=500, center_x=500, center_y=300).wait()
    session.run(0.01)
    session.mark("another one starts where it ends, and leads back to its start")
    siding.start_from_track(track="main")
    siding.append_position(x=100, y=300)
    siding.end_at_track(track="main").wait()
    session.run(0.01)
    session.mark("movers may come")
    main.enable()
    siding.enable().wait()
    session.run(0.02)


def verify(recording: takt.Recording) -> None:
    assert recording["siding"]["previous_tracks"][-1] == 1
    assert recording["main"]["length"][-1] > 300 + 314
