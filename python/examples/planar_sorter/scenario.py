"""Sixty movers sort products by colour on an L of stators: any of them to any place on two trays that come and go.

No mover has a way of its own. The program says which movers may go to which places, and gives new orders while others
are on their way; which mover takes which place, and which goes first, is planned anew with every order. What came of it
is read from the recording: products taken away, what movers did, and why they were held up.

takt run python/examples/planar_sorter/scenario.py     in process, in virtual time
takt demo planar_sorter                                on taktd in real time, over LCM
"""

from pathlib import Path

import takt
from judge import ENDS, WORKS, judge
from matplotlib.figure import Figure
from pictures import picture
from sorter import SIDE, Sorter
from takt import expect

TAKES_S = 31
VIEW = {"tab": "plan", "signals": ["m01.x", "m01.y", "red.mover_count", "blue.mover_count"]}

SECONDS = 30.0
MACHINE = Path(__file__).parent / "machine.yaml"
EVERY = 20  # cycles: 50 Hz are enough to tell who stood where


def scenario(session: takt.Session) -> None:
    play(session, SECONDS)


def play(session: takt.Session, seconds: float) -> Sorter:
    """All enabled, sorting for so long, and at rest."""
    for feedback in [mover.enable() for mover in session.movers.values()]:
        feedback.wait()
    session.mark(WORKS)
    sorter = Sorter(session)
    session.run(seconds)
    sorter.end()
    for reason, held in sorter.held_s.items():
        session.mark(f"held up by {reason}: {held:.1f} s")
    session.mark(ENDS)
    return sorter


def verify(recording: takt.Recording) -> None:
    became = judge(recording)
    print(became.sentence)
    assert became.products_a_minute > 20, became.sentence
    assert min(len(times) for times in became.delivered_s.values()) >= 8, became.sentence
    assert became.nearest > SIDE - 1e-6, f"two movers were {became.nearest:.1f} mm apart"
    assert sum(became.held_s.values()) < 0.25 * became.seconds * len(became.movers), became.sentence
    for mover in became.movers:
        expect.within_limits(recording, mover)


def pictures(recording: takt.Recording) -> dict[str, Figure]:
    with takt.Engine(MACHINE) as engine:
        machine = engine.machine
    return {"planar_sorter": picture(judge(recording), machine)}
