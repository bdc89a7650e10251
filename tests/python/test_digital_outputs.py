"""Digital outputs of an axis that a program writes (AX-111, MC_WriteDigitalOutput)."""

from __future__ import annotations

import pytest
import takt
from takt.plcopen import MC_ReadDigitalOutput, MC_WriteDigitalOutput

MACHINE = """
name: outputs
axes:
  - {name: x, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
cam_switches:
  - {name: gate, switches: [{track: 2, first_on_position: 10, last_on_position: 20}]}
"""


def test_outputs_are_written_and_stay() -> None:
    """AX-111: each by itself, beside those of the cam switches, through stops and an emergency stop."""
    with takt.Engine(MACHINE) as s:
        x = s.axis("x")
        assert x.digital_outputs == 0
        x.write_output(number=32, value=True).wait()
        x.write_output(number=2, value=True).wait()
        assert x.digital_outputs == 1 << 31 | 2
        x.write_output(number=2, value=False).wait()
        assert x.digital_outputs == 1 << 31
        x.power().wait()
        x.digital_cam_switch(switches="gate")
        x.move_absolute(position=15).wait()
        assert x.digital_outputs == 1 << 31 | 2
        s.command("machine", "emergency_stop", {}).wait()
        assert x.digital_outputs >> 31 == 1


@pytest.mark.parametrize("number", [0, 33, -1])
def test_there_are_32(number: int) -> None:
    with takt.Engine(MACHINE) as s:
        refused = s.command("x", "write_output", {"number": number, "value": True}).wait_final()
        assert refused.error
        assert "number" in str(refused.sentence)
        assert s.axis("x").digital_outputs == 0


def test_the_blocks_write_and_read() -> None:
    """AX-111: MC_WriteDigitalOutput at the rising edge, MC_ReadDigitalOutput shows it."""
    with takt.Engine(MACHINE) as s:
        x = s.axis("x")
        write = MC_WriteDigitalOutput(x, OutputNumber=5, Value=True)
        read = MC_ReadDigitalOutput(x, OutputNumber=5, Enable=True)

        def cycles() -> None:
            for _ in range(3):
                write()
                read()
                s.step(1)
            write()
            read()

        cycles()
        assert not read.Value
        write.Execute = True
        cycles()
        assert write.Done
        assert read.Value
        write.Value = False
        cycles()
        assert read.Value  # inputs count at the edge
        write.Execute = False
        cycles()
        write.Execute = True
        cycles()
        assert not read.Value
        write.Execute = False
        cycles()
        write.OutputNumber = 33
        write.Execute = True
        cycles()
        assert write.Error
