"""Commands to emulated drives while they run, on any bus: faults, broken cables, supply."""

from __future__ import annotations

import queue
import sys
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, Final

from takt.drives import objects as od
from takt.drives.error_texts import error_text

# Object that only emulated drives have (manufacturer specific): the base of their time. 1: one period with each SYNC or
# frame, for simulated time; 0: the clock of the host, with supervision of heartbeat and SYNC.
CLOCK: Final = (0x2000, 0)
CLOCK_IS_SYNC: Final = 1
VENDOR: Final = 0x0000_0000
PRODUCT: Final = 0x5441_4B54  # "TAKT"
NAME: Final = "Takt emulated drive"
HELP: Final = (
    "fault NODE CODE [lasting] | clear NODE | cut NODE | join NODE | power NODE off|on | stall NODE | "
    "jump NODE INCREMENTS | show | quit (NODE: a number, or all)"
)
# Smallest and largest number of arguments of each verb.
_WORDS: Final = {
    "fault": (2, 3), "clear": (1, 1), "cut": (1, 1), "join": (1, 1), "power": (2, 2), "stall": (1, 1), "jump": (2, 2),
    "show": (0, 0), "quit": (0, 0),
}  # fmt: skip


class Commanded(ABC):
    """Base of the emulated buses: carries out text commands of `takt drives emulate` between bus cycles.

    fault: a fault with this code (0x603F); lasting: it cannot be reset before clear. clear: ends a lasting fault, and
    stall. cut, join: disconnects or reconnects the cable in front of a node. stall: the power stage no longer becomes
    ready. jump: the value of the encoder jumps, the motor does not move.

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
        """Disconnects (out) or reconnects the cable in front of a node."""

    @abstractmethod
    def power(self, node: Any, on: bool) -> None:
        """Switches the supply of a node."""

    def more(self, verb: str, rest: Sequence[str]) -> str | None:
        """Carries out a command that only this bus has. Returns the reply; None if it has no such verb. Raises
        ValueError, IndexError or KeyError if the arguments are wrong."""
        return None

    def stop(self) -> None:
        self._running = False

    def command(self, text: str) -> None:
        """Queues a command line, from any thread."""
        self._commands.put(text)

    def obey(self) -> None:
        """Carries out the queued commands, on the thread of `run`."""
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
        least, most = _WORDS[verb]
        if not least <= len(rest) <= most:
            raise ValueError(rest)
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
                if not 0 <= code <= 0xFFFF or rest[2:] not in ([], ["lasting"]):
                    raise ValueError(rest)
                node.drive.fault(code, lasting=len(rest) == 3)
            elif verb == "clear":
                node.drive.held_fault, node.drive.never_ready = 0, False
            elif verb in ("cut", "join"):
                self.cut(node, verb == "cut")
            elif verb == "stall":
                node.drive.never_ready = True
            elif verb == "jump":
                node.drive.slip(int(rest[1], 0))
            else:
                self.power(node, {"off": False, "on": True}[rest[1]])
        return f"{verb} {' '.join(rest)}: done"


def read_commands(emulation: Commanded) -> None:
    """Reads commands from standard input in a thread beside the emulation."""

    def read() -> None:
        for line in sys.stdin:
            emulation.command(line)

    threading.Thread(target=read, daemon=True).start()
