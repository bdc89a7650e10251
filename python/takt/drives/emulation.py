"""Emulated drives on a CANopen bus: nodes with SDO server, heartbeat, SYNC and process data, each with an EmulatedDrive
(`takt drives emulate`). Commands cause faults and broken cables.

Time: each SYNC advances a drive by one period (0x1006). With the clock of the host (0x2000 = 0) it first sends its
actual values and then applies its set point, as drives do; without SYNC it continues by the clock. In simulated time
(0x2000 = 1) a SYNC is a whole cycle: the set point is applied, executed, and the resulting values are sent.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from takt.drives import objects as od
from takt.drives.can_link import CanLink, packages, parse
from takt.drives.cia402 import State
from takt.drives.emulated import HOMING_METHODS, EmulatedDrive
from takt.drives.emulation_commands import CLOCK, CLOCK_IS_SYNC, NAME, PRODUCT, VENDOR, Commanded
from takt.drives.scaling import scaling_of
from takt.errors import TaktError

HEARTBEAT_LOST: Final = 0x8130
SYNC_LOST: Final = 0x8700
SILENCE_S: Final = 0.1  # without SYNC, until it counts as lost
MOST_MADE_UP_S: Final = 0.2  # most time that is caught up with after a pause of the process
OPERATIONAL: Final = 5
PRE_OPERATIONAL: Final = 127
NOT_MAPPED: Final = 1 << 31
_RPDOS: Final = (0x1400, 0x1401)
_TPDOS: Final = (0x1800, 0x1801, 0x1802, 0x1803)


def _dictionary(product: int) -> Any:
    """Returns canopen's object dictionary of an emulated drive."""
    _, canopen = packages()
    dictionary = canopen.objectdictionary
    datatypes = dictionary.datatypes
    kinds = {
        (8, False): datatypes.UNSIGNED8,
        (16, False): datatypes.UNSIGNED16,
        (32, False): datatypes.UNSIGNED32,
        (8, True): datatypes.INTEGER8,
        (16, True): datatypes.INTEGER16,
        (32, True): datatypes.INTEGER32,
    }
    whole = dictionary.ObjectDictionary()

    def variable(index: int, sub: int, bits: int, value: int, access: str = "rw", *, signed: bool = False) -> Any:
        made = dictionary.ODVariable(f"0x{index:04X}:{sub}", index, sub)
        made.data_type, made.default, made.access_type = kinds[bits, signed], value, access
        return made

    def record(index: int, *members: Any) -> None:
        made = dictionary.ODRecord(f"0x{index:04X}", index)
        made.add_member(variable(index, 0, 8, members[-1].subindex))
        for member in members:
            made.add_member(member)
        whole.add_object(made)

    for index, bits, value, access in (
        (0x1000, 32, 0x0002_0192, "ro"),
        (0x1001, 8, 0, "ro"),
        (0x1006, 32, 0, "rw"),
        (0x1017, 16, 0, "rw"),
        (CLOCK[0], 8, 0, "rw"),
    ):
        whole.add_object(variable(index, 0, bits, value, access))
    name = dictionary.ODVariable("device name", 0x1008, 0)
    name.data_type, name.default, name.access_type = datatypes.VISIBLE_STRING, NAME, "const"
    whole.add_object(name)
    record(0x1016, variable(0x1016, 1, 32, 0))
    record(0x1018, *(variable(0x1018, k, 32, v, "ro") for k, v in ((1, VENDOR), (2, product), (3, 1), (4, 0))))
    record(0x60C2, variable(0x60C2, 1, 8, 1), variable(0x60C2, 2, 8, -3, signed=True))
    record(0x6099, variable(0x6099, 1, 32, 0), variable(0x6099, 2, 32, 0))
    for base, first in zip((*_RPDOS, *_TPDOS), (0x200, 0x300, 0x180, 0x280, 0x380, 0x480), strict=True):
        settings = [variable(base, 1, 32, NOT_MAPPED | first), variable(base, 2, 8, 255)]
        settings += [variable(base, 5, 16, 0)] if base >= 0x1800 else []
        record(base, *settings)
        record(base + 0x200, *(variable(base + 0x200, k, 32, 0) for k in range(1, 9)))
    for entry in od.OBJECTS.values():
        access = "rw" if entry.writable else "ro"
        whole.add_object(variable(entry.index, 0, entry.bits, entry.default, access, signed=entry.signed))
    return whole


