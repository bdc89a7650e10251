"""Pick and place modules that share a belt (PP-67)."""

from __future__ import annotations

import pytest
import takt

LIMITS = "limits: {velocity: 1500, acceleration: 15000, jerk: 300000}"
PATH = "path: {velocity: 1000, acceleration: 10000, jerk: 200000}"
RANGE, APART = 200, 300  # mm, of the range of each gantry, and from one to the next


def sharing(*of_each: str) -> str:
    """Gantries along one belt, and what is set of the belt for each."""
    names = ["left", "right", "third"][: len(of_each)]
    text = f"name: shared\naxes:\n  - {{name: drive, unit: mm, {LIMITS}}}\n"
    text += "".join(f"  - {{name: {name}_{axis}, unit: mm, {LIMITS}}}\n" for name in names for axis in "xyz")
    text += "groups:\n"
    for name in names:
        axes = ", ".join(f"{name}_{axis}" for axis in "xyz")
        text += f"  - {{name: {name}, axes: [{axes}], kinematics: {{gantry: {{axes: [x, y, z]}}}}, {PATH}}}\n"
    text += "belts:\n  - {name: belt, axis: drive, lower_limit: 0, upper_limit: 1200, origin: {y: 100}}\n"
    text += "pick_and_place:\n"
    for i, (name, own) in enumerate(zip(names, of_each, strict=True)):
        lower = APART * i + 50
        middle, upper = lower + RANGE / 2, lower + RANGE
        text += f"""  - name: {name}_picker
    group: {name}
    settings: {{tracking_mode: belt1_to_static, keep_orientation: true, x_target: {middle}, z_target: 20,
      path_velocity: 1000, path_acceleration: 10000, path_deceleration: 10000, path_jerk: 200000,
      max_velocity: [0, 0, 0, 0, 0, 0, 0], max_acceleration: [0, 0, 0, 0, 0, 0, 0], max_jerk: [0, 0, 0, 0, 0, 0, 0]}}
    belts:
      - {{belt: belt, settings: {{lower_limit: {lower}, upper_limit: {upper}, z_distance: 20,
          park_x: {middle}, park_y: 50, park_z: 60, {own}}}}}
"""
    return text


def switched_on(session: takt.Session) -> tuple[takt.Belt, list[takt.PickPlace]]:
    """The belt and all modules, with power."""
    belt, pickers = session.belt("belt"), list(session.pick_places.values())
    belt.axis.power().wait()
    for picker in pickers:
        picker.control(regulator_on=True).wait()
    session.wait(lambda: all(p.axes_enabled and p.axes_group_enabled for p in pickers), 5)
    return belt, pickers


def shares(text: str, pitch: float, products: int = 30) -> tuple[list[int], int]:
    """How many each module picked of products that come every `pitch` mm, and how many the belt lost."""
    with takt.Engine(text) as session:
        belt, pickers = switched_on(session)
        for picker in pickers:
            picker.execute()
        belt.axis.move_velocity(velocity=100)
        for _ in range(products):
            belt.detect(x=0)
            at = belt.position
            session.wait(lambda at=at: belt.position >= at + pitch, 60)
        session.wait(lambda: not belt.object_count, 60)
        session.run(1)
        picked = [picker.picked for picker in pickers]
        assert [picker.placed for picker in pickers] == picked
        return picked, belt.lost_count


def test_every_nth_workpiece() -> None:
    """2 of 3 and 1 of 3, and nothing is lost; without a rule the first takes what it can."""
    assert shares(sharing("every: 3, turns: 2", "every: 3, turn: 3"), 60) == ([20, 10], 0)
    assert shares(sharing("every: 3", "every: 3, turn: 2", "every: 3, turn: 3"), 60) == ([10, 10, 10], 0)
    assert shares(sharing("sync_time: 0", "sync_time: 0"), 90) == ([30, 0], 0)


def test_rates() -> None:
    """No more than so many a minute; the rest is the next one's."""
    (first, second), lost = shares(sharing("most_per_minute: 40", "sync_time: 0"), 60)
    assert lost == 0
    assert first + second == 30
    assert first == pytest.approx(30 * 0.6 * 40 / 60, abs=2)  # products come every 0.6 s


