"""EN-26: the emulated EtherCAT slaves, frame by frame, without a network: addressing, states, EEPROM, mailbox, process
data, and frames that are none."""

from __future__ import annotations

import random
import struct
from typing import Any

import pytest
from buses import described
from takt.drives.cia402 import State
from takt.drives.esc import OPERATIONAL, PRE_OPERATIONAL, SAFE_OPERATIONAL, Line
from takt.drives.ethercat_emulation import EmulatedSlave, emulated_slaves

APRD, APWR, FPRD, FPWR, BRD, BWR, LRD, LWR, LRW = 1, 2, 4, 5, 7, 8, 10, 11, 12
AL_CONTROL, AL_STATUS, AL_CODE = 0x0120, 0x0130, 0x0134


def frame(command: int, first: int, second: int, data: bytes) -> bytearray:
    datagram = struct.pack("<BBHHHH", command, 7, first & 0xFFFF, second, len(data), 0) + data + b"\0\0"
    return bytearray(b"\xff" * 6 + bytes(6) + b"\x88\xa4" + struct.pack("<H", len(datagram) | 0x1000) + datagram)


class Master:
    """Sends one datagram at a time."""

    def __init__(self, count: int) -> None:
        lines = ["name: m", "axes:"]
        for k in range(1, count + 1):
            lines += [f"  - {{name: x{k}, limits: {{velocity: 500, acceleration: 5000, jerk: 100000}}}}"]
        lines += ["external:", "  buses:", "    - bus: ethercat:eth1", "      drives:"]
        lines += [f"        - {{axis: x{k}, position: {k}}}" for k in range(1, count + 1)]
        text = "\n".join(lines)
        whole = described(text)
        bus: Any = whole["external"]["buses"][0]
        self.slaves: list[EmulatedSlave] = emulated_slaves(bus, whole, text.encode(), "m.yaml")
        self.line = Line([slave.esc for slave in self.slaves])
        self.letters = 0

    def send(self, command: int, first: int, second: int, data: bytes) -> tuple[int, bytes]:
        """Working counter and data."""
        sent = frame(command, first, second, data)
        assert self.line.carry(sent)
        for slave in self.slaves:
            slave.esc.serve_mailbox()
            if slave.esc.waiting:
                slave.esc.live()
        return int.from_bytes(sent[-2:], "little"), bytes(sent[26:-2])

    def ask(self, address: int, state: int) -> tuple[int, int]:
        """AL status and code after a state has been asked for."""
        assert self.send(FPWR, address, AL_CONTROL, struct.pack("<H", state))[0] == 1
        status = self.send(FPRD, address, AL_STATUS, bytes(2))[1]
        code = self.send(FPRD, address, AL_CODE, bytes(2))[1]
        return int.from_bytes(status, "little"), int.from_bytes(code, "little")

    def into_preop(self) -> None:
        for k in range(len(self.slaves)):
            assert self.send(APWR, -k, 0x0010, struct.pack("<H", 0x1001 + k))[0] == 1
            managers = struct.pack("<HHBBBBHHBBBB", 0x1000, 256, 0x26, 0, 1, 0, 0x1200, 256, 0x22, 0, 1, 0)
            assert self.send(FPWR, 0x1001 + k, 0x0800, managers)[0] == 1
            assert self.ask(0x1001 + k, PRE_OPERATIONAL) == (PRE_OPERATIONAL, 0)

    def into_op(self) -> None:
        self.into_preop()
        for k in range(len(self.slaves)):
            managers = struct.pack("<HHBBBBHHBBBB", 0x1400, 6, 0x64, 0, 1, 0, 0x1800, 6, 0x20, 0, 1, 0)
            assert self.send(FPWR, 0x1001 + k, 0x0810, managers)[0] == 1
            out = struct.pack("<IHBBHBBI", 0x10000 + 6 * k, 6, 0, 7, 0x1400, 0, 2, 1)
            into = struct.pack("<IHBBHBBI", 0x20000 + 6 * k, 6, 0, 7, 0x1800, 0, 1, 1)
            assert self.send(FPWR, 0x1001 + k, 0x0600, out + into)[0] == 1
            assert self.ask(0x1001 + k, SAFE_OPERATIONAL) == (SAFE_OPERATIONAL, 0)
            assert self.ask(0x1001 + k, OPERATIONAL) == (OPERATIONAL, 0)

    def sdo(self, address: int, body: bytes) -> bytes:
        """The answer in the mailbox."""
        self.letters = self.letters % 7 + 1
        letter = struct.pack("<HHBBH", len(body) + 2, 0, 0, 3 | self.letters << 4, 2 << 12) + body
        assert self.send(FPWR, address, 0x1000, letter.ljust(256, b"\0"))[0] == 1
        counter, answer = self.send(FPRD, address, 0x1200, bytes(256))
        assert counter == 1
        return answer[8 : 6 + int.from_bytes(answer[:2], "little")]


def test_addresses_and_working_counters() -> None:
    """EN-26: by position, by address, to all."""
    master = Master(3)
    assert master.send(BRD, 0, 0x0000, bytes(2))[0] == 3
    assert master.send(APRD, -1, 0x0130, bytes(2)) == (1, b"\x01\x00")
    assert master.send(APRD, -3, 0x0130, bytes(2))[0] == 0
    assert master.send(FPRD, 0x1001, 0x0130, bytes(2))[0] == 0
    assert master.send(APWR, -2, 0x0010, b"\x34\x12")[0] == 1
    assert master.send(FPRD, 0x1234, 0x0010, bytes(2)) == (1, b"\x34\x12")
    assert master.send(BWR, 0, 0x0130, b"\x08\x00")[0] == 0, "registers that can only be read"
    master.slaves[1].esc.cut = True
    master.line.changed()
    assert master.send(BRD, 0, 0x0000, bytes(2))[0] == 1, "behind a broken cable nobody hears"


