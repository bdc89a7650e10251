"""GR-12, GR-13: paths are checked against what stands in the cell before they start."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import _core

AXES = "".join(
    f"  - {{name: {name}, unit: deg, limits: {{velocity: 800, acceleration: 20000, jerk: 1000000}}, "
    "encoder: {increments_per_unit: 10000}}\n"
    for name in ("arm1", "arm2", "arm3")
)
DELTA = f"""\
name: cell
lcm: {{axis_rate_hz: 1000}}
axes:
{AXES}groups:
  - name: robot
    axes: [arm1, arm2, arm3]
    kinematics: {{delta: {{base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}}}
    path: {{velocity: 1000, acceleration: 20000, jerk: 1000000}}
    workspace:
      margin: 5
      bounds: {{upper: {{z: -650}}}}
      obstacles:
        - {{name: post, cylinder: {{radius: 10, height: 300}}, pose: {{x: 100, z: -1000}}}}
      links:
        - {{link: upper_arm, capsule: {{radius: 20}}}}
        - {{link: lower_arm, capsule: {{radius: 6}}}}
      gripper:
        - {{name: finger, cylinder: {{radius: 8, height: 60}}, pose: {{z: -30}}}}
paths:
  - name: along
    elements:
      - {{shape: line, to: {{x: 0, y: 60, z: -830}}}}
      - {{shape: line, to: {{x: 50, y: 60, z: -830}}}}
      - {{shape: line, to: {{x: 50, y: 0, z: -830}}}}
      - {{shape: line, to: {{x: 150, y: 0, z: -830}}}}
  - name: around
    elements:
      - {{shape: line, to: {{x: 0, y: 60, z: -830}}}}
      - {{shape: line, to: {{x: 150, y: 60, z: -830}}}}
"""


@contextmanager
def cell(text: str = DELTA, *, journal: bool = False, folder: Path | None = None) -> Iterator[takt.Group]:
    """The group of an engine, powered, enabled, at x 0, y 0, z -830."""
    machine: str | Path = text
    if folder:
        machine = folder / "cell.yaml"
        machine.write_text(text)
    with takt.Engine(machine, journal=journal) as engine:
        prepare(engine.group("robot"))
        yield engine.group("robot")


def prepare(robot: takt.Group) -> None:
    robot.power().wait()
    robot.enable().wait()
    robot.move_direct_absolute(z=-830, coordinate_system="mcs").wait()


def refusal(move: takt.Feedback, error_id: int = 3024) -> str:
    with pytest.raises(takt.CommandError) as raised:
        move.wait()
    assert move.error_id == error_id
    assert str(raised.value).endswith(f"{move.sentence} (error {error_id})")
    return move.sentence


def test_a_line_through_a_post_is_refused() -> None:
    """The finger with its radius of 8 comes nearer than 5 mm to the post of 10 mm about x 100, at x 77."""
    with cell() as robot:
        before = robot.pose
        move = robot.move_linear_absolute(x=200)
        sentence = refusal(move)
        assert sentence.startswith("finger meets post ")
        assert sentence.endswith(" mm along the path (5 mm are to be kept)")
        assert robot.blocked_at == pytest.approx(77, abs=0.6)
        assert f" {robot.blocked_at:.1f} mm" in sentence
        robot.session.run(0.2)
        assert robot.pose == before
        assert robot.state is takt.GroupState.GROUP_STANDBY
        assert robot.trouble is takt.Trouble.COLLISION
        assert robot.in_the_way == ("finger", "post")
        assert robot.blocked_element == 0


def test_a_line_beside_it_runs() -> None:
    with cell() as robot:
        robot.move_linear_absolute(y=60).wait()
        robot.move_linear_absolute(x=200).wait()
        assert robot.pose[:3] == pytest.approx((200, 60, -830), abs=1e-6)
        assert robot.trouble is takt.Trouble.NONE
        assert robot.in_the_way == ()


@pytest.mark.parametrize(
    ("named", "ignored", "meets"),
    [("post_2", "post", "post_2"), ("post_2", "post_2", "post"), ("pile_2", "pile", "post")],
)
def test_ignore_means_the_obstacle_of_that_name(named: str, ignored: str, meets: str) -> None:
    """GR-13: a name is that of one thing; only a name that nothing has stands for all that begin with it."""
    obstacle = f"        - {{name: {named}, cylinder: {{radius: 10, height: 300}}, pose: {{x: 60, z: -1000}}}}\n"
    pairs = ", ".join(f"[{part}, {ignored}]" for part in ("finger", "lower_arm", "upper_arm"))
    text = DELTA.replace("      links:", obstacle + "      links:")
    text = text.replace("      gripper:", f"      ignore: [{pairs}]\n      gripper:")
    with cell(text) as robot:
        assert refusal(robot.move_linear_absolute(x=200)).startswith(f"finger meets {meets} ")


def test_a_direct_move_and_a_bound() -> None:
    with cell() as robot:
        sentence = refusal(robot.move_direct_absolute(x=200, coordinate_system="mcs"))
        assert sentence.startswith("finger meets post ")
        assert " units along the path" in sentence
        sentence = refusal(robot.move_linear_absolute(z=-600))
        assert sentence == "tool leaves the workspace at its bound upper z 180.0 mm along the path"
        assert robot.in_the_way == ("tool", "upper z")


def test_bounds_are_those_of_the_tool_centre_point() -> None:
    text = DELTA.replace("    workspace:\n", "    tool: {z: -100}\n    workspace:\n")
    with cell(text.replace("upper: {z: -650}", "upper: {z: -750}")) as robot:
        assert robot.z == pytest.approx(-830)
        robot.move_linear_absolute(z=-760).wait()
        assert "upper z 10." in refusal(robot.move_linear_absolute(z=-700))


def test_a_blend_into_an_obstacle_is_refused() -> None:
    """Both lines pass the post well; what rounds the corner between them does not."""
    text = DELTA.replace("pose: {x: 100, z: -1000}", "pose: {x: 95, y: 25, z: -1000}")
    for deviation, free in ((1, True), (40, False)):
        with cell(text) as robot:
            first = robot.move_linear_absolute(x=120)
            second = robot.move_linear_absolute(
                y=120,
                buffer_mode="blending_next",
                transition_mode="max_corner_deviation",
                transition_parameter=deviation,
            )
            if free:
                second.wait()
                continue
            sentence = refusal(second)
            assert sentence.startswith("finger meets post ")
            assert sentence.endswith(", where the corner before it is rounded")
            assert robot.on_blend
            first.wait_final()
            assert first.done
            assert robot.pose[:3] == pytest.approx((120, 0, -830), abs=1e-6)


def test_several_moves_queued() -> None:
    """What is free is gone; what is not ends, and takes with it what waits behind it."""
    with cell() as robot:
        moves = [
            robot.move_linear_absolute(y=60),
            robot.move_linear_absolute(x=60, buffer_mode="blending_next"),
            robot.move_linear_absolute(x=180, y=-60, buffer_mode="blending_next"),
            robot.move_linear_absolute(x=0, buffer_mode="buffered"),
        ]
        for move in moves:
            move.wait_final()
        assert [move.state.name for move in moves] == ["DONE", "DONE", "ERROR", "ABORTED"]
        assert moves[2].sentence.startswith("finger meets post ")
        robot.session.wait(lambda: robot.in_position)
        assert robot.pose[:3] == pytest.approx((60, 60, -830), abs=1e-6)


def test_an_element_of_a_path_is_named_and_nothing_has_moved() -> None:
    """GR-12: the fourth element goes through the post; not even the first one is begun."""
    with cell() as robot:
        before = robot.pose
        sentence = refusal(robot.move_path(path="along"))
        assert sentence.startswith("finger meets post ")
        assert sentence.endswith(", in element 4")
        assert robot.blocked_element == 4
        assert robot.blocked_at == pytest.approx(60 + 50 + 60 + 27, abs=0.6)
        robot.session.run(0.2)
        assert robot.pose == before
        robot.move_path(path="around").wait()
        robot.move_linear_absolute(x=0).wait()


def test_an_element_out_of_reach_is_named() -> None:
    """GR-12: the same without a workspace."""
    text = DELTA[: DELTA.index("    workspace:")] + DELTA[DELTA.index("paths:") :].replace(
        "x: 150, y: 0", "x: 1500, y: 0"
    )
    with cell(text) as robot:
        before = robot.pose
        move = robot.move_path(path="along")
        assert refusal(move, 3021).endswith(", in element 4")
        assert move.value == 4
        robot.session.run(0.2)
        assert robot.pose == before


def write_wall(file: Path) -> None:
    """A wall of two triangles at x 0.1 m, as STL in metres."""
    corners = [(0.1, -0.3, -1.2), (0.1, 0.3, -1.2), (0.1, 0.3, -0.85), (0.1, -0.3, -0.85)]
    triangles = [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for p in t for c in p), 0) for t in triangles)
    file.write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + facets)


WALL = DELTA.replace(
    "name: post, cylinder: {radius: 10, height: 300}", "name: wall, mesh: {file: wall.stl, scale: 1000}"
)
WALL = WALL.replace("pose: {x: 100, z: -1000}", "pose: {}")


def test_a_mesh_stands_in_the_way(tmp_path: Path) -> None:
    """Its file lies beside the machine file."""
    write_wall(tmp_path / "wall.stl")
    with cell(WALL, folder=tmp_path) as robot:
        robot.move_linear_absolute(y=60).wait()
        assert refusal(robot.move_linear_absolute(x=200)).startswith("finger meets wall ")
        assert robot.blocked_at == pytest.approx(87, abs=0.6)
        assert robot.in_the_way == ("finger", "wall")


def text_wall(head: str = "solid wall", number: str = "{}") -> str:
    """The wall of `write_wall` in mm, as text."""
    corners = [(100, -300, -1200), (100, 300, -1200), (100, 300, -850), (100, -300, -850)]
    lines = [head]
    for triangle in ((0, 1, 2), (0, 2, 3)):
        lines += ["facet normal 1 0 0", "outer loop"]
        lines += ["vertex " + " ".join(number.format(c) for c in corners[i]) for i in triangle]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid wall", ""])


@pytest.mark.parametrize(
    "text",
    [
        text_wall(number="{:+e}"),
        text_wall().upper(),
        text_wall("Solid wall").replace("vertex", "Vertex"),
        text_wall(" \n solid wall"),
        "\ufeff" + text_wall(),
    ],
    ids=["signs", "capitals", "mixed", "blanks", "mark"],
)
def test_text_meshes_as_programs_write_them(text: str, tmp_path: Path) -> None:
    """GR-13: numbers with a +, keywords of any case, blanks or a byte order mark in front."""
    (tmp_path / "wall.stl").write_text(text, encoding="utf-8")
    with cell(WALL.replace("scale: 1000", "scale: 1"), folder=tmp_path) as robot:
        robot.move_linear_absolute(y=60).wait()
        assert refusal(robot.move_linear_absolute(x=200)).startswith("finger meets wall ")


@pytest.mark.parametrize("number", ["++{}", "+-{}", "+"])
def test_text_meshes_with_bad_numbers(number: str, tmp_path: Path) -> None:
    """GR-13: one sign at most."""
    (tmp_path / "wall.stl").write_text(text_wall(number=number))
    wrong = "line 4: expected three numbers behind 'vertex'"
    with pytest.raises(takt.ConfigError, match=wrong), cell(WALL, folder=tmp_path):
        pass


def test_virtual_time_is_the_same_each_time() -> None:
    hashes = []
    for _ in range(2):
        with cell(journal=True) as robot:
            robot.move_linear_absolute(y=60)
            robot.move_linear_absolute(x=200, buffer_mode="blending_next").wait()
            robot.move_linear_absolute(y=-60).wait()
            robot.move_linear_absolute(x=0).wait_final()
            hashes.append(robot.session.take_hashes()[1])  # type: ignore[attr-defined]
    assert np.array_equal(*hashes)


def test_a_journal_is_run_again_without_asking() -> None:
    """EN-07: the answers are in the journal."""
    with cell(journal=True) as robot:
        robot.move_path(path="along").wait_final()
        robot.move_linear_absolute(y=60)
        robot.move_linear_absolute(x=200, buffer_mode="blending_next").wait()
        engine = robot.session
        assert isinstance(engine, takt.Engine)
        journal, (cycles, hashes) = engine.take_journal(), engine.take_hashes()
    answers = [entry for entry in journal if entry[4] == "path_checked"]
    assert len(answers) == 4
    assert all(entry[1] == 0 for entry in answers)
    assert ["trouble: collision" in entry[5] for entry in answers] == [False, True, False, False]
    again = _core.Engine(DELTA.encode(), "cell.yaml", journal=True, checks=False)
    for cycle in cycles:
        for entry in journal:
            if entry[0] == cycle:
                assert again.resubmit(*entry[3:], entry[1], entry[2])[1] == 0
        again.step(1)
    assert np.array_equal(again.take_hashes()[1], hashes)


def test_nobody_forges_an_answer() -> None:
    with cell() as robot:
        ticket, error_id, sentence = robot.session._core.submit("robot", "path_checked", "{number: 1}")  # type: ignore[attr-defined]
        assert (ticket, error_id) == (0, 3011)
        assert "found 'path_checked'" in sentence
        assert not hasattr(robot, "path_checked")


@pytest.mark.parametrize("pace", ["paced", "real"])
def test_taktd_checks_and_its_log_is_run_again(tmp_path: Path, pace: str) -> None:
    """EN-07, over LCM: the sentence and the names get there; a replay needs no meshes."""
    write_wall(tmp_path / "wall.stl")
    url = new_url()
    log = tmp_path / "run.lcm"
    with running(tmp_path, url, "--log", str(log), machine=WALL, pace=pace), takt.connect(url) as session:
        robot = session.group("robot")
        prepare(robot)
        parts = robot.parts
        assert refusal(robot.move_linear_absolute(x=200)).startswith("finger meets wall ")
        session.wait(lambda: robot.in_the_way == ("finger", "wall"), 5)
        robot.move_linear_absolute(y=60)
        robot.move_linear_absolute(x=60, buffer_mode="blending_next").wait()
    (tmp_path / "wall.stl").unlink()
    result = takt.replay(log)
    assert result.same, result.sentence
    table = takt.read_log(log)["robot"]
    assert set(table["second_part"]) == {0, len(parts)}


PROBLEMS = [
    ("margin: 5", "margin: -5", "workspace.margin: expected"),
    ("margin: 5", "margin: 5\n      resolution: 6", "resolution: must not be above margin"),
    ("margin: 5", "margins: 5", "did you mean margin"),
    ("upper: {z: -650}", "lower: {z: 0}, upper: {z: -650}", "upper: must lie above lower"),
    ("cylinder: {radius: 10, height: 300}", "box: {x: 1, y: 1}", "box.z: expected this key with a number in mm"),
    ("cylinder: {radius: 10, height: 300}", "mesh: {file: no.stl}", "obstacles[0].mesh.file: "),
    ("cylinder: {radius: 10, height: 300}, ", "", "obstacles[0]: expected"),
    ("link: upper_arm", "link: uper_arm", "links[0].link: expected a link of this mechanism"),
    (
        "      gripper:",
        "      ignore: [[finger, poste]]\n      gripper:",
        "ignore[0]: expected the name of an obstacle",
    ),
    (
        "kinematics: {delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}",
        "tool: {}",
        "workspace: must not be given without kinematics",
    ),
]


@pytest.mark.parametrize(("old", "new", "expected"), PROBLEMS)
def test_what_is_wrong_comes_with_its_key(old: str, new: str, expected: str) -> None:
    assert old in DELTA
    with pytest.raises(takt.ConfigError) as raised:
        takt.Engine(DELTA.replace(old, new))
    (problem,) = raised.value.problems
    assert problem.startswith("machine:")
    assert "groups[0].workspace" in problem
    assert expected in problem


def test_parts_have_numbers() -> None:
    with cell() as robot:
        assert robot.parts[:7] == ("tool", "lower x", "lower y", "lower z", "upper x", "upper y", "upper z")
        assert robot.parts[7:10] == ("upper_arm_1", "upper_arm_2", "upper_arm_3")
        assert robot.parts[-2:] == ("finger", "post")
    with takt.Engine(
        {
            "name": "m 😀",
            "axes": [{"name": "x", "limits": {"velocity": 1, "acceleration": 1, "jerk": 1}}],
            "groups": [{"name": "robot", "axes": ["x"], "path": {"velocity": 1, "acceleration": 1, "jerk": 1}}],
        }
    ) as engine:
        assert engine.group("robot").parts == ()


def urdf_arm(mesh: str = "") -> str:
    """A slide along x that carries an arm turning about z: a box on it, a finger fixed to it."""
    shape = f'<mesh filename="{mesh}" scale="0.001 0.001 0.001"/>' if mesh else '<box size="0.4 0.04 0.04"/>'
    return """<robot name="r">
<link name="world"><collision><geometry><box size="0.02 0.02 0.02"/></geometry></collision></link>
<link name="arm"/><link name="arm_hand"/><link name="finger"/>
<joint name="slide" type="prismatic"><parent link="world"/><child link="arm"/><origin xyz="0 0 0.5"/>
  <axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<joint name="turn" type="revolute"><parent link="arm"/><child link="arm_hand"/>
  <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
<joint name="fix" type="fixed"><parent link="arm_hand"/><child link="finger"/><origin xyz="0.4 0 0"/></joint>
</robot>""".replace(
        '<link name="arm_hand"/><link name="finger"/>',
        f'<link name="arm_hand"><collision><origin xyz="0.2 0 0"/><geometry>{shape}</geometry></collision></link>'
        '<link name="finger"><collision><origin xyz="0 0 -0.1"/><geometry><cylinder radius="0.01" length="0.2"/>'
        "</geometry></collision></link>",
    )


URDF_CELL = """\
name: arm
axes:
  - {name: slide, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: turn, unit: deg, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: robot
    axes: [slide, turn]
    kinematics: {serial: {urdf: sub/arm.urdf}}
    path: {velocity: 100, acceleration: 1000, jerk: 10000}
    workspace:
      obstacles: [{name: post, box: {x: 20, y: 20, z: 200}, pose: {x: 600, z: OBSTACLE}}]
"""


def test_links_have_the_shapes_that_urdf_gives_them(tmp_path: Path) -> None:
    """The finger reaches from z 300 to 500, the arm's box is 40 mm high about 500; their ends are at x 410 and 400."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "arm.urdf").write_text(urdf_arm())
    for z, part, way in ((300, "finger", 175), (615, "arm_hand", 185)):
        machine = tmp_path / "m.yaml"
        machine.write_text(URDF_CELL.replace("OBSTACLE", str(z)))
        with takt.Engine(machine) as engine:
            robot = engine.group("robot")
            robot.power().wait()
            robot.enable().wait()
            move = robot.move_direct_absolute(a1=300)
            assert refusal(move).startswith(f"{part} meets post ")
            assert robot.blocked_at == pytest.approx(way, abs=0.6)
            robot.move_direct_absolute(a1=150).wait()
            robot.move_direct_absolute(a2=90).wait()
            robot.move_direct_absolute(a1=300).wait()


def test_meshes_of_urdf(tmp_path: Path) -> None:
    (tmp_path / "sub" / "meshes").mkdir(parents=True)
    write_wall(tmp_path / "sub" / "meshes" / "wall.stl")
    machine = tmp_path / "m.yaml"
    machine.write_text(URDF_CELL.replace("OBSTACLE", "300"))
    for mesh in ("meshes/wall.stl", "package://arm/meshes/wall.stl", "package://sub/meshes/wall.stl"):
        (tmp_path / "sub" / "arm.urdf").write_text(urdf_arm(mesh))
        takt.Engine(machine).close()
    for mesh, problem in (("meshes/no.stl", "no.stl: "), ("meshes/wall.dae", "expected an STL file")):
        (tmp_path / "sub" / "arm.urdf").write_text(urdf_arm(mesh))
        with pytest.raises(takt.ConfigError, match=problem) as raised:
            takt.Engine(machine)
        assert "groups[0].workspace.links" in raised.value.problems[0]


def test_meshes_of_a_package_above_the_machine_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """GR-13: package://NAME also where NAME is the folder of the machine file, and the URDF is named from there."""
    package = tmp_path / "my_robot"
    (package / "urdf").mkdir(parents=True)
    (package / "meshes").mkdir()
    write_wall(package / "meshes" / "wall.stl")
    (package / "urdf" / "arm.urdf").write_text(urdf_arm("package://my_robot/meshes/wall.stl"))
    machine = package / "m.yaml"
    machine.write_text(URDF_CELL.replace("OBSTACLE", "300").replace("sub/", "urdf/"))
    takt.Engine(machine).close()
    monkeypatch.chdir(package)
    takt.Engine("m.yaml").close()
    (package / "meshes").rename(package / "urdf" / "meshes")  # a folder of that name is above, but not the mesh
    takt.Engine("m.yaml").close()


def slides(one: str, two: str, more: str = "") -> str:
    """A ball carried by a slide along x, a second one at z 500 by a slide along y on it; `tcp` is fixed to that."""

    def link(name: str, z: float) -> str:
        ball = f'<origin xyz="0 0 {z}"/><geometry><sphere radius="0.02"/></geometry>'
        return f'<link name="{name}"><collision>{ball}</collision></link>'

    def slide(parent: str, child: str, axis: str) -> str:
        ends = f'<parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>'
        limit = '<limit lower="-2" upper="2" effort="1" velocity="1"/>'
        return f'<joint name="to {child}" type="prismatic">{ends}{limit}</joint>'

    links = f'<link name="root"/>{link(one, 0)}{link(two, 0.5)}<link name="tcp"/>'
    joints = slide("root", one, "1 0 0") + slide(one, two, "0 1 0")
    fixed = f'<joint name="f" type="fixed"><parent link="{two}"/><child link="tcp"/><origin xyz="0 0 0.2"/></joint>'
    return f'<robot name="r">{links}{joints}{fixed}{more}</robot>'


@contextmanager
def slides_cell(urdf: str, posts: str = "") -> Iterator[takt.Group]:
    limits = "limits: {velocity: 500, acceleration: 5000, jerk: 100000}"
    with takt.Engine(f"""\
name: slides
axes:
  - {{name: x, {limits}}}
  - {{name: y, {limits}}}
groups:
  - name: robot
    axes: [x, y]
    kinematics: {{serial: {{urdf: {json.dumps(urdf, ensure_ascii=False)}, base: root, tip: tcp}}}}
    path: {{velocity: 100, acceleration: 1000, jerk: 10000}}
    workspace: {{margin: 1, obstacles: [{posts}]}}
""") as engine:
        robot = engine.group("robot")
        robot.power().wait()
        robot.enable().wait()
        yield robot


LONG = "x" + "\u00e4" * 30  # 61 bytes: longer than a name of Takt, which would end within a character


@pytest.mark.parametrize(
    ("one", "two"),
    [("one", "two"), ("one", "tool"), ("base", "two"), ("base", "link_1"), ("tool", "base"), (LONG, LONG + "2")],
)
def test_shapes_of_urdf_belong_to_links_of_any_name(one: str, two: str) -> None:
    """GR-13: of base and tool, too, which mean something else here, and of long ones."""
    posts = (
        "{name: first, sphere: {radius: 20}, pose: {x: 150}}, "
        "{name: second, sphere: {radius: 20}, pose: {y: 150, z: 500}}"
    )
    with slides_cell(slides(one, two), posts) as robot:
        assert refusal(robot.move_direct_absolute(coordinate_system="acs", a1=300)).startswith(f"{one} meets first ")
        assert refusal(robot.move_direct_absolute(coordinate_system="acs", a2=300)).startswith(f"{two} meets second ")
        robot.move_direct_absolute(coordinate_system="acs", a1=-300, a2=-300).wait()


def test_shapes_of_urdf_above_the_base_stand_still() -> None:
    """GR-13: a box 200 mm along x, on a table to which a fixed joint holds the base, turned by 90 deg."""
    table = (
        '<link name="table"><collision><origin xyz="0.2 0.2 0.4"/><geometry><box size="0.05 0.05 0.05"/></geometry>'
        '</collision></link><joint name="table" type="fixed"><parent link="table"/><child link="root"/>'
        '<origin xyz="0.2 0 -0.1" rpy="0 0 1.5707963267948966"/></joint>'
    )
    with slides_cell(slides("one", "two", table)) as robot:
        assert refusal(robot.move_direct_absolute(coordinate_system="acs", a1=300)).startswith("table meets two ")
        assert robot.blocked_at == pytest.approx(154, abs=0.6)
        robot.move_direct_absolute(coordinate_system="acs", a2=100).wait()
        robot.move_direct_absolute(coordinate_system="acs", a1=300).wait()
