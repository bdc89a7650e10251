"""A Delta picks from a running belt and places onto another.

Products come at random, both belts change their speeds, one path is interrupted on its way. What became of the products
is measured against where everything really was (cell.py), not against set points.

takt run python/examples/pick_cell/scenario.py       in process, in virtual time
takt demo pick_cell                                  on taktd in real time, over LCM
"""

from pathlib import Path

import numpy as np
import takt
import yaml
from cell import Cell, Settings
from judge import ENDS, GOES_ON, INTERRUPTED, WORKS, Judgement, judge
from matplotlib.figure import Figure
from picker import Picker
from pictures import picture
from takt import expect

TAKES_S = 41
VIEW = {"tab": "plan", "signals": ["robot.z", "robot.velocity", "infeed.velocity", "outfeed.velocity", "robot.state"]}

SETTINGS = Settings()
SECONDS = 40.0
INFEED, OUTFEED = 200.0, 150.0  # mm/s, in the beginning
SPEEDS = (  # s from the beginning, belt, mm/s
    (8.0, "infeed", 250.0),
    (14.0, "outfeed", 190.0),
    (22.0, "infeed", 200.0),
    (27.0, "outfeed", 160.0),
    (34.0, "infeed", 180.0),
)
INTERRUPT, REST = 24.0, 0.3  # s: from then on the next product on its way is held up, for so long

MACHINE = yaml.safe_load((Path(__file__).parent / "machine.yaml").read_text(encoding="utf-8"))


def scenario(session: takt.Session) -> None:
    play(session, SETTINGS, SECONDS, SPEEDS, INTERRUPT)


def play(
    session: takt.Session,
    settings: Settings,
    seconds: float,
    speeds: tuple[tuple[float, str, float], ...] = (),
    interrupt: float | None = None,
) -> Cell:
    """Power on, pick for so long, and off again. `speeds` of belts at times, as SPEEDS; `interrupt`, as INTERRUPT."""
    robot, picker = session.group("robot"), session.pick_place("picker")
    axes = {name: belt.axis for name, belt in session.belts.items()}
    for axis in axes.values():
        axis.power().wait()
    picker.control(regulator_on=True).wait()
    session.wait(lambda: picker.axes_enabled and picker.axes_group_enabled, 10)
    cell = Cell(session, settings)
    begins = session.now

    def change(belt: str, speed: float) -> None:
        session.mark(f"{belt} at {speed:g} mm/s")
        axes[belt].move_velocity(velocity=speed)

    def hold_up() -> None:
        session.mark(INTERRUPTED)
        picker.control(path_interrupt=True)
        cell.at(session.now + REST, go_on)

    def go_on() -> None:
        session.mark(GOES_ON)
        picker.control(path_interrupt=False)

    for at, belt, speed in ((0.0, "infeed", INFEED), (0.0, "outfeed", OUTFEED), *speeds):
        cell.at(begins + at, lambda belt=belt, speed=speed: change(belt, speed))
    if interrupt is not None:
        held_midway = lambda: cell.gripper.holds and abs(robot.y) < 60  # noqa: E731
        cell.at(begins + interrupt, lambda: cell.when(held_midway, hold_up))
    session.mark(WORKS)
    Picker(session, cell).run(begins + seconds)
    session.mark(ENDS)
    for axis in axes.values():
        axis.halt().wait()
    picker.control(regulator_on=False).wait()
    session.wait(lambda: not picker.axes_enabled, 10)
    for axis in axes.values():
        axis.power(enable=False).wait()
    return cell


def found(recording: takt.Recording) -> Judgement:
    return judge(recording, MACHINE, SETTINGS)


def verify(recording: takt.Recording) -> None:
    for axis in ("arm_1", "arm_2", "arm_3", "infeed_drive", "outfeed_drive"):
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
        expect.stays(recording, f"|{axis}.following_error| < 1")
    became = found(recording)
    print(became.sentence)
    assert len(became.placed) > 40, became.sentence
    # In real time the control, another process, may come late with a grip now and then.
    assert np.percentile(became.errors, 90) < 0.5, became.sentence
    assert became.errors.max() < 5, became.sentence
    assert all(abs(one.height) < 0.3 for one in became.placed), "a product was let fall"


def pictures(recording: takt.Recording) -> dict[str, Figure]:
    at = next(event.time_s for event in recording.events if event.text == INTERRUPTED)
    return {"pick_cell": picture(recording, MACHINE, found(recording), at)}
