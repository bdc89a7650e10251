"""A CiA 402 drive in software: the power state machine and its modes in front of the simulated servo of the engine,
which has inertia, friction, load, encoder and switches as in the machine file.

It is independent of the bus, which reads and writes its objects and calls `step`.
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
from takt.drives.probe import (
    CONTINUOUS_BIT,
    ENABLE_BIT,
    FALL_BIT,
    FALL_STORED_BIT,
    RISE_BIT,
    RISE_STORED_BIT,
    latches,
)
from takt.drives.scaling import Scaling, Unwrapped, signed

AT_REST_COUNTS: Final = 0.5  # in a cycle
HOME_HERE: Final = (35, 37)  # homing methods: the present position
HOME_AT: Final = {17: "limit_negative", 18: "limit_positive"}  # the edge of a switch
HOME_PULSE: Final = {33: -1, 34: 1}  # the next index pulse in that direction
HOMING_METHODS: Final = (*HOME_HERE, *HOME_AT, *HOME_PULSE)
FOLLOWING: Final = 0x8611


class EmulatedDrive:
    """One drive; each step is a period of its servo.

    rated_torque (of the scaling): Nm, or N; 0x6076 holds it in thousandths.
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
        self.held_fault = 0  # lasting fault, which cannot be reset; 0: none
        self.never_ready = False  # the power stage never becomes ready
        self._counts = Unwrapped()  # of the encoder
        self._increments = 0  # unwrapped: position of the encoder
        self._slipped = 0  # increments: offset of the encoder from the motor
        self._measured: dict[str, Any] = {}
        self.homing_velocities = [200_000, 20_000]  # 0x6099: to a switch, to its edge or an index pulse
        self._homed = self._homing_failed = False
        self._homing_sense = 0  # direction of the search; 0: none
        self._leaving = False  # the switch was found; searches its edge
        self._pulses = 0  # index pulses at the beginning of the search
        self._homing_speed = 0.0  # increments/s
        self._home = 0  # increments: subtracted from the position
        self._edges = [0, 0]  # of the touch probe, rising and falling
        self._latched: dict[int, int] = {}  # increments by the object of a latch
        self._ramp: float | None = None  # counts/s: of a quick stop
        self._ready = False
        self._speed = 0.0  # counts/s, over the last step
        self._target: int | None = None
        self.step()

    # --- objects ---

    def write(self, entry: od.Object, value: int) -> None:
        """Writes an object, from process data or SDO."""
        self.values[entry.index] = value
        if entry is od.QUICK_STOP_OPTION:
            self.machine.quick_stop_option = value

    def read(self, entry: od.Object) -> int:
        return self.values[entry.index]

    def restart(self) -> None:
        """Restarts the drive, as after its supply has returned; the axis keeps its position."""
        fresh = PowerStateMachine(quick_stop_option=self.read(od.QUICK_STOP_OPTION))
        fresh.started()
        self.machine, self._ramp, self._target = fresh, None, None
        self._home = 0
        self._latched.clear()
        self.values[od.PROBE_FUNCTION.index] = self.values[od.CONTROL_WORD.index] = 0

    # --- faults ---

    def fault(self, code: int, *, lasting: bool = False) -> None:
        """Puts the drive into a fault with this code (0x603F). lasting: it cannot be reset."""
        self.held_fault = code if lasting else 0
        self.machine.fault(code)

    def slip(self, increments: int) -> None:
        """Makes the position of the encoder jump; the motor does not move."""
        self._slipped += increments

    # --- motion ---

    @property
    def mode(self) -> Mode:
        try:
            return Mode(self.values[od.MODE.index])
        except ValueError:
            return Mode.NONE

    @property
    def moving(self) -> bool:
        """It drives, brakes, or is not at rest yet."""
        resting = abs(self._speed) * self.period_s <= AT_REST_COUNTS
        driving = (State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE, State.FAULT_REACTION_ACTIVE)
        return self.machine.state in driving or not resting

    def step(self) -> None:
        """Executes the control word and moves for one period; afterwards the objects hold the actual values."""
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
            self._homing_speed = 0.0
        self._forget_homing()
        self._ramp = None

    def _what_to_do(self, state: State, enabling: bool) -> dict[str, Any]:
        """Returns the commands of the servo for this period."""
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
            told["position_counts"] = (now + signed(target + self._home - now) - self._slipped) / ratio
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
            elif mode is Mode.HOMING:
                self._search()
                told["velocity_counts_s"] = self._homing_speed / ratio
        if mode is not Mode.CYCLIC_POSITION:
            self._target = None
        if mode is not Mode.HOMING:
            self._homing_speed = 0.0
        if mode is not Mode.HOMING or not self.values[od.CONTROL_WORD.index] & HOMING_START_BIT:
            self._forget_homing()

    def _forget_homing(self) -> None:
        self._homed = self._homing_failed = self._leaving = False
        self._homing_sense = 0

    # --- homing ---

    def _search(self) -> None:
        """Carries out one period of homing by the method of 0x6098: computes the speed of the next one."""
        method = self.values[od.HOMING_METHOD.index]
        if self.values[od.CONTROL_WORD.index] & HOMING_START_BIT and not (self._homed or self._homing_failed):
            if self._homing_sense == 0:
                self._pulses = self._measured["index_pulses"]
                self._homing_sense = HOME_PULSE.get(method, -1 if method == 17 else 1)
            self._look(method)
        to_switch, to_edge = (each / self.scaling.velocity_factor for each in self.homing_velocities)
        wanted = 0.0
        if not (self._homed or self._homing_failed) and method not in HOME_HERE:
            wanted = self._homing_sense * (
                -to_edge if self._leaving else to_edge if method in HOME_PULSE else to_switch
            )
        most = self.values[od.HOMING_ACCELERATION.index] / self.scaling.velocity_factor * self.period_s
        self._homing_speed += max(-most, min(most, wanted - self._homing_speed))

    def _look(self, method: int) -> None:
        """Ends the search at its reference, or at the wrong switch."""
        if method in HOME_HERE:
            self._found(self._increments)
        elif method in HOME_PULSE:
            if self._measured["index_pulses"] != self._pulses:
                before = self._measured["index_counts"] - self._measured["counts"]
                self._found(self._increments + round(signed(before) * self.scaling.increments_per_count))
            elif self._measured["limit_positive" if self._homing_sense > 0 else "limit_negative"]:
                self._homing_failed = True
        else:
            on = self._measured[HOME_AT[method]]
            if self._leaving and not on:
                self._found(self._increments)
            self._leaving = self._leaving or on
            other = "limit_positive" if self._homing_sense < 0 else "limit_negative"
            self._homing_failed = not on and bool(self._measured[other])

    def _found(self, increments: int) -> None:
        self._home = increments - self.values[od.HOME_OFFSET.index]
        self._homed = True

    def _braked(self) -> float:
        """Returns the velocity [counts/s] of the next period on the quick stop ramp."""
        ratio = float(self.scaling.increments_per_count)
        speed = self._speed if self._ramp is None else self._ramp
        less = self.values[od.QUICK_STOP_DECELERATION.index] / ratio * self.period_s
        self._ramp = max(0.0, abs(speed) - less) * (1 if speed >= 0 else -1)
        return self._ramp

    def _take(self, measured: dict[str, Any]) -> None:
        before = self._counts.total
        counts = self._counts.take(measured["counts"])
        self._speed = 0.0 if before is None else (counts - before) / self.period_s
        self._increments = round(counts * self.scaling.increments_per_count) + self._slipped
        self._measured = measured
        self._latch(measured)

    def _latch(self, measured: dict[str, Any]) -> None:
        """Updates the touch probes, both on the same wire: latches the position of the motor at an edge."""
        function, status = self.values[od.PROBE_FUNCTION.index], 0
        edges = [measured["probe_rises"], measured["probe_falls"]]
        for number, shift in ((1, 0), (2, 8)):
            bits = function >> shift
            status |= (bits & ENABLE_BIT) << shift
            for which, (entry, wanted, stored) in enumerate(
                zip(latches(number), (RISE_BIT, FALL_BIT), (RISE_STORED_BIT, FALL_STORED_BIT), strict=True)
            ):
                if not bits & ENABLE_BIT or not bits & wanted:
                    self._latched.pop(entry.index, None)
                elif edges[which] != self._edges[which] and (bits & CONTINUOUS_BIT or entry.index not in self._latched):
                    age_s = measured["probe_fall_age_s" if which else "probe_rise_age_s"]
                    at = self._increments - round(self._speed * age_s * float(self.scaling.increments_per_count))
                    self.values[entry.index] = signed(at - self._home)
                    self._latched[entry.index] = at
                status |= (stored << shift) * (entry.index in self._latched)
        self._edges = edges
        self.values[od.PROBE_STATUS.index] = status

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
            resting = abs(self._speed) * self.period_s <= AT_REST_COUNTS and self._homing_speed == 0
            homing = FOLLOWS_BIT | TARGET_REACHED_BIT * resting if self._homed else 0
            homing |= FOLLOWING_ERROR_BIT if self._homing_failed else 0
            more = homing if self.mode is Mode.HOMING else FOLLOWS_BIT
        if self.machine.error_code == FOLLOWING:
            more |= FOLLOWING_ERROR_BIT
        values[od.STATUS_WORD.index] = self.machine.status_word(more)
