"""The server of the live page: what it keeps, what it counts, what it says over its socket."""

from __future__ import annotations

import itertools
import json
import math
import os
import random
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from hypothesis import given
from hypothesis import strategies as st
from machines import machine_with, new_url, running
from pages import Client, served, start_server
from takt import msgs
from takt.cam import Table
from takt.network import open_network
from takt.tables import KINDS
from takt.view.commander import Commander
from takt.view.feed import Tap
from takt.view.layout import Layout
from takt.view.ledger import Ledger
from takt.view.machine import Machine, drawn
from takt.view.made import MadeCams
from takt.view.protocol import MOST_SIGNALS, RequestError, frame, parse
from takt.view.ring import Ring
from takt.view.shapes import Routes, Shapes
from takt.view.status import LIVE, WORDS, name_in, words
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect as connect_socket

FULL_RATE = machine_with("{axis_rate_hz: 1000, dead_man_s: 0.5}")
EXAMPLES = Path(__file__).parents[2] / "python" / "examples"


def described(text: str, period: float = 0.001) -> msgs.machine_description:
    message = msgs.machine_description()
    message.text, message.name, message.run_id, message.period_s = text, "test", 1, period
    return message


# --- tables of messages ---


@pytest.mark.parametrize("kind", KINDS)
def test_rows_of_messages_are_what_decoding_gives(kind: str) -> None:
    chance = random.Random(kind)
    layout = Layout(kind, "größe 1")
    messages = []
    for _ in range(5):
        message = KINDS[kind].message()
        message.name = "größe 1"
        message.cycle, message.time_ns, message.sequence = (chance.randrange(2**62) for _ in range(3))
        for field in message.__slots__:
            value = getattr(message, field)
            if type(value) is float:
                setattr(message, field, chance.choice([chance.gauss(0, 1e6), math.nan, math.inf, -0.0]))
            elif type(value) is bool:
                setattr(message, field, chance.random() < 0.5)
            elif type(value) is int and field not in ("utime", "cycle", "time_ns", "sequence"):
                setattr(message, field, chance.randrange(-128, 128))
        messages.append(message)
    encoded = [message.encode() for message in messages]
    assert all(layout.fits(data) for data in encoded)
    rows = layout.rows(encoded)
    for field in KINDS[kind].getters:
        given_values = [float(KINDS[kind].getters[field](message)) for message in messages]
        np.testing.assert_array_equal(rows[field].astype(float), given_values)
    np.testing.assert_array_equal(rows["cycle"], [message.cycle for message in messages])


def test_messages_of_others_do_not_fit() -> None:
    layout = Layout("axis", "x")
    message = msgs.axis_state()
    message.name = "x"
    assert layout.fits(message.encode())
    message.name = "y"
    assert not layout.fits(message.encode())
    message.name = "x"
    assert not layout.fits(message.encode()[:-1])
    assert not layout.fits(b"\0" * len(message.encode()))
    belt = msgs.belt_state()
    belt.name = "x"
    assert not layout.fits(belt.encode())


# --- rings ---


@given(st.lists(st.integers(0, 25), max_size=30), st.integers(1, 12), st.data())
def test_a_reader_of_a_ring_gets_every_row_once_or_counts_it(sizes: list[int], most: int, data: st.DataObject) -> None:
    ring = Ring(("a", "b"), capacity=16)
    written = 0
    cursor = seen = skipped = 0
    for size in sizes:
        cycles = np.arange(written, written + size)
        ring.append(cycles, np.stack([cycles * 2.0, cycles * 3.0]))
        written += size
        for _ in range(data.draw(st.integers(0, 4))):
            piece = ring.since(cursor, ("b",), most)
            assert len(piece.cycles) <= most
            np.testing.assert_array_equal(piece.cycles, np.arange(cursor + piece.skipped, piece.cursor))
            np.testing.assert_array_equal(piece.columns, [piece.cycles * 3])
            cursor = piece.cursor
            seen += len(piece.cycles)
            skipped += piece.skipped
    assert seen + skipped == cursor <= written
    assert len(ring.since(0, (), 100).cycles) == min(written, 16)


