"""Drives of CiA 402 on EtherCAT, for an engine: start-up, process data in one frame a cycle, loss and return of slaves.

A cycle: one frame carries control words and set points to all drives and returns their previous actual values. Its
working counter shows whether all took part. A thread beside the cycle reads the state of missing slaves and brings
returning ones into operation, in steps short enough for the cycle of the others.
"""

from __future__ import annotations

import contextlib
import struct
import threading
import time
import warnings
from collections import deque
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, Final

from takt import drive
from takt.counted import counted
from takt.drives import objects as od
from takt.drives.axis import AXIS_MODES, DriveAxis, Heard, Words, set_point_mode
from takt.drives.cia402 import MODE_NAMES, Mode
from takt.drives.emulation_commands import CLOCK
from takt.drives.ethercat_link import (
    ERROR_BIT,
    INIT,
    OPERATIONAL,
    PRE_OPERATIONAL,
    SAFE_OPERATIONAL,
    STATION_ADDRESS,
    Sdo,
    Wire,
    state_text,
)
from takt.drives.field_bus import ANSWERS_WITHIN, FieldBus, extras_of, lacks
from takt.drives.homing import homing_objects
from takt.drives.phase import Phase
from takt.drives.probe import ProbeLatch, latches
from takt.drives.scaling import scaling_of
from takt.drives.sdo import SdoError
from takt.errors import TaktError

SIGNS_MISSING: Final = 3  # times heartbeat_s: the watchdog of a slave's outputs
OPERATIONAL_WITHIN_S: Final = 5.0
STATE_WITHIN_S: Final = 2.0
CLOCK_WITHIN_S: Final = 5.0  # emulated slaves may share a busy host
REGISTERS_US: Final = 3000  # longest round trip of a frame that accesses a register
LOOK_AGAIN_S: Final = 0.05  # interval of checks of slaves that are not in operation
RING_CYCLES: Final = 20  # cycles with a broken ring before it is reported
FIRST_SILENT: Final = 3  # cycles without a frame at the first end of a broken ring, before its timeout is reduced ...
FIRST_SHARE: Final = 0.4  # ... as the package reads the second end only after that
LATE_CYCLES: Final = 50  # after a lost frame, in which it may still arrive
SILENT: Final = 20  # frames lost in a row: the wire itself is interrupted
RX_MAP, TX_MAP, RX_ASSIGNED, TX_ASSIGNED = 0x1600, 0x1A00, 0x1C12, 0x1C13
AL_CONTROL, AL_STATUS = 0x0120, 0x0130
# Registers (address, bytes) that are written again when a slave returns.
FMMUS, MAILBOX_MANAGERS, DATA_MANAGERS = (0x0600, 64), (0x0800, 16), (0x0810, 16)

# Mapped objects, the last ones only if the drive has them. Objects of 8 bits last: some drives require even addresses.
OUTPUTS: Final = (od.CONTROL_WORD, None, od.TARGET_TORQUE, od.MAX_TORQUE, od.MODE)  # None: the target of the mode
INPUTS: Final = (od.STATUS_WORD, od.POSITION, od.TORQUE, od.DIGITAL_INPUTS, od.ERROR_CODE)


