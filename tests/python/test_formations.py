"""PL-73: movers that move as one body."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine

# A floor that goes round a corner, 720 mm wide, and four movers under one plate.
STATORS = [(x, y) for x in range(0, 1920, 240) for y in range(0, 720, 240)] + [
    (x, y) for x in range(1200, 1920, 240) for y in range(720, 1920, 240)
]
PLACES = {"one": (180, 240), "two": (420, 240), "three": (420, 480), "four": (180, 480)}
MACHINE = (
    "name: plate\naxes: []\nmovers:\n"
    + "".join(
        f"  - name: {name}\n    initial: {{x: {x}, y: {y}}}\n"
        "    c: {maximum: {velocity: 360, acceleration: 3600, jerk: 72000}, lower: -100, upper: 100}\n"
        for name, (x, y) in PLACES.items()
    )
    + "  - {name: spare, initial: {x: 1560, y: 1800}}\n"
    + "environments:\n  - {name: floor, stators: ["
    + ", ".join(f"{{x: {x}, y: {y}}}" for x, y in STATORS)
    + "]}\nplanar_groups:\n  - {name: cell, movers: [one, two, three, four, spare], environment: floor}\n"
)


def formed(session: takt.Session) -> takt.Mover:
    """All four go along with the first one, which is returned."""
    star = session.mover("one")
    session.planar_group("cell").enable().wait()
    for mover in session.movers.values():
        mover.enable().wait()
    for name in ("two", "three", "four"):
        session.mover(name).join_formation(star="one").wait(until="reached")
    return star


def carry(star: takt.Mover) -> None:
    """Along the floor, round its corner, and up."""
    star.move_to_position(x=1400, y=200, velocity=1500)
    star.move_to_position(x=1580, y=260, c=90, use_orientation=True, buffer_mode="buffered")
    star.move_to_position(x=1580, y=1300, buffer_mode="buffered").wait()


def test_four_movers_carry_a_plate_round_a_corner() -> None:
    """The plate keeps its shape to the last nanometre, stays on the floor, and nobody exceeds what it can do."""
    engine = Engine(MACHINE)
    star = formed(engine)
    assert [engine.mover(name).formation for name in (*PLACES, "spare")] == [1, 1, 1, 1, 0]
    assert engine.mover("three").command_mode == "Formation"
    with engine.record() as recorder:
        carry(star)
    recording = recorder.recording
    at = {name: recording.column(name, "x") + 1j * recording.column(name, "y") for name in PLACES}
    for i, one in enumerate(PLACES):
        for other in list(PLACES)[:i]:
            apart = abs(complex(*PLACES[one]) - complex(*PLACES[other]))
            assert np.max(np.abs(np.abs(at[one] - at[other]) - apart)) < 1e-9
        speed = np.hypot(recording.column(one, "velocity_x"), recording.column(one, "velocity_y"))
        acceleration = np.hypot(recording.column(one, "acceleration_x"), recording.column(one, "acceleration_y"))
        assert np.max(speed) <= 2000 * (1 + 1e-9)
        assert np.max(acceleration) <= 10000 * (1 + 1e-9)
        inside = (at[one].imag < 720 - 56.5) | (at[one].real > 1200 + 56.5)
        assert np.all(inside)
    assert np.max(recording.column("one", "velocity_x")) == pytest.approx(1500, abs=1)
    # By a quarter: what lay to the right of the first one lies above it now.
    assert engine.mover("two").x == pytest.approx(1580, abs=1e-9)
    assert engine.mover("two").y == pytest.approx(1540, abs=1e-9)
    assert engine.mover("three").c == pytest.approx(90)
    for name in ("two", "three", "four"):
        engine.mover(name).leave_formation().wait()
    engine.mover("three").move_to_position(x=1300, y=1540).wait()


def test_what_is_in_the_way_of_one_is_in_the_way_of_all() -> None:
    """PL-30: the sentence says what, and the body stays where it is."""
    engine = Engine(MACHINE)
    star = formed(engine)
    border = star.move_to_position(x=300, y=430).wait_final()
    assert border.error_id == 3024
    assert border.object is engine.environment("floor")
    engine.mover("spare").move_to_position(x=1560, y=500).wait()
    spare = star.move_to_position(x=1300, y=240).wait_final()
    assert spare.error_id == 3024
    assert spare.object is engine.mover("spare")
    assert (star.x, star.y) == (180, 240)
    with pytest.raises(takt.CommandError, match="command mode"):
        engine.mover("two").move_to_position(x=0, y=0).wait()
    with pytest.raises(takt.CommandError, match="cannot be a star"):
        engine.mover("spare").join_formation(star="two").wait(until="active")
    with pytest.raises(takt.CommandError, match="another mover"):
        engine.mover("spare").join_formation(star="spare").wait(until="active")
    star.move_to_position(x=600, y=240)
    engine.run(0.1)
    with pytest.raises(takt.CommandError, match="all that it can"):
        star.move_c(position=10).wait()


def test_a_fault_of_one_stops_all() -> None:
    engine = Engine(MACHINE)
    star = formed(engine)
    move = star.move_to_position(x=1400, y=240)
    engine.run(0.3)
    engine.mover("three").disable()
    engine.run(1)
    assert move.error_id == 3092
    assert star.velocity_x == 0
    assert star.state == "Enabled"
    assert [engine.mover(name).formation for name in PLACES] == [1, 1, 0, 1]
    assert engine.mover("three").x - star.x == pytest.approx(240, abs=1e-9)
    record = star.history()[-1]
    assert (record.verb, record.error_id) == ("move_to_position", 3092)
    star.disable().wait()
    assert engine.mover("two").formation == 0
    assert engine.mover("two").state == "Enabled"


def test_replay_is_the_same(tmp_path: Path) -> None:
    """EN-07, EN-22: over LCM, and from its log the same to the last bit."""
    url = new_url()
    log = tmp_path / "log.lcm"
    with running(tmp_path, url, "--log", str(log), machine=MACHINE), takt.connect(url) as session:
        star = formed(session)
        carry(star)
        two = session.mover("two")
        session.wait(lambda: two.y > 1539.9, 5)
        assert two.formation == 1
        two.disable().wait()
        session.wait(lambda: two.formation == 0, 5)
    result = takt.replay(log)
    assert result.same, result.sentence


def test_a_planet_says_that_what_is_buffered_waits_for_the_end_of_the_formation() -> None:  # PL-84
    with Engine(MACHINE) as engine:
        star, two = formed(engine), engine.mover("two")
        assert two.delay == "none"
        since = engine.cycle
        waits = two.move_to_position(x=900, y=240, buffer_mode="buffered")
        engine.run(0.5)
        assert waits.busy
        assert (two.delay, two.blocked_by, two.x) == ("formation", star, 420)
        assert two.delay_since < since
        two.leave_formation().wait()
        waits.wait()
        assert (two.delay, two.blocked_by, two.x) == ("none", None, pytest.approx(900))


def test_a_planet_whose_star_is_lost_begins_nothing_by_itself() -> None:
    """PL-71, PL-73: what is buffered behind the formation is aborted with its error."""
    with Engine(MACHINE) as engine:
        star, two = formed(engine), engine.mover("two")
        behind = two.move_to_position(x=900, y=240, buffer_mode="buffered")
        star.disable()
        engine.run(1)
        assert behind.aborted
        assert (two.x, two.buffered, two.formation) == (420, 0, 0)


@pytest.mark.parametrize("waits", [False, True])
def test_a_halt_of_a_planet_takes_waits_and_releases_with_it(waits: bool) -> None:
    """PL-71: as that of any mover."""
    with Engine(MACHINE) as engine:
        two = engine.mover("two")
        two.enable().wait()
        early = two.wait(for_release=True) if waits else two.release()
        engine.step(2)
        star = engine.mover("one")
        star.enable().wait()
        two.join_formation(star="one").wait(until="reached")
        two.halt().wait()
        if waits:
            assert early.aborted
        else:
            late = two.wait(for_release=True)
            engine.run(0.1)
            assert not late.final


ON_PARTS = """
name: door
axes: []
coordinate_systems: [{name: lower}, {name: upper}]
parts:
  - {name: hall, columns: 4, rows: 1, positions: [{coordinate_system: lower}]}
  - name: door
    columns: 1
    rows: 1
    travel_time_s: 0.3
    positions:
      - {coordinate_system: lower, y: 240}
      - {coordinate_system: lower, x: 240, y: 240}
      - {coordinate_system: upper}
