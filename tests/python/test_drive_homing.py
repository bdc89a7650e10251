"""AX-87: what drives on field buses do by themselves: homing (0x6098), touch probes that latch (0x60B8)."""

from __future__ import annotations

import re
from pathlib import Path

import buses
import pytest
import takt
from both_buses import driven
from machines import new_url, running
from takt import drive
from takt.drives.axis import DriveAxis, Heard
from takt.drives.canopen_bus import CanopenBus
from takt.drives.cia402 import FOLLOWING_ERROR_BIT, FOLLOWS_BIT, HOMING_START_BIT, TARGET_REACHED_BIT, Mode, State
from takt.drives.homing import DriveHoming, Watch, homing_objects
from takt.drives.probe import ENABLE_BIT, FALL_BIT, RISE_BIT, ProbeLatch
from takt.drives.scaling import Scaling
from takt.errors import TaktError

HOMING = "homing: {method: 17, velocity_switch: 60, velocity_pulse: 10, acceleration: 1000, within_s: 9}"
SERVO = """simulation:
  servos:
    - axis: x1
      switches: {limit_negative: {to: -8}, touch_probe: {from: 31.5, to: 58.25}}
"""


def machine(url: str, bus: str, keys: str, axes: int = 1, servo: str = SERVO) -> str:
    place = "position" if bus.startswith("ethercat") else "node"
    axis = "drive: {ready_timeout_s: 10}\n    homing: {method: pulse, velocity: 20}"
    text = buses.machine(url, bus, axes, place=place, drive_keys=keys, axis_keys=axis)
    return text.replace("increments_per_unit: 1000}", "increments_per_unit: 5000}") + servo


def test_a_drive_homes_itself_when_it_is_switched_on(bus: str, tmp_path: Path) -> None:
    """The axis is not ready before; its reference is that of the drive, with a gear, too; it is kept while the drive
    has its supply."""
    url = new_url()
    scaling = "scaling: {increments_per_revolution: 65536, gear_motor: 7, gear_shaft: 2, feed: 9}"
    text = machine(url, bus, f"{scaling}, {HOMING}")
    with driven(text, url, tmp_path) as (said, command), takt.Engine(text) as engine:
        x = engine.axis("x1")
        assert not x.homed
        x.power().wait()
        assert any("homing in the drive by method 17 begins" in line for line in said)
        stands = x.actual_position
        x.step_ref_flying_ref_pulse(set_position=-8.0).wait()
        assert x.homed
        assert x.actual_position == pytest.approx(-8.0, abs=0.2)  # it stops some way behind the edge of the switch
        assert stands == pytest.approx(-8.0, abs=0.2)  # the encoder began at 0, and has not jumped
        x.move_absolute(position=20.0).wait()
        x.home(position=-8.0).wait()  # by the index pulse that the drive's reference is: found at once
        assert x.actual_position == pytest.approx(20.0, abs=0.1)
        x.power(enable=False).wait()
        count = len(said)
        x.power().wait()
        x.move_absolute(position=20.0).wait()
        engine.run(0.1)
        assert x.actual_position == pytest.approx(20.0, abs=0.01)
        assert said[count:] == []

        command("fault 1 0x3210")
        engine.run(0.5)
        assert x.error == 3002
        x.reset().wait()
        x.power().wait()
        assert not any("homing" in line for line in said[count:])
        assert x.actual_position == pytest.approx(20.0, abs=0.1)


def test_homing_that_fails(tmp_path: Path) -> None:
    """It runs into the other limit switch: ErrorStop 3002, said why; the next MC_Power tries it again."""
    url, bus = new_url(), buses.new_bus()
    text = machine(
        url, bus, HOMING.replace("17", "34"), servo=SERVO.replace("negative: {to: -8", "positive: {from: 0.01")
    )
    with driven(text, url, tmp_path) as (said, _), takt.Engine(text) as engine:
        x = engine.axis("x1")
        for _ in range(2):
            count = len(said)
            assert x.power().wait_final().error_id == 3002
            assert any("homing in the drive by method 34: the drive reports a homing error" in t for t in said[count:])
            engine.run(0.5)
            x.reset().wait()


