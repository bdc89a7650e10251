"""Emulated drives in a test of their own on CANopen and on EtherCAT."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import buses


@contextlib.contextmanager
def driven(text: str, url: str, folder: Path) -> Iterator[tuple[list[str], Any]]:
    """What the process of the drives says, and the emulation: it takes commands."""
    if "canopen:" in text:
        with buses.emulated(text) as emulation, buses.run(text, url) as (_, said):
            yield said, emulation.command
        return
    import wires

    with wires.emulated(text, folder) as emulated, wires.run(text, url) as (_, said):
        yield said, lambda line: wires.tell(emulated, line)
