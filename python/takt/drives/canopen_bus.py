"""Drives of CiA 402 on a CANopen bus, for an engine: start-up, process data in step with SYNC, loss and return of
nodes.

A cycle: one message to each drive with its control word and set point, then SYNC, at which the drives apply these and
send the actual values of that moment.
"""

from __future__ import annotations

import contextlib
import math
import struct
import threading
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, Final

from takt import drive
from takt.counted import counted
from takt.drives import objects as od
from takt.drives.axis import AXIS_MODES, DriveAxis, Heard, Words, set_point_mode
from takt.drives.can_link import (
    EMERGENCY,
    HEARTBEAT,
    NMT_COMMAND,
    NMT_STATES,
    PRE_OPERATIONAL,
    RPDO1,
    RPDO2,
    START,
    SYNC,
    TPDO1,
    TPDO2,
    TPDO3,
    TPDO4,
    CanLink,
    Sdo,
    frame_bits,
    parse,
)
from takt.drives.cia402 import MODE_NAMES, Mode
from takt.drives.emulation_commands import CLOCK
from takt.drives.error_texts import error_text
from takt.drives.field_bus import ANSWERS_WITHIN, FieldBus, extras_of, lacks
from takt.drives.homing import homing_objects
from takt.drives.probe import ProbeLatch, latches
from takt.drives.scaling import scaling_of
from takt.drives.sdo import SdoError
from takt.errors import TaktError

OPERATIONAL: Final = 5
HEARTBEATS_MISSING: Final = 3
LISTENED_S: Final = 0.1  # time to listen for another master, which sends SYNC in each of its cycles
AGAIN_S: Final = 1.0  # from a failed set-up to the next one
STARTS_WITHIN_S: Final = 0.5  # until a node reports that it is operational
INPUTS_AGAIN_MS: Final = 100  # inputs are sent on change, and repeated at this interval, as a message may be lost
BUSY: Final = 0.8  # share of the bit rate
NOT_MAPPED: Final = 1 << 31

_TAKEN: Final = struct.Struct("<HiH")  # RPDO1: control word, target, max torque
_MEASURED: Final = struct.Struct("<Hih")  # TPDO1: status word, position, torque
_MORE: Final = struct.Struct("<IH")  # TPDO2: digital inputs, error code, and with homing the mode
_LATCHED: Final = struct.Struct("<Hi")  # TPDO3, TPDO4: touch probe status, position at a rising, falling edge


class _Node:
    """One drive, and its present state."""

    def __init__(self, described: Mapping[str, Any], axis: Mapping[str, Any]) -> None:
        self.described, self.axis_described = described, axis
        self.id: int = described["node"]
        self.axis: str = described["axis"]
        self.mode = AXIS_MODES[axis["drive"]["mode"]]
        self.drive: DriveAxis | None = None
        self.emulated = False
        self.torque = False  # it supports cst
        self.rare: Sequence[od.Object] = ()  # objects of RPDO2, which is sent when they change
        self.sent_rare = b""
        self.mode_display = 0
        number = described["probe_latch"]
        self.latch = ProbeLatch(number) if number else None  # reads the status
        self.stored: list[int | None] = [0, 0]  # at a rising and at a falling edge; not None until the first message
        self.fresh = False  # TPDO1 was received since the last SYNC
        self.data = (0, 0, 0)
        self.inputs = 0
        self.heard_s = 0.0
        self.operational = False
        self.started_s = 0.0
        self.lost = False
        self.setting_up: threading.Thread | None = None
        self.again_s = math.inf  # time of the next set-up

    @property
    def called(self) -> str:
        return f"node {self.id}"

    @property
    def named(self) -> str:
        return f"{self.axis}: node {self.id}"


