"""What the maker's file says of a drive: EDS (CiA 306) for CANopen, ESI (ETG.2000) for EtherCAT. A machine file is
checked against it before any bus is opened (AX-87)."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree

from takt.drives import objects as od
from takt.drives.axis import AXIS_MODES
from takt.drives.can_link import packages
from takt.drives.cia402 import Mode
from takt.drives.probe import latches
from takt.errors import TaktError

LARGEST_BYTES: Final = 64 << 20
MOST_SHOWN: Final = 160  # characters of what others say of a file
MISSING: Final = "EDS files need the package canopen: pip install 'takt-motion[canopen]'"


@dataclass(frozen=True)
class Described:
    """An object. bits: 0 where it has no fixed length. mappable: None where the file does not say."""

    name: str
    bits: int
    writable: bool
    mappable: bool | None = None


@dataclass
class DeviceFile:
    """One drive of a file."""

    path: Path
    name: str
    vendor: int
    product: int
    objects: dict[tuple[int, int], Described] = field(default_factory=dict)
    pdos: dict[int, list[str]] = field(default_factory=dict)  # ESI: what each message has by default


def read_device_file(path: Path, product: int | None = None) -> DeviceFile:
    """Reads EDS, or ESI where the name ends with .xml. Raises TaktError.

    product: which drive, where the file has several."""
    try:
        if path.stat().st_size > LARGEST_BYTES:
            raise TaktError(f"{path}: larger than {LARGEST_BYTES >> 20} MiB, no such file of a drive")
        data = path.read_bytes()
    except OSError as error:
        raise TaktError(f"{path}: cannot be read: {error.strerror}") from None
    if path.suffix.lower() == ".xml":
        return _esi(path, data, product)
    if path.suffix.lower() not in (".eds", ".dcf"):
        raise TaktError(f"{path}: expected a file .eds (CANopen) or .xml (EtherCAT: ESI)")
    return _eds(path, data)


# --- EDS ---


def _eds(path: Path, data: bytes) -> DeviceFile:
    _, canopen = packages(MISSING)
    text = io.StringIO(data.decode("utf-8-sig", "replace"))
    text.name = str(path)
    try:
        read = canopen.import_od(text, node_id=1)
    except Exception as error:  # whatever its reader raises at a bad file
        raise TaktError(f"{path}: no EDS file that can be read: {_line(error)}") from None
    if not len(read):
        raise TaktError(f"{path}: no EDS file of a drive: it describes no object")
    about = read.device_information
    found = DeviceFile(path, about.product_name or "no name", about.vendor_number or 0, about.product_number or 0)
    for index, entry in read.items():
        members = entry.values() if hasattr(entry, "values") else [entry]
        for one in members:
            bits = len(one) if one.data_type in canopen.objectdictionary.datatypes.NUMBER_TYPES else 0
            found.objects[index, one.subindex] = Described(one.name, bits, one.writable, bool(one.pdo_mappable))
    return found


# --- ESI ---


def _esi(path: Path, data: bytes, product: int | None) -> DeviceFile:
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, LookupError, ValueError) as error:  # what is no XML, or has no known encoding
        raise TaktError(f"{path}: no XML that can be read: {_line(error)}") from None
    try:
        return _device(path, root, product)
    except (ValueError, AttributeError) as error:
        raise TaktError(f"{path}: no ESI file that can be read: {_line(error)}") from None


def _number(text: str | None) -> int:
    """ "#x6040" or "24640"."""
    text = (text or "").strip().lower()
    try:
        return int(text[2:], 16) if text.startswith("#x") else int(text, 0)
    except ValueError:
        raise ValueError(f"expected a number such as #x6040 or 24640, found {text[:MOST_SHOWN]!r}") from None


def _number_at(element: ElementTree.Element, name: str) -> int:
    """The number of an element that must be there."""
    try:
        return _number(element.findtext(name))
    except ValueError as error:
        raise ValueError(f"{name} of {element.tag}: {error}") from None


def _device(path: Path, root: ElementTree.Element, product: int | None) -> DeviceFile:
    if root.tag != "EtherCATInfo":
        raise TaktError(f"{path}: expected an ESI file with EtherCATInfo, found {root.tag}")
    vendor = _number_at(root, "Vendor/Id")
    devices = {}
    for device in root.iterfind("Descriptions/Devices/Device"):
        code = device.find("Type")
        if code is not None and code.get("ProductCode"):
            devices[_number(code.get("ProductCode"))] = device  # the last one is the newest revision
    if not devices:
        raise TaktError(f"{path}: describes no drive: expected Descriptions/Devices/Device with a ProductCode")
    if product is None and len(devices) == 1:
        product = next(iter(devices))
    if product not in devices:
        has = ", ".join(f"0x{number:X}" for number in devices)
        wanted = "expected product: which one, as it has several" if product is None else f"no product 0x{product:X}"
        raise TaktError(f"{path}: {wanted}; it has {has}")
    device = devices[product]
    name = (device.findtext("Name") or device.findtext("Type") or "no name").strip()
    found = DeviceFile(path, name, vendor, product)
    for direction in ("RxPdo", "TxPdo"):
        for pdo in device.iterfind(direction):
            entries = [(_number_at(e, "Index"), _number(e.findtext("SubIndex") or "0")) for e in pdo.iterfind("Entry")]
            found.pdos[_number_at(pdo, "Index")] = [f"0x{i:04X}:{s}" for i, s in entries if i]
    for dictionary in device.iter("Dictionary"):
        types = {kind.findtext("Name"): kind for kind in dictionary.iterfind("DataTypes/DataType")}
        for entry in dictionary.iterfind("Objects/Object"):
            _add(found, entry, types)
    return found


def _add(found: DeviceFile, entry: ElementTree.Element, types: Mapping[str | None, ElementTree.Element]) -> None:
    index = _number_at(entry, "Index")
    name = (entry.findtext("Name") or "").strip()
    kind = types.get(entry.findtext("Type"))
    members = [] if kind is None else [one for one in kind.iterfind("SubItem") if one.findtext("SubIdx")]
    for one in members:
        found.objects[index, _number_at(one, "SubIdx")] = _flags(one, f"{name} {one.findtext('Name') or ''}")
    if not members:
        found.objects[index, 0] = _flags(entry, name)


def _flags(entry: ElementTree.Element, name: str) -> Described:
    access = (entry.findtext("Flags/Access") or "").strip()
    mapping = entry.findtext("Flags/PdoMapping")
    bits = _number(entry.findtext("BitSize") or "0")
    return Described(name, bits if bits <= 64 else 0, "w" in access, None if mapping is None else bool(mapping.strip()))


def _line(error: Exception) -> str:
    """Of any error, in printable characters and not too long: it may quote the file."""
    tells = isinstance(error, ValueError | ElementTree.ParseError) or type(error) is LookupError
    kind = "" if tells else f"{type(error).__name__}: "
    text = "".join(c if c.isprintable() else "?" for c in " ".join(str(error).split()))
    return kind + (text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]} ...")


# --- a machine file against it ---


def against(device: DeviceFile, described: Mapping[str, Any], axis: Mapping[str, Any]) -> list[str]:
    """What does not fit between a file and the entry of its drive in a machine file."""
    if not device.objects:
        return []  # ESI files need not have a dictionary
    problems = []
    for entry in _needed(described, AXIS_MODES[axis["drive"]["mode"]]):
        there = device.objects.get((entry.index, 0))
        what = f"0x{entry.index:04X} ({entry.name})"
        if there is None:
            problems.append(f"it has no {what}, which is needed")
        elif there.bits and there.bits != entry.bits:
            problems.append(f"{what} has {there.bits} bits, expected {entry.bits}")
        elif there.mappable is False:
            problems.append(f"{what} cannot be mapped into process data")
    for one in described["start_up"]:
        index, subindex = (int(text, 0) for text in one["object"].split(":"))
        there = device.objects.get((index, subindex))
        what = f"start_up: 0x{index:04X}:{subindex}"
        if there is None:
            problems.append(f"{what}: it has no such object")
        elif not there.writable:
            problems.append(f"{what} ({there.name}) cannot be written")
        elif there.bits and there.bits != one["bits"]:
            problems.append(f"{what} ({there.name}) has {there.bits} bits, the machine file writes {one['bits']}")
    return problems


def _needed(described: Mapping[str, Any], mode: Mode) -> list[od.Object]:
    target = od.TARGET_POSITION if mode is Mode.CYCLIC_POSITION else od.TARGET_VELOCITY
    needed = [od.CONTROL_WORD, od.STATUS_WORD, od.POSITION, target]
    if described.get("homing"):
        needed += [od.MODE, od.MODE_DISPLAY]
    number = described["probe_latch"]
    return needed + ([od.PROBE_FUNCTION, od.PROBE_STATUS, *latches(number)] if number else [])


def with_device_files(bus: Mapping[str, Any], machine: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The bus with vendor and product of the files of its drives, where they are not given. Raises TaktError with the
    first drive that does not fit its file."""
    axes = {axis["name"]: axis for axis in machine["axes"]}
    drives = []
    for one in bus["drives"]:
        name = one.get("device_file")
        if name is not None:
            product = one.get("product")
            device = read_device_file(folder / name, None if product is None else int(product, 16))
            for key, value in (("vendor", device.vendor), ("product", device.product)):
                given = one.get(key)
                if given is not None and value and int(given, 16) != value:
                    raise TaktError(f"{bus['bus']}: {one['axis']}: {key} {given}, but {name} is for 0x{value:X}")
                if given is None and value:
                    one = {**one, key: f"0x{value:X}"}
            problems = against(device, one, axes[one["axis"]])
            if problems:
                raise TaktError(f"{bus['bus']}: {one['axis']}: {name}: {'; '.join(problems)}")
        drives.append(one)
    return {**bus, "drives": drives}
