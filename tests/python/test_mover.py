"""Planar movers as scenarios see them: the manual's programs, and what comes on top of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import msgs

MACHINE = """
name: plane
axes: []
movers:
  - {name: one}
  - {name: two, initial: {x: 300, y: -300, c: 45}, missing_setpoints: 100}
"""


@pytest.fixture
def engine() -> takt.Engine:
    return takt.Engine(MACHINE)


@pytest.fixture
def mover(engine: takt.Engine) -> takt.Mover:
    mover = engine.mover("one")
    mover.enable().wait()
    return mover


def test_a_session_has_movers(engine: takt.Engine) -> None:
    """PL-01, PL-03."""
    assert list(engine.movers) == ["one", "two"]
    assert engine.mover("one").parameters["xy"]["maximum"]["velocity"] == 2000
    assert "Disabled" in repr(engine.mover("one"))
    with pytest.raises(takt.TaktError, match="did you mean 'two'"):
        engine.mover("tow")
    engine.step()
    assert engine.mover("one").command_mode == "FreeMovement"
    assert engine.mover("two").command_mode == "CRotationFreeMovement"


def test_to_a_position(engine: takt.Engine) -> None:
    """PL-50, example 6.1.3: enabled, a mover goes to (100, 100). By its state, not by feedback."""
    mover = engine.mover("one")
    mover.enable()
    engine.wait(lambda: mover.state == "Enabled", 1)
    mover.move_to_position(x=100, y=100)
    engine.run(1)
    assert (mover.x, mover.y) == (100, 100)
    assert (mover.actual_x, mover.actual_y) == (100, 100)
    assert not mover.busy_xyc


def test_auxiliary_coordinates(engine: takt.Engine, mover: takt.Mover) -> None:
    """PL-50, example 6.1.5."""
    mover.move_a(position=1)
    mover.move_b(position=-1)
    mover.move_c(position=3)
    mover.move_z(position=5)
    engine.step()
    assert mover.busy_z
    engine.run(2)
    assert (mover.a, mover.b, mover.c, mover.z) == (1, -1, 3, 5)
    assert mover.command_mode == "FreeMovement"
    assert not mover.busy_z


def follow(engine: takt.Engine, mover: takt.Mover) -> float:
    """The manual's profile: jerk up to 10 mm/s² and down to none; the velocity at its end."""
    x, v, a, jerk, dt = 0.0, 0.0, 0.0, 1.0, engine.period
    mover.set_external_setpoint(x=x)
    engine.step()
    while True:
        x += dt * v + dt * dt / 2 * a + dt**3 / 6 * jerk
        v += dt * a + dt * dt / 2 * jerk
        a += dt * jerk
        mover.set_external_setpoint(x=x, velocity_x=v, acceleration_x=a)
        engine.step()
        assert mover.x == x
        if a >= 10:
            jerk = -1.0
        if a <= 0:
            return v


def test_external_set_points(engine: takt.Engine, mover: takt.Mover) -> None:
    """PL-13, PL-50, example 6.1.6: a profile that ends with a speed; the stop brings it to rest."""
    start = mover.start_external_setpoint_generation()
    v = follow(engine, mover)
    assert v == pytest.approx(100, abs=0.1)
    assert mover.command_mode == "ExternalSetpointGeneration"
    assert start.state == takt.FeedbackState.ACTIVE
    before = mover.x
    mover.stop_external_setpoint_generation().wait()
    assert start.state == takt.FeedbackState.DONE
    assert mover.command_mode == "FreeMovement"
    assert mover.velocity_x == 0
    assert before < mover.x < before + 10


def test_a_missing_set_point_is_an_error(engine: takt.Engine, mover: takt.Mover) -> None:
    """PL-13."""
    start = mover.start_external_setpoint_generation()
    follow(engine, mover)
    with pytest.raises(takt.CommandError, match="missing"):
        start.wait()
    engine.wait(lambda: mover.state == "Error", 1)
    assert mover.error == start.error_id == 3043
    mover.reset().wait()
    assert mover.state == "Enabled"


