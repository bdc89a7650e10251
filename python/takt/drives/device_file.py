"""Reads the device file of a drive's maker: EDS (CiA 306) for CANopen, ESI (ETG.2000) for EtherCAT. A machine file is
checked against it before any bus is opened (AX-87)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from configparser import Error as ConfigParserError
from configparser import RawConfigParser
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree

from takt.drives import objects as od
from takt.drives.axis import AXIS_MODES
from takt.drives.cia402 import Mode
from takt.drives.probe import latches
from takt.errors import TaktError

LARGEST_BYTES: Final = 64 << 20
MOST_SHOWN: Final = 160  # characters of a quotation from a file
DOMAIN, VAR, ARRAY, RECORD = 2, 7, 8, 9  # kinds of objects (CiA 301)
# Bits of the numeric data types (CiA 301): signed and unsigned integers of 8 to 64 bits, and reals.
EDS_BITS: Final = {
    **{0x02: 8, 0x03: 16, 0x04: 32, 0x10: 24, 0x12: 40, 0x13: 48, 0x14: 56, 0x15: 64},
    **{0x05: 8, 0x06: 16, 0x07: 32, 0x16: 24, 0x18: 40, 0x19: 48, 0x1A: 56, 0x1B: 64},
    **{0x08: 32, 0x11: 64},
}
_OBJECT = re.compile(r"([0-9a-f]{4})(?:sub([0-9a-f]{1,2}))?")


@dataclass(frozen=True)
class Described:
    """An object in a device file. bits: 0 if it has no fixed length. mappable: None if the file does not specify it."""

    name: str
    bits: int
    writable: bool
    mappable: bool | None = None


@dataclass
class DeviceFile:
    """One drive of a device file."""

    path: Path
    name: str
    vendor: int
    product: int
    objects: dict[tuple[int, int], Described] = field(default_factory=dict)
    pdos: dict[int, list[str]] = field(default_factory=dict)  # ESI: default mapping of each message


def read_device_file(path: Path, product: int | None = None) -> DeviceFile:
    """Reads a device file: ESI if the name ends in .xml, else EDS. Raises TaktError.

    product: product code of the drive if the file has several; None: its only one."""
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
    ini = RawConfigParser(inline_comment_prefixes=(";",))  # keys in lower case: they are case-insensitive
    try:
        ini.read_string(data.decode("utf-8-sig", "replace"), str(path))
        sections = {name.lower(): _Section(name, ini[name]) for name in ini.sections()}
        about = sections.get("deviceinfo", _Section("DeviceInfo", {}))
        name = about.text("ProductName") or "no name"
        found = DeviceFile(path, name, about.number("VendorNumber"), about.number("ProductNumber"))
        for title, section in sections.items():
            match = _OBJECT.fullmatch(title)
            if match:
                subindex = int(match[2], 16) if match[2] else None
                _add_eds(found, int(match[1], 16), subindex, section, sections)
    except (ConfigParserError, ValueError) as error:
        raise TaktError(f"{path}: no EDS file that can be read: {_line(error)}") from None
    if not found.objects:
        raise TaktError(f"{path}: no EDS file of a drive: it describes no object")
    return found


class _Section:
    """A section of an EDS file. Empty values count as missing."""

    def __init__(self, name: str, values: Mapping[str, str]) -> None:
        self.name, self._values = name, values

    def has(self, key: str) -> bool:
        return key.lower() in self._values

    def text(self, key: str) -> str:
        return self._values.get(key.lower(), "").strip()

    def number(self, key: str, default: int | None = 0) -> int:
        """Returns the number of a key. Raises ValueError if it is invalid, or missing while the default is None."""
        text = self.text(key)
        try:
            if not text and default is not None:
                return default
            return int(text, 0)
        except ValueError:
            found = f"found {text[:MOST_SHOWN]!r}" if text else "it is missing"
            raise ValueError(f"[{self.name}] {key}: expected a number such as 0x7, {found}") from None


def _add_eds(
    found: DeviceFile, index: int, subindex: int | None, section: _Section, sections: Mapping[str, _Section]
) -> None:
    """Adds an object, or all elements of an array that are described as one (CompactSubObj)."""
    kind = section.number("ObjectType", VAR)
    count = min(section.number("CompactSubObj"), 254) if kind in (ARRAY, RECORD) and subindex is None else 0
    if kind not in (VAR, DOMAIN) and not count:
        return  # its members have their own sections
    name, data_type, access = (
        section.text("ParameterName"),
        section.number("DataType", None),
        section.text("AccessType"),
    )
    if not section.has("AccessType") and kind != DOMAIN:
        raise ValueError(f"[{section.name}] AccessType: expected ro, wo, rw, rwr, rww or const, it is missing")
    own = sections.get(f"{data_type:x}sub1")  # type defined by the editor of the file: holds its base type
    bits = EDS_BITS.get(own.number("DefaultValue") if own and data_type > max(EDS_BITS) else data_type, 0)
    writable = "w" in access.lower() or not section.has("AccessType")
    one = Described(name, bits, writable, section.number("PDOMapping") != 0)
    if count:
        found.objects.setdefault((index, 0), Described(f"{name} number of entries", 8, True, False))
        names = sections.get(f"{index:04x}name", _Section("", {}))
        for i in range(1, count + 1):
            found.objects.setdefault((index, i), replace(one, name=names.text(str(i)) or f"{name} {i}"))
    else:
        found.objects[index, subindex or 0] = one


# --- ESI ---


def _esi(path: Path, data: bytes, product: int | None) -> DeviceFile:
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, LookupError, ValueError) as error:  # not XML, or of an unknown encoding
        raise TaktError(f"{path}: no XML that can be read: {_line(error)}") from None
    try:
        return _device(path, root, product)
    except (ValueError, AttributeError) as error:
        raise TaktError(f"{path}: no ESI file that can be read: {_line(error)}") from None


def _number(text: str | None) -> int:
    """Returns the number in a text such as "#x6040" or "24640"."""
    text = (text or "").strip().lower()
    try:
        return int(text[2:], 16) if text.startswith("#x") else int(text, 0)
    except ValueError:
        raise ValueError(f"expected a number such as #x6040 or 24640, found {text[:MOST_SHOWN]!r}") from None


def _number_at(element: ElementTree.Element, name: str) -> int:
    """Returns the number of a required element."""
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
    has_members = False
    for one in [] if kind is None else kind.iterfind("SubItem"):
        title = f"{name} {one.findtext('Name') or ''}"
        if one.findtext("SubIdx"):
            found.objects[index, _number_at(one, "SubIdx")] = _flags(one, title)
            has_members = True
            continue
        elements = types.get(one.findtext("Type"))
        array = None if elements is None else elements.find("ArrayInfo")
        if array is None:
            continue
        first, many = _number_at(array, "LBound"), _number_at(array, "Elements")
        whole = _flags(one, title)
        has_members |= many > 0
        for i in range(first, min(first + many, 256)):
            size = _number(one.findtext("BitSize") or "0") // many
            found.objects[index, i] = replace(whole, name=f"{title} {i}", bits=size if size <= 64 else 0)
    if not has_members:
        found.objects[index, 0] = _flags(entry, name)


def _flags(entry: ElementTree.Element, name: str) -> Described:
    access = (entry.findtext("Flags/Access") or "").strip()
    mapping = entry.findtext("Flags/PdoMapping")
    bits = _number(entry.findtext("BitSize") or "0")
    return Described(name, bits if bits <= 64 else 0, "w" in access, None if mapping is None else bool(mapping.strip()))


def _line(error: Exception) -> str:
    """Returns an error in one line of printable characters and of limited length: it may quote the file."""
    tells = isinstance(error, ValueError | ElementTree.ParseError) or type(error) is LookupError
    kind = "" if tells else f"{type(error).__name__}: "
    text = "".join(c if c.isprintable() else "?" for c in " ".join(str(error).split()))
    return kind + (text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]} ...")


# --- check of a machine file ---


def against(device: DeviceFile, described: Mapping[str, Any], axis: Mapping[str, Any]) -> list[str]:
    """Returns the mismatches between a device file and the entry of its drive in a machine file; empty if none."""
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
    """Returns the bus with vendor and product of its drives' device files added where they are not given. Raises
    TaktError for the first drive that does not match its file."""
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