def test_a_ring_with_other_fields_keeps_its_rows() -> None:
    ring = Ring(("a",), capacity=8)
    ring.append(np.arange(12), np.arange(12.0)[None])
    wider = ring.with_fields(("b", "a"))
    wider.append(np.array([12]), np.array([[7.0], [12.0]]))
    piece = wider.since(0, ("a", "b"), 100)
    np.testing.assert_array_equal(piece.cycles, np.arange(5, 13))
    np.testing.assert_array_equal(piece.columns[0], np.arange(5.0, 13))
    np.testing.assert_array_equal(piece.columns[1], [math.nan] * 7 + [7])
    assert wider.after(9) == 10
    assert wider.after(-1) == 5
    assert wider.after(99) == 13


# --- losses ---


def state(cycle: int, sequence: int, position: float = 0.0) -> bytes:
    message = msgs.axis_state()
    message.name, message.cycle, message.sequence, message.time_ns = "x", cycle, sequence, cycle * 1_000_000
    message.set_position = position
    return bytes(message.encode())


def test_what_is_lost_on_the_way_is_counted() -> None:  # EN-20
    source = Machine(described(FULL_RATE)).by_name["x"]
    tap = Tap(source, 0.001)
    tap.ring = tap.ring.with_fields(("set_position",))
    for sequence in (*range(100, 110), *range(113, 120), 119, 118, 125):  # 3 lost, a repeated, a late one, 5 lost
        tap.take("", state(sequence * 2, sequence, sequence / 10))
    tap.take("", b"nonsense")
    impossible = msgs.axis_state.decode(state(400, 126))
    impossible.time_ns += 10_000_000
    tap.take("", impossible.encode())
    tap.take("", state(10**12, 127))  # later than can be: those behind it count
    tap.take("", state(252, 126))
    tap.drain(1000)
    assert (tap.lost, tap.malformed) == (8, 3)
    piece = tap.ring.since(0, ("set_position",), 1000)
    expected = [*range(100, 110), *range(113, 120), 125, 126]
    np.testing.assert_array_equal(piece.cycles, np.array(expected) * 2)
    np.testing.assert_array_equal(piece.columns[0], np.array([*expected[:-1], 0]) / 10)
    tap.take("", state(260, 130))  # and on from the last one of before
    tap.drain()
    assert tap.lost == 11


# --- words ---


def test_every_published_name_exists() -> None:
    for table in (LIVE, WORDS):
        for kind, fields in table.items():
            assert set(fields) <= set(KINDS[kind].units), kind


def values_of(kind: str, **said: float) -> dict[str, float]:
    return dict.fromkeys(WORDS[kind], 0) | said


def test_why_something_waits() -> None:
    name_of = name_in({"mover": ["left", "right"], "track": ["loop"], "axis": ["x", "y"]})
    mover = values_of("mover", state=2, command_mode=2, track=1, delay=1, waits_for=2, delay_since=500)
    said = words("mover", mover, name_of)
    assert (said.state, said.more, said.waits, said.since) == ("Enabled", "on loop", "waits for right", 500)
    assert "deadlocked" in words("mover", {**mover, "deadlocked": 1}, name_of).waits
    assert words("mover", values_of("mover", delay=2), name_of).waits == "at the end of its track"
    assert words("mover", values_of("mover", delay=5), name_of).waits == "waits for its master"
    assert words("mover", values_of("mover", delay=8), name_of).waits == "waits until nothing moves on a track"
    assert words("mover", values_of("mover", delay=9), name_of).waits == "waits until it has left its formation"
    place = words("mover", values_of("mover", delay=10, blocker=2), name_of)
    assert place.waits == "waits for its next place, which right visits before"
    axis = words("axis", values_of("axis", state=2, limited_by=1, buffered_commands=2, override_factor=0.5), name_of)
    assert (axis.state, axis.waits) == ("DiscreteMotion", "")
    assert axis.more == "held back by its limit of velocity, 2 commands behind it, override 50 %"
    assert words("axis", values_of("axis", state=2, override_factor=0), name_of).waits == "the override is 0"
    follower = words("axis", values_of("axis", state=4, master1=2, synchronizing=1, override_factor=1), name_of)
    assert (follower.more, follower.waits) == ("follows y", "gets into step")
    assert words("part", values_of("part", position_index=0, commanded_index=3), name_of).waits.endswith("position 3")
    for kind in KINDS:  # any number whatever is put into words
        words(kind, dict.fromkeys(WORDS[kind], 1), name_of)
        words(kind, dict.fromkeys(WORDS[kind], 0), name_in({}))


