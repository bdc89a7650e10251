"""CiA 402 (IEC 61800-7-201): the power state machine of a drive, on the master's and on the drive's side, and the modes
of operation.

Independent of the bus: control and status words are plain numbers.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Final


class State(enum.Enum):
    """State of a drive's power stage."""

    NOT_READY_TO_SWITCH_ON = "not ready to switch on"
    SWITCH_ON_DISABLED = "switch on disabled"
    READY_TO_SWITCH_ON = "ready to switch on"
    SWITCHED_ON = "switched on"
    OPERATION_ENABLED = "operation enabled"
    QUICK_STOP_ACTIVE = "quick stop active"
    FAULT_REACTION_ACTIVE = "fault reaction active"
    FAULT = "fault"


class Command(enum.Enum):
    """The command in a control word."""

    SHUTDOWN = "shutdown"
    SWITCH_ON = "switch on"  # in OPERATION_ENABLED: disable operation
    ENABLE_OPERATION = "enable operation"
    DISABLE_VOLTAGE = "disable voltage"
    QUICK_STOP = "quick stop"
    FAULT_RESET = "fault reset"  # by the rising edge of its bit


class Mode(enum.IntEnum):
    """Mode of operation (0x6060, 0x6061)."""

    NONE = 0
    PROFILE_POSITION = 1
    VELOCITY = 2
    PROFILE_VELOCITY = 3
    PROFILE_TORQUE = 4
    HOMING = 6
    INTERPOLATED_POSITION = 7
    CYCLIC_POSITION = 8
    CYCLIC_VELOCITY = 9
    CYCLIC_TORQUE = 10


MODE_NAMES: Final = {
    Mode.NONE: "none",
    Mode.PROFILE_POSITION: "pp",
    Mode.VELOCITY: "vl",
    Mode.PROFILE_VELOCITY: "pv",
    Mode.PROFILE_TORQUE: "tq",
    Mode.HOMING: "hm",
    Mode.INTERPOLATED_POSITION: "ip",
    Mode.CYCLIC_POSITION: "csp",
    Mode.CYCLIC_VELOCITY: "csv",
    Mode.CYCLIC_TORQUE: "cst",
}


def supported_modes(word: int) -> list[str]:
    """Returns the names of the modes in the object "supported drive modes" (0x6502)."""
    return [name for mode, name in MODE_NAMES.items() if mode and word >> (mode - 1) & 1]


# Control word (0x6040).
SWITCH_ON_BIT: Final = 1 << 0
ENABLE_VOLTAGE_BIT: Final = 1 << 1
NOT_QUICK_STOP_BIT: Final = 1 << 2  # low commands a quick stop
ENABLE_OPERATION_BIT: Final = 1 << 3
HOMING_START_BIT: Final = 1 << 4
FAULT_RESET_BIT: Final = 1 << 7
HALT_BIT: Final = 1 << 8

CONTROL_WORDS: Final = {
    Command.SHUTDOWN: 0x0006,
    Command.SWITCH_ON: 0x0007,
    Command.ENABLE_OPERATION: 0x000F,
    Command.DISABLE_VOLTAGE: 0x0000,
    Command.QUICK_STOP: 0x0002,
    Command.FAULT_RESET: 0x0080,
}

# Status word (0x6041): mask and value of the bits that encode each state.
STATE_BITS: Final = {
    State.NOT_READY_TO_SWITCH_ON: (0x4F, 0x00),
    State.SWITCH_ON_DISABLED: (0x4F, 0x40),
    State.READY_TO_SWITCH_ON: (0x6F, 0x21),
    State.SWITCHED_ON: (0x6F, 0x23),
    State.OPERATION_ENABLED: (0x6F, 0x27),
    State.QUICK_STOP_ACTIVE: (0x6F, 0x07),
    State.FAULT_REACTION_ACTIVE: (0x4F, 0x0F),
    State.FAULT: (0x4F, 0x08),
}
VOLTAGE_ENABLED_BIT: Final = 1 << 4
WARNING_BIT: Final = 1 << 7
REMOTE_BIT: Final = 1 << 9  # the control word is in effect
TARGET_REACHED_BIT: Final = 1 << 10
INTERNAL_LIMIT_BIT: Final = 1 << 11
FOLLOWS_BIT: Final = 1 << 12  # csp, csv, cst: the set point is followed; homing: attained
FOLLOWING_ERROR_BIT: Final = 1 << 13  # csp; homing: error


def state_of(status_word: int) -> State | None:
    """Returns the state in a status word; None if its bits match no state."""
    for state, (mask, value) in STATE_BITS.items():
        if status_word & mask == value:
            return state
    return None


