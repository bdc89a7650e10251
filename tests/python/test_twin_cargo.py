"""PY-23: belts, products, grippers and light barriers of a twin."""

from __future__ import annotations

import math
import re
import shutil
from pathlib import Path

import pytest
import takt
from takt.ready import EXAMPLES

mujoco = pytest.importorskip("mujoco")

from takt.twin import Twin, judge  # noqa: E402
from takt.twin import command as twin_command  # noqa: E402

MACHINE = """name: carry
axes:
  - {name: x, unit: mm, limits: {velocity: 500, acceleration: 3000, jerk: 60000}}
  - {name: z, unit: mm, limits: {velocity: 500, acceleration: 3000, jerk: 60000}}
  - {name: drive, unit: mm, limits: {velocity: 500, acceleration: 2000, jerk: 60000}}
groups:
  - name: robot
    axes: [x, z]
    kinematics: {gantry: {axes: [x, z]}}
    path: {velocity: 400, acceleration: 3000, jerk: 60000}
belts:
  - {name: line, axis: drive, source: actual_value, origin: {x: 0, y: 0, z: -100}}
twin:
  axes:
    - {axis: x, mass: 2, max_torque: 300}
    - {axis: z, mass: 2, max_torque: 300}
    - {axis: drive, mass: 5, max_torque: 300}
  mechanisms:
    - {group: robot, gripper: {reach: 2, force: 20}}
  belts:
    - {belt: line, from: -200, to: 300, width: 100, surface: -20, barrier: -50}
  products: {count: 2, length: 30, width: 40, height: 20, mass: 0.1}
"""


def powered(text: str) -> takt.Engine:
    engine = takt.Engine(text, plant="mujoco")
    for power in [axis.power() for axis in engine.axes.values()]:
        power.wait()
    engine.group("robot").enable().wait()
    return engine


def test_a_belt_carries_what_a_gripper_puts_elsewhere() -> None:
    """Carried by friction, seen by barrier and camera, gripped, put down; nothing touches what it must not."""
    with powered(MACHINE) as engine:
        assert isinstance(engine.plant, Twin)
        cargo, record = engine.plant.cargo, engine.record()
        assert cargo is not None
        drive, robot = engine.axis("drive"), engine.group("robot")
        edges = [drive.arm_probe(edge="rising"), drive.arm_probe(edge="falling")]
        number = cargo.put("line", x=-150, y=5, c=0)
        drive.move_absolute(position=150).wait()
        assert [edge.value for edge in edges] == [pytest.approx(85, abs=0.2), pytest.approx(115, abs=0.2)]
        (seen,) = cargo.camera("line")
        assert (seen.number, seen.x, seen.y, seen.z) == (
            number,
            pytest.approx(0, abs=0.2),
            pytest.approx(5, abs=0.1),
            pytest.approx(0, abs=0.1),
        )
        assert not cargo.camera("line", begin=10)

        cargo.move(number, dy=-5)
        gripper = cargo.grippers["robot"]
        robot.move_linear_absolute(x=0, z=-100, coordinate_system="mcs").wait()
        gripper.close()
        engine.run(0.05)
        assert gripper.holds == number
        robot.move_linear_absolute(x=0, z=-40, coordinate_system="mcs").wait()
        robot.move_linear_absolute(x=100, z=-100, coordinate_system="mcs").wait()
        assert cargo.position(number) == pytest.approx([100, 0, -100], abs=0.3)
        gripper.open()
        engine.run(0.1)
        assert gripper.holds is None
        robot.move_linear_absolute(x=100, z=-40, coordinate_system="mcs").wait()
        judged = judge(engine.plant, record.stop())
        assert judged.passed, [verdict.sentence for verdict in judged.verdicts]
        assert judged.products is not None
        assert judged.products.put == 1
        assert judged.products.moved[1] < 0.1

        drive.move_relative(distance=250).wait()
        assert cargo.here == ()  # taken off at the end of the belt


def test_what_goes_wrong_with_products_is_judged_and_said() -> None:
    """A gripper that is too weak, a product beside the belt, tools that run into products, more than there are."""
    with powered(MACHINE.replace("force: 20", "force: 0.5")) as engine:
        assert isinstance(engine.plant, Twin)
        cargo, robot, record = engine.plant.cargo, engine.group("robot"), engine.record()
        assert cargo is not None
        number = cargo.put("line")
        robot.move_linear_absolute(x=0, z=-100, coordinate_system="mcs").wait()
        cargo.grippers["robot"].close()
        engine.run(0.05)
        robot.move_linear_absolute(x=0, z=-60, coordinate_system="mcs").wait()
        (verdict,) = [v for v in judge(engine.plant, record.stop()).verdicts if v.name == "twin.products"]
        assert not verdict.passed
        assert "pulled off with more than 0.5 N" in verdict.sentence
        with pytest.raises(takt.TaktError, match=r"X 500, Y 0 mm is not on it"):
            cargo.put("line", x=500)
        with pytest.raises(takt.TaktError, match=r"no belt 'lime' \(it has line\)"):
            cargo.put("lime")
        with pytest.raises(takt.TaktError, match="there is no product 9 in the machine"):
            cargo.position(9)
        other = cargo.put("line", x=-150)
        with pytest.raises(takt.TaktError, match=r"all 2 products are in the machine \(twin.products.count\)"):
            cargo.put("line", x=-100)
        cargo.move(other, dy=80)
        engine.run(0.3)
        assert cargo.here == (number,)
        assert [fell for fell, _ in cargo.fallen] == [other]


