"""The scene of a machine (PY-27): its transforms against takt.kinematics, every ready machine, what is left out."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from takt import _core, msgs
from takt.kinematics import Kinematics, pose_to_matrix
from takt.ready import ready_machines
from takt.recording import Recording
from takt.scene import link_poses, make_scene, matrix_of, node_pose
from takt.scene.moving import is_shown, poses_of
from takt.scene.solids import MOST_TRIANGLES, along, thinned
from takt.view.machine import Machine

EXAMPLES = Path(__file__).parents[2] / "python" / "examples"

# A tetrahedron of 100 mm, as an STL file in m.
STL = """solid tip
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 0.1 0
vertex 0.1 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 0.1 0 0
vertex 0 0 0.1
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 0.1
vertex 0 0.1 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 0.1 0 0
vertex 0 0.1 0
vertex 0 0 0.1
endloop
endfacet
endsolid tip
"""

URDF = """<robot name="two">
<link name="foot"/>
<link name="lower"><collision><origin xyz="0 0 0.1"/><geometry><box size="0.05 0.06 0.2"/></geometry></collision></link>
<link name="upper"><collision><origin xyz="0 0 0.02"/>
<geometry><mesh filename="meshes/tip.stl" scale="1 1 1"/></geometry></collision></link>
<link name="hand"/>
<joint name="a" type="revolute"><parent link="foot"/><child link="lower"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><parent link="lower"/><child link="upper"/><origin xyz="0 0 0.3" rpy="0 0.2 0"/>
<axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="c" type="fixed"><parent link="upper"/><child link="hand"/><origin xyz="0.1 0 0.25"/></joint>
</robot>"""

KINDS = {
    "gantry": {"gantry": {"axes": ["x", "y", "z", "c"]}},
    "core_xy": {"core_xy": {}},
    "scara": {"scara": {"first_arm": 325, "second_arm": 275, "height": 400}},
    "delta": {"delta": {"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 800}},
    "six_axis": {"six_axis": {"a1": 25, "a2": -35, "b": 10, "c1": 400, "c2": 315, "c3": 365, "c4": 80}},
    "serial": {"serial": {"urdf": URDF}},
}
LIMITS = "limits: {velocity: 500, acceleration: 5000, jerk: 200000"


def described(text: str, folder: Path | None = None) -> Machine:
    message = msgs.machine_description()
    message.name, message.version, message.period_s, message.text = "m", "0", 0.001, text
    return Machine(message, folder)


def with_held(recording: Recording, start_s: float, end_s: float) -> Recording:
    """As if module `picker` held something for that time."""
    tables = {name: recording[name].copy() for name in recording.components}
    time_s = tables["picker"]["time_s"]
    tables["picker"]["held"] = (time_s > start_s) & (time_s < end_s)
    return Recording(tables, meta=recording.meta)


def kinds(machine: Machine) -> set[str]:
    """Of all its solids."""
    return {solid["kind"] for node in machine.scene["nodes"] for solid in node["solids"]}


def one_group(kinematics: dict[str, object], more: str = "") -> str:
    """A machine file with one group on a base that is turned and shifted."""
    mechanism = Kinematics(**kinematics)  # type: ignore[arg-type]
    axes = "".join(
        f"  - {{name: a{i}, unit: {'deg' if turns else 'mm'}, {LIMITS}, lower: -60, upper: 60}}}}\n"
        for i, turns in enumerate(mechanism.rotary)
    )
    members = ", ".join(f"a{i}" for i in range(mechanism.axes))
    return (
        f"name: m\naxes:\n{axes}groups:\n  - name: robot\n    axes: [{members}]\n"
        f"    base: {{x: 100, y: -200, z: 700, a: 10, b: -20, c: 130}}\n    tool: {{z: 50}}\n"
        f"    kinematics: {json.dumps(kinematics)}\n"
        f"    path: {{velocity: 100, acceleration: 1000, jerk: 20000}}\n{more}"
    )


@pytest.mark.parametrize("kind", KINDS)
def test_links_are_where_the_kinematics_say(kind: str) -> None:
    machine = described(one_group(KINDS[kind]))
    mechanism, _, base = machine.mechanisms["robot"]
    scene = machine.scene
    rng = np.random.default_rng(7)
    joints = rng.uniform(-50, 50, (20, mechanism.axes))
    poses = link_poses(mechanism, base, joints)
    np.testing.assert_allclose(np.linalg.norm(poses[:, :, 3:], axis=-1), 1, atol=1e-12)
    world = np.asarray(pose_to_matrix([100, -200, 700, 10, -20, 130]))
    tools = np.asarray(pose_to_matrix(mechanism.forward(joints)))
    places = mechanism.link_places(joints)
    nodes = {node["name"]: node for node in scene["nodes"]}
    unknown = lambda *_: math.nan  # noqa: E731
    for row in range(len(joints)):
        frames = mechanism.link_frames(joints[row : row + 1])[0]
        for i, link in enumerate(mechanism.links):
            pose = matrix_of(poses[row, i])
            np.testing.assert_allclose(pose, world @ frames[i], atol=1e-9)
            # From its own axis to the next one, as the span says: what pages draw from above.
            begin, end = (world @ np.append(places[row, i, k : k + 3], 1) for k in (0, 3))
            np.testing.assert_allclose(pose[:3, 3], begin[:3], atol=1e-9)
            span = np.reshape(scene["spans"]["robot"], (-1, 3))[i]
            np.testing.assert_allclose((pose @ np.append(span, 1))[:3], end[:3], atol=1e-3)
            if node := nodes.get(f"robot.{link}"):
                np.testing.assert_allclose(node_pose(scene, node, {"robot": poses[row]}, unknown), pose, atol=1e-12)
        np.testing.assert_allclose(matrix_of(poses[row, -1]), world @ tools[row], atol=1e-9)
    drawn = [solid for node in scene["nodes"] if node.get("of") == "robot" for solid in node["solids"]]
    assert len(drawn) >= 3
    # The tool centre point is where the group's tool says, on the flange.
    tip = next(solid for solid in nodes["robot.tool"]["solids"] if solid["colour"] == "tip")
    assert tip["at"] == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 50]


def test_a_delta_whose_arms_do_not_meet_is_nowhere() -> None:
    mechanism = Kinematics(delta={"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 300})
    joints = np.array([[0, 0, 0], [-80, 80, 80], [math.nan, 0, 0], [10, 10, 10]], float)
    poses = link_poses(mechanism, np.eye(4), joints)
    known = np.all(np.isfinite(poses), axis=(1, 2))
    assert not known[2]
    for row in np.flatnonzero(known):
        np.testing.assert_array_equal(poses[row], link_poses(mechanism, np.eye(4), joints[row : row + 1])[0])
    assert np.all(np.isnan(poses[~known]))


def test_quaternions_of_every_turn() -> None:
    rng = np.random.default_rng(3)
    angles = np.concatenate([rng.uniform(-180, 180, (200, 3)), [[180, 0, 0], [0, 0, 180], [0, 90, 180], [0, 0, 0]]])
    matrices = np.asarray(pose_to_matrix(np.concatenate([rng.uniform(-1e3, 1e3, angles.shape), angles], axis=1)))
    for pose, matrix in zip(poses_of(matrices), matrices, strict=True):
        np.testing.assert_allclose(matrix_of(pose), matrix, atol=1e-9)


@pytest.mark.parametrize("name", [ready.name for ready in ready_machines()])
def test_every_ready_machine_has_a_scene(name: str) -> None:
    folder = EXAMPLES / name
    machine = described((folder / "machine.yaml").read_text(), folder)
    scene = machine.scene
    assert scene["nodes"]
    text = json.dumps(scene, allow_nan=False)
    assert len(text) < 40_000
    known = machine.by_name
    poses = {g: np.tile([0, 0, 0, 0, 0, 0, 1.0], (len(m.links), 1)) for g, (m, _, _) in machine.mechanisms.items()}
    for node in scene["nodes"]:
        moved = node.get("moved", {})
        assert node["solids"]
        component = moved.get("component", moved.get("group"))
        if component is not None:
            fields = set(known[component].layout.dtype.fields or ())
            needed = {moved["slide"]} if "slide" in moved else {f for f in moved.get("pose", ()) if f}
            assert needed <= fields, node["name"]
            assert node["of"] in known
        assert np.all(np.isfinite(node_pose(scene, node, poses, lambda *_: 1.0)))
    # Every axis, belt and mover is to be seen.
    shown = {node["of"] for node in scene["nodes"] if "of" in node}
    belts = {belt["axis"] for belt in machine.parameters["belts"]}
    members = {axis for _, axes, _ in machine.mechanisms.values() for axis in axes}
    for source in machine.sources:
        if source.kind in ("belt", "mover", "part", "group"):
            assert source.name in shown
        if source.kind == "axis":
            assert (source.name in shown) != (source.name in belts | members)


def test_what_a_module_holds_hangs_from_the_tool() -> None:
    """PY-27: as large as the twin's products, its top at the tool, while the module holds something."""
    machine = described((EXAMPLES / "pick_cell" / "machine.yaml").read_text(), EXAMPLES / "pick_cell")
    node = next(node for node in machine.scene["nodes"] if node["name"] == "picker.held")
    (solid,) = node["solids"]
    assert solid["size"] == [40, 30, 20] == machine.scene["belts"]["infeed"]["size"]
    links = len(machine.mechanisms["robot"][0].links)
    poses = {"robot": np.tile([100, 50, -700, 0, 0, 0, 1.0], (links, 1))}
    middle = node_pose(machine.scene, node, poses, lambda *_: 1.0) @ [*np.array(solid["at"])[3::4], 1]
    np.testing.assert_allclose(middle[:3], [100, 50, -710])
    for held, shown in ((0.0, False), (1.0, True), (2.0, True), (math.nan, False)):
        assert is_shown(node, lambda *_, held=held: held) is shown
    # Tools of arms point away from their flange, so what they hold is there.
    for kind, side in (("six_axis", 1), ("scara", 1)):  # one_group's tool is 50 mm along Z
        scene = described(one_group(KINDS[kind]) + "pick_and_place: [{name: picker, group: robot}]\n").scene
        (solid,) = next(node["solids"] for node in scene["nodes"] if node["name"] == "picker.held")
        assert solid["at"][11] == side * 10


