"""One drive of CiA 402 as the drive of an axis: converts set points into its words, and its words into actual values
(AX-87).

It is independent of the bus, which passes the words of each cycle and reports when the drive is not heard.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from takt import drive
from takt.drives.cia402 import CONTROL_WORDS, Command, FaultReset, Mode, State, command_towards, state_of
from takt.drives.error_texts import error_text
from takt.drives.homing import DriveHoming
from takt.drives.probe import ProbeLatch
from takt.drives.scaling import WORD, Scaling, Unwrapped, signed

MODES = {
    drive.CYCLIC_POSITION: Mode.CYCLIC_POSITION,
    drive.CYCLIC_VELOCITY: Mode.CYCLIC_VELOCITY,
    drive.CYCLIC_TORQUE: Mode.CYCLIC_TORQUE,
}
AXIS_MODES = {"cyclic_position": Mode.CYCLIC_POSITION, "cyclic_velocity": Mode.CYCLIC_VELOCITY}  # of a machine file
FOLLOWING = 0x8611
CODE_WITHIN_S = 0.2  # time after a fault in which its error code is expected
MANY_RESETS = 3
RESTING_CYCLES = 3
BRAKES_WITHIN_S = 2.0  # time for a drive to brake after its homing was broken off
LOST = 4  # times the largest step: jump of the position, by the engine's criterion
JUMP = 1.5  # times the largest step of the axis: the drive now counts from its reference


def set_point_mode(mode: Mode) -> int:
    """Returns the mode of a set point for a drive in this mode."""
    return drive.CYCLIC_VELOCITY if mode is Mode.CYCLIC_VELOCITY else drive.CYCLIC_POSITION


@dataclass
class Words:
    """The values that are sent to a drive in a cycle, as in its objects."""

    control: int = 0
    mode: int = Mode.NONE
    position: int = 0
    velocity: int = 0
    torque: int = 0
    torque_limit: int = 0xFFFF
    probe: int = 0


@dataclass
class Heard:
    """The values that a drive sends in a cycle, as in its objects."""

    status: int
    position: int
    torque: int = 0
    inputs: int = 0
    mode: int = Mode.NONE  # present mode; read while it homes
    probe: tuple[int | None, int | None] = (None, None)  # positions latched at a rising and at a falling edge


class DriveAxis:
    """The drive of one axis.

    called: its name in messages, such as "node 3".
    inputs: bit number of each digital input by its name (limit_negative ...); -1: not connected.
    modes: supported by the drive; a set point in another mode switches it off.
    homing: carried out by the drive itself before it is ready for the first time; None: none.
    largest_step: largest motion of the axis in a cycle [increments]; used with `homing`.
    limit_senses: by the name of a limit switch, the sign of the increments towards it, and whether its input is
        inverted.
    """

    def __init__(
        self,
        axis: str,
        called: str,
        scaling: Scaling,
        inputs: Mapping[str, int],
        modes: frozenset[Mode],
        say: Callable[[str], None],
        *,
        homing: DriveHoming | None = None,
        probe: ProbeLatch | None = None,
        period_s: float = 0.001,
        largest_step: float = 0.0,
        limit_senses: Mapping[str, tuple[int, bool]] | None = None,
    ) -> None:
        self.axis, self.called, self.scaling, self.modes = axis, called, scaling, modes
        self._inputs = {name: 1 << bit for name, bit in inputs.items() if bit >= 0}
        self._say = say
        self._homing, self._probe = homing, probe
        self._period_s, self._largest_step = period_s, largest_step
        self._limit_senses = {name: sense for name, sense in (limit_senses or {}).items() if name in self._inputs}
        self._brakes_since_s: float | None = None  # when its homing was broken off; None: it does not brake for that
        self._resting = 0  # cycles
        self._absorbed = 0  # increments: jumps of the drive's position at its homing
        self._reference: int | None = None  # increments without those jumps: position at which the drive counts 0
        self._off_first = False  # the reference is lost: homing only after the axis was switched off
        self._index_pulses = 0
        self._cycles = 0  # cycles of the engine since the last words of the drive
        self._asked = 0  # calls of `words` since then: fewer than cycles on a computer that is late
        self.mode = 0  # as last heard
        self._counter = Unwrapped()
        self._reset = FaultReset()
        self.status = 0
        self.position = 0  # increments, as last heard
        self.error_code = 0  # of the last fault; 0: not received yet
        self._base = 0  # counts, a multiple of 2^32: offset from the engine's counter
        self._counts: int | None = None  # last actual position, unwrapped
        self._target: int | None = None  # last set point of the position; None: it follows none
        self._lag: int | None = None  # increments: following error at the beginning of the last fault
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

    @property
    def _homes(self) -> bool:
        """The drive is to home and has no reference yet."""
        return self._homing is not None and self._reference is None

    def words(self, told: drive.SetPoint, now_s: float, *, stop: bool = False) -> Words:
        """Returns the words for the drive in this cycle.

        stop: the engine is lost, so the drive brakes by itself along its quick stop ramp."""
        mode = MODES.get(told.mode, Mode.NONE)
        self._cycles += told.cycles
        self._asked += 1
        enable = told.enable and self._has(mode)
        failed = self._homing is not None and self._homing.failed != ""
        self._off_first = self._off_first and told.enable
        enable = enable and not failed and not self._off_first
        stop = self._breaks_off(enable, now_s) or stop
        if self._homing is not None and failed and not told.enable:
            self._homing.forget()
        words = Words(self._control(enable, now_s, stop), int(mode), torque_limit=self._limit(told))
        words.probe = self._probe.function if self._probe is not None else 0
        follows = self.state is State.OPERATION_ENABLED and enable and mode is Mode.CYCLIC_POSITION
        if self._counts is not None and not follows:  # the engine sends the actual position
            self._base = round((self._counts - told.position_counts) / WORD) * WORD
        words.position = self.position  # so that the drive does not jump when it is switched on, or to csp
        self._target = None
        if self._homes:
            self._home(words, enable, now_s)
        elif self.state is State.OPERATION_ENABLED and enable:
            if mode is Mode.CYCLIC_POSITION:
                counts = told.position_counts + self._base
                words.position = signed(self.scaling.increments(counts) + self._absorbed)
                self._target = words.position
            words.velocity = self.scaling.velocity(told.velocity_counts_s) if mode is Mode.CYCLIC_VELOCITY else 0
            words.torque = self.scaling.torque(told.torque_nm) if mode is Mode.CYCLIC_TORQUE else 0
        return words

    def _breaks_off(self, enable: bool, now_s: float) -> bool:
        """Returns whether a homing was broken off and the drive must first come to rest along its quick stop ramp."""
        if self._homing is not None and self._homing.moves and not enable and self._brakes_since_s is None:
            self._brakes_since_s, self._resting = now_s, 0
        if self._brakes_since_s is None:
            return False
        stopping = self.state in (State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE)
        if not stopping or self._resting > RESTING_CYCLES or now_s - self._brakes_since_s > BRAKES_WITHIN_S:
            self._brakes_since_s = None
        return self._brakes_since_s is not None

    def _home(self, words: Words, enable: bool, now_s: float) -> None:
        """Sets the words with which the drive homes, and then returns to the mode of the axis."""
        homing = self._homing
        assert homing is not None
        if homing.homed:
            return
        if not enable or self.state is not State.OPERATION_ENABLED:
            homing.interrupted()
            words.mode = int(Mode.HOMING) if enable or self._brakes_since_s is not None else words.mode
            return
        if not homing.under_way:
            self._say(f"{self.axis}: {self.called}: homing in the drive by method {homing.method} begins")
        words.mode = int(Mode.HOMING)
        words.control |= homing.control_bits(self.status, self.mode, now_s)
        if homing.failed:
            self._say_homing_failed(homing)

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
        """Discards the position counter and the reference: the drive has restarted."""
        self._counter = Unwrapped()
        self._told_of_mode = False
        self._absorbed, self._reference = 0, None
        self._brakes_since_s = None
        if self._homing is not None:
            self._homing.forget()
        if self._probe is not None:
            self._probe.forget()

    def measured(self, heard: Heard, now_s: float) -> drive.Measured:
        """Returns the actual values for the words of a drive."""
        before = self._counter.total
        total = self._counter.take(heard.position)
        step = 0 if before is None else total - before
        if self._homes and abs(step) > JUMP * self._largest_step:
            self._absorbed += step
        elif self._reference is not None and abs(step) > LOST * self._largest_step * max(1, self._cycles):
            self._lose_reference(step)
        self.status, self.position, self.mode = heard.status, heard.position, heard.mode
        self._watch_fault(now_s)
        at = total - self._absorbed
        self._counts = self.scaling.counts(at)
        found = drive.Measured(
            counts=self._counts,
            drive_fault=self.faulty or (self._homing is not None and self._homing.failed != ""),
            torque_nm=self.scaling.torque_nm(heard.torque),
            drive_error=self.error_code if self.faulty else 0,
        )
        for name, bit in self._inputs.items():
            setattr(found, name, bool(heard.inputs & bit))
        self._resting = self._resting + 1 if step == 0 else 0
        self._watch_homing(at, found)
        self._tell_reference(at, found)
        self._tell_probe(heard, step, found)
        found.drive_ready = self.state is State.OPERATION_ENABLED and not self._homes
        self._cycles = self._asked = 0
        return found

    def _lose_reference(self, step: int) -> None:
        """Discards the reference of the drive after a jump of its position."""
        self._reference, self._off_first = None, True
        if self._homing is not None:
            self._homing.forget()
        self._say(
            f"{self.axis}: {self.called}: its position has jumped by {step} increments, so it has no reference any "
            f"more; it homes again when it is switched on"
        )

    def _watch_homing(self, at: int, found: drive.Measured) -> None:
        homing = self._homing
        if homing is None or homing.watch is None or not homing.under_way:
            return
        switches = {sense: getattr(found, name) != inverted for name, (sense, inverted) in self._limit_senses.items()}
        homing.failed = homing.watch.look(at, switches, max(1, self._asked))
        if homing.failed:
            found.drive_fault = True
            self._say_homing_failed(homing)

    def _say_homing_failed(self, homing: DriveHoming) -> None:
        self._say(f"{self.axis}: {self.called}: homing in the drive by method {homing.method}: {homing.failed}")

    def _tell_reference(self, at: int, found: drive.Measured) -> None:
        """Passes the reference of the drive to the engine, as an index pulse that occurs in each cycle."""
        if self._homing is None or not self._homing.homed:
            return
        if self._reference is None and self.state is State.OPERATION_ENABLED and self.mode != Mode.HOMING:
            self._reference = at - self.position
            self._say(f"{self.axis}: {self.called}: homed, its position is {self.position}")
        if self._reference is not None:
            found.index_counts = self.scaling.counts(self._reference)
            if (
                abs(found.counts - found.index_counts) < 1 << 31
            ):  # beyond that the engine would take it for another pulse
                self._index_pulses += 1
            found.index_pulses = self._index_pulses

    def _tell_probe(self, heard: Heard, step: int, found: drive.Measured) -> None:
        probe = self._probe
        if probe is None:
            return
        probe.take(heard.probe, heard.position, step, max(1, self._cycles) * self._period_s)
        found.probe_rises, found.probe_falls = probe.rise.count, probe.fall.count
        found.probe_rise_age_s, found.probe_fall_age_s = probe.rise.age_s, probe.fall.age_s
        if "touch_probe" not in self._inputs:
            found.touch_probe = probe.wire

    def _watch_fault(self, now_s: float) -> None:
        if not self.faulty:
            if self._fault_since_s is not None:
                if not self._told_of_fault:
                    self._say(f"{self.axis}: {self.called}: fault {self._code()}")
                self._say(f"{self.axis}: {self.called}: the fault has been reset")
                self._fault_since_s, self.error_code = None, 0
                self._told_of_fault = self._told_of_resets = False
                self._reset.forget()
            return
        if self._fault_since_s is None:
            self._fault_since_s = now_s
            self._lag = None if self._target is None else signed(self._target - self.position)
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
        if not self.error_code:
            return "without an error code"
        lag = self._lag if self.error_code == FOLLOWING else None
        behind = "" if lag is None else f", {lag} increments from its set point"
        return error_text(self.error_code) + behind