def test_turned_out_of_its_window(engine: takt.Engine, mover: takt.Mover) -> None:
    """PL-10, PL-50, example 6.1.8: at 20° it is in another mode; at 90° it is back."""
    mover.move_c(position=20).wait()
    assert (mover.c, mover.command_mode) == (20, "CRotationFreeMovement")
    with pytest.raises(takt.CommandError, match="command mode"):
        mover.move_to_position(x=1, y=1).wait()
    mover.move_c(position=90).wait()
    assert (mover.c, mover.command_mode) == (90, "FreeMovement")
    mover.move_c(position=0, direction="positive", additional_turns=1).wait()
    assert mover.c == 720


def test_feedback(engine: takt.Engine) -> None:
    """PL-02, PL-50, example 6.7.1: to (1000, 1000), each step when the one before is done."""
    mover = engine.mover("one")
    feedback = mover.enable()
    seen = []
    state = 1
    for _ in range(5000):
        engine.step()
        if state == 1 and feedback.done:
            feedback = mover.move_to_position(x=1000, y=1000)
            state = 3
        elif state == 3:
            seen.append(feedback.state)
    assert seen[0] == takt.FeedbackState.ACTIVE
    assert seen[-1] == takt.FeedbackState.DONE
    assert (mover.x, mover.y) == (1000, 1000)


def test_too_much_is_reduced(engine: takt.Engine, mover: takt.Mover) -> None:
    """PL-03."""
    with engine.record("one") as recorder:
        mover.move_to_position(x=2000, y=0, velocity=9000).wait()
    assert mover.limited_by == "velocity"
    table = recorder.recording["one"]
    assert table["velocity_x"].max() == pytest.approx(2000)
    assert np.abs(table["acceleration_x"]).max() <= 10000 * (1 + 1e-9)


def test_the_last_commands(engine: takt.Engine, mover: takt.Mover) -> None:
    """PL-70."""
    mover.move_z(position=99)
    first = mover.move_to_position(x=500, y=0, velocity=9000)
    engine.step(10)
    mover.move_to_position(x=0, y=0).wait()
    records = mover.history()
    assert [record.verb for record in records] == ["enable", "move_z", "move_to_position", "move_to_position"]
    assert [record.state.name for record in records] == ["DONE", "ERROR", "ABORTED", "DONE"]
    assert records[1].error_id == 8
    assert [record.limited_by for record in records] == ["nothing", "nothing", "velocity", "nothing"]
    assert records[2].ticket == first.ticket
    assert records[2].changed - records[2].cycle == 10
    for _ in range(200):
        mover.halt().wait()
    assert len(mover.history()) == 100
    assert {record.verb for record in mover.history()} == {"halt"}
    assert mover.commands == 204


def test_the_same_twice() -> None:
    """EN-06: bit for bit."""
    hashes = []
    for _ in range(2):
        engine = takt.Engine(MACHINE, journal=True)
        mover = engine.mover("one")
        mover.enable().wait()
        mover.move_to_position(x=300, y=20)
        engine.run(0.15)
        mover.move_to_position(x=300, y=200, c=5, use_orientation=True).wait()
        hashes.append(engine.take_hashes()[1].tolist())
    assert hashes[0] == hashes[1]
    assert len(set(hashes[0])) == len(hashes[0])


def test_shut_down(engine: takt.Engine, mover: takt.Mover) -> None:
    move = mover.move_to_position(x=1000, y=0)
    engine.run(0.2)
    assert mover.velocity_x > 0
    engine.shut_down()
    assert (mover.state, mover.velocity_x) == ("Disabled", 0)
    assert move.aborted


def test_the_same_over_lcm(tmp_path: Path) -> None:
    """PL-50, EN-20: example 6.1.3 and the modes of 6.1.8 from another process."""
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        mover = session.mover("one")
        mover.enable().wait()
        session.wait(lambda: mover.state == "Enabled")
        mover.move_to_position(x=100, y=100).wait()
        session.wait(lambda: (mover.x, mover.y, mover.busy_xyc) == (100, 100, False))
        mover.move_c(position=20).wait()
        session.wait(lambda: mover.command_mode == "CRotationFreeMovement" and mover.c == 20)
        with pytest.raises(takt.CommandError, match="command mode"):
            mover.move_to_position(x=0, y=0).wait()
        told = [(record.verb, record.state.name, record.error_id) for record in mover.history()]
        assert told == [
            ("enable", "DONE", 0),
            ("move_to_position", "DONE", 0),
            ("move_c", "DONE", 0),
            ("move_to_position", "ERROR", 3041),
        ]
        assert all(0 <= record.cycle <= record.begun <= record.changed for record in mover.history())