def test_what_the_file_leaves_out_is_left_out() -> None:
    machine = described(f"name: m\naxes:\n  - {{name: x, unit: mm, {LIMITS}}}}}\n")
    assert set(machine.scene) == {"heights", "nodes"}
    assert {node["name"] for node in machine.scene["nodes"]} == {"x", "x.rail"}
    assert make_scene({**machine.parameters, "axes": []}, {}) == {"heights": [], "nodes": []}


def test_slides_and_discs_move_as_their_axes() -> None:
    machine = described(
        f"""name: m
axes:
  - {{name: short, unit: mm, {LIMITS}, lower: -5, upper: 5}}}}
  - {{name: endless, unit: mm, {LIMITS}}}}}
  - {{name: turn, unit: deg, {LIMITS}}}}}
  - {{name: round, unit: pieces, kind: rotary, modulus: 12, {LIMITS}}}}}
"""
    )
    scene = machine.scene
    nodes = {node["name"]: node for node in scene["nodes"]}

    def at(name: str, position: float) -> np.ndarray:
        rest = np.eye(4)
        rest[:3] = np.reshape(nodes[name]["at"], (3, 4))
        return np.asarray(np.linalg.inv(rest) @ node_pose(scene, nodes[name], {}, lambda *_: position))

    assert at("short", -5)[0, 3] == pytest.approx(0)
    assert at("short", 5)[0, 3] == pytest.approx(150)  # no smaller than can be seen
    assert at("endless", 625)[0, 3] == pytest.approx(25)
    assert at("endless", -25)[0, 3] == pytest.approx(575)
    np.testing.assert_allclose(at("turn", 90)[:2, :2], [[0, -1], [1, 0]], atol=1e-12)
    np.testing.assert_allclose(at("round", 3)[:2, :2], [[0, -1], [1, 0]], atol=1e-12)


