"""AX-87, EN-26: field buses in machine files, checked with line and key."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml
from buses import described, machine
from takt import _core
from takt.cli import main
from takt.errors import ConfigError

URL = "udpm://239.255.76.67:7667?ttl=0"


def problems(text: str) -> list[str]:
    with pytest.raises(ConfigError) as caught:
        _core.load_machine(text.encode(), "m.yaml")
    return list(caught.value.problems)


def test_axes_on_a_bus_are_external_drives() -> None:
    """AX-87: without being named under drives; what is written there counts."""
    found = described(machine(URL, "canopen:can0", 3, bus_keys="missing_cycles: 7"))["external"]
    assert found["drives"] == [{"axis": f"x{k}", "missing_cycles": 7} for k in (1, 2, 3)]
    assert found["buses"][0]["drives"][1]["inputs"] == {
        "limit_negative": 0,
        "limit_positive": 1,
        "reference": 2,
        "touch_probe": -1,
    }
    text = machine(URL, "canopen:can0", 2).replace("  buses:", "  drives: [{axis: x2, missing_cycles: 20}]\n  buses:")
    assert described(text)["external"]["drives"] == [
        {"axis": "x2", "missing_cycles": 20},
        {"axis": "x1", "missing_cycles": 5},
    ]


def test_all_that_may_be_given() -> None:
    """AX-87."""
    keys = (
        'vendor: "0x2E1", product: "0x10", scaling: {increments_per_revolution: 65536, gear_motor: 10, feed: 5}, '
        "velocity_factor: 0.5, rated_torque: 1.27, inputs: {limit_negative: -1, touch_probe: 16}, "
        'start_up: [{object: "0x6098:0", value: -3, bits: 8}], ready_within_s: 20'
    )
    found = described(machine(URL, "canopen:can0", 1, drive_keys=keys, bus_keys="bitrate: 0"))["external"]["buses"][0]
    one = found["drives"][0]
    assert found["bitrate"] == 0
    assert one["inputs"]["limit_negative"] == -1
    assert one["scaling"]["gear_shaft"] == 1
    assert one["start_up"] == [{"object": "0x6098:0", "value": -3, "bits": 8}]


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('"canopen:can0"', '"profibus:1"', "m.yaml:14:12: external.buses[0].bus: expected canopen:CHANNEL or"),
        (
            "axis: x2",
            "axis: x3",
            "m.yaml:17:18: external.buses[0].drives[1].axis: expected the name of an axis, found 'x3'",
        ),
        ("axis: x2", "axis: x1", "external.buses[0].drives[1].axis: expected each axis once, found 'x1' again"),
        ("node: 2", "node: 1", "external.buses[0].drives[1].node: expected each address once on a bus, found 1 again"),
        ("node: 2", "node: 127", "node: expected another address than that of this end of the bus, found 127"),
        ("node: 2", "node: 128", "external.buses[0].drives[1].node: expected a whole number from 1 to 127, found 128"),
        (
            "node: 2",
            "nodes: 2",
            "m.yaml:17:22: external.buses[0].drives[1]: expected a known key, found 'nodes'; did you mean node?",
        ),
        (
            "  - name: x2\n",
            "  - name: x2\n    drive: {torque_offset: {inertia: 0.1}}\n",
            "drives[1].axis: expected an axis without drive: torque_offset, which is not sent to drives on a bus",
        ),
        ("drives:", "ring: eth2\n      drives:", "buses[0].ring: expected this key on a bus ethercat:INTERFACE only"),
        (
            "node: 2",
            "node: 2, inputs: {limit_negative: 4, limit_positive: 4}",
            "inputs.limit_positive: expected another bit than that of limit_negative, found 4 again",
        ),
        (
            "node: 2",
            "node: 2, scaling: {increments_per_revolution: 1e300, gear_motor: 1e300, feed: 1}",
            "drives[1].scaling: expected fewer than 2147483647 increments of the drive in a cycle at the velocity",
        ),
        (
            "node: 2",
            "node: 2, scaling: {increments_per_revolution: 4e9, feed: 1}",
            "at the velocity limit of the axis, found 8.0e+09",
        ),
        (
            "node: 2",
            "node: 2, homing: {method: 17, velocity_switch: 501, within_s: 0.5}",
            "homing.velocity_switch: expected the velocity limit of the axis at the most, 500.0, found 501.0",
        ),
        (
            "node: 2",
            "node: 2, homing: {method: 17, acceleration: 5001, within_s: 0.5}",
            "homing.acceleration: expected the acceleration limit of the axis at the most, 5000.0, found 5001.0",
        ),
        ("node: 2", 'node: 2, vendor: "2E1"', 'vendor: expected a number of 32 bits like "0x2E1", found'),
        (
            "node: 2",
            'node: 2, start_up: [{object: "6098", value: 1}]',
            'start_up[0].object: expected index and subindex like "0x6098:0", found',
        ),
        (
            "node: 2",
            'node: 2, start_up: [{object: "0x6098:0", value: 300, bits: 8}]',
            "start_up[0].value: expected a number of 8 bits, found 300",
        ),
        (
            "node: 2",
            'node: 2, start_up: [{object: "0x6098:0", value: 3, bits: 9}]',
            "bits: expected 8, 16, 32 or 64, found 9",
        ),
        (
            "node: 2",
            "node: 2, inputs: {reference: 32}",
            "inputs.reference: expected a whole number from -1 to 31, found 32",
        ),
        (
            "node: 2",
            "node: 2, scaling: {feed: 5}",
            "scaling.increments_per_revolution: expected this key with a number above 0, found nothing",
        ),
        (
            "node: 2",
            "node: 2, homing: {method: 0, within_s: 0.5}",
            "drives[1].homing.method: expected a homing method (0x6098) other than 0, found 0",
        ),
        (
            "node: 2",
            "node: 2, homing: {method: 17}",
            "homing.within_s: expected less than drive: ready_timeout_s of the axis, which is switched on meanwhile: "
            "1.0 s, found 60.0 s",
        ),
        (
            "node: 2",
            "node: 2, homing: {method: 200}",
            "drives[1].homing.method: expected a whole number from -128 to 127, found 200",
        ),
        (
            "node: 2",
            "node: 2, probe_latch: 3",
            "drives[1].probe_latch: expected a whole number from 0 to 2, found 3",
        ),
        (
            "    encoder: {increments_per_unit: 1000}\nexternal",
            "    encoder: {increments_per_unit: 1000}\n    drive: {mode: analog}\nexternal",
            "expected an axis whose drive: mode is cyclic_position or cyclic_velocity, found",
        ),
        (
            "    encoder: {increments_per_unit: 1000}\nexternal",
            "    encoder: {type: absolute_ssi, increments_per_unit: 1000}\nexternal",
            "expected an encoder that is incremental, or absolute with ssi_bits: 32",
        ),
        (
            "  buses:",
            "  drives: [{axis: x2, missing_cycles: 2}]\n  buses:",
            "external.drives[0].missing_cycles: expected at least 3 cycles",
        ),
    ],
)
def test_what_is_wrong_is_said_with_line_and_key(old: str, new: str, sentence: str) -> None:
    """AX-87, EN-10."""
    text = machine(URL, "canopen:can0", 2)
    assert old in text
    before, _, after = text.rpartition(old)
    found = problems(before + new + after)
    assert any(sentence in line for line in found), found


def test_homing_in_the_drive_is_for_incremental_encoders() -> None:
    """AX-87: an absolute one needs none."""
    encoder = "encoder: {type: absolute_ssi, ssi_bits: 32, coding: binary, increments_per_unit: 1000}"
    text = machine(URL, "canopen:can0", 1, drive_keys="homing: {method: 17, within_s: 0.5}")
    found = problems(text.replace("encoder: {increments_per_unit: 1000}", encoder))
    assert len(found) == 1
    assert "drives[0].homing: expected this key with an incremental encoder, found an absolute one, which" in found[0]


def test_the_speed_of_a_drive_must_fit_its_object() -> None:
    """AX-87: csv; a set point beyond 32 bits would be cut off, and the axis lag behind."""
    keys = "drive: {mode: cyclic_velocity}\n    loop: {kp: 0.06, ff: 1, velocity_at_10v: 600}"
    text = machine(URL, "canopen:can0", 1, axis_keys=keys, drive_keys="velocity_factor: 4294.9")
    described(text)
    found = problems(text.replace("4294.9", "4295.1"))
    assert found == [
        "m.yaml:15:48: external.buses[0].drives[0].velocity_factor: expected a velocity limit of the axis of "
        "2147483647 units of the drive (0x60FF) at the most, found 2147550000.0"
    ]


ETHERCAT = machine(URL, "ethercat:eth1", 2, bus_keys="dc: true").replace("node: ", "position: ")


def test_drives_on_ethercat() -> None:
    """AX-87: by position or alias."""
    found = described(ETHERCAT.replace("position: 2", "alias: 4001"))["external"]["buses"][0]
    assert found["dc"] is True
    assert [(one.get("position"), one.get("alias")) for one in found["drives"]] == [(1, None), (None, 4001)]


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("ethercat:eth1", "ethercat:", "m.yaml:14:12: external.buses[0].bus: expected canopen:CHANNEL or"),
        (
            "position: 2",
            "node: 2",
            "drives[1].node: expected position or alias on a bus ethercat:INTERFACE, found node",
        ),
        ("position: 2", "position: 1", "drives[1].position: expected each position once on a bus, found 1 again"),
        ("position: 2", "position: 0", "drives[1].position: expected a whole number from 1 to 65535, found 0"),
        ("position: 2", "position: 2, alias: 3", "drives[1].alias: expected either position or alias, found both"),
        (", position: 2", "", "drives[1].position: expected this key, or alias, with a whole number from 1 to 65535"),
        ("dc: true", "bitrate: 500000", "buses[0].bitrate: expected this key on CANopen only"),
        ("dc: true", "node: 5", "buses[0].node: expected this key on CANopen only"),
        (
            "dc: true",
            "heartbeat_s: 2.2",
            "buses[0].heartbeat_s: expected at most 2.1845 s on a bus ethercat:INTERFACE, for a watchdog of its drives",
        ),
        ("dc: true", "ring: eth1", "buses[0].ring: expected an interface other than that of bus, found 'eth1'"),
        ("ethercat:eth1", "canopen:can0", "external.buses[0].dc: expected this key on a bus ethercat:INTERFACE only"),
        ("ethercat:eth1", "canopen:can0", "drives[1].position: expected this key on a bus ethercat:INTERFACE only"),
        ("ethercat:eth1", "canopen:can0", "drives[1].node: expected this key with a whole number from 1 to 127, found"),
    ],
)
def test_what_is_wrong_on_ethercat_is_said_with_line_and_key(old: str, new: str, sentence: str) -> None:
    """AX-87, EN-10."""
    assert old in ETHERCAT
    found = problems(ETHERCAT.replace(old, new))
    assert any(sentence in line for line in found), found


def test_the_schema_knows_buses(capsys: pytest.CaptureFixture[str]) -> None:
    """EN-11: editors complete them."""
    import jsonschema

    assert main(["schema"]) == 0
    schema = json.loads(capsys.readouterr().out)
    text = machine(URL, "canopen:can0", 2, drive_keys='vendor: "0x2E1"')
    jsonschema.validate(yaml.safe_load(text), schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(yaml.safe_load(text.replace("node: 2", "node: 0")), schema)


def test_check_says_ok(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """EN-10."""
    file = tmp_path / "machine.yaml"
    file.write_text(machine(URL, "canopen:can0", 2))
    assert main(["check", str(file)]) == 0
    assert capsys.readouterr().out.endswith("ok\n")