def test_probes_latch_in_the_drive(bus: str, tmp_path: Path) -> None:
    """MC_TouchProbe gives where the drive was at the edge, not at a sample: these are 0.8 mm apart."""
    url = new_url()
    text = machine(url, bus, "probe_latch: 2")
    with driven(text, url, tmp_path), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        captures = [x.arm_probe(edge=edge) for edge in ("rising", "falling")]
        x.move_absolute(position=100.0, velocity=200.0).wait()
        assert [one.value for one in captures] == pytest.approx([31.5, 58.25], abs=0.02)
        captures = [x.arm_probe(edge=edge) for edge in ("rising", "falling")]  # back: the other way round
        x.move_absolute(position=0.0, velocity=200.0).wait()
        assert [one.value for one in captures] == pytest.approx([58.25, 31.5], abs=0.02)


def test_a_following_error_is_said_with_its_size(tmp_path: Path) -> None:
    """0x8611 of the drive (0x6065): which way and how far it was behind."""
    url, bus = new_url(), buses.new_bus()
    servo = "simulation: {servos: [{axis: x1, mechanics: {upper_stop: 5}}]}\n"
    text = machine(url, bus, 'start_up: [{object: "0x6065:0", value: 4000}]', servo=servo)
    with driven(text, url, tmp_path) as (said, _), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        x.move_velocity(velocity=50.0)
        engine.wait(lambda: x.error != 0, timeout=20)
        engine.run(0.5)
        found = [line for line in said if "0x8611" in line]
        assert len(found) == 1
        lag = re.search(r"x1: node 1: fault 0x8611 \(.*\), (\d+) increments from its set point", found[0])
        assert lag
        assert int(lag[1]) == pytest.approx(4000, abs=3 * 50 * 5000 * 0.004)


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ("homing: {method: 7}", "x1: node 1: 0x6098:0 cannot be written with 7: SDO abort 0x06090030"),
        ("probe_latch: 1", "x1: node 1 does not have 0x60B8 (touch probe function), which probe_latch: 1 asks for"),
        (
            "homing: {method: 35}",
            "x1: node 1 does not have the mode hm, which homing asks for; it has csp, csv, cst",
        ),
    ],
)
def test_drives_that_cannot(keys: str, sentence: str) -> None:
    """One line says what."""
    from takt.drives import objects as od

    bus = buses.new_bus()
    text = machine(new_url(), bus, keys.replace("}", ", within_s: 9}"))
    whole = buses.described(text)
    with buses.emulated(text) as emulation:
        if "probe" in keys:
            del emulation.nodes[1].local.object_dictionary.indices[0x60B8]
            del emulation.nodes[1].drive.values[0x60B8]
        if "35" in keys:
            emulation.nodes[1].drive.values[od.SUPPORTED_MODES.index] = 0x380
        with pytest.raises(TaktError) as caught:
            CanopenBus(whole["external"]["buses"][0], whole, lambda _: None)
        assert str(caught.value).startswith(f"{bus}: {sentence}")


def test_the_handshake_of_homing() -> None:
    """The start bit comes after the mode, an answer that is an older one's is not believed, time is limited."""
    homing = DriveHoming({"method": 1, "within_s": 5.0})
    done = FOLLOWS_BIT | TARGET_REACHED_BIT
    assert homing.control_bits(done, Mode.CYCLIC_POSITION, 0.0) == 0
    bits = [homing.control_bits(done, Mode.HOMING, 0.01 * k) for k in range(5)]
    assert bits == [0, 0, *[HOMING_START_BIT] * 3]
    assert homing.under_way
    for k in range(5, 10):
        homing.control_bits(0, Mode.HOMING, 0.01 * k)
    homing.control_bits(FOLLOWS_BIT, Mode.HOMING, 0.2)  # attained, but still moving
    assert homing.under_way
    homing.control_bits(done, Mode.HOMING, 0.3)
    assert homing.homed

    homing.forget()
    homing.control_bits(0, Mode.CYCLIC_POSITION, 0.0)
    homing.control_bits(0, Mode.CYCLIC_POSITION, 1.1)
    assert homing.failed == "the drive has not changed to the mode hm within 1 s, it says mode 8"
    homing.forget()
    for k in range(10):
        homing.control_bits(0, Mode.HOMING, 0.01 * k)
    homing.control_bits(0, Mode.HOMING, 5.1)
    assert homing.failed == "it has not ended within 5 s"
    homing.forget()
    for k in range(10):
        homing.control_bits(FOLLOWING_ERROR_BIT, Mode.HOMING, 0.01 * k)
    assert homing.failed == "the drive reports a homing error (status word 0x2000)"


