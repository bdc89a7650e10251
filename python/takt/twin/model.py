"""The model of a twin, generated or read, with its joints by axis and its tools by group. Checks that model and machine
file agree."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from takt import _core
from takt.errors import ConfigError
from takt.kinematics import Kinematics, KinematicsError
from takt.names import shown
from takt.twin import made
from takt.twin.places import Problems, mujoco_missing, near
from takt.urdf_files import urdf_folders

Array = npt.NDArray[np.float64]

FITS_MM = 0.5  # admissible deviation of a model's tool from the kinematics
FITS_DEG = 0.5
STABLE = 0.8  # gain of all velocity loops together over one step: below 2, with a margin for other poses
LOOP_MM = 0.05  # admissible gap of a closed loop at the start
PER_M = 1000.0  # mm
PER_RAD = 180 / math.pi  # deg


@dataclass(frozen=True)
class Joint:
    """An axis and a joint of the model: position [u] = zero [u] + scale [u/m or u/rad] * joint [m or rad]."""

    axis: str
    name: str
    position: int  # index in qpos
    velocity: int  # index in qvel
    scale: float
    zero: float


@dataclass(frozen=True)
class Tool:
    """The flange of a group in the model, and Takt's kinematics of it."""

    group: str
    kinematics: Kinematics
    rows: tuple[int, ...]  # indices of its axes among those of the twin
    site: int  # of the model; -1: the flange is a body
    body: int  # of the model; -1: the flange is a site
    base: Array  # (4, 4) [mm] pose of the group's MCS in the world

    def pose_in(self, data: Any) -> tuple[Array, Array]:
        """Returns position (3,) [m] and rotation matrix (9,), row by row, of the flange in the world, from MuJoCo."""
        if self.site >= 0:
            return data.site_xpos[self.site], data.site_xmat[self.site]
        return data.xpos[self.body], data.xmat[self.body]

    def expected(self, joints: npt.ArrayLike) -> tuple[Array, Array]:
        """Returns positions (n, 3) [mm] and rotations (n, 3, 3) of the flange in the world, from Takt's kinematics, for
        positions of its axes (n, axes) [u]. Raises KinematicsError if the kinematics have no solution."""
        poses = np.atleast_2d(self.kinematics.forward(joints))
        turns = rotations(poses[:, 3:])
        return poses[:, :3] @ self.base[:3, :3].T + self.base[:3, 3], self.base[:3, :3] @ turns


@dataclass
class Model:
    """A model and its initial state."""

    model: Any  # mujoco.MjModel
    data: Any
    joints: tuple[Joint, ...]
    tools: tuple[Tool, ...]
    inertia: Array  # [kg m2 or kg] for which the gain of each drive is set


def rotations(angles: Array) -> Array:
    """Returns the rotation matrices (n, 3, 3), Rz(c) Ry(b) Rx(a), of angles a, b, c (n, 3) [deg] about the fixed axes
    X, Y, Z."""
    a, b, c = np.radians(angles).T
    zero, one = np.zeros_like(a), np.ones_like(a)

    def matrix(*rows: Array) -> Array:
        return np.stack(rows, axis=-1).reshape(-1, 3, 3)

    about_x = matrix(one, zero, zero, zero, np.cos(a), -np.sin(a), zero, np.sin(a), np.cos(a))
    about_y = matrix(np.cos(b), zero, np.sin(b), zero, one, zero, -np.sin(b), zero, np.cos(b))
    about_z = matrix(np.cos(c), -np.sin(c), zero, np.sin(c), np.cos(c), zero, zero, zero, one)
    return np.asarray(about_z @ about_y @ about_x)


def build(text: bytes, file_name: str, machine: Mapping[str, Any], step_s: float) -> Model:
    """Returns the model of a machine's twin, at rest at the start positions of its axes. step_s: time step [s].

    Raises TaktError if MuJoCo is not installed, ConfigError if the section `twin` is missing or the model does not fit.
    """
    try:
        import mujoco
    except ImportError:
        raise mujoco_missing() from None
    twin = machine.get("twin")
    if twin is None:
        raise Problems(text, file_name).fail(
            "twin", "expected a section that says which axes the twin moves (docs: A twin), found none"
        )
    builder = _Builder(mujoco, text, file_name, machine, step_s)
    warned = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(silent)
    try:
        return builder.from_file() if twin["model"] else builder.from_kinematics()
    finally:
        mujoco.set_mju_user_warning(warned)


def silent(_: str) -> None:
    """Discards MuJoCo's own warnings, which would otherwise be printed and written to MUJOCO_LOG.TXT in the working
    directory. A twin reads them from its data, and reports them with cycle and joint."""


