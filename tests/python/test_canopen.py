"""AX-87, EN-26: drives of CiA 402 on a CANopen bus, emulated ones, run for an engine; and what goes wrong there."""

from __future__ import annotations

import contextlib
import random
import sys
import time
from pathlib import Path
from typing import Any

import can
import pytest
import takt
from buses import PATIENT, PATIENT_WATCHDOG, PERIOD_S, described, emulated, eventually, machine, new_bus, run
from machines import new_url, running
from takt import drive
from takt.drives import objects as od
from takt.drives.can_link import CanLink, Sdo, frame_bits, parse
from takt.drives.canopen_bus import CanopenBus, nodes_on
from takt.drives.cia402 import State
from takt.drives.field_bus import interpolation_period
from takt.drives.sdo import Objects, SdoError
from takt.errors import TaktError


def test_axes_move_over_canopen_as_they_should() -> None:
    """AX-87, EN-26: in simulated time; gear and resolution, position and velocity loops in the drive, torque limits."""
    url, bus = new_url(), new_bus()
    keys = "scaling: {increments_per_revolution: 65536, gear_motor: 7, gear_shaft: 2, feed: 9}, rated_torque: 2"
    text = machine(url, bus, 2, drive_keys=keys).replace(
        "x2\n    limits: {",
        "x2\n    drive: {mode: cyclic_velocity}\n    loop: {kp: 0.06, ff: 1, velocity_at_10v: 600}\n    limits: {",
    )
    with emulated(text) as emulation, run(text, url) as (served, said), takt.Engine(text) as engine:
        x1, x2 = engine.axis("x1"), engine.axis("x2")
        for axis in (x1, x2):
            axis.power().wait()
        record = engine.record()
        away = x2.move_absolute(position=-40.0)
        x1.move_absolute(position=123.456).wait()
        away.wait()
        engine.run(0.2)
        recording = record.stop()
        assert x1.actual_position == pytest.approx(123.456, abs=0.002)
        assert x2.actual_position == pytest.approx(-40.0, abs=0.05)
        increments = emulation.nodes[1].drive.read(od.POSITION)
        assert increments == pytest.approx(123.456 * 65536 * 3.5 / 9, abs=65536 * 3.5 / 9 / 1000)
        assert abs(recording["x1"]["following_error"]).max() < 0.1
        assert emulation.nodes[2].drive.read(od.MODE_DISPLAY) == 9
        for axis in (x1, x2):
            axis.power(enable=False).wait()
        engine.run(0.02)
        assert emulation.nodes[1].drive.machine.state is State.READY_TO_SWITCH_ON
        assert served.late == 0
    assert not [line for line in said if "node" in line]


def test_a_run_comes_out_the_same_again() -> None:
    """EN-26: simulated time goes by SYNC, however slow the processes are."""

    def once() -> bytes:
        url, bus = new_url(), new_bus()
        text = machine(url, bus, 1)
        with emulated(text), run(text, url), takt.Engine(text) as engine:
            x = engine.axis("x1")
            x.power().wait()
            record = engine.record()
            x.move_absolute(position=30.0).wait()
            return bytes(record.stop()["x1"]["actual_position"].tobytes())

    assert once() == once()


def test_torque_control_switches_the_mode() -> None:
    """AX-87: cst, and back to csp."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1)
    with emulated(text) as emulation, run(text, url), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        x.torque_control(torque=0.2, velocity=50.0)
        engine.run(0.4)
        assert emulation.nodes[1].drive.read(od.MODE_DISPLAY) == 10
        assert x.actual_velocity > 10
        x.halt().wait()
        x.move_absolute(position=0.0).wait()
        assert emulation.nodes[1].drive.read(od.MODE_DISPLAY) == 8


def test_a_fault_of_the_drive_is_said_in_words_and_reset() -> None:
    """AX-87: 3002 in the engine, the text here; MC_Reset once the drive has none any more."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 2)
    with emulated(text) as emulation, run(text, url) as (_, said), takt.Engine(text) as engine:
        x1, x2 = engine.axis("x1"), engine.axis("x2")
        for axis in (x1, x2):
            axis.power().wait()
        moving = x1.move_velocity(velocity=100.0)
        x2.move_velocity(velocity=100.0)
        engine.run(0.3)
        emulation.command("fault 1 0x3210")
        engine.wait(lambda: moving.aborted or moving.error, timeout=20)
        assert (x1.state, x1.error) == (takt.PlcState.ERROR_STOP, 3002)
        engine.run(0.5)
        assert "x1: node 1: fault 0x3210 (DC link overvoltage)" in said
        assert "x1: node 1: the fault has been reset" in said
        assert (x1.drive_error, x2.drive_error) == (0x3210, 0), "kept, though the drive has it no more"
        assert x2.set_velocity == pytest.approx(100.0), "the other drive goes on"
        x1.reset().wait()
        engine.run(0.01)
        assert x1.drive_error == 0
        x1.power(enable=False).wait()
        x1.power().wait()
        x1.move_absolute(position=0.0).wait()


