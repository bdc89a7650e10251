"""The control of the pick cell, as a user of the pick and place module writes it. The module chooses products and
trays, moves, and says when the gripper is to act; the control starts it, and tells it when the gripper has acted."""

from __future__ import annotations

import math

import takt
from cell import EVERY, Cell, Seen, reaches_in

LIFT = 40.0  # mm above a product: z_distance in the machine file
INFEED, OUTFEED = 1, 2  # the module's belts

LEFT = "left the range"
NOT_HELD = "not held"
WATCHED = ("picker.target", "picker.workpiece", "picker.pulse_gripper", "picker.in_target", "picker.picked")


class Picker:
    """Takes products from the infeed and puts each onto a tray of the outfeed, again and again."""

    def __init__(self, session: takt.Session, cell: Cell) -> None:
        self.session = session
        self.cell = cell
        self.module = session.pick_place("picker")
        self._going: Seen | None = None  # the product that the module goes for
        self._told = 0, 0  # for what the gripper was told to act last: belt and number there
        self._acted = False
        self._picked = int(self.module.picked)
        session.program(self._step, every=EVERY, on=WATCHED)
        cell.changed = cell.infeed.changed = lambda: session.wake(self._step)

    def run(self, until_s: float) -> None:
        """Until the session's time has come, and the last product is put down."""
        loop = self.module.execute()
        self.session.run(max(until_s - self.session.now, 0.0))
        self.session.wait(lambda: self.session.now >= until_s and self._places(), until_s + 60, every=EVERY)
        self.module.abort()  # the loop ends behind the path in progress
        loop.wait_final()

    def _places(self) -> bool:
        return self.module.target == OUTFEED and self.module.workpiece > 0

    def _step(self) -> float:
        """Every few cycles, if something is new. Returns s until a product may leave the range. A pulse of one cycle
        may be missed, then it is the place of the tool that says it."""
        module, gripper = self.module, self.cell.gripper
        picks = module.target == INFEED
        # A control in another process may not see the cycle of the pulse: it is told late then, when the tool is there.
        what = int(module.target), int(module.workpiece)
        if (module.pulse_gripper or module.in_target) and module.workpiece and what != self._told:
            self._told = what
            gripper.close() if picks else gripper.open()
        acted, self._acted = self._acted, bool(module.in_target) and gripper.closed == picks
        if acted != self._acted:
            module.control(ack_gripper=self._acted)  # it need not stay there any longer
        return self._follow()

    def _follow(self) -> float:
        """What becomes of the products: the one that the module goes for is held or not, others leave the range."""
        module, seen = self.module, self.cell.infeed.seen
        if module.picked > self._picked and self._going:
            if not self.cell.gripper.holds:
                self._missed(self._going, NOT_HELD)
            self._going = None
        self._picked = int(module.picked)
        if module.target == INFEED and module.workpiece in seen:
            if self._going:
                seen[self._going.number] = self._going  # given up for another one
            self._going = seen.pop(int(module.workpiece))
        belt, first = self.cell.infeed.belt, math.inf
        position, limit = belt.position, belt.parameters["upper_limit"]
        for one in list(seen.values()):
            left = limit - (position - one.recorded + one.x)
            if left < 0:
                self._missed(seen.pop(one.number), LEFT)
            first = min(first, left)
        return reaches_in(belt, first) if first < math.inf else first

    def _missed(self, product: Seen, why: str) -> None:
        self.session.mark(f"misses object {product.number}: {why}")
