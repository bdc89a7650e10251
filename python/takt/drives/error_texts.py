"""What the error code of a drive (0x603F, and that of emergency messages) means, in words."""

from __future__ import annotations

from takt import _core


def error_text(code: int) -> str:
    """ "0x3210 (DC link overvoltage)"; of a code that is not known, what its group is about; 0xFFxx is the maker's."""
    text: str = _core.drive_error_text(code)
    return text
