"""A Delta draws what a CAM system has written.

5,000 points at up to 300 mm/s, corners blended within 0.05 mm.

takt path python/examples/delta_cell/drawing.gcode --plot drawing.png    the drawing as it is in the file
takt run python/examples/delta_cell/scenario.py       in process, in virtual time
takt demo delta_cell                                  on taktd in real time, over LCM
"""

from pathlib import Path

import takt
from matplotlib.figure import Figure
from takt import expect, toolpath
from takt.toolpath_picture import Followed, followed_picture

TAKES_S = 25
VIEW = {"tab": "plan", "signals": ["robot.velocity", "robot.path_error", "arm_1.set_velocity", "robot.state"]}

SHEET = -800.0  # mm: Z of the sheet
LIFT = 4.0  # mm above the sheet: where the drawing starts
CORNERS = 0.05  # mm: how far a blend may be beside a corner

BEGINS = "the drawing begins"
INTERRUPTED = "interrupted on the path"
GOES_ON = "and gone on with"
ENDS = "the drawing is done"


def drawing() -> toolpath.Toolpath:
    """As the robot is to draw it, in the machine's coordinates."""
    file = Path(__file__).parent / "drawing.gcode"
    return toolpath.read(file, start=(0.0, 0.0, LIFT)).shifted(z=SHEET)


def scenario(session: takt.Session) -> None:
    robot = session.group("robot")

    session.mark("power on")
    robot.power().wait()
    robot.enable().wait()
    robot.set_cartesian_transform(pcs=1, z=SHEET).wait()

    session.mark("to the sheet")
    above = robot.move_direct_absolute(x=0, y=0, z=60, coordinate_system="pcs")
    down = robot.move_linear_absolute(z=LIFT, coordinate_system="pcs", buffer_mode="buffered", velocity=200)
    above.wait()
    down.wait()

    session.mark(BEGINS)
    drawn = robot.move_path(
        path="drawing",
        coordinate_system="pcs",
        transition_mode="max_corner_deviation",
        transition_parameter=CORNERS,
    )
    session.run(8.0)
    session.mark(INTERRUPTED)
    robot.interrupt().wait()
    assert robot.interrupted
    session.run(0.2)
    session.mark(GOES_ON)
    robot.continue_path().wait()
    drawn.wait()
    session.mark(ENDS)

    session.mark("and away")
    robot.move_direct_absolute(x=0, y=0, z=80, coordinate_system="pcs").wait()
    robot.disable().wait()
    robot.power(enable=False).wait()


def times(recording: takt.Recording) -> dict[str, float]:
    return {event.text: event.time_s for event in recording.events if event.kind == "mark"}


def verify(recording: takt.Recording) -> None:
    path, at = drawing(), times(recording)
    window = (at[BEGINS], at[ENDS])
    expect.follows_path(recording, "robot", path, CORNERS + 0.001, window=window)
    expect.follows_path(recording, "robot", path, 0.4, actual=True, window=window)
    expect.stays(recording, "robot.path_error < 0.5", window=window)
    # It stops at no corner: jerk and bound leave 9 mm/s at the sharpest, of 150 deg. All of the path is tried before it
    # begins.
    for begin, end in ((at[BEGINS] + 0.5, at[INTERRUPTED]), (at[GOES_ON] + 0.05, at[ENDS])):
        expect.stays(recording, "robot.velocity > 5", window=(begin, end - 0.05))
    for axis in ("arm_1", "arm_2", "arm_3"):
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
        expect.stays(recording, f"|{axis}.following_error| < 0.3")
    expect.visits_states(recording, "robot", ["GroupDisabled", "GroupStandby", "GroupMoving", "GroupStandby"])
    seconds = window[1] - window[0]
    assert 20 < seconds < 40, f"drawing took {seconds} s"


def pictures(recording: takt.Recording) -> dict[str, Figure]:
    at = times(recording)
    followed = Followed.of(drawing(), recording, "robot", at[BEGINS], at[ENDS])
    return {
        "drawing": followed_picture(followed, "A Delta draws 5,000 points", bound=CORNERS, detail=(11.05, 20.55, 1.2))
    }
