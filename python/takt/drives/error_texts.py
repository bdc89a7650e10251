"""The meaning of a drive's error code (0x603F, and in emergency messages), in words."""

from __future__ import annotations

from takt import _core


def error_text(code: int) -> str:
    """Returns "0x3210 (DC link overvoltage)"; for an unknown code the meaning of its group; 0xFFxx is specific to the
    maker."""
    text: str = _core.drive_error_text(code)
    return text