def command_of(control_word: int, before: int) -> Command:
    """Returns the command in a control word, given the previous one (the reset is an edge). With the reset bit high and
    no edge the other bits count, as the standard leaves it open and drives do."""
    if control_word & ~before & FAULT_RESET_BIT:
        return Command.FAULT_RESET
    if not control_word & ENABLE_VOLTAGE_BIT:
        return Command.DISABLE_VOLTAGE
    if not control_word & NOT_QUICK_STOP_BIT:
        return Command.QUICK_STOP
    if not control_word & SWITCH_ON_BIT:
        return Command.SHUTDOWN
    return Command.ENABLE_OPERATION if control_word & ENABLE_OPERATION_BIT else Command.SWITCH_ON


# By state and command: number of the transition in the standard, and new state. Other commands have no effect.
# Transitions 0, 1, 13 and 14 are the drive's own.
TRANSITIONS: Final[dict[tuple[State, Command], tuple[int, State]]] = {
    (State.SWITCH_ON_DISABLED, Command.SHUTDOWN): (2, State.READY_TO_SWITCH_ON),
    (State.READY_TO_SWITCH_ON, Command.SWITCH_ON): (3, State.SWITCHED_ON),
    (State.READY_TO_SWITCH_ON, Command.ENABLE_OPERATION): (3, State.SWITCHED_ON),  # and 4 after it
    (State.SWITCHED_ON, Command.ENABLE_OPERATION): (4, State.OPERATION_ENABLED),
    (State.OPERATION_ENABLED, Command.SWITCH_ON): (5, State.SWITCHED_ON),
    (State.SWITCHED_ON, Command.SHUTDOWN): (6, State.READY_TO_SWITCH_ON),
    (State.READY_TO_SWITCH_ON, Command.DISABLE_VOLTAGE): (7, State.SWITCH_ON_DISABLED),
    (State.READY_TO_SWITCH_ON, Command.QUICK_STOP): (7, State.SWITCH_ON_DISABLED),
    (State.OPERATION_ENABLED, Command.SHUTDOWN): (8, State.READY_TO_SWITCH_ON),
    (State.OPERATION_ENABLED, Command.DISABLE_VOLTAGE): (9, State.SWITCH_ON_DISABLED),
    (State.SWITCHED_ON, Command.DISABLE_VOLTAGE): (10, State.SWITCH_ON_DISABLED),
    (State.SWITCHED_ON, Command.QUICK_STOP): (10, State.SWITCH_ON_DISABLED),
    (State.OPERATION_ENABLED, Command.QUICK_STOP): (11, State.QUICK_STOP_ACTIVE),
    (State.QUICK_STOP_ACTIVE, Command.DISABLE_VOLTAGE): (12, State.SWITCH_ON_DISABLED),
    (State.FAULT, Command.FAULT_RESET): (15, State.SWITCH_ON_DISABLED),
    (State.QUICK_STOP_ACTIVE, Command.ENABLE_OPERATION): (16, State.OPERATION_ENABLED),
}

STAYS_AFTER_QUICK_STOP: Final = range(5, 9)  # option codes (0x605A) with which the drive stays in QUICK_STOP_ACTIVE


def after(state: State, command: Command, quick_stop_option: int = 2) -> State:
    """Returns the state after one command."""
    if (state, command) == (State.QUICK_STOP_ACTIVE, Command.ENABLE_OPERATION):
        if quick_stop_option not in STAYS_AFTER_QUICK_STOP:
            return state  # transition 16 exists only if the quick stop does not end by itself
    elif command is Command.FAULT_RESET and state is not State.FAULT:
        return state
    return TRANSITIONS.get((state, command), (0, state))[1]


# --- the master's side ---

_ORDER: Final = (State.SWITCH_ON_DISABLED, State.READY_TO_SWITCH_ON, State.SWITCHED_ON, State.OPERATION_ENABLED)
_UP: Final = {  # to the next state of that order
    State.SWITCH_ON_DISABLED: Command.SHUTDOWN,
    State.READY_TO_SWITCH_ON: Command.SWITCH_ON,
    State.SWITCHED_ON: Command.ENABLE_OPERATION,
}
_HOLD: Final = {  # the command that holds a state also reaches it from the higher states
    State.SWITCH_ON_DISABLED: Command.DISABLE_VOLTAGE,
    State.READY_TO_SWITCH_ON: Command.SHUTDOWN,
    State.SWITCHED_ON: Command.SWITCH_ON,
    State.OPERATION_ENABLED: Command.ENABLE_OPERATION,
    State.QUICK_STOP_ACTIVE: Command.QUICK_STOP,
}


