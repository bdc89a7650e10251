"""Commands from a page: only those listed here, and only if the machine file allows them.

Jogging continues only while the page confirms it (EN-23): each page is a separate client of the engine, and repeatedly
reports that the button is still held."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from takt import msgs
from takt.arguments import to_text
from takt.tables import KINDS
from takt.view.client import Client
from takt.view.machine import Machine

# By kind of component: verbs that a page may give, with their permitted arguments.
ALLOWED: dict[str, dict[str, frozenset[str]]] = {
    "machine": {
        "emergency_stop": frozenset(),
        "stop_all": frozenset(),
        "begin_cam": frozenset({"name", "cyclic", "interpolation", "x_unit", "y_unit"}),
        "add_cam_points": frozenset({"cam", "first", "points"}),
        "build_cam": frozenset({"cam", "count"}),
    },
    "axis": {
        "power": frozenset({"enable"}),
        "reset": frozenset(),
        "halt": frozenset(),
        "jog": frozenset({"forward", "backward", "velocity"}),
    },
    "group": {
        **{verb: frozenset() for verb in ("enable", "disable", "reset", "halt")},
        "power": frozenset({"enable"}),
        "jog": frozenset({*"xyzabc", *(f"a{i}" for i in range(1, 9)), "coordinate_system"}),
    },
    "flex_cam": {
        "control": frozenset({"regulator_on", "reset_error", "halt"}),
        "set_cam": frozenset({"slot", "cam"}),
    },
    "pick_place": {"control": frozenset({"regulator_on", "reset_error", "path_halt"})},
    "mover": {verb: frozenset() for verb in ("enable", "disable", "reset", "halt")},
    "track": {verb: frozenset() for verb in ("enable", "disable", "reset")},
    "planar_group": {verb: frozenset() for verb in ("enable", "disable", "reset")},
}
HELD = {("axis", "jog"), ("group", "jog")}  # continue only while they are held
Tell = Callable[[dict[str, Any]], None]


class RefusedError(Exception):
    """A page may not give a command; the text says why."""


class Commander(Client):
    """The commands of one page. `tell` receives errors of them."""

    def __init__(self, network: Any, machine: Machine, tell: Tell) -> None:
        super().__init__(network, machine, "page")
        self._tell = tell

    def give(self, target: str, verb: str, arguments: Mapping[str, Any], now: float) -> None:
        """Gives a command. Raises RefusedError with a sentence."""
        if not self._machine.parameters["view"]["commands"]:
            raise RefusedError("the machine file does not let the page command: view: {commands: true}")
        source = self._machine.by_name.get(target)
        kind = source.kind if source else "machine"
        if source is None and target != "machine":
            raise RefusedError(f"there is no {target!r}")
        allowed = ALLOWED.get(kind, {}).get(verb)
        if allowed is None:
            raise RefusedError(f"the page gives no {verb!r} to a {kind.replace('_', ' ')}")
        if not arguments.keys() <= allowed:
            raise RefusedError(f"the page gives {verb} with {', '.join(sorted(allowed)) or 'no arguments'} alone")
        held = (kind, verb) in HELD
        if held:
            self.release()
            self._held_at = now
            self._beat(now)  # the engine must know the client before the command
        self._send(target, verb, to_text(arguments), now, held)

    def _became(self, message: msgs.command, feedback: msgs.feedback) -> None:
        if feedback.error_id:
            self._say(message, "error", feedback.sentence)

    def _unanswered(self, message: msgs.command) -> None:
        self._say(message, "error", "the engine does not answer")

    def _say(self, message: msgs.command, state: str, sentence: str) -> None:
        self._tell({"target": message.target, "verb": message.verb, "state": state, "sentence": sentence})


assert ALLOWED.keys() <= {"machine", *KINDS}