class _Map:
    """One message of process data with its mapping."""

    def __init__(self, cob_id: int, transmission: int, again_s: float, entries: Sequence[od.Object]) -> None:
        self.cob_id, self.transmission, self.again_s = cob_id, transmission, again_s
        self.sent_s = 0.0
        self.entries = entries
        kinds = {(8, False): "B", (8, True): "b", (16, False): "H", (16, True): "h", (32, False): "I", (32, True): "i"}
        self._struct = struct.Struct("<" + "".join(kinds[e.bits, e.signed] for e in entries))
        self.waiting: bytes | None = None  # received; applied at the next SYNC
        self.sent = b""

    def take(self, drive: EmulatedDrive, data: bytes) -> bool:
        """Writes the data of a message to the drive. Returns False if it is shorter than mapped."""
        if len(data) < self._struct.size:
            return False
        for entry, value in zip(self.entries, self._struct.unpack_from(data), strict=True):
            drive.write(entry, value)
        return True

    def data(self, drive: EmulatedDrive) -> bytes:
        return self._struct.pack(*(drive.read(entry) for entry in self.entries))


class EmulatedNode:
    """A drive on the bus."""

    def __init__(self, number: int, drive: EmulatedDrive, product: int = PRODUCT) -> None:
        _, canopen = packages()
        self.id, self.drive = number, drive
        self.local = canopen.LocalNode(number, _dictionary(product))
        self.local.add_read_callback(self._read)
        self.local.add_write_callback(self._write)
        self.state = PRE_OPERATIONAL
        self.cut = self.off = False
        self.heartbeat_s = 0.0
        self.watched: tuple[int, float] | None = None  # a node, and its longest silence [s]
        self.master_heard_s: float | None = None
        self.beat_s = 0.0
        self.sync_s: float | None = None  # the last one
        self.lived_s = 0.0  # time up to which the drive was stepped without SYNC
        self.clock_is_sync = False
        self.rpdos: list[_Map] = []
        self.tpdos: list[_Map] = []
        self.told_fault = 0

    def _read(self, index: int, subindex: int, **_: Any) -> int | None:
        if index == 0x6099 and subindex:
            return self.drive.homing_velocities[subindex - 1]
        return self.drive.values.get(index) if subindex == 0 else None

    def _write(self, index: int, subindex: int, data: bytes, **_: Any) -> None:
        _, canopen = packages()
        entry = od.OBJECTS.get(index)
        if entry is not None:
            value = entry.decode(bytes(data))
            if entry is od.HOMING_METHOD and value not in HOMING_METHODS:
                raise canopen.SdoAbortedError(0x0609_0030)
            self.drive.write(entry, value)
            return
        value = int.from_bytes(data, "little")
        if index == 0x1017:
            self.heartbeat_s = value / 1000
        elif (index, subindex) == (0x1016, 1):
            self.watched = (value >> 16 & 0x7F, (value & 0xFFFF) / 1000) if value & 0xFFFF else None
            self.master_heard_s = None
        elif index == 0x6099 and subindex:
            self.drive.homing_velocities[subindex - 1] = value
        elif index == 0x1006 and value:
            self.drive.period_s = value / 1e6
        elif (index, subindex) == CLOCK:
            self.clock_is_sync = value == CLOCK_IS_SYNC

    def number(self, index: int, subindex: int) -> int:
        return int.from_bytes(self.local.get_data(index, subindex), "little")

    def map(self) -> None:
        """Reads the mappings, as a node does when it becomes operational."""
        self.rpdos = list(filter(None, (self._mapped(index) for index in _RPDOS)))
        self.tpdos = list(filter(None, (self._mapped(index) for index in _TPDOS)))

    def _mapped(self, index: int) -> _Map | None:
        cob_id = self.number(index, 1)
        if cob_id & NOT_MAPPED:
            return None
        words = [self.number(index + 0x200, k) for k in range(1, self.number(index + 0x200, 0) + 1)]
        again_s = self.number(index, 5) / 1000 if index >= 0x1800 else 0.0
        return _Map(cob_id & 0x7FF, self.number(index, 2), again_s, [od.OBJECTS[word >> 16] for word in words])


