"""The web server: the page, and one WebSocket for everything else. It runs in a thread of its own."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import threading
from collections.abc import AsyncIterator, Awaitable, Callable
from importlib.resources import files
from typing import Final

import uvicorn
from fastapi import FastAPI, Request, Response, WebSocket
from pydantic import BaseModel, ValidationError
from starlette.websockets import WebSocketDisconnect

from mintpilot.console.access import Address, Rate, Tokens
from mintpilot.console.board import Board, Cursor
from mintpilot.console.desk import Client, Desk
from mintpilot.console.protocol import COMMANDS, LONGEST_BYTES, Hello
from mintpilot.core.errors import DeviceError

HELLO_S = 5.0
"""A browser that has not said who it is by then is sent away, seconds."""
BEAT_S = 1.0
"""A browser hears something at least so often, seconds: else it knows that the link is lost."""
MOST_CLIENTS = 40
"""Links at one time."""
_COMMANDS_AT_ONCE, _COMMANDS_A_SECOND = 20, 5.0
_SOUNDS_AT_ONCE, _SOUNDS_A_SECOND = 60, 15.0
"""Messages of a microphone; a tenth of a second is usual."""
_START_S, _STOP_S = 10.0, 5.0
_LAST_S = 0.3
"""Browsers get so long to hear how the mission ended, seconds."""
_REFUSED, _TOO_MUCH, _FULL = 4401, 4429, 4503
"""Codes with which a WebSocket is closed."""
_TYPES: Final = {"html": "text/html", "css": "text/css", "js": "text/javascript", "svg": "image/svg+xml"}


class ConsoleServer:
    """Serves until it is closed.

    Args:
        board: what is shown.
        desk: who answers.
        address: where to listen.
        tokens: who may do what.

    Raises:
        DeviceError: nothing can be served at that address.
    """

    def __init__(self, board: Board, desk: Desk, address: Address, tokens: Tokens) -> None:
        self._board, self._desk, self._address, self._tokens = board, desk, address, tokens
        self._socket = _listening(address)
        self.port: int = self._socket.getsockname()[1]
        self._links = 0
        config = uvicorn.Config(
            self._app(),
            log_level="critical",
            access_log=False,
            ws="websockets-sansio",
            ws_max_size=LONGEST_BYTES,
            ws_ping_interval=5.0,
            ws_ping_timeout=10.0,
            server_header=False,
            timeout_graceful_shutdown=1,
            lifespan="off",
            ssl_certfile=address.tls_cert,
            ssl_keyfile=address.tls_key,
        )
        self._server = uvicorn.Server(config)
        self._thread = threading.Thread(target=self._serve, name="mintpilot console server", daemon=True)
        self._thread.start()
        waited = threading.Event()
        for _ in range(int(_START_S / 0.02)):
            if self._server.started or not self._thread.is_alive():
                break
            waited.wait(0.02)
        if not self._server.started:
            self.close()
            raise DeviceError(f"the web console could not be served at {address.host}: choose another --port")

    @property
    def serves(self) -> bool:
        """Whether it still does."""
        return self._thread.is_alive()

    @property
    def base_url(self) -> str:
        """Scheme, host and port."""
        host = f"[{self._address.host}]" if ":" in self._address.host else self._address.host
        return f"{'https' if self._address.is_safe else 'http'}://{host}:{self.port}"

    def close(self) -> None:
        """Ends all links. Safe to call again."""
        if self._links and self._thread.is_alive() and not self._server.should_exit:
            threading.Event().wait(_LAST_S)
        self._server.should_exit = True
        self._thread.join(timeout=_STOP_S)
        self._socket.close()

    def _serve(self) -> None:
        self._server.run(sockets=[self._socket])

    def _app(self) -> FastAPI:
        app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
        hosts = self._address.hosts(self.port)
        rules = {**_HEADERS, "content-security-policy": _policy(self._address, self.port)}

        async def guarded(request: Request, go_on: Callable[[Request], Awaitable[Response]]) -> Response:
            ours = request.headers.get("host") in hosts
            response = await go_on(request) if ours else Response("This host is not served here.", 421)
            for name, value in rules.items():
                response.headers[name] = value
            return response

        async def page() -> Response:
            return _file("index.html") or Response("", 404)

        async def part(name: str) -> Response:
            return _file(name) or Response("There is no such file.", 404)

        async def live(link: WebSocket) -> None:
            await self._live(link)

        app.middleware("http")(guarded)
        app.get("/")(page)
        app.get("/static/{name}")(part)
        app.websocket("/live")(live)
        return app

    async def _live(self, link: WebSocket) -> None:
        head = link.headers
        if head.get("host") not in self._address.hosts(self.port) or head.get("origin") not in self._address.origins(
            self.port
        ):
            await link.close(_REFUSED)
            return
        await link.accept()
        if self._links >= MOST_CLIENTS:
            await link.close(_FULL)
            return
        self._links += 1
        try:
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                client = await self._welcomed(link)
                if client is not None:
                    await self._served(link, client)
        finally:
            self._links -= 1

    async def _welcomed(self, link: WebSocket) -> Client | None:
        try:
            hello = Hello.model_validate_json(await asyncio.wait_for(link.receive_text(), HELLO_S))
            role = self._tokens.role(hello.token)
        except (TimeoutError, ValidationError, KeyError):
            role, hello = None, None
        if role is None or hello is None:
            await link.close(_REFUSED)
            return None
        address = link.client.host if link.client is not None else ""
        return Client(browser=hello.browser, role=role, address=address)

    async def _served(self, link: WebSocket, client: Client) -> None:
        awake, loop = asyncio.Event(), asyncio.get_running_loop()

        def wake() -> None:
            with contextlib.suppress(RuntimeError):  # the loop has ended
                loop.call_soon_threadsafe(awake.set)

        self._desk.enter(client)
        self._board.join(id(client), wake)
        sending = asyncio.create_task(self._send(link, client, awake))
        try:
            await self._receive(link, client, wake)
        finally:
            self._board.leave(id(client))
            self._desk.leave(client)
            sending.cancel()
            with contextlib.suppress(asyncio.CancelledError, Exception):
                await sending

    async def _receive(self, link: WebSocket, client: Client, wake: Callable[[], None]) -> None:
        rate = Rate(burst=_COMMANDS_AT_ONCE, per_second=_COMMANDS_A_SECOND)
        sound_rate = Rate(burst=_SOUNDS_AT_ONCE, per_second=_SOUNDS_A_SECOND)
        while True:
            message = await link.receive()
            if message["type"] == "websocket.disconnect":
                return
            sound = message.get("bytes")
            if not (rate if sound is None else sound_rate).allows():
                await link.close(_TOO_MUCH)
                return
            if sound is not None:
                self._desk.hear(client, sound)
                continue
            try:
                command = COMMANDS.validate_json(message.get("text") or "")
            except ValidationError:
                await link.close(_REFUSED)
                return
            taken = self._desk.take(client, command)
            await link.send_text(f'{{"ack":{command.n},"taken":{"true" if taken else "false"}}}')
            wake()

    async def _send(self, link: WebSocket, client: Client, awake: asyncio.Event) -> None:
        """Sends what this browser has not got. A slow one is waited for here, and nobody else waits."""
        cursor, seat = Cursor(), None
        while True:
            awake.clear()
            now: BaseModel = self._desk.seat(client)
            if now != seat:
                seat = now
                await link.send_text(f'{{"pane":"seat","data":{now.model_dump_json()}}}')
            async for message in _all(self._board, cursor):
                await (link.send_bytes(message) if isinstance(message, bytes) else link.send_text(message))
            try:
                await asyncio.wait_for(awake.wait(), BEAT_S)
            except TimeoutError:
                await link.send_text('{"beat":1}')


async def _all(board: Board, cursor: Cursor) -> AsyncIterator[str | bytes]:
    while (message := board.news(cursor)) is not None:
        yield message


def _listening(address: Address) -> socket.socket:
    family = socket.AF_INET6 if ":" in address.host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((address.host, address.port))
    except OSError as error:
        listener.close()
        raise DeviceError(
            f"the web console cannot listen at {address.host}:{address.port} ({error.strerror}): choose another --port"
        ) from error
    return listener


_HEADERS: Final = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
    "permissions-policy": "camera=(), microphone=(self), geolocation=()",
}


def _policy(address: Address, port: int) -> str:
    scheme = "wss" if address.is_safe else "ws"
    named = sorted(host for host in address.hosts(port) if not host.startswith("["))  # no policy can name those
    sockets = " ".join(["'self'", *(f"{scheme}://{host}" for host in named)])
    return (
        f"default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src {sockets}; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; require-trusted-types-for 'script'"
    )


def _file(name: str) -> Response | None:
    """One of the files that the package ships; None: it ships none of that name."""
    shipped = {entry.name: entry for entry in files("mintpilot.console").joinpath("static").iterdir()}
    kind = _TYPES.get(name.rpartition(".")[2])
    if name not in shipped or kind is None:
        return None
    return Response(shipped[name].read_bytes(), media_type=f"{kind}; charset=utf-8")