@pytest.mark.parametrize("sense", [1, -1])
def test_a_watch_over_homing(sense: int) -> None:
    """AX-87: the drive may come to rest behind a limit switch, as far as its braking takes, but not go on; it may leave
    one that it begins on; and it may not go too far. With either sense of the axis."""
    watch = Watch(most=5000, acceleration=100_000, period_s=0.001)  # 1000/s: 5 increments of braking

    def go(position: int, negative: bool = False, positive: bool = False) -> str:
        return watch.look(sense * position, {-sense: negative, sense: positive})

    assert [go(position) for position in range(2000)] == [""] * 2000
    braking = (2001, 2003, 2005, 2006, 2006)
    assert [go(position, positive=True) for position in braking] == [""] * len(braking)
    assert not any(go(position, positive=position > 1998) for position in range(2005, 0, -1))
    watch.begin()
    said = [go(position, positive=True) for position in range(100, 130)]
    assert said[:6] == [""] * 6
    end = "positive" if sense > 0 else "negative"
    assert said[-1] == f"it goes on behind the {end} limit switch, 29 increments by now"
    watch.begin()
    late = [1990, 1995, 2000, 2000, 2001, 2003, 2005, 2006, 2006]  # the position is late where the switch comes on
    assert [go(position, positive=k > 2) for k, position in enumerate(late)] == [""] * len(late)
    watch.begin()
    assert not any(go(position, negative=position < 50) for position in range(200)), "it leaves the switch it began on"
    watch.begin()
    assert not any(go(position) for position in range(0, 5001, 10))
    assert go(5010) == "it has gone 5010 increments from where it began, more than the 5000 of distance"


@pytest.mark.parametrize("reason", ["distance", "power", "emergency"])
def test_homing_that_is_broken_off(reason: str) -> None:
    """AX-87: the drive comes to rest along its quick stop ramp (0x6085), whoever breaks its homing off, and is off."""
    url, bus = new_url(), buses.new_bus()
    # 200 mm/s; its ramp is 2000 mm/s2, so that it takes 10 mm, and about 5 without (brake, friction).
    keys = HOMING.replace("velocity_switch: 60", "velocity_switch: 200") + (
        ', start_up: [{object: "0x6085:0", value: 10000000}]'
    )
    if reason == "distance":
        keys = keys.replace("within_s", "distance: 40, within_s")
    servo = SERVO.replace("-8", "-800")
    text = machine(url, bus, keys, servo=servo)
    with buses.emulated(text) as emulation, buses.run(text, url) as (_, said), takt.Engine(text) as engine:
        x, motor = engine.axis("x1"), emulation.nodes[1].drive
        given = x.power()
        engine.wait(lambda: abs(x.actual_velocity) > 190, timeout=20)
        if reason == "power":
            x.power(enable=False)
        elif reason == "emergency":
            engine.emergency_stop()
        else:
            engine.wait(lambda: x.error != 0, timeout=20)
        states, where = set(), x.actual_position
        for _ in range(60):
            engine.run(0.004)
            states.add(motor.machine.state)
        assert State.QUICK_STOP_ACTIVE in states
        assert motor.machine.state in (State.READY_TO_SWITCH_ON, State.SWITCH_ON_DISABLED)
        assert x.actual_velocity == pytest.approx(0, abs=0.5)
        assert 5 < abs(x.actual_position - where) < 13
        assert given.error or given.aborted
        if reason == "distance":
            assert x.error == 3002
            assert any("more than the 200000 of distance" in line for line in said)


def test_what_is_written_for_homing() -> None:
    """In increments of the drive; what is unset is left alone."""
    axis = {"encoder": {"increments_per_unit": 1000}}
    described = {"method": -3, "velocity_switch": 20.0, "velocity_pulse": None, "acceleration": 100.0}
    assert homing_objects(described, axis, Scaling(velocity_factor=0.5)) == [
        (0x6098, 0, -3, 8),
        (0x6099, 1, 10_000, 32),
        (0x609A, 0, 50_000, 32),
    ]


