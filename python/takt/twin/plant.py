"""A machine's twin as the plant of its engine: MuJoCo simulates the mechanics, Takt's simulated drives convert set
points into torques, and its encoders and switches read the joints.

In each cycle every drive takes its set point, then MuJoCo makes the cycle's steps with the torques that the drives
command at the beginning of each step, then the encoders are read. The result is a function of the set points alone: a
run is reproducible, bit for bit, on the same build of MuJoCo and the same processor.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from takt import _core
from takt.plant import Plant, PlantError, Rows
from takt.twin.cargo import Cargo
from takt.twin.model import Array, Model, build, silent

if TYPE_CHECKING:
    from takt.recording import Recording

MOST_KEPT = 4096  # cached results of contact checks
FASTEST = 1e6  # [m/s or rad/s] above this speed the physics has exploded


@dataclass(frozen=True)
class Frame:
    """A state of the model, as `takt.twin.picture` draws it."""

    cycle: int
    positions: Array  # MuJoCo's qpos
    velocities: Array  # MuJoCo's qvel


@dataclass(frozen=True)
class ContactSeen:
    """Two bodies that touched, at their first contact."""

    cycle: int
    bodies: tuple[str, str]
    depth_mm: float
    at_mm: tuple[float, float, float]


@dataclass(frozen=True)
class Seen:
    """What the twin measured, one row for each cycle from 0 on."""

    joints: Array  # (n, axes) [u], at the last step of the physics in the cycle
    torques: Array  # (n, axes) [Nm or N] of the motors
    limited: np.ndarray[Any, np.dtype[np.bool_]]  # (n, axes): True if the motor was at its limit
    tools: dict[str, tuple[Array, Array]]  # by group: (n, 3) [mm] and (n, 3, 3), in the world, at the same instant


class Twin(Plant):
    """The twin of a machine, `takt.Engine(machine, plant="mujoco")`; each engine needs a twin of its own."""

    def __init__(
        self,
        text: bytes,
        file_name: str | os.PathLike[str],
        machine: Mapping[str, Any],
        period: float | None = None,
    ) -> None:
        self._period_s = period or float(machine["cycle"]["period_s"])
        twin: Mapping[str, Any] = machine.get("twin") or {"step_s": 1.0, "axes": ()}  # build raises the error then
        self.steps = max(1, round(self._period_s / twin["step_s"]))
        self.built: Model = build(text, os.fspath(file_name), machine, self._period_s / self.steps)
        self.name = str(machine["name"])
        self.axes = tuple(joint.axis for joint in self.built.joints)
        self.contacts: dict[tuple[str, str], ContactSeen] = {}
        self.limits = {axis["axis"]: float(axis["max_torque"]) for axis in twin["axes"]}
        import mujoco

        self._mj_step = mujoco.mj_step
        self._warned, self._warn = mujoco.get_mju_user_warning, mujoco.set_mju_user_warning
        self._servos = _core.MovedServos(text, os.fspath(file_name), self._period_s, self.steps)
        for joint, told, inertia in zip(self.built.joints, twin["axes"], self.built.inertia, strict=True):
            most = told["max_torque"]
            brake = told.get("brake_torque", most)
            self._servos.add(joint.axis, joint.position, joint.velocity, joint.scale, joint.zero, inertia, most, brake)
        self._servos.start()
        model, data = self.built.model, self.built.data
        # Views of MuJoCo's own memory: reading them through the data takes longer than a step of a small model.
        self._qpos, self._qvel, self._torques = data.qpos, data.qvel, data.qfrc_applied
        self._warnings = data.warning.number
        self._no_warnings = self._warnings.tobytes()
        self._poses = [view for tool in self.built.tools for view in tool.pose_in(data)]
        self._ahead = np.zeros(model.nv)
        self._places = np.array([joint.position for joint in self.built.joints])
        self._scales = np.array([joint.scale for joint in self.built.joints])
        self._zeros = np.array([joint.zero for joint in self.built.joints])
        carries = twin["belts"] or twin.get("products")
        self.cargo = Cargo(mujoco, machine, self.built, self.axes, self._period_s) if carries else None
        self._allowed = self.cargo.allowed if self.cargo else np.zeros((model.ngeom, model.ngeom), bool)
        # By the shapes of all contacts, as bytes: the contacts not allowed. They hardly change from cycle to cycle.
        self._suspects: dict[bytes, list[int]] = {}
        self._rows: list[tuple[Any, ...]] = []
        self._good = (data.qpos.copy(), data.qvel.copy())
        self._cycle = -1

    @classmethod
    def of(cls, machine: str | os.PathLike[str]) -> Twin:
        """Returns the twin of a machine file. Raises ConfigError if the file or its section `twin` is invalid,
        TaktError if MuJoCo is not installed."""
        import json

        from takt.engine import read_machine

        text, file_name = read_machine(machine)
        return cls(text, file_name, json.loads(_core.load_machine(text, file_name)))

    def __repr__(self) -> str:
        return f"<Twin {self.name}: {', '.join(self.axes)}; cycle {self._cycle}>"

    @property
    def frame(self) -> Frame:
        """The state after the last valid cycle."""
        return Frame(self._cycle, self._good[0].copy(), self._good[1].copy())

    def step(self, cycle: int, told: Rows, measured: Rows) -> None:
        servos, qpos, qvel, last = self._servos, self._qpos, self._qvel, self.steps - 1
        model, data, step = self.built.model, self.built.data, self._mj_step
        if self.cargo is not None:
            self.cargo.before(cycle)
        servos.begin(told)
        at = qpos
        warned = self._warned()
        self._warn(silent)
        try:
            for i in range(self.steps):
                servos.ask(i, qpos, qvel, self._ahead, self._torques)
                if i == last:
                    at = qpos[self._places]
                step(model, data)
        finally:
            self._warn(warned)
        # Written so that NaN fails, too.
        if not qvel.dot(qvel) < FASTEST * FASTEST or self._warnings.tobytes() != self._no_warnings:
            self._explode(cycle)
        servos.sense(qpos, qvel, measured)
        if self.cargo is not None:
            self.cargo.after(cycle, measured)
        # After a step of MuJoCo, the poses of bodies are those at the start of the step.
        if cycle >= 0:
            self._rows.append((at, servos.torques, bytes(servos.limited), *[view.copy() for view in self._poses]))
        if data.ncon:
            self._touch(cycle)
        np.copyto(self._good[0], qpos)
        np.copyto(self._good[1], qvel)
        self._cycle = cycle

    def _explode(self, cycle: int) -> None:
        """Raises PlantError with the joint or warning that shows the explosion, before any of its values are used."""
        data = self.built.data
        model = self.built.model
        finite = np.isfinite(data.qvel)
        dof = int(np.flatnonzero(~finite)[0]) if not finite.all() else int(np.abs(data.qvel).argmax())
        joint = model.joint(int(model.dof_jntid[dof]))
        called = f"joint '{joint.name}'" if joint.name else f"a joint of body '{model.body(int(joint.bodyid[0])).name}'"
        why = f"{called} has a speed of {data.qvel[dof]:.3g}"
        if finite.all() and abs(data.qvel[dof]) < FASTEST and data.warning.number.any():
            import mujoco

            number = int(np.flatnonzero(data.warning.number)[0])
            why = f"MuJoCo warns {mujoco.mjtWarning(number).name}"
        when = (
            f"in cycle {cycle} ({cycle * self._period_s:.4f} s)" if cycle >= 0 else "in the step before the first cycle"
        )
        kept = f"the state after cycle {self._cycle}" if cycle > 0 else "the state at the start"
        raise PlantError(f"the physics of {self.name} exploded {when}: {why}; stopped, {kept} is kept (Twin.frame)")

    def _touch(self, cycle: int) -> None:
        model, data = self.built.model, self.built.data
        shapes = data.contact.geom
        key = shapes.tobytes()
        suspects = self._suspects.get(key)
        if suspects is None:
            if len(self._suspects) >= MOST_KEPT:
                self._suspects.clear()
            suspects = np.flatnonzero(~self._allowed[shapes[:, 0], shapes[:, 1]]).tolist()
            self._suspects[key] = suspects
        if not suspects:
            return
        for i in suspects:
            if not data.contact.dist[i] <= 0:
                continue
            contact = data.contact[int(i)]
            names = sorted(_called(model, int(geom)) for geom in contact.geom)
            pair = (names[0], names[1])
            if pair not in self.contacts:
                x, y, z = (float(one) * 1000 for one in contact.pos)
                self.contacts[pair] = ContactSeen(cycle, pair, -float(contact.dist) * 1000, (x, y, z))

    def seen(self) -> Seen:
        """Returns what the twin has measured so far."""
        count = len(self.axes)
        columns = list(zip(*self._rows, strict=True)) or [() for _ in range(3 + 2 * len(self.built.tools))]
        joints = np.array(columns[0], float).reshape(-1, count)
        limited = np.frombuffer(b"".join(columns[2]), np.uint8).reshape(-1, count) > 0
        tools = {}
        for number, tool in enumerate(self.built.tools):
            places = np.array(columns[3 + 2 * number], float).reshape(-1, 3) * 1000
            tools[tool.group] = (places, np.array(columns[4 + 2 * number], float).reshape(-1, 3, 3))
        torques = np.array(columns[1], float).reshape(-1, count)
        return Seen(self._zeros + self._scales * joints, torques, limited, tools)

    def finish(self, recording: Recording) -> None:
        recording.meta["plant"] = f"MuJoCo {_version()}"

    def picture(self, file: str | os.PathLike[str], frame: Frame | None = None) -> Path:
        """Draws a state as PNG, and returns the path of the file. frame: None: the last valid state. Raises PlantError
        if no driver on this machine can draw, or the file is no .png."""
        from takt.twin.picture import draw

        return draw(self.built, frame or self.frame, Path(file))


def _called(model: Any, geom: int) -> str:
    name = model.geom(geom).name
    return name or model.body(int(model.geom_bodyid[geom])).name or f"geom {geom}"


def _version() -> str:
    import mujoco

    return str(mujoco.__version__)
