"""AX-35, AX-43, AX-48: an axis that follows something, and is changed, ended or renumbered: it never jumps."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import takt

LIMITS = {"velocity": 500, "acceleration": 2000, "jerk": 40000}
FAST = {"velocity": 1500, "acceleration": 20000, "jerk": 4e6}
SEGMENTS = [{"to": {"x": 100, "y": 50}, "law": "modified_sine"}, {"to": {"x": 200, "y": 60}, "law": "modified_sine"}]
MACHINE = {
    "name": "followers",
    "axes": [
        {"name": "web", "unit": "mm", "limits": LIMITS},
        {"name": "other", "unit": "mm", "limits": LIMITS},
        {
            "name": "roll",
            "unit": "mm",
            "limits": FAST | {"lower": -1000, "upper": 1500},
            "drive": {"brake_closes_s": 0.05},
        },
    ],
    "cams": [{"name": "lift", "x_unit": "mm", "y_unit": "mm", "cyclic": True, "segments": SEGMENTS}],
    "flex_cams": [{"name": "module", "slave": "roll", "master": "web", "cams": ["lift"]}],
    "simulation": {"servos": [{"axis": "roll", "switches": {"reference": {"from": 30, "to": 40}}}]},
}
CYCLE_S = 0.001
Session = takt.Engine


def powered(machine: dict[str, object] = MACHINE) -> Session:
    session = takt.Engine(machine)
    for axis in session.axes.values():
        axis.power().wait()
    return session


def geared(session: Session) -> None:
    session.axis("roll").gear_in(master="web").wait(until="reached")


def geared_in_position(session: Session) -> None:
    session.axis("roll").gear_in_pos(master="web", master_sync_position=50, slave_sync_position=50)


def combined(session: Session) -> None:
    session.axis("roll").combine_axes(master1="web", master2="other").wait(until="reached")


def cammed(session: Session) -> None:
    session.axis("roll").cam_in(master="web", cam="lift").wait(until="reached")


def streamed(session: Session) -> None:
    roll = session.axis("roll")
    roll.stream(timeout=10)
    roll.stream_point(position=80)


def moved_by_a_module(session: Session) -> None:
    session.flex_cam("module").control(regulator_on=True, sync_cam=True)


def beneath_another(session: Session) -> None:
    """An override holds both where they are."""
    roll = session.axis("roll")
    roll.move_absolute(position=300, velocity=100)
    session.run(0.5)
    roll.move_superimposed(distance=50, velocity_difference=50)
    session.run(0.3)
    roll.set_override(velocity_factor=0)


FOLLOWING: list[Callable[[Session], None]] = [
    *(geared, geared_in_position, combined, cammed, streamed, moved_by_a_module, beneath_another)
]


@pytest.mark.parametrize("follow", FOLLOWING, ids=lambda follow: follow.__name__)
def test_switched_off_at_rest_the_axis_stays_where_it_is(follow: Callable[[Session], None]) -> None:
    """AX-14: while the brake closes, too."""
    session = powered()
    web, roll = session.axis("web"), session.axis("roll")
    follow(session)
    web.move_absolute(position=70).wait()
    session.run(1)
    place = roll.set_position
    assert place > 30
    off = roll.power(enable=False)
    while not off.final:
        session.run(CYCLE_S)
        assert roll.set_position == pytest.approx(place, abs=0.01)
    assert roll.state == "Disabled"


@pytest.mark.parametrize("follow", [geared_in_position, combined], ids=lambda follow: follow.__name__)
@pytest.mark.parametrize("speed", [0, 20])
def test_a_command_that_waits_for_what_is_added(follow: Callable[[Session], None], speed: float) -> None:
    """AX-35: a coupling gives way to a command that waits for what lies on top; the axis goes on as it moves."""
    session = powered()
    web, roll = session.axis("web"), session.axis("roll")
    follow(session)
    web.move_absolute(position=100).wait()
    if speed:
        web.move_velocity(velocity=speed).wait(until="reached")
    roll.move_superimposed(distance=10, velocity_difference=50)
    session.run(0.05)
    before = roll.set_position
    off = roll.power(enable=False, buffer_mode="buffered")
    while not off.final:
        session.run(CYCLE_S)
        assert 0 <= roll.set_position - before < 0.1
        before = roll.set_position
    if speed == 0:
        assert before == pytest.approx(110, abs=0.1)


def test_an_update_on_the_way_into_a_cam() -> None:
    """AX-48: a cam that is changed before its beginning is as if it had been so from the start."""
    ends = []
    for updated in (False, True):
        session = powered()
        web, roll = session.axis("web"), session.axis("roll")
        cam = {"master": "web", "cam": "lift", "master_sync_position": 200, "master_start_distance": 80}
        roll.cam_in(**cam, slave_scaling=1 if updated else 2)
        web.move_velocity(velocity=100)
        session.wait(lambda web=web: web.set_position > 150)
        if updated:
            roll.cam_in(**cam, slave_scaling=2, update=True)
        session.wait(lambda web=web: web.set_position > 250)
        ends.append((roll.set_position, roll.profile_ends))
    assert ends[0] == (pytest.approx(50), 0)
    assert ends[1] == (pytest.approx(ends[0][0], abs=1e-9), 0)


@pytest.mark.parametrize("run_s", [0.5, 3])
def test_an_update_keeps_what_was_added(run_s: float) -> None:
    """AX-35, AX-111: while it is added, which goes on, and behind its end."""
    session = powered()
    roll = session.axis("roll")
    cam = {"master": "web", "cam": "lift", "start_mode": "relative"}
    roll.cam_in(**cam, slave_scaling=0.1).wait(until="reached")
    begin = roll.set_position
    added = roll.move_superimposed(distance=100, velocity_difference=100)
    session.run(run_s)
    place = roll.set_position
    assert place > 45
    roll.cam_in(**cam, slave_scaling=0.2, update=True)
    session.step()
    assert roll.set_position == pytest.approx(place, abs=0.2)
    session.run(1.5)
    assert added.done
    assert roll.set_position == pytest.approx(begin + 100, abs=0.2)


@pytest.mark.parametrize("follow", [geared, combined, streamed, moved_by_a_module], ids=lambda follow: follow.__name__)
def test_a_reference_in_passing(follow: Callable[[Session], None]) -> None:
    """AX-67: an axis that follows has no end that its new numbers could bring behind a SW limit."""
    session = powered()
    web, roll = session.axis("web"), session.axis("roll")
    follow(session)
    web.move_velocity(velocity=100)
    if follow is streamed:
        roll.stream_point(position=120)
    found = roll.step_ref_flying_switch(switch_mode="edge_on", set_position=-985)
    session.wait(lambda: found.final, timeout=5)
    session.run(0.1)
    assert found.done
    assert (roll.error, roll.state) == (0, "SynchronizedMotion")


@pytest.mark.parametrize("jerk", [0, 5e6])
@pytest.mark.parametrize(("deceleration", "after_s"), [(2000, 0.2), (4500, 0.1)])
def test_catching_up_with_a_master_that_brakes(deceleration: float, after_s: float, jerk: float) -> None:
    """AX-14, AX-45: the axis moves no further in a cycle than its velocity limit allows."""
    web = {"velocity": 300, "acceleration": 40000, "jerk": 0}
    roll = {"velocity": 600, "acceleration": 60000, "jerk": jerk}
    axes = [{"name": "web", "unit": "mm", "limits": web}, {"name": "roll", "unit": "mm", "limits": roll}]
    with powered({"name": "braking", "axes": axes}) as session:
        session.axis("web").move_velocity(velocity=250).wait(until="reached")
        session.axis("roll").gear_in_pos(master="web", master_sync_position=0, slave_sync_position=200)
        with session.record("roll") as recorder:
            session.run(after_s)
            session.axis("web").halt(deceleration=deceleration)
            session.run(1)
        assert session.axis("roll").in_step
    takt.expect.within_limits(recorder.recording, "roll")
    takt.expect.continuous(recorder.recording, "roll")