class CanopenBus(FieldBus):
    """The drives of one bus of a machine file.

    Raises TaktError if the bus does not match the machine file."""

    rhythm = "SYNC"

    def __init__(
        self,
        described: Mapping[str, Any],
        machine: Mapping[str, Any],
        say: Callable[[str], None],
        *,
        link: CanLink | None = None,
    ) -> None:
        super().__init__(described, machine, say)
        axes = {axis["name"]: axis for axis in machine["axes"]}
        self._nodes = [_Node(one, axes[one["axis"]]) for one in described["drives"]]
        self.axes: Sequence[str] = [node.axis for node in self._nodes]
        self._by_axis = {node.axis: node for node in self._nodes}
        self._heartbeat_s = float(described["heartbeat_s"])
        self._own_beat_s = 0.0
        self._listened = False
        name = parse(described["bus"])
        self._check_load(name.has_wire)
        self._link = link or CanLink(name, described.get("bitrate"))
        self._sdos: dict[int, Sdo] = {}
        try:
            self._start_up()
        except BaseException:
            self._link.close()
            raise

    @property
    def members(self) -> Sequence[_Node]:
        return self._nodes

    # --- before motion ---

    def load(self, bitrate: int) -> float:
        """Returns the largest share of the bit rate [bit/s] that the messages of a cycle use."""
        bits = frame_bits(0) + len(self._nodes) * (frame_bits(_TAKEN.size) + frame_bits(_MEASURED.size))
        return bits / bitrate / self.period_s

    def _check_load(self, has_wire: bool) -> None:
        bitrate = self.described.get("bitrate")
        if not has_wire or not bitrate:
            return
        load = self.load(bitrate)
        said = (
            f"{self.bus_name}: {counted(len(self._nodes), 'drive')} every {1000 * self.period_s:g} ms take "
            f"{100 * load:.0f} % of {bitrate} bit/s"
        )
        if load > 1:
            need_s = load * self.period_s / BUSY
            raise TaktError(f"{said}; expected 100 % at the most: cycle: {{period_s: {need_s:.4f}}} or a faster bus")
        if load > BUSY:
            self._say(f"{said}, which leaves little for anything else")

    def _start_up(self) -> None:
        link = self._link
        for node in self._nodes:
            self._subscribe(node)
            self._sdos[node.id] = Sdo(link, node.id)
        with link.background():
            self._listen()
            self._listened = True
            self._find()
            for node in self._nodes:
                self._set_up(node, self._sdos[node.id].patience(0.5))
        for node in self._nodes:
            self._start_node(node)

    def _listen(self) -> None:
        """Detects another master. Raises TaktError at the start; later it is only reported."""
        own = int(self.described["node"])
        heard: list[str] = []
        network = self._link.network
        network.subscribe(SYNC, lambda _id, _data, _s: self._on_master(heard, "sends SYNC, too"))
        network.subscribe(HEARTBEAT + own, lambda _id, _data, _s: self._on_master(heard, f"has node {own} of this end"))
        time.sleep(LISTENED_S)
        if heard:
            raise TaktError(
                f"{self.bus_name}: another master is active: another node {heard[0]} (another takt drives run, or a "
                f"drive that is set up to send SYNC, 0x1005); two on one bus disturb each other"
            )

    def _on_master(self, heard: list[str], does: str) -> None:
        if does in heard:
            return
        heard.append(does)
        if self._listened:
            self._say(
                f"{self.bus_name}: another master is active: another node {does}; two on one bus disturb each other"
            )

    def _subscribe(self, node: _Node) -> None:
        network = self._link.network
        network.subscribe(TPDO1 + node.id, lambda _id, data, _s: self._on_measured(node, data))
        network.subscribe(TPDO2 + node.id, lambda _id, data, _s: self._on_more(node, data))
        if node.latch is not None:
            network.subscribe(TPDO3 + node.id, lambda _id, data, _s: self._on_latched(node, 0, data))
            network.subscribe(TPDO4 + node.id, lambda _id, data, _s: self._on_latched(node, 1, data))
        network.subscribe(EMERGENCY + node.id, lambda _id, data, _s: self._on_emergency(node, data))
        network.subscribe(HEARTBEAT + node.id, lambda _id, data, _s: self._on_heartbeat(node, data))

    def _find(self) -> None:
        """Waits for every drive, each for its own time. Raises TaktError if one does not answer; then no drive
        moves."""
        begin_s = time.monotonic()
        missing = list(self._nodes)
        while missing:
            missing = [node for node in missing if not self._answers(node)]
            waited_s = time.monotonic() - begin_s
            late = [node for node in missing if waited_s > node.described["ready_within_s"]]
            if late:
                raise TaktError(self._not_there(late))

    def _answers(self, node: _Node) -> bool:
        try:
            self._sdos[node.id].patience(0.1).read(0x1000)
        except SdoError as error:
            return error.code is not None
        return True

    def _not_there(self, missing: Sequence[_Node]) -> str:
        there = nodes_on(self._link, 0.3)
        named = ", ".join(f"{node.id} (axis {node.axis})" for node in missing)
        seen = ", ".join(map(str, there)) or "none"
        many = len(missing) > 1
        return (
            f"{self.bus_name}: node{'s' * many} {named} {'do' if many else 'does'} not answer; nodes that do: {seen} "
            f"(check supply, address, bit rate and termination)"
        )

    def _set_up(self, node: _Node, sdo: Sdo) -> None:
        """Writes all settings of a drive before it becomes operational. Raises TaktError."""
        try:
            self._check(node, sdo)
            self._write_objects(node, sdo)
            self._map(node, sdo)
            inputs, code = sdo.find(od.DIGITAL_INPUTS.index), sdo.find(od.ERROR_CODE.index)
            node.inputs = inputs or 0
            node.data = (sdo.read(od.STATUS_WORD.index), sdo.read(od.POSITION.index, signed=True), 0)
        except SdoError as error:
            raise TaktError(f"{self.bus_name}: {node.named}: {error}") from None
        if node.drive is not None:
            node.drive.error_code = code or 0
            self._measured(node)

    def _check(self, node: _Node, sdo: Sdo) -> None:
        device = sdo.read(0x1000)
        if device & 0xFFFF != 402:
            raise TaktError(
                f"{self.bus_name}: {node.named} is no drive of CiA 402: its device type (0x1000) is 0x{device:08X}, "
                f"expected 0x....0192"
            )
        for key, subindex, name in (("vendor", 1, "vendor"), ("product", 2, "product code")):
            wanted = node.described.get(key)
            found = None if wanted is None else sdo.read(0x1018, subindex)
            if wanted is not None and found != int(wanted, 16):
                raise TaktError(f"{self.bus_name}: {node.named}: expected {name} {wanted}, found 0x{found:X}")
        supported = sdo.find(od.SUPPORTED_MODES.index)
        modes = frozenset(m for m in Mode if m and (supported is None or supported >> (m - 1) & 1))
        if node.mode not in modes:
            has = ", ".join(MODE_NAMES[m] for m in sorted(modes)) or "none"
            raise TaktError(
                f"{self.bus_name}: {node.named} does not have the mode {MODE_NAMES[node.mode]}, which drive: mode of "
                f"its axis asks for; it has {has}"
            )
        lacking = lacks(node.described, sdo, modes)
        if lacking:
            raise TaktError(f"{self.bus_name}: {node.named} {lacking}")
        node.torque = Mode.CYCLIC_TORQUE in modes
        rare = [od.MODE] if node.torque or node.described.get("homing") else []
        rare += [od.TARGET_TORQUE] if node.torque else []
        node.rare = rare + ([od.PROBE_FUNCTION] if node.latch else [])
        node.emulated = sdo.find(*CLOCK) is not None
        rated = sdo.find(od.RATED_TORQUE.index)
        scaling = scaling_of(node.described, node.axis_described, (rated or 1000) / 1000)
        usable = frozenset({node.mode} | ({Mode.CYCLIC_TORQUE} if node.torque else set()))
        if node.drive is None:
            more = extras_of(node.described, node.axis_described, scaling, self.period_s)
            node.drive = DriveAxis(node.axis, node.called, scaling, node.described["inputs"], usable, self._say, **more)
        else:
            node.drive.restarted()

    def _write_objects(self, node: _Node, sdo: Sdo) -> None:
        self._link.send(NMT_COMMAND, bytes((PRE_OPERATIONAL, node.id)))
        for one in node.described["start_up"]:
            index, subindex = (int(text, 0) for text in one["object"].split(":"))
            sdo.write(index, subindex, one["value"], one["bits"])
        if node.described.get("homing") and node.drive is not None:
            scaling = node.drive.scaling
            for written in homing_objects(node.described["homing"], node.axis_described, scaling):
                sdo.write(*written)
        sdo.write(od.MODE.index, 0, node.mode, 8)
        beat_ms = max(1, round(1000 * self._heartbeat_s))
        sdo.write(0x1017, 0, beat_ms, 16)
        watch = int(self.described["node"]) << 16 | HEARTBEATS_MISSING * beat_ms
        if not sdo.try_to_write(0x1016, 1, watch, 32):
            self._say(f"{node.named} cannot watch for the end of this process (0x1016:1): it would go on by itself")
        sdo.try_to_write(0x1006, 0, round(1e6 * self.period_s), 32)
        self._tell_interpolation_period(node, sdo)

    def _map(self, node: _Node, sdo: Sdo) -> None:
        target = od.TARGET_POSITION if node.mode is Mode.CYCLIC_POSITION else od.TARGET_VELOCITY
        _map_one(sdo, 0x1400, RPDO1 + node.id, 1, (od.CONTROL_WORD, target, od.MAX_TORQUE))
        if node.rare:
            # At SYNC, too: the mode must not change before its set point.
            _map_one(sdo, 0x1401, RPDO2 + node.id, 1, node.rare)
        _map_one(sdo, 0x1800, TPDO1 + node.id, 1, (od.STATUS_WORD, od.POSITION, od.TORQUE))
        mode = [od.MODE_DISPLAY] if node.described.get("homing") else []
        _map_one(sdo, 0x1801, TPDO2 + node.id, 255, (od.DIGITAL_INPUTS, od.ERROR_CODE, *mode))
        sdo.try_to_write(0x1801, 5, INPUTS_AGAIN_MS, 16)
        others = [(0x1402, 0x400), (0x1403, 0x500), (0x1802, TPDO3), (0x1803, TPDO4)]
        if node.latch is not None:
            for (index, first), latched in zip(others[2:], latches(node.described["probe_latch"]), strict=True):
                _map_one(sdo, index, first + node.id, 255, (od.PROBE_STATUS, latched))
                sdo.try_to_write(index, 5, INPUTS_AGAIN_MS, 16)
            del others[2:]
        for index, first in others:
            with contextlib.suppress(SdoError):  # most drives have no more
                if not sdo.read(index, 1) & NOT_MAPPED:
                    sdo.write(index, 1, NOT_MAPPED | first + node.id, 32)

    def _start_node(self, node: _Node) -> None:
        node.sent_rare, node.mode_display, node.stored = b"", 0, [0, 0]
        node.operational, node.lost = True, False
        node.heard_s = node.started_s = time.monotonic()
        self._link.send(NMT_COMMAND, bytes((START, node.id)))

    # --- received messages ---

    def _on_measured(self, node: _Node, data: bytes) -> None:
        if len(data) >= _MEASURED.size:
            node.data = _MEASURED.unpack_from(data)
            node.fresh = True
            node.heard_s = time.monotonic()

    def _on_more(self, node: _Node, data: bytes) -> None:
        if len(data) >= _MORE.size:
            node.inputs, code = _MORE.unpack_from(data)
            if len(data) > _MORE.size:
                node.mode_display = od.MODE_DISPLAY.decode(data[_MORE.size :])
            if code and node.drive is not None:
                node.drive.error_code = code

    def _on_latched(self, node: _Node, edge: int, data: bytes) -> None:
        if node.latch is not None and len(data) >= _LATCHED.size:
            status, position = _LATCHED.unpack_from(data)
            node.stored[edge] = node.latch.stored(status, position, position)[edge]

    def _on_emergency(self, node: _Node, data: bytes) -> None:
        code = int.from_bytes(data[:2], "little")
        if code and node.drive is not None:
            node.drive.error_code = code
            if not node.drive.faulty and not node.operational:
                self._say(f"{node.named}: {error_text(code)}")

    def _on_heartbeat(self, node: _Node, data: bytes) -> None:
        node.heard_s = time.monotonic()
        state = data[0] & 0x7F
        settled = state == 0 or node.heard_s - node.started_s > STARTS_WITHIN_S
        if state != OPERATIONAL and node.operational and node.setting_up is None and settled:
            self._say(f"{node.named} is {NMT_STATES.get(state, state)}: it is set up again")
            self._again(node)
        elif node.lost and state == OPERATIONAL:
            node.lost = False
            self._say(f"{node.named} is heard again")

    def _again(self, node: _Node) -> None:
        """Sets up a restarted drive in a thread beside the cycle; after a failure it is repeated once AGAIN_S has
        passed."""
        node.operational = node.fresh = False
        node.again_s = math.inf

        def set_up() -> None:
            try:
                self._set_up(node, self._sdos[node.id].patience(1.0))
                self._start_node(node)
                self._say(f"{node.named} is set up again")
            except TaktError as error:
                self._say_once(f"{error}: tried again")
                node.again_s = time.monotonic() + AGAIN_S
            finally:
                node.setting_up = None

        node.setting_up = threading.Thread(target=set_up, daemon=True)
        node.setting_up.start()

    def _try_again(self, now_s: float) -> None:
        for node in self._nodes:
            if now_s >= node.again_s and node.setting_up is None:
                self._again(node)

    def _watch(self, now_s: float) -> None:
        """Sends the own heartbeat and supervises those of the drives; in real time."""
        if now_s - self._own_beat_s >= self._heartbeat_s:
            self._own_beat_s = now_s
            self._link.send(HEARTBEAT + int(self.described["node"]), bytes((OPERATIONAL,)))
        for node in self._nodes:
            silent_s = now_s - node.heard_s
            if silent_s > HEARTBEATS_MISSING * self._heartbeat_s and not node.lost and node.setting_up is None:
                node.lost = True
                self._say(
                    f"{node.named} is not heard any more on {self.bus_name} (nothing for {silent_s:.2f} s): "
                    f"cable, supply, or the node itself"
                )

    # --- cycles ---

    def _tell_clock(self, simulated: bool) -> None:
        with self._link.background():
            for node in self._nodes:
                if (setting_up := node.setting_up) is not None:  # it ends by itself
                    setting_up.join()
                if node.emulated:
                    self._tell_clock_of(node, self._sdos[node.id].patience(1.0), simulated)

    def exchange(self, told: Mapping[str, drive.SetPoint], *, real_time: bool) -> Mapping[str, drive.Measured | None]:
        self._link.drain()
        begin_s = time.monotonic()
        self._try_again(begin_s)
        if real_time:
            self._watch(begin_s)
        for axis, point in told.items():
            node = self._by_axis[axis]
            if node.operational and node.drive is not None:
                now_s = begin_s if real_time else self.cycles * self.period_s
                self._send(node, node.drive.words(point, now_s))
        asked = [node for node in self._nodes if node.operational]
        sync_s = self._sync(asked)
        self._take_in(asked, begin_s + self._answers_within_s(real_time))
        end_s = time.monotonic()
        self.cycles += 1
        if real_time:
            self.sent_s.append(sync_s)
            self.round_trips_s.append(end_s - begin_s)
        self.late += sum(not node.fresh for node in asked)
        return {node.axis: self._measured(node) if node.fresh else None for node in self._nodes}

    def idle(self, stop: Collection[str]) -> None:
        self._link.drain()
        now_s = time.monotonic()
        self._try_again(now_s)
        self._watch(now_s)
        off = drive.SetPoint()
        for node in self._nodes:
            if node.operational and node.drive is not None:
                off_in_its_mode = drive.SetPoint(mode=set_point_mode(node.mode))
                self._send(node, node.drive.words(off_in_its_mode, now_s, stop=node.axis in stop))
        asked = [node for node in self._nodes if node.operational]
        self._sync(asked)
        self._take_in(asked, now_s + max(0.002, ANSWERS_WITHIN * off.period_s))
        for node in asked:
            if node.fresh:
                self._measured(node)

    def _send(self, node: _Node, words: Words) -> None:
        target = words.velocity if node.mode is Mode.CYCLIC_VELOCITY else words.position
        self._link.send(RPDO1 + node.id, _TAKEN.pack(words.control, target, words.torque_limit))
        values = {od.MODE: words.mode or node.mode, od.TARGET_TORQUE: words.torque, od.PROBE_FUNCTION: words.probe}
        rare = b"".join(entry.encode(values[entry]) for entry in node.rare)
        if rare != node.sent_rare:
            node.sent_rare = rare
            self._link.send(RPDO2 + node.id, rare)

    def _sync(self, asked: Sequence[_Node]) -> float:
        for node in asked:
            node.fresh = False
        self._link.send(SYNC, b"")
        return time.monotonic()

    def _take_in(self, asked: Sequence[_Node], until_s: float) -> None:
        while not all(node.fresh for node in asked):
            left_s = until_s - time.monotonic()
            if left_s <= 0:
                return
            self._link.pump(left_s)

    def _measured(self, node: _Node) -> drive.Measured | None:
        if node.drive is None:
            return None
        latched = (node.stored[0], node.stored[1])
        heard = Heard(*node.data, node.inputs, node.mode_display, latched)
        return node.drive.measured(heard, time.monotonic())

    # --- the end ---

    def close(self, within_s: float = 2.0) -> None:
        """Brakes moving drives along their quick stop ramps, switches off, and leaves the bus."""
        end_s = time.monotonic() + within_s
        with contextlib.suppress(TaktError):
            if not self._simulated:
                while time.monotonic() < end_s and any(
                    node.operational and not node.lost and node.drive is not None and node.drive.energised
                    for node in self._nodes
                ):
                    self.idle(self.axes)
                    time.sleep(self.period_s)
            for node in self._nodes:
                self._link.send(NMT_COMMAND, bytes((PRE_OPERATIONAL, node.id)))
        self._link.close()


