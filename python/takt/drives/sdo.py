"""Objects of a drive, read and written by SDO over whatever bus (CiA 301, ETG.1000.6)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Final


class SdoError(Exception):
    """An object could not be read or written. code: of the abort; None: there was no answer."""

    def __init__(self, what: str, code: int | None = None) -> None:
        super().__init__(what)
        self.code = code


class Objects(ABC):
    """Objects of one drive, as integers.

    called: "node 3", as sentences name the drive."""

    called: str

    @abstractmethod
    def upload(self, what: str, index: int, subindex: int) -> bytes:
        """Raises SdoError, which begins with `what`."""

    @abstractmethod
    def download(self, what: str, index: int, subindex: int, data: bytes) -> None:
        """Raises SdoError, which begins with `what`."""

    def read_bytes(self, index: int, subindex: int = 0) -> bytes:
        return self.upload(f"0x{index:04X}:{subindex} cannot be read", index, subindex)

    def read(self, index: int, subindex: int = 0, *, signed: bool = False) -> int:
        return int.from_bytes(self.read_bytes(index, subindex), "little", signed=signed)

    def find(self, index: int, subindex: int = 0, *, signed: bool = False) -> int | None:
        """None: the drive does not have it. Raises SdoError where there is no answer."""
        try:
            return self.read(index, subindex, signed=signed)
        except SdoError as error:
            if error.code is None:
                raise
            return None

    def write(self, index: int, subindex: int, value: int, bits: int) -> None:
        data = (value & ((1 << bits) - 1)).to_bytes(bits // 8, "little")
        self.download(f"0x{index:04X}:{subindex} cannot be written with {value}", index, subindex, data)

    def try_to_write(self, index: int, subindex: int, value: int, bits: int) -> bool:
        """False: the drive does not take it."""
        try:
            self.write(index, subindex, value, bits)
        except SdoError as error:
            if error.code is None:
                raise
            return False
        return True


def abort_text(code: int) -> str:
    """ "SDO abort 0x06020000, the object does not exist"."""
    text = ABORTS.get(code)
    return f"SDO abort 0x{code:08X}" + (f", {text}" if text else "")


ABORTS: Final = {
    0x05040000: "the transfer timed out",
    0x06010000: "such an access is not supported",
    0x06010001: "the object can only be written",
    0x06010002: "the object can only be read",
    0x06020000: "the object does not exist",
    0x06040041: "the object cannot be mapped",
    0x06040042: "the mapping would be longer than a message",
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