def test_tracks_and_routes_are_told_once_and_damaged_ones_never() -> None:  # EN-22, PL-72
    shapes, routes = Shapes(("lift",)), Routes()
    shape, route = msgs.track_shape(), msgs.mover_route()
    shape.name, shape.part, shape.count, shape.position, shape.x, shape.y = "loop", 1, 2, [0, 5], [1, 6], [2, 2]
    route.name, route.first, route.count, route.x, route.y = "one", 7, 2, [60, 180.004], [60, 60]
    for _ in range(2):
        shapes.take(shape)
        routes.take(route)
    assert shapes.since(0) == [{"name": "loop", "part": "lift", "closed": False, "points": [0, 1, 2, 5, 6, 2]}]
    assert routes.since(0) == [{"name": "one", "first": 7, "points": [60, 60, 180, 60]}]
    for wrong in (math.nan, math.inf, -math.inf):
        shape.x, route.y = [1, wrong], [wrong, 60]
        shapes.take(shape)
        routes.take(route)
    shape.x = [1, 6]
    for shape.part in (2, -1, 2**31 - 1):
        shapes.take(shape)
    assert (shapes.count, routes.count) == (1, 1)
    route.count, route.x, route.y = 0, [], []
    routes.take(route)
    assert routes.since(1) == [{"name": "one", "first": 7, "points": []}]


def test_cams_that_pass_by_are_known_when_they_are_whole() -> None:  # CAM-88
    made = MadeCams(lambda table: {"name": table.name, "end": table.end, "stroke": table.stroke})
    ids = itertools.count(1)

    def told(verb: str, arguments: str) -> msgs.command:
        message = msgs.command()
        message.client, message.session, message.id, message.target = "line", 1, next(ids), "machine"
        message.verb, message.arguments = verb, arguments
        made.take_command(message)
        return message

    def answer(command: msgs.command, value: float, state: int = msgs.feedback.STATE_DONE) -> list[dict[str, Any]]:
        before = made.count
        message = msgs.feedback()
        message.client, message.session, message.id = command.client, command.session, command.id
        message.state, message.value = state, value
        made.take_feedback(message)
        return made.since(before)

    def send(*pieces: str, count: int = 3) -> msgs.command:
        told("begin_cam", "{name: lift, interpolation: linear}")
        for piece in pieces:
            command = told("add_cam_points", piece)
            made.take_command(command)  # sent again
        return told("build_cam", f"{{cam: lift, count: {count}}}")

    first = "{cam: lift, first: 0, points: [{x: 0, y: 1e-05}, {x: 1.0, y: 2.0}]}"
    last = "{cam: lift, first: 2, points: [{x: 4.0, y: 3.0}]}"
    for pieces in ((first, last), (last, first)):  # in the order of the network
        assert answer(send(*pieces), 7.0) == [{"number": 7, "name": "lift", "end": 4.0, "stroke": 2.99999}]
    assert answer(send(first), 8.0) == []  # a piece was not heard
    assert answer(send(first, last), 0.0, msgs.feedback.STATE_ERROR) == []
    assert answer(send(first, last, "{cam: lift, first: 3, points: [{x: .nan}]}", count=4), 9.0) == []
    for value in (math.nan, math.inf, -1.0, 0.0):
        assert answer(send(first, last), value) == []
    for nonsense in ("", "{", "[1]", "{name: [1]}", "{cam: {}}", "{cam: unknown}"):
        for verb in ("begin_cam", "add_cam_points", "build_cam"):
            assert answer(told(verb, nonsense), 10.0) == []


