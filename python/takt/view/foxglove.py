"""`takt foxglove`: the scene and the signals of a running engine, live for Foxglove, by Foxglove's own server (PY-27).

A client sees the topics that `takt export --mcap` writes: /scene and /tf of the same description, and one topic per
component with its published values."""

from __future__ import annotations

import contextlib
import math
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from takt import _core
from takt.demo import free_url, taktd
from takt.ending import end_in_order
from takt.engine import read_machine
from takt.errors import TaktError
from takt.keys import KeyFile, read_key
from takt.network import usual_url
from takt.scene import foxglove as types
from takt.scene.moving import is_shown, node_pose, poses_of, rounded_poses
from takt.tables import KINDS, unit_of, units_of
from takt.view.feed import Feed
from takt.view.machine import Machine, Source

HOST = "127.0.0.1"
RATE_HZ = 25.0
NEEDS = "a live link to Foxglove needs the package foxglove-sdk: pip install 'takt-motion[foxglove]'"


class Link:
    """A Foxglove server that publishes one engine after the other. All of it happens in `tick`, on one thread."""

    def __init__(self, feed: Feed, port: int) -> None:
        try:
            import foxglove
        except ImportError:
            raise TaktError(NEEDS) from None
        self._foxglove = foxglove
        self._feed = feed
        self._context = foxglove.Context()
        self._epoch = 0
        self._channels: dict[str, Any] = {}
        self._last: dict[str, Any] = {}  # last published value of each frame and belt
        self._complete = threading.Event()  # the complete state is to be published
        listener: Any = _Listener(self._complete)  # the package's protocol demands more methods than it needs
        try:
            self._server = foxglove.start_server(
                name="takt", host=HOST, port=port, context=self._context, server_listener=listener
            )
        except Exception as error:  # the package raises nothing narrower
            raise TaktError(f"port {port} cannot be used for Foxglove: {error}") from None

    @property
    def port(self) -> int:
        return int(self._server.port)

    def stop(self) -> None:
        self._server.stop()

    def tick(self) -> None:
        """Publishes what has changed."""
        self._feed.tick()
        machine, overview = self._feed.machine, self._feed.overview
        if machine is None or overview is None or self._feed.engine is None:
            return
        if self._epoch != self._feed.epoch:
            self._begin(machine)
        time_s = overview.cycle * machine.period_s
        if self._complete.is_set():
            self._complete.clear()
            self._last.clear()
            entities = [*types.entities(machine.scene, time_s), *types.tracks(machine, time_s)]
            self._say(types.SHAPES, {"deletions": [], "entities": entities}, time_s)
        self._say_transforms(machine, time_s)
        for node in machine.scene["nodes"]:
            shown = is_shown(node, overview.value)
            if "shown" in node and self._last.get(f"shown {node['name']}", False) != shown:
                self._last[f"shown {node['name']}"] = shown
                self._say(types.SHAPES, types.coming_or_going(node, shown, time_s), time_s)
        for belt, rows in self._feed.objects.items():
            size = machine.scene.get("belts", {}).get(belt, {}).get("size")
            if size and self._last.get(f"belt {belt}") != rows:
                self._last[f"belt {belt}"] = rows
                entity = types.products_on(belt, size, rows, time_s)
                self._say(types.SHAPES, {"deletions": [], "entities": [entity]}, time_s)
        for source in machine.sources:
            if overview.heard(source.index):
                self._say(types.topic_of(source.name), self._values(source, time_s), time_s)

    def _begin(self, machine: Machine) -> None:
        self._epoch = self._feed.epoch
        for channel in self._channels.values():
            channel.close()
        schemas = {types.SHAPES: types.SCENE, types.POSES: types.TRANSFORMS}
        schemas |= {types.topic_of(source.name): _schema(machine, source) for source in machine.sources}
        self._channels = {
            topic: self._foxglove.Channel(topic, schema=schema, context=self._context)
            for topic, schema in schemas.items()
        }
        self._complete.set()

    def _say(self, topic: str, message: Any, time_s: float) -> None:
        self._channels[topic].log(message, log_time=round(time_s * 1e9))

    def _say_transforms(self, machine: Machine, time_s: float) -> None:
        overview, scene, changed = self._feed.overview, machine.scene, []
        assert overview is not None
        links = {name: np.array(poses) for name, poses in self._feed.links.items() if poses}
        for node in scene["nodes"]:
            moved = node.get("moved", {})
            if "link" in moved and moved["group"] not in links:
                continue
            matrix = node_pose(scene, node, links, overview.value)
            if not all(map(math.isfinite, matrix.ravel().tolist())):
                continue
            pose = rounded_poses(poses_of(matrix)).tolist()
            if self._last.get(node["name"]) != pose:
                self._last[node["name"]] = pose
                changed.append(types.transform(node["name"], pose, time_s))
        if changed:
            self._say(types.POSES, {"transforms": changed}, time_s)

    def _values(self, source: Source, time_s: float) -> dict[str, Any]:
        overview, kind = self._feed.overview, KINDS[source.kind]
        assert overview is not None
        said: dict[str, Any] = {"time_s": time_s}
        for field, value in zip(kind.units, overview.values(source.index, kind.units).tolist(), strict=True):
            if not math.isfinite(value):
                continue
            if field in kind.names:
                with contextlib.suppress(KeyError, IndexError):  # value of another version
                    said[field] = str(kind.names[field][int(value)])
            else:
                said[field] = bool(value) if kind.dtypes[field] == np.bool_ else value
        return said