def command_towards(wanted: State, now: State) -> Command | None:
    """Returns the next command on the shortest path to a state, or the one that holds it; None if only time (or, in
    FAULT, a reset) helps.

    wanted: a state that can be commanded. Raises ValueError for others, such as FAULT."""
    if wanted not in _HOLD:
        raise ValueError(f"a drive cannot be commanded into {wanted.value}")
    if now not in _HOLD:
        return None
    if wanted is State.QUICK_STOP_ACTIVE:
        return _UP.get(now, Command.QUICK_STOP)
    if now is State.QUICK_STOP_ACTIVE:
        return Command.DISABLE_VOLTAGE
    return _UP[now] if _ORDER.index(now) < _ORDER.index(wanted) else _HOLD[wanted]


@dataclass
class FaultReset:
    """Acknowledges a fault by rising edges, with growing pauses while it persists."""

    pauses_s: tuple[float, ...] = (0.0, 0.5, 2.0, 5.0)
    edge_s: float = 0.02  # how long the bit stays high
    tries: int = 0
    _next_s: float = 0.0
    _high_until_s: float = -1.0

    def word(self, now_s: float) -> int:
        """Returns the control word while the drive is in FAULT and may be reset."""
        if now_s < self._high_until_s:
            return CONTROL_WORDS[Command.FAULT_RESET]
        if self._high_until_s >= 0:  # low, so that the next reset is an edge
            self._high_until_s = -1.0
            return 0
        if self.tries == 0 and self._next_s == 0.0:
            self._next_s = now_s + self.pauses_s[0]
        if now_s < self._next_s:
            return 0
        self.tries += 1
        self._high_until_s = now_s + self.edge_s
        self._next_s = self._high_until_s + self.pauses_s[min(self.tries, len(self.pauses_s) - 1)]
        return CONTROL_WORDS[Command.FAULT_RESET]

    def forget(self) -> None:
        """Starts over: the fault was reset."""
        self.tries, self._next_s, self._high_until_s = 0, 0.0, -1.0


# --- the drive's side ---


@dataclass
class PowerStateMachine:
    """The power state machine on the drive's side.

    quick_stop_option: 0x605A; 5 to 8 stay in QUICK_STOP_ACTIVE once the drive is at rest.
    """

    state: State = State.NOT_READY_TO_SWITCH_ON
    quick_stop_option: int = 2
    error_code: int = 0  # 0x603F
    _before: int = 0

    def started(self) -> None:
        """Ends the self-test of the drive: transition 1."""
        if self.state is State.NOT_READY_TO_SWITCH_ON:
            self.state = State.SWITCH_ON_DISABLED

    def control(self, control_word: int, *, may_enable: bool = True, fault_gone: bool = True) -> State:
        """Executes a control word, at most one transition. Returns the new state.

        may_enable: the power stage is ready, so transition 4 is allowed.
        fault_gone: the cause of the fault is removed, so transition 15 is allowed.
        """
        command = command_of(control_word, self._before)
        self._before = control_word
        wanted = after(self.state, command, self.quick_stop_option)
        if wanted is State.OPERATION_ENABLED and self.state is State.SWITCHED_ON and not may_enable:
            return self.state
        if self.state is State.FAULT and wanted is not State.FAULT:
            if not fault_gone:
                return self.state
            self.error_code = 0
        self.state = wanted
        return self.state

    def fault(self, code: int) -> None:
        """Enters the fault reaction: transition 13. An earlier fault keeps its error code."""
        if self.state not in (State.FAULT_REACTION_ACTIVE, State.FAULT):
            self.state = State.FAULT_REACTION_ACTIVE
            self.error_code = code

    def rests(self) -> None:
        """Call at rest: ends a quick stop (transition 12) and a fault reaction (14)."""
        if self.state is State.FAULT_REACTION_ACTIVE:
            self.state = State.FAULT
        elif self.state is State.QUICK_STOP_ACTIVE and self.quick_stop_option not in STAYS_AFTER_QUICK_STOP:
            self.state = State.SWITCH_ON_DISABLED

    def status_word(self, more: int = 0) -> int:
        """Returns the status word of the state, with the bits of `more` added."""
        word = STATE_BITS[self.state][1]
        if self.state in (State.SWITCHED_ON, State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE):
            word |= VOLTAGE_ENABLED_BIT
        return word | REMOTE_BIT | more