def test_the_ledger_knows_what_became_of_commands() -> None:
    ledger = Ledger(["x"])
    command, feedback = msgs.command(), msgs.feedback()
    command.client = feedback.client = "me"
    command.session = feedback.session = 7
    command.id = feedback.id = 1
    command.target, command.verb, command.arguments = "x", "move_absolute", "{position: 100}"
    ledger.take_command(command, 10)
    ledger.take_command(command, 11)  # sent again
    feedback.ticket, feedback.state, feedback.cycle = 42, 1, 12
    ledger.take_feedback(feedback)
    assert ledger.command_of("x", 42) == ledger.command_of("x") == "move_absolute {position: 100}"
    assert ledger.command_of("x", 43) == "command 43"
    feedback.state, feedback.error_id, feedback.sentence, feedback.cycle = 4, 2006, "too far", 20
    ledger.take_feedback(feedback)
    ledger.take_feedback(feedback)
    assert ledger.command_of("x") == ""
    assert ledger.trouble_of("x") == "too far"
    assert [(e.cycle, e.state, e.sentence) for e in ledger.since(0)] == [(10, "given", ""), (20, "error", "too far")]
    assert ledger.since(2) == []
    feedback.client = "somebody else"
    ledger.take_feedback(feedback)
    assert ledger.count == 2
    command.id, command.target = 2, "nobody"
    ledger.take_command(command, 30)
    feedback.client, feedback.id, feedback.state, feedback.ticket = "me", 2, 0, 0
    ledger.take_feedback(feedback)
    assert (ledger.command_of("nobody"), ledger.trouble_of("nobody")) == ("", "")


# --- what pages ask ---


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("nonsense", "JSON"),
        ("[]", "a request has"),
        ('{"jog": 1}', "a request has"),
        ('{"ack": "1"}', "number of a frame"),
        ('{"epoch": 1, "signals": [[0, "nothing"]]}', "publishes no 'nothing'"),
        ('{"epoch": 1, "signals": [[7, "set_position"]]}', "no component 7"),
        ('{"epoch": 1, "signals": [[true, "set_position"]]}', "no component True"),
        ('{"epoch": 1, "signals": 3}', "list of pairs"),
        ('{"epoch": 1, "signals": [[0, "set_position"]], "after": [[0, "x"]]}', "no number"),
        ('{"epoch": 1, "details": "x"}', "list of components"),
        ('{"epoch": 1, "signals": [[0, []]]}', r"publishes no \[\]"),
        ('{"epoch": 1, "signals": [[0, "set_position"]], "after": [[0, 1%s]]}' % ("0" * 400), "finite"),
        ("[" * 100_000, "JSON"),
        ('{"epoch": 1, "command": ["machine", "add_cam_points", {"points": [{"x": 1%s}]}]}' % ("0" * 400), "a command"),
        ('{"epoch": 1, "command": "jog"}', "a command has"),
        ('{"epoch": 1, "command": ["x", "jog", {"velocity": "}, evil: {"}]}', "a command has"),
        *(
            (json.dumps({"epoch": 1, "command": ["machine", "add_cam_points", {"points": points}]}), "a command has")
            for points in ([3], [{"x": "1"}], [{"x": True}], [{"z": 1}], [{"x": math.nan}], [{"x": 1}] * 21, {"x": 1})
        ),
        *(
            (json.dumps({"epoch": 1, "command": ["machine", "begin_cam", {"name": name}]}), "a command has")
            for name in ("", "a: b", "a, b", 'a"', "a\\", "a\n", "x" * 61)
        ),
        (json.dumps({"epoch": 1, "signals": [[0, "set_position"]] * (MOST_SIGNALS + 1)}), "too many"),
    ],
)
def test_wrong_requests_get_a_sentence(text: str, sentence: str) -> None:
    with pytest.raises(RequestError, match=sentence):
        parse(text, Machine(described(FULL_RATE)), 1)


def test_requests_about_another_machine_are_left_out() -> None:
    request = parse('{"ack": 3, "epoch": 1, "signals": [[0, "nothing"]]}', Machine(described(FULL_RATE)), 2)
    assert (request.ack, request.signals, request.details) == (3, None, None)


def test_a_frame_is_aligned() -> None:
    for text in ("", "a", "äöü", "abcdefg"):
        data = frame({"t": text}, [np.array([1.5, math.nan]), np.arange(3)])
        assert len(data) % 8 == 0
        np.testing.assert_array_equal(np.frombuffer(data[-40:]), [1.5, math.nan, 0, 1, 2])