def _map_one(sdo: Sdo, index: int, cob_id: int, transmission: int, entries: Sequence[od.Object]) -> None:
    """Maps these objects into a message: disabled, mapped, and enabled again, as CiA 301 requires."""
    mapping = index + 0x200
    sdo.write(index, 1, NOT_MAPPED | cob_id, 32)
    sdo.write(index, 2, transmission, 8)
    sdo.write(mapping, 0, 0, 8)
    for number, entry in enumerate(entries, start=1):
        sdo.write(mapping, number, entry.mapping, 32)
    sdo.write(mapping, 0, len(entries), 8)
    sdo.write(index, 1, cob_id, 32)


def nodes_on(link: CanLink, wait_s: float = 0.5) -> list[int]:
    """Returns the nodes that answer a request for their device type within about `wait_s`. Messages must be received
    meanwhile."""
    found: set[int] = set()
    for node in range(1, 128):
        link.network.subscribe(0x580 + node, lambda can_id, _data, _s: found.add(can_id - 0x580))
    for node in range(1, 128):
        link.send(0x600 + node, bytes((0x40, 0x00, 0x10, 0, 0, 0, 0, 0)))
        if node % 16 == 0:
            time.sleep(0.005)  # interfaces have short queues
    time.sleep(wait_s)
    return sorted(found)