def test_fill() -> None:
    """The first leaves so many for those behind it before it takes one."""
    (first, second), lost = shares(sharing("leave: 2", "most_per_minute: 30"), 50)
    assert first > 3
    assert second > 3
    assert lost == 30 - first - second


@pytest.mark.parametrize("bad", ["every: 2, turn: 3", "every: 3, turn: 2, turns: 3", "every: 0"])
def test_bad_shares_are_named(bad: str) -> None:
    """Shares that no workpiece has are refused, in the file and at run time."""
    with pytest.raises(takt.ConfigError, match=r"pick_and_place\[0\].belts\[0\].settings.(turns|every)"):
        takt.Engine(sharing(bad, "sync_time: 0"))
    with takt.Engine(sharing("sync_time: 0", "sync_time: 0")) as session:
        picker = session.pick_place("left_picker")
        given = {key: int(value) for key, value in (one.split(": ") for one in bad.split(", "))}
        assert picker.configure_belt(**given).wait_final().error_id == 5
        assert picker.configure_belt(every=3, turn=2, turns=2).wait().done


@pytest.mark.parametrize("of_each", [("sync_time: 0.1", "sync_time: 0.1"), ("every: 2", "every: 2, turn: 2")])
def test_a_product_that_was_seen_twice_is_fetched_once(of_each: tuple[str, str]) -> None:
    """PP-66: the second module takes another one, where its range begins at that of the first."""
    text = sharing(*of_each).replace("lower_limit: 350, upper_limit: 550", "lower_limit: 50, upper_limit: 250")
    with takt.Engine(text) as session:
        belt, pickers = switched_on(session)
        belt.axis.move_velocity(velocity=60).wait(until="reached")
        for x in (100, 101):
            belt.detect(x=x)
        for picker in pickers:
            picker.execute()
        session.run(3)
        assert sum(picker.picked for picker in pickers) == 1
        assert (belt.object_count, sum(picker.missed for picker in pickers)) == (0, 0)


def test_leave_needs_a_range() -> None:
    """PP-67: without one nothing lies behind it; refused in the file and at run time, whichever is changed."""
    wrong = "leave must be 0 without lower_limit and upper_limit"
    text = sharing("leave: 2").replace("lower_limit: 50, upper_limit: 250, ", "")
    with pytest.raises(takt.ConfigError, match="leave: must be 0 without lower_limit and upper_limit"):
        takt.Engine(text)
    with takt.Engine(text.replace("leave: 2", "leave: 0")) as session:
        picker = session.pick_place("left_picker")
        feedback = picker.configure_belt(leave=2).wait_final()
        assert (feedback.error_id, wrong in str(feedback.sentence)) == (5, True)
        picker.configure_belt(leave=2, lower_limit=50, upper_limit=250).wait()
        feedback = picker.configure_belt(lower_limit=0, upper_limit=0).wait_final()
        assert (feedback.error_id, wrong in str(feedback.sentence)) == (5, True)


def test_leave_needs_a_range_that_ends_before_the_belt() -> None:
    """PP-67: the belt deletes what lies behind its own end; refused in the file and at run time."""
    wrong = "leave: expected 0, or an upper_limit below that of belt 'belt', 1200.0, found leave 2 with upper_limit "
    text = sharing("leave: 2")
    for upper in (1200, 1300):
        with pytest.raises(takt.ConfigError, match=f"{wrong}{upper}.0"):
            takt.Engine(text.replace("upper_limit: 250", f"upper_limit: {upper}"))
    takt.Engine(text.replace("upper_limit: 250", "upper_limit: 1199")).close()
    takt.Engine(text.replace("lower_limit: 0, upper_limit: 1200", "lower_limit: 0")).close()
    with takt.Engine(text) as session:
        picker = session.pick_place("left_picker")
        with pytest.raises(takt.CommandError, match=f"{wrong}1200.0"):
            picker.configure_belt(leave=2, lower_limit=50, upper_limit=1200).wait()
        with pytest.raises(takt.CommandError, match="leave must be 0, or upper_limit lie below that of the belt"):
            picker.configure_belt(upper_limit=1200).wait()
        picker.configure_belt(leave=0, upper_limit=1200).wait()
        with pytest.raises(takt.CommandError, match="leave must be 0, or upper_limit lie below that of the belt"):
            picker.configure_belt(leave=1).wait()
