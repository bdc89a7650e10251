"""`takt drives`: scan a field bus, run its drives as the drive process of an engine, and emulate drives."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from takt.counted import counted
from takt.drive import WATCHDOG, Plant
from takt.drives import objects as od
from takt.drives.can_link import CanLink, Sdo, parse
from takt.drives.canopen_bus import CanopenBus, nodes_on
from takt.drives.cia402 import MODE_NAMES, Mode, state_of, supported_modes
from takt.drives.device_file import read_device_file, with_device_files
from takt.drives.emulation import Emulation, bus_of, emulated_link, emulated_nodes
from takt.drives.emulation_commands import read_commands
from takt.drives.error_texts import error_text
from takt.drives.ethercat_bus import EthercatBus
from takt.drives.ethercat_emulation import EthercatEmulation, emulated_slaves
from takt.drives.ethercat_link import Wire, is_ethercat, other_end
from takt.drives.ethercat_link import parse as parse_ethercat
from takt.drives.sdo import Objects, SdoError
from takt.errors import TaktError
from takt.network import network_of
from takt.yaml_text import to_json

FILE = click.Path(path_type=Path)
BUS = click.option(
    "--bus", required=True, metavar="BUS", help="canopen:CHANNEL, canopen:INTERFACE:CHANNEL or ethercat:INTERFACE."
)
BITRATE = click.option(
    "--bitrate", default=1_000_000, show_default=True, type=click.IntRange(1), help="bit/s, on CANopen."
)
NONE_THERE = 1


def _say(sentence: str) -> None:
    click.echo(sentence, err=True)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
def drives() -> None:
    """Real drives on a field bus (CiA 402): scan, run them for an engine, emulate them."""


@drives.command()
@BUS
@BITRATE
def scan(bus: str, bitrate: int) -> int:
    """List the nodes of a bus, or the slaves: type, maker, state."""
    if is_ethercat(bus):
        return _scan_ethercat(bus)
    with CanLink(parse(bus), bitrate) as link, link.background():
        found = nodes_on(link)
        for node in found:
            print(_line_on(Sdo(link, node)))
        print(f"{bus}: {counted(len(found), 'node')}", file=sys.stderr)
    return 0 if found else NONE_THERE


def _scan_ethercat(bus: str) -> int:
    with Wire(bus) as wire:
        found = wire.find()
        for position, slave in enumerate(found, start=1):
            print(_line_of_slave(wire, slave, position))
        print(f"{bus}: {counted(len(found), 'slave')}", file=sys.stderr)
    return 0 if found else NONE_THERE


def _line_of_slave(wire: Wire, slave: Any, position: int) -> str:
    """Returns the line of a slave, also of one without objects, such as a coupler."""
    alias = wire.alias(slave)
    sdo = wire.sdo(slave, position)
    sdo.called += f" (alias {alias})" if alias else ""
    try:
        return _line_on(sdo)
    except SdoError:
        return (
            f"{sdo.called}: {slave.name or 'no name'}, vendor 0x{slave.man:X}, product 0x{slave.id:X}, revision "
            f"0x{slave.rev:X}: no objects"
        )


def _line_on(sdo: Objects) -> str:
    device = sdo.read(0x1000)
    said = f"{sdo.called}: {_text(sdo, 0x1008) or 'no name'}, {_identity(sdo)}"
    if device & 0xFFFF != 402:
        return f"{said}, device type 0x{device:08X}: no drive of CiA 402"
    state = state_of(sdo.find(od.STATUS_WORD.index) or 0)
    return f"{said}, {state.value if state else 'no state'}, {_error(sdo)}"


def _identity(sdo: Objects) -> str:
    vendor, product, revision = (sdo.find(0x1018, subindex) for subindex in (1, 2, 3))
    return ", ".join(
        f"{name} 0x{value:X}"
        for name, value in (("vendor", vendor), ("product", product), ("revision", revision))
        if value is not None
    )


def _text(sdo: Objects, index: int) -> str:
    try:
        return sdo.read_bytes(index).decode("ascii", "replace").strip("\0 ")
    except SdoError:
        return ""


def _error(sdo: Objects) -> str:
    code = sdo.find(od.ERROR_CODE.index)
    return error_text(code) if code else "no error"


@drives.command()
@BUS
@BITRATE
@click.option("--node", "number", type=click.IntRange(1, 127), help="CANopen: address of the drive.")
@click.option("--position", type=click.IntRange(1, 65535), help="EtherCAT: place of the drive, from 1.")
def info(bus: str, bitrate: int, number: int | None, position: int | None) -> int:
    """Print all that a drive reports of itself: maker, modes, state, scaling, process data."""
    if is_ethercat(bus):
        return _info_ethercat(bus, position)
    if number is None or position is not None:
        raise click.UsageError("give the --node of the drive on CANopen, its --position on EtherCAT")
    with CanLink(parse(bus), bitrate) as link, link.background():
        sdo = Sdo(link, number)
        try:
            print(_line_on(sdo))
        except SdoError as error:
            raise TaktError(f"{bus}: node {number}: {error}") from None
        for name, value in _facts(sdo):
            print(f"  {name}: {value}")
    return 0


def _info_ethercat(bus: str, position: int | None) -> int:
    if position is None:
        raise click.UsageError("give the --node of the drive on CANopen, its --position on EtherCAT")
    with Wire(bus) as wire:
        found = wire.find()
        if position > len(found):
            raise TaktError(f"{bus}: no slave at position {position}; there are {len(found)}")
        slave = found[position - 1]
        print(_line_of_slave(wire, slave, position))
        for name, value in _facts(wire.sdo(slave, position)):
            print(f"  {name}: {value}")
    return 0


def _facts(sdo: Objects) -> Iterator[tuple[str, str]]:
    modes = sdo.find(od.SUPPORTED_MODES.index)
    if modes is not None:
        yield "modes", ", ".join(supported_modes(modes))
    mode = sdo.find(od.MODE_DISPLAY.index, signed=True)
    if mode is not None:
        yield "mode", MODE_NAMES.get(Mode(mode), str(mode)) if mode in list(Mode) else str(mode)
    for entry in od.OBJECTS.values():
        if entry in (od.MODE, od.MODE_DISPLAY, od.SUPPORTED_MODES):
            continue
        value = sdo.find(entry.index, signed=entry.signed)
        if value is not None:
            yield f"0x{entry.index:04X} {entry.name}", f"0x{value:04X}" if "word" in entry.name else str(value)
    for index, name in ((0x608F, "encoder increments / revolutions"), (0x6091, "gear"), (0x6092, "feed / revolutions")):
        pair = [sdo.find(index, subindex) for subindex in (1, 2)]
        if None not in pair:
            yield f"0x{index:04X} {name}", f"{pair[0]} / {pair[1]}"
    for index in (0x1400, 0x1401, 0x1402, 0x1403, 0x1800, 0x1801, 0x1802, 0x1803):
        cob_id = sdo.find(index, 1)
        if cob_id is not None and not cob_id >> 31:
            count = sdo.find(index + 0x200, 0) or 0
            mapped = [sdo.find(index + 0x200, k) or 0 for k in range(1, count + 1)]
            kind = f"{'RPDO' if index < 0x1800 else 'TPDO'}{(index & 0xF) + 1}"
            objects = " ".join(f"0x{word >> 16:04X}:{word & 0xFF}" for word in mapped)
            yield kind, f"0x{cob_id & 0x7FF:03X}, transmission {sdo.find(index, 2)}: {objects}"
    for assigned, kind in ((0x1C12, "outputs"), (0x1C13, "inputs")):
        for k in range(1, (sdo.find(assigned, 0) or 0) + 1):
            index = sdo.find(assigned, k) or 0
            mapped = [sdo.find(index, n) or 0 for n in range(1, (sdo.find(index, 0) or 0) + 1)]
            yield kind, f"0x{index:04X}: {' '.join(f'0x{word >> 16:04X}:{word >> 8 & 0xFF}' for word in mapped)}"


@drives.command("file")
@click.argument("file", type=FILE)
@click.option("--product", metavar="NUMBER", help="ESI with several drives: which one, as 0x10.")
def device_file(file: Path, product: str | None) -> int:
    """Print the contents of the maker's file (EDS, ESI) of a drive: maker, and which objects of CiA 402 it has."""
    try:
        number = None if product is None else int(product, 0)
    except ValueError:
        raise click.UsageError(f"--product: expected a number such as 0x10, found {product!r}") from None
    device = read_device_file(file, number)
    print(f"{device.name}: vendor 0x{device.vendor:X}, product 0x{device.product:X}")
    for entry in od.OBJECTS.values():
        there = device.objects.get((entry.index, 0))
        if there is not None:
            mapped = {True: ", mappable", False: ", not mappable", None: ""}[there.mappable]
            print(f"  0x{entry.index:04X} {entry.name}: {there.bits} bits{mapped}")
    for index, mapping in device.pdos.items():
        print(f"  PDO 0x{index:04X}: {' '.join(mapping)}")
    return 0


