"""Cams made at run time, gathered from commands (CAM-88): those that pass by, for the page, or those of a log."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import yaml

from takt import cam, msgs
from takt.errors import ConfigError
from takt.yaml_text import load

MOST_PIECES = 500  # of one cam; of a longer one the page shows no curve
DRAFTS = 4  # that are remembered; an engine has two
BUILDS = 16  # under way
KNOWN = 256  # cams
DONE = msgs.feedback.STATE_DONE
VERBS = {"begin_cam", "add_cam_points", "add_cam_segments", "build_cam"}

Key = tuple[str, int, int]
Draft = OrderedDict[Key, str]  # the commands that sent a cam, as texts


class MadeCams:
    """Cams by number, and what is kept of each. What was made before anyone listened, or only heard in part, is not
    among them."""

    def __init__(self, drawn: Callable[[cam.Table], dict[str, Any]], builds: int = BUILDS) -> None:
        """drawn: what is kept of a cam. builds: how many may be under way."""
        self.count = 0  # of cams so far
        self._most_builds = builds
        self._drawn = drawn
        self._drafts: OrderedDict[str, Draft] = OrderedDict()  # by name
        self._builds: OrderedDict[Key, Draft] = OrderedDict()
        self._known: OrderedDict[int, dict[str, Any]] = OrderedDict()  # by how many there were

    def take_command(self, message: msgs.command) -> None:
        if message.target != "machine" or message.verb not in VERBS:
            return
        key = (message.client, message.session, message.id)
        if key in self._builds or any(key in draft for draft in self._drafts.values()):  # sent again
            return
        first = message.verb == "begin_cam"
        name = _read(message.arguments).get("name" if first else "cam")
        if not isinstance(name, str):
            return
        if first:
            self._drafts.pop(name, None)
            _remember(self._drafts, name, OrderedDict(), DRAFTS)
        draft = self._drafts.get(name)
        if draft is None:
            return
        _remember(draft, key, message.arguments, MOST_PIECES)
        if message.verb == "build_cam":
            _remember(self._builds, key, self._drafts.pop(name), self._most_builds)

    def take_feedback(self, message: msgs.feedback) -> None:
        key = (message.client, message.session, message.id)
        if message.state < DONE or key not in self._builds:
            return
        draft = self._builds.pop(key)
        number = message.value
        if message.state != DONE or not 1 <= number < 2**53:
            return
        table = _table(draft)
        if table is not None:
            self.count += 1
            _remember(self._known, self.count, {"number": int(number), **self._drawn(table)}, KNOWN)

    def since(self, count: int) -> list[dict[str, Any]]:
        """Those behind this number of cams, as far as they are remembered."""
        return [known for at, known in self._known.items() if at > count]


def _table(draft: Draft) -> cam.Table | None:
    """None: pieces are missing."""
    head, *pieces, build = (_read(text) for text in draft.values())
    lists: dict[str, list[Any]] = {"points": [], "segments": []}
    try:
        for piece in sorted(pieces, key=lambda one: one.get("first", 0)):  # the network may change their order
            for name, items in lists.items():
                items += piece.get(name, [])
        given = {name: items for name, items in lists.items() if items}
        count = sum(map(len, given.values()))
        if "name" not in head or build.get("count", count) != count:
            return None
        return cam.Table.from_dict({**head, **given})
    except (ConfigError, TypeError, ValueError):
        return None


def _read(text: str) -> dict[str, Any]:
    try:
        read = load(text)
    except (yaml.YAMLError, ValueError):
        return {}
    return read if isinstance(read, dict) else {}


def _remember(memory: OrderedDict[Any, Any], key: Any, value: Any, most: int) -> None:
    memory[key] = value
    while len(memory) > most:
        memory.popitem(last=False)