def test_cams_are_edited_at_points_and_ends_of_segments() -> None:  # CAM-88
    def knots(**cam: Any) -> list[list[float]] | None:
        known: list[list[float]] | None = drawn(Table.from_dict({"name": "c", **cam}))["knots"]
        return known

    law = {"law": "modified_sine"}  # three pieces
    segments = [
        {"to": {"x": 90, "y": 40}, **law},
        {"to": {"x": 120, "y": 40}, "law": "dwell"},
        {"to": {"x": 360, "y": 0}, **law},
    ]
    found = knots(cyclic=True, segments=segments)
    assert found is not None
    assert [knot[:2] for knot in found] == [[0, 0], [90, 40], [120, 40], [360, 0]]
    np.testing.assert_allclose([knot[2:] for knot in found], 0, atol=1e-12)
    points = [{"x": x, "y": y} for x, y in ((0, 0), (90, 10), (200, 5), (360, 0))]
    found = knots(cyclic=True, points=points)
    assert found is not None
    assert found[0][1:] == found[-1][1:]
    again = Table.from_dict(
        {"name": "c", "cyclic": True, "points": [dict(zip("xyva", one, strict=True)) for one in found]}
    )
    x = np.linspace(0, 360, 200)
    np.testing.assert_allclose(
        again.at(x).y, Table.from_dict({"name": "c", "cyclic": True, "points": points}).at(x).y, atol=1e-9
    )
    assert knots(interpolation="linear", points=points) is None
    assert knots(points=[{"x": i, "y": i * i} for i in range(61)]) is None


@pytest.mark.parametrize("example", sorted(path.parent.name for path in EXAMPLES.glob("*/machine.yaml")))
def test_every_example_can_be_described(example: str) -> None:
    machine = Machine(described((EXAMPLES / example / "machine.yaml").read_text()), EXAMPLES / example)
    shown = json.loads(json.dumps(machine.describe(), allow_nan=False))
    assert len(shown["components"]) == len(machine.sources) > 0
    assert {group["name"] for group in shown["plan"]["groups"]} == set(machine.mechanisms)
    assert len(shown["cams"]) == len(machine.parameters["cams"])
    assert len(shown["plan"]["tracks"]) == len(machine.parameters["tracks"])


# --- a running server ---


def test_signals_come_without_loss_and_as_the_engine_has_them(tmp_path: Path) -> None:
    url = new_url()
    fields = ["set_position", "set_velocity", "set_acceleration", "actual_position", "following_error", "state"]
    names = [f"{axis}.{field}" for axis in "xr" for field in fields]
    with running(tmp_path, url, machine=FULL_RATE), served(url) as address, takt.connect(url) as session:
        x, r = session.axis("x"), session.axis("r")
        with Client(address) as client:
            client.look_at(*names, details=[client.index("x")])
            client.until(lambda: len(client.signal("x.state")[0]) > 10)
            record = session.record()
            for axis in (x, r):
                axis.power().wait()
            x.move_absolute(position=300)
            r.move_relative(distance=700).wait()
            x.move_absolute(position=20).wait()
            recording = record.stop()
            client.until(lambda: client.signal("x.state")[0][-1] > recording["x"]["cycle"][-1])
            for axis in "xr":
                cycles, _ = client.signal(f"{axis}.state")
                np.testing.assert_array_equal(np.diff(cycles), 1)
                at = np.searchsorted(cycles, recording[axis]["cycle"])
                for field in fields:
                    _, values = client.signal(f"{axis}.{field}")
                    np.testing.assert_array_equal(values[at], recording[axis][field].astype(float))
            assert client.header["health"] | {"messages": 0} == {
                **dict.fromkeys(("lost", "skipped", "messages"), 0),
                **{"gone": False, "trouble": ""},
            }
            client.until(lambda: client.state("x") == "Standstill")  # rows come by themselves, and now and then
            row = client.rows[client.index("x")]
            assert (row["state"], row["error"], row["command"]) == ("Standstill", 0, "")
            x.move_velocity(velocity=20.0)
            client.until(lambda: client.rows[client.index("x")]["command"] == "move_velocity {velocity: 20.0}")
            refused = x.move_absolute(position=5000)
            assert refused.error
            client.until(lambda: client.rows[client.index("x")]["refused"] == refused.sentence)
            x.halt().wait()