def test_an_endless_fault_is_not_reset_for_ever() -> None:
    """AX-87: tried again and again, ever more rarely, and said once; the axis stays in ErrorStop."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1)
    with emulated(text) as emulation, run(text, url) as (_, said), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        emulation.command("fault 1 0x2320 lasting")
        engine.run(6.0)
        assert x.state == takt.PlcState.ERROR_STOP
        told = [line for line in said if "still there after 3 resets" in line]
        assert told == [
            "x1: node 1: fault 0x2320 (short circuit or earth leakage at the motor) is still there after 3 resets; one "
            "is tried every 5 s while the axis is off"
        ]
        assert x.reset().wait_final().error
        emulation.command("clear 1")
        engine.run(6.0)
        x.reset().wait()


def test_a_drive_that_never_gets_ready() -> None:
    """AX-87: MC_Power fails, nothing moves."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1, axis_keys="drive: {ready_timeout_s: 0.5}")
    with emulated(text) as emulation, run(text, url), takt.Engine(text) as engine:
        emulation.command("stall 1")
        x = engine.axis("x1")
        engine.run(0.1)
        assert x.power().wait_final().error_id == 3002
        emulation.command("clear 1")
        engine.run(0.1)
        x.reset().wait()
        x.power().wait()


@pytest.mark.parametrize(
    "text",
    [
        "fault 1 -1",
        "fault 1 0x10000",
        "fault 1 0x3210 lastng",
        "fault 1 0x3210 lasting 2",
        "cut 1 2",
        "clear",
        "jump 1",
        "power 1 maybe",
        "show 1",
        "stall 9",
        "nonsense",
    ],
)
def test_commands_to_emulated_drives_are_whole(text: str) -> None:
    """AX-87: a command with a word too many, too few or misspelt changes nothing, and is said to be none."""
    said: list[str] = []
    with emulated(machine(new_url(), new_bus(), 1)) as emulation:
        emulation._say = said.append
        emulation.command(text)
        assert eventually(lambda: bool(said), 20)
        assert said[0].startswith(f"not understood: '{text}'; expected fault NODE CODE")
        assert emulation.nodes[1].drive.machine.error_code == 0


@pytest.mark.parametrize(
    ("period_s", "expected"),
    [(0.00025, (25, -5)), (0.001, (1, -3)), (0.0015, (15, -4)), (0.02, (20, -3)), (0.000251, (251, -6))],
)
def test_periods_of_interpolation(period_s: float, expected: tuple[int, int]) -> None:
    """0x60C2: 1 to 255 times a power of ten."""
    assert interpolation_period(period_s) == expected


