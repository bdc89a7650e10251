"""AX-87: EDS and ESI files of drives against the machine file."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from buses import described, emulated, machine, new_bus
from takt.cli import main
from takt.drives.device_file import read_device_file, with_device_files
from takt.errors import TaktError

URL = "udpm://239.255.76.67:7667?ttl=0"
OBJECTS = {
    0x6040: ("Controlword", 6, "rww", 1),
    0x6041: ("Statusword", 6, "ro", 1),
    0x6064: ("Position actual value", 4, "ro", 1),
    0x607A: ("Target position", 4, "rww", 1),
    0x6085: ("Quick stop deceleration", 7, "rw", 0),
}
BITS = {4: 32, 6: 16, 7: 32}


def eds(**changed: tuple[str, int, str, int] | None) -> str:
    """Objects as "x6040": name, data type, access, mappable; None: it has none."""
    objects = {f"x{index:04X}": one for index, one in OBJECTS.items()} | changed
    lines = ["[DeviceInfo]", "VendorName=Maker", "VendorNumber=0x2E1", "ProductName=Servo 7", "ProductNumber=0x10"]
    for name, one in objects.items():
        if one is not None:
            title, kind, access, mappable = one
            lines += [f"[{name[1:]}]", f"ParameterName={title}", "ObjectType=0x7", f"DataType={kind}"]
            lines += [f"AccessType={access}", f"PDOMapping={mappable}"]
    return "\n".join(lines) + "\n"


def esi(products: tuple[int, ...] = (0x10,)) -> str:
    objects = "".join(
        f"<Object><Index>#x{index:04x}</Index><Name>{title}</Name><Type>DINT</Type><BitSize>{BITS[kind]}</BitSize>"
        f"<Flags><Access>{access[:2]}</Access>{'<PdoMapping>RT</PdoMapping>' * mappable}</Flags></Object>"
        for index, (title, kind, access, mappable) in OBJECTS.items()
    )
    devices = "".join(
        f'<Device><Type ProductCode="#x{code:08X}" RevisionNo="#x1">S</Type><Name>Servo {code}</Name>'
        f"<RxPdo><Index>#x1600</Index><Entry><Index>#x6040</Index><SubIndex>0</SubIndex><BitLen>16</BitLen></Entry>"
        f"<Entry><Index>#x0</Index><BitLen>8</BitLen></Entry></RxPdo>"
        f"<Profile><Dictionary><Objects>{objects}</Objects></Dictionary></Profile></Device>"
        for code in products
    )
    return (
        f"<EtherCATInfo><Vendor><Id>#x2E1</Id></Vendor><Descriptions><Devices>{devices}</Devices></Descriptions>"
        f"</EtherCATInfo>"
    )


def wrong(folder: Path, keys: str = "device_file: d.eds") -> str:
    whole = described(machine(URL, "canopen:can0", 1, drive_keys=keys))
    with pytest.raises(TaktError) as caught:
        with_device_files(whole["external"]["buses"][0], whole, folder)
    return str(caught.value).replace(f"{folder}/", "")


def test_an_eds_says_which_drive_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Vendor and product are checked on the bus as if they were in the machine file."""
    (tmp_path / "d.eds").write_text(eds())
    bus = new_bus()
    text = machine(URL, bus, 1, drive_keys="device_file: d.eds")
    whole = described(text)
    one = with_device_files(whole["external"]["buses"][0], whole, tmp_path)["drives"][0]
    assert (one["vendor"], one["product"]) == ("0x2E1", "0x10")
    (tmp_path / "m.yaml").write_text(text)
    with emulated(text):
        assert main(["drives", "run", str(tmp_path / "m.yaml")]) == 2
    assert "x1: node 1: expected vendor 0x2E1, found 0x0" in capsys.readouterr().err
    assert main(["drives", "file", str(tmp_path / "d.eds")]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "Servo 7: vendor 0x2E1, product 0x10"
    assert "  0x6040 control word: 16 bits, mappable" in said
    assert "  0x6085 quick stop deceleration: 32 bits, not mappable" in said


@pytest.mark.parametrize(
    ("changed", "keys", "sentence"),
    [
        ({"x607A": None}, "", "it has no 0x607A (target position), which is needed"),
        ({"x6064": ("P", 3, "ro", 1)}, "", "0x6064 (position actual value) has 16 bits, expected 32"),
        ({"x6041": ("S", 6, "ro", 0)}, "", "0x6041 (status word) cannot be mapped into process data"),
        ({}, ", probe_latch: 1", "it has no 0x60B8 (touch probe function), which is needed; it has no 0x60B9"),
        ({}, ', start_up: [{object: "0x6086:0", value: 1}]', "start_up: 0x6086:0: it has no such object"),
        ({}, ', start_up: [{object: "0x6041:0", value: 1}]', "start_up: 0x6041:0 (Statusword) cannot be written"),
        (
            {},
            ', start_up: [{object: "0x6085:0", value: 1, bits: 16}]',
            "start_up: 0x6085:0 (Quick stop deceleration) has 32 bits, the machine file writes 16",
        ),
    ],
)
def test_what_does_not_fit(
    tmp_path: Path, changed: dict[str, tuple[str, int, str, int] | None], keys: str, sentence: str
) -> None:
    (tmp_path / "d.eds").write_text(eds(**changed))
    assert wrong(tmp_path, f"device_file: d.eds{keys}").startswith(f"canopen:can0: x1: d.eds: {sentence}")


def test_a_file_for_another_drive(tmp_path: Path) -> None:
    (tmp_path / "d.eds").write_text(eds())
    assert wrong(tmp_path, 'device_file: d.eds, vendor: "0x5"') == (
        "canopen:can0: x1: vendor 0x5, but d.eds is for 0x2E1"
    )


def test_an_esi(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One drive of several by its product; process data by default."""
    file = tmp_path / "d.xml"
    file.write_text(esi())
    found = read_device_file(file)
    assert (found.name, found.vendor, found.product, found.pdos) == ("Servo 16", 0x2E1, 0x10, {0x1600: ["0x6040:0"]})
    assert found.objects[0x607A, 0].mappable
    file.write_text(esi((0x10, 0x11)))
    assert main(["drives", "file", str(file)]) == 2
    assert "d.xml: expected product: which one, as it has several; it has 0x10, 0x11" in capsys.readouterr().err
    assert main(["drives", "file", str(file), "--product", "0x11"]) == 0
    assert capsys.readouterr().out.startswith("Servo 17: vendor 0x2E1, product 0x11\n")
    with pytest.raises(TaktError, match="no product 0x12; it has 0x10, 0x11"):
        read_device_file(file, 0x12)


ARRAY = """[607D]
ParameterName=Range
ObjectType=0x8
DataType=0x4
AccessType=rw
CompactSubObj=2
PDOMapping=0
"""
ESI_ARRAY = (
    "<Dictionary><DataTypes><DataType><Name>A</Name><BaseType>DINT</BaseType><BitSize>64</BitSize>"
    "<ArrayInfo><LBound>1</LBound><Elements>2</Elements></ArrayInfo></DataType><DataType><Name>R</Name>"
    "<BitSize>80</BitSize><SubItem><SubIdx>0</SubIdx><Name>N</Name><Type>USINT</Type><BitSize>8</BitSize>"
    "<Flags><Access>ro</Access></Flags></SubItem><SubItem><Name>Elements</Name><Type>A</Type><BitSize>64</BitSize>"
    "<Flags><Access>rw</Access></Flags></SubItem></DataType></DataTypes>"
    "<Objects><Object><Index>#x607d</Index><Name>Range</Name><Type>R</Type><BitSize>80</BitSize></Object>"
)


@pytest.mark.parametrize("name", ["d.eds", "d.xml"])
def test_elements_of_arrays(tmp_path: Path, name: str) -> None:
    """AX-87: arrays described as one have an object for each element."""
    text = eds() + ARRAY if name == "d.eds" else esi().replace("<Dictionary><Objects>", ESI_ARRAY)
    profile = text[text.find("<Profile>") : text.find("</Device>")]
    if name == "d.xml":
        text = text.replace(profile, 2 * profile)  # one for each of two modules
    (tmp_path / name).write_text(text)
    objects = read_device_file(tmp_path / name).objects
    assert [(sub, objects[0x607D, sub].bits) for index, sub in objects if index == 0x607D] == [(0, 8), (1, 32), (2, 32)]
    assert objects[0x607D, 2].writable
    assert "start_up: 0x607D:3: it has no such object" in wrong(
        tmp_path, f'device_file: {name}, start_up: [{{object: "0x607D:1", value: 1}}, {{object: "0x607D:3", value: 1}}]'
    )


@pytest.mark.parametrize(
    ("old", "new", "vendor"),
    [
        ("VendorNumber=0x2E1", "VendorNumber=", 0),
        ("[DeviceInfo]", "[Comments]\nLines=5\nline1=x\n[DummyUsage]\nDummy0001=x\n[DEVICEINFO]", 0x2E1),
        ("PDOMapping", "PdoMapping", 0x2E1),
        ("ObjectType=0x7", "objecttype=", 0x2E1),
        ("[DeviceInfo]", "[6075]\nParameterName=P\nDataType=7\nAccessType=\n[DeviceInfo]", 0x2E1),
        ("[DeviceInfo]", f"{ARRAY}[607Dsub1]\nDataType=4\nAccessType=rw\n[DeviceInfo]", 0x2E1),
    ],
)
def test_spellings_of_eds_files(tmp_path: Path, old: str, new: str, vendor: int) -> None:
    """AX-87: neither the case of letters nor what says nothing of objects matters; empty values are as none."""
    file = tmp_path / "d.eds"
    file.write_text(eds().replace(old, new))
    found = read_device_file(file)
    assert (found.name, found.vendor, found.objects[0x6040, 0].bits) == ("Servo 7", vendor, 16)
    assert found.objects[0x6040, 0].mappable


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("d.eds", None, "d.eds: cannot be read: No such file or directory"),
        ("d.txt", "", "d.txt: expected a file .eds (CANopen) or .xml (EtherCAT: ESI)"),
        ("d.eds", "no section", "d.eds: no EDS file that can be read: MissingSectionHeaderError"),
        (
            "d.eds",
            "[6040]\nParameterName=C\nObjectType=0x7\nDataType=x\n",
            "d.eds: no EDS file that can be read: [6040] DataType: expected a number such as 0x7, found 'x'",
        ),
        ("d.eds", "[6040]\nParameterName=C\nDataType=6\n", "d.eds: no EDS file that can be read: [6040] AccessType: e"),
        (
            "d.eds",
            "[6040]\nAccessType=ro\n",
            "d.eds: no EDS file that can be read: [6040] DataType: expected a number such as 0x7, it is missing",
        ),
        (
            "d.eds",
            eds().replace("=0x2E1", "=none"),
            "d.eds: no EDS file that can be read: [DeviceInfo] VendorNumber: "
            "expected a number such as 0x7, found 'none'",
        ),
        ("d.xml", "<a>", "d.xml: no XML that can be read: no element found"),
        ("d.xml", "<a/>", "d.xml: expected an ESI file with EtherCATInfo, found a"),
        (
            "d.xml",
            "<EtherCATInfo/>",
            "d.xml: no ESI file that can be read: Vendor/Id of EtherCATInfo: expected a number such as #x6040 or "
            "24640, found ''",
        ),
        ("d.xml", "<EtherCATInfo><Vendor><Id>1</Id></Vendor></EtherCATInfo>", "d.xml: describes no drive: expected De"),
        ("d.xml", '<?xml version="1.0" encoding="klingon"?><a/>', "d.xml: no XML that can be read: unknown encoding"),
        ("d.xml", '<?xml version="1.0" encoding="utf-16"?><a/>', "d.xml: no XML that can be read: "),
        ("d.eds", "", "d.eds: no EDS file of a drive: it describes no object"),
        ("d.eds", "[FileInfo]\nx=1\n", "d.eds: no EDS file of a drive: it describes no object"),
    ],
)
def test_bad_files(tmp_path: Path, name: str, text: str | None, sentence: str) -> None:
    """One line, with the file."""
    if text is not None:
        (tmp_path / name).write_text(text)
    assert wrong(tmp_path, f"device_file: {name}").startswith(sentence)


@pytest.mark.parametrize("name", ["d.eds", "d.xml"])
def test_what_is_no_text(tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """A line that can be read, and is not the file."""
    (tmp_path / name).write_bytes(random.Random(4).randbytes(5000))
    said = wrong(tmp_path, f"device_file: {name}")
    assert said.isprintable()
    assert len(said) < 300
    assert capsys.readouterr().err == ""
