"""External drives: connect a motor, a field bus or another simulation, in a process of its own, to an engine (EN-26,
AX-87).

A `Plant` receives the set points of an engine and passes them to your `Drive` objects, one for each axis listed under
`external: drives:` of the machine file. The values that a drive measured are sent back as the answer.
"""

from __future__ import annotations

import json
import os
import random
import select
import signal
import sys
import time
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import partial
from typing import Any, Final

from takt import _core, msgs
from takt.errors import TaktError
from takt.keys import KeyFile, no_key, not_the_key, read_key
from takt.network import DEFAULT_URL, network_of, open_network

CYCLIC_POSITION: Final = msgs.drive_setpoint.MODE_CYCLIC_POSITION
CYCLIC_VELOCITY: Final = msgs.drive_setpoint.MODE_CYCLIC_VELOCITY
ANALOG: Final = msgs.drive_setpoint.MODE_ANALOG
CYCLIC_TORQUE: Final = msgs.drive_setpoint.MODE_CYCLIC_TORQUE

WATCHDOG = 100  # periods
_REST_S = 0.01  # s, real time: between two steps of drives that the watchdog has switched off
_MOST_WAIT_S = 0.1


@dataclass(frozen=True)
class SetPoint:
    """The set points of a drive for one cycle. The defaults mean: drive off."""

    mode: int = CYCLIC_POSITION  # selects the set point that the drive follows
    enable: bool = False  # power stage on
    release_brake: bool = False  # brake relay energised
    position_counts: float = 0.0  # csp: position at the end of the cycle, unwrapped, in the encoder's direction
    velocity_counts_s: float = 0.0  # csp: feedforward; csv: set point; cst: largest speed in either direction
    voltage_v: float = 0.0  # analogue, -10 to 10 V
    torque_nm: float = 0.0  # cst; N on linear motors
    torque_until_counts_s: float = 0.0  # cst: signed velocity at which the torque ends in this cycle
    torque_limit_nm: float = 0.0  # largest torque in either direction, in all modes; 0: the limit of the drive
    digital_outputs: int = 0  # of the axis, one bit each
    period_s: float = 0.001  # cycle time
    cycles: int = 1  # since the previous set point: above 1 if some were lost or the computer was late


@dataclass
class Measured:
    """The values measured by a drive at the end of a cycle: wires before any inversion, counts modulo 2^32."""

    counts: int = 0  # incremental: quadrature counter; absolute: the SSI word
    index_counts: int = 0  # the counter at the last index pulse
    index_pulses: int = 0  # number of index pulses so far
    encoder_error: bool = False
    limit_positive: bool = False
    limit_negative: bool = False
    reference: bool = False
    touch_probe: bool = False
    probe_rises: int = 0  # edges of the touch probe; if they are never counted, the engine samples the wire
    probe_falls: int = 0
    probe_rise_age_s: float = 0.0  # time from the last edge to the end of the cycle
    probe_fall_age_s: float = 0.0
    drive_ready: bool = False  # power stage on and following its set point
    drive_fault: bool = False
    torque_nm: float = 0.0
    load_counts: int = 0  # of a second encoder, on the load
    load_encoder_error: bool = False
    drive_error: int = 0  # the drive's error code (CiA 402, 0x603F); 0: none


class Drive(ABC):
    """One drive with its encoder and switches."""

    def start(self) -> None:  # noqa: B027 (may be left as it is)
        """Called when an engine starts to use this drive, before its first set point."""

    @abstractmethod
    def step(self, told: SetPoint, elapsed_s: float) -> Measured:
        """Applies a set point and returns the measured values at the end of its cycle.

        told: the set point.
        elapsed_s: time [s] since the end of the previous cycle; more than a period if set points were lost.

        In real time, when the engine is no longer heard, it is called repeatedly with a set point that means off.
        """


