"""Pick and place modules whose group is stopped, moved or taken away by other commands while a profile is under way."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import takt
from test_pick_place import started

Other = Callable[[takt.Engine], object]

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
