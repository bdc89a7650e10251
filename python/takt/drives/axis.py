"""One drive of CiA 402 as the axis that it moves: set points become its words, its words what was measured (AX-87).

It knows no bus; that hands over the words of a cycle and says when the drive is not heard.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from takt import drive
from takt.drives.cia402 import CONTROL_WORDS, Command, FaultReset, Mode, State, command_towards, state_of
from takt.drives.error_texts import error_text
from takt.drives.scaling import Scaling, Unwrapped

MODES = {
    drive.CYCLIC_POSITION: Mode.CYCLIC_POSITION,
    drive.CYCLIC_VELOCITY: Mode.CYCLIC_VELOCITY,
    drive.CYCLIC_TORQUE: Mode.CYCLIC_TORQUE,
}
AXIS_MODES = {"cyclic_position": Mode.CYCLIC_POSITION, "cyclic_velocity": Mode.CYCLIC_VELOCITY}  # of a machine file
CODE_WITHIN_S = 0.2  # after the fault itself the error code is expected to have come
MANY_RESETS = 3


def set_point_mode(mode: Mode) -> int:
    """Of a set point for a drive in this mode."""
    return drive.CYCLIC_VELOCITY if mode is Mode.CYCLIC_VELOCITY else drive.CYCLIC_POSITION


@dataclass
class Words:
    """What goes to a drive in a cycle, as its objects hold it."""

    control: int = 0
    mode: int = Mode.NONE
    position: int = 0
    velocity: int = 0
    torque: int = 0
    torque_limit: int = 0xFFFF


class DriveAxis:
    """The drive of one axis.

    called: "node 3", as sentences name it.
    inputs: bits of the digital inputs by what they are (limit_negative ...); -1: none.
    modes: that the drive has; a set point in another one switches it off.
    """

    def __init__(
        self,
        axis: str,
        called: str,
        scaling: Scaling,
        inputs: Mapping[str, int],
        modes: frozenset[Mode],
        say: Callable[[str], None],
    ) -> None:
        self.axis, self.called, self.scaling, self.modes = axis, called, scaling, modes
        self._inputs = {name: 1 << bit for name, bit in inputs.items() if bit >= 0}
        self._say = say
        self._counter = Unwrapped()
        self._reset = FaultReset()
        self.status = 0
        self.position = 0  # increments, as last heard
        self.error_code = 0  # of the last fault, 0: not told yet
        self._fault_since_s: float | None = None
        self._told_of_fault = self._told_of_resets = self._told_of_mode = False

    @property
    def state(self) -> State | None:
        return state_of(self.status)

    @property
    def faulty(self) -> bool:
        return self.state in (State.FAULT, State.FAULT_REACTION_ACTIVE)

    @property
    def energised(self) -> bool:
        """The power stage drives the motor."""
        return self.state in (State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE, State.FAULT_REACTION_ACTIVE)

    def words(self, told: drive.SetPoint, now_s: float, *, stop: bool = False) -> Words:
        """What the drive is to hear.

        stop: the engine is lost, so the drive brakes by itself along its quick stop ramp."""
        mode = MODES.get(told.mode, Mode.NONE)
        enable = told.enable and self._has(mode)
        words = Words(self._control(enable, now_s, stop), int(mode), torque_limit=self._limit(told))
        words.position = self.position  # so that the drive does not jump when it is switched on, or to csp
        if self.state is State.OPERATION_ENABLED and enable:
            if mode is Mode.CYCLIC_POSITION:
                words.position = self.scaling.increments(told.position_counts)
            words.velocity = self.scaling.velocity(told.velocity_counts_s) if mode is Mode.CYCLIC_VELOCITY else 0
            words.torque = self.scaling.torque(told.torque_nm) if mode is Mode.CYCLIC_TORQUE else 0
        return words

    def _limit(self, told: drive.SetPoint) -> int:
        return self.scaling.torque_limit(told.torque_limit_nm)

    def _has(self, mode: Mode) -> bool:
        if mode in self.modes:
            return True
        if not self._told_of_mode:
            self._told_of_mode = True
            has = ", ".join(sorted(known.name.lower() for known in self.modes)) or "none that is cyclic"
            self._say(f"{self.axis}: {self.called} does not have the mode {mode.name.lower()}; it has {has}")
        return False

    def _control(self, enable: bool, now_s: float, stop: bool) -> int:
        state = self.state
        if state is State.FAULT:
            return 0 if enable else self._reset.word(now_s)
        if state is None:
            return 0
        wanted = State.OPERATION_ENABLED if enable else State.READY_TO_SWITCH_ON
        if stop and state in (State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE):
            return CONTROL_WORDS[Command.QUICK_STOP]
        command = command_towards(wanted, state)
        return 0 if command is None else CONTROL_WORDS[command]

    def restarted(self) -> None:
        """The drive has started anew: its counter, and what was said of it, are of no worth any more."""
        self._counter = Unwrapped()
        self._told_of_mode = False

    def measured(self, status: int, position: int, torque: int, inputs: int, now_s: float) -> drive.Measured:
        """What the words of a drive say."""
        self.status, self.position = status, position
        self._watch_fault(now_s)
        wires = {name: bool(inputs & bit) for name, bit in self._inputs.items()}
        return drive.Measured(
            counts=self.scaling.counts(self._counter.take(position)),
            drive_ready=self.state is State.OPERATION_ENABLED,
            drive_fault=self.faulty,
            torque_nm=self.scaling.torque_nm(torque),
            **wires,
        )

    def _watch_fault(self, now_s: float) -> None:
        if not self.faulty:
            if self._fault_since_s is not None:
                if self._told_of_fault:
                    self._say(f"{self.axis}: {self.called}: the fault has been reset")
                self._fault_since_s, self.error_code = None, 0
                self._told_of_fault = self._told_of_resets = False
                self._reset.forget()
            return
        if self._fault_since_s is None:
            self._fault_since_s = now_s
        if not self._told_of_fault and (self.error_code or now_s - self._fault_since_s > CODE_WITHIN_S):
            self._told_of_fault = True
            self._say(f"{self.axis}: {self.called}: fault {self._code()}")
        if self._reset.tries >= MANY_RESETS and not self._told_of_resets:
            self._told_of_resets = True
            again_s = self._reset.pauses_s[-1]
            self._say(
                f"{self.axis}: {self.called}: fault {self._code()} is still there after {self._reset.tries} resets; "
                f"one is tried every {again_s:g} s while the axis is off"
            )

    def _code(self) -> str:
        return error_text(self.error_code) if self.error_code else "without an error code"