class Emulation(Commanded):
    """Nodes on a bus. `run` serves them until `stop`; commands are texts of `takt drives emulate`."""

    def __init__(self, link: Any, nodes: Sequence[EmulatedNode], say: Callable[[str], None]) -> None:
        super().__init__({node.id: node for node in nodes}, say)
        self.link = link
        self.silence_s = SILENCE_S
        link.emulation = self
        network = link.network
        for node in nodes:
            network.add_node(node.local)
            network.unsubscribe(0, node.local.nmt.on_command)
        network.subscribe(0, self._on_nmt)
        network.subscribe(0x80, self._on_sync)

    # --- running ---

    def run(self) -> None:
        for node in self.nodes.values():
            self._boot(node)
        while self._running:
            self.link.pump(0.002)
            self.link.drain(100)
            self._tick(time.monotonic())
            self.obey()

    def reaches(self, node: EmulatedNode) -> bool:
        return not node.cut and not node.off

    def _send(self, node: EmulatedNode, can_id: int, data: bytes) -> None:
        if self.reaches(node):
            self.link.send(can_id, data)

    def _boot(self, node: EmulatedNode) -> None:
        node.state, node.heartbeat_s, node.watched, node.sync_s = PRE_OPERATIONAL, 0.0, None, None
        node.local.data_store.clear()
        node.rpdos, node.tpdos = [], []
        node.drive.restart()
        self._send(node, 0x700 + node.id, b"\x00")

    # --- the bus ---

    def route(self, can_id: int) -> bool:
        """Returns whether a message reaches its node: false for a node behind a broken cable."""
        node = self.nodes.get(can_id & 0x7F)
        return node is None or can_id <= 0x80 or self.reaches(node)

    def heard(self, can_id: int, data: bytes) -> None:
        """Handles a message that canopen's nodes do not: process data, and heartbeats."""
        if can_id > 0x700:
            for node in self.nodes.values():
                if node.watched and node.watched[0] == can_id - 0x700 and self.reaches(node):
                    node.master_heard_s = time.monotonic()
            return
        own = self.nodes.get(can_id & 0x7F)
        if own is None or own.state != OPERATIONAL or not self.reaches(own):
            return
        for mapped in own.rpdos:
            if mapped.cob_id != can_id:
                continue
            if mapped.transmission <= 240:
                mapped.waiting = bytes(data)
            elif not mapped.take(own.drive, bytes(data)):
                self._emergency(own, 0x8210)

    def _on_nmt(self, _can_id: int, data: bytes, _s: float) -> None:
        for node in self.nodes.values():
            if data[1] not in (0, node.id) or not self.reaches(node):
                continue
            if data[0] == 1:
                node.map()
                node.state, node.sync_s = OPERATIONAL, None
            elif data[0] in (2, 128):
                node.state = 4 if data[0] == 2 else PRE_OPERATIONAL
                if node.drive.machine.state is State.OPERATION_ENABLED:
                    node.drive.fault(HEARTBEAT_LOST)
            elif data[0] in (129, 130):
                self._boot(node)

    def _on_sync(self, _can_id: int, _data: bytes, _s: float) -> None:
        now_s = time.monotonic()
        live = [node for node in self.nodes.values() if node.state == OPERATIONAL and self.reaches(node)]
        for node in live:  # actual values are sent first: the master waits for them
            node.sync_s = node.lived_s = now_s
            if not node.clock_is_sync:
                self._publish(node)
        for node in live:
            for mapped in node.rpdos:
                if mapped.waiting is not None:
                    data, mapped.waiting = mapped.waiting, None
                    if not mapped.take(node.drive, data):
                        self._emergency(node, 0x8210)
            node.drive.step()
            if node.clock_is_sync:
                self._publish(node)

    def _publish(self, node: EmulatedNode) -> None:
        self._tell_fault(node)
        for mapped in reversed(node.tpdos):  # inputs before the position that they belong to
            data = mapped.data(node.drive)
            now_s = time.monotonic()
            again = mapped.again_s and now_s - mapped.sent_s >= mapped.again_s
            if mapped.transmission <= 240 or data != mapped.sent or again:
                mapped.sent, mapped.sent_s = data, now_s
                self._send(node, mapped.cob_id, data)

    def _tell_fault(self, node: EmulatedNode) -> None:
        code = node.drive.machine.error_code
        if code != node.told_fault:
            node.told_fault = code
            self._emergency(node, code)

    def _emergency(self, node: EmulatedNode, code: int) -> None:
        self._send(node, 0x80 + node.id, code.to_bytes(2, "little") + bytes((1 if code else 0, 0, 0, 0, 0, 0)))

    # --- time ---

    def _tick(self, now_s: float) -> None:
        for node in self.nodes.values():
            if node.off:
                continue
            if node.heartbeat_s and now_s - node.beat_s >= node.heartbeat_s:
                node.beat_s = now_s
                self._send(node, 0x700 + node.id, bytes((node.state,)))
            if node.clock_is_sync:
                continue
            drive = node.drive
            if node.watched and node.master_heard_s and now_s - node.master_heard_s > node.watched[1]:
                node.master_heard_s = None
                if drive.machine.state in (State.SWITCHED_ON, State.OPERATION_ENABLED):
                    drive.fault(HEARTBEAT_LOST)
            if node.sync_s is not None and now_s - node.sync_s > max(self.silence_s, 5 * drive.period_s):
                if drive.machine.state is State.OPERATION_ENABLED:
                    drive.fault(SYNC_LOST)
                node.lived_s = max(node.lived_s, now_s - MOST_MADE_UP_S)
                while now_s - node.lived_s > drive.period_s:
                    node.lived_s += drive.period_s
                    drive.step()

    # --- commands ---

    def cut(self, node: EmulatedNode, out: bool) -> None:
        node.cut = out

    def power(self, node: EmulatedNode, on: bool) -> None:
        was, node.off = node.off, not on
        if was and on:
            self._boot(node)


