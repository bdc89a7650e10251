"""Serves the page on this host, and sends each page the data that it requests."""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
import threading
import time
import traceback
from collections import deque
from collections.abc import AsyncIterator, Iterator
from importlib import resources
from pathlib import Path
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import Request as HttpRequest
from starlette.responses import Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import Message, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from takt.errors import TaktError
from takt.keys import Key, no_key
from takt.recording import Array
from takt.tables import KINDS
from takt.view.commander import Commander, RefusedError
from takt.view.feed import Feed
from takt.view.protocol import Request, RequestError, frame, parse

HOST = "127.0.0.1"
HOSTS = ["127.0.0.1", "localhost"]
TICK_S = 0.05  # interval of frames
AHEAD = 4  # largest number of frames not drawn yet: a slow page receives fewer and larger ones
WAITING_S = 1.0  # interval of the message that the page waits for an engine
MOST_ROWS = 8192  # of one component in one frame
MOST_ANSWERS = 256  # newest answers kept for a page that takes no frames
HEADERS = [
    (b"cache-control", b"no-store"),
    (b"x-content-type-options", b"nosniff"),
    (b"content-security-policy", b"default-src 'self'; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'"),
]


class Page:
    """One open page."""

    def __init__(self, socket: WebSocket, feed: Feed, drawn: threading.Event) -> None:
        self._drawn = drawn  # set as soon as the page has drawn something of an engine
        self._wanted: dict[int, tuple[str, ...]] = {}
        self.ready = asyncio.Event()
        self._socket = socket
        self._feed = feed
        self._epoch = -1
        self._waiting: dict[str, str] = {}
        self._cursors: dict[int, int] = {}
        self._details: tuple[int, ...] = ()
        self._revision = 0
        self._events = 0
        self._shapes = 0
        self._routes = 0
        self._made_cams = 0
        self._waited = 0.0  # when the page was last informed that it waits
        self._engine: Any = None
        self._sent = 0
        self._acked = 0
        self._skipped = 0
        self._commander: Commander | None = None
        self._answers: deque[dict[str, Any]] = deque(maxlen=MOST_ANSWERS)  # errors of commands

    @property
    def signals(self) -> list[tuple[int, str]]:
        """The signals that the page shows, of the running machine."""
        if self._epoch != self._feed.epoch:
            return []
        return [(index, field) for index, fields in self._wanted.items() for field in fields]

    async def listen(self) -> None:
        while True:
            text = await self._socket.receive_text()
            try:
                self._take(parse(text, self._feed.machine, self._feed.epoch))
            except (RequestError, RefusedError) as error:
                await self._socket.send_text(json.dumps({"complaint": str(error)}))

    def _take(self, request: Request) -> None:
        if request.ack is not None:
            self._acked = min(max(self._acked, request.ack), self._sent)
            self._drawn.set()
        now = time.monotonic()
        if self._commander is not None and self._epoch == self._feed.epoch:
            if request.command is not None:
                if not self._feed.may_command:
                    raise RefusedError(no_key(self._feed.url))
                self._commander.give(*request.command, now)
            if request.hold is not None:
                self._commander.hold(now) if request.hold else self._commander.release()
        if request.details is not None:
            self._details = request.details
        if request.signals is not None:
            self._wanted = dict(request.signals)
            self._feed.look_at(self.signals)
            for index in self._wanted:
                ring = self._feed.taps[index].ring
                if index in request.after:
                    self._cursors[index] = ring.after(request.after[index])
                else:
                    self._cursors.setdefault(index, ring.first)
            self._cursors = {i: cursor for i, cursor in self._cursors.items() if i in self._wanted}

    def tick(self) -> None:
        """Call after the feed's tick: handles held commands, and triggers the next frame."""
        if self._commander is not None:
            self._commander.tick(time.monotonic())
        self.ready.set()

    def leave(self) -> None:
        """Releases all held commands."""
        if self._commander is not None:
            self._commander.release()
            self._feed.listeners.discard(self._commander.take)
            self._commander = None

    async def tell(self) -> None:
        while True:
            await self.ready.wait()
            self.ready.clear()
            if self._epoch != self._feed.epoch or self._feed.machine is None:
                await self._tell_machine()
            if self._feed.machine is not None and self._sent - self._acked < AHEAD:
                self._sent += 1
                await self._socket.send_bytes(self._frame())

    async def _tell_machine(self) -> None:
        feed = self._feed
        if feed.machine is None:
            waiting = {"waiting": feed.url, "trouble": feed.trouble}
            now = time.monotonic()
            if waiting != self._waiting or now - self._waited > WAITING_S:  # the page takes silence for a dead server
                self._waiting, self._waited = waiting, now
                await self._socket.send_text(json.dumps(waiting))
            return
        self._epoch, self._wanted, self._cursors, self._details = feed.epoch, {}, {}, ()
        self._revision = self._events = self._shapes = self._routes = self._made_cams = self._skipped = 0
        self._engine = None
        self.leave()
        self._commander = Commander(feed.network, feed.machine, self._answers.append)
        feed.listeners.add(self._commander.take)
        described = {"epoch": feed.epoch, "url": feed.url, **feed.machine.describe()}
        await self._socket.send_text(json.dumps({"machine": described}, allow_nan=False))

    def _frame(self) -> bytes:
        feed, overview = self._feed, self._feed.overview
        assert feed.machine is not None
        assert overview is not None
        numbers: list[Array] = [overview.live]
        for index in self._details:
            numbers.append(overview.values(index, KINDS[feed.machine.sources[index].kind].units))
        signals = []
        for index, fields in self._wanted.items():
            piece = feed.taps[index].ring.since(self._cursors[index], fields, MOST_ROWS)
            self._cursors[index] = piece.cursor
            self._skipped += piece.skipped
            if len(piece.cycles):
                signals.append([index, len(piece.cycles), fields, piece.skipped])
                numbers += [piece.cycles, *piece.columns]
        header: dict[str, Any] = {
            "n": self._sent,
            "cycle": overview.cycle,
            "live": len(overview.live),
            "details": self._details,
            "signals": signals,
            "objects": feed.objects,
            "links": feed.links,
            "health": {
                "gone": feed.gone,
                "trouble": feed.trouble,
                "lost": feed.lost,
                "skipped": self._skipped,
                "messages": feed.messages,
            },
        }
        if rows := overview.rows_since(self._revision):
            header["rows"] = rows
        self._revision = overview.revision
        if events := feed.ledger.since(self._events):
            header["events"] = events
        self._events = feed.ledger.count
        if shapes := feed.shapes.since(self._shapes):
            header["shapes"] = shapes
        self._shapes = feed.shapes.count
        if routes := feed.routes.since(self._routes):
            header["routes"] = routes
        self._routes = feed.routes.count
        if made := feed.made_cams.since(self._made_cams):
            header["cams"] = made
        self._made_cams = feed.made_cams.count
        if self._answers:
            header["answers"] = list(self._answers)
            self._answers.clear()
        if feed.engine is not self._engine:
            header["engine"] = self._engine = feed.engine
        return frame(header, numbers)