def _schema(machine: Machine, source: Source) -> dict[str, Any]:
    """Returns the schema of a component's topic, as in `takt export --mcap`: units in the descriptions, enumerations as
    texts."""
    kind, own = KINDS[source.kind], units_of(machine.parameters, KINDS[source.kind], source.parameters)
    properties: dict[str, Any] = {"time_s": {"type": "number", "description": "s"}}
    for field in kind.units:
        if field in kind.names:
            properties[field] = {"type": "string"}
        elif kind.dtypes[field] == np.bool_:
            properties[field] = {"type": "boolean"}
        else:
            properties[field] = {"type": "number", "description": unit_of(source.kind, field, own)}
    return {"title": f"takt.{source.name}", "type": "object", "properties": properties}


class _Listener:
    """Listener of Foxglove's server, on its own threads: a new subscriber needs the complete state."""

    def __init__(self, complete: threading.Event) -> None:
        self._complete = complete

    def on_subscribe(self, client: Any, channel: Any) -> None:
        self._complete.set()

    def __getattr__(self, name: str) -> Callable[..., None]:
        if name.startswith("on_"):
            return lambda *_: None
        raise AttributeError(name)


def run(what: str | None, port: int, pace: str, say: Callable[[str], None], key_file: KeyFile | None = None) -> int:
    """Serves the engine of a network (its URL; None: the default one), or an own engine for a machine file. Returns the
    exit status."""
    key = read_key(key_file)
    end_in_order()
    with contextlib.ExitStack() as stack:
        if what is None or "://" in what:
            url, file, engine = what or usual_url(), None, None
        else:
            url, file = free_url(), Path(what)
            _core.load_machine(*read_machine(file))  # raises if the file is invalid
        link = Link(Feed(url, key, file), port)
        stack.callback(link.stop)
        if file is not None:
            directory = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="takt-foxglove-")))
            engine = stack.enter_context(taktd(file, url, None, pace, directory, key))
        say(f"{what or url}: open ws://{HOST}:{link.port} in Foxglove (Ctrl-C ends it)")
        while engine is None or engine.poll() is None:
            link.tick()
            time.sleep(1 / RATE_HZ)
        say(f"taktd has ended: {(directory / 'taktd.txt').read_text(errors='replace').strip()}")
        return 0 if engine.returncode == 0 else 1