class _Builder:
    def __init__(self, mujoco: Any, text: bytes, file_name: str, machine: Mapping[str, Any], step_s: float):
        self.mujoco, self.problems = mujoco, Problems(text, file_name)
        self.machine, self.twin, self.step_s = machine, machine["twin"], step_s
        self.folder = Path(file_name).resolve().parent
        self.urdf_folders = urdf_folders(text.decode(), self.folder)
        self.axes = {axis["name"]: axis for axis in machine["axes"]}
        self.moved = [axis["axis"] for axis in self.twin["axes"]]
        self.groups = [
            group
            for group in machine["groups"]
            if group.get("kinematics") and any(axis in self.moved for axis in group["axes"])
        ]

    # --- both kinds of models ---

    def compiled(self, spec: Any, path: str) -> Any:
        try:
            model = spec.compile()
        except Exception as error:  # the compiler's own message names the element
            raise self.problems.fail(path, f"MuJoCo does not take the model: {_line(error)}") from None
        model.opt.timestep = self.step_s
        model.opt.disableflags |= int(self.mujoco.mjtDisableBit.mjDSBL_ACTUATION)
        model.opt.disableflags |= int(self.mujoco.mjtDisableBit.mjDSBL_AUTORESET)
        return model

    def rotary(self, axis: str) -> bool:
        """True if an axis without a mechanism is rotary."""
        return bool(self.axes[axis]["unit"] == "deg")

    def joint_of(self, model: Any, number: int, name: str) -> Joint | None:
        """Returns the joint of an axis; None, with a problem added, if it does not fit."""
        axis, path = self.moved[number], f"twin.axes[{number}].joint"
        names = [model.joint(i).name for i in range(model.njnt)]
        if name not in names:
            self.problems.add(path, f"expected the name of a joint of the model, found '{name}'{near(name, names)}")
            return None
        joint = model.joint(name)
        kinds = self.mujoco.mjtJoint
        turns, slides = int(joint.type[0]) == int(kinds.mjJNT_HINGE), int(joint.type[0]) == int(kinds.mjJNT_SLIDE)
        if not turns and not slides:
            self.problems.add(path, f"expected a joint that turns or slides, found '{name}', which does neither alone")
            return None
        group, place = self.member(axis)
        if group is not None:
            expected = Kinematics(folder=self.folder, **mechanism(group)).rotary[place]
        else:
            expected = self.rotary(axis)
        if expected != turns:
            is_, wants = ("turns", "a joint that slides") if turns else ("slides", "a joint that turns")
            self.problems.add(path, f"expected {wants}, as axis {axis} does, found '{name}', which {is_}")
            return None
        scale, zero = (PER_RAD if turns else PER_M), 0.0
        if group is not None and group["kinematics"]["joints"]:
            counts = group["kinematics"]["joints"][place]
            scale, zero = -scale if counts["invert"] else scale, counts["zero"]
        return Joint(axis, name, int(joint.qposadr[0]), int(joint.dofadr[0]), scale, zero)

    def member(self, axis: str) -> tuple[Mapping[str, Any] | None, int]:
        """Returns the group whose mechanism an axis moves, and the index of the axis in it; None and -1 if there is
        none."""
        for group in self.groups:
            count = Kinematics(folder=self.folder, **mechanism(group)).axes
            if axis in group["axes"][:count]:
                return group, list(group["axes"]).index(axis)
        return None, -1

    def tool_of(self, model: Any, group: Mapping[str, Any], name: str, path: str) -> Tool | None:
        sites = [model.site(i).name for i in range(model.nsite)]
        bodies = [model.body(i).name for i in range(model.nbody)]
        if name not in sites and name not in bodies:
            known = near(name, [one for one in sites + bodies if one])
            self.problems.add(path, f"expected the name of a site or body of the model, found '{name}'{known}")
            return None
        site = sites.index(name) if name in sites else -1
        body = bodies.index(name) if site < 0 else -1
        kinematics = Kinematics(folder=self.folder, **mechanism(group))
        missing = [axis for axis in group["axes"][: kinematics.axes] if axis not in self.moved]
        if missing:
            self.problems.add("twin.axes", f"expected all axes of group {group['name']}, found no {missing[0]}")
            return None
        rows = tuple(self.moved.index(axis) for axis in group["axes"][: kinematics.axes])
        base = np.eye(4)
        pose = group["base"]
        base[:3, :3] = rotations(np.array([[pose["a"], pose["b"], pose["c"]]]))[0]
        base[:3, 3] = pose["x"], pose["y"], pose["z"]
        return Tool(group["name"], kinematics, rows, site, body, base)

    def add_drive_trains(self, model: Any, joints: Sequence[Joint]) -> None:
        """Adds rotor inertia and friction to the joints."""
        for joint, told in zip(joints, self.twin["axes"], strict=True):
            model.dof_armature[joint.velocity] += told["rotor_inertia"]
            model.dof_frictionloss[joint.velocity] += told["coulomb_friction"]
            model.dof_damping[joint.velocity] += told["viscous_friction"]
            if told["coulomb_friction"]:
                # MuJoCo's friction is soft: a joint held by it creeps at 1 ms times the acceleration that is held back.
                # With these parameters it is less than 1 us times that.
                model.dof_solref[joint.velocity] = (2 * self.step_s, 1.0)
                model.dof_solimp[joint.velocity, :2] = (0.999, 0.999)

    def start_of(self, axis: str) -> float:
        servos = self.machine["simulation"]["servos"]
        return float(next((s["mechanics"]["start_position"] for s in servos if s["axis"] == axis), 0.0))

    def time_constant_of(self, axis: str) -> float:
        """Returns the time constant [s] of the velocity loop of an axis' drive."""
        servos = self.machine["simulation"]["servos"]
        return float(next((s["drive"]["velocity_time_constant_s"] for s in servos if s["axis"] == axis), 0.001))

    def done(self, model: Any, data: Any, joints: Sequence[Joint], tools: Sequence[Tool]) -> Model:
        self.mujoco.mj_forward(model, data)
        self.check_loops(model, data)
        self.check_tools(data, joints, tools)
        self.problems.end()
        inertia = self.inertia_of(model, data, joints)
        return Model(model, data, tuple(joints), tuple(tools), inertia)

    def check_loops(self, model: Any, data: Any) -> None:
        kinds = self.mujoco.mjtConstraint
        rows = np.flatnonzero(data.efc_type[: data.nefc] == int(kinds.mjCNSTR_EQUALITY))
        if not len(rows):
            return
        worst = rows[np.argmax(np.abs(data.efc_pos[rows]))]
        open_mm = abs(float(data.efc_pos[worst])) * PER_M
        if open_mm > LOOP_MM:
            number = int(data.efc_id[worst])
            name = model.equality(number).name or f"number {number}"
            path = "twin.model" if self.twin["model"] else "twin.mechanisms"
            self.problems.add(
                path, f"expected loops that close at the start, found {open_mm:.3g} mm between the ends of {name}"
            )

    def check_tools(self, data: Any, joints: Sequence[Joint], tools: Sequence[Tool]) -> None:
        for tool in tools:
            at = np.array([joints[row].zero + joints[row].scale * data.qpos[joints[row].position] for row in tool.rows])
            place, turn = tool.pose_in(data)
            expected, expected_turn = tool.expected(at)
            off = float(np.linalg.norm(place * PER_M - expected[0]))
            turned = math.degrees(
                math.acos(np.clip((np.trace(expected_turn[0].T @ turn.reshape(3, 3)) - 1) / 2, -1, 1))
            )
            if off > FITS_MM or turned > FITS_DEG:
                number = next((i for i, m in enumerate(self.twin["mechanisms"]) if m["group"] == tool.group), None)
                path = "twin.model" if number is None else f"twin.mechanisms[{number}]"
                sentence = f"expected the tool of {tool.group} where its kinematics say, found it {off:.4g} mm"
                self.problems.add(path, f"{sentence} and {turned:.3g} deg away, at the start")

    def inertia_of(self, model: Any, data: Any, joints: Sequence[Joint]) -> Array:
        """Returns the inertia for which each motor's gain is set: the one it moves in the initial pose while the others
        hold, reduced if all loops together would be unstable. It is computed from accelerations per torque, so that
        closed chains are included."""
        losses = model.dof_frictionloss.copy()
        model.dof_frictionloss[:] = 0
        data.qvel[:] = 0
        self.mujoco.mj_forward(model, data)
        dofs = [joint.velocity for joint in joints]
        at_rest = data.qacc[dofs]
        gained = np.zeros((len(joints), len(joints)))
        for row, joint in enumerate(joints):
            data.qfrc_applied[joint.velocity] = 1.0
            self.mujoco.mj_forward(model, data)
            gained[:, row] = data.qacc[dofs] - at_rest
            data.qfrc_applied[joint.velocity] = 0.0
            if not gained[row, row] > 1e-9:
                sentence = f"expected that its motor can move it, found that joint '{joint.name}' is held"
                self.problems.add(f"twin.axes[{row}]", sentence)
        model.dof_frictionloss[:] = losses
        self.mujoco.mj_forward(model, data)
        self.problems.end()
        held = np.diag(np.linalg.inv(gained))
        shares = [1 - math.exp(-self.step_s / self.time_constant_of(joint.axis)) for joint in joints]
        swing = float(np.abs(np.linalg.eigvals(gained * held)).max())
        return np.asarray(held * min(1.0, STABLE / (max(shares) * swing)))

    # --- generated ---

    def from_kinematics(self) -> Model:
        parts, twin = made.Made(), self.twin
        alone = [(n, axis) for n, axis in enumerate(twin["axes"]) if self.member(axis["axis"])[0] is None]
        for number, group in enumerate(self.groups):
            if made.mechanism_of(group)[0] == "serial":
                continue
            if made.mechanism_of(group)[0] == "core_xy":
                raise self.problems.fail("twin", f"group {group['name']}: core_xy cannot be made; give a model")
            made.add_group(parts, number, group, twin)
        belts = {one["name"]: one for one in self.machine["belts"]}
        of_belts = {belts[one["belt"]]["axis"]: one for one in twin["belts"]}
        for place, (_, axis) in enumerate(alone):
            if belt := of_belts.get(axis["axis"]):
                if self.rotary(axis["axis"]):
                    raise self.problems.fail(
                        f"twin.belts[{twin['belts'].index(belt)}].belt",
                        f"expected a belt whose axis is in mm, found that {axis['axis']} is in deg",
                    )
                made.add_belt(parts, belt, belts[belt["belt"]], axis)
            else:
                made.add_alone(parts, len(self.groups) + place, place, axis, self.rotary(axis["axis"]))
        if products := twin.get("products"):
            made.add_products(parts, products, twin["belts"])
            for mechanism in twin["mechanisms"]:
                if mechanism.get("gripper"):
                    group = next(one for one in self.groups if one["name"] == mechanism["group"])
                    made.add_gripper(parts, group, products["count"])
        spec = self.mujoco.MjSpec.from_string(made.document(self.machine["name"], parts, self.step_s))
        for number, group in enumerate(self.groups):
            if made.mechanism_of(group)[0] == "serial":
                self.attach(spec, number, group, parts)
        model = self.compiled(spec, "twin")
        joints = [self.joint_of(model, n, parts.joints[axis]) for n, axis in enumerate(self.moved)]
        tools = [self.tool_of(model, group, parts.tools[group["name"]], "twin.mechanisms") for group in self.groups]
        self.problems.end()
        fitting = [joint for joint in joints if joint is not None]
        self.add_drive_trains(model, fitting)
        data = self.mujoco.MjData(model)
        for joint in fitting:
            data.qpos[joint.position] = (self.start_of(joint.axis) - joint.zero) / joint.scale
        found = [tool for tool in tools if tool is not None]
        for tool, group in zip(found, self.groups, strict=True):
            if made.mechanism_of(group)[0] == "delta":
                self.assemble(model, data, tool, group, fitting)
        return self.done(model, data, fitting, found)

    def assemble(self, model: Any, data: Any, tool: Tool, group: Mapping[str, Any], joints: Sequence[Joint]) -> None:
        """Sets the platform of a Delta to its pose at the start positions of the axes, and turns the rods to it."""
        at = [self.start_of(joints[row].axis) for row in tool.rows]
        try:
            places, _ = tool.expected(at)
        except KinematicsError as error:
            number = next(i for i, m in enumerate(self.twin["mechanisms"]) if m["group"] == group["name"])
            raise self.problems.fail(
                f"twin.mechanisms[{number}]", f"expected loops that close at the start, {at}: {error}"
            ) from None
        free = model.joint(f"{group['name']}.platform").qposadr[0]
        data.qpos[free : free + 3] = places[0] / PER_M
        self.mujoco.mju_mat2Quat(data.qpos[free + 3 : free + 7], tool.base[:3, :3].ravel())
        self.mujoco.mj_kinematics(model, data)
        for i in range(3):
            for k in range(2):
                name = f"{group['name']}.rod_{i + 1}{k + 1}"
                knee = data.xpos[model.body(name).id]
                wanted = data.site_xpos[model.site(name + ".at").id] - knee
                parent = data.xmat[model.body(group["axes"][i]).id].reshape(3, 3)
                quat = np.zeros(4)
                self.mujoco.mju_quatZ2Vec(quat, -(parent.T @ wanted) / np.linalg.norm(wanted))
                ball = model.joint(name).qposadr[0]
                data.qpos[ball : ball + 4] = quat

    # --- from URDF of the kinematics ---

    def attach(self, spec: Any, number: int, group: Mapping[str, Any], parts: made.Made) -> None:
        kinematics = group["kinematics"]["serial"]
        path = f"groups[{self.machine['groups'].index(group)}].kinematics.serial.urdf"
        text = kinematics["urdf"]
        child = self.read_urdf(text, path, self.urdf_folders.get(group["name"], self.folder))
        names, tip = _core.urdf_chain_names(text, kinematics["base"], kinematics["tip"])
        for body in child.bodies:
            for geom in body.geoms:
                own = 1 << (number % made.GROUPS)
                geom.contype, geom.conaffinity = own, ((1 << made.GROUPS) - 1) & ~own | made.ENVIRONMENT
        pose, prefix = group["base"], f"{group['name']}."
        quat = np.zeros(4)
        turn = rotations(np.array([[pose["a"], pose["b"], pose["c"]]]))[0]
        self.mujoco.mju_mat2Quat(quat, turn.ravel())
        frame = spec.worldbody.add_frame(pos=[pose[k] / PER_M for k in "xyz"], quat=quat)
        told = next((m for m in self.twin["mechanisms"] if m["group"] == group["name"]), None)
        flange = child.body(tip)
        if flange is None:
            raise self.problems.fail(path, f"expected link '{tip}' in the model that MuJoCo made of it, found none")
        flange.add_site(name="flange")
        if told and told["payload"]:
            at = [group["tool"][k] / PER_M for k in "xyz"]
            flange.add_geom(type=self.mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.015, 0, 0], pos=at, mass=told["payload"])
        spec.attach(child, frame=frame, prefix=prefix)
        for axis, name in zip(group["axes"], names, strict=False):
            parts.joints[axis] = prefix + name
        parts.tools[group["name"]] = prefix + "flange"

    def read_urdf(self, text: str, path: str, folder: Path) -> Any:
        """Returns the model of a URDF in `folder`; its meshes are resolved as those of a workspace."""
        try:
            spec = self.mujoco.MjSpec.from_string(text)
        except Exception as error:
            raise self.problems.fail(path, f"MuJoCo cannot read it: {_line(error)}") from None
        spec.compiler.fusestatic = False
        # Meshes not found in this way are searched in the folder that MuJoCo's own element of the URDF names.
        own = folder / spec.compiler.meshdir
        spec.strippath = False
        for mesh in spec.meshes:
            file = _core.urdf_mesh_file(mesh.file, shown(folder))
            mesh.file = file if Path(file).is_file() else _core.urdf_mesh_file(mesh.file, shown(own))
        return spec

    # --- from a file ---

    def from_file(self) -> Model:
        file = self.folder / self.twin["model"]
        try:
            text = file.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            why = error.strerror if isinstance(error, OSError) else "it is no text"
            raise self.problems.fail("twin.model", f"{file}: cannot be read: {why}") from None
        if "<robot" in text:
            spec = self.read_urdf(text, "twin.model", file.parent)
        else:
            try:
                spec = self.mujoco.MjSpec.from_file(str(file))
            except Exception as error:
                raise self.problems.fail("twin.model", f"MuJoCo cannot read it: {_line(error)}") from None
        model = self.compiled(spec, "twin.model")
        joints = [self.joint_of(model, n, axis["joint"]) for n, axis in enumerate(self.twin["axes"])]
        tools = []
        for number, told in enumerate(self.twin["mechanisms"]):
            group = next(g for g in self.machine["groups"] if g["name"] == told["group"])
            if told["tool"]:
                tools.append(self.tool_of(model, group, told["tool"], f"twin.mechanisms[{number}].tool"))
        names = [joint.name for joint in joints if joint is not None]
        for number, name in enumerate(names):
            if name in names[:number]:
                self.problems.add(f"twin.axes[{number}].joint", f"expected each joint once, found '{name}' again")
        self.problems.end()
        fitting = [joint for joint in joints if joint is not None]
        self.add_drive_trains(model, fitting)
        data = self.mujoco.MjData(model)
        for joint in fitting:
            data.qpos[joint.position] = (self.start_of(joint.axis) - joint.zero) / joint.scale
        return self.done(model, data, fitting, [tool for tool in tools if tool is not None])


def mechanism(group: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the arguments of takt.kinematics.Kinematics for a group."""
    kind, params = made.mechanism_of(group)
    found: dict[str, Any] = {kind: params}
    if group["kinematics"]["joints"]:
        found["joints"] = group["kinematics"]["joints"]
    return found


def _line(error: Exception) -> str:
    return " ".join(str(error).split())


__all__ = ["ConfigError", "Joint", "Model", "Tool", "build", "rotations"]
