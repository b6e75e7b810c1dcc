"""Answers that belong together go out together: one call of the system for all that a turn of the event loop sends.

A slider's pose and the `done` behind it are two messages. Each sent by itself costs the server a quarter of the time
that the pose took to work out.
"""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

__all__ = ["BatchedProtocol"]


class _BatchedTransport:
    """A transport that keeps what is written until the event loop's next turn."""

    def __init__(self, transport: asyncio.Transport, loop: asyncio.AbstractEventLoop) -> None:
        self._transport = transport
        self._loop = loop
        self._parts: list[bytes] = []

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    def write(self, data: bytes) -> None:
        """Keep data to be sent."""
        if not self._parts:
            self._loop.call_soon(self._flush)
        self._parts.append(data)

    def close(self) -> None:
        """Send what is kept, and close."""
        self._flush()
        self._transport.close()

    def _flush(self) -> None:
        parts, self._parts = self._parts, []
        if parts and not self._transport.is_closing():
            self._transport.write(b"".join(parts))


class BatchedProtocol(WebSocketsSansIOProtocol):
    """Uvicorn's WebSocket on such a transport."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin a connection."""
        batched: Any = _BatchedTransport(transport, self.loop)  # type: ignore[arg-type] # a stream's is one to write to
        super().connection_made(batched)
