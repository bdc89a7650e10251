"""The controller (ESC) of an emulated EtherCAT slave, and a line of them on a wire: registers, EEPROM, sync managers,
FMMUs, mailbox, states and clock as described in ETG.1000.3 and .4.

It is independent of the drive, which is the `Device` behind it.
"""

from __future__ import annotations

import struct
import time
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Final

ETHERTYPE: Final = 0x88A4
HEADER_BYTES: Final = 14  # of Ethernet
INIT, PRE_OPERATIONAL, BOOTSTRAP, SAFE_OPERATIONAL, OPERATIONAL = 1, 2, 3, 4, 8
ERROR_BIT: Final = 0x10  # of AL status; of AL control it is the acknowledgement

# Commands of datagrams.
_NOP, _APRD, _APWR, _APRW, _FPRD, _FPWR, _FPRW, _BRD, _BWR, _BRW, _LRD, _LWR, _LRW, _ARMW, _FRMW = range(15)
_BY_POSITION: Final = frozenset((_APRD, _APWR, _APRW, _ARMW))
_BY_ADDRESS: Final = frozenset((_FPRD, _FPWR, _FPRW, _FRMW))
_TO_ALL: Final = frozenset((_BRD, _BWR, _BRW))
_LOGICAL: Final = frozenset((_LRD, _LWR, _LRW))

# AL status codes.
INVALID_CHANGE: Final = 0x0011
UNKNOWN_STATE: Final = 0x0012
NO_BOOTSTRAP: Final = 0x0013
INVALID_MAILBOX: Final = 0x0016
SYNC_WATCHDOG: Final = 0x001B
INVALID_OUTPUTS: Final = 0x001D
INVALID_INPUTS: Final = 0x001E

# Registers.
_ADDRESS, _ALIAS, _LINKS, _AL_CONTROL, _AL_STATUS, _AL_CODE = 0x0010, 0x0012, 0x0110, 0x0120, 0x0130, 0x0134
_DIVIDER, _WATCHDOG, _WATCHDOG_STATE = 0x0400, 0x0420, 0x0440
_SII_CONTROL, _SII_ADDRESS, _SII_DATA = 0x0502, 0x0504, 0x0508
_FMMUS, _SYNC_MANAGERS, _SYNC_MANAGERS_END = 0x0600, 0x0800, 0x0840
_RECEIVED, _SYSTEM_TIME, _RECEIVED_64, _OFFSET = 0x0900, 0x0910, 0x0918, 0x0920
_MEMORY: Final = 0x1000  # process memory from here on; registers below
_SIZE: Final = 0x3000
_READ_ONLY: Final = ((0x0000, 0x0010), (0x0110, 0x0120), (0x0130, 0x0140), (0x0440, 0x0442))

_MAILBOX_FULL: Final = 0x08
_READS, _WRITES = 1, 2  # of FMMUs, seen from the master
_HOP_NS: Final = 500  # from slave to slave


class Device(ABC):
    """The application behind the controller."""

    @abstractmethod
    def mailbox(self, kind: int, data: bytes) -> list[tuple[int, bytes]]:
        """Returns the replies to a mailbox message, as (mailbox type, data); `kind` is its type: 3 is CoE."""

    @abstractmethod
    def sizes(self) -> tuple[int, int]:
        """Returns the sizes of the process data as presently mapped: outputs, inputs [bytes]."""

    @abstractmethod
    def entered(self, state: int, before: int) -> None:
        """Called after the AL state has changed from `before` to `state`."""

    @abstractmethod
    def cycle(self, outputs: bytes | None) -> bytes:
        """Executes one cycle and returns the inputs at its end. None: outputs are not in effect."""

    @property
    @abstractmethod
    def immediate(self) -> bool:
        """The inputs in a frame result from its own outputs, as in simulated time; else from those of the frame
        before."""


