"""Sessions of OPC UA clients: the caller of a method, and the time of each client's last request."""

from __future__ import annotations

import contextvars
import time
from typing import Any

from asyncua import ua
from asyncua.common.utils import ServiceError
from asyncua.crypto.permission_rules import User, UserRole
from asyncua.server.internal_server import InternalServer
from asyncua.server.internal_session import InternalSession, SessionState

from takt.opcua.users import Person

CALLER: contextvars.ContextVar[Session] = contextvars.ContextVar("caller")
SHORTEST_MS = 10.0  # between two notifications of a subscription


class Session(InternalSession):  # type: ignore[misc]
    """A session of `asyncua`, with the data that dead-man supervision needs."""

    heard_at = 0.0  # time of its last request, monotonic clock [s]
    certificate: bytes | None = None  # of the client, as given at the creation of the session
    calls = 0  # methods that have not returned yet

    @property
    def is_closed(self) -> bool:
        return self.state is SessionState.Closed

    @property
    def client(self) -> str:
        """The client for display: the user's name, or the address."""
        if isinstance(self.user, Person) and self.user.name:
            return str(self.user.name)
        return ":".join(map(str, self.name[:2])) if isinstance(self.name, tuple) else str(self.name)

    @property
    def may_command(self) -> bool:
        return isinstance(self.user, Person) and self.user.commands

    async def create_session(self, params: Any, sockname: Any = None) -> Any:
        # asyncua checks the certificate that the client gives here, but not whether it is that of the secure channel.
        self.certificate = params.ClientCertificate
        if self.iserver.certificate_validator is not None and not self.certificate:
            raise ServiceError(ua.StatusCodes.BadCertificateInvalid)
        return await super().create_session(params, sockname)

    def activate_session(self, params: Any, peer_certificate: bytes | None) -> Any:
        if self.iserver.certificate_validator is not None and peer_certificate != self.certificate:
            raise ServiceError(ua.StatusCodes.BadCertificateInvalid)
        return super().activate_session(params, peer_certificate)

    def touch(self) -> None:
        super().touch()
        self.heard_at = time.monotonic()

    async def call(self, params: list[ua.CallMethodRequest]) -> list[ua.CallMethodResult]:
        before = CALLER.set(self)
        self.calls += 1
        try:
            results: list[ua.CallMethodResult] = await super().call(params)
            return results
        finally:
            self.calls -= 1
            CALLER.reset(before)

    async def create_subscription(self, params: Any, callback: Any, request_callback: Any = None) -> Any:
        if not params.RequestedPublishingInterval >= SHORTEST_MS:
            params.RequestedPublishingInterval = SHORTEST_MS
        return await super().create_subscription(params, callback, request_callback)

    def modify_subscription(self, params: Any) -> Any:
        if not params.RequestedPublishingInterval >= SHORTEST_MS:
            params.RequestedPublishingInterval = SHORTEST_MS
        return super().modify_subscription(params)


class Sessions(InternalServer):  # type: ignore[misc]
    """The internal server of `asyncua`, with sessions of this module."""

    def create_session(self, name: str, user: User | None = None, external: bool = False) -> InternalSession:
        user = user or User(role=UserRole.Anonymous)
        return Session(self, self.aspace, self.subscription_service, name, user=user, external=external)