WORKSPACE = """    workspace:
      bounds: {upper: {z: 400}}
      obstacles:
        - {name: post, cylinder: {radius: 10, height: 300}, pose: {x: 400, z: 100}}
        - {name: guard, mesh: {file: tip.stl, scale: 1000}, pose: {x: -400}}
      links:
        - {link: link_2, capsule: {radius: 30}}
      gripper:
        - {name: finger, box: {x: 10, y: 20, z: 60}, pose: {z: 30}}
"""


def test_workspaces_have_their_shapes_and_names(tmp_path: Path) -> None:
    (tmp_path / "tip.stl").write_text(STL)
    zone = "zones:\n  - {name: z, lower: {x: 0, y: 0, z: 0}, upper: {x: 10, y: 20, z: 30}, groups: []}\n"
    text = one_group(KINDS["six_axis"], WORKSPACE + zone)
    scene = described(text, tmp_path).scene
    nodes = {node["name"]: node for node in scene["nodes"]}
    post, guard = nodes["robot.obstacles"]["solids"]
    assert (post["kind"], post["size"], post["part"]) == ("cylinder", [10, 300], "post")
    assert (guard["kind"], len(guard["triangles"]), max(guard["vertices"])) == ("mesh", 12, 100)
    (link,) = nodes["robot.link_2"]["solids"]
    assert (link["kind"], link["size"][0], link["part"]) == ("capsule", 30, "link_2")
    assert {"finger", "tool"} == {solid["part"] for solid in nodes["robot.tool"]["solids"]}
    (bound,) = nodes["robot.bounds"]["solids"]
    assert bound["at"][11] + bound["size"][2] / 2 == pytest.approx(
        400
    )  # as far as said; elsewhere as far as it reaches
    (box,) = nodes["z"]["solids"]
    assert (box["size"], box["at"][3::4]) == ([10, 20, 30], [5, 10, 15])
    # What a refused path says by number has the names that the solids have.
    named = {solid.get("part") for node in scene["nodes"] for solid in node["solids"]} - {None}
    assert {"post", "guard", "finger", "tool"} <= named & set(scene["parts"]["robot"])
    # Without the folder no file is opened; all else is there.
    apart = {node["name"]: node for node in described(text).scene["nodes"]}
    assert [solid["part"] for solid in apart["robot.obstacles"]["solids"]] == ["post"]


