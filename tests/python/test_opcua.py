"""Takt as an OPC UA server, seen by asyncua's client (EN-20, EN-22, EN-23, EN-31, PY-07)."""

from __future__ import annotations

import asyncio
import contextlib
import math
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from asyncua import ua
from asyncua.common.utils import ServiceError
from asyncua.crypto.cert_gen import setup_self_signed_certificate
from asyncua.sync import Client, ThreadLoop
from cryptography import x509
from cryptography.x509.oid import ExtendedKeyUsageOID
from every_kind import FULL, text_of
from machines import machine_with, new_url, running
from takt.cli import main
from takt.errors import ConnectionError, TaktError
from takt.keys import new_key, read_key
from takt.opcua.arguments import RefusedError, values_of
from takt.opcua.descriptions import enumerations, fields_of, verbs_of
from takt.opcua.server import Options, serving
from takt.opcua.sessions import Sessions
from takt.opcua.units import number_of
from takt.opcua.users import Users, add_user, read_users
from takt.tables import KINDS

MACHINE = machine_with("{dead_man_s: 0.4}")
WAIT_S = 20.0  # of states: the host may be busy
BUSY, ACTIVE, DONE, ABORTED, ERROR = range(5)


class Plant(NamedTuple):
    url: str  # of the engine
    address: str  # of a server that takes commands


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Plant]:
    url = new_url()
    with (
        running(tmp_path_factory.mktemp("opcua"), url, machine=MACHINE),
        serving(url, Options(port=0, commands=True, rate_hz=50, timeout_s=WAIT_S), None, _quiet) as (address, _),
    ):
        yield Plant(url, address)


@pytest.fixture(scope="module")
def loop() -> Iterator[ThreadLoop]:
    """Of all clients."""
    with ThreadLoop() as loop:
        yield loop


@pytest.fixture
def client(plant: Plant, loop: ThreadLoop) -> Iterator[Client]:
    with Client(plant.address, tloop=loop) as client:
        yield client
        client.get_node("ns=2;s=x").call_method("2:power", False)


def _quiet(_: str) -> None:
    pass


def until(condition: Callable[[], object]) -> None:
    end = time.monotonic() + WAIT_S
    while not condition():
        assert time.monotonic() < end, "it does not come"
        time.sleep(0.02)


def value(client: Client, name: str) -> Any:
    return client.get_node(f"ns=2;s={name}").read_value()


def call(client: Client, target: str, verb: str, *arguments: Any) -> dict[str, Any]:
    node = client.get_node(f"ns=2;s={target}")
    names = ("command", "state", "reached", "error_id", "sentence", "value", "ticket")
    return dict(zip(names, node.call_method(f"2:{verb}", *arguments), strict=True))


def enumeration(client: Client, name: str) -> list[str]:
    """The members of the type of a variable, as a client finds them."""
    of = client.get_node(client.get_node(f"ns=2;s={name}").read_data_type())
    return [member.Text for member in of.get_child("0:EnumStrings").read_value()]


def powered(client: Client, axis: str = "x") -> None:
    assert call(client, axis, "power", True)["error_id"] == 0
    until(lambda: value(client, f"{axis}.state") == 1)


# --- values ---


def test_an_axis_shows_all_that_it_publishes(client: Client) -> None:
    """EN-20: fields, meanings, units and members come from the descriptions."""
    x = client.get_node("ns=2;s=x")
    names = {node.read_browse_name().Name for node in x.get_variables()}
    assert names == {*KINDS["axis"].units, "error_text"}
    assert [client.get_node(n).read_browse_name().Name for n in (x.read_type_definition(),)] == ["AxisType"]
    until(lambda: value(client, "/machine/connected"))
    for name, number, text in (
        ("x.actual_position", number_of("MMT"), "mm"),
        ("x.set_acceleration", number_of("M41"), "mm/s²"),
        ("r.set_velocity", number_of("E96"), "°/s"),
        ("x.voltage_v", number_of("VLT"), "V"),
    ):
        unit = client.get_node(f"ns=2;s={name}").get_child("0:EngineeringUnits").read_value()
        assert (unit.UnitId, unit.DisplayName.Text) == (number, text)
    assert enumeration(client, "x.state") == list(enumerations()["PlcState"].members)
    assert enumeration(client, "x.state")[value(client, "x.state")] in ("Disabled", "Standstill")
    about = client.get_node("ns=2;s=x.actual_position").read_description().Text
    assert about == "Measured; rotary axes: in [0, modulus)."
    assert isinstance(value(client, "x.homed"), bool)


