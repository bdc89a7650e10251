"""AX-95: takt.plcopen against the lists of PLCopen and of the GT-775x modules in spec/."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Any

import pytest
import takt
from machines import MACHINE
from takt import plcopen as plc
from takt.plcopen.statement import TABLES, TYPES, Entry, Pin, tables

ROOT = Path(__file__).resolve().parents[2]
BLOCKS = {block.__name__: block for block in plc.BLOCKS}
ENTRIES = [entry for table in tables() for entry in table.entries]
THERE = [entry for entry in ENTRIES if entry.name in BLOCKS]
# Names of the standard's Appendix B and of its Part 5, counted: a table that loses some is noticed.
NUMBERS = {"plcopen_part1.yaml": 45 + 11, "plcopen_part4.yaml": 39, "gt775x.yaml": 45, "conveyor_tracking.yaml": 2}
ENUMERATIONS = ("ENUM", "MC_DIRECTION", "MC_BUFFER_MODE", "MC_SOURCE", "MC_HOME_DIRECTION", "MC_SWITCH_MODE")
ENUMERATIONS += ("MC_SYNC_MODE", "MC_COMBINE_MODE", "MC_BUFFERMODE", "MC_START_MODE", "MC_EXECUTION_MODE")
# Blocks with an output of the interface rules that the standard does not give them (AX-11).
OUTPUTS_TOO_MANY = {
    "MC_Reset": {"Active", "CommandAborted", "Aborted"},
    "MC_MoveVelocity": {"Done"},
    "MC_Power": {"Done"},
    "MC_GearIn": {"Done"},
    "MC_SetPosition": {"Active", "CommandAborted"},
}


def label(entry: Entry) -> str:
    return f"{entry.name}-{entry.section}"


def test_tables_are_whole() -> None:
    for name, table in zip(TABLES, tables(), strict=True):
        assert len(table.entries) == NUMBERS[name]
        for entry in table.entries:
            assert all(pin.level in ("B", "E", "V") for pin in entry.pins), entry.name
            assert set(entry.without) <= {pin.name for pin in entry.pins}, entry.name
    part1 = tables()[0]
    for entry in part1.entries:
        required = {pin.name for pin in entry.pins if pin.required}
        assert "Error" in required, entry.name
        assert required & {"Execute", "Enable"}, entry.name
        assert required & {"Done", "Valid", "Status", "InOperation", "Enabled"} or any(
            name.startswith("In") or name == "ProfileCompleted" for name in required
        ), entry.name


@pytest.mark.parametrize("entry", THERE, ids=label)
def test_a_block_has_what_its_name_promises(entry: Entry) -> None:
    """Every basic input and output, under the standard's name or an alias, and on the right side."""
    block = BLOCKS[entry.name]
    missing = {pin.name for pin in entry.missing(block) if pin.required}
    assert missing == set(entry.without), entry.name
    for pin in entry.pins:
        assert pin.kind != "inputs" or pin.name not in block.OUTPUTS, pin
        assert pin.kind != "outputs" or pin.name not in block.INPUTS, pin


@pytest.mark.parametrize("entry", THERE, ids=label)
def test_types_are_those_of_the_table(entry: Entry) -> None:
    block = BLOCKS[entry.name]
    for pin in entry.pins:
        member = block.INPUTS.get(pin.name) or block.OUTPUTS.get(pin.name)
        if member is not None:
            assert fits(pin, member.initial), (pin, member.initial)


def fits(pin: Pin, initial: Any) -> bool:
    """Whether a value, None for one that the engine fills in, is of the table's type."""
    kind = pin.type.upper()
    if kind == "BOOL":
        return initial is None or isinstance(initial, bool)
    if kind in ("REAL", "LREAL", "TIME"):
        return initial is None or isinstance(initial, float)
    if kind in ("INT", "UINT", "WORD", "DWORD"):  # gears may have ratios that are not whole
        return isinstance(initial, (int, float)) and not isinstance(initial, bool)
    if kind in ENUMERATIONS:
        return isinstance(initial, Enum)
    return kind.endswith(("_REF", "_ID")) or pin.type in TYPES


def test_every_block_of_the_tables_is_there() -> None:
    assert [entry.name for entry in ENTRIES if not entry.reason and entry.name not in BLOCKS] == []


def test_what_is_left_out_on_purpose_is_not_there() -> None:
    assert [entry.name for entry in ENTRIES if entry.reason and entry.name in BLOCKS] == []


def test_no_output_that_the_rules_forbid() -> None:
    for name, outputs in OUTPUTS_TOO_MANY.items():
        assert not outputs & set(BLOCKS[name].OUTPUTS), name


def test_the_statement_is_up_to_date() -> None:
    """docs/plcopen.md is made by tools/compliance.py."""
    page = plc.compliance()
    assert (ROOT / "docs" / "plcopen.md").read_text(encoding="utf-8") == page, "please run tools/compliance.py"
    for block in plc.BLOCKS:
        assert f"\n| {block.__name__} | " in page


def test_aliases_are_the_same_input_output_and_axis() -> None:
    with takt.Engine(MACHINE) as engine:
        x, r = engine.axis("x"), engine.axis("r")
        step = plc.MC_StepLimitSwitch(x, LimitSwitchMode=takt.SwitchMode.IS_OFF)
        assert step.SwitchMode is takt.SwitchMode.IS_OFF
        step.SwitchMode = takt.SwitchMode.IS_ON
        assert step.LimitSwitchMode is takt.SwitchMode.IS_ON
        gear = plc.MC_GearIn(r, Master=x)
        assert gear.Slave is gear.Axis is r
        gear(Slave=x)
        assert gear.Axis is x
        stop = plc.GT_EStop(x)
        stop(Enable=True)
        engine.step()
        assert (stop.Execute, stop().Done) == (True, True)
        status = plc.MC_ReadStatus(x, Enable=True)()
        assert (status.Disabled, status.Standstill, status.StandStill) == (True, False, False)
        stop(Enable=False)
        x.power().wait()
        assert (status().Standstill, status.StandStill) == (True, True)


def test_digital_inputs_and_outputs() -> None:
    machine = (
        MACHINE
        + "cam_switches:\n  - name: gates\n    switches: [{track: 2, first_on_position: -1, last_on_position: 1}]\n"
    )
    machine += "simulation:\n  servos:\n    - {axis: x, switches: {reference: {from: -1, to: 1}}}\n"
    with takt.Engine(machine) as engine:
        x = engine.axis("x")
        signal, gate = plc.MC_ReadDigitalInput(x, Enable=True), plc.MC_ReadDigitalOutput(x, Enable=True)
        switch = plc.MC_DigitalCamSwitch(x, Enable=True, Switches="gates")
        for _ in range(5):
            switch()
            engine.step()
        assert [signal(InputNumber=n).Value for n in (1, 2, 3, 4)] == [False, False, True, False]
        assert [gate(OutputNumber=n).Value for n in (1, 2, 3)] == [False, True, False]
        for block, inputs in ((signal, {"InputNumber": 5}), (gate, {"OutputNumber": 0})):
            block(**inputs)
            assert (block.Valid, block.Error, block.ErrorID, block.Value) == (False, True, 5, False)