@pytest.mark.parametrize("then", ["taken out", "gripped again", "left alone"])
def test_only_a_product_that_lies_where_it_was_put_is_judged(then: str) -> None:
    """What is taken out or gripped again, before it has come to rest, did not move on its belt."""
    with powered(MACHINE.replace("force: 20", "force: 20, acts_s: 0.005")) as engine:
        assert isinstance(engine.plant, Twin)
        cargo, robot = engine.plant.cargo, engine.group("robot")
        assert cargo is not None
        number, gripper = cargo.put("line"), cargo.grippers["robot"]
        robot.move_linear_absolute(x=0, z=-100, coordinate_system="mcs").wait()
        gripper.close()
        engine.wait(lambda: gripper.holds == number)
        gripper.open()
        engine.wait(lambda: gripper.holds is None)
        if then == "taken out":
            cargo.take(number)
        elif then == "gripped again":
            gripper.close()
            engine.wait(lambda: gripper.holds == number)
            robot.move_linear_absolute(x=0, z=-60, coordinate_system="mcs").wait()
        engine.run(0.1)
        put = next(one for one in cargo.handled if one.number == number)
        assert (put.lost, math.isnan(put.moved)) == ("", then != "left alone")


def test_what_of_belts_and_products_the_loader_refuses(tmp_path: Path) -> None:
    """With line and key, and without MuJoCo."""
    cases = {
        MACHINE.replace("{belt: line,", "{belt: lime,"): "expected the name of a belt, found 'lime'",
        MACHINE.replace("    - {axis: drive, mass: 5, max_torque: 300}\n", ""): "expected its axis in twin.axes",
        MACHINE.replace("from: -200, to: 300", "from: 300, to: 300"): "expected an end behind the beginning",
        MACHINE.replace("mass: 0.1}", "mass: 0}"): "twin.products.mass: expected",
        MACHINE.replace("count: 2", "count: 0"): "twin.products.count: expected",
        MACHINE.replace("  products: {count: 2, length: 30, width: 40, height: 20, mass: 0.1}\n", ""): (
            "expected products that it can hold (twin.products), found none"
        ),
        MACHINE.replace("source: actual_value,", "source: actual_value, ratio: 2,"): "a belt whose ratio is 1",
        MACHINE.replace("height: 20, ", ""): "height",
    }
    for text, said in cases.items():
        file = tmp_path / "machine.yaml"
        file.write_text(text)
        with pytest.raises(takt.ConfigError) as caught:
            takt.Engine(file)
        assert said in str(caught.value), (said, str(caught.value))
        assert re.search(r"machine\.yaml:\d+:\d+: twin", str(caught.value)), str(caught.value)


def test_the_pick_cell_in_the_twin(tmp_path: Path) -> None:
    """Belts, camera, gripper and products are MuJoCo's: a few are picked and placed, within what the cell allows."""
    folder = shutil.copytree(EXAMPLES / "pick_cell", tmp_path / "cell")
    file = folder / "short.py"
    file.write_text(SHORT)
    ran = twin_command.run(EXAMPLES / "pick_cell" / "machine.yaml", takt.scenario.load_scenario(file), compare=False)
    said = [verdict.sentence for verdict in ran.outcome.verdicts if not verdict.passed]
    assert ran.outcome.passed, (said, ran.outcome.complaint)
    assert ran.judged.products is not None
    assert ran.judged.products.put >= 2
    assert ran.judged.products.beside[1] < 0.5


SHORT = '''"""The first seconds of the pick cell."""
from cell import Settings
from judge import judge
from scenario import MACHINE, play

SETTINGS = Settings(noise=0.0, slip=0.0, slides=0.0)

def scenario(session):
    play(session, SETTINGS, 4.0, ((0.0, "infeed", 200.0), (0.0, "outfeed", 150.0)))

def verify(recording):
    found = judge(recording, MACHINE, SETTINGS)
    assert len(found.placed) >= 2, found.sentence
    assert found.errors.max() < 0.3, found.sentence
'''


def test_belts_in_a_row_hand_products_on() -> None:
    """What lies beyond the end of one belt is on another one."""
    text = MACHINE
    for before, added in (
        ("groups:", "  - {name: other, unit: mm, limits: {velocity: 500, acceleration: 2000, jerk: 60000}}\n"),
        ("twin:", "  - {name: next, axis: other, source: actual_value, origin: {x: 600, y: 0, z: -100}}\n"),
        ("  mechanisms:", "    - {axis: other, mass: 5, max_torque: 300}\n"),
        ("  products:", "    - {belt: next, from: -300, to: 300, width: 100, surface: -20}\n"),
    ):
        text = text.replace(before, added + before, 1)
    with powered(text) as engine:
        assert isinstance(engine.plant, Twin)
        cargo = engine.plant.cargo
        assert cargo is not None
        number = cargo.put("line", x=250)
        engine.step(30)
        assert cargo.here == (number,)
        for distance, there in ((200, (number,)), (500, ())):
            for move in [engine.axis(name).move_relative(distance=distance) for name in ("drive", "other")]:
                move.wait()
            engine.run(0.2)
            assert cargo.here == there
            assert [seen.number for seen in cargo.camera("next")] == list(there)
        assert cargo.fallen == []