def test_the_engine_says_how_it_is(client: Client) -> None:
    """EN-20."""
    until(lambda: value(client, "/machine/connected") and value(client, "/engine/cycle") > 0)
    assert value(client, "/machine/name") == "test"
    assert value(client, "/machine/period") == pytest.approx(0.001)
    assert value(client, "/machine/trouble") == ""
    assert value(client, "/engine/overruns") >= 0
    assert client.get_node("ns=2;s=/engine/overruns").read_description().Text.startswith("Cycles that ended after")


def test_what_changes_is_told_to_those_who_subscribe(client: Client) -> None:
    seen: list[float] = []

    class Handler:
        def datachange_notification(self, _node: object, new: float, _data: object) -> None:
            seen.append(new)

    powered(client)
    subscription = client.create_subscription(20, Handler())
    subscription.subscribe_data_change(client.get_node("ns=2;s=x.actual_position"))
    assert call(client, "x", "move_relative", 20.0, 200.0)["state"] in (ACTIVE, DONE)
    until(lambda: value(client, "x/last_command/state") == DONE)
    until(lambda: seen and seen[-1] == value(client, "x.actual_position"))
    assert len(seen) > 5
    time.sleep(0.1)
    count = len(seen)
    time.sleep(0.2)  # it rests: nothing to tell
    assert len(seen) - count <= 1
    subscription.delete()


def test_every_kind_is_described() -> None:
    """All that is published has a type, all arguments of all commands, too."""
    for kind in KINDS:
        fields = fields_of(kind)
        assert [field.name for field in fields] == list(KINDS[kind].units)
        for field in fields:
            if field.enumeration:
                members = enumerations()[field.enumeration].members
                assert dict(enumerate(members)) == dict(KINDS[kind].names[field.name])
    assert {
        argument.kind for kind in ("machine", *KINDS) for verb in verbs_of(kind) for argument in verb.arguments
    } == {*("bool", "integer", "real", "text", "enum", "yaml")}


# --- commands ---


def test_a_command_is_given_and_followed_to_its_end(client: Client) -> None:
    """EN-22: what a method returns, what is to be read afterwards."""
    powered(client)
    given = call(client, "x", "move_absolute", 30.0, 300.0)
    assert given["state"] in (ACTIVE, DONE)
    assert (given["error_id"], given["sentence"]) == (0, "")
    assert given["ticket"] > 0
    until(lambda: value(client, "x/last_command/state") == DONE)
    assert value(client, "x/last_command/command") == given["command"]
    assert value(client, "x/last_command/verb") == "move_absolute"
    assert value(client, "x/last_command/arguments") == "{position: 30.0, velocity: 300.0}"
    assert value(client, "x/last_command/client").startswith("127.0.0.1:")
    number = ua.Variant(given["command"], ua.VariantType.UInt32)
    assert client.get_node("ns=2;s=/machine").call_method("2:feedback", number)[1] == DONE
    until(lambda: value(client, "x.actual_position") == pytest.approx(30.0, abs=0.1))


def test_what_the_engine_refuses_comes_back_as_its_sentence(client: Client) -> None:
    """EN-22."""
    powered(client)
    refused = call(client, "x", "move_absolute", 5000.0)
    assert (refused["state"], refused["error_id"]) == (ERROR, 8)
    assert refused["sentence"] == "the target lies behind a SW limit, or an end of the track"
    assert value(client, "x/last_command/sentence") == refused["sentence"]
    incomplete = call(client, "x", "move_absolute", math.nan)  # what must be given was not
    assert (incomplete["state"], "position" in incomplete["sentence"]) == (ERROR, True), incomplete


def test_arguments_that_are_not_given_are_as_they_are_by_default(client: Client) -> None:
    powered(client)
    null = ua.Variant(None, ua.VariantType.Null)
    assert call(client, "x", "move_absolute", 31.0, math.nan, 2000, null)["error_id"] == 0
    assert value(client, "x/last_command/arguments") == "{position: 31.0, acceleration: 2000.0}"
    inputs = client.get_node("ns=2;s=x").get_child(["2:move_absolute", "0:InputArguments"]).read_value()
    direction = next(i for i, one in enumerate(inputs) if one.Name == "direction")
    members = enumeration_of(client, inputs[direction].DataType)
    positive = ua.Variant(members.index("positive"), ua.VariantType.Int32)
    call(client, "x", "move_absolute", 32.0, *[null] * (direction - 1), positive)
    assert value(client, "x/last_command/arguments") == "{position: 32.0, direction: positive}"