def test_two_pages_a_slow_one_and_one_that_comes_back(tmp_path: Path) -> None:
    url = new_url()
    with running(tmp_path, url, machine=FULL_RATE), served(url) as address, Client(address) as quick:
        quick.look_at("x.set_position")
        quick.until(lambda: len(quick.signal("x.set_position")[0]) > 0)
        with Client(address) as slow:
            slow.look_at("r.set_position", "x.actual_position")
            slow.until(lambda: len(slow.signal("r.set_position")[0]) > 0)
            end = time.monotonic() + 3
            quick.until(lambda: time.monotonic() > end)  # meanwhile nobody reads what the slow one is told
            newest = quick.signal("x.set_position")[0][-1]
            slow.until(lambda: slow.signal("r.set_position")[0][-1] > newest)
            cycles, _ = slow.signal("r.set_position")
            np.testing.assert_array_equal(np.diff(cycles), 1)
            assert slow.header["n"] < 2 + 4 + 40  # few large frames, not all that would have been due
        last = float(cycles[-1])
        end = time.monotonic() + 0.5
        quick.until(lambda: time.monotonic() > end)
        with Client(address) as again:  # gets what it missed
            again.look_at("r.set_position", after=[[again.index("r"), last]])
            again.until(lambda: len(again.signal("r.set_position")[0]) > 500)
            cycles, _ = again.signal("r.set_position")
            assert cycles[0] == last + 1
            np.testing.assert_array_equal(np.diff(cycles), 1)
        np.testing.assert_array_equal(np.diff(quick.signal("x.set_position")[0]), 1)
        assert quick.header["health"]["skipped"] == quick.header["health"]["lost"] == 0


def test_wrong_bytes_and_other_sites(tmp_path: Path) -> None:
    url = new_url()
    with running(tmp_path, url), served(url) as address, Client(address) as client:
        for text in ("{", "[1]", '{"signals": 1, "epoch": 1}', '{"epoch": 1, "details": [-1]}'):
            client.say(text)
        client.until(lambda: len(client.complaints) == 4)
        client.look_at("x.state")
        client.until(lambda: len(client.signal("x.state")[0]) > 0)
        for origin in ("http://example.org", None):
            with pytest.raises(InvalidStatus), connect_socket(address.replace("http", "ws") + "live", origin=origin):
                pass
        for path in ("page/../server.py", "page/%2e%2e/server.py", "nothing", "page/"):
            with pytest.raises(urllib.error.HTTPError):
                urllib.request.urlopen(address + path)
        strange = urllib.request.Request(address, headers={"Host": "example.org"})
        with pytest.raises(urllib.error.HTTPError, match="400"):
            urllib.request.urlopen(strange)
        page = urllib.request.urlopen(address)
        assert "default-src 'self'" in page.headers["content-security-policy"]


def test_nonsense_on_the_network(tmp_path: Path) -> None:
    """EN-22: bytes changed or made up on every channel the page listens to."""
    url = new_url()
    chance = random.Random(5)
    machine, engine, feedback = msgs.machine_description(), msgs.engine_state(), msgs.feedback()
    with running(tmp_path, url, machine=FULL_RATE), served(url) as address, Client(address) as client:
        client.look_at("x.set_position")
        client.until(lambda: len(client.signal("x.set_position")[0]) > 0)
        network = open_network(url)
        machine.run_id, machine.period_s, machine.text = 99, math.nan, "nonsense: ["
        engine.run_id, engine.cycle = int(client.machine["run"]) + 1, 2**62
        feedback.state, feedback.error_id = 77, -5
        good = [state(5, 5), machine.encode(), engine.encode(), feedback.encode(), msgs.command().encode(), b""]
        channels = [f"takt/{name}" for name in ("axis/x", "axis/r", "machine", "engine", "command", "feedback")]
        for _ in range(2000):
            data = bytearray(chance.choice(good))
            for _ in range(chance.randrange(4)):
                if data:
                    data[chance.randrange(len(data))] = chance.randrange(256)
            network.publish(chance.choice(channels), bytes(data[: chance.randrange(len(data) + 1)] or data))
        network.publish("takt/axis/x", state(10**12, 10**9))
        machine.period_s = 0.001
        network.publish("takt/machine", machine.encode())
        client.until(lambda: "another engine" in client.header["health"]["trouble"])
        before = len(client.signal("x.set_position")[0])
        client.until(lambda: len(client.signal("x.set_position")[0]) > before + 500)
        cycles, values = client.signal("x.set_position")
        assert np.all(np.diff(cycles) > 0)
        np.testing.assert_array_equal(values, 0.0)
        assert client.machine["name"] == "test"
        assert client.header["cycle"] < 10**9


