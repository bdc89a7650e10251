"""An assembly line of 32 movers: loading, two presses in lanes of their own, a bypass, a test; and a lift to a repair.

Nobody but the movers sees to it that they do not collide, where the lanes part and where they meet again: the program
only says who is to go where and for how long. What came of it is read from the recording: how many pieces, how busy the
stations were, and why movers waited.

takt run python/examples/planar_line/scenario.py      in process, in virtual time
takt demo planar_line                                 on taktd in real time, over LCM
"""

from pathlib import Path

import takt
from judge import ENDS, WORKS, judge
from line import Line
from matplotlib.figure import Figure
from pictures import picture
from takt import expect

TAKES_S = 61
VIEW = {"tab": "plan", "signals": ["m01.track_position", "m01.track_velocity", "m01.state"]}

SECONDS = 60.0
MACHINE = Path(__file__).parent / "machine.yaml"
EVERY = 20  # cycles: 50 Hz are enough to tell who stood where


def scenario(session: takt.Session) -> None:
    play(session, SECONDS)


def play(session: takt.Session, seconds: float) -> Line:
    """All onto the tracks, round for so long, and at rest."""
    for feedback in [track.enable() for track in session.tracks.values()]:
        feedback.wait()
    for feedback in [mover.enable() for mover in session.movers.values()]:
        feedback.wait()
    for feedback in [mover.join_track(track=below(mover), use_orientation=False) for mover in session.movers.values()]:
        feedback.wait()
    session.mark(WORKS)
    line = Line(session)
    session.run(seconds)
    session.mark(ENDS)
    line.ends = True
    for feedback in [mover.halt() for mover in session.movers.values()]:
        feedback.wait()
    return line


def below(mover: takt.Mover) -> str:
    """The track that it stands above at first."""
    return "back" if mover.x > 5000 else "home" if mover.y > 1000 else "supply"


def verify(recording: takt.Recording) -> None:
    became = judge(recording)
    print(became.sentence)
    assert not became.deadlocked, became.sentence
    assert became.pieces_a_minute > 25, became.sentence
    assert became.nearest > 113, f"two movers were {became.nearest:.1f} mm apart"
    for mover in became.movers:
        expect.within_limits(recording, mover)


def pictures(recording: takt.Recording) -> dict[str, Figure]:
    return {"planar_line": picture(recording, judge(recording), MACHINE.read_text(encoding="utf-8"))}
