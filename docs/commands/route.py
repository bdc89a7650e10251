"""Routes of movers.

Movers on the free surface go along routes, and let one another pass in an order that is planned
([how](../../docs/surface.md)). Here the guest goes over the crossing first; the shuttle is halted on its way and goes
on, and on its way back it is held in a place before it goes on.
"""

import takt
from takt import expect

COMMANDS = ("mover.set_route", "mover.continue_route", "start_routes", "hold_routes")
ERRORS = (5, 3004, 3024, 3040, 3041, 3052, 3071, 3072)
SIGNALS = ("shuttle.x", "shuttle.y", "guest.x", "guest.y", "shuttle.route_visit", "guest.route_visit", "shuttle.delay")


def scenario(session: takt.Session) -> None:
    shuttle, guest = session.mover("shuttle"), session.mover("guest")
    shuttle.set_position(x=420, y=180).wait()
    guest.set_position(x=540, y=60).wait()
    shuttle.enable()
    guest.enable().wait()
    session.mark("the guest goes first")
    up = [{"x": 540, "y": 60 + 120 * k} for k in range(4)]
    across = [{"x": 420 + 120 * k, "y": 180} for k in range(5)]
    across[1] |= {"after": 2, "after_visit": 1}  # mover 2 is the guest
    there = guest.set_route(first=guest.route_visit, visits=up)
    shuttle.set_route(first=shuttle.route_visit, visits=across)
    session.command("machine", "start_routes", {"velocity": 600}).wait()
    session.wait(lambda: shuttle.x > 560, 5)
    session.mark("halted, and on")
    shuttle.halt().wait()
    shuttle.continue_route().wait()
    there.wait()
    session.mark("held in a place, and on")
    places = [{"x": place["x"], "y": place["y"]} for place in reversed(across)]
    back = shuttle.set_route(first=shuttle.route_visit, visits=places)
    session.command("machine", "start_routes", {"velocity": 600}).wait()
    session.run(0.2)
    session.command("machine", "hold_routes").wait()
    session.run(0.3)
    session.command("machine", "hold_routes", {"hold": False}).wait()
    back.wait()


def verify(recording: takt.Recording) -> None:
    expect.reaches(recording, "shuttle", 900, tolerance=1e-9, by=3, signal="x")
    expect.stays(recording, "guest.error == 0")
    crossed = recording["guest"]["route_visit"] >= 2
    assert recording["shuttle"]["x"][~crossed].max() < 540
    assert recording["shuttle"]["x"][-1] == 420