def test_a_period_of_interpolation_that_drives_cannot_hold() -> None:
    """AX-87: it is said, and the object is left alone; it was told 77 of 333 us."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1).replace("period_s: 0.004", "period_s: 0.000333")
    with emulated(text) as emulation, run(text, url) as (_, said), takt.Engine(text) as engine:
        engine.axis("x1").power().wait()
        assert len([line for line in said if "x1: node 1: 0x60C2 cannot hold the cycle of 333 us" in line]) == 1
        assert emulation.nodes[1].drive.period_s == 0.000333


class OneObject(Objects):
    """A drive with an object of 16 bits, or one that refuses."""

    called = "it"

    def __init__(self, code: int | None = None) -> None:
        self.code, self.data = code, b"\x01\x00"

    def upload(self, what: str, index: int, subindex: int) -> bytes:
        if self.code is not None:
            raise SdoError(what, self.code)
        return self.data

    def download(self, what: str, index: int, subindex: int, data: bytes) -> None:
        self.upload(what, index, subindex)
        self.data = data


def test_objects_that_cannot_be_read_or_written() -> None:
    """AX-87: what a drive does not have is told apart from what it cannot do just now; no value is cut off."""
    for code in (0x06020000, 0x06090011, 0x06010002, 0x08000000):
        assert OneObject(code).find(0x2000) is None
        assert not OneObject(code).try_to_write(0x2000, 0, 1, 16)
    for code in (0x05040000, 0x08000022):
        with pytest.raises(SdoError):
            OneObject(code).find(0x2000)
        with pytest.raises(SdoError):
            OneObject(code).try_to_write(0x2000, 0, 1, 16)
    one = OneObject()
    for value in (-0x8000, 0, 0xFFFF):
        one.write(0x2000, 0, value, 16)
        assert one.find(0x2000) == value & 0xFFFF
    for value in (-0x8001, 0x10000):
        with pytest.raises(SdoError, match=f"0x2000:0 cannot be written with {value}: it has 16 bits"):
            one.try_to_write(0x2000, 0, value, 16)


def test_a_cable_that_breaks_in_motion(tmp_path: Path) -> None:
    """AX-87, in real time: the engine stops the axis with 3002, the drive brakes by itself, and all is said; with the
    cable back MC_Reset brings the axis back."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 2, bus_keys=PATIENT)
    with (
        emulated(text) as emulation,
        run(text, url, watchdog=PATIENT_WATCHDOG) as (_, said),
        running(tmp_path, url, machine=text, pace="real"),
        takt.connect(url) as session,
    ):
        x = session.axis("x1")
        x.power().wait(timeout=20)
        x.move_velocity(velocity=50.0)
        session.wait(lambda: x.actual_velocity > 40, timeout=20)
        emulation.command("cut all")
        session.wait(lambda: x.error == 3002, timeout=20)
        assert eventually(lambda: any("x1: node 1 is not heard any more" in line for line in said), 20)
        assert eventually(lambda: emulation.nodes[1].drive.machine.state is State.FAULT, 10)
        where = emulation.nodes[1].drive.read(od.POSITION)
        emulation.command("join all")
        assert eventually(lambda: any("node 1 is heard again" in line for line in said), 10)
        assert eventually(lambda: any("the fault has been reset" in line for line in said), 10)
        x.reset().wait(timeout=20)
        x.power(enable=False).wait(timeout=20)
        x.power().wait(timeout=20)
        assert abs(emulation.nodes[1].drive.read(od.POSITION) - where) < 100
        x.move_relative(distance=5.0).wait(timeout=20)


def test_two_masters() -> None:
    """AX-87: the second one does not start and does no harm; one that does not ask is said."""
    import can

    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1)
    signs = [
        f"{bus}: another master is active: another node {does}"
        for does in ("sends SYNC, too", "has node 127 of this end")
    ]
    with emulated(text), run(text, url) as (_, said):
        why = (
            "(another takt drives run, or a drive that is set up to send SYNC, 0x1005); "
            "two on one bus disturb each other"
        )
        # Of what the first one sends all the time either may be heard first.
        assert wrong(text) in [f"{sign} {why}" for sign in signs]
        with takt.Engine(text) as engine:
            x = engine.axis("x1")
            x.power().wait()
            x.move_absolute(position=5.0).wait()
            with can.Bus(interface="virtual", channel=parse(bus).channel) as stranger:
                for number in (0x080, 0x77F, 0x080):
                    data = b"\x05" * (number > 0x700)
                    stranger.send(can.Message(arbitration_id=number, data=data, is_extended_id=False))
            engine.run(0.1)  # in simulated time the bus is looked at when a cycle comes
        assert eventually(lambda: sum("another master" in line for line in said) == 2, 10)
        assert [line for line in said if "another master" in line] == [
            f"{sign}; two on one bus disturb each other" for sign in signs
        ]