def enumeration_of(client: Client, node: ua.NodeId) -> list[str]:
    return [member.Text for member in client.get_node(node).get_child("0:EnumStrings").read_value()]


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (("far",), ua.StatusCodes.BadInvalidArgument),
        ((True,), ua.StatusCodes.BadInvalidArgument),
        (([1.0, 2.0],), ua.StatusCodes.BadInvalidArgument),
        ((), ua.StatusCodes.BadArgumentsMissing),
        ((1.0,) * 20, ua.StatusCodes.BadTooManyArguments),
    ],
)
def test_arguments_of_other_types_are_refused(client: Client, arguments: tuple[Any, ...], status: int) -> None:
    with pytest.raises(ua.UaStatusCodeError) as refused:
        call(client, "x", "move_absolute", *arguments)
    assert refused.value.code == status


def test_calls_of_what_is_not_there_are_refused(client: Client) -> None:
    x, machine = client.get_node("ns=2;s=x"), client.get_node("ns=2;s=/machine")
    nobody = client.get_node("ns=2;s=nobody")
    method = x.get_child("2:halt")
    for of, status in (
        (nobody, ua.StatusCodes.BadNodeIdInvalid),
        (machine, ua.StatusCodes.BadMethodInvalid),
        (client.get_node("ns=2;s=/types/axis"), ua.StatusCodes.BadMethodInvalid),
    ):
        with pytest.raises(ua.UaStatusCodeError) as refused:
            of.call_method(method.nodeid)
        assert refused.value.code == status
    with pytest.raises(ua.UaStatusCodeError) as refused:
        machine.call_method("2:feedback", ua.Variant(4_000_000, ua.VariantType.UInt32))
    assert refused.value.code == ua.StatusCodes.BadNotFound


def test_values_cannot_be_written_nor_nodes_be_made(client: Client) -> None:
    with pytest.raises(ua.UaStatusCodeError) as refused:
        client.get_node("ns=2;s=x.set_position").write_value(5.0)
    assert refused.value.code == ua.StatusCodes.BadUserAccessDenied
    with pytest.raises(ua.UaStatusCodeError):
        client.nodes.objects.add_object(2, "mine")


def test_lists_and_whole_texts_of_arguments() -> None:
    """Arguments of commands that few machines have."""
    verbs = {(kind, verb.name): verb.arguments for kind in ("machine", *KINDS) for verb in verbs_of(kind)}

    def values(of: tuple[str, str], name: str, value: Any, kind: ua.VariantType) -> Any:
        arguments = [one for one in verbs[of] if one.name == name]
        return values_of(arguments, [ua.Variant(value, kind)])[name]

    assert values(("pick_place", "configure"), "max_velocity", [1.0, 2.0], ua.VariantType.Double) == [1.0, 2.0]
    assert values(("mover", "gear_in_pos_on_track"), "trail", ["a", "b"], ua.VariantType.String) == ["a", "b"]
    text = "[{x: 0, y: 1}, {x: 2, y: 3}]"
    points = [{"x": 0, "y": 1}, {"x": 2, "y": 3}]
    assert values(("machine", "add_cam_points"), "points", text, ua.VariantType.String) == points
    for text in ("[{x: 0,\ty: 1e-5}]", "[{x: 0, y: 1e-05}]"):
        points = [{"x": 0, "y": 0.00001}]
        assert values(("machine", "add_cam_points"), "points", text, ua.VariantType.String) == points
    assert values(("axis", "power"), "enable_positive", False, ua.VariantType.Boolean) is False
    for of, name, wrong, kind, status in (
        (("machine", "add_cam_points"), "points", "[{x: 0", ua.VariantType.String, ua.StatusCodes.BadOutOfRange),
        (("machine", "add_cam_points"), "points", "[" * 30_000, ua.VariantType.String, ua.StatusCodes.BadOutOfRange),
        (("machine", "add_cam_points"), "points", "- " * 30_000, ua.VariantType.String, ua.StatusCodes.BadOutOfRange),
        (("machine", "add_cam_points"), "points", "[{1: 0}]", ua.VariantType.String, ua.StatusCodes.BadOutOfRange),
        (("axis", "power"), "buffer_mode", 99, ua.VariantType.Int32, ua.StatusCodes.BadOutOfRange),
        (("axis", "power"), "buffer_mode", "later", ua.VariantType.String, ua.StatusCodes.BadOutOfRange),
        (("axis", "power"), "buffer_mode", 1.0, ua.VariantType.Double, ua.StatusCodes.BadTypeMismatch),
        (("pick_place", "configure"), "max_velocity", 1.0, ua.VariantType.Double, ua.StatusCodes.BadTypeMismatch),
    ):
        with pytest.raises(RefusedError) as refused:
            values(of, name, wrong, kind)
        assert refused.value.arguments == [status]


