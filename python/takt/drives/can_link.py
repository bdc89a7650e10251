"""A CAN bus by the packages python-can and canopen: opened by its name, read while a caller waits for it."""

from __future__ import annotations

import contextlib
import logging
import re
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Final

from takt.drives.sdo import Objects, SdoError, abort_text
from takt.errors import TaktError

KIND: Final = "canopen"
DEFAULT_INTERFACE: Final = "socketcan"
ECHOES: Final = ("udp_multicast",)  # return own messages, too
ECHO_WITHIN_S: Final = 1.0
WITHOUT_BIT_RATE: Final = ("virtual", "udp_multicast")  # no wire, so no bit rate
MISSING: Final = "CANopen needs the packages canopen and python-can: pip install 'takt-motion[canopen]'"


def packages(missing: str = MISSING) -> tuple[Any, Any]:
    """Returns the modules can and canopen. Raises TaktError that says how to install them."""
    try:
        import can
        import canopen
    except ImportError:
        raise TaktError(missing) from None
    for name in ("can", "canopen"):  # takt reports errors itself; set a handler of logging to see theirs
        logger = logging.getLogger(name)
        if not logger.handlers:
            logger.addHandler(logging.NullHandler())
    return can, canopen


@dataclass(frozen=True)
class BusName:
    """ "canopen:INTERFACE:CHANNEL?OPTION=VALUE", with interface and channel as named by python-can."""

    text: str
    interface: str
    channel: str
    options: dict[str, int | str] = field(default_factory=dict)

    @property
    def has_wire(self) -> bool:
        return self.interface not in WITHOUT_BIT_RATE


def parse(text: str) -> BusName:
    """Returns the bus of this name; without an interface it is socketcan of Linux. Raises TaktError if the name is
    invalid."""
    can, _ = packages()
    kind, _, rest = text.partition(":")
    if kind != KIND or not rest:
        raise TaktError(f"{text}: expected canopen:CHANNEL or canopen:INTERFACE:CHANNEL, such as canopen:can0")
    rest, _, tail = rest.partition("?")
    options: dict[str, int | str] = {}
    for part in filter(None, tail.split("&")):
        key, equals, value = part.partition("=")
        if not equals or not key:
            raise TaktError(f"{text}: expected OPTION=VALUE behind the question mark, found {part}")
        options[key] = int(value) if re.fullmatch(r"-?[0-9]+", value) else value
    interface, colon, channel = rest.partition(":")
    if not colon:
        return BusName(text, DEFAULT_INTERFACE, rest, options)
    if interface not in can.VALID_INTERFACES:
        known = ", ".join(sorted(can.VALID_INTERFACES))
        raise TaktError(f"{text}: python-can has no interface {interface}; it has {known}")
    if not channel:
        raise TaktError(f"{text}: expected a channel behind the interface, such as canopen:{interface}:0")
    return BusName(text, interface, channel, options)


def open_bus(name: BusName, bitrate: int | None) -> Any:
    """Returns python-can's bus. Raises TaktError with the reason in one line."""
    can, _ = packages()
    options = dict(name.options)
    if bitrate and name.has_wire and name.interface != DEFAULT_INTERFACE:  # a socketcan interface has its own
        options["bitrate"] = bitrate
    try:
        return can.Bus(interface=name.interface, channel=name.channel, **options)
    except Exception as error:
        why = " ".join(str(error).split()) or type(error).__name__
        raise TaktError(f"{name.text}: the bus cannot be opened: {why}{_hint(name)}") from None


def _hint(name: BusName) -> str:
    if name.interface != DEFAULT_INTERFACE:
        return ""
    return f" (interfaces of this host: ip -br link show type can; switch on: ip link set {name.channel} up)"


class _Echoes:
    """Removes own messages that an interface returns; otherwise they would look like those of another master."""

    def __init__(self, bus: Any) -> None:
        self._send = bus.send
        self._sent: deque[tuple[float, int, bytes]] = deque()
        self._lock = threading.Lock()
        bus.send = self._note

    def _note(self, message: Any, timeout: float | None = None) -> None:
        with self._lock:
            self._sent.append((time.monotonic(), message.arbitration_id, bytes(message.data)))
        self._send(message, timeout)

    def take(self, message: Any) -> bool:
        """Returns whether the message is an own one; each is removed once."""
        data, since_s = bytes(message.data), time.monotonic() - ECHO_WITHIN_S
        with self._lock:
            while self._sent and self._sent[0][0] < since_s:
                self._sent.popleft()
            for entry in self._sent:
                if entry[1:] == (message.arbitration_id, data):
                    self._sent.remove(entry)
                    return True
        return False


