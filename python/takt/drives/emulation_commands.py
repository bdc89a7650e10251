"""What can be done to emulated drives while they run, whatever bus they are on: faults, broken cables, supply."""

from __future__ import annotations

import queue
import sys
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, Final

from takt.drives import objects as od
from takt.drives.error_texts import error_text

CLOCK: Final = (0x2000, 0)  # of an emulated drive: what its time goes by
CLOCK_IS_SYNC: Final = 1
VENDOR: Final = 0x0000_0000
PRODUCT: Final = 0x5441_4B54  # "TAKT"
NAME: Final = "Takt emulated drive"
HELP: Final = (
    "fault NODE CODE [lasting] | clear NODE | cut NODE|all | join NODE|all | power NODE off|on | stall NODE | "
    "jump NODE INCREMENTS | show | quit"
)


class Commanded(ABC):
    """An emulation that texts change, as `takt drives emulate` reads them.

    nodes: by address; each has a `drive`, an EmulatedDrive."""

    called = "node"
    help = HELP

    def __init__(self, nodes: dict[int, Any], say: Callable[[str], None]) -> None:
        self.nodes = nodes
        self._say = say
        self._commands: queue.Queue[str] = queue.Queue()
        self._running = True

    @abstractmethod
    def cut(self, node: Any, out: bool) -> None:
        """The cable of a node is out, or back."""

    @abstractmethod
    def power(self, node: Any, on: bool) -> None:
        """The supply of a node."""

    def more(self, verb: str, rest: Sequence[str]) -> str | None:
        """Commands that only this bus knows; None: it does not."""
        return None

    def stop(self) -> None:
        self._running = False

    def command(self, text: str) -> None:
        """From any thread."""
        self._commands.put(text)

    def obey(self) -> None:
        """Carries out what has come."""
        while not self._commands.empty():
            self._obey(self._commands.get())

    def _obey(self, text: str) -> None:
        words = text.split()
        if not words:
            return
        try:
            said = self.more(words[0], words[1:]) or self._carry_out(words[0], words[1:])
        except (ValueError, IndexError, KeyError):
            said = f"not understood: {text!r}; expected {self.help}"
        self._say(said)

    def _which(self, word: str) -> list[Any]:
        return list(self.nodes.values()) if word == "all" else [self.nodes[int(word)]]

    def _carry_out(self, verb: str, rest: Sequence[str]) -> str:
        if verb == "quit":
            self.stop()
            return "ends"
        if verb == "show":
            return "; ".join(
                f"{self.called} {number}: {n.drive.machine.state.value}, {error_text(n.drive.machine.error_code)}, "
                f"position {n.drive.read(od.POSITION)}"
                for number, n in self.nodes.items()
            )
        for node in self._which(rest[0]):
            if verb == "fault":
                code = int(rest[1], 0)
                if not 0 <= code <= 0xFFFF:
                    raise ValueError(code)
                node.drive.fault(code, lasting=rest[2:] == ["lasting"])
            elif verb == "clear":
                node.drive.held_fault = 0
            elif verb in ("cut", "join"):
                self.cut(node, verb == "cut")
            elif verb == "stall":
                node.drive.never_ready = True
            elif verb == "jump":
                node.drive.slip(int(rest[1], 0))
            elif verb == "power":
                self.power(node, {"off": False, "on": True}[rest[1]])
            else:
                raise ValueError(verb)
        return f"{verb} {' '.join(rest)}: done"


def read_commands(emulation: Commanded) -> None:
    """Takes commands from standard input, beside the emulation."""

    def read() -> None:
        for line in sys.stdin:
            emulation.command(line)

    threading.Thread(target=read, daemon=True).start()