def test_a_tool_with_shapes_of_its_own(tmp_path: Path) -> None:
    """Those of the machine file, and the gripper beside them."""
    (tmp_path / "tip.stl").write_text(STL)
    text = one_group(KINDS["six_axis"], WORKSPACE.replace("link: link_2, capsule", "link: tool, capsule"))
    nodes = {node["name"]: node for node in described(text, tmp_path).scene["nodes"]}
    kinds = [(solid["kind"], solid["part"]) for solid in nodes["robot.tool"]["solids"]]
    assert kinds == [("capsule", "tool"), ("box", "finger")]


def test_urdf_has_its_meshes(tmp_path: Path) -> None:
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "two.urdf").write_text(URDF)
    (tmp_path / "arm" / "meshes" / "tip.stl").write_text(STL)
    text = one_group(KINDS["serial"]).replace(json.dumps({"urdf": URDF}), "{urdf:\tarm/two.urdf}")
    nodes = {node["name"]: node for node in described(text, tmp_path).scene["nodes"]}
    (lower,) = nodes["robot.lower"]["solids"]
    assert (lower["kind"], lower["size"], lower["at"][11]) == ("box", [50, 60, 200], 100)
    (upper,) = nodes["robot.upper"]["solids"]
    assert (upper["kind"], max(upper["vertices"]), upper["at"][11]) == ("mesh", 100, 20)
    # A message that names files opens none; where it says what a file of this host says, that file's are drawn.
    file = tmp_path / "machine.yaml"
    file.write_text(text)
    message = msgs.machine_description()
    message.name, message.version, message.period_s = "m", "0", 0.001
    message.text = json.dumps(json.loads(_core.load_machine(text.encode(), str(file))))
    assert len(Machine(message).scene["nodes"]) == len(nodes)
    assert not kinds(Machine(message)) & {"mesh"}
    assert kinds(Machine(message, file=file)) >= {"mesh"}
    file.write_text(text.replace("x: 100", "x: 101"))
    assert not kinds(Machine(message, file=file)) & {"mesh"}
    (tmp_path / "arm" / "meshes" / "tip.stl").write_text("solid tip\nvertex 1\n")
    nodes = {node["name"]: node for node in described(text, tmp_path).scene["nodes"]}
    assert all(solid["kind"] != "mesh" for solid in nodes["robot.upper"]["solids"])  # a simple one in its place