@pytest.mark.parametrize("refused", [0, 1, 3])
def test_a_drive_that_starts_anew_is_set_up_again(refused: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """AX-87: its supply went off and on; also where the wire takes no frame at first, and no heartbeat comes."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1)
    with emulated(text) as emulation, run(text, url) as (served, said):
        assert eventually(lambda: served._nodes[0].drive.state is State.READY_TO_SWITCH_ON, 10)
        emulation.command("power 1 off")
        assert eventually(lambda: any("is not heard any more" in line for line in said), 10)
        send, left = served._link.network.send_message, [0x601] * refused

        def full(can_id: int, *rest: Any, **more: Any) -> None:
            if can_id in left:
                left.remove(can_id)
                raise can.CanOperationError("Transmit buffer full")
            send(can_id, *rest, **more)

        monkeypatch.setattr(served._link.network, "send_message", full)
        emulation.command("power 1 on")
        assert eventually(lambda: "x1: node 1 is set up again" in said, 10), said
        assert eventually(lambda: emulation.nodes[1].drive.machine.state is State.READY_TO_SWITCH_ON, 10)
        assert sum("Transmit buffer full: tried again" in line for line in said) == min(refused, 1), "said once"


def test_an_emulator_that_is_killed_in_motion() -> None:
    """AX-87: simulated time goes on without it, the axis is in ErrorStop."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1).replace("answer_within_s: 20", "answer_within_s: 0.3")
    with contextlib.ExitStack() as alive, contextlib.ExitStack() as others:
        alive.enter_context(emulated(text))
        others.enter_context(run(text, url))
        engine = others.enter_context(takt.Engine(text))
        x = engine.axis("x1")
        x.power().wait()
        x.move_velocity(velocity=50.0)
        engine.run(0.2)
        alive.close()
        with pytest.warns(takt.DriveWarning):
            engine.run(0.5)
        assert (x.state, x.error) == (takt.PlcState.ERROR_STOP, 3002)
        assert x.set_velocity == 0


def wrong(text: str) -> str:
    """What the start says of this machine's bus."""
    whole = described(text)
    with pytest.raises(TaktError) as caught:
        CanopenBus(whole["external"]["buses"][0], whole, lambda _: None)
    return str(caught.value)


def test_fewer_nodes_than_axes() -> None:
    """AX-87: which are missing, and which are there."""
    bus = new_bus()
    text = machine(new_url(), bus, 3, drive_keys="ready_within_s: 0.3")
    with emulated(text, leave_out=(2, 3)):
        assert wrong(text) == (
            f"{bus}: nodes 2 (axis x2), 3 (axis x3) do not answer; nodes that do: 1 (check supply, address, bit rate "
            f"and termination)"
        )


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ('vendor: "0x2E1"', "x1: node 1: expected vendor 0x2E1, found 0x0"),
        ('product: "0x17"', "x1: node 1: expected product code 0x17, found 0x54414B54"),
        (
            'start_up: [{object: "0x2FFF:1", value: 5}]',
            "x1: node 1: 0x2FFF:1 cannot be written with 5: SDO abort 0x06020000, the object does not exist",
        ),
        (
            'start_up: [{object: "0x6098:0", value: 7, bits: 8}]',
            "x1: node 1: 0x6098:0 cannot be written with 7: SDO abort 0x06090030, the value is out of range",
        ),
        (
            'start_up: [{object: "0x6098:0", value: 35, bits: 16}]',
            "x1: node 1: 0x6098:0 cannot be written with 35: SDO abort 0x06070010, the length is wrong",
        ),
        (
            'start_up: [{object: "0x6041:0", value: 35, bits: 16}]',
            "x1: node 1: 0x6041:0 cannot be written with 35: SDO abort 0x06010002, the object can only be read",
        ),
    ],
)
def test_what_is_wrong_at_start(keys: str, sentence: str) -> None:
    """AX-87: nothing moves, and one line says what."""
    bus = new_bus()
    text = machine(new_url(), bus, 1, drive_keys=keys)
    with emulated(text):
        assert wrong(text) == f"{bus}: {sentence}"