class Esc:
    """One slave.

    cut: the cable towards it is broken. off: it has no supply."""

    def __init__(self, eeprom: bytes, device: Device, number: int) -> None:
        self.eeprom, self.device, self.number = eeprom, device, number
        self.cut = self.off = False
        self.last_s = 0.0  # time of the last process data
        self.waiting = False  # process data were received; a cycle is to be executed
        self._clock_ns = 1_000_003 * (number + 1)  # offset from the host's clock, different for each slave
        self._drift, self._drifts_since_ns = 0.0, 0
        self.reset()

    def reset(self) -> None:
        """Resets memory and mailbox, as at power on."""
        m = self.memory = bytearray(_SIZE)
        # Type, revision, build, FMMUs, sync managers, KiB, ports 0 and 1, distributed clocks with 64 bits.
        m[0:10] = bytes((0x11, 0, 2, 0, 8, 8, 8, 0x0F, 0x0C, 0))
        m[_ALIAS : _ALIAS + 2] = self.eeprom[8:10]
        m[_AL_CONTROL] = m[_AL_STATUS] = INIT
        m[0x0140] = m[0x0150] = self.eeprom[0]
        struct.pack_into("<H", m, _DIVIDER, 2498)
        struct.pack_into("<H", m, 0x0410, 1000)
        struct.pack_into("<H", m, _WATCHDOG, 1000)
        m[_SII_CONTROL] = 0x40  # 8 bytes at once
        self._maps: list[tuple[int, int, int, int]] = []
        self._outbox: list[bytes] = []
        self._mailbox_message = b""  # message delivered last, for a repeat request
        self._received: bytes | None = None
        self._heard = self._sent = 0  # mailbox counters: last received, last sent
        self.waiting = False

    # --- state ---

    @property
    def state(self) -> int:
        return self.memory[_AL_STATUS] & 0x0F

    def number_at(self, register: int) -> int:
        return int.from_bytes(self.memory[register : register + 2], "little")

    def _control(self) -> None:
        """Handles a write to AL control: changes the state or refuses."""
        m = self.memory
        wanted, acknowledged = m[_AL_CONTROL] & 0x0F, bool(m[_AL_CONTROL] & ERROR_BIT)
        if m[_AL_STATUS] & ERROR_BIT and not acknowledged:
            return
        code = self._objection(wanted)
        if code:
            self.fall_back(self.state, code)
        else:
            self._enter(wanted)

    def _objection(self, wanted: int) -> int:
        """Returns the AL status code with which a change of state is refused; 0 if it is allowed."""
        now = self.state
        if wanted == BOOTSTRAP:
            return NO_BOOTSTRAP
        if wanted not in (INIT, PRE_OPERATIONAL, SAFE_OPERATIONAL, OPERATIONAL):
            return UNKNOWN_STATE
        if wanted > now and (now, wanted) not in ((INIT, 2), (PRE_OPERATIONAL, 4), (SAFE_OPERATIONAL, 8)):
            return INVALID_CHANGE
        if wanted >= PRE_OPERATIONAL and not (self._active(0) and self._active(1)):
            return INVALID_MAILBOX
        if wanted >= SAFE_OPERATIONAL:
            outputs, inputs = self.device.sizes()
            if self._area(2)[1] != outputs or (outputs and not self._active(2)):
                return INVALID_OUTPUTS
            if self._area(3)[1] != inputs or (inputs and not self._active(3)):
                return INVALID_INPUTS
        return 0

    def fall_back(self, state: int, code: int) -> None:
        """Changes to a state, with the error bit and this AL status code."""
        self._enter(state, ERROR_BIT, code)

    def _enter(self, state: int, error: int = 0, code: int = 0) -> None:
        before = self.state
        self.memory[_AL_STATUS] = state | error
        struct.pack_into("<H", self.memory, _AL_CODE, code)
        if state == INIT:
            self._outbox.clear()
            self._heard = 0
        if state != before:
            self.last_s = time.monotonic()
            self.waiting = False
            self.device.entered(state, before)
            if state == SAFE_OPERATIONAL:
                self._put_inputs(self.device.cycle(None))

    @property
    def watchdog_s(self) -> float:
        """Time [s] without outputs after which the process data watchdog expires; 0: it is disabled."""
        return self.number_at(_WATCHDOG) * (self.number_at(_DIVIDER) + 2) * 40e-9

    def watch(self, now_s: float) -> bool:
        """Returns whether the process data watchdog expires now; if so, changes to SAFEOP with AL status code
        0x001B."""
        watchdog_s = self.watchdog_s
        watched = self.state == OPERATIONAL and watchdog_s and self.memory[_SYNC_MANAGERS + 16 + 4] & 0x40
        if not watched or now_s - self.last_s <= watchdog_s:
            return False
        self.memory[_WATCHDOG_STATE] = 0
        self.fall_back(SAFE_OPERATIONAL, SYNC_WATCHDOG)
        return True

    # --- sync managers ---

    def _area(self, manager: int) -> tuple[int, int]:
        """Returns begin and length of a sync manager's area."""
        begin, length = struct.unpack_from("<HH", self.memory, _SYNC_MANAGERS + 8 * manager)
        return begin, length

    def _active(self, manager: int) -> bool:
        return bool(self.memory[_SYNC_MANAGERS + 8 * manager + 6] & 1)

    def _put_inputs(self, inputs: bytes) -> None:
        begin, length = self._area(3)
        self.memory[begin : begin + length] = inputs[:length].ljust(length, b"\0")

    def live(self) -> None:
        """Executes a cycle of the device; its inputs are in the area of sync manager 3 for the next frame."""
        self.waiting = False
        begin, length = self._area(2)
        operational = self.state == OPERATIONAL
        self._put_inputs(self.device.cycle(bytes(self.memory[begin : begin + length]) if operational else None))

    # --- mailbox ---

    def serve_mailbox(self) -> None:
        """Passes the received message to the device and queues its replies."""
        letter, self._received = self._received, None
        if letter is None:
            return
        self.memory[_SYNC_MANAGERS + 5] &= ~_MAILBOX_FULL
        length, _, _, kind = struct.unpack_from("<HHBB", letter)
        counter = kind >> 4 & 7
        if counter and counter == self._heard:
            return  # a repetition: its acknowledgement was lost
        self._heard = counter
        size = self._area(1)[1]
        for kind_of_answer, data in self.device.mailbox(kind & 0x0F, letter[6 : 6 + length]):
            self._sent = self._sent % 7 + 1
            answer = struct.pack("<HHBB", len(data), 0, 0, kind_of_answer | self._sent << 4) + data
            self._outbox.append(answer.ljust(size, b"\0"))
        self._deliver()

    def _deliver(self) -> None:
        status = _SYNC_MANAGERS + 8 + 5
        if self._outbox and not self.memory[status] & _MAILBOX_FULL:
            self._mailbox_message = self._outbox.pop(0)
            self._put_mailbox_message()

    def _put_mailbox_message(self) -> None:
        begin, length = self._area(1)
        self.memory[begin : begin + length] = self._mailbox_message[:length].ljust(length, b"\0")
        self.memory[_SYNC_MANAGERS + 8 + 5] |= _MAILBOX_FULL

    def _repetition(self) -> None:
        """Repeats the last message if the master requests it by changing bit 1; that of the next byte acknowledges
        it."""
        at = _SYNC_MANAGERS + 8 + 6
        if (self.memory[at] ^ self.memory[at + 1]) & 2:
            self.memory[at + 1] ^= 2
            if self._mailbox_message:
                if self.memory[at - 1] & _MAILBOX_FULL:
                    begin, length = self._area(1)
                    self._outbox.insert(0, bytes(self.memory[begin : begin + length]))
                self._put_mailbox_message()

    # --- memory ---

    def read(self, at: int, length: int) -> bytes | None:
        """Returns `length` bytes of the memory; None if the mailbox is empty or they exceed the memory. Reading the
        last byte of the mailbox empties it."""
        m = self.memory
        if at >= _MEMORY:
            begin, size = self._area(1)
            if self._active(1) and at < begin + size and begin < at + length:
                if not m[_SYNC_MANAGERS + 8 + 5] & _MAILBOX_FULL:
                    return None
                data = bytes(m[at : at + length])
                if at + length >= begin + size:
                    m[_SYNC_MANAGERS + 8 + 5] &= ~_MAILBOX_FULL
                    self._deliver()
                return data
        elif at + length > _SYSTEM_TIME and at < _SYSTEM_TIME + 8:
            offset_ns = struct.unpack_from("<q", m, _OFFSET)[0]
            struct.pack_into("<Q", m, _SYSTEM_TIME, self.local_ns() + offset_ns & (1 << 64) - 1)
        data = bytes(m[at : at + length])
        return data if len(data) == length else None

    def write(self, at: int, data: bytes) -> bool:
        """Writes to the memory. Returns False if it is read-only or too short, or the mailbox is full."""
        m, end = self.memory, at + len(data)
        if end > _SIZE or any(first <= at and end <= last for first, last in _READ_ONLY):
            return False
        if at >= _MEMORY:
            begin, size = self._area(0)
            if self._active(0) and at < begin + size and begin < end:
                if m[_SYNC_MANAGERS + 5] & _MAILBOX_FULL:
                    return False
                m[at:end] = data
                if end >= begin + size:
                    m[_SYNC_MANAGERS + 5] |= _MAILBOX_FULL
                    self._received = bytes(m[begin : begin + size])
                return True
            m[at:end] = data
            return True
        kept = bytes(m[at:end])
        m[at:end] = data
        for first, last in _READ_ONLY:
            if first < end and at < last:
                low, high = max(first, at), min(last, end)
                m[low:high] = kept[low - at : high - at]
        self._written(at, end, kept)
        return True

    def _written(self, at: int, end: int, kept: bytes) -> None:
        """Handles writes to registers that have an effect."""
        m = self.memory
        if at <= _AL_CONTROL < end:
            self._control()
        if at < _SII_DATA and end > _SII_CONTROL:
            self._access_eeprom()
        if at < _FMMUS + 0x80 and end > _FMMUS:
            self._maps = []
            for base in range(_FMMUS, _FMMUS + 0x80, 16):
                start, length, _, _, physical, _, kind, active = struct.unpack_from("<IHBBHBBB", m, base)
                if active & 1:
                    self._maps.append((start, start + length, physical, kind))
        if at < _SYNC_MANAGERS_END and end > _SYNC_MANAGERS:
            for manager in range(8):
                base = _SYNC_MANAGERS + 8 * manager
                for own in (base + 5, base + 7):  # the slave's own
                    if at <= own < end:
                        m[own] = kept[own - at]
                if not m[base + 6] & 1:
                    m[base + 5] &= ~_MAILBOX_FULL
            self._repetition()
        if at == _RECEIVED:
            self._latch()

    def _access_eeprom(self) -> None:
        m = self.memory
        command = self.number_at(_SII_CONTROL) & 0x0700
        at = 2 * struct.unpack_from("<I", m, _SII_ADDRESS)[0]
        refused = 0
        if command == 0x0100:
            m[_SII_DATA : _SII_DATA + 8] = self.eeprom[at : at + 8].ljust(8, b"\xff")
        elif command:
            refused = 0x2000  # the EEPROM is read-only
        struct.pack_into("<H", m, _SII_CONTROL, 0x0040 | refused)

    # --- clock ---

    def local_ns(self) -> int:
        now_ns = time.monotonic_ns()
        return now_ns + self._clock_ns + round(self._drift * (now_ns - self._drifts_since_ns))

    def drift(self, ppm: float) -> None:
        """Sets the drift [ppm] of the clock against that of the host, from now on; its time does not jump."""
        now_ns = time.monotonic_ns()
        self._clock_ns = self.local_ns() - now_ns
        self._drift, self._drifts_since_ns = 1e-6 * ppm, now_ns

    def _latch(self) -> None:
        """Latches the times at which the frame that writes here passed each port; the line of slaves sets the hops."""
        begin_ns = self.local_ns()
        there, back = begin_ns + self.hops_there * _HOP_NS, begin_ns + self.hops_back * _HOP_NS
        struct.pack_into("<II", self.memory, _RECEIVED, there & 0xFFFF_FFFF, back & 0xFFFF_FFFF)
        struct.pack_into("<Q", self.memory, _RECEIVED_64, there)

    hops_there = hops_back = 0

    # --- logical addresses ---

    def logical(self, command: int, start: int, data: bytearray, at: int, length: int) -> int:
        """Reads and writes its part of a datagram. Returns the increment of the working counter."""
        if self.state < SAFE_OPERATIONAL:
            return 0
        wrote = read = False
        m, end = self.memory, start + length
        if command != _LRD and self.state == OPERATIONAL:
            for first, last, physical, kind in self._maps:
                low, high = max(first, start), min(last, end)
                if kind == _WRITES and low < high:
                    to = physical + low - first
                    m[to : to + high - low] = data[at + low - start : at + high - start]
                    wrote = True
            if wrote:
                self.last_s = time.monotonic()
                m[_WATCHDOG_STATE] = 1
                self.waiting = True
                if self.device.immediate:
                    self.live()
        if command != _LWR:
            for first, last, physical, kind in self._maps:
                low, high = max(first, start), min(last, end)
                if kind == _READS and low < high:
                    origin = physical + low - first
                    data[at + low - start : at + high - start] = m[origin : origin + high - low]
                    read = True
            if read and self.state == SAFE_OPERATIONAL:
                self.waiting = True
        return read + (2 * wrote if command == _LRW else wrote)


