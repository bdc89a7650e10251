"""Distance-coded reference marks (AX-111, MC_StepDistanceCoded of PLCopen Part 5)."""

from __future__ import annotations

import pytest
import takt
from takt.plcopen import MC_StepDistanceCoded

DISTANCE = 20.0
MARKS = f"coded_marks: {{distance: {DISTANCE}, step: 0.02, position: -100}}"


def machine(start: float, *, marks: str = MARKS, more: str = "", encoder: str = "") -> str:
    return f"""
name: coded
axes:
  - name: x
    limits: {{velocity: 500, acceleration: 5000, jerk: 100000}}
    encoder: {{increments_per_unit: 1000, {marks}}}
    {more}
simulation:
  servos:
    - axis: x
      mechanics: {{start_position: {start}}}
      {encoder}
"""


@pytest.mark.parametrize("invert", [False, True])
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("direction", ["positive", "negative"])
@pytest.mark.parametrize("start", [-17.3, 0.0, 61.234])
def test_the_position_is_known_after_two_marks(start: float, direction: str, reverse: bool, invert: bool) -> None:
    """AX-111: from anywhere, either way, on scales either way round: the axis knows where its load really is."""
    at = -200 - start if reverse else start
    marks = MARKS.replace("}", ", reversed: true}") if reverse else MARKS
    with takt.Engine(machine(at, marks=marks + (", invert: true" if invert else ""))) as s:
        x = s.axis("x")
        x.power().wait()
        x.step_distance_coded(direction=direction, velocity=50).wait()
        assert x.homed
        assert x.state.value == "Standstill"
        s.run(0.1)
        assert x.actual_position == pytest.approx(x.true_position, abs=0.0015)
        assert abs(x.true_position - at) < 2 * DISTANCE


def test_the_block_and_home_do_the_same() -> None:
    """AX-111: MC_StepDistanceCoded; `home` with that method."""
    with takt.Engine(machine(33.0, more="homing: {method: distance_coded, direction: positive, velocity: 40}")) as s:
        x = s.axis("x")
        x.power().wait()
        x.home().wait()
        s.run(0.1)
        assert x.actual_position == pytest.approx(x.true_position, abs=0.0015)
        x.step_direct(set_position=0).wait()
        block = MC_StepDistanceCoded(x, Direction="negative", Velocity=40.0, Execute=True)
        for _ in range(4000):
            block()
            if block.Done:
                break
            s.step(1)
        assert block.Done
        s.run(0.1)
        assert x.actual_position == pytest.approx(x.true_position, abs=0.0015)


def test_marks_that_are_no_neighbours_end_the_search() -> None:
    """AX-111: a scale of another code is told, not believed (3104); so are ends of the search (1, 2)."""
    plain = "encoder: {increments_per_unit: 1000, index_distance: 10, index_offset: 3}"
    with takt.Engine(machine(0.0, encoder=plain)) as s:
        x = s.axis("x")
        x.power().wait()
        refused = x.step_distance_coded(velocity=50).wait_final()
        assert refused.error_id == 3104
        assert "coded_marks" in str(refused.sentence)
        assert not x.homed
        s.run(0.5)
        assert x.state.value == "Standstill"
        assert x.step_distance_coded(velocity=5, time_limit=0.1).wait_final().error_id == 1
        s.run(0.5)
        assert x.step_distance_coded(velocity=5, distance_limit=1).wait_final().error_id == 2


@pytest.mark.parametrize("velocity", [150, 300, 450])
def test_two_marks_in_a_cycle_are_no_pair(velocity: float) -> None:
    """AX-111: a search that is too fast for the latch never takes a wrong position."""
    fast = machine(0.0, marks="coded_marks: {distance: 0.5, step: 0.01, position: -3}").replace("1000,", "10000,")
    with takt.Engine(fast) as s:
        x = s.axis("x")
        x.power().wait()
        ended = x.step_distance_coded(velocity=velocity, distance_limit=40).wait_final()
        s.run(0.5)
        assert ended.error_id in (2, 3104) or abs(x.actual_position - x.true_position) < 0.002


def test_an_encoder_without_coded_marks_is_refused() -> None:
    with takt.Engine(machine(0.0, marks="offset: 0")) as s:
        s.axis("x").power().wait()
        refused = s.axis("x").step_distance_coded(velocity=50).wait_final()
        assert refused.error_id == 3105
        assert "coded_marks" in str(refused.sentence)


@pytest.mark.parametrize(
    ("marks", "said"),
    [
        ("coded_marks: {distance: 20, step: 11}", "half of distance"),
        ("coded_marks: {distance: 20, step: 0.001}", "four counts"),
        ("coded_marks: {distance: 0, step: 0.02}", "distance"),
        ("coded_marks: {distance: 20}", "step"),
    ],
)
def test_marks_that_cannot_be_are_refused(marks: str, said: str) -> None:
    with pytest.raises(takt.ConfigError, match=said):
        takt.Engine(machine(0.0, marks=marks))


def test_homing_by_marks_needs_marks() -> None:
    homing = "homing: {method: distance_coded, velocity: 40, direction: positive}"
    with pytest.raises(takt.ConfigError, match="coded_marks for method distance_coded"):
        takt.Engine(machine(0.0, marks="offset: 0", more=homing))
