"""The server: writes the values that an engine publishes to the address space several times a second, and sends
commands to the engine."""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import ipaddress
import logging
import socket
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from asyncua import Server, ua
from asyncua.crypto.truststore import TrustStore
from asyncua.crypto.uacrypto import load_certificate
from asyncua.crypto.validator import CertificateValidator, CertificateValidatorOptions
from cryptography import x509

from takt import _core
from takt.errors import ConnectionError, TaktError
from takt.keys import Key, no_key
from takt.opcua.commands import Commands
from takt.opcua.descriptions import MACHINE
from takt.opcua.sessions import Sessions
from takt.opcua.space import NAMESPACE, Space
from takt.opcua.users import Users, read_users
from takt.view.feed import Feed

PORT = 4840  # registered for OPC UA
TICK_S = 0.02  # [s] longest interval between two checks for answers of the engine
FIRST_S = 1.5  # [s] longest wait for the engine's own state, after its description
SECURE = [
    *(ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt, ua.SecurityPolicyType.Basic256Sha256_Sign),
    *(ua.SecurityPolicyType.Aes128Sha256RsaOaep_SignAndEncrypt, ua.SecurityPolicyType.Aes128Sha256RsaOaep_Sign),
    *(ua.SecurityPolicyType.Aes256Sha256RsaPss_SignAndEncrypt, ua.SecurityPolicyType.Aes256Sha256RsaPss_Sign),
]
TRUSTED = (
    CertificateValidatorOptions.TIME_RANGE
    | CertificateValidatorOptions.URI
    | CertificateValidatorOptions.TRUSTED
    | CertificateValidatorOptions.PEER_CLIENT
)
Say = Callable[[str], None]


@dataclass(frozen=True)
class Options:
    host: str = "127.0.0.1"
    port: int = PORT  # 0: any free one
    rate_hz: float = 10.0  # of values
    commands: bool = False  # clients may command
    users: Path | None = None
    certificate: Path | None = None
    private_key: Path | None = None
    trust: Path | None = None  # folder with the certificates of clients; None: all clients
    timeout_s: float = 5.0  # longest wait for the engine at the start

    def check(self) -> None:
        """Raises TaktError if options contradict one another, or would let any client on the network command."""
        if (self.certificate is None) != (self.private_key is None):
            raise TaktError("--certificate and --private-key go together: give both or none")
        if self.trust is not None and self.certificate is None:
            raise TaktError("--trust is for encrypted connections: give --certificate and --private-key, too")
        if self.trust is not None and not self.trust.is_dir():
            raise TaktError(f"{self.trust}: --trust is a folder with the certificates of clients")
        if self.commands and self.users is None and self.trust is None and not _is_local(self.host):
            raise TaktError(
                f"--allow-commands on {self.host} would let anybody on the network move the machine: "
                "give --users or --trust"
            )


class AnotherMachineError(TaktError):
    """The engine was restarted with another machine file: the address space no longer describes its machine."""


