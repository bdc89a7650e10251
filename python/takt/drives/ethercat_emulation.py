"""Emulated drives on EtherCAT: slaves in a line on an Ethernet interface, usually one end of a veth pair, each with an
EmulatedDrive (`takt drives emulate`). Commands cause faults, broken cables and lost frames.

Time: each frame of process data advances a drive by one period. With the clock of the host (0x2000 = 0) the frame is
answered first, with the previous actual values, as slaves do; without frames a drive continues by the clock. In
simulated time (0x2000 = 1) a frame is a whole cycle: its outputs are executed, and the resulting values are in the same
frame.
"""

from __future__ import annotations

import random
import select
import socket
import struct
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Final

from takt.drives import objects as od
from takt.drives.cia402 import State
from takt.drives.coe import AbortError, Entry, SdoServer
from takt.drives.emulated import HOMING_METHODS, EmulatedDrive
from takt.drives.emulation_commands import CLOCK, CLOCK_IS_SYNC, HELP, NAME, PRODUCT, VENDOR, Commanded
from takt.drives.esc import OPERATIONAL, PRE_OPERATIONAL, Device, Esc, Line
from takt.drives.ethercat_link import ethernet_socket
from takt.drives.scaling import scaling_of

REVISION: Final = 1
STRANGE: Final = 0x0001  # product of a device without an axis
LINK_LOST: Final = 0x7500
MOST_DRIFT_PPM: Final = 100_000
SILENCE_S: Final = 0.1  # without process data, until a drive continues by the clock
MOST_MADE_UP_S: Final = 0.2
MAILBOX_BYTES: Final = 256
MAILBOX_OUT, MAILBOX_IN, OUTPUTS, INPUTS = 0x1000, 0x1200, 0x1400, 0x1800
MOST_MAPPED: Final = 16  # objects
RX_MAP, TX_MAP, RX_ASSIGNED, TX_ASSIGNED = 0x1600, 0x1A00, 0x1C12, 0x1C13

NOT_NOW: Final = 0x0800_0022
WRONG_LENGTH: Final = 0x0607_0010
OUT_OF_RANGE: Final = 0x0609_0030
NOT_MAPPABLE: Final = 0x0604_0041
NO_OBJECT: Final = 0x0602_0000
TOO_LONG: Final = 0x0604_0042
READ_ONLY: Final = 0x0601_0002
FIRST_NONE: Final = 0x0601_0003  # a mapping can be changed only while subindex 0 is 0

DEFAULT_MAPS: Final = {RX_MAP: (od.CONTROL_WORD, od.TARGET_POSITION), TX_MAP: (od.STATUS_WORD, od.POSITION)}
_FORMATS: Final = {8: "Bb", 16: "Hh", 32: "Ii"}  # unsigned and signed


