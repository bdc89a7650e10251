"""PY-23: the twin of a machine in MuJoCo: models made and given, what does not fit, what it says of runs."""

from __future__ import annotations

import json
import os
import re
import struct
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url
from takt import _core, drive
from takt.cli import main
from takt.plant import OnNetwork
from takt.ready import EXAMPLES, ready_machines

mujoco = pytest.importorskip("mujoco")

from takt.twin import Twin, judge  # noqa: E402
from takt.twin import command as twin_command  # noqa: E402
from takt.twin.places import problem  # noqa: E402

LIMITS = "limits: {velocity: 300, acceleration: 3000, jerk: 60000}"
TURNS = "limits: {velocity: 180, acceleration: 1500, jerk: 30000}"


def machine(axes: str, kinematics: str, twin: str, more: str = "") -> str:
    """A machine of axes in the units given by their first letter: x, y, z in mm, others in deg."""
    text = "name: trial\naxes:\n"
    for name in axes.split():
        slides = name[0] in "xyz"
        text += f"  - {{name: {name}, unit: {'mm' if slides else 'deg'}, {LIMITS if slides else TURNS}}}\n"
    names = ", ".join(axes.split())
    if kinematics:
        path = "path: {velocity: 200, acceleration: 2000, jerk: 50000}"
        text += f"groups:\n  - {{name: robot, axes: [{names}], kinematics: {kinematics}, {path}}}\n"
    return text + f"twin:\n  axes:\n{twin}{more}"


def motors(axes: str, more: str = "mass: 2") -> str:
    return "".join(f"    - {{axis: {axis}, max_torque: 900, {more}}}\n" for axis in axes.split())


GANTRY = machine("x y z c", "{gantry: {axes: [x, y, z, c]}}", motors("x y z c"))
SCARA = machine(
    "a1 a2 z4 c",
    "{scara: {first_arm: 325, second_arm: 275, height: 100}}",
    motors("a1 a2 z4 c", "mass: 1, rotor_inertia: 0.3"),
)
ARM = machine(
    "q1 q2 q3 q4 q5 q6",
    "{six_axis: {a1: 150, a2: -110, b: 20, c1: 450, c2: 615, c3: 705, c4: 90}}",
    motors("q1 q2 q3 q4 q5 q6", "mass: 3, rotor_inertia: 1").replace("900", "2000"),
)
DELTA = machine(
    "a1 a2 a3",
    "{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}, "
    "joints: [{}, {invert: true}, {zero: 3}]}",
    motors("a1 a2 a3", "mass: 0.6, rotor_inertia: 0.01"),
    "  mechanisms: [{group: robot, platform_mass: 0.25, rod_mass: 0.06, payload: 0.1}]\n",
)
URDF = """<robot name="two"><link name="base"/>
<link name="upper"><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
<inertia ixx="0.001" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="lower"><inertial><origin xyz="0.1 0 0"/><mass value="0.5"/>
<inertia ixx="0.001" iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="hand"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.2"/>
<axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="5"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.3 0 0"/>
<axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="5"/></joint>
<joint name="wrist" type="fixed"><parent link="lower"/><child link="hand"/><origin xyz="0.2 0 0.05"/></joint></robot>
"""
MJCF = """<mujoco><worldbody><body name="car"><joint name="rail" type="slide" axis="1 0 0"/>
<geom type="box" size=".05 .05 .02" mass="4"/><body pos="0 0 .1"><joint name="spin" type="hinge" axis="0 0 1"/>
<geom type="cylinder" size=".05 .01" mass="1"/><site name="tip" pos="0 0 0.02"/></body></body></worldbody></mujoco>"""


def moved(text: str | Path, seconds: float = 0.4) -> tuple[takt.Recording, Twin]:
    """Every axis on, and all of them moved at once."""
    with takt.Engine(text, plant="mujoco") as engine:
        record = engine.record()
        for power in [axis.power() for axis in engine.axes.values()]:
            power.wait()
        for number, axis in enumerate(engine.axes.values()):
            axis.move_relative(distance=20 if number % 2 else -15)
        engine.run(seconds)
        assert isinstance(engine.plant, Twin)
        return record.stop(), engine.plant