def test_urdf_has_its_meshes_seen_from_a_relative_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """PY-27: of a machine file that is named by a relative path."""
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "two.urdf").write_text(URDF)
    (tmp_path / "arm" / "meshes" / "tip.stl").write_text(STL)
    monkeypatch.chdir(tmp_path)
    text = one_group(KINDS["serial"]).replace(json.dumps({"urdf": URDF}), "{urdf: arm/two.urdf}")
    assert "mesh" in kinds(described(text, Path()))


def test_arms_of_long_urdfs_are_drawn() -> None:
    """PY-27: of a URDF longer than the arguments of a command may be, too."""
    short = one_group(KINDS["serial"])
    long = URDF.replace("</robot>", "<!-- " + "x" * 20_000 + " --></robot>")
    machine = described(short.replace(json.dumps(URDF), json.dumps(long)))
    assert list(machine.mechanisms) == ["robot"]
    assert [node["name"] for node in machine.scene["nodes"]] == [
        node["name"] for node in described(short).scene["nodes"]
    ]


def test_urdf_has_what_is_to_be_seen(tmp_path: Path) -> None:
    """PY-27: visuals before shapes for collisions, those before simple solids; of each link for itself."""
    (tmp_path / "cover.stl").write_text(STL)
    visual = """<visual><origin xyz="0 0 0.05" rpy="0 0 1.5707963267948966"/><geometry>%s</geometry></visual>"""
    cover = visual % '<mesh filename="cover.stl" scale="2 2 2"/>'
    column = visual % '<cylinder radius="0.04" length="0.2"/>'
    text = URDF.replace('<link name="lower">', f'<link name="lower">{cover}{column}')
    text = text.replace('<link name="upper">', '<link name="upper">' + visual % '<mesh filename="gone.dae"/>')
    palm = visual % '<sphere radius="0.03"/>'
    text = text.replace('<link name="hand"/>', f'<link name="hand">{palm}</link>')
    (tmp_path / "two.urdf").write_text(text)
    machine = one_group(KINDS["serial"]).replace(json.dumps({"urdf": URDF}), "{urdf: two.urdf}")
    nodes = {node["name"]: node for node in described(machine, tmp_path).scene["nodes"]}
    mesh, cylinder = nodes["robot.lower"]["solids"]
    assert (mesh["kind"], max(mesh["vertices"]), mesh["part"], mesh["at"][11]) == ("mesh", 200, "lower", 50)
    assert mesh["at"][:3] == pytest.approx([0, -1, 0], abs=1e-6)  # turned about Z
    assert (cylinder["kind"], cylinder["size"]) == ("cylinder", [40, 200])
    assert "mesh" not in {solid["kind"] for solid in nodes["robot.upper"]["solids"][1:]}
    ball = next(s for node in nodes.values() for s in node["solids"] if s.get("part") == "hand")
    assert (ball["kind"], ball["size"]) == ("sphere", [30])
    # Without the folder: what is in no file.
    apart = {node["name"]: node for node in described(machine.replace("two.urdf", json.dumps(text))).scene["nodes"]}
    assert [solid["kind"] for solid in apart["robot.lower"]["solids"]] == ["cylinder"]


def test_large_meshes_are_made_smaller() -> None:
    n = 120
    u, v = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    vertices = np.stack([u.ravel(), v.ravel(), 10 * np.sin(u.ravel() / 9)], axis=1).astype(float)
    corner = (u * n + v)[:-1, :-1].ravel()
    triangles = np.concatenate(
        [np.stack([corner, corner + n, corner + 1], axis=1), np.stack([corner + 1, corner + n, corner + n + 1], axis=1)]
    )
    few, kept = thinned(vertices, triangles)
    assert 1000 < len(kept) <= MOST_TRIANGLES < len(triangles)
    assert kept.max() < len(few)
    np.testing.assert_allclose(few.max(axis=0), vertices.max(axis=0), atol=3)


def test_frames_along_every_direction() -> None:
    for way in np.concatenate([np.eye(3), -np.eye(3), np.random.default_rng(5).normal(size=(20, 3))]):
        frame = along((1, 2, 3), np.array([1, 2, 3]) + 10 * way)
        np.testing.assert_allclose(frame[:3, :3] @ frame[:3, :3].T, np.eye(3), atol=1e-12)
        assert np.linalg.det(frame[:3, :3]) == pytest.approx(1)
        np.testing.assert_allclose(frame[:3, 2], way / np.linalg.norm(way), atol=1e-12)
