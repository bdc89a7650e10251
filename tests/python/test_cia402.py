"""AX-87: CiA 402, against the table of IEC 61800-7-201 and against the package canopen."""

from __future__ import annotations

import random
from types import SimpleNamespace

import pytest
from canopen.profiles.p402 import BaseNode402, State402
from takt.drives.cia402 import (
    CONTROL_WORDS,
    Command,
    FaultReset,
    PowerStateMachine,
    State,
    after,
    command_of,
    command_towards,
    state_of,
    supported_modes,
)
from takt.drives.error_texts import error_text

NRSO, SOD, RTSO, SO, OE, QSA, FRA, F = State
STATES = {"NRSO": NRSO, "SOD": SOD, "RTSO": RTSO, "SO": SO, "OE": OE, "QSA": QSA, "FRA": FRA, "F": F}

# As the standard has it: by state, where each command leads. "-": nothing changes. QSA and enable operation: only with
# a quick stop that stays (option codes 5 to 8).
TABLE = """\
        shutdown  switch_on  enable_operation  disable_voltage  quick_stop  fault_reset
NRSO    -         -          -                 -                -           -
SOD     RTSO      -          -                 -                -           -
RTSO    -         SO         SO                SOD              SOD         -
SO      RTSO      -          OE                SOD              SOD         -
OE      RTSO      SO         -                 SOD              QSA         -
QSA     -         -          OE                SOD              -           -
FRA     -         -          -                 -                -           -
F       -         -          -                 -                -           SOD
"""


def table() -> dict[tuple[State, Command], State]:
    head, *rows = TABLE.splitlines()
    commands = [Command[name.upper()] for name in head.split()]
    cells = {}
    for row in rows:
        name, *leads = row.split()
        for command, to in zip(commands, leads, strict=True):
            cells[STATES[name], command] = STATES[name] if to == "-" else STATES[to]
    return cells


def words_for(command: Command) -> list[int]:
    """Every control word of 8 bits that means this command, after a word with the reset bit low."""
    return [word for word in range(256) if command_of(word, 0) is command]


def test_all_states_and_all_commands() -> None:
    """AX-87: 8 states x 6 commands x every word that gives one."""
    for (state, command), to in table().items():
        assert after(state, command, quick_stop_option=6) is to, (state, command)
        assert words_for(command)
        for word in words_for(command):
            machine = PowerStateMachine(state, quick_stop_option=6)
            assert machine.control(word) is to, (state, hex(word))
    assert len(table()) == len(State) * len(Command)
    assert after(QSA, Command.ENABLE_OPERATION, quick_stop_option=2) is QSA


def test_control_words_mean_what_they_are_for() -> None:
    """AX-87: bit by bit, as the standard's table of commands says."""
    for command, word in CONTROL_WORDS.items():
        assert command_of(word, 0) is command
    for word in range(256):
        low = word & 0x0F
        expected = (
            Command.FAULT_RESET
            if word & 0x80
            else Command.DISABLE_VOLTAGE
            if not low & 2
            else Command.QUICK_STOP
            if not low & 4
            else Command.SHUTDOWN
            if not low & 1
            else Command.ENABLE_OPERATION
            if low & 8
            else Command.SWITCH_ON
        )
        assert command_of(word, 0) is expected
        assert command_of(word, 0x80) is command_of(word & 0x7F, 0), "a reset is an edge"


@pytest.mark.parametrize("wanted", [SOD, RTSO, SO, OE, QSA])
def test_a_wanted_state_is_reached_step_by_step(wanted: State) -> None:
    """AX-87: from every state, in four transitions at most; from a fault only with a reset."""
    for start in State:
        machine = PowerStateMachine(start, quick_stop_option=6)
        for _ in range(5):
            command = command_towards(wanted, machine.state)
            if command is None:
                break
            machine.control(CONTROL_WORDS[command])
        if start in (NRSO, FRA, F):
            assert machine.state is start
        else:
            assert machine.state is wanted
            machine.control(CONTROL_WORDS[command_towards(wanted, wanted) or Command.FAULT_RESET])
            assert machine.state is wanted, "and is held"
    for never in (NRSO, FRA, F):
        with pytest.raises(ValueError, match="cannot be commanded into"):
            command_towards(never, SOD)


def test_a_drive_goes_through_fault_and_reset() -> None:
    """AX-87: transitions 13, 14 and 15; a fault that lasts is not reset; the first code is the one told."""
    machine = PowerStateMachine()
    machine.started()
    for word in (6, 7, 15):
        machine.control(word)
    assert machine.state is OE
    machine.fault(0x3210)
    machine.fault(0x8611)
    assert (machine.state, machine.error_code) == (FRA, 0x3210)
    assert machine.control(0x80) is FRA
    machine.rests()
    assert machine.state is F
    assert machine.control(0x80) is F, "the bit was high already"
    machine.control(0)
    assert machine.control(0x80, fault_gone=False) is F
    machine.control(0)
    assert (machine.control(0x80), machine.error_code) == (SOD, 0)