@pytest.mark.parametrize(
    ("text", "tools"), [(GANTRY, 1), (SCARA, 1), (ARM, 1), (DELTA, 1)], ids=["gantry", "scara", "six_axis", "delta"]
)
def test_models_made_of_kinematics(text: str, tools: int) -> None:
    """The tool of MuJoCo's bodies is where Takt's kinematics of their joints say, and the axes follow."""
    recording, twin = moved(text)
    judged = judge(twin, recording)
    assert len(judged.tools) == tools
    assert judged.passed, [verdict.sentence for verdict in judged.verdicts]
    for axis in judged.axes:
        table = recording[axis.axis]
        assert np.ptp(table["actual_position"]) > 14, axis
        assert axis.following[1] < 0.5, axis
        assert abs(table["following_error"][-1]) < 0.02, axis


def test_axes_alone_and_gravity() -> None:
    """A linear axis of 5 kg that moves upwards takes its weight; so does its brake, before it is switched on."""
    text = machine("x z a", "", motors("x a", "mass: 2") + "    - {axis: z, max_torque: 400, mass: 5, direction: z}\n")
    recording, twin = moved(text)
    held = recording["z"]["actual_position"][:5]
    assert np.abs(held).max() < 0.05
    torque = twin.seen().torques[-1]
    assert torque[twin.axes.index("z")] == pytest.approx(5 * 9.81, rel=0.01)
    assert abs(torque[twin.axes.index("x")]) < 0.1


def test_the_same_again() -> None:
    """Deterministic: bit for bit."""
    runs = [moved(DELTA, 0.2)[0] for _ in range(2)]
    assert runs[0]["a1"].tobytes() == runs[1]["a1"].tobytes()


def test_models_that_are_given(tmp_path: Path) -> None:
    """MJCF with names for the axes, and the URDF that kinematics name."""
    (tmp_path / "model.xml").write_text(MJCF)
    given = machine("x c", "{gantry: {axes: [x, c]}}", "").replace("  axes:\n", "  model: model.xml\n  axes:\n")
    given += "    - {axis: x, max_torque: 300, joint: rail}\n    - {axis: c, max_torque: 9, joint: spin}\n"
    for tool, said in (("tip", "found it 120 mm and 0 deg away"), ("tpi", "'tpi'; did you mean 'tip'?")):
        (tmp_path / "given.yaml").write_text(given + f"  mechanisms: [{{group: robot, tool: {tool}}}]\n")
        with pytest.raises(takt.ConfigError, match=re.escape(said)):
            moved(tmp_path / "given.yaml")
    given += "  mechanisms: [{group: robot, tool: car}]\n"
    (tmp_path / "given.yaml").write_text(given)
    recording, _ = moved(tmp_path / "given.yaml")
    assert recording["x"]["actual_position"][-1] == pytest.approx(-15, abs=0.02)

    (tmp_path / "arm.urdf").write_text(URDF)
    (tmp_path / "arm.yaml").write_text(machine("a1 a2", "{serial: {urdf: arm.urdf}}", motors("a1 a2", "friction: 0")))
    with pytest.raises(takt.ConfigError, match="friction"):
        moved(tmp_path / "arm.yaml")
    urdf = "{serial: {urdf: arm.urdf}}"
    (tmp_path / "arm.yaml").write_text(machine("a1 a2", urdf, motors("a1 a2", "coulomb_friction: 0.1")))
    recording, twin = moved(tmp_path / "arm.yaml")
    assert judge(twin, recording).passed


def urdf_with_mesh(mesh: str, own: str = "") -> str:
    """own: attributes of MuJoCo's element."""
    shape = f'<collision><geometry><mesh filename="{mesh}"/></geometry></collision>'
    urdf = URDF.replace('<link name="lower">', f'<link name="lower">{shape}')
    return urdf.replace("<link", f"<mujoco><compiler {own}/></mujoco><link", 1) if own else urdf