def emulated_link(bus: str) -> Any:
    """Returns a link whose network passes all messages to the emulated nodes, except to those behind a broken cable."""
    base: Any = packages()[1].Network

    class Network(base):  # type: ignore[misc]
        emulation: Emulation | None = None

        def notify(self, can_id: int, data: bytearray, timestamp: float) -> None:
            emulation = self.emulation
            if emulation is None or not emulation.route(can_id):
                return
            for callback in self.subscribers.get(can_id, ()):
                callback(can_id, data, timestamp)
            emulation.heard(can_id, bytes(data))

        def send_periodic(self, *_: Any, **__: Any) -> Any:  # heartbeats: `_tick` sends them
            class Nothing:
                def stop(self) -> None: ...
                def update(self, data: object) -> None: ...

            return Nothing()

    class Link(CanLink):
        @property
        def emulation(self) -> Emulation | None:
            found: Emulation | None = self.network.emulation
            return found

        @emulation.setter
        def emulation(self, value: Emulation) -> None:
            self.network.emulation = value

    return Link(parse(bus), network=Network())


def emulated_nodes(described: Mapping[str, Any], machine: Mapping[str, Any], text: bytes, file: str) -> list[Any]:
    """Returns the drives of one bus of a machine file, with the servos that the engine would simulate for their
    axes."""
    axes = {axis["name"]: axis for axis in machine["axes"]}
    nodes = []
    for one in described["drives"]:
        axis = axes[one["axis"]]
        scaling = scaling_of(one, axis, rated_torque=one.get("rated_torque") or 1.0)
        drive = EmulatedDrive(text, file, one["axis"], scaling, dict(one["inputs"]))
        drive.period_s = float(machine["cycle"]["period_s"])
        nodes.append(EmulatedNode(one["node"], drive))
    return nodes


def bus_of(machine: Mapping[str, Any], file: str, bus: str | None) -> list[Mapping[str, Any]]:
    """Returns the buses of a machine file, or only the one of this name. Raises TaktError if there is none."""
    buses: list[Mapping[str, Any]] = machine["external"].get("buses") or []
    if not buses:
        raise TaktError(f"{file}: has no field buses (external: buses: - bus: canopen:CHANNEL)")
    chosen = [one for one in buses if bus is None or one["bus"] == bus]
    if not chosen:
        raise TaktError(f"{file}: external.buses has no {bus}; it has {', '.join(one['bus'] for one in buses)}")
    return chosen
