"""Parts.

A part is a set of stators that movers float over ([what it does](../../docs/parts.md)). It is enabled with the movers
of its coordinate system; forced to be disabled it takes those on it along. Parts with several positions go from one to
another, with the movers that stand on them.
"""

import takt
from takt import expect

COMMANDS = ("part.activate_position", "part.allow_enable", "part.force_disable", "part.reset")
ERRORS = (5, 3005, 3072, 3073, 3074, 3075, 3076, 3077)
SIGNALS = ("shuttle.x", "shuttle.velocity_x", "shuttle.state", "deck.state")


def scenario(session: takt.Session) -> None:
    deck, shuttle = session.part("deck"), session.mover("shuttle")
    deck.activate_position(index=1).wait()  # where it is
    session.run(0.02)
    session.mark("enabled with the mover")
    shuttle.enable().wait()
    shuttle.move_to_position(x=500, y=0)
    session.run(0.2)
    session.mark("forced to be disabled: the mover brakes")
    deck.force_disable().wait()
    session.run(0.05)
    session.mark("and on again")
    deck.allow_enable().wait()
    deck.reset().wait()
    shuttle.reset().wait()
    shuttle.enable().wait()
    shuttle.move_to_position(x=500, y=0).wait()
    shuttle.disable().wait()
    session.run(0.02)


def verify(recording: takt.Recording) -> None:
    assert recording["shuttle"]["x"][-1] == 500
    states = ["Disabled", "Enabling", "Enabled", "Disabling"]
    expect.visits_states(recording, "deck", [*states, *states, "Disabled"])
