"""Drives in a process of their own: what a motor, a field bus or another simulation is to an engine (EN-26, AX-87).

A `Plant` listens for the set points of an engine and has a `Drive` of yours carry them out, one for each axis that the
machine file lists under `external: drives:`. What the drive measured goes back as the answer.
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
_REST_S = 0.01  # real time: between two steps of drives that the watchdog has switched off
_MOST_WAIT_S = 0.1


@dataclass(frozen=True)
class SetPoint:
    """What a drive is told for one cycle. As it is here: off."""

    mode: int = CYCLIC_POSITION  # which of the set points it follows
    enable: bool = False  # power stage on
    release_brake: bool = False  # brake relay energised
    position_counts: float = 0.0  # csp: where to be at the end of the cycle, unwrapped, in the encoder's sense
    velocity_counts_s: float = 0.0  # csp: fed forward; csv: set point; cst: largest speed either way
    voltage_v: float = 0.0  # analogue, -10 to 10 V
    torque_nm: float = 0.0  # cst; N on linear motors
    torque_until_counts_s: float = 0.0  # cst: signed velocity at which the torque ends in this cycle
    torque_limit_nm: float = 0.0  # largest torque either way, in all modes; 0: that of the drive
    digital_outputs: int = 0  # of the axis, a bit for each
    period_s: float = 0.001  # length of a cycle
    cycles: int = 1  # since the set point before: more where some were lost, or the computer was late


@dataclass
class Measured:
    """What a drive says at the end of a cycle: wires before any inversion, counts modulo 2^32."""

    counts: int = 0  # incremental: quadrature counter; absolute: the SSI word
    index_counts: int = 0  # the counter at the last index pulse
    index_pulses: int = 0  # how many there were
    encoder_error: bool = False
    limit_positive: bool = False
    limit_negative: bool = False
    reference: bool = False
    touch_probe: bool = False
    probe_rises: int = 0  # edges of the touch probe; where none ever counts, the engine looks at the wire
    probe_falls: int = 0
    probe_rise_age_s: float = 0.0  # how long before the end of the cycle the last one came
    probe_fall_age_s: float = 0.0
    drive_ready: bool = False  # power stage on and following its set point
    drive_fault: bool = False
    torque_nm: float = 0.0
    load_counts: int = 0  # of a second encoder, on the load
    load_encoder_error: bool = False
    drive_error: int = 0  # what it says of its fault (CiA 402, 0x603F); 0: nothing


class Drive(ABC):
    """One drive with its encoder and switches."""

    def start(self) -> None:  # noqa: B027 (may be left as it is)
        """An engine has started, and this drive is its own from now on."""

    @abstractmethod
    def step(self, told: SetPoint, elapsed_s: float) -> Measured:
        """Carries a set point out and says what the wires read at the end of its cycle, `elapsed_s` after the one
        before (more than a period where set points were lost on the way). When the engine is not heard any more in real
        time, it is called with a set point that says off, again and again."""


class Bus(ABC):
    """Drives that share a wire: all set points of a cycle go out together, and what was measured comes back together.

    axes: the names of the axes of its drives.
    period_s: how often it is kept going while there is no engine.
    later_s: how much later the cycles of the engine ought to begin for the clock of the bus, as its last exchange says;
        0: as they do.
    """

    axes: Sequence[str]
    period_s: float = 0.001
    later_s: float = 0.0

    def start(self, axis: str, *, real_time: bool, period_s: float) -> None:  # noqa: B027 (may be left as it is)
        """An engine has started, and the drive of this axis is its own from now on."""

    @abstractmethod
    def exchange(self, told: Mapping[str, SetPoint], *, real_time: bool) -> Mapping[str, Measured | None]:
        """Carries out one cycle. In real time what comes back was measured when the set points went out, so it is the
        answer to the cycle before; in simulated time it was measured at the end of the cycle. None: a drive was not
        heard. Set points that were lost on the way are missing in `told`."""

    @abstractmethod
    def idle(self, stop: Collection[str]) -> None:
        """Keeps the bus going while no engine is heard, every `period_s`. stop: axes that had one before: their drives
        brake by themselves; all are off."""


class SimulatedServo(Drive):
    """The servo that the engine itself would simulate for this axis: the very same motion, bit for bit."""

    MOST_CYCLES = 1000  # of lost set points that are made up for

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
    drive: Drive | None  # None: it is on a bus
    bus: _Shared | None = field(default=None, repr=False)
    run_id: int = -1
    cycle: int = -2  # carried out last; the first one is -1
    sequence: int = 0  # of the next answer
    answer: bytes = b""
    real_time: bool = False
    period_s: float = 0.001
    heard_s: float = 0.0  # when, by the clock
    off_since_s: float | None = None  # by the watchdog; None: it has not bitten
    stepped_s: float = 0.0
    latched: bool = False  # the engine has not switched the drive off since the watchdog bit
    subscription: Any = field(default=None, repr=False)


@dataclass
class _Shared:
    """A bus between the network and its drives."""

    bus: Bus
    lines: list[_Line] = field(default_factory=list)
    pending: dict[str, tuple[_Line, SetPoint, int]] = field(default_factory=dict)  # by axis: of which cycle
    since_s: float = 0.0  # the first of them
    served_s: float = 0.0  # when there was the last exchange

    @property
    def newest(self) -> int:
        return max(cycle for _, _, cycle in self.pending.values())

    @property
    def complete(self) -> bool:
        """There is a set point of one and the same cycle for all that have not carried it out already."""
        newest = self.newest
        return all(
            self.pending[line.axis][2] == newest if line.axis in self.pending else line.cycle == newest
            for line in self.lines
        )

    @property
    def alone(self) -> bool:
        """No engine is heard."""
        return all(line.run_id == -1 or line.off_since_s is not None for line in self.lines)


class Plant:
    """Connects drives with an engine.

    drives: by the names of their axes.
    buses: with drives that share a wire, beside those.
    watchdog: in real time, drives that hear no set point for so many periods are told to be off: 0 V, power stage off,
        brake fallen. They stay off until the engine has switched them off and on again. Simulated time stands still
        until the drives have answered: there is nothing to watch.
    say: takes a sentence when an engine starts, when it is not heard any more, when it is back, and the first time when
        its messages are ignored for want of the right key.
    key: file with the key of the engine, unless the environment names it (TAKT_KEY_FILE); "": none.
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
        self.refused: Counter[str] = Counter()  # set points that were ignored for want of the right key, by reason
        self._id = random.SystemRandom().getrandbits(62)
        self._lines = {axis: _Line(axis, drive) for axis, drive in drives.items()}
        self._shared = [_Shared(bus) for bus in buses]
        for shared in self._shared:
            shared.lines = [_Line(axis, None, shared) for axis in shared.bus.axes]
            self._lines |= {line.axis: line for line in shared.lines}
        self._stopped = False
        self.malformed = 0  # messages that were no set points
        for line in self._lines.values():
            # Channels are regular expressions here; a point is the only such sign that a name may have.
            channel = f"takt/drive/{line.axis}/setpoint".replace(".", "\\.")
            line.subscription = self._network.subscribe(channel, partial(self._receive, line))
            line.subscription.set_queue_capacity(1000)

    def run(self, duration_s: float | None = None) -> None:
        """Serves until `stop`, or for so long."""
        end_s = None if duration_s is None else time.monotonic() + duration_s
        while not self._stopped and (end_s is None or time.monotonic() < end_s):
            left_s = _MOST_WAIT_S if end_s is None else max(0.0, min(_MOST_WAIT_S, end_s - time.monotonic()))
            self.handle(left_s)
        self._stopped = False

    def stop(self) -> None:
        """Ends `run`, also one that is about to begin; from a drive, another thread or a signal."""
        self._stopped = True

    def handle(self, timeout_s: float = 0.0) -> None:
        """Carries out what has come, waiting so long for the first of it at most, and sees to the watchdog."""
        # Waiting with select, not with LCM, which fails when a signal comes.
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
        """How long until the watchdog of some drive wants to be looked at."""
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
        if self._key is None and _core.has_tag(data):  # nothing here could tell whether it is the engine's
            self.refused["no_key"] += 1
            if self.refused["no_key"] == 1:
                self._say(f"{channel}: {no_key(self._url)}")
            return
        try:
            message = msgs.drive_setpoint.decode(data)
        except Exception:  # generated code raises whatever comes
            self.malformed += 1
            return
        if message.axis != line.axis or message.run_id < line.run_id or not message.period_s > 0:
            return  # not for this drive, or from an engine that another one came after
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
        """Has a bus carry out what is complete, or in real time what there is after half a period."""
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
                continue  # the engine asks again
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
    """Serves the external drives of a machine, or those of these axes, until SIGINT or SIGTERM. twin: those that it
    moves are in MuJoCo."""
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
