"""A CiA 402 drive without metal: the power state machine and its modes before the simulated servo of the engine, which
has inertia, friction, load, encoder and switches as the machine file says.

It knows no bus: that writes and reads its objects, and has it step.
"""

from __future__ import annotations

from typing import Any, Final

from takt import _core, drive
from takt.drives import objects as od
from takt.drives.cia402 import (
    FOLLOWING_ERROR_BIT,
    FOLLOWS_BIT,
    HOMING_START_BIT,
    TARGET_REACHED_BIT,
    Command,
    Mode,
    PowerStateMachine,
    State,
    command_of,
)
from takt.drives.scaling import Scaling, Unwrapped, signed

AT_REST_COUNTS: Final = 0.5  # in a cycle
HOME_HERE: Final = (35, 37)  # homing methods: the present position
FOLLOWING: Final = 0x8611


class EmulatedDrive:
    """One drive; each step is a period of its servo.

    rated_torque: Nm, or N; 0x6076 tells it in thousandths.
    """

    def __init__(self, machine: bytes, file_name: str, axis: str, scaling: Scaling, inputs: dict[str, int]) -> None:
        self._servo = _core.Servo(machine, file_name, axis)
        self._told: dict[str, Any] = _core.servo_outputs()
        self.scaling = scaling
        self._inputs = {name: 1 << bit for name, bit in inputs.items() if bit >= 0}
        self.machine = PowerStateMachine()
        self.machine.started()
        self.values = {index: entry.default for index, entry in od.OBJECTS.items()}
        self.values[od.RATED_TORQUE.index] = round(1000 * scaling.rated_torque)
        self.period_s = 0.001
        self.held_fault = 0  # this fault lasts: it cannot be reset
        self.never_ready = False  # the power stage never comes up
        self._counts = Unwrapped()  # of the encoder
        self._increments = 0  # unwrapped: where the motor is
        self._measured: dict[str, Any] = {}
        self._homed = False
        self._home = 0  # increments: subtracted from the position
        self._ramp: float | None = None  # counts/s: of a quick stop
        self._ready = False
        self._speed = 0.0  # counts/s, over the last step
        self._target: int | None = None
        self.step()

    # --- objects ---

    def write(self, entry: od.Object, value: int) -> None:
        """As process data or SDO bring it."""
        self.values[entry.index] = value
        if entry is od.QUICK_STOP_OPTION:
            self.machine.quick_stop_option = value

    def read(self, entry: od.Object) -> int:
        return self.values[entry.index]

    def restart(self) -> None:
        """As after power has come back, but that the axis is where it was."""
        fresh = PowerStateMachine(quick_stop_option=self.read(od.QUICK_STOP_OPTION))
        fresh.started()
        self.machine, self._ramp, self._target = fresh, None, None

    # --- faults ---

    def fault(self, code: int, *, lasting: bool = False) -> None:
        """Something is wrong with the drive."""
        self.held_fault = code if lasting else 0
        self.machine.fault(code)

    # --- motion ---

    @property
    def mode(self) -> Mode:
        try:
            return Mode(self.values[od.MODE.index])
        except ValueError:
            return Mode.NONE

    @property
    def moving(self) -> bool:
        """It drives, brakes, or has not come to rest yet."""
        resting = abs(self._speed) * self.period_s <= AT_REST_COUNTS
        driving = (State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE, State.FAULT_REACTION_ACTIVE)
        return self.machine.state in driving or not resting

    def step(self) -> None:
        """Obeys the control word and moves for one period; what was measured at its end is in the objects then."""
        word = self.values[od.CONTROL_WORD.index]
        before = self.machine.state
        enabling = command_of(word, word) is Command.ENABLE_OPERATION
        state = self.machine.control(word, may_enable=self._ready, fault_gone=not self.held_fault)
        if state is not before:
            self._entered(state)
        measured = self._servo.step(self.period_s, self._what_to_do(state, enabling))
        self._ready = bool(measured["drive_ready"])
        self._take(measured)
        resting = abs(self._speed) * self.period_s <= AT_REST_COUNTS
        if state in (State.QUICK_STOP_ACTIVE, State.FAULT_REACTION_ACTIVE) and (resting or not self._ready):
            self.machine.rests()
        self._supervise(state)
        self._publish()

    def _entered(self, state: State) -> None:
        if state is State.OPERATION_ENABLED:
            self._target = None
        self._ramp = None

    def _what_to_do(self, state: State, enabling: bool) -> dict[str, Any]:
        """What the servo is told in this period."""
        told = dict(self._told)
        told["torque_limit_nm"] = self._torque_limit()
        if state is State.SWITCHED_ON and enabling and not self.never_ready:
            told["enable"] = True  # the brake holds until the power stage is up
            told["mode"] = drive.CYCLIC_VELOCITY
        elif state is State.OPERATION_ENABLED:
            told["enable"] = told["release_brake"] = True
            self._follow(told)
        elif state is State.QUICK_STOP_ACTIVE or (
            state is State.FAULT_REACTION_ACTIVE and self.values[od.FAULT_REACTION_OPTION.index] != 0
        ):
            told["enable"] = told["release_brake"] = True
            told["mode"] = drive.CYCLIC_VELOCITY
            told["velocity_counts_s"] = self._braked()
        return told

    def _torque_limit(self) -> float:
        limit = self.values[od.MAX_TORQUE.index]
        return 0.0 if limit >= 0xFFFF else self.scaling.torque_nm(limit)

    def _follow(self, told: dict[str, Any]) -> None:
        ratio = float(self.scaling.increments_per_count)
        mode = self.mode
        if mode is Mode.CYCLIC_POSITION:
            target = self.values[od.TARGET_POSITION.index]
            last = target if self._target is None else self._target
            self._target = target
            told["mode"] = drive.CYCLIC_POSITION
            # Near the present position, so that the exact ratio of a gear survives the wrap of 32 bits.
            now = self._increments
            told["position_counts"] = (now + signed(target + self._home - now)) / ratio
            told["velocity_counts_s"] = signed(target - last) / self.period_s / ratio
        elif mode is Mode.CYCLIC_TORQUE:
            torque = self.scaling.torque_nm(self.values[od.TARGET_TORQUE.index])
            fastest = self.values[od.MAX_MOTOR_SPEED.index] / ratio / self.scaling.velocity_factor
            told["mode"], told["torque_nm"] = drive.CYCLIC_TORQUE, torque
            told["velocity_counts_s"] = fastest
            told["torque_until_counts_s"] = fastest if torque >= 0 else -fastest
        else:
            told["mode"] = drive.CYCLIC_VELOCITY
            if mode is Mode.CYCLIC_VELOCITY:
                velocity = self.values[od.TARGET_VELOCITY.index]
                told["velocity_counts_s"] = velocity / ratio / self.scaling.velocity_factor
            elif mode is Mode.HOMING and self.values[od.CONTROL_WORD.index] & HOMING_START_BIT and not self._homed:
                self._home = self._increments - self.values[od.HOME_OFFSET.index]
                self._homed = True
        if mode is not Mode.CYCLIC_POSITION:
            self._target = None
        if mode is not Mode.HOMING or not self.values[od.CONTROL_WORD.index] & HOMING_START_BIT:
            self._homed = False

    def _braked(self) -> float:
        """The speed of the next period on the quick stop ramp."""
        ratio = float(self.scaling.increments_per_count)
        speed = self._speed if self._ramp is None else self._ramp
        less = self.values[od.QUICK_STOP_DECELERATION.index] / ratio * self.period_s
        self._ramp = max(0.0, abs(speed) - less) * (1 if speed >= 0 else -1)
        return self._ramp

    def _take(self, measured: dict[str, Any]) -> None:
        before = self._counts.total
        counts = self._counts.take(measured["counts"])
        self._speed = 0.0 if before is None else (counts - before) / self.period_s
        self._increments = round(counts * self.scaling.increments_per_count)
        self._measured = measured

    def _supervise(self, state: State) -> None:
        window = self.values[od.FOLLOWING_WINDOW.index]
        watched = state is State.OPERATION_ENABLED and window < 0xFFFF_FFFF
        if watched and abs(self._following_error()) > window:
            self.machine.fault(FOLLOWING)

    def _following_error(self) -> int:
        return 0 if self._target is None else signed(self._target + self._home - self._increments)

    def _publish(self) -> None:
        measured, values = self._measured, self.values
        values[od.POSITION.index] = signed(self._increments - self._home)
        values[od.VELOCITY.index] = self.scaling.velocity(self._speed)
        values[od.TORQUE.index] = self.scaling.torque(measured["torque_nm"])
        values[od.FOLLOWING_ERROR.index] = self._following_error()
        values[od.DIGITAL_INPUTS.index] = sum(bit for name, bit in self._inputs.items() if measured[name])
        values[od.MODE_DISPLAY.index] = int(self.mode)
        values[od.ERROR_CODE.index] = self.machine.error_code
        more = 0
        if self.machine.state is State.OPERATION_ENABLED:
            homing = FOLLOWS_BIT | TARGET_REACHED_BIT if self._homed else 0
            more = homing if self.mode is Mode.HOMING else FOLLOWS_BIT
        if self.machine.error_code == FOLLOWING:
            more |= FOLLOWING_ERROR_BIT
        values[od.STATUS_WORD.index] = self.machine.status_word(more)