class EmulatedSlave(Device):
    """A drive behind its controller.

    fixed_map: its process data have a fixed mapping, as with simple drives."""

    def __init__(
        self, number: int, drive: EmulatedDrive, *, alias: int = 0, product: int = PRODUCT, fixed_map: bool = False
    ) -> None:
        self.drive, self.alias, self.product, self.fixed_map = drive, alias, product, fixed_map
        self._clock_is_sync = False
        self.state = 1
        self.cycles = 0  # executed cycles
        self.lived_s = 0.0
        self._alone = False  # no process data are received
        self._maps: dict[int, list[od.Object]] = {}
        self._counts: dict[int, int] = {}
        self._structs: dict[int, struct.Struct] = {}
        self.numbers: dict[tuple[int, int], tuple[int, int]] = {}  # value and bits of objects that only hold a number
        self._default()
        self._server = SdoServer(self._dictionary(), MAILBOX_BYTES)
        self.esc = Esc(eeprom(alias, product, number + 1), self, number)

    def _default(self) -> None:
        for index, entries in DEFAULT_MAPS.items():
            self._maps[index] = list(entries)
            self._counts[index] = len(entries)
        self._pack()

    def restart(self) -> None:
        """Restarts the slave, as after its supply has returned."""
        self._default()
        self._clock_is_sync = False
        self.state = 1
        self.esc.reset()
        self.drive.restart()

    # --- objects ---

    def _dictionary(self) -> dict[tuple[int, int], Entry]:
        found: dict[tuple[int, int], Entry] = {}

        def number(index: int, subindex: int, value: int, bits: int, writable: bool = False) -> None:
            self.numbers[index, subindex] = (value, bits)
            write = partial(self._write_number, index, subindex) if writable else None
            found[index, subindex] = Entry(partial(self._read_number, index, subindex), write)

        number(0x1000, 0, 0x0002_0192, 32)
        number(0x1001, 0, 0, 8)
        for index, text in ((0x1008, NAME), (0x1009, "emulated"), (0x100A, "1")):
            found[index, 0] = Entry(partial(bytes, text.encode()))
        for subindex, value in enumerate((4, VENDOR, self.product, REVISION, 0)):
            number(0x1018, subindex, value, 32 if subindex else 8)
        for subindex, value in enumerate((4, 1, 2, 3, 4)):
            number(0x1C00, subindex, value, 8)
        for subindex, value, bits in ((0, 2, 8), (1, 1, 8), (2, 0xFD, 8)):
            number(0x60C2, subindex, value, bits, subindex > 0)
        for index in (0x1C32, 0x1C33):
            for subindex, value, bits in ((0, 2, 8), (1, 1, 16), (2, 1_000_000, 32)):
                number(index, subindex, value, bits, subindex == 1)
        number(0x6099, 0, 2, 8)
        for which in (0, 1):
            found[0x6099, which + 1] = Entry(
                partial(self._read_homing_velocity, which), partial(self._write_homing_velocity, which)
            )
        found[CLOCK] = Entry(lambda: bytes((self._clock_is_sync,)), self._set_clock)
        for entry in od.OBJECTS.values():
            write = partial(self._write_object, entry) if entry.writable else None
            found[entry.index, 0] = Entry(partial(self._read_object, entry), write)
        for map_index, assigned in ((RX_MAP, RX_ASSIGNED), (TX_MAP, TX_ASSIGNED)):
            for subindex in range(MOST_MAPPED + 1):
                found[map_index, subindex] = Entry(
                    partial(self._read_map, map_index, subindex), partial(self._write_map, map_index, subindex)
                )
            number(assigned, 0, 1, 8)
            found[assigned, 0].write = partial(self._assign, assigned, map_index, 0)
            number(assigned, 1, map_index, 16)
            found[assigned, 1].write = partial(self._assign, assigned, map_index, 1)
        return found

    def _read_number(self, index: int, subindex: int) -> bytes:
        value, bits = self.numbers[index, subindex]
        return value.to_bytes(bits // 8, "little")

    def _write_number(self, index: int, subindex: int, data: bytes) -> None:
        bits = self.numbers[index, subindex][1]
        self.numbers[index, subindex] = (_number(data, bits), bits)

    def _read_homing_velocity(self, which: int) -> bytes:
        return self.drive.homing_velocities[which].to_bytes(4, "little")

    def _write_homing_velocity(self, which: int, data: bytes) -> None:
        self.drive.homing_velocities[which] = _number(data, 32)

    def _read_object(self, entry: od.Object) -> bytes:
        return entry.encode(self.drive.read(entry))

    def _write_object(self, entry: od.Object, data: bytes) -> None:
        _number(data, entry.bits)
        value = entry.decode(data)
        if entry is od.HOMING_METHOD and value not in HOMING_METHODS:
            raise AbortError(OUT_OF_RANGE)
        self.drive.write(entry, value)

    def _set_clock(self, data: bytes) -> None:
        self._clock_is_sync = _number(data, 8) == CLOCK_IS_SYNC

    # --- mapping ---

    def _read_map(self, index: int, subindex: int) -> bytes:
        if subindex == 0:
            return bytes((self._counts[index],))
        entries = self._maps[index]
        return (entries[subindex - 1].mapping if subindex <= len(entries) else 0).to_bytes(4, "little")

    def _changeable(self) -> None:
        if self.state != PRE_OPERATIONAL:
            raise AbortError(NOT_NOW)
        if self.fixed_map:
            raise AbortError(READ_ONLY)

    def _write_map(self, index: int, subindex: int, data: bytes) -> None:
        self._changeable()
        if subindex == 0:
            count = _number(data, 8)
            if count > len(self._maps[index]):
                raise AbortError(NOT_MAPPABLE)
            self._counts[index] = count
            if count:
                del self._maps[index][count:]
            self._pack()
            return
        if self._counts[index]:
            raise AbortError(FIRST_NONE)
        word = _number(data, 32)
        entry = od.OBJECTS.get(word >> 16)
        if entry is None:
            raise AbortError(NO_OBJECT)
        if word != entry.mapping or not entry.mappable or (index == RX_MAP and not entry.writable):
            raise AbortError(NOT_MAPPABLE)
        if subindex > len(self._maps[index]) + 1:
            raise AbortError(TOO_LONG)
        self._maps[index][subindex - 1 :] = [entry]

    def _assign(self, assigned: int, map_index: int, subindex: int, data: bytes) -> None:
        self._changeable()
        bits = 16 if subindex else 8
        value = _number(data, bits)
        if (subindex == 0 and value > 1) or (subindex == 1 and value != map_index):
            raise AbortError(OUT_OF_RANGE)
        self.numbers[assigned, subindex] = (value, bits)
        self._pack()

    def _pack(self) -> None:
        for index in (RX_MAP, TX_MAP):
            entries = self._maps[index][: self._counts[index]]
            self._structs[index] = struct.Struct("<" + "".join(_FORMATS[e.bits][e.signed] for e in entries))

    def sizes(self) -> tuple[int, int]:
        return (
            self._structs[RX_MAP].size if self.numbers[RX_ASSIGNED, 0][0] else 0,
            self._structs[TX_MAP].size if self.numbers[TX_ASSIGNED, 0][0] else 0,
        )

    # --- interface of the controller ---

    def mailbox(self, kind: int, data: bytes) -> list[tuple[int, bytes]]:
        return self._server.answer(kind, data)

    @property
    def immediate(self) -> bool:
        return self._clock_is_sync

    def entered(self, state: int, before: int) -> None:
        self.state = state
        self.lived_s = time.monotonic()
        if before == OPERATIONAL:
            if self.drive.machine.state in (State.SWITCHED_ON, State.OPERATION_ENABLED, State.QUICK_STOP_ACTIVE):
                self.drive.fault(LINK_LOST)
            self.drive.write(od.CONTROL_WORD, 0)

    def cycle(self, outputs: bytes | None) -> bytes:
        if outputs is not None:
            layout = self._structs[RX_MAP]
            if len(outputs) >= layout.size:
                for entry, value in zip(self._maps[RX_MAP], layout.unpack_from(outputs), strict=False):
                    self.drive.values[entry.index] = value
        self.drive.step()
        self.cycles += 1
        self._alone = False
        self.lived_s = time.monotonic()
        read = self.drive.values
        return self._structs[TX_MAP].pack(*(read[e.index] for e in self._maps[TX_MAP][: self._counts[TX_MAP]]))

    def live_by_the_clock(self, now_s: float) -> None:
        """Steps the drive by the clock: without process data a motor keeps moving."""
        if self._clock_is_sync or not self.drive.moving:
            return
        if now_s - self.lived_s < SILENCE_S and not self._alone:
            return
        self._alone = True
        self.lived_s = max(self.lived_s, now_s - MOST_MADE_UP_S)
        while now_s - self.lived_s > self.drive.period_s:
            self.lived_s += self.drive.period_s
            self.drive.step()


def _number(data: bytes, bits: int) -> int:
    if len(data) != bits // 8:
        raise AbortError(WRONG_LENGTH)
    return int.from_bytes(data, "little")


# --- EEPROM (SII, ETG.1000.6 and ETG.2010) ---


def eeprom(alias: int, product: int, serial: int) -> bytes:
    """Returns the EEPROM: identity, mailboxes, name, sync managers, FMMUs and the default mapping."""
    head = struct.pack("<HHHHHHH", 0x0005, 0, 0, 0, alias, 0, 0)
    image = bytearray(head + bytes((_checksum(head), 0)))
    image += struct.pack("<IIII", VENDOR, product, REVISION, serial)
    image += bytes(8)
    image += struct.pack("<HHHH", 0, 0, 0, 0)  # no bootstrap mailboxes
    image += struct.pack("<HHHHH", MAILBOX_OUT, MAILBOX_BYTES, MAILBOX_IN, MAILBOX_BYTES, 0x0004)  # CoE
    image = bytearray(image.ljust(0x7C, b"\0"))
    image += struct.pack("<HH", 15, 1)  # 16 Kbit, version
    texts = [NAME, "Drives", "Outputs", "Inputs"]
    strings = bytes((len(texts),)) + b"".join(bytes((len(text),)) + text.encode() for text in texts)
    # Group, image, order, name; CoE with SDO, assignment and mapping; nothing else; two ports of MII.
    general = struct.pack("<BBBBBBBBBBBBhHHH", 2, 0, 1, 1, 0, 0x0D, 0, 0, 0, 1, 0, 0, 0, 0, 0x0011, 0).ljust(32, b"\0")
    sizes = {index: sum(e.bits for e in entries) // 8 for index, entries in DEFAULT_MAPS.items()}
    managers = b"".join(
        struct.pack("<HHBBBB", begin, length, control, 0, 1, kind)
        for begin, length, control, kind in (
            (MAILBOX_OUT, MAILBOX_BYTES, 0x26, 1),
            (MAILBOX_IN, MAILBOX_BYTES, 0x22, 2),
            (OUTPUTS, sizes[RX_MAP], 0x64, 3),
            (INPUTS, sizes[TX_MAP], 0x20, 4),
        )
    )
    image += _category(10, strings) + _category(30, general)
    image += _category(40, bytes((1, 2, 0, 0))) + _category(41, managers)
    image += _category(50, _map_in_eeprom(TX_MAP, 3, 4)) + _category(51, _map_in_eeprom(RX_MAP, 2, 3))
    image += b"\xff\xff"
    return bytes(image.ljust(2048, b"\xff"))


def _category(kind: int, data: bytes) -> bytes:
    data += b"\0" * (len(data) % 2)
    return struct.pack("<HH", kind, len(data) // 2) + data


def _map_in_eeprom(index: int, manager: int, name: int) -> bytes:
    entries = DEFAULT_MAPS[index]
    kinds = {(8, True): 2, (16, True): 3, (32, True): 4, (8, False): 5, (16, False): 6, (32, False): 7}
    made = struct.pack("<HBBBBH", index, len(entries), manager, 0, name, 0)
    for entry in entries:
        made += struct.pack("<HBBBBH", entry.index, 0, 0, kinds[entry.bits, entry.signed], entry.bits, 0)
    return made


def _checksum(data: bytes) -> int:
    """Returns the CRC of 8 bits, x^8 + x^2 + x + 1, from 0xFF."""
    crc = 0xFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1) ^ 0x107 if crc & 0x80 else crc << 1
    return crc


# --- the bus ---


class EthercatEmulation(Commanded):
    """Slaves on an interface, the first one next to the master. `run` serves them until `stop`.

    nodes: by position, from 1.
    ring: interface at the other end of the slaves; None: no ring."""

    called = "slave"
    help = HELP + " | lose PERCENT | fix NODE | drift PPM"

    def __init__(
        self, interface: str, slaves: Sequence[EmulatedSlave], say: Callable[[str], None], ring: str | None = None
    ) -> None:
        super().__init__(dict(enumerate(slaves, start=1)), say)
        self._slaves = list(slaves)
        self.line = Line([slave.esc for slave in slaves])
        self.lost_share = 0.0
        self.frames = self.lost = 0
        self._random = random.Random(1)
        self._ends = [ethernet_socket(interface)]
        if ring is not None:
            self._ends.append(ethernet_socket(ring))
        self._looked_s = 0.0

    def run(self) -> None:
        frame = bytearray(2048)
        while self._running:
            for end in select.select(self._ends, [], [], 0.002)[0]:
                self._take(frame, end)
            now_s = time.monotonic()
            if now_s - self._looked_s > 0.002:
                self._looked_s = now_s
                self._tick(now_s)
            self.obey()

    def close(self) -> None:
        for end in self._ends:
            end.close()

    def __enter__(self) -> EthercatEmulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _loses(self) -> bool:
        if self.lost_share and self._random.random() < self.lost_share:
            self.lost += 1
            return True
        return False

    def _carry(self, frame: bytearray, end: socket.socket) -> socket.socket | None:
        """Sends a frame through the slaves. Returns the end where it leaves; None if nowhere. In an intact ring slaves
        read and write only frames from its first end; those from the other end pass unchanged."""
        if len(self._ends) == 1:
            return end if self.line.carry(frame) else None
        behind = end is self._ends[1]
        if not self.line.whole:
            return end if self.line.carry(frame, behind=behind) else None
        if behind:
            return self._ends[0]
        return self._ends[1] if self.line.carry(frame) else None

    def _take(self, buffer: bytearray, end: socket.socket) -> None:
        try:
            length, address = end.recvfrom_into(buffer)
        except OSError:  # the interface is down, or gone
            time.sleep(0.01)
            return
        if address[2] == socket.PACKET_OUTGOING or self._loses():
            return
        frame = bytearray(memoryview(buffer)[:length])
        out = self._carry(frame, end)
        if out is None:
            return
        self.frames += 1
        if not self._loses():
            try:
                out.send(frame)
            except OSError:
                return
        for slave in self._slaves:  # after the answer, which must not wait for it
            esc = slave.esc
            esc.serve_mailbox()
            if esc.waiting:
                esc.live()

    def _tick(self, now_s: float) -> None:
        for slave in self._slaves:
            if slave.esc.off:
                continue
            if not slave.immediate:
                slave.esc.watch(now_s)
            slave.live_by_the_clock(now_s)

    # --- commands ---

    def cut(self, node: EmulatedSlave, out: bool) -> None:
        node.esc.cut = out
        self.line.changed()

    def power(self, node: EmulatedSlave, on: bool) -> None:
        was, node.esc.off = node.esc.off, not on
        if was and on:
            node.restart()
        self.line.changed()

    def more(self, verb: str, rest: Sequence[str]) -> str | None:
        if verb == "lose":
            percent = float(rest[0])
            if not 0 <= percent <= 100:
                raise ValueError(percent)
            self.lost_share = percent / 100
        elif verb == "drift":
            ppm = float(rest[0])
            if not abs(ppm) <= MOST_DRIFT_PPM:
                raise ValueError(ppm)
            for node in self._slaves:  # their clocks are synchronised
                node.esc.drift(ppm)
        elif verb == "fix":
            for node in self._which(rest[0]):
                node.fixed_map = True
        else:
            return None
        return f"{verb} {rest[0]}: done"


def emulated_slaves(
    described: Mapping[str, Any], machine: Mapping[str, Any], text: bytes, file: str
) -> list[EmulatedSlave]:
    """Returns the drives of one bus of a machine file at their positions; gaps are filled by drives with an alias, then
    by devices of another product."""
    axes = {axis["name"]: axis for axis in machine["axes"]}
    drives = list(described["drives"])
    by_position = {one["position"]: one for one in drives if one.get("position") is not None}
    by_alias = [one for one in drives if one.get("position") is None]
    slaves: list[EmulatedSlave] = []
    while by_position or by_alias:
        one = by_position.pop(len(slaves) + 1, None)
        strange = one is None and not by_alias
        if one is None:
            one = drives[0] if strange else by_alias.pop(0)
        scaling = scaling_of(one, axes[one["axis"]], one.get("rated_torque") or 1.0)
        drive = EmulatedDrive(text, file, one["axis"], scaling, dict(one["inputs"]))
        drive.period_s = float(machine["cycle"]["period_s"])
        product = STRANGE if strange else PRODUCT
        slaves.append(EmulatedSlave(len(slaves), drive, alias=one.get("alias") or 0, product=product))
    return slaves