class CanLink:
    """A bus and canopen's network on it. `pump`, or the thread of `background`, receives messages."""

    def __init__(self, name: BusName, bitrate: int | None = None, *, network: Any = None) -> None:
        _, canopen = packages()
        self.name = name
        self.bus = open_bus(name, bitrate)
        self._echoes = _Echoes(self.bus) if name.interface in ECHOES else None
        self.network = canopen.Network() if network is None else network  # an empty network is false
        self.network.bus = self.bus
        self.malformed = 0  # frames that could not be read

    def pump(self, timeout_s: float = 0.0) -> bool:
        """Receives one message, waiting at most `timeout_s`. Returns whether there was one. Raises TaktError if the
        interface cannot receive."""
        try:
            message = self.bus.recv(timeout_s)
        except Exception as error:  # the adapter was unplugged, the interface switched off
            raise TaktError(f"{self.name.text}: nothing can be received: {' '.join(str(error).split())}") from None
        if message is None:
            return False
        if message.is_error_frame or message.is_remote_frame:
            return True
        if self._echoes is not None and self._echoes.take(message):
            return True
        try:
            self.network.notify(message.arbitration_id, message.data, message.timestamp)
        except TaktError:
            raise
        except Exception:  # frames that are too short, or answers without a request: any node may send them
            self.malformed += 1
        return True

    def drain(self, most: int = 1000) -> None:
        """Receives pending messages, at most `most`."""
        while most and self.pump():
            most -= 1

    def wait(self, seconds: float) -> None:
        """Receives messages for this time [s]."""
        end_s = time.monotonic() + seconds
        while (left_s := end_s - time.monotonic()) > 0:
            self.pump(left_s)

    @contextlib.contextmanager
    def background(self) -> Iterator[None]:
        """Receives messages in a thread while the context is open, so that answers to SDOs arrive."""
        ended = threading.Event()

        def take() -> None:
            with contextlib.suppress(TaktError):  # the caller that waits for an answer reports its absence
                while not ended.is_set():
                    self.pump(0.02)

        thread = threading.Thread(target=take, daemon=True)
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join()

    def send(self, can_id: int, data: bytes) -> None:
        """Sends a message. Raises TaktError if the interface does not accept it."""
        try:
            self.network.send_message(can_id, data)
        except Exception as error:
            raise TaktError(f"{self.name.text}: nothing can be sent: {' '.join(str(error).split())}") from None

    def close(self) -> None:
        self.network.bus = None
        with contextlib.suppress(Exception):
            self.bus.shutdown()

    def __enter__(self) -> CanLink:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


# --- SDO ---

QUESTIONS: Final = 3  # without an answer


class Sdo(Objects):
    """Objects of one node. Messages must be received meanwhile by another thread (`CanLink.background`)."""

    def __init__(self, link: CanLink, node: int, timeout_s: float = 0.3) -> None:
        can, canopen = packages()
        self._can, self._canopen = can, canopen
        self._remote = canopen.RemoteNode(node, canopen.ObjectDictionary())
        link.network.add_node(self._remote)  # replaces an earlier one
        self._remote.sdo.RESPONSE_TIMEOUT = timeout_s
        self.node = node
        self.called = f"node {node}"

    def patience(self, timeout_s: float) -> Sdo:
        """Sets the longest time [s] to wait for an answer. Returns self."""
        self._remote.sdo.RESPONSE_TIMEOUT = timeout_s
        return self

    def upload(self, what: str, index: int, subindex: int) -> bytes:
        return bytes(self._asked(what, lambda: self._remote.sdo.upload(index, subindex)))

    def download(self, what: str, index: int, subindex: int, data: bytes) -> None:
        self._asked(what, lambda: self._remote.sdo.download(index, subindex, data))

    def _asked(self, what: str, question: Callable[[], Any]) -> Any:
        """Returns the answer; repeats the request if there is none, as a frame may get lost. Raises SdoError."""
        for _ in range(QUESTIONS):
            try:
                return question()
            except self._canopen.SdoAbortedError as error:
                raise SdoError(f"{what}: {abort_text(error.code)}", error.code) from None
            except self._canopen.SdoCommunicationError:
                pass
            except self._can.CanError as error:  # the buffer is full of frames that no node acknowledges
                raise SdoError(f"{what}: {' '.join(str(error).split())}") from None
        raise SdoError(f"{what}: no answer")


# --- constants of CANopen ---

NMT_COMMAND: Final = 0x000
SYNC: Final = 0x080
EMERGENCY: Final = 0x080  # + node
TPDO1: Final = 0x180
RPDO1: Final = 0x200
TPDO2: Final = 0x280
RPDO2: Final = 0x300
TPDO3: Final = 0x380
TPDO4: Final = 0x480
SDO_ANSWER: Final = 0x580
SDO_REQUEST: Final = 0x600
HEARTBEAT: Final = 0x700

START, STOP, PRE_OPERATIONAL, RESET_NODE, RESET_COMMUNICATION = 1, 2, 128, 129, 130
NMT_STATES: Final = {0: "starting", 4: "stopped", 5: "operational", 127: "pre-operational"}


def frame_bits(data_bytes: int) -> int:
    """Returns the largest number of bits of a frame with an 11-bit identifier on the wire, including stuffing and
    pause."""
    stuffed = 34 + 8 * data_bytes
    return stuffed + (stuffed - 1) // 4 + 13
