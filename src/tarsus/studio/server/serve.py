"""The server process: socket, link, and health check."""

from __future__ import annotations

import asyncio
import dataclasses
import errno
import json
import os
import socket
import threading
import urllib.request
from typing import Any

import uvicorn

from tarsus.errors import InputError
from tarsus.studio.server.app import studio_app
from tarsus.studio.server.batched_transport import BatchedProtocol
from tarsus.studio.server.pages import Pages
from tarsus.studio.server.settings import Settings

__all__ = ["Serving"]

# Interval between searches for late connections while the server ends [s].
_SHUTDOWN_CHECK = 0.05


class _Server(uvicorn.Server):
    """Uvicorn that, when it ends, also closes connections that it accepts after it has asked the others to close."""

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        asked = set(self.server_state.connections)
        ending = asyncio.create_task(self._end_late_connections(asked))
        try:
            await super().shutdown(sockets)
        finally:
            ending.cancel()

    async def _end_late_connections(self, asked: set[Any]) -> None:
        while True:
            await asyncio.sleep(_SHUTDOWN_CHECK)
            for connection in set(self.server_state.connections) - asked:
                asked.add(connection)
                connection.shutdown()


class Serving:
    """A server with a bound port.

    Parameters
    ----------
    settings : Settings
        Host and port; port 0 selects a free one.
    pages : Pages, optional
        The front end; that of the package where left out.

    Raises
    ------
    InputError
        If the port is in use, or the address does not exist.
    """

    def __init__(self, settings: Settings, *, pages: Pages | None = None) -> None:
        self._socket = _listen(settings.host, settings.port)
        self.settings = dataclasses.replace(settings, port=self._socket.getsockname()[1])
        limits = settings.limits
        config = uvicorn.Config(
            studio_app(self.settings, pages=pages),
            ws=BatchedProtocol,
            ws_max_size=limits.message_bytes,
            # On loopback, compression costs more than it saves.
            ws_per_message_deflate=not settings.loopback,
            log_level="warning",
            access_log=False,
            server_header=False,
            timeout_graceful_shutdown=2,
        )
        self._server = _Server(config)

    @property
    def url(self) -> str:
        """The link that opens the studio, with its token."""
        host = self.settings.host
        if host in ("0.0.0.0", "::"):
            host = _own_address(self._socket.family)
        if ":" in host:
            host = f"[{host}]"
        token = "" if self.settings.token is None else f"?token={self.settings.token}"
        return f"http://{host}:{self.settings.port}/{token}"

    def run(self) -> None:
        """Serve until interrupted."""
        try:
            self._server.run(sockets=[self._socket])
        except KeyboardInterrupt:
            pass  # the usual way to stop it
        finally:
            self._socket.close()

    def __enter__(self) -> Serving:
        """Serve in a separate thread."""
        self._thread = threading.Thread(target=self.run, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        """Stop, and wait for the thread."""
        self._server.should_exit = True
        self._thread.join()

    def health(self, *, timeout: float = 10.0) -> dict[str, Any]:
        """Return the health report of the running server.

        Parameters
        ----------
        timeout : float
            Timeout [s].
        """
        family, address = self._socket.family, "127.0.0.1"
        if family == socket.AF_INET6:
            address = "[::1]"
        if self.settings.host not in ("0.0.0.0", "::", "localhost"):
            address = f"[{self.settings.host}]" if ":" in self.settings.host else self.settings.host
        with urllib.request.urlopen(f"http://{address}:{self.settings.port}/health", timeout=timeout) as answer:
            health: dict[str, Any] = json.load(answer)
        return health


# Addresses reserved for documentation (RFC 5737, RFC 3849): no packet is sent to them.
_ELSEWHERE = {socket.AF_INET: ("192.0.2.1", 9), socket.AF_INET6: ("2001:db8::1", 9)}


def _own_address(family: socket.AddressFamily) -> str:
    """Return this machine's address in its network, as other machines may not know its name."""
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        try:
            # Connecting a datagram socket selects its interface and local address, and sends nothing.
            probe.connect(_ELSEWHERE[family])
            return str(probe.getsockname()[0])
        except OSError:  # not in a network
            return "127.0.0.1" if family == socket.AF_INET else "::1"


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, proto=socket.IPPROTO_TCP
        )[0]
        # asyncio sets TCP_NODELAY only if the socket's protocol is TCP; else small messages are delayed by 40 ms.
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise InputError(_why(host, port, error)) from None
    except (OverflowError, UnicodeError):
        raise InputError(f"{host!r}, port {port}: the address does not exist") from None
    try:
        if os.name == "posix":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        listener.listen()
    except OSError as error:
        listener.close()
        raise InputError(_why(host, port, error)) from None
    return listener


def _why(host: str, port: int, error: OSError) -> str:
    if isinstance(error, socket.gaierror):
        return f"cannot listen on {host!r}: {error.strerror}"
    if error.errno == errno.EADDRINUSE:
        return f"port {port} at {host} is in use; choose another, or 0 for a free one"
    if error.errno in (errno.EACCES, errno.EPERM):
        return f"port {port} requires more privileges; choose a port of at least 1024 with --port"
    return f"cannot listen on {host}, port {port}: {os.strerror(error.errno) if error.errno else error}"