@pytest.mark.parametrize(
    ("mesh", "own"),
    [
        ("../meshes/tip.stl", ""),
        ("package://arm/meshes/tip.stl", ""),
        ("file://FOLDER/meshes/tip.stl", ""),
        ("package://gone/away/tip.stl", 'strippath="true" meshdir="../meshes"'),
        ("../meshes/tip.stl", 'meshdir="../meshes"'),
        ("tip.stl", 'meshdir="../meshes"'),
    ],
)
def test_meshes_of_a_urdf_are_found_from_its_folder(
    mesh: str, own: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """GR-13: by the same rule as for workspaces, and from any working directory; in models that are given, too."""
    package, elsewhere = tmp_path / "arm", tmp_path / "elsewhere"
    for folder in (package / "urdf", package / "meshes", elsewhere):
        folder.mkdir(parents=True)
    corners = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    facets = [struct.pack("<12fH", 0, 0, 0, *(x for i in face for x in corners[i]), 0) for face in faces]
    (package / "meshes" / "tip.stl").write_bytes(bytes(80) + struct.pack("<I", len(faces)) + b"".join(facets))
    (package / "urdf" / "arm.urdf").write_text(urdf_with_mesh(mesh.replace("FOLDER", str(package)), own))
    monkeypatch.chdir(elsewhere)
    text = machine("a1 a2", "{serial: {urdf: urdf/arm.urdf}}", motors("a1 a2", ""))
    (package / "made.yaml").write_text(text)
    model = takt_model(package / "made.yaml")
    assert [model.mesh(i).name for i in range(model.nmesh)] == ["robot.tip"]
    joints = "".join(
        f"    - {{axis: {a}, max_torque: 900, joint: {j}}}\n" for a, j in (("a1", "shoulder"), ("a2", "elbow"))
    )
    (package / "given.yaml").write_text(
        machine("a1 a2", "", "").replace("  axes:\n", "  model: urdf/arm.urdf\n  axes:\n") + joints
    )
    assert takt_model(package / "given.yaml").nmesh == 1


def takt_model(file: Path) -> mujoco.MjModel:
    with takt.Engine(file, plant="mujoco") as engine:
        assert isinstance(engine.plant, Twin)
        return engine.plant.built.model


def test_urdfs_that_are_long_or_have_unbound_prefixes(tmp_path: Path) -> None:
    """EN-37: what the machine file's check accepts, its twin takes: a URDF longer than a command's arguments may be,
    with a prefix of an XML namespace that is not declared, and with joints beside the chain."""
    more = '<gazebo><sensor:camera name="c"/></gazebo>' + "<!-- " + "x" * 20_000 + " -->"
    side = '<link name="side"/><joint name="first" type="fixed"><parent link="base"/><child link="side"/></joint>'
    (tmp_path / "arm.urdf").write_text(URDF.replace("</robot>", f"{more}{side}</robot>"))
    (tmp_path / "arm.yaml").write_text(machine("a1 a2", "{serial: {urdf: arm.urdf, tip: hand}}", motors("a1 a2", "")))
    recording, twin = moved(tmp_path / "arm.yaml")
    assert [joint.name for joint in twin.built.joints] == ["robot.shoulder", "robot.elbow"]
    assert judge(twin, recording).passed


def test_what_the_loader_refuses(tmp_path: Path) -> None:
    """With line and key, and without MuJoCo."""
    cases = {
        GANTRY.replace("axis: y, max_torque: 900, mass: 2", "axis: y, max_torque: 900, mass: 0"): "mass: expected",
        GANTRY.replace("axis: y, max", "axis: yy, max"): "expected the name of an axis, found 'yy'",
        GANTRY.replace("axis: y, max", "axis: x, max"): "found 'x' again",
        GANTRY.replace("axis: y, max_torque: 900, mass: 2", "axis: y, max_torque: 900"): "mass of the body",
        GANTRY.replace("max_torque: 900", "max_torque: 0"): "max_torque: expected",
        GANTRY.replace("mass: 2}", "mass: 2, joint: q}"): "expected a model that has joints",
        GANTRY + "  mechanisms: [{group: robo}]\n": "did you mean",
        GANTRY + "  mechanisms: [{group: robot, rod_mass: 1}]\n": "of a Delta only",
        GANTRY + "  step_s: 0.1\n": "step_s",
        DELTA.replace("rod_mass: 0.06, ", ""): "mass of each rod (rod_mass)",
        DELTA.replace("    - {axis: a2, max_torque: 900, mass: 0.6, rotor_inertia: 0.01}\n", ""): "no 'a2'",
        "name: x\naxes: [{name: x, " + LIMITS + "}]\ntwin: {axes: []}\n": "expected at least one axis",
    }
    for text, said in cases.items():
        file = tmp_path / "machine.yaml"
        file.write_text(text)
        with pytest.raises(takt.ConfigError) as caught:
            takt.Engine(file)
        assert said in str(caught.value), (said, str(caught.value))
        assert re.search(r"machine\.yaml:\d+:\d+: twin", str(caught.value)), str(caught.value)


def test_places_in_files_with_tabs() -> None:
    """With line and column, for any blanks between the words."""
    text = "name:\tm # a\u2028b\ntwin:\n  axes:\n    - {axis: x,\tjoint: rail}\n"
    assert problem(text.encode(), "m", "twin.axes[0].joint", "why") == "m:4:24: twin.axes[0].joint: why"


def test_what_only_the_model_shows(tmp_path: Path) -> None:
    """Models that do not fit, with line and key."""
    given = machine("x c", "", "").replace("  axes:\n", "  model: model.xml\n  axes:\n")
    joints = "    - {axis: x, max_torque: 300, joint: rail}\n    - {axis: c, max_torque: 9, joint: JOINT}\n"
    loop = '<equality><connect site1="tip" site2="post"/></equality></mujoco>'
    post = '<body name="post" pos=".1 0 0"><geom size=".01"/><site name="post"/></body></worldbody>'
    cases: list[tuple[str | None, str, str]] = [
        (
            MJCF,
            "spn",
            "twin.axes[1].joint: expected the name of a joint of the model, found 'spn'; did you mean 'spin'?",
        ),
        (MJCF, "rail", "which slides"),
        (MJCF.replace('mass="1"', 'mass="0"'), "spin", "MuJoCo does not take the model"),
        (MJCF.replace("</worldbody>", post).replace("</mujoco>", loop), "spin", "loops that close"),
        ("<mujoco><worldbody>", "spin", "MuJoCo cannot read it"),
        (None, "spin", "cannot be read: No such file"),
    ]
    for model, joint, said in cases:
        (tmp_path / "model.xml").unlink(missing_ok=True)
        if model is not None:
            (tmp_path / "model.xml").write_text(model)
        file = tmp_path / "machine.yaml"
        file.write_text(given + joints.replace("JOINT", joint))
        with pytest.raises(takt.ConfigError) as caught:
            takt.Engine(file, plant="mujoco")
        assert said in str(caught.value), (said, str(caught.value))
        assert re.search(r"machine\.yaml:\d+:\d+: twin", str(caught.value)), str(caught.value)
    with pytest.raises(takt.ConfigError, match="twin: expected a section"):
        takt.Engine("name: x\naxes: [{name: x, " + LIMITS + "}]\n", plant="mujoco")
    far = DELTA.replace("lower_arm: 800", "lower_arm: 330")
    with pytest.raises(takt.ConfigError, match="loops that close at the start"):
        takt.Engine(far, plant="mujoco")


def test_physics_that_explodes_is_said_and_stopped() -> None:
    """The frame before it is kept, and no cycle is made of what came after."""
    with takt.Engine(GANTRY, plant="mujoco") as engine:
        engine.step(20)
        twin = engine.plant
        assert isinstance(twin, Twin)
        twin.built.data.qvel[0] = 1e9
        with pytest.raises(takt.PlantError, match=r"exploded in cycle 19 .* joint 'x' has a speed of 1e\+09"):
            engine.step(5)
        assert engine.cycle == 20
        assert twin.frame.cycle == 18
        assert np.isfinite(twin.frame.positions).all()
        with pytest.raises(RuntimeError, match="failed before"):
            engine.step()


def test_physics_that_explodes_at_once_is_said_and_nowhere_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """PY-23: not on the terminal, and not in a file of MuJoCo's."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.xml").write_text(
        "<mujoco><option gravity='1e12 0 0'/><worldbody><body name='b'><joint name='jx' type='slide' axis='1 0 0'/>"
        "<geom size='0.05' mass='2'/></body></worldbody></mujoco>"
    )
    file = tmp_path / "machine.yaml"
    file.write_text(
        f"name: x\naxes: [{{name: x, {LIMITS}}}]\n"
        "twin: {model: m.xml, axes: [{axis: x, joint: jx, max_torque: 9}]}\n"
    )
    with (
        takt.Engine(file, plant="mujoco") as engine,
        pytest.raises(takt.PlantError, match=r"exploded in the step before the first cycle: .* the state at the start"),
    ):
        engine.step(5)
    assert [path.name for path in tmp_path.iterdir() if path.suffix == ".TXT"] == []
    assert capfd.readouterr() == ("", "")


def test_a_twin_in_a_process_of_its_own(tmp_path: Path) -> None:
    """PY-23, EN-26: over LCM, in step with the engine, motion is the same, bit for bit; for the next engine, too."""
    url = new_url()
    text = GANTRY + "external: {answer_within_s: 20, drives: [" + ", ".join(f"{{axis: {a}}}" for a in "xyzc") + "]}\n"
    described = json.loads(_core.load_machine(text.encode(), "m"))

    def work(engine: takt.Engine) -> list[bytes]:
        record = engine.record()
        for axis in "xyzc":
            engine.axis(axis).power().wait()
        for axis in "xyzc":
            engine.axis(axis).move_absolute(position=10)
        engine.run(0.05)
        recording = record.stop()
        return [recording[axis]["actual_position"].tobytes() for axis in "xyzc"]

    with takt.Engine(text, plant="mujoco") as engine:
        expected = work(engine)
    bus = OnNetwork(lambda: Twin(text.encode(), "m", described), described)
    plant = drive.Plant({}, url, buses=[bus], say=lambda _: None)
    thread = threading.Thread(target=plant.run)
    thread.start()
    try:
        for _ in range(2):
            with takt.Engine(text, url=url) as engine:
                assert work(engine) == expected
    finally:
        plant.stop()
        thread.join(60)
    with pytest.raises(takt.PlantError, match=r"the engine has cycles of 0\.002 s, the machine file says 0\.001 s"):
        bus.start("x", real_time=False, period_s=0.002)
    # In real time what comes back was measured before, and without an engine nothing moves.
    off = dict.fromkeys("xyzc", drive.SetPoint())
    first = bus.exchange(off, real_time=True)
    second = bus.exchange(off, real_time=True)
    assert second != first
    bus.idle([])
    part = bus.exchange({axis: off[axis] for axis in "xy"}, real_time=True)
    assert bus.exchange({axis: off[axis] for axis in "zc"}, real_time=True) is part  # of the same cycle, but late
    assert part != second
    file = tmp_path / "machine.yaml"
    for wrong, options, said in (
        (text, {"axes": ["x"]}, "give either --twin or --axis"),
        (text.replace("{axis: c}", "").replace(", ]", "]"), {}, r"the twin moves c, expected them in external\.drives"),
        (text[: text.index("twin:")] + text[text.index("external:") :], {}, "twin: expected a section"),
    ):
        file.write_text(wrong)
        with pytest.raises(takt.TaktError, match=said):
            drive.simulate(file, url, twin=True, **options)  # type: ignore[arg-type]


def test_friction_holds() -> None:
    """PY-23: what a motor is too weak for does not creep: 20 N against 30 N."""
    text = (
        "name: x\naxes: [{name: z, " + LIMITS + "}]\ngroups: []\n"
        "simulation: {servos: [{axis: z, mechanics: {inertia: 0.001}}]}\n"
        "twin: {axes: [{axis: z, mass: 2, max_torque: 20, coulomb_friction: 30}]}\n"
    )
    with takt.Engine(text, plant="mujoco") as engine:
        engine.axis("z").power().wait()
        engine.axis("z").move_absolute(position=50)
        engine.run(1.0)
        assert abs(engine.axis("z").true_position) < 0.05


def test_motors_that_are_too_weak_and_what_must_not_touch() -> None:
    """Both are failures of the twin's own."""
    weak = GANTRY.replace("axis: z, max_torque: 900", "axis: z, max_torque: 30")  # 2 kg with c: 39 N of weight
    recording, twin = moved(weak, 0.2)
    failed = {verdict.title: verdict.sentence for verdict in judge(twin, recording).verdicts if not verdict.passed}
    assert "at its limit of 30 N in" in failed["twin.torque(z)"]
    solid = "workspace: {obstacles: [{name: post, box: {x: 40, y: 40, z: 40}, pose: {x: 0, y: 40}}]}"
    recording, twin = moved(GANTRY.replace("path: {", f"{solid}, path: {{"), 0.3)
    failed = {verdict.title: verdict.sentence for verdict in judge(twin, recording).verdicts if not verdict.passed}
    assert re.search(r"obstacle post and . touched from", failed["twin.contacts"])


def with_mechanisms() -> list[str]:
    """The ready machines that have groups with kinematics."""
    found = []
    for one in ready_machines():
        file = one.scenario.parent / "machine.yaml"
        described = json.loads(_core.load_machine(*takt.read_machine(file)))
        if any(group.get("kinematics") for group in described["groups"]):
            found.append(one.name)
    return found


def test_every_ready_machine_with_a_mechanism_has_a_twin() -> None:
    """And each of their groups and belts is in it."""
    assert {"delta_cell", "pick_cell", "two_robots"} <= set(with_mechanisms())
    for name in with_mechanisms():
        described = json.loads(_core.load_machine(*takt.read_machine(EXAMPLES / name / "machine.yaml")))
        groups = {group["name"] for group in described["groups"] if group.get("kinematics")}
        assert groups == {mechanism["group"] for mechanism in described["twin"]["mechanisms"]}, name


@pytest.mark.skipif(not os.environ.get("TAKT_LONG"), reason="whole scenarios: TAKT_LONG=1")
@pytest.mark.parametrize("name", with_mechanisms())
def test_whole_scenarios_of_ready_machines(name: str) -> None:
    """As `takt twin NAME` runs them: the verdicts of the scenario and the twin's own."""
    scenario = takt.scenario.load_scenario(EXAMPLES / name / "scenario.py")
    ran = twin_command.run(scenario.machine, scenario, compare=False)
    said = [f"{verdict.title}: {verdict.sentence}" for verdict in ran.outcome.verdicts if not verdict.passed]
    assert ran.outcome.passed, (said, ran.outcome.complaint)


@pytest.mark.parametrize("name", with_mechanisms())
def test_ready_machines(name: str, tmp_path: Path) -> None:
    """Each with a mechanism: a short scenario in the twin, with the twin's verdicts and the scenario's own."""
    file = tmp_path / "scenario.py"
    file.write_text(SHORT)
    scenario = takt.scenario.load_scenario(file)
    ran = twin_command.run(EXAMPLES / name / "machine.yaml", scenario)
    said = [verdict.sentence for verdict in ran.outcome.verdicts if not verdict.passed]
    assert ran.outcome.passed, (said, ran.outcome.complaint)
    for tool in ran.judged.tools:
        assert tool.agreement[1] < 0.1, tool
    for axis in ran.judged.axes:
        assert not axis.following[1] > 0.5, axis  # those of belts were never switched on


def test_nothing_touches_in_two_robots() -> None:
    """PY-23: the scenario of two Deltas that reach into one box, in the twin: no rod touches another one."""
    scenario = takt.scenario.load_scenario(EXAMPLES / "two_robots" / "scenario.py")
    ran = twin_command.run(scenario.machine, scenario, compare=False)
    said = {verdict.title: verdict for verdict in ran.outcome.verdicts}
    assert said["twin.contacts"].passed, said["twin.contacts"].sentence
    assert not ran.twin.contacts
    assert ran.outcome.passed, (ran.outcome.complaint, [v.sentence for v in said.values() if not v.passed])


SHORT = '''"""All robots on, there and back."""
from takt import expect

POSES = ((0, 0, -760), (90, 40, -800), (-60, 80, -780), (0, 0, -760))

def scenario(session):
    for power in [group.power() for group in session.groups.values()]:
        power.wait()
    for group in session.groups.values():
        group.enable().wait()
    for x, y, z in POSES:
        for move in [
            group.move_direct_absolute(x=x, y=y, z=z, coordinate_system="mcs") for group in session.groups.values()
        ]:
            move.wait()

def verify(recording):
    for axis in recording.components:
        if axis[-2:] in ("_1", "_2", "_3"):
            expect.within_limits(recording, axis)
'''


def test_a_model_that_is_given_is_drawn(tmp_path: Path) -> None:
    """PY-23: though it says nothing of pictures; one without shapes is told apart from drivers that cannot draw."""
    given = machine("x c", "", "").replace("  axes:\n", "  model: model.xml\n  axes:\n")
    given += "    - {axis: x, max_torque: 300, joint: rail}\n    - {axis: c, max_torque: 9, joint: spin}\n"
    (tmp_path / "machine.yaml").write_text(given)
    file = tmp_path / "twin.png"
    (tmp_path / "model.xml").write_text(MJCF)
    said = ""
    try:
        Twin.of(tmp_path / "machine.yaml").picture(file)
    except takt.PlantError as error:  # nothing here can draw
        said = str(error)
    assert "framebuffer" not in said
    assert said or file.read_bytes().startswith(b"\x89PNG")
    (tmp_path / "model.xml").write_text(MJCF.replace("<geom", '<geom rgba="0 0 0 0"'))
    with pytest.raises(takt.PlantError, match="the model has no shape that can be seen"):
        Twin.of(tmp_path / "machine.yaml").picture(file)


def test_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """takt twin: verdicts, figures beside our servo's, a picture where something here can draw."""
    (tmp_path / "scenario.py").write_text(SHORT)
    (tmp_path / "machine.yaml").write_text(
        (EXAMPLES / "delta_cell" / "machine.yaml")
        .read_text()
        .replace("    file: drawing.csv", "    elements: [{shape: line, to: {x: 0, y: 0, z: 0}}]")
    )
    picture = tmp_path / "twin.png"
    assert main(["twin", str(tmp_path / "machine.yaml"), "--picture", str(picture)]) == 0
    said = capsys.readouterr().out
    assert "twin.tool(robot)" in said
    assert "following error [deg]" in said
    assert "cycles a second" in said
    assert picture.is_file() or "no picture: egl: " in said
    if picture.is_file():
        assert picture.read_bytes().startswith(b"\x89PNG")


def test_without_mujoco(tmp_path: Path) -> None:
    """All else works, and the sentence says how to get it."""
    file = tmp_path / "gantry.yaml"
    file.write_text(GANTRY)
    program = f"""
import sys
sys.modules["mujoco"] = None
import takt
from takt.cli import main
with takt.Engine({str(file)!r}) as engine:
    engine.step(10)
try:
    takt.Engine({str(file)!r}, plant="mujoco")
except takt.TaktError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert 'pip install "takt-motion[twin]"' in done.stdout


def test_the_distance_from_the_set_pose_is_no_way_of_a_cycle() -> None:
    """PY-23: at a constant velocity a gantry is as far from its set pose as its axis has a following error."""
    with takt.Engine(GANTRY, plant="mujoco") as engine:
        for axis in "xyzc":
            engine.axis(axis).power().wait()
        robot = engine.group("robot")
        robot.enable().wait()
        record = engine.record()
        robot.move_linear_absolute(x=100, coordinate_system="mcs").wait()
        recording = record.stop()
        (tool,) = judge(engine.plant, recording).tools
    lag = np.abs(recording["x"]["following_error"]).max()
    assert tool.off[1] == pytest.approx(lag, abs=0.02)