class Bus(ABC):
    """Drives on one bus: all set points of a cycle are sent together, and all measured values are received together.

    axes: the names of the axes of its drives.
    period_s: period [s] of `idle` while no engine is heard.
    later_s: time [s] by which the engine's cycles should begin later to match the clock of the bus, from the last
        exchange; 0: no shift.
    """

    axes: Sequence[str]
    period_s: float = 0.001
    later_s: float = 0.0

    def start(self, axis: str, *, real_time: bool, period_s: float) -> None:  # noqa: B027 (may be left as it is)
        """Called when an engine starts to use the drive of this axis, before its first set point."""

    @abstractmethod
    def exchange(self, told: Mapping[str, SetPoint], *, real_time: bool) -> Mapping[str, Measured | None]:
        """Performs one cycle of the bus and returns the measured values by axis; None for a drive that was not heard.

        In real time the values were measured when the set points were sent, and answer the previous cycle; in simulated
        time they were measured at the end of this cycle. `told` lacks set points that were lost.
        """

    @abstractmethod
    def idle(self, stop: Collection[str]) -> None:
        """Called every `period_s` while no engine is heard, to keep the bus alive with all drives off. `stop`: axes
        that had an engine before; their drives brake by themselves."""


class SimulatedServo(Drive):
    """The servo that the engine itself would simulate for this axis, with bit-identical motion."""

    MOST_CYCLES = 1000  # most lost set points that are caught up

    def __init__(self, machine: str | os.PathLike[str], axis: str) -> None:
        from takt.engine import read_machine

        self._servo = _core.Servo(*read_machine(machine), axis)
        self._told: dict[str, Any] = _core.servo_outputs()

    def start(self) -> None:
        self._servo.restart()
        self._told = _core.servo_outputs()

    def step(self, told: SetPoint, elapsed_s: float) -> Measured:
        for _ in range(min(round(elapsed_s / told.period_s) - 1, self.MOST_CYCLES)):
            self._servo.step(told.period_s, self._told)
        self._told = {name: getattr(told, name) for name in self._told}
        return Measured(**self._servo.step(told.period_s, self._told))


_TOLD: Final = [f.name for f in fields(SetPoint) if f.name != "cycles"]
_MEASURED: Final = [f.name for f in fields(Measured)]
_COUNTERS: Final = ("counts", "index_counts", "index_pulses", "probe_rises", "probe_falls", "load_counts")


@dataclass
class _Line:
    """One axis between the network and its drive."""

    axis: str
    drive: Drive | None  # None: on a bus
    bus: _Shared | None = field(default=None, repr=False)
    run_id: int = -1
    cycle: int = -2  # the last one carried out; the first cycle is -1
    sequence: int = 0  # of the next answer
    answer: bytes = b""
    real_time: bool = False
    period_s: float = 0.001
    heard_s: float = 0.0  # monotonic time of the last set point
    off_since_s: float | None = None  # switched off by the watchdog since; None: not
    stepped_s: float = 0.0
    latched: bool = False  # the engine has not switched the drive off since the watchdog did
    subscription: Any = field(default=None, repr=False)


@dataclass
class _Shared:
    """A bus between the network and its drives."""

    bus: Bus
    lines: list[_Line] = field(default_factory=list)
    pending: dict[str, tuple[_Line, SetPoint, int]] = field(default_factory=dict)  # by axis; with the cycle
    since_s: float = 0.0  # time of the first pending set point
    served_s: float = 0.0  # time of the last exchange

    @property
    def newest(self) -> int:
        return max(cycle for _, _, cycle in self.pending.values())

    @property
    def complete(self) -> bool:
        """Whether every line has a set point of the newest cycle or has carried that cycle out."""
        newest = self.newest
        return all(
            self.pending[line.axis][2] == newest if line.axis in self.pending else line.cycle == newest
            for line in self.lines
        )

    @property
    def alone(self) -> bool:
        """Whether no engine is heard."""
        return all(line.run_id == -1 or line.off_since_s is not None for line in self.lines)