def test_a_quick_stop_ends_as_its_option_says() -> None:
    """AX-87: transition 12 comes by itself, or the drive stays and may go on (16)."""
    for option, end in ((2, SOD), (6, QSA)):
        machine = PowerStateMachine(OE, quick_stop_option=option)
        assert machine.control(2) is QSA
        assert machine.control(15) is (OE if option == 6 else QSA)
        machine.control(2)
        machine.rests()
        assert machine.state is end


def test_switching_on_waits_for_the_power_stage() -> None:
    """AX-87."""
    machine = PowerStateMachine(SO)
    assert machine.control(15, may_enable=False) is SO
    assert machine.control(15) is OE


def test_faults_are_reset_by_edges_with_pauses() -> None:
    """AX-87: the bit is low between two tries, and they get rarer."""
    reset = FaultReset()
    rises = []
    before = 0
    for ms in range(20_000):
        word = reset.word(ms / 1000)
        if word & ~before & 0x80:
            rises.append(ms)
        before = word
    assert rises[:3] == [0, 520, 2540]
    assert reset.tries == len(rises) == 6
    reset.forget()
    assert reset.word(30.0) == 0x80


def test_status_words_are_read_as_canopen_reads_them() -> None:
    """AX-87: all 65,536, those of no state included."""
    for word in range(1 << 16):
        theirs = BaseNode402.state.fget(SimpleNamespace(statusword=word))
        ours = state_of(word)
        assert theirs == (ours.value.upper() if ours else "UNKNOWN"), hex(word)


def test_transitions_of_canopen_are_ours() -> None:
    """AX-87: its table says how a state is left for another; each of its words does that here."""
    checked = 0
    for (start, to), word in State402.TRANSITIONTABLE.items():
        if start == "START" or (start, to) in (
            ("NOT READY TO SWITCH ON", "SWITCH ON DISABLED"),  # by itself
            ("FAULT REACTION ACTIVE", "FAULT"),
        ):
            continue
        machine = PowerStateMachine(State(start.lower()), quick_stop_option=6)
        assert machine.control(word) is State(to.lower()), (start, to)
        checked += 1
    assert checked == 13


class Steered(BaseNode402):
    """canopen's master of a drive, whose words go straight to a state machine of ours."""

    TIMEOUT_RESET_FAULT = TIMEOUT_SWITCH_STATE_SINGLE = 0.005
    TIMEOUT_SWITCH_STATE_FINAL = 0.05

    def __init__(self, machine: PowerStateMachine) -> None:
        self.machine = machine

    @property
    def statusword(self) -> int:
        return self.machine.status_word()

    def check_statusword(self, timeout: float | None = None) -> int:
        return self.statusword

    controlword = property(None, lambda self, word: self.machine.control(word))


def test_random_walks_under_canopens_master() -> None:
    """AX-87: wherever random control words have led, both see the same state, and canopen leads on from there.

    Not right in canopen: it takes transition 16 out of a quick stop that ends by itself, and runs into its time-out."""
    random_numbers = random.Random(402)
    for _ in range(300):
        machine = PowerStateMachine(random_numbers.choice([SOD, RTSO, SO, OE]), random_numbers.choice([2, 6]))
        node = Steered(machine)
        for _ in range(random_numbers.randrange(12)):
            machine.control(random_numbers.randrange(1 << 16))
            if random_numbers.random() < 0.05:
                machine.fault(0x2310)
            assert node.state == machine.state.value.upper()
        if machine.state is FRA:
            machine.rests()
        if machine.state is F:
            machine.control(0)
            node.reset_from_fault()
        elif machine.state is QSA and machine.quick_stop_option == 2:
            with pytest.raises(RuntimeError, match="Timeout"):
                node.state = "OPERATION ENABLED"
            continue
        else:
            node.state = "OPERATION ENABLED"
        assert machine.state is OE


@pytest.mark.parametrize(
    ("code", "text"),
    [
        (0x3210, "0x3210 (DC link overvoltage)"),
        (0x3211, "0x3211 (DC link voltage)"),
        (0x8611, "0x8611 (following error)"),
        (0x6ABC, "0x6ABC (software of the drive)"),
        (0xFF17, "0xFF17 (of the maker of the drive)"),
        (0xB000, "0xB000 (unknown)"),
    ],
)
def test_errors_in_words(code: int, text: str) -> None:
    """AX-87: a code that is not listed is said by its group."""
    assert error_text(code) == text


def test_supported_modes() -> None:
    """AX-87: 0x6502."""
    assert supported_modes(0x3A5) == ["pp", "pv", "hm", "csp", "csv", "cst"]