movers:
  - {name: star, reference: door, initial: {x: 120, y: 120}}
  - {name: planet, reference: hall, initial: {x: 120, y: 120}}
  - {name: other, reference: hall, initial: {x: 360, y: 120}}
"""


@pytest.mark.parametrize("index", [2, 3])
@pytest.mark.parametrize("after_s", [0, 0.001, 0.1, 0.299, 0.3])
def test_a_star_whose_part_is_on_its_way_takes_no_planet(index: int, after_s: float) -> None:
    """PL-73, PL-80: the part would bring the star elsewhere and the planet with it, onto another mover or off all
    stators."""
    engine = Engine(ON_PARTS)
    star, planet = engine.mover("star"), engine.mover("planet")
    for mover in engine.movers.values():
        mover.enable().wait()
    going = engine.part("door").activate_position(index=index)
    if after_s:
        engine.run(after_s)
    joined = planet.join_formation(star="star")
    engine.step()
    assert joined.state.name == "ERROR"
    assert joined.error_id == 3072
    assert "door" in joined.sentence
    going.wait()
    engine.run(0.1)
    assert (planet.x, planet.y, planet.formation) == (120, 120, 0)
    later = planet.join_formation(star="star")
    if index == 2:  # in the same coordinate system again
        later.wait(until="reached")
        assert (planet.x, planet.y, star.x, star.y) == (120, 120, 360, 360)
    else:
        assert later.wait_final().error_id != 0