def test_states_and_their_errors() -> None:
    """EN-26: AL status codes, and acknowledgement."""
    master = Master(1)
    assert master.send(APWR, 0, 0x0010, struct.pack("<H", 0x1001))[0] == 1
    assert master.ask(0x1001, PRE_OPERATIONAL) == (0x11, 0x0016), "no mailboxes"
    assert master.ask(0x1001, OPERATIONAL) == (0x11, 0x0016), "an error wants to be acknowledged"
    assert master.ask(0x1001, 0x11) == (0x01, 0)
    assert master.ask(0x1001, OPERATIONAL) == (0x11, 0x0011)
    assert master.ask(0x1001, 0x13) == (0x11, 0x0013), "no bootstrap"
    assert master.ask(0x1001, 0x17) == (0x11, 0x0012)
    master = Master(1)
    master.into_preop()
    assert master.ask(0x1001, SAFE_OPERATIONAL) == (0x12, 0x001D), "no process data"


def test_process_data_and_the_watchdog() -> None:
    """EN-26: LRW counts 3 for a slave, 1 in SAFEOP; without outputs for too long it falls back, and its drive stops."""
    master = Master(2)
    master.into_op()
    for word in [6] * 3 + [7] * 3 + [15] * 400:
        assert master.send(LWR, 0x0000, 1, struct.pack("<Hi", word, 0) * 2)[0] == 2
    counter, data = master.send(LRD, 0x0000, 2, bytes(12))
    assert counter == 2
    assert [struct.unpack_from("<H", data, at)[0] & 0x6F for at in (0, 6)] == [0x27, 0x27]
    esc = master.slaves[0].esc
    assert not esc.watch(esc.last_s + 0.09)
    assert esc.watch(esc.last_s + 0.11)
    assert (esc.memory[AL_STATUS], esc.number_at(AL_CODE)) == (0x14, 0x001B)
    assert master.slaves[0].drive.machine.state in (State.FAULT_REACTION_ACTIVE, State.FAULT)
    assert master.send(LWR, 0x0000, 1, bytes(12))[0] == 1, "it takes no outputs any more"
    assert master.ask(0x1001, 0x14) == (0x04, 0)


def test_objects_in_the_mailbox() -> None:
    """EN-26: expedited, longer, refused; a repeated message is not carried out twice; mapping in PREOP only."""
    master = Master(1)
    master.into_preop()
    assert master.sdo(0x1001, struct.pack("<BHBI", 0x40, 0x1000, 0, 0))[4:8] == struct.pack("<I", 0x0002_0192)
    assert master.sdo(0x1001, struct.pack("<BHBI", 0x40, 0x1008, 0, 0))[8:] == b"Takt emulated drive"
    for body, code in (
        (struct.pack("<BHBI", 0x40, 0x5FFF, 0, 0), 0x0602_0000),
        (struct.pack("<BHBI", 0x40, 0x1018, 9, 0), 0x0609_0011),
        (struct.pack("<BHBI", 0x2B, 0x6041, 0, 0), 0x0601_0002),
        (struct.pack("<BHBI", 0x2B, 0x6060, 0, 0), 0x0607_0010),
        (struct.pack("<BHBI", 0x50, 0x1018, 0, 0), 0x0601_0000),
        (struct.pack("<BHBI", 0x23, 0x1600, 1, 0x60400010), 0x0601_0003),
        (struct.pack("<BHBI", 0x60, 0, 0, 0), 0x0504_0001),
        (struct.pack("<BHBI", 0xE0, 0, 0, 0), 0x0504_0001),
    ):
        answer = master.sdo(0x1001, body)
        assert (answer[0], struct.unpack_from("<I", answer, 4)[0]) == (0x80, code)
    number = master.letters
    assert master.sdo(0x1001, struct.pack("<BHBI", 0x2F, 0x6060, 0, 8))[0] == 0x60
    master.letters = number
    with pytest.raises(AssertionError):  # the same counter: no second answer
        master.sdo(0x1001, struct.pack("<BHBI", 0x2F, 0x6060, 0, 9))
    assert master.slaves[0].drive.values[0x6060] == 8


def test_frames_that_are_none() -> None:
    """EN-26: whatever comes over the wire, the slaves go on."""
    master = Master(2)
    master.into_op()
    chance = random.Random(5)
    good = [bytes(frame(c, 0x1001, 0x0120, bytes(20))) for c in range(16)]
    for _ in range(3000):
        wild = bytearray(chance.choice(good))
        for _ in range(chance.randrange(1, 6)):
            wild[chance.randrange(14, len(wild))] = chance.randrange(256)
        del wild[chance.randrange(15, len(wild) + 1) :]
        master.line.carry(wild)
        for slave in master.slaves:
            slave.esc.serve_mailbox()
            if slave.esc.waiting:
                slave.esc.live()
    assert master.line.malformed > 100
    assert master.send(BRD, 0, 0x0000, bytes(2))[0] == 2
