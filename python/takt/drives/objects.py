"""The objects of a CiA 402 drive that are used here, listed once, for mapping, `takt drives info` and emulation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Object:
    """An object without subindices. Integers are little endian; `bits` is 8, 16 or 32."""

    index: int
    name: str
    bits: int
    signed: bool = False
    writable: bool = False
    mappable: bool = False
    default: int = 0

    @property
    def mapping(self) -> int:
        """The entry of the object in a mapping of process data."""
        return self.index << 16 | self.bits

    def encode(self, value: int) -> bytes:
        return (value & ((1 << self.bits) - 1)).to_bytes(self.bits // 8, "little")

    def decode(self, data: bytes) -> int:
        return int.from_bytes(data[: self.bits // 8], "little", signed=self.signed)


def _input(index: int, name: str, bits: int, signed: bool = False) -> Object:
    return Object(index, name, bits, signed, mappable=True)


def _output(index: int, name: str, bits: int, signed: bool = False, default: int = 0) -> Object:
    return Object(index, name, bits, signed, writable=True, mappable=True, default=default)


ERROR_CODE: Final = _input(0x603F, "error code", 16)
CONTROL_WORD: Final = _output(0x6040, "control word", 16)
STATUS_WORD: Final = _input(0x6041, "status word", 16)
QUICK_STOP_OPTION: Final = Object(0x605A, "quick stop option code", 16, True, True, default=2)
FAULT_REACTION_OPTION: Final = Object(0x605E, "fault reaction option code", 16, True, True, default=2)
MODE: Final = _output(0x6060, "modes of operation", 8, True)
MODE_DISPLAY: Final = _input(0x6061, "modes of operation display", 8, True)
POSITION: Final = _input(0x6064, "position actual value", 32, True)
FOLLOWING_WINDOW: Final = Object(0x6065, "following error window", 32, False, True, default=0xFFFF_FFFF)
VELOCITY: Final = _input(0x606C, "velocity actual value", 32, True)
TARGET_TORQUE: Final = _output(0x6071, "target torque", 16, True)
MAX_TORQUE: Final = _output(0x6072, "max torque", 16, default=1000)
RATED_TORQUE: Final = Object(0x6076, "motor rated torque", 32, default=1000)  # mNm
TORQUE: Final = _input(0x6077, "torque actual value", 16, True)
TARGET_POSITION: Final = _output(0x607A, "target position", 32, True)
HOME_OFFSET: Final = Object(0x607C, "home offset", 32, True, True)
MAX_MOTOR_SPEED: Final = _output(0x6080, "max motor speed", 32, default=0xFFFF_FFFF)
QUICK_STOP_DECELERATION: Final = Object(0x6085, "quick stop deceleration", 32, False, True, default=5_000_000)
HOMING_METHOD: Final = Object(0x6098, "homing method", 8, True, True, default=37)
HOMING_ACCELERATION: Final = Object(0x609A, "homing acceleration", 32, False, True, default=1_000_000)
PROBE_FUNCTION: Final = _output(0x60B8, "touch probe function", 16)
PROBE_STATUS: Final = _input(0x60B9, "touch probe status", 16)
PROBE_1_RISE: Final = _input(0x60BA, "touch probe 1, position at the rising edge", 32, True)
PROBE_1_FALL: Final = _input(0x60BB, "touch probe 1, position at the falling edge", 32, True)
PROBE_2_RISE: Final = _input(0x60BC, "touch probe 2, position at the rising edge", 32, True)
PROBE_2_FALL: Final = _input(0x60BD, "touch probe 2, position at the falling edge", 32, True)
FOLLOWING_ERROR: Final = _input(0x60F4, "following error actual value", 32, True)
DIGITAL_INPUTS: Final = _input(0x60FD, "digital inputs", 32)
TARGET_VELOCITY: Final = _output(0x60FF, "target velocity", 32, True)
SUPPORTED_MODES: Final = Object(0x6502, "supported drive modes", 32, default=0x3A0)  # hm, csp, csv, cst

OBJECTS: Final = {
    entry.index: entry
    for entry in (
        Object(0x6007, "abort connection option code", 16, True, True, default=1),
        *(ERROR_CODE, CONTROL_WORD, STATUS_WORD, QUICK_STOP_OPTION, FAULT_REACTION_OPTION, MODE, MODE_DISPLAY),
        *(POSITION, FOLLOWING_WINDOW, VELOCITY, TARGET_TORQUE, MAX_TORQUE, RATED_TORQUE, TORQUE, TARGET_POSITION),
        *(HOME_OFFSET, MAX_MOTOR_SPEED, QUICK_STOP_DECELERATION, HOMING_METHOD, HOMING_ACCELERATION, PROBE_FUNCTION),
        *(PROBE_STATUS, PROBE_1_RISE, PROBE_1_FALL, PROBE_2_RISE, PROBE_2_FALL, FOLLOWING_ERROR, DIGITAL_INPUTS),
        *(TARGET_VELOCITY, SUPPORTED_MODES),
    )
}