class _Layout:
    """The byte offsets of objects in process data."""

    def __init__(self, words: Sequence[int]) -> None:
        self.words = list(words)
        self.at: dict[int, tuple[int, od.Object]] = {}
        bits = 0
        for word in words:
            entry = od.OBJECTS.get(word >> 16)
            if entry is not None and entry.mapping == word and bits % 8 == 0:
                self.at.setdefault(entry.index, (bits // 8, entry))
            bits += word & 0xFF
        self.size = (bits + 7) // 8

    def has(self, entry: od.Object) -> bool:
        return entry.index in self.at

    def put(self, data: bytearray, entry: od.Object, value: int) -> None:
        found = self.at.get(entry.index)
        if found is not None:
            data[found[0] : found[0] + entry.bits // 8] = entry.encode(value)

    def get(self, data: bytes, entry: od.Object) -> int:
        """Returns the value of an object; 0 if it is not mapped."""
        found = self.at.get(entry.index)
        return 0 if found is None else entry.decode(data[found[0] :])

    def text(self) -> str:
        return " ".join(f"0x{word >> 16:04X}:{word >> 8 & 0xFF}" for word in self.words) or "nothing"


class _Slave:
    """One drive, and its present state."""

    def __init__(self, described: Mapping[str, Any], axis: Mapping[str, Any]) -> None:
        self.described, self.axis_described = described, axis
        self.axis: str = described["axis"]
        self.mode = AXIS_MODES[axis["drive"]["mode"]]
        self.position = 0  # from 1
        self.slave: Any = None
        self.sdo: Sdo
        self.drive: DriveAxis | None = None
        self.emulated = False
        self.outputs = self.inputs = _Layout(())
        self.state = 0  # last known AL state; 0: not there
        number = described["probe_latch"]
        self.latch = ProbeLatch(number) if number else None  # reads the status
        self.registers: dict[int, bytes] = {}
        self.told_lost = False

    @property
    def called(self) -> str:
        return f"slave {self.position}"

    @property
    def named(self) -> str:
        return f"{self.axis}: slave {self.position}"

    @property
    def operational(self) -> bool:
        return self.state == OPERATIONAL


class EthercatBus(FieldBus):
    """The drives of one bus of a machine file.

    Raises TaktError if the bus does not match the machine file."""

    rhythm = "frames"

    def __init__(self, described: Mapping[str, Any], machine: Mapping[str, Any], say: Callable[[str], None]) -> None:
        super().__init__(described, machine, say)
        axes = {axis["name"]: axis for axis in machine["axes"]}
        self._slaves = [_Slave(one, axes[one["axis"]]) for one in described["drives"]]
        self.axes: Sequence[str] = [one.axis for one in self._slaves]
        self._by_axis = {one.axis: one for one in self._slaves}
        self.lost_frames = 0
        self._lost_in_a_row = 0
        self._late_frames = 0  # cycles in which lost frames may still arrive
        self._counter = 0  # of the last frame
        self._others_count = 0  # largest contribution of slaves without an axis
        self._phase = Phase(self.period_s)
        self._clocks: deque[tuple[float, float]] = deque(maxlen=200_000)  # s: of this host, and of the slaves
        self._told_silent = False
        self._look = threading.Event()
        self._ended = False
        self._watcher: threading.Thread | None = None
        self._others: list[Any] = []  # slaves without an axis
        self._ring_broken = 0  # cycles; RING_CYCLES: it was reported
        self._first_silent = 0  # cycles without a frame at the first end of the ring
        self._wire = Wire(described["bus"], described.get("ring"))
        try:
            self._start_up()
        except BaseException:
            self._wire.close()
            raise
        self._watcher = threading.Thread(target=self._watch, daemon=True)
        self._watcher.start()

    @property
    def members(self) -> Sequence[_Slave]:
        return self._slaves

    # --- before motion ---

    def _start_up(self) -> None:
        for tries_left in (2, 1, 0):
            self._find()
            for one in self._slaves:
                self._set_up(one)
            try:
                self._map()
                break
            except TaktError:  # the package treats objects whose answers were lost as missing
                if not tries_left:
                    raise
        self._operate()
        for one in self._slaves:  # no patience from now on: cycles must not wait for a request
            one.sdo = self._wire.sdo(one.slave, one.position)

    def _find(self) -> None:
        """Waits until every drive is at its position. Raises TaktError if one is missing after the longest of their
        times; then no drive moves."""
        end_s = time.monotonic() + max(float(one["ready_within_s"]) for one in self.described["drives"])
        while True:
            found = self._wire.find()
            wrong = self._place(found)
            if not wrong:
                return
            if time.monotonic() > end_s:
                raise TaktError(f"{self.bus_name}: {wrong}")
            time.sleep(0.05)

    def _place(self, found: Sequence[Any]) -> str:
        """Assigns each axis its slave. Returns what is missing; "" if nothing is."""
        aliases: dict[int, int] = {}
        if any(one.described.get("alias") is not None for one in self._slaves):
            for position, slave in enumerate(found, start=1):
                aliases.setdefault(self._wire.alias(slave), position)
        missing = []
        for one in self._slaves:
            alias = one.described.get("alias")
            wanted = one.described.get("position") if alias is None else aliases.get(alias)
            place = f"position {wanted}" if alias is None else f"alias {alias}"
            if wanted is None or wanted > len(found):
                missing.append(f"{place} (axis {one.axis})")
                continue
            one.position, one.slave = wanted, found[wanted - 1]
            one.sdo = self._wire.sdo(one.slave, wanted).patience(float(one.described["ready_within_s"]))
        used = {one.position for one in self._slaves}
        self._others = [slave for position, slave in enumerate(found, start=1) if position not in used]
        if not missing:
            return ""
        there = ", ".join(f"{k}: {slave.name or 'no name'}" for k, slave in enumerate(found, start=1)) or "none"
        return (
            f"no slave at {', '.join(missing)}; slaves that are there: {there} (check supply, cables and their order)"
        )

    def _set_up(self, one: _Slave) -> None:
        """Writes all settings of a drive in PREOP. Raises TaktError."""
        try:
            self._check(one)
            for start in one.described["start_up"]:
                index, subindex = (int(text, 0) for text in start["object"].split(":"))
                one.sdo.write(index, subindex, start["value"], start["bits"])
            if one.described.get("homing") and one.drive is not None:
                for written in homing_objects(one.described["homing"], one.axis_described, one.drive.scaling):
                    one.sdo.write(*written)
            one.sdo.write(od.MODE.index, 0, one.mode, 8)
            self._tell_period(one)
            self._choose(one)
            code = one.sdo.find(od.ERROR_CODE.index)
        except SdoError as error:
            raise TaktError(f"{self.bus_name}: {one.named}: {error}") from None
        if one.drive is not None:
            one.drive.error_code = code or 0

    def _check(self, one: _Slave) -> None:
        for key, found, name in (
            ("vendor", one.slave.man, "vendor"),
            ("product", one.slave.id, "product code"),
        ):
            wanted = one.described.get(key)
            if wanted is not None and found != int(wanted, 16):
                raise TaktError(f"{self.bus_name}: {one.named}: expected {name} {wanted}, found 0x{found:X}")
        sdo = one.sdo
        device = sdo.read(0x1000)
        if device & 0xFFFF != 402:
            raise TaktError(
                f"{self.bus_name}: {one.named} is no drive of CiA 402: its device type (0x1000) is 0x{device:08X}, "
                f"expected 0x....0192"
            )
        supported = sdo.find(od.SUPPORTED_MODES.index)
        modes = frozenset(m for m in Mode if m and (supported is None or supported >> (m - 1) & 1))
        if one.mode not in modes:
            has = ", ".join(MODE_NAMES[m] for m in sorted(modes)) or "none"
            raise TaktError(
                f"{self.bus_name}: {one.named} does not have the mode {MODE_NAMES[one.mode]}, which drive: mode of "
                f"its axis asks for; it has {has}"
            )
        lacking = lacks(one.described, sdo, modes)
        if lacking:
            raise TaktError(f"{self.bus_name}: {one.named} {lacking}")
        one.emulated = sdo.find(*CLOCK) is not None
        rated = sdo.find(od.RATED_TORQUE.index)
        scaling = scaling_of(one.described, one.axis_described, (rated or 1000) / 1000)
        if one.drive is None:
            usable = frozenset({one.mode}) | (modes & {Mode.CYCLIC_TORQUE})
            more = extras_of(one.described, one.axis_described, scaling, self.period_s)
            one.drive = DriveAxis(one.axis, one.called, scaling, one.described["inputs"], usable, self._say, **more)
        else:
            one.drive.restarted()

    def _tell_period(self, one: _Slave) -> None:
        self._tell_interpolation_period(one, one.sdo)
        mode = 2 if self.described["dc"] else 1  # synchronous with SYNC0, or with the frames
        for index in (0x1C32, 0x1C33):
            one.sdo.try_to_write(index, 1, mode if index == 0x1C32 or mode == 2 else 0x22, 16)

    def _choose(self, one: _Slave) -> None:
        """Maps the required objects; a drive with a fixed mapping must already have them."""
        target = od.TARGET_POSITION if one.mode is Mode.CYCLIC_POSITION else od.TARGET_VELOCITY
        outputs = [target if entry is None else entry for entry in OUTPUTS]
        inputs = list(INPUTS)
        send, hear = [od.CONTROL_WORD, target], [od.STATUS_WORD, od.POSITION]
        if one.latch is not None:
            latched = (od.PROBE_STATUS, *latches(one.described["probe_latch"]))
            outputs.insert(-1, od.PROBE_FUNCTION)
            send.append(od.PROBE_FUNCTION)
            inputs += latched
            hear += latched
        if one.described.get("homing"):
            inputs.append(od.MODE_DISPLAY)
            send.append(od.MODE)
            hear.append(od.MODE_DISPLAY)
        one.outputs = self._map_one(one, RX_MAP, RX_ASSIGNED, outputs, send)
        one.inputs = self._map_one(one, TX_MAP, TX_ASSIGNED, inputs, hear)
        if one.drive is not None and not (one.outputs.has(od.MODE) and one.outputs.has(od.TARGET_TORQUE)):
            one.drive.modes = frozenset({one.mode})

    def _map_one(
        self, one: _Slave, index: int, assigned: int, wanted: Sequence[od.Object], needed: Sequence[od.Object]
    ) -> _Layout:
        sdo = one.sdo
        there = [entry for entry in wanted if entry in needed or sdo.find(entry.index) is not None]
        reason = ""
        try:
            sdo.write(assigned, 0, 0, 8)
            sdo.write(index, 0, 0, 8)
            for number, entry in enumerate(there, start=1):
                sdo.write(index, number, entry.mapping, 32)
            sdo.write(index, 0, len(there), 8)
            sdo.write(assigned, 1, index, 16)
            sdo.write(assigned, 0, 1, 8)
        except SdoError as error:
            if error.code is None:
                raise
            reason = str(error)
        words = []
        for k in range(1, sdo.read(assigned, 0) + 1):
            used = sdo.read(assigned, k)
            words += [sdo.read(used, n) for n in range(1, sdo.read(used, 0) + 1)]
        layout = _Layout(words)
        lacking = [entry for entry in needed if not layout.has(entry)]
        if lacking:
            names = ", ".join(f"0x{entry.index:04X} ({entry.name})" for entry in lacking)
            raise TaktError(
                f"{self.bus_name}: {one.named}: its process data are {layout.text()}; expected {names} among them"
                + (f"; they cannot be changed: {reason}" if reason else "")
            )
        return layout

    def _map(self) -> None:
        master, pysoem = self._wire.master, self._wire.pysoem
        try:
            master.config_map()
            if self.described["dc"]:
                self._synchronise()
        except pysoem.ConfigMapError as error:
            raise TaktError(f"{self.bus_name}: the process data cannot be mapped: {error}") from None
        for one in self._slaves:
            for name, has, layout in (("in", one.slave.input, one.inputs), ("out", one.slave.output, one.outputs)):
                if len(has) != layout.size:
                    raise TaktError(
                        f"{self.bus_name}: {one.named}: expected {counted(layout.size, 'byte')} of process data "
                        f"{name}, as mapped, found {len(has)}"
                    )
            self._set_watchdog(one)
            for at, length in ((STATION_ADDRESS, 2), FMMUS, MAILBOX_MANAGERS, DATA_MANAGERS, (0x0400, 2), (0x0420, 2)):
                one.registers[at] = self._asked(one, at, length)
        if master.state_check(SAFE_OPERATIONAL, round(1e6 * STATE_WITHIN_S)) != SAFE_OPERATIONAL:
            raise TaktError(self._not_in(SAFE_OPERATIONAL))

    def _set_watchdog(self, one: _Slave) -> None:
        """Sets the watchdog of the process data: time without frames until SAFEOP. Some slaves have none."""
        watchdog_ms = 1000 * SIGNS_MISSING * float(self.described["heartbeat_s"])
        for _ in range(5):
            with contextlib.suppress(Exception), warnings.catch_warnings():
                warnings.simplefilter("ignore")  # the package warns that it rounds to steps of 100 us
                one.slave.set_watchdog("processdata", watchdog_ms)
                return
        self._say(f"{one.named}: its watchdog cannot be set to {watchdog_ms / 1000:.4g} s")

    def _asked(self, one: _Slave, register: int, length: int) -> bytes:
        for _ in range(5):
            with contextlib.suppress(Exception):
                return bytes(one.slave._fprd(register, length, REGISTERS_US))
        raise TaktError(f"{self.bus_name}: {one.named}: register 0x{register:04X} cannot be read: no answer")

    def _synchronise(self) -> None:
        """Synchronises the clocks, and starts SYNC0 in every period."""
        if not self._wire.master.config_dc():
            raise TaktError(f"{self.bus_name}: dc: true, but no slave has a distributed clock")
        period_ns = round(1e9 * self.period_s)
        for one in self._slaves:
            one.slave.dc_sync(True, period_ns, period_ns // 2)

    def _not_in(self, state: int) -> str:
        self._wire.master.read_state()
        said = [
            f"{one.named} is in {state_text(one.slave.state)}, {self._reason(one)}"
            for one in self._slaves
            if one.slave.state != state
        ]
        return f"{self.bus_name}: expected all drives in {state_text(state)}: {'; '.join(said) or 'a slave is not'}"

    def _reason(self, one: _Slave) -> str:
        code = one.slave.al_status
        text = self._wire.pysoem.al_status_code_to_string(code)
        return f"AL status code 0x{code:04X} ({text})"

    def _operate(self) -> None:
        master = self._wire.master
        for one in self._slaves:
            one.slave.output = bytes(one.outputs.size)
        for slave in self._others:
            with contextlib.suppress(Exception):
                slave.output = bytes(len(slave.output))
        self._frame(0.01)
        master.state = OPERATIONAL
        master.write_state()
        end_s = time.monotonic() + OPERATIONAL_WITHIN_S
        while time.monotonic() < end_s:
            self._frame(0.01)
            master.read_state()
            if all(one.slave.state == OPERATIONAL for one in self._slaves):
                break
            time.sleep(0.001)
        else:
            raise TaktError(self._not_in(OPERATIONAL))
        for one in self._slaves:
            one.state = OPERATIONAL
        self._others_count = sum(3 if len(s.output) and len(s.input) else 0 for s in self._others)
        self._wire.hurry()
        for _ in range(50):
            if self._frame(0.02) and self._take_in():
                return
        raise TaktError(f"{self.bus_name}: the frames do not come back: {self.lost_frames} were lost")

    # --- frames ---

    def _frame(self, within_s: float) -> int:
        """Sends the outputs and receives the inputs. Returns the working counter; 0 if the frame was lost."""
        master = self._wire.master
        end_s = time.monotonic() + within_s
        if self._late_frames > 0:
            self._late_frames -= 1
            self._wire.discard_late_frames()
        master.send_processdata()
        if not self._wire.lock.locked():  # else the other thread may receive this frame
            self._wire.await_frame(within_s)
        counter = master.receive_processdata(max(50, round(1e6 * (end_s - time.monotonic()))))
        self._counter = max(0, counter)
        if counter < 0:
            self.lost_frames += 1
            self._lost_in_a_row += 1
            self._late_frames = LATE_CYCLES
            if self._lost_in_a_row == SILENT:
                self._look.set()
        else:
            self._lost_in_a_row = 0
            if self._told_silent or not counter:  # 0: it has come back, and no slave took part
                self._look.set()
        return self._counter

    def _expected(self) -> tuple[int, int]:
        """Returns the smallest and largest working counter for the present states of the drives. Drives that are not in
        operation may or may not accept outputs."""
        least = most = 0
        for one in self._slaves:
            if one.state == OPERATIONAL:
                least, most = least + 3, most + 3
            elif one.state & 0x0F == SAFE_OPERATIONAL:
                least, most = least + 1, most + 3
        return least, most + self._others_count

    def _take_in(self) -> dict[str, drive.Measured]:
        """Returns the actual values of the drives in operation, by axis; empty unless all of them have answered."""
        if not self._counter:
            return {}
        least, most = self._expected()
        fits = least <= self._counter <= most
        if not fits or least < self._full:
            self._look.set()
        if not fits:
            return {}
        now_s = time.monotonic()
        return {one.axis: self._measure(one, one.drive, now_s) for one in self._slaves if one.operational and one.drive}

    @property
    def _full(self) -> int:
        return 3 * len(self._slaves)

    def _measure(self, one: _Slave, axis: DriveAxis, now_s: float) -> drive.Measured:
        data, layout = one.slave.input, one.inputs
        axis.error_code = layout.get(data, od.ERROR_CODE) or axis.error_code
        heard = Heard(
            layout.get(data, od.STATUS_WORD),
            layout.get(data, od.POSITION),
            layout.get(data, od.TORQUE),
            layout.get(data, od.DIGITAL_INPUTS),
            layout.get(data, od.MODE_DISPLAY),
        )
        if one.latch is not None:
            rise, fall = (layout.get(data, entry) for entry in latches(one.described["probe_latch"]))
            heard.probe = one.latch.stored(layout.get(data, od.PROBE_STATUS), rise, fall)
        return axis.measured(heard, now_s)

    def _put(self, one: _Slave, words: Words) -> None:
        layout = one.outputs
        data = bytearray(layout.size)
        layout.put(data, od.CONTROL_WORD, words.control)
        layout.put(data, od.MODE, words.mode or one.mode)
        layout.put(data, od.TARGET_POSITION, words.position)
        layout.put(data, od.TARGET_VELOCITY, words.velocity)
        layout.put(data, od.TARGET_TORQUE, words.torque)
        layout.put(data, od.MAX_TORQUE, words.torque_limit)
        layout.put(data, od.PROBE_FUNCTION, words.probe)
        one.slave.output = bytes(data)

    # --- drives that are not in operation ---

    def _watch(self) -> None:
        """Runs beside the cycle: checks the drives if the working counter is not as expected."""
        while not self._ended:
            if not self._look.wait(0.2):
                continue
            self._look.clear()
            with self._wire.lock:
                try:
                    self._look_at_all()
                except Exception as error:  # any error of the package: tried again
                    self._say_once(f"{self.bus_name}: {' '.join(str(error).split()) or type(error).__name__}")
            time.sleep(LOOK_AGAIN_S)

    def _look_at_all(self) -> None:
        if self._lost_in_a_row >= SILENT:
            if not self._told_silent:
                self._told_silent = True
                self._say(f"{self.bus_name}: no frame comes back any more: cable, first slave, or the interface")
            return
        if self._told_silent:
            self._told_silent = False
            self._say(f"{self.bus_name}: frames come back again")
        for one in self._slaves:
            state = self._state_of(one)
            if state is not None and not self._ended:
                self._judge(one, state)

    def _state_of(self, one: _Slave) -> int | None:
        """Returns the AL state of a drive; 0 if it is not there, None if frames get lost."""
        for _ in range(4):
            begin_s = time.monotonic()
            try:
                return bytes(one.slave._fprd(AL_STATUS, 2, REGISTERS_US))[0] & 0x1F
            except self._wire.pysoem.WkcError:
                if time.monotonic() - begin_s < 0.9e-6 * REGISTERS_US:
                    return 0  # the frame has come back at once, and no slave took part
        return None

    def _judge(self, one: _Slave, state: int) -> None:
        if state == OPERATIONAL:
            return self._goes_on(one)
        fell = one.state == OPERATIONAL
        one.state = state
        with contextlib.suppress(Exception):
            one.slave.output = bytes(one.outputs.size)  # it must not move by itself when it is back
        if state == 0:
            if not one.told_lost:
                one.told_lost = True
                self._say(f"{one.named} is not heard any more on {self.bus_name}: cable, supply, or the slave itself")
            self._wire.give_address(one.position, one.registers[STATION_ADDRESS])
            time.sleep(0.001)
            state = self._state_of(one) or 0
            if state == 0:
                return
            if state == OPERATIONAL:  # it returned meanwhile in its former state
                return self._goes_on(one)
        elif fell:
            code = int.from_bytes(self._asked(one, 0x0134, 2), "little")
            text = self._wire.pysoem.al_status_code_to_string(code)
            self._say(f"{one.named} has left operation: {state_text(state)}, AL status code 0x{code:04X} ({text})")
        try:
            self._bring_back(one, state)
        except (TaktError, SdoError) as error:
            self._say_once(f"{error}: tried again")

    def _goes_on(self, one: _Slave) -> None:
        one.state = OPERATIONAL
        if one.told_lost:
            one.told_lost = False
            self._say(f"{one.named} is heard again")

    def _bring_back(self, one: _Slave, state: int) -> None:
        """Brings a drive back into operation. Raises TaktError."""
        again = state & 0x0F != SAFE_OPERATIONAL
        if again:
            self._to(one, INIT)
            self._write(one, MAILBOX_MANAGERS[0])
            self._to(one, PRE_OPERATIONAL)
            product = one.sdo.find(0x1018, 2)
            if product not in (None, one.slave.id):
                raise TaktError(
                    f"{self.bus_name}: {one.named}: expected product code 0x{one.slave.id:X} as before, found "
                    f"0x{product:X}"
                )
            self._set_up(one)
            for at in (DATA_MANAGERS[0], FMMUS[0], 0x0400, 0x0420):
                self._write(one, at)
            if self.described["dc"]:
                one.slave.dc_sync(True, round(1e9 * self.period_s), round(1e9 * self.period_s) // 2)
        self._to(one, SAFE_OPERATIONAL)
        if one.emulated and self._simulated:
            self._tell_clock_of(one, one.sdo, True)
        self._to(one, OPERATIONAL)
        one.told_lost = False
        one.state = OPERATIONAL
        self._say(f"{one.named} is {'set up again' if again else 'in operation again'}")

    def _write(self, one: _Slave, register: int) -> None:
        pysoem = self._wire.pysoem
        for _ in range(5):
            with contextlib.suppress(pysoem.WkcError):
                one.slave._fpwr(register, one.registers[register], REGISTERS_US)
                return
        raise TaktError(f"{self.bus_name}: {one.named}: register 0x{register:04X} cannot be written: no answer")

    def _to(self, one: _Slave, wanted: int) -> None:
        """Commands a state and waits for it, in short steps. Raises TaktError."""
        pysoem = self._wire.pysoem
        end_s = time.monotonic() + STATE_WITHIN_S
        while time.monotonic() < end_s:
            state = self._state_of(one)
            if state == wanted:
                return
            if state == 0:
                raise TaktError(f"{self.bus_name}: {one.named} is gone again")
            if state is not None:
                with contextlib.suppress(pysoem.WkcError):
                    acknowledge = ERROR_BIT if state & ERROR_BIT else 0
                    request = state & 0x0F if acknowledge and wanted == OPERATIONAL else wanted
                    one.slave._fpwr(AL_CONTROL, struct.pack("<H", request | acknowledge), REGISTERS_US)
            time.sleep(0.002)
        raise TaktError(f"{self.bus_name}: {one.named}: expected {state_text(wanted)}, found another state")

    # --- cycles ---

    def _tell_clock(self, simulated: bool) -> None:
        with self._wire.lock:
            for one in self._slaves:
                if one.emulated and one.operational:
                    self._tell_clock_of(one, one.sdo.patience(CLOCK_WITHIN_S), simulated)
            self._simulated = simulated  # the watcher, which waits for the lock, uses it

    def exchange(self, told: Mapping[str, drive.SetPoint], *, real_time: bool) -> Mapping[str, drive.Measured | None]:
        begin_s = time.monotonic()
        now_s = begin_s if real_time else self.cycles * self.period_s
        for axis, point in told.items():
            one = self._by_axis[axis]
            if one.operational and one.drive is not None:
                self._put(one, one.drive.words(point, now_s))
        within_s = self._answers_within_s(real_time)
        self._frame(within_s * FIRST_SHARE if self._first_silent >= FIRST_SILENT else within_s)
        self._look_at_ring(time.monotonic() - begin_s >= within_s)
        self.later_s = 0.0
        if real_time:
            self.sent_s.append(begin_s)
            if self.described["dc"] and self._counter:
                clock_ns = self._wire.master.dc_time
                self._clocks.append((begin_s, 1e-9 * clock_ns))
                self.later_s = self._phase.take(clock_ns)
            self.round_trips_s.append(time.monotonic() - begin_s)
        measured = self._take_in()
        self.cycles += 1
        self.late += sum(one.axis not in measured for one in self._slaves)
        return {one.axis: measured.get(one.axis) for one in self._slaves}

    def _look_at_ring(self, waited: bool) -> None:
        """Reports a broken ring. waited: the frame took all the time that it was given."""
        if self.described.get("ring") is None or not self._counter:
            return
        whole = self._wire.ring_is_whole()
        if whole and self._ring_broken >= RING_CYCLES:
            self._say(f"{self.bus_name}: the ring is whole again")
        self._ring_broken = 0 if whole else self._ring_broken + 1
        if whole:
            self._first_silent = 0
        elif waited:
            self._first_silent += 1
        if self._ring_broken == RING_CYCLES:
            self._say(
                f"{self.bus_name}: the ring is broken: a cable is out, or a slave without supply; the next break loses "
                f"drives"
            )

    def idle(self, stop: Collection[str]) -> None:
        now_s = time.monotonic()
        for one in self._slaves:
            if one.operational and one.drive is not None:
                off_in_its_mode = drive.SetPoint(mode=set_point_mode(one.mode))
                self._put(one, one.drive.words(off_in_its_mode, now_s, stop=one.axis in stop))
        self._frame(max(0.002, ANSWERS_WITHIN * self.period_s))
        self._look_at_ring(False)
        self._take_in()

    # --- the end ---

    def close(self, within_s: float = 2.0) -> None:
        """Brakes moving drives along their quick stop ramps, switches off, and leaves the bus."""
        end_s = time.monotonic() + within_s
        if not self._simulated:
            while (
                time.monotonic() < end_s
                and self._lost_in_a_row < SILENT
                and any(one.operational and one.drive is not None and one.drive.energised for one in self._slaves)
            ):
                self.idle(self.axes)
                time.sleep(self.period_s)
        self._ended = True
        self._look.set()
        if self._watcher is not None:
            self._watcher.join()
        with contextlib.suppress(Exception):
            self._wire.master.state = INIT
            self._wire.master.write_state()
        self._wire.close()

    def _also_lost(self) -> str:
        return f", {counted(self.lost_frames, 'frame')} lost{self._drift_text()}"

    def _drift_text(self) -> str:
        drift = drift_of(self._clocks)
        if drift is None:
            return ""
        said = f"; the clocks of the slaves gain {1e6 * drift:.1f} ppm on that of this host"
        if self._phase.locked:
            return f"{said}, the cycle follows them: {self._phase.text()}"
        return said + (f", so SYNC0 passes the frames every {self.period_s / abs(drift):.3g} s" if drift else "")


def drift_of(clocks: Sequence[tuple[float, float]]) -> float | None:
    """Returns the relative drift of a second clock against the first (above 0: it is faster), from readings of both
    [s]; None if there are too few.

    The second clock is read with the delay of a frame; the quickest frames of the first and the last fifth are used.
    """
    fifth = len(clocks) // 5
    if fifth < 4:
        return None
    read = list(clocks)
    (begin, first), (end, last) = (
        min(((own, other - own) for own, other in part), key=lambda one: one[1])
        for part in (read[:fifth], read[-fifth:])
    )
    return (last - first) / (end - begin)
