"""The live link to Foxglove (PY-27): a client that knows nothing of Foxglove's package speaks its protocol, and holds
every message against the schema that was advertised."""

from __future__ import annotations

import contextlib
import json
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import takt
from machines import new_url, running
from takt.view.feed import Feed
from test_scene import one_group
from websockets.sync.client import connect
from websockets.typing import Subprotocol

pytest.importorskip("foxglove")

from takt.view.foxglove import NEEDS, Link

DELTA = {"delta": {"base_radius": 200, "platform_radius": 45, "upper_arm": 235, "lower_arm": 800}}
MESSAGE = 1  # the opcode of message data: then the subscription, ns, and the message


class Client:
    """What Foxglove does: reads what is there, subscribes, gets messages."""

    def __init__(self, link: Link, socket: Any) -> None:
        self._link = link
        self._socket = socket
        self.channels: dict[int, dict[str, Any]] = {}
        self.checks: dict[int, Any] = {}
        self.server: dict[str, Any] = {}

    def hear(self, topics: set[str]) -> dict[str, dict[str, Any]]:
        """One message of each of these topics; each is as its schema says."""
        found: dict[str, dict[str, Any]] = {}
        for _ in range(2000):
            if set(found) == topics:
                return found
            self._link.tick()
            try:
                data = self._socket.recv(timeout=0.02)
            except TimeoutError:
                continue
            if isinstance(data, str):
                self._take(json.loads(data), topics)
            elif data[0] == MESSAGE:
                number, _ = struct.unpack_from("<IQ", data, 1)
                message = json.loads(data[13:])
                self.checks[number].validate(message)
                found.setdefault(self.channels[number]["topic"], message)
        raise AssertionError(f"heard only {sorted(found)} of {sorted(topics)}")

    def _take(self, said: dict[str, Any], topics: set[str]) -> None:
        if said["op"] == "serverInfo":
            self.server = said
        if said["op"] != "advertise":
            return
        for channel in said["channels"]:
            self.channels[channel["id"]] = channel
            self.checks[channel["id"]] = jsonschema.Draft202012Validator(json.loads(channel["schema"]))
        wanted = [{"id": n, "channelId": n} for n, channel in self.channels.items() if channel["topic"] in topics]
        self._socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))


@contextlib.contextmanager
def client_of(link: Link) -> Iterator[Client]:
    with connect(f"ws://127.0.0.1:{link.port}", subprotocols=[Subprotocol("foxglove.sdk.v1")]) as socket:
        yield Client(link, socket)


def test_a_client_sees_frames_solids_and_signals_of_a_running_engine(tmp_path: Path) -> None:
    url = new_url()
    with running(tmp_path, url, machine=one_group(DELTA)):
        with takt.connect(url) as session:
            session.axis("a0").power().wait()
            session.axis("a0").move_absolute(position=20).wait()
        link = Link(Feed(url), 0)
        with client_of(link) as client:
            heard = client.hear({"/scene", "/tf", "/a0"})
        assert client.server["name"] == "takt"
        named = {channel["topic"]: channel["schemaName"] for channel in client.channels.values()}
        assert (named["/scene"], named["/tf"]) == ("foxglove.SceneUpdate", "foxglove.FrameTransforms")
        assert heard["/a0"]["actual_position"] == pytest.approx(20, abs=0.1)
        assert heard["/a0"]["state"] == "Standstill"
        frames = {one["child_frame_id"] for one in heard["/tf"]["transforms"]}
        assert {one["frame_id"] for one in heard["/scene"]["entities"]} <= frames
        with client_of(link) as late:  # it hears all, though nothing has changed since
            again = late.hear({"/scene", "/tf"})
        assert {one["child_frame_id"] for one in again["/tf"]["transforms"]} == frames
        with pytest.raises(takt.TaktError, match=f"port {link.port} cannot be used for Foxglove"):
            Link(Feed(url), link.port)
        link.stop()


def test_an_axis_named_like_a_topic(tmp_path: Path) -> None:
    """PY-27: `/tf` keeps its transforms, and the axis `tf` its values."""
    url = new_url()
    machine = "name: m\naxes: [{name: tf, limits: {velocity: 100, acceleration: 1000, jerk: 10000}}]\n"
    with running(tmp_path, url, machine=machine):
        link = Link(Feed(url), 0)
        with client_of(link) as client:
            heard = client.hear({"/components/tf", "/scene"})
        named = {channel["topic"]: channel["schemaName"] for channel in client.channels.values()}
        assert named["/tf"] == "foxglove.FrameTransforms"
        assert "set_position" in heard["/components/tf"]
        link.stop()


def test_without_the_package(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is said how to get it."""
    monkeypatch.setitem(sys.modules, "foxglove", None)
    with pytest.raises(takt.TaktError) as caught:
        Link(Feed(new_url()), 0)
    assert str(caught.value) == NEEDS