class Plant:
    """Connects drives with an engine over LCM.

    drives: by the names of their axes.
    url: LCM network of the engine.
    buses: further drives, which share a bus each.
    watchdog: number of periods, at least 1; in real time, drives without a set point for this time are switched off:
        0 V, power stage off, brake applied. They stay off until the engine has switched them off and on again. There is
        no watchdog in simulated time, which does not advance until the drives have answered.
    say: called with a sentence when an engine starts, when it is no longer heard, when it is heard again, and the first
        time messages are ignored because of a wrong key; None: prints to stderr.
    key: file with the key of the engine; None: the file named by the environment (TAKT_KEY_FILE); "": no key.

    Raises TaktError without drives and buses, KeyFileError if the key file cannot be used.
    """

    def __init__(
        self,
        drives: Mapping[str, Drive],
        url: str = DEFAULT_URL,
        *,
        buses: Sequence[Bus] = (),
        watchdog: int = WATCHDOG,
        say: Callable[[str], None] | None = None,
        key: KeyFile | None = None,
    ) -> None:
        if not drives and not buses:
            raise TaktError("a plant needs at least one drive")
        if watchdog < 1:
            raise TaktError(f"a watchdog needs at least one period, not {watchdog}")
        self._watchdog = watchdog
        self._say = say or (lambda sentence: print(sentence, file=sys.stderr, flush=True))
        self._url = url
        self._key = read_key(key)
        self._network = open_network(url, key=self._key, refused=self._refuse)
        self.refused: Counter[str] = Counter()  # set points ignored because of a missing or wrong key, by reason
        self._id = random.SystemRandom().getrandbits(62)
        self._lines = {axis: _Line(axis, drive) for axis, drive in drives.items()}
        self._shared = [_Shared(bus) for bus in buses]
        for shared in self._shared:
            shared.lines = [_Line(axis, None, shared) for axis in shared.bus.axes]
            self._lines |= {line.axis: line for line in shared.lines}
        self._stopped = False
        self.malformed = 0  # messages that could not be decoded as set points
        for line in self._lines.values():
            # Channels are regular expressions here; the dot is the only special character allowed in names.
            channel = f"takt/drive/{line.axis}/setpoint".replace(".", "\\.")
            line.subscription = self._network.subscribe(channel, partial(self._receive, line))
            line.subscription.set_queue_capacity(1000)

    def run(self, duration_s: float | None = None) -> None:
        """Serves until `stop` is called, or for `duration_s` [s]; None: no limit."""
        end_s = None if duration_s is None else time.monotonic() + duration_s
        while not self._stopped and (end_s is None or time.monotonic() < end_s):
            left_s = _MOST_WAIT_S if end_s is None else max(0.0, min(_MOST_WAIT_S, end_s - time.monotonic()))
            self.handle(left_s)
        self._stopped = False

    def stop(self) -> None:
        """Ends `run`, also a call that is about to begin. May be called from a drive, another thread or a signal
        handler."""
        self._stopped = True

    def handle(self, timeout_s: float = 0.0) -> None:
        """Processes received set points, waiting up to `timeout_s` [s] for the first one, and checks the watchdog."""
        # Waits with select: LCM's own wait fails when a signal arrives.
        if select.select([self._network.fileno()], [], [], max(0.0, min(timeout_s, self._wait_s())))[0]:
            self._network.handle()
            # Set points for a bus are collected; after a stall only the newest ones count.
            while self._shared and select.select([self._network.fileno()], [], [], 0)[0]:
                self._network.handle()
        now_s = time.monotonic()
        for shared in self._shared:
            self._serve(shared, now_s)
        for line in self._lines.values():
            self._watch(line, now_s)

    def _wait_s(self) -> float:
        """Returns the time [s] until a bus or a watchdog has to be served next."""
        waits = [_MOST_WAIT_S]
        now_s = time.monotonic()
        for shared in self._shared:
            if shared.pending:
                waits.append(shared.since_s + shared.bus.period_s / 2 - now_s)
            elif shared.alone:
                waits.append(shared.served_s + shared.bus.period_s - now_s)
        for line in self._lines.values():
            if line.real_time:
                waits.append(_REST_S if line.off_since_s is not None else self._watchdog * line.period_s / 4)
        return max(0.0 if self._shared else 0.001, min(waits))

    def _watch(self, line: _Line, now_s: float) -> None:
        if not line.real_time or now_s - line.heard_s < self._watchdog * line.period_s:
            return
        if line.off_since_s is None:
            line.off_since_s = line.stepped_s = now_s
            line.latched = True
            self._say(f"{line.axis}: no set point for {self._watchdog} periods: off, brake on")
            if line.drive is not None:
                line.drive.step(SetPoint(period_s=line.period_s), line.period_s)
        elif line.drive is not None and now_s - line.stepped_s >= _REST_S:
            rested_s = now_s - line.stepped_s
            off = SetPoint(period_s=line.period_s, cycles=max(1, round(rested_s / line.period_s)))
            line.drive.step(off, rested_s)
            line.stepped_s = now_s

    def _refuse(self, channel: str, state: _core.TagState) -> None:
        self.refused[state.name] += 1
        if self.refused[state.name] == 1 and self._key is not None:
            self._say(f"{channel}: {not_the_key(self._url, self._key, state)}")

    def _receive(self, line: _Line, channel: str, data: bytes) -> None:
        if self._key is None and _core.has_tag(data):  # cannot be authenticated without a key
            self.refused["no_key"] += 1
            if self.refused["no_key"] == 1:
                self._say(f"{channel}: {no_key(self._url)}")
            return
        try:
            message = msgs.drive_setpoint.decode(data)
        except Exception:  # generated code raises many kinds of errors
            self.malformed += 1
            return
        if message.axis != line.axis or message.run_id < line.run_id or not message.period_s > 0:
            return  # not for this drive, or from an engine that has been replaced
        if message.run_id > line.run_id:
            self._begin(line, message)
        elif message.cycle == line.cycle:
            if line.answer:
                self._network.publish(_feedback_channel(line), line.answer)
            return
        elif message.cycle < line.cycle:
            return
        self._carry_out(line, message)

    def _begin(self, line: _Line, message: msgs.drive_setpoint) -> None:
        line.run_id, line.sequence, line.cycle = message.run_id, 0, message.cycle - 1
        line.latched = False
        line.off_since_s = None
        if line.bus is not None:
            line.bus.pending.pop(line.axis, None)
            line.bus.bus.start(line.axis, real_time=message.real_time, period_s=message.period_s)
        elif line.drive is not None:
            line.drive.start()
        self._say(f"{line.axis}: an engine has started" + ("" if message.real_time else ", in simulated time"))

    def _carry_out(self, line: _Line, message: msgs.drive_setpoint) -> None:
        elapsed_s = (message.cycle - line.cycle) * message.period_s
        line.real_time, line.period_s, line.heard_s = message.real_time, message.period_s, time.monotonic()
        if line.off_since_s is not None:
            self._say(
                f"{line.axis}: the engine is heard again" + ("; off until it is switched on anew" * message.enable)
            )
            line.off_since_s, elapsed_s = None, message.period_s
        line.latched = line.latched and message.enable
        cycles = max(1, round(elapsed_s / message.period_s))
        if line.latched:
            told = SetPoint(period_s=message.period_s, cycles=cycles)
        else:
            told = SetPoint(**{name: getattr(message, name) for name in _TOLD}, cycles=cycles)
        if line.bus is not None:
            if not line.bus.pending:
                line.bus.since_s = line.heard_s
            line.bus.pending[line.axis] = (line, told, message.cycle)
            return
        assert line.drive is not None
        measured = line.drive.step(told, elapsed_s)
        line.cycle = message.cycle
        self._answer(line, measured, line.cycle)

    def _serve(self, shared: _Shared, now_s: float) -> None:
        """Performs an exchange on the bus when the set points are complete, in real time after half a period anyway."""
        if not shared.pending:
            if shared.alone and now_s - shared.served_s >= shared.bus.period_s:
                shared.served_s = now_s
                shared.bus.idle([line.axis for line in shared.lines if line.run_id != -1])
            return
        real_time = all(line.real_time for line, _, _ in shared.pending.values())
        if not shared.complete and not (real_time and now_s - shared.since_s >= shared.bus.period_s / 2):
            return
        shared.served_s = now_s
        newest = shared.newest
        taken = [(line, told) for line, told, cycle in shared.pending.values() if cycle == newest]
        shared.pending.clear()
        measured = shared.bus.exchange({line.axis: told for line, told in taken}, real_time=real_time)
        for line, _ in taken:
            found = measured.get(line.axis)
            if found is None and not real_time:
                continue  # the engine repeats the set point
            line.cycle, line.answer = newest, b""
            if found is None or (real_time and newest == 0):
                continue
            self._answer(line, found, max(-1, newest - 1) if real_time else newest)

    def _answer(self, line: _Line, measured: Measured, cycle: int) -> None:
        line.answer = self._encode(line, measured, cycle)
        self._network.publish(_feedback_channel(line), line.answer)

    def _encode(self, line: _Line, measured: Measured, cycle: int) -> bytes:
        answer = msgs.drive_feedback()
        answer.utime = time.time_ns() // 1000
        answer.run_id, answer.cycle, answer.plant = line.run_id, cycle, self._id
        answer.axis, answer.sequence = line.axis, line.sequence
        line.sequence += 1
        for name in _MEASURED:
            setattr(answer, name, getattr(measured, name))
        answer.later_s = 0.0 if line.bus is None else line.bus.bus.later_s
        for name in _COUNTERS:
            setattr(answer, name, int(getattr(measured, name)) & 0xFFFF_FFFF)
        data: bytes = answer.encode()
        return data


