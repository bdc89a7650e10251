"""Scenes in MCAP (PY-27): read back by the package's own reader, every message as its schema says, frames where
takt.kinematics has them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import takt
from mcap.reader import make_reader
from takt.export import to_mcap
from takt.kinematics import Kinematics, pose_to_matrix
from takt.ready import EXAMPLES
from takt.recording import Recording
from takt.scene import matrix_of
from test_scene import one_group, with_held

DELTA = {"delta": {"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 800}}
BELT = """  - {name: drive, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 200000}}
belts:
  - {name: infeed, axis: drive, origin: {x: 900, z: 50, c: 90}, lower_limit: 100, upper_limit: 500}
"""


@pytest.fixture(scope="module")
def recording() -> Recording:
    """A Delta that moves over a belt with an object on it."""
    head, groups = one_group(DELTA).split("groups:\n")
    with takt.Engine(f"{head}{BELT}groups:\n{groups}") as session:
        recorder = session.record()
        for number, target in enumerate((20.0, 35.0, 50.0)):
            session.axis(f"a{number}").power().wait()
            session.axis(f"a{number}").move_absolute(position=target)
        session.axis("drive").power().wait()
        session.axis("drive").move_velocity(velocity=200)
        session.belt("infeed").detect(recorded_position=0.0, x=0.0).wait()
        session.run(1.0)
        return recorder.stop()


def read(path: Path) -> dict[str, list[tuple[int, dict[str, Any]]]]:
    """Messages by topic, of the scene; each is as its schema says."""
    found: dict[str, list[tuple[int, dict[str, Any]]]] = {"/tf": [], "/scene": []}
    names = {"/tf": "foxglove.FrameTransforms", "/scene": "foxglove.SceneUpdate"}
    checks: dict[str, Any] = {}
    for schema, channel, message in make_reader(path.open("rb")).iter_messages(topics=list(found)):
        assert schema is not None
        assert (schema.name, schema.encoding) == (names[channel.topic], "jsonschema")
        if channel.topic not in checks:
            checks[channel.topic] = jsonschema.Draft202012Validator(json.loads(schema.data))
        content = json.loads(message.data)
        checks[channel.topic].validate(content)
        found[channel.topic].append((message.log_time, content))
    return found


def test_frames_and_solids_of_a_run(recording: Recording, tmp_path: Path) -> None:
    to_mcap(recording, tmp_path / "a.mcap")
    found = read(tmp_path / "a.mcap")
    _, first = found["/scene"][0]
    entities = {entity["id"]: entity for entity in first["entities"]}
    frames = {
        transform["child_frame_id"]
        for _, message in found["/tf"]
        for transform in message["transforms"]
        if transform["parent_frame_id"] == "world"
    }
    assert {entity["frame_id"] for entity in entities.values()} <= frames
    assert {"infeed", "robot.base", "robot.platform", "robot.lower_arm_1_a"} <= set(entities)
    rod = entities["robot.lower_arm_1_a"]
    assert (len(rod["cylinders"]), len(rod["spheres"])) == (1, 2)  # a capsule
    assert rod["cylinders"][0]["size"]["z"] == pytest.approx(0.8)
    # What lies on the belt goes along with it.
    lying = [message["entities"][0]["cubes"] for _, message in found["/scene"][1:]]
    places = [cubes[0]["pose"]["position"] for cubes in lying if cubes]
    assert places[-1]["y"] - places[0]["y"] > 0.1
    assert {place["x"] for place in places} == {0.9}
    # The tool is where the kinematics have it, at each time that says so.
    mechanism = Kinematics(**DELTA)
    base = np.asarray(pose_to_matrix([100, -200, 700, 10, -20, 130]))
    seen = 0
    for time_ns, message in found["/tf"]:
        for transform in message["transforms"]:
            if transform["child_frame_id"] != "robot.tool":
                continue
            assert transform["timestamp"]["sec"] * 10**9 + transform["timestamp"]["nsec"] == time_ns
            axes = [recording[axis] for axis in ("a0", "a1", "a2")]
            rows = [np.searchsorted(axis["time_s"], time_ns / 1e9 + 1e-9, side="right") - 1 for axis in axes]
            joints = [axis["actual_position"][max(row, 0)] for axis, row in zip(axes, rows, strict=True)]
            pose = [transform["translation"][k] * 1000 for k in "xyz"] + [transform["rotation"][k] for k in "xyzw"]
            expected = base @ np.asarray(pose_to_matrix(mechanism.forward(joints)))
            np.testing.assert_allclose(matrix_of(np.array(pose)), expected, atol=0.02)
            seen += 1
    assert seen > 10


def test_what_a_module_holds_comes_and_goes(tmp_path: Path) -> None:
    """Solids that go with the tool, as long as it holds something."""
    with takt.Engine(EXAMPLES / "pick_cell" / "machine.yaml") as session:
        recorder = session.record()
        session.run(1.0)
        recording = with_held(recorder.stop(), 0.3, 0.7)
    to_mcap(recording, tmp_path / "a.mcap")
    found = read(tmp_path / "a.mcap")
    assert "picker.held" in {one["child_frame_id"] for _, message in found["/tf"] for one in message["transforms"]}
    came = [at for at, message in found["/scene"] if any(e["id"] == "picker.held" for e in message["entities"])]
    went = [at for at, message in found["/scene"] if any(d["id"] == "picker.held" for d in message["deletions"])]
    assert np.array([*came, *went]) / 1e9 == pytest.approx([0.32, 0.72], abs=0.03)


def test_what_is_not_known_is_left_out(recording: Recording, tmp_path: Path) -> None:
    """Without a machine, of a part of the signals, and where an axis of the group was not recorded."""
    names = ("a0", "a1", "drive", "infeed")
    nowhere = recording.pick((name, field) for name in names for field in recording.fields(name))
    to_mcap(nowhere, tmp_path / "a.mcap")
    frames = {t["child_frame_id"] for _, message in read(tmp_path / "a.mcap")["/tf"] for t in message["transforms"]}
    assert frames == {"infeed", "infeed.marks"}
    to_mcap(recording, tmp_path / "b.mcap", scene=False)
    assert not any(read(tmp_path / "b.mcap").values())
    to_mcap(Recording({"x": {"time_s": [0.0], "p": [1.0]}}), tmp_path / "c.mcap")
    assert not any(read(tmp_path / "c.mcap").values())
