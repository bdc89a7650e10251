"""GR-10 to GR-12: frames and kinematics as Python sees them, with NumPy's own linear algebra as the yardstick."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import takt
import takt.kinematics as kin
from hypothesis import given, settings
from hypothesis import strategies as st

URDF = Path(__file__).parents[1] / "cpp" / "kinematics"

DELTA = {"base_radius": 164, "platform_radius": 44, "upper_arm": 524, "lower_arm": 1244, "first_arm_deg": -90}
PUMA = {"a2": 20.3, "b": -150.05, "c2": 431.8, "c3": 431.8}

# Mechanisms, and where their axes may be without a singularity in between.
MECHANISMS = {
    "gantry": (kin.Kinematics(gantry={"axes": ["x", "y", "z", "c"]}), [(-500, 500)] * 3 + [(-700, 700)]),
    "core_xy": (kin.Kinematics(core_xy={"with_z": True}), [(-500, 500)] * 3),
    "scara": (
        kin.Kinematics(scara={"first_arm": 325, "second_arm": 275}, joints=[{"zero": 5}, {}, {"invert": True}, {}]),
        [(-120, 120), (5, 150), (-200, 0), (-400, 400)],
    ),
    "delta": (kin.Kinematics(delta=DELTA), [(-30, 60)] * 3),
    "six_axis": (kin.Kinematics(six_axis=PUMA), [(-160, 160), (20, 70), (10, 80), (-170, 170), (5, 100), (-170, 170)]),
    "serial": (
        kin.Kinematics(serial={"urdf": "puma.urdf"}, folder=URDF),
        [(-150, 150), (-60, 30), (-45, 10), (-160, 160), (10, 90), (-150, 150)],
    ),
}


def positions(name: str, rows: int, seed: int) -> np.ndarray:
    """Positions (rows, axes) of a mechanism's axes."""
    lower, upper = np.array(MECHANISMS[name][1], float).T
    return np.random.default_rng(seed).uniform(lower, upper, (rows, len(lower)))