class Service:
    """One server, for the engine of one network."""

    def __init__(self, url: str, options: Options, key: Key | None, say: Say) -> None:
        options.check()
        self.options = options
        self._known = read_users(options.users) if options.users is not None else None
        self._say = say
        self._feed = Feed(url, key)
        self._epoch = 0
        self._gone = True
        self._told: tuple[bool, str, int] | None = None
        self._failed = ""  # the last error of `run`, printed once
        self._commands = Commands(self._feed, self._target_of)

    async def start(self) -> str:
        """Waits for the engine, builds the address space, listens, and returns the address. Raises ConnectionError if
        no engine answers within `timeout_s` or the key does not permit commands, TaktError if the port or a certificate
        cannot be used."""
        await self._wait_for_engine()
        machine, feed, options = self._feed.machine, self._feed, self.options
        assert machine is not None
        if options.commands and not feed.may_command:
            raise ConnectionError(no_key(feed.url))
        self._epoch = feed.epoch
        port = _free_port(options.host, options.port)  # fails before the address space is built
        self._server = Server(iserver=Sessions(user_manager=Users(self._known, options.commands)))
        self._server.iserver.allow_remote_admin = False
        self._server.set_server_name(f"Takt: {machine.name}")
        uri = await self._secure(f"urn:{socket.gethostname()}:takt:{machine.name}")
        await self._server.init()
        await self._server.set_application_uri(uri)
        host = f"[{options.host}]" if ":" in options.host else options.host
        address = f"opc.tcp://{host}:{port}/takt/"
        self._server.set_endpoint(address)
        await self._server.set_build_info(
            "urn:takt:opcua", "Takt", "Takt", _core.__version__, _core.__version__, datetime.now()
        )
        self.index = await self._server.register_namespace(NAMESPACE)
        self._space = Space(self._server, self.index, machine)
        callers = (self._commands.caller, self._commands.ask) if options.commands else (None, None)
        await self._space.make(feed.engine or {}, *callers)
        try:
            await self._server.start()
        except OSError as error:
            raise _not_usable(options.host, port, error) from None
        return address

    async def _wait_for_engine(self) -> None:
        feed, end = self._feed, time.monotonic() + self.options.timeout_s
        while feed.machine is None and time.monotonic() < end:
            feed.tick()
            await asyncio.sleep(TICK_S)
        if feed.machine is None:
            raise ConnectionError(
                feed.trouble
                or f"no engine answers on {feed.url} within {self.options.timeout_s:g} s; is taktd running there?"
            )
        end = time.monotonic() + FIRST_S
        while feed.engine is None and time.monotonic() < end:
            feed.tick()
            await asyncio.sleep(TICK_S)

    async def _secure(self, uri: str) -> str:
        """Sets up certificates and kinds of login. Returns the URI of the application: that of the certificate, else
        `uri`."""
        server, options = self._server, self.options
        tokens: list[type] = [ua.UserNameIdentityToken if self._known is not None else ua.AnonymousIdentityToken]
        server.set_identity_tokens(tokens)
        if options.certificate is None or options.private_key is None:
            server.set_security_policy([ua.SecurityPolicyType.NoSecurity])
            if self._known is not None and not _is_local(options.host):
                self._say("passwords come unencrypted: give --certificate and --private-key")
            return uri
        try:
            await server.load_certificate(options.certificate)
            uri = _uri_of(await load_certificate(options.certificate)) or uri
        except Exception as error:
            raise TaktError(f"{options.certificate}: not a certificate that can be used: {error}") from None
        try:
            await server.load_private_key(options.private_key)
        except Exception as error:
            raise TaktError(f"{options.private_key}: not a private key that can be used: {error}") from None
        server.set_security_policy(SECURE)
        if options.trust is not None:
            store = TrustStore([options.trust], [])
            try:
                await store.load()
            except Exception as error:
                raise TaktError(f"{options.trust}: a certificate there cannot be used: {error}") from None
            server.iserver.certificate_validator = CertificateValidator(TRUSTED, store)
        return uri

    def _target_of(self, node: ua.NodeId) -> tuple[str, str] | None:
        machine = self._feed.machine
        if node.NamespaceIndex != self.index or machine is None:
            return None
        if node.Identifier == f"/{MACHINE}":
            return MACHINE, MACHINE
        source = machine.by_name.get(str(node.Identifier))
        return (source.name, source.kind) if source else None

    # --- while it runs ---

    async def run(self, stop: asyncio.Event) -> None:
        """Runs until `stop` is set. Raises AnotherMachineError if the engine is restarted with another machine."""
        step = 1.0 / self.options.rate_hz
        loop = asyncio.get_running_loop()
        due = shown = loop.time()
        while not stop.is_set():
            try:
                self._feed.tick()
                self._commands.tick(time.monotonic())
                if loop.time() >= shown:
                    shown = max(shown + step, loop.time())
                    await self._show()
                await self._show_commands()
            except AnotherMachineError:
                raise
            except Exception as error:  # continues for clients that read the rest
                if self._failed != repr(error):
                    self._failed = repr(error)
                    traceback.print_exc()
            due = max(due + min(step, TICK_S), loop.time())
            with contextlib.suppress(asyncio.TimeoutError):
                await asyncio.wait_for(stop.wait(), max(due - loop.time(), 0.001))

    async def _show(self) -> None:
        feed = self._feed
        if feed.epoch != self._epoch:
            await self._begin_again()
        gone, machine = feed.gone, self._space.machine
        trouble = f"no engine is heard on {feed.url}" if gone and not feed.trouble else feed.trouble
        told = (not gone, trouble, machine.run_id)
        if told != self._told:
            self._told = told
            await self._space.tell(not gone, trouble)
        if gone != self._gone:
            self._gone = gone
            self._say(f"the engine on {feed.url} {'is silent' if gone else 'is heard'}")
            if gone:
                await self._space.silence()
        if not gone and feed.overview is not None:
            await self._space.show(feed.overview, feed.engine)

    async def _begin_again(self) -> None:
        """Continues after a restart of the engine. Raises AnotherMachineError if it has another machine."""
        machine = self._feed.machine
        assert machine is not None
        if machine.text != self._space.machine.text:
            raise AnotherMachineError(
                f"the engine on {self._feed.url} was started with another machine, {machine.name}: "
                "start the server again"
            )
        self._epoch = self._feed.epoch
        self._commands.forget()
        self._space.machine = machine
        await self._space.silence(ua.StatusCodes.BadWaitingForInitialData)

    async def _show_commands(self) -> None:
        changed, self._commands.changed = self._commands.changed, {}
        for target, followed in changed.items():
            await self._space.tell_of(target, followed.told)

    async def stop(self) -> None:
        """Releases everything that sessions hold, and closes all connections."""
        self._commands.release()
        clock, self._server.iserver.time_task = self._server.iserver.time_task, None
        clock.cancel()  # it would sleep for up to a second more
        await self._server.stop()


