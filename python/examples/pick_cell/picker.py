"""The control of the pick cell: one pick after another, by commands of the group."""

from __future__ import annotations

from collections.abc import Callable

import takt
from cell import Cell, Conveyor, Seen

LIFT = 40.0  # mm above a product
ROUND = 18.0  # mm before and behind a corner
AHEAD_S = 0.12  # a thing that will be in the range by then may be gone for
NEEDED_S = 0.45  # a thing must stay in the range for so long
PARK = {"x": 0.0, "y": -60.0, "z": -760.0}  # mm

PRODUCT, TRAY = 1, 2  # product coordinate systems

LEFT = "left the range"
NOT_HELD = "not held"
UNREACHABLE = "unreachable"


class Picker:
    """Takes products from the infeed in the order in which they leave the range, and puts each onto a tray."""

    def __init__(self, session: takt.Session, cell: Cell) -> None:
        self.session = session
        self.cell = cell
        self.robot = session.group("robot")
        self._on = 0  # product coordinate system in which the tool stands; 0: none

    def run(self, until_s: float) -> None:
        """Until the session's time has come, and the last product is put down."""
        self._park().wait()
        while self._waits_for(lambda: self._first(self.cell.infeed), until_s):
            if self._pick():
                while not self._place():
                    pass
            if not self._first(self.cell.infeed):
                self._park()
        self._park().wait()

    def _waits_for(self, condition: Callable[[], object], until_s: float = float("inf")) -> bool:
        self.session.wait(lambda: condition() or self.session.now >= until_s, 60)
        return self.session.now < until_s

    def _first(self, conveyor: Conveyor) -> Seen | None:
        """The thing that leaves the range first, of those that can still be fetched; what cannot is given up."""
        belt = conveyor.belt
        speed = max(belt.velocity, 0.0)
        lower, upper = belt.parameters["lower_limit"], belt.parameters["upper_limit"]
        for seen in list(conveyor.seen.values()):
            place = belt.position - seen.recorded + seen.x
            if place + speed * NEEDED_S > upper:
                del conveyor.seen[seen.number]
                if conveyor is self.cell.infeed:
                    self._missed(seen, LEFT)
            elif place + speed * AHEAD_S >= lower:
                return seen
            else:
                return None
        return None

    def _pick(self) -> bool:
        """Fetches the first product. False: missed."""
        gripper, product = self.cell.gripper, self._first(self.cell.infeed)
        if product is None:
            return False
        down = self._go_to(self.cell.infeed, PRODUCT, product)
        self._arrives(down)
        gripper.close()
        self._waits_for(lambda: gripper.closed and down.final)
        self.cell.infeed.belt.remove(number=product.number)
        if down.done and gripper.holds:
            return True
        gripper.open()
        self._missed(product, NOT_HELD if down.done else UNREACHABLE)
        if not down.done:
            self._recover()
        return False

    def _place(self) -> bool:
        """Puts the product onto the first tray. False: it did not get there, and still has it."""
        gripper = self.cell.gripper
        if not self._first(self.cell.outfeed):
            self._park()
            self._waits_for(lambda: self._first(self.cell.outfeed))
        tray = self._first(self.cell.outfeed)
        if tray is None:
            return False
        down = self._go_to(self.cell.outfeed, TRAY, tray)
        self._arrives(down)
        if down.final and not down.done:
            self._recover()
            return False
        gripper.open()
        self._waits_for(lambda: not gripper.closed and down.final)
        self.cell.outfeed.belt.remove(number=tray.number)
        return True

    def _recover(self) -> None:
        """Whatever rode on something comes to rest, and goes up."""
        self.robot.halt().wait()
        self._on = 0
        self.robot.move_linear_absolute(z=PARK["z"]).wait()

    def _arrives(self, down: takt.Feedback) -> None:
        """Lets time pass until the gripper, told now, acts when the tool arrives; one that was held up has arrived."""
        robot, ahead, held_up = self.robot, self.cell.settings.gripper_s, False

        def is_near() -> bool:
            nonlocal held_up
            held_up |= bool(robot.interrupted)
            return down.final or (not held_up and robot.command == down.ticket and robot.time_left <= ahead)

        self._waits_for(is_near)

    def _missed(self, product: Seen, why: str) -> None:
        self.session.mark(f"misses object {product.number}: {why}")

    def _go_to(self, conveyor: Conveyor, pcs: int, seen: Seen) -> takt.Feedback:
        """Up, above it, and down onto it."""
        del conveyor.seen[seen.number]
        conveyor.belt.take(number=seen.number)
        self.robot.set_dyn_coord_transform(
            pcs=pcs, carrier=conveyor.belt.name, x=seen.x, y=seen.y, recorded_position=seen.recorded
        )
        self._lift()
        self._line(pcs, LIFT)
        self._on = pcs
        return self._line(pcs, 0.0)

    def _lift(self) -> None:
        if self._on:
            self.robot.move_linear_absolute(z=LIFT, coordinate_system="pcs", pcs=self._on, buffer_mode="buffered")

    def _line(self, pcs: int, z: float) -> takt.Feedback:
        return self.robot.move_linear_absolute(
            x=0, y=0, z=z, coordinate_system="pcs", pcs=pcs, buffer_mode="blending_next",
            transition_mode="corner_distance", transition_parameter=ROUND,
        )  # fmt: skip

    def _park(self) -> takt.Feedback:
        self._lift()
        self._on = 0
        return self.robot.move_linear_absolute(
            **PARK, buffer_mode="blending_next", transition_mode="corner_distance", transition_parameter=ROUND
        )
