"""Belts, products and grippers of a twin: products lie on belts by friction, a gripper holds a product by a weld that
is enabled if its cup is near enough, and light barriers across belts act as touch probes.

A belt is a plate whose body moves and whose shape stays: in contact it is a sliding surface. Products that are not in
the machine are parked beside it. MuJoCo alone moves products in the machine, except for `Cargo.move`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from takt.errors import TaktError
from takt.twin import made

if TYPE_CHECKING:
    from takt.plant import Rows
    from takt.twin.model import Array, Model

PER_M = 1000.0  # mm
GONE_MM = 100.0  # [mm] this far beneath the surfaces of all belts a product has fallen
REST_S = 0.02  # [s] from the release of a product until it is at rest
ROUNDING_M = 1e-6  # [m] more than the rounding errors of two ways to compute a position
LOOK = 10  # cycles between two checks of belt ends, fallen products and parked ones


@dataclass(frozen=True)
class ProductSeen:
    """A product on a belt, as a camera above it would see it."""

    number: int  # from 1, in the order in which products were put in; never used again
    x: float  # [mm] centre of its top, in the belt's frame
    y: float
    z: float
    c: float  # [deg] about Z


@dataclass(frozen=True)
class Handled:
    """A product that a gripper held, and the outcome."""

    number: int
    gripper: str  # the group's name
    gripped: int  # cycle
    offset: Array  # (3,) [mm], world frame: from the tool to the centre of its top when it was gripped
    put: int | None = None  # cycle of its release; None: still held
    belt: str | None = None  # the belt on which it was released; None: none
    moved: float = math.nan  # [mm] relative to the belt's surface, from its release until it was at rest
    turned: float = math.nan  # [deg] between its vertical axis and the belt's normal, at rest
    lost: str = ""  # the reason if it was not put down properly


@dataclass
class _Belt:
    name: str
    joint: int  # index in qpos
    dof: int
    geom: int
    row: int  # of its axis
    origin: Array  # (4, 4), m
    from_m: float
    to_m: float
    half_width: float
    surface: float
    barrier: float | None
    blocked: bool = False
    rises: int = 0
    falls: int = 0


@dataclass
class _Product:
    slot: int
    qpos: int
    qvel: int
    geom: int
    number: int = 0  # 0: parked beside the machine
    held: Gripper | None = None


@dataclass
class _Rests:
    """A product that a gripper has released."""

    product: _Product
    number: int
    at: int  # index of its Handled
    due: int  # cycle
    belt: _Belt | None = None
    place: Array = field(default_factory=lambda: np.zeros(2))


class Gripper:
    """A vacuum gripper at the tool of a group. `close` and `open` take effect after the time set in the machine file.
    `closed` is True while it is closed, `holds` is the number of the product held, or None."""

    def __init__(
        self, cargo: Cargo, told: Mapping[str, Any], group: str, tool: Any, at: Array, body: int, welds: Sequence[int]
    ):
        self.group = group
        self.closed = False
        self.holds: int | None = None  # number of the product
        self._cargo = cargo
        self._told = told
        self._tool = tool
        self._at = at  # [m] position of the TCP in the flange frame
        self._body = body
        self._welds = welds
        self._due: list[tuple[int, bool]] = []
        self._product: _Product | None = None  # the one held

    def close(self) -> None:
        """Commands the gripper to close; when it does, it grips the nearest product within its reach, if any."""
        self._tell(True)

    def open(self) -> None:
        """Commands the gripper to open; when it does, it releases its product."""
        self._tell(False)

    def _tell(self, close: bool) -> None:
        cargo = self._cargo
        self._due.append((cargo.cycle + max(1, round(self._told["acts_s"] / cargo.period_s)), close))

    def _step(self, cycle: int) -> None:
        while self._due and self._due[0][0] <= cycle:
            _, self.closed = self._due.pop(0)
            if self.closed and self.holds is None:
                self._grip(cycle)
            elif not self.closed:
                self._let_go(cycle, "")
        if self.holds is not None and self._pull() > self._told["force"]:
            self._let_go(cycle, f"pulled off with more than {self._told['force']:g} N")

    def _grip(self, cycle: int) -> None:
        cargo = self._cargo
        flange, turn = self._tool.pose_in(cargo._data)
        place = flange + turn.reshape(3, 3) @ self._at
        near, best = None, self._told["reach"] / PER_M
        for one in cargo._there():
            if one.held is not None:
                continue
            off = float(np.linalg.norm(cargo._top(one) - place))
            if off <= best:
                near, best = one, off
        if near is None:
            return
        cargo._forget(near)
        near.held, self.holds, self._product = self, near.number, near
        offset = (cargo._top(near) - place) * PER_M
        cargo.handled.append(Handled(near.number, self.group, cycle, offset))
        cargo._weld(self._welds[near.slot], self._body, near)

    def _let_go(self, cycle: int, lost: str) -> None:
        product, self.holds, self._product = self._product, None, None
        if product is None:
            return
        product.held = None
        cargo = self._cargo
        cargo._data.eq_active[self._welds[product.slot]] = 0
        cargo._released(product, cycle, lost)

    def _pull(self) -> float:
        """Returns the force [N] between cup and product; 0 if none is held."""
        product = self._product
        if product is None:
            return 0.0
        data = self._cargo._data
        weld, ids = self._welds[product.slot], data.efc_id[: data.ne]
        if not len(ids):
            return 0.0
        first = int((ids == weld).argmax())  # rows of one constraint are adjacent, forces first
        if ids[first] != weld:
            return 0.0
        force = data.efc_force[first : first + 3]
        return math.sqrt(force.dot(force))


class Cargo:
    """The belts, products and grippers of a twin. `grippers`: by name of the group."""

    def __init__(self, mujoco: Any, machine: Mapping[str, Any], built: Model, axes: Sequence[str], period_s: float):
        twin = machine["twin"]
        self.period_s = period_s
        self.cycle = -1
        self.handled: list[Handled] = []
        self.fallen: list[tuple[int, int]] = []  # products that fell off: number, cycle
        self._mujoco, self._model, self._data = mujoco, built.model, built.data
        model = built.model
        told = twin.get("products")
        count = told["count"] if told else 0
        self._half = np.array([told[edge] / 2000 for edge in ("length", "width", "height")]) if told else np.zeros(3)
        self._products: list[_Product] = []
        for slot in range(count):
            joint = model.joint(made.product(slot))
            geom = model.geom(made.product(slot)).id
            self._products.append(_Product(slot, int(joint.qposadr[0]), int(joint.dofadr[0]), int(geom)))
        self._park = built.data.qpos.copy()
        self._rgba = model.geom_rgba.copy()
        self._belts: dict[str, _Belt] = {}
        for belt in twin["belts"]:
            params = next(one for one in machine["belts"] if one["name"] == belt["belt"])
            row = axes.index(params["axis"])
            joint = built.joints[row]
            body = model.body(made.belt(belt["belt"]))
            frame = np.eye(4)
            frame[:3, :3] = built.data.xmat[body.id].reshape(3, 3)
            frame[:3, 3] = np.array([params["origin"][k] for k in "xyz"]) / PER_M
            barrier = belt.get("barrier")
            self._belts[belt["belt"]] = _Belt(
                belt["belt"],
                joint.position,
                joint.velocity,
                int(model.geom(made.belt(belt["belt"])).id),
                row,
                frame,
                belt["from"] / PER_M,
                belt["to"] / PER_M,
                belt["width"] / 2 / PER_M,
                belt["surface"] / PER_M,
                None if barrier is None else barrier / PER_M,
            )
        surfaces = [float(belt.origin[2, 3]) + belt.surface for belt in self._belts.values()]
        self._floor = min(surfaces, default=-math.inf) - GONE_MM / PER_M  # [m] products below have fallen
        self._place_of = np.array([[one.qpos + i for i in range(3)] for one in self._products], int).reshape(-1, 3)
        self.grippers: dict[str, Gripper] = {}
        for mechanism in twin["mechanisms"]:
            if mechanism.get("gripper"):
                group = mechanism["group"]
                tool = next(tool for tool in built.tools if tool.group == group)
                welds = [int(model.equality(made.grip(group, slot)).id) for slot in range(count)]
                body = int(model.eq_obj1id[welds[0]])
                offset = next(one["tool"] for one in machine["groups"] if one["name"] == group)
                at = np.array([offset[k] for k in "xyz"]) / PER_M
                self.grippers[group] = Gripper(self, mechanism.get("gripper"), group, tool, at, body, welds)
        self._last = 0
        self._rests: list[_Rests] = []
        for one in self._products:
            self._wait(one)
        self.allowed = self._allowed()

    # --- for scenarios ---

    @property
    def here(self) -> tuple[int, ...]:
        """The numbers of the products in the machine."""
        return tuple(sorted(one.number for one in self._there()))

    def put(self, belt: str, x: float = 0.0, y: float = 0.0, c: float = 0.0) -> int:
        """Puts a product onto a belt with its centre at x, y [mm] and the angle c about Z [deg], all in the belt's
        frame, and with the belt's velocity. Returns its number. Raises TaktError if there is no such belt, x, y is not
        on it, or all products are in use."""
        on = self._belt(belt)
        if not (on.from_m <= x / PER_M <= on.to_m and abs(y) / PER_M <= on.half_width):
            raise TaktError(f"belt '{belt}': X {x:g}, Y {y:g} mm is not on it")
        free = next((one for one in self._products if not one.number), None)
        if free is None:
            raise TaktError(
                f"belt '{belt}': all {len(self._products)} products are in the machine (twin.products.count)"
            )
        self._last += 1
        free.number = self._last
        self._model.geom_rgba[free.geom] = self._rgba[free.geom]
        self._place(free, on, x, y, c)
        return free.number

    def move(self, number: int, dx: float = 0.0, dy: float = 0.0) -> None:
        """Displaces a product by dx, dy [mm] in the world frame. Raises TaktError if there is no such product."""
        at = self._numbered(number).qpos
        self._data.qpos[at : at + 2] += np.array([dx, dy]) / PER_M

    def take(self, number: int) -> None:
        """Removes a product from the machine. Raises TaktError if there is no such product or a gripper holds it."""
        product = self._numbered(number)
        if product.held is not None:
            raise TaktError(f"product {number} cannot be taken: the gripper of {product.held.group} holds it")
        self._forget(product)
        self._wait(product)

    def position(self, number: int) -> Array:
        """Returns the centre of a product's top, (3,) [mm] in the world frame. Raises TaktError if there is no such
        product."""
        return np.asarray(self._top(self._numbered(number)) * PER_M)

    def camera(self, belt: str, begin: float = -math.inf, end: float = math.inf) -> list[ProductSeen]:
        """Returns the products that lie on a belt with X in begin..end [mm, belt frame], the largest X first; held ones
        are left out. Raises TaktError if there is no such belt."""
        on = self._belt(belt)
        seen = []
        for one in self._there():
            x, y, z = self._seen_from(on, self._top(one))
            if one.held is None and self._is_on(on, one) and begin <= x * PER_M <= end:
                along = on.origin[:3, :3].T @ self._turn(one)[:, 0]
                c = math.degrees(math.atan2(along[1], along[0]))
                seen.append(ProductSeen(one.number, x * PER_M, y * PER_M, z * PER_M, c))
        return sorted(seen, key=lambda one: -one.x)

    # --- for the twin ---

    def before(self, cycle: int) -> None:
        """Prepares a cycle, before its physics steps: belts keep their shapes, waiting products stay parked."""
        if cycle % LOOK:
            return
        qpos, qvel = self._data.qpos, self._data.qvel
        for belt in self._belts.values():
            middle = (belt.from_m + belt.to_m) / 2
            self._model.geom_pos[belt.geom, 0] = middle - qpos[belt.joint]
        for one in self._products:
            if not one.number:
                qpos[one.qpos : one.qpos + 7] = self._park[one.qpos : one.qpos + 7]
                qvel[one.qvel : one.qvel + 6] = 0

    def after(self, cycle: int, measured: Rows) -> None:
        """Finishes a cycle, after its physics steps: grippers, products at rest or at an end, light barriers."""
        self.cycle = cycle
        for gripper in self.grippers.values():
            gripper._step(cycle)
        for rests in [one for one in self._rests if one.due <= cycle]:
            self._rests.remove(rests)
            self._judge(rests)
        if cycle % LOOK == 0:
            for one in self._may_leave():
                self._leave(one, cycle)
        for belt in self._belts.values():
            if belt.barrier is not None:
                self._sense(belt, measured)

    # --- inside ---

    def _belt(self, name: str) -> _Belt:
        if name not in self._belts:
            raise TaktError(f"the twin has no belt '{name}' (it has {', '.join(self._belts) or 'none'})")
        return self._belts[name]

    def _numbered(self, number: int) -> _Product:
        for one in self._there():
            if one.number == number:
                return one
        raise TaktError(f"there is no product {number} in the machine")

    def _there(self) -> Iterator[_Product]:
        return (one for one in self._products if one.number)

    def _turn(self, one: _Product) -> Array:
        turn = np.zeros(9)
        self._mujoco.mju_quat2Mat(turn, self._data.qpos[one.qpos + 3 : one.qpos + 7])
        return turn.reshape(3, 3)

    def _top(self, one: _Product) -> Array:
        """Returns the centre of a product's top [m], world frame."""
        return np.asarray(self._data.qpos[one.qpos : one.qpos + 3] + self._turn(one)[:, 2] * self._half[2])

    def _seen_from(self, belt: _Belt, place: Array) -> Array:
        return np.asarray(belt.origin[:3, :3].T @ (place - belt.origin[:3, 3]))

    def _is_on(self, belt: _Belt, one: _Product) -> bool:
        x, y, z = self._seen_from(belt, self._data.qpos[one.qpos : one.qpos + 3])
        beneath = z - self._half[2] - belt.surface
        return bool(belt.from_m <= x <= belt.to_m and abs(y) <= belt.half_width and abs(beneath) < 0.002)

    def _place(self, one: _Product, belt: _Belt, x: float, y: float, c: float) -> None:
        data = self._data
        at = np.array([x / PER_M, y / PER_M, belt.surface + self._half[2]])
        data.qpos[one.qpos : one.qpos + 3] = belt.origin[:3, 3] + belt.origin[:3, :3] @ at
        cos, sin = math.cos(math.radians(c)), math.sin(math.radians(c))
        turn = belt.origin[:3, :3] @ np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
        quat = np.zeros(4)
        self._mujoco.mju_mat2Quat(quat, np.ascontiguousarray(turn).ravel())
        data.qpos[one.qpos + 3 : one.qpos + 7] = quat
        data.qvel[one.qvel : one.qvel + 6] = 0
        data.qvel[one.qvel : one.qvel + 3] = belt.origin[:3, 0] * data.qvel[belt.dof]

    def _wait(self, one: _Product) -> None:
        """Parks a product beside the machine, invisible and at rest."""
        one.number = 0
        self._model.geom_rgba[one.geom, 3] = 0
        self._data.qpos[one.qpos : one.qpos + 7] = self._park[one.qpos : one.qpos + 7]
        self._data.qvel[one.qvel : one.qvel + 6] = 0

    def _may_leave(self) -> list[_Product]:
        """Returns the products that may be at the end of a belt, or below all belts: a fast check of all products."""
        free = [one for one in self._there() if one.held is None]
        if not free:
            return []
        places = self._data.qpos[self._place_of[[one.slot for one in free]]]
        may = places[:, 2] < self._floor + ROUNDING_M
        for belt in self._belts.values():
            seen = (places - belt.origin[:3, 3]) @ belt.origin[:3, :2]
            beside = np.abs(seen[:, 1]) <= belt.half_width + ROUNDING_M
            may |= beside & (seen[:, 0] > belt.to_m - self._half[0] - ROUNDING_M)
        return [one for one, leaves in zip(free, may.tolist(), strict=True) if leaves]

    def _leave(self, one: _Product, cycle: int) -> None:
        """Removes a product that has fallen, or is at the end of its belt with no other belt to carry it further."""
        place = self._data.qpos[one.qpos : one.qpos + 3]
        half, at_end = self._half[0], False
        for belt in self._belts.values():
            x, y, z = self._seen_from(belt, place)
            if abs(y) > belt.half_width or abs(z - self._half[2] - belt.surface) >= 0.01:
                continue
            if belt.from_m - half < x <= belt.to_m - half:
                return
            at_end = at_end or belt.to_m - half < x <= belt.to_m + half
        if at_end:
            self._forget(one)
            self._wait(one)
            return
        if place[2] < self._floor:
            self.fallen.append((one.number, cycle))
            self._forget(one)
            self._wait(one)

    def _forget(self, one: _Product) -> None:
        """Cancels the check of where a product came to rest."""
        self._rests = [rests for rests in self._rests if rests.product is not one]

    def _weld(self, weld: int, body: int, one: _Product) -> None:
        """Enables the weld between a body and a product at their present relative pose."""
        data, mujoco = self._data, self._mujoco
        mujoco.mj_kinematics(self._model, data)
        turn, back, quat = data.xquat[body], np.zeros(4), np.zeros(4)
        mujoco.mju_negQuat(back, turn)
        place = np.zeros(3)
        mujoco.mju_rotVecQuat(place, data.qpos[one.qpos : one.qpos + 3] - data.xpos[body], back)
        mujoco.mju_mulQuat(quat, back, data.qpos[one.qpos + 3 : one.qpos + 7])
        self._model.eq_data[weld, 0:3] = 0
        self._model.eq_data[weld, 3:6] = place
        self._model.eq_data[weld, 6:10] = quat
        data.eq_active[weld] = 1

    def _released(self, one: _Product, cycle: int, lost: str) -> None:
        index = max(i for i, handled in enumerate(self.handled) if handled.number == one.number)
        handled = self.handled[index]
        belt = next((belt for belt in self._belts.values() if self._is_on(belt, one)), None)
        why = lost or ("" if belt else "put onto no belt")
        on = belt.name if belt else None
        self.handled[index] = Handled(
            handled.number, handled.gripper, handled.gripped, handled.offset, cycle, on, lost=why
        )
        if belt is not None:
            due = cycle + max(1, round(REST_S / self.period_s))
            self._rests.append(_Rests(one, one.number, index, due, belt, self._carried(belt, one)))

    def _carried(self, belt: _Belt, one: _Product) -> Array:
        """Returns X and Y of a product [m] relative to the moving belt surface."""
        place = self._seen_from(belt, self._data.qpos[one.qpos : one.qpos + 3])[:2]
        return np.asarray(place - [self._data.qpos[belt.joint], 0])

    def _judge(self, rests: _Rests) -> None:
        belt = rests.belt
        assert belt is not None
        one, handled = rests.product, self.handled[rests.at]
        moved = float(np.linalg.norm(self._carried(belt, one) - rests.place)) * PER_M
        upright = float(belt.origin[:3, 2] @ self._turn(one)[:, 2])
        self.handled[rests.at] = Handled(
            handled.number,
            handled.gripper,
            handled.gripped,
            handled.offset,
            handled.put,
            handled.belt,
            moved,
            math.degrees(math.acos(max(-1.0, min(1.0, upright)))),
            handled.lost or ("" if self._is_on(belt, one) else "it fell off the belt"),
        )

    def _sense(self, belt: _Belt, measured: Rows) -> None:
        """Updates the light barrier: on while any product is in it. The age of an edge follows from the distance by
        which the product has passed the barrier."""
        assert belt.barrier is not None
        speed = float(self._data.qvel[belt.dof])
        past = math.inf  # [m] by which the front, or else the end, of the nearest product is past the barrier
        blocked = False
        for one in self._there():
            x, y, _ = self._seen_from(belt, self._data.qpos[one.qpos : one.qpos + 3])
            if one.held is not None or abs(y) > belt.half_width:
                continue
            half = float(np.abs(belt.origin[:3, 0] @ self._turn(one)) @ self._half)
            front, end = x + half - belt.barrier, x - half - belt.barrier
            if front >= 0 >= end:
                blocked, past = True, min(past, front)
            elif end > 0 and not blocked:
                past = min(past, end)
        if blocked != belt.blocked:
            age = min(max(past / speed, 0.0), self.period_s) if speed > 0 and past < math.inf else 0.0
            if blocked:
                belt.rises += 1
                measured["probe_rise_age_s"][belt.row] = age
            else:
                belt.falls += 1
                measured["probe_fall_age_s"][belt.row] = age
            belt.blocked = blocked
        measured["touch_probe"][belt.row] = blocked
        measured["probe_rises"][belt.row] = belt.rises
        measured["probe_falls"][belt.row] = belt.falls

    def _allowed(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Returns (n, n): True for pairs of shapes that may touch, a product and a belt."""
        count = self._model.ngeom
        allowed = np.zeros((count, count), bool)
        products = [one.geom for one in self._products]
        for belt in self._belts.values():
            allowed[belt.geom, products] = allowed[products, belt.geom] = True
        return allowed