def turn(axis: int, degrees: float) -> np.ndarray:
    """The rotation matrix about X, Y or Z."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


angle = st.floats(-180, 180)
length = st.floats(-3000, 3000)
pose = st.tuples(length, length, length, angle, st.floats(-90, 90), angle)


@given(pose)
def test_pose_turns_about_x_then_y_then_z(pose):
    """GR-10"""
    matrix = kin.pose_to_matrix(pose)
    x, y, z, a, b, c = pose
    np.testing.assert_allclose(matrix[:3, :3], turn(2, c) @ turn(1, b) @ turn(0, a), atol=1e-14)
    np.testing.assert_array_equal(matrix[:, 3], [x, y, z, 1])


@given(pose)
def test_pose_comes_back_as_the_same_frame(pose):
    """GR-10: in the gimbal lock, too, where A is 0."""
    matrix = kin.pose_to_matrix(pose)
    back = kin.matrix_to_pose(matrix)
    np.testing.assert_allclose(kin.pose_to_matrix(back), matrix, atol=1e-11)
    assert -90 <= back[4] <= 90
    assert kin.matrix_to_pose(kin.pose_to_matrix([0, 0, 0, 20, 90, 50]))[3] == 0


@given(pose, pose, st.floats(0, 1))
def test_interpolation_turns_evenly_about_one_axis(start, end, share):
    """GR-21: what is left to turn is the rest of the whole angle."""

    def between(a: np.ndarray, b: np.ndarray) -> float:
        relative = kin.pose_to_matrix(a)[:3, :3].T @ kin.pose_to_matrix(b)[:3, :3]
        return float(2 * np.arcsin(min(1, np.linalg.norm(relative - np.eye(3)) / np.sqrt(8))))

    (middle,) = kin.interpolate(start, end, [share])
    whole = between(start, end)
    assert between(start, middle) == pytest.approx(whole * share, abs=1e-7)
    assert between(middle, end) == pytest.approx(whole * (1 - share), abs=1e-7)
    np.testing.assert_allclose(middle[:3], np.array(start[:3]) * (1 - share) + np.array(end[:3]) * share, atol=1e-9)


@pytest.mark.parametrize("name", MECHANISMS)
@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1))
def test_forward_of_inverse_is_the_pose(name, seed):
    """GR-11"""
    robot, _ = MECHANISMS[name]
    joints = positions(name, 50, seed)
    poses = robot.forward(joints)
    near = joints + np.random.default_rng(seed).uniform(-1, 1, joints.shape)
    found = robot.inverse(poses, near)
    assert found.ok.all()
    back = robot.forward(found.joints)
    np.testing.assert_allclose(back[:, :3], poses[:, :3], atol=1e-9)
    np.testing.assert_allclose(
        kin.pose_to_matrix(back)[:, :3, :3], kin.pose_to_matrix(poses)[:, :3, :3], atol=1e-9 * np.pi / 180
    )
    np.testing.assert_allclose(found.joints, joints, atol=1e-6)


@pytest.mark.parametrize("name", MECHANISMS)
@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1))
def test_motion_is_the_jacobian_times_the_axes(name, seed):
    """GR-23"""
    robot, _ = MECHANISMS[name]
    joints = positions(name, 20, seed)
    rng = np.random.default_rng(seed)
    rates, changes = rng.uniform(-100, 100, joints.shape), rng.uniform(-1000, 1000, joints.shape)
    tool = robot.forward_motion(joints, rates, changes)
    expected = np.einsum("nij,nj->ni", robot.jacobian(joints), rates)
    np.testing.assert_allclose(tool.velocities, expected, rtol=1e-9, atol=1e-6)
    found = robot.inverse_motion(*tool, near=joints)
    assert found.ok.all()
    np.testing.assert_allclose(found.velocities, rates, rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(found.accelerations, changes, rtol=1e-4, atol=1e-2)


@pytest.mark.parametrize("name", MECHANISMS)
@settings(deadline=None, max_examples=15)
@given(seed=st.integers(0, 2**32 - 1))
def test_paths_do_not_jump(name, seed):
    """GR-12: point by point along a line: no axis makes a step, up to the point where a reason says that it ends."""
    robot, _ = MECHANISMS[name]
    start, end = positions(name, 2, seed)
    path = kin.interpolate(robot.forward(start), robot.forward(end), np.linspace(0, 1, 4001))
    found = robot.inverse(path, start, path=True)
    length = int(np.argmin(found.ok)) if not found.ok.all() else len(path)
    assert length > 0
    assert robot.configuration(found.joints[length - 1]) == robot.configuration(start)
    for i in np.flatnonzero(np.abs(np.diff(found.joints[:length], axis=0)).max(axis=1) >= 30):
        # A wrist nearly stretched turns as fast as that; looked at closely it is no step.
        near = robot.inverse(kin.interpolate(path[i], path[i + 1], np.linspace(0, 1, 4001)), found.joints[i], path=True)
        assert near.ok.all()
        assert np.abs(np.diff(near.joints, axis=0)).max() < 30
    assert np.isnan(found.joints[~found.ok]).all()


def test_single_rows_give_single_rows():
    robot = kin.Kinematics(delta=DELTA)
    assert robot.axes == 3
    assert robot.rotary == (True, True, True)
    assert robot.forward([10, 20, 30]).shape == (6,)
    assert robot.forward([[10, 20, 30]]).shape == (1, 6)
    assert robot.jacobian([10, 20, 30]).shape == (6, 3)
    assert robot.jacobian(np.zeros((5, 3))).shape == (5, 6, 3)
    with pytest.raises(ValueError, match="rows of 3 numbers"):
        robot.forward([1, 2])


@pytest.mark.parametrize("name", MECHANISMS)
@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1))
def test_links_keep_their_lengths_and_hang_together(name, seed):
    robot, _ = MECHANISMS[name]
    joints = positions(name, 5, seed)
    places = robot.link_places(joints)
    assert robot.links[0] == "base"
    np.testing.assert_allclose(places[:, -1, :3], robot.forward(joints)[:, :3], atol=1e-6)  # the last one is the tool
    lengths = np.linalg.norm(places[..., 3:] - places[..., :3], axis=-1)
    np.testing.assert_allclose(lengths, lengths[:1].repeat(5, axis=0), atol=1e-6)
    # The same by frames: where each begins, and its span turned by it.
    frames = robot.link_frames(joints)
    np.testing.assert_allclose(frames[:, -1], kin.pose_to_matrix(robot.forward(joints)), atol=1e-6)
    np.testing.assert_array_equal(frames[..., :3, 3], places[..., :3])
    ends = np.einsum("nlij,lj->nli", frames[..., :3, :3], robot.link_spans) + frames[..., :3, 3]
    np.testing.assert_allclose(ends, places[..., 3:], atol=1e-9)
    np.testing.assert_array_equal(robot.link_frames(joints[0]), frames[0])
    if name == "delta":
        link = {link: places[:, i] for i, link in enumerate(robot.links)}
        for arm in "123":
            upper, lower = link[f"upper_arm_{arm}"], link[f"lower_arm_{arm}_a"]
            np.testing.assert_allclose(np.linalg.norm(upper[:, :3], axis=1), DELTA["base_radius"])
            np.testing.assert_allclose(upper[:, 3:], lower[:, :3], atol=1e-6)
            np.testing.assert_allclose(np.linalg.norm(upper[:, 3:] - upper[:, :3], axis=1), DELTA["upper_arm"])
            np.testing.assert_allclose(np.linalg.norm(lower[:, 3:] - lower[:, :3], axis=1), DELTA["lower_arm"])
            to_platform = np.linalg.norm(lower[:, 3:] - link["tool"][:, :3], axis=1)
            np.testing.assert_allclose(to_platform, DELTA["platform_radius"])


def test_reasons_say_why_not():
    """GR-12"""
    robot = kin.Kinematics(delta=DELTA)
    found = robot.inverse([[0, 0, -900, 0, 0, 0], [0, 0, -3000, 0, 0, 0], [0, 0, -900, 5, 0, 0], [np.nan] * 6])
    assert found.reasons.tolist() == ["none", "out_of_reach", "orientation", "not_finite"]
    assert found.ok.tolist() == [True, False, False, False]
    robot.ranges = [(-10, 60)] * 3
    assert robot.inverse([[0, 0, -900, 0, 0, 0]]).reasons.tolist() == ["axis_limit"]
    np.testing.assert_array_equal(robot.ranges, [(-10, 60)] * 3)
    wide = kin.Kinematics(delta={"base_radius": 500, "platform_radius": 0, "upper_arm": 300, "lower_arm": 700})
    with pytest.raises(kin.KinematicsError, match="row 1: the place is out of reach") as caught:
        wide.forward([[90, 90, 90], [0, 0, 0]])
    assert caught.value.reason == "out_of_reach"


def test_eight_branches_of_an_arm():
    """GR-11"""
    robot = kin.Kinematics(six_axis=PUMA)
    pose = robot.forward([20, 30, 40, 50, 60, 70])
    seen = set()
    for shoulder in ("front", "back"):
        for elbow in ("positive", "negative"):
            for wrist in ("positive", "negative"):
                found = robot.inverse(pose, shoulder=shoulder, elbow=elbow, wrist=wrist)
                assert found.ok.all()
                assert robot.configuration(found.joints[0]) == (shoulder, elbow, wrist)
                np.testing.assert_allclose(robot.forward(found.joints)[0, :3], pose[:3], atol=1e-9)
                seen.add(tuple(np.round(found.joints[0], 6)))
    assert len(seen) == 8


@pytest.mark.parametrize(
    ("params", "sentence"),
    [
        ({}, "expected exactly one of the keys"),
        ({"scara": {"first_arm": -1, "second_arm": 2}}, "scara.first_arm: expected a number in mm above 0, found -1"),
        ({"scara": {"first_arm": 1, "second": 2}}, "scara: expected a known key, found 'second'"),
        ({"robot": {}}, "found 'robot'"),
        ({"serial": {"urdf": "missing.urdf"}}, "serial.urdf: cannot read"),
    ],
)
def test_wrong_parameters_are_explained(params, sentence):
    with pytest.raises(takt.ConfigError) as caught:
        kin.Kinematics(**params)
    assert sentence in str(caught.value)


def test_urdf_files_are_utf_8(tmp_path):
    """EN-37: others are refused with place and byte, in machine files and Kinematics; a byte order mark is skipped."""
    text = (URDF / "puma.urdf").read_text().replace("</robot>", "<!-- f\u00fcr -->\n</robot>")
    axes = [f"a{i}" for i in range(6)]
    limits = "unit: deg, limits: {velocity: 1, acceleration: 1, jerk: 1}"
    machine = "name: m\naxes:\n" + "".join(f"  - {{name: {axis}, {limits}}}\n" for axis in axes)
    machine += (
        f"groups:\n  - name: robot\n    axes: [{', '.join(axes)}]\n    kinematics: {{serial: {{urdf: arm.urdf}}}}\n"
    )
    machine += "    path: {velocity: 1, acceleration: 1, jerk: 1}\n"
    (tmp_path / "m.yaml").write_text(machine)
    for encoding, problem in (("latin-1", "expected text in UTF-8, found the byte 0xfc"), ("utf-8-sig", "")):
        (tmp_path / "arm.urdf").write_bytes(text.encode(encoding))
        if not problem:
            assert kin.Kinematics(serial={"urdf": "arm.urdf"}, folder=tmp_path).axes == 6
            takt.Engine(tmp_path / "m.yaml").close()
            continue
        place = rf"arm\.urdf:{1 + text[: text.index('<!-- f')].count(chr(10))}:7: "
        with pytest.raises(takt.ConfigError, match=place + problem):
            kin.Kinematics(serial={"urdf": "arm.urdf"}, folder=tmp_path)
        with pytest.raises(takt.ConfigError, match=place + r"groups\[0\]\.kinematics\.serial\.urdf: " + problem):
            takt.Engine(tmp_path / "m.yaml")


def test_an_unknown_branch_is_explained():
    with pytest.raises(takt.ConfigError, match="expected one of keep, front, back, found 'left'"):
        kin.Kinematics(six_axis=PUMA).inverse([500, 0, 500, 0, 90, 0], shoulder="left")  # type: ignore[arg-type]
