"""Fewer system calls: writes are batched, and a pause of reading that would end before the next message is left out.

The answer to a slider is two messages, pose and `done`. A system call for each would cost a quarter of the time that
computing the pose takes. For every message, Uvicorn pauses reading until the application has received it, which takes
two more calls.
"""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

__all__ = ["BatchedProtocol", "BatchedTransport"]


class BatchedTransport:
    """A transport that delays writes, and pauses of reading, until the next iteration of the event loop."""

    def __init__(self, transport: asyncio.Transport, loop: asyncio.AbstractEventLoop) -> None:
        self._transport = transport
        self._loop = loop
        self._parts: list[bytes] = []
        self._pausing: asyncio.Handle | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    def write(self, data: bytes) -> None:
        """Buffer data."""
        if not self._parts:
            self._loop.call_soon(self._flush)
        self._parts.append(data)

    def close(self) -> None:
        """Send buffered data, and close."""
        self._flush()
        self._transport.close()

    def pause_reading(self) -> None:
        """Pause reading in the next iteration of the event loop, unless it is resumed before."""
        self._pausing = self._loop.call_soon(self._pause)

    def resume_reading(self) -> None:
        """Resume reading."""
        if self._pausing is None:
            self._transport.resume_reading()
        else:
            self._pausing.cancel()
            self._pausing = None

    def _pause(self) -> None:
        self._pausing = None
        self._transport.pause_reading()

    def _flush(self) -> None:
        parts, self._parts = self._parts, []
        if parts and not self._transport.is_closing():
            self._transport.write(b"".join(parts))


class BatchedProtocol(WebSocketsSansIOProtocol):
    """Uvicorn's WebSocket protocol on a batched transport."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Start a connection."""
        batched: Any = BatchedTransport(transport, self.loop)  # type: ignore[arg-type] # stream transports can write
        super().connection_made(batched)
