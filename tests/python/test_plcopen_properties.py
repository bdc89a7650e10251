"""Function blocks under whatever a program does to them (AX-11)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import takt
from blocks import WEAK, shown
from hypothesis import given, settings
from hypothesis import strategies as st
from takt import plcopen as plc


class Watch:
    """The interface rules of one block, looked at after every call."""

    def __init__(self, block: plc.FunctionBlock) -> None:
        self.block = block
        self.executes = "Execute" in block.INPUTS
        self.ended_unseen = False  # Execute fell while it was busy: the end must still be shown, once

    def call(self) -> None:
        block = self.block
        was_executed = self.executes and block._edge  # type: ignore[attr-defined]
        out = block().outputs
        ends = shown(block, "Done", "Error", "CommandAborted")
        busy = out.get("Busy", False)
        assert len(ends) + busy <= 1, out
        assert len(ends) + out.get("Active", False) <= 1, out
        assert busy or not (out.get("Active") or out.get("InVelocity")), out
        assert out["Error"] == (out["ErrorID"] != 0), out
        if not self.executes:
            assert not (out.get("Valid") and out["Error"]), out
            return
        execute = block.Execute  # type: ignore[attr-defined]
        if execute:
            assert len(ends) + busy == 1, out
        elif self.ended_unseen:
            assert len(ends) + busy == 1, out  # its end is shown in one call
        elif not was_executed:
            assert not ends, out
        self.ended_unseen = not execute and busy


INPUT = {"power": "Enable", "jog": "JogPos"}
MODES = {"move": list(takt.BufferMode), "velo": list(takt.BufferMode)}
for _name in ("stop", "halt", "power"):
    MODES[_name] = [takt.BufferMode.ABORTING, takt.BufferMode.BUFFERED]


@st.composite
def events(draw: st.DrawFn) -> tuple[str, int, dict[str, Any], int]:
    """Kind of block, which of the two, its inputs, and for how many cycles."""
    kind = draw(st.sampled_from("move velo halt stop reset power jog".split()))
    inputs: dict[str, Any] = {INPUT.get(kind, "Execute"): draw(st.booleans())}
    if kind == "jog":
        inputs |= {"Enable": draw(st.booleans()), "JogNeg": draw(st.booleans())}
    if kind == "velo":  # also too fast (the loop opens), also onto the SW limit (ErrorStop with the loop closed)
        inputs["Direction"] = draw(st.sampled_from([takt.Direction.POSITIVE, takt.Direction.NEGATIVE]))
    if kind in ("move", "velo"):
        inputs["Velocity"] = draw(st.sampled_from([100.0, 400.0, -1.0]))
    if kind in MODES:
        inputs["BufferMode"] = draw(st.sampled_from(MODES[kind]))
    return kind, draw(st.integers(0, 1)), inputs, draw(st.integers(0, 60))


@settings(max_examples=50, deadline=None)
@given(events=st.lists(events(), max_size=16))
def test_outputs_exclude_one_another(events: list[tuple[str, int, dict[str, Any], int]]) -> None:
    """AX-11: whatever is pressed and let go on two instances of each block, and through all faults: exactly one of
    Busy, Done, Error, Aborted while Execute is true, and each end seen once. At last, with all keys let go, a reset
    brings back an axis whose MC_Power is still enabled (AX-20), and nothing holds it any more."""
    with takt.Engine(WEAK) as engine:
        x = engine.axis("x")
        makers: dict[str, Callable[[], plc.FunctionBlock]] = {
            "power": lambda: plc.MC_Power(x, Enable=True),
            "reset": lambda: plc.MC_Reset(x),
            "move": lambda: plc.MC_MoveAbsolute(x, Position=100.0),
            "velo": lambda: plc.MC_MoveVelocity(x),
            "halt": lambda: plc.MC_Halt(x),
            "stop": lambda: plc.MC_Stop(x),
            "jog": lambda: plc.GT_Jog(x, JogVelo=100.0),
        }
        watches = {(kind, i): Watch(make()) for i in range(2) for kind, make in makers.items()}

        def press(kind: str, i: int, cycles: int, **inputs: Any) -> dict[str, Any]:
            watch = watches[kind, i]
            for name, value in inputs.items():
                setattr(watch.block, name, value)
            watch.call()  # perhaps more than once in a cycle
            for _ in range(cycles):
                for each in watches.values():
                    each.call()
                engine.step()
            return watch.block.outputs

        press("power", 0, 150)
        for kind, i, inputs, cycles in events:
            press(kind, i, cycles, **inputs)
        for kind, i in watches:
            level = kind == "power"
            press(kind, i, 1, **{INPUT.get(kind, "Execute"): level}, **({"JogNeg": False} if kind == "jog" else {}))
        press("halt", 0, 150, Execute=False)  # perhaps the drive is still getting ready
        press("halt", 0, 200, Execute=True, BufferMode=takt.BufferMode.ABORTING)
        press("halt", 0, 1, Execute=False)
        assert press("reset", 0, 300, Execute=True)["Done"]
        for i in range(2):
            power = watches["power", i].block
            assert shown(power, "Status", "Busy", "Error", "CommandAborted") == ["Status"]
        assert press("halt", 0, 20, Execute=True)["Done"]
        assert x.state is takt.PlcState.STANDSTILL