class Site:
    """The page, its files and its socket."""

    def __init__(self, feed: Feed, drawn: threading.Event) -> None:
        self.feed = feed
        self.drawn = drawn
        self.pages: set[Page] = set()
        root = resources.files("takt")
        self.app = Starlette(
            routes=[
                Route("/", self._index),
                WebSocketRoute("/live", self._live),
                Mount("/page", _files(str(root / "view" / "page"))),
            ],
            middleware=[Middleware(TrustedHostMiddleware, allowed_hosts=HOSTS)],
            lifespan=self._lifespan,
        )

    async def _index(self, _: HttpRequest) -> Response:
        text = (resources.files("takt") / "view" / "page" / "index.html").read_text(encoding="utf-8")
        return Response(text, media_type="text/html", headers={k.decode(): v.decode() for k, v in HEADERS})

    @contextlib.asynccontextmanager
    async def _lifespan(self, _: Starlette) -> AsyncIterator[None]:
        running = asyncio.create_task(self._run())
        try:
            yield
        finally:
            running.cancel()

    async def _run(self) -> None:
        loop = asyncio.get_running_loop()
        due = loop.time()
        while True:
            with self._trouble_told():
                self.feed.tick()
            with self._trouble_told():
                self.feed.look_at(signal for page in self.pages for signal in page.signals)
            for page in self.pages:
                with self._trouble_told():
                    page.tick()
            due = max(due + TICK_S, loop.time())
            await asyncio.sleep(due - loop.time())

    @contextlib.contextmanager
    def _trouble_told(self) -> Iterator[None]:
        try:
            yield
        except Exception as error:  # the page shows it, rather than standing still
            trouble = f"the server of this page has failed: {error!r}"
            if self.feed.trouble != trouble:
                traceback.print_exc()
            self.feed.trouble = trouble

    async def _live(self, socket: WebSocket) -> None:
        origin = socket.headers.get("origin", "")
        if origin != f"http://{socket.headers.get('host', '')}":  # another site in the same browser
            await socket.close(1008)
            return
        await socket.accept()
        page = Page(socket, self.feed, self.drawn)
        self.pages.add(page)
        tasks = [asyncio.create_task(page.listen()), asyncio.create_task(page.tell())]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self.pages.discard(page)
            page.leave()
            for task in tasks:
                task.cancel()
            for result in await asyncio.gather(*tasks, return_exceptions=True):
                left = isinstance(result, WebSocketDisconnect) or socket.application_state != WebSocketState.CONNECTED
                if isinstance(result, Exception) and not left:
                    raise result


def _files(directory: str) -> Any:
    files = StaticFiles(directory=directory)

    async def serve(scope: Scope, receive: Receive, send: Send) -> None:
        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message["headers"], *HEADERS]
            await send(message)

        await files(scope, receive, with_headers)

    return serve


@contextlib.contextmanager
def serving(
    url: str,
    port: int = 0,
    drawn: threading.Event | None = None,
    key: Key | None = None,
    file: Path | None = None,
) -> Iterator[str]:
    """Serves the page of the engine on this network, in a thread, while the context is open. Yields its address. port
    0: any. `drawn` is set as soon as a page has drawn something of the engine. `file`: the machine file that the engine
    presumably runs. Raises TaktError if the port cannot be used."""
    site = Site(Feed(url, key, file), drawn or threading.Event())
    with socket.socket() as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((HOST, port))
        except OSError as error:
            raise TaktError(f"port {port} cannot be used for the page: {error.strerror}") from None
        config = uvicorn.Config(
            site.app,
            log_level="error",
            lifespan="on",
            ws_per_message_deflate=False,
            ws_max_size=1 << 20,
            timeout_graceful_shutdown=1,
        )
        server = uvicorn.Server(config)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, name="takt view", daemon=True)
        thread.start()
        while thread.is_alive() and not server.started:
            time.sleep(0.01)
        try:
            yield f"http://{HOST}:{listener.getsockname()[1]}/"
        finally:
            server.should_exit = True
            thread.join()