class Line:
    """Slaves in a line."""

    def __init__(self, slaves: Sequence[Esc]) -> None:
        self.slaves = list(slaves)
        self.malformed = 0  # EtherCAT frames with a datagram that exceeds the frame
        self._reached: list[Esc] | None = None
        self._behind: list[Esc] | None = None

    def reached(self) -> list[Esc]:
        """Returns the slaves before the first broken cable and the first one without supply."""
        if self._reached is None:
            self._reached = []
            for slave in self.slaves:
                if slave.cut or slave.off:
                    break
                self._reached.append(slave)
            last = len(self._reached) - 1
            for number, slave in enumerate(self._reached):
                slave.hops_there, slave.hops_back = number, 2 * last - number
                # Port 0 has a link, port 1 unless it is the last one; the others are closed.
                links = 0x5211 | (0x0400 if number == last else 0x0820)
                struct.pack_into("<H", slave.memory, _LINKS, links)
        return self._reached

    def reached_from_behind(self) -> list[Esc]:
        """Returns, for a broken ring, the slaves behind the last broken cable and the last one without supply."""
        if self._behind is None:
            self._behind = []
            for slave in reversed(self.slaves):
                if slave.off:
                    break
                self._behind.insert(0, slave)
                if slave.cut:
                    break
        return self._behind

    @property
    def whole(self) -> bool:
        """A frame that enters at one end of a ring leaves at the other."""
        return len(self.reached()) == len(self.slaves)

    def changed(self) -> None:
        """Call after cables or supplies have changed."""
        self._reached = self._behind = None

    def carry(self, frame: bytearray, *, behind: bool = False) -> bool:
        """Sends a frame through the slaves and back. Returns False if it is not an EtherCAT frame, is malformed, or no
        slave is reached.

        behind: it enters at the far end of a broken ring."""
        slaves = self.reached_from_behind() if behind else self.reached()
        if len(frame) < HEADER_BYTES + 2 or frame[12:14] != b"\x88\xa4" or not slaves:
            return False
        header = int.from_bytes(frame[14:16], "little")
        if header >> 12 != 1:
            return False
        at, more = HEADER_BYTES + 2, True
        while more:
            if at + 12 > len(frame):
                self.malformed += 1
                return False
            command, first, second, length_word = struct.unpack_from("<BxHHH", frame, at)
            length, more = length_word & 0x7FF, bool(length_word & 0x8000)
            body = at + 10
            if body + length + 2 > len(frame):
                self.malformed += 1
                return False
            self._datagram(slaves, command, first, second, frame, at, body, length)
            at = body + length + 2
        frame[6] |= 0x02  # marks a frame that has passed the slaves
        return True

    def _datagram(
        self,
        slaves: Sequence[Esc],
        command: int,
        first: int,
        second: int,
        frame: bytearray,
        at: int,
        body: int,
        length: int,
    ) -> None:
        end = body + length
        counter = int.from_bytes(frame[end : end + 2], "little")
        if command in _LOGICAL:
            start = first | second << 16
            for slave in slaves:
                counter += slave.logical(command, start, frame, body, length)
        elif command in _BY_POSITION or command in _TO_ALL:
            for number, slave in enumerate(slaves):
                mine = command in _TO_ALL or (first + number) & 0xFFFF == 0
                counter += _physical(slave, command, mine, second, frame, body, end)
            struct.pack_into("<H", frame, at + 2, first + len(slaves) & 0xFFFF)
        elif command in _BY_ADDRESS:
            for slave in slaves:
                mine = slave.number_at(_ADDRESS) == first
                counter += _physical(slave, command, mine, second, frame, body, end)
        struct.pack_into("<H", frame, end, counter & 0xFFFF)


def _physical(slave: Esc, command: int, mine: bool, register: int, frame: bytearray, body: int, end: int) -> int:
    """Executes a datagram at a slave. Returns the increment of the working counter."""
    if command in (_ARMW, _FRMW):  # read at one, written to all others
        if not mine:
            if register != _SYSTEM_TIME:  # clocks follow the first one anyway: they do not drift apart here
                return int(slave.write(register, bytes(frame[body:end])))
            return 1
        command = _APRD
    elif not mine:
        return 0
    came = bytes(frame[body:end])
    counter = 0
    if command in (_APRD, _FPRD, _BRD, _APRW, _FPRW, _BRW):
        found = slave.read(register, end - body)
        if found is not None:
            if command in _TO_ALL:
                found = bytes(a | b for a, b in zip(found, came, strict=True))
            frame[body:end] = found
            counter += 1
    if command not in (_APRD, _FPRD, _BRD):
        counter += slave.write(register, came) * (1 if command in (_APWR, _FPWR, _BWR) else 2)
    return counter
