"""Pick and place modules whose group is stopped, moved or taken away by other commands while a profile is under way."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import takt
from test_pick_place import started

Other = Callable[[takt.Engine], object]
READY = takt.PickPlaceState.READY


def a_fault(engine: takt.Engine) -> None:
    picker = engine.pick_place("picker")
    picker.execute(0)
    engine.run(0.1)
    engine.axis("x").power(enable=False)
    engine.run(0.5)
    assert picker.state is takt.PickPlaceState.ERROR
    picker.control(reset_error=True)
    engine.run(1)
    picker.control(reset_error=False)


def enabled_by_others(engine: takt.Engine) -> None:
    picker, group = engine.pick_place("picker"), engine.group("portal")
    picker.control(stop_all=True)
    engine.run(0.3)
    group.enable()
    engine.run(0.3)
    picker.control(stop_all=False)


@pytest.mark.parametrize(
    "before", [lambda engine: None, a_fault, enabled_by_others], ids=["nothing", "fault", "others"]
)
def test_a_disable_of_its_group_is_not_undone(before: Other) -> None:
    """PP-20: whatever the module was about to enable before; profiles never go on by themselves."""
    engine = started()
    picker, group = engine.pick_place("picker"), engine.group("portal")
    before(engine)
    engine.run(0.5)
    assert (picker.state, picker.axes_group_enabled) == (READY, True)
    placed = picker.placed
    going = picker.execute(0)
    engine.run(0.1)
    group.disable()
    engine.run(0.8)
    assert going.aborted
    assert (picker.state, picker.placed, picker.axes_group_enabled) == (READY, placed, False)


REFUSALS: dict[str, tuple[Other, int]] = {
    "disabled": (lambda engine: engine.group("portal").disable(), 3025),
    "stopped": (lambda engine: engine.group("portal").stop(hold=True), 6),
    "off": (lambda engine: engine.group("portal").power(enable=False), 10),
}


@pytest.mark.parametrize("cause", REFUSALS)
@pytest.mark.parametrize("what", ["execute", "home_execute", "return_to_path", "jog"])
def test_a_refusal_names_what_the_group_lacks(cause: str, what: str) -> None:
    """PP-63: that it is disabled, held by a stop, or that its axes are off."""
    engine = started()
    picker = engine.pick_place("picker")
    act, error = REFUSALS[cause]
    act(engine)
    engine.run(0.5)
    picker.control(select_axis="x").wait()
    asked = picker.jog(positive=True) if what == "jog" else picker.control(**{what: True})
    engine.run(0.05)
    assert asked.error_id == error
