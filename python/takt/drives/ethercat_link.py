"""An EtherCAT bus by the package pysoem: opened by the name of an Ethernet interface, its slaves and their objects."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import select
import socket
import stat
import struct
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from takt.drives.esc import ETHERTYPE
from takt.drives.sdo import Objects, SdoError, abort_text
from takt.errors import TaktError

KIND: Final = "ethercat"
MISSING: Final = "EtherCAT needs the package pysoem: pip install 'takt-motion[ethercat]'"
QUESTIONS: Final = 3  # without an answer
FRAME_US: Final = 20_000  # longest round trip of a frame before the cycles begin: busy hosts are slow
LISTENED_S: Final = 0.05  # time to listen for another master
APWR, STATION_ADDRESS = 2, 0x0010  # a command, and the register that it writes
FIRST_SOURCE, SECOND_SOURCE = b"\x01\x01", b"\x04\x04"  # by interface: the package's source address of frames
OWN_INDEX: Final = 0x7F  # of a frame; the package uses 16 of them and ignores others
GET_FLAGS: Final = 0x8913  # of an interface, by ioctl
GET_LINK, LINKED_WITH = 18, 5  # of rtnetlink
ALIAS_WORD: Final = 4  # of the EEPROM
MAILBOX_MANAGER: Final = 0x0808  # register: the sync manager of the mailbox that a slave sends from
MAILBOX_FULL: Final = 0x08
MAILBOX_QUIET_S, MAILBOX_WITHIN_S = 0.02, 1.0  # silence after which no late answer is expected; longest wait for it

INIT, PRE_OPERATIONAL, SAFE_OPERATIONAL, OPERATIONAL = 1, 2, 4, 8
ERROR_BIT: Final = 0x10
STATES: Final = {
    0: "not there",
    INIT: "INIT",
    PRE_OPERATIONAL: "PREOP",
    3: "BOOT",
    SAFE_OPERATIONAL: "SAFEOP",
    OPERATIONAL: "OP",
}


def state_text(state: int) -> str:
    """Returns the name of an AL state, such as "SAFEOP with an error"."""
    name = STATES.get(state & 0x0F, f"state {state & 0x0F}")
    return f"{name} with an error" if state & ERROR_BIT else name


def package() -> Any:
    """Returns the module pysoem. Raises TaktError that says how to install it."""
    try:
        import pysoem
    except ImportError:
        raise TaktError(MISSING) from None
    pysoem.settings.always_release_gil = True
    pysoem.settings.timeouts.ret = FRAME_US
    return pysoem


def is_ethercat(bus: str) -> bool:
    return bus.startswith(f"{KIND}:")


def parse(text: str) -> str:
    """Returns the interface of "ethercat:INTERFACE". Raises TaktError if the name is invalid."""
    kind, _, interface = text.partition(":")
    if kind != KIND or not interface:
        raise TaktError(f"{text}: expected ethercat:INTERFACE, such as ethercat:eth1")
    return interface


def ethernet_socket(interface: str) -> socket.socket:
    """Returns a socket that receives and sends EtherCAT frames. Raises TaktError with the reason in one line."""
    name = f"{KIND}:{interface}"
    known = [found for _, found in socket.if_nameindex()]
    if interface not in known:
        raise TaktError(f"{name}: there is no interface {interface}; this host has {', '.join(sorted(known))}")
    try:
        opened = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETHERTYPE))
        opened.bind((interface, ETHERTYPE))
    except OSError as error:
        if error.errno in (errno.EPERM, errno.EACCES):
            raise TaktError(
                f"{name}: no right to raw Ethernet frames (CAP_NET_RAW): run this as root, or "
                f"setcap cap_net_raw+ep on the Python that runs it"
            ) from None
        raise TaktError(f"{name}: the interface cannot be opened: {error.strerror}") from None
    if not _is_up(opened, interface):
        opened.close()
        raise TaktError(f"{name}: the interface is switched off: ip link set {interface} up")
    return opened


def other_end(interface: str) -> str:
    """Returns the other end of a veth pair. Raises TaktError if the interface is not one."""
    linked = _linked(interface)
    if linked:
        with contextlib.suppress(OSError):  # the other end is in another network namespace
            return socket.if_indextoname(linked)
    raise TaktError(
        f"{KIND}:{interface}: expected one end of a veth pair of this host, whose other end the emulation takes: "
        f"ip link add {interface} type veth peer name {interface}-drives; "
        f"ip link set {interface} up; ip link set {interface}-drives up"
    )


def _linked(interface: str) -> int:
    """Returns the number of the interface that this one is linked with; 0 if none. Asks the kernel (rtnetlink), as /sys
    may be that of another network namespace."""
    with contextlib.suppress(OSError, struct.error):
        index = socket.if_nametoindex(interface)
        with socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, 0) as asking:
            asking.send(struct.pack("<IHHII", 32, GET_LINK, 1, 1, 0) + struct.pack("<BxHiII", 0, 0, index, 0, 0))
            answer = asking.recv(65536)
        at = 32
        while at + 4 <= len(answer):
            length, kind = struct.unpack_from("<HH", answer, at)
            if kind == LINKED_WITH:
                found: int = struct.unpack_from("<I", answer, at + 4)[0]
                return 0 if found == index else found
            at += max(4, length + 3 & ~3)
    return 0


def _is_up(opened: socket.socket, interface: str) -> bool:
    asked = fcntl.ioctl(opened, GET_FLAGS, struct.pack("16sH14x", interface.encode(), 0))
    return bool(struct.unpack_from("H", asked, 16)[0] & 1)


def _packet_sockets() -> set[int]:
    """Returns the packet sockets of this process."""
    found = set()
    for path in Path("/proc/self/fd").iterdir():
        number = int(path.name)
        with contextlib.suppress(OSError):
            if stat.S_ISSOCK(os.fstat(number).st_mode):
                with socket.socket(fileno=os.dup(number)) as opened:
                    if opened.family == socket.AF_PACKET:
                        found.add(number)
    return found


def another_master(interface: str, listened_s: float = LISTENED_S) -> bool:
    """Returns whether EtherCAT frames pass the interface while this process sends none."""
    with ethernet_socket(interface) as listening:
        return bool(select.select([listening], [], [], listened_s)[0])


class Wire:
    """The master on an interface, or on two at both ends of a ring. Everything but the exchange of process data may be
    done by one other thread at a time, which holds `lock`."""

    def __init__(self, bus: str, ring: str | None = None) -> None:
        pysoem = self.pysoem = package()
        self.bus, self.interface = bus, parse(bus)
        for interface in filter(None, (self.interface, ring)):
            if another_master(interface):
                raise TaktError(f"{bus}: another master is active on {interface}; two on one wire disturb each other")
        self.master = pysoem.Master()
        self.lock = threading.Lock()
        before = _packet_sockets()
        try:
            self.master.open(self.interface, ring)
        except Exception as error:
            raise TaktError(f"{bus}: the interface cannot be opened: {_line(error)}") from None
        self._sockets = _packet_sockets() - before
        self._received = [socket.socket(fileno=os.dup(number)) for number in self._sockets]
        self.ring_end = None if ring is None else ethernet_socket(ring)

    def hurry(self) -> None:
        """Call before the cycles begin. The package waits for frames in the kernel, for at least several ms if one is
        lost. So its sockets are made non-blocking, and `await_frame` waits first, as long as a cycle may."""
        for number in self._sockets:
            os.set_blocking(number, False)

    def await_frame(self, within_s: float) -> None:
        """Waits for a frame, at most `within_s`."""
        if self._sockets:
            select.select(self._sockets, [], [], max(0.0, within_s))

    def discard_late_frames(self) -> None:
        """Discards frames that came back too late: frame numbers only go up to 15, so the package would take one for
        the answer to its sixteenth next, and so on forever."""
        for received in self._received:
            with contextlib.suppress(OSError):  # no more
                while received.recv(2048, socket.MSG_DONTWAIT):
                    pass

    def find(self) -> list[Any]:
        """Brings the present slaves to PREOP. Returns them in the order of their positions. Raises TaktError."""
        try:
            count = self.master.config_init()
        except Exception as error:
            raise TaktError(f"{self.bus}: the slaves cannot be set up: {_line(error)}") from None
        return list(self.master.slaves) if count > 0 else []

    def ring_is_whole(self) -> bool:
        """Returns whether, since the previous call, frames from the first interface came in at the second one, and none
        that were sent there: a broken ring sends those back."""
        came = set()
        while self.ring_end is not None:
            try:
                frame, address = self.ring_end.recvfrom(2048, socket.MSG_DONTWAIT)
            except OSError:  # no more, or the interface is down
                break
            if address[2] != socket.PACKET_OUTGOING:
                came.add(frame[8:10])
        return FIRST_SOURCE in came and SECOND_SOURCE not in came

    def give_address(self, position: int, address: bytes) -> None:
        """Sends its address to the slave at a position, which has lost it with its supply. The package does that only
        for slaves without any address, and leaves a wrong one behind if a frame gets lost; so this is a frame of our
        own."""
        datagram = (
            struct.pack("<BBHHHH", APWR, OWN_INDEX, 1 - position & 0xFFFF, STATION_ADDRESS, 2, 0) + address + b"\0\0"
        )
        head = b"\xff" * 6 + b"\x02" + bytes(5) + ETHERTYPE.to_bytes(2, "big")
        with ethernet_socket(self.interface) as aside:
            aside.send((head + struct.pack("<H", len(datagram) | 0x1000) + datagram).ljust(60, b"\0"))

    def alias(self, slave: Any) -> int:
        """Returns the alias of a slave; 0 if none."""
        before = None
        for _ in range(QUESTIONS):  # read twice: a lost answer leaves an old value
            read = int.from_bytes(bytes(slave.eeprom_read(ALIAS_WORD))[:2], "little")
            if read == before:
                return read
            before = read
        return 0

    def sdo(self, slave: Any, position: int) -> Sdo:
        return Sdo(self, slave, position)

    def close(self) -> None:
        self._sockets = set()
        while self._received:
            self._received.pop().close()
        if self.ring_end is not None:
            self.ring_end.close()
            self.ring_end = None
        self.master.close()

    def __enter__(self) -> Wire:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Sdo(Objects):
    """Objects of the slave at a position, from 1."""

    def __init__(self, wire: Wire, slave: Any, position: int) -> None:
        self._wire, self._slave = wire, slave
        self.position = position
        self.called = f"slave {position}"
        self._within_s = 0.0

    def patience(self, timeout_s: float) -> Sdo:
        """Returns the same objects, whose requests without an answer are repeated for this time [s]."""
        patient = Sdo(self._wire, self._slave, self.position)
        patient._within_s = timeout_s
        return patient

    def upload(self, what: str, index: int, subindex: int) -> bytes:
        return bytes(self._asked(what, lambda: self._slave.sdo_read(index, subindex)))

    def download(self, what: str, index: int, subindex: int, data: bytes) -> None:
        self._asked(what, lambda: self._slave.sdo_write(index, subindex, data))

    def _asked(self, what: str, question: Callable[[], Any]) -> Any:
        pysoem = self._wire.pysoem
        end_s = time.monotonic() + self._within_s
        asked = 0
        while asked < QUESTIONS or time.monotonic() < end_s:
            asked += 1
            try:
                answer = question()
            except pysoem.SdoError as error:
                self._discard_late_answers(asked)
                code = error.abort_code & 0xFFFF_FFFF
                raise SdoError(f"{what}: {abort_text(code)}", code) from None
            except (pysoem.MailboxError, pysoem.PacketError, pysoem.WkcError):
                self._wire.discard_late_frames()
                continue  # a frame may get lost
            self._discard_late_answers(asked)
            return answer
        self._discard_late_answers(asked)
        raise SdoError(f"{what}: no answer")

    def _discard_late_answers(self, asked: int) -> None:
        """Discards late answers. A repeated request may be answered twice; the package would take the second answer for
        that to the next request for the same index."""
        end_s = time.monotonic() + MAILBOX_WITHIN_S
        empty_since_s: float | None = None
        while asked > 1 and time.monotonic() < end_s:
            try:
                manager = bytes(self._slave._fprd(MAILBOX_MANAGER, 8, FRAME_US))
                begin, length = struct.unpack_from("<HH", manager)
                if not manager[5] & MAILBOX_FULL:
                    empty_since_s = empty_since_s or time.monotonic()
                    if time.monotonic() - empty_since_s >= MAILBOX_QUIET_S:
                        return
                else:
                    empty_since_s = None
                    self._slave._fprd(begin, length, FRAME_US)
            except self._wire.pysoem.WkcError:
                empty_since_s = None
            time.sleep(0.001)


def _line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__
