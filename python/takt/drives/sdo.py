"""Objects of a drive, read and written by SDO on any bus (CiA 301, ETG.1000.6)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Final

# Abort codes of objects that may exist, but temporarily cannot be read or written.
TRANSIENT: Final = frozenset((0x05040000, 0x08000020, 0x08000021, 0x08000022))


class SdoError(Exception):
    """An object could not be read or written.

    code: of the abort; None: there was no answer, or no request."""

    def __init__(self, what: str, code: int | None = None) -> None:
        super().__init__(what)
        self.code = code


class Objects(ABC):
    """Objects of one drive, as integers.

    called: the drive in error sentences, such as "node 3" or "slave 2"."""

    called: str

    @abstractmethod
    def upload(self, what: str, index: int, subindex: int) -> bytes:
        """Returns the bytes of an object, little endian. Raises SdoError, whose sentence begins with `what`."""

    @abstractmethod
    def download(self, what: str, index: int, subindex: int, data: bytes) -> None:
        """Writes the bytes of an object. Raises SdoError, whose sentence begins with `what`."""

    def read_bytes(self, index: int, subindex: int = 0) -> bytes:
        return self.upload(f"0x{index:04X}:{subindex} cannot be read", index, subindex)

    def read(self, index: int, subindex: int = 0, *, signed: bool = False) -> int:
        return int.from_bytes(self.read_bytes(index, subindex), "little", signed=signed)

    def find(self, index: int, subindex: int = 0, *, signed: bool = False) -> int | None:
        """Returns the value of an object; None if the drive refuses to read it, as it does if the object does not
        exist. Raises SdoError if there is no answer, or the drive temporarily cannot read it."""
        try:
            return self.read(index, subindex, signed=signed)
        except SdoError as error:
            if error.code is None or error.code in TRANSIENT:
                raise
            return None

    def write(self, index: int, subindex: int, value: int, bits: int) -> None:
        """Writes an integer of `bits` bits (a multiple of 8), little endian, two's complement below 0. Raises SdoError,
        also if it does not fit."""
        what = f"0x{index:04X}:{subindex} cannot be written with {value}"
        if not -(1 << (bits - 1)) <= value < 1 << bits:
            raise SdoError(f"{what}: it has {bits} bits")
        self.download(what, index, subindex, (value & ((1 << bits) - 1)).to_bytes(bits // 8, "little"))

    def try_to_write(self, index: int, subindex: int, value: int, bits: int) -> bool:
        """Writes like `write`. Returns false if the drive refuses it. Raises SdoError if there is no answer, the drive
        temporarily cannot write it, or the value does not fit."""
        try:
            self.write(index, subindex, value, bits)
        except SdoError as error:
            if error.code is None or error.code in TRANSIENT:
                raise
            return False
        return True


def abort_text(code: int) -> str:
    """Returns an abort code with its text, as "SDO abort 0x06020000, the object does not exist"; without a text if
    ABORTS has none."""
    text = ABORTS.get(code)
    return f"SDO abort 0x{code:08X}" + (f", {text}" if text else "")


ABORTS: Final = {
    0x05040000: "the transfer timed out",
    0x06010000: "such an access is not supported",
    0x06010001: "the object can only be written",
    0x06010002: "the object can only be read",
    0x06020000: "the object does not exist",
    0x06040041: "the object cannot be mapped",
    0x06040042: "the mapped objects would exceed the length of the message",
    0x06040043: "the parameters do not fit together",
    0x06060000: "the hardware refuses it",
    0x06070010: "the length is wrong",
    0x06070012: "the data are too long",
    0x06070013: "the data are too short",
    0x06090011: "the subindex does not exist",
    0x06090030: "the value is out of range",
    0x06090031: "the value is too large",
    0x06090032: "the value is too small",
    0x060A0023: "the resource is not there",
    0x08000000: "general error",
    0x08000020: "the data cannot be stored",
    0x08000021: "the drive is controlled locally",
    0x08000022: "not in the present state of the drive",
}
