"""Cams made at run time, assembled from commands (CAM-88): from those on the network, for the page, or from those of a
log."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import yaml

from takt import cam, msgs
from takt.errors import ConfigError
from takt.yaml_text import load

MOST_PIECES = 500  # of one cam; the page shows no curve of a longer one
DRAFTS = 4  # stored drafts; an engine has two
BUILDS = 16  # in progress
KNOWN = 256  # stored cams
DONE = msgs.feedback.STATE_DONE
VERBS = {"begin_cam", "add_cam_points", "add_cam_segments", "build_cam"}

Key = tuple[str, int, int]
Draft = OrderedDict[Key, str]  # arguments of the commands that sent a cam


class MadeCams:
    """Cams by number, and the stored form of each. Cams made before listening began, or received only in part, are
    missing."""

    def __init__(self, drawn: Callable[[cam.Table], dict[str, Any]], builds: int = BUILDS) -> None:
        """drawn: returns the stored form of a cam. builds: largest number of builds in progress."""
        self.count = 0  # number of cams so far
        self._most_builds = builds
        self._drawn = drawn
        self._drafts: OrderedDict[str, Draft] = OrderedDict()  # by name
        self._builds: OrderedDict[Key, Draft] = OrderedDict()
        self._known: OrderedDict[int, dict[str, Any]] = OrderedDict()  # by the count at their creation

    def take_command(self, message: msgs.command) -> None:
        if message.target != "machine" or message.verb not in VERBS:
            return
        key = (message.client, message.session, message.id)
        if key in self._builds or any(key in draft for draft in self._drafts.values()):  # a repetition
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
        """Returns the cams made after the first `count`, as far as they are stored."""
        return [known for at, known in self._known.items() if at > count]


def _table(draft: Draft) -> cam.Table | None:
    """Returns the cam of a draft; None if pieces are missing or invalid."""
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