def test_another_device_on_the_place_of_a_drive() -> None:
    """AX-87: an I/O module, or a drive without the mode."""
    bus = new_bus()
    text = machine(new_url(), bus, 1)
    with emulated(text) as emulation:
        emulation.nodes[1].local.object_dictionary[0x1000].default = 0x0003_0191
        assert "x1: node 1 is no drive of CiA 402: its device type (0x1000) is 0x00030191" in wrong(text)
        emulation.nodes[1].local.object_dictionary[0x1000].default = 0x0002_0192
        emulation.nodes[1].drive.values[od.SUPPORTED_MODES.index] = 0x2D
        assert "does not have the mode csp, which drive: mode of its axis asks for; it has pp, pv, tq, hm" in wrong(
            text
        )


def test_the_load_of_the_wire() -> None:
    """AX-87: six drives every millisecond are too many for 1 Mbit/s; said before anything is opened."""
    text = machine(new_url(), "canopen:can0", 6).replace("period_s: 0.004", "period_s: 0.001")
    found = wrong(text)
    assert "canopen:can0: 6 drives every 1 ms take 168 % of 1000000 bit/s; expected 100 % at the most" in found
    assert "cycle: {period_s: 0.0021}" in found
    assert frame_bits(8) == 135


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("can0", "can0: expected canopen:CHANNEL or canopen:INTERFACE:CHANNEL, such as canopen:can0"),
        ("canopen:nix:0", "canopen:nix:0: python-can has no interface nix; it has "),
        ("canopen:virtual:", "canopen:virtual:: expected a channel behind the interface"),
        ("canopen:virtual:a?b", "canopen:virtual:a?b: expected OPTION=VALUE behind the question mark, found b"),
    ],
)
def test_names_of_buses(name: str, sentence: str) -> None:
    """AX-87."""
    with pytest.raises(TaktError) as caught:
        parse(name)
    assert str(caught.value).startswith(sentence)


def test_options_that_are_no_numbers_stay_texts() -> None:
    """AX-87."""
    assert parse("canopen:virtual:a?x=--5&y=-5&z=²").options == {"x": "--5", "y": -5, "z": "²"}


def test_an_interface_that_is_not_there() -> None:
    """AX-87: one line, with what to look at."""
    with pytest.raises(TaktError, match=r"canopen:nocan7: the bus cannot be opened: .*ip link set nocan7 up"):
        CanLink(parse("canopen:nocan7"))


def test_an_adapter_that_is_unplugged() -> None:
    """AX-87: one line, whichever way it shows."""
    link = CanLink(parse(new_bus()))
    link.bus.shutdown()
    with pytest.raises(TaktError, match="nothing can be received: Cannot operate on a closed bus"):
        link.pump()
    with pytest.raises(TaktError, match="nothing can be sent: "):
        link.send(0x80, b"")


def test_without_the_packages_all_else_works(monkeypatch: pytest.MonkeyPatch) -> None:
    """The sentence says how to get them."""
    monkeypatch.setitem(sys.modules, "can", None)
    with pytest.raises(
        TaktError, match=r"needs the packages canopen and python-can: pip install 'takt-motion\[canopen\]'"
    ):
        parse("canopen:can0")


def test_metal_does_not_follow_simulated_time() -> None:
    """AX-87: said; nothing is switched on."""
    url, bus = new_url(), new_bus()
    text = machine(url, bus, 1)
    whole = described(text)
    with emulated(text):
        served = CanopenBus(whole["external"]["buses"][0], whole, lambda _: None)
        served._nodes[0].emulated = False  # a drive of metal has no such object
        with pytest.raises(TaktError, match=r"x1: node 1 is no emulated drive .* run taktd --pace real"):
            served.start("x1", real_time=False, period_s=PERIOD_S)
        with pytest.raises(TaktError, match="the engine's cycle is 1 ms, the machine file's 4 ms"):
            served.start("x1", real_time=True, period_s=0.001)
        served.close()