def test_the_handshake_of_a_probe() -> None:
    """What was stored before the start is no edge; each edge counts once, and is looked for again."""
    probe = ProbeLatch(2)
    both = (RISE_BIT | FALL_BIT | ENABLE_BIT) << 8
    probe.take(probe.stored(0x0600, 5, 6), 100, 40, 0.004)
    assert (probe.function, probe.rise.count, probe.fall.count) == (ENABLE_BIT << 8, 1, 1)
    probe.take(probe.stored(0x0100, 5, 6), 140, 40, 0.004)
    assert probe.function == both
    probe.take(probe.stored(0x0300, 170, 6), 180, 40, 0.004)
    assert (probe.rise.count, probe.fall.count) == (2, 1)
    assert probe.rise.age_s == pytest.approx(0.001)
    assert probe.function == both & ~(RISE_BIT << 8)
    probe.take(probe.stored(0x0300, 170, 6), 220, 40, 0.004)
    assert (probe.rise.count, probe.wire) == (2, True)
    probe.take(probe.stored(0x0100, 170, 6), 260, 40, 0.004)
    assert probe.function == both
    probe.take(probe.stored(0x0500, 170, -0x7FFF_FFFF), 0x7FFF_FFFF, -8, 0.004)  # across the wrap, backwards
    assert (probe.fall.count, probe.wire) == (2, False)
    assert probe.fall.age_s == pytest.approx(0.001)


def test_a_short_pulse_leaves_the_wire_as_it_was() -> None:
    """AX-49: both edges within one cycle."""
    probe = ProbeLatch(1)
    probe.take((None, None), 0, 10, 0.001)
    probe.take((5, None), 10, 10, 0.001)
    assert probe.wire
    probe.take((None, None), 20, 10, 0.001)
    probe.take((28, 22), 30, 10, 0.001)
    assert (probe.wire, probe.rise.count, probe.fall.count) == (True, 3, 2)


def test_a_latch_after_cycles_that_were_lost() -> None:
    """AX-87: how long ago the edge was goes by the cycles of the engine, not by those in which the drive was heard."""
    latch = ProbeLatch(1)
    modes = frozenset({Mode.CYCLIC_POSITION})
    axis = DriveAxis("x", "it", Scaling(), {}, modes, lambda _: None, probe=latch, period_s=0.001)
    for cycles, position, stored in ((1, 0, (None, None)), (1, 40, (None, None)), (10, 440, (340, None))):
        axis.words(drive.SetPoint(cycles=cycles), 0.0)
        found = axis.measured(Heard(0x0237, position, 0, 0, int(Mode.CYCLIC_POSITION), stored), 0.0)
    assert found.probe_rises == 2
    assert found.probe_rise_age_s == pytest.approx(0.0025)


def test_homing_and_probes_by_the_clock(tmp_path: Path) -> None:
    """In real time, with answers that come a cycle later: reference and edges are right; a drive that has started anew
    homes again."""
    url, bus = new_url(), buses.new_bus()
    text = machine(url, bus, f"{HOMING}, probe_latch: 1", servo=SERVO.replace("-8", "-1").replace("31.5", "5.5"))
    text = text.replace("      drives:\n", f"      {buses.PATIENT}\n      drives:\n", 1)
    with (
        buses.emulated(text) as emulation,
        buses.run(text, url, watchdog=buses.PATIENT_WATCHDOG) as (_, said),
        running(tmp_path, url, machine=text, pace="real"),
        takt.connect(url) as session,
    ):
        x = session.axis("x1")
        x.power().wait(timeout=20)
        assert any("x1: node 1: homed, its position is " in line for line in said)
        x.step_ref_flying_ref_pulse(set_position=0.0).wait(timeout=20)
        assert x.homed
        capture = x.arm_probe()
        x.move_absolute(position=10.0, velocity=5.0).wait(timeout=20)  # answers of a busy host may be 20 ms late
        assert capture.value == pytest.approx(6.5, abs=0.1)  # from the switch at -1 to the probe at 5.5

        count = len(said)
        emulation.command("power 1 off")
        session.wait(lambda: x.error == 3002, timeout=20)
        emulation.command("power 1 on")
        assert buses.eventually(lambda: "x1: node 1 is set up again" in said[count:], 20), said
        session.wait(lambda: not x.reset().wait_final(timeout=20).error, timeout=20)
        assert not x.homed, "the reference went with the supply"
        x.power().wait(timeout=20)
        assert any("x1: node 1: homed, its position is " in line for line in said[count:])