@contextmanager
def until_signal(stop: Callable[[], None]) -> Iterator[None]:
    """Calls `stop` on SIGINT and SIGTERM while the context is open."""
    before = [signal.signal(number, lambda *_: stop()) for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        yield
    finally:
        for number, handler in zip((signal.SIGINT, signal.SIGTERM), before, strict=True):
            signal.signal(number, handler)


def _described(machine: Path) -> tuple[bytes, str, Mapping[str, Any]]:
    import json

    from takt import _core
    from takt.engine import read_machine

    text, file_name = read_machine(machine)
    return text, file_name, json.loads(_core.load_machine(text, file_name))


@drives.command()
@click.argument("machine", type=FILE)
@click.option("--bus", metavar="BUS", help="Only this bus of the machine file [all].")
@click.option("--url", help="LCM network of the engine [machine file].")
@click.option("--key", type=FILE, help="File with the key of the engine [TAKT_KEY_FILE, else none].")
@click.option(
    "--watchdog", default=WATCHDOG, show_default=True, type=click.IntRange(1), help="Periods without a set point."
)
def run(machine: Path, bus: str | None, url: str | None, key: Path | None, watchdog: int) -> int:
    """Run the drives of a machine file: the process of its field buses for the engine (taktd MACHINE)."""
    _, file_name, described = _described(machine)
    buses: list[CanopenBus | EthercatBus] = []
    try:
        for one in bus_of(described, file_name, bus):
            kind = EthercatBus if is_ethercat(one["bus"]) else CanopenBus
            buses.append(kind(with_device_files(one, described, machine.parent), described, _say))
        plant = Plant({}, url or network_of(described), buses=buses, watchdog=watchdog, key=key, say=_say)
        _say(f"ready: {', '.join(axis for one in buses for axis in one.axes)}")
        with until_signal(plant.stop):
            plant.run()
    finally:
        for each in buses:
            each.close()
    for each in buses:
        _say(each.summary())
    return 0


@drives.command()
@click.argument("machine", type=FILE, required=False)
@click.option("--bus", metavar="BUS", help="Only this bus of the machine file [all]; without a file: where.")
@click.option("--nodes", default=1, show_default=True, type=click.IntRange(1, 126), help="Without a file: how many.")
def emulate(machine: Path | None, bus: str | None, nodes: int) -> int:
    """Emulate drives without hardware: those of a machine file, or a number of them on a bus.

    Commands are read from standard input: fault NODE CODE [lasting], clear NODE, cut NODE|all, join NODE|all, power
    NODE off|on, stall NODE, jump NODE INCREMENTS, show, quit; on EtherCAT lose PERCENT, too, and a NODE is a
    position."""
    if machine is None:
        if bus is None:
            raise click.UsageError("give a machine file, or --bus with --nodes")
        text, file_name, described = standing_alone(bus, nodes)
    else:
        text, file_name, described = _described(machine)
    chosen = bus_of(described, file_name, bus)
    if len(chosen) > 1:
        raise TaktError(f"{file_name} has {len(chosen)} buses: choose one with --bus")
    if is_ethercat(chosen[0]["bus"]):
        return _emulate_ethercat(chosen[0], described, text, file_name, own=machine is None)
    with emulated_link(chosen[0]["bus"]) as link:
        emulation = Emulation(link, emulated_nodes(chosen[0], described, text, file_name), _say)
        _say(f"{chosen[0]['bus']}: {counted(len(emulation.nodes), 'emulated drive')}")
        read_commands(emulation)
        with until_signal(emulation.stop):
            emulation.run()
    return 0


def _emulate_ethercat(
    bus: Mapping[str, Any], described: Mapping[str, Any], text: bytes, file_name: str, *, own: bool
) -> int:
    """Emulates the slaves of a bus. own: the bus names this end of the wire; else that of the master, as in a machine
    file."""
    name = parse_ethercat(bus["bus"])
    name = name if own else other_end(name)
    ring = other_end(bus["ring"]) if bus.get("ring") else None
    slaves = emulated_slaves(bus, described, text, file_name)
    with EthercatEmulation(name, slaves, _say, ring) as emulation:
        _say(f"ethercat:{name}: {counted(len(emulation.nodes), 'emulated drive')}")
        read_commands(emulation)
        with until_signal(emulation.stop):
            emulation.run()
    return 0


def standing_alone(bus: str, nodes: int) -> tuple[bytes, str, Mapping[str, Any]]:
    """Returns text, file name and description of a machine with this number of drives on a bus."""
    import json

    from takt import _core

    lines = ["name: emulated", "axes:"]
    limits = "{velocity: 500, acceleration: 5000, jerk: 100000}"
    lines += [
        f"  - {{name: x{k}, limits: {limits}, encoder: {{increments_per_unit: 1000}}}}" for k in range(1, nodes + 1)
    ]
    lines += ["external:", f"  buses:\n    - bus: {to_json(bus)}", "      drives:"]
    key = "position" if is_ethercat(bus) else "node"
    lines += [f"        - {{axis: x{k}, {key}: {k}}}" for k in range(1, nodes + 1)]
    text = "\n".join(lines).encode()
    return text, "emulated", json.loads(_core.load_machine(text, "emulated"))
