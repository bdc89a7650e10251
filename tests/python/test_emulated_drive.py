"""AX-87: the emulated drive of CiA 402 by its objects, without a bus."""

from __future__ import annotations

import random

import pytest
from buses import machine
from takt.drives import objects as od
from takt.drives.cia402 import STATE_BITS, Mode, PowerStateMachine, State, state_of
from takt.drives.emulated import EmulatedDrive
from takt.drives.scaling import Scaling

INPUTS = {"limit_negative": 0, "limit_positive": 1, "reference": 2, "touch_probe": -1}


def made(extra: str = "", scaling: Scaling | None = None) -> EmulatedDrive:
    text = machine("udpm://239.255.76.67:7667?ttl=0", "canopen:can0", 1) + extra
    return EmulatedDrive(text.encode(), "m.yaml", "x1", scaling or Scaling(), INPUTS)


def steps(drive: EmulatedDrive, word: int, count: int = 1) -> None:
    drive.write(od.CONTROL_WORD, word)
    for _ in range(count):
        drive.step()


def enabled(drive: EmulatedDrive, mode: Mode) -> EmulatedDrive:
    drive.write(od.MODE, mode)
    for word in (6, 7):
        steps(drive, word)
    steps(drive, 15, 200)
    assert state_of(drive.read(od.STATUS_WORD)) is State.OPERATION_ENABLED
    return drive


def test_the_power_stage_takes_its_time() -> None:
    """AX-87: SWITCHED_ON until it is up (power_up_s 0.1)."""
    drive = made()
    for word in (6, 7):
        steps(drive, word)
    steps(drive, 15, 50)
    assert state_of(drive.read(od.STATUS_WORD)) is State.SWITCHED_ON
    steps(drive, 15, 100)
    assert state_of(drive.read(od.STATUS_WORD)) is State.OPERATION_ENABLED


def test_a_quick_stop_brakes_along_its_ramp() -> None:
    """AX-87: 0x6085, then SWITCH ON DISABLED (0x605A = 2)."""
    drive = enabled(made(), Mode.CYCLIC_VELOCITY)
    drive.write(od.TARGET_VELOCITY, 100_000)
    steps(drive, 15, 300)
    assert drive.read(od.VELOCITY) == pytest.approx(100_000, rel=0.02)
    drive.write(od.QUICK_STOP_DECELERATION, 1_000_000)
    begin = drive.read(od.POSITION)
    count = 0
    while drive.machine.state is not State.SWITCH_ON_DISABLED:
        steps(drive, 2)
        count += 1
        assert count < 500
    assert count == pytest.approx(100, abs=15)  # ms
    assert drive.read(od.POSITION) - begin == pytest.approx(100_000**2 / 2e6, rel=0.1)


def test_homing_at_the_present_position() -> None:
    """AX-87: methods 35 and 37: the home offset is where it is; attained is said."""
    drive = enabled(made(), Mode.CYCLIC_VELOCITY)
    drive.write(od.TARGET_VELOCITY, 50_000)
    steps(drive, 15, 200)
    drive.write(od.TARGET_VELOCITY, 0)
    steps(drive, 15, 200)
    drive.write(od.MODE, Mode.HOMING)
    drive.write(od.HOME_OFFSET, 1234)
    steps(drive, 15)
    assert not drive.read(od.STATUS_WORD) & 1 << 12
    steps(drive, 31, 2)
    assert drive.read(od.STATUS_WORD) & 1 << 12
    assert drive.read(od.POSITION) == pytest.approx(1234, abs=2)
    drive.write(od.MODE, Mode.CYCLIC_POSITION)
    drive.write(od.TARGET_POSITION, drive.read(od.POSITION))
    steps(drive, 15, 50)
    assert drive.read(od.POSITION) == pytest.approx(1234, abs=2)


def test_a_following_error_is_a_fault() -> None:
    """AX-87: 0x8611 beyond the window (0x6065); bit 13."""
    drive = enabled(made(), Mode.CYCLIC_POSITION)
    drive.write(od.FOLLOWING_WINDOW, 500)
    drive.write(od.TARGET_POSITION, drive.read(od.POSITION) + 100_000)
    steps(drive, 15, 2)
    assert drive.machine.error_code == 0x8611
    assert drive.read(od.STATUS_WORD) & 1 << 13


def test_the_torque_limit_holds() -> None:
    """AX-87: 0x6072, thousandths of the rated torque."""
    drive = enabled(made(scaling=Scaling(rated_torque=2.0)), Mode.CYCLIC_VELOCITY)
    drive.write(od.MAX_TORQUE, 100)
    drive.write(od.TARGET_VELOCITY, 400_000)
    most = 0
    for _ in range(50):
        steps(drive, 15)
        most = max(most, drive.read(od.TORQUE))
    assert 90 <= most <= 100


def test_random_walks_obey_the_table() -> None:
    """AX-87: whatever control words and faults come, the drive goes where the state machine alone goes."""
    numbers = random.Random(402)
    drive = enabled(made(), Mode.CYCLIC_VELOCITY)
    moved = 0
    for _ in range(3000):
        drive.write(od.TARGET_VELOCITY, numbers.randrange(-200_000, 200_000))
        if numbers.random() < 0.01:
            drive.fault(0x2310)
        word = numbers.choice([0, 2, 6, 7, 15, 15, 15, 15, 0x80, numbers.randrange(1 << 16)])
        before = drive.machine.state
        alone = PowerStateMachine(before, drive.machine.quick_stop_option, _before=drive.machine._before)
        reachable = {before, alone.control(word)}
        if before is State.SWITCHED_ON:
            reachable.add(State.SWITCHED_ON)
        alone.rests()
        reachable.add(alone.state)
        steps(drive, word)
        assert drive.machine.state in reachable | {State.FAULT}
        mask, value = STATE_BITS[drive.machine.state]
        assert drive.read(od.STATUS_WORD) & mask == value
        if word == 15:
            steps(drive, 15, numbers.randrange(20))
        if drive.machine.state is State.SWITCHED_ON:
            drive._ready = numbers.random() < 0.5  # as if its power stage had come up
        moved += drive.machine.state is State.OPERATION_ENABLED
    assert moved > 100