@contextlib.contextmanager
def serving(url: str, options: Options, key: Key | None, say: Say) -> Iterator[tuple[str, Callable[[], str]]]:
    """Runs a server on a thread of its own. Yields its address, and a function that returns the reason why it has ended
    ("": it is running). Raises as Service.start does."""
    logging.getLogger("asyncua").setLevel(logging.CRITICAL)  # clients receive the errors that it would log
    started: concurrent.futures.Future[tuple[str, Callable[[], None]]] = concurrent.futures.Future()
    ended: list[str] = []

    async def serve() -> None:
        stop = asyncio.Event()
        loop = asyncio.get_running_loop()
        service = Service(url, options, key, say)
        address = await service.start()
        started.set_result((address, lambda: _set(loop, stop)))
        try:
            await service.run(stop)
        except AnotherMachineError as error:
            ended.append(str(error))
        finally:
            await service.stop()

    def run() -> None:
        try:
            asyncio.run(serve())
        except BaseException as error:
            if not started.done():
                started.set_exception(error)
            else:
                ended.append(f"the server has failed: {error!r}")

    thread = threading.Thread(target=run, name="takt opcua", daemon=True)
    thread.start()
    address, stop = started.result()
    try:
        yield address, lambda: ended[0] if ended else ""
    finally:
        stop()
        thread.join()


def _set(loop: asyncio.AbstractEventLoop, event: asyncio.Event) -> None:
    with contextlib.suppress(RuntimeError):  # it has ended by itself
        loop.call_soon_threadsafe(event.set)


def _is_local(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _free_port(host: str, port: int) -> int:
    """Returns this port, or any free one for 0. Raises TaktError if the port cannot be used."""
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except OSError as error:
            raise _not_usable(host, port, error) from None
        return int(probe.getsockname()[1])


def _not_usable(host: str, port: int, error: OSError) -> TaktError:
    return TaktError(f"port {port} of {host} cannot be used for OPC UA: {error.strerror or error}")


def _uri_of(certificate: Any) -> str:
    """Returns the application URI of a certificate; empty if it has none."""
    try:
        names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return ""
    found = names.get_values_for_type(x509.UniformResourceIdentifier)
    return str(found[0]) if found else ""