# --- the dead man ---


def jogging(client: Client) -> None:
    powered(client)
    assert call(client, "x", "jog", True, False, 10.0)["error_id"] == 0
    until(lambda: value(client, "x.set_velocity") > 5)


def test_a_jog_goes_on_while_its_client_is_heard(plant: Plant, client: Client) -> None:
    """EN-23."""
    jogging(client)
    end = time.monotonic() + 1.0  # longer than the dead man's time
    while time.monotonic() < end:
        assert value(client, "x.set_velocity") > 5
        time.sleep(0.05)
    assert call(client, "x", "jog", False, False)["error_id"] == 0
    until(lambda: value(client, "x.set_velocity") == 0)


def test_a_held_stop_goes_on_behind_its_end(client: Client) -> None:
    """EN-23: done, or aborted, a held stop holds while its client is heard, until it is released."""
    powered(client)
    assert call(client, "x", "move_velocity", 100.0)["error_id"] == 0
    names = [
        argument.Name for argument in client.get_node("ns=2;s=x").get_child("2:stop/0:InputArguments").read_value()
    ]
    stop = call(client, "x", "stop", *[name == "hold" or None for name in names])
    until(lambda: value(client, "x.set_velocity") == 0)
    end = time.monotonic() + 1.2  # longer than the dead man's time
    while time.monotonic() < end:
        assert enumeration(client, "x.state")[value(client, "x.state")] == "Stopping"
        time.sleep(0.05)
    call(client, "/machine", "release", stop["ticket"])
    until(lambda: value(client, "x.state") == 1)


@pytest.mark.parametrize("how", ["leaves", "is cut off", "hangs"])
def test_a_jog_ends_with_its_client(plant: Plant, client: Client, how: str, loop: ThreadLoop) -> None:
    """EN-23: a client that goes away in a jog; another one goes on reading."""
    powered(client)
    other = Client(plant.address, tloop=loop, watchdog_intervall=1000)
    other.connect()
    try:
        jogging(other)
        if how == "leaves":
            other.disconnect()
        elif how == "is cut off":
            transport = other.aio_obj.uaclient.protocol.transport
            other.tloop.loop.call_soon_threadsafe(transport.abort)
        until(lambda: value(client, "x.set_velocity") == 0)
        assert value(client, "x.state") == 1
        assert value(client, "x/last_command/state") in (DONE, ABORTED)
    finally:
        if how != "leaves":
            with contextlib.suppress(Exception):
                other.disconnect()


def test_two_clients_command_beside_each_other(plant: Plant, client: Client, loop: ThreadLoop) -> None:
    """EN-22: each is a client of the engine by itself; the later command takes over."""
    with Client(plant.address, tloop=loop) as other:
        powered(client)
        first = call(client, "x", "move_absolute", 900.0, 5.0)
        second = call(other, "x", "move_absolute", 40.0, 300.0)
        assert second["error_id"] == 0
        number = ua.Variant(first["command"], ua.VariantType.UInt32)
        until(lambda: client.get_node("ns=2;s=/machine").call_method("2:feedback", number)[1] == ABORTED)
        until(lambda: value(client, "x/last_command/state") == DONE)
        assert value(client, "x/last_command/command") == second["command"]