def _feedback_channel(line: _Line) -> str:
    return f"takt/drive/{line.axis}/feedback"


def simulate(
    machine: str | os.PathLike[str],
    url: str | None = None,
    axes: Sequence[str] = (),
    watchdog: int = WATCHDOG,
    key: KeyFile | None = None,
    *,
    twin: bool = False,
) -> int:
    """Serves simulated external drives of a machine until SIGINT or SIGTERM. Returns 0.

    machine: the machine file.
    url: LCM network; None: that of the machine file.
    axes: the axes to serve; empty: all external ones.
    watchdog, key: as in `Plant`.
    twin: axes that the machine's twin moves are simulated in MuJoCo; not together with `axes`.

    Raises TaktError if an axis is not external, or the machine has no external drives.
    """
    from takt.engine import read_machine

    text, file_name = read_machine(machine)
    described = json.loads(_core.load_machine(text, file_name))
    external = [drive["axis"] for drive in described["external"]["drives"]]
    for axis in axes:
        if axis not in external:
            raise TaktError(f"{file_name}: external.drives has no axis {axis}; it has {', '.join(external) or 'none'}")
    if not external:
        raise TaktError(f"{file_name}: has no external drives (external: drives: - axis: NAME)")
    if twin and axes:
        raise TaktError("a twin moves all of its axes: give either --twin or --axis")
    buses = [_twin_of(text, file_name, described, external)] if twin else []
    moved = [axis for bus in buses for axis in bus.axes]
    drives = {axis: SimulatedServo(machine, axis) for axis in axes or external if axis not in moved}
    plant = Plant(drives, url or network_of(described), buses=buses, watchdog=watchdog, key=key)
    before = [signal.signal(number, lambda *_: plant.stop()) for number in (signal.SIGINT, signal.SIGTERM)]
    said = [f"simulating {', '.join(drives)}"] * bool(drives) + [f"in MuJoCo {', '.join(moved)}"] * twin
    print("; ".join(said), file=sys.stderr, flush=True)
    plant.run()
    for number, handler in zip((signal.SIGINT, signal.SIGTERM), before, strict=True):
        signal.signal(number, handler)
    return 0


def _twin_of(text: bytes, file_name: str, machine: Mapping[str, Any], external: Sequence[str]) -> Bus:
    from takt.plant import OnNetwork
    from takt.twin import Twin

    bus = OnNetwork(lambda: Twin(text, file_name, machine), machine)
    left = [axis for axis in bus.axes if axis not in external]
    if left:
        names = ", ".join(left)
        raise TaktError(f"{file_name}: the twin moves {names}, expected them in external.drives, found {external}")
    return bus