def rows_of(session: takt.Session) -> list[tuple[object, ...]]:
    """The history of a mover that gets commands of every end; cycles relative to that which took the command."""
    mover = session.mover("one")
    mover.move_x(position=1)  # is refused by the mover
    mover.enable().wait()
    with pytest.raises(takt.CommandError):
        session.command("one", "nonsense").wait()  # refused before any mover has it
    with pytest.raises(takt.CommandError):
        session.command("one", "move_x", "{x: }").wait()
    first = mover.move_to_position(x=500, y=0, velocity=9000)
    aborted = mover.move_to_position(x=0, y=0, buffer_mode="buffered")
    session.run(0.1)
    mover.halt().wait()
    assert first.aborted
    assert aborted.aborted
    mover.move_z(position=99)
    mover.move_to_position(x=300, y=0, velocity=100)
    mover.move_to_position(x=0, y=0, buffer_mode="buffered").wait()
    stop = session.emergency_stop(hold=True)
    session.run(0.1)
    with pytest.raises(takt.CommandError, match="emergency stop"):
        mover.enable().wait()
    stop.release()
    return [
        (r.ticket > 0, r.verb, r.state.name, r.error_id, r.cycle >= 0, r.begun > r.cycle, r.limited_by)
        for r in mover.history()
    ]


def test_the_last_commands_are_the_same_over_lcm(engine: takt.Engine, tmp_path: Path) -> None:
    """PL-70, PL-85: those that movers have taken, a buffered one begun in the cycle that took it until it begins."""
    url = new_url()
    rows = rows_of(engine)
    verbs = ["move_x", "enable", "move_to_position", "move_to_position", "halt", "move_z"]
    assert [row[1] for row in rows] == [*verbs, "move_to_position", "move_to_position"]
    assert [row[5] for row in rows] == [False] * 7 + [True]
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        assert rows_of(session) == rows


def test_set_position_and_enable_in_one_cycle() -> None:
    """PL-11: the position that was measured before is no deviation."""
    engine = takt.Engine("name: plane\naxes: []\nmovers: [{name: one, deviation: 2}]\n")
    one = engine.mover("one")
    put, on = one.set_position(x=500, y=100), one.enable()
    engine.run(0.01)
    assert put.done
    assert on.done, on.sentence
    assert (one.state, one.x, one.actual_x) == ("Enabled", 500, 500)


@pytest.mark.parametrize("velocity", [0, 200])
def test_what_is_reached_is_told_with_its_cycle(engine: takt.Engine, mover: takt.Mover, velocity: float) -> None:
    """PL-02: a velocity that is reached and a move that is done, each with the cycle in which it came to be so."""
    if velocity:
        move = mover.move_velocity_x(velocity=velocity)
        engine.wait(lambda: move.reached, 5)
        assert mover.velocity_x == pytest.approx(velocity)
    else:
        move = mover.move_x(position=50)
        engine.wait(lambda: move.done, 5)
    assert move.cycle == engine.cycle - 1


def test_a_refused_release_of_a_mover_is_told(engine: takt.Engine) -> None:
    """PY-20: `release` of a mover is a command like any other, not the release of a level-sensitive one."""
    refused = engine.mover("two").release()
    engine.step()
    assert engine.unheeded == [refused]
    assert refused.error_id == 3040


def test_a_release_given_up_is_not_sent_again(tmp_path: Path) -> None:
    """EN-22: as any command of a mover that the engine has not answered in time."""
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        sent: list[msgs.command] = []
        publish = session._publish

        def losing(channel: str, data: bytes) -> None:
            if channel == "takt/command":
                sent.append(msgs.command.decode(data))
            else:
                publish(channel, data)

        session._publish = losing  # type: ignore[method-assign]
        session._answer_s = 0.2
        for give_up in (session.mover("one").release, session.mover("one").halt):
            with pytest.raises(takt.ConnectionError, match="does not answer"):
                give_up()
            count = len(sent)
            session.run(1.0)
            assert len(sent) == count