def test_a_command_is_followed_behind_the_end_of_its_session(
    plant: Plant, client: Client, loop: ThreadLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    """EN-22: a move that takes longer than a closed session is waited for."""
    monkeypatch.setattr("takt.opcua.commands.GIVEN_UP_S", 0.2)
    powered(client)
    start = value(client, "x.set_position")
    with Client(plant.address, tloop=loop) as other:
        given = call(other, "x", "move_absolute", start + 40.0, 40.0)
    number = ua.Variant(given["command"], ua.VariantType.UInt32)
    until(lambda: client.get_node("ns=2;s=/machine").call_method("2:feedback", number)[1] == DONE)


def test_commands_that_have_ended_are_forgotten_first(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """EN-22."""
    monkeypatch.setattr("takt.opcua.commands.MOST", 3)
    powered(client)
    moving = call(client, "x", "move_absolute", value(client, "x.set_position") + 40.0, 20.0)
    for _ in range(5):
        assert call(client, "x", "set_override", 1.0)["error_id"] == 0
    number = ua.Variant(moving["command"], ua.VariantType.UInt32)
    assert client.get_node("ns=2;s=/machine").call_method("2:feedback", number)[1] in (ACTIVE, DONE)


# --- rights ---


def test_without_the_option_there_is_nothing_to_command(plant: Plant, loop: ThreadLoop) -> None:
    with (
        serving(plant.url, Options(port=0, timeout_s=WAIT_S), None, _quiet) as (address, _),
        Client(address, tloop=loop) as client,
    ):
        assert client.get_node("ns=2;s=x").get_methods() == []
        with pytest.raises(ua.UaStatusCodeError):
            client.get_node("ns=2;s=x").call_method(ua.NodeId("/types/axis/power", 2), True)
        until(lambda: value(client, "/machine/connected"))


def test_users_have_rights(plant: Plant, tmp_path: Path, loop: ThreadLoop) -> None:
    """Names, passwords and what each may do."""
    file = tmp_path / "users"
    add_user(file, "panel", "secret", "read")
    add_user(file, "plc", "more secret", "commands")
    options = Options(port=0, commands=True, users=file, timeout_s=WAIT_S)
    with serving(plant.url, options, None, _quiet) as (address, _):
        with pytest.raises(ua.UaStatusCodeError):
            Client(address, tloop=loop).connect()  # says no name
        for name, password in (("plc", "wrong"), ("nobody", "secret"), ("admin", "")):
            stranger = Client(address, tloop=loop)
            stranger.set_user(name)
            stranger.set_password(password)
            with pytest.raises(ua.UaStatusCodeError) as refused:
                stranger.connect()
            assert refused.value.code == ua.StatusCodes.BadUserAccessDenied
        for name, password, may in (("panel", "secret", False), ("plc", "more secret", True)):
            client = Client(address, tloop=loop)
            client.set_user(name)
            client.set_password(password)
            with client:
                if may:
                    assert call(client, "x", "halt")["error_id"] >= 0
                    until(lambda client=client: value(client, "x/last_command/client") == "plc")  # type: ignore[misc]
                else:
                    assert value(client, "/machine/name") == "test"
                    with pytest.raises(ua.UaStatusCodeError) as refused:
                        call(client, "x", "power", True)
                    assert refused.value.code == ua.StatusCodes.BadUserAccessDenied


def certified(folder: Path, name: str, uri: str, use: x509.ObjectIdentifier) -> tuple[Path, Path]:
    """A new certificate, and its key."""
    key, certificate = folder / f"{name}.pem", folder / f"{name}.der"
    asyncio.run(setup_self_signed_certificate(key, certificate, uri, "localhost", [use], {"commonName": name}))
    return certificate, key


async def claimed(certificate: bytes | None, channel: bytes) -> None:
    """A session of a client that names this certificate, over a channel that was made with another one."""

    async def anybody(*_: object) -> None:
        pass

    server = Sessions(user_manager=Users(None, True))
    server.certificate_validator = anybody
    session = server.create_session("client", external=True)
    await session.create_session(ua.CreateSessionParameters(ClientCertificate=certificate))
    session.activate_session(ua.ActivateSessionParameters(), channel)


def test_certificates_keep_strangers_out(plant: Plant, loop: ThreadLoop, tmp_path: Path) -> None:
    """Encrypted connections alone, of those clients whose certificate is in a folder."""
    certificate, key = certified(tmp_path, "server", "urn:takt:test", ExtendedKeyUsageOID.SERVER_AUTH)
    known, known_key = certified(tmp_path, "plc", "urn:plc", ExtendedKeyUsageOID.CLIENT_AUTH)
    unknown, unknown_key = certified(tmp_path, "stranger", "urn:plc", ExtendedKeyUsageOID.CLIENT_AUTH)
    trust = tmp_path / "trusted"
    trust.mkdir()
    (trust / "plc.der").write_bytes(known.read_bytes())
    options = Options("127.0.0.1", 0, 10.0, True, None, certificate, key, trust, WAIT_S)
    with serving(plant.url, options, None, _quiet) as (address, _):

        def connect(certificate: Path, key: Path) -> str:
            client = Client(address, tloop=loop)
            client.application_uri = "urn:plc"
            client.set_security_string(f"Basic256Sha256,SignAndEncrypt,{certificate},{key}")
            with client:
                return str(call(client, "x", "power", False)["sentence"])

        assert connect(known, known_key) == ""
        with pytest.raises(ua.UaStatusCodeError) as refused:
            connect(unknown, unknown_key)
        assert refused.value.code == ua.StatusCodes.BadCertificateUntrusted
        with pytest.raises(ua.UaError):
            Client(address, tloop=loop).connect()  # unencrypted
        shown = known.read_bytes()  # anybody has seen it
        with pytest.raises(ServiceError) as refused:
            asyncio.run(claimed(None, unknown.read_bytes()))
        assert refused.value.code == ua.StatusCodes.BadCertificateInvalid
        with pytest.raises(ServiceError) as refused:
            asyncio.run(claimed(shown, unknown.read_bytes()))
        assert refused.value.code == ua.StatusCodes.BadCertificateInvalid
    for wrong, sentence in (
        ({"certificate": known_key}, "not a certificate that can be used"),
        ({"private_key": certificate}, "not a private key that can be used"),
    ):
        with (
            pytest.raises(TaktError, match=sentence),
            serving(plant.url, replace(options, **wrong), None, _quiet),  # type: ignore[arg-type]
        ):
            pass


def test_users_files_say_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "users"
    assert main(["opcua-user", str(file), "plc", "--commands", "--password", "a"]) == 0
    assert main(["opcua-user", str(file), "plc", "--password", "b"]) == 0  # another password, fewer rights
    assert [(name, rights) for name, (rights, _) in read_users(file).items()] == [("plc", "read")]
    assert main(["opcua-user", str(file), "two words", "--password", "a"]) == 2
    assert "a name is one word, not 'two words'" in capsys.readouterr().err
    file.chmod(0o644)
    with pytest.raises(TaktError, match="others than its owner may open it"):
        read_users(file)
    file.chmod(0o600)
    file.write_text("plc everything abc\n")
    with pytest.raises(TaktError, match=r"users:1: expected a name, read or commands, and a hash"):
        read_users(file)
    file.write_text("# nobody\n")
    with pytest.raises(TaktError, match="there are no users in it"):
        read_users(file)
    with pytest.raises(TaktError, match="No such file"):
        read_users(tmp_path / "none")


# --- what goes wrong ---


def test_options_that_cannot_be(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments, sentence in (
        ([], "give a MACHINE file, or the network of a running engine with --connect"),
        (["m.yaml", "--connect", "udpm://"], "give a MACHINE file, or the network"),
        (["--connect", new_url(), "--allow-commands", "--host", "0.0.0.0"], "would let anybody on the network move"),
        (["--connect", new_url(), "--certificate", "c.pem"], "--certificate and --private-key go together"),
        (["--connect", new_url(), "--trust", str(tmp_path)], "--trust is for encrypted connections"),
        (["--connect", new_url(), "--rate", "1000"], "1<=x<=100"),
        ([str(tmp_path / "none.yaml")], "No such file"),
    ):
        assert main(["opcua", *arguments]) == 2
        assert sentence in capsys.readouterr().err


def test_without_an_engine_it_says_so() -> None:
    url = new_url()
    with (
        pytest.raises(ConnectionError, match=r"no engine answers on .* within 0.3 s; is taktd running there\?"),
        serving(url, Options(port=0, timeout_s=0.3), None, _quiet),
    ):
        pass


def test_a_port_that_is_taken_is_named(plant: Plant) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with (
            pytest.raises(
                TaktError, match=f"port {port} of 127.0.0.1 cannot be used for OPC UA: Address already in use"
            ),
            serving(plant.url, Options(port=port, timeout_s=WAIT_S), None, _quiet),
        ):
            pass


def test_an_engine_that_ends_and_comes_again(tmp_path: Path, loop: ThreadLoop) -> None:
    """Values without an engine are none; with the same machine they come back, with another one the server ends."""
    url = new_url()
    said: list[str] = []
    names = threading.Lock()

    def say(sentence: str) -> None:
        with names:
            said.append(sentence)

    def status(client: Client) -> int:
        read = client.get_node("ns=2;s=x.actual_position").read_data_value(raise_on_bad_status=False)
        return int(read.StatusCode.value)

    with contextlib.ExitStack() as stack:
        with running(tmp_path, url, machine=MACHINE):
            options = Options(port=0, commands=True, rate_hz=50, timeout_s=WAIT_S)
            address, why = stack.enter_context(serving(url, options, None, say))
            client = stack.enter_context(Client(address, tloop=loop))
            until(lambda: status(client) == ua.StatusCodes.Good)
            first = value(client, "/machine/run_id")
        until(lambda: status(client) == ua.StatusCodes.BadNoCommunication)
        assert value(client, "/machine/connected") is False
        assert value(client, "/machine/trouble") == f"no engine is heard on {url}"
        with pytest.raises(ua.UaStatusCodeError) as refused:
            call(client, "x", "power", True)
        assert refused.value.code == ua.StatusCodes.BadNoCommunication
        with running(tmp_path, url, machine=MACHINE):
            until(lambda: status(client) == ua.StatusCodes.Good)
            assert value(client, "/machine/run_id") != first
            powered(client)
        with running(tmp_path, url, machine=MACHINE.replace("name: test", "name: other")):
            until(why)
        assert why() == (f"the engine on {url} was started with another machine, other: start the server again")
    assert said == [f"the engine on {url} is {what}" for what in ("heard", "silent", "heard", "silent")][: len(said)]


def test_an_engine_with_a_key_is_commanded_with_it_alone(tmp_path: Path, loop: ThreadLoop) -> None:
    """EN-31."""
    url, file = new_url(), tmp_path / "takt.key"
    new_key(file)
    options = Options(port=0, commands=True, timeout_s=WAIT_S)
    with running(tmp_path, url, "--key", str(file), machine=MACHINE):
        with (
            pytest.raises(ConnectionError, match="has a key and hears only holders of it"),
            serving(url, options, None, _quiet),
        ):
            pass
        with serving(url, options, read_key(file), _quiet) as (address, _), Client(address, tloop=loop) as client:
            powered(client)


def test_the_command_runs_a_machine_of_its_own(tmp_path: Path, loop: ThreadLoop) -> None:
    """PY-07: it says where it is, and ends in order."""
    file = tmp_path / "machine.yaml"
    file.write_text(MACHINE)
    command = [sys.executable, "-m", "takt", "opcua", str(file), "--port", "0"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stderr is not None
            line = next(line for line in process.stderr if "Ctrl-C" in line)
            address = re.findall(r"opc.tcp://[^ ]+", line)[0]
            assert line.endswith(f"{address} (values, read-only; Ctrl-C ends it)\n")
            with Client(address, tloop=loop) as client:
                until(lambda: _is_good(client, "x.state"))
        finally:
            process.send_signal(signal.SIGINT)
        assert process.wait(WAIT_S) == 130


def test_every_kind_of_component_has_its_object(tmp_path: Path, loop: ThreadLoop) -> None:
    """EN-20: a machine with all kinds."""
    url = new_url()
    with (
        running(tmp_path, url, machine=text_of(FULL)),
        serving(url, Options(port=0, timeout_s=WAIT_S), None, _quiet) as (address, _),
        Client(address, tloop=loop) as client,
    ):
        for kind in KINDS.values():
            folder = client.get_node("ns=2;s=/machine").get_child(f"2:{kind.section}")
            objects = {node.read_browse_name().Name: node for node in folder.get_children()}
            assert list(objects) == [component["name"] for component in FULL[kind.section]]
            name, of = next(iter(objects.items()))
            assert {node.read_browse_name().Name for node in of.get_variables()} >= set(kind.units)
            until(lambda name=name, kind=kind: _is_good(client, f"{name}.{next(iter(kind.units))}"))  # type: ignore[misc]


def _is_good(client: Client, name: str) -> bool:
    read = client.get_node(f"ns=2;s={name}").read_data_value(raise_on_bad_status=False)
    return bool(read.StatusCode.is_good())