def test_another_engine_takes_the_place_of_the_first(tmp_path: Path) -> None:
    url = new_url()
    other = (
        "name: other\nlcm: {axis_rate_hz: 1000}\naxes: [{name: z, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\n"
    )
    with served(url) as address:
        with running(tmp_path, url, machine=FULL_RATE), Client(address) as client:
            client.look_at("r.set_position", "x.set_position")
            client.until(lambda: len(client.signal("r.set_position")[0]) > 0)
            first = client.machine["epoch"]
        with Client(address) as client:
            client.until(lambda: client.header["health"]["gone"])
            client.look_at("r.set_position")
            with running(tmp_path, url, machine=other):
                client.until(lambda: client.machine["epoch"] == first + 1)
                assert (client.machine["name"], len(client.machine["components"])) == ("other", 1)
                client.ask(epoch=first, signals=[[1, "set_position"]])  # of the first: left out
                client.look_at("z.set_position")
                client.until(lambda: len(client.signal("z.set_position")[0]) > 10)
                assert not client.header["health"]["gone"]
                assert client.complaints == []
                with running(tmp_path, url, machine=FULL_RATE):
                    client.until(lambda: "another engine" in client.header["health"]["trouble"])
                    assert client.machine["name"] == "other"
            client.until(lambda: client.header["health"]["gone"])


def test_view_of_a_machine_file_runs_an_engine_of_its_own(tmp_path: Path) -> None:
    file = tmp_path / "machine.yaml"
    file.write_text(FULL_RATE)
    with served(str(file), "--pace", "paced") as address, Client(address) as client:
        client.look_at("x.state")
        client.until(lambda: len(client.signal("x.state")[0]) > 0)
        assert client.machine["name"] == "test"


def test_bad_input_of_the_command() -> None:
    def complaint(*arguments: str) -> str:
        command = [sys.executable, "-m", "takt", "view", "--no-browser", *arguments]
        result = subprocess.run(
            command, capture_output=True, text=True, timeout=60, env={**os.environ, "NO_COLOR": "1"}
        )
        assert result.returncode == 2, result.stderr
        (line,) = result.stderr.splitlines()
        return line

    assert "cannot be read" in complaint("nowhere.yaml")
    assert "LCM URL" in complaint("udpm://nowhere")
    with served(new_url()) as address:
        port = address.rsplit(":", 1)[1].rstrip("/")
        assert f"port {port} cannot be used" in complaint(new_url(), "--port", port)


# --- commands ---


ALLOWING = machine_with("{axis_rate_hz: 1000, dead_man_s: 1}") + "view: {commands: true}\n"


def test_a_page_commands_only_where_it_may(tmp_path: Path) -> None:
    url = new_url()
    with running(tmp_path, url, machine=FULL_RATE), served(url) as address, Client(address) as client:
        client.give("x", "power", enable=True)
        client.until(lambda: client.complaints)
        assert "does not let the page command" in client.complaints[0]
        client.until(lambda: client.state("x") == "Disabled")


def test_commands_from_a_page(tmp_path: Path) -> None:
    url = new_url()
    with running(tmp_path, url, machine=ALLOWING), served(url) as address, Client(address) as client:
        client.give("x", "power", enable=True)
        client.until(lambda: client.state("x") == "Standstill")
        for target, verb, arguments, sentence in (
            ("x", "move_absolute", {"position": 100}, "gives no 'move_absolute'"),
            ("x", "halt", {"deceleration": 1}, "no arguments alone"),
            ("machine", "release", {"ticket": 1}, "gives no 'release'"),
            ("nobody", "halt", {}, "there is no 'nobody'"),
        ):
            client.give(target, verb, **arguments)
            client.until(lambda sentence=sentence: client.complaints and sentence in client.complaints[-1])
        client.give("r", "halt")  # is off: the engine refuses it
        client.until(lambda: client.answers)
        answer = client.answers[0]
        assert (answer["target"], answer["verb"], answer["state"]) == ("r", "halt", "error")
        assert answer["sentence"]
        client.give("machine", "emergency_stop")
        client.until(lambda: client.state("x") == "Disabled")