def test_what_is_on_a_bus_is_found() -> None:
    """AX-87: scan, and objects by SDO."""
    bus = new_bus()
    text = machine(new_url(), bus, 3)
    with emulated(text), CanLink(parse(bus)) as link, link.background():
        assert nodes_on(link, 0.3) == [1, 2, 3]
        sdo = Sdo(link, 2)
        assert sdo.read(0x1000) == 0x0002_0192
        assert sdo.find(0x5FFF) is None
        with pytest.raises(SdoError, match="0x1000:0 cannot be read: no answer"):
            Sdo(link, 9, 0.05).read(0x1000)


def test_a_lost_engine_lets_drives_brake() -> None:
    """AX-87: an engine that is killed in motion: quick stop along the ramp of the drive, then off."""
    text = machine(new_url(), new_bus(), 1)
    whole = described(text)
    with emulated(text) as emulation:
        bus = CanopenBus(whole["external"]["buses"][0], whole, lambda _: None)
        node = emulation.nodes[1].drive
        position, end_s = 0.0, time.monotonic() + 20
        while time.monotonic() < end_s and position < 30_000:
            told = drive.SetPoint(enable=True, position_counts=position, period_s=PERIOD_S)
            found = bus.exchange({"x1": told}, real_time=True)["x1"]
            if found is not None and found.drive_ready:
                position += 400
            time.sleep(PERIOD_S)
        assert node.machine.state is State.OPERATION_ENABLED
        assert node.read(od.VELOCITY) > 50_000
        seen = set()
        while time.monotonic() < end_s and node.machine.state is not State.READY_TO_SWITCH_ON:
            bus.idle(["x1"])
            seen.add(node.machine.state)
            time.sleep(PERIOD_S)
        assert State.QUICK_STOP_ACTIVE in seen
        assert abs(node.read(od.VELOCITY)) < 1000
        bus.close()


def switched_on(bus: CanopenBus) -> None:
    """Until its drive x1 follows; then it stands."""
    end_s = time.monotonic() + 20
    faulty = False
    while time.monotonic() < end_s:
        told = drive.SetPoint(enable=not faulty, period_s=PERIOD_S)  # a loaded computer may have lost SYNC
        found = bus.exchange({"x1": told}, real_time=True)["x1"]
        if found is not None and found.drive_ready:
            return
        faulty = found.drive_fault if found is not None else faulty
        time.sleep(PERIOD_S)
    raise AssertionError("never ready")


def test_a_drive_process_that_is_killed() -> None:
    """AX-87: nobody sends SYNC or signs of life any more: the drive has a fault of its own and is off."""
    text = machine(new_url(), new_bus(), 1)
    whole = described(text)
    with emulated(text) as emulation:
        bus = CanopenBus(whole["external"]["buses"][0], whole, lambda _: None)
        switched_on(bus)
        node = emulation.nodes[1].drive
        assert eventually(lambda: node.machine.state is State.FAULT, 10)
        assert node.machine.error_code in (0x8130, 0x8700)
        bus.close()


def test_noise_on_the_wire() -> None:
    """AX-87: frames of any length and kind, from anybody, end neither side; the drive is not switched off by them."""
    import can

    url, name = new_url(), new_bus()
    text = machine(url, name, 1)
    numbers = random.Random(1)
    # Not those that are commands by rights: NMT, SYNC, set points and objects of the drive.
    taken = {0x000, 0x080, 0x201, 0x301, 0x601}
    with emulated(text) as emulation, run(text, url) as (bus, _), takt.Engine(text) as engine:
        x = engine.axis("x1")
        x.power().wait()
        channel = parse(name).channel
        with can.Bus(interface="virtual", channel=channel) as stranger:
            for _ in range(2000):
                number = numbers.randrange(0x800)
                if number in taken or number in (0x081, 0x181, 0x281, 0x701):  # nor what comes from the drive itself
                    number = 0x7E5
                data = numbers.randbytes(numbers.randrange(9))
                stranger.send(can.Message(arbitration_id=number, data=data, is_extended_id=False))
            for number in (0x081, 0x281, 0x701, 0x000, 0x601):  # too short to be anything
                stranger.send(can.Message(arbitration_id=number, data=b"", is_extended_id=False))
        x.move_absolute(position=10.0).wait()
        assert x.actual_position == pytest.approx(10.0, abs=0.05)
        assert bus._link.malformed > 0
        assert emulation.link.malformed > 0
