"""Counts with their nouns as text."""

from __future__ import annotations

from typing import SupportsInt


def counted(number: SupportsInt, one: str, many: str = "") -> str:
    """ "1 track", "2 tracks"."""
    count = int(number)
    return f"{count:,} {one if count == 1 else many or one + 's'}"