def test_a_module_from_a_page(tmp_path: Path) -> None:
    url = new_url()
    machine = (EXAMPLES / "flying_saw" / "machine.yaml").read_text() + "\nview: {commands: true}\n"
    with running(tmp_path, url, machine=machine), served(url) as address, Client(address) as client:
        client.give("cutter", "control", regulator_on=True)
        client.until(lambda: client.state("cutter") == "Ready")
        client.give("cutter", "control", stop=True)
        client.until(
            lambda: client.complaints and "with halt, regulator_on, reset_error alone" in client.complaints[-1]
        )
        client.give("cutter", "control", regulator_on=False)
        client.until(lambda: client.state("saw") == "Disabled")


class Wire:
    """A network on which no message arrives: they are kept."""

    def __init__(self) -> None:
        self.sent: list[Any] = []

    def publish(self, channel: str, data: bytes) -> None:
        kind = {"takt/command": msgs.command, "takt/heartbeat": msgs.heartbeat}[channel]
        self.sent.append(kind.decode(data))

    def take(self) -> list[Any]:
        sent, self.sent = self.sent, []
        return sent


@pytest.mark.parametrize("released", [False, True])
def test_a_jog_without_an_answer_is_not_kept_up_by_the_next_one(released: bool) -> None:
    """EN-23: the engine may have accepted it. It is repeated, without heartbeats, and released when it is answered."""
    wire, said = Wire(), []
    commander = Commander(wire, Machine(described(ALLOWING)), said.append)
    start = now = time.monotonic()
    commander.give("x", "jog", {"forward": True, "velocity": 5.0}, now)
    jog = wire.take()[-1]
    if released:
        commander.release()
    while now < start + 3.0:
        now += 0.05
        commander.hold(now)
        commander.tick(now)
    assert [one["sentence"] for one in said] == ["the engine does not answer"]
    assert all(isinstance(one, msgs.heartbeat) or one.id == jog.id for one in wire.take())
    for _ in range(100):  # nothing is held: no heartbeats, and the command is repeated with its first time
        now += 0.05
        commander.hold(now)
        commander.tick(now)
    repeated = wire.take()
    assert {type(one) for one in repeated} == {msgs.command}
    assert {(one.id, one.utime) for one in repeated} == {(jog.id, jog.utime)}
    assert len(repeated) <= 3
    commander.give("r", "jog", {"forward": True, "velocity": 5.0}, now)
    wire.take()
    answer = msgs.feedback()
    answer.client, answer.session, answer.id, answer.ticket, answer.state = jog.client, jog.session, jog.id, 77, 1
    commander.take(answer)
    (release,) = wire.take()
    assert (release.target, release.verb, release.arguments) == ("machine", "release", "{ticket: 77}")
    assert len(said) == 1
    for _ in range(100):  # the release is repeated, too, until it is answered
        now += 0.05
        commander.tick(now)
    assert any(isinstance(one, msgs.command) and one.id == release.id for one in wire.take()[-20:])


@pytest.mark.parametrize("how", ["let go", "silent", "closed", "server killed"])
def test_what_is_jogged_stops_whatever_falls_silent(how: str, tmp_path: Path) -> None:  # EN-23
    url = new_url()
    machine = ALLOWING.replace("dead_man_s: 1}", "dead_man_s: 60}") if how in ("let go", "closed") else ALLOWING
    with running(tmp_path, url, machine=machine), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        process, address = start_server(url)
        try:
            with Client(address) as client:
                client.give("x", "jog", forward=True, velocity=20.0)
                began = session.now
                while session.now < began + 2:  # twice the dead man's time: it lives
                    client.hold()
                    session.run(0.05)
                assert x.set_velocity == pytest.approx(20.0)
                if how == "let go":
                    client.hold(False)
                elif how == "server killed":
                    process.kill()
                if how != "closed":
                    session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 5.0)
            session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 5.0)
            stood = x.set_position
            session.run(0.5)
            assert x.set_position == stood
            assert x.error == 0
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=20)
