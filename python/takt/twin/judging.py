"""Evaluation of a run in a twin: verdicts, and figures beside those of our servo model."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from takt.counted import counted
from takt.recording import Recording
from takt.twin.cargo import Cargo
from takt.twin.model import Array
from takt.twin.plant import Twin
from takt.verdict import Verdict, seconds

AGREES_MM = 0.3  # between the model's tool and Takt's kinematics of the model's joints: constraints in MuJoCo are soft
AGREES_DEG = 0.3
LIES_MM = 1.0  # admissible displacement of a product on its belt after its release
LIES_DEG = 2.0
HEAD = ("", "", "twin rms", "largest", "servo rms", "largest")


@dataclass(frozen=True)
class AxisFigures:
    """Figures of one axis, in its unit and in Nm or N."""

    axis: str
    unit: str
    following: tuple[float, float]  # rms and largest
    servo: tuple[float, float] | None  # the same with our servo model
    torque: tuple[float, float]
    max_torque: float
    limited: int  # number of cycles with the motor at its limit


@dataclass(frozen=True)
class ToolFigures:
    """Figures of the tool of one group, in mm and deg."""

    group: str
    agreement: tuple[float, float]  # rms and largest
    turned: float  # largest
    off: tuple[float, float]  # rms and largest distance from the set pose
    servo_off: tuple[float, float] | None


@dataclass(frozen=True)
class ProductFigures:
    """Figures of all products that grippers held, in mm."""

    gripped: int
    put: int
    beside: tuple[float, float]  # rms and largest distance from the tool to the centre of a product's top when gripped
    moved: tuple[float, float]  # rms and largest displacement on the belt after the release


@dataclass(frozen=True)
class Judged:
    cycles: int
    axes: tuple[AxisFigures, ...]
    tools: tuple[ToolFigures, ...]
    products: ProductFigures | None
    verdicts: tuple[Verdict, ...]

    def __repr__(self) -> str:
        failed = ", ".join(verdict.title for verdict in self.verdicts if not verdict.passed)
        return f"<Judged {counted(self.cycles, 'cycle')}: {f'failed: {failed}' if failed else 'passed'}>"

    def _repr_html_(self) -> str:
        from takt.notebook import twin_table

        return twin_table(self)

    @property
    def passed(self) -> bool:
        return all(verdict.passed for verdict in self.verdicts)

    def table(self) -> list[tuple[str, ...]]:
        """Returns the rows of figures; their columns are those of `HEAD`."""
        rows: list[tuple[str, ...]] = []
        for tool in self.tools:
            rows.append((tool.group, "tool from its set pose [mm]", *_pair(tool.off), *_pair(tool.servo_off)))
            rows.append(("", "tool from Takt's kinematics [mm]", *_pair(tool.agreement), "", ""))
        if self.products is not None:
            rows.append(("products", "tool from their middle, gripped [mm]", *_pair(self.products.beside), "", ""))
            rows.append(("", "moved after they were put down [mm]", *_pair(self.products.moved), "", ""))
        for axis in self.axes:
            rows.append((axis.axis, f"following error [{axis.unit}]", *_pair(axis.following), *_pair(axis.servo)))
            rows.append(("", f"torque of {axis.max_torque:g}", *_pair(axis.torque), "", ""))
        return rows


def _pair(values: tuple[float, float] | None) -> tuple[str, str]:
    return ("", "") if values is None or math.isnan(values[0]) else (f"{values[0]:.2g}", f"{values[1]:.2g}")


def judge(twin: Twin, recording: Recording, servo: Recording | None = None) -> Judged:
    """Returns verdicts and figures of the run of a twin since its start.

    recording: of the same run, for the figures of axes and groups.
    servo: recording of the same run with our servo model, for comparison; None: not compared.
    """
    seen = twin.seen()
    period = float(recording.meta["period_s"])
    verdicts: list[Verdict] = []
    tools = []
    for tool in twin.built.tools:
        places, turns = seen.tools[tool.group]
        expected, expected_turns = tool.expected(seen.joints[:, tool.rows])
        off = np.linalg.norm(places - expected, axis=1)
        cosines = (np.einsum("nij,nij->n", expected_turns, turns) - 1) / 2
        turned = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
        tools.append(
            ToolFigures(
                tool.group,
                _size(off),
                float(turned.max(initial=0.0)),
                _size(_off(recording, tool.group)),
                _size(_off(servo, tool.group)) if servo is not None and tool.group in servo else None,
            )
        )
        verdicts.append(_agrees(tool.group, off, turned, period))
    axes = []
    for number, joint in enumerate(twin.built.joints):
        name, most = joint.axis, twin.limits[joint.axis]
        torque, limited = seen.torques[:, number], seen.limited[:, number]
        unit = recording.unit(name, "actual_position")
        axes.append(
            AxisFigures(
                name,
                unit,
                _size(_following(recording, name)),
                _size(_following(servo, name)) if servo is not None and name in servo else None,
                _size(torque),
                most,
                int(limited.sum()),
            )
        )
        verdicts.append(_within(name, torque, limited, most, period, "N" if abs(joint.scale) == 1000 else "Nm"))
    verdicts.append(_untouched(twin, period))
    products = None
    if twin.cargo is not None and (twin.cargo.handled or twin.cargo.fallen):
        products, verdict = _lie(twin.cargo, period)
        verdicts.append(verdict)
    return Judged(len(seen.joints), tuple(axes), tuple(tools), products, tuple(verdicts))


def _agrees(group: str, off: Array, turned: Array, period: float) -> Verdict:
    worst = int(off.argmax()) if len(off) else 0
    most, angle = float(off.max(initial=0.0)), float(turned.max(initial=0.0))
    passed = most <= AGREES_MM and angle <= AGREES_DEG
    sentence = (
        f"the tool is within {most:.2g} mm and {angle:.2g} deg of where Takt's kinematics of the twin's joints say, "
        f"worst at {seconds(worst * period)} ({AGREES_MM} mm and {AGREES_DEG} deg are allowed)"
    )
    return _verdict("twin.tool", group, passed, sentence, worst * period, abs(AGREES_MM - most), "mm")


def _within(name: str, torque: Array, limited: npt.NDArray[np.bool_], most: float, period: float, unit: str) -> Verdict:
    sizes = np.abs(torque)
    worst = int(limited.argmax()) if limited.any() else int(sizes.argmax()) if len(sizes) else 0
    peak = float(sizes.max(initial=0.0))
    if limited.any():
        sentence = (
            f"the motor was at its limit of {most:g} {unit} in {counted(int(limited.sum()), 'cycle')}, "
            f"the first at {seconds(worst * period)}"
        )
    else:
        sentence = f"the motor gave up to {peak:.3g} {unit} of {most:g} ({100 * peak / most:.0f} %)"
    return _verdict("twin.torque", name, not limited.any(), sentence, worst * period, most - peak, unit)


def _untouched(twin: Twin, period: float) -> Verdict:
    seen = sorted(twin.contacts.values(), key=lambda one: one.cycle)
    if not seen:
        return _verdict("twin.contacts", "", True, "nothing touched anything", None, None, "")
    first = seen[0]
    x, y, z = first.at_mm
    others = f"; {counted(len(seen) - 1, 'other pair')} later" if len(seen) > 1 else ""
    sentence = (
        f"{first.bodies[0]} and {first.bodies[1]} touched from {seconds(first.cycle * period)} on, at X {x:.1f}, "
        f"Y {y:.1f}, Z {z:.1f} mm{others}"
    )
    return _verdict("twin.contacts", "", False, sentence, first.cycle * period, first.depth_mm, "mm")


def _lie(cargo: Cargo, period: float) -> tuple[ProductFigures, Verdict]:
    """Returns the figures of products, and the verdict that they rest where they were released, upright, and that none
    fell."""
    handled = cargo.handled
    put = [one for one in handled if one.put is not None]
    moved = np.array([one.moved for one in put if not math.isnan(one.moved)])
    beside = np.array([np.linalg.norm(one.offset) for one in handled])
    figures = ProductFigures(len(handled), len(put), _size(beside), _size(moved))
    wrong: list[tuple[int, str]] = [(when, f"product {number} fell") for number, when in cargo.fallen]
    for one in put:
        what, when = f"product {one.number}", one.put or 0
        if one.lost:
            wrong.append((when, f"{what}: {one.lost}"))
        elif one.moved > LIES_MM:
            wrong.append((when, f"{what} moved by {one.moved:.3g} mm on belt {one.belt} after it was put there"))
        elif one.turned > LIES_DEG:
            wrong.append((when, f"{what} tilted by {one.turned:.3g} deg on belt {one.belt}"))
    if wrong:
        first, sentence = min(wrong)
        more = f"; {counted(len(wrong) - 1, 'other product')} beside" if len(wrong) > 1 else ""
        return figures, _verdict("twin.products", "", False, sentence + more, first * period, None, "")
    sentence = (
        f"{counted(len(handled), 'product')} gripped within {beside.max(initial=0):.2g} mm of the middle, {len(put)} "
        f"put down, and lie within {moved.max(initial=0):.2g} mm of where the gripper let go "
        f"({LIES_MM:g} mm are allowed)"
    )
    room = LIES_MM - float(moved.max(initial=0))
    return figures, _verdict("twin.products", "", True, sentence, None, room, "mm")


def _verdict(
    name: str, component: str, passed: bool, sentence: str, when: float | None, room: float | None, unit: str
) -> Verdict:
    return Verdict(name, (component,) if component else (), passed, sentence, when, room, unit, None)


def _size(values: Array) -> tuple[float, float]:
    """Returns root mean square and largest magnitude; NaN if there are no values."""
    if not len(values):
        return math.nan, math.nan
    return float(np.sqrt(np.mean(np.square(values)))), float(np.abs(values).max())


def _following(recording: Recording, axis: str) -> Array:
    table = recording[axis]
    return np.asarray(table["following_error"][table["loop_closed"].astype(bool)], float)


def _off(recording: Recording, group: str) -> Array:
    """Returns the distances [mm] of the tool from its set pose while the group is enabled. The actual pose corresponds
    to the set pose of the preceding cycle."""
    table = recording[group]
    poses = np.array([table[name] for name in ("x", "y", "z", "actual_x", "actual_y", "actual_z")], float)
    off = np.linalg.norm(poses[3:, 1:] - poses[:3, :-1], axis=0)
    return np.asarray(off[np.isfinite(off)])
